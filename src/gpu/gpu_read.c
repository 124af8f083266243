/// Reading a batch: flags, observations, positions, velocities, hash.
///
/// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "gpu_batch.h"

/// Bodies whose state is read together.
#define CHUNK_OF_BODIES 4096u

static mspring_result check_gpu_range(mspring_gpu *batch, const char *kind, uint64_t first, uint64_t count,
                                      uint64_t all, const void *out, uint32_t stride) {
    if (first > all || count > all - first)
        return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_ID,
                                 "%llu %s from number %llu on: numbers are below %llu", (unsigned long long)count,
                                 kind, (unsigned long long)first, (unsigned long long)all);
    if (out == NULL && count > 0)
        return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_ARGUMENT, "the place for what is read is NULL");
    return stride > 0 ? MSPRING_OK : mspringi_gpu_fail(&batch->message, MSPRING_ERROR_ARGUMENT, "the stride is 0");
}

static mspring_result no_gpu_memory(mspring_gpu *batch) {
    return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_MEMORY, "no memory to read the batch");
}

mspring_result mspring_gpu_get_flags(mspring_gpu *batch, uint32_t first, uint32_t count, uint32_t *flags,
                                     uint32_t stride) {
    if (batch == NULL)
        return MSPRING_ERROR_ARGUMENT;
    mspring_result result = check_gpu_range(batch, "bodies", first, count, batch->body_count, flags, stride);
    if (result != MSPRING_OK || count == 0)
        return result;
    uint8_t *held = malloc(count);
    if (held == NULL)
        return no_gpu_memory(batch);
    result = mspringi_gpu_read(batch, batch->helds[batch->now], first, count, held, "reading flags");
    for (size_t i = 0; result == MSPRING_OK && i < count; i++)
        flags[i * stride] = held[i] != 0 ? MSPRING_GROUP_HELD : 0;
    free(held);
    return result;
}

/* ---------------------------------------------------------------------------------------- observations */

static mspring_result reserve_buffer(mspring_gpu *batch, cl_mem *buffer, size_t *has, size_t bytes) {
    cl_mem made = NULL;
    if (*buffer != NULL && *has >= bytes)
        return MSPRING_OK;
    const mspring_result result =
        mspringi_gpu_make_buffer(batch, &made, bytes, NULL, "making room for observations");
    if (result != MSPRING_OK)
        return result;
    if (*buffer != NULL)
        (void)batch->gpu.clReleaseMemObject(*buffer);
    *buffer = made;
    *has = bytes;
    return MSPRING_OK;
}

// Check that the kernel knows the columns.
static mspring_result check_columns(mspring_gpu *batch, const mspring_observation *columns, uint32_t count) {
    for (uint32_t c = 0; c < count; c++) {
        const mspring_property property = columns[c].property;
        const bool is_of_body =
            property == MSPRING_GROUP_FLAGS || (property >= MSPRING_GROUP_X && property <= MSPRING_GROUP_MAX_Y);
        if (is_of_body && columns[c].index != 0)
            return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_ARGUMENT,
                                     "column %u is of the body itself: its index is %u, it must be 0", (unsigned)c,
                                     (unsigned)columns[c].index);
        if (!is_of_body && property != MSPRING_MASS && !(property >= MSPRING_X && property <= MSPRING_VY) &&
            !(property >= MSPRING_RELATIVE_X && property <= MSPRING_RELATIVE_VY))
            return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_ARGUMENT,
                                     "column %u: a device cannot observe property 0x%x", (unsigned)c,
                                     (unsigned)property);
    }
    return MSPRING_OK;
}

static mspring_result run_observe(mspring_gpu *batch, uint32_t first, uint32_t count,
                                  const mspring_observation *columns, uint32_t column_count, size_t bytes) {
    const cl_double origin_x = batch->t.origin_x, origin_y = batch->t.origin_y;
    const size_t column_bytes = column_count * sizeof *columns;
    mspring_result result = reserve_buffer(batch, &batch->rows, &batch->rows_bytes, bytes);
    if (result == MSPRING_OK)
        result = reserve_buffer(batch, &batch->columns, &batch->columns_bytes, column_bytes);
    if (result == MSPRING_OK)
        result = mspringi_gpu_write(batch, batch->columns, column_bytes, columns, "writing the columns");
    const mspringi_gpu_argument arguments[] = {{sizeof(cl_mem), &batch->states[batch->now]},
                                               {sizeof(cl_mem), &batch->helds[batch->now]},
                                               {sizeof(cl_mem), &batch->masses},
                                               {sizeof(cl_mem), &batch->columns},
                                               {sizeof(cl_mem), &batch->rows},
                                               {sizeof first, &first},
                                               {sizeof count, &count},
                                               {sizeof column_count, &column_count},
                                               {sizeof origin_x, &origin_x},
                                               {sizeof origin_y, &origin_y}};
    if (result == MSPRING_OK)
        result =
            mspringi_gpu_set_arguments(batch, batch->observe, arguments, sizeof arguments / sizeof arguments[0]);
    return result == MSPRING_OK ? mspringi_gpu_run(batch, batch->observe, count, 0, "observing bodies") : result;
}

mspring_result mspring_gpu_observe(mspring_gpu *batch, uint32_t first, uint32_t count,
                                   const mspring_observation *columns, uint32_t column_count, double *rows,
                                   uint32_t stride) {
    if (batch == NULL)
        return MSPRING_ERROR_ARGUMENT;
    mspring_result result = check_gpu_range(batch, "bodies", first, count, batch->body_count, rows, stride);
    if (result == MSPRING_OK && stride < column_count)
        result =
            mspringi_gpu_fail(&batch->message, MSPRING_ERROR_ARGUMENT, "the stride is %u, but a row has %u columns",
                              (unsigned)stride, (unsigned)column_count);
    if (result == MSPRING_OK && columns == NULL && column_count > 0)
        result = mspringi_gpu_fail(&batch->message, MSPRING_ERROR_ARGUMENT, "the list of columns is NULL");
    if (result == MSPRING_OK)
        result = check_columns(batch, columns, column_count);
    if (result != MSPRING_OK || count == 0 || column_count == 0)
        return result;
    if (column_count > SIZE_MAX / sizeof *rows / count)
        return no_gpu_memory(batch);
    const size_t bytes = (size_t)count * column_count * sizeof *rows;
    double *all = stride == column_count ? rows : malloc(bytes);
    if (all == NULL)
        return no_gpu_memory(batch);
    result = run_observe(batch, first, count, columns, column_count, bytes);
    if (result == MSPRING_OK)
        result = mspringi_gpu_read(batch, batch->rows, 0, bytes, all, "reading observations");
    for (size_t i = 0; result == MSPRING_OK && all != rows && i < count; i++)
        memcpy(rows + i * stride, all + i * column_count, column_count * sizeof *rows);
    if (all != rows)
        free(all);
    return result;
}

/* ----------------------------------------------------------------------------------------------- state */

/// Arguments and result of a visit of bodies in order. first and count are particles of the batch.
typedef struct gpu_visit {
    uint32_t first, count, stride;
    double *x, *y;
    float *vx, *vy;
    uint64_t hash;
} gpu_visit;

static void visit_hash(gpu_visit *v, const mspring_gpu *batch, uint32_t body, const float *state) {
    (void)body;
    v->hash = mspringi_gpu_hash_body(v->hash, state, batch->t.particle_count);
}

static void visit_particles(gpu_visit *v, const mspring_gpu *batch, uint32_t body, const float *state) {
    const uint32_t n = batch->t.particle_count;
    for (uint32_t p = 0; p < n; p++) {
        const uint64_t id = (uint64_t)body * n + p;
        if (id < v->first || id - v->first >= v->count)
            continue;
        const size_t at = (size_t)(id - v->first) * v->stride;
        if (v->vx != NULL) {
            v->vx[at] = state[4 * n + p];
            v->vy[at] = state[5 * n + p];
        } else {
            v->x[at] =
                batch->t.origin_x + ((double)state[p] + (double)mspringi_gpu_low_of(state[p], state[2 * n + p]));
            v->y[at] = batch->t.origin_y +
                       ((double)state[n + p] + (double)mspringi_gpu_low_of(state[n + p], state[3 * n + p]));
        }
    }
}

static mspring_result visit_bodies(mspring_gpu *batch, uint32_t first, uint32_t count, gpu_visit *v,
                                   void (*visit)(gpu_visit *, const mspring_gpu *, uint32_t, const float *)) {
    const size_t floats = mspringi_gpu_state_size(batch);
    const uint32_t most = count < CHUNK_OF_BODIES ? count : CHUNK_OF_BODIES;
    float *states = malloc(most * floats * sizeof *states);
    mspring_result result = states != NULL ? MSPRING_OK : no_gpu_memory(batch);
    for (uint32_t done = 0; result == MSPRING_OK && done < count;) {
        const uint32_t part = count - done < most ? count - done : most;
        result = mspringi_gpu_read(batch, batch->states[batch->now], (first + done) * floats * sizeof *states,
                                   part * floats * sizeof *states, states, "reading the state");
        for (uint32_t b = 0; result == MSPRING_OK && b < part; b++)
            visit(v, batch, first + done + b, states + b * floats);
        done += part;
    }
    free(states);
    return result;
}

static mspring_result read_particles_of(mspring_gpu *batch, gpu_visit *v) {
    const uint64_t n = batch->t.particle_count;
    const void *out =
        v->x != NULL && v->y != NULL ? (const void *)v->x : (const void *)(v->vy != NULL ? v->vx : NULL);
    const mspring_result result =
        check_gpu_range(batch, "particles", v->first, v->count, n * batch->body_count, out, v->stride);
    if (result != MSPRING_OK || v->count == 0)
        return result;
    const uint32_t body = (uint32_t)(v->first / n), end = (uint32_t)(((uint64_t)v->first + v->count - 1) / n) + 1;
    return visit_bodies(batch, body, end - body, v, visit_particles);
}

mspring_result mspring_gpu_get_positions(mspring_gpu *batch, mspring_id first, uint32_t count, double *x, double *y,
                                         uint32_t stride) {
    gpu_visit v = {.first = first, .count = count, .stride = stride, .x = x, .y = y};
    return batch != NULL ? read_particles_of(batch, &v) : MSPRING_ERROR_ARGUMENT;
}

mspring_result mspring_gpu_get_velocities(mspring_gpu *batch, mspring_id first, uint32_t count, float *vx,
                                          float *vy, uint32_t stride) {
    gpu_visit v = {.first = first, .count = count, .stride = stride, .vx = vx, .vy = vy};
    return batch != NULL ? read_particles_of(batch, &v) : MSPRING_ERROR_ARGUMENT;
}

mspring_result mspring_gpu_get_state_hash(mspring_gpu *batch, uint64_t *hash) {
    if (batch == NULL || hash == NULL)
        return MSPRING_ERROR_ARGUMENT;
    gpu_visit v = {.hash = mspringi_gpu_hash_head(batch->t.origin_x, batch->t.origin_y, batch->lag)};
    const mspring_result result = visit_bodies(batch, 0, batch->body_count, &v, visit_hash);
    if (result == MSPRING_OK)
        *hash = v.hash;
    return result;
}

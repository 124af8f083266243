/// Creation of a batch: buffers, kernels, and a check that it has the bits of the processor.
///
/// SPDX-License-Identifier: MIT
#include "gpu_batch.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Most work-items of a group.
#define MOST_ITEMS 256u

/* ---------------------------------------------------------------------------------------- device calls */

mspring_result mspringi_gpu_make_buffer(mspring_gpu *batch, cl_mem *buffer, size_t bytes, const void *from,
                                        const char *purpose) {
    cl_int status = CL_SUCCESS;
    *buffer =
        batch->gpu.clCreateBuffer(batch->gpu.context, CL_MEM_READ_WRITE, bytes > 0 ? bytes : 4, NULL, &status);
    if (*buffer == NULL)
        return mspringi_gpu_check(&batch->gpu, &batch->message, status != CL_SUCCESS ? status : CL_OUT_OF_RESOURCES,
                                  "clCreateBuffer", purpose);
    return from != NULL && bytes > 0 ? mspringi_gpu_write(batch, *buffer, bytes, from, purpose) : MSPRING_OK;
}

mspring_result mspringi_gpu_write(mspring_gpu *batch, cl_mem buffer, size_t bytes, const void *from,
                                  const char *purpose) {
    return mspringi_gpu_check(
        &batch->gpu, &batch->message,
        batch->gpu.clEnqueueWriteBuffer(batch->gpu.queue, buffer, CL_TRUE, 0, bytes, from, 0, NULL, NULL),
        "clEnqueueWriteBuffer", purpose);
}

mspring_result mspringi_gpu_read(mspring_gpu *batch, cl_mem buffer, size_t offset, size_t bytes, void *to,
                                 const char *purpose) {
    return mspringi_gpu_check(
        &batch->gpu, &batch->message,
        batch->gpu.clEnqueueReadBuffer(batch->gpu.queue, buffer, CL_TRUE, offset, bytes, to, 0, NULL, NULL),
        "clEnqueueReadBuffer", purpose);
}

mspring_result mspringi_gpu_run(mspring_gpu *batch, cl_kernel kernel, size_t items, size_t group_size,
                                const char *purpose) {
    const mspring_result result =
        mspringi_gpu_check(&batch->gpu, &batch->message,
                           batch->gpu.clEnqueueNDRangeKernel(batch->gpu.queue, kernel, 1, NULL, &items,
                                                             group_size > 0 ? &group_size : NULL, 0, NULL, NULL),
                           "clEnqueueNDRangeKernel", purpose);
    return result == MSPRING_OK ? mspringi_gpu_check(&batch->gpu, &batch->message,
                                                     batch->gpu.clFinish(batch->gpu.queue), "clFinish", purpose)
                                : result;
}

mspring_result mspringi_gpu_set_arguments(mspring_gpu *batch, cl_kernel kernel,
                                          const mspringi_gpu_argument *arguments, cl_uint count) {
    mspring_result result = MSPRING_OK;
    for (cl_uint i = 0; result == MSPRING_OK && i < count; i++)
        result = mspringi_gpu_check(&batch->gpu, &batch->message,
                                    batch->gpu.clSetKernelArg(kernel, i, arguments[i].size, arguments[i].value),
                                    "clSetKernelArg", "preparing a kernel");
    return result;
}

/* ---------------------------------------------------------------------------------------------- making */

static mspring_result make_kernel(mspring_gpu *batch, const char *name, cl_kernel *kernel) {
    cl_int status = CL_SUCCESS;
    *kernel = batch->gpu.clCreateKernel(batch->gpu.program, name, &status);
    return *kernel != NULL
               ? MSPRING_OK
               : mspringi_gpu_check(&batch->gpu, &batch->message,
                                    status != CL_SUCCESS ? status : CL_OUT_OF_RESOURCES, "clCreateKernel", name);
}

static mspring_result make_kernels(mspring_gpu *batch) {
    const mspringi_gpu_template *t = &batch->t;
    const uint64_t local = 16 * (uint64_t)t->particle_count + 4 * ((uint64_t)batch->actuator_count + 1) + 64;
    const size_t most = batch->gpu.group_size < MOST_ITEMS ? batch->gpu.group_size : MOST_ITEMS;
    char options[512];
    batch->group_size = t->particle_count <= most ? t->particle_count : most;
    if (local > batch->gpu.local_memory)
        return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_LIMIT,
                                 "a body with %u actuators takes %llu bytes of local memory, and %s has %llu",
                                 (unsigned)batch->actuator_count, (unsigned long long)local, batch->gpu.name,
                                 (unsigned long long)batch->gpu.local_memory);
    (void)snprintf(options, sizeof options,
                   "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt -DPARTICLES=%u -DSLOTS=%u -DACTUATORS=%u "
                   "-DPLANES=%u -DLOCAL=%u -DROW_SLOTS=%u -DIS_DAMPED=%d",
                   (unsigned)t->particle_count, (unsigned)t->slot_count, (unsigned)batch->actuator_count,
                   (unsigned)t->plane_count, (unsigned)batch->group_size, (unsigned)t->row_slots, t->is_damped);
    mspring_result result = mspringi_gpu_build(&batch->gpu, options, &batch->message);
    if (result == MSPRING_OK)
        result = make_kernel(batch, "take_step", &batch->take_step);
    if (result == MSPRING_OK)
        result = make_kernel(batch, "put_back", &batch->put_back);
    return result == MSPRING_OK ? make_kernel(batch, "observe", &batch->observe) : result;
}

static mspring_result make_buffers(mspring_gpu *batch) {
    const mspringi_gpu_template *t = &batch->t;
    const size_t n = t->particle_count, bodies = batch->body_count, state = mspringi_gpu_state_size(batch) * 4;
    const struct {
        cl_mem *buffer;
        size_t bytes;
        const void *from;
        const char *purpose;
    } all[] = {{&batch->states[0], bodies * state, NULL, "making room for bodies"},
               {&batch->states[1], bodies * state, NULL, "making room for bodies"},
               {&batch->helds[0], bodies, batch->mask, "making room for flags"},
               {&batch->helds[1], bodies, batch->mask, "making room for flags"},
               {&batch->device_mask, bodies, NULL, "making room for the mask"},
               {&batch->device_targets, bodies * batch->actuator_count * 4, NULL, "making room for signals"},
               {&batch->start, batch->start_count * state, NULL, "making room for the start"},
               {&batch->device_links, t->slot_count * n * 16, NULL, "making room for springs"},
               {&batch->masses, n * sizeof *t->masses, t->masses, "making room for masses"},
               {&batch->planes, t->plane_count * sizeof t->planes[0], t->planes, "making room for the floor"},
               {&batch->particles, n * sizeof *t->particles, t->particles, "making room for particles"}};
    mspring_result result = MSPRING_OK;
    for (size_t i = 0; result == MSPRING_OK && i < sizeof all / sizeof all[0]; i++)
        result = mspringi_gpu_make_buffer(batch, all[i].buffer, all[i].bytes, all[i].from, all[i].purpose);
    return result;
}

static mspring_result make_host_arrays(mspring_gpu *batch, const mspring_gpu_def *def) {
    const mspringi_gpu_template *t = &batch->t;
    const size_t actuators = batch->actuator_count, signals = batch->body_count * actuators;
    batch->actuator_of = malloc(t->spring_count * sizeof *batch->actuator_of);
    batch->lengths = malloc((actuators + 1) * sizeof *batch->lengths);
    batch->targets = malloc((signals + 1) * sizeof *batch->targets);
    batch->mask = calloc(batch->body_count, 1);
    batch->links = malloc(4 * (size_t)t->slot_count * t->particle_count * sizeof *batch->links);
    if (batch->actuator_of == NULL || batch->lengths == NULL || batch->targets == NULL || batch->mask == NULL ||
        batch->links == NULL)
        return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_MEMORY, "no memory for %u bodies",
                                 (unsigned)batch->body_count);
    memset(batch->actuator_of, 0xff, t->spring_count * sizeof *batch->actuator_of);
    for (uint32_t a = 0; a < actuators; a++) {
        batch->actuator_of[def->actuators[a]] = (uint16_t)a;
        batch->lengths[a] = t->springs[def->actuators[a]].rest_length;
    }
    for (size_t i = 0; i < signals; i++)
        batch->targets[i] = batch->lengths[i % actuators];
    return MSPRING_OK;
}

/* ----------------------------------------------------------------------------------------------- proof */

static double draw(uint64_t *seed) { // -1 to 1
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(int64_t)(*seed >> 11) * 0x1p-52 - 1.0;
}

// Write the start to the device, put all bodies back to it, and clear the lag.
static mspring_result begin_at(mspring_gpu *batch) {
    const size_t floats = mspringi_gpu_state_size(batch), motion = 6 * (size_t)batch->t.particle_count;
    float *start = malloc(batch->start_count * floats * sizeof *start);
    if (start == NULL)
        return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_MEMORY, "no memory for the start");
    for (uint32_t b = 0; b < batch->start_count; b++) {
        memcpy(start + b * floats, batch->t.states + b * motion, motion * sizeof *start);
        memcpy(start + b * floats + motion, batch->lengths, batch->actuator_count * sizeof *start);
    }
    mspring_result result = mspringi_gpu_write(batch, batch->start, batch->start_count * floats * sizeof *start,
                                               start, "writing the start");
    free(start);
    if (result == MSPRING_OK)
        result = mspring_gpu_reset(batch, NULL);
    batch->lag = 0.0f;
    return result;
}

// Make random signals, and give the clone actuators with them. It checks the list of springs, too.
static mspring_result prove_signals(mspring_gpu *batch, const mspring_gpu_def *def, mspring_network *clone,
                                    float **signals, uint64_t *seed) {
    const uint32_t all = batch->start_count * batch->actuator_count;
    mspring_id *springs = malloc(all * sizeof *springs);
    *signals = malloc(all * sizeof **signals);
    mspring_result result = springs != NULL && *signals != NULL ? MSPRING_OK : MSPRING_ERROR_MEMORY;
    for (uint32_t i = 0; result == MSPRING_OK && i < all; i++) {
        const uint32_t body = i / batch->actuator_count;
        springs[i] = def->actuators[i % batch->actuator_count] + body * batch->t.spring_count;
        (*signals)[i] = (float)(1.0 + 0.05 * draw(seed));
    }
    if (result == MSPRING_OK)
        result = mspring_network_set_actuators(clone, springs, all, batch->changes);
    if (result == MSPRING_OK)
        result = mspring_network_set(clone, MSPRING_SIGNAL, NULL, 0, all, *signals, 1);
    free(springs);
    return result;
}

// Give the clone random velocities, which change the length of a spring by about 3 % in a substep. Choose a stable
// dt.
static mspring_result prove_motion(const mspring_gpu *batch, mspring_network *clone, double *dt, uint64_t *seed) {
    const size_t all = (size_t)batch->start_count * batch->t.particle_count;
    double h = 0.0;
    float *velocities = malloc(2 * all * sizeof *velocities);
    mspring_result result =
        velocities != NULL ? mspring_network_get_stable_dt(clone, NULL, &h) : MSPRING_ERROR_MEMORY;
    h = h > 0.0 && h < 1.0 ? 0.5 * h : 1e-3;
    const double shortest = batch->t.shortest < 1e3 ? batch->t.shortest : 1.0;
    const double fastest = fmin(0.03 * shortest / h, 0.1 * (double)batch->t.max_speed);
    for (size_t i = 0; result == MSPRING_OK && i < 2 * all; i++)
        velocities[i] = (float)(fastest * draw(seed));
    if (result == MSPRING_OK)
        result = mspring_network_set_velocities(clone, NULL, 0, (uint32_t)all, velocities, velocities + 1, 2);
    free(velocities);
    *dt = h * (double)batch->t.substeps;
    return result;
}

// Step the clone and the batch from the clone's state, and compare their hashes.
static mspring_result step_both(mspring_gpu *batch, mspring_network *clone, const float *signals, double dt) {
    uint64_t expected = 0, hash = 1;
    mspring_result result = mspringi_gpu_read_states(clone, &batch->t, &batch->message);
    if (result == MSPRING_OK)
        result = begin_at(batch);
    if (result == MSPRING_OK && batch->actuator_count > 0)
        result = mspring_gpu_set_signals(batch, 0, batch->start_count * batch->actuator_count, signals, 1);
    for (uint32_t taken = 0; result == MSPRING_OK && taken < 4; taken += batch->t.substeps) {
        result = mspring_network_step(clone, dt);
        if (result != MSPRING_OK)
            return mspringi_gpu_fail(&batch->message, result, "a clone of the network says: %s",
                                     mspring_network_error(clone));
        result = mspringi_gpu_take_step(batch, dt);
    }
    if (result == MSPRING_OK)
        result = mspring_gpu_get_state_hash(batch, &hash);
    if (result == MSPRING_OK)
        result = mspring_network_get_state_hash(clone, &expected);
    if (result == MSPRING_OK && hash != expected)
        return mspringi_gpu_fail(
            &batch->message, MSPRING_ERROR_ARGUMENT,
            "%s and the processor differ after a step: the network has what no call tells (forces, "
            "signals, grips, colliders, edits of masses), or the device is not exact",
            batch->gpu.name);
    return result;
}

static mspring_result prove(mspring_gpu *batch, const mspring_network *network, const mspring_gpu_def *def) {
    const uint32_t bodies = batch->body_count;
    uint64_t seed = 1;
    double dt;
    float *signals = NULL;
    mspring_network *clone = NULL;
    mspring_result result = mspring_network_clone(network, NULL, &clone);
    if (result != MSPRING_OK)
        return mspringi_gpu_fail(&batch->message, result, "no clone of the network: %s",
                                 mspring_network_error(network));
    result = prove_motion(batch, clone, &dt, &seed);
    if (result == MSPRING_OK && batch->actuator_count > 0)
        result = prove_signals(batch, def, clone, &signals, &seed);
    if (result != MSPRING_OK)
        (void)mspringi_gpu_fail(&batch->message, result, "a clone of the network says: %s",
                                mspring_network_error(clone));
    batch->body_count = batch->start_count;
    if (result == MSPRING_OK)
        result = step_both(batch, clone, signals, dt);
    batch->body_count = bodies;
    if (result == MSPRING_OK)
        result = mspringi_gpu_read_states(network, &batch->t, &batch->message);
    free(signals);
    mspring_network_destroy(clone);
    return result == MSPRING_OK ? begin_at(batch) : result;
}

/* ---------------------------------------------------------------------------------------------- public */

mspring_result mspring_gpu_def_init(mspring_gpu_def *def, size_t size) {
    if (def == NULL)
        return MSPRING_ERROR_ARGUMENT;
    if (size < sizeof *def)
        return MSPRING_ERROR_STRUCT;
    memset(def, 0, size);
    def->struct_size = (uint32_t)size;
    def->device = MSPRING_GPU_ANY;
    def->changes = 1;
    return MSPRING_OK;
}

static mspring_result check_def(mspring_gpu *batch, const mspring_gpu_def *def) {
    const mspringi_gpu_template *t = &batch->t;
    if (def->changes < 1 || def->changes > 256)
        return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_ARGUMENT, "changes is %u, it must be 1 to 256",
                                 (unsigned)def->changes);
    if (def->actuator_count > t->spring_count || (def->actuators == NULL && def->actuator_count > 0))
        return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_ARGUMENT,
                                 "%u actuators: a body has %u springs, or the list is NULL",
                                 (unsigned)def->actuator_count, (unsigned)t->spring_count);
    for (uint32_t i = 0; i < def->actuator_count; i++)
        if (def->actuators[i] >= t->spring_count)
            return mspringi_gpu_fail(
                &batch->message, MSPRING_ERROR_ID,
                "index %u of the actuators: the first body has no spring %u, numbers are below %u", (unsigned)i,
                (unsigned)def->actuators[i], (unsigned)t->spring_count);
    batch->start_count = t->body_count;
    batch->body_count = def->body_count > 0 ? def->body_count : t->body_count;
    batch->actuator_count = def->actuator_count;
    batch->changes = def->changes;
    const uint64_t most = def->actuator_count > t->particle_count ? def->actuator_count : t->particle_count;
    if (batch->body_count > SIZE_MAX / 64 / most || batch->body_count * most > UINT32_MAX)
        return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_LIMIT,
                                 "%u bodies have more particles or actuators than there are numbers",
                                 (unsigned)batch->body_count);
    if (batch->body_count < batch->start_count)
        return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_ARGUMENT,
                                 "body_count is %u, but the network has %u groups", (unsigned)def->body_count,
                                 (unsigned)t->body_count);
    return MSPRING_OK;
}

static mspring_result create(mspring_gpu *batch, const mspring_network *network, const mspring_gpu_def *def) {
    mspring_result result = mspringi_gpu_read_network(network, &batch->t, &batch->message);
    if (result == MSPRING_OK)
        result = check_def(batch, def);
    if (result == MSPRING_OK)
        result = mspringi_gpu_open(&batch->gpu, def->library, def->device, &batch->message);
    if (result == MSPRING_OK)
        result = make_host_arrays(batch, def);
    if (result == MSPRING_OK)
        result = make_kernels(batch);
    if (result == MSPRING_OK)
        result = make_buffers(batch);
    return result == MSPRING_OK ? prove(batch, network, def) : result;
}

mspring_result mspring_gpu_create(const mspring_network *network, const mspring_gpu_def *def, mspring_gpu **batch) {
    if (network == NULL || def == NULL || batch == NULL)
        return MSPRING_ERROR_ARGUMENT;
    if (def->struct_size < sizeof *def)
        return MSPRING_ERROR_STRUCT;
    mspring_gpu *made = calloc(1, sizeof *made);
    if (made == NULL)
        return MSPRING_ERROR_MEMORY;
    const mspring_result result = create(made, network, def);
    if (result != MSPRING_OK && def->message != NULL && def->message_size > 0)
        (void)snprintf(def->message, def->message_size, "%s", made->message.text);
    if (result == MSPRING_OK)
        *batch = made;
    else
        mspring_gpu_destroy(made);
    return result;
}

void mspring_gpu_destroy(mspring_gpu *batch) {
    if (batch == NULL)
        return;
    const cl_mem buffers[] = {batch->states[0], batch->states[1],   batch->helds[0],       batch->helds[1],
                              batch->start,     batch->device_mask, batch->device_targets, batch->device_links,
                              batch->particles, batch->masses,      batch->planes,         batch->rows,
                              batch->columns};
    const cl_kernel kernels[] = {batch->take_step, batch->put_back, batch->observe};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        if (buffers[i] != NULL)
            (void)batch->gpu.clReleaseMemObject(buffers[i]);
    for (size_t i = 0; i < sizeof kernels / sizeof kernels[0]; i++)
        if (kernels[i] != NULL)
            (void)batch->gpu.clReleaseKernel(kernels[i]);
    mspringi_gpu_close(&batch->gpu);
    mspringi_gpu_template_free(&batch->t);
    free(batch->actuator_of);
    free(batch->lengths);
    free(batch->targets);
    free(batch->mask);
    free(batch->links);
    free(batch);
}

const char *mspring_gpu_error(const mspring_gpu *batch) {
    return batch != NULL ? batch->message.text : "";
}

uint32_t mspring_gpu_body_count(const mspring_gpu *batch) {
    return batch != NULL ? batch->body_count : 0;
}

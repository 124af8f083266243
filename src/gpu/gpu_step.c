/// A step: constants, relative springs, the kernel. The arithmetic is that of spec.c and spec_springs.c in
/// tests/spec.
///
/// SPDX-License-Identifier: MIT
#include "gpu_batch.h"

#include <math.h>
#include <string.h>

/* -------------------------------------------------------------------------------------- global damping */

// Compute 1 - exp(-x), as loss() in spec.c.
static double gpu_loss(double x) {
    double sum = 1.0;
    if (x < 0.125) {
        for (int power = 9; power >= 2; power--)
            sum = 1.0 - x / (double)power * sum;
        return x * sum;
    }
    double part = (double)(float)x;
    int squarings = 0;
    for (; part >= 0.125 && part < 104.0; squarings++)
        part *= 0.5;
    if (!(part < 104.0))
        return 1.0;
    for (int power = 9; power >= 1; power--)
        sum = 1.0 - part / (double)power * sum;
    for (; squarings > 0; squarings--)
        sum *= sum;
    return 1.0 - (double)(float)sum;
}

// Compute the constants of a step. In a network with groups the lag is h, so all substeps have the kick of h.
static mspringi_gpu_step gpu_step_of(const mspring_gpu *batch, float h) {
    const mspringi_gpu_template *t = &batch->t;
    const double rate = (double)t->global_damping, decay = rate * (double)h;
    mspringi_gpu_step step = {.h = h,
                              .kick = t->global_damping > 0.0f ? (float)(gpu_loss(decay) / rate) : h,
                              .damping = (float)gpu_loss(decay),
                              .max_speed = t->max_speed,
                              .substeps = t->substeps,
                              .changes = batch->changes,
                              .stops = t->is_damped || t->global_damping > 0.0f};
    step.gravity_x = t->gravity_x * step.kick + 0.0f;
    step.gravity_y = t->gravity_y * step.kick + 0.0f;
    step.dithered = t->gravity_x == 0.0f && t->gravity_y == 0.0f ? 0 : t->substeps / 4 * 4;
    return step;
}

/* ----------------------------------------------------------------------------------------------- links */

// Return a spring with its stiffness and damping in substeps of h, as spec_derive_relative().
static mspringi_gpu_spring gpu_spring_at(const mspringi_gpu_template *t, uint32_t spring, float h) {
    mspringi_gpu_spring s = t->springs[spring];
    const double rate = 1.0 / (double)h;
    if (s.is_relative) {
        const double mass = 1.0 / (1.0 / (double)t->masses[s.a] + 1.0 / (double)t->masses[s.b]);
        s.stiffness = (float)((double)s.stiffness * mass * rate * rate);
        s.damping = (float)((double)s.damping * mass * rate);
    }
    return s;
}

static mspring_result write_links(mspring_gpu *batch, float h) {
    const mspringi_gpu_template *t = &batch->t;
    const size_t count = (size_t)t->slot_count * t->particle_count;
    if (batch->are_links_known && (!t->has_relative || memcmp(&h, &batch->links_h, sizeof h) == 0))
        return MSPRING_OK;
    for (size_t i = 0; i < count; i++) {
        const uint32_t p = (uint32_t)(i % t->particle_count);
        cl_uint *link = batch->links + 4 * i;
        memset(link, 0, 4 * sizeof *link);
        link[0] = p | (cl_uint)MSPRINGI_GPU_NONE << 16; // no spring: one without stiffness to itself
        if (t->slots[i] != MSPRINGI_GPU_NONE) {
            const mspringi_gpu_spring s = gpu_spring_at(t, t->slots[i], h);
            link[0] = (s.a + s.b - p) | (cl_uint)batch->actuator_of[t->slots[i]] << 16;
            memcpy(link + 1, &s.stiffness, sizeof s.stiffness);
            memcpy(link + 2, &s.damping, sizeof s.damping);
            memcpy(link + 3, &s.rest_length, sizeof s.rest_length);
        }
    }
    batch->are_links_known = false;
    const mspring_result result = mspringi_gpu_write(batch, batch->device_links, 4 * count * sizeof *batch->links,
                                                     batch->links, "writing springs");
    batch->are_links_known = result == MSPRING_OK;
    batch->links_h = h;
    return result;
}

/* ------------------------------------------------------------------------------------------------ step */

mspring_result mspringi_gpu_take_step(mspring_gpu *batch, double dt) {
    const float h = (float)(dt / (double)batch->t.substeps);
    const mspringi_gpu_step step = gpu_step_of(batch, h);
    const cl_double shortest = batch->t.shortest;
    const uint32_t now = batch->now, next = 1 - now;
    mspring_result result = write_links(batch, h);
    if (result == MSPRING_OK && batch->are_targets_new && batch->actuator_count > 0)
        result = mspringi_gpu_write(batch, batch->device_targets,
                                    (size_t)batch->body_count * batch->actuator_count * sizeof *batch->targets,
                                    batch->targets, "writing signals");
    batch->are_targets_new &= result != MSPRING_OK;
    const mspringi_gpu_argument arguments[] = {{sizeof(cl_mem), &batch->states[now]},
                                               {sizeof(cl_mem), &batch->states[next]},
                                               {sizeof(cl_mem), &batch->helds[now]},
                                               {sizeof(cl_mem), &batch->helds[next]},
                                               {sizeof(cl_mem), &batch->device_targets},
                                               {sizeof(cl_mem), &batch->device_links},
                                               {sizeof(cl_mem), &batch->particles},
                                               {sizeof(cl_mem), &batch->planes},
                                               {sizeof step, &step},
                                               {sizeof shortest, &shortest}};
    if (result == MSPRING_OK)
        result =
            mspringi_gpu_set_arguments(batch, batch->take_step, arguments, sizeof arguments / sizeof arguments[0]);
    if (result == MSPRING_OK)
        result = mspringi_gpu_run(batch, batch->take_step, batch->body_count * batch->group_size, batch->group_size,
                                  "taking a step");
    if (result == MSPRING_OK) {
        batch->now = next;
        batch->lag = h;
    }
    return result;
}

mspring_result mspring_gpu_step(mspring_gpu *batch, double dt) {
    if (batch == NULL)
        return MSPRING_ERROR_ARGUMENT;
    const float h = (float)(dt / (double)batch->t.substeps);
    if (!(dt > 0.0 && isfinite(dt) && h > 0.0f && isfinite(h)))
        return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_ARGUMENT,
                                 "dt is %g: it must be finite and above 0, and "
                                 "so must a substep",
                                 dt);
    return mspringi_gpu_take_step(batch, dt);
}

/* ---------------------------------------------------------------------------------- signals and resets */

mspring_result mspring_gpu_set_signals(mspring_gpu *batch, uint32_t first, uint32_t count, const float *signals,
                                       uint32_t stride) {
    if (batch == NULL)
        return MSPRING_ERROR_ARGUMENT;
    const uint64_t all = (uint64_t)batch->body_count * batch->actuator_count;
    if ((uint64_t)first + count > all)
        return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_ID, "actuators %u to %u: numbers are below %llu",
                                 (unsigned)first, (unsigned)(first + count - 1), (unsigned long long)all);
    if (signals == NULL && count > 0)
        return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_ARGUMENT, "the signals are NULL");
    for (size_t i = 0; i < count; i++)
        if (!(signals[i * stride] >= 0.01f && signals[i * stride] <= 100.0f))
            return mspringi_gpu_fail(&batch->message, MSPRING_ERROR_ARGUMENT,
                                     "actuator %u: the signal is %g, it must be 0.01 to 100", (unsigned)(first + i),
                                     (double)signals[i * stride]);
    for (size_t i = 0; i < count; i++)
        batch->targets[first + i] = batch->lengths[(first + i) % batch->actuator_count] * signals[i * stride];
    batch->are_targets_new |= count > 0;
    return MSPRING_OK;
}

mspring_result mspring_gpu_reset(mspring_gpu *batch, const uint8_t *mask) {
    if (batch == NULL)
        return MSPRING_ERROR_ARGUMENT;
    const uint32_t now = batch->now, next = 1 - now;
    const cl_uint start_count = batch->start_count;
    if (mask != NULL)
        memcpy(batch->mask, mask, batch->body_count);
    else
        memset(batch->mask, 1, batch->body_count);
    const mspringi_gpu_argument arguments[] = {
        {sizeof(cl_mem), &batch->states[now]}, {sizeof(cl_mem), &batch->states[next]},
        {sizeof(cl_mem), &batch->helds[now]},  {sizeof(cl_mem), &batch->helds[next]},
        {sizeof(cl_mem), &batch->start},       {sizeof(cl_mem), &batch->device_mask},
        {sizeof start_count, &start_count}};
    mspring_result result =
        mspringi_gpu_write(batch, batch->device_mask, batch->body_count, batch->mask, "writing the mask");
    if (result == MSPRING_OK)
        result =
            mspringi_gpu_set_arguments(batch, batch->put_back, arguments, sizeof arguments / sizeof arguments[0]);
    if (result == MSPRING_OK)
        result = mspringi_gpu_run(batch, batch->put_back, batch->body_count * batch->group_size, batch->group_size,
                                  "resetting bodies");
    if (result != MSPRING_OK)
        return result;
    batch->now = next;
    for (uint32_t b = 0; b < batch->body_count; b++)
        if (batch->mask[b] != 0 && batch->actuator_count > 0)
            memcpy(batch->targets + (size_t)b * batch->actuator_count, batch->lengths,
                   batch->actuator_count * sizeof *batch->lengths);
    batch->are_targets_new = true;
    return MSPRING_OK;
}

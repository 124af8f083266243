/// @file gpu_batch.h
/// A batch on a device.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GPU_BATCH_H
#define MSPRINGI_GPU_BATCH_H

#include "gpu_template.h"

/// Constants of a step, laid out as step_def in batch.cl.
typedef struct mspringi_gpu_step {
    cl_float h, kick, damping, gravity_x, gravity_y, max_speed;
    cl_uint substeps, dithered, changes, stops;
} mspringi_gpu_step;

struct mspring_gpu {
    mspringi_gpu_device gpu;
    mspringi_gpu_template t;
    uint32_t body_count, actuator_count, changes, start_count;
    uint16_t *actuator_of; ///< [spring_count] actuator or MSPRINGI_GPU_NONE
    float *lengths;        ///< [actuator_count] rest lengths at the start
    float *targets;        ///< [body_count][actuator_count] rest lengths after the next step
    uint8_t *mask;         ///< [body_count] scratch
    cl_uint *links;        ///< [slot_count][particle_count][4] scratch, see batch.cl
    size_t group_size;
    cl_kernel take_step, put_back, observe;
    /// A step reads states[now] and writes the other one. If it fails, states[now] is unchanged.
    cl_mem states[2], helds[2], start, device_targets, device_mask, device_links, particles, masses, planes;
    cl_mem rows, columns; ///< of observations
    size_t rows_bytes, columns_bytes;
    uint32_t now;
    float lag, links_h; ///< substep of the last step, and that of the relative springs in links, s
    bool are_targets_new, are_links_known;
    mspringi_gpu_message message;
};

/// Floats of a body's state on the device.
static inline size_t mspringi_gpu_state_size(const struct mspring_gpu *batch) {
    return 6 * (size_t)batch->t.particle_count + batch->actuator_count;
}

/// Make a buffer, and fill it unless from is NULL.
mspring_result mspringi_gpu_make_buffer(mspring_gpu *batch, cl_mem *buffer, size_t bytes, const void *from,
                                        const char *purpose);

/// Write or read a buffer, or run a kernel, and wait. A message has the purpose.
mspring_result mspringi_gpu_write(mspring_gpu *batch, cl_mem buffer, size_t bytes, const void *from,
                                  const char *purpose);
mspring_result mspringi_gpu_read(mspring_gpu *batch, cl_mem buffer, size_t offset, size_t bytes, void *to,
                                 const char *purpose);
mspring_result mspringi_gpu_run(mspring_gpu *batch, cl_kernel kernel, size_t items, size_t group_size,
                                const char *purpose);

/// An argument of a kernel.
typedef struct mspringi_gpu_argument {
    size_t size;
    const void *value;
} mspringi_gpu_argument;
mspring_result mspringi_gpu_set_arguments(mspring_gpu *batch, cl_kernel kernel,
                                          const mspringi_gpu_argument *arguments, cl_uint count);

/// Step a batch without checking dt. gpu_step.c
mspring_result mspringi_gpu_take_step(mspring_gpu *batch, double dt);

#endif

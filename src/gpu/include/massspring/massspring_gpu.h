/// @file massspring_gpu.h
/// Batches of equal bodies on a graphics card, with the bits of the processor.
///
///     devices     gpu_describe_devices
///     batch       gpu_def_default, gpu_create, gpu_destroy, gpu_error, gpu_body_count, gpu_step, gpu_reset
///     actuators   gpu_set_signals
///     state       gpu_get_flags, gpu_observe, gpu_get_positions, gpu_get_velocities, gpu_get_state_hash
///
/// These calls are a separate library, massspring_gpu: build with -DMASSSPRING_GPU=ON. It uses only public calls of
/// massspring, one of them of the part `lab`. The calls are not frozen yet: a later minor version may change them.
/// massspring.h explains the notation.
///
/// **How it works.** You make a network of one body or several on the processor, divide it into groups (batch.h), and
/// set floor and settings. mspring_gpu_create() reads it, repeats its bodies as often as you ask, and copies them to a
/// device. After that the network is no longer needed. Each step gives the bits of a network with that many groups:
/// mspring_gpu_get_state_hash() equals its mspring_network_get_state_hash(). Before it returns, mspring_gpu_create()
/// checks this: it steps a clone of the network and the batch from the same random velocities, and compares them. One
/// exception: bodies that are partly lattice, with many other springs, are swept in another order from 64 on. So for a
/// larger batch of these give the network 64 groups.
///
/// **What bodies may have.** Up to MSPRING_GPU_MAX_PARTICLES particles, pinned or not, each with a spring; springs with
/// stiffness, damping and rest length, relative ones, welds; actuators; half-planes with friction and restitution;
/// gravity and global damping. All bodies have the same springs and masses; positions and velocities may differ.
/// Particles and springs of a body have consecutive ids, as mspring_builder_add_copies() gives them. Parts of a body
/// may be lattices, chains or neither, and all bodies have the same layout.
///
/// **What is rejected.** Anything else is an error that names it: MSPRING_NETWORK_PRECISE, springs that are broken or
/// break, yield or act one way, areas, angles, contact, heights, scales of inverse masses. There are two exceptions,
/// because no call reads them. Hooks are ignored. So is the shortest rest length at creation, which bounds how bodies
/// bounce: if there is a floor, give the builder the rest lengths, and do not change them later.
///
/// **Devices.** OpenCL 1.2 or later with double precision, loaded when the first batch is created. A device is rejected
/// if its division and square root are not correctly rounded, or if it flushes subnormal numbers: bits would differ.
///
/// **Failures.** A call that fails leaves the batch as it was before. If the device is lost, all calls that need it
/// return MSPRING_ERROR_DEVICE, also those that read.
///
/// The kernel, src/gpu/batch.cl, is derived from the specification (src/SPECIFICATION.md, tests/spec). One difference:
/// if a body is out of bounds, the processor repeats the step, but a device handles each body separately.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_MASSSPRING_GPU_H
#define MASSSPRING_MASSSPRING_GPU_H

#include <massspring/massspring.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Result: there is no OpenCL or no such device, the device is unsuitable, or an OpenCL call failed.
#define MSPRING_ERROR_DEVICE ((mspring_result)-100)

/// Largest number of particles in a body. Its state must also fit into the local memory of the device.
#define MSPRING_GPU_MAX_PARTICLES 1024u

/// Value of mspring_gpu_def.device: the first suitable device, graphics cards first.
#define MSPRING_GPU_ANY 0xffffffffu

/// A batch on a device: many equal bodies, and their state.
typedef struct mspring_gpu mspring_gpu;

/// Definition of a batch, as mspring_gpu_def_default() makes it.
typedef struct mspring_gpu_def {
    uint32_t struct_size;
    uint32_t device;             ///< number of a device (mspring_gpu_describe_devices()); default MSPRING_GPU_ANY
    uint32_t body_count;         ///< at least the number of groups, default 0: that number. Body i begins as group
                                 ///< i % groups, in the same place
    uint32_t changes;            ///< as for mspring_network_set_actuators(), 1 to 256; default 1
    const mspring_id *actuators; ///< [actuator_count] springs of the first body, each once, no welds; default NULL
    uint32_t actuator_count;     ///< default 0
    uint32_t message_size;       ///< bytes of message, its final 0 included; default 0
    char *message;               ///< receives why mspring_gpu_create() failed; default NULL
    const char *library;         ///< path of the OpenCL library; default NULL: the system's
} mspring_gpu_def;

/// Fill a definition with its defaults, struct_size included. In C and C++ mspring_gpu_def_default() is shorter.
/// @param size  sizeof the struct, as your header gives it
/// Threads: any. Allocates: never. Errors: ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_gpu_def_init(mspring_gpu_def *def, size_t size);

#if !defined(MSPRING_NO_INLINE)
/// Return a definition with its defaults.
static inline mspring_gpu_def mspring_gpu_def_default(void) {
    mspring_gpu_def made;
    (void)mspring_gpu_def_init(&made, sizeof made);
    return made;
}
#endif

/// Describe the devices, one line each: number, name and, if it is unsuitable, the reason.
/// @param library  path of the OpenCL library, or NULL: the system's
/// @param text     [size] receives as much of the lines as fits, or the error message
/// Threads: any. Allocates: yes, and frees it; the OpenCL library stays loaded. Errors: ARGUMENT; MEMORY; DEVICE if
/// there is no OpenCL.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gpu_describe_devices(
    const char *library, char *text, size_t size);

/// Create a batch from a network that has groups and has not taken a step yet.
/// The present state is the start, to which mspring_gpu_reset() goes back. The network's own actuators and signals are
/// not read: def has those of the batch.
/// @param batch  receives the batch; free it with mspring_gpu_destroy()
/// Threads: shared for the network, which must not step meanwhile. Allocates: yes; on the device 48 bytes for each
/// particle of the batch, and 24 for each of the network. Errors: ARGUMENT also for a network with something that a
/// batch cannot have (the message names it); STRUCT; LIMIT for more than MSPRING_GPU_MAX_PARTICLES, 65534 springs in a
/// body, 2^32 - 1 particles or actuators, or the local memory of the device; ID or DUPLICATE for an actuator; MEMORY;
/// DEVICE.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gpu_create(
    const mspring_network *network, const mspring_gpu_def *def, mspring_gpu **batch);

/// Destroy a batch. NULL is allowed.
/// Threads: exclusive. Allocates: never.
MSPRING_API void MSPRING_CALL mspring_gpu_destroy(mspring_gpu *batch);

/// Return the message of the last call that failed, or "". It is valid until the next call on the batch. NULL gives "".
/// Threads: exclusive. Allocates: never.
MSPRING_API const char *MSPRING_CALL mspring_gpu_error(const mspring_gpu *batch);

/// Return the number of bodies. NULL gives 0.
/// Threads: shared. Allocates: never.
MSPRING_API uint32_t MSPRING_CALL mspring_gpu_body_count(const mspring_gpu *batch);

/// Step all bodies that are not held, with the network's number of substeps. Waits for the device.
/// If a step takes a body out of bounds (max_speed, MSPRING_MAX_COORDINATE, NaN), the body is held, as a group is. It
/// stays where it was before the step, at rest, until mspring_gpu_reset().
/// @param dt  s, finite, > 0
/// Threads: exclusive. Allocates: never. Errors: ARGUMENT, DEVICE, MEMORY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gpu_step(mspring_gpu *batch, double dt);

/// Put bodies back to their start, and release those that are held. Their signals that no step has used are dropped.
/// @param mask  [mspring_gpu_body_count()] resets bodies whose mask is not 0; NULL: all
/// Threads: exclusive. Allocates: never. Errors: ARGUMENT, DEVICE, MEMORY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gpu_reset(mspring_gpu *batch, const uint8_t *mask);

/// Set signals for the next step, as mspring_network_set() of MSPRING_SIGNAL. Actuator a of body b has number
/// b * actuator_count + a.
/// @param signals  that of actuator first + i in signals[i * stride], 0.01 to 100
/// @param stride   elements from one signal to the next; 0: all have signals[0]
/// Threads: exclusive. Allocates: never. Errors: ID, ARGUMENT (the message names the actuator).
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gpu_set_signals(
    mspring_gpu *batch, uint32_t first, uint32_t count, const float *signals, uint32_t stride);

/// Read the flags of the bodies first ... first + count - 1: MSPRING_GROUP_HELD.
/// @param flags   receives those of body first + i in flags[i * stride]
/// @param stride  elements from one body to the next, at least 1
/// Threads: exclusive. Allocates: yes, and frees it. Errors: ID, ARGUMENT, MEMORY, DEVICE.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gpu_get_flags(
    mspring_gpu *batch, uint32_t first, uint32_t count, uint32_t *flags, uint32_t stride);

/// Observe the bodies first ... first + count - 1 on the device: a row for each, bit for bit that of
/// mspring_network_observe_groups().
/// Columns may be MSPRING_MASS, MSPRING_X to MSPRING_VY and MSPRING_RELATIVE_X to MSPRING_RELATIVE_VY of particles, and
/// all properties of groups. The index of a particle is counted from the first of each body.
/// @param columns  [column_count]; may be NULL if column_count is 0
/// @param rows     receives column c of body first + i in rows[i * stride + c]
/// @param stride   numbers from one row to the next, at least column_count
/// Threads: exclusive. Allocates: yes, and keeps a buffer on the device. Errors: ID; ARGUMENT also for another property
/// (the message names the column); MEMORY, DEVICE.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gpu_observe(mspring_gpu *batch, uint32_t first,
    uint32_t count, const mspring_observation *columns, uint32_t column_count, double *rows, uint32_t stride);

/// Read world positions (m) of the particles first ... first + count - 1. Particle p of body b has the id
/// b * particles + p, as in a network with as many bodies.
/// @param x       receives that of particle first + i in x[i * stride]
/// @param y       the same in y
/// @param stride  elements from one particle to the next, at least 1
/// Threads: exclusive. Allocates: yes, and frees it. Errors: ID, ARGUMENT, MEMORY, DEVICE.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gpu_get_positions(
    mspring_gpu *batch, mspring_id first, uint32_t count, double *x, double *y, uint32_t stride);

/// Read velocities (m/s), half a substep old, as mspring_gpu_get_positions().
/// Threads: exclusive. Allocates: yes, and frees it. Errors: ID, ARGUMENT, MEMORY, DEVICE.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gpu_get_velocities(
    mspring_gpu *batch, mspring_id first, uint32_t count, float *vx, float *vy, uint32_t stride);

/// Hash the state. It is the mspring_network_get_state_hash() of a network with as many bodies. Reads the whole state.
/// Threads: exclusive. Allocates: yes, and frees it. Errors: ARGUMENT, MEMORY, DEVICE.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gpu_get_state_hash(mspring_gpu *batch, uint64_t *hash);

#ifdef __cplusplus
}
#endif

#endif

/// @file massspring_gradient.h
/// Gradients of a loss through explicit steps, by reverse mode: for learning, design and calibration.
///
///     create      gradient_create, _destroy, _error
///     forwards    gradient_step
///     backwards   gradient_add_seeds, _reverse
///     read        gradient_get, _get_signals, _get_forces
///
/// Part `lab`; it also needs the part `batch`. These calls are not frozen yet: a later minor version may change them.
/// massspring.h explains the notation.
///
/// A gradient records steps of a network. Then you give it the seeds, which are the derivatives of your loss by the
/// final state, and it goes back step by step:
///
///     mspring_gradient_create(network, 100, NULL, 0, &gradient);
///     for (i = 0; i < 100; ++i) mspring_gradient_step(gradient, dt, signals[i], NULL);
///     ... compute dL/dx and dL/dy at the end ...
///     mspring_gradient_add_seeds(gradient, NULL, 0, particle_count, seeds, NULL);
///     mspring_gradient_reverse(gradient, 100);
///     mspring_gradient_get(gradient, MSPRING_GRADIENT_STIFFNESS, NULL, 0, spring_count, values, 1);
///
/// If the loss also depends on earlier states, reverse to each of them and add its seeds there.
///
/// **What is differentiated** is the explicit scheme itself (massspring.h, Physics), substep by substep. The number of
/// substeps and dt are constants. States are those of the network, bit for bit; derivatives are in double precision.
/// You get derivatives by the stiffness, damping and rest length of springs, positions and velocities, signals of
/// actuators (batch.h) and forces. A network may have pins, global damping, gravity, and half-planes without
/// friction and restitution. Anything else is rejected with a message that names it.
///
/// **Memory.** A gradient keeps frames (MSPRING_SNAPSHOT_FRAME) of some steps, and the states of all substeps between
/// two frames: 32 bytes for each slot and substep, 16 without dampers and floor. The frames are spaced so that both
/// together take the least memory, which grows as the square root of the steps. Signals, forces and their derivatives
/// are kept for each step.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_MASSSPRING_GRADIENT_H
#define MASSSPRING_MASSSPRING_GRADIENT_H

#include "massspring.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Largest number of steps of a gradient.
#define MSPRING_MAX_GRADIENT_STEPS 0x1000000u

/// A record of steps, and the derivatives of a loss through them.
typedef struct mspring_gradient mspring_gradient;

/// Quantity that the loss is differentiated by. A derivative has the unit of the loss over that of the quantity.
typedef enum mspring_gradient_of {
    MSPRING_GRADIENT_STIFFNESS = 0,   ///< of a spring, N/m; 0 for a broken one
    MSPRING_GRADIENT_DAMPING = 1,     ///< of a spring, N s/m; 0 for a broken one and in a network without dampers
    MSPRING_GRADIENT_REST_LENGTH = 2, ///< of a spring, m; 0 for a broken one; of an actuator: its length before the
                                      ///< earliest step reversed so far
    MSPRING_GRADIENT_X = 3,           ///< of a particle, m: position before the earliest step reversed so far
    MSPRING_GRADIENT_Y = 4,
    MSPRING_GRADIENT_VX = 5, ///< of a particle, m/s: velocity then, as mspring_network_get_velocities() reads it
    MSPRING_GRADIENT_VY = 6,
    MSPRING_GRADIENT_OF_INT = MSPRING_ENUM_INT ///< no value
} mspring_gradient_of;

/// Make a gradient that records steps of a network from its present state on.
/// To go back it steps a clone of the network, so the network keeps its final state. Destroy the gradient before the
/// network. On failure the network has the error message.
/// @param step_count    most steps that can be recorded, 1 to MSPRING_MAX_GRADIENT_STEPS
/// @param forced        [forced_count] particles to which mspring_gradient_step() applies forces, each once; copied
/// @param forced_count  0: none; then forced may be NULL
/// @param gradient      receives the gradient
/// Threads: exclusive for network. Allocates: yes, with the network's allocator. Errors: ARGUMENT also if the network
/// has something without a gradient (the message names it); ID, DUPLICATE in forced; LIMIT, MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gradient_create(mspring_network *network,
    uint32_t step_count, const mspring_id *forced, uint32_t forced_count, mspring_gradient **gradient);

/// Free a gradient. NULL is allowed. The network stays.
/// Threads: exclusive. Allocates: never.
MSPRING_API void MSPRING_CALL mspring_gradient_destroy(mspring_gradient *gradient);

/// Return the error message of the last call; "" if that succeeded. NULL gives "".
/// Threads: shared. Allocates: never.
MSPRING_API const char *MSPRING_CALL mspring_gradient_error(const mspring_gradient *gradient);

/// Step the network and record the step. The state is, bit for bit, that of mspring_network_step() after
/// mspring_network_set() of MSPRING_SIGNAL and mspring_network_apply_forces().
/// Between these calls only read the network. mspring_gradient_reverse() detects most edits, and returns an error.
/// The guard of the step is MSPRING_GUARD_GROWTH, unless the network has MSPRING_GUARD_BOUNDS. So a step that another
/// guard would clamp or repeat fails.
/// @param dt       s, as for mspring_network_step()
/// @param signals  [mspring_network_count(network, MSPRING_ACTUATORS)] 0.01 to 100; NULL: rest lengths stay
/// @param forces   [forced_count][2] x and y, N, during this step; NULL: none
/// Threads: exclusive for gradient and network. Allocates: some steps. Errors: as mspring_network_step(),
/// mspring_network_set() of MSPRING_SIGNAL and mspring_network_apply_forces(); LIMIT after step_count steps; ARGUMENT
/// also after mspring_gradient_reverse(), or if the layout has changed; MEMORY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gradient_step(
    mspring_gradient *gradient, double dt, const float *signals, const float *forces);

/// Add derivatives of the loss by the state before the earliest step reversed so far: at first, the final state.
/// @param ids         [count] particles, or NULL: first ... first + count - 1
/// @param first       place in ids where they begin, or the first id
/// @param positions   [count][2] derivatives by x and y, unit of the loss per m; NULL: none
/// @param velocities  [count][2] derivatives by vx and vy, unit of the loss per m/s; NULL: none
/// Threads: exclusive. Allocates: never. Errors: ID, ARGUMENT also for NaN and infinity.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gradient_add_seeds(mspring_gradient *gradient,
    const mspring_id *ids, mspring_id first, uint32_t count, const double *positions, const double *velocities);

/// Go back by step_count steps. On entering a segment between two frames, its steps are first computed again on the
/// clone.
/// @param step_count  at most the number of steps not reversed yet
/// Threads: exclusive for gradient, shared for network. Allocates: yes. Errors: ARGUMENT also if steps computed again
/// differ because the network was edited between them, or if the floor acted in a corner; UNSTABLE if a derivative is
/// not finite; MEMORY. After any error but a step_count that is too large, destroy the gradient: its derivatives are
/// incomplete.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gradient_reverse(
    mspring_gradient *gradient, uint32_t step_count);

/// Read derivatives of the loss. They include all steps reversed so far.
/// @param of      the quantity
/// @param ids     [count] springs or particles, or NULL: first ... first + count - 1; removed ones read as 0
/// @param first   place in ids where they begin, or the first id
/// @param values  receives the derivative by element i in values[i * stride]
/// @param stride  elements from one value to the next, at least 1
/// Threads: shared. Allocates: never. Errors: ID, ARGUMENT; without a message.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gradient_get(const mspring_gradient *gradient,
    mspring_gradient_of of, const mspring_id *ids, mspring_id first, uint32_t count, double *values, uint32_t stride);

/// Read derivatives of the loss by the signals, or by the forces (N), of a step; 0 if the step is not reversed.
/// The derivative by a signal includes later steps without signals, in which the rest lengths stayed.
/// @param step    number of the step, from 0
/// @param values  receives [mspring_network_count(network, MSPRING_ACTUATORS)], or [forced_count][2] by x and y
/// Threads: shared. Allocates: never. Errors: ID for a step that was not recorded, ARGUMENT; without a message.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gradient_get_signals(
    const mspring_gradient *gradient, uint32_t step, double *values);
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_gradient_get_forces(
    const mspring_gradient *gradient, uint32_t step, double *values);

#ifdef __cplusplus
}
#endif

#endif

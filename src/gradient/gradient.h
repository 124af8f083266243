/// @file gradient.h
/// Reverse mode through explicit steps. In a substep h is its length, t the time for which forces act, and s the
/// share of velocity that global damping takes. f d is the force of a spring, with d from one end to the other:
///
///     v' = (1 - s) v + t/m F(x, v) + t g,   x' = x + h v',   F = sum of f d + forces of the host
///
/// With X and V the derivatives of the loss by x' and v', those by the state before the substep are:
///
///     W = V + h X,   U = t/m W                                by v', by the force on a particle
///     X += sum over springs of dF/dx U,   V = (1 - s) W + sum of dF/dv U
///
/// Arrays are by slot, because rows of a lattice have consecutive slots: springs of one direction join consecutive
/// slots to consecutive slots. Eight of them make an octet, whose positions are loaded without gathering.
///
///   gradient.c          creation, reading
///   gradient_refuse.c   rejection of networks without a gradient
///   gradient_springs.c  octets
///   gradient_tape.c     recorded steps, frames, segments computed again
///   gradient_reverse.c  a step back
///   gradient_floor.c    half-planes, a substep back
///   gradient_kernel.c   springs, a substep back
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_GRADIENT_H
#define MSPRINGI_GRADIENT_H

#include <massspring/massspring.h>
#include <massspring/massspring_gradient.h>

#include <float.h>
#include <string.h>

#include "store/network.h"

/// Springs of an octet.
#define MSPRINGI_OCTET 8u

/// Springs in octets: spring i joins the slots a[i / 8] + i % 8 and b[i / 8] + i % 8. Lanes without a spring have
/// stiffness, damping and rest length 0.
typedef struct mspringi_octets {
    uint32_t count;
    uint32_t *a, *b;                               ///< [count]
    double *stiffness, *damping, *length;          ///< [8 count]; damping is NULL if no spring has any
    double *by_stiffness, *by_damping, *by_length; ///< [8 count] derivatives of the loss
    uint32_t *place;                               ///< [springs] its index in the octets; MSPRING_NONE if not live
} mspringi_octets;

/// Vectors by slot.
typedef struct mspringi_doubles {
    double *x, *y;
} mspringi_doubles;

/// Recorded state before a substep: positions relative to an origin, and velocities, NULL if nothing needs them.
typedef struct mspringi_moment {
    const double *x, *y, *vx, *vy;
    double origin_x, origin_y;
} mspringi_moment;

/// A recorded step.
typedef struct mspringi_past {
    double dt;
    float h, lag, full_lag; ///< as in the network, s
    uint32_t substeps;
    uint32_t first_moment; ///< of its first substep, while its segment is on the tape
    bool has_signals, has_forces;
} mspringi_past;

/// A frame of the network before a step.
typedef struct mspringi_frame {
    void *bytes;
    size_t size;
    uint64_t hash;
} mspringi_frame;

/// Derivatives of the loss, by slot. Springs have separate arrays for their ends a and b: a store to an array is
/// not followed at once by loads that overlap it, which would wait for it.
typedef struct mspringi_adjoint {
    mspringi_doubles position, velocity;       ///< X, V
    mspringi_doubles force;                    ///< U
    mspringi_doubles by_position, by_velocity; ///< what springs add to X and V at their ends b
    double *inverse_mass;                      ///< 1/kg, 0 for pins
    double *is_free;                           ///< 1, 0 for pins
} mspringi_adjoint;

struct mspring_gradient {
    mspringi_memory memory;
    mspringi_message message;
    mspring_network *network; ///< the host's
    mspring_network *clone;   ///< steps segments again
    uint32_t slots, lanes;    ///< slots in use; length of arrays, with room for a last octet
    uint32_t particle_count, spring_count;
    uint64_t layout;                ///< its layout_generation
    uint32_t capacity, count, left; ///< steps: most, recorded, not reversed yet
    bool is_reversing, has_failed;
    bool needs_velocities;
    mspring_simd level; ///< of the kernel
    mspringi_octets octets;
    mspringi_adjoint adjoint;
    double planes[MSPRING_MAX_PLANES][3]; ///< unit normal, and its product with a point on the border
    uint32_t plane_count;
    mspringi_doubles spring_force[2]; ///< F for the floor; NULL without planes

    uint32_t forced_count;
    mspring_id *forced;    ///< [forced_count]
    uint32_t *forced_slot; ///< [forced_count]
    uint32_t actuator_count, changes;
    uint32_t *actuator_place; ///< [actuator_count] in octets
    float *nominal;           ///< [actuator_count] m
    double *by_length;        ///< [actuator_count] derivative by the length before the steps reversed so far
    double *actuator_start;   ///< [actuator_count] the same for the start of the step being reversed

    mspringi_past *past;            ///< [capacity]
    float *signals, *lengths;       ///< [capacity][actuator_count], [capacity + 1][actuator_count]
    float *forces;                  ///< [capacity][forced_count][2]
    double *by_signals, *by_forces; ///< the same shapes: derivatives of the loss
    mspringi_frame *frames;         ///< [capacity / period + 1]
    uint32_t period;                ///< steps from one frame to the next; 0: not known before the first step
    size_t frame_count, frame_capacity;
    double *tape;    ///< [moments][2 or 4][lanes] x, y, vx, vy
    double *origins; ///< [moments][2]
    uint32_t moments, moment_capacity;
    uint32_t segment;  ///< index of the segment on the tape; MSPRING_NONE: none
    uint64_t end_hash; ///< state hash after the last step
};

/* gradient_refuse.c */

/// Reject networks that have no gradient. The network has the message.
mspring_result mspringi_gradient_check(mspring_network *network);

/* gradient_springs.c */

/// Put live springs into octets. Returns false without memory.
bool mspringi_octets_make(mspring_gradient *gradient);

/* gradient_tape.c */

/// Compute the segment that contains a step again, unless it is on the tape.
mspring_result mspringi_tape_play(mspring_gradient *gradient, uint32_t step);
/// Return the state at an index of the tape.
mspringi_moment mspringi_tape_moment(const mspring_gradient *gradient, uint32_t index);

/* gradient_floor.c */

/// Times and damping of a substep.
typedef struct mspringi_times {
    double h, kick, gravity_kick; ///< s
    double loss;                  ///< share that global damping takes
} mspringi_times;

/// Take the derivatives by the state after a substep back through the floor. forces: those of the host, or NULL.
/// Returns MSPRING_NONE, or the slot of a particle whose landing differs from that of the network.
uint32_t mspringi_gradient_floor(mspring_gradient *gradient, const mspringi_moment *before,
                                 const mspringi_moment *after, const mspringi_times *times, const float *forces);

/* gradient_kernel.c */

/// Take derivatives by the state after a substep back to those by the state before it, and add those by parameters.
void mspringi_gradient_go_back(mspring_gradient *gradient, const mspringi_moment *at, const mspringi_times *times);
/// Add the forces of springs to spring_force.
void mspringi_octets_forces(mspring_gradient *gradient, const mspringi_moment *at);

#endif

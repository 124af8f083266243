/// @file floor.h
/// What particles cannot get through: half-planes and a field of heights.
///
///   floor.c      the definition, given by the host
///   floor_surface.c    where the surface is, and which way it faces
///   floor_clearance.c     how far it is from strips and from the whole network
///   floor_bounce.c     what it does to a particle in a substep of symplectic Euler, and to one without springs
///   floor_explicit.c   the same of all particles of such substeps
///   floor_implicit.c    what it does to particles with springs after an implicit substep; see
///   solvers/implicit/implicit_floor.c silt.c       what silt above the heights does to a particle;
///   kernels/silt_kernel.h has blocks of them
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_FLOOR_H
#define MSPRINGI_FLOOR_H

#include "kernels/bounce_kernel.h"
#include "store/network.h"

typedef struct mspringi_half_plane {
    double x, y;   ///< a point on its border, world coordinates
    double nx, ny; ///< of length 1
} mspringi_half_plane;

/// Enough to come from MSPRING_MAX_HEIGHTS heights to one.
#define MSPRINGI_HEIGHT_LEVELS 27

/// Straight lines from (x + i spacing, y + heights[i]) to the next; level beyond both ends.
typedef struct mspringi_heights {
    double x, y, spacing; ///< world coordinates
    double local_x, local_y;
    uint32_t count; ///< 0: there are none
    float *heights;
    double *normals;                        ///< [count - 1][2] of each straight part
    float *frictions, *restitutions;        ///< [count - 1] likewise; NULL: all have the floor's
    double friction, restitution;           ///< the floor's
    double silt_depth, silt_rate;           ///< m and 1/s; if either is 0 there is none
    float *highest[MSPRINGI_HEIGHT_LEVELS]; ///< [level][i]: the highest of 2^level of them from i 2^level on;
                                            ///< highest[0] is heights
} mspringi_heights;

/// What is clear of the surface, for the slots of a strip.
typedef struct mspringi_clearance {
    mspringi_bounds clear; ///< no surface is in it, and no silt
    float bare;            ///< no surface is in a box that begins here, instead of at clear.min_y
    bool is_far;           ///< the strip cannot come out of it in the substeps that this was made for
} mspringi_clearance;

/// A particle and a straight surface that it touches, or may touch, in an implicit substep.
typedef struct mspringi_floor_contact {
    uint32_t slot;
    bool is_active;   ///< it is held
    double slip;      ///< it slides this way along the surface, 1 or -1; 0: it sticks
    double nx, ny;    ///< across the surface
    double friction;  ///< of it
    double gap;       ///< distance where it is predicted, m
    double ahead;     ///< how far it is predicted to come along the surface, m
    double stiffness; ///< of what holds it, in the units of the matrix
    double normal;    ///< what holds it across the surface, in the units of the right-hand side
    double along;     ///< what brakes it along the surface, likewise
} mspringi_floor_contact;

typedef struct mspringi_floor {
    mspringi_half_plane planes[MSPRING_MAX_PLANES];
    double given[MSPRING_MAX_PLANES][4];         ///< the same, as the host gave them
    float *plane_frictions, *plane_restitutions; ///< [plane_count] of these; NULL: all have the next two
    mspringi_line lines[MSPRING_MAX_PLANES];     ///< the same, local
    uint32_t plane_count;
    mspringi_heights heights;
    double friction, restitution;
    mspringi_clearance *clearances; ///< [strip_count]
    mspringi_field start;           ///< [slot_count] positions before an implicit substep, m
    mspringi_state before;  ///< [slot_count] before a substep: velocities, or all of particles without springs
    mspringi_field impulse; ///< [slot_count] N s on each slot in the last step
    mspringi_field previous_impulse; ///< [slot_count] in the step before it, as long as one is made
    size_t slot_count;
    double reach;           ///< twice as far, m, as anything may come in the substeps of the last survey
    bool is_near;           ///< some strip may come near in these, or there was no survey yet
    bool is_missed;         ///< forces have driven a strip further than the survey had thought
    bool is_second_try;     ///< so this time none is left out
    mspringi_safe_box room; ///< that all of the network was in
    mspringi_bounds clear;  ///< where no surface is, around the network as it was before an implicit substep
    mspringi_floor_contact *contacts; ///< of an implicit substep
    uint32_t contact_count, contact_capacity;
    bool is_in_coarse; ///< some are in the coarse matrix
    bool has_impulse;  ///< impulse is not all zero
    bool had_impulse;  ///< former is not all zero
} mspringi_floor;

/// A particle that has moved from its start in a substep, local coordinates.
typedef struct mspringi_moved_particle {
    double start_x, start_y, x, y, vx, vy;
} mspringi_moved_particle;

void mspringi_floor_destroy(mspringi_floor *floor, mspringi_memory *memory);

/// Make the floor of another network, which has the same particles in another layout; the two share the definition.
/// NULL if there is no memory.
mspringi_floor *mspringi_floor_move(mspring_network *to, const mspring_network *from);

/// Free a floor that shares its definition with another. NULL is allowed.
void mspringi_floor_free_layout(mspringi_floor *floor, mspringi_memory *memory);

/// Go back to the impulses of the step before the one that was begun last. NULL is allowed.
void mspringi_floor_roll_back(mspringi_floor *floor);
/// Forget what pushed the particle in a slot: it is another one from now on.
void mspringi_floor_clear_slot(const mspringi_floor *floor, uint32_t slot);

/* floor_surface.c */

/// Have lines and heights follow the local origin.
void mspringi_floor_set_origin(mspringi_floor *floor, double origin_x, double origin_y);

/// Distances below which a particle at (x, y) touches a surface: some last places of its coordinates.
double mspringi_floor_slop(double x, double y);

/// The straight parts of a field of heights are numbered by their left ends; the level ones beyond its ends are -1
/// and count - 1.
mspringi_line mspringi_heights_line(const mspringi_heights *heights, int64_t part);

/// The part that is below x.
int64_t mspringi_heights_segment_below(const mspringi_heights *heights, double x);

/// The part that a particle on its way from (start_x, start_y) to (x, y) meets or, if it meets none, the one that
/// is below it at the end.
int64_t mspringi_heights_first_hit(const mspringi_heights *heights, double start_x, double start_y, double x,
                                   double y);

/// Height of the highest knot between two x, and of the next ones beyond them.
double mspringi_heights_highest(const mspringi_heights *heights, double low, double high);

/// Smallest distance from any surface, < 0 where particles cannot be. (That of a point above the heights is the one
/// from the line below it.)
double mspringi_floor_distance(const mspringi_floor *floor, double x, double y);

/* floor_clearance.c */

/// Look how far every strip is from the surface, and which of them stay clear of it for so many seconds.
void mspringi_floor_update_clearances(mspring_network *network, double seconds);

/// Whether a block of a strip that may come near the surface may do so itself, in the same substeps.
bool mspringi_floor_is_near_block(const mspring_network *network, const mspringi_strip *strip, uint32_t block);

/// Whether nothing can come near the surface in a step of so many seconds. The clearances of the last survey then
/// say so of every strip, too.
bool mspringi_floor_is_out_of_reach(mspring_network *network, double seconds);

/// After that step, of substeps of h: whether nothing did, by bounds of what it has led to.
bool mspringi_floor_was_out_of_reach(const mspring_network *network, float h, mspringi_extrema seen);

/// The same of other surfaces, whose lines are local, and a room of theirs; way is what a particle may have gone at
/// the highest speed.
bool mspringi_safe_box_suffices(const mspring_network *network, const mspringi_floor *surfaces,
                                mspringi_safe_box *room, double seconds);
bool mspringi_safe_box_sufficed(const mspring_network *network, const mspringi_safe_box *room, double way,
                                mspringi_extrema seen);

/* floor_bounce.c */

/// Have a point that is inside the surface put onto it. Returns whether it was.
bool mspringi_floor_put_outside(const mspringi_floor *floor, double *x, double *y);

/// Let the surface act on a particle that a substep of symplectic Euler of h seconds moves from (x, y) at (vx, vy),
/// and came there at (from_vx, from_vy). Returns false if it does nothing; else it ends at p->x + h p->vx.
bool mspringi_floor_bounce(const mspringi_floor *floor, double h, double from_vx, double from_vy,
                           mspringi_bouncing_particle *p);

/// Let a particle without springs fly past the surface for p->left seconds. Returns whether that did anything;
/// (*vx, *vy) is the velocity of how->skew ago.
bool mspringi_floor_move_free_particle(const mspringi_floor *floor, const mspringi_bounce_params *how,
                                       mspringi_free_particle *p, double *vx, double *vy);

/* silt.c */

static inline bool mspringi_has_silt(const mspringi_heights *heights) {
    return heights->count > 0 && heights->silt_depth > 0.0 && heights->silt_rate > 0.0;
}

/// The share of its velocity that silt takes from a particle at (x, y), if there is any, in so many seconds.
double mspringi_silt_damping(const mspringi_heights *heights, double x, double y, double seconds);

/// Let it act on a particle after a substep of h seconds.
void mspringi_silt_brake(const mspring_network *network, size_t slot, double h);

/* floor_explicit.c */

/// Whether a strip may come near the surface in the substeps that the last survey was for.
bool mspringi_floor_is_near(const mspring_network *network, const mspringi_strip *strip);

/// Before substeps of symplectic Euler: keep the velocities of whole blocks. Those of a strip that stays clear are
/// left out, here and in what follows.
void mspringi_floor_save_velocities(const mspring_network *network, const mspringi_strip *strip,
                                    const mspringi_span *spans, uint32_t span_count);

/// Let the surface act on the particles of whole blocks that a substep of h seconds has moved: on those with
/// springs, or on those without.
void mspringi_floor_apply(const mspring_network *network, const mspringi_strip *strip, const mspringi_span *spans,
                          uint32_t span_count, float h);
void mspringi_floor_apply_loose(const mspring_network *network, const mspringi_strip *strip,
                                const mspringi_span *span, float h);

/// Look whether the strips that were left out have stayed clear.
void mspringi_floor_check_clear(const mspring_network *network);

/// Whether no spring pulls at a particle, in a network with another solver: it is in the loose row, or all its
/// springs broke. (A clamped one knows of those in the loose row alone.)
bool mspringi_floor_is_isolated(const mspring_network *network, size_t slot);

/// Of a network with another solver: keep the particles without springs as they are, and take so many substeps of
/// theirs alone from there, in force fields as these: exact parabolas, for nothing else moves them.
void mspringi_floor_save_isolated(const mspring_network *network);
void mspringi_floor_step_isolated(mspring_network *network, float h, mspringi_field base, uint32_t count);

/* floor_implicit.c */

/// Let the surface act on a body that an implicit substep of h seconds has moved.
void mspringi_floor_collide(const mspringi_floor *floor, mspringi_moved_particle *body, double h);

/// Keep the positions before an implicit substep of h, and let the surface act after it on particles with springs.
void mspringi_floor_save_positions(mspring_network *network, float h);
void mspringi_floor_apply_all(mspring_network *network, float h);

/// Let silt act on them after that.
void mspringi_floor_apply_silt(const mspring_network *network, float h);

#endif

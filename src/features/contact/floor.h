/// @file floor.h
/// Floor: half-planes and a field of heights that particles cannot enter.
///
///   floor.c            definition, set by the host; memory
///   floor_surface.c    surface: distances, straight parts, first hit
///   floor_clearance.c  distance from strips and from the whole network
///   floor_bounce.c     bounce of one particle
///   floor_explicit.c   floor in explicit substeps, and particles without springs
///   floor_implicit.c   floor after an implicit substep; within it: solvers/implicit/implicit_floor.c
///   floor_support.c    floor below bodies in contact
///   silt.c             silt above the heights; kernels/silt_kernel.h for whole blocks
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_FLOOR_H
#define MSPRINGI_FLOOR_H

#include "kernels/bounce_kernel.h"
#include "store/network.h"
#include "store/safe_box.h"

/// Largest coefficient of friction: of the floor, of contact and of colliders.
#define MSPRINGI_MOST_FRICTION 1e6

typedef struct mspringi_half_plane {
    double x, y;   ///< a point on its border, world coordinates
    double nx, ny; ///< of length 1
} mspringi_half_plane;

/// Levels of the maximum pyramid over MSPRING_MAX_HEIGHTS heights.
#define MSPRINGI_HEIGHT_LEVELS 27

/// Field of heights: straight lines from (x + i spacing, y + heights[i]) to the next; level beyond both ends.
typedef struct mspringi_heights {
    double x, y, spacing; ///< world coordinates
    double local_x, local_y;
    uint32_t count; ///< 0: no heights
    uint32_t given; ///< by the host: one is kept as two
    float *heights;
    double *normals;                        ///< [count - 1][2] of each straight part
    float *frictions, *restitutions;        ///< [count - 1] of each straight part; NULL: all have the floor's
    double friction, restitution;           ///< the floor's
    float *silt_depths;                     ///< [count] m; NULL: silt_depth everywhere
    double silt_depth, silt_rate;           ///< m, the largest of silt_depths, and 1/s; no silt if either is 0
    float *highest[MSPRINGI_HEIGHT_LEVELS]; ///< [level][i]: the highest of 2^level of them from i 2^level on;
                                            ///< highest[0] is heights
} mspringi_heights;

/// Clearance of a strip's slots.
typedef struct mspringi_clearance {
    mspringi_bounds clear; ///< box without surface and silt
    float bare;            ///< lower bound of a box without surface, instead of clear.min_y
    bool is_far;           ///< the strip stays in it for the substeps of the last survey
} mspringi_clearance;

/// Most surfaces with constraints of one particle in an implicit substep, the nearest ones. Two fix its position.
#define MSPRINGI_MAX_FLOOR_CONTACTS 2u

/// Most particles with constraints for a second surface: those near corners. Others have them for the nearest
/// surface only. mspringi_floor_apply_all() keeps particles out of all surfaces after the substep.
static inline size_t mspringi_floor_max_second_contacts(size_t particles) {
    const size_t most = particles / 4 + 64;
    return most < particles ? most : particles;
}

typedef struct mspringi_floor {
    mspringi_half_plane planes[MSPRING_MAX_PLANES];
    double given[MSPRING_MAX_PLANES][4];         ///< definition of the host
    float *plane_frictions, *plane_restitutions; ///< [plane_count]; NULL: all have those of the floor
    mspringi_line lines[MSPRING_MAX_PLANES];     ///< in local coordinates
    uint32_t plane_count;
    mspringi_heights heights;
    double friction, restitution;   ///< of surfaces without their own
    mspringi_clearance *clearances; ///< [strip_count], and behind them the marks of blocks: floor_explicit.c
    mspringi_field start;           ///< [slot_count] positions before an implicit substep, m
    mspringi_state before;  ///< [slot_count] before a substep: velocities, or all of particles without springs
    mspringi_field impulse; ///< [slot_count] on each slot in the last step, or in the present one so far, N s
    mspringi_field previous_impulse; ///< [slot_count] in the step before, while a step is taken
    size_t slot_count;
    double seconds;         ///< length of the substeps of the last survey or of the step out of reach, s
    double reach;           ///< twice the longest way in the substeps of the last survey, m
    bool is_near;           ///< a strip may reach the surface in them, or there was no survey yet
    bool is_missed;         ///< forces moved a strip farther than the survey assumed: repeat the step
    bool is_second_try;     ///< repeated step: no strip is left out
    mspringi_safe_box safe; ///< safe box of the whole network
    mspringi_bounds clear;  ///< box without surface around the network before an implicit substep
    bool has_impulse;       ///< impulse is not all zero
    bool had_impulse;       ///< previous_impulse is not all zero
} mspringi_floor;

/// Particle with its start and its end of a substep, local coordinates.
typedef struct mspringi_moved_particle {
    double start_x, start_y, x, y, vx, vy;
    const mspringi_contact_material *own; ///< NULL: none
} mspringi_moved_particle;

/// Restore the impulses of the previous step. NULL is allowed.
void mspringi_floor_roll_back(mspringi_floor *floor);
/// Clear the impulses of a slot, because another particle takes it.
void mspringi_floor_clear_slot(const mspringi_floor *floor, uint32_t slot);

/* contact_materials.c */

/// A particle's own friction and restitution; NULL if no particle has any.
const mspringi_contact_material *mspringi_contact_own(const mspring_network *network, size_t slot);
static inline const mspringi_contact_material *mspringi_own_of(const mspring_network *network, size_t slot) {
    return network->contacts ? mspringi_contact_own(network, slot) : NULL;
}

/// Friction and restitution of a surface and a particle.
static inline double mspringi_friction_on(const mspringi_line *line, const mspringi_contact_material *own) {
    return own ? mspringi_mixed_friction(line->friction, own) : line->friction;
}
static inline double mspringi_restitution_on(const mspringi_line *line, const mspringi_contact_material *own) {
    return own ? mspringi_mixed_restitution(line->restitution, own) : line->restitution;
}

/* floor_surface.c */

/// Move lines and heights to the local origin.
void mspringi_floor_set_origin(mspringi_floor *floor, double origin_x, double origin_y);

/// Distance below which a particle at (x, y) touches a surface: rounding of its coordinates.
double mspringi_floor_slop(double x, double y);

/// Signed distance from a straight surface, < 0 inside.
static inline double mspringi_distance_from_line(const mspringi_line *line, double x, double y) {
    return line->nx * x + line->ny * y + line->offset;
}

/// Most passes over all surfaces for one particle. Corners need more than one.
#define MSPRINGI_FLOOR_ROUNDS 4

/// The straight parts of a field of heights are numbered by their left ends; the level ones beyond its ends are -1
/// and count - 1.
mspringi_line mspringi_heights_line(const mspringi_heights *heights, int64_t part);

/// Part below x.
int64_t mspringi_heights_find_part(const mspringi_heights *heights, double x);

/// First part that a particle meets from (start_x, start_y) to (x, y); if it meets none, the part below the end.
int64_t mspringi_heights_first_hit(const mspringi_heights *heights, double start_x, double start_y, double x,
                                   double y);

/// Largest height between two x, their next knots included.
double mspringi_heights_highest(const mspringi_heights *heights, double low, double high);

/// Smallest signed distance from a surface, < 0 inside. Above the heights, the line below (x, y) counts.
double mspringi_floor_distance(const mspringi_floor *floor, double x, double y);

/* floor_clearance.c */

/// Survey: find the clearance of each strip, and the strips that stay clear for `seconds`.
void mspringi_floor_update_clearances(mspring_network *network, double seconds);

/// Lanes of a block of loose particles, of a strip near the surface, that may reach it in the same substeps: by
/// their own motion, so that no bits depend on the other lanes.
uint32_t mspringi_floor_near_lanes(const mspring_network *network, const mspringi_strip *strip, uint32_t block,
                                   const struct mspringi_sweep *sweep);

/// True if no particle can reach the surface in a step of `seconds`. Then the clearances of the last survey hold
/// for each strip, too.
bool mspringi_floor_is_out_of_reach(mspring_network *network, double seconds);

/// True if no particle did reach it in that step of substeps of h, by bounds from the outcome. This misses a
/// particle that forces drive into the surface and out again within the step, if all are as slow at both ends of it
/// as assumed.
bool mspringi_floor_was_out_of_reach(const mspring_network *network, float h, mspringi_extrema seen);

/// The same for any surfaces in local coordinates, as those of hooks: true if no particle can reach them in a step
/// of `seconds`; true if none did. A safe box that is too small for the step is found anew. way: that of a particle
/// at the largest speed in the step, m.
bool mspringi_safe_box_suffices(const mspring_network *network, const mspringi_floor *surfaces,
                                mspringi_safe_box *safe, double seconds);
bool mspringi_safe_box_sufficed(const mspring_network *network, const mspringi_safe_box *safe, double way,
                                mspringi_extrema seen);

/* floor_bounce.c */

/// Project a point inside the floor onto the surface. Return true if it was inside.
bool mspringi_floor_put_outside(const mspringi_floor *floor, double *x, double *y);

/// Bounce a particle that a leapfrog substep of h seconds moves from (x, y) at (vx, vy), and that came
/// there at (from_vx, from_vy). Return false if nothing happens; else it ends at p->x + h p->vx.
bool mspringi_floor_bounce(const mspringi_floor *floor, double h, double from_vx, double from_vy,
                           mspringi_bouncing_particle *p);

/// Move a free particle past the surface for p->left seconds. Return true if it bounced. (*vx, *vy) is the velocity
/// of how->skew ago.
bool mspringi_floor_move_free_particle(const mspringi_floor *floor, const mspringi_bounce_params *how,
                                       mspringi_free_particle *p, double *vx, double *vy);

/* silt.c */

static inline bool mspringi_has_silt(const mspringi_heights *heights) {
    return heights->count > 0 && heights->silt_depth > 0.0 && heights->silt_rate > 0.0;
}

/// Share of the velocity that silt removes from a particle at (x, y) in `seconds`.
double mspringi_silt_damping(const mspringi_heights *heights, double x, double y, double seconds);

/// Brake a particle in silt after a substep of h seconds.
void mspringi_silt_brake(const mspring_network *network, size_t slot, double h);

/* floor_explicit.c */

/// Mark the blocks of a strip near heights in which a particle is not clear.
void mspringi_floor_mark_blocks(const mspring_network *network, const mspringi_strip *strip);

/// True if a strip may reach the surface in the substeps of the last survey.
bool mspringi_floor_is_near(const mspring_network *network, const mspringi_strip *strip);

/// Save the velocities of whole blocks before explicit substeps. Strips that stay clear are left out, here and
/// below.
void mspringi_floor_save_velocities(const mspring_network *network, const mspringi_strip *strip,
                                    const mspringi_span *spans, uint32_t span_count);

/// Apply the floor to the particles of whole blocks after an explicit substep: to those with springs, or to those
/// without.
void mspringi_floor_apply(const mspring_network *network, const mspringi_strip *strip, const mspringi_span *spans,
                          uint32_t span_count, const mspringi_sweep *substep);
void mspringi_floor_apply_loose(const mspring_network *network, const mspringi_strip *strip,
                                const mspringi_span *span, const mspringi_sweep *substep);

/// Check that the strips left out have stayed clear.
void mspringi_floor_check_clear(const mspring_network *network);

/// True if no spring acts on a particle, with a solver other than the explicit one: a loose particle, or one with
/// broken springs only. (With the clamped solver, loose ones only.)
bool mspringi_floor_is_isolated(const mspring_network *network, size_t slot);

/// Save the isolated particles, then take `count` substeps of theirs alone in these force fields: exact parabolas.
/// For solvers other than the explicit one.
void mspringi_floor_save_isolated(const mspring_network *network);
void mspringi_floor_step_isolated(mspring_network *network, float h, mspringi_field base, uint32_t count);

/* floor_implicit.c */

/// Apply the surface to a particle that an implicit substep of h seconds has moved.
void mspringi_floor_collide(const mspringi_floor *floor, mspringi_moved_particle *body, double h);

/// Before an implicit substep of h, or an interval: save the positions, survey the strips, and find the clear box
/// of the network. Constraints, intervals and mspringi_floor_apply_all() need them.
void mspringi_floor_save_positions(mspring_network *network, float h);
/// After it: apply the floor to particles with springs.
void mspringi_floor_apply_all(mspring_network *network, float h);

/// End an interval of h seconds, after mspringi_floor_apply_all(): brake particles in silt.
void mspringi_floor_end_interval(const mspring_network *network, float h);

/// Impulse that a slot had from the floor in the last step, N s, in x (axis 0) or y.
float mspringi_floor_impulse_of(const mspring_network *network, uint32_t slot, int axis);

#endif

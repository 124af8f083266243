/// @file contacts.h
/// Contact between bodies, and of a body with itself: outline points against outline edges with a thickness.
///
/// contact_state.h has the data. In the order of a step:
///
///   contacts.c           definition of contact, set by the host; memory
///   contact_room.c       room for pairs and constraints, and more of it
///   outline.c            outline: edges and points
///   edge_grid.c          broad phase: edges in a hashed grid
///   point_speeds.c       speeds of outline points, and the margins that follow
///   pair_list.c          Verlet list of near pairs, candidates, substeps without contact
///   inner_points.c       inner particles of bodies that are flat on a collider
///   contact_ranges.c     ranges of points, pairs and constraints for the workers
///   constraints.c        narrow phase: contact constraints of an interval, in a fixed order
///   contact_solver.c     intervals of a substep, and motion in them
///   gauss_seidel.c       impulses: projected Gauss-Seidel
///   penetration.c        more sweeps of constraints that would get deeper
///   relaxation.c         explicit solver: velocities without what pushed overlaps apart
///   floor_support.c      floor below bodies, in the same sweeps
///   contact_events.c     begin and end events for the host
///   contact_stage.c      stage: when to scan
///   piles.c              islands that lie on each other sleep and wake together
///   contact_materials.c  friction and restitution of single particles
///   colliders.c          shapes of the host: adding, moving, reading
///   collider_motion.c    motion of colliders in a step, and impulses on them
///   snapshot_contact.c, archive_contact.c
///
/// *Across* is along the normal of a contact, *along* is along its tangent. A *touch* is the impulse across that a
/// particle was given in a step.
///
/// Order of a substep: forces, velocities, positions, contact. Constraints take positions from before the substep
/// and velocities from after it, and correct both.
///
/// An *interval* is a part of a substep, often all of it. A *node* is a particle or a collider point. A *pair* is a
/// point near an edge, a *candidate* a pair that may touch before the next scan. A *constraint* is a candidate that
/// may touch in an interval. An *ongoing contact* joins a particle to another body or a collider, for events.
///
/// State kept between steps follows from positions and from the shape of the outline. Lists hold spare pairs.
/// Results do not depend on when a list was made.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CONTACTS_H
#define MSPRINGI_CONTACTS_H

#include <math.h>

#include "features/contact/contact_state.h"
#include "store/things.h"

static inline bool mspringi_contact_is_rejected(const mspringi_contacts *contacts) {
    return contacts->rejection != MSPRINGI_CONTACT_SOUND;
}

/// Reject the step, for the first reason that is found.
static inline void mspringi_contact_reject(mspringi_contacts *contacts, mspringi_contact_rejection why) {
    if (contacts->rejection == MSPRINGI_CONTACT_SOUND)
        contacts->rejection = why;
}

/// Comparisons of points and edges allowed to a step: 75 ms. More are allowed with each list (pair_list.c), each
/// constraint (contact_solver.c) and each implicit substep (solvers/implicit/work.c).
#define MSPRINGI_MOST_COMPARISONS ((uint64_t)3 << 20)

/// Reject the step if it has taken too much work.
static inline void mspringi_contact_check_work(mspringi_contacts *contacts) {
    if (contacts->work > contacts->most_work)
        mspringi_contact_reject(contacts, MSPRINGI_CONTACT_LACKS_WORK);
}

/// Edges at a particle that cost nothing to visit. More count as comparisons: hubs of thousands would take their
/// square.
#define MSPRINGI_FREE_EDGES 64u

/// Count visits of constraints: three take as long as a comparison of a point with an edge.
static inline void mspringi_contact_count_constraints(mspringi_contacts *contacts, uint64_t visits) {
    contacts->work += visits / 3;
}

/// Count visits of outline edges at one particle.
static inline void mspringi_contact_count_visits(mspringi_contacts *contacts, uint32_t visits) {
    if (visits <= MSPRINGI_FREE_EDGES)
        return;
    contacts->work += visits;
    mspringi_contact_check_work(contacts);
}

/* contact_ranges.c */

/// Range of points, pairs, candidates or constraints.
typedef struct mspringi_contact_range {
    uint32_t number, of;    ///< number of the range, and of all ranges
    uint32_t first, end;    ///< the things in it
    uint32_t found, missed; ///< pairs or constraints that it found; near misses
} mspringi_contact_range;

/// Most ranges.
#define MSPRINGI_CONTACT_RANGES 64u

/// The work on a range. If there are several, each gets a copy of the contact, with scratch of its own: of the copy
/// only rejection, work, fastest and has_push are kept.
typedef void (*mspringi_contact_range_fn)(const mspring_network *network, mspringi_contacts *contacts,
                                          mspringi_contact_range *range, const void *argument);

/// Reserve scratch for each worker's share, when contact is made, and for the workers of a clone.
bool mspringi_contact_reserve_ranges(mspring_network *network, mspringi_contacts *made);
/// Forget all stamps: springs have broken.
void mspringi_contact_clear_stamps(mspringi_contacts *contacts);
/// Do the work on `count` things, at least `least` of them by a worker. If one rejects the step, or all find more
/// than there is room for, one range does it all again, so that the end is that of one worker. Return the number of
/// ranges. Without threads it is 1, and code for more is left out.
#if defined(MSPRINGI_THREADS)
uint32_t mspringi_contact_divide(const mspring_network *network, mspringi_contacts *contacts, uint32_t count,
                                 uint32_t least, uint32_t room, mspringi_contact_range_fn fn, const void *argument,
                                 mspringi_contact_range ranges[MSPRINGI_CONTACT_RANGES]);
#else
static inline uint32_t mspringi_contact_divide(const mspring_network *network, mspringi_contacts *contacts,
                                               uint32_t count, uint32_t least, uint32_t room,
                                               mspringi_contact_range_fn fn, const void *argument,
                                               mspringi_contact_range ranges[MSPRINGI_CONTACT_RANGES]) {
    (void)least, (void)room;
    ranges[0] = (mspringi_contact_range){.of = 1, .end = count};
    fn(network, contacts, &ranges[0], argument);
    return 1;
}
#endif

/* outline.c */

/// Remove a slot from the shape, because another particle takes it.
void mspringi_outline_clear_slot(const mspring_network *network, uint32_t slot);
/// Add a particle to the shape at its present position: when contact is set, and when the particle is added.
void mspringi_outline_take_in(const mspring_network *network, mspringi_outline *outline, mspring_id particle);
/// Find the outline, or update it after edits. Allocates nothing.
void mspringi_outline_update(const mspring_network *network, mspringi_contacts *contacts);
/// Find the ends of a spring, by rising id.
void mspringi_outline_ends(const mspring_network *network, mspring_id spring, mspring_id ends[2]);
/// True if two particles are equal or at most two live springs apart. Cheapest for consecutive calls with the same
/// p.
bool mspringi_outline_are_neighbours(const mspring_network *network, mspringi_contacts *contacts, mspring_id p,
                                     mspring_id q);

/* edge_grid.c */

/// Sort the edges into cells, by their margins.
void mspringi_edge_grid_fill(const mspring_network *network, mspringi_contacts *contacts);
/// Find edges that may form a pair with a point. Return their number.
uint32_t mspringi_edge_grid_search(const mspring_network *network, mspringi_contacts *contacts, mspring_id p);

/* point_speeds.c */

/// Allowed growth until the next scan: of the speed, as a factor; of the way in a step, as a share of the
/// thickness.
#define MSPRINGI_SPEED_MARGIN 1.5
#define MSPRINGI_DRIFT_FRACTION 0.05

static inline mspringi_closest_point mspringi_closest_point_on_edge(double px, double py, double ax, double ay,
                                                                    double bx, double by) {
    const double ex = bx - ax, ey = by - ay, square = ex * ex + ey * ey;
    // Clamped without branches, which nothing could predict.
    const double along = (px - ax) * ex + (py - ay) * ey, ahead = 0.5 * (along + fabs(along)),
                 nearest = ahead < square ? ahead : square, share = square > 0.0 ? nearest / square : 0.0;
    return (mspringi_closest_point){px - ax - share * ex, py - ay - share * ey, share};
}

static inline double mspringi_bound_at(const mspringi_speed_bound *bound, double speed) {
    return bound->at_rest + bound->per_speed * speed;
}

/// Find positions of all points, their speeds, and their displacements since the list was made.
void mspringi_points_measure(const mspring_network *network, mspringi_contacts *contacts);
/// Choose the substeps until the next scan, and how fast points count at least.
void mspringi_points_choose_margins(const mspring_network *network, mspringi_contacts *contacts);
/// Margin that a point of this speed needs in the list, m.
double mspringi_point_margin(const mspringi_contacts *contacts, double speed);

/// Larger value of both ends of an edge.
static inline double mspringi_max_of_ends(const mspringi_contacts *contacts, const double *values, uint32_t edge) {
    const double a = values[contacts->outline.a[edge]], b = values[contacts->outline.b[edge]];
    return a > b ? a : b;
}
/// Largest speed at which both sides of a pair may approach, m/s.
static inline double mspringi_speeds_of(const mspringi_contacts *contacts, const double *speed,
                                        const mspringi_pair *pair) {
    return speed[pair->point] + mspringi_max_of_ends(contacts, speed, pair->edge);
}
static inline double mspringi_margin_of_edge(const mspringi_contacts *contacts, uint32_t edge) {
    return mspringi_max_of_ends(contacts, contacts->margin, edge);
}

/* pair_list.c */

/// Make a new list if pairs may be missing, and collect the candidates. is_missed becomes true if a pair could have
/// touched that had no constraints: any in the last `quiet` substeps, or one that was no candidate in those with
/// contact since the last scan. Then the step's repetition assumes the speeds of now. Return false if the step is
/// rejected.
bool mspringi_pair_list_refresh(const mspring_network *network, mspringi_contacts *contacts, uint32_t quiet);
/// Find is_missed without a scan, after substeps with contact.
void mspringi_pair_list_check_speeds(const mspring_network *network, mspringi_contacts *contacts);
/// Refresh the list unless nothing moved since the last scan, and count the quiet substeps. Return false if the
/// step is rejected.
bool mspringi_pair_list_scan(const mspring_network *network, mspringi_contacts *contacts, uint32_t quiet);
/// Drop the list, and begin to look for pairs nearer than `reach`, m, for piles. No room for pairs and no work of
/// the step bounds that, so that a network that loads a snapshot finds the piles of the one that saved it.
void mspringi_near_begin(const mspring_network *network, mspringi_contacts *contacts, double reach);
/// Find the edges that a point forms such pairs with, in grid.found. Return their number; 0 if all took too long.
uint32_t mspringi_near_edges(const mspring_network *network, mspringi_contacts *contacts, mspring_id p);
/// True if layers, masks and groups let two nodes touch.
bool mspringi_may_touch(const mspring_network *network, mspring_id p, mspring_id q);

/* constraints.c */

/// Near misses: pairs out of reach by less than this share of the thickness. Small impulses may bring them in
/// reach.
#define MSPRINGI_NEAR_MISS_FRACTION 0.01

/// Load the nodes before a substep, with no motion by contact yet.
void mspringi_contact_begin_substep(const mspring_network *network, mspringi_contacts *contacts);
/// Load positions, start velocities (v_start) and masses of the nodes, as they are now.
void mspringi_contact_load_nodes(const mspring_network *network, mspringi_contacts *contacts);
/// Make the constraints of an implicit interval of h seconds, with a larger reach, because springs and other bodies
/// may push in it. Return the largest speed, m/s.
double mspringi_contact_prepare_implicit(const mspring_network *network, mspringi_contacts *contacts, double h);
/// Make the constraints of an interval of h seconds: of pairs that may touch at their own speed or at `given`. At
/// most `pending` are coloured together; with 1 they stay in the order of candidates. Return the largest speed,
/// m/s.
double mspringi_contact_make_constraints(const mspring_network *network, mspringi_contacts *contacts, double h,
                                         double given, uint32_t pending);
/// Add constraints of pairs that may touch after the sweeps. Return true if one would overlap by more than `kept`,
/// m.
bool mspringi_contact_add_constraints(const mspring_network *network, mspringi_contacts *contacts, double h,
                                      bool has_fast, double kept);
/// True if no fast node of a constraint would move too far in the interval.
bool mspringi_contact_moves_are_short(const mspringi_contacts *contacts, double h);

/* contact_solver.c */

/// Solve contact after an explicit substep, and count its impulses. Return false if there was no constraint.
bool mspringi_contact_solve_substep(const mspring_network *network, mspringi_contacts *contacts);
/// Solve contact of the loaded nodes in double precision, without a change of the state. Floor supports read
/// positions from the network.
bool mspringi_contact_solve_nodes(const mspring_network *network, mspringi_contacts *contacts, double h);
/// Add the impulses of an accepted interval to ongoing contacts, colliders and statistics. For all solvers.
void mspringi_contact_count_impulses(const mspring_network *network, mspringi_contacts *contacts);
/// Add an impulse across to the touch of a constraint's particles.
void mspringi_contact_add_touch(mspringi_contacts *contacts, const mspringi_contact_constraint *t, double impulse);

/* floor_support.c */

/// Find the supports of nodes near the floor, if there are contact constraints: once a substep, after the first of
/// them.
void mspringi_floor_support_find(const mspring_network *network, mspringi_contacts *contacts);
/// Begin each try at an interval of h seconds, with no impulses.
void mspringi_floor_support_begin(const mspringi_contacts *contacts, double h);
/// The same after an implicit substep, which may leave particles below the floor: they are to come out of it.
void mspringi_floor_support_begin_implicit(const mspringi_contacts *contacts, double h);
/// Sweep the supports once.
void mspringi_floor_support_sweep(const mspringi_contacts *contacts);
/// Add the impulses of an accepted interval to the floor's.
void mspringi_floor_support_end(const mspring_network *network, const mspringi_contacts *contacts);

/* gauss_seidel.c */

/// Relative normal speed of the point and the closest point of the edge, m/s; > 0 opens the gap.
static inline double mspringi_normal_speed(const mspringi_contact_constraint *t, const mspringi_velocity *v) {
    return t->nx * (v[t->p].x - t->bary_a * v[t->a].x - t->bary_b * v[t->b].x) +
           t->ny * (v[t->p].y - t->bary_a * v[t->a].y - t->bary_b * v[t->b].y);
}
/// Sweep all constraints so many times, and count the work; again with less restitution where bounces add energy.
void mspringi_contact_sweep(mspringi_contacts *contacts, uint32_t sweeps);
/// Sweep those once that pushed overlaps apart, without friction, and count the work.
void mspringi_contact_sweep_pushed(mspringi_contacts *contacts);
/// Find the normal impulse of a constraint alone, and apply a share of it.
void mspringi_contact_push_apart(const mspringi_contacts *contacts, uint32_t constraint, double share);

/* piles.c */

/// Distance beyond the thickness, as a share of it, up to which bodies rest on each other.
#define MSPRINGI_RESTING_SHARE 0.05

/// True if point and edge rest on each other, or may after `way` metres.
bool mspringi_pair_is_resting(const mspring_network *network, const mspringi_contacts *contacts,
                              const mspringi_pair *pair, double way);
/// Wake islands that an awake one, or a moving collider, can reach in this step. In an attempt only before_step()
/// does: islands that are reached all the same are as heavy as pinned ones until the next.
void mspringi_piles_wake(mspring_network *network, const mspringi_contacts *contacts);
/// Give islands that rest on each other the shortest time for which one of them was still, so that they fall asleep
/// together.
void mspringi_piles_share_stillness(mspring_network *network, const mspringi_contacts *contacts);

/* contact_events.c */

/// Begin an attempt; discard it if the step is rolled back.
void mspringi_contact_events_begin(const mspring_network *network, mspringi_contacts *contacts);
void mspringi_contact_events_discard_step(mspringi_contacts *contacts);
/// Add the impulses of a constraint in an accepted interval to its ongoing contact.
void mspringi_contact_events_add_impulse(const mspring_network *network, mspringi_contacts *contacts,
                                         const mspringi_contact_constraint *t);
/// Subtract what relaxation took from the normal impulse of a constraint, N s.
void mspringi_contact_events_subtract(mspringi_contacts *contacts, const mspringi_contact_constraint *t,
                                      double impulse);
/// End an accepted interval: count the constraints that had no room.
void mspringi_contact_events_end_interval(mspringi_contacts *contacts);
/// Queue the events of an accepted step.
void mspringi_contact_events_finish_step(const mspring_network *network, mspringi_contacts *contacts);
/// Drop the events after a change of state. Bodies at rest on each other count as in contact already.
void mspringi_contact_events_reset(mspringi_contacts *contacts);
/// Most events that there may be room for.
#define MSPRINGI_MOST_CONTACT_EVENTS 0x1000000u
/// Make room for events; have the contact take it, or drop it. Make it and have it taken.
mspring_result mspringi_contact_events_make(mspring_network *network, uint32_t capacity,
                                            mspringi_contact_events *made);
void mspringi_contact_events_take(mspring_network *network, bool is_used, mspringi_contact_events *made);
mspring_result mspringi_contact_events_resize(mspring_network *network, uint32_t capacity);

/* contact_materials.c */

/// A particle's own friction and restitution, -1 where it has none; its layers and masks.
mspringi_contact_material mspringi_contact_material_of(const mspring_network *network, mspring_id particle);
uint32_t mspringi_contact_layers_of(const mspring_network *network, mspring_id particle);
uint32_t mspringi_contact_masks_of(const mspring_network *network, mspring_id particle);
/// Make room for the materials of particles, -1 at first.
mspring_result mspringi_contact_reserve_materials(mspring_network *network);
/// Set friction or restitution, layers or masks, by their property.
mspring_result mspringi_contact_set_material(mspring_network *network, const mspringi_selection *at,
                                             const mspringi_values *values);
mspring_result mspringi_contact_set_layers(mspring_network *network, mspring_property property,
                                           const mspringi_selection *at, const uint32_t *values, size_t stride);
/// Take in a particle that was added, with the defaults: its id may have been another's.
void mspringi_contact_take_in(mspring_network *network, mspring_id particle);
/// Material of a pair, if particles have their own. collider: that of the pair, or NULL.
mspringi_contact_material mspringi_contact_material_mix(const mspringi_contacts *contacts,
                                                        const mspringi_pair *pair,
                                                        const mspringi_collider *collider);

/* collider_motion.c */

/// True if a node is a collider point.
static inline bool mspringi_is_collider_point(const mspringi_contacts *contacts, mspring_id node) {
    return node >= contacts->particles;
}
static inline const mspringi_collider *mspringi_collider_of(const mspringi_contacts *contacts, mspring_id node) {
    const mspringi_colliders *c = &contacts->colliders;
    return &c->list[c->owner[node - contacts->particles]];
}
/// Radius of the pair's collider, m; 0 without one.
static inline double mspringi_radius_of(const mspringi_contacts *contacts, mspring_id point, uint32_t edge) {
    const mspring_id a = contacts->outline.a[edge];
    return mspringi_is_collider_point(contacts, point) ? mspringi_collider_of(contacts, point)->radius
           : mspringi_is_collider_point(contacts, a)   ? mspringi_collider_of(contacts, a)->radius
                                                       : 0.0;
}

/// Begin a step.
void mspringi_colliders_begin(const mspring_network *network, mspringi_contacts *contacts, uint32_t substeps);
/// Move all points to their positions after `done` substeps.
void mspringi_colliders_move_points(const mspring_network *network, mspringi_contacts *contacts, uint32_t done);
/// Angular and linear velocity in a step of dt, 1/s and m/s; 0 at rest.
double mspringi_collider_spin(const mspringi_collider *collider, double dt);
void mspringi_collider_velocity(const mspringi_collider *collider, double dt, double *vx, double *vy);
/// Discard the impulses of the step so far.
void mspringi_colliders_discard_step(mspringi_contacts *contacts);
/// Of a constraint with a collider: distance from its point to the surface where friction acts, m: the radius of
/// the collider if the point is the collider's, else 0.
double mspringi_collider_friction_offset(const mspringi_contacts *contacts, const mspringi_contact_constraint *t);
/// Tangential speed of a turning collider's surface, m/s. Sides have it in the velocities of their ends.
double mspringi_collider_surface_speed(const mspringi_contacts *contacts, const mspringi_contact_constraint *t);
/// Add impulses of a constraint, N s, to its collider.
void mspringi_colliders_add_impulse(mspringi_contacts *contacts, const mspringi_contact_constraint *t,
                                    double normal_impulse, double tangent_impulse);
/// Finish an accepted step: poses become the targets.
void mspringi_colliders_finish_step(const mspring_network *network, mspringi_contacts *contacts);

/* contacts.c */

/// Reserve collider points. False: no memory, and nothing changed.
bool mspringi_contacts_reserve_points(mspring_network *network, uint32_t points);
/// Forget what floor, bodies and colliders gave a particle in the last step: it is put where it was at another
/// time.
void mspringi_contact_forget_impulses_of(const mspring_network *network, mspring_id particle);
/// Forget that of all particles: a snapshot is loaded.
void mspringi_contact_forget_impulses(mspring_network *network);
/// Touch of a particle in the last step, N s.
static inline float mspringi_contact_touch_of(const mspring_network *network, mspring_id particle) {
    const mspringi_contacts *c = network->contacts;
    return c ? c->touch[(size_t)(1 - c->touch_now) * c->particles + particle] : 0.0f;
}

/* contact_room.c */

/// Most pairs that there may be room for.
#define MSPRINGI_MOST_PAIRS ((uint32_t)1 << 26)

/// Reserve pairs and constraints for an outline; def.capacity is set if it is 0. On error some of it is there.
bool mspringi_contacts_reserve_room(mspring_network *network, mspringi_contacts *made);
/// Pairs that steps may make room for.
uint32_t mspringi_contacts_most_pairs(const mspringi_contacts *contacts);
/// Reserve implicit constraints, for solvers with contact in their system. Does nothing without contact.
mspring_result mspringi_contacts_reserve_implicit(mspring_network *network);

#endif

/// @file contacts.h
/// Contact between bodies, and of a body with itself: outline points against outline edges with a thickness.
///
///   contacts.c      the definition, given by the host
///   outline.c    which springs and particles are the outline
///   edge_grid.c      edges by cells, and those in the cells around a point
///   pair_list.c       which points are near which edges, and for how many substeps none of them can touch
///   constraints.c       which of them touch in a substep, in which order
///   contact_solver.c     solving these, in pieces of the substep, and how they move on
///   gauss_seidel.c     the impulses of those that touch
///   piles.c      islands that sleep on each other and wake together
///   contact_stage.c   the stage: when to look, and which islands sleep and wake together
///   contact_events.c   contacts that begin and end, as events for the host
///   contact_materials.c      friction and restitution of particles of their own
///   colliders.c  shapes of the host: adding, moving, reading them
///   collider_motion.c      where these are in the course of a step, and what they get in it
///
/// What is simulated: forces, velocity, contact, move. A substep has moved the particles when contact acts, so the
/// rows take positions of before it and velocities of after it, and correct both.
///
/// All that is kept from step to step follows from positions, or is the shape by which the outline was found. Lists
/// are longer than they need to be; what of them acts does not depend on when they were made.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CONTACTS_H
#define MSPRINGI_CONTACTS_H

#include <massspring/massspring_contact.h>

#include "store/network.h"

/// The outline: springs with a free side, their ends, and particles without springs, as edges of length 0. Edges
/// are numbered by rising ids: springs first, then particles, then the sides of colliders. The points of colliders
/// are numbered from the number of particles on, so nodes are both. A collider of one point is an edge of length 0.
typedef struct mspringi_outline {
    uint8_t *is_edge;          ///< [springs] 1: live, and not inside
    uint8_t *is_known;         ///< [particles] 1: its place in the shape is known
    double *shape_x, *shape_y; ///< [particles] where it was when contact was set, or when it was added
    double origin_x, origin_y; ///< of the shape
    mspring_id *a, *b;         ///< [springs + nodes] ends of each edge; the same for a particle
    mspring_id *points;        ///< [nodes]
    uint32_t *first, *at;      ///< [nodes + 1], [2 (springs + nodes)]: the edges at a node, rising
    uint32_t *body;            ///< [nodes] the lowest of the same body, unless bodies touch themselves
    uint32_t edge_count, point_count;
    bool is_found;
    bool are_bodies_found;      ///< body is right
    uint64_t links, growth;     ///< edits that it has seen
    uint64_t tries, most_tries; ///< particles that were tried for a triangle when springs were judged last; at most
} mspringi_outline;

/// An outline point that may come near an outline edge.
typedef struct mspringi_pair {
    mspring_id point;
    uint32_t edge;
    uint16_t tested_bits, excluded_bits; ///< bits for the edges at a's end, and at b's: excluded_bits if the point
                                         ///< never touches the edge, once that was asked
} mspringi_pair;

/// A pair that may touch before the list is looked at again, by active nodes.
typedef struct mspringi_candidate {
    uint32_t pair, p, a, b;
} mspringi_candidate;

/// Edges by cells, in buckets; see edge_grid.c. What a search reads lies in the order in which it is read.
typedef struct mspringi_edge_grid {
    uint32_t *first;             ///< [bucket_count + 1]
    uint32_t *sorted;            ///< [edges] by buckets
    uint32_t *below;             ///< [edges] of sorted ones: points that they are a pair with are below this number
    int32_t *row;                ///< [edges] of sorted ones: of its cell
    double *middle_x, *middle_y; ///< [edges] of sorted ones
    uint32_t *long_edges;        ///< [edges] those that are in no cell
    uint32_t *found;             ///< [edges + 1] by the last search; before all searches the bucket of each edge
    double size;                 ///< of a cell, m
    double reach;                ///< from a point to the middle of an edge in cells that is near, at most, m
    uint32_t bucket_count, bucket_capacity, long_count;
} mspringi_edge_grid;

/// Of a node, m/s: both coordinates side by side, as sweeps need them.
typedef struct mspringi_velocity {
    double x, y;
} mspringi_velocity;

/// Nodes that pairs need, by a number of their own.
typedef struct mspringi_contact_nodes {
    mspring_id *particles;          ///< [nodes]
    uint32_t *number;               ///< [nodes] MSPRING_NONE if it is none of them
    double *x, *y;                  ///< [nodes] at the start of the substep, and of each of its pieces
    mspringi_velocity *v_start;     ///< [nodes] before the substep's forces
    mspringi_velocity *v_before;    ///< [nodes] before the piece's contact
    mspringi_velocity *v;           ///< [nodes]
    double *inverse_mass;           ///< [nodes] inverse mass, 1/kg
    double *shift_x, *shift_y;      ///< [nodes] what contact adds to the move
    uint8_t *is_fast;               ///< [nodes] sweeps have changed the velocity much
    double *extra_vx, *extra_vy;    ///< what it adds to the velocity of what an implicit solver lets fly by itself
    uint32_t particle_count, count; ///< particles, and with the points of colliders, which are behind these
} mspringi_contact_nodes;

/// A point that touches an edge, or may do so in this piece of a substep.
typedef struct mspringi_contact_constraint {
    // What sweeps need: two lines of the cache.
    uint32_t p, a, b; ///< active nodes
    float friction;
    double nx, ny;             ///< from the edge to the point, of length 1
    double bary_a, bary_b;     ///< of the edge's nearest place
    double clear_speed;        ///< speed across at which it just does not touch, m/s; DBL_MAX: it overlaps
    double target_speed;       ///< speed across that it is to have at least, when it touches, m/s
    double normal_mass;        ///< impulse across by a unit of velocity, kg
    double couple_x, couple_y; ///< along the edge: the couple of friction on its ends, by a unit along
    double couple_response;    ///< speed along that a unit of impulse across gives by that couple, 1/kg
    double tangent_mass;       ///< impulse along by a unit of velocity, kg; 0: no friction
    double surface_speed;      ///< what the turning of a collider adds to the speed along, m/s
    double normal_impulse, tangent_impulse; ///< impulses, N s

    double gap, distance; ///< m
    uint32_t candidate;
    uint32_t collider; ///< number of the collider that the point or the edge is of, MSPRING_NONE if none is
    bool is_bounce;    ///< target is what restitution makes of it
} mspringi_contact_constraint;

/// A place on an edge.
typedef struct mspringi_closest_point {
    double x, y;     ///< from there to the point
    double fraction; ///< of the way from a to b
} mspringi_closest_point;

/// Rows that are put into an order together, at most.
#define MSPRINGI_MAX_PENDING 64u

/// A row that is to be made, once it is known where in the order.
typedef struct mspringi_pending_constraint {
    mspringi_closest_point at;
    double resistance; ///< 1/kg
    uint32_t candidate, colour;
} mspringi_pending_constraint;

/// A row of a particle that contact may press into the floor.
typedef struct mspringi_floor_support {
    uint32_t p, slot; ///< number in mspringi_contact_nodes
    double nx, ny, friction;
    double room;          ///< m to the surface at the end of the substep, without contact
    double free_speed;    ///< speed away from it then, m/s
    double min_speed;     ///< that it is to have at least, m/s
    double across, along; ///< what the row gives, m/s
} mspringi_floor_support;

/// Of a particle: to two surfaces, where they meet.
#define MSPRINGI_MAX_SUPPORTS 2u

/// A row in the linear system of an implicit substep; see solvers/implicit/implicit_contact.c. Of three: the point
/// and the ends of the edge.
typedef struct mspringi_implicit_constraint {
    uint32_t slots[3];                ///< MSPRING_NONE: not in the system
    double across[3][2], along[3][2]; ///< how a unit of force is shared
    double gap;                       ///< where all is predicted, beyond what there is to be at least, m
    double spare;                     ///< that it may lack before it is held, as it bounces then, m
    double ahead;                     ///< how far the point has slid there, m
    double stiffness, grip;           ///< of what holds it across and along, in the units of the matrix
    double friction;
    double slip;                          ///< it slides this way along, 1 or -1; 0: it sticks
    double normal, braked;                ///< what it gives across and along, in the units of the right-hand side
    double answer[2], left[2], search[2]; ///< of the direct solver: forces across and along, and their iteration
    bool is_active;                       ///< it is held
} mspringi_implicit_constraint;

/// Where a collider is, world coordinates.
typedef struct mspringi_pose {
    double x, y, angle;
} mspringi_pose;

/// A shape of the host.
typedef struct mspringi_collider {
    mspring_collider_def def; ///< as given; points does not count, position and angle are those of now
    mspring_id id;
    uint32_t first, count; ///< its points
    uint32_t sides;
    double radius;
    mspringi_pose target;                 ///< at the end of the next step
    bool is_moving;                       ///< target is elsewhere
    double impulse_x, impulse_y, angular; ///< of the last step
    double pushed_x, pushed_y, turned;    ///< of the step that is being made
} mspringi_collider;

/// All of them, by rising ids, and their points one behind the other.
typedef struct mspringi_colliders {
    mspringi_collider *list; ///< [capacity]
    size_t capacity;
    uint32_t count, point_count, point_capacity;
    uint32_t listed_points, listed_sides; ///< those in the outline
    double *shape;                        ///< [point_capacity][2] as given
    uint32_t *owner;                      ///< [point_capacity] number of its collider
    double *x, *y;   ///< [point_capacity] local coordinates, at the end of so many substeps as done says
    double *vx, *vy; ///< [point_capacity] in the substep after that
    uint32_t done, substeps;
    double origin_x, origin_y; ///< of x and y
    bool is_placed;            ///< x and y are right but for what moves
    bool are_new;              ///< the outline lacks some
    bool are_moving;           ///< some are, in this step
    uint64_t reported;         ///< the step that the impulses are of
} mspringi_colliders;

/// What two had at a place, and where; world coordinates.
typedef struct mspringi_contact_location {
    mspring_id a, b; ///< ends of the edge; MSPRING_NONE: a collider's
    double x, y, nx, ny;
} mspringi_contact_location;

/// A contact of a particle with another body or a collider, or of a collider's corners with a body.
typedef struct mspringi_ongoing_contact {
    mspring_id point;                    ///< MSPRING_NONE: the corners
    mspring_id other;                    ///< lowest particle of the other body, MSPRING_NONE: a collider
    mspring_id collider;                 ///< its id, MSPRING_NONE: none
    bool is_new;                         ///< it began in this step
    double largest;                      ///< impulse of a row in a piece of this step, N s
    double impulse, friction;            ///< of this step, sums of sizes, N s
    mspringi_contact_location now, last; ///< of the largest; of the last step that had one
} mspringi_ongoing_contact;

/// All that go on, in the order of point, collider and other, and the events that the host has not read: a ring.
typedef struct mspringi_contact_events {
    mspringi_ongoing_contact *list; ///< [capacity]
    mspring_contact_event *ring;    ///< [capacity]
    uint32_t capacity, count, first, waiting;
    uint32_t dropped, max_dropped; ///< rows that had no room in a piece; in any piece of the step
    uint64_t lost;
    bool is_known; ///< else what rests on each other has begun before
} mspringi_contact_events;

/// Friction and restitution of what touches.
typedef struct mspringi_contact_material {
    float friction, restitution; ///< of a particle: < 0: the contact's
} mspringi_contact_material;

/// Edges that are kept for each point because it never touches them: those beside its own on a straight outline.
#define MSPRINGI_EXCLUDED_EDGES 6u

struct mspringi_contacts {
    mspring_contact_def def;
    double thickness, push;
    bool touches_itself;
    uint32_t particles;                   ///< that there is room for
    size_t edge_capacity;                 ///< springs and nodes
    uint32_t *groups, *masks;             ///< [nodes]
    mspringi_contact_material *materials; ///< [particles] NULL: none has values of its own
    mspringi_outline outline;
    mspringi_edge_grid cells;
    mspringi_colliders colliders;
    mspringi_contact_events events;

    // The list of all pairs that are near.
    mspringi_pair *list; ///< [capacity]
    uint32_t count, capacity;
    mspringi_candidate *candidates; ///< [capacity] those of the list that may touch before it is looked at again
    uint32_t candidate_count;
    bool is_listed, is_pair_list_full;
    uint64_t work, most_work; ///< comparisons of points and edges in this step, and how many these may be
    double reach;             ///< all pairs nearer than this were in the list when it was made, m
    double *seen_x, *seen_y;  ///< [nodes] where points were then
    uint32_t *stamp;          ///< [particles] how many springs join it to the point of stamp_of; see outline.c
    uint32_t stamp_of;
    bool are_all_stamped;     ///< else those that two springs join to it are stamped when they are asked for
    uint32_t *excluded_edges; ///< [particles][MSPRINGI_EXCLUDED_EDGES] edges that each was found never to touch;
                              ///< MSPRING_NONE

    // The last look.
    double *x, *y; ///< [nodes] where points were
    double mean_vx, mean_vy;
    double speed;                  ///< of any of them beside their mean, at most, m/s
    double moved;                  ///< since the list was made, likewise, m
    double nearest;                ///< distance of any pair, as far as the list tells, m
    bool is_fresh;                 ///< nothing has moved since
    uint64_t state, sleep_changes; ///< edits then
    float scan_h;
    double scan_dt;

    // A step.
    float h;
    double dt;
    uint32_t quiet_substeps;      ///< substeps in which nothing can touch
    uint32_t valid;               ///< substeps until the list is to be looked at again
    uint32_t first_substep;       ///< of the group of substeps that is being taken
    uint32_t substeps_done;       ///< substeps that were followed
    bool has_sleepers;            ///< the step began with some: whatever may come to them in it wakes them
    uint32_t substeps_since_scan; ///< the last of them, which were quiet
    double room;                  ///< that the nearest pair had at the last look, m
    double extra_speed;           ///< speed that contact gave where the look did not expect it, m/s
    bool is_missed;               ///< pairs could touch where nothing should
    bool is_second_try;           ///< so this time every substep is looked at

    mspringi_contact_nodes nodes;
    mspringi_contact_constraint *constraints; ///< [constraint_capacity]
    uint32_t *colours;                        ///< [nodes] of the drafts that a node is in, as bits
    uint8_t *is_seen;                         ///< [capacity] of candidates, while rows are added
    uint32_t *near_misses;                    ///< [capacity] candidates that just miss a row
    uint32_t constraint_count, near_miss_count, constraint_capacity;
    mspringi_pending_constraint pending[MSPRINGI_MAX_PENDING]; ///< rows that are to be made
    uint32_t pending_count, max_pending;
    bool is_out_of_room;                                ///< a row had no room
    mspringi_implicit_constraint *implicit_constraints; ///< [constraint_capacity] the same rows, of an implicit
                                                        ///< substep; NULL: no solver has such
    double passed;                                      ///< of an implicit substep, in pieces, s
    double fall_x, fall_y;            ///< velocity that gravity gives in one, m/s; 0: forces have acted already
    double share;                     ///< of its substep that a piece of an implicit one is; else 1
    mspringi_floor_support *supports; ///< [MSPRINGI_MAX_SUPPORTS * nodes]
    uint32_t support_count;
    uint32_t touching; ///< pairs that pushed each other in a substep, at most
    double deepest;    ///< overlap, m
};

typedef struct mspringi_contacts mspringi_contacts;

/* outline.c */

/// Forget the shape of what was in a slot: it is another particle's from now on.
void mspringi_outline_clear_slot(const mspring_network *network, uint32_t slot);
/// Have a particle take part in the shape where it is now: when contact is set, and in the call that adds it.
void mspringi_outline_take_in(const mspring_network *network, mspringi_outline *outline, mspring_id particle);
/// Find the outline, or what edits have changed of it. Allocates nothing.
void mspringi_outline_update(const mspring_network *network, mspringi_contacts *contacts);
/// The particles that a spring joins.
void mspringi_outline_ends(const mspring_network *network, mspring_id spring, mspring_id ends[2]);
/// True if two particles are the same, or joined by one live spring, or by two. Asking for one p after the other is
/// cheapest.
bool mspringi_outline_are_neighbours(const mspring_network *network, mspringi_contacts *contacts, mspring_id p,
                                     mspring_id q);

/* edge_grid.c */

/// Sort the edges into cells, but for the long ones, for searches this far around points.
void mspringi_edge_grid_fill(const mspring_network *network, mspringi_contacts *contacts, double reach);
/// Find edges in cells that a point may be a pair with. Returns how many.
uint32_t mspringi_edge_grid_search(const mspring_network *network, mspringi_contacts *contacts, mspring_id p);
/// Two particles without springs are one pair, and one with a corner is it with the corner's edges.
bool mspringi_is_duplicate_pair(const mspringi_outline *o, mspring_id p, uint32_t edge);

/* pair_list.c */

/// Points may get faster than they are by this factor before the next look, and go this share of the thickness
/// besides in a step.
#define MSPRINGI_SPEED_MARGIN 1.5
#define MSPRINGI_DRIFT_FRACTION 0.05

static inline mspringi_closest_point mspringi_closest_point_on_edge(double px, double py, double ax, double ay,
                                                                    double bx, double by) {
    const double ex = bx - ax, ey = by - ay, square = ex * ex + ey * ey;
    double share = 0.0;
    if (square > 0.0) {
        share = ((px - ax) * ex + (py - ay) * ey) / square;
        share = share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share;
    }
    return (mspringi_closest_point){px - ax - share * ex, py - ay - share * ey, share};
}

/// Make the list anew if it may lack pairs. False: there is no room for all of them.
bool mspringi_pair_list_refresh(const mspring_network *network, mspringi_contacts *contacts);
/// Look how near points and edges are, and for how many substeps nothing can touch. False: as above.
bool mspringi_pair_list_scan(const mspring_network *network, mspringi_contacts *contacts);
/// Replace the pair list by the pairs nearer than `reach`, m. The next refresh makes it anew.
void mspringi_near_list(const mspring_network *network, mspringi_contacts *contacts, double reach);

/* constraints.c */

/// Pairs that miss a row by less than this share of the thickness are remembered: small impulses may make it one.
#define MSPRINGI_NEAR_MISS_FRACTION 0.01

/// Before a substep: keep what contact needs of it.
void mspringi_contact_begin_substep(const mspring_network *network, mspringi_contacts *contacts);
/// The same before a piece of it.
void mspringi_contact_load_nodes(const mspring_network *network, mspringi_contacts *contacts);
/// Make the rows of an implicit substep of h seconds, or of a piece of one, from what was noted: more of them, as
/// springs and other bodies may push in it. Returns the speed of the fastest.
double mspringi_contact_prepare_implicit(const mspring_network *network, mspringi_contacts *contacts, double h);
/// Make the rows of a piece of h seconds, of what may touch by its own speed or by one that it may be given; so
/// many at most are put into an order together. Returns the speed of the fastest.
double mspringi_contact_make_constraints(const mspring_network *network, mspringi_contacts *contacts, double h,
                                         double given, uint32_t pending);
/// Add rows of pairs that may touch by the velocities that the sweeps have left. Returns whether any of them does.
bool mspringi_contact_add_constraints(const mspring_network *network, mspringi_contacts *contacts, double h,
                                      bool any_fast);
/// Whether nothing that touches, and was thrown, would move too far.
bool mspringi_contact_moves_are_short(const mspringi_contacts *contacts, double h);

/* contact_solver.c */

/// After a substep: let contact act. Returns whether anything touched, or could have.
bool mspringi_contact_solve_substep(const mspring_network *network, mspringi_contacts *contacts);
/// The same of nodes as they are in mspringi_contact_nodes, in double precision, and no further. Floors bear what
/// they find in the network.
bool mspringi_contact_solve_nodes(const mspring_network *network, mspringi_contacts *contacts, double h);
/// Count what was given in a piece, once it is taken for good.
void mspringi_contact_count_impulses(const mspring_network *network, mspringi_contacts *contacts);

/* floor_support.c */

/// Find what is near the floor, at the end of a substep of which contact has rows.
void mspringi_floor_support_find(const mspring_network *network, mspringi_contacts *contacts);
/// Begin a piece of h seconds.
void mspringi_floor_support_begin(const mspringi_contacts *contacts, double h);
/// Let the floor resist once.
void mspringi_floor_support_sweep(const mspringi_contacts *contacts);
/// Count what it gave in the piece.
void mspringi_floor_support_end(const mspring_network *network, const mspringi_contacts *contacts);

/* gauss_seidel.c */

/// How fast a point and its place on an edge part.
static inline double mspringi_normal_speed(const mspringi_contact_constraint *t, const mspringi_velocity *v) {
    return t->nx * (v[t->p].x - t->bary_a * v[t->a].x - t->bary_b * v[t->b].x) +
           t->ny * (v[t->p].y - t->bary_a * v[t->a].y - t->bary_b * v[t->b].y);
}
/// Give all rows of a piece of h seconds their impulses. False: some would still get much deeper.
bool mspringi_contact_sweep(const mspringi_contacts *contacts, double h, uint32_t sweeps);

/* piles.c */

/// Find the piles: islands that sleep on each other.
void mspringi_piles_find(mspring_network *network);

/* contact_stage.c */

/// Whether a pair rests on each other, or may do so after so many metres.
bool mspringi_pair_is_resting(const mspring_network *network, const mspringi_contacts *contacts,
                              const mspringi_pair *pair, double way);

/* contact_events.c */

/// An attempt at a step begins: forget what another one has found.
void mspringi_contact_events_begin(const mspring_network *network, mspringi_contacts *contacts);
void mspringi_contact_events_discard_step(mspringi_contacts *contacts);
/// Count what a row has given, at the beginning of a piece of a substep.
void mspringi_contact_events_begin_interval(mspringi_contacts *contacts);
void mspringi_contact_events_add_impulse(const mspring_network *network, mspringi_contacts *contacts,
                                         const mspringi_contact_constraint *touch);
/// The step is taken: queue its events.
void mspringi_contact_events_finish_step(const mspring_network *network, mspringi_contacts *contacts);
/// The state is another: drop events, and take what rests on each other for begun.
void mspringi_contact_events_reset(mspringi_contacts *contacts);

/* contact_materials.c */

/// Of a pair where particles have values of their own. collider: the one that it is of, or NULL.
mspringi_contact_material mspringi_contact_material_mix(const mspringi_contacts *contacts,
                                                        const mspringi_pair *pair,
                                                        const mspringi_collider *collider);

/* collider_motion.c */

/// Whether a node is a point of a collider.
static inline bool mspringi_is_collider_point(const mspringi_contacts *contacts, mspring_id node) {
    return node >= contacts->particles;
}
static inline const mspringi_collider *mspringi_collider_of(const mspringi_contacts *contacts, mspring_id node) {
    const mspringi_colliders *c = &contacts->colliders;
    return &c->list[c->owner[node - contacts->particles]];
}
/// How much nearer the surface of a collider is than its points and sides are, m.
static inline double mspringi_radius_of(const mspringi_contacts *contacts, mspring_id point, uint32_t edge) {
    const mspring_id a = contacts->outline.a[edge];
    return mspringi_is_collider_point(contacts, point) ? mspringi_collider_of(contacts, point)->radius
           : mspringi_is_collider_point(contacts, a)   ? mspringi_collider_of(contacts, a)->radius
                                                       : 0.0;
}

/// A step of so many substeps begins.
void mspringi_colliders_begin(const mspring_network *network, mspringi_contacts *contacts, uint32_t substeps);
/// Have all points be where they are after so many of them.
void mspringi_colliders_move_points(const mspring_network *network, mspringi_contacts *contacts, uint32_t done);
/// Speeds in a step, 1/s and m/s; 0 of what stands still.
double mspringi_collider_spin(const mspringi_collider *collider, double dt);
void mspringi_collider_velocity(const mspringi_collider *collider, double dt, double *vx, double *vy);
/// Forget what colliders got in the step so far.
void mspringi_colliders_discard_step(mspringi_contacts *contacts);
/// From the point of a row to where friction acts on it: 0, or to the surface of the collider that it is of, m.
double mspringi_collider_friction_offset(const mspringi_contacts *contacts,
                                         const mspringi_contact_constraint *touch);
/// What the turning of a collider adds to the speed along a row, m/s. Sides have it in the motion of their ends.
double mspringi_collider_surface_speed(const mspringi_contacts *contacts, const mspringi_contact_constraint *touch);
/// Count what a row gives to a collider, at the beginning of a piece of a substep.
void mspringi_colliders_add_impulse(mspringi_contacts *contacts, const mspringi_contact_constraint *touch);
/// The step is taken: all are where they were to come.
void mspringi_colliders_finish_step(const mspring_network *network, mspringi_contacts *contacts);

/* contacts.c */

/// Make room for so many points of colliders. False: there is no memory, and nothing has changed.
bool mspringi_contacts_reserve_points(mspring_network *network, uint32_t points);
/// Make room for what solvers need that have contact in their system. Nothing without contact.
mspring_result mspringi_contacts_reserve_implicit(mspring_network *network);
void mspringi_contacts_relocate(mspringi_contacts *contacts, const mspringi_memory *from,
                                const mspringi_memory *to);

#endif

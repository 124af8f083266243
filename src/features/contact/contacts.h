/// @file contacts.h
/// Contact between bodies, and of a body with itself: outline points against outline edges with a thickness.
///
/// In the order of a step:
///
///   contacts.c           definition of contact, set by the host; memory
///   outline.c            outline: edges and points
///   edge_grid.c          broad phase: edges in a hashed grid
///   point_speeds.c       speeds of outline points, and the margins that follow
///   pair_list.c          Verlet list of near pairs, candidates, substeps without contact
///   inner_points.c       inner particles of bodies that are flat on a collider
///   constraints.c        narrow phase: contact constraints of an interval, in a fixed order
///   contact_solver.c     intervals of a substep, and motion in them
///   gauss_seidel.c       impulses: projected Gauss-Seidel
///   penetration.c        more sweeps of constraints that would get deeper
///   relaxation.c         explicit solver: velocities without what pushed overlaps apart
///   floor_support.c      floor below bodies, in the same sweeps
///   contact_events.c     begin and end events for the host
///   contact_stage.c      stage: when to scan; islands that wake or fall asleep together
///   piles.c              islands that sleep on each other
///   contact_materials.c  friction and restitution of single particles
///   colliders.c          shapes of the host: adding, moving, reading
///   collider_motion.c    motion of colliders in a step, and impulses on them
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

#include <massspring/massspring_contact.h>

#include "features/contact/floor_support.h"
#include "features/contact/inner_points.h"
#include "features/contact/penetration.h"
#include "store/network.h"

/// Outline: springs with a free side, their ends, and particles without springs, as edges of length 0. Edges are
/// numbered by rising ids: springs, particles, then sides of colliders. Collider points are nodes, numbered behind
/// the particles. A collider of one point is an edge of length 0.
typedef struct mspringi_outline {
    uint8_t *is_edge;          ///< [springs] 1: live, and not inside
    uint8_t *is_known;         ///< [particles] 1: in the shape
    double *shape_x, *shape_y; ///< [particles] position when contact was set, or when the particle was added, m
    double origin_x, origin_y; ///< origin of the shape
    mspring_id *a, *b;         ///< [springs + nodes] ends of each edge; equal for a particle
    mspring_id *points;        ///< [nodes]
    uint32_t *first, *at;      ///< [nodes + 1], [2 (springs + nodes)]: edges at a node, by rising number
    uint32_t *body;            ///< [nodes] lowest node of the body; the node itself if bodies touch themselves
    uint32_t edge_count, point_count;
    bool is_found;
    bool are_bodies_found;      ///< body is up to date
    uint64_t links, growth;     ///< counters of edits at the last update
    uint64_t tries, most_tries; ///< particles tried for a triangle, or listed, in the last update; their limit
} mspringi_outline;

/// Pair of an outline point and a near outline edge.
typedef struct mspringi_pair {
    mspring_id point;
    uint32_t edge;
    float distance;                      ///< at the last scan that had has_distances, m
    uint16_t tested_bits, excluded_bits; ///< a bit for each neighbouring edge at both ends: tested; never touched
                                         ///< by the point (constraints.c)
} mspringi_pair;

/// Pair that may touch before the next scan, with its nodes.
typedef struct mspringi_candidate {
    uint32_t pair, p, a, b;
} mspringi_candidate;

/// Edge as a search reads it: a cache line.
typedef struct mspringi_sought_edge {
    double x, y;             ///< one end, m
    double along_x, along_y; ///< direction from there, of length 1, or 0
    double length, slack;    ///< m; margin, and radius of a collider's side, with rounding, m
    uint32_t edge;
    uint32_t below; ///< only points below this number form a pair with the edge
    int32_t row;    ///< of its cell
    uint32_t reserved;
} mspringi_sought_edge;

/// Edges of about the same reach: half their length and their margin.
typedef struct mspringi_grid_level {
    double reach;                      ///< the largest, m
    double size;                       ///< side of a cell, m
    double min_x, max_x, min_y, max_y; ///< bounds of the midpoints, m
    uint32_t count;
} mspringi_grid_level;

#define MSPRINGI_GRID_LEVELS 8

/// Edges by grid cell, in hash buckets (edge_grid.c).
typedef struct mspringi_edge_grid {
    uint32_t *first;             ///< [bucket_count + 1]
    mspringi_sought_edge *edges; ///< [edges] by bucket
    uint32_t *found;   ///< [edges + 1] results of the last search; while the grid is filled, bucket of each edge
    uint8_t *level_of; ///< [edges]
    mspringi_grid_level levels[MSPRINGI_GRID_LEVELS];
    uint32_t bucket_count, bucket_capacity;
} mspringi_edge_grid;

/// Bound that grows with the speed of a point: at_rest + per_speed * speed.
typedef struct mspringi_speed_bound {
    double at_rest, per_speed;
} mspringi_speed_bound;

/// Velocity of a node, m/s. Both coordinates lie side by side, as sweeps load them.
typedef struct mspringi_velocity {
    double x, y;
} mspringi_velocity;

/// Nodes of candidates and of neighbouring edges, numbered densely.
typedef struct mspringi_contact_nodes {
    mspring_id *particles;          ///< [nodes]
    uint32_t *number;               ///< [nodes] dense number; MSPRING_NONE without one
    double *x, *y;                  ///< [nodes] position at the start of the interval, m
    mspringi_velocity *v_start;     ///< [nodes] before the substep's forces
    mspringi_velocity *v_before;    ///< [nodes] before contact in this interval
    mspringi_velocity *v;           ///< [nodes] current
    double *inverse_mass;           ///< [nodes] 1/kg
    double *shift_x, *shift_y;      ///< [nodes] displacement by contact, m
    uint8_t *is_fast;               ///< [nodes] contact changed the velocity so much that near misses may touch
    double *extra_vx, *extra_vy;    ///< [nodes] velocity from contact, for isolated particles, m/s
    uint32_t particle_count, count; ///< particles; all nodes, collider points last
} mspringi_contact_nodes;

/// Contact constraint: a point and an edge that touch, or may touch, in this interval.
typedef struct mspringi_contact_constraint {
    // Members that a sweep reads: two cache lines.
    uint32_t p, a, b; ///< dense numbers of the point and of the edge's ends
    float friction;
    double nx, ny;             ///< normal from the edge to the point, of length 1
    double bary_a, bary_b;     ///< barycentric weights of the closest point of the edge
    double clear_speed;        ///< normal speed that just keeps the gap open, m/s; DBL_MAX if it is closed
    double target_speed;       ///< lower bound of the normal speed after contact, m/s
    double normal_mass;        ///< normal impulse per change of normal speed, kg
    double couple_x, couple_y; ///< couple of friction on the ends of the edge, per unit of tangential impulse
    double couple_response;    ///< tangential speed from that couple, per unit of normal impulse, 1/kg
    double tangent_mass;       ///< tangential impulse per change of tangential speed, kg; 0 without friction
    double surface_speed;      ///< tangential speed of a turning collider's surface, m/s
    double normal_impulse, tangent_impulse; ///< accumulated, N s

    double gap, distance;  ///< distance minus thickness and radius; distance between point and edge, m
    double pushed_impulse; ///< normal_impulse before relaxation, N s
    uint32_t candidate;    ///< index of its candidate
    uint32_t collider;     ///< index of the collider of the point or edge, or MSPRING_NONE
    bool is_bounce;        ///< target_speed comes from restitution
    bool is_pushed;        ///< it pushes an overlap apart, and will be relaxed
} mspringi_contact_constraint;

/// Closest point of an edge to a point.
typedef struct mspringi_closest_point {
    double x, y;     ///< vector from it to the point, m
    double fraction; ///< position between a (0) and b (1)
} mspringi_closest_point;

/// Most pending constraints that are coloured together (constraints.c).
#define MSPRINGI_MAX_PENDING 64u

/// Pending constraint: its place in the order is not known yet.
typedef struct mspringi_pending_constraint {
    mspringi_closest_point at;
    double inverse_mass; ///< of point and closest point of the edge together, 1/kg
    uint32_t candidate, colour;
} mspringi_pending_constraint;

/// Contact constraint between rigid bodies, in one direction (solvers/implicit/rigid_contact.c). Index 0 is the
/// side of the point, 1 that of the edge.
typedef struct mspringi_rigid_row {
    double arms[2]; ///< torque on each body for a unit of impulse, m
    double speed;   ///< relative speed of the bodies without impulses, m/s
    double mass;    ///< impulse per change of speed, kg; 0: none acts
} mspringi_rigid_row;

/// Contact constraint in the linear system (solvers/implicit/implicit_contact.c). Index 0 is the point, 1 and 2 are
/// the ends of the edge.
typedef struct mspringi_implicit_constraint {
    uint32_t slots[3];                ///< MSPRING_NONE: not an unknown of the system
    uint32_t listed;                  ///< index of its push in network->constraints; MSPRING_NONE: impulses only
    double across[3][2], along[3][2]; ///< Jacobians of the normal and the tangential displacement
    double spare;                     ///< slack before a bouncing constraint becomes active, m
    double friction;                  ///< 0: it has no friction in the system
    bool is_active;                   ///< in the active set at the prediction
    uint32_t bodies[2];               ///< of point and edge, if contact moves rigid bodies; MSPRINGI_NO_COMPONENT
    mspringi_rigid_row rigid[2];      ///< across and along
} mspringi_implicit_constraint;

/// Pose of a collider, world coordinates.
typedef struct mspringi_pose {
    double x, y, angle;
} mspringi_pose;

/// Collider: a shape that the host moves.
typedef struct mspringi_collider {
    mspring_collider_def def; ///< as given, except for points; position and angle are current
    mspring_id id;
    uint32_t first, count; ///< range of its points
    uint32_t sides;
    double radius;
    mspringi_pose target;                 ///< at the end of the next step
    bool is_moving;                       ///< target differs from the current pose
    double impulse_x, impulse_y, angular; ///< in the last step, N s and N m s
    double pushed_x, pushed_y, turned;    ///< impulse and angular impulse in the present step so far, N s, N m s
} mspringi_collider;

/// All colliders by rising id, with their points end to end.
typedef struct mspringi_colliders {
    mspringi_collider *list; ///< [capacity]
    size_t capacity;
    uint32_t count, point_count, point_capacity;
    uint32_t listed_points, listed_sides; ///< points and sides in the outline
    double *shape;                        ///< [point_capacity][2] points in the collider's frame, m
    uint32_t *owner;                      ///< [point_capacity] index of the collider
    double *x, *y;                        ///< [point_capacity] local coordinates after `done` substeps, m
    double *vx, *vy;                      ///< [point_capacity] in the next substep, m/s
    uint32_t done, substeps;
    double origin_x, origin_y; ///< of x and y
    bool is_placed;            ///< x and y are up to date for colliders at rest
    bool are_new;              ///< the outline lacks new colliders
    bool are_moving;           ///< at least one moves in this step
    uint64_t reported;         ///< step of the reported impulses
} mspringi_colliders;

/// Location of a contact, world coordinates.
typedef struct mspringi_contact_location {
    mspring_id a, b; ///< ends of the edge; MSPRING_NONE for a collider's
    double x, y, nx, ny;
} mspringi_contact_location;

/// Ongoing contact, from its begin event to its end event: of a particle with another body or a collider, or of a
/// collider's corners with a body.
typedef struct mspringi_ongoing_contact {
    mspring_id point;         ///< MSPRING_NONE for a collider's corners
    mspring_id other;         ///< lowest particle of the other body; MSPRING_NONE for a collider
    mspring_id collider;      ///< id, or MSPRING_NONE
    bool is_new;              ///< began in this step
    double largest;           ///< largest normal impulse of a constraint in an interval of this step, N s
    double impulse, friction; ///< sums of normal and tangential impulses in this step, N s
    mspringi_contact_location now, last; ///< where `largest` acted; the same of the last step with an impulse
} mspringi_ongoing_contact;

/// Ongoing contacts by point, collider and other, and a ring of unread events.
typedef struct mspringi_contact_events {
    mspringi_ongoing_contact *list; ///< [capacity]
    mspring_contact_event *ring;    ///< [capacity]
    uint32_t capacity;              ///< of both
    uint32_t count;                 ///< ongoing contacts
    uint32_t first, waiting;        ///< oldest event in the ring; unread events
    uint32_t dropped, max_dropped;  ///< constraints without room in the interval; most in an interval of the step
    uint64_t lost;                  ///< events and contacts without room since the reservation
    bool is_known;                  ///< false: contacts at rest get no begin event, as they began before
} mspringi_contact_events;

/// Friction and restitution of a contact.
typedef struct mspringi_contact_material {
    float friction, restitution; ///< of a particle, < 0 means the value of the definition
} mspringi_contact_material;

/// Remembered edges that a point never touches: neighbours on a straight outline.
#define MSPRINGI_EXCLUDED_EDGES 6u

/// Why contact will reject the step. Then nothing more is done for it.
typedef enum mspringi_contact_rejection {
    MSPRINGI_CONTACT_SOUND,             ///< it will not
    MSPRINGI_CONTACT_LACKS_PAIRS,       ///< the list has no room for a pair
    MSPRINGI_CONTACT_LACKS_CONSTRAINTS, ///< an interval has none for a constraint
    MSPRINGI_CONTACT_LACKS_WORK         ///< it took more than most_work
} mspringi_contact_rejection;

struct mspringi_contacts {
    mspring_contact_def def;
    double thickness, push; ///< m; largest speed of push-out, m/s
    bool touches_itself;
    uint32_t particles;                   ///< capacity: ids, spare ones included
    size_t edge_capacity;                 ///< springs and nodes
    uint32_t *groups, *masks;             ///< [nodes]
    mspringi_contact_material *materials; ///< [particles]; NULL without values of single particles
    mspringi_outline outline;
    mspringi_edge_grid grid;
    mspringi_colliders colliders;
    mspringi_contact_events events;

    // Verlet list: all near pairs.
    mspringi_pair *list; ///< [capacity]
    uint32_t count, capacity;
    mspringi_candidate *candidates; ///< [capacity] pairs that may touch before the next scan
    uint32_t candidate_count;
    bool is_listed;
    mspringi_inner_points inner;
    uint64_t work, most_work; ///< comparisons of points with edges in this step, or what takes as long; their limit
    double *margin;          ///< [nodes] the list held all pairs nearer than thickness and both margins when it was
                             ///< made, m
    double *seen_x, *seen_y; ///< [nodes] positions when the list was made, m
    uint32_t *stamp;         ///< [particles] springs between the particle and stamp_of (outline.c)
    uint32_t stamp_of;
    bool are_all_stamped;     ///< false: particles two springs away are stamped on request
    uint32_t *excluded_edges; ///< [particles][MSPRINGI_EXCLUDED_EDGES] edges that the particle never touches, or
                              ///< MSPRING_NONE

    // The last scan.
    double *x, *y; ///< [nodes] positions, m
    double mean_vx, mean_vy;
    double *speed;         ///< [nodes] relative to the mean, or min_speed, m/s
    double *assumed_speed; ///< [nodes] the same, or that of a faster point that may hit this one, m/s
    double *square_moved;  ///< [nodes] square of the displacement relative to the mean since the list was made, m^2
    double mean_speed, min_speed, max_speed; ///< of `speed`, m/s
    bool is_uniform;                         ///< all have max_speed
    mspringi_speed_bound travel;             ///< way of a point in a substep, m
    mspringi_speed_bound candidate_margin;   ///< way until the next scan, with what constraints reach beyond, m
    double candidate_substeps;               ///< substeps until the next scan
    double nearest;                          ///< distance of the nearest pair in the list, m
    bool has_distances;                      ///< pairs have their distances
    uint32_t quiet_at_scan;                  ///< quiet substeps found by the last scan
    bool is_fresh;                           ///< nothing moved since
    uint64_t state, sleep_changes;           ///< counters of network->edits at the scan
    float scan_h;
    double scan_dt;

    // A step.
    float h;                      ///< length of a substep, s
    double dt;                    ///< length of the step, s
    uint32_t quiet_substeps;      ///< next substeps in which nothing can touch
    uint32_t substeps_to_refresh; ///< substeps until the next refresh of the list
    uint32_t first_substep;       ///< first of the substeps now taken together
    uint32_t substeps_done;       ///< substeps finished
    bool has_sleepers;            ///< islands slept when the step began; bodies that reach them wake them
    uint32_t substeps_since_scan; ///< quiet substeps since the last scan
    double least_gap;             ///< gap of the nearest pair at the last scan, m
    double *extra_speed;          ///< [nodes] speed from contact beyond the scan's assumption, m/s; else 0
    bool has_extra_speed;         ///< some are not 0
    mspringi_contact_rejection rejection;
    bool is_missed;     ///< pairs could touch in a quiet substep: repeat the step
    bool is_second_try; ///< repeated step: scan after each substep

    // An interval.
    mspringi_contact_nodes nodes;
    mspringi_contact_constraint *constraints; ///< [constraint_capacity]
    mspringi_due_constraints due;
    uint32_t *colours;     ///< [nodes] colours of its pending constraints, as bits
    uint8_t *is_seen;      ///< [capacity] candidates with a constraint, while more are added
    uint32_t *near_misses; ///< [capacity] candidates just out of reach
    uint32_t constraint_count, near_miss_count, constraint_capacity;
    mspringi_pending_constraint pending[MSPRINGI_MAX_PENDING];
    uint32_t pending_count, max_pending;
    mspringi_implicit_constraint *implicit_constraints; ///< [constraint_capacity] the same constraints in a linear
                                                        ///< system; NULL unless a solver has one
    double passed;                                      ///< time taken in intervals of an implicit substep, s
    double fall_x, fall_y; ///< change of velocity by gravity in an implicit interval, m/s; 0 after forces
    double share;          ///< length of an implicit interval as a share of its substep; else 1
    double kept_push;      ///< faster push-out of overlaps is relaxed, m/s; DBL_MAX: none is
    double max_push; ///< limit of such push-out where nothing approaches, m/s, raised for weights (relaxation.c)
    bool has_push;   ///< constraints of this interval may have such push-out
    mspringi_floor_support *supports; ///< [MSPRINGI_MAX_SUPPORTS * nodes]
    uint32_t support_count;
    uint32_t touching; ///< largest number of pushing constraints in an interval
    double deepest;    ///< deepest overlap, m
};

typedef struct mspringi_contacts mspringi_contacts;

static inline bool mspringi_contact_is_rejected(const mspringi_contacts *contacts) {
    return contacts->rejection != MSPRINGI_CONTACT_SOUND;
}

/// Reject the step, for the first reason that is found.
static inline void mspringi_contact_reject(mspringi_contacts *contacts, mspringi_contact_rejection why) {
    if (contacts->rejection == MSPRINGI_CONTACT_SOUND)
        contacts->rejection = why;
}

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
    double share = 0.0;
    if (square > 0.0) {
        share = ((px - ax) * ex + (py - ay) * ey) / square;
        share = share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share;
    }
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
static inline double mspringi_margin_of_edge(const mspringi_contacts *contacts, uint32_t edge) {
    return mspringi_max_of_ends(contacts, contacts->margin, edge);
}

/* pair_list.c */

/// Make a new list if pairs may be missing, and collect the candidates. is_missed becomes true if a pair could have
/// touched in the last `quiet` substeps, which had no constraints. False: the step is rejected.
bool mspringi_pair_list_refresh(const mspring_network *network, mspringi_contacts *contacts, uint32_t quiet);
/// Refresh the list unless nothing moved since the last scan, and count the quiet substeps. False: as above.
bool mspringi_pair_list_scan(const mspring_network *network, mspringi_contacts *contacts, uint32_t quiet);
/// Replace the list by all pairs nearer than `reach`, m, for piles. The next scan makes its own list.
void mspringi_near_list(const mspring_network *network, mspringi_contacts *contacts, double reach);

/* constraints.c */

/// Near misses: pairs out of reach by less than this share of the thickness. Small impulses may bring them in
/// reach.
#define MSPRINGI_NEAR_MISS_FRACTION 0.01

/// Save the nodes before a substep.
void mspringi_contact_begin_substep(const mspring_network *network, mspringi_contacts *contacts);
/// Load the nodes before an interval.
void mspringi_contact_load_nodes(const mspring_network *network, mspringi_contacts *contacts);
/// Make the constraints of an implicit interval of h seconds, with a larger reach, because springs and other bodies
/// may push in it. Return the largest speed, m/s.
double mspringi_contact_prepare_implicit(const mspring_network *network, mspringi_contacts *contacts, double h);
/// Make the constraints of an interval of h seconds: of pairs that may touch at their own speed or at `given`. At
/// most `pending` are coloured together. Return the largest speed, m/s.
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

/* floor_support.c */

/// Find the supports of nodes near the floor, if there are contact constraints.
void mspringi_floor_support_find(const mspring_network *network, mspringi_contacts *contacts);
/// Begin an interval of h seconds.
void mspringi_floor_support_begin(const mspringi_contacts *contacts, double h);
/// Sweep the supports once.
void mspringi_floor_support_sweep(const mspringi_contacts *contacts);
/// Add the impulses of the interval to the floor's.
void mspringi_floor_support_end(const mspring_network *network, const mspringi_contacts *contacts);

/* gauss_seidel.c */
/// Overlap up to which bodies may get deeper, as a share of the thickness.
#define MSPRINGI_KEPT_DEPTH 0.05

/// Relative normal speed of the point and the closest point of the edge, m/s; > 0 opens the gap.
static inline double mspringi_normal_speed(const mspringi_contact_constraint *t, const mspringi_velocity *v) {
    return t->nx * (v[t->p].x - t->bary_a * v[t->a].x - t->bary_b * v[t->b].x) +
           t->ny * (v[t->p].y - t->bary_a * v[t->a].y - t->bary_b * v[t->b].y);
}
/// Sweep all constraints so many times, or once those that push overlaps apart, and count the work.
void mspringi_contact_sweep(mspringi_contacts *contacts, uint32_t sweeps);
void mspringi_contact_sweep_pushed(mspringi_contacts *contacts);
/// Find and apply the normal impulse of a constraint alone.
void mspringi_contact_push_apart(const mspringi_contacts *contacts, uint32_t constraint);

/* contact_stage.c */

/// Distance beyond the thickness, as a share of it, up to which bodies rest on each other.
#define MSPRINGI_RESTING_SHARE 0.05

/// True if point and edge rest on each other, or may after `way` metres.
bool mspringi_pair_is_resting(const mspring_network *network, const mspringi_contacts *contacts,
                              const mspringi_pair *pair, double way);

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

/* contact_materials.c */
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
/// Distance from a constraint's point to the surface where friction acts, m: the collider's radius, or 0.
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

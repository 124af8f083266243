/// @file contact_state.h
/// The data of contact between bodies (contacts.h).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CONTACT_STATE_H
#define MSPRINGI_CONTACT_STATE_H

#include <massspring/massspring.h>

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
    uint32_t candidate;
    uint32_t place; ///< among the constraints; its colour at first
} mspringi_pending_constraint;

/// Contact constraint between rigid bodies, in one direction (solvers/implicit/rigid_contact.c). Index 0 is the
/// side of the point, 1 that of the edge.
typedef struct mspringi_rigid_direction {
    double arms[2]; ///< torque on each body for a unit of impulse, m
    double speed;   ///< relative speed of the bodies without impulses, m/s
    double mass;    ///< impulse per change of speed, kg; 0: none acts
} mspringi_rigid_direction;

/// Contact constraint in the linear system (solvers/implicit/implicit_contact.c). Index 0 is the point, 1 and 2 are
/// the ends of the edge.
typedef struct mspringi_implicit_constraint {
    uint32_t slots[3];                 ///< MSPRING_NONE: not an unknown of the system
    uint32_t listed;                   ///< index of its push in network->constraints; MSPRING_NONE: impulses only
    double across[3][2], along[3][2];  ///< Jacobians of the normal and the tangential displacement
    double spare;                      ///< slack before a bouncing constraint becomes active, m
    double friction;                   ///< 0: it has no friction in the system
    double mended;                     ///< more impulse of its spring, had it not given way by what was mended, N s
    bool is_active;                    ///< in the active set at the prediction
    uint32_t bodies[2];                ///< of point and edge, if contact moves rigid bodies; MSPRINGI_NO_COMPONENT
    mspringi_rigid_direction rigid[2]; ///< across and along
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

/// Remembered edges that a point never touches: neighbours on a straight outline.
#define MSPRINGI_EXCLUDED_EDGES 6u

/// Why contact will reject the step. Then nothing more is done for it.
typedef enum mspringi_contact_rejection {
    MSPRINGI_CONTACT_SOUND,             ///< it will not
    MSPRINGI_CONTACT_LACKS_PAIRS,       ///< the list has no room for a pair
    MSPRINGI_CONTACT_LACKS_CONSTRAINTS, ///< an interval has none for a constraint
    MSPRINGI_CONTACT_LACKS_WORK         ///< it took more than most_work
} mspringi_contact_rejection;

/// All of contact, by how long it lasts.
struct mspringi_contacts {
    // As the host has set it.
    mspring_contact_def def;
    double thickness, push; ///< m; largest speed of push-out, m/s
    bool touches_itself;
    uint32_t *layers, *masks;             ///< [nodes]
    mspringi_contact_material *materials; ///< [particles]; NULL without values of single particles
    float *touch;                         ///< [2][particles] normal impulses, N s, of this step and of the last
    uint32_t touch_now;                   ///< index of those of this step
    bool has_touch[2];                    ///< not all of them are 0
    mspringi_colliders colliders;

    // Until edits change the shape of the bodies.
    uint32_t particles;   ///< capacity: ids, spare ones included
    size_t edge_capacity; ///< springs and nodes
    mspringi_outline outline;
    uint32_t *excluded_edges; ///< [particles][MSPRINGI_EXCLUDED_EDGES] edges that the particle never touches, or
                              ///< MSPRING_NONE

    // From one list of near pairs to the next.
    mspringi_pair *list; ///< [capacity] Verlet list: all near pairs
    uint32_t count, capacity;
    bool is_listed;
    double *margin;          ///< [nodes] the list held all pairs nearer than thickness and both margins when it was
                             ///< made, m
    double *seen_x, *seen_y; ///< [nodes] positions when the list was made, m
    double *square_moved;    ///< [nodes] square of the displacement relative to the mean since then, m^2

    // From one scan to the next.
    mspringi_candidate *candidates; ///< [capacity] pairs that may touch before the next scan
    uint32_t candidate_count;
    mspringi_inner_points inner;
    double *x, *y; ///< [nodes] positions, m
    double mean_vx, mean_vy;
    double *speed;         ///< [nodes] relative to the mean, or min_speed, m/s
    double *assumed_speed; ///< [nodes] the same, or that of a faster point that may hit this one, m/s
    double mean_speed, min_speed, max_speed; ///< of `speed`, m/s
    bool is_uniform;                         ///< all have max_speed
    mspringi_speed_bound travel;             ///< way of a point in a substep, m
    mspringi_speed_bound candidate_margin;   ///< way until the next scan, with what constraints reach beyond, m
    double candidate_substeps;               ///< substeps until the next scan
    uint32_t substeps_to_refresh;            ///< of these, those that are left
    double nearest, least_gap;               ///< distance, and gap, of the nearest pair in the list, m
    bool has_distances;                      ///< pairs have their distances
    uint32_t quiet_at_scan;                  ///< quiet substeps found by the scan
    bool is_fresh;                           ///< nothing moved since
    uint64_t state, sleep_changes;           ///< counters of network->edits at the scan
    float scan_h;                            ///< `h` at the scan, s
    double scan_dt;                          ///< `dt` at the scan, s

    // A step.
    float h;                  ///< length of a substep, s
    double dt;                ///< length of the step, s
    uint64_t work, most_work; ///< comparisons of points with edges, or what takes as long; their limit
    uint32_t quiet_substeps;  ///< next substeps in which nothing can touch
    uint32_t first_substep;   ///< first of the substeps now taken together; solvers advance network->first_substep
    uint32_t substeps_done;   ///< substeps finished
    uint32_t substeps_since_scan; ///< quiet substeps since the last scan
    uint32_t solved_substeps;     ///< substeps with contact since the last scan
    bool has_sleepers;            ///< islands slept when the step began; bodies that reach them wake them
    double *extra_speed;          ///< [nodes] speed from contact or forces beyond a scan's assumption, m/s; else 0
    bool has_extra_speed;         ///< some are not 0
    mspringi_contact_rejection rejection;
    bool is_missed;                 ///< pairs could touch in a quiet substep: repeat the step
    bool is_second_try;             ///< repeated step: scan after each substep
    uint32_t touching;              ///< largest number of pushing constraints in an interval
    uint32_t reported_pairs;        ///< pairs at the end of the last step, before piles are looked for
    double deepest;                 ///< deepest overlap, m
    mspringi_contact_events events; ///< ongoing contacts, and what the host has not read

    // A substep of an implicit solver.
    mspringi_implicit_constraint *implicit_constraints; ///< [constraint_capacity] `constraints` in a linear system;
                                                        ///< NULL unless a solver has one
    double passed;                                      ///< time taken in intervals so far, s

    // An interval.
    mspringi_contact_nodes nodes;
    mspringi_contact_constraint *constraints; ///< [constraint_capacity]
    uint32_t constraint_count, constraint_capacity;
    uint32_t *near_misses; ///< [capacity] candidates just out of reach
    uint32_t near_miss_count;
    uint32_t pushed_count; ///< constraints that pushed an overlap apart, and are relaxed: in due.next, free by then
    mspringi_due_constraints due;
    double fall_x, fall_y; ///< change of velocity by gravity in an implicit interval, m/s; 0 after forces
    double share;          ///< length of an implicit interval as a share of its substep; else 1
    double kept_push;      ///< faster push-out of overlaps is relaxed, m/s; DBL_MAX: none is
    double max_push; ///< limit of such push-out where nothing approaches, m/s, raised for weights (relaxation.c)
    bool has_push;   ///< constraints of this interval may have such push-out
    mspringi_floor_support *supports; ///< [MSPRINGI_MAX_SUPPORTS * nodes]
    uint32_t support_count;

    // Scratch.
    mspringi_edge_grid grid;
    uint32_t *stamp; ///< [particles] springs between the particle and stamp_of (outline.c)
    uint32_t stamp_of;
    bool are_all_stamped;                 ///< false: particles two springs away are stamped on request
    uint32_t *colours;                    ///< [nodes] colours of its pending constraints, as bits
    uint8_t *is_seen;                     ///< [capacity] candidates with a constraint, while more are added
    mspringi_pending_constraint *pending; ///< [constraint_capacity]
    uint32_t pending_count, max_pending;  ///< the most that are coloured together
    double fastest;                       ///< largest speed of a pair that became pending, m/s
    uint32_t *of_shares;                  ///< stamp and grid.found of each share but the first (contact_ranges.c)
    uint32_t most_shares;                 ///< workers that share the work
};

typedef struct mspringi_contacts mspringi_contacts;

#endif

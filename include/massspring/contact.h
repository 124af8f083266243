/// @file contact.h
/// Contact of bodies: with floors, each other and colliders of the host; and grips. Include massspring.h.
///
///     floor       network_set_floor, _get_floor
///     contact     network_set_contact, _get_contact, _get_contact_info, _read_contact_events
///     colliders   network_add_collider, _remove_collider, _move_collider, _place_collider, _get_collider,
///                 _get_collider_impulse
///     grips       network_add_grip, _remove_grip, _set_grip, _move_grip, _get_grip, _get_grip_impulse
///
/// Which particles touch which, how rough they are and what touched them, are properties: MSPRING_LAYERS,
/// MSPRING_MASKS, MSPRING_FRICTION, MSPRING_RESTITUTION, MSPRING_FLOOR_IMPULSE_X and _Y.
///
/// Snapshots leave floor, contact and colliders as they are. Before you load one, set the same. Archives and clones
/// have all of them.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_CONTACT_H
#define MASSSPRING_CONTACT_H

#include "core.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --------------------------------------------------------------------------------------------------------- floor */

/// Most half-planes of a floor, and most heights.
#define MSPRING_MAX_PLANES 8u
#define MSPRING_MAX_HEIGHTS 0x4000000u

/// A floor: half-planes, such as walls, and a field of heights, such as a sea floor.
typedef struct mspring_floor_def {
    uint32_t struct_size;
    uint32_t plane_count;        ///< half-planes, at most MSPRING_MAX_PLANES; default 0
    double heights_x, heights_y; ///< x of the first height, y of height 0, m, world coordinates; default 0
    double spacing;              ///< m from one height to the next, 1e-9 to 1e9; default 1
    const double *planes;  ///< [plane_count][4]: x, y of a point on the border (m, world coordinates), x, y of a normal
                           ///< of any length. It points to the side where particles may be.
    const float *heights;  ///< [height_count], m above heights_y, joined by straight lines, level beyond both ends;
                           ///< NULL, the default: all 0
    uint32_t height_count; ///< 1, for level ground, to MSPRING_MAX_HEIGHTS; 0, the default: no heights
    float friction;        ///< of sliding (Coulomb): force along the surface over that across it, 0 to 1e6; default 0
    float restitution;     ///< speed across the surface after contact over that before, 0 to 1; default 0
    uint32_t reserved;     ///< 0
    /// Friction and restitution of each plane, and of each straight part of the heights from left to right. The first
    /// and the last part go on beyond the ends. NULL, the default: the fields friction and restitution everywhere.
    /// Particles may have their own (MSPRING_FRICTION, MSPRING_RESTITUTION): then the friction is the square root of
    /// the product of both, and the larger restitution counts.
    const float *plane_frictions, *plane_restitutions;   ///< [plane_count]
    const float *height_frictions, *height_restitutions; ///< [height_count - 1]
    float silt_depth; ///< m of silt above the heights, straight up, 0 to 1e12: a soft layer that brakes; default 0
    float silt_rate;  ///< 1/s, 0 to 1e6: dv/dt = -silt_rate v at the heights, less above, 0 at its top; default 0
    const float *silt_depths;     ///< [height_count], m of silt above each height, 0 to 1e12, joined by straight lines,
                                  ///< level beyond both ends; silt_depth must be 0. NULL, the default: silt_depth
                                  ///< everywhere
    const void *reserved_pointer; ///< NULL
} mspring_floor_def;
MSPRING_DEFAULT(mspring_floor_def, MSPRING_STRUCT_FLOOR_DEF);

/// Set the floor, instead of the one that the network has.
/// It acts on every particle that is not pinned, in every substep. A particle that was above it is not below it
/// afterwards, at any speed, but for a millionth of its distance from the local origin. One that was below is put
/// onto it. Contact takes energy and gives none; the guide floor.md names the exceptions, and what
/// bounces how. Snapshots, state hashes and mspring_network_settle() do not contain the floor.
/// @param def  copied with all that it points to; NULL: no floor
/// Threads: exclusive. Allocates: yes. Errors: ARGUMENT also for a floor without planes and heights; STRUCT, MEMORY,
/// BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_floor(
    mspring_network *network, const mspring_floor_def *def);

/// Read the floor.
/// If you set one again, nothing changes. Without a floor both counts are 0. Its arrays are the network's copies, valid
/// until the floor is set again or the network is destroyed.
/// Threads: shared. Allocates: never. Errors: ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_floor(
    const mspring_network *network, mspring_floor_def *def);

/* ------------------------------------------------------------------------------------------------------- contact */

/// Flags of mspring_contact_def.
typedef enum mspring_contact_flags {
    MSPRING_CONTACT_SELF = 1 << 0 ///< a body touches itself, too; else only other bodies
} mspring_contact_flags;

/// Contact between bodies, and of a body with itself.
typedef struct mspring_contact_def {
    uint32_t struct_size;
    uint32_t flags; ///< MSPRING_CONTACT_SELF or 0; default MSPRING_CONTACT_SELF
    /// Distance (m) that points keep from springs, > 0, at most 1e6. With MSPRING_CONTACT_SELF at most 0.9 of the
    /// shortest rest length at creation. Default 0: half of that length; without springs, set another.
    double thickness;
    float friction;        ///< of bodies that slide (Coulomb), 0 to 1e6; default 0
    float restitution;     ///< speed across the contact after it over that before, 0 to 1; default 0
    float push_speed;      ///< overlaps are pushed apart at this speed at most, m/s, 0 to 1e6; default -1: half the
                           ///< thickness a second, at most 3
    uint32_t sweeps;       ///< over all contacts in a substep, 1 to 64; default 4. With more, stacks lie stiller.
    uint32_t capacity;     ///< pairs of a point and a spring that there is room for at first, at most 2^26; default 0:
                           ///< 4096 + 2 for each particle + 16 for each particle of the outline
    uint32_t max_capacity; ///< pairs that there may be room for, at most 2^26; default 0: 16 times the default of
                           ///< capacity. A step with more near pairs than there is room for makes more. Equal to
                           ///< capacity: no step allocates
    uint32_t event_capacity; ///< contact events that may wait to be read, and contacts that are followed at a time, at
                             ///< most 0x1000000; default 0: record none. A new number drops events that wait.
    uint32_t reserved;       ///< 0
} mspring_contact_def;
MSPRING_DEFAULT(mspring_contact_def, MSPRING_STRUCT_CONTACT_DEF);

/// Let the bodies of a network collide, or change how they do.
/// A body is a component. The outline of the network is all springs with a free side, and particles without springs.
/// Ropes and trusses are all outline. Particles of the outline, its points, keep the distance thickness from its
/// springs, also where forces throw them past these in a step from rest. Inner particles keep it from colliders only.
/// If one spring or two in a row join two particles, neither collides with the other's springs. The outline follows
/// breaks, additions and removals. The guide contact.md has the guarantees.
///
/// Which side of a spring is free follows from the positions at this call, and from those at which particles were added
/// later. So set contact before the network deforms. Springs that cross at the start stay crossed.
///
/// Overlaps, at the start or after a break, are pushed apart. With the explicit solver that leaves no velocity. Where
/// springs press an overlap together by more than half of push_speed in a substep it stays, so that they do not store
/// energy for it; weights of 64 particles may. With the implicit and the direct solver what is pushed keeps push_speed.
///
/// If the network has contact already, the outline keeps the shape that it was found by. Layers, masks, surfaces,
/// colliders with their moves, contacts and events that wait stay, too. All bodies wake. If only capacities change,
/// none wakes, and the next steps have the same bits as without the call. To begin anew, remove contact first.
///
/// All solvers have contact. With the implicit and the direct solver it is part of the linear system. Substeps in which
/// bodies touch are then of implicit Euler, and keep the energy budget, whatever integrator and guard are set.
/// mspring_network_tune() and mspring_network_settle() leave contact out.
///
/// Snapshots leave contact as it is, as they leave the floor. They hold the outline's shape only. Before you load one,
/// set the same contact, layers, masks and surfaces. Then the next steps have the same bits.
///
/// If more than capacity pairs are near each other, or more than an eighth of capacity and 1024 may touch in a substep,
/// a step is undone, doubles the capacity, and is made again in the same call. It has the bits that it would have had
/// with that room from the first, and MSPRING_STEP_GREW. So a game loop need not know of this. Without memory it
/// returns MSPRING_ERROR_MEMORY, and beyond max_capacity MSPRING_ERROR_LIMIT, with the state of before. If max_capacity
/// is 0, at most half of the default of capacity, or an eighth of capacity if that is more, plus 1024 may touch.
///
/// A step returns MSPRING_ERROR_LIMIT, too, if a run of its substeps takes too much work. Work is comparisons of
/// points of the outline with springs near them that form no pair. Visits of springs at particles with over 64 of
/// these count, too, and visits of constraints beyond 768 for each. A run may take 3.1 million comparisons, or work
/// that takes as long, about 75 ms. Each list of pairs adds 32 for each point. Each implicit or direct substep adds
/// 2.6 million, and 3000 for each particle. Large scenes stay far below. The message names the particle with the most
/// springs of the outline.
///
/// A step that is undone and repeated has several runs, for instance with more room or other substeps. Each run counts
/// its work from zero, so the whole step may take several times this limit.
///
/// Springs inside a body are told by the triangles at them. In networks where hundreds of particles are joined to
/// hundreds each, that may take over 16 million comparisons and 32 for each spring: then the call fails.
/// @param def  copied; NULL: no contact, the default. Layers, masks, surfaces, colliders and events are forgotten.
/// Threads: exclusive. Allocates: yes; about 700 bytes for a particle, 1000 more for one of the outline, 100 for a
/// spring. With an implicit or a direct solver, also as the fallback, 60 and 1300 more. Errors: ARGUMENT (the message
/// names the field), STRUCT, MEMORY, BUSY; LIMIT (the message names a particle).
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_contact(
    mspring_network *network, const mspring_contact_def *def);

/// Read the contact.
/// Without contact capacity is 0. With it, thickness, push_speed, capacity and max_capacity are those in use.
/// Threads: shared. Allocates: never. Errors: ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_contact(
    const mspring_network *network, mspring_contact_def *def);

/// Report of contact in the last step.
typedef struct mspring_contact_info {
    uint32_t struct_size;
    uint32_t edges;    ///< of the outline: springs with a free side, and particles without springs
    uint32_t points;   ///< of the outline
    uint32_t pairs;    ///< pairs of a point and an edge that are looked at
    uint32_t touching; ///< pairs that pushed each other in a substep of the step, at most; 0: nothing touched
    uint32_t reserved; ///< 0
    double deepest;    ///< largest overlap in the step, m; 0 if there was none
} mspring_contact_info;
MSPRING_DEFAULT(mspring_contact_info, MSPRING_STRUCT_CONTACT_INFO);

/// Read the report of contact. Without contact, and before the first step with it, all numbers are 0.
/// Threads: shared. Allocates: never. Errors: ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_contact_info(
    const mspring_network *network, mspring_contact_info *info);

/* -------------------------------------------------------------------------------------------------------- events */

/// Kind of a contact event.
typedef enum mspring_contact_event_kind {
    MSPRING_CONTACT_BEGAN = 0,                   ///< an impulse acted where there was no contact before
    MSPRING_CONTACT_ENDED = 1,                   ///< they have parted
    MSPRING_CONTACT_EVENT_INT = MSPRING_ENUM_INT ///< no value
} mspring_contact_event_kind;

/// A contact that began or ended in a step: of a particle with another body, of a particle with a collider, or of a
/// collider's corners with a body. With MSPRING_CONTACT_SELF the other body may be the particle's own.
typedef struct mspring_contact_event {
    uint32_t struct_size;
    mspring_contact_event_kind kind;
    mspring_id point;          ///< the particle; MSPRING_NONE: corners of the collider
    mspring_id a, b;           ///< ends of the spring that it touches, a <= b; both are a particle without springs;
                               ///< MSPRING_NONE: the collider's sides
    mspring_id collider;       ///< MSPRING_NONE: none
    double x, y;               ///< where, on the spring or the collider's surface, m, world coordinates
    double normal_x, normal_y; ///< of length 1, from the spring or the sides to the particle or the corner; 0, 0 if
                               ///< a loaded contact ends without an impulse since
    double impulse;            ///< across, of the step, sum of sizes, N s; 0 if kind is MSPRING_CONTACT_ENDED. With
                               ///< the explicit solver without what pushed an overlap apart, else with it
    double friction;           ///< along, likewise
} mspring_contact_event;
MSPRING_DEFAULT(mspring_contact_event, MSPRING_STRUCT_CONTACT_EVENT);

/// Read and remove the oldest contact events.
/// Those of a step come by rising particles, corners last: the order is the same on every machine. Contacts that go
/// on come before new ones where there is no room for all, and of new ones those of the first substep.
/// @param events    [capacity], struct_size set in the first, the same for all; may be NULL if capacity is 0
/// @param count     receives how many were read
/// @param lost      receives how many had no room since it was reserved, and in each step the most contacts at a
///                  time that were not followed; may be NULL
/// Threads: exclusive. Allocates: never. Errors: ARGUMENT (also without contact), STRUCT, BUSY.
MSPRING_API mspring_result MSPRING_CALL mspring_network_read_contact_events(
    mspring_network *network, mspring_contact_event *events, uint32_t capacity, uint32_t *count, uint64_t *lost);

/* ----------------------------------------------------------------------------------------------------- colliders */

/// Most points of a chain.
#define MSPRING_MAX_COLLIDER_POINTS 0x10000u

/// Shapes of colliders.
typedef enum mspring_collider_kind {
    MSPRING_COLLIDER_CHAIN = 0,             ///< straight sides from point to point
    MSPRING_COLLIDER_BOX = 1,               ///< a rectangle around its position
    MSPRING_COLLIDER_CIRCLE = 2,            ///< a circle around its position
    MSPRING_COLLIDER_INT = MSPRING_ENUM_INT ///< no value
} mspring_collider_kind;

/// Flags of mspring_collider_def.
typedef enum mspring_collider_flags {
    MSPRING_COLLIDER_CLOSED = 1 << 0 ///< a side joins the last point of a chain to the first
} mspring_collider_flags;

/// A collider: a shape that the host owns and moves, and that bodies collide with. Half-planes and fields of heights
/// are mspring_floor_def's.
typedef struct mspring_collider_def {
    uint32_t struct_size;
    mspring_collider_kind kind; ///< default MSPRING_COLLIDER_CHAIN
    double x, y;                ///< position, m, world coordinates, at most MSPRING_MAX_COORDINATE in size; default 0
    double angle;               ///< rad, counterclockwise around the position, at most 1e6 in size; default 0
    double width, height;       ///< of a box, m, > 0, at most MSPRING_MAX_COORDINATE; default 1
    /// Of a circle, m, > 0, at most MSPRING_MAX_COORDINATE. Chains and boxes are this much thicker, and rounded; 0 is
    /// allowed for them. Default 0: set it for a circle.
    double radius;
    const double *points; ///< [point_count][2]: x, y of a chain's points, m, relative to its position, before the turn
    void *reserved_pointer; ///< NULL
    uint32_t point_count;   ///< of a chain 2 (closed 3) to MSPRING_MAX_COLLIDER_POINTS; else 0, the default
    uint32_t flags;         ///< MSPRING_COLLIDER_CLOSED or 0, the default
    float friction;         ///< of what touches it, instead of the contact's, 0 to 1e6; default 0
    float restitution;      ///< the same, 0 to 1; default 0
    uint32_t layers, masks; ///< bits, as of particles; default 1 and 0xffffffff
} mspring_collider_def;
MSPRING_DEFAULT(mspring_collider_def, MSPRING_STRUCT_COLLIDER_DEF);

/// Add a collider.
/// Bodies keep the contact's thickness from it. No outline passes it, from either side: boxes and closed chains are
/// walls around a space, and what lies inside stays inside. Inner particles keep out, too; those of very soft bodies
/// may still pass other bodies. Sides may cross. Colliders do not touch each other. Their mass is infinite. The
/// contact's sweeps and push_speed are theirs, too. The guide contact.md has the guarantees.
///
/// Colliders need contact. If only colliders are to touch particles, set layers and masks by which particles do not
/// touch each other.
///
/// Snapshots leave colliders out, as they leave the floor. Before you load one, add the same colliders and place them.
/// Clones have them. All bodies wake.
/// @param def       copied, with its points
/// @param collider  receives its id; may be NULL
/// Threads: exclusive. Allocates: yes; 1 to 3 kB for a point. Errors: ARGUMENT (also without contact), STRUCT, MEMORY,
/// BUSY, LIMIT for more than 0x1000000 points in all.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_collider(
    mspring_network *network, const mspring_collider_def *def, mspring_id *collider);

/// Remove a collider. All bodies wake.
/// Threads: exclusive. Allocates: never. Errors: ID, ARGUMENT, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_remove_collider(
    mspring_network *network, mspring_id collider);

/// Set where a collider is to be at the end of the next step.
/// In that step it moves and turns at an even speed, and pushes bodies in its way. From then on it stands still. If the
/// step fails, the collider has not moved, and the next step moves it. A moving collider wakes the bodies it comes to,
/// and none falls asleep on it.
/// @param x  as in mspring_collider_def. An angle of more than half a turn away makes it spin: it goes the
///                whole way.
/// @param y  as x
/// @param angle  as x
/// Threads: exclusive. Allocates: never. Errors: ID, ARGUMENT, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_move_collider(
    mspring_network *network, mspring_id collider, double x, double y, double angle);

/// Put a collider somewhere else at once.
/// It touches nothing on its way. A body that it overlaps there is pushed apart from it. A body that it lies across
/// stays so. A move that was set is dropped. All bodies wake.
/// @param x  as in mspring_collider_def
/// @param y  as x
/// @param angle  as x
/// Threads: exclusive. Allocates: never. Errors: ID, ARGUMENT, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_place_collider(
    mspring_network *network, mspring_id collider, double x, double y, double angle);

/// Read a collider.
/// Position and angle are those of now. points leads to the network's copy, valid until a collider is added or removed
/// or contact is set.
/// Threads: shared. Allocates: never. Errors: ID, ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_collider(
    const mspring_network *network, mspring_id collider, mspring_collider_def *def);

/// Read the impulses that bodies gave to a collider in the last step.
/// To move the collider as a rigid body, add the impulse to its momentum, and the angular impulse to its angular
/// momentum around its position. Both totals are then conserved. Bodies that sleep give nothing. With the explicit
/// solver impulses leave out what pushed an overlap apart; with the others they have it.
/// @param x  impulse, N s
/// @param y  as x
/// @param angular  angular impulse around the position at the end of the step, N m s, counterclockwise
/// Threads: shared. Allocates: never. Errors: ID, ARGUMENT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_collider_impulse(
    const mspring_network *network, mspring_id collider, double *x, double *y, double *angular);

/* --------------------------------------------------------------------------------------------------------- grips */

/// Grips that a network can have at a time.
#define MSPRING_MAX_GRIPS 16u

/// A soft hold of a particle, as of a mouse or a finger.
///
/// The grip pulls the particle with the force
///     F = stiffness (target - p) + damping (velocity of the target - v),    |F| <= max_force
/// at the end of each substep (implicit Euler). So it is stable with any stiffness, dt and solver. To hold a body of
/// mass M at the angular frequency w without overshoot, use stiffness = M w^2 and damping = 2 M w.
typedef struct mspring_grip_def {
    uint32_t struct_size;
    mspring_id particle; ///< default MSPRING_NONE: set it
    double x, y;         ///< target, world position, m, at most MSPRING_MAX_COORDINATE in size; default 0
    float stiffness;     ///< N/m, 0 to 1e30; default 0
    float damping;       ///< N s/m, 0 to 1e30; default 0
    float max_force;     ///< N, 0 to MSPRING_NEVER; default MSPRING_NEVER: no bound
    uint32_t reserved;   ///< 0
} mspring_grip_def;
MSPRING_DEFAULT(mspring_grip_def, MSPRING_STRUCT_GRIP_DEF);

/// Add a grip: hold a particle.
/// The target is at rest at first. The particle's component wakes. If the particle is removed, the grip is, too.
///
/// A pinned particle does not feel a grip. Snapshots and clones have the grips, with their ids.
/// mspring_network_settle() leaves them out. While a grip acts, the explicit solver takes substeps one by one, as with
/// hooks.
///
/// The target may be far away. Then a stiff grip without max_force throws the particle, as a stiff spring would. The
/// guide grips.md has the details.
/// @param def   copied
/// @param grip  receives its id; may be NULL
/// Threads: exclusive. Allocates: at the first call; 2 kB. Errors: ARGUMENT (the message names the field), ID, STRUCT,
/// BUSY, MEMORY, LIMIT for more than MSPRING_MAX_GRIPS.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_grip(
    mspring_network *network, const mspring_grip_def *def, mspring_id *grip);

/// Remove a grip: let go. The particle's component wakes.
/// Threads: exclusive. Allocates: never. Errors: ID, ARGUMENT, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_remove_grip(
    mspring_network *network, mspring_id grip);

/// Change what a grip does.
/// If it holds the same particle as before, its target moves as by mspring_network_move_grip(). Otherwise it begins
/// anew.
/// @param def  copied
/// Threads: exclusive. Allocates: never. Errors: ARGUMENT (the message names the field), ID, STRUCT, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_grip(
    mspring_network *network, mspring_id grip, const mspring_grip_def *def);

/// Move the target of a grip.
/// In the next step the target goes there in a straight line. It rests from then on.
/// @param x  world position, m, at most MSPRING_MAX_COORDINATE in size
/// @param y  as x
/// Threads: exclusive. Allocates: never. Errors: ID, ARGUMENT, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_move_grip(
    mspring_network *network, mspring_id grip, double x, double y);

/// Read a grip. The target is the one given last.
/// Threads: shared. Allocates: never. Errors: ID, ARGUMENT, STRUCT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_grip(
    const mspring_network *network, mspring_id grip, mspring_grip_def *def);

/// Read the impulse (N s) that a grip gave its particle in the last step.
/// It is the sum of force times substep, and at most max_force times dt. While the particle sleeps, it is that of the
/// last step before.
/// @param x  receive the impulse
/// @param y  as x
/// Threads: shared. Allocates: never. Errors: ID, ARGUMENT.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_grip_impulse(
    const mspring_network *network, mspring_id grip, double *x, double *y);

#ifdef __cplusplus
}
#endif

#endif

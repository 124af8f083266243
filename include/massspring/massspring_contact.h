/// @file massspring_contact.h
/// Bodies that meet: contact between bodies, colliders of the host, and grips.
///
///     contact     network_set_contact, _get_contact, _set_contact_groups, _set_contact_surface, _get_contact_info;
///                 contact_def_init
///     events      network_reserve_contact_events, _read_contact_events
///     colliders   network_add_collider, _remove_collider, _move_collider, _place_collider, _get_collider,
///                 _get_collider_impulse; collider_def_init
///     grips       network_add_grip, _remove_grip, _set_grip, _move_grip, _get_grip, _get_grip_impulse; grip_def_init
///
/// These calls are not frozen yet: a later minor version may change them. massspring.h explains the notation. The floor
/// is part of massspring.h.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_MASSSPRING_CONTACT_H
#define MASSSPRING_MASSSPRING_CONTACT_H

#include "massspring.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------------------------------------------- contact */

/// Flags of mspring_contact_def.
enum {
    MSPRING_CONTACT_SELF = 1u << 0 ///< a body touches itself, too; else only other bodies
};

/// Contact between bodies, and of a body with itself. Fill with mspring_contact_def_init() first.
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
} mspring_contact_def;

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_API mspring_result MSPRING_CALL mspring_contact_def_init(mspring_contact_def *def, size_t size);

/// Let the bodies of a network collide, or change how they do.
/// A body is a component. The outline of the network is all springs with a free side, and particles without springs.
/// Ropes and trusses are all outline. Particles of the outline, its points, keep the distance thickness from its
/// springs. If one spring or two in a row join two particles, neither collides with the other's springs. The outline
/// follows breaks, additions and removals. The guide examples/guides/contact.md has the guarantees.
///
/// Which side of a spring is free follows from the positions at this call, and from those at which particles were added
/// later. So set contact before the network deforms. Springs that cross at the start stay crossed.
///
/// Overlaps, at the start or after a break, are pushed apart. With the explicit solver that leaves no velocity. Where
/// springs press an overlap together by more than half of push_speed in a substep it stays, so that they do not store
/// energy for it; weights of 64 particles may. With the implicit and the direct solver what is pushed keeps push_speed.
///
/// If the network has contact already, the outline keeps the shape that it was found by. Groups, surfaces, colliders
/// with their moves, contacts and events that wait stay, too. All bodies wake. If only capacity or max_capacity changes,
/// none wakes, and the next steps have the same bits as without the call. To begin anew, remove contact first.
///
/// All solvers have contact. With the implicit and the direct solver it is part of the linear system. Substeps in which
/// bodies touch are then of implicit Euler, and keep the energy budget, whatever integrator and guard are set.
/// mspring_network_tune() and mspring_network_settle() leave contact out.
///
/// Snapshots leave contact as it is, as they leave the floor. They hold the outline's shape only. Before you load one,
/// set the same contact, groups and surfaces. Then the next steps have the same bits.
///
/// If more than capacity pairs are near each other, or more than an eighth of capacity and 1024 may touch in a substep,
/// a step is undone, doubles the capacity, and is made again in the same call. It has the bits that it would have had
/// with that room from the first, and MSPRING_STEP_GREW. So a game loop need not know of this. Without memory it returns
/// MSPRING_ERROR_MEMORY, and beyond max_capacity MSPRING_ERROR_LIMIT, with the state of before. If max_capacity is 0, at
/// most half of the default of capacity, or an eighth of capacity if that is more, plus 1024 may touch.
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
/// @param def  copied; NULL: no contact, the default. Groups, surfaces, colliders and events are forgotten.
/// @threads exclusive   @allocates yes; about 700 bytes for a particle, 1000 more for one of the outline, 100 for a
///          spring. With an implicit or a direct solver, also as the fallback, 60 and 1300 more.
/// @errors ARGUMENT (the message names the field), STRUCT, MEMORY, BUSY; LIMIT (the message names a particle)
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_contact(
    mspring_network *network, const mspring_contact_def *def);

/// Read the contact. Set struct_size first.
/// Without contact capacity is 0. With it, thickness, push_speed, capacity and max_capacity are those in use.
/// @threads shared   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_contact(
    const mspring_network *network, mspring_contact_def *def);

/// Set which particles may touch each other.
/// Two particles may if each one's group has a bit of the other's mask. A spring may touch what both its ends may.
/// All have group 1 and mask 0xffffffff at first.
/// @param first, count  particles first ... first + count - 1, of which those that were removed are left out
/// @param groups, masks  bits, for all of them
/// @threads exclusive   @allocates never   @errors ID, ARGUMENT (also without contact), BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_contact_groups(
    mspring_network *network, mspring_id first, uint32_t count, uint32_t groups, uint32_t masks);

/// Set friction and restitution of particles, instead of the contact's.
/// Where two touch, the friction is the square root of the product of both, and the restitution is the larger one. A
/// spring has the mean of its two ends. Against a collider the collider's values stand for -1. The floor uses its own
/// values only. All bodies wake. Snapshots leave this as it is, and clones have it.
/// @param first, count  particles first ... first + count - 1
/// @param friction      0 to 1e6; -1: the contact's, as at first
/// @param restitution   0 to 1; -1: likewise
/// @threads exclusive   @allocates at the first call; 8 bytes for a particle   @since 0.2
/// @errors ID, ARGUMENT (also without contact), MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_contact_surface(
    mspring_network *network, mspring_id first, uint32_t count, float friction, float restitution);

/// Report of contact in the last step. Set struct_size first.
typedef struct mspring_contact_info {
    uint32_t struct_size;
    uint32_t edges;    ///< of the outline: springs with a free side, and particles without springs
    uint32_t points;   ///< of the outline
    uint32_t pairs;    ///< pairs of a point and an edge that are looked at
    uint32_t touching; ///< pairs that pushed each other in a substep of the step, at most; 0: nothing touched
    uint32_t reserved; ///< 0
    double deepest;    ///< largest overlap in the step, m; 0 if there was none
} mspring_contact_info;

/// Read the report of contact. Without contact, and before the first step with it, all numbers are 0.
/// @threads shared   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_contact_info(
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
/// Set struct_size first.
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

/// Reserve room for contact events, which are recorded from then on.
/// A contact goes on while its particle slides from spring to spring of the same body. It ends after a step without an
/// impulse, if they are further apart than 1.05 of the thickness. Bodies that sleep stay in contact. The floor has no
/// contact events.
///
/// Snapshots hold none. After a load all that is nearer than 1.05 of the thickness counts as begun, and events that
/// were not read are dropped. Clones have contacts and events. Removing contact ends the recording.
/// @param capacity  events that may wait to be read, and contacts that are followed at a time, at most 0x1000000; 0:
///                  record none. Events that were not read yet are dropped.
/// @threads exclusive   @allocates yes; 200 bytes for each   @since 0.2
/// @errors ARGUMENT (also without contact), MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_reserve_contact_events(
    mspring_network *network, uint32_t capacity);

/// Read and remove the oldest contact events.
/// Those of a step come by rising particles, corners last: the order is the same on every machine. Contacts that go
/// on come before new ones where there is no room for all, and of new ones those of the first substep.
/// @param events    [capacity], struct_size set in each; may be NULL if capacity is 0
/// @param count     receives how many were read
/// @param lost      receives how many had no room since it was reserved, and in each step the most contacts at a
///                  time that were not followed; may be NULL
/// @threads exclusive   @allocates never   @since 0.2   @errors ARGUMENT (also without contact), STRUCT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_read_contact_events(
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
enum {
    MSPRING_COLLIDER_CLOSED = 1u << 0 ///< a side joins the last point of a chain to the first
};

/// A collider: a shape that the host owns and moves, and that bodies collide with. Fill with
/// mspring_collider_def_init() first. Half-planes and fields of heights are mspring_floor_def's.
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
    uint32_t groups, masks; ///< bits, as of mspring_network_set_contact_groups(); default 1 and 0xffffffff
} mspring_collider_def;

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_API mspring_result MSPRING_CALL mspring_collider_def_init(mspring_collider_def *def, size_t size);

/// Add a collider.
/// Bodies keep the contact's thickness from it. No outline passes it, from either side: boxes and closed chains are
/// walls around a space, and what lies inside stays inside. Inner particles keep out, too; those of very soft bodies may
/// still pass other bodies. Sides may cross. Colliders do not touch each other. Their mass is infinite. The contact's
/// sweeps and push_speed are theirs, too. The guide examples/guides/contact.md has the guarantees.
///
/// Colliders need contact. If only colliders are to touch particles, set groups and masks by which particles do not
/// touch each other.
///
/// Snapshots leave colliders out, as they leave the floor. Before you load one, add the same colliders and place them.
/// Clones have them. All bodies wake.
/// @param def       copied, with its points
/// @param collider  receives its id; may be NULL
/// @threads exclusive   @allocates yes; 1 to 3 kB for a point   @since 0.2   @errors ARGUMENT (also without
///          contact), STRUCT, MEMORY, BUSY, LIMIT for more than 0x1000000 points in all
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_collider(
    mspring_network *network, const mspring_collider_def *def, mspring_id *collider);

/// Remove a collider. All bodies wake.
/// @threads exclusive   @allocates never   @since 0.2   @errors ID, ARGUMENT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_remove_collider(
    mspring_network *network, mspring_id collider);

/// Set where a collider is to be at the end of the next step.
/// In that step it moves and turns at an even speed, and pushes bodies in its way. From then on it stands still. If the
/// step fails, the collider has not moved, and the next step moves it. A moving collider wakes the bodies it comes to,
/// and none falls asleep on it.
/// @param x, y, angle  as in mspring_collider_def. An angle of more than half a turn away makes it spin: it goes the
///                     whole way.
/// @threads exclusive   @allocates never   @since 0.2   @errors ID, ARGUMENT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_move_collider(
    mspring_network *network, mspring_id collider, double x, double y, double angle);

/// Put a collider somewhere else at once.
/// It touches nothing on its way. A body that it overlaps there is pushed apart from it. A body that it lies across
/// stays so. A move that was set is dropped. All bodies wake.
/// @param x, y, angle  as in mspring_collider_def
/// @threads exclusive   @allocates never   @since 0.2   @errors ID, ARGUMENT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_place_collider(
    mspring_network *network, mspring_id collider, double x, double y, double angle);

/// Read a collider. Set struct_size first.
/// Position and angle are those of now. points leads to the network's copy, valid until a collider is added or removed
/// or contact is set.
/// @threads shared   @allocates never   @since 0.2   @errors ID, ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_collider(
    const mspring_network *network, mspring_id collider, mspring_collider_def *def);

/// Read the impulses that bodies gave to a collider in the last step.
/// To move the collider as a rigid body, add the impulse to its momentum, and the angular impulse to its angular
/// momentum around its position. Both totals are then conserved. Bodies that sleep give nothing. With the explicit
/// solver impulses leave out what pushed an overlap apart; with the others they have it.
/// @param x, y     impulse, N s
/// @param angular  angular impulse around the position at the end of the step, N m s, counterclockwise
/// @threads shared   @allocates never   @since 0.2   @errors ID, ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_collider_impulse(
    const mspring_network *network, mspring_id collider, double *x, double *y, double *angular);

/* --------------------------------------------------------------------------------------------------------- grips */

/// Grips that a network can have at a time.
#define MSPRING_MAX_GRIPS 16u

/// A soft hold of a particle, as of a mouse or a finger. Fill with mspring_grip_def_init() first.
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

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_API mspring_result MSPRING_CALL mspring_grip_def_init(mspring_grip_def *def, size_t size);

/// Add a grip: hold a particle.
/// The target is at rest at first. The particle's component wakes. If the particle is removed, the grip is, too.
///
/// A pinned particle does not feel a grip. Snapshots and clones have the grips, with their ids.
/// mspring_network_settle() leaves them out. While a grip acts, the explicit solver takes substeps one by one, as with
/// hooks.
///
/// The target may be far away. Then a stiff grip without max_force throws the particle, as a stiff spring would. The
/// guide examples/guides/grips.md has the details.
/// @param def   copied
/// @param grip  receives its id; may be NULL
/// @threads exclusive   @allocates at the first call; 2 kB   @errors ARGUMENT (the message names the field), ID, STRUCT,
///          BUSY, MEMORY, LIMIT for more than MSPRING_MAX_GRIPS
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_grip(
    mspring_network *network, const mspring_grip_def *def, mspring_id *grip);

/// Remove a grip: let go. The particle's component wakes.
/// @threads exclusive   @allocates never   @errors ID, ARGUMENT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_remove_grip(
    mspring_network *network, mspring_id grip);

/// Change what a grip does.
/// If it holds the same particle as before, its target moves as by mspring_network_move_grip(). Otherwise it begins
/// anew.
/// @param def  copied
/// @threads exclusive   @allocates never   @errors ARGUMENT (the message names the field), ID, STRUCT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_grip(
    mspring_network *network, mspring_id grip, const mspring_grip_def *def);

/// Move the target of a grip.
/// In the next step the target goes there in a straight line. It rests from then on.
/// @param x, y  world position, m, at most MSPRING_MAX_COORDINATE in size
/// @threads exclusive   @allocates never   @errors ID, ARGUMENT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_move_grip(
    mspring_network *network, mspring_id grip, double x, double y);

/// Read a grip. Set struct_size first. The target is the one given last.
/// @threads shared   @allocates never   @errors ID, ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_grip(
    const mspring_network *network, mspring_id grip, mspring_grip_def *def);

/// Read the impulse (N s) that a grip gave its particle in the last step.
/// It is the sum of force times substep, and at most max_force times dt. While the particle sleeps, it is that of the
/// last step before.
/// @param x, y  receive the impulse
/// @threads shared   @allocates never   @errors ID, ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_grip_impulse(
    const mspring_network *network, mspring_id grip, double *x, double *y);

#ifdef __cplusplus
}
#endif

#endif

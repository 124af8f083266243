/// @file massspring_laws.h
/// Material laws beyond the linear spring: springs that yield, so that what bends stays bent; ropes that only pull;
/// strain limits; areas that keep jelly from turning inside out, and balloons inflated; angle springs for beams and
/// spines.
///
///     plasticity  network_get_plasticity
///     limits      builder_add_strain_limits
///     areas       network_add_area, _add_cell_areas, _remove_area, _set_area, _get_area, _get_area_info,
///                 _get_area_particles, _get_areas; area_def_init
///     angles      network_add_angles, _remove_angle, _set_angle, _set_rest_angles, _get_angle, _get_angle_info,
///                 _get_angles; angle_def_init
///
/// These calls are not frozen yet: a later minor version may change them. massspring.h explains the notation.
///
/// **Springs that yield.** Give a spring, or a material, a yield_strain. A spring that is strained by more gets another
/// rest length, and keeps it. With r its rest length, r0 that before it ever yielded, L its length:
///
///     plastic strain  p = r / r0 - 1
///     it yields while |(L - r) / r0 - hardening * p| > yield_strain, and |p| is below plastic_limit
///
/// The properties, for mspring_network_set() and _get():
///
///     MSPRING_YIELD_STRAIN    > 0; default MSPRING_NEVER
///     MSPRING_HARDENING       0 to 10; default MSPRING_HARDENING_DEFAULT. Stiffness past the yield strain is
///                             hardening / (1 + hardening) of that before it. It is kinematic (Prager): what was
///                             stretched yields sooner when it is pressed.
///     MSPRING_PLASTIC_LIMIT   0 to 0.9; default MSPRING_PLASTIC_LIMIT_DEFAULT. Beyond it a spring is elastic again.
///     MSPRING_PLASTIC_STRAIN  p, -0.9 to 0.9. Set 0 to straighten a spring, or another value to dent it. What springs
///                             back yields again, unless it may not yield until it rests. Writing it ends a ramp.
///                             Frames (MSPRING_SNAPSHOT_FRAME) hold it: it is no edit to them.
///
/// To set any of them allocates, the first time. A spring that was broken and is restored keeps its plastic strain.
/// MSPRING_REST_LENGTH is r0, MSPRING_ACTIVE_REST_LENGTH is r. If you write r0, or a signal does (massspring_batch.h),
/// p stays: rest lengths may be sent in each frame, and dents remain. A spring breaks by its total
/// strain, (L - r0) / r0, but is stressed and relaxes by the strain in force. A weld never yields, nor does a spring on
/// a ramp.
///
/// Springs yield in each substep of any solver. Where the explicit solver is used, dents hardly depend on the number of
/// substeps, if these are well below the stability limit. Long implicit and direct substeps would damp a blow before it
/// can dent. So while springs that are near yield, or would be by the end of a substep, are stretched fast, it is cut
/// into up to 16 pieces. Each costs as much as a substep; hooks and ramps see none of them. substeps of
/// mspring_step_info counts them. Slow loads are not cut. If a step is longer than a blow, the dent is still too small.
/// mspring_network_settle() gives MSPRING_ERROR_EQUILIBRIUM where a spring would yield on the way to rest.
/// mspring_network_tune() compares as if they did not, unless a scene has MSPRING_TUNE_SCENE_BREAKING. The guide
/// examples/guides/materials.md has examples.
///
/// **Springs that only pull, or only push.** Give a definition the flag MSPRING_SPRING_PULL_ONLY or
/// MSPRING_SPRING_PUSH_ONLY: a slack cable does not push, a prop that stands on the ground does not hold it. With L the
/// length, r the rest length:
///
///     it pulls    max(0, k (L - r) + c dL/dt) where L > r, else 0
///     it pushes   max(0, k (r - L) - c dL/dt) where L < r, else 0
///
/// Slack springs have no elastic energy, no force, and neither break nor yield; their strain is what it is. They stay
/// live: components and sleep take them as all others. mspring_network_stable_dt() counts their stiffness fourfold:
/// where they begin to act, substeps of less than six a period gain energy. mspring_network_settle() knows them.
/// mspring_network_tune() compares trajectories as if they did both. mspring_network_get_spring_flags() reports the
/// flags. They are given at creation: mspring_network_add_springs() rejects them.
///
/// Explicit substeps have the forces of their start, implicit and direct ones those of their end: such a step is taken
/// twice where a slack spring tightens in it. While one is awake, the explicit solver takes substeps one by one, as
/// with a hook, and looks at all of them before each.
///
/// Such a spring may lie beside another: between particles that a spring joins already. Where two springs join the same
/// particles, one at least has to be such.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_MASSSPRING_LAWS_H
#define MASSSPRING_MASSSPRING_LAWS_H

#include "massspring.h"

#ifdef __cplusplus
extern "C" {
#endif

/// More flags of mspring_spring_def, and of all that has spring_flags. A spring has at most one of them.
enum {
    MSPRING_SPRING_PULL_ONLY = 1u << 2, ///< no force where it is shorter than its rest length: rope, cable, string
    MSPRING_SPRING_PUSH_ONLY = 1u << 3  ///< no force where it is longer: prop, stop
};

/// Hardening and plastic limit of springs for which none was given.
#define MSPRING_HARDENING_DEFAULT 0.1f
#define MSPRING_PLASTIC_LIMIT_DEFAULT 0.5f

/// Report of what has yielded so far. Set struct_size first.
typedef struct mspring_plasticity {
    uint32_t struct_size;
    uint32_t bent_springs; ///< springs whose plastic strain is not 0 now
    uint64_t yield_count;  ///< springs that yielded in a step, summed over all steps
    double dissipated;     ///< energy that yielding has turned into heat, J; no step lowers it. What a substep
                           ///< stretches beyond the yield strain takes no work, and makes none
} mspring_plasticity;

/// Read the report of what has yielded. Takes a pass over all springs.
/// Snapshots and clones have it.
/// @threads shared   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_plasticity(
    const mspring_network *network, mspring_plasticity *report);

/* -------------------------------------------------------------------------------------------------------- limits */

/// Have springs stiffen beyond a strain: cloth, rubber, ligaments.
/// Beside each of them lies another spring then, that only pulls or only pushes. With k the stiffness, r the rest
/// length, q the strain, s the stiffening:
///
///     q > 0    k (L - r) + s k (L - (1 + q) r)    where L > (1 + q) r
///     q < 0    the same                           where L < (1 + q) r
///
/// Call it twice to have both. The limit is no wall: for a limit of s = 9, ten times the force brings about twice the
/// strain of q. mspring_network_stable_dt() counts its stiffness fourfold, whether it acts or not. So explicit
/// substeps are shorter by a factor of sqrt(1 + 4 s), or sqrt(1 + 8 s) with both. The implicit and the direct solver
/// have it in their linear system.
///
/// Limits are springs with ids of their own, without damping, and relative if those beside them are. They break as soon
/// as those do. They never yield. What you change, break, restore or remove later, change on both.
///
/// @param first, count  the springs that get one
/// @param strain        q, above -1, not 0
/// @param stiffening    s, above 0, at most 30
/// @param first_limit   receives the id of the first limit; the others follow; may be NULL
/// @threads exclusive   @allocates yes   @since 0.2
/// @errors ID if there is no such spring; ARGUMENT also for a spring that breaks before its limit, or has rest length 0
///         (the message names it); LIMIT, MEMORY. On error none is added.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_strain_limits(mspring_builder *builder,
    mspring_id first, uint32_t count, float strain, float stiffening, mspring_id *first_limit);

/* --------------------------------------------------------------------------------------------------------- areas */

/// Most particles of an area.
#define MSPRING_MAX_AREA_PARTICLES 4096u

/// Laws of areas. A is the area now, A0 the rest area; p pushes outwards, in N/m.
typedef enum mspring_area_kind {
    MSPRING_AREA_ELASTIC = 0,           ///< p = pressure + stiffness * (fill - A / A0)
    MSPRING_AREA_GAS = 1,               ///< p = pressure * fill * A0 / A: p * A stays, as in a gas of one temperature
    MSPRING_AREA_INT = MSPRING_ENUM_INT ///< no value
} mspring_area_kind;

/// An area: a closed polygon of particles with a pressure inside. Fill with mspring_area_def_init() first.
typedef struct mspring_area_def {
    uint32_t struct_size;
    mspring_area_kind kind; ///< default MSPRING_AREA_ELASTIC
    float stiffness;        ///< N/m, 0 to 1e30; 0 for a gas; default 0. Of lattice cells k / 2 to k, with springs of k.
    float pressure;         ///< N/m, at most 1e30 in size; of a gas >= 0; default 0
    float fill;             ///< part of the rest area that it is filled to, 0.01 to 100; default 1
    uint32_t reserved;      ///< 0
    double rest_area;       ///< A0, m^2, 1e-24 to 1e24, at least 1e-6 of the square of the polygon's perimeter at this
                            ///< call; default 0: the area that the polygon has at this call
} mspring_area_def;

/// An area now. Set struct_size first.
typedef struct mspring_area_info {
    uint32_t struct_size;
    uint32_t particle_count;
    uint32_t is_open; ///< 1: a spring of its outline is broken or removed, so it has no pressure
    uint32_t reserved;
    double area;     ///< m^2; below 0 if the polygon is inside out; of one that crosses itself, the sum of its parts
    double pressure; ///< p, N/m
    double energy;   ///< J, part of the elastic energy of mspring_network_energy(); 0 at fill * rest_area
} mspring_area_info;

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_API mspring_result MSPRING_CALL mspring_area_def_init(mspring_area_def *def, size_t size);

/// Add an area: a balloon, a tyre, a muscle.
/// The particles are the corners of the polygon, in either order around it. No particle may be there twice. At this
/// call the polygon must have an area, whether a rest area is given or not: at least 1e-6 of the square of its
/// perimeter. Corners on a line have less. That side is its positive one: turned inside out, the area is negative, and
/// the pressure turns it back. A gas has at most 20 times its pressure.
///
/// The outline consists of the springs that join one corner to the next at this call. If one of them is broken or
/// removed, the area is open: it exerts no force and has no energy until all are whole. If a corner is removed, the
/// area is, too.
///
/// Snapshots and clones have the areas, with their ids. mspring_builder_add_network() takes them along. A frame
/// (MSPRING_SNAPSHOT_FRAME) fits a network with the same areas.
///
/// An elastic area around a lattice cell is part of the explicit solver's sweeps. With others the explicit solver takes
/// substeps one by one, as with a hook. mspring_network_stable_dt() counts areas; its bound for any shape counts those
/// in the shape that they were added in.
///
/// The implicit and the direct solver have an area in their linear system if a spring was on each side of its outline
/// when it was added. Forces of others they take from the start of a substep. If one is too long for these, they reject
/// the step as unstable. MSPRING_GUARD_CLAMP, the default, does not: it repeats each such step with clamped strain
/// rates (MSPRING_STEP_CLAMPED). mspring_network_settle() rejects areas with a side without a spring. Its is_stable
/// does not see where pressure alone makes a shape unstable. mspring_network_tune() counts areas; it gives no rest
/// where settling rejects them.
///
/// @param count  3 to MSPRING_MAX_AREA_PARTICLES
/// @param area   receives its id, which is never given again; may be NULL
/// @threads exclusive access to network   @allocates yes
/// @errors ARGUMENT, STRUCT, ID if there is no such particle, LIMIT, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_area(mspring_network *network,
    const mspring_area_def *def, const mspring_id *particles, uint32_t count, mspring_id *area);

/// Add an area to each cell.
/// Where the layout has lattice rows, a cell is four particles with four whole springs around it. Elsewhere, as in
/// small lattices, it is four particles that whole springs join each to each, two of which cross. The rest area in def
/// must be 0. Each cell must have an area, as above. Ids are consecutive: by rising id of the corner that begins a cell
/// in the layout's rows, elsewhere of the lowest corner. mspring_network_get_area_particles() reads which corners an
/// area has. Without cells nothing is added. A second call adds all of them again. Where cells lie above each other, as
/// in a clique, there may be at most 16384, or as many as springs.
/// @param first_area  receives the first id; may be NULL
/// @param count       receives the number of areas added; may be NULL
/// @threads exclusive access to network   @allocates yes   @errors ARGUMENT, STRUCT, LIMIT, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_cell_areas(
    mspring_network *network, const mspring_area_def *def, mspring_id *first_area, uint32_t *count);

/// Remove an area.
/// @threads exclusive access to network   @allocates never   @errors ARGUMENT, ID, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_remove_area(
    mspring_network *network, mspring_id area);

/// Change an area: inflate it, or let it down.
/// If rest_area is 0, the polygon must have an area on its positive side: at least 1e-6 of its squared perimeter.
/// @threads exclusive access to network   @allocates never   @errors ARGUMENT, STRUCT, ID, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_area(
    mspring_network *network, mspring_id area, const mspring_area_def *def);

/// Read what an area is like. Set struct_size first.
/// @threads shared   @allocates never   @errors ARGUMENT, STRUCT, ID
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_area(
    const mspring_network *network, mspring_id area, mspring_area_def *def);

/// Measure an area. Set struct_size first.
/// @threads shared   @allocates never   @errors ARGUMENT, STRUCT, ID
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_area_info(
    const mspring_network *network, mspring_id area, mspring_area_info *info);

/// Read the corners of an area, in the order in which it is positive.
/// @param particles  [capacity] receives as many as fit; may be NULL if capacity is 0
/// @param count      receives how many corners it has
/// @threads shared   @allocates never   @since 0.2   @errors ARGUMENT, ID
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_area_particles(
    const mspring_network *network, mspring_id area, mspring_id *particles, uint32_t capacity, uint32_t *count);

/// Measure all areas, in the order of their ids.
/// @param ids        [capacity] receives the ids of as many as fit; may be NULL
/// @param areas      [capacity] receives A of each, m^2; may be NULL
/// @param pressures  [capacity] receives p of each, N/m, 0 of those that are open; may be NULL
/// @param count      receives how many areas there are
/// @threads shared   @allocates never   @since 0.2   @errors ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_areas(const mspring_network *network,
    mspring_id *ids, double *areas, double *pressures, uint32_t capacity, uint32_t *count);

/* -------------------------------------------------------------------------------------------------------- angles */

/// Flags of mspring_angle_def.
enum {
    MSPRING_ANGLE_REST_GIVEN = 1u << 0 ///< rest_angle counts; without: the angle that there is at this call
};

/// An angle spring between two arms. Fill with mspring_angle_def_init() first.
typedef struct mspring_angle_def {
    uint32_t struct_size;
    float stiffness;   ///< k, N m/rad, 0 to 1e30; default 0. Of a beam EI / d with links of d, twice that where clamped
    float damping;     ///< N m s/rad, 0 to 1e30; default 0
    uint32_t flags;    ///< MSPRING_ANGLE_REST_GIVEN
    double rest_angle; ///< rad, at most 1e6 in size; default 0: straight
} mspring_angle_def;

/// An angle spring now. Set struct_size first.
typedef struct mspring_angle_info {
    uint32_t struct_size;
    uint32_t is_open;        ///< 1: a spring along an arm is broken or removed, so it has no torque
    mspring_id a, b, c;      ///< its particles
    uint32_t reserved;
    double angle;  ///< rad, -pi to pi
    double torque; ///< N m, without that of damping; above 0 it turns the second arm to the left
    double energy; ///< J, part of the elastic energy of mspring_network_energy()
} mspring_angle_info;

/// Fill a definition with its defaults, as mspring_network_def_init().
/// @threads any   @allocates never   @errors ARGUMENT, STRUCT
MSPRING_API mspring_result MSPRING_CALL mspring_angle_def_init(mspring_angle_def *def, size_t size);

/// Add angle springs: the bending stiffness of a beam, a spine, a hinge.
/// Each is between three particles a, b, c. Its angle is by how much the way from a over b to c turns to the left at
/// b: 0 is straight, pi / 2 a turn to the left, -pi / 2 one to the right. With d the angle less the rest angle:
///
///     energy  k (1 - cos d)        torque  -k sin d - damping * rate of the angle
///
/// For small d that is k d^2 / 2. The torque is largest at a quarter turn, and 0 at half a turn. It acts as forces on
/// a, b and c, which keep momentum and angular momentum. If an arm has length 0, there is none.
///
/// The forces are the torque divided by the length of an arm: they grow without bound as it shrinks. Then any solver
/// may gain energy, and guards may not see it. Springs that resist pressing keep arms long. If they only pull, add
/// another beside each that only pushes, of the same stiffness and half the rest length.
///
/// If a spring joins a and b, or b and c, at this call, and is broken or removed later, the angle is open: it exerts
/// no force until both are whole. If one of the particles is removed, the angle is, too.
///
/// Angles and areas are numbered together. Snapshots and clones have the angles, with their ids. A frame
/// (MSPRING_SNAPSHOT_FRAME) fits a network with the same angles, and holds their rest angles.
/// mspring_builder_add_network() takes them along.
///
/// While there is one, the explicit solver takes substeps one by one, as with a hook. mspring_network_stable_dt()
/// counts angles: with particles of m and links of d, a straight beam is stable up to d / 2 sqrt(m / k). The implicit
/// and the direct solver have angles in their linear system, if springs join a and b, and b and c: then any substep is
/// stable. They take the forces of other angles from the start of a substep. If one is too long for these, they reject
/// the step as unstable. MSPRING_GUARD_CLAMP, the default, does not: it repeats each such step with clamped strain
/// rates (MSPRING_STEP_CLAMPED). The direct solver takes fewest iterations if the angles of a beam are added in their
/// order along it. mspring_network_settle() has all angles, and mspring_network_tune() counts them.
///
/// @param particles    [3 * count]: a, b, c of each; no two that follow each other are in one place
/// @param first_angle  receives the first id; the others follow; may be NULL
/// @threads exclusive access to network   @allocates yes   @since 0.2
/// @errors ARGUMENT, STRUCT, ID if there is no such particle, LIMIT, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_angles(mspring_network *network,
    const mspring_angle_def *def, const mspring_id *particles, uint32_t count, mspring_id *first_angle);

/// Remove an angle spring.
/// @threads exclusive access to network   @allocates never   @since 0.2   @errors ARGUMENT, ID, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_remove_angle(
    mspring_network *network, mspring_id angle);

/// Change an angle spring.
/// @threads exclusive access to network   @allocates never   @since 0.2   @errors ARGUMENT, STRUCT, ID, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_angle(
    mspring_network *network, mspring_id angle, const mspring_angle_def *def);

/// Set the rest angles of the angles first ... first + count - 1: muscles, servos, flippers.
/// They hold from the next step on. This is no edit: frames (MSPRING_SNAPSHOT_FRAME) hold it.
/// @param rest_angles  that of angle first + i in rest_angles[i * stride], rad, at most 1e6 in size
/// @param stride       elements from one to the next; 0: all have rest_angles[0]
/// @threads exclusive access to network   @allocates never   @since 0.2
/// @errors ID if one is no angle (the message names it), ARGUMENT, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_rest_angles(
    mspring_network *network, mspring_id first, uint32_t count, const double *rest_angles, uint32_t stride);

/// Read what an angle spring is like. Set struct_size first. Its rest angle is given.
/// @threads shared   @allocates never   @since 0.2   @errors ARGUMENT, STRUCT, ID
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_angle(
    const mspring_network *network, mspring_id angle, mspring_angle_def *def);

/// Measure an angle spring. Set struct_size first.
/// @threads shared   @allocates never   @since 0.2   @errors ARGUMENT, STRUCT, ID
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_angle_info(
    const mspring_network *network, mspring_id angle, mspring_angle_info *info);

/// Measure all angle springs, in the order of their ids.
/// @param ids      [capacity] receives the ids of as many as fit; may be NULL
/// @param angles   [capacity] receives the angle of each, rad, -pi to pi; may be NULL
/// @param torques  [capacity] receives the torque of each, N m, 0 of those that are open; may be NULL
/// @param count    receives how many there are
/// @threads shared   @allocates never   @since 0.2   @errors ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_angles(const mspring_network *network,
    mspring_id *ids, double *angles, double *torques, uint32_t capacity, uint32_t *count);

#ifdef __cplusplus
}
#endif

#endif

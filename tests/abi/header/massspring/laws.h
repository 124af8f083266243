/// @file laws.h
/// Material laws beyond the linear spring: springs that yield, springs that only pull or push, and elements: areas that
/// keep jelly from turning inside out, and balloons inflated; angle springs for beams and spines. Include massspring.h.
///
///     elements    network_add_area, _add_cell_areas, _add_angles, _remove_elements, _get_element_particles
///
/// Elements are read and changed by properties: MSPRING_PRESSURE, MSPRING_REST_ANGLE, MSPRING_AREA and so on. Areas and
/// angles are numbered together. Snapshots, clones and archives have them, with their ids. Frames
/// (MSPRING_SNAPSHOT_FRAME) fit a network with the same elements, and hold their rest angles.
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
/// MSPRING_REST_LENGTH is r0, MSPRING_ACTIVE_REST_LENGTH is r. If you write r0, or a signal does (batch.h),
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
/// strength.md has examples.
///
/// **Springs that only pull, or only push.** Give a definition the flag MSPRING_SPRING_PULL_ONLY or
/// MSPRING_SPRING_PUSH_ONLY: a slack cable does not push, a prop that stands on the ground does not hold it. With L the
/// length, r the rest length:
///
///     it pulls    max(0, k (L - r) + c dL/dt) where L > r, else 0
///     it pushes   max(0, k (r - L) - c dL/dt) where L < r, else 0
///
/// Slack springs have no elastic energy, no force, and neither break nor yield; their strain is what it is. They stay
/// live: components and sleep take them as all others. mspring_network_get_stable_dt() counts their stiffness fourfold:
/// where they begin to act, substeps of less than six a period gain energy. mspring_network_settle() knows them.
/// mspring_network_tune() compares trajectories as if they did both. MSPRING_SPRING_FLAGS reports the
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
#ifndef MASSSPRING_LAWS_H
#define MASSSPRING_LAWS_H

#include "core.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Flags of elements.
typedef enum mspring_element_flags {
    MSPRING_ELEMENT_AREA = 1 << 0,    ///< it is an area
    MSPRING_ELEMENT_ANGLE = 1 << 1,   ///< it is an angle
    MSPRING_ELEMENT_OPEN = 1 << 2,    ///< a spring of its outline or arms is broken or removed: no force, no energy
    MSPRING_ELEMENT_REMOVED = 1 << 10 ///< removed: in ranges only
} mspring_element_flags;

/* --------------------------------------------------------------------------------------------------------- areas */

/// Most particles of an area.
#define MSPRING_MAX_AREA_PARTICLES 4096u

/// Laws of areas. A is the area now, A0 the rest area; p pushes outwards, in N/m.
typedef enum mspring_area_kind {
    MSPRING_AREA_ELASTIC = 0, ///< p = pressure + stiffness * (fill - A / A0)
    MSPRING_AREA_GAS = 1,     ///< p = pressure * fill * A0 / A, at most 20 times pressure: as of one temperature
    MSPRING_AREA_INT = MSPRING_ENUM_INT ///< no value
} mspring_area_kind;

/// An area: a closed polygon of particles with a pressure inside.
typedef struct mspring_area_def {
    uint32_t struct_size;
    mspring_area_kind kind; ///< default MSPRING_AREA_ELASTIC
    float stiffness;        ///< N/m, 0 to 1e30; 0 for a gas; default 0. Of lattice cells k / 2 to k, with springs of k.
    float pressure;         ///< N/m, at most 1e30 in size; of a gas >= 0; default 0
    float fill;             ///< part of the rest area that it is filled to, 0.01 to 100; default 1
    float rest_area;        ///< A0, m^2, 1e-24 to 1e24, at least 1e-6 of the square of the polygon's perimeter at this
                            ///< call; default 0: the area that the polygon has at this call
} mspring_area_def;
MSPRING_DEFAULT(mspring_area_def, MSPRING_STRUCT_AREA_DEF);

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
/// substeps one by one, as with a hook. mspring_network_get_stable_dt() counts areas; its bound for any shape counts
/// those in the shape that they were added in.
///
/// The implicit and the direct solver have an area in their linear system if a spring was on each side of its outline
/// when it was added. Forces of others they take from the start of a substep. If one is too long for these, they reject
/// the step as unstable. MSPRING_GUARD_CLAMP, the default, does not: it repeats each such step with clamped strain
/// rates (MSPRING_STEP_CLAMPED). mspring_network_settle() rejects areas with a side without a spring. Its is_stable
/// does not see where pressure alone makes a shape unstable. mspring_network_tune() counts areas; it gives no rest
/// where settling rejects them.
///
/// @param count  3 to MSPRING_MAX_AREA_PARTICLES
/// @param element  receives its id, which is never given again; may be NULL
/// Threads: exclusive. Allocates: yes. Errors: ARGUMENT, STRUCT, ID if there is no such particle, LIMIT, MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_area(mspring_network *network,
    const mspring_area_def *def, const mspring_id *particles, uint32_t count, mspring_id *element);

/// Add an area to each cell.
/// Where the layout has lattice rows, a cell is four particles with four whole springs around it. Elsewhere, as in
/// small lattices, it is four particles that whole springs join each to each, two of which cross. The rest area in def
/// must be 0. Each cell must have an area, as above. Ids are consecutive: by rising id of the corner that begins a cell
/// in the layout's rows, elsewhere of the lowest corner. mspring_network_get_element_particles() reads which corners an
/// area has. Without cells nothing is added. A second call adds all of them again. Where cells lie above each other, as
/// in a clique, there may be at most 16384, or as many as springs.
/// @param first_element  receives the first id; may be NULL
/// @param count       receives the number of areas added; may be NULL
/// Threads: exclusive. Allocates: yes. Errors: ARGUMENT, STRUCT, LIMIT, MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_cell_areas(
    mspring_network *network, const mspring_area_def *def, mspring_id *first_element, uint32_t *count);

/* -------------------------------------------------------------------------------------------------------- angles */

/// rest_angle for "the angle that there is at this call".
#define MSPRING_REST_ANGLE_PRESENT 3.40282346638528859812e+38f

/// An angle spring between two arms.
typedef struct mspring_angle_def {
    uint32_t struct_size;
    float stiffness;  ///< k, N m/rad, 0 to 1e30; default 0. Of a beam EI / d with links of d, twice that where clamped
    float damping;    ///< N m s/rad, 0 to 1e30; default 0
    float rest_angle; ///< rad, at most 1e6 in size, 0: straight; default MSPRING_REST_ANGLE_PRESENT
} mspring_angle_def;
MSPRING_DEFAULT(mspring_angle_def, MSPRING_STRUCT_ANGLE_DEF);

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
/// While there is one, the explicit solver takes substeps one by one, as with a hook. mspring_network_get_stable_dt()
/// counts angles: with particles of m and links of d, a straight beam is stable up to d / 2 sqrt(m / k). The implicit
/// and the direct solver have angles in their linear system, if springs join a and b, and b and c: then any substep is
/// stable. They take the forces of other angles from the start of a substep. If one is too long for these, they reject
/// the step as unstable. MSPRING_GUARD_CLAMP, the default, does not: it repeats each such step with clamped strain
/// rates (MSPRING_STEP_CLAMPED). The direct solver takes fewest iterations if the angles of a beam are added in their
/// order along it. mspring_network_settle() has all angles, and mspring_network_tune() counts them.
///
/// @param particles  a, b, c of angle i at particles[i * stride]; no two that follow each other are in one place
/// @param stride     3 for a list of triples; 1 for the angles along a chain of count + 2 particles
/// @param first_element  receives the first id; the others follow; may be NULL
/// Threads: exclusive. Allocates: yes. Errors: ARGUMENT, STRUCT, ID if there is no such particle, LIMIT, MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_add_angles(mspring_network *network,
    const mspring_angle_def *def, const mspring_id *particles, uint32_t count, uint32_t stride,
    mspring_id *first_element);

/* ------------------------------------------------------------------------------------------------- all elements */

/// Remove elements, for good.
/// Threads: exclusive. Allocates: never. Errors: ARGUMENT, ID, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_remove_elements(
    mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count);

/// Read the particles of an element: of an area in the order in which it is positive, of an angle a, b, c.
/// @param particles  [capacity] receives as many as fit; may be NULL if capacity is 0
/// @param count      receives how many it has
/// Threads: shared. Allocates: never. Errors: ARGUMENT, ID.
MSPRING_API mspring_result MSPRING_CALL mspring_network_get_element_particles(const mspring_network *network,
    mspring_id element, mspring_id *particles, uint32_t capacity, uint32_t *count);

#ifdef __cplusplus
}
#endif

#endif

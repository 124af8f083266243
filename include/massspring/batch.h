/// @file batch.h
/// Batches: many bodies in one network, each of them judged, put back, driven and read singly. Include massspring.h.
///
///     groups      network_set_groups, _mark_groups, _reset_groups, _observe_groups
///     actuators   network_set_actuators
///
/// **Groups.** A group is a body or several, such as a robot; those of a batch may differ. It has particles of its own,
/// and no spring or element leads out of it. If a step would throw a group out of bounds, the group is held: it stays
/// where it was before that step, at rest, until you reset it. The other groups take the step, with the same bits as if
/// the held group were not there. Groups do not touch each other, so all of them may stand in the same place.
///
/// **What groups ask for.** The explicit solver with a set number of substeps, MSPRING_GUARD_BOUNDS and sleep_speed 0.
/// No particles and springs can be added while there are groups. Choose max_speed so low that no group that is well
/// reaches it. The limit of stability is not checked, as that would judge all groups together. The local origin
/// stays where it is.
///
/// **Limits of isolation.** Contact between bodies gives all bodies as many sweeps as the one that needs most. So with
/// contact, and where bodies touch, the bits of a group depend on the others. A step for which the contact's
/// max_capacity is too small fails for all. A hook sees all groups; if it refuses, all are rolled back.
///
/// **Velocities.** In explicit steps of a network with groups all velocities, given ones too, count as half a substep
/// old. So a group that is reset repeats, bit for bit, what it did at first, whatever the others do; and its motion is
/// off by as much as half a substep would make.
///
/// **Gradients.** massspring_gradient.h has derivatives of a loss. Without it: with 2 P copies whose P parameters are
/// changed by a little, one by one, up and down, a batch gives the gradient of any loss by central differences. The
/// guide batches.md has examples.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_BATCH_H
#define MASSSPRING_BATCH_H

#include "core.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Flags of groups.
typedef enum mspring_group_flags {
    MSPRING_GROUP_HELD = 1 << 0 ///< a step would have thrown it out of bounds
} mspring_group_flags;

/// Divide particles into groups. This replaces the groups that there are.
/// Group g has the particles firsts[g] ... firsts[g + 1] - 1. Particles in no group touch no group. If one of them
/// leaves the bounds, the step fails. The present state becomes the start of each group. Clones have the groups.
///
/// Snapshots hold which groups are held, but neither groups nor marks. Before you load one, set the same groups.
/// @param firsts  [count + 1], rising: no group is empty
/// @param count   0: no groups; then firsts may be NULL. No group is held any more.
/// Threads: exclusive. Allocates: yes; 44 bytes for a particle (8 more in precise networks), 17 for a spring. Errors:
/// ARGUMENT also for a spring or element that leads out of a group (the message names it), or if the network is not as
/// groups ask; ID, MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_groups(
    mspring_network *network, const mspring_id *firsts, uint32_t count);

/// Remember the present state of groups as their mark.
/// A mark has positions, velocities, rest lengths and which springs are broken. Until then a group's mark is its start.
/// @param count  MSPRING_ALL is allowed
/// Threads: exclusive. Allocates: the first time. Errors: ID (the message names the index), ARGUMENT, MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_mark_groups(
    mspring_network *network, const mspring_id *ids, mspring_id first, uint32_t count);

/// States to which a group is put back.
typedef enum mspring_reset {
    MSPRING_RESET_START = 0,             ///< the state at mspring_network_set_groups()
    MSPRING_RESET_MARK = 1,              ///< its mark
    MSPRING_RESET_INT = MSPRING_ENUM_INT ///< no value
} mspring_reset;

/// Put groups back to their start or their mark, and hold them no more.
/// Ramps end: each spring gets the rest length that it had there, with no ramp. If it was on a ramp there already, it
/// gets that of the ramp's end.
/// Springs that broke since are restored, which gives events. Masses, stiffness, damping, thresholds and forces for the
/// next step stay as they are. Signals that no step has used yet are dropped.
/// @param count  MSPRING_ALL is allowed
/// Threads: exclusive. Allocates: if a compacted network must be expanded (mspring_network_compact()). Errors: ID (the
/// message names the index), ARGUMENT, MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_reset_groups(
    mspring_network *network, mspring_reset to, const mspring_id *ids, mspring_id first, uint32_t count);

/// A column of an observation: a property of the index-th particle, spring, element or actuator of each group, in the
/// order of ids, or of the group itself (then index is 0). This struct never changes.
typedef struct mspring_observation {
    mspring_property property;
    uint32_t index;
} mspring_observation;

/// Observe groups: a row for each. Sums are in double precision, in the order of ids.
/// Different bodies may share columns: where a group has no such thing, or it was removed, the number is 0. Particles,
/// springs and actuators keep their index if others are removed. Elements do not: those behind move up by one.
/// @param columns  [column_count]
/// @param rows     receives column c of element i in rows[i * stride + c]; world coordinates are not rounded to float
/// @param stride   numbers from one row to the next, at least column_count
/// Threads: shared. Allocates: never. Errors: ID; ARGUMENT also for an unknown property (the message names the column).
MSPRING_API mspring_result MSPRING_CALL mspring_network_observe_groups(const mspring_network *network,
    const mspring_id *ids, mspring_id first, uint32_t count, const mspring_observation *columns, uint32_t column_count,
    double *rows, uint32_t stride);

/// Make springs actuators: their rest lengths follow signals. This replaces the actuators that there are.
/// MSPRING_SIGNAL of actuator i is that of springs[i]. Signal 1 is the MSPRING_REST_LENGTH of now. In the next step the
/// rest lengths become signal times that, and stay so. To set signals is no edit: frames hold them. An actuator that is
/// no more keeps the rest length that it has. If its spring is removed, an actuator stays and does nothing, until a
/// spring is added with that id (mspring_network_reuse_ids()). Clones have actuators, and snapshots hold their rest
/// lengths and signals. Before you load a snapshot, set the same actuators.
/// @param springs  [count], each once, no welds; rest lengths of 1e-12 to 4e10 m
/// @param count    0: no actuators; then springs may be NULL
/// @param changes  in how many even parts a step takes a rest length to its signal, 1 to 256; at most one in a substep.
///                 1: at once, as the step begins. More are smoother, and cost as hooks before so many substeps do.
/// Threads: exclusive. Allocates: yes; 16 bytes for each, 4 for a spring, and rest lengths. Errors: ID (the message
/// names the index), ARGUMENT, DUPLICATE, MEMORY, BUSY.
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_actuators(
    mspring_network *network, const mspring_id *springs, uint32_t count, uint32_t changes);

#ifdef __cplusplus
}
#endif

#endif

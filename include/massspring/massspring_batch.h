/// @file massspring_batch.h
/// Batches: many bodies in one network, each of them judged, put back, driven and read singly.
///
///     copies      builder_add_copies
///     groups      network_set_groups, _group_count, _get_group_flags, _mark_groups, _reset_groups, _observe_groups
///     actuators   network_set_actuators, _actuator_count, _set_signals
///
/// These calls are not frozen yet: a later minor version may change them. massspring.h explains the notation.
///
/// **Groups.** A group is a body or several, such as a robot. It has particles of its own, and no spring or area leads
/// out of it. If a step would throw a group out of bounds, the group is held: it stays where it was before that step,
/// at rest, until you reset it. The other groups take the step, with the same bits as if the held group were not there.
/// Groups do not touch each other, so all of them may stand in the same place.
///
/// **What groups ask for.** The explicit solver with a set number of substeps, MSPRING_GUARD_BOUNDS and sleep_speed 0.
/// Nothing can be added to the network while there are groups. Choose max_speed so low that no group that is well
/// reaches it. The border of stability is not looked at, as that would judge all groups together. The local origin
/// stays where it is.
///
/// **Limits of isolation.** Contact between bodies (massspring_contact.h) gives all bodies as many sweeps as the one
/// that needs most. So with contact, and where bodies touch, the bits of a group depend on the others. A step for which
/// the contact's capacity is too small fails for all. A hook sees all groups.
///
/// **Velocities.** In explicit steps of a network with groups all velocities, given ones too, count as half a substep
/// old. So a group that is reset repeats, bit for bit, what it did at first, whatever the others do; and its motion is
/// off by as much as half a substep would make.
///
/// The guide examples/guides/batches.md has an example.
///
/// SPDX-License-Identifier: MIT
#ifndef MASSSPRING_MASSSPRING_BATCH_H
#define MASSSPRING_MASSSPRING_BATCH_H

#include "massspring.h"

#ifdef __cplusplus
extern "C" {
#endif

/* -------------------------------------------------------------------------------------------------------- copies */

/// Add copies of all that another builder holds: all or, on error, none.
/// Areas and angles, which mspring_builder_add_network() has put there, are copied, too.
/// Copy i has the particles first_particle + i * p ..., with p the number of particles of from, and its springs
/// likewise.
/// @param from            another builder
/// @param count           copies, at least 1
/// @param x, y            [count] offset of copy i in x[i * stride], m; both NULL: none
/// @param stride          elements from one to the next
/// @param first_particle, first_spring  receive the first ids; may be NULL
/// @threads exclusive for builder, shared for from   @allocates yes   @since 0.2
/// @errors ARGUMENT also for a copy that is not within MSPRING_MAX_COORDINATE (the message names it), LIMIT, MEMORY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_builder_add_copies(mspring_builder *builder,
    const mspring_builder *from, uint32_t count, const double *x, const double *y, uint32_t stride,
    mspring_id *first_particle, mspring_id *first_spring);

/* -------------------------------------------------------------------------------------------------------- groups */

/// Divide particles into groups. This replaces the groups that there are.
/// Group g has the particles firsts[g] ... firsts[g + 1] - 1. Particles in no group touch no group. If one of them
/// leaves the bounds, the step fails. The present state becomes the start of each group. Clones have the groups.
///
/// Snapshots hold which groups are held, but neither groups nor marks. Before you load one, set the same groups.
/// @param firsts  [count + 1], rising: no group is empty
/// @param count   0: no groups; then firsts may be NULL. No group is held any more.
/// @threads exclusive   @allocates yes; 44 bytes for a particle (8 more in precise networks), 17 for a spring   @since 0.2
/// @errors ARGUMENT also for a spring or area that leads out of a group (the message names it), or if the network is
///         not as groups ask; ID, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_groups(
    mspring_network *network, const mspring_id *firsts, uint32_t count);

/// Return the number of groups. NULL gives 0.
/// @threads shared   @allocates never   @since 0.2
MSPRING_API uint32_t MSPRING_CALL mspring_network_group_count(const mspring_network *network);

/// Flags of groups.
enum {
    MSPRING_GROUP_HELD = 1u << 0 ///< a step would have thrown it out of bounds
};

/// Read the flags of the groups first ... first + count - 1.
/// @param flags   receives those of group first + i in flags[i * stride]
/// @param stride  elements from one to the next, at least 1
/// @threads shared   @allocates never   @since 0.2   @errors ID, ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_get_group_flags(
    const mspring_network *network, uint32_t first, uint32_t count, uint32_t *flags, uint32_t stride);

/// Remember the present state of groups as their mark.
/// A mark has positions, velocities, rest lengths and which springs are broken. Until then a group's mark is its start.
/// @param groups  [count]; NULL with count 0: all groups
/// @threads exclusive   @allocates the first time, as mspring_network_set_groups()   @since 0.2
/// @errors ID (the message names the index), ARGUMENT, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_mark_groups(
    mspring_network *network, const uint32_t *groups, uint32_t count);

/// What a group is put back to.
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
/// @param groups  [count]; NULL with count 0: all groups
/// @threads exclusive   @allocates if a compacted network must be expanded (mspring_network_compact())   @since 0.2
/// @errors ID (the message names the index), ARGUMENT, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_reset_groups(
    mspring_network *network, const uint32_t *groups, uint32_t count, mspring_reset to);

/// Columns of an observation.
enum {
    MSPRING_OBSERVE_X = 0, ///< centre of mass, m, world coordinates
    MSPRING_OBSERVE_Y = 1,
    MSPRING_OBSERVE_VX = 2, ///< its velocity, m/s
    MSPRING_OBSERVE_VY = 3,
    MSPRING_OBSERVE_MIN_X = 4, ///< smallest box around the particles, m, world coordinates
    MSPRING_OBSERVE_MIN_Y = 5,
    MSPRING_OBSERVE_MAX_X = 6,
    MSPRING_OBSERVE_MAX_Y = 7,
    MSPRING_OBSERVE_HELD = 8, ///< 1 if the group is held, else 0
    /// From here on four columns for each chosen particle: position relative to the centre of mass, x and y (m), and
    /// velocity, x and y (m/s).
    MSPRING_OBSERVE_PARTICLES = 9
};

/// Observe the groups first ... first + count - 1: a row for each.
/// Sums are in double precision, in the order of ids. Pinned particles count with their mass. A particle that was
/// removed reads as 0.
/// @param particles       [particle_count] chosen particles, counted from the first of each group; may be NULL if
///                        particle_count is 0
/// @param rows            receives column c of group first + i in rows[i * stride + c]
/// @param stride          elements from one row to the next, at least MSPRING_OBSERVE_PARTICLES + 4 * particle_count
/// @threads shared   @allocates never   @since 0.2
/// @errors ID also for a chosen particle that a group does not have, ARGUMENT
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_observe_groups(
    const mspring_network *network, uint32_t first, uint32_t count, const uint32_t *particles,
    uint32_t particle_count, double *rows, uint32_t stride);

/* ----------------------------------------------------------------------------------------------------- actuators */

/// Make springs actuators: their rest lengths follow signals. This replaces the actuators that there are.
/// Signal i is that of springs[i]. Signal 1 is the MSPRING_REST_LENGTH of now. An actuator that is no more
/// keeps the rest length that it has. Clones have actuators, and snapshots hold their rest lengths and signals. Before
/// you load a snapshot, set the same actuators.
/// @param springs  [count], each once, no welds; rest lengths of 1e-12 to 4e10 m
/// @param count    0: no actuators; then springs may be NULL
/// @param changes  in how many even parts a step takes a rest length to its signal, 1 to 256; at most one in a substep.
///                 1: at once, as the step begins. More are smoother, and cost as hooks before so many substeps do.
/// @threads exclusive   @allocates yes; 16 bytes for each, 4 for a spring, and rest lengths   @since 0.2
/// @errors ID (the message names the index), ARGUMENT, DUPLICATE, MEMORY, BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_actuators(
    mspring_network *network, const mspring_id *springs, uint32_t count, uint32_t changes);

/// Return the number of actuators. NULL gives 0.
/// @threads shared   @allocates never   @since 0.2
MSPRING_API uint32_t MSPRING_CALL mspring_network_actuator_count(const mspring_network *network);

/// Set the signals of the actuators first ... first + count - 1.
/// In the next step the rest lengths become signal times those at mspring_network_set_actuators(), and stay so. This is
/// no edit: frames (MSPRING_SNAPSHOT_FRAME) hold it.
/// @param signals  that of actuator first + i in signals[i * stride], 0.01 to 100
/// @param stride   elements from one to the next; 0: all have signals[0]
/// @threads exclusive   @allocates never   @since 0.2   @errors ID, ARGUMENT (the message names the actuator), BUSY
MSPRING_NODISCARD MSPRING_API mspring_result MSPRING_CALL mspring_network_set_signals(
    mspring_network *network, uint32_t first, uint32_t count, const float *signals, uint32_t stride);

#ifdef __cplusplus
}
#endif

#endif

/// @file network.h
/// The data of a network.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_NETWORK_H
#define MSPRINGI_NETWORK_H

#include <math.h>

#include "base/assert.h"
#include "base/structs.h"
#include "builder/builder_areas.h"
#include "features/breaking/strain_state.h"
#include "kernels/kernels.h"
#include "layout/topology.h"
#include "store/added_springs.h"
#include "store/components.h"
#include "store/constraint_list.h"
#include "store/edit_counters.h"
#include "store/groups.h"
#include "store/id_pool_state.h"
#include "store/sent_values.h"
#include "store/sleep_state.h"
#include "store/solver.h"
#include "store/state.h"
#include "store/steps.h"
#include "store/tested_springs.h"
#include "tasks/tasks.h"

/// Forces from outside, in N by slot. Fields that a network does not need are NULL.
typedef struct mspringi_forces {
    mspringi_field held;   ///< given by the host for the next step; its calls add up
    mspringi_field base;   ///< held, with the forces of hooks before the step: the same in all substeps
    mspringi_field driven; ///< base, with the forces of hooks before the substep
    mspringi_field inner;  ///< base or driven, with forces within bodies, as of areas
    mspringi_field first;  ///< given by the host for the first substep of the next step
    mspringi_field begun;  ///< those of the first substep: base or driven, with first
    mspringi_field known;  ///< from outside in the first substep of the present attempt; NULL: none, or no step
    bool held_any;         ///< held is not all zero
    bool first_any;        ///< first is not all zero
    uint32_t held_calls;   ///< if held_any: calls that added forces up to MSPRINGI_MODEST to it
} mspringi_forces;

/// Size of a force, N, and calls: so many forces of that size have a finite sum, which need not be checked.
#define MSPRINGI_MODEST 1e30f
#define MSPRINGI_MODEST_CALLS 1000000u

typedef enum mspringi_in_hook {
    MSPRINGI_IN_NO_HOOK,
    MSPRINGI_IN_HOOK, ///< in one that a single thread calls
    MSPRINGI_IN_HOOKS ///< in a concurrent one, perhaps on several threads
} mspringi_in_hook;

/// Stiffness and damping as fractions; stiffness < 0 for a spring that is not relative.
typedef struct mspringi_relative {
    float stiffness, damping;
} mspringi_relative;

/// Fractions of all springs; values is NULL if no spring is relative.
typedef struct mspringi_fractions {
    mspringi_relative *values;
    uint8_t *of_spring; ///< [springs] index in values; NULL: values is [springs]
} mspringi_fractions;

/// Forces of areas that the sweeps of lattices compute, see features/areas/areas.h.
typedef struct mspringi_cell_forces {
    float *values;  ///< [lattice blocks][2][lane] half the force per distance at area 0, N/m, and its slope
    uint32_t swept; ///< cells with such forces
} mspringi_cell_forces;

/// Rest lengths of the lattices' springs, in blocks of [direction][lane].
typedef struct mspringi_rest_lengths {
    float *lengths;     ///< [count] blocks: those that several lattice blocks share, then those of one each
    uint32_t *of_block; ///< [lattice blocks] index of its block of lengths
    uint32_t count, shared_count;
} mspringi_rest_lengths;

/// Halos: data at the borders between workers' shares (solvers/explicit/halo.h, partition.h). One worker has no
/// arrays.
typedef struct mspringi_halos {
    uint32_t workers;     ///< capacity; 0: none
    uint32_t count;       ///< halos: borders between lattice strips
    uint32_t substeps;    ///< of the deepest pass
    uint32_t row_spans;   ///< spans in a row, at most
    uint32_t strips;      ///< or tiers, whichever are more
    size_t segment;       ///< slots of the widest row, and a block that kernels read behind it
    float *values;        ///< [count][mspringi_state_arrays()][rows of a halo][segment]
    mspringi_span *spans; ///< [count][2][2][row_spans]
    uint32_t *borders;    ///< [MSPRINGI_PLANNED_PASSES][workers]
    uint64_t *weights;    ///< [strips + 1] of the strips below each
} mspringi_halos;

/// The network. Each array has a row in store/network.def. State of one feature alone is behind a pointer that
/// features.def declares.
struct mspring_network {
    mspringi_memory memory;       ///< of the network and all arrays, except those in tasks_memory
    mspringi_memory tasks_memory; ///< of data that a copy of the network makes anew: workers, the shared message
    void(MSPRING_CALL *release_tasks)(void *user); ///< of the host's tasks, called at the end; or NULL
    void *tasks_user;
    mspringi_message message;
    mspringi_shared_message *shared; ///< of calls that only read; in tasks_memory
    mspringi_topology topology;
    mspringi_topology whole; ///< the one the network was created with, while it is compact; else empty
    bool is_compact;
    uint64_t whole_fingerprint;   ///< topology_fingerprint of whole
    uint32_t whole_tile_size;     ///< of the implicit solver that whole had; 0 if there was none
    uint32_t whole_fallback_size; ///< the same of the fallback's
    mspring_job *job;             ///< another layout that is being made, or NULL
    bool is_seen_compact;         ///< a compaction at the next two counters of edits had nothing to do
    uint64_t seen_links, seen_growth;
    uint64_t topology_fingerprint;  ///< hash of which particles the springs join, and of where they lie
    uint64_t parameter_fingerprint; ///< hash of the springs' parameters, and of all edits of them
    const mspringi_kernels *kernels;
    mspringi_tasks *tasks; ///< NULL: the caller's thread steps alone

    // State.
    mspringi_state state, backup;
    uint32_t dithered;         ///< substeps of the present step with dither (base/dither.h): a multiple of 4, or 0
    uint32_t first_substep;    ///< number in the step of the first substep that is now taken
    float lag;                 ///< lag at that substep, s: steps.lag, or less if springs would be unstable with it
    float full_lag;            ///< lag for gravity, s: without that limit
    double step_time;          ///< length of the present step, s: dt, or near it: SUBSTEPS_EVEN, substep_length
    mspringi_pace next_pace;   ///< becomes steps.pace if the step succeeds
    bool backup_is_start;      ///< only the solver has written to the state since the backup was written
    bool is_to_repeat;         ///< an assumption failed: the substeps that are undone are taken again
    double origin_x, origin_y; ///< world = origin + local
    float recentre_distance;   ///< distance of the network from its origin from which on a move of the origin is
                               ///< tried, m

    // Parameters.
    float *inverse_mass;                ///< [slots] 1/kg; 0 if pinned or empty
    float *mass;                        ///< [particles] kg
    float *inverse_mass_scale;          ///< [particles]; NULL as long as each is 1, or 0 for a pinned particle
    bool is_scaled;                     ///< the host has set scales: it needs the array
    uint32_t parts;                     ///< values per spring in the records: 2, or 3 with damping
    bool is_precise;                    ///< low words count in the lengths of springs
    bool keeps_poses;                   ///< places at creation are kept
    mspringi_rest_lengths rest_lengths; ///< of lattice_springs, whose records have only stiffness and damping
    float *lattice_springs, *chain_springs;
    mspringi_shared_records shared_records; ///< lattice blocks with equal stiffness and damping
    float *irregular_springs;
    float *gathered; ///< [2][halves][nodes of the irregular part][4] motion before this and the next substep
                     ///< (store/precise.h)
    float *attached; ///< forces on the attached nodes, N, all x and then all y
    mspringi_fractions fractions;
    float relative_h;        ///< substep that relative springs were derived for, s; 0: not yet
    uint16_t *live;          ///< [spring slots / 16] a bit for each: 1 where a live spring lies
    mspringi_relative *kept; ///< [springs] N/m, N s/m of broken springs that are not relative; NULL before any
    uint8_t *is_reversed; ///< [(reserve.first_spring + 7) / 8] a bit for each spring that was given with the higher
                          ///< id first; NULL if none was
    float *metres;        ///< [4 * springs] limits as given in metres (store/metres.h); NULL if no spring has any
    int8_t *side;         ///< [reserve.first_spring] see mspringi_side_of(); NULL if all springs pull and push
    bool keeps_none;      ///< all springs are relative, so `kept` is never needed
    uint32_t depth;       ///< substeps that may be swept in one pass over the lattice rows
    uint32_t carry_rows;  ///< for each worker one for each substep of a pass
    float *carry;         ///< [carry_rows] forces on the row above, N, all x and then all y of each
    mspringi_halos halos;

    mspring_settings settings; ///< but for what is the solver's: mspringi_settings_of()
    mspringi_steps steps;
    mspringi_outcome outcome;         ///< of the present step
    uint32_t added_substeps;          ///< substeps that dividing others has added in it
    uint32_t substeps;                ///< of the last step or, unless auto_substeps, of the next
    uint32_t max_substeps, most_work; ///< see mspring_settings
    uint32_t auto_substeps;           ///< each step chooses them, if its solver can: MSPRINGI_SUBSTEPS_AUTO, _EVEN
    double substep_length;            ///< see mspring_settings; 0: none is given
    mspringi_solver solver;           ///< the one that the host chose
    mspringi_solver fallback;         ///< takes steps for the explicit one; none before MSPRING_GUARD_IMPLICIT
    const mspringi_solver *running;   ///< the one that takes the present attempt; else NULL
    mspringi_guard guard;
    float
        *guard_scratch; ///< [5][slots] weights of the guard's bound, and scratch; NULL if it never checks the limit
    double shortest;    ///< smallest rest length when the network was created, m, without welds
    float shortest_set; ///< smallest of these and of all set since, m, without welds and flow
    bool has_welds;     ///< a weld was there or was set
    mspringi_sent sent[MSPRINGI_SENT_COUNT]; ///< by property, from MSPRING_STIFFNESS on

    mspringi_edits edits;
/// States of features; NULL as long as the network does not use them.
#define STATE(name) struct mspringi_##name *name;
#include "store/features.def"
    mspringi_strain strain;
    mspringi_tested tested;
    mspringi_cell_forces cells;
    mspringi_constraints constraints; ///< of the last substep with a linear system
    mspringi_components components;
    mspringi_sleep sleep;
    mspringi_incidence incidence; ///< of all springs but spare ones; made when it is first needed
    mspringi_id_pool growth;
    mspringi_added_springs added_springs;
    mspringi_groups groups;
    mspringi_any_shape any_shape;
    mspringi_any_shape
        last_shape; ///< found last, perhaps in a failed step; kept, so that the next step need not find it again

    mspringi_forces forces;
    mspring_id next_collider; ///< id of the next collider that is added
    mspringi_in_hook in_hook;
    bool was_opened;       ///< it became open in this step
    mspringi_extrema seen; ///< extrema after the substeps of the last attempt
    bool is_open; ///< somebody outside may write to the state's arrays, or has done since the last step: a hook, or
                  ///< the host through a view
};

/// Arrays of a state, one after another: x, y, vx, vy, low_x, low_y and, in precise networks, low_vx, low_vy.
static inline size_t mspringi_state_arrays(const mspring_network *network) {
    return network->is_precise ? 8 : 6;
}

static inline size_t mspringi_slot_count(const mspring_network *network) {
    return (size_t)network->topology.block_count * MSPRINGI_WIDTH;
}

/// End of the slots in use: all particles lie below it. The spare slots behind hold zeros, or forces that act on
/// nothing.
static inline size_t mspringi_used_slots(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    return t->spare_blocks == 0 ? mspringi_slot_count(network)
                                : t->spans[t->rows[t->row_count - 1].first_span].end_slot;
}

/// Inverse masses in the present step, 1/kg: 0 for particles that sleep or are held.
static inline const float *mspringi_active_inverse_mass(const mspring_network *network) {
    return network->sleep.sleeping > 0 ? network->sleep.active_inverse_mass
           : network->groups.held > 0  ? network->groups.active_inverse_mass
                                       : network->inverse_mass;
}

static inline bool mspringi_particle_exists(const mspring_network *network, mspring_id particle) {
    return !network->growth.particles || network->growth.particles[particle] == MSPRINGI_THERE;
}
static inline bool mspringi_spring_exists(const mspring_network *network, mspring_id spring) {
    return !network->growth.springs || network->growth.springs[spring] == MSPRINGI_THERE;
}

/// Allocate the message of read-only calls.
mspring_result mspringi_shared_reserve(mspring_network *network);

/// Check the struct that a read-only call fills. A network NULL is MSPRING_ERROR_ARGUMENT.
mspring_result mspringi_check_report(const mspring_network *network, const mspringi_struct *of, const void *out);

/// Refuse NULL, and calls from inside a hook.
mspring_result mspringi_check_call(mspring_network *network);

/// True if the next step chooses its number of substeps.
static inline bool mspringi_can_choose_substeps(const mspring_network *network) {
    return network->auto_substeps && network->solver.ops->can_choose_substeps;
}

/// Refuse settings that mspring_network_set_settings() would.
mspring_result mspringi_check_settings(const mspring_settings *settings, mspringi_message *message);

/// The settings that the next step uses.
mspring_settings mspringi_settings_of(const mspring_network *network);

/// The same settings with another solver: how it is evolved, not what guards it and what acts.
mspring_settings mspringi_settings_with_solver_of(const mspring_settings *settings, const mspring_settings *solver);

/// From now on, or never if NULL, destroying the network releases the host's tasks.
void mspringi_network_own_tasks(mspring_network *network, const mspring_tasks *tasks);

/// Clear the slots without a particle, which a hook or a view may have written to: those in use, and those behind.
void mspringi_clear_empty_slots(const mspring_network *network);
void mspringi_clear_unused_slots(const mspring_network *network);

/// Drop the low words that are too large for their coordinates.
void mspringi_drop_stale_lows(const mspring_network *network);

/// Allocate the carry rows and halos that the network's workers need, unless it has as many.
mspring_result mspringi_carry_reserve(mspring_network *network);

/// Allocate the explicit solver's arrays by slot and by spring slot. On error some of them are there.
mspring_result mspringi_layout_reserve(mspring_network *network);
/// Copy a field, or set it to 0, in the slots in use.
void mspringi_field_copy(const mspring_network *network, mspringi_field from, mspringi_field to);
void mspringi_field_clear(const mspring_network *network, mspringi_field field);
/// Forget the forces that were given for the next step.
void mspringi_forces_forget(mspring_network *network);
/// Allocate a field of all slots, zeroed; leaves it alone if it is there.
mspring_result mspringi_field_reserve(mspring_network *network, mspringi_field *field);

#endif

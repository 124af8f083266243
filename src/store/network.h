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
#include "store/sent_values.h"
#include "store/sleep_state.h"
#include "store/solver.h"
#include "store/state.h"
#include "store/steps.h"
#include "store/tested_springs.h"
#include "tasks/tasks.h"

/// Forces from outside, in N by slot. Fields that a network does not need are NULL.
typedef struct mspringi_forces {
    mspringi_field held;   ///< given by the host for the next step
    mspringi_field base;   ///< held and what hooks before the step added: where each substep starts from
    mspringi_field driven; ///< base, and what hooks before the substep added
    mspringi_field inner;  ///< these, and forces within bodies that a stage added
    bool held_any;         ///< held is not all zero
    uint32_t held_calls;   ///< if it is not: calls that gave it, of forces up to MSPRINGI_MODEST
} mspringi_forces;

/// N, of which so many calls add up to something finite.
#define MSPRINGI_MODEST 1e30f
#define MSPRINGI_MODEST_CALLS 1000000u

typedef enum mspringi_in_hook {
    MSPRINGI_IN_NO_HOOK,
    MSPRINGI_IN_HOOK, ///< in one at a time
    MSPRINGI_IN_HOOKS ///< in several, perhaps, on different threads
} mspringi_in_hook;

/// Stiffness and damping as fractions; stiffness < 0 for a spring that is not relative.
typedef struct mspringi_relative {
    float stiffness, damping;
} mspringi_relative;

/// Those of all springs; values is NULL if no spring is relative.
typedef struct mspringi_fractions {
    mspringi_relative *values;
    uint8_t *of_spring; ///< [springs] which of values; NULL: values is [springs]
} mspringi_fractions;

/// Forces of areas that the sweeps of lattices compute, see features/areas/areas.h.
typedef struct mspringi_cell_forces {
    float *values;  ///< [lattice blocks][2][lane] half the force per distance at area 0, and its slope
    uint32_t swept; ///< cells that have any
} mspringi_cell_forces;

/// Rest lengths of the lattices' springs, in blocks of [direction][lane].
typedef struct mspringi_rest_lengths {
    float *lengths;     ///< [count] blocks: those that several lattice blocks share, then those of one each
    uint32_t *of_block; ///< [lattice blocks] which of them is whose
    uint32_t count, shared_count;
} mspringi_rest_lengths;

/// What workers leave to each other where they share strips, see solvers/explicit/halo.h and partition.h; no arrays
/// for one.
typedef struct mspringi_halos {
    uint32_t workers;     ///< that there is room for; 0: none
    uint32_t count;       ///< halos: borders between lattice strips
    uint32_t substeps;    ///< in the deepest pass
    uint32_t row_spans;   ///< spans in a row, at most
    uint32_t strips;      ///< or tiers, whichever are more
    size_t segment;       ///< slots of the widest row, and a block to be read behind
    float *values;        ///< [count][MSPRINGI_STATE_ARRAYS][rows of a halo][segment]
    mspringi_span *spans; ///< [count][2][2][row_spans]
    uint32_t *borders;    ///< [MSPRINGI_PLANNED_PASSES][workers]
    uint64_t *weights;    ///< [strips + 1] of the strips below each
} mspringi_halos;

/// Whether an id names something.
enum {
    MSPRINGI_GONE = 0,  ///< it was removed
    MSPRINGI_THERE = 1, ///< it does
    MSPRINGI_SPARE = 2  ///< it can be given to what is added next
};

/// No end of a spring.
#define MSPRINGI_NO_END UINT32_MAX

/// What has been added and removed. End e of the spare springs is that of the spare spring number e / 2; those at a
/// particle are linked.
typedef struct mspringi_id_pool {
    uint8_t *particles, *springs; ///< [reserve.particle_end], [reserve.spring_end] NULL: all ids so far are there
    uint32_t *first_end;          ///< [reserve.particle_end] MSPRINGI_NO_END if there is none
    uint32_t *next_end;           ///< [2 * spare springs]
    mspring_id *particle_of_end;  ///< [2 * spare springs]
    mspring_id lowest_particle, lowest_spring; ///< no id below is spare
} mspringi_id_pool;

/// The springs of particle p are springs[first[p]] ... springs[first[p + 1] - 1], by rising id. Spare springs are
/// in none of these lists.
typedef struct mspringi_incidence {
    uint32_t *first;   ///< [particles + 1], or NULL: not made yet
    uint32_t *springs; ///< [2 * springs]
} mspringi_incidence;

/// What is needed to measure all springs at once; NULL as long as that has not been done.
typedef struct mspringi_extents {
    float *scratch;     ///< [2][places] what is computed, see extents.c
    uint16_t *reversed; ///< [place words] a bit for each place: 1 where its base is the second end
} mspringi_extents;

/// An array that is added here goes into store/network.def. What one feature alone has is behind a pointer that
/// features.def declares.
struct mspring_network {
    mspringi_memory memory;       ///< the network itself and all that it holds, but for
    mspringi_memory tasks_memory; ///< what a copy of the network has of its own: workers, and the shared message
    mspringi_message message;
    mspringi_shared_message *shared; ///< of calls that only read; in tasks_memory
    mspringi_topology topology;
    mspringi_topology whole; ///< the one the network was created with, while it is compact; else empty
    bool is_compact;
    uint64_t whole_fingerprint;   ///< topology_fingerprint of whole
    uint32_t whole_tile_size;     ///< of the implicit solver that whole had; 0 if there was none
    uint32_t whole_fallback_size; ///< the same of the fallback's
    mspring_job *job;             ///< another layout that is being made, or NULL
    bool is_seen_compact;         ///< with these edits it was found to have nothing to do
    uint64_t seen_links, seen_growth;
    uint64_t topology_fingerprint;  ///< hash of which particles the springs join, and of where they lie
    uint64_t parameter_fingerprint; ///< hash of what the springs are like, and of all edits of that
    const mspringi_kernels *kernels;
    mspringi_tasks *tasks; ///< NULL: the caller's thread steps alone

    // State.
    mspringi_state state, backup;
    uint32_t dithered;         ///< substeps of the step that is being made with dither (dither.h): fours, or 0
    uint32_t first_substep;    ///< number in the step of the first of the substeps that are being taken
    float lag;                 ///< steps.lag at the first of these, s
    float full_lag;            ///< the same for gravity, whatever is stable
    double step_time;          ///< that the step takes, s: dt, but for MSPRING_SUBSTEPS_EVEN
    mspringi_pace next_pace;   ///< once it has succeeded
    bool backup_is_start;      ///< since it was written, nothing but the solver has written to the state
    double origin_x, origin_y; ///< world = origin + local
    float recentre_distance;   ///< how far the network may be from its origin until that is moved along

    // Parameters.
    float *inverse_mass;          ///< [slots] 0 if pinned or empty
    float *mass;                  ///< [particles]
    float *inverse_mass_scale;    ///< [particles], or NULL as long as all are 0 (where inverse_mass is) or 1
    float *spring_mass;           ///< [particles] masses that relative springs go by, or NULL if these are mass
    bool is_scaled, is_reweighed; ///< scales, or masses, have been given that these two are needed for
    uint32_t parts;               ///< values per spring in the records: 2, or 3 with damping
    bool is_precise;              ///< low words count in the lengths of springs
    mspringi_rest_lengths rest_lengths; ///< of lattice_springs, whose records have stiffness and damping only
    float *lattice_springs, *chain_springs;
    mspringi_shared_records shared_records; ///< in stiffness and damping
    float *irregular_springs;
    float
        *gathered; ///< [2][nodes of the irregular part][4] at the start of every other substep; see store/precise.h
    float *attached; ///< forces on the attached nodes, all x and then all y
    mspringi_fractions fractions;
    float relative_h;        ///< the substep that relative springs were derived for; 0: not yet
    uint16_t *live;          ///< [places / 16] a bit for each place: 1 where a spring is, and is not broken
    mspringi_relative *kept; ///< [springs] N/m, N s/m of broken springs that are not relative; NULL before any
    uint8_t *is_reversed; ///< [(reserve.first_spring + 7) / 8] a bit for each spring that was given with the higher
                          ///< id first; NULL if none was
    int8_t *side;         ///< [reserve.first_spring] see mspringi_side_of(); NULL if all springs pull and push
    bool keeps_none;      ///< all springs were seen to be relative, and stay so
    uint32_t depth;       ///< substeps that may be swept in one pass over the lattice rows
    uint32_t carry_rows;  ///< for each worker as many as there are substeps under way
    float *carry;         ///< [carry_rows] forces on the row above, all x and then all y of each
    mspringi_halos halos;

    mspring_settings settings;
    mspringi_steps steps;
    mspringi_outcome outcome; ///< of the step that is being made
    uint32_t added_substeps;  ///< by pieces of substeps in it
    uint32_t substeps;        ///< of the last step or, unless auto_substeps, of the next
    uint32_t max_substeps;
    uint32_t most_work;             ///< see mspring_solver_def
    uint32_t auto_substeps;         ///< each step chooses them, if its solver can: MSPRINGI_SUBSTEPS_AUTO, _EVEN
    mspringi_solver solver;         ///< the one that the host chose
    mspringi_solver fallback;       ///< takes steps for the explicit one; none before MSPRING_GUARD_IMPLICIT
    const mspringi_solver *running; ///< the one that takes the step that is being made; else NULL
    mspringi_guard guard;
    float
        *guard_scratch; ///< [5][slots] weights of the guard's bound, and room; NULL if it never looks at the border
    double shortest;    ///< smallest rest length at first, m, but for welds
    float shortest_set; ///< and of all that have been set since, but for flow
    bool has_welds;     ///< there has been one
    mspringi_sent sent[MSPRINGI_SENT_COUNT]; ///< by property, from MSPRING_STIFFNESS on

    mspringi_edits edits;
/// Of features: NULL as long as the network does not use them.
#define STATE(name) struct mspringi_##name *name;
#include "store/features.def"
    mspringi_strain strain;
    mspringi_tested tested;
    mspringi_cell_forces cells;
    mspringi_constraints constraints; ///< of the last substep with a linear system
    mspringi_components components;
    mspringi_extents extents;
    mspringi_sleep sleep;
    mspringi_incidence incidence; ///< made when it is needed first, of the springs that are not spare ones
    mspringi_id_pool growth;
    mspringi_added_springs added_springs;
    mspringi_groups groups;
    mspringi_any_shape any_shape;
    mspringi_any_shape last_shape; ///< found last, maybe in a step that was refused: to find it again costs nothing

    mspringi_forces forces;
    mspring_id next_collider;
    mspringi_in_hook in_hook;
    bool was_in_hook;      ///< one was called in this step
    mspringi_extrema seen; ///< of what the substeps have led to, with bounds for what was not watched
    bool is_open; ///< somebody outside may write to the state's arrays, or has done since the last step: a hook, or
                  ///< the host through a view
    bool has_host_view; ///< the latter, so also to slots that no step uses
};

/// Arrays of a state, one after another: x, y, vx, vy, low_x, low_y and, in precise networks, low_vx, low_vy.
static inline size_t mspringi_state_arrays(const mspring_network *network) {
    return network->is_precise ? 8 : 6;
}

static inline size_t mspringi_slot_count(const mspring_network *network) {
    return (size_t)network->topology.block_count * MSPRINGI_WIDTH;
}

/// Slots in front of which all particles lie. In what a step reads and writes spare slots behind them hold zeros,
/// or forces that act on nothing.
static inline size_t mspringi_used_slots(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    return t->spare_blocks == 0 ? mspringi_slot_count(network)
                                : t->spans[t->rows[t->row_count - 1].first_span].end_slot;
}

/// Inverse masses as a step sees them, 0 of what sleeps or is held.
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

/// Allocate the message of calls that only read.
mspring_result mspringi_shared_reserve(mspring_network *network);

/// Check the struct that a call which only reads is to fill. A network NULL is MSPRING_ERROR_ARGUMENT.
mspring_result mspringi_check_report(const mspring_network *network, const mspringi_struct *of, const void *out);

/// Refuse NULL, and calls from inside a hook.
mspring_result mspringi_check_call(mspring_network *network);

/// Refuse ranges of ids that leave the network.
mspring_result mspringi_check_range(mspring_network *network, const char *what, mspring_id first, uint32_t count,
                                    uint32_t total);

/// Whether the next step chooses its substeps.
static inline bool mspringi_can_choose_substeps(const mspring_network *network) {
    return network->auto_substeps && network->solver.ops->can_choose_substeps;
}

/// Refuse settings that mspring_network_set_settings() would.
mspring_result mspringi_check_settings(const mspring_settings *settings, mspringi_message *message);

/// Refuse solver definitions that mspring_network_set_solver() would.
mspring_result mspringi_check_solver(const mspring_solver_def *def, mspringi_message *message);

/// Clear slots without particle, which a hook or a view may have written to: among those in use, and behind them.
void mspringi_clear_empty_slots(const mspring_network *network);
void mspringi_clear_unused_slots(const mspring_network *network);

/// Drop the low words that are too large for their coordinates.
void mspringi_drop_stale_lows(const mspring_network *network);

/// Allocate the carry rows and halos that the network's workers need, unless it has as many.
mspring_result mspringi_carry_reserve(mspring_network *network);

/// Allocate what the explicit solver has by slot and by place. On error some of it is there.
mspring_result mspringi_layout_reserve(mspring_network *network);
/// Copy a field, or set it to 0, in the slots in use.
void mspringi_field_copy(const mspring_network *network, mspringi_field from, mspringi_field to);
void mspringi_field_clear(const mspring_network *network, mspringi_field field);
/// Allocate a field of all slots, zeroed; leaves it alone if it is there.
mspring_result mspringi_field_reserve(mspring_network *network, mspringi_field *field);

#endif

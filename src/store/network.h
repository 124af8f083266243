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
#include "kernels/kernels.h"
#include "layout/topology.h"
#include "store/added_springs.h"
#include "store/components.h"
#include "store/constraint_list.h"
#include "store/groups.h"
#include "store/solver.h"
#include "store/state.h"
#include "tasks/tasks.h"

/// Forces from outside, in N by slot. Fields that a network does not need are NULL.
typedef struct mspringi_forces {
    mspringi_field held;   ///< given by the host for the next step
    mspringi_field base;   ///< held and what hooks before the step added: where each substep starts from
    mspringi_field driven; ///< base, and what hooks before the substep added
    bool held_any;         ///< held is not all zero
    uint32_t held_calls;   ///< if it is not: calls that gave it, of forces up to MSPRINGI_MODEST
} mspringi_forces;

/// N, of which so many calls add up to something finite.
#define MSPRINGI_MODEST 1e30f
#define MSPRINGI_MODEST_CALLS 1000000u

/// A box that no surface is near.
typedef struct mspringi_safe_box {
    mspringi_bounds box;
    float coordinate;          ///< coordinates of less than this size are in the box
    double reach;              ///< half as far from the box there is no surface; 0: there is no such box
    double origin_x, origin_y; ///< that it is relative to
} mspringi_safe_box;

/// Whether any particle may come below the height of a hook with MSPRING_HOOK_BELOW in a step.
typedef enum mspringi_distance { MSPRINGI_UNKNOWN, MSPRINGI_AWAY, MSPRINGI_CLOSE } mspringi_distance;

typedef struct mspringi_hook {
    mspring_hook_def def;
    uint32_t number;
    mspringi_field held; ///< forces of a hook that is not called before every substep; else none
    mspringi_distance distance;
    mspringi_safe_box room; ///< above its height, that all of the network was in
} mspringi_hook;

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

/// What has been edited between steps, in counters that only ever grow. Whoever keeps something that follows from
/// the edited (a solver its history or its tiles, a measurement its components) remembers the counters that it has
/// seen and looks whether they are still the same: mspringi_edits_have_link() and mspringi_edits_link() then tell
/// which springs it was. Views may be written to without any counter knowing; what relative springs derive from a
/// new substep is no edit either.
typedef struct mspringi_edits {
    uint64_t state;         ///< calls that set positions or velocities
    uint64_t motion;        ///< calls that set the positions of all particles at once: a new motion begins
    uint64_t masses;        ///< calls that changed inverse masses
    uint64_t values;        ///< calls that changed stiffness, damping or rest lengths
    uint64_t growth;        ///< calls that added or removed particles or springs
    uint64_t grafts;        ///< those among them in which springs were added or removed
    uint64_t links;         ///< springs that were broken or restored, added or removed, one by one
    uint64_t sleep_changes; ///< times that islands fell asleep or woke
    uint64_t layouts;       ///< times that all slots changed
    uint64_t origins;       ///< times that the local origin moved
    mspring_id
        *link_log; ///< the last of these springs: change n, counted from 0, is at n & link_mask; NULL before any
    uint32_t link_mask;
    bool broke; ///< there have been such changes, here or in what was loaded
} mspringi_edits;

/// A restored spring on its way to its own rest length.
typedef struct mspringi_ramp {
    mspring_id spring;
    float to;       ///< its own rest length, m
    double from;    ///< rest length when it was restored
    double seconds; ///< that the way takes
    double passed;  ///< of these
} mspringi_ramp;

typedef struct mspringi_ramps {
    mspringi_ramp *list;
    size_t count, capacity;
} mspringi_ramps;

/// What mspringi_stable_in_any_shape() has found, and the edits that it has seen.
typedef struct mspringi_any_shape {
    double dt;
    double mixed_dt; ///< see mspringi_stable_with_relative(); 0: not known yet
    mspring_id spring;
    bool is_known;
    uint64_t masses, values, growth;
} mspringi_any_shape;

/// A particle that the host holds; see contact/grips.h.
typedef struct mspringi_grip {
    mspring_id id;       ///< of the grip
    mspring_id particle; ///< that it holds
    float stiffness, damping, max_force;
    double x, y;                 ///< where the target is at the end of the next step, world coordinates
    double from_x, from_y;       ///< and at its start
    double impulse_x, impulse_y; ///< that it gave in the last step, N s
    double sum_x, sum_y;         ///< the same of the step that is being made
    double force_x, force_y;     ///< in an implicit substep, N
    double share;                ///< of stiffness and damping that acts in it
    bool is_bounded;             ///< none does, but the force that is the largest
} mspringi_grip;

typedef struct mspringi_grips {
    mspringi_grip *list; ///< [MSPRING_MAX_GRIPS] in the order of ids; NULL before the first
    uint32_t count;
    mspring_id next_id;

    // A step.
    bool could_act; ///< they could act in it
    float h;
    double begin, share; ///< of the step that has passed before its substep, and that the substep is
    double passed;       ///< of the substep, where an implicit one is taken in pieces
} mspringi_grips;

/// The events that the host has not read yet: a ring, empty if the host has not asked for one.
typedef struct mspringi_events {
    mspring_event *ring; ///< [capacity]
    uint32_t first, count, capacity;
    uint64_t lost;
} mspringi_events;

/// What springs break and are stressed at, by place; NULL as long as none does.
typedef struct mspringi_strain {
    float *break_strain, *stress_strain;
    float *relax_strain;       ///< MSPRING_RELAX_STRAIN_DEFAULT: the usual fraction of its stress strain
    float *least;              ///< the smaller of the two; NULL as long as break_strain is alone
    uint16_t *stressed;        ///< [places / MSPRINGI_WIDTH] a bit for each place
    mspringi_strain_hit *hits; ///< [places / MSPRINGI_WIDTH] for the pass to write to
    bool breaks, stresses;     ///< a threshold of this kind has been finite: there is something to save
    bool relaxes;              ///< so with a relax strain that is not the default
} mspringi_strain;

/// A spring that only pulls or only pushes, in a step.
typedef struct mspringi_one_way_spring {
    mspringi_spring_slot spring_slot;
    uint32_t base, tip;       ///< slots
    float rest_length;        ///< as the host reads it
    float stiffness, damping; ///< where it acts
    uint32_t due;             ///< substep in which it acts whatever is expected; MSPRING_NONE: in none
    int32_t side;             ///< 1: it pulls; -1: it pushes
    bool acts;                ///< its records have these values, not 0
} mspringi_one_way_spring;

/// Springs that only pull or only push; side is NULL if there is none.
typedef struct mspringi_one_way {
    int8_t *side;                  ///< [reserve.first_spring] see mspringi_side_of()
    mspringi_one_way_spring *list; ///< [count] those of the step that are live
    uint32_t count, listed;
    bool must_repeat; ///< one did not act in a substep in which it should have
    bool is_repeated; ///< for that reason, the step is taken once more
} mspringi_one_way;

/// What springs yield at, and what has become of them, by place; NULL as long as none yields. See step/yielding.c.
typedef struct mspringi_plastic {
    float *yield_strain, *hardening, *plastic_limit;
    float *nominal;              ///< rest length before any flow, m; the one in force is among the spring's values
    float *low, *high;           ///< squares of the lengths between which the spring is cold, m^2
    float *flow_low, *flow_high; ///< of those between which it does not flow
    float *before;               ///< rest length before the step, where it has changed in it
    float *gain;                 ///< 1 / (1 + hardening)
    float *heat;                 ///< what flow has dissipated in the step, J
    mspringi_shared_records shared_records; ///< lattice blocks with the same rest lengths and bounds
    uint16_t
        *has_flowed; ///< [places / MSPRINGI_WIDTH] a bit for each place: its rest length has changed in the step
    mspringi_strain_hit *hits; ///< [places / MSPRINGI_WIDTH] springs that were warm at the last look
    uint32_t hit_count;
    float *ahead;          ///< [2 slots] x and y where particles would be at the end of a substep
    uint8_t *warmth;       ///< [strips] MSPRINGI_WARM, ...
    uint32_t substep;      ///< of the step, the first of those that are being taken
    bool is_swept;         ///< the sweeps of rows test their springs
    bool maps;             ///< ... and map them; else they only find out whether any is warm
    bool was_warm;         ///< some strip was in the last step; says only what is worth trying
    bool irregular_yields; ///< some spring of the irregular part may yield in this step
    bool yields;           ///< a yield strain has been finite: there is something to save
    bool is_bent;          ///< some rest length may be another than the nominal one
    bool flows;            ///< some bit of has_flowed is set, other than by rows that test
    uint64_t flows_seen;   ///< times that a rest length has changed by flow
    uint64_t count;        ///< springs that flowed in a step, summed over the steps
    double dissipated;     ///< J
} mspringi_plastic;

typedef struct mspringi_corner {
    mspring_id particle;
    mspring_id spring; ///< to the next corner when the area was added; MSPRING_NONE: there was none
    uint32_t slot;     ///< of the particle; see mspringi_areas_refresh()
    float reach;       ///< by how much the area grew then where the particle moved outwards, m
} mspringi_corner;

/// Counters of edits, see mspringi_edits.
typedef struct mspringi_areas_seen {
    uint64_t changes, links, growth, layouts, masses;
} mspringi_areas_seen;

/// All of them.
typedef struct mspringi_areas {
    mspringi_area *list; ///< [count] in the order of ids
    size_t count, capacity;
    mspringi_corner *corners; ///< [corner_count] of the first area, of the second, and so on
    size_t corner_count, corner_capacity;
    size_t angle_count; ///< areas in the list that are angles
    mspring_id next_id;
    uint64_t changes; ///< times that any was edited

    // What follows from these, the springs and the layout; see mspringi_areas_refresh().
    mspringi_areas_seen seen;
    uint32_t swept, unswept; ///< closed areas that the explicit solver's sweeps have in them, and others
    uint32_t unringed;       ///< and those without springs all around
    uint32_t hinge_count;    ///< closed angles with springs along both arms
    double longest;          ///< substep that is stable with forces of these alone, s
    double longest_of_all;   ///< and with those of all
    float *cells;            ///< [lattice blocks][2][lane] half the force per distance at area 0, and its slope
    mspringi_field force;    ///< from outside and of areas, in a substep
} mspringi_areas;

/// What came of a step beside its result: see mspring_step_info.
typedef struct mspringi_outcome {
    mspring_id particle, spring; ///< to blame
    uint32_t flags;
    double work; ///< of all attempts, in calm steps
} mspringi_outcome;

/// Pace of MSPRING_SUBSTEPS_EVEN.
typedef struct mspringi_pace {
    double dt;      ///< from which the length of substeps was chosen, s; 0: none was
    double h;       ///< the length, s
    double left;    ///< that steps were asked for and have not taken yet, s; < 0: they are ahead
    uint32_t steps; ///< in a row that ask for another length
} mspringi_pace;

/// Values of auto_substeps.
enum { MSPRINGI_SUBSTEPS_GIVEN, MSPRINGI_SUBSTEPS_AUTO, MSPRINGI_SUBSTEPS_EVEN };

/// The last step, and how many there have been.
typedef struct mspringi_steps {
    mspring_result result;
    mspringi_outcome outcome;
    uint32_t substeps; ///< of the last that succeeded
    uint64_t count, fallback_count;
    double time; ///< s
    double dt;   ///< of the last that succeeded, s; 0: none did
    /// Steps that MSPRING_SUBSTEPS_AUTO still takes for uneven, after a change of dt.
    uint32_t uneven_steps;
    /// The last explicit substep, s: velocities are half of it older than positions; 0: they are not. Other solvers
    /// leave it: what they begin with, and end with, is as old.
    float lag;
    mspringi_pace pace;
} mspringi_steps;

/// Steps after a change of dt for which steps count as uneven.
#define MSPRINGI_UNEVEN_STEPS 600u

static inline mspringi_outcome mspringi_outcome_none(void) {
    return (mspringi_outcome){.particle = MSPRING_NONE, .spring = MSPRING_NONE};
}

/// Steps that follow one which the explicit solver could not take, and which it is not asked to: to find that it
/// still cannot takes longer than they do.
#define MSPRINGI_FALLBACK_STEPS 15u

/// What the guard knows from step to step.
typedef struct mspringi_guard {
    float h, global_damping; ///< the border was looked at for these; h is 0 at first
    bool watches;            ///< this step's substeps are longer than what is stable in any shape
    uint32_t fallback_steps; ///< steps that the fallback still takes before the explicit solver is tried again
    float peak;              ///< largest change when the border was looked at last, fading, m/s
    bool knows_speed;        ///< speed is that of the state before this step
    bool knows_coordinate;   ///< place is, and how far it gets in this step follows from speeds at its end
    float speed;             ///< none was larger at the end of the last step, m/s; infinite if that is not known
    float coordinate;        ///< so with coordinates, m
    uint64_t state;          ///< edits.state then
} mspringi_guard;

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

/// Which islands sleep, and what they were when they fell asleep; no arrays if none ever does. An island is a
/// component of live springs, numbered by its lowest slot.
typedef struct mspringi_sleep {
    uint32_t count;    ///< islands; 0: not looked for yet
    uint32_t sleeping; ///< of these asleep; what follows of slots and blocks is of no use as long as this is 0
    uint32_t *island;  ///< [slots] of each slot, MSPRING_NONE if it has no particle
    uint32_t *lowest;  ///< [particles] the lowest slot of each island
    uint32_t *beside;  ///< [slots] of the lowest one of a sleeper: that of the next in its pile, in a ring
    double *still;     ///< [particles] of each island, for how long it has been still, s; < 0: asleep
    double *kept;      ///< [particles] still before the step, if it woke any
    bool has_kept;
    bool is_mapped;         ///< what follows is up to date
    uint8_t *mark;          ///< [particles] of each island, while all are gone through
    uint32_t *scratch;      ///< [slots]
    uint32_t *block_island; ///< [blocks] the island that all of a block is of, MSPRING_NONE if there are several
    float *active_inverse_mass;    ///< [slots] inverse mass, 0 of what sleeps
    uint16_t *sleepers;            ///< [blocks] a bit for each slot
    uint8_t *swept;                ///< [blocks] 1 where a particle is awake, or springs are of one that is
    uint8_t *share;                ///< [strips] mspringi_strip_sleep
    mspringi_span *runs;           ///< [spans] runs of blocks of a row while that is swept, from its first span on
    bool has_force;                ///< force is not all zero
    double origin_x, origin_y;     ///< that state is relative to, m
    float *state;                  ///< [MSPRINGI_STATE_ARRAYS][slots]
    float *inverse_mass;           ///< [slots]
    float *held;                   ///< [4][slots] positions and their low words, while substeps are taken
    mspringi_field force;          ///< from outside
    mspringi_field in_force;       ///< of the step that is being made; else NULL
    uint64_t masses, links, moved; ///< edits that it has seen; the last is edits.state
    uint64_t piled;                ///< edits.naps for which piles were found
} mspringi_sleep;

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

/// An array that is added here goes into store/network.def.
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
    struct mspringi_floor *floor;   ///< NULL: there is none
    struct mspringi_contacts *contacts; ///< contact between bodies; NULL: there is none
    mspringi_guard guard;
    float
        *guard_scratch; ///< [5][slots] weights of the guard's bound, and room; NULL if it never looks at the border
    double shortest;    ///< smallest rest length at first, m, but for welds
    bool has_welds;     ///< there has been one

    mspringi_edits edits;
    mspringi_ramps ramps;
    mspringi_grips grips;
    mspringi_strain strain;
    mspringi_plastic plastic;
    mspringi_one_way one_way;
    mspringi_areas areas;
    mspringi_constraints constraints; ///< of the last substep with a linear system
    mspringi_events events;
    mspringi_components components;
    mspringi_extents extents;
    mspringi_sleep sleep;
    mspringi_incidence incidence; ///< made when it is needed first, of the springs that are not spare ones
    mspringi_id_pool growth;
    mspringi_added_springs added_springs;
    mspringi_groups groups;
    mspringi_actuators actuators;
    mspringi_any_shape any_shape;
    mspringi_any_shape last_shape; ///< found last, maybe in a step that was refused: to find it again costs nothing

    mspringi_forces forces;
    mspringi_hook *hooks;
    size_t hook_count, hook_capacity;
    uint32_t next_hook;
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

/// Whether the log still has everything from change number seen on; if not, any spring may have changed.
static inline bool mspringi_edits_have_link(const mspringi_edits *edits, uint64_t seen) {
    return edits->links - seen <= (uint64_t)edits->link_mask + 1;
}

/// The spring that was broken or restored in change number n.
static inline mspring_id mspringi_edits_link(const mspringi_edits *edits, uint64_t n) {
    MSPRINGI_ASSERT(edits->link_log && n < edits->links && mspringi_edits_have_link(edits, n));
    return edits->link_log[n & edits->link_mask];
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

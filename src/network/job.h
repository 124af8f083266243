/// @file job.h
/// Job: a new layout of a network, computed while the network steps.
///
///   begin   copies the input of the layout: spring slots, the springs' values, live bits
///   run     short functions on these copies: a topology of the surviving springs (survivors.c), then its arrays,
///           springs and solver (relayout.c). Any thread may run them while the network steps
///   finish  moves the network to the new layout: present particles, and springs set since (relayout.c)
///
/// A job owns all that it reads. So the network may be edited, stepped, saved, cloned or destroyed while it runs.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_JOB_H
#define MSPRINGI_JOB_H

#include "base/passes.h"
#include "store/network.h"
#include "store/rest_lengths.h"

/// Request for one of the new network's solvers.
typedef struct mspringi_job_solver {
    mspring_settings def; ///< of the present solver
    uint32_t tile_size;   ///< 0: by layout
} mspringi_job_solver;

struct mspring_job {
    mspringi_memory memory;   ///< job itself, and copies; results are in the memory of `to`
    mspring_network *network; ///< NULL if it was destroyed or moved, or the job is finished
    mspring_layout layout;
    bool is_needless;       ///< network already has this layout
    bool is_spent;          ///< failed or finished: can only be destroyed
    mspring_result failure; ///< of run

    mspring_network from;           ///< copies by begin; owns all that it points to
    mspring_network to;             ///< results so far
    mspring_network shape;          ///< network at begin: only the presence of its arrays is read
    mspringi_topology initial;      ///< initial layout of the network; empty if from has it
    mspringi_job_solver solvers[2]; ///< present solver and fallback
    uint32_t workers;
    uint64_t links, growth; ///< edits.links and edits.growth
    mspringi_cursor cursor; ///< in the list in job.c

    // survivors.c
    bool has_work;               ///< some spring in the layout is broken, or some live one is outside
    uint16_t *was_live;          ///< [springs / 16] a bit for each spring
    struct mspring_builder left; ///< particles by row and column of the initial layout, live springs
    mspring_id *ids;             ///< [left.spring_count] ids of the live springs, rising
    uint32_t live, listed;       ///< live springs; those listed so far
    mspringi_layout_builder *layout_builder;
    mspringi_spring_slot *laid_out_spring_slots; ///< [left.spring_count] of the live springs
    mspringi_spring_slot next_inactive;
    uint64_t fingerprint; ///< of the layout, so far

    // relayout.c
    mspringi_spring_slot *new_slot;  ///< spring slot in `to`, by spring slot in `from`
    mspringi_rest_pattern *of_block; ///< [lattice blocks] while rest lengths are compared
    uint16_t *changed;               ///< a bit for each spring slot in `from`, set by edits since begin
    bool has_changed, has_all_changed;
};

/// Record a change of the spring in this slot, or of unnamed springs. The network need not have a job.
void mspringi_job_track(const mspring_network *network, mspringi_spring_slot spring_slot);
void mspringi_job_track_all(const mspring_network *network);
/// Mark the job as outdated: the network's layout has changed, or the network was destroyed.
void mspringi_job_invalidate(mspring_network *network);

static inline const mspringi_topology *mspringi_job_initial_topology(const mspring_job *job) {
    return job->initial.slot_of_particle ? &job->initial : &job->from.topology;
}

mspring_result mspringi_job_no_memory(mspring_job *job);

/// Begin a job that the network does not know of: edits meanwhile are not tracked unless network->job is set.
mspring_result mspringi_job_begin(mspring_network *network, mspring_layout layout, mspring_job **begun);
/// Run the next at_most parts, all if it is 0. On error the job can only be destroyed.
mspring_result mspringi_job_run(mspring_job *job, uint32_t at_most);
/// Parts left, an estimate that never rises; 0: it can be finished.
uint32_t mspringi_job_left(const mspring_job *job);
/// Move the network to the layout of a job that was run. The job is spent.
mspring_result mspringi_job_finish(mspring_network *network, mspring_job *job);
void mspringi_job_destroy(mspring_job *job);

/// Copy a network without its arrays by slot or spring slot.
mspring_network mspringi_relayout_copy_shell(const mspring_network *network);

/* survivors.c: a topology of the springs that are left, in this order. Ranges are of springs, but for particles
 * and, in place_in_grids, lattice rows. */
mspring_result mspringi_survivors_begin(mspring_job *job);
mspring_result mspringi_survivors_count_live(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_survivors_reserve(mspring_job *job);
mspring_result mspringi_survivors_place_on_diagonal(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_survivors_place_in_grids(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_survivors_list(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_survivors_begin_layout(mspring_job *job);
mspring_result mspringi_survivors_lay_out(mspring_job *job);
mspring_result mspringi_survivors_finish_layout(mspring_job *job);
mspring_result mspringi_survivors_number_spring_slots(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_survivors_save_ends(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_survivors_assign_spare(mspring_job *job);
mspring_result mspringi_survivors_fingerprint_slots(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_survivors_fingerprint_spring_slots(mspring_job *job, uint32_t first, uint32_t end);

/* relayout.c: what lies by slot or place in the new topology, in this order. */
mspring_result mspringi_relayout_begin(mspring_job *job);
mspring_result mspringi_relayout_compare_rest_lengths(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_relayout_reserve_springs(mspring_job *job);
mspring_result mspringi_relayout_copy_springs(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_relayout_reserve_others(mspring_job *job);
mspring_result mspringi_relayout_make_solver(mspring_job *job);
mspring_result mspringi_relayout_make_fallback(mspring_job *job);
/// Move the network to the new layout. On error it is unchanged, and the job has failed.
mspring_result mspringi_relayout_network(mspring_network *network, mspring_job *job);

#endif

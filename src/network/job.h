/// @file job.h
/// Another layout of a network, made beside it.
///
///   begin    copies what the layout follows from: where springs lie, what they are like, which are live
///   run      plain functions on these copies: a topology of what is left (survivors.c), its arrays, springs and
///   solver
///            (relayout.c); any thread may run them while the network goes on
///   finish   moves the network: what its particles are now, and springs that were set since (relayout.c)
///
/// A job owns all that it reads, so the network may be edited, stepped, saved, cloned, even destroyed while it
/// runs.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_JOB_H
#define MSPRINGI_JOB_H

#include "base/passes.h"
#include "store/network.h"
#include "store/rest_lengths.h"

/// What becomes of one of the network's solvers.
typedef struct mspringi_job_solver {
    mspring_solver_def def; ///< as it was asked for
    uint32_t tile_size;     ///< 0: by plan
} mspringi_job_solver;

struct mspring_job {
    mspringi_memory memory;   ///< the job itself, and copies; what is made is in to's memory
    mspring_network *network; ///< NULL: it has been destroyed, has moved, or the job is finished
    mspring_layout layout;
    bool is_needless;       ///< the network has this layout
    bool is_spent;          ///< it has failed or is finished: it can only be destroyed
    mspring_result failure; ///< of run

    mspring_network from;    ///< what begin has copied, and nothing else that lies elsewhere
    mspring_network to;      ///< what has been made so far
    mspring_network shape;   ///< the network at begin: its arrays are not read, but for whether they are there
    mspringi_topology first; ///< the layout that the network was created with; empty if from has it
    mspringi_job_solver solvers[2]; ///< the chosen one and the fallback
    uint32_t workers;
    uint64_t links, growth; ///< edits.links and edits.growth
    mspringi_cursor cursor; ///< in the list in job.c

    // survivors.c
    bool has_work;               ///< some spring that is swept is broken, or one was added that the layout lacks
    uint16_t *was_live;          ///< [springs / 16] a bit for each spring
    struct mspring_builder left; ///< particles in the first layout's rows and columns, live springs
    mspring_id *ids;             ///< [left.spring_count] of the live springs, rising
    uint32_t live, listed;       ///< of these counted, and listed so far
    mspringi_layout_builder *assembly;
    mspringi_spring_slot *laid_out_spring_slots; ///< [left.spring_count] of the live springs
    mspringi_spring_slot next_inactive;
    uint64_t fingerprint; ///< of the layout, so far

    // relayout.c
    mspringi_spring_slot *there;     ///< by place in from, that in to
    mspringi_rest_pattern *of_block; ///< [lattice blocks] while rest lengths are looked at
    uint16_t *changed;               ///< a bit for each place in from: set since begin, by who edits
    bool has_changed, has_all_changed;
};

/// The spring in this place has changed, or others that nobody names. The network may have no job.
void mspringi_job_track(const mspring_network *network, mspringi_spring_slot spring_slot);
void mspringi_job_track_all(const mspring_network *network);
/// The network's layout has changed, or it is no more: the job is outdated.
void mspringi_job_invalidate(mspring_network *network);

static inline const mspringi_topology *mspringi_job_first(const mspring_job *job) {
    return job->first.slot_of_particle ? &job->first : &job->from.topology;
}

mspring_result mspringi_job_no_memory(mspring_job *job);

/// A network without what lies by slot or place.
mspring_network mspringi_relayout_shell(const mspring_network *network);

/* survivors.c: a topology of the springs that are left, in this order. Ranges are of springs, but for particles
 * and, in place_in_grids, lattice rows. */
mspring_result mspringi_survivors_begin(mspring_job *job);
mspring_result mspringi_survivors_look(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_survivors_reserve(mspring_job *job);
mspring_result mspringi_survivors_place_on_diagonal(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_survivors_place_in_grids(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_survivors_list(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_survivors_begin_layout(mspring_job *job);
mspring_result mspringi_survivors_lay_out(mspring_job *job);
mspring_result mspringi_survivors_finish_layout(mspring_job *job);
mspring_result mspringi_survivors_number_spring_slots(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_survivors_note_ends(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_survivors_keep_spare(mspring_job *job);
mspring_result mspringi_survivors_fingerprint_slots(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_survivors_fingerprint_spring_slots(mspring_job *job, uint32_t first, uint32_t end);

/* relayout.c: what lies by slot or place in the new topology, in this order. */
mspring_result mspringi_relayout_begin(mspring_job *job);
mspring_result mspringi_relayout_note_rest_lengths(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_relayout_reserve_springs(mspring_job *job);
mspring_result mspringi_relayout_copy_springs(mspring_job *job, uint32_t first, uint32_t end);
mspring_result mspringi_relayout_reserve_others(mspring_job *job);
mspring_result mspringi_relayout_make_solver(mspring_job *job);
mspring_result mspringi_relayout_make_fallback(mspring_job *job);
/// Move the network. On error it is as it was, and the job has failed.
mspring_result mspringi_relayout_network(mspring_network *network, mspring_job *job);

#endif

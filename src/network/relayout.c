/// Move of a network to a new layout of the same particles and springs.
///
/// Arrays by slot or spring slot are made in a second network, which shares arrays by id with the first. The job
/// makes most of them; arrays that a step changes are moved at the finish.
#include <math.h>
#include <string.h>

#include "network/job.h"
#include "stability/stability_limit.h"
#include "store/changed.h"
#include "store/feature.h"
#include "store/sleepers.h"
#include "store/spring_limits.h"
#include "store/springs.h"
#include "store/store.h"

static mspring_result no_memory_to_move(mspring_network *to) {
    return mspringi_fail(&to->message, MSPRING_ERROR_MEMORY, "no memory to move %u particles and %u springs",
                         (unsigned)to->topology.particle_count, (unsigned)to->topology.spring_count);
}

/* -------------------------------------------------------------------------------------------------- springs */

mspring_result mspringi_relayout_begin(mspring_job *job) {
    const size_t spring_slots = mspringi_spring_slot_words(&job->from.topology) * MSPRINGI_WIDTH;
    job->new_slot = mspringi_alloc(&job->memory, spring_slots, sizeof *job->new_slot);
    job->of_block = mspringi_alloc(&job->memory, job->to.topology.lattice_blocks, sizeof *job->of_block);
    return job->new_slot && job->of_block ? MSPRING_OK : no_memory_to_move(&job->to);
}

mspring_result mspringi_relayout_compare_rest_lengths(mspring_job *job, uint32_t first, uint32_t end) {
    const mspringi_topology *t = &job->to.topology;
    for (mspring_id s = first; s < end; ++s)
        if (t->slot_of_spring[s] < t->lattice_spring_slots)
            mspringi_rest_lengths_note(job->of_block, t->slot_of_spring[s],
                                       mspringi_spring_get(&job->from, s).rest_length);
    return MSPRING_OK;
}

// Blocks share rest lengths as at creation, unless the network has unshared them.
mspring_result mspringi_relayout_reserve_springs(mspring_job *job) {
    mspring_network *to = &job->to;
    mspring_result result = mspringi_layout_reserve(to);
    if (result == MSPRING_OK)
        result = mspringi_rest_lengths_reserve(&to->rest_lengths, job->of_block, to->topology.lattice_blocks,
                                               &to->memory, &to->message);
    if (result == MSPRING_OK && job->from.rest_lengths.shared_count == 0)
        result = mspringi_rest_lengths_unshare(to);
    return result == MSPRING_OK ? mspringi_limits_match_layout(to, &job->from) : result;
}

// Copy all values of a spring from its old slot to its new one.
static void copy_spring(mspring_network *to, mspringi_spring_slot spring_slot, const mspring_network *from,
                        mspringi_spring_slot before) {
    mspringi_spring_slot_copy(from, before, to, spring_slot);
    mspringi_store_copy_spring(to, spring_slot, from, before);
    if (to->strain.least)
        to->strain.least[spring_slot] = from->strain.least[before];
}

mspring_result mspringi_relayout_copy_springs(mspring_job *job, uint32_t first, uint32_t end) {
    for (mspring_id s = first; s < end; ++s) {
        const mspringi_spring_slot before = job->from.topology.slot_of_spring[s];
        job->new_slot[before] = job->to.topology.slot_of_spring[s];
        copy_spring(&job->to, job->new_slot[before], &job->from, before);
    }
    return MSPRING_OK;
}

// Copy springs that were set since the job began.
static void copy_changed(mspring_network *to, const mspring_network *from, const mspring_job *job) {
    const size_t words = mspringi_spring_slot_words(&from->topology);
    if (job->has_all_changed) {
        for (mspring_id s = 0; s < from->topology.spring_count; ++s)
            copy_spring(to, to->topology.slot_of_spring[s], from, from->topology.slot_of_spring[s]);
        return;
    }
    for (size_t word = 0; job->has_changed && word < words; ++word)
        for (uint32_t bit = 0; job->changed[word] >> bit != 0; ++bit)
            if (job->changed[word] >> bit & 1) {
                const mspringi_spring_slot before = (mspringi_spring_slot)(word * MSPRINGI_WIDTH + bit);
                copy_spring(to, job->new_slot[before], from, before);
            }
}

/* --------------------------------------------------------------------------------------------------- others */

mspring_result mspringi_relayout_reserve_others(mspring_job *job) {
    // Only the presence of the source's arrays matters here; their contents may be missing.
    if (!mspringi_store_match_layout(&job->to, &job->shape))
        return no_memory_to_move(&job->to);
    mspringi_store_move_slots(&job->to, &job->from); // inverse masses, to tell pinned particles
    return job->shape.guard_scratch ? mspringi_stability_limit_reserve(&job->to) : MSPRING_OK;
}

static mspring_result make_solver(mspring_job *job, mspringi_solver *made, const mspringi_job_solver *request) {
    bool is_done = !made->ops || !made->ops->build || !made->object;
    mspring_result result = MSPRING_OK;
    if (!made->object && made->ops && made->ops->create) {
        result = made->ops->create(&job->to, &request->def, request->tile_size, &made->object);
        is_done = !made->ops->build;
    } else if (!is_done) {
        result = made->ops->build(made->object, &is_done);
    }
    job->cursor.again = !is_done;
    return result;
}

mspring_result mspringi_relayout_make_solver(mspring_job *job) {
    return make_solver(job, &job->to.solver, &job->solvers[0]);
}

mspring_result mspringi_relayout_make_fallback(mspring_job *job) {
    return make_solver(job, &job->to.fallback, &job->solvers[1]);
}

// Adopt the solver that the job has made if it still fits; else make another.
static mspring_result adopt_solver(mspring_network *to, mspringi_solver *solver, const mspringi_solver *made,
                                   const mspringi_solver *had, uint32_t tile_size) {
    const mspringi_solver_ops *ops = had->ops;
    mspring_settings def;
    mspringi_solver unused = *made;
    *solver = (mspringi_solver){ops, NULL};
    if (ops && ops->create)
        ops->get_def(had->object, &def);
    if (made->object && made->ops == ops && (!ops->fits || ops->fits(made->object, &def))) {
        solver->object = made->object;
        if (ops->adjust)
            ops->adjust(solver->object, &def);
        return ops->reserve ? ops->reserve(solver->object, to) : MSPRING_OK;
    }
    if (made->object)
        mspringi_solver_destroy(&unused, &to->memory);
    return ops && ops->create ? mspringi_solver_make(solver, to, &def, tile_size) : MSPRING_OK;
}

// Make what the network has and the job has not made: recent or small things.
static mspring_result make_others(mspring_network *to, const mspring_network *from, mspring_job *job) {
    mspring_result result = MSPRING_OK;
    if (to->rest_lengths.shared_count > 0 && from->rest_lengths.shared_count == 0)
        result = mspringi_rest_lengths_unshare(to);
    if (result == MSPRING_OK)
        result = mspringi_limits_match_layout(to, from);
    if (result == MSPRING_OK && from->guard_scratch)
        result = mspringi_stability_limit_reserve(to);
    if (result == MSPRING_OK && !mspringi_store_match_layout(to, from))
        result = no_memory_to_move(to);
    if (result == MSPRING_OK)
        result = mspringi_carry_reserve(to);
#define MOVES(make, drop) result = result == MSPRING_OK ? make(to, from) : result;
#include "store/features.def"
    if (result == MSPRING_OK)
        copy_changed(to, from, job);
    return result;
}

/* ------------------------------------------------------------------------------------------------- the exchange */

static void move_values(const float *from, float *to, const mspring_network *old, const mspring_network *made) {
    const uint32_t *here = old->topology.slot_of_particle, *new_slot = made->topology.slot_of_particle;
    MSPRINGI_ASSERT(made->topology.particle_count == old->topology.particle_count);
    for (mspring_id p = 0; p < old->topology.particle_count; ++p)
        to[new_slot[p]] = from[here[p]];
}

// Free all arrays by slot or spring slot.
static void free_layout(mspring_network *network, mspringi_memory *memory) {
#define MOVES(make, drop) drop(network, memory);
#include "store/features.def"
    mspringi_store_free_layout(network, memory);
    mspringi_solver_destroy(&network->solver, memory);
    mspringi_solver_destroy(&network->fallback, memory);
}

mspring_network mspringi_relayout_copy_shell(const mspring_network *network) {
    mspring_network to = *network;
    mspringi_store_forget_layout(&to);
    to.topology = (mspringi_topology){0};
    to.halos = (mspringi_halos){0};
    to.rest_lengths = (mspringi_rest_lengths){0};
    to.sleep = (mspringi_sleep){0};
    to.solver.object = to.fallback.object = NULL;
    to.floor = NULL;
    to.job = NULL;
    return to;
}

// Network with the arrays by slot and spring slot that the job has made.
static mspring_network with_layout_of(const mspring_network *network, const mspring_network *made) {
    mspring_network to = mspringi_relayout_copy_shell(network);
    to.memory = made->memory;
    to.topology = made->topology;
    mspringi_store_take_layout(&to, made);
    to.shared_records.changes = made->shared_records.changes;
    to.shared_records.compared = made->shared_records.compared;
    to.tested.shared_records.changes = made->tested.shared_records.changes;
    to.tested.shared_records.compared = made->tested.shared_records.compared;
    to.rest_lengths = made->rest_lengths;
    to.halos = made->halos;
    to.carry_rows = made->carry_rows;
    to.depth = made->depth;
    return to;
}

static mspring_result fill(mspring_network *to, const mspring_network *network, mspring_job *job) {
    mspring_result result = make_others(to, network, job);
    if (result != MSPRING_OK)
        return result;
    mspringi_store_move_slots(to, network);
    if (network->guard_scratch)
        move_values(network->guard_scratch, to->guard_scratch, network, to);
    if (network->sleep.count > 0)
        mspringi_sleepers->move(to, network);
    result = adopt_solver(to, &to->solver, &job->to.solver, &network->solver, job->solvers[0].tile_size);
    if (result == MSPRING_OK)
        result = adopt_solver(to, &to->fallback, &job->to.fallback, &network->fallback, job->solvers[1].tile_size);
    return result;
}

mspring_result mspringi_relayout_network(mspring_network *network, mspring_job *job) {
    mspring_network to = with_layout_of(network, &job->to);
    mspring_result result = fill(&to, network, job);
    job->is_spent = true; // its results belong to `to`, or are freed with it
    job->to.memory = to.memory;
    if (result != MSPRING_OK) {
        job->to.message = to.message;
        return result;
    }
    mspringi_solver_take_over(&to, &to.solver, network, &network->solver);
    mspringi_solver_take_over(&to, &to.fallback, network, &network->fallback);
    mspringi_added_springs_reset(&to.added_springs);
    mspring_network old = *network;
    to.memory = old.memory;
    mspringi_memory_hand_over(&job->to.memory, &to.memory);
    *network = to;
    mspringi_notify_change(network, MSPRINGI_CHANGED_LAYOUT, 0);
    free_layout(&old, &network->memory);
    return MSPRING_OK;
}

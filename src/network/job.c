/// Job that computes a new layout of a network: begin, run, finish.
#include "network/job.h"

#include "base/cpu.h"
#include "network/compact.h"
#include "store/feature.h"
#include "store/springs.h"
#include "store/store.h"

mspring_result mspringi_job_no_memory(mspring_job *job) {
    return mspringi_fail(&job->to.message, MSPRING_ERROR_MEMORY, "no memory for another layout of %u springs",
                         (unsigned)job->from.topology.spring_count);
}

/* -------------------------------------------------------------------------------------------- edits meanwhile */

void mspringi_job_track(const mspring_network *network, mspringi_spring_slot spring_slot) {
    mspring_job *job = network->job;
    if (!job || !job->changed) // needless from the start (run also writes is_needless, on any thread)
        return;
    job->changed[spring_slot / MSPRINGI_WIDTH] |= (uint16_t)(1u << spring_slot % MSPRINGI_WIDTH);
    job->has_changed = true;
}

void mspringi_job_track_all(const mspring_network *network) {
    if (network->job)
        network->job->has_all_changed = true;
}

void mspringi_job_invalidate(mspring_network *network) {
    if (network->job)
        network->job->network = NULL;
    network->job = NULL;
}

// True if a spring is in the new layout or broken.
static bool has_spring(const mspring_job *job, const mspring_network *network, mspring_id spring) {
    const mspringi_topology *t = &job->to.topology;
    return !mspringi_spring_slot_is_inactive(t, mspringi_slot_of_spring(t, spring)) ||
           !mspringi_spring_is_live(network, spring);
}

// True if the new layout contains every live spring. It may contain springs that broke since.
static bool is_valid(const mspring_job *job, const mspring_network *network) {
    const mspringi_edits *edits = &network->edits;
    bool is_valid = job->growth == edits->growth;
    if (job->is_needless)
        return is_valid;
    if (!job->has_all_changed && mspringi_edits_have_link(edits, job->links)) {
        for (uint64_t n = job->links; is_valid && n < edits->links; ++n)
            is_valid = has_spring(job, network, mspringi_edits_link(edits, n));
        return is_valid;
    }
    for (mspring_id s = 0; is_valid && s < job->to.topology.spring_count; ++s)
        is_valid = has_spring(job, network, s);
    return is_valid;
}

/* ------------------------------------------------------------------------------------------------------- begin */

static bool copy_topologies(mspring_job *job, const mspring_network *network) {
    job->from.topology = network->topology;
    if (network->is_compact)
        job->initial = network->whole;
    return mspringi_array_table_duplicate(mspringi_topology_arrays, &job->from.topology, &job->memory) &&
           mspringi_array_table_duplicate(mspringi_topology_arrays, &job->initial, &job->memory);
}

// Copy the spring arrays and the live bits and, if a solver is to be built, masses, fractions and sides.
static bool copy_arrays(mspring_job *job, const mspring_network *network) {
    static const mspringi_group groups[] = {MSPRINGI_STORE_ROWS,   MSPRINGI_STORE_IRREGULAR, MSPRINGI_STORE_RESTS,
                                            MSPRINGI_STORE_STRAIN, MSPRINGI_STORE_STRESS,    MSPRINGI_STORE_RELAX,
                                            MSPRINGI_STORE_TESTED, MSPRINGI_STORE_MARKS,     MSPRINGI_STORE_ENDS,
                                            MSPRINGI_STORE_MASS,   MSPRINGI_STORE_FRACTIONS, MSPRINGI_STORE_SIDE};
    mspring_network *from = &job->from;
    const bool has_solver = network->solver.object || network->fallback.object;
    for (size_t i = 0; i < sizeof groups / sizeof groups[0] - (has_solver ? 0 : 3); ++i)
        if (!mspringi_store_duplicate(from, network, groups[i], &job->memory))
            return false;
    from->inverse_mass = has_solver ? mspringi_memory_duplicate(&job->memory, network->inverse_mass) : NULL;
    job->changed =
        mspringi_alloc(&job->memory, mspringi_spring_slot_words(&network->topology), sizeof *job->changed);
    return job->changed && (from->inverse_mass || !has_solver);
}

static void get_solver_def(mspringi_job_solver *request, const mspringi_solver *solver, uint32_t tile_size) {
    if (!solver->ops || !solver->ops->create)
        return;
    solver->ops->get_def(solver->object, &request->def);
    request->tile_size = tile_size;
}

// True if an earlier job found nothing to do, and no spring was edited since.
static bool is_seen_compact(const mspring_network *network) {
    return network->is_seen_compact && network->seen_links == network->edits.links &&
           network->seen_growth == network->edits.growth;
}

static bool copy_all(mspring_job *job, const mspring_network *network) {
    const bool is_whole = job->layout == MSPRING_LAYOUT_WHOLE;
    job->to = mspringi_relayout_copy_shell(network);
    job->to.memory = (mspringi_memory){.allocator = network->memory.allocator};
    job->to.tasks = NULL; // owned by the network; finish reserves what more workers need
    job->to.message = (mspringi_message){0};
    job->shape = *network;
    mspringi_store_forget(&job->to);
    mspringi_features_forget(&job->to);
    job->to.whole = (mspringi_topology){0};
    job->from = job->to;
    job->from.rest_lengths = network->rest_lengths;
    job->workers = mspringi_tasks_partition_size(network->tasks);
    job->links = network->edits.links;
    job->growth = network->edits.growth;
    job->is_needless = is_whole ? !network->is_compact : is_seen_compact(network);
    get_solver_def(&job->solvers[0], &network->solver, is_whole ? network->whole_tile_size : 0);
    get_solver_def(&job->solvers[1], &network->fallback, is_whole ? network->whole_fallback_size : 0);
    if (job->is_needless)
        return true;
    if (!copy_topologies(job, network) || !copy_arrays(job, network))
        return false;
    job->to.mass = job->from.mass;
    job->to.fractions = job->from.fractions;
    job->to.side = job->from.side;
    job->to.growth = job->from.growth;
    return true;
}

mspring_result mspringi_job_begin(mspring_network *network, mspring_layout layout, mspring_job **begun) {
    mspringi_memory memory = {.allocator = network->memory.allocator};
    mspring_job *job = mspringi_alloc(&memory, 1, sizeof *job);
    if (job) {
        job->memory = memory;
        job->layout = layout;
    }
    if (!job || !copy_all(job, network)) {
        if (job)
            mspringi_job_destroy(job);
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for another layout of %u springs",
                             (unsigned)network->topology.spring_count);
    }
    *begun = job;
    return MSPRING_OK;
}

/* --------------------------------------------------------------------------------------------------------- run */

static mspring_result take_whole(mspring_job *job) {
    job->to.topology = job->initial;
    job->fingerprint = job->from.whole_fingerprint;
    // Results belong to the memory of `to`, which is still empty.
    return mspringi_array_table_duplicate(mspringi_topology_arrays, &job->to.topology, &job->to.memory)
               ? MSPRING_OK
               : mspringi_job_no_memory(job);
}

static uint32_t springs_of(const mspring_job *job) {
    return job->from.topology.spring_count;
}

static uint32_t particles_of(const mspring_job *job) {
    return job->from.topology.particle_count;
}

static uint32_t rows_of(const mspring_job *job) {
    return mspringi_job_initial_topology(job)->lattice_rows;
}

MSPRINGI_PASSES(job, mspring_job)
#define MOVE                                                                                                       \
    MSPRINGI_ONCE(mspringi_relayout_begin),                                                                        \
        MSPRINGI_EACH(mspringi_relayout_compare_rest_lengths, springs_of, 16000),                                  \
        MSPRINGI_ONCE(mspringi_relayout_reserve_springs),                                                          \
        MSPRINGI_EACH(mspringi_relayout_copy_springs, springs_of, 16000),                                          \
        MSPRINGI_ONCE(mspringi_relayout_reserve_others), MSPRINGI_ONCE(mspringi_relayout_make_solver),             \
        MSPRINGI_ONCE(mspringi_relayout_make_fallback)

static const job_pass compact_passes[] = {
    MSPRINGI_ONCE(mspringi_survivors_begin),
    MSPRINGI_EACH(mspringi_survivors_count_live, springs_of, 64000),
    MSPRINGI_ONCE(mspringi_survivors_reserve),
    MSPRINGI_EACH(mspringi_survivors_place_on_diagonal, particles_of, 64000),
    MSPRINGI_EACH(mspringi_survivors_place_in_grids, rows_of, 64),
    MSPRINGI_EACH(mspringi_survivors_list, springs_of, 32000),
    MSPRINGI_ONCE(mspringi_survivors_begin_layout),
    MSPRINGI_ONCE(mspringi_survivors_lay_out),
    MSPRINGI_ONCE(mspringi_survivors_finish_layout),
    MSPRINGI_EACH(mspringi_survivors_number_spring_slots, springs_of, 64000),
    MSPRINGI_EACH(mspringi_survivors_save_ends, springs_of, 32000),
    MSPRINGI_ONCE(mspringi_survivors_assign_spare),
    MSPRINGI_EACH(mspringi_survivors_fingerprint_slots, particles_of, 64000),
    MSPRINGI_EACH(mspringi_survivors_fingerprint_spring_slots, springs_of, 64000),
    MOVE,
};

static const job_pass whole_passes[] = {MSPRINGI_ONCE(take_whole), MOVE};

static uint32_t pass_count(const mspring_job *job) {
    return job->layout == MSPRING_LAYOUT_WHOLE ? MSPRINGI_PASS_COUNT(whole_passes)
                                               : MSPRINGI_PASS_COUNT(compact_passes);
}

uint32_t mspringi_job_left(const mspring_job *job) {
    return job->is_needless ? 0 : pass_count(job) - job->cursor.pass;
}

MSPRINGI_NOINLINE mspring_result mspringi_job_run(mspring_job *job, uint32_t at_most) {
    const job_pass *list = job->layout == MSPRING_LAYOUT_WHOLE ? whole_passes : compact_passes;
    mspring_result result = MSPRING_OK;
    for (uint32_t n = 0; result == MSPRING_OK && mspringi_job_left(job) > 0 && (at_most == 0 || n < at_most); ++n)
        result = job_run(job, list, &job->cursor);
    job->is_spent = result != MSPRING_OK;
    job->failure = result;
    return result;
}

/* ------------------------------------------------------------------------------------------------------ finish */

// Move the network. Keep its initial layout, free any other old one.
static mspring_result exchange(mspring_network *network, mspring_job *job) {
    const bool was_compact = network->is_compact, is_whole = job->layout == MSPRING_LAYOUT_WHOLE;
    const uint64_t fingerprint = network->topology_fingerprint;
    const uint32_t tile_size = mspringi_solver_get_basis(&network->solver).tile_size;
    const uint32_t fallback_size = mspringi_solver_get_basis(&network->fallback).tile_size;
    mspringi_topology before = network->topology, whole = network->whole;
    mspring_result result = mspringi_relayout_network(network, job);
    if (result != MSPRING_OK)
        return result;
    network->topology_fingerprint = job->fingerprint;
    network->is_compact = !is_whole;
    network->is_seen_compact = false;
    if (was_compact) {
        mspringi_topology_destroy(&before, &network->memory);
    } else {
        network->whole = before;
        network->whole_fingerprint = fingerprint;
        network->whole_tile_size = tile_size;
        network->whole_fallback_size = fallback_size;
    }
    if (is_whole) {
        mspringi_topology_destroy(&whole, &network->memory);
        network->whole = (mspringi_topology){0};
    }
    return MSPRING_OK;
}

mspring_result mspringi_job_finish(mspring_network *network, mspring_job *job) {
    job->is_spent = true;
    if (!is_valid(job, network)) {
        return mspringi_fail(&network->message, MSPRING_ERROR_OUTDATED,
                             "particles or springs were added, removed or restored since the job began");
    }
    if (job->is_needless) {
        if (job->layout == MSPRING_LAYOUT_COMPACT) {
            network->is_seen_compact = job->links == network->edits.links;
            network->seen_links = network->edits.links;
            network->seen_growth = network->edits.growth;
        }
        return MSPRING_OK;
    }
    network->memory.bin = &job->memory; // freeing the factor of a direct solver takes milliseconds
    mspring_result result = exchange(network, job);
    network->memory.bin = NULL;
    if (result != MSPRING_OK)
        network->message = job->to.message;
    return result;
}

void mspringi_job_destroy(mspring_job *job) {
    if (!job)
        return;
    if (job->network)
        job->network->job = NULL;
    mspringi_memory memory = job->memory, made = job->to.memory;
    mspringi_free_all(&made);
    mspringi_free_all(&memory);
}

/* ----------------------------------------------------------------------------------------------------- at once */

// Begin, run and finish a job at once. A job in progress depends on the old layout, and is lost.
static mspring_result change_layout(mspring_network *network, mspring_layout layout) {
    mspring_job *job = NULL;
    mspring_result result = mspringi_job_begin(network, layout, &job);
    if (result != MSPRING_OK)
        return result;
    result = mspringi_job_run(job, 0);
    if (result != MSPRING_OK)
        network->message = job->to.message;
    else if (!job->is_needless)
        mspringi_job_invalidate(network);
    if (result == MSPRING_OK)
        result = mspringi_job_finish(network, job);
    mspringi_job_destroy(job);
    return result;
}

mspring_result mspringi_expand(mspring_network *network) {
    const mspringi_fp_state before = mspringi_fp_enter();
    mspring_result result = change_layout(network, MSPRING_LAYOUT_WHOLE);
    mspringi_fp_leave(before);
    return result;
}

mspring_result mspring_network_compact(mspring_network *network) {
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    result = change_layout(network, MSPRING_LAYOUT_COMPACT);
    mspringi_fp_leave(before);
    return result;
}

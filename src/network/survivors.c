/// Survivors: topology of the live springs.
///
/// The initial layout of a network contains all springs, and sweeps those that break, too. This one contains only
/// live springs: lattices of surviving squares, chains, the irregular part between them, and loose particles.
/// Broken springs become inactive: they keep a spring slot and a record, so that queries and edits still work, but
/// are not swept.
///
/// The search for grids uses rows and columns of the initial layout as positions, since present positions mean
/// nothing.
#include "network/job.h"

#include "base/hash.h"
#include "layout/emit/spare.h"
#include "store/springs.h"

/* --------------------------------------------------------------------------------------------- what is left */

mspring_result mspringi_survivors_begin(mspring_job *job) {
    const uint32_t springs = job->from.topology.spring_count;
    job->was_live = mspringi_alloc(&job->memory, ((size_t)springs + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH,
                                   sizeof *job->was_live);
    return job->was_live ? MSPRING_OK : mspringi_job_no_memory(job);
}

mspring_result mspringi_survivors_count_live(mspring_job *job, uint32_t first, uint32_t end) {
    const mspringi_topology *t = &job->from.topology;
    for (mspring_id s = first; s < end; ++s) {
        const mspringi_spring_slot spring_slot = t->slot_of_spring[s];
        const bool is_live = mspringi_spring_slot_is_live(&job->from, spring_slot);
        job->was_live[s / MSPRINGI_WIDTH] |= (uint16_t)(is_live << s % MSPRINGI_WIDTH);
        job->live += is_live;
        job->has_work = job->has_work || is_live != mspringi_spring_slot_is_laid_out(t, spring_slot);
    }
    return MSPRING_OK;
}

mspring_result mspringi_survivors_reserve(mspring_job *job) {
    job->is_needless = !job->has_work;
    if (job->is_needless)
        return MSPRING_OK;
    const uint32_t particles = job->from.topology.particle_count;
    struct mspring_builder *left = &job->left;
    left->particles = mspringi_alloc(&job->memory, particles, sizeof *left->particles);
    left->springs = mspringi_alloc(&job->memory, job->live, sizeof *left->springs);
    job->ids = mspringi_alloc(&job->memory, job->live, sizeof *job->ids);
    left->particle_count = particles;
    left->spring_count = job->live;
    return left->particles && left->springs && job->ids ? MSPRING_OK : mspringi_job_no_memory(job);
}

// Positions for the search. Grids lie one above the other, far enough apart to stay separate. All other particles
// lie on a diagonal on the other side, in the order of their slots. No two of them are neighbours in a grid.

mspring_result mspringi_survivors_place_on_diagonal(mspring_job *job, uint32_t first, uint32_t end) {
    const mspringi_topology *initial = mspringi_job_initial_topology(job);
    mspringi_particle *particles = job->left.particles;
    for (mspring_id p = first; p < end; ++p) {
        particles[p].x = particles[p].y = -10.0 - 3.0 * (double)initial->slot_of_particle[p];
        if (!mspringi_particle_exists(&job->from, p))
            particles[p].flags = MSPRINGI_PARTICLE_ABSENT;
    }
    return MSPRING_OK;
}

mspring_result mspringi_survivors_place_in_grids(mspring_job *job, uint32_t first, uint32_t end) {
    const mspringi_topology *t = mspringi_job_initial_topology(job);
    mspringi_particle *particles = job->left.particles;
    for (uint32_t i = first; i < end; ++i) {
        const mspringi_row *row = &t->rows[i];
        for (const mspringi_span *span = t->spans + row->first_span;
             span < t->spans + row->first_span + row->span_count; ++span) {
            for (uint32_t slot = span->first_slot; slot < span->end_slot; ++slot) {
                const mspring_id p = t->particle_of_slot[slot];
                if (p == MSPRING_NONE)
                    continue;
                particles[p].x = (double)((int64_t)slot + span->carry);
                particles[p].y = (double)i + 2.0 * (double)t->grid_of_row[i];
            }
        }
    }
    return MSPRING_OK;
}

mspring_result mspringi_survivors_list(mspring_job *job, uint32_t first, uint32_t end) {
    const mspringi_topology *t = mspringi_job_initial_topology(job);
    for (mspring_id s = first; s < end; ++s) {
        const mspringi_spring_slot spring_slot = t->slot_of_spring[s];
        uint32_t base, tip;
        if (!(job->was_live[s / MSPRINGI_WIDTH] >> s % MSPRINGI_WIDTH & 1))
            continue;
        mspringi_topology_ends(t, spring_slot, &base, &tip);
        job->ids[job->listed] = s;
        job->left.springs[job->listed++] = (mspringi_spring){
            .a = t->particle_of_slot[base],
            .b = t->particle_of_slot[tip],
            .flags =
                t->parallel_count > 0 ? MSPRINGI_ONE_WAY_FLAGS : 0, // all may be parallel: the builder was checked
        };
    }
    return MSPRING_OK;
}

// Bundles suit the explicit solver only. The implicit one takes irregular springs one by one, and so takes twice as
// long for a wreck that is mostly bundles.
mspring_result mspringi_survivors_begin_layout(mspring_job *job) {
    const mspringi_topology *t = mspringi_job_initial_topology(job);
    return mspringi_topology_begin(&job->left, &t->reserve, t->parallel_count == 0,
                                   job->from.solver.ops->has_bundles, job->workers, job->from.kernels->lanes,
                                   &job->to.memory, &job->to.message, &job->layout_builder);
}

mspring_result mspringi_survivors_lay_out(mspring_job *job) {
    bool is_done;
    mspring_result result = mspringi_topology_run(job->layout_builder, &is_done);
    job->cursor.again = !is_done;
    return result;
}

/* ----------------------------------------------------------------------------------------- inactive springs */

// Number of live springs that are not spare.
static uint32_t count_laid_out(const mspring_job *job, uint32_t first_spare) {
    uint32_t low = 0, high = (uint32_t)job->left.spring_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (job->ids[middle] < first_spare)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

mspring_result mspringi_survivors_finish_layout(mspring_job *job) {
    mspringi_topology *t = &job->to.topology;
    mspringi_topology_finish(job->layout_builder, &job->to.memory, t);
    job->layout_builder = NULL;
    job->laid_out_spring_slots = t->slot_of_spring;
    const uint32_t inactive = t->reserve.first_spring - count_laid_out(job, t->reserve.first_spring);
    t->slot_of_spring = mspringi_alloc(&job->to.memory, t->reserve.spring_end, sizeof *t->slot_of_spring);
    if (!t->slot_of_spring)
        return mspringi_job_no_memory(job);
    t->spring_count = mspringi_job_initial_topology(job)->spring_count;
    job->next_inactive = t->row_spring_slots + t->laid_out_count + mspringi_spare_springs(t);
    job->listed = 0;
    mspring_result result = mspringi_spare_reserve(t, inactive, &job->to.memory, &job->to.message);
    if (result == MSPRING_OK)
        mspringi_spare_set_entries(t);
    return result;
}

// Number the springs outside the layout after those in it. Spare springs get their reserved slots, broken ones the
// slots behind.
mspring_result mspringi_survivors_number_spring_slots(mspring_job *job, uint32_t first, uint32_t end) {
    const mspringi_topology *t = &job->to.topology;
    for (mspring_id s = first; s < end; ++s) {
        if (job->was_live[s / MSPRINGI_WIDTH] >> s % MSPRINGI_WIDTH & 1)
            t->slot_of_spring[s] = job->laid_out_spring_slots[job->listed++];
        else
            t->slot_of_spring[s] =
                s < t->reserve.first_spring ? job->next_inactive++ : mspringi_spare_spring_slot(t, s);
    }
    return MSPRING_OK;
}

// Save the ends of springs outside the layout. Removed springs may have any ends, as their particles may be gone,
// too.
mspring_result mspringi_survivors_save_ends(mspring_job *job, uint32_t first, uint32_t end) {
    const mspringi_topology *initial = mspringi_job_initial_topology(job);
    mspringi_topology *t = &job->to.topology;
    for (mspring_id s = first; s < end; ++s) {
        const mspringi_spring_slot initial_spring_slot = initial->slot_of_spring[s],
                                   spring_slot = t->slot_of_spring[s];
        uint32_t base, tip;
        if (mspringi_spring_slot_is_laid_out(t, spring_slot) || !mspringi_spring_exists(&job->from, s))
            continue;
        mspringi_topology_ends(initial, initial_spring_slot, &base, &tip);
        mspringi_topology_set_ends(t, spring_slot, t->slot_of_particle[initial->particle_of_slot[base]],
                                   t->slot_of_particle[initial->particle_of_slot[tip]]);
    }
    return MSPRING_OK;
}

mspring_result mspringi_survivors_assign_spare(mspring_job *job) {
    mspringi_free(&job->to.memory, job->laid_out_spring_slots);
    job->laid_out_spring_slots = NULL;
    mspringi_topology *t = &job->to.topology;
    mspring_result result = mspringi_spare_assign_slots(t, &job->to.memory, &job->to.message);
    if (result == MSPRING_OK)
        mspringi_spare_set_counts(t, t->particle_count, t->spring_count);
    job->fingerprint = job->from.is_compact ? job->from.whole_fingerprint : job->from.topology_fingerprint;
    return result;
}

/* --------------------------------------------------------------------------------------------- fingerprint */

mspring_result mspringi_survivors_fingerprint_slots(mspring_job *job, uint32_t first, uint32_t end) {
    const mspringi_topology *t = &job->to.topology;
    for (mspring_id p = first; p < end; ++p)
        job->fingerprint = mspringi_hash(job->fingerprint, t->slot_of_particle[p]);
    return MSPRING_OK;
}

mspring_result mspringi_survivors_fingerprint_spring_slots(mspring_job *job, uint32_t first, uint32_t end) {
    for (mspring_id s = first; s < end; ++s)
        job->fingerprint = mspringi_hash(job->fingerprint, job->to.topology.slot_of_spring[s]);
    return MSPRING_OK;
}

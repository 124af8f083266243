/// A topology of the springs that are left.
#include "replan.h"

#include "network/springs.h"
#include "topology/spare.h"

#include "base/mix.h"
#include "base/pace.h"
#include "move.h"

struct mspringi_replan {
    mspringi_pace pace;
    uint64_t spent;         ///< effort so far
    uint64_t links, growth; ///< edits.links and edits.growth when the replan was begun
    bool has_work;          ///< some spring that is swept is broken, or one was added that the plan does not know
    uint16_t *was_live;     ///< [springs / 16] a bit for each spring
    struct mspring_builder left; ///< particles in the first topology's rows and columns, live springs
    mspring_id *ids;             ///< [left.spring_count] of the live springs, rising
    uint32_t live, listed;       ///< of these counted, and listed so far
    uint32_t slot;               ///< in the lattice row that is gone through
    mspringi_assembly *assembly;
    mspringi_topology topology;   ///< once the assembly has made it
    mspringi_place *woven_places; ///< [left.spring_count] of the live springs
    mspringi_place next_parked;
    uint64_t print; ///< of the plan, so far
};

// The topology that the network was created with.
static const mspringi_topology *first_topology(const mspring_network *network) {
    return network->is_compact ? &network->whole : &network->topology;
}

static mspring_result out_of_memory(mspring_network *network) {
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for another plan of %u springs",
                         (unsigned)network->topology.spring_count);
}

/* --------------------------------------------------------------------------------------------- what is left */

static mspring_result begin(mspringi_replan *r, mspring_network *network) {
    const uint32_t springs = network->topology.spring_count;
    r->was_live = mspringi_pace_alloc(&r->pace, &network->plan_memory,
                                      ((size_t)springs + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH, sizeof *r->was_live);
    return r->was_live ? MSPRING_OK : out_of_memory(network);
}

static mspring_result look_for_live(mspringi_replan *r, mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    uint32_t first, end;
    mspringi_pace_take(&r->pace, t->spring_count, 2, &first, &end);
    for (mspring_id s = first; s < end; ++s) {
        const mspringi_place place = t->place_of_spring[s];
        const bool is_live = mspringi_place_is_live(network, place);
        r->was_live[s / MSPRINGI_WIDTH] |= (uint16_t)(is_live << s % MSPRINGI_WIDTH);
        r->live += is_live;
        r->has_work = r->has_work || is_live != mspringi_place_is_woven(t, place);
    }
    return MSPRING_OK;
}

static mspring_result reserve_lists(mspringi_replan *r, mspring_network *network) {
    const uint32_t particles = network->topology.particle_count;
    struct mspring_builder *left = &r->left;
    left->particles = mspringi_pace_alloc(&r->pace, &network->plan_memory, particles, sizeof *left->particles);
    left->springs = mspringi_pace_alloc(&r->pace, &network->plan_memory, r->live, sizeof *left->springs);
    r->ids = mspringi_pace_alloc(&r->pace, &network->plan_memory, r->live, sizeof *r->ids);
    left->particle_count = particles;
    left->spring_count = r->live;
    return left->particles && left->springs && r->ids ? MSPRING_OK : out_of_memory(network);
}

// Where a particle is in its grid: grids lie one above the other, too far apart to be taken for one. Particles
// of no grid lie on a diagonal on the other side, where no two can be taken for neighbours on a grid, in the order
// in which they lie in memory.

static mspring_result place_on_diagonal(mspringi_replan *r, mspring_network *network) {
    const mspringi_topology *first_one = first_topology(network);
    mspringi_particle *particles = r->left.particles;
    uint32_t first, end;
    mspringi_pace_take(&r->pace, (uint32_t)r->left.particle_count, 2, &first, &end);
    for (mspring_id p = first; p < end; ++p) {
        particles[p].x = particles[p].y = -10.0 - 3.0 * (double)first_one->slot_of_particle[p];
        if (!mspringi_particle_exists(network, p))
            particles[p].flags = MSPRINGI_PARTICLE_ABSENT;
    }
    return MSPRING_OK;
}

static mspring_result place_in_grids(mspringi_replan *r, mspring_network *network) {
    const mspringi_topology *t = first_topology(network);
    mspringi_particle *particles = r->left.particles;
    uint32_t i = r->pace.at;
    for (; i < t->lattice_rows && r->pace.left > 0; ++i) {
        const mspringi_row *row = &t->rows[i];
        for (const mspringi_span *span = t->spans + row->first_span;
             span < t->spans + row->first_span + row->span_count; ++span) {
            mspringi_pace_spend(&r->pace, (uint64_t)2 * (span->end_slot - span->first_slot));
            for (uint32_t slot = span->first_slot; slot < span->end_slot; ++slot) {
                const mspring_id p = t->particle_of_slot[slot];
                if (p == MSPRING_NONE)
                    continue;
                particles[p].x = (double)((int64_t)slot + span->carry);
                particles[p].y = (double)i + 2.0 * (double)t->grid_of_row[i];
            }
        }
    }
    r->pace.at = i;
    r->pace.is_halfway = i < t->lattice_rows;
    return MSPRING_OK;
}

static mspring_result list_springs(mspringi_replan *r, mspring_network *network) {
    const mspringi_topology *t = first_topology(network);
    uint32_t first, end;
    mspringi_pace_take(&r->pace, t->spring_count, 3, &first, &end);
    for (mspring_id s = first; s < end; ++s) {
        const mspringi_place place = t->place_of_spring[s];
        uint32_t base, tip;
        if (!(r->was_live[s / MSPRINGI_WIDTH] >> s % MSPRINGI_WIDTH & 1))
            continue;
        mspringi_topology_ends(t, place, &base, &tip);
        r->ids[r->listed] = s;
        r->left.springs[r->listed++] =
            (mspringi_spring){.a = t->particle_of_slot[base], .b = t->particle_of_slot[tip]};
    }
    return MSPRING_OK;
}

// Herds are for the explicit solver: the implicit one takes the springs of the web one by one, and twice as long
// for a wreck that mostly stands in such.
static mspring_result begin_layout(mspringi_replan *r, mspring_network *network) {
    const bool has_herds = network->solver.ops->has_herds;
    return mspringi_topology_begin(&r->left, &first_topology(network)->reserve, true, has_herds,
                                   mspringi_tasks_concurrency(network->tasks), network->kernels->lanes,
                                   &network->plan_memory, &network->message, &r->assembly);
}

static mspring_result lay_out(mspringi_replan *r, mspring_network *network) {
    bool is_done;
    (void)network;
    mspring_result result = mspringi_topology_go_on(r->assembly, &r->pace.left, &is_done);
    r->pace.is_halfway = !is_done;
    return result;
}

/* ------------------------------------------------------------------------------------------------- parking */

// How many of the live springs are not spare ones.
static uint32_t count_woven(const mspringi_replan *r, uint32_t first_spare) {
    uint32_t low = 0, high = (uint32_t)r->left.spring_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (r->ids[middle] < first_spare)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static mspring_result finish_layout(mspringi_replan *r, mspring_network *network) {
    mspringi_topology *t = &r->topology;
    mspringi_topology_finish(r->assembly, &network->plan_memory, t);
    r->assembly = NULL;
    r->woven_places = t->place_of_spring;
    const uint32_t parked = t->reserve.first_spring - count_woven(r, t->reserve.first_spring);
    t->place_of_spring =
        mspringi_pace_alloc(&r->pace, &network->plan_memory, t->reserve.spring_end, sizeof *t->place_of_spring);
    if (!t->place_of_spring)
        return out_of_memory(network);
    t->spring_count = first_topology(network)->spring_count;
    mspringi_pace_spend(&r->pace, ((uint64_t)t->woven_count + parked) * 16 / MSPRINGI_PACE_BYTES);
    r->next_parked = t->chain_places + t->woven_count + mspringi_spare_springs(t);
    r->listed = 0;
    return mspringi_spare_reserve(t, parked, &network->plan_memory, &network->message);
}

// Give the springs that are not left places behind those that are: spare ones those that are kept for them, the
// others behind these.
static mspring_result number_places(mspringi_replan *r, mspring_network *network) {
    const mspringi_topology *t = &r->topology;
    uint32_t first, end;
    (void)network;
    mspringi_pace_take(&r->pace, t->spring_count, 1, &first, &end);
    for (mspring_id s = first; s < end; ++s) {
        if (r->was_live[s / MSPRINGI_WIDTH] >> s % MSPRINGI_WIDTH & 1)
            t->place_of_spring[s] = r->woven_places[r->listed++];
        else
            t->place_of_spring[s] = s < t->reserve.first_spring ? r->next_parked++ : mspringi_spare_place(t, s);
    }
    return MSPRING_OK;
}

static mspring_result enter_spare(mspringi_replan *r, mspring_network *network) {
    (void)network;
    mspringi_spare_enter(&r->topology, &r->pace);
    return MSPRING_OK;
}

// Write down what springs outside of the plan join. Those that have been removed keep whatever ends: their
// particles may be gone, too.
static mspring_result note_ends(mspringi_replan *r, mspring_network *network) {
    const mspringi_topology *first_one = first_topology(network);
    mspringi_topology *t = &r->topology;
    uint32_t first, end;
    mspringi_pace_take(&r->pace, t->spring_count, 4, &first, &end);
    for (mspring_id s = first; s < end; ++s) {
        const mspringi_place first_place = first_one->place_of_spring[s], place = t->place_of_spring[s];
        uint32_t base, tip;
        if (mspringi_place_is_woven(t, place) || !mspringi_spring_exists(network, s))
            continue;
        mspringi_topology_ends(first_one, first_place, &base, &tip);
        t->leftover_a[place - t->chain_places] = t->slot_of_particle[first_one->particle_of_slot[base]];
        t->leftover_b[place - t->chain_places] = t->slot_of_particle[first_one->particle_of_slot[tip]];
    }
    return MSPRING_OK;
}

static mspring_result keep_spare(mspringi_replan *r, mspring_network *network) {
    mspringi_topology *t = &r->topology;
    mspring_result result = mspringi_spare_keep(t, &network->plan_memory, &network->message);
    if (result == MSPRING_OK)
        mspringi_spare_count(t, t->particle_count, t->spring_count);
    r->print = network->is_compact ? network->whole_print : network->topology_print;
    return result;
}

/* ------------------------------------------------------------------------------------------------- the print */

static mspring_result print_slots(mspringi_replan *r, mspring_network *network) {
    const mspringi_topology *t = &r->topology;
    uint32_t first, end;
    (void)network;
    mspringi_pace_take(&r->pace, t->particle_count, 1, &first, &end);
    for (mspring_id p = first; p < end; ++p)
        r->print = mspringi_mix(r->print, t->slot_of_particle[p]);
    return MSPRING_OK;
}

static mspring_result print_places(mspringi_replan *r, mspring_network *network) {
    uint32_t first, end;
    (void)network;
    mspringi_pace_take(&r->pace, r->topology.spring_count, 1, &first, &end);
    for (mspring_id s = first; s < end; ++s)
        r->print = mspringi_mix(r->print, r->topology.place_of_spring[s]);
    return MSPRING_OK;
}

/* ---------------------------------------------------------------------------------------------- the springs */

static mspring_result begin_move(mspringi_replan *r, mspring_network *network) {
    return mspringi_mover_begin(network, &r->topology, &r->pace);
}

static mspring_result reserve_move(mspringi_replan *r, mspring_network *network) {
    return mspringi_mover_reserve(network, &r->pace);
}

static mspring_result note_rests(mspringi_replan *r, mspring_network *network) {
    mspringi_mover_note_rests(network, r->ids, r->woven_places, r->live, &r->pace);
    return MSPRING_OK;
}

static mspring_result reserve_rests(mspringi_replan *r, mspring_network *network) {
    (void)r;
    return mspringi_mover_reserve_rests(network);
}

static mspring_result reserve_strain(mspringi_replan *r, mspring_network *network) {
    return mspringi_mover_reserve_strain(network, &r->pace);
}

static mspring_result copy_springs(mspringi_replan *r, mspring_network *network) {
    mspringi_mover_copy(network, r->topology.place_of_spring, &r->pace);
    return MSPRING_OK;
}

// Only the springs' places are needed still, should the copying begin anew, and how many are live.
static mspring_result free_lists(mspringi_replan *r, mspring_network *network) {
    mspringi_free(&network->plan_memory, r->was_live);
    mspringi_free(&network->plan_memory, r->left.particles);
    mspringi_free(&network->plan_memory, r->left.springs);
    r->was_live = NULL;
    r->left.particles = NULL;
    r->left.springs = NULL;
    r->pace.left = 0;
    return MSPRING_OK;
}

/* ---------------------------------------------------------------------------------------------- piece by piece */

static mspring_result (*const replan_passes[])(mspringi_replan *, mspring_network *) = {
    begin,        look_for_live, reserve_lists,  place_on_diagonal, place_in_grids, list_springs,
    begin_layout, lay_out,       finish_layout,  number_places,     enter_spare,    note_ends,
    keep_spare,   print_slots,   print_places,   free_lists,        begin_move,     reserve_move,
    note_rests,   reserve_rests, reserve_strain, copy_springs,
};

#define REPLAN_PASSES (sizeof replan_passes / sizeof replan_passes[0])
#define PASS_AFTER_LOOK 2u
#define MOVE_PASSES 6u

mspring_result mspringi_replan_begin(mspring_network *network, mspringi_replan **begun) {
    mspringi_replan *replan = mspringi_alloc(&network->plan_memory, 1, sizeof *replan);
    if (!replan)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for another plan");
    replan->links = network->edits.links;
    replan->growth = network->edits.growth;
    *begun = replan;
    return MSPRING_OK;
}

mspring_result mspringi_replan_go_on(mspringi_replan *r, mspring_network *network, uint32_t *effort) {
    mspringi_pace *pace = &r->pace;
    mspring_result result = MSPRING_OK;
    pace->left = *effort;
    if (pace->pass > REPLAN_PASSES - MOVE_PASSES && !network->mover) { // it was dropped
        pace->pass = (uint32_t)REPLAN_PASSES - MOVE_PASSES;
        pace->at = 0;
    }
    while (result == MSPRING_OK && !mspringi_replan_is_done(r) && pace->left > 0) {
        pace->is_halfway = false;
        result = replan_passes[pace->pass](r, network);
        if (pace->is_halfway)
            continue;
        pace->pass++;
        pace->at = 0;
    }
    r->spent += *effort - pace->left;
    *effort = pace->left;
    return result;
}

bool mspringi_replan_is_needless(const mspringi_replan *replan) {
    return replan->pace.pass == PASS_AFTER_LOOK && !replan->has_work;
}

bool mspringi_replan_is_done(const mspringi_replan *replan) {
    return replan->pace.pass == REPLAN_PASSES || mspringi_replan_is_needless(replan);
}

// So much takes a particle, a live spring and any spring, about.
uint64_t mspringi_replan_left(const mspringi_replan *replan, const mspring_network *network) {
    const uint64_t springs = network->topology.spring_count;
    const uint64_t live = replan->pace.pass < PASS_AFTER_LOOK ? springs : replan->live;
    const uint64_t all = 60 * (uint64_t)network->topology.particle_count + 80 * live + 12 * springs;
    return all > replan->spent ? all - replan->spent : 0;
}

bool mspringi_replan_is_outdated(const mspringi_replan *replan, const mspring_network *network) {
    return replan->growth != network->edits.growth;
}

bool mspringi_replan_is_current(const mspringi_replan *replan, const mspring_network *network) {
    return replan->links == network->edits.links;
}

// Whether a spring that is live is in the plan.
static bool fits(const mspringi_replan *replan, const mspring_network *network, mspring_id spring) {
    const mspringi_topology *t = &replan->topology;
    return !mspringi_place_is_parked(t, mspringi_place_of(t, spring)) || !mspringi_spring_is_live(network, spring);
}

bool mspringi_replan_is_valid(const mspringi_replan *replan, const mspring_network *network) {
    const mspringi_edits *edits = &network->edits;
    bool is_valid = true;
    if (mspringi_edits_have_link(edits, replan->links)) {
        for (uint64_t n = replan->links; is_valid && n < edits->links; ++n)
            is_valid = fits(replan, network, mspringi_edits_link(edits, n));
        return is_valid;
    }
    for (mspring_id s = 0; is_valid && s < replan->topology.spring_count; ++s)
        is_valid = fits(replan, network, s);
    return is_valid;
}

void mspringi_replan_take(mspringi_replan *replan, mspring_network *network, mspringi_topology *topology,
                          uint64_t *print) {
    *topology = replan->topology;
    *print = replan->print;
    void *const blocks[] = {replan->was_live, replan->left.particles, replan->left.springs,
                            replan->ids,      replan->woven_places,   replan};
    for (size_t i = 0; i < sizeof blocks / sizeof blocks[0]; ++i)
        mspringi_free(&network->plan_memory, blocks[i]);
    mspringi_memory_hand_over(&network->plan_memory, &network->memory);
}

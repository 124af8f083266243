/// A topology of the springs that are left.
#include "replan.h"

#include "network/springs.h"
#include "topology/spare.h"

#include "base/mix.h"
#include "move.h"

struct mspringi_replan {
    uint32_t pass, at;      ///< of replan_passes, the one that is under way, and how far it has come
    uint64_t links, growth; ///< edits.links and edits.growth when the replan was begun
    bool has_work;          ///< some spring that is swept is broken, or one was added that the plan does not know
    uint16_t *was_live;     ///< [springs / 16] a bit for each spring
    struct mspring_builder left; ///< particles in the first topology's rows and columns, live springs
    mspring_id *ids;             ///< [left.spring_count] of the live springs, rising
    uint32_t live, listed;       ///< of these counted, and listed so far
    mspringi_assembly *assembly;
    bool is_halfway;              ///< it
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
    r->was_live = mspringi_alloc(&network->plan_memory, ((size_t)springs + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH,
                                 sizeof *r->was_live);
    return r->was_live ? MSPRING_OK : out_of_memory(network);
}

static mspring_result look_for_live(mspringi_replan *r, mspring_network *network, uint32_t first, uint32_t end) {
    const mspringi_topology *t = &network->topology;
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
    left->particles = mspringi_alloc(&network->plan_memory, particles, sizeof *left->particles);
    left->springs = mspringi_alloc(&network->plan_memory, r->live, sizeof *left->springs);
    r->ids = mspringi_alloc(&network->plan_memory, r->live, sizeof *r->ids);
    left->particle_count = particles;
    left->spring_count = r->live;
    return left->particles && left->springs && r->ids ? MSPRING_OK : out_of_memory(network);
}

// Where a particle is in its grid: grids lie one above the other, too far apart to be taken for one. Particles
// of no grid lie on a diagonal on the other side, where no two can be taken for neighbours on a grid, in the order
// in which they lie in memory.

static mspring_result place_on_diagonal(mspringi_replan *r, mspring_network *network, uint32_t first,
                                        uint32_t end) {
    const mspringi_topology *first_one = first_topology(network);
    mspringi_particle *particles = r->left.particles;
    for (mspring_id p = first; p < end; ++p) {
        particles[p].x = particles[p].y = -10.0 - 3.0 * (double)first_one->slot_of_particle[p];
        if (!mspringi_particle_exists(network, p))
            particles[p].flags = MSPRINGI_PARTICLE_ABSENT;
    }
    return MSPRING_OK;
}

static mspring_result place_in_grids(mspringi_replan *r, mspring_network *network, uint32_t first, uint32_t end) {
    const mspringi_topology *t = first_topology(network);
    mspringi_particle *particles = r->left.particles;
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

static mspring_result list_springs(mspringi_replan *r, mspring_network *network, uint32_t first, uint32_t end) {
    const mspringi_topology *t = first_topology(network);
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
    mspring_result result = mspringi_topology_run(r->assembly, &is_done);
    r->is_halfway = !is_done;
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
    t->place_of_spring = mspringi_alloc(&network->plan_memory, t->reserve.spring_end, sizeof *t->place_of_spring);
    if (!t->place_of_spring)
        return out_of_memory(network);
    t->spring_count = first_topology(network)->spring_count;
    r->next_parked = t->chain_places + t->woven_count + mspringi_spare_springs(t);
    r->listed = 0;
    return mspringi_spare_reserve(t, parked, &network->plan_memory, &network->message);
}

// Give the springs that are not left places behind those that are: spare ones those that are kept for them, the
// others behind these.
static mspring_result number_places(mspringi_replan *r, mspring_network *network, uint32_t first, uint32_t end) {
    const mspringi_topology *t = &r->topology;
    (void)network;
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
    mspringi_spare_enter(&r->topology);
    return MSPRING_OK;
}

// Write down what springs outside of the plan join. Those that have been removed keep whatever ends: their
// particles may be gone, too.
static mspring_result note_ends(mspringi_replan *r, mspring_network *network, uint32_t first, uint32_t end) {
    const mspringi_topology *first_one = first_topology(network);
    mspringi_topology *t = &r->topology;
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

static mspring_result print_slots(mspringi_replan *r, mspring_network *network, uint32_t first, uint32_t end) {
    const mspringi_topology *t = &r->topology;
    (void)network;
    for (mspring_id p = first; p < end; ++p)
        r->print = mspringi_mix(r->print, t->slot_of_particle[p]);
    return MSPRING_OK;
}

static mspring_result print_places(mspringi_replan *r, mspring_network *network, uint32_t first, uint32_t end) {
    (void)network;
    for (mspring_id s = first; s < end; ++s)
        r->print = mspringi_mix(r->print, r->topology.place_of_spring[s]);
    return MSPRING_OK;
}

/* ---------------------------------------------------------------------------------------------- the springs */

static mspring_result begin_move(mspringi_replan *r, mspring_network *network) {
    return mspringi_mover_begin(network, &r->topology);
}

static mspring_result reserve_move(mspringi_replan *r, mspring_network *network) {
    (void)r;
    return mspringi_mover_reserve(network);
}

static mspring_result note_rests(mspringi_replan *r, mspring_network *network, uint32_t first, uint32_t end) {
    mspringi_mover_note_rests(network, r->ids, r->woven_places, first, end);
    return MSPRING_OK;
}

static mspring_result reserve_rests(mspringi_replan *r, mspring_network *network) {
    (void)r;
    return mspringi_mover_reserve_rests(network);
}

static mspring_result reserve_strain(mspringi_replan *r, mspring_network *network) {
    (void)r;
    return mspringi_mover_reserve_strain(network);
}

static mspring_result copy_springs(mspringi_replan *r, mspring_network *network, uint32_t first, uint32_t end) {
    mspringi_mover_copy(network, r->topology.place_of_spring, first, end);
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
    return MSPRING_OK;
}

/* ---------------------------------------------------------------------------------------------- piece by piece */

static uint32_t springs_of(const mspringi_replan *r, const mspring_network *network) {
    (void)r;
    return network->topology.spring_count;
}

static uint32_t particles_of(const mspringi_replan *r, const mspring_network *network) {
    (void)r;
    return network->topology.particle_count;
}

static uint32_t rows_of(const mspringi_replan *r, const mspring_network *network) {
    (void)r;
    return first_topology(network)->lattice_rows;
}

static uint32_t live_of(const mspringi_replan *r, const mspring_network *network) {
    (void)network;
    return r->live;
}

/// A function that is called once, or with one range of so many things after the other.
typedef struct replan_pass {
    mspring_result (*once)(mspringi_replan *, mspring_network *);
    mspring_result (*part)(mspringi_replan *, mspring_network *, uint32_t first, uint32_t end);
    uint32_t (*count)(const mspringi_replan *, const mspring_network *);
    uint32_t most;
} replan_pass;

#define ONCE(function)                                                                                             \
    { function, NULL, NULL, 0 }
#define EACH(function, count, most)                                                                                \
    { NULL, function, count, most }

static const replan_pass replan_passes[] = {
    ONCE(begin),
    EACH(look_for_live, springs_of, 64000),
    ONCE(reserve_lists),
    EACH(place_on_diagonal, particles_of, 64000),
    EACH(place_in_grids, rows_of, 64),
    EACH(list_springs, springs_of, 32000),
    ONCE(begin_layout),
    ONCE(lay_out),
    ONCE(finish_layout),
    EACH(number_places, springs_of, 64000),
    ONCE(enter_spare),
    EACH(note_ends, springs_of, 32000),
    ONCE(keep_spare),
    EACH(print_slots, particles_of, 64000),
    EACH(print_places, springs_of, 64000),
    ONCE(free_lists),
    ONCE(begin_move),
    ONCE(reserve_move),
    EACH(note_rests, live_of, 16000),
    ONCE(reserve_rests),
    ONCE(reserve_strain),
    EACH(copy_springs, springs_of, 16000),
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

static mspring_result run(mspringi_replan *r, mspring_network *network) {
    const replan_pass *next = &replan_passes[r->pass];
    const uint32_t count = next->part ? next->count(r, network) : 0, left = count - r->at;
    mspring_result result = MSPRING_OK;
    r->is_halfway = false;
    if (next->once) {
        result = next->once(r, network);
    } else if (left > 0) {
        const uint32_t first = r->at;
        r->at += left < next->most ? left : next->most;
        result = next->part(r, network, first, r->at);
    }
    if (r->at == count && !r->is_halfway) {
        r->pass++;
        r->at = 0;
    }
    return result;
}

mspring_result mspringi_replan_go_on(mspringi_replan *r, mspring_network *network) {
    if (r->pass > REPLAN_PASSES - MOVE_PASSES && !network->mover) { // it was dropped
        r->pass = (uint32_t)REPLAN_PASSES - MOVE_PASSES;
        r->at = 0;
    }
    return mspringi_replan_is_done(r) ? MSPRING_OK : run(r, network);
}

bool mspringi_replan_is_needless(const mspringi_replan *replan) {
    return replan->pass == PASS_AFTER_LOOK && !replan->has_work;
}

bool mspringi_replan_is_done(const mspringi_replan *replan) {
    return replan->pass == REPLAN_PASSES || mspringi_replan_is_needless(replan);
}

uint32_t mspringi_replan_left(const mspringi_replan *replan) {
    return (uint32_t)REPLAN_PASSES - replan->pass;
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

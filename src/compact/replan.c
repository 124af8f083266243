/// A topology of the springs that are left.
#include "replan.h"

#include "network/springs.h"
#include "topology/spare.h"

struct mspringi_replan {
    struct mspring_builder left; ///< particles in the first topology's rows and columns, live springs
    mspring_id *ids;             ///< [left.spring_count] of the live springs, rising
    mspringi_assembly *assembly;
    mspringi_topology topology; ///< once the assembly has made it
    uint64_t links, growth;     ///< edits.links and edits.growth when live springs were listed
    uint32_t done;              ///< pieces of the work
};

// The topology that the network was created with.
static const mspringi_topology *first_topology(const mspring_network *network) {
    return network->is_compact ? &network->whole : &network->topology;
}

/* --------------------------------------------------------------------------------------------- what is left */

// Where a particle is in its grid: grids lie one above the other, too far apart to be taken for one. Particles
// of no grid lie on a diagonal on the other side, where no two can be taken for neighbours on a grid, in the order
// in which they lie in memory.
static void place_particles(const mspringi_topology *first, mspringi_particle *particles) {
    for (mspring_id p = 0; p < first->particle_count; ++p)
        particles[p].x = particles[p].y = -10.0 - 3.0 * (double)first->slot_of_particle[p];
    for (uint32_t r = 0; r < first->lattice_rows; ++r) {
        const mspringi_row *row = &first->rows[r];
        for (const mspringi_span *span = first->spans + row->first_span;
             span < first->spans + row->first_span + row->span_count; ++span) {
            for (uint32_t slot = span->first_slot; slot < span->end_slot; ++slot) {
                const mspring_id p = first->particle_of_slot[slot];
                if (p == MSPRING_NONE)
                    continue;
                particles[p].x = (double)((int64_t)slot + span->carry);
                particles[p].y = (double)r + 2.0 * (double)first->grid_of_row[r];
            }
        }
    }
}

static mspring_result list_what_is_left(mspringi_replan *replan, mspring_network *network) {
    const mspringi_topology *first = first_topology(network);
    struct mspring_builder *left = &replan->left;
    mspringi_place_reader places, first_places;
    size_t live = 0;
    replan->links = network->edits.links;
    replan->growth = network->edits.growth;
    mspringi_places_begin(&places, &network->topology.places, 0);
    for (mspring_id s = 0; s < first->spring_count; ++s)
        live += mspringi_place_is_live(network, mspringi_places_next(&places));
    left->particles = mspringi_alloc(&network->plan_memory, first->particle_count, sizeof *left->particles);
    left->springs = mspringi_alloc(&network->plan_memory, live, sizeof *left->springs);
    replan->ids = mspringi_alloc(&network->plan_memory, live, sizeof *replan->ids);
    if (!left->particles || !left->springs || !replan->ids)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to list %zu springs that are left",
                             live);
    place_particles(first, left->particles);
    for (mspring_id p = 0; p < first->particle_count; ++p)
        if (!mspringi_particle_exists(network, p))
            left->particles[p].flags = MSPRINGI_PARTICLE_ABSENT;
    left->particle_count = first->particle_count;
    mspringi_places_begin(&places, &network->topology.places, 0);
    mspringi_places_begin(&first_places, &first->places, 0);
    for (mspring_id s = 0; s < first->spring_count; ++s) {
        const mspringi_place place = mspringi_places_next(&places),
                             first_place = mspringi_places_next(&first_places);
        uint32_t base, tip;
        if (!mspringi_place_is_live(network, place))
            continue;
        mspringi_topology_ends(first, first_place, &base, &tip);
        replan->ids[left->spring_count] = s;
        left->springs[left->spring_count++] =
            (mspringi_spring){.a = first->particle_of_slot[base], .b = first->particle_of_slot[tip]};
    }
    return mspringi_topology_begin(left, &first->reserve, mspringi_tasks_concurrency(network->tasks),
                                   &network->plan_memory, &network->message, &replan->assembly);
}

/* ------------------------------------------------------------------------------------------------- parking */

static mspring_result no_memory_to_park(mspring_network *network, uint32_t parked) {
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to park %u springs", (unsigned)parked);
}

// Give the springs that are not left places behind those that are: spare ones those that are kept for them, the
// others behind these.
static void number_places(const mspringi_replan *replan, const mspringi_topology *first, const mspringi_topology *t,
                          const mspringi_place *woven_places, mspringi_place *places) {
    const uint32_t woven = (uint32_t)replan->left.spring_count;
    mspringi_place next_parked = t->chain_places + t->woven_count + mspringi_spare_springs(t);
    for (mspring_id s = 0, next_woven = 0; s < first->spring_count; ++s) {
        if (next_woven < woven && replan->ids[next_woven] == s)
            places[s] = woven_places[next_woven++];
        else
            places[s] = s < t->reserve.first_spring ? next_parked++ : mspringi_spare_place(t, s);
    }
}

// Write down what springs outside of the plan join. Those that have been removed keep whatever ends: their
// particles may be gone, too.
static void note_ends(const mspring_network *network, const mspringi_topology *first, mspringi_topology *t,
                      const mspringi_place *places) {
    mspringi_place_reader first_places;
    mspringi_places_begin(&first_places, &first->places, 0);
    for (mspring_id s = 0; s < t->spring_count; ++s) {
        const mspringi_place first_place = mspringi_places_next(&first_places);
        uint32_t base, tip;
        if (mspringi_place_is_woven(t, places[s]) || !mspringi_spring_exists(network, s))
            continue;
        mspringi_topology_ends(first, first_place, &base, &tip);
        t->leftover_a[places[s] - t->chain_places] = t->slot_of_particle[first->particle_of_slot[base]];
        t->leftover_b[places[s] - t->chain_places] = t->slot_of_particle[first->particle_of_slot[tip]];
    }
}

// Who asked for the replan frees all of it if this fails.
static mspring_result park(mspringi_replan *replan, mspring_network *network, mspringi_place *woven_places) {
    const mspringi_topology *first = first_topology(network);
    mspringi_topology *t = &replan->topology;
    uint32_t woven = 0;
    while (woven < replan->left.spring_count && replan->ids[woven] < t->reserve.first_spring)
        ++woven;
    const uint32_t parked = t->reserve.first_spring - woven;
    mspringi_place *places = mspringi_alloc(&network->plan_memory, t->reserve.spring_end, sizeof *places);
    if (!places)
        return no_memory_to_park(network, parked);
    number_places(replan, first, t, woven_places, places);
    t->spring_count = first->spring_count;
    mspring_result result = mspringi_spare_extend(t, places, parked, &network->plan_memory, &network->message);
    if (result != MSPRING_OK)
        return result;
    note_ends(network, first, t, places);
    mspringi_spare_count(t, t->particle_count, t->spring_count);
    mspringi_free(&network->plan_memory, places);
    mspringi_free(&network->plan_memory, woven_places);
    return MSPRING_OK;
}

static mspring_result finish(mspringi_replan *replan, mspring_network *network) {
    mspringi_place *places;
    mspringi_topology_finish(replan->assembly, &network->plan_memory, &replan->topology, &places);
    replan->assembly = NULL;
    return park(replan, network, places);
}

/* ---------------------------------------------------------------------------------------------- piece by piece */

mspring_result mspringi_replan_begin(mspring_network *network, mspringi_replan **begun) {
    mspringi_replan *replan = mspringi_alloc(&network->plan_memory, 1, sizeof *replan);
    if (!replan)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for another plan");
    *begun = replan;
    return MSPRING_OK;
}

mspring_result mspringi_replan_go_on(mspringi_replan *replan, mspring_network *network) {
    const uint32_t piece = replan->done++;
    if (piece == 0)
        return list_what_is_left(replan, network);
    return piece <= MSPRINGI_TOPOLOGY_PIECES ? mspringi_topology_go_on(replan->assembly) : finish(replan, network);
}

uint32_t mspringi_replan_pieces_left(const mspringi_replan *replan) {
    return MSPRINGI_REPLAN_PIECES - replan->done;
}

bool mspringi_replan_is_valid(const mspringi_replan *replan, const mspring_network *network) {
    const mspringi_topology *t = &replan->topology;
    mspringi_place_reader places, planned;
    if (replan->growth != network->edits.growth)
        return false;
    mspringi_places_begin(&places, &network->topology.places, 0);
    mspringi_places_begin(&planned, &t->places, 0);
    for (mspring_id s = 0; replan->links != network->edits.links && s < t->spring_count; ++s) {
        const bool live = mspringi_place_is_live(network, mspringi_places_next(&places));
        if (mspringi_place_is_parked(t, mspringi_places_next(&planned)) && live)
            return false;
    }
    return true;
}

void mspringi_replan_take(mspringi_replan *replan, mspring_network *network, mspringi_topology *topology) {
    *topology = replan->topology;
    mspringi_free(&network->plan_memory, replan->left.particles);
    mspringi_free(&network->plan_memory, replan->left.springs);
    mspringi_free(&network->plan_memory, replan->ids);
    mspringi_free(&network->plan_memory, replan);
    mspringi_memory_hand_over(&network->plan_memory, &network->memory);
}

/// Thresholds of strain, and the pass that compares them.
#include "strain.h"

#include <math.h>

#include "breaking.h"
#include "events.h"
#include "network/springs.h"
#include "selection.h"

/* ---------------------------------------------------------------------------------------------------- the pass */

// The springs of the web, as the kernels do those of rows.
static uint32_t leftover_strain(const mspring_network *network, mspringi_strain_hit *hits) {
    const mspringi_topology *t = &network->topology;
    const mspringi_strain *strain = &network->strain;
    const mspringi_state *state = &network->state;
    uint32_t count = 0;
    for (uint32_t first = 0; first < t->leftover_count; first += MSPRINGI_WIDTH) {
        const uint32_t word = (t->chain_places + first) / MSPRINGI_WIDTH;
        mspringi_strain_hit hit = {.word = word};
        for (uint32_t i = first; i < first + MSPRINGI_WIDTH && i < t->leftover_count; ++i) {
            const mspringi_place place = t->chain_places + i;
            const uint16_t bit = (uint16_t)(1u << place % MSPRINGI_WIDTH);
            if (!(network->live[word] & bit))
                continue;
            const mspringi_spring_values values = mspringi_place_get(network, place);
            const float dx = state->x[values.tip] - state->x[values.base];
            const float dy = state->y[values.tip] - state->y[values.base];
            const float stretch = fabsf(sqrtf(dx * dx + dy * dy) - values.rest_length);
            const float stress_at =
                strain->stress_strain ? strain->stress_strain[place] * values.rest_length : INFINITY;
            const bool stressed = strain->stressed[word] & bit;
            if (stretch > strain->break_strain[place] * values.rest_length)
                hit.broken |= bit;
            else if (!stressed && stretch > stress_at)
                hit.stressed |= bit;
            else if (stressed && stress_at * strain->relax > stretch)
                hit.relaxed |= bit;
        }
        if (hit.broken | hit.stressed | hit.relaxed)
            hits[count++] = hit;
    }
    return count;
}

static void act_on(mspring_network *network, mspringi_place place, const mspringi_strain_hit *hit) {
    const mspringi_topology *t = &network->topology;
    const uint16_t bit = (uint16_t)(1u << place % MSPRINGI_WIDTH);
    uint32_t base, tip;
    mspringi_topology_ends(t, place, &base, &tip);
    const mspring_id spring = mspringi_incidence_find(&network->incidence, t, t->particle_of_slot[base], place);
    mspring_event event = {.kind = hit->broken & bit     ? MSPRING_EVENT_BROKEN
                                   : hit->stressed & bit ? MSPRING_EVENT_STRESSED
                                                         : MSPRING_EVENT_RELAXED,
                           .id = spring,
                           .other = MSPRING_NONE,
                           .strain = mspringi_spring_strain(network, spring)};
    if (event.kind == MSPRING_EVENT_BROKEN)
        (void)mspringi_spring_break(network, spring);
    else
        network->strain.stressed[hit->word] ^= bit;
    mspringi_events_push(network, event);
}

void mspringi_strain_pass(mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const mspringi_strain *strain = &network->strain;
    if (!strain->break_strain)
        return;
    const mspringi_strain_sweep sweep = {
        .x = network->state.x,
        .y = network->state.y,
        .lattice_springs = network->lattice_springs,
        .chain_springs = network->chain_springs,
        .parts = network->parts,
        .up_of_block = t->up_of_block,
        .lattice_first = t->lattice_first,
        .chain_first = t->chain_first,
        .chain_word = t->lattice_places / MSPRINGI_WIDTH,
        .break_strain = strain->break_strain,
        .stress_strain = strain->stress_strain,
        .live = network->live,
        .stressed = strain->stressed,
        .relax = strain->relax,
    };
    mspringi_strain_hit *hits = strain->hits;
    uint32_t count = network->kernels->lattice_strain(&sweep, 0, t->lattice_blocks, hits);
    count += network->kernels->chain_strain(&sweep, 0, t->chain_blocks, hits + count);
    count += leftover_strain(network, hits + count);
    for (const mspringi_strain_hit *hit = hits; hit < hits + count; ++hit)
        for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
            if ((hit->broken | hit->stressed | hit->relaxed) >> lane & 1)
                act_on(network, hit->word * MSPRINGI_WIDTH + lane, hit);
}

/* -------------------------------------------------------------------------------------------------- thresholds */

static float *allocate_thresholds(mspring_network *network) {
    const size_t count = mspringi_place_words(&network->topology) * MSPRINGI_WIDTH;
    float *thresholds = mspringi_alloc(&network->memory, count, sizeof *thresholds);
    for (size_t place = 0; thresholds && place < count; ++place)
        thresholds[place] = INFINITY;
    return thresholds;
}

// All that the pass needs; break_strain is there when all of it is.
static mspring_result reserve(mspring_network *network) {
    mspringi_strain *strain = &network->strain;
    if (strain->break_strain)
        return MSPRING_OK;
    const size_t words = mspringi_place_words(&network->topology);
    mspring_result result = mspringi_breaking_reserve(network);
    if (result == MSPRING_OK && !network->incidence.first)
        result =
            mspringi_incidence_create(&network->incidence, &network->topology, &network->memory, &network->message);
    if (result != MSPRING_OK)
        return result;
    if (!strain->stressed)
        strain->stressed = mspringi_alloc(&network->memory, words, sizeof *strain->stressed);
    if (!strain->hits)
        strain->hits = mspringi_alloc(&network->memory, words, sizeof *strain->hits);
    if (strain->stressed && strain->hits)
        strain->break_strain = allocate_thresholds(network);
    return strain->break_strain ? MSPRING_OK
                                : mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                                                "no memory to watch the strain of %u springs",
                                                (unsigned)network->topology.spring_count);
}

static mspring_result reserve_stress(mspring_network *network) {
    mspringi_strain *strain = &network->strain;
    if (!strain->stress_strain)
        strain->stress_strain = allocate_thresholds(network);
    return strain->stress_strain ? MSPRING_OK
                                 : mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                                                 "no memory for the stress strains of %u springs",
                                                 (unsigned)network->topology.spring_count);
}

static mspring_result set_thresholds(mspring_network *network, bool stress, const mspringi_selection *at,
                                     const float *strain) {
    for (uint32_t i = 0; i < at->count; ++i)
        if (!(strain[i] > 0.0f))
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                 "spring %u: %s strain is %g, it must be > 0", (unsigned)mspringi_selected(at, i),
                                 stress ? "stress" : "break", (double)strain[i]);
    mspring_result result = at->count > 0 ? reserve(network) : MSPRING_OK;
    if (result == MSPRING_OK && stress && at->count > 0)
        result = reserve_stress(network);
    float *thresholds = stress ? network->strain.stress_strain : network->strain.break_strain;
    for (uint32_t i = 0; result == MSPRING_OK && i < at->count; ++i)
        thresholds[network->topology.place_of_spring[mspringi_selected(at, i)]] = strain[i];
    return result;
}

static mspring_result set_range(mspring_network *network, bool stress, mspring_id first, uint32_t count,
                                const float *strain) {
    mspringi_selection at;
    const uint32_t total = mspring_network_spring_count(network);
    mspring_result result = mspringi_select_range(network, "spring", total, first, count, strain, strain, &at);
    return result == MSPRING_OK ? set_thresholds(network, stress, &at, strain) : result;
}

static mspring_result set_list(mspring_network *network, bool stress, const mspring_id *springs, uint32_t count,
                               const float *strain) {
    mspringi_selection at;
    const uint32_t total = mspring_network_spring_count(network);
    mspring_result result = mspringi_select_list(network, "spring", total, springs, count, strain, strain, &at);
    return result == MSPRING_OK ? set_thresholds(network, stress, &at, strain) : result;
}

mspring_result mspring_network_set_break_strains(mspring_network *network, mspring_id first, uint32_t count,
                                                 const float *strain) {
    return set_range(network, false, first, count, strain);
}

mspring_result mspring_network_set_break_strains_at(mspring_network *network, const mspring_id *springs,
                                                    uint32_t count, const float *strain) {
    return set_list(network, false, springs, count, strain);
}

mspring_result mspring_network_set_stress_strains(mspring_network *network, mspring_id first, uint32_t count,
                                                  const float *strain) {
    return set_range(network, true, first, count, strain);
}

mspring_result mspring_network_set_stress_strains_at(mspring_network *network, const mspring_id *springs,
                                                     uint32_t count, const float *strain) {
    return set_list(network, true, springs, count, strain);
}

mspring_result mspring_network_set_relax_fraction(mspring_network *network, float fraction) {
    mspring_result result = mspringi_enter(network);
    if (result != MSPRING_OK)
        return result;
    if (!(fraction >= 0.0f && fraction <= 1.0f))
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "the relax fraction is %g, it must be 0 to 1", (double)fraction);
    network->strain.relax = fraction;
    return MSPRING_OK;
}

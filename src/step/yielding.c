/// The stage in which springs yield.
///
/// A look over all springs finds those that are warm: near to what they yield at. It is due before each
/// PERIOD-th substep of a step, counted from its first, and costs less than testing them, as it knows of bounds
/// only. Those that are warm are tested before each substep until the next look. So what a step does follows from
/// the state that it begins with, and nothing has to be remembered from step to step. As long as nothing is warm,
/// substeps are taken PERIOD at a time.
///
/// Longer periods than 4 lose yields: with 20, a blow of 8 ms left a dent 13 % too small. Without a border of
/// stability substeps are long, and each of them begins with a look.
#include <math.h>

#include "sleep/sleep.h"
#include "step/plastic.h"
#include "step/strain.h"
#include "store/changed.h"
#include "store/events.h"
#include "store/growth.h"
#include "store/springs.h"
#include "store/stages.h"

#define PERIOD 4u

static uint32_t period_of(const mspringi_attempt *attempt) {
    return attempt->solver->ops->has_border ? PERIOD : 1u;
}

static bool is_used(const mspring_network *network) {
    return network->plastic.yields;
}

static bool is_quiet(const mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    return mspringi_sleep_is_whole(network);
}

/* ------------------------------------------------------------------------------------------------------- a look */

static uint32_t look_at_leftover(const mspring_network *network, mspringi_strain_hit *hits) {
    const mspringi_topology *t = &network->topology;
    const mspringi_plastic *p = &network->plastic;
    const mspringi_state *s = &network->state;
    uint32_t count = 0;
    for (uint32_t first = 0; first < t->leftover_count; first += MSPRINGI_WIDTH) {
        const uint32_t word = (t->chain_places + first) / MSPRINGI_WIDTH;
        uint32_t bits = 0;
        for (uint32_t i = first; i < first + MSPRINGI_WIDTH && i < t->leftover_count; ++i) {
            const mspringi_place place = t->chain_places + i;
            const float dx = s->x[t->leftover_b[i]] - s->x[t->leftover_a[i]];
            const float dy = s->y[t->leftover_b[i]] - s->y[t->leftover_a[i]], square = dx * dx + dy * dy;
            const bool is_out = square > p->high[place] || p->low[place] > square;
            if (is_out && mspringi_place_is_live(network, place) &&
                !mspringi_slot_is_asleep(network, t->leftover_a[i]))
                bits |= 1u << (i - first);
        }
        if (bits)
            hits[count++] = (mspringi_strain_hit){word, bits};
    }
    return count;
}

// List the springs that are warm.
static void look(mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    mspringi_plastic *p = &network->plastic;
    const mspringi_yield_sweep sweep = {.x = network->state.x,
                                        .y = network->state.y,
                                        .up_of_block = t->up_of_block,
                                        .lattice_first = t->lattice_first,
                                        .chain_first = t->chain_first,
                                        .chain_word = t->lattice_places / MSPRINGI_WIDTH,
                                        .low = p->low,
                                        .high = p->high,
                                        .live = network->live};
    mspringi_strain_hit *hits = p->hits;
    for (uint32_t first = 0, end; mspringi_next_awake(network, t->lattice_first, t->lattice_blocks, &first, &end);
         first = end)
        hits += network->kernels->lattice_yield(&sweep, first, end, hits);
    for (uint32_t first = 0, end; mspringi_next_awake(network, t->chain_first, t->chain_blocks, &first, &end);
         first = end)
        hits += network->kernels->chain_yield(&sweep, first, end, hits);
    hits += look_at_leftover(network, hits);
    p->hit_count = (uint32_t)(hits - p->hits);
}

/* ---------------------------------------------------------------------------------------------------- the flow */

static void keep(mspringi_plastic *p, mspringi_place place, float rest_length) {
    const uint16_t bit = (uint16_t)(1u << place % MSPRINGI_WIDTH);
    uint16_t *word = &p->has_flowed[place / MSPRINGI_WIDTH];
    if (*word & bit)
        return;
    p->before[place] = rest_length;
    *word |= bit;
    p->flows = p->is_bent = true;
    p->count++;
}

// Map one spring back onto its yield surface: see plastic.h. One on a ramp does not flow: that sets its rest
// length.
static void map(mspring_network *network, mspringi_place place) {
    mspringi_plastic *p = &network->plastic;
    const mspringi_state *s = &network->state;
    const mspringi_spring_values values = mspringi_place_get(network, place);
    const double dx = mspringi_x_of(s, values.tip) - mspringi_x_of(s, values.base);
    const double dy = mspringi_y_of(s, values.tip) - mspringi_y_of(s, values.base);
    const double length = sqrt(dx * dx + dy * dy), rest = (double)values.rest_length;
    const double nominal = (double)p->nominal[place], hardening = (double)p->hardening[place];
    const double strain = (rest - nominal) / nominal, limit = (double)p->plastic_limit[place];
    const double t = (length - rest) / nominal - hardening * strain, size = fabs(t);
    const double over = size - (double)p->yield_strain[place], sign = t > 0.0 ? 1.0 : -1.0;
    if (!(over > 0.0 && length <= (double)MSPRINGI_LARGEST_LENGTH) || mspringi_place_ramp(network, place))
        return;
    const double flowed = fmin(sign * strain + over / (1.0 + hardening), limit);
    const float made = (float)(nominal * (1.0 + sign * flowed));
    const double step = sign * ((double)made - rest) / nominal;
    if (!(step > 0.0))
        return;
    keep(p, place, values.rest_length);
    p->dissipated += (double)values.stiffness * nominal * nominal * step * (size - 0.5 * (1.0 + hardening) * step);
    p->flows_seen++;
    mspringi_place_set_rest_length(network, place, made);
    mspringi_plastic_renew(network, place);
}

static void map_warm(mspring_network *network) {
    const mspringi_plastic *p = &network->plastic;
    for (const mspringi_strain_hit *hit = p->hits; hit < p->hits + p->hit_count; ++hit)
        for (uint32_t bits = hit->bits, lane = 0; bits; bits >>= 1, ++lane)
            if (bits & 1)
                map(network, hit->word * MSPRINGI_WIDTH + lane);
}

/* -------------------------------------------------------------------------------------------------- the stage */

static void before_step(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_plastic *p = &network->plastic;
    (void)attempt;
    p->hit_count = 0;
    p->count_before = p->count;
    p->dissipated_before = p->dissipated;
}

// The first substep stands alone: what it begins with is known only when it does.
static uint32_t free_substeps(const mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    const uint32_t period = period_of(attempt), left = attempt->substeps - substep;
    const uint32_t most = substep == 0 || network->plastic.hit_count > 0 ? 1 : period - substep % period;
    return most < left ? most : left;
}

static mspringi_field before_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                                     mspringi_field base) {
    if (substep == 0)
        look(network);
    (void)attempt;
    map_warm(network);
    return base;
}

static void after_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    if ((substep + 1) % period_of(attempt) == 0 && substep + 1 < attempt->substeps)
        look(network);
}

// Go through the springs that have flowed in the step, and forget that they have.
static void end_flow(mspring_network *network, void (*end)(mspring_network *network, mspringi_place place)) {
    mspringi_plastic *p = &network->plastic;
    const size_t words = p->flows ? mspringi_place_words(&network->topology) : 0;
    for (size_t word = 0; word < words; ++word) {
        for (uint32_t bits = p->has_flowed[word], lane = 0; bits; bits >>= 1, ++lane)
            if (bits & 1)
                end(network, (mspringi_place)(word * MSPRINGI_WIDTH + lane));
        p->has_flowed[word] = 0;
    }
    p->flows = false;
}

static void straighten(mspring_network *network, mspringi_place place) {
    network->plastic.flows_seen++;
    mspringi_place_set_rest_length(network, place, network->plastic.before[place]);
    mspringi_plastic_renew(network, place);
}

static void take_back(mspring_network *network) {
    mspringi_plastic *p = &network->plastic;
    end_flow(network, straighten);
    p->hit_count = 0;
    p->count = p->count_before;
    p->dissipated = p->dissipated_before;
}

static void report(mspring_network *network, mspringi_place place) {
    const mspringi_spring_values values = mspringi_place_get(network, place);
    const double nominal = (double)network->plastic.nominal[place];
    mspringi_events_push(
        network,
        (mspring_event){.kind = MSPRING_EVENT_YIELDED,
                        .id = mspringi_around_find(network, network->topology.particle_of_slot[values.base], place),
                        .other = MSPRING_NONE,
                        .strain = (float)(((double)values.rest_length - nominal) / nominal)});
}

static void after_step(mspring_network *network, double dt) {
    (void)dt;
    end_flow(network, report);
}

const mspringi_stage mspringi_stage_yielding = {.is_used = is_used,
                                                .before_step = before_step,
                                                .is_quiet = is_quiet,
                                                .free_substeps = free_substeps,
                                                .before_substep = before_substep,
                                                .after_substep = after_substep,
                                                .take_back = take_back,
                                                .after_step = after_step};

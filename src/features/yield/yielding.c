/// The stage in which springs yield.
///
/// A look over all springs finds those that are warm: near to what they yield at. It is due before each
/// MSPRINGI_YIELD_PERIOD-th substep of a step, counted from its first. The warm springs are tested before each
/// substep until the next look, and mapped where they are over their yield strain. Other springs are not, in any
/// layout. So a step follows from the state at its beginning, and nothing is remembered from step to step.
///
/// In the explicit solver the sweeps of lattice and chain rows look and test, strip by strip: see yield_springs()
/// in kernels/yield_sweep.h. With several workers they first take a step in which they only look. If any spring was
/// warm, that step is taken once more with one worker, who maps as well. The next step begins with that, as it is
/// likely to be warm, too: both have the same bits where nothing is. Springs of the irregular part, and those of
/// all other solvers, are looked at and mapped here, between substeps.
///
/// Longer periods than 4 lose yields: with 20, a blow of 8 ms left a dent 13 % too small. Without a stability
/// limit substeps are long, and each of them begins with a look. Implicit ones are cut into pieces where they
/// would stretch warm springs too far: those that are warm, and those that will be by their end.
#include <math.h>
#include <string.h>

#include "base/assert.h"
#include "features/breaking/strain.h"
#include "features/yield/plastic.h"
#include "store/changed.h"
#include "store/events.h"
#include "store/id_pool.h"
#include "store/record_sharing.h"
#include "store/sleepers.h"
#include "store/spring_limits.h"
#include "store/springs.h"
#include "store/stages.h"
#include "tasks/tasks.h"

static uint32_t period_of(const mspringi_attempt *attempt) {
    return attempt->solver->ops->has_stability_limit ? MSPRINGI_YIELD_PERIOD : 1u;
}

static bool is_used(const mspring_network *network) {
    return network->tested.yields;
}

static bool is_quiet(const mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    return mspringi_sleep_is_whole(network) || (network->tested.is_swept && !network->plastic->irregular_yields);
}

/* ------------------------------------------------------------------------------------------------------- a look */

static uint32_t look_at_irregular(const mspring_network *network, const float *x, const float *y,
                                  mspringi_strain_hit *hits) {
    const mspringi_topology *t = &network->topology;
    const mspringi_tested *p = &network->tested;
    uint32_t count = 0;
    for (uint32_t first = 0; first < t->irregular_count; first += MSPRINGI_WIDTH) {
        const uint32_t word = (t->row_spring_slots + first) / MSPRINGI_WIDTH;
        uint32_t bits = 0;
        for (uint32_t i = first; i < first + MSPRINGI_WIDTH && i < t->irregular_count; ++i) {
            const mspringi_spring_slot spring_slot = t->row_spring_slots + i;
            const float dx = x[t->irregular_b[i]] - x[t->irregular_a[i]];
            const float dy = y[t->irregular_b[i]] - y[t->irregular_a[i]], square = dx * dx + dy * dy;
            const bool is_out = square > p->high[spring_slot] || p->low[spring_slot] > square;
            if (is_out && mspringi_spring_slot_is_live(network, spring_slot) &&
                !mspringi_slot_is_asleep(network, t->irregular_a[i]))
                bits |= 1u << (i - first);
        }
        if (bits)
            hits[count++] = (mspringi_strain_hit){word, bits};
    }
    return count;
}

// List the springs that are warm in these positions.
static void look_at(mspring_network *network, const float *x, const float *y) {
    const mspringi_topology *t = &network->topology;
    mspringi_tested *p = &network->tested;
    const mspringi_yield_sweep sweep = {.x = x,
                                        .y = y,
                                        .up_of_block = t->up_of_block,
                                        .lattice_first = t->lattice_first,
                                        .chain_first = t->chain_first,
                                        .chain_word = t->lattice_spring_slots / MSPRINGI_WIDTH,
                                        .low = p->low,
                                        .high = p->high,
                                        .live = network->live};
    mspringi_strain_hit *hits = p->hits;
    network->plastic->hit_count = p->is_swept ? look_at_irregular(network, x, y, hits) : 0;
    if (p->is_swept)
        return;
    for (uint32_t first = 0, end; mspringi_next_awake(network, t->lattice_first, t->lattice_blocks, &first, &end);
         first = end)
        hits += network->kernels->lattice_yield(&sweep, first, end, hits);
    for (uint32_t first = 0, end; mspringi_next_awake(network, t->chain_first, t->chain_blocks, &first, &end);
         first = end)
        hits += network->kernels->chain_yield(&sweep, first, end, hits);
    hits += look_at_irregular(network, x, y, hits);
    network->plastic->hit_count = (uint32_t)(hits - p->hits);
}

static void look(mspring_network *network) {
    look_at(network, network->state.x, network->state.y);
}

// List those that will be, if particles go on as they move now.
static void look_ahead(mspring_network *network, float time) {
    const mspringi_state *s = &network->state;
    const size_t slots = mspringi_slot_count(network);
    float *x = network->tested.ahead, *y = x + slots;
    for (size_t slot = 0; slot < slots; ++slot) {
        x[slot] = s->x[slot] + time * s->vx[slot];
        y[slot] = s->y[slot] + time * s->vy[slot];
    }
    look_at(network, x, y);
}

/* ---------------------------------------------------------------------------------------------------- the flow */

static void keep(mspring_network *network, mspringi_spring_slot spring_slot, float rest_length) {
    const mspringi_tested *p = &network->tested;
    const uint16_t bit = (uint16_t)(1u << spring_slot % MSPRINGI_WIDTH);
    uint16_t *word = &p->has_flowed[spring_slot / MSPRINGI_WIDTH];
    if (*word & bit)
        return;
    p->before[spring_slot] = rest_length;
    *word |= bit;
    network->plastic->flows = true;
}

// Whether a spring that is expected to act at the end of an implicit substep does not yet.
static bool is_slack(const mspring_network *network, mspringi_spring_slot spring_slot,
                     const mspringi_spring_values *spring, float length) {
    if (!network->side)
        return false;
    const mspring_id id = mspringi_spring_at(network, spring_slot);
    return mspringi_is_slack(mspringi_side_of(network, id), (double)length - (double)spring->rest_length);
}

// Length at which the particles last felt a spring. Leapfrog moves them by forces of the substep's start.
static float start_of(const mspring_network *network, const mspringi_attempt *attempt,
                      const mspringi_spring_values *spring, double dx, double dy) {
    const mspringi_state *s = &network->state;
    const float h = attempt->solver->ops->is_staggered ? attempt->h : 0.0f;
    const float way_x = h * (s->vx[spring->tip] - s->vx[spring->base]);
    const float way_y = h * (s->vy[spring->tip] - s->vy[spring->base]);
    return mspringi_yield_start((float)(dx * dx + dy * dy), (float)dx, (float)dy, way_x, way_y);
}

// Map one spring back onto its yield surface, as the sweeps of rows do.
static void map(mspring_network *network, const mspringi_attempt *attempt, mspringi_spring_slot spring_slot) {
    const mspringi_tested *p = &network->tested;
    const mspringi_state *s = &network->state;
    const mspringi_spring_values spring = mspringi_spring_slot_get(network, spring_slot);
    const mspringi_yield_values values = mspringi_yield_values_of(network, spring_slot);
    const mspringi_yield_bounds bounds = {p->low[spring_slot], p->high[spring_slot], p->flow_low[spring_slot],
                                          p->flow_high[spring_slot]};
    const double dx = mspringi_x_of(s, spring.tip) - mspringi_x_of(s, spring.base);
    const double dy = mspringi_y_of(s, spring.tip) - mspringi_y_of(s, spring.base);
    const double square = dx * dx + dy * dy;
    const float length = (float)sqrt(square);
    if (!(spring.stiffness > 0.0f) || is_slack(network, spring_slot, &spring, length))
        return;
    const float to = mspringi_yield_rest(values, bounds, (float)square, length, spring.rest_length);
    if (to == spring.rest_length)
        return;
    keep(network, spring_slot, spring.rest_length);
    const float start = start_of(network, attempt, &spring, dx, dy);
    p->heat[spring_slot] += mspringi_yield_heat(values, spring.stiffness, start, length, spring.rest_length, to);
    network->edits.flows++;
    mspringi_spring_slot_set_rest_length(network, spring_slot, to);
    mspringi_limits_renew(network, spring_slot);
}

static void map_warm(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_tested *p = &network->tested;
    for (const mspringi_strain_hit *hit = p->hits; hit < p->hits + network->plastic->hit_count; ++hit)
        for (uint32_t bits = hit->bits, lane = 0; bits; bits >>= 1, ++lane)
            if (bits & 1)
                map(network, attempt, hit->word * MSPRINGI_WIDTH + lane);
}

/* ------------------------------------------------------------------------------------------------------- pieces */

/// Share of its yield strain by which a warm spring may be stretched within a piece of a substep. With 0.2 a blow
/// of two implicit substeps leaves 92 % of its dent, with 0.1 or less 94 %; with 0.05 it costs twice as many
/// pieces.
#define STRETCH_OF_PIECE 0.1f

// The largest change of strain that a warm spring goes through in a time, over its yield strain.
static float fastest_stretch(const mspring_network *network, float time) {
    const mspringi_tested *p = &network->tested;
    const mspringi_state *s = &network->state;
    float fastest = 0.0f;
    for (const mspringi_strain_hit *hit = p->hits; hit < p->hits + network->plastic->hit_count; ++hit)
        for (uint32_t bits = hit->bits, lane = 0; bits; bits >>= 1, ++lane) {
            if (!(bits & 1))
                continue;
            const mspringi_spring_slot spring_slot = hit->word * MSPRINGI_WIDTH + lane;
            const mspringi_spring_values spring = mspringi_spring_slot_get(network, spring_slot);
            const float dx = s->x[spring.tip] - s->x[spring.base], dy = s->y[spring.tip] - s->y[spring.base];
            const float vx = s->vx[spring.tip] - s->vx[spring.base], vy = s->vy[spring.tip] - s->vy[spring.base];
            const float length = sqrtf(dx * dx + dy * dy),
                        border = p->yield_strain[spring_slot] * p->nominal[spring_slot];
            const float stretch = fabsf(dx * vx + dy * vy) / length * time / border;
            fastest = stretch > fastest ? stretch : fastest;
        }
    return fastest;
}

// Long substeps damp a blow before it can dent, so those in which warm springs are stretched fast are cut.
static uint32_t max_parts(mspring_network *network, const mspringi_attempt *attempt, uint32_t left) {
    if (!attempt->solver->ops->takes_one_substep)
        return left;
    if (left < MSPRINGI_SUBSTEP_PARTS) {
        look(network);
        map_warm(network, attempt);
    }
    const float now = fastest_stretch(network, attempt->h);
    look_ahead(network, attempt->h);
    const float ahead = fastest_stretch(network, attempt->h);
    float stretch = now > ahead ? now : ahead;
    uint32_t most = MSPRINGI_SUBSTEP_PARTS;
    for (; most > 1 && stretch > STRETCH_OF_PIECE; stretch *= 0.5f)
        most /= 2;
    return most < left ? most : left;
}

/* -------------------------------------------------------------------------------------------------- the stage */

static bool irregular_part_yields(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const mspringi_tested *p = &network->tested;
    for (mspringi_spring_slot spring_slot = t->row_spring_slots, end = spring_slot + t->irregular_count;
         spring_slot < end; ++spring_slot)
        if (p->high[spring_slot] < INFINITY || p->low[spring_slot] >= 0.0f)
            return true;
    return false;
}

// Nothing is warm before the first look of a step.
static void forget_looks(const mspring_network *network) {
    const mspringi_tested *p = &network->tested;
    memset(p->warmth, 0, network->topology.strip_count);
    memset(p->warm, 0, mspringi_spring_slot_words(&network->topology) * sizeof *p->warm);
    memset(p->look_of, 0, mspringi_spring_slot_words(&network->topology) * sizeof *p->look_of);
}

static void before_step(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_tested *p = &network->tested;
    network->plastic->hit_count = 0;
    p->substep = 0;
    p->is_swept = attempt->solver->ops->has_stability_limit;
    p->maps = p->is_swept && (network->plastic->was_warm || mspringi_tasks_partition_size(network->tasks) == 1);
    network->plastic->irregular_yields = p->is_swept && irregular_part_yields(network);
    if (p->is_swept)
        mspringi_shared_records_find_yielding(network);
    forget_looks(network);
}

static uint32_t warmth_of_all(const mspring_network *network) {
    uint32_t warmth = 0;
    for (uint32_t strip = 0; strip < network->topology.strip_count; ++strip)
        warmth |= network->tested.warmth[strip];
    return warmth;
}

static bool must_repeat(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_tested *p = &network->tested;
    (void)attempt;
    if (!p->is_swept || p->maps || !(warmth_of_all(network) & MSPRINGI_WAS_WARM))
        return false;
    p->maps = true;
    return true;
}

// The first substep stands alone: what it begins with is known only when it does.
static uint32_t free_substeps(const mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    const mspringi_tested *p = &network->tested;
    const uint32_t period = period_of(attempt), left = attempt->substeps - substep;
    if (p->is_swept && !network->plastic->irregular_yields)
        return left;
    const uint32_t most = substep == 0 || network->plastic->hit_count > 0 ? 1 : period - substep % period;
    return most < left ? most : left;
}

static mspringi_field before_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                                     mspringi_field base) {
    mspringi_tested *p = &network->tested;
    p->substep = substep;
    if (p->is_swept && !network->plastic->irregular_yields)
        return base;
    if (substep == 0)
        look(network);
    map_warm(network, attempt);
    return base;
}

static void after_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    if (network->tested.is_swept && !network->plastic->irregular_yields)
        return;
    if ((substep + 1) % period_of(attempt) == 0 && substep + 1 < attempt->substeps)
        look(network);
}

// Go through the springs that have flowed in the step, and forget that they have.
static void end_flow(mspring_network *network,
                     void (*end)(mspring_network *network, mspringi_spring_slot spring_slot)) {
    mspringi_tested *p = &network->tested;
    const bool flows = network->plastic->flows || warmth_of_all(network) & MSPRINGI_HAS_FLOWED;
    const size_t words = flows ? mspringi_spring_slot_words(&network->topology) : 0;
    for (size_t word = 0; word < words; ++word) {
        for (uint32_t bits = p->has_flowed[word], lane = 0; bits; bits >>= 1, ++lane) {
            const mspringi_spring_slot spring_slot = (mspringi_spring_slot)(word * MSPRINGI_WIDTH + lane);
            if (!(bits & 1))
                continue;
            end(network, spring_slot);
            p->heat[spring_slot] = 0.0f;
        }
        p->has_flowed[word] = 0;
    }
    network->plastic->flows = false;
    network->edits.flows += flows;
}

static void straighten(mspring_network *network, mspringi_spring_slot spring_slot) {
    mspringi_spring_slot_set_rest_length(network, spring_slot, network->tested.before[spring_slot]);
    mspringi_limits_renew(network, spring_slot);
}

static void roll_back(mspring_network *network) {
    end_flow(network, straighten);
    network->plastic->hit_count = 0;
    forget_looks(network);
}

// Heat is summed place by place, so that no order of rows or lanes changes the sum. Where the guard has put
// particles back it may be no number.
static void book(mspring_network *network, mspringi_spring_slot spring_slot) {
    mspringi_tested *p = &network->tested;
    MSPRINGI_ASSERT(p->heat && p->nominal);
    network->plastic->count++;
    if (isfinite(p->heat[spring_slot]))
        network->plastic->dissipated += (double)p->heat[spring_slot];
    p->is_bent = true;
    if (network->strain.break_strain)
        mspringi_strain_renew_least(network, spring_slot);
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACE, spring_slot);
    if (!network->events)
        return;
    const mspringi_spring_values values = mspringi_spring_slot_get(network, spring_slot);
    const double nominal = (double)p->nominal[spring_slot];
    mspringi_events_push(network,
                         (mspring_event){.kind = MSPRING_EVENT_YIELDED,
                                         .id = mspringi_spring_at(network, spring_slot),
                                         .other = MSPRING_NONE,
                                         .strain = (float)(((double)values.rest_length - nominal) / nominal)});
}

static void after_step(mspring_network *network, double dt) {
    (void)dt;
    const double dissipated = network->plastic->dissipated;
    network->plastic->was_warm = warmth_of_all(network) & MSPRINGI_WAS_WARM;
    end_flow(network, book);
    network->plastic->dissipated = fmax(network->plastic->dissipated, dissipated);
}

const mspringi_stage mspringi_stage_yielding = {.is_used = is_used,
                                                .before_step = before_step,
                                                .is_quiet = is_quiet,
                                                .free_substeps = free_substeps,
                                                .before_substep = before_substep,
                                                .max_parts = max_parts,
                                                .after_substep = after_substep,
                                                .must_repeat = must_repeat,
                                                .is_swept = true,
                                                .roll_back = roll_back,
                                                .after_step = after_step};

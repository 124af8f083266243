/// The stage of contact between bodies: when to look, and which islands sleep and wake together.
///
/// Steps and substeps in which nothing can touch are taken as if there were no contact. How many these are is
/// bounded by the speeds at the last look. If forces have made points so fast that some could have touched, the
/// step is taken back and repeated with a look after every substep.
#include "contact/pairs.h"

#include <math.h>

#include "sleep/sleep.h"
#include "store/stages.h"

/// Points this near rest on each other, as a share of the thickness.
#define RESTING_SHARE 0.05

static bool is_used(const mspring_network *network) {
    return network->pairs != NULL;
}

// A collider moves even where all bodies sleep.
static bool moves(const mspring_network *network) {
    const mspringi_colliders *c = &network->pairs->colliders;
    for (uint32_t i = 0; i < c->count; ++i)
        if (c->list[i].is_moving)
            return true;
    return false;
}

/* -------------------------------------------------------------------------------------------------------- sleep */

static uint32_t island_of(const mspring_network *network, mspring_id p) {
    return network->sleep.island[network->topology.slot_of_particle[p]];
}

typedef struct node_place {
    double x, y;
} node_place;

static node_place place_of(const mspring_network *network, const mspringi_pairs *pairs, mspring_id node) {
    const mspringi_state *s = &network->state;
    if (mspringi_is_of_collider(pairs, node)) {
        const uint32_t point = node - pairs->particles;
        return (node_place){pairs->colliders.x[point], pairs->colliders.y[point]};
    }
    const uint32_t slot = network->topology.slot_of_particle[node];
    return (node_place){mspringi_x_of(s, slot), mspringi_y_of(s, slot)};
}

bool mspringi_pairs_rest(const mspring_network *network, const mspringi_pairs *pairs, const mspringi_pair *pair,
                         double way) {
    const mspringi_outline *o = &pairs->outline;
    const node_place p = place_of(network, pairs, pair->point), a = place_of(network, pairs, o->a[pair->edge]),
                     b = place_of(network, pairs, o->b[pair->edge]);
    const mspringi_nearest at = mspringi_nearest_on(p.x, p.y, a.x, a.y, b.x, b.y);
    const double distance = sqrt(at.x * at.x + at.y * at.y) - mspringi_radius_of(pairs, pair->point, pair->edge);
    return distance <= (1.0 + RESTING_SHARE) * pairs->thickness + way;
}

// The two sides of a pair: islands, and for how long each has been still. A collider that moves never is, and one
// that stands still is no side.
typedef struct pair_sides {
    uint32_t island[2]; // MSPRING_NONE: a collider
    double still[2];
    bool are_two;
} pair_sides;

static pair_sides sides_of(const mspring_network *network, const mspringi_pairs *pairs, const mspringi_pair *pair) {
    const mspring_id nodes[2] = {pair->point, pairs->outline.a[pair->edge]};
    pair_sides s = {.are_two = true};
    for (int i = 0; i < 2; ++i) {
        const bool is_collider = mspringi_is_of_collider(pairs, nodes[i]);
        s.island[i] = is_collider ? MSPRING_NONE : island_of(network, nodes[i]);
        s.still[i] = is_collider ? 0.0 : network->sleep.still[s.island[i]];
        s.are_two &= !is_collider || mspringi_collider_of(pairs, nodes[i])->is_moving;
    }
    return s;
}

// Wake what sleeps where something that is awake comes.
static void wake_touched(mspring_network *network, const mspringi_pairs *pairs) {
    const uint64_t naps = network->edits.naps;
    if (network->sleep.sleeping == 0)
        return;
    for (bool again = true; again;) {
        again = false;
        for (uint32_t i = 0; i < pairs->count; ++i) {
            const pair_sides s = sides_of(network, pairs, &pairs->list[i]);
            if (!s.are_two || (s.still[0] < 0.0) == (s.still[1] < 0.0) ||
                !mspringi_pairs_rest(network, pairs, &pairs->list[i], 2.0 * pairs->dt * pairs->speed))
                continue;
            mspringi_sleep_rouse(network, s.island[s.still[0] < 0.0 ? 0 : 1]);
            again = true;
        }
    }
    mspringi_sleep_roused(network, naps);
}

// Islands that rest on each other have been still for as long as the one that was still for the shortest time: they
// fall asleep together.
static void share_stillness(mspring_network *network, const mspringi_pairs *pairs) {
    if (!(network->settings.sleep_speed > 0.0f) || mspringi_sleep_is_whole(network))
        return;
    mspringi_islands_find(network);
    for (bool again = true; again;) {
        again = false;
        for (uint32_t i = 0; i < pairs->count; ++i) {
            const pair_sides s = sides_of(network, pairs, &pairs->list[i]);
            if (!s.are_two || s.still[0] == s.still[1] || s.still[0] < 0.0 || s.still[1] < 0.0 ||
                !mspringi_pairs_rest(network, pairs, &pairs->list[i], 0.0))
                continue;
            const double least = s.still[0] < s.still[1] ? s.still[0] : s.still[1];
            for (int k = 0; k < 2; ++k)
                if (s.island[k] != MSPRING_NONE)
                    network->sleep.still[s.island[k]] = least;
            again = true;
        }
    }
}

/* ------------------------------------------------------------------------------------------------------ stage */

// Before substeps are taken, or taken once more. Returns whether all pairs have room.
static bool begin_substeps(mspring_network *network, uint32_t substeps) {
    mspringi_pairs *pairs = network->pairs;
    pairs->is_missed = pairs->is_full = pairs->is_crowded = false;
    pairs->taken = pairs->touching = 0;
    pairs->since_look = 0;
    pairs->deepest = pairs->thrown = 0.0;
    mspringi_colliders_begin(network, pairs, substeps);
    return mspringi_near_look(network, pairs);
}

static void before_step(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_pairs *pairs = network->pairs;
    mspringi_outline_follow(network, pairs);
    pairs->h = attempt->h;
    pairs->dt = attempt->dt;
    pairs->is_strict = false;
    pairs->has_sleepers = network->sleep.sleeping > 0;
    if (begin_substeps(network, attempt->substeps))
        wake_touched(network, pairs);
    mspringi_meetings_begin(network, pairs);
}

static bool is_quiet(const mspring_network *network, const mspringi_attempt *attempt) {
    return network->pairs->quiet >= attempt->substeps;
}

static uint32_t free_substeps(const mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    const uint32_t quiet = network->pairs->quiet, left = attempt->substeps - substep;
    return quiet == 0 ? 1 : quiet < left ? quiet : left;
}

static mspringi_field before_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                                     mspringi_field base) {
    mspringi_pairs *pairs = network->pairs;
    (void)attempt;
    pairs->first_substep = substep;
    if (pairs->quiet == 0) {
        mspringi_colliders_place(network, pairs, substep);
        mspringi_rows_begin(network, pairs);
    }
    return base;
}

static void look(mspring_network *network, mspringi_pairs *pairs) {
    pairs->is_fresh = false;
    (void)mspringi_near_look(network, pairs);
}

// After so many quiet substeps: with the speeds that there are now, some pair could have touched.
static void look_back(mspring_network *network, mspringi_pairs *pairs, uint32_t count) {
    const double room = pairs->room;
    look(network, pairs);
    pairs->is_missed |=
        !(2.0 * (double)pairs->h * (double)count * pairs->speed <= room) || pairs->nearest < pairs->thickness;
}

static void after_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    mspringi_pairs *pairs = network->pairs;
    const uint32_t count = substep + 1 - pairs->first_substep;
    pairs->taken += count;
    if (pairs->is_full)
        return;
    pairs->is_fresh = false;
    if (pairs->quiet > 0) {
        pairs->quiet = pairs->quiet > count ? pairs->quiet - count : 0;
        pairs->since_look += count;
        if (pairs->quiet == 0 && pairs->taken < attempt->substeps) {
            look_back(network, pairs, pairs->since_look);
            pairs->since_look = 0;
        }
        return;
    }
    if (network->running->ops->holds_bodies || !mspringi_rows_act(network, pairs) || pairs->is_strict)
        look(network, pairs);
    else if (--pairs->valid == 0 && pairs->taken < attempt->substeps) // a step begins with a look
        (void)mspringi_near_renew(network, pairs);
}

// The last substeps may have been quiet; all were, if they were taken at once.
static bool has_missed(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_pairs *pairs = network->pairs;
    const uint32_t count = pairs->taken == 0 ? attempt->substeps : pairs->since_look;
    pairs->taken = attempt->substeps;
    if (count > 0 && !pairs->is_full)
        look_back(network, pairs, count);
    if (!pairs->is_missed || pairs->is_strict || pairs->is_full)
        return false;
    pairs->is_strict = true;
    return true;
}

static mspring_result judge(mspring_network *network) {
    const mspringi_pairs *pairs = network->pairs;
    if (!pairs->is_full && !pairs->is_crowded)
        return MSPRING_OK;
    return mspringi_fail(&network->message, MSPRING_ERROR_LIMIT,
                         "more than %u pairs of an outline point and an outline edge %s each other: set "
                         "contact with a larger capacity, or less thickness",
                         (unsigned)(pairs->is_full ? pairs->capacity : pairs->row_capacity),
                         pairs->is_full ? "are near" : "may touch");
}

// The state is that of before the step. If the step is repeated, perhaps for another stage, it begins with a look.
static void take_back(mspring_network *network) {
    mspringi_pairs *pairs = network->pairs;
    pairs->is_fresh = false;
    mspringi_meetings_forget_step(pairs);
    (void)begin_substeps(network, pairs->colliders.substeps);
}

static void after_step(mspring_network *network, double dt) {
    mspringi_pairs *pairs = network->pairs;
    (void)dt;
    pairs->is_fresh &= !(network->outcome.flags & MSPRING_STEP_PUT_BACK);
    mspringi_colliders_place(network, pairs, pairs->colliders.substeps);
    share_stillness(network, pairs);
    mspringi_meetings_end(network, pairs);
    mspringi_colliders_end(network, pairs);
}

const mspringi_stage mspringi_stage_pairs = {.is_used = is_used,
                                             .moves = moves,
                                             .writes_state = true,
                                             .before_step = before_step,
                                             .is_quiet = is_quiet,
                                             .free_substeps = free_substeps,
                                             .before_substep = before_substep,
                                             .after_substep = after_substep,
                                             .has_missed = has_missed,
                                             .judge = judge,
                                             .take_back = take_back,
                                             .after_step = after_step};

/// The stage of springs that only pull or only push.
///
/// Before each substep it looks which of them act in it, and sets stiffness and damping of the others to 0 until
/// the step is over: so all solvers, and springs of all kinds of rows, know of it. Outside of a step their records
/// have what the host gave.
///
/// An explicit substep has the forces of its start, where a spring acts if it is on its side of the rest length and
/// the sum of both its forces is. Implicit ones have those of their end: a spring acts if it is expected to be on
/// its side there. A rope that begins to fall is not seen to tighten by that. So where a spring that did not act
/// was on its side in the end, the step is taken once more, and the spring acts in that substep. (A slack rope of
/// 32 links was strained by 84 % by its first jerk without that.)
#include <math.h>

#include "base/assert.h"
#include "features/one_way/one_way.h"
#include "store/feature.h"
#include "store/id_pool.h"
#include "store/sleepers.h"
#include "store/springs.h"
#include "store/stages.h"

static bool is_quiet(const mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    return mspringi_sleep_is_whole(network);
}

/// How much longer than its rest length a spring is, m, and how fast that grows, m/s.
typedef struct stretch {
    double length, rate;
} stretch;

static stretch stretch_of(const mspring_network *network, const mspringi_one_way_spring *spring) {
    const mspringi_state *s = &network->state;
    const uint32_t base = spring->base, tip = spring->tip;
    const double dx = mspringi_x_of(s, tip) - mspringi_x_of(s, base);
    const double dy = mspringi_y_of(s, tip) - mspringi_y_of(s, base);
    const double dvx = (double)s->vx[tip] - (double)s->vx[base];
    const double dvy = (double)s->vy[tip] - (double)s->vy[base];
    const double length = sqrt(dx * dx + dy * dy);
    return (stretch){length - (double)spring->rest_length, length > 0.0 ? (dvx * dx + dvy * dy) / length : 0.0};
}

// What a root would tell, for most of those that are slack: a limit beside another spring nearly always is.
// (Without, a cloth of 60x60 with limits both ways took 2.9 times as long.)
static bool is_slack_by_far(const mspring_network *network, const mspringi_one_way_spring *spring) {
    const mspringi_state *s = &network->state;
    const double dx = mspringi_x_of(s, spring->tip) - mspringi_x_of(s, spring->base);
    const double dy = mspringi_y_of(s, spring->tip) - mspringi_y_of(s, spring->base);
    const double square = dx * dx + dy * dy, rest = (double)spring->rest_length, border = rest * rest;
    return spring->side > 0 ? square < border * (1.0 - 1e-9) : square > border * (1.0 + 1e-9);
}

static void activate(mspring_network *network, mspringi_one_way_spring *spring, bool acts) {
    if (spring->acts == acts)
        return;
    MSPRINGI_ASSERT(mspringi_spring_slot_is_live(network, spring->spring_slot));
    spring->acts = acts;
    mspringi_spring_slot_set(network, spring->spring_slot, acts ? spring->stiffness : 0.0f,
                             acts ? spring->damping : 0.0f);
}

static void activate_all(mspring_network *network) {
    mspringi_one_way *one_way = network->one_way;
    for (uint32_t i = 0; i < one_way->listed; ++i)
        activate(network, &one_way->list[i], true);
}

static void before_step(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_one_way *one_way = network->one_way;
    const mspringi_topology *t = &network->topology;
    (void)attempt;
    one_way->listed = 0;
    one_way->must_repeat = one_way->is_repeated = false;
    for (mspring_id s = 0; s < t->reserve.first_spring; ++s) {
        if (network->side[s] == 0 || !mspringi_spring_exists(network, s))
            continue;
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(t, s);
        const mspringi_spring_values values = mspringi_spring_slot_get(network, spring_slot);
        if (mspringi_spring_slot_is_live(network, spring_slot))
            one_way->list[one_way->listed++] =
                (mspringi_one_way_spring){.spring_slot = spring_slot,
                                          .base = values.base,
                                          .tip = values.tip,
                                          .rest_length = mspringi_read_length(values.rest_length),
                                          .stiffness = values.stiffness,
                                          .damping = values.damping,
                                          .due = MSPRING_NONE,
                                          .side = network->side[s],
                                          .acts = true};
    }
}

// Ramps and actuators change them from one substep to the next, and so does yielding.
static void follow_rest_lengths(mspring_network *network) {
    mspringi_one_way *one_way = network->one_way;
    if (!mspringi_features_change_lengths(network) && !network->tested.nominal)
        return;
    for (uint32_t i = 0; i < one_way->listed; ++i)
        one_way->list[i].rest_length =
            mspringi_read_length(mspringi_spring_slot_get(network, one_way->list[i].spring_slot).rest_length);
}

static mspringi_field before_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                                     mspringi_field base) {
    mspringi_one_way *one_way = network->one_way;
    const bool is_explicit = attempt->solver->ops->has_stability_limit;
    const double ahead = is_explicit ? 0.0 : (double)attempt->h;
    follow_rest_lengths(network);
    for (uint32_t i = 0; i < one_way->listed; ++i) {
        mspringi_one_way_spring *spring = &one_way->list[i];
        if (is_explicit && is_slack_by_far(network, spring)) {
            activate(network, spring, false);
            continue;
        }
        const stretch now = stretch_of(network, spring);
        const double there = now.length + ahead * now.rate, side = (double)spring->side;
        const double force = (double)spring->stiffness * there + (double)spring->damping * now.rate;
        activate(network, spring, spring->due == substep || (side * there > 0.0 && side * force > 0.0));
    }
    return base;
}

static void after_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    mspringi_one_way *one_way = network->one_way;
    if (attempt->solver->ops->has_stability_limit)
        return;
    follow_rest_lengths(network);
    for (uint32_t i = 0; i < one_way->listed; ++i) {
        mspringi_one_way_spring *spring = &one_way->list[i];
        if (spring->acts || spring->due != MSPRING_NONE ||
            !((double)spring->side * stretch_of(network, spring).length > 0.0))
            continue;
        spring->due = substep;
        one_way->must_repeat = true;
    }
}

// Once: those that tighten in the second run are let be.
static bool must_repeat(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_one_way *one_way = network->one_way;
    (void)attempt;
    if (!one_way->must_repeat || one_way->is_repeated)
        return false;
    one_way->is_repeated = true;
    return true;
}

// Before the guard looks at them.
static mspring_result verify(mspring_network *network) {
    activate_all(network);
    return MSPRING_OK;
}

static void after_step(mspring_network *network, double dt) {
    (void)dt;
    activate_all(network);
}

static void undo(mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    activate_all(network);
}

const mspringi_stage mspringi_stage_one_way = {.is_used = mspringi_one_way_is_used,
                                               .before_step = before_step,
                                               .is_quiet = is_quiet,
                                               .before_substep = before_substep,
                                               .after_substep = after_substep,
                                               .must_repeat = must_repeat,
                                               .verify = verify,
                                               .after_step = after_step,
                                               .roll_back = activate_all,
                                               .undo = undo};

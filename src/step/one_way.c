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

#include "sleep/sleep.h"
#include "store/growth.h"
#include "store/one_way.h"
#include "store/springs.h"
#include "store/stages.h"

static bool is_used(const mspring_network *network) {
    return network->one_way.side != NULL;
}

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
    const mspringi_spring_values values = mspringi_place_get(network, spring->place);
    const double dx = mspringi_x_of(s, values.tip) - mspringi_x_of(s, values.base);
    const double dy = mspringi_y_of(s, values.tip) - mspringi_y_of(s, values.base);
    const double dvx = (double)s->vx[values.tip] - (double)s->vx[values.base];
    const double dvy = (double)s->vy[values.tip] - (double)s->vy[values.base];
    const double length = sqrt(dx * dx + dy * dy);
    return (stretch){length - (double)mspringi_read_length(values.rest_length),
                     length > 0.0 ? (dvx * dx + dvy * dy) / length : 0.0};
}

static void let_act(mspring_network *network, mspringi_one_way_spring *spring, bool acts) {
    if (spring->acts == acts)
        return;
    spring->acts = acts;
    mspringi_place_set(network, spring->place, acts ? spring->stiffness : 0.0f, acts ? spring->damping : 0.0f);
}

static void let_all_act(mspring_network *network) {
    mspringi_one_way *one_way = &network->one_way;
    for (uint32_t i = 0; i < one_way->listed; ++i)
        let_act(network, &one_way->list[i], true);
}

static void before_step(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_one_way *one_way = &network->one_way;
    const mspringi_topology *t = &network->topology;
    (void)attempt;
    one_way->listed = 0;
    one_way->has_missed = false;
    for (mspring_id s = 0; s < t->reserve.first_spring; ++s) {
        if (one_way->side[s] == 0 || !mspringi_spring_exists(network, s))
            continue;
        const mspringi_place place = mspringi_place_of(t, s);
        const mspringi_spring_values values = mspringi_place_get(network, place);
        if (mspringi_place_is_live(network, place))
            one_way->list[one_way->listed++] = (mspringi_one_way_spring){.place = place,
                                                                         .stiffness = values.stiffness,
                                                                         .damping = values.damping,
                                                                         .due = MSPRING_NONE,
                                                                         .side = one_way->side[s],
                                                                         .acts = true};
    }
}

static mspringi_field before_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                                     mspringi_field base) {
    mspringi_one_way *one_way = &network->one_way;
    const double ahead = attempt->solver->ops->has_border ? 0.0 : (double)attempt->h;
    for (uint32_t i = 0; i < one_way->listed; ++i) {
        mspringi_one_way_spring *spring = &one_way->list[i];
        const stretch now = stretch_of(network, spring);
        const double there = now.length + ahead * now.rate, side = (double)spring->side;
        const double force = (double)spring->stiffness * there + (double)spring->damping * now.rate;
        let_act(network, spring, spring->due == substep || (side * there > 0.0 && side * force > 0.0));
    }
    return base;
}

static void after_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    mspringi_one_way *one_way = &network->one_way;
    for (uint32_t i = 0; !attempt->solver->ops->has_border && i < one_way->listed; ++i) {
        mspringi_one_way_spring *spring = &one_way->list[i];
        if (spring->acts || spring->due != MSPRING_NONE ||
            !((double)spring->side * stretch_of(network, spring).length > 0.0))
            continue;
        spring->due = substep;
        one_way->has_missed = true;
    }
}

static bool has_missed(mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    return network->one_way.has_missed;
}

// Before the guard looks at them.
static mspring_result judge(mspring_network *network) {
    let_all_act(network);
    return MSPRING_OK;
}

static void after_step(mspring_network *network, double dt) {
    (void)dt;
    let_all_act(network);
}

static void undo(mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    let_all_act(network);
}

const mspringi_stage mspringi_stage_one_way = {.is_used = is_used,
                                               .before_step = before_step,
                                               .is_quiet = is_quiet,
                                               .before_substep = before_substep,
                                               .after_substep = after_substep,
                                               .has_missed = has_missed,
                                               .judge = judge,
                                               .after_step = after_step,
                                               .take_back = let_all_act,
                                               .undo = undo};

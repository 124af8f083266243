/// The stage of grips, and what they do after a substep of symplectic Euler.
///
/// Such a substep has moved the particle to p* = p + h v* with the velocity v* that all other forces give it. A
/// grip changes the velocity to v, and the position to p* + h (v - v*), by the force that it has then:
///
///     m (v - v*) = h F,    F = k (t - p* - h (v - v*)) + c (u - v)
///     F = (k (t - p*) + c (u - v*)) / (1 + (h c + h^2 k) / m)
///
/// t and u being place and velocity of the target at the end of the substep. It is the soft constraint of Box2D
/// (Catto, "Soft Constraints", 2011), with softness and bias written out. The particle is as if its mass were m + h
/// c + h^2 k, so what is stable without the grip is stable with it. A force that is bounded is a smaller one,
/// towards the same place: no particle overshoots by it that would not without.
#include <math.h>

#include "contact/floor.h"
#include "contact/grips.h"
#include "store/stages.h"

static bool is_used(const mspring_network *network) {
    return network->grips.count > 0;
}

static bool any_acts(const mspring_network *network) {
    uint32_t slot;
    bool any = false;
    for (uint32_t i = 0; i < MSPRING_MAX_GRIPS; ++i)
        any |= mspringi_grip_acts(network, &network->grips.list[i], &slot);
    return any;
}

static void forget_sums(mspring_network *network) {
    network->grips.were_asked = false;
    for (uint32_t i = 0; i < MSPRING_MAX_GRIPS; ++i)
        network->grips.list[i].sum_x = network->grips.list[i].sum_y = 0.0;
}

static void before_step(mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    forget_sums(network);
}

// Nothing that sleeps or is pinned feels it.
static bool is_quiet(const mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    return !any_acts(network);
}

static mspringi_field before_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                                     mspringi_field base) {
    mspringi_grips *grips = &network->grips;
    grips->were_asked = true;
    grips->h = attempt->h;
    grips->share = 1.0 / (double)attempt->substeps;
    grips->begin = (double)substep * grips->share;
    grips->passed = 0.0;
    return base;
}

// What the surface takes of the pull that a grip has moved a particle by.
static void collide(const mspring_network *network, uint32_t slot, mspringi_body *body, double h) {
    mspringi_floor *floor = network->floor;
    const double vx = body->vx, vy = body->vy, mass = 1.0 / (double)network->inverse_mass[slot];
    mspringi_floor_follow(floor, network->origin_x, network->origin_y);
    mspringi_floor_collide(floor, body, h);
    floor->impulse.x[slot] += (float)(mass * (body->vx - vx));
    floor->impulse.y[slot] += (float)(mass * (body->vy - vy));
    floor->has_impulse |= body->vx != vx || body->vy != vy;
}

static void pull(mspring_network *network, mspringi_grip *grip, uint32_t slot) {
    const mspringi_grips *grips = &network->grips;
    const mspringi_state *s = &network->state;
    const mspringi_aim to = mspringi_grip_aim(network, grip, grips->begin + grips->share);
    const double h = (double)grips->h, k = (double)grip->stiffness, c = (double)grip->damping;
    const double by = (double)mspringi_free_mass(network)[slot], share = 1.0 / (1.0 + h * (c + h * k) * by);
    const double x = mspringi_x_of(s, slot), y = mspringi_y_of(s, slot);
    const double vx = (double)s->vx[slot], vy = (double)s->vy[slot];
    double fx = share * (k * (to.x - x) + c * (to.vx - vx)), fy = share * (k * (to.y - y) + c * (to.vy - vy));
    (void)mspringi_grip_bound(grip, &fx, &fy);
    mspringi_body body = {.start_x = x, .start_y = y, .vx = vx + h * by * fx, .vy = vy + h * by * fy};
    body.x = x + h * (h * by * fx);
    body.y = y + h * (h * by * fy);
    grip->sum_x += h * fx;
    grip->sum_y += h * fy;
    if (network->floor)
        collide(network, slot, &body, h);
    s->vx[slot] = (float)body.vx;
    s->vy[slot] = (float)body.vy;
    mspringi_set_x(s, slot, body.x);
    mspringi_set_y(s, slot, body.y);
}

static void after_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    const mspringi_solver *solver = attempt->solver;
    uint32_t slot;
    (void)substep;
    for (uint32_t i = 0; i < MSPRING_MAX_GRIPS; ++i) {
        mspringi_grip *grip = &network->grips.list[i];
        if (mspringi_grip_acts(network, grip, &slot) &&
            !(solver->ops->holds_grips && !solver->ops->is_alone(network, solver->object, slot)))
            pull(network, grip, slot);
    }
}

// What slept when the step began may have woken in it.
static bool has_missed(mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    return !network->grips.were_asked && any_acts(network);
}

static void after_step(mspring_network *network, double dt) {
    (void)dt;
    mspringi_grips_arrive(network);
}

const mspringi_stage mspringi_stage_grips = {.is_used = is_used,
                                             .before_step = before_step,
                                             .is_quiet = is_quiet,
                                             .before_substep = before_substep,
                                             .after_substep = after_substep,
                                             .has_missed = has_missed,
                                             .take_back = forget_sums,
                                             .after_step = after_step};

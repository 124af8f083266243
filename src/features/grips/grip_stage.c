/// The stage of grips, and what they do after a leapfrog substep.
///
/// Such a substep has moved the particle to p* = p + h v* with the velocity v* that all other forces give it. A
/// grip changes the velocity to v, and the position to p* + h (v - v*), by the force that it has then:
///
///     m (v - v*) = h F,    F = k (t - p* - h (v - v*)) + c (u - v)
///     F = (k (t - p*) + c (u - v*)) / (1 + (h c + h^2 k) / m)
///
/// t and u being place and velocity of the target at the end of the substep. Of several that hold one particle k, c
/// and forces add up. It is the soft constraint of Box2D
/// (Catto, "Soft Constraints", 2011), with softness and bias written out. The particle is as if its mass were m + h
/// c + h^2 k, so what is stable without the grip is stable with it. The force of one that is bounded is a smaller
/// one, towards the same place: no particle overshoots by it that would not without. Of several, each acts with the
/// part of k and c that keeps its force within its bound at the end of the substep.
#include <math.h>

#include "features/contact/floor.h"
#include "features/grips/grips.h"
#include "store/feature.h"
#include "store/stages.h"

static bool is_used(const mspring_network *network) {
    return mspringi_grip_count(network) > 0;
}

static bool any_active(const mspring_network *network) {
    uint32_t slot;
    bool any = false;
    for (uint32_t i = 0; i < mspringi_grip_count(network); ++i)
        any |= mspringi_grip_is_active(network, &network->grips->list[i], &slot);
    return any;
}

void mspringi_grips_discard_step(mspring_network *network) {
    if (network->grips)
        network->grips->could_act = false;
    for (uint32_t i = 0; i < mspringi_grip_count(network); ++i)
        network->grips->list[i].sum_x = network->grips->list[i].sum_y = 0.0;
}

static void before_step(mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    mspringi_grips_discard_step(network);
}

// Nothing that sleeps or is pinned feels it.
static bool is_quiet(const mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    return !any_active(network);
}

// Grips that do nothing part no substeps: particles without springs would round otherwise for them.
static uint32_t free_substeps(const mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    return any_active(network) ? 1 : attempt->substeps - substep;
}

static mspringi_field before_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                                     mspringi_field base) {
    mspringi_grips *grips = network->grips;
    grips->could_act |= any_active(network);
    grips->h = attempt->h;
    grips->share = 1.0 / (double)attempt->substeps;
    grips->begin = (double)substep * grips->share;
    grips->passed = 0.0;
    return base;
}

// Remove the part of a grip's displacement that the surface stops.
static void collide(const mspring_network *network, uint32_t slot, mspringi_moved_particle *body, double h) {
    mspringi_floor *floor = network->floor;
    const double vx = body->vx, vy = body->vy, mass = 1.0 / (double)network->inverse_mass[slot];
    mspringi_floor_set_origin(floor, network->origin_x, network->origin_y);
    mspringi_floor_collide(floor, body, h);
    floor->impulse.x[slot] += (float)(mass * (body->vx - vx));
    floor->impulse.y[slot] += (float)(mass * (body->vy - vy));
    floor->has_impulse |= body->vx != vx || body->vy != vy;
}

typedef struct mspringi_force {
    double x, y;
} mspringi_force;

// Grips that hold one particle, and what it does but for them. They act together: one after another, each would
// undo what stiffer ones did, and give energy.
typedef struct mspringi_grips_of_particle {
    mspringi_grip *grips[MSPRING_MAX_GRIPS];
    mspringi_grip_target targets[MSPRING_MAX_GRIPS];
    mspringi_force forces[MSPRING_MAX_GRIPS];
    double part[MSPRING_MAX_GRIPS]; // of stiffness and damping that act, for the force to be within its bound
    uint32_t count;
    double x, y, vx, vy, by, h;
} mspringi_grips_of_particle;

// Resistance of a grip to velocity over a substep, as a part of the particle's own.
static double resistance(const mspringi_grips_of_particle *hold, uint32_t i) {
    const mspringi_grip *grip = hold->grips[i];
    return hold->h * ((double)grip->damping + hold->h * (double)grip->stiffness) * hold->by * hold->part[i];
}

// The force of one grip, unbounded, if the particle does not feel it.
static mspringi_force force_at_start(const mspringi_grips_of_particle *hold, uint32_t i) {
    const double k = (double)hold->grips[i]->stiffness, c = (double)hold->grips[i]->damping;
    const mspringi_grip_target *to = &hold->targets[i];
    return (mspringi_force){k * (to->x - hold->x) + c * (to->vx - hold->vx),
                            k * (to->y - hold->y) + c * (to->vy - hold->vy)};
}

// The force of one grip at the end of the substep, out of what all would exert now: by others, so that none cancels
// where grips are very stiff.
static mspringi_force force_of(const mspringi_grips_of_particle *hold, uint32_t which, const mspringi_force *now,
                               double share) {
    mspringi_force others = {0.0, 0.0};
    double firmness = 0.0;
    for (uint32_t i = 0; i < hold->count; ++i) {
        if (i == which)
            continue;
        others.x += now[i].x;
        others.y += now[i].y;
        firmness += resistance(hold, i);
    }
    const double own = resistance(hold, which);
    return (mspringi_force){share * (now[which].x + (firmness * now[which].x - own * others.x)),
                            share * (now[which].y + (firmness * now[which].y - own * others.y))};
}

// All forces at the end of the substep. Returns their sum.
static mspringi_force solve(mspringi_grips_of_particle *hold) {
    mspringi_force now[MSPRING_MAX_GRIPS], sum = {0.0, 0.0};
    double firmness = 0.0;
    for (uint32_t i = 0; i < hold->count; ++i) {
        const mspringi_force whole = force_at_start(hold, i);
        now[i] = (mspringi_force){hold->part[i] * whole.x, hold->part[i] * whole.y};
        sum.x += now[i].x;
        sum.y += now[i].y;
        firmness += resistance(hold, i);
    }
    const double share = 1.0 / (1.0 + firmness);
    for (uint32_t i = 0; i < hold->count; ++i)
        hold->forces[i] = force_of(hold, i, now, share);
    return (mspringi_force){share * sum.x, share * sum.y};
}

/// Times at most that parts are found anew, and a change of a part that is none. Of 200,000 holds of 2 to 5 random
/// grips 2 % need more than 32, and 64 bring all within 6 % of their bounds.
#define MOST_PASSES 64
#define SAME_PART 1e-7

/// The least part: a stiffness that is next to nothing, but no division by 0.
#define LEAST_PART 1e-30

// The force of one grip within its bound.
static mspringi_force solve_one(mspringi_grips_of_particle *hold) {
    const mspringi_force sum = solve(hold);
    return mspringi_grip_bound(hold->grips[0], &hold->forces[0].x, &hold->forces[0].y) ? hold->forces[0] : sum;
}

// The part of its stiffness and damping that keeps a grip within its bound, if all of them give this force.
static double part_of(const mspringi_grip *grip, mspringi_force force) {
    const double size = sqrt(force.x * force.x + force.y * force.y), most = (double)grip->max_force;
    const double part = size > most ? most / size : 1.0;
    return part > LEAST_PART ? part : LEAST_PART;
}

// Find the parts anew by the forces that they led to. Returns whether any is another.
static bool find_parts(mspringi_grips_of_particle *hold) {
    bool any = false;
    for (uint32_t i = 0; i < hold->count; ++i) {
        const double had = hold->part[i];
        const mspringi_force whole = {hold->forces[i].x / had, hold->forces[i].y / had};
        hold->part[i] = part_of(hold->grips[i], whole);
        any |= fabs(hold->part[i] - had) > SAME_PART * had;
    }
    return any;
}

// Shrink all forces alike until each is within its bound: less of a change that takes energy takes energy, too.
static mspringi_force shrink(mspringi_grips_of_particle *hold, mspringi_force sum) {
    double least = 1.0;
    for (uint32_t i = 0; i < hold->count; ++i) {
        const double part = part_of(hold->grips[i], hold->forces[i]);
        least = part < least ? part : least;
    }
    for (uint32_t i = 0; i < hold->count; ++i) {
        hold->forces[i].x *= least;
        hold->forces[i].y *= least;
    }
    return (mspringi_force){least * sum.x, least * sum.y};
}

// Forces of several within their bounds: iteratively reweighted least squares (Huber 1981). The parts begin as if
// the particle stayed where it is, so the energy of all, with that of the bounds, falls from there in each pass.
static mspringi_force solve_bounded(mspringi_grips_of_particle *hold) {
    if (hold->count == 1)
        return solve_one(hold);
    for (uint32_t i = 0; i < hold->count; ++i)
        hold->part[i] = part_of(hold->grips[i], force_at_start(hold, i));
    mspringi_force sum = solve(hold);
    for (int pass = 0; pass < MOST_PASSES && find_parts(hold); ++pass)
        sum = solve(hold);
    return shrink(hold, sum);
}

static void apply_grips(mspring_network *network, mspringi_grips_of_particle *hold, uint32_t slot) {
    const mspringi_state *s = &network->state;
    const double h = hold->h = (double)network->grips->h;
    hold->by = (double)mspringi_active_inverse_mass(network)[slot];
    hold->x = mspringi_x_of(s, slot);
    hold->y = mspringi_y_of(s, slot);
    hold->vx = (double)s->vx[slot];
    hold->vy = (double)s->vy[slot];
    const mspringi_force force = solve_bounded(hold);
    const double vx = h * hold->by * force.x, vy = h * hold->by * force.y;
    mspringi_moved_particle body = {
        .start_x = hold->x, .start_y = hold->y, .vx = hold->vx + vx, .vy = hold->vy + vy};
    body.x = hold->x + h * vx;
    body.y = hold->y + h * vy;
    for (uint32_t i = 0; i < hold->count; ++i) {
        hold->grips[i]->sum_x += h * hold->forces[i].x;
        hold->grips[i]->sum_y += h * hold->forces[i].y;
    }
    if (network->floor)
        collide(network, slot, &body, h);
    s->vx[slot] = (float)body.vx;
    s->vy[slot] = (float)body.vy;
    mspringi_set_x(s, slot, body.x);
    mspringi_set_y(s, slot, body.y);
}

// Collect all grips on one particle. Empty unless `first` is the first of them, so each particle is visited once.
static void collect_grips(mspring_network *network, uint32_t first, mspringi_grips_of_particle *hold) {
    mspringi_grips *grips = network->grips;
    hold->count = 0;
    for (uint32_t i = 0; i < grips->count; ++i) {
        mspringi_grip *grip = &grips->list[i];
        if (grip->particle != grips->list[first].particle)
            continue;
        if (i < first)
            return;
        hold->grips[hold->count] = grip;
        hold->targets[hold->count] = mspringi_grip_target_at(network, grip, grips->begin + grips->share);
        hold->part[hold->count++] = 1.0;
    }
}

static void after_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    const mspringi_solver *solver = attempt->solver;
    uint32_t slot;
    (void)substep;
    for (uint32_t i = 0; network->grips->could_act && i < mspringi_grip_count(network); ++i) {
        if (mspringi_grip_is_active(network, &network->grips->list[i], &slot) &&
            !(solver->ops->has_implicit_grips && !solver->ops->is_isolated(network, solver->object, slot))) {
            mspringi_grips_of_particle hold;
            collect_grips(network, i, &hold);
            if (hold.count > 0)
                apply_grips(network, &hold, slot);
        }
    }
}

// Islands asleep at the beginning of the step may have woken since.
static bool must_repeat(mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    return !network->grips->could_act && any_active(network);
}

static void after_step(mspring_network *network, double dt) {
    (void)dt;
    mspringi_grips_finish_step(network);
}

const mspringi_stage mspringi_stage_grips = {.is_used = is_used,
                                             .before_step = before_step,
                                             .is_quiet = is_quiet,
                                             .free_substeps = free_substeps,
                                             .before_substep = before_substep,
                                             .after_substep = after_substep,
                                             .must_repeat = must_repeat,
                                             .roll_back = mspringi_grips_discard_step,
                                             .after_step = after_step};

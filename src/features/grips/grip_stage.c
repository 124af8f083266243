/// Stage of grips, and their action after an explicit substep.
///
/// The substep has moved the particle to p* = p + h v*. Its velocity v* has all other forces in it. A grip changes
/// the velocity to v and the position to p* + h (v - v*), by its force F at the end of the substep:
///
///     m (v - v*) = h F,    F = k (t - p* - h (v - v*)) + c (u - v)
///     F = (k (t - p*) + c (u - v*)) / (1 + (h c + h^2 k) / m)
///
/// t and u are position and velocity of the target then, k and c the grip's stiffness and damping. It is the soft
/// constraint of Box2D (Catto, "Soft Constraints", 2011), with softness and bias written out. The particle moves as
/// if its mass were m + h c + h^2 k, so a grip makes no substep unstable.
///
/// Several grips on one particle add up k, c and forces. A bound makes the force of a single grip smaller, in the
/// same direction, so the particle does not overshoot. Of several, each acts with the *part* of k and c that keeps
/// its force within its bound.
///
/// In the order of a particle: collect_grips(), apply_grips(), solve_bounded(), and collide() with the floor.
#include <math.h>

#include "base/assert.h"
#include "features/contact/floor.h"
#include "features/grips/grips.h"
#include "store/feature.h"
#include "store/stages.h"

bool mspringi_grips_act(const mspring_network *network) {
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

// Grips on sleeping and pinned particles do nothing.
static bool is_quiet(const mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    return !any_active(network);
}

// Inactive grips do not divide substeps: isolated particles, which take several at once, would round otherwise.
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

// Grips on one particle, and its state without them. They are solved together: one after the other, each would undo
// the action of stiffer ones, and add energy.
typedef struct mspringi_grips_of_particle {
    mspringi_grip *grips[MSPRING_MAX_GRIPS];
    mspringi_grip_target targets[MSPRING_MAX_GRIPS];
    mspringi_force forces[MSPRING_MAX_GRIPS];
    double part[MSPRING_MAX_GRIPS]; // share of stiffness and damping that acts
    uint32_t count;
    double x, y, vx, vy, inverse_mass, h;
} mspringi_grips_of_particle;

// Resistance of a grip to velocity over a substep, as a part of the particle's own.
static double resistance(const mspringi_grips_of_particle *held, uint32_t i) {
    const mspringi_grip *grip = held->grips[i];
    return held->h * ((double)grip->damping + held->h * (double)grip->stiffness) * held->inverse_mass *
           held->part[i];
}

// Force of one grip, unbounded, at the state without grips.
static mspringi_force force_at_start(const mspringi_grips_of_particle *held, uint32_t i) {
    const double k = (double)held->grips[i]->stiffness, c = (double)held->grips[i]->damping;
    const mspringi_grip_target *to = &held->targets[i];
    return (mspringi_force){k * (to->x - held->x) + c * (to->vx - held->vx),
                            k * (to->y - held->y) + c * (to->vy - held->vy)};
}

// Force of one grip at the end of the substep, from the forces of all at the state without grips. Written as a
// difference from the others, so that it does not cancel if grips are very stiff.
static mspringi_force force_of(const mspringi_grips_of_particle *held, uint32_t which, const mspringi_force *now,
                               double share) {
    mspringi_force others = {0.0, 0.0};
    double sum_resistance = 0.0;
    for (uint32_t i = 0; i < held->count; ++i) {
        if (i == which)
            continue;
        others.x += now[i].x;
        others.y += now[i].y;
        sum_resistance += resistance(held, i);
    }
    const double own = resistance(held, which);
    return (mspringi_force){share * (now[which].x + (sum_resistance * now[which].x - own * others.x)),
                            share * (now[which].y + (sum_resistance * now[which].y - own * others.y))};
}

// Find all forces at the end of the substep, with the present parts. Return their sum.
static mspringi_force solve(mspringi_grips_of_particle *held) {
    mspringi_force now[MSPRING_MAX_GRIPS], sum = {0.0, 0.0};
    double sum_resistance = 0.0;
    for (uint32_t i = 0; i < held->count; ++i) {
        const mspringi_force whole = force_at_start(held, i);
        now[i] = (mspringi_force){held->part[i] * whole.x, held->part[i] * whole.y};
        sum.x += now[i].x;
        sum.y += now[i].y;
        sum_resistance += resistance(held, i);
    }
    const double share = 1.0 / (1.0 + sum_resistance);
    for (uint32_t i = 0; i < held->count; ++i)
        held->forces[i] = force_of(held, i, now, share);
    return (mspringi_force){share * sum.x, share * sum.y};
}

/// Most updates of the parts, and relative change of a part that ends them. Of 200,000 sets of 2 to 5 random grips,
/// 2 % need more than 32 updates; 64 bring all within 6 % of their bounds.
#define MOST_PASSES 64
#define SAME_PART 1e-7

/// Smallest part: next to no stiffness, but no division by 0.
#define LEAST_PART 1e-30

// Force of a single grip, within its bound.
static mspringi_force solve_one(mspringi_grips_of_particle *held) {
    const mspringi_force sum = solve(held);
    return mspringi_grip_bound(held->grips[0], &held->forces[0].x, &held->forces[0].y) ? held->forces[0] : sum;
}

// Part of its stiffness and damping that keeps a grip within its bound, if all of it would give this force.
static double part_of(const mspringi_grip *grip, mspringi_force force) {
    const double size = sqrt(force.x * force.x + force.y * force.y), most = (double)grip->max_force;
    const double part = size > most ? most / size : 1.0;
    return part > LEAST_PART ? part : LEAST_PART;
}

// Update the parts by the forces that they gave. Return true if any changed.
static bool update_parts(mspringi_grips_of_particle *held) {
    bool any = false;
    for (uint32_t i = 0; i < held->count; ++i) {
        const double had = held->part[i];
        const mspringi_force whole = {held->forces[i].x / had, held->forces[i].y / had};
        held->part[i] = part_of(held->grips[i], whole);
        any |= fabs(held->part[i] - had) > SAME_PART * had;
    }
    return any;
}

// Scale all forces down equally until each is within its bound. A smaller share of a change that takes energy takes
// energy, too.
static mspringi_force scale_down(mspringi_grips_of_particle *held, mspringi_force sum) {
    double least = 1.0;
    for (uint32_t i = 0; i < held->count; ++i) {
        const double part = part_of(held->grips[i], held->forces[i]);
        least = part < least ? part : least;
    }
    for (uint32_t i = 0; i < held->count; ++i) {
        held->forces[i].x *= least;
        held->forces[i].y *= least;
    }
    return (mspringi_force){least * sum.x, least * sum.y};
}

// Find all forces within their bounds: iteratively reweighted least squares (Huber 1981). The parts begin as if the
// particle did not move. From there the energy of all grips, bounds included, falls with each pass.
static mspringi_force solve_bounded(mspringi_grips_of_particle *held) {
    if (held->count == 1)
        return solve_one(held);
    for (uint32_t i = 0; i < held->count; ++i)
        held->part[i] = part_of(held->grips[i], force_at_start(held, i));
    mspringi_force sum = solve(held);
    for (int pass = 0; pass < MOST_PASSES && update_parts(held); ++pass)
        sum = solve(held);
    return scale_down(held, sum);
}

// Apply grips to their particle, and the floor to their displacement.
static void apply_grips(mspring_network *network, mspringi_grips_of_particle *held, uint32_t slot) {
    const mspringi_state *s = &network->state;
    const double h = held->h = (double)network->grips->h;
    held->inverse_mass = (double)mspringi_active_inverse_mass(network)[slot];
    held->x = mspringi_x_of(s, slot);
    held->y = mspringi_y_of(s, slot);
    held->vx = (double)s->vx[slot];
    held->vy = (double)s->vy[slot];
    const mspringi_force force = solve_bounded(held);
    const double vx = h * held->inverse_mass * force.x, vy = h * held->inverse_mass * force.y;
    mspringi_moved_particle body = {.start_x = held->x,
                                    .start_y = held->y,
                                    .vx = held->vx + vx,
                                    .vy = held->vy + vy,
                                    .own = mspringi_own_of(network, slot)};
    body.x = held->x + h * vx;
    body.y = held->y + h * vy;
    for (uint32_t i = 0; i < held->count; ++i) {
        held->grips[i]->sum_x += h * held->forces[i].x;
        held->grips[i]->sum_y += h * held->forces[i].y;
    }
    if (network->floor)
        collide(network, slot, &body, h);
    s->vx[slot] = (float)body.vx;
    s->vy[slot] = (float)body.vy;
    mspringi_set_x(s, slot, body.x);
    mspringi_set_y(s, slot, body.y);
}

// Collect all grips on one particle. Empty unless `first` is the first of them, so each particle is visited once.
static void collect_grips(mspring_network *network, uint32_t first, mspringi_grips_of_particle *held) {
    mspringi_grips *grips = network->grips;
    held->count = 0;
    for (uint32_t i = 0; i < grips->count; ++i) {
        mspringi_grip *grip = &grips->list[i];
        if (grip->particle != grips->list[first].particle)
            continue;
        if (i < first)
            return;
        MSPRINGI_ASSERT(held->count < MSPRING_MAX_GRIPS);
        held->grips[held->count] = grip;
        held->targets[held->count] = mspringi_grip_target_at(network, grip, grips->begin + grips->share);
        held->part[held->count++] = 1.0;
    }
}

static void after_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    const mspringi_solver *solver = attempt->solver;
    uint32_t slot;
    (void)substep;
    for (uint32_t i = 0; network->grips->could_act && i < mspringi_grip_count(network); ++i) {
        if (mspringi_grip_is_active(network, &network->grips->list[i], &slot) &&
            !(solver->ops->has_implicit_grips && !solver->ops->is_isolated(network, solver->object, slot))) {
            mspringi_grips_of_particle held;
            collect_grips(network, i, &held);
            if (held.count > 0)
                apply_grips(network, &held, slot);
        }
    }
}

// Repeat the step if a grip is active only now: an island may have woken in the step.
static bool must_repeat(mspring_network *network, const mspringi_attempt *attempt) {
    (void)attempt;
    return !network->grips->could_act && any_active(network);
}

static void after_step(mspring_network *network, double dt) {
    (void)dt;
    mspringi_grips_finish_step(network);
}

const mspringi_stage mspringi_stage_grips = {.is_used = mspringi_grips_act,
                                             .before_step = before_step,
                                             .is_quiet = is_quiet,
                                             .free_substeps = free_substeps,
                                             .before_substep = before_substep,
                                             .after_substep = after_substep,
                                             .must_repeat = must_repeat,
                                             .roll_back = mspringi_grips_discard_step,
                                             .after_step = after_step};

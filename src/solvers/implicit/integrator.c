/// The integrators. All three solve
///
///     (M + c K + s C) d = c (f(x*, v*) + f_outside) + M e,      x* = x + h v,   x(t+h) = x* + d,
///     v(t+h) = v* + g d / h,                                    c = force_fraction h^2,   s = c g / h
///
/// f being the springs' and dampers' force, and K and C their matrices, at x*. They come from requiring
/// M a = f(x(t+h), v(t+h)), linearised there, with
///
///     implicit Euler   a = (v(t+h) - v) / h                             c = h^2      g = 1    v* = v
///     GA0              2 a(t+h) - a(t), the generalised-alpha method of Chung and Hulbert (1993) with
///                      rho_inf = 0: alpha_m = -1, alpha_f = 0, beta = 1, gamma = 3/2
///                                                                       c = h^2 / 2  g = 3/2  v* = v + h a / 4
///     BDF2             (3 v(t+h) - 4 v + v(t-h)) / 2h                   c = 4 h^2/9  g = 3/2  v* = v - E / 2h
///
/// and e = 0 except with BDF2, whose history is kept as what it differs from uniform motion by,
/// E = x - x(t-h) - h v and G = v - v(t-h): then e = E / 3 + 2 h G / 9, and a jump of position or velocity that a
/// collision makes is no jump of the history.
///
/// x* is turned on: what x + h v would stretch, with every tile (see tiles.h) turning by a shear, is taken back by
/// turning the tile as a rigid body instead. So d and e are those above less the difference. For a body that spins,
/// what is left for d is a displacement of its tiles, which the coarse matrix solves for at once; without that,
/// iterations that end early leave forces that drive the spin (80x5 at 5 rad/s, 10^9 N/m, 8 iterations: energy
/// doubled in 5 s).
///
/// Global damping of rate b is a damper b M in C. Splitting its decay off the substep would be exact in free
/// flight, but the histories, which do not know of it, would make the whole first order.
#include "features/contact/floor.h"
#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"

mspringi_integrator_coefficients mspringi_integrator_coefficients_of(mspring_integrator integrator) {
    switch (integrator) {
    case MSPRING_INTEGRATOR_BDF2:
        return (mspringi_integrator_coefficients){4.0 / 9.0, 1.5};
    case MSPRING_INTEGRATOR_EULER:
        return (mspringi_integrator_coefficients){1.0, 1.0};
    default:
        return (mspringi_integrator_coefficients){0.5, 1.5};
    }
}

// True if the substep is of implicit Euler, whatever the integrator.
static bool starts_anew(const mspringi_implicit *n) {
    return n->history.restarts > 0 || n->uses_euler;
}

static mspring_integrator integrator_now(const mspringi_implicit *n) {
    return starts_anew(n) ? MSPRING_INTEGRATOR_EULER : n->integrator;
}

bool mspringi_integrator_is_euler(const mspringi_implicit *n) {
    return integrator_now(n) == MSPRING_INTEGRATOR_EULER;
}

/* ------------------------------------------------------------------------------------------------- preparation */

// Factor on a history of another substep length: for a smooth motion, E grows as h^2 and G as h.
static float rescaling(const mspringi_implicit *n, float h) {
    const bool other = n->integrator == MSPRING_INTEGRATOR_BDF2 && !starts_anew(n) && n->history.h != h;
    return other ? h / n->history.h : 1.0f;
}

static mspringi_prediction prepare_flight(const mspringi_implicit_substep *substep, mspring_integrator integrator) {
    const mspring_network *network = substep->network;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const float h = substep->h, ratio = rescaling(n, h);
    const float share = integrator == MSPRING_INTEGRATOR_ALPHA  ? 0.25f * h
                        : integrator == MSPRING_INTEGRATOR_BDF2 ? -0.5f / h * (ratio * ratio)
                                                                : 0.0f;
    return (mspringi_prediction){
        .x = network->state.x,
        .y = network->state.y,
        .vx = network->state.vx,
        .vy = network->state.vy,
        .low_x = network->state.low_x,
        .low_y = network->state.low_y,
        .first_x = n->history.first.x,
        .first_y = n->history.first.y,
        .inverse_mass = mspringi_active_inverse_mass(network),
        .mass = n->mass,
        .h = h,
        .first_share = share,
        .rate = (float)(mspringi_integrator_coefficients_of(integrator).velocity_fraction / (double)h),
        .turned_x = n->scaled.x, // free before the solution
        .turned_y = n->scaled.y,
        .arm_x = n->arm.x,
        .arm_y = n->arm.y,
        .to_x = n->x,
        .to_y = n->y,
        .start_vx = n->velocity.x,
        .start_vy = n->velocity.y,
    };
}

// The forces from outside, and the inertia of what was predicted.
static void prepare_outside(mspringi_implicit_substep *substep, double c, double heavier) {
    const mspring_network *network = substep->network;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const bool two = n->integrator == MSPRING_INTEGRATOR_BDF2 && !starts_anew(n);
    const float h = substep->h, ratio = rescaling(n, h);
    const double damping = (double)network->settings.global_damping;
    mspringi_outside o = {
        .mass = n->mass,
        .force_fraction = (float)n->system.force_scale,
        .velocity_fraction = (float)(-c * damping / heavier),
        .turned_fraction = (float)(1.0 / heavier),
        .first_share = (float)(1.0 / 3.0 / heavier) * (ratio * ratio),
        .second_share = (float)(2.0 / 9.0 * (double)h / heavier) * ratio,
    };
    o.force = substep->base.x;
    o.velocity = n->velocity.x;
    o.turned = n->scaled.x;
    o.first = n->history.first.x;
    o.second = two ? n->history.second.x : NULL;
    o.shift = (float)(c * (double)network->settings.gravity_x / heavier);
    substep->outside[0] = o;
    o.force = substep->base.y;
    o.velocity = n->velocity.y;
    o.turned = n->scaled.y;
    o.first = n->history.first.y;
    o.second = two ? n->history.second.y : NULL;
    o.shift = (float)(c * (double)network->settings.gravity_y / heavier);
    substep->outside[1] = o;
}

static mspringi_history_kind choose_memory(const mspringi_implicit *n) {
    switch (n->integrator) {
    case MSPRING_INTEGRATOR_ALPHA:
        return starts_anew(n) ? MSPRINGI_HISTORY_VELOCITY_CHANGE : MSPRINGI_HISTORY_ACCELERATION;
    case MSPRING_INTEGRATOR_BDF2:
        return MSPRINGI_HISTORY_BDF2;
    default:
        return MSPRINGI_HISTORY_NONE;
    }
}

static void prepare_landing(mspringi_implicit_substep *substep) {
    const mspring_network *network = substep->network;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_history *from = &n->history, *to = &n->previous;
    const mspringi_field direction = n->is_direct ? n->product : n->direction; // nothing, or what is left of d
    substep->history = choose_memory(n);
    substep->correction[0] = (mspringi_correction){.predicted = n->x,
                                                   .inverse_mass = mspringi_active_inverse_mass(network),
                                                   .solution = n->displacement.x,
                                                   .direction = direction.x,
                                                   .low = network->state.low_x,
                                                   .first = from->first.x,
                                                   .position = network->state.x,
                                                   .velocity = network->state.vx,
                                                   .low_velocity = network->state.low_vx,
                                                   .to_low = network->state.low_x,
                                                   .to_first = to->first.x,
                                                   .to_second = to->second.x,
                                                   .h = substep->h,
                                                   .first_share = substep->prediction.first_share,
                                                   .rate = substep->prediction.rate,
                                                   .grid = mspringi_rounding(&network->state)};
    substep->correction[1] = (mspringi_correction){.predicted = n->y,
                                                   .inverse_mass = mspringi_active_inverse_mass(network),
                                                   .solution = n->displacement.y,
                                                   .direction = direction.y,
                                                   .low = network->state.low_y,
                                                   .first = from->first.y,
                                                   .position = network->state.y,
                                                   .velocity = network->state.vy,
                                                   .low_velocity = network->state.low_vy,
                                                   .to_low = network->state.low_y,
                                                   .to_first = to->first.y,
                                                   .to_second = to->second.y,
                                                   .h = substep->h,
                                                   .first_share = substep->prediction.first_share,
                                                   .rate = substep->prediction.rate,
                                                   .grid = mspringi_rounding(&network->state)};
}

void mspringi_integrator_prepare(mspringi_implicit_substep *substep) {
    const mspring_network *network = substep->network;
    mspringi_implicit *n = mspringi_implicit_of(network);
    const mspring_integrator integrator = integrator_now(n);
    const mspringi_integrator_coefficients scheme = mspringi_integrator_coefficients_of(integrator);
    const double h = (double)substep->h, c = scheme.force_fraction * h * h;
    // Factor of global damping on masses.
    const double heavier =
        1.0 + scheme.force_fraction * scheme.velocity_fraction * h * (double)network->settings.global_damping;
    n->system.force_scale = n->scale * c;
    n->system.damping_rate = scheme.velocity_fraction / h;
    substep->mass_scale = (float)(n->scale * heavier);
    substep->prediction = prepare_flight(substep, integrator);
    prepare_outside(substep, c, heavier);
    prepare_landing(substep);
}

/* -------------------------------------------------------------------------------------------------- the flight */

void mspringi_predict(const mspringi_implicit_substep *substep, mspringi_team_member *member) {
    const mspring_network *network = substep->network;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_system_kernels *kernels = &network->kernels->system;
    const mspringi_tiles *tiles = &n->tiles;
    const mspringi_slots slots = mspringi_slots_of(network, member);
    mspringi_slots run;
    for (size_t at = slots.first; mspringi_next_slots(network, slots, &at, &run);)
        kernels->scale_masses(mspringi_active_inverse_mass(network), substep->mass_scale, n->mass, run.first,
                              run.end);
    mspringi_team_barrier(member);
    for (size_t t = 0; t < tiles->count; ++t)
        if (mspringi_tile_is_of(network, member, t))
            kernels->find_tile_motion(&substep->prediction, tiles->parts + tiles->first_part[t],
                                      tiles->first_part[t + 1] - tiles->first_part[t], &n->tile_motions[t]);
    mspringi_team_barrier(member);
    const mspringi_part_range parts = mspringi_tiles_parts(tiles, slots.first, slots.end);
    kernels->rotate_tiles(&substep->prediction, parts.parts, parts.count, n->tile_motions);
    mspringi_condense_turn(network, &substep->prediction, member);
    for (size_t at = slots.first; mspringi_next_slots(network, slots, &at, &run);)
        kernels->predict(&substep->prediction, run.first, run.end);
}

/* ----------------------------------------------------------------------------------------------------- landing */

// Particles without springs are in no tile and no factor: their rows of A are diagonal, but for contact, whose
// forces are known by now.
static void land_loose(const mspring_network *network, mspringi_slots slots) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_slots loose = mspringi_loose_slots(&network->topology, &slots);
    for (size_t i = loose.first; i < loose.end; ++i) {
        if (*mspringi_coupling_of(network, n, i) == MSPRINGI_COUPLED_BY_SPRINGS)
            continue;
        n->displacement.x[i] = n->mass[i] > 0.0f ? n->residual.x[i] / n->mass[i] : 0.0f;
        n->displacement.y[i] = n->mass[i] > 0.0f ? n->residual.y[i] / n->mass[i] : 0.0f;
    }
}

// Rows of particles whose springs have all broken are diagonal, too: what iterations have left of their residual is
// done at once. (Up to a hundredth of their momentum was, where iterations end early.) Above a floor they fly.
static void land_broken_off(const mspring_network *network, mspringi_slots slots, float alpha) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    if (n->is_direct || network->floor || !n->budget.has_isolated || !(alpha - alpha == 0.0f) ||
        mspringi_contact_constraint_is_active(&network->constraints))
        return;
    const size_t loose = (size_t)network->topology.loose_first * MSPRINGI_WIDTH;
    for (size_t i = slots.first; i < slots.end && i < loose; ++i) {
        if (!mspringi_budget_is_isolated(&n->budget, i) || !(n->mass[i] > 0.0f))
            continue;
        n->displacement.x[i] += n->residual.x[i] / n->mass[i] - alpha * n->direction.x[i];
        n->displacement.y[i] += n->residual.y[i] / n->mass[i] - alpha * n->direction.y[i];
    }
}

void mspringi_correct(const mspringi_implicit_substep *substep, const mspringi_team_member *member, float alpha) {
    const mspring_network *network = substep->network;
    const mspringi_slots slots = mspringi_slots_of(network, member);
    land_loose(network, slots);
    land_broken_off(network, slots, alpha);
    for (int i = 0; i < 2; ++i) {
        mspringi_correction landing = substep->correction[i];
        landing.alpha = alpha;
        mspringi_slots run;
        for (size_t at = slots.first; mspringi_next_slots(network, slots, &at, &run);)
            network->kernels->system.correct[substep->history](&landing, run.first, run.end);
    }
}

void mspringi_integrator_accept(const mspringi_implicit_substep *substep) {
    mspringi_implicit *n = mspringi_implicit_of(substep->network);
    const mspringi_history before = n->history;
    n->history = n->previous;
    n->is_first = n->is_kept;
    if (n->is_kept) {
        n->previous = n->backup;
        n->backup = before;
        n->is_kept = false;
        n->has_changed = true;
    } else {
        n->previous = before;
    }
    n->history.h = substep->h;
    n->history.restarts =
        before.restarts > 1 ? before.restarts - 1 : n->uses_euler; // a blow is no acceleration that lasts
    n->uses_euler = false;
}

void mspringi_integrator_undo(mspring_network *network) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_history failed = n->history;
    if (n->is_first) {
        n->history = n->backup;
        n->backup = n->previous;
        n->is_kept = true;
        n->has_changed = n->is_first = false;
    } else {
        n->history = n->previous;
    }
    n->previous = failed;
}

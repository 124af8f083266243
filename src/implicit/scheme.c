/// The integrators. All three solve
///
///     (M + c K + s C) d = c (f(x*, v*) + f_outside) + M e,      x* = x + h v,   x(t+h) = x* + d,
///     v(t+h) = v* + g d / h,                                    c = force_share h^2,   s = c g / h
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
#include "implicit.h"

#include <string.h>

mspringi_scheme mspringi_scheme_of(mspring_integrator integrator) {
    switch (integrator) {
    case MSPRING_INTEGRATOR_BDF2:
        return (mspringi_scheme){4.0 / 9.0, 1.5};
    case MSPRING_INTEGRATOR_EULER:
        return (mspringi_scheme){1.0, 1.0};
    default:
        return (mspringi_scheme){0.5, 1.5};
    }
}

static mspring_integrator integrator_now(const mspringi_implicit *n) {
    return n->history.restarts ? MSPRING_INTEGRATOR_EULER : n->integrator;
}

// Bring a history to another substep: of a smooth motion, E grows as h^2 and G as h.
static void rescale_history(mspring_network *network, float h) {
    mspringi_implicit *n = network->implicit;
    mspringi_history *history = &n->history;
    const size_t slots = mspringi_slot_count(network);
    if (history->h == h || n->integrator != MSPRING_INTEGRATOR_BDF2 || history->restarts)
        return;
    const float ratio = h / history->h, ratio_squared = ratio * ratio;
    for (size_t i = 0; i < 2 * slots; ++i) {
        history->first.x[i] = history->first.x[i] * ratio_squared;
        history->second.x[i] = history->second.x[i] * ratio;
    }
}

// One coordinate's predicted position, and velocity of d = 0.
static void predict_coordinate(size_t slots, const float *position, const float *low, const float *velocity,
                               const float *first, const float *turned, const float *inverse_mass, float h,
                               float first_share, float rate, double *restrict predicted, float *restrict start) {
    for (size_t i = 0; i < slots; ++i) {
        const float moved = (velocity[i] + first_share * first[i]) + rate * turned[i];
        const double straight = ((double)position[i] + (double)low[i]) + (double)h * (double)velocity[i];
        predicted[i] = straight + (double)turned[i];
        start[i] = inverse_mass[i] > 0.0f ? moved : velocity[i];
    }
}

// How far tiles turn on; into scaled, which is free before the solution.
static void fly_tiles(const mspring_network *network, float h) {
    const mspringi_implicit *n = network->implicit;
    const mspringi_tiles *tiles = &n->tiles;
    const mspringi_flight flight = {.x = network->state.x,
                                    .y = network->state.y,
                                    .vx = network->state.vx,
                                    .vy = network->state.vy,
                                    .mass = n->mass,
                                    .h = h,
                                    .turned_x = n->scaled.x,
                                    .turned_y = n->scaled.y,
                                    .arm_x = n->arm.x,
                                    .arm_y = n->arm.y};
    memset(n->scaled.x, 0, 2 * mspringi_slot_count(network) * sizeof *n->scaled.x);
    for (uint32_t t = 0; t < tiles->count; ++t)
        network->kernels->system.fly_tile(&flight, tiles->parts + tiles->first_part[t],
                                          tiles->first_part[t + 1] - tiles->first_part[t]);
}

void mspringi_predict(mspring_network *network, float h) {
    mspringi_implicit *n = network->implicit;
    const mspringi_history *history = &n->history;
    const mspringi_state *s = &network->state;
    const size_t slots = mspringi_slot_count(network);
    rescale_history(network, h);
    const mspring_integrator integrator = integrator_now(n);
    const float share = integrator == MSPRING_INTEGRATOR_GA0    ? 0.25f * h
                        : integrator == MSPRING_INTEGRATOR_BDF2 ? -0.5f / h
                                                                : 0.0f;
    const float rate = (float)(mspringi_scheme_of(integrator).velocity_share / (double)h);
    fly_tiles(network, h);
    predict_coordinate(slots, s->x, history->low.x, s->vx, history->first.x, n->scaled.x, network->inverse_mass, h,
                       share, rate, n->x, n->velocity.x);
    predict_coordinate(slots, s->y, history->low.y, s->vy, history->first.y, n->scaled.y, network->inverse_mass, h,
                       share, rate, n->y, n->velocity.y);
}

// One coordinate's state after a substep. A pinned particle has d = 0. displacement becomes what it is from x + h
// v.
static void finish_coordinate(size_t slots, const double *predicted, const float *start, const float *inverse_mass,
                              float h, float rate, float *restrict displacement, float *restrict position,
                              float *restrict low, float *restrict velocity, float *restrict change) {
    for (size_t i = 0; i < slots; ++i) {
        const double straight = ((double)position[i] + (double)low[i]) + (double)h * (double)velocity[i];
        const double end = predicted[i] + (double)displacement[i];
        const float rounded = (float)end;
        const float after = inverse_mass[i] > 0.0f ? start[i] + rate * displacement[i] : velocity[i];
        position[i] = rounded;
        low[i] = (float)(end - (double)rounded);
        change[i] = after - velocity[i];
        velocity[i] = after;
        displacement[i] = (float)(end - straight);
    }
}

// change holds v(t+h) - v of one coordinate.
static void update_history(const mspringi_implicit *n, mspring_integrator integrator, size_t slots, float h,
                           const float *displacement, const float *change, float *restrict first,
                           float *restrict second) {
    const float per_h = 1.0f / h;
    switch (n->integrator) {
    case MSPRING_INTEGRATOR_GA0:
        for (size_t i = 0; i < slots; ++i)
            first[i] = integrator == MSPRING_INTEGRATOR_EULER ? change[i] * per_h
                                                              : displacement[i] * per_h * per_h + 0.5f * first[i];
        break;
    case MSPRING_INTEGRATOR_BDF2:
        for (size_t i = 0; i < slots; ++i) {
            first[i] = displacement[i] - h * change[i]; // (h v + d) - h v(t+h)
            second[i] = change[i];
        }
        break;
    default:
        break;
    }
}

void mspringi_finish(mspring_network *network, float h) {
    mspringi_implicit *n = network->implicit;
    mspringi_history *history = &n->history;
    const mspringi_state *s = &network->state;
    const size_t slots = mspringi_slot_count(network);
    const mspring_integrator integrator = integrator_now(n);
    const float rate = (float)(mspringi_scheme_of(integrator).velocity_share / (double)h);
    const mspringi_field change = n->product; // done with
    finish_coordinate(slots, n->x, n->velocity.x, network->inverse_mass, h, rate, n->displacement.x, s->x,
                      history->low.x, s->vx, change.x);
    finish_coordinate(slots, n->y, n->velocity.y, network->inverse_mass, h, rate, n->displacement.y, s->y,
                      history->low.y, s->vy, change.y);
    update_history(n, integrator, slots, h, n->displacement.x, change.x, history->first.x, history->second.x);
    update_history(n, integrator, slots, h, n->displacement.y, change.y, history->first.y, history->second.y);
    history->h = h;
    history->restarts = false;
}

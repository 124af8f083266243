/// Substeps in which no spring pulls more than its ends can take: those that need it are clamped, all act at once.
///
/// Let w = h^2 k + 2 h c be the weight of a spring of direction n between the particles a and b, and r the largest
/// eigenvalue of the sum of w n n^T (and of h^2 k (1 - L0 / L) across the spring, if that is stretched) over the
/// springs of a particle, over its mass. For any displacement u
///     w (n.u_b - n.u_a)^2 <= (r_a + r_b) (w (n.u_a)^2 / r_a + w (n.u_b)^2 / r_b),
/// and the last factors of all springs sum to no more than the sum of m u^2. So if each spring has its forces
/// multiplied by G / (r_a + r_b) where that is below 1, all together have no eigenvalue above G. Let them act in
/// the direction at x + h v, by the length at x + q h v. A mode is multiplied by the roots of
///     z^2 - (2 - g (1 + q)) z + 1 - g q = 0, g <= G,
/// which are in the unit disc if G (1 + 2 q) <= 4: then no small motion grows. Here G is MSPRINGI_CLAMP_RATIO and q
/// MSPRINGI_CLAMP_AHEAD. The left side is 1.9, and r is never below half of what it would be in another shape: so
/// ratios found at the start of a step serve all of its substeps. Springs below G act whole and at x, as in an
/// explicit substep (q = 0). Violent ones (see violence.c) act as implicit Euler has it for a spring alone whose
/// ends have shares of the masses, w / r: q = 1 and 1 / (1 + r_a + r_b). That takes them no further than to their
/// rest length.
///
/// G and q are what keeps the kinetic energy of what is let go below the energy that it had: with G = 2 and q = 1 /
/// 4 a stretched rope came to 1.44 times as much. With q = 1 and 1 / (1 + r_a + r_b) for all, the article's bar at
/// its border would hang 216 m down instead of 152.
#include <math.h>
#include <string.h>

#include "base/decay.h"
#include "features/contact/floor.h"
#include "solvers/explicit/explicit.h"
#include "stability/stability_limit.h"
#include "store/sleepers.h"

/// Scratch arrays by slot.
enum { CHANGE_X, CHANGE_Y, RATIO = 3 };

/* ---------------------------------------------------------------------------------------- springs outside kernels
 */

static float between_ends(const float *values, const mspringi_spring_values *spring) {
    return values[spring->base] - values[spring->tip];
}

// As clamp_terms() in kernels/limit_kernel.h.
static void clamp_spring(const mspringi_stability_limit *b, const mspringi_spring_values *spring) {
    const float h = b->h, ratio = b->in[2][spring->base] + b->in[2][spring->tip];
    const float dvx = between_ends(b->in[0], spring), dvy = between_ends(b->in[1], spring);
    const float here_x = between_ends(b->x, spring), here_y = between_ends(b->y, spring);
    const float way_x = h * dvx, way_y = h * dvy;
    const bool is_violent =
        way_x * way_x + way_y * way_y - (here_x * here_x + here_y * here_y) * MSPRINGI_CLAMP_WAY > 0.0f;
    const bool is_stiff = ratio - MSPRINGI_CLAMP_RATIO > 0.0f;
    const float ahead = is_stiff || is_violent ? 1.0f : 0.0f;
    const float softening = is_stiff ? ratio * (1.0f / MSPRINGI_CLAMP_RATIO) : 1.0f;
    const float share = 1.0f / (is_violent ? 1.0f + ratio : softening);
    const float back = is_stiff && !is_violent ? 1.0f - MSPRINGI_CLAMP_AHEAD : 0.0f;
    const float dx = here_x + ahead * way_x, dy = here_y + ahead * way_y;
    const float square = dx * dx + dy * dy, inverse = square > MSPRINGI_NO_DIRECTION ? 1.0f / square : 0.0f;
    const float length = sqrtf(square);
    if (!(inverse * (share > 0.0f ? spring->stiffness + spring->damping : 0.0f) > 0.0f))
        return;
    const float push = h * spring->stiffness * share, pull = push * (length * (length - spring->rest_length));
    const float drag = (h * spring->damping * share - back * h * push) * (dvx * dx + dvy * dy);
    const float impulse = (pull + drag) * inverse, x = impulse * dx, y = impulse * dy;
    b->out[0][spring->base] -= b->inverse_mass[spring->base] * x;
    b->out[1][spring->base] -= b->inverse_mass[spring->base] * y;
    b->out[0][spring->tip] += b->inverse_mass[spring->tip] * x;
    b->out[1][spring->tip] += b->inverse_mass[spring->tip] * y;
}

static void clamp_irregular(const mspring_network *network, const mspringi_stability_limit *b) {
    for (uint32_t i = 0; i < network->topology.irregular_count; ++i) {
        const mspringi_spring_values values = mspringi_irregular_spring(network, i);
        clamp_spring(b, &values);
    }
}

/* ------------------------------------------------------------------------------------------------------- substeps
 */

// Largest eigenvalues of the sums at particles, over masses.
static void find_ratios(const mspring_network *network, mspringi_stability_limit *b) {
    const size_t slots = mspringi_slot_count(network);
    float *half = mspringi_stability_limit_scratch(network, RATIO);
    for (size_t slot = 0; slot < slots; ++slot)
        half[slot] = 0.5f;
    b->in[0] = half;
    for (size_t sum = 0; sum < 3; ++sum)
        b->out[sum] = mspringi_stability_limit_scratch(network, sum);
    memset(b->out[0], 0, 3 * slots * sizeof *b->out[0]);
    mspringi_stability_limit_bound(network, b);
    const float *trace = b->out[0], *off = b->out[1], *off_axis = b->out[2];
    for (size_t slot = 0; slot < slots; ++slot) {
        const float largest = trace[slot] + sqrtf(off[slot] * off[slot] + off_axis[slot] * off_axis[slot]);
        half[slot] = b->inverse_mass[slot] > 0.0f ? largest * b->inverse_mass[slot] : 0.0f;
    }
}

// Changes of velocities by springs.
static void find_changes(const mspring_network *network, mspringi_stability_limit *b) {
    b->in[0] = network->state.vx;
    b->in[1] = network->state.vy;
    b->in[2] = mspringi_stability_limit_scratch(network, RATIO);
    b->out[0] = mspringi_stability_limit_scratch(network, CHANGE_X);
    b->out[1] = mspringi_stability_limit_scratch(network, CHANGE_Y);
    memset(b->out[0], 0, 2 * mspringi_slot_count(network) * sizeof *b->out[0]);
    network->kernels->clamp_rows(b);
    clamp_irregular(network, b);
}

// What does not come from springs, as the explicit solver has it.
static void push_from_outside(const mspring_network *network, float h, mspringi_field base) {
    const float *restrict inverse_mass = mspringi_active_inverse_mass(network);
    const float loss = mspringi_loss(network->settings.global_damping, h);
    const float kick = mspringi_gain(network->settings.global_damping, h);
    const float gravity_h_x = network->settings.gravity_x * kick, gravity_h_y = network->settings.gravity_y * kick;
    float *restrict vx = network->state.vx, *restrict vy = network->state.vy;
    const size_t slots = mspringi_used_slots(network);
    for (size_t slot = 0; slot < slots; ++slot) {
        const bool is_free = inverse_mass[slot] > 0.0f;
        vx[slot] = is_free ? vx[slot] + (gravity_h_x - loss * vx[slot]) : vx[slot];
        vy[slot] = is_free ? vy[slot] + (gravity_h_y - loss * vy[slot]) : vy[slot];
    }
    for (size_t slot = 0; base.x && slot < slots; ++slot) {
        vx[slot] += base.x[slot] * (inverse_mass[slot] * kick);
        vy[slot] += base.y[slot] * (inverse_mass[slot] * kick);
    }
}

// Kahan's sum in one direction, as in mspringi_move_by(), in a form that compilers make vectors of.
static void move_along(float *restrict places, float *restrict lows, float *restrict speeds,
                       const float *restrict changes, float h, float grid) {
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
        speeds[lane] += changes[lane];
        const float way = speeds[lane] * h + lows[lane];
        const float place = grid > 0.0f ? places[lane] + way + grid - grid : places[lane] + way;
        lows[lane] = way - (place - places[lane]);
        places[lane] = place;
    }
}

// Move all particles but those that sleep.
static void move_all(const mspring_network *network, float h) {
    const mspringi_state *s = &network->state;
    const float *change_x = mspringi_stability_limit_scratch(network, CHANGE_X);
    const float *change_y = mspringi_stability_limit_scratch(network, CHANGE_Y);
    for (size_t first = 0; first < mspringi_used_slots(network); first += MSPRINGI_WIDTH) {
        bool is_awake = true;
        for (size_t slot = first; network->sleep.sleeping > 0 && slot < first + MSPRINGI_WIDTH; ++slot)
            is_awake = is_awake && !mspringi_slot_is_asleep(network, slot);
        if (is_awake) {
            move_along(s->x + first, s->low_x + first, s->vx + first, change_x + first, h, s->grid);
            move_along(s->y + first, s->low_y + first, s->vy + first, change_y + first, h, s->grid);
            continue;
        }
        for (size_t slot = first; slot < first + MSPRINGI_WIDTH; ++slot) {
            if (mspringi_slot_is_asleep(network, slot))
                continue;
            s->vx[slot] += change_x[slot];
            s->vy[slot] += change_y[slot];
            mspringi_move_by(s, slot, s->vx[slot] * h, s->vy[slot] * h);
        }
    }
}

static void act_on_floor(mspring_network *network, float h) {
    mspringi_floor_apply_all(network, h);
    mspringi_floor_end_interval(network, h);
}

static void take_substeps(mspring_network *network, void *object, float h, mspringi_field base, uint32_t count) {
    mspringi_stability_limit springs = mspringi_stability_limit_at(network, (double)h);
    (void)object;
    springs.h = h;
    springs.inverse_mass = mspringi_active_inverse_mass(network);
    find_ratios(network, &springs);
    if (network->floor)
        mspringi_floor_save_isolated(network);
    for (uint32_t i = 0; i < count; ++i) {
        if (network->floor)
            mspringi_floor_save_positions(network, h);
        push_from_outside(network, h, base);
        find_changes(network, &springs);
        move_all(network, h);
        if (network->floor)
            act_on_floor(network, h);
    }
    if (network->floor)
        mspringi_floor_step_isolated(network, h, base, count);
}

// See ladder.h: what it takes, measured.
static double calm_work(const void *object) {
    (void)object;
    return 3.0;
}

static const mspringi_solver_ops ops = {
    .calm_work = calm_work,
    .is_staggered = true,
    .can_add = true,
    .begin = mspringi_added_springs_update,
    .substeps = take_substeps,
    .end = mspringi_explicit_end,
    .is_isolated = mspringi_explicit_is_isolated,
};
const mspringi_solver mspringi_clamped = {&ops, NULL};

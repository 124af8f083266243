/// Substeps in which each spring pulls by itself, and no more than it takes.
///
/// Symplectic Euler adds up what springs do each as if it were alone, which is what makes motion turn round and
/// grow. Here they take turns: each changes the velocities of its ends, so that the next one finds what it has
/// done, and its impulse is the one of implicit Euler for this spring alone. However stiff it is, that takes it no
/// further than to its rest length, where the ends would be at the end of the substep; however damped, no further
/// than to rest.
///
/// Why twice, from the first to the last and back, with half the stiffness each time: to small motion about a shape
/// each turn is a matrix I - a n n^T in the norm of the masses, 0 <= a <= 1, and all turns together are P = B^T B,
/// with eigenvalues p between 0 and 1. With x' = P (2 x - x_before) a mode is multiplied by roots of
/// z^2 - 2 p z + p = 0, |z|^2 = p: none grows. Turns in one direction only have complex eigenvalues, and can grow.
#include <math.h>

#include "base/decay.h"
#include "features/contact/floor.h"
#include "features/sleep/sleep.h"
#include "solvers/explicit/explicit.h"
#include "store/springs.h"

// What does not come from springs, as the explicit solver has it.
static void push_from_outside(const mspring_network *network, float h, mspringi_field base) {
    const mspringi_state *s = &network->state;
    const float *inverse_mass = mspringi_active_inverse_mass(network);
    const float loss = mspringi_loss(network->settings.global_damping, h);
    const float kick = mspringi_gain(network->settings.global_damping, h);
    const float gravity_h_x = network->settings.gravity_x * kick, gravity_h_y = network->settings.gravity_y * kick;
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot) {
        const float inverse_mass_h = inverse_mass[slot] * kick;
        if (!(inverse_mass[slot] > 0.0f))
            continue;
        const float force_x = base.x ? base.x[slot] : 0.0f, force_y = base.x ? base.y[slot] : 0.0f;
        s->vx[slot] = s->vx[slot] + (force_x * inverse_mass_h + (gravity_h_x - loss * s->vx[slot]));
        s->vy[slot] = s->vy[slot] + (force_y * inverse_mass_h + (gravity_h_y - loss * s->vy[slot]));
    }
}

// A spring's turn.
static void take_turn(const mspring_network *network, double h, mspring_id spring) {
    const mspringi_spring_values values = mspringi_spring_get(network, spring);
    const mspringi_state *s = &network->state;
    const uint32_t a = values.base, b = values.tip;
    const float *inverse_mass = mspringi_active_inverse_mass(network);
    const double by_a = (double)inverse_mass[a], by_b = (double)inverse_mass[b], by = by_a + by_b;
    if (!(by > 0.0) || !(values.stiffness > 0.0f || values.damping > 0.0f))
        return;
    const double dvx = (double)s->vx[b] - (double)s->vx[a], dvy = (double)s->vy[b] - (double)s->vy[a];
    double dx = (double)s->x[b] - (double)s->x[a] + h * dvx;
    double dy = (double)s->y[b] - (double)s->y[a] + h * dvy;
    if (network->is_precise) {
        dx += (double)s->low_x[b] - (double)s->low_x[a];
        dy += (double)s->low_y[b] - (double)s->low_y[a];
    }
    const double length = sqrt(dx * dx + dy * dy);
    if (!(length > 0.0))
        return;
    // Half of what the spring exerts for each m and m/s, N s. What velocities do not change comes first: they are
    // waited for from turn to turn.
    const double stiffness = 0.5 * h * (double)values.stiffness, damping = 0.5 * (h * (double)values.damping);
    const double share = 1.0 / (1.0 + by * (stiffness * h + damping));
    const double nx = dx * (1.0 / length), ny = dy * (1.0 / length);
    const double extension = length - (double)values.rest_length, rate = nx * dvx + ny * dvy;
    const double impulse = share * (stiffness * extension + damping * rate);
    s->vx[a] += (float)(by_a * impulse * nx);
    s->vy[a] += (float)(by_a * impulse * ny);
    s->vx[b] -= (float)(by_b * impulse * nx);
    s->vy[b] -= (float)(by_b * impulse * ny);
}

static void move_all(const mspring_network *network, float h) {
    const mspringi_state *s = &network->state;
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot) {
        if (mspringi_slot_is_asleep(network, slot))
            continue;
        mspringi_move_by(s, slot, s->vx[slot] * h, s->vy[slot] * h);
    }
}

static void act_on_floor(mspring_network *network, float h) {
    mspringi_floor_apply_all(network, h);
    mspringi_floor_apply_silt(network, h);
}

static void take_substeps(mspring_network *network, void *object, float h, mspringi_field base, uint32_t count) {
    const uint32_t springs = network->topology.spring_count;
    (void)object;
    if (network->floor)
        mspringi_floor_save_isolated(network);
    for (uint32_t i = 0; i < count; ++i) {
        if (network->floor)
            mspringi_floor_save_positions(network, h);
        push_from_outside(network, h, base);
        for (mspring_id s = 0; s < springs; ++s)
            take_turn(network, (double)h, s);
        for (mspring_id s = springs; s-- > 0;)
            take_turn(network, (double)h, s);
        move_all(network, h);
        if (network->floor)
            act_on_floor(network, h);
    }
    if (network->floor)
        mspringi_floor_step_isolated(network, h, base, count);
}

static const mspringi_solver_ops ops = {
    .is_staggered = true,
    .can_add = true,
    .begin = mspringi_added_springs_update,
    .substeps = take_substeps,
    .end = mspringi_explicit_end,
    .is_isolated = mspringi_explicit_is_isolated,
};
const mspringi_solver mspringi_clamped = {&ops, NULL};

/// Relaxation: overlaps that were pushed apart keep no velocity of it (Box2D 3, Catto 2024).
///
/// A constraint that pushes an overlap apart has moved its nodes by the end of the interval. Then it gets target
/// speed 0, and is swept again: its accumulated impulse falls, at least to 0. An impulse conserves angular momentum
/// only where point and edge are, so the normal is that of the end. (With that of the start, bars that slide past
/// each other changed theirs by 7e-2 of the sum of its parts; so by 1e-5, which is rounding.)
///
/// Only constraints that pushed are relaxed, and without friction. With all of them, heaps did not come to rest.
/// They are swept as often as to push. (32 sweeps take back little more, and 37 % of a step where 10,000 particles
/// settle.)
///
/// Push-out against springs would store energy in them: without limit where a crack leaves an overlap within a
/// body, and in crashes in proportion to the speed. So what forces press together is pushed apart less, or held as
/// it is. (Of 600 collisions whose bodies break, two gained 40 to 50 % of their energy; now none gains 0.03 %.)
/// Weights do not count, so that heaps part.
#include <math.h>

#include "features/contact/relaxation.h"

/// Slower push-out than this share of the thickness in a step keeps its velocity, since stacks would tremble; at
/// most this share of the largest push speed, which is 1e-3 of its energy.
#define KEPT_MOVE 0.002
#define KEPT_SHARE 0.04

/// Loss of push-out per speed at which an overlap is pressed together, and weights on a particle that may press it
/// besides. (With a loss of 1, bars that overlap and slide gain half as much again.)
#define LOSS 2.0
#define WEIGHTS 64.0

void mspringi_relaxation_set_limits(const mspring_network *network, mspringi_contacts *contacts) {
    const double of_move = KEPT_MOVE * contacts->thickness / contacts->dt, of_push = KEPT_SHARE * contacts->push;
    const double gravity = fabs((double)network->settings.gravity_x) + fabs((double)network->settings.gravity_y);
    contacts->kept_push = of_move < of_push ? of_move : of_push;
    contacts->max_push = contacts->push + LOSS * WEIGHTS * gravity * (double)contacts->h;
}

void mspringi_relaxation_limit_push(mspringi_contacts *contacts, mspringi_contact_constraint *t) {
    const double most = contacts->max_push + LOSS * mspringi_normal_speed(t, contacts->nodes.v);
    if (most < t->target_speed)
        t->target_speed = most > 0.0 ? most : 0.0;
    contacts->has_push |= t->target_speed > contacts->kept_push;
}

// Turn a constraint to its normal at the end of the interval.
static void turn_to_end(const mspringi_contact_nodes *k, mspringi_contact_constraint *t, double h) {
    const mspringi_velocity *v = k->v;
    const double x = k->x[t->p] + h * v[t->p].x - t->bary_a * (k->x[t->a] + h * v[t->a].x) -
                     t->bary_b * (k->x[t->b] + h * v[t->b].x);
    const double y = k->y[t->p] + h * v[t->p].y - t->bary_a * (k->y[t->a] + h * v[t->a].y) -
                     t->bary_b * (k->y[t->b] + h * v[t->b].y);
    const double distance = sqrt(x * x + y * y);
    if (distance == 0.0)
        return;
    t->nx = x / distance;
    t->ny = y / distance;
}

bool mspringi_relaxation_begin(mspringi_contacts *contacts, double h) {
    contacts->pushed_count = 0;
    for (uint32_t i = 0; i < contacts->constraint_count; ++i) {
        mspringi_contact_constraint *t = &contacts->constraints[i];
        if (!(t->target_speed > contacts->kept_push) || t->is_bounce || t->normal_impulse == 0.0)
            continue;
        contacts->due.next[contacts->pushed_count++] = i;
        t->pushed_impulse = t->normal_impulse;
        t->target_speed = 0.0;
        turn_to_end(&contacts->nodes, t, h);
    }
    return contacts->pushed_count > 0;
}

void mspringi_relaxation_finish(mspringi_contacts *contacts) {
    for (uint32_t n = 0; n < contacts->def.sweeps; ++n) {
        mspringi_contact_sweep_pushed(contacts);
        mspringi_floor_support_sweep(contacts);
    }
    for (uint32_t i = 0; i < contacts->pushed_count; ++i) {
        const mspringi_contact_constraint *t = &contacts->constraints[contacts->due.next[i]];
        const double taken = t->pushed_impulse - t->normal_impulse;
        if (taken == 0.0)
            continue;
        if (t->collider != MSPRING_NONE)
            mspringi_colliders_add_impulse(contacts, t, -taken, 0.0);
        mspringi_contact_add_touch(contacts, t, -taken);
        if (contacts->events.capacity > 0)
            mspringi_contact_events_subtract(contacts, t, taken);
    }
}

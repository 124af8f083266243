/// Projected Gauss-Seidel: impulses of the contact constraints of an interval, one constraint after the other.
/// Neighbours in the order mostly share no particle, so a processor overlaps them.
///
/// Accumulated impulses are clamped, so a later sweep may take back impulses of an earlier one (Catto 2005).
/// Friction acts on the surface, at a distance from the edge. Its couple on the edge conserves angular momentum.
///
/// In an interval:
///
/// 1. sweep_all() visits all constraints, and floor supports, a given number of times.
/// 2. Several bounces together may add energy, because one throws a point at another edge. Then all of them bounce
///    less, and are swept again.
#include <math.h>

#include "base/assert.h"
#include "base/cpu.h"
#include "features/contact/contacts.h"

/// Factor on bounces that add energy, and most rounds of it; the last one removes bounces. Work below this share is
/// rounding.
#define BOUNCE_SHARE 0.5
#define MOST_BOUNCES 3
#define ROUNDING_SHARE 1e-9

/* -------------------------------------------------------------------------------------------- one constraint */

// True if a constraint without an impulse needs none.
MSPRINGI_ALWAYS_INLINE bool is_idle(const mspringi_contact_constraint *t, double speed) {
    return t->normal_impulse == 0.0 && speed >= t->clear_speed;
}

// Change a node's velocity. An immovable one is not written: constraints that share it would wait for each other.
// (A bar of 80x5 at rest on a collider: 0.74 of the step.)
MSPRINGI_ALWAYS_INLINE void change_velocity(const mspringi_contact_nodes *k, uint32_t node, double x, double y) {
    const double inverse_mass = k->inverse_mass[node];
    if (inverse_mass == 0.0)
        return;
    k->v[node].x += inverse_mass * x;
    k->v[node].y += inverse_mass * y;
}

// Apply an impulse (x, y) to the point and the opposite one to the edge, with a couple (turn_x, turn_y) on its
// ends.
MSPRINGI_ALWAYS_INLINE void apply_impulse(const mspringi_contact_nodes *k, const mspringi_contact_constraint *t,
                                          double x, double y, double turn_x, double turn_y) {
    change_velocity(k, t->p, x, y);
    change_velocity(k, t->a, -t->bary_a * x - turn_x, -t->bary_a * y - turn_y);
    change_velocity(k, t->b, turn_x - t->bary_b * x, turn_y - t->bary_b * y);
}

// Accumulate a share of the normal impulse that the target speed takes. Return the change.
MSPRINGI_ALWAYS_INLINE double add_normal_impulse(mspringi_contact_constraint *t, double speed, double share) {
    const double sum = t->normal_impulse + share * ((t->target_speed - speed) * t->normal_mass),
                 total = sum > 0.0 ? sum : 0.0;
    const double by = total - t->normal_impulse;
    t->normal_impulse = total;
    return by;
}

void mspringi_contact_push_apart(const mspringi_contacts *contacts, uint32_t constraint, double share) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    mspringi_contact_constraint *t = &contacts->constraints[constraint];
    const double speed = mspringi_normal_speed(t, k->v);
    if (is_idle(t, speed))
        return;
    const double by = add_normal_impulse(t, speed, share);
    apply_impulse(k, t, by * t->nx, by * t->ny, 0.0, 0.0);
}

// Relative tangential speed of the surfaces, m/s.
static double tangent_speed(const mspringi_contact_constraint *t, const mspringi_velocity *v) {
    const double x = v[t->p].x - t->bary_a * v[t->a].x - t->bary_b * v[t->b].x;
    const double y = v[t->p].y - t->bary_a * v[t->a].y - t->bary_b * v[t->b].y;
    return t->nx * y - t->ny * x + (t->couple_y * (v[t->b].x - v[t->a].x) - t->couple_x * (v[t->b].y - v[t->a].y)) +
           t->surface_speed;
}

// Find and apply normal and tangential impulse together. couple_response gives the effect of the normal one on the
// tangential speed in advance.
MSPRINGI_ALWAYS_INLINE void solve_constraint(const mspringi_contact_nodes *k, mspringi_contact_constraint *t) {
    const mspringi_velocity p = k->v[t->p], a = k->v[t->a], b = k->v[t->b];
    const double x = p.x - t->bary_a * a.x - t->bary_b * b.x, y = p.y - t->bary_a * a.y - t->bary_b * b.y;
    const double speed = t->nx * x + t->ny * y;
    if (is_idle(t, speed))
        return;
    const double by = add_normal_impulse(t, speed, 1.0);
    if (t->tangent_mass == 0.0) {
        apply_impulse(k, t, by * t->nx, by * t->ny, 0.0, 0.0);
        return;
    }
    const double most = (double)t->friction * t->normal_impulse;
    const double turning = t->couple_y * (b.x - a.x) - t->couple_x * (b.y - a.y) + t->surface_speed;
    const double slide = t->nx * y - t->ny * x + turning + by * t->couple_response,
                 sum = t->tangent_impulse - slide * t->tangent_mass;
    const double not_less = sum > -most ? sum : -most, along = not_less < most ? not_less : most;
    const double tangent = along - t->tangent_impulse;
    t->tangent_impulse = along;
    apply_impulse(k, t, by * t->nx - tangent * t->ny, by * t->ny + tangent * t->nx, tangent * t->couple_y,
                  -tangent * t->couple_x);
}

static void sweep_all(mspringi_contacts *contacts, uint32_t sweeps) {
    const mspringi_contact_nodes k = contacts->nodes;
    mspringi_contact_count_constraints(contacts, (uint64_t)sweeps * contacts->constraint_count);
    MSPRINGI_ASSERT(contacts->constraint_count <= contacts->constraint_capacity);
    for (uint32_t n = 0; n < sweeps; ++n) {
        for (uint32_t i = 0; i < contacts->constraint_count; ++i)
            solve_constraint(&k, &contacts->constraints[i]);
        mspringi_floor_support_sweep(contacts);
    }
}

// True if bouncing constraints added energy. Twice the work of an impulse is its product with the sum of the speeds
// before the substep's forces and now. Push-out of an overlap is left out.
static bool gained_energy(const mspringi_contacts *contacts) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    double work = 0.0, size = 0.0;
    bool any = false;
    for (uint32_t i = 0; i < contacts->constraint_count && !any; ++i)
        any = contacts->constraints[i].is_bounce && contacts->constraints[i].normal_impulse > 0.0;
    for (uint32_t i = 0; i < contacts->constraint_count && any; ++i) {
        const mspringi_contact_constraint *t = &contacts->constraints[i];
        if ((t->normal_impulse == 0.0 && t->tangent_impulse == 0.0) || (t->target_speed > 0.0 && !t->is_bounce))
            continue;
        work += t->normal_impulse * (mspringi_normal_speed(t, k->v_start) + mspringi_normal_speed(t, k->v));
        work += t->tangent_impulse * (tangent_speed(t, k->v_start) + tangent_speed(t, k->v));
        size += t->normal_impulse * t->normal_impulse / t->normal_mass;
    }
    return work > ROUNDING_SHARE * size;
}

static void reduce_restitution(const mspringi_contacts *contacts, double share) {
    for (uint32_t i = 0; i < contacts->constraint_count; ++i)
        contacts->constraints[i].target_speed *= contacts->constraints[i].is_bounce ? share : 1.0;
}

void mspringi_contact_sweep(mspringi_contacts *contacts, uint32_t sweeps) {
    sweep_all(contacts, sweeps);
    for (uint32_t n = 1; n <= MOST_BOUNCES && gained_energy(contacts); ++n) {
        reduce_restitution(contacts, n < MOST_BOUNCES ? BOUNCE_SHARE : 0.0);
        sweep_all(contacts, sweeps);
    }
}

void mspringi_contact_sweep_pushed(mspringi_contacts *contacts) {
    const mspringi_contact_nodes k = contacts->nodes;
    mspringi_contact_count_constraints(contacts, contacts->pushed_count);
    for (uint32_t i = 0; i < contacts->pushed_count; ++i) {
        mspringi_contact_constraint *t = &contacts->constraints[contacts->due.next[i]];
        const double by = add_normal_impulse(t, mspringi_normal_speed(t, k.v), 1.0);
        apply_impulse(&k, t, by * t->nx, by * t->ny, 0.0, 0.0);
    }
}

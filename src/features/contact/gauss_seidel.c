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
/// 3. A heavy body that presses a light one against another needs more sweeps. So
///    mspringi_contact_resolve_penetration sweeps constraints that would get deeper until none does. Bodies at rest
///    on each other have none.
#include <math.h>

#include "base/cpu.h"
#include "features/contact/contacts.h"

/// Speed at which a constraint beyond the kept depth may close, in thicknesses per substep; colliders: any overlap.
/// (With 1e-3, light fragments under many heavy ones, which are not pushed out, sank by 0.6 thicknesses in a
/// second.)
#define CLOSING_SPEED 1e-6

/// Overlap that more sweeps are spent on, as a share of the thickness. If one gets that deep within an interval,
/// the interval is too long.
#define DEEPEST_SHARE 0.1

/// Sweeps of penetrating constraints: most and least of them; between these, visits of constraints. Then most
/// of those that are deepest, and of colliders alone.
#define MOST_DEPTH_SWEEPS 256
#define LEAST_DEPTH_SWEEPS 16
#define DEPTH_VISITS 16384
#define MORE_SWEEPS 64

/// Factor on bounces that add energy, and most rounds of it; the last one removes bounces. Work below this share is
/// rounding.
#define BOUNCE_SHARE 0.5
#define MOST_BOUNCES 3
#define ROUNDING_SHARE 1e-9

/// Visits of constraints that take as long as a comparison of a point with an edge.
#define VISITS_OF_WORK 3u

/* -------------------------------------------------------------------------------------------- one constraint */

// True if a constraint without an impulse needs none.
MSPRINGI_ALWAYS_INLINE bool is_idle(const mspringi_contact_constraint *t, double speed) {
    return t->normal_impulse == 0.0 && speed >= t->clear_speed;
}

// Apply an impulse (x, y) to the point and the opposite one to the edge, with a couple (turn_x, turn_y) on its
// ends.
MSPRINGI_ALWAYS_INLINE void apply_impulse(const mspringi_contact_nodes *k, const mspringi_contact_constraint *t,
                                          double x, double y, double turn_x, double turn_y) {
    const double inverse_mass_p = k->inverse_mass[t->p], inverse_mass_a = k->inverse_mass[t->a],
                 inverse_mass_b = k->inverse_mass[t->b];
    k->v[t->p].x += inverse_mass_p * x;
    k->v[t->p].y += inverse_mass_p * y;
    k->v[t->a].x -= inverse_mass_a * (t->bary_a * x + turn_x);
    k->v[t->a].y -= inverse_mass_a * (t->bary_a * y + turn_y);
    k->v[t->b].x -= inverse_mass_b * (t->bary_b * x - turn_x);
    k->v[t->b].y -= inverse_mass_b * (t->bary_b * y - turn_y);
}

// Accumulate the normal impulse. Return the change.
MSPRINGI_ALWAYS_INLINE double add_normal_impulse(mspringi_contact_constraint *t, double speed) {
    const double sum = t->normal_impulse + (t->target_speed - speed) * t->normal_mass,
                 total = sum > 0.0 ? sum : 0.0;
    const double by = total - t->normal_impulse;
    t->normal_impulse = total;
    return by;
}

// Find and apply the normal impulse alone.
static void push_apart(const mspringi_contact_nodes *k, mspringi_contact_constraint *t) {
    const double speed = mspringi_normal_speed(t, k->v);
    if (is_idle(t, speed))
        return;
    const double by = add_normal_impulse(t, speed);
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
    const double by = add_normal_impulse(t, speed);
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

/// Bounds on constraints after the sweeps of an interval.
typedef struct penetration {
    double h, speed; ///< interval, s; closing speed of a too deep constraint, m/s
    double deepest;  ///< m
} penetration;

static penetration penetration_limit(const mspringi_contacts *contacts, double h, double share) {
    return (penetration){h, CLOSING_SPEED * contacts->thickness / (double)contacts->h, share * contacts->thickness};
}

// True if a constraint would end too deep, and deeper than it begins.
MSPRINGI_ALWAYS_INLINE bool is_penetrating(const mspringi_contacts *contacts, const mspringi_contact_constraint *t,
                                           const penetration *most) {
    const double speed = mspringi_normal_speed(t, contacts->nodes.v),
                 end = t->gap + most->h * (speed + most->speed);
    return end < (t->gap < 0.0 ? t->gap : 0.0) && end < -most->deepest;
}

// Sweep constraints that penetrate, between bodies by more than a share of the thickness. Return true if any did.
static bool sweep_penetrating(mspringi_contacts *contacts, double h, double share) {
    const penetration of_bodies = penetration_limit(contacts, h, share),
                      of_colliders = penetration_limit(contacts, h, 0.0);
    bool any = false;
    contacts->work += contacts->constraint_count / VISITS_OF_WORK;
    for (uint32_t i = 0; i < contacts->constraint_count; ++i) {
        mspringi_contact_constraint *t = &contacts->constraints[i];
        if (!is_penetrating(contacts, t, t->collider == MSPRING_NONE ? &of_bodies : &of_colliders))
            continue;
        push_apart(&contacts->nodes, t);
        any = true;
    }
    return any;
}

static void sweep_all(mspringi_contacts *contacts, uint32_t sweeps) {
    const mspringi_contact_nodes k = contacts->nodes;
    contacts->work += (uint64_t)sweeps * contacts->constraint_count / VISITS_OF_WORK;
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

bool mspringi_contact_resolve_penetration(mspringi_contacts *contacts, double h, bool *any) {
    const uint32_t by_visits = LEAST_DEPTH_SWEEPS + DEPTH_VISITS / (contacts->constraint_count + 1);
    const uint32_t most = by_visits < MOST_DEPTH_SWEEPS ? by_visits : MOST_DEPTH_SWEEPS;
    static const double shares[] = {DEEPEST_SHARE, HUGE_VAL}; // the last are colliders alone
    for (uint32_t n = 0; n < most; ++n) {
        if (!sweep_penetrating(contacts, h, MSPRINGI_KEPT_DEPTH))
            return true;
        *any = true;
        mspringi_floor_support_sweep(contacts);
    }
    for (int i = 0; i < 2; ++i)
        for (uint32_t n = 0; n < MORE_SWEEPS && sweep_penetrating(contacts, h, shares[i]); ++n)
            mspringi_floor_support_sweep(contacts);
    const penetration deepest = penetration_limit(contacts, h, DEEPEST_SHARE);
    for (uint32_t i = 0; i < contacts->constraint_count; ++i) {
        const mspringi_contact_constraint *t = &contacts->constraints[i];
        if ((t->gap > -deepest.deepest || t->collider != MSPRING_NONE) && is_penetrating(contacts, t, &deepest))
            return false;
    }
    return true;
}

void mspringi_contact_sweep_pushed(mspringi_contacts *contacts) {
    const mspringi_contact_nodes k = contacts->nodes;
    contacts->work += contacts->constraint_count / VISITS_OF_WORK;
    for (uint32_t i = 0; i < contacts->constraint_count; ++i) {
        mspringi_contact_constraint *t = &contacts->constraints[i];
        if (!t->is_pushed)
            continue;
        const double by = add_normal_impulse(t, mspringi_normal_speed(t, k.v));
        apply_impulse(&k, t, by * t->nx, by * t->ny, 0.0, 0.0);
    }
}

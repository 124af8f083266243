/// Penetration: more sweeps of the constraints that would get deeper.
///
/// A heavy body that presses a light one against another needs more sweeps than others. Most constraints need none
/// of these: in a pit of 10,000 particles at rest 70 of 25,000 act in one. So a sweep visits only the *due* ones,
/// of which a node has another velocity than when they were last visited. The bits are those of whole sweeps.
#include <math.h>
#include <string.h>

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

/// Share of the impulse that closes the gap in later sweeps: successive over-relaxation. Below 2 no visit adds
/// energy. Bodies at rest need plain sweeps; where bodies crush each other, speeds cross them slowly. (With 1, six
/// crashes of two lattices of 20,000 springs took 1.07 times as long, their worst steps 1.14 times. After eight
/// plain sweeps eight heaps of 500 fragments slept after 20 to 97 s. After 24 seven slept after 13 to 26 s and one
/// not in 60, as without.)
#define OVERRELAXATION 1.7
#define PLAIN_SWEEPS 24

/// Limit on the depth of constraints at the end of an interval.
typedef struct depth_limit {
    double h, speed; ///< interval, s; closing speed of a too deep constraint, m/s
    double deepest;  ///< m
} depth_limit;

static depth_limit limit_at(const mspringi_contacts *contacts, double h, double share) {
    return (depth_limit){h, CLOSING_SPEED * contacts->thickness / (double)contacts->h, share * contacts->thickness};
}

// True if a constraint would end too deep, and deeper than it begins.
MSPRINGI_ALWAYS_INLINE bool is_penetrating(const mspringi_contacts *contacts, const mspringi_contact_constraint *t,
                                           const depth_limit *most) {
    const double speed = mspringi_normal_speed(t, contacts->nodes.v),
                 end = t->gap + most->h * (speed + most->speed);
    return end < (t->gap < 0.0 ? t->gap : 0.0) && end < -most->deepest;
}

/* ---------------------------------------------------------------------------------------------- due constraints */

// List the constraints at each movable node.
static void list_at_nodes(const mspringi_contacts *contacts) {
    const mspringi_due_constraints *due = &contacts->due;
    const double *inverse_mass = contacts->nodes.inverse_mass;
    for (uint32_t i = 0; i < contacts->nodes.count; ++i)
        due->first[i] = MSPRING_NONE;
    for (uint32_t i = 0; i < contacts->constraint_count; ++i) {
        const mspringi_contact_constraint *t = &contacts->constraints[i];
        const uint32_t nodes[3] = {t->p, t->a, t->b};
        for (uint32_t j = 0; j < 3; ++j) {
            if (inverse_mass[nodes[j]] == 0.0)
                continue;
            due->next[3 * i + j] = due->first[nodes[j]];
            due->first[nodes[j]] = 3 * i + j;
        }
    }
}

// Make the constraints at a node due. Where many points lie on one edge, that may take longer than to visit all
// constraints: then all are due for the rest of the sweep and in the next one.
static void make_due(mspringi_contacts *contacts, uint32_t node) {
    mspringi_due_constraints *due = &contacts->due;
    for (uint32_t j = due->are_all ? MSPRING_NONE : due->first[node]; j != MSPRING_NONE; j = due->next[j]) {
        due->is_due[j / 3] = 1;
        ++due->made;
    }
    if (due->made <= contacts->constraint_count || due->are_all)
        return;
    memset(due->is_due, 1, contacts->constraint_count);
    due->are_all = true;
}

// Find the first constraint from i on that is due. What lies behind the last one does not matter.
static uint32_t next_due(const mspringi_contacts *contacts, uint32_t i) {
    const uint8_t *is_due = contacts->due.is_due;
    while (i < contacts->constraint_count && !is_due[i]) {
        uint64_t eight = 1;
        if (i % 8 == 0)
            memcpy(&eight, is_due + i, sizeof eight);
        i += eight == 0 ? 8 : 1;
    }
    return i;
}

/* ------------------------------------------------------------------------------------------------------- sweeps */

// Limits by kind: between bodies, and with colliders.
typedef struct depth_limits {
    depth_limit of_bodies, of_colliders;
} depth_limits;

static depth_limits limits_for(const mspringi_contacts *contacts, double h, double share) {
    return (depth_limits){limit_at(contacts, h, share), limit_at(contacts, h, 0.0)};
}

MSPRINGI_ALWAYS_INLINE bool must_push(const mspringi_contacts *contacts, uint32_t i, const depth_limits *most) {
    const mspringi_contact_constraint *t = &contacts->constraints[i];
    return is_penetrating(contacts, t, t->collider == MSPRING_NONE ? &most->of_bodies : &most->of_colliders);
}

// Begin with the first constraint that penetrates. False: there is none.
static bool begin_sweeps(mspringi_contacts *contacts, const depth_limits *most) {
    mspringi_due_constraints *due = &contacts->due;
    uint32_t first = 0;
    while (first < contacts->constraint_count && !must_push(contacts, first, most))
        ++first;
    mspringi_contact_count_constraints(contacts, first);
    if (first == contacts->constraint_count)
        return false;
    list_at_nodes(contacts);
    memset(due->is_due, 0, first);
    memset(due->is_due + first, 1, contacts->constraint_count - first);
    return true;
}

// Sweep constraints that penetrate, and the floor supports. Return true if any did.
static bool sweep_due(mspringi_contacts *contacts, const depth_limits *most, double share) {
    mspringi_due_constraints *due = &contacts->due;
    uint32_t visits = 0;
    bool any = false;
    due->made = 0;
    due->are_all = false;
    for (uint32_t i = next_due(contacts, 0); i < contacts->constraint_count; i = next_due(contacts, i + 1)) {
        const mspringi_contact_constraint *t = &contacts->constraints[i];
        ++visits;
        due->is_due[i] = due->are_all;
        if (!must_push(contacts, i, most))
            continue;
        mspringi_contact_push_apart(contacts, i, share);
        any = true;
        make_due(contacts, t->p);
        make_due(contacts, t->a);
        make_due(contacts, t->b);
    }
    mspringi_contact_count_constraints(contacts, visits);
    if (!any)
        return false;
    mspringi_floor_support_sweep(contacts);
    for (uint32_t i = 0; i < contacts->support_count; ++i)
        if (contacts->supports[i].has_moved)
            make_due(contacts, contacts->supports[i].p);
    return true;
}

mspringi_interval_end mspringi_contact_resolve_penetration(mspringi_contacts *contacts, double h, bool *any) {
    const uint32_t by_visits = LEAST_DEPTH_SWEEPS + DEPTH_VISITS / (contacts->constraint_count + 1);
    const uint32_t most = by_visits < MOST_DEPTH_SWEEPS ? by_visits : MOST_DEPTH_SWEEPS;
    static const double shares[] = {DEEPEST_SHARE, HUGE_VAL}; // the last are colliders alone
    const depth_limits kept = limits_for(contacts, h, MSPRINGI_KEPT_DEPTH);
    if (!begin_sweeps(contacts, &kept))
        return MSPRINGI_INTERVAL_SOLVED;
    *any = true;
    for (uint32_t n = 0; n < most; ++n)
        if (!sweep_due(contacts, &kept, n < PLAIN_SWEEPS ? 1.0 : OVERRELAXATION))
            return MSPRINGI_INTERVAL_SOLVED;
    for (int i = 0; i < 2; ++i) {
        const depth_limits deeper = limits_for(contacts, h, shares[i]);
        for (uint32_t n = 0; n < MORE_SWEEPS && sweep_due(contacts, &deeper, OVERRELAXATION); ++n)
            ;
    }
    const depth_limit deepest = limit_at(contacts, h, DEEPEST_SHARE);
    mspringi_interval_end end = MSPRINGI_INTERVAL_SOLVED;
    for (uint32_t i = 0; i < contacts->constraint_count; ++i) {
        const mspringi_contact_constraint *t = &contacts->constraints[i];
        if ((t->collider == MSPRING_NONE && t->gap <= -deepest.deepest) || !is_penetrating(contacts, t, &deepest))
            continue;
        if (t->collider != MSPRING_NONE)
            return MSPRINGI_INTERVAL_TOO_LONG;
        end = MSPRINGI_INTERVAL_TOO_DEEP;
    }
    return end;
}

/// Contact in a substep: make constraints, find impulses, add constraints of pairs that these made fast.
///
/// A substep is divided into intervals in which no node moves further than the thickness. In the order of an
/// interval: mspringi_contact_make_constraints, solve_interval(), mspringi_contact_count_impulses, move_nodes(),
/// mspringi_floor_support_end. After the last, store_nodes() writes the state.
#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "features/contact/relaxation.h"
#include "store/network.h"

/// Most intervals of a substep.
#define MAX_INTERVALS 64

/// Most subdivisions of the remaining intervals in a substep: each doubles them, and 2^6 is MAX_INTERVALS.
#define MAX_CUTS 6

/// Intervals of a substep in which bodies end too deep in each other: fewer where constraints are many, as there
/// it is sweeps that lack. (With 64 of them, steps in which walls close on a heap of 600 loose particles took 5e6
/// comparisons, and ended with LIMIT; now 0.6e6.)
#define LEAST_DEPTH_INTERVALS 4
#define DEPTH_INTERVALS 4096u

/// Most rounds of added constraints and further sweeps in an interval.
#define MAX_ROUNDS 8

/// Work allowed to a substep for each of its constraints: as much as undivided intervals take.
#define WORK_OF_CONSTRAINT 256u

static void load_velocities(const mspring_network *network, const mspringi_contact_nodes *k) {
    for (uint32_t i = 0; i < k->particle_count; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[k->particles[i]];
        k->v[i].x = (double)network->state.vx[slot];
        k->v[i].y = (double)network->state.vy[slot];
        k->shift_x[i] = k->shift_y[i] = 0.0;
    }
}

// Mark the particles whose velocities contact changed so much that pairs beyond the near misses may come into
// reach. Return true if there are any.
static bool mark_fast(const mspringi_contacts *contacts, double h) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    const double least = 0.25 * MSPRINGI_NEAR_MISS_FRACTION * contacts->thickness / h;
    uint8_t any = 0;
    for (uint32_t i = 0; i < k->particle_count; ++i) {
        const double x = k->v[i].x - k->v_before[i].x, y = k->v[i].y - k->v_before[i].y;
        k->is_fast[i] = x * x + y * y > least * least;
        any |= k->is_fast[i];
    }
    memset(k->is_fast + k->particle_count, 0, k->count - k->particle_count);
    return any;
}

// Solve an interval, and add constraints for nodes that it made fast. Penetration is resolved when there are no
// more of them, as that takes most sweeps. The last round takes added constraints that would not get too deep as
// they are.
static mspringi_interval_end solve_interval(const mspring_network *network, mspringi_contacts *contacts, double h) {
    mspringi_interval_end end = MSPRINGI_INTERVAL_SOLVED;
    bool is_resolved = false;
    mspringi_floor_support_begin(contacts, h);
    mspringi_contact_sweep(contacts, contacts->def.sweeps);
    for (uint32_t round = 0;; ++round) {
        const bool has_fast = mark_fast(contacts, h), is_last = round >= MAX_ROUNDS;
        if ((has_fast || contacts->near_miss_count > 0) &&
            mspringi_contact_add_constraints(network, contacts, h, has_fast,
                                             is_last ? MSPRINGI_KEPT_DEPTH * contacts->thickness : 0.0)) {
            if (is_last)
                return MSPRINGI_INTERVAL_TOO_LONG;
            mspringi_contact_sweep(contacts, 1);
            is_resolved = false;
            continue;
        }
        bool any = false;
        if (!is_resolved)
            end = mspringi_contact_resolve_penetration(contacts, h, &any);
        is_resolved = true;
        if (any)
            continue;
        if (has_fast && !mspringi_contact_moves_are_short(contacts, h))
            return MSPRINGI_INTERVAL_TOO_LONG;
        return end;
    }
}

void mspringi_contact_add_touch(mspringi_contacts *contacts, const mspringi_contact_constraint *t, double impulse) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    float *const touch = contacts->touch + (size_t)contacts->touch_now * contacts->particles;
    const float all = (float)impulse, of_b = (float)(t->bary_b * impulse);
    if (t->p < k->particle_count)
        touch[k->particles[t->p]] += all;
    if (t->a < k->particle_count) {
        touch[k->particles[t->a]] += all - of_b;
        touch[k->particles[t->b]] += of_b;
    }
    contacts->has_touch[contacts->touch_now] = true;
}

void mspringi_contact_count_impulses(const mspring_network *network, mspringi_contacts *contacts) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < contacts->constraint_count && contacts->events.capacity > 0; ++i)
        if (contacts->constraints[i].normal_impulse > 0.0)
            mspringi_contact_events_add_impulse(network, contacts, &contacts->constraints[i]);
    mspringi_contact_events_end_interval(contacts);
    for (uint32_t i = 0; i < contacts->constraint_count; ++i) {
        const mspringi_contact_constraint *t = &contacts->constraints[i];
        if (t->collider != MSPRING_NONE)
            mspringi_colliders_add_impulse(contacts, t, t->normal_impulse, t->tangent_impulse);
        if (t->normal_impulse > 0.0)
            mspringi_contact_add_touch(contacts, t, t->normal_impulse);
        count += t->normal_impulse > 0.0;
        contacts->deepest = -t->gap > contacts->deepest ? -t->gap : contacts->deepest;
    }
    contacts->touching = count > contacts->touching ? count : contacts->touching;
}

static void save_velocities(const mspringi_contact_nodes *k) {
    memcpy(k->v_before, k->v, k->particle_count * sizeof *k->v);
}

static void restore_velocities(const mspringi_contact_nodes *k) {
    memcpy(k->v, k->v_before, k->particle_count * sizeof *k->v);
}

// Add up the displacement by contact in an interval of h seconds, and move the nodes if their positions are needed.
static void advance(const mspring_network *network, const mspringi_contact_nodes *k, double h,
                    bool needs_positions) {
    for (uint32_t i = 0; i < k->particle_count; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[k->particles[i]];
        k->shift_x[i] += h * (k->v[i].x - (double)network->state.vx[slot]);
        k->shift_y[i] += h * (k->v[i].y - (double)network->state.vy[slot]);
    }
    for (uint32_t i = 0; i < k->count && needs_positions; ++i) {
        k->x[i] += h * k->v[i].x;
        k->y[i] += h * k->v[i].y;
    }
}

// Bounces of the next interval start at the velocities that this one leaves.
static void update_start_velocities(const mspringi_contact_nodes *k) {
    for (uint32_t i = 0; i < k->particle_count; ++i) {
        k->v_start[i].x += k->v[i].x - k->v_before[i].x;
        k->v_start[i].y += k->v[i].y - k->v_before[i].y;
    }
}

// Refresh the list if contact made a node faster than the last scan allows. If pairs may be missing in this substep
// already, repeat the step, with this speed of the node in its scans.
static void check_speed(mspringi_contacts *contacts, mspring_id p, double square) {
    const double spare = MSPRINGI_DRIFT_FRACTION * contacts->thickness / contacts->dt,
                 assumed = contacts->is_uniform ? contacts->max_speed : contacts->assumed_speed[p];
    const double expected = MSPRINGI_SPEED_MARGIN * assumed + spare,
                 most = 3.0 * assumed + 0.25 * contacts->thickness / (double)contacts->h;
    if (square > expected * expected)
        contacts->substeps_to_refresh = 1;
    if (square > most * most) {
        const double speed =
            square < INFINITY ? sqrt(square) : 0.0; // a list for an endless reach would have no pairs
        contacts->is_missed = contacts->has_extra_speed = true;
        contacts->extra_speed[p] = speed > contacts->extra_speed[p] ? speed : contacts->extra_speed[p];
    }
}

// Speed below which check_speed() has nothing to do, whatever the last scan assumed of a node, m/s.
static double unchecked_speed(const mspringi_contacts *contacts) {
    return MSPRINGI_SPEED_MARGIN * contacts->min_speed +
           MSPRINGI_DRIFT_FRACTION * contacts->thickness / contacts->dt;
}

MSPRINGI_ALWAYS_INLINE void check_node(mspringi_contacts *contacts, uint32_t i, double unchecked) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    const double x = k->v[i].x - contacts->mean_vx, y = k->v[i].y - contacts->mean_vy, square = x * x + y * y;
    if (square > unchecked * unchecked)
        check_speed(contacts, k->particles[i], square);
}

// Store velocities and displacements, and check the speeds.
static void store_nodes(const mspring_network *network, mspringi_contacts *contacts) {
    const mspringi_state *s = &network->state;
    const mspringi_contact_nodes *k = &contacts->nodes;
    const double unchecked = unchecked_speed(contacts);
    for (uint32_t i = 0; i < k->particle_count; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[k->particles[i]];
        check_node(contacts, i, unchecked);
        if (k->shift_x[i] == 0.0 && k->shift_y[i] == 0.0 && k->v[i].x == (double)s->vx[slot] &&
            k->v[i].y == (double)s->vy[slot])
            continue;
        s->vx[slot] = (float)k->v[i].x;
        s->vy[slot] = (float)k->v[i].y;
        mspringi_move_by(s, slot, (float)k->shift_x[i], (float)k->shift_y[i]);
    }
}

// Move the nodes for an interval of h seconds. Push-out of overlaps moves them, and then leaves no velocity.
static void move_nodes(const mspring_network *network, mspringi_contacts *contacts, double h, bool is_last) {
    const bool has_pushed = contacts->has_push && mspringi_relaxation_begin(contacts, h);
    for (uint32_t i = 0; i < contacts->nodes.particle_count && has_pushed; ++i)
        check_node(contacts, i, unchecked_speed(contacts));
    advance(network, &contacts->nodes, h, !is_last || has_pushed);
    if (has_pushed)
        mspringi_relaxation_finish(contacts);
}

// True if the step has taken too much work. Then nothing more is done for it.
static bool is_too_much(mspringi_contacts *contacts) {
    if (contacts->work <= contacts->most_work)
        return false;
    mspringi_contact_check_work(contacts);
    contacts->candidate_count = contacts->constraint_count = contacts->near_miss_count = 0;
    return true;
}

// Most intervals of a substep with such an end.
static uint32_t most_intervals(const mspringi_contacts *contacts, mspringi_interval_end end) {
    const uint32_t by_constraints = LEAST_DEPTH_INTERVALS + DEPTH_INTERVALS / (contacts->constraint_count + 1);
    if (end == MSPRINGI_INTERVAL_SOLVED)
        return 0;
    return end == MSPRINGI_INTERVAL_TOO_DEEP && by_constraints < MAX_INTERVALS ? by_constraints : MAX_INTERVALS;
}

// Solve intervals of equal length. Divide the remaining ones if one fails.
static void solve_in_intervals(const mspring_network *network, mspringi_contacts *contacts, double h,
                               uint32_t intervals) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    bool is_made = intervals == 1; // the caller has made the constraints of a single interval
    for (uint32_t left = intervals, cuts = 0; left > 0;) {
        const double interval = h / left;
        if (!is_made)
            (void)mspringi_contact_make_constraints(network, contacts, interval, 0.0, MSPRINGI_MAX_PENDING);
        is_made = false;
        save_velocities(k);
        const uint32_t most = most_intervals(contacts, solve_interval(network, contacts, interval));
        if (is_too_much(contacts))
            return;
        if (cuts < MAX_CUTS && left < most) {
            restore_velocities(k);
            left = 2 * left < most ? 2 * left : most;
            ++cuts;
            continue;
        }
        mspringi_contact_count_impulses(network, contacts);
        move_nodes(network, contacts, interval, left == 1);
        mspringi_floor_support_end(network, contacts);
        if (left > 1)
            update_start_velocities(k);
        h -= interval;
        --left;
    }
}

bool mspringi_contact_solve_nodes(const mspring_network *network, mspringi_contacts *contacts, double h) {
    contacts->share = 1.0;
    mspringi_relaxation_set_limits(network, contacts);
    const double fastest = mspringi_contact_make_constraints(network, contacts, h, 0.0, MSPRINGI_MAX_PENDING);
    if (contacts->constraint_count == 0)
        return false;
    contacts->most_work += WORK_OF_CONSTRAINT * (uint64_t)contacts->constraint_count;
    mspringi_floor_support_find(network, contacts);
    const double thicknesses = h * fastest / contacts->thickness;
    solve_in_intervals(network, contacts, h,
                       thicknesses < MAX_INTERVALS ? (uint32_t)thicknesses + 1 : MAX_INTERVALS);
    return true;
}

bool mspringi_contact_solve_substep(const mspring_network *network, mspringi_contacts *contacts) {
    load_velocities(network, &contacts->nodes);
    contacts->fall_x = contacts->fall_y = 0.0;
    if (!mspringi_contact_solve_nodes(network, contacts, (double)contacts->h))
        return false;
    store_nodes(network, contacts);
    return true;
}

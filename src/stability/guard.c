/// Detection of unstable steps: substeps above the stability limit (see pencil.h), and values out of bounds.
///
/// A substep that is stable in any shape needs no check. A longer one is compared with the limit of the present
/// shape in two cases: before a step with a new substep, and after a step that changed a velocity by twice the peak
/// of the last check. A bound first tests if the limit can be near at all (certificate.c). If so, a search looks
/// for an unstable motion (limit_search.c). Its eigenvalue is a lower bound, so a step below the limit is never
/// rejected.
///
/// A check takes as long as a few substeps, so no frame is late. An instability that a short search misses grows,
/// changes velocities more and triggers the next search. This starts from the motion of the step, in which the
/// unstable mode is stronger each time. The step in which it is found is rolled back.
#include "stability/guard.h"

#include <math.h>

#include "base/assert.h"
#include "base/decay.h"
#include "features/contact/contacts.h"
#include "features/contact/floor.h"
#include "stability/stability.h"
#include "stability/stability_elements.h"
#include "stability/stability_limit.h"
#include "store/feature.h"
#include "store/stages.h"

/// Growth of the largest change of velocity from one check of the limit to the next.
#define SUSPICIOUS 2.0f

/// Decay of that peak in a step without a check: half in 2839 steps, so checks are rare where nothing grows.
#define PEAK_DECAY (4095.0f / 4096.0f)

/// Change of velocity below which nothing is checked, in shortest rest lengths per substep.
#define HARMLESS 1e-3

/// Iterations of a search from noise, and from the motion.
#define ITERATIONS 100
#define ITERATIONS_FROM_MOTION 12

/// Substeps of a step for each iteration it may take; iterations times springs that any step may take; fewest
/// iterations.
#define SUBSTEPS_OF_ITERATION 4
#define SMALL_WORK 40000u
#define MIN_ITERATIONS 2

/* --------------------------------------------------------------------------------------------------- bounds */

static bool is_in_bounds(const mspring_network *network, uint32_t slot) {
    const mspringi_state *s = &network->state;
    const float largest = (float)MSPRING_MAX_COORDINATE, fastest = network->settings.max_speed;
    return fabsf(s->x[slot]) <= largest && fabsf(s->y[slot]) <= largest && fabsf(s->vx[slot]) <= fastest &&
           fabsf(s->vy[slot]) <= fastest;
}

// Report the first particle out of bounds whose state is still a number, since NaN spreads to others.
static mspring_result check_bounds(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_state *s = &network->state;
    const mspringi_topology *t = &network->topology;
    mspring_id named = MSPRING_NONE;
    for (mspring_id p = t->particle_count; p-- > 0;) {
        const uint32_t slot = t->slot_of_particle[p];
        const float sum = s->x[slot] + s->y[slot] + s->vx[slot] + s->vy[slot];
        if (!is_in_bounds(network, slot) && (sum == sum || named == MSPRING_NONE))
            named = p;
    }
    if (named == MSPRING_NONE)
        return MSPRING_OK;
    const uint32_t slot = t->slot_of_particle[named];
    const double x = network->origin_x + (double)s->x[slot], y = network->origin_y + (double)s->y[slot];
    const double vx = (double)s->vx[slot], vy = (double)s->vy[slot];
    const char *cure = "Use a shorter dt, more substeps or lower stiffness.";
    network->outcome.particle = named;
    if (!isfinite(x + y + vx + vy))
        return mspringi_fail(&network->message, MSPRING_ERROR_UNSTABLE,
                             "unstable: substeps of %g s throw particle %u out of the range of float. %s",
                             (double)attempt->h, (unsigned)named, cure);
    return mspringi_fail(&network->message, MSPRING_ERROR_UNSTABLE,
                         "unstable: substeps of %g s throw particle %u to (%g, %g) m at (%g, %g) m/s, at most %g. "
                         "%s",
                         (double)attempt->h, (unsigned)named, x, y, vx, vy, (double)network->settings.max_speed,
                         cure);
}

static float between(float value, float most) {
    return value > most ? most : value < -most ? -most : value;
}

static bool is_finite_in(const mspringi_state *s, uint32_t slot) {
    return isfinite(s->x[slot]) && isfinite(s->y[slot]) && isfinite(s->vx[slot]) && isfinite(s->vy[slot]);
}

// Move a coordinate within the bounds. A low word that belongs to another coordinate, or is NaN, becomes 0.
static void clamp_coordinate(float *coordinate, float *low, float grid) {
    const float bounded = between(*coordinate, (float)MSPRING_MAX_COORDINATE);
    *low = bounded == *coordinate ? mspringi_low_of(bounded, *low, grid) : 0.0f;
    *coordinate = bounded;
}

// Clamp the state to its bounds. What is not finite goes back to where it was before the step.
static void clamp_state(mspring_network *network) {
    const mspringi_state *s = &network->state, *before = &network->backup;
    const mspringi_topology *t = &network->topology;
    for (mspring_id p = 0; p < t->particle_count; ++p) {
        const uint32_t slot = t->slot_of_particle[p];
        if (!is_finite_in(s, slot)) {
            s->x[slot] = before->x[slot];
            s->y[slot] = before->y[slot];
            s->low_x[slot] = before->low_x[slot];
            s->low_y[slot] = before->low_y[slot];
            mspringi_set_velocity(s, slot, 0.0f, 0.0f);
        }
        clamp_coordinate(&s->x[slot], &s->low_x[slot], s->grid);
        clamp_coordinate(&s->y[slot], &s->low_y[slot], s->grid);
        s->vx[slot] = between(s->vx[slot], network->settings.max_speed);
        s->vy[slot] = between(s->vy[slot], network->settings.max_speed);
        MSPRINGI_ASSERT(is_in_bounds(network, slot));
    }
    mspringi_clear_empty_slots(network);
    mspringi_clear_unused_slots(network);
    mspringi_solver_forget(&network->solver);
    if (network->solver.ops->new_floor) // its coarse matrix may be of positions that were NaN
        network->solver.ops->new_floor(network->solver.object);
    network->outcome.flags |= MSPRING_STEP_PUT_BACK;
}

// Clamp the state at the end of a step. Impulses of grips and colliders may be NaN: they are cleared.
static mspringi_extrema put_back(mspring_network *network) {
    clamp_state(network);
    mspringi_features_discard_step(network);
    return mspringi_guard_extrema(network, 0, mspringi_used_slots(network));
}

/* --------------------------------------------------------------------------------------------- stability limit */

static mspring_result report_elements(mspring_network *network, const mspringi_attempt *attempt) {
    return mspringi_fail(&network->message, MSPRING_ERROR_UNSTABLE,
                         "unstable: the substep of %g s exceeds the stability limit of areas and angles (%g s "
                         "by themselves). Use a "
                         "shorter dt, more substeps, or less stiffness or pressure.",
                         (double)attempt->h, mspringi_elements_longest(network));
}

// Report the tightest spring, and the lighter of its ends.
static mspring_result report_limit(mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_topology *t = &network->topology;
    const mspring_id spring = mspringi_tightest_spring(network, (double)attempt->h);
    if (spring == MSPRING_NONE)
        return report_elements(network, attempt);
    uint32_t base, tip;
    mspringi_topology_ends(t, mspringi_slot_of_spring(t, spring), &base, &tip);
    const float at_base = network->inverse_mass[base], at_tip = network->inverse_mass[tip];
    const mspring_id a = t->particle_of_slot[base], b = t->particle_of_slot[tip];
    const mspring_id moved = at_base > at_tip || (at_base == at_tip && a < b) ? a : b;
    network->outcome.spring = spring;
    network->outcome.particle = moved;
    return mspringi_fail(
        &network->message, MSPRING_ERROR_UNSTABLE,
        "unstable: the substep of %g s exceeds the stability limit (spring %u, particle %u). Use a "
        "shorter dt, more substeps or lower stiffness.",
        (double)attempt->h, (unsigned)spring, (unsigned)moved);
}

// Number of iterations of a search, at most half the time of the step's substeps. Small networks may take more.
static int affordable_iterations(const mspring_network *network, uint32_t substeps, int most) {
    const uint32_t by_step = substeps / SUBSTEPS_OF_ITERATION;
    const uint32_t by_size = SMALL_WORK / (network->topology.spring_count + 1);
    const uint32_t count = by_step > by_size ? by_step : by_size;
    return count >= (uint32_t)most ? most : count > MIN_ITERATIONS ? (int)count : MIN_ITERATIONS;
}

static mspring_result check_limit(mspring_network *network, const mspringi_attempt *attempt, bool from_motion) {
    const float h = attempt->h;
    // Margin for the rounding of single-precision vectors.
    const double sharp = mspringi_stability_bound(network->settings.global_damping, h),
                 bound = sharp * (1.0 + 1e-4);
    if (mspringi_stability_limit_is_below(network, (double)h, sharp))
        return MSPRING_OK;
    const int iterations =
        affordable_iterations(network, attempt->substeps, from_motion ? ITERATIONS_FROM_MOTION : ITERATIONS);
    const uint32_t moved = from_motion ? attempt->substeps : 0;
    if (!(mspringi_stability_limit_search(network, (double)h, moved, bound, iterations) > bound))
        return MSPRING_OK;
    return report_limit(network, attempt);
}

/* ------------------------------------------------------------------------------------------------------- steps */

mspring_result mspringi_guard_check(mspring_guard policy, mspringi_message *message) {
    if (policy < MSPRING_GUARD_GROWTH || policy > MSPRING_GUARD_CLAMP_BOUNDS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "guard is %d, which is none", (int)policy);
    return policy == MSPRING_GUARD_IMPLICIT ? mspringi_solver_check_name(MSPRING_SOLVER_IMPLICIT, message)
                                            : MSPRING_OK;
}

bool mspringi_guard_checks_limit(mspring_guard policy) {
    return policy != MSPRING_GUARD_BOUNDS && policy != MSPRING_GUARD_CLAMP_BOUNDS;
}

mspring_result mspringi_guard_reserve(mspring_network *network, mspring_guard policy) {
    mspring_result result = MSPRING_OK;
    if (policy != MSPRING_GUARD_BOUNDS) // the clamped solver works in the same arrays
        result = mspringi_stability_limit_reserve(network);
    if (result != MSPRING_OK || policy != MSPRING_GUARD_IMPLICIT)
        return result;
    // One that is left from before fits the shape of then, and no archive or snapshot has it.
    if (network->settings.guard != MSPRING_GUARD_IMPLICIT)
        mspringi_solver_destroy(&network->fallback, &network->memory);
    return mspringi_fallback_reserve(network, 0);
}

// Check elements that linear systems do not have in them. In solvers without a stability limit, their forces are
// those at the start of a substep. The clamped solver takes any step.
static mspring_result check_elements(mspring_network *network, const mspringi_attempt *attempt) {
    if (network->settings.guard == MSPRING_GUARD_CLAMP_BOUNDS || attempt->solver == &mspringi_clamped ||
        (double)attempt->h <= mspringi_elements_longest(network))
        return MSPRING_OK;
    return report_elements(network, attempt);
}

mspring_result mspringi_guard_begin(mspring_network *network, const mspringi_attempt *attempt) {
    const float h = attempt->h;
    mspringi_guard *guard = &network->guard;
    const bool is_checked = guard->h == h && guard->global_damping == network->settings.global_damping;
    guard->watches = false;
    const bool is_unedited = guard->state == network->edits.state && !network->is_open;
    guard->knows_speed = is_unedited && guard->speed <= network->settings.max_speed;
    guard->knows_coordinate =
        is_unedited && guard->coordinate <= (float)MSPRING_MAX_COORDINATE && attempt->substeps == 1;
    if (!attempt->solver->ops->has_stability_limit)
        return check_elements(network, attempt);
    if (!mspringi_guard_checks_limit(network->settings.guard))
        return MSPRING_OK;
    const mspringi_any_shape *any_shape = &network->any_shape;
    if (is_checked && (any_shape->masses != network->edits.masses || any_shape->values != network->edits.values)) {
        guard->watches = true; // too early to see the effect of edits; velocities will show it
        return MSPRING_OK;
    }
    mspring_id spring;
    guard->watches = (double)h > mspringi_stable_in_any_shape(network, &spring);
    guard->h = h;
    guard->global_damping = network->settings.global_damping;
    return guard->watches && !is_checked ? check_limit(network, attempt, false) : MSPRING_OK;
}

// Larger value; NaN counts as the largest, as in the kernels.
static float larger(float a, float b) {
    return b > a || b != b ? b : a;
}

mspringi_extrema mspringi_extrema_join(mspringi_extrema a, mspringi_extrema b) {
    return (mspringi_extrema){larger(a.coordinate, b.coordinate), larger(a.speed, b.speed),
                              larger(a.change, b.change)};
}

mspringi_extrema mspringi_guard_extrema(const mspring_network *network, size_t first, size_t end) {
    const mspringi_largest_fn largest = network->kernels->largest;
    const mspringi_state *s = &network->state, *b = &network->backup;
    const bool watches = network->guard.watches;
    const size_t count = end - first;
    const mspringi_largest vx = largest(s->vx + first, watches ? b->vx + first : NULL, count);
    const mspringi_largest vy = largest(s->vy + first, watches ? b->vy + first : NULL, count);
    return (mspringi_extrema){
        larger(largest(s->x + first, NULL, count).value, largest(s->y + first, NULL, count).value),
        larger(vx.value, vy.value), larger(vx.change, vy.change)};
}

/// Fewest slots for which workers share the pass.
#define MIN_SHARED_SLOTS 32768

typedef struct extrema_task {
    const mspring_network *network;
    uint32_t workers;
    mspringi_extrema seen[MSPRING_MAX_WORKERS];
} extrema_task;

static void find_share_extrema(void *argument, uint32_t index, uint32_t worker) {
    extrema_task *all = argument;
    const size_t blocks = mspringi_used_slots(all->network) / MSPRINGI_WIDTH;
    (void)worker;
    all->seen[index] = mspringi_guard_extrema(all->network, blocks * index / all->workers * MSPRINGI_WIDTH,
                                              blocks * (index + 1) / all->workers * MSPRINGI_WIDTH);
}

mspringi_extrema mspringi_guard_extrema_of_all(const mspring_network *network) {
    extrema_task all = {.network = network, .workers = mspringi_tasks_workers(network->tasks)};
    if (mspringi_used_slots(network) < MIN_SHARED_SLOTS)
        return mspringi_guard_extrema(network, 0, mspringi_used_slots(network));
    mspringi_tasks_run(network->tasks, all.workers, find_share_extrema, &all);
    for (uint32_t i = 1; i < all.workers; ++i)
        all.seen[0] = mspringi_extrema_join(all.seen[0], all.seen[i]);
    return all.seen[0];
}

// Change of velocity too small to check, m/s.
static float harmless_change(const mspring_network *network, float h) {
    const double harmless = HARMLESS * network->shortest / (double)h;
    return harmless < 1e15 ? (float)harmless : 1e15f;
}

// True if the largest change of velocity in a step is unusual. Updates the peak.
static bool is_suspicious(mspring_network *network, float h, float change) {
    mspringi_guard *guard = &network->guard;
    const bool suspicious = change > SUSPICIOUS * fmaxf(guard->peak, harmless_change(network, h));
    guard->peak = suspicious ? change : guard->peak * PEAK_DECAY;
    return suspicious;
}

// Upper bound of all speeds after a step, m/s. A kernel that watches changes skips speeds (costs: see sweep.h): no
// particle is faster than the fastest before plus the largest change, with a margin for rounding.
static float bound_speed(const mspring_network *network, mspringi_extrema extrema) {
    const mspringi_guard *guard = &network->guard;
    if (!(guard->watches && guard->knows_speed))
        return extrema.speed;
    const float bound = (guard->speed + extrema.change) * (1.0f + 1e-6f);
    return bound <= network->settings.max_speed
               ? bound
               : mspringi_guard_extrema(network, 0, mspringi_used_slots(network)).speed;
}

// Upper bound of all coordinates after a step, m. One substep moves a particle by its final speed at most, except
// at a floor, where every coordinate was read.
static float bound_coordinate(const mspring_network *network, float h, float speed, mspringi_extrema extrema) {
    const mspringi_guard *guard = &network->guard;
    if (!guard->knows_coordinate)
        return extrema.coordinate;
    const float bound = larger(extrema.coordinate, (guard->coordinate + h * speed) * (1.0f + 1e-6f));
    return bound <= (float)MSPRING_MAX_COORDINATE
               ? bound
               : mspringi_guard_extrema(network, 0, mspringi_used_slots(network)).coordinate;
}

mspringi_extrema mspringi_guard_bound(const mspring_network *network, float h, mspringi_extrema extrema) {
    extrema.speed = bound_speed(network, extrema);
    extrema.coordinate = bound_coordinate(network, h, extrema.speed, extrema);
    return extrema;
}

// True if numbers overflowed in a substep, or nearly did. Then 0 times infinity may have spread from springs that
// are not there, of which wide vectors have more: such a state is not the same at all levels. All agree on this.
static bool has_overflowed(float coordinate, float speed) {
    return !(coordinate <= (float)MSPRING_MAX_SPEED && speed <= (float)MSPRING_MAX_SPEED);
}

// True if the guard takes no step whose solver has left repetitions undone: the others have a fallback, or ask for
// none.
static bool needs_all_work(mspring_guard policy) {
    return policy == MSPRING_GUARD_GROWTH || policy == MSPRING_GUARD_RETRY;
}

static mspring_result report_spent(mspring_network *network, const mspringi_attempt *attempt) {
    return mspringi_fail(&network->message, MSPRING_ERROR_UNSTABLE,
                         "unstable: substeps of %g s need more solutions than most_work, %u, allows. Use a larger "
                         "most_work, more substeps or a shorter dt.",
                         (double)attempt->h, (unsigned)network->most_work);
}

mspring_result mspringi_guard_end(mspring_network *network, const mspringi_attempt *attempt,
                                  mspringi_extrema extrema) {
    const float h = attempt->h;
    mspringi_guard *guard = &network->guard;
    if (attempt->is_spent && needs_all_work(network->settings.guard))
        return report_spent(network, attempt);
    const mspringi_extrema bounds = mspringi_guard_bound(network, h, extrema);
    float speed = bounds.speed, coordinate = bounds.coordinate;
    const bool is_out = !(coordinate <= (float)MSPRING_MAX_COORDINATE && speed <= network->settings.max_speed);
    const bool is_last = attempt->solver == &mspringi_clamped || !has_overflowed(coordinate, speed);
    if (is_out && network->settings.guard == MSPRING_GUARD_CLAMP_BOUNDS && is_last) {
        extrema = put_back(network);
        speed = extrema.speed;
        coordinate = extrema.coordinate;
    } else if (is_out) {
        const mspring_result result = check_bounds(network, attempt);
        if (result != MSPRING_OK)
            return result;
    }
    if (guard->watches && is_suspicious(network, h, extrema.change)) {
        const mspring_result result = check_limit(network, attempt, true);
        if (result != MSPRING_OK)
            return result;
    }
    // Sleeping particles are skipped, and the bounds serve only a step of the same kind.
    const bool is_known = attempt->solver->ops->has_stability_limit;
    guard->speed = is_known ? larger(speed, network->settings.sleep_speed) : INFINITY;
    guard->coordinate = is_known && network->sleep.sleeping == 0 ? coordinate : INFINITY;
    guard->state = network->edits.state;
    return MSPRING_OK;
}

/// Substeps where they are left to the library. Leapfrog conserves an energy that depends on the length of
/// substeps, most of all near the stability limit. So substeps whose length varies gain energy.
#include "step/pace.h"

#include <math.h>

#include "base/assert.h"
#include "stability/stability.h"

/* -------------------------------------------------------------------------------------------- violent motion */

/// Relative way of a spring's ends in a substep, in its rest lengths, up to which leapfrog keeps the energy. A free
/// lattice of 4 x 4 gains up to 1.3 times its energy at 0.25, 5,000 times at 0.4.
#define VIOLENT_SHARE 0.25

// Arguments and results of a choice of substeps.
typedef struct choice {
    double dt, limit; ///< of the step; longest substep that is stable in any shape, s
    bool may_raise;   ///< more substeps for violent motion
    uint32_t calm;    ///< result: substeps for calm motion
    double need;      ///< result: substeps that the motion needs; 0: not computed
} choice;

// Raise the substeps if violent motion needs more, within most_work and max_substeps. With relative springs, more
// would make these stiffer.
static uint32_t raised(const mspring_network *network, choice *made, uint32_t calm) {
    const double dt = made->dt;
    const double work = network->most_work > 0 ? (double)network->most_work * (double)calm : INFINITY,
                 most = fmin(work, (double)network->max_substeps);
    made->calm = calm;
    if (!made->may_raise || network->fractions.values || (double)calm > most ||
        dt * mspringi_violence_bound(network) <= VIOLENT_SHARE * (double)calm)
        return calm;
    made->need = -floor(-dt * mspringi_violence(network) / VIOLENT_SHARE);
    return made->need > most ? (uint32_t)most : made->need > (double)calm ? (uint32_t)made->need : calm;
}

// Flag a step that takes fewer substeps than it needs.
static uint32_t flagged(mspring_network *network, uint32_t substeps, double need) {
    if (need > (double)substeps)
        network->outcome.flags |= MSPRING_STEP_FEWER;
    return substeps;
}

/* ------------------------------------------------------------------------------------- MSPRING_SUBSTEPS_AUTO */

// True if dt differs from that of the last step by more than rounding.
static bool changes_dt(const mspring_network *network, double dt) {
    const double before = network->steps.dt;
    return before > 0.0 && !(fabs(dt - before) <= 1e-6 * before);
}

// Choose the substeps for a dt that varies: of a length as near as possible to the last one, 0.4 to 0.8 of the
// limit. An undamped rope of 20 springs gains 2.9 times its energy in a minute in which dt lies between 0.9 and 1
// of 1/64 s, and over a millionfold with the fewest substeps.
static uint32_t uneven_substeps(const mspring_network *network, double dt, double limit) {
    const uint32_t most = network->max_substeps, least = mspringi_substeps_within(dt, 0.8 * limit, most);
    if (least > most)
        return mspringi_substeps_within(dt, limit, most);
    const double wanted = fmin(fmax((double)network->steps.lag, 0.4 * limit), 0.8 * limit);
    const double more = -floor(-dt / wanted), fewer = fmax(more - 1.0, 1.0); // one of these has the closest length
    const double closest = dt / fewer - wanted < wanted - dt / more ? fewer : more;
    return closest < (double)least ? least : closest < (double)most ? (uint32_t)closest : most;
}

/* ------------------------------------------------------------------------------------- MSPRING_SUBSTEPS_EVEN */

/// Consecutive steps after which substeps get another length: steps of one dt, or with more than FEW times the
/// substeps that dt needs. With more than MANY times as many they get it at once.
#define EVEN_STEPS 30u
#define FEW 2.0
#define MANY 16.0

/// Substeps by which the state may be ahead of the host's time.
#define MOST_AHEAD 1.5

// Substeps of a step at the length that substeps had.
typedef struct kept_length {
    double whole, left; ///< their number, and the rest of dt that it leaves, s
    double times;       ///< their number, in units of the fewest that the step needs
    bool is_ahead;      ///< the state would get too far ahead
} kept_length;

// True if substeps get another length. calm, fewest: fewest substeps for calm motion, and for this one.
static bool needs_new_length(const mspring_network *network, const choice *made, const kept_length *kept,
                             uint32_t calm, uint32_t fewest) {
    const mspringi_pace *had = &network->steps.pace;
    const double dt = made->dt, h = had->h;
    const bool is_of_dt = dt == had->dt && fabs(had->left) <= 0.5 * h; // chosen for this dt: take it from dt again
    const bool is_due = network->next_pace.steps >= EVEN_STEPS;
    const bool is_stable = h > 0.0 && h <= made->limit;
    const bool are_too_many = kept->times > MANY || kept->whole > (double)network->max_substeps;
    const bool are_too_few = fewest > calm && kept->whole < (double)fewest; // for violent motion
    const bool is_too_long = kept->is_ahead && (dt >= 0.5 * h || dt * MANY >= made->limit);
    return is_of_dt || is_due || !is_stable || are_too_many || are_too_few || is_too_long;
}

// Keep the length of substeps: take the whole number of them nearest to dt, at least one, and carry the rest of dt
// to the next step. If the state would get too far ahead, choose a new length. But a dt far below the limit is
// taken as it is, and the length stays for later steps. (Lengths near the limit that change to and fro gain
// energy.)
static uint32_t even_substeps(mspring_network *network, choice *made) {
    const double dt = made->dt;
    const mspringi_pace *had = &network->steps.pace;
    mspringi_pace *pace = &network->next_pace;
    const uint32_t most = network->max_substeps, calm = mspringi_substeps_within(dt, made->limit, most),
                   fewest = raised(network, made, calm);
    const double h = had->h, whole = fmax(floor((dt + had->left) / h + 0.5), 1.0),
                 left = dt + had->left - whole * h;
    const kept_length kept = {whole, left, whole / (double)fewest, dt < h && left < -MOST_AHEAD * h};
    const bool is_settled = dt == network->steps.dt || kept.times > FEW || kept.is_ahead;
    pace->steps = !is_settled ? 1 : had->steps < EVEN_STEPS ? had->steps + 1 : EVEN_STEPS;
    if (fewest > most)
        return fewest;
    if (needs_new_length(network, made, &kept, calm, fewest)) {
        pace->dt = dt;
        pace->h = (double)(float)(dt / (double)fewest);
        pace->steps = 0;
        return flagged(network, fewest, made->need);
    }
    if (kept.is_ahead) // by a dt far below the limit
        return flagged(network, fewest, made->need);
    pace->left = left;
    network->step_time = whole * h;
    made->calm = fewest > calm ? calm : (uint32_t)whole;
    return flagged(network, (uint32_t)whole, made->need);
}

/* -------------------------------------------------------------------------------------------- substep_length */

// Number of substeps of substep_length in dt plus the rest of earlier steps.
static double whole_substeps(const mspring_network *network, double dt) {
    return floor((dt + network->steps.pace.left) / network->substep_length + 0.5);
}

mspring_result mspringi_pace_defer(mspring_network *network, double dt, bool *is_deferred) {
    const double whole = network->substep_length > 0.0 && dt > 0.0 ? whole_substeps(network, dt) : 1.0;
    *is_deferred = whole < 1.0;
    if (*is_deferred)
        network->steps.pace.left += dt;
    return whole <= (double)MSPRING_MAX_SUBSTEPS
               ? MSPRING_OK
               : mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "dt is %g s: that is more than %u substeps of substep_length, %g s", dt,
                               (unsigned)MSPRING_MAX_SUBSTEPS, network->substep_length);
}

void mspringi_pace_keep_length(mspring_network *network, double dt) {
    const double whole = whole_substeps(network, dt);
    network->substeps = (uint32_t)whole;
    network->step_time = whole * network->substep_length;
    network->next_pace.left = dt + network->steps.pace.left - network->step_time;
}

/* ------------------------------------------------------------------------------------------------------ both */

static uint32_t preferred_substeps(mspring_network *network, choice *made) {
    const double dt = made->dt, limit = made->limit;
    if (network->auto_substeps == MSPRINGI_SUBSTEPS_EVEN)
        return even_substeps(network, made);
    const uint32_t calm = network->steps.uneven_steps > 0 || changes_dt(network, dt)
                              ? uneven_substeps(network, dt, limit)
                              : mspringi_substeps_within(dt, limit, network->max_substeps);
    const uint32_t substeps = raised(network, made, calm);
    return flagged(network, substeps, made->need);
}

mspring_result mspringi_pace_choose(mspring_network *network, double dt, bool may_raise, uint32_t *calm) {
    mspring_id spring;
    const double limit = mspringi_stable_in_any_shape(network, &spring);
    choice made = {.dt = dt, .limit = limit, .may_raise = may_raise};
    uint32_t substeps = preferred_substeps(network, &made);
    if (substeps > network->max_substeps && network->fractions.values)
        substeps = mspringi_substeps_within(dt, mspringi_stable_with_relative(network), network->max_substeps);
    if (network->settings.guard == MSPRING_GUARD_CLAMP_BOUNDS && substeps > network->max_substeps)
        substeps = network->max_substeps;
    if (substeps > network->max_substeps) {
        const mspring_id tightest = mspringi_tightest_spring(network, dt / (double)network->max_substeps);
        network->outcome.spring = tightest;
        if (tightest == MSPRING_NONE)
            return mspringi_fail(&network->message, MSPRING_ERROR_UNSTABLE,
                                 "unstable: for its areas a step of %g s needs substeps of at most %g s, which are "
                                 "more than max_substeps, %u. Use a shorter dt, a larger max_substeps, or less "
                                 "stiffness or pressure.",
                                 dt, limit, (unsigned)network->max_substeps);
        return mspringi_fail(&network->message, MSPRING_ERROR_UNSTABLE,
                             "unstable: a step of %g s needs substeps of at most %g s (spring %u), which are more "
                             "than max_substeps, %u. Use a shorter dt, a larger max_substeps or lower stiffness.",
                             dt, limit, (unsigned)tightest, (unsigned)network->max_substeps);
    }
    MSPRINGI_ASSERT(substeps > 0 && network->step_time >= 0.0);
    network->substeps = substeps;
    *calm = made.calm < substeps ? made.calm : substeps;
    return MSPRING_OK;
}

void mspringi_pace_note(mspring_network *network, double dt) {
    mspringi_steps *steps = &network->steps;
    if (changes_dt(network, dt))
        steps->uneven_steps = MSPRINGI_UNEVEN_STEPS;
    else if (steps->uneven_steps > 0)
        steps->uneven_steps--;
    steps->dt = dt;
}

/// Settings: all that may change between steps.
#include <float.h>
#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "features/contact/contacts.h"
#include "solvers/implicit/implicit.h"
#include "stability/guard.h"
#include "store/changed.h"
#include "store/group_ops.h"
#include "store/network.h"
#include "store/sleepers.h"

static mspring_result check_implicit(const mspring_settings *def, mspringi_message *message) {
    if (def->integrator < MSPRING_INTEGRATOR_ALPHA || def->integrator > MSPRING_INTEGRATOR_EULER)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "integrator is %d, which is unknown",
                             (int)def->integrator);
    if (def->solver == MSPRING_SOLVER_DIRECT)
        return MSPRING_OK;
    if (def->iterations > MSPRINGI_MOST_ITERATIONS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "iterations is %u, it must be at most %d",
                             (unsigned)def->iterations, MSPRINGI_MOST_ITERATIONS);
    if (def->coarse_period > MSPRINGI_MOST_ITERATIONS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "coarse_period is %u, it must be at most %d",
                             (unsigned)def->coarse_period, MSPRINGI_MOST_ITERATIONS);
    if (!(def->residual >= 0.0f && def->residual <= 1.0f)) // NaN is refused, too
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "residual is %g, it must be 0 to 1",
                             (double)def->residual);
    const bool is_power_of_two = (def->tile_size & (def->tile_size - 1)) == 0;
    if (def->tile_size != 0 && (def->tile_size < 8 || def->tile_size > 256 || !is_power_of_two))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "tile_size is %u, it must be 0 or a power of two from 8 to 256",
                             (unsigned)def->tile_size);
    return MSPRING_OK;
}

static uint32_t auto_of(uint32_t substeps) {
    return substeps == MSPRING_SUBSTEPS_AUTO   ? MSPRINGI_SUBSTEPS_AUTO
           : substeps == MSPRING_SUBSTEPS_EVEN ? MSPRINGI_SUBSTEPS_EVEN
                                               : MSPRINGI_SUBSTEPS_GIVEN;
}

static mspring_result check_solver(const mspring_settings *def, mspringi_message *message) {
    mspring_result result = mspringi_solver_check_name(def->solver, message);
    if (result != MSPRING_OK)
        return result;
    if (auto_of(def->substeps) == MSPRINGI_SUBSTEPS_GIVEN &&
        (def->substeps < 1 || def->substeps > MSPRING_MAX_SUBSTEPS))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "substeps is %u, it must be 1 to %u",
                             (unsigned)def->substeps, (unsigned)MSPRING_MAX_SUBSTEPS);
    if (def->most_work > MSPRING_MAX_SUBSTEPS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "most_work is %u, it must be at most %u",
                             (unsigned)def->most_work, (unsigned)MSPRING_MAX_SUBSTEPS);
    if (def->max_substeps < 1 || def->max_substeps > MSPRING_MAX_SUBSTEPS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "max_substeps is %u, it must be 1 to %u",
                             (unsigned)def->max_substeps, (unsigned)MSPRING_MAX_SUBSTEPS);
    if (def->substep_length != 0.0 && !(def->substep_length >= (double)FLT_MIN && def->substep_length <= 1e30))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "substep_length is %g s, it must be 0 or 1.2e-38 to 1e30", def->substep_length);
    return def->solver != MSPRING_SOLVER_EXPLICIT ? check_implicit(def, message) : MSPRING_OK;
}

// Replace the solver by the one defined, or adjust it if it fits.
static mspring_result change_solver(mspring_network *network, const mspring_settings *def) {
    mspringi_solver made = {mspringi_solver_ops_of(def->solver), NULL};
    if (made.ops == network->solver.ops && (!made.ops->fits || made.ops->fits(network->solver.object, def))) {
        if (made.ops->adjust)
            made.ops->adjust(network->solver.object, def);
        return MSPRING_OK;
    }
    const mspringi_fp_state before = mspringi_fp_enter();
    mspring_result result = mspringi_solver_make(&made, network, def, 0);
    mspringi_fp_leave(before);
    if (result != MSPRING_OK)
        return result;
    mspringi_solver_destroy(&network->solver, &network->memory);
    network->solver = made;
    return MSPRING_OK;
}

/* ---------------------------------------------------------------------------------------------------- settings */

mspring_result mspringi_check_settings(const mspring_settings *settings, mspringi_message *message) {
    float value;
#define SETTING(name, first, range, is_good, change)                                                               \
    value = settings->name;                                                                                        \
    if (!(is_good))                                                                                                \
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s is %g, it must be %s", #name, (double)value,     \
                             range);
#include "base/settings.def"
    const mspring_result result = mspringi_guard_check(settings->guard, message);
    return result == MSPRING_OK ? check_solver(settings, message) : result;
}

mspring_settings mspringi_settings_of(const mspring_network *network) {
    const mspringi_solver *solver = &network->solver;
    mspring_settings made;
    (void)mspring_init(MSPRING_STRUCT_SETTINGS, &made, sizeof made);
    if (solver->ops->get_def)
        solver->ops->get_def(solver->object, &made);
#define SETTING(name, first, range, is_good, change) made.name = network->settings.name;
#include "base/settings.def"
    made.guard = network->settings.guard;
    made.substeps = network->auto_substeps == MSPRINGI_SUBSTEPS_AUTO   ? MSPRING_SUBSTEPS_AUTO
                    : network->auto_substeps == MSPRINGI_SUBSTEPS_EVEN ? MSPRING_SUBSTEPS_EVEN
                                                                       : network->substeps;
    made.max_substeps = network->max_substeps;
    made.most_work = network->most_work;
    made.substep_length = network->substep_length;
    return made;
}

mspring_settings mspringi_settings_with_solver_of(const mspring_settings *settings,
                                                  const mspring_settings *solver) {
    mspring_settings made = *solver;
    made.guard = settings->guard;
#define SETTING(name, first, range, is_good, change) made.name = settings->name;
#include "base/settings.def"
    return made;
}

mspring_result mspring_network_get_settings(const mspring_network *network, mspring_settings *settings) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_settings, settings);
    if (result != MSPRING_OK)
        return result;
    const mspring_settings had = mspringi_settings_of(network);
    mspringi_put_settings(settings, &had);
    return MSPRING_OK;
}

// Allocate memory that the new settings need in addition.
static mspring_result reserve_for(mspring_network *network, const mspring_settings *settings) {
    const mspringi_fp_state before = mspringi_fp_enter();
    mspring_result result = MSPRING_OK;
    if (settings->sleep_speed > 0.0f)
        result = mspringi_sleep_reserve(network);
    if (result == MSPRING_OK && settings->guard != network->settings.guard)
        result = mspringi_guard_reserve(network, settings->guard);
    mspringi_fp_leave(before);
    return result;
}

// Set what of the settings is the solver's. `before`: the settings of before, with another solver object or not.
static void set_solver(mspring_network *network, const mspring_settings *settings, const mspring_settings *before,
                       const void *object) {
    const mspring_settings had = mspringi_settings_of(network);
    const mspring_settings now = mspringi_settings_with_solver_of(before, &had);
    const bool is_same = object == network->solver.object && memcmp(before, &now, sizeof now) == 0;
    if (is_same && settings->substeps == now.substeps && settings->max_substeps == now.max_substeps &&
        settings->most_work == now.most_work && settings->substep_length == now.substep_length)
        return;
    mspringi_notify_change(network, MSPRINGI_CHANGED_SOLVER, 0);
    network->auto_substeps = auto_of(settings->substeps);
    network->substeps = network->auto_substeps ? 1 : settings->substeps;
    network->max_substeps = settings->max_substeps;
    network->most_work = settings->most_work;
    network->substep_length = settings->substep_length;
    network->guard.fallback_steps = 0;
}

// Set the others, in memory that is there.
static void set_others(mspring_network *network, const mspring_settings *settings) {
    const mspring_settings old = network->settings;
    network->settings = *settings;
    if (settings->guard != old.guard) {
        network->guard.h = network->guard.peak = 0.0f;
        network->guard.fallback_steps = 0;
    }
#define SETTING(name, first, range, is_good, change)                                                               \
    if (settings->name != old.name)                                                                                \
        mspringi_notify_change(network, change, 0);
#include "base/settings.def"
}

mspring_result mspring_network_set_settings(mspring_network *network, const mspring_settings *settings) {
    mspring_settings taken;
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = mspringi_take_settings(&network->message, &settings, &taken);
    if (result == MSPRING_OK)
        result = mspringi_check_settings(settings, &network->message);
    if (result == MSPRING_OK && network->groups.count > 0)
        result = mspringi_held_groups->check_settings(network, settings);
    if (result == MSPRING_OK)
        result = reserve_for(network, settings);
    if (result != MSPRING_OK)
        return result;
    if (settings->substep_length > 0.0)
        taken.substeps = MSPRING_SUBSTEPS_AUTO;
    taken.substep_length = (double)(float)settings->substep_length;
    const mspring_settings before = mspringi_settings_of(network);
    const void *object = network->solver.object;
    result = change_solver(network, settings);
    if (result != MSPRING_OK)
        return result;
    set_solver(network, settings, &before, object);
    set_others(network, settings);
    return MSPRING_OK;
}

mspring_result mspring_network_wake(mspring_network *network) {
    const mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK && mspringi_sleepers)
        mspringi_sleepers->wake_all(network);
    return result;
}

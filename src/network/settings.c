/// Settings that may change between steps: solver, gravity, global damping.
#include <math.h>

#include "base/cpu.h"
#include "solvers/implicit/implicit.h"
#include "stability/guard.h"
#include "store/changed.h"
#include "store/network.h"

static mspring_result check_implicit(const mspring_solver_def *def, mspringi_message *message) {
    if (def->integrator < MSPRING_INTEGRATOR_GA0 || def->integrator > MSPRING_INTEGRATOR_EULER)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "integrator is %d, which is none",
                             (int)def->integrator);
    if (def->solver == MSPRING_SOLVER_DIRECT)
        return MSPRING_OK;
    if (def->iterations > MSPRINGI_MOST_ITERATIONS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "iterations is %u, it must be at most %d",
                             (unsigned)def->iterations, MSPRINGI_MOST_ITERATIONS);
    if (def->coarse_period > MSPRINGI_MOST_ITERATIONS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "coarse_period is %u, it must be at most %d",
                             (unsigned)def->coarse_period, MSPRINGI_MOST_ITERATIONS);
    const bool is_power_of_two = (def->tile_size & (def->tile_size - 1)) == 0;
    if (def->tile_size != 0 && (def->tile_size < 8 || def->tile_size > 256 || !is_power_of_two))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "tile_size is %u, it must be 0 or a power of two from 8 to 256",
                             (unsigned)def->tile_size);
    return MSPRING_OK;
}

mspring_result mspringi_check_solver(const mspring_solver_def *def, mspringi_message *message) {
    if (!def)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "solver definition is NULL");
    mspring_result result =
        mspringi_check_struct(message, "mspring_solver_def", def->struct_size, sizeof *def, sizeof *def);
    if (result != MSPRING_OK)
        return result;
    if (!mspringi_solver_ops_of(def->solver))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "solver is %d, which is none", (int)def->solver);
    const bool automatic = def->substeps == MSPRING_SUBSTEPS_AUTO;
    if (!automatic && (def->substeps < 1 || def->substeps > MSPRING_MAX_SUBSTEPS))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "substeps is %u, it must be 1 to %u",
                             (unsigned)def->substeps, (unsigned)MSPRING_MAX_SUBSTEPS);
    if (def->max_substeps < 1 || def->max_substeps > MSPRING_MAX_SUBSTEPS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "max_substeps is %u, it must be 1 to %u",
                             (unsigned)def->max_substeps, (unsigned)MSPRING_MAX_SUBSTEPS);
    return def->solver != MSPRING_SOLVER_EXPLICIT ? check_implicit(def, message) : MSPRING_OK;
}

// Exchange the solver for that of the definition, or have it go on with other settings.
static mspring_result change_solver(mspring_network *network, const mspring_solver_def *def) {
    mspringi_solver made = {mspringi_solver_ops_of(def->solver), NULL};
    if (made.ops == network->solver.ops && (!made.ops->fits || made.ops->fits(network->solver.object, def))) {
        if (made.ops->adjust)
            made.ops->adjust(network->solver.object, def);
        return MSPRING_OK;
    }
    if (made.ops->create) {
        const mspringi_fp_state before = mspringi_fp_enter();
        mspring_result result = made.ops->create(network, def, &made.object);
        mspringi_fp_leave(before);
        if (result != MSPRING_OK)
            return result;
    }
    mspringi_solver_destroy(&network->solver, &network->memory);
    network->solver = made;
    return MSPRING_OK;
}

mspring_result mspring_network_set_solver(mspring_network *network, const mspring_solver_def *def) {
    mspring_result result = mspringi_enter(network);
    if (result == MSPRING_OK)
        result = mspringi_check_solver(def, &network->message);
    if (result == MSPRING_OK)
        result = change_solver(network, def);
    if (result != MSPRING_OK)
        return result;
    mspringi_changed(network, MSPRINGI_CHANGED_SOLVER, 0);
    const bool automatic = def->substeps == MSPRING_SUBSTEPS_AUTO;
    network->auto_substeps = automatic && network->solver.ops->picks_substeps;
    network->substeps = automatic ? 1 : def->substeps;
    network->max_substeps = def->max_substeps;
    network->guard.fallback_steps = 0;
    return MSPRING_OK;
}

mspring_result mspring_network_set_guard(mspring_network *network, mspring_guard guard) {
    mspring_result result = mspringi_enter(network);
    if (result == MSPRING_OK)
        result = mspringi_guard_check(guard, &network->message);
    if (result != MSPRING_OK || guard == network->guard_policy)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    result = mspringi_guard_reserve(network, guard);
    mspringi_fp_leave(before);
    if (result != MSPRING_OK)
        return result;
    network->guard_policy = guard;
    network->guard.h = network->guard.peak = 0.0f;
    network->guard.fallback_steps = 0;
    return MSPRING_OK;
}

mspring_guard mspring_network_get_guard(const mspring_network *network) {
    return network ? network->guard_policy : MSPRING_GUARD_GROWTH;
}

mspring_result mspring_network_set_gravity(mspring_network *network, float x, float y) {
    mspring_result result = mspringi_enter(network);
    if (result != MSPRING_OK)
        return result;
    if (!isfinite(x) || !isfinite(y))
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "gravity (%g, %g) m/s^2 is not finite",
                             (double)x, (double)y);
    const bool is_new = x != network->gravity_x || y != network->gravity_y;
    network->gravity_x = x;
    network->gravity_y = y;
    if (is_new)
        mspringi_changed(network, MSPRINGI_CHANGED_GRAVITY, 0);
    return MSPRING_OK;
}

mspring_result mspring_network_set_global_damping(mspring_network *network, float rate) {
    mspring_result result = mspringi_enter(network);
    if (result != MSPRING_OK)
        return result;
    if (!(rate >= 0.0f && rate <= 1e6f))
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "global damping is %g 1/s, it must be 0 to 1e6", (double)rate);
    network->global_damping = rate;
    return MSPRING_OK;
}

uint32_t mspring_network_substeps(const mspring_network *network) {
    return network ? network->substeps : 0;
}

uint64_t mspring_network_fallback_count(const mspring_network *network) {
    return network ? network->fallback_count : 0;
}

/// Settings that may change between steps: solver, gravity, global damping.
#include "network.h"

#include <math.h>

mspring_result mspring_network_set_solver(mspring_network *network, const mspring_solver_def *def) {
    mspring_result result = mspringi_enter(network);
    if (result != MSPRING_OK)
        return result;
    mspringi_message *message = &network->message;
    if (!def)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "solver definition is NULL");
    result = mspringi_check_struct(message, "mspring_solver_def", def->struct_size, sizeof *def, sizeof *def);
    if (result != MSPRING_OK)
        return result;
    if (def->solver != MSPRING_SOLVER_EXPLICIT)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "solver is %d, which is none", (int)def->solver);
    const bool automatic = def->substeps == MSPRING_SUBSTEPS_AUTO;
    if (!automatic && (def->substeps < 1 || def->substeps > MSPRING_MAX_SUBSTEPS))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "substeps is %u, it must be 1 to %u",
                             (unsigned)def->substeps, (unsigned)MSPRING_MAX_SUBSTEPS);
    if (def->max_substeps < 1 || def->max_substeps > MSPRING_MAX_SUBSTEPS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "max_substeps is %u, it must be 1 to %u",
                             (unsigned)def->max_substeps, (unsigned)MSPRING_MAX_SUBSTEPS);
    network->auto_substeps = automatic;
    network->substeps = automatic ? 1 : def->substeps;
    network->max_substeps = def->max_substeps;
    return MSPRING_OK;
}

mspring_result mspring_network_set_gravity(mspring_network *network, float x, float y) {
    mspring_result result = mspringi_enter(network);
    if (result != MSPRING_OK)
        return result;
    if (!isfinite(x) || !isfinite(y))
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "gravity (%g, %g) m/s^2 is not finite",
                             (double)x, (double)y);
    network->gravity_x = x;
    network->gravity_y = y;
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

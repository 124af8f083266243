/// The check of the whole state after a step, for builds with asserts.
#include "step/finite.h"

#include <math.h>

#include "store/feature.h"
#include "store/springs.h"

static bool are_finite(const float *values, size_t count) {
    uint32_t others = 0;
    for (size_t i = 0; i < count; ++i)
        others |= !isfinite(values[i]);
    return others == 0;
}

static bool is_motion_finite(const mspring_network *network) {
    const size_t slots = mspringi_slot_count(network), used = mspringi_used_slots(network);
    bool finite = true;
    for (size_t i = 0; i < mspringi_state_arrays(network); ++i)
        finite = finite && are_finite(network->state.x + i * slots, used) &&
                 (network->sleep.sleeping == 0 || are_finite(network->sleep.state + i * slots, used));
    return finite && isfinite(network->origin_x) && isfinite(network->origin_y) && isfinite(network->steps.time);
}

static bool are_forces_finite(const mspring_network *network) {
    const mspringi_field fields[] = {network->forces.held, network->forces.first,
                                     network->sleep.sleeping > 0 ? network->sleep.force
                                                                 : (mspringi_field){NULL, NULL}};
    const size_t used = mspringi_used_slots(network);
    bool finite = true;
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i)
        finite = finite && (!fields[i].x || (are_finite(fields[i].x, used) && are_finite(fields[i].y, used)));
    return finite;
}

static bool are_features_finite(const mspring_network *network) {
    bool finite = true;
#define FINITE(function) finite = finite && function(network);
#include "store/features.def"
    return finite;
}

static bool are_springs_finite(const mspring_network *network) {
    bool finite = true;
    for (mspring_id s = 0; finite && s < network->topology.spring_count; ++s) {
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, s);
        if (!mspringi_spring_exists(network, s))
            continue;
        const mspringi_spring_values values = mspringi_spring_slot_get(network, spring_slot);
        finite = isfinite(values.stiffness) && isfinite(values.damping) && isfinite(values.rest_length);
    }
    return finite;
}

bool mspringi_is_finite(const mspring_network *network) {
    const mspringi_solver *solver = &network->solver;
    return is_motion_finite(network) && are_forces_finite(network) && are_features_finite(network) &&
           are_springs_finite(network) && (!solver->ops->is_finite || solver->ops->is_finite(solver->object));
}

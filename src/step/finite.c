/// The check of the whole state after a step, for builds with asserts.
#include "step/finite.h"

#include <math.h>

#include "features/contact/contacts.h"
#include "features/contact/floor.h"
#include "features/grips/grips.h"
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
    const mspringi_field fields[] = {
        network->forces.held, network->sleep.sleeping > 0 ? network->sleep.force : (mspringi_field){NULL, NULL},
        network->floor ? network->floor->impulse : (mspringi_field){NULL, NULL}};
    const size_t used = mspringi_used_slots(network);
    bool finite = true;
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i)
        finite = finite && (!fields[i].x || (are_finite(fields[i].x, used) && are_finite(fields[i].y, used)));
    return finite;
}

static bool are_contacts_finite(const mspring_network *network) {
    bool finite = true;
    for (uint32_t i = 0; i < mspringi_grip_count(network); ++i) {
        const mspringi_grip *grip = &network->grips->list[i];
        finite = finite && isfinite(grip->impulse_x) && isfinite(grip->impulse_y) && isfinite(grip->from_x) &&
                 isfinite(grip->from_y);
    }
    for (uint32_t i = 0; network->contacts && i < network->contacts->colliders.count; ++i) {
        const mspringi_collider *c = &network->contacts->colliders.list[i];
        finite = finite && isfinite(c->impulse_x) && isfinite(c->impulse_y) && isfinite(c->angular) &&
                 isfinite(c->def.x) && isfinite(c->def.y) && isfinite(c->def.angle);
    }
    return finite;
}

static bool are_springs_finite(const mspring_network *network) {
    const mspringi_plastic *plastic = &network->plastic;
    bool finite = isfinite(plastic->dissipated);
    for (mspring_id s = 0; finite && s < network->topology.spring_count; ++s) {
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, s);
        if (!mspringi_spring_exists(network, s))
            continue;
        const mspringi_spring_values values = mspringi_spring_slot_get(network, spring_slot);
        finite = isfinite(values.stiffness) && isfinite(values.damping) && isfinite(values.rest_length) &&
                 (!plastic->nominal || isfinite(plastic->nominal[spring_slot]));
    }
    return finite;
}

bool mspringi_is_finite(const mspring_network *network) {
    const mspringi_solver *solver = &network->solver;
    return is_motion_finite(network) && are_forces_finite(network) && are_contacts_finite(network) &&
           are_springs_finite(network) && (!solver->ops->is_finite || solver->ops->is_finite(solver->object));
}

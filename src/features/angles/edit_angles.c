/// Definition of angle springs.
#include "features/angles/angles.h"

#include <math.h>

#include "base/cpu.h"
#include "base/rotation.h"
#include "features/areas/edit_areas.h"
#include "store/changed.h"

#define STRONGEST 1e30f

/* ------------------------------------------------------------------------------------------------------ checks */

static mspring_result check_def(mspring_network *network, const mspring_angle_def **given, mspring_angle_def *def) {
    mspringi_message *message = &network->message;
    const mspring_result result = mspringi_take_angle_def(message, given, def);
    if (result != MSPRING_OK)
        return result;
    if (!(def->stiffness >= 0.0f && def->stiffness <= STRONGEST && def->damping >= 0.0f &&
          def->damping <= STRONGEST))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the angle's stiffness is %g and its damping %g, they must be 0 to %g",
                             (double)def->stiffness, (double)def->damping, (double)STRONGEST);
    if (def->rest_angle != MSPRING_REST_ANGLE_PRESENT && !(fabs((double)def->rest_angle) <= MSPRINGI_MAX_ANGLE))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the rest angle is %g rad, it must be at most 1e6 in size", (double)def->rest_angle);
    return MSPRING_OK;
}

// Check that both arms have a direction.
static mspring_result check_arms(mspring_network *network, const mspring_id particles[3]) {
    const uint32_t *slots = network->topology.slot_of_particle;
    for (int i = 0; i < 2; ++i) {
        const uint32_t from = slots[particles[i]], to = slots[particles[i + 1]];
        if (mspringi_x_of(&network->state, from) == mspringi_x_of(&network->state, to) &&
            mspringi_y_of(&network->state, from) == mspringi_y_of(&network->state, to))
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                 "the angle has particles %u and %u in one place", (unsigned)particles[i],
                                 (unsigned)particles[i + 1]);
    }
    return MSPRING_OK;
}

/* ------------------------------------------------------------------------------------------------------ adding */

static double rest_of(const mspring_network *network, const mspring_angle_def *def, const mspring_id particles[3]) {
    const uint32_t *slots = network->topology.slot_of_particle;
    return def->rest_angle != MSPRING_REST_ANGLE_PRESENT
               ? (double)def->rest_angle
               : mspringi_angle_between(network, slots[particles[0]], slots[particles[1]], slots[particles[2]]);
}

static MSPRINGI_NOINLINE mspring_result add_angles(mspring_network *network, const mspring_angle_def *def,
                                                   const mspring_id *particles, uint32_t count, uint32_t stride,
                                                   mspring_id *first_element) {
    mspring_angle_def taken;
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = check_def(network, &def, &taken);
    if (result == MSPRING_OK && !particles && count > 0)
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "the list of particles is NULL");
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        result = mspringi_check_corners(network, "angle", particles + (size_t)stride * i, 3);
        if (result == MSPRING_OK)
            result = check_arms(network, particles + (size_t)stride * i);
    }
    if (result == MSPRING_OK && count > 0)
        result = mspringi_areas_check_room(network, count, (size_t)3 * count, count);
    if (result != MSPRING_OK)
        return result;
    if (first_element)
        *first_element = mspringi_area_next_id(network);
    for (uint32_t i = 0; i < count; ++i) {
        const mspring_id *three = particles + (size_t)stride * i;
        mspringi_area_add(network, mspringi_angle_make(def->stiffness, def->damping, rest_of(network, def, three)),
                          three);
    }
    return MSPRING_OK;
}

mspring_result mspring_network_add_angles(mspring_network *network, const mspring_angle_def *def,
                                          const mspring_id *particles, uint32_t count, uint32_t stride,
                                          mspring_id *first_element) {
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = add_angles(network, def, particles, count, stride, first_element);
    mspringi_fp_leave(before);
    return result;
}

/// Definition of angle springs.
#include "features/angles/angles.h"

#include <math.h>

#include "base/cpu.h"
#include "base/rotation.h"
#include "features/areas/edit_areas.h"
#include "store/changed.h"

#define STRONGEST 1e30f

/* ------------------------------------------------------------------------------------------------------ checks */

static mspring_result check_rest_angle(mspring_network *network, double rest_angle) {
    return fabs(rest_angle) <= MSPRINGI_MAX_ANGLE
               ? MSPRING_OK
               : mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "the rest angle is %g rad, it must be at most 1e6 in size", rest_angle);
}

static mspring_result check_def(mspring_network *network, const mspring_angle_def **given, mspring_angle_def *def) {
    mspringi_message *message = &network->message;
    const mspring_result result = mspringi_take_angle_def(message, given, def);
    if (result != MSPRING_OK)
        return result;
    if (def->flags & ~(uint32_t)MSPRING_ANGLE_REST_GIVEN)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "flags of mspring_angle_def are 0x%x",
                             (unsigned)def->flags);
    if (!(def->stiffness >= 0.0f && def->stiffness <= STRONGEST && def->damping >= 0.0f &&
          def->damping <= STRONGEST))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the angle's stiffness is %g and its damping %g, they must be 0 to %g",
                             (double)def->stiffness, (double)def->damping, (double)STRONGEST);
    return check_rest_angle(network, def->rest_angle);
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
    return def->flags & MSPRING_ANGLE_REST_GIVEN
               ? def->rest_angle
               : mspringi_angle_between(network, slots[particles[0]], slots[particles[1]], slots[particles[2]]);
}

static MSPRINGI_NOINLINE mspring_result add_angles(mspring_network *network, const mspring_angle_def *def,
                                                   const mspring_id *particles, uint32_t count,
                                                   mspring_id *first_angle) {
    mspring_angle_def taken;
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = check_def(network, &def, &taken);
    if (result == MSPRING_OK && !particles && count > 0)
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "the list of particles is NULL");
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        result = mspringi_check_corners(network, "angle", particles + (size_t)3 * i, 3);
        if (result == MSPRING_OK)
            result = check_arms(network, particles + (size_t)3 * i);
    }
    if (result == MSPRING_OK && count > 0)
        result = mspringi_areas_check_room(network, count, (size_t)3 * count, count);
    if (result != MSPRING_OK)
        return result;
    if (first_angle)
        *first_angle = mspringi_area_next_id(network);
    for (uint32_t i = 0; i < count; ++i) {
        const mspring_id *three = particles + (size_t)3 * i;
        mspringi_area_add(network, mspringi_angle_make(def->stiffness, def->damping, rest_of(network, def, three)),
                          three);
    }
    return MSPRING_OK;
}

mspring_result mspring_network_add_angles(mspring_network *network, const mspring_angle_def *def,
                                          const mspring_id *particles, uint32_t count, mspring_id *first_angle) {
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = add_angles(network, def, particles, count, first_angle);
    mspringi_fp_leave(before);
    return result;
}

mspring_result mspring_network_remove_angle(mspring_network *network, mspring_id angle) {
    return mspringi_area_remove(network, angle, true);
}

/* ---------------------------------------------------------------------------------------------------- changing */

static MSPRINGI_NOINLINE mspring_result set_angle(mspring_network *network, mspring_id angle,
                                                  const mspring_angle_def *def) {
    mspring_angle_def taken;
    mspringi_area *found = NULL;
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = mspringi_area_find(network, angle, true, &found);
    if (result == MSPRING_OK)
        result = check_def(network, &def, &taken);
    if (result != MSPRING_OK)
        return result;
    mspring_id three[3];
    for (uint32_t i = 0; i < 3; ++i)
        three[i] = network->areas->corners[found->first + i].particle;
    found->stiffness = def->stiffness;
    found->damping = def->damping;
    mspringi_angle_set_rest(found, rest_of(network, def, three));
    network->areas->changes++;
    mspringi_area_tell(network, MSPRINGI_EDIT_SET_AREA, found);
    return MSPRING_OK;
}

mspring_result mspring_network_set_angle(mspring_network *network, mspring_id angle, const mspring_angle_def *def) {
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = set_angle(network, angle, def);
    mspringi_fp_leave(before);
    return result;
}

static MSPRINGI_NOINLINE mspring_result set_rest_angles(mspring_network *network, mspring_id first, uint32_t count,
                                                        const double *rest_angles, uint32_t stride) {
    mspringi_area *found = NULL;
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK && !rest_angles && count > 0)
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "the list of rest angles is NULL");
    if (result == MSPRING_OK && count > mspringi_area_next_id(network))
        result = mspringi_fail(&network->message, MSPRING_ERROR_ID, "there are no %u angles", (unsigned)count);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        result = mspringi_area_find(network, first + i, true, &found);
        if (result == MSPRING_OK)
            result = check_rest_angle(network, rest_angles[(size_t)i * stride]);
    }
    if (result != MSPRING_OK || count == 0)
        return result;
    // Ids are consecutive, and so are the angles in the list. found is the last.
    mspringi_area *of_first = found - (count - 1);
    for (uint32_t i = 0; i < count; ++i)
        mspringi_angle_set_rest(&of_first[i], rest_angles[(size_t)i * stride]);
    mspringi_notify_change(network, MSPRINGI_CHANGED_REST_ANGLES, 0);
    return MSPRING_OK;
}

mspring_result mspring_network_set_rest_angles(mspring_network *network, mspring_id first, uint32_t count,
                                               const double *rest_angles, uint32_t stride) {
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = set_rest_angles(network, first, count, rest_angles, stride);
    mspringi_fp_leave(before);
    return result;
}

/* ----------------------------------------------------------------------------------------------------- reading */

mspring_result mspring_network_get_angle(const mspring_network *network, mspring_id angle, mspring_angle_def *def) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_angle_def, def);
    if (result != MSPRING_OK)
        return result;
    const mspringi_area *found = mspringi_area_look_up(network, angle, true);
    if (!found)
        return MSPRING_ERROR_ID;
    const mspring_angle_def had = {.stiffness = found->stiffness,
                                   .damping = found->damping,
                                   .flags = MSPRING_ANGLE_REST_GIVEN,
                                   .rest_angle = found->rest_angle};
    mspringi_put_angle_def(def, &had);
    return MSPRING_OK;
}

mspring_result mspring_network_get_angle_info(const mspring_network *network, mspring_id angle,
                                              mspring_angle_info *info) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_angle_info, info);
    if (result != MSPRING_OK)
        return result;
    const mspringi_area *found = mspringi_area_look_up(network, angle, true);
    if (!found)
        return MSPRING_ERROR_ID;
    const bool is_open = mspringi_area_is_open(network, found);
    const double size = mspringi_area_size(network, found);
    const mspringi_corner *corners = network->areas->corners + found->first;
    const mspring_angle_info made = {
        .is_open = is_open,
        .a = corners[0].particle,
        .b = corners[1].particle,
        .c = corners[2].particle,
        .angle = mspringi_angles->between_arms(network, found),
        .torque = is_open ? 0.0 : mspringi_angle_torque(found, size),
        .energy = is_open ? 0.0 : mspringi_angle_energy(found, size),
    };
    mspringi_put_angle_info(info, &made);
    return MSPRING_OK;
}

mspring_result mspring_network_get_angles(const mspring_network *network, mspring_id *ids, double *angles,
                                          double *torques, uint32_t capacity, uint32_t *count) {
    return mspringi_areas_measure(network, true, ids, angles, torques, capacity, count);
}

/// Areas and angles, read and changed. In a file of its own, as the library may be built without them.
#include <stdlib.h>

#include "support.h"

static mspring_result set_one(mspring_network *network, mspring_property property, mspring_id element, float value) {
    return mspring_network_set(network, property, &element, 0, 1, &value, 1);
}

static double get_one(const mspring_network *network, mspring_property property, mspring_id element) {
    float value = 0.0f;
    check_ok(mspring_network_get(network, property, &element, 0, 1, &value, 1));
    return (double)value;
}

/// Flags of an element; an error if it is not of the kind.
static uint32_t flags_of(const mspring_network *network, mspring_id element, uint32_t kind, mspring_result *result) {
    uint32_t flags = 0;
    *result = mspring_network_get_integers(network, MSPRING_ELEMENT_FLAGS, &element, 0, 1, &flags, 1);
    if (*result == MSPRING_OK && !(flags & kind))
        *result = MSPRING_ERROR_ID;
    return flags;
}

mspring_result support_set_area(mspring_network *network, mspring_id area, const mspring_area_def *def) {
    mspring_result result = set_one(network, MSPRING_ELEMENT_STIFFNESS, area, def->stiffness);
    if (result == MSPRING_OK)
        result = set_one(network, MSPRING_PRESSURE, area, def->pressure);
    if (result == MSPRING_OK)
        result = set_one(network, MSPRING_FILL, area, def->fill);
    return result == MSPRING_OK ? set_one(network, MSPRING_REST_AREA, area, def->rest_area) : result;
}

mspring_result support_get_area(const mspring_network *network, mspring_id area, mspring_area_def *def) {
    mspring_result result;
    (void)flags_of(network, area, MSPRING_ELEMENT_AREA, &result);
    if (result != MSPRING_OK)
        return result;
    def->stiffness = (float)get_one(network, MSPRING_ELEMENT_STIFFNESS, area);
    def->pressure = (float)get_one(network, MSPRING_PRESSURE, area);
    def->fill = (float)get_one(network, MSPRING_FILL, area);
    def->rest_area = (float)get_one(network, MSPRING_REST_AREA, area);
    return MSPRING_OK;
}

mspring_result support_get_area_info(const mspring_network *network, mspring_id area, support_area_info *info) {
    mspring_result result;
    const uint32_t flags = flags_of(network, area, MSPRING_ELEMENT_AREA, &result);
    if (result == MSPRING_OK)
        result = mspring_network_get_element_particles(network, area, NULL, 0, &info->particle_count);
    if (result != MSPRING_OK)
        return result;
    info->is_open = (flags & MSPRING_ELEMENT_OPEN) != 0;
    info->area = get_one(network, MSPRING_AREA, area);
    info->pressure = get_one(network, MSPRING_ACTIVE_PRESSURE, area);
    info->energy = get_one(network, MSPRING_ELEMENT_ENERGY, area);
    return MSPRING_OK;
}

mspring_result support_set_angle(mspring_network *network, mspring_id angle, const mspring_angle_def *def) {
    mspring_result result = set_one(network, MSPRING_ELEMENT_STIFFNESS, angle, def->stiffness);
    if (result == MSPRING_OK)
        result = set_one(network, MSPRING_ELEMENT_DAMPING, angle, def->damping);
    if (result != MSPRING_OK)
        return result;
    const float rest = def->rest_angle == MSPRING_REST_ANGLE_PRESENT ? (float)get_one(network, MSPRING_ANGLE, angle)
                                                                     : def->rest_angle;
    return set_one(network, MSPRING_REST_ANGLE, angle, rest);
}

mspring_result support_get_angle(const mspring_network *network, mspring_id angle, mspring_angle_def *def) {
    mspring_result result;
    (void)flags_of(network, angle, MSPRING_ELEMENT_ANGLE, &result);
    if (result != MSPRING_OK)
        return result;
    def->stiffness = (float)get_one(network, MSPRING_ELEMENT_STIFFNESS, angle);
    def->damping = (float)get_one(network, MSPRING_ELEMENT_DAMPING, angle);
    def->rest_angle = (float)get_one(network, MSPRING_REST_ANGLE, angle);
    return MSPRING_OK;
}

mspring_result support_get_angle_info(const mspring_network *network, mspring_id angle, support_angle_info *info) {
    mspring_id corners[3] = {MSPRING_NONE, MSPRING_NONE, MSPRING_NONE};
    uint32_t count = 0;
    mspring_result result;
    const uint32_t flags = flags_of(network, angle, MSPRING_ELEMENT_ANGLE, &result);
    if (result == MSPRING_OK)
        result = mspring_network_get_element_particles(network, angle, corners, 3, &count);
    if (result != MSPRING_OK)
        return result;
    *info = (support_angle_info){.is_open = (flags & MSPRING_ELEMENT_OPEN) != 0,
                                 .a = corners[0],
                                 .b = corners[1],
                                 .c = corners[2],
                                 .angle = get_one(network, MSPRING_ANGLE, angle),
                                 .torque = get_one(network, MSPRING_TORQUE, angle),
                                 .energy = get_one(network, MSPRING_ELEMENT_ENERGY, angle)};
    return MSPRING_OK;
}

mspring_result support_set_rest_angles(mspring_network *network, mspring_id first, uint32_t count,
                                       const double *rest_angles, uint32_t stride) {
    float *values = calloc(count + 1, sizeof *values);
    assert_non_null(values);
    for (uint32_t i = 0; i < count; ++i)
        values[i] = (float)rest_angles[(size_t)i * stride];
    const mspring_result result = mspring_network_set(network, MSPRING_REST_ANGLE, NULL, first, count, values, 1);
    free(values);
    return result;
}

static mspring_result list_elements(const mspring_network *network, uint32_t kind, mspring_property size,
                                    mspring_property push, mspring_id *ids, double *sizes, double *pushes,
                                    uint32_t capacity, uint32_t *count) {
    *count = 0;
    for (mspring_id id = 0; id < mspring_network_count(network, MSPRING_ELEMENTS); ++id) {
        mspring_result result;
        (void)flags_of(network, id, kind, &result);
        if (result != MSPRING_OK || (*count)++ >= capacity)
            continue;
        if (ids)
            ids[*count - 1] = id;
        if (sizes)
            sizes[*count - 1] = get_one(network, size, id);
        if (pushes)
            pushes[*count - 1] = get_one(network, push, id);
    }
    return MSPRING_OK;
}

mspring_result support_get_areas(const mspring_network *network, mspring_id *ids, double *areas, double *pressures,
                                 uint32_t capacity, uint32_t *count) {
    return list_elements(network, MSPRING_ELEMENT_AREA, MSPRING_AREA, MSPRING_ACTIVE_PRESSURE, ids, areas, pressures,
                         capacity, count);
}

mspring_result support_get_angles(const mspring_network *network, mspring_id *ids, double *angles, double *torques,
                                  uint32_t capacity, uint32_t *count) {
    return list_elements(network, MSPRING_ELEMENT_ANGLE, MSPRING_ANGLE, MSPRING_TORQUE, ids, angles, torques, capacity,
                         count);
}

/// Edits of particle and spring properties between steps.
#include "base/cpu.h"
#include "edits/edit_values.h"

static mspring_result check_property(mspring_network *network, mspring_property property) {
    const mspringi_property *known = mspringi_property_of(property);
    if (!known)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "there is no property %d", (int)property);
    if (!known->is_writable)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "property %d, %s, can only be read",
                             (int)property, known->name);
    return MSPRING_OK;
}

static bool exists(const mspring_network *network, mspringi_kind kind, mspring_id id) {
    return kind == MSPRINGI_PARTICLES ? mspringi_particle_exists(network, id) : mspringi_spring_exists(network, id);
}

// Check the values of a range. Those for removed elements are ignored.
static mspring_result check_values(mspring_network *network, const mspringi_selection *at,
                                   const mspringi_values *values) {
    const mspringi_property *property = mspringi_property_of(values->property);
    if (mspringi_are_allowed(values->property, values->first, at->count, values->stride))
        return MSPRING_OK;
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id id = mspringi_selected(at, i);
        const float value = mspringi_value_of(values, i);
        if (exists(network, property->kind, id) && !mspringi_are_allowed(values->property, &value, 1, 1))
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "%s %u: %s is %g%s, it must be %s",
                                 property->kind == MSPRINGI_PARTICLES ? "particle" : "spring", (unsigned)id,
                                 property->name, (double)value, property->unit, property->range);
    }
    return MSPRING_OK;
}

static mspring_result set_values(mspring_network *network, const mspringi_selection *at,
                                 const mspringi_values *values) {
    const bool is_of_springs = mspringi_property_of(values->property)->kind == MSPRINGI_SPRINGS;
    if (is_of_springs && mspringi_springs_have_values(network, at, values))
        return MSPRING_OK;
    mspring_result result = check_values(network, at, values);
    if (result != MSPRING_OK || at->count == 0)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    result = is_of_springs ? mspringi_set_spring_values(network, at, values)
                           : mspringi_set_particle_values(network, at, values);
    mspringi_fp_leave(before);
    return result;
}

mspring_result mspring_network_set(mspring_network *network, mspring_property property, mspring_id first,
                                   uint32_t count, const float *values, uint32_t stride) {
    mspringi_selection at;
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = check_property(network, property);
    if (result == MSPRING_OK)
        result =
            mspringi_select_range(network, mspringi_property_of(property)->kind, first, count, values, values, &at);
    return result == MSPRING_OK ? set_values(network, &at, &(mspringi_values){property, values, stride}) : result;
}

mspring_result mspring_network_set_at(mspring_network *network, mspring_property property, const mspring_id *ids,
                                      uint32_t count, const float *values, uint32_t stride) {
    mspringi_selection at;
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = check_property(network, property);
    if (result == MSPRING_OK)
        result =
            mspringi_select_list(network, mspringi_property_of(property)->kind, ids, count, values, values, &at);
    return result == MSPRING_OK ? set_values(network, &at, &(mspringi_values){property, values, stride}) : result;
}

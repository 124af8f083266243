/// Edits of particle and spring properties between steps.
#include "base/cpu.h"
#include "edits/edit_values.h"
#include "features/contact/contacts.h"

static mspring_result check_property(mspring_network *network, mspring_property property, bool is_of_integers) {
    const mspringi_property *known = mspringi_property_of(property);
    if (!known)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "there is no property 0x%x",
                             (unsigned)property);
    if (!known->is_writable)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "property 0x%x, %s, can only be read",
                             (unsigned)property, known->name);
    if (mspringi_is_of_integers(property) != is_of_integers)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "property 0x%x, %s, has %s values: call %s",
                             (unsigned)property, known->name, is_of_integers ? "float" : "integer",
                             is_of_integers ? "mspring_network_set()" : "mspring_network_set_integers()");
    return MSPRING_OK;
}

// Check the values of a range. Those for removed elements are ignored.
static mspring_result check_values(mspring_network *network, const mspringi_selection *at,
                                   const mspringi_values *values) {
    const mspringi_property *property = mspringi_property_of(values->property);
    const mspringi_thing_ops *of = mspringi_things_of(mspringi_kind_of(values->property));
    if (mspringi_are_allowed(values->property, values->first, at->count, values->stride))
        return MSPRING_OK;
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id id = mspringi_selected(at, i);
        const float value = mspringi_value_of(values, i);
        if (of->exists(network, id) && !mspringi_are_allowed(values->property, &value, 1, 1))
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "%s %u: %s is %g%s, it must be %s",
                                 of->name, (unsigned)id, property->name, (double)value, property->unit,
                                 property->range);
    }
    return MSPRING_OK;
}

static mspring_result set_values(mspring_network *network, const mspringi_selection *at,
                                 const mspringi_values *values) {
    const mspringi_thing_ops *of = mspringi_things_of(mspringi_kind_of(values->property));
    if (of->kind == MSPRING_SPRINGS && mspringi_springs_have_values(network, at, values))
        return MSPRING_OK;
    mspring_result result = check_values(network, at, values);
    if (result != MSPRING_OK || at->count == 0)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    result = of->kind == MSPRING_SPRINGS     ? mspringi_set_spring_values(network, at, values)
             : of->kind == MSPRING_PARTICLES ? mspringi_set_particle_values(network, at, values)
                                             : of->set(network, at, values);
    mspringi_fp_leave(before);
    return result;
}

mspring_result mspring_network_set(mspring_network *network, mspring_property property, const mspring_id *ids,
                                   mspring_id first, uint32_t count, const float *values, uint32_t stride) {
    mspringi_selection at;
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = check_property(network, property, false);
    if (result == MSPRING_OK)
        result = mspringi_select_for(network, mspringi_kind_of(property), ids, first, count, values, values, stride,
                                     &at);
    return result == MSPRING_OK ? set_values(network, &at, &(mspringi_values){property, values, stride}) : result;
}

// Only contact has integers that can be set: layers and masks.
mspring_result mspring_network_set_integers(mspring_network *network, mspring_property property,
                                            const mspring_id *ids, mspring_id first, uint32_t count,
                                            const uint32_t *values, uint32_t stride) {
    mspringi_selection at;
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = check_property(network, property, true);
    if (result == MSPRING_OK)
        result = mspringi_select_for(network, mspringi_kind_of(property), ids, first, count, values, values, stride,
                                     &at);
    return result == MSPRING_OK ? mspringi_contact_set_layers(network, property, &at, values, stride) : result;
}

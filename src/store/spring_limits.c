/// Calls of all features that keep limits of springs.
#include "store/spring_limits.h"

#include <string.h>

#include "store/metres.h"
#include "store/properties.h"

static const mspringi_limit_ops *const all[] = {
#define LIMITS(table) &table,
#include "store/features.def"
    NULL};

static const mspringi_limit_ops *owner_of(mspring_property property) {
    const mspringi_limit_ops *const *ops = all;
    while (*ops && !(property >= (*ops)->first && property <= (*ops)->last))
        ++ops;
    return *ops;
}

mspring_result mspringi_limit_reserve(mspring_network *network, mspring_property property) {
    const mspringi_limit_ops *owner = owner_of(property);
    return owner ? owner->reserve(network, property)
                 : mspringi_fail(
                       &network->message, MSPRING_ERROR_ARGUMENT,
                       "springs have no %s here: this build of the library lacks the part laws (MASSSPRING_PARTS)",
                       mspringi_property_of(property)->name);
}

mspring_result mspringi_limits_reserve(mspring_network *network, mspringi_limits limits) {
    const struct {
        mspring_property property;
        bool is_given;
    } needs[] = {{MSPRING_BREAK_STRAIN, limits.break_strain < MSPRING_NEVER},
                 {MSPRING_WARN_STRAIN, limits.warn_strain < MSPRING_NEVER},
                 {MSPRING_RELAX_STRAIN, limits.relax_strain != MSPRING_RELAX_STRAIN_DEFAULT},
                 {MSPRING_YIELD_STRAIN, mspringi_has_plasticity(limits)}};
    mspring_result result = MSPRING_OK;
    for (size_t i = 0; result == MSPRING_OK && i < sizeof needs / sizeof needs[0]; ++i)
        if (needs[i].is_given)
            result = mspringi_limit_reserve(network, needs[i].property);
    return result;
}

mspring_result mspringi_limits_match_layout(mspring_network *to, const mspring_network *from) {
    mspring_result result = MSPRING_OK;
    for (const mspringi_limit_ops *const *ops = all; result == MSPRING_OK && *ops; ++ops)
        result = (*ops)->match_layout(to, from);
    return result;
}

void mspringi_limit_store(mspring_network *network, mspringi_spring_slot spring_slot, mspring_property property,
                          float value) {
    if (property <= MSPRING_RELAX_STRAIN)
        mspringi_sent_forget(&network->sent[mspringi_sent_index(property)]);
    owner_of(property)->store(network, spring_slot, property, value);
}

void mspringi_limits_put(mspring_network *network, mspring_id spring, uint32_t flags, mspringi_limits limits) {
    if (flags & MSPRING_SPRING_METRES)
        limits = mspringi_metres_put(network, spring, limits);
    for (const mspringi_limit_ops *const *ops = all; *ops; ++ops)
        (*ops)->put(network, spring, limits);
}

void mspringi_limits_forget(mspring_network *network, mspring_id spring) {
    if (network->metres)
        memset(network->metres + (size_t)MSPRINGI_METRES * spring, 0, MSPRINGI_METRES * sizeof *network->metres);
    for (const mspringi_limit_ops *const *ops = all; *ops; ++ops)
        (*ops)->forget(network, spring);
}

void mspringi_limits_renew(mspring_network *network, mspringi_spring_slot spring_slot) {
    for (const mspringi_limit_ops *const *ops = all; *ops; ++ops)
        (*ops)->renew(network, spring_slot);
}

float *mspringi_limits_of(const mspring_network *network, mspring_property property) {
    const mspringi_strain *strain = &network->strain;
    const mspringi_tested *tested = &network->tested;
    return property == MSPRING_BREAK_STRAIN    ? strain->break_strain
           : property == MSPRING_WARN_STRAIN   ? strain->warn_strain
           : property == MSPRING_RELAX_STRAIN  ? strain->relax_strain
           : property == MSPRING_YIELD_STRAIN  ? tested->yield_strain
           : property == MSPRING_HARDENING     ? tested->hardening
           : property == MSPRING_PLASTIC_LIMIT ? tested->plastic_limit
                                               : NULL;
}

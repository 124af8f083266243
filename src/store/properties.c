#include "store/properties.h"

#include <math.h>

#include "store/spring_limits.h"
#include "store/springs.h"

static const mspringi_property list[] = {
    [MSPRING_MASS] = {"mass", " kg", "1e-30 to 1e30", MSPRINGI_PARTICLES, true},
    [MSPRING_INVERSE_MASS_SCALE] = {"scale of inverse mass", "", "0 or 1e-6 to 1", MSPRINGI_PARTICLES, true},
    [MSPRING_STIFFNESS] = {"stiffness", "", "0 to 1e30", MSPRINGI_SPRINGS, true},
    [MSPRING_DAMPING] = {"damping", "", "0 to 1e30", MSPRINGI_SPRINGS, true},
    [MSPRING_REST_LENGTH] = {"rest length", " m", "0 to 4e12", MSPRINGI_SPRINGS, true},
    [MSPRING_BREAK_STRAIN] = {"break strain", "", "> 0", MSPRINGI_SPRINGS, true},
    [MSPRING_STRESS_STRAIN] = {"stress strain", "", "> 0", MSPRINGI_SPRINGS, true},
    [MSPRING_RELAX_STRAIN] = {"relax strain", "", ">= 0 or MSPRING_RELAX_STRAIN_DEFAULT", MSPRINGI_SPRINGS, true},
    [MSPRING_STRAIN] = {"strain", "", "", MSPRINGI_SPRINGS, false},
    [MSPRING_LENGTH] = {"length", " m", "", MSPRINGI_SPRINGS, false},
    [MSPRING_FORCE] = {"force", " N", "", MSPRINGI_SPRINGS, false},
    [MSPRING_ACTIVE_STIFFNESS] = {"stiffness in force", " N/m", "", MSPRINGI_SPRINGS, false},
    [MSPRING_ACTIVE_DAMPING] = {"damping in force", " N s/m", "", MSPRINGI_SPRINGS, false},
    [MSPRING_YIELD_STRAIN] = {"yield strain", "", "> 0", MSPRINGI_SPRINGS, true},
    [MSPRING_HARDENING] = {"hardening", "", "0 to 10", MSPRINGI_SPRINGS, true},
    [MSPRING_PLASTIC_LIMIT] = {"plastic limit", "", "0 to 0.9", MSPRINGI_SPRINGS, true},
    [MSPRING_PLASTIC_STRAIN] = {"plastic strain", "", "-0.9 to 0.9", MSPRINGI_SPRINGS, true},
    [MSPRING_ACTIVE_REST_LENGTH] = {"rest length in force", " m", "", MSPRINGI_SPRINGS, false},
};

const mspringi_property *mspringi_property_of(mspring_property property) {
    return property >= 0 && (size_t)property < sizeof list / sizeof list[0] ? &list[property] : NULL;
}

/* ------------------------------------------------------------------------------------------------------- checks */

// A loop for each test, without branches, so that several values are tested at once.
#define ALL(test)                                                                                                  \
    {                                                                                                              \
        uint32_t others = 0;                                                                                       \
        if (stride == 1)                                                                                           \
            for (uint32_t i = 0; i < count; ++i)                                                                   \
                others |= !(test(values[i]));                                                                      \
        else                                                                                                       \
            for (uint32_t i = 0; i < last; ++i)                                                                    \
                others |= !(test(values[i * stride]));                                                             \
        return others == 0;                                                                                        \
    }
#define IS_REST_LENGTH(value) ((value >= 0.0f) & (value <= 4e12f))
#define IS_HARDENING(value) ((value >= 0.0f) & (value <= MSPRINGI_MAX_HARDENING))
#define IS_PLASTIC_LIMIT(value) ((value >= 0.0f) & (value <= MSPRINGI_MAX_PLASTIC_STRAIN))
#define IS_PLASTIC_STRAIN(value) ((value >= -MSPRINGI_MAX_PLASTIC_STRAIN) & (value <= MSPRINGI_MAX_PLASTIC_STRAIN))
#define IS_COEFFICIENT(value) mspringi_is_spring_value(MSPRINGI_STIFFNESS, value)

bool mspringi_are_allowed(mspring_property property, const float *values, uint32_t count, size_t stride) {
    const uint32_t last = stride == 0 && count > 0 ? 1 : count;
    switch (property) {
    case MSPRING_MASS:
        ALL(mspringi_is_mass)
    case MSPRING_INVERSE_MASS_SCALE:
        ALL(mspringi_is_inverse_mass_scale)
    case MSPRING_STIFFNESS:
    case MSPRING_DAMPING:
        ALL(IS_COEFFICIENT)
    case MSPRING_REST_LENGTH:
        ALL(IS_REST_LENGTH)
    case MSPRING_BREAK_STRAIN:
    case MSPRING_STRESS_STRAIN:
    case MSPRING_YIELD_STRAIN:
        ALL(mspringi_is_threshold)
    case MSPRING_RELAX_STRAIN:
        ALL(mspringi_is_relax_strain)
    case MSPRING_HARDENING:
        ALL(IS_HARDENING)
    case MSPRING_PLASTIC_LIMIT:
        ALL(IS_PLASTIC_LIMIT)
    case MSPRING_PLASTIC_STRAIN:
        ALL(IS_PLASTIC_STRAIN)
    default:
        return false;
    }
}

/* ------------------------------------------------------------------------------------------------------- values */

float mspringi_particle_property(const mspring_network *network, mspring_property property, mspring_id particle) {
    if (property == MSPRING_MASS)
        return network->mass[particle];
    if (network->inverse_mass_scale)
        return network->inverse_mass_scale[particle];
    return network->inverse_mass[network->topology.slot_of_particle[particle]] > 0.0f ? 1.0f : 0.0f;
}

// Of a weld it is 0, and of one on a ramp that which it will have.
static float plastic_strain(const mspring_network *network, mspringi_spring_slot spring_slot) {
    const float *nominal = network->tested.nominal;
    if (!nominal || nominal[spring_slot] == MSPRINGI_WELD)
        return 0.0f;
    const double own = (double)mspringi_spring_slot_own_length(network, spring_slot);
    return (float)((own - (double)nominal[spring_slot]) / (double)nominal[spring_slot]);
}

static float default_limit(mspring_property property) {
    return property == MSPRING_RELAX_STRAIN    ? MSPRING_RELAX_STRAIN_DEFAULT
           : property == MSPRING_HARDENING     ? MSPRING_HARDENING_DEFAULT
           : property == MSPRING_PLASTIC_LIMIT ? MSPRING_PLASTIC_LIMIT_DEFAULT
                                               : INFINITY;
}

float mspringi_spring_property(const mspring_network *network, mspring_property property, mspring_id spring) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    const float *limits;
    switch (property) {
    case MSPRING_STIFFNESS:
        return mspringi_spring_get_nominal(network, spring, spring_slot).stiffness;
    case MSPRING_DAMPING:
        return mspringi_spring_get_nominal(network, spring, spring_slot).damping;
    case MSPRING_REST_LENGTH:
        return mspringi_spring_slot_given_length(network, spring_slot);
    case MSPRING_PLASTIC_STRAIN:
        return plastic_strain(network, spring_slot);
    default:
        limits = mspringi_limits_of(network, property);
        return limits ? limits[spring_slot] : default_limit(property);
    }
}

#include "store/properties.h"

#include <math.h>

#include "store/metres.h"
#include "store/spring_limits.h"
#include "store/springs.h"

// In the order of their numbers.
static const mspringi_property list[] = {
    {MSPRING_MASS, "mass", " kg", "1e-30 to 1e30", true},
    {MSPRING_INVERSE_MASS_SCALE, "scale of inverse mass", "", "0 or 1e-6 to 1", true},
    {MSPRING_X, "x", " m", "", false},
    {MSPRING_Y, "y", " m", "", false},
    {MSPRING_VX, "vx", " m/s", "", false},
    {MSPRING_VY, "vy", " m/s", "", false},
    {MSPRING_FRICTION, "friction", "", "0 to 1e6, or -1 for the contact's", true},
    {MSPRING_RESTITUTION, "restitution", "", "0 to 1, or -1 for the contact's", true},
    {MSPRING_FLOOR_IMPULSE_X, "impulse of the floor in x", " N s", "", false},
    {MSPRING_FLOOR_IMPULSE_Y, "impulse of the floor in y", " N s", "", false},
    {MSPRING_TOUCH, "impulse of touch", " N s", "", false},
    {MSPRING_RELATIVE_X, "relative x", " m", "", false},
    {MSPRING_RELATIVE_Y, "relative y", " m", "", false},
    {MSPRING_RELATIVE_VX, "relative vx", " m/s", "", false},
    {MSPRING_RELATIVE_VY, "relative vy", " m/s", "", false},
    {MSPRING_PARTICLE_FLAGS, "flags", "", "bits", false},
    {MSPRING_LAYERS, "layers", "", "bits", true},
    {MSPRING_MASKS, "mask", "", "bits", true},
    {MSPRING_COMPONENT, "component", "", "a number", false},
    {MSPRING_SLOT, "slot", "", "a number", false},
    {MSPRING_STIFFNESS, "stiffness", "", "0 to 1e30", true},
    {MSPRING_DAMPING, "damping", "", "0 to 1e30", true},
    {MSPRING_REST_LENGTH, "rest length", " m", "0 to 4e12", true},
    {MSPRING_BREAK_STRAIN, "break strain", "", "> 0", true},
    {MSPRING_WARN_STRAIN, "warn strain", "", "> 0", true},
    {MSPRING_RELAX_STRAIN, "relax strain", "", ">= 0 or MSPRING_RELAX_STRAIN_DEFAULT", true},
    {MSPRING_YIELD_STRAIN, "yield strain", "", "> 0", true},
    {MSPRING_HARDENING, "hardening", "", "0 to 10", true},
    {MSPRING_PLASTIC_LIMIT, "plastic limit", "", "0 to 0.9", true},
    {MSPRING_PLASTIC_STRAIN, "plastic strain", "", "-0.9 to 0.9", true},
    {MSPRING_LENGTH, "length", " m", "", false},
    {MSPRING_DIRECTION_X, "direction in x", "", "", false},
    {MSPRING_DIRECTION_Y, "direction in y", "", "", false},
    {MSPRING_STRAIN, "strain", "", "", false},
    {MSPRING_TENSION, "tension", " N", "", false},
    {MSPRING_ACTIVE_STIFFNESS, "stiffness in force", " N/m", "", false},
    {MSPRING_ACTIVE_DAMPING, "damping in force", " N s/m", "", false},
    {MSPRING_ACTIVE_REST_LENGTH, "rest length in force", " m", "", false},
    {MSPRING_SPRING_FLAGS, "flags", "", "bits", false},
    {MSPRING_END_A, "end a", "", "an id", false},
    {MSPRING_END_B, "end b", "", "an id", false},
    {MSPRING_SLOT_A, "slot of end a", "", "a number", false},
    {MSPRING_SLOT_B, "slot of end b", "", "a number", false},
    {MSPRING_ELEMENT_STIFFNESS, "stiffness", "", "0 to 1e30", true},
    {MSPRING_ELEMENT_DAMPING, "damping", " N m s/rad", "0 to 1e30", true},
    {MSPRING_PRESSURE, "pressure", " N/m", "at most 1e30 in size, of a gas at least 0", true},
    {MSPRING_FILL, "fill", "", "0.01 to 100", true},
    {MSPRING_REST_AREA, "rest area", " m^2", "0 or 1e-24 to 1e24", true},
    {MSPRING_REST_ANGLE, "rest angle", " rad", "at most 1e6 in size", true},
    {MSPRING_AREA, "area", " m^2", "", false},
    {MSPRING_ACTIVE_PRESSURE, "pressure in force", " N/m", "", false},
    {MSPRING_ANGLE, "angle", " rad", "", false},
    {MSPRING_TORQUE, "torque", " N m", "", false},
    {MSPRING_ELEMENT_ENERGY, "energy", " J", "", false},
    {MSPRING_ELEMENT_FLAGS, "flags", "", "bits", false},
    {MSPRING_GROUP_X, "x of the centre", " m", "", false},
    {MSPRING_GROUP_Y, "y of the centre", " m", "", false},
    {MSPRING_GROUP_VX, "vx of the centre", " m/s", "", false},
    {MSPRING_GROUP_VY, "vy of the centre", " m/s", "", false},
    {MSPRING_GROUP_MIN_X, "least x", " m", "", false},
    {MSPRING_GROUP_MIN_Y, "least y", " m", "", false},
    {MSPRING_GROUP_MAX_X, "largest x", " m", "", false},
    {MSPRING_GROUP_MAX_Y, "largest y", " m", "", false},
    {MSPRING_GROUP_FLAGS, "flags", "", "bits", false},
    {MSPRING_SIGNAL, "signal", "", "0.01 to 100", true},
    {MSPRING_ACTUATOR_SPRING, "spring", "", "an id", false},
};

const mspringi_property *mspringi_property_of(mspring_property property) {
    size_t low = 0, high = sizeof list / sizeof list[0];
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (list[middle].number == property)
            return &list[middle];
        if (list[middle].number < property)
            low = middle + 1;
        else
            high = middle;
    }
    return NULL;
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
#define IS_FRICTION(value) ((value == -1.0f) | ((value >= 0.0f) & (value <= 1e6f)))
#define IS_RESTITUTION(value) ((value == -1.0f) | ((value >= 0.0f) & (value <= 1.0f)))
#define IS_PRESSURE(value) ((value >= -1e30f) & (value <= 1e30f))
#define IS_RATIO(value) ((value >= 0.01f) & (value <= 100.0f))
#define IS_AREA(value) ((value == 0.0f) | ((value >= 1e-24f) & (value <= 1e24f)))
#define IS_ANGLE(value) ((value >= -1e6f) & (value <= 1e6f))
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
    case MSPRING_WARN_STRAIN:
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
    case MSPRING_FRICTION:
        ALL(IS_FRICTION)
    case MSPRING_RESTITUTION:
        ALL(IS_RESTITUTION)
    case MSPRING_ELEMENT_STIFFNESS:
    case MSPRING_ELEMENT_DAMPING:
        ALL(IS_COEFFICIENT)
    case MSPRING_PRESSURE:
        ALL(IS_PRESSURE)
    case MSPRING_FILL:
    case MSPRING_SIGNAL:
        ALL(IS_RATIO)
    case MSPRING_REST_AREA:
        ALL(IS_AREA)
    case MSPRING_REST_ANGLE:
        ALL(IS_ANGLE)
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
        limits = mspringi_metres_at(network, property, spring);
        if (limits)
            return *limits;
        limits = mspringi_limits_of(network, property);
        return limits ? limits[spring_slot] : default_limit(property);
    }
}

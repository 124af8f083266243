#include "store/properties.h"

#include <math.h>

#include "store/metres.h"
#include "store/spring_limits.h"
#include "store/springs.h"

#define NO_RANGE 0.0f, 0.0f, 0.0f
#define READ_ONLY false, NO_RANGE
/// Strains above 0.
#define ABOVE_0 0x1p-149f, INFINITY, INFINITY

// In the order of their numbers.
static const mspringi_property list[] = {
    {MSPRING_MASS, "mass", " kg", "1e-30 to 1e30", true, MSPRINGI_SMALLEST_MASS, MSPRINGI_LARGEST_MASS, 1.0f},
    {MSPRING_INVERSE_MASS_SCALE, "scale of inverse mass", "", "0 or 1e-6 to 1", true, MSPRINGI_SMALLEST_SCALE, 1.0f,
     0.0f},
    {MSPRING_X, "x", " m", "", READ_ONLY},
    {MSPRING_Y, "y", " m", "", READ_ONLY},
    {MSPRING_VX, "vx", " m/s", "", READ_ONLY},
    {MSPRING_VY, "vy", " m/s", "", READ_ONLY},
    {MSPRING_FRICTION, "friction", "", "0 to 1e6, or -1 for the contact's", true, 0.0f, 1e6f, -1.0f},
    {MSPRING_RESTITUTION, "restitution", "", "0 to 1, or -1 for the contact's", true, 0.0f, 1.0f, -1.0f},
    {MSPRING_FLOOR_IMPULSE_X, "impulse of the floor in x", " N s", "", READ_ONLY},
    {MSPRING_FLOOR_IMPULSE_Y, "impulse of the floor in y", " N s", "", READ_ONLY},
    {MSPRING_TOUCH, "impulse of touch", " N s", "", READ_ONLY},
    {MSPRING_RELATIVE_X, "relative x", " m", "", READ_ONLY},
    {MSPRING_RELATIVE_Y, "relative y", " m", "", READ_ONLY},
    {MSPRING_RELATIVE_VX, "relative vx", " m/s", "", READ_ONLY},
    {MSPRING_RELATIVE_VY, "relative vy", " m/s", "", READ_ONLY},
    {MSPRING_PARTICLE_FLAGS, "flags", "", "bits", READ_ONLY},
    {MSPRING_LAYERS, "layers", "", "bits", true, NO_RANGE},
    {MSPRING_MASKS, "mask", "", "bits", true, NO_RANGE},
    {MSPRING_COMPONENT, "component", "", "a number", READ_ONLY},
    {MSPRING_SLOT, "slot", "", "a number", READ_ONLY},
    {MSPRING_STIFFNESS, "stiffness", "", "0 to 1e30", true, 0.0f, 1e30f, 0.0f},
    {MSPRING_DAMPING, "damping", "", "0 to 1e30", true, 0.0f, 1e30f, 0.0f},
    {MSPRING_REST_LENGTH, "rest length", " m", "0 to 4e12", true, 0.0f, 4e12f, 0.0f},
    {MSPRING_BREAK_STRAIN, "break strain", "", "> 0", true, ABOVE_0},
    {MSPRING_WARN_STRAIN, "warn strain", "", "> 0", true, ABOVE_0},
    {MSPRING_RELAX_STRAIN, "relax strain", "", ">= 0 or MSPRING_RELAX_STRAIN_DEFAULT", true, 0.0f, INFINITY,
     MSPRING_RELAX_STRAIN_DEFAULT},
    {MSPRING_YIELD_STRAIN, "yield strain", "", "> 0", true, ABOVE_0},
    {MSPRING_HARDENING, "hardening", "", "0 to 10", true, 0.0f, MSPRINGI_MAX_HARDENING, 0.0f},
    {MSPRING_PLASTIC_LIMIT, "plastic limit", "", "0 to 0.9", true, 0.0f, MSPRINGI_MAX_PLASTIC_STRAIN, 0.0f},
    {MSPRING_PLASTIC_STRAIN, "plastic strain", "", "-0.9 to 0.9", true, -MSPRINGI_MAX_PLASTIC_STRAIN,
     MSPRINGI_MAX_PLASTIC_STRAIN, 0.0f},
    {MSPRING_LENGTH, "length", " m", "", READ_ONLY},
    {MSPRING_DIRECTION_X, "direction in x", "", "", READ_ONLY},
    {MSPRING_DIRECTION_Y, "direction in y", "", "", READ_ONLY},
    {MSPRING_STRAIN, "strain", "", "", READ_ONLY},
    {MSPRING_TENSION, "tension", " N", "", READ_ONLY},
    {MSPRING_ACTIVE_STIFFNESS, "stiffness in force", " N/m", "", READ_ONLY},
    {MSPRING_ACTIVE_DAMPING, "damping in force", " N s/m", "", READ_ONLY},
    {MSPRING_ACTIVE_REST_LENGTH, "rest length in force", " m", "", READ_ONLY},
    {MSPRING_SPRING_FLAGS, "flags", "", "bits", READ_ONLY},
    {MSPRING_END_A, "end a", "", "an id", READ_ONLY},
    {MSPRING_END_B, "end b", "", "an id", READ_ONLY},
    {MSPRING_SLOT_A, "slot of end a", "", "a number", READ_ONLY},
    {MSPRING_SLOT_B, "slot of end b", "", "a number", READ_ONLY},
    {MSPRING_ELEMENT_STIFFNESS, "stiffness", "", "0 to 1e30", true, 0.0f, 1e30f, 0.0f},
    {MSPRING_ELEMENT_DAMPING, "damping", " N m s/rad", "0 to 1e30", true, 0.0f, 1e30f, 0.0f},
    {MSPRING_PRESSURE, "pressure", " N/m", "at most 1e30 in size, of a gas at least 0", true, -1e30f, 1e30f, 0.0f},
    {MSPRING_FILL, "fill", "", "0.01 to 100", true, 0.01f, 100.0f, 1.0f},
    {MSPRING_REST_AREA, "rest area", " m^2", "0 or 1e-24 to 1e24", true, 1e-24f, 1e24f, 0.0f},
    {MSPRING_REST_ANGLE, "rest angle", " rad", "at most 1e6 in size", true, -1e6f, 1e6f, 0.0f},
    {MSPRING_AREA, "area", " m^2", "", READ_ONLY},
    {MSPRING_ACTIVE_PRESSURE, "pressure in force", " N/m", "", READ_ONLY},
    {MSPRING_ANGLE, "angle", " rad", "", READ_ONLY},
    {MSPRING_TORQUE, "torque", " N m", "", READ_ONLY},
    {MSPRING_ELEMENT_ENERGY, "energy", " J", "", READ_ONLY},
    {MSPRING_ELEMENT_FLAGS, "flags", "", "bits", READ_ONLY},
    {MSPRING_GROUP_X, "x of the centre", " m", "", READ_ONLY},
    {MSPRING_GROUP_Y, "y of the centre", " m", "", READ_ONLY},
    {MSPRING_GROUP_VX, "vx of the centre", " m/s", "", READ_ONLY},
    {MSPRING_GROUP_VY, "vy of the centre", " m/s", "", READ_ONLY},
    {MSPRING_GROUP_MIN_X, "least x", " m", "", READ_ONLY},
    {MSPRING_GROUP_MIN_Y, "least y", " m", "", READ_ONLY},
    {MSPRING_GROUP_MAX_X, "largest x", " m", "", READ_ONLY},
    {MSPRING_GROUP_MAX_Y, "largest y", " m", "", READ_ONLY},
    {MSPRING_GROUP_FLAGS, "flags", "", "bits", READ_ONLY},
    {MSPRING_SIGNAL, "signal", "", "0.01 to 100", true, 0.01f, 100.0f, 1.0f},
    {MSPRING_ACTUATOR_SPRING, "spring", "", "an id", READ_ONLY},
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

// Without branches, so that several values are tested at once.
bool mspringi_are_allowed(mspring_property property, const float *values, uint32_t count, size_t stride) {
    const mspringi_property *of = mspringi_property_of(property);
    if (!of || !(of->least < of->most))
        return false;
    const float least = of->least, most = of->most, also = of->also;
    const uint32_t last = stride == 0 && count > 0 ? 1 : count;
    uint32_t others = 0;
    if (stride == 1)
        for (uint32_t i = 0; i < count; ++i)
            others |= !((values[i] == also) | ((values[i] >= least) & (values[i] <= most)));
    else
        for (uint32_t i = 0; i < last; ++i)
            others |=
                !((values[i * stride] == also) | ((values[i * stride] >= least) & (values[i * stride] <= most)));
    return others == 0;
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

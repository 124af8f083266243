/// Access to properties of particles and springs.
#include <math.h>

#include "base/cpu.h"
#include "query/measure.h"
#include "store/properties.h"
#include "store/rest_lengths.h"
#include "store/springs.h"

/* ---------------------------------------------------------------------------------------- strains and lengths */

// Equal to mspringi_spring_slot_length() and mspringi_spring_slot_strain() up to rounding. Most springs lie in
// lattices. Differences of low words between neighbours are small, so single precision suffices.
static inline float low_of(float coordinate, float low, bool may_be_stale, float grid) {
    return may_be_stale ? mspringi_low_of(coordinate, low, grid) : low;
}

static inline void measure(const mspring_network *network, mspring_property property,
                           const mspringi_spring_slot *spring_slots, const mspring_id *list, uint32_t count,
                           bool may_be_stale, float *out, size_t stride) {
    const mspringi_topology *t = &network->topology;
    const mspringi_state s = network->state;
    const mspringi_rest_lengths rests = network->rest_lengths;
    const uint16_t *live = network->live;
    for (uint32_t i = 0; i < count; ++i) {
        const mspringi_spring_slot spring_slot = spring_slots[list ? list[i] : i];
        uint32_t base, tip;
        if (spring_slot >= t->lattice_spring_slots) {
            out[i * stride] = property == MSPRING_STRAIN ? mspringi_spring_slot_strain(network, spring_slot)
                                                         : mspringi_spring_slot_length(network, spring_slot);
            continue;
        }
        mspringi_lattice_ends(t, spring_slot, &base, &tip);
        const float dx = (s.x[tip] - s.x[base]) + (low_of(s.x[tip], s.low_x[tip], may_be_stale, s.grid) -
                                                   low_of(s.x[base], s.low_x[base], may_be_stale, s.grid));
        const float dy = (s.y[tip] - s.y[base]) + (low_of(s.y[tip], s.low_y[tip], may_be_stale, s.grid) -
                                                   low_of(s.y[base], s.low_y[base], may_be_stale, s.grid));
        float value = sqrtf(dx * dx + dy * dy);
        if (property == MSPRING_STRAIN) {
            const float rest_length = *mspringi_rest_lengths_at(&rests, spring_slot);
            const bool is_live = live[spring_slot / MSPRINGI_WIDTH] >> spring_slot % MSPRINGI_WIDTH & 1;
            value = is_live ? (value - rest_length) / rest_length : 0.0f;
        }
        out[i * stride] = value;
    }
}

// Special loops for contiguous ranges, and for networks without a writable view, whose low words need no check.
static void measure_all(const mspring_network *network, mspring_property property, const mspringi_selection *at,
                        float *out, size_t stride) {
    const mspringi_spring_slot *all = network->topology.slot_of_spring,
                               *spring_slots = at->list ? all : all + at->first;
    if (network->is_open)
        measure(network, property, spring_slots, at->list, at->count, true, out, stride);
    else if (at->list)
        measure(network, property, spring_slots, at->list, at->count, false, out, stride);
    else if (stride == 1)
        measure(network, property, spring_slots, NULL, at->count, false, out, 1);
    else
        measure(network, property, spring_slots, NULL, at->count, false, out, stride);
}

// The strain of a weld in a lattice is its length.
static void measure_welds(const mspring_network *network, const mspringi_selection *at, float *out, size_t stride) {
    const mspringi_topology *t = &network->topology;
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspringi_selection one = {.first = mspringi_selected(at, i), .count = 1};
        const mspringi_spring_slot spring_slot = t->slot_of_spring[one.first];
        if (spring_slot < t->lattice_spring_slots &&
            *mspringi_rest_lengths_at(&network->rest_lengths, spring_slot) == MSPRINGI_WELD &&
            mspringi_spring_slot_is_live(network, spring_slot))
            measure_all(network, MSPRING_LENGTH, &one, out + i * stride, 1);
    }
}

void mspringi_measure(const mspring_network *network, mspring_property property, const mspringi_selection *at,
                      float *out, size_t stride) {
    measure_all(network, property, at, out, stride);
    if (network->has_welds && property == MSPRING_STRAIN)
        measure_welds(network, at, out, stride);
}

/* ------------------------------------------------------------------------------------------------------ reading */

static float value_of(const mspring_network *network, mspring_property property, mspring_id id) {
    switch (property) {
    case MSPRING_MASS:
    case MSPRING_INVERSE_MASS_SCALE:
        return mspringi_particle_property(network, property, id);
    case MSPRING_FORCE:
        return mspringi_spring_force(network, id);
    case MSPRING_ACTIVE_STIFFNESS:
        return mspringi_spring_slot_get(network, mspringi_slot_of_spring(&network->topology, id)).stiffness;
    case MSPRING_ACTIVE_DAMPING:
        return mspringi_spring_slot_get(network, mspringi_slot_of_spring(&network->topology, id)).damping;
    case MSPRING_ACTIVE_REST_LENGTH:
        return mspringi_read_length(mspringi_spring_get(network, id).rest_length);
    case MSPRING_REST_LENGTH:
        return mspringi_read_length(mspringi_spring_property(network, property, id));
    default:
        return mspringi_read_value(mspringi_spring_property(network, property, id));
    }
}

static bool exists(const mspring_network *network, mspringi_kind kind, mspring_id id) {
    return kind == MSPRINGI_PARTICLES ? mspringi_particle_exists(network, id) : mspringi_spring_exists(network, id);
}

// Removed particles and springs read as 0.
static void clear_removed(const mspring_network *network, mspringi_kind kind, mspring_id first, uint32_t count,
                          float *out, size_t stride) {
    for (uint32_t i = 0; network->growth.particles && i < count; ++i)
        if (!exists(network, kind, first + i))
            out[i * stride] = 0.0f;
}

static mspring_result check(const mspring_network *network, mspring_property property) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    return mspringi_property_of(property) ? MSPRING_OK
                                          : mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT,
                                                                 "there is no property %d", (int)property);
}

static MSPRINGI_NOINLINE void get_values(const mspring_network *network, mspring_property property,
                                         const mspringi_selection *at, float *values, size_t stride) {
    if (property == MSPRING_STRAIN || property == MSPRING_LENGTH)
        mspringi_measure(network, property, at, values, stride);
    else
        for (uint32_t i = 0; i < at->count; ++i)
            values[i * stride] = value_of(network, property, mspringi_selected(at, i));
}

mspring_result mspring_network_get(const mspring_network *network, mspring_property property, mspring_id first,
                                   uint32_t count, float *values, uint32_t stride) {
    mspringi_selection at;
    mspring_result result = check(network, property);
    if (result != MSPRING_OK)
        return result;
    const mspringi_kind kind = mspringi_property_of(property)->kind;
    result = mspringi_look_up_range(network, kind, first, count, values, values, stride, &at);
    if (result != MSPRING_OK)
        return result;
    get_values(network, property, &at, values, stride);
    clear_removed(network, kind, first, count, values, stride);
    return MSPRING_OK;
}

mspring_result mspring_network_get_at(const mspring_network *network, mspring_property property,
                                      const mspring_id *ids, uint32_t count, float *values, uint32_t stride) {
    mspringi_selection at;
    mspring_result result = check(network, property);
    if (result == MSPRING_OK)
        result = mspringi_look_up_list(network, mspringi_property_of(property)->kind, ids, count, values, values,
                                       stride, &at);
    if (result == MSPRING_OK)
        get_values(network, property, &at, values, stride);
    return result;
}

/// Snapshot of yield parameters and plastic strains.
#include <math.h>

#include "features/yield/plastic.h"
#include "store/properties.h"
#include "store/rest_lengths.h"
#include "store/sections.h"
#include "store/spring_limits.h"
#include "store/springs.h"

/* -------------------------------------------------------------------------------------------- yield parameters */

/// Largest rest length before any flow, m: a spring may shrink to a tenth of it.
#define LONGEST_NOMINAL 1e14f

typedef struct yielding {
    float yield_strain, hardening, plastic_limit, nominal;
} yielding;
enum { VALUES = 4 };

// Values in the slot of a removed spring depend on when it was removed.
static const yielding of_no_spring = {INFINITY, MSPRING_HARDENING_DEFAULT, MSPRING_PLASTIC_LIMIT_DEFAULT, 1.0f};

static size_t yielding_size(const mspring_network *network) {
    return network->tested.yields ? network->topology.reserve.spring_end * sizeof(yielding) : 0;
}

static void yielding_save(const mspring_network *network, mspringi_writer *to) {
    const mspringi_tested *p = &network->tested;
    for (mspring_id s = 0; s < network->topology.reserve.spring_end; ++s) {
        const mspringi_spring_slot spring_slot = network->topology.slot_of_spring[s];
        yielding values = of_no_spring;
        if (mspringi_spring_exists(network, s))
            values = (yielding){p->yield_strain[spring_slot], p->hardening[spring_slot],
                                p->plastic_limit[spring_slot], p->nominal[spring_slot]};
        mspringi_put(to, &values, VALUES, sizeof(float));
    }
}

static mspring_result yielding_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_yielding;
    const uint32_t springs = network->topology.reserve.spring_end;
    if (size == 0)
        return MSPRING_OK;
    mspring_result result = mspringi_section_check_size(network, section, size, springs * sizeof(yielding));
    for (mspring_id s = 0; result == MSPRING_OK && s < springs; ++s) {
        yielding v;
        from = mspringi_get(from, &v, VALUES, sizeof(float));
        if (!mspringi_are_allowed(MSPRING_YIELD_STRAIN, &v.yield_strain, 1, 1) ||
            !mspringi_are_allowed(MSPRING_HARDENING, &v.hardening, 1, 1) ||
            !mspringi_are_allowed(MSPRING_PLASTIC_LIMIT, &v.plastic_limit, 1, 1) ||
            !(v.nominal > 0.0f && v.nominal <= LONGEST_NOMINAL))
            result = mspringi_section_fail(
                network, section, "spring %u has yield strain %g, hardening %g, plastic limit %g, length %g m",
                (unsigned)s, (double)v.yield_strain, (double)v.hardening, (double)v.plastic_limit,
                (double)v.nominal);
    }
    return result == MSPRING_OK ? mspringi_plastic_reserve(network) : result;
}

static void yielding_load(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_tested *p = &network->tested;
    network->tested.yields = size > 0;
    for (mspring_id s = 0; p->nominal && s < network->topology.reserve.spring_end; ++s) {
        const mspringi_spring_slot spring_slot = network->topology.slot_of_spring[s];
        const bool exists = mspringi_spring_exists(network, s);
        yielding v = of_no_spring;
        if (exists)
            v.nominal = mspringi_spring_slot_own_length(network, spring_slot);
        if (size > 0)
            from = mspringi_get(from, &v, VALUES, sizeof(float));
        p->yield_strain[spring_slot] = mspringi_broken_value(v.yield_strain);
        p->hardening[spring_slot] = v.hardening;
        p->plastic_limit[spring_slot] = v.plastic_limit;
        p->nominal[spring_slot] = v.nominal;
        if (exists)
            mspringi_limits_renew(network, spring_slot);
    }
}

const mspringi_section mspringi_section_yielding = {"yiel",        "yield strains", true,          yielding_size,
                                                    yielding_save, yielding_check,  yielding_load, NULL};

/* -------------------------------------------------------------------------------------------- plastic strains */

// Counts, and rest lengths if a spring has flowed; frames have rest lengths for no other reason.
typedef struct counts {
    uint64_t count, is_bent;
    double dissipated;
} counts;

static void hand_counts(mspringi_io *io, counts *c) {
    MSPRINGI_HAND(io, c->count);
    MSPRINGI_HAND(io, c->is_bent);
    MSPRINGI_HAND(io, c->dissipated);
}

static void bent_save(const mspring_network *network, mspringi_writer *to) {
    const mspringi_tested *p = &network->tested;
    mspringi_io io = mspringi_io_to(to);
    if (!p->yields)
        return;
    hand_counts(&io, &(counts){network->plastic->count, p->is_bent, network->plastic->dissipated});
    for (mspring_id s = 0; p->is_bent && s < network->topology.reserve.spring_end; ++s) {
        const float length = mspringi_spring_exists(network, s)
                                 ? mspringi_spring_slot_own_length(network, network->topology.slot_of_spring[s])
                                 : 1.0f;
        mspringi_put(to, &length, 1, sizeof length);
    }
}

static mspring_result bent_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_bent;
    const uint32_t springs = network->topology.reserve.spring_end;
    mspringi_io io = mspringi_io_from(from, size);
    counts read;
    if (size == 0)
        return MSPRING_OK;
    hand_counts(&io, &read);
    if (read.is_bent > 1 || !(read.dissipated >= 0.0))
        return mspringi_section_fail(network, section, "%g J were dissipated", read.dissipated);
    for (mspring_id s = 0; read.is_bent && !io.is_short && s < springs; ++s) {
        float length;
        MSPRINGI_HAND(&io, length);
        if (!io.is_short && !mspringi_is_spring_value(MSPRINGI_REST_LENGTH, length))
            return mspringi_section_fail(network, section, "spring %u has rest length %g m", (unsigned)s,
                                         (double)length);
    }
    const mspring_result result = mspringi_section_end(network, section, &io);
    return result == MSPRING_OK ? mspringi_plastic_reserve(network) : result;
}

// Load before the ramps, which were cleared.
static void bent_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_tested *p = &network->tested;
    mspringi_io io = mspringi_io_from(from, size);
    counts read;
    if (!p->nominal)
        return;
    hand_counts(&io, &read);
    for (mspring_id s = 0; (p->is_bent || read.is_bent) && s < network->topology.spring_count; ++s) {
        const mspringi_spring_slot spring_slot = network->topology.slot_of_spring[s];
        const float length = read.is_bent ? mspringi_float_at(io.from, s) : p->nominal[spring_slot];
        if (!mspringi_spring_exists(network, s) ||
            mspringi_spring_slot_get(network, spring_slot).rest_length == length)
            continue;
        mspringi_spring_slot_set_rest_length(network, spring_slot, length);
        mspringi_limits_renew(network, spring_slot);
    }
    network->plastic->count = read.count;
    p->is_bent = read.is_bent;
    network->plastic->dissipated = read.dissipated;
    network->edits.flows++;
}

const mspringi_section mspringi_section_bent = {
    "bent", "springs that have yielded", false, NULL, bent_save, bent_check, bent_load, NULL};

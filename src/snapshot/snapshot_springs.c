/// Snapshot of the springs as edits and strain have changed them.
#include <math.h>
#include <string.h>

#include "features/breaking/breaking.h"
#include "features/ramps/ramps.h"
#include "store/changed.h"
#include "store/metres.h"
#include "store/properties.h"
#include "store/rest_lengths.h"
#include "store/sections.h"
#include "store/spring_limits.h"
#include "store/springs.h"

/* ------------------------------------------------------------------------------------------ bits by spring slot */

static size_t words_size(const mspring_network *network) {
    return mspringi_spring_slot_words(&network->topology) * sizeof(uint16_t);
}

static bool bit_at(const uint8_t *from, mspringi_spring_slot spring_slot) {
    uint16_t word;
    mspringi_get(from + spring_slot / MSPRINGI_WIDTH * sizeof word, &word, 1, sizeof word);
    return word >> spring_slot % MSPRINGI_WIDTH & 1;
}

/* ----------------------------------------------------------------------------------------------------- broken */

// True if a spring is broken, or was left out of a compact layout for that.
static bool is_any_broken(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    bool any = t->inactive_count > 0;
    for (mspring_id s = 0; network->edits.broke && !any && s < t->spring_count; ++s)
        any = mspringi_spring_exists(network, s) && !mspringi_spring_slot_is_live(network, t->slot_of_spring[s]);
    return any;
}

static size_t broken_size(const mspring_network *network) {
    return is_any_broken(network) ? words_size(network) : 0;
}

static void broken_save(const mspring_network *network, mspringi_writer *to) {
    mspringi_put(to, network->live, mspringi_spring_slot_words(&network->topology), sizeof *network->live);
}

// An inactive spring was broken when the network was compacted. Restoring it would invalidate the layout.
static mspring_result broken_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_broken;
    const mspringi_topology *t = &network->topology;
    if (size == 0 && t->inactive_count == 0)
        return MSPRING_OK;
    mspring_result result = mspringi_section_check_size(network, section, size, words_size(network));
    for (uint32_t i = 0; result == MSPRING_OK && i < t->inactive_count; ++i)
        if (bit_at(from, t->row_spring_slots + t->irregular_capacity + i))
            result = mspringi_section_fail(network, section, "a spring that the plan leaves out is whole");
    return result == MSPRING_OK ? mspringi_breaking_reserve(network) : result;
}

// True if the live bits are unchanged, the common case; comparing each spring would take half of loading a frame.
// False if springs may have been added or removed.
static bool are_as_in(const mspring_network *network, const uint8_t *from, size_t size) {
    const size_t words = size / sizeof(uint16_t);
    bool same = !network->growth.springs && (size > 0 || !network->edits.broke);
    for (size_t i = 0; same && i < words; ++i) {
        uint16_t word;
        mspringi_get(from + i * sizeof word, &word, 1, sizeof word);
        same = word == network->live[i];
    }
    return same;
}

static void broken_load(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_topology *t = &network->topology;
    if (are_as_in(network, from, size))
        return;
    for (mspring_id s = 0; s < t->spring_count; ++s) {
        const mspringi_spring_slot spring_slot = t->slot_of_spring[s];
        const bool live = mspringi_spring_exists(network, s) && (size == 0 || bit_at(from, spring_slot));
        if (live)
            (void)mspringi_spring_restore(network, s);
        else
            (void)mspringi_spring_break(network, s);
    }
    network->edits.broke = size > 0;
}

bool mspringi_saved_is_whole(const mspringi_saved *saved, mspring_id spring) {
    return mspringi_saved_has_spring(saved, spring) &&
           (!saved->live || bit_at(saved->live, mspringi_saved_place(saved, spring)));
}

// Refuse live springs that do not exist.
static mspring_result broken_check_against(mspring_network *network, const mspringi_saved *saved,
                                           const uint8_t *from, size_t size) {
    for (mspring_id s = 0; size > 0 && saved->growth && s < network->topology.reserve.spring_end; ++s)
        if (bit_at(from, mspringi_saved_place(saved, s)) && !mspringi_saved_has_spring(saved, s))
            return mspringi_section_fail(network, &mspringi_section_broken, "spring %u is whole, but not there",
                                         (unsigned)s);
    return MSPRING_OK;
}

const mspringi_section mspringi_section_broken = {"brok",      "broken springs", false,       broken_size,
                                                  broken_save, broken_check,     broken_load, broken_check_against};

static uint32_t bits_runs(const mspring_network *network, mspringi_io head, mspringi_run *runs) {
    (void)network;
    (void)head;
    runs[0] = (mspringi_run){MSPRINGI_BITS, 1};
    return 1;
}

const mspringi_by_id mspringi_by_id_broken = {&mspringi_section_broken, bits_runs, NULL, NULL};

/* ----------------------------------------------------------------------------------------------------- values */

// Values of a spring: nominal stiffness and damping, and rest length. That of a spring on a ramp is the present
// one; the ramp has its own.
enum { VALUES = 3 };

static size_t values_size(const mspring_network *network) {
    return (size_t)network->topology.reserve.spring_end * VALUES * sizeof(float);
}

typedef struct spring_values {
    float stiffness, damping, rest_length;
} spring_values;

static spring_values values_of(const mspring_network *network, mspring_id spring,
                               mspringi_spring_slot spring_slot) {
    if (!mspringi_spring_exists(network, spring))
        return (spring_values){0.0f, 0.0f, 1.0f};
    const mspringi_relative nominal = mspringi_spring_get_nominal(network, spring, spring_slot);
    return (spring_values){nominal.stiffness, nominal.damping,
                           mspringi_spring_slot_get(network, spring_slot).rest_length};
}

static void values_save(const mspring_network *network, mspringi_writer *to) {
    for (mspring_id s = 0; s < network->topology.reserve.spring_end; ++s) {
        const spring_values values = values_of(network, s, network->topology.slot_of_spring[s]);
        mspringi_put(to, &values, VALUES, sizeof(float));
    }
}

static mspring_result values_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_values;
    mspring_result result = mspringi_section_check_size(network, section, size, values_size(network));
    bool other_rest_lengths = false, other_fractions = false;
    for (mspring_id s = 0; result == MSPRING_OK && s < network->topology.reserve.spring_end; ++s) {
        spring_values values;
        from = mspringi_get(from, &values, VALUES, sizeof(float));
        if (!mspringi_is_spring_value(MSPRINGI_STIFFNESS, values.stiffness) ||
            !mspringi_is_spring_value(MSPRINGI_DAMPING, values.damping) ||
            !mspringi_is_spring_value(MSPRINGI_REST_LENGTH, values.rest_length) ||
            (values.damping > 0.0f && network->parts <= MSPRINGI_DAMPING))
            result = mspringi_section_fail(
                network, section, "spring %u has stiffness %g, damping %g, rest length %g m", (unsigned)s,
                (double)values.stiffness, (double)values.damping, (double)values.rest_length);
        const mspringi_spring_slot spring_slot = network->topology.slot_of_spring[s];
        other_rest_lengths = other_rest_lengths ||
                             (spring_slot < network->topology.lattice_spring_slots &&
                              values.rest_length != mspringi_spring_slot_get(network, spring_slot).rest_length);
        if (mspringi_spring_is_relative(network, s)) {
            const mspringi_relative had = mspringi_fractions_of(&network->fractions, s);
            other_fractions = other_fractions || values.stiffness != had.stiffness || values.damping != had.damping;
        }
    }
    if (result == MSPRING_OK && other_rest_lengths)
        result = mspringi_rest_lengths_unshare(network);
    return result == MSPRING_OK && other_fractions ? mspringi_fractions_separate(network) : result;
}

static void values_load(mspring_network *network, const uint8_t *from, size_t size) {
    if (size == 0)
        return;
    for (mspring_id s = 0; s < network->topology.reserve.spring_end; ++s) {
        spring_values values;
        const mspringi_spring_slot spring_slot = network->topology.slot_of_spring[s];
        const spring_values present = values_of(network, s, spring_slot);
        from = mspringi_get(from, &values, VALUES, sizeof(float));
        if (!mspringi_spring_exists(network, s))
            continue;
        if (values.rest_length != present.rest_length)
            mspringi_spring_slot_set_rest_length(network, spring_slot, values.rest_length);
        if (values.stiffness != present.stiffness || values.damping != present.damping)
            mspringi_spring_set_nominal(network, s, spring_slot,
                                        (mspringi_relative){values.stiffness, values.damping});
    }
    mspringi_notify_change(network, MSPRINGI_CHANGED_SPRING_VALUES, 0);
}

const mspringi_section mspringi_section_values = {
    "valu", "stiffness, damping and rest lengths", true, values_size, values_save, values_check, values_load, NULL};

/* ------------------------------------------------------------------------------------------------ strains */

static size_t thresholds_size(const mspring_network *network, bool has_any) {
    return has_any ? network->topology.reserve.spring_end * sizeof(float) : 0;
}

static void thresholds_save(const mspring_network *network, const float *thresholds, mspringi_writer *to) {
    for (mspring_id s = 0; s < network->topology.reserve.spring_end; ++s)
        mspringi_put(to, &thresholds[network->topology.slot_of_spring[s]], 1, sizeof *thresholds);
}

static mspring_result thresholds_check(mspring_network *network, const mspringi_section *section,
                                       mspring_property property, const uint8_t *from, size_t size) {
    const uint32_t springs = network->topology.reserve.spring_end;
    mspring_result result = mspringi_section_check_size(network, section, size, springs * sizeof(float));
    for (mspring_id s = 0; result == MSPRING_OK && s < springs; ++s) {
        const float value = mspringi_float_at(from, s);
        if (!mspringi_are_allowed(property, &value, 1, 1))
            result = mspringi_section_fail(network, section, "spring %u has %g", (unsigned)s, (double)value);
    }
    return result == MSPRING_OK ? mspringi_limit_reserve(network, property) : result;
}

static void thresholds_load(mspring_network *network, mspring_property property, const uint8_t *from, size_t size) {
    const float none = property == MSPRING_RELAX_STRAIN ? MSPRING_RELAX_STRAIN_DEFAULT : INFINITY;
    for (mspring_id s = 0; s < network->topology.reserve.spring_end; ++s)
        mspringi_limit_store(network, network->topology.slot_of_spring[s], property,
                             size > 0 ? mspringi_float_at(from, s) : none);
}

// A section of thresholds of one kind, absent if no spring ever had one.
#define THRESHOLDS(name, tag, words, property, array, has_any)                                                     \
    static size_t name##_size(const mspring_network *network) {                                                    \
        return thresholds_size(network, network->strain.has_any);                                                  \
    }                                                                                                              \
    static void name##_save(const mspring_network *network, mspringi_writer *to) {                                 \
        thresholds_save(network, network->strain.array, to);                                                       \
    }                                                                                                              \
    static mspring_result name##_check(mspring_network *network, const uint8_t *from, size_t size) {               \
        return size > 0 ? thresholds_check(network, &mspringi_section_##name, property, from, size) : MSPRING_OK;  \
    }                                                                                                              \
    static void name##_load(mspring_network *network, const uint8_t *from, size_t size) {                          \
        network->strain.has_any = size > 0;                                                                        \
        if (network->strain.array)                                                                                 \
            thresholds_load(network, property, from, size);                                                        \
    }                                                                                                              \
    const mspringi_section mspringi_section_##name = {tag,         words,        true,        name##_size,         \
                                                      name##_save, name##_check, name##_load, NULL}

THRESHOLDS(break_strains, "brks", "break strains", MSPRING_BREAK_STRAIN, break_strain, breaks);
THRESHOLDS(stress_strains, "strs", "stress strains", MSPRING_WARN_STRAIN, warn_strain, stresses);
THRESHOLDS(relax_strains, "rlxs", "relax strains", MSPRING_RELAX_STRAIN, relax_strain, relaxes);

/* ----------------------------------------------------------------------------------------------------- metres */

// Limits as they were given in metres, 0 for springs that have strains. The sections of strains have what follows
// from them, so that readers who do not know this section still have the limits.
static size_t metres_size(const mspring_network *network) {
    const uint32_t springs = network->topology.reserve.spring_end;
    mspring_id s = 0;
    while (network->metres && s < springs && !mspringi_metres_of(network, s)) // memory for it does not make one
        ++s;
    return network->metres && s < springs ? springs * MSPRINGI_METRES * sizeof(float) : 0;
}

static void metres_save(const mspring_network *network, mspringi_writer *to) {
    mspringi_put(to, network->metres, (size_t)network->topology.reserve.spring_end * MSPRINGI_METRES, sizeof(float));
}

static mspring_result metres_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_metres;
    const uint32_t springs = network->topology.reserve.spring_end;
    if (size == 0)
        return MSPRING_OK;
    mspring_result result =
        mspringi_section_check_size(network, section, size, (size_t)springs * MSPRINGI_METRES * sizeof(float));
    for (size_t i = 0; result == MSPRING_OK && i < (size_t)springs * MSPRINGI_METRES; ++i) {
        const mspring_property property = (mspring_property)(MSPRING_BREAK_STRAIN + (int)(i % MSPRINGI_METRES));
        const float value = mspringi_float_at(from, i), first = mspringi_float_at(from, i - i % MSPRINGI_METRES);
        if (first != 0.0f ? !mspringi_are_allowed(property, &value, 1, 1) : value != 0.0f)
            result = mspringi_section_fail(network, section, "spring %zu has a %s of %g m", i / MSPRINGI_METRES,
                                           mspringi_property_of(property)->name, (double)value);
    }
    return result == MSPRING_OK ? mspringi_metres_reserve(network, MSPRING_SPRING_METRES) : result;
}

static void metres_load(mspring_network *network, const uint8_t *from, size_t size) {
    const size_t count = (size_t)network->topology.reserve.spring_end * MSPRINGI_METRES;
    if (size > 0)
        mspringi_get(from, network->metres, count, sizeof(float));
    else if (network->metres)
        memset(network->metres, 0, count * sizeof(float));
}

const mspringi_section mspringi_section_metres = {"mtrs",      "limits in metres", true,        metres_size,
                                                  metres_save, metres_check,       metres_load, NULL};

/* --------------------------------------------------------------------------------------------------- stressed */

static size_t stressed_size(const mspring_network *network) {
    return network->strain.stresses ? words_size(network) : 0;
}

static void stressed_save(const mspring_network *network, mspringi_writer *to) {
    mspringi_put(to, network->strain.stressed, mspringi_spring_slot_words(&network->topology), sizeof(uint16_t));
}

static mspring_result stressed_check(mspring_network *network, const uint8_t *from, size_t size) {
    (void)from;
    if (size == 0)
        return MSPRING_OK;
    mspring_result result =
        mspringi_section_check_size(network, &mspringi_section_stressed, size, words_size(network));
    return result == MSPRING_OK ? mspringi_limit_reserve(network, MSPRING_BREAK_STRAIN) : result;
}

// Only live springs are stressed.
static void stressed_load(mspring_network *network, const uint8_t *from, size_t size) {
    const size_t words = mspringi_spring_slot_words(&network->topology);
    uint16_t *stressed = network->strain.stressed;
    if (!stressed)
        return;
    if (size == 0)
        memset(stressed, 0, words * sizeof *stressed);
    else
        mspringi_get(from, stressed, words, sizeof *stressed);
    for (size_t i = 0; i < words; ++i)
        stressed[i] &= network->live[i];
}

const mspringi_section mspringi_section_stressed = {"stsd",        "stressed springs", false,         stressed_size,
                                                    stressed_save, stressed_check,     stressed_load, NULL};

const mspringi_by_id mspringi_by_id_stressed = {&mspringi_section_stressed, bits_runs, NULL, NULL};

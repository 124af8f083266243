/// Edits of stiffness, damping, rest lengths, thresholds and yield parameters.
///
/// Most springs lie in lattices: their values are compared and set in place. An unchanged spring costs only that
/// comparison.
#include "store/springs.h"

#include "base/cpu.h"
#include "base/hash.h"
#include "edits/edit_values.h"
#include "features/ramps/ramps.h"
#include "store/changed.h"
#include "store/metres.h"
#include "store/record_sharing.h"
#include "store/rest_lengths.h"
#include "store/spring_limits.h"

/* --------------------------------------------------------------------------------------------------- comparing */

// Array of spring values by spring slot, for direct comparison.
typedef struct plane {
    float *values;            ///< value of spring slot p at p % WIDTH + p / WIDTH * WIDTH * planes
    uint32_t planes;          ///< 1 or 2
    mspringi_spring_slot end; ///< end of its spring slots; 0: none
} plane;

static inline float *in_plane(const plane *from, mspringi_spring_slot spring_slot) {
    return &from->values[spring_slot +
                         (size_t)(from->planes - 1) * (spring_slot & ~(mspringi_spring_slot)(MSPRINGI_WIDTH - 1))];
}

// Prefetch distance in springs: to the next blocks, since a step leaves none of them in the near caches.
#define AHEAD 256

/// Prefetch distance in a list, whose springs may lie anywhere.
#define AHEAD_IN_LIST 32

static inline void fetch(const plane *from, mspringi_spring_slot spring_slot) {
    if (spring_slot < from->end)
        MSPRINGI_PREFETCH(in_plane(from, spring_slot));
}

// Array of a property. All thresholds have one, unless springs have some in metres; so have the given rest lengths
// of yielding springs, rest lengths of lattices unless shared, and stiffness and damping of lattices.
static plane plane_of(const mspring_network *network, mspring_property property) {
    const mspringi_topology *t = &network->topology;
    const uint32_t planes = network->parts - 1;
    if (network->metres && property >= MSPRING_REST_LENGTH && property <= MSPRING_YIELD_STRAIN)
        return (plane){NULL, 1, 0};
    float *thresholds = mspringi_limits_of(network, property);
    if (property == MSPRING_REST_LENGTH && mspringi_ramp_count(network) == 0 && network->tested.nominal)
        thresholds = network->tested.nominal;
    if (thresholds)
        return (plane){thresholds, 1, (mspringi_spring_slot)(mspringi_spring_slot_words(t) * MSPRINGI_WIDTH)};
    if (property == MSPRING_STIFFNESS)
        return (plane){network->lattice_springs, planes, t->lattice_spring_slots};
    if (property == MSPRING_DAMPING && planes > 1)
        return (plane){network->lattice_springs + MSPRINGI_WIDTH, planes, t->lattice_spring_slots};
    if (property == MSPRING_REST_LENGTH && network->rest_lengths.shared_count == 0 &&
        mspringi_ramp_count(network) == 0)
        return (plane){network->rest_lengths.lengths, 1, t->lattice_spring_slots};
    return (plane){NULL, 1, 0};
}

// True if the value changes the spring, or must end its ramp.
static bool is_changed(const mspring_network *network, mspring_property property, mspring_id spring, float value) {
    return mspringi_spring_exists(network, spring) &&
           (mspringi_spring_property(network, property, spring) != value ||
            (property == MSPRING_REST_LENGTH && mspringi_has_ramp(network, spring)));
}

// Index of the first spring from i on that may change. A broken spring has 0 in its record, so that value proves
// nothing.
static inline uint32_t skip_equal(const mspringi_spring_slot *spring_slots, plane known, const float *values,
                                  size_t stride, uint32_t i, uint32_t count) {
    while (i < count && spring_slots[i] < known.end) {
        const float value = mspringi_broken_value(values[i * stride]);
        if (count - i > AHEAD)
            fetch(&known, spring_slots[i + AHEAD]);
        if (*in_plane(&known, spring_slots[i]) != value || value == 0.0f)
            break;
        ++i;
    }
    return i;
}

// skip_equal() for a list.
static uint32_t skip_equal_listed(const mspring_network *network, const mspring_id *list, plane known,
                                  const float *values, size_t stride, uint32_t i, uint32_t count) {
    const mspringi_spring_slot *spring_slots = network->topology.slot_of_spring;
    for (; i < count && spring_slots[list[i]] < known.end; ++i) {
        const float value = values[i * stride];
        if (*in_plane(&known, spring_slots[list[i]]) != value || value == 0.0f)
            break;
    }
    return i;
}

// skip_equal() for shared rest lengths.
static inline uint32_t skip_equal_rests(const mspring_network *network, const mspringi_spring_slot *spring_slots,
                                        const float *values, size_t stride, uint32_t i, uint32_t count) {
    const mspringi_rest_lengths rests = network->rest_lengths;
    const mspringi_spring_slot end = network->topology.lattice_spring_slots;
    while (i < count && spring_slots[i] < end &&
           *mspringi_rest_lengths_at(&rests, spring_slots[i]) == values[i * stride])
        ++i;
    return i;
}

// skip_equal() for fractions of relative springs.
static inline uint32_t skip_equal_fractions(const mspringi_fractions *fractions, mspring_id first, bool is_damping,
                                            const float *values, size_t stride, uint32_t i, uint32_t count) {
    for (; i < count; ++i) {
        const mspringi_relative had = mspringi_fractions_of(fractions, first + i);
        if (!(had.stiffness >= 0.0f) || (is_damping ? had.damping : had.stiffness) != values[i * stride])
            break;
    }
    return i;
}

// skip_equal_fractions() for a list.
static uint32_t skip_equal_listed_fractions(const mspringi_fractions *fractions, const mspring_id *list,
                                            bool is_damping, const float *values, size_t stride, uint32_t i,
                                            uint32_t count) {
    for (; i < count; ++i) {
        if (count - i > AHEAD_IN_LIST && !fractions->of_spring)
            MSPRINGI_PREFETCH(&fractions->values[list[i + AHEAD_IN_LIST]]);
        if (skip_equal_fractions(fractions, list[i], is_damping, values + i * stride, stride, 0, 1) == 0)
            break;
    }
    return i;
}

// Index of the first spring from i on that changes.
static uint32_t next_changed(const mspring_network *network, const mspringi_selection *at,
                             const mspringi_values *values, uint32_t i) {
    const mspringi_spring_slot *spring_slots = network->topology.slot_of_spring + at->first;
    const plane known = plane_of(network, values->property);
    const bool is_damping = values->property == MSPRING_DAMPING;
    const bool has_fractions = network->fractions.values && (is_damping || values->property == MSPRING_STIFFNESS);
    const bool has_shared_rests = values->property == MSPRING_REST_LENGTH &&
                                  network->rest_lengths.shared_count > 0 && mspringi_ramp_count(network) == 0;
    for (; i < at->count; ++i) {
        if (!at->list && has_shared_rests)
            i = skip_equal_rests(network, spring_slots, values->first, values->stride, i, at->count);
        else if (!at->list && has_fractions)
            i = skip_equal_fractions(&network->fractions, at->first, is_damping, values->first, values->stride, i,
                                     at->count);
        else if (!at->list && known.planes == 1)
            i = skip_equal(spring_slots, (plane){known.values, 1, known.end}, values->first, values->stride, i,
                           at->count);
        else if (!at->list)
            i = skip_equal(spring_slots, known, values->first, values->stride, i, at->count);
        else if (has_fractions)
            i = skip_equal_listed_fractions(&network->fractions, at->list, is_damping, values->first,
                                            values->stride, i, at->count);
        else
            i = skip_equal_listed(network, at->list, known, values->first, values->stride, i, at->count);
        if (i == at->count ||
            is_changed(network, values->property, mspringi_selected(at, i), mspringi_value_of(values, i)))
            break;
    }
    return i;
}

/* ----------------------------------------------------------------------------------------------------- setting */

static uint32_t edit_of(mspring_property property) {
    switch (property) {
    case MSPRING_STIFFNESS:
        return MSPRINGI_EDIT_PARTS + MSPRINGI_STIFFNESS;
    case MSPRING_DAMPING:
        return MSPRINGI_EDIT_PARTS + MSPRINGI_DAMPING;
    case MSPRING_REST_LENGTH:
        return MSPRINGI_EDIT_PARTS + MSPRINGI_REST_LENGTH;
    case MSPRING_BREAK_STRAIN:
        return MSPRINGI_EDIT_BREAK_STRAIN;
    case MSPRING_WARN_STRAIN:
        return MSPRINGI_EDIT_STRESS_STRAIN;
    case MSPRING_YIELD_STRAIN:
        return MSPRINGI_EDIT_YIELD_STRAIN;
    case MSPRING_HARDENING:
        return MSPRINGI_EDIT_HARDENING;
    case MSPRING_PLASTIC_LIMIT:
        return MSPRINGI_EDIT_PLASTIC_LIMIT;
    default:
        return MSPRINGI_EDIT_RELAX_STRAIN;
    }
}

static mspring_result check_room_for_damping(mspring_network *network, const mspringi_selection *at,
                                             const mspringi_values *values) {
    for (uint32_t i = 0; network->parts <= MSPRINGI_DAMPING && i < at->count; ++i)
        if (mspringi_value_of(values, i) > 0.0f && mspringi_spring_exists(network, mspringi_selected(at, i)))
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                 "spring %u: damping is %g, but the network was created without room for any "
                                 "(MSPRING_NETWORK_RESERVE_DAMPING)",
                                 (unsigned)mspringi_selected(at, i), (double)mspringi_value_of(values, i));
    return MSPRING_OK;
}

// True if the edit of this spring ends sharing of rest lengths or fractions.
static bool ends_sharing(const mspring_network *network, mspring_property property, mspring_id spring) {
    const mspringi_topology *t = &network->topology;
    if (property == MSPRING_REST_LENGTH)
        return mspringi_slot_of_spring(t, spring) < t->lattice_spring_slots;
    return mspringi_spring_is_relative(network, spring);
}

// Allocate memory for an edit. i: index of the first changed value.
static mspring_result reserve(mspring_network *network, const mspringi_selection *at, const mspringi_values *values,
                              uint32_t i) {
    const mspring_property property = values->property;
    const bool is_rest_length = property == MSPRING_REST_LENGTH;
    if (!is_rest_length && property != MSPRING_STIFFNESS && property != MSPRING_DAMPING)
        return mspringi_limit_reserve(network, property);
    if (is_rest_length ? network->rest_lengths.shared_count == 0 : !network->fractions.of_spring)
        return MSPRING_OK;
    while (i < at->count && !ends_sharing(network, property, mspringi_selected(at, i)))
        i = next_changed(network, at, values, i + 1);
    if (i >= at->count)
        return MSPRING_OK;
    return is_rest_length ? mspringi_rest_lengths_unshare(network) : mspringi_fractions_separate(network);
}

static MSPRINGI_NOINLINE void set_one(mspring_network *network, mspring_property property, mspring_id spring,
                                      mspringi_spring_slot spring_slot, float value) {
    mspringi_relative nominal;
    switch (property) {
    case MSPRING_STIFFNESS:
    case MSPRING_DAMPING:
        nominal = mspringi_spring_get_nominal(network, spring, spring_slot);
        *(property == MSPRING_STIFFNESS ? &nominal.stiffness : &nominal.damping) = value;
        mspringi_spring_set_nominal(network, spring, spring_slot, nominal);
        break;
    case MSPRING_REST_LENGTH:
        mspringi_ramp_drop(network, spring);
        mspringi_spring_slot_give_length(network, spring_slot, value);
        mspringi_metres_renew(network, spring);
        break;
    default:
        if (property == MSPRING_PLASTIC_STRAIN)
            mspringi_ramp_drop(network, spring);
        mspringi_limit_store(network, spring_slot, property, mspringi_metres_set(network, property, spring, value));
    }
}

// Contribution of a value to the hash of a call. Independent of the others: a chain would take as long as the rest.
static inline uint64_t trace(uint32_t i, mspring_id spring, float value) {
    return mspringi_hash_floats(mspringi_hash(MSPRINGI_HASH_START, (uint64_t)i << 32 | spring), value, 0.0f);
}

// Arguments for setting springs of a lattice in place.
typedef struct lattice_setter {
    plane records;
    const float *mass; ///< masses for relative springs
    double rate;
    bool is_damping, has_relative;
    float mass_a, mass_b; ///< masses of the relative spring set before
    uint32_t changed;     ///< springs of which set_run() changed the value
    double reduced_mass;
} lattice_setter;

// Most springs have the masses of the one before.
static inline double reduced_mass_of(lattice_setter *with, float a, float b) {
    if (a != with->mass_a || b != with->mass_b) {
        with->reduced_mass = mspringi_reduced_mass((double)a, (double)b);
        with->mass_a = a;
        with->mass_b = b;
    }
    return with->reduced_mass;
}

static lattice_setter lattice_setter_of(const mspring_network *network, mspring_property property) {
    return (lattice_setter){.records = plane_of(network, property),
                            .mass = network->mass,
                            .rate = mspringi_relative_rate(network),
                            .is_damping = property == MSPRING_DAMPING,
                            .has_relative = network->fractions.values != NULL};
}

// Active stiffness or damping of a relative spring in a lattice, from its new value.
static inline float in_force(const mspring_network *network, lattice_setter *with, mspringi_spring_slot spring_slot,
                             float value) {
    const mspringi_topology *t = &network->topology;
    uint32_t base, tip;
    mspringi_lattice_ends(t, spring_slot, &base, &tip);
    const double reduced_mass =
        reduced_mass_of(with, with->mass[t->particle_of_slot[base]], with->mass[t->particle_of_slot[tip]]);
    return with->is_damping ? mspringi_derived_damping(value, reduced_mass, with->rate)
                            : mspringi_derived_stiffness(value, reduced_mass, with->rate);
}

// Set stiffness or damping of a live spring in a lattice. False if it is unchanged.
static inline bool set_in_lattice(mspring_network *network, lattice_setter *with, mspring_id spring,
                                  mspringi_spring_slot spring_slot, float value) {
    float *record = in_plane(&with->records, spring_slot), force = value;
    if (with->has_relative && mspringi_spring_is_relative(network, spring)) {
        mspringi_relative *fractions = mspringi_fractions_at(&network->fractions, spring);
        float *had = with->is_damping ? &fractions->damping : &fractions->stiffness;
        if (*had == value)
            return false;
        MSPRINGI_ASSERT(!network->fractions.of_spring);
        *had = value;
        force = in_force(network, with, spring_slot, value);
    } else if (*record == value) {
        return false;
    }
    mspringi_shared_records_unshare(network, spring_slot);
    *record = force;
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACE, spring_slot);
    return true;
}

// Set a rest length or threshold in its array. False if it is unchanged.
static inline bool set_in_plane(mspring_network *network, const plane *known, mspring_property property,
                                mspringi_spring_slot spring_slot, float value) {
    float *at = in_plane(known, spring_slot);
    if (*at == value)
        return false;
    if (property != MSPRING_REST_LENGTH) {
        mspringi_limit_store(network, spring_slot, property, value);
        return true;
    }
    if (network->tested.nominal) {
        mspringi_spring_slot_give_length(network, spring_slot, value);
        return true;
    }
    *at = value;
    mspringi_note_rest_length(network, value);
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACE, spring_slot);
    return true;
}

// Set stiffness or damping of springs from index i to end, while they are live and in a lattice. Notifies only the
// fingerprint of each. Returns the index of the first spring left.
MSPRINGI_ALWAYS_INLINE uint32_t set_run(mspring_network *network, const mspringi_selection *at,
                                        const mspringi_values *values, lattice_setter *with, uint32_t i,
                                        uint32_t end, bool has_relative, uint64_t *traces) {
    const mspringi_spring_slot *spring_slots = network->topology.slot_of_spring;
    const mspringi_shared_records shared = network->shared_records;
    const plane records = with->records;
    const uint32_t count = at->count;
    uint64_t sum = 0, changes = 0;
    for (; i < end; ++i) {
        const mspring_id spring = mspringi_selected(at, i);
        const mspringi_spring_slot spring_slot = spring_slots[spring];
        const uint32_t block = spring_slot / (MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH);
        float force = mspringi_broken_value(values->first[i * values->stride]);
        const float value = force;
        if (count - i > AHEAD)
            fetch(&records, spring_slots[mspringi_selected(at, i + AHEAD)]);
        if (spring_slot >= records.end || !mspringi_spring_slot_is_live(network, spring_slot))
            break;
        float *record = in_plane(&records, spring_slot);
        if (has_relative && mspringi_spring_is_relative(network, spring)) {
            mspringi_relative *fractions = mspringi_fractions_at(&network->fractions, spring);
            float *had = with->is_damping ? &fractions->damping : &fractions->stiffness;
            if (*had == value)
                continue;
            MSPRINGI_ASSERT(!network->fractions.of_spring);
            *had = value;
            force = in_force(network, with, spring_slot, value);
        } else if (*record == value) {
            continue;
        }
        if (shared.of_block[block] != block || shared.readers[block] > 0)
            mspringi_shared_records_unshare_block(&network->shared_records, block,
                                                  network->topology.lattice_blocks);
        shared.is_set[block] = 1;
        *record = force;
        ++changes;
        sum += trace(i, spring, value);
    }
    network->shared_records.changes += changes;
    with->changed += (uint32_t)changes;
    *traces += sum;
    return i;
}

/// Springs after a changed one that are set without another look at what was sent.
#define RUN_AFTER_CHANGE 64u

// Set changed springs from index `next` on. sent: values of all that were sent before, or NULL. Returns how many
// changed.
static MSPRINGI_NOINLINE uint32_t set_changed(mspring_network *network, const mspringi_selection *at,
                                              const mspringi_values *values, const float *sent, uint32_t next) {
    const mspringi_spring_slot *spring_slots = network->topology.slot_of_spring;
    const mspring_property property = values->property;
    const bool may_sleep = network->sleep.count > 0;
    const bool is_part = property == MSPRING_STIFFNESS || property == MSPRING_DAMPING;
    lattice_setter lattice = lattice_setter_of(network, property);
    const bool runs = is_part && !at->list && !may_sleep && !network->job;
    uint32_t changed = 0, end = sent ? next : at->count;
    uint64_t traces = 0;
    while (next < at->count) {
        if (next == end) {
            next = mspringi_sent_skip(sent, values, next, at->count);
            end = at->count - next > RUN_AFTER_CHANGE ? next + RUN_AFTER_CHANGE : at->count;
        }
        if (runs)
            next = lattice.has_relative ? set_run(network, at, values, &lattice, next, end, true, &traces)
                                        : set_run(network, at, values, &lattice, next, end, false, &traces);
        else if (at->list)
            next = next_changed(network, at, values, next);
        if (next == end)
            continue;
        const uint32_t i = next++;
        const mspring_id spring = mspringi_selected(at, i);
        const mspringi_spring_slot spring_slot = spring_slots[spring];
        const float value = mspringi_value_of(values, i);
        bool is_new;
        if (at->count - i > AHEAD)
            fetch(&lattice.records, spring_slots[mspringi_selected(at, i + AHEAD)]);
        if (spring_slot < lattice.records.end && is_part && mspringi_spring_slot_is_live(network, spring_slot)) {
            is_new = set_in_lattice(network, &lattice, spring, spring_slot, value);
        } else if (spring_slot < lattice.records.end && !is_part && mspringi_spring_exists(network, spring)) {
            is_new = set_in_plane(network, &lattice.records, property, spring_slot, value);
        } else {
            is_new = is_changed(network, property, spring, value);
            if (is_new)
                set_one(network, property, spring, spring_slot, value);
        }
        if (!is_new)
            continue;
        ++changed;
        traces += trace(i, spring, value);
        if (may_sleep)
            mspringi_notify_change(network, MSPRINGI_CHANGED_SPRING, spring);
    }
    if (property != MSPRING_PLASTIC_STRAIN) { // plastic strain is state, no parameter
        mspringi_fingerprint(network, edit_of(property), at->count);
        network->parameter_fingerprint = mspringi_hash(network->parameter_fingerprint, traces);
    }
    if (is_part || property == MSPRING_REST_LENGTH || property == MSPRING_PLASTIC_STRAIN)
        mspringi_notify_change(network, MSPRINGI_CHANGED_SPRING_VALUES, 0);
    return changed + lattice.changed;
}

mspring_result mspringi_set_spring_values(mspring_network *network, const mspringi_selection *at,
                                          const mspringi_values *values) {
    mspring_result result =
        values->property == MSPRING_DAMPING ? check_room_for_damping(network, at, values) : MSPRING_OK;
    if (result != MSPRING_OK)
        return result;
    mspringi_sent_edit edit = mspringi_sent_begin(network, values->property);
    const float *sent = mspringi_sent_range(network, at, values->property);
    const uint32_t from = sent ? mspringi_sent_skip(sent, values, 0, at->count) : 0;
    const uint32_t first = next_changed(network, at, values, from);
    edit.equal = from;
    if (first < at->count) {
        result = reserve(network, at, values, first);
        if (result != MSPRING_OK)
            return result;
        edit.changed = set_changed(network, at, values, sent, first);
    }
    mspringi_sent_end(network, at, values, edit);
    return MSPRING_OK;
}

bool mspringi_springs_have_values(mspring_network *network, const mspringi_selection *at,
                                  const mspringi_values *values) {
    const bool again = mspringi_sent_again(network, at, values);
    MSPRINGI_ASSERT(!again || next_changed(network, at, values, 0) == at->count);
    return again;
}

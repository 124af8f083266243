/// Declaration of actuators, and their signals.
#include "features/actuators/actuators.h"

#include "base/cpu.h"
#include "builder/builder.h"
#include "store/archive.h"
#include "store/changed.h"
#include "store/feature.h"
#include "store/id_pool.h"
#include "store/properties.h"
#include "store/rest_lengths.h"
#include "store/springs.h"

#define MAX_SIGNAL 100.0f
#define MAX_CHANGES 256u

/// Shortest and longest rest length of an actuator, m: no signal makes it a weld, or longer than springs may be.
#define SHORTEST 1e-12f
#define LONGEST (MSPRINGI_MAX_LENGTH / MAX_SIGNAL)

static mspring_result check(mspring_network *network, const mspring_id *springs, uint32_t count, uint32_t changes) {
    const uint32_t all = network->topology.spring_count;
    if (!springs && count > 0)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "the list of springs is NULL");
    if (changes < 1 || changes > MAX_CHANGES)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "changes is %u, it must be 1 to %u",
                             (unsigned)changes, (unsigned)MAX_CHANGES);
    if (count > all)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "%u actuators are more than %u springs",
                             (unsigned)count, (unsigned)all);
    for (uint32_t i = 0; i < count; ++i) {
        if (springs[i] >= all || !mspringi_spring_exists(network, springs[i]))
            return mspringi_fail(&network->message, MSPRING_ERROR_ID, "actuator %u: there is no spring %s",
                                 (unsigned)i, MSPRINGI_ID(springs[i]));
        const float length = mspringi_spring_property(network, MSPRING_REST_LENGTH, springs[i]);
        if (!(length >= SHORTEST && length <= LONGEST))
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                 "actuator %u: spring %u has rest length %g m, it must be 1e-12 to 4e10",
                                 (unsigned)i, (unsigned)springs[i], (double)mspringi_read_length(length));
    }
    return MSPRING_OK;
}

static void free_all(mspring_network *network, mspringi_actuators *a) {
    if (a)
        mspringi_array_table_free(mspringi_state_of_actuators.arrays, a, &network->memory);
    mspringi_free(&network->memory, a);
}

static mspring_result no_memory(mspring_network *network, uint32_t count) {
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for %u actuators", (unsigned)count);
}

static mspring_result allocate(mspring_network *network, mspringi_actuators *a) {
    mspringi_memory *memory = &network->memory;
    const uint32_t springs = network->topology.reserve.spring_end;
    mspring_result result = mspringi_rest_lengths_unshare(network);
    if (result != MSPRING_OK)
        return result;
    a->spring = mspringi_alloc(memory, a->count, sizeof *a->spring);
    a->of_spring = mspringi_alloc(memory, springs, sizeof *a->of_spring);
    a->nominal = mspringi_alloc(memory, a->count, sizeof *a->nominal);
    a->to = mspringi_alloc(memory, a->count, sizeof *a->to);
    a->from = mspringi_alloc(memory, a->count, sizeof *a->from);
    a->bent_from = mspringi_alloc(memory, a->count, sizeof *a->bent_from);
    if (a->spring && a->of_spring && a->nominal && a->to && a->from && a->bent_from)
        return MSPRING_OK;
    return no_memory(network, a->count);
}

static mspring_result fill(mspring_network *network, mspringi_actuators *a, const mspring_id *springs) {
    for (mspring_id s = 0; s < network->topology.reserve.spring_end; ++s)
        a->of_spring[s] = MSPRING_NONE;
    for (uint32_t i = 0; i < a->count; ++i) {
        if (a->of_spring[springs[i]] != MSPRING_NONE)
            return mspringi_fail(&network->message, MSPRING_ERROR_DUPLICATE,
                                 "actuators %u and %u are the same spring, %u", (unsigned)a->of_spring[springs[i]],
                                 (unsigned)i, (unsigned)springs[i]);
        a->of_spring[springs[i]] = i;
        a->spring[i] = springs[i];
        a->nominal[i] = a->to[i] = mspringi_spring_property(network, MSPRING_REST_LENGTH, springs[i]);
    }
    return MSPRING_OK;
}

// Told by the state, not by what happened: a network that loaded it must go on as the one that was saved.
static bool have_moved(const mspring_network *network) {
    const mspringi_actuators *a = network->actuators;
    bool moved = false;
    for (uint32_t i = 0; a && !moved && i < a->count; ++i)
        moved = mspringi_spring_exists(network, a->spring[i]) &&
                (a->to[i] != a->nominal[i] || mspringi_actuator_length(network, i) != a->nominal[i]);
    return moved;
}

// The rest lengths of former actuators become parameters: no earlier frame fits any more.
static void leave_lengths(mspring_network *network) {
    const mspringi_actuators *a = network->actuators;
    if (!have_moved(network))
        return;
    mspringi_fingerprint(network, MSPRINGI_EDIT_PARTS + MSPRINGI_REST_LENGTH, a->count);
    for (uint32_t i = 0; i < a->count; ++i)
        if (mspringi_spring_exists(network, a->spring[i]))
            mspringi_fingerprint_floats(network, mspringi_actuator_length(network, i), 0.0f);
}

// Make them; on error there is a message, and nothing of them.
static mspring_result make(mspring_network *network, const mspring_id *springs, uint32_t count, uint32_t changes,
                           mspringi_actuators **made) {
    *made = mspringi_alloc(&network->memory, 1, sizeof **made);
    if (!*made)
        return no_memory(network, count);
    (*made)->count = count;
    (*made)->changes = changes;
    mspring_result result = allocate(network, *made);
    if (result == MSPRING_OK)
        result = fill(network, *made, springs);
    if (result != MSPRING_OK) {
        free_all(network, *made);
        *made = NULL;
    }
    return result;
}

mspring_result mspring_network_set_actuators(mspring_network *network, const mspring_id *springs, uint32_t count,
                                             uint32_t changes) {
    mspring_result result = mspringi_check_call(network);
    mspringi_actuators *made = NULL;
    if (result == MSPRING_OK)
        result = check(network, springs, count, changes);
    if (result == MSPRING_OK && count > 0)
        result = make(network, springs, count, changes, &made);
    if (result != MSPRING_OK)
        return result;
    leave_lengths(network);
    free_all(network, network->actuators);
    network->actuators = made;
    return MSPRING_OK;
}

/* ----------------------------------------------------------------------------------------------------- archives */

static void actuators_save(const mspring_network *network, mspringi_io *io) {
    const mspringi_actuators *a = network->actuators;
    if (!a)
        return;
    const uint32_t head[] = {a->count, a->changes};
    mspringi_put(io->to, head, 2, sizeof head[0]);
    mspringi_put(io->to, a->spring, a->count, sizeof *a->spring);
    mspringi_put(io->to, a->nominal, a->count, sizeof *a->nominal);
}

// The rest length of an actuator may have become one that no actuator begins with, and its spring may be gone.
static mspring_result check_archived(mspring_network *network, const mspring_id *springs, uint32_t count,
                                     uint32_t changes, const float *nominal) {
    bool good = count > 0 && changes >= 1 && changes <= MAX_CHANGES;
    for (uint32_t i = 0; good && i < count; ++i)
        good = springs[i] < network->topology.spring_count && nominal[i] >= SHORTEST && nominal[i] <= LONGEST;
    return good ? MSPRING_OK
                : mspringi_fail(&network->message, MSPRING_ERROR_SNAPSHOT,
                                "%u actuators of %u changes, or one of them, cannot be", (unsigned)count,
                                (unsigned)changes);
}

static mspring_result actuators_load(mspring_network *network, mspringi_io *io) {
    uint32_t head[2];
    mspring_result result = MSPRING_OK;
    mspringi_hand(io, head, 2, sizeof head[0]);
    mspring_id *springs = mspringi_chunk_array(network, io, head[0], sizeof *springs, &result);
    float *nominal = mspringi_chunk_array(network, io, head[0], sizeof *nominal, &result);
    if (result == MSPRING_OK)
        result = check_archived(network, springs, head[0], head[1], nominal);
    if (result == MSPRING_OK)
        result = make(network, springs, head[0], head[1], &network->actuators);
    for (uint32_t i = 0; result == MSPRING_OK && i < head[0]; ++i)
        network->actuators->nominal[i] = nominal[i];
    mspringi_free(&network->memory, nominal);
    mspringi_free(&network->memory, springs);
    return result;
}

const mspringi_chunk mspringi_chunk_actuators = {"acts", "signals of actuators", actuators_save, actuators_load,
                                                 &mspringi_section_actuators};

/* -------------------------------------------------------------------------------------------------- properties */

static uint32_t total(const mspring_network *network) {
    return mspringi_actuator_count(network);
}

static bool exists(const mspring_network *network, mspring_id id) {
    return id < mspringi_actuator_count(network);
}

static double get(const mspring_network *network, mspring_property property, mspring_id id) {
    (void)property; // MSPRING_SIGNAL
    return (double)network->actuators->to[id] / (double)network->actuators->nominal[id];
}

static uint32_t get_integer(const mspring_network *network, mspring_property property, mspring_id id) {
    (void)property; // MSPRING_ACTUATOR_SPRING
    return network->actuators->spring[id];
}

static mspring_result set_signals(mspring_network *network, const mspringi_selection *at,
                                  const mspringi_values *values) {
    mspringi_actuators *a = network->actuators;
    bool any = false;
    for (uint32_t i = 0; i < at->count; ++i) {
        const uint32_t actuator = mspringi_selected(at, i);
        const float to = a->nominal[actuator] * values->first[i * values->stride];
        any = any || a->to[actuator] != to || mspringi_actuator_length(network, actuator) != to;
        a->to[actuator] = to;
        mspringi_note_rest_length(network, to);
    }
    if (!any)
        return MSPRING_OK;
    a->are_pending = true;
    if (network->sleep.sleeping > 0)
        mspringi_notify_change(network, MSPRINGI_CHANGED_SIGNALS, 0);
    return MSPRING_OK;
}

const mspringi_thing_ops mspringi_things_actuators = {.kind = MSPRING_ACTUATORS,
                                                      .name = "actuator",
                                                      .total = total,
                                                      .exists = exists,
                                                      .get = get,
                                                      .get_integer = get_integer,
                                                      .set = set_signals};

/// The queue of events: a ring that the host sizes.
#include "store/events.h"

#include "base/assert.h"
#include "store/archive.h"
#include "store/feature.h"

void mspringi_events_push(mspring_network *network, mspring_event event) {
    mspringi_events *events = network->events;
    if (!events)
        return;
    if (events->count == events->capacity) {
        events->lost++;
        return;
    }
    const uint32_t until_end = events->capacity - events->first;
    events->ring[events->count < until_end ? events->first + events->count : events->count - until_end] = event;
    events->count++;
    MSPRINGI_ASSERT(events->count <= events->capacity && events->first < events->capacity);
}

void mspringi_events_clear(mspring_network *network) {
    if (network->events)
        network->events->count = 0;
}

static void destroy(mspringi_events *events, mspringi_memory *memory) {
    if (events)
        mspringi_free(memory, events->ring);
    mspringi_free(memory, events);
}

// NULL: no memory.
static mspringi_events *make(mspringi_memory *memory, uint32_t capacity) {
    mspringi_events *made = mspringi_alloc(memory, 1, sizeof *made);
    if (!made)
        return NULL;
    made->capacity = capacity;
    made->ring = mspringi_alloc(memory, capacity, sizeof *made->ring);
    if (made->ring)
        return made;
    destroy(made, memory);
    return NULL;
}

static const mspringi_array_entry arrays[] = {MSPRINGI_ARRAY_ENTRY(mspringi_events, ring, MSPRINGI_ARRAY)};
const mspringi_feature_state mspringi_state_of_events = {MSPRINGI_ARRAY_TABLE(arrays), NULL};

mspring_result mspring_network_reserve_events(mspring_network *network, uint32_t capacity) {
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    if (capacity > MSPRING_MAX_SPRINGS)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "room for %u events is asked for, %u is the most", (unsigned)capacity,
                             (unsigned)MSPRING_MAX_SPRINGS);
    mspringi_events *made = capacity > 0 ? make(&network->memory, capacity) : NULL;
    if (capacity > 0 && !made)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for %u events",
                             (unsigned)capacity);
    destroy(network->events, &network->memory);
    network->events = made;
    return MSPRING_OK;
}

mspring_result mspring_network_read_events(mspring_network *network, mspring_event *events, uint32_t capacity,
                                           uint32_t *count, uint64_t *lost) {
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    if (!count || (capacity > 0 && !events))
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "the place for events, or their count, is NULL");
    mspringi_events none = {.ring = NULL}, *queue = network->events ? network->events : &none;
    const uint32_t read = capacity < queue->count ? capacity : queue->count;
    for (uint32_t i = 0; i < read; ++i) {
        events[i] = queue->ring[queue->first];
        queue->first = queue->first + 1 < queue->capacity ? queue->first + 1 : 0;
    }
    queue->count -= read;
    *count = read;
    if (lost)
        *lost = queue->lost;
    return MSPRING_OK;
}

/* ----------------------------------------------------------------------------------------------------- archives */

// Events that wait are in no archive: only the room for them.
static void events_save(const mspring_network *network, mspringi_io *io) {
    if (network->events)
        MSPRINGI_HAND(io, network->events->capacity);
}

static mspring_result events_load(mspring_network *network, mspringi_io *io) {
    uint32_t capacity = 0;
    MSPRINGI_HAND(io, capacity);
    return mspring_network_reserve_events(network, mspringi_chunk_room(network, capacity));
}

const mspringi_chunk mspringi_chunk_events = {"evnt", "room for events", events_save, events_load, NULL};

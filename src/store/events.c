/// The queue of events: a ring that the host sizes.
#include "store/events.h"

void mspringi_events_push(mspring_network *network, mspring_event event) {
    mspringi_events *events = &network->events;
    if (events->capacity == 0)
        return;
    if (events->count == events->capacity) {
        events->lost++;
        return;
    }
    const uint32_t until_end = events->capacity - events->first;
    events->ring[events->count < until_end ? events->first + events->count : events->count - until_end] = event;
    events->count++;
}

mspring_result mspring_network_reserve_events(mspring_network *network, uint32_t capacity) {
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    if (capacity > MSPRING_MAX_SPRINGS)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "room for %u events is asked for, %u is the most", (unsigned)capacity,
                             (unsigned)MSPRING_MAX_SPRINGS);
    mspring_event *ring = capacity > 0 ? mspringi_alloc(&network->memory, capacity, sizeof *ring) : NULL;
    if (capacity > 0 && !ring)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for %u events",
                             (unsigned)capacity);
    mspringi_free(&network->memory, network->events.ring);
    network->events = (mspringi_events){.ring = ring, .capacity = capacity};
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
    mspringi_events *queue = &network->events;
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

/// Blocks that are swept while some islands sleep.
#include "store/sleepers.h"

#include "store/id_pool.h"
#include "store/store.h"

#define SLEEP(table) &table +
const mspringi_sleep_ops *const mspringi_sleepers =
#include "store/features.def"
    0;

mspring_result mspringi_sleep_reserve(mspring_network *network) {
    if (network->sleep.state)
        return MSPRING_OK;
    if (!mspringi_sleepers)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "nothing sleeps in this build of the library: sleep_speed must be 0");
    mspring_result result = mspringi_incidence_reserve(network);
    if (result == MSPRING_OK && !mspringi_store_reserve(network, MSPRINGI_STORE_SLEEP))
        result = mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to let %zu slots sleep",
                               mspringi_slot_count(network));
    return result;
}

bool mspringi_is_any_swept(const mspring_network *network, size_t first, size_t end) {
    if (network->sleep.sleeping == 0)
        return true;
    for (size_t block = first; block < end; ++block)
        if (network->sleep.swept[block])
            return true;
    return false;
}

bool mspringi_next_swept(const mspring_network *network, const mspringi_span *span, uint32_t *at,
                         mspringi_span part[2]) {
    const uint8_t *swept = network->sleep.swept;
    const uint32_t first_block = span->first_slot / MSPRINGI_WIDTH;
    const uint32_t end_block = (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
    uint32_t first = *at / MSPRINGI_WIDTH;
    while (first < end_block && !swept[first])
        ++first;
    uint32_t end = first;
    while (end < end_block && swept[end])
        ++end;
    if (first == end)
        return false;
    part[0] = *span;
    if (first > first_block)
        part[0].first_slot = first * MSPRINGI_WIDTH;
    if (end < end_block)
        part[0].end_slot = end * MSPRINGI_WIDTH;
    part[0].first_record += first - first_block;
    part[1] = part[0];
    *at = end * MSPRINGI_WIDTH;
    return true;
}

bool mspringi_next_awake(const mspring_network *network, uint32_t base, uint32_t count, uint32_t *first,
                         uint32_t *end) {
    const mspringi_sleep *sleep = &network->sleep;
    *end = count;
    if (sleep->sleeping == 0)
        return *first < count;
    while (*first < count && !sleep->swept[base + *first])
        ++*first;
    *end = *first;
    while (*end < count && sleep->swept[base + *end])
        ++*end;
    return *first < count;
}

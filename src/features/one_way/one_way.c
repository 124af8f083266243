/// Springs that only pull or only push.
#include "features/one_way/one_way.h"

#include "store/changed.h"
#include "store/feature.h"

static int side_of(const mspringi_spring *spring) {
    return spring->flags & MSPRING_SPRING_PULL_ONLY ? 1 : spring->flags & MSPRING_SPRING_PUSH_ONLY ? -1 : 0;
}

static bool reserve(mspring_network *network, uint32_t count) {
    mspringi_one_way *made = network->one_way = mspringi_alloc(&network->memory, 1, sizeof *made);
    if (!made)
        return false;
    made->count = count;
    made->side = mspringi_alloc(&network->memory, network->topology.reserve.first_spring, sizeof *made->side);
    made->list = mspringi_alloc(&network->memory, count, sizeof *made->list);
    return made->side && made->list;
}

static const mspringi_array_entry arrays[] = {MSPRINGI_ARRAY_ENTRY(mspringi_one_way, side, MSPRINGI_ARRAY),
                                              MSPRINGI_ARRAY_ENTRY(mspringi_one_way, list, MSPRINGI_ARRAY)};
const mspringi_feature_state mspringi_state_of_one_way = {MSPRINGI_ARRAY_TABLE(arrays), NULL};

mspring_result mspringi_one_way_create(mspring_network *network, const mspring_builder *builder) {
    uint32_t count = 0;
    for (size_t s = 0; s < builder->spring_count; ++s)
        count += side_of(&builder->springs[s]) != 0;
    if (count == 0)
        return MSPRING_OK;
    if (!reserve(network, count))
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for %u springs that only pull or only push", (unsigned)count);
    for (size_t s = 0; s < builder->spring_count; ++s) {
        network->one_way->side[s] = (int8_t)side_of(&builder->springs[s]);
        mspringi_fingerprint_floats(network, (float)network->one_way->side[s], 0.0f);
    }
    return MSPRING_OK;
}

bool mspringi_one_way_varies(const mspring_network *network) {
    return network->one_way != NULL;
}

uint32_t mspringi_side_flags(const mspring_network *network, mspring_id spring) {
    const int side = mspringi_side_of(network, spring);
    return side > 0 ? MSPRING_SPRING_PULL_ONLY : side < 0 ? MSPRING_SPRING_PUSH_ONLY : 0u;
}

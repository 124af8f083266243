/// Springs that only pull or only push.
#include "features/one_way/one_way.h"

#include "store/changed.h"
#include "store/store.h"

static int side_of(const mspringi_spring *spring) {
    return spring->flags & MSPRING_SPRING_PULL_ONLY ? 1 : spring->flags & MSPRING_SPRING_PUSH_ONLY ? -1 : 0;
}

mspring_result mspringi_one_way_create(mspring_network *network, const mspring_builder *builder) {
    mspringi_one_way *one_way = &network->one_way;
    for (size_t s = 0; s < builder->spring_count; ++s)
        one_way->count += side_of(&builder->springs[s]) != 0;
    if (one_way->count == 0)
        return MSPRING_OK;
    if (!mspringi_store_reserve(network, MSPRINGI_STORE_ONE_WAY))
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for %u springs that only pull or only push", (unsigned)one_way->count);
    for (size_t s = 0; s < builder->spring_count; ++s) {
        one_way->side[s] = (int8_t)side_of(&builder->springs[s]);
        mspringi_fingerprint_floats(network, (float)one_way->side[s], 0.0f);
    }
    return MSPRING_OK;
}

uint32_t mspringi_side_flags(const mspring_network *network, mspring_id spring) {
    const int side = mspringi_side_of(network, spring);
    return side > 0 ? MSPRING_SPRING_PULL_ONLY : side < 0 ? MSPRING_SPRING_PUSH_ONLY : 0u;
}

/// Springs that only pull or only push.
#include "features/one_way/one_way.h"

#include "store/feature.h"

static const mspringi_array_entry arrays[] = {MSPRINGI_ARRAY_ENTRY(mspringi_one_way, list, MSPRINGI_ARRAY)};
const mspringi_feature_state mspringi_state_of_one_way = {MSPRINGI_ARRAY_TABLE(arrays), NULL};

mspring_result mspringi_one_way_create(mspring_network *network, const mspring_builder *builder) {
    uint32_t count = 0;
    for (mspring_id s = 0; network->side && s < network->topology.reserve.first_spring; ++s)
        count += network->side[s] != 0;
    (void)builder;
    if (count == 0)
        return MSPRING_OK;
    mspringi_one_way *made = network->one_way = mspringi_alloc(&network->memory, 1, sizeof *made);
    if (made) {
        made->count = count;
        made->list = mspringi_alloc(&network->memory, count, sizeof *made->list);
    }
    return made && made->list
               ? MSPRING_OK
               : mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                               "no memory for %u springs that only pull or only push", (unsigned)count);
}

bool mspringi_one_way_is_used(const mspring_network *network) {
    return network->one_way != NULL;
}

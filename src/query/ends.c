/// What a host draws springs from: their ends and flags, for a range of ids.
#include "store/springs.h"

static mspring_result check(const mspring_network *network, mspring_id first, uint32_t count, const uint32_t *a,
                            const uint32_t *b, uint32_t stride) {
    if (!network || (count > 0 && (!a || !b)) || stride == 0)
        return MSPRING_ERROR_ARGUMENT;
    const uint32_t total = network->topology.spring_count;
    return first <= total && count <= total - first ? MSPRING_OK : MSPRING_ERROR_ID;
}

mspring_result mspring_network_get_ends(const mspring_network *network, mspring_id first, uint32_t count,
                                        mspring_numbering numbering, uint32_t *a, uint32_t *b, uint32_t stride) {
    if (numbering != MSPRING_ENDS_IDS && numbering != MSPRING_ENDS_SLOTS)
        return MSPRING_ERROR_ARGUMENT;
    const mspring_result result = check(network, first, count, a, b, stride);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        mspringi_ends ends = {MSPRING_NONE, MSPRING_NONE};
        if (mspringi_spring_exists(network, first + i)) {
            const uint32_t *of_slot = network->topology.particle_of_slot;
            ends = mspringi_spring_ends(network, first + i);
            if (numbering == MSPRING_ENDS_IDS)
                ends = (mspringi_ends){of_slot[ends.a], of_slot[ends.b]};
        }
        a[(size_t)i * stride] = ends.a;
        b[(size_t)i * stride] = ends.b;
    }
    return result;
}

mspring_result mspring_network_get_spring_flags(const mspring_network *network, mspring_id first, uint32_t count,
                                                uint32_t *flags, uint32_t stride) {
    const mspring_result result = check(network, first, count, flags, flags, stride);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i)
        flags[(size_t)i * stride] = mspringi_spring_exists(network, first + i)
                                        ? mspringi_spring_flags(network, first + i)
                                        : MSPRING_SPRING_BROKEN | MSPRING_SPRING_REMOVED;
    return result;
}

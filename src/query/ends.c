/// Ends and flags of a range of springs, for drawing.
#include "store/selection.h"
#include "store/springs.h"

mspring_result mspring_network_get_ends(const mspring_network *network, mspring_id first, uint32_t count,
                                        mspring_numbering numbering, uint32_t *a, uint32_t *b, uint32_t stride) {
    mspringi_selection at;
    const mspring_result result =
        mspringi_look_up_range(network, MSPRINGI_SPRINGS, first, count, a, b, stride, &at);
    if (result != MSPRING_OK)
        return result;
    if (numbering != MSPRING_ENDS_IDS && numbering != MSPRING_ENDS_SLOTS)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT, "numbering is %d, which is none",
                                    (int)numbering);
    const uint32_t *of_slot = network->topology.particle_of_slot;
    for (uint32_t i = 0; i < count; ++i) {
        mspringi_ends ends = {MSPRING_NONE, MSPRING_NONE};
        if (mspringi_spring_exists(network, first + i)) {
            ends = mspringi_spring_ends(network, first + i);
            if (numbering == MSPRING_ENDS_IDS)
                ends = (mspringi_ends){of_slot[ends.a], of_slot[ends.b]};
        }
        a[(size_t)i * stride] = ends.a;
        b[(size_t)i * stride] = ends.b;
    }
    return MSPRING_OK;
}

mspring_result mspring_network_get_spring_flags(const mspring_network *network, mspring_id first, uint32_t count,
                                                uint32_t *flags, uint32_t stride) {
    mspringi_selection at;
    const mspring_result result =
        mspringi_look_up_range(network, MSPRINGI_SPRINGS, first, count, flags, flags, stride, &at);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i)
        flags[(size_t)i * stride] = mspringi_spring_exists(network, first + i)
                                        ? mspringi_spring_flags(network, first + i)
                                        : MSPRING_SPRING_BROKEN | MSPRING_SPRING_REMOVED;
    return result;
}

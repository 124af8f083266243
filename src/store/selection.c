/// Checking ranges and lists of ids.
#include "store/selection.h"

static mspring_result check_arrays(mspring_network *network, uint32_t count, const void *values, const void *more) {
    mspring_result result = mspringi_enter(network);
    if (result == MSPRING_OK && count > 0 && (!values || !more))
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "an array of %u elements is NULL",
                               (unsigned)count);
    return result;
}

static const char *const names[] = {"particle", "spring"};

static uint32_t total_of(const mspring_network *network, mspringi_kind kind) {
    return kind == MSPRINGI_PARTICLES ? network->topology.particle_count : network->topology.spring_count;
}

static bool exists(const mspring_network *network, mspringi_kind kind, mspring_id id) {
    return kind == MSPRINGI_PARTICLES ? mspringi_particle_exists(network, id) : mspringi_spring_exists(network, id);
}

mspring_result mspringi_select_range(mspring_network *network, mspringi_kind kind, mspring_id first, uint32_t count,
                                     const void *values, const void *more, mspringi_selection *selection) {
    mspring_result result = check_arrays(network, count, values, more);
    if (result == MSPRING_OK)
        result = mspringi_check_range(network, names[kind], first, count, total_of(network, kind));
    if (result == MSPRING_OK)
        *selection = (mspringi_selection){.first = first, .count = count};
    return result;
}

mspring_result mspringi_select_list(mspring_network *network, mspringi_kind kind, const mspring_id *list,
                                    uint32_t count, const void *values, const void *more,
                                    mspringi_selection *selection) {
    mspring_result result = check_arrays(network, count, values, more);
    if (result == MSPRING_OK)
        result = check_arrays(network, count, list, list);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        if (list[i] == MSPRING_NONE)
            result = mspringi_fail(&network->message, MSPRING_ERROR_ID,
                                   "index %u of the list: MSPRING_NONE is no %s", (unsigned)i, names[kind]);
        else if (list[i] >= total_of(network, kind))
            result = mspringi_fail(&network->message, MSPRING_ERROR_ID,
                                   "index %u of the list: there is no %s %u, only %u", (unsigned)i, names[kind],
                                   (unsigned)list[i], (unsigned)total_of(network, kind));
        else if (!exists(network, kind, list[i]))
            result =
                mspringi_fail(&network->message, MSPRING_ERROR_ID, "index %u of the list: %s %u has been removed",
                              (unsigned)i, names[kind], (unsigned)list[i]);
    }
    if (result == MSPRING_OK)
        *selection = (mspringi_selection){.list = list, .count = count};
    return result;
}

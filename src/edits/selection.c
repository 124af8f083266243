/// Checking ranges and lists of ids.
#include "selection.h"

static mspring_result check_arrays(mspring_network *network, uint32_t count, const void *values, const void *more) {
    mspring_result result = mspringi_enter(network);
    if (result == MSPRING_OK && count > 0 && (!values || !more))
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "an array of %u elements is NULL",
                               (unsigned)count);
    return result;
}

mspring_result mspringi_select_range(mspring_network *network, const char *what, uint32_t total, mspring_id first,
                                     uint32_t count, const void *values, const void *more,
                                     mspringi_selection *selection) {
    mspring_result result = check_arrays(network, count, values, more);
    if (result == MSPRING_OK)
        result = mspringi_check_range(network, what, first, count, total);
    if (result == MSPRING_OK)
        *selection = (mspringi_selection){.first = first, .count = count};
    return result;
}

mspring_result mspringi_select_list(mspring_network *network, const char *what, uint32_t total,
                                    const mspring_id *list, uint32_t count, const void *values, const void *more,
                                    mspringi_selection *selection) {
    mspring_result result = check_arrays(network, count, values, more);
    if (result == MSPRING_OK)
        result = check_arrays(network, count, list, list);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i)
        if (list[i] >= total)
            result = mspringi_fail(&network->message, MSPRING_ERROR_ID,
                                   "index %u of the list: there is no %s %u, only %u", (unsigned)i, what,
                                   (unsigned)list[i], (unsigned)total);
    if (result == MSPRING_OK)
        *selection = (mspringi_selection){.list = list, .count = count};
    return result;
}

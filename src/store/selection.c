/// Checking ranges and lists of ids.
#include "store/selection.h"

static const char *const names[] = {"particle", "spring"};

static uint32_t total_of(const mspring_network *network, mspringi_kind kind) {
    return kind == MSPRINGI_PARTICLES ? network->topology.particle_count : network->topology.spring_count;
}

static bool exists(const mspring_network *network, mspringi_kind kind, mspring_id id) {
    return kind == MSPRINGI_PARTICLES ? mspringi_particle_exists(network, id) : mspringi_spring_exists(network, id);
}

static mspring_result check_arrays(uint32_t count, const void *values, const void *more,
                                   mspringi_message *message) {
    return count == 0 || (values && more)
               ? MSPRING_OK
               : mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "an array of %u elements is NULL", (unsigned)count);
}

static mspring_result check_stride(uint32_t count, uint32_t stride, mspringi_message *message) {
    return count == 0 || stride > 0
               ? MSPRING_OK
               : mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the stride is 0, it must be at least 1");
}

static mspring_result check_range(const mspring_network *network, mspringi_kind kind, mspring_id first,
                                  uint32_t count, mspringi_message *message) {
    const uint32_t total = total_of(network, kind);
    return first <= total && count <= total - first
               ? MSPRING_OK
               : mspringi_fail(message, MSPRING_ERROR_ID, "%u %s%s from id %s on: ids are below %u",
                               (unsigned)count, names[kind], count == 1 ? "" : "s", MSPRINGI_ID(first),
                               (unsigned)total);
}

static mspring_result check_id(const mspring_network *network, mspringi_kind kind, mspring_id id,
                               mspringi_message *message) {
    if (id >= total_of(network, kind))
        return mspringi_fail(message, MSPRING_ERROR_ID, "there is no %s %s: ids are below %u", names[kind],
                             MSPRINGI_ID(id), (unsigned)total_of(network, kind));
    return exists(network, kind, id)
               ? MSPRING_OK
               : mspringi_fail(message, MSPRING_ERROR_ID, "%s %u has been removed", names[kind], (unsigned)id);
}

static mspring_result check_list(const mspring_network *network, mspringi_kind kind, const mspring_id *list,
                                 uint32_t count, mspringi_message *message) {
    mspring_result result = check_arrays(count, list, list, message);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        if (list[i] < total_of(network, kind) && exists(network, kind, list[i]))
            continue;
        mspringi_message reason;
        result = check_id(network, kind, list[i], &reason);
        result = mspringi_fail(message, result, "index %u of the list: %s", (unsigned)i, reason.text);
    }
    return result;
}

/* ------------------------------------------------------------------------------------------- calls that write */

mspring_result mspringi_select_range(mspring_network *network, mspringi_kind kind, mspring_id first, uint32_t count,
                                     const void *values, const void *more, mspringi_selection *selection) {
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = check_arrays(count, values, more, &network->message);
    if (result == MSPRING_OK)
        result = check_range(network, kind, first, count, &network->message);
    if (result == MSPRING_OK)
        *selection = (mspringi_selection){.first = first, .count = count};
    return result;
}

mspring_result mspringi_select_one(mspring_network *network, mspringi_kind kind, const mspring_id *id,
                                   mspringi_selection *selection) {
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = check_id(network, kind, *id, &network->message);
    if (result == MSPRING_OK)
        *selection = (mspringi_selection){.list = id, .count = 1};
    return result;
}

mspring_result mspringi_select_list(mspring_network *network, mspringi_kind kind, const mspring_id *list,
                                    uint32_t count, const void *values, const void *more,
                                    mspringi_selection *selection) {
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = check_arrays(count, values, more, &network->message);
    if (result == MSPRING_OK)
        result = check_list(network, kind, list, count, &network->message);
    if (result == MSPRING_OK)
        *selection = (mspringi_selection){.list = list, .count = count};
    return result;
}

/* -------------------------------------------------------------------------------------------- calls that read */

static mspring_result leave(const mspring_network *network, mspring_result result,
                            const mspringi_message *message) {
    return result == MSPRING_OK ? MSPRING_OK : mspringi_shared_set(network->shared, result, message);
}

mspring_result mspringi_look_up_range(const mspring_network *network, mspringi_kind kind, mspring_id first,
                                      uint32_t count, const void *values, const void *more, uint32_t stride,
                                      mspringi_selection *selection) {
    mspringi_message message;
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    mspring_result result = check_arrays(count, values, more, &message);
    if (result == MSPRING_OK)
        result = check_stride(count, stride, &message);
    if (result == MSPRING_OK)
        result = check_range(network, kind, first, count, &message);
    *selection = (mspringi_selection){.first = first, .count = count};
    return leave(network, result, &message);
}

mspring_result mspringi_look_up_list(const mspring_network *network, mspringi_kind kind, const mspring_id *list,
                                     uint32_t count, const void *values, const void *more, uint32_t stride,
                                     mspringi_selection *selection) {
    mspringi_message message;
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    mspring_result result = check_arrays(count, values, more, &message);
    if (result == MSPRING_OK)
        result = check_stride(count, stride, &message);
    if (result == MSPRING_OK)
        result = check_list(network, kind, list, count, &message);
    *selection = (mspringi_selection){.list = list, .count = count};
    return leave(network, result, &message);
}

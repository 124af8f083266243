/// Checking ranges and lists of ids.
#include "store/selection.h"

#include "store/things.h"

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

static mspring_result check_id(const mspring_network *network, const mspringi_thing_ops *of, mspring_id id,
                               mspringi_message *message) {
    if (id >= of->total(network))
        return mspringi_fail(message, MSPRING_ERROR_ID, "there is no %s %s: ids are below %u", of->name,
                             MSPRINGI_ID(id), (unsigned)of->total(network));
    return of->exists(network, id)
               ? MSPRING_OK
               : mspringi_fail(message, MSPRING_ERROR_ID, "%s %u has been removed", of->name, (unsigned)id);
}

static mspring_result check_range(const mspring_network *network, const mspringi_thing_ops *of, mspring_id first,
                                  uint32_t count, mspringi_message *message) {
    const uint32_t total = of->total(network);
    return first <= total && count <= total - first
               ? MSPRING_OK
               : mspringi_fail(message, MSPRING_ERROR_ID, "%u %s%s from id %s on: ids are below %u",
                               (unsigned)count, of->name, count == 1 ? "" : "s", MSPRINGI_ID(first),
                               (unsigned)total);
}

static mspring_result check_list(const mspring_network *network, const mspringi_thing_ops *of,
                                 const mspringi_selection *at, mspringi_message *message) {
    const uint32_t total = of->total(network);
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; result == MSPRING_OK && i < at->count; ++i) {
        if (at->list[i] < total && of->exists(network, at->list[i]))
            continue;
        mspringi_message reason;
        result = check_id(network, of, at->list[i], &reason);
        result = mspringi_fail(message, result, "index %u of the list: %s", (unsigned)(at->first + i), reason.text);
    }
    return result;
}

// `is_open` if the count may be MSPRING_ALL.
static mspring_result choose(const mspring_network *network, mspring_kind kind, mspringi_selection *at,
                             bool is_open, mspringi_message *message) {
    const mspringi_thing_ops *of = mspringi_things_of(kind);
    if (!of)
        return mspringi_fail(message, MSPRING_ERROR_ID, "this build has none of these things (mspring_features())");
    if (at->list && at->count == MSPRING_ALL)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the count is MSPRING_ALL, but there is a list of ids: give its length");
    if (at->list) {
        at->list += at->first;
        return check_list(network, of, at, message);
    }
    if (at->count == MSPRING_ALL && !is_open)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the count is MSPRING_ALL, but arrays depend on it: give their length");
    const uint32_t total = of->total(network);
    if (at->count == MSPRING_ALL && at->first <= total)
        at->count = total - at->first;
    return check_range(network, of, at->first, at->count, message);
}

/* ------------------------------------------------------------------------------------------- calls that write */

mspring_result mspringi_select(mspring_network *network, mspring_kind kind, const mspring_id *ids, mspring_id first,
                               uint32_t count, mspringi_selection *selection) {
    const mspring_result result = mspringi_check_call(network);
    *selection = (mspringi_selection){ids, first, count};
    return result == MSPRING_OK ? choose(network, kind, selection, true, &network->message) : result;
}

mspring_result mspringi_select_for(mspring_network *network, mspring_kind kind, const mspring_id *ids,
                                   mspring_id first, uint32_t count, const void *values, const void *more,
                                   uint32_t stride, mspringi_selection *selection) {
    mspring_result result = mspringi_check_call(network);
    *selection = (mspringi_selection){ids, first, count};
    if (result == MSPRING_OK)
        result = check_arrays(count, values, more, &network->message);
    return result == MSPRING_OK ? choose(network, kind, selection, stride == 0, &network->message) : result;
}

mspring_result mspringi_select_one(mspring_network *network, mspring_kind kind, const mspring_id *id,
                                   mspringi_selection *selection) {
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = check_id(network, mspringi_things_of(kind), *id, &network->message);
    if (result == MSPRING_OK)
        *selection = (mspringi_selection){.list = id, .count = 1};
    return result;
}

/* -------------------------------------------------------------------------------------------- calls that read */

static mspring_result leave(const mspring_network *network, mspring_result result,
                            const mspringi_message *message) {
    return result == MSPRING_OK ? MSPRING_OK : mspringi_shared_set(network->shared, result, message);
}

mspring_result mspringi_look_up_with(mspringi_message *message, const mspring_network *network, mspring_kind kind,
                                     const mspring_id *ids, mspring_id first, uint32_t count,
                                     mspringi_selection *selection) {
    *selection = (mspringi_selection){ids, first, count};
    return choose(network, kind, selection, true, message);
}

mspring_result mspringi_look_up(const mspring_network *network, mspring_kind kind, const mspring_id *ids,
                                mspring_id first, uint32_t count, mspringi_selection *selection) {
    mspringi_message message;
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    return leave(network, mspringi_look_up_with(&message, network, kind, ids, first, count, selection), &message);
}

mspring_result mspringi_look_up_for(const mspring_network *network, mspring_kind kind, const mspring_id *ids,
                                    mspring_id first, uint32_t count, const void *values, const void *more,
                                    uint32_t stride, mspringi_selection *selection) {
    mspringi_message message;
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    *selection = (mspringi_selection){ids, first, count};
    mspring_result result = check_arrays(count, values, more, &message);
    if (result == MSPRING_OK)
        result = check_stride(count, stride, &message);
    if (result == MSPRING_OK)
        result = choose(network, kind, selection, false, &message);
    return leave(network, result, &message);
}

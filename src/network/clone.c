/// Clone of a network: copy all blocks of memory, then relocate every pointer from one block into another.
///
/// Pointers of the network are listed in store/network.def, those of topologies and solvers next to their destroy
/// functions, those of features in their rooms. A forgotten one points into the original; test_clone checks every
/// word of a clone for that.
#include "features/contact/contacts.h"
#include "features/hooks/hooks.h"
#include "store/feature.h"
#include "store/network.h"
#include "store/store.h"

static void relocate_network(mspring_network *n, const mspringi_memory *from, const mspringi_memory *to) {
    mspringi_array_table_relocate(mspringi_topology_arrays, &n->topology, from, to);
    mspringi_array_table_relocate(mspringi_topology_arrays, &n->whole, from, to);
    mspringi_store_relocate(n, from, to);
    mspringi_features_relocate(n, from, to);
    mspringi_solvers_relocate(n, from, to);
}

/* ---------------------------------------------------------------------------------------------------- the clone */

static bool has_hook_with_storage(const mspring_network *network) {
    for (size_t i = 0; i < mspringi_hook_count(network); ++i)
        if (network->hooks->list[i].def.storage)
            return true;
    return false;
}

// Give a clone its own threads and their working memory.
static mspring_result start_tasks(mspring_network *network, const mspring_clone_def *def) {
    mspring_result result = mspringi_shared_reserve(network);
    if (result == MSPRING_OK)
        result = mspringi_tasks_create(def->worker_count, def->tasks, &network->tasks_memory, &network->message,
                                       &network->tasks);
    if (result == MSPRING_OK)
        result = mspringi_carry_reserve(network);
    if (result == MSPRING_OK && network->contacts && !mspringi_contact_reserve_ranges(network, network->contacts))
        result = mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for the clone's workers");
    return result == MSPRING_OK ? mspringi_solvers_reserve(network) : result;
}

static mspring_result copy(const mspring_network *network, const mspring_clone_def *def,
                           const mspring_allocator *allocator, mspring_network **clone, mspringi_message *message) {
    mspringi_memory memory = {.allocator = *allocator};
    mspring_network *made = NULL;
    if (mspringi_memory_copy(&network->memory, &memory))
        made = mspringi_memory_relocate(&network->memory, &memory, network);
    if (!made) {
        mspringi_free_all(&memory);
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for a copy of the network");
    }
    made->memory = memory;
    made->tasks_memory = (mspringi_memory){.allocator = *allocator};
    made->tasks = NULL;
    made->job = NULL;
    mspringi_message_clear(&made->message);
    made->shared = NULL;
    relocate_network(made, &network->memory, &made->memory);
    made->release_tasks = NULL;
    if (!def->copy_hooks)
        mspringi_hooks_clear(made);
    mspring_result result = start_tasks(made, def);
    if (result == MSPRING_OK) {
        mspringi_hooks_retain(made);
        mspringi_network_own_tasks(made, def->tasks);
        *clone = made;
    } else {
        *message = made->message;
        mspringi_hooks_clear(made);
        mspring_network_destroy(made);
    }
    return result;
}

static mspring_result check_clone(const mspring_network *network, const mspring_clone_def **given,
                                  mspring_clone_def *def, mspring_network *const *clone,
                                  mspringi_message *message) {
    if (!clone)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "clone is NULL");
    if (network->in_hook != MSPRINGI_IN_NO_HOOK)
        return mspringi_fail(message, MSPRING_ERROR_BUSY, "no clone is made inside a hook");
    mspring_result result = mspringi_take_clone_def_or_defaults(message, given, def);
    if (result == MSPRING_OK)
        result = mspringi_check_reserved(message, "mspring_clone_def", def->reserved);
    if (result != MSPRING_OK)
        return result;
    if (def->copy_hooks > 1)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "copy_hooks is %u, it must be 0 or 1",
                             (unsigned)def->copy_hooks);
    const uint32_t has = mspringi_tasks_workers(network->tasks);
    const uint32_t workers = def->tasks ? def->tasks->worker_count : def->worker_count;
    if (def->copy_hooks && workers > has && has_hook_with_storage(network))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "hooks have storage for %u workers, the clone is to have %u", (unsigned)has,
                             (unsigned)workers);
    return MSPRING_OK;
}

mspring_result mspring_network_clone(const mspring_network *network, const mspring_clone_def *def,
                                     mspring_network **clone) {
    mspring_clone_def taken;
    mspringi_message message;
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_message_clear(&message);
    mspring_result result = check_clone(network, &def, &taken, clone, &message);
    mspringi_memory memory = network->memory;
    if (result == MSPRING_OK && def->allocator)
        result = mspringi_memory_init(&memory, def->allocator, &message);
    if (result == MSPRING_OK)
        result = copy(network, def, &memory.allocator, clone, &message);
    return result == MSPRING_OK ? MSPRING_OK : mspringi_shared_set(network->shared, result, &message);
}

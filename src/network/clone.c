/// Clone of a network: copy all blocks of memory, then relocate every pointer from one block into another.
///
/// Pointers of the network are listed in store/network.def, those of topologies and solvers next to their destroy
/// functions. Those of contact are in features/contact/contacts.c, those of floor and hooks here. A forgotten one
/// points into the original; test_clone checks every word of a clone for that.
#include "features/contact/contacts.h"
#include "features/contact/floor.h"
#include "store/network.h"
#include "store/store.h"

/// Memories of the original and of the copy.
typedef struct relocation {
    const mspringi_memory *from, *to;
} relocation;

/// Redirect a copied pointer to the copy of its block.
#define RELOCATE(pointer) ((pointer) = mspringi_memory_relocate(r->from, r->to, (pointer)))

static void relocate_field(const relocation *r, mspringi_field *field) {
    RELOCATE(field->x);
    RELOCATE(field->y);
}

static void relocate_state(const relocation *r, mspringi_state *state) {
    RELOCATE(state->x);
    RELOCATE(state->y);
    RELOCATE(state->vx);
    RELOCATE(state->vy);
    RELOCATE(state->low_x);
    RELOCATE(state->low_y);
    RELOCATE(state->low_vx);
    RELOCATE(state->low_vy);
}

static void relocate_floor(const relocation *r, mspringi_floor *floor) {
    RELOCATE(floor->heights.heights);
    RELOCATE(floor->heights.normals);
    RELOCATE(floor->heights.frictions);
    RELOCATE(floor->heights.restitutions);
    RELOCATE(floor->plane_frictions);
    RELOCATE(floor->plane_restitutions);
    for (uint32_t i = 0; i < MSPRINGI_HEIGHT_LEVELS; ++i)
        RELOCATE(floor->heights.highest[i]);
    RELOCATE(floor->clearances);
    relocate_field(r, &floor->start);
    relocate_state(r, &floor->before);
    relocate_field(r, &floor->impulse);
    relocate_field(r, &floor->previous_impulse);
}

static void relocate_network(const relocation *r, mspring_network *n) {
    mspringi_array_table_relocate(mspringi_topology_arrays, &n->topology, r->from, r->to);
    mspringi_array_table_relocate(mspringi_topology_arrays, &n->whole, r->from, r->to);
    mspringi_store_relocate(n, r->from, r->to);
    for (size_t i = 0; i < n->hook_count; ++i)
        relocate_field(r, &n->hooks[i].held);
    RELOCATE(n->floor);
    if (n->floor)
        relocate_floor(r, n->floor);
    RELOCATE(n->contacts);
    if (n->contacts)
        mspringi_contacts_relocate(n->contacts, r->from, r->to);
    mspringi_solvers_relocate(n, r->from, r->to);
}

/* ---------------------------------------------------------------------------------------------------- the clone */

static void drop_hooks(mspring_network *network) {
    for (size_t i = 0; i < network->hook_count; ++i)
        mspringi_free(&network->memory, network->hooks[i].held.x);
    network->hook_count = 0;
}

static bool has_hook_with_storage(const mspring_network *network) {
    for (size_t i = 0; i < network->hook_count; ++i)
        if (network->hooks[i].def.storage)
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
    relocate_network(&(relocation){&network->memory, &made->memory}, made);
    if (!(def->flags & MSPRING_CLONE_HOOKS))
        drop_hooks(made);
    mspring_result result = start_tasks(made, def);
    if (result == MSPRING_OK) {
        *clone = made;
    } else {
        *message = made->message;
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
    if (def->flags & ~(uint32_t)MSPRING_CLONE_HOOKS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "clone flags %#x are unknown", (unsigned)def->flags);
    const uint32_t has = mspringi_tasks_workers(network->tasks);
    const uint32_t workers = def->tasks ? def->tasks->worker_count : def->worker_count;
    if (def->flags & MSPRING_CLONE_HOOKS && workers > has && has_hook_with_storage(network))
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

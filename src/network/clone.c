/// Clone of a network: copy all blocks of memory, then relocate every pointer from one block into another.
///
/// Pointers of the network are listed in store/network.def, those of topologies and solvers in tables next to their
/// destroy functions, those of contact in contact/contacts.c, those of floor and hooks here. A forgotten one points
/// into the original; test_clone checks every word of a clone for that.
#include "contact/contacts.h"
#include "contact/floor.h"
#include "store/network.h"
#include "store/store.h"

/// Memories of the original and of the copy.
typedef struct moving {
    const mspringi_memory *from, *to;
} moving;

/// Redirect a copied pointer to the copy of its block.
#define MOVE(pointer) ((pointer) = mspringi_memory_moved(m->from, m->to, (pointer)))

static void move_field(const moving *m, mspringi_field *field) {
    MOVE(field->x);
    MOVE(field->y);
}

static void move_state(const moving *m, mspringi_state *state) {
    MOVE(state->x);
    MOVE(state->y);
    MOVE(state->vx);
    MOVE(state->vy);
    MOVE(state->low_x);
    MOVE(state->low_y);
}

static void move_floor(const moving *m, mspringi_floor *floor) {
    MOVE(floor->heights.heights);
    MOVE(floor->heights.normals);
    MOVE(floor->heights.frictions);
    MOVE(floor->heights.restitutions);
    MOVE(floor->plane_frictions);
    MOVE(floor->plane_restitutions);
    for (uint32_t i = 0; i < MSPRINGI_HEIGHT_LEVELS; ++i)
        MOVE(floor->heights.highest[i]);
    MOVE(floor->clearances);
    MOVE(floor->contacts);
    move_field(m, &floor->start);
    move_state(m, &floor->before);
    move_field(m, &floor->impulse);
    move_field(m, &floor->previous_impulse);
}

static void move_network(const moving *m, mspring_network *n) {
    mspringi_array_table_relocate(mspringi_topology_arrays, &n->topology, m->from, m->to);
    mspringi_array_table_relocate(mspringi_topology_arrays, &n->whole, m->from, m->to);
    mspringi_store_relocate(n, m->from, m->to);
    for (size_t i = 0; i < n->hook_count; ++i)
        move_field(m, &n->hooks[i].held);
    MOVE(n->floor);
    if (n->floor)
        move_floor(m, n->floor);
    MOVE(n->contacts);
    if (n->contacts)
        mspringi_contacts_relocate(n->contacts, m->from, m->to);
    mspringi_solvers_relocate(n, m->from, m->to);
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
static mspring_result employ(mspring_network *network, const mspring_clone_def *def) {
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
        made = mspringi_memory_moved(&network->memory, &memory, network);
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
    move_network(&(moving){&network->memory, &made->memory}, made);
    if (!(def->flags & MSPRING_CLONE_HOOKS))
        drop_hooks(made);
    mspring_result result = employ(made, def);
    if (result == MSPRING_OK) {
        *clone = made;
    } else {
        *message = made->message;
        mspring_network_destroy(made);
    }
    return result;
}

static mspring_result check_clone(const mspring_network *network, const mspring_clone_def *def,
                                  mspring_network *const *clone, mspringi_message *message) {
    if (!clone)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "clone is NULL");
    if (network->in_hook != MSPRINGI_IN_NO_HOOK)
        return mspringi_fail(message, MSPRING_ERROR_BUSY, "no clone is made inside a hook");
    mspring_result result = mspringi_check_struct(message, "mspring_clone_def", def, sizeof *def);
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
    mspring_clone_def defaults;
    mspringi_message message;
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    if (!def) {
        (void)mspring_clone_def_init(&defaults, sizeof defaults);
        def = &defaults;
    }
    mspringi_message_clear(&message);
    mspring_result result = check_clone(network, def, clone, &message);
    mspringi_memory memory = network->memory;
    if (result == MSPRING_OK && def->allocator)
        result = mspringi_memory_init(&memory, def->allocator, &message);
    if (result == MSPRING_OK)
        result = copy(network, def, &memory.allocator, clone, &message);
    return result == MSPRING_OK ? MSPRING_OK : mspringi_shared_take(network->shared, result, &message);
}

/// The components as the host sees them: numbered by their lowest particles, with events of what has split or
/// joined.
#include "store/components.h"

#include <string.h>

#include "base/assert.h"
#include "store/events.h"
#include "store/id_pool.h"
#include "store/roots.h"
#include "store/store.h"

static mspring_result reserve(mspring_network *network) {
    if (network->components.number)
        return MSPRING_OK;
    const size_t particles = network->topology.reserve.particle_end;
    mspringi_components *made = &network->components;
    const bool is_there = mspringi_store_reserve(network, MSPRINGI_STORE_COMPONENTS) &&
                          mspringi_store_reserve(network, MSPRINGI_STORE_ROOT);
    mspring_result result = is_there ? mspringi_incidence_reserve(network)
                                     : mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                                                     "no memory for the components of %zu particles", particles);
    for (size_t p = 0; result == MSPRING_OK && p < particles; ++p)
        made->number[p] = made->old[p] = MSPRING_NONE;
    if (result != MSPRING_OK) {
        mspringi_store_free(network, MSPRINGI_STORE_COMPONENTS);
        mspringi_store_free(network, MSPRINGI_STORE_ROOT);
    }
    return result;
}

/* ------------------------------------------------------------------------------------------------------ numbers */

/// Marks a root that has been given the number in its other bits. There are fewer slots than that.
#define NUMBERED 0x80000000u

// Number the components in the order of their lowest particles.
static void number_components(mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    mspringi_components *c = &network->components;
    c->count = 0;
    for (mspring_id p = 0; p < t->particle_count; ++p) {
        if (!mspringi_particle_exists(network, p)) {
            // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): made with the components
            c->number[p] = MSPRING_NONE;
            continue;
        }
        const uint32_t slot = t->slot_of_particle[p];
        const uint32_t root = c->root[slot] & NUMBERED ? slot : c->root[slot];
        if (!(c->root[root] & NUMBERED)) {
            c->root[root] = NUMBERED | c->count;
            // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): made with the components
            c->head[c->count] = p;
            c->size[c->count++] = 0;
        }
        const uint32_t number = c->root[root] & ~NUMBERED;
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): made with the components
        c->number[p] = number;
        c->size[number]++;
    }
}

static void push_event(mspring_network *network, mspring_event_kind kind, mspring_id id, mspring_id other) {
    mspringi_events_push(network, (mspring_event){.kind = kind, .id = id, .other = other});
}

// Sort the particles by component.
static void list_particles(mspring_network *network) {
    mspringi_components *c = &network->components;
    uint32_t end = 0;
    for (uint32_t i = 0; i < c->count; ++i) {
        c->first[i] = end;
        end += c->size[i];
    }
    for (mspring_id p = 0; p < network->topology.particle_count; ++p)
        if (c->number[p] != MSPRING_NONE)
            c->particles[c->first[c->number[p]]++] = p;
    MSPRINGI_ASSERT(c->count == 0 || c->first[c->count - 1] == end);
    for (uint32_t i = 0; i < c->count; ++i)
        c->first[i] -= c->size[i];
}

void mspringi_components_forget_removed(mspring_network *network) {
    mspringi_components *c = &network->components;
    for (uint32_t i = 0; i < c->count; ++i) {
        mspring_id *of = c->particles + c->first[i];
        uint32_t left = 0;
        for (uint32_t k = 0; k < c->size[i]; ++k)
            if (mspringi_particle_exists(network, of[k]))
                of[left++] = of[k];
        c->size[i] = left;
    }
}

// Tell of the heads that have come and gone.
static void compare_heads(mspring_network *network) {
    const mspringi_components *c = &network->components;
    for (mspring_id p = 0; p < network->topology.particle_count; ++p) {
        if (c->number[p] == MSPRING_NONE || c->old[p] == MSPRING_NONE)
            continue; // removed or added since
        const mspring_id head = c->head[c->number[p]], old_head = c->old_head[c->old[p]];
        if (head == p && old_head != p)
            push_event(network, MSPRING_EVENT_SPLIT, p, old_head);
        else if (head != p && old_head == p)
            push_event(network, MSPRING_EVENT_JOINED, p, head);
    }
}

/* ----------------------------------------------------------------------------------------------------- updates */

static void swap(uint32_t **a, uint32_t **b) {
    uint32_t *const other = *a;
    *a = *b;
    *b = other;
}

// True if there was an update. (It may have found none, where all particles were removed.)
static bool is_known(const mspring_network *network) {
    return network->components.number != NULL;
}

mspring_result mspring_network_update_components(mspring_network *network, uint32_t *count, uint32_t *changed) {
    mspring_result result = mspringi_check_call(network);
    const bool is_first = result == MSPRING_OK && !is_known(network);
    if (result == MSPRING_OK)
        result = reserve(network);
    if (result != MSPRING_OK)
        return result;
    mspringi_components *c = &network->components;
    const bool unchanged = !is_first && c->seen_growth == network->edits.growth &&
                           mspringi_links_change_nothing(network, c->seen, c->number, NULL);
    if (!unchanged) {
        swap(&c->number, &c->old);
        swap(&c->head, &c->old_head);
        mspringi_find_roots(network, c->root);
        number_components(network);
        list_particles(network);
        if (!is_first)
            compare_heads(network);
    }
    c->seen = network->edits.links;
    c->seen_growth = network->edits.growth;
    if (count)
        *count = c->count;
    if (changed)
        *changed = is_first || (!unchanged && memcmp(c->number, c->old,
                                                     network->topology.particle_count * sizeof *c->number) != 0);
    return MSPRING_OK;
}

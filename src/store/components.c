/// The components as the host sees them: numbered by their lowest particles, with events of what has split or
/// joined.
#include "store/components.h"

#include <string.h>

#include "base/cpu.h"
#include "store/events.h"
#include "store/id_pool.h"
#include "store/moments.h"
#include "store/roots.h"
#include "store/selection.h"
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

/* ----------------------------------------------------------------------------------------------------- reading */

#define NO_UPDATE "the components are unknown: call mspring_network_update_components() first"

mspring_result mspring_network_get_component_numbers(const mspring_network *network, mspring_id first,
                                                     uint32_t count, uint32_t *numbers, uint32_t stride) {
    mspringi_selection at;
    mspring_result result =
        mspringi_look_up_range(network, MSPRINGI_PARTICLES, first, count, numbers, numbers, stride, &at);
    if (result == MSPRING_OK && !is_known(network))
        result = mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT, NO_UPDATE);
    if (result != MSPRING_OK)
        return result;
    for (uint32_t i = 0; i < count; ++i)
        numbers[(size_t)i * stride] = network->components.number[first + i];
    return MSPRING_OK;
}

// Add a particle to its component: mass, centre times mass, momentum. All of these fields are of the first version,
// so that the host's struct has them, however short it is.
static void add_particle(const mspring_network *network, mspring_id particle, mspring_component *to) {
    const mspringi_moments moments = mspringi_moments_of(network, particle);
    to->mass += moments.mass;
    to->x += moments.x;
    to->y += moments.y;
    if (network->inverse_mass[network->topology.slot_of_particle[particle]] > 0.0f) {
        to->px += moments.px;
        to->py += moments.py;
    }
}

static MSPRINGI_NOINLINE void measure(const mspring_network *network, uint32_t first, uint32_t count,
                                      mspring_component *components) {
    const mspringi_components *c = &network->components;
    for (uint32_t i = 0; i < count; ++i)
        mspringi_put_component_at(
            components, i, &(mspring_component){.head = c->head[first + i], .particle_count = c->size[first + i]});
    for (mspring_id p = 0; p < network->topology.particle_count; ++p)
        if (c->number[p] - first < count && mspringi_particle_exists(network, p)) // unsigned: below first are not
            add_particle(network, p, mspringi_element(components, c->number[p] - first));
    for (uint32_t i = 0; i < count; ++i) {
        mspring_component *component = mspringi_element(components, i);
        component->x = network->origin_x + component->x / component->mass;
        component->y = network->origin_y + component->y / component->mass;
    }
}

mspring_result mspring_network_get_components(const mspring_network *network, uint32_t first, uint32_t count,
                                              mspring_component *components) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_shared_message *shared = network->shared;
    if (count > 0 && !components)
        return mspringi_shared_fail(shared, MSPRING_ERROR_ARGUMENT, "the place for %u components is NULL",
                                    (unsigned)count);
    if (!is_known(network))
        return mspringi_shared_fail(shared, MSPRING_ERROR_ARGUMENT, NO_UPDATE);
    if (first > network->components.count || count > network->components.count - first)
        return mspringi_shared_fail(shared, MSPRING_ERROR_ID,
                                    "%u components from number %s on: numbers are below %u", (unsigned)count,
                                    MSPRINGI_ID(first), (unsigned)network->components.count);
    mspringi_message message;
    const mspring_result result = mspringi_check_outputs(&message, &mspringi_struct_component, components, count);
    if (result != MSPRING_OK)
        return mspringi_shared_set(shared, result, &message);
    const mspringi_fp_state before = mspringi_fp_enter();
    measure(network, first, count, components);
    mspringi_fp_leave(before);
    return MSPRING_OK;
}

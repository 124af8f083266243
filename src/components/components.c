/// Finding the components: a union-find over slots, in which most of the work is done on bits.
///
/// In a row, a slot hangs on its left neighbour or starts a run; that takes one pass. Between rows, a link is
/// needed only where no link beside it says the same, and masks of live springs tell that for a whole block at
/// once: in a hull that is whole, one slot of sixteen is left. Roots are the lowest slots, so a component has the
/// same root whatever the order of the links.
#include "components.h"

#include <string.h>

#include "base/cpu.h"
#include "base/forest.h"
#include "edits/events.h"
#include "network/springs.h"

/// So many changes are looked at one by one, before finding everything anew costs less.
#define FEW_CHANGES 64

void mspringi_components_destroy(mspringi_components *components, mspringi_memory *memory) {
    mspringi_free(memory, components->number);
    mspringi_free(memory, components->old);
    mspringi_free(memory, components->head);
    mspringi_free(memory, components->old_head);
    mspringi_free(memory, components->size);
    mspringi_free(memory, components->root);
    *components = (mspringi_components){0};
}

static mspring_result reserve(mspring_network *network) {
    if (network->components.number)
        return MSPRING_OK;
    mspringi_memory *memory = &network->memory;
    const size_t particles = network->topology.particle_count;
    mspringi_components made = {
        .number = mspringi_alloc(memory, particles, sizeof *made.number),
        .old = mspringi_alloc(memory, particles, sizeof *made.old),
        .head = mspringi_alloc(memory, particles, sizeof *made.head),
        .old_head = mspringi_alloc(memory, particles, sizeof *made.old_head),
        .size = mspringi_alloc(memory, particles, sizeof *made.size),
        .root = mspringi_alloc(memory, mspringi_slot_count(network), sizeof *made.root),
    };
    mspring_result result = MSPRING_OK;
    if (!made.number || !made.old || !made.head || !made.old_head || !made.size || !made.root)
        result = mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                               "no memory for the components of %zu particles", particles);
    if (result == MSPRING_OK && !network->incidence.first)
        result = mspringi_incidence_create(&network->incidence, &network->topology, memory, &network->message);
    if (result == MSPRING_OK)
        network->components = made;
    else
        mspringi_components_destroy(&made, memory);
    return result;
}

/* --------------------------------------------------------------------------------------------------- the roots */

static uint32_t lowest_bit(uint32_t bits) {
#if defined(__GNUC__)
    return (uint32_t)__builtin_ctz(bits);
#else
    uint32_t bit = 0;
    while (!(bits >> bit & 1))
        ++bit;
    return bit;
#endif
}

// Let every slot from first on hang on the one before it where the springs to the right, a word of bits for each
// block, say so.
static void join_runs(uint32_t *root, uint32_t first, uint32_t block_count, const uint16_t *to_right,
                      size_t words_per_block) {
    uint32_t slot = first * MSPRINGI_WIDTH, carried = 0;
    for (uint32_t block = 0; block < block_count; ++block) {
        const uint32_t right = to_right[block * words_per_block], joined = right << 1 | carried;
        for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane, ++slot)
            root[slot] = joined >> lane & 1 ? root[slot - 1] : slot;
        carried = right >> (MSPRINGI_WIDTH - 1);
    }
}

// Join slots of a lattice block with those of the block above it.
static void join_rows(const mspring_network *network, uint32_t block) {
    const mspringi_topology *t = &network->topology;
    const uint16_t *live = network->live + (size_t)block * MSPRINGI_DIRECTIONS;
    uint32_t *root = network->components.root;
    const uint32_t here = (t->lattice_first + block) * MSPRINGI_WIDTH, up = t->up_of_block[block] * MSPRINGI_WIDTH;
    const uint32_t above = t->up_of_block[block] - t->lattice_first;
    const uint32_t east = live[MSPRINGI_EAST], north = live[MSPRINGI_NORTH];
    const uint32_t east_above = network->live[(size_t)above * MSPRINGI_DIRECTIONS + MSPRINGI_EAST];
    // A link between two rows says nothing new if the one to its left does and both rows hang together there; a
    // diagonal one if a square's side and an upright link go the same way.
    const uint32_t uprights = north & ~((north & east & east_above) << 1);
    const uint32_t known = (north & east_above) | (north >> 1 & east),
                   known_down = (north & east) | (north >> 1 & east_above);
    for (uint32_t bits = uprights; bits; bits &= bits - 1)
        mspringi_forest_join(root, here + lowest_bit(bits), up + lowest_bit(bits));
    for (uint32_t bits = live[MSPRINGI_NORTH_EAST] & ~known; bits; bits &= bits - 1)
        mspringi_forest_join(root, here + lowest_bit(bits), up + lowest_bit(bits) + 1);
    for (uint32_t bits = live[MSPRINGI_SOUTH_EAST] & ~known_down; bits; bits &= bits - 1)
        mspringi_forest_join(root, up + lowest_bit(bits), here + lowest_bit(bits) + 1);
}

// Give every slot the lowest slot that it hangs together with.
static void find_roots(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    uint32_t *root = network->components.root;
    const uint32_t slots = (uint32_t)mspringi_slot_count(network);
    for (uint32_t slot = 0; slot < slots; ++slot)
        root[slot] = slot;
    join_runs(root, t->lattice_first, t->lattice_blocks, network->live + MSPRINGI_EAST, MSPRINGI_DIRECTIONS);
    join_runs(root, t->chain_first, t->chain_blocks, network->live + t->lattice_places / MSPRINGI_WIDTH, 1);
    for (uint32_t block = 0; block < t->lattice_blocks; ++block)
        join_rows(network, block);
    for (uint32_t i = 0; i < t->leftover_count; ++i) {
        const mspringi_place place = t->chain_places + i;
        if (network->live[place / MSPRINGI_WIDTH] >> place % MSPRINGI_WIDTH & 1)
            mspringi_forest_join(root, t->leftover_a[i], t->leftover_b[i]);
    }
    for (uint32_t slot = 0; slot < slots; ++slot)
        root[slot] = root[root[slot]]; // no root is above its slot, so it has its own already
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
        const uint32_t slot = t->slot_of_particle[p];
        const uint32_t root = c->root[slot] & NUMBERED ? slot : c->root[slot];
        if (!(c->root[root] & NUMBERED)) {
            c->root[root] = NUMBERED | c->count;
            c->head[c->count] = p;
            c->size[c->count++] = 0;
        }
        const uint32_t number = c->root[root] & ~NUMBERED;
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
        const mspring_id head = c->head[c->number[p]], old_head = c->old_head[c->old[p]];
        if (head == p && old_head != p)
            push_event(network, MSPRING_EVENT_SPLIT, p, old_head);
        else if (head != p && old_head == p)
            push_event(network, MSPRING_EVENT_JOINED, p, head);
    }
}

/* ------------------------------------------------------------------------------------------------------- updates
 */

typedef struct pair {
    mspring_id a, b;
} pair;

static pair ends_of(const mspring_network *network, mspring_id spring) {
    const mspringi_topology *t = &network->topology;
    uint32_t base, tip;
    mspringi_topology_ends(t, mspringi_place_of(t, spring), &base, &tip);
    return (pair){t->particle_of_slot[base], t->particle_of_slot[tip]};
}

static bool have_common_neighbour(const mspring_network *network, pair ends) {
    const mspringi_incidence *incidence = &network->incidence;
    for (uint32_t i = incidence->first[ends.a]; i < incidence->first[ends.a + 1]; ++i) {
        if (!mspringi_spring_is_live(network, incidence->springs[i]))
            continue;
        const pair first = ends_of(network, incidence->springs[i]);
        const mspring_id between = first.a == ends.a ? first.b : first.a;
        for (uint32_t j = incidence->first[between]; j < incidence->first[between + 1]; ++j) {
            const pair second = ends_of(network, incidence->springs[j]);
            if ((second.a == ends.b || second.b == ends.b) &&
                mspringi_spring_is_live(network, incidence->springs[j]))
                return true;
        }
    }
    return false;
}

// Whether all springs that were broken or restored since the last update have, for all one sees near them, left the
// components as they were: restored ones lie within one, and the ends of broken ones have a neighbour in common.
// Then every path there was can still be gone.
static bool is_unchanged(const mspring_network *network) {
    const mspringi_components *c = &network->components;
    const mspringi_edits *edits = &network->edits;
    if (edits->links - c->seen > FEW_CHANGES || !mspringi_edits_have_link(edits, c->seen))
        return edits->links == c->seen;
    for (uint64_t n = c->seen; n < edits->links; ++n) {
        const mspring_id spring = mspringi_edits_link(edits, n);
        const pair ends = ends_of(network, spring);
        const bool together = c->number[ends.a] == c->number[ends.b];
        if (mspringi_spring_is_live(network, spring) ? !together
                                                     : together && !have_common_neighbour(network, ends))
            return false;
    }
    return true;
}

static void swap(uint32_t **a, uint32_t **b) {
    uint32_t *const other = *a;
    *a = *b;
    *b = other;
}

mspring_result mspring_network_update_components(mspring_network *network, uint32_t *count, uint32_t *changed) {
    mspring_result result = mspringi_enter(network);
    if (result == MSPRING_OK)
        result = reserve(network);
    if (result != MSPRING_OK)
        return result;
    mspringi_components *c = &network->components;
    const bool is_first = c->count == 0, unchanged = !is_first && is_unchanged(network);
    if (!unchanged) {
        swap(&c->number, &c->old);
        swap(&c->head, &c->old_head);
        find_roots(network);
        number_components(network);
        if (!is_first)
            compare_heads(network);
    }
    c->seen = network->edits.links;
    if (count)
        *count = c->count;
    if (changed)
        *changed = is_first || (!unchanged && memcmp(c->number, c->old,
                                                     network->topology.particle_count * sizeof *c->number) != 0);
    return MSPRING_OK;
}

/* ------------------------------------------------------------------------------------------------------- reading
 */

mspring_result mspring_network_get_component_numbers(const mspring_network *network, mspring_id first,
                                                     uint32_t count, uint32_t *component) {
    if (!network || (count > 0 && !component) || network->components.count == 0)
        return MSPRING_ERROR_ARGUMENT;
    const uint32_t total = network->topology.particle_count;
    if (first > total || count > total - first)
        return MSPRING_ERROR_ID;
    memcpy(component, network->components.number + first, count * sizeof *component);
    return MSPRING_OK;
}

// Add a particle to its component: mass, centre times mass, momentum.
static void add_particle(const mspring_network *network, mspring_id particle, mspring_component *to) {
    const mspringi_state *s = &network->state;
    const uint32_t slot = network->topology.slot_of_particle[particle];
    const double mass = (double)network->mass[particle];
    to->mass += mass;
    to->x += mass * (double)s->x[slot];
    to->y += mass * (double)s->y[slot];
    if (network->inverse_mass[slot] > 0.0f) {
        to->px += mass * (double)s->vx[slot];
        to->py += mass * (double)s->vy[slot];
    }
}

static MSPRINGI_NOINLINE void measure(const mspring_network *network, uint32_t first, uint32_t count,
                                      mspring_component *components) {
    const mspringi_components *c = &network->components;
    for (uint32_t i = 0; i < count; ++i)
        components[i] = (mspring_component){
            .struct_size = sizeof *components, .head = c->head[first + i], .particle_count = c->size[first + i]};
    for (mspring_id p = 0; p < network->topology.particle_count; ++p)
        if (c->number[p] - first < count) // unsigned: numbers below first are not
            add_particle(network, p, &components[c->number[p] - first]);
    for (uint32_t i = 0; i < count; ++i) {
        components[i].x = network->origin_x + components[i].x / components[i].mass;
        components[i].y = network->origin_y + components[i].y / components[i].mass;
    }
}

mspring_result mspring_network_get_components(const mspring_network *network, uint32_t first, uint32_t count,
                                              mspring_component *components) {
    if (!network || (count > 0 && !components) || network->components.count == 0)
        return MSPRING_ERROR_ARGUMENT;
    if (first > network->components.count || count > network->components.count - first)
        return MSPRING_ERROR_ID;
    for (uint32_t i = 0; i < count; ++i)
        if (components[i].struct_size != sizeof *components)
            return MSPRING_ERROR_STRUCT;
    const mspringi_fp_state before = mspringi_fp_enter();
    measure(network, first, count, components);
    mspringi_fp_leave(before);
    return MSPRING_OK;
}

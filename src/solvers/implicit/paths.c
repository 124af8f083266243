/// Finding of paths in a layout.
#include "solvers/implicit/paths.h"

#include "solvers/implicit/cells.h"

static mspring_result no_memory_for_paths(const mspringi_path_builder *m) {
    return mspringi_fail(m->message, MSPRING_ERROR_MEMORY, "no memory to find paths among %u particles",
                         (unsigned)m->network->topology.particle_count);
}

mspring_result mspringi_paths_begin(mspringi_path_builder *m) {
    const size_t slots = mspringi_slot_count(m->network);
    m->degree = mspringi_alloc(m->memory, slots, sizeof *m->degree);
    m->springs = mspringi_alloc(m->memory, slots, sizeof *m->springs);
    return m->degree && m->springs ? MSPRING_OK : no_memory_for_paths(m);
}

void mspringi_paths_count_springs(mspringi_path_builder *m, mspring_id first, mspring_id end) {
    const mspringi_topology *t = &m->network->topology;
    for (mspring_id spring = first; spring < end; ++spring) {
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(t, spring);
        uint32_t ends[2];
        if (!mspringi_spring_slot_is_laid_out(t, spring_slot))
            continue;
        mspringi_topology_ends(t, spring_slot, &ends[0], &ends[1]);
        for (int i = 0; i < 2; ++i) {
            uint8_t *degree = &m->degree[ends[i]];
            if (*degree < 2)
                m->springs[ends[i]][*degree] = spring_slot;
            *degree = (uint8_t)(*degree + (*degree < 3));
        }
    }
}

/* ----------------------------------------------------------------------------------------------------- walking */

/// The paths are visited twice: first to count, then to list.
typedef struct path_listing {
    mspringi_path_builder *m;
    bool lists;
    uint32_t count, node_count;
} path_listing;

/// A walk along a path: at a particle, to which a spring has led; MSPRING_NONE: it begins there.
typedef struct path_walk {
    uint32_t slot;
    mspringi_spring_slot from;
} path_walk;

static bool is_on_path(const mspringi_path_builder *m, uint32_t slot) {
    return (m->degree[slot] & 3) == 1 || (m->degree[slot] & 3) == 2;
}

static bool visit(path_listing *l, uint32_t slot) {
    const uint8_t bit = l->lists ? 8 : 4;
    const bool is_new = !(l->m->degree[slot] & bit);
    l->m->degree[slot] |= bit;
    return is_new;
}

// The spring that leads on; MSPRING_NONE: none.
static mspringi_spring_slot spring_ahead(const mspringi_path_builder *m, path_walk at) {
    const mspringi_spring_slot *springs = m->springs[at.slot];
    if (at.from != springs[0])
        return springs[0];
    return (m->degree[at.slot] & 3) == 2 ? springs[1] : MSPRING_NONE;
}

static uint32_t slot_beyond(const mspringi_path_builder *m, mspringi_spring_slot spring, uint32_t slot) {
    uint32_t a, b;
    if (spring == MSPRING_NONE)
        return MSPRING_NONE;
    mspringi_topology_ends(&m->network->topology, spring, &a, &b);
    return a == slot ? b : a;
}

// Go to the end of the path. Return the walk back from there, or from where it began, if that is on a ring.
static path_walk go_to_end(const mspringi_path_builder *m, uint32_t start) {
    path_walk at = {start, MSPRING_NONE};
    for (;;) {
        const mspringi_spring_slot spring = spring_ahead(m, at);
        const uint32_t next = slot_beyond(m, spring, at.slot);
        if (next == start || next == MSPRING_NONE || !is_on_path(m, next))
            return (path_walk){next == start ? start : at.slot, spring};
        at = (path_walk){next, spring};
    }
}

static void list_path_node(path_listing *l, uint32_t node, uint32_t slot) {
    if (l->lists) {
        l->m->paths->slots[node] = slot;
        l->m->paths->node_of_slot[slot] = node;
    }
}

static void list_path_spring(const path_listing *l, uint32_t node, mspringi_spring_slot spring) {
    if (l->lists)
        l->m->paths->factors[node + l->count] =
            spring == MSPRING_NONE ? MSPRING_NONE : mspringi_factors_of_spring_slot(spring);
}

// List a path, if it is long enough. On a ring, its lowest particle is both ends.
static void list_path(path_listing *l, uint32_t lowest) {
    const mspringi_path_builder *m = l->m;
    path_walk at = go_to_end(m, lowest);
    const uint32_t first = l->node_count, before = slot_beyond(m, at.from, at.slot);
    const bool is_ring = before != MSPRING_NONE && is_on_path(m, before);
    uint32_t node = first;
    if (is_ring)
        at = (path_walk){before, at.from};
    mspringi_path made = {.first = first, .ends = {is_ring ? lowest : before, MSPRING_NONE}};
    list_path_spring(l, node, at.from);
    for (;;) {
        (void)visit(l, at.slot);
        list_path_node(l, node++, at.slot);
        const mspringi_spring_slot spring = spring_ahead(m, at);
        const uint32_t next = slot_beyond(m, spring, at.slot);
        list_path_spring(l, node, spring);
        made.ends[1] = next;
        if (next == MSPRING_NONE || !is_on_path(m, next) || (is_ring && next == lowest))
            break;
        at = (path_walk){next, spring};
    }
    made.end = node;
    if (node - first >= MSPRINGI_LEAST_PATH) {
        if (l->lists)
            m->paths->list[l->count] = made;
        l->node_count = node;
        l->count++;
        return;
    }
    for (uint32_t i = first; l->lists && i < node; ++i)
        m->paths->node_of_slot[m->paths->slots[i]] = MSPRING_NONE;
}

static path_listing go_through(mspringi_path_builder *m, bool lists) {
    path_listing l = {.m = m, .lists = lists};
    const size_t slots = mspringi_slot_count(m->network);
    for (uint32_t slot = 0; slot < slots; ++slot)
        if (is_on_path(m, slot) && visit(&l, slot))
            list_path(&l, slot);
    return l;
}

// A path that is too short is listed behind the others before it is left out.
#define SPARE_NODES 2u

mspring_result mspringi_paths_list(mspringi_path_builder *m) {
    mspringi_paths *p = m->paths;
    const path_listing l = go_through(m, false);
    const size_t nodes = l.node_count, slots = mspringi_slot_count(m->network);
    p->count = l.count;
    p->node_count = l.node_count;
    if (l.count == 0)
        return MSPRING_OK;
    p->list = mspringi_alloc(m->memory, l.count, sizeof *p->list);
    p->segments = mspringi_alloc(m->memory, nodes / MSPRINGI_LEAST_PATH, sizeof *p->segments);
    p->node_of_slot = mspringi_alloc(m->memory, slots, sizeof *p->node_of_slot);
    p->slots = mspringi_alloc(m->memory, nodes + SPARE_NODES, sizeof *p->slots);
    p->factors = mspringi_alloc(m->memory, nodes + l.count + SPARE_NODES + 1, sizeof *p->factors);
    p->marks = mspringi_alloc(m->memory, nodes, sizeof *p->marks);
    p->held = mspringi_alloc(m->memory, nodes, sizeof *p->held);
    p->mass = mspringi_alloc(m->memory, nodes, sizeof *p->mass);
    p->ups = mspringi_alloc(m->memory, nodes, sizeof *p->ups);
    p->responses = mspringi_alloc(m->memory, nodes, sizeof *p->responses);
    if (!p->list || !p->segments || !p->node_of_slot || !p->slots || !p->factors || !p->marks || !p->held ||
        !p->mass || !p->ups || !p->responses)
        return no_memory_for_paths(m);
    for (size_t slot = 0; slot < slots; ++slot)
        p->node_of_slot[slot] = MSPRING_NONE;
    (void)go_through(m, true);
    return MSPRING_OK;
}

void mspringi_paths_end(mspringi_path_builder *m) {
    mspringi_free(m->memory, m->degree);
    mspringi_free(m->memory, m->springs);
    m->degree = NULL;
    m->springs = NULL;
}

#define ARRAY(member) MSPRINGI_ARRAY_ENTRY(mspringi_paths, member, MSPRINGI_ARRAY)
static const mspringi_array_entry path_arrays[] = {
    ARRAY(list),  ARRAY(segments), ARRAY(node_of_slot), ARRAY(slots), ARRAY(factors),
    ARRAY(marks), ARRAY(held),     ARRAY(mass),         ARRAY(ups),   ARRAY(responses),
};
const mspringi_array_table mspringi_paths_columns = MSPRINGI_ARRAY_TABLE(path_arrays);

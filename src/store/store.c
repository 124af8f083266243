/// Operations on all arrays of a network.
#include "store/store.h"

#include <string.h>

#include "base/array_table.h"
#include "base/cpu.h"
#include "layout/emit/spare.h"
#include "store/precise.h"

/// Elements of an array that its owner reserves.
#define UNKNOWN SIZE_MAX

#define STATE(member)                                                                                              \
    LANES(member.x, mspringi_state_arrays(n))                                                                      \
    VIEW(member.y, slots)                                                                                          \
    VIEW(member.vx, 2 * slots)                                                                                     \
    VIEW(member.vy, 3 * slots)                                                                                     \
    VIEW(member.low_x, 4 * slots)                                                                                  \
    VIEW(member.low_y, 5 * slots)                                                                                  \
    VIEW(member.low_vx, n->is_precise ? 6 * slots : UNKNOWN)                                                       \
    VIEW(member.low_vy, n->is_precise ? 7 * slots : UNKNOWN)
#define FLOATS(member) ARRAY(member, spring_slots)
#define BITS(member) ARRAY(member, words)
#define END(name)

#define GROUP(name) {0, 0, MSPRINGI_GROUP},
#define ARRAY(member, elements) MSPRINGI_ARRAY_ENTRY(mspring_network, member, MSPRINGI_ARRAY),
#define LANES(member, planes) MSPRINGI_ARRAY_ENTRY(mspring_network, member, MSPRINGI_PLANES),
#define VIEW(member, elements) MSPRINGI_ARRAY_ENTRY(mspring_network, member, MSPRINGI_VIEW),
static const mspringi_array_entry list[] = {
#include "store/network.def"
};
#undef GROUP
#undef ARRAY
#undef LANES
#undef VIEW

#define COLUMN_COUNT (sizeof list / sizeof list[0])

/* ---------------------------------------------------------------------------------------------------- elements */

static size_t irregular_record_slots(const mspringi_topology *t) {
    const size_t own = t->irregular.slice_count > 0 ? t->irregular.first_slice_column[t->irregular.slice_count] : 0;
    const size_t others = (size_t)(t->irregular_capacity - t->laid_out_count) + t->inactive_count;
    return (own + (others + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH) * MSPRINGI_WIDTH;
}

static size_t spare_ends(const mspringi_topology *t) {
    return (size_t)2 * mspringi_spare_springs(t);
}

static size_t graft_nodes(const mspringi_topology *t) {
    return (spare_ends(t) + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
}

// Elements of each column; of a view those before it.
static void count_elements(const mspring_network *n, size_t elements[COLUMN_COUNT]) {
    const mspringi_topology *t = &n->topology;
    const size_t slots = mspringi_slot_count(n), words = mspringi_spring_slot_words(t),
                 spring_slots = words * MSPRINGI_WIDTH;
    const size_t particles = t->reserve.particle_end, springs = t->reserve.spring_end;
#define GROUP(name) *elements++ = 0;
#define ARRAY(member, count) *elements++ = (size_t)(count);
#define LANES(member, planes) *elements++ = (size_t)(planes)*slots;
#define VIEW(member, count) *elements++ = (size_t)(count);
#include "store/network.def"
#undef GROUP
#undef ARRAY
#undef LANES
#undef VIEW
}

/* ------------------------------------------------------------------------------------------------------- groups */

// The rows of the groups first ... end - 1, with the heads of these.
static mspringi_array_table rows_of(uint32_t first, uint32_t end) {
    size_t from = 0, to = COLUMN_COUNT;
    uint32_t group = 0;
    for (size_t i = 0; i < COLUMN_COUNT; ++i) {
        if (list[i].kind != MSPRINGI_GROUP)
            continue;
        if (group == first)
            from = i;
        if (group == end)
            to = i;
        group++;
    }
    return (mspringi_array_table){list + from, to - from};
}

bool mspringi_store_reserve(mspring_network *network, mspringi_group group) {
    const mspringi_array_table rows = rows_of(group, group + 1u);
    size_t elements[COLUMN_COUNT];
    char *array = NULL;
    count_elements(network, elements);
    for (const mspringi_array_entry *c = rows.list; c < rows.list + rows.count; ++c) {
        const size_t count = elements[c - list];
        if (c->kind == MSPRINGI_GROUP || count == UNKNOWN)
            continue;
        if (c->kind == MSPRINGI_VIEW) {
            mspringi_array_entry_set(c, network, array + count * c->size);
            continue;
        }
        array = mspringi_array_entry_get(c, network);
        if (!array)
            array = mspringi_alloc(&network->memory, count, c->size);
        mspringi_array_entry_set(c, network, array);
        if (!array) {
            mspringi_store_free(network, group);
            return false;
        }
    }
    return true;
}

void mspringi_store_free(mspring_network *network, mspringi_group group) {
    mspringi_array_table_free(rows_of(group, group + 1u), network, &network->memory);
}

bool mspringi_store_duplicate(mspring_network *to, const mspring_network *from, mspringi_group group,
                              mspringi_memory *memory) {
    const mspringi_array_table rows = rows_of(group, group + 1u);
    for (const mspringi_array_entry *c = rows.list; c < rows.list + rows.count; ++c)
        if (c->kind != MSPRINGI_GROUP)
            mspringi_array_entry_set(c, to, mspringi_array_entry_get(c, from));
    return mspringi_array_table_duplicate(rows, to, memory);
}

void mspringi_store_relocate(mspring_network *network, const mspringi_memory *from, const mspringi_memory *to) {
    mspringi_array_table_relocate(rows_of(0, MSPRINGI_STORE_GROUPS), network, from, to);
}

/* ------------------------------------------------------------------------------------------------------ layouts */

void mspringi_store_free_layout(mspring_network *network, mspringi_memory *memory) {
    mspringi_array_table_free(rows_of(0, MSPRINGI_LAYOUT_END), network, memory);
}

// Where it is inlined, gcc 12 takes the network for its first field, and warns of writing beyond it (with all of
// the library in one file, at -O2).
static MSPRINGI_NOINLINE void forget(mspring_network *network, mspringi_array_table rows) {
    for (const mspringi_array_entry *c = rows.list; c < rows.list + rows.count; ++c)
        if (c->kind != MSPRINGI_GROUP)
            mspringi_array_entry_set(c, network, NULL);
}

void mspringi_store_forget_layout(mspring_network *network) {
    forget(network, rows_of(0, MSPRINGI_LAYOUT_END));
}

void mspringi_store_forget(mspring_network *network) {
    forget(network, rows_of(0, MSPRINGI_STORE_GROUPS));
}

void mspringi_store_take_layout(mspring_network *to, const mspring_network *from) {
    const mspringi_array_table rows = rows_of(0, MSPRINGI_LAYOUT_END);
    for (const mspringi_array_entry *c = rows.list; c < rows.list + rows.count; ++c)
        if (c->kind != MSPRINGI_GROUP)
            mspringi_array_entry_set(c, to, mspringi_array_entry_get(c, from));
}

bool mspringi_store_match_layout(mspring_network *to, const mspring_network *from) {
    for (uint32_t group = 0; group < MSPRINGI_REMADE_END; ++group) {
        const mspringi_array_entry *first = rows_of(group, group + 1u).list + 1;
        const bool has = mspringi_array_entry_get(first, to), needs = mspringi_array_entry_get(first, from);
        if (has && !needs)
            mspringi_store_free(to, (mspringi_group)group);
        if (needs && !has && !mspringi_store_reserve(to, (mspringi_group)group))
            return false;
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------------- moving */

/// Planes that are moved in one go, so that slots are looked up once for all of them.
#define MOST_PLANES 4

static void move_planes(const float *const old[MOST_PLANES], float *const made[MOST_PLANES],
                        const mspringi_topology *from, const mspringi_topology *to) {
    const uint32_t *here = from->slot_of_particle, *there = to->slot_of_particle;
    const float *const a = old[0], *const b = old[1], *const c = old[2], *const d = old[3];
    float *const made_a = made[0], *const made_b = made[1], *const made_c = made[2], *const made_d = made[3];
    for (mspring_id p = 0; p < from->particle_count; ++p) {
        const uint32_t before = here[p], now = there[p];
        made_a[now] = a[before];
        made_b[now] = b[before];
        made_c[now] = c[before];
        made_d[now] = d[before];
    }
}

void mspringi_store_move_slots(mspring_network *to, const mspring_network *from) {
    const size_t slots = mspringi_slot_count(from), made_slots = mspringi_slot_count(to);
    const float *old[MOST_PLANES];
    float *made[MOST_PLANES];
    size_t elements[COLUMN_COUNT], count = 0;
    MSPRINGI_ASSERT(to->topology.particle_count == from->topology.particle_count);
    count_elements(from, elements);
    for (size_t i = 0; i < COLUMN_COUNT; ++i) {
        const float *first = list[i].kind == MSPRINGI_PLANES ? mspringi_array_entry_get(&list[i], from) : NULL;
        float *first_made = first ? mspringi_array_entry_get(&list[i], to) : NULL;
        for (size_t plane = 0; first_made && plane < elements[i] / slots; ++plane) {
            old[count] = first + plane * slots;
            made[count++] = first_made + plane * made_slots;
            if (count < MOST_PLANES)
                continue;
            move_planes(old, made, &from->topology, &to->topology);
            count = 0;
        }
    }
    if (count == 0)
        return;
    for (size_t i = count; i < MOST_PLANES; ++i) { // the last one again
        old[i] = old[count - 1];
        made[i] = made[count - 1];
    }
    move_planes(old, made, &from->topology, &to->topology);
}

static void copy_value(float *to, mspringi_spring_slot spring_slot, const float *from,
                       mspringi_spring_slot before) {
    if (to && from)
        to[spring_slot] = from[before];
}

static void copy_bit(uint16_t *to, mspringi_spring_slot spring_slot, const uint16_t *from,
                     mspringi_spring_slot before) {
    const uint16_t bit = (uint16_t)(1u << spring_slot % MSPRINGI_WIDTH);
    if (!to || !from)
        return;
    to += spring_slot / MSPRINGI_WIDTH;
    *to = (uint16_t)(from[before / MSPRINGI_WIDTH] >> before % MSPRINGI_WIDTH & 1 ? *to | bit : *to & ~bit);
}

#undef FLOATS
#undef BITS
#define GROUP(name)
#define ARRAY(member, elements)
#define LANES(member, planes)
#define VIEW(member, elements)
#define FLOATS(member) copy_value(to->member, spring_slot, from->member, before);
#define BITS(member) copy_bit(to->member, spring_slot, from->member, before);
void mspringi_store_copy_spring(mspring_network *to, mspringi_spring_slot spring_slot, const mspring_network *from,
                                mspringi_spring_slot before) {
#include "store/network.def"
}

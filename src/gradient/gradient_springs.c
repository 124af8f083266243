/// Octets of springs: in a lattice, all springs of one direction join slots of one distance.
#include "gradient/gradient.h"
#include "layout/analysis.h"

/// Slots of a tile. Springs are visited tile by tile, and in a tile direction by direction.
#define MSPRINGI_OCTET_TILE 512u

/// Ends and parameters of all springs.
typedef struct octet_springs {
    uint32_t *a, *b, *flags;
    float *stiffness, *damping, *length;
} octet_springs;

static bool octet_springs_read(mspring_gradient *g, octet_springs *s) {
    const uint32_t count = g->spring_count;
    mspringi_memory *m = &g->memory;
    s->a = mspringi_alloc(m, count, sizeof *s->a);
    s->b = mspringi_alloc(m, count, sizeof *s->b);
    s->flags = mspringi_alloc(m, count, sizeof *s->flags);
    s->stiffness = mspringi_alloc(m, count, sizeof *s->stiffness);
    s->damping = mspringi_alloc(m, count, sizeof *s->damping);
    s->length = mspringi_alloc(m, count, sizeof *s->length);
    if (!s->a || !s->b || !s->flags || !s->stiffness || !s->damping || !s->length)
        return false;
    const mspring_network *n = g->network;
    if (count == 0)
        return true;
    const mspring_column ends[] = {{MSPRING_SLOT_A, 1, s->a}, {MSPRING_SLOT_B, 1, s->b}};
    return mspring_network_get_columns(n, NULL, 0, count, ends, 2) == MSPRING_OK &&
           mspring_network_get_integers(n, MSPRING_SPRING_FLAGS, NULL, 0, count, s->flags, 1) == MSPRING_OK &&
           mspring_network_get(n, MSPRING_ACTIVE_STIFFNESS, NULL, 0, count, s->stiffness, 1) == MSPRING_OK &&
           mspring_network_get(n, MSPRING_ACTIVE_DAMPING, NULL, 0, count, s->damping, 1) == MSPRING_OK &&
           mspring_network_get(n, MSPRING_ACTIVE_REST_LENGTH, NULL, 0, count, s->length, 1) == MSPRING_OK;
}

static void octet_springs_free(mspringi_memory *memory, octet_springs *s) {
    mspringi_free(memory, s->a);
    mspringi_free(memory, s->b);
    mspringi_free(memory, s->flags);
    mspringi_free(memory, s->stiffness);
    mspringi_free(memory, s->damping);
    mspringi_free(memory, s->length);
}

static uint32_t octet_low(const octet_springs *s, uint32_t spring) {
    return s->a[spring] < s->b[spring] ? s->a[spring] : s->b[spring];
}

static uint32_t octet_distance(const octet_springs *s, uint32_t spring) {
    return s->a[spring] < s->b[spring] ? s->b[spring] - s->a[spring] : s->a[spring] - s->b[spring];
}

// Sort key of a spring: tile, distance of its slots, lower slot in the tile. A slot has 27 bits, 9 of them in a
// tile.
static uint64_t octet_key(const octet_springs *s, uint32_t spring) {
    const uint64_t low = octet_low(s, spring), distance = octet_distance(s, spring);
    return low / MSPRINGI_OCTET_TILE << 36 | distance << 9 | low % MSPRINGI_OCTET_TILE;
}

// Assign octets to sorted keys, and return their number. Keys are unique: no two springs join the same slots.
static uint32_t octets_assign(mspringi_octets *o, const uint64_t *keys, size_t count, bool writes) {
    uint32_t octets = 0, begin = 0;
    uint64_t way = UINT64_MAX;
    for (size_t i = 0; i < count; ++i) {
        const uint32_t low = (uint32_t)(keys[i] >> 36 << 9 | (keys[i] & (MSPRINGI_OCTET_TILE - 1)));
        if (keys[i] >> 9 != way || low - begin >= MSPRINGI_OCTET) {
            way = keys[i] >> 9;
            begin = low;
            if (writes) {
                o->a[octets] = low;
                o->b[octets] = low + (uint32_t)(way & ((1u << 27) - 1));
            }
            ++octets;
        }
    }
    return octets;
}

static bool octets_reserve(mspring_gradient *g, uint32_t count, bool is_damped) {
    mspringi_octets *o = &g->octets;
    mspringi_memory *m = &g->memory;
    const size_t lanes = (size_t)count * MSPRINGI_OCTET;
    o->count = count;
    o->a = mspringi_alloc(m, count, sizeof *o->a);
    o->b = mspringi_alloc(m, count, sizeof *o->b);
    o->stiffness = mspringi_alloc(m, lanes, sizeof(double));
    o->length = mspringi_alloc(m, lanes, sizeof(double));
    o->by_stiffness = mspringi_alloc(m, lanes, sizeof(double));
    o->by_length = mspringi_alloc(m, lanes, sizeof(double));
    o->place = mspringi_alloc(m, g->spring_count, sizeof *o->place);
    if (is_damped) {
        o->damping = mspringi_alloc(m, lanes, sizeof(double));
        o->by_damping = mspringi_alloc(m, lanes, sizeof(double));
    }
    return o->a && o->b && o->stiffness && o->length && o->by_stiffness && o->by_length && o->place &&
           (!is_damped || (o->damping && o->by_damping));
}

// Find the place of a spring in the octets, which are in the order of keys.
static uint32_t octets_find(const mspringi_octets *o, uint64_t key, uint32_t low) {
    uint32_t least = 0, most = o->count;
    while (most - least > 1) {
        const uint32_t middle = least + (most - least) / 2;
        const uint64_t at = (uint64_t)(o->a[middle] / MSPRINGI_OCTET_TILE) << 36 |
                            (uint64_t)(o->b[middle] - o->a[middle]) << 9 | o->a[middle] % MSPRINGI_OCTET_TILE;
        if (at <= key)
            least = middle;
        else
            most = middle;
    }
    return least * MSPRINGI_OCTET + (low - o->a[least]);
}

static void octets_fill(mspring_gradient *g, const octet_springs *s) {
    mspringi_octets *o = &g->octets;
    for (uint32_t i = 0; i < g->spring_count; ++i) {
        o->place[i] = MSPRING_NONE;
        if (s->flags[i] & MSPRING_SPRING_BROKEN)
            continue;
        const uint32_t place = octets_find(o, octet_key(s, i), octet_low(s, i));
        o->place[i] = place;
        o->stiffness[place] = (double)s->stiffness[i];
        o->length[place] = (double)s->length[i];
        if (o->damping)
            o->damping[place] = (double)s->damping[i];
    }
}

static bool octets_make(mspring_gradient *g, const octet_springs *s, uint64_t *keys, uint64_t *scratch) {
    size_t count = 0;
    bool is_damped = false;
    for (uint32_t i = 0; i < g->spring_count; ++i)
        if (!(s->flags[i] & MSPRING_SPRING_BROKEN)) {
            keys[count++] = octet_key(s, i);
            is_damped = is_damped || s->damping[i] > 0.0f;
        }
    if (count > 0)
        mspringi_sort_keys(keys, scratch, count);
    if (!octets_reserve(g, octets_assign(NULL, keys, count, false), is_damped))
        return false;
    (void)octets_assign(&g->octets, keys, count, true);
    octets_fill(g, s);
    return true;
}

bool mspringi_octets_make(mspring_gradient *g) {
    octet_springs springs = {0};
    uint64_t *keys = mspringi_alloc(&g->memory, g->spring_count, sizeof *keys);
    uint64_t *scratch = mspringi_alloc(&g->memory, g->spring_count, sizeof *scratch);
    const bool is_made =
        keys && scratch && octet_springs_read(g, &springs) && octets_make(g, &springs, keys, scratch);
    octet_springs_free(&g->memory, &springs);
    mspringi_free(&g->memory, keys);
    mspringi_free(&g->memory, scratch);
    return is_made;
}

/// Cutting a network into tiles.
#include "tiles.h"

#include "base/mix.h"
#include "network/springs.h"
#include "tile_order.h"

/// Grids of at most this many rows are cut across only.
#define SLENDER_ROWS 10

/// A cell, or MSPRING_NONE for slots that are in none.
typedef struct tiling {
    const mspring_network *network;
    mspringi_memory *memory;
    uint32_t *cell_of_slot;
    uint32_t *parent; ///< of a slot in the forest of components
    uint32_t cell_count;
} tiling;

bool mspringi_is_live(const mspring_network *network, mspring_id spring) {
    return mspringi_spring_is_live(network, spring) &&
           mspringi_spring_get_nominal(network, spring).stiffness > 0.0f;
}

uint32_t mspringi_factors_of_place(mspringi_place place) {
    return place / MSPRINGI_WIDTH * (MSPRINGI_FACTORS * MSPRINGI_WIDTH) + place % MSPRINGI_WIDTH;
}

/* ------------------------------------------------------------------------------------------------------ cells */

static bool has_place_in_tile(const mspring_network *network, uint32_t slot) {
    return network->inverse_mass[slot] > 0.0f;
}

// Whether a row is the first of its grid: no block of the row before has a block above it.
static bool starts_grid(const mspringi_topology *t, uint32_t row) {
    if (row == 0)
        return true;
    const mspringi_row *before = &t->rows[row - 1];
    for (uint32_t s = before->first_span; s < before->first_span + before->span_count; ++s)
        if (t->spans[s].up != 0)
            return false;
    return true;
}

// Give the slots of some rows of a grid, which follow each other, cells of width columns; numbers from first on.
static uint32_t cut_rows(tiling *g, uint32_t first_row, uint32_t row_count, uint32_t width, uint32_t first) {
    const mspringi_topology *t = &g->network->topology;
    uint32_t end = first;
    for (uint32_t r = first_row; r < first_row + row_count; ++r) {
        const mspringi_row *row = &t->rows[r];
        for (uint32_t s = row->first_span; s < row->first_span + row->span_count; ++s) {
            const mspringi_span *span = &t->spans[s];
            for (uint32_t slot = span->first_slot; slot < span->end_slot; ++slot) {
                const uint32_t column = (uint32_t)((int64_t)slot + span->carry);
                const uint32_t cell = first + column / width;
                if (has_place_in_tile(g->network, slot))
                    g->cell_of_slot[slot] = cell;
                end = cell + 1 > end ? cell + 1 : end;
            }
        }
    }
    return end;
}

static void cut_grids(tiling *g, uint32_t size) {
    const mspringi_topology *t = &g->network->topology;
    for (uint32_t row = 0; row < t->lattice_rows;) {
        uint32_t end = row + 1;
        while (end < t->lattice_rows && !starts_grid(t, end))
            ++end;
        const uint32_t rows = end - row;
        const bool slender = rows <= SLENDER_ROWS && size <= SLENDER_ROWS;
        const uint32_t height = slender ? rows : size;
        for (; row < end; row += height)
            g->cell_count = cut_rows(g, row, height < end - row ? height : end - row, size, g->cell_count);
        row = end;
    }
}

// Cut the chains' slots into pieces of size.
static void cut_chains(tiling *g, uint32_t size) {
    const mspringi_topology *t = &g->network->topology;
    const uint32_t first = t->chain_first * MSPRINGI_WIDTH, count = t->chain_blocks * MSPRINGI_WIDTH;
    for (uint32_t i = 0; i < count; ++i)
        if (has_place_in_tile(g->network, first + i))
            g->cell_of_slot[first + i] = g->cell_count + i / size;
    g->cell_count += (count + size - 1) / size;
}

/// Springs by slot, for the slots of the web.
typedef struct incidence {
    uint32_t *first;     ///< [slots + 1]
    uint32_t *neighbour; ///< slots
} incidence;

static bool list_neighbours(incidence *in, const tiling *g) {
    const mspringi_topology *t = &g->network->topology;
    const size_t slots = mspringi_slot_count(g->network);
    in->first = mspringi_alloc(g->memory, slots + 2, sizeof *in->first);
    in->neighbour = mspringi_alloc(g->memory, (size_t)2 * t->leftover_count, sizeof *in->neighbour);
    if (!in->first || !in->neighbour)
        return false;
    for (uint32_t i = 0; i < t->leftover_count; ++i) {
        in->first[t->leftover_a[i] + 2]++;
        in->first[t->leftover_b[i] + 2]++;
    }
    for (size_t slot = 2; slot < slots + 2; ++slot)
        in->first[slot] += in->first[slot - 1];
    for (uint32_t i = 0; i < t->leftover_count; ++i) {
        in->neighbour[in->first[t->leftover_a[i] + 1]++] = t->leftover_b[i];
        in->neighbour[in->first[t->leftover_b[i] + 1]++] = t->leftover_a[i];
    }
    return true;
}

// Grow neighbourhoods of at most size * size / 2 particles, breadth first, from the first slot that is in none.
static bool cut_web(tiling *g, uint32_t size) {
    const mspringi_topology *t = &g->network->topology;
    const uint32_t first = t->web_first * MSPRINGI_WIDTH, end = first + t->web_blocks * MSPRINGI_WIDTH;
    const uint32_t most = size * size / 2;
    if (first == end)
        return true;
    incidence in = {NULL, NULL};
    uint32_t *queue = mspringi_alloc(g->memory, most, sizeof *queue);
    const bool ok = list_neighbours(&in, g) && queue;
    for (uint32_t seed = first; ok && seed < end; ++seed) {
        if (!has_place_in_tile(g->network, seed) || g->cell_of_slot[seed] != MSPRING_NONE)
            continue;
        uint32_t count = 0;
        queue[count++] = seed;
        g->cell_of_slot[seed] = g->cell_count;
        for (uint32_t i = 0; i < count; ++i) {
            for (uint32_t n = in.first[queue[i]]; n < in.first[queue[i] + 1] && count < most; ++n) {
                const uint32_t slot = in.neighbour[n];
                if (slot < first || slot >= end || !has_place_in_tile(g->network, slot) ||
                    g->cell_of_slot[slot] != MSPRING_NONE)
                    continue;
                g->cell_of_slot[slot] = g->cell_count;
                queue[count++] = slot;
            }
        }
        g->cell_count++;
    }
    mspringi_free(g->memory, in.first);
    mspringi_free(g->memory, in.neighbour);
    mspringi_free(g->memory, queue);
    return ok;
}

/* ------------------------------------------------------------------------------------------------- components */

static uint32_t root_of(uint32_t *parent, uint32_t slot) {
    while (parent[slot] != slot) {
        parent[slot] = parent[parent[slot]];
        slot = parent[slot];
    }
    return slot;
}

// Join the slots of each cell that live springs connect. The root of a component is its lowest slot.
static void find_components(tiling *g) {
    const mspringi_topology *t = &g->network->topology;
    const uint32_t slots = (uint32_t)mspringi_slot_count(g->network);
    for (uint32_t slot = 0; slot < slots; ++slot)
        g->parent[slot] = slot;
    for (mspring_id s = 0; s < t->spring_count; ++s) {
        uint32_t a, b;
        mspringi_topology_ends(t, t->place_of_spring[s], &a, &b);
        if (g->cell_of_slot[a] != g->cell_of_slot[b] || g->cell_of_slot[a] == MSPRING_NONE ||
            !mspringi_is_live(g->network, s))
            continue;
        a = root_of(g->parent, a);
        b = root_of(g->parent, b);
        if (a < b)
            g->parent[b] = a;
        else
            g->parent[a] = b;
    }
}

// Number the components in the order of their lowest slots.
static void number_components(mspringi_tiles *tiles, tiling *g) {
    const uint32_t slots = (uint32_t)mspringi_slot_count(g->network);
    tiles->count = 0;
    for (uint32_t slot = 0; slot < slots; ++slot) {
        tiles->tile_of_slot[slot] = MSPRING_NONE;
        if (g->cell_of_slot[slot] == MSPRING_NONE)
            continue;
        const uint32_t root = root_of(g->parent, slot);
        tiles->tile_of_slot[slot] = root == slot ? tiles->count++ : tiles->tile_of_slot[root];
    }
}

/* ------------------------------------------------------------------------------------------------------ joints */

// The joint of a spring between two tiles, or between one and a pinned particle; false: it is none.
static bool find_joint(const mspringi_tiles *tiles, const mspring_network *network, mspring_id spring,
                       mspringi_joint *joint) {
    const mspringi_topology *t = &network->topology;
    uint32_t a, b;
    mspringi_topology_ends(t, t->place_of_spring[spring], &a, &b);
    const uint32_t tile_a = tiles->tile_of_slot[a], tile_b = tiles->tile_of_slot[b];
    if (tile_a == tile_b || !mspringi_is_live(network, spring))
        return false;
    const bool a_first = tile_b == MSPRING_NONE || (tile_a != MSPRING_NONE && tile_a > tile_b);
    *joint = (mspringi_joint){.tile = a_first ? tile_a : tile_b,
                              .other = a_first ? tile_b : tile_a,
                              .slot = a_first ? a : b,
                              .other_slot = a_first ? b : a,
                              .factors = mspringi_factors_of_place(t->place_of_spring[spring])};
    return true;
}

// List the joints, sorted by tile and then by the other one.
static bool list_joints(mspringi_tiles *tiles, const mspring_network *network, mspringi_memory *memory) {
    const uint32_t springs = network->topology.spring_count;
    mspringi_joint joint;
    tiles->joint_count = 0;
    for (mspring_id s = 0; s < springs; ++s)
        tiles->joint_count += find_joint(tiles, network, s, &joint);
    tiles->joints = mspringi_alloc(memory, tiles->joint_count, sizeof *tiles->joints);
    mspringi_joint *sorted = mspringi_alloc(memory, tiles->joint_count, sizeof *sorted);
    uint32_t *first = mspringi_alloc(memory, (size_t)tiles->count + 2, sizeof *first);
    const bool ok = tiles->joints && sorted && first;
    if (ok) {
        uint32_t count = 0;
        for (mspring_id s = 0; s < springs; ++s)
            if (find_joint(tiles, network, s, &joint))
                tiles->joints[count++] = joint;
        // Two passes of a stable counting sort: by other (MSPRING_NONE last), then by tile.
        for (int pass = 0; pass < 2; ++pass) {
            const mspringi_joint *from = pass == 0 ? tiles->joints : sorted;
            mspringi_joint *to = pass == 0 ? sorted : tiles->joints;
            for (uint32_t i = 0; i < tiles->count + 2; ++i)
                first[i] = 0;
            for (int place = 0; place < 2; ++place) {
                for (uint32_t j = 0; j < count; ++j) {
                    const uint32_t other = from[j].other == MSPRING_NONE ? tiles->count : from[j].other;
                    const uint32_t key = pass == 0 ? other : from[j].tile;
                    if (place == 0)
                        first[key + 1]++;
                    else
                        to[first[key]++] = from[j];
                }
                for (uint32_t i = 1; place == 0 && i < tiles->count + 2; ++i)
                    first[i] += first[i - 1];
            }
        }
    }
    mspringi_free(memory, sorted);
    mspringi_free(memory, first);
    return ok;
}

/* ------------------------------------------------------------------------------------------------------- parts */

// List the particles of each tile, some slots at a time.
static bool list_parts(mspringi_tiles *tiles, const mspring_network *network, mspringi_memory *memory) {
    const uint32_t slots = (uint32_t)mspringi_slot_count(network);
    tiles->first_part = mspringi_alloc(memory, (size_t)tiles->count + 2, sizeof *tiles->first_part);
    if (!tiles->first_part)
        return false;
    uint32_t *first = tiles->first_part;
    for (int pass = 0; pass < 2; ++pass) { // first count, then fill
        for (uint32_t begin = 0; begin < slots; begin += MSPRINGI_PART) {
            for (uint32_t lane = 0; lane < MSPRINGI_PART; ++lane) {
                const uint32_t tile = tiles->tile_of_slot[begin + lane];
                uint32_t lanes = 0;
                for (uint32_t i = 0; i < MSPRINGI_PART; ++i)
                    lanes |= (uint32_t)(tiles->tile_of_slot[begin + i] == tile) << i;
                if (tile == MSPRING_NONE || lanes & ((1u << lane) - 1u))
                    continue; // none, or listed at an earlier lane
                if (pass == 0)
                    first[tile + 2]++;
                else
                    tiles->parts[first[tile + 1]++] = (mspringi_tile_part){begin, lanes};
            }
        }
        if (pass == 0) {
            for (uint32_t i = 2; i < tiles->count + 2; ++i)
                first[i] += first[i - 1];
            tiles->parts = mspringi_alloc(memory, first[tiles->count + 1], sizeof *tiles->parts);
            if (!tiles->parts)
                return false;
        }
    }
    return true;
}

/* --------------------------------------------------------------------------------------------------- the whole */

// Half the square of the mean rest length: what a body about as large as a spring would have.
static float choose_turn_inertia(const mspring_network *network) {
    double sum = 0.0;
    const uint32_t count = network->topology.spring_count;
    for (mspring_id s = 0; s < count; ++s)
        sum += (double)mspringi_spring_get(network, s).rest_length;
    const double mean = count > 0 ? sum / (double)count : 1.0;
    return (float)(0.02 * mean * mean);
}

static mspring_result cut(mspringi_tiles *tiles, tiling *g, uint32_t size) {
    const size_t slots = mspringi_slot_count(g->network);
    g->cell_of_slot = mspringi_alloc(g->memory, slots, sizeof *g->cell_of_slot);
    g->parent = mspringi_alloc(g->memory, slots, sizeof *g->parent);
    tiles->tile_of_slot = mspringi_alloc(g->memory, slots, sizeof *tiles->tile_of_slot);
    if (!g->cell_of_slot || !g->parent || !tiles->tile_of_slot)
        return MSPRING_ERROR_MEMORY;
    for (size_t slot = 0; slot < slots; ++slot)
        g->cell_of_slot[slot] = MSPRING_NONE;
    cut_grids(g, size);
    cut_chains(g, size);
    if (!cut_web(g, size))
        return MSPRING_ERROR_MEMORY;
    find_components(g);
    number_components(tiles, g);
    tiles->turn_inertia = choose_turn_inertia(g->network);
    if (!mspringi_tiles_order(tiles, g->network, g->memory) || !list_parts(tiles, g->network, g->memory) ||
        !list_joints(tiles, g->network, g->memory))
        return MSPRING_ERROR_MEMORY;
    return MSPRING_OK;
}

static void take_print(mspringi_tiles *tiles, size_t slots) {
    tiles->print = mspringi_mix_floats(MSPRINGI_MIX_START, tiles->turn_inertia, 0.0f);
    for (size_t slot = 0; slot < slots; ++slot)
        tiles->print = mspringi_mix(tiles->print, tiles->tile_of_slot[slot]);
}

mspring_result mspringi_tiles_create(mspringi_tiles *tiles, const mspring_network *network, uint32_t size,
                                     mspringi_memory *memory, mspringi_message *message) {
    *tiles = (mspringi_tiles){.size = size};
    tiling g = {.network = network, .memory = memory};
    mspring_result result = cut(tiles, &g, size);
    mspringi_free(memory, g.cell_of_slot);
    mspringi_free(memory, g.parent);
    if (result == MSPRING_OK) {
        take_print(tiles, mspringi_slot_count(network));
        return result;
    }
    mspringi_tiles_destroy(tiles, memory);
    return mspringi_fail(message, result, "no memory to cut %u particles into tiles",
                         (unsigned)network->topology.particle_count);
}

void mspringi_tiles_destroy(mspringi_tiles *tiles, mspringi_memory *memory) {
    mspringi_free(memory, tiles->first_part);
    mspringi_free(memory, tiles->parts);
    mspringi_free(memory, tiles->tile_of_slot);
    mspringi_free(memory, tiles->joints);
    *tiles = (mspringi_tiles){0};
}

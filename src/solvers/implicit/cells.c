/// Cutting a network into cells.
#include "solvers/implicit/cells.h"

#include "kernels/system.h"
#include "layout/emit/spare.h"

/// Grids of at most this many rows are cut across only.
#define SLENDER_ROWS 10

/// What is needed while a network is cut.
typedef struct cutting {
    const mspring_network *network;
    mspringi_memory *memory;
    mspringi_cells *cells;
    bool *is_for_none; ///< [slots] no particle is there, nor was one that has been removed
} cutting;

uint32_t mspringi_factors_of_place(mspringi_place place) {
    return place / MSPRINGI_WIDTH * (MSPRINGI_FACTORS * MSPRINGI_WIDTH) + place % MSPRINGI_WIDTH;
}

/* ------------------------------------------------------------------------------------------------------ cutting */

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
static uint32_t cut_rows(cutting *g, uint32_t first_row, uint32_t row_count, uint32_t width, uint32_t first) {
    const mspringi_topology *t = &g->network->topology;
    uint32_t end = first;
    for (uint32_t r = first_row; r < first_row + row_count; ++r) {
        const mspringi_row *row = &t->rows[r];
        for (uint32_t s = row->first_span; s < row->first_span + row->span_count; ++s) {
            const mspringi_span *span = &t->spans[s];
            for (uint32_t slot = span->first_slot; slot < span->end_slot; ++slot) {
                const uint32_t column = (uint32_t)((int64_t)slot + span->carry);
                const uint32_t cell = first + column / width;
                if (!g->is_for_none[slot])
                    g->cells->of_slot[slot] = cell;
                end = cell + 1 > end ? cell + 1 : end;
            }
        }
    }
    return end;
}

static void cut_grids(cutting *g, uint32_t size) {
    const mspringi_topology *t = &g->network->topology;
    for (uint32_t row = 0; row < t->lattice_rows;) {
        uint32_t end = row + 1;
        while (end < t->lattice_rows && !starts_grid(t, end))
            ++end;
        const uint32_t rows = end - row;
        const bool slender = rows <= SLENDER_ROWS && size <= SLENDER_ROWS;
        const uint32_t height = slender ? rows : size;
        for (; row < end; row += height)
            g->cells->count = cut_rows(g, row, height < end - row ? height : end - row, size, g->cells->count);
        row = end;
    }
}

// Cut the chains' slots into pieces of size.
static void cut_chains(cutting *g, uint32_t size) {
    const mspringi_topology *t = &g->network->topology;
    const uint32_t first = t->chain_first * MSPRINGI_WIDTH, count = t->chain_blocks * MSPRINGI_WIDTH;
    for (uint32_t i = 0; i < count; ++i)
        if (!g->is_for_none[first + i])
            g->cells->of_slot[first + i] = g->cells->count + i / size;
    g->cells->count += (count + size - 1) / size;
}

/// Springs by slot, for the slots of the web.
typedef struct incidence {
    uint32_t *first;     ///< [slots + 1]
    uint32_t *neighbour; ///< slots
} incidence;

static bool list_neighbours(incidence *in, const cutting *g) {
    const mspringi_topology *t = &g->network->topology;
    const size_t slots = mspringi_slot_count(g->network);
    in->first = mspringi_alloc(g->memory, slots + 2, sizeof *in->first);
    in->neighbour = mspringi_alloc(g->memory, (size_t)2 * t->woven_count, sizeof *in->neighbour);
    if (!in->first || !in->neighbour)
        return false;
    for (uint32_t i = 0; i < t->woven_count; ++i) {
        in->first[t->leftover_a[i] + 2]++;
        in->first[t->leftover_b[i] + 2]++;
    }
    for (size_t slot = 2; slot < slots + 2; ++slot)
        in->first[slot] += in->first[slot - 1];
    for (uint32_t i = 0; i < t->woven_count; ++i) {
        in->neighbour[in->first[t->leftover_a[i] + 1]++] = t->leftover_b[i];
        in->neighbour[in->first[t->leftover_b[i] + 1]++] = t->leftover_a[i];
    }
    return true;
}

// Grow neighbourhoods of at most size * size / 2 particles, breadth first, from the first slot that is in none.
// Where springs lead anywhere, the last of them are crumbs, each with springs to many others, and their coarse
// matrix is full: of the largest size they are swept up into cells as large as the others.
static bool cut_web(cutting *g, uint32_t size) {
    const mspringi_topology *t = &g->network->topology;
    const uint32_t first = t->web_first * MSPRINGI_WIDTH, end = first + t->web_blocks * MSPRINGI_WIDTH;
    const uint32_t most = size * size / 2;
    if (first == end)
        return true;
    const bool sweeps_up = size == MSPRINGI_LARGEST_TILE_SIZE;
    incidence in = {NULL, NULL};
    uint32_t count = 0; // in the cell that grows
    uint32_t *queue = mspringi_alloc(g->memory, most, sizeof *queue);
    const bool ok = list_neighbours(&in, g) && queue;
    for (uint32_t seed = first; ok && seed < end; ++seed) {
        if (g->is_for_none[seed] || g->cells->of_slot[seed] != MSPRING_NONE)
            continue;
        if (count == most || !sweeps_up) {
            g->cells->count += count > 0;
            count = 0;
        }
        uint32_t i = count;
        queue[count++] = seed;
        g->cells->of_slot[seed] = g->cells->count;
        for (; i < count; ++i) {
            for (uint32_t n = in.first[queue[i]]; n < in.first[queue[i] + 1] && count < most; ++n) {
                const uint32_t slot = in.neighbour[n];
                if (slot < first || slot >= end || g->is_for_none[slot] || g->cells->of_slot[slot] != MSPRING_NONE)
                    continue;
                g->cells->of_slot[slot] = g->cells->count;
                queue[count++] = slot;
            }
        }
    }
    g->cells->count += count > 0;
    mspringi_free(g->memory, in.first);
    mspringi_free(g->memory, in.neighbour);
    mspringi_free(g->memory, queue);
    return ok;
}

// Where springs may be added, each block of loose and spare particles is a cell, whose particles are in tiles while
// springs pull at them.
static void cut_loose(cutting *g) {
    const mspringi_topology *t = &g->network->topology;
    if (mspringi_spare_springs(t) == 0)
        return;
    for (uint32_t block = t->loose_first; block < t->spare_first + t->spare_blocks; ++block) {
        for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
            g->cells->of_slot[block * MSPRINGI_WIDTH + lane] = g->cells->count;
        g->cells->count++;
    }
}

/* -------------------------------------------------------------------------------------------------------- lists */

// Drop the numbers of cells that have no particle.
static bool drop_empty_cells(cutting *g) {
    mspringi_cells *cells = g->cells;
    const size_t slots = mspringi_slot_count(g->network);
    uint32_t *number = mspringi_alloc(g->memory, cells->count, sizeof *number); // 0: none yet
    uint32_t count = 0;
    if (!number)
        return false;
    for (size_t slot = 0; slot < slots; ++slot) {
        const uint32_t cell = cells->of_slot[slot];
        if (cell == MSPRING_NONE)
            continue;
        if (number[cell] == 0)
            number[cell] = ++count;
        cells->of_slot[slot] = number[cell] - 1;
    }
    cells->count = count;
    mspringi_free(g->memory, number);
    return true;
}

static bool list_slots(cutting *g) {
    mspringi_cells *cells = g->cells;
    const uint32_t slots = (uint32_t)mspringi_slot_count(g->network);
    cells->first_slot = mspringi_alloc(g->memory, (size_t)cells->count + 2, sizeof *cells->first_slot);
    if (!cells->first_slot)
        return false;
    for (uint32_t slot = 0; slot < slots; ++slot)
        if (cells->of_slot[slot] != MSPRING_NONE)
            cells->first_slot[cells->of_slot[slot] + 2]++;
    for (uint32_t i = 2; i < cells->count + 2; ++i)
        cells->first_slot[i] += cells->first_slot[i - 1];
    cells->slots = mspringi_alloc(g->memory, cells->first_slot[cells->count + 1], sizeof *cells->slots);
    if (!cells->slots)
        return false;
    for (uint32_t slot = 0; slot < slots; ++slot)
        if (cells->of_slot[slot] != MSPRING_NONE)
            cells->slots[cells->first_slot[cells->of_slot[slot] + 1]++] = slot;
    return true;
}

// List the springs inside cells, and count those between them.
static bool list_inner(cutting *g) {
    mspringi_cells *cells = g->cells;
    const mspringi_topology *t = &g->network->topology;
    uint32_t a, b;
    cells->first_inner = mspringi_alloc(g->memory, (size_t)cells->count + 2, sizeof *cells->first_inner);
    if (!cells->first_inner)
        return false;
    for (int pass = 0; pass < 2; ++pass) { // first count, then fill
        for (mspring_id s = 0; s < t->spring_count; ++s) {
            const mspringi_place place = t->place_of_spring[s];
            if (!mspringi_place_is_woven(t, place))
                continue;
            mspringi_topology_ends(t, place, &a, &b);
            const uint32_t cell = cells->of_slot[a];
            if (cell != cells->of_slot[b])
                cells->joint_count += pass == 0;
            else if (pass == 0)
                cells->first_inner[cell + 2]++;
            else
                cells->inner[cells->first_inner[cell + 1]++] = s;
        }
        if (pass == 0) {
            for (uint32_t i = 2; i < cells->count + 2; ++i)
                cells->first_inner[i] += cells->first_inner[i - 1];
            cells->inner = mspringi_alloc(g->memory, cells->first_inner[cells->count + 1], sizeof *cells->inner);
            if (!cells->inner)
                return false;
        }
    }
    return true;
}

// One pass of a stable counting sort of joints, by the cell of one of the ends.
static void sort_joints(const mspringi_cells *cells, const mspringi_joint *from, mspringi_joint *to,
                        uint32_t *first, bool by_other) {
    for (uint32_t i = 0; i < cells->count + 2; ++i)
        first[i] = 0;
    for (uint32_t j = 0; j < cells->joint_count; ++j)
        first[cells->of_slot[by_other ? from[j].other_slot : from[j].slot] + 1]++;
    for (uint32_t i = 1; i < cells->count + 2; ++i)
        first[i] += first[i - 1];
    for (uint32_t j = 0; j < cells->joint_count; ++j)
        to[first[cells->of_slot[by_other ? from[j].other_slot : from[j].slot]]++] = from[j];
}

static bool list_joints(cutting *g) {
    mspringi_cells *cells = g->cells;
    const mspringi_topology *t = &g->network->topology;
    cells->joints = mspringi_alloc(g->memory, cells->joint_count, sizeof *cells->joints);
    mspringi_joint *scratch = mspringi_alloc(g->memory, cells->joint_count, sizeof *scratch);
    uint32_t *first = mspringi_alloc(g->memory, (size_t)cells->count + 2, sizeof *first);
    const bool ok = cells->joints && scratch && first;
    uint32_t count = 0, a, b;
    for (mspring_id s = 0; ok && s < t->spring_count; ++s) {
        const mspringi_place place = t->place_of_spring[s];
        if (!mspringi_place_is_woven(t, place))
            continue;
        mspringi_topology_ends(t, place, &a, &b);
        if (cells->of_slot[a] == cells->of_slot[b])
            continue;
        const bool a_later = cells->of_slot[a] > cells->of_slot[b];
        cells->joints[count++] = (mspringi_joint){
            .slot = a_later ? a : b, .other_slot = a_later ? b : a, .factors = mspringi_factors_of_place(place)};
    }
    if (ok) {
        sort_joints(cells, cells->joints, scratch, first, true);
        sort_joints(cells, scratch, cells->joints, first, false);
        // Each is at the end of its cell's now, which is where the next one's begin.
        for (uint32_t cell = cells->count; cell > 0; --cell)
            first[cell] = first[cell - 1];
        first[0] = 0;
    }
    cells->first_joint = first;
    mspringi_free(g->memory, scratch);
    return ok;
}

static bool find_lowest(cutting *g) {
    mspringi_cells *cells = g->cells;
    cells->lowest = mspringi_alloc(g->memory, cells->count, sizeof *cells->lowest);
    if (!cells->lowest)
        return false;
    for (uint32_t c = 0; c < cells->count; ++c)
        cells->lowest[c] = c;
    for (uint32_t j = 0; j < cells->joint_count; ++j) {
        const uint32_t cell = cells->of_slot[cells->joints[j].slot];
        const uint32_t other = cells->of_slot[cells->joints[j].other_slot];
        cells->lowest[cell] = other < cells->lowest[cell] ? other : cells->lowest[cell];
    }
    return true;
}

/* ---------------------------------------------------------------------------------------------------- the whole */

static bool find_empty(cutting *g) {
    const mspringi_topology *t = &g->network->topology;
    g->is_for_none = mspringi_alloc(g->memory, mspringi_slot_count(g->network), sizeof *g->is_for_none);
    for (uint32_t i = 0; g->is_for_none && i < t->empty_run_count; ++i)
        for (uint32_t j = 0; j < t->empty_runs[i].slot_count; ++j)
            g->is_for_none[t->empty_runs[i].first_slot + j] = true;
    return g->is_for_none != NULL;
}

static bool cut(cutting *g, uint32_t size) {
    const size_t slots = mspringi_slot_count(g->network);
    g->cells->of_slot = mspringi_alloc(g->memory, slots, sizeof *g->cells->of_slot);
    if (!g->cells->of_slot || !find_empty(g))
        return false;
    for (size_t slot = 0; slot < slots; ++slot)
        g->cells->of_slot[slot] = MSPRING_NONE;
    cut_grids(g, size);
    cut_chains(g, size);
    if (!cut_web(g, size))
        return false;
    cut_loose(g);
    return drop_empty_cells(g) && mspringi_cells_order(g->cells, g->network, g->memory) && list_slots(g) &&
           list_inner(g) && list_joints(g) && find_lowest(g);
}

mspring_result mspringi_cells_create(mspringi_cells *cells, const mspring_network *network, uint32_t size,
                                     mspringi_memory *memory, mspringi_message *message) {
    *cells = (mspringi_cells){.size = size};
    cutting g = {.network = network, .memory = memory, .cells = cells};
    const bool is_cut = cut(&g, size);
    mspringi_free(memory, g.is_for_none);
    if (is_cut)
        return MSPRING_OK;
    mspringi_cells_destroy(cells, memory);
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to cut %u particles into cells",
                         (unsigned)network->topology.particle_count);
}

#define ARRAY(member) MSPRINGI_COLUMN(mspringi_cells, member, MSPRINGI_ARRAY)
static const mspringi_column columns[] = {
    ARRAY(of_slot), ARRAY(first_slot), ARRAY(slots),       ARRAY(first_inner),
    ARRAY(inner),   ARRAY(joints),     ARRAY(first_joint), ARRAY(lowest),
};
const mspringi_columns mspringi_cells_columns = MSPRINGI_COLUMNS(columns);

void mspringi_cells_destroy(mspringi_cells *cells, mspringi_memory *memory) {
    mspringi_columns_free(mspringi_cells_columns, cells, memory);
    *cells = (mspringi_cells){0};
}

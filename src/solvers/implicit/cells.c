/// Division of a network into cells.
#include "solvers/implicit/cells.h"

#include "base/union_find.h"
#include "kernels/system.h"
#include "layout/emit/spare.h"

/// Grids of at most this many rows are cut across only.
#define SLENDER_ROWS 10

typedef mspringi_cell_builder cutting;

static mspring_result no_memory(const cutting *g) {
    return mspringi_fail(g->message, MSPRING_ERROR_MEMORY, "no memory to cut %u particles into cells",
                         (unsigned)g->network->topology.particle_count);
}

uint32_t mspringi_factors_of_spring_slot(mspringi_spring_slot spring_slot) {
    return spring_slot / MSPRINGI_WIDTH * (MSPRINGI_FACTORS * MSPRINGI_WIDTH) + spring_slot % MSPRINGI_WIDTH;
}

/* ------------------------------------------------------------------------------------------------------ cutting */

// True if a row is the first of its grid: no block of the row before has a block above it.
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
                if (!g->is_unused[slot])
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

// Divide the chains' slots into cells of `size` slots.
static void cut_chains(cutting *g, uint32_t size) {
    const mspringi_topology *t = &g->network->topology;
    const uint32_t first = t->chain_first * MSPRINGI_WIDTH, count = t->chain_blocks * MSPRINGI_WIDTH;
    for (uint32_t i = 0; i < count; ++i)
        if (!g->is_unused[first + i])
            g->cells->of_slot[first + i] = g->cells->count + i / size;
    g->cells->count += (count + size - 1) / size;
}

/* ------------------------------------------------------------------------------------------ the irregular part */

static uint32_t irregular_slots_of(const cutting *g) {
    return g->network->topology.irregular_blocks * MSPRINGI_WIDTH;
}

static uint32_t irregular_springs_of(const cutting *g) {
    return irregular_slots_of(g) > 0 ? g->network->topology.laid_out_count : 0;
}

static uint32_t most_in_cell(const cutting *g) {
    return g->cells->size * g->cells->size / 2;
}

static mspring_result begin_irregular(cutting *g) {
    const size_t slots = mspringi_slot_count(g->network);
    if (irregular_slots_of(g) == 0)
        return MSPRING_OK;
    g->first = mspringi_alloc(g->memory, slots + 2, sizeof *g->first);
    g->neighbour = mspringi_alloc(g->memory, (size_t)2 * irregular_springs_of(g), sizeof *g->neighbour);
    g->queue = mspringi_alloc(g->memory, most_in_cell(g), sizeof *g->queue);
    return g->first && g->neighbour && g->queue ? MSPRING_OK : no_memory(g);
}

static mspring_result count_irregular(cutting *g, uint32_t first, uint32_t end) {
    const mspringi_topology *t = &g->network->topology;
    for (uint32_t i = first; i < end; ++i) {
        g->first[t->irregular_a[i] + 2]++;
        g->first[t->irregular_b[i] + 2]++;
    }
    return MSPRING_OK;
}

static mspring_result add_up_irregular(cutting *g) {
    for (size_t slot = 2; g->first && slot < mspringi_slot_count(g->network) + 2; ++slot)
        g->first[slot] += g->first[slot - 1];
    return MSPRING_OK;
}

static mspring_result list_irregular(cutting *g, uint32_t first, uint32_t end) {
    const mspringi_topology *t = &g->network->topology;
    for (uint32_t i = first; i < end; ++i) {
        g->neighbour[g->first[t->irregular_a[i] + 1]++] = t->irregular_b[i];
        g->neighbour[g->first[t->irregular_b[i] + 1]++] = t->irregular_a[i];
    }
    return MSPRING_OK;
}

static bool is_free_for_cell(const cutting *g, uint32_t slot) {
    return !g->is_unused[slot] && g->cells->of_slot[slot] == MSPRING_NONE;
}

// Let the last cell grow breadth first from a slot.
static void grow_cell(cutting *g, uint32_t seed, uint32_t most) {
    const mspringi_topology *t = &g->network->topology;
    const uint32_t irregular = t->irregular_first * MSPRINGI_WIDTH,
                   irregular_end = irregular + irregular_slots_of(g);
    uint32_t i = g->grown;
    g->queue[g->grown++] = seed;
    g->cells->of_slot[seed] = g->cells->count;
    for (; i < g->grown; ++i) {
        for (uint32_t n = g->first[g->queue[i]]; n < g->first[g->queue[i] + 1] && g->grown < most; ++n) {
            const uint32_t slot = g->neighbour[n];
            if (slot < irregular || slot >= irregular_end || !is_free_for_cell(g, slot))
                continue;
            g->cells->of_slot[slot] = g->cells->count;
            g->queue[g->grown++] = slot;
        }
    }
}

// Grow neighbourhoods of at most size * size / 2 particles, from the first slot that is in none. Where springs lead
// anywhere, the last of them are crumbs, each with springs to many others, and their coarse matrix is full: of the
// largest size they are swept up into cells as large as the others.
static mspring_result grow_cells(cutting *g, uint32_t first, uint32_t end) {
    const uint32_t irregular = g->network->topology.irregular_first * MSPRINGI_WIDTH, most = most_in_cell(g);
    const bool sweeps_up = g->cells->size == MSPRINGI_LARGEST_TILE_SIZE;
    for (uint32_t seed = irregular + first; seed < irregular + end; ++seed) {
        if (!is_free_for_cell(g, seed))
            continue;
        if (g->grown == most || !sweeps_up) {
            g->cells->count += g->grown > 0;
            g->grown = 0;
        }
        if (g->grown > 0)
            mspringi_union_find_join(g->parent, g->queue[0], seed); // no spring does
        grow_cell(g, seed, most);
    }
    return MSPRING_OK;
}

static void free_lists(cutting *g) {
    uint32_t **const lists[] = {&g->first, &g->neighbour,      &g->queue,           &g->couplings,
                                &g->mark,  &g->by_sweep.order, &g->by_sweep.behind, &g->by_degree.behind};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; ++i) {
        mspringi_free(g->memory, *lists[i]);
        *lists[i] = NULL;
    }
    mspringi_free(g->memory, g->is_absorbed);
    g->is_absorbed = NULL;
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

static uint32_t springs_of(const cutting *g) {
    return g->network->topology.spring_count;
}

// Find the slots of a spring's ends. False: it lies in no cell.
static bool find_ends(const cutting *g, mspring_id spring, uint32_t *a, uint32_t *b) {
    const mspringi_topology *t = &g->network->topology;
    const mspringi_spring_slot spring_slot = t->slot_of_spring[spring];
    if (!mspringi_spring_slot_is_laid_out(t, spring_slot))
        return false;
    mspringi_topology_ends(t, spring_slot, a, b);
    return true;
}

static bool is_path_node(const cutting *g, uint32_t slot) {
    return g->paths->node_of_slot && g->paths->node_of_slot[slot] != MSPRING_NONE;
}

// Join what springs inside cells connect, but paths with nothing else: what a path joins does not move with it once
// that is condensed.
static mspring_result join_parts(cutting *g, uint32_t first, uint32_t end) {
    for (mspring_id s = first; s < end; ++s) {
        uint32_t a, b;
        if (find_ends(g, s, &a, &b) && g->cells->of_slot[a] == g->cells->of_slot[b] &&
            is_path_node(g, a) == is_path_node(g, b))
            mspringi_union_find_join(g->parent, a, b);
    }
    return MSPRING_OK;
}

// Number the parts of cells as cells, in the order of their lowest slots.
static mspring_result part_cells(cutting *g) {
    mspringi_cells *cells = g->cells;
    const uint32_t slots = (uint32_t)mspringi_slot_count(g->network);
    cells->count = 0;
    for (uint32_t slot = 0; slot < slots; ++slot) {
        const uint32_t root = mspringi_union_find_root(g->parent, slot);
        if (cells->of_slot[slot] != MSPRING_NONE)
            cells->of_slot[slot] = root == slot ? cells->count++ : cells->of_slot[root];
    }
    mspringi_free(g->memory, g->parent);
    g->parent = NULL;
    return mspringi_cells_begin_order(g) ? MSPRING_OK : no_memory(g);
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

static mspring_result count_inner(cutting *g, uint32_t first, uint32_t end) {
    mspringi_cells *cells = g->cells;
    for (mspring_id s = first; s < end; ++s) {
        uint32_t a, b;
        if (!find_ends(g, s, &a, &b))
            continue;
        if (cells->of_slot[a] != cells->of_slot[b])
            cells->cell_edge_count++;
        else
            cells->first_inner[cells->of_slot[a] + 2]++;
    }
    return MSPRING_OK;
}

static mspring_result reserve_springs(cutting *g) {
    mspringi_cells *cells = g->cells;
    for (uint32_t i = 2; i < cells->count + 2; ++i)
        cells->first_inner[i] += cells->first_inner[i - 1];
    cells->inner = mspringi_alloc(g->memory, cells->first_inner[cells->count + 1], sizeof *cells->inner);
    cells->cell_edges = mspringi_alloc(g->memory, cells->cell_edge_count, sizeof *cells->cell_edges);
    return cells->inner && cells->cell_edges ? MSPRING_OK : no_memory(g);
}

// List the springs inside cells, and those between them.
static mspring_result list_springs(cutting *g, uint32_t first, uint32_t end) {
    mspringi_cells *cells = g->cells;
    for (mspring_id s = first; s < end; ++s) {
        uint32_t a, b;
        if (!find_ends(g, s, &a, &b))
            continue;
        if (cells->of_slot[a] == cells->of_slot[b]) {
            cells->inner[cells->first_inner[cells->of_slot[a] + 1]++] = s;
            continue;
        }
        const bool a_later = cells->of_slot[a] > cells->of_slot[b];
        cells->cell_edges[g->listed++] = (mspringi_cell_edge){
            .slot = a_later ? a : b,
            .other_slot = a_later ? b : a,
            .factors = mspringi_factors_of_spring_slot(g->network->topology.slot_of_spring[s])};
    }
    return MSPRING_OK;
}

// One round of a stable counting sort of cell edges, by the cell of one end.
static void sort_joints(const mspringi_cells *cells, const mspringi_cell_edge *from, mspringi_cell_edge *to,
                        uint32_t *first, bool by_other) {
    for (uint32_t i = 0; i < cells->count + 2; ++i)
        first[i] = 0;
    for (uint32_t j = 0; j < cells->cell_edge_count; ++j)
        first[cells->of_slot[by_other ? from[j].other_slot : from[j].slot] + 1]++;
    for (uint32_t i = 1; i < cells->count + 2; ++i)
        first[i] += first[i - 1];
    for (uint32_t j = 0; j < cells->cell_edge_count; ++j)
        to[first[cells->of_slot[by_other ? from[j].other_slot : from[j].slot]]++] = from[j];
}

static mspring_result sort_all_joints(cutting *g) {
    mspringi_cells *cells = g->cells;
    mspringi_cell_edge *scratch = mspringi_alloc(g->memory, cells->cell_edge_count, sizeof *scratch);
    uint32_t *first = cells->first_cell_edge =
        mspringi_alloc(g->memory, (size_t)cells->count + 2, sizeof *cells->first_cell_edge);
    if (scratch && first) {
        sort_joints(cells, cells->cell_edges, scratch, first, true);
        sort_joints(cells, scratch, cells->cell_edges, first, false);
        // Each is at the end of its cell's now, which is where the next one's begin.
        for (uint32_t cell = cells->count; cell > 0; --cell)
            first[cell] = first[cell - 1];
        first[0] = 0;
    }
    mspringi_free(g->memory, scratch);
    return scratch && first ? MSPRING_OK : no_memory(g);
}

/* ---------------------------------------------------------------------------------------------------- the whole */

static bool find_empty(cutting *g) {
    const mspringi_topology *t = &g->network->topology;
    g->is_unused = mspringi_alloc(g->memory, mspringi_slot_count(g->network), sizeof *g->is_unused);
    for (uint32_t i = 0; g->is_unused && i < t->empty_run_count; ++i)
        for (uint32_t j = 0; j < t->empty_runs[i].slot_count; ++j)
            g->is_unused[t->empty_runs[i].first_slot + j] = true;
    return g->is_unused != NULL;
}

// Each slot is a part, but loose ones, of which each block is one.
static bool begin_parting(cutting *g) {
    const uint32_t slots = (uint32_t)mspringi_slot_count(g->network);
    const uint32_t loose = g->network->topology.loose_first * MSPRINGI_WIDTH;
    g->parent = mspringi_alloc(g->memory, slots, sizeof *g->parent);
    for (uint32_t slot = 0; g->parent && slot < slots; ++slot)
        g->parent[slot] = slot < loose ? slot : slot / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
    return g->parent != NULL;
}

static mspring_result begin(cutting *g) {
    const size_t slots = mspringi_slot_count(g->network);
    g->cells->of_slot = mspringi_alloc(g->memory, slots, sizeof *g->cells->of_slot);
    if (!g->cells->of_slot || !find_empty(g) || !begin_parting(g))
        return no_memory(g);
    for (size_t slot = 0; slot < slots; ++slot)
        g->cells->of_slot[slot] = MSPRING_NONE;
    cut_grids(g, g->cells->size);
    cut_chains(g, g->cells->size);
    return MSPRING_OK;
}

static mspring_result end_irregular(cutting *g) {
    g->cells->count += g->grown > 0;
    free_lists(g);
    cut_loose(g);
    return MSPRING_OK;
}

static mspring_result count_neighbours(cutting *g, uint32_t first, uint32_t end) {
    mspringi_cells_count_neighbours(g, first, end);
    return MSPRING_OK;
}

static mspring_result add_up(cutting *g) {
    return mspringi_cells_add_up(g) ? MSPRING_OK : no_memory(g);
}

static mspring_result list_neighbours(cutting *g, uint32_t first, uint32_t end) {
    mspringi_cells_list_neighbours(g, first, end);
    return MSPRING_OK;
}

static mspring_result sweep(cutting *g) {
    return mspringi_cells_sweep(g) && mspringi_cells_begin_elimination(g) ? MSPRING_OK : no_memory(g);
}

static uint32_t cells_of(const cutting *g) {
    return g->cells->count;
}

static mspring_result eliminate_by_degree(cutting *g, uint32_t first, uint32_t end) {
    return mspringi_cells_eliminate_by_degree(g, first, end) ? MSPRING_OK : no_memory(g);
}

static mspring_result eliminate_by_sweep(cutting *g, uint32_t first, uint32_t end) {
    return mspringi_cells_eliminate_by_sweep(g, first, end) ? MSPRING_OK : no_memory(g);
}

static mspring_result number(cutting *g) {
    return mspringi_cells_number(g) ? MSPRING_OK : no_memory(g);
}

static mspring_result list_rows(cutting *g, uint32_t first, uint32_t end) {
    mspringi_cells_list_rows(g, first, end);
    return MSPRING_OK;
}

static mspring_result list_all_slots(cutting *g) {
    free_lists(g);
    g->cells->first_inner = mspringi_alloc(g->memory, (size_t)g->cells->count + 2, sizeof *g->cells->first_inner);
    return g->cells->first_inner && list_slots(g) ? MSPRING_OK : no_memory(g);
}

MSPRINGI_PASSES(cells, mspringi_cell_builder)
static const cells_pass cells_passes[] = {
    MSPRINGI_ONCE(begin),
    MSPRINGI_ONCE(begin_irregular),
    MSPRINGI_EACH(count_irregular, irregular_springs_of, 64000),
    MSPRINGI_ONCE(add_up_irregular),
    MSPRINGI_EACH(list_irregular, irregular_springs_of, 32000),
    MSPRINGI_EACH(grow_cells, irregular_slots_of, 1000),
    MSPRINGI_ONCE(end_irregular),
    MSPRINGI_EACH(join_parts, springs_of, 32000),
    MSPRINGI_ONCE(part_cells),
    MSPRINGI_EACH(count_neighbours, springs_of, 32000),
    MSPRINGI_ONCE(add_up),
    MSPRINGI_EACH(list_neighbours, springs_of, 32000),
    MSPRINGI_ONCE(sweep),
    MSPRINGI_EACH(eliminate_by_degree, cells_of, 200),
    MSPRINGI_EACH(eliminate_by_sweep, cells_of, 200),
    MSPRINGI_ONCE(number),
    MSPRINGI_EACH(list_rows, cells_of, 1000),
    MSPRINGI_ONCE(list_all_slots),
    MSPRINGI_EACH(count_inner, springs_of, 32000),
    MSPRINGI_ONCE(reserve_springs),
    MSPRINGI_EACH(list_springs, springs_of, 32000),
    MSPRINGI_ONCE(sort_all_joints),
};

void mspringi_cells_begin(mspringi_cell_builder *g, mspringi_cells *cells, const mspring_network *network,
                          const mspringi_paths *paths, uint32_t size, double most_cost, mspringi_memory *memory,
                          mspringi_message *message) {
    *cells = (mspringi_cells){.size = size};
    *g = (mspringi_cell_builder){.network = network,
                                 .paths = paths,
                                 .memory = memory,
                                 .message = message,
                                 .cells = cells,
                                 .most_cost = most_cost};
}

mspring_result mspringi_cells_run(mspringi_cell_builder *g, bool *is_done) {
    const mspring_result result = cells_run(g, cells_passes, &g->cursor);
    *is_done = g->cursor.pass == MSPRINGI_PASS_COUNT(cells_passes);
    return result;
}

void mspringi_cells_end(mspringi_cell_builder *g) {
    free_lists(g);
    mspringi_free(g->memory, g->is_unused);
    mspringi_free(g->memory, g->parent);
    g->is_unused = NULL;
    g->parent = NULL;
}

#define ARRAY(member) MSPRINGI_ARRAY_ENTRY(mspringi_cells, member, MSPRINGI_ARRAY)
static const mspringi_array_entry columns[] = {
    ARRAY(of_slot),    ARRAY(first_slot),      ARRAY(slots),        ARRAY(first_inner), ARRAY(inner),
    ARRAY(cell_edges), ARRAY(first_cell_edge), ARRAY(first_before), ARRAY(before),
};
const mspringi_array_table mspringi_cells_columns = MSPRINGI_ARRAY_TABLE(columns);

void mspringi_cells_destroy(mspringi_cells *cells, mspringi_memory *memory) {
    mspringi_array_table_free(mspringi_cells_columns, cells, memory);
    *cells = (mspringi_cells){0};
}

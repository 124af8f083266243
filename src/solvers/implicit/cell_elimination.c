/// Order of cells in which the coarse matrix's factor costs little: the cheaper of two, least degree first (Tinney
/// and Walker 1967; by a quotient graph, George and Liu 1980), and from end to end, so that narrow bands stay
/// bands.
#include "solvers/implicit/cells.h"

#include <string.h>

typedef mspringi_cell_builder cutting;
typedef mspringi_cell_elimination elimination;

/* ------------------------------------------------------------------------------------------------------ degrees */

static void insert(cutting *g, uint32_t cell, uint32_t degree) {
    const uint32_t next = g->first_of_degree[degree];
    g->degree[cell] = degree;
    g->next[cell] = next;
    g->previous[cell] = MSPRING_NONE;
    if (next != MSPRING_NONE)
        g->previous[next] = cell;
    g->first_of_degree[degree] = cell;
    g->least_degree = degree < g->least_degree ? degree : g->least_degree;
}

static void take_out(const cutting *g, uint32_t cell) {
    const uint32_t next = g->next[cell], previous = g->previous[cell];
    if (next != MSPRING_NONE)
        g->previous[next] = previous;
    if (previous != MSPRING_NONE)
        g->next[previous] = next;
    else
        g->first_of_degree[g->degree[cell]] = next;
}

// How many cells one is coupled to, by itself and by eliminated ones.
static uint32_t degree_of(cutting *g, const elimination *e, uint32_t cell) {
    const uint32_t *const own = g->couplings + g->first[cell], *const through = own + g->left[cell];
    uint32_t degree = g->left[cell];
    g->mark[cell] = ++g->stamp;
    for (uint32_t i = 0; i < g->left[cell]; ++i)
        g->mark[own[i]] = g->stamp;
    for (uint32_t i = 0; i < g->eliminated[cell]; ++i) {
        const uint32_t place = g->place[through[i]];
        for (uint32_t k = e->first_behind[place]; k < e->first_behind[place + 1]; ++k) {
            const uint32_t other = e->behind[k];
            degree += g->mark[other] != g->stamp && g->place[other] == MSPRING_NONE;
            g->mark[other] = g->stamp;
        }
    }
    return degree;
}

/* -------------------------------------------------------------------------------------------------- elimination */

// Add a cell to the column that is being listed.
static void couple(cutting *g, elimination *e, uint32_t cell, uint32_t *end) {
    if (g->mark[cell] == g->stamp || g->place[cell] != MSPRING_NONE)
        return;
    g->mark[cell] = g->stamp;
    e->behind[(*end)++] = cell;
}

// List what a cell is coupled to. Those eliminated before that couple it are absorbed.
static bool list_column(cutting *g, elimination *e, uint32_t cell) {
    const uint32_t *const own = g->couplings + g->first[cell], *const through = own + g->left[cell];
    uint32_t end = e->first_behind[e->done];
    void *behind = e->behind;
    if (!mspringi_grow(g->memory, &behind, &e->capacity, (size_t)end + g->cells->count, sizeof *e->behind))
        return false;
    e->behind = behind;
    g->mark[cell] = ++g->stamp;
    for (uint32_t i = 0; i < g->left[cell]; ++i)
        couple(g, e, own[i], &end);
    for (uint32_t i = 0; i < g->eliminated[cell]; ++i) {
        const uint32_t place = g->place[through[i]];
        g->is_absorbed[through[i]] = true;
        for (uint32_t k = e->first_behind[place]; k < e->first_behind[place + 1]; ++k)
            couple(g, e, e->behind[k], &end);
    }
    e->first_behind[e->done + 1] = end;
    return true;
}

// Couple a cell by the one that is eliminated: no longer by that itself, nor by cells of its column, which are
// marked, nor by absorbed ones. At least one of them goes, so there is room.
static void couple_by(const cutting *g, uint32_t cell, uint32_t by) {
    uint32_t *const own = g->couplings + g->first[cell];
    const uint32_t left = g->left[cell], end = left + g->eliminated[cell];
    uint32_t kept = 0;
    for (uint32_t i = 0; i < left; ++i)
        if (g->mark[own[i]] != g->stamp)
            own[kept++] = own[i];
    g->left[cell] = kept;
    for (uint32_t i = left; i < end; ++i)
        if (!g->is_absorbed[own[i]])
            own[kept++] = own[i];
    own[kept++] = by;
    g->eliminated[cell] = kept - g->left[cell];
}

static bool eliminate(cutting *g, elimination *e, uint32_t cell) {
    if (!list_column(g, e, cell))
        return false;
    const uint32_t begin = e->first_behind[e->done], end = e->first_behind[e->done + 1];
    for (uint32_t i = begin; i < end; ++i)
        couple_by(g, e->behind[i], cell);
    g->place[cell] = e->done;
    e->order[e->done++] = cell;
    e->cost += mspringi_cells_column_cost((double)(end - begin) + 1.0);
    return true;
}

// Degrees fall by one at most from cell to cell, so at least that many columns are still to come, each shorter by
// one than the one before.
static double least_cost(const cutting *g, const elimination *e) {
    const double degree = (double)g->least_degree;
    return e->cost + mspringi_cells_column_cost(degree) * degree * (1.0 / 3.0);
}

bool mspringi_cells_eliminate_by_degree(cutting *g, uint32_t first, uint32_t end) {
    elimination *const e = &g->by_degree;
    for (uint32_t i = first; i < end && e->cost <= g->most_cost; ++i) {
        while (g->first_of_degree[g->least_degree] == MSPRING_NONE)
            g->least_degree++;
        const uint32_t cell = g->first_of_degree[g->least_degree];
        if (least_cost(g, e) > g->most_cost) {
            e->cost = least_cost(g, e);
            return true;
        }
        take_out(g, cell);
        if (!eliminate(g, e, cell))
            return false;
        for (uint32_t k = e->first_behind[i]; k < e->first_behind[i + 1]; ++k) {
            take_out(g, e->behind[k]);
            insert(g, e->behind[k], degree_of(g, e, e->behind[k]));
        }
    }
    return true;
}

/* -------------------------------------------------------------------------------------------------- preparation */

// All cells are left again.
static void restart(cutting *g) {
    const uint32_t cells = g->cells->count;
    memcpy(g->couplings, g->neighbour, g->first[cells] * sizeof *g->couplings);
    memset(g->eliminated, 0, cells * sizeof *g->eliminated);
    memset(g->is_absorbed, 0, cells * sizeof *g->is_absorbed);
    for (uint32_t cell = 0; cell < cells; ++cell) {
        g->left[cell] = g->first[cell + 1] - g->first[cell];
        g->place[cell] = MSPRING_NONE;
    }
}

// List each neighbour once, since they are repeated.
static void drop_repeats(cutting *g) {
    uint32_t end = 0, begin = 0;
    for (uint32_t cell = 0; cell < g->cells->count; ++cell) {
        const uint32_t stop = g->first[cell + 1];
        g->mark[cell] = ++g->stamp;
        g->first[cell] = end;
        for (uint32_t i = begin; i < stop; ++i) {
            const uint32_t other = g->neighbour[i];
            if (g->mark[other] != g->stamp)
                g->neighbour[end++] = other;
            g->mark[other] = g->stamp;
        }
        begin = stop;
    }
    g->first[g->cells->count] = end;
}

bool mspringi_cells_begin_elimination(cutting *g) {
    const size_t cells = g->cells->count;
    drop_repeats(g);
    uint32_t **const arrays[] = {
        &g->left,     &g->eliminated, &g->place,           &g->first_of_degree,        &g->next,
        &g->previous, &g->degree,     &g->by_degree.order, &g->by_degree.first_behind, &g->by_sweep.first_behind};
    const size_t count = sizeof arrays / sizeof arrays[0];
    g->couplings = mspringi_alloc(g->memory, g->first[cells] + count * (cells + 1), sizeof *g->couplings);
    g->is_absorbed = mspringi_alloc(g->memory, cells, sizeof *g->is_absorbed);
    if (!g->couplings || !g->is_absorbed)
        return false;
    for (size_t i = 0; i < count; ++i)
        *arrays[i] = g->couplings + g->first[cells] + i * (cells + 1);
    restart(g);
    for (uint32_t cell = 0; cell < cells; ++cell)
        g->first_of_degree[cell] = MSPRING_NONE;
    for (uint32_t cell = (uint32_t)cells; cell-- > 0;)
        insert(g, cell, g->left[cell]);
    return true;
}

bool mspringi_cells_eliminate_by_sweep(cutting *g, uint32_t first, uint32_t end) {
    elimination *const e = &g->by_sweep;
    if (g->by_degree.cost > g->most_cost)
        return true;
    if (first == 0)
        restart(g);
    for (uint32_t i = first; i < end && e->cost <= g->by_degree.cost; ++i)
        if (!eliminate(g, e, e->order[i]))
            return false;
    return true;
}

/* ----------------------------------------------------------------------------------------------------- numbering
 */

static const elimination *cheaper_of(const cutting *g) {
    const bool is_whole = g->by_sweep.done == g->cells->count;
    return is_whole && g->by_sweep.cost <= g->by_degree.cost ? &g->by_sweep : &g->by_degree;
}

// Count the entries of rows.
static void count_rows(const cutting *g, const elimination *e) {
    uint32_t *const first = g->cells->first_before;
    for (uint32_t i = 0; i < e->first_behind[g->cells->count]; ++i)
        first[g->place[e->behind[i]] + 2]++;
    for (uint32_t i = 2; i < g->cells->count + 2; ++i)
        first[i] += first[i - 1];
}

// Without rows, if they cost too much, the numbers mean nothing.
bool mspringi_cells_number(cutting *g) {
    mspringi_cells *cells = g->cells;
    const elimination *e = cheaper_of(g);
    const uint32_t slots = (uint32_t)mspringi_slot_count(g->network);
    const bool has_rows = e->cost <= g->most_cost;
    cells->cost = e->cost;
    cells->has_rows = has_rows;
    cells->first_before = mspringi_alloc(g->memory, (size_t)cells->count + 2, sizeof *cells->first_before);
    cells->before = mspringi_alloc(g->memory, has_rows ? e->first_behind[cells->count] : 0, sizeof *cells->before);
    if (!cells->first_before || !cells->before)
        return false;
    for (uint32_t i = 0; i < cells->count; ++i)
        g->place[has_rows ? e->order[i] : i] = i;
    for (uint32_t slot = 0; slot < slots; ++slot)
        if (cells->of_slot[slot] != MSPRING_NONE)
            cells->of_slot[slot] = g->place[cells->of_slot[slot]];
    if (has_rows)
        count_rows(g, e);
    return true;
}

// Column after column, so that rows are sorted.
void mspringi_cells_list_rows(cutting *g, uint32_t first, uint32_t end) {
    mspringi_cells *cells = g->cells;
    const elimination *e = cheaper_of(g);
    for (uint32_t i = first; i < end && cells->has_rows; ++i)
        for (uint32_t k = e->first_behind[i]; k < e->first_behind[i + 1]; ++k)
            cells->before[cells->first_before[g->place[e->behind[k]] + 1]++] = i;
}

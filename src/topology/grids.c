/// Grids, found from positions and springs whatever the order in which they were added.
///
/// From a seed particle the search follows springs: the offset between a spring's ends, in units of the seed's
/// shortest axis-parallel spring, says which cell the other end is in. A grid is kept if sweeping its rows costs
/// less than handling its springs one by one.
#include "analysis.h"

#include <math.h>
#include <stdlib.h>

/// How far, in cells, an offset may lie off its cell's centre.
#define CELL_TOLERANCE 0.3

/// A grid is kept if one slot in this many of its records holds a spring: a spring on its own costs about that
/// many times a slot of a swept record (measured: 6 to 12, by instruction set).
#define SLOTS_PER_SPRING 6

typedef struct finder {
    const mspringi_graph *graph;
    mspringi_grids *grids;
    uint8_t *kinds;
    uint8_t *given_up; ///< [particles] was in a grid that was not worth it
    int32_t *column;   ///< [particles] relative to the seed
    int32_t *row;      ///< [particles]
    uint32_t *cell;    ///< hash table of the current grid's particles
    size_t cell_mask;
    uint64_t *keys, *scratch;
} finder;

/* --------------------------------------------------------------------------------------- the cells of a grid */

static size_t hash_cell(int32_t column, int32_t row, size_t mask) {
    uint64_t key = (uint64_t)(uint32_t)column << 32 | (uint32_t)row;
    key ^= key >> 33;
    key *= 0xff51afd7ed558ccdu; // an odd number with well spread bits
    key ^= key >> 33;
    return (size_t)key & mask;
}

// Put a particle into a cell; false if somebody is there.
static bool occupy(finder *f, uint32_t particle, int32_t column, int32_t row) {
    size_t i = hash_cell(column, row, f->cell_mask);
    while (f->cell[i] != 0) {
        const uint32_t there = f->cell[i] - 1;
        if (f->column[there] == column && f->row[there] == row)
            return false;
        i = (i + 1) & f->cell_mask;
    }
    f->cell[i] = particle + 1;
    f->column[particle] = column;
    f->row[particle] = row;
    return true;
}

// Empty the hash table again: probe for each member, then clear.
static void vacate(finder *f, const uint32_t *members, uint32_t count) {
    for (uint32_t m = 0; m < count; ++m) {
        size_t i = hash_cell(f->column[members[m]], f->row[members[m]], f->cell_mask);
        while (f->cell[i] != 0) {
            f->cell[i] = 0;
            i = (i + 1) & f->cell_mask;
        }
    }
}

/* ------------------------------------------------------------------------------------------------- the search */

static bool is_free(const finder *f, uint32_t particle) {
    return f->kinds[particle] == MSPRINGI_ROW_LOOSE && f->grids->grid_of[particle] == MSPRING_NONE &&
           !f->given_up[particle];
}

// The shortest of a particle's springs that lie along an axis; 0 if it has none.
static double shortest_axial_spring(const finder *f, uint32_t particle) {
    const mspring_builder *builder = f->graph->builder;
    double shortest = 0.0;
    for (uint32_t i = f->graph->first[particle]; i < f->graph->first[particle + 1]; ++i) {
        const mspring_id other = mspringi_other_end(&builder->springs[f->graph->springs[i]], particle);
        const double dx = fabs(builder->particles[other].x - builder->particles[particle].x);
        const double dy = fabs(builder->particles[other].y - builder->particles[particle].y);
        const double along = dx > dy ? dx : dy, across = dx > dy ? dy : dx;
        if (is_free(f, other) && across <= CELL_TOLERANCE * along && (shortest == 0.0 || along < shortest))
            shortest = along;
    }
    return shortest;
}

// Round an offset to a cell; false if it lies off any of the 3 x 3 cells around.
static bool round_offset(double offset, int32_t *cell) {
    const double rounded = floor(offset + 0.5);
    if (!(fabs(rounded) <= 1.0 && fabs(offset - rounded) <= CELL_TOLERANCE))
        return false;
    *cell = (int32_t)rounded;
    return true;
}

// Collect all particles that can be reached from seed, cell by cell, behind those of the earlier grids.
static void flood(finder *f, uint32_t seed, double spacing, uint32_t number) {
    const mspringi_graph *graph = f->graph;
    const mspring_builder *builder = graph->builder;
    mspringi_grids *grids = f->grids;
    occupy(f, seed, 0, 0);
    grids->grid_of[seed] = number;
    uint32_t done = grids->member_count;
    grids->members[grids->member_count++] = seed;
    for (; done < grids->member_count; ++done) {
        const uint32_t at = grids->members[done];
        for (uint32_t i = graph->first[at]; i < graph->first[at + 1]; ++i) {
            const mspring_id other = mspringi_other_end(&builder->springs[graph->springs[i]], at);
            int32_t dc = 0, dr = 0;
            if (!is_free(f, other) ||
                !round_offset((builder->particles[other].x - builder->particles[at].x) / spacing, &dc) ||
                !round_offset((builder->particles[other].y - builder->particles[at].y) / spacing, &dr))
                continue;
            if ((dc != 0 || dr != 0) && occupy(f, other, f->column[at] + dc, f->row[at] + dr)) {
                grids->grid_of[other] = number;
                grids->members[grids->member_count++] = other;
            }
        }
    }
}

/* --------------------------------------------------------------------------------------------- is it worth it */

// What it costs to sweep a grid with its columns along the rows, or the other way round, in blocks: those it has,
// and about one for each run of neighbouring ones to start with.
static uint64_t cost_of_sweep(finder *f, const uint32_t *members, uint32_t count, int32_t min_column,
                              int32_t min_row, bool transposed, uint32_t *blocks) {
    for (uint32_t m = 0; m < count; ++m) {
        const uint32_t column = (uint32_t)(f->column[members[m]] - min_column);
        const uint32_t row = (uint32_t)(f->row[members[m]] - min_row);
        f->keys[m] = transposed ? (uint64_t)column << 32 | row / MSPRINGI_WIDTH
                                : (uint64_t)row << 32 | column / MSPRINGI_WIDTH;
    }
    mspringi_sort_keys(f->keys, f->scratch, count);
    uint32_t runs = 0;
    *blocks = 0;
    for (uint32_t i = 0; i < count; ++i) {
        *blocks += i == 0 || f->keys[i] != f->keys[i - 1];
        runs += i == 0 || f->keys[i] > f->keys[i - 1] + 1;
    }
    return (uint64_t)*blocks + runs;
}

// Count the springs of a grid's particles: those between neighbouring cells, and all.
static void count_springs(const finder *f, const uint32_t *members, uint32_t count, size_t *neighbours,
                          size_t *all) {
    const mspringi_graph *graph = f->graph;
    size_t ends = 0;
    *all = 0;
    for (uint32_t m = 0; m < count; ++m) {
        const uint32_t at = members[m];
        *all += graph->first[at + 1] - graph->first[at];
        for (uint32_t i = graph->first[at]; i < graph->first[at + 1]; ++i) {
            const mspring_id other = mspringi_other_end(&graph->builder->springs[graph->springs[i]], at);
            ends += f->grids->grid_of[other] == f->grids->grid_of[at] &&
                    abs(f->column[other] - f->column[at]) <= 1 && abs(f->row[other] - f->row[at]) <= 1;
        }
    }
    *neighbours = ends / 2;
    *all -= *neighbours;
}

// Keep the grid that was flooded last, in its better orientation, or give it up.
static void judge(finder *f, uint32_t begin) {
    mspringi_grids *grids = f->grids;
    uint32_t *members = grids->members + begin;
    const uint32_t count = grids->member_count - begin;
    int32_t min_column = 0, min_row = 0;
    for (uint32_t m = 0; m < count; ++m) {
        min_column = f->column[members[m]] < min_column ? f->column[members[m]] : min_column;
        min_row = f->row[members[m]] < min_row ? f->row[members[m]] : min_row;
    }
    uint32_t blocks_upright, blocks_transposed;
    const bool transposed = cost_of_sweep(f, members, count, min_column, min_row, true, &blocks_transposed) <
                            cost_of_sweep(f, members, count, min_column, min_row, false, &blocks_upright);
    const uint32_t blocks = transposed ? blocks_transposed : blocks_upright;
    size_t neighbours = 0, all = 0;
    count_springs(f, members, count, &neighbours, &all);

    if (neighbours * SLOTS_PER_SPRING < (size_t)blocks * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH ||
        2 * neighbours < all) {
        for (uint32_t m = 0; m < count; ++m) {
            grids->grid_of[members[m]] = MSPRING_NONE;
            f->given_up[members[m]] = 1;
        }
        grids->member_count = begin;
        return;
    }
    for (uint32_t m = 0; m < count; ++m) {
        const uint32_t p = members[m];
        const uint32_t column = (uint32_t)(f->column[p] - min_column), row = (uint32_t)(f->row[p] - min_row);
        grids->column[p] = transposed ? row : column;
        grids->row[p] = transposed ? column : row;
        f->kinds[p] = MSPRINGI_ROW_LATTICE;
    }
    grids->first_member[++grids->count] = grids->member_count;
}

static void find_all(finder *f) {
    mspringi_grids *grids = f->grids;
    const uint32_t particles = (uint32_t)f->graph->builder->particle_count;
    for (uint32_t seed = 0; seed < particles; ++seed) {
        const double spacing = is_free(f, seed) ? shortest_axial_spring(f, seed) : 0.0;
        if (!(spacing > 0.0))
            continue;
        const uint32_t begin = grids->member_count;
        flood(f, seed, spacing, grids->count);
        vacate(f, grids->members + begin, grids->member_count - begin);
        judge(f, begin);
    }
}

mspring_result mspringi_grids_find(mspringi_grids *grids, const mspringi_graph *graph, uint8_t *kinds,
                                   mspringi_memory *memory, mspringi_message *message) {
    const size_t particles = graph->builder->particle_count;
    size_t table = 16;
    while (table < 2 * particles)
        table *= 2;
    finder f = {.graph = graph, .grids = grids, .kinds = kinds, .cell_mask = table - 1};
    grids->grid_of = mspringi_alloc(memory, particles, sizeof *grids->grid_of);
    grids->column = mspringi_alloc(memory, particles, sizeof *grids->column);
    grids->row = mspringi_alloc(memory, particles, sizeof *grids->row);
    grids->members = mspringi_alloc(memory, particles, sizeof *grids->members);
    grids->first_member = mspringi_alloc(memory, particles + 1, sizeof *grids->first_member);
    f.given_up = mspringi_alloc(memory, particles, sizeof *f.given_up);
    f.column = mspringi_alloc(memory, particles, sizeof *f.column);
    f.row = mspringi_alloc(memory, particles, sizeof *f.row);
    f.cell = mspringi_alloc(memory, table, sizeof *f.cell);
    f.keys = mspringi_alloc(memory, particles, sizeof *f.keys);
    f.scratch = mspringi_alloc(memory, particles, sizeof *f.scratch);
    mspring_result result = MSPRING_OK;
    if (!grids->grid_of || !grids->column || !grids->row || !grids->members || !grids->first_member ||
        !f.given_up || !f.column || !f.row || !f.cell || !f.keys || !f.scratch) {
        result =
            mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to search %zu particles for grids", particles);
    } else {
        for (size_t p = 0; p < particles; ++p)
            grids->grid_of[p] = MSPRING_NONE;
        find_all(&f);
    }
    grids->found_count = grids->count;
    mspringi_free(memory, f.given_up);
    mspringi_free(memory, f.column);
    mspringi_free(memory, f.row);
    mspringi_free(memory, f.cell);
    mspringi_free(memory, f.keys);
    mspringi_free(memory, f.scratch);
    return result;
}

void mspringi_grids_destroy(mspringi_grids *grids, mspringi_memory *memory) {
    mspringi_free(memory, grids->grid_of);
    mspringi_free(memory, grids->column);
    mspringi_free(memory, grids->row);
    mspringi_free(memory, grids->members);
    mspringi_free(memory, grids->first_member);
}

bool mspringi_grids_place(const mspringi_grids *grids, const mspringi_spring *spring,
                          mspringi_lattice_spring *found) {
    uint32_t base = spring->a, tip = spring->b;
    if (grids->grid_of[base] == MSPRING_NONE || grids->grid_of[base] != grids->grid_of[tip])
        return false;
    // The base is in the column to the left or, in the same column, in the row below.
    if (grids->column[base] > grids->column[tip] ||
        (grids->column[base] == grids->column[tip] && grids->row[base] > grids->row[tip])) {
        base = spring->b;
        tip = spring->a;
    }
    const uint32_t right = grids->column[tip] - grids->column[base];
    const int64_t up = (int64_t)grids->row[tip] - (int64_t)grids->row[base];
    if (right > 1 || up > 1 || up < -1)
        return false;
    found->column = grids->column[base];
    found->row = grids->row[base] - (up < 0);
    found->direction = up < 0       ? MSPRINGI_SOUTH_EAST
                       : up == 0    ? MSPRINGI_EAST
                       : right == 0 ? MSPRINGI_NORTH
                                    : MSPRINGI_NORTH_EAST;
    return true;
}

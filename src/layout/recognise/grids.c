/// Search for grids by positions and springs, whatever the order of ids.
///
/// A search follows springs from a seed. The vector along a spring, in the lattice basis of one end, gives the cell
/// of the other end. A grid is kept if sweeping its rows costs less than computing its springs one by one.
///
/// There are three searches, each among the remaining particles. The first is for axis-aligned grids with nearly
/// all springs of their particles. The second is for curved ones, at any angle and with oblong cells, the third for
/// axis-aligned ones with half of the springs.
#include "layout/analysis.h"
#include "layout/recognise/lattice_basis.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Largest slope of a spring along an axis.
#define AXIAL_TOLERANCE 0.3f

/// A grid is kept if a spring lies in at least one in this many slots of its records. An irregular spring costs as
/// much as 6 to 12 slots, by instruction set.
#define SLOTS_PER_SPRING 6

/// The first two searches keep a grid if at most one in this many springs of its particles joins no neighbouring
/// cells. (Meshes of 200 x 200 triangles, displaced by up to a fraction of a cell, ns per spring and substep with
/// AVX-512. Displaced by 0.2: aligned 0.9, curved 0.6; by 0.3: aligned 1.2, curved 4.3, in 15 parts. A ring of 36 x
/// 6: 1.9 and 0.7.)
#define SPRINGS_PER_OUTER_ALIGNED 64
#define SPRINGS_PER_OUTER_CURVED 16

/// From an entry of the table to the next that may have a cell: on another line, and odd, so that all are visited.
#define NEXT_ENTRY 17

/// Place of a spring in this direction.
#define PLACE(direction) (1 + MSPRINGI_##direction)

/// Most springs of a curved grid's seed: to eight neighbours, and some ropes.
#define MAX_SEED_SPRINGS 16

typedef enum grid_search { SEARCH_ALIGNED, SEARCH_CURVED, SEARCH_PARTIAL } grid_search;

/// Springs of a grid's particles.
typedef struct grid_springs {
    uint32_t inner_ends; ///< ends of springs between neighbouring cells
    uint32_t ends;       ///< ends of all springs of its particles
} grid_springs;

/// Candidate of a particle that can be in none: in a grid already, or not loose.
#define TAKEN (MSPRING_NONE - 1)

/// A particle as the search reads it, on one cache line.
typedef struct grid_place {
    double x, y;
    int32_t column, row; ///< relative to the seed
    uint32_t grid;       ///< candidate, MSPRING_NONE or TAKEN
} grid_place;

/// Search for grids. Grids from grids->count on are candidates: found by the present search, not yet evaluated.
typedef struct mspringi_grid_finder {
    const mspringi_graph *graph;
    mspringi_grids *grids;
    uint8_t *kinds;
    grid_search search;
    grid_place *places; ///< [particles]
    uint32_t *cell;     ///< hash table of the candidates' particles
    size_t cell_mask;
    uint64_t *keys, *scratch; ///< [particles]
    /// [particles] Lattice bases, in the memory of keys and scratch, which are needed later.
    mspringi_grid_step *steps[2];
    mspringi_lattice_basis aligned; ///< basis of an axis-aligned grid
    grid_springs *springs;          ///< [candidates]

    bool has_partial;            ///< a candidate of the first search would do for the last
    uint32_t first, end;         ///< candidates
    uint32_t seed;               ///< next particle to try as a seed
    uint32_t next_member;        ///< first member not yet visited
    int32_t min_column, min_row; ///< of the grid being evaluated
    uint32_t blocks, runs;       ///< blocks, and runs of consecutive ones, in one orientation
} finder;

static mspring_result out_of_memory(const mspringi_graph *graph, mspringi_message *message) {
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory to search %zu particles for grids",
                         graph->builder->particle_count);
}

/* --------------------------------------------------------------------------------------- the cells of a grid */

// Cells of 4 by 4 share a cache line of the table.
static size_t hash_cell(uint32_t grid, uint32_t column, uint32_t row, size_t mask) {
    uint64_t key = (uint64_t)(column / 4) << 32 | row / 4;
    key ^= grid * 0x9e3779b97f4a7c15u; // as below
    key ^= key >> 33;
    key *= 0xff51afd7ed558ccdu; // an odd number with well spread bits
    key ^= key >> 33;
    return ((size_t)key ^ (column % 4 * 4 + row % 4)) & mask;
}

// Put a particle into a cell of the last candidate; false if the cell is taken.
static bool occupy(finder *f, uint32_t particle, int32_t column, int32_t row) {
    mspringi_grids *grids = f->grids;
    const uint32_t grid = f->end - 1;
    size_t i = hash_cell(grid, (uint32_t)column, (uint32_t)row, f->cell_mask);
    while (f->cell[i] != 0) {
        const grid_place *there = &f->places[f->cell[i] - 1];
        if (there->column == column && there->row == row && there->grid == grid)
            return false;
        i = (i + NEXT_ENTRY) & f->cell_mask;
    }
    f->cell[i] = particle + 1;
    f->places[particle].column = column;
    f->places[particle].row = row;
    f->places[particle].grid = grid;
    grids->members[grids->member_count++] = particle;
    return true;
}

/* ------------------------------------------------------------------------------------------------- the search */

static bool is_free(const finder *f, uint32_t particle) {
    return f->places[particle].grid == MSPRING_NONE;
}

static mspringi_lattice_basis basis_of(const finder *f, uint32_t particle) {
    return (mspringi_lattice_basis){f->steps[0][particle], f->steps[1][particle]};
}

static void set_basis(finder *f, uint32_t particle, mspringi_lattice_basis basis) {
    f->steps[0][particle] = basis.column;
    f->steps[1][particle] = basis.row;
}

static mspringi_grid_step vector_between(const finder *f, uint32_t from, uint32_t to) {
    const grid_place *a = &f->places[from], *b = &f->places[to];
    return (mspringi_grid_step){(float)(b->x - a->x), (float)(b->y - a->y)};
}

// Set the basis from the shortest of a seed's springs along an axis.
static bool find_aligned_basis(finder *f, uint32_t seed) {
    float shortest = 0.0f;
    for (uint32_t i = f->graph->first[seed]; i < f->graph->first[seed + 1]; ++i) {
        const mspring_id other = f->graph->others[i];
        const mspringi_grid_step vector = vector_between(f, seed, other);
        const float dx = fabsf(vector.x), dy = fabsf(vector.y);
        const float along = dx > dy ? dx : dy, across = dx > dy ? dy : dx;
        if (is_free(f, other) && across <= AXIAL_TOLERANCE * along && (shortest == 0.0f || along < shortest))
            shortest = along;
    }
    f->aligned = mspringi_lattice_basis_aligned(shortest);
    return shortest > 0.0f;
}

// List the vectors along a seed's springs to free particles, shortest first. Return their number, or 0 if the seed
// has too many springs.
static uint32_t list_vectors(const finder *f, uint32_t seed, mspringi_grid_step vectors[MAX_SEED_SPRINGS]) {
    const uint32_t first = f->graph->first[seed], end = f->graph->first[seed + 1];
    uint32_t count = 0;
    for (uint32_t i = first; end - first <= MAX_SEED_SPRINGS && i < end; ++i) {
        const mspring_id other = f->graph->others[i];
        const mspringi_grid_step vector = vector_between(f, seed, other);
        if (!is_free(f, other))
            continue;
        uint32_t at = count++;
        for (; at > 0 && mspringi_square_length(vector) < mspringi_square_length(vectors[at - 1]); --at)
            vectors[at] = vectors[at - 1];
        vectors[at] = vector;
    }
    return count;
}

static uint32_t count_rounded(mspringi_lattice_basis basis, const mspringi_grid_step *vectors, uint32_t count) {
    uint32_t rounded = 0;
    int32_t columns, rows;
    for (uint32_t i = 0; i < count; ++i)
        rounded += mspringi_lattice_basis_round(basis, vectors[i], &columns, &rows);
    return rounded;
}

// Set a seed's basis from its shortest spring and the one that rounds most springs to neighbouring cells. Side and
// diagonal of a slanted cell may be equally long; this finds the side.
static bool find_curved_basis(finder *f, uint32_t seed) {
    mspringi_grid_step vectors[MAX_SEED_SPRINGS];
    const uint32_t count = list_vectors(f, seed, vectors);
    uint32_t most = 0;
    for (uint32_t i = 1; i < count; ++i) {
        if (!mspringi_lattice_basis_is_spanned(vectors[0], vectors[i]))
            continue;
        const mspringi_lattice_basis basis = mspringi_lattice_basis_of(vectors[0], vectors[i]);
        const uint32_t rounded = count_rounded(basis, vectors, count);
        if (rounded > most) {
            most = rounded;
            set_basis(f, seed, basis);
        }
    }
    return most > 0;
}

// Begin a grid with a particle that has a basis.
static void seed_from(finder *f, uint32_t seed) {
    if (!is_free(f, seed) ||
        !(f->search == SEARCH_CURVED ? find_curved_basis(f, seed) : find_aligned_basis(f, seed)))
        return;
    f->grids->first_member[f->end++] = f->grids->member_count;
    (void)occupy(f, seed, 0, 0);
}

// Fit a particle's basis to the members in the nearest eight cells.
static mspringi_lattice_basis fit_basis(finder *f, uint32_t at) {
    mspringi_basis_fit fit = {.count = 0};
    for (uint32_t i = f->graph->first[at]; i < f->graph->first[at + 1]; ++i) {
        const mspring_id other = f->graph->others[i];
        const bool is_member = f->places[other].grid == f->end - 1;
        const int32_t dc = is_member ? f->places[other].column - f->places[at].column : 0;
        const int32_t dr = is_member ? f->places[other].row - f->places[at].row : 0;
        if ((dc != 0 || dr != 0) && abs(dc) <= 1 && abs(dr) <= 1)
            mspringi_basis_fit_add(&fit, basis_of(f, other), vector_between(f, at, other), dc, dr);
    }
    if (fit.count > 0)
        set_basis(f, at, mspringi_basis_fit_result(&fit));
    return basis_of(f, at);
}

// Add the free neighbours of a member to the last candidate, each to its cell.
static void spread_from(finder *f, uint32_t at) {
    const mspringi_graph *graph = f->graph;
    const mspringi_lattice_basis basis = f->search == SEARCH_CURVED ? fit_basis(f, at) : f->aligned;
    for (uint32_t i = graph->first[at]; i < graph->first[at + 1]; ++i) {
        const mspring_id other = graph->others[i];
        int32_t dc = 0, dr = 0;
        if (!is_free(f, other) || !mspringi_lattice_basis_round(basis, vector_between(f, at, other), &dc, &dr))
            continue;
        if ((dc != 0 || dr != 0) && occupy(f, other, f->places[at].column + dc, f->places[at].row + dr) &&
            f->search == SEARCH_CURVED)
            set_basis(f, other, basis);
    }
}

void mspringi_grids_flood(mspringi_grids *grids, uint32_t first, uint32_t end) {
    finder *f = grids->finder;
    const uint32_t particles = (uint32_t)f->graph->builder->particle_count;
    // The last search repeats the first one, with other terms, if no grid was found meanwhile.
    if (f->search == SEARCH_PARTIAL && grids->count == 0 && !f->has_partial)
        return;
    for (uint32_t i = first; i < end; ++i) {
        if (f->next_member < grids->member_count)
            spread_from(f, grids->members[f->next_member++]);
        else if (f->seed < particles)
            seed_from(f, f->seed++);
    }
}

/* --------------------------------------------------------------------------------------------- is it worth it */

// True if a grid has the proportion of its particles' springs that the search requires.
static bool has_enough_springs(grid_search search, size_t neighbours, size_t all) {
    const size_t outer = all - neighbours;
    switch (search) {
    case SEARCH_ALIGNED:
        return outer * SPRINGS_PER_OUTER_ALIGNED <= all;
    case SEARCH_CURVED:
        return outer * SPRINGS_PER_OUTER_CURVED <= all;
    default:
        return outer <= neighbours;
    }
}

// Sort the members of each candidate by id: most of what follows goes by id, too.
static void sort_members(finder *f) {
    mspringi_grids *grids = f->grids;
    const uint32_t particles = (uint32_t)f->graph->builder->particle_count, count = f->end - f->first;
    for (uint32_t candidate = 0; candidate < count; ++candidate)
        f->springs[candidate].ends = grids->first_member[f->first + candidate];
    for (uint32_t p = 0; count > 0 && p < particles; ++p)
        if (f->places[p].grid - f->first < count)
            grids->members[f->springs[f->places[p].grid - f->first].ends++] = p;
    memset(f->springs, 0, count * sizeof *f->springs);
}

mspring_result mspringi_grids_begin_evaluation(mspringi_grids *grids, mspringi_memory *memory,
                                               mspringi_message *message) {
    finder *f = grids->finder;
    grids->first_member[f->end] = grids->member_count;
    f->next_member = grids->first_member[f->first];
    f->springs = mspringi_alloc_unset(memory, f->end - f->first, sizeof *f->springs);
    if (!f->springs)
        return out_of_memory(f->graph, message);
    sort_members(f);
    return MSPRING_OK;
}

uint32_t mspringi_grids_candidate_count(const mspringi_grids *grids) {
    return grids->finder->end - grids->finder->first;
}

uint32_t mspringi_grids_candidate_member_count(const mspringi_grids *grids) {
    return grids->member_count - grids->first_member[grids->finder->first];
}

void mspringi_grids_count_springs(mspringi_grids *grids, uint32_t first, uint32_t end) {
    const finder *f = grids->finder;
    const mspringi_graph *graph = f->graph;
    const uint32_t *members = grids->members + grids->first_member[f->first];
    for (uint32_t m = first; m < end; ++m) {
        const uint32_t at = members[m];
        const grid_place *here = &f->places[at];
        uint32_t inner_ends = 0;
        for (uint32_t i = graph->first[at]; i < graph->first[at + 1]; ++i) {
            const grid_place *there = &f->places[graph->others[i]];
            inner_ends += there->grid == here->grid && abs(there->column - here->column) <= 1 &&
                          abs(there->row - here->row) <= 1;
        }
        f->springs[here->grid - f->first].ends += graph->first[at + 1] - graph->first[at];
        f->springs[here->grid - f->first].inner_ends += inner_ends;
    }
}

// Find the lowest column and row.
static void find_bounds(finder *f, const uint32_t *members, uint32_t count) {
    f->min_column = f->min_row = 0; // of the seed
    for (uint32_t m = 0; m < count; ++m) {
        const grid_place *place = &f->places[members[m]];
        f->min_column = place->column < f->min_column ? place->column : f->min_column;
        f->min_row = place->row < f->min_row ? place->row : f->min_row;
    }
}

// Cost of sweeping a grid, in blocks: its blocks, and about one to start each run of consecutive blocks.
// transposed: with columns and rows swapped.
static uint64_t count_runs(finder *f, const uint32_t *members, uint32_t members_count, bool transposed) {
    uint32_t *last_of_row = (uint32_t *)(void *)f->scratch, count = 0; // no more rows than members
    memset(last_of_row, 0xff, members_count * sizeof *last_of_row);
    for (uint32_t m = 0; m < members_count; ++m) {
        const uint32_t x = (uint32_t)(f->places[members[m]].column - f->min_column),
                       y = (uint32_t)(f->places[members[m]].row - f->min_row), row = transposed ? x : y,
                       column_block = (transposed ? y : x) / MSPRINGI_WIDTH;
        if (last_of_row[row] != column_block)
            f->keys[count++] = (uint64_t)row << 32 | column_block;
        last_of_row[row] = column_block;
    }
    mspringi_sort_keys(f->keys, f->scratch, count);
    f->blocks = f->runs = 0;
    for (uint32_t i = 0; i < count; ++i) {
        f->blocks += i == 0 || f->keys[i] != f->keys[i - 1];
        f->runs += i == 0 || f->keys[i] > f->keys[i - 1] + 1;
    }
    return (uint64_t)f->blocks + f->runs;
}

// True if neighbours that fill so many blocks pay.
static bool fill_blocks(size_t neighbours, size_t blocks) {
    return neighbours * SLOTS_PER_SPRING >= blocks * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH;
}

// True if sweeping a candidate's rows pays, by the terms of a search. Sets the better orientation.
static bool is_worth_sweeping(finder *f, grid_search search, uint32_t candidate, const uint32_t *members,
                              uint32_t count, bool *transposed) {
    const grid_springs *springs = &f->springs[candidate];
    const size_t neighbours = springs->inner_ends / 2;
    if (!has_enough_springs(search, neighbours, springs->ends - neighbours) ||
        !fill_blocks(neighbours, (count + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH))
        return false;
    find_bounds(f, members, count);
    uint64_t cost[2];
    uint32_t blocks[2];
    for (int turned = 0; turned < 2; ++turned) {
        cost[turned] = count_runs(f, members, count, turned != 0);
        blocks[turned] = f->blocks;
    }
    *transposed = cost[1] < cost[0];
    return fill_blocks(neighbours, blocks[*transposed]);
}

static void reject(finder *f, const uint32_t *members, uint32_t count) {
    for (uint32_t m = 0; m < count; ++m)
        f->places[members[m]].grid = MSPRING_NONE;
}

// Keep a grid, behind those already kept.
static void accept(finder *f, const uint32_t *members, uint32_t count, bool transposed) {
    mspringi_grids *grids = f->grids;
    uint32_t to = grids->first_member[grids->count];
    for (uint32_t m = 0; m < count; ++m) {
        const uint32_t p = members[m], column = (uint32_t)(f->places[p].column - f->min_column),
                       row = (uint32_t)(f->places[p].row - f->min_row);
        f->places[p].grid = TAKEN;
        grids->grid_of[p] = grids->count;
        grids->column[p] = transposed ? row : column;
        grids->row[p] = transposed ? column : row;
        f->kinds[p] = MSPRINGI_ROW_LATTICE;
        grids->members[to++] = p;
    }
    grids->first_member[++grids->count] = to;
}

void mspringi_grids_evaluate(mspringi_grids *grids, uint32_t first, uint32_t end) {
    finder *f = grids->finder;
    for (uint32_t candidate = first; candidate < end; ++candidate) {
        const uint32_t begin = f->next_member, behind = grids->first_member[f->first + candidate + 1];
        const uint32_t *members = grids->members + begin;
        bool transposed = false;
        if (is_worth_sweeping(f, f->search, candidate, members, behind - begin, &transposed)) {
            accept(f, members, behind - begin, transposed);
        } else {
            f->has_partial = f->has_partial || (f->search == SEARCH_ALIGNED &&
                                                is_worth_sweeping(f, SEARCH_PARTIAL, candidate, members,
                                                                  behind - begin, &transposed));
            reject(f, members, behind - begin);
        }
        f->next_member = behind;
    }
}

/* ---------------------------------------------------------------------------------------------------- the whole */

static void free_finder(finder *f, mspringi_memory *memory) {
    if (!f)
        return;
    void *const blocks[] = {f->places, f->cell, f->keys, f->scratch, f->springs, f};
    for (size_t i = 0; i < sizeof blocks / sizeof blocks[0]; ++i)
        mspringi_free(memory, blocks[i]);
}

mspring_result mspringi_grids_begin(mspringi_grids *grids, const mspringi_graph *graph, uint8_t *kinds,
                                    mspringi_memory *memory, mspringi_message *message) {
    const size_t particles = graph->builder->particle_count;
    size_t table = 16;
    while (table < 2 * particles)
        table *= 2;
    finder *f = grids->finder = mspringi_alloc(memory, 1, sizeof *f);
    grids->grid_of = mspringi_alloc_unset(memory, particles, sizeof *grids->grid_of);
    grids->column = mspringi_alloc_unset(memory, particles, sizeof *grids->column);
    grids->row = mspringi_alloc_unset(memory, particles, sizeof *grids->row);
    grids->members = mspringi_alloc_unset(memory, particles, sizeof *grids->members);
    grids->first_member = mspringi_alloc_unset(memory, particles + 1, sizeof *grids->first_member);
    grids->place = mspringi_alloc(memory, graph->builder->spring_count, sizeof *grids->place);
    if (f) {
        f->graph = graph;
        f->grids = grids;
        f->kinds = kinds;
        f->cell_mask = table - 1;
        f->places = mspringi_alloc_unset(memory, particles, sizeof *f->places);
        f->cell = mspringi_alloc(memory, table, sizeof *f->cell);
        f->keys = mspringi_alloc_unset(memory, particles, sizeof *f->keys);
        f->scratch = mspringi_alloc_unset(memory, particles, sizeof *f->scratch);
    }
    if (!f || !grids->grid_of || !grids->column || !grids->row || !grids->members || !grids->first_member ||
        !grids->place || !f->places || !f->cell || !f->keys || !f->scratch)
        return out_of_memory(graph, message);
    f->steps[0] = (mspringi_grid_step *)(void *)f->keys;
    f->steps[1] = (mspringi_grid_step *)(void *)f->scratch;
    memset(grids->grid_of, 0xff, particles * sizeof *grids->grid_of);
    for (size_t p = 0; p < particles; ++p)
        f->places[p] = (grid_place){.x = graph->builder->particles[p].x,
                                    .y = graph->builder->particles[p].y,
                                    .grid = kinds[p] == MSPRINGI_ROW_LOOSE ? MSPRING_NONE : TAKEN};
    return MSPRING_OK;
}

void mspringi_grids_end_search(mspringi_grids *grids, mspringi_memory *memory) {
    finder *f = grids->finder;
    if (f->end > f->first && f->search + 1 < MSPRINGI_GRID_SEARCHES)
        memset(f->cell, 0, (f->cell_mask + 1) * sizeof *f->cell);
    mspringi_free(memory, f->springs);
    f->springs = NULL;
    f->first = f->end = grids->count;
    f->next_member = grids->member_count = grids->first_member[grids->count];
    f->seed = 0;
    if (++f->search < MSPRINGI_GRID_SEARCHES)
        return;
    grids->found_count = grids->count;
    free_finder(f, memory);
    grids->finder = NULL;
}

void mspringi_grids_destroy(mspringi_grids *grids, mspringi_memory *memory) {
    free_finder(grids->finder, memory);
    mspringi_shelver_destroy(grids->shelver, memory);
    mspringi_free(memory, grids->grid_of);
    mspringi_free(memory, grids->column);
    mspringi_free(memory, grids->row);
    mspringi_free(memory, grids->members);
    mspringi_free(memory, grids->first_member);
    mspringi_free(memory, grids->place);
}

uint8_t mspringi_grids_place_spring(const mspringi_grids *grids, const mspringi_spring *spring) {
    // By columns and rows from a to b. The base is in the left column or, if both are equal, in the lower row.
    static const uint8_t places[3][3] = {
        {PLACE(NORTH_EAST) | MSPRINGI_FROM_B, PLACE(EAST) | MSPRINGI_FROM_B, PLACE(SOUTH_EAST) | MSPRINGI_FROM_B},
        {PLACE(NORTH) | MSPRINGI_FROM_B, 0, PLACE(NORTH)},
        {PLACE(SOUTH_EAST), PLACE(EAST), PLACE(NORTH_EAST)}};
    const uint32_t a = spring->a, b = spring->b;
    if (grids->grid_of[a] == MSPRING_NONE || grids->grid_of[a] != grids->grid_of[b])
        return 0;
    const uint32_t right = grids->column[b] - grids->column[a] + 1, up = grids->row[b] - grids->row[a] + 1;
    return right <= 2 && up <= 2 ? places[right][up] : 0;
}

/// @file lattices.c
/// Search for lattices. It follows springs from a seed, breadth first, and puts particles into cells. There are
/// three searches, each among the particles that are left: for lattices along the axes, for lattices that are
/// turned, oblong or bent, and for lattices along the axes with half of the springs.
///
/// SPDX-License-Identifier: MIT
#include "arrange.h"

#include <math.h>
#include <stdlib.h>

typedef enum search { ALIGNED, CURVED, PARTIAL, SEARCHES } search;

/// Most springs of a seed in the search for bent lattices.
#define MOST_SEED_SPRINGS 16u

/// Ways to the next column and to the next row, m.
typedef struct basis {
    spec_vector column, row;
} basis;

typedef struct finder {
    spec_arrangement *a;
    search search;
    uint32_t number; ///< of the present lattice
    basis aligned;   ///< of lattices along the axes
    basis *bases;    ///< [particles] of others
} finder;

static spec_vector way_of(const spec_arrangement *a, uint32_t from, uint32_t to) {
    return (spec_vector){(float)(a->x[to] - a->x[from]), (float)(a->y[to] - a->y[from])};
}

static spec_vector sum(spec_vector a, spec_vector b) {
    return (spec_vector){a.x + b.x, a.y + b.y};
}

static spec_vector scaled(spec_vector a, float by) {
    return (spec_vector){a.x * by, a.y * by};
}

static float cross(spec_vector a, spec_vector b) {
    return a.x * b.y - a.y * b.x;
}

static float square_of(spec_vector a) {
    return a.x * a.x + a.y * a.y;
}

static bool is_free(const spec_arrangement *a, uint32_t p) {
    return a->kinds[p] == SPEC_LOOSE && a->lattice[p] == 0;
}

static uint32_t degree_of(const spec_arrangement *a, uint32_t p) {
    return a->first[p + 1] - a->first[p];
}

/* -------------------------------------------------------------------------------------------------------- bases */

// Cells that a way leads, if it ends at most 0.3 of a cell off one of the nine nearest.
static bool find_cell(basis b, spec_vector way, int32_t cell[2]) {
    const float area = cross(b.column, b.row), off[2] = {cross(way, b.row) / area, cross(b.column, way) / area};
    for (int i = 0; i < 2; i++) {
        cell[i] = off[i] > 0.5f ? 1 : off[i] < -0.5f ? -1 : 0;
        if (!(fabsf(off[i] - (float)cell[i]) <= 0.3f)) {
            return false;
        }
    }
    return true;
}

// True if two ways are far from parallel.
static bool is_spanned(spec_vector a, spec_vector b) {
    const float longest = sqrtf(square_of(a)) * sqrtf(square_of(b));
    return fabsf(cross(a, b)) >= 0.8f * longest && longest > 0.0f;
}

// A basis of two ways: columns go right, rows up.
static basis basis_of(spec_vector a, spec_vector b) {
    const bool is_in_order = fabsf(a.x) * fabsf(b.y) >= fabsf(a.y) * fabsf(b.x);
    const spec_vector column = is_in_order ? a : b, row = is_in_order ? b : a;
    return (basis){scaled(column, column.x < 0.0f ? -1.0f : 1.0f), scaled(row, row.y < 0.0f ? -1.0f : 1.0f)};
}

// A square basis from a seed's shortest spring along an axis. False if there is none.
static bool find_aligned_basis(finder *f, uint32_t seed) {
    const spec_arrangement *a = f->a;
    float shortest = 0.0f;
    for (uint32_t i = a->first[seed]; i < a->first[seed + 1]; i++) {
        const uint32_t other = spec_other_end(a, a->springs[i], seed);
        const spec_vector way = way_of(a, seed, other);
        const float dx = fabsf(way.x), dy = fabsf(way.y), along = dx > dy ? dx : dy, across = dx > dy ? dy : dx;
        if (is_free(a, other) && across <= 0.3f * along && (shortest == 0.0f || along < shortest)) {
            shortest = along;
        }
    }
    f->aligned = (basis){{shortest, 0.0f}, {0.0f, shortest}};
    return shortest > 0.0f;
}

// A basis from a seed's shortest spring and the one that puts most of its springs into cells. False if there is
// none.
static bool find_curved_basis(const finder *f, uint32_t seed) {
    const spec_arrangement *a = f->a;
    spec_vector ways[MOST_SEED_SPRINGS];
    uint32_t count = 0, most = 0;
    for (uint32_t i = a->first[seed]; degree_of(a, seed) <= MOST_SEED_SPRINGS && i < a->first[seed + 1]; i++) {
        const uint32_t other = spec_other_end(a, a->springs[i], seed);
        const spec_vector way = way_of(a, seed, other);
        if (!is_free(a, other)) {
            continue;
        }
        uint32_t at = count++; // the shortest first
        for (; at > 0 && square_of(way) < square_of(ways[at - 1]); at--) {
            ways[at] = ways[at - 1];
        }
        ways[at] = way;
    }
    for (uint32_t i = 1; i < count; i++) {
        const basis b = basis_of(ways[0], ways[i]);
        uint32_t fits = 0;
        int32_t cell[2];
        for (uint32_t k = 0; is_spanned(ways[0], ways[i]) && k < count; k++) {
            fits += find_cell(b, ways[k], cell);
        }
        if (fits > most) {
            most = fits;
            f->bases[seed] = b;
        }
    }
    return most > 0;
}

// Fit a particle's basis to its neighbours in the nearest eight cells: least squares of the ways to them, and of
// the difference from the mean of their bases, with the weight of four neighbours.
static void fit_basis(const finder *f, uint32_t p) {
    const spec_arrangement *a = f->a;
    basis bases = {{0.0f, 0.0f}, {0.0f, 0.0f}}, ways = bases;
    float columns = 0.0f, rows = 0.0f, both = 0.0f;
    int count = 0;
    for (uint32_t i = a->first[p]; i < a->first[p + 1]; i++) {
        const uint32_t other = spec_other_end(a, a->springs[i], p);
        const bool is_member = a->lattice[other] == f->number;
        const int32_t dc = is_member ? a->column[other] - a->column[p] : 0,
                      dr = is_member ? a->row[other] - a->row[p] : 0;
        if ((dc == 0 && dr == 0) || abs(dc) > 1 || abs(dr) > 1) {
            continue;
        }
        const spec_vector way = way_of(a, p, other);
        bases = (basis){sum(bases.column, f->bases[other].column), sum(bases.row, f->bases[other].row)};
        ways = (basis){sum(ways.column, scaled(way, (float)dc)), sum(ways.row, scaled(way, (float)dr))};
        columns += (float)(dc * dc);
        rows += (float)(dr * dr);
        both += (float)(dc * dr);
        count++;
    }
    if (count == 0) {
        return;
    }
    const float share = 1.0f / (float)count;
    const basis mean = {scaled(bases.column, share), scaled(bases.row, share)};
    columns = columns + 4.0f;
    rows = rows + 4.0f;
    const float per = 1.0f / (columns * rows - both * both);
    const spec_vector of_column = sum(ways.column, scaled(mean.column, 4.0f));
    const spec_vector of_row = sum(ways.row, scaled(mean.row, 4.0f));
    const basis best = {scaled(sum(scaled(of_column, rows), scaled(of_row, -both)), per),
                        scaled(sum(scaled(of_row, columns), scaled(of_column, -both)), per)};
    f->bases[p] = is_spanned(best.column, best.row) ? best : mean;
}

/* ------------------------------------------------------------------------------------------------------- search */

static bool is_taken(const spec_arrangement *a, uint32_t count, int32_t column, int32_t row) {
    for (uint32_t i = 0; i < count; i++) {
        if (a->column[a->queue[i]] == column && a->row[a->queue[i]] == row) {
            return true;
        }
    }
    return false;
}

// Put a seed and all that springs reach from it into the cells of one lattice. Return the count.
static uint32_t spread(const finder *f, uint32_t seed) {
    const spec_arrangement *a = f->a;
    uint32_t count = 1;
    a->queue[0] = seed;
    a->column[seed] = a->row[seed] = 0;
    a->lattice[seed] = f->number;
    for (uint32_t head = 0; head < count; head++) {
        const uint32_t p = a->queue[head];
        if (f->search == CURVED) {
            fit_basis(f, p);
        }
        const basis b = f->search == CURVED ? f->bases[p] : f->aligned;
        for (uint32_t i = a->first[p]; i < a->first[p + 1]; i++) {
            const uint32_t other = spec_other_end(a, a->springs[i], p);
            int32_t cell[2];
            if (!is_free(a, other) || !find_cell(b, way_of(a, p, other), cell) ||
                is_taken(a, count, a->column[p] + cell[0], a->row[p] + cell[1])) {
                continue;
            }
            a->column[other] = a->column[p] + cell[0];
            a->row[other] = a->row[p] + cell[1];
            a->lattice[other] = f->number;
            f->bases[other] = b;
            a->queue[count++] = other;
        }
    }
    return count;
}

// Blocks of a lattice plus runs of consecutive blocks, with rows along `column`.
static uint32_t cost_of(const spec_arrangement *a, uint32_t count, const int32_t *column, const int32_t *row,
                        uint32_t *blocks) {
    uint64_t *keys = spec_make(count, sizeof *keys);
    uint32_t runs = 0;
    *blocks = 0;
    for (uint32_t i = 0; i < count; i++) {
        keys[i] = (uint64_t)row[a->queue[i]] << 32 | (uint32_t)(column[a->queue[i]] / SPEC_BLOCK);
    }
    qsort(keys, count, sizeof *keys, spec_compare_keys);
    for (uint32_t i = 0; i < count; i++) {
        *blocks += i == 0 || keys[i] != keys[i - 1];
        runs += i == 0 || keys[i] > keys[i - 1] + 1;
    }
    free(keys);
    return *blocks + runs;
}

// Count columns and rows from 0, and choose the way of the rows: that of less cost, x if both are alike. Return the
// blocks.
static uint32_t orient(const spec_arrangement *a, uint32_t count) {
    int32_t column = 0, row = 0;
    uint32_t blocks, blocks_along_y;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t p = a->queue[i];
        column = a->column[p] < column ? a->column[p] : column;
        row = a->row[p] < row ? a->row[p] : row;
    }
    for (uint32_t i = 0; i < count; i++) {
        a->column[a->queue[i]] -= column;
        a->row[a->queue[i]] -= row;
    }
    const bool is_along_y =
        cost_of(a, count, a->row, a->column, &blocks_along_y) < cost_of(a, count, a->column, a->row, &blocks);
    for (uint32_t i = 0; is_along_y && i < count; i++) {
        const uint32_t p = a->queue[i];
        const int32_t kept = a->column[p];
        a->column[p] = a->row[p];
        a->row[p] = kept;
    }
    return is_along_y ? blocks_along_y : blocks;
}

// True if a lattice is kept: few springs of its particles are not between its cells, and springs fill at least a
// sixth of the places in its blocks.
static bool is_worth_keeping(const finder *f, uint32_t count) {
    const spec_arrangement *a = f->a;
    uint32_t inner = 0, ends = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t p = a->queue[i];
        ends += degree_of(a, p);
        for (uint32_t k = a->first[p]; k < a->first[p + 1]; k++) {
            inner += spec_joins_cells(a, a->springs[k]);
        }
    }
    inner /= 2;
    const uint32_t all = ends - inner, outer = all - inner, blocks = orient(a, count);
    const bool has_enough = f->search == ALIGNED  ? outer * 64 <= all
                            : f->search == CURVED ? outer * 16 <= all
                                                  : outer <= inner;
    return has_enough && inner * 6 >= blocks * 4 * SPEC_BLOCK;
}

// Search once. Particles of lattices that are not kept take part in the next search.
static void search_once(finder *f) {
    spec_arrangement *a = f->a;
    const uint32_t particles = a->network->particle_count, first = a->lattice_count;
    uint32_t *kept = spec_make(particles + 1, sizeof *kept), found = 0;
    for (uint32_t seed = 0; seed < particles; seed++) {
        if (!is_free(a, seed) ||
            !(f->search == CURVED ? find_curved_basis(f, seed) : find_aligned_basis(f, seed))) {
            continue;
        }
        f->number = first + ++found;
        kept[found] = is_worth_keeping(f, spread(f, seed)) ? ++a->lattice_count : 0;
    }
    for (uint32_t p = 0; p < particles; p++) {
        a->lattice[p] = a->lattice[p] > first ? kept[a->lattice[p] - first] : a->lattice[p];
        a->kinds[p] = a->lattice[p] > 0 ? SPEC_LATTICE : a->kinds[p];
    }
    free(kept);
}

void spec_find_lattices(spec_arrangement *a) {
    finder f = {.a = a, .bases = spec_make(a->network->particle_count, sizeof *f.bases)};
    for (; f.search < SEARCHES; f.search++) {
        search_once(&f);
    }
    free(f.bases);
}

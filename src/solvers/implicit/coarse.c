/// Coarse matrix: assembly of Z^T A Z, block Cholesky factorisation, solution.
#include "solvers/implicit/coarse.h"

#include <math.h>
#include <string.h>

#include "base/assert.h"
#include "base/cpu.h"

/// Entries of a block of the matrix.
#define BLOCK_VALUES ((size_t)MSPRINGI_RIGID * MSPRINGI_RIGID)

/// Cell edges to prefetch: their factors lie scattered over the rows' records.
#define AHEAD 12

/* ---------------------------------------------------------------------------------------------------- entries */

// Tiles have more columns than cells, and longer ones. Without rows, these cannot be counted, and however few tiles
// there are, as where all is pinned, there may be one to each cell later.
double mspringi_coarse_cost(const mspringi_tiles *tiles) {
    const double values = (double)mspringi_tiles_cell_values(tiles);
    const double times =
        tiles->cells.has_rows && values > 0.0 ? (double)mspringi_tiles_coarse_values(tiles) / values : 1.0;
    return tiles->cells.cost * (times * times);
}

// List a tile's entries: all tiles of the earlier cells in its row, and those of its own cell up to itself. Returns
// where they end.
static size_t list_entries(const mspringi_coarse *coarse, const mspringi_tiles *tiles, uint32_t cell, uint32_t tile,
                           size_t at) {
    const mspringi_cells *cells = &tiles->cells;
    for (uint32_t i = cells->first_before[cell]; i <= cells->first_before[cell + 1]; ++i) {
        const bool is_own = i == cells->first_before[cell + 1];
        const uint32_t other = is_own ? cell : cells->before[i];
        const uint32_t end = is_own ? tile + 1 : tiles->first_of_cell[other + 1];
        for (uint32_t t = tiles->first_of_cell[other]; t < end; ++t)
            coarse->entries[at++] = t;
    }
    return at;
}

void mspringi_coarse_shape(mspringi_coarse *coarse, const mspringi_tiles *tiles) {
    size_t at = 0;
    coarse->count = tiles->count;
    for (uint32_t cell = 0; cell < tiles->cells.count; ++cell) {
        for (uint32_t t = tiles->first_of_cell[cell]; t < tiles->first_of_cell[cell + 1]; ++t) {
            coarse->first[t] = at;
            at = list_entries(coarse, tiles, cell, t, at);
        }
    }
    coarse->first[coarse->count] = at;
    coarse->value_count = BLOCK_VALUES * at;
}

mspring_result mspringi_coarse_create(mspringi_coarse *coarse, const mspringi_tiles *tiles, mspringi_memory *memory,
                                      mspringi_message *message) {
    *coarse = (mspringi_coarse){0};
    const size_t entries = tiles->value_capacity / BLOCK_VALUES + 1;
    coarse->first = mspringi_alloc(memory, (size_t)tiles->capacity + 1, sizeof *coarse->first);
    coarse->place = mspringi_alloc(memory, tiles->capacity, sizeof *coarse->place);
    coarse->restricted = mspringi_alloc(memory, tiles->capacity, sizeof *coarse->restricted);
    // Most of these are room for what tiles may become; they are set where they are used.
    coarse->values = mspringi_alloc_unset(memory, tiles->value_capacity, sizeof *coarse->values);
    coarse->kept = mspringi_alloc_unset(memory, tiles->value_capacity, sizeof *coarse->kept);
    coarse->entries = mspringi_alloc_unset(memory, entries, sizeof *coarse->entries);
    coarse->far_turns = mspringi_alloc_unset(memory, entries, sizeof *coarse->far_turns);
    if (coarse->first && coarse->place && coarse->restricted && coarse->values && coarse->kept && coarse->entries &&
        coarse->far_turns) {
        mspringi_coarse_shape(coarse, tiles);
        return MSPRING_OK;
    }
    mspringi_coarse_destroy(coarse, memory);
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for a coarse matrix of %u tiles",
                         (unsigned)tiles->count);
}

#define ARRAY(member) MSPRINGI_ARRAY_ENTRY(mspringi_coarse, member, MSPRINGI_ARRAY)
static const mspringi_array_entry columns[] = {
    ARRAY(first), ARRAY(entries), ARRAY(place), ARRAY(values), ARRAY(kept), ARRAY(far_turns), ARRAY(restricted),
};
const mspringi_array_table mspringi_coarse_columns = MSPRINGI_ARRAY_TABLE(columns);

void mspringi_coarse_destroy(mspringi_coarse *coarse, mspringi_memory *memory) {
    mspringi_array_table_free(mspringi_coarse_columns, coarse, memory);
    *coarse = (mspringi_coarse){0};
}

void mspringi_coarse_keep(const mspringi_coarse *coarse) {
    memcpy(coarse->kept, coarse->values, coarse->value_count * sizeof *coarse->kept);
}

void mspringi_coarse_restore(const mspringi_coarse *coarse) {
    memcpy(coarse->values, coarse->kept, coarse->value_count * sizeof *coarse->values);
}

/// A block of the matrix: its rows.
typedef double (*block)[MSPRINGI_RIGID];

static block block_of(const mspringi_coarse *coarse, size_t entry) {
    return (block)(coarse->values + BLOCK_VALUES * entry);
}

static size_t diagonal_entry(const mspringi_coarse *coarse, uint32_t tile) {
    return coarse->first[tile + 1] - 1;
}

static block diagonal_of(const mspringi_coarse *coarse, uint32_t tile) {
    return block_of(coarse, diagonal_entry(coarse, tile));
}

/// None: a row has no entry for a tile.
#define NO_ENTRY SIZE_MAX

// The entry of a tile's row for an earlier tile, or for itself.
static size_t find_entry(const mspringi_coarse *coarse, uint32_t tile, uint32_t other) {
    size_t begin = coarse->first[tile], end = coarse->first[tile + 1];
    while (end - begin > 1) {
        const size_t middle = begin + (end - begin) / 2;
        if (coarse->entries[middle] <= other)
            begin = middle;
        else
            end = middle;
    }
    return coarse->entries[begin] == other ? begin : NO_ENTRY;
}

/* --------------------------------------------------------------------------------------------------- assembly */

/// z^T S z of springs between two ends: the parts without an arm, with one, and with both.
typedef struct joint_sum {
    double xx, xy, yy;
    double near_x, near_y, far_x, far_y;
    double near_near, near_far, far_far;
} joint_sum;

static void add_joint(joint_sum *sum, const mspringi_cell_edge *joint, const mspringi_coarse_parts *parts) {
    const float *const f = parts->factors + joint->factors, *const arm_x = parts->iterate->arm_x;
    const float *const arm_y = parts->iterate->arm_y;
    const double pull_x = (double)f[MSPRINGI_PULL_X * MSPRINGI_WIDTH];
    const double pull_y = (double)f[MSPRINGI_PULL_Y * MSPRINGI_WIDTH];
    const double geometric = (double)f[MSPRINGI_GEOMETRIC * MSPRINGI_WIDTH];
    const double xx = geometric + pull_x * pull_x, xy = pull_x * pull_y, yy = geometric + pull_y * pull_y;
    const double near_arm_x = (double)arm_x[joint->slot], near_arm_y = (double)arm_y[joint->slot];
    const double far_arm_x = (double)arm_x[joint->other_slot], far_arm_y = (double)arm_y[joint->other_slot];
    const double near_x = near_arm_x * xy - near_arm_y * xx, near_y = near_arm_x * yy - near_arm_y * xy;
    const double far_x = far_arm_x * xy - far_arm_y * xx, far_y = far_arm_x * yy - far_arm_y * xy;
    sum->xx += xx;
    sum->xy += xy;
    sum->yy += yy;
    sum->near_x += near_x;
    sum->near_y += near_y;
    sum->far_x += far_x;
    sum->far_y += far_y;
    sum->near_near += near_arm_x * near_y - near_arm_y * near_x;
    sum->near_far += near_arm_x * far_y - near_arm_y * far_x;
    sum->far_far += far_arm_x * far_y - far_arm_y * far_x;
}

// Add to the lower triangle of a diagonal block.
static void add_diagonal(block to, double xx, double xy, double yy, double turn_x, double turn_y, double turn) {
    to[0][0] += xx;
    to[1][0] += xy;
    to[1][1] += yy;
    to[2][0] += turn_x;
    to[2][1] += turn_y;
    to[2][2] += turn;
}

// Add springs between two tiles to the rows of the later one. What the earlier one's diagonal gets is the same
// numbers, but for one that is put aside.
static void add_sum(mspringi_coarse *coarse, uint32_t tile, uint32_t other, const joint_sum *sum) {
    const size_t entry = find_entry(coarse, tile, other);
    add_diagonal(diagonal_of(coarse, tile), sum->xx, sum->xy, sum->yy, sum->near_x, sum->near_y, sum->near_near);
    MSPRINGI_ASSERT(entry != NO_ENTRY);
    coarse->far_turns[entry] += sum->far_far;
    const block to = block_of(coarse, entry);
    to[0][0] -= sum->xx;
    to[0][1] -= sum->xy;
    to[0][2] -= sum->far_x;
    to[1][0] -= sum->xy;
    to[1][1] -= sum->yy;
    to[1][2] -= sum->far_y;
    to[2][0] -= sum->near_x;
    to[2][1] -= sum->near_y;
    to[2][2] -= sum->near_far;
}

// Add cell edges, consecutive ones of the same two tiles together.
static void add_joints(mspringi_coarse *coarse, const mspringi_tiles *tiles, const mspringi_coarse_parts *parts,
                       uint32_t first, uint32_t end) {
    const mspringi_cell_edge *const joints = tiles->cells.cell_edges;
    for (uint32_t j = first; j < end;) {
        const uint32_t tile = tiles->of_slot[joints[j].slot], other = tiles->of_slot[joints[j].other_slot];
        joint_sum sum = {0};
        for (; j < end && tiles->of_slot[joints[j].slot] == tile && tiles->of_slot[joints[j].other_slot] == other;
             ++j) {
            if (j + AHEAD < end)
                MSPRINGI_PREFETCH(parts->factors + joints[j + AHEAD].factors);
            add_joint(&sum, &joints[j], parts);
        }
        if (tile != MSPRING_NONE && other != MSPRING_NONE)
            add_sum(coarse, tile, other, &sum);
    }
}

void mspringi_coarse_assemble(mspringi_coarse *coarse, const mspringi_tiles *tiles,
                              const mspringi_coarse_parts *parts, uint32_t first, uint32_t end) {
    const uint32_t first_tile = tiles->first_of_cell[first], end_tile = tiles->first_of_cell[end];
    if (first_tile == end_tile)
        return;
    const size_t begin = coarse->first[first_tile], entries = coarse->first[end_tile] - begin;
    memset(block_of(coarse, begin), 0, entries * BLOCK_VALUES * sizeof *coarse->values);
    memset(coarse->far_turns + begin, 0, entries * sizeof *coarse->far_turns);
    for (uint32_t t = first_tile; t < end_tile; ++t) {
        double sums[2];
        parts->kernels->inertia_of_tile(parts->iterate, parts->mass, tiles->parts + tiles->first_part[t],
                                        tiles->first_part[t + 1] - tiles->first_part[t], sums);
        add_diagonal(diagonal_of(coarse, t), sums[0], 0.0, sums[0], 0.0, 0.0,
                     sums[1] + sums[0] * (double)tiles->turn_inertia);
    }
    // Cell edges belong to the later cell. A cell without tiles, all pinned or asleep, has none that count.
    for (uint32_t cell = first, behind; cell < end; cell = behind + (behind == cell)) {
        for (behind = cell; behind < end && tiles->first_of_cell[behind] < tiles->first_of_cell[behind + 1];)
            ++behind;
        add_joints(coarse, tiles, parts, tiles->cells.first_cell_edge[cell], tiles->cells.first_cell_edge[behind]);
    }
}

void mspringi_coarse_complete(mspringi_coarse *coarse, const mspringi_tiles *tiles,
                              const mspringi_coarse_parts *parts) {
    for (uint32_t t = 0; t < coarse->count; ++t) {
        for (size_t entry = coarse->first[t]; entry < diagonal_entry(coarse, t); ++entry) {
            const block from = block_of(coarse, entry);
            add_diagonal(diagonal_of(coarse, coarse->entries[entry]), -from[0][0], -from[1][0], -from[1][1],
                         -from[0][2], -from[1][2], coarse->far_turns[entry]);
        }
    }
    for (uint32_t a = 0; a < tiles->pin_edge_count; ++a) {
        const uint32_t tile = tiles->of_slot[tiles->pin_edges[a].slot];
        joint_sum sum = {0};
        if (tile == MSPRING_NONE || tile == tiles->of_slot[tiles->pin_edges[a].other_slot])
            continue;
        add_joint(&sum, &tiles->pin_edges[a], parts);
        add_diagonal(diagonal_of(coarse, tile), sum.xx, sum.xy, sum.yy, sum.near_x, sum.near_y, sum.near_near);
    }
}

static bool has_place(const mspringi_coarse *coarse, uint32_t tile, uint32_t other) {
    return find_entry(coarse, tile > other ? tile : other, tile > other ? other : tile) != NO_ENTRY;
}

// Add rows of one tile times those of another to the lower triangle.
static void add_outer(const mspringi_coarse *coarse, const mspringi_coarse_rank_one *pulls, uint32_t i, uint32_t j,
                      double times) {
    const block to = block_of(coarse, find_entry(coarse, pulls->tiles[i], pulls->tiles[j]));
    for (int r = 0; r < MSPRINGI_RIGID; ++r)
        for (int c = 0; c < MSPRINGI_RIGID && (i != j || c <= r); ++c)
            to[r][c] += times * pulls->rows[i][r] * pulls->rows[j][c];
}

void mspringi_coarse_add_rank_one(mspringi_coarse *coarse, const mspringi_coarse_rank_one *pulls) {
    bool is_whole = true;
    for (uint32_t i = 0; i < pulls->count; ++i)
        for (uint32_t j = 0; j < i; ++j)
            is_whole &= has_place(coarse, pulls->tiles[i], pulls->tiles[j]);
    // The square of a sum of n is at most n times the sum of the squares.
    for (uint32_t i = 0; i < pulls->count; ++i)
        add_outer(coarse, pulls, i, i, is_whole ? 1.0 : (double)pulls->count);
    for (uint32_t i = 0; is_whole && i < pulls->count; ++i)
        for (uint32_t j = 0; j < pulls->count; ++j)
            if (pulls->tiles[i] > pulls->tiles[j])
                add_outer(coarse, pulls, i, j, 1.0);
}

/* --------------------------------------------------------------------------------------- factoring and solving */

// sum += a b^T.
static void add_product(block sum, block a, block b) {
    for (int i = 0; i < MSPRINGI_RIGID; ++i)
        for (int j = 0; j < MSPRINGI_RIGID; ++j)
            sum[i][j] += (a[i][0] * b[j][0] + a[i][1] * b[j][1]) + a[i][2] * b[j][2];
}

static void subtract(block to, block sum) {
    for (int i = 0; i < MSPRINGI_RIGID; ++i)
        for (int j = 0; j < MSPRINGI_RIGID; ++j)
            to[i][j] -= sum[i][j];
}

// Factor a diagonal block; own holds what its diagonal was at first.
static void factor_diagonal(block b, const double *own) {
    for (int j = 0; j < MSPRINGI_RIGID; ++j) {
        double pivot = b[j][j];
        for (int k = 0; k < j; ++k)
            pivot -= b[j][k] * b[j][k];
        // The mass alone is more than this part of the springs' stiffness, unless k h^2 / m is beyond 10^12.
        const double least = 1e-13 * own[j];
        pivot = pivot > least ? pivot : least;
        const double reciprocal = pivot > 0.0 ? 1.0 / sqrt(pivot) : 0.0;
        b[j][j] = reciprocal;
        for (int i = j + 1; i < MSPRINGI_RIGID; ++i) {
            double value = b[i][j];
            for (int k = 0; k < j; ++k)
                value -= b[i][k] * b[j][k];
            b[i][j] = value * reciprocal;
        }
    }
}

// to = to L^-T, L being a factored diagonal block.
static void divide_by_diagonal(block to, block l) {
    for (int i = 0; i < MSPRINGI_RIGID; ++i) {
        to[i][0] *= l[0][0];
        to[i][1] = (to[i][1] - to[i][0] * l[1][0]) * l[1][1];
        to[i][2] = (to[i][2] - to[i][0] * l[2][0] - to[i][1] * l[2][1]) * l[2][2];
    }
}

// Of the factor L of a diagonal block, with reciprocals on its diagonal, make (L L^T)^-1, all of it.
static void invert_diagonal(block b) {
    const double l00 = b[0][0], l11 = b[1][1], l22 = b[2][2];
    const double l10 = -b[1][0] * l00 * l11, l21 = -b[2][1] * l11 * l22;
    const double l20 = -(b[2][0] * l00 + b[2][1] * l10) * l22; // these are those of L^-1
    b[0][0] = l00 * l00 + (l10 * l10 + l20 * l20);
    b[0][1] = b[1][0] = l10 * l11 + l20 * l21;
    b[0][2] = b[2][0] = l20 * l22;
    b[1][1] = l11 * l11 + l21 * l21;
    b[1][2] = b[2][1] = l21 * l22;
    b[2][2] = l22 * l22;
}

// to = to L^-1, L being a factored diagonal block.
static void divide_by_factor(block to, block l) {
    for (int i = 0; i < MSPRINGI_RIGID; ++i) {
        to[i][2] *= l[2][2];
        to[i][1] = (to[i][1] - to[i][2] * l[2][1]) * l[1][1];
        to[i][0] = ((to[i][0] - to[i][1] * l[1][0]) - to[i][2] * l[2][0]) * l[0][0];
    }
}

// Subtract what the entries that both rows have before these say. A row's tiles have their places marked.
static void reduce_entry(const mspringi_coarse *coarse, size_t row, size_t entry) {
    const uint32_t tile = coarse->entries[entry];
    double sum[MSPRINGI_RIGID][MSPRINGI_RIGID] = {{0.0}};
    for (size_t other = coarse->first[tile]; other < diagonal_entry(coarse, tile); ++other) {
        const uint32_t place = coarse->place[coarse->entries[other]];
        if (place > 0)
            add_product(sum, block_of(coarse, row + place - 1), block_of(coarse, other));
    }
    subtract(block_of(coarse, entry), sum);
}

// Cholesky's factor, by rows.
static void factor_row(mspringi_coarse *coarse, uint32_t t) {
    const size_t row = coarse->first[t], end = diagonal_entry(coarse, t);
    const block diagonal = block_of(coarse, end);
    const double own[] = {diagonal[0][0], diagonal[1][1], diagonal[2][2]};
    double sum[MSPRINGI_RIGID][MSPRINGI_RIGID] = {{0.0}};
    for (size_t entry = row; entry < end; ++entry)
        coarse->place[coarse->entries[entry]] = (uint32_t)(entry - row) + 1;
    for (size_t entry = row; entry < end; ++entry) {
        reduce_entry(coarse, row, entry);
        divide_by_diagonal(block_of(coarse, entry), diagonal_of(coarse, coarse->entries[entry]));
        add_product(sum, block_of(coarse, entry), block_of(coarse, entry));
    }
    subtract(diagonal, sum);
    factor_diagonal(diagonal, own);
    for (size_t entry = row; entry < end; ++entry)
        coarse->place[coarse->entries[entry]] = 0;
}

// L D L^T in blocks, L having unit blocks on its diagonal: a solution then has only one product after the other to
// wait for from tile to tile, and not three divisions (1800x5: 2.1 microseconds instead of 5.4).
void mspringi_coarse_factor(mspringi_coarse *coarse) {
    for (uint32_t t = 0; t < coarse->count; ++t)
        factor_row(coarse, t);
    for (uint32_t t = 0; t < coarse->count; ++t)
        for (size_t entry = coarse->first[t]; entry < diagonal_entry(coarse, t); ++entry)
            divide_by_factor(block_of(coarse, entry), diagonal_of(coarse, coarse->entries[entry]));
    for (uint32_t t = 0; t < coarse->count; ++t)
        invert_diagonal(diagonal_of(coarse, t));
}

// Subtract the earlier tiles' unknowns from a tile's right-hand side.
static void solve_forward(const mspringi_coarse *coarse, double (*unknowns)[MSPRINGI_RIGID], uint32_t t) {
    double sum[MSPRINGI_RIGID] = {0.0};
    for (size_t entry = coarse->first[t]; entry < diagonal_entry(coarse, t); ++entry) {
        const double *const x = unknowns[coarse->entries[entry]];
        const block b = block_of(coarse, entry);
        for (int i = 0; i < MSPRINGI_RIGID; ++i)
            sum[i] += (b[i][0] * x[0] + b[i][1] * x[1]) + b[i][2] * x[2];
    }
    for (int i = 0; i < MSPRINGI_RIGID; ++i)
        unknowns[t][i] = coarse->restricted[t][i] - sum[i];
}

// Subtract a tile's solved unknowns from the earlier tiles' right-hand sides.
static void solve_backward(const mspringi_coarse *coarse, double (*unknowns)[MSPRINGI_RIGID], uint32_t t) {
    const double *x = unknowns[t], x0 = x[0], x1 = x[1], x2 = x[2];
    for (size_t entry = coarse->first[t]; entry < diagonal_entry(coarse, t); ++entry) {
        double *const before = unknowns[coarse->entries[entry]];
        const block b = block_of(coarse, entry);
        for (int j = 0; j < MSPRINGI_RIGID; ++j)
            before[j] -= (b[0][j] * x0 + b[1][j] * x1) + b[2][j] * x2;
    }
}

double mspringi_coarse_solve(const mspringi_coarse *coarse, double (*unknowns)[MSPRINGI_RIGID]) {
    double sum = 0.0;
    for (uint32_t t = 0; t < coarse->count; ++t)
        solve_forward(coarse, unknowns, t);
    for (uint32_t t = 0; t < coarse->count; ++t) {
        const block inverse = diagonal_of(coarse, t);
        double *x = unknowns[t];
        const double y0 = x[0], y1 = x[1], y2 = x[2];
        for (int i = 0; i < MSPRINGI_RIGID; ++i)
            x[i] = (inverse[i][0] * y0 + inverse[i][1] * y1) + inverse[i][2] * y2;
    }
    for (uint32_t t = coarse->count; t-- > 0;)
        solve_backward(coarse, unknowns, t);
    for (uint32_t t = 0; t < coarse->count; ++t)
        for (int i = 0; i < MSPRINGI_RIGID; ++i)
            sum += coarse->restricted[t][i] * unknowns[t][i];
    return sum;
}

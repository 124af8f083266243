/// Coarse matrix: assembly of Z^T A Z in its envelope, block Cholesky factorisation, solution.
#include "solvers/implicit/coarse.h"

#include <math.h>
#include <string.h>

#include "base/cpu.h"

/// Entries of a block of the matrix.
#define BLOCK_VALUES ((size_t)MSPRINGI_RIGID * MSPRINGI_RIGID)

/// Cell edges to prefetch: their factors lie scattered over the rows' records.
#define AHEAD 12

/* --------------------------------------------------------------------------------------------------- envelope */

double mspringi_coarse_cost(const mspringi_tiles *tiles) {
    double sum = 0.0;
    for (uint32_t cell = 0; cell < tiles->cells.count; ++cell) {
        const uint32_t first = mspringi_tiles_envelope(tiles, cell);
        for (uint32_t t = tiles->first_of_cell[cell]; t < tiles->first_of_cell[cell + 1]; ++t) {
            const double length = (double)MSPRINGI_RIGID * (double)(t - first + 1);
            sum += 0.5 * MSPRINGI_RIGID * length * length;
        }
    }
    return sum;
}

void mspringi_coarse_shape(mspringi_coarse *coarse, const mspringi_tiles *tiles) {
    coarse->count = tiles->count;
    coarse->value_count = 0;
    for (uint32_t cell = 0; cell < tiles->cells.count; ++cell) {
        const uint32_t first = mspringi_tiles_envelope(tiles, cell);
        for (uint32_t t = tiles->first_of_cell[cell]; t < tiles->first_of_cell[cell + 1]; ++t) {
            coarse->first[t] = first;
            coarse->row[t] = coarse->value_count;
            coarse->value_count += (size_t)MSPRINGI_RIGID * MSPRINGI_RIGID * (t - first + 1);
        }
    }
}

mspring_result mspringi_coarse_create(mspringi_coarse *coarse, const mspringi_tiles *tiles, mspringi_memory *memory,
                                      mspringi_message *message) {
    *coarse = (mspringi_coarse){0};
    coarse->first = mspringi_alloc(memory, tiles->capacity, sizeof *coarse->first);
    coarse->row = mspringi_alloc(memory, tiles->capacity, sizeof *coarse->row);
    coarse->restricted = mspringi_alloc(memory, tiles->capacity, sizeof *coarse->restricted);
    // Most of these are room for what tiles may become; they are set where they are used.
    coarse->values = mspringi_alloc_unset(memory, tiles->value_capacity, sizeof *coarse->values);
    coarse->kept = mspringi_alloc_unset(memory, tiles->value_capacity, sizeof *coarse->kept);
    coarse->far_turns =
        mspringi_alloc_unset(memory, tiles->value_capacity / BLOCK_VALUES + 1, sizeof *coarse->far_turns);
    if (coarse->first && coarse->row && coarse->restricted && coarse->values && coarse->kept && coarse->far_turns) {
        mspringi_coarse_shape(coarse, tiles);
        return MSPRING_OK;
    }
    mspringi_coarse_destroy(coarse, memory);
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for a coarse matrix of %u tiles",
                         (unsigned)tiles->count);
}

#define ARRAY(member) MSPRINGI_ARRAY_ENTRY(mspringi_coarse, member, MSPRINGI_ARRAY)
static const mspringi_array_entry columns[] = {
    ARRAY(first), ARRAY(row), ARRAY(values), ARRAY(kept), ARRAY(far_turns), ARRAY(restricted),
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

/// Three rows of the envelope, from the column of tile other on.
typedef struct block_rows {
    double *row[MSPRINGI_RIGID];
} block_rows;

static block_rows rows_of(const mspringi_coarse *coarse, uint32_t tile, uint32_t other) {
    const size_t length = (size_t)MSPRINGI_RIGID * (tile - coarse->first[tile] + 1);
    double *begin = coarse->values + coarse->row[tile] + (size_t)MSPRINGI_RIGID * (other - coarse->first[tile]);
    return (block_rows){{begin, begin + length, begin + 2 * length}};
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
static void add_diagonal(block_rows to, double xx, double xy, double yy, double turn_x, double turn_y,
                         double turn) {
    to.row[0][0] += xx;
    to.row[1][0] += xy;
    to.row[1][1] += yy;
    to.row[2][0] += turn_x;
    to.row[2][1] += turn_y;
    to.row[2][2] += turn;
}

static double *far_turn_of(const mspringi_coarse *coarse, uint32_t tile, uint32_t other) {
    return coarse->far_turns + coarse->row[tile] / BLOCK_VALUES + (other - coarse->first[tile]);
}

// Add springs between two tiles to the rows of the later one. What the earlier one's diagonal gets is the same
// numbers, but for one that is put aside.
static void add_sum(mspringi_coarse *coarse, uint32_t tile, uint32_t other, const joint_sum *sum) {
    add_diagonal(rows_of(coarse, tile, tile), sum->xx, sum->xy, sum->yy, sum->near_x, sum->near_y, sum->near_near);
    *far_turn_of(coarse, tile, other) += sum->far_far;
    const block_rows to = rows_of(coarse, tile, other);
    to.row[0][0] -= sum->xx;
    to.row[0][1] -= sum->xy;
    to.row[0][2] -= sum->far_x;
    to.row[1][0] -= sum->xy;
    to.row[1][1] -= sum->yy;
    to.row[1][2] -= sum->far_y;
    to.row[2][0] -= sum->near_x;
    to.row[2][1] -= sum->near_y;
    to.row[2][2] -= sum->near_far;
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
    const size_t begin = coarse->row[first_tile];
    const size_t values = (end_tile < coarse->count ? coarse->row[end_tile] : coarse->value_count) - begin;
    memset(coarse->values + begin, 0, values * sizeof *coarse->values);
    memset(coarse->far_turns + begin / BLOCK_VALUES, 0, values / BLOCK_VALUES * sizeof *coarse->far_turns);
    for (uint32_t t = first_tile; t < end_tile; ++t) {
        double sums[2];
        parts->kernels->inertia_of_tile(parts->iterate, parts->mass, tiles->parts + tiles->first_part[t],
                                        tiles->first_part[t + 1] - tiles->first_part[t], sums);
        add_diagonal(rows_of(coarse, t, t), sums[0], 0.0, sums[0], 0.0, 0.0,
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
        for (uint32_t other = coarse->first[t]; other < t; ++other) {
            const block_rows from = rows_of(coarse, t, other);
            add_diagonal(rows_of(coarse, other, other), -from.row[0][0], -from.row[1][0], -from.row[1][1],
                         -from.row[0][2], -from.row[1][2], *far_turn_of(coarse, t, other));
        }
    }
    for (uint32_t a = 0; a < tiles->pin_edge_count; ++a) {
        const uint32_t tile = tiles->of_slot[tiles->pin_edges[a].slot];
        joint_sum sum = {0};
        if (tile == MSPRING_NONE || tile == tiles->of_slot[tiles->pin_edges[a].other_slot])
            continue;
        add_joint(&sum, &tiles->pin_edges[a], parts);
        add_diagonal(rows_of(coarse, tile, tile), sum.xx, sum.xy, sum.yy, sum.near_x, sum.near_y, sum.near_near);
    }
}

static bool has_place(const mspringi_coarse *coarse, uint32_t tile, uint32_t other) {
    return tile >= other ? other >= coarse->first[tile] : tile >= coarse->first[other];
}

// Add rows of one tile times those of another to the lower triangle.
static void add_outer(const mspringi_coarse *coarse, const mspringi_coarse_rank_one *pulls, uint32_t i, uint32_t j,
                      double times) {
    const block_rows to = rows_of(coarse, pulls->tiles[i], pulls->tiles[j]);
    for (int r = 0; r < MSPRINGI_RIGID; ++r)
        for (int c = 0; c < MSPRINGI_RIGID && (i != j || c <= r); ++c)
            to.row[r][c] += times * pulls->rows[i][r] * pulls->rows[j][c];
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

// to -= a b^T over count columns.
static void subtract_product(block_rows to, block_rows a, block_rows b, size_t count) {
    double sum[MSPRINGI_RIGID][MSPRINGI_RIGID] = {{0.0}};
    for (size_t k = 0; k < count; ++k)
        for (int i = 0; i < MSPRINGI_RIGID; ++i)
            for (int j = 0; j < MSPRINGI_RIGID; ++j)
                sum[i][j] += a.row[i][k] * b.row[j][k];
    for (int i = 0; i < MSPRINGI_RIGID; ++i)
        for (int j = 0; j < MSPRINGI_RIGID; ++j)
            to.row[i][j] -= sum[i][j];
}

// Factor a diagonal block; own holds what its diagonal was at first.
static void factor_diagonal(block_rows b, const double *own) {
    for (int j = 0; j < MSPRINGI_RIGID; ++j) {
        double pivot = b.row[j][j];
        for (int k = 0; k < j; ++k)
            pivot -= b.row[j][k] * b.row[j][k];
        // The mass alone is more than this part of the springs' stiffness, unless k h^2 / m is beyond 10^12.
        const double least = 1e-13 * own[j];
        pivot = pivot > least ? pivot : least;
        const double reciprocal = pivot > 0.0 ? 1.0 / sqrt(pivot) : 0.0;
        b.row[j][j] = reciprocal;
        for (int i = j + 1; i < MSPRINGI_RIGID; ++i) {
            double value = b.row[i][j];
            for (int k = 0; k < j; ++k)
                value -= b.row[i][k] * b.row[j][k];
            b.row[i][j] = value * reciprocal;
        }
    }
}

// to = to L^-T, L being a factored diagonal block.
static void divide_by_diagonal(block_rows to, block_rows l) {
    for (int i = 0; i < MSPRINGI_RIGID; ++i) {
        to.row[i][0] *= l.row[0][0];
        to.row[i][1] = (to.row[i][1] - to.row[i][0] * l.row[1][0]) * l.row[1][1];
        to.row[i][2] = (to.row[i][2] - to.row[i][0] * l.row[2][0] - to.row[i][1] * l.row[2][1]) * l.row[2][2];
    }
}

// Of the factor L of a diagonal block, with reciprocals on its diagonal, make (L L^T)^-1, all of it.
static void invert_diagonal(block_rows b) {
    const double l00 = b.row[0][0], l11 = b.row[1][1], l22 = b.row[2][2];
    const double l10 = -b.row[1][0] * l00 * l11, l21 = -b.row[2][1] * l11 * l22;
    const double l20 = -(b.row[2][0] * l00 + b.row[2][1] * l10) * l22; // these are those of L^-1
    b.row[0][0] = l00 * l00 + (l10 * l10 + l20 * l20);
    b.row[0][1] = b.row[1][0] = l10 * l11 + l20 * l21;
    b.row[0][2] = b.row[2][0] = l20 * l22;
    b.row[1][1] = l11 * l11 + l21 * l21;
    b.row[1][2] = b.row[2][1] = l21 * l22;
    b.row[2][2] = l22 * l22;
}

// to = to L^-1, L being a factored diagonal block.
static void divide_by_factor(block_rows to, block_rows l) {
    for (int i = 0; i < MSPRINGI_RIGID; ++i) {
        to.row[i][2] *= l.row[2][2];
        to.row[i][1] = (to.row[i][1] - to.row[i][2] * l.row[2][1]) * l.row[1][1];
        to.row[i][0] = ((to.row[i][0] - to.row[i][1] * l.row[1][0]) - to.row[i][2] * l.row[2][0]) * l.row[0][0];
    }
}

// Cholesky's factor, by rows.
static void factor_rows(mspringi_coarse *coarse) {
    for (uint32_t t = 0; t < coarse->count; ++t) {
        const block_rows diagonal = rows_of(coarse, t, t);
        const double own[] = {diagonal.row[0][0], diagonal.row[1][1], diagonal.row[2][2]};
        for (uint32_t s = coarse->first[t]; s <= t; ++s) {
            const uint32_t from = coarse->first[s] > coarse->first[t] ? coarse->first[s] : coarse->first[t];
            const block_rows to = rows_of(coarse, t, s);
            if (from < s)
                subtract_product(to, rows_of(coarse, t, from), rows_of(coarse, s, from),
                                 (size_t)MSPRINGI_RIGID * (s - from));
            if (s < t)
                divide_by_diagonal(to, rows_of(coarse, s, s));
        }
        factor_diagonal(diagonal, own);
    }
}

// L D L^T in blocks, L having unit blocks on its diagonal: a solution then has only one product after the other to
// wait for from tile to tile, and not three divisions (1800x5: 2.1 microseconds instead of 5.4).
void mspringi_coarse_factor(mspringi_coarse *coarse) {
    factor_rows(coarse);
    for (uint32_t t = 0; t < coarse->count; ++t)
        for (uint32_t s = coarse->first[t]; s < t; ++s)
            divide_by_factor(rows_of(coarse, t, s), rows_of(coarse, s, s));
    for (uint32_t t = 0; t < coarse->count; ++t)
        invert_diagonal(rows_of(coarse, t, t));
}

// Subtract the earlier tiles' unknowns from a tile's right-hand side.
static void solve_forward(const mspringi_coarse *coarse, double (*unknowns)[MSPRINGI_RIGID], uint32_t t) {
    const uint32_t first = coarse->first[t];
    const block_rows rows = rows_of(coarse, t, first);
    const double *before = unknowns[first];
    double *x = unknowns[t];
    const size_t count = (size_t)MSPRINGI_RIGID * (t - first);
    // Three sums in each row, so that they do not wait for each other.
    for (int i = 0; i < MSPRINGI_RIGID; ++i) {
        const double *row = rows.row[i];
        double sum[MSPRINGI_RIGID] = {0.0};
        for (size_t k = 0; k < count; k += MSPRINGI_RIGID)
            for (size_t j = 0; j < MSPRINGI_RIGID; ++j)
                sum[j] += row[k + j] * before[k + j];
        x[i] = coarse->restricted[t][i] - ((sum[0] + sum[1]) + sum[2]);
    }
}

// Subtract a tile's solved unknowns from the earlier tiles' right-hand sides.
static void solve_backward(const mspringi_coarse *coarse, double (*unknowns)[MSPRINGI_RIGID], uint32_t t) {
    const uint32_t first = coarse->first[t];
    const block_rows rows = rows_of(coarse, t, first);
    double *before = unknowns[first];
    const double *x = unknowns[t], x0 = x[0], x1 = x[1], x2 = x[2];
    const size_t count = (size_t)MSPRINGI_RIGID * (t - first);
    for (size_t k = 0; k < count; ++k)
        before[k] -= (rows.row[0][k] * x0 + rows.row[1][k] * x1) + rows.row[2][k] * x2;
}

double mspringi_coarse_solve(const mspringi_coarse *coarse, double (*unknowns)[MSPRINGI_RIGID]) {
    double sum = 0.0;
    for (uint32_t t = 0; t < coarse->count; ++t)
        solve_forward(coarse, unknowns, t);
    for (uint32_t t = 0; t < coarse->count; ++t) {
        const block_rows inverse = rows_of(coarse, t, t);
        double *x = unknowns[t];
        const double y0 = x[0], y1 = x[1], y2 = x[2];
        for (int i = 0; i < MSPRINGI_RIGID; ++i)
            x[i] = (inverse.row[i][0] * y0 + inverse.row[i][1] * y1) + inverse.row[i][2] * y2;
    }
    for (uint32_t t = coarse->count; t-- > 0;)
        solve_backward(coarse, unknowns, t);
    for (uint32_t t = 0; t < coarse->count; ++t)
        for (int i = 0; i < MSPRINGI_RIGID; ++i)
            sum += coarse->restricted[t][i] * unknowns[t][i];
    return sum;
}

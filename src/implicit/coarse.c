/// The coarse matrix and its factor.
#include "coarse.h"

#include <math.h>
#include <string.h>

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
    coarse->unknowns = mspringi_alloc(memory, (size_t)MSPRINGI_RIGID * tiles->capacity, sizeof *coarse->unknowns);
    coarse->values = mspringi_alloc(memory, tiles->value_capacity, sizeof *coarse->values);
    if (coarse->first && coarse->row && coarse->unknowns && coarse->values) {
        mspringi_coarse_shape(coarse, tiles);
        return MSPRING_OK;
    }
    mspringi_coarse_destroy(coarse, memory);
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for a coarse matrix of %u tiles",
                         (unsigned)tiles->count);
}

void mspringi_coarse_destroy(mspringi_coarse *coarse, mspringi_memory *memory) {
    mspringi_free(memory, coarse->first);
    mspringi_free(memory, coarse->row);
    mspringi_free(memory, coarse->values);
    mspringi_free(memory, coarse->unknowns);
    *coarse = (mspringi_coarse){0};
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

static void add_joint(joint_sum *sum, const mspringi_joint *joint, const float *factors, mspringi_field arm) {
    const float *f = factors + joint->factors;
    const double pull_x = (double)f[MSPRINGI_PULL_X * MSPRINGI_WIDTH];
    const double pull_y = (double)f[MSPRINGI_PULL_Y * MSPRINGI_WIDTH];
    const double swing = (double)f[MSPRINGI_SWING * MSPRINGI_WIDTH];
    const double xx = swing + pull_x * pull_x, xy = pull_x * pull_y, yy = swing + pull_y * pull_y;
    const double near_arm_x = (double)arm.x[joint->slot], near_arm_y = (double)arm.y[joint->slot];
    const double far_arm_x = (double)arm.x[joint->other_slot], far_arm_y = (double)arm.y[joint->other_slot];
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

// Either may be MSPRING_NONE: that end is pinned.
static void add_sum(mspringi_coarse *coarse, uint32_t tile, uint32_t other, const joint_sum *sum) {
    if (tile != MSPRING_NONE)
        add_diagonal(rows_of(coarse, tile, tile), sum->xx, sum->xy, sum->yy, sum->near_x, sum->near_y,
                     sum->near_near);
    if (other != MSPRING_NONE)
        add_diagonal(rows_of(coarse, other, other), sum->xx, sum->xy, sum->yy, sum->far_x, sum->far_y,
                     sum->far_far);
    if (tile == MSPRING_NONE || other == MSPRING_NONE)
        return;
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

static void add_masses(mspringi_coarse *coarse, const mspringi_tiles *tiles, const float *mass,
                       mspringi_field arm) {
    for (uint32_t t = 0; t < tiles->count; ++t) {
        double sum = 0.0, inertia = 0.0;
        for (uint32_t p = tiles->first_part[t]; p < tiles->first_part[t + 1]; ++p) {
            for (uint32_t lane = 0; lane < MSPRINGI_PART; ++lane) {
                const uint32_t slot = tiles->parts[p].first_slot + lane;
                if (!(tiles->parts[p].lanes >> lane & 1))
                    continue;
                const double x = (double)arm.x[slot], y = (double)arm.y[slot], m = (double)mass[slot];
                sum += m;
                inertia += m * (x * x + y * y);
            }
        }
        add_diagonal(rows_of(coarse, t, t), sum, 0.0, sum, 0.0, 0.0, inertia + sum * (double)tiles->turn_inertia);
    }
}

// Add joints, those of the same two tiles together as far as they follow each other.
static void add_joints(mspringi_coarse *coarse, const mspringi_tiles *tiles, const mspringi_joint *joints,
                       uint32_t count, const float *factors, mspringi_field arm) {
    for (uint32_t j = 0; j < count;) {
        const uint32_t tile = tiles->of_slot[joints[j].slot], other = tiles->of_slot[joints[j].other_slot];
        joint_sum sum = {0};
        for (; j < count && tiles->of_slot[joints[j].slot] == tile && tiles->of_slot[joints[j].other_slot] == other;
             ++j)
            add_joint(&sum, &joints[j], factors, arm);
        add_sum(coarse, tile, other, &sum);
    }
}

void mspringi_coarse_assemble(mspringi_coarse *coarse, const mspringi_tiles *tiles, const float *factors,
                              const float *mass, mspringi_field arm) {
    memset(coarse->values, 0, coarse->value_count * sizeof *coarse->values);
    add_masses(coarse, tiles, mass, arm);
    add_joints(coarse, tiles, tiles->cells.joints, tiles->cells.joint_count, factors, arm);
    add_joints(coarse, tiles, tiles->anchors, tiles->anchor_count, factors, arm);
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

void mspringi_coarse_factor(mspringi_coarse *coarse) {
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

void mspringi_coarse_solve(mspringi_coarse *coarse) {
    for (uint32_t t = 0; t < coarse->count; ++t) {
        const uint32_t first = coarse->first[t];
        const block_rows rows = rows_of(coarse, t, first), l = rows_of(coarse, t, t);
        const double *before = coarse->unknowns + (size_t)MSPRINGI_RIGID * first;
        double *x = coarse->unknowns + (size_t)MSPRINGI_RIGID * t;
        const size_t count = (size_t)MSPRINGI_RIGID * (t - first);
        double sum[MSPRINGI_RIGID] = {0.0};
        for (size_t k = 0; k < count; ++k)
            for (int i = 0; i < MSPRINGI_RIGID; ++i)
                sum[i] += rows.row[i][k] * before[k];
        x[0] = (x[0] - sum[0]) * l.row[0][0];
        x[1] = (x[1] - sum[1] - l.row[1][0] * x[0]) * l.row[1][1];
        x[2] = (x[2] - sum[2] - l.row[2][0] * x[0] - l.row[2][1] * x[1]) * l.row[2][2];
    }
    for (uint32_t t = coarse->count; t-- > 0;) {
        const uint32_t first = coarse->first[t];
        const block_rows rows = rows_of(coarse, t, first), l = rows_of(coarse, t, t);
        double *before = coarse->unknowns + (size_t)MSPRINGI_RIGID * first;
        double *x = coarse->unknowns + (size_t)MSPRINGI_RIGID * t;
        const size_t count = (size_t)MSPRINGI_RIGID * (t - first);
        const double x2 = x[2] * l.row[2][2];
        const double x1 = (x[1] - l.row[2][1] * x2) * l.row[1][1];
        const double x0 = (x[0] - l.row[2][0] * x2 - l.row[1][0] * x1) * l.row[0][0];
        x[0] = x0;
        x[1] = x1;
        x[2] = x2;
        for (size_t k = 0; k < count; ++k)
            before[k] -= (rows.row[0][k] * x0 + rows.row[1][k] * x1) + rows.row[2][k] * x2;
    }
}

/// @file numeric.h
/// Factorisation and solution in one precision and one width of vector: included by factor_table.h, once for each
/// precision.
///
/// A front's columns come in groups of four (two nodes), its rows in tiles of some vectors. With W = L D, an
/// element of column q is
///
///     W_iq = A_iq - sum over p < q of W_ip L_qp,     L_iq = W_iq / D_q
///
/// and is computed in this order, one product at a time. W is kept in a copy of the front, tile by tile, as the
/// innermost loop reads it.
///
/// SPDX-License-Identifier: MIT

/// Columns in a group.
#define GROUP 4
/// Numbers in a vector.
#define LANES (sizeof(VECTOR) / sizeof(REAL))
/// Vectors in the shortest tile: rows come in multiples of MSPRINGI_PAD.
#define SHORTEST (MSPRINGI_PAD / LANES < MSPRINGI_TILE_VECTORS ? MSPRINGI_PAD / LANES : MSPRINGI_TILE_VECTORS)

#define COLUMNS NAME(columns)
#define TILE NAME(tile)
#define CORNER NAME(corner)
#define PAIR NAME(pair)
#define PLACE NAME(place)

/// The columns of one front on their way.
typedef struct COLUMNS {
    REAL *pivots, *border;               ///< L: pivot rows and border rows
    REAL *scaled_pivots, *scaled_border; ///< W
    REAL *reciprocal;                    ///< of D
    size_t count, pivot_rows, border_rows;
} COLUMNS;

MSPRINGI_INLINE VECTOR NAME(load)(const REAL *from) {
    return *(const VECTOR *)(const void *)from;
}
MSPRINGI_INLINE void NAME(store)(REAL *to, VECTOR a) {
    *(VECTOR *)(void *)to = a;
}
MSPRINGI_INLINE VECTOR NAME(load_anywhere)(const REAL *from) {
    return *(const VECTOR_ANYWHERE *)(const void *)from;
}
MSPRINGI_INLINE void NAME(store_anywhere)(REAL *to, VECTOR a) {
    *(VECTOR_ANYWHERE *)(void *)to = a;
}
/// a where the mask has ones, 0 elsewhere.
MSPRINGI_INLINE VECTOR NAME(keep)(VECTOR a, MASK mask) {
    MASK bits;
    memcpy(&bits, &a, sizeof bits);
    bits &= mask;
    memcpy(&a, &bits, sizeof a);
    return a;
}
MSPRINGI_INLINE VECTOR NAME(set)(REAL value) {
    return value - (VECTOR){0};
}

/* ------------------------------------------------------------------------------------------------------- tiles */

/// Rows of one tile: as many vectors as the registers have room for, fewer at the end.
MSPRINGI_INLINE size_t NAME(tile_rows)(size_t rows_left) {
    const size_t vectors = rows_left / LANES;
    size_t fit = MSPRINGI_TILE_VECTORS;
    while (fit > SHORTEST && fit > vectors)
        fit /= 2;
    return fit * LANES;
}

/// What a tile works with: its part of some columns, its rows of W, and the rows of L that belong to the columns.
typedef struct TILE {
    REAL *values;      ///< first column, first row of the tile
    size_t rows;       ///< from a column to the next
    REAL *scaled;      ///< W of the tile: [column][row of the tile]
    const REAL *lower; ///< L in the rows that the columns are the pivots of, first column of the front
    size_t lower_rows; ///< from a column to the next
    size_t before;     ///< columns of the front that come before
} TILE;

/// What a group's own rows come to: 1 / D and L.
typedef struct CORNER {
    REAL reciprocal[GROUP], lower[GROUP][GROUP]; ///< L: [column][row]
} CORNER;

MSPRINGI_INLINE void NAME(subtract)(VECTOR sum[GROUP][MSPRINGI_TILE_VECTORS], const TILE *t, size_t columns,
                                    size_t vectors) {
    const REAL *scaled = t->scaled, *lower = t->lower;
    for (size_t p = 0; p < t->before; p += 2) { // columns come in pairs
        MSPRINGI_UNROLL
        for (size_t q = 0; q < 2; ++q) {
            VECTOR w[MSPRINGI_TILE_VECTORS];
            MSPRINGI_UNROLL
            for (size_t v = 0; v < vectors; ++v)
                w[v] = NAME(load)(scaled + v * LANES);
            MSPRINGI_UNROLL
            for (size_t c = 0; c < columns; ++c) {
                const VECTOR factor = NAME(set)(lower[c]);
                MSPRINGI_UNROLL
                for (size_t v = 0; v < vectors; ++v)
                    sum[c][v] = sum[c][v] - w[v] * factor;
            }
            scaled += vectors * LANES;
            lower += t->lower_rows;
        }
    }
}

/// Subtract the products of the columns before.
MSPRINGI_INLINE void NAME(update_tile)(const TILE *t, size_t columns, size_t vectors) {
    VECTOR sum[GROUP][MSPRINGI_TILE_VECTORS];
    MSPRINGI_UNROLL
    for (size_t c = 0; c < columns; ++c)
        MSPRINGI_UNROLL
    for (size_t v = 0; v < vectors; ++v)
        sum[c][v] = NAME(load)(t->values + c * t->rows + v * LANES);
    NAME(subtract)(sum, t, columns, vectors);
    MSPRINGI_UNROLL
    for (size_t c = 0; c < columns; ++c)
        MSPRINGI_UNROLL
    for (size_t v = 0; v < vectors; ++v)
        NAME(store)(t->values + c * t->rows + v * LANES, sum[c][v]);
}

/// Subtract the products of the columns before, unless that is done, and eliminate the group's columns.
MSPRINGI_INLINE void NAME(eliminate_tile)(const TILE *t, const CORNER *corner, bool updated, size_t columns,
                                          size_t vectors) {
    VECTOR sum[GROUP][MSPRINGI_TILE_VECTORS];
    MSPRINGI_UNROLL
    for (size_t c = 0; c < columns; ++c)
        MSPRINGI_UNROLL
    for (size_t v = 0; v < vectors; ++v)
        sum[c][v] = NAME(load)(t->values + c * t->rows + v * LANES);
    if (!updated)
        NAME(subtract)(sum, t, columns, vectors);
    REAL *scaled = t->scaled + t->before * vectors * LANES;
    MSPRINGI_UNROLL
    for (size_t c = 0; c < columns; ++c) {
        const VECTOR inverse = NAME(set)(corner->reciprocal[c]);
        MSPRINGI_UNROLL
        for (size_t v = 0; v < vectors; ++v) {
            NAME(store)(scaled + (c * vectors + v) * LANES, sum[c][v]);
            NAME(store)(t->values + c * t->rows + v * LANES, sum[c][v] * inverse);
        }
        MSPRINGI_UNROLL
        for (size_t d = c + 1; d < columns; ++d) {
            const VECTOR factor = NAME(set)(corner->lower[c][d]);
            MSPRINGI_UNROLL
            for (size_t v = 0; v < vectors; ++v)
                sum[d][v] = sum[d][v] - sum[c][v] * factor;
        }
    }
}

static void NAME(update)(const TILE *t, size_t columns, size_t vectors) {
#if MSPRINGI_TILE_VECTORS >= 4
    if (SHORTEST == 4 || vectors == 4)
        columns == GROUP ? NAME(update_tile)(t, GROUP, 4) : NAME(update_tile)(t, 2, 4);
    else
#endif
        if (SHORTEST == 2 || vectors == 2)
        columns == GROUP ? NAME(update_tile)(t, GROUP, 2) : NAME(update_tile)(t, 2, 2);
    else
        columns == GROUP ? NAME(update_tile)(t, GROUP, 1) : NAME(update_tile)(t, 2, 1);
}

static void NAME(eliminate)(const TILE *t, const CORNER *corner, bool updated, size_t columns, size_t vectors) {
#if MSPRINGI_TILE_VECTORS >= 4
    if (SHORTEST == 4 || vectors == 4)
        columns == GROUP ? NAME(eliminate_tile)(t, corner, updated, GROUP, 4)
                         : NAME(eliminate_tile)(t, corner, updated, 2, 4);
    else
#endif
        if (SHORTEST == 2 || vectors == 2)
        columns == GROUP ? NAME(eliminate_tile)(t, corner, updated, GROUP, 2)
                         : NAME(eliminate_tile)(t, corner, updated, 2, 2);
    else
        columns == GROUP ? NAME(eliminate_tile)(t, corner, updated, GROUP, 1)
                         : NAME(eliminate_tile)(t, corner, updated, 2, 1);
}

/* ---------------------------------------------------------------------------------------------------- one front */

/// Eliminate a group's own rows, which the columns before have been subtracted from. Returns the column whose pivot
/// is not positive, or columns.
MSPRINGI_INLINE size_t NAME(eliminate_corner)(CORNER *corner, const REAL *values, size_t rows, size_t columns) {
    REAL scaled[GROUP][GROUP];
    MSPRINGI_UNROLL
    for (size_t c = 0; c < columns; ++c) {
        MSPRINGI_UNROLL
        for (size_t i = c; i < columns; ++i) {
            scaled[c][i] = values[c * rows + i];
            MSPRINGI_UNROLL
            for (size_t p = 0; p < c; ++p)
                // What is read was written in the turn of p.
                // cppcheck-suppress uninitvar
                scaled[c][i] = scaled[c][i] - scaled[p][i] * corner->lower[p][c];
        }
        if (!(scaled[c][c] >= SMALLEST && scaled[c][c] <= LARGEST))
            return c;
        corner->reciprocal[c] = (REAL)1 / scaled[c][c];
        MSPRINGI_UNROLL
        for (size_t i = c + 1; i < columns; ++i)
            corner->lower[c][i] = scaled[c][i] * corner->reciprocal[c];
    }
    return columns;
}

/// Eliminate the columns first ... first + columns - 1 in the rows below. Returns the column whose pivot is not
/// positive, or the number of columns in the front.
MSPRINGI_INLINE size_t NAME(eliminate_group)(const COLUMNS *f, size_t first, size_t columns) {
    size_t row = 0, rows = NAME(tile_rows)(f->pivot_rows);
    while (row + rows <= first) {
        row += rows;
        rows = NAME(tile_rows)(f->pivot_rows - row);
    }
    TILE t = {.rows = f->pivot_rows, .lower = f->pivots + first, .lower_rows = f->pivot_rows, .before = first};
    REAL *const values = f->pivots + first * f->pivot_rows;
    t.values = values + row;
    t.scaled = f->scaled_pivots + row * f->count;
    if (first > 0)
        NAME(update)(&t, columns, rows / LANES);
    CORNER corner;
    const size_t done = columns == GROUP ? NAME(eliminate_corner)(&corner, values + first, f->pivot_rows, GROUP)
                                         : NAME(eliminate_corner)(&corner, values + first, f->pivot_rows, 2);
    if (done < columns)
        return first + done;
    for (size_t c = 0; c < columns; c += 2)
        memcpy(f->reciprocal + first + c, corner.reciprocal + c, 2 * sizeof *f->reciprocal);
    NAME(eliminate)(&t, &corner, true, columns, rows / LANES);
    for (row += rows; row < f->pivot_rows; row += rows) {
        rows = NAME(tile_rows)(f->pivot_rows - row);
        t.values = values + row;
        t.scaled = f->scaled_pivots + row * f->count;
        NAME(eliminate)(&t, &corner, false, columns, rows / LANES);
    }
    t.rows = f->border_rows;
    for (row = 0; row < f->border_rows; row += rows) {
        rows = NAME(tile_rows)(f->border_rows - row);
        t.values = f->border + first * f->border_rows + row;
        t.scaled = f->scaled_border + row * f->count;
        NAME(eliminate)(&t, &corner, false, columns, rows / LANES);
    }
    return f->count;
}

/// Subtract the products of all columns from the update matrix, lower triangle.
MSPRINGI_INLINE void NAME(update_border)(const COLUMNS *f, REAL *update, size_t update_columns) {
    TILE t = {.rows = f->border_rows, .lower_rows = f->border_rows, .before = f->count};
    size_t rows;
    for (size_t row = 0; row < f->border_rows; row += rows) {
        rows = NAME(tile_rows)(f->border_rows - row);
        t.scaled = f->scaled_border + row * f->count;
        const size_t end = row + rows < update_columns ? row + rows : update_columns;
        for (size_t first = 0; first < end; first += GROUP) {
            t.values = update + first * f->border_rows + row;
            t.lower = f->border + first;
            NAME(update)(&t, first + GROUP <= update_columns ? GROUP : 2, rows / LANES);
        }
    }
}

/* --------------------------------------------------------------------------------------------------- assembly */

MSPRINGI_INLINE void NAME(add_edges)(REAL *columns, size_t rows, const mspringi_cholesky_entry *entry,
                                     const mspringi_cholesky_entry *end, const MATRIX *matrix) {
    for (; entry < end; ++entry) {
        const REAL xy = matrix->edge_xy[entry->edge];
        REAL *to = columns + entry->to;
        to[0] += matrix->edge_xx[entry->edge];
        to[1] += xy;
        to[rows] += xy;
        to[rows + 1] += matrix->edge_yy[entry->edge];
    }
}

/// Put a front's part of A into its columns, which are zero. 0 + makes 0 of -0, see add_columns().
MSPRINGI_INLINE void NAME(assemble)(const COLUMNS *f, const mspringi_cholesky_symbolic *plan,
                                    const mspringi_front *front, const MATRIX *matrix) {
    const mspringi_cholesky_entry *entries = plan->entries;
    REAL *to = f->pivots;
    for (uint32_t p = 0; p < front->pivot_count; ++p, to += 2 * (f->pivot_rows + 1)) {
        const uint32_t node = plan->order[front->first_pivot + p];
        to[0] = 0 + matrix->node_xx[node];
        to[1] = 0 + matrix->node_xy[node];
        to[f->pivot_rows + 1] = 0 + matrix->node_yy[node];
    }
    NAME(add_edges)(f->pivots, f->pivot_rows, entries + front->first_entry, entries + front->border_entry, matrix);
    NAME(add_edges)(f->border, f->border_rows, entries + front->border_entry, entries + front->end_entry, matrix);
}

/// Where some columns begin, and how far it is from one to the next.
typedef struct NAME(place) {
    REAL *at;
    size_t rows;
} PLACE;

/// Add the first rows rows of some columns to others. A vector may reach beyond them, where it adds 0: nothing
/// there is -0, so nothing changes.
MSPRINGI_INLINE void NAME(add_columns)(PLACE to, PLACE from, size_t columns, size_t rows) {
    const size_t whole = (rows - 1) / LANES * LANES;
    const MASK mask = *(const MASK_ANYWHERE *)(const void *)(NAME(masks) + MSPRINGI_PAD - (rows - whole));
    for (size_t c = 0; c < columns; ++c, to.at += to.rows, from.at += from.rows) {
        for (size_t i = 0; i < whole; i += LANES)
            NAME(store_anywhere)(to.at + i, NAME(load_anywhere)(to.at + i) + NAME(load_anywhere)(from.at + i));
        const VECTOR last = NAME(keep)(NAME(load_anywhere)(from.at + whole), mask);
        NAME(store_anywhere)(to.at + whole, NAME(load_anywhere)(to.at + whole) + last);
    }
}

/// Add the update matrix of a child to a front's columns and its own update matrix.
MSPRINGI_INLINE void NAME(add_child)(const COLUMNS *f, REAL *update, size_t update_columns,
                                     const mspringi_front *child, const mspringi_front_run *runs, REAL *values) {
    const size_t child_rows = mspringi_border_rows(child), child_columns = 2 * (size_t)child->border_count;
    for (uint32_t a = 0; a < child->run_count; ++a) {
        const size_t columns = 2 * (size_t)runs[a].count;
        REAL *const from = values + 2 * runs[a].first * child_rows;
        for (uint32_t b = a; b < child->run_count; ++b) {
            const size_t rows = runs[b].is_pivot ? f->pivot_rows : f->border_rows;
            REAL *const to = !runs[a].is_pivot ? update : runs[b].is_pivot ? f->pivots : f->border;
            const PLACE there = {to + 2 * (runs[a].to * rows + runs[b].to), rows};
            const PLACE here = {from + 2 * (size_t)runs[b].first, child_rows};
            NAME(add_columns)(there, here, columns, 2 * (size_t)runs[b].count);
        }
        REAL *const to = (runs[a].is_pivot ? f->border : update) + 2 * runs[a].to * f->border_rows + update_columns;
        for (size_t c = 0; c < columns; ++c)
            to[c * f->border_rows] += from[c * child_rows + child_columns];
    }
}

/// Factor A. The last row of each border is that of a right side b, whose part for the columns of a front is in
/// vector in the order of elimination; it leaves as D^-1 L^-1 b.
static uint32_t NAME(eliminate_all)(FACTOR *factor, const MATRIX *matrix, REAL *vector) {
    const mspringi_cholesky_symbolic *plan = factor->plan;
    for (uint32_t n = 0; n < plan->front_count; ++n) {
        const mspringi_front *front = &plan->fronts[n];
        COLUMNS f = {.count = 2 * (size_t)front->pivot_count,
                     .pivot_rows = mspringi_pivot_rows(front),
                     .border_rows = mspringi_border_rows(front)};
        f.pivots = factor->panels + front->panel;
        f.border = f.pivots + f.count * f.pivot_rows;
        f.scaled_pivots = factor->scaled;
        f.scaled_border = factor->scaled + f.count * f.pivot_rows;
        f.reciprocal = factor->reciprocal + 2 * (size_t)front->first_pivot;
        REAL *update = factor->updates[front->stack] + front->update;
        const size_t update_columns = 2 * (size_t)front->border_count;
        REAL *const right_side = vector + 2 * (size_t)front->first_pivot, *const row = f.border + update_columns;
        memset(f.pivots, 0, f.count * (f.pivot_rows + f.border_rows) * sizeof *f.pivots);
        memset(update, 0, update_columns * f.border_rows * sizeof *update);
        NAME(assemble)(&f, plan, front, matrix);
        for (size_t c = 0; c < f.count; ++c)
            row[c * f.border_rows] = 0 + right_side[c];
        for (uint32_t c = 0; c < front->child_count; ++c) {
            const mspringi_front *child = &plan->fronts[plan->children[front->first_child + c]];
            REAL *const values = factor->updates[child->stack] + child->update;
            NAME(add_child)(&f, update, update_columns, child, plan->runs + child->first_run, values);
        }
        for (size_t first = 0; first < f.count; first += GROUP) {
            const size_t bad = NAME(eliminate_group)(&f, first, first + GROUP <= f.count ? GROUP : 2);
            if (bad < f.count)
                return plan->order[front->first_pivot + bad / 2];
        }
        NAME(update_border)(&f, update, update_columns);
        for (size_t c = 0; c < f.count; ++c)
            right_side[c] = row[c * f.border_rows];
    }
    return MSPRING_NONE;
}

/* --------------------------------------------------------------------------------------------------- solution */

/// Sum of products in MSPRINGI_PAD partial sums, whatever the width of vectors, that are then added in pairs.
MSPRINGI_INLINE REAL NAME(dot)(const REAL *a, const REAL *b, size_t count) {
    VECTOR sum[MSPRINGI_PAD / LANES];
    REAL part[MSPRINGI_PAD], four[4];
    MSPRINGI_UNROLL
    for (size_t v = 0; v < MSPRINGI_PAD / LANES; ++v)
        sum[v] = NAME(load)(a + v * LANES) * NAME(load)(b + v * LANES);
    for (size_t i = MSPRINGI_PAD; i < count; i += MSPRINGI_PAD) {
        MSPRINGI_UNROLL
        for (size_t v = 0; v < MSPRINGI_PAD / LANES; ++v)
            sum[v] = sum[v] + NAME(load)(a + i + v * LANES) * NAME(load)(b + i + v * LANES);
    }
    memcpy(part, sum, sizeof part);
    for (int i = 0; i < 4; ++i)
        four[i] = (part[i] + part[i + 8]) + (part[i + 4] + part[i + 12]);
    return (four[0] + four[2]) + (four[1] + four[3]);
}

/// y = D^-1 L^-1 b for the pivots of a front, and the rest of b.
MSPRINGI_INLINE void NAME(solve_forward)(const FACTOR *factor, const mspringi_front *front, REAL *y) {
    const size_t columns = 2 * (size_t)front->pivot_count;
    const size_t pivot_rows = mspringi_pivot_rows(front), border_rows = mspringi_border_rows(front);
    const REAL *pivots = factor->panels + front->panel, *border = pivots + columns * pivot_rows;
    const REAL *reciprocal = factor->reciprocal + 2 * (size_t)front->first_pivot;
    const uint32_t *places = factor->plan->border + front->first_border;
    for (size_t p = 0; p < columns; ++p)
        for (size_t i = p + 1; i < columns; ++i)
            y[i] -= pivots[p * pivot_rows + i] * y[p];
    for (size_t row = 0; row < border_rows; row += LANES) {
        VECTOR sum = NAME(set)(0);
        for (size_t p = 0; p < columns; ++p)
            sum = sum + NAME(load)(border + p * border_rows + row) * NAME(set)(y[p]);
        NAME(store)(factor->part + row, sum);
    }
    for (size_t i = 0; i < front->border_count; ++i) {
        REAL *to = factor->vector + 2 * (size_t)places[i];
        to[0] -= factor->part[2 * i];
        to[1] -= factor->part[2 * i + 1];
    }
    for (size_t p = 0; p < columns; ++p)
        y[p] = y[p] * reciprocal[p];
}

/// Two unknowns.
typedef struct PAIR {
    REAL first, second;
} PAIR;

/// Two unknowns without what they have in common with two later ones, which are rows of lower.
MSPRINGI_INLINE PAIR NAME(without)(const REAL *lower, size_t rows, const REAL *y, PAIR later) {
    return (PAIR){(y[0] - lower[1] * later.second) - lower[0] * later.first,
                  (y[1] - lower[rows + 1] * later.second) - lower[rows] * later.first};
}

/// y = L^-T y in the pivot rows. The next two unknowns, which the ones after them wait for, do not go through
/// memory.
MSPRINGI_INLINE void NAME(solve_pivots)(const REAL *lower, size_t rows, size_t columns, REAL *restrict y) {
    PAIR now = {y[columns - 2], y[columns - 1]};
    for (size_t at = columns - 2;; at -= 2) {
        now.first -= lower[at * rows + at + 1] * now.second;
        y[at] = now.first;
        y[at + 1] = now.second;
        if (at == 0)
            return;
        const PAIR next = NAME(without)(lower + (at - 2) * rows + at, rows, y + at - 2, now);
        for (size_t i = 0; i < at - 2; i += 2) {
            const PAIR other = NAME(without)(lower + i * rows + at, rows, y + i, now);
            y[i] = other.first;
            y[i + 1] = other.second;
        }
        now = next;
    }
}

/// x = L^-T y for the pivots of a front.
MSPRINGI_INLINE void NAME(solve_backward)(const FACTOR *factor, const mspringi_front *front, REAL *restrict y) {
    const size_t columns = 2 * (size_t)front->pivot_count, border = 2 * (size_t)front->border_count;
    const size_t pivot_rows = mspringi_pivot_rows(front), border_rows = mspringi_border_rows(front);
    const REAL *pivots = factor->panels + front->panel, *lower = pivots + columns * pivot_rows;
    const uint32_t *places = factor->plan->border + front->first_border;
    REAL *restrict part = factor->part;
    if (border > 0) {
        for (size_t i = 0; i < border; i += 2) {
            part[i] = factor->vector[2 * (size_t)places[i / 2]];
            part[i + 1] = factor->vector[2 * (size_t)places[i / 2] + 1];
        }
        for (size_t i = border; i < border_rows; ++i)
            part[i] = 0; // the row of the right side among them
        for (size_t p = 0; p < columns; ++p)
            y[p] -= NAME(dot)(lower + p * border_rows, part, border_rows);
    }
    NAME(solve_pivots)(pivots, pivot_rows, columns, y);
}

#include "solvers/sparse/band.h"

/* ------------------------------------------------------------------------------------------------ the table's */

MSPRINGI_INLINE void NAME(permute)(const FACTOR *factor, const REAL *x, const REAL *y) {
    for (uint32_t i = 0; i < factor->plan->size; ++i) {
        factor->vector[2 * (size_t)i] = x[factor->plan->order[i]];
        factor->vector[2 * (size_t)i + 1] = y[factor->plan->order[i]];
    }
    memset(factor->vector + 2 * (size_t)factor->plan->size, 0, 2 * sizeof *factor->vector); // see fill_group()
}

static void NAME(solve_all_backward)(const FACTOR *factor, REAL *x, REAL *y) {
    const mspringi_cholesky_symbolic *plan = factor->plan;
    REAL *vector = factor->vector;
    if (plan->band_groups > 0)
        NAME(solve_band_backward)(factor, vector);
    for (uint32_t n = plan->front_count; n-- > 0;)
        NAME(solve_backward)(factor, &plan->fronts[n], vector + 2 * (size_t)plan->fronts[n].first_pivot);
    for (uint32_t i = 0; i < plan->size; ++i) {
        x[plan->order[i]] = vector[2 * (size_t)i];
        y[plan->order[i]] = vector[2 * (size_t)i + 1];
    }
}

/// Factor A; the right side in factor->vector leaves as D^-1 L^-1 b.
static uint32_t NAME(eliminate_matrix)(FACTOR *factor, const MATRIX *matrix) {
    return factor->plan->band_groups > 0 ? NAME(eliminate_band)(factor, matrix, factor->vector)
                                         : NAME(eliminate_all)(factor, matrix, factor->vector);
}

static uint32_t NAME(factor)(FACTOR *factor, const MATRIX *matrix) {
    memset(factor->vector, 0, (2 * (size_t)factor->plan->size + 2) * sizeof *factor->vector);
    return NAME(eliminate_matrix)(factor, matrix);
}

static uint32_t NAME(factor_solve)(FACTOR *factor, const MATRIX *matrix, REAL *x, REAL *y) {
    NAME(permute)(factor, x, y);
    const uint32_t bad = NAME(eliminate_matrix)(factor, matrix);
    if (bad == MSPRING_NONE)
        NAME(solve_all_backward)(factor, x, y);
    return bad;
}

static void NAME(solve)(FACTOR *factor, REAL *x, REAL *y) {
    const mspringi_cholesky_symbolic *plan = factor->plan;
    NAME(permute)(factor, x, y);
    if (plan->band_groups > 0)
        NAME(solve_band_forward)(factor, factor->vector);
    for (uint32_t n = 0; n < plan->front_count; ++n)
        NAME(solve_forward)(factor, &plan->fronts[n], factor->vector + 2 * (size_t)plan->fronts[n].first_pivot);
    NAME(solve_all_backward)(factor, x, y);
}

#undef COLUMNS
#undef TILE
#undef CORNER
#undef PAIR
#undef PLACE
#undef GROUP
#undef LANES
#undef SHORTEST

/// @file numeric.h
/// Factorisation and solution in one precision and one width of vector: included by table.h, once for each
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

/// The columns of one front on their way.
typedef struct NAME(columns) {
    REAL *pivots, *border;               ///< L: pivot rows and border rows
    REAL *scaled_pivots, *scaled_border; ///< W
    REAL *reciprocal;                    ///< of D
    size_t count, pivot_rows, border_rows;
} NAME(columns);

MSPRINGI_INLINE VECTOR NAME(load)(const REAL *from) {
    return *(const VECTOR *)(const void *)from;
}
MSPRINGI_INLINE void NAME(store)(REAL *to, VECTOR a) {
    *(VECTOR *)(void *)to = a;
}
MSPRINGI_INLINE VECTOR NAME(set)(REAL value) {
    return value - (VECTOR){0};
}

/* ------------------------------------------------------------------------------------------------------- tiles */

/// Rows of one tile: as many vectors as the registers have room for, fewer at the end.
MSPRINGI_INLINE size_t NAME(tile_rows)(size_t rows_left) {
    const size_t vectors = rows_left / LANES;
    size_t fit = MSPRINGI_TILE_VECTORS;
    while (fit > vectors)
        fit /= 2;
    return fit * LANES;
}

/// What a tile works with: its part of some columns, its rows of W, and the rows of L that belong to the columns.
typedef struct NAME(tile) {
    REAL *values;      ///< first column, first row of the tile
    size_t rows;       ///< from a column to the next
    REAL *scaled;      ///< W of the tile: [column][row of the tile]
    const REAL *lower; ///< L in the rows that the columns are the pivots of, first column of the front
    size_t lower_rows; ///< from a column to the next
    size_t before;     ///< columns of the front that come before
} NAME(tile);

/// What a group's own rows come to: 1 / D and L.
typedef struct NAME(corner) {
    REAL reciprocal[GROUP], lower[GROUP][GROUP]; ///< L: [column][row]
} NAME(corner);

MSPRINGI_INLINE void NAME(subtract)(VECTOR sum[GROUP][MSPRINGI_TILE_VECTORS], const NAME(tile) * t, size_t columns,
                                    size_t vectors) {
    const REAL *scaled = t->scaled, *lower = t->lower;
    for (size_t p = 0; p < t->before; ++p) {
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

/// Subtract the products of the columns before.
MSPRINGI_INLINE void NAME(update_tile)(const NAME(tile) * t, size_t columns, size_t vectors) {
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
MSPRINGI_INLINE void NAME(eliminate_tile)(const NAME(tile) * t, const NAME(corner) * corner, bool updated,
                                          size_t columns, size_t vectors) {
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

static void NAME(update)(const NAME(tile) * t, size_t columns, size_t vectors) {
#if MSPRINGI_TILE_VECTORS >= 4
    if (vectors == 4 && columns == GROUP)
        NAME(update_tile)(t, GROUP, 4);
    else if (vectors == 4)
        NAME(update_tile)(t, 2, 4);
    else
#endif
        if (vectors == 2 && columns == GROUP)
        NAME(update_tile)(t, GROUP, 2);
    else if (vectors == 2)
        NAME(update_tile)(t, 2, 2);
    else if (columns == GROUP)
        NAME(update_tile)(t, GROUP, 1);
    else
        NAME(update_tile)(t, 2, 1);
}

static void NAME(eliminate)(const NAME(tile) * t, const NAME(corner) * corner, bool updated, size_t columns,
                            size_t vectors) {
#if MSPRINGI_TILE_VECTORS >= 4
    if (vectors == 4 && columns == GROUP)
        NAME(eliminate_tile)(t, corner, updated, GROUP, 4);
    else if (vectors == 4)
        NAME(eliminate_tile)(t, corner, updated, 2, 4);
    else
#endif
        if (vectors == 2 && columns == GROUP)
        NAME(eliminate_tile)(t, corner, updated, GROUP, 2);
    else if (vectors == 2)
        NAME(eliminate_tile)(t, corner, updated, 2, 2);
    else if (columns == GROUP)
        NAME(eliminate_tile)(t, corner, updated, GROUP, 1);
    else
        NAME(eliminate_tile)(t, corner, updated, 2, 1);
}

/* ---------------------------------------------------------------------------------------------------- one front */

/// Eliminate a group's own rows, which the columns before have been subtracted from. Returns the column whose pivot
/// is not positive, or columns.
static size_t NAME(eliminate_corner)(NAME(corner) * corner, const REAL *values, size_t rows, size_t columns) {
    REAL scaled[GROUP][GROUP];
    for (size_t c = 0; c < columns; ++c) {
        for (size_t i = c; i < columns; ++i) {
            REAL value = values[c * rows + i];
            for (size_t p = 0; p < c; ++p)
                value = value - scaled[p][i] * corner->lower[p][c];
            scaled[c][i] = value;
        }
        if (!(scaled[c][c] >= SMALLEST && scaled[c][c] <= LARGEST))
            return c;
        corner->reciprocal[c] = (REAL)1 / scaled[c][c];
        for (size_t i = c + 1; i < columns; ++i)
            corner->lower[c][i] = scaled[c][i] * corner->reciprocal[c];
    }
    return columns;
}

/// Eliminate the columns first ... first + columns - 1 in the rows below. Returns the column whose pivot is not
/// positive, or the number of columns in the front.
MSPRINGI_INLINE size_t NAME(eliminate_group)(const NAME(columns) * f, size_t first, size_t columns) {
    size_t row = 0, rows = NAME(tile_rows)(f->pivot_rows);
    while (row + rows <= first) {
        row += rows;
        rows = NAME(tile_rows)(f->pivot_rows - row);
    }
    NAME(tile)
    t = {.rows = f->pivot_rows, .lower = f->pivots + first, .lower_rows = f->pivot_rows, .before = first};
    REAL *const values = f->pivots + first * f->pivot_rows;
    t.values = values + row;
    t.scaled = f->scaled_pivots + row * f->count;
    if (first > 0)
        NAME(update)(&t, columns, rows / LANES);
    NAME(corner) corner;
    const size_t done = NAME(eliminate_corner)(&corner, values + first, f->pivot_rows, columns);
    if (done < columns)
        return first + done;
    memcpy(f->reciprocal + first, corner.reciprocal, columns * sizeof *f->reciprocal);
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
MSPRINGI_INLINE void NAME(update_border)(const NAME(columns) * f, REAL *update, size_t update_columns) {
    NAME(tile) t = {.rows = f->border_rows, .lower_rows = f->border_rows, .before = f->count};
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

MSPRINGI_INLINE void NAME(add_block)(REAL *to, size_t rows, REAL xx, REAL xy, REAL yy) {
    to[0] += xx;
    to[1] += xy;
    to[rows] += xy;
    to[rows + 1] += yy;
}

MSPRINGI_INLINE void NAME(assemble)(const NAME(columns) * f, const mspringi_cholesky_plan *plan,
                                    const mspringi_front *front, const MATRIX *matrix) {
    for (uint32_t p = 0; p < front->pivot_count; ++p) {
        const uint32_t node = plan->order[front->first_pivot + p];
        REAL *to = f->pivots + 2 * (size_t)p * (f->pivot_rows + 1);
        NAME(add_block)(to, f->pivot_rows, matrix->node_xx[node], matrix->node_xy[node], matrix->node_yy[node]);
    }
    for (uint32_t e = front->first_entry; e < front->end_entry; ++e) {
        const mspringi_cholesky_entry *entry = &plan->entries[e];
        const bool is_pivot = e < front->border_entry;
        NAME(add_block)
        ((is_pivot ? f->pivots : f->border) + entry->to, is_pivot ? f->pivot_rows : f->border_rows,
         matrix->edge_xx[entry->edge], matrix->edge_xy[entry->edge], matrix->edge_yy[entry->edge]);
    }
}

/// Add the update matrix of a child to a front's columns and its own update matrix.
MSPRINGI_INLINE void NAME(add_child)(const NAME(columns) * f, REAL *update, const mspringi_front_run *runs,
                                     uint32_t run_count, const REAL *child, size_t child_rows) {
    for (uint32_t a = 0; a < run_count; ++a) {
        const size_t columns = 2 * (size_t)runs[a].count;
        for (uint32_t b = a; b < run_count; ++b) {
            const REAL *from = child + 2 * (runs[a].first * child_rows + runs[b].first);
            const size_t rows = 2 * (size_t)runs[b].count;
            const size_t to_rows = runs[b].is_pivot ? f->pivot_rows : f->border_rows;
            REAL *to = !runs[a].is_pivot ? update : runs[b].is_pivot ? f->pivots : f->border;
            to += 2 * (runs[a].to * to_rows + runs[b].to);
            for (size_t c = 0; c < columns; ++c, to += to_rows, from += child_rows)
                for (size_t i = a == b ? c : 0; i < rows; ++i)
                    to[i] += from[i];
        }
    }
}

static uint32_t NAME(factor)(FACTOR *factor, const MATRIX *matrix) {
    const mspringi_cholesky_plan *plan = factor->plan;
    for (uint32_t n = 0; n < plan->front_count; ++n) {
        const mspringi_front *front = &plan->fronts[n];
        NAME(columns)
        f = {.count = 2 * (size_t)front->pivot_count,
             .pivot_rows = mspringi_pivot_rows(front),
             .border_rows = mspringi_border_rows(front)};
        f.pivots = factor->panels + front->panel;
        f.border = f.pivots + f.count * f.pivot_rows;
        f.scaled_pivots = factor->scaled;
        f.scaled_border = factor->scaled + f.count * f.pivot_rows;
        f.reciprocal = factor->reciprocal + 2 * (size_t)front->first_pivot;
        REAL *update = factor->updates[front->stack] + front->update;
        const size_t update_columns = 2 * (size_t)front->border_count;
        memset(f.pivots, 0, f.count * (f.pivot_rows + f.border_rows) * sizeof *f.pivots);
        memset(update, 0, update_columns * f.border_rows * sizeof *update);
        NAME(assemble)(&f, plan, front, matrix);
        for (uint32_t c = 0; c < front->child_count; ++c) {
            const mspringi_front *child = &plan->fronts[plan->children[front->first_child + c]];
            NAME(add_child)
            (&f, update, plan->runs + child->first_run, child->run_count,
             factor->updates[child->stack] + child->update, mspringi_border_rows(child));
        }
        for (size_t first = 0; first < f.count; first += GROUP) {
            const size_t bad = NAME(eliminate_group)(&f, first, first + GROUP <= f.count ? GROUP : 2);
            if (bad < f.count)
                return plan->order[front->first_pivot + bad / 2];
        }
        NAME(update_border)(&f, update, update_columns);
    }
    return MSPRING_NONE;
}

/* --------------------------------------------------------------------------------------------------- solution */

/// Sum of products in MSPRINGI_PAD partial sums, whatever the width of vectors, that are then added in pairs.
MSPRINGI_INLINE REAL NAME(dot)(const REAL *a, const REAL *b, size_t count) {
    VECTOR sum[MSPRINGI_PAD / LANES];
    REAL part[MSPRINGI_PAD];
    MSPRINGI_UNROLL
    for (size_t v = 0; v < MSPRINGI_PAD / LANES; ++v)
        sum[v] = NAME(set)(0);
    for (size_t i = 0; i < count; i += MSPRINGI_PAD) {
        MSPRINGI_UNROLL
        for (size_t v = 0; v < MSPRINGI_PAD / LANES; ++v)
            sum[v] = sum[v] + NAME(load)(a + i + v * LANES) * NAME(load)(b + i + v * LANES);
    }
    memcpy(part, sum, sizeof part);
    for (size_t half = MSPRINGI_PAD / 2; half > 0; half /= 2)
        for (size_t i = 0; i < half; ++i)
            part[i] += part[i + half];
    return part[0];
}

MSPRINGI_INLINE void NAME(solve_forward)(const FACTOR *factor, const mspringi_front *front, REAL *y) {
    const size_t columns = 2 * (size_t)front->pivot_count;
    const size_t pivot_rows = mspringi_pivot_rows(front), border_rows = mspringi_border_rows(front);
    const REAL *pivots = factor->panels + front->panel, *border = pivots + columns * pivot_rows;
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
}

MSPRINGI_INLINE void NAME(solve_backward)(const FACTOR *factor, const mspringi_front *front, REAL *y) {
    const size_t columns = 2 * (size_t)front->pivot_count;
    const size_t pivot_rows = mspringi_pivot_rows(front), border_rows = mspringi_border_rows(front);
    const REAL *pivots = factor->panels + front->panel, *border = pivots + columns * pivot_rows;
    const REAL *reciprocal = factor->reciprocal + 2 * (size_t)front->first_pivot;
    const uint32_t *places = factor->plan->border + front->first_border;
    for (size_t i = 0; i < front->border_count; ++i) {
        factor->part[2 * i] = factor->vector[2 * (size_t)places[i]];
        factor->part[2 * i + 1] = factor->vector[2 * (size_t)places[i] + 1];
    }
    for (size_t i = 2 * (size_t)front->border_count; i < border_rows; ++i)
        factor->part[i] = 0;
    for (size_t p = 0; p < columns; ++p)
        y[p] = y[p] * reciprocal[p] - NAME(dot)(border + p * border_rows, factor->part, border_rows);
    for (size_t p = columns; p-- > 1;)
        for (size_t i = 0; i < p; ++i)
            y[i] -= pivots[i * pivot_rows + p] * y[p];
}

static void NAME(solve)(FACTOR *factor, REAL *x, REAL *y) {
    const mspringi_cholesky_plan *plan = factor->plan;
    REAL *vector = factor->vector;
    for (uint32_t i = 0; i < plan->size; ++i) {
        vector[2 * (size_t)i] = x[plan->order[i]];
        vector[2 * (size_t)i + 1] = y[plan->order[i]];
    }
    for (uint32_t n = 0; n < plan->front_count; ++n)
        NAME(solve_forward)(factor, &plan->fronts[n], vector + 2 * (size_t)plan->fronts[n].first_pivot);
    for (uint32_t n = plan->front_count; n-- > 0;)
        NAME(solve_backward)(factor, &plan->fronts[n], vector + 2 * (size_t)plan->fronts[n].first_pivot);
    for (uint32_t i = 0; i < plan->size; ++i) {
        x[plan->order[i]] = vector[2 * (size_t)i];
        y[plan->order[i]] = vector[2 * (size_t)i + 1];
    }
}

#undef GROUP
#undef LANES

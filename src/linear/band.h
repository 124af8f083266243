/// @file band.h
/// Factorisation and solution of a banded matrix in one precision and one width of vector: included by numeric.h.
///
/// Columns come in groups of four (two nodes) and reach MSPRINGI_PAD rows down from the first of their group, so
/// that a window of as many columns and rows slides along the diagonal. Row i is number i % MSPRINGI_PAD of each
/// column: nothing moves when the window does. By then a group's own rows have left the window, and their numbers
/// in later columns are those of rows MSPRINGI_PAD further down.
///
/// Every element has its products subtracted in the order of elimination, as in fronts. Beside these, nothing is
/// gathered or added up, and what is computed next waits for little else than one division after another: on the
/// bar of 80 x 5 fronts take twice as long.
///
/// SPDX-License-Identifier: MIT

/// Vectors in a column.
#define PARTS (MSPRINGI_PAD / LANES)
#define WINDOW NAME(window)
/// Where a vector is one number, loops over them are left to the compiler: unrolled, they take minutes to compile.
#if MSPRINGI_VECTOR_BYTES > 0
#define UNROLL_PARTS MSPRINGI_UNROLL
#else
#define UNROLL_PARTS
#endif

/// A group on its way.
typedef struct WINDOW {
    REAL *columns;    ///< of the group; those of later ones follow
    size_t own;       ///< number in a column of the group's first row
    size_t later;     ///< groups behind it that it reaches
    MASK mine[PARTS]; ///< ones in the group's own rows
} WINDOW;

/// Ones in the rows of a group, which begin at this number in a column.
MSPRINGI_INLINE MASK NAME(group_rows)(size_t first, size_t part) {
    const MASK_ANYWHERE *before = (const void *)(NAME(masks) + MSPRINGI_PAD - first + part * LANES);
    const MASK_ANYWHERE *with = (const void *)(NAME(masks) + MSPRINGI_PAD - first - GROUP + part * LANES);
    return *with & ~*before;
}

MSPRINGI_INLINE WINDOW NAME(window_at)(const FACTOR *factor, uint32_t group) {
    const mspringi_cholesky_plan *plan = factor->plan;
    const uint32_t behind = plan->band_groups - 1 - group;
    WINDOW w = {.columns = factor->panels + (size_t)group * GROUP * MSPRINGI_PAD,
                .own = (size_t)group * GROUP % MSPRINGI_PAD,
                .later = behind < plan->band_reach ? behind : plan->band_reach};
    UNROLL_PARTS
    for (size_t v = 0; v < PARTS; ++v)
        w.mine[v] = NAME(group_rows)(w.own, v);
    return w;
}

/// Put the matrix into a group's columns.
MSPRINGI_INLINE void NAME(fill_group)(const FACTOR *factor, const MATRIX *matrix, uint32_t group) {
    const mspringi_cholesky_plan *plan = factor->plan;
    REAL *const columns = factor->panels + (size_t)group * GROUP * MSPRINGI_PAD;
    const size_t own = (size_t)group * GROUP % MSPRINGI_PAD;
    UNROLL_PARTS
    for (size_t i = 0; i < GROUP * PARTS; ++i)
        NAME(store)(columns + i * LANES, NAME(set)(0));
    for (uint32_t n = 0; n < 2; ++n) {
        REAL *to = columns + 2 * n * (MSPRINGI_PAD + 1) + own;
        const bool is_there = 2 * group + n < plan->size; // there may be one node too few for whole groups
        const uint32_t node = plan->order[is_there ? 2 * group + n : 0];
        to[0] = is_there ? 0 + matrix->node_xx[node] : 1;
        to[1] = is_there ? 0 + matrix->node_xy[node] : 0;
        to[MSPRINGI_PAD + 1] = is_there ? 0 + matrix->node_yy[node] : 1;
    }
    NAME(add_edges)
    (factor->panels, MSPRINGI_PAD, plan->entries + plan->band_entries[group],
     plan->entries + plan->band_entries[group + 1], matrix);
}

/// What is left of the right side in the rows of the window: its part in a group's own rows.
MSPRINGI_INLINE void NAME(own_rows)(const WINDOW *w, const VECTOR right[PARTS], REAL own[GROUP]) {
    REAL all[MSPRINGI_PAD];
    memcpy(all, right, sizeof all);
    MSPRINGI_UNROLL
    for (size_t c = 0; c < GROUP; ++c)
        own[c] = all[w->own + c];
}

/// L^-1 in a group's own rows.
MSPRINGI_INLINE void NAME(solve_own_rows)(const REAL *lower, size_t rows, REAL own[GROUP]) {
    MSPRINGI_UNROLL
    for (size_t c = 0; c < GROUP; ++c)
        MSPRINGI_UNROLL
    for (size_t d = c + 1; d < GROUP; ++d)
        own[d] -= lower[c * rows + d] * own[c];
}

/// Let the rows that follow on the window take the place of a group's own.
MSPRINGI_INLINE void NAME(move_on)(const WINDOW *w, VECTOR right[PARTS], const REAL *vector, uint32_t group) {
    const size_t next = ((size_t)group * GROUP / MSPRINGI_PAD + 1) * MSPRINGI_PAD;
    UNROLL_PARTS
    for (size_t v = 0; v < PARTS; ++v)
        right[v] =
            NAME(keep)(right[v], ~w->mine[v]) + NAME(keep)(NAME(load)(vector + next + v * LANES), w->mine[v]);
}

/// Eliminate a group's columns in all rows, its own as computed in the corner, and in the right side.
MSPRINGI_INLINE void NAME(eliminate_columns)(const WINDOW *w, const CORNER *corner, VECTOR scaled[PARTS][GROUP]) {
    MSPRINGI_UNROLL
    for (size_t c = 0; c < GROUP; ++c)
        UNROLL_PARTS
    for (size_t v = 0; v < PARTS; ++v)
        scaled[v][c] = NAME(keep)(NAME(load)(w->columns + c * MSPRINGI_PAD + v * LANES), ~w->mine[v]);
    MSPRINGI_UNROLL
    for (size_t c = 0; c < GROUP; ++c) {
        const VECTOR inverse = NAME(set)(corner->reciprocal[c]);
        UNROLL_PARTS
        for (size_t v = 0; v < PARTS; ++v)
            NAME(store)(w->columns + c * MSPRINGI_PAD + v * LANES, scaled[v][c] * inverse);
        MSPRINGI_UNROLL
        for (size_t d = c + 1; d < GROUP; ++d) {
            const VECTOR factor = NAME(set)(corner->lower[c][d]);
            UNROLL_PARTS
            for (size_t v = 0; v < PARTS; ++v)
                scaled[v][d] = scaled[v][d] - scaled[v][c] * factor;
        }
    }
}

/// Subtract what a group's columns come to from those of a later group, in the rows from that group's own on.
MSPRINGI_INLINE void NAME(update_group)(const WINDOW *w, VECTOR scaled[PARTS][GROUP], size_t later) {
    const size_t first = (w->own + later * GROUP) % MSPRINGI_PAD, part = first / LANES;
    const size_t enough = (first % LANES + MSPRINGI_PAD - later * GROUP + LANES - 1) / LANES;
    const size_t parts = enough < PARTS ? enough : PARTS;
    const REAL *lower = w->columns + first;
    REAL *const to = w->columns + later * GROUP * MSPRINGI_PAD;
    MSPRINGI_UNROLL
    for (size_t q = 0; q < GROUP; ++q) {
        VECTOR factor[GROUP];
        MSPRINGI_UNROLL
        for (size_t c = 0; c < GROUP; ++c)
            factor[c] = NAME(set)(lower[c * MSPRINGI_PAD + q]);
        for (size_t i = 0; i < parts; ++i) {
            const size_t v = (part + i) % PARTS;
            VECTOR sum = NAME(load)(to + q * MSPRINGI_PAD + v * LANES);
            MSPRINGI_UNROLL
            for (size_t c = 0; c < GROUP; ++c)
                sum = sum - scaled[v][c] * factor[c];
            NAME(store)(to + q * MSPRINGI_PAD + v * LANES, sum);
        }
    }
    // Columns of groups behind that one have no place for its rows, which share a vector with what they have.
    if (LANES > GROUP) {
        const MASK others = ~NAME(group_rows)(first, part);
        MSPRINGI_UNROLL
        for (size_t c = 0; c < GROUP; ++c)
            scaled[part][c] = NAME(keep)(scaled[part][c], others);
    }
}

/// Subtract what a group's columns, whose own rows may be filled in or 0, take from the right side.
MSPRINGI_INLINE void NAME(update_right)(const WINDOW *w, const REAL own[GROUP], bool has_own_rows,
                                        VECTOR right[PARTS]) {
    MSPRINGI_UNROLL
    for (size_t c = 0; c < GROUP; ++c) {
        const VECTOR factor = NAME(set)(own[c]);
        UNROLL_PARTS
        for (size_t v = 0; v < PARTS; ++v) {
            const VECTOR lower = NAME(load)(w->columns + c * MSPRINGI_PAD + v * LANES);
            right[v] = right[v] - (has_own_rows ? NAME(keep)(lower, ~w->mine[v]) : lower) * factor;
        }
    }
}

/// What is left to do for a group when the next has all it needs of it.
MSPRINGI_INLINE void NAME(finish_group)(const FACTOR *factor, const WINDOW *w, uint32_t group, const CORNER *corner,
                                        VECTOR scaled[PARTS][GROUP], VECTOR right[PARTS], REAL *vector) {
    REAL own[GROUP];
    for (size_t later = 2; later <= w->later; ++later)
        NAME(update_group)(w, scaled, later);
    NAME(own_rows)(w, right, own);
    NAME(solve_own_rows)(corner->lower[0], GROUP, own);
    NAME(update_right)(w, own, false, right);
    NAME(move_on)(w, right, vector, group);
    MSPRINGI_UNROLL
    for (size_t c = 0; c < GROUP; ++c) {
        vector[(size_t)group * GROUP + c] = own[c] * corner->reciprocal[c];
        factor->reciprocal[(size_t)group * GROUP + c] = corner->reciprocal[c];
        MSPRINGI_UNROLL
        for (size_t d = c + 1; d < GROUP; ++d)
            w->columns[c * MSPRINGI_PAD + w->own + d] = corner->lower[c][d];
    }
}

/// Factor A. The vector holds a right side b and leaves as D^-1 L^-1 b.
///
/// A group's corner is one long wait, and the next group's corner waits for it and for little else. So what no one
/// waits for is left until the next corner has begun.
static uint32_t NAME(eliminate_band)(FACTOR *factor, const MATRIX *matrix, REAL *vector) {
    const mspringi_cholesky_plan *plan = factor->plan;
    WINDOW w, before = {0};
    CORNER corner, last = {{0}, {{0}}};
    VECTOR scaled[PARTS][GROUP], right[PARTS];
    memset(scaled, 0, sizeof scaled);
    UNROLL_PARTS
    for (size_t v = 0; v < PARTS; ++v)
        right[v] = NAME(load)(vector + v * LANES);
    for (uint32_t group = 0; group <= plan->band_reach && group < plan->band_groups; ++group)
        NAME(fill_group)(factor, matrix, group);
    for (uint32_t group = 0; group < plan->band_groups; ++group, before = w, last = corner) {
        w = NAME(window_at)(factor, group);
        const size_t done = NAME(eliminate_corner)(&corner, w.columns + w.own, MSPRINGI_PAD, GROUP);
        if (done < GROUP)
            return plan->order[2 * group + done / 2];
        // One group ahead of need, so that these numbers are in memory by then.
        if (group + plan->band_reach + 1 < plan->band_groups)
            NAME(fill_group)(factor, matrix, group + plan->band_reach + 1);
        if (group > 0)
            NAME(finish_group)(factor, &before, group - 1, &last, scaled, right, vector);
        NAME(eliminate_columns)(&w, &corner, scaled);
        if (w.later > 0)
            NAME(update_group)(&w, scaled, 1);
    }
    NAME(finish_group)(factor, &before, plan->band_groups - 1, &last, scaled, right, vector);
    return MSPRING_NONE;
}

/// D^-1 L^-1 b.
static void NAME(solve_band_forward)(const FACTOR *factor, REAL *vector) {
    VECTOR right[PARTS];
    UNROLL_PARTS
    for (size_t v = 0; v < PARTS; ++v)
        right[v] = NAME(load)(vector + v * LANES);
    for (uint32_t group = 0; group < factor->plan->band_groups; ++group) {
        const WINDOW w = NAME(window_at)(factor, group);
        REAL own[GROUP];
        NAME(own_rows)(&w, right, own);
        NAME(solve_own_rows)(w.columns + w.own, MSPRINGI_PAD, own);
        NAME(update_right)(&w, own, true, right);
        NAME(move_on)(&w, right, vector, group);
        MSPRINGI_UNROLL
        for (size_t c = 0; c < GROUP; ++c)
            vector[(size_t)group * GROUP + c] = own[c] * factor->reciprocal[(size_t)group * GROUP + c];
    }
}

/// L^-T, the unknowns that are known last coming last.
static void NAME(solve_band_backward)(const FACTOR *factor, REAL *vector) {
    const mspringi_cholesky_plan *plan = factor->plan;
    for (uint32_t group = plan->band_groups; group-- > 0;) {
        const REAL *const columns = factor->panels + (size_t)group * GROUP * MSPRINGI_PAD;
        const size_t own = (size_t)group * GROUP % MSPRINGI_PAD;
        REAL *const to = vector + (size_t)group * GROUP;
        REAL x[GROUP];
        memcpy(x, to, sizeof x);
        for (size_t later = plan->band_reach; later > 0; --later) {
            const REAL *const lower = columns + (own + later * GROUP) % MSPRINGI_PAD;
            MSPRINGI_UNROLL
            for (size_t q = GROUP; q-- > 0;)
                MSPRINGI_UNROLL
            for (size_t c = 0; c < GROUP; ++c)
                x[c] -= lower[c * MSPRINGI_PAD + q] * to[later * GROUP + q];
        }
        MSPRINGI_UNROLL
        for (size_t q = GROUP; q-- > 0;)
            MSPRINGI_UNROLL
        for (size_t c = 0; c < q; ++c)
            x[c] -= columns[c * MSPRINGI_PAD + own + q] * x[q];
        memcpy(to, x, sizeof x);
    }
}

#undef PARTS
#undef UNROLL_PARTS
#undef WINDOW

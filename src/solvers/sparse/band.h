/// @file band.h
/// Factorisation and solution of a banded matrix in one precision and one width of vector: included by numeric.h.
///
/// Columns come in groups of four (two nodes) and reach MSPRINGI_PAD rows down from the first of their group, which
/// is number 0 of each of its columns. No vector is wider than a group has rows, so none holds rows of two groups:
/// between columns of different groups all goes by whole vectors, which ones is known when this is compiled, and
/// there is nothing to mask. (With the widest vectors, and rows that keep their place while the window moves on,
/// the bar of 80 x 5 takes 1.4 times as long in double precision with AVX-512, and twice as long without vectors.)
///
/// Every element has its products subtracted in the order of elimination, as in fronts. Beside these, nothing is
/// gathered or added up, and what is computed next waits for little else than one division after another: on the
/// bar of 80 x 5 fronts take twice as long.
///
/// SPDX-License-Identifier: MIT

#define BAND_LANES (sizeof(BAND_VECTOR) / sizeof(REAL))
/// Vectors of a group's rows, and in a column.
#define OWN_PARTS (GROUP / BAND_LANES)
#define PARTS (MSPRINGI_PAD / BAND_LANES)
#define WINDOW NAME(window)
/// Where a vector is one number, loops over them are left to the compiler: unrolled, they take minutes to compile.
#if MSPRINGI_VECTOR_BYTES > 0
#define UNROLL_PARTS MSPRINGI_UNROLL
#else
#define UNROLL_PARTS
#endif

/// A group on its way.
typedef struct WINDOW {
    REAL *columns; ///< of the group; those of later ones follow
    size_t later;  ///< groups behind it that it reaches
} WINDOW;

MSPRINGI_INLINE BAND_VECTOR NAME(band_load)(const REAL *from) {
    return *(const BAND_VECTOR *)(const void *)from;
}
MSPRINGI_INLINE void NAME(band_store)(REAL *to, BAND_VECTOR a) {
    *(BAND_VECTOR *)(void *)to = a;
}
MSPRINGI_INLINE BAND_VECTOR NAME(band_set)(REAL value) {
    return value - (BAND_VECTOR){0};
}

MSPRINGI_INLINE WINDOW NAME(window_at)(const FACTOR *factor, uint32_t group) {
    const mspringi_cholesky_symbolic *plan = factor->plan;
    const uint32_t behind = plan->band_groups - 1 - group;
    return (WINDOW){.columns = factor->panels + (size_t)group * GROUP * MSPRINGI_PAD,
                    .later = behind < plan->band_reach ? behind : plan->band_reach};
}

/// Put the matrix into a group's columns.
MSPRINGI_INLINE void NAME(fill_group)(const FACTOR *factor, const MATRIX *matrix, uint32_t group) {
    const mspringi_cholesky_symbolic *plan = factor->plan;
    REAL *const columns = factor->panels + (size_t)group * GROUP * MSPRINGI_PAD;
    UNROLL_PARTS
    for (size_t i = 0; i < GROUP * PARTS; ++i)
        NAME(band_store)(columns + i * BAND_LANES, NAME(band_set)(0));
    for (uint32_t n = 0; n < 2; ++n) {
        REAL *to = columns + 2 * n * (MSPRINGI_PAD + 1);
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

/// L^-1 in a group's own rows.
MSPRINGI_INLINE void NAME(solve_own_rows)(const REAL *lower, size_t rows, REAL own[GROUP]) {
    MSPRINGI_UNROLL
    for (size_t c = 0; c < GROUP; ++c)
        MSPRINGI_UNROLL
    for (size_t d = c + 1; d < GROUP; ++d)
        own[d] -= lower[c * rows + d] * own[c];
}

/// Let the rows of the window move up by a group, and those that follow on it come in.
MSPRINGI_INLINE void NAME(move_on)(BAND_VECTOR right[PARTS], const REAL *vector, uint32_t group) {
    UNROLL_PARTS
    for (size_t v = 0; v < PARTS - OWN_PARTS; ++v)
        right[v] = right[v + OWN_PARTS];
    UNROLL_PARTS
    for (size_t v = 0; v < OWN_PARTS; ++v)
        right[PARTS - OWN_PARTS + v] =
            NAME(band_load)(vector + (size_t)group * GROUP + MSPRINGI_PAD + v * BAND_LANES);
}

/// Eliminate a group's columns in all rows but its own, which are computed in the corner.
MSPRINGI_INLINE void NAME(eliminate_columns)(const WINDOW *w, const CORNER *corner,
                                             BAND_VECTOR scaled[PARTS][GROUP]) {
    UNROLL_PARTS
    for (size_t v = OWN_PARTS; v < PARTS; ++v) {
        REAL *const values = w->columns + v * BAND_LANES;
        MSPRINGI_UNROLL
        for (size_t c = 0; c < GROUP; ++c)
            scaled[v][c] = NAME(band_load)(values + c * MSPRINGI_PAD);
        MSPRINGI_UNROLL
        for (size_t c = 0; c < GROUP; ++c) {
            NAME(band_store)(values + c * MSPRINGI_PAD, scaled[v][c] * NAME(band_set)(corner->reciprocal[c]));
            MSPRINGI_UNROLL
            for (size_t d = c + 1; d < GROUP; ++d)
                scaled[v][d] = scaled[v][d] - scaled[v][c] * NAME(band_set)(corner->lower[c][d]);
        }
    }
}

/// Subtract what a group's columns come to from those of a later group.
MSPRINGI_INLINE void NAME(update_group)(const WINDOW *w, BAND_VECTOR scaled[PARTS][GROUP], size_t later) {
    const REAL *const lower = w->columns + later * GROUP;
    REAL *const to = w->columns + later * GROUP * MSPRINGI_PAD;
    MSPRINGI_UNROLL
    for (size_t q = 0; q < GROUP; ++q) {
        BAND_VECTOR factor[GROUP];
        MSPRINGI_UNROLL
        for (size_t c = 0; c < GROUP; ++c)
            factor[c] = NAME(band_set)(lower[c * MSPRINGI_PAD + q]);
        UNROLL_PARTS
        for (size_t v = later * OWN_PARTS; v < PARTS; ++v) {
            REAL *const values = to + q * MSPRINGI_PAD + (v - later * OWN_PARTS) * BAND_LANES;
            BAND_VECTOR sum = NAME(band_load)(values);
            MSPRINGI_UNROLL
            for (size_t c = 0; c < GROUP; ++c)
                sum = sum - scaled[v][c] * factor[c];
            NAME(band_store)(values, sum);
        }
    }
}

/// Subtract what a group's columns take from the right side in the rows below its own.
MSPRINGI_INLINE void NAME(update_right)(const WINDOW *w, const REAL own[GROUP], BAND_VECTOR right[PARTS]) {
    MSPRINGI_UNROLL
    for (size_t c = 0; c < GROUP; ++c) {
        const BAND_VECTOR factor = NAME(band_set)(own[c]);
        UNROLL_PARTS
        for (size_t v = OWN_PARTS; v < PARTS; ++v)
            right[v] = right[v] - NAME(band_load)(w->columns + c * MSPRINGI_PAD + v * BAND_LANES) * factor;
    }
}

/// What is left to do for a group when the next has all it needs of it.
MSPRINGI_INLINE void NAME(finish_group)(const FACTOR *factor, const WINDOW *w, uint32_t group, const CORNER *corner,
                                        BAND_VECTOR scaled[PARTS][GROUP], BAND_VECTOR right[PARTS], REAL *vector) {
    REAL own[GROUP];
    if (w->later > 1)
        NAME(update_group)(w, scaled, 2);
    if (w->later > 2)
        NAME(update_group)(w, scaled, 3);
    memcpy(own, right, sizeof own);
    NAME(solve_own_rows)(corner->lower[0], GROUP, own);
    NAME(update_right)(w, own, right);
    NAME(move_on)(right, vector, group);
    MSPRINGI_UNROLL
    for (size_t c = 0; c < GROUP; ++c) {
        vector[(size_t)group * GROUP + c] = own[c] * corner->reciprocal[c];
        factor->reciprocal[(size_t)group * GROUP + c] = corner->reciprocal[c];
        MSPRINGI_UNROLL
        for (size_t d = c + 1; d < GROUP; ++d)
            w->columns[c * MSPRINGI_PAD + d] = corner->lower[c][d];
    }
}

/// Factor A. The vector holds a right side b and leaves as D^-1 L^-1 b.
///
/// A group's corner is one long wait, and the next group's corner waits for it and for little else. So what no one
/// waits for is left until the next corner has begun.
static uint32_t NAME(eliminate_band)(FACTOR *factor, const MATRIX *matrix, REAL *vector) {
    const mspringi_cholesky_symbolic *plan = factor->plan;
    WINDOW w, before = {0};
    CORNER corner, last = {{0}, {{0}}};
    BAND_VECTOR scaled[PARTS][GROUP], right[PARTS];
    memset(scaled, 0, sizeof scaled);
    UNROLL_PARTS
    for (size_t v = 0; v < PARTS; ++v)
        right[v] = NAME(band_load)(vector + v * BAND_LANES);
    for (uint32_t group = 0; group <= plan->band_reach && group < plan->band_groups; ++group)
        NAME(fill_group)(factor, matrix, group);
    for (uint32_t group = 0; group < plan->band_groups; ++group, before = w, last = corner) {
        w = NAME(window_at)(factor, group);
        const size_t done = NAME(eliminate_corner)(&corner, w.columns, MSPRINGI_PAD, GROUP);
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
    BAND_VECTOR right[PARTS];
    UNROLL_PARTS
    for (size_t v = 0; v < PARTS; ++v)
        right[v] = NAME(band_load)(vector + v * BAND_LANES);
    for (uint32_t group = 0; group < factor->plan->band_groups; ++group) {
        const WINDOW w = NAME(window_at)(factor, group);
        REAL own[GROUP];
        memcpy(own, right, sizeof own);
        NAME(solve_own_rows)(w.columns, MSPRINGI_PAD, own);
        NAME(update_right)(&w, own, right);
        NAME(move_on)(right, vector, group);
        MSPRINGI_UNROLL
        for (size_t c = 0; c < GROUP; ++c)
            vector[(size_t)group * GROUP + c] = own[c] * factor->reciprocal[(size_t)group * GROUP + c];
    }
}

/// L^-T, the unknowns that are known last coming last.
static void NAME(solve_band_backward)(const FACTOR *factor, REAL *vector) {
    const mspringi_cholesky_symbolic *plan = factor->plan;
    for (uint32_t group = plan->band_groups; group-- > 0;) {
        const REAL *const columns = factor->panels + (size_t)group * GROUP * MSPRINGI_PAD;
        REAL *const to = vector + (size_t)group * GROUP;
        REAL x[GROUP];
        memcpy(x, to, sizeof x);
        for (size_t later = plan->band_reach; later > 0; --later) {
            const REAL *const lower = columns + later * GROUP;
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
            x[c] -= columns[c * MSPRINGI_PAD + q] * x[q];
        memcpy(to, x, sizeof x);
    }
}

#undef BAND_LANES
#undef OWN_PARTS
#undef PARTS
#undef UNROLL_PARTS
#undef WINDOW

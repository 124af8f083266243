/// @file system_iterate.h
/// Iteration of conjugate gradients without the product. Plain C in blocks of MSPRINGI_WIDTH slots, or of the
/// MSPRINGI_QUARTER slots of a part of a tile, as in system_assemble.h. Sums are by lane, added in pairs at the
/// end, so their order is the same for every instruction set.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SYSTEM_ITERATE_H
#define MSPRINGI_SYSTEM_ITERATE_H

// Vectors for parts of a tile: those of the instruction set, or halves of them if they are longer than a part.
#ifndef PART_LANES
#define PART_LANES LANES
typedef vec part_vec;

static inline part_vec part_set(float value) {
    return set(value);
}
static inline part_vec part_load(const float *from) {
    return load(from);
}
static inline void part_store(float *to, part_vec a) {
    store(to, a);
}
static inline part_vec part_add(part_vec a, part_vec b) {
    return add(a, b);
}
static inline part_vec part_sub(part_vec a, part_vec b) {
    return sub(a, b);
}
static inline part_vec part_mul(part_vec a, part_vec b) {
    return mul(a, b);
}
#endif

/* -------------------------------------------------------------------------------------------------- by slot */

static inline float sum_block_lanes(float *lanes) {
    for (size_t half = MSPRINGI_WIDTH / 2; half > 0; half /= 2)
        for (size_t i = 0; i < half; ++i)
            lanes[i] = lanes[i] + lanes[i + half];
    return lanes[0];
}

// Invert the diagonal blocks. They are rounded to single precision: a millionth of their trace is added, which
// keeps those positive definite that are so by their mass alone, such as a taut rope's.
static void invert(const mspringi_system *s, size_t first, size_t end) {
    const float *restrict const masses = s->mass;
    float *restrict const block_xx = s->xx, *restrict const block_xy = s->xy, *restrict const block_yy = s->yy;
    for (size_t i = first; i < end; ++i) {
        const double mass = (double)masses[i], trace = (double)block_xx[i] + (double)block_yy[i];
        const double on_top = mass + 1e-6 * trace;
        const double xx = (double)block_xx[i] + on_top, yy = (double)block_yy[i] + on_top;
        const double xy = (double)block_xy[i];
        const double is_there = mass > 0.0 ? 1.0 : 0.0, determinant = xx * yy - xy * xy;
        const double factor = is_there / (mass > 0.0 ? determinant : 1.0);
        block_xx[i] = (float)(yy * factor);
        block_xy[i] = (float)(-xy * factor);
        block_yy[i] = (float)(xx * factor);
    }
}

// Parameters, since compilers know that restrict parameters do not alias.
MSPRINGI_INLINE float advance_chunk(size_t slots, float alpha, bool is_first, const float *restrict px,
                                    const float *restrict py, const float *restrict qx, const float *restrict qy,
                                    const float *restrict xx, const float *restrict xy, const float *restrict yy,
                                    float *restrict dx, float *restrict dy, float *restrict rx, float *restrict ry,
                                    float *restrict zx, float *restrict zy) {
    float sums[MSPRINGI_WIDTH] = {0.0f};
    for (size_t slot = 0; slot < slots; slot += MSPRINGI_WIDTH) {
        for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
            const size_t at = slot + i;
            const float x = rx[at] - alpha * qx[at], y = ry[at] - alpha * qy[at];
            const float scaled_x = xx[at] * x + xy[at] * y, scaled_y = xy[at] * x + yy[at] * y;
            dx[at] = (is_first ? 0.0f : dx[at]) + alpha * px[at];
            dy[at] = (is_first ? 0.0f : dy[at]) + alpha * py[at];
            rx[at] = x;
            ry[at] = y;
            zx[at] = scaled_x;
            zy[at] = scaled_y;
            sums[i] = sums[i] + (x * scaled_x + y * scaled_y);
        }
    }
    return sum_block_lanes(sums);
}

MSPRINGI_INLINE void advance_chunks(const mspringi_system *s, const mspringi_iterate *n, float alpha, bool is_first,
                                    size_t first, size_t end, float *sums) {
    for (size_t at = first; at < end; at += MSPRINGI_CHUNK) {
        const size_t slots = end - at < MSPRINGI_CHUNK ? end - at : MSPRINGI_CHUNK;
        sums[at / MSPRINGI_CHUNK] = advance_chunk(
            slots, alpha, is_first, n->direction_x + at, n->direction_y + at, n->product_x + at, n->product_y + at,
            s->xx + at, s->xy + at, s->yy + at, n->solution_x + at, n->solution_y + at, n->residual_x + at,
            n->residual_y + at, n->scaled_x + at, n->scaled_y + at);
    }
}

static void advance(const mspringi_system *s, const mspringi_iterate *n, float alpha, bool is_first, size_t first,
                    size_t end, float *sums) {
    if (is_first)
        advance_chunks(s, n, alpha, true, first, end, sums);
    else
        advance_chunks(s, n, alpha, false, first, end, sums);
}

/* -------------------------------------------------------------------------------------------------- by tile */

/// Number of vectors in a part.
#define PART_VECTORS (MSPRINGI_PART / PART_LANES)

MSPRINGI_INLINE double sum_part(const part_vec *sums) {
    _Alignas(64) float lanes[MSPRINGI_PART];
    for (size_t v = 0; v < PART_VECTORS; ++v)
        part_store(lanes + v * PART_LANES, sums[v]);
    return (double)(((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) +
                    ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7])));
}

// In double precision, so that tiles of particles of equal mass, however many, get equal shares of a force.
static void inertia_of_tile(const mspringi_iterate *n, const float *mass, const mspringi_tile_part *parts,
                            size_t count, double *to) {
    double sum[MSPRINGI_PART] = {0.0}, inertia[MSPRINGI_PART] = {0.0};
    for (size_t p = 0; p < count; ++p) {
        const size_t slot = parts[p].first_slot;
        const float *const weights = mspringi_part_weights[parts[p].lanes];
        for (size_t i = 0; i < MSPRINGI_PART; ++i) {
            const double x = (double)n->arm_x[slot + i], y = (double)n->arm_y[slot + i];
            const double m = (double)(weights[i] * mass[slot + i]);
            sum[i] = sum[i] + m;
            inertia[i] = inertia[i] + m * (x * x + y * y);
        }
    }
    for (size_t half = MSPRINGI_PART / 2; half > 0; half /= 2) {
        for (size_t i = 0; i < half; ++i) {
            sum[i] = sum[i] + sum[i + half];
            inertia[i] = inertia[i] + inertia[i + half];
        }
    }
    to[0] = sum[0];
    to[1] = inertia[0];
}

static void restrict_to_tile(const mspringi_iterate *n, const mspringi_tile_part *parts, size_t count, double *to) {
    part_vec sum_x[PART_VECTORS], sum_y[PART_VECTORS], sum_moment[PART_VECTORS];
    for (size_t v = 0; v < PART_VECTORS; ++v)
        sum_x[v] = sum_y[v] = sum_moment[v] = part_set(0.0f);
    for (size_t p = 0; p < count; ++p) {
        for (size_t v = 0; v < PART_VECTORS; ++v) {
            const size_t slot = parts[p].first_slot + v * PART_LANES;
            const part_vec weight = part_load(mspringi_part_weights[parts[p].lanes] + v * PART_LANES);
            const part_vec x = part_mul(weight, part_load(n->residual_x + slot));
            const part_vec y = part_mul(weight, part_load(n->residual_y + slot));
            sum_x[v] = part_add(sum_x[v], x);
            sum_y[v] = part_add(sum_y[v], y);
            sum_moment[v] = part_add(sum_moment[v], part_sub(part_mul(part_load(n->arm_x + slot), y),
                                                             part_mul(part_load(n->arm_y + slot), x)));
        }
    }
    to[0] = sum_part(sum_x);
    to[1] = sum_part(sum_y);
    to[2] = sum_part(sum_moment);
}

// True if a part is the first of those at its slots.
static inline bool is_first_at_slots(const mspringi_tile_part *parts, size_t p) {
    return p == 0 || parts[p].first_slot != parts[p - 1].first_slot;
}

// Set the direction. A part writes the motion of its tile to its own slots; parts of other tiles at the same slots
// add theirs later.
MSPRINGI_INLINE void update_search(const mspringi_iterate *n, const mspringi_tile_part *parts, size_t count,
                                   const double (*bodies)[3], float beta, mspringi_search_update what) {
    const part_vec betas = part_set(beta);
    for (size_t p = 0; p < count; ++p) {
        const double *body = bodies[parts[p].tile];
        const part_vec shift_x = part_set((float)body[0]), shift_y = part_set((float)body[1]);
        const part_vec angle = part_set((float)body[2]);
        const bool is_first = is_first_at_slots(parts, p);
        for (size_t v = 0; v < PART_VECTORS; ++v) {
            const size_t slot = parts[p].first_slot + v * PART_LANES;
            const part_vec weight = part_load(mspringi_part_weights[parts[p].lanes] + v * PART_LANES);
            part_vec x = part_mul(weight, part_sub(shift_x, part_mul(part_load(n->arm_y + slot), angle)));
            part_vec y = part_mul(weight, part_add(shift_y, part_mul(part_load(n->arm_x + slot), angle)));
            if (!is_first) {
                x = part_add(part_load(n->direction_x + slot), x);
                y = part_add(part_load(n->direction_y + slot), y);
            } else if (what != MSPRINGI_SEARCH_COARSE_ONLY) {
                x = part_add(part_load(n->scaled_x + slot), x);
                y = part_add(part_load(n->scaled_y + slot), y);
            }
            if (is_first && what == MSPRINGI_SEARCH_CONTINUE) {
                x = part_add(x, part_mul(betas, part_load(n->direction_x + slot)));
                y = part_add(y, part_mul(betas, part_load(n->direction_y + slot)));
            }
            part_store(n->direction_x + slot, x);
            part_store(n->direction_y + slot, y);
        }
    }
}

static void search_coarse_only(const mspringi_iterate *n, const mspringi_tile_part *parts, size_t count,
                               const double (*bodies)[3], float beta) {
    update_search(n, parts, count, bodies, beta, MSPRINGI_SEARCH_COARSE_ONLY);
}

static void search_restart(const mspringi_iterate *n, const mspringi_tile_part *parts, size_t count,
                           const double (*bodies)[3], float beta) {
    update_search(n, parts, count, bodies, beta, MSPRINGI_SEARCH_RESTART);
}

static void search_continue(const mspringi_iterate *n, const mspringi_tile_part *parts, size_t count,
                            const double (*bodies)[3], float beta) {
    update_search(n, parts, count, bodies, beta, MSPRINGI_SEARCH_CONTINUE);
}

#endif

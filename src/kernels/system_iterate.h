/// @file system_iterate.h
/// What an iteration of conjugate gradients does beside the product: plain C in blocks of MSPRINGI_WIDTH slots, or
/// of the MSPRINGI_QUARTER slots of a part of a tile, as system_assemble.h is. Every sum is one of lanes, added up
/// pairwise at the end, so its order is the same for every instruction set.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SYSTEM_ITERATE_H
#define MSPRINGI_SYSTEM_ITERATE_H

// Vectors within a part of a tile: those of the instruction set, or half of them where they are longer than a part.
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

#if defined(_MSC_VER)
#define MSPRINGI_PART_INLINE static __forceinline
#else
#define MSPRINGI_PART_INLINE static inline __attribute__((always_inline))
#endif

static inline float sum_block_lanes(float *lanes) {
    for (size_t half = MSPRINGI_WIDTH / 2; half > 0; half /= 2)
        for (size_t i = 0; i < half; ++i)
            lanes[i] = lanes[i] + lanes[i + half];
    return lanes[0];
}

// The parameters are what compilers know to be apart from each other.
static float advance_coordinates(size_t slots, float alpha, const float *restrict px, const float *restrict py,
                                 const float *restrict qx, const float *restrict qy, const float *restrict xx,
                                 const float *restrict xy, const float *restrict yy, float *restrict dx,
                                 float *restrict dy, float *restrict rx, float *restrict ry, float *restrict zx,
                                 float *restrict zy) {
    float sums[MSPRINGI_WIDTH] = {0.0f};
    for (size_t slot = 0; slot < slots; slot += MSPRINGI_WIDTH) {
        for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
            const size_t at = slot + i;
            dx[at] = dx[at] + alpha * px[at];
            dy[at] = dy[at] + alpha * py[at];
            const float x = rx[at] - alpha * qx[at], y = ry[at] - alpha * qy[at];
            const float scaled_x = xx[at] * x + xy[at] * y, scaled_y = xy[at] * x + yy[at] * y;
            rx[at] = x;
            ry[at] = y;
            zx[at] = scaled_x;
            zy[at] = scaled_y;
            sums[i] = sums[i] + (x * scaled_x + y * scaled_y);
        }
    }
    return sum_block_lanes(sums);
}

static float advance(const mspringi_system *s, const mspringi_iterate *n, float alpha) {
    return advance_coordinates(n->slots, alpha, n->direction_x, n->direction_y, n->product_x, n->product_y, s->xx,
                               s->xy, s->yy, n->solution_x, n->solution_y, n->residual_x, n->residual_y,
                               n->scaled_x, n->scaled_y);
}

static float dot(size_t slots, const float *restrict ax, const float *restrict ay, const float *restrict bx,
                 const float *restrict by) {
    float sums[MSPRINGI_WIDTH] = {0.0f};
    for (size_t slot = 0; slot < slots; slot += MSPRINGI_WIDTH)
        for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
            sums[i] = sums[i] + (ax[slot + i] * bx[slot + i] + ay[slot + i] * by[slot + i]);
    return sum_block_lanes(sums);
}

/// All lanes of a part.
#define ALL_LANES ((1u << MSPRINGI_PART) - 1u)

/// Vectors in a part.
#define PART_VECTORS (MSPRINGI_PART / PART_LANES)

/// Sums by lane of a tile's residual, and of its moment.
typedef struct tile_sums {
    part_vec x[PART_VECTORS], y[PART_VECTORS], turn[PART_VECTORS];
} tile_sums;

MSPRINGI_PART_INLINE void add_part(tile_sums *to, const float *rx, const float *ry, const float *arm_x,
                                   const float *arm_y) {
    for (size_t v = 0; v < PART_VECTORS; ++v) {
        const part_vec x = part_load(rx + v * PART_LANES), y = part_load(ry + v * PART_LANES);
        to->x[v] = part_add(to->x[v], x);
        to->y[v] = part_add(to->y[v], y);
        to->turn[v] = part_add(to->turn[v], part_sub(part_mul(part_load(arm_x + v * PART_LANES), y),
                                                     part_mul(part_load(arm_y + v * PART_LANES), x)));
    }
}

static double sum_part(const part_vec *sums) {
    _Alignas(64) float lanes[MSPRINGI_PART];
    for (size_t v = 0; v < PART_VECTORS; ++v)
        part_store(lanes + v * PART_LANES, sums[v]);
    return (double)(((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) +
                    ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7])));
}

static void restrict_to_tile(const mspringi_iterate *n, const mspringi_tile_part *parts, size_t count, double *to) {
    tile_sums sums;
    for (size_t v = 0; v < PART_VECTORS; ++v)
        sums.x[v] = sums.y[v] = sums.turn[v] = part_set(0.0f);
    for (size_t p = 0; p < count; ++p) {
        const size_t slot = parts[p].first_slot;
        if (parts[p].lanes == ALL_LANES) {
            add_part(&sums, n->residual_x + slot, n->residual_y + slot, n->arm_x + slot, n->arm_y + slot);
            continue;
        }
        _Alignas(64) float x[MSPRINGI_PART], y[MSPRINGI_PART];
        for (size_t i = 0; i < MSPRINGI_PART; ++i) {
            const bool counts = parts[p].lanes >> i & 1;
            x[i] = counts ? n->residual_x[slot + i] : 0.0f;
            y[i] = counts ? n->residual_y[slot + i] : 0.0f;
        }
        add_part(&sums, x, y, n->arm_x + slot, n->arm_y + slot);
    }
    to[0] = sum_part(sums.x);
    to[1] = sum_part(sums.y);
    to[2] = sum_part(sums.turn);
}

static void turn_tile(const mspringi_iterate *n, const mspringi_tile_part *parts, size_t count, const double *body,
                      float beta) {
    const part_vec shift_x = part_set((float)body[0]), shift_y = part_set((float)body[1]);
    const part_vec angle = part_set((float)body[2]), betas = part_set(beta);
    for (size_t p = 0; p < count; ++p) {
        const size_t slot = parts[p].first_slot;
        const bool all = parts[p].lanes == ALL_LANES;
        _Alignas(64) float some_x[MSPRINGI_PART], some_y[MSPRINGI_PART];
        float *const px = n->direction_x + slot, *const py = n->direction_y + slot;
        float *const to_x = all ? px : some_x, *const to_y = all ? py : some_y;
        for (size_t i = 0; i < MSPRINGI_PART; i += PART_LANES) {
            const part_vec body_x = part_sub(shift_x, part_mul(part_load(n->arm_y + slot + i), angle));
            const part_vec body_y = part_add(shift_y, part_mul(part_load(n->arm_x + slot + i), angle));
            part_store(to_x + i, part_add(part_add(part_load(n->scaled_x + slot + i), body_x),
                                          part_mul(betas, part_load(px + i))));
            part_store(to_y + i, part_add(part_add(part_load(n->scaled_y + slot + i), body_y),
                                          part_mul(betas, part_load(py + i))));
        }
        for (size_t i = 0; !all && i < MSPRINGI_PART; ++i) {
            px[i] = parts[p].lanes >> i & 1 ? some_x[i] : px[i];
            py[i] = parts[p].lanes >> i & 1 ? some_y[i] : py[i];
        }
    }
}

/// Sums by lane over a tile, about a point in it that moves along: mass, first moments of place and velocity,
/// moment of momentum and of inertia.
typedef struct tile_moments {
    part_vec sums[7][PART_VECTORS];
} tile_moments;

MSPRINGI_PART_INLINE void add_moments(tile_moments *to, const mspringi_flight *f, size_t slot, const float *mass,
                                      size_t origin) {
    for (size_t v = 0; v < PART_VECTORS; ++v) {
        const size_t at = slot + v * PART_LANES;
        const part_vec m = part_load(mass + v * PART_LANES);
        const part_vec x = part_sub(part_load(f->x + at), part_set(f->x[origin]));
        const part_vec y = part_sub(part_load(f->y + at), part_set(f->y[origin]));
        const part_vec vx = part_sub(part_load(f->vx + at), part_set(f->vx[origin]));
        const part_vec vy = part_sub(part_load(f->vy + at), part_set(f->vy[origin]));
        const part_vec values[] = {m,
                                   part_mul(m, x),
                                   part_mul(m, y),
                                   part_mul(m, vx),
                                   part_mul(m, vy),
                                   part_mul(m, part_sub(part_mul(x, vy), part_mul(y, vx))),
                                   part_mul(m, part_add(part_mul(x, x), part_mul(y, y)))};
        for (size_t i = 0; i < 7; ++i)
            to->sums[i][v] = part_add(to->sums[i][v], values[i]);
    }
}

/// A rigid motion about a point: where the mass centre is and goes to, and the rotation less what h v makes of it.
typedef struct tile_turn {
    float x, y, hvx, hvy, inward, sideways;
} tile_turn;

static tile_turn find_turn(const tile_moments *moments, double h) {
    double sums[7];
    for (size_t i = 0; i < 7; ++i)
        sums[i] = sum_part(moments->sums[i]);
    const double x = sums[1] / sums[0], y = sums[2] / sums[0], vx = sums[3] / sums[0], vy = sums[4] / sums[0];
    const double moment = sums[5] - sums[0] * (x * vy - y * vx), inertia = sums[6] - sums[0] * (x * x + y * y);
    // The rotation whose half angle has this tangent: of the angle omega h up to its third power, whatever that is.
    const double half = inertia > 1e-6 * sums[6] ? 0.5 * h * moment / inertia : 0.0;
    const double inward = -2.0 * half * half / (1.0 + half * half); // cos - 1; half of it times half: sin - omega h
    const tile_turn turn = {(float)x,        (float)y,      (float)(h * vx),
                            (float)(h * vy), (float)inward, (float)(half * inward)};
    return turn;
}

MSPRINGI_PART_INLINE void fly_part(const mspringi_flight *f, size_t slot, size_t origin, const tile_turn *turn,
                                   float *const to[4]) {
    const part_vec inward = part_set(turn->inward), sideways = part_set(turn->sideways), h = part_set(f->h);
    for (size_t i = 0; i < MSPRINGI_PART; i += PART_LANES) {
        const size_t at = slot + i;
        const part_vec x = part_sub(part_sub(part_load(f->x + at), part_set(f->x[origin])), part_set(turn->x));
        const part_vec y = part_sub(part_sub(part_load(f->y + at), part_set(f->y[origin])), part_set(turn->y));
        const part_vec vx = part_sub(part_load(f->vx + at), part_set(f->vx[origin]));
        const part_vec vy = part_sub(part_load(f->vy + at), part_set(f->vy[origin]));
        const part_vec turned_x = part_sub(part_mul(inward, x), part_mul(sideways, y));
        const part_vec turned_y = part_add(part_mul(inward, y), part_mul(sideways, x));
        part_store(to[0] + i, turned_x);
        part_store(to[1] + i, turned_y);
        part_store(to[2] + i, part_add(part_add(x, turned_x), part_sub(part_mul(h, vx), part_set(turn->hvx))));
        part_store(to[3] + i, part_add(part_add(y, turned_y), part_sub(part_mul(h, vy), part_set(turn->hvy))));
    }
}

static void fly_tile(const mspringi_flight *f, const mspringi_tile_part *parts, size_t count) {
    float *const to[] = {f->turned_x, f->turned_y, f->arm_x, f->arm_y};
    tile_moments moments;
    for (size_t i = 0; i < 7; ++i)
        for (size_t v = 0; v < PART_VECTORS; ++v)
            moments.sums[i][v] = part_set(0.0f);
    size_t origin = parts[0].first_slot;
    while (!(parts[0].lanes >> (origin - parts[0].first_slot) & 1))
        ++origin;
    for (size_t p = 0; p < count; ++p) {
        const size_t slot = parts[p].first_slot;
        if (parts[p].lanes == ALL_LANES) {
            add_moments(&moments, f, slot, f->mass + slot, origin);
            continue;
        }
        _Alignas(64) float mass[MSPRINGI_PART];
        for (size_t i = 0; i < MSPRINGI_PART; ++i)
            mass[i] = parts[p].lanes >> i & 1 ? f->mass[slot + i] : 0.0f;
        add_moments(&moments, f, slot, mass, origin);
    }
    const tile_turn turn = find_turn(&moments, (double)f->h);
    for (size_t p = 0; p < count; ++p) {
        const size_t slot = parts[p].first_slot;
        _Alignas(64) float some[4][MSPRINGI_PART];
        float *const all[] = {to[0] + slot, to[1] + slot, to[2] + slot, to[3] + slot};
        float *const part[] = {some[0], some[1], some[2], some[3]};
        fly_part(f, slot, origin, &turn, parts[p].lanes == ALL_LANES ? all : part);
        for (size_t i = 0; parts[p].lanes != ALL_LANES && i < MSPRINGI_PART; ++i)
            for (size_t j = 0; j < 4; ++j)
                all[j][i] = parts[p].lanes >> i & 1 ? some[j][i] : all[j][i];
    }
}

#undef ALL_LANES

#endif

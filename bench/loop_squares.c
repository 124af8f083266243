/// @file loop_squares.c
/// The step as a game writes it by hand for SSE: four springs of a square at a time, of which each particle is
/// loaded once, with approximate reciprocal roots.
///
/// SPDX-License-Identifier: MIT
#include "loops.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <emmintrin.h>

/// Corners: lower left, lower right, upper left, upper right. Springs: 0 to 3, 1 to 2, 0 to 1, 0 to 2.
typedef struct square {
    float stiffness[4], damping[4], rest[4];
    uint32_t corners[4];
} square;

typedef struct squares {
    uint32_t particle_count, square_count, other_count;
    float *places, *velocities, *forces; ///< [particle_count][2]
    float *inverse, *weight;             ///< [particle_count][2], the same twice; 1/kg, and gravity's share
    square *list;                        ///< [square_count]
    naive_spring *others;                ///< [other_count]
    float lag;                           ///< as in naive_network
} squares;

static void end(void *self) {
    squares *s = self;
    free(s->places);
    free(s->list);
    free(s->others);
}

/// Which spring goes from a place of the grid: to the right, up, up right, up left.
typedef struct starts {
    uint32_t of[4];
} starts;

static uint32_t spring_to(const starts *from, const naive_network *network, uint32_t direction, uint32_t a,
                          uint32_t b) {
    const uint32_t found = from->of[direction];
    if (found == BENCH_NOBODY || a == BENCH_NOBODY || b == BENCH_NOBODY)
        return BENCH_NOBODY;
    const naive_spring *spring = &network->springs[found];
    return (spring->a == a && spring->b == b) || (spring->a == b && spring->b == a) ? found : BENCH_NOBODY;
}

// Note each spring where it starts on the grid.
static void note_springs(const naive_network *from, const bench_grid *grid, const uint32_t *at, starts *all) {
    const uint32_t w = grid->columns;
    for (uint32_t i = 0; i < w * grid->rows; i++)
        all[i] = (starts){{BENCH_NOBODY, BENCH_NOBODY, BENCH_NOBODY, BENCH_NOBODY}};
    for (uint32_t i = 0; i < from->spring_count; i++) {
        const uint32_t one = at[from->springs[i].a], other = at[from->springs[i].b];
        const uint32_t low = one < other ? one : other, further = one < other ? other - one : one - other;
        const uint32_t steps[4] = {1, w, w + 1, w - 1};
        for (int direction = 0; direction < 4; direction++)
            if (further == steps[direction])
                all[low].of[direction] = i;
    }
}

static void add_square(squares *s, const naive_network *from, const uint32_t corners[4],
                       const uint32_t springs[4]) {
    square *made = &s->list[s->square_count++];
    memcpy(made->corners, corners, sizeof made->corners);
    for (int i = 0; i < 4; i++) {
        made->stiffness[i] = from->springs[springs[i]].stiffness;
        made->damping[i] = from->springs[springs[i]].damping;
        made->rest[i] = from->springs[springs[i]].rest_length;
    }
}

static void find_squares(squares *s, const naive_network *from, const bench_grid *grid, const starts *all,
                         bool *is_taken) {
    const uint32_t w = grid->columns;
    for (uint32_t i = 0; i + w + 1 < w * grid->rows; i++) {
        const uint32_t corners[4] = {grid->place[i], grid->place[i + 1], grid->place[i + w],
                                     grid->place[i + w + 1]};
        const uint32_t springs[4] = {spring_to(&all[i], from, 2, corners[0], corners[3]),
                                     spring_to(&all[i + 1], from, 3, corners[1], corners[2]),
                                     spring_to(&all[i], from, 0, corners[0], corners[1]),
                                     spring_to(&all[i], from, 1, corners[0], corners[2])};
        if (i % w == w - 1 || springs[0] == BENCH_NOBODY || springs[1] == BENCH_NOBODY ||
            springs[2] == BENCH_NOBODY || springs[3] == BENCH_NOBODY)
            continue;
        add_square(s, from, corners, springs);
        for (int j = 0; j < 4; j++)
            is_taken[springs[j]] = true;
    }
}

static bool arrange(squares *s, const naive_network *from, const bench_grid *grid) {
    const size_t places = (size_t)grid->columns * grid->rows;
    starts *all = malloc(places * sizeof *all);
    uint32_t *at = malloc(from->particle_count * sizeof *at);
    bool *is_taken = calloc(from->spring_count, sizeof *is_taken);
    const bool good = all && at && is_taken;
    if (good) {
        for (uint32_t i = 0; i < places; i++)
            if (grid->place[i] != BENCH_NOBODY)
                at[grid->place[i]] = i;
        note_springs(from, grid, at, all);
        find_squares(s, from, grid, all, is_taken);
        for (uint32_t i = 0; i < from->spring_count; i++)
            if (!is_taken[i])
                s->others[s->other_count++] = from->springs[i];
    }
    free(all);
    free(at);
    free(is_taken);
    return good;
}

static bool begin(void *self, const naive_network *from, const bench_grid *grid) {
    squares *s = self;
    const size_t n = 2 * (size_t)from->particle_count;
    *s = (squares){.particle_count = from->particle_count};
    s->places = calloc(5 * n, sizeof(float));
    s->list = malloc((size_t)grid->columns * grid->rows * sizeof *s->list);
    s->others = malloc(from->spring_count * sizeof *s->others);
    if (!s->places || !s->list || !s->others || !arrange(s, from, grid)) {
        end(s);
        return false;
    }
    s->velocities = s->places + n;
    s->forces = s->velocities + n;
    s->inverse = s->forces + n;
    s->weight = s->inverse + n;
    return true;
}

static void reset(void *self, const naive_network *from) {
    squares *s = self;
    s->lag = from->lag;
    for (uint32_t i = 0; i < s->particle_count; i++) {
        const naive_particle *p = &from->particles[i];
        s->places[2 * i] = p->x;
        s->places[2 * i + 1] = p->y;
        s->velocities[2 * i] = p->vx;
        s->velocities[2 * i + 1] = p->vy;
        s->inverse[2 * i] = s->inverse[2 * i + 1] = p->inverse_mass;
        s->weight[2 * i] = p->inverse_mass > 0 ? from->gravity_x : 0;
        s->weight[2 * i + 1] = p->inverse_mass > 0 ? from->gravity_y : 0;
    }
}

/// Of the corners: x in one register, y in another.
typedef struct corners {
    __m128 x, y;
} corners;

static __m128 pair(const float *all, uint32_t low, uint32_t high) {
    const __m128 half = _mm_loadl_pi(_mm_setzero_ps(), (const __m64 *)(const void *)(all + 2 * (size_t)low));
    return _mm_loadh_pi(half, (const __m64 *)(const void *)(all + 2 * (size_t)high));
}

static corners load(const float *all, const uint32_t of[4]) {
    const __m128 lower = pair(all, of[0], of[1]), upper = pair(all, of[2], of[3]);
    return (corners){_mm_shuffle_ps(lower, upper, _MM_SHUFFLE(2, 0, 2, 0)),
                     _mm_shuffle_ps(lower, upper, _MM_SHUFFLE(3, 1, 3, 1))};
}

// Ends less starts of the four springs.
static __m128 along(__m128 of) {
    return _mm_sub_ps(_mm_shuffle_ps(of, of, _MM_SHUFFLE(2, 1, 2, 3)),
                      _mm_shuffle_ps(of, of, _MM_SHUFFLE(0, 0, 1, 0)));
}

// Forces on corners of those of springs: f0 + f2 + f3, f1 - f2, -f1 - f3, -f0.
static __m128 at_corners(__m128 f) {
    const __m128 signs = _mm_castsi128_ps(_mm_set_epi32((int)0x80000000, (int)0x80000000, 0, 0));
    const __m128 diagonals = _mm_xor_ps(_mm_shuffle_ps(f, f, _MM_SHUFFLE(0, 1, 1, 0)), signs);
    const __m128 sides = _mm_shuffle_ps(f, f, _MM_SHUFFLE(3, 3, 2, 2));
    const __m128 share = _mm_mul_ps(sides, _mm_set_ps(0, -1, -1, 1));
    const __m128 last = _mm_move_ss(_mm_setzero_ps(), _mm_shuffle_ps(f, f, _MM_SHUFFLE(3, 3, 3, 3)));
    return _mm_add_ps(_mm_add_ps(diagonals, share), last);
}

static void add(float *all, uint32_t low, uint32_t high, __m128 force) {
    const __m128 sum = _mm_add_ps(pair(all, low, high), force);
    _mm_storel_pi((__m64 *)(void *)(all + 2 * (size_t)low), sum);
    _mm_storeh_pi((__m64 *)(void *)(all + 2 * (size_t)high), sum);
}

static void pull_squares(const squares *s) {
    for (uint32_t i = 0; i < s->square_count; i++) {
        const square *of = &s->list[i];
        const corners place = load(s->places, of->corners), velocity = load(s->velocities, of->corners);
        const __m128 dx = along(place.x), dy = along(place.y);
        const __m128 square_length = _mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy));
        const __m128 is_long = _mm_cmpgt_ps(square_length, _mm_setzero_ps());
        const __m128 inverse = _mm_and_ps(_mm_rsqrt_ps(square_length), is_long);
        const __m128 ux = _mm_mul_ps(dx, inverse), uy = _mm_mul_ps(dy, inverse);
        const __m128 length = _mm_mul_ps(square_length, inverse);
        const __m128 rate = _mm_add_ps(_mm_mul_ps(along(velocity.x), ux), _mm_mul_ps(along(velocity.y), uy));
        const __m128 force =
            _mm_add_ps(_mm_mul_ps(_mm_sub_ps(length, _mm_loadu_ps(of->rest)), _mm_loadu_ps(of->stiffness)),
                       _mm_mul_ps(rate, _mm_loadu_ps(of->damping)));
        const __m128 fx = at_corners(_mm_mul_ps(force, ux)), fy = at_corners(_mm_mul_ps(force, uy));
        add(s->forces, of->corners[0], of->corners[1], _mm_unpacklo_ps(fx, fy));
        add(s->forces, of->corners[2], of->corners[3], _mm_unpackhi_ps(fx, fy));
    }
}

static void pull_others(const squares *s) {
    for (uint32_t i = 0; i < s->other_count; i++) {
        const naive_spring *of = &s->others[i];
        const float *a = s->places + 2 * (size_t)of->a, *b = s->places + 2 * (size_t)of->b;
        const float *va = s->velocities + 2 * (size_t)of->a, *vb = s->velocities + 2 * (size_t)of->b;
        const float dx = b[0] - a[0], dy = b[1] - a[1], length = sqrtf(dx * dx + dy * dy);
        const float inverse = length > 0 ? 1 / length : 0;
        const float rate = ((vb[0] - va[0]) * dx + (vb[1] - va[1]) * dy) * inverse;
        const float force = ((length - of->rest_length) * of->stiffness + rate * of->damping) * inverse;
        s->forces[2 * (size_t)of->a] += force * dx;
        s->forces[2 * (size_t)of->a + 1] += force * dy;
        s->forces[2 * (size_t)of->b] -= force * dx;
        s->forces[2 * (size_t)of->b + 1] -= force * dy;
    }
}

static void step(void *self, const naive_network *from, double dt, uint32_t substeps) {
    squares *s = self;
    const float h = (float)(dt / substeps), rate = from->global_damping;
    const size_t n = 2 * (size_t)s->particle_count;
    for (uint32_t substep = 0; substep < substeps; substep++) {
        pull_squares(s);
        pull_others(s);
        const float time = 0.5f * (s->lag + h), loss = -expm1f(-rate * time);
        const float kick = rate > 0.0f ? loss / rate : time;
        s->lag = h;
        float *restrict x = s->places, *restrict v = s->velocities, *restrict f = s->forces;
        const float *restrict inverse = s->inverse, *restrict weight = s->weight;
        for (size_t i = 0; i < n; i++) {
            v[i] += (f[i] * inverse[i] + weight[i]) * kick - loss * v[i];
            x[i] += v[i] * h;
            f[i] = 0;
        }
    }
}

static void get(const void *self, uint32_t particle, float *x, float *y) {
    const squares *s = self;
    *x = s->places[2 * (size_t)particle];
    *y = s->places[2 * (size_t)particle + 1];
}

const bench_loop bench_squares = {"squares", sizeof(squares), begin, reset, step, get, end};

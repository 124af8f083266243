/// @file test_web_kernels.c
/// The kernels of the web (springs outside of rows) against the scalar ones, byte for byte, with canaries around
/// all that they may touch: 0 to 3 groups of the web's own nodes, 0 to 2 of attached ones, 0 to 5 rungs in a group,
/// of which the first may be upright.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "level_kernels.h"
#include "support.h"

static const mspringi_kernels *kernels;

enum {
    W = MSPRINGI_WIDTH,
    OWN = 3,      // most groups of own nodes,
    ATTACHED = 2, // of attached ones,
    GROUPS = OWN + ATTACHED,
    RUNGS = 5, // and most rungs in a group
    FIRST = 1, // block where the web's row begins
    SLOTS = (1 + OWN + 1) * W,
    GUARD = 4 * W
};

#define CANARY 0xc5c5c5c5u

/// All memory of a web, what is written between canaries.
typedef struct arena {
    uint32_t front[GUARD];
    float x[SLOTS];
    uint32_t after_x[GUARD];
    float y[SLOTS];
    uint32_t after_y[GUARD];
    float vx[SLOTS];
    uint32_t after_vx[GUARD];
    float vy[SLOTS];
    uint32_t after_vy[GUARD];
    float low_x[SLOTS];
    uint32_t after_low_x[GUARD];
    float low_y[SLOTS];
    uint32_t after_low_y[GUARD];
    float low_vx[SLOTS];
    uint32_t after_low_vx[GUARD];
    float low_vy[SLOTS];
    uint32_t after_low_vy[GUARD];
    float gathered[2 * GROUPS * W * 4]; ///< in halves if precise
    uint32_t after_gathered[GUARD];
    float attached_x[ATTACHED * W];
    uint32_t after_attached_x[GUARD];
    float attached_y[ATTACHED * W];
    uint32_t after_attached_y[GUARD];
    float inverse_mass[SLOTS], force_x[SLOTS], force_y[SLOTS];
    float records[GROUPS * RUNGS * 3 * W];
    uint32_t neighbour[GROUPS * RUNGS * W];
    uint32_t first_slice_column[GROUPS + 1], end_column[GROUPS * W / MSPRINGI_QUARTER];
    uint8_t is_interleaved[GROUPS];
    mspringi_sell irregular;
} arena;

static void check_canaries(const arena *a) {
    const uint32_t *guards[] = {a->front,       a->after_x,        a->after_y,          a->after_vx,
                                a->after_vy,    a->after_gathered, a->after_attached_x, a->after_attached_y,
                                a->after_low_x, a->after_low_y,    a->after_low_vx,     a->after_low_vy};
    for (size_t i = 0; i < COUNT_OF(guards); i++) {
        for (size_t j = 0; j < GUARD; j++) {
            assert_int_equal(guards[i][j], CANARY);
        }
    }
}

typedef struct setup {
    uint32_t own, attached; ///< groups
    uint32_t parts;
    uint64_t seed;
    bool stands; ///< groups may have upright rungs
    bool forced, precise;
} setup;

static float random_float(uint64_t *seed, double low, double high) {
    return (float)support_random_between(seed, low, high);
}

/// Random rungs; about a quarter of their places is taken by no spring, which is a node's spring to itself.
static void fill_web(arena *a, const setup *s, uint64_t *seed) {
    const uint32_t groups = s->own + s->attached, nodes = groups * W;
    memset(a->records, 0, sizeof a->records);
    memset(a->neighbour, 0, sizeof a->neighbour);
    memset(a->first_slice_column, 0, sizeof a->first_slice_column);
    memset(a->is_interleaved, 0, sizeof a->is_interleaved);
    for (uint32_t group = 0; group < groups; group++) {
        const uint32_t rungs = (uint32_t)(support_random(seed) % (RUNGS + 1));
        a->first_slice_column[group + 1] = a->first_slice_column[group] + rungs;
        a->is_interleaved[group] = s->stands && group + 1 < s->own && rungs > 0 && support_random(seed) % 4 > 0;
        for (uint32_t lane = 0; lane < W; lane += MSPRINGI_QUARTER) {
            a->end_column[(group * W + lane) / MSPRINGI_QUARTER] = a->first_slice_column[group];
        }
        for (uint32_t place = a->first_slice_column[group] * W; place < a->first_slice_column[group + 1] * W;
             place++) {
            const uint32_t lane = place % W, node = group * W + lane;
            float *record = a->records + (size_t)(place / W) * s->parts * W + lane;
            a->neighbour[place] = node;
            if (support_random(seed) % 4 == 0) {
                continue;
            }
            a->neighbour[place] = (uint32_t)(support_random(seed) % nodes);
            a->end_column[node / MSPRINGI_QUARTER] = place / W + 1;
            record[MSPRINGI_REST_LENGTH * W] = random_float(seed, 0.5, 2);
            record[MSPRINGI_STIFFNESS * W] = random_float(seed, 10, 1000);
            if (s->parts > MSPRINGI_DAMPING) {
                record[MSPRINGI_DAMPING * W] = random_float(seed, 0, 30);
            }
        }
    }
    a->irregular = (mspringi_sell){.own_count = s->own * W,
                                   .attached_count = s->attached * W,
                                   .slice_count = groups,
                                   .first_slice_column = a->first_slice_column,
                                   .end_column = a->end_column,
                                   .neighbour = a->neighbour,
                                   .is_interleaved = s->stands ? a->is_interleaved : NULL};
}

static arena *arena_new(const setup *s) {
    arena *a = support_aligned_alloc(sizeof *a);
    uint64_t seed = s->seed;
    memset(a, 0, sizeof *a);
    uint32_t *guards[] = {a->front,       a->after_x,        a->after_y,          a->after_vx,
                          a->after_vy,    a->after_gathered, a->after_attached_x, a->after_attached_y,
                          a->after_low_x, a->after_low_y,    a->after_low_vx,     a->after_low_vy};
    for (size_t i = 0; i < COUNT_OF(guards); i++) {
        for (size_t j = 0; j < GUARD; j++) {
            guards[i][j] = CANARY;
        }
    }
    for (uint32_t i = 0; i < SLOTS; i++) {
        a->x[i] = random_float(&seed, -20, 20);
        a->y[i] = random_float(&seed, -20, 20);
        a->vx[i] = random_float(&seed, -5, 5);
        a->vy[i] = random_float(&seed, -5, 5);
        a->low_x[i] = random_float(&seed, -1e-7, 1e-7);
        a->low_vx[i] = random_float(&seed, -1e-7, 1e-7);
        a->low_vy[i] = random_float(&seed, -1e-7, 1e-7);
        a->low_y[i] = random_float(&seed, -1e-7, 1e-7);
        a->inverse_mass[i] = support_random(&seed) % 9 == 0 ? 0 : random_float(&seed, 0.1, 3);
        a->force_x[i] = random_float(&seed, -50, 50);
        a->force_y[i] = random_float(&seed, -50, 50);
    }
    // Own nodes are packed from their slots by the kernel; attached ones lie elsewhere.
    for (uint32_t i = s->own * W * 4; i < (s->own + s->attached) * W * 4; i++) {
        a->gathered[i] = random_float(&seed, -20, 20);
        a->gathered[i + (s->own + s->attached) * W * 4] = random_float(&seed, -5, 5);
    }
    for (uint32_t i = s->own * W * 4; s->precise && i < (s->own + s->attached) * W * 4; i += 4) {
        a->gathered[i + 2] = random_float(&seed, -1e-7, 1e-7);
        a->gathered[i + 3] = random_float(&seed, -1e-7, 1e-7);
    }
    fill_web(a, s, &seed);
    return a;
}

static mspringi_sweep sweep_of(arena *a, const setup *s) {
    return (mspringi_sweep){
        .x = a->x,
        .y = a->y,
        .vx = a->vx,
        .vy = a->vy,
        .low_x = a->low_x,
        .low_y = a->low_y,
        .low_vx = a->low_vx,
        .low_vy = a->low_vy,
        .grid = 0x1p-22f * 0x1.8p23f,
        .inverse_mass = a->inverse_mass,
        .force_x = s->forced ? a->force_x : NULL,
        .force_y = s->forced ? a->force_y : NULL,
        .irregular = &a->irregular,
        .irregular_springs = a->records,
        .gathered = a->gathered,
        .parts = s->parts,
        .h = 0.01f,
        .kick = 0.0075f,
        .loss = 0.01f,
        .gravity_h_x = 0.015f,
        .gravity_h_y = -0.098f,
    };
}

/// What a substep does: pack, pull at the attached nodes, sweep the own ones.
static void run(arena *a, const setup *s, const mspringi_kernels *with) {
    const bool damped = s->parts > MSPRINGI_DAMPING;
    const mspringi_sweep sweep = sweep_of(a, s);
    const mspringi_span span = {.first_slot = FIRST * W, .end_slot = (FIRST + s->own) * W};
    with->pack(&sweep, FIRST, s->own, a->gathered);
    const mspringi_attached_fn attached = s->precise ? with->precise.attached : with->attached[damped];
    if (s->precise) {
        mspringi_sweep half = sweep;
        half.x = sweep.vx;
        half.y = sweep.vy;
        with->pack(&half, FIRST, s->own, a->gathered + mspringi_gathered_half(&a->irregular));
        half = sweep;
        half.vx = sweep.low_x;
        half.vy = sweep.low_y;
        with->pack(&half, FIRST, s->own, a->gathered);
    }
    attached(&sweep, 0, a->irregular.attached_count, a->attached_x, a->attached_y);
    (s->precise ? with->precise.irregular : with->irregular[damped])(&sweep, &span, 1);
}

static void web_kernels(void **state) {
    (void)state;
    for (uint32_t variant = 0; variant < 8000; variant++) {
        const setup s = {.own = variant % (OWN + 1),
                         .attached = variant / 4 % (ATTACHED + 1),
                         .parts = 2 + (variant / 12 & 1),
                         .seed = variant,
                         .stands = variant / 48 & 1,
                         .forced = variant / 24 & 1,
                         .precise = variant / 96 & 1};
        arena *mine = arena_new(&s), *reference = arena_new(&s), *before = arena_new(&s);
        run(mine, &s, kernels);
        run(reference, &s, &mspringi_kernels_scalar);
        check_canaries(mine);
        check_canaries(reference);
        // The web holds pointers, each run's own; all else is equal.
        mine->irregular = reference->irregular = (mspringi_sell){0};
        if (memcmp(mine, reference, sizeof *mine) != 0) {
            print_error("own %u, attached %u, parts %u, forced %d, precise %d, seed %u\n", s.own, s.attached,
                        s.parts, s.forced, s.precise, variant);
        }
        assert_memory_equal(mine, reference, sizeof *mine);
        // Padding in front and behind has not moved; the row has, if there is one.
        assert_memory_equal(mine->x, before->x, W * sizeof(float));
        assert_memory_equal(mine->x + (FIRST + s.own) * W, before->x + (FIRST + s.own) * W,
                            (OWN + 1 - s.own) * W * sizeof(float));
        assert_int_equal(memcmp(mine->x, before->x, sizeof mine->x) != 0, s.own > 0);
        support_aligned_free(mine);
        support_aligned_free(reference);
        support_aligned_free(before);
    }
}

static void pack_copies_blocks(void **state) {
    (void)state;
    for (uint32_t blocks = 0; blocks <= OWN; blocks++) {
        const setup s = {.own = OWN, .parts = 2, .seed = 5};
        arena *a = arena_new(&s);
        const mspringi_sweep sweep = sweep_of(a, &s);
        for (size_t i = 0; i < COUNT_OF(a->gathered); i++) {
            a->gathered[i] = -1;
        }
        kernels->pack(&sweep, FIRST, blocks, a->gathered);
        for (uint32_t i = 0; i < OWN * W; i++) {
            const float *gathered = a->gathered + (size_t)4 * i;
            const size_t slot = FIRST * W + i;
            const float expected[4] = {a->x[slot], a->y[slot], a->vx[slot], a->vy[slot]},
                        none[4] = {-1, -1, -1, -1};
            assert_memory_equal(gathered, i < blocks * W ? expected : none, sizeof expected);
        }
        check_canaries(a);
        support_aligned_free(a);
    }
}

int main(int argc, char **argv) {
    kernels = level_kernels(argc, argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(web_kernels),
        cmocka_unit_test(pack_copies_blocks),
    };
    return cmocka_run_group_tests_name("web_kernels", tests, NULL, NULL);
}

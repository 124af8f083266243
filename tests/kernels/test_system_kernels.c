/// @file test_system_kernels.c
/// The kernels of the implicit solver at a level against the scalar ones, byte for byte, with canaries behind all
/// that they may touch: 0 to 3 blocks, one or two rows, in one span and in two, parts of tiles of any lanes.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "level_kernels.h"
#include "support.h"

static const mspringi_system_kernels *kernels, *scalar = &mspringi_kernels_scalar.system;

enum {
    W = MSPRINGI_WIDTH,
    ROW = 3,                             // most blocks in a row
    SLOTS = (1 + ROW + 1 + ROW + 1) * W, // padding, the row, padding, the row above, padding
    ABOVE = (ROW + 1) * W,               // from a slot to the one above it
    MANY = 2 * MSPRINGI_CHUNK + 3 * W,   // slots of what goes by slot alone: two chunks and a bit
    GUARD = 2 * W,
    TILES = 5,
    PARTS = 40
};

#define CANARY 0xc5c5c5c5u

/// An array between two canaries.
#define GUARDED(type, name, count)                                                                                 \
    _Alignas(64) type name[count];                                                                                 \
    _Alignas(64) uint32_t after_##name[GUARD]

/// All memory of a kernel's call. One of these per run, so that runs can be compared whole.
typedef struct arena {
    _Alignas(64) uint32_t front[GUARD];
    GUARDED(double, predicted_x, MANY);
    GUARDED(double, predicted_y, MANY);
    _Alignas(64) float by_slot[24][MANY];
    _Alignas(64) uint32_t after_by_slot[GUARD];
    GUARDED(float, records, ROW * 2 * MSPRINGI_DIRECTIONS * 3 * W);
    GUARDED(float, rest_lengths, ROW * 2 * MSPRINGI_DIRECTIONS * W);
    GUARDED(float, factors, ROW * 2 * MSPRINGI_DIRECTIONS * MSPRINGI_FACTORS * W);
    GUARDED(double, force_carry, 2 * ROW * W);
    GUARDED(float, carry, 3 * ROW * W);
    GUARDED(float, sums, 4);
    GUARDED(mspringi_tile_motion, flights, TILES);
    GUARDED(double, bodies, 3 * TILES);
    GUARDED(double, results, 4 * TILES);
    uint32_t rests_of_block[2 * ROW];
    mspringi_tile_part parts[PARTS];
    uint32_t part_count;
} arena;

/// The arrays by slot.
enum {
    VX,
    VY,
    MASS,
    INVERSE_MASS,
    FORCE_X,
    FORCE_Y,
    XX,
    XY,
    YY,
    SOLUTION_X,
    SOLUTION_Y,
    RESIDUAL_X,
    RESIDUAL_Y,
    SCALED_X,
    SCALED_Y,
    DIRECTION_X,
    DIRECTION_Y,
    PRODUCT_X,
    PRODUCT_Y,
    ARM_X,
    ARM_Y,
    LOW,
    FIRST,
    SECOND
};

static float random_float(uint64_t *seed, double low, double high) {
    return (float)support_random_between(seed, low, high);
}

static void put_canaries(void *memory, size_t size) {
    for (size_t i = 0; i < size / sizeof(uint32_t); i++) {
        ((uint32_t *)memory)[i] = CANARY;
    }
}

/// Whether the arrays end where they should.
static void check_canaries(const arena *a) {
    const uint32_t *guards[] = {
        a->front,         a->after_predicted_x, a->after_predicted_y, a->after_records, a->after_rest_lengths,
        a->after_factors, a->after_force_carry, a->after_carry,       a->after_by_slot, a->after_sums,
        a->after_flights, a->after_bodies,      a->after_results};
    for (size_t i = 0; i < COUNT_OF(guards); i++) {
        for (size_t j = 0; j < GUARD; j++) {
            assert_int_equal(guards[i][j], CANARY);
        }
    }
}

/// Parts of tiles, sorted by slot: full ones, some with holes, some groups of slots with two or three tiles.
static void fill_parts(arena *a, uint32_t slots, uint64_t *seed) {
    a->part_count = 0;
    for (uint32_t group = 0; group < slots / MSPRINGI_PART && a->part_count + 3 <= PARTS; group++) {
        const uint64_t kind = support_random(seed) % 4;
        uint32_t rest = kind == 0 ? 0 : kind == 1 ? 0xff : (uint32_t)(support_random(seed) & 0xff);
        for (uint32_t tile = 0; tile < TILES && rest != 0; tile += 2) {
            const uint32_t own = tile + 2 < TILES ? rest & (uint32_t)support_random(seed) : rest;
            const uint32_t lanes = kind == 1 ? rest : own;
            rest &= ~lanes;
            if (lanes != 0) {
                a->parts[a->part_count++] = (mspringi_tile_part){group * MSPRINGI_PART, lanes, tile};
            }
        }
    }
}

/// Positions of a grid that is off by a little, every seventh particle on the next one; everything else random.
static void fill(arena *a, uint32_t live, uint32_t parts, bool has_above, uint64_t seed) {
    put_canaries(a, offsetof(arena, rests_of_block));
    for (uint32_t i = 0; i < MANY; i++) {
        const uint32_t slot = i % ((ROW + 1) * W);
        a->predicted_x[i] = (double)slot + support_random_between(&seed, -0.2, 0.2);
        a->predicted_y[i] = (i / ((ROW + 1) * W)) + support_random_between(&seed, -0.2, 0.2);
        if (i % 7 == 6) {
            a->predicted_x[i] = a->predicted_x[i - 1];
            a->predicted_y[i] = a->predicted_y[i - 1];
        }
        for (int array = 0; array < 24; array++) {
            a->by_slot[array][i] = random_float(&seed, -2, 2);
        }
        const bool free = support_random(&seed) % 9 != 0;
        a->by_slot[INVERSE_MASS][i] = free ? random_float(&seed, 0.1, 3) : 0;
        a->by_slot[MASS][i] = free ? random_float(&seed, 0.1, 3) : 0;
        a->by_slot[XX][i] = random_float(&seed, 2, 5);
        a->by_slot[YY][i] = random_float(&seed, 2, 5);
    }
    for (uint32_t i = 0; i < 2 * ROW * MSPRINGI_DIRECTIONS * W; i++) {
        const uint32_t column = i / (MSPRINGI_DIRECTIONS * W) % ROW * W + i % W;
        const bool spring = column < live && (has_above || i / W % MSPRINGI_DIRECTIONS == MSPRINGI_EAST) &&
                            support_random(&seed) % 5 != 0;
        // Some are pressed, to less than three quarters, some tense.
        a->rest_lengths[i] = spring ? random_float(&seed, 0.6, 2) : 0;
        const uint32_t first = i / W * W * (parts - 1) + i % W;
        a->records[first] = spring ? random_float(&seed, 10, 1000) : 0;
        if (parts > MSPRINGI_DAMPING) {
            a->records[first + W] = spring ? random_float(&seed, 0, 30) : 0;
        }
    }
    for (uint32_t i = 0; i < 2 * ROW * MSPRINGI_DIRECTIONS * MSPRINGI_FACTORS * W; i++) {
        a->factors[i] = random_float(&seed, -3, 3);
    }
    for (uint32_t i = 0; i < 2 * ROW * W; i++) {
        a->force_carry[i] = has_above ? support_random_between(&seed, -9, 9) : 0;
    }
    for (uint32_t i = 0; i < 3 * ROW * W; i++) {
        a->carry[i] = has_above ? random_float(&seed, 0, 9) : 0;
    }
    for (uint32_t i = 0; i < 3 * TILES; i++) {
        a->bodies[i] = support_random_between(&seed, -1, 1);
    }
    for (uint32_t i = 0; i < TILES; i++) {
        a->flights[i] = (mspringi_tile_motion){
            1, 2, 0.5f, 0.25f, 0.125f, random_float(&seed, -1, 1), 0.1f, 0.2f, -0.01f, random_float(&seed, -1, 1)};
    }
    memset(a->sums, 0, sizeof a->sums);
    memset(a->rests_of_block, 0, sizeof a->rests_of_block);
    memset(a->parts, 0, sizeof a->parts);
    for (uint32_t i = 0; i < 2 * ROW; i++) {
        a->rests_of_block[i] = 2 * ROW - 1 - i;
    }
    fill_parts(a, MANY, &seed);
}

static mspringi_system system_of(arena *a, uint32_t parts) {
    return (mspringi_system){
        .x = a->predicted_x,
        .y = a->predicted_y,
        .vx = a->by_slot[VX],
        .vy = a->by_slot[VY],
        .force_scale = 0.75,
        .damping_rate = 1.5,
        .parts = parts,
        .lattice_springs = a->records,
        .rest_lengths = a->rest_lengths,
        .chain_springs = a->records,
        .rests_of_block = a->rests_of_block,
        .mass = a->by_slot[MASS],
        .lattice_factors = a->factors,
        .chain_factors = a->factors,
        .force_x = a->by_slot[FORCE_X],
        .force_y = a->by_slot[FORCE_Y],
        .xx = a->by_slot[XX],
        .xy = a->by_slot[XY],
        .yy = a->by_slot[YY],
        .force_carry_x = a->force_carry,
        .force_carry_y = a->force_carry + ROW * W,
        .carry_xx = a->carry,
        .carry_xy = a->carry + ROW * W,
        .carry_yy = a->carry + 2 * ROW * W,
    };
}

static mspringi_iterate iterate_of(arena *a) {
    return (mspringi_iterate){
        .solution_x = a->by_slot[SOLUTION_X],
        .solution_y = a->by_slot[SOLUTION_Y],
        .residual_x = a->by_slot[RESIDUAL_X],
        .residual_y = a->by_slot[RESIDUAL_Y],
        .scaled_x = a->by_slot[SCALED_X],
        .scaled_y = a->by_slot[SCALED_Y],
        .direction_x = a->by_slot[DIRECTION_X],
        .direction_y = a->by_slot[DIRECTION_Y],
        .product_x = a->by_slot[PRODUCT_X],
        .product_y = a->by_slot[PRODUCT_Y],
        .arm_x = a->by_slot[ARM_X],
        .arm_y = a->by_slot[ARM_Y],
    };
}

/// What a run is about.
typedef struct setup {
    uint32_t blocks;       ///< of the row; of what goes by slot, the range
    uint32_t live;         ///< springs' columns
    uint32_t idle;         ///< quarters that the first span lacks in front
    uint32_t split;        ///< blocks in the first of two spans; 0: one span
    uint32_t parts;        ///< 2 or 3
    uint32_t record_slots; ///< of chains
    uint32_t first;        ///< block where a range begins, chunk where one of advance() does
    int variant;
    bool has_above;
    uint64_t seed;
} setup;

typedef void (*run_fn)(arena *a, const setup *s, const mspringi_system_kernels *k);

/// Run on two arenas that are alike; they must be afterwards.
static void compare(const char *name, const setup *s, run_fn run, bool changes) {
    arena *mine = support_aligned_alloc(sizeof *mine), *reference = support_aligned_alloc(sizeof *reference);
    arena *before = support_aligned_alloc(sizeof *before);
    memset(before, 0, sizeof *before);
    fill(before, s->live, s->parts, s->has_above, s->seed);
    memcpy(mine, before, sizeof *mine);
    memcpy(reference, before, sizeof *reference);
    run(mine, s, kernels);
    run(reference, s, scalar);
    check_canaries(mine);
    check_canaries(reference);
    // Nothing pulls with +0 or with -0: see test_kernels.c.
    for (size_t i = 0; i < COUNT_OF(mine->carry); i++) {
        mine->carry[i] += 0.0f;
        reference->carry[i] += 0.0f;
    }
    if (memcmp(mine, reference, sizeof *mine) != 0) {
        size_t place = 0;
        while (((const char *)mine)[place] == ((const char *)reference)[place]) {
            place++;
        }
        print_error(
            "%s: blocks %u, live %u, idle %u, split %u, parts %u, first %u, variant %d: differs in byte %zu "
            "(by_slot at %zu, factors at %zu, carry at %zu, sums at %zu)\n",
            name, s->blocks, s->live, s->idle, s->split, s->parts, s->first, s->variant, place,
            offsetof(arena, by_slot), offsetof(arena, factors), offsetof(arena, carry), offsetof(arena, sums));
        fail();
    }
    if (changes) {
        assert_true(memcmp(mine, before, sizeof *mine) != 0);
    }
    support_aligned_free(mine);
    support_aligned_free(reference);
    support_aligned_free(before);
}

/* ------------------------------------------------------------------------------------------------------ by row */

/// The row, in one span or in two.
static uint32_t spans_of(const setup *s, mspringi_span spans[3]) {
    spans[0] = (mspringi_span){
        .first_slot = W + s->idle * MSPRINGI_QUARTER,
        .end_slot = W + s->blocks * W,
        .record_slots = s->record_slots,
        .up = s->has_above ? ABOVE : 0,
        .carry = -W,
    };
    spans[1] = spans[2] = spans[0];
    const uint32_t halo = W + s->split * W;
    if (s->split == 0 || spans[0].first_slot >= halo || spans[0].end_slot <= halo) {
        return s->blocks > 0;
    }
    spans[0].end_slot = spans[1].first_slot = halo;
    spans[1].first_record = s->split;
    return 2;
}

static void run_assemble(arena *a, const setup *s, const mspringi_system_kernels *k) {
    mspringi_span spans[3];
    const mspringi_system system = system_of(a, s->parts);
    const uint32_t count = spans_of(s, spans);
    const bool damped = s->parts > MSPRINGI_DAMPING;
    (s->variant == 0   ? k->assemble_lattice
     : s->variant == 1 ? k->assemble_chain
                       : k->carry_forces)[damped](&system, spans, count);
}

/// Nothing is in the quarters that a span leaves out in front; wide vectors go over them all the same.
static void clear_idle(arena *a, const setup *s) {
    for (uint32_t column = 0; column < s->idle * MSPRINGI_QUARTER; column++) {
        for (int array = 0; array < 24; array++) {
            a->by_slot[array][W + column] = a->by_slot[array][W + ABOVE + column] = 0;
        }
        for (uint32_t i = 0; i < MSPRINGI_DIRECTIONS * MSPRINGI_FACTORS; i++) {
            a->factors[i * W + column] = 0;
        }
        a->carry[column] = a->carry[ROW * W + column] = 0;
    }
}

static void run_multiply(arena *a, const setup *s, const mspringi_system_kernels *k) {
    mspringi_span spans[3];
    const mspringi_system system = system_of(a, s->parts);
    const mspringi_iterate n = iterate_of(a);
    const uint32_t count = spans_of(s, spans);
    clear_idle(a, s);
    if (s->variant == 2) {
        k->carry_product(&system, spans, count, n.direction_x, n.direction_y);
        return;
    }
    a->sums[0] = (s->variant == 0 ? k->multiply_lattice : k->multiply_chain)(
        &system, spans, count, n.direction_x, n.direction_y, n.product_x, n.product_y);
}

static void compare_rows(const char *name, run_fn run) {
    for (uint32_t blocks = 0; blocks <= ROW; blocks++) {
        for (uint32_t live = 0; live <= blocks * W; live += live < W ? 5 / ROUNDS(5) : 7) {
            for (int variant = 0; variant < 3; variant++) {
                for (uint32_t other = 0; other < 8; other++) {
                    const setup s = {
                        .blocks = blocks,
                        .live = live,
                        .idle = blocks > 1 ? other / 2 % 4 : 0,
                        .split = other & 1 && blocks > 1 ? 1 + live % (blocks - 1) : 0,
                        .parts = 2 + (other >> 1 & 1),
                        .record_slots = variant == 1 && other >> 2 & 1 ? W : MSPRINGI_DIRECTIONS * W,
                        .variant = variant,
                        .has_above = variant != 1,
                        .seed = blocks * 1000 + live * 10 + other,
                    };
                    compare(name, &s, run, blocks > 0 && live > 0);
                }
            }
        }
    }
}

static void assembly(void **state) {
    (void)state;
    compare_rows("assemble", run_assemble);
}

static void products(void **state) {
    (void)state;
    compare_rows("multiply", run_multiply);
}

/// What a row hands on is the same whether it is multiplied or only asked for that.
static void what_is_handed_on(void **state) {
    (void)state;
    arena *whole = support_aligned_alloc(sizeof *whole), *only = support_aligned_alloc(sizeof *only);
    for (uint32_t blocks = 1; blocks <= ROW; blocks++) {
        for (int forces = 0; forces < 2; forces++) {
            setup s = {.blocks = blocks, .parts = 3, .record_slots = MSPRINGI_DIRECTIONS * W, .has_above = true};
            fill(whole, blocks * W, s.parts, true, blocks);
            fill(only, blocks * W, s.parts, true, blocks);
            (forces ? run_assemble : run_multiply)(whole, &s, kernels);
            s.variant = 2;
            (forces ? run_assemble : run_multiply)(only, &s, kernels);
            assert_memory_equal(whole->carry, only->carry, sizeof whole->carry);
            assert_memory_equal(whole->force_carry, only->force_carry, sizeof whole->force_carry);
            assert_memory_not_equal(whole->by_slot, only->by_slot, sizeof whole->by_slot);
        }
    }
    support_aligned_free(whole);
    support_aligned_free(only);
}

/* ----------------------------------------------------------------------------------------------------- by slot */

static mspringi_prediction flight_of(arena *a) {
    return (mspringi_prediction){
        .x = a->by_slot[SOLUTION_X],
        .y = a->by_slot[SOLUTION_Y],
        .vx = a->by_slot[VX],
        .vy = a->by_slot[VY],
        .low_x = a->by_slot[LOW],
        .low_y = a->by_slot[FIRST],
        .first_x = a->by_slot[SECOND],
        .first_y = a->by_slot[XY],
        .inverse_mass = a->by_slot[INVERSE_MASS],
        .mass = a->by_slot[MASS],
        .h = 0.015f,
        .first_share = 0.25f,
        .rate = 90,
        .turned_x = a->by_slot[SCALED_X],
        .turned_y = a->by_slot[SCALED_Y],
        .arm_x = a->by_slot[ARM_X],
        .arm_y = a->by_slot[ARM_Y],
        .to_x = a->predicted_x,
        .to_y = a->predicted_y,
        .start_vx = a->by_slot[PRODUCT_X],
        .start_vy = a->by_slot[PRODUCT_Y],
    };
}

static void run_by_slot(arena *a, const setup *s, const mspringi_system_kernels *k) {
    const size_t first = s->first * W, end = first + s->blocks * W;
    const mspringi_system system = system_of(a, 2);
    const mspringi_prediction flight = flight_of(a);
    mspringi_outside outside = {
        .mass = a->by_slot[MASS],
        .force = s->variant & 1 ? a->by_slot[FORCE_X] : NULL,
        .velocity = a->by_slot[VX],
        .turned = a->by_slot[SCALED_X],
        .first = a->by_slot[FIRST],
        .second = s->variant & 2 ? a->by_slot[SECOND] : NULL,
        .force_fraction = 0.1f,
        .velocity_fraction = -0.2f,
        .turned_fraction = 0.9f,
        .first_share = 0.3f,
        .second_share = 0.4f,
        .shift = -9,
    };
    // With the history written to other arrays and to where it was.
    const bool apart = s->variant & 4;
    mspringi_correction landing = {
        .predicted = a->predicted_x,
        .inverse_mass = a->by_slot[INVERSE_MASS],
        .solution = a->by_slot[SOLUTION_X],
        .direction = a->by_slot[DIRECTION_X],
        .low = a->by_slot[LOW],
        .first = a->by_slot[FIRST],
        .position = a->by_slot[SOLUTION_Y],
        .velocity = a->by_slot[VY],
        .to_low = a->by_slot[apart ? ARM_X : LOW],
        .to_first = a->by_slot[apart ? ARM_Y : FIRST],
        .to_second = a->by_slot[SECOND],
        .low_velocity = s->variant & 1 ? a->by_slot[FORCE_X] : NULL,
        .alpha = 0.7f,
        .h = 0.015f,
        .first_share = 0.004f,
        .rate = 90,
    };
    k->scale_masses(a->by_slot[INVERSE_MASS], 3, a->by_slot[MASS], first, end);
    k->predict(&flight, first, end);
    k->add_outside(&outside, a->by_slot[RESIDUAL_X], first, end);
    k->invert(&system, first, end);
    k->correct[s->variant % MSPRINGI_HISTORY_KINDS](&landing, first, end);
}

/// Inverted blocks are inverses, of the springs' part and the mass; slots without a mass have 0.
static void blocks_are_inverted(void **state) {
    (void)state;
    arena *before = support_aligned_alloc(sizeof *before), *after = support_aligned_alloc(sizeof *after);
    fill(before, W, 2, false, 3);
    fill(after, W, 2, false, 3);
    const mspringi_system system = system_of(after, 2);
    kernels->invert(&system, 0, MANY);
    for (uint32_t i = 0; i < MANY; i++) {
        const double mass = (double)before->by_slot[MASS][i], is_there = mass > 0 ? 1 : 0;
        const double a = mass + (double)before->by_slot[XX][i], b = (double)before->by_slot[XY][i],
                     d = mass + (double)before->by_slot[YY][i];
        const double xx = (double)after->by_slot[XX][i], xy = (double)after->by_slot[XY][i],
                     yy = (double)after->by_slot[YY][i];
        check_near(a * xx + b * xy, is_there, 1e-4);
        check_near(b * xy + d * yy, is_there, 1e-4);
        check_near(a * xy + b * yy, 0, 1e-4);
    }
    support_aligned_free(before);
    support_aligned_free(after);
}

static void passes_by_slot(void **state) {
    (void)state;
    for (uint32_t blocks = 0; blocks <= 5; blocks++) {
        for (uint32_t first = 0; first < 3; first++) {
            for (int variant = 0; variant < 8; variant++) {
                const setup s = {.blocks = blocks,
                                 .first = first,
                                 .variant = variant,
                                 .parts = 2,
                                 .live = W,
                                 .seed = blocks * 10 + first};
                compare("by slot", &s, run_by_slot, blocks > 0);
            }
        }
    }
}

static void run_advance(arena *a, const setup *s, const mspringi_system_kernels *k) {
    const mspringi_system system = system_of(a, 2);
    const mspringi_iterate n = iterate_of(a);
    const size_t first = (size_t)s->first * MSPRINGI_CHUNK, end = first + s->blocks * W;
    k->advance(&system, &n, 0.3f, s->variant == 0, first, end < MANY ? end : MANY, a->sums);
}

/// Every slot of every chunk goes by its own direction.
static void check_step(bool is_first) {
    arena *before = support_aligned_alloc(sizeof *before), *after = support_aligned_alloc(sizeof *after);
    fill(before, W, 2, false, 1);
    fill(after, W, 2, false, 1);
    run_advance(after, &(setup){.blocks = MANY / W, .variant = !is_first}, kernels);
    for (int axis = 0; axis < 2; axis++)
        for (uint32_t i = 0; i < MANY; i++) {
            const float from = is_first ? 0 : before->by_slot[SOLUTION_X + axis][i];
            const float rest = before->by_slot[RESIDUAL_X + axis][i];
            check_near((double)after->by_slot[SOLUTION_X + axis][i],
                       (double)(from + 0.3f * before->by_slot[DIRECTION_X + axis][i]), 1e-6);
            check_near((double)after->by_slot[RESIDUAL_X + axis][i],
                       (double)(rest - 0.3f * before->by_slot[PRODUCT_X + axis][i]), 1e-6);
        }
    support_aligned_free(before);
    support_aligned_free(after);
}

static void advances(void **state) {
    (void)state;
    for (uint32_t blocks = 0; blocks * W <= MANY; blocks += blocks < 4 ? 1 : 13) {
        for (uint32_t first = 0; first < 3; first++) {
            for (int variant = 0; variant < 2; variant++) {
                const setup s = {
                    .blocks = blocks, .first = first, .variant = variant, .parts = 2, .live = W, .seed = blocks};
                compare("advance", &s, run_advance, blocks > 0);
            }
        }
    }
    for (int variant = 0; variant < 2; variant++)
        check_step(variant == 0);
    // A sum does not depend on which chunks are asked for together.
    arena *whole = support_aligned_alloc(sizeof *whole), *pieces = support_aligned_alloc(sizeof *pieces);
    fill(whole, W, 2, false, 1);
    fill(pieces, W, 2, false, 1);
    run_advance(whole, &(setup){.blocks = MANY / W}, kernels);
    for (uint32_t chunk = 3; chunk-- > 0;) {
        run_advance(pieces, &(setup){.blocks = MSPRINGI_CHUNK / W, .first = chunk}, kernels);
    }
    assert_memory_equal(whole->sums, pieces->sums, sizeof whole->sums);
    assert_memory_equal(whole->by_slot, pieces->by_slot, sizeof whole->by_slot);
    support_aligned_free(whole);
    support_aligned_free(pieces);
}

/* ------------------------------------------------------------------------------------------------------ energy */

static mspringi_motion motion_of(arena *a, bool is_precise) {
    return (mspringi_motion){.x = a->by_slot[ARM_X],
                             .y = a->by_slot[ARM_Y],
                             .vx = a->by_slot[VX],
                             .vy = a->by_slot[VY],
                             .low_x = a->by_slot[LOW],
                             .low_y = a->by_slot[FIRST],
                             .low_vx = is_precise ? a->by_slot[SECOND] : NULL,
                             .low_vy = is_precise ? a->by_slot[RESIDUAL_X] : NULL,
                             .inverse_mass = a->by_slot[MASS]};
}

static void run_moments(arena *a, const setup *s, const mspringi_system_kernels *k) {
    const mspringi_motion motion = motion_of(a, s->variant != 0);
    const double origin[] = {0.3, -2, 1.5, 7};
    const size_t first = s->first * W;
    k->moments(&motion, first, first + s->blocks * W, origin, a->results);
}

static void moments(void **state) {
    (void)state;
    for (uint32_t blocks = 0; blocks <= 5; blocks++) {
        for (uint32_t first = 0; first < 6; first++) {
            const setup s = {.blocks = blocks,
                             .first = first % 3,
                             .variant = first / 3,
                             .parts = 2,
                             .live = W,
                             .seed = blocks * 10 + first};
            compare("moments", &s, run_moments, true);
        }
    }
}

/// Lay every seventh particle upon the one before: a spring between them has no direction.
static void lay_upon_others(arena *a) {
    const int arrays[] = {ARM_X, ARM_Y, LOW, FIRST};
    for (uint32_t slot = 6; slot < MANY; slot += 7) {
        for (size_t i = 0; i < COUNT_OF(arrays); i++) {
            a->by_slot[arrays[i]][slot] = a->by_slot[arrays[i]][slot - 1];
        }
    }
}

static void run_elastic(arena *a, const setup *s, const mspringi_system_kernels *k) {
    mspringi_span spans[3];
    mspringi_elastic of_block[MANY / W] = {{0}};
    const mspringi_system system = system_of(a, s->parts);
    const mspringi_motion motion = motion_of(a, false);
    const uint32_t count = spans_of(s, spans);
    lay_upon_others(a);
    k->elastic(&system, &motion, spans, count, s->has_above, of_block);
    for (size_t block = 0; block < MANY / W; block++) {
        a->results[block % TILES * 2] += of_block[block].energy;
        a->results[block % TILES * 2 + 1] += of_block[block].length;
    }
}

static void elastic(void **state) {
    (void)state;
    compare_rows("elastic", run_elastic);
}

/* ----------------------------------------------------------------------------------------------------- by tile */

static void run_by_parts(arena *a, const setup *s, const mspringi_system_kernels *k) {
    const mspringi_iterate n = iterate_of(a);
    const mspringi_prediction flight = flight_of(a);
    const size_t count = s->blocks < a->part_count ? s->blocks : a->part_count;
    double bodies[TILES][3];
    memcpy(bodies, a->bodies, sizeof bodies);
    for (uint32_t tile = 0; tile < TILES; tile++) {
        mspringi_tile_part own[PARTS];
        size_t own_count = 0;
        for (size_t p = 0; p < count; p++) {
            if (a->parts[p].tile == tile) {
                own[own_count++] = a->parts[p];
            }
        }
        k->restrict_to_tile(&n, own, own_count, a->bodies + (size_t)3 * tile);
        k->inertia_of_tile(&n, a->by_slot[XX], own, own_count, a->results + (size_t)2 * tile);
        if (own_count > 0 && s->variant == 0) {
            // Masses of no weight would make infinities, whose signs are the compilers' own.
            mspringi_prediction heavy = flight;
            heavy.mass = a->by_slot[XX];
            k->find_tile_motion(&heavy, own, own_count, &a->flights[tile]);
        }
    }
    k->rotate_tiles(&flight, a->parts, count, a->flights);
    k->update_search[s->variant](&n, a->parts, count, (const double(*)[3])bodies, 0.6f);
}

static void passes_by_part(void **state) {
    (void)state;
    for (uint32_t count = 0; count <= PARTS; count += count < 8 ? 1 : 8) {
        for (int variant = 0; variant < MSPRINGI_SEARCH_UPDATES; variant++) {
            for (uint64_t seed = 0; seed < ROUNDS(20); seed++) {
                const setup s = {.blocks = count, .variant = variant, .parts = 2, .live = W, .seed = seed};
                compare("by part", &s, run_by_parts, count > 0);
            }
        }
    }
}

/// Slots of a tile's part get what is theirs, the others at the same slots nothing.
static void weights_are_those_of_the_lanes(void **state) {
    (void)state;
    for (uint32_t lanes = 0; lanes < 1u << MSPRINGI_PART; lanes++) {
        for (uint32_t lane = 0; lane < MSPRINGI_PART; lane++) {
            const bool is_set = mspringi_part_weights[lanes][lane] > 0;
            assert_int_equal(is_set, lanes >> lane & 1);
        }
    }
}

enum { NODES = 4 * W };

/// Blocks of a matrix in double precision: three arrays behind one another, and what lies around them.
typedef struct doubles {
    double nodes[3 * NODES], before[W], edges[3 * W], after[W];
} doubles;

static void fill_doubles(doubles *d, uint64_t seed) {
    double *values = (double *)d;
    for (size_t i = 0; i < sizeof *d / sizeof *values; i++) {
        values[i] = support_random_between(&seed, 0, 1e6);
    }
}

/// A spring after the other, each to its ends.
static void add_one_by_one(const mspringi_edge_block *block, const float *factors, doubles *d) {
    for (uint32_t i = 0; i < W; i++) {
        const double pull_x = (double)factors[i], pull_y = (double)factors[W + i];
        const double geometric = (double)factors[2 * W + i];
        const double spring[] = {geometric + pull_x * pull_x, pull_x * pull_y, geometric + pull_y * pull_y};
        for (int part = 0; part < 3; part++) {
            d->edges[part * W + i] = -spring[part];
            if (block->lanes >> i & 1) {
                d->nodes[part * NODES + block->base + i] += spring[part];
                d->nodes[part * NODES + block->tip + i] += spring[part];
            }
        }
    }
}

static void edges_in_double_precision(void **state) {
    (void)state;
    // To the right and to the left, where springs share ends, by less than a block and by more.
    static const uint32_t ends[][2] = {{W, W + 1}, {W + 1, W}, {W, W + 5}, {W + 5, W}, {0, 2 * W}, {3 * W, 7}};
    uint64_t seed = 11;
    for (size_t n = 0; n < 8 * COUNT_OF(ends); n++) {
        const uint32_t *at = ends[n % COUNT_OF(ends)];
        const uint32_t any = (uint32_t)support_random(&seed) & ((1u << W) - 1);
        const mspringi_edge_block block = {at[0], at[1], n < COUNT_OF(ends) ? (1u << W) - 1 : any};
        _Alignas(64) float factors[MSPRINGI_FACTORS * W];
        for (size_t i = 0; i < COUNT_OF(factors); i++) {
            factors[i] = random_float(&seed, -1e3, 1e3);
        }
        doubles expected, found;
        fill_doubles(&expected, n);
        fill_doubles(&found, n);
        add_one_by_one(&block, factors, &expected);
        const mspringi_blocks_double edges = {found.edges, found.edges + W, found.edges + 2 * W};
        const mspringi_blocks_double nodes = {found.nodes, found.nodes + NODES, found.nodes + 2 * NODES};
        kernels->add_edges(&block, factors, &edges, &nodes);
        assert_memory_equal(&expected, &found, sizeof found);
    }
}

int main(int argc, char **argv) {
    kernels = &level_kernels(argc, argv)->system;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(assembly),
        cmocka_unit_test(products),
        cmocka_unit_test(what_is_handed_on),
        cmocka_unit_test(passes_by_slot),
        cmocka_unit_test(blocks_are_inverted),
        cmocka_unit_test(advances),
        cmocka_unit_test(moments),
        cmocka_unit_test(elastic),
        cmocka_unit_test(passes_by_part),
        cmocka_unit_test(weights_are_those_of_the_lanes),
        cmocka_unit_test(edges_in_double_precision),
    };
    return cmocka_run_group_tests_name("system_kernels", tests, NULL, NULL);
}

/// @file test_kernels.c
/// Every kernel of a level against the scalar one, byte for byte, with canaries around all that it may touch:
/// sweeps of 0 to 3 blocks, of 0 to 2 w + 1 particles, in one span and in two that continue each other.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "level_kernels.h"
#include "support.h"

static const mspringi_kernels *kernels;

enum {
    W = MSPRINGI_WIDTH,
    ROW = 3,                             // most blocks in a sweep
    SLOTS = (1 + ROW + 1 + ROW + 1) * W, // padding, the row, padding, the row above, padding
    FIRST = 1,                           // block where the row begins,
    ABOVE = 1 + ROW + 1,                 // and the one above it
    CARRY = ROW * W,
    RECORDS = ROW * MSPRINGI_DIRECTIONS * 3 * W,
    GUARD = 4 * W,
    STRIDE = SLOTS + GUARD // from x to y and on to the velocities
};

#define CANARY 0xc5c5c5c5u

/// All memory of a sweep, each array between two canaries. One of these per run, so that runs can be compared
/// whole.
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
    float inverse_mass[SLOTS];
    uint32_t after_inverse_mass[GUARD];
    float force_x[SLOTS];
    uint32_t after_force_x[GUARD];
    float force_y[SLOTS];
    uint32_t after_force_y[GUARD];
    float carry_x[CARRY];
    uint32_t after_carry_x[GUARD];
    float carry_y[CARRY];
    uint32_t after_carry_y[GUARD];
    float records[RECORDS];
    uint32_t after_records[GUARD];
    float rest_lengths[ROW * MSPRINGI_DIRECTIONS * W];
    float cells[ROW * 2 * W];
    uint32_t rests_of_block[ROW];
    uint32_t springs_of_block[ROW];
    uint32_t back[GUARD];
    _Alignas(64) float kept[8 * STRIDE];
    uint32_t after_kept[GUARD];
    mspringi_extrema_lanes watch;
    mspringi_extrema extrema; ///< of the watch
} arena;

static arena *arena_new(void) {
    arena *made = support_aligned_alloc(sizeof *made);
    assert_int_equal(offsetof(arena, x) % 64, 0);
    assert_int_equal(offsetof(arena, records) % 64, 0);
    assert_int_equal(offsetof(arena, rest_lengths) % 64, 0);
    assert_int_equal(offsetof(arena, y) - offsetof(arena, x), STRIDE * sizeof(float));
    for (size_t i = 0; i < sizeof *made / sizeof(uint32_t); i++) {
        ((uint32_t *)(void *)made)[i] = CANARY;
    }
    return made;
}

static arena *copy_of(const arena *a) {
    arena *made = support_aligned_alloc(sizeof *made);
    memcpy(made, a, sizeof *made);
    return made;
}

static void check_canaries(const arena *a) {
    const uint32_t *guards[] = {a->front,         a->after_x,       a->after_y,       a->after_vx,
                                a->after_vy,      a->after_carry_x, a->after_records, a->after_inverse_mass,
                                a->after_force_x, a->after_force_y, a->after_carry_y, a->back,
                                a->after_kept,    a->after_low_x,   a->after_low_y,   a->after_low_vx,
                                a->after_low_vy};
    for (size_t i = 0; i < COUNT_OF(guards); i++) {
        for (size_t j = 0; j < GUARD; j++) {
            assert_int_equal(guards[i][j], CANARY);
        }
    }
}

/// How a sweep is set up.
typedef struct setup {
    uint32_t blocks; ///< 0 to ROW
    uint32_t live;   ///< particles in the row; the slots behind them are empty
    uint32_t idle;   ///< slots in front of the first particle
    uint32_t split;  ///< blocks in the first of two spans; 0: one span
    uint32_t parts;  ///< 2 or 3
    bool from_below; ///< a row below has left forces
    bool has_above;  ///< there is a row above; else the row itself stands for it
    bool forced;     ///< there are forces from outside
    bool keeps;      ///< the state that is found; else it is there already, or something like it
    bool watches_coordinate, watches_speed, watches_change;
    uint32_t record_slots;
    uint64_t seed;
} setup;

static float random_float(uint64_t *seed, double low, double high) {
    return (float)support_random_between(seed, low, high);
}

static void fill(arena *a, const setup *s) {
    uint64_t seed = s->seed;
    for (uint32_t i = 0; i < SLOTS; i++) {
        // A grid that is off by a little; every seventh particle lies on the next one.
        uint32_t slot = i % ((ROW + 1) * W);
        a->x[i] = i % 7 == 6 && i > 0 ? a->x[i - 1] : (float)slot - 30 + random_float(&seed, -0.2, 0.2);
        a->y[i] = i % 7 == 6 && i > 0 ? a->y[i - 1] : (i >= ABOVE * W) + random_float(&seed, -0.2, 0.2);
        a->vx[i] = random_float(&seed, -5, 5);
        a->vy[i] = random_float(&seed, -5, 5);
        a->low_x[i] = random_float(&seed, -1e-7, 1e-7);
        a->low_y[i] = random_float(&seed, -1e-7, 1e-7);
        a->low_vx[i] = random_float(&seed, -1e-7, 1e-7);
        a->low_vy[i] = random_float(&seed, -1e-7, 1e-7);
        a->inverse_mass[i] = support_random(&seed) % 9 == 0 ? 0 : random_float(&seed, 0.1, 3);
        a->force_x[i] = random_float(&seed, -50, 50);
        a->force_y[i] = random_float(&seed, -50, 50);
        bool in_row = i >= FIRST * W + s->idle && i < FIRST * W + s->idle + s->live;
        bool in_row_above = s->has_above && i >= ABOVE * W + s->idle && i < ABOVE * W + s->idle + s->live;
        if (!in_row && !in_row_above) {
            a->x[i] = a->y[i] = a->vx[i] = a->vy[i] = a->low_x[i] = a->low_y[i] = a->inverse_mass[i] = 0;
            a->low_vx[i] = a->low_vy[i] = 0;
        }
    }
    for (uint32_t i = 0; i < 8 * STRIDE; i++) {
        const bool is_empty = i % STRIDE >= SLOTS || (a->x[i % STRIDE] == 0 && a->vx[i % STRIDE] == 0);
        a->kept[i] = is_empty || s->keeps ? 0 : random_float(&seed, -5, 5);
    }
    a->watch = (mspringi_extrema_lanes){{0}, {0}, {0}};
    a->extrema = (mspringi_extrema){0, 0, 0};
    for (uint32_t i = 0; i < CARRY; i++) {
        // Only where there are particles: the row below has no spring to an empty slot.
        bool pulled = s->from_below && i >= s->idle && i < s->idle + s->live;
        a->carry_x[i] = pulled ? random_float(&seed, -100, 100) : 0;
        a->carry_y[i] = pulled ? random_float(&seed, -100, 100) : 0;
    }
    for (uint32_t i = 0; i < RECORDS; i++) {
        a->records[i] = 0;
    }
    for (uint32_t i = 0; i < ROW * s->record_slots; i++) {
        uint32_t record = i / s->record_slots, direction = i % s->record_slots / W, lane = i % W;
        const bool lattice = s->record_slots > W;
        float *first = a->records +
                       ((size_t)(lattice ? (record + 1) % ROW : record) * s->record_slots + direction * W) *
                           (s->parts - lattice) +
                       lane;
        a->rests_of_block[record] = ROW - 1 - record;
        a->springs_of_block[record] = (record + 1) % ROW;
        float *rest_length =
            lattice ? a->rest_lengths + ((ROW - 1 - record) * MSPRINGI_DIRECTIONS + direction) * W + lane : first;
        float *stiffness = lattice ? first : first + W;
        uint32_t column = record * W + lane;
        bool spring = column >= s->idle && column < s->idle + s->live && support_random(&seed) % 5 != 0 &&
                      (s->has_above || direction == MSPRINGI_EAST);
        *rest_length = spring ? random_float(&seed, 0.9, 1.5) : 0;
        *stiffness = spring ? random_float(&seed, 10, 1000) : 0;
        if (s->parts > MSPRINGI_DAMPING) {
            stiffness[W] = spring ? random_float(&seed, 0, 30) : 0;
        }
    }
    for (uint32_t column = 0; column < ROW * W; column++) {
        const bool cell = column >= s->idle && column < s->idle + s->live && s->has_above && column % 5 != 4;
        float *first = a->cells + (size_t)column / W * 2 * W + column % W;
        first[0] = cell ? random_float(&seed, -300, 300) : 0;
        first[W] = cell ? random_float(&seed, 0, 300) : 0;
    }
}

static void run(arena *a, const setup *s, mspringi_row_fn kernel, mspringi_extrema_fn extrema_of) {
    const mspringi_sweep sweep = {
        .x = a->x,
        .y = a->y,
        .vx = a->vx,
        .vy = a->vy,
        .low_x = a->low_x,
        .low_y = a->low_y,
        .low_vx = a->low_vx,
        .low_vy = a->low_vy,
        .grid = 0x1p-22f * 0x1.8p23f,
        .flushes = s->seed % 2,
        .inverse_mass = a->inverse_mass,
        .force_x = s->forced ? a->force_x : NULL,
        .force_y = s->forced ? a->force_y : NULL,
        .carry_x = a->carry_x,
        .carry_y = a->carry_y,
        .lattice_springs = a->records,
        .rest_lengths = a->rest_lengths,
        .rests_of_block = a->rests_of_block,
        .springs_of_block = a->springs_of_block,
        .cells = a->cells,
        .chain_springs = a->records,
        .parts = s->parts,
        .h = 0.01f,
        .kick = 0.0075f,
        .loss = 0.01f,
        .gravity_h_x = 0.015f,
        .gravity_h_y = -0.098f,
        .keep = s->keeps ? a->kept : NULL,
        .watch = s->watches_coordinate || s->watches_speed || s->watches_change ? &a->watch : NULL,
        .before = s->watches_change ? a->kept + 2 * (size_t)STRIDE : NULL,
        .watches_coordinate = s->watches_coordinate,
        .watches_speed = s->watches_speed,
    };
    // The last particle's springs reach one slot further.
    const uint32_t busy_end = s->live > 0 ? s->idle + s->live + 1 : 0, end = s->blocks * W;
    const uint32_t idle_back = s->live > 0 && busy_end < end && end - busy_end < W ? end - busy_end : 0;
    mspringi_span spans[3] = {{
        .first_slot = FIRST * W + s->idle / MSPRINGI_QUARTER * MSPRINGI_QUARTER,
        .end_slot = FIRST * W + end - idle_back / MSPRINGI_QUARTER * MSPRINGI_QUARTER,
        .first_record = s->idle / W,
        .record_slots = s->record_slots,
        .up = s->has_above ? (ABOVE - FIRST) * W : 0,
        .carry = -FIRST * W,
    }};
    uint32_t count = s->blocks > 0;
    const uint32_t halo = (FIRST + s->split) * W;
    if (s->split > 0 && spans[0].first_slot < halo && spans[0].end_slot > halo) {
        spans[1] = spans[0];
        spans[0].end_slot = spans[1].first_slot = halo;
        spans[1].first_record = s->split;
        count = 2;
    }
    kernel(&sweep, spans, count);
    // Which lane has seen what is a level's own business.
    a->extrema = extrema_of(&a->watch);
    a->watch = (mspringi_extrema_lanes){{0}, {0}, {0}};
}

/// What a watch has to see of a row that has been moved.
static mspringi_extrema expected_extrema(const arena *a, const setup *s) {
    mspringi_extrema extrema = {0, 0, 0};
    for (uint32_t i = FIRST * W; i < (FIRST + s->blocks) * W; i++) {
        if (s->watches_coordinate) {
            extrema.coordinate = fmaxf(extrema.coordinate, fmaxf(fabsf(a->x[i]), fabsf(a->y[i])));
        }
        if (s->watches_speed) {
            extrema.speed = fmaxf(extrema.speed, fmaxf(fabsf(a->vx[i]), fabsf(a->vy[i])));
        }
        if (s->watches_change) {
            const float *before = a->kept + 2 * (size_t)STRIDE + i;
            extrema.change = fmaxf(extrema.change, fabsf(a->vx[i] - before[0]));
            extrema.change = fmaxf(extrema.change, fabsf(a->vy[i] - before[STRIDE]));
        }
    }
    return extrema;
}

/// A force of zero may be +0 or -0 where no spring pulls: the step's result is the same.
static void drop_signs_of_zero(float *values, size_t count) {
    for (size_t i = 0; i < count; i++) {
        values[i] += 0.0f;
    }
}

static void compare(const setup *s, mspringi_row_fn kernel, mspringi_row_fn scalar, mspringi_row_kind kind) {
    arena *before = arena_new();
    fill(before, s);
    arena *mine = copy_of(before), *reference = copy_of(before);
    run(mine, s, kernel, kernels->extrema_of);
    run(reference, s, scalar, mspringi_kernels_scalar.extrema_of);
    check_canaries(mine);
    check_canaries(reference);
    drop_signs_of_zero(mine->carry_x, CARRY);
    drop_signs_of_zero(mine->carry_y, CARRY);
    drop_signs_of_zero(reference->carry_x, CARRY);
    drop_signs_of_zero(reference->carry_y, CARRY);
    if (memcmp(mine, reference, sizeof *mine) != 0) {
        size_t place = 0;
        while (((const char *)mine)[place] == ((const char *)reference)[place]) {
            place++;
        }
        print_error(
            "kind %d, blocks %u, live %u, split %u, parts %u, below %d, above %d: differs in byte %zu (x at "
            "%zu, vx at %zu, carry at %zu)\n",
            kind, s->blocks, s->live, s->split, s->parts, s->from_below, s->has_above, place, offsetof(arena, x),
            offsetof(arena, vx), offsetof(arena, carry_x));
        fail();
    }
    const mspringi_extrema expected = expected_extrema(mine, s);
    if (kind != MSPRINGI_ROW_LOOSE) {
        assert_memory_equal(&mine->extrema, &expected, sizeof expected);
        const float *found[] = {before->x, before->y, before->vx, before->vy};
        for (uint32_t i = 0; s->keeps && i < 4 * s->live; i++) {
            const uint32_t slot = FIRST * W + s->idle + i / 4;
            assert_true(mine->kept[slot + i % 4 * STRIDE] == found[i % 4][slot]);
        }
    }
    // And the sweep has moved something, if there is anything.
    assert_int_equal(memcmp(mine->x, before->x, sizeof mine->x) != 0, s->blocks > 0 && s->live > 0);
    support_aligned_free(mine);
    support_aligned_free(reference);
    support_aligned_free(before);
}

/// All setups for one kernel.
static void compare_all(mspringi_row_kind kind, uint32_t parts, uint32_t record_slots, bool forced,
                        mspringi_row_fn kernel, mspringi_row_fn scalar) {
    for (uint32_t blocks = 0; blocks <= ROW; blocks++) {
        for (uint32_t live = 0; live <= 2 * W + 1 && live <= blocks * W; live++) {
            for (uint32_t variant = 0; variant < 32; variant += 5 / ROUNDS(5)) {
                setup s = {
                    .blocks = blocks,
                    .live = live,
                    .idle = variant / 8 * 5 + live <= blocks * W ? variant / 8 * 5 : 0,
                    .parts = parts,
                    .from_below = (variant & 1) && kind == MSPRINGI_ROW_LATTICE,
                    .has_above = (variant & 2) && kind == MSPRINGI_ROW_LATTICE,
                    .split = (variant & 4) && blocks > 1 ? 1 + live % (blocks - 1) : 0,
                    .forced = forced,
                    .keeps = live % 3 == 1,
                    .watches_coordinate = live % 4 == 1 || variant % 5 == 1,
                    .watches_speed = live % 3 == 2 || variant % 3 == 2,
                    .watches_change = live % 3 == 2 || variant % 3 == 1,
                    .record_slots = record_slots,
                    .seed = blocks * 1000 + live * 10 + variant,
                };
                compare(&s, kernel, scalar, kind);
            }
        }
    }
}

static void lattice_kernels(void **state) {
    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        for (int forced = 0; forced < 2; forced++) {
            const uint32_t parts = damped ? 3 : 2, record_slots = MSPRINGI_DIRECTIONS * W;
            compare_all(MSPRINGI_ROW_LATTICE, parts, record_slots, forced, kernels->lattice[damped][forced],
                        mspringi_kernels_scalar.lattice[damped][forced]);
            compare_all(MSPRINGI_ROW_LATTICE, parts, record_slots, forced, kernels->precise.lattice,
                        mspringi_kernels_scalar.precise.lattice);
            compare_all(MSPRINGI_ROW_LATTICE, parts, record_slots, forced, kernels->cells[damped][forced],
                        mspringi_kernels_scalar.cells[damped][forced]);
            compare_all(MSPRINGI_ROW_LATTICE, parts, record_slots, forced, kernels->precise.cells,
                        mspringi_kernels_scalar.precise.cells);
        }
    }
}

static void chain_kernels(void **state) {
    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        for (int forced = 0; forced < 2; forced++) {
            // Records of their own, and those of a lattice that has but one row.
            for (uint32_t record_slots = W; record_slots <= MSPRINGI_DIRECTIONS * W;
                 record_slots *= MSPRINGI_DIRECTIONS) {
                const uint32_t parts = damped ? 3 : 2;
                compare_all(MSPRINGI_ROW_CHAIN, parts, record_slots, forced, kernels->chain[damped][forced],
                            mspringi_kernels_scalar.chain[damped][forced]);
                compare_all(MSPRINGI_ROW_CHAIN, parts, record_slots, forced, kernels->precise.chain,
                            mspringi_kernels_scalar.precise.chain);
            }
        }
    }
}

// What three substeps do that leave nine tenths of a velocity.
static const mspringi_free_motion glide = {.keep = 0.729f,
                                           .loss = 0.271f,
                                           .gain = 2.439f,
                                           .reach = 0.02439f,
                                           .fall = 0.05049f,
                                           .drift = 0.03f,
                                           .gravity_x = 0.036f,
                                           .gravity_y = -0.24f,
                                           .gravity_way_x = 0.0007f,
                                           .gravity_way_y = -0.005f};
static int loose_forced;
static bool loose_is_precise;

static void run_loose(const mspringi_kernels *with, mspringi_sweep sweep, const mspringi_span *spans,
                      uint32_t count) {
    sweep.low_vx = loose_is_precise ? sweep.low_vx : NULL;
    sweep.low_vy = loose_is_precise ? sweep.low_vy : NULL;
    for (uint32_t i = 0; i < count; i++) {
        with->loose[loose_forced](&sweep, &spans[i], &glide);
    }
}

static void loose_of_level(const mspringi_sweep *sweep, const mspringi_span *spans, uint32_t count) {
    run_loose(kernels, *sweep, spans, count);
}

static void loose_scalar(const mspringi_sweep *sweep, const mspringi_span *spans, uint32_t count) {
    run_loose(&mspringi_kernels_scalar, *sweep, spans, count);
}

static void loose_kernels(void **state) {
    (void)state;
    for (int variant = 0; variant < 4; variant++) {
        loose_forced = variant % 2;
        loose_is_precise = variant / 2;
        compare_all(MSPRINGI_ROW_LOOSE, 2, W, loose_forced, loose_of_level, loose_scalar);
    }
}

static void check_largest(float found, float expected) {
    assert_true(isnan(expected) ? isnan(found) : found == expected);
}

static void largest_sees_every_lane(void **state) {
    (void)state;
    const float large[] = {NAN, INFINITY, -INFINITY, 1.5f, -1.5f}, small[] = {0, -0.0f, 1, -1, 1e-40f};
    const float changes[] = {NAN, INFINITY, INFINITY, 1.25f, 1.75f}; // from 0.25; of -1: 1.25
    _Alignas(64) float values[3 * W], before[3 * W];
    for (size_t place = 0; place < COUNT_OF(values); place++) {
        for (size_t i = 0; i < COUNT_OF(large); i++) {
            for (size_t j = 0; j < COUNT_OF(values); j++) {
                values[j] = small[j % COUNT_OF(small)];
                before[j] = 0.25f;
            }
            values[place] = large[i];
            for (size_t count = W; count <= COUNT_OF(values); count += W) {
                const mspringi_largest alone = kernels->largest(values, NULL, count);
                const mspringi_largest both = kernels->largest(values, before, count);
                check_largest(alone.value, place < count ? fabsf(large[i]) : 1);
                check_largest(both.value, place < count ? fabsf(large[i]) : 1);
                check_largest(both.change, place < count ? changes[i] : 1.25f);
                check_largest(alone.change, 0);
            }
        }
    }
    check_largest(kernels->largest(values, before, 0).value, 0);
}

/// Copying and summing up, or summing up alone, of anything anywhere: the sums are those of the scalar kernel.
static void checksums_are_alike(void **state) {
    (void)state;
    enum { UNIT = MSPRINGI_CHECKSUM_UNIT, UNITS = 5, ROOM = UNITS * UNIT + UNIT };
    uint8_t from[ROOM], to[ROOM + 1];
    uint64_t seed = 1;
    for (size_t i = 0; i < ROOM; i++) {
        from[i] = (uint8_t)support_random(&seed);
    }
    for (size_t units = 0; units <= UNITS; units++) {
        for (size_t offset = 0; offset < UNIT; offset += offset % 8 == 0 ? 1 : 7) {
            mspringi_checksum copied = {{1, 2}, {3}}, seen = copied, expected = copied;
            const size_t first = UNIT - 1 - offset, end = first + units * UNIT;
            memset(to, 0xc5, sizeof to);
            kernels->checksum(to + first, from + offset, units, &copied);
            kernels->checksum(NULL, from + offset, units, &seen);
            mspringi_kernels_scalar.checksum(NULL, from + offset, units, &expected);
            assert_memory_equal(&copied, &expected, sizeof expected);
            assert_memory_equal(&seen, &expected, sizeof expected);
            assert_memory_equal(to + first, from + offset, units * UNIT);
            for (size_t i = 0; i < sizeof to; i++) {
                assert_true((i >= first && i < end) || to[i] == 0xc5);
            }
        }
    }
}

int main(int argc, char **argv) {
    kernels = level_kernels(argc, argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lattice_kernels),     cmocka_unit_test(chain_kernels),
        cmocka_unit_test(loose_kernels),       cmocka_unit_test(largest_sees_every_lane),
        cmocka_unit_test(checksums_are_alike),
    };
    return cmocka_run_group_tests_name("kernels", tests, NULL, NULL);
}

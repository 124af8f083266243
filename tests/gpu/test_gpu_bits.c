/// @file test_gpu_bits.c
/// A batch on a device has the bits of the network that it was made of, in every step: random bodies, masses, pins,
/// dampers, relative springs, floors, actuators, dt and resets.
///
///     test_gpu_bits                   checks 32 batches
///     test_gpu_bits SEED [COUNT]      checks those of some seeds
///
/// SPDX-License-Identifier: MIT
#include <inttypes.h>
#include <stdlib.h>

#include "batches.h"

#define STEPS 30

static uint64_t first_seed = 1, seed_count;

// Signals of some actuators, alike on both sides.
static void send_signals(batch *b, mspring_gpu *gpu) {
    const uint32_t all = b->body_count * b->actuator_count, times = mspring_gpu_body_count(gpu) / b->body_count;
    const uint32_t first = (uint32_t)(support_random(&b->seed) % all);
    const uint32_t count = 1 + (uint32_t)(support_random(&b->seed) % (all - first));
    float *signals = malloc(count * sizeof *signals);
    assert_non_null(signals);
    for (uint32_t i = 0; i < count; i++)
        signals[i] = (float)support_random_between(&b->seed, 0.8, 1.2);
    check_ok(mspring_network_set(b->network, MSPRING_SIGNAL, NULL, first, count, signals, 1));
    for (uint32_t time = 0; time < times; time++)
        check_ok(mspring_gpu_set_signals(gpu, time * all + first, count, signals, 1));
    free(signals);
}

static void reset_some(batch *b, mspring_gpu *gpu) {
    const uint32_t all = mspring_gpu_body_count(gpu);
    uint8_t *mask = calloc(all, 1);
    uint32_t *groups = malloc(b->body_count * sizeof *groups), count = 0;
    assert_true(mask != NULL && groups != NULL);
    for (uint32_t g = 0; g < b->body_count; g++)
        if (support_random(&b->seed) % 3 == 0) {
            groups[count++] = g;
            for (uint32_t body = g; body < all; body += b->body_count)
                mask[body] = (uint8_t)(1 + g % 255);
        }
    check_ok(mspring_network_reset_groups(b->network, MSPRING_RESET_START, groups, 0, count));
    check_ok(mspring_gpu_reset(gpu, mask));
    free(mask);
    free(groups);
}

// All bodies that began alike are alike.
static void check_repeated(const batch *b, mspring_gpu *gpu) {
    const uint32_t n = b->body_count * b->particle_count, all = mspring_gpu_body_count(gpu) * b->particle_count;
    double *places = malloc(2 * (size_t)all * sizeof *places);
    assert_non_null(places);
    check_ok(mspring_gpu_get_positions(gpu, 0, all, places, places + 1, 2));
    for (size_t i = 0; i < 2 * (size_t)all; i++)
        assert_true(places[i] == places[i % (2 * (size_t)n)]);
    free(places);
}

// Return false if it is refused for its layout.
static bool check_seed(uint64_t seed) {
    const batch_shape shape = (batch_shape)(seed % BATCH_SHAPES);
    batch b = batch_draw(seed * 7919, shape, seed / BATCH_SHAPES % 2 == 0, seed % 3 == 0);
    mspring_gpu *gpu = batch_on_device(&b, seed % 5 == 0 ? 3 : 1);
    uint32_t held = 0;
    if (gpu == NULL) {
        print_message("seed %" PRIu64 ": refused for its layout\n", seed);
        batch_destroy(&b);
        return false;
    }
    batch_check_equal(&b, gpu);
    for (uint32_t step = 0; step < STEPS; step++) {
        const double dt = seed % 2 == 0 ? b.dt : b.dt * support_random_between(&b.seed, 0.5, 1);
        if (b.actuator_count > 0 && support_random(&b.seed) % 2 == 0)
            send_signals(&b, gpu);
        if (support_random(&b.seed) % 8 == 0)
            reset_some(&b, gpu);
        check_ok(mspring_network_step(b.network, dt));
        check_ok(mspring_gpu_step(gpu, dt));
        batch_check_equal(&b, gpu);
        uint32_t flags;
        check_ok(mspring_network_get_integers(b.network, MSPRING_GROUP_FLAGS, NULL, 0, 1, &flags, 1));
        held += flags;
    }
    check_repeated(&b, gpu);
    print_message("seed %" PRIu64 ": shape %d, %u bodies of %u particles, %u springs, %u actuators, held %u\n", seed,
                  (int)shape, (unsigned)b.body_count, (unsigned)b.particle_count, (unsigned)b.spring_count,
                  (unsigned)b.actuator_count, (unsigned)held);
    mspring_gpu_destroy(gpu);
    batch_destroy(&b);
    return true;
}

static void random_batches(void **state) {
    (void)state;
    uint64_t checked = 0;
    for (uint64_t seed = first_seed; seed < first_seed + seed_count; seed++)
        checked += check_seed(seed);
    assert_true(4 * checked >= 3 * seed_count || seed_count < 4);
}

// A batch of few bodies that are repeated has the hash of a network with as many.
static void repeated_bodies(void **state) {
    (void)state;
    const struct {
        batch_shape shape;
        uint32_t few, times;
    } cases[] = {{BATCH_LATTICE, 1, 500}, {BATCH_CHAIN, 4, 50}, {BATCH_WEB, 16, 20}, {BATCH_MIXED, 64, 4}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        batch few = batch_of_copies(i + 5, cases[i].shape, cases[i].few);
        batch all = batch_of_copies(i + 5, cases[i].shape, cases[i].few * cases[i].times);
        mspring_gpu *gpu = batch_on_device(&few, cases[i].times);
        assert_non_null(gpu);
        for (int step = 0; step < 40; step++) {
            check_ok(mspring_network_step(all.network, all.dt));
            check_ok(mspring_gpu_step(gpu, all.dt));
            batch_check_equal(&all, gpu);
        }
        mspring_gpu_destroy(gpu);
        batch_destroy(&few);
        batch_destroy(&all);
    }
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_batches), cmocka_unit_test(repeated_bodies)};
    first_seed = argc > 1 ? strtoull(argv[1], NULL, 10) : 1;
    seed_count = argc > 2 ? strtoull(argv[2], NULL, 10) : argc > 1 ? 1 : SAMPLE(32);
    batch_need_device();
    return cmocka_run_group_tests(tests, NULL, NULL);
}

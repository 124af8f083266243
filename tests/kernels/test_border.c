/// @file test_border.c
/// The guard's passes over all springs: at every level the bits of the scalar one, and what springs that are looked
/// at one by one in double precision add up to.
///
/// SPDX-License-Identifier: MIT
#include "stability/stability_limit.h"

#include <math.h>
#include <string.h>

#include "level.h"
#include "recipe.h"
#include "stability/pencil.h"
#include "support.h"

#define H 3e-3

/// Room of a look: what is read, and what is added up.
enum { IN = 0, OUT = 2, ARRAYS = 5 };

static mspring_simd level;

/// Lattices with holes, ropes and springs at random, stretched and pressed, one spring of no length, some broken.
static mspring_network *make(uint64_t seed, bool damped, mspring_simd at) {
    const recipe_stuff stuff = {
        .mass = {1, 30}, .stiffness = {100, 2000}, .damping = {0, damped ? 5 : 0}, .pinned = 0.05, .holes = 0.1};
    const uint32_t sizes[][2] = {{3, 2}, {16, 5}, {17, 9}, {40, 12}, {70, 3}};
    const uint32_t *size = sizes[seed % COUNT_OF(sizes)];
    recipe made = {0};
    recipe_lattice(&made, size[0], size[1], 0, 0, 1, &stuff, &seed);
    recipe_rope(&made, 0, made.particle_count - 1, 21, &stuff, &seed);
    recipe_random_springs(&made, 30, &stuff, &seed);
    recipe_disturb(&made, 0.3, 0, &seed);
    const mspring_spring_def *short_one = &made.springs[1];
    made.particles[short_one->b].x = made.particles[short_one->a].x;
    made.particles[short_one->b].y = made.particles[short_one->a].y;
    mspring_network_def def = support_def(0, 1);
    def.simd_level = at;
    mspring_network *network = recipe_network(&made, &def);
    for (mspring_id s = 0; s < made.spring_count; s += 7) {
        check_ok(mspring_network_break_springs(network, &s, 0, 1));
    }
    recipe_free(&made);
    return network;
}

static float *array_of(const mspring_network *network, size_t which) {
    return network->guard_scratch + which * mspringi_slot_count(network);
}

/// Numbers at random to be read, and 0 to add to.
static mspringi_stability_limit prepare(const mspring_network *network, bool is_image) {
    const size_t slots = mspringi_slot_count(network);
    mspringi_stability_limit border = mspringi_stability_limit_at(network, H);
    uint64_t seed = 9;
    for (size_t slot = 0; slot < slots; slot++) {
        for (size_t i = 0; i < 2; i++) {
            array_of(network, IN + i)[slot] = (float)support_random_between(&seed, is_image ? -1 : 0.1, 1);
        }
    }
    memset(array_of(network, OUT), 0, 3 * slots * sizeof(float));
    border.inverse_mass = network->inverse_mass;
    for (size_t i = 0; i < 2; i++) {
        border.in[i] = array_of(network, IN + i);
    }
    for (size_t i = 0; i < 3; i++) {
        border.out[i] = array_of(network, OUT + i);
    }
    return border;
}

static void pass(const mspring_network *network, bool is_image) {
    const mspringi_stability_limit border = prepare(network, is_image);
    if (is_image) {
        mspringi_stability_limit_image(network, &border);
    } else {
        mspringi_stability_limit_bound(network, &border);
    }
}

static void levels_are_alike(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 40; seed++) {
        mspring_network *network = make(seed / 4, seed % 2, level);
        mspring_network *scalar = make(seed / 4, seed % 2, MSPRING_SIMD_SCALAR);
        level_check(network, level);
        pass(network, seed / 2 % 2);
        pass(scalar, seed / 2 % 2);
        assert_memory_equal(network->guard_scratch, scalar->guard_scratch,
                            ARRAYS * mspringi_slot_count(network) * sizeof *network->guard_scratch);
        mspring_network_destroy(network);
        mspring_network_destroy(scalar);
    }
}

/// What a spring adds, by its formulas.
static void add_spring(const mspring_network *network, const mspringi_linear_spring *s, bool is_image,
                       double *sums) {
    const uint32_t a = s->a, b = s->b;
    const size_t count = mspringi_slot_count(network);
    const float *first = array_of(network, IN), *second = array_of(network, IN + 1);
    const double along = H * H * s->strength.stiffness + 2 * H * s->strength.damping;
    const double across = H * H * s->strength.stiffness * (is_image ? s->across : fmax(s->across, 0));
    double at_a[3] = {0}, at_b[3] = {0};
    if (!s->directed) {
        return;
    }
    if (is_image) {
        const double dx = (double)first[b] - (double)first[a], dy = (double)second[b] - (double)second[a];
        const double pull = along * (s->nx * dx + s->ny * dy), shear = across * (s->ny * dx - s->nx * dy);
        const double force[] = {pull * s->nx + shear * s->ny, pull * s->ny - shear * s->nx};
        for (int i = 0; i < 2; i++) {
            at_a[i] = -(double)network->inverse_mass[a] * force[i];
            at_b[i] = (double)network->inverse_mass[b] * force[i];
        }
    } else {
        const double both = (double)first[a] + (double)first[b];
        at_a[0] = at_b[0] = both * (along + across) / 2;
        at_a[1] = at_b[1] = both * (along - across) / 2 * (s->nx * s->nx - s->ny * s->ny);
        at_a[2] = at_b[2] = both * (along - across) * s->nx * s->ny;
    }
    for (size_t i = 0; i < 3; i++) {
        sums[i * count + a] += at_a[i];
        sums[i * count + b] += at_b[i];
    }
}

static void it_is_what_springs_add_up_to(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 20; seed++) {
        mspring_network *network = make(seed / 4, seed % 2, level);
        const bool is_image = seed / 2 % 2;
        const size_t slots = mspringi_slot_count(network);
        double *sums = test_calloc(3 * slots, sizeof *sums), largest = 0;
        pass(network, is_image);
        for (mspring_id s = 0; s < network->topology.spring_count; s++) {
            const mspringi_linear_spring seen =
                mspringi_linearise_spring(network, s, mspringi_slot_of_spring(&network->topology, s));
            add_spring(network, &seen, is_image, sums);
        }
        for (size_t i = 0; i < 3 * slots; i++) {
            largest = fmax(largest, fabs(sums[i]));
        }
        // Ten springs at a particle, some ten operations each, that are off by 6e-8.
        for (size_t i = 0; i < 3 * slots; i++) {
            check_near((double)array_of(network, OUT)[i], sums[i], 1e-5 * largest);
        }
        assert_true(largest > 1e-3);
        test_free(sums);
        mspring_network_destroy(network);
    }
}

int main(int argc, char **argv) {
    level = level_from_arguments(argc, argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_are_alike),
        cmocka_unit_test(it_is_what_springs_add_up_to),
    };
    return cmocka_run_group_tests_name("border", tests, NULL, NULL);
}

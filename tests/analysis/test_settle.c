/// @file test_settle.c
/// Static equilibrium: against closed forms, against bars that another program settled, and against the forces that
/// are left, summed up here; from bad starts, without equilibrium, without memory.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"

static const double gravity = 9.8;

static mspring_settle_result settled(mspring_network *network) {
    mspring_settle_result result = {.struct_size = sizeof result};
    check_ok(mspring_network_settle(network, NULL, &result));
    return result;
}

static mspring_network *network_of(const recipe *made, double gravity_y) {
    const mspring_network_def def = support_def((float)gravity_y, 1);
    return recipe_network(made, &def);
}

/// The largest force that springs and weight leave on a particle that is not pinned, N: from what the network
/// tells.
static double force_left(const mspring_network *network, const recipe *made, double gravity_y) {
    double *force = calloc(2 * (size_t)made->particle_count, sizeof *force), largest = 0;
    assert_non_null(force);
    for (mspring_id s = 0; s < made->spring_count; s++) {
        support_spring_info info;
        check_ok(support_get_spring(network, s, &info));
        const support_point a = support_position(network, info.a), b = support_position(network, info.b);
        const double length = hypot(b.x - a.x, b.y - a.y);
        if (length == 0) {
            continue;
        }
        const double each = (double)info.stiffness * (length - (double)info.rest_length) / length;
        const mspring_id ends[] = {info.a, info.b};
        for (int end = 0; end < 2; end++) {
            const double sign = end == 0 ? 1 : -1;
            force[2 * ends[end]] += sign * each * (b.x - a.x);
            force[2 * ends[end] + 1] += sign * each * (b.y - a.y);
        }
    }
    for (uint32_t p = 0; p < made->particle_count; p++) {
        if (!(made->particles[p].flags & MSPRING_PARTICLE_PINNED)) {
            const double y = force[2 * p + 1] + (double)made->particles[p].mass * gravity_y;
            largest = fmax(largest, fmax(fabs(force[2 * p]), fabs(y)));
        }
    }
    free(force);
    return largest;
}

/* ------------------------------------------------------------------------------------------------ closed forms */

static void weight_on_a_spring(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id top = support_pinned(builder, 3, 10, 1), weight = support_particle(builder, 3, 8, 5);
    support_spring(builder, top, weight, 1000, 0);
    const mspring_network_def def = support_def((float)-gravity, 4);
    mspring_network *network = support_network(builder, &def);
    const float sideways = 1;
    check_ok(mspring_network_set_velocities(network, NULL, weight, 1, &sideways, &sideways, 1));
    const mspring_settle_result result = settled(network);
    // Length 2 + m g / k, down to the float's last place.
    check_near(support_position(network, weight).y, 10 - (2 + 5 * gravity / 1000), 1e-6);
    check_near(support_position(network, weight).x, 3, 1e-6);
    check_near(result.displacement, 5 * gravity / 1000, 1e-6);
    check_near(result.largest_force, 5 * gravity, 1e-5);
    assert_true(result.residual <= 1e-9 * result.largest_force);
    assert_int_equal(result.is_stable, 1);
    assert_int_equal(result.left_alone, 0);
    check_near(support_velocity(network, weight).x, 0, 0);
    check_near(support_velocity(network, weight).y, 0, 0);
    mspring_network_destroy(network);
}

// The force of the host acts, and is still there for the step that follows: that one leaves the weight at rest.
static void force_given_for_the_next_step(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id pin = support_pinned(builder, 0, 0, 1), end = support_particle(builder, 1, 0, 2);
    support_spring(builder, pin, end, 500, 0);
    const mspring_network_def def = support_def(0, 8);
    mspring_network *network = support_network(builder, &def);
    check_ok(mspring_network_apply_force(network, end, 30, 40));
    settled(network);
    // 50 N along (3, 4) / 5 lengthen it by 0.1 m.
    check_near(support_position(network, end).x, 1.1 * 0.6, 1e-6);
    check_near(support_position(network, end).y, 1.1 * 0.8, 1e-6);
    support_steps(network, 1, 0.01);
    // k times half a last place, 500 * 6e-8 N, on 2 kg for 0.01 s.
    check_near(support_velocity(network, end).x, 0, 1e-6);
    check_near(support_velocity(network, end).y, 0, 1e-6);
    support_steps(network, 1, 0.01);
    assert_true(fabs(support_velocity(network, end).x) > 0.1); // the force is gone
    mspring_network_destroy(network);
}

// A taut rope's sag: n equal weights on springs, each spring along the force that it carries.
static void rope_between_two_pins(void **state) {
    (void)state;
    enum { SEGMENTS = 40 };
    uint64_t seed = 1;
    const recipe_stuff stuff = {.mass = {2, 2}, .stiffness = {1e5, 1e5}};
    recipe made = {0};
    const mspring_id left = recipe_particle(&made, 0, 0, 1, MSPRING_PARTICLE_PINNED);
    const mspring_id right = recipe_particle(&made, 20, 3, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, left, right, SEGMENTS, &stuff, &seed);
    mspring_network *network = network_of(&made, -gravity);
    const mspring_settle_result result = settled(network);
    assert_int_equal(result.is_stable, 1);
    // Horizontal pull H is the same in all springs; the vertical one grows by m g from one to the next.
    double pull = 0;
    for (mspring_id s = 0; s < SEGMENTS; s++) {
        support_spring_info info;
        check_ok(support_get_spring(network, s, &info));
        const support_point a = support_position(network, info.a), b = support_position(network, info.b);
        const double horizontal = (double)info.force * fabs(b.x - a.x) / hypot(b.x - a.x, b.y - a.y);
        pull = s == 0 ? horizontal : pull;
        check_near(horizontal, pull, 0.3); // k times a last place of 10 m, 1e5 * 1e-6 N, at both ends
    }
    assert_true(pull > 1000);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void pendulum_upside_down_falls(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id pin = support_pinned(builder, 0, 0, 1), weight = support_particle(builder, 0, 1, 3);
    support_spring(builder, pin, weight, 1e4, 0);
    const mspring_network_def def = support_def((float)-gravity, 1);
    mspring_network *network = support_network(builder, &def);
    const mspring_settle_result result = settled(network);
    check_near(support_position(network, weight).x, 0, 1e-6);
    check_near(support_position(network, weight).y, -(1 + 3 * gravity / 1e4), 1e-6);
    assert_int_equal(result.is_stable, 1);
    mspring_network_destroy(network);
}

/* -------------------------------------------------------------------------------------------------------- bars */

// Bending of bars as found by another implementation of Newton's method; 4 * 6.7643e7 is what "2.706e8" is there.
static void check_bending(uint32_t columns, uint32_t rows, double stiffness, double bending) {
    recipe made = recipe_bar(columns, rows, stiffness);
    mspring_network *network = network_of(&made, -gravity);
    const mspring_id probe = columns * rows - 1;
    const mspring_settle_result result = settled(network);
    // 0.01 %: the reference has five or six digits, and a float's last place at 900 m is 6e-5 m.
    check_near(made.particles[probe].y - support_position(network, probe).y, bending, 1e-4 * bending);
    assert_int_equal(result.is_stable, 1);
    // The first column is where it was.
    check_near(support_position(network, 0).x, made.particles[0].x, 0);
    check_near(support_position(network, 0).y, made.particles[0].y, 0);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void bars_80x5(void **state) {
    (void)state;
    check_bending(80, 5, 6.7643e7, 20.0586);
    check_bending(80, 5, 4 * 6.7643e7, 5.2448);
    check_bending(80, 5, 1e9, 1.42216);
    check_bending(80, 5, 1e10, 0.142200);
    check_bending(80, 5, 1e12, 0.00142195);
}

static void bars_544x68(void **state) {
    (void)state;
    check_bending(544, 68, 6.7643e7, 188.464);
    if (ROUNDS_ARE_FEW)
        return;
    check_bending(544, 68, 4 * 6.7643e7, 50.798);
    check_bending(544, 68, 1e9, 13.779);
    check_bending(544, 68, 1e10, 1.3769);
}

static void bars_1800x5(void **state) {
    (void)state;
    check_bending(1800, 5, 6.7643e7, 1806.7);
    if (ROUNDS_ARE_FEW)
        return;
    check_bending(1800, 5, 1e9, 1775.7);
    check_bending(1800, 5, 1e10, 1715.7);
    check_bending(1800, 5, 1e12, 364.5);
    check_bending(1800, 5, 1e13, 37.680);
    check_bending(1800, 5, 1e14, 3.769);
}

/* ------------------------------------------------------------------------------------------------- any network */

static void settles_and_rests(const recipe *made) {
    mspring_network *network = network_of(made, -gravity);
    const mspring_settle_result result = settled(network);
    assert_int_equal(result.is_stable, 1);
    double stiffest = 0, farthest = 0;
    for (uint32_t s = 0; s < made->spring_count; s++) {
        stiffest = fmax(stiffest, (double)made->springs[s].stiffness);
    }
    for (uint32_t p = 0; p < made->particle_count; p++) {
        const support_point at = support_position(network, p);
        farthest = fmax(farthest, fmax(fabs(at.x), fabs(at.y)));
    }
    // Rounding a position to float moves it by 6e-8 of itself; some springs meet at a particle.
    check_near(force_left(network, made, -gravity), 0, 20 * stiffest * 6e-8 * farthest + 1e-9);
    mspring_network_destroy(network);
}

static void random_graphs_rest(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        uint64_t random = seed;
        const recipe_stuff stuff = {.mass = {1, 100}, .stiffness = {1e3, 1e5}};
        recipe made = {0};
        for (uint32_t i = 0; i < 200; i++) {
            recipe_particle(&made, support_random_between(&random, 0, 10), support_random_between(&random, 0, 10),
                            1 + i % 5, i % 20 == 0 ? MSPRING_PARTICLE_PINNED : 0);
        }
        for (uint32_t i = 1; i < 200; i++) {
            recipe_spring(&made, i - 1, i, 1e4, 0, 0); // so that all hangs together
        }
        recipe_random_springs(&made, (uint32_t)(80 * seed), &stuff, &random);
        settles_and_rests(&made);
        recipe_free(&made);
    }
}

static void truss_and_ropes_rest(void **state) {
    (void)state;
    uint64_t seed = 3;
    const recipe_stuff beam = {.mass = {10, 20}, .stiffness = {1e6, 2e6}};
    const recipe_stuff rope = {.mass = {0.1, 0.2}, .stiffness = {1e3, 1e4}};
    recipe made = {0};
    for (uint32_t i = 0; i < 20; i++) {
        recipe_particle(&made, i, 0, 10, i == 0 ? MSPRING_PARTICLE_PINNED : 0);
        recipe_particle(&made, i + 0.5, 1, 10, i == 0 ? MSPRING_PARTICLE_PINNED : 0);
    }
    for (uint32_t i = 0; i + 2 < 40; i++) {
        recipe_spring(&made, i, i + 1, 1e6, 0, 0);
        recipe_spring(&made, i, i + 2, 1e6, 0, 0);
    }
    const mspring_id lattice = recipe_lattice(&made, 9, 7, 30, 5, 0.5, &beam, &seed);
    recipe_rope(&made, 20, lattice, 30, &rope, &seed);
    recipe_rope(&made, 37, lattice + 8, 20, &rope, &seed);
    settles_and_rests(&made);
    recipe_free(&made);
}

// Masses and stiffnesses over six orders of magnitude: some hang a million times as deep as their springs are long.
static void springs_and_weights_of_all_sizes(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= 100; seed++) {
        uint64_t random = seed;
        recipe made = {0};
        const uint32_t count = 2 + (uint32_t)(support_random(&random) % 80);
        for (uint32_t i = 0; i < count; i++) {
            const double mass = pow(10, support_random_between(&random, -3, 3));
            recipe_particle(&made, support_random_between(&random, 0, 1), support_random_between(&random, 0, 1),
                            mass, i == 0 || support_random(&random) % 20 == 0 ? MSPRING_PARTICLE_PINNED : 0);
            if (i > 0) {
                const double stiffness = pow(10, support_random_between(&random, -3, 3));
                recipe_spring(&made, i, (mspring_id)(support_random(&random) % i), stiffness, 0, 0);
            }
        }
        mspring_network *network = network_of(&made, -gravity);
        const mspring_settle_result result = settled(network);
        assert_int_equal(result.is_stable, 1);
        // 1e-9, or what rounding leaves of it: positions of up to 1e8 m have a last place of 1.5e-8 m.
        assert_true(result.residual <= 1e-9 * result.largest_force + 1e3 * 1.5e-8);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

static void hangs_the_same_far_from_the_origin(void **state) {
    (void)state;
    recipe here = recipe_bar(30, 4, 1e8), there = recipe_bar(30, 4, 1e8);
    for (uint32_t p = 0; p < there.particle_count; p++) {
        there.particles[p].x += 1e7;
        there.particles[p].y -= 3e6;
    }
    mspring_network *a = network_of(&here, -gravity), *b = network_of(&there, -gravity);
    settled(a);
    settled(b);
    for (uint32_t p = 0; p < here.particle_count; p++) {
        check_near(support_position(b, p).x - 1e7, support_position(a, p).x, 1e-8); // last place of a double there
        check_near(support_position(b, p).y + 3e6, support_position(a, p).y, 1e-8);
    }
    mspring_network_destroy(a);
    mspring_network_destroy(b);
    recipe_free(&here);
    recipe_free(&there);
}

static void broken_springs_bear_nothing(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id top = support_pinned(builder, 0, 0, 1), weight = support_particle(builder, 0, -1, 2);
    support_spring(builder, top, weight, 1000, 0);
    const mspring_id side = support_pinned(builder, 1, -1, 1);
    const mspring_id broken = support_spring(builder, side, weight, 1e6, 0);
    const mspring_network_def def = support_def((float)-gravity, 1);
    mspring_network *network = support_network(builder, &def);
    check_ok(mspring_network_break_springs(network, &broken, 0, 1));
    settled(network);
    check_near(support_position(network, weight).x, 0, 1e-6);
    check_near(support_position(network, weight).y, -(1 + 2 * gravity / 1000), 1e-6);
    mspring_network_destroy(network);
}

/// A bar so soft that it hangs down from its clamp, springs three times as long: 102 iterations, 185 as long as no
/// step went on where the energy fell further. Rounding may cost or spare a few.
static void a_soft_bar_takes_few_iterations(void **state) {
    (void)state;
    recipe made = recipe_bar(68, 9, 8678);
    mspring_network *network = network_of(&made, -gravity);
    const mspring_settle_result result = settled(network);
    print_message("%u iterations\n", (unsigned)result.iterations);
    assert_true(result.is_stable);
    assert_true(result.iterations < 140);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void relative_springs_follow_a_substep(void **state) {
    (void)state;
    recipe made = recipe_bar(12, 3, 0.3);
    for (uint32_t s = 0; s < made.spring_count; s++) {
        made.springs[s].flags = MSPRING_SPRING_RELATIVE;
    }
    mspring_network *network = network_of(&made, -gravity);
    const uint64_t before = support_hash(network);
    // Before the first step they have no stiffness.
    check_error(mspring_network_settle(network, NULL, NULL), MSPRING_ERROR_EQUILIBRIUM);
    mspring_settle_def def;
    check_ok(mspring_init(MSPRING_STRUCT_SETTLE_DEF, &def, sizeof def));
    def.relative_substep = 1.0 / 640;
    def.max_iterations = 1;
    def.tolerance = 1e-15;
    check_error(mspring_network_settle(network, &def, NULL), MSPRING_ERROR_EQUILIBRIUM);
    support_spring_info info;
    check_ok(support_get_spring(network, 0, &info));
    check_near(info.stiffness, 0, 0); // as before
    assert_true(support_hash(network) == before);
    def.max_iterations = 100;
    def.tolerance = 1e-9;
    check_ok(mspring_network_settle(network, &def, NULL));
    check_ok(support_get_spring(network, 0, &info));
    const double stiffness = 0.3 * 73.3975 / 2 * 640 * 640; // f mu / h^2
    check_near(info.stiffness, stiffness, 1e-6 * stiffness);
    check_near(force_left(network, &made, -gravity), 0, 20 * stiffness * 6e-8 * 12);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/* -------------------------------------------------------------------------------------------------- bad starts */

typedef enum start { CRUSHED, SCATTERED, FLATTENED, ONE_POINT, FOLDED, WAVED, STARTS } start;

static void move_to_start(mspring_network *network, const recipe *made, start kind, double width, uint64_t *seed) {
    for (uint32_t p = 0; p < made->particle_count; p++) {
        double x = made->particles[p].x, y = made->particles[p].y;
        if (made->particles[p].flags & MSPRING_PARTICLE_PINNED) {
            continue;
        }
        switch (kind) {
        case CRUSHED:
            x = x / 2 + support_random_between(seed, 0, 4);
            y = y / 2 + support_random_between(seed, 0, 1);
            break;
        case SCATTERED:
            x = support_random_between(seed, 0, 1);
            y = support_random_between(seed, 0, 1);
            break;
        case FLATTENED:
            y = 0;
            break;
        case ONE_POINT:
            x = y = 0;
            break;
        case FOLDED:
            x = x > width / 2 ? width - x : x;
            break;
        case WAVED:
            y -= 12 * sin(x * 19 / width);
            break;
        default:
            fail();
        }
        check_ok(mspring_network_set_positions(network, NULL, p, 1, &x, &y, 1));
    }
}

static void bad_starts(void **state) {
    (void)state;
    const double stiffness[] = {1e6, 6.7643e7, 1e10};
    uint64_t seed = 5;
    for (size_t k = 0; k < COUNT_OF(stiffness); k++) {
        for (start kind = 0; kind < STARTS; kind++) {
            recipe made = recipe_bar(50, 5, stiffness[k]);
            mspring_network *network = network_of(&made, -gravity);
            double elastic, potential, elastic_after, potential_after;
            move_to_start(network, &made, kind, 50, &seed);
            check_ok(support_get_energy(network, NULL, &elastic, &potential));
            const mspring_settle_result result = settled(network);
            check_ok(support_get_energy(network, NULL, &elastic_after, &potential_after));
            // Downhill, to a minimum: perhaps a tangled one.
            assert_true(elastic_after + potential_after < elastic + potential);
            assert_int_equal(result.is_stable, 1);
            assert_true(result.residual <= 1e-9 * result.largest_force);
            check_near(force_left(network, &made, -gravity), 0, 20 * stiffness[k] * 6e-8 * 64);
            mspring_network_destroy(network);
            recipe_free(&made);
        }
    }
}

/* ------------------------------------------------------------------------------------------- no equilibrium */

static void floating_parts(void **state) {
    (void)state;
    uint64_t seed = 1;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1e4, 1e4}};
    recipe made = recipe_bar(10, 3, 1e6);
    const mspring_id loose = recipe_lattice(&made, 4, 4, 0, 20, 1, &stuff, &seed);
    recipe_disturb(&made, 0.1, 1, &seed);
    mspring_network *network = network_of(&made, -gravity);
    const uint64_t before = support_hash(network);
    char name[32];
    snprintf(name, sizeof name, "particle %u", (unsigned)loose);
    check_error(mspring_network_settle(network, NULL, NULL), MSPRING_ERROR_EQUILIBRIUM);
    check_contains(mspring_network_error(network), name);
    assert_true(support_hash(network) == before);

    mspring_settle_def def;
    mspring_settle_result result = {.struct_size = sizeof result};
    check_ok(mspring_init(MSPRING_STRUCT_SETTLE_DEF, &def, sizeof def));
    def.flags = MSPRING_SETTLE_LEAVE_FLOATING;
    const support_point place = support_position(network, loose), speed = support_velocity(network, loose);
    check_ok(mspring_network_settle(network, &def, &result));
    assert_int_equal(result.left_alone, 16);
    check_near(support_position(network, loose).x, place.x, 0);
    check_near(support_position(network, loose).y, place.y, 0);
    check_near(support_velocity(network, loose).x, speed.x, 0);
    check_near(support_velocity(network, 15).x, 0, 0);

    // Without gravity it takes its own shape, where it is.
    check_ok(support_set_gravity(network, 0, 0));
    check_ok(mspring_network_settle(network, NULL, &result));
    assert_int_equal(result.left_alone, 0);
    check_near(force_left(network, &made, 0), 0, 20 * 1e6 * 6e-8 * 20);
    check_near(support_position(network, loose).x, place.x, 0.3);
    check_near(support_position(network, loose).y, place.y, 0.3);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void nothing_to_settle(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id a = support_pinned(builder, 0, 0, 1), b = support_pinned(builder, 2, 0, 1);
    support_spring(builder, a, b, 1000, 0);
    mspring_network *pinned = support_network(builder, NULL);
    const uint64_t before = support_hash(pinned);
    const mspring_settle_result result = settled(pinned);
    assert_int_equal(result.iterations, 0);
    assert_int_equal(result.is_stable, 1);
    assert_true(support_hash(pinned) == before);
    mspring_network_destroy(pinned);

    builder = support_builder();
    support_particle(builder, 0, 0, 1);
    const mspring_network_def def = support_def(0, 1);
    mspring_network *weightless = support_network(builder, &def);
    settled(weightless);
    check_ok(mspring_network_apply_force(weightless, 0, 1, 0));
    check_error(mspring_network_settle(weightless, NULL, NULL), MSPRING_ERROR_EQUILIBRIUM);
    mspring_network_destroy(weightless);
}

static void out_of_bounds(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id top = support_pinned(builder, 0, 0, 1), weight = support_particle(builder, 0, -1, 1e30f);
    support_spring(builder, top, weight, 1e-30f, 0);
    const mspring_network_def def = support_def((float)-gravity, 1);
    mspring_network *network = support_network(builder, &def);
    const uint64_t before = support_hash(network);
    check_error(mspring_network_settle(network, NULL, NULL), MSPRING_ERROR_EQUILIBRIUM);
    assert_true(support_hash(network) == before);
    mspring_network_destroy(network);
}

static void too_few_iterations(void **state) {
    (void)state;
    recipe made = recipe_bar(80, 5, 6.7643e7);
    mspring_network *network = network_of(&made, -gravity);
    const uint64_t before = support_hash(network);
    mspring_settle_result result = {.struct_size = sizeof result, .iterations = 77};
    mspring_settle_def def;
    check_ok(mspring_init(MSPRING_STRUCT_SETTLE_DEF, &def, sizeof def));
    def.max_iterations = 2;
    check_error(mspring_network_settle(network, &def, &result), MSPRING_ERROR_EQUILIBRIUM);
    check_contains(mspring_network_error(network), "2 iterations");
    assert_true(support_hash(network) == before);
    assert_int_equal(result.iterations, 77);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------------------- bad input, memory */

static void settle_in_a_hook(const mspring_hook_args *args, void *user) {
    (void)args;
    check_error(mspring_network_settle(user, NULL, NULL), MSPRING_ERROR_BUSY);
}

static void bad_input(void **state) {
    (void)state;
    recipe made = recipe_bar(6, 3, 1e6);
    mspring_network *network = network_of(&made, -gravity);
    mspring_settle_def good, def;
    check_error(mspring_init(MSPRING_STRUCT_SETTLE_DEF, NULL, sizeof good), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_init(MSPRING_STRUCT_SETTLE_DEF, &good, sizeof good - 1), MSPRING_ERROR_STRUCT);
    check_ok(mspring_init(MSPRING_STRUCT_SETTLE_DEF, &good, sizeof good));
    check_error(mspring_network_settle(NULL, &good, NULL), MSPRING_ERROR_ARGUMENT);
    def = good;
    def.struct_size = 4;
    check_error(mspring_network_settle(network, &def, NULL), MSPRING_ERROR_STRUCT);
    def = good;
    def.flags = 2;
    check_error(mspring_network_settle(network, &def, NULL), MSPRING_ERROR_ARGUMENT);
    def = good;
    def.max_iterations = 0;
    check_error(mspring_network_settle(network, &def, NULL), MSPRING_ERROR_ARGUMENT);
    const double bad[] = {0, -1, NAN, INFINITY, 1.1};
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        def = good;
        def.tolerance = bad[i];
        check_error(mspring_network_settle(network, &def, NULL), MSPRING_ERROR_ARGUMENT);
    }
    const double bad_substeps[] = {-1, NAN, INFINITY, 1e-60, 1e60};
    for (size_t i = 0; i < COUNT_OF(bad_substeps); i++) {
        def = good;
        def.relative_substep = bad_substeps[i];
        check_error(mspring_network_settle(network, &def, NULL), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "relative_substep");
    }
    mspring_settle_result result = {.struct_size = 3};
    check_error(mspring_network_settle(network, &good, &result), MSPRING_ERROR_STRUCT);
    mspring_hook_def hook;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &hook, sizeof hook));
    hook.fn = settle_in_a_hook;
    hook.user = network;
    check_ok(mspring_network_add_hook(network, &hook, NULL));
    support_steps(network, 1, 0.001);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void same_bits_at_every_level(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    uint64_t expected = 0, seed = 6;
    recipe made = recipe_bar(60, 9, 1e8);
    recipe_random_springs(&made, 40, &(recipe_stuff){.stiffness = {1e3, 1e7}}, &seed);
    for (uint32_t i = 0; i < count; i++) {
        mspring_network_def def = support_def((float)-gravity, 1);
        def.simd_level = levels[i];
        mspring_network *network = recipe_network(&made, &def);
        settled(network);
        if (i == 0) {
            expected = support_hash(network);
        }
        assert_true(support_hash(network) == expected);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

static void every_allocation_may_fail(void **state) {
    (void)state;
    recipe made = recipe_bar(12, 4, 1e7);
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    mspring_network_def def = support_def((float)-gravity, 1);
    def.allocator = &allocator;
    mspring_network *network = recipe_network(&made, &def);
    const uint64_t before = support_hash(network);
    const size_t memory = support_memory_used(network);
    uint32_t failures = 0;
    for (mspring_result result = MSPRING_ERROR_MEMORY; result != MSPRING_OK; failures++) {
        watched.fail_at = watched.calls + 1 + failures;
        result = mspring_network_settle(network, NULL, NULL);
        assert_int_equal(support_memory_used(network), memory);
        if (result != MSPRING_OK) {
            check_error(result, MSPRING_ERROR_MEMORY);
            check_contains(mspring_network_error(network), "memory");
            assert_true(support_hash(network) == before);
        }
    }
    assert_true(failures > 30);
    watched.fail_at = 0;
    mspring_network_destroy(network);
    check_watched_clean(&watched);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weight_on_a_spring),
        cmocka_unit_test(force_given_for_the_next_step),
        cmocka_unit_test(rope_between_two_pins),
        cmocka_unit_test(pendulum_upside_down_falls),
        cmocka_unit_test(bars_80x5),
        cmocka_unit_test(bars_544x68),
        cmocka_unit_test(bars_1800x5),
        cmocka_unit_test(random_graphs_rest),
        cmocka_unit_test(truss_and_ropes_rest),
        cmocka_unit_test(springs_and_weights_of_all_sizes),
        cmocka_unit_test(hangs_the_same_far_from_the_origin),
        cmocka_unit_test(broken_springs_bear_nothing),
        cmocka_unit_test(a_soft_bar_takes_few_iterations),
        cmocka_unit_test(relative_springs_follow_a_substep),
        cmocka_unit_test(bad_starts),
        cmocka_unit_test(floating_parts),
        cmocka_unit_test(nothing_to_settle),
        cmocka_unit_test(out_of_bounds),
        cmocka_unit_test(too_few_iterations),
        cmocka_unit_test(bad_input),
        cmocka_unit_test(same_bits_at_every_level),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("settle", tests, NULL, NULL);
}

/// @file test_certificate.c
/// The bound of the stability border that spares the guard its iteration: never above the border, and near it where
/// games are.
///
/// SPDX-License-Identifier: MIT
#include "stability/stability_limit.h"
#include "store/network.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "recipe.h"
#include "support.h"

/// What mspring_network_get_stable_dt() may be below the border itself: its residuals (see lanczos.c and LIMIT_TOLERANCE
/// there).
#define SHARPNESS 3e-3

/// Whether the bound says that substeps of h are stable in the network's shape.
static bool is_below(mspring_network *network, double h) {
    return mspringi_stability_limit_is_below(network, h, 4.0);
}

/// The longest substep that the bound allows, as a part of the border.
static double reach(mspring_network *network) {
    double border, low = 0.0, high = 2.0;
    check_ok(mspring_network_get_stable_dt(network, &border, NULL));
    for (int i = 0; i < 20; i++) {
        const double middle = 0.5 * (low + high);
        if (is_below(network, middle * border)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

static void it_is_never_above_the_border(void **state) {
    (void)state;
    const recipe_stuff stuffs[] = {
        {.mass = {1, 1}, .stiffness = {100, 100}},
        {.mass = {1, 50}, .stiffness = {10, 2000}, .damping = {0, 5}, .pinned = 0.1},
        {.mass = {0.01, 100}, .stiffness = {1, 1000}, .damping = {0, 1}, .holes = 0.3},
    };
    double worst = 1.0;
    for (uint64_t seed = 1; seed <= 60; seed++) {
        uint64_t random = seed;
        const recipe_stuff *stuff = &stuffs[seed % COUNT_OF(stuffs)];
        recipe made = {0};
        recipe_lattice(&made, 3 + (uint32_t)(seed % 17), 2 + (uint32_t)(seed % 11), 0, 0, 1, stuff, &random);
        recipe_rope(&made, 0, made.particle_count - 1, 10, stuff, &random);
        if (seed % 4 == 0) {
            recipe_random_springs(&made, 20, stuff, &random);
        }
        // At rest, crumpled, and stretched so far that springs are stiff across their direction, too.
        recipe_disturb(&made, seed % 5 == 0 ? 0.0 : seed % 5 == 1 ? 3.0 : 0.3, 0, &random);
        mspring_network *network = recipe_network(&made, NULL);
        const double part = reach(network);
        assert_true(part <= 1.0 + SHARPNESS);
        assert_true(part >= 0.3); // else it is good for nothing
        worst = fmin(worst, part);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
    print_message("down to %.2f of the border\n", worst);
}

static void it_is_near_for_lattices(void **state) {
    (void)state;
    const recipe_stuff alike = {.mass = {1, 1}, .stiffness = {100, 100}, .damping = {0.5, 0.5}};
    const recipe_stuff unlike = {.mass = {1, 1.3}, .stiffness = {100, 130}, .damping = {0.5, 0.6}, .holes = 0.05};
    uint64_t seed = 3;
    for (int i = 0; i < 2; i++) {
        recipe made = {0};
        recipe_lattice(&made, 60, 40, 0, 0, 1, i == 0 ? &alike : &unlike, &seed);
        mspring_network *network = recipe_network(&made, NULL);
        const double part = reach(network);
        print_message("%.3f of the border\n", part);
        assert_true(part >= (i == 0 ? 0.99 : 0.9));
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/// Nor with areas and angles, of corners close to each other and far apart.
static void elements_are_counted(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= 40; seed++) {
        uint64_t random = seed;
        const double spacing = pow(10, support_random_between(&random, -1, 1.5));
        const recipe_stuff stuff = {.mass = {1, 3}, .stiffness = {1, 3}};
        recipe made = {0};
        recipe_lattice(&made, 4, 2 + (uint32_t)(seed % 3), 0, 0, spacing, &stuff, &random);
        recipe_disturb(&made, 0.1 * spacing, 0, &random);
        mspring_network *network = recipe_network(&made, NULL);
        mspring_area_def area;
        mspring_angle_def angle;
        check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area));
        check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &angle, sizeof angle));
        area.stiffness = 300;
        angle.stiffness = 300;
        if (seed % 3 < 2)
            check_ok(mspring_network_add_cell_areas(network, &area, NULL, NULL));
        if (seed % 3 > 0)
            check_ok(mspring_network_add_angles(network, &angle, (const mspring_id[]){0, 1, 2, 4, 5, 1}, 2, 3, NULL));
        const double part = reach(network);
        assert_true(part <= 1.0 + SHARPNESS);
        assert_true(part >= 0.3);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/// Nor where pressure alone is stiff: of an area of n corners its tangent has at most the eigenvalue sin(2 pi k / n) p.
static void pressure_is_counted(void **state) {
    (void)state;
    for (uint32_t n = 3; n <= 9; n++) {
        const double mass = 2, pressure = 50;
        double eigenvalue = 0;
        mspring_id corners[9];
        mspring_builder *builder = support_builder();
        for (uint32_t k = 0; k < n; k++) {
            const double angle = 6.283185307179586 * k / n;
            eigenvalue = fmax(eigenvalue, sin(angle));
            corners[k] = support_particle(builder, 3 * cos(angle), 3 * sin(angle), (float)mass);
        }
        mspring_network *network = support_network(builder, NULL);
        mspring_area_def area;
        check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area));
        area.pressure = (float)pressure;
        check_ok(mspring_network_add_area(network, &area, corners, n, NULL));
        const double border = 2 / sqrt(eigenvalue * pressure / mass);
        assert_false(is_below(network, 1.01 * border));
        assert_true(is_below(network, 0.5 * border));
        mspring_network_destroy(network);
    }
}

/// Nor for ropes over several blocks, with dampers or without, that are stiff in one place.
static void ropes_are_counted_wherever_they_are_stiff(void **state) {
    (void)state;
    for (uint32_t stiff = 0; stiff < 60; stiff += 4) {
        uint64_t seed = stiff;
        const double damping = stiff % 8 == 0 ? 2 : 0;
        const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {10, 10}, .damping = {damping, damping}};
        recipe made = {0};
        const mspring_id from = recipe_particle(&made, 0, 0, 1, 0);
        recipe_rope(&made, from, recipe_particle(&made, 60, 0, 1, 0), 60, &stuff, &seed);
        made.springs[stiff].stiffness = 1000;
        mspring_network *network = recipe_network(&made, NULL);
        const double part = reach(network);
        assert_true(part <= 1.0 + SHARPNESS);
        assert_true(part >= 0.3);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/// Numbers that overflow say nothing, rather than that all is well.
static void it_does_not_vouch_for_overflows(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id a = support_particle(builder, 0, 0, 1e-30f), b = support_particle(builder, 1, 0, 1e-30f);
    support_spring(builder, a, b, 1e30f, 0);
    mspring_network *network = support_network(builder, NULL);
    assert_false(is_below(network, 1.0));
    mspring_network_destroy(network);
}

/// The longest substep that is stable in any shape bounds the search in any shape, too, where a spring is far shorter
/// than at rest. (With all that it softens, rounding in the search found up to 270 times the border.)
static void a_search_finds_no_more_than_there_is(void **state) {
    (void)state;
    const recipe_stuff stuff = {.mass = {1, 3}, .stiffness = {100, 300}, .damping = {0, 1}};
    double most = 0.0;
    for (uint64_t seed = 1; seed <= 60; seed++) {
        uint64_t random = seed;
        recipe made = {0};
        if (seed % 3 > 0)
            recipe_lattice(&made, 6 + (uint32_t)(seed % 9), 5 + (uint32_t)(seed % 5), 0, 0, 1, &stuff, &random);
        else
            for (int i = 0; i < 20; i++)
                recipe_particle(&made, i % 5, i / 5, 1 + i % 3, 0);
        recipe_random_springs(&made, 20, &stuff, &random);
        mspring_network *network = recipe_network(&made, NULL);
        double any_shape;
        check_ok(mspring_network_get_stable_dt(network, NULL, &any_shape));
        for (float length = 1e3f; length <= 1e12f; length *= 1e3f) {
            check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, (mspring_id)seed % made.spring_count, 1, &length, 1));
            most = fmax(most, mspringi_stability_limit_search(network, any_shape, 0, 4.0, 100));
        }
        mspring_network_destroy(network);
        recipe_free(&made);
    }
    print_message("up to %.6f of 4\n", most);
    assert_true(most <= 4.0 * (1.0 + 1e-4)); // the guard's margin
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_never_above_the_border),
        cmocka_unit_test(it_is_near_for_lattices),
        cmocka_unit_test(elements_are_counted),
        cmocka_unit_test(pressure_is_counted),
        cmocka_unit_test(ropes_are_counted_wherever_they_are_stiff),
        cmocka_unit_test(it_does_not_vouch_for_overflows),
        cmocka_unit_test(a_search_finds_no_more_than_there_is),
    };
    return cmocka_run_group_tests_name("certificate", tests, NULL, NULL);
}

/// @file test_clamp.c
/// Steps with strain rates clamped: what would explode goes on, and comes to no energy that it cannot have;
/// momentum is kept; the bits are the same everywhere; and what cannot be helped is refused as ever.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"

#define DT (1.0 / 64)

/* -------------------------------------------------------------------------------------------------- networks */

static const recipe_shape shapes[] = {
    {"bar", .width = 60, .height = 5, .hangs = true},
    {"damped bar", .width = 60, .height = 5, .damping = 1e5, .hangs = true},
    {"ship", .width = 30, .height = 20, .rope = 20},
    {"rope", .rope = 50},
    {"graph", .particles = 100, .springs = 300},
};

static mspring_network *make(const recipe *made, mspring_guard guard, float gravity, uint32_t substeps) {
    mspring_network_def def = support_def(gravity, substeps);
    def.settings.guard = guard;
    return recipe_network(made, &def);
}

/// Kinetic energy and that of the springs, with the stiffness that they have in substeps of h, J.
static double softened_energy(const mspring_network *network, const recipe *made, double h) {
    double sum = 0, kinetic = 0;
    check_ok(support_get_energy(network, &kinetic, NULL, NULL));
    for (mspring_id s = 0; s < made->spring_count; s++) {
        support_spring_info info;
        check_ok(support_get_spring(network, s, &info));
        const double extension = (double)info.length - (double)info.rest_length;
        const mspring_particle_def *a = &made->particles[info.a], *b = &made->particles[info.b];
        const double by_a = a->flags & MSPRING_PARTICLE_PINNED ? 0 : 1 / (double)a->mass;
        const double by_b = b->flags & MSPRING_PARTICLE_PINNED ? 0 : 1 / (double)b->mass;
        const double stiffness = (double)info.stiffness / (1 + (double)info.stiffness * h * h * (by_a + by_b));
        sum += 0.5 * stiffness * extension * extension;
    }
    return kinetic + sum;
}

static double mass_of(const recipe *made) {
    double mass = 0;
    for (uint32_t p = 0; p < made->particle_count; p++) {
        mass += (double)made->particles[p].mass;
    }
    return mass;
}

/* -------------------------------------------------------------------------------------------------- stability */

/// From twice the border to 1e14 N/m, for 5 s: no step is refused, and there is never more energy than gravity can
/// have given, with what there was.
static void what_would_explode_goes_on(void **state) {
    (void)state;
    const double stiffnesses[] = {1e4, 1e6, 1e14}, ratios[] = {1, 1e3};
    const uint32_t substeps[] = {1, 3};
    double worst = 0;
    for (size_t i = 0; i < COUNT_OF(shapes) * COUNT_OF(stiffnesses) * COUNT_OF(ratios) * COUNT_OF(substeps); i++) {
        const recipe_shape *s = &shapes[i % COUNT_OF(shapes)];
        size_t rest = i / COUNT_OF(shapes);
        const double stiffness = stiffnesses[rest % COUNT_OF(stiffnesses)];
        rest /= COUNT_OF(stiffnesses);
        const uint32_t count = substeps[rest % COUNT_OF(substeps)];
        recipe made = recipe_of_shape(s, stiffness, ratios[rest / COUNT_OF(substeps)]);
        mspring_network *network = make(&made, MSPRING_GUARD_CLAMP, -9.8f, count);
        const double first = softened_energy(network, &made, DT / count), mass = mass_of(&made);
        for (uint32_t step = 1; step <= 320; step++) {
            check_ok(mspring_network_step(network, DT));
            double kinetic = 0;
            check_ok(support_get_energy(network, &kinetic, NULL, NULL));
            const double root = sqrt(first) + 9.8 * step * DT * sqrt(mass / 2);
            worst = fmax(worst, kinetic / (root * root));
        }
        // The graphs of heavy particles are within the border at the least stiffness.
        if (stiffness > 1e5) {
            assert_int_equal(support_fallback_count(network), 320);
        }
        mspring_network_destroy(network);
        recipe_free(&made);
    }
    print_message("kinetic energy at most %.3f of what there can be\n", worst);
    assert_true(worst < 1.001); // of rounding
}

/// Without gravity and pins energy falls to a tenth, and is never more than at first. (From step to step it may rise:
/// how stiff springs are there depends on the shape.)
static void energy_falls(void **state) {
    (void)state;
    const double stiffnesses[] = {1e5, 1e8, 1e12};
    for (size_t i = 0; i < 2 * COUNT_OF(stiffnesses); i++) {
        recipe made = recipe_of_shape(&shapes[i % 2 ? 4 : 2], stiffnesses[i / 2], 10);
        uint64_t seed = 3;
        recipe_disturb(&made, 0.2, 5, &seed);
        mspring_network *network = make(&made, MSPRING_GUARD_CLAMP, 0, 1);
        const double first = softened_energy(network, &made, DT);
        double now = first;
        for (uint32_t step = 0; step < 120; step++) {
            check_ok(mspring_network_step(network, DT));
            now = softened_energy(network, &made, DT);
            assert_true(now < first);
        }
        assert_true(now < 0.1 * first);
        assert_int_equal(support_fallback_count(network), 120);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/// The article's bar, which falls and crosses its border: it stays as long as its springs allow, about.
static void a_bar_that_crosses_its_border_goes_on(void **state) {
    (void)state;
    const double stiffnesses[] = {139000, 229376, 1e9};
    for (size_t i = 0; i < COUNT_OF(stiffnesses); i++) {
        uint64_t seed = 8;
        const recipe_stuff stuff = {
            .mass = {73.3975, 73.3975}, .stiffness = {stiffnesses[i], stiffnesses[i]}, .damping = {55.05, 55.05}};
        recipe made = {0};
        recipe_lattice(&made, 80, 5, 0, 0, 1, &stuff, &seed);
        for (uint32_t row = 0; row < 5; row++) {
            made.particles[row * 80].flags = MSPRING_PARTICLE_PINNED;
        }
        mspring_network *network = make(&made, MSPRING_GUARD_CLAMP, -9.8f, 1);
        double longest = 0;
        for (uint32_t step = 0; step < 1280; step++) {
            check_ok(mspring_network_step(network, DT));
            const support_point tip = support_position(network, 79);
            longest = fmax(longest, hypot(tip.x, tip.y));
        }
        print_message("%g N/m: %u steps of 1280 clamped, tip up to %.1f m from its pin at 79 m\n", stiffnesses[i],
                      (unsigned)support_fallback_count(network), longest);
        assert_true(support_fallback_count(network) > 0);
        assert_true(longest < 2 * 79); // at the stiffness that it has its weight makes it 1.5 times as long
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

static void particles_in_one_place_have_no_direction(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id a = support_particle(builder, 0, 0, 1), b = support_particle(builder, 1, 0, 1);
    const mspring_id pinned = support_pinned(builder, 2, 0, 1), other = support_pinned(builder, 3, 0, 1);
    support_spring(builder, a, b, 1e10f, 1e6f);
    support_spring(builder, b, pinned, 1e10f, 1e6f);
    support_spring(builder, pinned, other, 1e10f, 1e6f);
    mspring_network_def def = support_def(0, 1);
    def.settings.guard = MSPRING_GUARD_CLAMP;
    mspring_network *network = support_network(builder, &def);
    const double x[4] = {2, 2, 2, 2}, y[4] = {0, 0, 0, 0};
    check_ok(mspring_network_set_positions(network, NULL, 0, 4, x, y, 1));
    support_steps(network, 100, DT);
    for (mspring_id p = 0; p < 4; p++) {
        check_near(support_position(network, p).x, 2, 0);
        check_near(support_velocity(network, p).x, 0, 0);
    }
    // A nudge, and they find their distances.
    const float nudge = 1e-3f;
    check_ok(mspring_network_set_velocities(network, NULL, a, 1, &nudge, &nudge, 1));
    support_steps(network, 2000, DT);
    const support_point at_a = support_position(network, a), at_b = support_position(network, b);
    check_near(hypot(at_b.x - 2, at_b.y), 1, 1e-3);
    check_near(hypot(at_b.x - at_a.x, at_b.y - at_a.y), 1, 1e-3);
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------------- conservation */

static void momentum_is_kept(void **state) {
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        recipe made = recipe_of_shape(&shapes[i ? 4 : 2], 1e9, 10);
        uint64_t seed = 3;
        recipe_disturb(&made, 0.1, 5, &seed);
        for (uint32_t p = 0; p < made.particle_count; p++) {
            made.particles[p].vx += 3;                                 // goes
            made.particles[p].vy += 0.2f * (float)made.particles[p].x; // and turns
        }
        mspring_network *network = make(&made, MSPRING_GUARD_CLAMP, 0, 1);
        double px = 0, py = 0, turn = 0, px_then = 0, py_then = 0, turn_then = 0;
        check_ok(support_get_momentum(network, &px, &py, &turn));
        support_steps(network, 200, DT);
        check_ok(support_get_momentum(network, &px_then, &py_then, &turn_then));
        assert_int_equal(support_fallback_count(network), 200);
        // Each impulse is rounded to 6e-8 of a velocity at either end, at random; some ten of them a particle and
        // step.
        const double whole = mass_of(&made) * 5, tolerance = whole * 6e-8 * sqrt(200 * 10);
        check_near(px_then, px, tolerance);
        check_near(py_then, py, tolerance);
        print_message("momentum %.6g and %.6g, then %.6g and %.6g; angular %.5g, then %.5g\n", px, py, px_then,
                      py_then, turn, turn_then);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/* ----------------------------------------------------------------------------------------------- the same bits */

/// A bar on its way from steps that are taken as they are to clamped ones and back, over the floor, with breaking
/// springs and a hook.
static recipe hanging_bar(void) {
    uint64_t seed = 5;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1900, 1900}, .damping = {0.75, 0.75}};
    recipe made = {0};
    recipe_lattice(&made, 80, 5, 0, 0, 1, &stuff, &seed);
    for (uint32_t row = 0; row < 5; row++) {
        made.particles[row * 80].flags = MSPRING_PARTICLE_PINNED;
    }
    return made;
}

static void brake(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->inverse_mass[slot] > 0 && args->vy[slot] < -40) {
            args->vy[slot] = -40;
        }
    }
}

typedef struct playing {
    mspring_simd level;
    uint32_t workers, substeps;
    bool hooked, pauses;
} playing;

static uint64_t play(const recipe *made, playing how, uint64_t *clamped) {
    mspring_network_def def = support_def(-9.8f, how.substeps);
    def.settings.guard = MSPRING_GUARD_CLAMP;
    def.simd_level = how.level;
    def.worker_count = how.workers;
    def.settings.sleep_speed = 0.01f;
    def.settings.max_substeps = 1; // too few for MSPRING_SUBSTEPS_AUTO
    mspring_network *network = recipe_network(made, &def);
    const double plane[4] = {0, -30, 0.1, 1};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = plane;
    floor.plane_count = 1;
    floor.friction = 0.3f;
    check_ok(mspring_network_set_floor(network, &floor));
    if (how.hooked) {
        check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, brake, NULL, NULL));
    }
    const float strain = 0.3f;
    for (mspring_id s = 0; s < made->spring_count; s++) {
        check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, s, 1, &strain, 1));
    }
    for (uint32_t step = 0; step < 300; step++) {
        check_ok(mspring_network_step(network, DT));
        if (how.pauses && (step == 50 || step == 151 || step == 250)) {
            size_t size;
            check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_ALL, &size));
            void *snapshot = malloc(size);
            assert_non_null(snapshot);
            check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, snapshot, size, NULL));
            support_steps(network, 2, DT);
            check_ok(mspring_network_load(network, snapshot, size));
            mspring_network *clone = NULL;
            check_ok(mspring_network_clone(network, NULL, &clone));
            mspring_network_destroy(network);
            network = clone;
            if (how.hooked) { // a clone has none
                check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, brake, NULL, NULL));
            }
            free(snapshot);
        }
    }
    *clamped = support_fallback_count(network);
    const uint64_t hash = support_hash(network);
    mspring_network_destroy(network);
    return hash;
}

static void bits_are_the_same_everywhere(void **state) {
    (void)state;
    recipe made = hanging_bar();
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    const uint32_t substeps[] = {1, MSPRING_SUBSTEPS_AUTO};
    for (size_t i = 0; i < 4; i++) {
        playing how = {.level = MSPRING_SIMD_SCALAR, .workers = 1, .substeps = substeps[i / 2], .hooked = i % 2};
        uint64_t clamped = 0, again = 0;
        const uint64_t expected = play(&made, how, &clamped);
        print_message("%u of 300 steps clamped\n", (unsigned)clamped);
        assert_true(clamped > 100);
        for (uint32_t l = 1; l < count; l++) {
            how.level = levels[l];
            how.workers = l % 2 + 1;
            assert_true(play(&made, how, &again) == expected);
            assert_true(again == clamped);
        }
        how.pauses = true;
        assert_true(play(&made, how, &again) == expected);
    }
    recipe_free(&made);
}

/// All springs act at once, so where they lie changes the order of sums alone.
static void plans_make_no_difference(void **state) {
    (void)state;
    recipe made = recipe_of_shape(&shapes[2], 1e8, 10);
    mspring_network *networks[2];
    double apart = 0;
    for (size_t i = 0; i < 2; i++) {
        networks[i] = make(&made, MSPRING_GUARD_CLAMP, -9.8f, 1);
        for (mspring_id s = 0; s < made.spring_count; s += 3) {
            check_ok(mspring_network_break_springs(networks[i], &s, 0, 1));
        }
        if (i == 1) {
            check_ok(mspring_network_compact(networks[i]));
        }
        support_steps(networks[i], 100, DT);
        assert_int_equal(support_fallback_count(networks[i]), 100);
    }
    for (mspring_id p = 0; p < made.particle_count; p++) {
        const support_point a = support_position(networks[0], p), b = support_position(networks[1], p);
        apart = fmax(apart, hypot(a.x - b.x, a.y - b.y));
    }
    print_message("%g m apart\n", apart);
    assert_true(apart < 1e-3); // rounding of 100 steps of a body of 30 m, which is 2e-6 m in each
    mspring_network_destroy(networks[0]);
    mspring_network_destroy(networks[1]);
    recipe_free(&made);
}

/* ---------------------------------------------------------------------------------------------- what it is not */

static void what_is_stable_is_not_clamped(void **state) {
    (void)state;
    recipe made = recipe_of_shape(&shapes[2], 1000, 1);
    mspring_network *network = make(&made, MSPRING_GUARD_CLAMP, -9.8f, 1);
    mspring_network *twin = make(&made, MSPRING_GUARD_GROWTH, -9.8f, 1);
    support_steps(network, 500, DT);
    support_steps(twin, 500, DT);
    assert_int_equal(support_hash(network), support_hash(twin));
    assert_int_equal(support_fallback_count(network), 0);
    mspring_network_destroy(network);
    mspring_network_destroy(twin);
    recipe_free(&made);
}

/// Out of bounds is out of bounds: the error as without, and everything as it was.
static void what_cannot_be_helped_is_refused(void **state) {
    (void)state;
    recipe made = recipe_of_shape(&shapes[2], 1e9, 10);
    mspring_network *network = make(&made, MSPRING_GUARD_CLAMP, -9.8f, 1);
    mspring_network *twin = make(&made, MSPRING_GUARD_CLAMP, -9.8f, 1);
    support_steps(network, 10, DT);
    support_steps(twin, 10, DT);
    check_ok(mspring_network_apply_force(network, 7, 3e30f, 0));
    const uint64_t before = support_hash(network), count = support_fallback_count(network);
    for (int again = 0; again < 2; again++) {
        check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
        check_contains(mspring_network_error(network), "throw particle");
        assert_int_equal(support_hash(network), before);
        assert_int_equal(support_fallback_count(network), count);
    }
    check_ok(mspring_network_apply_force(network, 7, -3e30f, 0)); // it was still there
    support_steps(network, 30, DT);
    support_steps(twin, 30, DT);
    assert_int_equal(support_hash(network), support_hash(twin));
    mspring_network_destroy(network);
    mspring_network_destroy(twin);
    recipe_free(&made);
}

static void steps_allocate_nothing(void **state) {
    (void)state;
    recipe made = hanging_bar();
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.guard = MSPRING_GUARD_CLAMP;
    def.allocator = &allocator;
    mspring_network *network = recipe_network(&made, &def);
    const size_t calls = watched.calls, memory = support_memory_used(network);
    support_steps(network, 200, DT);
    assert_true(support_fallback_count(network) > 0);
    assert_int_equal(watched.calls, calls);
    mspring_network_destroy(network);
    check_watched_clean(&watched);
    // And a network that may is as large as one that may not.
    network = make(&made, MSPRING_GUARD_GROWTH, -9.8f, 1);
    assert_int_equal(support_memory_used(network), memory);
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_would_explode_goes_on),
        cmocka_unit_test(energy_falls),
        cmocka_unit_test(a_bar_that_crosses_its_border_goes_on),
        cmocka_unit_test(particles_in_one_place_have_no_direction),
        cmocka_unit_test(momentum_is_kept),
        cmocka_unit_test(bits_are_the_same_everywhere),
        cmocka_unit_test(plans_make_no_difference),
        cmocka_unit_test(what_is_stable_is_not_clamped),
        cmocka_unit_test(what_cannot_be_helped_is_refused),
        cmocka_unit_test(steps_allocate_nothing),
    };
    return cmocka_run_group_tests_name("clamp", tests, NULL, NULL);
}

/// @file test_levels.c
/// A level gives the scalar level's state (in a build without that the lowest one's), byte for byte, on networks of
/// every awkward size, and writes nowhere but into its own memory; and the host's floating-point modes do not
/// matter.
///
/// SPDX-License-Identifier: MIT
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "allocator.h"
#include "level.h"
#include "recipe.h"
#include "support.h"

static mspring_simd level;

/// The state of a network, by id.
typedef struct snapshot {
    float *values; ///< x, y, vx, vy of particle 0, of particle 1, ...
    size_t size;   ///< bytes
    uint64_t hash;
} snapshot;

static snapshot run(const recipe *made, mspring_simd at, uint32_t steps) {
    watched_allocator watched = {0};
    mspring_allocator allocator = watched_interface(&watched);
    mspring_network_def def = support_def(-9.8f, 3);
    def.simd_level = at;
    def.settings.global_damping = 0.25f;
    def.settings.max_speed = 1e15f;
    def.allocator = &allocator;
    mspring_network *network = recipe_network(made, &def);
    level_check(network, at);
    for (uint32_t step = 0; step < steps; step++) {
        // Forces in half of the steps: the kernels with and those without.
        if (step % 2 == 1) {
            check_ok(mspring_network_apply_force(network, step % made->particle_count, 30, -20));
        }
        support_steps(network, 1, 1.0 / 64);
    }
    snapshot taken = {.size = made->particle_count * 4 * sizeof(float), .hash = support_hash(network)};
    taken.values = malloc(taken.size);
    assert_non_null(taken.values);
    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_get_view(network, &view));
    for (mspring_id id = 0; id < made->particle_count; id++) {
        uint32_t slot = view.slot_of_particle[id];
        const float values[4] = {view.x[slot], view.y[slot], view.vx[slot], view.vy[slot]};
        memcpy(taken.values + (size_t)4 * id, values, sizeof values);
    }
    mspring_network_destroy(network);
    check_watched_clean(&watched);
    return taken;
}

static void check_equal_to_scalar(const recipe *made, const char *what, uint32_t a, uint32_t b) {
    const uint32_t steps = 6;
    snapshot mine = run(made, level, steps), scalar = run(made, level_lowest(), steps);
    if (mine.hash != scalar.hash || memcmp(mine.values, scalar.values, mine.size) != 0) {
        print_error("%s %u x %u, %u particles, %u springs\n", what, a, b, made->particle_count, made->spring_count);
    }
    assert_memory_equal(mine.values, scalar.values, mine.size);
    assert_int_equal(mine.hash, scalar.hash);
    free(mine.values);
    free(scalar.values);
}

static recipe_stuff random_stuff(uint32_t variant) {
    recipe_stuff stuff = {.mass = {0.5, 2}, .stiffness = {500, 3000}, .pinned = 0.05};
    stuff.damping[1] = variant % 2 == 0 ? 0 : 10;
    stuff.holes = variant % 3 == 0 ? 0 : 0.15 * (variant % 3);
    return stuff;
}

static void lattices_of_every_size(void **state) {
    (void)state;
    for (uint32_t columns = 1; columns <= 40; columns++) {
        for (uint32_t rows = 1; rows <= 5; rows++) {
            for (uint32_t variant = 0; variant < 4; variant++) {
                uint64_t seed = columns * 100 + rows * 10 + variant;
                recipe_stuff stuff = random_stuff(variant);
                recipe made = {0};
                recipe_lattice(&made, columns, rows, 0, 0, 1, &stuff, &seed);
                if (made.particle_count > 0) {
                    recipe_disturb(&made, 0.1, 3, &seed);
                    check_equal_to_scalar(&made, "lattice", columns, rows);
                }
                recipe_free(&made);
            }
        }
    }
}

static void chains_of_every_length(void **state) {
    (void)state;
    for (uint32_t segments = 1; segments <= 70; segments++) {
        uint64_t seed = segments;
        recipe_stuff stuff = random_stuff(segments);
        recipe made = {0};
        mspring_id a = recipe_particle(&made, 0, 0, 1, MSPRING_PARTICLE_PINNED);
        mspring_id b = recipe_particle(&made, segments, 1, 1, 0);
        recipe_rope(&made, a, b, segments, &stuff, &seed);
        recipe_disturb(&made, 0.1, 3, &seed);
        check_equal_to_scalar(&made, "chain", segments, 1);
        recipe_free(&made);
    }
}

static void loose_particles_of_every_number(void **state) {
    (void)state;
    for (uint32_t count = 1; count <= 40; count++) {
        uint64_t seed = count;
        recipe made = {0};
        for (uint32_t i = 0; i < count; i++) {
            recipe_particle(&made, i, 0, 1 + 0.1 * i, i % 5 == 4 ? MSPRING_PARTICLE_PINNED : 0);
        }
        recipe_disturb(&made, 0.1, 3, &seed);
        check_equal_to_scalar(&made, "loose", count, 1);
        recipe_free(&made);
    }
}

static void mixtures_of_all(void **state) {
    (void)state;
    for (uint32_t variant = 0; variant < 30; variant++) {
        uint64_t seed = 1000 + variant;
        recipe_stuff stuff = random_stuff(variant);
        recipe made = {0};
        uint32_t columns = 10 + (uint32_t)(support_random(&seed) % 60),
                 rows = 3 + (uint32_t)(support_random(&seed) % 12);
        recipe_lattice(&made, columns, rows, 0, 0, 1, &stuff, &seed);
        recipe_lattice(&made, rows, columns, 100, 0, 0.5, &stuff, &seed);
        for (uint32_t i = 0; i < 5; i++) {
            recipe_rope(&made, (mspring_id)i, made.particle_count - 1 - i, 3 + 7 * i, &stuff, &seed);
        }
        recipe_random_springs(&made, 25, &stuff, &seed);
        recipe_disturb(&made, 0.1, 3, &seed);
        recipe_shuffle(&made, &seed, NULL);
        check_equal_to_scalar(&made, "mixture", columns, rows);
        recipe_free(&made);
    }
}

static void extreme_values(void **state) {
    (void)state;
    // Denormal numbers, overflowing squares and coincident particles: same bits here, too.
    for (uint32_t variant = 0; variant < 4; variant++) {
        uint64_t seed = 50 + variant;
        const double spacings[] = {1e-9, 1e-4, 1e9, 1};
        const double scale = spacings[variant];
        const recipe_stuff stuff = {
            .mass = {1e-3, 1e3}, .stiffness = {1e-3, 1}, .damping = {0, 1e-3}, .holes = 0.1};
        recipe made = {0};
        recipe_lattice(&made, 37, 8, 0, 0, scale, &stuff, &seed);
        recipe_disturb(&made, 0.1 * scale, 1e-30, &seed);
        if (variant == 3) {
            for (uint32_t i = 0; i < made.particle_count; i++) {
                made.particles[i].x = made.particles[i].y = 0; // rest lengths are those of the lattice
            }
        }
        check_equal_to_scalar(&made, "extreme", variant, 0);
        recipe_free(&made);
    }
}

/// What a spring by itself, or the first one of a lattice, does to a particle of 1 kg at rest within 1 s, m/s. Its
/// other end is length away and flies off at speed.
static double pulled(bool in_lattice, double length, double rest_length, double stiffness, double damping,
                     float speed) {
    recipe made = {0};
    uint64_t seed = 1;
    const recipe_stuff stuff = {.mass = {1, 1}};
    if (in_lattice) {
        recipe_lattice(&made, 2, 2, 0, 0, 0.5, &stuff, &seed); // its local origin is (0, 0)
    } else {
        recipe_particle(&made, 0, 0, 1, 0);
        recipe_spring(&made, 0, recipe_particle(&made, 0.5, 0, 1, 0), 0, 0, 0);
    }
    uint32_t spring = 0;
    while (made.springs[spring].a + made.springs[spring].b != 1) {
        spring++;
    }
    made.springs[spring].rest_length = (float)rest_length;
    made.springs[spring].stiffness = (float)stiffness;
    made.springs[spring].damping = (float)damping;
    mspring_network_def def = support_def(0, 1);
    def.simd_level = level;
    def.settings.max_speed = 1e15f;
    def.settings.guard = MSPRING_GUARD_BOUNDS; // a spring of no length is not stable
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    level_check(network, level);
    const double x[] = {0, length}, y[] = {0, 0};
    const float vx[] = {0, speed}, vy[] = {0, 0};
    check_ok(mspring_network_set_positions(network, NULL, 0, 2, x, y, 1));
    check_ok(mspring_network_set_velocities(network, NULL, 0, 2, vx, vy, 1));
    check_ok(mspring_network_step(network, 1)); // of which the first half changes velocities
    const support_point got = support_velocity(network, 0);
    assert_true(got.y == 0.0);
    mspring_network_destroy(network);
    return 2 * got.x;
}

static void springs_of_any_length_obey_the_law(void **state) {
    (void)state;
    for (int in_lattice = 0; in_lattice < 2; in_lattice++) {
        for (int exponent = -18; exponent <= 11; exponent++) {
            // Stretched and pressed; so stiff that the particle moves by a thousandth of the length. As far from
            // its origin as it is long, the network's coordinates have an error of 1 part in 2^24.
            const double length = 4.0 * pow(10, exponent), stiffness = 1e-3;
            for (double rest = 0.5; rest < 2; rest += 1) {
                const double rest_length = (float)(rest * length), speed = stiffness * (length - rest_length);
                check_near(pulled(in_lattice, length, rest_length, stiffness, 0, 0), speed,
                           1e-6 * length * stiffness);
            }
            // A damper alone.
            const float apart = (float)(1e-3 * length);
            check_near(pulled(in_lattice, length, length, 0, 0.5, apart), 0.5 * (double)apart,
                       1e-6 * (double)apart);
        }
        // So short that there is no direction, and so no force.
        const double none[] = {3e-19, 1e-20, 1e-25, 1e-38, 1e-45, 0};
        for (size_t i = 0; i < COUNT_OF(none); i++) {
            assert_true(pulled(in_lattice, none[i], 1e-3, 1e3, 1e3, 1.0f) == 0.0);
        }
    }
}

/// Build and step a network while the host has set a rounding mode, and find that it is still set.
static uint64_t hash_in_rounding_mode(const recipe *made, int mode) {
    mspring_network_def def = support_def(-9.8f, 3);
    def.simd_level = level;
    def.settings.global_damping = 0.25f;
    assert_int_equal(fesetround(mode), 0);
    mspring_network *network = recipe_network(made, &def);
    support_steps(network, 10, 1.0 / 64);
    const int mode_after = fegetround();
    fesetround(FE_TONEAREST);
    assert_int_equal(mode_after, mode);
    uint64_t hash = support_hash(network);
    mspring_network_destroy(network);
    return hash;
}

static void rounding_mode_of_the_host_does_not_matter(void **state) {
    (void)state;
    const int modes[] = {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    uint64_t seed = 8;
    recipe_stuff stuff = random_stuff(1);
    recipe made = {0};
    recipe_lattice(&made, 30, 10, 0.1, 0.7, 0.3, &stuff,
                   &seed); // positions and rest lengths that have to be rounded
    recipe_rope(&made, 5, 200, 12, &stuff, &seed);
    recipe_random_springs(&made, 10, &stuff, &seed);
    const uint64_t expected = hash_in_rounding_mode(&made, FE_TONEAREST);
    for (size_t i = 0; i < COUNT_OF(modes); i++) {
        assert_int_equal(hash_in_rounding_mode(&made, modes[i]), expected);
    }
    recipe_free(&made);
}

#if defined(__SSE__)
#define FLUSH_TO_ZERO 0x8040u // of denormal results and operands

static void set_flushing(int on) {
    _mm_setcsr(on ? _mm_getcsr() | FLUSH_TO_ZERO : _mm_getcsr() & ~FLUSH_TO_ZERO);
}

static void flushing_denormals_does_not_matter(void **state) {
    (void)state;
    set_flushing(1);
    const bool flushes = (_mm_getcsr() & FLUSH_TO_ZERO) == FLUSH_TO_ZERO;
    set_flushing(0);
    if (!flushes) {
        skip(); // some emulators, valgrind's too, leave out these modes
    }
    // Speeds that are denormal numbers; nothing damps them.
    uint64_t seed = 9;
    recipe made = {0};
    for (int i = 0; i < 40; i++) {
        recipe_particle(&made, i, 0, 1, 0);
        made.particles[i].vx = (float)support_random_between(&seed, 1e-40, 1e-39);
    }
    mspring_network_def def = support_def(0, 1);
    def.simd_level = level;
    uint64_t hashes[2];
    for (int on = 0; on < 2; on++) {
        mspring_network *network = recipe_network(&made, &def);
        set_flushing(on);
        support_steps(network, 10, 1.0 / 64);
        const uint32_t kept = _mm_getcsr() & FLUSH_TO_ZERO;
        set_flushing(0);
        assert_int_equal(kept, on ? FLUSH_TO_ZERO : 0);
        hashes[on] = support_hash(network);
        double vx = support_velocity(network, 0).x;
        assert_true(vx > 0 && vx < (double)FLT_MIN); // or there was nothing to flush
        mspring_network_destroy(network);
    }
    assert_int_equal(hashes[0], hashes[1]);
    recipe_free(&made);
}
#endif

/// A speed that is none, that a hook writes, where damping would bring it back within the step: refused at all
/// levels, whatever overflows on the way.
static void speeds_out_of_bounds(void **state) {
    (void)state;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1, 1}, .damping = {1, 1}};
    const mspring_simd levels[] = {level, level_lowest()};
    for (uint32_t width = 1; width <= 20; width++) {
        for (size_t i = 0; i < COUNT_OF(levels); i++) {
            uint64_t seed = 1;
            recipe made = {0};
            recipe_lattice(&made, width, 3, 0, 0, 1e9, &stuff, &seed);
            recipe_lattice(&made, width / 2 + 1, 3, 0, 1e11, 1e9, &stuff, &seed);
            mspring_network_def def = support_def(0, 1);
            def.simd_level = levels[i];
            def.settings.guard = MSPRING_GUARD_BOUNDS;
            def.settings.global_damping = 1e6f;
            mspring_network *network = recipe_network(&made, &def);
            support_writing writing = {.array = 2, .particle = width - 1, .value = -3e38f};
            (void)support_write_in_step(network, &writing);
            const uint64_t before = support_hash(network);
            check_error(mspring_network_step(network, 1), MSPRING_ERROR_UNSTABLE);
            assert_int_equal(support_hash(network), before);
            char culprit[32];
            (void)snprintf(culprit, sizeof culprit, "particle %u ", (unsigned)(width - 1));
            check_contains(mspring_network_error(network), culprit);
            writing = (support_writing){.array = 2, .particle = width - 1, .value = -1e11f}; // 1e5 m/s are left of it
            check_ok(mspring_network_step(network, 1));
            mspring_network_destroy(network);
            recipe_free(&made);
        }
    }
}

// The same where no step fails, and where a rejected one is repeated, by a hook that does it once.
static void speeds_out_of_bounds_are_put_back(void **state) {
    (void)state;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1, 1}, .damping = {1, 1}};
    const mspring_simd levels[] = {level, level_lowest()};
    const float speeds[] = {-3e38f, 2e15f, INFINITY, NAN}; // the guard sees what is not finite
    for (uint32_t width = 1; width <= 20; width++) {
        for (size_t s = 0; s < 2 * COUNT_OF(speeds); s++) {
            uint64_t hashes[2];
            for (size_t i = 0; i < COUNT_OF(levels); i++) {
                uint64_t seed = 1;
                recipe made = {0};
                recipe_lattice(&made, width, 3, 0, 0, 1e9, &stuff, &seed);
                mspring_network_def def = support_def(0, 2);
                def.simd_level = levels[i];
                def.settings.guard = s % 2 ? MSPRING_GUARD_CLAMP : MSPRING_GUARD_CLAMP_BOUNDS;
                def.settings.global_damping = 1e6f;
                mspring_network *network = recipe_network(&made, &def);
                support_writing writing = {.array = 2, .particle = width / 2, .value = speeds[s / 2]};
                (void)support_write_in_step(network, &writing);
                check_ok(mspring_network_step(network, 1));
                const uint32_t flags = support_step_flags(network);
                assert_true(flags & (s % 2 ? MSPRING_STEP_CLAMPED : MSPRING_STEP_PUT_BACK));
                hashes[i] = support_hash(network);
                mspring_network_destroy(network);
                recipe_free(&made);
            }
            assert_int_equal(hashes[0], hashes[1]);
        }
    }
}

int main(int argc, char **argv) {
    level = level_from_arguments(argc, argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lattices_of_every_size),
        cmocka_unit_test(chains_of_every_length),
        cmocka_unit_test(loose_particles_of_every_number),
        cmocka_unit_test(mixtures_of_all),
        cmocka_unit_test(extreme_values),
        cmocka_unit_test(springs_of_any_length_obey_the_law),
        cmocka_unit_test(speeds_out_of_bounds),
        cmocka_unit_test(speeds_out_of_bounds_are_put_back),
        cmocka_unit_test(rounding_mode_of_the_host_does_not_matter),
#if defined(__SSE__)
        cmocka_unit_test(flushing_denormals_does_not_matter),
#endif
    };
    return cmocka_run_group_tests_name("levels", tests, NULL, NULL);
}

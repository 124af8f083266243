/// @file test_origin.c
/// The local origin: a network far away behaves as one at the world's origin, and one that flies far takes its
/// precision along.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "recipe.h"
#include "support.h"

/// A wobbling ship with an anchored corner: lattice with holes, ropes, leftover springs.
static recipe ship(void) {
    uint64_t seed = 17;
    const recipe_stuff stuff = {.mass = {2, 3}, .stiffness = {3000, 5000}, .damping = {1, 2}, .holes = 0.1};
    recipe made = {0};
    mspring_id first = recipe_lattice(&made, 30, 10, 0, 0, 1, &stuff, &seed);
    mspring_id top = recipe_particle(&made, 15, 25, 2, 0);
    recipe_rope(&made, first, top, 20, &stuff, &seed);
    recipe_rope(&made, first + 20, top, 20, &stuff, &seed);
    recipe_random_springs(&made, 5, &stuff, &seed);
    made.particles[first].flags = MSPRING_PARTICLE_PINNED;
    recipe_disturb(&made, 0.05, 1, &seed);
    return made;
}

static void far_away_is_as_here(void **state) {
    (void)state;
    // Sums of whole metres and fractions are exact in double up to here, so the local states are the same bits; a
    // float that held world coordinates would have an ulp of 1 mm, 16 m and 64 km at these places.
    const double places[][2] = {{10000, -7000}, {-123456789, 1e8}, {5e11, -9e11}};
    recipe here = ship();
    // Positions as 1 / 2^12 m, so that they are exact in double at the farthest place.
    for (uint32_t i = 0; i < here.particle_count; i++) {
        here.particles[i].x = floor(here.particles[i].x * 4096) / 4096;
        here.particles[i].y = floor(here.particles[i].y * 4096) / 4096;
    }
    mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *home = recipe_network(&here, &def);
    support_steps(home, 200, 1.0 / 64);
    for (size_t i = 0; i < COUNT_OF(places); i++) {
        recipe there = ship();
        for (uint32_t id = 0; id < there.particle_count; id++) {
            there.particles[id].x = here.particles[id].x + places[i][0];
            there.particles[id].y = here.particles[id].y + places[i][1];
        }
        mspring_network *away = recipe_network(&there, &def);
        support_steps(away, 200, 1.0 / 64);
        for (uint32_t id = 0; id < here.particle_count; id++) {
            support_point v = support_velocity(home, id), w = support_velocity(away, id);
            assert_true(v.x == w.x && v.y == w.y);
            support_point p = support_position(home, id), q = support_position(away, id);
            // What a double resolves at 9e11 m is 1.2e-4 m.
            check_near(q.x - places[i][0], p.x, 2e-4);
            check_near(q.y - places[i][1], p.y, 2e-4);
        }
        mspring_network_destroy(away);
        recipe_free(&there);
    }
    mspring_network_destroy(home);
    recipe_free(&here);
}

static void at_any_offset_it_stays_as_still(void **state) {
    (void)state;
    // A stiff square lattice at rest, 10 km away and at no whole number of metres. In world coordinates in float it
    // would tremble at over 1 m/s.
    uint64_t seed = 4;
    const recipe_stuff stuff = {.mass = {73, 73}, .stiffness = {6.7e7, 6.7e7}};
    recipe made = {0};
    recipe_lattice(&made, 20, 5, 10000.3, -9999.7, 1, &stuff, &seed);
    mspring_network_def def = support_def(0, 30);
    mspring_network *network = recipe_network(&made, &def);
    double fastest = 0;
    for (int step = 0; step < 128; step++) {
        check_ok(mspring_network_step(network, 1.0 / 64));
        for (mspring_id id = 0; id < made.particle_count; id++) {
            support_point v = support_velocity(network, id);
            fastest = fmax(fastest, hypot(v.x, v.y));
        }
    }
    // Each of the 3840 substeps rounds positions within 16 m of the origin by up to half an ulp, 5e-7 m, at random;
    // such an error swings on with omega = sqrt(8 k / m) = 2700 1/s, and n of them add to sqrt(n) times one.
    assert_true(fastest < 0.1);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void a_flying_ship_keeps_its_shape(void **state) {
    (void)state;
    // 100 km in 300 s, with a wobble that dampers take out. In the end every spring has its rest length.
    uint64_t seed = 23;
    const recipe_stuff stuff = {.mass = {2, 3}, .stiffness = {3000, 5000}, .damping = {40, 60}, .holes = 0.1};
    recipe made = {0};
    recipe_lattice(&made, 30, 10, 0.5, 0.25, 1, &stuff, &seed);
    recipe_random_springs(&made, 5, &stuff, &seed);
    recipe_disturb(&made, 0.05, 0, &seed);
    const double speed_x = 1000.0 / 3, speed_y = -1000.0 / 7;
    for (uint32_t id = 0; id < made.particle_count; id++) {
        made.particles[id].vx = (float)speed_x;
        made.particles[id].vy = (float)speed_y;
    }
    mspring_network_def def = support_def(0, 2);
    mspring_network *network = recipe_network(&made, &def);
    double px, py, px_now, py_now;
    check_ok(support_get_momentum(network, &px, &py, NULL));
    const uint32_t steps = 300 * 64;
    support_steps(network, steps, 1.0 / 64);

    // Without the moving origin positions would be multiples of 8 mm, and strains of about that. With it they are
    // within 128 m of the origin and off by up to half an ulp, 4e-6 m, at each end; the 333 m/s are off by 1.5e-5
    // m/s, which the dampers, of the same size as the springs within a substep, turn into as much.
    float strain;
    check_ok(support_get_max_strain(network, &strain, NULL));
    assert_true(strain < 1e-4f);

    double min_x, min_y, max_x, max_y;
    check_ok(support_get_bounds(network, &min_x, &min_y, &max_x, &max_y));
    assert_true(hypot(min_x, min_y) > 1e5);
    // Each of 38,400 substeps rounds a position by up to 4e-6 m, and a velocity by up to 1.5e-5 m/s for the rest of
    // the time: at random that adds to 1 m at most, always the same way it would be 100 m.
    check_near((min_x + max_x) / 2, 15 + speed_x * 300, 2);
    check_near((min_y + max_y) / 2, 4.75 + speed_y * 300, 2);
    check_ok(support_get_momentum(network, &px_now, &py_now, NULL));
    // The same velocity errors at random are 1.5e-5 / 333 sqrt(38400 / 250) = 5.6e-7 of vx, 1.3e-6 of vy.
    check_near(px_now / px, 1, 2e-6);
    check_near(py_now / py, 1, 4e-6);

    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_get_view(network, &view));
    check_near(view.origin_x, (min_x + max_x) / 2, 200); // the origin has come along
    check_near(view.origin_y, (min_y + max_y) / 2, 200);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void moving_the_origin_moves_no_particle(void **state) {
    (void)state;
    // 2 m in each substep, every operation exact in binary: the world position has to be exact, too, through all
    // moves of the origin.
    mspring_builder *builder = support_builder();
    for (int i = 0; i < 40; i++) {
        mspring_particle_def particle;
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
        particle.x = 0.125 * i;
        particle.y = -0.0625 * i;
        particle.vx = 256;
        particle.vy = 128;
        check_ok(mspring_builder_add_particles(builder, &particle, 1, NULL));
    }
    mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    mspring_view view = {.struct_size = sizeof view};
    uint32_t moves = 0;
    double last = 0;
    for (int step = 1; step <= 5000; step++) {
        check_ok(mspring_network_step(network, 1.0 / 128));
        for (mspring_id id = 0; id < 40; id++) {
            support_point p = support_position(network, id);
            assert_true(p.x == 0.125 * id + 2.0 * step && p.y == -0.0625 * id + 1.0 * step);
        }
        check_ok(mspring_network_get_view(network, &view));
        moves += view.origin_x != last;
        last = view.origin_x;
    }
    assert_true(moves > 5);
    mspring_network_destroy(network);
}

/// Two particles that fly past the origin, the second one faster.
static mspring_network *two_in_flight(void) {
    mspring_builder *builder = support_builder();
    for (int i = 0; i < 2; i++) {
        mspring_particle_def particle;
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
        particle.x = particle.y = i == 0 ? 40 : -40;
        particle.vx = particle.vy = i == 0 ? 64 : 96;
        check_ok(mspring_builder_add_particles(builder, &particle, 1, NULL));
    }
    mspring_network_def def = support_def(0, 1);
    return support_network(builder, &def);
}

static void a_snapshot_brings_its_origin(void **state) {
    (void)state;
    // From step 48 to 176 the network is let go 128 m from its origin, as it was on both sides of it when it had
    // gone 64, and from 93 on it could follow: whoever did not know of the 128 would. In step 176 it does.
    static const int saved_after[] = {100, 200};
    for (size_t i = 0; i < COUNT_OF(saved_after); i++) {
        mspring_network *network = two_in_flight(), *loaded = two_in_flight();
        support_steps(network, (uint32_t)saved_after[i], 1.0 / 128);
        support_bring(network, loaded, MSPRING_SNAPSHOT_FRAME);
        mspring_view here = {.struct_size = sizeof here}, there = {.struct_size = sizeof there};
        for (int step = 0; step < 100; step++) {
            check_ok(mspring_network_get_view(network, &here));
            check_ok(mspring_network_get_view(loaded, &there));
            assert_true(here.origin_x == there.origin_x && here.origin_y == there.origin_y);
            assert_int_equal(here.origin_x > 0 && here.origin_y > 0, saved_after[i] + step >= 176);
            assert_int_equal(support_hash(network), support_hash(loaded));
            support_steps(network, 1, 1.0 / 128);
            support_steps(loaded, 1, 1.0 / 128);
        }
        mspring_network_destroy(network);
        mspring_network_destroy(loaded);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(far_away_is_as_here),           cmocka_unit_test(at_any_offset_it_stays_as_still),
        cmocka_unit_test(a_flying_ship_keeps_its_shape), cmocka_unit_test(moving_the_origin_moves_no_particle),
        cmocka_unit_test(a_snapshot_brings_its_origin),
    };
    return cmocka_run_group_tests_name("origin", tests, NULL, NULL);
}

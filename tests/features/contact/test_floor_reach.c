/// @file test_floor_reach.c
/// A floor that is out of reach takes another way through the step. A hook before each step forces the usual way: a
/// twin that has one goes through the same states.
///
/// SPDX-License-Identifier: MIT
#include "recipe.h"
#include "snapshots.h"
#include "support.h"

static void do_nothing(const mspring_hook_args *args, void *user) {
    (void)args;
    (void)user;
}

/// A network and its twin.
typedef struct twins {
    mspring_network *of[2];
    uint32_t particles;
} twins;

static void lay_floor(mspring_network *network, double bottom) {
    const float heights[6] = {0, 3, -2, 1, 5, 0};
    const double planes[8] = {-2e4, 0, 1, 0, 0, bottom - 2, 0.1, 1};
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.planes = planes;
    def.plane_count = 2;
    def.heights = heights;
    def.height_count = COUNT_OF(heights);
    def.heights_x = -20;
    def.heights_y = bottom;
    def.spacing = 8;
    def.friction = 0.4f;
    def.restitution = 0.5f;
    check_ok(mspring_network_set_floor(network, &def));
}

static twins make_twins(const recipe *made, mspring_network_def def, double bottom) {
    twins both = {.particles = made->particle_count};
    for (uint32_t i = 0; i < 2; i++) {
        uint32_t hook;
        def.worker_count = 1 + i;
        both.of[i] = recipe_network(made, &def);
        lay_floor(both.of[i], bottom);
        if (i == 1) {
            check_ok(support_add_hook(both.of[i], MSPRING_PHASE_BEFORE_STEP, do_nothing, NULL, &hook));
        }
    }
    return both;
}

static void destroy(const twins *both) {
    mspring_network_destroy(both->of[0]);
    mspring_network_destroy(both->of[1]);
}

/// What the floor has done to them in the last step is the same, too. Returns whether that was anything.
static bool check_same(const twins *both) {
    float x[2], y[2];
    bool any = false;
    assert_int_equal(support_hash(both->of[0]), support_hash(both->of[1]));
    for (mspring_id p = 0; p < both->particles; p++) {
        for (uint32_t i = 0; i < 2; i++) {
            check_ok(mspring_network_get_columns(both->of[i], NULL, p, 1, (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, &x[i]}, {MSPRING_FLOOR_IMPULSE_Y, 1, &y[i]}}, 2));
        }
        assert_true(x[0] == x[1] && y[0] == y[1]);
        any |= x[0] != 0 || y[0] != 0;
    }
    return any;
}

/// Something of what a host may do between steps.
static void disturb(const twins *both, uint64_t *seed) {
    const mspring_id one = (mspring_id)(support_random(seed) % both->particles);
    const float speed = (float)support_random_between(seed, -300, 300);
    const uint32_t what = (uint32_t)(support_random(seed) % 16);
    for (uint32_t i = 0; i < 2; i++) {
        mspring_network *network = both->of[i];
        if (what == 0) {
            check_ok(mspring_network_set_velocities(network, NULL, one, 1, &speed, &speed, 1));
        } else if (what == 1) {
            check_ok(mspring_network_apply_force(network, one, 0, 20 * speed));
        } else if (what == 2) {
            const support_point v = support_velocity(network, one);
            support_set_velocity(network, one, (float)v.x, (float)v.y - 0.1f);
        } else if (what == 3) {
            const support_point at = support_position(network, one);
            const double x = at.x, y = at.y - 0.3;
            check_ok(mspring_network_set_positions(network, NULL, one, 1, &x, &y, 1));
        }
    }
}

static void falls_the_same_way(void **state) {
    (void)state;
    uint32_t touched = 0;
    for (uint64_t seed = 1; seed <= 12; seed++) {
        uint64_t draws = seed;
        recipe made = recipe_mixed(seed);
        mspring_network_def def = support_def(-9.8f, seed % 3 == 0 ? 1 : 4);
        def.settings.global_damping = seed % 2 == 0 ? 0.1f : 0;
        def.settings.guard = MSPRING_GUARD_BOUNDS;
        def.spare_particles = seed % 5 == 0 ? 40 : 0;
        const twins both = make_twins(&made, def, seed % 4 == 0 ? -300 : -40);
        for (uint32_t step = 0; step < 500; step++) {
            if (seed > 4) {
                disturb(&both, &draws);
            }
            support_steps(both.of[0], 1, 1.0 / 64);
            support_steps(both.of[1], 1, 1.0 / 64);
            touched += check_same(&both);
        }
        destroy(&both);
        recipe_free(&made);
    }
    assert_true(touched > 100);
}

/// Springs that are far too short throw what was at rest into a floor which, by its speed, was out of reach.
static void is_taken_again_if_it_was_not_out_of_reach(void **state) {
    (void)state;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1000, 1000}};
    uint64_t seed = 5;
    uint32_t touched = 0;
    recipe made = {0};
    recipe_lattice(&made, 20, 6, 0, 0, 1, &stuff, &seed);
    mspring_network_def def = support_def(-0.1f, 256);
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    const twins both = make_twins(&made, def, -16);
    for (uint32_t step = 0; step < 8; step++) {
        const float longer = 12;
        for (uint32_t i = 0; i < 2; i++) {
            if (step == 3) {
                check_ok(mspring_network_set(both.of[i], MSPRING_REST_LENGTH, NULL, 0, made.spring_count, &longer, 0));
            }
            support_steps(both.of[i], 1, 1);
        }
        touched += check_same(&both);
    }
    assert_true(touched > 0);
    destroy(&both);
    recipe_free(&made);
}

/// The floor stays where it is in the world when the local origin moves along.
static void is_met_after_a_long_fall(void **state) {
    (void)state;
    const double level[4] = {0, -1000, 0, 1};
    mspring_builder *builder = support_builder();
    const mspring_id a = support_particle(builder, 0, 0, 1), b = support_particle(builder, 1, 0, 1);
    support_spring(builder, a, b, 100, 0);
    const mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = support_network(builder, &def);
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = level;
    floor.plane_count = 1;
    check_ok(mspring_network_set_floor(network, &floor));
    support_steps(network, 64 * 20, 1.0 / 64);
    check_near(support_position(network, a).y, -1000, 1e-4);
    check_near(support_position(network, b).y, -1000, 1e-4);
    mspring_network_destroy(network);
}

/// A bar of springs that yield, thrown over the ground.
static mspring_network *flung_bar(uint64_t *seed, uint32_t workers) {
    enum { WIDTH = 12, HEIGHT = 4 };
    static const uint16_t cells[WIDTH * HEIGHT];
    mspring_builder *builder = support_builder();
    mspring_material material;
    mspring_lattice_def lattice;
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &lattice, sizeof lattice));
    material.stiffness = 2000, material.yield_strain = 0.05f;
    lattice.width = WIDTH, lattice.height = HEIGHT, lattice.y = support_random_between(seed, 0.5, 3);
    lattice.cells = cells, lattice.materials = &material, lattice.material_count = 1;
    check_ok(mspring_builder_add_lattice(builder, &lattice, NULL));
    mspring_network_def def = support_def(-9.8f, 8);
    def.worker_count = workers;
    mspring_network *network = support_network(builder, &def);
    for (mspring_id p = 0; p < WIDTH * HEIGHT; p++) {
        const float vx = (float)support_random_between(seed, -9, 9),
                    vy = (float)support_random_between(seed, -9, 9);
        check_ok(mspring_network_set_velocities(network, NULL, p, 1, &vx, &vy, 1));
    }
    const double ground[4] = {0, 0, 0, 1};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = ground, floor.plane_count = 1;
    check_ok(mspring_network_set_floor(network, &floor));
    return network;
}

/// A step that meets the floor unforeseen is begun anew, and what has yielded in it with it: two workers, who look
/// before they let springs yield, come to the same bits, and so does what is loaded before each step.
static void a_step_begun_anew_takes_flow_back(void **state) {
    (void)state;
    uint64_t seed = 11;
    for (int scene = 0; scene < 40; scene++) {
        uint64_t again = seed, once_more = seed;
        mspring_network *one = flung_bar(&seed, 1), *two = flung_bar(&again, 2), *loaded = flung_bar(&once_more, 1);
        for (int step = 0; step < 40; step++) {
            support_bring(one, loaded, MSPRING_SNAPSHOT_ALL);
            support_steps(one, 1, 1.0 / 60);
            support_steps(two, 1, 1.0 / 60);
            support_steps(loaded, 1, 1.0 / 60);
            assert_true(support_hash(one) == support_hash(two));
            assert_true(support_hash(one) == support_hash(loaded));
        }
        mspring_network_destroy(one);
        mspring_network_destroy(two);
        mspring_network_destroy(loaded);
    }
}

/// Particles without springs, and two with one, that fly far above the ground; a grip holds one that is pinned.
static mspring_network *make_flight(double bottom, bool has_grip) {
    const double ground[4] = {0, bottom, 0, 1};
    mspring_builder *builder = support_builder();
    const mspring_id a = support_particle(builder, 0, 0, 1), b = support_particle(builder, 1, 0, 1);
    const mspring_id pinned = support_pinned(builder, 5, 5, 1);
    support_spring(builder, a, b, 1000, 0);
    for (int i = 0; i < 20; i++) {
        support_particle(builder, 2 + 0.37 * i, 3 + 0.11 * i, 1);
    }
    mspring_network_def def = support_def(-0.3f, 12);
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    mspring_network *network = support_network(builder, &def);
    for (mspring_id p = pinned + 1; p < pinned + 21; p++) {
        support_kick(network, p, 0.3f + 0.07f * (float)p);
    }
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = ground, floor.plane_count = 1;
    check_ok(mspring_network_set_floor(network, &floor));
    if (has_grip) {
        mspring_grip_def grip;
        check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &grip, sizeof grip));
        grip.particle = pinned, grip.x = 6, grip.y = 5, grip.stiffness = 10;
        check_ok(mspring_network_add_grip(network, &grip, NULL));
    }
    return network;
}

/// What is loaded into a network that has not seen the floor yet flies on by the same bits: whether the step before
/// was near the floor is not in a snapshot, and must not tell.
static void what_is_loaded_flies_the_same_way(void **state) {
    (void)state;
    for (int has_grip = 0; has_grip < 2; has_grip++) {
        mspring_network *one = make_flight(-1e4, has_grip);
        for (int step = 0; step < 12; step++) {
            mspring_network *fresh = make_flight(-1e4, has_grip);
            support_bring(one, fresh, MSPRING_SNAPSHOT_ALL);
            support_steps(one, 1, 1.0 / 60);
            support_steps(fresh, 1, 1.0 / 60);
            assert_true(support_hash(one) == support_hash(fresh));
            mspring_network_destroy(fresh);
        }
        mspring_network_destroy(one);
    }
}

/// Where a body that passes below a ridge comes to. has_other: another one lies at the foot of a higher hill.
static support_point pass_ridge(bool has_other) {
    const float heights[] = {0, 0, 1, 0, 0, 0, 0, 9, 0, 0};
    recipe made = {0};
    mspring_floor_def floor;
    for (uint32_t i = 0; i < 2; i++) { // they rise from the foot of the ridge to above its top, 1 m wide
        recipe_particle(&made, -0.7 + 0.1 * i, 0.5, 1, 0);
        made.particles[i].vx = 60;
        made.particles[i].vy = 36;
    }
    recipe_spring(&made, 0, 1, 1e3, 0, 0);
    for (uint32_t i = 0; has_other && i < 2; i++) {
        recipe_particle(&made, 3.5 + 0.1 * i, 0.1, 1, 0);
    }
    if (has_other) {
        recipe_spring(&made, 2, 3, 1e3, 0, 0);
    }
    const mspring_network_def def = support_def(0, 1);
    mspring_network *network = recipe_network(&made, &def);
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.heights = heights;
    floor.height_count = COUNT_OF(heights);
    floor.heights_x = -2;
    floor.spacing = 1;
    check_ok(mspring_network_set_floor(network, &floor));
    mspring_network *clone; // has memory of its own
    check_ok(mspring_network_clone(network, NULL, &clone));
    support_steps(network, 1, 1.0 / 60);
    const support_point end = support_position(network, 0);
    mspring_network_destroy(network);
    support_steps(clone, 1, 1.0 / 60);
    assert_true(support_position(clone, 0).x == end.x && support_position(clone, 0).y == end.y);
    mspring_network_destroy(clone);
    recipe_free(&made);
    return end;
}

/// A body meets a ridge whatever else is in the network, and so in the same strip.
static void a_ridge_is_met_beside_any_other_body(void **state) {
    (void)state;
    const support_point alone = pass_ridge(false), beside = pass_ridge(true);
    assert_true(alone.x == beside.x && alone.y == beside.y);
    assert_true(alone.x < 0.25); // 0.3 m without the ridge
}

/// Impulse of the floor on a light particle that a spring pushes into it and pulls out again.
static double impulse_of_dip(double seconds, uint32_t steps, uint32_t substeps) {
    const double plane[] = {0, 0, 0, 1};
    recipe made = {0};
    mspring_floor_def floor;
    recipe_particle(&made, 0, 0.5, 1, 0);
    recipe_particle(&made, 0, 0.55, 1000, 0);
    recipe_spring(&made, 0, 1, 1e4, 0, 0);
    made.springs[0].rest_length = 1;
    const mspring_network_def def = support_def(-9.8f, substeps);
    mspring_network *network = recipe_network(&made, &def);
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = plane;
    floor.plane_count = 1;
    check_ok(mspring_network_set_floor(network, &floor));
    double sum = 0;
    for (uint32_t step = 0; step < steps; step++) {
        float x, y;
        support_steps(network, 1, seconds / steps);
        check_ok(mspring_network_get_columns(network, NULL, 0, 1, (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, &x}, {MSPRING_FLOOR_IMPULSE_Y, 1, &y}}, 2));
        sum += (double)y;
    }
    mspring_network_destroy(network);
    recipe_free(&made);
    return sum;
}

/// At rest before a step of about a period of the spring, and above the floor before and after it. The end speed
/// tells that the particle was faster than the survey assumed, in a step of 16 substeps even after one period: they
/// make periods 0.6 % longer.
static void what_dips_within_a_step_is_met(void **state) {
    (void)state;
    const double period = 6.283185307 / 100;
    for (int i = 0; i <= 6; i++) {
        const double seconds = (0.88 + 0.04 * i) * period, expected = impulse_of_dip(seconds, 16, 1);
        assert_true(expected > 100);
        // Steps round 1/16 of a step otherwise.
        check_near(impulse_of_dip(seconds, 1, 16), expected, 1e-3 * expected);
    }
}

static void count_call(const mspring_hook_args *args, void *user) {
    (void)args;
    ++*(uint32_t *)user;
}

/// The survey knows the forces of the step, with and without sleep: nothing that they move is met by surprise.
static void forces_of_the_host_are_surveyed(void **state) {
    (void)state;
    for (int sleeps = 0; sleeps < 2; sleeps++) {
        enum { SIDE = 24, SUBSTEPS = 16 };
        static float push[SIDE * SIDE], none[SIDE * SIDE];
        const double plane[4] = {0, 0, 0, 1};
        const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1e5, 1e5}, .damping = {10, 10}};
        uint32_t calls = 0, hook;
        uint64_t seed = 1;
        recipe made = {0};
        recipe_lattice(&made, SIDE, SIDE, 0, 1, 1, &stuff, &seed);
        mspring_network_def def = support_def(0, SUBSTEPS);
        def.settings.sleep_speed = sleeps ? 1e-12f : 0.0f;
        mspring_network *network = recipe_network(&made, &def);
        recipe_free(&made);
        mspring_floor_def floor;
        check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
        floor.planes = plane;
        floor.plane_count = 1;
        check_ok(mspring_network_set_floor(network, &floor));
        check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_SUBSTEP, count_call, &calls, &hook));
        for (int step = 0; step < 20; step++) { // up and down again
            for (int i = 0; i < SIDE * SIDE; i++) {
                push[i] = step % 4 == 0 || step % 4 == 3 ? 300.0f : -300.0f;
            }
            calls = 0;
            check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, SIDE * SIDE, none, push, 1));
            check_ok(mspring_network_step(network, 1.0 / 60));
            assert_int_equal(calls, SUBSTEPS);
        }
        mspring_network_destroy(network);
    }
}

// What a step that is taken again returns to has been kept for slots with particles only. Forces are summed up where
// it is kept.
static void empty_slots_stay_empty(void **state) {
    (void)state;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {100, 100}};
    uint64_t seed = 1;
    recipe made = {0};
    recipe_lattice(&made, 3, 3, 0, 2, 1, &stuff, &seed);
    mspring_network_def def = support_def(0, 4);
    def.spare_particles = 1;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    lay_floor(network, 0);
    const float x = 1, y = -1e4f;
    check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, 0, MSPRING_ALL, &x, &y, 0));
    support_steps(network, 1, 0.1);
    mspring_view view = mspring_view_default();
    check_ok(mspring_network_get_view(network, &view));
    for (uint32_t slot = 0; slot < view.slot_count; slot++)
        assert_true(view.particle_of_slot[slot] != MSPRING_NONE || (view.vx[slot] == 0 && view.vy[slot] == 0));
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_step_begun_anew_takes_flow_back),
        cmocka_unit_test(falls_the_same_way),
        cmocka_unit_test(is_taken_again_if_it_was_not_out_of_reach),
        cmocka_unit_test(is_met_after_a_long_fall),
        cmocka_unit_test(forces_of_the_host_are_surveyed),
        cmocka_unit_test(what_is_loaded_flies_the_same_way),
        cmocka_unit_test(what_dips_within_a_step_is_met),
        cmocka_unit_test(a_ridge_is_met_beside_any_other_body),
        cmocka_unit_test(empty_slots_stay_empty),
    };
    return cmocka_run_group_tests_name("floor_reach", tests, NULL, NULL);
}

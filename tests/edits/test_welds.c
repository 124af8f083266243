/// @file test_welds.c
/// Springs of rest length 0, which weld two particles: they hold them together, as stiff in all directions, in all
/// solvers, also where both are in the same place; their strain is in metres.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "recipe.h"
#include "snapshots.h"
#include "support.h"

#define DT (1.0 / 64)

static const mspring_solver solvers[] = {MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT};

static void use_solver(mspring_network *network, mspring_solver solver, mspring_integrator integrator,
                       uint32_t substeps) {
    mspring_settings def;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def));
    def.solver = solver;
    def.integrator = integrator;
    def.substeps = substeps;
    check_ok(support_set_solver(network, &def));
}

static mspring_id weld(mspring_builder *builder, mspring_id a, mspring_id b, float stiffness) {
    mspring_spring_def def;
    mspring_id id;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = a;
    def.b = b;
    def.stiffness = stiffness;
    def.rest_length = 0;
    check_ok(mspring_builder_add_springs(builder, &def, 1, &id));
    return id;
}

static float value_of(const mspring_network *network, mspring_property property, mspring_id spring) {
    float value;
    check_ok(mspring_network_get(network, property, NULL, spring, 1, &value, 1));
    return value;
}

static void join_cells(mspring_builder *builder, const mspring_id *ids, uint32_t width) {
    for (uint32_t x = 0; x < width; x++) {
        (void)support_spring(builder, ids[2 * x], ids[2 * x + 1], 1e5f, 50);
        if (x + 1 == width)
            break;
        (void)support_spring(builder, ids[2 * x], ids[2 * x + 2], 1e5f, 50);
        (void)support_spring(builder, ids[2 * x + 1], ids[2 * x + 3], 1e5f, 50);
        (void)support_spring(builder, ids[2 * x], ids[2 * x + 3], 1e5f, 50);
        (void)support_spring(builder, ids[2 * x + 1], ids[2 * x + 2], 1e5f, 50);
    }
}

/// Two bars of 8 cells: the second hangs at the last particle of the first, or at one of its own that is welded to
/// it.
static mspring_network *swing(bool is_welded, mspring_id *end) {
    enum { WIDTH = 9 };
    mspring_builder *builder = support_builder();
    mspring_id first[2 * WIDTH], second[2 * WIDTH];
    for (uint32_t x = 0; x < WIDTH; x++) {
        first[2 * x] = x == 0 ? support_pinned(builder, 0, 0, 1)
                              : support_particle(builder, x, 0, x == WIDTH - 1 && !is_welded ? 2 : 1);
        first[2 * x + 1] = support_particle(builder, x, 1, 1);
    }
    for (uint32_t x = 0; x < WIDTH; x++) {
        const bool is_joint = x == 0 && !is_welded;
        second[2 * x] = is_joint ? first[2 * WIDTH - 2] : support_particle(builder, WIDTH - 1 + (double)x, 0, 1);
        second[2 * x + 1] = support_particle(builder, WIDTH - 1 + (double)x, -1, 1);
    }
    join_cells(builder, first, WIDTH);
    join_cells(builder, second, WIDTH);
    if (is_welded)
        (void)weld(builder, first[2 * WIDTH - 2], second[0], 1e5f);
    *end = second[2 * WIDTH - 1];
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.guard = MSPRING_GUARD_GROWTH;
    return support_network(builder, &def);
}

static void welded_bars_swing_as_one(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_id end, merged_end;
        mspring_network *network = swing(true, &end), *merged = swing(false, &merged_end);
        use_solver(network, solvers[i], MSPRING_INTEGRATOR_ALPHA, solvers[i] == MSPRING_SOLVER_EXPLICIT ? 40 : 8);
        use_solver(merged, solvers[i], MSPRING_INTEGRATOR_ALPHA, solvers[i] == MSPRING_SOLVER_EXPLICIT ? 40 : 8);
        for (int step = 0; step < 64; step++) {
            support_steps(network, 1, DT);
            support_steps(merged, 1, DT);
            const support_point here = support_position(network, end), there = support_position(merged, merged_end);
            check_near(here.x, there.x, 0.16); // 1 % of the whole
            check_near(here.y, there.y, 0.16);
            assert_true(value_of(network, MSPRING_LENGTH, mspring_network_count(network, MSPRING_SPRINGS) - 1) < 0.02f);
        }
        mspring_network_destroy(network);
        mspring_network_destroy(merged);
    }
}

/// h^2 2 k / m = 4, whether the ends are apart or not.
static void border_is_the_closed_form(void **state) {
    (void)state;
    for (int apart = 0; apart < 2; apart++) {
        mspring_builder *builder = support_builder();
        (void)weld(builder, support_particle(builder, 0, 0, 3),
                   support_particle(builder, apart * 0.3, apart * 0.4, 3), 1200);
        const mspring_network_def def = support_def(0, 1);
        mspring_network *network = support_network(builder, &def);
        double now, any;
        check_ok(mspring_network_get_stable_dt(network, &now, &any));
        check_near(now, sqrt(2.0 * 3 / 1200), 1e-4 * now);
        check_near(any, sqrt(2.0 * 3 / 1200), 1e-4 * any);
        mspring_network_destroy(network);
    }
}

/// At length 0 a weld resists in all directions as its stiffness says: one substep of implicit Euler that pulls its
/// ends apart from there. In a chain, and among irregular springs.
static void weld_is_as_stiff_in_all_directions(void **state) {
    (void)state;
    const float stiffness = 1e6f;
    for (size_t i = 1; i < COUNT_OF(solvers); i++) {
        for (int is_star = 0; is_star < 2; is_star++) {
            for (int direction = 0; direction < 8; direction++) {
                mspring_builder *builder = support_builder();
                const mspring_id a = support_particle(builder, 0, 0, 1), b = support_particle(builder, 0, 0, 1);
                (void)weld(builder, a, b, stiffness);
                for (int arm = 0; is_star && arm < 3; arm++) // of no weight
                    (void)support_spring(builder, a, support_particle(builder, arm - 5, 4, 1), 1e-9f, 0);
                const mspring_network_def def = support_def(0, 1);
                mspring_network *network = support_network(builder, &def);
                use_solver(network, solvers[i], MSPRING_INTEGRATOR_EULER, 1);
                const double angle = 0.3 + 0.785 * direction, h = 1.0 / 64;
                const float x = (float)(100 * cos(angle)), y = (float)(100 * sin(angle));
                check_ok(mspring_network_apply_force(network, a, x, y));
                check_ok(mspring_network_apply_force(network, b, -x, -y));
                support_steps(network, 1, h);
                const support_point at_a = support_position(network, a), at_b = support_position(network, b);
                const double length = 2 * 100 * h * h / (1 + 2 * (double)stiffness * h * h);
                check_near(at_a.x - at_b.x, length * cos(angle), 0.02 * length);
                check_near(at_a.y - at_b.y, length * sin(angle), 0.02 * length);
                mspring_network_destroy(network);
            }
        }
    }
}

/// Two particles in the same place exert nothing, and stay finite whatever happens to one of them.
static void same_place_is_no_singularity(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_builder *builder = support_builder();
        const mspring_id a = support_particle(builder, 5, 5, 1), b = support_particle(builder, 5, 5, 2);
        const mspring_id joint = weld(builder, a, b, 1e4f);
        (void)support_spring(builder, b, support_particle(builder, 6, 5, 1), 1e4f, 10);
        mspring_network_def def = support_def(-9.8f, 1);
        def.settings.guard = MSPRING_GUARD_GROWTH;
        mspring_network *network = support_network(builder, &def);
        use_solver(network, solvers[i], MSPRING_INTEGRATOR_ALPHA, solvers[i] == MSPRING_SOLVER_EXPLICIT ? 20 : 1);
        assert_true(value_of(network, MSPRING_TENSION, joint) == 0);
        assert_true(value_of(network, MSPRING_STRAIN, joint) == 0);
        support_steps(network, 10, DT);
        assert_true(value_of(network, MSPRING_LENGTH, joint) < 1e-4f);
        support_kick(network, a, 5);
        for (int step = 0; step < 200; step++) {
            support_steps(network, 1, DT);
            assert_true(value_of(network, MSPRING_LENGTH, joint) < 0.1f);
        }
        mspring_network_destroy(network);
    }
}

/// The strain of a weld is its length in metres.
static void weld_breaks_by_metres(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id a = support_pinned(builder, 0, 0, 1), b = support_pinned(builder, 0.03, 0.04, 1);
    const mspring_id joint = weld(builder, a, b, 100);
    const mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    const float limits[] = {0.1f, 0.04f};
    check_ok(mspring_network_reserve_events(network, 8));
    check_near((double)value_of(network, MSPRING_STRAIN, joint), 0.05, 1e-7);
    check_near((double)value_of(network, MSPRING_TENSION, joint), 5, 1e-4);
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, joint, 1, &limits[0], 1));
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, joint, 1, &limits[1], 1));
    float strain;
    mspring_id spring;
    check_ok(support_get_max_strain(network, &strain, &spring));
    check_near((double)strain, 0.05, 1e-7);
    const struct {
        double x;
        int32_t kind; // -1: nothing happens
    } places[] = {
        {0.05, MSPRING_EVENT_STRESSED}, {0.099, -1}, {0.01, MSPRING_EVENT_RELAXED}, {0.101, MSPRING_EVENT_BROKEN}};
    for (size_t i = 0; i < COUNT_OF(places); i++) {
        const double y = 0;
        mspring_event events[4];
        uint32_t count;
        check_ok(mspring_network_set_positions(network, NULL, b, 1, &places[i].x, &y, 1));
        support_steps(network, 1, DT);
        check_ok(mspring_network_read_events(network, events, 4, &count, NULL));
        assert_int_equal(count, places[i].kind >= 0);
        if (count > 0) {
            assert_int_equal(events[0].kind, places[i].kind);
            check_near((double)events[0].strain, places[i].x, 1e-6);
        }
    }
    // Restored at once: it has no ramp.
    check_ok(mspring_network_restore_springs(network, &joint, 0, 1, 0.5));
    assert_true(value_of(network, MSPRING_REST_LENGTH, joint) == 0);
    mspring_network_destroy(network);
}

/* --------------------------------------------------------------------------------------- as the host sees it */

static mspring_network *make(mspring_solver solver, mspring_simd level, uint32_t workers, uint32_t spare) {
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {2e4, 2e4}, .damping = {10, 10}};
    uint64_t seed = 1;
    recipe made = {0};
    recipe_lattice(&made, 120, 4, 0, 0, 1, &stuff, &seed);
    const mspring_id last = made.particle_count - 1, next = recipe_lattice(&made, 60, 4, 119, 3, 1, &stuff, &seed);
    recipe_particle(&made, 119, 20, 2, 0);
    recipe_rope(&made, last, made.particle_count - 1, 12, &stuff, &seed);
    recipe_spring(&made, last, next, 2e4, 10, 0);
    mspring_spring_def *springs = made.springs;
    springs[made.spring_count - 1].rest_length = 0;
    springs[made.spring_count - 4].rest_length = 0; // in the rope
    springs[7].rest_length = 0;                     // in the lattice
    mspring_network_def def = support_def(-9.8f, 1);
    def.simd_level = level;
    def.worker_count = workers;
    def.spare_particles = def.spare_springs = spare;
    def.settings.guard = MSPRING_GUARD_GROWTH;
    mspring_network *network = recipe_network(&made, &def);
    use_solver(network, solver, MSPRING_INTEGRATOR_ALPHA, solver == MSPRING_SOLVER_EXPLICIT ? 20 : 2);
    recipe_free(&made);
    return network;
}

static void bits_are_the_same(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        uint64_t expected = 0;
        for (uint32_t l = 0; l < count; l++) {
            for (uint32_t workers = 1; workers <= 2; workers++) {
                mspring_network *network = make(solvers[i], levels[l], workers, 0);
                support_steps(network, 20, DT);
                const uint64_t hash = support_hash(network);
                assert_true(expected == 0 || hash == expected);
                expected = hash;
                mspring_network_destroy(network);
            }
        }
    }
}

static void snapshots_have_welds(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *network = make(solvers[i], MSPRING_SIMD_AUTO, 1, 0),
                        *other = make(solvers[i], MSPRING_SIMD_AUTO, 1, 0);
        const float whole[] = {1, 0};
        const mspring_id last = mspring_network_count(network, MSPRING_SPRINGS) - 1;
        check_ok(mspring_network_set(other, MSPRING_REST_LENGTH, NULL, last, 1, &whole[0], 1));
        check_ok(mspring_network_set(other, MSPRING_REST_LENGTH, NULL, 7, 1, &whole[0], 1));
        check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 20, 1, &whole[1], 1));
        support_steps(network, 5, DT);
        support_bring(network, other, MSPRING_SNAPSHOT_ALL);
        for (mspring_id s = 0; s <= last; s++)
            assert_true(value_of(network, MSPRING_REST_LENGTH, s) == value_of(other, MSPRING_REST_LENGTH, s));
        assert_true(value_of(other, MSPRING_REST_LENGTH, 7) == 0);
        assert_true(value_of(other, MSPRING_REST_LENGTH, 20) == 0);
        assert_true(value_of(other, MSPRING_REST_LENGTH, last) == 0);
        support_steps(network, 5, DT);
        support_steps(other, 5, DT);
        assert_int_equal(support_hash(network), support_hash(other));
        mspring_network_destroy(network);
        mspring_network_destroy(other);
    }
}

static void rest_length_is_read_as_given(void **state) {
    (void)state;
    mspring_network *network = make(MSPRING_SOLVER_EXPLICIT, MSPRING_SIMD_AUTO, 1, 4);
    const mspring_id first = 0, last = mspring_network_count(network, MSPRING_SPRINGS) - 1;
    const float one = 1, zero = 0, minus = -0.0f, wrong[] = {-1, NAN, INFINITY, 5e12f};
    support_spring_info info;
    check_ok(support_get_spring(network, last, &info));
    assert_true(info.rest_length == 0 && info.strain == info.length);
    // Here and back, in a lattice and elsewhere.
    for (mspring_id s = 0; s <= last; s += last) {
        check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, s, 1, &one, 1));
        assert_true(value_of(network, MSPRING_REST_LENGTH, s) == 1);
        check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, s, 1, &minus, 1));
        assert_true(value_of(network, MSPRING_REST_LENGTH, s) == 0);
        check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, s, 1, &zero, 1));
        check_near((double)value_of(network, MSPRING_STRAIN, s), (double)value_of(network, MSPRING_LENGTH, s), 0);
        for (size_t i = 0; i < COUNT_OF(wrong); i++)
            check_error(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, s, 1, &wrong[i], 1),
                        MSPRING_ERROR_ARGUMENT);
    }
    check_contains(mspring_network_error(network), "0 to 4e12");
    // All of a kind in one measurement.
    float strains[2];
    const mspring_id both[] = {first, last};
    check_ok(mspring_network_get(network, MSPRING_STRAIN, both, 0, 2, strains, 1));
    assert_true(strains[0] == value_of(network, MSPRING_LENGTH, first));
    // The largest is found among them.
    float most = 0, strain;
    mspring_id where = 0, found;
    check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 50, 1, &zero, 1));
    for (mspring_id s = 0; s <= last; s++) {
        const float of_spring = fabsf(value_of(network, MSPRING_STRAIN, s));
        where = of_spring > most ? s : where;
        most = of_spring > most ? of_spring : most;
    }
    check_ok(support_get_max_strain(network, &strain, &found));
    assert_true(strain == most && found == where);
    check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 0, 51, &one, 0)); // no more of it
    // Added later, and in a builder again.
    mspring_particle_def particle;
    mspring_spring_def spring;
    mspring_id added, joint;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
    const support_point at = support_position(network, 3);
    particle.x = at.x;
    particle.y = at.y;
    check_ok(mspring_network_add_particles(network, &particle, 1, &added));
    spring.a = 3;
    spring.b = added;
    spring.stiffness = 2e4f;
    check_error(mspring_network_add_springs(network, &spring, 1, &joint), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "weld");
    spring.rest_length = 0;
    check_ok(mspring_network_add_springs(network, &spring, 1, &joint));
    assert_true(value_of(network, MSPRING_REST_LENGTH, joint) == 0);
    mspring_builder *builder = support_builder();
    check_ok(mspring_builder_add_network(builder, network, NULL, 0, MSPRING_ALL, NULL, NULL));
    const mspring_network_def def = support_def(-9.8f, 20);
    mspring_network *again = support_network(builder, &def);
    assert_true(value_of(again, MSPRING_REST_LENGTH, mspring_network_count(again, MSPRING_SPRINGS) - 1) == 0);
    support_steps(network, 20, DT);
    const support_point one_end = support_position(network, 3), other_end = support_position(network, added);
    assert_true(hypot(one_end.x - other_end.x, one_end.y - other_end.y) < 0.05);
    mspring_network_destroy(again);
    mspring_network_destroy(network);
}

/// A body that is welded to a pin comes to rest below it.
static void settled_weld_hangs(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id pin = support_pinned(builder, 0, 0, 1), p = support_particle(builder, 0, 0, 10);
    (void)weld(builder, pin, p, 1e4f);
    (void)support_spring(builder, p, support_particle(builder, 1, 0, 5), 1e5f, 0);
    const mspring_network_def def = support_def(-9.8f, 20);
    mspring_network *network = support_network(builder, &def);
    check_ok(mspring_network_settle(network, NULL, NULL));
    const support_point at = support_position(network, p);
    check_near(at.x, 0, 1e-6);
    check_near(at.y, -15 * 9.8 / 1e4, 1e-6);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(welded_bars_swing_as_one),
        cmocka_unit_test(border_is_the_closed_form),
        cmocka_unit_test(weld_is_as_stiff_in_all_directions),
        cmocka_unit_test(same_place_is_no_singularity),
        cmocka_unit_test(weld_breaks_by_metres),
        cmocka_unit_test(bits_are_the_same),
        cmocka_unit_test(snapshots_have_welds),
        cmocka_unit_test(rest_length_is_read_as_given),
        cmocka_unit_test(settled_weld_hangs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

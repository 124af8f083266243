/// @file test_sleepers.c
/// Sleepers where it is close: at the border of stability, with the direct solver, among many loose particles, all
/// around a single spring.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>
#include <stdlib.h>

#include "recipe.h"
#include "snapshots.h"
#include "support.h"

#define DT (1.0 / 64)

enum { COLUMNS = 20, ROWS = 4, IN_A = 12, IN_B = COLUMNS * ROWS + 12, SUBSTEPS = 8, LOOSE = 16384 };

/// How a network is stepped.
typedef struct way {
    mspring_simd level;
    uint32_t workers;
    mspring_solver solver;
    uint32_t substeps;
} way;

static const way as_usual = {MSPRING_SIMD_AUTO, 1, MSPRING_SOLVER_EXPLICIT, SUBSTEPS};

static mspring_network *make(recipe *made, const way *how) {
    mspring_network_def def = support_def(0, how->substeps);
    def.simd_level = how->level;
    def.worker_count = how->workers;
    def.settings.solver = how->solver;
    def.settings.global_damping = 6;
    def.settings.sleep_speed = 0.02f;
    def.settings.sleep_time = 0.25f;
    mspring_network *network = recipe_network(made, &def);
    recipe_free(made);
    return network;
}

/// Two lattices of equal masses, one firmer than the other, at rest.
static mspring_network *make_two(double firmness_of_a, const way *how) {
    uint64_t seed = 3;
    const recipe_stuff a = {.mass = {1, 1}, .stiffness = {firmness_of_a, firmness_of_a}, .damping = {1, 1}};
    const recipe_stuff b = {.mass = {1, 1}, .stiffness = {1000, 1000}, .damping = {1, 1}};
    recipe made = {0};
    recipe_lattice(&made, COLUMNS, ROWS, 0, 0, 1, &a, &seed);
    recipe_lattice(&made, COLUMNS, ROWS, 30, 0, 1, &b, &seed);
    return make(&made, how);
}

/* ------------------------------------------------------------------------------------- the border of stability */

/// What a lattice of mass 1 bears in a substep of DT / SUBSTEPS, N/m: mass / (2 h^2).
static const double border = 0.5 * SUBSTEPS * SUBSTEPS / (DT * DT);

/// What sleeps counts as if it were awake, so that nothing that wakes makes a step too long: one that it could not
/// take is refused, and it sleeps on.
static void what_sleeps_counts(void **state) {
    (void)state;
    mspring_network *network = make_two(0.8 * border, &as_usual);
    support_fall_asleep(network, DT);
    support_kick(network, IN_B, 1);
    support_steps(network, 5, DT);
    const uint64_t before = support_hash(network);
    check_error(mspring_network_step(network, 2 * DT), MSPRING_ERROR_UNSTABLE); // 3.2 times what A bears
    assert_int_equal(support_hash(network), before);
    assert_int_equal(support_sleeps(network, IN_A), 1);
    assert_int_equal(support_sleeps(network, IN_B), 0);
    support_steps(network, 5, DT);
    assert_int_equal(support_sleeps(network, IN_A), 1);
    mspring_network_destroy(network);
}

/// Both have A's particles in the same places.
static void check_places_of_a(const mspring_network *network, const mspring_network *other) {
    for (mspring_id p = 0; p < COLUMNS * ROWS; p++) {
        check_near(support_position(network, p).x, support_position(other, p).x, 0);
        check_near(support_position(network, p).y, support_position(other, p).y, 0);
    }
}

/// Whether a step is refused until A is at rest again, while B sleeps. A copy in which nothing does goes through
/// the same, and is refused at the same step.
static bool is_refused(double firmness) {
    mspring_network *network = make_two(firmness, &as_usual), *awake = NULL;
    mspring_result result = MSPRING_OK;
    support_steps(network, 128, DT / 2); // shorter ones, which A bears however firm it is here
    assert_int_equal(support_is_asleep(network), 1);
    check_ok(mspring_network_clone(network, NULL, &awake));
    support_kick(network, IN_A, 0.1f);
    support_kick(awake, IN_A, 0.1f);
    for (int step = 0; result == MSPRING_OK && (step == 0 || !support_sleeps(network, IN_A)); step++) {
        assert_true(step < 200);
        assert_int_equal(support_sleeps(network, IN_B), 1);
        check_ok(mspring_network_wake(awake));
        result = mspring_network_step(network, DT);
        assert_int_equal(mspring_network_step(awake, DT), result);
        check_places_of_a(network, awake);
    }
    mspring_network_destroy(network);
    mspring_network_destroy(awake);
    return result != MSPRING_OK;
}

static void the_border_is_where_it_is_when_nothing_sleeps(void **state) {
    (void)state;
    uint32_t refused = 0, crossings = 0;
    bool was = false;
    for (int tenths = 8; tenths <= 20; tenths++) {
        const bool now = is_refused(0.1 * tenths * border);
        refused += now;
        crossings += now != was;
        was = now;
    }
    // A full lattice's border is at 1, that of one of four rows a little above.
    assert_int_equal(crossings, 1);
    assert_in_range(refused, 1, 10);
}

/* ------------------------------------------------------------------------------------------- the direct solver */

/// Kicks, a break and a restored spring while one of two sleeps; what of it can be seen.
static uint64_t direct_session(mspring_simd level, uint32_t workers) {
    const way how = {level, workers, MSPRING_SOLVER_DIRECT, 1};
    mspring_network *network = make_two(1e5, &how);
    uint64_t print = 0;
    uint32_t apart = 0;
    const mspring_id spring = 30;
    for (uint32_t frame = 0; frame < 160; frame++) {
        if (frame % 40 == 30) {
            support_kick(network, frame % 80 == 30 ? IN_A : IN_B, 2);
        }
        if (frame == 50) {
            check_ok(mspring_network_break_springs(network, &spring, 0, 1));
        }
        if (frame == 120) {
            check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 0.1));
        }
        support_steps(network, 1, DT);
        print =
            print * 31 + support_hash(network) + support_sleeps(network, IN_A) + 2u * support_sleeps(network, IN_B);
        apart += support_sleeps(network, IN_A) != support_sleeps(network, IN_B);
    }
    assert_true(apart > 10);
    mspring_network_destroy(network);
    return print;
}

static void direct_bits_are_the_same_everywhere(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    const uint64_t expected = direct_session(MSPRING_SIMD_SCALAR, 1);
    for (uint32_t i = 0; i < level_count; i++) {
        assert_int_equal(direct_session(levels[i], 1), expected);
    }
    assert_int_equal(direct_session(MSPRING_SIMD_AUTO, 3), expected);
}

/// Saved, cloned and laid out anew with one asleep, it goes on as it would have.
static void direct_sleepers_go_on_elsewhere(void **state) {
    (void)state;
    const way how = {MSPRING_SIMD_AUTO, 1, MSPRING_SOLVER_DIRECT, 1};
    mspring_network *all[3] = {make_two(1e5, &how), make_two(1e5, &how), NULL};
    support_fall_asleep(all[0], DT);
    support_kick(all[0], IN_B, 2);
    support_steps(all[0], 3, DT);
    assert_int_equal(support_sleeps(all[0], IN_A), 1);
    size_t size;
    check_ok(mspring_network_get_snapshot_size(all[0], MSPRING_SNAPSHOT_ALL, &size));
    void *bytes = malloc(size);
    assert_non_null(bytes);
    check_ok(mspring_network_save(all[0], MSPRING_SNAPSHOT_ALL, bytes, size, NULL));
    check_ok(mspring_network_load(all[1], bytes, size));
    check_ok(mspring_network_clone(all[0], NULL, &all[2]));
    free(bytes);
    for (int frame = 0; frame < 60; frame++) {
        for (int i = 0; i < 3; i++) {
            support_steps(all[i], 1, DT);
            assert_int_equal(support_hash(all[i]), support_hash(all[0]));
            assert_int_equal(support_sleeps(all[i], IN_A), 1);
            assert_int_equal(support_sleeps(all[i], IN_B), support_sleeps(all[0], IN_B));
        }
    }
    for (int i = 0; i < 3; i++) {
        mspring_network_destroy(all[i]);
    }
}

/* --------------------------------------------------------------------------------------------- loose particles */

/// A lattice that is kept moving beside as many loose particles as a game has. They come to rest and sleep; then
/// one is pushed and moves alone.
static uint64_t loose_session(mspring_simd level, uint32_t workers, uint32_t substeps) {
    uint64_t seed = 5, print = 0;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1000, 1000}, .damping = {1, 1}};
    recipe made = {0};
    recipe_lattice(&made, COLUMNS, ROWS, 0, 0, 1, &stuff, &seed);
    const mspring_id first = made.particle_count, pushed = first + 5000;
    for (uint32_t i = 0; i < LOOSE; i++) {
        recipe_particle(&made, 30 + i % 128, i / 128, 1, 0);
    }
    recipe_disturb(&made, 0, 1, &seed);
    const way how = {level, workers, MSPRING_SOLVER_EXPLICIT, substeps};
    mspring_network *network = make(&made, &how);
    uint8_t *asleep = malloc(LOOSE);
    double *x = malloc(LOOSE * sizeof *x), *y = malloc(LOOSE * sizeof *y), *to_x = malloc(LOOSE * sizeof *x),
           *to_y = malloc(LOOSE * sizeof *y);
    assert_true(asleep && x && y && to_x && to_y);
    for (int frame = 0; frame < 90; frame++) { // from sqrt(2) m/s to 0.02 takes 46 of them
        support_kick(network, IN_A, 1);
        support_steps(network, 1, DT);
        check_ok(support_get_sleepers(network, first, LOOSE, asleep, 1));
        for (uint32_t i = 0; i < LOOSE; i++) {
            print = print * 3 + asleep[i];
        }
    }
    for (uint32_t i = 0; i < LOOSE; i++) {
        assert_int_equal(asleep[i], 1);
    }
    assert_int_equal(support_sleeps(network, IN_A), 0);
    print = print * 31 + support_hash(network);

    check_ok(mspring_network_get_positions(network, NULL, first, LOOSE, x, y, 1));
    support_kick(network, pushed, 3);
    for (int frame = 0; frame < 10; frame++) {
        support_kick(network, IN_A, 1);
        support_steps(network, 1, DT);
    }
    check_ok(support_get_sleepers(network, first, LOOSE, asleep, 1));
    check_ok(mspring_network_get_positions(network, NULL, first, LOOSE, to_x, to_y, 1));
    for (uint32_t i = 0; i < LOOSE; i++) {
        const bool is_pushed = first + i == pushed;
        assert_int_equal(asleep[i], !is_pushed);
        assert_int_equal(to_x[i] == x[i] && to_y[i] == y[i], !is_pushed);
    }
    print = print * 31 + support_hash(network);
    support_fall_asleep(network, DT);
    print = print * 31 + support_hash(network);
    mspring_network_destroy(network);
    free(asleep);
    free(x);
    free(y);
    free(to_x);
    free(to_y);
    return print;
}

static void thousands_of_loose_ones_sleep(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    const uint64_t expected = loose_session(MSPRING_SIMD_SCALAR, 1, SUBSTEPS);
    for (uint32_t i = 0; i < level_count; i++) {
        assert_int_equal(loose_session(levels[i], 1, SUBSTEPS), expected);
    }
    assert_int_equal(loose_session(MSPRING_SIMD_AUTO, 3, SUBSTEPS), expected);
}

/* ----------------------------------------------------------------------------------------------- all but one */

/// A lattice of three rows that end in blocks of their own, in which all springs but one are broken, or in which
/// none sleeps.
static mspring_network *make_wreck(const recipe *made, mspring_id whole, float sleep_speed) {
    mspring_network_def def = support_def(0, 4);
    def.settings.sleep_speed = sleep_speed;
    def.settings.sleep_time = 0;
    mspring_network *network = recipe_network(made, &def);
    for (mspring_id s = 0; s < made->spring_count; s++) {
        if (s != whole) {
            check_ok(mspring_network_break_springs(network, &s, 0, 1));
        }
    }
    support_steps(network, 1, DT);
    return network;
}

/// Whichever spring of a lattice is the only one that is awake, in a block, over its sides or over its corners: it
/// moves as if nothing slept.
static void a_spring_alone_moves_among_sleepers(void **state) {
    (void)state;
    uint64_t seed = 3;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {500, 1000}, .damping = {0, 5}};
    recipe made = {0};
    recipe_lattice(&made, 34, 3, 0, 0, 1, &stuff, &seed);
    for (mspring_id s = 0; s < made.spring_count; s++) {
        mspring_network *network = make_wreck(&made, s, 0.001f), *other = make_wreck(&made, s, 0);
        assert_int_equal(support_is_asleep(network), 1);
        support_kick(network, made.springs[s].a, 1);
        support_kick(other, made.springs[s].a, 1);
        for (int step = 0; step < 4; step++) {
            support_steps(network, 1, DT);
            support_steps(other, 1, DT);
            assert_int_equal(support_hash(network), support_hash(other));
        }
        uint8_t asleep[102];
        uint32_t sleepers = 0;
        check_ok(support_get_sleepers(network, 0, COUNT_OF(asleep), asleep, 1));
        for (size_t p = 0; p < COUNT_OF(asleep); p++) {
            sleepers += asleep[p];
        }
        assert_int_equal(sleepers, made.particle_count - 2);
        mspring_network_destroy(network);
        mspring_network_destroy(other);
    }
    recipe_free(&made);
}

/// A network of one island keeps asleep, and for how long it has been still, in another layout.
static void the_only_island_goes_on_in_another_layout(void **state) {
    (void)state;
    uint64_t seed = 3;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1000, 1000}, .damping = {1, 1}};
    recipe made = {0};
    recipe_lattice(&made, COLUMNS, ROWS, 0, 0, 1, &stuff, &seed);
    mspring_network *network = make(&made, &as_usual);
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    for (mspring_id s = 0; s < springs; s += 5) {
        check_ok(mspring_network_break_springs(network, &s, 0, 1));
    }
    uint32_t count;
    check_ok(mspring_network_update_components(network, &count, NULL));
    assert_int_equal(count, 1);
    support_steps(network, 10, DT);
    check_ok(mspring_network_compact(network));
    support_steps(network, 5, DT);
    assert_int_equal(support_is_asleep(network), 0);
    support_steps(network, 1, DT); // 0.25 s
    assert_int_equal(support_is_asleep(network), 1);
    check_ok(support_expand(network));
    assert_int_equal(support_is_asleep(network), 1);
    check_ok(mspring_network_compact(network));
    assert_int_equal(support_is_asleep(network), 1);
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------- values of now */

/// Numbers that may be set, and another one for each.
static const struct {
    mspring_property property;
    float other;
} writable[] = {
    {MSPRING_MASS, 1.5f},           {MSPRING_INVERSE_MASS_SCALE, 0.5f}, {MSPRING_FRICTION, 0.25f},
    {MSPRING_RESTITUTION, 0.25f},   {MSPRING_STIFFNESS, 900},           {MSPRING_DAMPING, 0.5f},
    {MSPRING_REST_LENGTH, 1.25f},   {MSPRING_WARN_STRAIN, 0.5f},        {MSPRING_PLASTIC_STRAIN, 0.125f},
    {MSPRING_ELEMENT_STIFFNESS, 5}, {MSPRING_PRESSURE, 2},              {MSPRING_FILL, 1.5f},
    {MSPRING_REST_AREA, 1.25f},     {MSPRING_REST_ANGLE, 0.25f},        {MSPRING_ELEMENT_DAMPING, 0.5f},
    {MSPRING_SIGNAL, 1.25f}};

/// An area, an angle, actuators and contact on what make_two() makes.
static mspring_network *make_all_kinds(void) {
    const mspring_id corners[] = {0, 1, COLUMNS + 1, COLUMNS}, arms[] = {5, 6, 7}, actuated[] = {3, 9};
    mspring_network *network = make_two(1000, &as_usual);
    mspring_area_def area = mspring_area_def_default();
    mspring_angle_def angle = mspring_angle_def_default();
    mspring_contact_def contact = mspring_contact_def_default();
    area.stiffness = 10;
    angle.stiffness = 1;
    contact.thickness = 0.1;
    check_ok(mspring_network_add_area(network, &area, corners, 4, NULL));
    check_ok(mspring_network_add_angles(network, &angle, arms, 1, 3, NULL));
    check_ok(mspring_network_set_actuators(network, actuated, 2, 1));
    check_ok(mspring_network_set_contact(network, &contact));
    support_fall_asleep(network, DT);
    return network;
}

/// What is set already wakes nothing, and is no edit to frames. Another value wakes what it is of, but for strains at
/// which a spring warns.
static void values_of_now_wake_nothing(void **state) {
    (void)state;
    mspring_network *network = make_all_kinds();
    saved frame = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
    for (size_t i = 0; i < COUNT_OF(writable); i++) {
        const mspring_property property = writable[i].property;
        const mspring_id id = property == MSPRING_REST_ANGLE || property == MSPRING_ELEMENT_DAMPING;
        float now;
        check_ok(mspring_network_get(network, property, NULL, id, 1, &now, 1));
        check_ok(mspring_network_set(network, property, NULL, id, 1, &now, 1));
        if (!support_is_asleep(network))
            print_error("property 0x%x wakes\n", (unsigned)property);
        assert_true(support_is_asleep(network));
    }
    for (int mask = 0; mask < 2; mask++) {
        uint32_t now;
        check_ok(mspring_network_get_integers(network, mask ? MSPRING_MASKS : MSPRING_LAYERS, NULL, 3, 1, &now, 1));
        check_ok(mspring_network_set_integers(network, mask ? MSPRING_MASKS : MSPRING_LAYERS, NULL, 3, 1, &now, 1));
        assert_true(support_is_asleep(network));
    }
    check_ok(mspring_network_load(network, frame.bytes, frame.size));
    free(frame.bytes);
    for (size_t i = 0; i < COUNT_OF(writable); i++) {
        const mspring_property property = writable[i].property;
        const mspring_id id = property == MSPRING_REST_ANGLE || property == MSPRING_ELEMENT_DAMPING;
        support_fall_asleep(network, DT);
        check_ok(mspring_network_set(network, property, NULL, id, 1, &writable[i].other, 1));
        if (property != MSPRING_WARN_STRAIN && support_is_asleep(network))
            print_error("property 0x%x wakes nothing\n", (unsigned)property);
        assert_true(property == MSPRING_WARN_STRAIN || !support_is_asleep(network));
        float now;
        check_ok(mspring_network_get(network, property, NULL, id, 1, &now, 1));
        check_near((double)now, (double)writable[i].other, 1e-6);
    }
    mspring_network_destroy(network);
}

/* -------------------------------------------------------------------------------------------- hooks in a step */

static void push_sleeper(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++)
        if (args->particle_of_slot[slot] == IN_A && args->substep == 0)
            args->vx[slot] = 1;
}

/// A sleeper to which a hook gives a velocity within a step stays where it is until the end of that step.
static void sleepers_stay_until_the_step_ends(void **state) {
    (void)state;
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        way how = as_usual;
        how.solver = solver;
        mspring_network *network = make_two(1000, &how);
        support_fall_asleep(network, DT);
        support_kick(network, IN_B, 1);
        check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, push_sleeper, NULL, NULL));
        const support_point before = support_position(network, IN_A), other = support_position(network, IN_B);
        support_steps(network, 1, DT);
        assert_true(support_position(network, IN_A).x == before.x);
        assert_true(support_position(network, IN_B).x > other.x);
        support_steps(network, 2, DT);
        assert_true(support_position(network, IN_A).x > before.x);
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sleepers_stay_until_the_step_ends),
        cmocka_unit_test(what_sleeps_counts),
        cmocka_unit_test(the_border_is_where_it_is_when_nothing_sleeps),
        cmocka_unit_test(direct_bits_are_the_same_everywhere),
        cmocka_unit_test(direct_sleepers_go_on_elsewhere),
        cmocka_unit_test(thousands_of_loose_ones_sleep),
        cmocka_unit_test(a_spring_alone_moves_among_sleepers),
        cmocka_unit_test(the_only_island_goes_on_in_another_layout),
        cmocka_unit_test(values_of_now_wake_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/// @file test_sleep.c
/// Networks that fall asleep, what wakes them and what does not, and that nothing else depends on it.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "allocator.h"
#include "changes.h"
#include "recipe.h"
#include "support.h"

#define DT (1.0 / 64)
#define SLEEP_SPEED 0.01f

/// A lattice that hangs on a rope from a pin, strongly damped, with relative springs or not.
static recipe hanging_recipe(uint32_t spring_flags) {
    uint64_t seed = 5;
    const bool relative = spring_flags & MSPRING_SPRING_RELATIVE;
    const recipe_stuff stuff = {.mass = {1, 2},
                                .stiffness = {relative ? 0.2 : 2000, relative ? 0.2 : 2000},
                                .damping = {relative ? 0.05 : 5, relative ? 0.05 : 5},
                                .spring_flags = spring_flags};
    recipe made = {0};
    recipe_lattice(&made, 20, 5, 0, 0, 1, &stuff, &seed);
    const mspring_id pin = recipe_particle(&made, 10, 9, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 90, pin, 4, &stuff, &seed);
    return made;
}

static mspring_network_def def_of(float sleep_speed) {
    mspring_network_def def = support_def(-9.8f, 4);
    def.settings.global_damping = 4;
    def.settings.sleep_speed = sleep_speed;
    return def;
}

static mspring_network *make(const recipe *made) {
    const mspring_network_def def = def_of(SLEEP_SPEED);
    return recipe_network(made, &def);
}

static void set_solver(mspring_network *network, mspring_solver which) {
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = which;
    solver.substeps = which == MSPRING_SOLVER_EXPLICIT ? 4 : 1;
    check_ok(support_set_solver(network, &solver));
}

static void it_sleeps_once_it_has_been_slow_for_long_enough(void **state) {
    (void)state;
    recipe made = hanging_recipe(0);
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_IMPLICIT; solver++) {
        mspring_network *network = make(&made);
        set_solver(network, solver);
        uint32_t slow_steps = 0;
        for (int i = 0; i < 6400 && !support_is_asleep(network); i++) {
            const uint32_t before = slow_steps;
            support_steps(network, 1, DT);
            bool slow = true;
            for (mspring_id p = 0; p < made.particle_count; p++) {
                const support_point v = support_velocity(network, p);
                slow = slow && fabs(v.x) <= (double)SLEEP_SPEED && fabs(v.y) <= (double)SLEEP_SPEED;
            }
            slow_steps = slow ? before + 1 : 0;
        }
        assert_int_equal(slow_steps, 32); // 0.5 s
        double kinetic;
        check_ok(support_get_energy(network, &kinetic, NULL, NULL));
        check_near(kinetic, 0, 0);
        const uint64_t hash = support_hash(network);
        support_steps(network, 100, DT);
        assert_int_equal(support_hash(network), hash);
        // Waking it undoes nothing, and it has to be still again for as long.
        check_ok(mspring_network_wake(network));
        assert_int_equal(support_is_asleep(network), 0);
        support_steps(network, 31, DT);
        assert_int_equal(support_is_asleep(network), 0);
        support_steps(network, 1, DT);
        assert_int_equal(support_is_asleep(network), 1);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

static void what_moves_does_not_sleep(void **state) {
    (void)state;
    recipe made = hanging_recipe(0);
    // Off by default.
    mspring_network_def def = def_of(0);
    mspring_network *network = recipe_network(&made, &def);
    support_steps(network, 2000, DT);
    assert_int_equal(support_is_asleep(network), 0);
    mspring_network_destroy(network);
    // A pin on its way, however slow.
    network = make(&made);
    const float slow = 1e-4f, none = 0;
    check_ok(mspring_network_set_velocities(network, NULL, 100, 1, &none, &slow, 1));
    support_steps(network, 2000, DT);
    assert_int_equal(support_is_asleep(network), 0);
    check_ok(mspring_network_set_velocities(network, NULL, 100, 1, &none, &none, 1));
    support_fall_asleep(network, DT);
    mspring_network_destroy(network);
    // What falls at the speed that gravity and damping leave it.
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    network = support_network(builder, &def);
    support_steps(network, 2000, DT);
    assert_int_equal(support_is_asleep(network), 0);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// One particle that flies freely; numbers that are exact in floats.
static mspring_network *make_flying(float sleep_time) {
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    mspring_network_def def = support_def(0, 1);
    def.settings.sleep_speed = 0.25f;
    def.settings.sleep_time = sleep_time;
    return support_network(builder, &def);
}

static void as_slow_as_sleep_speed_is_slow_enough(void **state) {
    (void)state;
    const struct {
        float vx, vy;
        uint32_t sleeps;
    } ways[] = {{0.25f, 0, 1},
                {0, 0.25f, 1},
                {-0.25f, -0.25f, 1},
                {0.25f + 0x1p-24f, 0, 0},
                {0, 0.25f + 0x1p-24f, 0},
                {-0.25f - 0x1p-24f, 0, 0},
                {0, -0.25f - 0x1p-24f, 0}};
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        mspring_network *network = make_flying(0.5f);
        check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &ways[i].vx, &ways[i].vy, 1));
        support_steps(network, 31, DT);
        assert_int_equal(support_is_asleep(network), 0);
        support_steps(network, 1, DT);
        assert_int_equal(support_is_asleep(network), ways[i].sleeps);
        mspring_network_destroy(network);
    }
}

static void without_sleep_time_the_first_still_step_is_enough(void **state) {
    (void)state;
    mspring_network *network = make_flying(0);
    const float fast = 1, slow = 0.1f, none = 0;
    check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &fast, &none, 1));
    support_steps(network, 10, DT);
    assert_int_equal(support_is_asleep(network), 0);
    check_near(support_position(network, 0).x, 10 * DT, 0);
    check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &slow, &none, 1));
    support_steps(network, 1, DT);
    assert_int_equal(support_is_asleep(network), 1);
    mspring_network_destroy(network);
}

/* -------------------------------------------------------------------------------------------------- waking */

/// Changes of the network as a whole, and of its pin.
static void let_go(mspring_network *network) {
    const float scale = 1;
    check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, 100, 1, &scale, 1));
}

static void tilt(mspring_network *network) {
    check_ok(support_set_gravity(network, 1, -9.8f));
}

static void change_solver(mspring_network *network) {
    set_solver(network, MSPRING_SOLVER_IMPLICIT);
}

static void raise_floor(mspring_network *network) {
    const double plane[4] = {0, 1, 0, 1};
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.planes = plane;
    def.plane_count = 1;
    check_ok(mspring_network_set_floor(network, &def));
}

static void settle(mspring_network *network) {
    check_ok(mspring_network_settle(network, NULL, NULL));
}

static void check_it_wakes(const recipe *made, const char *name, void (*general)(mspring_network *network),
                           change_fn particular) {
    mspring_network *network = make(made);
    support_fall_asleep(network, DT);
    const uint64_t before = support_hash(network);
    if (general) {
        general(network);
    } else {
        particular(network, 3, 50);
    }
    support_steps(network, 2, DT);
    if (support_is_asleep(network) || support_hash(network) == before) {
        print_error("%s\n", name);
        fail();
    }
    mspring_network_destroy(network);
}

static void changes_wake_it(void **state) {
    (void)state;
    static const struct {
        const char *name;
        void (*make)(mspring_network *network);
    } general[] = {
        {"let go", let_go}, {"tilt", tilt}, {"solver", change_solver}, {"floor", raise_floor}, {"settle", settle}};
    recipe made = hanging_recipe(0);
    for (size_t i = 0; i < CHANGE_COUNT; i++) {
        check_it_wakes(&made, changes[i].name, NULL, changes[i].make);
    }
    for (size_t i = 0; i < COUNT_OF(general); i++) {
        check_it_wakes(&made, general[i].name, general[i].make, NULL);
    }
    recipe_free(&made);
}

static void restoring_wakes_it_and_a_ramp_keeps_it_awake(void **state) {
    (void)state;
    recipe made = hanging_recipe(0);
    mspring_network *network = make(&made);
    change_break(network, MSPRING_NONE, 50);
    support_fall_asleep(network, DT);
    const mspring_id spring = 50;
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 5));
    support_steps(network, 4 * 64, DT);
    assert_int_equal(support_is_asleep(network), 0);
    support_fall_asleep(network, DT);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void what_stays_the_same_wakes_nothing(void **state) {
    (void)state;
    recipe made = hanging_recipe(0);
    mspring_network *network = make(&made);
    support_fall_asleep(network, DT);
    const uint64_t before = support_hash(network);
    float *mass = malloc(made.particle_count * sizeof *mass);
    assert_non_null(mass);
    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_get_view(network, &view));
    for (int i = 0; i < 20; i++) {
        const support_point at = support_position(network, 3);
        const float none = 0;
        check_ok(mspring_network_get(network, MSPRING_MASS, NULL, 0, made.particle_count, mass, 1));
        check_ok(mspring_network_set(network, MSPRING_MASS, NULL, 0, made.particle_count, mass, 1));
        check_ok(mspring_network_set_positions(network, NULL, 3, 1, &at.x, &at.y, 1));
        check_ok(mspring_network_set_velocities(network, NULL, 3, 1, &none, &none, 1));
        check_ok(support_set_gravity(network, 0, -9.8f));
        check_ok(support_set_global_damping(network, (float)i));
        // 0.005 N on at least 1 kg for 0.5 s: 0.0025 m/s.
        check_ok(mspring_network_apply_force(network, 3, 0.005f, 0));
        check_ok(mspring_network_step(network, i % 2 == 0 ? DT : 2 * DT));
        assert_int_equal(support_is_asleep(network), 1);
    }
    assert_int_equal(support_hash(network), before);
    free(mass);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void relative_springs_follow_another_substep(void **state) {
    (void)state;
    recipe made = hanging_recipe(MSPRING_SPRING_RELATIVE);
    mspring_network *network = make(&made);
    support_fall_asleep(network, DT);
    support_steps(network, 3, DT);
    assert_int_equal(support_is_asleep(network), 1);
    support_steps(network, 1, DT / 2);
    assert_int_equal(support_is_asleep(network), 0);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/* --------------------------------------------------------------------------------------------- forces, hooks */

static void forces_that_stay_let_it_sleep(void **state) {
    (void)state;
    recipe made = hanging_recipe(0);
    mspring_network *network = make(&made);
    int steps = 0;
    for (; steps < 6400 && !support_is_asleep(network); steps++) {
        check_ok(mspring_network_apply_force(network, 7, 20, 5));
        support_steps(network, 1, DT);
    }
    for (int i = 0; i < 10; i++) {
        check_ok(mspring_network_apply_force(network, 7, 20, 5));
        support_steps(network, 1, DT);
        assert_int_equal(support_is_asleep(network), 1);
    }
    support_steps(network, 1, DT); // without it
    assert_int_equal(support_is_asleep(network), 0);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// What a hook does: forces, and at the end of a substep a shift.
typedef struct doings {
    float force, shift;
    uint32_t calls;
} doings;

static void do_things(const mspring_hook_args *args, void *user) {
    doings *what = user;
    what->calls++;
    for (uint32_t slot = 0; slot < args->slot_count; slot++) {
        if (args->force_x && args->particle_of_slot[slot] == 7) {
            args->force_x[slot] += what->force;
        }
        if (!args->force_x && args->particle_of_slot[slot] == 7) {
            args->x[slot] += what->shift;
        }
    }
}

static void hooks_are_called_and_wake_it(void **state) {
    (void)state;
    recipe made = hanging_recipe(0);
    for (mspring_phase phase = MSPRING_PHASE_BEFORE_STEP; phase <= MSPRING_PHASE_AFTER_SUBSTEP; phase++) {
        mspring_network *network = make(&made);
        doings what = {.force = 5};
        check_ok(support_add_hook(network, phase, do_things, &what, NULL));
        support_fall_asleep(network, DT);
        what.calls = 0;
        support_steps(network, 3, DT);
        assert_int_equal(support_is_asleep(network), 1);
        assert_int_equal(what.calls, phase == MSPRING_PHASE_BEFORE_STEP ? 3 : 3 * 4);
        const uint64_t before = support_hash(network);
        what.force = 50;
        what.shift = 0.001f;
        support_steps(network, 1, DT);
        assert_int_equal(support_is_asleep(network), 0);
        assert_int_equal(support_sleeps(network, 7), 0); // from the end of the step on
        assert_true(support_hash(network) != before);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

static void a_step_that_goes_wrong_leaves_it_asleep(void **state) {
    (void)state;
    recipe made = hanging_recipe(0);
    mspring_network *network = make(&made);
    doings what = {.force = 5};
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, do_things, &what, NULL));
    support_fall_asleep(network, DT);
    const uint64_t before = support_hash(network);
    what.shift = NAN;
    check_error(mspring_network_step(network, DT), MSPRING_ERROR_UNSTABLE);
    assert_int_equal(support_hash(network), before);
    assert_int_equal(support_is_asleep(network), 1);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/* -------------------------------------------------------------------------------------------- the same bits */

/// Sleeps, is pushed, sleeps again, breaks, is compacted and sleeps.
static uint64_t session_hash(const recipe *made, mspring_simd level, uint32_t workers, mspring_solver solver) {
    mspring_network_def def = def_of(SLEEP_SPEED);
    def.simd_level = level;
    def.worker_count = workers;
    mspring_network *network = recipe_network(made, &def);
    set_solver(network, solver);
    support_fall_asleep(network, DT);
    check_ok(mspring_network_apply_force(network, 5, 300, 100));
    support_steps(network, 3, DT);
    support_fall_asleep(network, DT);
    change_break(network, MSPRING_NONE, 50);
    check_ok(mspring_network_compact(network));
    support_steps(network, 3, DT);
    assert_int_equal(support_is_asleep(network), 0);
    support_fall_asleep(network, DT);
    change_shift(network, 3, MSPRING_NONE);
    support_steps(network, 3, DT);
    const uint64_t hash = support_hash(network);
    mspring_network_destroy(network);
    return hash;
}

static void bits_are_the_same_everywhere(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    recipe made = hanging_recipe(0);
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_IMPLICIT; solver++) {
        const uint64_t expected = session_hash(&made, MSPRING_SIMD_SCALAR, 1, solver);
        for (uint32_t i = 0; i < level_count; i++) {
            assert_int_equal(session_hash(&made, levels[i], 1, solver), expected);
        }
        assert_int_equal(session_hash(&made, MSPRING_SIMD_AUTO, 3, solver), expected);
    }
    recipe_free(&made);
}

/* ---------------------------------------------------------------------------------------- snapshots, clones */

/// What follows is the same whether it was saved asleep, on the way there, or disturbed in its sleep.
static void snapshots_and_clones_sleep_on(void **state) {
    (void)state;
    recipe made = hanging_recipe(0);
    for (int when = 0; when < 4; when++) {
        mspring_network *network = make(&made), *other = make(&made), *clone = NULL;
        for (int i = 0; i < 6400 && !support_is_asleep(network); i++) {
            check_ok(mspring_network_apply_force(network, 7, 20, 5));
            support_steps(network, 1, DT);
        }
        if (when == 1) {
            check_ok(mspring_network_wake(network));
            check_ok(mspring_network_apply_force(network, 7, 20, 5));
            support_steps(network, 1, DT);
        } else if (when == 2) {
            change_write_view(network, 3, MSPRING_NONE);
        }
        support_bring(network, other, MSPRING_SNAPSHOT_FRAME);
        check_ok(mspring_network_clone(network, NULL, &clone));
        mspring_network *const all[] = {network, other, clone};
        uint64_t hashes[3], naps[3];
        for (int i = 0; i < 3; i++) {
            naps[i] = support_is_asleep(all[i]);
            for (int frame = 0; frame < 40; frame++) {
                check_ok(mspring_network_apply_force(all[i], 7, when == 3 && frame > 3 ? 60 : 20, 5));
                support_steps(all[i], 1, DT);
                naps[i] = naps[i] * 3 + support_is_asleep(all[i]);
            }
            hashes[i] = support_hash(all[i]);
            mspring_network_destroy(all[i]);
        }
        assert_int_equal(hashes[0], hashes[1]);
        assert_int_equal(hashes[0], hashes[2]);
        assert_int_equal(naps[0], naps[1]);
        assert_int_equal(naps[0], naps[2]);
    }
    recipe_free(&made);
}

/* ----------------------------------------------------------------------------------------------------- errors */

static void try_in_hook(const mspring_hook_args *args, void *user) {
    (void)args;
    check_error(mspring_network_wake(user), MSPRING_ERROR_BUSY);
}

static void misuse_is_refused(void **state) {
    (void)state;
    check_error(mspring_network_wake(NULL), MSPRING_ERROR_ARGUMENT);
    assert_int_equal(support_is_asleep(NULL), 0);
    const float bad[][2] = {{-1, 1}, {NAN, 1}, {INFINITY, 1}, {1, -1}, {1, NAN}, {1, 2e6f}};
    recipe made = hanging_recipe(0);
    mspring_builder *builder = recipe_builder(&made, NULL);
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        mspring_network_def def = def_of(bad[i][0]);
        mspring_network *network = NULL;
        def.settings.sleep_time = bad[i][1];
        check_error(mspring_network_create(builder, &def, &network), MSPRING_ERROR_ARGUMENT);
        check_contains(support_builder_error(builder), "sleep");
    }
    mspring_builder_destroy(builder);
    mspring_network *network = make(&made);
    check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, try_in_hook, network, NULL));
    support_steps(network, 1, DT);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void failed_allocations_leave_nothing_behind(void **state) {
    (void)state;
    recipe made = hanging_recipe(0);
    mspring_builder *builder = recipe_builder(&made, NULL);
    mspring_result result = MSPRING_ERROR_MEMORY;
    for (size_t fail_at = 1; result != MSPRING_OK; fail_at++) {
        watched_allocator watched = {.fail_at = fail_at};
        mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def def = def_of(SLEEP_SPEED);
        mspring_network *network = NULL;
        def.allocator = &allocator;
        result = mspring_network_create(builder, &def, &network);
        if (result == MSPRING_OK) {
            const size_t calls = watched.calls;
            support_fall_asleep(network, DT);
            assert_int_equal(watched.calls, calls);
            mspring_network_destroy(network);
        } else {
            check_error(result, MSPRING_ERROR_MEMORY);
        }
        check_watched_clean(&watched);
    }
    mspring_builder_destroy(builder);
    recipe_free(&made);
}

/* ---------------------------------------------------------------------------------------------------- details */

static void put_below_zero(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->particle_of_slot[slot] == 0) {
            args->x[slot] = args->y[slot] = -0.0f;
        }
    }
}

/// Beside one that moves, in the same vector, a sleeper's place stays to the bit, though a hook left it at -0,
/// which becomes 0 where 0 is added.
static void sleepers_keep_every_bit(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    support_particle(builder, 5, 3, 1);
    mspring_network_def def = support_def(0, 4);
    def.settings.sleep_speed = SLEEP_SPEED;
    mspring_network *network = support_network(builder, &def);
    mspring_view view = {.struct_size = sizeof view};
    uint32_t hook;
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, put_below_zero, NULL, &hook));
    support_fall_asleep(network, DT);
    check_ok(mspring_network_remove_hook(network, hook));
    check_ok(mspring_network_get_view(network, &view));
    const uint32_t slot = view.slot_of_particle[0];
    const float before[] = {view.x[slot], view.y[slot], view.vx[slot], view.vy[slot]};
    support_kick(network, 1, 1);
    support_steps(network, 5, DT);
    assert_true(support_sleeps(network, 0) && !support_sleeps(network, 1));
    const float after[] = {view.x[slot], view.y[slot], view.vx[slot], view.vy[slot]};
    assert_memory_equal(after, before, sizeof before);
    mspring_network_destroy(network);
}

static void another_relax_fraction_wakes_it(void **state) {
    (void)state;
    recipe made = hanging_recipe(0);
    mspring_network *network = make(&made);
    const uint32_t count = mspring_network_count(network, MSPRING_SPRINGS);
    check_ok(mspring_network_reserve_events(network, 1000));
    for (mspring_id s = 0; s < count; s++) {
        const float strain = 0.01f;
        check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, s, 1, &strain, 1));
    }
    check_ok(support_set_relax_fraction(network, 0));
    const float kick = 20;
    check_ok(mspring_network_set_velocities(network, NULL, 50, 1, &kick, &kick, 1));
    support_fall_asleep(network, DT);
    mspring_event events[1000];
    uint32_t events_read;
    check_ok(mspring_network_read_events(network, events, COUNT_OF(events), &events_read, NULL));
    // Springs that were stressed only on the way relax.
    check_ok(support_set_relax_fraction(network, 1));
    support_steps(network, 1, DT);
    check_ok(mspring_network_read_events(network, events, COUNT_OF(events), &events_read, NULL));
    assert_true(events_read > 0);
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_sleeps_once_it_has_been_slow_for_long_enough),
        cmocka_unit_test(what_moves_does_not_sleep),
        cmocka_unit_test(as_slow_as_sleep_speed_is_slow_enough),
        cmocka_unit_test(without_sleep_time_the_first_still_step_is_enough),
        cmocka_unit_test(changes_wake_it),
        cmocka_unit_test(restoring_wakes_it_and_a_ramp_keeps_it_awake),
        cmocka_unit_test(what_stays_the_same_wakes_nothing),
        cmocka_unit_test(relative_springs_follow_another_substep),
        cmocka_unit_test(forces_that_stay_let_it_sleep),
        cmocka_unit_test(hooks_are_called_and_wake_it),
        cmocka_unit_test(a_step_that_goes_wrong_leaves_it_asleep),
        cmocka_unit_test(bits_are_the_same_everywhere),
        cmocka_unit_test(snapshots_and_clones_sleep_on),
        cmocka_unit_test(misuse_is_refused),
        cmocka_unit_test(failed_allocations_leave_nothing_behind),
        cmocka_unit_test(sleepers_keep_every_bit),
        cmocka_unit_test(another_relax_fraction_wakes_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/// @file test_fallback.c
/// Steps that the implicit solver takes for the explicit one, together with everything else that a network may
/// have.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "recipe.h"
#include "support.h"

#define DT (1.0 / 64)

/* -------------------------------------------------------------------------------------------------- networks */

/// A lattice of masses of 1 kg, of springs far too stiff for explicit steps of DT, which are stable up to 2048 N/m.
static recipe stiff_block(uint32_t width, uint32_t height) {
    uint64_t seed = 5;
    const recipe_stuff stiff = {.mass = {1, 1}, .stiffness = {1e6, 1e6}, .damping = {20, 20}};
    recipe made = {0};
    recipe_lattice(&made, width, height, 0, 0, 1, &stiff, &seed);
    return made;
}

/// The same hung up at its left end and just below the border at rest: it crosses it as it falls and stretches.
static recipe hanging_bar(uint32_t width, uint32_t height) {
    uint64_t seed = 5;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1900, 1900}, .damping = {0.75, 0.75}};
    recipe made = {0};
    recipe_lattice(&made, width, height, 0, 0, 1, &stuff, &seed);
    for (uint32_t row = 0; row < height; row++) {
        made.particles[row * width].flags = MSPRING_PARTICLE_PINNED;
    }
    return made;
}

static mspring_network *make(const recipe *made, mspring_guard guard, float gravity) {
    mspring_network_def def = support_def(gravity, 1);
    def.settings.guard = guard;
    return recipe_network(made, &def);
}

static void *save(const mspring_network *network, size_t *size) {
    check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_ALL, size));
    void *snapshot = malloc(*size);
    assert_non_null(snapshot);
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, snapshot, *size, NULL));
    return snapshot;
}

static void set_all_rest_lengths(mspring_network *network, float rest_length) {
    for (mspring_id s = 0; s < mspring_network_count(network, MSPRING_SPRINGS); s++) {
        check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, s, 1, &rest_length, 1));
    }
}

static void set_floor(mspring_network *network, double y) {
    const double plane[1][4] = {{0, y, 0, 1}};
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.planes = plane[0];
    def.plane_count = 1;
    def.friction = 0.5f;
    check_ok(mspring_network_set_floor(network, &def));
}

static double lowest_of(const mspring_network *network) {
    double lowest = INFINITY;
    for (mspring_id p = 0; p < mspring_network_count(network, MSPRING_PARTICLES); p++) {
        lowest = fmin(lowest, support_position(network, p).y);
    }
    return lowest;
}

/* ------------------------------------------------------------------------------------------------- snapshots */

/// What the solver was made for is in the snapshot: the rest lengths of its making, whatever they are where it is
/// loaded.
static void snapshots_have_the_solver_as_it_was_made(void **state) {
    (void)state;
    const mspring_guard guards[] = {MSPRING_GUARD_GROWTH, MSPRING_GUARD_IMPLICIT};
    recipe made = stiff_block(24, 8), other = stiff_block(24, 8);
    for (uint32_t s = 0; s < other.spring_count; s++) {
        other.springs[s].rest_length = 3;
    }
    uint64_t seed = 9;
    recipe_disturb(&made, 0.05, 0.5, &seed);
    mspring_network *network = make(&made, MSPRING_GUARD_IMPLICIT, -9.8f);
    size_t size;
    void *snapshot = save(network, &size);
    support_steps(network, 5, DT);
    assert_int_equal(support_fallback_count(network), 5);
    const uint64_t expected = support_hash(network);
    // In one whose solver follows from edited springs, has yet to be made, or has been made for others.
    for (size_t i = 0; i < 2 * COUNT_OF(guards); i++) {
        mspring_network *twin = make(i < 2 ? &made : &other, guards[i % 2], -9.8f);
        if (i < 2) {
            set_all_rest_lengths(twin, 3);
        }
        check_ok(mspring_network_load(twin, snapshot, size));
        support_steps(twin, 5, DT);
        assert_int_equal(support_hash(twin), expected);
        size_t again;
        void *second = save(twin, &again);
        check_ok(mspring_network_load(network, second, again));
        assert_int_equal(support_hash(network), expected);
        free(second);
        mspring_network_destroy(twin);
    }
    free(snapshot);
    mspring_network_destroy(network);
    recipe_free(&made);
    recipe_free(&other);
}

/* ---------------------------------------------------------------------------------------------- combinations */

/// It falls onto the floor, lies there, falls asleep, and is woken.
static void it_lies_on_a_floor_and_sleeps(void **state) {
    (void)state;
    recipe made = stiff_block(24, 8);
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.guard = MSPRING_GUARD_IMPLICIT;
    def.settings.sleep_speed = 0.05f;
    mspring_network *network = recipe_network(&made, &def);
    set_floor(network, -1);
    uint32_t step = 0;
    double most = 0;
    for (; step < 2000 && !support_is_asleep(network); step++) {
        check_ok(mspring_network_step(network, DT));
        double kinetic = 0, elastic = 0;
        check_ok(support_get_energy(network, &kinetic, &elastic, NULL));
        most = fmax(most, kinetic + elastic);
        assert_true(lowest_of(network) > -1 - 1e-4); // some last places of 24 m
    }
    assert_true(support_is_asleep(network));
    assert_int_equal(support_fallback_count(network), step);
    // What it fell through is all the energy that there can be.
    assert_true(most < 1.001 * made.particle_count * 9.8);
    float x[192], y[192];
    double sum = 0;
    assert_int_equal(made.particle_count, COUNT_OF(y));
    check_ok(mspring_network_wake(network));
    support_steps(network, 1, DT);
    check_ok(mspring_network_get_columns(network, NULL, 0, COUNT_OF(y), (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, x}, {MSPRING_FLOOR_IMPULSE_Y, 1, y}}, 2));
    for (size_t i = 0; i < COUNT_OF(y); i++) {
        sum += (double)y[i];
    }
    check_near(sum, made.particle_count * 9.8 * DT, 0.2 * made.particle_count * 9.8 * DT); // it still swings a bit
    // A step that nobody can take leaves it as it is.
    for (step = 0; step < 2000 && !support_is_asleep(network); step++) {
        check_ok(mspring_network_step(network, DT));
    }
    assert_true(support_is_asleep(network));
    const uint64_t count = support_fallback_count(network), hash = support_hash(network);
    check_error(mspring_network_step(network, -1), MSPRING_ERROR_ARGUMENT);
    support_steps(network, 40, DT);
    assert_int_equal(support_fallback_count(network), count);
    assert_int_equal(support_hash(network), hash);
    mspring_network_destroy(network);
    recipe_free(&made);
}

typedef struct pusher {
    uint32_t calls;
    float force;
} pusher;

static void push(const mspring_hook_args *args, void *user) {
    pusher *p = user;
    p->calls++;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->inverse_mass[slot] > 0) {
            args->force_x[slot] += p->force;
        }
    }
}

/// Hooks are called for the substeps that are taken, and what they and the host push acts once.
static void forces_act_once(void **state) {
    (void)state;
    recipe made = stiff_block(24, 8);
    const mspring_phase phases[] = {MSPRING_PHASE_BEFORE_STEP, MSPRING_PHASE_BEFORE_SUBSTEP};
    for (size_t i = 0; i < COUNT_OF(phases); i++) {
        mspring_network *network = make(&made, MSPRING_GUARD_IMPLICIT, 0);
        mspring_settings solver;
        check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
        solver.substeps = 3; // explicit ones
        check_ok(support_set_solver(network, &solver));
        pusher one = {.force = 0.5f};
        check_ok(support_add_hook(network, phases[i], push, &one, NULL));
        const uint32_t steps = 40;
        for (uint32_t step = 0; step < steps; step++) {
            for (mspring_id p = 0; p < made.particle_count; p++) {
                check_ok(mspring_network_apply_force(network, p, 0.25f, 0));
            }
            check_ok(mspring_network_step(network, DT));
        }
        assert_int_equal(support_fallback_count(network), steps);
        assert_int_equal(one.calls, steps); // what is refused beforehand calls none
        double px = 0, py = 0;
        check_ok(support_get_momentum(network, &px, &py, NULL));
        const double expected = 0.75 * made.particle_count * steps * DT;
        check_near(px, expected, 1e-4 * expected); // of single precision, in steps of one
        check_near(py, 0, 1e-4 * expected);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

/// Every spring that breaks is told once, whoever took the step.
static void events_are_told_once(void **state) {
    (void)state;
    recipe made = hanging_bar(80, 5);
    mspring_network *network = make(&made, MSPRING_GUARD_IMPLICIT, -9.8f);
    check_ok(mspring_network_reserve_events(network, 4096));
    const float strain = 0.3f;
    for (mspring_id s = 0; s < made.spring_count; s++) {
        check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, s, 1, &strain, 1));
    }
    uint8_t *told = calloc(made.spring_count, 1);
    assert_non_null(told);
    uint32_t broken = 0;
    for (uint32_t step = 0; step < 300; step++) {
        check_ok(mspring_network_step(network, DT));
        mspring_event events[256];
        uint32_t count;
        do {
            check_ok(mspring_network_read_events(network, events, COUNT_OF(events), &count, NULL));
            for (uint32_t i = 0; i < count; i++) {
                assert_int_equal(events[i].kind, MSPRING_EVENT_BROKEN);
                assert_int_equal(told[events[i].id]++, 0);
                broken++;
            }
        } while (count > 0);
    }
    assert_true(broken > 5);
    const uint64_t fallen_back = support_fallback_count(network);
    assert_true(fallen_back > 0);
    assert_true(fallen_back < 300);
    for (mspring_id s = 0; s < made.spring_count; s++) {
        support_spring_info info;
        check_ok(support_get_spring(network, s, &info));
        assert_int_equal((info.flags & MSPRING_SPRING_BROKEN) != 0, told[s]);
    }
    free(told);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/* -------------------------------------------------------------------------------------------- all at once */

static void nudge(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->inverse_mass[slot] > 0 && args->vy[slot] < -40) {
            args->vy[slot] = -40;
        }
    }
}

/// A bar that breaks as it falls onto the floor, with everything, compacted and expanded on the way. Returns the
/// state's hash, with the events' in it.
static uint64_t play(mspring_simd level, uint32_t workers, uint64_t *fallen_back, bool pauses) {
    recipe made = hanging_bar(80, 5);
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.guard = MSPRING_GUARD_IMPLICIT;
    def.simd_level = level;
    def.worker_count = workers;
    def.settings.sleep_speed = 0.05f;
    def.settings.global_damping = 0.05f;
    mspring_network *network = recipe_network(&made, &def);
    set_floor(network, -30);
    check_ok(mspring_network_reserve_events(network, 4096));
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, nudge, NULL, NULL));
    const float strain = 0.3f;
    for (mspring_id s = 0; s < made.spring_count; s++) {
        check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, s, 1, &strain, 1));
    }
    uint64_t hash = 0;
    for (uint32_t step = 0; step < 400; step++) {
        check_ok(mspring_network_step(network, DT));
        assert_true(lowest_of(network) > -30 - 1e-3); // some last places of 80 m
        mspring_event events[256];
        uint32_t count;
        check_ok(mspring_network_read_events(network, events, COUNT_OF(events), &count, NULL));
        for (uint32_t i = 0; i < count; i++) {
            hash = hash * 31 + events[i].id;
        }
        if (step == 150) {
            check_ok(mspring_network_compact(network));
        }
        if (step == 250) {
            check_ok(support_expand(network));
        }
        if (pauses && (step == 50 || step == 151 || step == 300)) {
            size_t size;
            void *snapshot = save(network, &size);
            const mspring_result result = mspring_network_step(network, DT);
            check_ok(result);
            check_ok(mspring_network_load(network, snapshot, size));
            free(snapshot);
        }
    }
    *fallen_back = support_fallback_count(network);
    hash ^= support_hash(network);
    mspring_network_destroy(network);
    recipe_free(&made);
    return hash;
}

static void all_at_once_has_the_same_bits(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    uint64_t fallen_back = 0, again = 0;
    const uint64_t expected = play(MSPRING_SIMD_SCALAR, 1, &fallen_back, false);
    print_message("%u of 400 steps taken by the implicit solver\n", (unsigned)fallen_back);
    assert_true(fallen_back > 10);
    assert_true(fallen_back < 390);
    for (uint32_t i = 1; i < count; i++) {
        assert_true(play(levels[i], i % 2 + 1, &again, false) == expected);
        assert_true(again == fallen_back);
    }
    // Snapshots on the way, each of which a step is tried and taken back from.
    assert_true(play(MSPRING_SIMD_AUTO, 2, &again, true) == expected);
}

/// A step that is too long, and the 15 after it, though explicit substeps would do for those; then explicit ones again.
static void fifteen_steps_follow(void **state) {
    (void)state;
    const mspring_guard guards[] = {MSPRING_GUARD_IMPLICIT, MSPRING_GUARD_CLAMP};
    recipe made = stiff_block(4, 4);
    for (size_t i = 0; i < COUNT_OF(guards); i++) {
        mspring_network *network = make(&made, guards[i], -9.8f);
        for (uint32_t step = 0; step < 40; step++) {
            check_ok(mspring_network_step(network, step == 0 ? DT : 1e-6));
            assert_int_equal(support_fallback_count(network), step < 16 ? step + 1 : 16);
        }
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fifteen_steps_follow),
        cmocka_unit_test(snapshots_have_the_solver_as_it_was_made),
        cmocka_unit_test(it_lies_on_a_floor_and_sleeps),
        cmocka_unit_test(forces_act_once),
        cmocka_unit_test(events_are_told_once),
        cmocka_unit_test(all_at_once_has_the_same_bits),
    };
    return cmocka_run_group_tests_name("fallback", tests, NULL, NULL);
}

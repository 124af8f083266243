/// @file test_grip_calls.c
/// Grips as the host handles them: calls that are refused, sleep, removal, clones, snapshots and other layouts; the
/// same bits at all levels, with any number of workers.
///
/// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "recipe.h"
#include "snapshots.h"
#include "support.h"

#define DT (1.0 / 64)

static const mspring_solver solvers[] = {MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT};

static mspring_grip_def grip_of(mspring_id particle, double x, double y) {
    mspring_grip_def def;
    check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &def, sizeof def));
    def.particle = particle;
    def.x = x;
    def.y = y;
    def.stiffness = 4000;
    def.damping = 300;
    return def;
}

static bool exists(const mspring_network *network, mspring_id grip) {
    mspring_grip_def def = {.struct_size = sizeof def};
    return mspring_network_get_grip(network, grip, &def) == MSPRING_OK;
}

// Set a grip, or add the one that has this id.
static void use(mspring_network *network, mspring_id grip, const mspring_grip_def *def) {
    mspring_id added = grip;
    if (exists(network, grip))
        check_ok(mspring_network_set_grip(network, grip, def));
    else
        check_ok(mspring_network_add_grip(network, def, &added));
    assert_int_equal(added, grip);
}

static void hold(mspring_network *network, mspring_id grip, mspring_id particle, double x, double y) {
    const mspring_grip_def def = grip_of(particle, x, y);
    use(network, grip, &def);
}

static mspring_grip_def read(const mspring_network *network, mspring_id grip) {
    mspring_grip_def def = {.struct_size = sizeof def};
    check_ok(mspring_network_get_grip(network, grip, &def));
    return def;
}

typedef struct making {
    mspring_solver solver;
    mspring_simd level;
    uint32_t workers, width, spare;
    float sleep_speed;
} making;

static mspring_network *make(making how) {
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {2e4, 2e4}, .damping = {20, 20}};
    uint64_t seed = 1;
    recipe made = {0};
    recipe_lattice(&made, how.width > 0 ? how.width : 20, 4, 0, 0, 1, &stuff, &seed);
    const mspring_id last = made.particle_count - 1;
    recipe_particle(&made, -10, 20, 2, 0);
    recipe_rope(&made, last, last + 1, 12, &stuff, &seed);
    recipe_particle(&made, -20, 20, 2, 0);
    mspring_network_def def = support_def(0, 1);
    def.simd_level = how.level;
    def.worker_count = how.workers > 0 ? how.workers : 1;
    def.settings.sleep_speed = how.sleep_speed;
    def.settings.sleep_time = 0.2f;
    def.spare_particles = def.spare_springs = how.spare;
    def.settings.global_damping = how.sleep_speed > 0 ? 2.0f : 0.0f;
    mspring_network *network = recipe_network(&made, &def);
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = how.solver;
    solver.substeps = how.solver == MSPRING_SOLVER_EXPLICIT ? 20 : 2;
    solver.coarse_period = how.solver == MSPRING_SOLVER_IMPLICIT ? 3 : 0;
    check_ok(support_set_solver(network, &solver));
    recipe_free(&made);
    return network;
}

// The hand is another grip every time it takes hold; grips 1 and 2 stay.
static mspring_id hand_of(uint32_t frame) {
    return frame < 16 ? 0 : 2 + frame / 16;
}

// A hand that does a bit of everything, as a function of the frame's number alone.
static void run_frame(mspring_network *network, uint32_t frame) {
    const mspring_id hand = hand_of(frame);
    const mspring_id loose = mspring_network_count(network, MSPRING_PARTICLES) - 1;
    switch (frame % 16) {
    case 1:
        hold(network, hand, 3, 4, 5);
        break;
    case 3: {
        mspring_grip_def bounded = grip_of(40, 10, -4);
        bounded.max_force = 200;
        use(network, 1, &bounded);
        hold(network, 2, loose, -22, 19);
        break;
    }
    case 12:
        check_ok(mspring_network_remove_grip(network, hand));
        break;
    default:
        if (exists(network, hand))
            check_ok(mspring_network_move_grip(network, hand, 4 + 0.2 * frame, 5 - 0.1 * frame));
    }
    support_steps(network, 1, DT);
}

/* ---------------------------------------------------------------------------------------------------------- bits
 */

static void bits_are_the_same(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        uint64_t expected[24] = {0};
        for (uint32_t l = 0; l < count; l++) {
            for (uint32_t workers = 1; workers <= 3; workers++) {
                mspring_network *network =
                    make((making){.solver = solvers[i], .level = levels[l], .workers = workers, .width = 400});
                for (uint32_t frame = 0; frame < COUNT_OF(expected); frame++) {
                    run_frame(network, frame);
                    const uint64_t hash = support_hash(network);
                    assert_true(expected[frame] == 0 || expected[frame] == hash);
                    expected[frame] = hash;
                }
                mspring_network_destroy(network);
            }
        }
    }
}

/// What was held and let go, before any step, is as if it never had been.
static void without_grips_nothing_changes(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *network = make((making){.solver = solvers[i]}),
                        *other = make((making){.solver = solvers[i]});
        hold(network, 0, 7, 1, 1);
        const size_t used = support_memory_used(network);
        hold(network, 1, 8, 1, 1);
        assert_int_equal(support_memory_used(network), used); // only the first allocates
        for (mspring_id grip = 0; grip < 2; grip++) {
            check_ok(mspring_network_remove_grip(network, grip));
            check_error(mspring_network_remove_grip(network, grip), MSPRING_ERROR_ID);
        }
        support_kick(network, 3, 2);
        support_kick(other, 3, 2);
        support_steps(network, 20, DT);
        support_steps(other, 20, DT);
        assert_int_equal(support_hash(network), support_hash(other));
        mspring_network_destroy(network);
        mspring_network_destroy(other);
    }
}

/* ----------------------------------------------------------------------------------------------------- snapshots
 */

static void snapshots_go_on_with_the_same_bits(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        for (int contents = MSPRING_SNAPSHOT_ALL; contents <= MSPRING_SNAPSHOT_FRAME; contents++) {
            mspring_network *network = make((making){.solver = solvers[i], .sleep_speed = 0.01f});
            mspring_network *other = make((making){.solver = solvers[i], .sleep_speed = 0.01f});
            for (uint32_t frame = 0; frame < 40; frame++) {
                run_frame(network, frame);
                if (frame % 5 != 4)
                    continue;
                // With a target that is on its way.
                if (exists(network, hand_of(frame)))
                    check_ok(mspring_network_move_grip(network, hand_of(frame), 2, 3));
                saved kept = snapshots_save(network, (mspring_snapshot_contents)contents);
                snapshots_load(other, &kept);
                for (mspring_id grip = 0; grip < 10; grip++) {
                    double impulse[4];
                    assert_int_equal(exists(network, grip), exists(other, grip));
                    if (!exists(network, grip))
                        continue;
                    const mspring_grip_def here = read(network, grip), there = read(other, grip);
                    assert_memory_equal(&here, &there, sizeof here);
                    check_ok(mspring_network_get_grip_impulse(network, grip, &impulse[0], &impulse[1]));
                    check_ok(mspring_network_get_grip_impulse(other, grip, &impulse[2], &impulse[3]));
                    assert_memory_equal(impulse, impulse + 2, 2 * sizeof impulse[0]);
                }
                mspring_network *clone;
                check_ok(mspring_network_clone(network, NULL, &clone));
                for (uint32_t next = frame + 1; next < frame + 8; next++) {
                    run_frame(network, next);
                    run_frame(other, next);
                    run_frame(clone, next);
                    assert_int_equal(support_hash(network), support_hash(other));
                    assert_int_equal(support_hash(network), support_hash(clone));
                }
                mspring_network_destroy(clone);
                snapshots_load(network, &kept);
                free(kept.bytes);
            }
            mspring_network_destroy(network);
            mspring_network_destroy(other);
        }
    }
}

/// One without grips, as of before there were any, lets all go.
static void snapshot_without_grips_lets_go(void **state) {
    (void)state;
    mspring_network *network = make((making){0});
    saved kept = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    hold(network, 0, 3, 4, 5);
    support_steps(network, 3, DT);
    snapshots_load(network, &kept);
    assert_false(exists(network, 0));
    support_steps(network, 3, DT);
    const uint64_t after = support_hash(network);
    snapshots_load(network, &kept);
    support_steps(network, 3, DT);
    assert_int_equal(support_hash(network), after);
    hold(network, 0, 3, 4, 5); // ids are those of the snapshot, too
    free(kept.bytes);
    mspring_network_destroy(network);
}

static void forged_grips_are_refused(void **state) {
    (void)state;
    mspring_network *network = make((making){0});
    hold(network, 0, 3, 4, 5);
    hold(network, 1, 6, 4, 5);
    support_steps(network, 2, DT);
    saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    uint64_t size;
    const size_t at = (size_t)(snapshots_section_of(&good, "grip", &size) - good.bytes);
    assert_int_equal(size, 8 + 2 * 72);
    const struct {
        size_t at;
        uint32_t word;
        const char *part;
    } words[] = {{0, 1, "grip 1 comes"},
                 {4, 1, "has 2 grips"},
                 {8, 1, "grip 1 comes"},
                 {8, 16, "grip 16 comes"},
                 {80, 0, "grip 0 comes"},
                 {12, 100000, "particle 100000"},
                 {12, MSPRING_NONE, "particle"},
                 {16, 0x7fc00000, "stiffness nan"},
                 {20, 0xbf800000, "damping -1"},
                 {24, 0x7f800000, "max_force"},
                 {28, 1, "holds"}};
    for (size_t i = 0; i < COUNT_OF(words); i++) {
        saved bad = snapshots_copy(&good);
        snapshots_put_word(bad.bytes + at + words[i].at, words[i].word);
        snapshots_check_refused(network, &bad, words[i].part);
        free(bad.bytes);
    }
    const double numbers[] = {NAN, INFINITY, 1e13};
    for (size_t offset = 32; offset < 80; offset += 8) {
        for (size_t i = 0; i < (offset < 64 ? COUNT_OF(numbers) : 2); i++) {
            saved bad = snapshots_copy(&good);
            snapshots_put_double(bad.bytes + at + offset, numbers[i]);
            snapshots_check_refused(network, &bad, "grip 0 pulls");
            free(bad.bytes);
        }
    }
    free(good.bytes);
    mspring_network_destroy(network);
}

/* --------------------------------------------------------------------------------------------------------- edits
 */

static void sleeper_wakes(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *network = make((making){.solver = solvers[i], .sleep_speed = 0.02f});
        const mspring_id loose = mspring_network_count(network, MSPRING_PARTICLES) - 1;
        support_fall_asleep(network, DT);
        hold(network, 0, 3, 3, 0.5);
        assert_false(support_sleeps(network, 3));
        assert_true(support_sleeps(network, loose)); // its island alone
        support_steps(network, 3, DT);
        check_near(support_position(network, loose).x, -20, 0);
        assert_true(support_position(network, 3).y > 1e-3);
        // It rests at the target, and sleeps there.
        support_fall_asleep(network, DT);
        const support_point slept = support_position(network, 3);
        check_near(slept.y, 0.5, 0.05);
        support_steps(network, 50, DT);
        assert_true(support_position(network, 3).y == slept.y);
        check_ok(mspring_network_move_grip(network, 0, 3, 0.5)); // where it is
        assert_true(support_sleeps(network, 3));
        check_ok(mspring_network_move_grip(network, 0, 3, 1.5));
        assert_false(support_sleeps(network, 3));
        support_fall_asleep(network, DT);
        check_near(support_position(network, 3).y, 1.5, 0.05);
        check_ok(mspring_network_remove_grip(network, 0));
        assert_false(support_sleeps(network, 3));
        mspring_network_destroy(network);
    }
}

/// A kick wakes what sleeps at its target only in the step, and the grip acts in that step.
static void woken_sleeper_is_held_in_the_same_step(void **state) {
    (void)state;
    mspring_network *network = make((making){.sleep_speed = 0.02f}), *awake = NULL;
    hold(network, 0, 3, 3, 0.5);
    support_fall_asleep(network, DT);
    check_ok(mspring_network_clone(network, NULL, &awake));
    check_ok(mspring_network_wake(awake));
    check_ok(mspring_network_apply_force(network, 10, 500, 0));
    check_ok(mspring_network_apply_force(awake, 10, 500, 0));
    support_steps(network, 1, DT);
    support_steps(awake, 1, DT);
    for (mspring_id p = 0; p < 20; p++) {
        const support_point here = support_position(network, p), there = support_position(awake, p);
        check_near(here.x, there.x, 1e-9);
        check_near(here.y, there.y, 1e-9);
    }
    double x, y, other_x, other_y;
    check_ok(mspring_network_get_grip_impulse(network, 0, &x, &y));
    check_ok(mspring_network_get_grip_impulse(awake, 0, &other_x, &other_y));
    assert_true(fabs(x) > 1e-6);
    check_near(x, other_x, 1e-6);
    mspring_network_destroy(network);
    mspring_network_destroy(awake);
}

static void removed_particle_takes_its_grip_along(void **state) {
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        mspring_network *network = make((making){.solver = solvers[i], .spare = 3});
        mspring_particle_def def;
        mspring_id added;
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def));
        def.x = -30;
        check_ok(mspring_network_add_particles(network, &def, 1, &added));
        hold(network, 0, added, -31, 0);
        hold(network, 1, 3, 3, 1);
        support_steps(network, 5, DT);
        assert_true(support_position(network, added).x < -30.001);
        check_ok(mspring_network_remove_particles(network, &added, 0, 1));
        assert_int_equal(read(network, 1).particle, 3);
        check_error(mspring_network_move_grip(network, 0, 0, 0), MSPRING_ERROR_ID);
        const mspring_grip_def gone = grip_of(added, 0, 0);
        check_error(mspring_network_set_grip(network, 1, &gone), MSPRING_ERROR_ID);
        check_error(mspring_network_add_grip(network, &gone, NULL), MSPRING_ERROR_ID);
        // The id is another particle's, which nothing holds.
        check_ok(mspring_network_reuse_ids(network));
        check_ok(mspring_network_add_particles(network, &def, 1, &added));
        support_steps(network, 5, DT);
        check_near(support_position(network, added).x, -30, 0);
        mspring_network_destroy(network);
    }
}

static void pinned_particle_feels_nothing(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *network = make((making){.solver = solvers[i]}),
                        *other = make((making){.solver = solvers[i]});
        const float pinned = 0, whole = 1;
        double x, y;
        check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, 3, 1, &pinned, 1));
        check_ok(mspring_network_set(other, MSPRING_INVERSE_MASS_SCALE, NULL, 3, 1, &pinned, 1));
        hold(network, 0, 3, 8, 8);
        support_steps(network, 5, DT);
        support_steps(other, 5, DT);
        assert_int_equal(support_hash(network), support_hash(other));
        mspring_network_destroy(other);
        check_ok(mspring_network_get_grip_impulse(network, 0, &x, &y));
        assert_true(x == 0 && y == 0);
        check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, 3, 1, &whole, 1));
        support_steps(network, 5, DT);
        assert_true(support_position(network, 3).y > 0.01);
        mspring_network_destroy(network);
    }
}

/// Another layout holds the same particles.
static void compaction_keeps_grips(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(solvers); i++) {
        mspring_network *network = make((making){.solver = solvers[i]}),
                        *other = make((making){.solver = solvers[i]});
        for (mspring_id s = 0; s < 60; s++) {
            check_ok(mspring_network_break_springs(network, &s, 0, 1));
            check_ok(mspring_network_break_springs(other, &s, 0, 1));
        }
        hold(network, 0, 50, 12, 3);
        hold(other, 0, 50, 12, 3);
        check_ok(mspring_network_compact(network));
        support_steps(network, 30, DT);
        support_steps(other, 30, DT);
        const support_point here = support_position(network, 50), there = support_position(other, 50);
        check_near(here.x, there.x, 1e-3);
        check_near(here.y, there.y, 1e-3);
        mspring_network_destroy(network);
        mspring_network_destroy(other);
    }
}

/// A step that is rolled back has moved neither the target nor what was counted.
static void failed_step_changes_nothing(void **state) {
    (void)state;
    mspring_network *network = make((making){0}), *other = make((making){0});
    hold(network, 0, 3, 3, 0.2);
    hold(other, 0, 3, 3, 0.2);
    support_steps(network, 4, DT);
    support_steps(other, 4, DT);
    check_ok(mspring_network_move_grip(network, 0, 3, 0.4));
    check_ok(mspring_network_move_grip(other, 0, 3, 0.4));
    double x, y, kept_x, kept_y;
    check_ok(mspring_network_get_grip_impulse(network, 0, &kept_x, &kept_y));
    check_ok(support_set_guard(network, MSPRING_GUARD_GROWTH));
    check_error(mspring_network_step(network, 2.0), MSPRING_ERROR_UNSTABLE);
    check_ok(mspring_network_get_grip_impulse(network, 0, &x, &y));
    assert_true(x == kept_x && y == kept_y);
    check_ok(support_set_guard(other, MSPRING_GUARD_GROWTH));
    support_steps(network, 4, DT);
    support_steps(other, 4, DT);
    assert_int_equal(support_hash(network), support_hash(other));
    mspring_network_destroy(network);
    mspring_network_destroy(other);
}

/* --------------------------------------------------------------------------------------------------------- calls
 */

static void refuse(mspring_network *network, const mspring_grip_def *def, mspring_result result, const char *part) {
    check_error(mspring_network_set_grip(network, 0, def), result);
    check_contains(mspring_network_error(network), part);
    assert_int_equal(read(network, 0).particle, 3);
}

static void wrong_grips_are_refused(void **state) {
    (void)state;
    mspring_network *network = make((making){0});
    hold(network, 0, 3, 4, 5);
    mspring_grip_def def = grip_of(mspring_network_count(network, MSPRING_PARTICLES), 0, 0);
    refuse(network, &def, MSPRING_ERROR_ID, "does not exist");
    def.particle = MSPRING_NONE;
    refuse(network, &def, MSPRING_ERROR_ID, "is not set (MSPRING_NONE)");
    const float wrong[] = {-1, NAN, INFINITY};
    for (size_t i = 0; i < COUNT_OF(wrong); i++) {
        def = grip_of(4, 0, 0);
        def.stiffness = wrong[i];
        refuse(network, &def, MSPRING_ERROR_ARGUMENT, "stiffness is");
        def = grip_of(4, 0, 0);
        def.damping = wrong[i];
        refuse(network, &def, MSPRING_ERROR_ARGUMENT, "damping is");
        def = grip_of(4, 0, 0);
        def.max_force = wrong[i];
        refuse(network, &def, MSPRING_ERROR_ARGUMENT, "max_force is");
        def = grip_of(4, 0, wrong[i] < 0 ? 2e12 : (double)wrong[i]);
        refuse(network, &def, MSPRING_ERROR_ARGUMENT, "the target (");
    }
    def = grip_of(4, 0, 0);
    check_error(mspring_network_set_grip(network, 1, &def), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "there is no grip 1");
    check_error(mspring_network_set_grip(network, 0, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_move_grip(network, 1, 0, 0), MSPRING_ERROR_ID);
    check_error(mspring_network_move_grip(network, 0, NAN, 0), MSPRING_ERROR_ARGUMENT);
    double x = 7, y = 7;
    check_error(mspring_network_get_grip_impulse(network, 9, &x, &y), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "there is no grip 9");
    check_error(mspring_network_get_grip(network, MSPRING_NONE, &def), MSPRING_ERROR_ID);
    assert_true(x == 7 && y == 7);
    for (mspring_id grip = 1; grip < MSPRING_MAX_GRIPS; grip++)
        hold(network, grip, 4, 0, 0);
    check_error(mspring_network_add_grip(network, &def, NULL), MSPRING_ERROR_LIMIT);
    check_ok(mspring_network_remove_grip(network, 7));
    hold(network, MSPRING_MAX_GRIPS, 4, 0, 0);
    check_error(mspring_network_move_grip(network, 7, 0, 0), MSPRING_ERROR_ID);
    mspring_network_destroy(network);
}

static void MSPRING_CALL call_from_inside(const mspring_hook_args *args, void *user) {
    mspring_network *network = user;
    (void)args;
    const mspring_grip_def def = grip_of(3, 0, 0);
    check_error(mspring_network_add_grip(network, &def, NULL), MSPRING_ERROR_BUSY);
    check_error(mspring_network_move_grip(network, 0, 0, 0), MSPRING_ERROR_BUSY);
}

static void hooks_may_not_hold(void **state) {
    (void)state;
    mspring_network *network = make((making){0});
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, call_from_inside, network, NULL));
    support_steps(network, 1, DT);
    mspring_network_destroy(network);
}

/// To hold the same particle again moves the target; to hold another begins there.
static void target_moves_if_the_particle_stays(void **state) {
    (void)state;
    support_point reached[3];
    for (int i = 0; i < 3; i++) {
        mspring_network *network = make((making){0});
        hold(network, 0, i == 2 ? 9 : 3, i == 2 ? 9 : 3, 0);
        support_steps(network, 2, DT);
        if (i == 1)
            check_ok(mspring_network_move_grip(network, 0, 3, 1));
        else
            hold(network, 0, 3, 3, 1);
        support_steps(network, 1, DT);
        reached[i] = support_position(network, 3);
        mspring_network_destroy(network);
    }
    assert_true(reached[0].y == reached[1].y);
    assert_true(fabs(reached[2].y - reached[0].y) > 1e-3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bits_are_the_same),
        cmocka_unit_test(without_grips_nothing_changes),
        cmocka_unit_test(snapshots_go_on_with_the_same_bits),
        cmocka_unit_test(snapshot_without_grips_lets_go),
        cmocka_unit_test(forged_grips_are_refused),
        cmocka_unit_test(sleeper_wakes),
        cmocka_unit_test(woken_sleeper_is_held_in_the_same_step),
        cmocka_unit_test(removed_particle_takes_its_grip_along),
        cmocka_unit_test(pinned_particle_feels_nothing),
        cmocka_unit_test(compaction_keeps_grips),
        cmocka_unit_test(failed_step_changes_nothing),
        cmocka_unit_test(wrong_grips_are_refused),
        cmocka_unit_test(hooks_may_not_hold),
        cmocka_unit_test(target_moves_if_the_particle_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

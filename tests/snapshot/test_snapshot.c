/// @file test_snapshot.c
/// Snapshots: what is saved comes back, and nothing else comes with it.
///
/// SPDX-License-Identifier: MIT
#include <fenv.h>
#include <float.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "snapshots.h"
#include "store/snapshot_format.h"
#include "support.h"

enum { FRAMES = ROUNDS(50) + 10, BACK = 8 };

/// Go on for some frames, go back, and go on again: the same.
static void check_rollback(mspring_snapshot_contents contents, uint32_t worker_count, mspring_solver kind,
                           mspring_integrator integrator, uint32_t coarse_period) {
    recipe made = recipe_mixed(3);
    mspring_network *network = snapshots_make(&made, MSPRING_SIMD_AUTO, worker_count);
    mspring_network *straight = snapshots_make(&made, MSPRING_SIMD_SCALAR, 1);
    if (kind != MSPRING_SOLVER_EXPLICIT) {
        snapshots_use_solver(network, kind, integrator, coarse_period);
        snapshots_use_solver(straight, kind, integrator, coarse_period);
    }
    uint64_t seen[FRAMES];
    saved states[FRAMES];
    snapshots_set_up(network);
    snapshots_set_up(straight);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        states[frame] = snapshots_save(network, contents);
        snapshots_run_frame(network, frame);
        snapshots_run_frame(straight, frame);
        seen[frame] = snapshots_look_at(network);
        assert_int_equal(seen[frame], snapshots_look_at(straight));
        if (frame % 10 == 9) {
            // Back, and through the same frames again.
            snapshots_load(network, &states[frame + 1 - BACK]);
            for (uint32_t again = frame + 1 - BACK; again <= frame; again++) {
                snapshots_run_frame(network, again);
                assert_int_equal(snapshots_look_at(network), seen[again]);
            }
        }
    }
    // Something did happen: springs that broke by strain, some that are whole.
    double energy;
    check_ok(support_get_energy(network, &energy, NULL, NULL));
    assert_true(energy > 0);
    // From any frame to any other.
    uint64_t seed = 9;
    for (int jump = 0; jump < 50; jump++) {
        const uint32_t frame = (uint32_t)(support_random(&seed) % FRAMES);
        snapshots_load(network, &states[frame]);
        snapshots_run_frame(network, frame);
        assert_int_equal(snapshots_look_at(network), seen[frame]);
    }
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        free(states[frame].bytes);
    }
    mspring_network_destroy(network);
    mspring_network_destroy(straight);
    recipe_free(&made);
}

static void a_rollback_gives_the_same_bits(void **state) {
    (void)state;
    check_rollback(MSPRING_SNAPSHOT_ALL, 1, MSPRING_SOLVER_EXPLICIT, 0, 0);
    check_rollback(MSPRING_SNAPSHOT_FRAME, 1, MSPRING_SOLVER_EXPLICIT, 0, 0);
    check_rollback(MSPRING_SNAPSHOT_FRAME, 3, MSPRING_SOLVER_EXPLICIT, 0, 0);
}

static void a_rollback_of_the_implicit_solvers_gives_the_same_bits(void **state) {
    (void)state;
    for (mspring_integrator integrator = MSPRING_INTEGRATOR_ALPHA; integrator <= MSPRING_INTEGRATOR_EULER;
         integrator++) {
        check_rollback(MSPRING_SNAPSHOT_ALL, 1, MSPRING_SOLVER_IMPLICIT, integrator, 1);
        check_rollback(MSPRING_SNAPSHOT_FRAME, 1, MSPRING_SOLVER_IMPLICIT, integrator, 5);
        check_rollback(MSPRING_SNAPSHOT_ALL, 1, MSPRING_SOLVER_DIRECT, integrator, 0);
        check_rollback(MSPRING_SNAPSHOT_FRAME, 1, MSPRING_SOLVER_DIRECT, integrator, 0);
    }
}

/// What a solver has gone through that is not in a snapshot does not matter: not even after ten thousand steps.
static void an_old_network_goes_on_like_a_young_one(void **state) {
    (void)state;
    recipe made = recipe_mixed(3);
    for (mspring_solver kind = MSPRING_SOLVER_IMPLICIT; kind <= MSPRING_SOLVER_DIRECT; kind++) {
        mspring_network *old = snapshots_make(&made, MSPRING_SIMD_AUTO, 1),
                        *young = snapshots_make(&made, MSPRING_SIMD_AUTO, 1);
        snapshots_use_solver(old, kind, MSPRING_INTEGRATOR_ALPHA, 1);
        snapshots_use_solver(young, kind, MSPRING_INTEGRATOR_ALPHA, 1);
        support_steps(young, 1, 0.01);
        const saved start = snapshots_save(young, MSPRING_SNAPSHOT_ALL);
        support_steps(old, ROUNDS(10000), 0.001);
        snapshots_load(old, &start);
        for (int step = 0; step < 5; step++) {
            support_steps(old, 1, 0.01);
            support_steps(young, 1, 0.01);
            assert_int_equal(snapshots_look_at(old), snapshots_look_at(young));
        }
        free(start.bytes);
        mspring_network_destroy(old);
        mspring_network_destroy(young);
    }
    recipe_free(&made);
}

static void solvers_have_to_be_alike(void **state) {
    (void)state;
    recipe made = recipe_mixed(3);
    mspring_network *explicit_one = snapshots_make(&made, MSPRING_SIMD_AUTO, 1);
    mspring_network *implicit_one = snapshots_make(&made, MSPRING_SIMD_AUTO, 1);
    mspring_network *other_one = snapshots_make(&made, MSPRING_SIMD_AUTO, 1);
    mspring_network *direct_one = snapshots_make(&made, MSPRING_SIMD_AUTO, 1);
    snapshots_use_solver(implicit_one, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, 1);
    snapshots_use_solver(other_one, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER, 1);
    snapshots_use_solver(direct_one, MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_BDF2, 1);
    saved of_explicit = snapshots_save(explicit_one, MSPRING_SNAPSHOT_ALL);
    saved of_implicit = snapshots_save(implicit_one, MSPRING_SNAPSHOT_ALL);
    check_error(mspring_network_load(implicit_one, of_explicit.bytes, of_explicit.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(implicit_one), "implicit solver: it was saved without one, the network has one");
    check_error(mspring_network_load(explicit_one, of_implicit.bytes, of_implicit.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(explicit_one), "implicit solver: it was saved with one, the network has none");
    check_error(mspring_network_load(other_one, of_implicit.bytes, of_implicit.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(other_one), "integrator");
    check_error(mspring_network_load(direct_one, of_implicit.bytes, of_implicit.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(direct_one), "another solver");
    saved of_direct = snapshots_save(direct_one, MSPRING_SNAPSHOT_ALL);
    check_error(mspring_network_load(implicit_one, of_direct.bytes, of_direct.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(implicit_one), "another solver");
    mspring_network_destroy(direct_one);
    free(of_direct.bytes);
    free(of_explicit.bytes);
    free(of_implicit.bytes);
    mspring_network_destroy(explicit_one);
    mspring_network_destroy(implicit_one);
    mspring_network_destroy(other_one);
    recipe_free(&made);
}

static void snapshots_are_the_same_everywhere(void **state) {
    (void)state;
    recipe made = recipe_mixed(3);
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    saved first = {0};
    for (uint32_t i = 0; i < count; i++) {
        mspring_network *network = snapshots_make(&made, levels[i], i + 1);
        snapshots_set_up(network);
        for (uint32_t frame = 0; frame < 20; frame++) {
            snapshots_run_frame(network, frame);
        }
        saved now = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
        if (i == 0) {
            first = now;
        } else {
            assert_int_equal(now.size, first.size);
            assert_memory_equal(now.bytes, first.bytes, first.size);
            free(now.bytes);
        }
        mspring_network_destroy(network);
    }
    free(first.bytes);
    recipe_free(&made);
}

static void all_goes_into_a_new_network(void **state) {
    (void)state;
    recipe made = recipe_mixed(3);
    mspring_network *old = snapshots_make(&made, MSPRING_SIMD_AUTO, 1);
    snapshots_set_up(old);
    for (uint32_t frame = 0; frame < 20; frame++) {
        snapshots_run_frame(old, frame);
    }
    saved all = snapshots_save(old, MSPRING_SNAPSHOT_ALL), frame_only = snapshots_save(old, MSPRING_SNAPSHOT_FRAME);
    assert_true(frame_only.size < all.size);

    // A new one lacks the edits of snapshots_set_up(): it needs all.
    mspring_network *new = snapshots_make(&made, MSPRING_SIMD_SCALAR, 2);
    const uint64_t before = snapshots_look_at(new);
    check_error(mspring_network_load(new, frame_only.bytes, frame_only.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(new), "MSPRING_SNAPSHOT_FRAME");
    assert_int_equal(snapshots_look_at(new), before);
    snapshots_load(new, &all);
    assert_int_equal(snapshots_look_at(new), snapshots_look_at(old));
    snapshots_load(new, &frame_only);
    for (uint32_t frame = 20; frame < 30; frame++) {
        snapshots_run_frame(old, frame);
        snapshots_run_frame(new, frame);
        assert_int_equal(snapshots_look_at(new), snapshots_look_at(old));
    }
    // And back to one that has none of what there is now.
    mspring_network *fresh = snapshots_make(&made, MSPRING_SIMD_AUTO, 1);
    saved start = snapshots_save(fresh, MSPRING_SNAPSHOT_ALL);
    snapshots_load(new, &start);
    assert_int_equal(snapshots_look_at(new), before);
    for (uint32_t frame = 0; frame < 5; frame++) {
        snapshots_run_frame(fresh, frame);
        snapshots_run_frame(new, frame);
        assert_int_equal(snapshots_look_at(new), snapshots_look_at(fresh));
    }
    mspring_network_destroy(old);
    mspring_network_destroy(new);
    mspring_network_destroy(fresh);
    free(all.bytes);
    free(frame_only.bytes);
    free(start.bytes);
    recipe_free(&made);
}

/// Settings at the ends of what they may be.
typedef struct extremes {
    float global_damping, max_speed, relax;
    uint32_t substeps, max_substeps, iterations, coarse_period;
    float residual;
} extremes;

static mspring_network *extreme_network(const extremes *set, mspring_solver kind) {
    recipe made = {0};
    // As far out as a network may be made, so that its origin is there, too.
    recipe_particle(&made, MSPRING_MAX_COORDINATE, -MSPRING_MAX_COORDINATE, 1, 0);
    recipe_particle(&made, MSPRING_MAX_COORDINATE - 4, -MSPRING_MAX_COORDINATE, 1, 0);
    recipe_spring(&made, 0, 1, 1e-3, 0, 0); // and stable with 1 s as with little
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.global_damping = set->global_damping;
    def.settings.max_speed = set->max_speed;
    mspring_network *network = recipe_network(&made, &def);
    check_ok(support_set_relax_fraction(network, set->relax));
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = kind;
    solver.substeps = set->substeps;
    solver.max_substeps = set->max_substeps;
    solver.iterations = set->iterations;
    solver.coarse_period = set->coarse_period;
    solver.residual = set->residual;
    check_ok(support_set_solver(network, &solver));
    recipe_free(&made);
    return network;
}

/// Whatever a setting may be comes back with a snapshot, into a network that has other settings.
static void settings_may_be_all_that_they_can_be(void **state) {
    (void)state;
    const extremes usual = {0.5f, 100, 0.8f, 3, 1000, 5, 3, 0.01f};
    const extremes sets[] = {{0, 1e15f, 1, 1, 1, 1, 10000, 0},
                             {1e6f, 1e-3f, 0, 1, 2, 10000, 1, 1},
                             {1e6f, 1e15f, 0, MSPRING_MAX_SUBSTEPS, MSPRING_MAX_SUBSTEPS, 2, 2, 0.1f},
                             {0, 1, 1, MSPRING_SUBSTEPS_AUTO, 1, 2, 2, FLT_MIN}};
    for (size_t i = 0; i < COUNT_OF(sets); i++) {
        for (mspring_solver kind = MSPRING_SOLVER_EXPLICIT; kind <= MSPRING_SOLVER_DIRECT; kind++) {
            mspring_network *network = extreme_network(&sets[i], kind), *other = extreme_network(&usual, kind);
            const double x = MSPRING_MAX_COORDINATE - 3, y = 1 - MSPRING_MAX_COORDINATE;
            check_ok(mspring_network_set_positions(network, NULL, 0, 1, &x, &y, 1)); // it is elsewhere in the other
            if (sets[i].substeps == 1) {
                support_steps(network, 1, 0.01); // the guard knows the damping of its last look, too
            }
            const saved all = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
            snapshots_load(other, &all);
            const saved again = snapshots_save(other, MSPRING_SNAPSHOT_ALL);
            assert_int_equal(again.size, all.size);
            assert_memory_equal(again.bytes, all.bytes, all.size);
            assert_int_equal(snapshots_look_at(other), snapshots_look_at(network));
            assert_int_equal(support_substeps(other), support_substeps(network));
            if (kind == MSPRING_SOLVER_IMPLICIT) {
                const mspring_settings now = support_solver(other);
                assert_int_equal(now.iterations, sets[i].iterations);
                assert_int_equal(now.coarse_period, sets[i].coarse_period);
                assert_true(now.residual == sets[i].residual);
            }
            // In 0.01 s they fall to 0.098 m/s more, or with much damping to 9.8e-6 m/s.
            if (sets[i].substeps == 1) {
                support_steps(other, 1, 0.01);
                support_steps(network, 1, 0.01);
                assert_int_equal(snapshots_look_at(other), snapshots_look_at(network));
            }
            free(all.bytes);
            free(again.bytes);
            mspring_network_destroy(network);
            mspring_network_destroy(other);
        }
    }
}

/// What was saved when nothing had been removed brings back what was removed since.
static void what_was_removed_comes_back(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    mspring_network *network = snapshots_make(&made, MSPRING_SIMD_AUTO, 1), *other = NULL;
    support_steps(network, 3, 0.01);
    saved before = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    check_ok(mspring_network_clone(network, NULL, &other));
    const mspring_id particles[] = {2, made.particle_count - 1}, springs[] = {0, made.spring_count - 1};
    check_ok(mspring_network_remove_particles(network, particles, 0, 2));
    for (size_t i = 0; i < COUNT_OF(springs); i++) {
        if (support_has_spring(network, springs[i])) {
            check_ok(mspring_network_remove_springs(network, &springs[i], 0, 1));
        }
    }
    support_steps(network, 3, 0.01);
    snapshots_load(network, &before);
    assert_int_equal(support_has_particle(network, 2), 1);
    for (int step = 0; step < 5; step++) {
        assert_int_equal(snapshots_look_at(network), snapshots_look_at(other));
        support_steps(network, 1, 0.01);
        support_steps(other, 1, 0.01);
    }
    free(before.bytes);
    mspring_network_destroy(network);
    mspring_network_destroy(other);
    recipe_free(&made);
}

// Sections and their bytes, or bytes per slot.
static void describe(const mspring_network *network, char *text, size_t room) {
    support_plan plan;
    saved of = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    check_ok(support_get_plan(network, &plan));
    mspringi_snapshot_header header;
    assert_true(mspringi_get_header(of.bytes, &header));
    const uint8_t *at = of.bytes + MSPRINGI_SNAPSHOT_HEADER_BYTES;
    size_t length = (size_t)snprintf(text, room, "%u:", (unsigned)header.version);
    for (uint32_t i = 0; i < header.section_count; i++) {
        uint64_t size;
        mspringi_get(at + 8, &size, 1, sizeof size);
        assert_true(length < room);
        const bool by_slot = size % plan.slot_count == 0;
        length += (size_t)snprintf(text + length, room - length, " %.4s %u%s", (const char *)at,
                                   (unsigned)(by_slot ? size / plan.slot_count : size), by_slot ? "/slot" : "");
        at += MSPRINGI_SECTION_HEADER_BYTES + mspringi_round_up((size_t)size, 8);
    }
    free(of.bytes);
}

/// What is in a snapshot of a single spring, with all that there can be. Where this changes, so does the version.
static void a_version_has_one_format(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id a = support_pinned(builder, 0, 0, 1), b = support_particle(builder, 1, 0, 1);
    support_spring(builder, a, b, 100, 1);
    mspring_network_def def = support_def(-9.8f, 4);
    def.settings.guard = MSPRING_GUARD_IMPLICIT;
    def.spare_particles = def.spare_springs = 1;
    def.flags = MSPRING_NETWORK_RESERVE_RELATIVE;
    def.settings.sleep_speed = 0.1f;
    mspring_network *network = support_network(builder, &def);
    const float strain = 1, scale = 0.5f;
    const mspring_id spring = 0;
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, 1, &strain, 1));
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, 1, &strain, 1));
    check_ok(mspring_network_set(network, MSPRING_RELAX_STRAIN, NULL, 0, 1, &strain, 1));
    check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, b, 1, &scale, 1));
    check_ok(mspring_network_break_springs(network, &spring, 0, 1));
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 9));
    check_ok(mspring_network_apply_force(network, b, 1, 2));
    char text[400];
    describe(network, text, sizeof text);
    assert_string_equal(text,
                        "12: grow 23 sett 60 step 72 moti 24/slot mass 28 forc 8/slot valu 24 brks 8 strs 8 "
                        "rlxs 8 stsd 4 ramp 32 slee 24 guar 56");
    snapshots_use_solver(network, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, 1);
    check_ok(mspring_network_step(network, 0.01));
    describe(network, text, sizeof text);
    assert_string_equal(
        text, "12: grow 23 sett 60 step 72 moti 24/slot mass 28 valu 24 brks 8 strs 8 rlxs 8 stsd 4 ramp 32 "
              "slee 24 impl 1324 guar 56");
    mspring_network_destroy(network);
}

/// What happened before a network was loaded has not happened to it; and the rounding mode of the thread stays.
static void loading_leaves_no_events_and_no_rounding_mode(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    mspring_network *network = snapshots_make(&made, MSPRING_SIMD_AUTO, 1);
    saved before = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    const float strain = 1e-3f, fast = 20;
    check_ok(mspring_network_reserve_events(network, 10));
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, 1, &strain, 1));
    check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &fast, &fast, 1));
    support_steps(network, 3, 0.01);
    const int mode = fegetround();
    assert_int_equal(fesetround(FE_UPWARD), 0);
    volatile float one = 1, little = 1e-10f, expected = one + little; // over 1, but for valgrind
    snapshots_load(network, &before);
    volatile float sum = one + little;
    assert_int_equal(fegetround(), FE_UPWARD);
    assert_int_equal(fesetround(mode), 0);
    assert_true(sum == expected); // which fegetround() need not know
    mspring_event event;
    uint32_t count = 1;
    check_ok(mspring_network_read_events(network, &event, 1, &count, NULL));
    assert_int_equal(count, 0);
    // They were there.
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, 1, &strain, 1));
    check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &fast, &fast, 1));
    support_steps(network, 3, 0.01);
    check_ok(mspring_network_read_events(network, &event, 1, &count, NULL));
    assert_int_equal(count, 1);
    free(before.bytes);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/* ----------------------------------------------------------------------------------------------- refused steps */

/// A network with something of everything, that nobody has stepped with this solver yet.
static mspring_network *eventful(const recipe *made, mspring_guard guard, mspring_solver solver) {
    static const double plane[4] = {0, -1.5, 0, 1};
    mspring_network_def def = support_def(-9.8f, 4);
    mspring_floor_def floor_def;
    def.settings.guard = guard;
    def.settings.max_speed = 1e3f;
    def.settings.sleep_speed = 1e-3f;
    mspring_network *network = recipe_network(made, &def);
    snapshots_set_up(network);
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor_def, sizeof floor_def));
    floor_def.planes = plane, floor_def.plane_count = 1;
    check_ok(mspring_network_set_floor(network, &floor_def));
    if (solver != MSPRING_SOLVER_EXPLICIT) {
        snapshots_use_solver(network, solver, MSPRING_INTEGRATOR_BDF2, 2);
    }
    mspring_settings most = support_solver(network);
    most.most_work = 0; // else MSPRING_GUARD_RETRY may keep more substeps after a step that fails
    check_ok(support_set_solver(network, &most));
    return network;
}

/// A step is refused, and the snapshot has the same bytes afterwards.
static void check_refusal(mspring_network *network, double dt, const char *why) {
    const saved before = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    const mspring_result result = mspring_network_step(network, dt);
    const saved after = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    if (result != MSPRING_ERROR_UNSTABLE || before.size != after.size ||
        memcmp(before.bytes, after.bytes, before.size) != 0) {
        print_error("%s: %s\n", why, mspring_result_string(result));
    }
    check_error(result, MSPRING_ERROR_UNSTABLE);
    assert_int_equal(after.size, before.size);
    assert_memory_equal(after.bytes, before.bytes, before.size);
    free(before.bytes);
    free(after.bytes);
}

static void refused_steps_leave_no_trace(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    for (int guard = MSPRING_GUARD_GROWTH; guard <= MSPRING_GUARD_CLAMP; guard++) {
        for (int solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
            for (uint32_t frames = 0; frames < ROUNDS(8); frames++) {
                mspring_network *network = eventful(&made, guard, solver);
                for (uint32_t frame = 0; frame < frames; frame++) {
                    snapshots_run_frame(network, frame);
                }
                // Too fast at the end whoever takes it, for a step like the last one and for one of another length.
                check_ok(mspring_network_apply_force(network, 2, 1e9f, 1e9f));
                check_refusal(network, 0.01, "a blow");
                check_refusal(network, 0.03, "a blow in a long step");
                check_refusal(network, 0.01, "the blow again");
                mspring_network_destroy(network);
            }
        }
    }
    recipe_free(&made);
}

static void bad_arguments_are_refused(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    mspring_network *network = snapshots_small_network(&made);
    size_t size = 4711, room;
    uint8_t bytes[64];
    check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_FRAME, &room));
    check_error(mspring_network_get_snapshot_size(NULL, MSPRING_SNAPSHOT_ALL, &size), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_snapshot_size(network, 2, &size), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_snapshot_size(network, -1, &size), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_ALL, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_save(NULL, MSPRING_SNAPSHOT_ALL, bytes, sizeof bytes, &size),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, NULL, room, &size), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, bytes, sizeof bytes, &size),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_load(NULL, bytes, sizeof bytes), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_load(network, NULL, 100), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "NULL");
    assert_int_equal(size, 4711);
    uint8_t *enough = malloc(room);
    assert_non_null(enough);
    check_error(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, enough, room - 1, &size),
                MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, enough, room, NULL));
    free(enough);
    mspring_network_destroy(network);
    recipe_free(&made);
}

typedef struct caller {
    mspring_network *network;
    saved snapshot;
    int calls;
} caller;

static void call_from_inside(const mspring_hook_args *args, void *user) {
    caller *inside = user;
    size_t size = 0;
    (void)args;
    inside->calls++;
    check_error(mspring_network_get_snapshot_size(inside->network, MSPRING_SNAPSHOT_ALL, &size),
                MSPRING_ERROR_BUSY);
    check_error(mspring_network_save(inside->network, MSPRING_SNAPSHOT_ALL, inside->snapshot.bytes,
                                     inside->snapshot.size, &size),
                MSPRING_ERROR_BUSY);
    check_error(mspring_network_load(inside->network, inside->snapshot.bytes, inside->snapshot.size),
                MSPRING_ERROR_BUSY);
}

static void hooks_can_neither_save_nor_load(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    mspring_network *network = snapshots_small_network(&made);
    caller inside = {.network = network, .snapshot = snapshots_save(network, MSPRING_SNAPSHOT_ALL)};
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, call_from_inside, &inside, NULL));
    check_ok(mspring_network_step(network, 0.01));
    assert_true(inside.calls > 0);
    free(inside.snapshot.bytes);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void loading_survives_every_failure(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    mspring_network *old = snapshots_small_network(&made);
    saved all = snapshots_save(old, MSPRING_SNAPSHOT_ALL);
    const uint64_t expected = snapshots_look_at(old);
    mspring_result result = MSPRING_ERROR_MEMORY;
    size_t fail_at = 0;
    while (result != MSPRING_OK) {
        watched_allocator watched = {0};
        const mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def def = support_def(-9.8f, 4);
        def.allocator = &allocator;
        mspring_network *network = recipe_network(&made, &def);
        const uint64_t before = snapshots_look_at(network);
        watched.fail_at = watched.calls + ++fail_at;
        result = mspring_network_load(network, all.bytes, all.size);
        if (result == MSPRING_OK) {
            assert_int_equal(snapshots_look_at(network), expected);
        } else {
            check_error(result, MSPRING_ERROR_MEMORY);
            check_contains(mspring_network_error(network), "memory");
            assert_int_equal(snapshots_look_at(network), before);
            check_ok(mspring_network_step(network, 0.01));
        }
        mspring_network_destroy(network);
        check_watched_clean(&watched);
    }
    assert_true(fail_at > 5);
    mspring_network_destroy(old);
    free(all.bytes);
    recipe_free(&made);
}

/// Of a network without springs, too, whose border of stability is that there is none.
static void what_was_loaded_is_saved_alike(void **state) {
    (void)state;
    mspring_network *networks[2];
    for (int n = 0; n < 2; n++) {
        mspring_builder *builder = support_builder();
        support_particle(builder, 0, 0, 1);
        const mspring_network_def def = support_def(-9.8f, 4);
        networks[n] = support_network(builder, &def);
    }
    support_steps(networks[0], 3, 0.01);
    saved first = snapshots_save(networks[0], MSPRING_SNAPSHOT_ALL);
    snapshots_load(networks[1], &first);
    saved second = snapshots_save(networks[1], MSPRING_SNAPSHOT_ALL);
    assert_true(first.size == second.size && memcmp(first.bytes, second.bytes, first.size) == 0);
    free(first.bytes);
    free(second.bytes);
    mspring_network_destroy(networks[0]);
    mspring_network_destroy(networks[1]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rollback_gives_the_same_bits),
        cmocka_unit_test(a_rollback_of_the_implicit_solvers_gives_the_same_bits),
        cmocka_unit_test(an_old_network_goes_on_like_a_young_one),
        cmocka_unit_test(solvers_have_to_be_alike),
        cmocka_unit_test(snapshots_are_the_same_everywhere),
        cmocka_unit_test(all_goes_into_a_new_network),
        cmocka_unit_test(settings_may_be_all_that_they_can_be),
        cmocka_unit_test(what_was_removed_comes_back),
        cmocka_unit_test(a_version_has_one_format),
        cmocka_unit_test(loading_leaves_no_events_and_no_rounding_mode),
        cmocka_unit_test(refused_steps_leave_no_trace),
        cmocka_unit_test(bad_arguments_are_refused),
        cmocka_unit_test(hooks_can_neither_save_nor_load),
        cmocka_unit_test(loading_survives_every_failure),
        cmocka_unit_test(what_was_loaded_is_saved_alike),
    };
    return cmocka_run_group_tests_name("snapshot", tests, NULL, NULL);
}

/// @file test_breaking.c
/// Springs that break and are restored: a broken spring is as good as none, a restored one as if nothing had been,
/// in lattices, chains and webs, at every level.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "snapshots.h"
#include "support.h"

static mspring_network *network_of(const recipe *made, mspring_simd level) {
    mspring_network_def def = support_def(-9.8f, 4);
    def.simd_level = level;
    return recipe_network(made, &def);
}

/// Every third spring of a recipe.
static uint32_t every_third(const recipe *made, mspring_id *ids) {
    uint32_t count = 0;
    for (mspring_id s = 0; s < made->spring_count; s += 3) {
        ids[count++] = s;
    }
    return count;
}

/// The same recipe, made without stiffness and damping in the listed springs.
static mspring_network *network_without(const recipe *made, const mspring_id *ids, uint32_t count,
                                        mspring_simd level) {
    recipe weak = *made;
    weak.springs = malloc(made->spring_count * sizeof *weak.springs);
    assert_non_null(weak.springs);
    for (mspring_id s = 0; s < made->spring_count; s++) {
        weak.springs[s] = made->springs[s];
    }
    for (uint32_t i = 0; i < count; i++) {
        weak.springs[ids[i]].stiffness = weak.springs[ids[i]].damping = 0;
    }
    mspring_network *network = network_of(&weak, level);
    free(weak.springs);
    return network;
}

static void a_broken_spring_is_one_without_stiffness_and_damping(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    for (uint32_t flags = 0; flags <= MSPRING_SPRING_RELATIVE; flags += MSPRING_SPRING_RELATIVE) {
        recipe made = recipe_rows(11, flags, 1, 5);
        mspring_id *ids = malloc(made.spring_count * sizeof *ids);
        assert_non_null(ids);
        const uint32_t count = every_third(&made, ids);
        uint64_t first_hash = 0;
        for (uint32_t i = 0; i < level_count; i++) {
            mspring_network *network = network_of(&made, levels[i]);
            mspring_network *without = network_without(&made, ids, count, levels[i]);
            check_ok(mspring_network_break_springs(network, ids, 0, count));
            // Relative springs must stay broken when they are derived anew for another substep.
            support_steps(network, 10, 1.0 / 64);
            support_steps(without, 10, 1.0 / 64);
            support_steps(network, 10, 1.0 / 128);
            support_steps(without, 10, 1.0 / 128);
            assert_int_equal(support_hash(network), support_hash(without));
            first_hash = i == 0 ? support_hash(network) : first_hash;
            assert_int_equal(support_hash(network), first_hash);
            mspring_network_destroy(network);
            mspring_network_destroy(without);
        }
        free(ids);
        recipe_free(&made);
    }
}

static void restoring_undoes_breaking(void **state) {
    (void)state;
    for (uint32_t flags = 0; flags <= MSPRING_SPRING_RELATIVE; flags += MSPRING_SPRING_RELATIVE) {
        recipe made = recipe_rows(11, flags, 1, 5);
        mspring_id *ids = malloc(made.spring_count * sizeof *ids);
        assert_non_null(ids);
        const uint32_t count = every_third(&made, ids);
        mspring_network *network = network_of(&made, MSPRING_SIMD_AUTO);
        mspring_network *untouched = network_of(&made, MSPRING_SIMD_AUTO);
        // Before the first step, and between steps; twice, as breaking and restoring again change nothing.
        for (int round = 0; round < 3; round++) {
            for (int again = 0; again < 2; again++) {
                check_ok(mspring_network_break_springs(network, ids, 0, count));
            }
            for (int again = 0; again < 2; again++) {
                check_ok(mspring_network_restore_springs(network, ids, 0, count, 0));
            }
            support_steps(network, 5, 1.0 / 64);
            support_steps(untouched, 5, 1.0 / 64);
            assert_int_equal(support_hash(network), support_hash(untouched));
        }
        mspring_network_destroy(network);
        mspring_network_destroy(untouched);
        free(ids);
        recipe_free(&made);
    }
}

static support_spring_info info_of(const mspring_network *network, mspring_id spring) {
    support_spring_info info;
    check_ok(support_get_spring(network, spring, &info));
    return info;
}

/// Set all stiffness, in a range or a list.
static void set_stiffness(mspring_network *network, const recipe *made, float stiffness, bool is_listed) {
    const uint32_t count = mspring_network_count(network, MSPRING_SPRINGS);
    mspring_id *all = malloc(count * sizeof *all);
    assert_non_null(all);
    for (mspring_id s = 0; s < count; s++) {
        all[s] = s;
    }
    assert_int_equal(count, made->spring_count);
    check_ok(is_listed ? mspring_network_set(network, MSPRING_STIFFNESS, all, 0, count, &stiffness, 0)
                       : mspring_network_set(network, MSPRING_STIFFNESS, NULL, 0, count, &stiffness, 0));
    free(all);
}

static void a_broken_spring_that_is_set_stays_broken(void **state) {
    (void)state;
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t flags = i % 2 ? MSPRING_SPRING_RELATIVE : 0;
        const float stiffness = flags ? 0.15f : 750.0f;
        recipe made = recipe_rows(11, flags, 1, 5);
        mspring_id *ids = malloc(made.spring_count * sizeof *ids);
        assert_non_null(ids);
        const uint32_t count = every_third(&made, ids);
        mspring_network *broken_first = network_of(&made, MSPRING_SIMD_AUTO);
        mspring_network *set_first = network_of(&made, MSPRING_SIMD_AUTO);
        support_steps(broken_first, 1, 1.0 / 64); // stiffness of relative springs is known from then on
        support_steps(set_first, 1, 1.0 / 64);
        check_ok(mspring_network_break_springs(broken_first, ids, 0, count));
        set_stiffness(broken_first, &made, stiffness, i >= 2);
        set_stiffness(set_first, &made, stiffness, i >= 2);
        check_ok(mspring_network_break_springs(set_first, ids, 0, count));
        support_steps(broken_first, 10, 1.0 / 64);
        support_steps(set_first, 10, 1.0 / 64);
        assert_true(support_hash(broken_first) == support_hash(set_first));
        check_ok(mspring_network_restore_springs(broken_first, ids, 0, count, 0.0));
        check_ok(mspring_network_restore_springs(set_first, ids, 0, count, 0.0));
        support_steps(broken_first, 10, 1.0 / 64);
        support_steps(set_first, 10, 1.0 / 64);
        assert_true(support_hash(broken_first) == support_hash(set_first));
        mspring_network_destroy(broken_first);
        mspring_network_destroy(set_first);
        free(ids);
        recipe_free(&made);
    }
}

static void a_cut_rope_falls_in_two(void **state) {
    (void)state;
    // A weight on a rope, at rest; once the rope is cut the weight falls freely: 9.8 t^2 / 2, which leapfrog has
    // exactly.
    mspring_builder *builder = support_builder();
    support_pinned(builder, 0, 0, 1);
    support_particle(builder, 0, -2, 10);
    mspring_rope_def rope;
    check_ok(mspring_init(MSPRING_STRUCT_ROPE_DEF, &rope, sizeof rope));
    rope.from = 0;
    rope.to = 1;
    rope.segment_count = 4;
    mspring_material rope_material = mspring_material_default();
    rope.material = &rope_material;
    rope_material.mass = 0.1f;
    rope_material.stiffness = 1e4f;
    mspring_id first_spring;
    check_ok(mspring_builder_add_rope(builder, &rope, NULL, &first_spring));
    mspring_network_def def = support_def(-9.8f, 1);
    mspring_network *network = support_network(builder, &def);
    const mspring_id last = first_spring + 3;
    check_ok(mspring_network_break_springs(network, &last, 0, 1));
    support_steps(network, 1000, 0.001);
    // Rounding of a velocity of up to 9.8 m/s in 1000 steps of 1 ms: 1000 * 5e-7 * 1 s at worst.
    check_near(support_position(network, 1).y, -2 - 9.8 / 2, 1e-3);
    assert_true(support_position(network, 0).y == 0);

    support_spring_info info = info_of(network, last);
    assert_int_equal(info.flags, MSPRING_SPRING_BROKEN);
    assert_true(info.stiffness == 0 && info.force == 0 && info.strain == 0 && info.length > 1);
    assert_true(info.nominal_stiffness == 1e4f && info.rest_length == 0.5f);
    float strain = 1;
    check_ok(mspring_network_get(network, MSPRING_STRAIN, NULL, last, 1, &strain, 1));
    assert_true(strain == 0);
    mspring_id most;
    check_ok(support_get_max_strain(network, &strain, &most));
    assert_int_not_equal(most, last);
    check_ok(mspring_network_restore_springs(network, &last, 0, 1, 0));
    info = info_of(network, last);
    assert_int_equal(info.flags, 0);
    assert_true(info.stiffness == 1e4f && info.strain > 1);
    mspring_network_destroy(network);
}

/// Two particles a metre apart, and a spring between.
static mspring_network *one_spring(double x, double y) {
    mspring_builder *builder = support_builder();
    support_particle(builder, x, y, 1);
    support_particle(builder, x + 1, y, 1);
    support_spring(builder, 0, 1, 1000, 10);
    const mspring_network_def def = support_def(0, 20);
    return support_network(builder, &def);
}

/// Two masses of 1 kg, 3 m apart, on a broken damped spring of 1 m, without gravity.
static mspring_network *torn_pair(void) {
    mspring_network *network = one_spring(0, 0);
    const mspring_id spring = 0;
    const double x = 3, y = 0;
    check_ok(mspring_network_break_springs(network, &spring, 0, 1));
    check_ok(mspring_network_set_positions(network, NULL, 1, 1, &x, &y, 1));
    return network;
}

/// The fastest that a particle of the pair gets, in two seconds after its spring is restored.
static double fastest_after_restoring(double ramp_seconds) {
    mspring_network *network = torn_pair();
    const mspring_id spring = 0;
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, ramp_seconds));
    double fastest = 0;
    for (int step = 0; step < 200; step++) {
        support_steps(network, 1, 0.01);
        fastest = fmax(fastest, fabs(support_velocity(network, 1).x));
    }
    // It has its own rest length again, and has come to it: the swing decays by exp(-10 t).
    assert_true(info_of(network, 0).rest_length == 1);
    check_near(info_of(network, 0).length, 1, 1e-3);
    mspring_network_destroy(network);
    return fastest;
}

static void a_ramp_takes_the_kick_out_of_restoring(void **state) {
    (void)state;
    // Undamped, each would get half of 2 m times sqrt(2 k / m) = 44.7 /s; with this damping 0.71 of that.
    check_near(fastest_after_restoring(0), 32, 2);
    // With the ramp they follow a rest length that shrinks by 2 m in 1 s: each at 1 m/s, and at most twice that, as
    // when a spring is pulled at by something that moves steadily.
    const double fastest = fastest_after_restoring(1);
    assert_true(fastest > 0.9 && fastest < 2);
}

static void a_ramp_is_even_and_ends(void **state) {
    (void)state;
    mspring_network *network = torn_pair();
    const mspring_id spring = 0;
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 0.1));
    assert_true(info_of(network, 0).rest_length == 3 && info_of(network, 0).force == 0);
    for (int step = 1; step <= 12; step++) {
        support_steps(network, 1, 0.01);
        check_near(info_of(network, 0).rest_length, step < 10 ? 3 - 0.2 * step : 1, 1e-6); // of a float
    }
    // Broken on its way, it has its own rest length; so it has if that is set, or restored with another ramp.
    for (int way = 0; way < 3; way++) {
        const float length = 1.5f;
        check_ok(mspring_network_break_springs(network, &spring, 0, 1));
        check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 1));
        support_steps(network, 3, 0.01);
        if (way == 0) {
            check_ok(mspring_network_break_springs(network, &spring, 0, 1));
        } else if (way == 1) {
            check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, 0, 1, &length, 1));
        } else {
            support_steps(network, 100, 0.01);
        }
        assert_true(info_of(network, 0).rest_length == (way == 0 ? 1 : length));
        support_steps(network, 2, 0.01);
        assert_true(info_of(network, 0).rest_length == (way == 0 ? 1 : length));
    }
    mspring_network_destroy(network);
}

static size_t snapshot_size(const mspring_network *network, mspring_snapshot_contents contents) {
    size_t size = 0;
    check_ok(mspring_network_get_snapshot_size(network, contents, &size));
    return size;
}

static bool saves_ramps(const mspring_network *network) {
    saved frame = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
    bool saves = false;
    for (size_t i = 0; i + 4 <= frame.size; i += 8) {
        saves = saves || memcmp(frame.bytes + i, "ramp", 4) == 0;
    }
    free(frame.bytes);
    return saves;
}

static void a_ramp_ends_with_its_last_step(void **state) {
    (void)state;
    mspring_network *network = torn_pair();
    const mspring_id spring = 0;
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 1));
    // Four steps of a quarter are a second, without rounding; what has no ramp any more saves none.
    support_steps(network, 3, 0.25);
    assert_true(saves_ramps(network));
    support_steps(network, 1, 0.25);
    assert_false(saves_ramps(network));
    assert_true(info_of(network, 0).rest_length == 1);
    mspring_network *same = torn_pair();
    support_bring(network, same, MSPRING_SNAPSHOT_ALL);
    assert_int_equal(support_hash(same), support_hash(network));
    mspring_network_destroy(network);
    mspring_network_destroy(same);
}

static void a_ramp_begins_at_the_distance_of_its_ends(void **state) {
    (void)state;
    mspring_network *network = one_spring(10, 20);
    const mspring_id spring = 0;
    // 3 m across and 4 m up are 5 m, whichever of the ends is where.
    const double x[] = {12, 9}, y[] = {17, 21};
    for (int way = 0; way < 2; way++) {
        check_ok(mspring_network_break_springs(network, &spring, 0, 1));
        check_ok(mspring_network_set_positions(network, NULL, 0, 1, &x[way], &y[way], 1));
        check_ok(mspring_network_set_positions(network, NULL, 1, 1, &x[1 - way], &y[1 - way], 1));
        check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 1));
        assert_true(info_of(network, 0).rest_length == 5 && info_of(network, 0).force == 0);
    }
    // Where both ends are in one place strain divides by a length all the same: a small part of the spring's own.
    check_ok(mspring_network_break_springs(network, &spring, 0, 1));
    check_ok(mspring_network_set_positions(network, NULL, 1, 1, &x[1], &y[1], 1));
    check_ok(mspring_network_set_positions(network, NULL, 0, 1, &x[1], &y[1], 1));
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 1));
    assert_true(info_of(network, 0).rest_length > 0 && info_of(network, 0).rest_length <= 0.01f);
    assert_true(info_of(network, 0).strain == -1);
    mspring_network_destroy(network);
}

/// A frame of before the ramp leaves rest lengths out, so what the ramp has made of its spring's has to go with it.
static void a_frame_of_before_a_ramp_takes_it_back(void **state) {
    (void)state;
    mspring_network *network = torn_pair(), *twin = torn_pair();
    const mspring_id spring = 0;
    // The first restoring with a ramp gives springs rest lengths of their own, which does not change them.
    size_t size = snapshot_size(network, MSPRING_SNAPSHOT_FRAME);
    void *frame = malloc(size);
    assert_non_null(frame);
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, frame, size, NULL));
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 1));
    support_steps(network, 5, 0.01);
    assert_true(info_of(network, 0).rest_length > 2.5f);
    check_ok(mspring_network_load(network, frame, size));
    assert_true(info_of(network, 0).rest_length == 1);
    assert_int_equal(info_of(network, 0).flags, MSPRING_SPRING_BROKEN);
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 0));
    check_ok(mspring_network_restore_springs(twin, &spring, 0, 1, 0));
    support_steps(network, 5, 0.01);
    support_steps(twin, 5, 0.01);
    assert_int_equal(support_hash(network), support_hash(twin));
    free(frame);
    mspring_network_destroy(network);
    mspring_network_destroy(twin);
}

static void what_is_whole_stays_as_it_is(void **state) {
    (void)state;
    mspring_network *network = one_spring(0, 0);
    const mspring_id spring = 0;
    const double x = 3, y = 0;
    mspring_event event;
    uint32_t count;
    check_ok(mspring_network_reserve_events(network, 8));
    check_ok(mspring_network_set_positions(network, NULL, 1, 1, &x, &y, 1));
    // Stretched to three times its length, it goes on pulling.
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 1));
    assert_true(info_of(network, 0).rest_length == 1 && info_of(network, 0).strain == 2);
    check_ok(mspring_network_read_events(network, &event, 1, &count, NULL));
    assert_int_equal(count, 0);
    mspring_network_destroy(network);
}

static void ramps_take_up_to_eleven_days(void **state) {
    (void)state;
    mspring_network *network = torn_pair();
    const mspring_id spring = 0;
    const double wrong[] = {1.0000001e6, INFINITY, NAN, -1e-9};
    for (size_t i = 0; i < COUNT_OF(wrong); i++) {
        check_error(mspring_network_restore_springs(network, &spring, 0, 1, wrong[i]), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "ramp");
        assert_int_equal(info_of(network, 0).flags, MSPRING_SPRING_BROKEN);
    }
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 1e6));
    support_steps(network, 100, 0.01);
    // In a second 2e-6 m of the 2 m.
    check_near(info_of(network, 0).rest_length, 3 - 2e-6, 2.4e-7); // of a float
    mspring_network_destroy(network);
}

/// Memory is taken at the first break, which a list of none is not.
static void lists_of_none_take_no_memory(void **state) {
    (void)state;
    recipe made = recipe_rows(11, 0, 1, 5);
    mspring_network *network = network_of(&made, MSPRING_SIMD_AUTO);
    const size_t before = support_memory_used(network);
    check_ok(mspring_network_break_springs(network, NULL, 0, 0));
    check_ok(mspring_network_restore_springs(network, NULL, 0, 0, 0));
    check_ok(mspring_network_detach_particles(network, NULL, 0, 0));
    check_ok(mspring_network_remove_springs(network, NULL, 0, 0));
    check_ok(mspring_network_remove_particles(network, NULL, 0, 0));
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, 0, NULL, 1));
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 5, 0, NULL, 1));
    assert_true(support_memory_used(network) == before);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void a_refused_step_does_not_move_a_ramp(void **state) {
    (void)state;
    mspring_network *network = torn_pair(), *twin = torn_pair();
    const mspring_id spring = 0;
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 3));
    check_ok(mspring_network_restore_springs(twin, &spring, 0, 1, 3));
    support_steps(network, 2, 0.01);
    support_steps(twin, 2, 0.01);
    const float before = info_of(network, 0).rest_length;
    const double far = 1e11, y = 0, back = support_position(network, 1).x;
    check_ok(mspring_network_set_positions(network, NULL, 1, 1, &far, &y, 1));
    check_error(mspring_network_step(network, 0.5), MSPRING_ERROR_UNSTABLE);
    assert_true(info_of(network, 0).rest_length == before);
    check_ok(mspring_network_set_positions(network, NULL, 1, 1, &back, &y, 1));
    support_steps(network, 10, 0.01);
    support_steps(twin, 10, 0.01);
    assert_int_equal(support_hash(network), support_hash(twin));
    mspring_network_destroy(network);
    mspring_network_destroy(twin);
}

static void a_detached_particle_flies_on_alone(void **state) {
    (void)state;
    recipe made = recipe_rows(11, 0, 1, 5);
    mspring_network *network = network_of(&made, MSPRING_SIMD_AUTO);
    // One inside the lattice, its corner with the rope, one inside the rope.
    const mspring_id detached[] = {100, 2, made.particle_count - 5};
    check_ok(mspring_network_detach_particles(network, detached, 0, 3));
    uint32_t broken = 0, expected = 0;
    for (mspring_id s = 0; s < made.spring_count; s++) {
        bool touches = false;
        for (int i = 0; i < 3; i++) {
            touches = touches || made.springs[s].a == detached[i] || made.springs[s].b == detached[i];
        }
        assert_int_equal((info_of(network, s).flags & MSPRING_SPRING_BROKEN) != 0, touches);
        broken += (info_of(network, s).flags & MSPRING_SPRING_BROKEN) != 0;
        expected += touches;
    }
    assert_true(expected >= 10 && broken == expected);
    support_point v[3];
    for (int i = 0; i < 3; i++) {
        v[i] = support_velocity(network, detached[i]);
    }
    support_steps(network, 10, 0.01);
    for (int i = 0; i < 3; i++) {
        assert_true(support_velocity(network, detached[i]).x == v[i].x);
        // Half a substep of 0.0025 s ago; 40 roundings of about 1 m/s.
        check_near(support_velocity(network, detached[i]).y, v[i].y - 9.8 * (0.1 - 0.00125), 1e-5);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void bad_lists_are_refused_and_change_nothing(void **state) {
    (void)state;
    recipe made = recipe_rows(11, 0, 1, 5);
    mspring_network *network = network_of(&made, MSPRING_SIMD_AUTO);
    const mspring_id bad[] = {0, 1, made.spring_count, 2}, worse[] = {MSPRING_NONE};
    check_error(mspring_network_break_springs(NULL, bad, 0, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_restore_springs(NULL, bad, 0, 1, 0), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_break_springs(network, bad, 0, MSPRING_ALL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_break_springs(network, NULL, 1, made.spring_count), MSPRING_ERROR_ID);
    check_error(mspring_network_restore_springs(network, NULL, 2, UINT32_MAX - 1, 0), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "4294967294 springs from id 2");
    check_error(mspring_network_detach_particles(network, NULL, made.particle_count + 1, MSPRING_ALL), MSPRING_ERROR_ID);
    check_ok(mspring_network_break_springs(network, NULL, 0, 0));
    check_ok(mspring_network_restore_springs(network, NULL, 0, 0, 0));
    check_error(mspring_network_break_springs(network, bad, 0, 4), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "index 2");
    check_error(mspring_network_restore_springs(network, bad, 0, 4, 0), MSPRING_ERROR_ID);
    check_error(mspring_network_break_springs(network, worse, 0, 1), MSPRING_ERROR_ID);
    support_spring_info info;
    check_ok(support_get_spring(network, 0, &info));
    assert_int_equal(info.flags, 0);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static uint32_t broken_of(const mspring_network *network) {
    uint32_t count = 0;
    for (mspring_id s = 0; s < mspring_network_count(network, MSPRING_SPRINGS); s++) {
        uint32_t flags;
        check_ok(mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, s, 1, &flags, 1));
        count += (flags & MSPRING_SPRING_BROKEN) != 0 && (flags & MSPRING_SPRING_REMOVED) == 0;
    }
    return count;
}

// first counts in a list, too. Ranges leave out what was removed, and a list that has it is refused.
static void lists_and_ranges_begin_at_first(void **state) {
    (void)state;
    recipe made = recipe_rows(11, 0, 1, 5);
    mspring_network *network = network_of(&made, MSPRING_SIMD_AUTO);
    const mspring_id list[] = {made.spring_count, 3, 4, 9};
    check_ok(mspring_network_break_springs(network, list, 1, 2));
    assert_int_equal(broken_of(network), 2);
    check_ok(mspring_network_remove_springs(network, &list[3], 0, 1));
    check_error(mspring_network_break_springs(network, list, 1, 3), MSPRING_ERROR_ID);
    check_contains(mspring_network_error(network), "spring 9");
    check_ok(mspring_network_break_springs(network, NULL, 0, MSPRING_ALL));
    assert_int_equal(broken_of(network), made.spring_count - 1);
    check_ok(mspring_network_restore_springs(network, NULL, 5, MSPRING_ALL, 0));
    assert_int_equal(broken_of(network), 5);
    check_ok(mspring_network_detach_particles(network, NULL, 0, MSPRING_ALL));
    assert_int_equal(broken_of(network), made.spring_count - 1);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void the_first_break_survives_every_failure(void **state) {
    (void)state;
    recipe made = recipe_rows(11, 0, 1, 5);
    const mspring_id spring = 17;
    size_t fail_at = 1;
    for (bool failed = true; failed; fail_at++) {
        watched_allocator watched = {0};
        mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def def = support_def(-9.8f, 4);
        def.allocator = &allocator;
        mspring_network *network = recipe_network(&made, &def);
        watched.fail_at = watched.calls + fail_at;
        mspring_result result = mspring_network_break_springs(network, &spring, 0, 1);
        failed = result != MSPRING_OK;
        support_spring_info info;
        if (failed) {
            check_error(result, MSPRING_ERROR_MEMORY);
            check_contains(mspring_network_error(network), "memory");
            check_ok(support_get_spring(network, spring, &info));
            assert_int_equal(info.flags, 0);
            check_ok(mspring_network_break_springs(network, &spring, 0, 1));
        }
        check_ok(support_get_spring(network, spring, &info));
        assert_int_equal(info.flags, MSPRING_SPRING_BROKEN);
        const size_t calls = watched.calls;
        check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 0));
        check_ok(mspring_network_break_springs(network, &spring, 0, 1));
        support_steps(network, 1, 0.01);
        assert_int_equal(watched.calls, calls);
        mspring_network_destroy(network);
        check_watched_clean(&watched);
    }
    assert_true(fail_at > 3); // the springs' values and the log
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_broken_spring_is_one_without_stiffness_and_damping),
        cmocka_unit_test(restoring_undoes_breaking),
        cmocka_unit_test(a_broken_spring_that_is_set_stays_broken),
        cmocka_unit_test(a_cut_rope_falls_in_two),
        cmocka_unit_test(a_ramp_takes_the_kick_out_of_restoring),
        cmocka_unit_test(a_ramp_is_even_and_ends),
        cmocka_unit_test(a_ramp_ends_with_its_last_step),
        cmocka_unit_test(a_ramp_begins_at_the_distance_of_its_ends),
        cmocka_unit_test(a_frame_of_before_a_ramp_takes_it_back),
        cmocka_unit_test(what_is_whole_stays_as_it_is),
        cmocka_unit_test(ramps_take_up_to_eleven_days),
        cmocka_unit_test(lists_of_none_take_no_memory),
        cmocka_unit_test(a_refused_step_does_not_move_a_ramp),
        cmocka_unit_test(a_detached_particle_flies_on_alone),
        cmocka_unit_test(bad_lists_are_refused_and_change_nothing),
        cmocka_unit_test(lists_and_ranges_begin_at_first),
        cmocka_unit_test(the_first_break_survives_every_failure),
    };
    return cmocka_run_group_tests_name("breaking", tests, NULL, NULL);
}

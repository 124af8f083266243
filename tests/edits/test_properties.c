/// @file test_properties.c
/// Properties: what is set can be read; strides and lists do the same as arrays; what is there already is left
/// alone.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "recipe.h"
#include "support.h"

#define DT (1.0 / 64)

#define WRITABLE ((int)MSPRING_RELAX_STRAIN + 1)
#define ALL ((int)MSPRING_ACTIVE_DAMPING + 1)
#define MOST 3000
#define MEASURES (ALL - WRITABLE)

static uint32_t count_of(const mspring_network *network, mspring_property property) {
    return property <= MSPRING_INVERSE_MASS_SCALE ? mspring_network_particle_count(network)
                                                  : mspring_network_spring_count(network);
}

/// Values that a property may have, another for each seed.
static void fill(mspring_property property, bool relative, float *values, uint32_t count, uint64_t seed) {
    const double stiffness = relative ? 0.05 : 200, damping = relative ? 0.01 : 1;
    const double low[WRITABLE] = {1, 0.5, stiffness, damping, 0.9, 1.5, 0.5, 0.1};
    for (uint32_t i = 0; i < count; i++) {
        values[i] = (float)support_random_between(&seed, low[property], 2 * low[property]);
    }
}

static uint64_t hash_after(mspring_network *network, uint32_t steps) {
    support_steps(network, steps, DT);
    return support_hash(network);
}

static void what_is_set_can_be_read(void **state) {
    (void)state;
    for (int relative = 0; relative < 2; relative++) {
        recipe made = recipe_rows(21, relative ? MSPRING_SPRING_RELATIVE : 0, 1, 5);
        mspring_network_def def = support_def(-9.8f, 4);
        mspring_network *network = recipe_network(&made, &def);
        static float values[MOST], read[MOST], wide[3 * MOST];
        static mspring_id ids[MOST];
        support_steps(network, 1, DT);
        for (mspring_property p = 0; p < WRITABLE; p++) {
            const uint32_t count = count_of(network, p);
            assert_true(count < MOST);
            fill(p, relative, values, count, 5);
            check_ok(mspring_network_set(network, p, 0, count, values, 1));
            check_ok(mspring_network_get(network, p, 0, count, read, 1));
            assert_memory_equal(read, values, count * sizeof *read);
            // A field of structs, a list from behind, and what lies between is left alone.
            for (uint32_t i = 0; i < count; i++) {
                wide[3 * i] = wide[3 * i + 1] = wide[3 * i + 2] = 7;
                ids[i] = count - 1 - i;
            }
            check_ok(mspring_network_get_at(network, p, ids, count, wide + 1, 3));
            for (uint32_t i = 0; i < count; i++) {
                assert_true(wide[3 * i + 1] == values[count - 1 - i] && wide[3 * i] == 7 && wide[3 * i + 2] == 7);
            }
            fill(p, relative, values, count, 6);
            for (uint32_t i = 0; i < count; i++) {
                wide[3 * i + 1] = values[ids[i]];
            }
            check_ok(mspring_network_set_at(network, p, ids, count, wide + 1, 3));
            check_ok(mspring_network_get(network, p, 0, count, read, 1));
            assert_memory_equal(read, values, count * sizeof *read);
            // One for all.
            check_ok(mspring_network_set(network, p, 1, count - 2, values, 0));
            check_ok(mspring_network_get(network, p, 0, count, read, 1));
            for (uint32_t i = 0; i < count; i++) {
                assert_true(read[i] == values[i == 0 || i == count - 1 ? i : 0]);
            }
            // The last value of an id counts.
            const mspring_id twice[] = {4, 4};
            const float other[] = {values[1], values[0]};
            check_ok(mspring_network_set_at(network, p, twice, 2, other, 1));
            check_ok(mspring_network_get_at(network, p, twice, 1, read, 1));
            assert_true(read[0] == values[0]);
        }
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/// INFINITY and all from MSPRING_NEVER on are one value: it is read as that, and to set one for another is no edit.
static void never_is_one_value(void **state) {
    (void)state;
    recipe made = recipe_rows(21, 0, 1, 5);
    mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = recipe_network(&made, &def);
    const float never[] = {MSPRING_NEVER, INFINITY}, some = 0.5f;
    const uint32_t count = mspring_network_spring_count(network);
    static float read[MOST];
    for (mspring_property p = MSPRING_BREAK_STRAIN; p <= MSPRING_STRESS_STRAIN; p++) {
        check_ok(mspring_network_get(network, p, 0, count, read, 1));
        assert_true(read[0] == MSPRING_NEVER && read[count - 1] == MSPRING_NEVER);
        check_ok(mspring_network_set(network, p, 0, 1, &some, 1));
        for (size_t i = 0; i < COUNT_OF(never); i++) {
            check_ok(mspring_network_set(network, p, 0, count, &never[i], 0));
            check_ok(mspring_network_get(network, p, 0, count, read, 1));
            assert_true(read[0] == MSPRING_NEVER && read[count - 1] == MSPRING_NEVER);
            uint8_t frame[1 << 16];
            size_t size;
            check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, frame, sizeof frame, &size));
            check_ok(mspring_network_set(network, p, 0, count, &never[1 - i], 0));
            check_ok(mspring_network_load(network, frame, size)); // a frame is refused after edits
        }
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void measured_ones_are_those_of_each_spring(void **state) {
    (void)state;
    recipe made = recipe_rows(21, 0, 1, 5);
    mspring_network_def def = support_def(-9.8f, 40);
    mspring_network *network = recipe_network(&made, &def);
    static float read[MEASURES][MOST], wide[2 * MOST];
    const uint32_t count = made.spring_count;
    const mspring_id broken[] = {3, 50, count - 1};
    check_ok(mspring_network_break_springs(network, broken, 3));
    support_steps(network, 3, DT);
    for (int viewed = 0; viewed < 2; viewed++) { // whoever has a view may have written to it
        float largest;
        mspring_id where = 0;
        for (int i = 0; i < MEASURES; i++) {
            check_ok(mspring_network_get(network, MSPRING_STRAIN + i, 0, count, read[i], 1));
            check_ok(mspring_network_get(network, MSPRING_STRAIN + i, 0, count, wide, 2));
            for (uint32_t s = 0; s < count; s++) {
                check_near(wide[2 * s], read[i][s], 2e-7 * (1 + fabs((double)read[i][s])));
            }
        }
        for (mspring_id s = 0; s < count; s++) {
            mspring_spring_info info = {.struct_size = sizeof info};
            float strain;
            check_ok(mspring_network_get_spring(network, s, &info));
            check_near(read[0][s], info.strain, 4e-7); // rounding of lengths
            check_near(read[1][s], info.length, 4e-7 * (double)info.length);
            assert_true(read[2][s] == info.force);
            assert_true(read[3][s] == info.stiffness && read[4][s] == info.damping);
            check_ok(mspring_network_get_at(network, MSPRING_STRAIN, &s, 1, &strain, 1));
            assert_true(strain == read[0][s]);
            where = fabsf(read[0][s]) > fabsf(read[0][where]) ? s : where;
        }
        mspring_id found;
        check_ok(mspring_network_max_strain(network, &largest, &found));
        assert_true(largest == fabsf(read[0][where]) && found == where);
        mspring_view view = {.struct_size = sizeof view};
        check_ok(mspring_network_view(network, &view));
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// Set every property to what it is.
static void set_what_is_there(mspring_network *network) {
    static float values[MOST];
    for (mspring_property p = 0; p < WRITABLE; p++) {
        const uint32_t count = count_of(network, p);
        check_ok(mspring_network_get(network, p, 0, count, values, 1));
        check_ok(mspring_network_set(network, p, 0, count, values, 1));
        for (mspring_id id = 0; id < count; id += 7) {
            check_ok(mspring_network_set_at(network, p, &id, 1, &values[id], 0));
        }
    }
}

static void what_is_there_is_left_alone(void **state) {
    (void)state;
    for (int relative = 0; relative < 2; relative++) {
        recipe made = recipe_rows(21, relative ? MSPRING_SPRING_RELATIVE : 0, 1, 5);
        mspring_network_def def = support_def(0, 4);
        def.global_damping = 20;
        def.sleep_speed = 0.01f;
        mspring_network *network = recipe_network(&made, &def), *twin = recipe_network(&made, &def);
        const mspring_id broken[] = {3, 50};
        check_ok(mspring_network_break_springs(network, broken, 2));
        check_ok(mspring_network_break_springs(twin, broken, 2));
        support_steps(network, 1, DT);
        support_steps(twin, 1, DT);
        set_what_is_there(network);
        assert_true(mspring_network_memory_used(network) == mspring_network_memory_used(twin));
        // It is no edit, so a frame of before fits.
        support_bring(twin, network, MSPRING_SNAPSHOT_FRAME);
        assert_true(hash_after(network, 10) == hash_after(twin, 10));
        support_fall_asleep(network, DT);
        set_what_is_there(network);
        support_steps(network, 1, DT);
        assert_true(mspring_network_is_asleep(network));
        // Another value of each does wake it, or for masses is seen by the next step.
        for (mspring_property p = MSPRING_STIFFNESS; p < WRITABLE; p++) {
            float value;
            check_ok(mspring_network_get(network, p, 60, 1, &value, 1));
            value = p == MSPRING_RELAX_STRAIN ? 0.1f : value < INFINITY ? 0.9f * value : 100.0f;
            check_ok(mspring_network_set(network, p, 60, 1, &value, 1));
            assert_false(mspring_network_is_asleep(network));
            support_fall_asleep(network, DT);
        }
        mspring_network_destroy(network);
        mspring_network_destroy(twin);
        recipe_free(&made);
    }
}

static void a_ramp_ends_even_at_the_length_that_it_has(void **state) {
    (void)state;
    recipe made = recipe_rows(21, 0, 1, 5);
    mspring_network_def def = support_def(0, 4);
    mspring_network *network = recipe_network(&made, &def);
    const mspring_id spring = 20;
    float before, during, after;
    check_ok(mspring_network_break_springs(network, &spring, 1));
    check_ok(mspring_network_restore_springs(network, &spring, 1, 10.0));
    support_steps(network, 1, DT);
    check_ok(mspring_network_get(network, MSPRING_ACTIVE_REST_LENGTH, spring, 1, &before, 1));
    support_steps(network, 1, DT);
    check_ok(mspring_network_get(network, MSPRING_ACTIVE_REST_LENGTH, spring, 1, &during, 1));
    assert_true(during != before);
    check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, spring, 1, &during, 1));
    support_steps(network, 5, DT);
    check_ok(mspring_network_get(network, MSPRING_ACTIVE_REST_LENGTH, spring, 1, &after, 1));
    assert_true(after == during);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void what_was_removed_has_nothing(void **state) {
    (void)state;
    recipe made = recipe_rows(21, 0, 1, 5);
    mspring_network_def def = support_def(0, 4);
    mspring_network *network = recipe_network(&made, &def);
    const mspring_id particle = 7;
    static float values[MOST];
    static mspring_id gone[ALL];
    check_ok(mspring_network_remove_particles(network, &particle, 1));
    for (mspring_property p = 0; p < ALL; p++) {
        const uint32_t count = count_of(network, p);
        check_ok(mspring_network_get(network, p, 0, count, values, 1));
        uint32_t removed = 0;
        for (mspring_id id = 0; id < count; id++) {
            const bool there = count == made.particle_count ? mspring_network_has_particle(network, id)
                                                            : mspring_network_has_spring(network, id);
            if (!there) {
                assert_true(values[id] == 0);
                gone[p] = id;
                removed++;
            }
        }
        assert_true(removed > 0);
        check_error(mspring_network_get_at(network, p, &gone[p], 1, values, 1), MSPRING_ERROR_ID);
        if (p < WRITABLE) { // what was read can be written, though 0 is no value of some
            check_ok(mspring_network_set(network, p, 0, count, values, 1));
            check_error(mspring_network_set_at(network, p, &gone[p], 1, values, 1), MSPRING_ERROR_ID);
        }
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void refused_ones_are_named(void **state) {
    (void)state;
    recipe made = recipe_rows(21, 0, 1, 5);
    mspring_network_def def = support_def(0, 4);
    mspring_network *network = recipe_network(&made, &def);
    static const char *const names[WRITABLE] = {"mass",          "scale of inverse mass", "stiffness",
                                                "damping",       "rest length",           "break strain",
                                                "stress strain", "relax strain"};
    const float bad[] = {NAN, -2, -INFINITY};
    const uint64_t hash = support_hash(network);
    float values[3], kept[MOST], read[MOST];
    for (mspring_property p = 0; p < WRITABLE; p++) {
        const uint32_t count = count_of(network, p);
        check_ok(mspring_network_get(network, p, 0, count, kept, 1));
        for (size_t i = 0; i < COUNT_OF(bad); i++) {
            fill(p, false, values, 3, 9);
            values[1] = bad[i];
            check_error(mspring_network_set(network, p, 10, 3, values, 1), MSPRING_ERROR_ARGUMENT);
            check_contains(mspring_network_error(network), names[p]);
            check_contains(mspring_network_error(network), " 11:");
            check_error(mspring_network_set(network, p, 10, 3, &bad[i], 0), MSPRING_ERROR_ARGUMENT);
            check_contains(mspring_network_error(network), " 10:");
            check_error(mspring_network_set_at(network, p, (const mspring_id[]){4, 2, 9}, 3, values, 1),
                        MSPRING_ERROR_ARGUMENT);
            check_contains(mspring_network_error(network), " 2:");
        }
        check_ok(mspring_network_get(network, p, 0, count, read, 1));
        assert_memory_equal(read, kept, count * sizeof *read);
        check_error(mspring_network_get(network, p, 0, 1, read, 0), MSPRING_ERROR_ARGUMENT);
        check_ok(mspring_network_set(network, p, 0, 0, NULL, 1));
        check_ok(mspring_network_set_at(network, p, NULL, 0, NULL, 1));
        check_ok(mspring_network_get(network, p, count, 0, NULL, 0));
    }
    for (mspring_property p = MSPRING_STRAIN; p < ALL; p++) {
        check_error(mspring_network_set(network, p, 0, 1, kept, 1), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "can only be read");
    }
    check_error(mspring_network_set(network, (mspring_property)(MSPRING_ACTIVE_REST_LENGTH + 1), 0, 1, kept, 1),
                MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "no property 18");
    assert_true(support_hash(network) == hash);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// A spring between a pinned particle and one that is moved to strain it.
static void strain_to(mspring_network *network, double strain) {
    const double x = 1 + strain, y = 0;
    check_ok(mspring_network_set_positions(network, 1, 1, &x, &y, 1));
    support_steps(network, 1, 1e-6);
}

static uint32_t read_kind(mspring_network *network) {
    mspring_event event;
    uint32_t count;
    check_ok(mspring_network_read_events(network, &event, 1, &count, NULL));
    return count == 1 ? (uint32_t)event.kind : UINT32_MAX;
}

static void springs_relax_at_strains_of_their_own(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id a = support_pinned(builder, 0, 0, 1), b = support_particle(builder, 1, 0, 1);
    support_spring(builder, a, b, 0, 0);
    mspring_network_def def = support_def(0, 1);
    mspring_network *network = support_network(builder, &def);
    const float stress = 0.5f;
    check_ok(mspring_network_reserve_events(network, 8));
    check_ok(mspring_network_set(network, MSPRING_STRESS_STRAIN, 0, 1, &stress, 1));
    // At which strains it relaxes, and just does not: by the network's fraction, its own, never, no later than at
    // the stress strain.
    const struct {
        float relax;
        double above, below;
    } cases[] = {{MSPRING_RELAX_STRAIN_DEFAULT, 0.41, 0.39}, {0.25f, 0.26, 0.24}, {0, 0.3, -1}, {9, 0.51, 0.49}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        check_ok(mspring_network_set(network, MSPRING_RELAX_STRAIN, 0, 1, &cases[i].relax, 1));
        strain_to(network, 0.6);
        assert_int_equal(read_kind(network), MSPRING_EVENT_STRESSED);
        strain_to(network, cases[i].above);
        assert_int_equal(read_kind(network), UINT32_MAX);
        // A copy and a snapshot have it, too.
        mspring_network *clone;
        check_ok(mspring_network_clone(network, NULL, &clone));
        support_bring(network, clone, MSPRING_SNAPSHOT_ALL);
        strain_to(clone, cases[i].below > 0 ? cases[i].below : 0);
        assert_int_equal(read_kind(clone), cases[i].below > 0 ? MSPRING_EVENT_RELAXED : UINT32_MAX);
        mspring_network_destroy(clone);
        const float now = 8;
        check_ok(mspring_network_set(network, MSPRING_RELAX_STRAIN, 0, 1, &now, 1));
        strain_to(network, 0);
        assert_int_equal(read_kind(network), MSPRING_EVENT_RELAXED);
    }
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_set_can_be_read),
        cmocka_unit_test(never_is_one_value),
        cmocka_unit_test(measured_ones_are_those_of_each_spring),
        cmocka_unit_test(what_is_there_is_left_alone),
        cmocka_unit_test(a_ramp_ends_even_at_the_length_that_it_has),
        cmocka_unit_test(what_was_removed_has_nothing),
        cmocka_unit_test(refused_ones_are_named),
        cmocka_unit_test(springs_relax_at_strains_of_their_own),
    };
    return cmocka_run_group_tests_name("properties", tests, NULL, NULL);
}

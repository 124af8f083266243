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

#define MOST 3000

/// Properties that can be written, what messages call them, and a value of each.
static const struct {
    mspring_property property;
    const char *name;
    double low, relative_low;
} writable[] = {
    {MSPRING_MASS, "mass", 1, 1},
    {MSPRING_INVERSE_MASS_SCALE, "scale of inverse mass", 0.5, 0.5},
    {MSPRING_STIFFNESS, "stiffness", 200, 0.05},
    {MSPRING_DAMPING, "damping", 1, 0.01},
    {MSPRING_REST_LENGTH, "rest length", 0.9, 0.9},
    {MSPRING_BREAK_STRAIN, "break strain", 1.5, 1.5},
    {MSPRING_WARN_STRAIN, "warn strain", 0.5, 0.5},
    {MSPRING_RELAX_STRAIN, "relax strain", 0.1, 0.1},
};
static const mspring_property measures[] = {MSPRING_STRAIN,           MSPRING_LENGTH,
                                            MSPRING_TENSION,          MSPRING_ACTIVE_STIFFNESS,
                                            MSPRING_ACTIVE_DAMPING,   MSPRING_DIRECTION_X,
                                            MSPRING_DIRECTION_Y,      MSPRING_ACTIVE_REST_LENGTH};
#define WRITABLE COUNT_OF(writable)
#define MEASURES COUNT_OF(measures)

static uint32_t count_of(const mspring_network *network, mspring_property property) {
    return mspring_network_count(network, (mspring_kind)(property >> 8));
}

/// Values that a property may have, another for each seed.
static void fill(size_t which, bool relative, float *values, uint32_t count, uint64_t seed) {
    const double low = relative ? writable[which].relative_low : writable[which].low;
    for (uint32_t i = 0; i < count; i++) {
        values[i] = (float)support_random_between(&seed, low, 2 * low);
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
        for (size_t w = 0; w < WRITABLE; w++) {
            const mspring_property p = writable[w].property;
            const uint32_t count = count_of(network, p);
            assert_true(count < MOST);
            fill(w, relative, values, count, 5);
            check_ok(mspring_network_set(network, p, NULL, 0, count, values, 1));
            check_ok(mspring_network_get(network, p, NULL, 0, count, read, 1));
            assert_memory_equal(read, values, count * sizeof *read);
            // A field of structs, a list from behind, and what lies between is left alone.
            for (uint32_t i = 0; i < count; i++) {
                wide[3 * i] = wide[3 * i + 1] = wide[3 * i + 2] = 7;
                ids[i] = count - 1 - i;
            }
            check_ok(mspring_network_get(network, p, ids, 0, count, wide + 1, 3));
            for (uint32_t i = 0; i < count; i++) {
                assert_true(wide[3 * i + 1] == values[count - 1 - i] && wide[3 * i] == 7 && wide[3 * i + 2] == 7);
            }
            fill(w, relative, values, count, 6);
            for (uint32_t i = 0; i < count; i++) {
                wide[3 * i + 1] = values[ids[i]];
            }
            check_ok(mspring_network_set(network, p, ids, 0, count, wide + 1, 3));
            check_ok(mspring_network_get(network, p, NULL, 0, count, read, 1));
            assert_memory_equal(read, values, count * sizeof *read);
            // One for all.
            check_ok(mspring_network_set(network, p, NULL, 1, count - 2, values, 0));
            check_ok(mspring_network_get(network, p, NULL, 0, count, read, 1));
            for (uint32_t i = 0; i < count; i++) {
                assert_true(read[i] == values[i == 0 || i == count - 1 ? i : 0]);
            }
            // The last value of an id counts.
            const mspring_id twice[] = {4, 4};
            const float other[] = {values[1], values[0]};
            check_ok(mspring_network_set(network, p, twice, 0, 2, other, 1));
            check_ok(mspring_network_get(network, p, twice, 0, 1, read, 1));
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
    const uint32_t count = mspring_network_count(network, MSPRING_SPRINGS);
    static float read[MOST];
    for (mspring_property p = MSPRING_BREAK_STRAIN; p <= MSPRING_WARN_STRAIN; p++) {
        check_ok(mspring_network_get(network, p, NULL, 0, count, read, 1));
        assert_true(read[0] == MSPRING_NEVER && read[count - 1] == MSPRING_NEVER);
        check_ok(mspring_network_set(network, p, NULL, 0, 1, &some, 1));
        for (size_t i = 0; i < COUNT_OF(never); i++) {
            check_ok(mspring_network_set(network, p, NULL, 0, count, &never[i], 0));
            check_ok(mspring_network_get(network, p, NULL, 0, count, read, 1));
            assert_true(read[0] == MSPRING_NEVER && read[count - 1] == MSPRING_NEVER);
            uint8_t frame[1 << 16];
            size_t size;
            check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, frame, sizeof frame, &size));
            check_ok(mspring_network_set(network, p, NULL, 0, count, &never[1 - i], 0));
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
    check_ok(mspring_network_break_springs(network, broken, 0, 3));
    support_steps(network, 3, DT);
    for (int viewed = 0; viewed < 2; viewed++) { // a view changes nothing
        float largest;
        mspring_id where = 0;
        for (size_t i = 0; i < MEASURES; i++) {
            check_ok(mspring_network_get(network, measures[i], NULL, 0, count, read[i], 1));
            check_ok(mspring_network_get(network, measures[i], NULL, 0, count, wide, 2));
            for (uint32_t s = 0; s < count; s++) {
                check_near(wide[2 * s], read[i][s], 2e-7 * (1 + fabs((double)read[i][s])));
            }
        }
        for (mspring_id s = 0; s < count; s++) {
            support_spring_info info;
            float strain;
            check_ok(support_get_spring(network, s, &info));
            check_near(read[0][s], info.strain, 4e-7); // rounding of lengths
            check_near(read[1][s], info.length, 4e-7 * (double)info.length);
            assert_true(read[2][s] == info.force);
            assert_true(read[3][s] == info.stiffness && read[4][s] == info.damping);
            check_ok(mspring_network_get(network, MSPRING_STRAIN, &s, 0, 1, &strain, 1));
            assert_true(strain == read[0][s]);
            where = fabsf(read[0][s]) > fabsf(read[0][where]) ? s : where;
        }
        mspring_id found;
        check_ok(support_get_max_strain(network, &largest, &found));
        assert_true(largest == fabsf(read[0][where]) && found == where);
        mspring_view view = {.struct_size = sizeof view};
        check_ok(mspring_network_get_view(network, &view));
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// Set every property to what it is.
static void set_what_is_there(mspring_network *network) {
    static float values[MOST];
    for (size_t w = 0; w < WRITABLE; w++) {
        const mspring_property p = writable[w].property;
        const uint32_t count = count_of(network, p);
        check_ok(mspring_network_get(network, p, NULL, 0, count, values, 1));
        check_ok(mspring_network_set(network, p, NULL, 0, count, values, 1));
        for (mspring_id id = 0; id < count; id += 7) {
            check_ok(mspring_network_set(network, p, &id, 0, 1, &values[id], 0));
        }
    }
}

static void what_is_there_is_left_alone(void **state) {
    (void)state;
    for (int relative = 0; relative < 2; relative++) {
        recipe made = recipe_rows(21, relative ? MSPRING_SPRING_RELATIVE : 0, 1, 5);
        mspring_network_def def = support_def(0, 4);
        def.settings.global_damping = 20;
        def.settings.sleep_speed = 0.01f;
        mspring_network *network = recipe_network(&made, &def), *twin = recipe_network(&made, &def);
        const mspring_id broken[] = {3, 50};
        check_ok(mspring_network_break_springs(network, broken, 0, 2));
        check_ok(mspring_network_break_springs(twin, broken, 0, 2));
        support_steps(network, 1, DT);
        support_steps(twin, 1, DT);
        set_what_is_there(network);
        assert_true(support_memory_used(network) == support_memory_used(twin));
        // It is no edit, so a frame of before fits.
        support_bring(twin, network, MSPRING_SNAPSHOT_FRAME);
        assert_true(hash_after(network, 10) == hash_after(twin, 10));
        support_fall_asleep(network, DT);
        set_what_is_there(network);
        support_steps(network, 1, DT);
        assert_true(support_is_asleep(network));
        // Another value of each does wake it, or for masses is seen by the next step.
        for (mspring_property p = MSPRING_STIFFNESS; p <= MSPRING_RELAX_STRAIN; p++) {
            float value;
            check_ok(mspring_network_get(network, p, NULL, 60, 1, &value, 1));
            value = p == MSPRING_RELAX_STRAIN ? 0.1f : value < INFINITY ? 0.9f * value : 100.0f;
            check_ok(mspring_network_set(network, p, NULL, 60, 1, &value, 1));
            assert_false(support_is_asleep(network));
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
    check_ok(mspring_network_break_springs(network, &spring, 0, 1));
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 10.0));
    support_steps(network, 1, DT);
    check_ok(mspring_network_get(network, MSPRING_ACTIVE_REST_LENGTH, NULL, spring, 1, &before, 1));
    support_steps(network, 1, DT);
    check_ok(mspring_network_get(network, MSPRING_ACTIVE_REST_LENGTH, NULL, spring, 1, &during, 1));
    assert_true(during != before);
    check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, spring, 1, &during, 1));
    support_steps(network, 5, DT);
    check_ok(mspring_network_get(network, MSPRING_ACTIVE_REST_LENGTH, NULL, spring, 1, &after, 1));
    assert_true(after == during);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// Thresholds leave a ramp as it is; plastic strain is a rest length, and ends it.
static void thresholds_leave_ramps_alone(void **state) {
    (void)state;
    const mspring_property set[] = {MSPRING_BREAK_STRAIN, MSPRING_WARN_STRAIN, MSPRING_RELAX_STRAIN,
                                    MSPRING_HARDENING, MSPRING_PLASTIC_STRAIN};
    const size_t known = mspring_features() & MSPRING_FEATURE_LAWS ? COUNT_OF(set) : 2;
    recipe made = recipe_rows(21, 0, 1, 5);
    mspring_network_def def = support_def(0, 4);
    mspring_network *network = recipe_network(&made, &def), *twin = NULL;
    const mspring_id spring = 20;
    const float value = 0.5f;
    check_ok(mspring_network_break_springs(network, &spring, 0, 1));
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 10.0));
    support_steps(network, 1, DT);
    check_ok(mspring_network_clone(network, NULL, &twin));
    for (size_t i = 0; i < known; i++) {
        float length = 0, expected = 0, before = 0;
        check_ok(mspring_network_set(network, set[i], NULL, spring, 1, &value, 1));
        check_ok(mspring_network_get(network, MSPRING_ACTIVE_REST_LENGTH, NULL, spring, 1, &before, 1));
        support_steps(network, 1, DT);
        support_steps(twin, 1, DT);
        check_ok(mspring_network_get(network, MSPRING_ACTIVE_REST_LENGTH, NULL, spring, 1, &length, 1));
        check_ok(mspring_network_get(twin, MSPRING_ACTIVE_REST_LENGTH, NULL, spring, 1, &expected, 1));
        assert_true(set[i] == MSPRING_PLASTIC_STRAIN ? length == before : length == expected && length != before);
    }
    mspring_network_destroy(network);
    mspring_network_destroy(twin);
    recipe_free(&made);
}

static void what_was_removed_has_nothing(void **state) {
    (void)state;
    recipe made = recipe_rows(21, 0, 1, 5);
    mspring_network_def def = support_def(0, 4);
    mspring_network *network = recipe_network(&made, &def);
    const mspring_id particle = 7;
    static float values[MOST];
    check_ok(mspring_network_remove_particles(network, &particle, 0, 1));
    for (size_t i = 0; i < WRITABLE + MEASURES; i++) {
        const mspring_property p = i < WRITABLE ? writable[i].property : measures[i - WRITABLE];
        mspring_id gone = MSPRING_NONE;
        const uint32_t count = count_of(network, p);
        check_ok(mspring_network_get(network, p, NULL, 0, count, values, 1));
        uint32_t removed = 0;
        for (mspring_id id = 0; id < count; id++) {
            const bool there = count == made.particle_count ? support_has_particle(network, id)
                                                            : support_has_spring(network, id);
            if (!there) {
                assert_true(values[id] == 0);
                gone = id;
                removed++;
            }
        }
        assert_true(removed > 0);
        check_error(mspring_network_get(network, p, &gone, 0, 1, values, 1), MSPRING_ERROR_ID);
        if (i < WRITABLE) { // what was read can be written, though 0 is no value of some
            check_ok(mspring_network_set(network, p, NULL, 0, count, values, 1));
            check_error(mspring_network_set(network, p, &gone, 0, 1, values, 1), MSPRING_ERROR_ID);
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
    const float bad[] = {NAN, -2, -INFINITY};
    const uint64_t hash = support_hash(network);
    float values[3], kept[MOST], read[MOST];
    for (size_t w = 0; w < WRITABLE; w++) {
        const mspring_property p = writable[w].property;
        const uint32_t count = count_of(network, p);
        check_ok(mspring_network_get(network, p, NULL, 0, count, kept, 1));
        for (size_t i = 0; i < COUNT_OF(bad); i++) {
            fill(w, false, values, 3, 9);
            values[1] = bad[i];
            check_error(mspring_network_set(network, p, NULL, 10, 3, values, 1), MSPRING_ERROR_ARGUMENT);
            check_contains(mspring_network_error(network), writable[w].name);
            check_contains(mspring_network_error(network), " 11:");
            check_error(mspring_network_set(network, p, NULL, 10, 3, &bad[i], 0), MSPRING_ERROR_ARGUMENT);
            check_contains(mspring_network_error(network), " 10:");
            check_error(mspring_network_set(network, p, (const mspring_id[]){4, 2, 9}, 0, 3, values, 1),
                        MSPRING_ERROR_ARGUMENT);
            check_contains(mspring_network_error(network), " 2:");
        }
        check_ok(mspring_network_get(network, p, NULL, 0, count, read, 1));
        assert_memory_equal(read, kept, count * sizeof *read);
        check_error(mspring_network_get(network, p, NULL, 0, 1, read, 0), MSPRING_ERROR_ARGUMENT);
        check_ok(mspring_network_set(network, p, NULL, 0, 0, NULL, 1));
        check_ok(mspring_network_set(network, p, NULL, 0, 0, NULL, 1));
        check_ok(mspring_network_get(network, p, NULL, count, 0, NULL, 0));
    }
    for (size_t i = 0; i < MEASURES; i++) {
        check_error(mspring_network_set(network, measures[i], NULL, 0, 1, kept, 1), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "can only be read");
    }
    check_error(
        mspring_network_set(network, (mspring_property)(MSPRING_ACTIVE_REST_LENGTH + 1), NULL, 0, 1, kept, 1),
        MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "no property 0x118");
    assert_true(support_hash(network) == hash);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// Several columns in one pass are those of a call each, of a range and of a list from its second place on.
static void columns_are_those_of_single_calls(void **state) {
    (void)state;
    recipe made = recipe_rows(21, 0, 1, 5);
    mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = recipe_network(&made, &def);
    static float single[MOST], fields[MEASURES][MOST];
    static uint32_t flags[MOST], ends[2 * MOST];
    const mspring_id removed = 9, list[] = {removed, 50, 4, made.spring_count - 1};
    check_ok(mspring_network_remove_springs(network, &removed, 0, 1));
    support_steps(network, 3, DT);
    for (int listed = 0; listed < 2; listed++) {
        const mspring_id *ids = listed ? list : NULL;
        const uint32_t first = 1, count = listed ? 3 : made.spring_count - 1;
        mspring_column columns[MEASURES + 3];
        for (size_t i = 0; i < MEASURES; i++)
            columns[i] = (mspring_column){measures[i], 1, fields[i]};
        columns[MEASURES] = (mspring_column){MSPRING_SPRING_FLAGS, 1, flags};
        columns[MEASURES + 1] = (mspring_column){MSPRING_END_A, 2, ends};
        columns[MEASURES + 2] = (mspring_column){MSPRING_END_B, 2, ends + 1};
        check_ok(mspring_network_get_columns(network, ids, first, count, columns, COUNT_OF(columns)));
        for (size_t i = 0; i < MEASURES; i++) {
            check_ok(mspring_network_get(network, measures[i], ids, first, count, single, 1));
            assert_memory_equal(single, fields[i], count * sizeof *single);
        }
        for (uint32_t i = 0; i < count; i++) {
            const mspring_id s = listed ? list[first + i] : first + i;
            const bool there = s != removed;
            assert_int_equal(flags[i], there ? 0 : MSPRING_SPRING_REMOVED | MSPRING_SPRING_BROKEN);
            assert_int_equal(ends[2 * i], there ? made.springs[s].a : MSPRING_NONE);
            assert_int_equal(ends[2 * i + 1], there ? made.springs[s].b : MSPRING_NONE);
        }
    }
    check_ok(mspring_network_get_columns(network, NULL, 0, 5, NULL, 0));
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// Floats and integers have calls of their own. One value for all needs no count.
static void calls_have_their_kind_of_number(void **state) {
    (void)state;
    recipe made = recipe_rows(21, 0, 1, 5);
    mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = recipe_network(&made, &def);
    uint32_t integer = 5;
    float number = 5, read[2];
    check_error(mspring_network_get(network, MSPRING_SPRING_FLAGS, NULL, 0, 1, &number, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set(network, MSPRING_SPRING_FLAGS, NULL, 0, 1, &number, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_integers(network, MSPRING_MASS, NULL, 0, 1, &integer, 1),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set_integers(network, MSPRING_MASS, NULL, 0, 1, &integer, 1),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set_integers(network, MSPRING_END_A, NULL, 0, 1, &integer, 1),
                MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "can only be read");
    assert_true(integer == 5 && number == 5);
    check_ok(mspring_network_set(network, MSPRING_MASS, NULL, 3, MSPRING_ALL, &number, 0));
    const mspring_id ends[] = {2, made.particle_count - 1};
    check_ok(mspring_network_get(network, MSPRING_MASS, ends, 0, 2, read, 1));
    assert_true(read[0] == made.particles[2].mass && read[1] == 5);
    check_error(mspring_network_set(network, MSPRING_MASS, NULL, 3, MSPRING_ALL, &number, 1),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set(network, MSPRING_MASS, ends, 0, MSPRING_ALL, &number, 0),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set(network, MSPRING_MASS, NULL, made.particle_count + 1, MSPRING_ALL, &number, 0),
                MSPRING_ERROR_ID);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// A spring between a pinned particle and one that is moved to strain it.
static void strain_to(mspring_network *network, double strain) {
    const double x = 1 + strain, y = 0;
    check_ok(mspring_network_set_positions(network, NULL, 1, 1, &x, &y, 1));
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
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, 1, &stress, 1));
    // At which strains it relaxes, and just does not: by the network's fraction, its own, never, no later than at
    // the stress strain.
    const struct {
        float relax;
        double above, below;
    } cases[] = {{MSPRING_RELAX_STRAIN_DEFAULT, 0.41, 0.39}, {0.25f, 0.26, 0.24}, {0, 0.3, -1}, {9, 0.51, 0.49}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        check_ok(mspring_network_set(network, MSPRING_RELAX_STRAIN, NULL, 0, 1, &cases[i].relax, 1));
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
        check_ok(mspring_network_set(network, MSPRING_RELAX_STRAIN, NULL, 0, 1, &now, 1));
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
        cmocka_unit_test(thresholds_leave_ramps_alone),
        cmocka_unit_test(what_was_removed_has_nothing),
        cmocka_unit_test(refused_ones_are_named),
        cmocka_unit_test(columns_are_those_of_single_calls),
        cmocka_unit_test(calls_have_their_kind_of_number),
        cmocka_unit_test(springs_relax_at_strains_of_their_own),
    };
    return cmocka_run_group_tests_name("properties", tests, NULL, NULL);
}

/// @file test_sent.c
/// Values that the host sends again: only a comparison, unless something else has changed them since.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"

#define DT (1.0 / 64)
#define MOST 3000
#define FIRST ((int)MSPRING_STIFFNESS)
#define END ((int)MSPRING_RELAX_STRAIN + 1)

static float values[MOST], others[MOST], read[MOST];

static mspring_network *lattice(recipe *made, const mspring_network_def *def) {
    *made = recipe_rows(21, 0, 1, 5);
    assert_true(made->spring_count < MOST);
    return recipe_network(made, def);
}

static float value_of(mspring_property property, uint64_t *seed) {
    static const double low[END - FIRST] = {200, 1, 0.9, 1.5, 0.5, 0.1};
    const double least = low[property - FIRST];
    return (float)support_random_between(seed, least, 1.2 * least);
}

static void fill(mspring_property property, float *to, uint64_t seed) {
    for (uint32_t i = 0; i < MOST; i++) {
        to[i] = value_of(property, &seed);
    }
}

static void send(mspring_network *network, mspring_property property, const float *from) {
    check_ok(
        mspring_network_set(network, property, NULL, 0, mspring_network_count(network, MSPRING_SPRINGS), from, 1));
}

static void check_has(const mspring_network *network, mspring_property property, const float *expected) {
    const uint32_t count = mspring_network_count(network, MSPRING_SPRINGS);
    check_ok(mspring_network_get(network, property, NULL, 0, count, read, 1));
    assert_memory_equal(read, expected, count * sizeof *read);
}

/// Values of all springs that the network compares with from now on.
static void send_twice(mspring_network *network, mspring_property property) {
    fill(property, values, 5);
    send(network, property, values);
    send(network, property, values);
}

/// The second call for a range makes a copy, later ones do not. Without memory for it the call succeeds.
static void a_copy_is_made_once(void **state) {
    (void)state;
    for (mspring_property p = FIRST; p < END; p++) {
        for (int fails = 0; fails < 2; fails++) {
            recipe made;
            watched_allocator watched = {0};
            const mspring_allocator allocator = watched_interface(&watched);
            mspring_network_def def = support_def(0, 4);
            def.allocator = &allocator;
            mspring_network *network = lattice(&made, &def);
            fill(p, values, 5);
            send(network, p, values);
            const uint64_t before = support_memory_used(network);
            watched.fail_at = fails ? watched.calls + 1 : 0;
            send(network, p, values);
            const uint64_t after = support_memory_used(network);
            // 64 bytes: the allocator's header, and rounding up
            assert_true(fails ? after == before
                              : after > before && after <= before + sizeof(float) * made.spring_count + 128);
            watched.fail_at = 0;
            for (int i = 0; i < 3; i++) {
                send(network, p, values);
            }
            assert_true(fails || support_memory_used(network) == after);
            check_has(network, p, values);
            mspring_network_destroy(network);
            check_watched_clean(&watched);
            recipe_free(&made);
        }
    }
}

/// Ranges, lists, strides and one value for all, of equal and other values, do what calls too small for a copy do.
static void it_does_what_small_calls_do(void **state) {
    (void)state;
    recipe made;
    mspring_network_def def = support_def(-9.8f, 4);
    def.spare_springs = 8;
    mspring_network *network = lattice(&made, &def), *twin = recipe_network(&made, &def);
    uint64_t seed = 11;
    static float wide[3 * MOST];
    for (mspring_property p = FIRST; p < END; p++) {
        const uint32_t count = made.spring_count;
        fill(p, values, p);
        for (int round = 0; round < SAMPLE(200); round++) {
            const uint32_t first = (uint32_t)(support_random(&seed) % count), kind = support_random(&seed) % 8;
            const uint32_t length =
                kind < 4 ? count - first : 1 + (uint32_t)(support_random(&seed) % (count - first));
            const uint32_t start = kind < 4 ? 0 : first, stride = kind % 4 == 1 ? 3 : kind == 7 ? 0 : 1;
            const uint32_t number = kind < 4 ? count : length;
            if (round % 3 == 0) {
                values[support_random(&seed) % count] = value_of(p, &seed);
            }
            for (uint32_t i = 0; i < number; i++) {
                wide[(size_t)i * stride] = values[start + i];
            }
            if (kind == 6) { // the last value of an id counts
                const mspring_id twice[] = {first, 0, first};
                const float three[] = {value_of(p, &seed), values[0], values[first]};
                check_ok(mspring_network_set(network, p, twice, 0, 3, three, 1));
                check_ok(mspring_network_set(twin, p, twice, 0, 3, three, 1));
            } else {
                check_ok(mspring_network_set(network, p, NULL, start, number, wide, stride));
                for (uint32_t i = 0; i < number; i++) {
                    check_ok(mspring_network_set(twin, p, NULL, start + i, 1, &wide[(size_t)i * stride], 1));
                }
            }
            check_ok(mspring_network_get(twin, p, NULL, 0, count, others, 1));
            check_has(network, p, others);
        }
        support_steps(network, 1, DT);
        support_steps(twin, 1, DT);
        assert_true(support_hash(network) == support_hash(twin));
    }
    mspring_network_destroy(network);
    mspring_network_destroy(twin);
    recipe_free(&made);
}

/// What lies between the values of a stride was not sent, so it counts when it is.
static void what_lies_between_was_not_sent(void **state) {
    (void)state;
    static float wide[3 * MOST];
    recipe made;
    const mspring_network_def def = support_def(0, 4);
    mspring_network *network = lattice(&made, &def);
    uint64_t seed = 4;
    for (mspring_property p = FIRST; p < END; p++) {
        for (size_t i = 0; i < COUNT_OF(wide); i++)
            wide[i] = value_of(p, &seed);
        for (int again = 0; again < 3; again++)
            check_ok(mspring_network_set(network, p, NULL, 0, made.spring_count, wide, 3));
        send(network, p, wide);
        check_has(network, p, wide);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// A failed call changes nothing, neither the network nor what it compares with.
static void what_is_no_value_is_refused(void **state) {
    (void)state;
    static const float bad[] = {NAN, -2, -INFINITY};
    recipe made;
    mspring_network_def def = support_def(0, 4);
    mspring_network *network = lattice(&made, &def);
    const uint32_t count = made.spring_count;
    for (mspring_property p = FIRST; p < END; p++) {
        send_twice(network, p);
        memcpy(others, values, sizeof others);
        for (size_t i = 0; i < COUNT_OF(bad); i++) {
            others[count - 7] = bad[i];
            others[3] = value_of(p, &(uint64_t){i});
            for (int again = 0; again < 2; again++) {
                check_error(mspring_network_set(network, p, NULL, 0, count, others, 1), MSPRING_ERROR_ARGUMENT);
            }
            check_has(network, p, values);
        }
        check_error(mspring_network_set(network, p, NULL, 1, count, values, 1), MSPRING_ERROR_ID);
        check_error(mspring_network_set(network, p, (const mspring_id[]){2, count}, 0, 2, values + 2, 1),
                    MSPRING_ERROR_ID);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// 0 is 0, and -0 is: no edit, so that a frame of before fits.
static void a_negative_zero_changes_nothing(void **state) {
    (void)state;
    const mspring_property properties[] = {MSPRING_DAMPING, MSPRING_REST_LENGTH, MSPRING_RELAX_STRAIN};
    for (size_t i = 0; i < 2 * COUNT_OF(properties); i++) {
        const mspring_property p = properties[i / 2];
        recipe made;
        mspring_network_def def = support_def(0, 4);
        mspring_network *network = lattice(&made, &def);
        fill(p, values, 5);
        values[9] = 0;
        send(network, p, values);
        send(network, p, values);
        mspring_network *twin = NULL;
        check_ok(mspring_network_clone(network, NULL, &twin));
        values[9] = i % 2 == 0 ? 0.0f : -0.0f;
        check_ok(mspring_network_set(twin, p, NULL, 9, 1, &values[9], 1));
        check_ok(mspring_network_set(twin, p, &(mspring_id){9}, 0, 1, &values[9], 1));
        send(twin, p, values);
        send(twin, p, values);
        support_bring(network, twin, MSPRING_SNAPSHOT_FRAME);
        mspring_network_destroy(network);
        mspring_network_destroy(twin);
        recipe_free(&made);
    }
}

/// Values that were sent are set again after anything else has changed them.
static void it_sees_other_changes(void **state) {
    (void)state;
    for (mspring_property p = FIRST; p < END; p++) {
        recipe made;
        mspring_network_def def = support_def(0, 4);
        def.spare_springs = 4;
        mspring_network *network = lattice(&made, &def), *other = recipe_network(&made, &def), *clone = NULL;
        const mspring_id list[] = {5, 90}, spring = 40;
        fill(p, others, 77);
        send(other, p, others);
        send_twice(network, p);
        check_ok(mspring_network_set(network, p, list, 0, 2, others, 1));
        send(network, p, values);
        check_has(network, p, values);
        support_bring(other, network, MSPRING_SNAPSHOT_ALL);
        check_has(network, p, others);
        send(network, p, values);
        check_has(network, p, values);
        check_ok(mspring_network_clone(network, NULL, &clone));
        send(clone, p, others);
        check_has(network, p, values);
        send(network, p, values);
        check_has(network, p, values);
        mspring_network_destroy(clone);
        // A value of a spring that is not there is ignored, until there is one again.
        mspring_id id, again;
        check_ok(mspring_network_remove_springs(network, &spring, 0, 1));
        check_ok(mspring_network_add_springs(network, &made.springs[spring], 1, &id));
        check_ok(mspring_network_remove_springs(network, &id, 0, 1));
        values[id] = NAN;
        send(network, p, values);
        send(network, p, values);
        check_ok(mspring_network_reuse_ids(network));
        check_ok(mspring_network_add_springs(network, &made.springs[spring], 1, &again));
        assert_int_equal(again, id);
        check_error(mspring_network_set(network, p, NULL, 0, id + 1, values, 1), MSPRING_ERROR_ARGUMENT);
        mspring_network_destroy(network);
        mspring_network_destroy(other);
        recipe_free(&made);
    }
}

/// What is sent of one property does not say that another is as it was: a spring has got another one's id.
static void each_property_is_known_for_itself(void **state) {
    (void)state;
    for (mspring_property p = FIRST; p < END; p++) {
        recipe made;
        mspring_network_def def = support_def(0, 4);
        def.spare_springs = 1;
        mspring_network *network = lattice(&made, &def);
        mspring_id id, again;
        check_ok(mspring_network_remove_springs(network, &(mspring_id){0}, 0, 1));
        check_ok(mspring_network_add_springs(network, &made.springs[0], 1, &id));
        send_twice(network, p);
        check_ok(mspring_network_remove_springs(network, &id, 0, 1));
        check_ok(mspring_network_reuse_ids(network));
        check_ok(mspring_network_add_springs(network, &made.springs[0], 1, &again));
        assert_int_equal(again, id);
        for (mspring_property q = FIRST; q < END; q++) {
            fill(q, others, 9);
            if (q != p)
                send(network, q, others);
        }
        send(network, p, values);
        check_ok(mspring_network_get(network, p, NULL, 1, id, read, 1));
        assert_memory_equal(read, values + 1, id * sizeof *read);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/// Rest lengths also change within steps, by ramps and actuators, and when groups are put back.
static void it_sees_rest_lengths_change(void **state) {
    (void)state;
    recipe made;
    mspring_network_def def = support_def(0, 4);
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    mspring_network *network = lattice(&made, &def);
    const mspring_id springs[] = {20, 300};
    const mspring_id firsts[] = {0, made.particle_count};
    float length;
    send_twice(network, MSPRING_REST_LENGTH);
    check_ok(mspring_network_break_springs(network, springs, 0, 2));
    check_ok(mspring_network_restore_springs(network, springs, 0, 2, 10.0));
    support_steps(network, 1, DT);
    send(network, MSPRING_REST_LENGTH, values); // which ends the ramp
    check_ok(mspring_network_get(network, MSPRING_ACTIVE_REST_LENGTH, NULL, 20, 1, &length, 1));
    assert_true(length == values[20]);
    const float signals[] = {1.25f, 0.75f};
    check_ok(mspring_network_set_actuators(network, springs, 2, 1));
    send(network, MSPRING_REST_LENGTH, values);
    check_ok(mspring_network_set(network, MSPRING_SIGNAL, NULL, 0, 2, signals, 1));
    support_steps(network, 1, DT);
    check_ok(mspring_network_get(network, MSPRING_REST_LENGTH, NULL, 20, 1, &length, 1));
    assert_true(length != values[20]);
    send(network, MSPRING_REST_LENGTH, values);
    check_has(network, MSPRING_REST_LENGTH, values);
    check_ok(mspring_network_set_actuators(network, NULL, 0, 1));
    check_ok(mspring_network_set_groups(network, firsts, 1));
    fill(MSPRING_REST_LENGTH, others, 8);
    send(network, MSPRING_REST_LENGTH, others);
    send(network, MSPRING_REST_LENGTH, others);
    check_ok(mspring_network_reset_groups(network, MSPRING_RESET_START, NULL, 0, MSPRING_ALL));
    check_has(network, MSPRING_REST_LENGTH, values);
    send(network, MSPRING_REST_LENGTH, others);
    check_has(network, MSPRING_REST_LENGTH, others);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// A frame fits where the same values were sent, and nowhere else, be it one of them that differs.
static void frames_tell_values_apart(void **state) {
    (void)state;
    static unsigned char frame[1 << 20];
    for (mspring_property p = FIRST; p < END; p++) {
        recipe made;
        mspring_network_def def = support_def(0, 4);
        mspring_network *network = lattice(&made, &def), *same = recipe_network(&made, &def),
                        *other = recipe_network(&made, &def);
        fill(p, values, 5);
        send(network, p, values);
        send(same, p, values);
        values[9] *= 1.01f;
        send(other, p, values);
        size_t size = 0;
        check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, frame, sizeof frame, &size));
        check_ok(mspring_network_load(same, frame, size));
        check_error(mspring_network_load(other, frame, size), MSPRING_ERROR_SNAPSHOT);
        mspring_network_destroy(network);
        mspring_network_destroy(same);
        mspring_network_destroy(other);
        recipe_free(&made);
    }
}

/// A snapshot; size 0: none yet.
typedef struct frame {
    unsigned char bytes[1 << 20];
    size_t size;
} frame;

/// Any other call, the same for both.
static void disturb(mspring_network *networks[2], const recipe *made, frame frames[2], uint64_t drawn) {
    const uint32_t count = made->spring_count - 1;
    const mspring_id ids[] = {1 + (mspring_id)(drawn / 16 % count), 1 + (mspring_id)(drawn / 64 % count)};
    const float signals[] = {0.9f, 1.2f}, yield = 0.02f;
    for (int i = 0; i < 2; i++) {
        mspring_network *network = networks[i], *clone = NULL;
        mspring_id id;
        switch (drawn % 11) {
        case 0:
            check_ok(mspring_network_break_springs(network, ids, 0, 2));
            break;
        case 1:
            check_ok(mspring_network_restore_springs(network, ids, 0, 2, drawn & 16 ? 0.1 : 0));
            break;
        case 2:
            check_ok(mspring_network_set_actuators(network, ids, ids[0] == ids[1] ? 1 : 2, 1));
            break;
        case 3:
            if (mspring_network_count(network, MSPRING_ACTUATORS) == 2)
                check_ok(mspring_network_set(network, MSPRING_SIGNAL, NULL, 0, 2, signals, 1));
            break;
        case 4:
            check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, frames[i].bytes, sizeof frames[i].bytes,
                                          &frames[i].size));
            break;
        case 5:
            if (frames[i].size > 0)
                (void)!mspring_network_load(network, frames[i].bytes, frames[i].size); // refused by another layout
            break;
        case 6:
            check_ok(mspring_network_clone(network, NULL, &clone));
            mspring_network_destroy(network);
            networks[i] = clone;
            break;
        case 7:
            check_ok(drawn & 16 ? mspring_network_compact(network) : support_expand(network));
            break;
        case 8:
            check_ok(mspring_network_set(network, MSPRING_YIELD_STRAIN, ids, 0, 1, &yield, 1));
            break;
        case 9:
            check_ok(mspring_network_add_springs(network, &made->springs[0], 1, &id));
            check_ok(mspring_network_remove_springs(network, &id, 0, 1));
            check_ok(mspring_network_reuse_ids(network));
            break;
        default:
            support_steps(network, 1 + (uint32_t)(drawn / 16 % 3), DT);
        }
    }
}

/// Whatever comes between, calls with a copy do what calls too small for one do.
static void it_holds_whatever_comes_between(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= SAMPLE(24); seed++) {
        recipe made;
        mspring_network_def def = support_def(-9.8f, 4);
        def.spare_springs = 8;
        def.settings.guard = MSPRING_GUARD_BOUNDS;
        mspring_network *of[2] = {lattice(&made, &def), recipe_network(&made, &def)};
        const uint32_t count = made.spring_count;
        static frame frames[2];
        frames[0].size = frames[1].size = 0;
        for (int i = 0; i < 2; i++) {
            check_ok(mspring_network_remove_springs(of[i], &(mspring_id){0}, 0, 1));
        }
        uint64_t random = seed;
        static float sent[END - FIRST][MOST];
        for (mspring_property p = FIRST; p < END; p++) {
            fill(p, sent[p - FIRST], seed);
        }
        for (int round = 0; round < 120; round++) {
            const mspring_property p = (mspring_property)(FIRST + (int)(support_random(&random) % (END - FIRST)));
            const uint32_t first = round % 4 == 3 ? (uint32_t)(support_random(&random) % count) : 0;
            if (round % 3 == 0)
                sent[p - FIRST][support_random(&random) % count] = value_of(p, &random);
            check_ok(mspring_network_set(of[0], p, NULL, first, count - first, sent[p - FIRST] + first, 1));
            for (mspring_id s = first; s < count; s++) {
                check_ok(mspring_network_set(of[1], p, NULL, s, 1, &sent[p - FIRST][s], 1));
            }
            disturb(of, &made, frames, support_random(&random));
            for (mspring_property q = FIRST; q < END; q++) {
                check_ok(mspring_network_get(of[1], q, NULL, 0, count, others, 1));
                check_ok(mspring_network_get(of[0], q, NULL, 0, count, read, 1));
                assert_memory_equal(read, others, count * sizeof *read);
            }
            assert_true(support_hash(of[0]) == support_hash(of[1]));
        }
        for (int i = 0; i < 2; i++) {
            mspring_network_destroy(of[i]);
        }
        recipe_free(&made);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_copy_is_made_once),
        cmocka_unit_test(it_does_what_small_calls_do),
        cmocka_unit_test(what_lies_between_was_not_sent),
        cmocka_unit_test(what_is_no_value_is_refused),
        cmocka_unit_test(a_negative_zero_changes_nothing),
        cmocka_unit_test(it_sees_other_changes),
        cmocka_unit_test(each_property_is_known_for_itself),
        cmocka_unit_test(it_sees_rest_lengths_change),
        cmocka_unit_test(frames_tell_values_apart),
        cmocka_unit_test(it_holds_whatever_comes_between),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

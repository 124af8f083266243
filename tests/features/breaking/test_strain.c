/// @file test_strain.c
/// The strain pass: springs break and are stressed by the strain they have at the end of a step, no other does, and
/// the events say so; the same ones in the same order at every level.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"

enum { CAPACITY = 4096, WEB_SPRINGS = 20, STRAND_SPRINGS = 24 };

/// A network with springs in rows of every kind, moving about.
static recipe lively_recipe(void) {
    uint64_t seed = 31;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {500, 1000}, .damping = {0, 2}, .holes = 0.1};
    recipe made = {0};
    recipe_lattice(&made, 37, 9, 0, 0, 1, &stuff, &seed);
    mspring_id end = recipe_particle(&made, 60, 20, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 2, end, 30, &stuff, &seed);
    recipe_random_springs(&made, WEB_SPRINGS, &stuff, &seed);
    // What hangs on a lattice is swept with the web; this is a row of its own.
    const mspring_id from = recipe_particle(&made, -30, 20, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, from, recipe_particle(&made, -30 + STRAND_SPRINGS, 20, 1, 0), STRAND_SPRINGS, &stuff, &seed);
    recipe_disturb(&made, 0.05, 6, &seed);
    return made;
}

/// The first of the web's springs: they come before those of the strand, which are the last.
static mspring_id first_of_web(uint32_t spring_count) {
    return spring_count - STRAND_SPRINGS - WEB_SPRINGS;
}

static mspring_network *network_of(const recipe *made, mspring_simd level) {
    mspring_network_def def = support_def(-9.8f, 4);
    def.simd_level = level;
    mspring_network *network = recipe_network(made, &def);
    check_ok(mspring_network_reserve_events(network, CAPACITY));
    return network;
}

/// Thresholds for every spring, some of them never.
typedef struct thresholds {
    float *break_strain, *warn_strain;
} thresholds;

static thresholds random_thresholds(uint32_t count) {
    uint64_t seed = 32;
    thresholds made = {malloc(count * sizeof(float)), malloc(count * sizeof(float))};
    assert_true(made.break_strain && made.warn_strain);
    for (uint32_t s = 0; s < count; s++) {
        // The springs of the web are long, and strained the less.
        const double scale = s - first_of_web(count) < WEB_SPRINGS ? 0.1 : 1;
        made.break_strain[s] =
            s % 5 == 0 ? INFINITY : (float)support_random_between(&seed, 0.05 * scale, 0.6 * scale);
        made.warn_strain[s] = s % 3 == 0 ? INFINITY : (float)support_random_between(&seed, 0.03, 0.3);
    }
    return made;
}

static void free_thresholds(thresholds *unwanted) {
    free(unwanted->break_strain);
    free(unwanted->warn_strain);
}

static uint32_t read_all(mspring_network *network, mspring_event *events) {
    uint32_t count;
    uint64_t lost;
    check_ok(mspring_network_read_events(network, events, CAPACITY, &count, &lost));
    assert_int_equal(lost, 0);
    return count;
}

static double strain_of(const mspring_network *network, const mspring_spring_def *spring) {
    const support_point a = support_position(network, spring->a), b = support_position(network, spring->b);
    return (hypot(b.x - a.x, b.y - a.y) - (double)spring->rest_length) / (double)spring->rest_length;
}

/// What a spring is, by the rules.
typedef enum condition { WHOLE, STRESSED, BROKEN } condition;

/// Follow the rules for one spring and one step; the pass may round otherwise within this much of a threshold.
static const double close = 1e-5;

static condition next_condition(condition now, double strain, double break_strain, double warn_strain,
                                double relax_strain, bool *too_close) {
    const double size = fabs(strain);
    *too_close =
        fabs(size - break_strain) < close || fabs(size - warn_strain) < close || fabs(size - relax_strain) < close;
    if (now == BROKEN || size > break_strain) {
        return BROKEN;
    }
    if (now == STRESSED) {
        return size < relax_strain ? WHOLE : STRESSED;
    }
    return size > warn_strain ? STRESSED : WHOLE;
}

/// Below which a stressed spring relaxes: some have a relax strain of their own, which counts up to their stress
/// strain.
static double relax_strain_of(mspring_id s, double warn_strain) {
    const double own = 0.02 * (double)(s % 16);
    return s % 4 > 0 ? 0.6 * warn_strain : own < warn_strain ? own : warn_strain;
}

static void set_relax_strains(mspring_network *network, uint32_t spring_count) {
    for (mspring_id s = 0; s < spring_count; s += 4) {
        const float own = 0.02f * (float)(s % 16);
        check_ok(mspring_network_set(network, MSPRING_RELAX_STRAIN, NULL, s, 1, &own, 1));
    }
}

/// At every level; with relax strains that some springs have of their own, or by the fraction alone.
static void springs_break_and_are_stressed_by_the_rules(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    for (uint32_t i = 0; i < 2 * level_count; i++) {
        const bool has_own = i % 2 == 1;
        recipe made = lively_recipe();
        thresholds at = random_thresholds(made.spring_count);
        mspring_network *network = network_of(&made, levels[i / 2]);
        check_ok(
            mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, made.spring_count, at.break_strain, 1));
        check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, made.spring_count, at.warn_strain, 1));
        check_ok(support_set_relax_fraction(network, 0.6f));
        if (has_own) {
            set_relax_strains(network, made.spring_count);
        }
        condition *conditions = calloc(made.spring_count, sizeof *conditions);
        mspring_event *events = malloc(CAPACITY * sizeof *events);
        assert_true(conditions && events);
        uint32_t totals[3] = {0, 0, 0};
        for (int step = 0; step < 60; step++) {
            support_steps(network, 1, 1.0 / 64);
            const uint32_t count = read_all(network, events);
            for (mspring_id s = 0; s < made.spring_count; s++) {
                const double strain = strain_of(network, &made.springs[s]);
                const double warn_strain = (double)at.warn_strain[s];
                bool too_close;
                condition next =
                    next_condition(conditions[s], strain, (double)at.break_strain[s], warn_strain,
                                   has_own ? relax_strain_of(s, warn_strain) : 0.6 * warn_strain, &too_close);
                support_spring_info info;
                check_ok(support_get_spring(network, s, &info));
                const condition is = info.flags & MSPRING_SPRING_BROKEN     ? BROKEN
                                     : info.flags & MSPRING_SPRING_STRESSED ? STRESSED
                                                                            : WHOLE;
                assert_true(too_close || is == next);
                // There is an event if, and only if, the condition has changed.
                uint32_t found = 0;
                for (uint32_t e = 0; e < count; e++) {
                    if (events[e].id != s) {
                        continue;
                    }
                    found++;
                    assert_int_equal(events[e].kind, is == BROKEN     ? MSPRING_EVENT_BROKEN
                                                     : is == STRESSED ? MSPRING_EVENT_STRESSED
                                                                      : MSPRING_EVENT_RELAXED);
                    assert_int_equal(events[e].other, MSPRING_NONE);
                    check_near((double)events[e].strain, strain, close);
                    totals[events[e].kind]++;
                }
                assert_int_equal(found, is != conditions[s]);
                conditions[s] = is;
            }
        }
        // All of it happens, in rows of every kind.
        assert_true(totals[MSPRING_EVENT_BROKEN] > 100 && totals[MSPRING_EVENT_STRESSED] > 200 &&
                    totals[MSPRING_EVENT_RELAXED] > 100);
        support_plan plan;
        check_ok(support_get_plan(network, &plan));
        assert_int_equal(plan.chain_springs, STRAND_SPRINGS);
        uint32_t broken_in_web = 0, broken_in_strand = 0;
        for (mspring_id s = first_of_web(made.spring_count); s < made.spring_count; s++) {
            uint32_t *const count =
                s - first_of_web(made.spring_count) < WEB_SPRINGS ? &broken_in_web : &broken_in_strand;
            *count += conditions[s] == BROKEN;
        }
        assert_true(broken_in_web > 3 && broken_in_strand > 3);
        free(conditions);
        free(events);
        mspring_network_destroy(network);
        free_thresholds(&at);
        recipe_free(&made);
    }
}

static void every_level_has_the_same_events(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    recipe made = lively_recipe();
    thresholds at = random_thresholds(made.spring_count);
    mspring_event *first = malloc(CAPACITY * sizeof *first), *events = malloc(CAPACITY * sizeof *events);
    assert_true(first && events);
    uint32_t first_count = 0;
    uint64_t first_hash = 0;
    for (uint32_t i = 0; i < level_count; i++) {
        mspring_network *network = network_of(&made, levels[i]);
        check_ok(
            mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, made.spring_count, at.break_strain, 1));
        check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, made.spring_count, at.warn_strain, 1));
        support_steps(network, 40, 1.0 / 64);
        mspring_event *into = i == 0 ? first : events;
        const uint32_t count = read_all(network, into);
        first_count = i == 0 ? count : first_count;
        first_hash = i == 0 ? support_hash(network) : first_hash;
        assert_int_equal(count, first_count);
        assert_memory_equal(into, first, count * sizeof *first);
        assert_int_equal(support_hash(network), first_hash);
        mspring_network_destroy(network);
    }
    assert_true(first_count > 300);
    free(first);
    free(events);
    free_thresholds(&at);
    recipe_free(&made);
}

static void thresholds_out_of_reach_change_nothing(void **state) {
    (void)state;
    recipe made = lively_recipe();
    thresholds at = random_thresholds(made.spring_count);
    for (uint32_t s = 0; s < made.spring_count; s++) {
        at.break_strain[s] = s % 2 == 0 ? 1e30f : INFINITY;
    }
    mspring_network *watched = network_of(&made, MSPRING_SIMD_AUTO), *plain = network_of(&made, MSPRING_SIMD_AUTO);
    check_ok(mspring_network_set(watched, MSPRING_BREAK_STRAIN, NULL, 0, made.spring_count, at.break_strain, 1));
    check_ok(mspring_network_set(watched, MSPRING_WARN_STRAIN, NULL, 0, made.spring_count, at.warn_strain, 1));
    support_steps(watched, 30, 1.0 / 64);
    support_steps(plain, 30, 1.0 / 64);
    assert_int_equal(support_hash(watched), support_hash(plain));
    mspring_network_destroy(watched);
    mspring_network_destroy(plain);
    free_thresholds(&at);
    recipe_free(&made);
}

/// The one spring of a long chain that gets too short a rest length breaks, wherever it is.
static void springs_of_a_chain_are_told_apart(void **state) {
    (void)state;
    enum { SPRINGS = 50 };
    for (mspring_id shortened = 0; shortened < SPRINGS; shortened += 7) {
        mspring_builder *builder = support_builder();
        for (int p = 0; p <= SPRINGS; p++)
            (void)support_pinned(builder, p, 0, 1);
        for (mspring_id s = 0; s < SPRINGS; s++)
            (void)support_spring(builder, s, s + 1, 100, 0);
        const mspring_network_def def = support_def(0, 4);
        mspring_network *network = support_network(builder, &def);
        mspring_event events[2];
        uint32_t count;
        check_ok(mspring_network_reserve_events(network, 2));
        const float limit = 0.1f, length = 0.8f;
        check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, SPRINGS, &limit, 0));
        check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, shortened, 1, &length, 1));
        support_steps(network, 1, 0.01);
        check_ok(mspring_network_read_events(network, events, 2, &count, NULL));
        assert_int_equal(count, 1);
        assert_true(events[0].id == shortened && events[0].kind == MSPRING_EVENT_BROKEN);
        mspring_network_destroy(network);
    }
}

/* --------------------------------------------------------------------------------------- a weight on a spring */

/// 1 kg on a spring of 1 m and 100 N/m, let go at rest length: it swings down by 2 m g / k = 0.196 m and back with
/// a period of 2 pi sqrt(m / k) = 0.628 s.
static mspring_network *swinging_weight(void) {
    mspring_builder *builder = support_builder();
    support_pinned(builder, 0, 0, 1);
    support_particle(builder, 0, -1, 1);
    support_spring(builder, 0, 1, 100, 0);
    mspring_network_def def = support_def(-9.8f, 20);
    mspring_network *network = support_network(builder, &def);
    check_ok(mspring_network_reserve_events(network, CAPACITY));
    return network;
}

static void a_swinging_weight_stresses_once_a_period(void **state) {
    (void)state;
    mspring_network *network = swinging_weight();
    const float stress = 0.15f;
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, 1, &stress, 1));
    check_ok(support_set_relax_fraction(network, 0.5f));
    mspring_event events[CAPACITY];
    support_steps(network, 314, 0.01); // five periods
    const uint32_t count = read_all(network, events);
    assert_int_equal(count, 10);
    for (uint32_t e = 0; e < count; e++) {
        assert_int_equal(events[e].kind, e % 2 == 0 ? MSPRING_EVENT_STRESSED : MSPRING_EVENT_RELAXED);
        // The first step past the threshold: at most 0.98 m/s * 0.01 s further.
        check_near((double)events[e].strain, e % 2 == 0 ? 0.155 : 0.07, 0.006);
    }
    // Never to be stressed any more: it relaxes.
    support_steps(network, 30, 0.01);
    const float never = INFINITY;
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, 1, &never, 1));
    support_steps(network, 1, 0.01);
    support_spring_info info;
    check_ok(support_get_spring(network, 0, &info));
    assert_int_equal(info.flags, 0);
    mspring_network_destroy(network);
}

/// A threshold is to be passed: at it, nothing happens. The numbers are exact in floats.
static void what_is_at_its_threshold_stays(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_pinned(builder, 0, 0, 1);
    support_pinned(builder, 1, 0, 1);
    support_spring(builder, 0, 1, 100, 0);
    mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = support_network(builder, &def);
    check_ok(mspring_network_reserve_events(network, CAPACITY));
    const float stress = 0.5f, limit = 0.75f;
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, 1, &stress, 1));
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, 1, &limit, 1));
    check_ok(support_set_relax_fraction(network, 0.5f));
    const double little = 0x1p-20, y = 0;
    const struct {
        double length;
        uint32_t flags, event; ///< afterwards; what is told, if anything is
    } ways[] = {{1.5, 0, MSPRING_NONE},
                {0.5, 0, MSPRING_NONE},
                {1.5 + little, MSPRING_SPRING_STRESSED, MSPRING_EVENT_STRESSED},
                {1.25, MSPRING_SPRING_STRESSED, MSPRING_NONE},
                {0.75, MSPRING_SPRING_STRESSED, MSPRING_NONE},
                {1.25 - little, 0, MSPRING_EVENT_RELAXED},
                {0.5 - little, MSPRING_SPRING_STRESSED, MSPRING_EVENT_STRESSED},
                {1.75, MSPRING_SPRING_STRESSED, MSPRING_NONE},
                {0.25, MSPRING_SPRING_STRESSED, MSPRING_NONE},
                {0.25 - little, MSPRING_SPRING_BROKEN, MSPRING_EVENT_BROKEN}};
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        check_ok(mspring_network_set_positions(network, NULL, 1, 1, &ways[i].length, &y, 1));
        support_steps(network, 1, 0.01);
        support_spring_info info;
        check_ok(support_get_spring(network, 0, &info));
        assert_int_equal(info.flags, ways[i].flags);
        mspring_event events[CAPACITY];
        assert_int_equal(read_all(network, events), ways[i].event != MSPRING_NONE);
        if (ways[i].event != MSPRING_NONE) {
            assert_int_equal(events[0].kind, ways[i].event);
            assert_true((double)events[0].strain == ways[i].length - 1);
        }
    }
    mspring_network_destroy(network);
}

/// Thresholds of one spring, and of one kind, leave those that there are alone.
static void thresholds_do_not_take_each_others_place(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    for (int p = 0; p < 4; p++) {
        support_pinned(builder, p, 0, 1);
    }
    support_spring(builder, 0, 1, 100, 0);
    support_spring(builder, 2, 3, 100, 0);
    mspring_network_def def = support_def(0, 4);
    mspring_network *network = support_network(builder, &def);
    mspring_event events[CAPACITY];
    check_ok(mspring_network_reserve_events(network, CAPACITY));
    const float limit = 0.5f, stress = 0.25f;
    const double far = -0.625, y = 0; // a strain of 0.625
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, 1, &limit, 1));
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 1, 1, &stress, 1)); // the first of its kind
    check_ok(mspring_network_set_positions(network, NULL, 0, 1, &far, &y, 1));
    check_ok(mspring_network_step(network, 0.01));
    assert_int_equal(read_all(network, events), 1);
    assert_true(events[0].kind == MSPRING_EVENT_BROKEN && events[0].id == 0);
    mspring_network_destroy(network);
}

static void a_weight_too_heavy_breaks_its_spring_and_falls(void **state) {
    (void)state;
    mspring_network *network = swinging_weight();
    const float limit = 0.19f, higher = 0.2f;
    const mspring_id spring = 0;
    mspring_event events[CAPACITY];
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, &spring, 0, 1, &higher, 1));
    support_steps(network, 200, 0.01);
    assert_int_equal(read_all(network, events), 0);
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, &spring, 0, 1, &limit, 1));
    support_steps(network, 200, 0.01);
    assert_int_equal(read_all(network, events), 1);
    assert_int_equal(events[0].kind, MSPRING_EVENT_BROKEN);
    assert_int_equal(events[0].id, 0);
    check_near((double)events[0].strain, 0.193, 0.003);
    assert_true(support_position(network, 1).y < -5);
    // Restored as it is, it breaks again; with a ramp it holds as long as it is let down slowly enough.
    check_ok(mspring_network_restore_springs(network, &spring, 0, 1, 0));
    support_steps(network, 1, 0.01);
    assert_int_equal(read_all(network, events), 2);
    assert_int_equal(events[0].kind, MSPRING_EVENT_RESTORED);
    assert_int_equal(events[1].kind, MSPRING_EVENT_BROKEN);
    mspring_network_destroy(network);
}

/// A wreck of springs of which every third is to break at once, the next to be stressed, and the next neither, told
/// at the first time when its compaction has come so far (or the first part of that before it begins). Returns how
/// many pieces were left.
static bool watch_while_compacting(uint32_t pieces, bool breaks_before) {
    recipe made = lively_recipe();
    uint64_t seed = 77;
    mspring_network *network = network_of(&made, MSPRING_SIMD_AUTO);
    static mspring_event events[CAPACITY];
    for (mspring_id s = 0; s < made.spring_count; s++) {
        if (support_random(&seed) % 2 == 0) {
            check_ok(mspring_network_break_springs(network, &s, 0, 1));
        }
    }
    (void)read_all(network, events);
    thresholds at = random_thresholds(made.spring_count);
    for (mspring_id s = 0; s < made.spring_count; s++) {
        at.break_strain[s] = s % 3 == 0 ? 1e-4f : INFINITY;
        at.warn_strain[s] = s % 3 == 1 ? 1e-4f : INFINITY;
    }
    mspring_job *job = NULL;
    if (breaks_before) {
        check_ok(
            mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, made.spring_count, at.break_strain, 1));
    }
    support_compact(network, pieces, &job);
    const bool is_left = job != NULL;
    if (!breaks_before) {
        check_ok(
            mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, made.spring_count, at.break_strain, 1));
        support_compact(network, 1, &job);
    }
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, made.spring_count, at.warn_strain, 1));
    while (job) {
        support_compact(network, 0, &job);
    }
    support_steps(network, 1, 1.0 / 64);
    const uint32_t count = read_all(network, events);
    uint32_t totals[3] = {0, 0, 0};
    for (uint32_t e = 0; e < count; e++) {
        assert_int_equal(events[e].kind, events[e].id % 3 == 0 ? MSPRING_EVENT_BROKEN : MSPRING_EVENT_STRESSED);
        totals[events[e].id % 3]++;
    }
    // Of some 450 springs that are whole; few are strained by less.
    assert_true(totals[0] > 100 && totals[1] > 100 && totals[2] == 0);
    free_thresholds(&at);
    mspring_network_destroy(network);
    recipe_free(&made);
    return is_left;
}

static void watching_may_begin_while_the_network_is_compacted(void **state) {
    (void)state;
    for (int breaks_before = 0; breaks_before < 2; breaks_before++) {
        uint32_t pieces = 1;
        while (watch_while_compacting(pieces, breaks_before)) {
            pieces += 9;
        }
        assert_true(pieces > 4);
    }
}

/* ---------------------------------------------------------------------------------------------------- refusals */

static void bad_thresholds_are_refused(void **state) {
    (void)state;
    recipe made = lively_recipe();
    mspring_network *network = network_of(&made, MSPRING_SIMD_AUTO);
    const mspring_id list[] = {1, 2, 3}, beyond[] = {1, made.spring_count, 3};
    const float bad[] = {0, -1, NAN, -INFINITY}, good[] = {1, 1, 1}, below = -2;
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        const float strain[] = {0.001f, bad[i], 0.001f};
        check_error(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 5, 3, strain, 1),
                    MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "spring 6");
        check_error(mspring_network_set(network, MSPRING_BREAK_STRAIN, list, 0, 3, strain, 1),
                    MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "spring 2: break");
        check_error(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 5, 3, strain, 1),
                    MSPRING_ERROR_ARGUMENT);
        check_error(mspring_network_set(network, MSPRING_WARN_STRAIN, list, 0, 3, strain, 1),
                    MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "spring 2: warn");
    }
    check_error(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, made.spring_count, 1, good, 1),
                MSPRING_ERROR_ID);
    check_error(mspring_network_set(network, MSPRING_BREAK_STRAIN, beyond, 0, 3, good, 1), MSPRING_ERROR_ID);
    check_error(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, 1, NULL, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set(network, MSPRING_RELAX_STRAIN, NULL, 0, 1, &below, 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "spring 0: relax");
    check_error(mspring_network_set(NULL, MSPRING_BREAK_STRAIN, NULL, 0, 1, good, 1), MSPRING_ERROR_ARGUMENT);
    const float fractions[] = {-0.1f, 1.1f, NAN};
    for (size_t i = 0; i < COUNT_OF(fractions); i++) {
        check_error(support_set_relax_fraction(network, fractions[i]), MSPRING_ERROR_ARGUMENT);
    }
    mspring_event event;
    uint32_t count = 7;
    check_error(mspring_network_read_events(NULL, &event, 1, &count, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_read_events(network, NULL, 1, &count, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_read_events(network, &event, 1, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    assert_int_equal(count, 7);
    check_error(mspring_network_reserve_events(network, MSPRING_MAX_SPRINGS + 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_reserve_events(NULL, 1), MSPRING_ERROR_ARGUMENT);
    // Nothing is watched.
    support_steps(network, 10, 1.0 / 64);
    check_ok(mspring_network_read_events(network, &event, 1, &count, NULL));
    assert_int_equal(count, 0);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void watching_survives_every_failure_and_steps_allocate_nothing(void **state) {
    (void)state;
    recipe made = lively_recipe();
    thresholds at = random_thresholds(made.spring_count);
    uint64_t expected = 0;
    size_t fail_at = 0;
    for (bool failed = true; failed; fail_at++) { // the first time round nothing fails
        watched_allocator watched = {0};
        mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def def = support_def(-9.8f, 4);
        def.allocator = &allocator;
        mspring_network *network = recipe_network(&made, &def);
        watched.fail_at = fail_at > 0 ? watched.calls + fail_at : 0;
        failed = fail_at == 0;
        for (int call = 0; call < 3; call++) {
            for (int again = 0; again < 2; again++) {
                const size_t used = support_memory_used(network);
                mspring_result result = call == 0   ? mspring_network_reserve_events(network, CAPACITY)
                                        : call == 1 ? mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0,
                                                                          made.spring_count, at.break_strain, 1)
                                                    : mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0,
                                                                          made.spring_count, at.warn_strain, 1);
                if (result == MSPRING_OK) {
                    break;
                }
                check_error(result, MSPRING_ERROR_MEMORY);
                check_contains(mspring_network_error(network), "memory");
                assert_int_equal(again, 0);
                // Of those of stress, both arrays or none.
                assert_true(call < 2 || support_memory_used(network) == used);
                failed = true;
            }
        }
        const size_t calls = watched.calls;
        support_steps(network, 20, 1.0 / 64);
        assert_int_equal(watched.calls, calls);
        expected = fail_at == 0 ? support_hash(network) : expected;
        assert_int_equal(support_hash(network), expected);
        mspring_network_destroy(network);
        check_watched_clean(&watched);
    }
    assert_true(fail_at > 8);
    free_thresholds(&at);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(springs_break_and_are_stressed_by_the_rules),
        cmocka_unit_test(every_level_has_the_same_events),
        cmocka_unit_test(thresholds_out_of_reach_change_nothing),
        cmocka_unit_test(springs_of_a_chain_are_told_apart),
        cmocka_unit_test(a_swinging_weight_stresses_once_a_period),
        cmocka_unit_test(what_is_at_its_threshold_stays),
        cmocka_unit_test(thresholds_do_not_take_each_others_place),
        cmocka_unit_test(a_weight_too_heavy_breaks_its_spring_and_falls),
        cmocka_unit_test(watching_may_begin_while_the_network_is_compacted),
        cmocka_unit_test(bad_thresholds_are_refused),
        cmocka_unit_test(watching_survives_every_failure_and_steps_allocate_nothing),
    };
    return cmocka_run_group_tests_name("strain", tests, NULL, NULL);
}

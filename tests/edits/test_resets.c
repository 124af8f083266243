/// @file test_resets.c
/// Resets of groups: each puts back the springs of its groups, and those of no other. Groups have different sizes,
/// their springs are given in any order, and some particles and springs belong to no group.
///
/// SPDX-License-Identifier: MIT
#include <string.h>

#include "support.h"

enum { MOST_GROUPS = 40, MOST_SPRINGS = 2000 };

// A network, and the group of each of its springs; group_count if a spring belongs to none.
typedef struct batch {
    mspring_network *network;
    uint32_t group_count, spring_count;
    uint32_t group_of[MOST_SPRINGS];
    mspring_id firsts[MOST_GROUPS + 1];
} batch;

// Add rings of any size with chords, the last of them outside of all groups, and their springs in any order.
static void make(batch *b, uint32_t groups, uint64_t *seed) {
    mspring_builder *builder = support_builder();
    mspring_id ends[MOST_SPRINGS][2];
    b->group_count = groups;
    b->spring_count = 0;
    b->firsts[0] = 0;
    for (uint32_t g = 0; g <= groups; g++) {
        const uint32_t size = 1 + (uint32_t)(support_random(seed) % 12);
        const mspring_id first = mspring_builder_count(builder, MSPRING_PARTICLES);
        for (uint32_t i = 0; i < size; i++)
            (void)support_particle(builder, 20.0 * g + i, 0.3 * (double)(i * i % 5), 1);
        for (uint32_t i = 0; i + 1 < size; i++)
            for (uint32_t step = 1; step <= 3 && i + step < size; step += 2, b->spring_count++) {
                ends[b->spring_count][0] = first + i;
                ends[b->spring_count][1] = first + i + step;
                b->group_of[b->spring_count] = g;
            }
        if (g < groups)
            b->firsts[g + 1] = first + size;
    }
    for (uint32_t s = b->spring_count; s-- > 1;) {
        const uint32_t other = (uint32_t)(support_random(seed) % (s + 1)), group = b->group_of[s];
        const mspring_id had[2] = {ends[s][0], ends[s][1]};
        memcpy(ends[s], ends[other], sizeof had);
        memcpy(ends[other], had, sizeof had);
        b->group_of[s] = b->group_of[other];
        b->group_of[other] = group;
    }
    for (uint32_t s = 0; s < b->spring_count; s++)
        (void)support_spring(builder, ends[s][0], ends[s][1], 100, 0);
    mspring_network_def def = support_def(0, 4);
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    b->network = support_network(builder, &def);
    check_ok(mspring_network_set_groups(b->network, b->firsts, groups));
}

static bool one_in(uint32_t count, uint64_t *seed) {
    return support_random(seed) % count == 0;
}

// Break some springs, set the rest lengths of others, put some groups back, and look at each spring.
static void disturb_and_reset(batch *b, uint64_t *seed) {
    bool is_whole[MOST_SPRINGS], is_reset[MOST_GROUPS + 1] = {0};
    float lengths[MOST_SPRINGS], had[MOST_SPRINGS], has;
    uint32_t list[MOST_GROUPS], listed = 0;
    check_ok(mspring_network_get(b->network, MSPRING_REST_LENGTH, NULL, 0, b->spring_count, had, 1));
    memcpy(lengths, had, sizeof lengths);
    for (mspring_id s = 0; s < b->spring_count; s++) {
        is_whole[s] = !one_in(3, seed);
        if (!is_whole[s])
            check_ok(mspring_network_break_springs(b->network, &s, 0, 1));
        if (one_in(3, seed))
            lengths[s] *= 1.25f;
        check_ok(mspring_network_set(b->network, MSPRING_REST_LENGTH, NULL, s, 1, &lengths[s], 1));
    }
    for (uint32_t g = 0; g < b->group_count; g++)
        if (one_in(2, seed))
            is_reset[list[listed++] = g] = true;
    check_ok(mspring_network_reset_groups(b->network, MSPRING_RESET_START, list, 0, listed));
    for (mspring_id s = 0; s < b->spring_count; s++) {
        const bool is_back = is_reset[b->group_of[s]];
        uint32_t flags = 0;
        check_ok(mspring_network_get_integers(b->network, MSPRING_SPRING_FLAGS, NULL, s, 1, &flags, 1));
        check_ok(mspring_network_get(b->network, MSPRING_REST_LENGTH, NULL, s, 1, &has, 1));
        assert_int_equal(!(flags & MSPRING_SPRING_BROKEN), is_whole[s] || is_back);
        assert_true(has == (is_back ? had[s] : lengths[s]));
    }
}

static void resets_put_back_their_springs(void **state) {
    static const uint32_t counts[] = {1, 2, 3, 7, MOST_GROUPS};
    static batch b;
    uint64_t seed = 1;
    (void)state;
    for (int round = 0; round < ROUNDS(20); round++)
        for (size_t i = 0; i < COUNT_OF(counts); i++) {
            make(&b, counts[i], &seed);
            disturb_and_reset(&b, &seed);
            mspring_network_destroy(b.network);
        }
}

// A clone has the groups of its network, and another layout keeps them.
static void clones_and_layouts_reset_alike(void **state) {
    static batch b;
    uint64_t seed = 2;
    (void)state;
    for (int round = 0; round < ROUNDS(20); round++) {
        mspring_network *clone = NULL;
        const mspring_id first = 0;
        make(&b, 1 + (uint32_t)(round % 5), &seed);
        check_ok(mspring_network_clone(b.network, NULL, &clone));
        mspring_network_destroy(b.network);
        b.network = clone;
        if (b.spring_count > 0 && round % 2) {
            check_ok(mspring_network_break_springs(clone, &first, 0, 1));
            check_ok(mspring_network_compact(clone));
            check_ok(mspring_network_reset_groups(clone, MSPRING_RESET_START, NULL, 0, MSPRING_ALL));
            check_ok(mspring_network_restore_springs(clone, &first, 0, 1, 0.0));
        }
        disturb_and_reset(&b, &seed);
        mspring_network_destroy(clone);
    }
}

// Let every third spring yield: rest lengths then change in a step.
static void let_yield(batch *b) {
    for (mspring_id s = 0; s < b->spring_count; s += 3) {
        const float strain = 0.01f;
        check_ok(mspring_network_set(b->network, MSPRING_YIELD_STRAIN, NULL, s, 1, &strain, 1));
    }
}

// Break springs and restore them with ramps, of which some end before the reset and others run on.
static void run_ramps(batch *b, uint64_t *seed) {
    for (mspring_id s = 0; s < b->spring_count; s += 1 + (mspring_id)(support_random(seed) % 3)) {
        const float longer = 3;
        if (b->group_of[s] == b->group_count)
            continue; // no reset restores it
        check_ok(mspring_network_break_springs(b->network, &s, 0, 1));
        check_ok(mspring_network_restore_springs(b->network, &s, 0, 1, one_in(2, seed) ? 0.01 : 10));
        if (one_in(4, seed))
            check_ok(mspring_network_set(b->network, MSPRING_REST_LENGTH, NULL, s, 1, &longer, 1));
    }
    for (int step = 0; step < 4; step++)
        check_ok(mspring_network_step(b->network, 0.01));
}

// A reset to the start leaves no ramp: the future is that of a network without one, bit for bit.
static void resets_undo_ramps(void **state) {
    static batch b;
    uint64_t seed = 3;
    (void)state;
    for (int round = 0; round < ROUNDS(20); round++) {
        mspring_network *fresh = NULL;
        make(&b, 1 + (uint32_t)(round % 5), &seed);
        if (round % 2)
            let_yield(&b);
        for (mspring_id p = 0; p < mspring_network_count(b.network, MSPRING_PARTICLES); p++)
            check_ok(mspring_network_set_velocities(b.network, NULL, p, 1, &(float){1}, &(float){(float)(p % 5)}, 1));
        check_ok(mspring_network_set_groups(b.network, b.firsts, b.group_count)); // the start has the velocities
        check_ok(mspring_network_clone(b.network, NULL, &fresh));
        for (int step = 0; step < 4; step++)
            check_ok(mspring_network_step(fresh, 0.01));
        check_ok(mspring_network_reset_groups(fresh, MSPRING_RESET_START, NULL, 0, MSPRING_ALL));
        run_ramps(&b, &seed);
        check_ok(mspring_network_reset_groups(b.network, MSPRING_RESET_START, NULL, 0, MSPRING_ALL));
        for (int step = 0; step < 5; step++) {
            assert_true(support_hash(b.network) == support_hash(fresh));
            check_ok(mspring_network_step(b.network, 0.01));
            check_ok(mspring_network_step(fresh, 0.01));
        }
        mspring_network_destroy(fresh);
        mspring_network_destroy(b.network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(resets_put_back_their_springs),
        cmocka_unit_test(clones_and_layouts_reset_alike),
        cmocka_unit_test(resets_undo_ramps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

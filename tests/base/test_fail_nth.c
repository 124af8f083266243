/// @file test_fail_nth.c
/// A life that calls every function that allocates, with the n-th allocation failing, for every n: the call that it
/// hits says so and changes no byte of the snapshot, succeeds when it is made again, and all ends as if nothing had
/// happened.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "fail_nth.h"
#include "snapshots.h"
#include "support.h"

/* --------------------------------------------------------------------------------------------------- the lives */

static recipe small_recipe(void) {
    uint64_t seed = 15;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {100, 200}, .damping = {0, 1}, .pinned = 0.1};
    recipe made = {0};
    recipe_lattice(&made, 7, 5, 0, 0, 1, &stuff, &seed);
    recipe_random_springs(&made, 5, &stuff, &seed);
    recipe_disturb(&made, 0.01, 0, &seed);
    return made;
}

static uint64_t hash_of(const life *l) {
    return l->network ? support_hash(l->network) : 0;
}

static saved save_of(const life *l) {
    return l->network ? snapshots_save(l->network, MSPRING_SNAPSHOT_ALL) : (saved){NULL, 0};
}

static void check_same(const saved *a, const saved *b, const char *name) {
    if (a->size != b->size || (a->size > 0 && memcmp(a->bytes, b->bytes, a->size) != 0))
        print_error("%s has changed the snapshot\n", name);
    assert_int_equal(a->size, b->size);
    assert_true(a->size == 0 || memcmp(a->bytes, b->bytes, a->size) == 0);
}

static size_t used_by(const life *l) {
    return support_memory_used(l->network);
}

// Make a call in which nothing fails.
static void make_good_call(life *l, size_t number) {
    const mspring_result result = life_calls[number].call(l);
    if (result != MSPRING_OK)
        print_error("%s: %s\n", life_calls[number].name,
                    l->network ? mspring_network_error(l->network) : support_builder_error(l->builder));
    check_ok(result);
}

// A builder keeps a failed description, as a network would lack it; but not that a network could not be made.
static void check_failure_of_builder(life *l, size_t number) {
    mspring_network *network = NULL;
    mspring_builder *other = support_builder();
    if (strlen(mspring_builder_error(l->builder)) > 0 && strncmp(life_calls[number].name, "create", 6) != 0) {
        check_error(mspring_builder_add_copies(other, l->builder, 1, NULL, NULL, 0, NULL, NULL),
                    MSPRING_ERROR_MEMORY);
        check_error(mspring_network_create(l->builder, NULL, &network), MSPRING_ERROR_MEMORY);
        mspring_builder_forget_error(l->builder);
    }
    mspring_builder_destroy(other);
}

// Make a call; if memory fails, look that nothing has changed, and make it again.
static void make_call(life *l, size_t number) {
    if (l->fail_at == 0 || l->fail_at > l->ends[number] || l->failures > 0) {
        make_good_call(l, number);
        return;
    }
    const uint64_t before = hash_of(l);
    const size_t live = l->watched.live, used = used_by(l);
    const uint32_t particles = mspring_builder_count(l->builder, MSPRING_PARTICLES);
    const uint32_t springs = mspring_builder_count(l->builder, MSPRING_SPRINGS);
    const size_t clones = l->clone != NULL;
    saved all = save_of(l);
    mspring_result result = life_calls[number].call(l);
    if (result == MSPRING_ERROR_MEMORY) {
        l->failures++;
        if (hash_of(l) != before || l->watched.live < live)
            print_error("%s has changed something\n", life_calls[number].name);
        assert_int_equal(hash_of(l), before);
        saved now = save_of(l);
        check_same(&now, &all, life_calls[number].name);
        free(now.bytes);
        assert_int_equal(mspring_builder_count(l->builder, MSPRING_PARTICLES), particles);
        assert_int_equal(mspring_builder_count(l->builder, MSPRING_SPRINGS), springs);
        assert_int_equal(l->clone != NULL, clones);
        check_failure_of_builder(l, number);
        // A call may keep memory that it reserved before it failed, if it counts it.
        assert_true(used_by(l) >= used);
        result = life_calls[number].call(l);
    }
    if (result != MSPRING_OK)
        print_error("%s: %s\n", life_calls[number].name,
                    l->network ? mspring_network_error(l->network) : support_builder_error(l->builder));
    check_ok(result);
    free(all.bytes);
}

/// Live with the n-th allocation failing, 0 for none. Returns how many there were.
static size_t live_through(size_t fail_at, size_t *ends, saved *end, uint32_t *failures) {
    life l = {.made = small_recipe(), .ends = ends, .fail_at = fail_at};
    l.allocator = watched_interface(&l.watched);
    l.watched.fail_at = fail_at;
    for (size_t i = 0; i < life_call_count; i++) {
        make_call(&l, i);
        if (fail_at == 0)
            ends[i] = l.watched.calls;
    }
    const size_t made = l.watched.calls;
    *end = save_of(&l);
    *failures = l.failures;
    mspring_network_destroy(l.network);
    mspring_network_destroy(l.clone);
    mspring_builder_destroy(l.builder);
    check_watched_clean(&l.watched);
    free(l.snapshot);
    recipe_free(&l.made);
    return made;
}

static void every_failure_is_survived(void **state) {
    (void)state;
    saved expected = {NULL, 0}, end = {NULL, 0};
    uint32_t failures = 0;
    size_t *ends = test_calloc(life_call_count, sizeof *ends);
    const size_t count = live_through(0, ends, &expected, &failures);
    assert_int_equal(failures, 0);
    assert_true(count > 200);
    // Sanitizers look at every third: they take minutes, and the allocator here finds what leaks. tests/README.md
    // says where every tenth of these is enough.
    const bool is_sanitized = ROUNDS(15) < 15, is_quick = support_is_quick();
    const size_t stride = is_quick ? (is_sanitized ? 30 : 23) : is_sanitized ? 3 : 1; // other ones with sanitizers
    size_t failed = 0;
    for (size_t n = 1; n <= count; n += stride, failed++) {
        (void)live_through(n, ends, &end, &failures);
        if (failures != 1)
            print_error("allocation %zu of %zu: %u calls failed\n", n, count, (unsigned)failures);
        assert_int_equal(failures, 1);
        check_same(&end, &expected, "a failed allocation");
        free(end.bytes);
    }
    free(expected.bytes);
    test_free(ends);
    print_message("%zu of %zu allocations, each failed once\n", failed, count);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_failure_is_survived),
    };
    return cmocka_run_group_tests_name("fail_nth", tests, NULL, NULL);
}

/// @file test_growth_snapshots.c
/// Snapshots and clones of networks to which particles and springs have been added: what goes back goes on as it
/// did.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "growth.h"
#include "store/snapshot_format.h"
#include "support.h"

typedef struct saved {
    void *bytes;
    size_t size;
} saved;

static saved save(const mspring_network *network, mspring_snapshot_contents contents) {
    saved out;
    check_ok(mspring_network_get_snapshot_size(network, contents, &out.size));
    out.bytes = malloc(out.size);
    assert_non_null(out.bytes);
    check_ok(mspring_network_save(network, contents, out.bytes, out.size, NULL));
    return out;
}

// Forward and back again: from what a snapshot holds the same edits and steps lead to the same bits, in the network
// itself, in its clone, and in one that was only just made.
static void snapshots_go_back_and_forth(void **state) {
    (void)state;
    recipe made = growth_recipe();
    for (int solver = 0; solver <= 1; solver++) {
        life *it = growth_begin(&made, MSPRING_SIMD_AUTO, 1, 31 + (uint64_t)solver);
        mspring_network *young = growth_network(&made, MSPRING_SIMD_SCALAR, 2);
        if (solver == 1) {
            growth_use(it->network, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, 0);
            growth_use(young, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, 0);
        }
        for (int round = 0; round < 12; round++) {
            for (int i = 0; i < 9; i++) {
                life_do_something(it);
            }
            check_ok(mspring_network_step(it->network, 1.0 / 64));
            const saved here = save(it->network, MSPRING_SNAPSHOT_ALL);
            const life then = *it;
            mspring_network *clone = NULL;
            check_ok(mspring_network_clone(it->network, NULL, &clone));
            uint64_t hashes[3][6];
            mspring_network *const networks[] = {it->network, clone, young};
            for (int n = 0; n < 3; n++) {
                *it = then;
                it->network = networks[n];
                if (n == 2) {
                    check_ok(mspring_network_load(young, here.bytes, here.size));
                }
                life_check(it);
                for (int i = 0; i < 6; i++) {
                    life_do_something(it);
                    check_ok(mspring_network_step(it->network, 1.0 / 64));
                    hashes[n][i] = support_hash(it->network);
                }
            }
            assert_memory_equal(hashes[1], hashes[0], sizeof hashes[0]);
            assert_memory_equal(hashes[2], hashes[0], sizeof hashes[0]);
            mspring_network_destroy(clone);
            const saved there = save(young, MSPRING_SNAPSHOT_ALL);
            const uint64_t used = support_memory_used(young);
            check_ok(mspring_network_load(young, here.bytes, here.size));
            check_ok(mspring_network_load(young, there.bytes, there.size));
            assert_int_equal(support_memory_used(young), used); // what comparing them took is given back
            free(there.bytes);
            *it = then;
            check_ok(mspring_network_load(it->network, here.bytes, here.size));
            life_check(it);
            for (int i = 0; i < 6; i++) {
                life_do_something(it);
                check_ok(mspring_network_step(it->network, 1.0 / 64));
                assert_int_equal(support_hash(it->network), hashes[0][i]);
            }
            free(here.bytes);
        }
        mspring_network_destroy(young);
        growth_end(it);
    }
    recipe_free(&made);
}

// Within one compact plan, too, whatever became of the added ones that it has laid out.
static void snapshots_go_back_in_a_compact_plan(void **state) {
    (void)state;
    recipe made = growth_recipe();
    life *it = growth_begin(&made, MSPRING_SIMD_AUTO, 1, 53);
    int again_count = 0;
    for (int round = 0; round < 8; round++) {
        for (int i = 0; i < 12; i++) {
            life_do_something(it);
        }
        check_ok(mspring_network_compact(it->network));
        const saved here = save(it->network, MSPRING_SNAPSHOT_ALL);
        const life then = *it;
        uint64_t hashes[4] = {0};
        for (int again = 0; again <= 1; again++) {
            for (int i = 0; i < 4; i++) {
                life_do_something(it);
                life_do_something(it);
                check_ok(mspring_network_step(it->network, 1.0 / 64));
                hashes[i] = again ? hashes[i] : support_hash(it->network);
                assert_int_equal(support_hash(it->network), hashes[i]);
            }
            if (mspring_network_load(it->network, here.bytes, here.size) != MSPRING_OK) {
                check_contains(mspring_network_error(it->network), "laid out otherwise");
                break;
            }
            *it = then;
            life_check(it);
            again_count += again;
        }
        free(here.bytes);
    }
    assert_true(again_count > 2); // restoring a spring that the plan leaves out makes it another plan
    growth_end(it);
    recipe_free(&made);
}

// A frame leaves out what springs are like, so it is refused where there are others.
static void frames_are_of_the_same_springs(void **state) {
    (void)state;
    recipe made = growth_recipe();
    life *it = growth_begin(&made, MSPRING_SIMD_AUTO, 1, 3);
    life_add(it, 3, 4);
    const saved here = save(it->network, MSPRING_SNAPSHOT_FRAME);
    support_steps(it->network, 2, 1.0 / 64);
    check_ok(mspring_network_load(it->network, here.bytes, here.size));
    life_check(it);
    life_add(it, 1, 0);
    check_error(mspring_network_load(it->network, here.bytes, here.size), MSPRING_ERROR_SNAPSHOT);
    life_check(it);
    free(here.bytes);
    growth_end(it);
    recipe_free(&made);
}

/// In a compact plan an added particle has a place among the others, and who comes after it the one that was kept
/// for the id: a snapshot brings back either.
static void added_ones_go_back_to_where_they_were(void **state) {
    (void)state;
    uint64_t seed = 4;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {20, 60}};
    recipe made = {0};
    recipe_lattice(&made, 5, 3, 0, 0, 1, &stuff, &seed);
    const mspring_id first = recipe_particle(&made, 0, 9, 1, 0);
    mspring_network_def def = support_def(-9.8f, 2);
    def.flags = MSPRING_NETWORK_RESERVE_RELATIVE;
    def.spare_particles = def.spare_springs = 2;
    mspring_network *network = recipe_network(&made, &def);
    mspring_particle_def particles[2];
    mspring_spring_def springs[2];
    mspring_id ids[2], joints[2];
    for (uint32_t i = 0; i < 2; i++) {
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particles[i], sizeof particles[i]));
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &springs[i], sizeof springs[i]));
        particles[i].x = 3 * i;
        particles[i].y = 20;
        springs[i].a = first;
        springs[i].b = first + 1 + i;
        springs[i].stiffness = i == 0 ? 10 : 0.001f;
        springs[i].flags = i == 0 ? 0 : MSPRING_SPRING_RELATIVE;
    }
    check_ok(mspring_network_add_particles(network, particles, 2, ids));
    check_ok(mspring_network_add_springs(network, springs, 2, joints));
    check_ok(mspring_network_compact(network));
    support_steps(network, 3, 0.01);
    saved states[3]; // with both of them in the plan, with one, and with one and another
    mspring_network *clones[3];
    states[0] = save(network, MSPRING_SNAPSHOT_ALL);
    check_ok(mspring_network_clone(network, NULL, &clones[0]));
    check_ok(mspring_network_remove_particles(network, &ids[0], 0, 1));
    check_ok(mspring_network_reuse_ids(network));
    support_steps(network, 3, 0.01);
    states[1] = save(network, MSPRING_SNAPSHOT_ALL);
    check_ok(mspring_network_clone(network, NULL, &clones[1]));
    particles[0].x = 40;
    const mspring_id expected = ids[0];
    check_ok(mspring_network_add_particles(network, particles, 1, ids));
    assert_int_equal(ids[0], expected);
    support_steps(network, 3, 0.01);
    states[2] = save(network, MSPRING_SNAPSHOT_ALL);
    check_ok(mspring_network_clone(network, NULL, &clones[2]));
    uint64_t hashes[3];
    for (int i = 0; i < 3; i++) {
        support_steps(clones[i], 5, 0.01);
        hashes[i] = support_hash(clones[i]);
    }
    // From each to each, in the network and in its clones; once more after all have been made whole.
    for (int turn = 0; turn < 2; turn++) {
        for (int i = 0; i < 9; i++) {
            const int to = (i / 3 + i) % 3;
            check_ok(mspring_network_load(network, states[to].bytes, states[to].size));
            support_steps(network, 5, 0.01);
            assert_int_equal(support_hash(network), hashes[to]);
            check_ok(mspring_network_load(clones[i % 3], states[to].bytes, states[to].size));
            support_steps(clones[i % 3], 5, 0.01);
            assert_int_equal(support_hash(clones[i % 3]), hashes[to]);
        }
    }
    // Out of the compact plan again, all are where they were.
    for (int i = 0; i < 3; i++) {
        check_ok(mspring_network_load(network, states[i].bytes, states[i].size));
        const uint64_t before = support_hash(network);
        check_ok(support_expand(network));
        assert_int_equal(support_hash(network), before);
        check_ok(mspring_network_compact(network));
        mspring_network_destroy(network);
        network = clones[i];
        check_ok(mspring_network_load(network, states[(i + 1) % 3].bytes, states[(i + 1) % 3].size));
    }
    mspring_network_destroy(network);
    for (int i = 0; i < 3; i++) {
        free(states[i].bytes);
    }
    recipe_free(&made);
}

/// Two bars of a spring each, and two particles that hang on nothing.
static mspring_network *bars_and_loose_ones(void) {
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    support_particle(builder, 5, 5, 1);
    for (mspring_id p = 2; p < 6; p++) {
        support_particle(builder, p, -1, 1);
    }
    support_spring(builder, 2, 3, 100, 0);
    support_spring(builder, 4, 5, 100, 0);
    mspring_network_def def = support_def(-9.8f, 2);
    def.flags = MSPRING_NETWORK_RESERVE_DAMPING;
    def.spare_particles = def.spare_springs = 2;
    return support_network(builder, &def);
}

static mspring_result load_frame_of(const mspring_network *from, mspring_network *to) {
    const saved frame = save(from, MSPRING_SNAPSHOT_FRAME);
    const mspring_result result = mspring_network_load(to, frame.bytes, frame.size);
    free(frame.bytes);
    return result;
}

/// Frames go to networks that were edited alike: what was removed, and that ids were given back, counts, and so
/// does what springs were made like, whatever it was before.
static void frames_are_of_networks_edited_alike(void **state) {
    (void)state;
    enum { NOTHING, SPRING, PARTICLE, RECYCLED, BREAK, STRESS, STIFFNESS, DAMPING, LENGTH };
    const struct {
        int kind;
        mspring_id id;
        float value;
    } edits[] = {{NOTHING, 0, 0},    {SPRING, 0, 0},     {SPRING, 1, 0},       {PARTICLE, 0, 0},
                 {PARTICLE, 1, 0},   {RECYCLED, 0, 0},   {BREAK, 0, 0.5f},     {BREAK, 1, 0.5f},
                 {BREAK, 0, 0.25f},  {STRESS, 0, 0.5f},  {STRESS, 1, 0.5f},    {LENGTH, 0, 0.5f},
                 {LENGTH, 1, 0.5f},  {LENGTH, 0, 0.25f}, {STIFFNESS, 0, 0.5f}, {STIFFNESS, 1, 0.5f},
                 {DAMPING, 0, 0.5f}, {DAMPING, 1, 0.5f}, {DAMPING, 1, 0.25f}};
    mspring_network *networks[COUNT_OF(edits)];
    for (size_t i = 0; i < COUNT_OF(edits); i++) {
        mspring_network *network = networks[i] = bars_and_loose_ones();
        // So that all have memory for what is removed and added.
        mspring_particle_def particle;
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
        mspring_id id;
        check_ok(mspring_network_add_particles(network, &particle, 1, &id));
        check_ok(mspring_network_remove_particles(network, &id, 0, 1));
        id = edits[i].id;
        const float *value = &edits[i].value;
        switch (edits[i].kind) {
        case SPRING:
            check_ok(mspring_network_remove_springs(network, &id, 0, 1));
            break;
        case PARTICLE:
            check_ok(mspring_network_remove_particles(network, &id, 0, 1));
            break;
        case RECYCLED:
            check_ok(mspring_network_reuse_ids(network));
            break;
        case BREAK:
            check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, id, 1, value, 1));
            break;
        case STRESS:
            check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, id, 1, value, 1));
            break;
        case STIFFNESS:
            check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, id, 1, value, 1));
            break;
        case DAMPING:
            check_ok(mspring_network_set(network, MSPRING_DAMPING, NULL, id, 1, value, 1));
            break;
        case LENGTH:
            check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, id, 1, value, 1));
            break;
        default:
            break;
        }
    }
    for (size_t i = 0; i < COUNT_OF(edits); i++) {
        for (size_t j = 0; j < COUNT_OF(edits); j++) {
            check_error(load_frame_of(networks[i], networks[j]), i == j ? MSPRING_OK : MSPRING_ERROR_SNAPSHOT);
        }
    }
    for (size_t i = 0; i < COUNT_OF(edits); i++) {
        mspring_network_destroy(networks[i]);
    }
}

// Whatever byte of a snapshot's section is another one (and the checksum right again) is refused or leads to a
// network that can be checked and stepped.
static void foreign_growth_is_refused_or_harmless(void **state) {
    (void)state;
    recipe made = growth_recipe();
    life *it = growth_begin(&made, MSPRING_SIMD_AUTO, 1, 8);
    for (int i = 0; i < 40; i++) {
        life_do_something(it);
    }
    const saved here = save(it->network, MSPRING_SNAPSHOT_ALL);
    unsigned char *bytes = here.bytes;
    const size_t growth = MSPRINGI_SNAPSHOT_HEADER_BYTES + MSPRINGI_SECTION_HEADER_BYTES;
    assert_memory_equal(bytes + growth - MSPRINGI_SECTION_HEADER_BYTES, "grow", 4);
    const size_t summed = here.size - MSPRINGI_SNAPSHOT_CHECKSUM_BYTES;
    uint32_t refused = 0;
    const size_t end_of_growth = growth + 8 + LIFE_PARTICLES + LIFE_SPRINGS;
    for (size_t i = growth; i < end_of_growth && i < summed; i += 3) {
        const unsigned char before = bytes[i];
        bytes[i] = (unsigned char)support_random(&it->seed);
        mspringi_checksum checksum = {{0}, {0}};
        mspringi_kernels_scalar.checksum(NULL, bytes, summed / MSPRINGI_CHECKSUM_UNIT, &checksum);
        const uint64_t value = mspringi_checksum_value(&checksum);
        memcpy(bytes + summed, &value, sizeof value); // little-endian, as the machines that this runs on
        const mspring_result result = mspring_network_load(it->network, bytes, here.size);
        assert_true(result == MSPRING_OK || result == MSPRING_ERROR_SNAPSHOT);
        refused += result != MSPRING_OK;
        const mspring_result stepped = mspring_network_step(it->network, 1.0 / 640);
        assert_true(stepped == MSPRING_OK || stepped == MSPRING_ERROR_UNSTABLE);
        bytes[i] = before;
    }
    assert_true(refused > 100);
    free(here.bytes);
    growth_end(it);
    recipe_free(&made);
}

/* ----------------------------------------------------------------------- networks that were only just made */

// A row of three particles with a relative spring from each to the next.
static mspring_network *relative_row(const mspring_network_def *def) {
    mspring_builder *builder = support_builder();
    for (mspring_id i = 0; i < 3; i++) {
        (void)support_particle(builder, i, 0, 1);
        mspring_spring_def spring;
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
        spring.a = i > 0 ? i - 1 : 0;
        spring.b = i;
        spring.stiffness = 0.1f;
        spring.flags = MSPRING_SPRING_RELATIVE;
        if (i > 0)
            check_ok(mspring_builder_add_springs(builder, &spring, 1, NULL));
    }
    return support_network(builder, def);
}

// Springs that have been removed have values in the young network until they are taken out of it: these are not
// derived for particles that are no longer there.
static void removed_relative_springs_are_left_alone(void **state) {
    (void)state;
    const mspring_network_def def = support_def(0, 4);
    mspring_network *old = relative_row(&def), *young = relative_row(&def);
    const mspring_id last = 2;
    check_ok(mspring_network_remove_particles(old, &last, 0, 1));
    support_steps(old, 1, 1.0 / 64);
    support_bring(old, young, MSPRING_SNAPSHOT_ALL);
    support_steps(old, 2, 1.0 / 64);
    support_steps(young, 2, 1.0 / 64);
    assert_true(support_hash(old) == support_hash(young));
    mspring_network_destroy(old);
    mspring_network_destroy(young);
}

/// What was removed is there again, and moves as it did, after a snapshot of before, which knows of no removal.
static void what_was_removed_comes_back(void **state) {
    (void)state;
    recipe made = recipe_mixed(7);
    const mspring_network_def def = support_def(-9.8f, 4);
    mspring_network *network = recipe_network(&made, &def);
    const saved before = save(network, MSPRING_SNAPSHOT_ALL);
    support_steps(network, 5, 1.0 / 64);
    const uint64_t hash = support_hash(network);
    check_ok(mspring_network_remove_springs(network, NULL, 0, made.spring_count / 2));
    check_ok(mspring_network_remove_particles(network, NULL, made.particle_count / 2, made.particle_count / 2));
    check_ok(mspring_network_load(network, before.bytes, before.size));
    for (mspring_id s = 0; s < made.spring_count; s++) {
        support_spring_info info;
        check_ok(support_get_spring(network, s, &info));
        assert_true(info.a == made.springs[s].a && info.b == made.springs[s].b);
    }
    support_steps(network, 5, 1.0 / 64);
    assert_int_equal(support_hash(network), hash);
    free(before.bytes);
    mspring_network_destroy(network);
    recipe_free(&made);
}

// An order of elimination without a spring that was removed gives other bits, so a snapshot does not fit a network
// whose order has it.
static void direct_snapshots_need_the_same_order(void **state) {
    (void)state;
    recipe made = growth_recipe();
    mspring_network *old = growth_network(&made, MSPRING_SIMD_AUTO, 1),
                    *young = growth_network(&made, MSPRING_SIMD_AUTO, 1);
    const mspring_id removed = 3;
    growth_use(young, MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_ALPHA, 0);
    check_ok(mspring_network_remove_springs(old, &removed, 0, 1));
    growth_use(old, MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_ALPHA, 0);
    const saved here = save(old, MSPRING_SNAPSHOT_ALL);
    check_error(mspring_network_load(young, here.bytes, here.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(young), "when the direct solver was chosen");
    // The same springs first, then the solver.
    check_ok(mspring_network_remove_springs(young, &removed, 0, 1));
    growth_use(young, MSPRING_SOLVER_EXPLICIT, MSPRING_INTEGRATOR_ALPHA, 0);
    growth_use(young, MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_ALPHA, 0);
    check_ok(mspring_network_load(young, here.bytes, here.size));
    free(here.bytes);
    support_steps(old, 2, 1.0 / 64);
    support_steps(young, 2, 1.0 / 64);
    assert_true(support_hash(old) == support_hash(young));
    mspring_network_destroy(old);
    mspring_network_destroy(young);
    recipe_free(&made);
}

/// Wherever the one broken spring is, a network that is whole takes it over, and back again.
static void take_over_breaks(mspring_builder *builder) {
    const mspring_network_def def = support_def(0, 4);
    mspring_network *broken = support_network(builder, &def), *other;
    check_ok(mspring_network_clone(broken, NULL, &other));
    const uint32_t count = mspring_network_count(broken, MSPRING_SPRINGS);
    const saved whole = save(broken, MSPRING_SNAPSHOT_ALL);
    for (mspring_id s = 0; s < count; s++) {
        check_ok(mspring_network_break_springs(broken, &s, 0, 1));
        const saved now = save(broken, MSPRING_SNAPSHOT_ALL);
        check_ok(mspring_network_load(other, now.bytes, now.size));
        for (mspring_id i = 0; i < count; i++) {
            uint32_t flags;
            check_ok(mspring_network_get_integers(other, MSPRING_SPRING_FLAGS, NULL, i, 1, &flags, 1));
            assert_true(((flags & MSPRING_SPRING_BROKEN) != 0) == (i == s));
        }
        assert_true(support_hash(other) == support_hash(broken));
        check_ok(mspring_network_load(other, whole.bytes, whole.size));
        check_ok(mspring_network_load(broken, whole.bytes, whole.size));
        assert_true(support_hash(other) == support_hash(broken));
        free(now.bytes);
    }
    free(whole.bytes);
    mspring_network_destroy(broken);
    mspring_network_destroy(other);
}

static void the_place_of_a_break_is_known(void **state) {
    (void)state;
    enum { COUNT = 32 };
    for (uint32_t way = 2; way < 6; way++) { // a rope, and rings with a second spring across of each particle
        mspring_builder *builder = support_builder();
        for (int p = 0; p < COUNT; p++)
            (void)support_particle(builder, 10 * cos(0.19 * p), 10 * sin(0.19 * p), 1);
        for (mspring_id p = 0; p < COUNT; p++) {
            if (way > 2 || p + 1 < COUNT)
                (void)support_spring(builder, p, (p + 1) % COUNT, 100, 0);
            if (way > 2)
                (void)support_spring(builder, p, (p + way) % COUNT, 100, 0);
        }
        take_over_breaks(builder);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(snapshots_go_back_and_forth),
        cmocka_unit_test(snapshots_go_back_in_a_compact_plan),
        cmocka_unit_test(added_ones_go_back_to_where_they_were),
        cmocka_unit_test(frames_are_of_the_same_springs),
        cmocka_unit_test(frames_are_of_networks_edited_alike),
        cmocka_unit_test(foreign_growth_is_refused_or_harmless),
        cmocka_unit_test(removed_relative_springs_are_left_alone),
        cmocka_unit_test(what_was_removed_comes_back),
        cmocka_unit_test(the_place_of_a_break_is_known),
        cmocka_unit_test(direct_snapshots_need_the_same_order),
    };
    return cmocka_run_group_tests_name("growth_snapshots", tests, NULL, NULL);
}

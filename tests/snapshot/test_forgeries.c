/// @file test_forgeries.c
/// What is no snapshot of a network is refused, whether it is damaged, of another network, or forged.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "recipe.h"
#include "snapshots.h"
#include "store/snapshot_format.h"
#include "support.h"

static void damage_is_found(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    mspring_network *network = snapshots_small_network(&made);
    saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    const uint64_t before = snapshots_look_at(network);
    for (size_t byte = 0; byte < good.size; byte++) {
        for (int bit = 0; bit < 8; bit++) {
            good.bytes[byte] ^= (uint8_t)(1 << bit);
            check_error(mspring_network_load(network, good.bytes, good.size), MSPRING_ERROR_SNAPSHOT);
            check_contains(mspring_network_error(network), "snapshot");
            good.bytes[byte] ^= (uint8_t)(1 << bit);
        }
    }
    for (size_t size = 0; size < good.size; size++) {
        uint8_t *cut = malloc(size + 1); // so that a reader past its end is found
        assert_non_null(cut);
        memcpy(cut, good.bytes, size);
        check_error(mspring_network_load(network, cut, size), MSPRING_ERROR_SNAPSHOT);
        free(cut);
    }
    check_error(mspring_network_load(network, good.bytes, good.size + 1), MSPRING_ERROR_SNAPSHOT);
    assert_int_equal(snapshots_look_at(network), before);
    // And it was good.
    snapshots_load(network, &good);
    assert_int_equal(snapshots_look_at(network), before);
    mspring_network_destroy(network);
    free(good.bytes);
    recipe_free(&made);
}

/// Whoever wants to do harm gets the checksum right. Whatever is in there: it is refused and nothing has changed,
/// or it is accepted and is a state like any other.
static void forge(mspring_solver kind, mspring_guard guard) {
    const uint32_t words[] = {0,          1,          0x7fc00000 /* NaN */, 0x7f800000 /* infinity */, 0xff800000,
                              0x7f7fffff, 0xffffffff, 0x80000000,           0xbf800000 /* -1 */,       0x00000001};
    recipe made = snapshots_small_recipe();
    mspring_network *network = snapshots_small_guarded(&made, guard);
    if (kind != MSPRING_SOLVER_EXPLICIT) {
        snapshots_use_solver(network, kind, MSPRING_INTEGRATOR_BDF2, 7);
        check_ok(mspring_network_step(network, 0.01));
    }
    saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    saved bad = {malloc(good.size), good.size};
    assert_non_null(bad.bytes);
    const uint64_t before = snapshots_look_at(network);
    uint32_t accepted = 0, refused = 0;
    for (size_t at = 0; at + 4 <= good.size - MSPRINGI_SNAPSHOT_CHECKSUM_BYTES; at += 4) {
        for (size_t i = 0; i < COUNT_OF(words); i++) {
            memcpy(bad.bytes, good.bytes, good.size);
            memcpy(bad.bytes + at, &words[i], sizeof words[i]);
            snapshots_renew_checksum(&bad);
            const mspring_result result = mspring_network_load(network, bad.bytes, bad.size);
            if (result != MSPRING_OK) {
                check_error(result, MSPRING_ERROR_SNAPSHOT);
                refused++;
                continue;
            }
            accepted++;
            const mspring_result stepped = mspring_network_step(network, 0.01);
            if (stepped != MSPRING_OK) {
                check_error(stepped, MSPRING_ERROR_UNSTABLE);
            }
            for (mspring_id p = 0; p < mspring_network_count(network, MSPRING_PARTICLES); p++) {
                const support_point is = support_position(network, p), moves = support_velocity(network, p);
                assert_true(isfinite(is.x) && isfinite(is.y) && isfinite(moves.x) && isfinite(moves.y));
            }
            snapshots_load(network, &good);
        }
        if (at % 256 == 0) {
            assert_int_equal(snapshots_look_at(network), before);
        }
    }
    assert_true(accepted > 100 && refused > 1000);
    assert_int_equal(snapshots_look_at(network), before);
    mspring_network_destroy(network);
    free(good.bytes);
    free(bad.bytes);
    recipe_free(&made);
}

static void forgeries_do_no_harm(void **state) {
    (void)state;
    forge(MSPRING_SOLVER_EXPLICIT, MSPRING_GUARD_GROWTH);
    forge(MSPRING_SOLVER_EXPLICIT, MSPRING_GUARD_IMPLICIT);
    forge(MSPRING_SOLVER_IMPLICIT, MSPRING_GUARD_GROWTH);
    forge(MSPRING_SOLVER_DIRECT, MSPRING_GUARD_CLAMP);
}

static mspring_network *make_compact(uint32_t spare, bool add) {
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {20, 60}};
    uint64_t seed = 4;
    recipe made = {0};
    recipe_lattice(&made, 5, 3, 0, 0, 1, &stuff, &seed);
    const mspring_id loose = recipe_particle(&made, 0, 9, 1, 0);
    mspring_network_def def = support_def(-9.8f, 2);
    def.spare_particles = def.spare_springs = spare;
    mspring_network *network = recipe_network(&made, &def);
    if (add) {
        mspring_particle_def particle;
        mspring_id id;
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
        particle.y = 20;
        check_ok(mspring_network_add_particles(network, &particle, 1, &id));
        mspring_spring_def spring;
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
        spring.a = loose, spring.b = id, spring.stiffness = 1;
        check_ok(mspring_network_add_springs(network, &spring, 1, &id));
    } else {
        const mspring_id corner = 0;
        check_ok(mspring_network_remove_particles(network, &corner, 0, 1));
    }
    check_ok(mspring_network_compact(network));
    recipe_free(&made);
    return network;
}

/// In a compact plan an added particle is where the plan has laid it out, or in the slot that was kept for it:
/// which of the two is up to the snapshot, so nothing may be wrong with what it has in either.
static void what_hides_in_other_slots_is_refused(void **state) {
    (void)state;
    const float bad[] = {NAN, INFINITY, 1e30f};
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        mspring_network *network = make_compact(1, true);
        const mspring_id joint = mspring_network_count(network, MSPRING_SPRINGS) - 1;
        check_ok(mspring_network_remove_springs(network, &joint, 0, 1));
        mspring_view view = {.struct_size = sizeof view};
        check_ok(mspring_network_get_view(network, &view));
        saved forged = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
        uint64_t size;
        uint8_t *growth = snapshots_section_of(&forged, "grow", &size),
                *motion = snapshots_section_of(&forged, "moti", &size);
        const uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES);
        uint8_t *slots = growth + 8 + particles + mspring_network_count(network, MSPRING_SPRINGS);
        assert_int_equal(*slots, 2); // laid out
        *slots = 0;
        for (uint32_t slot = 0; slot < 4 * view.slot_count; slot++) {
            if (view.particle_of_slot[slot % view.slot_count] == MSPRING_NONE) {
                mspringi_writer to = mspringi_writer_begin(motion + (size_t)4 * slot, &mspringi_kernels_scalar);
                mspringi_put(&to, &bad[i], 1, sizeof bad[i]);
            }
        }
        snapshots_renew_checksum(&forged);
        check_error(mspring_network_load(network, forged.bytes, forged.size), MSPRING_ERROR_SNAPSHOT);
        check_contains(mspring_network_error(network), "positions and velocities");
        check_near(support_position(network, particles - 1).y, 20, 0);
        free(forged.bytes);
        mspring_network_destroy(network);
    }
}

/// An added spring that a compact plan has laid out joins what lies at its ends there, in whatever order.
static void a_spring_that_is_laid_out_keeps_its_ends(void **state) {
    (void)state;
    mspring_network *network = make_compact(1, true);
    const uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES);
    const mspring_id ends[] = {particles - 2, particles - 1};
    saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    uint64_t size;
    const uint8_t *growth = snapshots_section_of(&good, "grow", &size);
    const size_t at = (size_t)(growth + size - good.bytes) - 8; // the ends of the only spare spring
    mspring_id saved_ends[2];
    mspringi_get(good.bytes + at, saved_ends, 2, sizeof saved_ends[0]);
    assert_memory_equal(saved_ends, ends, sizeof ends);
    assert_int_equal(good.bytes[at - 1], 2); // laid out
    const mspring_id others[][2] = {{3, ends[1]}, {ends[0], 3}, {ends[1], 3}, {3, ends[0]}, {3, 4}};
    for (size_t i = 0; i < COUNT_OF(others); i++) {
        saved bad = snapshots_copy(&good);
        snapshots_put_word(bad.bytes + at, others[i][0]);
        snapshots_put_word(bad.bytes + at + 4, others[i][1]);
        snapshots_check_refused(network, &bad, "joins particles");
        free(bad.bytes);
    }
    snapshots_put_word(good.bytes + at, ends[1]);
    snapshots_put_word(good.bytes + at + 4, ends[0]);
    snapshots_renew_checksum(&good);
    check_ok(mspring_network_load(network, good.bytes, good.size));
    free(good.bytes);
    mspring_network_destroy(network);
}

/// An added spring joins whom no other one joins, whichever way round, of those that were there and of those added.
static void two_springs_never_join_the_same(void **state) {
    (void)state;
    recipe made = {0};
    for (uint32_t i = 0; i < 5; i++)
        recipe_particle(&made, i, i % 2, 1, 0);
    for (mspring_id i = 0; i < 3; i++)
        recipe_spring(&made, i, i + 1, 10, 0, 0);
    mspring_network_def def = support_def(0, 1);
    def.spare_springs = 3, def.spare_particles = 1;
    mspring_network *network = recipe_network(&made, &def);
    mspring_particle_def particle = mspring_particle_def_default();
    mspring_id added[3];
    mspring_spring_def springs[3];
    const mspring_id ends[3][2] = {{0, 2}, {5, 4}, {4, 2}};
    particle.x = 9;
    check_ok(mspring_network_add_particles(network, &particle, 1, &added[0]));
    for (int i = 0; i < 3; i++) {
        springs[i] = mspring_spring_def_default();
        springs[i].a = ends[i][0], springs[i].b = ends[i][1], springs[i].stiffness = 10;
    }
    check_ok(mspring_network_add_springs(network, springs, 3, added));
    const saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    for (uint32_t i = 0; i < 36; i++) {
        const mspring_id a = i / 6, b = i % 6, low = a < b ? a : b, high = a < b ? b : a;
        if (a == b)
            continue;
        saved forged = snapshots_copy(&good);
        uint64_t size;
        uint8_t *const at = snapshots_section_of(&forged, "grow", &size) + size - sizeof ends;
        snapshots_put_word(at, a);
        snapshots_put_word(at + 4, b);
        const bool joins_first = high == low + 1 && high <= 3;
        if (joins_first) {
            snapshots_check_refused(network, &forged, "joins what another one joins");
        } else if (low == 4 || (low == 2 && high == 4)) {
            snapshots_check_refused(network, &forged, "two springs join particles");
        } else {
            snapshots_renew_checksum(&forged);
            check_ok(mspring_network_load(network, forged.bytes, forged.size));
            snapshots_load(network, &good);
        }
        free(forged.bytes);
    }
    free(good.bytes);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// A plan that has left out what was removed cannot bring it back, so it does not take a snapshot that says nothing
/// of what was removed.
static void what_a_plan_leaves_out_stays_out(void **state) {
    (void)state;
    mspring_network *network = make_compact(0, false);
    saved forged = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    mspringi_snapshot_header header;
    uint64_t size;
    uint8_t *growth = snapshots_section_of(&forged, "grow", &size);
    const size_t cut = MSPRINGI_SECTION_HEADER_BYTES + mspringi_round_up((size_t)size, 8);
    assert_true(mspringi_get_header(forged.bytes, &header));
    uint8_t *rest = growth + mspringi_round_up((size_t)size, 8);
    memmove(growth - MSPRINGI_SECTION_HEADER_BYTES, rest, (size_t)(forged.bytes + forged.size - rest));
    // What follows the sections is zeros up to the checksum.
    const size_t kept = forged.size - MSPRINGI_SNAPSHOT_CHECKSUM_BYTES - cut;
    forged.size = mspringi_round_up(kept, MSPRINGI_CHECKSUM_UNIT);
    memset(forged.bytes + kept, 0, forged.size - kept);
    forged.size += MSPRINGI_SNAPSHOT_CHECKSUM_BYTES;
    header.size = forged.size;
    header.section_count--;
    mspringi_writer to = mspringi_writer_begin(forged.bytes, &mspringi_kernels_scalar);
    mspringi_put_header(&to, &header);
    snapshots_renew_checksum(&forged);
    check_error(mspring_network_load(network, forged.bytes, forged.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(network), "particle 0 is there, which the plan leaves out");
    free(forged.bytes);
    mspring_network_destroy(network);
}

static void foreign_snapshots_are_refused(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe(), other_made = recipe_mixed(3), turned_made = snapshots_small_recipe();
    turned_made.springs[4].b = turned_made.springs[4].b == 10 ? 11 : 10;
    turned_made.springs[4].rest_length = 1.5f;
    mspring_network *network = snapshots_small_network(&made);
    mspring_network *other = snapshots_make(&other_made, MSPRING_SIMD_AUTO, 1);
    mspring_network *turned = snapshots_make(&turned_made, MSPRING_SIMD_AUTO, 1);
    saved of_other = snapshots_save(other, MSPRING_SNAPSHOT_ALL),
          of_turned = snapshots_save(turned, MSPRING_SNAPSHOT_ALL);
    const uint64_t before = snapshots_look_at(network);
    check_error(mspring_network_load(network, of_other.bytes, of_other.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(network), "particles");
    check_error(mspring_network_load(network, of_turned.bytes, of_turned.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(network), "another network");
    check_error(mspring_network_load(network, "These are some bytes that are no snapshot, by any means at all", 63),
                MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(network), "something else");
    assert_int_equal(snapshots_look_at(network), before);

    // A frame does not survive an edit of what it leaves out; everything does.
    saved frame = snapshots_save(network, MSPRING_SNAPSHOT_FRAME),
          all = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    const float stiffness = 60;
    check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, 1, 1, &stiffness, 1));
    const uint64_t edited = snapshots_look_at(network);
    check_error(mspring_network_load(network, frame.bytes, frame.size), MSPRING_ERROR_SNAPSHOT);
    assert_int_equal(snapshots_look_at(network), edited);
    snapshots_load(network, &all);
    assert_int_equal(snapshots_look_at(network), before);
    snapshots_load(network, &frame);
    assert_int_equal(snapshots_look_at(network), before);
    free(of_other.bytes);
    free(of_turned.bytes);
    free(frame.bytes);
    free(all.bytes);
    mspring_network_destroy(network);
    mspring_network_destroy(other);
    mspring_network_destroy(turned);
    recipe_free(&made);
    recipe_free(&other_made);
    recipe_free(&turned_made);
}

/// Snapshots of before and after a change of the format: neither is taken for the other.
static void other_versions_say_so(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    mspring_network *network = snapshots_small_network(&made);
    saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    const uint64_t before = snapshots_look_at(network);
    const uint32_t others[] = {0, MSPRINGI_SNAPSHOT_VERSION - 1, MSPRINGI_SNAPSHOT_VERSION + 1, UINT32_MAX};
    for (size_t i = 0; i < COUNT_OF(others); i++) {
        saved other = {malloc(good.size), good.size};
        char expected[80];
        assert_non_null(other.bytes);
        memcpy(other.bytes, good.bytes, good.size);
        mspringi_writer to = mspringi_writer_begin(other.bytes + 8, &mspringi_kernels_scalar); // behind the magic
        mspringi_put(&to, &others[i], 1, sizeof others[i]);
        snapshots_renew_checksum(&other);
        check_error(mspring_network_load(network, other.bytes, other.size), MSPRING_ERROR_SNAPSHOT);
        snprintf(expected, sizeof expected, "version %u, this library knows version %u", (unsigned)others[i],
                 (unsigned)MSPRINGI_SNAPSHOT_VERSION);
        check_contains(mspring_network_error(network), expected);
        assert_int_equal(snapshots_look_at(network), before);
        free(other.bytes);
    }
    mspring_network_destroy(network);
    free(good.bytes);
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------------------------ the frame */

/// The checksum is a part of the format: of the same bytes it is the same everywhere, and of the same words in
/// another order it is another.
static void checksums_tell_words_and_their_order(void **state) {
    (void)state;
    uint8_t bytes[4 * MSPRINGI_CHECKSUM_UNIT], other[sizeof bytes];
    for (size_t i = 0; i < sizeof bytes; i++) {
        bytes[i] = (uint8_t)(i * i + 7 * i / 64);
    }
    mspringi_checksum sum = {{0}, {0}};
    mspringi_kernels_scalar.checksum(NULL, bytes, 4, &sum);
    assert_true(mspringi_checksum_value(&sum) == UINT64_C(0x2abf2411296e2398));
    for (size_t a = 0; a < 4; a++) {
        for (size_t b = 0; b < a; b++) {
            memcpy(other, bytes, sizeof bytes);
            memcpy(other + a * MSPRINGI_CHECKSUM_UNIT, bytes + b * MSPRINGI_CHECKSUM_UNIT, MSPRINGI_CHECKSUM_UNIT);
            memcpy(other + b * MSPRINGI_CHECKSUM_UNIT, bytes + a * MSPRINGI_CHECKSUM_UNIT, MSPRINGI_CHECKSUM_UNIT);
            mspringi_checksum swapped = {{0}, {0}};
            mspringi_kernels_scalar.checksum(NULL, other, 4, &swapped);
            assert_true(mspringi_checksum_value(&swapped) != mspringi_checksum_value(&sum));
        }
    }
}

/// The last section ends before the checksum, and there are as many as are counted, each once.
static void sections_end_where_they_end(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    mspring_network *network = snapshots_small_network(&made);
    saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    mspringi_snapshot_header header;
    uint64_t size;
    assert_true(mspringi_get_header(good.bytes, &header));
    const uint8_t *last = snapshots_section_of(&good, "guar", &size);
    const size_t at = (size_t)(last - good.bytes);
    const size_t left = good.size - MSPRINGI_SNAPSHOT_CHECKSUM_BYTES - at;
    const uint64_t sizes[] = {left + 1, left + 8, left + 16, left + 56, UINT64_MAX, UINT64_MAX - 6, 0};
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        saved bad = snapshots_copy(&good);
        mspringi_writer to = mspringi_writer_begin(bad.bytes + at - 8, &mspringi_kernels_scalar);
        mspringi_put(&to, &sizes[i], 1, sizeof sizes[i]);
        snapshots_check_refused(network, &bad, "they do not fit in");
        free(bad.bytes);
    }
    saved bad = snapshots_copy(&good);
    snapshots_put_word(bad.bytes + 12, header.section_count + 1);
    snapshots_check_refused(network, &bad, "section that this library does not know");
    snapshots_put_word(bad.bytes + 12, header.section_count - 1);
    snapshots_check_refused(network, &bad, "they take 0 bytes");
    free(bad.bytes);
    bad = snapshots_copy(&good);
    memcpy(snapshots_section_of(&bad, "moti", &size) - MSPRINGI_SECTION_HEADER_BYTES, "sett", 4);
    snapshots_check_refused(network, &bad, "settings: they do not fit in, or come twice");
    free(bad.bytes);
    free(good.bytes);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// As many particles, but another number of springs.
static void springs_are_counted(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe(), fewer = snapshots_small_recipe();
    fewer.spring_count--;
    mspring_network *network = snapshots_make(&made, MSPRING_SIMD_AUTO, 1);
    mspring_network *other = snapshots_make(&fewer, MSPRING_SIMD_AUTO, 1);
    saved of_other = snapshots_save(other, MSPRING_SNAPSHOT_ALL);
    snapshots_check_refused(network, &of_other, "particles and");
    free(of_other.bytes);
    mspring_network_destroy(network);
    mspring_network_destroy(other);
    recipe_free(&made);
    recipe_free(&fewer);
}

/// Bytes without meaning are 0: in the header, in those of sections, and behind each section.
static void unused_bytes_are_zero(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    mspring_network *network = snapshots_small_network(&made);
    saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    const size_t end = good.size - MSPRINGI_SNAPSHOT_CHECKSUM_BYTES;
    size_t at = MSPRINGI_SNAPSHOT_HEADER_BYTES, unused = 0;
    uint8_t *is_unused = calloc(good.size, 1);
    assert_non_null(is_unused);
    memset(is_unused + 36, 1, 4); // reserved word of the header
    while (at + MSPRINGI_SECTION_HEADER_BYTES <= end && good.bytes[at] != 0) {
        uint64_t size;
        memset(is_unused + at + 4, 1, 4);
        mspringi_get(good.bytes + at + 8, &size, 1, sizeof size);
        at += MSPRINGI_SECTION_HEADER_BYTES;
        memset(is_unused + at + size, 1, mspringi_round_up((size_t)size, 8) - (size_t)size);
        at += mspringi_round_up((size_t)size, 8);
    }
    memset(is_unused + at, 1, end - at);
    for (size_t i = 0; i < good.size; i++) {
        if (!is_unused[i])
            continue;
        for (int bit = 0; bit < 8; bit++) {
            saved bad = snapshots_copy(&good);
            bad.bytes[i] ^= (uint8_t)(1u << bit);
            snapshots_check_refused(network, &bad, "");
            free(bad.bytes);
        }
        unused++;
    }
    assert_true(unused > 50);
    free(is_unused);
    free(good.bytes);
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damage_is_found),
        cmocka_unit_test(forgeries_do_no_harm),
        cmocka_unit_test(what_hides_in_other_slots_is_refused),
        cmocka_unit_test(a_spring_that_is_laid_out_keeps_its_ends),
        cmocka_unit_test(two_springs_never_join_the_same),
        cmocka_unit_test(what_a_plan_leaves_out_stays_out),
        cmocka_unit_test(foreign_snapshots_are_refused),
        cmocka_unit_test(other_versions_say_so),
        cmocka_unit_test(checksums_tell_words_and_their_order),
        cmocka_unit_test(sections_end_where_they_end),
        cmocka_unit_test(springs_are_counted),
        cmocka_unit_test(unused_bytes_are_zero),
    };
    return cmocka_run_group_tests_name("forgeries", tests, NULL, NULL);
}

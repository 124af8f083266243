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
#include "snapshot/format.h"
#include "snapshots.h"
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

static mspring_network *small_guarded(const recipe *made, mspring_guard guard) {
    mspring_network_def def = support_def(-9.8f, 4);
    def.guard = guard;
    mspring_network *network = recipe_network(made, &def);
    snapshots_set_up(network);
    for (uint32_t frame = 0; frame < 6; frame++) {
        snapshots_run_frame(network, frame);
    }
    return network;
}

/// Whoever wants to do harm gets the checksum right. Whatever is in there: it is refused and nothing has changed,
/// or it is accepted and is a state like any other.
static void forge(mspring_solver kind, mspring_guard guard) {
    const uint32_t words[] = {0,          1,          0x7fc00000 /* NaN */, 0x7f800000 /* infinity */, 0xff800000,
                              0x7f7fffff, 0xffffffff, 0x80000000,           0xbf800000 /* -1 */,       0x00000001};
    recipe made = snapshots_small_recipe();
    mspring_network *network = small_guarded(&made, guard);
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
            for (mspring_id p = 0; p < mspring_network_particle_count(network); p++) {
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
        check_ok(mspring_particle_def_init(&particle, sizeof particle));
        particle.y = 20;
        check_ok(mspring_network_add_particles(network, &particle, 1, &id));
        mspring_spring_def spring;
        check_ok(mspring_spring_def_init(&spring, sizeof spring));
        spring.a = loose, spring.b = id, spring.stiffness = 1;
        check_ok(mspring_network_add_springs(network, &spring, 1, &id));
    } else {
        const mspring_id corner = 0;
        check_ok(mspring_network_remove_particles(network, &corner, 1));
    }
    check_ok(mspring_network_compact(network, 0, NULL));
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
        const mspring_id joint = mspring_network_spring_count(network) - 1;
        check_ok(mspring_network_remove_springs(network, &joint, 1));
        mspring_view view = {.struct_size = sizeof view};
        check_ok(mspring_network_view(network, &view));
        saved forged = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
        uint64_t size;
        uint8_t *growth = snapshots_section_of(&forged, "grow", &size),
                *motion = snapshots_section_of(&forged, "moti", &size);
        const uint32_t particles = mspring_network_particle_count(network);
        uint8_t *slots = growth + 8 + particles + mspring_network_spring_count(network);
        assert_int_equal(*slots, 2); // laid out
        *slots = 0;
        for (uint32_t slot = 0; slot < 4 * view.slot_count; slot++) {
            if (view.particle_of_slot[slot % view.slot_count] == MSPRING_NONE) {
                mspringi_writer to = mspringi_writer_begin(motion + (size_t)4 * slot);
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
    mspringi_writer to = mspringi_writer_begin(forged.bytes);
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
    check_ok(mspring_network_set_stiffnesses(network, 1, 1, &stiffness));
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
        mspringi_writer to = mspringi_writer_begin(other.bytes + 8); // behind the magic
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
    mspringi_checksum_add(&sum, bytes, 4);
    assert_true(mspringi_checksum_value(&sum) == UINT64_C(0x2abf2411296e2398));
    for (size_t a = 0; a < 4; a++) {
        for (size_t b = 0; b < a; b++) {
            memcpy(other, bytes, sizeof bytes);
            memcpy(other + a * MSPRINGI_CHECKSUM_UNIT, bytes + b * MSPRINGI_CHECKSUM_UNIT, MSPRINGI_CHECKSUM_UNIT);
            memcpy(other + b * MSPRINGI_CHECKSUM_UNIT, bytes + a * MSPRINGI_CHECKSUM_UNIT, MSPRINGI_CHECKSUM_UNIT);
            mspringi_checksum swapped = {{0}, {0}};
            mspringi_checksum_add(&swapped, other, 4);
            assert_true(mspringi_checksum_value(&swapped) != mspringi_checksum_value(&sum));
        }
    }
}

static saved copy_of(const saved *from) {
    saved out = {malloc(from->size), from->size};
    assert_non_null(out.bytes);
    memcpy(out.bytes, from->bytes, from->size);
    return out;
}

static void put_word(uint8_t *at, uint32_t word) {
    mspringi_writer to = mspringi_writer_begin(at);
    mspringi_put(&to, &word, 1, sizeof word);
}

static void put_float(uint8_t *at, float value) {
    mspringi_writer to = mspringi_writer_begin(at);
    mspringi_put(&to, &value, 1, sizeof value);
}

static void put_double(uint8_t *at, double value) {
    mspringi_writer to = mspringi_writer_begin(at);
    mspringi_put(&to, &value, 1, sizeof value);
}

/// Loading it fails with this, and changes nothing.
static void check_refused(mspring_network *network, saved *forged, const char *part) {
    const uint64_t before = snapshots_look_at(network);
    snapshots_renew_checksum(forged);
    check_error(mspring_network_load(network, forged->bytes, forged->size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(network), part);
    assert_int_equal(snapshots_look_at(network), before);
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
        saved bad = copy_of(&good);
        mspringi_writer to = mspringi_writer_begin(bad.bytes + at - 8);
        mspringi_put(&to, &sizes[i], 1, sizeof sizes[i]);
        check_refused(network, &bad, "they do not fit in");
        free(bad.bytes);
    }
    saved bad = copy_of(&good);
    put_word(bad.bytes + 12, header.section_count + 1);
    check_refused(network, &bad, "section that this library does not know");
    put_word(bad.bytes + 12, header.section_count - 1);
    check_refused(network, &bad, "they take 0 bytes");
    free(bad.bytes);
    bad = copy_of(&good);
    memcpy(snapshots_section_of(&bad, "moti", &size) - MSPRINGI_SECTION_HEADER_BYTES, "sett", 4);
    check_refused(network, &bad, "settings: they do not fit in, or come twice");
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
    check_refused(network, &of_other, "particles and");
    free(of_other.bytes);
    mspring_network_destroy(network);
    mspring_network_destroy(other);
    recipe_free(&made);
    recipe_free(&fewer);
}

/// Each section says of itself how long it has to be.
static void check_sizes(mspring_network *network, const char *const *tags, size_t count) {
    saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    for (size_t i = 0; i < count; i++) {
        uint64_t size;
        const size_t at = (size_t)(snapshots_section_of(&good, tags[i], &size) - good.bytes);
        const int64_t off[] = {-7, -4, -1, 1, 4, 7};
        uint32_t tried = 0;
        for (size_t k = 0; k < COUNT_OF(off); k++) {
            const uint64_t other = size + (uint64_t)off[k];
            if (other == 0 || mspringi_round_up((size_t)other, 8) != mspringi_round_up((size_t)size, 8)) {
                continue; // the sections behind it would not be found
            }
            saved bad = copy_of(&good);
            mspringi_writer to = mspringi_writer_begin(bad.bytes + at - 8);
            mspringi_put(&to, &other, 1, sizeof other);
            check_refused(network, &bad, "they take");
            free(bad.bytes);
            tried++;
        }
        assert_true(tried > 0);
    }
    free(good.bytes);
}

static mspring_network *grown(mspring_solver solver);
static mspring_network *half_asleep(void);

static void sections_are_as_long_as_they_must_be(void **state) {
    (void)state;
    static const char *const of_small[] = {"sett", "moti", "mass", "forc", "brok", "valu",
                                           "brks", "strs", "stsd", "ramp", "guar"};
    static const char *const of_grown[] = {"grow", "moti", "impl"}, *const of_sleeping[] = {"slee"};
    recipe made = snapshots_small_recipe();
    mspring_network *networks[] = {small_guarded(&made, MSPRING_GUARD_IMPLICIT), grown(MSPRING_SOLVER_IMPLICIT),
                                   half_asleep()};
    check_sizes(networks[0], of_small, COUNT_OF(of_small));
    check_sizes(networks[1], of_grown, COUNT_OF(of_grown));
    check_sizes(networks[2], of_sleeping, COUNT_OF(of_sleeping));
    for (size_t i = 0; i < COUNT_OF(networks); i++) {
        mspring_network_destroy(networks[i]);
    }
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------------------------------ growth */

enum { SPARE = 5 };

/// Two particles and three springs have been added, and one of each removed again.
static mspring_network *grown(mspring_solver solver) {
    recipe made = snapshots_small_recipe();
    mspring_network_def def = support_def(-9.8f, 4);
    def.spare_particles = def.spare_springs = SPARE;
    mspring_network *network = recipe_network(&made, &def);
    mspring_particle_def particle[2];
    mspring_spring_def spring[3];
    mspring_id ids[3], joined[3];
    for (int i = 0; i < 3; i++) {
        check_ok(mspring_spring_def_init(&spring[i], sizeof spring[i]));
        spring[i].stiffness = 20;
        if (i < 2) {
            check_ok(mspring_particle_def_init(&particle[i], sizeof particle[i]));
            particle[i].x = 2 * i;
            particle[i].y = 5;
        }
    }
    check_ok(mspring_network_add_particles(network, particle, 2, ids));
    spring[0].a = 0, spring[0].b = ids[0];
    spring[1].a = ids[0], spring[1].b = 5;
    spring[2].a = ids[1], spring[2].b = 7;
    check_ok(mspring_network_add_springs(network, spring, 3, joined));
    check_ok(mspring_network_remove_particles(network, &ids[1], 1)); // with its spring
    if (solver != MSPRING_SOLVER_EXPLICIT) {
        mspring_solver_def chosen;
        check_ok(mspring_solver_def_init(&chosen, sizeof chosen));
        chosen.solver = solver;
        check_ok(mspring_network_set_solver(network, &chosen));
    }
    check_ok(mspring_network_step(network, 0.01));
    recipe_free(&made);
    return network;
}

/// A byte or a word of the section, and what is said of it.
typedef struct forgery {
    size_t at;
    uint32_t value;
    bool is_word;
    const char *part;
} forgery;

static void forged_growth_is_refused(void **state) {
    (void)state;
    enum { GONE = 0, THERE = 1, FREE = 2, LAID_OUT = 2 };
    recipe made = snapshots_small_recipe();
    const uint32_t particles = made.particle_count, springs = made.spring_count;
    const size_t marks = 8, spring_marks = marks + particles + SPARE, slots = spring_marks + springs + SPARE;
    const size_t kinds = slots + SPARE, ends = kinds + SPARE;
    const forgery forgeries[] = {
        {0, particles - 1, true, "they count"},
        {0, particles + SPARE + 1, true, "they count"},
        {0, UINT32_MAX, true, "they count"},
        {4, springs - 1, true, "they count"},
        {4, springs + SPARE + 1, true, "they count"},
        {marks, 3, false, "they count"},
        {marks + particles - 1, FREE, false, "they count"},
        {marks + particles + SPARE - 1, THERE, false, "they count"},
        {marks + particles + SPARE - 1, GONE, false, "they count"},
        {spring_marks, 255, false, "they count"},
        {spring_marks + springs - 1, FREE, false, "they count"},
        {spring_marks + springs + SPARE - 1, THERE, false, "they count"},
        {slots, 1, false, "lies where it cannot"},
        {slots, LAID_OUT, false, "lies where it cannot"},
        {slots + SPARE - 1, 255, false, "lies where it cannot"},
        {marks, GONE, false, "without particle 0"},
        {marks + particles, GONE, false, "joins particles"},
        {kinds, LAID_OUT, false, "is of kind 2"},
        {kinds + SPARE - 1, 4, false, "is of kind 4"},
        {ends, particles, true, "joins particles"},
        {ends, particles + 1, true, "joins particles"},
        {ends, particles + SPARE, true, "joins particles"},
        {ends + 4, UINT32_MAX, true, "joins particles"},
    };
    mspring_network *network = grown(MSPRING_SOLVER_EXPLICIT);
    saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    uint64_t size;
    const size_t at = (size_t)(snapshots_section_of(&good, "grow", &size) - good.bytes);
    assert_int_equal(size, ends + 8 * SPARE);
    assert_int_equal(good.bytes[at + marks + particles], THERE);
    assert_int_equal(good.bytes[at + marks + particles + SPARE - 1], FREE);
    for (size_t i = 0; i < COUNT_OF(forgeries); i++) {
        saved bad = copy_of(&good);
        if (forgeries[i].is_word) {
            put_word(bad.bytes + at + forgeries[i].at, forgeries[i].value);
        } else {
            bad.bytes[at + forgeries[i].at] = (uint8_t)forgeries[i].value;
        }
        check_refused(network, &bad, forgeries[i].part);
        free(bad.bytes);
    }
    free(good.bytes);
    mspring_network_destroy(network);
    // The direct solver's matrix has room for the springs that there are.
    network = grown(MSPRING_SOLVER_DIRECT);
    good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    put_word(snapshots_section_of(&good, "grow", &size) + ends, 1); // instead of particle 0
    check_refused(network, &good, "chosen anew");
    free(good.bytes);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------------------------- guard, sleep */

/// The solver that takes steps for the explicit one is a part of the network: its tiles cannot be others.
static void other_tiles_are_refused(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    mspring_network *network = small_guarded(&made, MSPRING_GUARD_IMPLICIT);
    saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    uint64_t size;
    const size_t at = (size_t)(snapshots_section_of(&good, "guar", &size) - good.bytes) + 40;
    uint32_t tile_size;
    mspringi_get(good.bytes + at + 12, &tile_size, 1, sizeof tile_size);
    const uint32_t sizes[] = {0, 1, 3, tile_size / 2, 2 * tile_size, tile_size + 1, 1u << 20, 1u << 31};
    const double scales[] = {0, -1, NAN, INFINITY};
    const float inertias[] = {-1, NAN, INFINITY};
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        saved bad = copy_of(&good);
        put_word(bad.bytes + at + 12, sizes[i]);
        check_refused(network, &bad, "tiles of size");
        free(bad.bytes);
    }
    for (size_t i = 0; i < COUNT_OF(scales) + COUNT_OF(inertias); i++) {
        saved bad = copy_of(&good);
        if (i < COUNT_OF(scales)) {
            put_double(bad.bytes + at, scales[i]);
        } else {
            put_float(bad.bytes + at + 8, inertias[i - COUNT_OF(scales)]);
        }
        check_refused(network, &bad, "tiles of size");
        free(bad.bytes);
    }
    snapshots_load(network, &good);
    free(good.bytes);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void push_always(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        args->force_x[slot] += args->inverse_mass[slot] > 0 ? 0.001f : 0;
    }
}

/// Two pieces, of which one sleeps, under forces, and the other has been still for a while.
static mspring_network *half_asleep(void) {
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {50, 50}, .damping = {1, 1}};
    uint64_t seed = 5;
    recipe made = {0};
    recipe_lattice(&made, 4, 3, 0, 0, 1, &stuff, &seed);
    recipe_lattice(&made, 4, 3, 9, 0, 1, &stuff, &seed);
    mspring_network_def def = support_def(0, 4);
    def.global_damping = 20;
    def.sleep_speed = 0.01f;
    def.sleep_time = 0.5f;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, push_always, NULL, NULL));
    for (int i = 0; i < 1000 && !mspring_network_is_asleep(network); i++) {
        support_steps(network, 1, 0.01);
    }
    const float kick = 0.1f;
    check_ok(mspring_network_set_velocities(network, 20, 1, &kick, &kick));
    uint8_t asleep = 1;
    uint64_t size = 0, first = 0;
    for (int i = 0; i < 200; i++) { // until it is slow, which makes the snapshot longer
        support_steps(network, 1, 0.01);
        saved now = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
        (void)snapshots_section_of(&now, "slee", &size);
        free(now.bytes);
        first = i == 0 ? size : first;
        if (size > first) {
            break;
        }
    }
    assert_true(size > first);
    check_ok(mspring_network_get_sleepers(network, 20, 1, &asleep));
    assert_int_equal(asleep, 0);
    check_ok(mspring_network_get_sleepers(network, 0, 1, &asleep));
    assert_int_equal(asleep, 1);
    return network;
}

static void forged_sleep_is_refused(void **state) {
    (void)state;
    mspring_network *network = half_asleep();
    saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    uint64_t size;
    const size_t at = (size_t)(snapshots_section_of(&good, "slee", &size) - good.bytes), still = at + 20;
    const double times[] = {0, -1, NAN, INFINITY, 1.1e300};
    for (size_t i = 0; i < COUNT_OF(times); i++) {
        saved bad = copy_of(&good);
        put_double(bad.bytes + still + 4, times[i]);
        check_refused(network, &bad, "has been still");
        free(bad.bytes);
    }
    const float settings[] = {-1, NAN, INFINITY, 1.1e15f};
    for (size_t i = 0; i < 2 * COUNT_OF(settings); i++) {
        saved bad = copy_of(&good);
        put_float(bad.bytes + at + 4 * (i % 2), settings[i / 2]);
        check_refused(network, &bad, "islands below");
        free(bad.bytes);
    }
    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_view(network, &view));
    const uint32_t slots[] = {view.slot_count, UINT32_MAX};
    for (size_t i = 0; i < COUNT_OF(slots); i++) {
        saved bad = copy_of(&good);
        put_word(bad.bytes + still, slots[i]);
        check_refused(network, &bad, "has been still");
        free(bad.bytes);
    }
    // The forces under which it fell asleep are the last in the section.
    const size_t forces = at + (size_t)size - 2 * sizeof(float) * view.slot_count;
    const size_t places[] = {forces, forces + 4 * view.slot_count, at + (size_t)size - 4};
    for (size_t i = 0; i < COUNT_OF(places); i++) {
        saved bad = copy_of(&good);
        put_float(bad.bytes + places[i], i == 1 ? NAN : INFINITY);
        check_refused(network, &bad, "a force is");
        free(bad.bytes);
    }
    // And what sleeps under them sleeps on.
    snapshots_load(network, &good);
    support_steps(network, 3, 0.01);
    uint8_t asleep = 0;
    check_ok(mspring_network_get_sleepers(network, 0, 1, &asleep));
    assert_int_equal(asleep, 1);
    free(good.bytes);
    mspring_network_destroy(network);
}

/* ---------------------------------------------------------------------------------------------- where nobody is */

/// Forces on slots that hold no particle, and what an implicit solver remembers of them, do nothing, nor to a
/// particle that is added there.
static void what_nobody_has_does_nothing(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    mspring_network_def def = support_def(-9.8f, 4);
    def.spare_particles = def.spare_springs = 40;
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        def.solver = solver;
        def.sleep_speed = solver == MSPRING_SOLVER_EXPLICIT ? 1e-6f : 0;
        mspring_network *network = recipe_network(&made, &def), *twin = recipe_network(&made, &def);
        mspring_view view = {.struct_size = sizeof view};
        support_steps(network, 2, 0.01);
        check_ok(mspring_network_apply_force(network, 3, 1, 2));
        check_ok(mspring_network_view(network, &view));
        saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL), forged = copy_of(&good);
        uint64_t size;
        uint8_t *forces = snapshots_section_of(&forged, "forc", &size);
        assert_int_equal(size, 8 * (uint64_t)view.slot_count);
        const bool remembers = solver != MSPRING_SOLVER_EXPLICIT;
        uint8_t *history = remembers ? snapshots_section_of(&forged, "impl", &size) + 84 : NULL;
        const uint64_t fields = remembers ? (size - 84) / 4 / view.slot_count : 0;
        assert_true(!remembers || fields >= 2);
        uint32_t count = 0;
        for (uint32_t slot = 0; slot < view.slot_count; slot++) {
            if (view.particle_of_slot[slot] == MSPRING_NONE) {
                put_float(forces + 4 * (size_t)slot, 1e30f);
                put_float(forces + 4 * (size_t)(view.slot_count + slot), -1e30f);
                for (uint64_t i = 0; i < fields && i < 2; i++) {
                    put_float(history + 4 * (i * view.slot_count + slot), 1e10f);
                }
                count++;
            }
        }
        assert_true(count >= 40);
        snapshots_renew_checksum(&forged);
        snapshots_load(network, &forged);
        snapshots_load(twin, &good);
        mspring_network *const both[] = {network, twin};
        for (int step = 0; step < 4; step++) {
            for (int i = 0; i < 2; i++) {
                if (step % 2 == 0) { // while the forces are there, and after
                    mspring_particle_def particle;
                    mspring_id id;
                    check_ok(mspring_particle_def_init(&particle, sizeof particle));
                    particle.x = 20 + step;
                    check_ok(mspring_network_add_particles(both[i], &particle, 1, &id));
                }
                support_steps(both[i], 1, 0.01);
            }
            assert_int_equal(support_hash(network), support_hash(twin));
        }
        free(good.bytes);
        free(forged.bytes);
        mspring_network_destroy(network);
        mspring_network_destroy(twin);
    }
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damage_is_found),
        cmocka_unit_test(forgeries_do_no_harm),
        cmocka_unit_test(what_hides_in_other_slots_is_refused),
        cmocka_unit_test(what_a_plan_leaves_out_stays_out),
        cmocka_unit_test(foreign_snapshots_are_refused),
        cmocka_unit_test(other_versions_say_so),
        cmocka_unit_test(checksums_tell_words_and_their_order),
        cmocka_unit_test(sections_end_where_they_end),
        cmocka_unit_test(springs_are_counted),
        cmocka_unit_test(sections_are_as_long_as_they_must_be),
        cmocka_unit_test(forged_growth_is_refused),
        cmocka_unit_test(other_tiles_are_refused),
        cmocka_unit_test(forged_sleep_is_refused),
        cmocka_unit_test(what_nobody_has_does_nothing),
    };
    return cmocka_run_group_tests_name("forgeries", tests, NULL, NULL);
}

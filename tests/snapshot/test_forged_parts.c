/// @file test_forged_parts.c
/// What is in a snapshot's sections is looked at before anything of it is taken: each number has its range, and
/// what belongs to nobody is dropped.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "recipe.h"
#include "snapshots.h"
#include "store/snapshot_format.h"
#include "support.h"

/* ------------------------------------------------------------------------------------------------------ values */

/// A number that a section may not have, and what is said of it.
typedef struct bad_float {
    const char *tag;
    size_t at;
    float value;
    const char *part;
} bad_float;

typedef struct forged_word {
    const char *tag;
    size_t at;
    uint32_t value;
    const char *part;
} forged_word;

static void values_have_their_ranges(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    mspring_network *network = snapshots_small_network(&made);
    saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_get_view(network, &view));
    uint32_t spring_of_ramp = 0;
    uint64_t size;
    mspringi_get(snapshots_section_of(&good, "ramp", &size), &spring_of_ramp, 1, sizeof spring_of_ramp);
    assert_true(spring_of_ramp < made.spring_count);
    const size_t slot = 4 * (size_t)view.slot_of_particle[2], slots = 4 * (size_t)view.slot_count;
    const size_t last = 4 * ((size_t)made.spring_count - 1), last_mass = 4 * (size_t)made.particle_count;
    const bad_float bad[] = {
        {"sett", 16, 0, "the origin"},
        {"sett", 16, NAN, "the origin"},
        {"sett", 20, -1, "relative springs"},
        {"sett", 20, 1e-40f, "relative springs"},
        {"sett", 20, INFINITY, "relative springs"},
        {"sett", 40, NAN, "gravity_x is"},
        {"sett", 44, -INFINITY, "gravity_y is"},
        {"sett", 48, -1, "global_damping is"},
        {"sett", 48, 1.1e6f, "global_damping is"},
        {"sett", 52, 0, "max_speed is"},
        {"sett", 52, 1.1e15f, "max_speed is"},
        {"sett", 56, -0.1f, "relax_fraction is"},
        {"sett", 56, 1.1f, "relax_fraction is"},
        {"moti", slot, 1.1e12f, "particle 2 is at"},
        {"moti", slots + slot, -1.1e12f, "particle 2 is at"},
        {"moti", 2 * slots + slot, 1.1e15f, "particle 2 is at"},
        {"moti", 3 * slots + slot, NAN, "particle 2 is at"},
        {"mass", 4, 0, "particle 0 has a mass"},
        {"mass", 4, INFINITY, "particle 0 has a mass"},
        {"mass", last_mass, -1, "has a mass"},
        {"forc", 0, NAN, "a force is"},
        {"forc", 2 * slots - 4, INFINITY, "a force is"},
        {"valu", 0, NAN, "spring 0 has stiffness"},
        {"valu", 0, -1, "spring 0 has stiffness"},
        {"valu", 4, -1, "spring 0 has stiffness"},
        {"valu", 8, 0, "spring 0 has stiffness"},
        {"valu", 3 * last + 8, INFINITY, "has stiffness"},
        {"brks", 0, 0, "spring 0 has 0"},
        {"brks", last, NAN, "has"},
        {"strs", 0, -1, "spring 0 has -1"},
        {"strs", last, NAN, "has"},
        {"ramp", 4, 0, "goes from"},
        {"ramp", 4, NAN, "goes from"},
        {"guar", 8, NAN, "for substeps of"},
        {"guar", 12, -1, "for substeps of"},
        {"guar", 12, 1.1e6f, "for substeps of"},
        {"guar", 16, INFINITY, "for substeps of"},
    };
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        saved forged = snapshots_copy(&good);
        snapshots_put_float(snapshots_section_of(&forged, bad[i].tag, &size) + bad[i].at, bad[i].value);
        snapshots_check_refused(network, &forged, bad[i].part);
        free(forged.bytes);
    }
    const double doubles[] = {NAN, INFINITY, 2.1e12, -2.1e12};
    for (size_t i = 0; i < 2 * COUNT_OF(doubles); i++) {
        saved forged = snapshots_copy(&good);
        snapshots_put_double(snapshots_section_of(&forged, "sett", &size) + 8 * (i % 2), doubles[i / 2]);
        snapshots_check_refused(network, &forged, "the origin");
        free(forged.bytes);
    }
    const double ramps[][3] = {{-1, 1, 0.5},       {2e13, 1, 0.5}, {1, 0, 0}, {1, NAN, 0.5},
                               {1, INFINITY, 0.5}, {1, 1, -0.5},   {1, 1, 1}, {1, 1, NAN}};
    for (size_t i = 0; i < COUNT_OF(ramps); i++) {
        saved forged = snapshots_copy(&good);
        uint8_t *ramp = snapshots_section_of(&forged, "ramp", &size);
        for (size_t k = 0; k < 3; k++) {
            snapshots_put_double(ramp + 8 + 8 * k, ramps[i][k]);
        }
        snapshots_check_refused(network, &forged, "goes from");
        free(forged.bytes);
    }
    const forged_word words[] = {{"sett", 24, 0, "substeps is"},
                                 {"sett", 24, MSPRING_MAX_SUBSTEPS + 1, "substeps is"},
                                 {"sett", 28, 0, "substeps is"},
                                 {"sett", 28, MSPRING_MAX_SUBSTEPS + 1, "substeps is"},
                                 {"sett", 32, 3, "substeps is"},
                                 {"sett", 36, MSPRING_MAX_SUBSTEPS + 1, "most_work"},
                                 {"mass", 0, 4, "of kind 4"},
                                 {"ramp", 0, made.spring_count, "goes from"},
                                 {"guar", 20, MSPRING_GUARD_CLAMP_BOUNDS + 1, "for substeps of"},
                                 {"guar", 24, 1, "bits that have no meaning"},
                                 {"guar", 32, 4, "for substeps of"}};
    for (size_t i = 0; i < COUNT_OF(words); i++) {
        saved forged = snapshots_copy(&good);
        snapshots_put_word(snapshots_section_of(&forged, words[i].tag, &size) + words[i].at, words[i].value);
        snapshots_check_refused(network, &forged, words[i].part);
        free(forged.bytes);
    }
    snapshots_load(network, &good);
    free(good.bytes);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// What an implicit solver carries on.
static void values_of_an_implicit_solver_have_their_ranges(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    mspring_network *network = snapshots_small_network(&made);
    snapshots_use_solver(network, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, 7);
    check_ok(mspring_network_step(network, 0.01));
    saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    uint64_t size;
    const forged_word words[] = {{"impl", 20, 16, "its scale is"},
                                 {"impl", 28, 0, "it has 0 iterations"},
                                 {"impl", 28, 10001, "it has 10001 iterations"},
                                 {"impl", 28, UINT32_MAX, "iterations"},
                                 {"impl", 32, 0, "substeps old of 0"},
                                 {"impl", 32, 10001, "substeps old of 10001"},
                                 {"impl", 36, 7, "7 substeps old of 7"},
                                 {"impl", 36, UINT32_MAX, "substeps old of 7"},
                                 {"impl", 40, 0x7fc00000, "its residual is"},  // NaN
                                 {"impl", 40, 0xbf800000, "its residual is"},  // -1
                                 {"impl", 40, 0x3f800001, "its residual is"}}; // next to 1
    for (size_t i = 0; i < COUNT_OF(words); i++) {
        saved forged = snapshots_copy(&good);
        snapshots_put_word(snapshots_section_of(&forged, words[i].tag, &size) + words[i].at, words[i].value);
        snapshots_check_refused(network, &forged, words[i].part);
        free(forged.bytes);
    }
    const float substeps[] = {-1, NAN, INFINITY};
    for (size_t i = 0; i < COUNT_OF(substeps); i++) {
        saved forged = snapshots_copy(&good);
        snapshots_put_float(snapshots_section_of(&forged, "impl", &size) + 16, substeps[i]);
        snapshots_check_refused(network, &forged, "its scale is");
        free(forged.bytes);
    }
    const double scales[] = {-1, NAN, INFINITY, -INFINITY};
    for (size_t i = 0; i < COUNT_OF(scales); i++) {
        saved forged = snapshots_copy(&good);
        snapshots_put_double(snapshots_section_of(&forged, "impl", &size) + 8, scales[i]);
        snapshots_check_refused(network, &forged, "its scale is");
        free(forged.bytes);
    }
    snapshots_load(network, &good);
    free(good.bytes);
    mspring_network_destroy(network);
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
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring[i], sizeof spring[i]));
        spring[i].stiffness = 20;
        if (i < 2) {
            check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle[i], sizeof particle[i]));
            particle[i].x = 2 * i;
            particle[i].y = 5;
        }
    }
    check_ok(mspring_network_add_particles(network, particle, 2, ids));
    spring[0].a = 0, spring[0].b = ids[0];
    spring[1].a = ids[0], spring[1].b = 5;
    spring[2].a = ids[1], spring[2].b = 7;
    check_ok(mspring_network_add_springs(network, spring, 3, joined));
    check_ok(mspring_network_remove_particles(network, &ids[1], 0, 1)); // with its spring
    if (solver != MSPRING_SOLVER_EXPLICIT) {
        mspring_settings chosen;
        check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &chosen, sizeof chosen));
        chosen.solver = solver;
        check_ok(support_set_solver(network, &chosen));
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
        saved bad = snapshots_copy(&good);
        if (forgeries[i].is_word) {
            snapshots_put_word(bad.bytes + at + forgeries[i].at, forgeries[i].value);
        } else {
            bad.bytes[at + forgeries[i].at] = (uint8_t)forgeries[i].value;
        }
        snapshots_check_refused(network, &bad, forgeries[i].part);
        free(bad.bytes);
    }
    free(good.bytes);
    mspring_network_destroy(network);
    // The direct solver's matrix has room for the springs that there are.
    network = grown(MSPRING_SOLVER_DIRECT);
    good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    snapshots_put_word(snapshots_section_of(&good, "grow", &size) + ends, 1); // instead of particle 0
    snapshots_check_refused(network, &good, "chosen anew");
    free(good.bytes);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------------------------- guard, sleep */

/// The solver that takes steps for the explicit one is a part of the network: its tiles cannot be others.
static void other_tiles_are_refused(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    mspring_network *network = snapshots_small_guarded(&made, MSPRING_GUARD_IMPLICIT);
    saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    uint64_t size;
    const size_t at = (size_t)(snapshots_section_of(&good, "guar", &size) - good.bytes) + 40;
    uint32_t tile_size;
    mspringi_get(good.bytes + at + 12, &tile_size, 1, sizeof tile_size);
    const uint32_t sizes[] = {0, 1, 3, tile_size / 2, 2 * tile_size, tile_size + 1, 1u << 20, 1u << 31};
    const double scales[] = {0, -1, NAN, INFINITY};
    const float inertias[] = {-1, NAN, INFINITY};
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        saved bad = snapshots_copy(&good);
        snapshots_put_word(bad.bytes + at + 12, sizes[i]);
        snapshots_check_refused(network, &bad, "tiles of size");
        free(bad.bytes);
    }
    for (size_t i = 0; i < COUNT_OF(scales) + COUNT_OF(inertias); i++) {
        saved bad = snapshots_copy(&good);
        if (i < COUNT_OF(scales)) {
            snapshots_put_double(bad.bytes + at, scales[i]);
        } else {
            snapshots_put_float(bad.bytes + at + 8, inertias[i - COUNT_OF(scales)]);
        }
        snapshots_check_refused(network, &bad, "tiles of size");
        free(bad.bytes);
    }
    snapshots_load(network, &good);
    free(good.bytes);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// A network that has no such solver makes one with the tiles that the snapshot tells, instead of one that it has
/// had from another snapshot; of no other sizes than there are.
static void tiles_are_made_as_they_were(void **state) {
    (void)state;
    recipe made = snapshots_small_recipe();
    mspring_network *guarded = snapshots_small_guarded(&made, MSPRING_GUARD_IMPLICIT),
                    *network = snapshots_small_guarded(&made, MSPRING_GUARD_GROWTH);
    const saved with = snapshots_save(guarded, MSPRING_SNAPSHOT_ALL),
                without = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    uint64_t size;
    const size_t at = (size_t)(snapshots_section_of(&with, "guar", &size) - with.bytes) + 40;
    double scale;
    mspringi_get(with.bytes + at, &scale, 1, sizeof scale);
    const uint32_t bad[] = {0, 1, 4, 7, 9, 12, 24, 255, 257, 512, 1u << 20, 1u << 31, UINT32_MAX};
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        saved forged = snapshots_copy(&with);
        snapshots_put_word(forged.bytes + at + 12, bad[i]);
        snapshots_check_refused(network, &forged, "tiles of size");
        free(forged.bytes);
    }
    size_t used[9] = {0}; // with tiles of 2 to the power of the index
    for (int round = 0; round < 3; round++) {
        for (uint32_t power = 3; power <= 8; power++) {
            saved other = snapshots_copy(&with);
            snapshots_put_word(other.bytes + at + 12, 1u << power);
            snapshots_put_double(other.bytes + at, scale * power);
            snapshots_renew_checksum(&other);
            snapshots_load(network, &other);
            const saved again = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
            assert_int_equal(again.size, other.size);
            assert_memory_equal(again.bytes, other.bytes, other.size);
            // What an earlier one took is given back.
            const size_t uses = support_memory_used(network);
            assert_true(round == 0 || uses == used[power]);
            used[power] = uses;
            check_ok(mspring_network_step(network, 0.01));
            snapshots_load(network, &without);
            free(again.bytes);
            free(other.bytes);
        }
    }
    free(with.bytes);
    free(without.bytes);
    mspring_network_destroy(guarded);
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
    def.settings.global_damping = 20;
    def.settings.sleep_speed = 0.01f;
    def.settings.sleep_time = 0.5f;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, push_always, NULL, NULL));
    for (int i = 0; i < 1000 && !support_is_asleep(network); i++) {
        support_steps(network, 1, 0.01);
    }
    const float kick = 0.1f;
    check_ok(mspring_network_set_velocities(network, NULL, 20, 1, &kick, &kick, 1));
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
    check_ok(support_get_sleepers(network, 20, 1, &asleep, 1));
    assert_int_equal(asleep, 0);
    check_ok(support_get_sleepers(network, 0, 1, &asleep, 1));
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
        saved bad = snapshots_copy(&good);
        snapshots_put_double(bad.bytes + still + 4, times[i]);
        snapshots_check_refused(network, &bad, "has been still");
        free(bad.bytes);
    }
    const float settings[] = {-1, NAN, INFINITY, 1.1e15f};
    for (size_t i = 0; i < 2 * COUNT_OF(settings); i++) {
        saved bad = snapshots_copy(&good);
        snapshots_put_float(bad.bytes + at + 4 * (i % 2), settings[i / 2]);
        snapshots_check_refused(network, &bad, "islands below");
        free(bad.bytes);
    }
    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_get_view(network, &view));
    const uint32_t slots[] = {view.slot_count, UINT32_MAX};
    for (size_t i = 0; i < COUNT_OF(slots); i++) {
        saved bad = snapshots_copy(&good);
        snapshots_put_word(bad.bytes + still, slots[i]);
        snapshots_check_refused(network, &bad, "has been still");
        free(bad.bytes);
    }
    // The forces under which it fell asleep are the last in the section.
    const size_t forces = at + (size_t)size - 2 * sizeof(float) * view.slot_count;
    const size_t places[] = {forces, forces + 4 * view.slot_count, at + (size_t)size - 4};
    for (size_t i = 0; i < COUNT_OF(places); i++) {
        saved bad = snapshots_copy(&good);
        snapshots_put_float(bad.bytes + places[i], i == 1 ? NAN : INFINITY);
        snapshots_check_refused(network, &bad, "a force is");
        free(bad.bytes);
    }
    // And what sleeps under them sleeps on.
    snapshots_load(network, &good);
    support_steps(network, 3, 0.01);
    uint8_t asleep = 0;
    check_ok(support_get_sleepers(network, 0, 1, &asleep, 1));
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
        def.settings.solver = solver;
        def.settings.sleep_speed = solver == MSPRING_SOLVER_EXPLICIT ? 1e-6f : 0;
        mspring_network *network = recipe_network(&made, &def), *twin = recipe_network(&made, &def);
        mspring_view view = {.struct_size = sizeof view};
        support_steps(network, 2, 0.01);
        check_ok(mspring_network_apply_force(network, 3, 1, 2));
        check_ok(mspring_network_get_view(network, &view));
        saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL), forged = snapshots_copy(&good);
        uint64_t size;
        uint8_t *forces = snapshots_section_of(&forged, "forc", &size);
        assert_int_equal(size, 8 * (uint64_t)view.slot_count);
        const bool remembers = solver != MSPRING_SOLVER_EXPLICIT;
        uint8_t *history = remembers ? snapshots_section_of(&forged, "impl", &size) + 44 : NULL;
        const uint64_t fields = remembers ? (size - 44) / 4 / view.slot_count : 0;
        assert_true(!remembers || fields >= 2);
        uint32_t count = 0;
        for (uint32_t slot = 0; slot < view.slot_count; slot++) {
            if (view.particle_of_slot[slot] == MSPRING_NONE) {
                snapshots_put_float(forces + 4 * (size_t)slot, 1e30f);
                snapshots_put_float(forces + 4 * (size_t)(view.slot_count + slot), -1e30f);
                for (uint64_t i = 0; i < fields && i < 2; i++) {
                    snapshots_put_float(history + 4 * (i * view.slot_count + slot), 1e10f);
                }
                count++;
            }
        }
        assert_true(count >= 40);
        snapshots_renew_checksum(&forged);
        check_ok(mspring_network_load(network, forged.bytes, forged.size));
        snapshots_load(twin, &good);
        mspring_network *const both[] = {network, twin};
        for (int step = 0; step < 4; step++) {
            for (int i = 0; i < 2; i++) {
                if (step % 2 == 0) { // while the forces are there, and after
                    mspring_particle_def particle;
                    mspring_id id;
                    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
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

/* ------------------------------------------------------------------------------------------------------- sizes */

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
            saved bad = snapshots_copy(&good);
            mspringi_writer to = mspringi_writer_begin(bad.bytes + at - 8, &mspringi_kernels_scalar);
            mspringi_put(&to, &other, 1, sizeof other);
            snapshots_check_refused(network, &bad, "they take");
            free(bad.bytes);
            tried++;
        }
        assert_true(tried > 0);
    }
    free(good.bytes);
}

static void sections_are_as_long_as_they_must_be(void **state) {
    (void)state;
    static const char *const of_small[] = {"sett", "moti", "mass", "forc", "brok", "valu",
                                           "brks", "strs", "stsd", "ramp", "guar"};
    static const char *const of_grown[] = {"grow", "moti", "impl"}, *const of_sleeping[] = {"slee"};
    recipe made = snapshots_small_recipe();
    mspring_network *networks[] = {snapshots_small_guarded(&made, MSPRING_GUARD_IMPLICIT),
                                   grown(MSPRING_SOLVER_IMPLICIT), half_asleep()};
    check_sizes(networks[0], of_small, COUNT_OF(of_small));
    check_sizes(networks[1], of_grown, COUNT_OF(of_grown));
    check_sizes(networks[2], of_sleeping, COUNT_OF(of_sleeping));
    for (size_t i = 0; i < COUNT_OF(networks); i++) {
        mspring_network_destroy(networks[i]);
    }
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_have_their_ranges),
        cmocka_unit_test(values_of_an_implicit_solver_have_their_ranges),
        cmocka_unit_test(forged_growth_is_refused),
        cmocka_unit_test(other_tiles_are_refused),
        cmocka_unit_test(tiles_are_made_as_they_were),
        cmocka_unit_test(forged_sleep_is_refused),
        cmocka_unit_test(what_nobody_has_does_nothing),
        cmocka_unit_test(sections_are_as_long_as_they_must_be),
    };
    return cmocka_run_group_tests_name("forged_parts", tests, NULL, NULL);
}

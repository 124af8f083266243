/// @file test_forged_words.c
/// Every word of a snapshot, replaced by others under a checksum that fits: it is refused and the network is as
/// before, or what is taken steps, answers, is edited and compacted like any other, and saves what it takes again.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "recipe.h"
#include "snapshots.h"
#include "step/finite.h"
#include "store/snapshot_format.h"
#include "support.h"

enum { SPARE = 3 };

static void add_laws(mspring_network *network) {
    const mspring_id corners[3] = {0, 2, 6}, arms[3] = {0, 1, 2};
    const float yield = 0.01f, bend[2] = {0.05f, -0.03f}, limit = 0.9f;
    mspring_area_def area;
    mspring_angle_def angle;
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area));
    area.stiffness = 2;
    check_ok(mspring_network_add_area(network, &area, corners, 3, NULL));
    check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &angle, sizeof angle));
    angle.stiffness = 1;
    check_ok(mspring_network_add_angles(network, &angle, arms, 1, 3, NULL));
    check_ok(mspring_network_set(network, MSPRING_YIELD_STRAIN, NULL, 0, 10, &yield, 0));
    check_ok(mspring_network_set(network, MSPRING_PLASTIC_STRAIN, NULL, 4, 2, bend, 1));
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, 6, &limit, 0));
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, 6, &yield, 0));
}

static void add_and_remove(mspring_network *network) {
    const mspring_id gone = 7, broken[2] = {1, 2};
    mspring_particle_def particle;
    mspring_spring_def spring;
    mspring_grip_def grip;
    mspring_contact_def contact;
    mspring_id added, joint;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    particle.x = -3;
    check_ok(mspring_network_add_particles(network, &particle, 1, &added));
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
    spring.a = 0, spring.b = added, spring.stiffness = 30;
    check_ok(mspring_network_add_springs(network, &spring, 1, &joint));
    check_ok(mspring_network_remove_particles(network, &gone, 0, 1));
    check_ok(mspring_network_break_springs(network, broken, 0, 2));
    check_ok(mspring_network_restore_springs(network, broken, 0, 1, 1.0));
    check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &grip, sizeof grip));
    grip.particle = 1, grip.x = 1, grip.stiffness = 10;
    check_ok(mspring_network_add_grip(network, &grip, NULL));
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    check_ok(mspring_network_set_contact(network, &contact));
}

static mspring_network *make(mspring_solver solver, bool has_laws) {
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {50, 100}, .damping = {0, 1}};
    uint64_t seed = 4;
    recipe made = {0};
    recipe_lattice(&made, 4, 3, 0, 0, 1, &stuff, &seed);
    recipe_particle(&made, 0, 9, 1, MSPRING_PARTICLE_PINNED); // sleeps
    mspring_network_def def = support_def(-9.8f, 2);
    def.spare_particles = def.spare_springs = SPARE;
    def.settings.sleep_speed = 1e-3f;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    check_ok(mspring_network_reserve_events(network, 64));
    if (has_laws)
        add_laws(network);
    add_and_remove(network);
    if (solver != MSPRING_SOLVER_EXPLICIT)
        snapshots_use_solver(network, solver, MSPRING_INTEGRATOR_BDF2, 7);
    check_ok(mspring_network_step(network, 0.01));
    check_ok(mspring_network_apply_force(network, 6, 1, 1));
    return network;
}

// What a host may do. A step may be refused.
static void live(mspring_network *network) {
    const uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES),
                   springs = mspring_network_count(network, MSPRING_SPRINGS);
    double kinetic, elastic, potential, now;
    const float speed = 3;
    (void)!support_get_energy(network, &kinetic, &elastic, &potential);
    (void)!mspring_network_get_stable_dt(network, &now, NULL);
    for (mspring_id p = 0; p < particles; p += 5)
        if (support_has_particle(network, p))
            check_ok(mspring_network_set_velocities(network, NULL, p, 1, &speed, &speed, 1));
    for (int i = 0; i < 3; i++) {
        (void)!mspring_network_step(network, 0.01);
        assert_true(mspringi_is_finite(network));
    }
    for (mspring_id s = 1; s < springs; s += 4)
        (void)!mspring_network_remove_springs(network, &s, 0, 1);
    (void)!mspring_network_compact(network);
    (void)!mspring_network_step(network, 0.01);
    (void)!support_expand(network);
    for (mspring_id p = 2; p < particles; p += 4)
        (void)!mspring_network_remove_particles(network, &p, 0, 1);
    (void)!mspring_network_step(network, 0.01);
    assert_true(mspringi_is_finite(network));
}

// Save what was taken, and take that again: the bytes are the same.
static void check_round(mspring_network *network) {
    const saved once = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    snapshots_load(network, &once);
    const saved twice = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    assert_int_equal(twice.size, once.size);
    assert_memory_equal(twice.bytes, once.bytes, once.size);
    free(once.bytes);
    free(twice.bytes);
}

// Substeps that a forged number asks for may take minutes.
static bool is_slow(const saved *of) {
    uint64_t size;
    uint32_t substeps[2];
    mspringi_get(snapshots_section_of(of, "sett", &size) + 44, substeps, 2, sizeof substeps[0]);
    return substeps[0] > 100 || substeps[1] > 100;
}

static void forge(mspring_solver solver, bool has_laws, size_t stride) {
    const uint32_t words[] = {0,          1,          2,          3,          0x7fc00000, 0x7f800000, 0x7f7fffff,
                              0xffffffff, 0x80000000, 0xbf800000, 0x00000001, 0x01010101, 0x02000001};
    mspring_network *network = make(solver, has_laws);
    saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    uint32_t accepted = 0, refused = 0;
    for (size_t i = 0; i < good.size / 4 * COUNT_OF(words); i += stride) {
        const size_t at = i / COUNT_OF(words) * 4;
        if (at + MSPRINGI_SNAPSHOT_CHECKSUM_BYTES >= good.size)
            break;
        saved bad = snapshots_copy(&good);
        snapshots_put_word(bad.bytes + at, words[i % COUNT_OF(words)]);
        snapshots_renew_checksum(&bad);
        if (mspring_network_load(network, bad.bytes, bad.size) != MSPRING_OK) {
            assert_true(strlen(mspring_network_error(network)) > 0);
            const saved still = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
            assert_int_equal(still.size, good.size);
            assert_memory_equal(still.bytes, good.bytes, good.size);
            free(still.bytes);
            refused++;
        } else {
            accepted++;
            check_round(network);
            if (!is_slow(&bad))
                live(network);
            mspring_network_destroy(network);
            network = make(solver, has_laws);
        }
        free(bad.bytes);
    }
    assert_true(accepted > 20 && refused > 100);
    mspring_network_destroy(network);
    free(good.bytes);
}

static void forged_words_do_no_harm(void **state) {
    (void)state;
    const size_t stride = ROUNDS_ARE_FEW ? 29 : 7; // prime to the number of words
    forge(MSPRING_SOLVER_EXPLICIT, true, stride);
    forge(MSPRING_SOLVER_IMPLICIT, true, stride);
    forge(MSPRING_SOLVER_DIRECT, false, stride);
}

/// Marks of springs and particles that the network was made with, in one byte each.
static void forged_marks_do_no_harm(void **state) {
    (void)state;
    for (int way = 0; way < 6; way++) {
        mspring_network *network = make(MSPRING_SOLVER_EXPLICIT, true);
        saved bad = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
        uint64_t size;
        uint8_t *growth = snapshots_section_of(&bad, "grow", &size);
        const uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES) + SPARE - 1;
        const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS) - 1;
        for (uint32_t s = 0; s < springs; s++)
            if (way == 0 || s % 6 == (uint32_t)way)
                growth[8 + particles + s] = growth[8 + particles + s] ? 0 : 1;
        snapshots_renew_checksum(&bad);
        if (mspring_network_load(network, bad.bytes, bad.size) == MSPRING_OK) {
            check_round(network);
            live(network);
        }
        free(bad.bytes);
        mspring_network_destroy(network);
    }
}

/// Coordinates of the shape that contact has found outlines by, at their bound and beyond; and the tightest spring, at the
/// end of those that there are.
static void bounds_are_exact(void **state) {
    (void)state;
    const double most = 4e12, beyond = nextafter(most, INFINITY);
    const struct {
        double x, y;
        bool is_taken;
    } places[] = {{most, -most, true}, {NAN, NAN, true},    {beyond, 0, false}, {-beyond, 0, false},
                  {0, beyond, false},  {0, -beyond, false}, {NAN, 0, false},    {0, NAN, false}};
    mspring_network *network = make(MSPRING_SOLVER_EXPLICIT, false);
    const saved good = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    uint64_t size;
    for (size_t i = 0; i < 2 * COUNT_OF(places); i++) {
        const size_t place = i / 2;
        const bool is_origin = i % 2 == 0;
        saved forged = snapshots_copy(&good);
        uint8_t *at = snapshots_section_of(&forged, "shap", &size) + (is_origin ? 0 : (size_t)size - 16);
        snapshots_put_double(at, places[place].x);
        snapshots_put_double(at + 8, places[place].y);
        snapshots_renew_checksum(&forged);
        if (places[place].is_taken && !(is_origin && isnan(places[place].x)))
            check_ok(mspring_network_load(network, forged.bytes, forged.size));
        else
            snapshots_check_refused(network, &forged, is_origin ? "the origin is" : "was at");
        free(forged.bytes);
    }
    mspring_network_destroy(network);
    free(good.bytes);

    recipe made = snapshots_small_recipe();
    for (uint32_t spare = 0; spare < 2; spare++) {
        mspring_network_def def = support_def(-9.8f, 2);
        def.spare_springs = spare;
        network = recipe_network(&made, &def);
        saved with = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
        snapshots_put_word(snapshots_section_of(&with, "guar", &size) + 28, made.spring_count - 1);
        snapshots_renew_checksum(&with);
        check_ok(mspring_network_load(network, with.bytes, with.size));
        for (uint32_t past = 0; past < 2; past++) {
            snapshots_put_word(snapshots_section_of(&with, "guar", &size) + 28, made.spring_count + past);
            snapshots_check_refused(network, &with, "which is not there");
        }
        free(with.bytes);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forged_words_do_no_harm),
        cmocka_unit_test(forged_marks_do_no_harm),
        cmocka_unit_test(bounds_are_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/// @file test_metres.c
/// Springs whose limits are elongations in metres: they break, yield and are stressed at these, whatever rest
/// length they are given; and the metres are read back as given, from wherever the spring went.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "archives.h"
#include "snapshots.h"
#include "support.h"

static const mspring_property limits[] = {MSPRING_BREAK_STRAIN, MSPRING_WARN_STRAIN, MSPRING_RELAX_STRAIN,
                                          MSPRING_YIELD_STRAIN};

static mspring_spring_def spring_def(mspring_id a, mspring_id b, float rest_length, uint32_t flags) {
    mspring_spring_def def;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.flags = flags;
    def.a = a;
    def.b = b;
    def.rest_length = rest_length;
    return def;
}

static void set(mspring_network *network, mspring_property property, mspring_id spring, float value) {
    check_ok(mspring_network_set(network, property, &spring, 0, 1, &value, 1));
}

static float get(const mspring_network *network, mspring_property property, mspring_id spring) {
    float value;
    check_ok(mspring_network_get(network, property, &spring, 0, 1, &value, 1));
    return value;
}

static uint32_t flags_of(const mspring_network *network, mspring_id spring) {
    uint32_t flags;
    check_ok(mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, &spring, 0, 1, &flags, 1));
    return flags;
}

/* ------------------------------------------------------------------------------------------------------ acting */

/// Spring 0, of this rest length, between a pinned particle and another; nothing moves by itself.
static mspring_network *one_spring(float rest_length, uint32_t flags, float break_strain, float warn_strain) {
    mspring_builder *builder = support_builder();
    const mspring_id a = support_pinned(builder, 0, 0, 1), b = support_pinned(builder, 1, 0, 1);
    mspring_spring_def def = spring_def(a, b, rest_length, flags);
    def.break_strain = break_strain;
    def.warn_strain = warn_strain;
    check_ok(mspring_builder_add_springs(builder, &def, 1, NULL));
    mspring_network_def network_def = support_def(0, 2);
    network_def.spare_springs = 2;
    return support_network(builder, &network_def);
}

/// Flags of spring 0 after a step with its ends this far apart.
static uint32_t at(mspring_network *network, double length) {
    const mspring_id b = 1;
    const double y = 0;
    check_ok(mspring_network_set_positions(network, &b, 0, 1, &length, &y, 1));
    support_steps(network, 1, 1.0 / 64);
    return flags_of(network, 0) & (MSPRING_SPRING_BROKEN | MSPRING_SPRING_STRESSED);
}

// Springs of 4 m and 0.25 m are stressed at 0.1 m and break at 0.3 m, stretched and squeezed.
static void metres_are_what_counts(void **state) {
    (void)state;
    const float lengths[] = {4, 0.5f};
    for (int i = 0; i < 2; i++)
        for (int sign = -1; sign <= 1; sign += 2) {
            mspring_network *network = one_spring(lengths[i], MSPRING_SPRING_METRES, 0.3f, 0.1f);
            const double rest = (double)lengths[i];
            assert_int_equal(at(network, rest + 0.099 * sign), 0);
            assert_int_equal(at(network, rest + 0.101 * sign), MSPRING_SPRING_STRESSED);
            assert_int_equal(at(network, rest + 0.299 * sign), MSPRING_SPRING_STRESSED);
            assert_int_equal(at(network, rest), 0);
            assert_int_equal(at(network, rest + 0.301 * sign), MSPRING_SPRING_BROKEN);
            mspring_network_destroy(network);
        }
}

// Also after new rest lengths, a weld among them, and new metres.
static void they_follow_a_new_rest_length(void **state) {
    (void)state;
    const float lengths[] = {1, 4, 0.5f, 0, 7, 1e-9f, 3};
    mspring_network *network = one_spring(2, MSPRING_SPRING_METRES, 0.3f, 0.1f);
    for (size_t i = 0; i < COUNT_OF(lengths); i++) {
        set(network, MSPRING_REST_LENGTH, 0, lengths[i]);
        assert_true(get(network, MSPRING_BREAK_STRAIN, 0) == 0.3f && get(network, MSPRING_WARN_STRAIN, 0) == 0.1f);
        assert_int_equal(at(network, (double)lengths[i] + 0.099), 0);
        assert_int_equal(at(network, (double)lengths[i] + 0.101), MSPRING_SPRING_STRESSED);
        assert_int_equal(at(network, (double)lengths[i]), 0);
    }
    set(network, MSPRING_BREAK_STRAIN, 0, 1.5f);
    set(network, MSPRING_WARN_STRAIN, 0, MSPRING_NEVER);
    assert_int_equal(at(network, 4.49), 0);
    assert_true(get(network, MSPRING_BREAK_STRAIN, 0) == 1.5f &&
                get(network, MSPRING_WARN_STRAIN, 0) == MSPRING_NEVER);
    assert_int_equal(at(network, 4.51), MSPRING_SPRING_BROKEN);
    mspring_network_destroy(network);
}

// A spring without the flag keeps its strain.
static void strains_stay_strains(void **state) {
    (void)state;
    mspring_network *network = one_spring(2, 0, 0.3f, 0.1f);
    set(network, MSPRING_REST_LENGTH, 0, 4);
    assert_true(get(network, MSPRING_WARN_STRAIN, 0) == 0.1f);
    assert_int_equal(at(network, 4.39), 0);
    assert_int_equal(at(network, 4.41), MSPRING_SPRING_STRESSED);
    mspring_network_destroy(network);
}

static void actuators_keep_the_metres(void **state) {
    (void)state;
    const mspring_id spring = 0;
    mspring_network *network = one_spring(2, MSPRING_SPRING_METRES, 0.3f, 0.1f);
    check_ok(mspring_network_set_actuators(network, &spring, 1, 2));
    for (int i = 0; i < 4; i++) {
        const float signal = (float[]){0.5f, 3, 1, 0.1f}[i];
        set(network, MSPRING_SIGNAL, 0, signal);
        assert_int_equal(at(network, 2 * (double)signal), 0);
        assert_int_equal(at(network, 2 * (double)signal + 0.099), 0);
        assert_int_equal(at(network, 2 * (double)signal + 0.101), MSPRING_SPRING_STRESSED);
        assert_true(get(network, MSPRING_BREAK_STRAIN, 0) == 0.3f);
        assert_int_equal(at(network, 2 * (double)signal), 0);
        saved frame = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
        set(network, MSPRING_SIGNAL, 0, 1.5f);
        support_steps(network, 1, 1.0 / 64);
        snapshots_load(network, &frame);
        free(frame.bytes);
        assert_int_equal(at(network, 2 * (double)signal + 0.099), 0);
    }
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------- in rows, as springs of strains */

/// A lattice that falls and yields; flags and limits are of all its springs, whose length is 2 m or its diagonal.
static mspring_network *lattice(uint32_t flags, const float of[4], float diagonal_scale) {
    mspring_builder *builder = support_builder();
    mspring_lattice_def def;
    mspring_material material;
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def));
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    def.width = 20;
    def.height = 9;
    def.spacing = 2;
    material.stiffness = 4000;
    material.damping = 2;
    material.spring_flags = flags;
    material.break_strain = of[0];
    material.warn_strain = of[1];
    material.relax_strain = of[2];
    material.yield_strain = of[3];
    def.materials = &material;
    def.material_count = 1;
    check_ok(mspring_builder_add_lattice(builder, &def, NULL));
    mspring_network_def network_def = support_def(-9.8f, 8);
    network_def.spare_springs = 1;
    mspring_network *network = support_network(builder, &network_def);
    check_ok(mspring_network_reserve_events(network, 4096));
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    for (mspring_id s = 0; diagonal_scale != 1 && s < springs; s++)
        for (int i = 0; i < 4; i++)
            if (get(network, MSPRING_REST_LENGTH, s) != 2)
                set(network, limits[i], s, of[i] * diagonal_scale);
    const mspring_id end = mspring_network_count(network, MSPRING_PARTICLES) - 1;
    support_kick(network, end, 190);
    support_kick(network, 3, -150);
    return network;
}

// Limits that are powers of two: strains of the lattice's rows are exact, and only diagonals differ in rounding.
static void rows_have_the_bits_of_strains(void **state) {
    (void)state;
    const float metres[] = {1, 0.25f, 0.125f, 0.5f}, strains[] = {0.5f, 0.125f, 0.0625f, 0.25f};
    const float diagonal = 1 / (float)sqrt(2);
    mspring_network *a = lattice(MSPRING_SPRING_METRES, metres, 1), *b = lattice(0, strains, diagonal);
    mspring_energy energy;
    check_ok(mspring_init(MSPRING_STRUCT_ENERGY, &energy, sizeof energy));
    for (int step = 0; step < 90; step++) {
        support_steps(a, 1, 1.0 / 64);
        support_steps(b, 1, 1.0 / 64);
        assert_true(support_distance(a, b) < 1e-4);
    }
    uint32_t broken = 0;
    const uint32_t springs = mspring_network_count(a, MSPRING_SPRINGS);
    for (mspring_id s = 0; s < springs; s++) {
        const uint32_t flags = flags_of(a, s);
        assert_int_equal(flags & ~(uint32_t)MSPRING_SPRING_METRES, flags_of(b, s));
        assert_true(flags & MSPRING_SPRING_METRES);
        broken += (flags & MSPRING_SPRING_BROKEN) != 0;
        for (int i = 0; i < 4; i++)
            assert_true(get(a, limits[i], s) == metres[i]);
    }
    check_ok(mspring_network_get_energy(a, &energy));
    assert_true(broken > 0 && broken < springs / 4 && energy.yield_count > 0);
    mspring_network_destroy(a);
    mspring_network_destroy(b);
}

// The same values again change nothing, and a snapshot from before them fits.
static void the_same_again_changes_nothing(void **state) {
    (void)state;
    const float metres[] = {1, 0.25f, 0.125f, 0.5f};
    mspring_network *network = lattice(MSPRING_SPRING_METRES, metres, 1);
    saved frame = snapshots_save(network, MSPRING_SNAPSHOT_FRAME);
    for (int again = 0; again < 4; again++)
        for (int i = 0; i < 4; i++)
            check_ok(mspring_network_set(network, limits[i], NULL, 0, MSPRING_ALL, &metres[i], 0));
    snapshots_load(network, &frame);
    free(frame.bytes);
    mspring_network_destroy(network);
}

/* ----------------------------------------------------------------------------------------------------- copies */

/// All springs have the flags and limits of those of the other network.
static void check_alike(const mspring_network *a, const mspring_network *b) {
    const uint32_t springs = mspring_network_count(a, MSPRING_SPRINGS);
    assert_int_equal(springs, mspring_network_count(b, MSPRING_SPRINGS));
    for (mspring_id s = 0; s < springs; s++) {
        assert_int_equal(flags_of(a, s), flags_of(b, s));
        for (int i = 0; i < 4; i++)
            assert_true(get(a, limits[i], s) == get(b, limits[i], s));
    }
}

static void check_goes_on(mspring_network *a, mspring_network *b, double tolerance) {
    const float length = 1.7f;
    check_alike(a, b);
    for (int step = 0; step < 20; step++) {
        set(a, MSPRING_REST_LENGTH, (mspring_id)step, length);
        set(b, MSPRING_REST_LENGTH, (mspring_id)step, length);
        support_steps(a, 1, 1.0 / 64);
        support_steps(b, 1, 1.0 / 64);
    }
    check_alike(a, b);
    assert_true(support_distance(a, b) <= tolerance);
    mspring_network_destroy(b);
}

static mspring_network *mixed(void) {
    const float metres[] = {0.9f, 0.23f, 0.11f, 0.57f};
    mspring_network *network = lattice(MSPRING_SPRING_METRES, metres, 1);
    mspring_spring_def def = spring_def(0, 50, MSPRING_REST_LENGTH_DISTANCE, MSPRING_SPRING_METRES);
    mspring_id added;
    def.stiffness = 100;
    def.break_strain = 3.3f;
    check_ok(mspring_network_add_springs(network, &def, 1, &added));
    assert_true(get(network, MSPRING_BREAK_STRAIN, added) == 3.3f);
    assert_true(get(network, MSPRING_YIELD_STRAIN, added) == MSPRING_NEVER);
    set(network, MSPRING_WARN_STRAIN, 7, 0.31f);
    set(network, MSPRING_REST_LENGTH, 9, 2.13f);
    support_steps(network, 30, 1.0 / 64);
    return network;
}

static void copies_have_them(void **state) {
    (void)state;
    mspring_network *network = mixed(), *fresh = mixed(), *clone;
    mspring_clone_def def;
    check_ok(mspring_init(MSPRING_STRUCT_CLONE_DEF, &def, sizeof def));
    check_ok(mspring_network_clone(network, &def, &clone));
    check_goes_on(network, clone, 0);
    archived file = archives_write(network);
    size_t size;
    assert_true(archives_chunk(&file, "mtrs", &size) != NULL);
    free(file.bytes);
    check_goes_on(network, archives_check_same(network, 1), 0);
    saved all = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    snapshots_load(fresh, &all);
    free(all.bytes);
    check_goes_on(network, fresh, 0);
    check_ok(mspring_network_clone(network, &def, &clone));
    check_ok(mspring_network_compact(clone));
    check_goes_on(network, clone, 1e-3);
    mspring_network_destroy(network);
}

// A spring that takes the id of one in metres has none.
static void ids_that_are_used_again(void **state) {
    (void)state;
    mspring_network *network = one_spring(2, 0, 0.3f, 0.1f);
    mspring_id more[2], first;
    mspring_particle_def particle;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    mspring_network_destroy(network);
    mspring_builder *builder = support_builder();
    for (int i = 0; i < 3; i++)
        (void)support_pinned(builder, i, 0, 1);
    mspring_network_def network_def = support_def(0, 2);
    network_def.spare_springs = 2;
    network = support_network(builder, &network_def);
    mspring_spring_def def = spring_def(0, 1, 2, MSPRING_SPRING_METRES);
    def.break_strain = 0.3f;
    check_ok(mspring_network_add_springs(network, &def, 1, &more[0]));
    first = more[0];
    def = spring_def(1, 2, 2, 0);
    def.break_strain = 0.3f;
    check_ok(mspring_network_add_springs(network, &def, 1, &more[1]));
    assert_int_equal(flags_of(network, more[0]), MSPRING_SPRING_METRES);
    assert_int_equal(flags_of(network, more[1]), 0);
    check_ok(mspring_network_remove_springs(network, &more[0], 0, 1));
    check_ok(mspring_network_reuse_ids(network));
    def.a = 0;
    check_ok(mspring_network_add_springs(network, &def, 1, &more[0]));
    assert_int_equal(more[0], first);
    assert_int_equal(flags_of(network, first), 0);
    set(network, MSPRING_REST_LENGTH, first, 4);
    assert_true(get(network, MSPRING_BREAK_STRAIN, first) == 0.3f);
    mspring_network_destroy(network);
}

// Builders give definitions back as they were, also of an archive, a network and copies.
static void builders_give_them_back(void **state) {
    (void)state;
    mspring_network *network = mixed();
    mspring_builder *of[3] = {support_builder(), support_builder(), support_builder()};
    archived file = archives_write(network);
    check_ok(mspring_builder_add_network(of[0], network, NULL, 0, MSPRING_ALL, NULL, NULL));
    check_ok(mspring_builder_read(of[1], file.bytes, file.size, NULL));
    free(file.bytes);
    const double x = 50, y = 0;
    check_ok(mspring_builder_add_copies(of[2], of[0], 1, &x, &y, 1, NULL, NULL));
    for (int i = 0; i < 3; i++) {
        mspring_spring_def def = spring_def(0, 1, 1, 0);
        check_ok(mspring_builder_get_springs(of[i], NULL, 0, 1, &def));
        assert_int_equal(def.flags, MSPRING_SPRING_METRES);
        assert_true(def.break_strain == 0.9f && def.warn_strain == 0.23f && def.relax_strain == 0.11f &&
                    def.yield_strain == 0.57f);
        mspring_builder_destroy(of[i]);
    }
    mspring_network_destroy(network);
}

static void bad_ones_are_refused(void **state) {
    (void)state;
    mspring_network *network = one_spring(2, MSPRING_SPRING_METRES, 0.3f, 0.1f);
    const mspring_id spring = 0;
    const float bad[] = {0, -1, NAN};
    for (size_t i = 0; i < COUNT_OF(bad); i++)
        check_error(mspring_network_set(network, MSPRING_BREAK_STRAIN, &spring, 0, 1, &bad[i], 1),
                    MSPRING_ERROR_ARGUMENT);
    // Metres whose strain no float holds stay, too: the strain is as near to them as can be.
    set(network, MSPRING_REST_LENGTH, 0, 4e12f);
    set(network, MSPRING_WARN_STRAIN, 0, 1e-38f);
    assert_true(get(network, MSPRING_WARN_STRAIN, 0) == 1e-38f);
    set(network, MSPRING_REST_LENGTH, 0, 1e-12f);
    set(network, MSPRING_BREAK_STRAIN, 0, 1e30f);
    assert_true(get(network, MSPRING_BREAK_STRAIN, 0) == 1e30f);
    saved all = snapshots_save(network, MSPRING_SNAPSHOT_ALL);
    snapshots_load(network, &all);
    uint64_t size;
    uint8_t *metres = snapshots_section_of(&all, "mtrs", &size);
    snapshots_put_float(metres + 4, -1);
    snapshots_check_refused(network, &all, "limits in metres");
    snapshots_check_refused(network, &all, "spring 0 has a");
    free(all.bytes);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(metres_are_what_counts),
        cmocka_unit_test(they_follow_a_new_rest_length),
        cmocka_unit_test(strains_stay_strains),
        cmocka_unit_test(actuators_keep_the_metres),
        cmocka_unit_test(rows_have_the_bits_of_strains),
        cmocka_unit_test(the_same_again_changes_nothing),
        cmocka_unit_test(copies_have_them),
        cmocka_unit_test(ids_that_are_used_again),
        cmocka_unit_test(builders_give_them_back),
        cmocka_unit_test(bad_ones_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

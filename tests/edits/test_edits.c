/// @file test_edits.c
/// Edits between steps: an edited network moves as one that was made that way, bit for bit; ranges and lists do the
/// same; whatever is refused changes nothing.
///
/// SPDX-License-Identifier: MIT
#include <fenv.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "support.h"

static mspring_network *network_of(const recipe *made, mspring_simd level) {
    mspring_network_def def = support_def(-9.8f, 4);
    def.simd_level = level;
    return recipe_network(made, &def);
}

/// Random values, and the ids in another order.
typedef struct values {
    uint32_t count;
    float *value;
    float *value_of_listed;
    mspring_id *list;
} values;

static values random_values(uint32_t count, double low, double high, uint64_t seed) {
    values made = {count, malloc(count * sizeof *made.value), malloc(count * sizeof *made.value_of_listed),
                   malloc(count * sizeof *made.list)};
    assert_true(made.value && made.value_of_listed && made.list);
    for (uint32_t i = 0; i < count; i++) {
        made.value[i] = (float)support_random_between(&seed, low, high);
        made.list[i] = i;
    }
    for (uint32_t i = count; i-- > 1;) {
        const uint32_t j = (uint32_t)(support_random(&seed) % (i + 1));
        const mspring_id id = made.list[i];
        made.list[i] = made.list[j];
        made.list[j] = id;
    }
    for (uint32_t i = 0; i < count; i++) {
        made.value_of_listed[i] = made.value[made.list[i]];
    }
    return made;
}

static void free_values(values *unwanted) {
    free(unwanted->value);
    free(unwanted->value_of_listed);
    free(unwanted->list);
}

/// Take a step, and put the particles back: velocities then count as half a substep old, as in networks that have
/// been edited after a step.
static mspring_network *after_a_step(mspring_network *network) {
    const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
    double x[400], y[400];
    float vx[400], vy[400];
    assert_true(count <= COUNT_OF(x));
    check_ok(mspring_network_get_positions(network, NULL, 0, count, x, y, 1));
    check_ok(mspring_network_get_velocities(network, NULL, 0, count, vx, vy, 1));
    support_steps(network, 1, 1.0 / 64);
    check_ok(mspring_network_set_positions(network, NULL, 0, count, x, y, 1));
    check_ok(mspring_network_set_velocities(network, NULL, 0, count, vx, vy, 1));
    return network;
}

/// Three networks move alike, for two lengths of step.
static void check_same_motion(mspring_network *ranged, mspring_network *listed, mspring_network *made_so) {
    for (int i = 0; i < 2; i++) {
        support_steps(ranged, 10, 1.0 / (64 << i));
        support_steps(listed, 10, 1.0 / (64 << i));
        support_steps(made_so, 10, 1.0 / (64 << i));
        assert_int_equal(support_hash(ranged), support_hash(made_so));
        assert_int_equal(support_hash(listed), support_hash(made_so));
    }
    mspring_network_destroy(ranged);
    mspring_network_destroy(listed);
    mspring_network_destroy(made_so);
}

static void edited_masses_count_like_those_made_so(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    for (uint32_t i = 0; i < level_count; i++) {
        recipe made = recipe_rows(21, 0, 0, 5);
        values mass = random_values(made.particle_count, 1, 5, 3);
        mspring_network *ranged = network_of(&made, levels[i]), *listed = network_of(&made, levels[i]);
        const uint32_t half = mass.count / 2;
        check_ok(mspring_network_set(ranged, MSPRING_MASS, NULL, 0, half, mass.value, 1));
        check_ok(mspring_network_set(ranged, MSPRING_MASS, NULL, half, mass.count - half, mass.value + half, 1));
        check_ok(mspring_network_set(listed, MSPRING_MASS, mass.list, 0, mass.count, mass.value_of_listed, 1));
        for (uint32_t p = 0; p < made.particle_count; p++) {
            made.particles[p].mass = mass.value[p];
        }
        float seen[2];
        check_ok(mspring_network_get(listed, MSPRING_MASS, NULL, 7, 2, seen, 1));
        assert_memory_equal(seen, mass.value + 7, sizeof seen);
        check_same_motion(ranged, listed, network_of(&made, levels[i]));
        free_values(&mass);
        recipe_free(&made);
    }
}

static void relative_springs_follow_new_masses(void **state) {
    (void)state;
    recipe made = recipe_rows(21, MSPRING_SPRING_RELATIVE, 0, 5);
    values mass = random_values(made.particle_count, 1, 5, 4);
    // They are as if they had been made with these masses; before the first step and after one.
    mspring_network *first = network_of(&made, MSPRING_SIMD_AUTO), *later = network_of(&made, MSPRING_SIMD_AUTO);
    check_ok(mspring_network_set(first, MSPRING_MASS, NULL, 0, mass.count, mass.value, 1));
    after_a_step(first);
    after_a_step(later);
    check_ok(mspring_network_set(later, MSPRING_MASS, NULL, 0, mass.count, mass.value, 1));
    for (uint32_t p = 0; p < made.particle_count; p++) {
        made.particles[p].mass = mass.value[p];
    }
    check_same_motion(first, later, after_a_step(network_of(&made, MSPRING_SIMD_AUTO)));
    free_values(&mass);
    recipe_free(&made);
}

static void scales_of_inverse_mass_make_particles_heavier(void **state) {
    (void)state;
    // Scales that are powers of two, so that mass over scale has no rounding.
    recipe made = recipe_rows(21, 0, 0, 5);
    values scale = random_values(made.particle_count, 0, 1, 5);
    for (uint32_t p = 0; p < scale.count; p++) {
        scale.value[p] = p % 7 == 0 ? 0.0f : scale.value[p] < 0.3f ? 0.25f : scale.value[p] < 0.6f ? 0.5f : 1.0f;
    }
    for (uint32_t i = 0; i < scale.count; i++) {
        scale.value_of_listed[i] = scale.value[scale.list[i]];
    }
    mspring_network *ranged = network_of(&made, MSPRING_SIMD_AUTO), *listed = network_of(&made, MSPRING_SIMD_AUTO);
    check_ok(mspring_network_set(ranged, MSPRING_INVERSE_MASS_SCALE, NULL, 0, scale.count, scale.value, 1));
    check_ok(mspring_network_set(listed, MSPRING_INVERSE_MASS_SCALE, scale.list, 0, scale.count,
                                 scale.value_of_listed, 1));
    // Masses change, scales stay.
    values mass = random_values(made.particle_count, 1, 5, 6);
    check_ok(mspring_network_set(ranged, MSPRING_MASS, NULL, 0, mass.count, mass.value, 1));
    check_ok(mspring_network_set(listed, MSPRING_MASS, mass.list, 0, mass.count, mass.value_of_listed, 1));
    for (uint32_t p = 0; p < made.particle_count; p++) {
        const float s = scale.value[p];
        made.particles[p].flags = s == 0 ? MSPRING_PARTICLE_PINNED : 0;
        made.particles[p].mass = s == 0 ? mass.value[p] : mass.value[p] / s;
    }
    float *seen = malloc(scale.count * sizeof *seen);
    assert_non_null(seen);
    check_ok(mspring_network_get(ranged, MSPRING_INVERSE_MASS_SCALE, NULL, 0, scale.count, seen, 1));
    assert_memory_equal(seen, scale.value, scale.count * sizeof *seen);
    free(seen);
    mspring_network *twin = network_of(&made, MSPRING_SIMD_AUTO);
    // A pinned particle goes on with the velocity it had; here as there.
    check_same_motion(ranged, listed, twin);
    free_values(&scale);
    free_values(&mass);
    recipe_free(&made);
}

static void pins_come_and_go(void **state) {
    (void)state;
    recipe made = recipe_rows(21, 0, 0, 5);
    mspring_network *network = network_of(&made, MSPRING_SIMD_AUTO), *twin = network_of(&made, MSPRING_SIMD_AUTO);
    const mspring_id some[] = {0, 5, 9, made.particle_count - 1};
    const float zeros[4] = {0}, ones[4] = {1, 1, 1, 1}, mass[4] = {3, 3, 3, 3};
    float scales[4];
    check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, some, 0, 4, zeros, 1));
    const support_point before = support_position(network, 5);
    check_ok(mspring_network_set_velocities(network, some, 0, 4, zeros, zeros, 1));
    check_ok(mspring_network_set(network, MSPRING_MASS, some, 0, 4, mass, 1)); // and a pinned one stays so
    support_steps(network, 20, 0.01);
    assert_true(support_position(network, 5).x == before.x && support_position(network, 5).y == before.y);
    check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, some, 0, 4, ones, 1));
    check_ok(mspring_network_get(network, MSPRING_INVERSE_MASS_SCALE, NULL, 5, 4, scales, 1));
    assert_memory_equal(scales, ones, sizeof ones);
    support_steps(network, 1, 0.01);
    assert_true(support_position(network, 5).y != before.y);
    mspring_network_destroy(network);
    mspring_network_destroy(twin);
    recipe_free(&made);
}

/// What can be set of springs, and where it is in their definitions.
typedef struct spring_part {
    mspring_property property;
    size_t offset;
    double low[2], high[2]; ///< absolute, relative
} spring_part;

static const spring_part spring_parts[] = {
    {MSPRING_STIFFNESS, offsetof(mspring_spring_def, stiffness), {200, 0.05}, {900, 0.2}},
    {MSPRING_DAMPING, offsetof(mspring_spring_def, damping), {0, 0}, {5, 0.05}},
    {MSPRING_REST_LENGTH, offsetof(mspring_spring_def, rest_length), {0.9, 0.9}, {1.1, 1.1}},
};

static void edited_springs_act_like_those_made_so(void **state) {
    (void)state;
    for (size_t part = 0; part < COUNT_OF(spring_parts); part++) {
        const spring_part *kind = &spring_parts[part];
        // Absolute and relative; edited before the first step, or after a step and taken back to the start; whole
        // or, while edited, broken.
        for (int variant = 0; variant < 8; variant++) {
            const bool relative = variant & 1, late = variant & 2, broken = variant & 4;
            recipe made = recipe_rows(21, relative ? MSPRING_SPRING_RELATIVE : 0, 0, 5);
            values wanted = random_values(made.spring_count, kind->low[relative], kind->high[relative], 7 + part);
            mspring_network *networks[2];
            for (int i = 0; i < 2; i++) {
                mspring_network *network = networks[i] = network_of(&made, MSPRING_SIMD_AUTO);
                if (late) {
                    after_a_step(network);
                }
                if (broken) {
                    check_ok(mspring_network_break_springs(network, wanted.list, 0, 100));
                }
                check_ok(i == 0
                             ? mspring_network_set(network, kind->property, NULL, 0, wanted.count, wanted.value, 1)
                             : mspring_network_set(network, kind->property, wanted.list, 0, wanted.count,
                                                   wanted.value_of_listed, 1));
                if (broken) {
                    check_ok(mspring_network_restore_springs(network, wanted.list, 0, 100, 0));
                }
            }
            for (uint32_t s = 0; s < made.spring_count; s++) {
                memcpy((char *)&made.springs[s] + kind->offset, &wanted.value[s], sizeof(float));
            }
            mspring_network *made_so = network_of(&made, MSPRING_SIMD_AUTO);
            check_same_motion(networks[0], networks[1], late ? after_a_step(made_so) : made_so);
            free_values(&wanted);
            recipe_free(&made);
        }
    }
}

static void damping_needs_room(void **state) {
    (void)state;
    recipe made = recipe_rows(21, 0, 0, 0);
    const float some = 3, none = 0;
    mspring_network *network = network_of(&made, MSPRING_SIMD_AUTO);
    check_error(mspring_network_set(network, MSPRING_DAMPING, NULL, 4, 1, &some, 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "MSPRING_NETWORK_RESERVE_DAMPING");
    check_ok(mspring_network_set(network, MSPRING_DAMPING, NULL, 4, 1, &none, 1));
    mspring_network_destroy(network);

    mspring_network_def def = support_def(-9.8f, 4);
    def.flags = MSPRING_NETWORK_RESERVE_DAMPING;
    network = recipe_network(&made, &def);
    check_ok(mspring_network_set(network, MSPRING_DAMPING, NULL, 4, 1, &some, 1));
    support_spring_info info;
    check_ok(support_get_spring(network, 4, &info));
    assert_true(info.damping == 3 && info.nominal_damping == 3);
    mspring_network_destroy(network);

    def.flags = MSPRING_NETWORK_POSES << 1;
    mspring_builder *builder = recipe_builder(&made, NULL);
    check_error(mspring_network_create(builder, &def, &network), MSPRING_ERROR_ARGUMENT);
    check_contains(support_builder_error(builder), "flags");
    mspring_builder_destroy(builder);
    recipe_free(&made);
}

static void scattered_positions_and_velocities_equal_ranges(void **state) {
    (void)state;
    recipe made = recipe_rows(21, 0, 0, 5);
    const mspring_id list[] = {3, 70, 3};
    const double x[] = {0, 33.25, 4.5}, y[] = {0, 1.125, -7};
    const float vx[] = {9, 1, 2}, vy[] = {9, -3, 4};
    mspring_network *listed = network_of(&made, MSPRING_SIMD_AUTO), *ranged = network_of(&made, MSPRING_SIMD_AUTO);
    check_ok(mspring_network_set_positions(listed, list, 0, 3, x, y, 1));
    check_ok(mspring_network_set_velocities(listed, list, 0, 3, vx, vy, 1));
    for (int i = 1; i < 3; i++) {
        check_ok(mspring_network_set_positions(ranged, NULL, list[i], 1, x + i, y + i, 1));
        check_ok(mspring_network_set_velocities(ranged, NULL, list[i], 1, vx + i, vy + i, 1));
    }
    assert_int_equal(support_hash(listed), support_hash(ranged));
    mspring_network_destroy(listed);
    mspring_network_destroy(ranged);
    recipe_free(&made);
}

/* ---------------------------------------------------------------------------------------------------- refusals */

static void what_is_refused_changes_nothing(void **state) {
    (void)state;
    recipe made = recipe_rows(21, 0, 0, 5);
    mspring_network *network = network_of(&made, MSPRING_SIMD_AUTO), *twin = network_of(&made, MSPRING_SIMD_AUTO);
    const mspring_id list[] = {1, 2, 3}, beyond[] = {1, made.spring_count, 3};
    const double far[] = {0, 1e13, 0}, near[] = {0, 0, 0};
    const float good[] = {1, 1, 1};
    const float bad_masses[] = {0, -1, 1e31f, NAN, INFINITY}, bad_scales[] = {-1, 1e-7f, 1.5f, NAN};
    const float bad_values[] = {-1, 1e31f, NAN, INFINITY}, bad_lengths[] = {-1e-30f, -1, 5e12f, NAN, INFINITY};
    for (size_t i = 0; i < COUNT_OF(bad_masses); i++) {
        const float mass[] = {2, bad_masses[i], 2};
        check_error(mspring_network_set(network, MSPRING_MASS, NULL, 5, 3, mass, 1), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "particle 6");
        check_error(mspring_network_set(network, MSPRING_MASS, list, 0, 3, mass, 1), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "particle 2");
    }
    for (size_t i = 0; i < COUNT_OF(bad_scales); i++) {
        const float scale[] = {0.5f, bad_scales[i], 0};
        check_error(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, 5, 3, scale, 1),
                    MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "particle 6");
        check_error(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, list, 0, 3, scale, 1),
                    MSPRING_ERROR_ARGUMENT);
    }
    for (size_t part = 0; part < COUNT_OF(spring_parts); part++) {
        const spring_part *kind = &spring_parts[part];
        const bool length = kind->offset == offsetof(mspring_spring_def, rest_length);
        for (size_t i = 0; i < (length ? COUNT_OF(bad_lengths) : COUNT_OF(bad_values)); i++) {
            const float value[] = {2, length ? bad_lengths[i] : bad_values[i], 2};
            check_error(mspring_network_set(network, kind->property, NULL, 5, 3, value, 1), MSPRING_ERROR_ARGUMENT);
            check_contains(mspring_network_error(network), "spring 6");
            check_error(mspring_network_set(network, kind->property, list, 0, 3, value, 1), MSPRING_ERROR_ARGUMENT);
            check_contains(mspring_network_error(network), "spring 2");
        }
        check_error(mspring_network_set(network, kind->property, NULL, made.spring_count - 2, 3, good, 1),
                    MSPRING_ERROR_ID);
        check_error(mspring_network_set(network, kind->property, beyond, 0, 3, good, 1), MSPRING_ERROR_ID);
        check_contains(mspring_network_error(network), "index 1");
        check_error(mspring_network_set(network, kind->property, NULL, 0, 3, NULL, 1), MSPRING_ERROR_ARGUMENT);
        check_error(mspring_network_set(network, kind->property, list, 0, MSPRING_ALL, good, 0),
                    MSPRING_ERROR_ARGUMENT);
        check_error(mspring_network_set(network, kind->property, NULL, 0, MSPRING_ALL, good, 1),
                    MSPRING_ERROR_ARGUMENT);
        check_error(mspring_network_set(NULL, kind->property, NULL, 0, 0, good, 1), MSPRING_ERROR_ARGUMENT);
        check_ok(mspring_network_set(network, kind->property, NULL, 0, 0, NULL, 1));
    }
    check_error(mspring_network_set(network, MSPRING_MASS, NULL, made.particle_count, 1, good, 1),
                MSPRING_ERROR_ID);
    check_error(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, MSPRING_NONE, 1, good, 1),
                MSPRING_ERROR_ID);
    check_error(mspring_network_set_positions(network, list, 0, 3, near, far, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set_positions(network, beyond, 0, 3, near, near, 1), MSPRING_ERROR_ID);
    check_error(mspring_network_set_positions(network, list, 0, 3, near, NULL, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_set_velocities(network, list, 0, 3, good, (const float[]){0, NAN, 0}, 1),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_detach_particles(network, beyond, 0, 3), MSPRING_ERROR_ID);
    check_error(mspring_network_detach_particles(network, list, 0, MSPRING_ALL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_detach_particles(network, NULL, made.particle_count - 1, 2), MSPRING_ERROR_ID);
    const double bad_ramps[] = {-1, 1e7, NAN, INFINITY};
    for (size_t i = 0; i < COUNT_OF(bad_ramps); i++) {
        check_error(mspring_network_restore_springs(network, list, 0, 3, bad_ramps[i]), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "ramp");
    }
    float scale;
    check_error(mspring_network_get(network, MSPRING_INVERSE_MASS_SCALE, NULL, made.particle_count, 1, &scale, 1),
                MSPRING_ERROR_ID);
    check_error(mspring_network_get(network, MSPRING_INVERSE_MASS_SCALE, NULL, 0, 1, NULL, 1),
                MSPRING_ERROR_ARGUMENT);

    support_steps(network, 10, 0.01);
    support_steps(twin, 10, 0.01);
    assert_int_equal(support_hash(network), support_hash(twin));
    mspring_network_destroy(network);
    mspring_network_destroy(twin);
    recipe_free(&made);
}

static void edit_in_hook(const mspring_hook_args *args, void *user) {
    mspring_network *network = user;
    const mspring_id id = 1;
    const float one = 1;
    const double place = 0;
    (void)args;
    check_error(mspring_network_set(network, MSPRING_MASS, NULL, 0, 1, &one, 1), MSPRING_ERROR_BUSY);
    check_error(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, &id, 0, 1, &one, 1), MSPRING_ERROR_BUSY);
    check_error(mspring_network_set(network, MSPRING_STIFFNESS, NULL, 0, 1, &one, 1), MSPRING_ERROR_BUSY);
    check_error(mspring_network_set(network, MSPRING_REST_LENGTH, &id, 0, 1, &one, 1), MSPRING_ERROR_BUSY);
    check_error(mspring_network_set_positions(network, &id, 0, 1, &place, &place, 1), MSPRING_ERROR_BUSY);
    check_error(mspring_network_break_springs(network, &id, 0, 1), MSPRING_ERROR_BUSY);
    check_error(mspring_network_restore_springs(network, &id, 0, 1, 1), MSPRING_ERROR_BUSY);
    check_error(mspring_network_detach_particles(network, &id, 0, 1), MSPRING_ERROR_BUSY);
}

static void no_edits_in_the_middle_of_a_step(void **state) {
    (void)state;
    recipe made = recipe_rows(21, 0, 0, 5);
    mspring_network *network = network_of(&made, MSPRING_SIMD_AUTO);
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, edit_in_hook, network, NULL));
    support_steps(network, 1, 0.01);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// One edit of each kind that may allocate.
static mspring_result edit_number(mspring_network *network, int number) {
    const mspring_id ids[] = {3, 8};
    const float half[] = {0.5f, 0.5f}, mass[] = {2, 3};
    switch (number) {
    case 0:
        return mspring_network_set(network, MSPRING_MASS, ids, 0, 2, mass, 1);
    case 1:
        return mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, ids, 0, 2, half, 1);
    case 2:
        return mspring_network_detach_particles(network, ids, 0, 2);
    default:
        return mspring_network_restore_springs(network, ids, 0, 2, 0.5);
    }
}

enum { EDITS = 4 };

static void edits_survive_every_failure(void **state) {
    (void)state;
    recipe made = recipe_rows(21, MSPRING_SPRING_RELATIVE, 0, 5);
    mspring_network *twin = network_of(&made, MSPRING_SIMD_AUTO);
    for (int i = 0; i < EDITS; i++) {
        check_ok(edit_number(twin, i));
    }
    support_steps(twin, 3, 0.01);
    size_t fail_at = 1;
    for (bool failed = true; failed; fail_at++) {
        watched_allocator watched = {0};
        mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def def = support_def(-9.8f, 4);
        def.allocator = &allocator;
        mspring_network *network = recipe_network(&made, &def);
        watched.fail_at = watched.calls + fail_at;
        failed = false;
        for (int i = 0; i < EDITS; i++) {
            mspring_result result = edit_number(network, i);
            if (result != MSPRING_OK) {
                check_error(result, MSPRING_ERROR_MEMORY);
                check_contains(mspring_network_error(network), "memory");
                failed = true;
                check_ok(edit_number(network, i));
            }
        }
        const size_t calls = watched.calls;
        support_steps(network, 3, 0.01);
        assert_int_equal(watched.calls, calls);
        assert_int_equal(support_hash(network), support_hash(twin));
        mspring_network_destroy(network);
        check_watched_clean(&watched);
    }
    assert_true(fail_at > 6);
    mspring_network_destroy(twin);
    recipe_free(&made);
}

static void rounding_mode_of_the_host_does_not_matter(void **state) {
    (void)state;
    recipe made = recipe_rows(21, MSPRING_SPRING_RELATIVE, 0, 5);
    values mass = random_values(made.particle_count, 1, 5, 3);
    const int modes[] = {FE_TONEAREST, FE_UPWARD, FE_TOWARDZERO};
    uint64_t expected = 0;
    for (size_t i = 0; i < COUNT_OF(modes); i++) {
        mspring_network *network = network_of(&made, MSPRING_SIMD_AUTO);
        support_steps(network, 1, 0.01);
        const mspring_id ids[] = {3, 8};
        const float third[] = {1 / 3.0f, 1 / 3.0f};
        assert_int_equal(fesetround(modes[i]), 0);
        const volatile float one = 1, little = 1e-10f;
        const volatile float above = one + little, below = one - little;
        check_ok(mspring_network_set(network, MSPRING_MASS, NULL, 0, mass.count, mass.value, 1));
        check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, ids, 0, 2, third, 1));
        check_ok(mspring_network_set(network, MSPRING_STIFFNESS, ids, 0, 2, third, 1));
        check_ok(mspring_network_break_springs(network, ids, 0, 2));
        check_ok(mspring_network_restore_springs(network, ids, 0, 2, 0.3));
        mspring_body first = {.struct_size = sizeof first};
        check_ok(mspring_network_update_components(network, NULL, NULL));
        check_ok(mspring_network_get_components(network, 0, 1, &first));
        // It is the thread's, and as it was; which fegetround() need not know.
        assert_int_equal(fegetround(), modes[i]);
        assert_true(one + little == above && one - little == below);
        fesetround(FE_TONEAREST);
        support_steps(network, 3, 0.01);
        expected = i == 0 ? support_hash(network) : expected;
        assert_int_equal(support_hash(network), expected);
        mspring_network_destroy(network);
    }
    free_values(&mass);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edited_masses_count_like_those_made_so),
        cmocka_unit_test(relative_springs_follow_new_masses),
        cmocka_unit_test(scales_of_inverse_mass_make_particles_heavier),
        cmocka_unit_test(pins_come_and_go),
        cmocka_unit_test(edited_springs_act_like_those_made_so),
        cmocka_unit_test(damping_needs_room),
        cmocka_unit_test(scattered_positions_and_velocities_equal_ranges),
        cmocka_unit_test(what_is_refused_changes_nothing),
        cmocka_unit_test(no_edits_in_the_middle_of_a_step),
        cmocka_unit_test(edits_survive_every_failure),
        cmocka_unit_test(rounding_mode_of_the_host_does_not_matter),
    };
    return cmocka_run_group_tests_name("edits", tests, NULL, NULL);
}

/// @file test_snapshot.c
/// Snapshots: what is saved comes back, and what is no snapshot is refused.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "recipe.h"
#include "snapshot/format.h"
#include "support.h"

enum { MOST = 400 };

static mspring_network *make(const recipe *made, mspring_simd level, uint32_t worker_count) {
    mspring_network_def def = support_def(-9.8f, 4);
    def.simd_level = level;
    def.worker_count = worker_count;
    return recipe_network(made, &def);
}

static void use_solver(mspring_network *network, mspring_solver kind, mspring_integrator integrator,
                       uint32_t coarse_period) {
    mspring_solver_def solver;
    check_ok(mspring_solver_def_init(&solver, sizeof solver));
    solver.solver = kind;
    solver.integrator = integrator;
    solver.coarse_period = coarse_period;
    solver.substeps = 2;
    check_ok(mspring_network_set_solver(network, &solver));
}

typedef struct saved {
    uint8_t *bytes;
    size_t size;
} saved;

static saved save(const mspring_network *network, mspring_snapshot_contents contents) {
    saved out;
    size_t written = 0;
    check_ok(mspring_network_snapshot_size(network, contents, &out.size));
    out.bytes = malloc(out.size + 1);
    assert_non_null(out.bytes);
    out.bytes[out.size] = 0xab;
    check_ok(mspring_network_save(network, contents, out.bytes, out.size, &written));
    assert_int_equal(written, out.size);
    assert_int_equal(out.bytes[out.size], 0xab);
    return out;
}

static void load(mspring_network *network, const saved *from) {
    mspring_result result = mspring_network_load(network, from->bytes, from->size);
    if (result != MSPRING_OK) {
        print_error("%s\n", mspring_network_error(network));
    }
    check_ok(result);
}

/* ---------------------------------------------------------------------------------------------------- frames */

/// What the springs are like: what a frame leaves out.
static void set_up(mspring_network *network) {
    const uint32_t springs = mspring_network_spring_count(network);
    float values[MOST * 2];
    assert_true(springs <= COUNT_OF(values));
    for (uint32_t i = 0; i < springs; i++) {
        values[i] = i % 7 == 0 ? INFINITY : 0.05f + 0.01f * (float)(i % 5);
    }
    check_ok(mspring_network_set_break_strains(network, 0, springs, values));
    for (uint32_t i = 0; i < springs; i++) {
        values[i] = 0.01f;
    }
    check_ok(mspring_network_set_stress_strains(network, 0, springs, values));
    check_ok(mspring_network_set_relax_fraction(network, 0.7f));
    const float rest_length = 1.03f;
    const mspring_id spring = 3;
    check_ok(mspring_network_set_rest_lengths_at(network, &spring, 1, &rest_length));
}

/// A frame of a game, which does a bit of everything, as a function of the frame's number alone.
static void run_frame(mspring_network *network, uint32_t frame) {
    const uint32_t springs = mspring_network_spring_count(network);
    const uint32_t particles = mspring_network_particle_count(network);
    const mspring_id broken[] = {frame * 7 % springs, frame * 13 % springs};
    check_ok(mspring_network_break_springs(network, broken, 2));
    if (frame % 3 == 1) {
        const mspring_id whole[] = {(frame - 1) * 7 % springs};
        check_ok(mspring_network_restore_springs(network, whole, 1, frame % 2 == 0 ? 0 : 0.5));
    }
    if (frame % 4 == 2) {
        const float mass = 1 + 0.1f * (float)(frame % 10);
        check_ok(mspring_network_set_masses(network, frame % particles, 1, &mass));
    }
    if (frame % 5 == 3) {
        const float scale = frame % 2 == 0 ? 0.5f : 1;
        check_ok(mspring_network_set_inverse_mass_scales(network, frame * 3 % particles, 1, &scale));
    }
    check_ok(mspring_network_set_gravity(network, 0.1f * (float)(frame % 3), -9.8f));
    check_ok(mspring_network_apply_force(network, frame * 11 % particles, 30, 5));
    check_ok(mspring_network_step(network, frame % 6 == 5 ? 0.013 : 0.01));
    // For the next step.
    check_ok(mspring_network_apply_force(network, frame * 5 % particles, -20, 3));
}

/// Everything that can be asked, in one number.
static uint64_t look_at(const mspring_network *network) {
    double energy[3];
    float strain[MOST * 2], mass[MOST], scale[MOST];
    const uint32_t springs = mspring_network_spring_count(network);
    const uint32_t particles = mspring_network_particle_count(network);
    uint64_t sum = support_hash(network);
    check_ok(mspring_network_energy(network, &energy[0], &energy[1], &energy[2]));
    check_ok(mspring_network_get_strains(network, 0, springs, strain));
    check_ok(mspring_network_get_masses(network, 0, particles, mass));
    check_ok(mspring_network_get_inverse_mass_scales(network, 0, particles, scale));
    const void *const parts[] = {energy, strain, mass, scale};
    const size_t sizes[] = {sizeof energy, springs * sizeof *strain, particles * sizeof *mass,
                            particles * sizeof *scale};
    for (size_t part = 0; part < COUNT_OF(parts); part++) {
        for (size_t i = 0; i < sizes[part]; i++) {
            sum = (sum ^ ((const uint8_t *)parts[part])[i]) * 0x100000001b3u;
        }
    }
    for (mspring_id s = 0; s < springs; s++) {
        mspring_spring_info info = {.struct_size = sizeof info};
        check_ok(mspring_network_get_spring(network, s, &info));
        uint32_t stiffness;
        memcpy(&stiffness, &info.stiffness, sizeof stiffness);
        sum = (sum ^ info.flags ^ (uint64_t)stiffness << 32) * 0x100000001b3u;
    }
    return sum;
}

enum { FRAMES = 60, BACK = 8 };

/// Go on for some frames, go back, and go on again: the same.
static void check_rollback(mspring_snapshot_contents contents, uint32_t worker_count, mspring_solver kind,
                           mspring_integrator integrator, uint32_t coarse_period) {
    recipe made = recipe_mixed(3);
    mspring_network *network = make(&made, MSPRING_SIMD_AUTO, worker_count);
    mspring_network *straight = make(&made, MSPRING_SIMD_SCALAR, 1);
    if (kind != MSPRING_SOLVER_EXPLICIT) {
        use_solver(network, kind, integrator, coarse_period);
        use_solver(straight, kind, integrator, coarse_period);
    }
    uint64_t seen[FRAMES];
    saved states[FRAMES];
    set_up(network);
    set_up(straight);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        states[frame] = save(network, contents);
        run_frame(network, frame);
        run_frame(straight, frame);
        seen[frame] = look_at(network);
        assert_int_equal(seen[frame], look_at(straight));
        if (frame % 10 == 9) {
            // Back, and through the same frames again.
            load(network, &states[frame + 1 - BACK]);
            for (uint32_t again = frame + 1 - BACK; again <= frame; again++) {
                run_frame(network, again);
                assert_int_equal(look_at(network), seen[again]);
            }
        }
    }
    // Something did happen: springs that broke by strain, some that are whole.
    double energy;
    check_ok(mspring_network_energy(network, &energy, NULL, NULL));
    assert_true(energy > 0);
    // From any frame to any other.
    uint64_t seed = 9;
    for (int jump = 0; jump < 50; jump++) {
        const uint32_t frame = (uint32_t)(support_random(&seed) % FRAMES);
        load(network, &states[frame]);
        run_frame(network, frame);
        assert_int_equal(look_at(network), seen[frame]);
    }
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        free(states[frame].bytes);
    }
    mspring_network_destroy(network);
    mspring_network_destroy(straight);
    recipe_free(&made);
}

static void a_rollback_gives_the_same_bits(void **state) {
    (void)state;
    check_rollback(MSPRING_SNAPSHOT_ALL, 1, MSPRING_SOLVER_EXPLICIT, 0, 0);
    check_rollback(MSPRING_SNAPSHOT_FRAME, 1, MSPRING_SOLVER_EXPLICIT, 0, 0);
    check_rollback(MSPRING_SNAPSHOT_FRAME, 3, MSPRING_SOLVER_EXPLICIT, 0, 0);
}

static void a_rollback_of_the_implicit_solvers_gives_the_same_bits(void **state) {
    (void)state;
    for (mspring_integrator integrator = MSPRING_INTEGRATOR_GA0; integrator <= MSPRING_INTEGRATOR_EULER;
         integrator++) {
        check_rollback(MSPRING_SNAPSHOT_ALL, 1, MSPRING_SOLVER_IMPLICIT, integrator, 1);
        check_rollback(MSPRING_SNAPSHOT_FRAME, 1, MSPRING_SOLVER_IMPLICIT, integrator, 5);
        check_rollback(MSPRING_SNAPSHOT_ALL, 1, MSPRING_SOLVER_DIRECT, integrator, 0);
        check_rollback(MSPRING_SNAPSHOT_FRAME, 1, MSPRING_SOLVER_DIRECT, integrator, 0);
    }
}

/// What a solver has gone through that is not in a snapshot does not matter: not even after ten thousand steps.
static void an_old_network_goes_on_like_a_young_one(void **state) {
    (void)state;
    recipe made = recipe_mixed(3);
    for (mspring_solver kind = MSPRING_SOLVER_IMPLICIT; kind <= MSPRING_SOLVER_DIRECT; kind++) {
        mspring_network *old = make(&made, MSPRING_SIMD_AUTO, 1), *young = make(&made, MSPRING_SIMD_AUTO, 1);
        use_solver(old, kind, MSPRING_INTEGRATOR_GA0, 1);
        use_solver(young, kind, MSPRING_INTEGRATOR_GA0, 1);
        support_steps(young, 1, 0.01);
        const saved start = save(young, MSPRING_SNAPSHOT_ALL);
        support_steps(old, 10000, 0.001);
        load(old, &start);
        for (int step = 0; step < 5; step++) {
            support_steps(old, 1, 0.01);
            support_steps(young, 1, 0.01);
            assert_int_equal(look_at(old), look_at(young));
        }
        free(start.bytes);
        mspring_network_destroy(old);
        mspring_network_destroy(young);
    }
    recipe_free(&made);
}

static void solvers_have_to_be_alike(void **state) {
    (void)state;
    recipe made = recipe_mixed(3);
    mspring_network *explicit_one = make(&made, MSPRING_SIMD_AUTO, 1);
    mspring_network *implicit_one = make(&made, MSPRING_SIMD_AUTO, 1);
    mspring_network *other_one = make(&made, MSPRING_SIMD_AUTO, 1);
    mspring_network *direct_one = make(&made, MSPRING_SIMD_AUTO, 1);
    use_solver(implicit_one, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, 1);
    use_solver(other_one, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER, 1);
    use_solver(direct_one, MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_BDF2, 1);
    saved of_explicit = save(explicit_one, MSPRING_SNAPSHOT_ALL);
    saved of_implicit = save(implicit_one, MSPRING_SNAPSHOT_ALL);
    check_error(mspring_network_load(implicit_one, of_explicit.bytes, of_explicit.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(implicit_one), "implicit solver");
    check_error(mspring_network_load(explicit_one, of_implicit.bytes, of_implicit.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(explicit_one), "implicit solver");
    check_error(mspring_network_load(other_one, of_implicit.bytes, of_implicit.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(other_one), "integrator");
    check_error(mspring_network_load(direct_one, of_implicit.bytes, of_implicit.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(direct_one), "another solver");
    saved of_direct = save(direct_one, MSPRING_SNAPSHOT_ALL);
    check_error(mspring_network_load(implicit_one, of_direct.bytes, of_direct.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(implicit_one), "another solver");
    mspring_network_destroy(direct_one);
    free(of_direct.bytes);
    free(of_explicit.bytes);
    free(of_implicit.bytes);
    mspring_network_destroy(explicit_one);
    mspring_network_destroy(implicit_one);
    mspring_network_destroy(other_one);
    recipe_free(&made);
}

static void snapshots_are_the_same_everywhere(void **state) {
    (void)state;
    recipe made = recipe_mixed(3);
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    saved first = {0};
    for (uint32_t i = 0; i < count; i++) {
        mspring_network *network = make(&made, levels[i], i + 1);
        set_up(network);
        for (uint32_t frame = 0; frame < 20; frame++) {
            run_frame(network, frame);
        }
        saved now = save(network, MSPRING_SNAPSHOT_ALL);
        if (i == 0) {
            first = now;
        } else {
            assert_int_equal(now.size, first.size);
            assert_memory_equal(now.bytes, first.bytes, first.size);
            free(now.bytes);
        }
        mspring_network_destroy(network);
    }
    free(first.bytes);
    recipe_free(&made);
}

static void all_goes_into_a_new_network(void **state) {
    (void)state;
    recipe made = recipe_mixed(3);
    mspring_network *old = make(&made, MSPRING_SIMD_AUTO, 1);
    set_up(old);
    for (uint32_t frame = 0; frame < 20; frame++) {
        run_frame(old, frame);
    }
    saved all = save(old, MSPRING_SNAPSHOT_ALL), frame_only = save(old, MSPRING_SNAPSHOT_FRAME);
    assert_true(frame_only.size < all.size);

    // A new one lacks the edits of set_up(): it needs all.
    mspring_network *new = make(&made, MSPRING_SIMD_SCALAR, 2);
    const uint64_t before = look_at(new);
    check_error(mspring_network_load(new, frame_only.bytes, frame_only.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(new), "MSPRING_SNAPSHOT_FRAME");
    assert_int_equal(look_at(new), before);
    load(new, &all);
    assert_int_equal(look_at(new), look_at(old));
    load(new, &frame_only);
    for (uint32_t frame = 20; frame < 30; frame++) {
        run_frame(old, frame);
        run_frame(new, frame);
        assert_int_equal(look_at(new), look_at(old));
    }
    // And back to one that has none of what there is now.
    mspring_network *fresh = make(&made, MSPRING_SIMD_AUTO, 1);
    saved start = save(fresh, MSPRING_SNAPSHOT_ALL);
    load(new, &start);
    assert_int_equal(look_at(new), before);
    for (uint32_t frame = 0; frame < 5; frame++) {
        run_frame(fresh, frame);
        run_frame(new, frame);
        assert_int_equal(look_at(new), look_at(fresh));
    }
    mspring_network_destroy(old);
    mspring_network_destroy(new);
    mspring_network_destroy(fresh);
    free(all.bytes);
    free(frame_only.bytes);
    free(start.bytes);
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------------------- what is refused */

/// A network of few bytes, with something in each section.
static recipe small_recipe(void) {
    uint64_t seed = 5;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {50, 90}, .damping = {0, 1}};
    const recipe_stuff relative = {
        .mass = {1, 2}, .stiffness = {0.1, 0.2}, .spring_flags = MSPRING_SPRING_RELATIVE};
    recipe made = {0};
    recipe_lattice(&made, 4, 3, 0, 0, 1, &stuff, &seed);
    const mspring_id end = recipe_particle(&made, 9, 3, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 11, end, 4, &relative, &seed);
    return made;
}

static mspring_network *small_network(const recipe *made) {
    mspring_network *network = make(made, MSPRING_SIMD_AUTO, 1);
    set_up(network);
    for (uint32_t frame = 0; frame < 6; frame++) {
        run_frame(network, frame);
    }
    return network;
}

static void damage_is_found(void **state) {
    (void)state;
    recipe made = small_recipe();
    mspring_network *network = small_network(&made);
    saved good = save(network, MSPRING_SNAPSHOT_ALL);
    const uint64_t before = look_at(network);
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
    assert_int_equal(look_at(network), before);
    // And it was good.
    load(network, &good);
    assert_int_equal(look_at(network), before);
    mspring_network_destroy(network);
    free(good.bytes);
    recipe_free(&made);
}

static void renew_checksum(saved *of) {
    const size_t summed = of->size - MSPRINGI_SNAPSHOT_CHECKSUM_BYTES;
    mspringi_checksum checksum = {{0}, {0}};
    mspringi_checksum_add(&checksum, of->bytes, summed / MSPRINGI_CHECKSUM_UNIT);
    const uint64_t value = mspringi_checksum_value(&checksum);
    mspringi_writer to = mspringi_writer_begin(of->bytes + summed);
    mspringi_put(&to, &value, 1, sizeof value);
}

/// Whoever wants to do harm gets the checksum right. Whatever is in there: it is refused and nothing has changed,
/// or it is accepted and is a state like any other.
static void forge(mspring_solver kind) {
    const uint32_t words[] = {0,          1,          0x7fc00000 /* NaN */, 0x7f800000 /* infinity */, 0xff800000,
                              0x7f7fffff, 0xffffffff, 0x80000000,           0xbf800000 /* -1 */,       0x00000001};
    recipe made = small_recipe();
    mspring_network *network = small_network(&made);
    if (kind != MSPRING_SOLVER_EXPLICIT) {
        use_solver(network, kind, MSPRING_INTEGRATOR_BDF2, 7);
        check_ok(mspring_network_step(network, 0.01));
    }
    saved good = save(network, MSPRING_SNAPSHOT_ALL);
    saved bad = {malloc(good.size), good.size};
    assert_non_null(bad.bytes);
    const uint64_t before = look_at(network);
    uint32_t accepted = 0, refused = 0;
    for (size_t at = 0; at + 4 <= good.size - MSPRINGI_SNAPSHOT_CHECKSUM_BYTES; at += 4) {
        for (size_t i = 0; i < COUNT_OF(words); i++) {
            memcpy(bad.bytes, good.bytes, good.size);
            memcpy(bad.bytes + at, &words[i], sizeof words[i]);
            renew_checksum(&bad);
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
            load(network, &good);
        }
        if (at % 256 == 0) {
            assert_int_equal(look_at(network), before);
        }
    }
    assert_true(accepted > 100 && refused > 1000);
    assert_int_equal(look_at(network), before);
    mspring_network_destroy(network);
    free(good.bytes);
    free(bad.bytes);
    recipe_free(&made);
}

static void forgeries_do_no_harm(void **state) {
    (void)state;
    forge(MSPRING_SOLVER_EXPLICIT);
    forge(MSPRING_SOLVER_IMPLICIT);
    forge(MSPRING_SOLVER_DIRECT);
}

/// Where a section's bytes are.
static uint8_t *section_of(const saved *of, const char *tag, uint64_t *size) {
    uint8_t *at = of->bytes + MSPRINGI_SNAPSHOT_HEADER_BYTES;
    for (;;) {
        mspringi_get(at + 8, size, 1, sizeof *size);
        at += MSPRINGI_SECTION_HEADER_BYTES;
        if (memcmp(at - MSPRINGI_SECTION_HEADER_BYTES, tag, 4) == 0) {
            return at;
        }
        at += mspringi_round_up((size_t)*size, 8);
    }
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
        saved forged = save(network, MSPRING_SNAPSHOT_ALL);
        uint64_t size;
        uint8_t *growth = section_of(&forged, "grow", &size), *motion = section_of(&forged, "moti", &size);
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
        renew_checksum(&forged);
        check_error(mspring_network_load(network, forged.bytes, forged.size), MSPRING_ERROR_SNAPSHOT);
        check_contains(mspring_network_error(network), "positions and velocities");
        check_near(support_position(network, particles - 1).y, 20, 0);
        free(forged.bytes);
        mspring_network_destroy(network);
    }
}

/// What was saved when nothing had been removed brings back what was removed since.
static void what_was_removed_comes_back(void **state) {
    (void)state;
    recipe made = small_recipe();
    mspring_network *network = make(&made, MSPRING_SIMD_AUTO, 1), *other = NULL;
    support_steps(network, 3, 0.01);
    saved before = save(network, MSPRING_SNAPSHOT_ALL);
    check_ok(mspring_network_clone(network, NULL, &other));
    const mspring_id particles[] = {2, made.particle_count - 1}, springs[] = {0, made.spring_count - 1};
    check_ok(mspring_network_remove_particles(network, particles, 2));
    for (size_t i = 0; i < COUNT_OF(springs); i++) {
        if (mspring_network_has_spring(network, springs[i])) {
            check_ok(mspring_network_remove_springs(network, &springs[i], 1));
        }
    }
    support_steps(network, 3, 0.01);
    load(network, &before);
    assert_int_equal(mspring_network_has_particle(network, 2), 1);
    for (int step = 0; step < 5; step++) {
        assert_int_equal(look_at(network), look_at(other));
        support_steps(network, 1, 0.01);
        support_steps(other, 1, 0.01);
    }
    free(before.bytes);
    mspring_network_destroy(network);
    mspring_network_destroy(other);
    recipe_free(&made);
}

/// A plan that has left out what was removed cannot bring it back, so it does not take a snapshot that says nothing
/// of what was removed.
static void what_a_plan_leaves_out_stays_out(void **state) {
    (void)state;
    mspring_network *network = make_compact(0, false);
    saved forged = save(network, MSPRING_SNAPSHOT_ALL);
    mspringi_snapshot_header header;
    uint64_t size;
    uint8_t *growth = section_of(&forged, "grow", &size);
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
    renew_checksum(&forged);
    check_error(mspring_network_load(network, forged.bytes, forged.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(network), "particle 0 is there, which the plan leaves out");
    free(forged.bytes);
    mspring_network_destroy(network);
}

static void foreign_snapshots_are_refused(void **state) {
    (void)state;
    recipe made = small_recipe(), other_made = recipe_mixed(3), turned_made = small_recipe();
    turned_made.springs[4].b = turned_made.springs[4].b == 10 ? 11 : 10;
    turned_made.springs[4].rest_length = 1.5f;
    mspring_network *network = small_network(&made);
    mspring_network *other = make(&other_made, MSPRING_SIMD_AUTO, 1);
    mspring_network *turned = make(&turned_made, MSPRING_SIMD_AUTO, 1);
    saved of_other = save(other, MSPRING_SNAPSHOT_ALL), of_turned = save(turned, MSPRING_SNAPSHOT_ALL);
    const uint64_t before = look_at(network);
    check_error(mspring_network_load(network, of_other.bytes, of_other.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(network), "particles");
    check_error(mspring_network_load(network, of_turned.bytes, of_turned.size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(network), "another network");
    check_error(mspring_network_load(network, "These are some bytes that are no snapshot, by any means at all", 63),
                MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(network), "something else");
    assert_int_equal(look_at(network), before);

    // A frame does not survive an edit of what it leaves out; everything does.
    saved frame = save(network, MSPRING_SNAPSHOT_FRAME), all = save(network, MSPRING_SNAPSHOT_ALL);
    const float stiffness = 60;
    check_ok(mspring_network_set_stiffnesses(network, 1, 1, &stiffness));
    const uint64_t edited = look_at(network);
    check_error(mspring_network_load(network, frame.bytes, frame.size), MSPRING_ERROR_SNAPSHOT);
    assert_int_equal(look_at(network), edited);
    load(network, &all);
    assert_int_equal(look_at(network), before);
    load(network, &frame);
    assert_int_equal(look_at(network), before);
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
    recipe made = small_recipe();
    mspring_network *network = small_network(&made);
    saved good = save(network, MSPRING_SNAPSHOT_ALL);
    const uint64_t before = look_at(network);
    const uint32_t others[] = {0, MSPRINGI_SNAPSHOT_VERSION - 1, MSPRINGI_SNAPSHOT_VERSION + 1, UINT32_MAX};
    for (size_t i = 0; i < COUNT_OF(others); i++) {
        saved other = {malloc(good.size), good.size};
        char expected[80];
        assert_non_null(other.bytes);
        memcpy(other.bytes, good.bytes, good.size);
        mspringi_writer to = mspringi_writer_begin(other.bytes + 8); // behind the magic
        mspringi_put(&to, &others[i], 1, sizeof others[i]);
        renew_checksum(&other);
        check_error(mspring_network_load(network, other.bytes, other.size), MSPRING_ERROR_SNAPSHOT);
        snprintf(expected, sizeof expected, "version %u, this library knows version %u", (unsigned)others[i],
                 (unsigned)MSPRINGI_SNAPSHOT_VERSION);
        check_contains(mspring_network_error(network), expected);
        assert_int_equal(look_at(network), before);
        free(other.bytes);
    }
    mspring_network_destroy(network);
    free(good.bytes);
    recipe_free(&made);
}

// Sections and their bytes, or bytes per slot.
static void describe(const mspring_network *network, char *text, size_t room) {
    mspring_plan plan = {.struct_size = sizeof plan};
    saved of = save(network, MSPRING_SNAPSHOT_ALL);
    check_ok(mspring_network_plan(network, &plan));
    mspringi_snapshot_header header;
    assert_true(mspringi_get_header(of.bytes, &header));
    const uint8_t *at = of.bytes + MSPRINGI_SNAPSHOT_HEADER_BYTES;
    size_t length = (size_t)snprintf(text, room, "%u:", (unsigned)header.version);
    for (uint32_t i = 0; i < header.section_count; i++) {
        uint64_t size;
        mspringi_get(at + 8, &size, 1, sizeof size);
        assert_true(length < room);
        const bool by_slot = size % plan.slot_count == 0;
        length += (size_t)snprintf(text + length, room - length, " %.4s %u%s", (const char *)at,
                                   (unsigned)(by_slot ? size / plan.slot_count : size), by_slot ? "/slot" : "");
        at += MSPRINGI_SECTION_HEADER_BYTES + mspringi_round_up((size_t)size, 8);
    }
    free(of.bytes);
}

/// What is in a snapshot of a single spring, with all that there can be. Where this changes, so does the version.
static void a_version_has_one_format(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id a = support_pinned(builder, 0, 0, 1), b = support_particle(builder, 1, 0, 1);
    support_spring(builder, a, b, 100, 1);
    mspring_network_def def = support_def(-9.8f, 4);
    def.guard = MSPRING_GUARD_IMPLICIT;
    def.spare_particles = def.spare_springs = 1;
    def.flags = MSPRING_NETWORK_RESERVE_RELATIVE;
    def.sleep_speed = 0.1f;
    mspring_network *network = support_network(builder, &def);
    const float strain = 1, scale = 0.5f;
    const mspring_id spring = 0;
    check_ok(mspring_network_set_break_strains(network, 0, 1, &strain));
    check_ok(mspring_network_set_stress_strains(network, 0, 1, &strain));
    check_ok(mspring_network_set_inverse_mass_scales(network, b, 1, &scale));
    check_ok(mspring_network_break_springs(network, &spring, 1));
    check_ok(mspring_network_restore_springs(network, &spring, 1, 9));
    check_ok(mspring_network_apply_force(network, b, 1, 2));
    char text[400];
    describe(network, text, sizeof text);
    assert_string_equal(text, "3: grow 23 sett 56 moti 16/slot mass 28 forc 8/slot brok 4 valu 24 brks 8 strs 8 "
                              "stsd 4 ramp 32 slee 20 guar 56");
    use_solver(network, MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, 1);
    check_ok(mspring_network_step(network, 0.01));
    describe(network, text, sizeof text);
    assert_string_equal(text, "3: grow 23 sett 56 moti 16/slot mass 28 brok 4 valu 24 brks 8 strs 8 stsd 4 ramp 32 "
                              "slee 20 impl 2004 guar 56");
    mspring_network_destroy(network);
}

static void bad_arguments_are_refused(void **state) {
    (void)state;
    recipe made = small_recipe();
    mspring_network *network = small_network(&made);
    size_t size = 4711, room;
    uint8_t bytes[64];
    check_ok(mspring_network_snapshot_size(network, MSPRING_SNAPSHOT_FRAME, &room));
    check_error(mspring_network_snapshot_size(NULL, MSPRING_SNAPSHOT_ALL, &size), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_snapshot_size(network, 2, &size), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_snapshot_size(network, -1, &size), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_snapshot_size(network, MSPRING_SNAPSHOT_ALL, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_save(NULL, MSPRING_SNAPSHOT_ALL, bytes, sizeof bytes, &size),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, NULL, room, &size), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, bytes, sizeof bytes, &size),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_load(NULL, bytes, sizeof bytes), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_load(network, NULL, 100), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "NULL");
    assert_int_equal(size, 4711);
    uint8_t *enough = malloc(room);
    assert_non_null(enough);
    check_error(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, enough, room - 1, &size),
                MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, enough, room, NULL));
    free(enough);
    mspring_network_destroy(network);
    recipe_free(&made);
}

typedef struct caller {
    mspring_network *network;
    saved snapshot;
    int calls;
} caller;

static void call_from_inside(const mspring_hook_args *args, void *user) {
    caller *inside = user;
    size_t size = 0;
    (void)args;
    inside->calls++;
    check_error(mspring_network_snapshot_size(inside->network, MSPRING_SNAPSHOT_ALL, &size), MSPRING_ERROR_BUSY);
    check_error(mspring_network_save(inside->network, MSPRING_SNAPSHOT_ALL, inside->snapshot.bytes,
                                     inside->snapshot.size, &size),
                MSPRING_ERROR_BUSY);
    check_error(mspring_network_load(inside->network, inside->snapshot.bytes, inside->snapshot.size),
                MSPRING_ERROR_BUSY);
}

static void hooks_can_neither_save_nor_load(void **state) {
    (void)state;
    recipe made = small_recipe();
    mspring_network *network = small_network(&made);
    caller inside = {.network = network, .snapshot = save(network, MSPRING_SNAPSHOT_ALL)};
    check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, call_from_inside, &inside, NULL));
    check_ok(mspring_network_step(network, 0.01));
    assert_true(inside.calls > 0);
    free(inside.snapshot.bytes);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void loading_survives_every_failure(void **state) {
    (void)state;
    recipe made = small_recipe();
    mspring_network *old = small_network(&made);
    saved all = save(old, MSPRING_SNAPSHOT_ALL);
    const uint64_t expected = look_at(old);
    mspring_result result = MSPRING_ERROR_MEMORY;
    size_t fail_at = 0;
    while (result != MSPRING_OK) {
        watched_allocator watched = {0};
        const mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def def = support_def(-9.8f, 4);
        def.allocator = &allocator;
        mspring_network *network = recipe_network(&made, &def);
        const uint64_t before = look_at(network);
        watched.fail_at = watched.calls + ++fail_at;
        result = mspring_network_load(network, all.bytes, all.size);
        if (result == MSPRING_OK) {
            assert_int_equal(look_at(network), expected);
        } else {
            check_error(result, MSPRING_ERROR_MEMORY);
            check_contains(mspring_network_error(network), "memory");
            assert_int_equal(look_at(network), before);
            check_ok(mspring_network_step(network, 0.01));
        }
        mspring_network_destroy(network);
        check_watched_clean(&watched);
    }
    assert_true(fail_at > 5);
    mspring_network_destroy(old);
    free(all.bytes);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rollback_gives_the_same_bits),
        cmocka_unit_test(a_rollback_of_the_implicit_solvers_gives_the_same_bits),
        cmocka_unit_test(an_old_network_goes_on_like_a_young_one),
        cmocka_unit_test(solvers_have_to_be_alike),
        cmocka_unit_test(snapshots_are_the_same_everywhere),
        cmocka_unit_test(all_goes_into_a_new_network),
        cmocka_unit_test(damage_is_found),
        cmocka_unit_test(forgeries_do_no_harm),
        cmocka_unit_test(what_hides_in_other_slots_is_refused),
        cmocka_unit_test(what_was_removed_comes_back),
        cmocka_unit_test(what_a_plan_leaves_out_stays_out),
        cmocka_unit_test(foreign_snapshots_are_refused),
        cmocka_unit_test(other_versions_say_so),
        cmocka_unit_test(a_version_has_one_format),
        cmocka_unit_test(bad_arguments_are_refused),
        cmocka_unit_test(hooks_can_neither_save_nor_load),
        cmocka_unit_test(loading_survives_every_failure),
    };
    return cmocka_run_group_tests_name("snapshot", tests, NULL, NULL);
}

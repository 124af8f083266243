/// @file test_compact.c
/// Compaction: nothing is to be seen of it but cost and slots, and it can be undone.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "look.h"
#include "recipe.h"
#include "support.h"

enum { SEVERAL_FRAMES = 12 };

/// Rows of every kind, springs of both kinds, dampers.
static recipe mixed_recipe(void) {
    uint64_t seed = 5;
    const recipe_stuff relative = {.mass = {1, 2},
                                   .stiffness = {0.1, 0.2},
                                   .damping = {0, 0.05},
                                   .spring_flags = MSPRING_SPRING_RELATIVE,
                                   .pinned = 0.02,
                                   .holes = 0.1};
    const recipe_stuff absolute = {.mass = {1, 2}, .stiffness = {50, 100}, .damping = {0, 1}};
    recipe made = {0};
    recipe_lattice(&made, 45, 14, 0, 0, 1, &relative, &seed);
    const mspring_id other = recipe_lattice(&made, 9, 30, 60, 0.5, 1, &absolute, &seed);
    recipe_rope(&made, 2, other, 20, &absolute, &seed);
    recipe_random_springs(&made, 25, &absolute, &seed);
    recipe_particle(&made, 5, 40, 1, 0);
    recipe_disturb(&made, 0.05, 0.5, &seed);
    return made;
}

static mspring_network *make(const recipe *made, mspring_simd level, uint32_t worker_count) {
    mspring_network_def def = support_def(-9.8f, 4);
    def.simd_level = level;
    def.worker_count = worker_count;
    def.global_damping = 0.1f;
    return recipe_network(made, &def);
}

typedef enum wreck { SHATTERED, TORN, DISSOLVED, WRECKS } wreck;

/// Whether a spring breaks in a wreck: nine of ten anywhere, whatever crosses one of some lines, all.
static bool breaks(const recipe *made, wreck kind, mspring_id s) {
    const mspring_particle_def *a = &made->particles[made->springs[s].a], *b = &made->particles[made->springs[s].b];
    uint64_t seed = s;
    if (kind == SHATTERED) {
        return support_random(&seed) % 10 != 0;
    }
    return kind == DISSOLVED || floor(a->x / 11) != floor(b->x / 11) || fmod(a->y, 16) > 12;
}

static void make_wreck(mspring_network *network, const recipe *made, wreck kind) {
    for (mspring_id s = 0; s < made->spring_count; s++) {
        if (breaks(made, kind, s)) {
            check_ok(mspring_network_break_springs(network, &s, 1));
        }
    }
}

static void compact(mspring_network *network) {
    check_ok(mspring_network_compact(network));
}

static mspring_plan plan_of(const mspring_network *network) {
    mspring_plan plan = {.struct_size = sizeof plan};
    check_ok(mspring_network_plan(network, &plan));
    return plan;
}

/// Springs that a step sweeps.
static uint32_t swept(const mspring_network *network) {
    const mspring_plan plan = plan_of(network);
    return plan.lattice_springs + plan.chain_springs + plan.leftover_springs;
}

static uint32_t live_count(const mspring_network *network) {
    uint32_t count = 0;
    for (mspring_id s = 0; s < mspring_network_spring_count(network); s++) {
        mspring_spring_info info = {.struct_size = sizeof info};
        check_ok(mspring_network_get_spring(network, s, &info));
        count += !(info.flags & MSPRING_SPRING_BROKEN);
    }
    return count;
}

static void set_solver(mspring_network *network, mspring_solver which, mspring_integrator integrator) {
    mspring_solver_def solver;
    check_ok(mspring_solver_def_init(&solver, sizeof solver));
    solver.solver = which;
    solver.integrator = integrator;
    solver.substeps = 2;
    solver.iterations = 60;
    check_ok(mspring_network_set_solver(network, &solver));
}

/* -------------------------------------------------------------------------------------- what is to be seen */

static void nothing_changes_but_the_plan(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    for (wreck kind = 0; kind < WRECKS; kind++) {
        mspring_network *network = make(&made, MSPRING_SIMD_AUTO, 1);
        const float scale = 0.5f;
        check_ok(mspring_network_set_inverse_mass_scales(network, 7, 1, &scale));
        support_steps(network, 2, 1.0 / 64);
        make_wreck(network, &made, kind);
        const uint32_t before = swept(network);
        const look seen = look_at(network);
        compact(network);
        check_same_look(seen, look_at(network), network);
        assert_int_equal(swept(network), live_count(network));
        assert_true(before > live_count(network));
        // Nothing more to do, and no slot changes by that.
        mspring_view view = {.struct_size = sizeof view}, again = {.struct_size = sizeof again};
        check_ok(mspring_network_view(network, &view));
        compact(network);
        check_ok(mspring_network_view(network, &again));
        assert_ptr_equal(view.x, again.x);
        const look then = look_at(network);
        check_ok(mspring_network_expand(network));
        check_same_look(then, look_at(network), network);
        assert_int_equal(swept(network), before);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

/// The plan is the one that a network of the springs that are left is created with.
static void plans_are_those_of_what_is_left(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    for (wreck kind = 0; kind < WRECKS; kind++) {
        mspring_network *network = make(&made, MSPRING_SIMD_AUTO, 1);
        recipe left = made;
        left.springs = look_array(made.spring_count, sizeof *left.springs);
        left.spring_count = 0;
        for (mspring_id s = 0; s < made.spring_count; s++) {
            if (!breaks(&made, kind, s)) {
                left.springs[left.spring_count++] = made.springs[s];
            }
        }
        mspring_network *fresh = make(&left, MSPRING_SIMD_AUTO, 1);
        make_wreck(network, &made, kind);
        compact(network);
        const mspring_plan a = plan_of(network), b = plan_of(fresh);
        assert_int_equal(a.lattice_particles, b.lattice_particles);
        assert_int_equal(a.lattice_springs, b.lattice_springs);
        assert_int_equal(a.lattice_blocks, b.lattice_blocks);
        assert_int_equal(a.chain_particles, b.chain_particles);
        assert_int_equal(a.web_particles, b.web_particles);
        assert_int_equal(a.leftover_springs, b.leftover_springs);
        assert_int_equal(a.loose_particles, b.loose_particles);
        free(left.springs);
        mspring_network_destroy(network);
        mspring_network_destroy(fresh);
    }
    recipe_free(&made);
}

/* ------------------------------------------------------------------------------------------------- stepping */

static void push(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        args->force_x[slot] += 2 + args->y[slot] * 0.01f;
    }
}

static void add_pushing_hook(mspring_network *network) {
    mspring_hook_def hook;
    check_ok(mspring_hook_def_init(&hook, sizeof hook));
    hook.phase = MSPRING_PHASE_BEFORE_SUBSTEP;
    hook.fn = push;
    hook.period = 2;
    hook.flags = MSPRING_HOOK_CONCURRENT;
    check_ok(mspring_network_add_hook(network, &hook, NULL));
}

/// How the runs differ: one solver or another, with hooks or not.
enum { RUNS = 6 };

static void set_up_run(mspring_network *network, int run) {
    const double plane[4] = {0, -2, 0, 1};
    mspring_floor_def def;
    check_ok(mspring_floor_def_init(&def, sizeof def));
    def.planes = plane;
    def.plane_count = 1;
    def.friction = 0.3f;
    check_ok(mspring_network_set_floor(network, &def));
    if (run % 2 == 1) {
        add_pushing_hook(network);
    }
    if (run >= 2) {
        set_solver(network, run < 5 ? MSPRING_SOLVER_IMPLICIT : MSPRING_SOLVER_DIRECT,
                   run % 3 == 0   ? MSPRING_INTEGRATOR_BDF2
                   : run % 3 == 1 ? MSPRING_INTEGRATOR_EULER
                                  : MSPRING_INTEGRATOR_GA0);
    }
}

static double largest_difference(const mspring_network *a, const mspring_network *b) {
    double largest = 0;
    for (mspring_id p = 0; p < mspring_network_particle_count(a); p++) {
        const support_point pa = support_position(a, p), pb = support_position(b, p);
        largest = fmax(largest, hypot(pa.x - pb.x, pa.y - pb.y));
    }
    return largest;
}

/// A compact network moves as one that is not, but for rounding (and, if implicit, for tiles, which converge from
/// other sides): some 1e-7 of coordinates of 60 m in each of 40 to 80 substeps, and motion that goes on from there.
/// With an implicit solver, what has lost all its springs flies along parabolas and bounces where it meets the
/// floor once it is in a row of its own. Before, implicit Euler takes it g h^2 / 2 = 1.2 mm off that in a substep,
/// and it comes to lie on the floor at the end of one: at some 5 m/s, up to 0.1 m elsewhere.
static void motion_goes_on(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    for (int run = 0; run < RUNS; run++) {
        for (wreck kind = 0; kind < WRECKS; kind++) {
            mspring_network *network = make(&made, MSPRING_SIMD_AUTO, 1);
            set_up_run(network, run);
            support_steps(network, 3, 1.0 / 64);
            make_wreck(network, &made, kind);
            support_steps(network, 1, 1.0 / 64);
            mspring_network *compacted = make(&made, MSPRING_SIMD_AUTO, 1);
            set_up_run(compacted, run);
            support_steps(compacted, 3, 1.0 / 64);
            make_wreck(compacted, &made, kind);
            support_steps(compacted, 1, 1.0 / 64);
            assert_int_equal(support_hash(network), support_hash(compacted));
            check_ok(mspring_network_apply_force(network, 40, 300, 100));
            check_ok(mspring_network_apply_force(compacted, 40, 300, 100));
            compact(compacted);
            support_steps(network, 20, 1.0 / 64);
            support_steps(compacted, 20, 1.0 / 64);
            check_near(largest_difference(network, compacted), 0, run < 2 ? 1e-3 : 0.1);
            mspring_network_destroy(network);
            mspring_network_destroy(compacted);
        }
    }
    recipe_free(&made);
}

/// Forth and back between two steps is as if nothing had been, bit for bit.
static void expanding_undoes_compacting(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    for (int run = 0; run < RUNS; run++) {
        uint64_t hashes[2];
        for (int there = 0; there < 2; there++) {
            mspring_network *network = make(&made, MSPRING_SIMD_AUTO, 1);
            set_up_run(network, run);
            support_steps(network, 3, 1.0 / 64);
            make_wreck(network, &made, TORN);
            support_steps(network, 3, 1.0 / 64);
            check_ok(mspring_network_apply_force(network, 40, 300, 100));
            if (there) {
                compact(network);
                check_ok(mspring_network_expand(network));
            }
            support_steps(network, 5, 1.0 / 64);
            hashes[there] = support_hash(network);
            mspring_network_destroy(network);
        }
        assert_int_equal(hashes[0], hashes[1]);
    }
    recipe_free(&made);
}

/* -------------------------------------------------------------------------------------------- the same bits */

/// A session in which springs break and are restored while the network is compacted piece by piece.
static uint64_t session_hash(const recipe *made, mspring_simd level, uint32_t workers, int run) {
    mspring_network *network = make(made, level, workers);
    set_up_run(network, run);
    mspring_job *job = NULL;
    for (uint32_t frame = 0; frame < SEVERAL_FRAMES; frame++) {
        if (frame == 1) {
            make_wreck(network, made, TORN);
        }
        if (frame == 9) {
            make_wreck(network, made, SHATTERED);
        }
        const mspring_id some[] = {frame * 31 % made->spring_count, frame * 57 % made->spring_count};
        check_ok(mspring_network_break_springs(network, some, 2));
        if (frame == 3 || frame == 7) { // once while it is under way, once when it is done
            check_ok(mspring_network_restore_springs(network, some, 2, 0.1));
        }
        support_compact(network, frame < 6 ? 30 : 0, &job);
        support_steps(network, 2, 1.0 / 64);
    }
    assert_null(job);
    const uint64_t hash = support_hash(network);
    mspring_network_destroy(network);
    return hash;
}

static void bits_are_the_same_everywhere(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t level_count = support_levels(levels);
    for (int run = 0; run < RUNS; run += run < 2 ? 1 : 3) {
        const uint64_t expected = session_hash(&made, MSPRING_SIMD_SCALAR, 1, run);
        for (uint32_t i = 0; i < level_count; i++) {
            assert_int_equal(session_hash(&made, levels[i], 1, run), expected);
        }
        assert_int_equal(session_hash(&made, MSPRING_SIMD_AUTO, 3, run), expected);
    }
    recipe_free(&made);
}

/* ---------------------------------------------------------------------------------------------- pieces, edits */

typedef struct saved {
    uint8_t *bytes;
    size_t size;
} saved;

static saved save(const mspring_network *network) {
    saved out;
    check_ok(mspring_network_snapshot_size(network, MSPRING_SNAPSHOT_ALL, &out.size));
    out.bytes = look_array(out.size, 1);
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, out.bytes, out.size, NULL));
    return out;
}

static void work_is_done_in_pieces(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    mspring_network *network = make(&made, MSPRING_SIMD_AUTO, 1), *at_once = make(&made, MSPRING_SIMD_AUTO, 1);
    make_wreck(network, &made, TORN);
    make_wreck(at_once, &made, TORN);
    const uint32_t before = swept(network);
    uint32_t left = 100, functions = 0;
    mspring_job *job;
    check_ok(mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &job));
    for (; left > 0; functions++) {
        const uint32_t left_before = left;
        check_ok(mspring_job_run(job, 1, &left));
        assert_true(left <= left_before);
    }
    assert_int_equal(swept(network), before);
    assert_true(functions > 50);
    check_ok(mspring_job_finish(network, job));
    mspring_job_destroy(job);
    assert_true(swept(network) < before);
    compact(at_once);
    support_steps(network, 5, 1.0 / 64);
    support_steps(at_once, 5, 1.0 / 64);
    assert_int_equal(support_hash(network), support_hash(at_once));
    mspring_network_destroy(network);
    mspring_network_destroy(at_once);
    recipe_free(&made);
}

/// A wreck so large that copying its springs takes many pieces.
static recipe large_recipe(void) {
    uint64_t seed = 8;
    const recipe_stuff stuff = {.mass = {1, 2},
                                .stiffness = {0.1, 0.2},
                                .damping = {0, 0.05},
                                .spring_flags = MSPRING_SPRING_RELATIVE,
                                .holes = 0.05};
    const recipe_stuff absolute = {.mass = {1, 2}, .stiffness = {50, 100}, .damping = {0, 1}};
    recipe made = {0};
    const mspring_id first = recipe_lattice(&made, 150, 50, 0, 0, 1, &stuff, &seed);
    recipe_rope(&made, first, first + 900, 30, &absolute, &seed);
    recipe_random_springs(&made, 100, &absolute, &seed);
    recipe_disturb(&made, 0.02, 0.2, &seed);
    return made;
}

/// Change some springs in one way or another, in both networks alike.
static void change_something(mspring_network *const both[2], uint64_t *seed, saved *kept) {
    const uint32_t springs = mspring_network_spring_count(both[0]);
    const uint32_t what = (uint32_t)(support_random(seed) % 10);
    mspring_id list[20];
    float values[20];
    for (int i = 0; i < 20; i++) {
        list[i] = (mspring_id)(support_random(seed) % springs);
        values[i] = 0.05f + 0.001f * (float)(support_random(seed) % 100);
    }
    for (int i = 0; i < 2; i++) {
        mspring_network *n = both[i];
        switch (what) {
        case 0:
            check_ok(mspring_network_set_stiffnesses_at(n, list, 20, values));
            break;
        case 1:
            check_ok(mspring_network_set_dampings_at(n, list, 20, values));
            break;
        case 2: // from the first on, rest lengths are not shared any more
            for (int j = 0; j < 20 && i == 0; j++) {
                values[j] += 0.9f;
            }
            check_ok(mspring_network_set_rest_lengths_at(n, list, 20, values));
            break;
        case 3: // likewise thresholds
            for (int j = 0; j < 20 && i == 0; j++) {
                values[j] += 5;
            }
            check_ok(mspring_network_set_break_strains_at(n, list, 20, values));
            break;
        case 4:
            check_ok(mspring_network_set_stress_strains_at(n, list, 20, values));
            break;
        case 5: // at once, so that none of them is one that was broken before
            check_ok(mspring_network_break_springs(n, list, 20));
            check_ok(mspring_network_restore_springs(n, list + 10, 1, 0.05));
            break;
        case 6:
            check_ok(mspring_network_break_springs(n, list, 20));
            break;
        case 7: // another substep: all relative springs are derived anew
            support_steps(n, 1, 1.0 / (64 + values[0]));
            break;
        case 8:
            if (kept->bytes) {
                check_ok(mspring_network_load(n, kept->bytes, kept->size));
            }
            break;
        default:
            support_steps(n, 1, 1.0 / 64);
            break;
        }
    }
}

/// Whatever happens to springs while they are copied, piece by piece, they are what they would be without.
static void nothing_that_happens_meanwhile_is_lost(void **state) {
    (void)state;
    recipe made = large_recipe();
    for (uint64_t life = 0; life < 4; life++) {
        uint64_t seed = 40 + life;
        mspring_network *const both[2] = {make(&made, MSPRING_SIMD_AUTO, 1), make(&made, MSPRING_SIMD_AUTO, 1)};
        saved kept = {NULL, 0};
        for (int i = 0; i < 2; i++) {
            support_steps(both[i], 1, 1.0 / 64);
            make_wreck(both[i], &made, life % 2 == 0 ? TORN : SHATTERED);
        }
        mspring_job *job = NULL;
        uint32_t pieces = 0;
        for (; pieces == 0 || (job && pieces < 400); pieces++) {
            if (pieces == 20 && life >= 2) {
                kept = save(both[0]);
            }
            if (pieces < 200) { // and then in peace
                change_something(both, &seed, &kept);
            }
            support_compact(both[0], 1, &job);
        }
        assert_null(job);
        assert_true(pieces > 20);
        check_same_look(look_at(both[0]), look_at(both[1]), both[0]);
        free(kept.bytes);
        mspring_network_destroy(both[0]);
        mspring_network_destroy(both[1]);
    }
    recipe_free(&made);
}

static void springs_that_are_left_out_can_be_edited_and_restored(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    for (int run = 0; run < RUNS; run++) {
        mspring_network *network = make(&made, MSPRING_SIMD_AUTO, 1), *plain = make(&made, MSPRING_SIMD_AUTO, 1);
        mspring_network *const both[] = {network, plain};
        for (int i = 0; i < 2; i++) {
            set_up_run(both[i], run);
            support_steps(both[i], 2, 1.0 / 64);
            make_wreck(both[i], &made, DISSOLVED);
            if (i == 0) {
                compact(network);
                assert_int_equal(swept(network), 0);
            }
            const mspring_id id = 17;
            const float stiffness = 0.07f, rest_length = 1.1f, damping = 0.02f;
            check_ok(mspring_network_set_stiffnesses_at(both[i], &id, 1, &stiffness));
            check_ok(mspring_network_set_dampings_at(both[i], &id, 1, &damping));
            check_ok(mspring_network_set_rest_lengths_at(both[i], &id, 1, &rest_length));
            const mspring_id back[] = {id, 18, 300, 4};
            check_ok(mspring_network_restore_springs(both[i], back, 4, 0.2));
            support_steps(both[i], 5, 1.0 / 64);
        }
        // No step was made in between, so there is no difference of rounding either.
        assert_int_equal(swept(network), swept(plain));
        check_same_look(look_at(network), look_at(plain), network);
        mspring_network_destroy(network);
        mspring_network_destroy(plain);
    }
    recipe_free(&made);
}

static void strains_are_watched_as_before(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    mspring_event events[2][64];
    uint32_t counts[2];
    float *strain = look_array(made.spring_count, sizeof *strain);
    for (mspring_id s = 0; s < made.spring_count; s++) {
        strain[s] = 0.02f + 0.01f * (float)(s % 5);
    }
    for (int compacted = 0; compacted < 2; compacted++) {
        mspring_network *network = make(&made, MSPRING_SIMD_AUTO, 1);
        check_ok(mspring_network_set_stress_strains(network, 0, made.spring_count, strain));
        for (mspring_id s = 0; s < made.spring_count; s++) {
            strain[s] *= 2;
        }
        check_ok(mspring_network_set_break_strains(network, 0, made.spring_count, strain));
        for (mspring_id s = 0; s < made.spring_count; s++) {
            strain[s] /= 2;
        }
        support_steps(network, 1, 1.0 / 64);
        make_wreck(network, &made, SHATTERED);
        if (compacted) {
            compact(network);
        }
        check_ok(mspring_network_reserve_events(network, 64));
        support_steps(network, 1, 1.0 / 64);
        check_ok(mspring_network_read_events(network, events[compacted], 64, &counts[compacted], NULL));
        mspring_network_destroy(network);
    }
    // In the order of the plan, so each is looked for.
    assert_int_equal(counts[0], counts[1]);
    assert_in_range(counts[0], 4, 63);
    for (uint32_t i = 0; i < counts[0]; i++) {
        bool found = false;
        for (uint32_t j = 0; j < counts[1]; j++) {
            found = found || (events[1][j].id == events[0][i].id && events[1][j].kind == events[0][i].kind &&
                              fabsf(events[1][j].strain - events[0][i].strain) < 1e-4f);
        }
        assert_true(found);
    }
    free(strain);
    recipe_free(&made);
}

/* -------------------------------------------------------------------------------------------------- snapshots */

static void snapshots_are_of_one_plan(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    for (int run = 0; run < RUNS; run++) {
        mspring_network *network = make(&made, MSPRING_SIMD_AUTO, 1);
        set_up_run(network, run);
        support_steps(network, 2, 1.0 / 64);
        make_wreck(network, &made, TORN);
        saved whole = save(network);
        support_steps(network, 4, 1.0 / 64);
        const uint64_t from_whole = support_hash(network);
        compact(network);
        support_steps(network, 1, 1.0 / 64);
        saved compacted = save(network);
        support_steps(network, 4, 1.0 / 64);
        const uint64_t from_compacted = support_hash(network);

        check_error(mspring_network_load(network, whole.bytes, whole.size), MSPRING_ERROR_SNAPSHOT);
        assert_int_equal(support_hash(network), from_compacted);
        check_ok(mspring_network_load(network, compacted.bytes, compacted.size));
        support_steps(network, 4, 1.0 / 64);
        assert_int_equal(support_hash(network), from_compacted);

        check_ok(mspring_network_expand(network));
        check_error(mspring_network_load(network, compacted.bytes, compacted.size), MSPRING_ERROR_SNAPSHOT);
        check_ok(mspring_network_load(network, whole.bytes, whole.size));
        support_steps(network, 4, 1.0 / 64);
        assert_int_equal(support_hash(network), from_whole);
        free(whole.bytes);
        free(compacted.bytes);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

/// The solver that takes steps for the explicit one is as it was made, too: it goes by the first rest lengths.
static void steps_taken_for_the_explicit_solver_stay_the_same(void **state) {
    (void)state;
    uint64_t seed = 5;
    const recipe_stuff stiff = {.mass = {1, 1}, .stiffness = {1e7, 1e7}, .damping = {20, 20}};
    recipe made = {0};
    recipe_lattice(&made, 24, 8, 0, 0, 1, &stiff, &seed);
    mspring_network_def def = support_def(-9.8f, 1);
    def.guard = MSPRING_GUARD_IMPLICIT;
    mspring_network *network = recipe_network(&made, &def);
    const mspring_id some = 100;
    check_ok(mspring_network_break_springs(network, &some, 1));
    check_ok(mspring_network_restore_springs(network, &some, 1, 0));
    recipe_disturb(&made, 0.05, 0.5, &seed);
    for (mspring_id p = 0; p < made.particle_count; p++) {
        const mspring_particle_def *particle = &made.particles[p];
        check_ok(mspring_network_set_positions(network, p, 1, &particle->x, &particle->y));
    }
    size_t size;
    check_ok(mspring_network_snapshot_size(network, MSPRING_SNAPSHOT_ALL, &size));
    void *snapshot = malloc(size);
    assert_non_null(snapshot);
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, snapshot, size, NULL));
    support_steps(network, 5, 1.0 / 64);
    assert_true(mspring_network_fallback_count(network) > 0);
    const uint64_t hash = support_hash(network);
    for (mspring_id s = 0; s < made.spring_count; s++) {
        const float rest_length = 3;
        check_ok(mspring_network_set_rest_lengths(network, s, 1, &rest_length));
    }
    check_ok(mspring_network_break_springs(network, &some, 1));
    compact(network);
    check_ok(mspring_network_expand(network));
    check_ok(mspring_network_load(network, snapshot, size));
    support_steps(network, 5, 1.0 / 64);
    assert_int_equal(support_hash(network), hash);
    free(snapshot);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/* ----------------------------------------------------------------------------------------------------- clones */

static void clones_are_compact_too(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    for (uint32_t pieces = 1; pieces < 120; pieces += 12) {
        mspring_network *network = make(&made, MSPRING_SIMD_AUTO, 1), *clone = NULL;
        mspring_job *job = NULL;
        make_wreck(network, &made, TORN);
        support_compact(network, pieces, &job);
        check_ok(mspring_network_clone(network, NULL, &clone));
        assert_int_equal(swept(network), swept(clone));
        support_steps(network, 3, 1.0 / 64);
        support_steps(clone, 3, 1.0 / 64);
        assert_int_equal(support_hash(network), support_hash(clone));
        // What was under way is not cloned, so the clone begins anew; then it is at the same place.
        mspring_job_destroy(job);
        compact(network);
        mspring_network_destroy(network);
        compact(clone);
        check_ok(mspring_network_expand(clone));
        support_steps(clone, 3, 1.0 / 64);
        mspring_network_destroy(clone);
    }
    recipe_free(&made);
}

/* ----------------------------------------------------------------------------------------------------- errors */

/// A call that may be out of memory, with an allocator that fails once: then the network is as it was, and the call
/// can be made again.
static void check_survives(mspring_network *network, watched_allocator *watched, size_t fail_at,
                           mspring_result (*call)(mspring_network *), bool *failed) {
    const uint64_t hash = support_hash(network);
    const uint32_t before = swept(network);
    watched->fail_at = watched->calls + fail_at;
    mspring_result result = call(network);
    *failed = result != MSPRING_OK;
    watched->fail_at = 0;
    if (*failed) {
        check_error(result, MSPRING_ERROR_MEMORY);
        check_contains(mspring_network_error(network), "memory");
        assert_int_equal(support_hash(network), hash);
        assert_int_equal(swept(network), before);
        check_ok(call(network));
    }
    assert_int_equal(support_hash(network), hash);
}

static mspring_result compact_all(mspring_network *network) {
    return mspring_network_compact(network);
}

static void every_failure_leaves_the_network_as_it_was(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    float *strain = look_array(made.spring_count, sizeof *strain);
    for (mspring_id s = 0; s < made.spring_count; s++) {
        strain[s] = 10;
    }
    uint64_t expected = 0;
    bool failed = true;
    size_t fail_at = 1;
    for (; failed; fail_at++) {
        watched_allocator watched = {.fail_at = 0};
        mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def def = support_def(-9.8f, 4);
        def.allocator = &allocator;
        bool compacting_failed, expanding_failed;
        mspring_network *network = recipe_network(&made, &def);
        set_up_run(network, 3);
        check_ok(mspring_network_set_stress_strains(network, 0, made.spring_count, strain));
        check_ok(mspring_network_update_components(network, NULL, NULL));
        make_wreck(network, &made, TORN);
        support_steps(network, 1, 1.0 / 64);
        check_ok(mspring_network_apply_force(network, 3, 1, 2));
        check_survives(network, &watched, fail_at, compact_all, &compacting_failed);
        support_steps(network, 1, 1.0 / 64);
        check_survives(network, &watched, fail_at, mspring_network_expand, &expanding_failed);
        support_steps(network, 1, 1.0 / 64);
        expected = fail_at == 1 ? support_hash(network) : expected;
        assert_int_equal(support_hash(network), expected);
        mspring_network_destroy(network);
        check_watched_clean(&watched);
        failed = compacting_failed || expanding_failed;
    }
    assert_true(fail_at > 50); // topology, state, records, solver
    free(strain);
    recipe_free(&made);
}

/// A job is begun, run by some functions, and the network and it are destroyed in this order or the other; or the
/// layout changes meanwhile.
static void a_job_may_stay_unfinished(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    for (uint32_t functions = 1; functions < 120; functions += 7) {
        watched_allocator watched = {.fail_at = 0};
        mspring_allocator allocator = watched_interface(&watched);
        mspring_network_def def = support_def(-9.8f, 4);
        def.allocator = &allocator;
        mspring_network *network = recipe_network(&made, &def);
        mspring_job *job = NULL, *other = NULL;
        make_wreck(network, &made, TORN);
        check_ok(mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &job));
        check_error(mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &other), MSPRING_ERROR_BUSY);
        assert_null(other);
        check_error(mspring_job_finish(network, job), MSPRING_ERROR_BUSY);
        check_ok(mspring_job_run(job, functions, NULL));
        if (functions % 3 == 0) {
            compact(network);
            check_ok(mspring_job_run(job, 0, NULL));
            check_error(mspring_job_finish(network, job), MSPRING_ERROR_OUTDATED);
        }
        if (functions % 2 == 0) {
            mspring_job_destroy(job);
            check_ok(mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &job));
        }
        mspring_network_destroy(network);
        check_ok(mspring_job_run(job, 0, NULL)); // it owns all that it reads
        mspring_job_destroy(job);
        check_watched_clean(&watched);
    }
    recipe_free(&made);
}

/// The bits depend on when a job is begun and finished, not on how it is run; if nothing breaks in between they are
/// those of a compaction at the finish.
static void bits_depend_on_begin_and_finish_alone(void **state) {
    (void)state;
    static const uint32_t functions[] = {0, 1, 17};
    recipe made = mixed_recipe();
    for (int run = 0; run < RUNS; run++) {
        uint64_t at_once = 0;
        for (int way = -1; way < 3; way++) {
            mspring_network *network = make(&made, MSPRING_SIMD_AUTO, 1);
            mspring_job *job = NULL;
            set_up_run(network, run);
            make_wreck(network, &made, TORN);
            uint32_t left = 1;
            for (int aim = 0; aim < 2; aim++) {
                const mspring_layout layout = aim == 0 ? MSPRING_LAYOUT_COMPACT : MSPRING_LAYOUT_WHOLE;
                if (way >= 0) {
                    check_ok(mspring_job_begin(network, layout, &job));
                }
                for (int frame = 0; frame < 3; frame++) {
                    support_steps(network, 1, 1.0 / 64);
                    if (way >= 0) {
                        check_ok(mspring_job_run(job, functions[way], &left));
                    }
                }
                if (way < 0) {
                    check_ok(aim == 0 ? mspring_network_compact(network) : mspring_network_expand(network));
                } else {
                    check_ok(mspring_job_run(job, 0, &left));
                    check_ok(mspring_job_finish(network, job));
                    check_error(mspring_job_finish(network, job), MSPRING_ERROR_ARGUMENT);
                    check_error(mspring_job_run(job, 0, NULL), MSPRING_ERROR_ARGUMENT);
                    assert_int_equal(left, 0);
                    mspring_job_destroy(job);
                }
                support_steps(network, 3, 1.0 / 64);
            }
            at_once = way < 0 ? support_hash(network) : at_once;
            assert_int_equal(support_hash(network), at_once);
            mspring_network_destroy(network);
        }
    }
    recipe_free(&made);
}

/// What a job's layout leaves out and somebody restores, or what it does not know, makes it outdated.
static void jobs_become_outdated(void **state) {
    (void)state;
    recipe made = mixed_recipe();
    for (int what = 0; what < 4; what++) {
        mspring_network_def def = support_def(-9.8f, 4);
        def.spare_springs = 2;
        mspring_network *network = recipe_network(&made, &def);
        mspring_job *job = NULL;
        mspring_id spring = 0, ids[1];
        make_wreck(network, &made, TORN);
        while (!breaks(&made, TORN, spring)) {
            spring++;
        }
        check_ok(mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, &job));
        check_ok(mspring_job_run(job, 50, NULL));
        mspring_spring_def added;
        check_ok(mspring_spring_def_init(&added, sizeof added));
        added.a = made.particle_count - 1;
        added.b = 0;
        if (what == 0) {
            check_ok(mspring_network_restore_springs(network, &spring, 1, 0));
        } else if (what == 1) {
            check_ok(mspring_network_add_springs(network, &added, 1, ids));
        } else if (what == 2) {
            check_ok(mspring_network_remove_springs(network, &spring, 1));
        }
        support_steps(network, 1, 1.0 / 64);
        check_ok(mspring_job_run(job, 0, NULL));
        const uint64_t hash = support_hash(network);
        const uint32_t before = swept(network);
        if (what < 3) {
            check_error(mspring_job_finish(network, job), MSPRING_ERROR_OUTDATED);
            assert_int_equal(swept(network), before);
        } else {
            check_ok(mspring_job_finish(network, job));
        }
        assert_int_equal(support_hash(network), hash);
        mspring_job_destroy(job);
        compact(network);
        support_steps(network, 1, 1.0 / 64);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

static void compact_in_hook(const mspring_hook_args *args, void *user) {
    (void)args;
    check_error(mspring_network_compact(user), MSPRING_ERROR_BUSY);
    check_error(mspring_network_expand(user), MSPRING_ERROR_BUSY);
    mspring_job *job = NULL;
    check_error(mspring_job_begin(user, MSPRING_LAYOUT_COMPACT, &job), MSPRING_ERROR_BUSY);
    check_error(mspring_job_finish(user, NULL), MSPRING_ERROR_BUSY);
}

static void misuse_is_refused(void **state) {
    (void)state;
    check_error(mspring_network_compact(NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_expand(NULL), MSPRING_ERROR_ARGUMENT);
    recipe made = mixed_recipe();
    mspring_network *network = make(&made, MSPRING_SIMD_AUTO, 1);
    check_ok(mspring_network_expand(network)); // nothing to undo
    check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, compact_in_hook, network, NULL));
    support_steps(network, 1, 1.0 / 64);
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_changes_but_the_plan),
        cmocka_unit_test(plans_are_those_of_what_is_left),
        cmocka_unit_test(motion_goes_on),
        cmocka_unit_test(expanding_undoes_compacting),
        cmocka_unit_test(bits_are_the_same_everywhere),
        cmocka_unit_test(work_is_done_in_pieces),
        cmocka_unit_test(nothing_that_happens_meanwhile_is_lost),
        cmocka_unit_test(springs_that_are_left_out_can_be_edited_and_restored),
        cmocka_unit_test(strains_are_watched_as_before),
        cmocka_unit_test(snapshots_are_of_one_plan),
        cmocka_unit_test(steps_taken_for_the_explicit_solver_stay_the_same),
        cmocka_unit_test(clones_are_compact_too),
        cmocka_unit_test(every_failure_leaves_the_network_as_it_was),
        cmocka_unit_test(a_job_may_stay_unfinished),
        cmocka_unit_test(bits_depend_on_begin_and_finish_alone),
        cmocka_unit_test(jobs_become_outdated),
        cmocka_unit_test(misuse_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

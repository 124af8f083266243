/// @file test_job_storm.c
/// Two networks live the same random life. One runs its jobs all at once before their finish, the other in pieces
/// of random length between everything else that happens. Every call answers the same, no finish is to be seen, and
/// the bits stay the same.
///
/// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "changes.h"
#include "recipe.h"
#include "snapshots.h"
#include "support.h"

enum { SPARE = 40, LIVES = 12, EVENTS = 160 };

typedef struct twin {
    mspring_network *network;
    mspring_job *job;
    saved kept;
} twin;

static mspring_network *make(const recipe *made, uint64_t seed) {
    mspring_network_def def = support_def(-9.8f, 3);
    def.spare_particles = def.spare_springs = SPARE;
    def.settings.sleep_speed = seed % 3 == 0 ? 0.01f : 0;
    def.settings.guard = seed % 2 == 0 ? MSPRING_GUARD_IMPLICIT : MSPRING_GUARD_GROWTH;
    def.worker_count = seed % 4 == 1 ? 2 : 1;
    return recipe_network(made, &def);
}

static mspring_result use_solver(mspring_network *network, uint64_t choice) {
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = (mspring_solver)(choice % 3);
    solver.substeps = solver.solver == MSPRING_SOLVER_EXPLICIT ? 3 : 1 + (uint32_t)(choice / 3 % 2);
    solver.integrator = (mspring_integrator)(choice / 6 % 3);
    return support_set_solver(network, &solver);
}

static uint32_t finished, outdated;

static mspring_result finish(twin *t) {
    const uint64_t before = support_hash(t->network);
    mspring_result result = mspring_job_run(t->job, 0, NULL);
    if (result == MSPRING_OK) {
        result = mspring_job_finish(t->network, t->job);
    }
    assert_int_equal(support_hash(t->network), before);
    mspring_job_destroy(t->job);
    t->job = NULL;
    finished += result == MSPRING_OK;
    outdated += result == MSPRING_ERROR_OUTDATED;
    return result;
}

static mspring_result load(twin *t) {
    return t->kept.bytes ? mspring_network_load(t->network, t->kept.bytes, t->kept.size) : MSPRING_OK;
}

static void keep(twin *t) {
    free(t->kept.bytes);
    t->kept = snapshots_save(t->network, MSPRING_SNAPSHOT_ALL);
}

/// The clone takes the original's place, which takes its job along.
static void replace_by_clone(twin *t) {
    mspring_network *clone = NULL;
    check_ok(mspring_network_clone(t->network, NULL, &clone));
    mspring_network_destroy(t->network);
    t->network = clone;
    if (t->job) {
        check_ok(mspring_job_run(t->job, 0, NULL));
        mspring_job_destroy(t->job);
        t->job = NULL;
    }
}

static mspring_result add(mspring_network *network, mspring_id a, uint64_t what) {
    mspring_id id;
    if (what % 3 == 0) {
        mspring_particle_def particle;
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
        particle.x = (double)(what % 40);
        particle.y = (double)(what % 30);
        return mspring_network_add_particles(network, &particle, 1, &id);
    }
    mspring_spring_def spring;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
    spring.a = a;
    spring.b = (mspring_id)(what % mspring_network_count(network, MSPRING_PARTICLES));
    spring.stiffness = 40;
    spring.rest_length = 2;
    return mspring_network_add_springs(network, &spring, 1, &id);
}

static mspring_result take_away(mspring_network *network, mspring_id particle, mspring_id spring, uint64_t what) {
    return what % 8 == 0   ? mspring_network_remove_particles(network, &particle, 0, 1)
           : what % 8 == 1 ? mspring_network_reuse_ids(network)
                           : mspring_network_remove_springs(network, &spring, 0, 1);
}

static mspring_result happen(twin *t, uint64_t what) {
    mspring_network *network = t->network;
    const mspring_id particle = (mspring_id)(what / 64 % mspring_network_count(network, MSPRING_PARTICLES));
    const mspring_id spring = (mspring_id)(what / 256 % mspring_network_count(network, MSPRING_SPRINGS));
    const change *chosen = &changes[what / 128 % CHANGE_COUNT];
    switch (what % 16) {
    case 0:
    case 1:
        if (t->job) {
            return finish(t);
        }
        return mspring_job_begin(network, what / 16 % 4 == 0 ? MSPRING_LAYOUT_WHOLE : MSPRING_LAYOUT_COMPACT,
                                 &t->job);
    case 2:
        return use_solver(network, what / 16);
    case 3:
        keep(t);
        return MSPRING_OK;
    case 4:
        return load(t);
    case 5:
        if (what / 16 % 4 == 0) {
            replace_by_clone(t);
        }
        return MSPRING_OK;
    case 6:
        return what / 16 % 4 == 0 ? mspring_network_compact(network) : MSPRING_OK;
    case 7:
        return what / 16 % 4 == 0 ? support_expand(network) : MSPRING_OK;
    case 8:
    case 9:
        if (support_has_particle(network, particle) && support_has_spring(network, spring)) {
            chosen->make(network, particle, spring);
        }
        return MSPRING_OK;
    case 10:
        return mspring_network_break_springs(network, &spring, 0, 1);
    case 11:
        return mspring_network_restore_springs(network, &spring, 0, 1, (double)(what / 16 % 3) * 0.03);
    case 12:
        return add(network, particle, what / 16);
    case 13:
        return what / 16 % 2 == 0 ? take_away(network, particle, spring, what / 32) : MSPRING_OK;
    default:
        return mspring_network_step(network, 1.0 / 64);
    }
}

static void play(uint64_t seed) {
    recipe made = recipe_mixed(seed);
    twin *twins[2];
    for (int i = 0; i < 2; i++) {
        twins[i] = calloc(1, sizeof *twins[i]);
        assert_non_null(twins[i]);
        twins[i]->network = make(&made, seed);
    }
    uint64_t dice = seed, pieces = seed + 99;
    for (uint32_t n = 0; n < EVENTS; n++) {
        const uint64_t what = support_random(&dice);
        mspring_result results[2];
        for (int i = 0; i < 2; i++) {
            results[i] = happen(twins[i], what);
        }
        assert_int_equal(results[0], results[1]);
        assert_int_equal(support_hash(twins[0]->network), support_hash(twins[1]->network));
        if (twins[1]->job && support_random(&pieces) % 3 == 0) {
            check_ok(mspring_job_run(twins[1]->job, 1 + (uint32_t)(support_random(&pieces) % 9), NULL));
        }
    }
    assert_int_equal(snapshots_look_at(twins[0]->network), snapshots_look_at(twins[1]->network));
    for (int i = 0; i < 2; i++) {
        free(twins[i]->kept.bytes);
        mspring_network_destroy(twins[i]->network);
        mspring_job_destroy(twins[i]->job);
        free(twins[i]);
    }
    recipe_free(&made);
}

static void lives_do_not_tell_how_jobs_ran(void **state) {
    (void)state;
    const char *more = getenv("JOB_STORM_LIVES");
    const uint64_t lives = more ? strtoull(more, NULL, 10) : LIVES;
    for (uint64_t seed = 1; seed <= lives; seed++) {
        play(seed);
    }
    assert_true(finished > 2 * lives);
    assert_true(outdated > lives);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(lives_do_not_tell_how_jobs_ran)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

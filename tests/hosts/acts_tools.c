/// @file acts_tools.c
/// Hooks, layouts, equilibrium, stability, tuning, copies and snapshots.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plain.h"
#include "snapshots.h"
#include "step/finite.h"
#include "support.h"

/* ------------------------------------------------------------------------------------------------- hooks */

// A wind that depends on nothing but the place.
static void MSPRING_CALL blow(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++)
        if (args->inverse_mass[slot] > 0 && args->force_x)
            args->force_x[slot] += 0.25f;
        else if (args->inverse_mass[slot] > 0 && args->x[slot] > 30)
            args->vx[slot] *= 0.5f;
}

static mspring_result add_hook(game *it, place *p, const call *c) {
    mspring_hook_def def;
    const uint32_t at = c->pick % MOST_HOOKS;
    mspring_id id = MSPRING_NONE;
    if (p->has_hook[at])
        return MSPRING_OK;
    JUDGE(it, mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def) == MSPRING_OK);
    def.phase = (mspring_phase)(c->pick / 8 % 3);
    def.fn = blow;
    def.period = def.phase == MSPRING_PHASE_BEFORE_STEP ? 1 : 1 + c->pick / 32 % 3;
    def.flags = c->pick / 128 % 4;
    def.below_y = 2;
    const mspring_result result = mspring_network_add_hook(p->network, &def, &id);
    if (it->setup.is_verbose)
        printf("hook of phase %d, period %u, flags %u\n", (int)def.phase, def.period, def.flags);
    JUDGE(it, (result == MSPRING_OK) == (id != MSPRING_NONE));
    if (result == MSPRING_OK)
        p->has_hook[at] = true, p->hooks[at] = id;
    return result;
}

static mspring_result remove_hook(game *it, place *p, const call *c) {
    const uint32_t at = c->pick % MOST_HOOKS;
    const mspring_result result = mspring_network_remove_hook(p->network, p->has_hook[at] ? p->hooks[at] : 1000);
    JUDGE(it, (result == MSPRING_OK) == p->has_hook[at]);
    p->has_hook[at] = false;
    return result;
}

/* ------------------------------------------------------------------------------------------------ layouts */

static mspring_result compact(game *it, place *p, const call *c) {
    (void)it;
    return c->pick % 4 ? mspring_network_compact(p->network) : support_expand(p->network);
}

// A job that goes on for frames, and is left now and then.
// With all memory: a job that lacked some can only be destroyed, so the games would compact at different times.
// test_compact_jobs lets allocations of jobs fail.
static mspring_result go_on_with_job(game *it, place *p, const call *c) {
    const uint32_t fails = p->memory->fails;
    uint32_t left = 1;
    if (!p->job)
        return mspring_job_begin(p->network, c->pick % 4 ? MSPRING_LAYOUT_COMPACT : MSPRING_LAYOUT_WHOLE, &p->job);
    p->memory->fails = 0;
    mspring_result result = mspring_job_run(p->job, c->pick / 4 % 16, &left);
    if (result == MSPRING_OK && left == 0)
        result = mspring_job_finish(p->network, p->job);
    p->memory->fails = fails;
    JUDGE(it, result == MSPRING_OK || left == 0 || mspring_job_error(p->job)[0]);
    if (left == 0 || result != MSPRING_OK || c->pick / 64 % 8 == 0) {
        mspring_job_destroy(p->job);
        p->job = NULL;
    }
    return result == MSPRING_ERROR_LIMIT ? MSPRING_OK : result; // the job's message
}

/* ----------------------------------------------------------------------------------------------- analysis */

static mspring_result settle(game *it, place *p, const call *c) {
    mspring_settle_def def;
    mspring_settle_result found = {.struct_size = sizeof found};
    JUDGE(it, mspring_init(MSPRING_STRUCT_SETTLE_DEF, &def, sizeof def) == MSPRING_OK);
    def.flags = c->pick & 1 ? MSPRING_SETTLE_LEAVE_FLOATING : 0;
    def.max_iterations = 25;
    return mspring_network_settle(p->network, &def, &found);
}

static mspring_result stable_dt(game *it, place *p, const call *c) {
    double now = -1, any_shape = -1;
    uint32_t substeps = 0;
    if (c->pick & 1)
        return mspring_network_suggest_substeps(p->network, 1.0 / 60, 0.5 + c->d[0] / 2, &substeps);
    const mspring_result result = mspring_network_get_stable_dt(p->network, &now, &any_shape);
    JUDGE(it, result != MSPRING_OK || (now >= 0 && any_shape >= 0));
    return result;
}

// A clock that counts, so that no run depends on time.
static double MSPRING_CALL count_time(void *user) {
    return 1e-3 * (double)++*(uint64_t *)user;
}

static mspring_result tune(game *it, place *p, const call *c) {
    mspring_tune_def def;
    mspring_tune_row rows[2];
    mspring_settings settings[2];
    mspring_tune_scene scene;
    uint64_t ticks = 0;
    uint32_t count = 0;
    if (p->plain->particles > 150)
        return MSPRING_OK;
    JUDGE(it, mspring_init(MSPRING_STRUCT_TUNE_DEF, &def, sizeof def) == MSPRING_OK);
    for (int i = 0; i < 2; i++) {
        JUDGE(it, mspring_init(MSPRING_STRUCT_SETTINGS, &settings[i], sizeof settings[i]) == MSPRING_OK);
        settings[i].substeps = 2 + c->pick % 4;
        settings[i].solver = i ? MSPRING_SOLVER_IMPLICIT : MSPRING_SOLVER_EXPLICIT;
        rows[i] = (mspring_tune_row){.struct_size = sizeof rows[i]};
    }
    def.settings = settings, def.setting_count = 2;
    JUDGE(it, mspring_init(MSPRING_STRUCT_TUNE_SCENE, &scene, sizeof scene) == MSPRING_OK);
    scene.start_count = 4, scene.duration = 0.05;
    def.scene = c->pick / 8 % 2 ? &scene : NULL;
    def.budget = 0.2, def.duration = 0.1, def.clock = count_time, def.user = &ticks;
    const mspring_result result = mspring_network_tune(p->network, &def, rows, 2, &count);
    JUDGE(it, count == (result == MSPRING_OK ? 2u : 0u));
    if (result == MSPRING_OK)
        settings[0] = rows[1].settings;
    return result;
}

static mspring_result tune_settings(game *it, place *p, const call *c) {
    mspring_settings settings[64];
    uint32_t count = 0;
    for (int i = 0; i < 64; i++)
        settings[i].struct_size = sizeof settings[i];
    const mspring_result result =
        mspring_tune_settings(p->network, 1.0 / 60, settings, c->pick & 1 ? 64 : 0, &count);
    JUDGE(it, result != MSPRING_OK || count > 0);
    return result;
}

/* ----------------------------------------------------------------------------------- copies and snapshots */

// A clone goes another way, and comes back by a snapshot.
static mspring_result clone(game *it, place *p, const call *c) {
    mspring_network *made = NULL;
    const mspring_result result = mspring_network_clone(p->network, NULL, &made);
    if (result != MSPRING_OK)
        return result;
    const uint32_t fails = p->memory->fails;
    p->memory->fails = 0;
    const image now = keep(p->network, c->pick & 1 ? MSPRING_SNAPSHOT_ALL : MSPRING_SNAPSHOT_FRAME);
    const image whole = keep(p->network, MSPRING_SNAPSHOT_ALL);
    for (int i = 0; i < 3; i++)
        (void)!mspring_network_step(made, 0.01 + 0.01 * c->d[i] * c->d[i]);
    mspring_result loaded = mspring_network_load(made, now.bytes, now.size);
    if (loaded != MSPRING_OK)
        fprintf(stderr, "%s\n", mspring_network_error(made));
    JUDGE(it, loaded == MSPRING_OK);
    JUDGE(it, is_same_as(made, &whole));
    mspring_network_destroy(made);
    free(now.bytes);
    free(whole.bytes);
    p->memory->fails = fails;
    return result;
}

// Bytes that were changed or cut off: refused, or, if the checksum fits, another state that is sound.
static mspring_result load_damaged(game *it, place *p, const call *c) {
    saved of;
    const uint32_t fails = p->memory->fails;
    p->memory->fails = 0;
    const image now = keep(p->network, c->pick & 1 ? MSPRING_SNAPSHOT_ALL : MSPRING_SNAPSHOT_FRAME);
    of = (saved){now.bytes, now.size};
    mspring_network *other = NULL;
    JUDGE(it, mspring_network_clone(p->network, NULL, &other) == MSPRING_OK);
    const image before = keep(other, MSPRING_SNAPSHOT_ALL);
    for (uint32_t i = 0; i < 1 + c->count % 4; i++)
        of.bytes[(size_t)((double)of.size * (c->springs[i] % 1024) / 1024)] ^= (uint8_t)(1 + c->particles[i] % 255);
    if (c->pick & 2)
        of.size -= c->pick / 8 % of.size;
    const bool fits = c->pick & 4 && of.size == now.size;
    if (fits)
        snapshots_renew_checksum(&of);
    const mspring_result result = mspring_network_load(other, of.bytes, of.size);
    if (result == MSPRING_OK) {
        JUDGE(it, mspringi_is_finite(other));
        mspring_settings solver = {.struct_size = sizeof solver}; // a million substeps would be allowed
        JUDGE(it, mspring_network_get_settings(p->network, &solver) == MSPRING_OK);
        JUDGE(it, support_set_solver(other, &solver) == MSPRING_OK);
        const mspring_result stepped = mspring_network_step(other, 0.01);
        JUDGE(it, stepped == MSPRING_OK || stepped == MSPRING_ERROR_UNSTABLE || stepped == MSPRING_ERROR_LIMIT);
        JUDGE(it, mspringi_is_finite(other));
    } else {
        JUDGE(it, result == MSPRING_ERROR_SNAPSHOT && mspring_network_error(other)[0]);
        JUDGE(it, is_same_as(other, &before));
    }
    game_log(&it->log, &result, sizeof result);
    mspring_network_destroy(other);
    free(now.bytes);
    free(before.bytes);
    p->memory->fails = fails;
    return MSPRING_OK;
}

// Saved and loaded on the spot: nothing changes but that events are dropped.
static mspring_result save_and_load(game *it, place *p, const call *c) {
    const image now = keep(p->network, c->pick & 1 ? MSPRING_SNAPSHOT_ALL : MSPRING_SNAPSHOT_FRAME);
    const mspring_result result = mspring_network_load(p->network, now.bytes, now.size);
    JUDGE(it, result == MSPRING_OK || result == MSPRING_ERROR_MEMORY);
    if (result == MSPRING_OK)
        p->plain->knows_events = false;
    free(now.bytes);
    return result;
}

const act acts_tools[] = {
    {"add_hook", add_hook, ACT_SETUP},
    {"remove_hook", remove_hook, 0},
    {"compact", compact, ACT_INSIDE | ACT_RARE},
    {"job", go_on_with_job, ACT_INSIDE},
    {"settle", settle, ACT_RARE | ACT_CALM | ACT_WHOLE},
    {"stable_dt", stable_dt, ACT_READS | ACT_RARE},
    {"tune", tune, ACT_READS | ACT_RARE},
    {"tune_settings", tune_settings, ACT_READS | ACT_RARE},
    {"clone", clone, ACT_READS},
    {"load damaged", load_damaged, ACT_READS},
    {"save and load", save_and_load, ACT_READS},
};
const uint32_t acts_tools_count = COUNT_OF(acts_tools);

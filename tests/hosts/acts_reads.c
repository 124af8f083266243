/// @file acts_reads.c
/// Reading: events, components, measurements, lists and ranges of all kinds, and ranges that are not there.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "plain.h"
#include "support.h"

static mspring_result reserve_events(game *it, place *p, const call *c) {
    (void)it;
    const mspring_result result =
        mspring_network_reserve_events(p->network, c->pick % 4 ? 16u << c->pick / 4 % 8 : 0);
    if (result == MSPRING_OK) {
        memcpy(p->plain->breaks_by_events, p->plain->is_broken, sizeof p->plain->is_broken);
        p->plain->knows_events = c->pick % 4 != 0;
    }
    return result;
}

static void learn_event(game *it, plain *list, const mspring_event *event) {
    game_log(&it->events_log, event, sizeof *event);
    const bool is_of_spring = event->kind <= MSPRING_EVENT_RESTORED || event->kind == MSPRING_EVENT_YIELDED;
    JUDGE(it, event->kind >= 0 && event->kind <= MSPRING_EVENT_YIELDED);
    JUDGE(it, event->id < (is_of_spring ? list->springs : list->particles));
    if (event->kind == MSPRING_EVENT_BROKEN)
        list->breaks_by_events[event->id] = true;
    else if (event->kind == MSPRING_EVENT_RESTORED)
        list->breaks_by_events[event->id] = false;
}

// Read all queued events, or some. Then exactly the springs that events report are broken.
static mspring_result read_events(game *it, place *p, const call *c) {
    mspring_event events[MANY];
    uint32_t count = 0;
    uint64_t lost = 0;
    const bool is_all = c->pick & 1;
    mspring_result result = MSPRING_OK;
    do {
        result = mspring_network_read_events(p->network, events, is_all ? MANY : c->count, &count, &lost);
        for (uint32_t i = 0; i < count && result == MSPRING_OK; i++)
            learn_event(it, p->plain, &events[i]);
        it->counts.events += count;
    } while (is_all && result == MSPRING_OK && count == MANY);
    game_log(&it->events_log, &lost, sizeof lost);
    if (lost > 0)
        p->plain->knows_events = false;
    for (mspring_id i = 0; is_all && p->plain->knows_events && i < p->plain->springs; i++)
        JUDGE(it, !p->plain->has_spring[i] || p->plain->breaks_by_events[i] == p->plain->is_broken[i]);
    return result;
}

static mspring_result update_components(game *it, place *p, const call *c) {
    uint32_t count = 0, changed = 0;
    mspring_body report = {.struct_size = sizeof report};
    (void)c;
    const mspring_result result = mspring_network_update_components(p->network, &count, &changed);
    if (result == MSPRING_OK && count > 0) {
        JUDGE(it, mspring_network_get_components(p->network, count - 1, 1, &report) == MSPRING_OK);
        JUDGE(it, report.particle_count > 0 && report.head < p->plain->particles);
    }
    if (result == MSPRING_OK)
        game_log(&it->log, &count, sizeof count);
    return result;
}

static mspring_result measure(game *it, place *p, const call *c) {
    double numbers[8];
    (void)c;
    JUDGE(it, support_get_energy(p->network, &numbers[0], &numbers[1], &numbers[2]) == MSPRING_OK);
    JUDGE(it, support_get_momentum(p->network, &numbers[3], &numbers[4], &numbers[5]) == MSPRING_OK);
    JUDGE(it, !(numbers[0] < 0));
    game_log(&it->log, numbers, 6 * sizeof numbers[0]);
    return MSPRING_OK;
}

// The forms for lists and for floats say what the others say.
static mspring_result read_lists(game *it, place *p, const call *c) {
    double x[MANY], y[MANY], one[2];
    float xf[2][MANY], yf[2][MANY];
    const mspring_result result = mspring_network_get_positions(p->network, c->particles, 0, c->count, x, y, 1);
    JUDGE(it,
          mspring_network_get_columns(p->network, c->particles, 0, c->count, (const mspring_column[]){{MSPRING_X, 1, xf[0]}, {MSPRING_Y, 1, yf[0]}}, 2) == result);
    JUDGE(it, mspring_network_get_velocities(p->network, c->particles, 0, c->count, xf[1], yf[1], 1) == result);
    for (uint32_t i = 0; i < c->count && result == MSPRING_OK; i++) {
        float v[2], q[2];
        JUDGE(it, mspring_network_get_positions(p->network, NULL, c->particles[i], 1, &one[0], &one[1], 1) == MSPRING_OK);
        JUDGE(it, one[0] == x[i] && one[1] == y[i]);
        JUDGE(it,
              mspring_network_get_columns(p->network, NULL, c->particles[i], 1, (const mspring_column[]){{MSPRING_X, 1, &q[0]}, {MSPRING_Y, 1, &q[1]}}, 2) == MSPRING_OK);
        JUDGE(it, q[0] == xf[0][i] && q[1] == yf[0][i] && q[0] == (float)x[i]);
        JUDGE(it, mspring_network_get_velocities(p->network, NULL, c->particles[i], 1, &v[0], &v[1], 2) == MSPRING_OK);
        JUDGE(it, v[0] == xf[1][i] && v[1] == yf[1][i]);
    }
    return result;
}

static mspring_result read_springs(game *it, place *p, const call *c) {
    float values[MANY], one = 0;
    const mspring_property which = (mspring_property)(MSPRING_STIFFNESS + c->pick % 16);
    const mspring_result result = mspring_network_get(p->network, which, c->springs, 0, c->count, values, 1);
    for (uint32_t i = 0; i < c->count && result == MSPRING_OK; i++) {
        support_spring_info info;
        JUDGE(it, mspring_network_get(p->network, which, NULL, c->springs[i], 1, &one, 1) == MSPRING_OK);
        JUDGE(it, one == values[i]);
        const bool has = p->plain->has_spring[c->springs[i]];
        JUDGE(it, (support_get_spring(p->network, c->springs[i], &info) == MSPRING_OK) == has);
        JUDGE(it, !has || which != MSPRING_TENSION || info.force == one);
        game_log(&it->log, &one, sizeof one);
    }
    return result;
}

static mspring_result read_sleepers(game *it, place *p, const call *c) {
    uint8_t asleep[MANY];
    const mspring_result result = support_get_sleepers(p->network, c->particle, c->count, asleep, 1);
    for (uint32_t i = 0; i < c->count && result == MSPRING_OK; i++)
        JUDGE(it, asleep[i] <= 1 && (asleep[i] || !support_is_asleep(p->network) ||
                                     !p->plain->has_particle[c->particle + i]));
    if (result == MSPRING_OK)
        game_log(&it->log, asleep, c->count);
    return result;
}

static mspring_result read_floor(game *it, place *p, const call *c) {
    float x[MANY], y[MANY];
    mspring_floor_def def = {.struct_size = sizeof def};
    JUDGE(it, mspring_network_get_floor(p->network, &def) == MSPRING_OK);
    const mspring_result result = mspring_network_get_columns(p->network, NULL, c->particle, c->count, (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, x}, {MSPRING_FLOOR_IMPULSE_Y, 1, y}}, 2);
    for (uint32_t i = 0; i < c->count && result == MSPRING_OK; i++) {
        JUDGE(it, isfinite(x[i]) && isfinite(y[i]));
        JUDGE(it, def.plane_count + def.height_count > 0 || (x[i] == 0 && y[i] == 0));
    }
    return result;
}

static mspring_result read_plan(game *it, place *p, const call *c) {
    support_plan plan;
    (void)c;
    JUDGE(it, support_get_plan(p->network, &plan) == MSPRING_OK);
    JUDGE(it, plan.simd_level == support_simd_level(p->network) && mspring_simd_available(plan.simd_level));
    JUDGE(it, mspring_simd_name(plan.simd_level)[0] && plan.simd_level <= support_best_level());
    JUDGE(it, support_worker_count(p->network) >= 1);
    JUDGE(it, plan.particle_count == p->plain->particles && plan.spring_count == p->plain->springs);
    return MSPRING_OK;
}

// Calls that need no network.
static mspring_result read_library(game *it, place *p, const call *c) {
    mspring_settings settings;
    mspring_allocator allocator;
    (void)p;
    JUDGE(it, mspring_version() == MSPRING_VERSION && mspring_version_string()[0] && mspring_features() != 0);
    JUDGE(it, mspring_result_string((mspring_result)(-(int)(c->pick % 32)))[0]);
    JUDGE(it, mspring_init(MSPRING_STRUCT_ALLOCATOR, &allocator, sizeof allocator) == MSPRING_OK);
    JUDGE(it, mspring_init(MSPRING_STRUCT_SETTINGS, &settings, sizeof settings) == MSPRING_OK);
    JUDGE(it, mspring_init(MSPRING_STRUCT_SETTINGS, &settings, c->pick % 8) == MSPRING_ERROR_STRUCT);
    return MSPRING_OK;
}

// Too many, from an id that is there or from none.
static mspring_result read_too_many(game *it, place *p, const call *c) {
    double x[1], y[1];
    float f[2] = {1, 1};
    uint32_t u[1];
    const uint32_t many = c->pick & 1 ? MSPRING_ALL - 1 - c->pick / 4 : p->plain->particles + 1u + c->pick / 256;
    const uint32_t springs = many > p->plain->springs ? many : p->plain->springs + 1;
    mspring_network *n = p->network;
    JUDGE(it, mspring_network_get_positions(n, NULL, c->particle, many, x, y, 1) == MSPRING_ERROR_ID);
    JUDGE(it, mspring_network_get_velocities(n, NULL, c->particle, many, f, f, 1) == MSPRING_ERROR_ID);
    JUDGE(it, mspring_network_get_integers(n, MSPRING_PARTICLE_FLAGS, NULL, c->particle, many, u, 1) == MSPRING_ERROR_ID);
    JUDGE(it, mspring_network_get_integers(n, MSPRING_SPRING_FLAGS, NULL, c->spring, springs, u, 1) == MSPRING_ERROR_ID);
    JUDGE(it, mspring_network_get(n, MSPRING_STRAIN, NULL, c->spring, springs, f, 1) == MSPRING_ERROR_ID);
    JUDGE(it, mspring_network_get_positions(n, NULL, c->particle, 1, NULL, y, 1) != MSPRING_OK);
    if (c->pick & 2)
        return mspring_network_set_velocities(n, NULL, c->particle, many, f, f, 0);
    return mspring_network_set(n, MSPRING_STIFFNESS, NULL, c->spring, springs, f, 0);
}

const act acts_reads[] = {
    {"reserve_events", reserve_events, ACT_INSIDE | ACT_SETUP},
    {"read_events", read_events, ACT_READS},
    {"read events late", read_events, ACT_READS},
    {"update_components", update_components, ACT_INSIDE | ACT_SETUP},
    {"measure", measure, ACT_READS},
    {"read lists", read_lists, ACT_READS},
    {"read springs", read_springs, ACT_READS},
    {"get_sleepers", read_sleepers, ACT_READS},
    {"get_floor_impulses", read_floor, ACT_READS | ACT_RARE},
    {"get_plan", read_plan, ACT_READS},
    {"version and defaults", read_library, ACT_READS | ACT_RARE},
    {"too many", read_too_many, ACT_READS | ACT_RARE},
};
const uint32_t acts_reads_count = COUNT_OF(acts_reads);

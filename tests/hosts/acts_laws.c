/// @file acts_laws.c
/// Areas, angle springs, groups and actuators.
///
/// SPDX-License-Identifier: MIT
#include "plain.h"
#include "support.h"

static mspring_area_def draw_area(game *it, const call *c) {
    mspring_area_def def;
    JUDGE(it, mspring_init(MSPRING_STRUCT_AREA_DEF, &def, sizeof def) == MSPRING_OK);
    def.kind = c->pick / 256 % 4 == 0 ? MSPRING_AREA_GAS : MSPRING_AREA_ELASTIC;
    def.stiffness = def.kind == MSPRING_AREA_GAS ? 0 : 100 * c->f[0];
    def.pressure = c->pick / 1024 % 2 ? 5 * c->f[1] : 0;
    def.fill = c->pick / 2048 % 4 ? 1 : 0.5f + c->f[2];
    def.rest_area = c->pick / 8192 % 4 ? 0 : (float)c->d[0];
    return def;
}

static mspring_result add_area(game *it, place *p, const call *c) {
    const mspring_area_def def = draw_area(it, c);
    mspring_id ring[4], area = MSPRING_NONE, corners[4];
    uint32_t count = 0;
    // Ends of a spring and what follows: now and then corners of a cell.
    const mspring_id s = c->spring;
    ring[0] = s < p->plain->springs ? p->plain->ends[s][0] : c->particles[0];
    ring[1] = s < p->plain->springs ? p->plain->ends[s][1] : c->particles[1];
    ring[2] = c->pick % 2 ? ring[1] + 1 : c->particles[2];
    ring[3] = c->particles[3];
    const mspring_result result = mspring_network_add_area(p->network, &def, ring, 3 + c->count % 2, &area);
    if (result == MSPRING_OK) {
        JUDGE(it, mspring_network_get_element_particles(p->network, area, corners, 4, &count) == MSPRING_OK);
        JUDGE(it, count == 3 + c->count % 2);
    }
    return result;
}

static mspring_result add_cell_areas(game *it, place *p, const call *c) {
    const mspring_area_def def = draw_area(it, c);
    uint32_t count = 0;
    const mspring_result result = mspring_network_add_cell_areas(p->network, &def, NULL, &count);
    if (result == MSPRING_OK)
        game_log(&it->log, &count, sizeof count);
    return result;
}

static mspring_result change_area(game *it, place *p, const call *c) {
    static const mspring_property properties[] = {MSPRING_ELEMENT_STIFFNESS, MSPRING_PRESSURE, MSPRING_FILL,
                                                  MSPRING_REST_AREA};
    const mspring_area_def def = draw_area(it, c);
    const float values[] = {def.stiffness, def.pressure, def.fill, (float)def.rest_area};
    const uint32_t one = c->pick / 16 % COUNT_OF(values); // a second call would not undo the first
    return c->pick % 4 ? mspring_network_set(p->network, properties[one], NULL, c->pick % 16, 1, &values[one], 1)
                       : mspring_network_remove_elements(p->network, NULL, c->pick / 4 % 32, 1);
}

static mspring_result add_angles(game *it, place *p, const call *c) {
    mspring_angle_def def;
    mspring_id arms[6];
    JUDGE(it, mspring_init(MSPRING_STRUCT_ANGLE_DEF, &def, sizeof def) == MSPRING_OK);
    def.stiffness = 5 * c->f[0];
    def.damping = c->pick / 16 % 2 ? 0.1f * c->f[1] : 0;
    def.rest_angle = c->pick / 32 % 2 ? (float)c->d[0] : MSPRING_REST_ANGLE_PRESENT;
    for (uint32_t i = 0; i < 6; i++)
        arms[i] = c->pick % 2 ? c->particle + i % 3 + i / 3 : c->particles[i];
    return mspring_network_add_angles(p->network, &def, arms, c->count % 3, 3, NULL);
}

static mspring_result change_angle(game *it, place *p, const call *c) {
    mspring_angle_def def = {.struct_size = sizeof def};
    const mspring_id id = c->pick % 16;
    (void)it;
    if (c->pick / 256 % 8 == 0)
        return mspring_network_remove_elements(p->network, NULL, id, 1);
    const mspring_result result = support_get_angle(p->network, id, &def);
    def.stiffness *= 2 * c->f[0];
    return result ? MSPRING_OK : support_set_angle(p->network, id, &def);
}

static mspring_result set_rest_angles(game *it, place *p, const call *c) {
    double angles[MANY];
    (void)it;
    for (int i = 0; i < MANY; i++)
        angles[i] = c->d[i] - 0.5;
    return support_set_rest_angles(p->network, c->pick % 16, c->count % 4, angles, c->pick / 16 % 2);
}

/* ----------------------------------------------------------------------------------------- groups, actuators */

// Bodies that lie one after the other in ids are a group each, where no spring leads out of them.
static mspring_result set_groups(game *it, place *p, const call *c) {
    mspring_id firsts[9];
    const uint32_t all = p->plain->particles;
    uint32_t count = c->count % 8;
    (void)it;
    for (uint32_t i = 0; i <= count; i++)
        firsts[i] = c->pick % 4 == 0 ? c->particles[i] : (mspring_id)((uint64_t)all * i / (count ? count : 1));
    return mspring_network_set_groups(p->network, firsts, count);
}

static mspring_result mark_groups(game *it, place *p, const call *c) {
    const uint32_t groups[3] = {c->pick % 8, c->pick / 8 % 8, 0};
    (void)it;
    return mspring_network_mark_groups(p->network, c->pick & 256 ? NULL : groups, 0, c->pick & 256 ? 0 : c->count % 4);
}

static mspring_result reset_groups(game *it, place *p, const call *c) {
    const uint32_t groups[3] = {c->pick % 8, c->pick / 8 % 8, 0};
    const mspring_result result =
        mspring_network_reset_groups(p->network, (mspring_reset)(c->pick / 512 % 2), c->pick & 256 ? NULL : groups, 0, c->pick & 256 ? 0 : c->count % 4);
    if (result == MSPRING_OK)
        plain_learn_restored(it, p);
    return result;
}

static mspring_result read_groups(game *it, place *p, const call *c) {
    static const mspring_observation columns[] = {
        {MSPRING_GROUP_FLAGS, 0}, {MSPRING_GROUP_MIN_X, 0}, {MSPRING_GROUP_MAX_X, 0}, {MSPRING_RELATIVE_X, 0},
        {MSPRING_RELATIVE_Y, 0},  {MSPRING_VX, 0},          {MSPRING_STRAIN, 1},      {MSPRING_SIGNAL, 0}};
    enum { COLUMNS = sizeof columns / sizeof columns[0] };
    uint32_t flags[8];
    double rows[4][COLUMNS];
    const uint32_t count = mspring_network_count(p->network, MSPRING_GROUPS);
    const uint32_t first = c->pick % (count + 1), some = count - first < 4 ? count - first : 4;
    const mspring_result result =
        mspring_network_get_integers(p->network, MSPRING_GROUP_FLAGS, NULL, first, some, flags, 1);
    JUDGE(it, count == 0 || result == MSPRING_OK);
    JUDGE(it, result != MSPRING_OK || mspring_network_observe_groups(p->network, NULL, first, some, columns, COLUMNS,
                                                                     rows[0], COLUMNS) == MSPRING_OK);
    for (uint32_t i = 0; i < some && result == MSPRING_OK; i++) {
        JUDGE(it, (rows[i][0] == 1) == (flags[i] & MSPRING_GROUP_HELD));
        JUDGE(it, rows[i][1] <= rows[i][2]);
        game_log(&it->log, rows[i], sizeof rows[i]);
    }
    return result;
}

static mspring_result set_actuators(game *it, place *p, const call *c) {
    (void)it;
    return mspring_network_set_actuators(p->network, c->springs, c->count, 1 + c->pick % 4);
}

static mspring_result set_signals(game *it, place *p, const call *c) {
    float signals[MANY];
    const uint32_t count = mspring_network_count(p->network, MSPRING_ACTUATORS);
    (void)it;
    for (int i = 0; i < MANY; i++)
        signals[i] = 0.7f + 0.6f * c->f[i];
    return mspring_network_set(p->network, MSPRING_SIGNAL, NULL, 0, c->pick % 8 ? count : c->count, signals, c->pick / 8 % 2);
}

static mspring_result plasticity(game *it, place *p, const call *c) {
    mspring_energy report = {.struct_size = sizeof report};
    (void)c;
    const mspring_result result = mspring_network_get_energy(p->network, &report);
    JUDGE(it, report.dissipated >= 0 && report.bent_springs <= p->plain->springs);
    game_log(&it->log, &report, sizeof report);
    return result;
}

// All areas and angles, at once and one by one.
static mspring_result read_laws(game *it, place *p, const call *c) {
    mspring_id ids[MANY];
    double values[2][MANY];
    uint32_t count = 0;
    (void)c;
    JUDGE(it, support_get_areas(p->network, ids, values[0], values[1], MANY, &count) == MSPRING_OK);
    for (uint32_t i = 0; i < count && i < MANY; i++) {
        support_area_info info;
        mspring_area_def def = {.struct_size = sizeof def};
        JUDGE(it, support_get_area_info(p->network, ids[i], &info) == MSPRING_OK);
        JUDGE(it, support_get_area(p->network, ids[i], &def) == MSPRING_OK);
        JUDGE(it, info.area == values[0][i] && (info.is_open || info.pressure == values[1][i]));
        JUDGE(it, i == 0 || ids[i] > ids[i - 1]);
        game_log(&it->log, &info.area, sizeof info.area);
    }
    const mspring_result result = support_get_angles(p->network, ids, values[0], values[1], MANY, &count);
    for (uint32_t i = 0; i < count && i < MANY; i++) {
        support_angle_info info;
        JUDGE(it, support_get_angle_info(p->network, ids[i], &info) == MSPRING_OK);
        JUDGE(it, info.angle == values[0][i] && (info.is_open || info.torque == values[1][i]));
        game_log(&it->log, &info.angle, sizeof info.angle);
    }
    return result;
}

const act acts_laws[] = {
    {"add_area", add_area, ACT_WHOLE | ACT_INSIDE | ACT_SETUP},
    {"add_cell_areas", add_cell_areas, ACT_WHOLE | ACT_INSIDE | ACT_RARE},
    {"change area", change_area, ACT_WHOLE | ACT_INSIDE},
    {"add_angles", add_angles, ACT_WHOLE | ACT_INSIDE | ACT_SETUP},
    {"change angle", change_angle, ACT_WHOLE | ACT_INSIDE},
    {"set_rest_angles", set_rest_angles, ACT_CALM | ACT_WHOLE | ACT_INSIDE},
    {"set_groups", set_groups, ACT_SETUP},
    {"mark_groups", mark_groups, 0},
    {"reset_groups", reset_groups, 0},
    {"read groups", read_groups, ACT_READS},
    {"set_actuators", set_actuators, ACT_INSIDE | ACT_SETUP},
    {"set_signals", set_signals, ACT_CALM | ACT_WHOLE | ACT_INSIDE},
    {"get_plasticity", plasticity, ACT_READS},
    {"read areas and angles", read_laws, ACT_READS},
};
const uint32_t acts_laws_count = COUNT_OF(acts_laws);

/// @file acts_springs.c
/// Calls that change springs, and what a network consists of.
///
/// SPDX-License-Identifier: MIT
#include "plain.h"
#include "support.h"

static mspring_result break_springs(game *it, place *p, const call *c) {
    (void)it;
    const mspring_result result = mspring_network_break_springs(p->network, c->springs, 0, c->count);
    for (uint32_t i = 0; i < c->count && result == MSPRING_OK; i++)
        plain_break(p->plain, c->springs[i]);
    return result;
}

// Now and then all that are broken.
static mspring_result restore_springs(game *it, place *p, const call *c) {
    static mspring_id ids[MOST_SPRINGS];
    const bool is_all = c->pick % 4 == 0;
    uint32_t count = is_all ? 0 : c->count;
    for (mspring_id i = 0; is_all && i < p->plain->springs; i++)
        if (p->plain->has_spring[i] && p->plain->is_broken[i])
            ids[count++] = i;
    (void)it;
    const mspring_id *list = is_all ? ids : c->springs;
    const mspring_result result =
        mspring_network_restore_springs(p->network, list, 0, count, c->pick & 4 ? 0 : c->d[0] * 0.5);
    for (uint32_t i = 0; i < count && result == MSPRING_OK; i++)
        p->plain->is_broken[list[i]] = false;
    return result;
}

static mspring_result detach(game *it, place *p, const call *c) {
    (void)it;
    const mspring_result result = mspring_network_detach_particles(p->network, c->particles, 0, c->count % 3);
    for (uint32_t i = 0; i < c->count % 3 && result == MSPRING_OK; i++)
        plain_detach(p->plain, c->particles[i]);
    return result;
}

// Cut along a line, as with a knife.
static mspring_result cut(game *it, place *p, const call *c) {
    mspring_id ids[64];
    double fractions[64], box[4];
    uint32_t count = 0;
    JUDGE(it, support_get_bounds(p->network, &box[0], &box[1], &box[2], &box[3]) == MSPRING_OK);
    const double x = box[0] + (box[2] - box[0]) * (c->pick / 256) / 256, y = box[3] - (c->pick % 4);
    (void)!mspring_network_springs_across(p->network, x, box[3] + 1, x, y - 2, MSPRING_FIND_WHOLE, ids, fractions,
                                          64, &count);
    count = count < 64 ? count : 64;
    const mspring_result result = mspring_network_break_springs(p->network, ids, 0, count);
    for (uint32_t i = 0; i < count && result == MSPRING_OK; i++)
        plain_break(p->plain, ids[i]);
    return result;
}

static mspring_result add_particles(game *it, place *p, const call *c) {
    mspring_particle_def defs[3];
    mspring_id ids[3] = {MSPRING_NONE, MSPRING_NONE, MSPRING_NONE};
    double at[4];
    JUDGE(it, support_get_bounds(p->network, &at[0], &at[1], &at[2], &at[3]) == MSPRING_OK);
    for (int i = 0; i < 3; i++) {
        JUDGE(it, mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &defs[i], sizeof defs[i]) == MSPRING_OK);
        defs[i].x = at[0] + c->d[i] * 10, defs[i].y = at[3] + 1 + i;
        defs[i].mass = 0.5f + c->f[i];
    }
    const mspring_result result = mspring_network_add_particles(p->network, defs, c->count % 4, ids);
    for (uint32_t i = 0; i < c->count % 4; i++)
        if (result == MSPRING_OK)
            plain_add_particle(it, p->plain, ids[i], defs[i].mass);
        else
            JUDGE(it, ids[i] == MSPRING_NONE);
    return result;
}

static mspring_result add_springs(game *it, place *p, const call *c) {
    mspring_spring_def defs[2];
    mspring_id ids[2] = {MSPRING_NONE, MSPRING_NONE};
    const uint32_t count = c->pick % 8 == 0 ? 2 : 1;
    for (int i = 0; i < 2; i++) {
        JUDGE(it, mspring_init(MSPRING_STRUCT_SPRING_DEF, &defs[i], sizeof defs[i]) == MSPRING_OK);
        defs[i].a = c->particles[i], defs[i].b = c->particles[i + 2];
        defs[i].stiffness = 200 * c->f[i];
        defs[i].damping = c->pick & 16 ? c->f[i] : 0;
        defs[i].flags = c->pick / 32 % 8 == 0 ? MSPRING_SPRING_PULL_ONLY : 0;
        defs[i].break_strain = c->pick & 256 ? 3.0f : MSPRING_NEVER;
    }
    const mspring_result result = mspring_network_add_springs(p->network, defs, count, ids);
    for (uint32_t i = 0; i < count; i++)
        if (result == MSPRING_OK)
            plain_add_spring(it, p->plain, ids[i], &defs[i]);
        else
            JUDGE(it, ids[i] == MSPRING_NONE);
    return result;
}

static mspring_result remove_particles(game *it, place *p, const call *c) {
    (void)it;
    const mspring_result result = mspring_network_remove_particles(p->network, c->particles, 0, c->count % 3);
    for (uint32_t i = 0; i < c->count % 3 && result == MSPRING_OK; i++)
        if (p->plain->has_particle[c->particles[i]])
            plain_remove_particle(p->plain, c->particles[i]);
    return result;
}

static mspring_result remove_springs(game *it, place *p, const call *c) {
    (void)it;
    const mspring_result result = mspring_network_remove_springs(p->network, c->springs, 0, c->count % 4);
    for (uint32_t i = 0; i < c->count % 4 && result == MSPRING_OK; i++)
        if (p->plain->has_spring[c->springs[i]])
            plain_remove_spring(p->plain, c->springs[i]);
    return result;
}

static mspring_result recycle(game *it, place *p, const call *c) {
    (void)it, (void)c;
    return mspring_network_reuse_ids(p->network);
}

static mspring_result set_stiffness(game *it, place *p, const call *c) {
    float values[MANY];
    (void)it;
    const bool is_list = c->pick & 1;
    for (int i = 0; i < MANY; i++)
        values[i] = 300 * c->f[i];
    const mspring_result result =
        is_list ? mspring_network_set(p->network, MSPRING_STIFFNESS, c->springs, 0, c->count, values, 1)
                : mspring_network_set(p->network, MSPRING_STIFFNESS, NULL, c->spring, c->count, values, 1);
    for (uint32_t i = 0; i < c->count && result == MSPRING_OK; i++) {
        const mspring_id id = is_list ? c->springs[i] : c->spring + i;
        if (p->plain->has_spring[id])
            p->plain->stiffness[id] = values[i];
    }
    return result;
}

static mspring_result set_rest_lengths(game *it, place *p, const call *c) {
    float values[MANY];
    (void)it;
    for (int i = 0; i < MANY; i++)
        values[i] = 0.6f + c->f[i];
    return c->pick & 1 ? mspring_network_set(p->network, MSPRING_REST_LENGTH, c->springs, 0, c->count, values, 1)
                       : mspring_network_set(p->network, MSPRING_REST_LENGTH, NULL, c->spring, c->count, values, 0);
}

// Any property, also one that is read only or of none.
static mspring_result set_any(game *it, place *p, const call *c) {
    static const mspring_property some[] = {MSPRING_DAMPING,       MSPRING_BREAK_STRAIN,   MSPRING_WARN_STRAIN,
                                            MSPRING_RELAX_STRAIN,  MSPRING_YIELD_STRAIN,   MSPRING_HARDENING,
                                            MSPRING_PLASTIC_LIMIT, MSPRING_PLASTIC_STRAIN, MSPRING_STRAIN,
                                            MSPRING_LENGTH,        MSPRING_TENSION,          (mspring_property)99};
    const mspring_property which = some[c->pick % COUNT_OF(some)];
    (void)it;
    return mspring_network_set(p->network, which, NULL, c->spring, c->count, c->f, c->pick / 256 % 2);
}

// Sent again and again, as by a host that sends all rest lengths in each frame.
static mspring_result send_all(game *it, place *p, const call *c) {
    static float values[MOST_SPRINGS];
    const uint32_t count = p->plain->springs;
    JUDGE(it, mspring_network_get(p->network, MSPRING_REST_LENGTH, NULL, 0, count, values, 1) == MSPRING_OK);
    for (mspring_id i = 0; i < count; i += 1 + c->pick % 256)
        values[i] *= c->pick & 1024 ? 1 : 1.01f;
    return mspring_network_set(p->network, MSPRING_REST_LENGTH, NULL, 0, count, values, 1);
}

const act acts_springs[] = {
    {"break_springs", break_springs, ACT_CALM | ACT_WHOLE | ACT_INSIDE},
    {"restore_springs", restore_springs, ACT_CALM | ACT_WHOLE | ACT_INSIDE},
    {"detach_particles", detach, ACT_CALM | ACT_WHOLE | ACT_INSIDE},
    {"cut", cut, ACT_CALM | ACT_WHOLE | ACT_INSIDE},
    {"add_particles", add_particles, ACT_WHOLE},
    {"add_springs", add_springs, ACT_WHOLE | ACT_INSIDE},
    {"remove_particles", remove_particles, ACT_WHOLE},
    {"remove_springs", remove_springs, ACT_WHOLE | ACT_INSIDE},
    {"recycle", recycle, ACT_WHOLE | ACT_INSIDE},
    {"set stiffness", set_stiffness, ACT_WHOLE | ACT_INSIDE},
    {"set rest length", set_rest_lengths, ACT_WHOLE | ACT_INSIDE},
    {"set", set_any, ACT_WHOLE | ACT_INSIDE},
    {"send all rest lengths", send_all, ACT_WHOLE | ACT_INSIDE},
};
const uint32_t acts_springs_count = COUNT_OF(acts_springs);

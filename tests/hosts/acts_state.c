/// @file acts_state.c
/// Calls that move particles or push them, and settings.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "plain.h"
#include "support.h"

/// Of a number from 0 to 1 one between low and high; numbers that are no such stay of their kind.
static float between(float number, float low, float high) {
    return low + (high - low) * number;
}

static void spread(const float *from, float low, float high, float *to) {
    for (int i = 0; i < MANY; i++)
        to[i] = between(from[i], low, high);
}

static mspring_result apply_force(game *it, place *p, const call *c) {
    (void)it;
    return mspring_network_apply_force(p->network, c->particle, between(c->f[0], -90, 90),
                                       between(c->f[1], -90, 90));
}

static mspring_result apply_forces(game *it, place *p, const call *c) {
    float force[MANY];
    (void)it;
    spread(c->f, -30, 30, force);
    return c->pick & 1
               ? mspring_network_apply_forces(p->network, MSPRING_PUSH_STEP, c->particles, 0, c->count / 2, force, force + 1, 2)
               : mspring_network_apply_forces(p->network, c->pick / 4 % 4 ? MSPRING_PUSH_STEP : MSPRING_PUSH_SUBSTEP, NULL, c->particle, c->count, force, force, c->pick / 2 % 2);
}

static mspring_result apply_impulses(game *it, place *p, const call *c) {
    float impulse[MANY];
    (void)it;
    spread(c->f, -3, 3, impulse);
    return c->pick & 1
               ? mspring_network_apply_forces(p->network, MSPRING_PUSH_IMPULSE, c->particles, 0, c->count, impulse, impulse, 1)
               : mspring_network_apply_forces(p->network, MSPRING_PUSH_IMPULSE, NULL, c->particle, c->count / 2, impulse, impulse + 1, 2);
}

// All particles around one fly away from it.
static mspring_result explode(game *it, place *p, const call *c) {
    mspring_id ids[64];
    double x[64], y[64], at[2];
    float impulse[2][64];
    uint32_t count = 0;
    const float strength = c->pick % 8 == 0 ? 300 : 12;
    const mspring_result result = mspring_network_get_positions(p->network, &c->particle, 0, 1, &at[0], &at[1], 1);
    if (result != MSPRING_OK)
        return result;
    if (mspring_network_particles_in_circle(p->network, at[0], at[1], 3, ids, 64, &count) != MSPRING_OK)
        return MSPRING_OK; // a place out of bounds
    count = count < 64 ? count : 64;
    JUDGE(it, mspring_network_get_positions(p->network, ids, 0, count, x, y, 1) == MSPRING_OK);
    for (uint32_t i = 0; i < count; i++) {
        const double dx = x[i] - at[0], dy = y[i] - at[1], r = sqrt(dx * dx + dy * dy) + 0.1;
        impulse[0][i] = (float)(dx / r / r) * strength, impulse[1][i] = (float)(dy / r / r) * strength;
    }
    return mspring_network_apply_forces(p->network, MSPRING_PUSH_IMPULSE, ids, 0, count, impulse[0], impulse[1], 1);
}

static mspring_result set_velocities(game *it, place *p, const call *c) {
    float v[MANY];
    (void)it;
    spread(c->f, -4, 4, v);
    return c->pick & 1 ? mspring_network_set_velocities(p->network, c->particles, 0, c->count, v, v, 1)
                       : mspring_network_set_velocities(p->network, NULL, c->particle, c->count, v, v, c->pick / 2 % 2);
}

// A little away from where they are: all forms of the call.
static mspring_result shift(game *it, place *p, const call *c) {
    double x[MANY], y[MANY];
    const uint32_t count = c->pick & 1 ? 1 : c->count;
    const bool is_list = c->pick & 2;
    const mspring_result result = is_list
                                      ? mspring_network_get_positions(p->network, c->particles, 0, count, x, y, 1)
                                      : mspring_network_get_positions(p->network, NULL, c->particle, count, x, y, 1);
    if (result != MSPRING_OK)
        return result;
    for (uint32_t i = 0; i < count; i++) {
        x[i] += (c->d[i] - 0.5) * 0.2, y[i] += (c->d[MANY - 1 - i] - 0.5) * 0.2;
    }
    (void)it;
    return is_list ? mspring_network_set_positions(p->network, c->particles, 0, count, x, y, 1)
                   : mspring_network_set_positions(p->network, NULL, c->particle, count, x, y, 1);
}

// All of it, to somewhere else: near or far.
static mspring_result teleport(game *it, place *p, const call *c) {
    static double x[MOST_PARTICLES], y[MOST_PARTICLES];
    static const double far[] = {1, 40, 1e4, 1e6};
    const double by = (c->d[0] - 0.5) * far[c->pick % 4];
    JUDGE(it, mspring_network_get_positions(p->network, NULL, 0, p->plain->particles, x, y, 1) == MSPRING_OK);
    for (uint32_t i = 0; i < p->plain->particles; i++)
        x[i] += by, y[i] += by / 4;
    return mspring_network_set_positions(p->network, NULL, 0, p->plain->particles, x, y, 1);
}

static mspring_result kick_one(game *it, place *p, const call *c) {
    (void)it;
    const float vx = 0.01f * (float)(c->pick % 16), vy = (float)(c->pick % 8) - 4;
    if (c->particle >= p->plain->particles || !p->plain->has_particle[c->particle])
        return MSPRING_OK;
    return mspring_network_set_velocities(p->network, &c->particle, 0, 1, &vx, &vy, 1);
}

static mspring_result wake(game *it, place *p, const call *c) {
    (void)it, (void)c;
    return mspring_network_wake(p->network);
}

static mspring_result set_settings(game *it, place *p, const call *c) {
    mspring_settings settings = {.struct_size = sizeof settings};
    JUDGE(it, mspring_network_get_settings(p->network, &settings) == MSPRING_OK);
    switch (c->pick % 8) {
    case 0:
        settings.guard = c->pick / 8 % 2 ? MSPRING_GUARD_CLAMP : (mspring_guard)(c->pick / 16 % 7);
        break;
    case 1:
        settings.gravity_x = between(c->f[0], -4, 4);
        break;
    case 2:
        settings.gravity_y = c->pick & 8 ? -9.8f : between(c->f[0], -12, 4);
        break;
    case 3:
        settings.global_damping = c->pick & 8 ? 0 : c->f[0];
        break;
    case 4:
        settings.max_speed = c->pick & 8 ? 1e6f : between(c->f[0], 20, 400);
        break;
    case 5:
        settings.sleep_speed = c->pick & 8 ? 0.1f * c->f[0] : 0;
        break;
    case 6:
        settings.sleep_time = c->f[0];
        break;
    default:
        settings.relax_fraction = c->f[0];
    }
    return mspring_network_set_settings(p->network, &settings);
}

static mspring_result set_solver(game *it, place *p, const call *c) {
    mspring_settings def = {.struct_size = sizeof def};
    JUDGE(it, mspring_network_get_settings(p->network, &def) == MSPRING_OK);
    if (c->pick & 1) {
        JUDGE(it, mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def) == MSPRING_OK);
        def.solver = c->pick / 2 % 4 < 2 ? MSPRING_SOLVER_EXPLICIT : (mspring_solver)(c->pick / 2 % 4 - 1);
        def.integrator = (mspring_integrator)(c->pick / 8 % 3);
        def.iterations = c->pick / 32 % 2 ? c->count : 0;
        def.tile_size = c->pick / 64 % 2 ? 8u << c->pick / 128 % 6 : 0;
        def.residual = c->pick / 1024 % 2 ? 0.1f * c->f[0] : 0.01f;
    }
    def.substeps = c->pick & 4096   ? MSPRING_SUBSTEPS_AUTO
                   : c->pick & 8192 ? MSPRING_SUBSTEPS_EVEN
                                    : 1 + c->pick / 16384;
    def.max_substeps = 40;
    def.most_work = c->pick / 256 % 16 ? 4 : c->count;
    return support_set_solver(p->network, &def);
}

static mspring_result set_mass(game *it, place *p, const call *c) {
    float mass[MANY];
    (void)it;
    spread(c->f, 0.2f, 3, mass);
    const bool is_list = c->pick & 1;
    const mspring_result result =
        is_list ? mspring_network_set(p->network, MSPRING_MASS, c->particles, 0, c->count, mass, 1)
                : mspring_network_set(p->network, MSPRING_MASS, NULL, c->particle, c->count, mass, 0);
    for (uint32_t i = 0; i < c->count && result == MSPRING_OK; i++) {
        const mspring_id id = is_list ? c->particles[i] : c->particle + i;
        if (p->plain->has_particle[id])
            p->plain->mass[id] = mass[is_list ? i : 0];
    }
    return result;
}

static mspring_result set_scale(game *it, place *p, const call *c) {
    static const float scales[] = {1, 1, 1, 0, 0.5f, 1e-6f, 2, -1};
    (void)it;
    return mspring_network_set(p->network, MSPRING_INVERSE_MASS_SCALE, NULL, c->particle, 1, &scales[c->pick % 8], 0);
}

static mspring_result set_floor(game *it, place *p, const call *c) {
    static const float heights[] = {0, 1, 0.5f, -1, 0, 2, 0, 0}, frictions[] = {0, 1, 0.5f, 0, 0.2f, 1, 1, 1};
    const double planes[3][4] = {{0, -2, 0.01 * c->count, 1}, {-20, 0, 1, 0}, {60, 0, -1, 0}};
    mspring_floor_def def;
    JUDGE(it, mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def) == MSPRING_OK);
    def.planes = &planes[0][0];
    def.plane_count = c->pick % 4;
    def.heights = heights;
    def.height_count = c->pick / 4 % 2 ? 8 : 0;
    def.heights_x = -10, def.heights_y = -2, def.spacing = 8;
    def.friction = c->pick / 8 % 2 ? c->f[0] : 0;
    def.restitution = c->pick / 16 % 4 ? 0 : c->f[1];
    def.height_frictions = c->pick / 64 % 2 ? frictions : NULL;
    def.plane_restitutions = c->pick / 128 % 2 ? frictions : NULL;
    def.silt_depth = c->pick / 256 % 4 ? 0 : 2 * c->f[2], def.silt_rate = 8 * c->f[3];
    def.silt_depths = c->pick / 256 % 4 == 1 ? frictions : NULL;
    return mspring_network_set_floor(p->network, c->pick % 32 == 31 ? NULL : &def);
}

const act acts_state[] = {
    {"apply_force", apply_force, ACT_CALM | ACT_WHOLE},
    {"apply_forces", apply_forces, ACT_CALM | ACT_WHOLE},
    {"apply_impulses", apply_impulses, ACT_CALM | ACT_WHOLE},
    {"explode", explode, ACT_CALM | ACT_WHOLE},
    {"set_velocities", set_velocities, ACT_CALM | ACT_WHOLE},
    {"set_positions", shift, ACT_CALM | ACT_WHOLE},
    {"teleport", teleport, ACT_CALM | ACT_WHOLE},
    {"kick one", kick_one, ACT_CALM | ACT_WHOLE},
    {"wake", wake, ACT_CALM | ACT_WHOLE | ACT_INSIDE},
    {"set_settings", set_settings, ACT_CALM | ACT_WHOLE},
    {"set mass", set_mass, ACT_CALM | ACT_WHOLE},
    {"set inverse mass scale", set_scale, ACT_CALM | ACT_WHOLE},
    {"set_solver", set_solver, 0},
    {"set_floor", set_floor, ACT_SETUP},
};
const uint32_t acts_state_count = COUNT_OF(acts_state);

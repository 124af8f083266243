/// @file acts_contact.c
/// Contact, colliders and grips.
///
/// SPDX-License-Identifier: MIT
#include "plain.h"
#include "support.h"

static mspring_result set_contact(game *it, place *p, const call *c) {
    mspring_contact_def def;
    JUDGE(it, mspring_init(MSPRING_STRUCT_CONTACT_DEF, &def, sizeof def) == MSPRING_OK);
    def.flags = c->pick & 1 ? MSPRING_CONTACT_SELF : 0;
    def.thickness = c->pick & 2 ? 0.3 * c->d[0] : 0.1;
    def.friction = c->pick & 4 ? c->f[0] : 0;
    def.restitution = c->pick & 8 ? c->f[1] : 0;
    def.sweeps = 1 + c->pick / 16 % 8;
    def.capacity = c->pick & 128 ? 1 + c->pick / 256 % 64 : 0; // little, so that it grows
    return mspring_network_set_contact(p->network, c->pick / 1024 % 8 == 0 ? NULL : &def);
}

static mspring_result set_who_touches(game *it, place *p, const call *c) {
    (void)it;
    const float own = c->pick & 4 ? -1 : c->f[0];
    if (c->pick & 1)
        return mspring_network_set(p->network, c->pick & 2 ? MSPRING_FRICTION : MSPRING_RESTITUTION, NULL, c->particle,
                                   c->count, &own, 0);
    return support_set_layers(p->network, c->particle, c->count, c->pick / 2, c->pick / 4 | 1);
}

static mspring_result read_contact(game *it, place *p, const call *c) {
    mspring_contact_info info = {.struct_size = sizeof info};
    mspring_contact_def def = {.struct_size = sizeof def};
    (void)c;
    JUDGE(it, mspring_network_get_contact(p->network, &def) == MSPRING_OK);
    const mspring_result result = mspring_network_get_contact_info(p->network, &info);
    JUDGE(it, info.deepest >= 0);
    JUDGE(it, def.capacity > 0 || info.pairs == 0);
    return result;
}

static mspring_result reserve_contact_events(game *it, place *p, const call *c) {
    (void)it;
    return support_reserve_contact_events(p->network, c->pick % 4 ? c->pick / 4 % 256 : 0);
}

static mspring_result read_contact_events(game *it, place *p, const call *c) {
    mspring_contact_event events[16];
    uint32_t count = 0;
    uint64_t lost = 0;
    for (int i = 0; i < 16; i++)
        events[i].struct_size = sizeof events[i];
    const mspring_result result =
        mspring_network_read_contact_events(p->network, events, c->pick % 17, &count, &lost);
    JUDGE(it, count <= c->pick % 17);
    for (uint32_t i = 0; i < count; i++) {
        JUDGE(it, events[i].point == MSPRING_NONE || events[i].point < p->plain->particles);
        JUDGE(it, events[i].a <= events[i].b && events[i].impulse >= 0);
        game_log(&it->events_log, &events[i].point, 3 * sizeof events[i].point);
        game_log(&it->events_log, &events[i].impulse, sizeof events[i].impulse);
    }
    it->counts.events += count;
    return result;
}

/* ---------------------------------------------------------------------------------------------- colliders */

static mspring_result add_collider(game *it, place *p, const call *c) {
    const double points[4][2] = {{-12, -3}, {4, -4 + c->d[0]}, {20, -3}, {40, 1}};
    mspring_collider_def def;
    JUDGE(it, mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def) == MSPRING_OK);
    def.kind = (mspring_collider_kind)(c->pick % 3);
    def.x = 20 * (c->d[1] - 0.2), def.y = -4 - c->d[2];
    def.angle = c->pick & 8 ? c->d[3] : 0;
    if (def.kind == MSPRING_COLLIDER_CHAIN) {
        def.points = &points[0][0], def.point_count = 4, def.x = def.y = 0;
        def.flags = c->pick / 16 % 4 ? 0 : MSPRING_COLLIDER_CLOSED;
    } else if (def.kind == MSPRING_COLLIDER_BOX) {
        def.width = 1 + 9 * c->d[4], def.height = 1 + c->d[5];
    } else {
        def.radius = 0.5 + c->d[4];
    }
    def.friction = c->f[0], def.restitution = c->pick & 64 ? c->f[1] : 0;
    return mspring_network_add_collider(p->network, &def, NULL);
}

static mspring_result move_collider(game *it, place *p, const call *c) {
    mspring_collider_def def = {.struct_size = sizeof def};
    const mspring_id id = c->pick % 6;
    (void)it;
    const mspring_result result = mspring_network_get_collider(p->network, id, &def);
    if (result != MSPRING_OK)
        return result;
    const double x = def.x + c->d[0] - 0.5, y = def.y + (c->d[1] - 0.5) / 2, angle = def.angle + c->d[2] - 0.5;
    return c->pick / 8 % 8 ? mspring_network_move_collider(p->network, id, x, y, angle)
                           : mspring_network_place_collider(p->network, id, x + 2, y, angle);
}

static mspring_result remove_collider(game *it, place *p, const call *c) {
    (void)it;
    return mspring_network_remove_collider(p->network, c->pick % 8);
}

static mspring_result read_collider(game *it, place *p, const call *c) {
    double impulse[3] = {0};
    const mspring_result result =
        mspring_network_get_collider_impulse(p->network, c->pick % 6, &impulse[0], &impulse[1], &impulse[2]);
    JUDGE(it, impulse[0] - impulse[0] == 0 && impulse[1] - impulse[1] == 0 && impulse[2] - impulse[2] == 0);
    return result;
}

/* ------------------------------------------------------------------------------------------------- grips */

static mspring_grip_def draw_grip(game *it, const place *p, const call *c) {
    mspring_grip_def def;
    double x = 0, y = 0;
    JUDGE(it, mspring_init(MSPRING_STRUCT_GRIP_DEF, &def, sizeof def) == MSPRING_OK);
    def.particle = c->particle;
    if (mspring_network_get_positions(p->network, NULL, c->particle, 1, &x, &y, 1) == MSPRING_OK)
        def.x = x + 2 * (c->d[0] - 0.5), def.y = y + c->d[1];
    def.stiffness = 200 * c->f[0], def.damping = 10 * c->f[1];
    def.max_force = c->pick & 1 ? 50 * c->f[2] : MSPRING_NEVER;
    return def;
}

static mspring_result add_grip(game *it, place *p, const call *c) {
    const mspring_grip_def def = draw_grip(it, p, c);
    mspring_id grip = MSPRING_NONE;
    const mspring_result result = mspring_network_add_grip(p->network, &def, &grip);
    if (result == MSPRING_OK)
        game_log(&it->log, &grip, sizeof grip);
    return result;
}

static mspring_result change_grip(game *it, place *p, const call *c) {
    mspring_grip_def def = {.struct_size = sizeof def};
    const mspring_id id = c->pick % 16;
    const mspring_result result = mspring_network_get_grip(p->network, id, &def);
    if (result != MSPRING_OK)
        return result;
    JUDGE(it, support_has_particle(p->network, def.particle));
    if (c->pick / 16 % 4 == 0)
        def = draw_grip(it, p, c);
    return c->pick / 16 % 4 < 2
               ? mspring_network_set_grip(p->network, id, &def)
               : mspring_network_move_grip(p->network, id, def.x + c->d[0] - 0.5, def.y + c->d[1] - 0.5);
}

static mspring_result remove_grip(game *it, place *p, const call *c) {
    (void)it;
    return mspring_network_remove_grip(p->network, c->pick % 16);
}

static mspring_result read_grip(game *it, place *p, const call *c) {
    double impulse[2] = {0, 0};
    const mspring_result result =
        mspring_network_get_grip_impulse(p->network, c->pick % 16, &impulse[0], &impulse[1]);
    JUDGE(it, impulse[0] - impulse[0] == 0 && impulse[1] - impulse[1] == 0);
    return result;
}

const act acts_contact[] = {
    {"set_contact", set_contact, ACT_SETUP},
    {"set_contact_groups", set_who_touches, ACT_INSIDE},
    {"read contact", read_contact, ACT_READS},
    {"reserve_contact_events", reserve_contact_events, ACT_INSIDE | ACT_SETUP},
    {"read_contact_events", read_contact_events, ACT_READS},
    {"add_collider", add_collider, ACT_SETUP},
    {"move_collider", move_collider, 0},
    {"remove_collider", remove_collider, 0},
    {"get_collider_impulse", read_collider, ACT_READS},
    {"add_grip", add_grip, ACT_CALM | ACT_WHOLE},
    {"change grip", change_grip, ACT_CALM | ACT_WHOLE},
    {"remove_grip", remove_grip, ACT_CALM | ACT_WHOLE},
    {"get_grip_impulse", read_grip, ACT_READS},
};
const uint32_t acts_contact_count = COUNT_OF(acts_contact);

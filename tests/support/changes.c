/// @file changes.c
///
/// SPDX-License-Identifier: MIT
#include "changes.h"

#include "support.h"

void change_push(mspring_network *network, mspring_id particle, mspring_id spring) {
    (void)spring;
    check_ok(mspring_network_apply_force(network, particle, 10, 0));
}

void change_shift(mspring_network *network, mspring_id particle, mspring_id spring) {
    (void)spring;
    const support_point at = support_position(network, particle);
    const double x = at.x + 0.01;
    check_ok(mspring_network_set_positions(network, NULL, particle, 1, &x, &at.y, 1));
}

static void kick(mspring_network *network, mspring_id particle, mspring_id spring) {
    (void)spring;
    const float vx = 1, vy = 0.3f;
    check_ok(mspring_network_set_velocities(network, NULL, particle, 1, &vx, &vy, 1));
}

void change_write_view(mspring_network *network, mspring_id particle, mspring_id spring) {
    (void)spring;
    support_shift(network, particle, 0, 0.01);
}

void change_fill(mspring_network *network, mspring_id particle, mspring_id spring) {
    (void)spring;
    const float mass = 5;
    check_ok(mspring_network_set(network, MSPRING_MASS, NULL, particle, 1, &mass, 1));
}

static void pin(mspring_network *network, mspring_id particle, mspring_id spring) {
    (void)spring;
    const float scale = 0;
    check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, particle, 1, &scale, 1));
}

static void soften(mspring_network *network, mspring_id particle, mspring_id spring) {
    (void)particle;
    const float stiffness = 500;
    check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, spring, 1, &stiffness, 1));
}

static void lengthen(mspring_network *network, mspring_id particle, mspring_id spring) {
    (void)particle;
    const float rest_length = 1.1f;
    check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, spring, 1, &rest_length, 1));
}

void change_break(mspring_network *network, mspring_id particle, mspring_id spring) {
    (void)particle;
    check_ok(mspring_network_break_springs(network, &spring, 0, 1));
}

static void detach(mspring_network *network, mspring_id particle, mspring_id spring) {
    (void)spring;
    check_ok(mspring_network_detach_particles(network, &particle, 0, 1));
}

static void watch(mspring_network *network, mspring_id particle, mspring_id spring) {
    (void)particle;
    const float strain = 0.5f;
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, spring, 1, &strain, 1));
}

const change changes[CHANGE_COUNT] = {
    {"push", change_push},   {"shift", change_shift},
    {"kick", kick},          {"write to a view", change_write_view},
    {"fill", change_fill},   {"pin", pin},
    {"soften", soften},      {"lengthen", lengthen},
    {"break", change_break}, {"detach", detach},
    {"watch", watch},
};

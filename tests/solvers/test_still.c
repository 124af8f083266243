/// @file test_still.c
/// Implicit motion that dies away: at last its numbers are near the least that there are, and steps go on.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "recipe.h"
#include "support.h"

enum { STEPS = 400 };

typedef struct trial {
    mspring_solver solver;
    double mass, stiffness, ratio, dt; ///< ratio: of the last mass to the others
    bool has_contact, has_grip;
} trial;

/// A bent rope of three, two of them pinned, with an angle spring.
static mspring_network *bent_rope(const trial *t) {
    mspring_builder *builder = support_builder();
    mspring_network_def def = support_def(0, 3);
    mspring_id ids[3];
    for (uint32_t i = 0; i < 3; i++) {
        const float mass = (float)(i == 2 ? t->ratio * t->mass : t->mass);
        ids[i] = i < 2 ? support_pinned(builder, i, 0, mass) : support_particle(builder, i, 0, mass);
    }
    for (uint32_t i = 0; i < 2; i++)
        support_spring(builder, ids[i], ids[i + 1], (float)t->stiffness, 0);
    def.settings.solver = t->solver;
    mspring_network *network = support_network(builder, &def);
    mspring_angle_def angle;
    check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &angle, sizeof angle));
    angle.stiffness = (float)(0.1 * t->stiffness);
    check_ok(mspring_network_add_angles(network, &angle, ids, 1, 3, NULL));
    support_kick(network, 2, 0.2f);
    return network;
}

static void add_others(mspring_network *network, const trial *t) {
    mspring_contact_def contact;
    mspring_grip_def grip;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.12;
    if (t->has_contact)
        check_ok(mspring_network_set_contact(network, &contact));
    check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &grip, sizeof grip));
    grip.particle = 2;
    grip.x = 2;
    grip.stiffness = (float)t->stiffness;
    if (t->has_grip)
        check_ok(mspring_network_add_grip(network, &grip, NULL));
}

static void steps_are_taken_until_nothing_moves(void **state) {
    (void)state;
    static const double masses[] = {1e-9, 1, 1e9}, ratios[] = {1e-3, 1, 1e3}, steps[] = {1, 6, 40};
    for (uint32_t i = 0; i < 3 * 3 * 3 * 8; i++) {
        const double mass = masses[i % 3], stiffness = 210 * mass;
        trial t = {.mass = mass, .stiffness = stiffness, .ratio = ratios[i / 3 % 3]};
        t.dt = 3 * 0.07 * steps[i / 9 % 3] * (t.ratio > 1 ? sqrt(t.ratio) : 1);
        t.solver = i / 27 % 2 ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT;
        t.has_contact = i / 54 % 2;
        t.has_grip = i / 108 % 2;
        mspring_network *network = bent_rope(&t);
        add_others(network, &t);
        support_steps(network, STEPS, t.dt);
        mspring_network_destroy(network);
    }
}

/// A large body that fell asleep leaves nothing in the solutions of another one: a network that was brought to where this
/// one is, and has no past, goes on with the same bits.
static void sleepers_leave_no_sums(void **state) {
    (void)state;
    enum { AWAKE = 6 * 3 };
    uint64_t seed = 2;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {1e5, 2e5}};
    recipe made = {0};
    recipe_lattice(&made, 40, 30, 0, 0, 1, &stuff, &seed);
    recipe_lattice(&made, 6, 3, 0, 90, 1, &stuff, &seed);
    recipe_disturb(&made, 2e-4, 0.05, &seed);
    mspring_network_def def = support_def(0, 1);
    def.settings.solver = MSPRING_SOLVER_IMPLICIT;
    def.settings.sleep_speed = 0.2f, def.settings.sleep_time = 0.05f;
    mspring_network *network = recipe_network(&made, &def), *other = recipe_network(&made, &def);
    const mspring_id first = made.particle_count - AWAKE;
    for (int step = 0; step < 20; step++) {
        support_kick(network, first, step % 2 ? 1 : -1);
        support_steps(network, 1, 1.0 / 64);
    }
    assert_true(support_sleeps(network, 0) && !support_sleeps(network, first));
    support_bring(network, other, MSPRING_SNAPSHOT_ALL);
    for (int step = 0; step < 10; step++) {
        support_steps(network, 1, 1.0 / 64);
        support_steps(other, 1, 1.0 / 64);
        assert_true(support_hash(network) == support_hash(other));
    }
    mspring_network_destroy(other);
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(steps_are_taken_until_nothing_moves),
                                       cmocka_unit_test(sleepers_leave_no_sums)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

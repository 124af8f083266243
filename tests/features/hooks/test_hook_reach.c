/// @file test_hook_reach.c
/// Hooks with MSPRING_HOOK_BELOW: they do what they would do if they were called for all slots, and are not called
/// where nothing can come below.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "recipe.h"
#include "support.h"

static const double dt = 1.0 / 64;

/// The host's ground: what comes below it is pushed up, or thrown back.
typedef struct ground {
    double y;
    uint32_t calls, slots, below;
} ground;

static void act(const mspring_hook_args *args, void *user) {
    ground *self = user;
    self->calls++;
    self->slots += args->slot_count;
    for (uint32_t i = args->first_slot; i < args->first_slot + args->slot_count; i++) {
        const double depth = self->y - (args->origin_y + (double)args->y[i]);
        if (!(depth > 0) || args->particle_of_slot[i] == MSPRING_NONE) {
            continue;
        }
        self->below++;
        if (args->force_y) {
            args->force_y[i] += 40.0f * (float)fmin(depth, 10.0);
        }
        if (args->phase == MSPRING_PHASE_AFTER_SUBSTEP) {
            args->vy[i] = fabsf(args->vy[i]) * 0.5f;
            args->vx[i] *= 0.9f;
        }
    }
}

/// The same without counting, for concurrent calls.
static void act_alone(const mspring_hook_args *args, void *user) {
    ground own = *(const ground *)user;
    act(args, &own);
}

typedef struct kind {
    mspring_phase phase;
    uint32_t period, flags;
} kind;

static const kind kinds[] = {
    {MSPRING_PHASE_AFTER_SUBSTEP, 1, 0},  {MSPRING_PHASE_AFTER_SUBSTEP, 3, MSPRING_HOOK_CONCURRENT},
    {MSPRING_PHASE_BEFORE_SUBSTEP, 1, 0}, {MSPRING_PHASE_BEFORE_SUBSTEP, 3, MSPRING_HOOK_CONCURRENT},
    {MSPRING_PHASE_BEFORE_STEP, 1, 0},
};

static void add_ground(mspring_network *network, const kind *k, ground *to, uint32_t more_flags) {
    mspring_hook_def def;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def));
    def.phase = k->phase;
    def.period = k->period;
    def.flags = k->flags | more_flags;
    def.range_slots = 48;
    def.fn = k->flags ? act_alone : act;
    def.user = to;
    def.below_y = to->y;
    check_ok(mspring_network_add_hook(network, &def, NULL));
}

/* -------------------------------------------------------------------------------------------------------- scenes
 */

/// Rows of every kind, y above the ground.
static mspring_network *falling(double x, double y, float vy, mspring_solver solver, uint32_t workers) {
    uint64_t seed = 8;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {300, 400}, .damping = {1, 2}};
    recipe made = {0};
    recipe_lattice(&made, 40, 12, x, y, 1, &stuff, &seed);
    const mspring_id end = recipe_particle(&made, x + 45, y + 9, 1, 0);
    recipe_rope(&made, 2, end, 9, &stuff, &seed);
    recipe_random_springs(&made, 8, &stuff, &seed);
    for (uint32_t i = 0; i < 40; i++) {
        recipe_particle(&made, x - 3 + i, y + 5 + i % 3, 1, 0);
    }
    recipe_disturb(&made, 0.05, 0.5, &seed);
    for (uint32_t p = 0; p < made.particle_count; p++) {
        made.particles[p].vy += vy;
    }
    mspring_network_def def = support_def(-9.8f, solver == MSPRING_SOLVER_EXPLICIT ? 10 : 2);
    def.settings.solver = solver;
    def.worker_count = workers;
    def.spare_particles = 40;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

static uint64_t hash_of(const mspring_network *network) {
    uint64_t hash = 0;
    check_ok(mspring_network_get_state_hash(network, &hash));
    return hash;
}

/// Both go on bit by bit alike.
static void check_alike(mspring_network *plain, mspring_network *reaching, int steps) {
    for (int step = 0; step < steps; step++) {
        support_steps(plain, 1, dt);
        support_steps(reaching, 1, dt);
        assert_true(hash_of(plain) == hash_of(reaching));
    }
}

/// From above it into it, slowly and fast, near the world's origin and far from it, in all phases, by several
/// workers.
static void it_is_as_if_called_for_all(void **state) {
    (void)state;
    const struct {
        double x, y, above;
        float vy;
    } starts[] = {{0, 0, 2, 0}, {-9e6, 8e6, 3, -20}, {3e4, -2e5, 1000, -3000}, {0, 1e3, -4, 0}};
    for (size_t i = 0; i < COUNT_OF(starts); i++) {
        for (size_t k = 0; k < COUNT_OF(kinds); k++) {
            for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_IMPLICIT; solver++) {
                const double y = starts[i].y + starts[i].above;
                ground all = {.y = starts[i].y}, some = all;
                mspring_network *plain = falling(starts[i].x, y, starts[i].vy, solver, 1);
                mspring_network *reaching = falling(starts[i].x, y, starts[i].vy, solver, 1 + k % 2);
                add_ground(plain, &kinds[k], &all, 0);
                add_ground(reaching, &kinds[k], &some, MSPRING_HOOK_BELOW);
                check_alike(plain, reaching, 60);
                if (!kinds[k].flags) {
                    assert_true(all.below == some.below && some.below > 0);
                    assert_true(some.slots < all.slots);
                }
                mspring_network_destroy(plain);
                mspring_network_destroy(reaching);
            }
        }
    }
}

/// Beside a floor, contact and a hook that is called in each substep, by which steps are cut.
static void others_make_no_difference(void **state) {
    (void)state;
    for (size_t k = 0; k < COUNT_OF(kinds); k++) {
        for (uint32_t others = 1; others < 8; others++) {
            ground all = {.y = 0}, some = all, high[2] = {{.y = -1e6}, {.y = -1e6}};
            mspring_network *networks[2] = {falling(0, 2, -3, MSPRING_SOLVER_EXPLICIT, 1),
                                            falling(0, 2, -3, MSPRING_SOLVER_EXPLICIT, 1)};
            for (int n = 0; n < 2; n++) {
                if (others & 1) {
                    add_ground(networks[n], &kinds[(k + 2) % COUNT_OF(kinds)], &high[n], 0);
                }
                add_ground(networks[n], &kinds[k], n == 0 ? &all : &some, n == 0 ? 0 : MSPRING_HOOK_BELOW);
                if (others & 2) {
                    const double plane[4] = {0, -2, 0, 1};
                    mspring_floor_def def;
                    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
                    def.planes = plane;
                    def.plane_count = 1;
                    check_ok(mspring_network_set_floor(networks[n], &def));
                }
                if (others & 4) {
                    mspring_contact_def def;
                    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &def, sizeof def));
                    def.flags = MSPRING_CONTACT_SELF;
                    check_ok(mspring_network_set_contact(networks[n], &def));
                }
            }
            check_alike(networks[0], networks[1], 40);
            mspring_network_destroy(networks[0]);
            mspring_network_destroy(networks[1]);
        }
    }
}

/// A compressed spring throws its ends apart from rest, in one step through the ground far below.
static void what_springs_throw_is_found(void **state) {
    (void)state;
    for (size_t k = 0; k + 1 < COUNT_OF(kinds); k++) {
        mspring_network *networks[2];
        ground grounds[2] = {{.y = 0}, {.y = 0}};
        for (int n = 0; n < 2; n++) {
            mspring_builder *builder = support_builder();
            const mspring_id a = support_particle(builder, 0, 500, 1), b = support_particle(builder, 0, 499.9, 1);
            mspring_spring_def spring;
            check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
            spring.a = a;
            spring.b = b;
            spring.stiffness = 2e4f;
            spring.rest_length = 1000;
            check_ok(mspring_builder_add_springs(builder, &spring, 1, NULL));
            mspring_network_def def = support_def(-9.8f, 30);
            def.settings.max_speed = 1e9f;
            networks[n] = support_network(builder, &def);
            add_ground(networks[n], &kinds[k], &grounds[n], n == 0 ? 0 : MSPRING_HOOK_BELOW);
        }
        support_steps(networks[0], 1, dt);
        support_steps(networks[1], 1, dt);
        assert_true(hash_of(networks[0]) == hash_of(networks[1]));
        if (!kinds[k].flags) {
            assert_true(grounds[0].below == grounds[1].below && grounds[1].below > 0);
        }
        check_alike(networks[0], networks[1], 20);
        mspring_network_destroy(networks[0]);
        mspring_network_destroy(networks[1]);
    }
}

/// A body that flies off a ball which it touches, and far away two particles at rest that a spring throws apart,
/// one of them into the ground.
static mspring_network *flying_off(double overlap, float speed) {
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {2000, 2000}, .damping = {1, 1}};
    uint64_t seed = 1;
    recipe made = {0};
    recipe_lattice(&made, 3, 3, 0, 20, 1, &stuff, &seed);
    for (uint32_t p = 0; p < made.particle_count; p++) {
        made.particles[p].vy = speed;
    }
    mspring_builder *builder = recipe_builder(&made, NULL);
    recipe_free(&made);
    const mspring_id a = support_particle(builder, 100, 1, 1), b = support_particle(builder, 100, 1.1, 1);
    mspring_spring_def spring;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
    spring.a = a;
    spring.b = b;
    spring.stiffness = 2e4f;
    spring.rest_length = 20;
    check_ok(mspring_builder_add_springs(builder, &spring, 1, NULL));
    const mspring_network_def def = support_def(-9.8f, 100);
    mspring_network *network = support_network(builder, &def);
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.2;
    check_ok(mspring_network_set_contact(network, &contact));
    mspring_collider_def ball;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &ball, sizeof ball));
    ball.kind = MSPRING_COLLIDER_CIRCLE;
    ball.radius = 0.5;
    ball.x = 1;
    ball.y = 20 - 0.5 - 0.2 + overlap;
    check_ok(mspring_network_add_collider(network, &ball, NULL));
    return network;
}

/// Contact begins a step anew that is repeated as a hook was thought to be out of reach. At the end of the first
/// run nothing was near any more.
static void contact_begins_anew(void **state) {
    (void)state;
    for (int round = 0; round < 10; round++) {
        mspring_network *networks[2];
        ground grounds[2] = {{.y = 0}, {.y = 0}};
        for (int n = 0; n < 2; n++) {
            networks[n] = flying_off(0.01 * (1 + round), 10.0f * (float)(1 + round));
            add_ground(networks[n], &kinds[2 * (round % 2)], &grounds[n], n == 0 ? 0 : MSPRING_HOOK_BELOW);
        }
        check_alike(networks[0], networks[1], 3);
        // Contact may repeat a step that the hook repeats in the other network, where it is called once.
        assert_true(grounds[0].below >= grounds[1].below && grounds[1].below > 0);
        mspring_network_destroy(networks[0]);
        mspring_network_destroy(networks[1]);
    }
}

/* -------------------------------------------------------------------------------------------------------- looking
 */

/// By particle: whether the hook before was called for it in this substep.
typedef struct coverage {
    double y;
    uint8_t is_covered[4096];
    uint32_t missed, found;
} coverage;

static void cover(const mspring_hook_args *args, void *user) {
    coverage *self = user;
    assert_true(args->first_slot % 16 == 0 && args->slot_count % 16 == 0 && args->slot_count > 0);
    for (uint32_t i = args->first_slot; i < args->first_slot + args->slot_count; i++) {
        if (args->particle_of_slot[i] != MSPRING_NONE) {
            assert_int_equal(self->is_covered[args->particle_of_slot[i]], 0);
            self->is_covered[args->particle_of_slot[i]] = 1;
        }
    }
}

static void check_covered(const mspring_hook_args *args, void *user) {
    coverage *self = user;
    for (uint32_t i = args->first_slot; i < args->first_slot + args->slot_count; i++) {
        const uint32_t p = args->particle_of_slot[i];
        if (p == MSPRING_NONE || !(args->origin_y + (double)args->y[i] < self->y)) {
            continue;
        }
        self->found++;
        self->missed += !self->is_covered[p];
    }
    memset(self->is_covered, 0, sizeof self->is_covered);
}

/// Loose and spare particles at any speed, which are added, removed and thrown by the host, and fall asleep.
static void nobody_below_is_missed(void **state) {
    (void)state;
    uint64_t seed = 31;
    for (int round = 0; round < 12; round++) {
        const double far = round % 3 * 4e6;
        mspring_builder *builder = support_builder();
        for (uint32_t i = 0; i < 300; i++) {
            support_particle(builder, far + support_random_between(&seed, -50, 50),
                             far + support_random_between(&seed, -3, 200), 1);
        }
        for (uint32_t i = 0; i < 100; i++) {
            support_spring(builder, i, (i + 7) % 100, 20, 1);
        }
        mspring_network_def def = support_def(-9.8f, 8);
        def.spare_particles = 100;
        def.settings.sleep_speed = round % 2 ? 3.0f : 0.0f;
        def.settings.sleep_time = 0.02f;
        def.settings.guard = MSPRING_GUARD_CLAMP_BOUNDS;
        mspring_network *network = support_network(builder, &def);
        coverage seen = {.y = far};
        mspring_hook_def hook;
        check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &hook, sizeof hook));
        hook.phase = MSPRING_PHASE_AFTER_SUBSTEP;
        hook.flags = MSPRING_HOOK_BELOW;
        hook.below_y = seen.y;
        hook.fn = cover;
        hook.user = &seen;
        check_ok(mspring_network_add_hook(network, &hook, NULL));
        check_ok(support_add_hook(network, MSPRING_PHASE_AFTER_SUBSTEP, check_covered, &seen, NULL));
        for (int step = 0; step < 60; step++) {
            const mspring_id p = (mspring_id)(support_random(&seed) % 300);
            const float speed = (float)pow(10, support_random_between(&seed, 0, 5));
            const float vx = (float)support_random_between(&seed, -1, 1) * speed, vy = -speed;
            check_ok(mspring_network_set_velocities(network, NULL, p, 1, &vx, &vy, 1));
            if (step % 4 == 0) {
                mspring_particle_def more;
                mspring_id id;
                check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &more, sizeof more));
                more.x = far;
                more.y = far + support_random_between(&seed, -20, 20);
                check_ok(mspring_network_add_particles(network, &more, 1, &id));
            }
            support_steps(network, 1, dt);
        }
        assert_int_equal(seen.missed, 0);
        assert_true(seen.found > 0);
        mspring_network_destroy(network);
    }
}

/// What sleeps below is seen, too, and the step is no idle one; what sleeps above makes it one.
static void sleepers_below_are_seen(void **state) {
    (void)state;
    for (int above = 0; above < 2; above++) {
        mspring_builder *builder = support_builder();
        support_spring(builder, support_particle(builder, 0, 0, 1), support_particle(builder, 1, 0, 1), 10, 0);
        mspring_network_def def = support_def(0, 4);
        def.settings.sleep_speed = 0.1f;
        mspring_network *network = support_network(builder, &def);
        support_fall_asleep(network, dt);
        for (size_t k = 0; k < COUNT_OF(kinds); k++) {
            uint32_t number;
            ground to = {.y = above ? -1.0 : -0.0};
            mspring_hook_def hook;
            check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &hook, sizeof hook));
            hook.phase = kinds[k].phase;
            hook.flags = MSPRING_HOOK_BELOW;
            hook.below_y = above ? -100 : 5;
            hook.fn = act;
            hook.user = &to;
            check_ok(mspring_network_add_hook(network, &hook, &number));
            support_steps(network, 3, dt);
            assert_int_equal(to.calls, above ? 0 : hook.phase == MSPRING_PHASE_BEFORE_STEP ? 3 : 12);
            assert_true(support_sleeps(network, 0));
            assert_true(!(support_step_info(network).flags & MSPRING_STEP_ASLEEP) == !above);
            check_ok(mspring_network_remove_hook(network, number));
        }
        mspring_network_destroy(network);
    }
}

/* ---------------------------------------------------------------------------------------------------------- away
 */

/// High above, the hook is not called and the bits are those of one that is called and does nothing.
static void far_above_there_is_no_hook(void **state) {
    (void)state;
    for (size_t k = 0; k < COUNT_OF(kinds); k++) {
        mspring_network *networks[2];
        ground to = {.y = -1000}, called = to;
        for (int n = 0; n < 2; n++) {
            mspring_builder *builder = support_builder();
            for (uint32_t i = 0; i < 100; i++) {
                support_particle(builder, i, i % 7, 1);
            }
            support_spring(builder, 0, 1, 50, 0);
            const mspring_network_def def = support_def(-9.8f, 40);
            networks[n] = support_network(builder, &def);
        }
        add_ground(networks[0], &kinds[k], &called, 0);
        add_ground(networks[1], &kinds[k], &to, MSPRING_HOOK_BELOW);
        check_alike(networks[0], networks[1], 30);
        assert_int_equal(to.calls, 0);
        // Once more after a call of another hook, which may have written to the state.
        uint32_t number;
        check_ok(support_add_hook(networks[1], MSPRING_PHASE_BEFORE_STEP, act_alone, &to, &number));
        support_steps(networks[1], 1, dt);
        check_ok(mspring_network_remove_hook(networks[1], number));
        support_steps(networks[1], 3, dt);
        assert_int_equal(to.calls, 0);
        mspring_network_destroy(networks[0]);
        mspring_network_destroy(networks[1]);
    }
}

static void heights_have_their_range(void **state) {
    (void)state;
    mspring_network *network = falling(0, 0, 0, MSPRING_SOLVER_EXPLICIT, 1);
    const double bad[] = {NAN, INFINITY, -INFINITY, 1.1e12, -1.1e12}, good[] = {1e12, -1e12, 0};
    ground to = {.y = 0};
    mspring_hook_def def;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def));
    def.fn = act;
    def.user = &to;
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        def.below_y = bad[i];
        def.flags = MSPRING_HOOK_BELOW;
        check_error(mspring_network_add_hook(network, &def, NULL), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "below_y");
        def.flags = 0; // it is not looked at
        check_ok(mspring_network_add_hook(network, &def, NULL));
    }
    for (size_t i = 0; i < COUNT_OF(good); i++) {
        def.below_y = good[i];
        def.flags = MSPRING_HOOK_BELOW;
        check_ok(mspring_network_add_hook(network, &def, NULL));
    }
    def.flags = MSPRING_HOOK_BELOW << 1;
    check_error(mspring_network_add_hook(network, &def, NULL), MSPRING_ERROR_ARGUMENT);
    to.calls = 0;
    support_steps(network, 1, dt);
    assert_in_range(to.calls, COUNT_OF(bad) + 1, 100); // all of those without it, and the highest
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_as_if_called_for_all),  cmocka_unit_test(others_make_no_difference),
        cmocka_unit_test(what_springs_throw_is_found), cmocka_unit_test(contact_begins_anew),
        cmocka_unit_test(nobody_below_is_missed),      cmocka_unit_test(sleepers_below_are_seen),
        cmocka_unit_test(far_above_there_is_no_hook),  cmocka_unit_test(heights_have_their_range),
    };
    return cmocka_run_group_tests_name("hook_reach", tests, NULL, NULL);
}

/// @file test_conserve.c
/// Free bodies of all kinds are hit, blown apart, pushed and damped by the implicit and the direct solver, with
/// every integrator and at substeps from 1/240 to 1/10 s: energy never grows beyond the work of forces, and
/// momentum and angular momentum are what forces make them.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "recipe.h"
#include "support.h"

static const double substeps[] = {1.0 / 240, 1.0 / 64, 1.0 / 30, 0.1};

/// What a scene is about.
typedef enum scene { HIT, BLAST, SPIN, PUSH, DAMPED, SCENES } scene;

/// One of the cases.
typedef struct trial {
    scene what;
    mspring_solver solver;
    mspring_integrator integrator;
    double dt;
    uint64_t seed;
} trial;

/// A lattice with or without holes, a truss with ropes, or a random graph: all of 1e3 to 1e10 N/m, 0.5 to 100 kg.
static recipe body(uint64_t *seed) {
    recipe made = {0};
    const double stiffness = pow(10, support_random_between(seed, 3, 10));
    const double mass = pow(10, support_random_between(seed, -0.3, 2)), ratio = support_random(seed) % 2 ? 1 : 8;
    recipe_stuff stuff = {.mass = {mass, ratio * mass}, .stiffness = {stiffness, ratio * stiffness}};
    const uint32_t width = 2 + (uint32_t)(support_random(seed) % 9),
                   height = 1 + (uint32_t)(support_random(seed) % 6);
    if (support_random(seed) % 3 == 0) {
        stuff.damping[1] = 0.1 * sqrt(stiffness * mass);
    }
    switch (support_random(seed) % 4) {
    case 0:
        for (uint32_t i = 0; i < 4 * width; i++) {
            const double x = support_random_between(seed, 0, 10), y = support_random_between(seed, 0, 10);
            recipe_particle(&made, x, y, mass, 0);
        }
        recipe_random_springs(&made, 10 * width, &stuff, seed);
        break;
    case 1:
        recipe_lattice(&made, width, height, 0, 0, 1, &stuff, seed);
        recipe_rope(&made, 0, made.particle_count - 1, 2 * width + 3, &stuff, seed);
        break;
    case 2:
        stuff.holes = 0.15;
        recipe_lattice(&made, width + 3, height + 3, 0, 0, 1, &stuff, seed);
        break;
    default:
        recipe_lattice(&made, width, height, 0, 0, 1, &stuff, seed);
    }
    recipe_disturb(&made, 0, 0, seed); // rest lengths are those of now
    return made;
}

static void set_off(recipe *made, scene what, uint64_t *seed) {
    const uint32_t count = made->particle_count, struck = (uint32_t)(support_random(seed) % count);
    const double speed = pow(10, support_random_between(seed, -1, 2)), turn = support_random_between(seed, -8, 8);
    for (uint32_t i = 0; i < count; i++) {
        mspring_particle_def *p = &made->particles[i];
        const bool is_struck = what == BLAST || (what == HIT && i == struck);
        const double spin = what == SPIN || what == DAMPED ? turn : 0;
        p->vx = (float)(-spin * p->y + (is_struck ? support_random_between(seed, -speed, speed) : 0));
        p->vy = (float)(spin * p->x + (is_struck ? support_random_between(seed, -speed, speed) : 0));
    }
}

/// Of all particles together, which need not hang together: energy without flight, momentum, and spin about the
/// mass centre with what it is the difference of.
typedef struct totals {
    double mass, x, y, px, py, spin, energy, size;
    double rounding; ///< of energy, as positions are floats
} totals;

static totals totals_of(const mspring_network *network, const recipe *made) {
    totals t = {0};
    double kinetic, elastic, angular, furthest = 0;
    check_ok(support_get_energy(network, &kinetic, &elastic, NULL));
    check_ok(support_get_momentum(network, &t.px, &t.py, &angular));
    for (uint32_t i = 0; i < made->particle_count; i++) {
        const double m = (double)made->particles[i].mass;
        const support_point at = support_position(network, i);
        t.mass += m;
        t.x += m * at.x;
        t.y += m * at.y;
    }
    t.x /= t.mass;
    t.y /= t.mass;
    for (uint32_t i = 0; i < made->particle_count; i++) {
        const support_point at = support_position(network, i), v = support_velocity(network, i);
        furthest = fmax(furthest, fmax(fabs(at.x), fabs(at.y)));
        t.size += (double)made->particles[i].mass * hypot(at.x - t.x, at.y - t.y) * hypot(v.x, v.y);
    }
    for (uint32_t i = 0; i < made->spring_count; i++) {
        t.rounding += 0.5 * (double)made->springs[i].stiffness * pow(1.2e-7 * furthest, 2);
    }
    t.spin = angular - (t.x * t.py - t.y * t.px);
    t.energy = kinetic + elastic - 0.5 * (t.px * t.px + t.py * t.py) / t.mass;
    return t;
}

static void check_totals(const trial *c, const totals *first, const totals *now, double work, double left,
                         double px, double py, double spin, int step) {
    // Sums of floats, and what springs may have too much in a substep: 1e-5 of the energy, times the substeps.
    const double most = first->energy + work + 1e-3 * (first->energy + fabs(work)) + now->rounding;
    const double moved = 1e-4 * (hypot(px, py) + first->size + now->size) + 1e-6;
    // What forces turn goes by an arm that is known at the ends of a step only.
    const double turned = 1e-3 * fabs(spin) + 1e-5 * (first->size + now->size) + 1e-2 * left + 1e-6;
    if (!(now->energy <= most) || !(hypot(now->px - px, now->py - py) <= moved) ||
        !(fabs(now->spin - spin) <= turned)) {
        fail_msg(
            "scene %d, solver %d, integrator %d, dt %g, seed %d, step %d: energy %g, at most %g; momentum (%g, "
            "%g), expected (%g, %g); spin %g, expected %g",
            (int)c->what, (int)c->solver, (int)c->integrator, c->dt, (int)c->seed, step, now->energy, most, now->px,
            now->py, px, py, now->spin, spin);
    }
}

static void run(const trial *c) {
    uint64_t seed = 7919 * c->seed + (uint64_t)c->what;
    recipe made = body(&seed);
    set_off(&made, c->what, &seed);
    const float gravity = support_random(&seed) % 2 ? -9.8f : 0;
    mspring_network_def def = support_def(gravity, 1);
    def.settings.solver = c->solver;
    def.settings.global_damping = c->what == DAMPED ? 0.5f : 0;
    mspring_network *network = recipe_network(&made, &def);
    mspring_settings settings;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &settings, sizeof settings));
    settings.solver = c->solver;
    settings.integrator = c->integrator;
    check_ok(support_set_solver(network, &settings));
    const totals first = totals_of(network, &made);
    const mspring_id pushed = (mspring_id)(support_random(&seed) % made.particle_count);
    const double force = c->what == PUSH ? support_random_between(&seed, 1, 300) : 0;
    double px = first.px, py = first.py, spin = first.spin, work = 0, left = 0, unseen = 0;
    for (int step = 0; step < 40; step++) {
        const totals before = totals_of(network, &made);
        const support_point from = support_position(network, pushed);
        if (force > 0) {
            check_ok(mspring_network_apply_force(network, pushed, (float)force, 0));
        }
        check_ok(mspring_network_step(network, c->dt));
        const totals now = totals_of(network, &made);
        const support_point to = support_position(network, pushed);
        const double decay = c->what == DAMPED ? exp(-0.5 * c->dt) : 1;
        const double seconds = c->what == DAMPED ? (1 - decay) / 0.5 : c->dt;
        px = px * decay + (double)(float)force * c->dt;
        py = py * decay + first.mass * (double)gravity * seconds;
        const double arm = 0.5 * (from.y - before.y + (to.y - now.y));
        spin = spin * decay - arm * force * c->dt;
        left += fabs(arm * force * c->dt);
        work += force * (to.x - now.x - (from.x - before.x));
        unseen += 2e-6 * force; // positions are floats
        check_totals(c, &first, &now, work + unseen, left, px, py, spin, step);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void run_all(scene what) {
    uint32_t count = 0;
    for (uint64_t seed = 1; seed <= 12; seed++) {
        for (mspring_solver s = MSPRING_SOLVER_IMPLICIT; s <= MSPRING_SOLVER_DIRECT; s++) {
            for (mspring_integrator n = MSPRING_INTEGRATOR_ALPHA; n <= MSPRING_INTEGRATOR_EULER; n++) {
                for (size_t h = 0; h < COUNT_OF(substeps); h++) {
                    run(&(trial){what, s, n, substeps[h], seed});
                    count++;
                }
            }
        }
    }
    assert_int_equal(count, 12 * 2 * 3 * 4);
}

static void hits(void **state) {
    (void)state;
    run_all(HIT);
}

static void blasts(void **state) {
    (void)state;
    run_all(BLAST);
}

static void spins(void **state) {
    (void)state;
    run_all(SPIN);
}

static void pushes(void **state) {
    (void)state;
    run_all(PUSH);
}

static void damped(void **state) {
    (void)state;
    run_all(DAMPED);
}

/// A lattice of springs of iron that are at rest, and that turn about its mass centre, rad/s.
static void add_turning(recipe *made, uint32_t width, uint32_t height, double x, double stiffness, double turn) {
    uint64_t seed = 1;
    const recipe_stuff iron = {.mass = {73.4, 73.4}, .stiffness = {stiffness, stiffness}};
    const mspring_id first = recipe_lattice(made, width, height, x, 0, 1, &iron, &seed);
    for (mspring_id i = first; i < made->particle_count; i++) {
        mspring_particle_def *p = &made->particles[i];
        p->vx = (float)(-turn * (p->y - 0.5 * (height - 1)));
        p->vy = (float)(turn * (p->x - x - 0.5 * (width - 1)));
    }
}

static mspring_network *network_of(const recipe *made, mspring_solver solver, mspring_integrator integrator) {
    mspring_network_def def = support_def(0, 1);
    def.settings.solver = solver;
    return recipe_solved(made, &def, solver, integrator);
}

/// What a substep may gain by rounding does not add up: a body that only spins is where any error is a gain.
static void spin_for_long(uint32_t width, double stiffness, double turn, mspring_solver solver,
                          mspring_integrator integrator) {
    recipe made = {0};
    add_turning(&made, width, width < 3 ? 1 : 2, 30, stiffness, turn);
    mspring_network *network = network_of(&made, solver, integrator);
    const totals first = totals_of(network, &made);
    for (int step = 0; step < 10000; step++) {
        check_ok(mspring_network_step(network, 1.0 / 64));
    }
    const totals now = totals_of(network, &made);
    if (!(now.energy <= 1.001 * first.energy) || !(fabs(now.spin - first.spin) <= 1e-3 * fabs(first.spin))) {
        fail_msg(
            "width %u, %g N/m, %g rad/s, solver %d, integrator %d: energy %g, at first %g; spin %g, at first %g",
            width, stiffness, turn, (int)solver, (int)integrator, now.energy, first.energy, now.spin, first.spin);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void fragments_spin_for_long(void **state) {
    (void)state;
    static const double stiffnesses[] = {1e5, 1e7, 1e9}, turns[] = {0.3, 3, 20};
    for (uint32_t width = 2; width <= (support_is_quick() ? 2 : 3); width++) {
        for (size_t k = 0; k < COUNT_OF(stiffnesses); k++) {
            for (size_t w = 0; w < COUNT_OF(turns); w++) {
                for (mspring_integrator n = MSPRING_INTEGRATOR_ALPHA; n <= MSPRING_INTEGRATOR_EULER; n++) {
                    spin_for_long(width, stiffnesses[k], turns[w], MSPRING_SOLVER_IMPLICIT, n);
                    spin_for_long(width, stiffnesses[k], turns[w], MSPRING_SOLVER_DIRECT, n);
                }
            }
        }
    }
}

/// Energy of a bar that has swung for two seconds, maybe with a fragment that spins far away.
static double energy_of_bar(mspring_integrator integrator, double turn) {
    recipe made = {0};
    const uint32_t width = 40, height = 3;
    add_turning(&made, width, height, 0, 6.76e7, 0);
    for (uint32_t i = 0; i < width * height; i++) {
        const double along = made.particles[i].x / (width - 1) - 0.5;
        made.particles[i].vy = (float)(24 * (along * along - 1.0 / 12));
    }
    if (turn != 0) {
        add_turning(&made, 2, 1, 100, 6.76e7, turn);
    }
    mspring_network *network = network_of(&made, MSPRING_SOLVER_IMPLICIT, integrator);
    for (int step = 0; step < 128; step++) {
        check_ok(mspring_network_step(network, 1.0 / 64));
    }
    double kinetic, elastic;
    check_ok(support_get_energy(network, &kinetic, &elastic, NULL));
    mspring_network_destroy(network);
    recipe_free(&made);
    return kinetic + elastic - 2 * 0.5 * 73.4 * 0.25 * turn * turn;
}

static void fragments_leave_others_alone(void **state) {
    (void)state;
    for (mspring_integrator n = MSPRING_INTEGRATOR_ALPHA; n <= MSPRING_INTEGRATOR_EULER; n++) {
        const double alone = energy_of_bar(n, 0);
        check_near(energy_of_bar(n, 3), alone, 0.01 * alone);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hits),
        cmocka_unit_test(blasts),
        cmocka_unit_test(spins),
        cmocka_unit_test(pushes),
        cmocka_unit_test(damped),
        cmocka_unit_test(fragments_spin_for_long),
        cmocka_unit_test(fragments_leave_others_alone),
    };
    return cmocka_run_group_tests_name("conserve", tests, NULL, NULL);
}

/// @file test_uneven.c
/// Steps of uneven length: rest on a slope, relative springs and grips.
///
///   test_uneven [table]     table: prints the figures
///
/// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "recipe.h"
#include "support.h"

static bool prints;

/// Lengths of steps.
typedef enum pattern { EVEN, JITTER_2, JITTER_10, JITTER_50, IN_TURN, PATTERNS } pattern;
static const char *const names[] = {"even", "2 %", "10 %", "50 %", "1/60 and 1/90 in turn"};

static double dt_of(pattern of, uint32_t step, uint64_t *seed) {
    const double shorter[] = {0, 0.02, 0.1, 0.5};
    if (of == IN_TURN)
        return step % 2 ? 1.0 / 90 : 1.0 / 60;
    return (1 - support_random_between(seed, 0, 1) * shorter[of]) / 60;
}

static void step_for(mspring_network *network, double seconds, pattern of, uint64_t *seed) {
    double time = 0;
    for (uint32_t step = 0; time < seconds; step++) {
        const double dt = dt_of(of, step, seed);
        check_ok(mspring_network_step(network, dt));
        time += dt;
    }
}

/* ----------------------------------------------------------------------------------------------- on a slope */

enum { MOST_PARTICLES = 18 };

/// A chain of five particles, or a lattice of 6 x 3, that lies on a slope.
static mspring_network *lying(bool is_lattice, double angle, double friction, mspring_solver solver,
                              uint32_t flags) {
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {2e4, 2e4}, .damping = {20, 20}};
    recipe made = {0};
    uint64_t seed = 1;
    (void)recipe_lattice(&made, is_lattice ? 6 : 5, is_lattice ? 3 : 1, 0, 0, 1, &stuff, &seed);
    for (uint32_t p = 0; p < made.particle_count; p++) {
        const double x = made.particles[p].x, y = made.particles[p].y;
        made.particles[p].x = cos(angle) * x - sin(angle) * y;
        made.particles[p].y = sin(angle) * x + cos(angle) * y;
    }
    mspring_network_def def = support_def(-9.8f, MSPRING_SUBSTEPS_AUTO);
    def.settings.guard = MSPRING_GUARD_CLAMP;
    def.settings.solver = solver;
    def.flags = flags;
    mspring_network *network = recipe_network(&made, &def);
    const double slope[] = {0, 0, -sin(angle), cos(angle)};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = slope;
    floor.plane_count = 1;
    floor.friction = (float)friction;
    check_ok(mspring_network_set_floor(network, &floor));
    recipe_free(&made);
    return network;
}

static void get_places(const mspring_network *network, double angle, double *along) {
    const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
    for (uint32_t p = 0; p < count; p++)
        along[p] = support_position(network, p).x * cos(angle) + support_position(network, p).y * sin(angle);
}

/// Longest way of a particle along the slope in 30 s, after 10 s to come to rest.
static double creep(bool is_lattice, double angle, mspring_solver solver, uint32_t flags, pattern of) {
    mspring_network *network = lying(is_lattice, angle, 1.5 * tan(angle), solver, flags);
    double before[MOST_PARTICLES], after[MOST_PARTICLES], most = 0;
    uint64_t seed = 7;
    step_for(network, 10, of, &seed);
    get_places(network, angle, before);
    step_for(network, 30, of, &seed);
    get_places(network, angle, after);
    for (uint32_t p = 0; p < mspring_network_count(network, MSPRING_PARTICLES); p++)
        most = fmax(most, fabs(after[p] - before[p]));
    mspring_network_destroy(network);
    return most;
}

/// What friction holds stays where it is. A chain creeps by the rounding of coordinates; a lattice, some of whose
/// particles carry the others, and precise networks by some last places of the floor, 1e-7 m, in each second.
/// (Where the floor took no account of a shorter substep before, up to 3e-4 and 1e-3 m.)
static void bodies_rest_on_slopes(void **state) {
    (void)state;
    const double degrees[] = {5, 15, 30};
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_IMPLICIT; solver++)
        for (uint32_t flags = 0; flags <= MSPRING_NETWORK_PRECISE; flags += MSPRING_NETWORK_PRECISE)
            for (int is_lattice = 0; is_lattice < 2; is_lattice++)
                for (size_t i = 0; i < COUNT_OF(degrees); i += ROUNDS_ARE_FEW ? 2 : 1)
                    for (pattern of = EVEN; of < PATTERNS; of += ROUNDS_ARE_FEW ? 2 : 1) {
                        const double angle = degrees[i] * acos(-1) / 180;
                        const double way = creep(is_lattice, angle, solver, flags, of);
                        if (prints)
                            print_message("%s, %s, %s, %g degrees, %s: %.1e m\n", is_lattice ? "lattice" : "chain",
                                          solver == MSPRING_SOLVER_EXPLICIT ? "explicit" : "implicit",
                                          flags ? "precise" : "default", degrees[i], names[of], way);
                        assert_true(way < (is_lattice || flags ? 6e-5 : 4e-6));
                    }
}

/// What friction does not hold slides as Coulomb says, within a hundredth: the first steps bring it to the surface.
static void bodies_slide_as_with_even_steps(void **state) {
    (void)state;
    const double angle = 20 * acos(-1) / 180, friction = 0.5 * tan(angle);
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++)
        for (int is_lattice = 0; is_lattice < 2; is_lattice++)
            for (pattern of = EVEN; of < PATTERNS; of++) {
                mspring_network *network = lying(is_lattice, angle, friction, solver, 0);
                double before[MOST_PARTICLES], after[MOST_PARTICLES], time = 0;
                uint64_t seed = 7;
                get_places(network, angle, before);
                for (uint32_t step = 0; step < 120; step++) {
                    const double dt = dt_of(of, step, &seed);
                    check_ok(mspring_network_step(network, dt));
                    time += dt;
                }
                get_places(network, angle, after);
                const double pull = 9.8 * (sin(angle) - friction * cos(angle));
                const double share = (before[0] - after[0]) / (pull * time * time / 2);
                if (prints)
                    print_message("solver %d, %s, %s: slides %.4f of Coulomb's way\n", (int)solver,
                                  is_lattice ? "lattice" : "chain", names[of], share);
                check_near(share, 1, 0.01);
                mspring_network_destroy(network);
            }
}

/* ----------------------------------------------------------------------------------------- relative springs */

/// A free lattice of relative springs, kicked.
static mspring_network *relative_lattice(double stiffness, double damping) {
    const recipe_stuff stuff = {.mass = {1, 1},
                                .stiffness = {stiffness, stiffness},
                                .damping = {damping, damping},
                                .spring_flags = MSPRING_SPRING_RELATIVE};
    recipe made = {0};
    uint64_t seed = 3;
    (void)recipe_lattice(&made, 12, 4, 0, 0, 1, &stuff, &seed);
    recipe_disturb(&made, 0, 0.3, &seed);
    mspring_network_def def = support_def(0, 4);
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

/// A step of a hundredth of the one before makes relative springs 10,000 times as stiff, and their energy with it.
/// It adds no more than that: a first kick for half of the step before gave 550 times as much.
static void relative_springs_gain_what_stiffness_gives(void **state) {
    (void)state;
    for (double shorter = 10; shorter <= 1000; shorter *= 10) {
        mspring_network *network = relative_lattice(0.3, 0);
        support_steps(network, 60, 1.0 / 60);
        const double before = support_energy_of_motion(network);
        double most = 0;
        for (int i = 0; i < 1000; i++) {
            support_steps(network, 1, 1.0 / 60 / shorter);
            most = fmax(most, support_energy_of_motion(network));
        }
        if (prints)
            print_message("relative springs, dt / %g: energy times %.3g of stiffness\n", shorter,
                          most / before / (shorter * shorter));
        assert_true(most < 1.5 * before * shorter * shorter); // not all energy was elastic
        mspring_network_destroy(network);
    }
}

/// A stiffness that varies with dt works on springs; a tenth of relative damping takes more than that.
static void damped_relative_springs_lose_energy(void **state) {
    (void)state;
    for (pattern of = EVEN; of <= JITTER_50; of++) {
        mspring_network *network = relative_lattice(0.3, 0.1);
        const double before = support_energy_of_motion(network);
        uint64_t seed = 7;
        double most = 0;
        for (uint32_t step = 0; step < 3600; step++) {
            check_ok(mspring_network_step(network, dt_of(of, step, &seed)));
            most = fmax(most, support_energy_of_motion(network));
        }
        if (prints)
            print_message("damped relative springs, %s: energy times %.3f at most, %.3f in the end\n", names[of],
                          most / before, support_energy_of_motion(network) / before);
        assert_true(most < before);
        mspring_network_destroy(network);
    }
}

/* ------------------------------------------------------------------------------------------------------ grips */

#define GRIP_STIFFNESS 500.0

/// Energy with that of a grip at (0, 0), bounded by max_force.
static double energy_with_grip(const mspring_network *network, double max_force) {
    const support_point at = support_position(network, 0);
    const double way = hypot(at.x, at.y), reach = max_force / GRIP_STIFFNESS;
    return support_energy_of_motion(network) +
           (way < reach ? GRIP_STIFFNESS * way * way / 2 : max_force * (way - reach / 2));
}

/// Energy in the end, and the most on the way, as multiples of that at the start: of a lattice, or of a particle
/// alone, that a grip without damping holds, in a minute of steps that vary, or that shrink to a hundredth.
static double energy_in_grip(mspring_solver solver, bool is_lattice, double max_force, bool shrinks, pattern of,
                             double *end) {
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {2e4, 2e4}};
    recipe made = {0};
    uint64_t seed = 5;
    if (is_lattice)
        (void)recipe_lattice(&made, 6, 3, 0.2, 0, 1, &stuff, &seed);
    else
        (void)recipe_particle(&made, 0.2, 0, 1, 0);
    made.particles[0].vy = 1;
    mspring_network_def def = support_def(0, MSPRING_SUBSTEPS_AUTO);
    def.settings.guard = MSPRING_GUARD_CLAMP;
    def.settings.solver = solver;
    mspring_network *network = recipe_network(&made, &def);
    mspring_grip_def grip;
    check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &grip, sizeof grip));
    grip.particle = 0;
    grip.stiffness = (float)GRIP_STIFFNESS;
    grip.max_force = max_force < 1e30 ? (float)max_force : MSPRING_NEVER;
    check_ok(mspring_network_add_grip(network, &grip, NULL));
    const double before = energy_with_grip(network, max_force);
    double most = 0, time = 0, scale = 1;
    for (uint32_t step = 0; time < (shrinks ? 1 : 60); step++) {
        const double dt = scale * dt_of(of, step, &seed);
        scale = shrinks && scale > 0.01 ? 0.97 * scale : scale;
        check_ok(mspring_network_step(network, dt));
        time += dt;
        most = fmax(most, energy_with_grip(network, max_force));
    }
    *end = energy_with_grip(network, max_force) / before;
    mspring_network_destroy(network);
    recipe_free(&made);
    return most / before;
}

/// Grips only take energy, whatever dt does.
static void grips_give_no_energy(void **state) {
    (void)state;
    const double forces[] = {DBL_MAX, 20};
    const pattern patterns[] = {EVEN, JITTER_10, JITTER_50, IN_TURN};
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++)
        for (int is_lattice = 0; is_lattice < 2; is_lattice++)
            for (size_t f = 0; f < COUNT_OF(forces); f++)
                for (size_t i = 0; i < 2 * COUNT_OF(patterns); i += ROUNDS_ARE_FEW ? 3 : 1) {
                    const pattern of = patterns[i / 2];
                    double end;
                    const double most = energy_in_grip(solver, is_lattice, forces[f], i % 2, of, &end);
                    if (prints)
                        print_message("grip of a %s, solver %d, %s, %s%s: energy times %.4f at most, %.3f in the "
                                      "end\n",
                                      is_lattice ? "lattice" : "particle", (int)solver, f ? "bounded" : "unbounded",
                                      names[of], i % 2 ? ", shrinking" : "", most, end);
                    assert_true(most < 1.05);
                }
}

int main(int argc, char **argv) {
    prints = argc > 1 && strcmp(argv[1], "table") == 0;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_rest_on_slopes),
        cmocka_unit_test(bodies_slide_as_with_even_steps),
        cmocka_unit_test(relative_springs_gain_what_stiffness_gives),
        cmocka_unit_test(damped_relative_springs_lose_energy),
        cmocka_unit_test(grips_give_no_energy),
    };
    return cmocka_run_group_tests_name("uneven", tests, NULL, NULL);
}

/// @file test_order.c
/// Order of the solvers: errors of positions against a fine explicit run of the same network, as substeps double.
/// Free fall at many substeps a second. And what explicit velocities, which are half a substep older than
/// positions, ask for: the first substep of a step follows one of another length, in the same network or in the one
/// that it was made from.
///
///   test_order [table]     table: prints the errors
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "recipe.h"
#include "support.h"

#define DT (1.0 / 60)

static bool prints_errors;

/// A solver, its integrator, and a network of one or two words.
typedef struct method {
    mspring_solver solver;
    mspring_integrator integrator;
    uint32_t flags;
} method;

static const method precise = {MSPRING_SOLVER_EXPLICIT, MSPRING_INTEGRATOR_ALPHA, MSPRING_NETWORK_PRECISE};

/// A body that is let go of in gravity, and the damping that takes its energy.
typedef struct body {
    const char *name;
    bool is_chain; ///< instead of a cantilever
    double stiffness, damping;
    float global_damping;
} body;

static recipe recipe_of(const body *b) {
    uint64_t seed = 1;
    recipe made = {0};
    const recipe_stuff stuff = {
        .mass = {1, 1}, .stiffness = {b->stiffness, b->stiffness}, .damping = {b->damping, b->damping}};
    if (b->is_chain) {
        // Hangs at ease, and swings sideways.
        const mspring_id top = recipe_particle(&made, 0, 0, 1, MSPRING_PARTICLE_PINNED);
        const mspring_id end = recipe_particle(&made, 0, -12, 1, 0);
        (void)recipe_rope(&made, top, end, 12, &stuff, &seed);
        for (uint32_t p = 1; p < made.particle_count; p++)
            made.particles[p].vx = (float)(-made.particles[p].y / 2);
    } else {
        (void)recipe_lattice(&made, 12, 3, 0, 0, 1, &stuff, &seed);
        for (uint32_t p = 0; p < made.particle_count; p += 12)
            made.particles[p].flags = MSPRING_PARTICLE_PINNED;
    }
    return made;
}

/// Positions, x and y in turn, after a second.
static double *positions_of(const body *b, const method *how, uint32_t substeps) {
    recipe made = recipe_of(b);
    mspring_network_def def = support_def(-9.8f, substeps);
    def.settings.global_damping = b->global_damping;
    def.settings.solver = how->solver;
    def.settings.integrator = how->integrator;
    def.flags = how->flags;
    mspring_network *network = recipe_network(&made, &def);
    support_set_residual(network, 0); // what it leaves goes down slower than what integrators do
    support_steps(network, 60, DT);
    double *at = malloc(2 * (size_t)made.particle_count * sizeof *at);
    assert_non_null(at);
    check_ok(mspring_network_get_positions(network, NULL, 0, made.particle_count, at, at + 1, 2));
    mspring_network_destroy(network);
    recipe_free(&made);
    return at;
}

static double distance(const double *a, const double *b, uint32_t count) {
    double squares = 0;
    for (uint32_t i = 0; i < count; i++)
        squares += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(squares);
}

/// Errors, as shares of the motion, go down by this factor with each doubling of substeps, down to this share.
static void check_order(const body *b, const method *how, uint32_t first, double least, double end) {
    enum { FINE = 8192 };
    recipe made = recipe_of(b);
    const uint32_t count = 2 * made.particle_count;
    double *exact = positions_of(b, &precise, FINE), *start = malloc(count * sizeof *start);
    assert_non_null(start);
    for (uint32_t p = 0; p < made.particle_count; p++) {
        start[2 * p] = made.particles[p].x;
        start[2 * p + 1] = made.particles[p].y;
    }
    const double motion = distance(exact, start, count);
    double error = 0;
    for (uint32_t substeps = first; substeps <= FINE / 8; substeps *= 2) {
        const double before = error;
        double *at = positions_of(b, how, substeps);
        error = distance(at, exact, count) / motion;
        free(at);
        if (prints_errors)
            print_message(
                "%s, solver %d, integrator %d, %s: %u substeps, error %.2e of the motion, %.2f times less\n",
                b->name, (int)how->solver, (int)how->integrator, how->flags ? "precise" : "default",
                (unsigned)substeps, error, before / error);
        if (error < end && substeps > first)
            break;
        assert_true(substeps == first || before / error > least);
    }
    // It got there.
    assert_true(error < end);
    free(exact);
    free(start);
    recipe_free(&made);
}

static const body undamped[] = {
    {"cantilever", false, 2e3, 0, 0},
    {"cantilever, global damping", false, 2e3, 0, 0.5f},
    {"chain", true, 3e3, 0, 0},
    {"chain, global damping", true, 3e3, 0, 0.5f},
};

/// Second order: a factor of 4, of which higher orders take some at long substeps. Single precision rounds each
/// substep by 1e-7 of the size of a body, which a thousand of them add up to more than 1e-6 of the motion.
static void errors_are_of_second_order(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(undamped); i++) {
        check_order(&undamped[i], &precise, 2, 3.5, 1e-6);
        check_order(&undamped[i], &(method){0}, 2, 3.5, 1e-5);
    }
}

/// Dampers go by velocities of half a substep ago: first order, a factor of 2.
static void errors_of_dampers_are_of_first_order(void **state) {
    (void)state;
    const body damped[] = {{"cantilever, dampers", false, 2e3, 20, 0}, {"chain, dampers", true, 3e3, 20, 0}};
    for (size_t i = 0; i < COUNT_OF(damped); i++) {
        check_order(&damped[i], &precise, 2, 1.9, 1e-5);
        check_order(&damped[i], &(method){0}, 2, 1.9, 1e-4);
    }
}

/// Implicit steps: GA0 and BDF2 of second order, dampers or not, from 8 substeps on, which resolve all
/// oscillations; implicit Euler of first. Single precision of velocities takes some 1e-5 of the motion, so default
/// networks go down to that, and precise ones to 1e-6, as explicit ones do.
static void implicit_errors_are_of_the_order_of_the_integrator(void **state) {
    (void)state;
    const body bodies[] = {undamped[0], undamped[3], {"cantilever, dampers", false, 2e3, 20, 0}};
    for (size_t i = 0; i < COUNT_OF(bodies); i++)
        for (mspring_solver solver = MSPRING_SOLVER_IMPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++)
            for (uint32_t flags = 0; flags <= MSPRING_NETWORK_PRECISE; flags += MSPRING_NETWORK_PRECISE) {
                const double end = flags ? 1e-6 : 1e-5;
                check_order(&bodies[i], &(method){solver, MSPRING_INTEGRATOR_ALPHA, flags}, 8, 3.5, end);
                check_order(&bodies[i], &(method){solver, MSPRING_INTEGRATOR_BDF2, flags}, 8, 3.5, end);
                check_order(&bodies[i], &(method){solver, MSPRING_INTEGRATOR_EULER, flags}, 8, 1.9, 1e-3);
            }
}

/* ------------------------------------------------------------------------------------------------------ free fall
 */

/// Mean speed after a fifth of a second of free fall that begins at 10 m/s, less the one that it should have, as a
/// share of what the fall has added.
enum { LOOSE, LATTICE, TWO_STIFF_LATTICES, FALLING_SCENES };
static double error_of_fall(const method *how, int scene, uint32_t rate) {
    const double stiffness = scene == TWO_STIFF_LATTICES ? 1e9 : 1e3;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {stiffness, stiffness}};
    recipe made = {0};
    uint64_t seed = 5;
    if (scene == LOOSE)
        for (int i = 0; i < 20; i++)
            (void)recipe_particle(&made, i, 0, 1 + i, 0);
    else
        (void)recipe_lattice(&made, 4, 3, 0, 0, 1, &stuff, &seed);
    if (scene == TWO_STIFF_LATTICES) // small ones share blocks
        (void)recipe_lattice(&made, 3, 3, 10, 0, 1, &stuff, &seed);
    for (uint32_t p = 0; p < made.particle_count; p++)
        made.particles[p].vy = -10;
    mspring_network_def def = support_def(-9.8f, rate > 60 ? rate / 60 : 1);
    def.settings.solver = how->solver;
    def.settings.integrator = how->integrator;
    def.flags = how->flags;
    mspring_network *network = recipe_network(&made, &def);
    support_steps(network, 12, DT);
    const double late = how->solver == MSPRING_SOLVER_EXPLICIT ? 0.5 / rate : 0; // explicit velocities are old
    double sum = 0;
    for (uint32_t p = 0; p < made.particle_count; p++)
        sum += (double)support_velocity(network, p).y / made.particle_count;
    mspring_network_destroy(network);
    recipe_free(&made);
    return fabs((sum + 10) / (-(double)9.8f * (0.2 - late)) - 1);
}

/// Precise networks keep what a substep adds to a velocity, however little. The last place of what is read, 1e-6
/// m/s at 12 m/s, is 5e-7 of what the fall adds. (In one word, 491,520 substeps a second are off by 0.4 %.)
static void precise_networks_fall_as_gravity_says(void **state) {
    (void)state;
    const method methods[] = {
        {MSPRING_SOLVER_EXPLICIT, MSPRING_INTEGRATOR_ALPHA, MSPRING_NETWORK_PRECISE},
        {MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_ALPHA, MSPRING_NETWORK_PRECISE},
        {MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, MSPRING_NETWORK_PRECISE},
        {MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_EULER, MSPRING_NETWORK_PRECISE},
        {MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_ALPHA, MSPRING_NETWORK_PRECISE},
        {MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_BDF2, MSPRING_NETWORK_PRECISE},
    };
    const uint32_t rates[] = {60, 7680, 122880, 491520};
    const size_t rate_count = ROUNDS_ARE_FEW ? 2 : support_is_quick() ? 3 : COUNT_OF(rates);
    for (size_t i = 0; i < COUNT_OF(methods); i++)
        for (int scene = 0; scene < FALLING_SCENES; scene++)
            for (size_t j = 0; j < rate_count; j++) {
                if (scene == TWO_STIFF_LATTICES && methods[i].solver == MSPRING_SOLVER_EXPLICIT)
                    continue; // not stable
                const double error = error_of_fall(&methods[i], scene, rates[j]);
                if (prints_errors)
                    print_message("fall, solver %d, integrator %d, scene %d, %u substeps/s: %.2e\n",
                                  (int)methods[i].solver, (int)methods[i].integrator, scene, (unsigned)rates[j],
                                  error);
                assert_true(error < 1e-6);
            }
}

/// Default networks dither what would be rounded the same way in each substep. In so short a fall the last place of
/// what is read is 5e-7 of what it adds, and what the dither leaves up to 7e-6. (Without, the last of these rates
/// is off by 0.4 %.)
static void explicit_networks_fall_as_gravity_says(void **state) {
    (void)state;
    const uint32_t rates[] = {60, 480, 1920, 7680, 30720, 122880, 491520};
    const method how = {0};
    for (int scene = LOOSE; scene <= LATTICE; scene++)
        for (size_t i = 0; i < COUNT_OF(rates) - (ROUNDS_ARE_FEW ? 2 : 0); i++) {
            const double error = error_of_fall(&how, scene, rates[i]);
            if (prints_errors)
                print_message("fall, default, scene %d, %u substeps/s: %.2e\n", scene, (unsigned)rates[i], error);
            assert_true(error < 2e-5);
        }
}

/* ------------------------------------------------------------------------------------------------ uneven substeps
 */

/// A free bar, kicked.
static mspring_network *kicked_bar(uint32_t flags) {
    const recipe_stuff stuff = {.mass = {10, 10}, .stiffness = {2e4, 2e4}};
    recipe made = {0};
    uint64_t seed = 3;
    (void)recipe_lattice(&made, 20, 4, 0, 0, 1, &stuff, &seed);
    recipe_disturb(&made, 0, 0.5, &seed);
    mspring_network_def def = support_def(0, 1);
    def.flags = flags;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

/// Steps of two lengths in turn, each in so many substeps. A first substep that kicked for its own length, instead
/// of half of it and half of the one before, multiplied energy by 1e4 to 1e6. (At half of the border and above,
/// substeps of two lengths feed whatever swings in time with them.)
static void steps_of_two_lengths_gain_nothing(void **state) {
    (void)state;
    const uint32_t substeps[][2] = {{6, 3}, {12, 6}};
    for (size_t i = 0; i < COUNT_OF(substeps); i++)
        for (uint32_t flags = 0; flags <= MSPRING_NETWORK_PRECISE; flags += MSPRING_NETWORK_PRECISE) {
            mspring_network *network = kicked_bar(flags);
            mspring_settings solver = support_solver(network);
            const double before = support_energy_of_motion(network);
            double most = 0;
            for (uint32_t pair = 0; pair < 60 * 36; pair++) { // 1/60 s and 1/90 s are 1/36 s
                for (int half = 0; half < 2; half++) {
                    solver.substeps = substeps[i][half];
                    check_ok(support_set_solver(network, &solver));
                    support_steps(network, 1, half ? 1.0 / 90 : 1.0 / 60);
                }
                most = fmax(most, support_energy_of_motion(network));
            }
            if (prints_errors)
                print_message("%u and %u substeps in turn, %s: energy times %.3f at most\n",
                              (unsigned)substeps[i][0], (unsigned)substeps[i][1], flags ? "precise" : "default",
                              most / before);
            assert_true(most < 1.5 * before);
            mspring_network_destroy(network);
        }
}

/// Velocities of a network that has stepped are old; those of one that is made of it are so too. Pinned particles
/// far outside keep the local origin where it was, so that no position is rounded anew.
static void a_network_made_of_one_that_stepped_goes_on(void **state) {
    (void)state;
    recipe made = recipe_of(&undamped[0]);
    uint64_t seed = 4;
    recipe_disturb(&made, 0.01, 0.1, &seed);
    (void)recipe_particle(&made, -64, -64, 1, MSPRING_PARTICLE_PINNED);
    (void)recipe_particle(&made, 64, 64, 1, MSPRING_PARTICLE_PINNED);
    const mspring_network_def def = support_def(-9.8f, 8);
    for (uint32_t steps = 0; steps <= 25; steps += 5) {
        mspring_network *network = recipe_network(&made, &def), *clone = NULL;
        for (uint32_t i = 0; i < steps; i++)
            support_steps(network, 1, i % 2 ? DT : 0.7 * DT);
        check_ok(mspring_network_clone(network, NULL, &clone));
        mspring_builder *builder = support_builder();
        check_ok(mspring_builder_add_network(builder, network, NULL, 0, MSPRING_ALL, NULL, NULL));
        mspring_network *again = support_network(builder, &def);
        for (int i = 0; i < 50; i++) {
            assert_int_equal(support_hash(again), support_hash(clone));
            support_steps(again, 1, 0.9 * DT);
            support_steps(clone, 1, 0.9 * DT);
        }
        mspring_network_destroy(again);
        mspring_network_destroy(clone);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

/// A body falls as a stone does, whatever another's springs are set to, and whichever solver takes a step.
static double fallen(bool edits, bool switches) {
    mspring_builder *builder = support_builder();
    const mspring_id a = support_particle(builder, 0, 0, 1), b = support_particle(builder, 1, 0, 1);
    support_spring(builder, a, b, 100, 0);
    (void)support_particle(builder, 50, 0, 1);
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.substeps = edits ? MSPRING_SUBSTEPS_AUTO : 1;
    mspring_network *network = support_network(builder, &def);
    for (int n = 0; n < 120; n++) {
        const float stiffness = n % 2 == 0 ? 1e6f : 100;
        mspring_settings solver;
        check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
        solver.solver = n % 2 == 0 ? MSPRING_SOLVER_EXPLICIT : MSPRING_SOLVER_IMPLICIT;
        solver.substeps = 1;
        if (edits) {
            check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, 0, 1, &stiffness, 1));
        }
        if (switches) {
            check_ok(support_set_solver(network, &solver));
        }
        check_ok(mspring_network_step(network, 1.0 / 60));
    }
    const double y = support_position(network, 2).y;
    mspring_network_destroy(network);
    return -y;
}

static void gravity_is_not_lost(void **state) {
    (void)state;
    const double way = 9.8 * 4 / 2; // two seconds
    check_near(fallen(true, false), way, 1e-3);
    check_near(fallen(false, true), way, 0.01); // the first change has the implicit solver take it for of now
}

static void strong_damping_leaves_little_energy(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    mspring_particle_def particle;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    particle.vx = 3;
    check_ok(mspring_builder_add_particles(builder, &particle, 1, NULL));
    mspring_network_def def = support_def(0, 1);
    def.settings.global_damping = 100;
    mspring_network *network = support_network(builder, &def);
    check_ok(mspring_network_step(network, 1.0 / 30));
    double kinetic;
    check_ok(support_get_energy(network, &kinetic, NULL, NULL));
    const double v = 3 * exp(-100.0 / 30);
    check_near(kinetic, v * v / 2, 1e-6 * v * v); // single precision
    mspring_network_destroy(network);
}

/// Kinetic energy counts the low words of precise velocities: this fall adds a sixth of the last place of 1 m/s.
static void energy_counts_low_words(void **state) {
    (void)state;
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        mspring_builder *builder = support_builder();
        mspring_particle_def particle;
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
        particle.vy = -1;
        check_ok(mspring_builder_add_particles(builder, &particle, 1, NULL));
        mspring_network_def def = support_def(-1e-8f, 4);
        def.settings.solver = solver;
        def.flags = MSPRING_NETWORK_PRECISE;
        mspring_network *network = support_network(builder, &def);
        support_steps(network, 60, DT);
        double kinetic;
        check_ok(support_get_energy(network, &kinetic, NULL, NULL));
        check_near(kinetic, 0.5 + 1e-8, 1e-13); // 240 sums of low words in single precision
        mspring_network_destroy(network);
    }
}

/// An empty part of a network that has stepped gives the builder no lag: what is added then falls as from now.
static void an_empty_part_brings_nothing(void **state) {
    (void)state;
    mspring_builder *builder = support_builder(), *other = support_builder();
    (void)support_particle(other, 0, 0, 1);
    mspring_network_def def = support_def(-9.8f, 1);
    mspring_network *stepped = support_network(other, &def);
    support_steps(stepped, 1, 0.5);
    const mspring_id none = 0;
    check_ok(mspring_builder_add_network(builder, stepped, &none, 0, 0, NULL, NULL));
    (void)support_particle(builder, 0, 0, 1);
    mspring_network *network = support_network(builder, &def);
    support_steps(network, 1, 0.5);
    check_near(support_position(network, 0).y, -9.8 * 0.25 / 2, 1e-6);
    mspring_network_destroy(network);
    mspring_network_destroy(stepped);
}

int main(int argc, char **argv) {
    prints_errors = argc > 1 && strcmp(argv[1], "table") == 0;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_part_brings_nothing),
        cmocka_unit_test(gravity_is_not_lost),
        cmocka_unit_test(strong_damping_leaves_little_energy),
        cmocka_unit_test(energy_counts_low_words),
        cmocka_unit_test(errors_are_of_second_order),
        cmocka_unit_test(errors_of_dampers_are_of_first_order),
        cmocka_unit_test(implicit_errors_are_of_the_order_of_the_integrator),
        cmocka_unit_test(precise_networks_fall_as_gravity_says),
        cmocka_unit_test(explicit_networks_fall_as_gravity_says),
        cmocka_unit_test(steps_of_two_lengths_gain_nothing),
        cmocka_unit_test(a_network_made_of_one_that_stepped_goes_on),
    };
    return cmocka_run_group_tests_name("order", tests, NULL, NULL);
}

/// @file test_accuracy.c
/// Trajectories of bars that are let go and plucked, with and without dampers, against a fine reference in double
/// precision: how far each solver is off, and how that goes down with the step.
///
///   test_accuracy [table]     table: prints the errors of the 80 x 5 bar, in the form of bench/RESULTS.md
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reference.h"
#include "support.h"

typedef struct motion {
    const char *name;
    uint32_t columns, rows;
    double mass, stiffness, damping;
    float gravity;
    double pluck; ///< m/s upwards at the free end at first, growing with the square of the distance
    double seconds;
} motion;

static recipe bar_of(const motion *m) {
    uint64_t seed = 1;
    const recipe_stuff stuff = {
        .mass = {m->mass, m->mass}, .stiffness = {m->stiffness, m->stiffness}, .damping = {m->damping, m->damping}};
    recipe made = {0};
    recipe_lattice(&made, m->columns, m->rows, 0, 0, 1, &stuff, &seed);
    for (uint32_t i = 0; i < made.particle_count; i++) {
        const double along = (double)(i % m->columns) / (m->columns - 1);
        made.particles[i].vy = (float)(m->pluck * along * along);
        if (i % m->columns == 0) {
            made.particles[i].flags = MSPRING_PARTICLE_PINNED;
        }
    }
    return made;
}

/// Positions and velocities at the end, by id.
typedef struct outcome {
    uint32_t count;
    double *x, *y, *vx, *vy;
} outcome;

static outcome outcome_of(uint32_t count) {
    double *all = malloc((size_t)4 * count * sizeof *all);
    assert_non_null(all);
    return (outcome){count, all, all + count, all + 2 * count, all + 3 * count};
}

static void run_reference(const motion *m, uint32_t substeps, outcome *end) {
    recipe made = bar_of(m);
    reference net = reference_of(&made, 0, (double)m->gravity, 0);
    for (uint32_t i = 0; i < substeps; i++) {
        reference_substep(&net, m->seconds / substeps);
    }
    for (uint32_t i = 0; i < net.particle_count; i++) {
        end->x[i] = net.particles[i].x;
        end->y[i] = net.particles[i].y;
        end->vx[i] = net.particles[i].vx;
        end->vy[i] = net.particles[i].vy;
    }
    reference_free(&net);
    recipe_free(&made);
}

/// Extrapolated from two runs, as the reference's scheme is of first order: what is left is of second order.
static outcome reference_end(const motion *m, uint32_t substeps) {
    outcome coarse = outcome_of(m->columns * m->rows), fine = outcome_of(coarse.count);
    run_reference(m, substeps, &coarse);
    run_reference(m, 2 * substeps, &fine);
    for (uint32_t i = 0; i < 4 * fine.count; i++) {
        fine.x[i] = 2 * fine.x[i] - coarse.x[i]; // and y, vx, vy, which lie behind it
    }
    free(coarse.x);
    return fine;
}

typedef struct setting {
    const char *name;
    mspring_solver solver;
    mspring_integrator integrator;
    double least_order; ///< of positions and of velocities
} setting;

static const setting settings[] = {
    {"explicit", MSPRING_SOLVER_EXPLICIT, 0, 0.9},
    {"GA0, implicit", MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_ALPHA, 1.8},
    {"GA0, direct", MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_ALPHA, 1.8},
    {"BDF2, implicit", MSPRING_SOLVER_IMPLICIT, MSPRING_INTEGRATOR_BDF2, 1.8},
    {"BDF2, direct", MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_BDF2, 1.8},
    {"Euler, direct", MSPRING_SOLVER_DIRECT, MSPRING_INTEGRATOR_EULER, 0.75}, // comes near to 1 from below
};

/// Root of the mean squares of what positions (m) and velocities (m/s) are off.
typedef struct errors {
    double position, velocity;
} errors;

static errors errors_of(const motion *m, const setting *s, uint32_t steps, uint32_t substeps, const outcome *end) {
    recipe made = bar_of(m);
    mspring_network_def def = support_def(m->gravity, substeps);
    mspring_network *network = recipe_network(&made, &def);
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = s->solver;
    solver.integrator = s->integrator;
    solver.substeps = substeps;
    solver.residual = 0; // what iterations leave goes down by steps only as far as they are many
    check_ok(support_set_solver(network, &solver));
    support_steps(network, steps, m->seconds / steps);
    errors sum = {0, 0};
    for (mspring_id i = 0; i < end->count; i++) {
        const support_point is = support_position(network, i), moves = support_velocity(network, i);
        sum.position += (is.x - end->x[i]) * (is.x - end->x[i]) + (is.y - end->y[i]) * (is.y - end->y[i]);
        sum.velocity +=
            (moves.x - end->vx[i]) * (moves.x - end->vx[i]) + (moves.y - end->vy[i]) * (moves.y - end->vy[i]);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
    return (errors){sqrt(sum.position / end->count), sqrt(sum.velocity / end->count)};
}

/// The fastest oscillation has 56 rad/s, so these steps are a tenth of what the explicit solver bears, and errors
/// are a hundred times what single precision rounds.
static const motion small[] = {
    {"let go", 12, 3, 1, 400, 0, -9.8f, 0, 0.5},
    {"let go, damped", 12, 3, 1, 400, 1, -9.8f, 0, 0.5},
    {"plucked", 12, 3, 1, 400, 0, 0, 3, 0.5},
    {"plucked, damped", 12, 3, 1, 400, 1, 0, 3, 0.5},
};

static void errors_go_down_with_the_step(void **state) {
    (void)state;
    enum { STEPS = 128 };
    for (size_t i = 0; i < COUNT_OF(small); i++) {
        outcome end = reference_end(&small[i], 16384);
        for (size_t s = 0; s < COUNT_OF(settings); s++) {
            const errors coarse = errors_of(&small[i], &settings[s], STEPS, 1, &end);
            const errors fine = errors_of(&small[i], &settings[s], 2 * STEPS, 1, &end);
            const double order = log2(coarse.position / fine.position);
            const double velocity_order = log2(coarse.velocity / fine.velocity);
            if (!(order >= settings[s].least_order && velocity_order >= settings[s].least_order)) {
                print_error("%s, %s: %.3g m to %.3g m, order %.2f; velocity %.3g to %.3g, order %.2f\n",
                            small[i].name, settings[s].name, coarse.position, fine.position, order, coarse.velocity,
                            fine.velocity, velocity_order);
            }
            assert_true(order >= settings[s].least_order);
            assert_true(velocity_order >= settings[s].least_order);
            // The explicit solver takes positions and velocities of half a substep apart for those of one time:
            // what that shifts, the velocities of what is plucked or the positions of what is let go, is of first
            // order and no better.
            assert_true(settings[s].solver != MSPRING_SOLVER_EXPLICIT || fmin(order, velocity_order) < 1.2);
        }
        free(end.x);
    }
}

static void print_table(void) {
    const motion large[] = {
        {"let go", 80, 5, 73.3975, 6.7643e7, 0, -9.8f, 0, 1},
        {"let go, damped", 80, 5, 73.3975, 6.7643e7, 1e4, -9.8f, 0, 1},
        {"plucked", 80, 5, 73.3975, 6.7643e7, 0, 0, 20, 1},
        {"plucked, damped", 80, 5, 73.3975, 6.7643e7, 1e4, 0, 20, 1},
    };
    printf("| solver, steps of 1/64 s |");
    for (size_t i = 0; i < COUNT_OF(large); i++) {
        printf(" %s, mm | mm/s |", large[i].name);
    }
    printf("\n|:---|");
    for (size_t i = 0; i < COUNT_OF(large); i++) {
        printf("---:|---:|");
    }
    outcome ends[COUNT_OF(large)];
    for (size_t i = 0; i < COUNT_OF(large); i++) {
        ends[i] = reference_end(&large[i], 32768);
    }
    for (size_t s = 0; s < COUNT_OF(settings); s++) {
        for (uint32_t substeps = 1; substeps <= 4; substeps *= 2) {
            const uint32_t taken = settings[s].solver == MSPRING_SOLVER_EXPLICIT ? 30 * substeps : substeps;
            printf("\n| %s, %u substep%s |", settings[s].name, (unsigned)taken, taken > 1 ? "s" : "");
            for (size_t i = 0; i < COUNT_OF(large); i++) {
                const errors e = errors_of(&large[i], &settings[s], 64, taken, &ends[i]);
                printf(" %.2f | %.1f |", 1e3 * e.position, 1e3 * e.velocity);
            }
        }
    }
    printf("\n");
    for (size_t i = 0; i < COUNT_OF(large); i++) {
        free(ends[i].x);
    }
}

int main(int argc, char **argv) {
    if (argc > 1 && strcmp(argv[1], "table") == 0) {
        print_table();
        return 0;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_go_down_with_the_step),
    };
    return cmocka_run_group_tests_name("accuracy", tests, NULL, NULL);
}

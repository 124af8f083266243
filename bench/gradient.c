/// @file gradient.c
/// Cost of a run with its gradient, in steps without one: recorded steps, and all (with the way back). 40 substeps.
///
///     bench_gradient [TURNS]   the least of so many turns of each, by default 5, in processor time
///
/// SPDX-License-Identifier: MIT
#include <float.h>
#include <massspring/massspring_gradient.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define DT (1.0 / 64)

/// A scene: a lattice with equal sides, or a disc.
typedef struct scene {
    const char *name;
    uint32_t side, rings, steps;
} scene;

/// Processor time of a run, s.
typedef struct cost {
    double plain, recorded, all;
} cost;

static double now(void) {
    return (double)clock() / CLOCKS_PER_SEC;
}

static void check(mspring_result result) {
    if (result != MSPRING_OK) {
        fprintf(stderr, "%s\n", mspring_result_string(result));
        exit(1);
    }
}

static mspring_network *make(const scene *s, float damping) {
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_material material = mspring_material_default();
    mspring_lattice_def lattice = mspring_lattice_def_default();
    mspring_disc_def disc = mspring_disc_def_default();
    mspring_network_def def = mspring_network_def_default();
    material.mass = 1;
    material.stiffness = 500;
    material.damping = damping;
    lattice.width = lattice.height = s->side;
    lattice.materials = &material;
    disc.ring_count = s->rings;
    disc.radius = s->rings;
    disc.material = &material;
    def.settings.substeps = 40;
    check(mspring_builder_create(NULL, &builder));
    check(s->side > 0 ? mspring_builder_add_lattice(builder, &lattice, NULL)
                      : mspring_builder_add_disc(builder, &disc, NULL, NULL));
    check(mspring_network_create(builder, &def, &network));
    mspring_builder_destroy(builder);
    for (mspring_id p = 0; p < mspring_network_count(network, MSPRING_PARTICLES); p++) {
        const float v[2] = {0.1f * (float)((p * 7919 % 201) / 100.0 - 1),
                            0.1f * (float)((p * 104729 % 211) / 105.0 - 1)};
        check(mspring_network_set_velocities(network, NULL, p, 1, v, v + 1, 2));
    }
    return network;
}

static void run(const scene *s, float damping, cost *least) {
    static const double seed[2] = {0, 1};
    mspring_network *network = make(s, damping), *other = make(s, damping);
    mspring_gradient *gradient = NULL;
    check(mspring_gradient_create(other, s->steps, NULL, 0, &gradient));
    const double begin = now();
    for (uint32_t i = 0; i < s->steps; i++)
        check(mspring_network_step(network, DT));
    const double plain = now();
    for (uint32_t i = 0; i < s->steps; i++)
        check(mspring_gradient_step(gradient, DT, NULL, NULL));
    const double recorded = now();
    check(mspring_gradient_add_seeds(gradient, NULL, 0, 1, seed, NULL));
    check(mspring_gradient_reverse(gradient, s->steps));
    const cost took = {plain - begin, recorded - plain, now() - plain};
    least->plain = took.plain < least->plain ? took.plain : least->plain;
    least->recorded = took.recorded < least->recorded ? took.recorded : least->recorded;
    least->all = took.all < least->all ? took.all : least->all;
    mspring_gradient_destroy(gradient);
    mspring_network_destroy(network);
    mspring_network_destroy(other);
}

int main(int argc, char **argv) {
    static const scene scenes[] = {{"lattice, 6 x 6", 6, 0, 4000},
                                   {"lattice, 20 x 20", 20, 0, 400},
                                   {"lattice, 100 x 100", 100, 0, 40},
                                   {"disc, 127 particles", 0, 6, 800},
                                   {"disc, 2,791 particles", 0, 30, 40}};
    const int turns = argc > 1 ? atoi(argv[1]) : 5;
    printf("| network | dampers | us a step | recorded | all |\n|:---|:---|---:|---:|---:|\n");
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++)
        for (int is_damped = 0; is_damped < 2; is_damped++) {
            cost c = {DBL_MAX, DBL_MAX, DBL_MAX};
            for (int turn = 0; turn < turns; turn++)
                run(&scenes[i], (float)is_damped, &c);
            printf("| %s | %s | %.1f | %.2f | %.1f |\n", scenes[i].name, is_damped ? "yes" : "no",
                   1e6 * c.plain / scenes[i].steps, c.recorded / c.plain, c.all / c.plain);
            fflush(stdout);
        }
    return 0;
}

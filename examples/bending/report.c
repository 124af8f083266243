/// @file report.c
/// Measures, table and CSV line.
///
/// SPDX-License-Identifier: MIT
#include "bending/report.h"

#include <massspring/massspring_tools.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void measure_spring(const mspring_spring_info *info, const float *masses, double substep,
                           spring_measures *measures) {
    double reduced_mass = 1 / (1 / (double)masses[info->a] + 1 / (double)masses[info->b]);
    double fraction = info->stiffness * substep * substep / reduced_mass;
    measures->least_stiffness = fminf(measures->least_stiffness, info->stiffness);
    measures->most_stiffness = fmaxf(measures->most_stiffness, info->stiffness);
    measures->most_damping = fmaxf(measures->most_damping, info->damping);
    measures->least_fraction = fmin(measures->least_fraction, fraction);
    measures->most_fraction = fmax(measures->most_fraction, fraction);
}

static bool measure_springs(mspring_network *network, const scene *measured, const float *masses, double substep,
                            spring_measures *measures) {
    for (mspring_id i = 0; i < mspring_network_spring_count(network); i++) {
        mspring_spring_info info = {.struct_size = sizeof info};
        if (mspring_network_get_spring(network, i, &info) != MSPRING_OK)
            return false;
        measure_spring(&info, masses, substep, measures);
        if (i == measures->strained) {
            measures->strain = info.strain;
            measures->strained_a = info.a;
            measures->strained_b = info.b;
        }
        if (!measured->break_strain || measured->break_strain[i] == 0)
            continue;
        measures->can_break = true;
        measures->broken += fabsf(info.strain) > measured->break_strain[i];
    }
    return true;
}

bool report_measure(mspring_network *network, const scene *measured, double substep, spring_measures *measures) {
    uint32_t particles = mspring_network_particle_count(network);
    *measures =
        (spring_measures){.least_stiffness = INFINITY, .least_fraction = INFINITY, .strained = MSPRING_NONE};
    float *masses = malloc(particles * sizeof *masses);
    bool ok = masses && mspring_network_get(network, MSPRING_MASS, 0, particles, masses, 1) == MSPRING_OK &&
              mspring_network_max_strain(network, NULL, &measures->strained) == MSPRING_OK &&
              measure_springs(network, measured, masses, substep, measures);
    free(masses);
    if (measures->least_stiffness > measures->most_stiffness) {
        measures->least_stiffness = 0;
        measures->least_fraction = 0;
    }
    return ok;
}

static void print_layout(mspring_network *network) {
    mspring_plan plan = {.struct_size = sizeof plan};
    if (mspring_network_get_plan(network, &plan) != MSPRING_OK)
        return;
    printf("  layout        ");
    if (plan.lattice_count)
        printf("%u lattice%s with %u springs, ", plan.lattice_count, plan.lattice_count == 1 ? "" : "s",
               plan.lattice_springs);
    if (plan.chain_count)
        printf("%u chain%s with %u springs, ", plan.chain_count, plan.chain_count == 1 ? "" : "s",
               plan.chain_springs);
    printf("%u other springs\n", plan.irregular_springs);
}

static void print_stiffness(const spring_measures *measures) {
    if (measures->least_stiffness == measures->most_stiffness)
        printf("  stiffness     %.6g N/m", measures->most_stiffness);
    else
        printf("  stiffness     %.4g to %.4g N/m", measures->least_stiffness, measures->most_stiffness);
    // Equal springs differ in this by how masses were rounded.
    if (measures->most_fraction - measures->least_fraction < 1e-3 * measures->most_fraction)
        printf(", %.3g of the explicit limit\n", measures->most_fraction);
    else
        printf(", %.3g to %.3g of the explicit limit\n", measures->least_fraction, measures->most_fraction);
}

static void print_strain(const spring_measures *measures) {
    if (measures->strained == MSPRING_NONE)
        return;
    printf("  most strain   %+.3g %%, spring %u between particles %u and %u\n", 100 * measures->strain,
           measures->strained, measures->strained_a, measures->strained_b);
    if (measures->can_break)
        printf("  would break   %u springs\n", measures->broken);
}

static const char *solver_name(const bending_options *options) {
    static const char *const names[] = {"explicit", "implicit", "direct"};
    return options->at_once ? "static" : names[options->solver];
}

void report_print_table(mspring_network *network, const scene *measured, const bending_options *options,
                        const settle_result *settled, const spring_measures *measures) {
    printf("%s\n", measured->name);
    printf("  network       %u particles, %u springs\n", mspring_network_particle_count(network),
           mspring_network_spring_count(network));
    print_layout(network);
    const char *level = mspring_simd_name(mspring_network_simd_level(network));
    if (options->at_once)
        printf("  solver        static equilibrium, %llu iterations, level %s\n",
               (unsigned long long)settled->steps, level);
    else
        printf("  solver        %s, %u substep%s in a step of %.6g s, level %s\n", solver_name(options),
               options->substeps, options->substeps == 1 ? "" : "s", options->dt, level);
    print_stiffness(measures);
    printf("  damping       %.6g N s/m\n", measures->most_damping);
    if (options->at_once)
        printf("  speed         %.4g us an iteration\n", settled->median_step_s * 1e6);
    else
        printf("  speed         %.4g us a step (median of %llu)\n", settled->median_step_s * 1e6,
               (unsigned long long)settled->steps);
    print_strain(measures);
    if (!options->at_once)
        printf("  settled       after %.4g s of simulated time\n", settled->time);
    if (measured->probe == MSPRING_NONE)
        printf("  displacement  %.6g m, mean of all particles: there is no probe\n", settled->drop);
    else
        printf("  bending       %.6g m\n", settled->drop);
}

void report_print_csv_header(void) {
    puts("scene,particles,springs,solver,substeps,stiffness,damping,dt,bending_m,settle_s,us_per_step_median,level,"
         "finite");
}

void report_print_csv(mspring_network *network, const scene *measured, const bending_options *options,
                      const settle_result *settled, const spring_measures *measures) {
    printf("%s,%u,%u,%s,%u,%.9g,%.9g,%.9g,", measured->name, mspring_network_particle_count(network),
           mspring_network_spring_count(network), solver_name(options), options->substeps, measures->most_stiffness,
           measures->most_damping, options->dt);
    // Not printf's nan, whose spelling differs from system to system.
    if (settled->end == SETTLE_AT_REST)
        printf("%.9g,%.9g,", settled->drop, settled->time);
    else
        printf("nan,nan,");
    printf("%.4g,%s,%d\n", settled->median_step_s * 1e6, mspring_simd_name(mspring_network_simd_level(network)),
           settled->end != SETTLE_UNSTABLE);
}

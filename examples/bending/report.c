/// @file report.c
/// Measures, table and CSV line.
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL // for lab.h
#include "bending/report.h"
#include "common/described.h"

#include <massspring/massspring.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// What is read of a spring.
typedef struct spring_state {
    mspring_id a, b;
    float stiffness, damping, strain;
} spring_state;

static void measure_spring(const spring_state *spring, const float *masses, double substep,
                           spring_measures *measures) {
    double reduced_mass = 1 / (1 / (double)masses[spring->a] + 1 / (double)masses[spring->b]);
    double fraction = spring->stiffness * substep * substep / reduced_mass;
    measures->least_stiffness = fminf(measures->least_stiffness, spring->stiffness);
    measures->most_stiffness = fmaxf(measures->most_stiffness, spring->stiffness);
    measures->most_damping = fmaxf(measures->most_damping, spring->damping);
    measures->least_fraction = fmin(measures->least_fraction, fraction);
    measures->most_fraction = fmax(measures->most_fraction, fraction);
}

static bool measure_springs(mspring_network *network, const scene *measured, const float *masses, double substep,
                            spring_measures *measures) {
    for (mspring_id i = 0; i < mspring_network_count(network, MSPRING_SPRINGS); i++) {
        spring_state spring;
        const mspring_column columns[] = {{MSPRING_END_A, 1, &spring.a},
                                          {MSPRING_END_B, 1, &spring.b},
                                          {MSPRING_ACTIVE_STIFFNESS, 1, &spring.stiffness},
                                          {MSPRING_ACTIVE_DAMPING, 1, &spring.damping},
                                          {MSPRING_STRAIN, 1, &spring.strain}};
        if (mspring_network_get_columns(network, NULL, i, 1, columns, 5) != MSPRING_OK)
            return false;
        measure_spring(&spring, masses, substep, measures);
        if (i == measures->strained) {
            measures->strain = spring.strain;
            measures->strained_a = spring.a;
            measures->strained_b = spring.b;
        }
        if (!measured->break_strain || measured->break_strain[i] == 0)
            continue;
        measures->can_break = true;
        measures->broken += fabsf(spring.strain) > measured->break_strain[i];
    }
    return true;
}

bool report_measure(mspring_network *network, const scene *measured, double substep, spring_measures *measures) {
    uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES);
    *measures =
        (spring_measures){.least_stiffness = INFINITY, .least_fraction = INFINITY, .strained = MSPRING_NONE};
    mspring_energy energy = mspring_energy_default();
    float *masses = malloc(particles * sizeof *masses);
    bool ok = masses && mspring_network_get(network, MSPRING_MASS, NULL, 0, particles, masses, 1) == MSPRING_OK &&
              mspring_network_get_energy(network, &energy) == MSPRING_OK;
    measures->strained = energy.strained;
    ok = ok && measure_springs(network, measured, masses, substep, measures);
    free(masses);
    if (measures->least_stiffness > measures->most_stiffness) {
        measures->least_stiffness = 0;
        measures->least_fraction = 0;
    }
    return ok;
}

static void print_layout(mspring_network *network) {
    char text[DESCRIBED_SIZE];
    if (mspring_network_describe(network, text, sizeof text, NULL) != MSPRING_OK)
        return;
    printf("  layout        ");
    const double lattices = described_number(text, "lattice_count"), chains = described_number(text, "chain_count");
    if (lattices > 0)
        printf("%.0f lattice%s with %.0f springs, ", lattices, lattices == 1 ? "" : "s",
               described_number(text, "lattice_springs"));
    if (chains > 0)
        printf("%.0f chain%s with %.0f springs, ", chains, chains == 1 ? "" : "s",
               described_number(text, "chain_springs"));
    printf("%.0f other springs\n", described_number(text, "irregular_springs"));
}

static const char *level_of(const mspring_network *network) {
    mspring_network_info info = mspring_network_info_default();
    return mspring_network_get_info(network, &info) == MSPRING_OK ? mspring_simd_name(info.simd_level) : "unknown";
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
    printf("  network       %u particles, %u springs\n", mspring_network_count(network, MSPRING_PARTICLES),
           mspring_network_count(network, MSPRING_SPRINGS));
    print_layout(network);
    const char *level = level_of(network);
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
    printf("%s,%u,%u,%s,%u,%.9g,%.9g,%.9g,", measured->name, mspring_network_count(network, MSPRING_PARTICLES),
           mspring_network_count(network, MSPRING_SPRINGS), solver_name(options), options->substeps,
           measures->most_stiffness, measures->most_damping, options->dt);
    // Not printf's nan, whose spelling differs from system to system.
    if (settled->end == SETTLE_AT_REST)
        printf("%.9g,%.9g,", settled->drop, settled->time);
    else
        printf("nan,nan,");
    printf("%.4g,%s,%d\n", settled->median_step_s * 1e6, level_of(network), settled->end != SETTLE_UNSTABLE);
}

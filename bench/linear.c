/// @file linear.c
/// The sparse direct solver: what it costs to factor and solve the system of an implicit step of dt,
///
///     A = M + dt^2 / 2 K,     K of one spring: k n n^T, n its direction,
///
/// measured in turn with explicit steps of the same network, in units of their substeps.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <massspring/massspring.h>

#include "machine.h"
#include "modes.h"
#include "solvers/sparse/cholesky.h"

static const char *const default_scenes[] = {"bar_80x5", "grid_96x96", "bar_544x68", "bar_1800x5", NULL};

static const bench_column columns[] = {
    {"scene", "scene", -16},
    {"nodes", "nodes", 8},
    {"edges", "edges", 8},
    {"precision", "precision", -9},
    {"level", "level", -6},
    {"plan_ms", "plan ms", 8},
    {"factor_kilobytes", "factor kB", 10},
    {"mega_products", "Mproducts", 10},
    {"us_factor_solve_min", "us min", 10},
    {"us_factor_solve_median", "us median", 10},
    {"substeps_median", "substeps", 9},
};

#define COLUMN_COUNT ((int)(sizeof columns / sizeof *columns))

/// A matrix in both precisions, its factor in one, and a right side. Blocks are [xx xy yy][node or edge].
typedef struct linear_system {
    mspringi_memory memory;
    mspringi_message message;
    mspringi_cholesky_symbolic plan;
    mspringi_cholesky_float single;
    mspringi_cholesky_double twice;
    uint32_t nodes, edges;
    uint32_t *a, *b;
    bool *absent;
    double *x, *y, *node, *edge, *solution_x, *solution_y;
    float *node_float, *edge_float, *solution_x_float, *solution_y_float;
    bool in_double;
    double plan_seconds;
} linear_system;

static void system_free(linear_system *s) {
    mspringi_cholesky_float_destroy(&s->single, &s->memory);
    mspringi_cholesky_double_destroy(&s->twice, &s->memory);
    mspringi_cholesky_symbolic_destroy(&s->plan, &s->memory);
    void *const blocks[] = {s->a,
                            s->b,
                            s->absent,
                            s->x,
                            s->y,
                            s->node,
                            s->edge,
                            s->solution_x,
                            s->solution_y,
                            s->node_float,
                            s->edge_float,
                            s->solution_x_float,
                            s->solution_y_float};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        free(blocks[i]);
    }
}

static bool reserve(linear_system *s, scene_error *error) {
    const size_t nodes = s->nodes, edges = s->edges;
    return (s->a = bench_allocate(edges, sizeof *s->a, error)) &&
           (s->b = bench_allocate(edges, sizeof *s->b, error)) &&
           (s->absent = bench_allocate(nodes, sizeof *s->absent, error)) &&
           (s->x = bench_allocate(nodes, sizeof *s->x, error)) &&
           (s->y = bench_allocate(nodes, sizeof *s->y, error)) &&
           (s->node = bench_allocate(3 * nodes, sizeof *s->node, error)) &&
           (s->edge = bench_allocate(3 * edges, sizeof *s->edge, error)) &&
           (s->solution_x = bench_allocate(nodes, sizeof *s->solution_x, error)) &&
           (s->solution_y = bench_allocate(nodes, sizeof *s->solution_y, error)) &&
           (s->node_float = bench_allocate(3 * nodes, sizeof *s->node_float, error)) &&
           (s->edge_float = bench_allocate(3 * edges, sizeof *s->edge_float, error)) &&
           (s->solution_x_float = bench_allocate(nodes, sizeof *s->solution_x_float, error)) &&
           (s->solution_y_float = bench_allocate(nodes, sizeof *s->solution_y_float, error));
}

static bool add_spring(linear_system *s, mspring_network *network, uint32_t spring) {
    mspring_id a, b;
    float stiffness;
    const mspring_column read[] = {
        {MSPRING_END_A, 1, &a}, {MSPRING_END_B, 1, &b}, {MSPRING_ACTIVE_STIFFNESS, 1, &stiffness}};
    if (mspring_network_get_columns(network, NULL, spring, 1, read, 3) != MSPRING_OK) {
        return false;
    }
    s->a[spring] = a;
    s->b[spring] = b;
    const double dx = s->x[b] - s->x[a], dy = s->y[b] - s->y[a], length = hypot(dx, dy);
    const double k = length > 0 ? 0.5 * BENCH_DT * BENCH_DT * (double)stiffness / (length * length) : 0;
    const double block[3] = {k * dx * dx, k * dx * dy, k * dy * dy};
    for (size_t i = 0; i < 3; i++) {
        s->node[i * s->nodes + a] += block[i];
        s->node[i * s->nodes + b] += block[i];
        s->edge[i * s->edges + spring] = -block[i];
        s->edge_float[i * s->edges + spring] = (float)-block[i];
    }
    return true;
}

/// The system of the network as it is.
static bool fill(linear_system *s, mspring_network *network) {
    mspring_view view = mspring_view_default();
    if (mspring_network_get_view(network, &view) != MSPRING_OK ||
        mspring_network_get_positions(network, NULL, 0, s->nodes, s->x, s->y, 1) != MSPRING_OK) {
        return false;
    }
    memset(s->node, 0, 3 * (size_t)s->nodes * sizeof *s->node);
    for (uint32_t i = 0; i < s->edges; i++) {
        if (!add_spring(s, network, i)) {
            return false;
        }
    }
    for (uint32_t i = 0; i < s->nodes; i++) {
        const double inverse_mass = (double)view.inverse_mass[view.slot_of_particle[i]];
        s->absent[i] = inverse_mass == 0;
        s->node[i] += s->absent[i] ? 0 : 1 / inverse_mass;
        s->node[2 * (size_t)s->nodes + i] += s->absent[i] ? 0 : 1 / inverse_mass;
    }
    for (size_t i = 0; i < 3 * (size_t)s->nodes; i++) {
        s->node_float[i] = (float)s->node[i];
    }
    return true;
}

static bool analyse(linear_system *s, mspring_simd level, scene_error *error) {
    const mspringi_cholesky_graph graph = {s->nodes, s->edges, s->a, s->b, s->absent, s->x, s->y, 0};
    const double start = bench_seconds();
    bool ok = mspringi_cholesky_symbolic_create(&s->plan, &graph, &s->memory, &s->message) == MSPRING_OK;
    s->plan_seconds = bench_seconds() - start;
    ok = ok && mspringi_cholesky_float_create(&s->single, &s->plan, level, &s->memory, &s->message) == MSPRING_OK &&
         mspringi_cholesky_double_create(&s->twice, &s->plan, level, &s->memory, &s->message) == MSPRING_OK;
    if (!ok) {
        snprintf(error->text, sizeof error->text, "%.200s", s->message.text);
    }
    return ok;
}

static bool system_create(bench_network *from, mspring_simd level, linear_system *out, scene_error *error) {
    memset(out, 0, sizeof *out);
    out->nodes = from->particle_count;
    out->edges = from->spring_count;
    if (mspringi_memory_init(&out->memory, NULL, &out->message) != MSPRING_OK || !reserve(out, error)) {
        return false;
    }
    if (!fill(out, from->network)) {
        snprintf(error->text, sizeof error->text, "cannot read the network");
        return false;
    }
    return analyse(out, level, error);
}

static bool reset_system(void *self, scene_error *error) {
    (void)self;
    (void)error;
    return true;
}

static bool run_system(void *self, uint32_t steps, scene_error *error) {
    linear_system *s = self;
    const size_t nodes = s->nodes, edges = s->edges;
    const mspringi_cholesky_matrix_float single = {s->node_float, s->node_float + nodes, s->node_float + 2 * nodes,
                                                   s->edge_float, s->edge_float + edges, s->edge_float + 2 * edges};
    const mspringi_cholesky_matrix_double twice = {s->node, s->node + nodes, s->node + 2 * nodes,
                                                   s->edge, s->edge + edges, s->edge + 2 * edges};
    for (uint32_t step = 0; step < steps; step++) {
        for (size_t i = 0; i < nodes; i++) {
            s->solution_x[i] = s->solution_x_float[i] = 1;
            s->solution_y[i] = s->solution_y_float[i] = -2;
        }
        const uint32_t bad =
            s->in_double ? mspringi_cholesky_double_factor_solve(&s->twice, &twice, s->solution_x, s->solution_y)
                         : mspringi_cholesky_float_factor_solve(&s->single, &single, s->solution_x_float,
                                                                s->solution_y_float);
        if (bad != MSPRING_NONE) {
            snprintf(error->text, sizeof error->text, "the matrix is not positive definite at node %u", bad);
            return false;
        }
    }
    return true;
}

static bool measure(const bench_scene *subject, const bench_options *options, bench_network *network,
                    linear_system *s, scene_error *error) {
    const uint32_t repeat = options->repeat > 0 ? options->repeat : bench_default_repeat(network->spring_count);
    const bench_runner explicit_steps = bench_network_runner(network);
    const bench_runner solutions = {s, reset_system, run_system};
    for (int in_double = 0; in_double < 2; in_double++) {
        bench_turns turns;
        s->in_double = in_double;
        if (!bench_turns_measure(&explicit_steps, &solutions, repeat, &turns, error)) {
            return false;
        }
        const size_t size = in_double ? sizeof(double) : sizeof(float);
        const bench_cell cells[COLUMN_COUNT] = {
            bench_cell_of("%s", subject->label),
            bench_cell_of("%u", s->plan.size),
            bench_cell_of("%u", s->edges),
            bench_cell_of("%s", in_double ? "double" : "float"),
            bench_cell_of("%s", mspring_simd_name(bench_level_of(network->network))),
            bench_cell_of("%.2f", 1e3 * s->plan_seconds),
            bench_cell_of("%.0f", 1e-3 * (double)(s->plan.panel_reals * size)),
            bench_cell_of("%.3f", 1e-6 * s->plan.multiply_adds),
            bench_cell_of("%.2f", 1e6 * turns.second_min),
            bench_cell_of("%.2f", 1e6 * turns.second_median),
            bench_cell_of("%.1f", turns.ratio_median * network->substeps),
        };
        bench_table_row(options->format, columns, COLUMN_COUNT, cells);
    }
    return true;
}

static bool measure_level(const bench_scene *subject, const bench_options *options, mspring_simd level) {
    const uint32_t springs = mspring_builder_count(subject->made.builder, MSPRING_SPRINGS);
    const uint32_t substeps = options->substeps > 0 ? options->substeps : bench_default_substeps(springs);
    bench_network network;
    linear_system system;
    scene_error error;
    if (!bench_network_create(subject->made.builder, level, 1, substeps, &network, &error)) {
        bench_complain(subject->label, &error);
        return false;
    }
    bench_runner runner = bench_network_runner(&network);
    bool ok = runner.run(&network, 1, &error); /* relative springs have their stiffness after a step */
    if (ok) {
        ok =
            system_create(&network, level, &system, &error) && measure(subject, options, &network, &system, &error);
        system_free(&system);
    }
    if (!ok) {
        bench_complain(subject->label, &error);
    }
    bench_network_free(&network);
    return ok;
}

bool bench_run_linear(const bench_options *options) {
    bench_table_preamble(options->format);
    bench_table_head(options->format, columns, COLUMN_COUNT);
    return bench_for_each_level(options, default_scenes, measure_level);
}

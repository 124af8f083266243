/// @file board.c
/// massspring-board: error and firmness against cost, for the library and for methods of others.
///
///     massspring-board [--out FOLDER]
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "board/methods.h"
#include "common/clock.h"
#include "common/output.h"
#include "draw/scatter.h"
#include "scenes/scene.h"

static const double dt = 1.0 / 64; // s

/// What is moved.
typedef struct stage {
    const char *name, *title;
    uint32_t columns, rows;
    float stiffness;          ///< N/m
    uint64_t reference_steps; ///< of the reference, in 1 s
    bool settles;             ///< whether its sag at rest is measured, too
} stage;

static const stage stages[] = {
    {"bar_80x5", "Bar of 80 x 5, 6.76e7 N/m", 80, 5, 6.7643e7f, 65536, true},
    {"bar_80x5_stiff", "Bar of 80 x 5, 1e10 N/m", 80, 5, 1e10f, 524288, true},
    {"bar_272x34", "Bar of 272 x 34, 6.76e7 N/m", 272, 34, 6.7643e7f, 16384, false},
};
enum { STAGES = sizeof stages / sizeof *stages, METHODS = 8, MOST_EFFORTS = 6 };

static const method *const methods[METHODS] = {&board_ours[0], &board_ours[1], &board_ours[2], &board_naive,
                                               &board_pbd,     &board_xpbd,    &board_vbd,     &board_projective};
static const draw_colour colours[METHODS] = {0x1b3a8f, 0x2f7fd6, 0x7fb2e5, 0x8b8d98,
                                             0xb0762e, 0xe07b10, 0xc0392b, 0x2e9e5b};

/// Frames that take longer are not measured, us, and their sag at rest not even before.
enum { DEAREST_FRAME = 20000, DEAREST_SETTLED = 4000 };

/// One method at one effort.
typedef struct result {
    uint32_t effort;
    double us;    ///< of a frame
    double error; ///< after 1 s, as a share of how far the network has moved
    double soft;  ///< sag at rest over that of the springs as given, less 1; NaN: not measured
} result;

typedef struct reference {
    double *x, *y;   ///< after 1 s
    double distance; ///< by how much it has moved
    double sag;
} reference;

static double omega_of_sag(double sag) {
    return 1.24 * sqrt(9.8 / sag);
}

// Sag at rest: damped as the slowest oscillation needs it, until that has died out.
static double settled(const method *by, const model *m, uint32_t effort, double sag) {
    const double omega = omega_of_sag(sag);
    motion run;
    double *x = malloc(m->particle_count * sizeof *x), *y = malloc(m->particle_count * sizeof *y), found = NAN;
    if (motion_begin(&run, by, m, effort, 2 * omega, dt) && x && y) {
        for (double time = 0; time < 13 / omega; time += dt)
            by->frame(&run, dt);
        motion_positions(&run, by, x, y);
        found = (m->y[m->probe] - y[m->probe]) / sag - 1;
    }
    motion_end(&run, by);
    free(x);
    free(y);
    return found;
}

static result measure(const method *by, const model *m, const reference *exact, uint32_t effort, bool settles) {
    enum { REPEATS = 3, FRAMES = 64 };
    result found = {.effort = effort, .us = INFINITY, .error = NAN, .soft = NAN};
    double *x = malloc(m->particle_count * sizeof *x), *y = malloc(m->particle_count * sizeof *y);
    for (int repeat = 0; repeat < REPEATS && x && y; repeat++) {
        motion run;
        if (motion_begin(&run, by, m, effort, 0, dt)) {
            const double start = clock_processor_seconds();
            for (int i = 0; i < FRAMES; i++)
                by->frame(&run, dt);
            found.us = fmin(found.us, (clock_processor_seconds() - start) * 1e6 / FRAMES);
            motion_positions(&run, by, x, y);
            found.error = model_distance(m, x, y, exact->x, exact->y) / exact->distance;
        }
        motion_end(&run, by);
    }
    free(x);
    free(y);
    if (settles && found.us < DEAREST_SETTLED)
        found.soft = settled(by, m, effort, exact->sag);
    return found;
}

static bool find_reference(const stage *on, const model *m, reference *exact) {
    const size_t n = m->particle_count;
    exact->x = malloc(n * sizeof *exact->x);
    exact->y = malloc(n * sizeof *exact->y);
    if (!exact->x || !exact->y)
        return false;
    for (size_t i = 0; i < n; i++) {
        exact->x[i] = m->x[i];
        exact->y[i] = m->y[i];
    }
    const bool good = model_move(m, 1, on->reference_steps, exact->x, exact->y);
    exact->distance = model_distance(m, m->x, m->y, exact->x, exact->y);
    exact->sag = on->settles ? model_settled_sag(m) : NAN;
    return good;
}

static scatter_point point_of(const result *found, bool firmness) {
    return (scatter_point){.x = found->us, .y = fabs(firmness ? found->soft : found->error)};
}

static bool draw(const stage *on, const result results[METHODS][MOST_EFFORTS], bool firmness, const char *folder) {
    static scatter_point points[METHODS][MOST_EFFORTS];
    scatter_series series[METHODS];
    char name[64];
    for (int i = 0; i < METHODS; i++) {
        size_t count = 0;
        for (int e = 0; e < MOST_EFFORTS && results[i][e].effort > 0; e++) {
            const scatter_point point = point_of(&results[i][e], firmness);
            if (isfinite(point.y) && point.y < 10)
                points[i][count++] = point;
        }
        series[i] = (scatter_series){.points = points[i],
                                     .count = count,
                                     .mark = i < 3 ? SCATTER_DISC : SCATTER_SQUARE,
                                     .colour = colours[i],
                                     .name = methods[i]->name,
                                     .joined = true};
    }
    figure drawn;
    figure_start(&drawn, 800, 560, 0xffffff);
    scatter_draw(&drawn,
                 &(scatter){.title = on->title,
                            .x_label = "time of a frame of 1/64 s, us",
                            .y_label = firmness ? "error of the sag at rest" : "error of positions after 1 s",
                            .series = series,
                            .series_count = METHODS,
                            .percent = true},
                 0, 0, 800, 560);
    snprintf(name, sizeof name, "board_%s%s", on->name, firmness ? "_sag" : "");
    const bool good = output_figure(&drawn, folder, name);
    figure_free(&drawn);
    return good;
}

static void run_method(const stage *on, const model *m, const reference *exact, const method *by,
                       result results[MOST_EFFORTS]) {
    const uint32_t least = by->by_stability ? (uint32_t)ceil(dt / model_stable_substep(m) / 0.9) : 1;
    for (int e = 0; e < MOST_EFFORTS && by->efforts[e] > 0; e++) {
        if (e > 0 && results[e - 1].us * by->efforts[e] / by->efforts[e - 1] > DEAREST_FRAME)
            break;
        results[e] = measure(by, m, exact, by->efforts[e] * least, on->settles);
        printf("%s,%s,%u,%s,%.2f,%.6g,%.6g\n", on->name, by->name, (unsigned)results[e].effort, by->effort,
               results[e].us, results[e].error, results[e].soft);
        fflush(stdout);
    }
}

static bool run(const stage *on, const char *folder) {
    result results[METHODS][MOST_EFFORTS] = {{{0}}};
    scene_options options = scene_options_default();
    scene made;
    scene_error error = {""};
    model m;
    reference exact = {0};
    options.relative = false;
    options.stiffness = on->stiffness;
    options.damping = 0;
    if (!scene_bar(on->columns, on->rows, &options, &made, &error)) {
        fprintf(stderr, "massspring-board: %s\n", error.text);
        return false;
    }
    bool good = model_read(&m, made.builder, made.probe) && find_reference(on, &m, &exact);
    for (int i = 0; good && i < METHODS; i++)
        run_method(on, &m, &exact, methods[i], results[i]);
    good = good && draw(on, (const result(*)[MOST_EFFORTS])results, false, folder) &&
           (!on->settles || draw(on, (const result(*)[MOST_EFFORTS])results, true, folder));
    free(exact.x);
    free(exact.y);
    model_free(&m);
    scene_free(&made);
    return good;
}

int main(int count, char **arguments) {
    int exit_code = EXIT_SUCCESS;
    const char *folder = output_folder_from_arguments(
        count, arguments, "Error and firmness against cost, beside other methods.", &exit_code);
    if (!folder)
        return exit_code;
    printf("scene,method,effort,counts,us_per_frame,error_after_1_s,sag_error\n");
    bool good = true;
    for (int i = 0; good && i < STAGES; i++)
        good = run(&stages[i], folder);
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}

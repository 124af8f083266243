/// @file board.c
/// massspring-board: error and firmness against cost, for the library and for methods of others.
///
///     massspring-board [--out FOLDER]
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "board/energy.h"
#include "board/fracture.h"
#include "board/measures.h"
#include "common/output.h"
#include "draw/scatter.h"

enum { METHODS = BOARD_MOST_METHODS };

/// What a picture shows against the time of a frame.
typedef struct measured {
    const char *ending, *label;
    double (*of)(const result *found);
} measured;

static double error_after_1(const result *found) {
    return found->error[0];
}

static double error_after_10(const result *found) {
    return found->error[1];
}

static double softness(const result *found) {
    return fabs(found->soft);
}

static const measured pictures[] = {{"", "error of positions after 1 s", error_after_1},
                                    {"_10s", "error of positions after 10 s", error_after_10},
                                    {"_sag", "error of the sag at rest", softness}};
enum { PICTURES = sizeof pictures / sizeof *pictures };

static bool draw(const stage *on, const result results[METHODS][MOST_EFFORTS], const measured *what,
                 const char *folder) {
    static scatter_point points[METHODS][MOST_EFFORTS];
    scatter_series series[METHODS];
    char name[64];
    size_t all = 0;
    int methods = 0;
    for (int i = 0; board_methods[i]; i++) {
        size_t count = 0;
        for (int e = 0; e < MOST_EFFORTS && results[i][e].effort > 0; e++) {
            const scatter_point point = {.x = results[i][e].us, .y = what->of(&results[i][e])};
            if (isfinite(point.y) && point.y < 10)
                points[i][count++] = point;
        }
        series[i] = (scatter_series){.points = points[i],
                                     .count = count,
                                     .mark = i < OURS ? SCATTER_DISC : SCATTER_SQUARE,
                                     .colour = board_methods[i]->colour,
                                     .name = board_methods[i]->name,
                                     .joined = true};
        all += count;
        methods++;
    }
    if (all == 0)
        return true;
    figure drawn;
    figure_start(&drawn, 800, 560, 0xffffff);
    scatter_draw(&drawn,
                 &(scatter){.title = on->title,
                            .x_label = "time of a frame of 1/64 s, us",
                            .y_label = what->label,
                            .series = series,
                            .series_count = (size_t)methods,
                            .percent = true},
                 0, 0, 800, 560);
    snprintf(name, sizeof name, "board_%s%s", on->name, what->ending);
    const bool good = output_figure(&drawn, folder, name);
    figure_free(&drawn);
    return good;
}

static void run_method(const stage *on, const model *m, const reference *exact, const method *by,
                       result results[MOST_EFFORTS]) {
    const uint32_t least = by->by_stability ? least_substeps(m) : 1;
    for (int e = 0; e < MOST_EFFORTS && by->efforts[e] > 0; e++) {
        if (e > 0 && results[e - 1].us * by->efforts[e] / by->efforts[e - 1] > on->dearest)
            break;
        const result r = results[e] = measure(on, by, m, exact, by->efforts[e] * least);
        printf("%s,%s,%u,%s,%.2f,%.2f,%.6g,%.6g,%.6g,%.6g,%.6g\n", on->name, by->name, (unsigned)r.effort,
               by->effort, r.us, r.most_us, r.error[0], r.error[1], r.period, r.swing, r.soft);
        fflush(stdout);
    }
}

static bool run(const stage *on, const char *folder) {
    result results[METHODS][MOST_EFFORTS] = {{{0}}};
    model m;
    reference exact = {0};
    if (!stage_read(on, &m))
        return false;
    bool good = reference_find(on, &m, &exact);
    for (int i = 0; good && board_methods[i]; i++)
        run_method(on, &m, &exact, board_methods[i], results[i]);
    for (int i = 0; good && i < PICTURES; i++)
        good = draw(on, (const result(*)[MOST_EFFORTS])results, &pictures[i], folder);
    reference_free(&exact);
    model_free(&m);
    return good;
}

int main(int count, char **arguments) {
    int exit_code = EXIT_SUCCESS;
    const char *folder = output_folder_from_arguments(
        count, arguments, "Error and firmness against cost, beside other methods.", &exit_code);
    if (!folder)
        return exit_code;
    printf("scene,method,effort,counts,us_per_frame_min,us_per_frame_max,error_after_1_s,error_after_10_s,period_"
           "error,"
           "swing_left,sag_error\n");
    bool good = true;
    for (int i = 0; good && i < STAGES; i++)
        good = run(&board_stages[i], folder);
    return good && fracture_board(folder) && energy_board(folder) ? EXIT_SUCCESS : EXIT_FAILURE;
}

/// @file energy.c
/// How far energy strays in a million substeps.
///
/// SPDX-License-Identifier: MIT
#include "board/energy.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "board/measures.h"
#include "common/output.h"
#include "draw/scatter.h"

/// A method at one effort.
typedef struct entrant {
    const method *by;
    uint32_t effort;
    bool shadowed; ///< the energy that substeps of symplectic Euler keep is looked at
    const char *name;
} entrant;

enum { ENTRANTS = 8, MOST_POINTS = 40, SUBSTEPS = 1000000 };

/// How far energy has been from that of the start, as a share of the most that moves in a swing.
typedef struct track {
    scatter_point points[MOST_POINTS]; ///< time, s; share
    size_t count;
} track;

static bool follow(const entrant *who, const model *m, double unit, uint32_t frames, track *out) {
    model_state state;
    motion run;
    double worst = 0, next = 1;
    if (!model_state_begin(m, &state))
        return false;
    if (!motion_begin(&run, who->by, m, who->effort, 0, FRAME_TIME)) {
        model_state_end(&state);
        return false;
    }
    const double h = who->shadowed ? FRAME_TIME / who->effort : 0, start = model_energy(m, &state, h);
    out->count = 0;
    for (uint32_t frame = 1; frame <= frames; frame++) {
        who->by->frame(&run, FRAME_TIME);
        motion_state(&run, who->by, &state);
        worst = fmax(worst, fabs(model_energy(m, &state, h) - start) / unit);
        if ((frame >= next || frame == frames) && out->count < MOST_POINTS) {
            out->points[out->count++] = (scatter_point){.x = frame * FRAME_TIME, .y = worst};
            next = fmax(frame + 1, frame * 1.5);
        }
    }
    motion_end(&run, who->by);
    model_state_end(&state);
    return true;
}

static bool draw(const entrant *entrants, const track *tracks, const char *folder) {
    scatter_series series[ENTRANTS];
    figure drawn;
    for (int i = 0; i < ENTRANTS; i++)
        series[i] = (scatter_series){.points = tracks[i].points,
                                     .count = tracks[i].count,
                                     .mark = entrants[i].shadowed ? SCATTER_DIAMOND : SCATTER_DISC,
                                     .colour = entrants[i].by->colour,
                                     .name = entrants[i].name,
                                     .joined = true};
    figure_start(&drawn, 800, 560, 0xffffff);
    scatter_draw(&drawn,
                 &(scatter){.title = "Energy of a bar of 80 x 5 that swings",
                            .x_label = "simulated time, s",
                            .y_label = "farthest that energy has strayed",
                            .series = series,
                            .series_count = ENTRANTS,
                            .percent = true},
                 0, 0, 800, 560);
    const bool good = output_figure(&drawn, folder, "board_energy");
    figure_free(&drawn);
    return good;
}

bool energy_board(const char *folder) {
    static track tracks[ENTRANTS];
    model m;
    reference exact = {0};
    const stage *on = &board_stages[0];
    if (!stage_read(on, &m))
        return false;
    const uint32_t least = least_substeps(&m), frames = SUBSTEPS / least;
    const entrant entrants[ENTRANTS] = {
        {&board_ours[0], MSPRING_SUBSTEPS_AUTO, false, "ours, explicit, its own number"},
        {&board_precise, MSPRING_SUBSTEPS_AUTO, false, "the same, precise"},
        {&board_ours[1], 4, false, "ours, implicit, 4 substeps"},
        {&board_ours[2], 4, false, "ours, direct, 4 substeps"},
        {&board_naive, least, false, "plain loop, double precision"},
        {&board_naive, least, true, "the same, h v F / 2 added"},
        {&board_xpbd, 64, false, "XPBD, 64 substeps"},
        {&board_projective, 8, false, "projective dynamics, 8 iterations"},
    };
    bool good = reference_find(&(stage){.reference_steps = SECOND}, &m, &exact) && frames > 0;
    printf("\nmethod,effort,energy_of,after_s,strayed\n");
    for (int i = 0; good && i < ENTRANTS; i++) {
        good = follow(&entrants[i], &m, exact.rise / 2, frames, &tracks[i]);
        for (size_t j = 0; good && j < tracks[i].count; j++)
            printf("%s,%u,%s,%g,%.4g\n", entrants[i].by->name, (unsigned)entrants[i].effort,
                   entrants[i].shadowed ? "modified" : "plain", tracks[i].points[j].x, tracks[i].points[j].y);
        fflush(stdout);
    }
    good = good && draw(entrants, tracks, folder);
    reference_free(&exact);
    model_free(&m);
    return good;
}

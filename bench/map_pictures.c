/// @file map_pictures.c
/// The map of stability as pictures.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include "draw/colour_scale.h"
#include "map.h"

enum { LEFT = 92, RIGHT = 20, TOP = 76, BOTTOM = 78, GAP = 26, HEAD = 24 };

static const draw_colour ink = 0x26262e, quiet = 0x62646e, paper = 0xffffff;

/// Where the panels of a picture are: one column for each shape.
typedef struct panels {
    uint32_t cell_width, cell_height, rows, lines; ///< pixels; cells from top to bottom in a panel; panels
} panels;

static uint32_t panel_width(const panels *p) {
    return p->cell_width * EXTREME_STIFFNESSES;
}
static uint32_t panel_height(const panels *p) {
    return p->cell_height * p->rows;
}
static double panel_left(const panels *p, uint32_t shape) {
    return LEFT + shape * (double)(panel_width(p) + GAP);
}
static double panel_top(const panels *p, uint32_t line) {
    return TOP + line * (double)(panel_height(p) + HEAD + GAP / 2);
}

static void begin(figure *made, const panels *p, const char *title) {
    figure_start(made, LEFT + RIGHT + EXTREME_SHAPES * panel_width(p) + (EXTREME_SHAPES - 1) * GAP,
                 TOP + BOTTOM + p->lines * (panel_height(p) + HEAD) - HEAD + (p->lines - 1) * (GAP / 2), paper);
    figure_text(made, LEFT, 28, 17, FIGURE_LEFT, ink, title);
}

// Stiffness below a panel.
static void label_stiffness(figure *target, const panels *p, uint32_t shape) {
    const double top = panel_top(p, p->lines - 1) + panel_height(p);
    for (int k = 0; k < EXTREME_STIFFNESSES; k += 2) {
        char text[16];
        snprintf(text, sizeof text, "%d", k);
        figure_text(target, panel_left(p, shape) + (k + 0.5) * p->cell_width, top + 15, 10, FIGURE_CENTRE, quiet,
                    text);
    }
    figure_text(target, panel_left(p, shape) + panel_width(p) / 2.0, top + 32, 11, FIGURE_CENTRE, ink,
                "stiffness, powers of ten, N/m");
}

static bool finish(figure *drawn, const char *path, draw_error *error) {
    const bool written = figure_write_png(drawn, path, error);
    figure_free(drawn);
    return written;
}

/* ---------------------------------------------------------------------------------------------------- outcomes */

static const struct {
    draw_colour colour;
    const char *name;
    uint32_t left; ///< of its place below, pixels
} kinds[] = {{0x2f7fd6, "stable", 0},
             {0xf4b860, "a step refused with its cause", 120},
             {0xa2a4ac, "the network refused", 420},
             {0xc00000, "not finite, diverged or failed", 640}};
enum { KINDS = sizeof kinds / sizeof *kinds };

// A cell is divided from left to right as its cases are.
static void draw_cell(figure *target, double left, double top, const panels *p, const uint32_t *outcomes) {
    uint32_t counts[KINDS] = {0}, all = 0;
    for (int i = 0; i < EXTREME_OUTCOMES; i++) {
        counts[i < KINDS ? i : KINDS - 1] += outcomes[i];
        all += outcomes[i];
    }
    uint32_t before = 0;
    const double width = p->cell_width - 1.0;
    for (int i = 0; i < KINDS && all > 0; i++) {
        if (counts[i] > 0)
            figure_rectangle(target, left + width * before / all, top, width * counts[i] / all,
                             p->cell_height - 1.0, kinds[i].colour);
        before += counts[i];
    }
}

bool map_draw_outcomes(const map *drawn, const char *path, draw_error *error) {
    const panels p = {17, 17, EXTREME_STEPS, EXTREME_WAYS};
    figure made;
    begin(&made, &p, "What becomes of networks at the extremes, by stiffness and step");
    for (uint32_t shape = 0; shape < EXTREME_SHAPES; shape++) {
        for (uint32_t way = 0; way < EXTREME_WAYS; way++) {
            const double left = panel_left(&p, shape), top = panel_top(&p, way);
            char title[80];
            snprintf(title, sizeof title, "%s, %s", extreme_shape_name((extreme_shape)shape),
                     extreme_way_of(way).name);
            figure_text(&made, left, top - 7, 12, FIGURE_LEFT, ink, title);
            for (uint32_t dt = 0; dt < EXTREME_STEPS; dt++) {
                const double y = top + (EXTREME_STEPS - 1 - dt) * p.cell_height;
                char text[24];
                snprintf(text, sizeof text, "%.3g s", extreme_dt(dt));
                if (shape == 0)
                    figure_text(&made, LEFT - 8, y + 12, 10, FIGURE_RIGHT, quiet, text);
                for (uint32_t k = 0; k < EXTREME_STIFFNESSES; k++)
                    draw_cell(&made, left + k * p.cell_width, y, &p, drawn->outcomes[shape][way][k][dt]);
            }
        }
        label_stiffness(&made, &p, shape);
    }
    for (int i = 0; i < KINDS; i++) {
        figure_rectangle(&made, LEFT + kinds[i].left, made.height - 24.0, 12, 12, kinds[i].colour);
        figure_text(&made, LEFT + kinds[i].left + 18, made.height - 13.0, 12, FIGURE_LEFT, ink, kinds[i].name);
    }
    return finish(&made, path, error);
}

/* ----------------------------------------------------------------------------------------------------- borders */

/// Rows of one pair of ratio and damper, and off by how much has the strongest colour.
enum { ROWS_OF_A_PAIR = EXTREME_SPACINGS * EXTREME_PLACES };
static const double limit = 0.03;

static void draw_legend(figure *target) {
    const double left = LEFT, top = target->height - 24.0, step = 8;
    for (int i = 0; i < COLOUR_SCALE_STEPS; i++)
        figure_rectangle(target, left + i * step, top, step, 12, colour_scale_step(i));
    const char *const texts[] = {"3 % below", "as predicted", "3 % above"};
    const double places[] = {0, COLOUR_SCALE_STEPS / 2.0, COLOUR_SCALE_STEPS};
    for (int i = 0; i < 3; i++)
        figure_text(target, left + places[i] * step, top - 5, 10, (figure_align)i, quiet, texts[i]);
}

bool map_draw_borders(const map *drawn, const char *path, draw_error *error) {
    static const char *const ratios[EXTREME_RATIOS] = {"1", "1e3", "1e6"};
    static const char *const dampers[EXTREME_DAMPERS] = {"none", "0.1", "10"};
    const panels p = {17, 5, EXTREME_RATIOS * EXTREME_DAMPERS * ROWS_OF_A_PAIR, 1};
    figure made;
    begin(&made, &p, "Explicit border: measured over predicted by mspring_network_stable_dt");
    for (uint32_t number = 0; number < EXTREME_NETWORKS; number++) {
        const extreme_network n = extreme_network_of(number);
        const uint32_t row =
            (n.ratio * EXTREME_DAMPERS + n.damper) * ROWS_OF_A_PAIR + n.spacing * EXTREME_PLACES + n.place;
        const bool edge = row % ROWS_OF_A_PAIR == ROWS_OF_A_PAIR - 1;
        if (drawn->border[number] > 0)
            figure_rectangle(&made, panel_left(&p, n.shape) + n.stiffness * p.cell_width,
                             panel_top(&p, 0) + row * p.cell_height, p.cell_width - 1.0,
                             p.cell_height - (edge ? 1.0 : 0.0),
                             colour_scale_step(colour_scale_find(drawn->border[number] - 1, limit)));
    }
    for (uint32_t shape = 0; shape < EXTREME_SHAPES; shape++) {
        figure_text(&made, panel_left(&p, shape), panel_top(&p, 0) - 7, 12, FIGURE_LEFT, ink,
                    extreme_shape_name((extreme_shape)shape));
        label_stiffness(&made, &p, shape);
    }
    figure_text(&made, LEFT - 8, panel_top(&p, 0) - 20, 10, FIGURE_RIGHT, ink, "masses 1 :");
    figure_text(&made, LEFT - 8, panel_top(&p, 0) - 7, 10, FIGURE_RIGHT, ink, "dampers");
    for (int pair = 0; pair < EXTREME_RATIOS * EXTREME_DAMPERS; pair++) {
        char text[40];
        snprintf(text, sizeof text, "%s, %s", ratios[pair / EXTREME_DAMPERS], dampers[pair % EXTREME_DAMPERS]);
        figure_text(&made, LEFT - 8, panel_top(&p, 0) + (pair + 0.5) * ROWS_OF_A_PAIR * p.cell_height + 4, 10,
                    FIGURE_RIGHT, quiet, text);
    }
    draw_legend(&made);
    return finish(&made, path, error);
}

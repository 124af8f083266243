/// @file map_pictures.c
/// The map of stability as pictures.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include <massspring/massspring.h>

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
    figure_text(made, LEFT, 28, 14, FIGURE_LEFT, ink, title);
}

// Stiffness below a panel.
static void label_stiffness(figure *target, const panels *p, uint32_t shape) {
    const double top = panel_top(p, p->lines - 1) + panel_height(p);
    for (int k = 0; k < EXTREME_STIFFNESSES; k += 3) {
        char text[16];
        snprintf(text, sizeof text, k == 0 ? "1" : "1e%d", k);
        figure_text(target, panel_left(p, shape) + (k + 0.5) * p->cell_width, top + 15, 9, FIGURE_CENTRE, quiet,
                    text);
    }
    figure_text(target, panel_left(p, shape) + panel_width(p) / 2.0, top + 32, 10, FIGURE_CENTRE, ink,
                "stiffness, N/m");
}

// Fields lie close, those of one colour side by side in one rectangle; lines of paper part them afterwards.
typedef struct run {
    double left, top, width, height;
    draw_colour colour;
} run;

static void run_end(figure *target, run *last) {
    if (last->width > 0)
        figure_rectangle(target, last->left, last->top, last->width, last->height, last->colour);
    last->width = 0;
}

static void run_add(figure *target, run *last, run next) {
    if (last->width > 0 && next.colour == last->colour && next.top == last->top &&
        next.left == last->left + last->width) {
        last->width += next.width;
        return;
    }
    run_end(target, last);
    *last = next;
}

// Lines between all columns, and after every so many rows.
static void part_cells(figure *target, const panels *p, double left, double top, uint32_t rows) {
    for (uint32_t k = 1; k < EXTREME_STIFFNESSES; k++)
        figure_line(target, left + k * p->cell_width - 0.5, top, left + k * p->cell_width - 0.5,
                    top + panel_height(p), 1, paper);
    for (uint32_t row = rows; row < p->rows; row += rows)
        figure_line(target, left, top + row * p->cell_height - 0.5, left + panel_width(p),
                    top + row * p->cell_height - 0.5, 1, paper);
}

static bool finish(figure *drawn, const char *path, draw_error *error) {
    const bool written = figure_write_svg(drawn, path, error);
    figure_free(drawn);
    return written;
}

/* ---------------------------------------------------------------------------------------------------- outcomes */

/// The colour of a field by how many of its cases are stable, from all to none, and what it says of them below.
static const struct {
    draw_colour colour;
    const char *name;
    uint32_t left; ///< pixels
} kinds[] = {{0x2f7fd6, "all stable", 0},
             {0x7fb0e6, "most", 110},
             {0xd9d3c4, "some", 180},
             {0xf4b860, "none: a step refused, with its cause", 250}};
enum { KINDS = sizeof kinds / sizeof *kinds };
static const draw_colour wrong = 0xc00000;

static draw_colour colour_of(const uint32_t *outcomes) {
    uint32_t all = 0;
    for (int i = 0; i < EXTREME_OUTCOMES; i++)
        all += outcomes[i];
    const uint32_t stable = outcomes[EXTREME_STABLE];
    if (outcomes[EXTREME_NOT_FINITE] + outcomes[EXTREME_DIVERGED] + outcomes[EXTREME_FAILED] > 0)
        return wrong;
    return kinds[stable == all ? 0 : 2 * stable >= all ? 1 : stable > 0 ? 2 : 3].colour;
}

static void draw_kind(figure *target, double left, draw_colour colour, const char *name) {
    figure_rectangle(target, left, target->height - 24.0, 12, 12, colour);
    figure_text(target, left + 18, target->height - 13.5, 10, FIGURE_LEFT, ink, name);
}

static void draw_outcomes_of(figure *target, const map *drawn, const panels *p, uint32_t shape, uint32_t way) {
    const double left = panel_left(p, shape), top = panel_top(p, way);
    run last = {0};
    char text[80];
    snprintf(text, sizeof text, "%s, %s", extreme_shape_name((extreme_shape)shape), extreme_way_of(way).name);
    figure_text(target, left, top - 7, 11, FIGURE_LEFT, ink, text);
    for (uint32_t dt = 0; dt < EXTREME_STEPS; dt++) {
        const double y = top + (EXTREME_STEPS - 1 - dt) * p->cell_height;
        snprintf(text, sizeof text, "%.3g s", extreme_dt(dt));
        if (shape == 0)
            figure_text(target, LEFT - 8, y + 12, 9, FIGURE_RIGHT, quiet, text);
        for (uint32_t k = 0; k < EXTREME_STIFFNESSES; k++)
            run_add(target, &last,
                    (run){left + k * p->cell_width, y, p->cell_width, p->cell_height,
                          colour_of(drawn->outcomes[shape][way][k][dt])});
    }
    run_end(target, &last);
    part_cells(target, p, left, top, 1);
}

bool map_draw_outcomes(const map *drawn, const char *path, draw_error *error) {
    const panels p = {17, 17, EXTREME_STEPS, EXTREME_WAYS};
    figure made;
    begin(&made, &p, "What becomes of networks at the extremes, by stiffness and step");
    for (uint32_t shape = 0; shape < EXTREME_SHAPES; shape++) {
        for (uint32_t way = 0; way < EXTREME_WAYS; way++)
            draw_outcomes_of(&made, drawn, &p, shape, way);
        label_stiffness(&made, &p, shape);
    }
    for (uint32_t way = 0; way < EXTREME_WAYS; way++)
        figure_text(&made, LEFT - 8, panel_top(&p, way) - 7, 9, FIGURE_RIGHT, ink, "step");
    for (int i = 0; i < KINDS; i++)
        draw_kind(&made, LEFT + kinds[i].left, kinds[i].colour, kinds[i].name);
    draw_kind(&made, LEFT + 580, wrong, "any not finite, diverged or failed");
    return finish(&made, path, error);
}

/* ----------------------------------------------------------------------------------------------------- borders */

/// Rows of one pair of ratio and damper, and off by how much has the strongest colour.
enum { ROWS_OF_A_PAIR = EXTREME_SPACINGS * EXTREME_PLACES };
static const double limit = 0.01;

static void draw_legend(figure *target) {
    const double left = LEFT, top = target->height - 20.0, step = 10;
    for (int i = 0; i < COLOUR_SCALE_STEPS; i++)
        figure_rectangle(target, left + i * step, top, step, 12, colour_scale_step(i));
    const char *const texts[] = {"1 % below", "as predicted", "1 % above"};
    const double places[] = {0, COLOUR_SCALE_STEPS / 2.0, COLOUR_SCALE_STEPS};
    for (int i = 0; i < 3; i++)
        figure_text(target, left + places[i] * step, top - 6, 9, (figure_align)i, quiet, texts[i]);
}

static uint32_t border_row(const extreme_network *n) {
    return (n->ratio * EXTREME_DAMPERS + n->damper) * ROWS_OF_A_PAIR + n->spacing * EXTREME_PLACES + n->place;
}

static void draw_borders_of(figure *target, const map *drawn, const panels *p) {
    // By place, as runs go along rows.
    static double borders[EXTREME_SHAPES][EXTREME_RATIOS * EXTREME_DAMPERS * ROWS_OF_A_PAIR][EXTREME_STIFFNESSES];
    for (uint32_t number = 0; number < EXTREME_NETWORKS; number++) {
        const extreme_network n = extreme_network_of(number);
        borders[n.shape][border_row(&n)][n.stiffness] = drawn->border[number];
    }
    for (uint32_t shape = 0; shape < EXTREME_SHAPES; shape++) {
        run last = {0};
        for (uint32_t row = 0; row < p->rows; row++)
            for (uint32_t k = 0; k < EXTREME_STIFFNESSES; k++)
                if (borders[shape][row][k] > 0)
                    run_add(target, &last,
                            (run){panel_left(p, shape) + k * p->cell_width,
                                  panel_top(p, 0) + row * (double)p->cell_height, p->cell_width, p->cell_height,
                                  colour_scale_step(colour_scale_find(borders[shape][row][k] - 1, limit))});
        run_end(target, &last);
        part_cells(target, p, panel_left(p, shape), panel_top(p, 0), ROWS_OF_A_PAIR);
    }
}

bool map_draw_borders(const map *drawn, const char *path, draw_error *error) {
    static const char *const ratios[EXTREME_RATIOS] = {"1", "1e3", "1e6"};
    static const char *const dampers[EXTREME_DAMPERS] = {"none", "0.1", "10"};
    const panels p = {17, 5, EXTREME_RATIOS * EXTREME_DAMPERS * ROWS_OF_A_PAIR, 1};
    figure made;
    begin(&made, &p, "Explicit border: measured over predicted by mspring_network_get_stable_dt");
    draw_borders_of(&made, drawn, &p);
    for (uint32_t shape = 0; shape < EXTREME_SHAPES; shape++) {
        figure_text(&made, panel_left(&p, shape), panel_top(&p, 0) - 7, 11, FIGURE_LEFT, ink,
                    extreme_shape_name((extreme_shape)shape));
        label_stiffness(&made, &p, shape);
    }
    figure_text(&made, LEFT - 8, panel_top(&p, 0) - 20, 9, FIGURE_RIGHT, ink, "masses 1 to,");
    figure_text(&made, LEFT - 8, panel_top(&p, 0) - 7, 9, FIGURE_RIGHT, ink, "dampers");
    for (int pair = 0; pair < EXTREME_RATIOS * EXTREME_DAMPERS; pair++) {
        char text[40];
        snprintf(text, sizeof text, "%s, %s", ratios[pair / EXTREME_DAMPERS], dampers[pair % EXTREME_DAMPERS]);
        figure_text(&made, LEFT - 8, panel_top(&p, 0) + (pair + 0.5) * ROWS_OF_A_PAIR * p.cell_height + 4, 9,
                    FIGURE_RIGHT, quiet, text);
    }
    draw_legend(&made);
    return finish(&made, path, error);
}

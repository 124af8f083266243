/// @file plot.c
/// Frame, ticks and curves.
///
/// SPDX-License-Identifier: MIT
#include "draw/plot.h"
#include "draw/colour_scale.h"
#include "draw/internal.h"

#include <math.h>
#include <stdio.h>

static const draw_colour ink = 0x26262e;
static const draw_colour grid_colour = 0xe2e3e8;

enum { LEFT = 84, RIGHT = 28, TOP = 56, BOTTOM = 60, TICKS = 6 };

// One direction: the values it spans and the pixels they span.
typedef struct plot_axis {
    double low, high, step;
    double start, end;
} plot_axis;

static double axis_place(const plot_axis *axis, double value) {
    return axis->start + (value - axis->low) / (axis->high - axis->low) * (axis->end - axis->start);
}

static double y_value(const plot *drawn, double y) {
    return drawn->log_y ? log10(y) : y;
}

// Widens the span to whole steps, about TICKS of them.
static void axis_round(plot_axis *axis, bool whole_steps) {
    if (!(axis->high > axis->low))
        axis->high = axis->low + 1;
    axis->step = colour_scale_round_up((axis->high - axis->low) / TICKS);
    if (whole_steps && axis->step < 1)
        axis->step = 1;
    axis->low = floor(axis->low / axis->step) * axis->step;
    axis->high = ceil(axis->high / axis->step) * axis->step;
}

static void span_curves(const plot *drawn, plot_axis *across, plot_axis *up) {
    across->low = up->low = INFINITY;
    across->high = up->high = -INFINITY;
    for (size_t c = 0; c < drawn->curve_count; c++) {
        for (size_t i = 0; i < drawn->curves[c].count; i++) {
            across->low = fmin(across->low, drawn->curves[c].x[i]);
            across->high = fmax(across->high, drawn->curves[c].x[i]);
            up->low = fmin(up->low, y_value(drawn, drawn->curves[c].y[i]));
            up->high = fmax(up->high, y_value(drawn, drawn->curves[c].y[i]));
        }
    }
    axis_round(across, false);
    axis_round(up, drawn->log_y);
}

static void format_tick(char *text, size_t size, double value, double step, bool power) {
    // Steps add up to -0 or 1e-17 where 0 is meant.
    if (fabs(value) < 1e-6 * step)
        value = 0;
    if (power && fabs(value) > 3)
        snprintf(text, size, "1e%.0f", value);
    else if (power)
        snprintf(text, size, "%g", pow(10, value));
    else
        snprintf(text, size, "%.6g", value);
}

static void draw_frame(figure *target, const plot *drawn, const plot_axis *across, const plot_axis *up) {
    char text[32];
    int columns = (int)lround((across->high - across->low) / across->step);
    for (int i = 0; i <= columns; i++) {
        double value = across->low + i * across->step;
        double x = axis_place(across, value);
        figure_line(target, x, up->start, x, up->end, 1, grid_colour);
        format_tick(text, sizeof text, value, across->step, false);
        figure_text(target, x, up->start + 18, 9, FIGURE_CENTRE, ink, text);
    }
    int rows = (int)lround((up->high - up->low) / up->step);
    for (int i = 0; i <= rows; i++) {
        double value = up->low + i * up->step;
        double y = axis_place(up, value);
        figure_line(target, across->start, y, across->end, y, 1, grid_colour);
        format_tick(text, sizeof text, value, up->step, drawn->log_y);
        figure_text(target, across->start - 8, y + 4, 9, FIGURE_RIGHT, ink, text);
    }
    figure_text(target, (across->start + across->end) / 2, up->start + 42, 10, FIGURE_CENTRE, ink, drawn->x_label);
    figure_text(target, across->start, up->end - 10, 10, FIGURE_LEFT, ink, drawn->y_label);
    figure_text(target, across->start, 22, 12, FIGURE_LEFT, ink, drawn->title);
}

static void draw_curve(figure *target, const plot *drawn, const plot_curve *curve, const plot_axis *across,
                       const plot_axis *up) {
    for (size_t i = 1; i < curve->count; i++)
        figure_line(target, axis_place(across, curve->x[i - 1]), axis_place(up, y_value(drawn, curve->y[i - 1])),
                    axis_place(across, curve->x[i]), axis_place(up, y_value(drawn, curve->y[i])), 1.8,
                    curve->colour);
}

// The curves' names, in a row at the top right.
static void draw_names(figure *target, const plot *drawn, const plot_axis *across, const plot_axis *up) {
    const double height = 10;
    const double sample = 24;
    double x = across->end;
    for (size_t c = drawn->curve_count; c-- > 0;) {
        figure_text(target, x, up->end - 10, height, FIGURE_RIGHT, ink, drawn->curves[c].name);
        x -= stroke_font_width(height, drawn->curves[c].name) + 14; // browsers' letters are wider
        figure_line(target, x - sample, up->end - 15, x, up->end - 15, 2.5, drawn->curves[c].colour);
        x -= sample + 20;
    }
}

void plot_draw(figure *target, const plot *drawn) {
    plot_axis across = {.start = LEFT, .end = (double)target->width - RIGHT};
    plot_axis up = {.start = (double)target->height - BOTTOM, .end = TOP};
    span_curves(drawn, &across, &up);
    draw_frame(target, drawn, &across, &up);
    for (size_t c = 0; c < drawn->curve_count; c++)
        draw_curve(target, drawn, &drawn->curves[c], &across, &up);
    draw_names(target, drawn, &across, &up);
}

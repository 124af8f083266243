/// @file view_plots.c
/// Time series of what is measured.
///
/// SPDX-License-Identifier: MIT
#include "draw/colour_scale.h"
#include "lab/tint.h"
#include "lab/view.h"

#include <math.h>
#include <stdio.h>

static const struct {
    const char *title, *unit;
} plots[PROBE_KINDS] = {{"bending", "m"}, {"kinetic", "J"}, {"elastic", "J"}, {"max strain", "%"}, {"cost", "ms"}};

static double shown_value(int kind, double value) {
    return kind == PROBE_STRAIN ? 100 * value : value;
}

// A value with its unit; no thousands of percent or of milliseconds.
static const char *value_text(int kind, double value, char text[64]) {
    char digits[32];
    if (kind == PROBE_STRAIN || kind == PROBE_COST)
        snprintf(text, 64, value < 100 ? "%.3g %s" : "%.0f %s", value, plots[kind].unit);
    else
        snprintf(text, 64, "%s%s", view_number(value, digits), plots[kind].unit);
    return text;
}

// The range of the values of a plot, on all sides.
static void find_range(const lab_series *series, int kind, int sides, double *low, double *high) {
    *low = 0;
    *high = 0;
    for (int side = 0; side < sides; side++)
        for (int i = 0; i < series->count; i++) {
            const double value = shown_value(kind, series->values[kind][side][i]);
            *low = value < *low ? value : *low;
            *high = value > *high ? value : *high;
        }
    *high = *high > 0 ? colour_scale_round_up(*high * 1.02) : *high;
    *low = *low < 0 ? -colour_scale_round_up(-*low * 1.02) : 0;
    if (!(*high > *low))
        *high = *low + 1;
}

static void draw_line(lab_view *view, const lab_series *series, int kind, int side, lab_box area, double low,
                      double high) {
    const lab_colour colour = tint_of_side(side);
    const float *values = series->values[kind][side];
    const double across = (area.width - 3) / (double)(SERIES_LENGTH - 1), up = (area.height - 3) / (high - low);
    // Points that share a pixel are one stroke from the lowest to the highest.
    double before_x = 0, before_y = 0;
    for (int i = 0; i < series->count; i++) {
        const double x = area.x + 1 + i * across;
        const double y = area.y + area.height - 2 - (fmin(shown_value(kind, values[i]), high) - low) * up;
        if (i > 0 && x - before_x < 1 && i < series->count - 1 && fabs(y - before_y) < 1)
            continue;
        if (i > 0)
            raster_line(&view->target, area, before_x, before_y, x, y, 1.4, colour, 230);
        before_x = x;
        before_y = y;
    }
}

// Where each ten seconds begin.
static void draw_times(lab_view *view, const lab_series *series, lab_box area) {
    enum { SECONDS = 10, LABELLED = 110 };
    const double across = (area.width - 3) / (double)(SERIES_LENGTH - 1);
    for (int i = 1; i < series->count; i++) {
        const double part = floor(series->times[i] / SECONDS);
        if (!(part > floor(series->times[i - 1] / SECONDS)))
            continue;
        char text[32];
        const int x = area.x + 1 + (int)(i * across);
        raster_fill(&view->target, area, (lab_box){x, area.y, 1, area.height}, TINT_EDGE, 256);
        snprintf(text, sizeof text, "%.0f s", part * SECONDS);
        if (area.width >= LABELLED && x + 3 + text_width(&view->small, text) <= area.x + area.width)
            text_draw(&view->target, area, &view->small, x + 3, area.y + 11, TEXT_LEFT, TINT_FAINT, text);
    }
}

static lab_box plot_area(lab_box box) {
    return (lab_box){box.x + 8, box.y + 24, box.width - 16, box.height - 48};
}

static void draw_plot(lab_view *view, const lab_model *model, int kind, lab_box box) {
    const lab_series *series = &model->series;
    char text[64];
    double low, high;
    raster_round(&view->target, box, box, 6, TINT_PANEL, 256);
    text_draw(&view->target, box, &view->normal, box.x + 10, box.y + 17, TEXT_LEFT, TINT_FAINT, plots[kind].title);
    find_range(series, kind, model->side_count, &low, &high);
    value_text(kind, high, text);
    if (text_width(&view->normal, plots[kind].title) + text_width(&view->small, text) + 28 <= box.width)
        text_draw(&view->target, box, &view->small, box.x + box.width - 10, box.y + 17, TEXT_RIGHT, TINT_FAINT,
                  text);
    const lab_box area = plot_area(box);
    raster_fill(&view->target, area, area, TINT_VIEW, 256);
    const int zero = area.y + area.height - 2 + (int)(low * (area.height - 3) / (high - low));
    raster_fill(&view->target, area, (lab_box){area.x, zero, area.width, 1}, TINT_EDGE, 256);
    draw_times(view, series, area);
    int used = 0;
    for (int side = 0; side < model->side_count; side++) {
        draw_line(view, series, kind, side, area, low, high);
        if (series->count == 0)
            continue;
        const double last = shown_value(kind, series->values[kind][side][series->count - 1]);
        value_text(kind, last, text);
        used += text_width(&view->normal, text) + 10;
        // Where two values have no room beside each other, the second stands in the plot.
        text_draw(&view->target, box, &view->normal, side == 0 ? box.x + 10 : box.x + box.width - 10,
                  side > 0 && used + 10 > box.width ? box.y + 38 : box.y + box.height - 8,
                  side == 0 ? TEXT_LEFT : TEXT_RIGHT, tint_of_side(side), text);
    }
}

// As many as have room to be read.
static int plot_count(const lab_view *view) {
    enum { LEAST_WIDTH = 96 };
    const int count = view->shows_costs ? PROBE_KINDS : PROBE_KINDS - 1,
              room = view->layout.plots.width / LEAST_WIDTH;
    return room < count ? room : count;
}

static lab_box plot_box(const lab_view *view, int index) {
    enum { GAP = 8 };
    const lab_box box = view->layout.plots;
    const int count = plot_count(view), left = box.x + (box.width + GAP) * index / count,
              right = box.x + (box.width + GAP) * (index + 1) / count - GAP;
    return (lab_box){left, box.y, right - left, box.height};
}

void view_draw_plots(lab_view *view, const lab_model *model) {
    for (int i = 0; i < plot_count(view); i++)
        draw_plot(view, model, i, plot_box(view, i));
}

bool view_describe_plot(lab_view *view, const lab_model *model, int x, int y, char *text, size_t size) {
    const lab_series *series = &model->series;
    for (int kind = 0; kind < plot_count(view); kind++) {
        const lab_box area = plot_area(plot_box(view, kind));
        const int sample = (int)((x - area.x - 1) * (SERIES_LENGTH - 1) / (double)(area.width - 3) + 0.5);
        if (!box_holds(area, x, y) || sample < 0 || sample >= series->count)
            continue;
        char values[2][64];
        for (int side = 0; side < model->side_count; side++)
            value_text(kind, shown_value(kind, series->values[kind][side][sample]), values[side]);
        raster_fill(&view->target, area, (lab_box){x, area.y, 1, area.height}, TINT_TEXT, 160);
        snprintf(text, size, "%.2f s: %s%s%s", series->times[sample], values[0], model->side_count == 2 ? ", " : "",
                 model->side_count == 2 ? values[1] : "");
        return true;
    }
    return false;
}

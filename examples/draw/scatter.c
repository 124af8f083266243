/// @file scatter.c
/// Frame, ticks of decades, marks, and the front.
///
/// SPDX-License-Identifier: MIT
#include "draw/scatter.h"
#include "draw/internal.h"

#include <math.h>
#include <stdio.h>

static const draw_colour ink = 0x26262e;
static const draw_colour pale_ink = 0x6b6c76;
static const draw_colour strong_grid = 0xd3d5dc;
static const draw_colour weak_grid = 0xf0f1f4;
static const draw_colour front_colour = 0xb9bcc8;
static const draw_colour paper = 0xffffff;

enum { LEFT = 62, RIGHT = 18, TOP = 76, BOTTOM = 52 };
enum { MARK_RADIUS = 5, JOIN_WIDTH = 2, LABEL_SIZE = 8, MOST_BOXES = 512 };
enum { LEGEND_SAMPLE = 26, LEGEND_GAP = 20, LEGEND_LINE = 18 };

// One direction: the powers of ten it spans, and the pixels.
typedef struct decade_axis {
    double low, high;
    double start, end;
} decade_axis;

static double axis_place(const decade_axis *axis, double value) {
    return axis->start + (log10(value) - axis->low) / (axis->high - axis->low) * (axis->end - axis->start);
}

static bool is_drawn(const scatter_point *point) {
    return point->x > 0 && point->y > 0;
}

// Room for all points and a little around them.
static void span(const scatter *drawn, decade_axis *across, decade_axis *up) {
    across->low = up->low = INFINITY;
    across->high = up->high = -INFINITY;
    for (size_t s = 0; s < drawn->series_count; s++) {
        for (size_t i = 0; i < drawn->series[s].count; i++) {
            const scatter_point *point = &drawn->series[s].points[i];
            if (!is_drawn(point))
                continue;
            across->low = fmin(across->low, log10(point->x));
            across->high = fmax(across->high, log10(point->x));
            up->low = fmin(up->low, log10(point->y));
            up->high = fmax(up->high, log10(point->y));
        }
    }
    if (!(across->low <= across->high))
        across->low = across->high = up->low = up->high = 0;
    const double margin_x = 0.08 * fmax(across->high - across->low, 1);
    const double margin_y = 0.08 * fmax(up->high - up->low, 1);
    across->low -= margin_x;
    across->high += 1.5 * margin_x; // for labels
    up->low -= margin_y;
    up->high += margin_y;
}

static void format_tick(char *text, size_t size, double value, bool percent) {
    const double shown = percent ? 100 * value : value;
    if (shown >= 999999)
        snprintf(text, size, "%.0fe%.0f", shown / pow(10, floor(log10(shown) + 1e-9)), floor(log10(shown) + 1e-9));
    else
        snprintf(text, size, "%.6g%s", shown, percent ? " %" : "");
}

// Lines at 1, 2 ... 9 of each power of ten; numbers at 1, and at 2 and 5 where there are few powers.
static void draw_ticks(figure *target, const decade_axis *axis, const decade_axis *other, bool vertical,
                       bool percent) {
    char text[32];
    const bool few = axis->high - axis->low < 2.2;
    for (int power = (int)floor(axis->low); power <= (int)ceil(axis->high); power++) {
        for (int digit = 1; digit <= 9; digit++) {
            const double value = digit * pow(10, power);
            if (log10(value) < axis->low || log10(value) > axis->high)
                continue;
            const double at = axis_place(axis, value);
            const draw_colour colour = digit == 1 ? strong_grid : weak_grid;
            if (vertical)
                figure_line(target, other->start, at, other->end, at, 1, colour);
            else
                figure_line(target, at, other->start, at, other->end, 1, colour);
            if (digit != 1 && !(few && (digit == 2 || digit == 5)))
                continue;
            format_tick(text, sizeof text, value, percent);
            if (vertical)
                figure_text(target, other->start - 8, at + 4, 8.5, FIGURE_RIGHT, ink, text);
            else
                figure_text(target, at, other->start + 18, 8.5, FIGURE_CENTRE, ink, text);
        }
    }
}

static void draw_diamond(figure *target, double x, double y, double radius, draw_colour colour) {
    // Filled by strokes that lie close.
    for (double r = radius; r > 0; r -= 1) {
        figure_line(target, x - r, y, x, y - r, 1.6, colour);
        figure_line(target, x, y - r, x + r, y, 1.6, colour);
        figure_line(target, x + r, y, x, y + r, 1.6, colour);
        figure_line(target, x, y + r, x - r, y, 1.6, colour);
    }
}

static void draw_shape(figure *target, scatter_mark mark, double x, double y, double radius, draw_colour colour) {
    const double half = 0.88 * radius;
    switch (mark) {
    case SCATTER_DISC:
        figure_disc(target, x, y, radius, colour);
        break;
    case SCATTER_SQUARE:
        figure_rectangle(target, x - half, y - half, 2 * half, 2 * half, colour);
        break;
    case SCATTER_DIAMOND:
        draw_diamond(target, x, y, 1.15 * radius, colour);
        break;
    case SCATTER_NO_MARK:
        break;
    }
}

// With an edge of paper, so that marks that overlap can be told apart.
static void draw_mark(figure *target, scatter_mark mark, double x, double y, draw_colour colour) {
    draw_shape(target, mark, x, y, MARK_RADIUS + 1.3, paper);
    draw_shape(target, mark, x, y, MARK_RADIUS, colour);
}

static void draw_joins(figure *target, const scatter_series *series, const decade_axis *across,
                       const decade_axis *up) {
    for (size_t i = 1; series->joined && i < series->count; i++) {
        const scatter_point *from = &series->points[i - 1], *to = &series->points[i];
        if (is_drawn(from) && is_drawn(to))
            figure_line(target, axis_place(across, from->x), axis_place(up, from->y), axis_place(across, to->x),
                        axis_place(up, to->y), JOIN_WIDTH, series->colour);
    }
}

static void draw_series(figure *target, const scatter_series *series, const decade_axis *across,
                        const decade_axis *up) {
    for (size_t i = 0; i < series->count; i++) {
        const scatter_point *point = &series->points[i];
        if (!is_drawn(point))
            continue;
        const double x = axis_place(across, point->x), y = axis_place(up, point->y);
        if (point->ringed) {
            figure_disc(target, x, y, MARK_RADIUS + 6, ink);
            figure_disc(target, x, y, MARK_RADIUS + 4.4, paper);
        }
        draw_mark(target, series->mark, x, y, series->colour);
    }
}

// What labels keep clear of: marks, and labels that are there already.
typedef struct crowd {
    struct {
        double left, top, right, bottom;
    } boxes[MOST_BOXES];
    size_t count;
} crowd;

static bool crowd_overlaps(const crowd *all, double left, double top, double right, double bottom) {
    for (size_t i = 0; i < all->count; i++)
        if (left < all->boxes[i].right && all->boxes[i].left < right && top < all->boxes[i].bottom &&
            all->boxes[i].top < bottom)
            return true;
    return false;
}

static void crowd_add(crowd *all, double left, double top, double right, double bottom) {
    if (all->count == MOST_BOXES)
        return;
    all->boxes[all->count].left = left, all->boxes[all->count].top = top;
    all->boxes[all->count].right = right, all->boxes[all->count].bottom = bottom;
    all->count++;
}

static void add_marks(crowd *all, const scatter *drawn, const decade_axis *across, const decade_axis *up) {
    for (size_t s = 0; s < drawn->series_count; s++) {
        for (size_t i = 0; i < drawn->series[s].count; i++) {
            const scatter_point *point = &drawn->series[s].points[i];
            const double radius = MARK_RADIUS + (point->ringed ? 6 : 0);
            if (!is_drawn(point) || drawn->series[s].mark == SCATTER_NO_MARK)
                continue;
            const double x = axis_place(across, point->x), y = axis_place(up, point->y);
            crowd_add(all, x - radius, y - radius, x + radius, y + radius);
        }
    }
}

// Labels go over all marks, in the first corner of theirs that is free and within the frame; where none is, they
// are left out.
static void draw_labels(figure *target, const scatter_series *series, crowd *taken, const decade_axis *across,
                        const decade_axis *up) {
    for (size_t i = 0; i < series->count; i++) {
        const scatter_point *point = &series->points[i];
        if (!is_drawn(point) || !point->label[0])
            continue;
        const double away = MARK_RADIUS + (point->ringed ? 7 : 1);
        const double x = axis_place(across, point->x), y = axis_place(up, point->y);
        const double width = stroke_font_width(LABEL_SIZE, point->label);
        for (int corner = 0; corner < 4; corner++) {
            const bool below = series->labels_below != (corner == 1 || corner == 3);
            const bool before = series->labels_below != (corner >= 2);
            const double left = before ? x - away - width : x + away;
            const double bottom = below ? y + away + LABEL_SIZE : y - away;
            if (left < across->start || left + width > across->end || bottom - LABEL_SIZE < up->end ||
                bottom > up->start || crowd_overlaps(taken, left, bottom - LABEL_SIZE, left + width, bottom))
                continue;
            figure_text(target, before ? left + width : left, bottom, LABEL_SIZE,
                        before ? FIGURE_RIGHT : FIGURE_LEFT, pale_ink, point->label);
            crowd_add(taken, left, bottom - LABEL_SIZE, left + width, bottom);
            break;
        }
    }
}

// From each point of the front straight on at its error, down where the next one costs as much.
static void draw_front(figure *target, const scatter *drawn, const decade_axis *across, const decade_axis *up) {
    for (size_t i = 0; i < drawn->front_count; i++) {
        const scatter_point *point = &drawn->front[i];
        const double x = axis_place(across, point->x), y = axis_place(up, point->y);
        const bool last = i + 1 == drawn->front_count;
        const double next = last ? across->end : axis_place(across, drawn->front[i + 1].x);
        figure_line(target, x, y, next, y, 3, front_colour);
        if (!last)
            figure_line(target, next, y, next, axis_place(up, drawn->front[i + 1].y), 3, front_colour);
    }
}

// What stands before a series' name.
static double sample_width(const scatter_series *series) {
    return series->joined ? LEGEND_SAMPLE : 2 * MARK_RADIUS;
}

// The series' names, in rows above the frame. Returns the height of the rows after the first; draws nothing on
// target NULL.
static double draw_legend(figure *target, const scatter *drawn, double left, double top, double width) {
    double x = left, y = top;
    for (size_t s = 0; s < drawn->series_count; s++) {
        const scatter_series *series = &drawn->series[s];
        if (!series->name)
            continue;
        const double sample = sample_width(series);
        const double needed = sample + 6 + stroke_font_width(8.5, series->name);
        if (x > left && x + needed > left + width) {
            x = left;
            y += LEGEND_LINE;
        }
        if (target) {
            if (series->joined)
                figure_line(target, x, y - 4, x + sample, y - 4, JOIN_WIDTH, series->colour);
            draw_mark(target, series->mark, x + sample / 2, y - 4, series->colour);
            figure_text(target, x + sample + 6, y, 8.5, FIGURE_LEFT, ink, series->name);
        }
        x += needed + LEGEND_GAP;
    }
    if (target && drawn->front_count > 0) {
        figure_line(target, x, y - 4, x + 20, y - 4, 3, front_colour);
        figure_text(target, x + 26, y, 8.5, FIGURE_LEFT, ink, "front");
    }
    return y - top;
}

void scatter_draw(figure *target, const scatter *drawn, double left, double top, double width, double height) {
    decade_axis across = {.start = left + LEFT, .end = left + width - RIGHT};
    const double legend_width = width - 14 - RIGHT;
    const double more_legend = draw_legend(NULL, drawn, left + 14, top + 42, legend_width);
    decade_axis up = {.start = top + height - BOTTOM, .end = top + TOP + more_legend};
    span(drawn, &across, &up);
    draw_ticks(target, &across, &up, false, false);
    draw_ticks(target, &up, &across, true, drawn->percent);
    draw_front(target, drawn, &across, &up);
    for (size_t s = 0; s < drawn->series_count; s++)
        draw_joins(target, &drawn->series[s], &across, &up);
    for (size_t s = 0; s < drawn->series_count; s++)
        draw_series(target, &drawn->series[s], &across, &up);
    crowd taken = {.count = 0};
    add_marks(&taken, drawn, &across, &up);
    for (size_t s = 0; s < drawn->series_count; s++)
        draw_labels(target, &drawn->series[s], &taken, &across, &up);
    figure_text(target, (across.start + across.end) / 2, up.start + 40, 9.5, FIGURE_CENTRE, ink, drawn->x_label);
    figure_text(target, left + 14, up.end - 14, 9.5, FIGURE_LEFT, ink, drawn->y_label);
    figure_text(target, left + 14, top + 20, 11.5, FIGURE_LEFT, ink, drawn->title);
    draw_legend(target, drawn, left + 14, top + 42, legend_width);
}

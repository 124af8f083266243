/// @file network_picture.c
/// Springs as lines, with legend and ruler.
///
/// SPDX-License-Identifier: MIT
#include "draw/network_picture.h"
#include "draw/colour_scale.h"

#include <math.h>
#include <stdio.h>

static const draw_colour ink = 0x26262e;
static const draw_colour faint_ink = 0x70707a;
static const draw_colour rest_colour = 0xe2e3e8;
static const draw_colour pin_colour = 0x26262e;
static const draw_colour probe_colour = 0x7a1fa2;

enum { MARGIN = 28, HEADER = 44, FOOTER = 62, LEAST_WIDTH = 560 };

static bool is_whole(const network_shape *shape, uint32_t spring) {
    return !(shape->flags[spring] & MSPRING_SPRING_BROKEN);
}

static double typical_length(const network_shape *shape) {
    double sum = 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < shape->spring_count; i++) {
        sum += is_whole(shape, i) ? (double)shape->rest_length[i] : 0;
        count += is_whole(shape, i);
    }
    return count ? sum / count : 1;
}

network_view network_view_fit(const network_shape *shape, world_box box, uint32_t most_width, uint32_t most_height,
                              double strain_limit) {
    network_view view = {.strain_limit = strain_limit};
    double length = typical_length(shape);
    // Room for the particles at the rim; a point has no size of its own.
    double world_width = fmax(box.max_x - box.min_x, 1e-6 * length) + 0.5 * length;
    double world_height = fmax(box.max_y - box.min_y, 1e-6 * length) + 0.5 * length;
    double room_x = (double)most_width - 2 * MARGIN;
    double room_y = (double)most_height - HEADER - FOOTER;
    view.scale = fmin(room_x / world_width, room_y / world_height);
    view.width = (uint32_t)ceil(fmax(world_width * view.scale + 2 * MARGIN, fmin(LEAST_WIDTH, most_width)));
    view.height = (uint32_t)ceil(world_height * view.scale) + HEADER + FOOTER;
    view.left = view.width / 2.0 - (box.min_x + box.max_x) / 2 * view.scale;
    view.top = HEADER + world_height * view.scale / 2 + (box.min_y + box.max_y) / 2 * view.scale;
    view.spring_length = length * view.scale;
    return view;
}

static double to_x(const network_view *view, double x) {
    return view->left + x * view->scale;
}

static double to_y(const network_view *view, double y) {
    return view->top - y * view->scale;
}

static double limit(double value, double least, double most) {
    return value < least ? least : value > most ? most : value;
}

static void draw_spring(figure *target, const network_shape *shape, const network_view *view, uint32_t spring,
                        const double *x, const double *y, draw_colour colour) {
    mspring_id a = shape->a[spring];
    mspring_id b = shape->b[spring];
    figure_line(target, to_x(view, x[a]), to_y(view, y[a]), to_x(view, x[b]), to_y(view, y[b]),
                limit(0.11 * view->spring_length, 0.45, 3.5), colour);
}

static double strain_of(const network_shape *shape, uint32_t spring, const double *x, const double *y) {
    mspring_id a = shape->a[spring];
    mspring_id b = shape->b[spring];
    return hypot(x[b] - x[a], y[b] - y[a]) / shape->rest_length[spring] - 1;
}

// From the neutral colour outwards, so that the strained springs lie on top.
static void draw_springs(figure *target, const network_shape *shape, const network_view *view, const double *x,
                         const double *y) {
    const int middle = COLOUR_SCALE_STEPS / 2;
    for (int distance = 0; distance <= middle; distance++) {
        for (uint32_t i = 0; i < shape->spring_count; i++) {
            if (!is_whole(shape, i))
                continue;
            int step = colour_scale_find(strain_of(shape, i, x, y), view->strain_limit);
            if (step - middle == distance || middle - step == distance)
                draw_spring(target, shape, view, i, x, y, colour_scale_step(step));
        }
    }
}

static void draw_particles(figure *target, const network_shape *shape, const network_view *view, const double *x,
                           const double *y) {
    double radius = limit(0.16 * view->spring_length, 0, 8);
    for (uint32_t i = 0; i < shape->particle_count; i++) {
        if (shape->pinned[i]) {
            double half = fmax(1.25 * radius, 1);
            figure_rectangle(target, to_x(view, x[i]) - half, to_y(view, y[i]) - half, 2 * half, 2 * half,
                             pin_colour);
        } else if (radius >= 1.5) {
            figure_disc(target, to_x(view, x[i]), to_y(view, y[i]), radius, ink);
        }
    }
}

// A dashed line from where the probe was to where it is.
static void draw_probe(figure *target, const network_shape *shape, const network_view *view, const double *x,
                       const double *y) {
    if (shape->probe == MSPRING_NONE)
        return;
    const double dash = 6;
    double from_x = to_x(view, shape->x[shape->probe]);
    double from_y = to_y(view, shape->y[shape->probe]);
    double dx = to_x(view, x[shape->probe]) - from_x;
    double dy = to_y(view, y[shape->probe]) - from_y;
    double length = hypot(dx, dy);
    for (double at = 0; at < length && at < 1e5; at += 2 * dash) {
        double start = at / length;
        double end = fmin(at + dash, length) / length;
        figure_line(target, from_x + start * dx, from_y + start * dy, from_x + end * dx, from_y + end * dy, 1.2,
                    probe_colour);
    }
    figure_disc(target, from_x, from_y, 2.5, probe_colour);
    figure_disc(target, from_x + dx, from_y + dy, limit(0.25 * view->spring_length, 4, 9), probe_colour);
}

static void format_strain(char *text, size_t size, double strain) {
    if (fabs(strain) >= 1e-4)
        snprintf(text, size, "%+.3g %%", strain * 100);
    else
        snprintf(text, size, "%+.0e", strain);
}

static void draw_legend(figure *target, const network_view *view) {
    const double step_width = 6;
    const double height = 12;
    double width = COLOUR_SCALE_STEPS * step_width;
    double x = MARGIN;
    double y = view->height - 40.0;
    char text[32];
    for (int i = 0; i < COLOUR_SCALE_STEPS; i++)
        figure_rectangle(target, x + i * step_width, y, step_width, height, colour_scale_step(i));
    format_strain(text, sizeof text, -view->strain_limit);
    figure_text(target, x, y + height + 15, 9, FIGURE_LEFT, ink, text);
    figure_text(target, x + width / 2, y + height + 15, 9, FIGURE_CENTRE, ink, "strain");
    format_strain(text, sizeof text, view->strain_limit);
    figure_text(target, x + width, y + height + 15, 9, FIGURE_RIGHT, ink, text);
}

// A bar of a round number of metres.
static void draw_ruler(figure *target, const network_view *view) {
    double metres = colour_scale_round_up(60 / view->scale);
    double length = metres * view->scale;
    double right = (double)view->width - MARGIN;
    double y = view->height - 28.0;
    char text[32];
    snprintf(text, sizeof text, "%.3g m", metres);
    figure_line(target, right - length, y, right, y, 1.5, faint_ink);
    figure_line(target, right - length, y - 4, right - length, y + 4, 1.5, faint_ink);
    figure_line(target, right, y - 4, right, y + 4, 1.5, faint_ink);
    figure_text(target, right - length / 2, y + 15, 9, FIGURE_CENTRE, ink, text);
}

// Keep the part of a line along which start + t * way is from low to high.
static void clip(double start, double way, double low, double high, double *from, double *to) {
    if (way == 0) {
        *to = start < low || start > high ? -1 : *to;
        return;
    }
    double first = ((way > 0 ? low : high) - start) / way;
    double last = ((way > 0 ? high : low) - start) / way;
    *from = fmax(*from, first);
    *to = fmin(*to, last);
}

// The lines of the floor, between title and legend.
static void draw_floor(figure *target, const network_shape *shape, const network_view *view) {
    for (uint32_t i = 0; i < shape->floor_count; i++) {
        const double *line = shape->floor[i];
        double x = to_x(view, line[0]), y = to_y(view, line[1]);
        double dx = to_x(view, line[2]) - x, dy = to_y(view, line[3]) - y;
        double from = 0, to = 1;
        clip(x, dx, 0, view->width, &from, &to);
        clip(y, dy, HEADER, (double)view->height - FOOTER + 10, &from, &to);
        if (from < to)
            figure_line(target, x + from * dx, y + from * dy, x + to * dx, y + to * dy, 1.5, faint_ink);
    }
}

void network_picture_draw(figure *target, const network_shape *shape, const network_view *view, const double *x,
                          const double *y, const char *title) {
    for (uint32_t i = 0; i < shape->spring_count; i++)
        if (is_whole(shape, i))
            draw_spring(target, shape, view, i, shape->x, shape->y, rest_colour);
    draw_floor(target, shape, view);
    draw_springs(target, shape, view, x, y);
    draw_particles(target, shape, view, x, y);
    draw_probe(target, shape, view, x, y);
    figure_text(target, MARGIN, 28, 12, FIGURE_LEFT, ink, title);
    draw_legend(target, view);
    draw_ruler(target, view);
}

void network_picture_line(figure *target, const network_view *view, const double line[4]) {
    figure_line(target, to_x(view, line[0]), to_y(view, line[1]), to_x(view, line[2]), to_y(view, line[3]), 2.5,
                probe_colour);
}

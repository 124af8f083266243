/// @file strip.c
/// Panels: sky, water, sea floor, and the springs coloured by strain.
///
/// SPDX-License-Identifier: MIT
#include "game/strip.h"

#include "draw/colour_scale.h"

#include <math.h>

static const draw_colour sky = 0xf4f6fa, water = 0xd7e6f4, sand = 0xd8c79c, ink = 0x26262e, broken_ink = 0xb0b4bc,
                         rope_ink = 0x0f8a4a;

enum { GAP = 12, TITLE = 26 };

void strip_start(figure *made) {
    figure_start(made, STRIP_COLUMNS * (STRIP_PANEL_WIDTH + GAP) + GAP,
                 STRIP_ROWS * (STRIP_PANEL_HEIGHT + TITLE) + GAP, 0xffffff);
}

/// Where the world lies in a panel.
typedef struct panel {
    double x, y, scale_x, scale_y;
    const strip_world *world;
} panel;

static double to_x(const panel *in, double x) {
    return in->x + (x - in->world->left) * in->scale_x;
}

static double to_y(const panel *in, double y) {
    return in->y + (in->world->top - y) * in->scale_y;
}

static bool is_inside(const panel *in, double x, double y) {
    return x >= in->world->left && x <= in->world->right && y >= in->world->bottom && y <= in->world->top;
}

static void draw_world(figure *target, const panel *in) {
    const strip_world *w = in->world;
    figure_rectangle(target, in->x, in->y, STRIP_PANEL_WIDTH, STRIP_PANEL_HEIGHT, sky);
    figure_rectangle(target, in->x, to_y(in, 0), STRIP_PANEL_WIDTH, in->y + STRIP_PANEL_HEIGHT - to_y(in, 0),
                     water);
    for (int pixel = 0; pixel < STRIP_PANEL_WIDTH; pixel++) {
        const double y = to_y(in, w->floor_at(w->left + pixel / in->scale_x));
        figure_rectangle(target, in->x + pixel, y, 1, in->y + STRIP_PANEL_HEIGHT - y, sand);
    }
}

static void draw_spring(figure *target, const panel *in, mspring_id id, const network_shape *shape, const double *x,
                        const double *y) {
    const mspring_id a = shape->a[id], b = shape->b[id];
    if ((shape->flags[id] & MSPRING_SPRING_BROKEN) || !is_inside(in, x[a], y[a]) || !is_inside(in, x[b], y[b]))
        return;
    const bool is_rope = id - in->world->first_rope < in->world->rope_springs;
    const double strain = hypot(x[b] - x[a], y[b] - y[a]) / (double)shape->rest_length[id] - 1;
    const int step = colour_scale_find(strain, in->world->strain_limit);
    figure_line(target, to_x(in, x[a]), to_y(in, y[a]), to_x(in, x[b]), to_y(in, y[b]), is_rope ? 1.5 : 0.9,
                is_rope ? rope_ink : colour_scale_step(step));
}

void strip_add(figure *target, uint32_t number, const strip_world *world, const network_shape *shape,
               const double *x, const double *y, const char *title) {
    const panel in = {.x = GAP + number % STRIP_COLUMNS * (STRIP_PANEL_WIDTH + GAP),
                      .y = TITLE + number / STRIP_COLUMNS * (STRIP_PANEL_HEIGHT + TITLE),
                      .scale_x = STRIP_PANEL_WIDTH / (world->right - world->left),
                      .scale_y = STRIP_PANEL_HEIGHT / (world->top - world->bottom),
                      .world = world};
    draw_world(target, &in);
    for (uint32_t i = 0; i < shape->particle_count; i++)
        if (is_inside(&in, x[i], y[i]))
            figure_disc(target, to_x(&in, x[i]), to_y(&in, y[i]), 0.9, broken_ink);
    for (mspring_id s = 0; s < shape->spring_count; s++)
        draw_spring(target, &in, s, shape, x, y);
    if (is_inside(&in, x[world->anchor], y[world->anchor]))
        figure_disc(target, to_x(&in, x[world->anchor]), to_y(&in, y[world->anchor]), 3, rope_ink);
    figure_text(target, in.x + 2, in.y - 8, 11, FIGURE_LEFT, ink, title);
}

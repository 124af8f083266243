/// @file network_picture.h
/// A network as a picture: springs coloured by strain, the rest shape behind.
///
/// SPDX-License-Identifier: MIT
#ifndef DRAW_NETWORK_PICTURE_H
#define DRAW_NETWORK_PICTURE_H

#include "draw/figure.h"

#include <massspring/massspring.h>

/// What a picture needs to know of a network beside the positions: its springs, its floor, and how it looked at
/// first.
typedef struct network_shape {
    uint32_t particle_count, spring_count, floor_count;
    mspring_id *a, *b;  ///< [spring_count]
    float *rest_length; ///< [spring_count]
    uint32_t *flags;    ///< [spring_count]: those with MSPRING_SPRING_BROKEN are not drawn
    double *x, *y;      ///< [particle_count], world positions at first
    bool *pinned;       ///< [particle_count]
    double (*floor)[4]; ///< [floor_count]: x and y of a line's start and end, m
    mspring_id probe;   ///< or MSPRING_NONE
} network_shape;

/// A box in the world.
typedef struct world_box {
    double min_x, min_y, max_x, max_y;
} world_box;

/// How world and strain become pixels and colours.
typedef struct network_view {
    uint32_t width, height;
    double scale;     ///< pixels per metre
    double left, top; ///< pixel of the world's x = 0, y = 0
    double strain_limit;
    double spring_length; ///< of a typical spring, pixels
} network_view;

/// Take a network's shape as it is now.
bool network_shape_make(network_shape *made, const mspring_network *network, mspring_id probe, draw_error *error);
void network_shape_free(network_shape *unwanted);

/// The smallest box around the shape's positions at first.
world_box network_shape_bounds(const network_shape *shape);
/// The box grown to hold these positions, too.
world_box world_box_add(world_box box, const double *x, const double *y, uint32_t count);

/// A round number that is not exceeded by the absolute strain of most springs (99.5 %) at these positions.
double network_strain_limit(const network_shape *shape, const double *x, const double *y);

/// A view that shows the box within so many pixels, with room for title and legend.
network_view network_view_fit(const network_shape *shape, world_box box, uint32_t most_width, uint32_t most_height,
                              double strain_limit);

/// Draw the network at positions x, y onto a figure started with the view's size. The title is put on top, the
/// legend below.
void network_picture_draw(figure *target, const network_shape *shape, const network_view *view, const double *x,
                          const double *y, const char *title);

/// Draw a line of something else on top: x and y of its start and end, m.
void network_picture_line(figure *target, const network_view *view, const double line[4]);

#endif

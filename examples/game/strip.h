/// @file strip.h
/// Pictures of a game beside and below each other.
///
/// SPDX-License-Identifier: MIT
#ifndef GAME_STRIP_H
#define GAME_STRIP_H

#include "draw/network_picture.h"

enum { STRIP_COLUMNS = 2, STRIP_ROWS = 3, STRIP_PANEL_WIDTH = 560, STRIP_PANEL_HEIGHT = 330 };

/// The world that is shown: the water's surface is y = 0.
typedef struct strip_world {
    double left, right, bottom, top; ///< m
    double (*floor_at)(double x);    ///< height of the sea floor, m
    double strain_limit;
    mspring_id first_rope; ///< springs from here on are drawn as ropes
    uint32_t rope_springs;
    mspring_id anchor; ///< a particle
} strip_world;

/// Start the figure of all panels.
void strip_start(figure *made);

/// Draw the next panel: springs that are whole, between positions x, y by particle.
void strip_add(figure *target, uint32_t number, const strip_world *world, const network_shape *shape,
               const double *x, const double *y, const char *title);

#endif

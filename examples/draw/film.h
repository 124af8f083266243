/// @file film.h
/// A moving picture of a network, kept while it moves and drawn afterwards.
///
/// SPDX-License-Identifier: MIT
#ifndef DRAW_FILM_H
#define DRAW_FILM_H

#include "draw/network_picture.h"

/// Positions at moments that lie evenly apart. How long the motion lasts is not known before: whenever the film is
/// full, every second frame is dropped and the frames that follow come half as often.
typedef struct film {
    const network_shape *shape;
    double *x, *y;      ///< [frame_capacity][particle_count]
    uint32_t *flags;    ///< [frame_capacity][spring_count]: springs that break disappear
    mspring_id *probes; ///< [frame_capacity]
    mspring_id probe;   ///< of the frames to come: at first the shape's
    const double
        *corners; ///< [corner_count][2] of something else that moves, m, around its place; NULL: nothing does
    uint32_t corner_count;
    double place[3];      ///< of it in the frames to come: x, y, m, and angle, rad
    double (*places)[3];  ///< [frame_capacity]
    double strain_limit;  ///< of the colours; 0: what suits the last frame
    uint32_t most_height; ///< of a frame, pixels
    uint32_t frame_count, frame_capacity;
    uint64_t interval; ///< steps from frame to frame
    uint64_t step;     ///< seen
} film;

/// Start a film of a network of this shape. Large networks get fewer frames.
bool film_start(film *made, const network_shape *shape, draw_error *error);
void film_free(film *unwanted);

/// To be called after each step.
void film_step(film *target, const mspring_network *network);

/// Positions of the last frame, [particle_count]. There must be one.
const double *film_last_x(const film *source);
const double *film_last_y(const film *source);

/// Write the film as a moving PNG.
bool film_write(const film *source, const char *path, const char *title, draw_error *error);

#endif

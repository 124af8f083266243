/// @file boat.h
/// A small sailing boat, as the files that Floating Sandbox has of ships.
///
/// SPDX-License-Identifier: MIT
#ifndef DATA_BOAT_H
#define DATA_BOAT_H

#include "draw/canvas.h"

enum { BOAT_WIDTH = 60, BOAT_HEIGHT = 44 };

/// Draw the cells.
void boat_draw(canvas *target);
/// Draw the ends of ropes, each pair in a colour of its own.
void boat_draw_ropes(canvas *target);
/// Write both as boat.shp2.
bool boat_write_sections(const canvas *cells, const char *path, draw_error *error);
/// Write the file that names both images, and the materials.
bool boat_write_texts(const char *folder, draw_error *error);

#endif

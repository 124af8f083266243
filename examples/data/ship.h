/// @file ship.h
/// The steamer of ship.png.
///
/// SPDX-License-Identifier: MIT
#ifndef DATA_SHIP_H
#define DATA_SHIP_H

#include "draw/canvas.h"

enum { SHIP_WIDTH = 640, SHIP_HEIGHT = 236 };

/// Draw the ship, seen from its starboard side, on an empty canvas of this size. Its colours are those of
/// ship_materials.csv.
void ship_draw(canvas *target);

#endif

/// @file shoelace.h
/// Area of a polygon, corner by corner.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SHOELACE_H
#define MSPRINGI_SHOELACE_H

/// Polygon up to the last corner that was added. Start with {0}, which is the first corner.
typedef struct mspringi_shoelace {
    double x, y;  ///< last corner, from the first one
    double twice; ///< twice the area, positive if corners follow counterclockwise
} mspringi_shoelace;

/// Add the next corner, relative to the first one.
static inline void mspringi_shoelace_add(mspringi_shoelace *polygon, double x, double y) {
    polygon->twice += polygon->x * y - polygon->y * x;
    polygon->x = x;
    polygon->y = y;
}

#endif

/// @file scatter.h
/// Marks, alone or joined by lines, in a frame whose axes are in powers of ten.
///
/// SPDX-License-Identifier: MIT
#ifndef DRAW_SCATTER_H
#define DRAW_SCATTER_H

#include "draw/figure.h"

typedef enum scatter_mark { SCATTER_DISC, SCATTER_SQUARE, SCATTER_DIAMOND, SCATTER_NO_MARK } scatter_mark;

typedef struct scatter_point {
    double x, y;    ///< > 0; others are left out
    char label[32]; ///< drawn beside it
    bool ringed;    ///< to stand out
} scatter_point;

typedef struct scatter_series {
    const scatter_point *points; ///< [count]
    size_t count;
    scatter_mark mark;
    draw_colour colour;
    bool labels_below;
    const char *name; ///< in the legend; NULL: as the series before
    bool joined;      ///< a line from each point to the next, behind the marks
} scatter_series;

typedef struct scatter {
    const char *title, *x_label, *y_label;
    const scatter_series *series;
    size_t series_count;
    const scatter_point *front; ///< [front_count], joined by steps behind the marks: what no other point beats
    size_t front_count;
    bool percent; ///< y are shares, to be written as such
} scatter;

/// Draw into a part of a figure.
void scatter_draw(figure *target, const scatter *drawn, double left, double top, double width, double height);

#endif

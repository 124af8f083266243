/// @file plot.h
/// Curves in a frame with numbered axes.
///
/// SPDX-License-Identifier: MIT
#ifndef DRAW_PLOT_H
#define DRAW_PLOT_H

#include "draw/figure.h"

typedef struct plot_curve {
    const double *x, *y; ///< [count]
    size_t count;
    draw_colour colour;
    const char *name;
} plot_curve;

typedef struct plot {
    const char *title, *x_label, *y_label;
    const plot_curve *curves;
    size_t curve_count;
    bool log_y; ///< y in powers of ten; values must be above 0
} plot;

/// Colours for first, second ... curves, which colour-blind people tell apart.
enum { PLOT_COLOUR_1 = 0x2f7fd6, PLOT_COLOUR_2 = 0xe07b10 };

/// Draw the plot over the whole of a figure.
void plot_draw(figure *target, const plot *drawn);

#endif

/// @file colour_scale.h
/// Colours for strain.
///
/// SPDX-License-Identifier: MIT
#ifndef DRAW_COLOUR_SCALE_H
#define DRAW_COLOUR_SCALE_H

#include "draw/figure.h"

/// Steps of the scale; the middle one is neutral.
enum { COLOUR_SCALE_STEPS = 41 };

/// Colour of a step, 0 ... COLOUR_SCALE_STEPS - 1: from blue (shortened) over grey to orange and red (stretched).
/// It goes by blue against orange, which colour-blind people tell apart, and by darkness.
draw_colour colour_scale_step(int step);
/// The step of value, which counts as if it were -limit or limit when it lies beyond.
int colour_scale_find(double value, double limit);

/// The smallest of 1, 2, 5, 10, 20 ... (and 0.5, 0.2 ...) that is not below value; 1 if value is not above 0.
double colour_scale_round_up(double value);

#endif

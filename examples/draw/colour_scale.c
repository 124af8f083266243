/// @file colour_scale.c
/// A scale with a neutral middle and two arms.
///
/// SPDX-License-Identifier: MIT
#include "draw/colour_scale.h"

#include <float.h>
#include <math.h>

static const draw_colour stops[] = {0x08306b, 0x2f7fd6, 0xa2a4ac, 0xf08a24, 0x8f1d04};
enum { STOPS = sizeof stops / sizeof *stops };

draw_colour colour_scale_step(int step) {
    double place = (double)step / (COLOUR_SCALE_STEPS - 1) * (STOPS - 1);
    int stop = place >= STOPS - 2 ? STOPS - 2 : (int)place;
    double part = place - stop;
    draw_colour mixed = 0;
    for (int shift = 16; shift >= 0; shift -= 8) {
        double low = (double)(stops[stop] >> shift & 255);
        double high = (double)(stops[stop + 1] >> shift & 255);
        mixed |= (draw_colour)(low + (high - low) * part + 0.5) << shift;
    }
    return mixed;
}

int colour_scale_find(double value, double limit) {
    const int middle = COLOUR_SCALE_STEPS / 2;
    double place = limit > 0 ? value / limit * middle : 0;
    if (!(place > -middle))
        return 0;
    if (!(place < middle))
        return COLOUR_SCALE_STEPS - 1;
    return middle + (int)lround(place);
}

double colour_scale_round_up(double value) {
    if (!(value > 0 && value <= DBL_MAX))
        return 1;
    double power = pow(10, floor(log10(value)));
    const double steps[] = {1, 2, 5};
    for (int i = 0; i < 3; i++)
        if (value <= steps[i] * power * (1 + 1e-9))
            return steps[i] * power;
    return 10 * power;
}

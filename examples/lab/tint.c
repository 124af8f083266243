/// @file tint.c
/// Scales of colours, for dark backgrounds.
///
/// SPDX-License-Identifier: MIT
#include "lab/tint.h"

lab_colour tint_of_side(int side) {
    return side == 0 ? TINT_LEFT : TINT_RIGHT;
}

static lab_colour between(const lab_colour *stops, int count, int step) {
    const int place = step * (count - 1) * 256 / (TINT_STEPS - 1);
    const int stop = place >= (count - 1) * 256 ? count - 2 : place / 256;
    return colour_mix(stops[stop], stops[stop + 1], place - stop * 256);
}

lab_colour tint_strain(int step) {
    static const lab_colour stops[] = {0x9fe8ff, 0x3fa2ff, 0x2f66c4, 0x4a5568, 0xc4562d, 0xff9340, 0xffe39a};
    return between(stops, sizeof stops / sizeof *stops, step);
}

lab_colour tint_speed(int step) {
    static const lab_colour stops[] = {0x2b3a67, 0x3b5fa8, 0x2a9d8f, 0x8bd450, 0xf9e267};
    return between(stops, sizeof stops / sizeof *stops, step);
}

lab_colour tint_bent(int step) {
    static const lab_colour stops[] = {0xf3c4ff, 0xc45cff, 0x7a4fb0, 0x4a5568, 0xb0423a, 0xff4d4d, 0xffc2a8};
    return between(stops, sizeof stops / sizeof *stops, step);
}

lab_colour tint_of(colour_choice by, int step) {
    return by == COLOUR_SPEED ? tint_speed(step) : by == COLOUR_BENT ? tint_bent(step) : tint_strain(step);
}

lab_colour tint_distinct(uint32_t index) {
    static const lab_colour colours[] = {0x5aa9e6, 0xf4a259, 0x7bd389, 0xe56b9f, 0xb8a1ff, 0xf2e266, 0x4ecdc4,
                                         0xd98e73, 0x9ad1d4, 0xc0ca33, 0xff8fa3, 0x8d99ae, 0x6a7fdb};
    return colours[index % (sizeof colours / sizeof *colours)];
}

lab_colour tint_material(lab_colour colour) {
    const uint32_t red = colour >> 16 & 255, green = colour >> 8 & 255, blue = colour & 255;
    const uint32_t light = (2 * red + 5 * green + blue) / 8;
    return light < 96 ? colour_mix(colour, 0x8fa3bf, (int)(96 - light) * 3 / 2) : colour;
}

/// @file tint.h
/// The lab's colours.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_TINT_H
#define LAB_TINT_H

#include "lab/action.h"
#include "lab/raster.h"

enum {
    TINT_WINDOW = 0x0b0e14,
    TINT_PANEL = 0x141a24,
    TINT_VIEW = 0x10151e,
    TINT_GRID = 0x18202c,
    TINT_EDGE = 0x252f3f,
    TINT_GHOST = 0x1e2836,
    TINT_TEXT = 0xe3e9f2,
    TINT_FAINT = 0x8793a6,
    TINT_BUTTON = 0x212b3a,
    TINT_LEFT = 0x4fd1c5,
    TINT_RIGHT = 0xc79bff,
    TINT_PIN = 0xffe08a,
    TINT_WARNING = 0xff6b6b,
    TINT_GOOD = 0x6bd68a,
};

enum { TINT_STEPS = 256 };

/// The colour of a side.
lab_colour tint_of_side(int side);
/// From shortened, blue, over steel to stretched, orange and yellow: step 0 to TINT_STEPS - 1.
lab_colour tint_strain(int step);
/// From slow, dark blue, to fast, yellow.
lab_colour tint_speed(int step);
/// What is bent for good: from shortened, violet, over steel to lengthened, red.
lab_colour tint_bent(int step);
/// The scale of a choice of colours.
lab_colour tint_of(colour_choice by, int step);
/// One of some colours that differ.
lab_colour tint_distinct(uint32_t index);
/// A colour of an image, light enough for a dark background.
lab_colour tint_material(lab_colour colour);

#endif

/// @file palette.h
/// At most 256 colours that stand for all colours of some pictures.
///
/// SPDX-License-Identifier: MIT
#ifndef DRAW_PALETTE_H
#define DRAW_PALETTE_H

#include "draw/canvas.h"

enum { PALETTE_MOST = 256 };

typedef struct palette {
    draw_colour colours[PALETTE_MOST];
    size_t count;
    bool exact;       ///< every colour has its own place, and they are sorted
    uint8_t *nearest; ///< if not exact, [2^15]: the place for each colour of 5 bits a channel
} palette;

/// Choose at most so many colours for pictures like these: exactly theirs if they are few. Returns false when out
/// of memory.
bool palette_make(palette *made, const canvas *pictures, size_t count, size_t most);
void palette_free(palette *unwanted);

/// The place of the colour that stands for this one.
uint8_t palette_place(const palette *colours, draw_colour colour);

#endif

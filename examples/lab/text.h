/// @file text.h
/// Text on rasters: a small bitmap font, made from the strokes of the examples' letters at the size that is wanted.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_TEXT_H
#define LAB_TEXT_H

#include "lab/raster.h"

enum { FONT_FIRST = 33, FONT_LAST = 126, FONT_GLYPHS = FONT_LAST - FONT_FIRST + 1 };

typedef struct lab_font {
    int height; ///< of capitals, pixels
    int ascent, descent, space, gap;
    struct font_glyph {
        int width;
        uint8_t *coverage; ///< [ascent + descent][width]
    } glyphs[FONT_GLYPHS];
} lab_font;

typedef enum text_align { TEXT_LEFT, TEXT_CENTRE, TEXT_RIGHT } text_align;

/// Make a font whose capitals are so many pixels high. Returns false when out of memory.
bool font_make(lab_font *made, int height);
void font_free(lab_font *unwanted);

int text_width(const lab_font *font, const char *text);
/// Draw a line of text; y is the baseline, the row below the capitals' last. What cannot be printed is a box.
void text_draw(lab_raster *target, lab_box clip, const lab_font *font, int x, int y, text_align align,
               lab_colour colour, const char *text);

#endif

/// @file internal.h
/// What the parts of the drawing library share.
///
/// SPDX-License-Identifier: MIT
#ifndef DRAW_INTERNAL_H
#define DRAW_INTERNAL_H

#include "draw/canvas.h"
#include "draw/figure.h"

#include <stdio.h>

#if defined(__MINGW32__) && !defined(__clang__)
#define DRAW_PRINTF(text, first) __attribute__((format(gnu_printf, text, first))) // printf: that of old Windows
#elif defined(__GNUC__)
#define DRAW_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define DRAW_PRINTF(text, first)
#endif

/// Write a message into error. Always returns false.
bool draw_fail(draw_error *error, const char *format, ...) DRAW_PRINTF(2, 3);
/// Open a file for writing.
FILE *draw_open(const char *path, draw_error *error);
/// Close it; false if anything that was written to it got lost.
bool draw_close(FILE *stream, const char *path, draw_error *error);

/* stroke_font.c */

/// Draw text of the given height (of its capitals) with its baseline starting at x, y.
void stroke_font_draw(canvas *target, double x, double y, double height, draw_colour colour, const char *text);
double stroke_font_width(double height, const char *text);
/// The strokes of a letter: points, each a digit (x) and a letter (y), see stroke_font.c; a space has those of an
/// unknown one.
const char *stroke_font_glyph(char c);

/* zlib_stb.c or zlib_stored.c */

/// Put into the zlib format. Returns bytes that the caller frees, or NULL when out of memory.
uint8_t *zlib_pack(const uint8_t *bytes, size_t length, size_t *packed);

#endif

/// @file text.c
/// Letters as bitmaps. The points of their strokes are moved to whole pixels, so that stems are sharp.
///
/// SPDX-License-Identifier: MIT
#include "lab/text.h"
#include "draw/internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CAP_HEIGHT = 12, DEPTH = 4 }; // of the strokes' grid: above the baseline, and below

// The points of a glyph, one after the other. Returns false at the end; *down says whether a stroke leads there.
static bool next_point(const char **at, double scale, int *x, int *y, bool *down) {
    *down = true;
    for (; **at == '/'; (*at)++)
        *down = false;
    if (!**at)
        return false;
    *x = (int)lround(((*at)[0] - '0') * scale);
    *y = (int)lround(((*at)[1] - 'e') * scale);
    *at += 2;
    return true;
}

static bool make_glyph(struct font_glyph *made, const lab_font *font, const char *strokes) {
    const double scale = (double)font->height / CAP_HEIGHT;
    const double thickness = scale > 1 ? 1.15 * scale : 1.15;
    int x, y, widest = 0;
    bool down;
    for (const char *at = strokes; next_point(&at, scale, &x, &y, &down);)
        widest = x > widest ? x : widest;
    lab_raster drawn;
    if (!raster_make(&drawn, widest + 2, font->ascent + font->descent))
        return false;
    const lab_box all = {0, 0, drawn.width, drawn.height};
    double from_x = 0, from_y = 0;
    for (const char *at = strokes; next_point(&at, scale, &x, &y, &down);) {
        const double to_x = x + 0.5, to_y = font->ascent - 1 - y + 0.5;
        if (down && at != strokes + 2)
            raster_line(&drawn, all, from_x, from_y, to_x, to_y, thickness, 0xffffff, 256);
        from_x = to_x;
        from_y = to_y;
    }
    const size_t pixels = (size_t)drawn.width * (size_t)drawn.height;
    made->width = drawn.width;
    made->coverage = malloc(pixels);
    for (size_t i = 0; made->coverage && i < pixels; i++)
        made->coverage[i] = (uint8_t)(drawn.pixels[i] & 255);
    raster_free(&drawn);
    return made->coverage != NULL;
}

bool font_make(lab_font *made, int height) {
    const double scale = (double)height / CAP_HEIGHT;
    memset(made, 0, sizeof *made);
    made->height = height;
    made->ascent = height + 2;
    made->descent = (int)ceil(DEPTH * scale) + 1;
    made->space = (int)lround(5.5 * scale);
    made->gap = (int)lround(2.6 * scale) - 1; // a glyph's bitmap is a pixel wider than its strokes
    made->gap = made->gap < 1 ? 1 : made->gap;
    for (int i = 0; i < FONT_GLYPHS; i++) {
        if (make_glyph(&made->glyphs[i], made, stroke_font_glyph((char)(FONT_FIRST + i))))
            continue;
        font_free(made);
        return false;
    }
    return true;
}

void font_free(lab_font *unwanted) {
    for (int i = 0; i < FONT_GLYPHS; i++)
        free(unwanted->glyphs[i].coverage);
    memset(unwanted, 0, sizeof *unwanted);
}

static const struct font_glyph *glyph_for(const lab_font *font, char c) {
    const int code = (unsigned char)c;
    return &font->glyphs[code >= FONT_FIRST && code <= FONT_LAST ? code - FONT_FIRST : '#' - FONT_FIRST];
}

static int advance(const lab_font *font, char c) {
    return c == ' ' ? font->space : glyph_for(font, c)->width + font->gap;
}

int text_width(const lab_font *font, const char *text) {
    int width = 0;
    for (; *text; text++)
        width += advance(font, *text);
    return width;
}

static void draw_glyph(lab_raster *target, lab_box clip, const lab_font *font, const struct font_glyph *glyph,
                       int x, int y, lab_colour colour) {
    const int top = y - font->ascent;
    for (int row = 0; row < font->ascent + font->descent; row++) {
        uint32_t *pixels = target->pixels + (ptrdiff_t)(top + row) * target->width;
        for (int column = 0; column < glyph->width; column++) {
            const int coverage = glyph->coverage[row * glyph->width + column];
            if (coverage > 0 && box_holds(clip, x + column, top + row))
                pixels[x + column] = colour_mix(pixels[x + column], colour, coverage + (coverage >> 7));
        }
    }
}

void text_draw(lab_raster *target, lab_box clip, const lab_font *font, int x, int y, text_align align,
               lab_colour colour, const char *text) {
    if (align != TEXT_LEFT)
        x -= align == TEXT_CENTRE ? text_width(font, text) / 2 : text_width(font, text);
    for (; *text; text++) {
        if (*text != ' ')
            draw_glyph(target, clip, font, glyph_for(font, *text), x, y, colour);
        x += advance(font, *text);
    }
}

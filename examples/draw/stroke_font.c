/// @file stroke_font.c
/// Letters made of straight strokes, which can have any size.
///
/// A glyph is a string of points, each a digit (x, 0 to 8) and a letter (y, from a = -4 over e = 0, the
/// baseline, and m = 8, the height of small letters, to q = 12, that of capitals). '/' lifts the pen.
///
/// SPDX-License-Identifier: MIT
#include "draw/internal.h"

static const double cap_height = 12;
static const double gap = 3.6; // between two letters
static const double space = 5;

static const char *const glyphs[128] = {
    ['0'] = "2e5e7h7n5q2q0n0h2e",
    ['1'] = "1n4q4e",
    ['2'] = "0n2q5q7n7l0e7e",
    ['3'] = "0o2q5q7o7m5k2k/5k7i7g5e2e0g",
    ['4'] = "5e5q0h7h",
    ['5'] = "7q1q0k2l5l7j7g5e2e0g",
    ['6'] = "6q3q0m0g2e5e7g7i5k2k0i",
    ['7'] = "0q7q3e",
    ['8'] = "2k0m0o2q5q7o7m5k2k0i0g2e5e7g7i5k",
    ['9'] = "1e4e7i7o5q2q0o0m2k5k7m",
    ['A'] = "0e4q8e/1i7i",
    ['B'] = "0e0q5q7o7m5k0k/5k7i7g5e0e",
    ['C'] = "8n6q2q0n0h2e6e8h",
    ['D'] = "0e0q4q7n7h4e0e",
    ['E'] = "7q0q0e7e/0k5k",
    ['F'] = "7q0q0e/0k5k",
    ['G'] = "8n6q2q0n0h2e6e8h8k5k",
    ['H'] = "0e0q/8e8q/0k8k",
    ['I'] = "0e0q",
    ['J'] = "5q5g3e2e0g",
    ['K'] = "0e0q/7q0i/2k7e",
    ['L'] = "0q0e6e",
    ['M'] = "0e0q4i8q8e",
    ['N'] = "0e0q7e7q",
    ['O'] = "2e6e8h8n6q2q0n0h2e",
    ['P'] = "0e0q5q7o7m5k0k",
    ['Q'] = "2e6e8h8n6q2q0n0h2e/5h8d",
    ['R'] = "0e0q5q7o7m5k0k/4k7e",
    ['S'] = "7o5q2q0o0m2k5k7i7g5e2e0g",
    ['T'] = "0q8q/4q4e",
    ['U'] = "0q0g2e5e7g7q",
    ['V'] = "0q4e8q",
    ['W'] = "0q2e4m6e8q",
    ['X'] = "0e7q/0q7e",
    ['Y'] = "0q4k8q/4k4e",
    ['Z'] = "0q7q0e7e",
    ['a'] = "6m6e/6k4m2m0k0g2e4e6g",
    ['b'] = "0q0e/0k2m4m6k6g4e2e0g",
    ['c'] = "6l4m2m0k0g2e4e6f",
    ['d'] = "6q6e/6k4m2m0k0g2e4e6g",
    ['e'] = "0i6i6k4m2m0k0g2e4e6f",
    ['f'] = "4q3q2p2e/0m4m",
    ['g'] = "6m6c4a2a0b/6k4m2m0k0g2e4e6g",
    ['h'] = "0q0e/0k2m4m6k6e",
    ['i'] = "0e0m/0p0q",
    ['j'] = "2m2b0a/2p2q",
    ['k'] = "0q0e/5m0h/2j5e",
    ['l'] = "0q0f1e",
    ['m'] = "0e0m/0k2m3m4k4e/4k6m7m8k8e",
    ['n'] = "0e0m/0k2m4m6k6e",
    ['o'] = "2e4e6g6k4m2m0k0g2e",
    ['p'] = "0m0a/0k2m4m6k6g4e2e0g",
    ['q'] = "6m6a/6k4m2m0k0g2e4e6g",
    ['r'] = "0e0m/0k2m4m",
    ['s'] = "5l4m1m0l0k1j4h5g5f4e1e0f",
    ['t'] = "2p2f3e4e/0m4m",
    ['u'] = "0m0g2e4e6g/6m6e",
    ['v'] = "0m3e6m",
    ['w'] = "0m2e4k6e8m",
    ['x'] = "0m6e/0e6m",
    ['y'] = "0m3e/6m2a0a",
    ['z'] = "0m6m0e6e",
    ['.'] = "0e0f",
    [','] = "1f0c",
    [':'] = "0e0f/0l0m",
    ['\''] = "0o0q",
    ['+'] = "0j6j/3g3m",
    ['-'] = "0j5j",
    ['='] = "0h6h/0l6l",
    ['/'] = "0d6q",
    ['%'] = "1e7q/0o1q2q3o2m1m0o/5g6i7i8g7e6e5g",
    ['('] = "2q0n0g2d",
    [')'] = "0q2n2g0d",
    ['#'] = "2e3q/5e6q/0i8i/0m8m",
    ['_'] = "0d7d",
    ['<'] = "6n0j6f",
    ['>'] = "0n6j0f",
    ['!'] = "0q0h/0e0f",
    ['?'] = "0o1q4q6p6n3k3h/3e3f",
    ['*'] = "3l3q/0m6p/0p6m",
    ['['] = "2q0q0d2d",
    [']'] = "0q2q2d0d",
    ['|'] = "0q0d",
    ['"'] = "0o0q/3o3q",
    [';'] = "1f0c/1l1m",
    ['^'] = "0n3q6n",
    ['~'] = "0j1k2k4i5i6j",
};

static const char *const unknown_glyph = "0e0q7q7e0e";

const char *stroke_font_glyph(char c) {
    unsigned char index = (unsigned char)c;
    return index < 128 && glyphs[index] ? glyphs[index] : unknown_glyph;
}

static double glyph_width(char c) {
    if (c == ' ')
        return space;
    double widest = 0;
    for (const char *point = stroke_font_glyph(c); *point; point++)
        if (*point >= '0' && *point <= '8' && *point - '0' > widest)
            widest = *point - '0';
    return widest;
}

static void draw_glyph(canvas *target, double x, double y, double scale, draw_colour colour, const char *glyph) {
    double width = 1.3 * scale > 1 ? 1.3 * scale : 1;
    bool down = false;
    double from_x = 0;
    double from_y = 0;
    for (const char *point = glyph; *point; point++) {
        if (*point == '/') {
            down = false;
            continue;
        }
        double to_x = x + (*point - '0') * scale;
        point++;
        double to_y = y - (*point - 'e') * scale;
        if (down)
            canvas_line(target, from_x, from_y, to_x, to_y, width, colour);
        from_x = to_x;
        from_y = to_y;
        down = true;
    }
}

void stroke_font_draw(canvas *target, double x, double y, double height, draw_colour colour, const char *text) {
    double scale = height / cap_height;
    for (; *text; text++) {
        if (*text != ' ')
            draw_glyph(target, x, y, scale, colour, stroke_font_glyph(*text));
        x += (glyph_width(*text) + gap) * scale;
    }
}

double stroke_font_width(double height, const char *text) {
    double width = 0;
    for (; *text; text++)
        width += glyph_width(*text) + gap;
    return width > 0 ? (width - gap) * height / cap_height : 0;
}

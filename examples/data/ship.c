/// @file ship.c
/// A steamer with four funnels, standing on dock blocks amidships.
///
/// Its hull is cut open below the waterline, so that holds and boiler rooms show. Coordinates are pixels, which
/// become metres; y is down.
///
/// SPDX-License-Identifier: MIT
#include "data/ship.h"
#include "data/pixels.h"

#include <math.h>
#include <stddef.h>

// Materials, as in ship_materials.csv.
enum {
    DOCK = 0x0a0a0a,
    PROBE = 0x216ccf,
    HULL = 0x23262d,
    BOTTOM = 0x9c2b23,
    FRAME = 0x808090,
    HOUSE = 0xe9e2cf,
    DECK = 0x8a5a2b,
    FUNNEL = 0xd08a2e,
    MAST = 0x6b4423,
    BRONZE = 0xa8792a,
    ROPE = 0xb09a70,
    FLAG = 0xc23b3b,
};

enum {
    STERN = 48,      // column of the stern's end at the deck
    BOW = 592,       // and of the bow's
    DECK_ROW = 142,  // of the deck amidships
    WATER_ROW = 174, // of the waterline
    KEEL_ROW = 199,  // the hull's lowest row
    FIRST_FUNNEL = 224,
    LAST_FUNNEL = 380,
    FUNNEL_PITCH = 52,
};

// The deck rises towards both ends.
static int deck_row(int x) {
    double place = (x - (STERN + BOW) / 2.0) / ((BOW - STERN) / 2.0);
    double rise = place > 0 ? 13 : 9;
    return DECK_ROW - (int)lround(rise * place * place);
}

// How far below the deck a row is: 0 to 1 at the keel.
static double depth_of(int y, int deck) {
    double depth = (double)(y - deck) / (KEEL_ROW - deck);
    return depth < 0 ? 0 : depth;
}

// The stem leans back a little and is rounded where it meets the keel.
static double bow_column(int y) {
    double depth = depth_of(y, DECK_ROW - 13);
    return BOW - 12 * depth - 24 * pow(depth, 7);
}

// The stern hangs over; below it the hull draws in towards rudder and screw.
static double stern_column(int y) {
    double depth = depth_of(y, DECK_ROW - 9);
    double drawn_in = depth < 0.42 ? 0 : (depth - 0.42) / 0.58;
    return STERN + 40 * depth * depth + 44 * sin(1.5708 * fmin(1, 1.6 * drawn_in));
}

static void draw_hull(canvas *target) {
    for (int y = 0; y <= KEEL_ROW; y++) {
        int left = (int)lround(stern_column(y));
        int right = (int)lround(bow_column(y));
        for (int x = left; x <= right; x++)
            if (y >= deck_row(x))
                pixels_set(target, x, y, y < WATER_ROW ? HULL : BOTTOM);
    }
    // The line between black and red, a strake below the deck, and the deck itself.
    for (int x = STERN; x <= BOW; x++) {
        int deck = deck_row(x);
        for (int y = WATER_ROW - 2; y < WATER_ROW; y++)
            if (pixels_get(target, x, y) == HULL)
                pixels_set(target, x, y, HOUSE);
        if (pixels_get(target, x, deck + 4) == HULL)
            pixels_set(target, x, deck + 4, FRAME);
        for (int y = deck; y < deck + 2; y++)
            if (pixels_get(target, x, y) == HULL)
                pixels_set(target, x, y, DECK);
    }
}

static void draw_portholes(canvas *target) {
    for (int x = STERN + 16; x < BOW - 18; x += 7) {
        int deck = deck_row(x);
        pixels_box(target, x, deck + 9, 2, 2, PIXELS_EMPTY);
        pixels_box(target, x, deck + 18, 2, 2, PIXELS_EMPTY);
        if (x > STERN + 40 && x < BOW - 30)
            pixels_box(target, x + 3, deck + 27, 2, 2, PIXELS_EMPTY);
    }
}

// A room with a frame of its own around it.
static void draw_room(canvas *target, int x, int y, int width, int height) {
    pixels_box(target, x - 2, y - 2, width + 4, height + 4, FRAME);
    pixels_box(target, x, y, width, height, PIXELS_EMPTY);
}

static void draw_rooms(canvas *target) {
    enum { TOP = WATER_ROW + 5, HEIGHT = 15, WIDTH = 29, PITCH = 33, FIRST = 130, LAST = 500 };
    int index = 0;
    for (int x = FIRST; x <= LAST; x += PITCH, index++) {
        draw_room(target, x, TOP, WIDTH, HEIGHT);
        bool has_boilers = index >= 3 && index <= 8;
        for (int i = 0; has_boilers && i < 2; i++) {
            pixels_disc(target, x + 7.5 + 14 * i, TOP + HEIGHT - 6.5, 6.3, HULL);
            pixels_disc(target, x + 7.5 + 14 * i, TOP + HEIGHT - 6.5, 2.3, PIXELS_EMPTY);
        }
        if (!has_boilers) // a deck in the middle of the hold
            pixels_box(target, x, TOP + HEIGHT / 2, WIDTH, 2, FRAME);
    }
}

static void draw_rudder_and_screw(canvas *target) {
    int left = (int)lround(stern_column(KEEL_ROW - 8));
    const pixel_point rudder[] = {
        {left - 26, 168}, {left - 17, 164}, {left - 17, KEEL_ROW + 1}, {left - 30, KEEL_ROW + 1}, {left - 31, 181},
    };
    pixels_polygon(target, rudder, 5, BOTTOM);
    // The shaft, and a screw seen from the side.
    pixels_box(target, left - 11, 188, 14, 3, FRAME);
    pixels_disc(target, left - 9, 183.5, 4.2, BRONZE);
    pixels_disc(target, left - 9, 195.5, 4.2, BRONZE);
    pixels_box(target, left - 11, 183, 4, 13, BRONZE);
    // The heel that carries the rudder's foot.
    pixels_box(target, left - 30, KEEL_ROW - 1, 40, 3, BOTTOM);
}

// A row of windows, each with some wall between it and the next.
static void draw_windows(canvas *target, int left, int right, int y, int width, int height, int pitch) {
    for (int x = left; x + width <= right; x += pitch)
        pixels_box(target, x, y, width, height, PIXELS_EMPTY);
}

// A storey of the house: walls, a roof of wood that stands over a little, windows.
static void draw_storey(canvas *target, int left, int right, int roof, int floor_row, int pitch) {
    pixels_box(target, left, roof, right - left, floor_row - roof, HOUSE);
    pixels_box(target, left - 4, roof, right - left + 8, 2, DECK);
    draw_windows(target, left + 5, right - 4, roof + 4, 3, 3, pitch);
}

static void draw_houses(canvas *target) {
    // Down to where the deck is lowest, so that no gap stays below.
    draw_storey(target, 162, 480, 131, DECK_ROW + 1, 8);
    draw_storey(target, 176, 470, 121, 131, 6);
    draw_storey(target, 196, 452, 112, 121, 9);
    // The bridge, with its wings.
    draw_storey(target, 416, 450, 103, 112, 5);
    pixels_box(target, 408, 103, 50, 2, DECK);
    draw_storey(target, 421, 443, 95, 103, 5);
    // Houses on the foredeck and on the poop.
    draw_storey(target, 522, 554, 124, 137, 8);
    draw_storey(target, 82, 122, 126, 140, 8);
}

// One in front of each funnel.
static void draw_lifeboats(canvas *target) {
    for (int x = FIRST_FUNNEL + 17; x < LAST_FUNNEL; x += FUNNEL_PITCH) {
        const pixel_point boat[] = {{x, 105}, {x + 22, 105}, {x + 18, 110}, {x + 4, 110}};
        pixels_polygon(target, boat, 4, HOUSE);
        pixels_box(target, x, 105, 22, 1, DECK);
        pixels_box(target, x + 5, 110, 2, 2, FRAME);
        pixels_box(target, x + 15, 110, 2, 2, FRAME);
    }
}

// Funnels lean back by one in six.
static void draw_funnel(canvas *target, double x) {
    enum { FOOT = 113, TOP = 52, RIM = 63 };
    const double lean = 1.0 / 6;
    const double half = 8.5;
    double top_shift = lean * (FOOT - TOP);
    double rim_shift = lean * (FOOT - RIM);
    const pixel_point stack[] = {
        {x - half, FOOT}, {x + half, FOOT}, {x + half - top_shift, TOP}, {x - half - top_shift, TOP}};
    const pixel_point rim[] = {{x - half - rim_shift, RIM},
                               {x + half - rim_shift, RIM},
                               {x + half - top_shift, TOP},
                               {x - half - top_shift, TOP}};
    pixels_polygon(target, stack, 4, FUNNEL);
    pixels_polygon(target, rim, 4, HULL);
    // The steam pipe along the front.
    const pixel_point pipe[] = {{x + half + 1, FOOT},
                                {x + half + 3, FOOT},
                                {x + half + 3 - rim_shift, RIM},
                                {x + half + 1 - rim_shift, RIM}};
    pixels_polygon(target, pipe, 4, FRAME);
    pixels_box(target, (int)lround(x - half) - 2, FOOT - 4, 2 * (int)half + 6, 4, FRAME);
}

// Where a mast's top is, for a foot at this column of the deck.
static int mast_top(int foot) {
    return foot - 13;
}

enum { MAST_TOP_ROW = 24, CROW_ROW = 66 };

static void draw_mast(canvas *target, int foot) {
    int deck = deck_row(foot);
    int top = mast_top(foot);
    const pixel_point pole[] = {
        {foot - 2, deck + 1}, {foot + 3, deck + 1}, {top + 1.5, MAST_TOP_ROW}, {top - 1.5, MAST_TOP_ROW}};
    pixels_polygon(target, pole, 4, MAST);
    // The crow's nest and a yard.
    int nest = (int)lround(foot + (double)(top - foot) * (deck - CROW_ROW) / (deck - MAST_TOP_ROW));
    pixels_box(target, nest - 4, CROW_ROW - 5, 9, 6, MAST);
    pixels_box(target, top - 9, 38, 22, 2, MAST);
}

// Two derricks that lean away from the mast, each held by a rope from the nest.
static void draw_derricks(canvas *target, int foot) {
    int deck = deck_row(foot);
    int nest = foot - 8;
    for (int side = -1; side <= 1; side += 2) {
        int tip = foot + side * 26;
        const pixel_point boom[] = {{foot + side * 2 - 1.6, deck - 6.0},
                                    {foot + side * 2 + 1.6, deck - 6.0},
                                    {tip + 1.6, deck - 38.0},
                                    {tip - 1.6, deck - 38.0}};
        pixels_polygon(target, boom, 4, MAST);
        pixels_rope(target, nest, CROW_ROW + 2, tip, deck - 38, ROPE);
    }
}

static void draw_rigging(canvas *target, int main_mast, int fore_mast) {
    int main_top = mast_top(main_mast);
    int fore_top = mast_top(fore_mast);
    // Stays to both ends of the ship, the aerial between the masts, and shrouds to the deck.
    pixels_rope(target, fore_top, MAST_TOP_ROW + 3, BOW - 8, deck_row(BOW - 8) - 1, ROPE);
    pixels_rope(target, main_top, MAST_TOP_ROW + 3, STERN + 12, deck_row(STERN + 12) - 1, ROPE);
    pixels_rope(target, main_top, MAST_TOP_ROW + 1, fore_top, MAST_TOP_ROW + 1, ROPE);
    for (int i = 0; i < 3; i++) {
        int spread = 20 + 9 * i;
        pixels_rope(target, fore_top + 1, MAST_TOP_ROW + 8 + 4 * i, fore_mast + spread,
                    deck_row(fore_mast + spread) - 1, ROPE);
        pixels_rope(target, fore_top - 1, MAST_TOP_ROW + 8 + 4 * i, fore_mast - spread,
                    deck_row(fore_mast - spread) - 1, ROPE);
        pixels_rope(target, main_top - 1, MAST_TOP_ROW + 8 + 4 * i, main_mast - spread,
                    deck_row(main_mast - spread) - 1, ROPE);
        pixels_rope(target, main_top + 1, MAST_TOP_ROW + 8 + 4 * i, main_mast + spread,
                    deck_row(main_mast + spread) - 1, ROPE);
    }
}

static void draw_flag(canvas *target) {
    int deck = deck_row(STERN + 3);
    pixels_box(target, STERN + 2, deck - 26, 2, 26, MAST);
    pixels_box(target, STERN - 14, deck - 25, 16, 10, FLAG);
    pixels_box(target, STERN - 14, deck - 21, 16, 2, HOUSE);
}

static void draw_dock(canvas *target) {
    for (int x = 236; x <= 404; x += 28)
        pixels_box(target, x - 6, KEEL_ROW + 1, 12, 4, DOCK);
}

void ship_draw(canvas *target) {
    enum { MAIN_MAST = 142, FORE_MAST = 504 };
    draw_rudder_and_screw(target);
    draw_hull(target);
    draw_portholes(target);
    draw_rooms(target);
    draw_houses(target);
    for (int x = FIRST_FUNNEL; x <= LAST_FUNNEL; x += FUNNEL_PITCH)
        draw_funnel(target, x);
    draw_lifeboats(target);
    draw_mast(target, MAIN_MAST);
    draw_mast(target, FORE_MAST);
    draw_derricks(target, MAIN_MAST);
    draw_derricks(target, FORE_MAST);
    draw_rigging(target, MAIN_MAST, FORE_MAST);
    draw_flag(target);
    draw_dock(target);
    pixels_set(target, BOW, deck_row(BOW), PROBE);
}

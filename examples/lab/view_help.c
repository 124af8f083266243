/// @file view_help.c
/// The keys, on the screen.
///
/// SPDX-License-Identifier: MIT
#include "lab/keys.h"
#include "lab/tint.h"
#include "lab/view.h"

#include <string.h>

void view_draw_help(lab_view *view) {
    enum { WIDTH = 880, TOP = 74, KEY = 140, MARGIN = 26 };
    const lab_box all = {0, 0, view->target.width, view->target.height};
    const bool is_narrow = all.width < WIDTH + 16;
    const int columns = is_narrow ? 1 : 2, line = is_narrow ? 15 : 19,
              rows = (keys_help_count + columns - 1) / columns;
    const int width = is_narrow ? all.width - 16 : WIDTH, height = TOP + rows * line + 20;
    const lab_box box = {(all.width - width) / 2, (all.height - height) / 2 > 8 ? (all.height - height) / 2 : 8,
                         width, height < all.height - 16 ? height : all.height - 16};
    raster_fill(&view->target, all, all, TINT_WINDOW, 140);
    raster_round(&view->target, box, box, 10, TINT_EDGE, 256);
    raster_round(&view->target, box, box_shrink(box, 1), 9, TINT_PANEL, 256);
    text_draw(&view->target, box, &view->large, box.x + MARGIN, box.y + 32, TEXT_LEFT, TINT_TEXT, "keys and mouse");
    text_draw(&view->target, box, &view->normal, box.x + MARGIN, box.y + 54, TEXT_LEFT, TINT_FAINT,
              "Masses on springs. Above and below, two solvers move the same network.");
    for (int i = 0; i < keys_help_count; i++) {
        const int x = box.x + MARGIN + i / rows * ((width - MARGIN) / columns),
                  y = box.y + TOP + 12 + i % rows * line;
        text_draw(&view->target, box, &view->normal, x, y, TEXT_LEFT, TINT_LEFT, keys_help[i].key);
        text_draw(&view->target, box, &view->normal, x + KEY, y, TEXT_LEFT, TINT_TEXT, keys_help[i].about);
    }
    // It lies over gaps, too, which the next picture has to fill again.
    memset(view->filled, 0, sizeof view->filled);
}

/// @file view_tip.c
/// Small boxes that explain: what lies under the mouse, and the spring that was clicked.
///
/// SPDX-License-Identifier: MIT
#include "lab/tint.h"
#include "lab/view.h"

#include <massspring/massspring.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TIP_LINES = 2, TIP_TEXT = 96, MARGIN = 9, LINE = 17 };

// Lines in a box whose upper left corner is at a place, or as near to it as lets the box be whole.
static void draw_tip(lab_view *view, lab_box clip, int x, int y, int count, char lines[TIP_LINES][TIP_TEXT]) {
    lab_box box = {x, y, 0, LINE * count + 8};
    for (int i = 0; i < count; i++) {
        const int width = text_width(&view->normal, lines[i]) + 2 * MARGIN;
        box.width = width > box.width ? width : box.width;
    }
    if (box.width > clip.width || box.height > clip.height)
        return;
    box.x = box.x + box.width > clip.x + clip.width ? clip.x + clip.width - box.width : box.x;
    box.y = box.y + box.height > clip.y + clip.height ? clip.y + clip.height - box.height : box.y;
    box.x = box.x < clip.x ? clip.x : box.x;
    box.y = box.y < clip.y ? clip.y : box.y;
    raster_round(&view->target, clip, box, 4, TINT_TEXT, 256);
    for (int i = 0; i < count; i++)
        text_draw(&view->target, clip, &view->normal, box.x + MARGIN, box.y + 15 + LINE * i, TEXT_LEFT, TINT_WINDOW,
                  lines[i]);
}

void view_draw_spring(lab_view *view, const lab_model *model, int index, const lab_camera *camera) {
    const lab_side *side = &model->sides[index];
    const lab_box box = view->layout.views[index];
    if (!model->has_spring)
        return;
    const uint32_t spring = model->spring, a = side->stage->a[spring], b = side->stage->b[spring];
    double ax, ay, bx, by, px, py, qx, qy;
    char lines[TIP_LINES][TIP_TEXT], newtons[32];
    float force = 0;
    side_position(side, a, &ax, &ay);
    side_position(side, b, &bx, &by);
    camera_to_pixel(camera, ax, ay, &px, &py);
    camera_to_pixel(camera, bx, by, &qx, &qy);
    snprintf(lines[0], TIP_TEXT, "spring %u of particles %u and %u", spring, a, b);
    if (side->broken[spring] ||
        mspring_network_get(side->network, MSPRING_TENSION, NULL, spring, 1, &force, 1) != MSPRING_OK)
        snprintf(lines[1], TIP_TEXT, "broken");
    else
        snprintf(lines[1], TIP_TEXT, "%.4g m, strain %.3g %%, %s %sN", hypot(bx - ax, by - ay),
                 100 * (double)side->strain[spring], force < 0 ? "pushes" : "pulls",
                 view_number(fabs((double)force), newtons));
    raster_line(&view->target, box, px, py, qx, qy, 3, 0xffffff, 256);
    const double x = 0.5 * (px + qx), y = 0.5 * (py + qy);
    if (x >= box.x && x < box.x + box.width && y >= box.y && y < box.y + box.height)
        draw_tip(view, box, (int)x + 10, (int)y + 10, TIP_LINES, lines);
}

void view_draw_hover(lab_view *view, const lab_model *model, const lab_pointer *pointer) {
    const lab_box all = {0, 0, view->target.width, view->target.height};
    char lines[TIP_LINES][TIP_TEXT];
    if (!pointer->hovers || model->look.help)
        return;
    const lab_control *control = layout_control_at(&view->layout, pointer->at_x, pointer->at_y);
    const char *hint = control ? view_hint(control) : NULL;
    if (hint) {
        snprintf(lines[0], TIP_TEXT, "%s", hint);
        // Beside the panel, where it hides no other control.
        const lab_box panel = view->layout.panel;
        const bool in_panel = box_holds(panel, control->box.x, control->box.y);
        draw_tip(view, all, in_panel ? panel.x + panel.width + 6 : control->box.x + control->box.width + 6,
                 control->box.y, 1, lines);
    } else if (view_describe_plot(view, model, pointer->at_x, pointer->at_y, lines[0], TIP_TEXT)) {
        draw_tip(view, all, pointer->at_x + 12, pointer->at_y - 36, 1, lines);
    } else {
        return;
    }
    // It lies over gaps, too, which the next picture has to fill again.
    memset(view->filled, 0, sizeof view->filled);
}

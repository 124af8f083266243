/// @file view_panel.c
/// Buttons and sliders.
///
/// SPDX-License-Identifier: MIT
#include "lab/tint.h"
#include "lab/view.h"

static lab_colour colour_of_control(const lab_control *control) {
    return control->side_colour ? tint_of_side(control->side_colour - 1) : 0x8fb4e8;
}

static void draw_button(lab_view *view, const lab_control *control) {
    const lab_box box = control->box;
    const lab_colour lit = colour_of_control(control);
    raster_round(&view->target, box, box, 4, control->is_on ? colour_mix(TINT_BUTTON, lit, 170) : TINT_BUTTON, 256);
    text_draw(&view->target, box, &view->normal, box.x + box.width / 2, box.y + 15, TEXT_CENTRE,
              control->is_on ? TINT_WINDOW : TINT_TEXT, control->value[0] ? control->value : control->label);
}

static void draw_slider(lab_view *view, const lab_control *control) {
    const lab_box track = control_track(control);
    const lab_colour colour = colour_of_control(control);
    const int at = (int)(control_part(control) * (track.width - 1));
    const lab_box bar = {track.x, track.y + 1, track.width, 4};
    text_draw(&view->target, control->box, &view->normal, control->box.x, control->box.y + 14, TEXT_LEFT,
              TINT_FAINT, control->label);
    text_draw(&view->target, control->box, &view->normal, control->box.x + control->box.width, control->box.y + 14,
              TEXT_RIGHT, TINT_TEXT, control->value);
    raster_round(&view->target, bar, bar, 2, TINT_BUTTON, 256);
    raster_round(&view->target, bar, (lab_box){bar.x, bar.y, at > 4 ? at : 4, bar.height}, 2, colour, 190);
    const lab_box around = {track.x - 6, track.y - 4, track.width + 12, track.height + 8};
    const double x = track.x + at, clipped = x < track.x + 5                 ? track.x + 5
                                             : x > track.x + track.width - 5 ? track.x + track.width - 5
                                                                             : x;
    raster_ring(&view->target, around, clipped, track.y + 3, 0, 5, colour, 256);
}

void view_draw_panel(lab_view *view, const lab_model *model) {
    const lab_layout *layout = &view->layout;
    (void)model;
    if (layout->panel.width > 0)
        raster_round(&view->target, layout->panel, layout->panel, 6, TINT_PANEL, 256);
    for (int i = 0; i < layout->control_count; i++) {
        const lab_control *control = &layout->controls[i];
        if (control->kind == CONTROL_BUTTON)
            draw_button(view, control);
        else if (control->kind == CONTROL_SLIDER)
            draw_slider(view, control);
    }
}

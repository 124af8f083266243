/// @file layout.h
/// Where things are in the window: what the view draws and the mouse hits.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_LAYOUT_H
#define LAB_LAYOUT_H

#include "lab/model.h"

enum { LAYOUT_CONTROLS = 64, LAYOUT_LEAST_WIDTH = 480, LAYOUT_LEAST_HEIGHT = 320 };

typedef enum control_kind {
    CONTROL_LABEL,
    CONTROL_SLIDER, ///< moved by the mouse, or by its wheel
    CONTROL_BUTTON
} control_kind;

typedef struct lab_control {
    control_kind kind;
    lab_box box;
    const char *label;
    char value[32];    ///< what a slider stands at, as text; or a label that is made up
    lab_action action; ///< what a button does; a slider's, whose value is values[place]
    int place;
    double least, most, now; ///< of a slider
    double zero_below;       ///< a logarithmic slider's lowest end means 0
    bool logarithmic, whole;
    bool is_on;      ///< a button that is pressed
    int side_colour; ///< 0: none, 1: left, 2: right
} lab_control;

typedef struct lab_layout {
    int width, height;
    lab_box top, panel, plots, status;
    lab_box sides[2]; ///< each with its head
    lab_box views[2]; ///< what the networks are drawn in
    int side_count;
    lab_control controls[LAYOUT_CONTROLS];
    int control_count;
} lab_layout;

void layout_make(lab_layout *made, const lab_model *model, int width, int height);

/// The control at a place, or NULL.
const lab_control *layout_control_at(const lab_layout *layout, int x, int y);
/// The side at a place: 0, 1 or -1.
int layout_side_at(const lab_layout *layout, int x, int y);
/// Where a slider's knob is, 0 to 1; and the action that moves it there.
double control_part(const lab_control *slider);
lab_action control_action(const lab_control *slider, double part);
/// The part of the box in which a slider's knob moves.
lab_box control_track(const lab_control *slider);

#endif

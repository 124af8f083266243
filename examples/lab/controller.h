/// @file controller.h
/// Keys and mouse into actions.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_CONTROLLER_H
#define LAB_CONTROLLER_H

#include "lab/view.h"

typedef enum input_kind { INPUT_KEY, INPUT_KEY_UP, INPUT_PRESS, INPUT_RELEASE, INPUT_MOVE, INPUT_WHEEL } input_kind;
typedef enum input_button { BUTTON_LEFT = 1, BUTTON_MIDDLE = 2, BUTTON_RIGHT = 3 } input_button;

/// Keys that are no characters.
enum { KEY_F1 = 0x100, KEY_TAB = 9, KEY_ESCAPE = 27 };

typedef struct lab_input {
    input_kind kind;
    int key; ///< a small letter, a digit, a sign, or one of the above
    bool shift, control;
    int x, y; ///< of the mouse
    input_button button;
    int wheel; ///< > 0: up
} lab_input;

/// What is done with the actions.
typedef void (*perform_fn)(const lab_action *action, void *user);

typedef enum drag_kind { DRAG_NONE, DRAG_PULL, DRAG_CUT, DRAG_MOVE, DRAG_SLIDER } drag_kind;

typedef struct lab_controller {
    perform_fn perform;
    void *user;
    drag_kind drag;
    int side;                 ///< that the mouse works in
    int x, y;                 ///< of the mouse
    double from_x, from_y;    ///< world coordinates where it was pressed
    int pressed_x, pressed_y; ///< and pixels
    double radius;            ///< of the tool, pixels
    lab_control slider;       ///< that is dragged
    double gravity;           ///< to come back to
    bool cuts;                ///< the key for cutting is down
    bool quits;
    uint32_t files; ///< written so far
} lab_controller;

void controller_start(lab_controller *made, perform_fn perform, void *user);
void controller_take(lab_controller *controller, const lab_model *model, const lab_view *view,
                     const lab_input *input);
/// What to show of the mouse.
lab_pointer controller_pointer(const lab_controller *controller, const lab_model *model, const lab_view *view);

#endif

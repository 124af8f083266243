/// @file controller.c
/// What each key and each movement of the mouse means.
///
/// SPDX-License-Identifier: MIT
#include "lab/controller.h"
#include "lab/keys.h"
#include "lab/ready.h"
#include "lab/tint.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const key_help keys_help[] = {
    {"drag", "pull what is under the mouse"},
    {"click", "a spring: its strain, force and number"},
    {"X drag, shift drag", "cut springs with a line"},
    {"P", "pin, or let go of a pin"},
    {"B", "blast"},
    {"[ ]", "smaller, larger reach"},
    {"O", "probe here: its bending is measured"},
    {"G", "gravity on, off"},
    {"T", "the next solver, on this side"},
    {"tab", "one side, or two"},
    {"U, ctrl Z", "undo"},
    {"R", "start the scene again"},
    {"N", "next scene"},
    {"M", "more substeps, where a step is refused"},
    {"space", "pause, go on"},
    {".", "single step"},
    {"F", "fast: 2, 4, 8 steps a frame"},
    {"E", "go to equilibrium"},
    {"C, 1 to 7", "colours by strain, force, speed,"},
    {"", "island, row of the plan, material, bent"},
    {"wheel", "zoom; over a slider: change it"},
    {"right drag", "move the picture"},
    {"A", "see all"},
    {"L", "one above the other, side by side"},
    {"D, K", "plots, controls: show, hide"},
    {"W, V, Y", "write a picture, the plots as CSV, a script"},
    {"H, F1", "this help"},
    {"Q, escape", "quit"},
};
const int keys_help_count = sizeof keys_help / sizeof *keys_help;

void controller_start(lab_controller *made, perform_fn perform, void *user) {
    memset(made, 0, sizeof *made);
    made->perform = perform;
    made->user = user;
    made->radius = 12;
    made->gravity = 9.8;
}

static void perform(lab_controller *controller, action_kind kind, double a, double b, double c, double d) {
    const lab_action action = action_of(kind, a, b, c, d);
    controller->perform(&action, controller->user);
}

// Where the mouse is in the world; returns the scale, pixels per metre.
static double place(const lab_controller *controller, const lab_model *model, const lab_view *view, double *x,
                    double *y) {
    const lab_camera camera = view_camera(view, model, controller->side);
    camera_to_world(&camera, controller->x + 0.5, controller->y + 0.5, x, y);
    return camera.scale;
}

/* -------------------------------------------------------------------------------------------------------- keys */

static void toggle_pin(lab_controller *controller, const lab_model *model, double x, double y, double radius) {
    const lab_side *side = &model->sides[controller->side];
    const bool pinned = side_is_pinned(side, side_nearest(side, x, y));
    perform(controller, pinned ? ACTION_UNPIN : ACTION_PIN, x, y, radius, 0);
}

static void blast(lab_controller *controller, double x, double y, double radius) {
    perform(controller, ACTION_BLAST, x, y, 3 * radius, 60);
}

// As many substeps as the library wants on the sides that stand still.
static void cure(lab_controller *controller, const lab_model *model) {
    for (int i = 0; i < model->side_count; i++)
        if (model->sides[i].complaint[0] && model->sides[i].cure > 0 && model->sides[i].cure <= 1000)
            perform(controller, ACTION_SUBSTEPS, 1 << i, model->sides[i].cure, 0, 0);
}

static void next_scene(lab_controller *controller, const lab_model *model) {
    int next = 0;
    for (int i = 0; i < READY_COUNT; i++)
        if (strcmp(model->scene_name, ready_scenes[i].name) == 0)
            next = (i + 1) % READY_COUNT;
    const lab_action action = action_of_text(ACTION_SCENE, ready_scenes[next].name);
    controller->perform(&action, controller->user);
}

static void write_file(lab_controller *controller, action_kind kind) {
    char name[32];
    snprintf(name, sizeof name, "lab_%03u", controller->files++);
    const lab_action action = action_of_text(kind, name);
    controller->perform(&action, controller->user);
}

static void toggle_gravity(lab_controller *controller, const lab_model *model) {
    const double now = model->settings.gravity;
    if (now != 0)
        controller->gravity = now;
    perform(controller, ACTION_GRAVITY, now != 0 ? 0 : controller->gravity, 0, 0, 0);
}

static void press_key(lab_controller *controller, const lab_model *model, const lab_view *view,
                      const lab_input *input) {
    const lab_look *look = &model->look;
    double x, y;
    const double radius = controller->radius / place(controller, model, view, &x, &y);
    const lab_solver *solver = &model->solvers[controller->side];
    if (input->key >= '1' && input->key < '1' + COLOUR_CHOICES) {
        perform(controller, ACTION_COLOUR, input->key - '1', 0, 0, 0);
        return;
    }
    switch (input->key) {
    case ' ':
        perform(controller, model->playing ? ACTION_PAUSE : ACTION_PLAY, 0, 0, 0, 0);
        break;
    case '.':
        perform(controller, ACTION_STEP, 1, 0, 0, 0);
        break;
    case '[':
        controller->radius = fmax(controller->radius / 1.3, 3);
        break;
    case ']':
        controller->radius = fmin(controller->radius * 1.3, 200);
        break;
    case 'a':
        perform(controller, ACTION_FIT, 0, 0, 0, 0);
        break;
    case 'b':
        blast(controller, x, y, radius);
        break;
    case 'c':
        perform(controller, ACTION_COLOUR, (look->colour + 1) % COLOUR_CHOICES, 0, 0, 0);
        break;
    case 'd':
        perform(controller, ACTION_PLOTS, !look->plots, 0, 0, 0);
        break;
    case 'e':
        perform(controller, ACTION_SETTLE, 0, 0, 0, 0);
        break;
    case 'f':
        perform(controller, ACTION_SPEED, model->speed >= 8 ? 1 : 2 * model->speed, 0, 0, 0);
        break;
    case 'g':
        toggle_gravity(controller, model);
        break;
    case 'h':
    case KEY_F1:
        perform(controller, ACTION_HELP, !look->help, 0, 0, 0);
        break;
    case 'k':
        perform(controller, ACTION_PANEL, !look->panel, 0, 0, 0);
        break;
    case 'l':
        perform(controller, ACTION_LAYOUT, (look->layout + 1) % 3, 0, 0, 0);
        break;
    case 'm':
        cure(controller, model);
        break;
    case 'n':
        next_scene(controller, model);
        break;
    case 'o':
        perform(controller, ACTION_PROBE, x, y, 0, 0);
        break;
    case 'p':
        toggle_pin(controller, model, x, y, radius);
        break;
    case 'r':
        perform(controller, ACTION_RESET, 0, 0, 0, 0);
        break;
    case 't':
        perform(controller, ACTION_SOLVER, 1 << controller->side, (solver->solver + 1) % 3, 0, 0);
        break;
    case KEY_TAB:
        perform(controller, ACTION_SIDES, model->side_count == 1 ? 2 : 1, 0, 0, 0);
        break;
    case 'u':
        perform(controller, ACTION_UNDO, 0, 0, 0, 0);
        break;
    case 'w':
        write_file(controller, ACTION_SCREENSHOT);
        break;
    case 'v':
        write_file(controller, ACTION_TABLE);
        break;
    case 'y':
        write_file(controller, ACTION_RECORDING);
        break;
    case 'x':
        controller->cuts = true;
        break;
    case 'z':
        if (input->control)
            perform(controller, ACTION_UNDO, 0, 0, 0, 0);
        break;
    case 'q':
        controller->quits = true;
        break;
    case KEY_ESCAPE:
        if (look->help)
            perform(controller, ACTION_HELP, 0, 0, 0, 0);
        else
            controller->quits = true;
        break;
    default:
        break;
    }
}

/* ------------------------------------------------------------------------------------------------------- mouse */

// Pixels that a click may move, and how far from a spring it finds it.
enum { CLICK_REACH = 3, SPRING_REACH = 10 };

static void move_slider(lab_controller *controller) {
    const lab_box track = control_track(&controller->slider);
    const lab_action action =
        control_action(&controller->slider, (controller->x - track.x) / (double)(track.width - 1));
    controller->perform(&action, controller->user);
}

static void press_control(lab_controller *controller, const lab_control *control) {
    if (control->kind == CONTROL_BUTTON && control->action.kind >= ACTION_SCREENSHOT &&
        control->action.kind <= ACTION_RECORDING) {
        write_file(controller, control->action.kind);
        return;
    }
    if (control->kind == CONTROL_BUTTON) {
        controller->perform(&control->action, controller->user);
        return;
    }
    controller->slider = *control;
    controller->drag = DRAG_SLIDER;
    move_slider(controller);
}

static void press(lab_controller *controller, const lab_model *model, const lab_view *view,
                  const lab_input *input) {
    const lab_control *control = layout_control_at(&view->layout, input->x, input->y);
    if (control && input->button == BUTTON_LEFT) {
        press_control(controller, control);
        return;
    }
    if (layout_side_at(&view->layout, input->x, input->y) < 0)
        return;
    const double scale = place(controller, model, view, &controller->from_x, &controller->from_y);
    if (input->button != BUTTON_LEFT) {
        controller->drag = DRAG_MOVE;
    } else if (controller->cuts || input->shift || model->look.tool == TOOL_CUT) {
        controller->drag = DRAG_CUT;
    } else if (model->look.tool == TOOL_PIN) {
        toggle_pin(controller, model, controller->from_x, controller->from_y, controller->radius / scale);
    } else if (model->look.tool == TOOL_BLAST) {
        blast(controller, controller->from_x, controller->from_y, controller->radius / scale);
    } else {
        controller->drag = DRAG_PULL;
        controller->pressed_x = input->x;
        controller->pressed_y = input->y;
        perform(controller, ACTION_GRAB, controller->from_x, controller->from_y, controller->radius / scale, 0);
    }
}

static void move(lab_controller *controller, const lab_model *model, const lab_view *view) {
    double x, y;
    if (controller->drag == DRAG_NONE)
        return;
    const double scale = place(controller, model, view, &x, &y);
    if (controller->drag == DRAG_SLIDER) {
        move_slider(controller);
    } else if (controller->drag == DRAG_PULL) {
        perform(controller, ACTION_PULL, x, y, 0, 0);
    } else if (controller->drag == DRAG_MOVE) {
        const lab_camera camera = view_camera(view, model, controller->side);
        perform(controller, ACTION_CAMERA, camera.x + controller->from_x - x, camera.y + controller->from_y - y,
                view->layout.views[controller->side].width / scale, 0);
    }
}

static void release(lab_controller *controller, const lab_model *model, const lab_view *view) {
    double x, y;
    const double scale = place(controller, model, view, &x, &y);
    if (controller->drag == DRAG_PULL) {
        perform(controller, ACTION_DROP, 0, 0, 0, 0);
        // A click that has moved nothing asks for the spring; one beside all springs for none.
        if (hypot(controller->x - controller->pressed_x, controller->y - controller->pressed_y) < CLICK_REACH)
            perform(controller, ACTION_SPRING, 1 << controller->side, x, y, SPRING_REACH / scale);
    }
    if (controller->drag == DRAG_CUT)
        perform(controller, ACTION_CUT, controller->from_x, controller->from_y, x, y);
    controller->drag = DRAG_NONE;
}

// Zooms about the mouse, or moves the slider under it.
static void turn_wheel(lab_controller *controller, const lab_model *model, const lab_view *view, int wheel) {
    const lab_control *control = layout_control_at(&view->layout, controller->x, controller->y);
    if (control && control->kind == CONTROL_SLIDER) {
        const lab_action action = control_action(control, control_part(control) + 0.02 * wheel);
        controller->perform(&action, controller->user);
        return;
    }
    if (layout_side_at(&view->layout, controller->x, controller->y) < 0)
        return;
    double x, y;
    const double scale = place(controller, model, view, &x, &y), factor = pow(1.15, wheel);
    const lab_camera camera = view_camera(view, model, controller->side);
    perform(controller, ACTION_CAMERA, x + (camera.x - x) / factor, y + (camera.y - y) / factor,
            view->layout.views[controller->side].width / (scale * factor), 0);
}

void controller_take(lab_controller *controller, const lab_model *model, const lab_view *view,
                     const lab_input *input) {
    if (input->kind != INPUT_KEY && input->kind != INPUT_KEY_UP) {
        controller->x = input->x;
        controller->y = input->y;
        const int side = layout_side_at(&view->layout, input->x, input->y);
        if (controller->drag == DRAG_NONE && side >= 0)
            controller->side = side;
    }
    if (controller->side >= model->side_count)
        controller->side = 0;
    switch (input->kind) {
    case INPUT_KEY:
        press_key(controller, model, view, input);
        break;
    case INPUT_KEY_UP:
        if (input->key == 'x')
            controller->cuts = false;
        break;
    case INPUT_PRESS:
        if (controller->drag == DRAG_NONE)
            press(controller, model, view, input);
        break;
    case INPUT_RELEASE:
        release(controller, model, view);
        break;
    case INPUT_MOVE:
        move(controller, model, view);
        break;
    default:
        turn_wheel(controller, model, view, input->wheel);
        break;
    }
}

lab_pointer controller_pointer(const lab_controller *controller, const lab_model *model, const lab_view *view) {
    lab_pointer made = {.kind = POINTER_NONE,
                        .hovers = controller->drag == DRAG_NONE,
                        .at_x = controller->x,
                        .at_y = controller->y};
    if (controller->side >= model->side_count)
        return made;
    const double scale = place(controller, model, view, &made.x2, &made.y2);
    if (controller->drag == DRAG_CUT) {
        made.kind = POINTER_CUT;
        made.colour = TINT_WARNING;
        made.x = controller->from_x;
        made.y = controller->from_y;
    } else if (controller->drag == DRAG_NONE && layout_side_at(&view->layout, controller->x, controller->y) >= 0) {
        made.kind = POINTER_CIRCLE;
        made.colour = controller->cuts || model->look.tool == TOOL_CUT ? TINT_WARNING : 0xffffff;
        made.x = made.x2;
        made.y = made.y2;
        made.radius = controller->radius / scale;
    }
    return made;
}

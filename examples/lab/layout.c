/// @file layout.c
/// Boxes for bars, views and controls.
///
/// SPDX-License-Identifier: MIT
#include "lab/layout.h"
#include "lab/ready.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum {
    TOP = 36,
    STATUS = 24,
    PANEL = 212,
    PLOTS = 116,
    GAP = 8,
    HEAD = 26,
    BUTTON = 22,
    SLIDER = 31,
};

/* ---------------------------------------------------------------------------------------------------- controls */

// Controls are put one below the other.
typedef struct control_stack {
    lab_layout *layout;
    int x, y, width, bottom;
} control_stack;

static lab_control *add(control_stack *stack, control_kind kind, int height, const char *label) {
    lab_layout *layout = stack->layout;
    if (layout->control_count == LAYOUT_CONTROLS || stack->y + height > stack->bottom)
        return NULL;
    lab_control *made = &layout->controls[layout->control_count++];
    memset(made, 0, sizeof *made);
    made->kind = kind;
    made->label = label;
    made->box = (lab_box){stack->x, stack->y, stack->width, height};
    stack->y += height;
    return made;
}

// A row of buttons of equal width, of which the first ones are made. Returns the first, or NULL if there is no
// room.
static lab_control *add_buttons(control_stack *stack, int count, const char *const labels[]) {
    lab_layout *layout = stack->layout;
    if (layout->control_count + count > LAYOUT_CONTROLS || stack->y + BUTTON > stack->bottom)
        return NULL;
    lab_control *first = &layout->controls[layout->control_count];
    const int gap = 4, width = (stack->width - gap * (count - 1)) / count, top = stack->y;
    for (int i = 0; i < count; i++) {
        stack->y = top;
        lab_control *made = add(stack, CONTROL_BUTTON, BUTTON, labels[i]);
        made->box.x += i * (width + gap);
        made->box.width = i == count - 1 ? stack->width - i * (width + gap) : width;
    }
    stack->y += 4;
    return first;
}

static void add_slider(control_stack *stack, const char *label, lab_action action, int place, double least,
                       double most, bool logarithmic, const char *format, ...) {
    lab_control *made = add(stack, CONTROL_SLIDER, SLIDER, label);
    if (!made)
        return;
    made->action = action;
    made->place = place;
    made->least = least;
    made->most = most;
    made->now = action.values[place];
    made->logarithmic = logarithmic;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(made->value, sizeof made->value, format, arguments);
    va_end(arguments);
}

static lab_action number(action_kind kind, double value) {
    return action_of(kind, value, 0, 0, 0);
}

static void add_playing(control_stack *stack, const lab_model *model) {
    static const char *const scene_labels[] = {"<", "", ">"};
    static const char *const play_labels[] = {"pause", "undo", "reset"};
    static const char *const step_labels[] = {"single step", "settle"};
    lab_control *which = add_buttons(stack, 3, scene_labels);
    if (!which)
        return;
    int now = -1;
    for (int i = 0; i < READY_COUNT; i++)
        if (strcmp(model->scene_name, ready_scenes[i].name) == 0)
            now = i;
    const int before = now < 0 ? 0 : (now + READY_COUNT - 1) % READY_COUNT;
    which[0].box.width = which[2].box.width = 30;
    which[1].box.x = which[0].box.x + 34;
    which[1].box.width = stack->width - 68;
    which[2].box.x = which[1].box.x + which[1].box.width + 4;
    which[0].action = action_of_text(ACTION_SCENE, ready_scenes[before].name);
    which[2].action = action_of_text(ACTION_SCENE, ready_scenes[(now + 1) % READY_COUNT].name);
    snprintf(which[1].value, sizeof which[1].value, "%.26s ...", model->stage.made.name);
    which[1].action = number(ACTION_SCENES, 1);
    lab_control *play = add_buttons(stack, 3, play_labels), *step = add_buttons(stack, 2, step_labels);
    if (!play || !step)
        return;
    play[0].label = model->playing ? "pause" : "play";
    play[0].is_on = !model->playing;
    play[0].action = number(model->playing ? ACTION_PAUSE : ACTION_PLAY, 0);
    play[1].action = number(ACTION_UNDO, 0);
    play[2].action = number(ACTION_RESET, 0);
    step[0].action = number(ACTION_STEP, 1);
    step[1].action = number(ACTION_SETTLE, 0);
}

// The list of scenes stands in place of the controls, until one is chosen.
static void add_scenes(control_stack *stack, const lab_model *model) {
    static const char *const back[] = {"back"};
    for (int i = 0; i < READY_COUNT; i++) {
        lab_control *one = add_buttons(stack, 1, &ready_scenes[i].name);
        if (!one)
            return;
        one->is_on = strcmp(model->scene_name, ready_scenes[i].name) == 0;
        one->action = action_of_text(ACTION_SCENE, ready_scenes[i].name);
    }
    stack->y += 6;
    lab_control *last = add_buttons(stack, 1, back);
    if (last)
        last->action = number(ACTION_SCENES, 0);
}

// Pictures, tables and scripts, written where pictures go.
static void add_files(control_stack *stack) {
    static const char *const labels[] = {"picture", "table", "script"};
    lab_control *file = add_buttons(stack, 3, labels);
    for (int i = 0; file && i < 3; i++)
        file[i].action.kind = (action_kind)(ACTION_SCREENSHOT + i);
}

// What the left button of the mouse does.
static void add_tools(control_stack *stack, const lab_model *model) {
    static const char *const labels[TOOL_CHOICES] = {"pull", "cut", "pin", "blast"};
    lab_control *tool = add_buttons(stack, TOOL_CHOICES, labels);
    for (int i = 0; tool && i < TOOL_CHOICES; i++) {
        tool[i].is_on = (int)model->look.tool == i;
        tool[i].action = number(ACTION_TOOL, i);
    }
}

static void add_physics(control_stack *stack, const lab_model *model) {
    const lab_settings *now = &model->settings;
    add_slider(stack, "gravity", number(ACTION_GRAVITY, now->gravity), 0, 0, 30, false, "%.1f m/s^2", now->gravity);
    add_slider(stack, "mass", number(ACTION_MASS, now->mass), 0, 0.1, 10, true, "x %.2f", now->mass);
    if (model->stage.relative)
        add_slider(stack, "stiffness", number(ACTION_STIFFNESS, now->stiffness), 0, 0.002, 2, true, "%.3f of limit",
                   0.5 * now->stiffness);
    else
        add_slider(stack, "stiffness", number(ACTION_STIFFNESS, now->stiffness), 0, 0.001, 1000, true, "x %.3g",
                   now->stiffness);
    add_slider(stack, "damping", number(ACTION_DAMPING, now->damping), 0, 0, 10, false, "x %.2f", now->damping);
    add_slider(stack, "drag", number(ACTION_DRAG, now->drag), 0, 0, 4, false, "%.2f /s", now->drag);
    add_slider(stack, "time step", number(ACTION_DT, now->dt), 0, 1.0 / 512, 1.0 / 8, true, "%.2f ms",
               1e3 * now->dt);
}

static void add_toggles(control_stack *stack, const lab_model *model) {
    const lab_settings *now = &model->settings;
    const struct {
        const char *labels[3];
        int count;
        bool is_on[3];
        action_kind kinds[3];
    } rows[2] = {{{"breaking", "yielding", "relative"},
                  3,
                  {now->breaking, now->yielding, model->stage.relative},
                  {ACTION_BREAKING, ACTION_YIELDING, ACTION_RELATIVE}},
                 {{"floor", "collide"}, 2, {now->has_floor, now->collides}, {ACTION_FLOOR, ACTION_COLLIDE}}};
    for (int row = 0; row < 2; row++) {
        lab_control *toggle = add_buttons(stack, rows[row].count, rows[row].labels);
        for (int i = 0; toggle && i < rows[row].count; i++) {
            toggle[i].is_on = rows[row].is_on[i];
            toggle[i].action = number(rows[row].kinds[i], !rows[row].is_on[i]);
        }
    }
}

static void add_solver(control_stack *stack, const lab_model *model, int side) {
    static const char *const labels[] = {"explicit", "implicit", "direct"};
    const lab_solver *now = &model->solvers[side];
    const int bit = 1 << side;
    stack->y += 6;
    lab_control *solver = add_buttons(stack, 3, labels);
    if (!solver)
        return;
    for (int i = 0; i < 3; i++) {
        solver[i].is_on = now->solver == i;
        solver[i].action = action_of(ACTION_SOLVER, bit, i, 0, 0);
        solver[i].side_colour = side + 1;
    }
    const uint32_t substeps = now->substeps;
    if (substeps)
        add_slider(stack, "substeps", action_of(ACTION_SUBSTEPS, bit, substeps, 0, 0), 1, 1, 200, true, "%u",
                   substeps);
    else
        add_slider(stack, "substeps", action_of(ACTION_SUBSTEPS, bit, 1, 0, 0), 1, 1, 200, true, "auto");
    stack->layout->controls[stack->layout->control_count - 1].side_colour = side + 1;
    if (now->solver == MSPRING_SOLVER_IMPLICIT)
        add_slider(stack, "iterations", action_of(ACTION_ITERATIONS, bit, now->iterations, 0, 0), 1, 1, 64, true,
                   "%u", now->iterations);
    stack->layout->controls[stack->layout->control_count - 1].side_colour = side + 1;
}

static void add_colours(control_stack *stack, const lab_model *model) {
    static const char *const labels[2][4] = {{"strain", "force", "speed", "bent"}, {"island", "plan", "material"}};
    static const int counts[2] = {4, 3};
    static const colour_choice choices[2][4] = {{COLOUR_STRAIN, COLOUR_FORCE, COLOUR_SPEED, COLOUR_BENT},
                                                {COLOUR_ISLAND, COLOUR_PLAN, COLOUR_MATERIAL}};
    stack->y += 6;
    for (int row = 0; row < 2; row++) {
        lab_control *colour = add_buttons(stack, counts[row], labels[row]);
        for (int i = 0; colour && i < counts[row]; i++) {
            colour[i].is_on = model->look.colour == choices[row][i];
            colour[i].action = number(ACTION_COLOUR, choices[row][i]);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------- boxes */

static double fit(double width, double height, const lab_stage *stage) {
    const double across = stage->max_x - stage->min_x + stage->spacing;
    const double up = stage->max_y - stage->min_y + stage->spacing;
    return fmin(width / across, height / up);
}

static void place_sides(lab_layout *made, const lab_model *model, lab_box area) {
    made->side_count = model->side_count;
    made->sides[0] = area;
    if (model->side_count == 2) {
        const int width = (area.width - GAP) / 2, height = (area.height - GAP) / 2;
        bool rows = fit(area.width, height - HEAD, &model->stage) > fit(width, area.height - HEAD, &model->stage);
        if (model->look.layout != LAYOUT_AUTO)
            rows = model->look.layout == LAYOUT_ROWS;
        made->sides[0] =
            rows ? (lab_box){area.x, area.y, area.width, height} : (lab_box){area.x, area.y, width, area.height};
        made->sides[1] = rows ? (lab_box){area.x, area.y + height + GAP, area.width, area.height - height - GAP}
                              : (lab_box){area.x + width + GAP, area.y, area.width - width - GAP, area.height};
    }
    for (int i = 0; i < model->side_count; i++) {
        const lab_box side = made->sides[i];
        made->views[i] = (lab_box){side.x, side.y + HEAD, side.width, side.height - HEAD};
    }
}

// Beside a step that was refused: what lets it go on.
static void add_cures(lab_layout *made, const lab_model *model) {
    enum { WIDTH = 180, ABOVE = 94, LEAST_HEIGHT = 116 };
    for (int i = 0; i < model->side_count; i++) {
        const lab_side *side = &model->sides[i];
        const lab_box view = made->views[i];
        if (!side->complaint[0] || side->cure == 0 || side->cure > 1000 || side->cure <= side->substeps ||
            view.height < LEAST_HEIGHT || view.width < 2 * WIDTH)
            continue;
        control_stack stack = {made, view.x + 12, view.y + view.height - ABOVE - BUTTON, WIDTH,
                               view.y + view.height};
        lab_control *cure = add(&stack, CONTROL_BUTTON, BUTTON, "");
        if (!cure)
            return;
        snprintf(cure->value, sizeof cure->value, "more substeps: %u", side->cure);
        cure->is_on = true;
        cure->side_colour = i + 1;
        cure->action = action_of(ACTION_SUBSTEPS, 1 << i, side->cure, 0, 0);
    }
}

// All controls one below the other; or, in a low window, on two pages.
static void add_controls(control_stack *stack, const lab_model *model) {
    enum { WHOLE = 636 };
    static const char *const labels[2] = {"play", "settings"};
    if (model->look.scenes) {
        add_scenes(stack, model);
        return;
    }
    const bool has_pages = stack->bottom - stack->y < WHOLE;
    lab_control *pages = has_pages ? add_buttons(stack, 2, labels) : NULL;
    for (int i = 0; pages && i < 2; i++) {
        pages[i].is_on = model->look.page == i;
        pages[i].action = number(ACTION_PAGE, i + 1);
    }
    if (!has_pages || model->look.page == 0) {
        add_playing(stack, model);
        add_tools(stack, model);
        add_toggles(stack, model);
    }
    if (has_pages && model->look.page == 0) {
        add_colours(stack, model);
        add_files(stack);
        return;
    }
    add_physics(stack, model);
    for (int i = 0; i < model->side_count; i++)
        add_solver(stack, model, i);
    if (has_pages)
        return;
    add_colours(stack, model);
    add_files(stack);
}

void layout_make(lab_layout *made, const lab_model *model, int width, int height) {
    memset(made, 0, sizeof *made);
    made->width = width;
    made->height = height;
    made->top = (lab_box){0, 0, width, TOP};
    made->status = (lab_box){0, height - STATUS, width, STATUS};
    lab_box rest = {GAP, TOP, width - 2 * GAP, height - TOP - STATUS};
    // What shows the networks comes first, where there is little room.
    if (model->look.panel && width >= 3 * PANEL) {
        made->panel = (lab_box){GAP, TOP, PANEL, rest.height};
        rest.x += PANEL + GAP;
        rest.width -= PANEL + GAP;
    }
    if (model->look.plots && rest.height >= 3 * PLOTS) {
        made->plots = (lab_box){rest.x, rest.y + rest.height - PLOTS, rest.width, PLOTS};
        rest.height -= PLOTS + GAP;
    }
    place_sides(made, model, rest);
    add_cures(made, model);
    if (made->panel.width == 0)
        return;
    control_stack stack = {made, made->panel.x + 10, made->panel.y + 10, made->panel.width - 20,
                           made->panel.y + made->panel.height - 6};
    add_controls(&stack, model);
}

const lab_control *layout_control_at(const lab_layout *layout, int x, int y) {
    for (int i = 0; i < layout->control_count; i++)
        if (layout->controls[i].kind != CONTROL_LABEL && box_holds(layout->controls[i].box, x, y))
            return &layout->controls[i];
    return NULL;
}

int layout_side_at(const lab_layout *layout, int x, int y) {
    for (int i = 0; i < layout->side_count; i++)
        if (box_holds(layout->views[i], x, y))
            return i;
    return -1;
}

double control_part(const lab_control *slider) {
    const double now = fmin(fmax(slider->now, slider->least), slider->most);
    return slider->logarithmic ? log(now / slider->least) / log(slider->most / slider->least)
                               : (now - slider->least) / (slider->most - slider->least);
}

lab_action control_action(const lab_control *slider, double part) {
    lab_action made = slider->action;
    part = fmin(fmax(part, 0), 1);
    const double value = slider->logarithmic ? slider->least * pow(slider->most / slider->least, part)
                                             : slider->least + part * (slider->most - slider->least);
    // Three digits: a script can be read, and 1 can be hit.
    const double digit = pow(10, floor(log10(fmax(fabs(value), 1e-9))) - 2);
    made.values[slider->place] = fmin(fmax(floor(value / digit + 0.5) * digit, slider->least), slider->most);
    if (slider->logarithmic && fabs(log(value)) < 0.02 * log(slider->most / slider->least))
        made.values[slider->place] = 1;
    return action_rounded(&made);
}

lab_box control_track(const lab_control *slider) {
    return (lab_box){slider->box.x, slider->box.y + 20, slider->box.width, 6};
}

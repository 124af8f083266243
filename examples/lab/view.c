/// @file view.c
/// The parts of the picture, put together.
///
/// SPDX-License-Identifier: MIT
#include "lab/view.h"
#include "draw/colour_scale.h"
#include "lab/tint.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool view_make(lab_view *made, int width, int height) {
    memset(made, 0, sizeof *made);
    made->shows_costs = true;
    if (raster_make(&made->target, width, height) && font_make(&made->small, 8) && font_make(&made->normal, 9) &&
        font_make(&made->large, 13))
        return true;
    view_free(made);
    return false;
}

static void free_side(view_side *kept) {
    free(kept->x);
    free(kept->y);
    free(kept->tint);
    free(kept->extreme);
    free(kept->number);
    free(kept->behind);
    layer_free(&kept->layer);
    memset(kept, 0, sizeof *kept);
}

void view_free(lab_view *unwanted) {
    raster_free(&unwanted->target);
    font_free(&unwanted->small);
    font_free(&unwanted->normal);
    font_free(&unwanted->large);
    for (int i = 0; i < 2; i++)
        free_side(&unwanted->sides[i]);
}

bool view_resize(lab_view *view, int width, int height) {
    lab_raster made;
    if (!raster_make(&made, width, height))
        return false;
    raster_free(&view->target);
    view->target = made;
    memset(view->filled, 0, sizeof view->filled);
    return true;
}

const char *view_number(double value, char buffer[32]) {
    static const char *const prefixes[] = {"", "k", "M", "G", "T"};
    int thousand = 0;
    double shown = value;
    while (fabs(shown) >= 999.5 && thousand < 4) {
        shown /= 1000;
        thousand++;
    }
    const double size = fabs(shown);
    const int decimals = size >= 99.5 || size == 0 ? 0 : size >= 9.95 ? 1 : size >= 0.0995 ? 2 : 3;
    if (size > 0 && size < 5e-4)
        snprintf(buffer, 32, "%.1e ", shown);
    else
        snprintf(buffer, 32, "%.*f %s", decimals, shown, prefixes[thousand]);
    return buffer;
}

// A whole number with its thousands set apart.
static const char *whole_number(uint32_t value, char buffer[32]) {
    if (value < 1000)
        snprintf(buffer, 32, "%u", value);
    else if (value < 1000000)
        snprintf(buffer, 32, "%u,%03u", value / 1000, value % 1000);
    else
        snprintf(buffer, 32, "%u,%03u,%03u", value / 1000000, value / 1000 % 1000, value % 1000);
    return buffer;
}

/* ------------------------------------------------------------------------------------------------------ camera */

void camera_to_world(const lab_camera *camera, double pixel_x, double pixel_y, double *x, double *y) {
    *x = camera->x + (pixel_x - camera->pixel_x) / camera->scale;
    *y = camera->y - (pixel_y - camera->pixel_y) / camera->scale;
}

void camera_to_pixel(const lab_camera *camera, double x, double y, double *pixel_x, double *pixel_y) {
    *pixel_x = camera->pixel_x + (x - camera->x) * camera->scale;
    *pixel_y = camera->pixel_y - (y - camera->y) * camera->scale;
}

lab_camera view_camera(const lab_view *view, const lab_model *model, int side) {
    const lab_box box = view->layout.views[side];
    const lab_look *look = &model->look;
    lab_camera made = {.pixel_x = box.x + 0.5 * box.width, .pixel_y = box.y + 0.5 * box.height};
    if (look->metres > 0) {
        made.scale = box.width / look->metres;
        made.x = look->x;
        made.y = look->y;
        return made;
    }
    const double margin = 2 * model->stage.spacing;
    const double across = view->max_x - view->min_x + margin, up = view->max_y - view->min_y + margin;
    made.scale = fmin((box.width - 40) / across, (box.height - 32) / up);
    made.scale = made.scale > 1e-9 ? made.scale : 1e-9;
    made.x = 0.5 * (view->min_x + view->max_x);
    made.y = 0.5 * (view->min_y + view->max_y);
    return made;
}

// Lets the camera that sees everything see what has moved, but for what flies far away.
static void see(lab_view *view, const lab_model *model) {
    const lab_stage *stage = &model->stage;
    const double reach = 0.5 * fmax(stage->max_x - stage->min_x, stage->max_y - stage->min_y);
    if (view->seen != model->sides[0].network || model->look.metres > 0) {
        view->seen = model->sides[0].network;
        view->min_x = stage->min_x;
        view->min_y = stage->min_y;
        view->max_x = stage->max_x;
        view->max_y = stage->max_y;
    }
    for (int i = 0; i < model->side_count; i++) {
        const lab_measures *now = &model->sides[i].measured;
        view->min_x = fmin(view->min_x, fmax(now->min_x, stage->min_x - reach));
        view->min_y = fmin(view->min_y, fmax(now->min_y, stage->min_y - reach));
        view->max_x = fmax(view->max_x, fmin(now->max_x, stage->max_x + reach));
        view->max_y = fmax(view->max_y, fmin(now->max_y, stage->max_y + reach));
    }
}

/* ------------------------------------------------------------------------------------------------------- scales */

// The end of a scale: a round number above what is wanted; it comes down only when far too large.
static void adapt(double *limit, double wanted) {
    if (!(wanted > 1e-12))
        wanted = 1e-12;
    if (*limit < wanted || *limit > 8 * wanted)
        *limit = colour_scale_round_up(wanted);
}

static double mean_stiffness(const lab_model *model) {
    const uint32_t middle = model->stage.spring_count / 2;
    return model->stage.spring_count ? side_spring_stiffness(&model->sides[0], &model->settings, middle) : 1;
}

static bool now_is_bent(const lab_model *model, int side) {
    return model->look.colour == COLOUR_BENT && model->sides[side].bent_count > 0;
}

static void adapt_scales(lab_view *view, const lab_model *model) {
    double strain = 0, speed = 0, mass = 0, squares = 0, count = 0;
    for (uint32_t i = 0; i < model->stage.particle_count; i++)
        mass += model->stage.mass[i];
    for (int i = 0; i < model->side_count; i++) {
        const lab_measures *now = &model->sides[i].measured;
        // Only what all sides can be compared by: one that explodes does not take the colours from the other.
        const double here = 5 * now->rms_strain;
        strain = i == 0 || here < strain ? here : strain;
        for (uint32_t s = 0; now_is_bent(model, i) && s < model->stage.spring_count; s++)
            squares += pow(model->sides[i].plastic[s], 2), count++;
        speed = fmax(speed, 2.5 * sqrt(2 * now->kinetic / (mass * model->settings.mass)));
    }
    adapt(&view->limit[0], fmax(strain, 1e-4));
    adapt(&view->limit[1], fmax(strain, 1e-4) * mean_stiffness(model) * model->stage.spacing);
    adapt(&view->bent_limit, fmax(5 * sqrt(squares / fmax(count, 1)), 0.02));
    adapt(&view->speed_limit, fmax(speed, 0.05));
}

static bool make_room(lab_view *view, const lab_model *model) {
    const uint32_t count = model->stage.particle_count;
    if (count <= view->capacity)
        return true;
    view->capacity = 0;
    for (int i = 0; i < 2; i++) {
        view_side *kept = &view->sides[i];
        free_side(kept);
        kept->x = malloc(count * sizeof *kept->x);
        kept->y = malloc(count * sizeof *kept->y);
        kept->tint = malloc(count * sizeof *kept->tint);
        kept->extreme = malloc(count * sizeof *kept->extreme);
        kept->number = malloc(count * sizeof *kept->number);
        if (!kept->x || !kept->y || !kept->tint || !kept->extreme || !kept->number)
            return false;
    }
    view->capacity = count;
    return true;
}

// What no part covers, and what lies behind the rounded ones.
static void fill_behind(lab_view *view) {
    const lab_layout *layout = &view->layout;
    const lab_box boxes[] = {layout->panel, layout->plots, layout->sides[0], layout->sides[1]};
    const lab_box all = {0, 0, layout->width, layout->height};
    if (memcmp(boxes, view->filled, sizeof boxes) != 0) {
        memcpy(view->filled, boxes, sizeof boxes);
        raster_fill(&view->target, all, all, TINT_WINDOW, 256);
    }
    raster_fill(&view->target, all, layout->panel, TINT_WINDOW, 256);
    raster_fill(&view->target, all, layout->plots, TINT_WINDOW, 256);
}

bool view_begin(lab_view *view, const lab_model *model) {
    layout_make(&view->layout, model, view->target.width, view->target.height);
    see(view, model);
    adapt_scales(view, model);
    fill_behind(view);
    return make_room(view, model);
}

/* -------------------------------------------------------------------------------------------------------- sides */

static void describe_solver(const lab_side *side, bool in_short, char *text, size_t size) {
    static const char *const integrators[] = {"ga0", "bdf2", "Euler"};
    const uint32_t substeps = side->substeps;
    if (in_short)
        snprintf(text, size, "%u substep%s", substeps, substeps == 1 ? "" : "s");
    else if (side->solver.solver == MSPRING_SOLVER_EXPLICIT)
        snprintf(text, size, "%u substep%s%s", substeps, substeps == 1 ? "" : "s",
                 side->solver.substeps ? "" : ", chosen by the library");
    else if (side->solver.solver == MSPRING_SOLVER_DIRECT)
        snprintf(text, size, "%s, %u substep%s", integrators[side->solver.integrator], substeps,
                 substeps == 1 ? "" : "s");
    else
        snprintf(text, size, "%s, %u substep%s of %u iterations", integrators[side->solver.integrator], substeps,
                 substeps == 1 ? "" : "s", side->solver.iterations);
}

// A figure that ends at right, with its name before it; a usual one leaves the name where it is. Returns where the
// next one ends.
static int draw_figure(lab_view *view, lab_box head, int right, int base, const char *name, const char *text,
                       const char *usual) {
    text_draw(&view->target, head, &view->large, right, base, TEXT_RIGHT, TINT_TEXT, text);
    const int kept = text_width(&view->large, usual), needed = text_width(&view->large, text);
    right -= (needed > kept ? needed : kept) + 8;
    text_draw(&view->target, head, &view->normal, right, base, TEXT_RIGHT, TINT_FAINT, name);
    return right - text_width(&view->normal, name) - 18;
}

static void draw_head(lab_view *view, const lab_model *model, int index) {
    const lab_side *side = &model->sides[index];
    const lab_box box = view->layout.sides[index],
                  head = {box.x, box.y, box.width, view->layout.views[index].y - box.y};
    const lab_colour colour = tint_of_side(index);
    const char *name = action_choice_name(ACTION_SOLVER, 1, side->solver.solver);
    char about[128], text[128], digits[32];
    raster_fill(&view->target, head, head, TINT_PANEL, 256);
    raster_fill(&view->target, head, (lab_box){head.x, head.y, 4, head.height}, colour, 256);
    const int base = head.y + 18;
    text_draw(&view->target, head, &view->large, head.x + 14, base, TEXT_LEFT, colour, name);
    describe_solver(side, false, about, sizeof about);
    const int after = head.x + 14 + text_width(&view->large, name) + 10;
    // Right: cost, then bending to its left. What is left is for the description.
    int right = head.x + head.width - 12;
    if (view->shows_costs && side->measured.seconds > 0) {
        snprintf(text, sizeof text, "%.2f ms", 1e3 * side->measured.seconds);
        right = draw_figure(view, head, right, base, "cost", text, "00.00 ms");
    }
    if (after + text_width(&view->normal, "implicit, 1 substep of 8 iterations") + 150 <= right) {
        snprintf(text, sizeof text, "%sm", view_number(side->measured.bending, digits));
        right = draw_figure(view, head, right, base, "bending", text, "00.00 m");
    }
    if (after + text_width(&view->normal, about) > right)
        describe_solver(side, true, about, sizeof about);
    text_draw(&view->target, (lab_box){head.x, head.y, right - head.x, head.height}, &view->normal, after, base,
              TEXT_LEFT, TINT_FAINT, about);
}

// What the colours mean, in the upper right corner.
static void draw_scale(lab_view *view, const lab_model *model, lab_box box) {
    enum { WIDTH = 190 };
    const colour_choice by = model->look.colour;
    if (by == COLOUR_ISLAND || by == COLOUR_PLAN || box.width < 2 * WIDTH)
        return;
    const int left = box.x + box.width - WIDTH - 14, top = box.y + 20;
    const char *title = by == COLOUR_SPEED   ? "speed"
                        : by == COLOUR_FORCE ? "force"
                        : by == COLOUR_BENT  ? "bent for good"
                                             : "strain";
    for (int i = 0; i < WIDTH; i++) {
        const int step = i * (TINT_STEPS - 1) / (WIDTH - 1);
        raster_fill(&view->target, box, (lab_box){left + i, top, 1, 5}, tint_of(by, step), 256);
    }
    char high[64], low[72], digits[32];
    if (by == COLOUR_SPEED)
        snprintf(high, sizeof high, "%sm/s", view_number(view->speed_limit, digits));
    else if (by == COLOUR_FORCE)
        snprintf(high, sizeof high, "%sN", view_number(view->limit[1], digits));
    else
        snprintf(high, sizeof high, "%.3g %%", 100 * (by == COLOUR_BENT ? view->bent_limit : view->limit[0]));
    snprintf(low, sizeof low, "%s%s", by == COLOUR_SPEED ? "0" : "-", by == COLOUR_SPEED ? "" : high);
    text_draw(&view->target, box, &view->small, left, top - 4, TEXT_LEFT, TINT_FAINT, low);
    text_draw(&view->target, box, &view->small, left + WIDTH, top - 4, TEXT_RIGHT, TINT_FAINT, high);
    text_draw(&view->target, box, &view->small, left + WIDTH / 2, top - 4, TEXT_CENTRE, TINT_TEXT, title);
}

// Takes the words from the front of a text that fit into a line; returns what is left of it.
static const char *take_line(const lab_font *font, const char *text, int width, char *line, size_t size) {
    size_t taken = 0;
    for (size_t end = 1; end < size; end++) {
        if (text[end] != ' ' && text[end] != 0)
            continue;
        snprintf(line, end + 1, "%s", text);
        if (taken > 0 && text_width(font, line) > width)
            break;
        taken = end;
        if (text[end] == 0)
            break;
    }
    snprintf(line, taken + 1, "%s", text);
    return text + taken + (text[taken] == ' ');
}

static void draw_complaint(lab_view *view, const lab_side *side, lab_box box) {
    enum { LINES = 4, LINE_HEIGHT = 18 };
    if (!side->complaint[0])
        return;
    char text[LAB_COMPLAINT_SIZE + 16], lines[LINES][LAB_COMPLAINT_SIZE + 16];
    snprintf(text, sizeof text, "refused: %s", side->complaint);
    lab_box bar = {box.x + 12, 0, box.width - 160, 0};
    int count = 0;
    for (const char *rest = text; *rest && count < LINES; count++)
        rest = take_line(&view->normal, rest, bar.width - 20, lines[count], sizeof lines[count]);
    bar.height = LINE_HEIGHT * count + 6;
    bar.y = box.y + box.height - 12 - bar.height;
    raster_round(&view->target, box, bar, 4, 0x3a1720, 230);
    for (int i = 0; i < count; i++)
        text_draw(&view->target, box_shrink(bar, 1), &view->normal, bar.x + 10, bar.y + 16 + LINE_HEIGHT * i,
                  TEXT_LEFT, TINT_WARNING, lines[i]);
}

void view_draw_side(lab_view *view, const lab_model *model, int side) {
    const lab_box box = view->layout.views[side];
    if (box.width < 16 || box.height < 16)
        return;
    view_draw_network(view, model, side);
    draw_scale(view, model, box);
    draw_complaint(view, &model->sides[side], box);
    draw_head(view, model, side);
}

/* --------------------------------------------------------------------------------------------------------- rest */

static void draw_cost(lab_view *view, const lab_costs *costs, lab_box box) {
    const double budget = 1.0 / FRAMES_PER_SECOND;
    const int width = box.width >= 1000 ? 140 : 80, left = box.x + box.width - width - 12, top = box.y + 15;
    char text[96];
    const int used = (int)(fmin(costs->frame / (1.5 * budget), 1) * width);
    raster_fill(&view->target, box, (lab_box){left, top, width, 7}, TINT_BUTTON, 256);
    raster_fill(&view->target, box, (lab_box){left, top, used, 7},
                costs->frame <= budget ? TINT_GOOD : TINT_WARNING, 256);
    raster_fill(&view->target, box, (lab_box){left + width * 2 / 3, top - 3, 1, 13}, TINT_TEXT, 256);
    snprintf(text, sizeof text,
             box.width >= 1000 ? "steps %.1f + drawing %.1f of %.1f ms, %.0f a second"
                               : "steps %.1f + drawing %.1f of %.1f ms",
             1e3 * costs->steps, 1e3 * fmax(costs->frame - costs->steps, 0), 1e3 * budget, costs->per_second);
    text_draw(&view->target, box, &view->normal, left - 12, top + 8, TEXT_RIGHT,
              costs->frame <= budget ? TINT_TEXT : TINT_WARNING, text);
}

static void draw_top(lab_view *view, const lab_model *model, const lab_costs *costs) {
    const lab_box box = view->layout.top;
    char text[160], particles[32], springs[32];
    raster_fill(&view->target, box, box, TINT_WINDOW, 256);
    text_draw(&view->target, box, &view->large, 18, 24, TEXT_LEFT, TINT_TEXT, model->stage.made.name);
    const int after = 18 + text_width(&view->large, model->stage.made.name) + 14;
    uint32_t broken = 0, bent = 0;
    for (int i = 0; i < model->side_count; i++) {
        broken = model->sides[i].broken_count > broken ? model->sides[i].broken_count : broken;
        bent = model->sides[i].bent_count > bent ? model->sides[i].bent_count : bent;
    }
    snprintf(text, sizeof text, "%s particles   %s springs   %.2f s",
             whole_number(model->stage.particle_count, particles), whole_number(model->stage.spring_count, springs),
             model->time);
    if (box.width < 1000) // all of it leaves no room for the costs
        snprintf(text, sizeof text, "%.2f s", model->time);
    text_draw(&view->target, box, &view->normal, after, 24, TEXT_LEFT, TINT_FAINT, text);
    int state = after + text_width(&view->normal, text) + 16;
    if (broken) {
        snprintf(text, sizeof text, "%u broken", broken);
        text_draw(&view->target, box, &view->normal, state, 24, TEXT_LEFT, 0xff9340, text);
        state += text_width(&view->normal, text) + 16;
    }
    if (bent) {
        snprintf(text, sizeof text, "%u bent", bent);
        text_draw(&view->target, box, &view->normal, state, 24, TEXT_LEFT, tint_bent(TINT_STEPS / 5), text);
        state += text_width(&view->normal, text) + 16;
    }
    if (!model->playing)
        text_draw(&view->target, box, &view->normal, state, 24, TEXT_LEFT, TINT_PIN, "paused");
    else if (model->speed > 1) {
        snprintf(text, sizeof text, "%u x", model->speed);
        text_draw(&view->target, box, &view->normal, state, 24, TEXT_LEFT, TINT_PIN, text);
    }
    if (costs && view->shows_costs && costs->frame > 0 && box.width >= 640)
        draw_cost(view, costs, box);
}

static void draw_status(lab_view *view, const lab_model *model) {
    const lab_box box = view->layout.status;
    raster_fill(&view->target, box, box, TINT_WINDOW, 256);
    const char *usual = "Masses on springs, moved by two solvers.   drag: pull   click: ask a spring   X drag: cut "
                        "  P: pin   B: blast   "
                        "U: undo   space: pause   wheel: zoom   right drag: move   H: all keys";
    if (box.width < 1100)
        usual = "Masses on springs, moved by two solvers.   drag: pull   X drag: cut   H: all keys";
    const char *text = model->message[0] ? model->message : usual;
    text_draw(&view->target, box, &view->normal, 18, box.y + 16, TEXT_LEFT,
              model->message[0] ? TINT_PIN : TINT_FAINT, text);
}

static void draw_pointer(lab_view *view, const lab_model *model, const lab_pointer *pointer) {
    for (int i = 0; i < model->side_count; i++) {
        const lab_camera camera = view_camera(view, model, i);
        const lab_box box = view->layout.views[i];
        double x, y, x2, y2;
        camera_to_pixel(&camera, pointer->x, pointer->y, &x, &y);
        camera_to_pixel(&camera, pointer->x2, pointer->y2, &x2, &y2);
        const double radius = fmax(pointer->radius * camera.scale, 4);
        if (pointer->kind == POINTER_CUT) {
            raster_line(&view->target, box, x, y, x2, y2, 2, pointer->colour, 230);
            raster_ring(&view->target, box, x, y, 0, 3, pointer->colour, 256);
            raster_ring(&view->target, box, x2, y2, 0, 3, pointer->colour, 256);
        } else if (pointer->kind == POINTER_CIRCLE) {
            raster_ring(&view->target, box, x, y, radius - 1, radius, pointer->colour, 160);
        }
    }
}

void view_end(lab_view *view, const lab_model *model, const lab_pointer *pointer, const lab_costs *costs) {
    draw_top(view, model, costs);
    draw_status(view, model);
    view_draw_panel(view, model);
    view_draw_plots(view, model);
    if (pointer) {
        draw_pointer(view, model, pointer);
        view_draw_hover(view, model, pointer);
    }
    if (model->look.help)
        view_draw_help(view);
}

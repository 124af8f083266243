/// @file view_network.c
/// Networks: as tiles of particles when they are small, as springs when they are near.
///
/// SPDX-License-Identifier: MIT
#include "lab/tint.h"
#include "lab/view.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// From this many pixels between neighbours on springs are lines.
static const double lines_from = 3.5;
// And from this many, particles are seen as well.
static const double dots_from = 9;

/* ----------------------------------------------------------------------------------------------------- colours */

static uint8_t step_of(double part) {
    return (uint8_t)(part <= 0 ? 0 : part >= 1 ? TINT_STEPS - 1 : (int)(part * (TINT_STEPS - 1) + 0.5));
}

// The value of a spring that colours show, -1 to 1 and beyond.
static float spring_value(const lab_side *side, const lab_settings *settings, colour_choice by, double limit,
                          uint32_t spring) {
    if (by == COLOUR_BENT)
        return (float)(side->plastic[spring] / limit);
    if (by == COLOUR_FORCE)
        return (float)(side_spring_stiffness(side, settings, spring) * side->strain[spring] *
                       side->stage->rest[spring] / limit);
    return (float)(side->strain[spring] / limit);
}

static double limit_of(const lab_view *view, colour_choice by) {
    return by == COLOUR_BENT ? view->bent_limit : view->limit[by == COLOUR_FORCE];
}

static void find_extremes(lab_view *view, const lab_model *model, int index) {
    const lab_side *side = &model->sides[index];
    const lab_stage *stage = side->stage;
    view_side *kept = &view->sides[index];
    float *extreme = kept->extreme;
    const colour_choice by = model->look.colour == COLOUR_MATERIAL ? COLOUR_STRAIN : model->look.colour;
    const bool by_strain = by == COLOUR_STRAIN;
    const float scale = (float)(1 / view->limit[0]);
    for (uint32_t i = 0; i < stage->particle_count; i++)
        extreme[i] = 0;
    for (uint32_t i = 0; i < stage->spring_count; i++) {
        const float value =
            by_strain ? side->strain[i] * scale : spring_value(side, &model->settings, by, limit_of(view, by), i);
        float *a = &extreme[stage->a[i]], *b = &extreme[stage->b[i]];
        *a = fabsf(value) > fabsf(*a) ? value : *a;
        *b = fabsf(value) > fabsf(*b) ? value : *b;
    }
    for (uint32_t i = 0; i < stage->particle_count; i++)
        kept->tint[i] = step_of(0.5 + 0.5 * extreme[i]);
}

// Rows of the plan: particles that are neighbours in memory and on the stage.
static void find_rows(view_side *kept, const lab_side *side) {
    const lab_stage *stage = side->stage;
    uint32_t row = 0;
    mspring_id before = MSPRING_NONE;
    if (kept->numbered == side->network)
        return;
    for (uint32_t slot = 0; slot < side->view.slot_count; slot++) {
        const mspring_id now = side->view.particle_of_slot[slot];
        if (now == MSPRING_NONE)
            continue;
        const double reach = 1.6 * stage->spacing;
        if (before != MSPRING_NONE &&
            (fabs(stage->x[now] - stage->x[before]) > reach || fabs(stage->y[now] - stage->y[before]) > reach))
            row++;
        kept->number[now] = row;
        before = now;
    }
    kept->numbered = side->network;
}

static void find_islands(view_side *kept, const lab_side *side) {
    kept->numbered = NULL;
    if (mspring_network_update_components(side->network, NULL, NULL) != MSPRING_OK ||
        mspring_network_get_integers(side->network, MSPRING_COMPONENT, NULL, 0, side->stage->particle_count,
                                     kept->number, 1) != MSPRING_OK)
        for (uint32_t i = 0; i < side->stage->particle_count; i++)
            kept->number[i] = 0;
}

static void find_speeds(view_side *kept, const lab_side *side, double limit) {
    for (uint32_t i = 0; i < side->stage->particle_count; i++) {
        const uint32_t slot = side->view.slot_of_particle[i];
        const float vx = side->view.vx[slot], vy = side->view.vy[slot];
        kept->tint[i] = step_of(sqrtf(vx * vx + vy * vy) / limit);
    }
}

static void prepare_colours(lab_view *view, const lab_model *model, int index) {
    view_side *kept = &view->sides[index];
    const lab_side *side = &model->sides[index];
    switch (model->look.colour) {
    case COLOUR_SPEED:
        find_speeds(kept, side, view->speed_limit);
        break;
    case COLOUR_ISLAND:
        find_islands(kept, side);
        break;
    case COLOUR_PLAN:
        find_rows(kept, side);
        break;
    default:
        find_extremes(view, model, index);
        break;
    }
}

static lab_colour particle_colour(const lab_model *model, const view_side *kept, uint32_t particle) {
    switch (model->look.colour) {
    case COLOUR_SPEED:
        return tint_speed(kept->tint[particle]);
    case COLOUR_ISLAND:
    case COLOUR_PLAN:
        return tint_distinct(kept->number[particle]);
    case COLOUR_MATERIAL: {
        // What is strained glows.
        const int tint = kept->tint[particle], glow = tint < 128 ? 128 - tint : tint - 128;
        const lab_colour own = model->stage.material ? tint_material(model->stage.material[particle]) : 0x7d8aa0;
        return colour_mix(own, tint_strain(tint), glow > 16 ? (glow - 16) * 2 : 0);
    }
    case COLOUR_BENT:
        return tint_bent(kept->tint[particle]);
    default:
        return tint_strain(kept->tint[particle]);
    }
}

/* ------------------------------------------------------------------------------------------------------ pieces */

static void place_particles(view_side *kept, const lab_side *side, const lab_camera *camera) {
    const double offset_x = camera->pixel_x + (side->view.origin_x - camera->x) * camera->scale;
    const double offset_y = camera->pixel_y - (side->view.origin_y - camera->y) * camera->scale;
    const float scale = (float)camera->scale, from_x = (float)offset_x, from_y = (float)offset_y;
    for (uint32_t i = 0; i < side->stage->particle_count; i++) {
        const uint32_t slot = side->view.slot_of_particle[i];
        kept->x[i] = from_x + scale * side->view.x[slot];
        kept->y[i] = from_y - scale * side->view.y[slot];
    }
}

// Metres from one line of the grid to the next.
static double grid_step(const lab_camera *camera) {
    double step = pow(10, ceil(log10(60 / camera->scale)));
    if (step * camera->scale > 240)
        step /= 5;
    else if (step * camera->scale > 120)
        step /= 2;
    return step;
}

static void draw_grid(lab_view *view, const lab_camera *camera, lab_box box) {
    const double step = grid_step(camera);
    double left, top, right, bottom;
    camera_to_world(camera, box.x, box.y, &left, &top);
    camera_to_world(camera, box.x + box.width, box.y + box.height, &right, &bottom);
    for (double x = ceil(left / step) * step; x <= right; x += step) {
        double px, py;
        camera_to_pixel(camera, x, 0, &px, &py);
        raster_fill(&view->target, box, (lab_box){(int)px, box.y, 1, box.height}, TINT_GRID, 256);
    }
    for (double y = ceil(bottom / step) * step; y <= top; y += step) {
        double px, py;
        camera_to_pixel(camera, 0, y, &px, &py);
        raster_fill(&view->target, box, (lab_box){box.x, (int)py, box.width, 1}, TINT_GRID, 256);
    }
}

// In the lower right corner: a step of the grid.
static void draw_ruler(lab_view *view, const lab_camera *camera, lab_box box) {
    const double step = grid_step(camera);
    char text[48], digits[32];
    const int length = (int)(step * camera->scale), right_end = box.x + box.width - 12,
              at = box.y + box.height - 12;
    snprintf(text, sizeof text, "%sm", view_number(step, digits));
    raster_fill(&view->target, box, (lab_box){right_end - length, at, length, 1}, TINT_FAINT, 200);
    raster_fill(&view->target, box, (lab_box){right_end - length, at - 3, 1, 7}, TINT_FAINT, 200);
    raster_fill(&view->target, box, (lab_box){right_end, at - 3, 1, 7}, TINT_FAINT, 200);
    text_draw(&view->target, box, &view->small, right_end - length / 2, at - 5, TEXT_CENTRE, TINT_FAINT, text);
}

// The shape at first, behind: tiles, or lines of this width if there is one.
static void draw_ghost(lab_view *view, const lab_stage *stage, view_side *kept, const lab_camera *camera,
                       float half, float width) {
    const layer_colour colour = layer_colour_of(TINT_GHOST);
    for (uint32_t i = 0; i < stage->particle_count; i++) {
        kept->x[i] = (float)(camera->pixel_x + (stage->x[i] - camera->x) * camera->scale);
        kept->y[i] = (float)(camera->pixel_y - (stage->y[i] - camera->y) * camera->scale);
        if (width == 0)
            layer_square(&kept->layer, kept->x[i], kept->y[i], half, colour);
    }
    for (uint32_t i = 0; width > 0 && i < stage->spring_count; i++) {
        const uint32_t a = stage->a[i], b = stage->b[i];
        layer_line(&kept->layer, kept->x[a], kept->y[a], kept->x[b], kept->y[b], width, colour);
    }
    layer_finish(&kept->layer, &view->target);
}

// What particles cannot get through.
static void draw_floor(lab_view *view, const lab_stage *stage, const lab_camera *camera, lab_box box) {
    double x, y;
    camera_to_pixel(camera, 0, stage->floor_y, &x, &y);
    if (!(y > box.y - 1 && y < box.y + box.height))
        return;
    const int top = (int)y + 1;
    raster_fill(&view->target, box, (lab_box){box.x, top, box.width, box.y + box.height - top}, TINT_GRID, 256);
    raster_fill(&view->target, box, (lab_box){box.x, top, box.width, 2}, TINT_EDGE, 256);
}

// Grid and ghost, drawn when the camera has moved, and else copied.
static bool draw_behind(lab_view *view, const lab_side *side, view_side *kept, const lab_camera *camera,
                        lab_box box, float half, float width) {
    const double place[3] = {camera->scale, camera->x, camera->y};
    const size_t pixels = (size_t)box.width * (size_t)box.height, row_size = (size_t)box.width * sizeof(uint32_t);
    uint32_t *const first = view->target.pixels + (size_t)box.y * (size_t)view->target.width + (size_t)box.x;
    const bool is_there = kept->behind_network == side->network &&
                          memcmp(place, kept->behind_camera, sizeof place) == 0 &&
                          memcmp(&box, &kept->behind_box, sizeof box) == 0;
    if (is_there) {
        for (size_t row = 0; row < (size_t)box.height; row++)
            memcpy(first + row * (size_t)view->target.width, kept->behind + row * (size_t)box.width, row_size);
        return true;
    }
    raster_fill(&view->target, box, box, TINT_VIEW, 256);
    draw_grid(view, camera, box);
    if (!layer_start(&kept->layer, box))
        return false;
    draw_ghost(view, side->stage, kept, camera, half, width);
    kept->behind_network = NULL;
    if (pixels > kept->behind_capacity) {
        uint32_t *larger = realloc(kept->behind, pixels * sizeof *larger);
        if (!larger)
            return true;
        kept->behind = larger;
        kept->behind_capacity = pixels;
    }
    for (size_t row = 0; row < (size_t)box.height; row++)
        memcpy(kept->behind + row * (size_t)box.width, first + row * (size_t)view->target.width, row_size);
    memcpy(kept->behind_camera, place, sizeof place);
    kept->behind_box = box;
    kept->behind_network = side->network;
    return true;
}

static void draw_springs(const lab_side *side, view_side *kept, const lab_model *model, const lab_view *view,
                         const uint32_t *list, uint32_t count, float width) {
    const lab_stage *stage = side->stage;
    const colour_choice by = model->look.colour;
    const bool by_value = by == COLOUR_STRAIN || by == COLOUR_FORCE || by == COLOUR_BENT;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t spring = list ? list[i] : i, a = stage->a[spring], b = stage->b[spring];
        if (side->broken[spring])
            continue;
        lab_colour colour;
        if (by_value)
            colour = tint_of(
                by, step_of(0.5 + 0.5 * spring_value(side, &model->settings, by, limit_of(view, by), spring)));
        else
            colour = particle_colour(model, kept, a);
        layer_line(&kept->layer, kept->x[a], kept->y[a], kept->x[b], kept->y[b], width, layer_colour_of(colour));
    }
}

static void draw_squares(const lab_side *side, view_side *kept, const lab_model *model, float half) {
    const colour_choice by = model->look.colour;
    if (by <= COLOUR_SPEED || by == COLOUR_BENT) {
        layer_colour colours[TINT_STEPS];
        for (int i = 0; i < TINT_STEPS; i++)
            colours[i] = layer_colour_of(tint_of(by, i));
        for (uint32_t i = 0; i < side->stage->particle_count; i++)
            layer_square(&kept->layer, kept->x[i], kept->y[i], half, colours[kept->tint[i]]);
        return;
    }
    for (uint32_t i = 0; i < side->stage->particle_count; i++)
        layer_square(&kept->layer, kept->x[i], kept->y[i], half, layer_colour_of(particle_colour(model, kept, i)));
}

static void draw_pins(lab_view *view, const lab_side *side, view_side *kept, lab_box box, double spacing) {
    const float half = (float)(spacing < 3 ? 1.2 : spacing < 12 ? 0.3 * spacing : 3.6);
    const layer_colour colour = layer_colour_of(TINT_PIN);
    if (!layer_start(&kept->layer, box))
        return;
    for (uint32_t i = 0; i < side->stage->particle_count; i++)
        if (side_is_pinned(side, i))
            layer_square(&kept->layer, kept->x[i], kept->y[i], half, colour);
    layer_finish(&kept->layer, &view->target);
}

// How far the probe has come down: from a dashed line at its first height.
static void draw_probe(lab_view *view, const lab_model *model, int index, lab_box box, const lab_camera *camera) {
    const lab_side *side = &model->sides[index];
    const view_side *kept = &view->sides[index];
    const lab_colour colour = tint_of_side(index);
    double x, top, px, py = model->stage.y[model->probe];
    camera_to_pixel(camera, 0, py, &px, &top);
    x = kept->x[model->probe];
    py = kept->y[model->probe];
    (void)side;
    if (fabs(py - top) > 4) {
        for (double dash = x - 24; dash < x + 24; dash += 8)
            raster_line(&view->target, box, dash, top, dash + 4, top, 1, colour, 200);
        raster_line(&view->target, box, x, top, x, py, 1, colour, 150);
    }
    raster_ring(&view->target, box, x, py, 4.2, 5.8, colour, 256);
    raster_ring(&view->target, box, x, py, 0, 1.6, 0xffffff, 256);
}

static void draw_hold(lab_view *view, const lab_model *model, int index, lab_box box, const lab_camera *camera) {
    const lab_side *side = &model->sides[index];
    const view_side *kept = &view->sides[index];
    if (!model->holding || side->held_count == 0)
        return;
    double px, py, x = 0, y = 0;
    for (uint32_t i = 0; i < side->held_count; i++) {
        x += kept->x[side->held[i]];
        y += kept->y[side->held[i]];
    }
    x /= side->held_count;
    y /= side->held_count;
    camera_to_pixel(camera, model->hold_x, model->hold_y, &px, &py);
    raster_line(&view->target, box, x, y, px, py, 1.6, 0xffffff, 200);
    raster_ring(&view->target, box, x, y, 0, 3, 0xffffff, 256);
    raster_ring(&view->target, box, px, py, 5, 7, 0xffffff, 256);
}

void view_draw_network(lab_view *view, const lab_model *model, int index) {
    const lab_side *side = &model->sides[index];
    const lab_box box = view->layout.views[index];
    view_side *kept = &view->sides[index];
    const lab_camera camera = view_camera(view, model, index);
    const double spacing = camera.scale * side->stage->spacing;
    const float half = (float)fmax(0.54 * spacing, 0.5);
    const float width = spacing < lines_from ? 0 : (float)fmin(fmax(0.14 * spacing, 1), 3);
    prepare_colours(view, model, index);
    if (!draw_behind(view, side, kept, &camera, box, half, width) || !layer_start(&kept->layer, box))
        return;
    place_particles(kept, side, &camera);
    if (width == 0) {
        draw_squares(side, kept, model, half);
        draw_springs(side, kept, model, view, side->stage->long_springs, side->stage->long_count, 1);
    } else {
        draw_springs(side, kept, model, view, NULL, side->stage->spring_count, width);
    }
    layer_finish(&kept->layer, &view->target);
    if (spacing >= dots_from && layer_start(&kept->layer, box)) {
        draw_squares(side, kept, model, (float)fmin(0.12 * spacing, 4));
        layer_finish(&kept->layer, &view->target);
    }
    if (model->settings.has_floor)
        draw_floor(view, side->stage, &camera, box);
    draw_pins(view, side, kept, box, spacing);
    draw_probe(view, model, index, box, &camera);
    draw_hold(view, model, index, box, &camera);
    draw_ruler(view, &camera, box);
    view_draw_spring(view, model, index, &camera);
}

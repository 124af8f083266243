/// @file film.c
/// Frames of a network.
///
/// SPDX-License-Identifier: MIT
#include "draw/film.h"
#include "draw/png.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_FRAMES = 64,
    LEAST_FRAMES = 8,
    FRAME_WIDTH = 520,
    FRAME_HEIGHT = 400,
    FRAME_MILLISECONDS = 60,
    FRAME_COLOURS = 64, // fewer make smaller files
};

// Memory for the frames.
static const size_t most_bytes = (size_t)1 << 29;

bool film_start(film *made, const network_shape *shape, draw_error *error) {
    size_t frame_bytes = 2 * shape->particle_count * sizeof(double);
    size_t fitting = most_bytes / frame_bytes;
    memset(made, 0, sizeof *made);
    made->shape = shape;
    made->interval = 1;
    // Even, so that dropping every second frame keeps the distance to the next one.
    made->frame_capacity = fitting < MOST_FRAMES ? (uint32_t)fitting & ~1u : MOST_FRAMES;
    if (made->frame_capacity >= LEAST_FRAMES) {
        made->x = malloc(made->frame_capacity * (frame_bytes / 2));
        made->y = malloc(made->frame_capacity * (frame_bytes / 2));
    }
    if (made->x && made->y)
        return true;
    film_free(made);
    snprintf(error->text, sizeof error->text, "no memory for an animation of %u particles: leave it out",
             shape->particle_count);
    return false;
}

void film_free(film *unwanted) {
    free(unwanted->x);
    free(unwanted->y);
    memset(unwanted, 0, sizeof *unwanted);
}

static double *frame_of(const film *source, double *positions, uint32_t frame) {
    return positions + (size_t)frame * source->shape->particle_count;
}

const double *film_last_x(const film *source) {
    return frame_of(source, source->x, source->frame_count - 1);
}

const double *film_last_y(const film *source) {
    return frame_of(source, source->y, source->frame_count - 1);
}

static void drop_every_second(film *target) {
    size_t size = target->shape->particle_count * sizeof(double);
    for (uint32_t i = 1; i < target->frame_count / 2; i++) {
        memcpy(frame_of(target, target->x, i), frame_of(target, target->x, 2 * i), size);
        memcpy(frame_of(target, target->y, i), frame_of(target, target->y, 2 * i), size);
    }
    target->frame_count /= 2;
    target->interval *= 2;
}

void film_step(film *target, const mspring_network *network) {
    if (target->step++ % target->interval != 0)
        return;
    if (target->frame_count == target->frame_capacity) {
        drop_every_second(target);
        if ((target->step - 1) % target->interval != 0)
            return;
    }
    uint32_t frame = target->frame_count;
    if (mspring_network_get_positions(network, 0, target->shape->particle_count, frame_of(target, target->x, frame),
                                      frame_of(target, target->y, frame), 1) == MSPRING_OK)
        target->frame_count++;
}

static bool draw_frame(canvas *made, const film *source, const network_view *view, uint32_t frame,
                       const char *title, draw_error *error) {
    figure drawing;
    figure_start(&drawing, view->width, view->height, 0xffffff);
    network_picture_draw(&drawing, source->shape, view, frame_of(source, source->x, frame),
                         frame_of(source, source->y, frame), title);
    bool ok = canvas_from_figure(made, &drawing, error);
    figure_free(&drawing);
    return ok;
}

// Colours for the whole film, chosen from the first frame, the middle one and the last.
static bool choose_colours(palette *made, const film *source, const network_view *view, const char *title,
                           draw_error *error) {
    enum { SAMPLES = 3 };
    canvas samples[SAMPLES] = {{0}};
    bool ok = true;
    for (uint32_t i = 0; ok && i < SAMPLES; i++)
        ok = draw_frame(&samples[i], source, view, (source->frame_count - 1) * i / (SAMPLES - 1), title, error);
    if (ok && !palette_make(made, samples, SAMPLES, FRAME_COLOURS)) {
        snprintf(error->text, sizeof error->text, "out of memory for an animation");
        ok = false;
    }
    for (int i = 0; i < SAMPLES; i++)
        canvas_free(&samples[i]);
    return ok;
}

static network_view choose_view(const film *source) {
    const network_shape *shape = source->shape;
    world_box box = network_shape_bounds(shape);
    for (uint32_t i = 0; i < source->frame_count; i++)
        box = world_box_add(box, frame_of(source, source->x, i), frame_of(source, source->y, i),
                            shape->particle_count);
    uint32_t last = source->frame_count - 1;
    double limit =
        network_strain_limit(shape, frame_of(source, source->x, last), frame_of(source, source->y, last));
    return network_view_fit(shape, box, FRAME_WIDTH, FRAME_HEIGHT, limit);
}

static bool write_frames(png_animation *animation, const film *source, const network_view *view, const char *title,
                         draw_error *error) {
    bool ok = true;
    for (uint32_t i = 0; ok && i < source->frame_count; i++) {
        canvas pixels = {0};
        ok = draw_frame(&pixels, source, view, i, title, error) && png_animation_add(animation, &pixels, error);
        canvas_free(&pixels);
    }
    return ok;
}

bool film_write(const film *source, const char *path, const char *title, draw_error *error) {
    network_view view = choose_view(source);
    palette colours;
    png_animation animation;
    if (!choose_colours(&colours, source, &view, title, error))
        return false;
    bool ok = png_animation_begin(&animation, path, &colours, source->frame_count, FRAME_MILLISECONDS, error);
    if (ok) {
        ok = write_frames(&animation, source, &view, title, error);
        // A failed frame's message must not be hidden by that of closing an incomplete file.
        draw_error closing;
        ok = png_animation_end(&animation, ok ? error : &closing) && ok;
    }
    palette_free(&colours);
    return ok;
}

/// @file film.c
/// Frames of a network.
///
/// SPDX-License-Identifier: MIT
#include "draw/film.h"
#include "draw/png.h"

#include <math.h>
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
    size_t particles = shape->particle_count * sizeof(double);
    size_t springs = ((size_t)shape->spring_count + 1) * sizeof(uint32_t);
    size_t fitting = most_bytes / (2 * particles + springs);
    memset(made, 0, sizeof *made);
    made->shape = shape;
    made->interval = 1;
    made->probe = shape->probe;
    made->most_height = FRAME_HEIGHT;
    // Even, so that dropping every second frame keeps the distance to the next one.
    made->frame_capacity = fitting < MOST_FRAMES ? (uint32_t)fitting & ~1u : MOST_FRAMES;
    if (made->frame_capacity >= LEAST_FRAMES) {
        made->x = malloc(made->frame_capacity * particles);
        made->y = malloc(made->frame_capacity * particles);
        made->flags = malloc(made->frame_capacity * springs);
        made->probes = malloc(made->frame_capacity * sizeof *made->probes);
        made->places = malloc(made->frame_capacity * sizeof *made->places);
    }
    if (made->x && made->y && made->flags && made->probes && made->places)
        return true;
    film_free(made);
    snprintf(error->text, sizeof error->text, "no memory for an animation of %u particles: leave it out",
             shape->particle_count);
    return false;
}

void film_free(film *unwanted) {
    free(unwanted->x);
    free(unwanted->y);
    free(unwanted->flags);
    free(unwanted->probes);
    free(unwanted->places);
    memset(unwanted, 0, sizeof *unwanted);
}

static double *frame_of(const film *source, double *positions, uint32_t frame) {
    return positions + (size_t)frame * source->shape->particle_count;
}

static uint32_t *flags_of(const film *source, uint32_t frame) {
    return source->flags + (size_t)frame * source->shape->spring_count;
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
        memcpy(flags_of(target, i), flags_of(target, 2 * i), target->shape->spring_count * sizeof(uint32_t));
        target->probes[i] = target->probes[2 * i];
        memcpy(target->places[i], target->places[2 * i], sizeof target->places[i]);
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
    const network_shape *shape = target->shape;
    uint32_t frame = target->frame_count;
    if (mspring_network_get_positions(network, NULL, 0, shape->particle_count, frame_of(target, target->x, frame),
                                      frame_of(target, target->y, frame), 1) != MSPRING_OK ||
        mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, 0, shape->spring_count,
                                     flags_of(target, frame), 1) != MSPRING_OK)
        return;
    target->probes[frame] = target->probe;
    memcpy(target->places[frame], target->place, sizeof target->place);
    target->frame_count++;
}

// What the network is like in a frame.
static network_shape shape_in(const film *source, uint32_t frame) {
    network_shape shape = *source->shape;
    shape.flags = flags_of(source, frame);
    shape.probe = source->probes[frame];
    return shape;
}

// A corner of what moves besides, in a frame; the first one again behind the last.
static void corner_in(const film *source, uint32_t frame, uint32_t corner, double *x, double *y) {
    const double *local = source->corners + 2 * (size_t)(corner % source->corner_count);
    const double *place = source->places[frame];
    *x = place[0] + cos(place[2]) * local[0] - sin(place[2]) * local[1];
    *y = place[1] + sin(place[2]) * local[0] + cos(place[2]) * local[1];
}

static bool draw_frame(canvas *made, const film *source, const network_view *view, uint32_t frame,
                       const char *title, draw_error *error) {
    figure drawing;
    network_shape shape = shape_in(source, frame);
    figure_start(&drawing, view->width, view->height, 0xffffff);
    network_picture_draw(&drawing, &shape, view, frame_of(source, source->x, frame),
                         frame_of(source, source->y, frame), title);
    for (uint32_t i = 0; i < source->corner_count; i++) {
        double line[4];
        corner_in(source, frame, i, &line[0], &line[1]);
        corner_in(source, frame, i + 1, &line[2], &line[3]);
        network_picture_line(&drawing, view, line);
    }
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
    world_box box = network_shape_bounds(source->shape);
    for (uint32_t i = 0; i < source->frame_count; i++)
        box = world_box_add(box, frame_of(source, source->x, i), frame_of(source, source->y, i),
                            source->shape->particle_count);
    for (uint32_t i = 0; i < source->frame_count; i++)
        for (uint32_t corner = 0; corner < source->corner_count; corner++) {
            double x, y;
            corner_in(source, i, corner, &x, &y);
            box = world_box_add(box, &x, &y, 1);
        }
    network_shape last = shape_in(source, source->frame_count - 1);
    double limit = source->strain_limit;
    if (!(limit > 0))
        limit = network_strain_limit(&last, film_last_x(source), film_last_y(source));
    return network_view_fit(source->shape, box, FRAME_WIDTH, source->most_height, limit);
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

/// @file headless.c
/// Scripts into pictures.
///
/// SPDX-License-Identifier: MIT
#include "lab/headless.h"
#include "common/output.h"
#include "draw/png.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ANIMATION_COLOURS = 96, ANIMATION_SAMPLES = 4 };

// Memory for the frames of a moving picture, whose colours are chosen when all are there.
static const size_t most_bytes = (size_t)1 << 29;

typedef struct frame_list {
    canvas *frames;
    size_t count, bytes;
} frame_list;

static bool complain(const char *text) {
    fprintf(stderr, "lab: %s\n", text);
    return false;
}

// Keeps a frame, smaller by whole pixels.
static bool keep(frame_list *list, const lab_raster *source, uint32_t shrink) {
    const uint32_t width = (uint32_t)source->width / shrink, height = (uint32_t)source->height / shrink;
    list->bytes += (size_t)3 * width * height;
    canvas *frames = list->bytes <= most_bytes ? realloc(list->frames, (list->count + 1) * sizeof *frames) : NULL;
    if (!frames)
        return complain("too many frames for a moving picture: take --every or --shrink");
    list->frames = frames;
    canvas *made = &frames[list->count];
    if (!canvas_make(made, width, height, 0))
        return complain("out of memory for a moving picture");
    list->count++;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            for (int channel = 0; channel < 3; channel++) {
                uint32_t sum = 0;
                for (uint32_t i = 0; i < shrink * shrink; i++) {
                    const size_t row = (size_t)y * shrink + i / shrink, column = (size_t)x * shrink + i % shrink;
                    sum += source->pixels[row * (size_t)source->width + column] >> (16 - 8 * channel) & 255;
                }
                // NOLINTNEXTLINE(clang-analyzer-core.DivideZero): it is read as 1 at least
                made->rgb[3 * ((size_t)y * width + x) + (size_t)channel] = (uint8_t)(sum / (shrink * shrink));
            }
    return true;
}

static bool write_animation(const frame_list *list, const lab_options *options) {
    canvas samples[ANIMATION_SAMPLES];
    palette colours;
    png_animation animation;
    draw_error error = {""};
    for (size_t i = 0; i < ANIMATION_SAMPLES; i++)
        samples[i] = list->frames[(list->count - 1) * i / (ANIMATION_SAMPLES - 1)];
    if (!palette_make(&colours, samples, ANIMATION_SAMPLES, ANIMATION_COLOURS))
        return complain("out of memory for a moving picture");
    const uint32_t milliseconds = options->every * 1000 / FRAMES_PER_SECOND;
    bool ok = png_animation_begin(&animation, options->animation, &colours, (uint32_t)list->count,
                                  milliseconds ? milliseconds : 1, &error);
    if (ok) {
        for (size_t i = 0; ok && i < list->count; i++)
            ok = png_animation_add(&animation, &list->frames[i], &error);
        draw_error closing = {""};
        ok = png_animation_end(&animation, ok ? &error : &closing) && ok;
    }
    palette_free(&colours);
    return ok || complain(error.text);
}

static bool write_frame(lab_app *app, frame_list *list) {
    const lab_options *options = app->options;
    char name[32];
    if ((app->model.frame - 1) % options->every != 0)
        return true;
    snprintf(name, sizeof name, "frame_%05llu", (unsigned long long)((app->model.frame - 1) / options->every));
    return (!options->every_frame || app_write_png(&app->view.target, options->frames, name)) &&
           (!options->animation || keep(list, &app->view.target, options->shrink));
}

int headless_run(lab_app *app) {
    const lab_options *options = app->options;
    frame_list list = {0};
    bool ok = !options->every_frame || output_make_folder(options->frames);
    while (ok && !(options->script && app_script_done(app)) &&
           !(options->most_frames && app->model.frame >= options->most_frames))
        ok = app_frame(app, false) && write_frame(app, &list);
    if (ok && options->animation && list.count > 0)
        ok = write_animation(&list, options);
    for (size_t i = 0; i < list.count; i++)
        canvas_free(&list.frames[i]);
    free(list.frames);
    if (ok)
        app_report(app);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}

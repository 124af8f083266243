/// @file window_sdl.c
/// A window by SDL2: its events, and the picture as a texture.
///
/// SPDX-License-Identifier: MIT
#include "common/clock.h"
#include "lab/window.h"

#include <SDL.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool window_can_show(void) {
    // Without a display SDL may still draw into memory, which nobody sees.
    const bool can = SDL_Init(SDL_INIT_VIDEO) == 0 && strcmp(SDL_GetCurrentVideoDriver(), "offscreen") != 0 &&
                     strcmp(SDL_GetCurrentVideoDriver(), "dummy") != 0;
    SDL_Quit();
    return can;
}

static bool complain(const char *what) {
    fprintf(stderr, "lab: %s: %s\n", what, SDL_GetError());
    return false;
}

static SDL_Window *open_window(const lab_options *options) {
    // Under X11 pixels go to the server through shared memory; by OpenGL they would take twice as long where
    // software stands in for a graphics card, and hardly less where there is one.
    SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    SDL_Window *made = NULL;
    if (SDL_Init(SDL_INIT_VIDEO) != 0)
        complain("no display for a window (--headless needs none)");
    else if (!(made = SDL_CreateWindow("massspring lab", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
                                       options->width, options->height, SDL_WINDOW_RESIZABLE)))
        complain("no window");
    else
        SDL_SetWindowMinimumSize(made, LAYOUT_LEAST_WIDTH, LAYOUT_LEAST_HEIGHT);
    return made;
}

static void close_window(SDL_Window *unwanted) {
    if (unwanted)
        SDL_DestroyWindow(unwanted);
    SDL_Quit();
}

// Translates an event. Returns false for one that means nothing here.
static bool translate(const SDL_Event *event, lab_input *input) {
    const SDL_Keymod modifiers = SDL_GetModState();
    *input = (lab_input){.shift = (modifiers & KMOD_SHIFT) != 0, .control = (modifiers & KMOD_CTRL) != 0};
    switch (event->type) {
    case SDL_KEYDOWN:
    case SDL_KEYUP:
        input->kind = event->type == SDL_KEYDOWN ? INPUT_KEY : INPUT_KEY_UP;
        input->key = event->key.keysym.sym == SDLK_F1 ? KEY_F1 : (int)event->key.keysym.sym;
        return input->key <= KEY_F1 && (!event->key.repeat || input->key == '.');
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
        input->kind = event->type == SDL_MOUSEBUTTONDOWN ? INPUT_PRESS : INPUT_RELEASE;
        input->button = event->button.button == SDL_BUTTON_LEFT     ? BUTTON_LEFT
                        : event->button.button == SDL_BUTTON_MIDDLE ? BUTTON_MIDDLE
                                                                    : BUTTON_RIGHT;
        input->x = event->button.x;
        input->y = event->button.y;
        return true;
    case SDL_MOUSEMOTION:
        input->kind = INPUT_MOVE;
        input->x = event->motion.x;
        input->y = event->motion.y;
        return true;
    case SDL_MOUSEWHEEL:
        input->kind = INPUT_WHEEL;
        input->wheel = event->wheel.y;
        SDL_GetMouseState(&input->x, &input->y);
        return event->wheel.y != 0;
    default:
        return false;
    }
}

// A file that was dropped on the window is the next scene.
static void open_dropped(lab_app *app, char *path) {
    const lab_action action = action_of_text(ACTION_SCENE, path);
    app_perform(&action, app);
    SDL_free(path);
}

// Hands all that has happened to the controller. Movements count from frame to frame only.
static void take_events(lab_app *app, bool *quits) {
    SDL_Event event;
    lab_input input, moved = {.kind = INPUT_KEY_UP};
    while (SDL_PollEvent(&event)) {
        if (event.type == SDL_QUIT)
            *quits = true;
        if (event.type == SDL_DROPFILE)
            open_dropped(app, event.drop.file);
        if (!translate(&event, &input))
            continue;
        if (input.kind == INPUT_MOVE) {
            moved = input;
            continue;
        }
        if (moved.kind == INPUT_MOVE)
            controller_take(&app->controller, &app->model, &app->view, &moved);
        moved.kind = INPUT_KEY_UP;
        controller_take(&app->controller, &app->model, &app->view, &input);
        layout_make(&app->view.layout, &app->model, app->view.target.width, app->view.target.height);
    }
    if (moved.kind == INPUT_MOVE)
        controller_take(&app->controller, &app->model, &app->view, &moved);
}

static bool follow_size(SDL_Window *window, lab_app *app) {
    int width, height;
    SDL_GetWindowSize(window, &width, &height);
    if ((width == app->view.target.width && height == app->view.target.height) || width < LAYOUT_LEAST_WIDTH ||
        height < LAYOUT_LEAST_HEIGHT)
        return true;
    if (view_resize(&app->view, width, height))
        return true;
    fputs("lab: out of memory\n", stderr);
    return false;
}

static bool show(SDL_Window *window, const lab_raster *picture) {
    SDL_Surface *surface = SDL_GetWindowSurface(window);
    if (!surface)
        return complain("cannot draw");
    // The window may have been made smaller since the picture was begun.
    const int width = surface->w < picture->width ? surface->w : picture->width;
    const int height = surface->h < picture->height ? surface->h : picture->height;
    if (SDL_LockSurface(surface) != 0 ||
        SDL_ConvertPixels(width, height, SDL_PIXELFORMAT_RGB888, picture->pixels,
                          picture->width * (int)sizeof *picture->pixels, surface->format->format, surface->pixels,
                          surface->pitch) != 0)
        return complain("cannot draw");
    SDL_UnlockSurface(surface);
    return SDL_UpdateWindowSurface(window) == 0 || complain("cannot draw");
}

int window_run(lab_app *app) {
    SDL_Window *window = open_window(app->options);
    const uint32_t most = app->options->most_frames;
    bool ok = window != NULL, quits = false;
    double due = clock_seconds();
    while (ok && !quits && !app->controller.quits && !(most && app->model.frame >= most)) {
        // The mouse needs to know where things are.
        ok = app->frames > 0 || view_begin(&app->view, &app->model);
        if (ok)
            take_events(app, &quits);
        ok = ok && follow_size(window, app) && app_frame(app, true);
        const double drawn = clock_seconds();
        ok = ok && show(window, &app->view.target);
        app->total_shown += clock_seconds() - drawn;
        // Frames are due at equal distances; one that is late by a whole frame is not made up for.
        due += 1.0 / FRAMES_PER_SECOND;
        const double left = due - clock_seconds();
        if (left < -1.0 / FRAMES_PER_SECOND)
            due -= left;
        else if (left > 0.001)
            SDL_Delay((Uint32)(1e3 * left));
    }
    close_window(window);
    if (ok)
        app_report(app);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}

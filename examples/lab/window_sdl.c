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

typedef struct sdl_window {
    SDL_Window *window;
    SDL_Renderer *renderer;
    SDL_Texture *texture;
    int width, height; ///< of the texture
} sdl_window;

static bool complain(const char *what) {
    fprintf(stderr, "lab: %s: %s\n", what, SDL_GetError());
    return false;
}

static bool make_texture(sdl_window *made, int width, int height) {
    if (made->texture)
        SDL_DestroyTexture(made->texture);
    made->texture =
        SDL_CreateTexture(made->renderer, SDL_PIXELFORMAT_RGB888, SDL_TEXTUREACCESS_STREAMING, width, height);
    made->width = width;
    made->height = height;
    return made->texture || complain("no texture");
}

static bool open_window(sdl_window *made, const lab_options *options) {
    if (SDL_Init(SDL_INIT_VIDEO) != 0)
        return complain("no display for a window (--headless needs none)");
    made->window = SDL_CreateWindow("massspring lab", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
                                    options->width, options->height, SDL_WINDOW_RESIZABLE);
    if (!made->window)
        return complain("no window");
    SDL_SetWindowMinimumSize(made->window, LAYOUT_LEAST_WIDTH, LAYOUT_LEAST_HEIGHT);
    made->renderer = SDL_CreateRenderer(made->window, -1, SDL_RENDERER_PRESENTVSYNC);
    if (!made->renderer)
        made->renderer = SDL_CreateRenderer(made->window, -1, SDL_RENDERER_SOFTWARE);
    return made->renderer ? make_texture(made, options->width, options->height) : complain("no renderer");
}

static void close_window(sdl_window *unwanted) {
    if (unwanted->texture)
        SDL_DestroyTexture(unwanted->texture);
    if (unwanted->renderer)
        SDL_DestroyRenderer(unwanted->renderer);
    if (unwanted->window)
        SDL_DestroyWindow(unwanted->window);
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

// Hands all that has happened to the controller. Movements count from frame to frame only.
static void take_events(lab_app *app, bool *quits) {
    SDL_Event event;
    lab_input input, moved = {.kind = INPUT_KEY_UP};
    while (SDL_PollEvent(&event)) {
        if (event.type == SDL_QUIT)
            *quits = true;
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

static bool follow_size(sdl_window *window, lab_app *app) {
    int width, height;
    SDL_GetWindowSize(window->window, &width, &height);
    if ((width == window->width && height == window->height) || width < LAYOUT_LEAST_WIDTH ||
        height < LAYOUT_LEAST_HEIGHT)
        return true;
    return make_texture(window, width, height) &&
           (view_resize(&app->view, width, height) || complain("out of memory"));
}

static bool show(sdl_window *window, const lab_raster *picture) {
    if (SDL_UpdateTexture(window->texture, NULL, picture->pixels, picture->width * (int)sizeof *picture->pixels) !=
            0 ||
        SDL_RenderCopy(window->renderer, window->texture, NULL, NULL) != 0)
        return complain("cannot draw");
    SDL_RenderPresent(window->renderer);
    return true;
}

int window_run(lab_app *app) {
    sdl_window window = {0};
    const uint32_t most = app->options->most_frames;
    bool ok = open_window(&window, app->options), quits = false;
    while (ok && !quits && !app->controller.quits && !(most && app->model.frame >= most)) {
        const double begin = clock_seconds();
        // The mouse needs to know where things are.
        ok = app->frames > 0 || view_begin(&app->view, &app->model);
        if (ok)
            take_events(app, &quits);
        ok = ok && follow_size(&window, app) && app_frame(app, true) && show(&window, &app->view.target);
        // Where the display does not set the pace, this does.
        const double left = 1.0 / FRAMES_PER_SECOND - (clock_seconds() - begin);
        if (left > 0.002)
            SDL_Delay((Uint32)(1e3 * left));
    }
    close_window(&window);
    if (ok)
        app_report(app);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}

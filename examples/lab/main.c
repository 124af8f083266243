/// @file main.c
/// The lab: see networks move, pull and cut them, and compare solvers.
///
/// SPDX-License-Identifier: MIT
#include "lab/headless.h"
#include "lab/window.h"

#include <stdlib.h>

int main(int count, char **arguments) {
    static lab_app app;
    lab_options options;
    int exit_code;
    if (!options_read(&options, count, arguments, &exit_code))
        return exit_code;
    if (options.can_show)
        return window_can_show() ? EXIT_SUCCESS : EXIT_FAILURE;
    if (!app_start(&app, &options))
        return EXIT_FAILURE;
    exit_code = options.headless ? headless_run(&app) : window_run(&app);
    return app_free(&app) ? exit_code : EXIT_FAILURE;
}

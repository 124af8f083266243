/// @file window_none.c
/// No window here.
///
/// SPDX-License-Identifier: MIT
#include "lab/window.h"

#include <stdio.h>
#include <stdlib.h>

bool window_can_show(void) {
    return false;
}

int window_run(lab_app *app) {
    (void)app;
    fputs(
        "lab: built without SDL2, so there is no window: install libsdl2-dev (Debian, Ubuntu) and build again, or "
        "use --headless --script FILE\n",
        stderr);
    return EXIT_FAILURE;
}

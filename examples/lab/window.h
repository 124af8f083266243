/// @file window.h
/// The lab in a window. Built where SDL2 was found, or as a function that says that it was not.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_WINDOW_H
#define LAB_WINDOW_H

#include "lab/app.h"

/// Whether there can be one here.
bool window_can_show(void);

/// Run until somebody quits. Returns the exit code.
int window_run(lab_app *app);

#endif

/// @file headless.h
/// The lab without a window.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_HEADLESS_H
#define LAB_HEADLESS_H

#include "lab/app.h"

/// Play the script to its end and write what the options ask for. Returns the exit code.
int headless_run(lab_app *app);

#endif

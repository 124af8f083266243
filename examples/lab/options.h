/// @file options.h
/// The command line.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_OPTIONS_H
#define LAB_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct lab_options {
    const char *scene;     ///< ready scene or file; default ship
    const char *script;    ///< or NULL
    const char *record;    ///< file for a recording, or NULL
    const char *frames;    ///< folder for pictures; default "out"
    const char *animation; ///< file for a moving picture, or NULL
    bool headless;
    bool can_show;        ///< only tell whether there can be a window
    bool every_frame;     ///< write numbered frames
    bool no_clock;        ///< show nothing that differs from run to run
    int width, height;    ///< default 1280 x 720
    uint32_t every;       ///< frames of the lab from one written to the next; default 4
    uint32_t shrink;      ///< of the moving picture: 1, 2 or 4
    uint32_t most_frames; ///< stop after so many; 0: never
} lab_options;

/// Read it. Returns false if the program is to end now with *exit_code.
bool options_read(lab_options *made, int count, char **arguments, int *exit_code);

#endif

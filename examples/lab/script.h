/// @file script.h
/// Scripts: what is done when, in plain text.
///
///     # seconds  action  arguments
///     0          scene bar
///     1.5        grab 70 2 3
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_SCRIPT_H
#define LAB_SCRIPT_H

#include "lab/action.h"
#include "scenes/scene.h"

#include <stdint.h>
#include <stdio.h>

typedef struct script_line {
    uint64_t frame; ///< before which it is done
    uint32_t line;  ///< of the text, from 1
    lab_action action;
} script_line;

typedef struct lab_script {
    char name[ACTION_TEXT]; ///< for messages
    script_line *lines;
    size_t count;
} lab_script;

/// Read a script; a message says line, column and what is wrong.
bool script_parse(const char *text, size_t length, const char *name, lab_script *out, scene_error *error);
bool script_read(const char *path, lab_script *out, scene_error *error);
void script_free(lab_script *unwanted);

/// Write what is done in a frame, as a line of a script.
bool script_record(FILE *stream, uint64_t frame, const lab_action *action);

#endif

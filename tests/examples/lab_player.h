/// @file lab_player.h
/// Play the lab's model in tests: lines of scripts, and frames.
///
/// SPDX-License-Identifier: MIT
#ifndef TESTS_LAB_PLAYER_H
#define TESTS_LAB_PLAYER_H

#include <string.h>

#include "lab/model.h"
#include "support.h"

static void must_do(lab_model *model, const char *line) {
    lab_action action;
    action_error wrong = {0, ""};
    scene_error error = {""};
    if (!action_read(line, strlen(line), 1, &action, &wrong))
        fail_msg("%s: %s", line, wrong.text);
    if (!model_do(model, &action, &error))
        fail_msg("%s: %s", line, error.text);
}

static void start(lab_model *model, const char *scene_name) {
    scene_error error = {""};
    if (!model_start(model, scene_name, &error))
        fail_msg("%s", error.text);
}

static void frames(lab_model *model, int count) {
    for (int i = 0; i < count; i++) {
        const uint32_t steps = model_begin_frame(model);
        for (int side = 0; side < model->side_count; side++)
            model_play_side(model, side, steps);
        model_end_frame(model, steps);
    }
}

#endif

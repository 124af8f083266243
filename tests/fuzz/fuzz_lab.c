/// @file fuzz_lab.c
/// Scripts of the lab: they are refused with line and column, or read; nothing that their lines do to small scenes
/// goes wrong. What they leave is finite, and a load gives the bytes of its snapshot.
///
/// SPDX-License-Identifier: MIT
#include "fuzz.h"

#include <string.h>

#include "check.h"
#include "lab/model.h"
#include "lab/script.h"

// A script may ask for more than a fuzzer has time for.
enum { MOST_LINES = 40, MOST_FRAMES = 48, MOST_SUBSTEPS = 60 };

static bool is_cheap(const lab_action *action) {
    switch (action->kind) {
    case ACTION_SCENE:
        return strcmp(action->text, "bar") == 0 || strcmp(action->text, "rope") == 0;
    case ACTION_SUBSTEPS:
    case ACTION_ITERATIONS:
        return action->values[1] > 0 && action->values[1] <= MOST_SUBSTEPS;
    case ACTION_SPEED:
        return action->values[0] <= 2;
    default:
        return action->kind != ACTION_SETTLE;
    }
}

static void check_written(const lab_action *action) {
    char line[ACTION_LINE];
    lab_action again;
    action_error wrong;
    FUZZ_CHECK(action_is_valid(action));
    action_write(action, line);
    FUZZ_CHECK(action_read(line, strlen(line), 1, &again, &wrong));
    FUZZ_CHECK(again.kind == action->kind && strcmp(again.text, action->text) == 0);
}

static void frames_until(lab_model *model, uint64_t frame) {
    while (model->frame < frame && model->frame < MOST_FRAMES) {
        const uint32_t steps = model_begin_frame(model);
        for (int side = 0; side < model->side_count; side++)
            model_play_side(model, side, steps);
        model_end_frame(model, steps);
    }
}

// Line by line, so that one that is refused does not hide the others.
static void play_lines(const char *text, size_t size) {
    static lab_model model;
    scene_error error = {""};
    FUZZ_CHECK(model_start(&model, "rope", &error));
    for (int lines = 0; size > 0 && lines < MOST_LINES; lines++) {
        const char *end = memchr(text, '\n', size);
        const size_t length = end ? (size_t)(end - text) : size;
        lab_script script;
        if (script_parse(text, length, "fuzz", &script, &error)) {
            for (size_t i = 0; i < script.count; i++) {
                check_written(&script.lines[i].action);
                frames_until(&model, script.lines[i].frame);
                if (is_cheap(&script.lines[i].action) && !model_do(&model, &script.lines[i].action, &error))
                    FUZZ_CHECK(strlen(error.text) > 0);
            }
            script_free(&script);
        }
        text += length + (end != NULL);
        size -= length + (end != NULL);
    }
    frames_until(&model, model.frame + 2);
    for (int side = 0; side < model.side_count; side++) {
        (void)!fuzz_step(model.sides[side].network, 1e-3);
        fuzz_check_network(model.sides[side].network);
    }
    model_end(&model);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    lab_script script;
    scene_error error = {""};
    if (script_parse((const char *)data, size, "fuzz", &script, &error)) {
        script_free(&script);
    } else {
        FUZZ_CHECK(strncmp(error.text, "fuzz:", 5) == 0);
        FUZZ_CHECK(memchr(error.text, 0, sizeof error.text) != NULL);
    }
    play_lines((const char *)data, size);
    return 0;
}

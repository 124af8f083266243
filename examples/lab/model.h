/// @file model.h
/// The lab without window, mouse and pictures: a stage with one or two networks on it, and what actions do to them.
///
/// A frame is 1/64 s of the lab's own time, whether the networks move or not: what scripts count in.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_MODEL_H
#define LAB_MODEL_H

#include "lab/action.h"
#include "lab/undo.h"

enum { FRAMES_PER_SECOND = 64 };

typedef enum lab_probe {
    PROBE_BENDING,
    PROBE_KINETIC,
    PROBE_ELASTIC,
    PROBE_STRAIN,
    PROBE_COST, ///< milliseconds in a step
    PROBE_KINDS
} lab_probe;

enum { SERIES_LENGTH = 512, SERIES_FRAMES = 4 };

/// What was measured, the oldest first; every SERIES_FRAMES frames.
typedef struct lab_series {
    float values[PROBE_KINDS][2][SERIES_LENGTH];
    double times[SERIES_LENGTH]; ///< s
    int count;
} lab_series;

/// Files that are to be written after a frame.
typedef enum lab_wanted { WANTED_PICTURE, WANTED_TABLE, WANTED_RECORDING, WANTED_KINDS } lab_wanted;

/// What is shown, and where.
typedef struct lab_look {
    colour_choice colour;
    layout_choice layout;
    tool_choice tool;
    int page; ///< of the controls, from 0
    bool plots, panel, scenes, help;
    double x, y, metres; ///< of the camera: middle, and width of what is seen; metres is 0 to see everything
} lab_look;

typedef struct lab_model {
    char scene_name[ACTION_TEXT];
    lab_stage stage;
    lab_side sides[2];
    int side_count;
    lab_solver solvers[2];
    lab_settings settings;
    lab_look look;
    bool playing, ended;
    uint32_t speed, steps_asked;
    uint64_t frame;
    double time; ///< simulated, s
    mspring_id probe;
    bool has_spring; ///< one is told of
    uint32_t spring;
    lab_series series;
    lab_undo undo;
    action_kind last_undo_kind; ///< what the last undo is for,
    uint64_t last_undo_frame;   ///< and when: a slider that is moved is one edit
    bool holding;
    double grab_x, grab_y, hold_x, hold_y;  ///< where the mouse took hold, and where it is
    char message[256];                      ///< what to tell about the last action
    char wanted[WANTED_KINDS][ACTION_TEXT]; ///< names of files that are wanted, or ""
} lab_model;

/// A model with the ship on both sides, explicit and implicit.
bool model_start(lab_model *made, const char *scene_name, scene_error *error);
void model_end(lab_model *unwanted);

/// Do it. On error, such as a file that cannot be read, all is as before.
bool model_do(lab_model *model, const lab_action *action, scene_error *error);

/// A frame: begin it, play each side (two threads may), and end it.
uint32_t model_begin_frame(lab_model *model);
void model_play_side(lab_model *model, int side, uint32_t steps);
void model_end_frame(lab_model *model, uint32_t steps);

/// One number for the states of all sides.
uint64_t model_hash(const lab_model *model);

#endif

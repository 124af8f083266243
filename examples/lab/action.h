/// @file action.h
/// Everything that can be done in the lab, as data: what keys, mouse, scripts and recordings speak in.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_ACTION_H
#define LAB_ACTION_H

#include <stdbool.h>
#include <stddef.h>

enum { ACTION_VALUES = 4, ACTION_TEXT = 512, ACTION_LINE = 1024 };

/// Sides, as bits.
enum { SIDE_LEFT = 1, SIDE_RIGHT = 2, SIDE_BOTH = 3 };

typedef enum action_kind {
    ACTION_SCENE,      ///< text: a name or a file
    ACTION_SIDES,      ///< 1 or 2
    ACTION_SOLVER,     ///< sides, mspring_solver
    ACTION_INTEGRATOR, ///< sides, mspring_integrator
    ACTION_SUBSTEPS,   ///< sides, number; 0: by the library
    ACTION_ITERATIONS, ///< sides, number
    ACTION_GRAVITY,    ///< m/s^2, down
    ACTION_MASS,       ///< times the scene's
    ACTION_STIFFNESS,  ///< times the scene's, or times half the limit if relative
    ACTION_DAMPING,    ///< times the scene's
    ACTION_DRAG,       ///< global damping, 1/s
    ACTION_DT,         ///< s
    ACTION_RELATIVE,   ///< off, on
    ACTION_BREAKING,   ///< off, on
    ACTION_FLOOR,      ///< off, on
    ACTION_COLLIDE,    ///< off, on
    ACTION_YIELDING,   ///< off, on
    ACTION_GRIP,       ///< 1/s: how hard the mouse pulls
    ACTION_GRAB,       ///< x, y, radius
    ACTION_PULL,       ///< x, y
    ACTION_DROP,
    ACTION_PIN,    ///< x, y, radius
    ACTION_UNPIN,  ///< x, y, radius
    ACTION_CUT,    ///< x, y, x2, y2
    ACTION_BLAST,  ///< x, y, radius, speed
    ACTION_PROBE,  ///< x, y: the nearest particle is the probe
    ACTION_SPRING, ///< sides, x, y, radius: tell of the nearest spring what it bears
    ACTION_SETTLE,
    ACTION_PLAY,
    ACTION_PAUSE,
    ACTION_STEP,  ///< so many, while paused
    ACTION_SPEED, ///< steps in a frame
    ACTION_UNDO,
    ACTION_RESET,
    ACTION_COLOUR, ///< colour_choice
    ACTION_LAYOUT, ///< layout_choice
    ACTION_TOOL,   ///< tool_choice
    ACTION_PAGE,   ///< of the controls, where the window is too low for all of them
    ACTION_PLOTS,  ///< off, on
    ACTION_PANEL,  ///< off, on
    ACTION_SCENES, ///< off, on
    ACTION_HELP,   ///< off, on
    ACTION_CAMERA, ///< x, y of the middle, metres shown across
    ACTION_FIT,
    ACTION_SCREENSHOT, ///< text: a name
    ACTION_TABLE,      ///< text: a name
    ACTION_RECORDING,  ///< text: a name
    ACTION_END,
    ACTION_KINDS
} action_kind;

typedef enum colour_choice {
    COLOUR_STRAIN,
    COLOUR_FORCE,
    COLOUR_SPEED,
    COLOUR_ISLAND,
    COLOUR_PLAN,
    COLOUR_MATERIAL,
    COLOUR_BENT, ///< plastic strain: how much of a spring's length has changed for good
    COLOUR_CHOICES
} colour_choice;

/// What the left button does.
typedef enum tool_choice { TOOL_PULL, TOOL_CUT, TOOL_PIN, TOOL_BLAST, TOOL_CHOICES } tool_choice;

typedef enum layout_choice { LAYOUT_AUTO, LAYOUT_ROWS, LAYOUT_COLUMNS } layout_choice;

typedef struct lab_action {
    action_kind kind;
    double values[ACTION_VALUES]; ///< numbers, sides and places in a list of choices
    char text[ACTION_TEXT];
} lab_action;

/// What is wrong with a text, and where.
typedef struct action_error {
    size_t column; ///< from 1
    char text[256];
} action_error;

/// An action with these values.
lab_action action_of(action_kind kind, double a, double b, double c, double d);
lab_action action_of_text(action_kind kind, const char *text);

/// Read an action and its arguments from a piece of a line; first_column is that of its first character.
bool action_read(const char *line, size_t length, size_t first_column, lab_action *out, action_error *error);
/// Write it in the same form, without a newline. Returns buffer.
const char *action_write(const lab_action *action, char buffer[ACTION_LINE]);
/// Whether all values are in their ranges; an action that was written is within after it was read.
bool action_is_valid(const lab_action *action);
/// The same action with its values rounded as writing rounds them, and cut to their ranges.
lab_action action_rounded(const lab_action *action);

/// Its name and what it takes, such as "grab X Y RADIUS"; and what it does.
const char *action_usage(action_kind kind, char buffer[ACTION_LINE]);
const char *action_about(action_kind kind);
/// The words for a list of choices: of an action's argument number which.
const char *action_choice_name(action_kind kind, int which, int choice);
int action_choice_count(action_kind kind, int which);

#endif

/// @file view_hints.c
/// What each control does, in a line.
///
/// SPDX-License-Identifier: MIT
#include "lab/view.h"

static const char *const hints[ACTION_KINDS] = {
    [ACTION_SCENES] = "all scenes (N: the next one)",
    [ACTION_SCENE] = "open this scene",
    [ACTION_PLAY] = "go on (space)",
    [ACTION_PAUSE] = "stand still (space)",
    [ACTION_UNDO] = "take the last edit back (U)",
    [ACTION_RESET] = "start the scene again (R)",
    [ACTION_STEP] = "one time step (.)",
    [ACTION_SETTLE] = "go to static equilibrium at once (E)",
    [ACTION_BREAKING] = "springs break that are stretched too far",
    [ACTION_YIELDING] = "springs stay bent that are strained too far",
    [ACTION_RELATIVE] = "stiffness is a fraction of what one substep bears",
    [ACTION_FLOOR] = "a floor below the scene",
    [ACTION_COLLIDE] = "bodies meet each other and themselves",
    [ACTION_GRAVITY] = "downwards (G: off, on)",
    [ACTION_MASS] = "times what the scene has",
    [ACTION_STIFFNESS] = "how hard springs resist; more needs more substeps",
    [ACTION_DAMPING] = "in the springs: it stops vibration, not flight",
    [ACTION_DRAG] = "slows all motion, as water does",
    [ACTION_DT] = "time between two pictures that is computed at once",
    [ACTION_SUBSTEPS] = "pieces of a time step; more bear more stiffness",
    [ACTION_ITERATIONS] = "of the linear solver in a substep",
    [ACTION_PAGE] = "the other controls",
    [ACTION_SCREENSHOT] = "write a picture (W)",
    [ACTION_TABLE] = "write what the plots show, as CSV (V)",
    [ACTION_RECORDING] = "write what you did, as a script that plays it again (Y)",
};
static const char *const tools[TOOL_CHOICES] = {"pull with a soft spring; a click tells of a spring",
                                                "cut springs with a line (X)", "pin, or free what is pinned (P)",
                                                "push all away (B)"};
static const char *const solvers[] = {"cheapest and most accurate, if substeps are enough (T)",
                                      "stiff networks with one substep (T)",
                                      "as implicit, by factoring: for small networks (T)"};
static const char *const colours[COLOUR_CHOICES] = {"how far springs are stretched or squeezed (1)",
                                                    "the pull of springs (2)",
                                                    "how fast particles move (3)",
                                                    "what hangs together (4)",
                                                    "the rows in which the library sweeps (5)",
                                                    "the colours of the image (6)",
                                                    "lengths that changed for good (7)"};

const char *view_hint(const lab_control *control) {
    const lab_action *action = &control->action;
    switch (action->kind) {
    case ACTION_TOOL:
        return tools[(int)action->values[0]];
    case ACTION_SOLVER:
        return solvers[(int)action->values[1]];
    case ACTION_COLOUR:
        return colours[(int)action->values[0]];
    default:
        return hints[action->kind];
    }
}

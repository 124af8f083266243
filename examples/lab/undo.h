/// @file undo.h
/// What the lab looked like before the last edits: snapshots of the networks, and the settings.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_UNDO_H
#define LAB_UNDO_H

#include "lab/side.h"

enum { UNDO_MOST = 64 };

typedef struct lab_moment {
    lab_settings settings;
    lab_solver solvers[2];
    double time;
    mspring_id probe;
    int side_count;
    void *snapshots[2];
    size_t sizes[2];
} lab_moment;

typedef struct lab_undo {
    lab_moment moments[UNDO_MOST]; ///< the oldest first
    int count;
    size_t bytes;
} lab_undo;

void undo_clear(lab_undo *undo);
/// Keep a moment; the oldest ones go when there are too many or they take too much memory. Returns false when out
/// of memory.
bool undo_push(lab_undo *undo, const lab_side *sides, const lab_moment *state);
/// Take the last moment out and bring the sides back to it, from the settings that they have now. state receives
/// the rest of it. Returns false if there is none or a network refuses it, which its complaint tells.
bool undo_pop(lab_undo *undo, lab_side *sides, const lab_settings *now, lab_moment *state);

#endif

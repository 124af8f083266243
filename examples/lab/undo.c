/// @file undo.c
/// Snapshots, kept and loaded.
///
/// SPDX-License-Identifier: MIT
#include "lab/undo.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const size_t most_bytes = (size_t)1 << 28;

static void drop(lab_undo *undo, int index) {
    lab_moment *unwanted = &undo->moments[index];
    for (int i = 0; i < unwanted->side_count; i++) {
        undo->bytes -= unwanted->sizes[i];
        free(unwanted->snapshots[i]);
    }
    undo->count--;
    memmove(unwanted, unwanted + 1, (size_t)(undo->count - index) * sizeof *unwanted);
}

void undo_clear(lab_undo *undo) {
    while (undo->count > 0)
        drop(undo, undo->count - 1);
}

static bool save(const lab_side *side, void **snapshot, size_t *size) {
    if (mspring_network_get_snapshot_size(side->network, MSPRING_SNAPSHOT_ALL, size) != MSPRING_OK)
        return false;
    *snapshot = malloc(*size);
    return *snapshot &&
           mspring_network_save(side->network, MSPRING_SNAPSHOT_ALL, *snapshot, *size, size) == MSPRING_OK;
}

bool undo_push(lab_undo *undo, const lab_side *sides, const lab_moment *state) {
    lab_moment made = *state;
    bool ok = true;
    memset(made.snapshots, 0, sizeof made.snapshots);
    for (int i = 0; ok && i < made.side_count; i++)
        ok = save(&sides[i], &made.snapshots[i], &made.sizes[i]);
    if (!ok) {
        for (int i = 0; i < made.side_count; i++)
            free(made.snapshots[i]);
        return false;
    }
    for (int i = 0; i < made.side_count; i++)
        undo->bytes += made.sizes[i];
    while (undo->count == UNDO_MOST || (undo->count > 0 && undo->bytes > most_bytes))
        drop(undo, 0);
    undo->moments[undo->count++] = made;
    return true;
}

// Snapshots hold neither. The solver of the moment may be one that has no contact, or one that its contact needs.
static bool set_surroundings(lab_side *side, const lab_moment *moment, int index, const lab_settings *now) {
    lab_settings apart = moment->settings;
    apart.collides = false;
    return side_set_obstacles(side, &apart, now) && side_set_solver(side, &moment->solvers[index]) &&
           side_set_obstacles(side, &moment->settings, &apart);
}

bool undo_pop(lab_undo *undo, lab_side *sides, const lab_settings *now, lab_moment *state) {
    if (undo->count == 0)
        return false;
    const lab_moment *last = &undo->moments[undo->count - 1];
    bool ok = true;
    for (int i = 0; ok && i < last->side_count; i++) {
        // A snapshot of the implicit solver needs the same one to be there.
        ok = set_surroundings(&sides[i], last, i, now);
        if (ok && mspring_network_load(sides[i].network, last->snapshots[i], last->sizes[i]) != MSPRING_OK) {
            snprintf(sides[i].complaint, sizeof sides[i].complaint, "%s", mspring_network_error(sides[i].network));
            ok = false;
        }
        side_drop(&sides[i]);
        (void)!mspring_network_get_view(sides[i].network, &sides[i].view);
        side_find_broken(&sides[i]);
    }
    *state = *last;
    drop(undo, undo->count - 1);
    return ok;
}

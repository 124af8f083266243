/// @file ready.h
/// Scenes that the lab has ready.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_READY_H
#define LAB_READY_H

#include "lab/stage.h"

/// Of what a single explicit substep bears, where stiffness is relative.
#define READY_RELATIVE_STIFFNESS 0.5f
#define READY_RELATIVE_DAMPING 0.02f

typedef struct ready_scene {
    const char *name;
    bool (*make)(lab_stage *made, bool relative, scene_error *error);
} ready_scene;

/// In the order in which keys go through them.
enum { READY_COUNT = 11 };
/// A car of metal that yields, driven into a wall.
bool ready_car(lab_stage *made, bool relative, scene_error *error);
extern const ready_scene ready_scenes[READY_COUNT];

/// The scene of this name, or NULL.
const ready_scene *ready_find(const char *name);

/// Options of springs; those of files keep what the file says, unless stiffness is relative.
scene_options ready_options(bool relative, bool from_file);

#endif

/// @file settle.h
/// Let a scene down onto a floor.
///
/// SPDX-License-Identifier: MIT
#ifndef LOAD_SETTLE_H
#define LOAD_SETTLE_H

#include "scenes/scene.h"

typedef struct settle_request {
    double seconds;
    uint32_t substeps;   ///< of the explicit solver in 1/64 s; 0: as many as are stable
    const char *picture; ///< path to make the pictures' names of, or NULL
} settle_request;

/// Draw a scene as it is made.
bool settle_draw(scene *drawn, const char *path, scene_error *error);

/// Put a floor under the scene's lowest particle, step with a solver until the time is up, and print a line about
/// what came of it. Returns false, with a message, if a step is refused or the scene has flown apart.
bool settle_run(scene *settled, mspring_solver solver, const settle_request *request, scene_error *error);

#endif

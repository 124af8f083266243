/// @file actors.h
/// Actors beside springs in the random networks of test_spec.c: areas, angle springs, hooks, grips, actuators.
///
/// SPDX-License-Identifier: MIT
#ifndef SPEC_ACTORS_H
#define SPEC_ACTORS_H

#include <massspring/massspring.h>

#include "scene.h"
#include "spec.h"

/// Memory of a network's specification.
typedef struct specification {
    spec_network network;
    spec_motion motions[SCENE_PARTICLES], before[SCENE_PARTICLES];
    spec_vector forces[SCENE_PARTICLES], fields[SCENE_PARTICLES], held[SCENE_PARTICLES];
    spec_element elements[SCENE_ELEMENTS];
    spec_grip grips[SCENE_GRIPS];
    mspring_id grip_ids[SCENE_GRIPS];
    spec_actuator actuators[SCENE_ACTUATORS];
    mspring_id actuated[SCENE_ACTUATORS];
    float nominal[SCENE_ACTUATORS];
    uint32_t actuated_count;
    uint32_t first_particles; ///< at the beginning
    float inverse_masses[SCENE_PARTICLES], masses[SCENE_PARTICLES];
    spec_sums sums[SCENE_PARTICLES];
    uint32_t others[2 * SCENE_SPRINGS];
    double x[SCENE_PARTICLES], y[SCENE_PARTICLES];
} specification;

/// Add areas and angle springs to both sides.
void actors_add_elements(scene *s, mspring_network *library, specification *to);

/// Add hooks, grips and actuators to both sides.
void actors_add(scene *s, mspring_network *library, specification *to);

/// Move grips and signal actuators on both sides.
void actors_act(scene *s, mspring_network *library, specification *to);

#endif

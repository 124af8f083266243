/// @file scene.h
/// Random networks for test_spec.c.
///
/// SPDX-License-Identifier: MIT
#ifndef SPEC_SCENE_H
#define SPEC_SCENE_H

#include "spec.h"

#define SCENE_PARTICLES 2000
#define SCENE_SPRINGS 8000
#define SCENE_ELEMENTS 8
#define SCENE_GRIPS 4
#define SCENE_ACTUATORS 40

typedef struct scene_particle {
    double x, y;
    float vx, vy, mass;
    bool is_pinned;
} scene_particle;

/// A network as both sides get it.
typedef struct scene {
    uint64_t seed; ///< of what is drawn next
    uint32_t particle_count, spring_count, plane_count;
    scene_particle particles[SCENE_PARTICLES];
    spec_spring springs[SCENE_SPRINGS];
    double planes[3][4];
    double heights_x, heights_y, spacing;
    uint32_t height_count;
    float heights[40], frictions[40], restitutions[40];
    bool has_frictions; ///< of each part of the heights
    float friction, restitution, stiffness, damping, gravity_x, gravity_y, global_damping;
    uint32_t flags, max_substeps, most_work;
    bool is_calm;     ///< one particle moves, and time is short
    bool has_bundles; ///< for spec_arrange()
    bool grows;       ///< particles and springs may be added
    double welds;     ///< share of welds among springs
    double relative;  ///< of those that are relative
    double one_way;   ///< of those that only pull or push
    double brittle;   ///< of those that break
    double ductile;   ///< of those that yield
    double left;      ///< where the next part begins, m
} scene;

/// Particles and springs that may be added.
#define SCENE_SPARES 20

/// Draw a network.
void scene_make(scene *s, uint64_t seed);

/// Draw a spring between two particles with places of now, the next number. is_made: at the beginning; later it is plain.
void scene_add_spring(scene *s, uint32_t a, uint32_t b, bool is_made);

/// Draw a number, low <= number < high; a whole one below count; true with this probability.
double scene_between(scene *s, double low, double high);
uint32_t scene_below(scene *s, uint32_t count);
bool scene_chance(scene *s, double share);

#endif

/// @file stage.h
/// A scene as the lab needs it: what both sides share and what never changes while it is played.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_STAGE_H
#define LAB_STAGE_H

#include "lab/raster.h"
#include "scenes/scene.h"

typedef struct lab_stage {
    scene made;
    uint32_t particle_count, spring_count;
    double *x, *y;              ///< [particle_count], m, at first
    float *mass;                ///< [particle_count], kg
    bool *pinned;               ///< [particle_count], at first
    lab_colour *material;       ///< [particle_count] colours of the image, or NULL
    mspring_id *a, *b;          ///< [spring_count], the lower one first
    float *rest;                ///< [spring_count], m
    float *stiffness, *damping; ///< [spring_count], as in mspring_spring_def
    float *yield_strain;        ///< [spring_count]
    uint32_t *long_springs;     ///< [long_count] springs that do not join neighbours of a grid
    uint32_t long_count;
    double spacing; ///< of neighbours, m: that of most particles
    double min_x, min_y, max_x, max_y;
    double floor_y;   ///< where a floor lies, m
    mspring_id probe; ///< the scene's, or one far away from all pins
    bool relative;
    uint32_t substeps; ///< explicit ones that a file was made for; 0: any that are stable
    bool is_ready;  ///< one of the ready scenes
    bool collides;  ///< its bodies are there to meet
    double gravity; ///< m/s^2, down, that it begins with
    bool has_wall;  ///< where the floor ends, at wall_x
    double wall_x;  ///< m
    bool has_pins;
    bool yields; ///< some of its springs do
    bool has_damping; ///< the scene's own; if not, some is made up for the slider
} lab_stage;

/// Make a ready scene or read a file. With relative springs stiffness is half of what an explicit substep bears.
bool stage_open(lab_stage *made, const char *name, bool relative, scene_error *error);
void stage_free(lab_stage *unwanted);

#endif

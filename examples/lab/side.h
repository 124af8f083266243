/// @file side.h
/// One network of a stage: how it is stepped, held, edited and measured.
///
/// SPDX-License-Identifier: MIT
#ifndef LAB_SIDE_H
#define LAB_SIDE_H

#include "lab/stage.h"

/// What both sides have in common.
typedef struct lab_settings {
    double gravity, mass, stiffness, damping, drag, dt, grip; ///< as the actions of these names
    bool breaking, has_floor, collides, yielding;
} lab_settings;

enum { LAB_COMPLAINT_SIZE = 256 };

/// What each has for itself.
typedef struct lab_solver {
    mspring_solver solver;
    mspring_integrator integrator;
    uint32_t substeps; ///< 0: by the library
    uint32_t iterations;
} lab_solver;

typedef struct lab_measures {
    double bending;          ///< m that the probe has come down since the beginning
    double kinetic, elastic; ///< J
    double max_strain;
    double rms_strain;
    double min_x, min_y, max_x, max_y; ///< box around all particles
    double seconds;                    ///< that a step takes, on the average of the last ones; 0: not known yet
} lab_measures;

typedef struct lab_side {
    const lab_stage *stage;
    mspring_network *network;
    mspring_view view;
    lab_solver solver;
    lab_measures measured;
    float *strain; ///< [springs] as of the last measurement; 0 of broken ones
    bool *broken;  ///< [springs]
    uint32_t broken_count;
    float *plastic; ///< [springs] as of the last measurement: how much of their length changed for good
    uint32_t bent_count;
    uint32_t cure; ///< substeps that would have done for the step that was refused; 0: not known
    char complaint[LAB_COMPLAINT_SIZE]; ///< why the last step was refused, "" if it was not
    // What is held by the mouse.
    mspring_id *held;        ///< [particles]
    double *held_x, *held_y; ///< [particles] where they were when they were grabbed
    uint32_t held_count;
    double pull_x, pull_y; ///< how far they are pulled from there
    double last_dt;
    uint32_t substeps; ///< of the last step; before the first, of the next, or 1 where the library chooses
    uint64_t steps, timed_steps;
} lab_side;

/// Make a network of the stage with these settings.
bool side_make(lab_side *made, const lab_stage *stage, const lab_settings *settings, const lab_solver *solver,
               scene_error *error);
void side_free(lab_side *unwanted);

/// Take over solver or settings. On error, which complaint tells, nothing changes.
bool side_set_solver(lab_side *side, const lab_solver *solver);
bool side_set_settings(lab_side *side, const lab_settings *settings, const lab_settings *before);
/// Of these settings only what snapshots leave as it is: floor and contact. To be called before one is loaded.
bool side_set_obstacles(lab_side *side, const lab_settings *settings, const lab_settings *before);
/// Substeps that a step needs if the network keeps nearly its shape, for explicit steps; 0 if there are too many.
uint32_t side_suggest_substeps(lab_side *side, double dt);
void side_start_measuring_time(lab_side *side);

/// Take one step, with the forces on what is held. If it is refused, complaint says why, and nothing has moved.
void side_step(lab_side *side, const lab_settings *settings);
/// Measure and refresh strain and broken.
void side_measure(lab_side *side, const lab_settings *settings, mspring_id probe);
/// Stiffness in force of a spring, N/m, whether it is broken or not.
double side_spring_stiffness(const lab_side *side, const lab_settings *settings, uint32_t spring);
/// Read anew which springs are broken, after a snapshot was loaded.
void side_find_broken(lab_side *side);

/* side_bent.c */

/// Let springs yield: at the scene's strains, or at a usual one.
bool side_set_yielding(lab_side *side, bool yielding);
/// Refresh plastic and bent_count.
void side_measure_bent(lab_side *side);
/// Take over what another network of the same scene has bent.
bool side_copy_bent(lab_side *side, const lab_side *from);

/// World position of a particle.
void side_position(const lab_side *side, mspring_id particle, double *x, double *y);
mspring_id side_nearest(const lab_side *side, double x, double y);
bool side_is_pinned(const lab_side *side, mspring_id particle);
/// The nearest spring within a radius; false if there is none.
bool side_nearest_spring(const lab_side *side, double x, double y, double radius, uint32_t *spring);

/// Edits, by mouse: those within a radius, or the nearest particle if there is none. They return false when the
/// library refuses, which complaint tells.
void side_grab(lab_side *side, double x, double y, double radius);
void side_pull(lab_side *side, double x, double y);
void side_drop(lab_side *side);
bool side_pin(lab_side *side, double x, double y, double radius, bool pin);
bool side_cut(lab_side *side, double x, double y, double x2, double y2);
bool side_blast(lab_side *side, double x, double y, double radius, double speed);
/// Move, pin and break as another network of the same scene is.
bool side_copy_state(lab_side *side, const lab_side *from);

#endif

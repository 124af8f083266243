/// @file case.h
/// The cases of the map: families of them, numbered. A case is drawn from its number alone.
///
/// SPDX-License-Identifier: MIT
#ifndef MAP_CASE_H
#define MAP_CASE_H

#include "map/body.h"

#include <massspring/massspring.h>

typedef enum map_family {
    MAP_BLAST,    ///< velocities at random
    MAP_HIT,      ///< one particle is hit
    MAP_SPIN,     ///< a body turns
    MAP_DROP,     ///< a body falls onto a floor
    MAP_BOUNCE,   ///< loose particles bounce
    MAP_HANG,     ///< pins, that may move, gravity, held forces
    MAP_WRECK,    ///< springs are broken on the way, parts fall asleep
    MAP_FAR,      ///< far from the world's origin, and from the local one
    MAP_SUBSTEPS, ///< the same motion with ever more substeps
    MAP_MEET,     ///< two bodies collide
    MAP_SILT,     ///< a body falls into silt above heights, which differ in friction and restitution
    MAP_PRESS,    ///< two bodies collide, with the implicit and the direct solver
    MAP_BEND,     ///< springs that yield, act on one side or have limits, areas and angle springs
    MAP_WALL,     ///< a heavy body presses a light one against a wall or into a corner, which may move
    MAP_GRIP,     ///< one to four grips on a particle, whose targets may move
    MAP_FALL,     ///< a body, or loose particles, fall freely, in up to 491,520 substeps a second
    MAP_ORDER,    ///< precise networks, with ever more substeps
    MAP_UNEVEN,   ///< dt differs from step to step
    MAP_BURST,    ///< a body is blown up, and the library chooses the substeps
    MAP_REST,     ///< a precise body vibrates for long, also far from the local origin
    MAP_FAMILIES
} map_family;

const char *map_family_name(map_family family);

/// How many cases there are of a family.
uint32_t map_family_size(map_family family);

/// Springs on one side, springs that yield, limits, areas, angles.
enum { MAP_ONE_SIDED = 1, MAP_YIELDS = 2, MAP_LIMITS = 4, MAP_AREAS = 8, MAP_ANGLES = 16, MAP_ALL_LAWS = 31 };

enum { MAP_HEIGHTS = 40, MAP_PLANES = 4, MAP_STEPS = 48, MAP_GRIPS = 4 };

/// A case: everything that is to be known to run it again.
typedef struct map_case {
    map_family family;
    uint32_t index;
    map_shape shape;
    map_body body;
    mspring_network_def network;
    double share;   ///< explicit: length of a substep over what is stable in any shape; 0: dt is as it stands
    double dt;      ///< s; explicit with a share: the most
    uint32_t steps; ///< at most
    bool has_floor;
    mspring_floor_def floor; ///< its pointers are set by map_case_floor()
    double planes[MAP_PLANES][4];
    float heights[MAP_HEIGHTS];
    bool has_stretches; ///< each part of the heights has friction and restitution of its own
    float frictions[MAP_HEIGHTS], restitutions[MAP_HEIGHTS];
    bool has_forces, by_hook; ///< constant forces, given before each step or by a hook
    float force_x[MAP_PARTICLES], force_y[MAP_PARTICLES];
    double drift_x, drift_y; ///< m/s: velocity of all pinned particles, of the wedge and of targets
    uint32_t first_count;    ///< particles of the first of two bodies that meet; 0: there is no contact
    mspring_contact_def contact;
    bool has_wedge; ///< a collider of two sides that meet on the right
    double apex_x, apex_y;
    double wedge_angle, wedge_radius; ///< rad, between a side and the axis: a quarter turn is a straight wall; m
    uint32_t grip_count;
    mspring_grip_def grips[MAP_GRIPS];
    double limit_strain, limit_stiffening; ///< of all springs; 0: none
    float area_stiffness, angle_stiffness; ///< of all cells, N/m, and where springs follow each other, N m; 0: none
    uint32_t laws;                         ///< bits: MAP_ONE_SIDED and so on; 0: springs are linear
    uint32_t break_at;                     ///< step before which springs are broken; 0: none
    uint32_t break_every;                  ///< which of them: every so many-th
    uint32_t pattern;                      ///< of dt, where it differs from step to step
    double way; ///< spacings by which the fastest particle moves in a substep of calm motion
} map_case;

/// Draw a case.
void map_draw_case(map_case *drawn, map_family family, uint32_t index);

/// The case's floor, with pointers into the case.
mspring_floor_def map_case_floor(const map_case *what);

/// Describe a case in a line, without newline.
void map_describe_case(const map_case *what, char *text, size_t size);

#endif

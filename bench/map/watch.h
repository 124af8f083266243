/// @file watch.h
/// What the judges see of a network: its state by the public functions, and sums of it in double precision that owe
/// nothing to the library.
///
/// SPDX-License-Identifier: MIT
#ifndef MAP_WATCH_H
#define MAP_WATCH_H

#include "map/case.h"

/// One spring as it is in force.
typedef struct map_spring {
    mspring_id a, b;
    double stiffness, damping, rest_length;
} map_spring;

/// What hangs together.
typedef struct map_component {
    bool is_held; ///< a pinned particle is in it, or the floor touched it in the last step
    uint32_t particle_count;
    double mass, x, y;                             ///< kg; mass centre, m
    double px, py, spin;                           ///< kg m/s; kg m^2/s about the mass centre
    double momentum_scale;                         ///< sum of m |v|
    double spin_scale;                             ///< sum of m |r| |v - that of the mass centre|
    double spin_rounding;                          ///< sum of m |r| |v|
    double gravity_x, gravity_y, force_x, force_y; ///< N
} map_component;

typedef struct map_watch {
    const map_case *what;
    mspring_network *network;
    mspring_id wedge, grips[MAP_GRIPS]; ///< those that the case has
    uint32_t count, spring_count, component_count;
    map_spring springs[MAP_SPRINGS];
    double mass[MAP_PARTICLES]; ///< kg; INFINITY: pinned
    uint32_t component[MAP_PARTICLES];
    map_component components[MAP_PARTICLES];
    double substep, time;      ///< s
    double lag;                ///< s: twice the time by which velocities are older than positions
    double centre_x, centre_y; ///< m: where the local origin was at first
    double last_place;         ///< m, that a coordinate may be off by
    double x[MAP_PARTICLES], y[MAP_PARTICLES];
    float vx[MAP_PARTICLES], vy[MAP_PARTICLES];
    double force_x[MAP_PARTICLES], force_y[MAP_PARTICLES]; ///< N, all that acts but the floor
    float floor_x[MAP_PARTICLES], floor_y[MAP_PARTICLES];  ///< N s of the last step
    // Energies in the frame of the pinned particles, J.
    double kinetic, elastic;
    double speed, shortest; ///< m/s of the fastest particle; m, rest length of the shortest spring
    double potential;       ///< of gravity and held forces
    double shadow;          ///< explicit: what its substeps keep, beyond the sum of these
    double weight;   ///< sum of m |g| |x| and likewise of held forces: what a millionth of a coordinate is worth
    double force;    ///< N, sum of gravity and held forces
    double rounding; ///< J that the last places of positions are worth: |F| e + k e^2 / 2 of all springs
    double rounding_squares; ///< sum of ((|F| + k e) e)^2
    double deepest;          ///< m, overlap of two bodies that meet, or of one with a wall
} map_watch;

/// Begin to watch: add colliders and grips, read masses, springs, components and the first state.
bool map_watch_begin(map_watch *watch, const map_case *what, mspring_network *network, double substep);

/// Read springs and components again, after some were broken.
bool map_watch_springs(map_watch *watch);

/// Read the state, and sum it up.
/// @return false if something is not finite, or a call failed
bool map_watch_read(map_watch *watch);

/// What energy there is, J.
double map_watch_energy(const map_watch *watch);

/// How high a particle is above the floor, m; INFINITY without one.
double map_height_over_floor(const map_case *what, double x, double y);

#endif

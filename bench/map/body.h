/// @file body.h
/// Small bodies of every kind, drawn at random: what the families of the map step.
///
/// SPDX-License-Identifier: MIT
#ifndef MAP_BODY_H
#define MAP_BODY_H

#include <stdbool.h>
#include <stdint.h>

#include <massspring/massspring.h>

/// Of two bodies.
enum { MAP_PARTICLES = 128, MAP_SPRINGS = 640 };

/// Particles and springs, as they go into a builder.
typedef struct map_body {
    uint32_t particle_count, spring_count;
    mspring_particle_def particles[MAP_PARTICLES];
    mspring_spring_def springs[MAP_SPRINGS];
} map_body;

typedef enum map_shape {
    MAP_LATTICE,
    MAP_HOLES,  ///< a lattice with empty cells
    MAP_MESH,   ///< a grid without diagonals: it folds
    MAP_TRUSS,  ///< triangles in a row
    MAP_ROPE,   ///< a chain
    MAP_GRAPH,  ///< particles and springs at random
    MAP_WHEEL,  ///< a hub, spokes and a rim
    MAP_RIGGED, ///< a lattice with two ropes
    MAP_TWO,    ///< a lattice beside a truss: two components
    MAP_SHAPES,
    MAP_LOOSE = MAP_SHAPES ///< particles without springs: only where asked for
} map_shape;

const char *map_shape_name(map_shape shape);

/// What a body is made of.
typedef struct map_stuff {
    double stiffness;     ///< N/m, of the softest spring
    double spread;        ///< of the stiffest over the softest
    double damping_ratio; ///< of dampers, for the two masses of each spring
    double mass_ratio;    ///< of the heaviest particle over the lightest, which has 1 kg
    double spacing;       ///< m between neighbours
} map_stuff;

/// Draw a body whose lower left corner is at (0, 0).
void map_draw_body(map_body *body, map_shape shape, const map_stuff *stuff, uint64_t *seed);

/// The lowest left and the highest right corner of a body.
void map_body_box(const map_body *body, double *left, double *bottom, double *right, double *top);

/// Move a body.
void map_move_body(map_body *body, double x, double y);

/// Give all that the springs need to know to a builder.
mspring_result map_build_body(const map_body *body, mspring_builder *builder);

/// A random number evenly distributed between two, or with evenly distributed logarithm.
double map_between(uint64_t *seed, double low, double high);
double map_decades(uint64_t *seed, double low, double high);

#endif

/// @file hostile_shapes.h
/// Networks of about n springs in shapes that are expensive for careless algorithms.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_HOSTILE_SHAPES_H
#define TEST_HOSTILE_SHAPES_H

#include "costs.h"

mspring_builder *shapes_builder_for(costs *c);

/// Make a network of a builder and destroy that. spares: particles and springs that may be added.
mspring_network *shapes_network_of(mspring_builder *builder, costs *c, uint32_t spares);

/// Make a builder of such a shape.
typedef mspring_builder *(*shape)(costs *c, uint32_t n);

mspring_builder *shape_star(costs *c, uint32_t n);     ///< all springs at one particle
mspring_builder *shape_wheel(costs *c, uint32_t n);    ///< a star with a rim
mspring_builder *shape_clique(costs *c, uint32_t n);   ///< few particles, each joined to each
mspring_builder *shape_path(costs *c, uint32_t n);     ///< neighbours have far numbers
mspring_builder *shape_point(costs *c, uint32_t n);    ///< a path in one place
mspring_builder *shape_loose(costs *c, uint32_t n);    ///< n particles in one place
#define ROW_SPACING 0.5
mspring_builder *shape_row(costs *c, uint32_t n);      ///< n particles in a row, without springs
mspring_builder *shape_lattices(costs *c, uint32_t n); ///< small and equal
mspring_builder *shape_cliques(costs *c, uint32_t n);  ///< small and equal
mspring_builder *shape_lattice(costs *c, uint32_t n);  ///< a square of n particles
mspring_builder *shape_circle(costs *c, uint32_t n);   ///< a hub and n particles around it

#endif

/// @file growth.h
/// Networks that are added to.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_GROWTH_H
#define TEST_GROWTH_H

#include "life.h"
#include "recipe.h"

enum { SPARE_PARTICLES = 60, SPARE_SPRINGS = 120 };

/// A lattice with a rope to a pinned particle, a free strand, a random graph and loose particles.
recipe growth_recipe(void);

/// With room for what is added.
mspring_network *growth_network(const recipe *made, mspring_simd level, uint32_t workers);

/// The same, with a record of what is done to it; to be ended by growth_end().
life *growth_begin(const recipe *made, mspring_simd level, uint32_t workers, uint64_t seed);
void growth_end(life *it);

void growth_use(mspring_network *network, mspring_solver solver, mspring_integrator integrator,
                uint32_t iterations);

#endif

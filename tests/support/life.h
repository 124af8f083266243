/// @file life.h
/// A network that lives through random edits, additions and removals, beside a plain list of what it should consist
/// of.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_LIFE_H
#define TEST_LIFE_H

#include <stdbool.h>

#include "recipe.h"

enum { LIFE_PARTICLES = 600, LIFE_SPRINGS = 2400 }; ///< most ids

typedef struct life_spring {
    mspring_spring_def def;
    bool is_broken;
} life_spring;

typedef struct life {
    mspring_network *network;
    uint64_t seed;
    uint32_t spare_particles, spare_springs; ///< of the network
    bool has_particle[LIFE_PARTICLES], has_spring[LIFE_SPRINGS];
    float mass[LIFE_PARTICLES];
    bool is_pinned[LIFE_PARTICLES];
    life_spring springs[LIFE_SPRINGS];
    uint32_t particle_end, spring_end;     ///< ids so far
    uint32_t used_particles, used_springs; ///< spare ids that are in use, or gone and not recycled
    uint32_t gone_particles, gone_springs; ///< of these, gone
    uint32_t first_spare_particle, first_spare_spring;
} life;

/// Begin with what a recipe holds, and this network of it.
void life_begin(life *it, const recipe *made, mspring_network *network, uint32_t spare_particles,
                uint32_t spare_springs, uint64_t seed);

/// Do something random to network and list. Whatever the library answers is what the list says.
void life_do_something(life *it);

/// What of that life_do_something() may do.
void life_add(life *it, uint32_t particles, uint32_t springs);
void life_remove(life *it);

/// The network is what the list says, by everything that tells.
void life_check(const life *it);

/// What the list says as a recipe, at the places and speeds that the network has.
/// @param ids  [particle count of the result], receives the ids in the network; [LIFE_PARTICLES] will do
recipe life_recipe(const life *it, mspring_id *ids);

#endif

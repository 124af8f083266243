/// @file recipe.h
/// A network as two plain arrays, which can be shuffled, given to a builder, and given to the reference.
///
/// Lattices are made here particle by particle and spring by spring, not by mspring_builder_add_lattice(), so that
/// the tests do not ask the library what a lattice is.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_RECIPE_H
#define TEST_RECIPE_H

#include <massspring/massspring.h>
#include <stdbool.h>

typedef struct recipe {
    mspring_particle_def *particles;
    mspring_spring_def *springs;
    uint32_t particle_count, particle_room;
    uint32_t spring_count, spring_room;
} recipe;

/// What a lattice or a rope is made of. Each number is drawn anew for each particle or spring, within its range.
typedef struct recipe_stuff {
    double mass[2];
    double stiffness[2];
    double damping[2];
    uint32_t spring_flags;
    double pinned; ///< share of particles that are
    double holes;  ///< share of cells of a lattice that are empty
} recipe_stuff;

/// An empty recipe is {0}.
void recipe_free(recipe *made);

mspring_id recipe_particle(recipe *made, double x, double y, double mass, uint32_t flags);

/// With the distance as rest length.
mspring_id recipe_spring(recipe *made, mspring_id a, mspring_id b, double stiffness, double damping,
                         uint32_t flags);

/// A grid with its bottom left cell at (x, y), 8 neighbours to a cell.
/// @return the id of its first particle; the others follow row by row from the bottom, left to right
mspring_id recipe_lattice(recipe *made, uint32_t width, uint32_t height, double x, double y, double spacing,
                          const recipe_stuff *stuff, uint64_t *seed);

/// A straight chain of segments springs between two particles.
/// @return the id of its first inner particle
mspring_id recipe_rope(recipe *made, mspring_id from, mspring_id to, uint32_t segments, const recipe_stuff *stuff,
                       uint64_t *seed);

/// Springs between count random pairs of particles that none joins yet.
void recipe_random_springs(recipe *made, uint32_t count, const recipe_stuff *stuff, uint64_t *seed);

/// Move the particles, up to this much in each coordinate and m/s, after the springs have got their rest lengths.
/// (Rest lengths that are still to be taken from distances are set to what they are now.)
void recipe_disturb(recipe *made, double distance, double speed, uint64_t *seed);

/// Rows of every kind, relative springs and others, dampers, pins and a loose particle.
recipe recipe_mixed(uint64_t seed);

/// A lattice whose first column is pinned, 73.3975 kg a particle.
recipe recipe_bar(uint32_t columns, uint32_t rows, double stiffness);

/// A lattice with holes, a rope to a pin, and springs at random. Damping from `least` to `most`, N s/m; relative
/// springs have a hundredth of these numbers.
recipe recipe_rows(uint64_t seed, uint32_t spring_flags, double least, double most);

/// Put particles and springs into a random order, and half of the springs' ends the other way round.
/// @param new_ids  [particle_count], receives where each particle went; may be NULL
void recipe_shuffle(recipe *made, uint64_t *seed, mspring_id *new_ids);

/// A lattice, a random graph or a rope, or what several of them make.
typedef struct recipe_shape {
    const char *name;
    uint32_t width, height;      ///< of a lattice, with holes if there is a rope; 0: none
    uint32_t particles, springs; ///< of a random graph
    uint32_t rope;               ///< segments, from the lattice or from a pinned particle; 0: none
    double damping;
    bool hangs; ///< the lattice's left column and the rope's other end are pinned
} recipe_shape;

/// Masses from 1 to mass_ratio, a little out of shape.
recipe recipe_of_shape(const recipe_shape *shape, double stiffness, double mass_ratio);

mspring_builder *recipe_builder(const recipe *made, const mspring_allocator *allocator);

/// Make a network of it.
mspring_network *recipe_network(const recipe *made, const mspring_network_def *def);

/// The same, with this solver and integrator.
mspring_network *recipe_solved(const recipe *made, const mspring_network_def *def, mspring_solver solver,
                               mspring_integrator integrator);

#endif

/// @file ship.h
/// The game's ship: a hull with two masts on a lattice, and the ropes that stay the masts and hold an anchor.
///
/// SPDX-License-Identifier: MIT
#ifndef GAME_SHIP_H
#define GAME_SHIP_H

#include <massspring/massspring.h>

#include <stdbool.h>

enum {
    SHIP_WIDTH = 64,
    SHIP_HEIGHT = 12,
    SHIP_ROPES = 4,
    SHIP_MOST =
        SHIP_WIDTH * SHIP_HEIGHT, ///< particles; those of the ropes have room in what is empty of the lattice
    SHIP_MOST_SPRINGS = 4 * SHIP_MOST,
    SHIP_BRACES = 2
};

/// What a particle or a spring is part of. A spring between two parts is of the later one.
typedef enum ship_part { SHIP_HULL, SHIP_MAST, SHIP_ANCHOR, SHIP_ROPE, SHIP_PARTS } ship_part;

/// What the particles of a part are made of.
typedef struct ship_material {
    float mass;      ///< kg
    float displaced; ///< kg of water in its volume
    float drag;      ///< N s/m under water
    float wind;      ///< N s/m in air, which stands still
    float room;      ///< kg of water that may come into it
} ship_material;

extern const ship_material ship_materials[SHIP_PARTS];

/// How springs are to be measured out, and where the anchor lies.
typedef struct ship_choice {
    bool implicit;             ///< stiffness and damping in N/m and N s/m, not as fractions of what a substep bears
    double substep;            ///< s: what the fractions refer to
    double anchor_x, anchor_y; ///< m
} ship_choice;

typedef struct ship {
    ship_part part_of[SHIP_MOST]; ///< by particle
    uint32_t particles;
    mspring_id anchor;
    mspring_id first_rope; ///< spring; those of all ropes follow
    uint32_t rope_springs;
    mspring_id mast_top, brace_feet[SHIP_BRACES]; ///< where braces are to be
} ship;

/// Add the ship to the builder, which is empty and keeps its first failure: the keel lies at y = -2 m, its masts
/// end at 9 m.
void ship_build(ship *made, mspring_builder *builder, const ship_choice *choice);

/// The springs that brace the fore mast, for mspring_network_add_springs().
void ship_braces(const ship *of, const ship_choice *choice, mspring_spring_def *defs);

/// The part that a spring between particles a and b is of.
ship_part ship_part_of_spring(const ship *of, mspring_id a, mspring_id b);

#endif

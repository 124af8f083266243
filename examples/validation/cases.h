/// @file cases.h
/// Problems whose answers are known, and what the library makes of them.
///
/// SPDX-License-Identifier: MIT
#ifndef VALIDATION_CASES_H
#define VALIDATION_CASES_H

#include <massspring/massspring.h>

#include <stdbool.h>

typedef struct outcome {
    double computed, exact; ///< computed is NaN if a call failed, after a message
} outcome;

enum { CASE_SIZES = 4 };

typedef struct physics_case {
    const char *name;
    const char *unit;
    const char *size_name;      ///< what is refined
    uint32_t sizes[CASE_SIZES]; ///< from coarse to fine
    outcome (*run)(uint32_t size);
    double tolerance; ///< most error of the finest size, as a share of the exact answer
} physics_case;

outcome oscillator_period(uint32_t substeps_per_period);
outcome pendulum_period(uint32_t steps_per_second);
outcome wave_period(uint32_t springs);
outcome catenary_sag(uint32_t links);
outcome impact_of_equal_bars(uint32_t columns);
outcome impact_of_unequal_bars(uint32_t columns);

/// Of bars 20 times as long as high, with the bending stiffness of the lattice, which its edges raise.
outcome cantilever_sag(uint32_t cells_in_height);
outcome cantilever_first_period(uint32_t cells_in_height);
outcome cantilever_second_period(uint32_t cells_in_height);
outcome column_buckling_load(uint32_t cells_in_height);
/// The sag against the plate that fine lattices become.
outcome cantilever_sag_of_continuum(uint32_t cells_in_height);

/* ------------------------------------------------------------------------------------------------- what they share
 */

typedef struct world {
    mspring_builder *builder;
    mspring_network *network;
    mspring_result result; ///< of the first call that failed
} world;

/// An empty builder.
world world_begin(void);
/// Make its network, with gravity and the explicit solver.
void world_make(world *made, double gravity_x, double gravity_y, uint32_t substeps);
/// Free it, with a message if a call failed. Returns value, or NaN.
double world_end(world *ended, double value);
/// Note a result; once one has failed, the others are left out.
bool world_note(world *noted, mspring_result result);

/// A lattice of one material; its shear springs have half of its stiffness, so that it is isotropic.
typedef struct plate {
    uint32_t columns, rows;
    double x, y; ///< bottom left particle, m
    double spacing;
    double stiffness, mass; ///< of a spring along a row; of a particle
    bool pinned_column;     ///< the left one
    bool pinned_row;        ///< the bottom one
} plate;
void world_add_plate(world *to, const plate *added);

/// Time of one turn of an oscillation, from its upward passages through 0. Linear between samples.
typedef struct turn_counter {
    double before; ///< last sample
    double first, last;
    uint32_t passages;
} turn_counter;
void turn_counter_add(turn_counter *to, double time, double dt, double value);
double turn_counter_period(const turn_counter *counted);

#endif

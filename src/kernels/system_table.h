/// @file system_table.h
/// The implicit solver's part of an instruction set's table, empty if the build omits that solver.
///
/// SPDX-License-Identifier: MIT

#if defined(MSPRINGI_WITHOUT_IMPLICIT)
#define MSPRINGI_SYSTEM_TABLE                                                                                      \
    { 0 }
#else

#include "kernels/system_assemble.h"
#include "kernels/system_double.h"
#include "kernels/system_energy.h"
#include "kernels/system_iterate.h"
#include "kernels/system_motion.h"
#include "kernels/system_multiply.h"

#define MSPRINGI_SYSTEM_TABLE                                                                                      \
    {                                                                                                              \
        .scale_masses = scale_masses, .find_tile_motion = find_tile_motion, .rotate_tiles = rotate_tiles,          \
        .predict = predict, .assemble_lattice = {assemble_lattice_plain, assemble_lattice_damped},                 \
        .assemble_chain = {assemble_chain_plain, assemble_chain_damped},                                           \
        .carry_forces = {assemble_carry_plain, assemble_carry_damped}, .add_outside = add_outside,                 \
        .invert = invert, .multiply_lattice = multiply_lattice, .multiply_chain = multiply_chain,                  \
        .carry_product = multiply_carry, .advance = advance, .inertia_of_tile = inertia_of_tile,                   \
        .restrict_to_tile = restrict_to_tile,                                                                      \
        .update_search = {[MSPRINGI_SEARCH_COARSE_ONLY] = search_coarse_only,                                      \
                          [MSPRINGI_SEARCH_RESTART] = search_restart,                                              \
                          [MSPRINGI_SEARCH_CONTINUE] = search_continue},                                           \
        .correct = {[MSPRINGI_HISTORY_NONE] = correct_none,                                                        \
                    [MSPRINGI_HISTORY_VELOCITY_CHANGE] = correct_velocity_change,                                  \
                    [MSPRINGI_HISTORY_ACCELERATION] = correct_acceleration,                                        \
                    [MSPRINGI_HISTORY_BDF2] = correct_bdf2},                                                       \
        .moments = sum_moments, .elastic = sum_elastic, .add_edges = add_edges                                     \
    }

#endif

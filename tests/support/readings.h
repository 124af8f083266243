/// @file readings.h
/// Short ways to read and change a network: what takes several calls, or a struct, in one.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_READINGS_H
#define TEST_READINGS_H

#include <stdbool.h>

#include <massspring/massspring.h>

/* ------------------------------------------------------------------------------------------ sums and extremes */

/// Energies, J; momentum; the box around all particles. Any place may be NULL.
mspring_result support_get_energy(const mspring_network *network, double *kinetic, double *elastic,
                                  double *potential);
mspring_result support_get_momentum(const mspring_network *network, double *px, double *py, double *angular);
mspring_result support_get_bounds(const mspring_network *network, double *min_x, double *min_y, double *max_x,
                                  double *max_y);
/// Largest size of a strain, and its spring.
mspring_result support_get_max_strain(const mspring_network *network, float *strain, mspring_id *spring);
double support_largest_speed(const mspring_network *network);

/* ------------------------------------------------------------------------------------------------------ springs */

typedef struct support_spring_info {
    uint32_t flags;
    mspring_id a, b;
    float stiffness, damping, rest_length, length, strain, force, nominal_stiffness, nominal_damping;
} support_spring_info;

mspring_result support_get_spring(const mspring_network *network, mspring_id spring, support_spring_info *info);
/// Of all springs; each array may be NULL.
mspring_result support_get_extents(const mspring_network *network, float *length, float *direction_x,
                                   float *direction_y, float *strain);
bool support_has_spring(const mspring_network *network, mspring_id spring);
bool support_has_particle(const mspring_network *network, mspring_id particle);

/* ------------------------------------------------------------------------------------------------------- writes */

/// Move a particle by so much; set the velocity of one.
void support_shift(mspring_network *network, mspring_id particle, double dx, double dy);
void support_set_velocity(mspring_network *network, mspring_id particle, float vx, float vy);

/// A number that a hook writes to the state once, before the next step.
typedef struct support_writing {
    int array; ///< 0: x, 1: y, 2: vx, 3: vy
    mspring_id particle;
    float value;
    bool is_done;
} support_writing;
/// Add the hook; the writing must live as long.
mspring_id support_write_in_step(mspring_network *network, support_writing *writing);

/* ------------------------------------------------------------------------------------------------------ layout */

/// Numbers that mspring_network_describe() writes.
typedef struct support_plan {
    uint32_t particle_count;
    uint32_t spring_count;
    uint32_t lattice_count;
    uint32_t lattice_particles;
    uint32_t lattice_springs;
    uint32_t lattice_rows;
    uint32_t lattice_blocks;
    uint32_t chain_count;
    uint32_t chain_particles;
    uint32_t chain_springs;
    uint32_t irregular_particles;
    uint32_t loose_particles;
    uint32_t irregular_springs;
    uint32_t pass_rows;
    uint32_t pass_lag;
    uint32_t pass_substeps;
    uint32_t slot_count;
    uint32_t block_width;
    uint32_t has_damping;
    uint32_t has_relative;
    mspring_simd simd_level;
    mspring_solver solver;
    mspring_integrator integrator;
    uint32_t iterations;
    uint32_t tile_size;
    uint32_t tile_count;
    uint32_t coarse_values;
    uint32_t coarse_period;
    uint32_t irregular_layers;
    uint64_t factor_values;
    double factor_products;
    uint32_t pass_workers;
    float residual;
} support_plan;

mspring_result support_get_plan(const mspring_network *network, support_plan *plan);
size_t support_memory_used(const mspring_network *network);
uint32_t support_worker_count(const mspring_network *network);
mspring_simd support_simd_level(const mspring_network *network);
/// The best level of this machine and build.
mspring_simd support_best_level(void);
/// Take all springs into the layout again.
mspring_result support_expand(mspring_network *network);

/* ---------------------------------------------------------------------------------------------------- settings */

/// Set the solver of these settings: gravity, guard and so on stay.
mspring_result support_set_solver(mspring_network *network, const mspring_settings *settings);
uint32_t support_step_flags(const mspring_network *network);
uint32_t support_is_asleep(const mspring_network *network);
mspring_result support_get_sleepers(const mspring_network *network, mspring_id first, uint32_t count,
                                    uint8_t *asleep, uint32_t stride);
/// The message of the first failure, which is forgotten.
const char *support_builder_error(mspring_builder *builder);

/* ----------------------------------------------------------------------------------------------------- contact */

mspring_result support_set_layers(mspring_network *network, mspring_id first, uint32_t count, uint32_t layers,
                                  uint32_t masks);
mspring_result support_set_surface(mspring_network *network, mspring_id first, uint32_t count, float friction,
                                   float restitution);
mspring_result support_reserve_contact_events(mspring_network *network, uint32_t capacity);

/* ---------------------------------------------------------------------------------------------------- elements */

typedef struct support_area_info {
    uint32_t particle_count, is_open;
    double area, pressure, energy;
} support_area_info;

typedef struct support_angle_info {
    uint32_t is_open;
    mspring_id a, b, c;
    double angle, torque, energy;
} support_angle_info;

mspring_result support_set_area(mspring_network *network, mspring_id area, const mspring_area_def *def);
mspring_result support_get_area(const mspring_network *network, mspring_id area, mspring_area_def *def);
mspring_result support_get_area_info(const mspring_network *network, mspring_id area, support_area_info *info);
mspring_result support_set_angle(mspring_network *network, mspring_id angle, const mspring_angle_def *def);
mspring_result support_get_angle(const mspring_network *network, mspring_id angle, mspring_angle_def *def);
mspring_result support_get_angle_info(const mspring_network *network, mspring_id angle, support_angle_info *info);
mspring_result support_set_rest_angles(mspring_network *network, mspring_id first, uint32_t count,
                                       const double *rest_angles, uint32_t stride);
/// All areas, or all angles: ids, areas or angles, pressures or torques, as many as fit.
mspring_result support_get_areas(const mspring_network *network, mspring_id *ids, double *areas, double *pressures,
                                 uint32_t capacity, uint32_t *count);
mspring_result support_get_angles(const mspring_network *network, mspring_id *ids, double *angles, double *torques,
                                  uint32_t capacity, uint32_t *count);

#endif

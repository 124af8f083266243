#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

/* ------------------------------------------------------------------------------------------ sums and extremes */

static void put(double *to, double value) {
    if (to)
        *to = value;
}

mspring_result support_get_energy(const mspring_network *network, double *kinetic, double *elastic,
                                  double *potential) {
    mspring_energy energy = mspring_energy_default();
    const mspring_result result = mspring_network_get_energy(network, &energy);
    if (result != MSPRING_OK)
        return result;
    put(kinetic, energy.kinetic);
    put(elastic, energy.elastic);
    put(potential, energy.potential);
    return MSPRING_OK;
}

mspring_result support_get_momentum(const mspring_network *network, double *px, double *py, double *angular) {
    mspring_body body = mspring_body_default();
    const mspring_result result = mspring_network_get_body(network, NULL, 0, MSPRING_ALL, &body);
    if (result != MSPRING_OK)
        return result;
    put(px, body.px);
    put(py, body.py);
    put(angular, body.angular);
    return MSPRING_OK;
}

mspring_result support_get_bounds(const mspring_network *network, double *min_x, double *min_y, double *max_x,
                                  double *max_y) {
    mspring_body body = mspring_body_default();
    const mspring_result result = mspring_network_get_body(network, NULL, 0, MSPRING_ALL, &body);
    if (result != MSPRING_OK)
        return result;
    put(min_x, body.min_x);
    put(min_y, body.min_y);
    put(max_x, body.max_x);
    put(max_y, body.max_y);
    return MSPRING_OK;
}

mspring_result support_get_max_strain(const mspring_network *network, float *strain, mspring_id *spring) {
    mspring_energy energy = mspring_energy_default();
    const mspring_result result = mspring_network_get_energy(network, &energy);
    if (result != MSPRING_OK)
        return result;
    if (strain)
        *strain = (float)fabs(energy.largest_strain);
    if (spring)
        *spring = energy.strained;
    return MSPRING_OK;
}

double support_largest_speed(const mspring_network *network) {
    mspring_energy energy = mspring_energy_default();
    check_ok(mspring_network_get_energy(network, &energy));
    return energy.largest_speed;
}

/* ------------------------------------------------------------------------------------------------------ springs */

mspring_result support_get_spring(const mspring_network *network, mspring_id spring, support_spring_info *info) {
    const mspring_column columns[] = {
        {MSPRING_SPRING_FLAGS, 1, &info->flags},
        {MSPRING_END_A, 1, &info->a},
        {MSPRING_END_B, 1, &info->b},
        {MSPRING_ACTIVE_STIFFNESS, 1, &info->stiffness},
        {MSPRING_ACTIVE_DAMPING, 1, &info->damping},
        {MSPRING_ACTIVE_REST_LENGTH, 1, &info->rest_length},
        {MSPRING_LENGTH, 1, &info->length},
        {MSPRING_STRAIN, 1, &info->strain},
        {MSPRING_TENSION, 1, &info->force},
        {MSPRING_STIFFNESS, 1, &info->nominal_stiffness},
        {MSPRING_DAMPING, 1, &info->nominal_damping},
    };
    return mspring_network_get_columns(network, &spring, 0, 1, columns, COUNT_OF(columns));
}

mspring_result support_get_extents(const mspring_network *network, float *length, float *direction_x,
                                   float *direction_y, float *strain) {
    float *const places[] = {length, direction_x, direction_y, strain};
    mspring_column columns[4];
    uint32_t count = 0;
    for (int i = 0; i < 4; ++i)
        if (places[i])
            columns[count++] = (mspring_column){(mspring_property)(MSPRING_LENGTH + i), 1, places[i]};
    return mspring_network_get_columns(network, NULL, 0, mspring_network_count(network, MSPRING_SPRINGS), columns,
                                       count);
}

bool support_has_spring(const mspring_network *network, mspring_id spring) {
    uint32_t flags;
    return mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, &spring, 0, 1, &flags, 1) == MSPRING_OK;
}

bool support_has_particle(const mspring_network *network, mspring_id particle) {
    uint32_t flags;
    return mspring_network_get_integers(network, MSPRING_PARTICLE_FLAGS, &particle, 0, 1, &flags, 1) == MSPRING_OK;
}

/* ------------------------------------------------------------------------------------------------------- writes */

void support_shift(mspring_network *network, mspring_id particle, double dx, double dy) {
    double x, y;
    check_ok(mspring_network_get_positions(network, NULL, particle, 1, &x, &y, 1));
    x += dx;
    y += dy;
    check_ok(mspring_network_set_positions(network, NULL, particle, 1, &x, &y, 1));
}

void support_set_velocity(mspring_network *network, mspring_id particle, float vx, float vy) {
    check_ok(mspring_network_set_velocities(network, NULL, particle, 1, &vx, &vy, 1));
}

static void MSPRING_CALL write_once(const mspring_hook_args *args, void *user) {
    support_writing *writing = user;
    float *const arrays[] = {args->x, args->y, args->vx, args->vy};
    if (!writing->is_done)
        arrays[writing->array][args->slot_of_particle[writing->particle]] = writing->value;
    writing->is_done = true;
}

mspring_id support_write_in_step(mspring_network *network, support_writing *writing) {
    mspring_id hook = MSPRING_NONE;
    check_ok(support_add_hook(network, MSPRING_PHASE_BEFORE_STEP, write_once, writing, &hook));
    return hook;
}

/* ------------------------------------------------------------------------------------------------------ layout */

// The number that a line of a description gives.
static double number_in(const char *text, const char *name) {
    char line[64];
    (void)snprintf(line, sizeof line, "\n%s ", name);
    const char *found = strncmp(text, line + 1, strlen(line + 1)) == 0 ? text : strstr(text, line);
    if (!found)
        fail_msg("the description has no line for %s", name);
    return strtod(found + (found == text ? strlen(line + 1) : strlen(line)), NULL);
}

mspring_result support_get_plan(const mspring_network *network, support_plan *plan) {
    char text[4096];
    size_t size = 0;
    const mspring_result result = mspring_network_describe(network, text, sizeof text, &size);
    if (result != MSPRING_OK)
        return result;
    assert_true(size <= sizeof text);
    plan->particle_count = (uint32_t)number_in(text, "particle_count");
    plan->spring_count = (uint32_t)number_in(text, "spring_count");
    plan->lattice_count = (uint32_t)number_in(text, "lattice_count");
    plan->lattice_particles = (uint32_t)number_in(text, "lattice_particles");
    plan->lattice_springs = (uint32_t)number_in(text, "lattice_springs");
    plan->lattice_rows = (uint32_t)number_in(text, "lattice_rows");
    plan->lattice_blocks = (uint32_t)number_in(text, "lattice_blocks");
    plan->chain_count = (uint32_t)number_in(text, "chain_count");
    plan->chain_particles = (uint32_t)number_in(text, "chain_particles");
    plan->chain_springs = (uint32_t)number_in(text, "chain_springs");
    plan->irregular_particles = (uint32_t)number_in(text, "irregular_particles");
    plan->loose_particles = (uint32_t)number_in(text, "loose_particles");
    plan->irregular_springs = (uint32_t)number_in(text, "irregular_springs");
    plan->pass_rows = (uint32_t)number_in(text, "pass_rows");
    plan->pass_lag = (uint32_t)number_in(text, "pass_lag");
    plan->pass_substeps = (uint32_t)number_in(text, "pass_substeps");
    plan->slot_count = (uint32_t)number_in(text, "slot_count");
    plan->block_width = (uint32_t)number_in(text, "block_width");
    plan->has_damping = (uint32_t)number_in(text, "has_damping");
    plan->has_relative = (uint32_t)number_in(text, "has_relative");
    plan->simd_level = (mspring_simd)number_in(text, "simd_level");
    plan->solver = (mspring_solver)number_in(text, "solver");
    plan->integrator = (mspring_integrator)number_in(text, "integrator");
    plan->iterations = (uint32_t)number_in(text, "iterations");
    plan->tile_size = (uint32_t)number_in(text, "tile_size");
    plan->tile_count = (uint32_t)number_in(text, "tile_count");
    plan->coarse_values = (uint32_t)number_in(text, "coarse_values");
    plan->coarse_period = (uint32_t)number_in(text, "coarse_period");
    plan->irregular_layers = (uint32_t)number_in(text, "irregular_layers");
    plan->factor_values = (uint64_t)number_in(text, "factor_values");
    plan->factor_products = (double)number_in(text, "factor_products");
    plan->pass_workers = (uint32_t)number_in(text, "pass_workers");
    plan->residual = (float)number_in(text, "residual");
    return MSPRING_OK;
}

static mspring_network_info info_of(const mspring_network *network) {
    mspring_network_info info = mspring_network_info_default();
    (void)mspring_network_get_info(network, &info); // defaults if the network is NULL
    return info;
}

size_t support_memory_used(const mspring_network *network) {
    return (size_t)info_of(network).memory_used;
}

uint32_t support_worker_count(const mspring_network *network) {
    return info_of(network).worker_count;
}

mspring_simd support_simd_level(const mspring_network *network) {
    return info_of(network).simd_level;
}

mspring_simd support_best_level(void) {
    mspring_simd best = MSPRING_SIMD_AUTO;
    for (mspring_simd level = MSPRING_SIMD_SCALAR; level <= MSPRING_SIMD_WASM; ++level)
        if (mspring_simd_available(level))
            best = level;
    return best;
}

mspring_result support_expand(mspring_network *network) {
    mspring_job *job = NULL;
    mspring_result result = mspring_job_begin(network, MSPRING_LAYOUT_WHOLE, &job);
    if (result == MSPRING_OK)
        result = mspring_job_run(job, 0, NULL);
    if (result == MSPRING_OK)
        result = mspring_job_finish(network, job);
    mspring_job_destroy(job);
    return result;
}

/* ---------------------------------------------------------------------------------------------------- settings */

mspring_result support_set_solver(mspring_network *network, const mspring_settings *settings) {
    mspring_settings now = mspring_settings_default();
    mspring_result result = mspring_network_get_settings(network, &now);
    if (result != MSPRING_OK || !settings)
        return result != MSPRING_OK ? result : mspring_network_set_settings(network, settings);
    now.struct_size = settings->struct_size;
    now.solver = settings->solver;
    now.integrator = settings->integrator;
    now.substeps = settings->substeps;
    now.max_substeps = settings->max_substeps;
    now.substep_length = settings->substep_length;
    now.residual = settings->residual;
    now.iterations = settings->iterations;
    now.tile_size = settings->tile_size;
    now.coarse_period = settings->coarse_period;
    now.most_work = settings->most_work;
    return mspring_network_set_settings(network, &now);
}

static mspring_step_info step_of(const mspring_network *network) {
    mspring_step_info info = mspring_step_info_default();
    (void)mspring_network_get_step_info(network, &info);
    return info;
}

uint32_t support_step_flags(const mspring_network *network) {
    return step_of(network).flags;
}

uint32_t support_is_asleep(const mspring_network *network) {
    return step_of(network).is_asleep;
}

mspring_result support_get_sleepers(const mspring_network *network, mspring_id first, uint32_t count,
                                    uint8_t *asleep, uint32_t stride) {
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t flags;
        const mspring_result result =
            mspring_network_get_integers(network, MSPRING_PARTICLE_FLAGS, NULL, first + i, 1, &flags, 1);
        if (result != MSPRING_OK)
            return result;
        asleep[(size_t)i * stride] = (flags & MSPRING_PARTICLE_ASLEEP) != 0;
    }
    return MSPRING_OK;
}

const char *support_builder_error(mspring_builder *builder) {
    static char text[512];
    (void)snprintf(text, sizeof text, "%s", mspring_builder_error(builder));
    mspring_builder_forget_error(builder);
    return text;
}

/* ----------------------------------------------------------------------------------------------------- contact */

mspring_result support_set_layers(mspring_network *network, mspring_id first, uint32_t count, uint32_t layers,
                                  uint32_t masks) {
    const mspring_result result =
        mspring_network_set_integers(network, MSPRING_LAYERS, NULL, first, count, &layers, 0);
    return result != MSPRING_OK ? result
                                : mspring_network_set_integers(network, MSPRING_MASKS, NULL, first, count, &masks, 0);
}

mspring_result support_set_surface(mspring_network *network, mspring_id first, uint32_t count, float friction,
                                   float restitution) {
    const mspring_result result = mspring_network_set(network, MSPRING_FRICTION, NULL, first, count, &friction, 0);
    return result != MSPRING_OK
               ? result
               : mspring_network_set(network, MSPRING_RESTITUTION, NULL, first, count, &restitution, 0);
}

mspring_result support_reserve_contact_events(mspring_network *network, uint32_t capacity) {
    mspring_contact_def def = mspring_contact_def_default();
    mspring_result result = mspring_network_get_contact(network, &def);
    def.event_capacity = capacity;
    return result == MSPRING_OK ? mspring_network_set_contact(network, &def) : result;
}

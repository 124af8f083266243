/// @file model.c
/// Networks as plain arrays, and their motion in double precision.
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL // for lab.h
#include "board/model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <massspring/massspring.h>

static bool fail(const char *what) {
    fprintf(stderr, "massspring-board: %s\n", what);
    return false;
}

// Of floats that the library has of each.
static bool read_property(const mspring_network *network, mspring_property property, uint32_t count, double *to) {
    float value = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (mspring_network_get(network, property, NULL, i, 1, &value, 1) != MSPRING_OK)
            return false;
        to[i] = (double)value;
    }
    return true;
}

static bool read_network(model *m, const mspring_network *network) {
    const uint32_t n = m->particle_count, s = m->spring_count;
    m->x = malloc(n * sizeof *m->x);
    m->y = malloc(n * sizeof *m->y);
    m->inverse_mass = malloc(n * sizeof *m->inverse_mass);
    m->a = malloc(s * sizeof *m->a);
    m->b = malloc(s * sizeof *m->b);
    m->rest = malloc(s * sizeof *m->rest);
    m->stiffness = malloc(s * sizeof *m->stiffness);
    if (!m->x || !m->y || !m->inverse_mass || !m->a || !m->b || !m->rest || !m->stiffness)
        return fail("out of memory");
    bool good =
        mspring_network_get_positions(network, NULL, 0, n, m->x, m->y, 1) == MSPRING_OK &&
        mspring_network_get_columns(network, NULL, 0, s,
                                    (const mspring_column[]){{MSPRING_END_A, 1, m->a}, {MSPRING_END_B, 1, m->b}},
                                    2) == MSPRING_OK &&
        read_property(network, MSPRING_REST_LENGTH, s, m->rest) &&
        read_property(network, MSPRING_STIFFNESS, s, m->stiffness);
    for (uint32_t i = 0; good && i < n; i++) {
        double mass = 1, scale = 0;
        float value = 0;
        good = mspring_network_get(network, MSPRING_MASS, NULL, i, 1, &value, 1) == MSPRING_OK;
        mass = (double)value;
        good =
            good && mspring_network_get(network, MSPRING_INVERSE_MASS_SCALE, NULL, i, 1, &value, 1) == MSPRING_OK;
        scale = (double)value;
        m->inverse_mass[i] = scale / mass;
    }
    return good || fail(mspring_network_error(network));
}

bool model_read(model *made, mspring_builder *builder, uint32_t probe) {
    mspring_network *network = NULL;
    *made = (model){.particle_count = mspring_builder_count(builder, MSPRING_PARTICLES),
                    .spring_count = mspring_builder_count(builder, MSPRING_SPRINGS),
                    .probe = probe,
                    .gravity = (double)9.8f};
    if (mspring_network_create(builder, NULL, &network) != MSPRING_OK)
        return fail(mspring_builder_error(builder));
    const bool good = read_network(made, network);
    mspring_network_destroy(network);
    return good;
}

void model_free(model *unwanted) {
    free(unwanted->x);
    free(unwanted->y);
    free(unwanted->inverse_mass);
    free(unwanted->a);
    free(unwanted->b);
    free(unwanted->rest);
    free(unwanted->stiffness);
    *unwanted = (model){0};
}

mspring_network *model_network(const model *m, const mspring_network_def *def) {
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_result result = mspring_builder_create(NULL, &builder);
    for (uint32_t i = 0; result == MSPRING_OK && i < m->particle_count; i++) {
        mspring_particle_def particle;
        result = mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle);
        particle.flags = m->inverse_mass[i] > 0 ? 0 : MSPRING_PARTICLE_PINNED;
        particle.mass = m->inverse_mass[i] > 0 ? (float)(1 / m->inverse_mass[i]) : 1;
        particle.x = m->x[i];
        particle.y = m->y[i];
        result = result == MSPRING_OK ? mspring_builder_add_particles(builder, &particle, 1, NULL) : result;
    }
    for (uint32_t i = 0; result == MSPRING_OK && i < m->spring_count; i++) {
        mspring_spring_def spring;
        result = mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring);
        spring.a = m->a[i];
        spring.b = m->b[i];
        spring.rest_length = (float)m->rest[i];
        spring.stiffness = (float)m->stiffness[i];
        result = result == MSPRING_OK ? mspring_builder_add_springs(builder, &spring, 1, NULL) : result;
    }
    if (result == MSPRING_OK)
        result = mspring_network_create(builder, def, &network);
    if (result != MSPRING_OK)
        fail(mspring_builder_error(builder));
    mspring_builder_destroy(builder);
    return network;
}

double model_stable_substep(const model *m) {
    mspring_network *network = model_network(m, NULL);
    double least = 0;
    if (!network || mspring_network_get_stable_dt(network, &least, NULL) != MSPRING_OK)
        least = 0;
    mspring_network_destroy(network);
    return least;
}

bool model_settle(const model *m, double *x, double *y) {
    mspring_network *network = model_network(m, NULL);
    const bool good = network && mspring_network_settle(network, NULL, NULL) == MSPRING_OK &&
                      mspring_network_get_positions(network, NULL, 0, m->particle_count, x, y, 1) == MSPRING_OK;
    mspring_network_destroy(network);
    return good || fail("cannot settle");
}

/* --------------------------------------------------------------------------------------------- double precision */

static void accelerate(const model *m, const double *x, const double *y, double *ax, double *ay) {
    for (uint32_t i = 0; i < m->particle_count; i++) {
        ax[i] = 0;
        ay[i] = m->inverse_mass[i] > 0 ? -m->gravity : 0;
    }
    for (uint32_t s = 0; s < m->spring_count; s++) {
        const uint32_t a = m->a[s], b = m->b[s];
        const double dx = x[b] - x[a], dy = y[b] - y[a], length = sqrt(dx * dx + dy * dy);
        const double force = m->stiffness[s] * (length - m->rest[s]) / length;
        ax[a] += m->inverse_mass[a] * force * dx;
        ay[a] += m->inverse_mass[a] * force * dy;
        ax[b] -= m->inverse_mass[b] * force * dx;
        ay[b] -= m->inverse_mass[b] * force * dy;
    }
}

bool model_state_begin(const model *m, model_state *made) {
    const size_t n = m->particle_count;
    double *memory = calloc(4 * n, sizeof *memory);
    *made = (model_state){memory, memory + n, memory + 2 * n, memory + 3 * n};
    if (!memory)
        return fail("out of memory");
    memcpy(made->x, m->x, n * sizeof *made->x);
    memcpy(made->y, m->y, n * sizeof *made->y);
    return true;
}

void model_state_end(model_state *unwanted) {
    free(unwanted->x);
    *unwanted = (model_state){0};
}

bool model_move(const model *m, double time, uint64_t substeps, model_state *state) {
    const uint32_t n = m->particle_count;
    const double h = time / (double)substeps;
    double *ax = malloc(2 * (size_t)n * sizeof *ax), *ay = ax + n;
    if (!ax)
        return fail("out of memory");
    accelerate(m, state->x, state->y, ax, ay);
    for (uint64_t step = 0; step < substeps; step++) {
        for (uint32_t i = 0; i < n; i++) {
            state->vx[i] += 0.5 * h * ax[i];
            state->vy[i] += 0.5 * h * ay[i];
            state->x[i] += h * state->vx[i];
            state->y[i] += h * state->vy[i];
        }
        accelerate(m, state->x, state->y, ax, ay);
        for (uint32_t i = 0; i < n; i++) {
            state->vx[i] += 0.5 * h * ax[i];
            state->vy[i] += 0.5 * h * ay[i];
        }
    }
    free(ax);
    return true;
}

double model_energy(const model *m, const model_state *state, double h) {
    double energy = 0;
    for (uint32_t i = 0; i < m->particle_count; i++)
        if (m->inverse_mass[i] > 0)
            energy += (0.5 * (state->vx[i] * state->vx[i] + state->vy[i] * state->vy[i]) +
                       m->gravity * state->y[i] - 0.5 * h * state->vy[i] * m->gravity) /
                      m->inverse_mass[i];
    for (uint32_t s = 0; s < m->spring_count; s++) {
        const uint32_t a = m->a[s], b = m->b[s];
        const double free_a = m->inverse_mass[a] > 0, free_b = m->inverse_mass[b] > 0;
        const double dx = state->x[b] - state->x[a], dy = state->y[b] - state->y[a];
        const double length = sqrt(dx * dx + dy * dy), stretch = length - m->rest[s];
        const double rate = dx * (free_a * state->vx[a] - free_b * state->vx[b]) +
                            dy * (free_a * state->vy[a] - free_b * state->vy[b]);
        energy += 0.5 * m->stiffness[s] * stretch * (stretch + h * rate / length);
    }
    return energy;
}

double model_distance(const model *m, const double *x, const double *y, const double *to_x, const double *to_y) {
    double sum = 0;
    for (uint32_t i = 0; i < m->particle_count; i++)
        sum += (x[i] - to_x[i]) * (x[i] - to_x[i]) + (y[i] - to_y[i]) * (y[i] - to_y[i]);
    return sqrt(sum / m->particle_count);
}

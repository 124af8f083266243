/// @file calls.c
/// The calls that a game makes between its steps.
///
/// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include <massspring/massspring.h>

#include "session.h"

/// Springs broken at once where the rest of a structure holds.
#define FEW 20u

bool session_create(bench_network *network, session *out, scene_error *error) {
    const uint32_t particles = network->particle_count, springs = network->spring_count;
    const uint32_t most = particles > springs ? particles : springs;
    out->step = network;
    out->burst = springs < SESSION_BURST ? springs : SESSION_BURST;
    out->values = bench_allocate(most, sizeof *out->values, error);
    out->more_values = bench_allocate(particles, sizeof *out->more_values, error);
    out->x = bench_allocate(particles, sizeof *out->x, error);
    out->y = bench_allocate(particles, sizeof *out->y, error);
    out->snapshot = NULL;
    out->builder = NULL;
    if (mspring_network_get_snapshot_size(network->network, MSPRING_SNAPSHOT_ALL, &out->snapshot_size) ==
        MSPRING_OK) {
        out->snapshot_size += (size_t)64 * (particles + springs); // and what edits bring
        out->snapshot = bench_allocate(out->snapshot_size, 1, error);
    }
    out->list = bench_allocate(SESSION_BURST, sizeof *out->list, error);
    bool ok = true;
    for (int i = 0; i < 4; i++) {
        ok = (out->by_spring[i] = bench_allocate(springs, sizeof *out->by_spring[i], error)) != NULL && ok;
    }
    if (!ok || !out->values || !out->more_values || !out->x || !out->y || !out->list || !out->snapshot) {
        return false;
    }
    for (uint32_t i = 0; i < out->burst; i++) {
        out->list[i] = (mspring_id)((uint64_t)i * springs / out->burst);
    }
    return true;
}

void session_free(session *unwanted) {
    free(unwanted->values);
    free(unwanted->more_values);
    for (int i = 0; i < 4; i++) {
        free(unwanted->by_spring[i]);
    }
    free(unwanted->x);
    free(unwanted->y);
    free(unwanted->list);
    free(unwanted->snapshot);
    mspring_builder_destroy(unwanted->builder);
}

static void no_preparation(session *with) {
    (void)with;
}

static void prepare_masses(session *with) {
    with->calls++;
    for (uint32_t i = 0; i < with->step->particle_count; i++) {
        with->values[i] = 70.0f + (float)((i + with->calls) % 16);
    }
}

static mspring_result set_masses(session *with) {
    return mspring_network_set(with->step->network, MSPRING_MASS, NULL, 0, with->step->particle_count, with->values,
                               1);
}

static void prepare_scales(session *with) {
    with->calls++;
    for (uint32_t i = 0; i < with->step->particle_count; i++) {
        with->values[i] = (i + with->calls) % 16 == 0 ? 0.5f : 1.0f;
    }
}

static mspring_result set_scales(session *with) {
    return mspring_network_set(with->step->network, MSPRING_INVERSE_MASS_SCALE, NULL, 0, with->step->particle_count,
                               with->values, 1);
}

static mspring_result get_positions(session *with) {
    return mspring_network_get_positions(with->step->network, NULL, 0, with->step->particle_count, with->x, with->y,
                                         1);
}

static mspring_result set_positions(session *with) {
    return mspring_network_set_positions(with->step->network, NULL, 0, with->step->particle_count, with->x, with->y,
                                         1);
}

static void prepare_positions(session *with) {
    if (get_positions(with) != MSPRING_OK) {
        abort(); // not in a range that is all particles
    }
}

static mspring_result get_velocities(session *with) {
    return mspring_network_get_velocities(with->step->network, NULL, 0, with->step->particle_count, with->values,
                                          with->more_values, 1);
}

static mspring_result apply_forces(session *with) {
    return mspring_network_apply_forces(with->step->network, MSPRING_PUSH_STEP, NULL, 0, with->step->particle_count,
                                        with->values, with->more_values, 1);
}

static void prepare_forces(session *with) {
    for (uint32_t i = 0; i < with->step->particle_count; i++) {
        with->values[i] = with->more_values[i] = 0.5f;
    }
}

mspring_result session_restore(session *with) {
    return mspring_network_restore_springs(with->step->network, with->list, 0, with->burst, 0.0);
}

static mspring_result restore_ramped(session *with) {
    return mspring_network_restore_springs(with->step->network, with->list, 0, with->burst, 1.0);
}

static mspring_result break_burst(session *with) {
    return mspring_network_break_springs(with->step->network, with->list, 0, with->burst);
}

static void prepare_whole(session *with) {
    (void)!session_restore(with);
}

static void prepare_broken(session *with) {
    (void)!break_burst(with);
}

static mspring_result set_stiffnesses(session *with) {
    return mspring_network_set(with->step->network, MSPRING_STIFFNESS, with->list, 0, with->burst, with->values, 1);
}

static void prepare_stiffnesses(session *with) {
    for (uint32_t i = 0; i < with->burst; i++) {
        with->values[i] = 0.5f;
    }
}

static mspring_result set_all_stiffnesses(session *with) {
    return mspring_network_set(with->step->network, MSPRING_STIFFNESS, NULL, 0, with->step->spring_count,
                               with->by_spring[0], 1);
}

static void prepare_all_stiffnesses(session *with) {
    with->calls++;
    for (uint32_t i = 0; i < with->step->spring_count; i++) {
        with->by_spring[0][i] = 0.5f - 0.001f * (float)((i + with->calls) % 16);
    }
}

static void prepare_same_stiffnesses(session *with) {
    prepare_all_stiffnesses(with);
    (void)!set_all_stiffnesses(with);
}

static mspring_result update_components(session *with) {
    return mspring_network_update_components(with->step->network, NULL, NULL);
}

static void prepare_burst(session *with) {
    (void)!session_restore(with);
    (void)!update_components(with);
    (void)!break_burst(with);
}

static void prepare_few(session *with) {
    prepare_burst(with);
    (void)!update_components(with);
    (void)!mspring_network_restore_springs(with->step->network, with->list, 0, with->burst < 20 ? with->burst : 20,
                                           0.0);
}

static mspring_result measure_components(session *with) {
    mspring_body component = mspring_body_default();
    return mspring_network_get_components(with->step->network, 0, 1, &component);
}

static mspring_result get_strains(session *with) {
    return mspring_network_get(with->step->network, MSPRING_STRAIN, NULL, 0, with->step->spring_count,
                               with->by_spring[0], 1);
}

static mspring_result measure_energy(session *with) {
    mspring_energy energy = mspring_energy_default();
    return mspring_network_get_energy(with->step->network, &energy);
}

static mspring_result measure_body(session *with) {
    mspring_body body = mspring_body_default();
    return mspring_network_get_body(with->step->network, NULL, 0, MSPRING_ALL, &body);
}

static mspring_result get_report(session *with) {
    mspring_step_info info = mspring_step_info_default();
    return mspring_network_get_step_info(with->step->network, &info);
}

static mspring_result measure_columns(session *with) {
    const mspring_column columns[] = {{MSPRING_LENGTH, 1, with->by_spring[0]},
                                      {MSPRING_DIRECTION_X, 1, with->by_spring[1]},
                                      {MSPRING_DIRECTION_Y, 1, with->by_spring[2]},
                                      {MSPRING_STRAIN, 1, with->by_spring[3]}};
    return mspring_network_get_columns(with->step->network, NULL, 0, with->step->spring_count, columns, 4);
}

static mspring_result hash(session *with) {
    uint64_t sum;
    return mspring_network_get_state_hash(with->step->network, &sum);
}

static mspring_result save_frame(session *with) {
    return mspring_network_save(with->step->network, MSPRING_SNAPSHOT_FRAME, with->snapshot, with->snapshot_size,
                                NULL);
}

static void prepare_frame(session *with) {
    (void)!save_frame(with);
}

static mspring_result load_frame(session *with) {
    size_t size;
    mspring_result result = mspring_network_get_snapshot_size(with->step->network, MSPRING_SNAPSHOT_FRAME, &size);
    return result == MSPRING_OK ? mspring_network_load(with->step->network, with->snapshot, size) : result;
}

static mspring_result save_all(session *with) {
    return mspring_network_save(with->step->network, MSPRING_SNAPSHOT_ALL, with->snapshot, with->snapshot_size,
                                NULL);
}

static mspring_result MSPRING_CALL append(const void *bytes, size_t size, void *user) {
    session *with = user;
    if (size > with->snapshot_size - with->archive_size)
        return MSPRING_ERROR_LIMIT;
    memcpy((char *)with->snapshot + with->archive_size, bytes, size);
    with->archive_size += size;
    return MSPRING_OK;
}

static mspring_result write_archive(session *with) {
    with->archive_size = 0;
    return mspring_network_write(with->step->network, append, with);
}

static void forget_archive(session *with) {
    mspring_builder_destroy(with->builder);
    with->builder = NULL;
    (void)!mspring_builder_create(NULL, &with->builder);
}

static mspring_result read_archive(session *with) {
    return mspring_builder_read(with->builder, with->snapshot, with->archive_size, NULL);
}

static void prepare_archive(session *with) {
    (void)!write_archive(with);
    forget_archive(with);
}

static void prepare_builder(session *with) {
    prepare_archive(with);
    (void)!read_archive(with);
}

static mspring_result create_again(session *with) {
    mspring_network *made = NULL;
    const mspring_result result = mspring_network_create(with->builder, NULL, &made);
    mspring_network_destroy(made);
    return result;
}

const session_call session_calls[] = {
    {"read all positions", no_preparation, get_positions},
    {"write all positions", prepare_positions, set_positions},
    {"read all velocities", no_preparation, get_velocities},
    {"a force on every particle", prepare_forces, apply_forces},
    {"all masses", prepare_masses, set_masses},
    {"all scales of inverse mass", prepare_scales, set_scales},
    {"stiffness of 1,000 springs", prepare_stiffnesses, set_stiffnesses},
    {"stiffness of all springs", prepare_all_stiffnesses, set_all_stiffnesses},
    {"  unchanged", prepare_same_stiffnesses, set_all_stiffnesses},
    {"break 1,000 springs", prepare_whole, break_burst},
    {"restore 1,000 springs", prepare_broken, session_restore},
    {"restore 1,000 with a ramp", prepare_broken, restore_ramped},
    {"components after that", prepare_burst, update_components},
    {"components after 20 springs", prepare_few, update_components},
    {"mass, centre of a component", no_preparation, measure_components},
    {"strain of all springs", no_preparation, get_strains},
    {"  and length and direction", no_preparation, measure_columns},
    {"energies and extremes", no_preparation, measure_energy},
    {"all particles as a body", no_preparation, measure_body},
    {"report of the last step", no_preparation, get_report},
    {"hash of the state", no_preparation, hash},
    {"save a frame", no_preparation, save_frame},
    {"load a frame", prepare_frame, load_frame},
    {"save all", no_preparation, save_all},
    {"write an archive", no_preparation, write_archive},
    {"read an archive", prepare_archive, read_archive},
    {"  create its network", prepare_builder, create_again},
    {NULL, NULL, NULL},
};

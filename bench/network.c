/// @file network.c
/// A network of the library as a thing to be timed.
///
/// SPDX-License-Identifier: MIT
#include "network.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Largest starting velocity in x and y, m/s: far above rounding, far below what bends a spring visibly.
#define START_SPEED 0.05f

/// Force held on every particle where a scene asks for it, N: a thousandth of the weight of one of iron.
#define HELD_FORCE 0.7f

void bench_library_error(scene_error *error, const char *doing, mspring_result result, const char *message) {
    snprintf(error->text, sizeof error->text, "%s: %s%s%s", doing, mspring_result_string(result),
             message[0] != '\0' ? ": " : "", message);
}

void *bench_allocate(size_t count, size_t size, scene_error *error) {
    size_t bytes = (count * size + 63) / 64 * 64;
    void *memory = aligned_alloc(64, bytes > 0 ? bytes : 64);
    if (memory == NULL) {
        snprintf(error->text, sizeof error->text, "out of memory for %zu bytes: take a smaller scene", bytes);
    }
    return memory;
}

/// A number in -1 ... 1 that depends on index alone.
static float scatter(uint32_t index) {
    uint32_t bits = index * 2654435769u;
    bits = (bits ^ (bits >> 16)) * 2246822519u;
    bits ^= bits >> 13;
    return (float)(int32_t)(bits >> 8) / 8388608.0f - 1.0f;
}

static bool open_view(const bench_network *network, mspring_view *view, scene_error *error) {
    view->struct_size = sizeof *view;
    mspring_result result = mspring_network_get_view(network->network, view);
    if (result != MSPRING_OK) {
        bench_library_error(error, "viewing the network", result, "");
    }
    return result == MSPRING_OK;
}

static bool set_start_velocities(bench_network *network, scene_error *error) {
    mspring_view view;
    if (!open_view(network, &view, error)) {
        return false;
    }
    for (uint32_t i = 0; i < network->particle_count; i++) {
        bool pinned = !(view.inverse_mass[view.slot_of_particle[i]] > 0.0f);
        network->start_vx[i] = pinned ? 0.0f : START_SPEED * scatter(2 * i);
        network->start_vy[i] = pinned ? 0.0f : START_SPEED * scatter(2 * i + 1);
    }
    return true;
}

static bool reset(void *self, scene_error *error) {
    bench_network *network = self;
    uint32_t count = network->particle_count;
    mspring_result result =
        mspring_network_set_positions(network->network, NULL, 0, count, network->start_x, network->start_y, 1);
    if (result == MSPRING_OK) {
        result = mspring_network_set_velocities(network->network, NULL, 0, count, network->start_vx,
                                                network->start_vy, 1);
    }
    if (result == MSPRING_OK && network->straightens) {
        const float straight = 0;
        result = mspring_network_set(network->network, MSPRING_PLASTIC_STRAIN, NULL, 0, network->spring_count,
                                     &straight, 0);
    }
    if (result != MSPRING_OK) {
        bench_library_error(error, "setting the state", result, mspring_network_error(network->network));
        return false;
    }
    return true;
}

/// Save a frame, into more room if it takes that: forces and edits are saved, too.
static mspring_result save_frame(bench_network *network) {
    size_t size = 0;
    mspring_result result = mspring_network_get_snapshot_size(network->network, MSPRING_SNAPSHOT_FRAME, &size);
    if (result == MSPRING_OK && size > network->snapshot_size) {
        void *larger = realloc(network->snapshot, size);
        if (larger == NULL) {
            return MSPRING_ERROR_MEMORY;
        }
        network->snapshot = larger;
        network->snapshot_size = size;
    }
    return result == MSPRING_OK ? mspring_network_save(network->network, MSPRING_SNAPSHOT_FRAME, network->snapshot,
                                                       network->snapshot_size, NULL)
                                : result;
}

static bool run(void *self, uint32_t steps, scene_error *error) {
    bench_network *network = self;
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; i < steps && result == MSPRING_OK; i++) {
        if (network->held_x != NULL) {
            result = mspring_network_apply_forces(network->network, MSPRING_PUSH_STEP, NULL, 0,
                                                  network->particle_count, network->held_x, network->held_y, 1);
        }
        if (result == MSPRING_OK && network->saves_frames) {
            result = save_frame(network);
        }
        if (result == MSPRING_OK) {
            result = mspring_network_step(network->network, BENCH_DT);
        }
    }
    if (result != MSPRING_OK) {
        bench_library_error(error, "stepping the network", result, mspring_network_error(network->network));
        return false;
    }
    return true;
}

static bool create(mspring_builder *builder, mspring_simd level, const mspring_network_def *with, uint32_t substeps,
                   bench_network *out, scene_error *error) {
    mspring_network_def def;
    mspring_result result = mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def);
    if (result != MSPRING_OK) {
        bench_library_error(error, "preparing the network", result, "");
        return false;
    }
    def.simd_level = level;
    def.worker_count = with->worker_count;
    def.tasks = with->tasks;
    def.settings.substeps = substeps;
    def.flags = with->flags;
    def.settings.guard = MSPRING_GUARD_GROWTH;
    def.settings.global_damping = BENCH_GLOBAL_DAMPING;

    bench_network network = {.substeps = substeps};
    result = mspring_network_create(builder, &def, &network.network);
    if (result != MSPRING_OK) {
        bench_library_error(error, "creating the network", result, mspring_builder_error(builder));
        return false;
    }
    network.particle_count = mspring_network_count(network.network, MSPRING_PARTICLES);
    network.spring_count = mspring_network_count(network.network, MSPRING_SPRINGS);

    uint32_t count = network.particle_count;
    bool ok = (network.start_x = bench_allocate(count, sizeof *network.start_x, error)) != NULL &&
              (network.start_y = bench_allocate(count, sizeof *network.start_y, error)) != NULL &&
              (network.start_vx = bench_allocate(count, sizeof *network.start_vx, error)) != NULL &&
              (network.start_vy = bench_allocate(count, sizeof *network.start_vy, error)) != NULL &&
              set_start_velocities(&network, error);
    if (ok) {
        result =
            mspring_network_get_positions(network.network, NULL, 0, count, network.start_x, network.start_y, 1);
        if (result != MSPRING_OK) {
            bench_library_error(error, "reading positions", result, "");
            ok = false;
        }
    }
    if (!ok) {
        bench_network_free(&network);
        return false;
    }
    *out = network;
    return true;
}

bool bench_network_create(mspring_builder *builder, mspring_simd level, uint32_t workers, uint32_t substeps,
                          bench_network *out, scene_error *error) {
    return bench_network_create_with(builder, level, workers, substeps, 0, out, error);
}

bool bench_network_create_with(mspring_builder *builder, mspring_simd level, uint32_t workers, uint32_t substeps,
                               uint32_t flags, bench_network *out, scene_error *error) {
    return create(builder, level, &(mspring_network_def){.worker_count = workers, .flags = flags}, substeps, out,
                  error);
}

bool bench_network_create_on(mspring_builder *builder, mspring_simd level, const mspring_tasks *tasks,
                             uint32_t substeps, bench_network *out, scene_error *error) {
    return create(builder, level, &(mspring_network_def){.worker_count = 1, .tasks = tasks}, substeps, out, error);
}

void bench_network_free(bench_network *network) {
    mspring_network_destroy(network->network);
    free(network->start_x);
    free(network->start_y);
    free(network->start_vx);
    free(network->start_vy);
    free(network->held_x);
    free(network->held_y);
    free(network->snapshot);
    memset(network, 0, sizeof *network);
}

bool bench_network_hold_forces(bench_network *network, scene_error *error) {
    network->held_x = bench_allocate(network->particle_count, sizeof *network->held_x, error);
    network->held_y = bench_allocate(network->particle_count, sizeof *network->held_y, error);
    if (network->held_x == NULL || network->held_y == NULL) {
        return false;
    }
    for (uint32_t i = 0; i < network->particle_count; i++) {
        network->held_x[i] = HELD_FORCE * scatter(2 * i + 1);
        network->held_y[i] = HELD_FORCE * scatter(2 * i);
    }
    return true;
}

bench_runner bench_network_runner(bench_network *network) {
    return (bench_runner){.self = network, .reset = reset, .run = run};
}

static bool is_denormal(float value) {
    return value != 0.0f && fabsf(value) < FLT_MIN;
}

bool bench_network_check(const bench_network *network, scene_error *error) {
    mspring_view view;
    if (!open_view(network, &view, error)) {
        return false;
    }
    uint32_t denormal = 0;
    for (uint32_t i = 0; i < view.particle_count; i++) {
        uint32_t slot = view.slot_of_particle[i];
        if (!isfinite(view.x[slot]) || !isfinite(view.y[slot]) || !isfinite(view.vx[slot]) ||
            !isfinite(view.vy[slot])) {
            snprintf(error->text, sizeof error->text,
                     "the state of particle %u is not finite after the run: use more --substeps or less "
                     "--stiffness",
                     i);
            return false;
        }
        denormal += is_denormal(view.vx[slot]) || is_denormal(view.vy[slot]);
    }
    if (denormal > view.particle_count / 100) {
        snprintf(error->text, sizeof error->text,
                 "%u of %u particles have come to rest (denormal velocities), which falsifies the timing: use "
                 "less --damping",
                 denormal, view.particle_count);
        return false;
    }
    return true;
}

mspring_simd bench_level_of(const mspring_network *network) {
    mspring_network_info info = mspring_network_info_default();
    (void)mspring_network_get_info(network, &info);
    return info.simd_level;
}

size_t bench_memory_of(const mspring_network *network) {
    mspring_network_info info = mspring_network_info_default();
    (void)mspring_network_get_info(network, &info);
    return (size_t)info.memory_used;
}

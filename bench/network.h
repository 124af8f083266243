/// @file network.h
/// A network of the library and the naive network of the same particles and springs, as things to be timed.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_NETWORK_H
#define BENCH_NETWORK_H

#include <stdbool.h>
#include <stdint.h>

#include <massspring/massspring.h>

#include "naive.h"
#include "scenes/scene.h"
#include "turns.h"

/// Length of a step, s: what a game at 64 frames a second takes.
#define BENCH_DT (1.0 / 64.0)
/// Global damping of all bench networks, 1/s.
#define BENCH_GLOBAL_DAMPING 0.1f

typedef struct bench_network {
    mspring_network *network;
    uint32_t particle_count, spring_count, substeps;
    double *start_x, *start_y; ///< [particle_count] state that reset goes back to
    float *start_vx, *start_vy;
    float *held_x, *held_y; ///< [particle_count] forces given before every step, or NULL
    bool saves_frames;      ///< before every step
    bool straightens;       ///< what has yielded, where it goes back to its start
    void *snapshot;         ///< [snapshot_size] where to
    size_t snapshot_size;
} bench_network;

/// Make a network of a builder. Every particle that is not pinned gets a small velocity of its own, so that all of
/// it moves from the first step. On failure there is nothing to free.
bool bench_network_create(mspring_builder *builder, mspring_simd level, uint32_t workers, uint32_t substeps,
                          bench_network *out, scene_error *error);
/// The same with bits of MSPRING_NETWORK_.
bool bench_network_create_with(mspring_builder *builder, mspring_simd level, uint32_t workers, uint32_t substeps,
                               uint32_t flags, bench_network *out, scene_error *error);
/// The same with threads of a host.
bool bench_network_create_on(mspring_builder *builder, mspring_simd level, const mspring_tasks *tasks,
                             uint32_t substeps, bench_network *out, scene_error *error);
void bench_network_free(bench_network *network);

/// From now on, give every particle a force before every step.
bool bench_network_hold_forces(bench_network *network, scene_error *error);

/// Its timing: see turns.h.
bench_runner bench_network_runner(bench_network *network);

/// The instruction set that it runs on, and the bytes that it has allocated.
mspring_simd bench_level_of(const mspring_network *network);
size_t bench_memory_of(const mspring_network *network);

/// Refuse a state whose timing would mean nothing: numbers that are not finite, or velocities so small (denormal)
/// that the processor computes with them slowly.
bool bench_network_check(const bench_network *network, scene_error *error);

typedef struct bench_baseline {
    naive_network network;
    naive_particle *start; ///< [particle_count]
    uint32_t *place_of;    ///< [particle_count] where each is, once they are sorted; else NULL: where its id says
    uint32_t substeps;
    double origin_x, origin_y;
} bench_baseline;

/// Fill the naive network from the library's: particles and springs in the order of their ids, which is the order
/// in which the scene lists them, with the library's local origin. Steps and resets the library's network.
bool bench_baseline_create(bench_network *from, bench_baseline *out, scene_error *error);

/// Sort particles by where they are at the start, row by row, and springs likewise (nearby.c): the order that suits
/// the naive step best where that of the ids is a random one. Once for each baseline.
bool bench_baseline_sort(bench_baseline *baseline, scene_error *error);

void bench_baseline_free(bench_baseline *baseline);
bench_runner bench_baseline_runner(bench_baseline *baseline);
bool bench_baseline_check(const bench_baseline *baseline, scene_error *error);

/// Say that a call of the library failed: what was being done, the result and the object's message.
void bench_library_error(scene_error *error, const char *doing, mspring_result result, const char *message);

/// Memory for count items of size bytes, aligned to 64, or NULL with a message.
void *bench_allocate(size_t count, size_t size, scene_error *error);

#endif

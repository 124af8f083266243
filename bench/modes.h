/// @file modes.h
/// What the bench can do: one file each.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_MODES_H
#define BENCH_MODES_H

#include "network.h"
#include "options.h"

/// Measure scenes against the naive step (scenes.c), what features cost (features.c), what contact costs
/// (contact.c), what workers gain (workers.c), what more of them would gain (cores.c), what is done to a network
/// between its steps (session.c), a whole frame of a game (game.c), what the sparse direct solver costs (linear.c),
/// what steps of the implicit and the direct solver cost (solvers.c), how far they err (errors.c), how far from the machine's bounds the scenes
/// are (roofline.c), where networks are stable (map.c), one case of that (map_cases.c), how long the worst step
/// takes (map_frames.c), whether the guard refuses ordinary steps (alarms.c) and what it costs (guard.c), what a
/// floor and spare particles cost (spare.c), measure against other ways to write the loop (loops.c), or compare
/// positions with those of the naive step (check.c).
/// @return false if anything failed; messages have gone to stderr
bool bench_run_scenes(const bench_options *options);
bool bench_run_features(const bench_options *options);
bool bench_run_contact(const bench_options *options);
bool bench_run_workers(const bench_options *options);
bool bench_run_session(const bench_options *options);
bool bench_run_game(const bench_options *options);
bool bench_run_linear(const bench_options *options);
bool bench_run_solvers(const bench_options *options);
bool bench_run_errors(const bench_options *options);
bool bench_run_roofline(const bench_options *options);
bool bench_run_map(const bench_options *options);
bool bench_run_map_case(const bench_options *options);
bool bench_run_frames(const bench_options *options);
bool bench_run_alarms(const bench_options *options);
bool bench_run_guard(const bench_options *options);
bool bench_run_check(const bench_options *options);
bool bench_run_spare(const bench_options *options);
bool bench_run_cores(const bench_options *options);
bool bench_run_loops(const bench_options *options);

/// One scene at one level.
typedef struct bench_measurement {
    uint32_t particles, springs, substeps;
    mspring_simd level; ///< the one that ran
    bench_turns turns;  ///< first: the library; second: the naive step
    double ns;          ///< median, per spring and substep
    double bytes_per_particle;
} bench_measurement;

/// Measure one scene at one level against the naive step.
bool bench_measure(const bench_scene *subject, const bench_options *options, mspring_simd level,
                   bench_measurement *out, scene_error *error);

/// What is to be done with one scene. Prints its own messages.
typedef bool (*bench_visit_fn)(const bench_scene *subject, const bench_options *options, void *user);

/// Go through the scenes of the command line (or, if it names none, those given), making one after the other.
/// @return false if one could not be made or visit returned false for one; the others are visited all the same
bool bench_for_each_scene(const bench_options *options, const char *const *otherwise, bench_visit_fn visit,
                          void *user);

/// What is to be measured of one scene at one level. Prints its own messages.
typedef bool (*bench_level_fn)(const bench_scene *subject, const bench_options *options, mspring_simd level);

/// Go through the scenes likewise, and for each through the levels of the command line.
bool bench_for_each_level(const bench_options *options, const char *const *otherwise, bench_level_fn measure);

/// The table of implicit steps of any scene, a part of what solvers.c prints (implicit.c).
bool bench_print_implicit(const bench_options *options);

/// Print a message to stderr, after the program's name and what it is about.
void bench_complain(const char *about, const scene_error *error);

#endif

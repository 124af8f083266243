/// @file support.h
/// What the test programs share: checks that say what they saw, a random generator, short ways to make a network.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_SUPPORT_H
#define TEST_SUPPORT_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <setjmp.h>

#include <cmocka.h>
#include <massspring/massspring.h>

#include "readings.h"

#define COUNT_OF(array) (sizeof(array) / sizeof((array)[0]))

/// A number of rounds: a fifth of it where a sanitizer watches and makes each ten times as long, and in builds for
/// another system or without optimisation (TEST_IS_SLOW).
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(TEST_IS_SLOW)
#define ROUNDS(count) (((count) + 4) / 5)
#else
#define ROUNDS(count) (count)
#endif

/// True if a test is to sample long runs, as in the sets that each change and each push is judged by.
bool support_is_quick(void);

/// Whether rounds are few, so that a test may leave out what repeats itself.
#define ROUNDS_ARE_FEW (ROUNDS(5) < 5)

/// A number of rounds, of which such a test makes a quarter, unless they are few anyway.
#define SAMPLE(count) (ROUNDS_ARE_FEW ? ROUNDS(count) : support_is_quick() ? ((count) + 3) / 4 : (count))

/* ------------------------------------------------------------------------------------------------- checks */

/// The call succeeds.
#define check_ok(call) support_check_result((call), MSPRING_OK, #call, __FILE__, __LINE__)

/// The call fails with this code.
#define check_error(call, code) support_check_result((call), (code), #call, __FILE__, __LINE__)

/// A number lies within tolerance of what is expected. NaN never does.
#define check_near(actual, expected, tolerance)                                                                    \
    support_check_near((actual), (expected), (tolerance), #actual, __FILE__, __LINE__)

/// A message contains this text.
#define check_contains(text, part) support_check_contains((text), (part), __FILE__, __LINE__)

void support_check_result(mspring_result actual, mspring_result expected, const char *call, const char *file,
                          int line);
void support_check_near(double actual, double expected, double tolerance, const char *what, const char *file,
                        int line);
void support_check_contains(const char *text, const char *part, const char *file, int line);

/* ------------------------------------------------------------------------------------------------- random */

/// The next 64 random bits of a seed (SplitMix64): the same on every machine.
uint64_t support_random(uint64_t *seed);

/// A random number, low <= number < high.
double support_random_between(uint64_t *seed, double low, double high);

/* -------------------------------------------------------------------------------------------- environment */

/// Set a variable of the environment; NULL removes it.
void support_set_variable(const char *name, const char *value);

/// Memory aligned to 64 bytes, as the library's; fails the test if there is none.
void *support_aligned_alloc(size_t size);
void support_aligned_free(void *memory);

/* --------------------------------------------------------------------------------------- making a network */

mspring_builder *support_builder(void);

/// Add a particle at rest.
mspring_id support_particle(mspring_builder *builder, double x, double y, float mass);
mspring_id support_pinned(mspring_builder *builder, double x, double y, float mass);

/// Add a spring whose rest length is the distance of its ends.
mspring_id support_spring(mspring_builder *builder, mspring_id a, mspring_id b, float stiffness, float damping);
mspring_id support_join(mspring_builder *builder, mspring_id a, mspring_id b, float stiffness, float rest_length,
                        uint32_t flags);

/// Defaults with this gravity along y and this number of substeps, and the guard that rejects steps which would
/// grow.
mspring_network_def support_def(float gravity_y, uint32_t substeps);
/// The same guard, but one that takes steps of an implicit or direct solver which spend most_work.
mspring_guard support_guard_of(mspring_solver solver);

/// Make a network of a builder and destroy the builder.
mspring_network *support_network(mspring_builder *builder, const mspring_network_def *def);

/// Change one of the settings.
mspring_settings support_settings(const mspring_network *network);
mspring_result support_set_gravity(mspring_network *network, float x, float y);
mspring_result support_set_global_damping(mspring_network *network, float rate);
mspring_result support_set_guard(mspring_network *network, mspring_guard guard);
mspring_result support_set_relax_fraction(mspring_network *network, float fraction);

/// Step count times by dt; every step succeeds.
void support_steps(mspring_network *network, uint32_t count, double dt);

/// Add a hook with defaults for the rest.
mspring_result support_add_hook(mspring_network *network, mspring_phase phase, mspring_hook_fn fn, void *user,
                                uint32_t *hook);

/// Step by dt until everything sleeps.
void support_fall_asleep(mspring_network *network, double dt);

/// Give a particle a speed along x, m/s, and a third of it along y.
void support_kick(mspring_network *network, mspring_id particle, float speed);

/// Go on with a compaction by so many functions, with all for 0: one that is finished if it has come to its end,
/// and begun if there is none, or it is outdated.
/// @param job  NULL if there is none; NULL when the network is compact
void support_compact(mspring_network *network, uint32_t functions, mspring_job **job);

/* -------------------------------------------------------------------------------------- reading a network */

mspring_step_info support_step_info(const mspring_network *network);
uint32_t support_substeps(const mspring_network *network);
uint64_t support_fallback_count(const mspring_network *network);
mspring_settings support_solver(const mspring_network *network);
void support_set_residual(mspring_network *network, float residual);

typedef struct support_point {
    double x, y;
} support_point;

support_point support_position(const mspring_network *network, mspring_id particle);
/// Root mean square distance of the particles of two networks, m.
double support_distance(const mspring_network *a, const mspring_network *b);
support_point support_velocity(const mspring_network *network, mspring_id particle);
uint64_t support_hash(const mspring_network *network);

/// Have a network go on from where another one is, by a snapshot.
void support_bring(const mspring_network *from, mspring_network *to, mspring_snapshot_contents contents);
bool support_sleeps(const mspring_network *network, mspring_id particle);

/// What has been made of motion: kinetic and elastic energy, J.
double support_energy_of_motion(const mspring_network *network);

/// With what is potential.
double support_energy(const mspring_network *network);

/// Levels that this machine can run, worst (scalar) first. No kind of CPU has more than those up to AVX-512.
/// @return how many
uint32_t support_levels(mspring_simd levels[MSPRING_SIMD_AVX512]);

#endif

/// @file internal.h
/// What the makers of scenes share: messages, files, random numbers, pairs of particles.
///
/// SPDX-License-Identifier: MIT
#ifndef SCENES_INTERNAL_H
#define SCENES_INTERNAL_H

#include "scenes/number.h"
#include "scenes/scene.h"

#if defined(__MINGW32__) && !defined(__clang__)
#define SCENES_PRINTF(text, first) __attribute__((format(gnu_printf, text, first))) // printf: that of old Windows
#elif defined(__GNUC__)
#define SCENES_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define SCENES_PRINTF(text, first)
#endif

/* scene.c */

/// Write a message into error. Always returns false, so that a maker can return it.
bool scene_fail(scene_error *error, const char *format, ...) SCENES_PRINTF(2, 3);
/// The same for a failed library call on a builder.
bool scene_fail_builder(scene_error *error, const char *what, const mspring_builder *builder,
                        mspring_result result);
bool scene_fail_memory(scene_error *error, const char *what);
/// Start a scene: no probe, an empty builder.
bool scene_start(scene *out, scene_error *error);
/// Name a scene after a file: its base name without extension; what CSV or a file name cannot hold becomes '_'.
void scene_name_from_path(scene *out, const char *path);
/// Refuse options that no scene can have. from_file allows negative stiffness and damping.
bool scene_options_check(const scene_options *options, bool from_file, scene_error *error);

/* file.c */

/// Read a whole file, which the caller frees. Files over 1 GiB are refused.
bool file_read(const char *path, char **data, size_t *size, scene_error *error);

/* file_kind.c */

/// Whether a file that is to be read as a text network is something else, which the message then names.
bool scene_file_is_other(const char *path, const char *data, size_t size, scene_error *error);

/* random.c */

/// A stream of random numbers (splitmix64): the seed is the state.
uint64_t random_next(uint64_t *state);
/// Evenly distributed in 0 ... bound - 1.
uint32_t random_below(uint64_t *state, uint32_t bound);
/// Evenly distributed in 0 (included) to 1 (excluded).
double random_unit(uint64_t *state);

/* pair_set.c */

/// A set of unordered pairs of different particles, each with a note.
typedef struct pair_set {
    uint64_t *keys;
    uint64_t *notes;
    size_t capacity, count;
} pair_set;

typedef enum pair_added { PAIR_NEW, PAIR_PRESENT, PAIR_NO_MEMORY } pair_added;

/// Add a pair. If it is there already, *present receives its note and nothing changes.
pair_added pair_set_add(pair_set *set, mspring_id a, mspring_id b, uint64_t note, uint64_t *present);
void pair_set_free(pair_set *set);

#endif

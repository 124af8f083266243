/// @file internal.h
/// What the makers of scenes share: messages, files, numbers in text, random numbers, pairs of particles.
///
/// SPDX-License-Identifier: MIT
#ifndef SCENES_INTERNAL_H
#define SCENES_INTERNAL_H

#include "scenes/scene.h"

#if defined(__GNUC__)
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

/* number.c */

/// A piece of text that is not terminated by a 0.
typedef struct text_span {
    const char *start;
    size_t length;
} text_span;

/// Read a decimal number such as -1.5e3: no hexadecimal, no inf, no nan, nothing before or after it, and small
/// enough for a double. Returns false otherwise.
bool number_parse(text_span text, double *value);
/// Read a whole number without sign.
bool number_parse_count(text_span text, uint64_t *value);
/// Copy text into a message: cut to size - 1 characters, what cannot be printed as '?'. Returns buffer.
const char *text_quote(text_span text, char *buffer, size_t size);

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

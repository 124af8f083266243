/// @file catalogue.h
/// The scenes of the bench by name.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_CATALOGUE_H
#define BENCH_CATALOGUE_H

#include <stdbool.h>
#include <stdint.h>

#include "scenes/scene.h"

/// What the command line says about scenes.
typedef struct bench_scene_settings {
    const char *image;     ///< image of the ship scenes; NULL: the library's own ship
    const char *materials; ///< its colour table; NULL: the ship's own, for another image the built-in one
    float stiffness;       ///< fraction of the explicit limit; < 0: the default, in a network file the file's
    float damping;         ///< likewise; < 0: the default, in a network file the file's
    uint32_t ropes;        ///< added to every scene, besides those its name asks for; default 0
} bench_scene_settings;

/// Where a scene comes from.
typedef struct bench_source {
    const char *name; ///< one that bench_catalogue_print() lists, or its like in another size; or a path
    bool is_file;     ///< name is the path of a text network file
} bench_source;

typedef struct bench_scene {
    scene made;
    bench_source source; ///< to make it again with other settings
    char label[96];      ///< its name in results
} bench_scene;

/// Many equal bodies (copies.c): robots of 20 particles that are no lattice, lattices of side x side particles, and
/// such with 40 springs of a knight's move.
typedef enum bench_copies { BENCH_COPIES_ROBOTS, BENCH_COPIES_BLOCKS, BENCH_COPIES_BRACED } bench_copies;
bool bench_scene_copies(bench_copies kind, uint32_t side, uint32_t count, const scene_options *options, scene *out,
                        scene_error *error);

/// A lattice of which six cells of ten, chosen at random, are filled (noise.c).
bool bench_scene_noise(uint32_t columns, uint32_t rows, const scene_options *options, scene *out,
                       scene_error *error);

bool bench_scene_make(const bench_source *source, const bench_scene_settings *settings, bench_scene *out,
                      scene_error *error);

void bench_scene_free(bench_scene *unwanted);

/// Names of the scenes measured when none is asked for, ended by NULL; they take some seconds together.
const char *const *bench_catalogue_quick(void);

/// Names of the scenes checked against the baseline when none is asked for, ended by NULL; they need no file.
const char *const *bench_catalogue_checked(void);

void bench_catalogue_print(void);

/// Substeps and pairs of samples for a scene where the command line leaves them open.
uint32_t bench_default_substeps(uint32_t springs);
uint32_t bench_default_repeat(uint32_t springs);

#endif

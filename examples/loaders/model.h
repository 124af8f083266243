/// @file model.h
/// What a file says, before it is seen from the side: nodes in space and beams between them.
///
/// SPDX-License-Identifier: MIT
#ifndef LOADERS_MODEL_H
#define LOADERS_MODEL_H

#include <massspring/massspring.h>

#include "loaders/structure.h"
#include "scenes/internal.h"

/// Largest coordinate (m), mass (kg), stiffness (N/m) and damping (N s/m) that are taken from a file: sums of as
/// many as a file may hold stay within what a builder takes.
#define MODEL_MAX_COORDINATE 1e9
#define MODEL_MAX_VALUE 1e18
/// Smallest mass, kg.
#define MODEL_MIN_MASS 1e-9

typedef struct model_node {
    double at[3]; // m
    double mass;  // kg
    bool pinned;
} model_node;

typedef struct model_beam {
    uint32_t a, b;
    double stiffness, damping; // N/m, N s/m; of a relative model fractions
    double break_strain;       // 0: never
    double yield_strain;       // 0: never
    uint32_t side;             // MSPRING_SPRING_PULL_ONLY, MSPRING_SPRING_PUSH_ONLY or 0
    double rest;               // rest length over the distance of its ends, > 0
} model_beam;

typedef struct model {
    model_node *nodes;
    model_beam *beams;
    size_t node_count, node_capacity, beam_count, beam_capacity;
    structure_plane side; // which plane shows it from the side
    bool relative;        // stiffness and damping are fractions
    bool keeps_apart;     // nodes that coincide do not become one
    uint32_t substeps;    // as of structure
    tally used, ignored, notes;
} model;

/// Both return false when memory runs out, or when there are more than a network can have.
bool model_add_node(model *made, const model_node *node, scene_error *error);
bool model_add_beam(model *made, const model_beam *beam, scene_error *error);
double model_distance(const model *of, uint32_t a, uint32_t b);
/// The strain of a beam at which its spring has that force, N; 0 if it never has.
double model_strain_at(const model *of, const model_beam *beam, double force);
void model_free(model *unwanted);

/// Make room for one item more.
bool model_grow(void **items, size_t *capacity, size_t count, size_t size, scene_error *error);

/// The readers. They leave in made what was read until they fail; the caller frees it.
bool model_read_rigs_of_rods(const char *text, size_t length, const char *name, const structure_options *options,
                             model *made, scene_error *error);
bool model_read_jbeam(const char *text, size_t length, const char *name, const structure_options *options,
                      model *made, scene_error *error);
bool model_read_obj(const char *text, size_t length, const char *name, const structure_options *options,
                    model *made, scene_error *error);

/// See it in a plane.
bool model_project(const model *from, structure_plane plane, double merge_distance, structure *out,
                   scene_error *error);

#endif

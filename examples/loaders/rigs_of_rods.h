/// @file rigs_of_rods.h
/// What the parts of the reader of Rigs of Rods' files share.
///
/// SPDX-License-Identifier: MIT
#ifndef LOADERS_RIGS_OF_RODS_H
#define LOADERS_RIGS_OF_RODS_H

#include "loaders/lines.h"
#include "loaders/model.h"
#include "loaders/names.h"

/// What nodes get beside their position.
typedef struct ror_load {
    bool loaded;   ///< takes a share of the cargo
    double weight; ///< kg that it takes instead of a share, < 0: a share
} ror_load;

/// A wheel as a line gives it. Its nodes are made when all others are there.
typedef struct ror_wheel {
    uint32_t ends[2]; ///< of its axle
    uint32_t rays;
    double radius, mass, stiffness, damping;
} ror_wheel;

/// The camera in the cabin: a node that hangs between eight others.
typedef struct ror_camera {
    double at[3];
    uint32_t ends[8];
    double mass, stiffness, damping;
} ror_camera;

typedef struct ror_file {
    line_reader reader;
    const structure_options *options;
    model *made;
    name_table names;
    ror_load *loads; ///< by node
    ror_wheel *wheels;
    ror_camera *cameras;
    size_t load_capacity, wheel_count, wheel_capacity, camera_count, camera_capacity;
    double dry_mass, cargo_mass, minimum_mass;   // kg; dry mass < 0: not given
    double stiffness, damping, deform, strength; // set_beam_defaults: < 0: the program's own
    double stiffness_scale, damping_scale, deform_scale, strength_scale;
    ror_load node_default;
} ror_file;

/// A word that names a node.
bool ror_node(const ror_file *file, size_t word, uint32_t *node, scene_error *error);
/// A line of a wheel section: "wheels", "wheels2", "meshwheels", "meshwheels2" or "flexbodywheels".
bool ror_read_wheel(ror_file *file, const char *section, scene_error *error);
bool ror_is_wheel_section(const char *section);
/// Give the nodes their masses, then add cameras and wheels with theirs.
bool ror_finish(ror_file *file, scene_error *error);

#endif

/// @file structure.h
/// Structures from other programs' files, as particles and springs in a plane.
///
/// A file is read into a model (model.h): nodes in space, beams. Seen along one axis it becomes a structure: nodes
/// that coincide are merged with their masses, beams that lose their length are dropped, springs between the same
/// two particles are merged with their stiffness. A beam that leans out of the plane by an angle t counts with its
/// stiffness and damping times cos^2 t, which is what it does in the plane while its ends keep their depth.
///
/// All functions return true, or false with a message in error and nothing to free. Messages about a file begin
/// with its name, line and column.
///
/// SPDX-License-Identifier: MIT
#ifndef LOADERS_STRUCTURE_H
#define LOADERS_STRUCTURE_H

#include "loaders/tally.h"
#include "scenes/scene.h"

typedef enum structure_format {
    STRUCTURE_UNKNOWN,
    STRUCTURE_RIGS_OF_RODS, ///< .truck, .trailer and others of Rigs of Rods
    STRUCTURE_JBEAM,        ///< .jbeam of BeamNG
    STRUCTURE_OBJ,          ///< vertices and lines of a Wavefront OBJ
    STRUCTURE_SHIP ///< of Floating Sandbox, .shp, .shp2 or an image, whose colours a materials file explains
} structure_format;

/// Which two axes are seen, the second pointing up.
typedef enum structure_plane {
    STRUCTURE_PLANE_SIDE, ///< xy of Rigs of Rods and OBJ, yz of jbeam: what these programs call the side
    STRUCTURE_PLANE_XY,
    STRUCTURE_PLANE_XZ,
    STRUCTURE_PLANE_YZ
} structure_plane;

/// Fill with structure_options_default().
typedef struct structure_options {
    structure_plane plane; ///< default STRUCTURE_PLANE_SIDE
    double merge_distance; ///< m: nodes no farther apart in the plane are one; 1e-6 to 1000, default 0.001
    bool wheels;           ///< make wheels (Rigs of Rods); default true
    double mass;           ///< kg of each vertex (OBJ); default 1
    double stiffness;      ///< N/m of each line (OBJ); default 1e5
    double damping;        ///< N s/m of each line (OBJ); default 100
    const char *part;      ///< name of the part to load (jbeam); default NULL: the first that has nodes
    const char *materials; ///< path of the materials file (ships); default NULL: STRUCTURE_SHIP_MATERIALS beside it
    uint32_t substeps; ///< explicit substeps in 1/64 s that a ship's strength is for; default 40, as in the game
    bool dock;         ///< pin a ship's lowest row, and leave out what does not stand on it; default false
} structure_options;

/// What became of the file's contents.
typedef struct structure_report {
    uint32_t nodes, beams;    ///< of the model, what was made for wheels and cameras included
    uint32_t merged_nodes;    ///< that were one with an earlier one
    uint32_t dropped_beams;   ///< that lost their length
    uint32_t merged_springs;  ///< that join the same particles as an earlier one
    uint32_t loose_particles; ///< without any spring
    uint32_t pinned_particles;
    double mass;           ///< kg
    structure_plane plane; ///< the one seen: never STRUCTURE_PLANE_SIDE
    tally used;            ///< sections and their rows
    tally ignored;         ///< sections and their rows
    tally notes;           ///< what was simplified, and how often
} structure_report;

typedef struct structure {
    mspring_particle_def *particles; ///< [particle_count]
    mspring_spring_def *springs;     ///< [spring_count]
    float *break_strain;             ///< [spring_count], 0: never
    uint32_t particle_count, spring_count;
    uint32_t substeps; ///< explicit substeps in 1/64 s that it was made for; 0: any that are stable
    structure_report report;
} structure;

/// The name that the game gives to its materials.
#define STRUCTURE_SHIP_MATERIALS "structural_materials.json"

structure_options structure_options_default(void);
/// "xy", "xz" or "yz".
const char *structure_plane_name(structure_plane plane);
/// What the ending of a file's name says, in any case.
structure_format structure_format_of(const char *path);

/// Whether its ending is that of a ship, .shp or .shp2, rather than that of an image.
bool structure_is_ship(const char *path);

/// Load a file of the format that its name tells. With materials given, any image is a ship.
bool structure_load(const char *path, const structure_options *options, structure *out, scene_error *error);
/// The same from memory, for any format but ships; name stands for the path in messages.
bool structure_parse(structure_format format, const char *text, size_t length, const char *name,
                     const structure_options *options, structure *out, scene_error *error);

/// A file in memory; name stands for its path in messages.
typedef struct structure_bytes {
    const void *bytes;
    size_t length;
    const char *name;
} structure_bytes;

/// A ship from memory: .shp2 or an image, which may have another image for its ropes, or NULL. Refused where the
/// loaders were built without cJSON.
bool structure_parse_ship(const structure_bytes *ship, const structure_bytes *ropes,
                          const structure_bytes *materials, const structure_options *options, structure *out,
                          scene_error *error);

/// Size of the name of an image in a .shp file.
#define STRUCTURE_NAME_SIZE 256
/// The names of the images of a .shp file, in its own folder; of the ropes "" if there are none.
bool structure_ship_images(const structure_bytes *file, char cells[STRUCTURE_NAME_SIZE],
                           char ropes[STRUCTURE_NAME_SIZE], scene_error *error);
void structure_free(structure *unwanted);

/// Make a scene of it, without a probe; name is the path that the scene is named after.
bool structure_scene(const structure *from, const char *name, scene *out, scene_error *error);
/// Write it as a text network, which scene_network_file() reads. Break and yield strains and one-way springs have
/// no place there. If only some springs are relative, it is refused.
bool structure_write(const structure *from, const char *path, scene_error *error);

#endif

/// @file scene.h
/// The scenes that examples, tests and bench share: each is made in one place only.
///
/// A scene is a filled builder together with what its maker knows of it. All functions return true, or false
/// with a message for people in error (what happened, where, what to do) and nothing to free.
///
/// SPDX-License-Identifier: MIT
#ifndef SCENE_H
#define SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <massspring/massspring.h>

/// Mass of one particle of iron, kg.
#define SCENE_IRON_MASS 73.3975f
/// Stiffness of iron, N/m: half of the explicit limit at 30 substeps in 1/64 s.
#define SCENE_IRON_STIFFNESS 6.7643e7f

typedef struct scene_error {
    char text[512];
} scene_error;

typedef struct scene {
    char name[64]; ///< such as "bar_80x5"; for a file its base name without extension
    mspring_builder *builder;
    mspring_id probe;    ///< the particle whose drop is the bending, or MSPRING_NONE
    float *break_strain; ///< [springs] strain at which each breaks, 0: never; NULL if none ever does
    float *velocity;     ///< [particles][2] at first, m/s; NULL if all rest
} scene;

/// What the springs of a scene are like. Fill with scene_options_default().
typedef struct scene_options {
    float mass;      ///< kg per particle (scenes that are not files); default SCENE_IRON_MASS
    float stiffness; ///< N/m, or a fraction if relative; < 0 in files: the material's own. Default iron's;
                     ///< scene_options_from_file() gives -1
    float damping;   ///< N s/m, or a fraction if relative; < 0 in files: the material's own. Default 0 / -1
    bool relative;   ///< stiffness and damping are fractions (MSPRING_SPRING_RELATIVE); default false. If stiffness
                     ///< is given, damping < 0 means 0. If not, those of the materials are fractions, and those of
                     ///< network files that say so.
    double spacing;  ///< m; default 1
} scene_options;

scene_options scene_options_default(void);
/// The same with stiffness and damping left to the file's materials.
scene_options scene_options_from_file(void);

void scene_free(scene *unwanted);

/* shapes.c */

/// A full grid of columns x rows particles with all 8-neighbour springs, its leftmost column pinned, the probe at
/// its top right. Named "bar_<columns>x<rows>". At least 2 columns.
bool scene_bar(uint32_t columns, uint32_t rows, const scene_options *options, scene *out, scene_error *error);

/// A ring of columns particles around and rows deep with all 8-neighbour springs, its innermost row pinned, the
/// probe outermost on the right (wheel.c). Its spacing is that halfway out. Named "wheel_<columns>x<rows>". At
/// least 8 columns for each row.
bool scene_wheel(uint32_t columns, uint32_t rows, const scene_options *options, scene *out, scene_error *error);

/// A hanging rope: a horizontal chain of particles (at least 3), both ends pinned, the probe in its middle.
/// "rope_<particles>".
bool scene_rope(uint32_t particles, const scene_options *options, scene *out, scene_error *error);

/* meeting.c: bodies for contact, whose outlines keep 0.5 m apart */

/// Two hollow ships that sail at each other, without probe, for a network without gravity. "ships".
bool scene_ships(const scene_options *options, scene *out, scene_error *error);

/// Fragments of 1 to 20 particles and of masses 1:30 above a pit of pinned particles. No probe. "pile_<fragments>".
bool scene_pile(uint32_t fragments, const scene_options *options, scene *out, scene_error *error);

/// Soft discs above such a pit; mass, stiffness and damping are their own. No probe. "jellies_<jellies>".
bool scene_jellies(uint32_t jellies, const scene_options *options, scene *out, scene_error *error);

/* random_graph.c */

/// Particles at random places in a square (one per square spacing on average), each joined to about
/// neighbours / 2 of those after it that lie nearest, at rest; no grid in it. Particle 0 is pinned, no probe. The
/// same seed gives the same graph. "graph_<particles>".
bool scene_random_graph(uint32_t particles, uint32_t neighbours, uint64_t seed, const scene_options *options,
                        scene *out, scene_error *error);

/* random_ropes.c */

/// Add count ropes of segments springs each between pairs of particles chosen by seed, never two that a spring or
/// another of these ropes joins already. Mass, stiffness and damping of the ropes come from options.
bool scene_add_ropes(scene *target, uint32_t count, uint32_t segments, uint64_t seed, const scene_options *options,
                     scene_error *error);

/* file_kind.c */

/// Whether a file is to be read as an image rather than as a text network: by the ending of its name; if that says
/// nothing, by its first bytes.
bool scene_file_is_image(const char *path);

/* materials.c */

typedef struct scene_material {
    uint8_t red, green, blue;
    char name[32];
    float mass, stiffness, damping, break_strain; ///< break_strain 0: never
    bool pinned, probe;
} scene_material;

typedef struct scene_materials {
    scene_material *items;
    size_t count;
} scene_materials;

/// The built-in table: #0A0A0A pinned iron, #216CCF iron with the probe, #808090 iron. White is always empty.
bool scene_materials_builtin(scene_materials *out, scene_error *error);
/// Read a CSV file with the header colour,name,mass,stiffness,damping,break_strain,pinned,probe.
bool scene_materials_read(const char *path, scene_materials *out, scene_error *error);
/// The same from memory; name stands for the path in messages.
bool scene_materials_parse(const char *text, size_t length, const char *name, scene_materials *out,
                           scene_error *error);
void scene_materials_free(scene_materials *materials);

/* image_scene.c: an image is a lattice, a pixel a cell, its colour a material */

/// Read an image: PNM always; PNG and BMP where stb_image.h was found at build time. White and transparent
/// pixels are empty. At most one pixel may be a probe; without one, probe is MSPRING_NONE. A spring breaks at the
/// smaller of its two materials' break strains.
bool scene_image(const char *path, const scene_materials *materials, const scene_options *options, scene *out,
                 scene_error *error);
/// The same from memory; name stands for the path in messages and for the scene's name.
bool scene_image_parse(const void *bytes, size_t length, const char *name, const scene_materials *materials,
                       const scene_options *options, scene *out, scene_error *error);

/* network_file.c */

/// Read a plain text network: `P S`, then P lines `x y mass pinned probe`, then S lines
/// `a b rest stiffness damping`. `#` starts a comment. At most one particle may be a probe; without one, probe is
/// MSPRING_NONE.
bool scene_network_file(const char *path, const scene_options *options, scene *out, scene_error *error);
/// The same from memory; name stands for the path in messages and for the scene's name.
bool scene_network_parse(const char *text, size_t length, const char *name, const scene_options *options,
                         scene *out, scene_error *error);

#endif

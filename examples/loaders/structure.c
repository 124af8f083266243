/// @file structure.c
/// From a file of any format to a structure, and on to a scene.
///
/// SPDX-License-Identifier: MIT
#include "loaders/structure.h"
#include "loaders/model.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

structure_options structure_options_default(void) {
    structure_options options = {
        .plane = STRUCTURE_PLANE_SIDE,
        .merge_distance = 0.001,
        .wheels = true,
        .mass = 1,
        .stiffness = 1e5,
        .damping = 100,
        .substeps = 40,
    };
    return options;
}

const char *structure_plane_name(structure_plane plane) {
    switch (plane) {
    case STRUCTURE_PLANE_XY:
        return "xy";
    case STRUCTURE_PLANE_XZ:
        return "xz";
    case STRUCTURE_PLANE_YZ:
        return "yz";
    default:
        return "side";
    }
}

structure_format structure_format_of(const char *path) {
    static const struct {
        const char *ending;
        structure_format format;
    } endings[] = {
        {"truck", STRUCTURE_RIGS_OF_RODS},
        {"trailer", STRUCTURE_RIGS_OF_RODS},
        {"load", STRUCTURE_RIGS_OF_RODS},
        {"car", STRUCTURE_RIGS_OF_RODS},
        {"boat", STRUCTURE_RIGS_OF_RODS},
        {"train", STRUCTURE_RIGS_OF_RODS},
        {"airplane", STRUCTURE_RIGS_OF_RODS},
        {"machine", STRUCTURE_RIGS_OF_RODS},
        {"fixed", STRUCTURE_RIGS_OF_RODS},
        {"jbeam", STRUCTURE_JBEAM},
        {"obj", STRUCTURE_OBJ},
        {"shp", STRUCTURE_SHIP},
        {"shp2", STRUCTURE_SHIP},
        {"png", STRUCTURE_SHIP},
        {"bmp", STRUCTURE_SHIP},
        {"ppm", STRUCTURE_SHIP},
    };
    const char *dot = strrchr(path, '.');
    char ending[16] = "";
    if (!dot || strlen(dot + 1) >= sizeof ending)
        return STRUCTURE_UNKNOWN;
    for (size_t i = 0; dot[1 + i]; i++)
        ending[i] = (char)tolower((unsigned char)dot[1 + i]);
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (strcmp(ending, endings[i].ending) == 0)
            return endings[i].format;
    return STRUCTURE_UNKNOWN;
}

static bool check_options(const structure_options *options, scene_error *error) {
    if (!(options->merge_distance >= 1e-6 && options->merge_distance <= 1000))
        return scene_fail(error, "the merge distance is %g m: give one from 1e-6 to 1000", options->merge_distance);
    if (!(options->mass >= MODEL_MIN_MASS && options->mass <= MODEL_MAX_VALUE))
        return scene_fail(error, "the mass of a vertex is %g kg: give one from 1e-9 to 1e18", options->mass);
    if (!(options->stiffness >= 0 && options->stiffness <= MODEL_MAX_VALUE))
        return scene_fail(error, "the stiffness of a line is %g N/m: give one from 0 to 1e18", options->stiffness);
    if (!(options->damping >= 0 && options->damping <= MODEL_MAX_VALUE))
        return scene_fail(error, "the damping of a line is %g N s/m: give one from 0 to 1e18", options->damping);
    return true;
}

bool structure_parse(structure_format format, const char *text, size_t length, const char *name,
                     const structure_options *options, structure *out, scene_error *error) {
    model read = {0};
    bool ok = check_options(options, error);
    if (ok) {
        switch (format) {
        case STRUCTURE_RIGS_OF_RODS:
            ok = model_read_rigs_of_rods(text, length, name, options, &read, error);
            break;
        case STRUCTURE_JBEAM:
            ok = model_read_jbeam(text, length, name, options, &read, error);
            break;
        case STRUCTURE_OBJ:
            ok = model_read_obj(text, length, name, options, &read, error);
            break;
        default:
            ok = scene_fail(error, "%.200s: no format that structures can be read from", name);
        }
    }
    if (ok && read.node_count == 0)
        ok = scene_fail(error, "%.200s: there is no node in it", name);
    ok = ok && model_project(&read, options->plane, options->merge_distance, out, error);
    model_free(&read);
    return ok;
}

static bool read_bytes(const char *path, structure_bytes *made, scene_error *error) {
    char *bytes = NULL;
    if (!file_read(path, &bytes, &made->length, error))
        return false;
    made->bytes = bytes;
    made->name = path;
    return true;
}

static bool has_ending(const char *path, const char *ending) {
    const size_t length = strlen(path), last = strlen(ending);
    for (size_t i = 0; i < last; i++)
        if (length < last || tolower((unsigned char)path[length - last + i]) != ending[i])
            return false;
    return true;
}

bool structure_is_ship(const char *path) {
    return has_ending(path, ".shp") || has_ending(path, ".shp2");
}

// The path of a file beside another one.
static bool beside(const char *path, const char *name, char made[1024], scene_error *error) {
    size_t folder = 0;
    for (size_t i = 0; path[i]; i++)
        if (path[i] == '/' || path[i] == '\\')
            folder = i + 1;
    if (folder + strlen(name) >= 1024)
        return scene_fail(error, "%.200s: its path is too long", path);
    memcpy(made, path, folder);
    memcpy(made + folder, name, strlen(name) + 1);
    return true;
}

// A ship whose images are files of their own.
static bool load_images(const structure_bytes *file, const structure_bytes *materials,
                        const structure_options *options, structure *out, scene_error *error) {
    char names[2][STRUCTURE_NAME_SIZE], paths[2][1024];
    structure_bytes cells = {0}, ropes = {0};
    bool ok = structure_ship_images(file, names[0], names[1], error) &&
              beside(file->name, names[0], paths[0], error) && beside(file->name, names[1], paths[1], error) &&
              read_bytes(paths[0], &cells, error) && (!names[1][0] || read_bytes(paths[1], &ropes, error));
    ok = ok && structure_parse_ship(&cells, ropes.bytes ? &ropes : NULL, materials, options, out, error);
    free((void *)cells.bytes);
    free((void *)ropes.bytes);
    return ok;
}

static bool load_ship(const structure_bytes *file, const structure_options *options, structure *out,
                      scene_error *error) {
    char path[1024];
    structure_bytes materials = {0};
    if (!options->materials && !beside(file->name, STRUCTURE_SHIP_MATERIALS, path, error))
        return false;
    if (!read_bytes(options->materials ? options->materials : path, &materials, error))
        return scene_fail(
            error,
            "%.200s: the game's materials explain its colours: give them, or put " STRUCTURE_SHIP_MATERIALS
            " beside it",
            file->name);
    const bool ok = has_ending(file->name, ".shp")
                        ? load_images(file, &materials, options, out, error)
                        : structure_parse_ship(file, NULL, &materials, options, out, error);
    free((void *)materials.bytes);
    return ok;
}

bool structure_load(const char *path, const structure_options *options, structure *out, scene_error *error) {
    structure_format format = options->materials ? STRUCTURE_SHIP : structure_format_of(path);
    if (format == STRUCTURE_UNKNOWN)
        return scene_fail(error,
                          "%.200s: its name does not tell what it is: .truck, .trailer and others of Rigs of Rods, "
                          ".jbeam, .obj, and with a materials file .shp, .shp2 or an image can be read",
                          path);
    if (format == STRUCTURE_SHIP && !options->materials && !structure_is_ship(path))
        return scene_fail(error, "%.200s: an image needs the materials file that explains its colours", path);
    structure_bytes file = {0};
    if (!read_bytes(path, &file, error))
        return false;
    bool ok = format == STRUCTURE_SHIP
                  ? load_ship(&file, options, out, error)
                  : structure_parse(format, file.bytes, file.length, path, options, out, error);
    free((void *)file.bytes);
    return ok;
}

void structure_free(structure *unwanted) {
    free(unwanted->particles);
    free(unwanted->springs);
    free(unwanted->break_strain);
    memset(unwanted, 0, sizeof *unwanted);
}

bool structure_scene(const structure *from, const char *name, scene *out, scene_error *error) {
    if (!scene_start(out, error))
        return false;
    scene_name_from_path(out, name);
    mspring_result result =
        mspring_builder_add_particles(out->builder, from->particles, from->particle_count, NULL);
    if (result == MSPRING_OK)
        result = mspring_builder_add_springs(out->builder, from->springs, from->spring_count, NULL);
    bool ok = result == MSPRING_OK;
    if (!ok) {
        scene_fail_builder(error, "cannot build the structure", out->builder, result);
    } else if (from->spring_count > 0) {
        out->break_strain = malloc(from->spring_count * sizeof *out->break_strain);
        if (out->break_strain)
            memcpy(out->break_strain, from->break_strain, from->spring_count * sizeof *out->break_strain);
        else
            ok = scene_fail_memory(error, "cannot build the structure");
    }
    if (!ok)
        scene_free(out);
    return ok;
}

bool structure_write(const structure *from, const char *path, scene_error *error) {
    uint32_t relative = 0;
    for (uint32_t i = 0; i < from->spring_count; i++)
        relative += (from->springs[i].flags & MSPRING_SPRING_RELATIVE) != 0;
    if (relative > 0 && relative < from->spring_count)
        return scene_fail(error, "%.200s: in a text network all springs are relative, or none: here %u of %u are",
                          path, relative, from->spring_count);
    FILE *stream = fopen(path, "w");
    if (!stream)
        return scene_fail(error, "cannot write %.200s: %s", path, strerror(errno));
    fprintf(stream, "%u %u%s\n", from->particle_count, from->spring_count, relative ? " relative" : "");
    for (uint32_t i = 0; i < from->particle_count; i++) {
        const mspring_particle_def *particle = &from->particles[i];
        fprintf(stream, "%.17g %.17g %.9g %u 0\n", particle->x, particle->y, particle->mass,
                particle->flags & MSPRING_PARTICLE_PINNED);
    }
    for (uint32_t i = 0; i < from->spring_count; i++) {
        const mspring_spring_def *spring = &from->springs[i];
        fprintf(stream, "%u %u %.9g %.9g %.9g\n", spring->a, spring->b, spring->rest_length, spring->stiffness,
                spring->damping);
    }
    bool ok = !ferror(stream);
    if (fclose(stream) != 0 || !ok)
        return scene_fail(error, "cannot write %.200s: %s", path, strerror(errno));
    return true;
}

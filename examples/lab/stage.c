/// @file stage.c
/// Scenes from files, and the arrays of all scenes.
///
/// SPDX-License-Identifier: MIT
#include "lab/stage.h"
#include "data/pixels.h"
#include "draw/network_picture.h"
#include "lab/ready.h"
#include "lab/ship_materials.h"
#include "loaders/structure.h"
#include "scenes/image.h"
#include "scenes/internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Where a scene has no dampers, the slider's 1 is this part of critical damping of a single spring.
static const float made_up_damping = 0.02f;

/* ------------------------------------------------------------------------------------------------------- files */

static bool read_image(lab_stage *made, const char *path, bool relative, scene_error *error) {
    char *bytes = NULL;
    size_t length = 0;
    scene_materials tables[2] = {{0}};
    pixel_image image = {0};
    scene_error first = {""};
    const scene_options options = ready_options(relative, true);
    bool ok =
        file_read(path, &bytes, &length, error) && scene_materials_builtin(&tables[0], error) &&
        scene_materials_parse(ship_materials, strlen(ship_materials), "ship_materials.csv", &tables[1], error);
    // An image is in the colours of one table or of the other.
    if (ok && !scene_image_parse(bytes, length, path, &tables[0], &options, &made->made, &first))
        ok = scene_image_parse(bytes, length, path, &tables[1], &options, &made->made, error);
    if (ok && image_decode(bytes, length, path, &image, error)) {
        const size_t pixels = (size_t)image.width * image.height;
        const uint32_t most = mspring_builder_count(made->made.builder, MSPRING_PARTICLES);
        made->material = malloc(most * sizeof *made->material);
        uint32_t id = 0;
        for (size_t i = 0; made->material && i < pixels && id < most; i++) {
            const uint8_t *rgba = image.rgba + 4 * i;
            const lab_colour colour = (lab_colour)rgba[0] << 16 | (lab_colour)rgba[1] << 8 | rgba[2];
            if (rgba[3] != 0 && colour != PIXELS_EMPTY)
                made->material[id++] = colour;
        }
        image_free(&image);
    }
    scene_materials_free(&tables[0]);
    scene_materials_free(&tables[1]);
    free(bytes);
    return ok;
}

// A vehicle of another program, seen from the side.
static bool read_structure(lab_stage *made, const char *path, bool relative, scene_error *error) {
    structure read;
    const structure_options options = structure_options_default();
    if (!structure_load(path, &options, &read, error))
        return false;
    made->substeps = read.substeps;
    for (uint32_t i = 0; relative && read.substeps == 0 && i < read.spring_count; i++) {
        read.springs[i].flags = MSPRING_SPRING_RELATIVE;
        read.springs[i].stiffness = READY_RELATIVE_STIFFNESS;
        read.springs[i].damping = READY_RELATIVE_DAMPING;
    }
    const bool ok = structure_scene(&read, path, &made->made, error);
    structure_free(&read);
    return ok;
}

static bool read_file(lab_stage *made, const char *path, bool relative, scene_error *error) {
    const structure_format format = structure_format_of(path);
    if (format != STRUCTURE_UNKNOWN && (format != STRUCTURE_SHIP || structure_is_ship(path)))
        return read_structure(made, path, relative, error);
    const scene_options options = ready_options(relative, true);
    return scene_file_is_image(path) ? read_image(made, path, relative, error)
                                     : scene_network_file(path, &options, &made->made, error);
}

/* ------------------------------------------------------------------------------------------------ its arrays */

static bool allocate(lab_stage *made) {
    const size_t particles = made->particle_count, springs = made->spring_count ? made->spring_count : 1;
    made->x = malloc(particles * sizeof *made->x);
    made->y = malloc(particles * sizeof *made->y);
    made->mass = malloc(particles * sizeof *made->mass);
    made->pinned = malloc(particles * sizeof *made->pinned);
    made->a = malloc(springs * sizeof *made->a);
    made->b = malloc(springs * sizeof *made->b);
    made->rest = malloc(springs * sizeof *made->rest);
    made->stiffness = malloc(springs * sizeof *made->stiffness);
    made->damping = malloc(springs * sizeof *made->damping);
    made->yield_strain = malloc(springs * sizeof *made->yield_strain);
    made->long_springs = malloc(springs * sizeof *made->long_springs);
    return made->x && made->y && made->mass && made->pinned && made->a && made->b && made->rest &&
           made->stiffness && made->damping && made->yield_strain && made->long_springs;
}

static int compare_floats(const void *a, const void *b) {
    const float first = *(const float *)a, second = *(const float *)b;
    return first < second ? -1 : first > second;
}

// The rest length that a quarter of the springs do not exceed: in a grid the spacing, not the diagonal.
static double typical_spacing(const lab_stage *made) {
    if (made->spring_count == 0)
        return 1;
    float *sorted = malloc(made->spring_count * sizeof *sorted);
    if (!sorted)
        return made->rest[0];
    memcpy(sorted, made->rest, made->spring_count * sizeof *sorted);
    qsort(sorted, made->spring_count, sizeof *sorted, compare_floats);
    const double spacing = sorted[made->spring_count / 4];
    free(sorted);
    return spacing;
}

static void find_bounds(lab_stage *made) {
    const world_box first = {made->x[0], made->y[0], made->x[0], made->y[0]};
    const world_box box = world_box_add(first, made->x, made->y, made->particle_count);
    made->min_x = box.min_x;
    made->max_x = box.max_x;
    made->min_y = box.min_y;
    made->max_y = box.max_y;
}

// The particle that is farthest from the nearest pin, of some hundred.
static mspring_id far_from_pins(const lab_stage *made) {
    const uint32_t stride = made->particle_count / 400 + 1;
    mspring_id farthest = 0;
    double most = -1;
    for (uint32_t i = 0; i < made->particle_count; i += stride) {
        double nearest = 1e300;
        for (uint32_t p = 0; p < made->particle_count; p++) {
            const double x = made->x[p] - made->x[i], y = made->y[p] - made->y[i];
            if (made->pinned[p] && x * x + y * y < nearest)
                nearest = x * x + y * y;
        }
        if (nearest > most) {
            most = nearest;
            farthest = i;
        }
    }
    return farthest;
}

static bool read_network(lab_stage *made, const mspring_network *network) {
    const uint32_t particles = made->particle_count, springs = made->spring_count;
    mspring_view view = mspring_view_default();
    const bool ok =
        mspring_network_get_view(network, &view) == MSPRING_OK &&
        mspring_network_get_positions(network, NULL, 0, particles, made->x, made->y, 1) == MSPRING_OK &&
        mspring_network_get(network, MSPRING_MASS, NULL, 0, particles, made->mass, 1) == MSPRING_OK &&
        mspring_network_get_columns(
            network, NULL, 0, springs,
            (const mspring_column[]){{MSPRING_END_A, 1, made->a}, {MSPRING_END_B, 1, made->b}}, 2) == MSPRING_OK &&
        mspring_network_get(network, MSPRING_REST_LENGTH, NULL, 0, springs, made->rest, 1) == MSPRING_OK &&
        mspring_network_get(network, MSPRING_STIFFNESS, NULL, 0, springs, made->stiffness, 1) == MSPRING_OK &&
        mspring_network_get(network, MSPRING_DAMPING, NULL, 0, springs, made->damping, 1) == MSPRING_OK &&
        mspring_network_get(network, MSPRING_YIELD_STRAIN, NULL, 0, springs, made->yield_strain, 1) == MSPRING_OK;
    for (uint32_t i = 0; ok && i < particles; i++)
        made->pinned[i] = view.inverse_mass[view.slot_of_particle[i]] == 0;
    uint32_t flags = 0;
    if (ok && springs > 0 &&
        mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, 0, 1, &flags, 1) == MSPRING_OK)
        made->relative = made->relative || (flags & MSPRING_SPRING_RELATIVE) != 0;
    for (uint32_t i = 0; ok && i < springs; i++)
        made->has_damping = made->has_damping || made->damping[i] > 0;
    for (uint32_t i = 0; ok && i < springs; i++)
        made->yields = made->yields || made->yield_strain[i] < MSPRING_NEVER;
    return ok;
}

static void make_up_damping(lab_stage *made) {
    for (uint32_t i = 0; i < made->spring_count; i++) {
        const float a = made->mass[made->a[i]], b = made->mass[made->b[i]];
        made->damping[i] = made->relative ? READY_RELATIVE_DAMPING
                                          : made_up_damping * 2 * sqrtf(made->stiffness[i] * (a * b / (a + b)));
    }
}

static bool read_scene(lab_stage *made, scene_error *error) {
    mspring_network *network = NULL;
    mspring_builder *builder = made->made.builder;
    const mspring_result result = mspring_network_create(builder, NULL, &network);
    if (result != MSPRING_OK)
        return scene_fail_builder(error, made->made.name, builder, result);
    made->particle_count = mspring_network_count(network, MSPRING_PARTICLES);
    made->spring_count = mspring_network_count(network, MSPRING_SPRINGS);
    const bool ok = allocate(made) && read_network(made, network);
    mspring_network_destroy(network);
    if (!ok)
        return scene_fail_memory(error, "cannot show the scene");
    if (!made->has_damping)
        make_up_damping(made);
    find_bounds(made);
    for (uint32_t i = 0; i < made->particle_count; i++)
        made->has_pins = made->has_pins || made->pinned[i];
    // What is not held lies on the floor; else it is there to fall upon.
    made->floor_y = made->min_y - (made->has_pins ? 0.15 * (made->max_x - made->min_x) : 0);
    made->spacing = typical_spacing(made);
    for (uint32_t i = 0; i < made->spring_count; i++)
        if (made->rest[i] > 1.7 * made->spacing)
            made->long_springs[made->long_count++] = i;
    made->probe = made->made.probe != MSPRING_NONE ? made->made.probe : far_from_pins(made);
    return true;
}

bool stage_open(lab_stage *made, const char *name, bool relative, scene_error *error) {
    const ready_scene *ready = ready_find(name);
    lab_stage opened = {.relative = relative, .is_ready = ready != NULL, .gravity = 9.8};
    bool ok = ready ? ready->make(&opened, relative, error) : read_file(&opened, name, relative, error);
    if (ok && !read_scene(&opened, error)) {
        stage_free(&opened);
        ok = false;
    }
    if (!ok) {
        free(opened.material);
        return false;
    }
    *made = opened;
    return true;
}

void stage_free(lab_stage *unwanted) {
    scene_free(&unwanted->made);
    free(unwanted->x);
    free(unwanted->y);
    free(unwanted->mass);
    free(unwanted->pinned);
    free(unwanted->material);
    free(unwanted->a);
    free(unwanted->b);
    free(unwanted->rest);
    free(unwanted->stiffness);
    free(unwanted->damping);
    free(unwanted->yield_strain);
    free(unwanted->long_springs);
    memset(unwanted, 0, sizeof *unwanted);
}

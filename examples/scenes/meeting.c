/// @file meeting.c
/// Bodies that meet: two ships, a pile of fragments, a pit of jellies.
///
/// SPDX-License-Identifier: MIT
#include "scenes/internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <massspring/massspring.h>

// Particles of this mass are stable in 30 explicit substeps of 1/64 s with a margin.
static mspring_material material_of(float mass, const scene_options *options) {
    mspring_material made = mspring_material_default();
    made.mass = mass;
    made.stiffness = options->relative ? options->stiffness : options->stiffness * mass / options->mass;
    made.damping = options->relative ? options->damping : options->damping * mass / options->mass;
    made.spring_flags = options->relative ? MSPRING_SPRING_RELATIVE : 0;
    return made;
}

static bool add_lattice(scene *out, const mspring_lattice_def *lattice, scene_error *error) {
    const mspring_result result = mspring_builder_add_lattice(out->builder, lattice, NULL);
    return result == MSPRING_OK || scene_fail_builder(error, "cannot make a body", out->builder, result);
}

/* ------------------------------------------------------------------------------------------------------- ships */

enum { HULL_LENGTH = 96, HULL_HEIGHT = 34, DECK = 22, DECK_PITCH = 7, BULKHEAD_PITCH = 16, SKIN = 2 };

// Whether a ship that sails to the right is hollow or full at a place, counted from stern and keel.
static bool is_hull(int column, int row) {
    const double bow = HULL_LENGTH - 1 - 0.02 * (DECK - row) * (DECK - row) - 4, stern = 0.35 * (DECK - row);
    if (row > DECK) { // a bridge and a funnel
        const bool bridge = column >= 18 && column < 34 && row <= DECK + 7;
        const bool funnel = column >= 44 && column < 49;
        return bridge || funnel;
    }
    if (column < stern || column > bow)
        return false;
    const bool skin = column < stern + SKIN || column > bow - SKIN || row < SKIN || row > DECK - SKIN;
    return skin || row % DECK_PITCH < SKIN || column % BULKHEAD_PITCH < SKIN;
}

static bool add_ship(scene *out, bool faces_left, double x, double y, const mspring_material *steel,
                     scene_error *error) {
    static uint16_t cells[HULL_HEIGHT][HULL_LENGTH];
    for (int row = 0; row < HULL_HEIGHT; row++)
        for (int column = 0; column < HULL_LENGTH; column++) {
            const int along = faces_left ? HULL_LENGTH - 1 - column : column;
            cells[HULL_HEIGHT - 1 - row][column] = is_hull(along, row) ? 0 : MSPRING_CELL_EMPTY;
        }
    mspring_lattice_def hull = mspring_lattice_def_default();
    hull.width = HULL_LENGTH, hull.height = HULL_HEIGHT, hull.cells = cells[0];
    hull.materials = steel, hull.material_count = 1, hull.x = x, hull.y = y;
    return add_lattice(out, &hull, error);
}

static bool fill_ships(scene *out, const scene_options *options, scene_error *error) {
    const float speed = 30, break_strain = 0.02f;
    const mspring_material steel = material_of(options->mass, options);
    if (!add_ship(out, false, 0, 0, &steel, error))
        return false;
    const uint32_t first = mspring_builder_count(out->builder, MSPRING_PARTICLES);
    if (!add_ship(out, true, HULL_LENGTH + 8, -9, &steel, error))
        return false;
    const uint32_t particles = mspring_builder_count(out->builder, MSPRING_PARTICLES);
    const uint32_t springs = mspring_builder_count(out->builder, MSPRING_SPRINGS);
    out->velocity = calloc(2 * (size_t)particles, sizeof *out->velocity);
    out->break_strain = malloc(springs * sizeof *out->break_strain);
    if (!out->velocity || !out->break_strain)
        return scene_fail_memory(error, "cannot make the ships");
    for (uint32_t i = 0; i < particles; i++)
        out->velocity[2 * (size_t)i] = i < first ? speed : -0.3f * speed;
    for (uint32_t i = 0; i < springs; i++)
        out->break_strain[i] = break_strain;
    snprintf(out->name, sizeof out->name, "ships");
    return true;
}

/* --------------------------------------------------------------------------------------------------------- pit */

// Pinned particles, from wall to wall, and a floor that their springs close.
static bool add_pit(scene *out, int width, int height, const scene_options *options, scene_error *error) {
    mspring_material wall = material_of(options->mass, options);
    wall.particle_flags = MSPRING_PARTICLE_PINNED;
    uint16_t *cells = malloc((size_t)width * (size_t)height * sizeof *cells);
    if (!cells)
        return scene_fail_memory(error, "cannot make the pit");
    for (int row = 0; row < height; row++)
        for (int column = 0; column < width; column++)
            cells[row * width + column] =
                column == 0 || column == width - 1 || row == height - 1 ? 0 : MSPRING_CELL_EMPTY;
    mspring_lattice_def pit = mspring_lattice_def_default();
    pit.width = (uint32_t)width, pit.height = (uint32_t)height, pit.cells = cells;
    pit.materials = &wall;
    const bool ok = add_lattice(out, &pit, error);
    free(cells);
    return ok;
}

// A rectangle that may lack some of its corners.
static bool add_fragment(scene *out, uint64_t *seed, double x, double y, const scene_options *options,
                         scene_error *error) {
    enum { MOST = 5 };
    uint16_t cells[MOST * MOST] = {0};
    const uint32_t width = 1 + random_below(seed, MOST), height = 1 + random_below(seed, MOST - 1);
    const uint32_t corners[4] = {0, width - 1, (height - 1) * width, height * width - 1};
    for (int i = 0; width > 2 && height > 2 && i < 4; i++)
        cells[corners[i]] = random_below(seed, 2) ? MSPRING_CELL_EMPTY : 0;
    const float heavier = (float)pow(30, random_unit(seed) - 0.5); // 1:30
    const mspring_material material = material_of(heavier * options->mass, options);
    mspring_lattice_def fragment = mspring_lattice_def_default();
    fragment.width = width, fragment.height = height, fragment.cells = cells;
    fragment.materials = &material;
    fragment.x = x + random_unit(seed), fragment.y = y;
    return add_lattice(out, &fragment, error);
}

static bool fill_pile(scene *out, uint32_t count, const scene_options *options, scene_error *error) {
    enum { PITCH = 6, ACROSS = 24, WIDTH = PITCH * ACROSS + 2 };
    uint64_t seed = 23;
    const uint32_t rows = (count + ACROSS - 1) / ACROSS;
    bool ok = add_pit(out, WIDTH, 12 + (int)rows, options, error);
    for (uint32_t i = 0; ok && i < count; i++)
        ok = add_fragment(out, &seed, 1.2 + PITCH * (i % ACROSS), 3 + 5.0 * (i / ACROSS), options, error);
    snprintf(out->name, sizeof out->name, "pile_%u", count);
    return ok;
}

static bool fill_jellies(scene *out, uint32_t count, const scene_options *options, scene_error *error) {
    enum { PITCH = 9, ACROSS = 6, WIDTH = PITCH * ACROSS + 2 };
    const uint32_t rows = (count + ACROSS - 1) / ACROSS;
    bool ok = add_pit(out, WIDTH, 8 + (int)rows * 8, options, error);
    for (uint32_t i = 0; ok && i < count; i++) {
        mspring_material jelly_material = mspring_material_default();
        mspring_disc_def jelly = mspring_disc_def_default();
        jelly.material = &jelly_material;
        jelly.area_density = 1.0f;
        jelly.x = 5 + PITCH * (i % ACROSS) + 0.7 * (i / ACROSS % 2), jelly.y = 6 + PITCH * (double)(i / ACROSS);
        jelly.radius = 3.6, jelly.ring_count = 3;
        jelly.area_density = 60;
        jelly_material.spring_flags = MSPRING_SPRING_DAMPING_RATIO;
        jelly.young_modulus = 1e6f, jelly_material.damping = 0.1f;
        const mspring_result result = mspring_builder_add_disc(out->builder, &jelly, NULL, NULL);
        ok = result == MSPRING_OK || scene_fail_builder(error, "cannot make a jelly", out->builder, result);
    }
    snprintf(out->name, sizeof out->name, "jellies_%u", count);
    return ok;
}

/* --------------------------------------------------------------------------------------------- what others call */

static bool finish(bool ok, scene *out) {
    if (!ok)
        scene_free(out);
    return ok;
}

bool scene_ships(const scene_options *options, scene *out, scene_error *error) {
    return scene_options_check(options, false, error) && scene_start(out, error) &&
           finish(fill_ships(out, options, error), out);
}

bool scene_pile(uint32_t fragments, const scene_options *options, scene *out, scene_error *error) {
    if (fragments < 1 || fragments > 100000)
        return scene_fail(error, "a pile of %u fragments: give 1 to 100000", fragments);
    return scene_options_check(options, false, error) && scene_start(out, error) &&
           finish(fill_pile(out, fragments, options, error), out);
}

bool scene_jellies(uint32_t jellies, const scene_options *options, scene *out, scene_error *error) {
    if (jellies < 1 || jellies > 10000)
        return scene_fail(error, "a pit of %u jellies: give 1 to 10000", jellies);
    return scene_options_check(options, false, error) && scene_start(out, error) &&
           finish(fill_jellies(out, jellies, options, error), out);
}

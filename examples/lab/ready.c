/// @file ready.c
/// The ready scenes.
///
/// SPDX-License-Identifier: MIT
#include "lab/ready.h"
#include "data/pixels.h"
#include "data/ship.h"
#include "lab/ship_materials.h"
#include "scenes/internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <massspring/massspring.h>

scene_options ready_options(bool relative, bool from_file) {
    scene_options options = from_file ? scene_options_from_file() : scene_options_default();
    options.relative = relative;
    if (relative) {
        options.stiffness = READY_RELATIVE_STIFFNESS;
        options.damping = READY_RELATIVE_DAMPING;
    }
    return options;
}

// The steamer, drawn here and now: neither a file nor a reader for it is needed.
static bool make_ship(lab_stage *made, bool relative, scene_error *error) {
    enum { HEAD = 32 };
    const size_t pixels = (size_t)SHIP_WIDTH * SHIP_HEIGHT;
    char *bytes = malloc(HEAD + 3 * pixels);
    canvas drawn = {0};
    scene_materials materials = {0};
    const scene_options options = ready_options(relative, true);
    bool ok = bytes && canvas_make(&drawn, SHIP_WIDTH, SHIP_HEIGHT, PIXELS_EMPTY);
    if (!ok)
        scene_fail_memory(error, "cannot draw the ship");
    if (ok) {
        ship_draw(&drawn);
        const int head = snprintf(bytes, HEAD, "P6 %d %d 255\n", SHIP_WIDTH, SHIP_HEIGHT);
        memcpy(bytes + head, drawn.rgb, 3 * pixels);
        ok = scene_materials_parse(ship_materials, strlen(ship_materials), "ship_materials.csv", &materials,
                                   error) &&
             scene_image_parse(bytes, (size_t)head + 3 * pixels, "ship.ppm", &materials, &options, &made->made,
                               error);
        made->material = ok ? malloc(pixels * sizeof *made->material) : NULL;
        for (size_t i = 0, id = 0; made->material && i < pixels; i++) {
            const lab_colour colour = pixels_get(&drawn, (int)(i % SHIP_WIDTH), (int)(i / SHIP_WIDTH));
            if (colour != PIXELS_EMPTY)
                made->material[id++] = colour;
        }
        scene_materials_free(&materials);
        canvas_free(&drawn);
    }
    free(bytes);
    return ok;
}

// Particles on a line from pin to pin and a deck of a lattice under them, hung up by ropes.
static bool make_bridge(lab_stage *made, bool relative, scene_error *error) {
    enum { COLUMNS = 121, ROWS = 4, ROPES = 23, PITCH = 5, RISE = 34 };
    uint16_t cells[ROWS][COLUMNS] = {{0}};
    mspring_material materials[2];
    for (int i = 0; i < 2; i++) {
        materials[i] = mspring_material_default();
        materials[i].mass = 60;
        materials[i].stiffness = relative ? READY_RELATIVE_STIFFNESS : 3e7f;
        materials[i].damping = relative ? READY_RELATIVE_DAMPING : 3000;
        materials[i].spring_flags = relative ? MSPRING_SPRING_RELATIVE : 0;
    }
    materials[1].particle_flags = MSPRING_PARTICLE_PINNED;
    for (int row = 0; row < ROWS; row++)
        cells[row][0] = cells[row][COLUMNS - 1] = 1;
    mspring_id ids[ROWS][COLUMNS];
    mspring_lattice_def deck = mspring_lattice_def_default();
    deck.width = COLUMNS, deck.height = ROWS, deck.cells = cells[0], deck.materials = materials;
    deck.material_count = 2;
    if (!scene_start(&made->made, error))
        return false;
    mspring_builder *builder = made->made.builder;
    mspring_result result = mspring_builder_add_lattice(builder, &deck, ids[0]);
    // The main cable is a parabola of knots, from tower to tower; hangers go down from it.
    mspring_id knot = MSPRING_NONE;
    for (int i = 0; result == MSPRING_OK && i <= ROPES + 1; i++) {
        const double place = 2.0 * i / (ROPES + 1) - 1;
        mspring_particle_def particle = mspring_particle_def_default();
        particle.x = i * PITCH;
        particle.y = ROWS - 1 + 4 + (RISE - 4) * place * place;
        particle.mass = 60;
        particle.flags = i == 0 || i == ROPES + 1 ? MSPRING_PARTICLE_PINNED : 0;
        mspring_id here = MSPRING_NONE;
        result = mspring_builder_add_particles(builder, &particle, 1, &here);
        mspring_material rope_material = mspring_material_default();
        mspring_rope_def rope = mspring_rope_def_default();
        rope.material = &rope_material;
        rope_material.mass = 12, rope_material.stiffness = relative ? READY_RELATIVE_STIFFNESS : 1.2e7f;
        rope_material.damping = relative ? READY_RELATIVE_DAMPING : 800;
        rope_material.spring_flags = relative ? MSPRING_SPRING_RELATIVE : 0;
        if (result == MSPRING_OK && i > 0) {
            rope.from = knot, rope.to = here, rope.segment_count = 6;
            result = mspring_builder_add_rope(builder, &rope, NULL, NULL);
        }
        if (result == MSPRING_OK && i > 0 && i <= ROPES) {
            rope.from = here, rope.to = ids[0][i * PITCH];
            rope.segment_count = 2 + (uint32_t)(particle.y / 3);
            result = mspring_builder_add_rope(builder, &rope, NULL, NULL);
        }
        knot = here;
    }
    snprintf(made->made.name, sizeof made->made.name, "bridge");
    made->made.probe = ids[ROWS - 1][COLUMNS / 2];
    const uint32_t springs = mspring_builder_count(builder, MSPRING_SPRINGS);
    made->made.break_strain = malloc(springs * sizeof(float));
    for (uint32_t i = 0; made->made.break_strain && i < springs; i++)
        made->made.break_strain[i] = 0.12f;
    if (result == MSPRING_OK)
        return true;
    scene_fail_builder(error, "bridge", builder, result);
    scene_free(&made->made);
    return false;
}

// Bars of a lattice, one above the other, tied together and to the pins by ropes.
static bool make_net(lab_stage *made, bool relative, scene_error *error) {
    scene_options options = ready_options(relative, false);
    options.damping = relative ? READY_RELATIVE_DAMPING : 1400;
    if (!scene_bar(160, 16, &options, &made->made, error))
        return false;
    options.mass = 30;
    if (!relative)
        options.stiffness = 2e7f, options.damping = 800;
    if (!scene_add_ropes(&made->made, 60, 12, 7, &options, error)) {
        scene_free(&made->made);
        return false;
    }
    snprintf(made->made.name, sizeof made->made.name, "net");
    return true;
}

static bool make_bar(lab_stage *made, bool relative, scene_error *error) {
    const scene_options options = ready_options(relative, false);
    return scene_bar(80, 5, &options, &made->made, error);
}

static bool make_beam(lab_stage *made, bool relative, scene_error *error) {
    const scene_options options = ready_options(relative, false);
    return scene_bar(300, 40, &options, &made->made, error);
}

static bool make_rope(lab_stage *made, bool relative, scene_error *error) {
    const scene_options options = ready_options(relative, false);
    return scene_rope(120, &options, &made->made, error);
}

static bool make_graph(lab_stage *made, bool relative, scene_error *error) {
    const scene_options options = ready_options(relative, false);
    return scene_random_graph(3000, 8, 5, &options, &made->made, error);
}

static bool make_ships(lab_stage *made, bool relative, scene_error *error) {
    const scene_options options = ready_options(relative, false);
    made->collides = true;
    made->gravity = 0; // the water bears them
    return scene_ships(&options, &made->made, error);
}

static bool make_pile(lab_stage *made, bool relative, scene_error *error) {
    const scene_options options = ready_options(relative, false);
    made->collides = true;
    return scene_pile(150, &options, &made->made, error);
}

static bool make_jellies(lab_stage *made, bool relative, scene_error *error) {
    const scene_options options = ready_options(relative, false);
    made->collides = true;
    return scene_jellies(24, &options, &made->made, error);
}

const ready_scene ready_scenes[READY_COUNT] = {
    {"ship", make_ship}, {"bar", make_bar},         {"beam", make_beam},   {"bridge", make_bridge},
    {"net", make_net},   {"rope", make_rope},       {"graph", make_graph}, {"ships", make_ships},
    {"pile", make_pile}, {"jellies", make_jellies}, {"car", ready_car}};

const ready_scene *ready_find(const char *name) {
    for (int i = 0; i < READY_COUNT; i++)
        if (strcmp(ready_scenes[i].name, name) == 0)
            return &ready_scenes[i];
    return NULL;
}

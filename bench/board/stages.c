/// @file stages.c
/// Bars, a jelly, a truss and a ship, each held at one end and let go.
///
/// SPDX-License-Identifier: MIT
#include "board/stages.h"

#include <stdio.h>

#include "scenes/scene.h"

static bool make_bar(const stage *s, mspring_builder **builder, mspring_id *probe) {
    scene_options options = scene_options_default();
    scene made;
    scene_error error = {""};
    options.relative = false;
    options.stiffness = s->stiffness;
    options.mass = s->mass;
    options.damping = 0;
    options.spacing = s->spacing;
    if (!scene_bar(s->columns, s->rows, &options, &made, &error)) {
        fprintf(stderr, "massspring-board: %s\n", error.text);
        return false;
    }
    *builder = made.builder;
    *probe = made.probe;
    made.builder = NULL;
    scene_free(&made);
    return true;
}

static bool make_ship(const stage *s, mspring_builder **builder, mspring_id *probe) {
    const scene_options options = scene_options_from_file();
    scene_materials materials = {0};
    scene made;
    scene_error error = {""};
    const bool good = scene_materials_read(BENCH_DATA_DIR "/ship_materials.csv", &materials, &error) &&
                      scene_image(BENCH_DATA_DIR "/ship.png", &materials, &options, &made, &error);
    scene_materials_free(&materials);
    (void)s;
    if (!good) {
        fprintf(stderr, "massspring-board: %s\n", error.text);
        return false;
    }
    *builder = made.builder;
    *probe = made.probe;
    made.builder = NULL;
    scene_free(&made);
    return true;
}

static mspring_result add_bar(const stage *s, mspring_builder *builder, mspring_id a, mspring_id b, double length) {
    mspring_spring_def def;
    mspring_result result = mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def);
    def.a = a, def.b = b;
    def.stiffness = (float)(s->stiffness * s->spacing / length);
    return result ? result : mspring_builder_add_springs(builder, &def, 1, NULL);
}

// Bays of a chord below, one above, a post and a diagonal, all of one section.
static bool make_truss(const stage *s, mspring_builder **builder, mspring_id *probe) {
    mspring_particle_def joint;
    mspring_result result = mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &joint, sizeof joint);
    result = result ? result : mspring_builder_create(NULL, builder);
    joint.mass = s->mass;
    for (uint32_t i = 0; !result && i < 2 * s->columns; i++) {
        joint.flags = i < 2 ? MSPRING_PARTICLE_PINNED : 0;
        joint.x = i / 2 * s->spacing, joint.y = i % 2 * s->spacing;
        result = mspring_builder_add_particles(*builder, &joint, 1, probe);
    }
    for (mspring_id i = 2; !result && i < 2 * s->columns; i += 2) {
        result = add_bar(s, *builder, i - 2, i, s->spacing);
        result = result ? result : add_bar(s, *builder, i - 1, i + 1, s->spacing);
        result = result ? result : add_bar(s, *builder, i, i + 1, s->spacing);
        result = result ? result : add_bar(s, *builder, i - 1, i, 1.41421356 * s->spacing);
    }
    if (result)
        fprintf(stderr, "massspring-board: %s: %s\n", mspring_result_string(result),
                *builder ? mspring_builder_error(*builder) : "no builder");
    return result == MSPRING_OK;
}

const stage board_stages[STAGES] = {
    {"bar_80x5", "Bar of 80 x 5, 6.76e7 N/m", make_bar, 80, 5, 6.7643e7f, SCENE_IRON_MASS, 1, 65536, 20000, true},
    {"bar_80x5_stiff", "Bar of 80 x 5, 1e10 N/m", make_bar, 80, 5, 1e10f, SCENE_IRON_MASS, 1, 524288, 20000, true},
    {"jelly_10x10", "Jelly of 10 x 10, 200 N/m", make_bar, 10, 10, 200, 0.02f, 0.1, 16384, 20000, true},
    {"truss_17", "Truss of 16 bays, 1e8 N/m", make_truss, 17, 2, 1e8f, 50, 2, 131072, 20000, true},
    {"bar_272x34", "Bar of 272 x 34, 6.76e7 N/m", make_bar, 272, 34, 6.7643e7f, SCENE_IRON_MASS, 1, 16384, 20000,
     false},
    {"ship", "Ship of 157,962 springs", make_ship, 0, 0, 0, 0, 1, 16384, 60000, false},
};

bool stage_read(const stage *from, model *made) {
    mspring_builder *builder = NULL;
    mspring_id probe = 0;
    const bool good = from->make(from, &builder, &probe) && model_read(made, builder, probe);
    mspring_builder_destroy(builder);
    return good;
}

/// @file copies.c
/// Scenes of many equal bodies: robots that are no lattice, lattices, and lattices with braces.
///
/// SPDX-License-Identifier: MIT
#include "catalogue.h"

#include <massspring/massspring.h>

#include <math.h>
#include <stdio.h>

/// Particles and springs at each of a robot that is no lattice: 20 and about 55.
#define ROBOT_PARTICLES 20u
#define ROBOT_NEIGHBOURS 6u
#define ROBOT_SEED 7u

/// Springs that each braced lattice has besides.
#define MOST_BRACES 40u

static bool fail_builder(scene_error *error, const scene *of) {
    snprintf(error->text, sizeof error->text, "cannot make the copies: %s", mspring_builder_error(of->builder));
    return false;
}

/// Add springs of a knight's move to a lattice of side x side particles whose ids go row by row.
static bool add_braces(scene *model, uint32_t side, const scene_options *options, scene_error *error) {
    mspring_spring_def def;
    bool ok = mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def) == MSPRING_OK;
    def.stiffness = options->stiffness / 4;
    def.damping = options->damping;
    def.flags = MSPRING_SPRING_RELATIVE;
    uint32_t added = 0;
    for (uint32_t row = 0; ok && row + 1 < side; row++) {
        for (uint32_t column = 0; ok && column + 2 < side && added < MOST_BRACES; column++, added++) {
            def.a = row * side + column;
            def.b = def.a + side + 2;
            ok = mspring_builder_add_springs(model->builder, &def, 1, NULL) == MSPRING_OK;
        }
    }
    return ok || fail_builder(error, model);
}

/// Exchange a model's builder for one with copies of it in rows.
static bool copy_model(scene *model, double distance, uint32_t count, scene_error *error) {
    mspring_builder *one = model->builder;
    if (mspring_builder_create(NULL, &model->builder) != MSPRING_OK) {
        model->builder = one;
        return fail_builder(error, model);
    }
    const uint32_t columns = (uint32_t)ceil(sqrt(count));
    bool ok = true;
    for (uint32_t i = 0; ok && i < count; i++) {
        const double x = distance * (i % columns);
        const double y = distance * (double)(i / columns);
        ok = mspring_builder_add_copies(model->builder, one, 1, &x, &y, 1, NULL, NULL) == MSPRING_OK;
    }
    mspring_builder_destroy(one);
    return ok || fail_builder(error, model);
}

bool bench_scene_copies(bench_copies kind, uint32_t side, uint32_t count, const scene_options *options, scene *out,
                        scene_error *error) {
    if (count < 1) {
        snprintf(error->text, sizeof error->text, "no copies: give 1 or more");
        return false;
    }
    bool ok = kind == BENCH_COPIES_ROBOTS
                  ? scene_random_graph(ROBOT_PARTICLES, ROBOT_NEIGHBOURS, ROBOT_SEED, options, out, error)
                  : scene_bar(side, side, options, out, error);
    if (!ok) {
        return false;
    }
    ok = (kind != BENCH_COPIES_BRACED || add_braces(out, side, options, error)) &&
         copy_model(out, options->spacing * (side + 8), count, error);
    if (!ok) {
        scene_free(out);
    }
    return ok;
}

/// @file settle.c
/// Let a scene down onto a floor.
///
/// SPDX-License-Identifier: MIT
#include "load/settle.h"
#include "common/clock.h"
#include "draw/network_picture.h"
#include "scenes/internal.h"

#include <massspring/massspring.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    IMPLICIT_SUBSTEPS = 4, // in a frame
    MOST_WIDTH = 1200,
    MOST_HEIGHT = 700
};

static const double frame = 1.0 / 64;
static const double safety = 0.7; // of the longest stable substep
static const float drag = 0.5f;   // 1/s
static const float friction = 0.5f;
static const double burst = 1.5; // times its size: a structure that has flown apart

static bool fail(mspring_network *network, mspring_result result, const char *what, scene_error *error) {
    return scene_fail(error, "%s: %s: %s", what, mspring_result_string(result), mspring_network_error(network));
}

static bool draw(const network_shape *shape, mspring_network *network, const char *path, const char *title,
                 scene_error *error) {
    draw_error problem = {""};
    double *x = malloc(shape->particle_count * sizeof *x);
    double *y = malloc(shape->particle_count * sizeof *y);
    bool ok =
        x && y && mspring_network_get_positions(network, NULL, 0, shape->particle_count, x, y, 1) == MSPRING_OK;
    if (ok) {
        world_box box = world_box_add(network_shape_bounds(shape), x, y, shape->particle_count);
        double limit = network_strain_limit(shape, x, y);
        network_view view = network_view_fit(shape, box, MOST_WIDTH, MOST_HEIGHT, limit);
        figure drawn;
        figure_start(&drawn, view.width, view.height, 0xffffff);
        network_picture_draw(&drawn, shape, &view, x, y, title);
        ok = figure_write_png(&drawn, path, &problem);
        figure_free(&drawn);
        if (ok)
            printf("wrote %s\n", path);
        else
            scene_fail(error, "%s", problem.text);
    } else {
        scene_fail_memory(error, "cannot draw");
    }
    free(x);
    free(y);
    return ok;
}

static bool shape_of(mspring_network *network, network_shape *shape, scene_error *error) {
    draw_error problem = {""};
    return network_shape_make(shape, network, MSPRING_NONE, &problem) || scene_fail(error, "%s", problem.text);
}

bool settle_draw(scene *drawn, const char *path, scene_error *error) {
    mspring_network *network = NULL;
    network_shape shape;
    mspring_result result = mspring_network_create(drawn->builder, NULL, &network);
    if (result != MSPRING_OK)
        return scene_fail_builder(error, "cannot make the network", drawn->builder, result);
    bool ok = shape_of(network, &shape, error);
    if (ok) {
        ok = draw(&shape, network, path, drawn->name, error);
        network_shape_free(&shape);
    }
    mspring_network_destroy(network);
    return ok;
}

// path with _solver before its ending.
static void picture_path(const char *path, const char *solver, char made[1024]) {
    const char *dot = strrchr(path, '.');
    size_t length = dot && !strchr(dot, '/') ? (size_t)(dot - path) : strlen(path);
    snprintf(made, 1024, "%.*s_%s%s", (int)(length < 900 ? length : 900), path, solver,
             dot ? path + length : ".png");
}

static mspring_body body_of(const mspring_network *network) {
    mspring_body all = mspring_body_default();
    if (mspring_network_get_body(network, NULL, 0, MSPRING_ALL, &all) != MSPRING_OK)
        all.min_x = all.min_y = all.max_x = all.max_y = NAN;
    return all;
}

static bool start(mspring_network *network, mspring_solver solver, uint32_t substeps, scene_error *error) {
    mspring_floor_def ground = mspring_floor_def_default();
    mspring_settings settings = mspring_settings_default();
    ground.height_count = 1;
    ground.heights_y = body_of(network).min_y;
    ground.friction = friction;
    mspring_result result = mspring_network_set_floor(network, &ground);
    if (result == MSPRING_OK)
        result = mspring_network_get_settings(network, &settings);
    settings.solver = solver;
    settings.substeps = IMPLICIT_SUBSTEPS;
    if (result == MSPRING_OK && solver == MSPRING_SOLVER_EXPLICIT && substeps > 0)
        settings.substeps = substeps;
    else if (result == MSPRING_OK && solver == MSPRING_SOLVER_EXPLICIT)
        result = mspring_network_suggest_substeps(network, frame, safety, &settings.substeps);
    if (result == MSPRING_OK)
        result = mspring_network_set_settings(network, &settings);
    return result == MSPRING_OK || fail(network, result, "cannot set the solver", error);
}

static bool let_down(mspring_network *network, const char *name, const settle_request *request,
                     scene_error *error) {
    const mspring_body first = body_of(network);
    const double width = first.max_x - first.min_x, height = first.max_y - first.min_y;
    const int frames = (int)ceil(request->seconds / frame);
    const double began = clock_seconds();
    double most_energy = 0;
    mspring_energy energy = mspring_energy_default();
    for (int i = 0; i < frames; i++) {
        mspring_result result = mspring_network_step(network, frame);
        if (result != MSPRING_OK)
            return fail(network, result, name, error);
        if (mspring_network_get_energy(network, &energy) == MSPRING_OK && energy.kinetic > most_energy)
            most_energy = energy.kinetic;
    }
    const double spent = clock_seconds() - began;
    const mspring_body last = body_of(network);
    const double last_width = last.max_x - last.min_x;
    mspring_step_info info = mspring_step_info_default();
    (void)!mspring_network_get_step_info(network, &info);
    printf("%-10s %u substeps, %d frames of 1/64 s, %.3g ms each: top %.4g m lower, %.4g m wider, kinetic energy "
           "%.3g J (most %.3g), strain %.3g\n",
           name, info.substeps, frames, 1e3 * spent / frames, first.max_y - last.max_y, last_width - width,
           energy.kinetic, most_energy, fabs(energy.largest_strain));
    const double size = fmax(width, height);
    if (!(last_width <= burst * size && last.max_y - last.min_y <= burst * size))
        return scene_fail(error, "%s: it has flown apart", name);
    return true;
}

bool settle_run(scene *settled, mspring_solver solver, const settle_request *request, scene_error *error) {
    const char *name = solver == MSPRING_SOLVER_EXPLICIT ? "explicit" : "implicit";
    mspring_network_def def = mspring_network_def_default();
    mspring_network *network = NULL;
    network_shape shape;
    def.settings.global_damping = drag;
    def.settings.guard = MSPRING_GUARD_GROWTH;
    mspring_result result = mspring_network_create(settled->builder, &def, &network);
    if (result != MSPRING_OK)
        return scene_fail_builder(error, "cannot make the network", settled->builder, result);
    bool ok = start(network, solver, request->substeps, error) && shape_of(network, &shape, error);
    if (ok) {
        ok = let_down(network, name, request, error);
        if (ok && request->picture) {
            char path[1024];
            char title[128];
            picture_path(request->picture, name, path);
            snprintf(title, sizeof title, "%s, %s, after %g s", settled->name, name, request->seconds);
            ok = draw(&shape, network, path, title, error);
        }
        network_shape_free(&shape);
    }
    mspring_network_destroy(network);
    return ok;
}

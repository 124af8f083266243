/// @file 05_plan.c
/// How the library lays networks out: which springs it sweeps without any index, and which are left over.
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL // for mspring_network_describe()
#include "common/check.h"
#include "common/described.h"
#include "scenes/scene.h"

#include <massspring/massspring.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void print_header(void) {
    printf("%-16s %9s %9s | %8s %9s | %6s %8s | %9s %8s %6s | %5s %4s %5s | %7s %7s\n", "scene", "particles",
           "springs", "lattices", "springs", "chains", "springs", "irregular", "springs", "layers", "rows", "lag",
           "depth", "damping", "level");
}

static bool print_plan(const scene *planned) {
    mspring_network *network = NULL;
    mspring_network_info info = mspring_network_info_default();
    char text[DESCRIBED_SIZE];
    mspring_result result = mspring_network_create(planned->builder, NULL, &network);
    if (!check(result, "make the network", mspring_builder_error(planned->builder)))
        return false;
    result = mspring_network_get_info(network, &info);
    result = result ? result : mspring_network_describe(network, text, sizeof text, NULL);
    const bool ok = check(result, "read the plan", mspring_network_error(network));
    if (ok)
        printf("%-16s %9.0f %9.0f | %8.0f %9u | %6.0f %8u | %9.0f %8u %6.0f | %5.0f %4.0f %5.0f | %7s %7s\n",
               planned->name, described_number(text, "particle_count"), described_number(text, "spring_count"),
               described_number(text, "lattice_count"), (unsigned)info.lattice_springs,
               described_number(text, "chain_count"), (unsigned)info.chain_springs,
               described_number(text, "irregular_particles"), (unsigned)info.irregular_springs,
               described_number(text, "irregular_layers"), described_number(text, "pass_rows"),
               described_number(text, "pass_lag"), described_number(text, "pass_substeps"),
               described_number(text, "has_damping") > 0 ? "yes" : "no", mspring_simd_name(info.simd_level));
    mspring_network_destroy(network);
    return ok;
}

static bool make_scene(int index, scene *made, scene_error *error) {
    const scene_options options = scene_options_default();
    switch (index) {
    case 0:
        return scene_bar(80, 5, &options, made, error);
    case 1:
        return scene_bar(544, 68, &options, made, error);
    case 2:
        return scene_rope(1000, &options, made, error);
    case 3:
        return scene_random_graph(10000, 8, 1, &options, made, error);
    default:
        // A hull with rigging: its ropes are swept with the strips of rows that they hang on.
        if (!scene_bar(200, 40, &options, made, error))
            return false;
        snprintf(made->name, sizeof made->name, "bar with ropes");
        if (scene_add_ropes(made, 20, 30, 1, &options, error))
            return true;
        scene_free(made);
        return false;
    }
}

static bool read_scene(const char *path, scene *made, scene_error *error) {
    const scene_options options = scene_options_from_file();
    if (!scene_file_is_image(path))
        return scene_network_file(path, &options, made, error);
    scene_materials materials = {0};
    bool ok = scene_materials_builtin(&materials, error) && scene_image(path, &materials, &options, made, error);
    scene_materials_free(&materials);
    return ok;
}

static bool print_scene(bool made, scene *planned, const scene_error *error) {
    if (!made) {
        fprintf(stderr, "%s\n", error->text);
        return false;
    }
    bool ok = print_plan(planned);
    scene_free(planned);
    return ok;
}

int main(int count, char **arguments) {
    enum { SCENES = 5 };
    scene planned;
    scene_error error = {""};
    bool ok = true;
    if (count > 2 || (count == 2 && strcmp(arguments[1], "--help") == 0)) {
        printf("05_plan: how the library lays networks out.\n\n"
               "usage: %s [FILE]\n\nFILE is an image in the built-in colours, or a network (.msn, .txt).\n",
               arguments[0]);
        return count > 2 ? 2 : EXIT_SUCCESS;
    }
    print_header();
    if (count == 2)
        ok = print_scene(read_scene(arguments[1], &planned, &error), &planned, &error);
    for (int i = 0; count == 1 && ok && i < SCENES; i++)
        ok = print_scene(make_scene(i, &planned, &error), &planned, &error);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}

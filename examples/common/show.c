/// @file show.c
/// What small programs have in common: arguments, a film and a file.
///
/// SPDX-License-Identifier: MIT
#include "common/show.h"
#include "common/output.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_HEIGHT = 300 }; // of a frame, pixels

void show_begin(show *made, int count, char **arguments, const char *name, const char *about,
                const mspring_network *network, double strain_limit) {
    memset(made, 0, sizeof *made);
    made->name = name;
    made->about = about;
    made->folder = output_folder_from_arguments(count, arguments, about, &made->exit_code);
    if (!made->folder || !network)
        return;
    draw_error error = {""};
    made->is_ok = network_shape_make(&made->shape, network, MSPRING_NONE, &error) &&
                  film_start(&made->film, &made->shape, &error);
    if (!made->is_ok)
        fprintf(stderr, "%s: %s\n", name, error.text);
    made->film.strain_limit = strain_limit;
    made->film.most_height = MOST_HEIGHT;
}

void show_step(show *target, const mspring_network *network) {
    if (target->is_ok)
        film_step(&target->film, network);
}

static bool write_film(const show *ended) {
    char path[OUTPUT_PATH_SIZE];
    draw_error error = {""};
    if (!output_path(path, ended->folder, ended->name, ".png"))
        return false;
    const bool ok = film_write(&ended->film, path, ended->about, &error);
    if (ok)
        printf("written %s\n", path);
    else
        fprintf(stderr, "%s: %s\n", ended->name, error.text);
    return ok;
}

int show_end(show *ended, mspring_result result, mspring_builder *builder, mspring_network *network) {
    int exit_code = ended->exit_code;
    if (result != MSPRING_OK)
        fprintf(stderr, "%s: %s: %s%s\n", ended->name, mspring_result_string(result),
                mspring_builder_error(builder), mspring_network_error(network));
    if (ended->folder)
        exit_code = result == MSPRING_OK && ended->is_ok && write_film(ended) ? EXIT_SUCCESS : EXIT_FAILURE;
    film_free(&ended->film);
    network_shape_free(&ended->shape);
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
    return exit_code;
}

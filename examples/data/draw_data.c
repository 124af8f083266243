/// @file draw_data.c
/// Draw the images in this folder: three bars, a ship, and a boat in the formats of Floating Sandbox.
///
/// SPDX-License-Identifier: MIT
#include "data/boat.h"
#include "data/pixels.h"
#include "data/ship.h"
#include "draw/png.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const draw_colour pinned_iron = 0x0a0a0a;
static const draw_colour iron_probe = 0x216ccf;
static const draw_colour iron = 0x808090;

static bool write_ppm(const canvas *source, const char *path, draw_error *error) {
    FILE *stream = fopen(path, "wb");
    bool ok = stream != NULL;
    if (ok) {
        size_t size = (size_t)source->width * source->height * 3;
        fprintf(stream, "P6\n%u %u\n255\n", source->width, source->height);
        ok = fwrite(source->rgb, 1, size, stream) == size;
        ok = fclose(stream) == 0 && ok;
    }
    if (!ok)
        snprintf(error->text, sizeof error->text, "cannot write %.200s: %s", path, strerror(errno));
    return ok;
}

static bool write_image(const canvas *source, const char *folder, const char *name, bool as_ppm,
                        draw_error *error) {
    char path[1024];
    int length = snprintf(path, sizeof path, "%s/%s.%s", folder, name, as_ppm ? "ppm" : "png");
    if (length < 0 || (size_t)length >= sizeof path) {
        snprintf(error->text, sizeof error->text, "the folder's path is too long");
        return false;
    }
    return as_ppm ? write_ppm(source, path, error) : png_write(source, path, error);
}

// A bar, its leftmost column pinned, its top right pixel the probe.
static bool draw_bar(int columns, int rows, const char *folder, bool as_ppm, draw_error *error) {
    canvas picture = {0};
    char name[64];
    if (!canvas_make(&picture, (uint32_t)columns, (uint32_t)rows, iron)) {
        snprintf(error->text, sizeof error->text, "out of memory");
        return false;
    }
    pixels_box(&picture, 0, 0, 1, rows, pinned_iron);
    pixels_set(&picture, columns - 1, 0, iron_probe);
    snprintf(name, sizeof name, "bar_%dx%d", columns, rows);
    bool ok = write_image(&picture, folder, name, as_ppm, error);
    canvas_free(&picture);
    return ok;
}

static bool draw_ship(const char *folder, bool as_ppm, draw_error *error) {
    canvas picture = {0};
    if (!canvas_make(&picture, SHIP_WIDTH, SHIP_HEIGHT, PIXELS_EMPTY)) {
        snprintf(error->text, sizeof error->text, "out of memory");
        return false;
    }
    ship_draw(&picture);
    bool ok = write_image(&picture, folder, "ship", as_ppm, error);
    canvas_free(&picture);
    return ok;
}

static bool draw_boat(const char *folder, draw_error *error) {
    canvas cells = {0}, ropes = {0};
    char path[1024];
    bool ok = canvas_make(&cells, BOAT_WIDTH, BOAT_HEIGHT, PIXELS_EMPTY) &&
              canvas_make(&ropes, BOAT_WIDTH, BOAT_HEIGHT, PIXELS_EMPTY);
    if (ok) {
        boat_draw(&cells);
        boat_draw_ropes(&ropes);
        snprintf(path, sizeof path, "%s/boat.shp2", folder);
        ok = write_image(&cells, folder, "boat_structure", false, error) &&
             write_image(&ropes, folder, "boat_ropes", false, error) && boat_write_sections(&cells, path, error) &&
             boat_write_texts(folder, error);
    } else {
        snprintf(error->text, sizeof error->text, "out of memory");
    }
    canvas_free(&cells);
    canvas_free(&ropes);
    return ok;
}

int main(int count, char **arguments) {
    bool as_ppm = count == 3 && strcmp(arguments[1], "--ppm") == 0;
    if (count != 2 && !as_ppm) {
        fprintf(stderr, "usage: %s [--ppm] FOLDER\nDraws the examples' images as PNG, or as PPM, into a folder.\n",
                arguments[0]);
        return 2;
    }
    const char *folder = arguments[count - 1];
    draw_error error = {""};
    if (draw_bar(80, 5, folder, as_ppm, &error) && draw_bar(544, 68, folder, as_ppm, &error) &&
        draw_bar(1800, 5, folder, as_ppm, &error) && draw_ship(folder, as_ppm, &error) &&
        (as_ppm || draw_boat(folder, &error)))
        return EXIT_SUCCESS;
    fprintf(stderr, "%s: %s\n", arguments[0], error.text);
    return EXIT_FAILURE;
}

/// @file network_shape.c
/// What a picture keeps of a network.
///
/// SPDX-License-Identifier: MIT
#include "draw/internal.h"
#include "draw/network_picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double far_away = 1e6; // m: where lines that have no end are cut off

static bool allocate(network_shape *made, const mspring_floor_def *floor) {
    // One more of each, so that a network without springs does not ask for nothing.
    size_t springs = (size_t)made->spring_count + 1;
    size_t particles = (size_t)made->particle_count + 1;
    size_t lines = (size_t)floor->plane_count + floor->height_count + 1;
    made->a = malloc(springs * sizeof *made->a);
    made->b = malloc(springs * sizeof *made->b);
    made->rest_length = malloc(springs * sizeof *made->rest_length);
    made->flags = malloc(springs * sizeof *made->flags);
    made->x = malloc(particles * sizeof *made->x);
    made->y = malloc(particles * sizeof *made->y);
    made->pinned = malloc(particles * sizeof *made->pinned);
    made->floor = malloc(lines * sizeof *made->floor);
    return made->a && made->b && made->rest_length && made->flags && made->x && made->y && made->pinned &&
           made->floor;
}

static void add_line(network_shape *made, double x, double y, double x2, double y2) {
    double *line = made->floor[made->floor_count++];
    line[0] = x;
    line[1] = y;
    line[2] = x2;
    line[3] = y2;
}

// The borders of half-planes, and the heights with the level stretches beyond them.
static void read_floor(network_shape *made, const mspring_floor_def *floor) {
    for (uint32_t i = 0; i < floor->plane_count; i++) {
        const double *plane = &floor->planes[4 * (size_t)i];
        double far = far_away / hypot(plane[2], plane[3]);
        add_line(made, plane[0] - far * plane[3], plane[1] + far * plane[2], plane[0] + far * plane[3],
                 plane[1] - far * plane[2]);
    }
    double x = floor->heights_x - far_away;
    for (uint32_t i = 0; i < floor->height_count; i++) {
        double next = floor->heights_x + i * floor->spacing;
        double left = (double)floor->heights[i > 0 ? i - 1 : 0];
        add_line(made, x, floor->heights_y + left, next, floor->heights_y + (double)floor->heights[i]);
        x = next;
    }
    if (floor->height_count > 0) {
        double last = floor->heights_y + (double)floor->heights[floor->height_count - 1];
        add_line(made, x, last, x + far_away, last);
    }
}

static mspring_result read_network(network_shape *made, const mspring_network *network) {
    mspring_view view = mspring_view_default();
    mspring_result result = mspring_network_get_view(network, &view);
    for (uint32_t i = 0; result == MSPRING_OK && i < made->particle_count; i++)
        made->pinned[i] = view.inverse_mass[view.slot_of_particle[i]] == 0;
    const uint32_t springs = made->spring_count;
    if (result == MSPRING_OK)
        result = mspring_network_get_columns(
            network, NULL, 0, springs,
            (const mspring_column[]){{MSPRING_END_A, 1, made->a}, {MSPRING_END_B, 1, made->b}}, 2);
    if (result == MSPRING_OK)
        result = mspring_network_get(network, MSPRING_ACTIVE_REST_LENGTH, NULL, 0, springs, made->rest_length, 1);
    if (result == MSPRING_OK)
        result = mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, 0, springs, made->flags, 1);
    return result == MSPRING_OK
               ? mspring_network_get_positions(network, NULL, 0, made->particle_count, made->x, made->y, 1)
               : result;
}

bool network_shape_make(network_shape *made, const mspring_network *network, mspring_id probe, draw_error *error) {
    memset(made, 0, sizeof *made);
    made->particle_count = mspring_network_count(network, MSPRING_PARTICLES);
    made->spring_count = mspring_network_count(network, MSPRING_SPRINGS);
    made->probe = probe;
    mspring_floor_def floor = mspring_floor_def_default();
    mspring_result result = mspring_network_get_floor(network, &floor);
    if (result == MSPRING_OK && !allocate(made, &floor)) {
        network_shape_free(made);
        return draw_fail(error, "out of memory for a picture of %u springs",
                         mspring_network_count(network, MSPRING_SPRINGS));
    }
    if (result == MSPRING_OK)
        result = read_network(made, network);
    if (result != MSPRING_OK) {
        network_shape_free(made);
        return draw_fail(error, "cannot read the network for a picture: %s", mspring_result_string(result));
    }
    read_floor(made, &floor);
    return true;
}

void network_shape_free(network_shape *unwanted) {
    free(unwanted->a);
    free(unwanted->b);
    free(unwanted->rest_length);
    free(unwanted->flags);
    free(unwanted->x);
    free(unwanted->y);
    free(unwanted->pinned);
    free(unwanted->floor);
    memset(unwanted, 0, sizeof *unwanted);
}

world_box world_box_add(world_box box, const double *x, const double *y, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        box.min_x = fmin(box.min_x, x[i]);
        box.max_x = fmax(box.max_x, x[i]);
        box.min_y = fmin(box.min_y, y[i]);
        box.max_y = fmax(box.max_y, y[i]);
    }
    return box;
}

world_box network_shape_bounds(const network_shape *shape) {
    world_box box = {shape->x[0], shape->y[0], shape->x[0], shape->y[0]};
    return world_box_add(box, shape->x, shape->y, shape->particle_count);
}

static int compare_floats(const void *a, const void *b) {
    const float first = *(const float *)a;
    const float second = *(const float *)b;
    return (first > second) - (first < second);
}

double network_strain_limit(const network_shape *shape, const double *x, const double *y) {
    float *strains = malloc(((size_t)shape->spring_count + 1) * sizeof *strains);
    if (!strains || shape->spring_count == 0) {
        free(strains);
        return 1;
    }
    uint32_t whole = 0;
    strains[0] = 0;
    for (uint32_t i = 0; i < shape->spring_count; i++) {
        if (shape->flags[i] & MSPRING_SPRING_BROKEN)
            continue;
        double length = hypot(x[shape->b[i]] - x[shape->a[i]], y[shape->b[i]] - y[shape->a[i]]);
        strains[whole++] = (float)fabs(length / shape->rest_length[i] - 1);
    }
    qsort(strains, whole, sizeof *strains, compare_floats);
    float most = strains[whole > 0 ? (size_t)(0.995 * (whole - 1)) : 0];
    free(strains);
    // Below that the colours would show how positions are rounded.
    double limit = fmax(most, 1e-7);
    double half_step = 0.5 * pow(10, floor(log10(limit)));
    return ceil(limit / half_step) * half_step;
}

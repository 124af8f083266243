/// @file network_shape.c
/// What a picture keeps of a network.
///
/// SPDX-License-Identifier: MIT
#include "draw/internal.h"
#include "draw/network_picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool allocate(network_shape *made) {
    // One more of each, so that a network without springs does not ask for nothing.
    size_t springs = (size_t)made->spring_count + 1;
    size_t particles = (size_t)made->particle_count + 1;
    made->a = malloc(springs * sizeof *made->a);
    made->b = malloc(springs * sizeof *made->b);
    made->rest_length = malloc(springs * sizeof *made->rest_length);
    made->x = malloc(particles * sizeof *made->x);
    made->y = malloc(particles * sizeof *made->y);
    made->pinned = malloc(particles * sizeof *made->pinned);
    return made->a && made->b && made->rest_length && made->x && made->y && made->pinned;
}

static mspring_result read_network(network_shape *made, mspring_network *network) {
    mspring_view view = {.struct_size = sizeof view};
    mspring_result result = mspring_network_view(network, &view);
    if (result != MSPRING_OK)
        return result;
    for (uint32_t i = 0; i < made->particle_count; i++)
        made->pinned[i] = view.inverse_mass[view.slot_of_particle[i]] == 0;
    const uint32_t spring_count = made->spring_count;
    made->spring_count = 0;
    for (uint32_t i = 0; i < spring_count; i++) {
        mspring_spring_info info = {.struct_size = sizeof info};
        result = mspring_network_get_spring(network, i, &info);
        if (result != MSPRING_OK)
            return result;
        if (info.flags & MSPRING_SPRING_BROKEN)
            continue;
        made->a[made->spring_count] = info.a;
        made->b[made->spring_count] = info.b;
        made->rest_length[made->spring_count++] = info.rest_length;
    }
    return mspring_network_get_positions(network, 0, made->particle_count, made->x, made->y, 1);
}

bool network_shape_make(network_shape *made, mspring_network *network, mspring_id probe, draw_error *error) {
    memset(made, 0, sizeof *made);
    made->particle_count = mspring_network_particle_count(network);
    made->spring_count = mspring_network_spring_count(network);
    made->probe = probe;
    if (!allocate(made)) {
        network_shape_free(made);
        return draw_fail(error, "out of memory for a picture of %u springs", mspring_network_spring_count(network));
    }
    if (read_network(made, network) != MSPRING_OK) {
        network_shape_free(made);
        return draw_fail(error, "cannot read the network for a picture: %s", mspring_network_error(network));
    }
    return true;
}

void network_shape_free(network_shape *unwanted) {
    free(unwanted->a);
    free(unwanted->b);
    free(unwanted->rest_length);
    free(unwanted->x);
    free(unwanted->y);
    free(unwanted->pinned);
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
    for (uint32_t i = 0; i < shape->spring_count; i++) {
        double length = hypot(x[shape->b[i]] - x[shape->a[i]], y[shape->b[i]] - y[shape->a[i]]);
        strains[i] = (float)fabs(length / shape->rest_length[i] - 1);
    }
    qsort(strains, shape->spring_count, sizeof *strains, compare_floats);
    float most = strains[(size_t)(0.995 * (shape->spring_count - 1))];
    free(strains);
    // Below that the colours would show how positions are rounded.
    double limit = fmax(most, 1e-7);
    double half_step = 0.5 * pow(10, floor(log10(limit)));
    return ceil(limit / half_step) * half_step;
}

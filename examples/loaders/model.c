/// @file model.c
/// Nodes in space and beams between them.
///
/// SPDX-License-Identifier: MIT
#include "loaders/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool model_grow(void **items, size_t *capacity, size_t count, size_t size, scene_error *error) {
    if (count < *capacity)
        return true;
    size_t larger = *capacity ? 2 * *capacity : 64;
    void *moved = realloc(*items, larger * size);
    if (!moved)
        return scene_fail_memory(error, "cannot read the file");
    *items = moved;
    *capacity = larger;
    return true;
}

bool model_add_node(model *made, const model_node *node, scene_error *error) {
    if (made->node_count == MSPRING_MAX_PARTICLES)
        return scene_fail(error, "more than %u nodes: no network can have so many", MSPRING_MAX_PARTICLES);
    void *nodes = made->nodes;
    if (!model_grow(&nodes, &made->node_capacity, made->node_count, sizeof *node, error))
        return false;
    made->nodes = nodes;
    made->nodes[made->node_count++] = *node;
    return true;
}

bool model_add_beam(model *made, const model_beam *beam, scene_error *error) {
    if (made->beam_count == MSPRING_MAX_SPRINGS)
        return scene_fail(error, "more than %u beams: no network can have so many", MSPRING_MAX_SPRINGS);
    void *beams = made->beams;
    if (!model_grow(&beams, &made->beam_capacity, made->beam_count, sizeof *beam, error))
        return false;
    made->beams = beams;
    made->beams[made->beam_count++] = *beam;
    return true;
}

double model_distance(const model *of, uint32_t a, uint32_t b) {
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double d = of->nodes[a].at[i] - of->nodes[b].at[i];
        sum += d * d;
    }
    return sqrt(sum);
}

double model_strain_at(const model *of, const model_beam *beam, double force) {
    double length = model_distance(of, beam->a, beam->b);
    double strain = length > 0 && beam->stiffness > 0 ? force / (beam->stiffness * length) : 0;
    return strain <= MODEL_MAX_VALUE ? strain : 0;
}

void model_free(model *unwanted) {
    free(unwanted->nodes);
    free(unwanted->beams);
    memset(unwanted, 0, sizeof *unwanted);
}

/// @file random_graph.c
/// A network with no grid in it: random places, springs to the nearest.
///
/// SPDX-License-Identifier: MIT
#include "scenes/internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST_NEIGHBOURS = 64 };

// Particles sorted into square cells of one spacing: those of cell c are members[first[c]] ... in id order.
typedef struct cell_grid {
    uint32_t side;
    uint32_t *first;   // [side * side + 1]
    uint32_t *members; // [particles]
} cell_grid;

typedef struct places {
    double *x, *y; // in units of the spacing
    uint32_t count;
} place_list;

// A particle near another one.
typedef struct candidate {
    double distance;
    mspring_id id;
} candidate;

static size_t cell_of(const cell_grid *grid, double x, double y) {
    return (size_t)y * grid->side + (size_t)x;
}

static bool cell_grid_make(cell_grid *grid, const place_list *places, uint32_t side) {
    size_t cells = (size_t)side * side;
    grid->side = side;
    grid->first = calloc(cells + 2, sizeof *grid->first);
    grid->members = malloc(places->count * sizeof *grid->members);
    if (!grid->first || !grid->members)
        return false;
    // Counting sort, shifted by one place: filling a cell turns its start into the start of the next one.
    for (uint32_t i = 0; i < places->count; i++)
        grid->first[cell_of(grid, places->x[i], places->y[i]) + 2]++;
    for (size_t c = 2; c < cells + 2; c++)
        grid->first[c] += grid->first[c - 1];
    for (uint32_t i = 0; i < places->count; i++)
        grid->members[grid->first[cell_of(grid, places->x[i], places->y[i]) + 1]++] = i;
    return true;
}

static void cell_grid_free(cell_grid *grid) {
    free(grid->first);
    free(grid->members);
}

// Keeps the wanted nearest, sorted by distance. Returns how many there are now.
static uint32_t insert_candidate(candidate *nearest, uint32_t count, uint32_t wanted, candidate added) {
    if (count == wanted && added.distance >= nearest[count - 1].distance)
        return count;
    uint32_t place = count < wanted ? count++ : count - 1;
    while (place > 0 && nearest[place - 1].distance > added.distance) {
        nearest[place] = nearest[place - 1];
        place--;
    }
    nearest[place] = added;
    return count;
}

// The nearest particles with higher ids within reach cells.
static uint32_t find_nearest(const cell_grid *grid, const place_list *places, mspring_id id, uint32_t reach,
                             uint32_t wanted, candidate *nearest) {
    // Springs shorter than this would be so stiff for their length that single precision shows.
    const double too_near = 0.01;
    uint32_t count = 0;
    uint32_t cell_x = (uint32_t)places->x[id];
    uint32_t cell_y = (uint32_t)places->y[id];
    uint32_t low_x = cell_x > reach ? cell_x - reach : 0;
    uint32_t low_y = cell_y > reach ? cell_y - reach : 0;
    for (uint32_t y = low_y; y <= cell_y + reach && y < grid->side; y++) {
        for (uint32_t x = low_x; x <= cell_x + reach && x < grid->side; x++) {
            size_t cell = (size_t)y * grid->side + x;
            for (uint32_t i = grid->first[cell]; i < grid->first[cell + 1]; i++) {
                candidate found = {.id = grid->members[i]};
                if (found.id <= id)
                    continue;
                double dx = places->x[found.id] - places->x[id];
                double dy = places->y[found.id] - places->y[id];
                found.distance = sqrt(dx * dx + dy * dy);
                if (found.distance > too_near && found.distance <= reach)
                    count = insert_candidate(nearest, count, wanted, found);
            }
        }
    }
    return count;
}

static bool add_particles(scene *out, const place_list *places, const scene_options *options, scene_error *error) {
    for (uint32_t i = 0; i < places->count; i++) {
        mspring_particle_def def = mspring_particle_def_default();
        def.x = places->x[i] * options->spacing;
        def.y = places->y[i] * options->spacing;
        def.mass = options->mass;
        def.flags = i == 0 ? MSPRING_PARTICLE_PINNED : 0;
        mspring_result result = mspring_builder_add_particles(out->builder, &def, 1, NULL);
        if (result != MSPRING_OK)
            return scene_fail_builder(error, "cannot make the graph's particles", out->builder, result);
    }
    return true;
}

static bool add_springs(scene *out, const place_list *places, const cell_grid *grid, uint32_t neighbours,
                        const scene_options *options, scene_error *error) {
    uint32_t wanted = neighbours / 2 ? neighbours / 2 : 1;
    // A circle that holds about three times the neighbours: those with low ids find enough nearer by, those with
    // high ids take what is left instead of reaching across the whole square.
    uint32_t reach = (uint32_t)ceil(sqrt(neighbours)) + 1;
    mspring_spring_def def = mspring_spring_def_default();
    def.stiffness = options->stiffness;
    def.damping = options->damping;
    def.flags = options->relative ? MSPRING_SPRING_RELATIVE : 0;
    for (mspring_id i = 0; i < places->count; i++) {
        candidate nearest[MOST_NEIGHBOURS];
        uint32_t found = find_nearest(grid, places, i, reach, wanted, nearest);
        for (uint32_t j = 0; j < found; j++) {
            def.a = i;
            def.b = nearest[j].id;
            mspring_result result = mspring_builder_add_springs(out->builder, &def, 1, NULL);
            if (result != MSPRING_OK)
                return scene_fail_builder(error, "cannot make the graph's springs", out->builder, result);
        }
    }
    return true;
}

static bool add_graph(scene *out, const place_list *places, uint32_t side, uint32_t neighbours, uint64_t seed,
                      const scene_options *options, scene_error *error) {
    for (uint32_t i = 0; i < places->count; i++) {
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): it was asked for before
        places->x[i] = side * random_unit(&seed);
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): it was asked for before
        places->y[i] = side * random_unit(&seed);
    }
    snprintf(out->name, sizeof out->name, "graph_%u", places->count);
    cell_grid grid = {0};
    bool ok = cell_grid_make(&grid, places, side) || scene_fail_memory(error, "cannot make the graph");
    ok = ok && add_particles(out, places, options, error);
    ok = ok && add_springs(out, places, &grid, neighbours, options, error);
    cell_grid_free(&grid);
    return ok;
}

bool scene_random_graph(uint32_t particles, uint32_t neighbours, uint64_t seed, const scene_options *options,
                        scene *out, scene_error *error) {
    if (particles < 2 || particles > MSPRING_MAX_PARTICLES)
        return scene_fail(error, "a graph of %u particles: give 2 to %u", particles, MSPRING_MAX_PARTICLES);
    if (neighbours < 1 || neighbours > MOST_NEIGHBOURS)
        return scene_fail(error, "a graph of %u neighbours: give 1 to %d", neighbours, MOST_NEIGHBOURS);
    if (!scene_options_check(options, false, error))
        return false;
    place_list places = {.count = particles};
    places.x = malloc(particles * sizeof *places.x);
    places.y = malloc(particles * sizeof *places.y);
    bool ok = (places.x && places.y) || scene_fail_memory(error, "cannot make the graph");
    if (ok && (ok = scene_start(out, error))) {
        // One particle per cell on average.
        uint32_t side = (uint32_t)ceil(sqrt(particles));
        ok = add_graph(out, &places, side, neighbours, seed, options, error);
        if (!ok)
            scene_free(out);
    }
    free(places.x);
    free(places.y);
    return ok;
}

/// @file project.c
/// A model seen in a plane: what coincides becomes one.
///
/// SPDX-License-Identifier: MIT
#include "loaders/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A hash table of the particles made so far, by the square of the merge distance's size that they lie in.
typedef struct place_table {
    uint32_t *heads, *next; // particle + 1, 0: none
    size_t mask;
    double size;
} place_table;

// The shortest and longest rest length over distance that a beam's tension may lead to in the plane.
static const double least_rest = 0.1;
static const double most_rest = 10;

static const uint32_t one_sided = MSPRING_SPRING_PULL_ONLY | MSPRING_SPRING_PUSH_ONLY;

static size_t bucket_of(const place_table *table, int64_t column, int64_t row) {
    uint64_t state = (uint64_t)column * UINT64_C(0x9e3779b97f4a7c15) + (uint64_t)row;
    return (size_t)random_next(&state) & table->mask;
}

static int64_t square_of(const place_table *table, double coordinate) {
    return (int64_t)floor(coordinate / table->size);
}

// The first particle that is no farther than the merge distance, or MSPRING_NONE.
static uint32_t find_particle(const place_table *table, const structure *made, double x, double y) {
    int64_t column = square_of(table, x);
    int64_t row = square_of(table, y);
    uint32_t found = MSPRING_NONE;
    for (int64_t r = row - 1; r <= row + 1; r++) {
        for (int64_t c = column - 1; c <= column + 1; c++) {
            for (uint32_t i = table->heads[bucket_of(table, c, r)]; i; i = table->next[i - 1]) {
                // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): merge_nodes has filled it
                double dx = made->particles[i - 1].x - x;
                double dy = made->particles[i - 1].y - y;
                if (dx * dx + dy * dy <= table->size * table->size && i - 1 < found)
                    found = i - 1;
            }
        }
    }
    return found;
}

static void merge_nodes(const model *from, const int axes[2], place_table *table, uint32_t *particle_of,
                        structure *made) {
    for (size_t i = 0; i < from->node_count; i++) {
        const model_node *node = &from->nodes[i];
        double x = node->at[axes[0]];
        double y = node->at[axes[1]];
        uint32_t particle = from->keeps_apart ? MSPRING_NONE : find_particle(table, made, x, y);
        if (particle == MSPRING_NONE) {
            particle = made->particle_count++;
            mspring_particle_def *def = &made->particles[particle];
            *def = mspring_particle_def_default();
            def->x = x;
            def->y = y;
            def->mass = 0;
            size_t bucket = bucket_of(table, square_of(table, x), square_of(table, y));
            table->next[particle] = table->heads[bucket];
            table->heads[bucket] = particle + 1;
        } else {
            made->report.merged_nodes++;
        }
        made->particles[particle].mass += (float)node->mass;
        if (node->pinned)
            made->particles[particle].flags = MSPRING_PARTICLE_PINNED;
        made->report.mass += node->mass;
        particle_of[i] = particle;
    }
}

// What a beam is in the plane, while its ends keep their depth: F cos t along the spring for a change of length cos
// t.
static bool flatten_beam(const model *from, const model_beam *beam, mspring_id a, mspring_id b,
                         mspring_spring_def *def, float *break_strain, structure *made) {
    double in_space = model_distance(from, beam->a, beam->b);
    // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): merge_nodes has filled both
    double length = hypot(made->particles[a].x - made->particles[b].x, made->particles[a].y - made->particles[b].y);
    if (!(in_space > 0) || !(length > 0))
        return false;
    double cosine = length < in_space ? length / in_space : 1;
    double share = from->relative ? 1 : cosine * cosine;
    double rest = 1 - (1 - beam->rest) / share;
    if (!(rest >= least_rest && rest <= most_rest)) {
        rest = rest < least_rest ? least_rest : most_rest;
        tally_add_text(&made->report.notes, "springs whose tension was limited", 1);
    }
    *def = mspring_spring_def_default();
    def->a = a;
    def->b = b;
    def->flags = (from->relative ? MSPRING_SPRING_RELATIVE : 0u) | beam->side;
    def->stiffness = (float)(beam->stiffness * share);
    def->damping = (float)(beam->damping * share);
    def->rest_length = (float)(rest * length);
    *break_strain = (float)(beam->break_strain / share);
    float yield_strain = (float)fmin(beam->yield_strain / share, MSPRING_NEVER);
    if (yield_strain > 0)
        def->yield_strain = yield_strain;
    return true;
}

// Two springs side by side: forces add up. They act on one side only if both do, and yield only if both do.
static void merge_springs(mspring_spring_def *into, float *break_strain, const mspring_spring_def *other,
                          float other_break_strain) {
    double k = into->stiffness;
    double more = other->stiffness;
    if (k + more > 0) {
        into->rest_length = (float)((k * into->rest_length + more * other->rest_length) / (k + more));
        *break_strain = *break_strain == 0 || other_break_strain == 0
                            ? 0
                            : (float)((k * *break_strain + more * other_break_strain) / (k + more));
    }
    if (k + more > 0 && into->yield_strain < MSPRING_NEVER && other->yield_strain < MSPRING_NEVER)
        into->yield_strain = (float)((k * into->yield_strain + more * other->yield_strain) / (k + more));
    else
        into->yield_strain = MSPRING_NEVER;
    if ((into->flags ^ other->flags) & one_sided)
        into->flags &= ~one_sided;
    into->stiffness = (float)(k + more);
    into->damping += other->damping;
}

static bool add_springs(const model *from, const uint32_t *particle_of, pair_set *joined, structure *made,
                        scene_error *error) {
    for (size_t i = 0; i < from->beam_count; i++) {
        const model_beam *beam = &from->beams[i];
        mspring_id a = particle_of[beam->a];
        mspring_id b = particle_of[beam->b];
        mspring_spring_def def;
        float break_strain = 0;
        if (a == b || !flatten_beam(from, beam, a, b, &def, &break_strain, made)) {
            made->report.dropped_beams++;
            continue;
        }
        uint64_t twin = 0;
        switch (pair_set_add(joined, a, b, made->spring_count, &twin)) {
        case PAIR_NEW:
            made->break_strain[made->spring_count] = break_strain;
            made->springs[made->spring_count++] = def;
            break;
        case PAIR_PRESENT:
            if ((made->springs[twin].flags ^ def.flags) & one_sided)
                tally_add_text(&made->report.notes, "springs that only pull or push, taken as plain beside others",
                               1);
            merge_springs(&made->springs[twin], &made->break_strain[twin], &def, break_strain);
            made->report.merged_springs++;
            break;
        case PAIR_NO_MEMORY:
            return scene_fail_memory(error, "cannot merge the springs");
        }
    }
    return true;
}

static void count_particles(structure *made, bool *joined) {
    for (uint32_t i = 0; i < made->spring_count; i++)
        joined[made->springs[i].a] = joined[made->springs[i].b] = true;
    for (uint32_t i = 0; i < made->particle_count; i++) {
        made->report.loose_particles += !joined[i];
        made->report.pinned_particles += made->particles[i].flags & MSPRING_PARTICLE_PINNED;
    }
}

bool model_project(const model *from, structure_plane plane, double merge_distance, structure *out,
                   scene_error *error) {
    static const int all_axes[][2] = {
        [STRUCTURE_PLANE_XY] = {0, 1},
        [STRUCTURE_PLANE_XZ] = {0, 2},
        [STRUCTURE_PLANE_YZ] = {1, 2},
    };
    structure made = {0};
    if (plane == STRUCTURE_PLANE_SIDE)
        plane = from->side;
    made.report.plane = plane;
    made.substeps = from->substeps;
    made.report.nodes = (uint32_t)from->node_count;
    made.report.beams = (uint32_t)from->beam_count;
    made.report.used = from->used;
    made.report.ignored = from->ignored;
    made.report.notes = from->notes;

    size_t buckets = 16;
    while (buckets < from->node_count)
        buckets *= 2;
    place_table table = {.mask = buckets - 1, .size = merge_distance};
    table.heads = calloc(buckets, sizeof *table.heads);
    table.next = calloc(from->node_count + 1, sizeof *table.next);
    uint32_t *particle_of = malloc((from->node_count + 1) * sizeof *particle_of);
    bool *with_spring = calloc(from->node_count + 1, sizeof *with_spring);
    made.particles = malloc((from->node_count + 1) * sizeof *made.particles);
    made.springs = malloc((from->beam_count + 1) * sizeof *made.springs);
    made.break_strain = malloc((from->beam_count + 1) * sizeof *made.break_strain);
    bool ok = table.heads && table.next && particle_of && with_spring && made.particles && made.springs &&
              made.break_strain;
    if (ok) {
        pair_set joined = {0};
        merge_nodes(from, all_axes[plane], &table, particle_of, &made);
        ok = add_springs(from, particle_of, &joined, &made, error);
        pair_set_free(&joined);
        count_particles(&made, with_spring);
    } else {
        scene_fail_memory(error, "cannot merge the nodes");
    }
    free(table.heads);
    free(table.next);
    free(particle_of);
    free(with_spring);
    if (ok)
        *out = made;
    else
        structure_free(&made);
    return ok;
}

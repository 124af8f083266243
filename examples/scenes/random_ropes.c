/// @file random_ropes.c
/// Ropes across a scene that is there already: what a ship's rigging is to its hull.
///
/// SPDX-License-Identifier: MIT
#include "scenes/internal.h"

#include <stdlib.h>
#include <string.h>

#include <massspring/massspring.h>

// Pairs joined already: their note is not used.
static bool note_springs(const mspring_network *network, pair_set *joined) {
    const uint32_t count = mspring_network_count(network, MSPRING_SPRINGS);
    mspring_id(*ends)[2] = malloc((count + 1) * sizeof *ends);
    bool ok = ends && mspring_network_get_columns(network, NULL, 0, count,
                                                  (const mspring_column[]){{MSPRING_END_A, 2, &ends[0][0]},
                                                                           {MSPRING_END_B, 2, &ends[0][1]}},
                                                  2) == MSPRING_OK;
    for (mspring_id i = 0; ok && i < count; i++) {
        uint64_t present = 0;
        ok = pair_set_add(joined, ends[i][0], ends[i][1], 0, &present) != PAIR_NO_MEMORY;
    }
    free(ends);
    return ok;
}

// Two particles that nothing joins and that do not lie in the same place.
static bool choose_ends(const mspring_network *network, pair_set *joined, uint64_t *seed, mspring_rope_def *rope,
                        scene_error *error) {
    enum { TRIES = 1000 };
    uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES);
    for (int try = 0; try < TRIES; try++) {
        rope->from = random_below(seed, particles);
        rope->to = random_below(seed, particles);
        double from_x, from_y, to_x, to_y;
        if (mspring_network_get_positions(network, NULL, rope->from, 1, &from_x, &from_y, 1) != MSPRING_OK ||
            mspring_network_get_positions(network, NULL, rope->to, 1, &to_x, &to_y, 1) != MSPRING_OK)
            return scene_fail(error, "cannot read positions: %s", mspring_network_error(network));
        if (from_x == to_x && from_y == to_y)
            continue;
        uint64_t present = 0;
        switch (pair_set_add(joined, rope->from, rope->to, 0, &present)) {
        case PAIR_NEW:
            return true;
        case PAIR_PRESENT:
            break;
        case PAIR_NO_MEMORY:
            return scene_fail_memory(error, "cannot add ropes");
        }
    }
    return scene_fail(error,
                      "found no two particles to tie a rope to in %d tries: %u particles are too few or "
                      "joined already; ask for fewer ropes",
                      TRIES, particles);
}

static bool add_ropes(scene *target, const mspring_network *network, uint32_t count, uint32_t segments,
                      uint64_t seed, const scene_options *options, scene_error *error) {
    mspring_material rope_material = mspring_material_default();
    mspring_rope_def rope = mspring_rope_def_default();
    rope.material = &rope_material;
    rope.segment_count = segments;
    rope_material.mass = options->mass;
    rope_material.stiffness = options->stiffness;
    rope_material.damping = options->damping;
    rope_material.spring_flags = options->relative ? MSPRING_SPRING_RELATIVE : 0;
    pair_set joined = {0};
    bool ok = note_springs(network, &joined) || scene_fail_memory(error, "cannot add ropes");
    for (uint32_t i = 0; ok && i < count; i++) {
        ok = choose_ends(network, &joined, &seed, &rope, error);
        if (!ok)
            break;
        mspring_result result = mspring_builder_add_rope(target->builder, &rope, NULL, NULL);
        if (result != MSPRING_OK)
            ok = scene_fail_builder(error, "cannot add a rope", target->builder, result);
    }
    pair_set_free(&joined);
    return ok;
}

bool scene_add_ropes(scene *target, uint32_t count, uint32_t segments, uint64_t seed, const scene_options *options,
                     scene_error *error) {
    if (segments < 1)
        return scene_fail(error, "a rope of 0 springs: give at least 1");
    uint32_t springs = mspring_builder_count(target->builder, MSPRING_SPRINGS);
    if ((uint64_t)count * segments > MSPRING_MAX_SPRINGS - springs)
        return scene_fail(error, "%u ropes of %u springs on top of %u springs: at most %u are possible", count,
                          segments, springs, MSPRING_MAX_SPRINGS);
    if (!scene_options_check(options, false, error))
        return false;
    if (target->break_strain) {
        size_t all = springs + (size_t)count * segments;
        float *larger = realloc(target->break_strain, all * sizeof *larger);
        if (!larger)
            return scene_fail_memory(error, "cannot add ropes");
        memset(larger + springs, 0, (all - springs) * sizeof *larger);
        target->break_strain = larger;
    }
    // The builder does not tell where its particles are; a network made of it does.
    mspring_network *network = NULL;
    mspring_result result = mspring_network_create(target->builder, NULL, &network);
    if (result != MSPRING_OK)
        return scene_fail_builder(error, "cannot add ropes to this scene", target->builder, result);
    bool ok = add_ropes(target, network, count, segments, seed, options, error);
    mspring_network_destroy(network);
    return ok;
}

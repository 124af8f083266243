/// @file 10_bridge.c
/// A rope bridge gives way under somebody who walks across: ropes, a state of rest, and a force that moves.
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL // for mspring_network_settle()
#include "common/show.h"

#include <massspring/massspring.h>

enum { PLANKS = 24, STEPS = 16 * 63 };

int main(int count, char **arguments) {
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_particle_def post = mspring_particle_def_default();
    post.flags = MSPRING_PARTICLE_PINNED;
    mspring_material hemp = mspring_material_default();
    hemp.mass = 6, hemp.stiffness = 2e5f, hemp.damping = 200;
    mspring_rope_def rope = mspring_rope_def_default();
    rope.segment_count = PLANKS, rope.length_ratio = 1.02f, rope.material = &hemp;
    mspring_id ids[2][PLANKS + 1]; // of deck and rail
    mspring_result result = mspring_builder_create(NULL, &builder);
    for (int i = 0; i < 2; i++) {
        post.x = 0, post.y = 1.2 * i; // m
        mspring_builder_add_particles(builder, &post, 1, &rope.from);
        post.x = PLANKS;
        mspring_builder_add_particles(builder, &post, 1, &rope.to);
        mspring_builder_add_rope(builder, &rope, ids[i], NULL);
    }
    rope.segment_count = 1, rope.length_ratio = 1; // what hangs between
    for (int i = 1; i < PLANKS; i++) {
        rope.from = ids[0][i], rope.to = ids[1][i];
        mspring_builder_add_rope(builder, &rope, NULL, NULL);
    }
    result = result ? result : mspring_network_create(builder, NULL, &network);
    result = result ? result : mspring_network_settle(network, NULL, NULL);
    show shown;
    show_begin(&shown, count, arguments, "10_bridge", "Somebody walks across a rope bridge.", network, 0.02);
    for (int step = 0; !result && step < STEPS; step++, show_step(&shown, network)) {
        shown.film.probe = ids[0][step * PLANKS / STEPS];
        result = mspring_network_apply_force(network, shown.film.probe, 0, -800);
        result = result ? result : mspring_network_step(network, 1.0 / 60);
    }
    return show_end(&shown, result, builder, network);
}

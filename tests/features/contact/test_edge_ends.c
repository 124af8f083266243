/// @file test_edge_ends.c
/// Bodies in contact, breaks, and a compaction between them: a network that was made anew, compacted likewise and
/// has loaded a snapshot goes on with the same bits, though it found its outline in another layout.
///
/// SPDX-License-Identifier: MIT
#include "support.h"

#define DT (1.0 / 120)

enum {
    WIDTH = 5,
    HEIGHT = 3,
    BODIES = 8,
    CELLS = WIDTH * HEIGHT,
    PARTICLES = BODIES * CELLS,
    STEPS = 12,
    AFTER = 120
};

/// Particles in the order of lattices, and springs from either end: which end is the base follows from the layout
/// as long as it is one of lattices, and from the builder once it is not.
static void add_bodies(mspring_builder *builder, uint64_t *seed) {
    static const uint32_t to[4][2] = {{1, 0}, {0, 1}, {1, 1}, {(uint32_t)-1, 1}};
    for (uint32_t i = 0; i < PARTICLES; i++)
        support_particle(builder, 0.3 * (i / CELLS) + i % WIDTH, (HEIGHT + 0.2) * (i / CELLS) + i % CELLS / WIDTH,
                         1);
    for (uint32_t i = 0; i < 4 * PARTICLES; i++) {
        const uint32_t cell = i / 4 % CELLS, column = cell % WIDTH + to[i % 4][0],
                       row = cell / WIDTH + to[i % 4][1];
        const mspring_id a = i / 4, b = i / 4 - cell + WIDTH * row + column;
        const bool is_turned = support_random_between(seed, 0, 2) < 1;
        if (column < WIDTH && row < HEIGHT)
            support_spring(builder, is_turned ? b : a, is_turned ? a : b, 3000, 0);
    }
}

/// A stack of bodies that fall on each other; each particle flies a little on its own.
static mspring_network *stack(uint32_t trial) {
    uint64_t seed = 400 + trial;
    mspring_builder *builder = support_builder();
    add_bodies(builder, &seed);
    mspring_network_def def = support_def(-9.8f, trial % 3 == 0 ? 16 : 2);
    def.settings.solver = (mspring_solver)(trial % 3);
    mspring_network *network = support_network(builder, &def);
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.3;
    contact.friction = 0.5f;
    contact.flags = MSPRING_CONTACT_SELF;
    check_ok(mspring_network_set_contact(network, &contact));
    for (mspring_id p = 0; p < PARTICLES; p++) {
        const float vx = (float)support_random_between(&seed, -1, 1),
                    vy = (float)support_random_between(&seed, -1, 1);
        check_ok(mspring_network_set_velocities(network, NULL, p, 1, &vx, &vy, 1));
    }
    return network;
}

/// Break half of the springs, at random.
static void break_some(mspring_network *network, uint32_t trial) {
    uint64_t seed = trial;
    mspring_id broken[4 * PARTICLES];
    uint32_t count = 0;
    for (mspring_id s = 0; s < mspring_network_count(network, MSPRING_SPRINGS); s++)
        if (support_random_between(&seed, 0, 2) < 1)
            broken[count++] = s;
    check_ok(mspring_network_break_springs(network, broken, 0, count));
}

static void run(uint32_t trial) {
    mspring_network *network = stack(trial), *other = stack(trial);
    support_steps(network, STEPS, DT);
    break_some(network, trial);
    support_steps(network, STEPS, DT);
    check_ok(mspring_network_compact(network));
    support_steps(network, STEPS, DT);
    break_some(other, trial);
    check_ok(mspring_network_compact(other));
    support_bring(network, other, MSPRING_SNAPSHOT_ALL);
    for (uint32_t step = 0; step < AFTER; step++) {
        check_ok(mspring_network_step(network, DT));
        check_ok(mspring_network_step(other, DT));
        if (support_hash(network) != support_hash(other))
            fail_msg("trial %u: other bits in step %u after the load", trial, step);
    }
    mspring_network_destroy(network);
    mspring_network_destroy(other);
}

static void a_loaded_snapshot_goes_on_with_the_same_bits(void **state) {
    (void)state;
    for (uint32_t trial = 0; trial < ROUNDS(12); trial++)
        run(trial);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_loaded_snapshot_goes_on_with_the_same_bits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#include "look.h"

#include <stdlib.h>
#include <string.h>

void *look_array(size_t count, size_t size) {
    void *made = calloc(count, size);
    assert_non_null(made);
    return made;
}

look look_at(mspring_network *network) {
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    const uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES);
    look seen = {.hash = support_hash(network)};
    seen.springs = look_array(springs, sizeof *seen.springs);
    for (mspring_id s = 0; s < springs; s++) {
        check_ok(support_get_spring(network, s, &seen.springs[s]));
    }
    for (int i = 0; i < 4; i++) {
        seen.by_spring[i] = look_array(springs, sizeof(float));
    }
    seen.scale = look_array(particles, sizeof(float));
    seen.component = look_array(particles, sizeof *seen.component);
    check_ok(support_get_energy(network, &seen.energy[0], &seen.energy[1], &seen.energy[2]));
    check_ok(support_get_momentum(network, &seen.momentum[0], &seen.momentum[1], &seen.momentum[2]));
    check_ok(support_get_extents(network, seen.by_spring[0], seen.by_spring[1], seen.by_spring[2],
                                         seen.by_spring[3]));
    check_ok(mspring_network_get(network, MSPRING_INVERSE_MASS_SCALE, NULL, 0, particles, seen.scale, 1));
    check_ok(mspring_network_update_components(network, &seen.component_count, NULL));
    check_ok(mspring_network_get_integers(network, MSPRING_COMPONENT, NULL, 0, particles, seen.component, 1));
    return seen;
}

void check_same_look(look a, look b, const mspring_network *network) {
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    const uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES);
    assert_int_equal(a.hash, b.hash);
    assert_memory_equal(a.energy, b.energy, sizeof a.energy);
    assert_memory_equal(a.momentum, b.momentum, sizeof a.momentum);
    assert_memory_equal(a.springs, b.springs, springs * sizeof *a.springs);
    for (int i = 0; i < 4; i++) {
        for (mspring_id s = 0; s < springs; s++) { // the sense of a difference may be another, and so 0's sign
            check_near(a.by_spring[i][s], b.by_spring[i][s], 0);
        }
        free(a.by_spring[i]);
        free(b.by_spring[i]);
    }
    assert_memory_equal(a.scale, b.scale, particles * sizeof *a.scale);
    assert_int_equal(a.component_count, b.component_count);
    assert_memory_equal(a.component, b.component, particles * sizeof *a.component);
    free(a.springs);
    free(b.springs);
    free(a.scale);
    free(b.scale);
    free(a.component);
    free(b.component);
}

/// @file finite_math.c
/// A program that is compiled with -ffinite-math-only: it says and reads "never" without INFINITY.
///
/// SPDX-License-Identifier: MIT
#include <massspring/massspring.h>

static int stretch(mspring_builder *builder, mspring_network **network) {
    mspring_particle_def particle;
    mspring_spring_def spring;
    if (mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle) != MSPRING_OK ||
        mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring) != MSPRING_OK)
        return 0;
    particle.flags = MSPRING_PARTICLE_PINNED;
    for (int i = 0; i < 2; i++, particle.x = 1000) {
        if (mspring_builder_add_particles(builder, &particle, 1, NULL) != MSPRING_OK)
            return 0;
    }
    spring.a = 0;
    spring.b = 1;
    spring.rest_length = 1e-30f; // of which the largest float is only 3e8 m
    return mspring_builder_add_springs(builder, &spring, 1, NULL) == MSPRING_OK &&
           mspring_network_create(builder, NULL, network) == MSPRING_OK;
}

static int breaks(mspring_network *network, float break_strain) {
    float read = 0;
    uint32_t flags = 0;
    if (mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, 1, &break_strain, 0) != MSPRING_OK ||
        mspring_network_get(network, MSPRING_BREAK_STRAIN, NULL, 0, 1, &read, 1) != MSPRING_OK || read != break_strain ||
        mspring_network_step(network, 0.01) != MSPRING_OK ||
        mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, 0, 1, &flags, 1) != MSPRING_OK)
        return -1;
    return (flags & MSPRING_SPRING_BROKEN) != 0;
}

int main(void) {
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    if (mspring_builder_create(NULL, &builder) != MSPRING_OK)
        return 1;
    const int ok = stretch(builder, &network) && breaks(network, MSPRING_NEVER) == 0 && breaks(network, 1e30f) == 1;
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
    return ok ? 0 : 1;
}

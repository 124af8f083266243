// What a program that uses the library looks like: two particles, a spring, a second of time.
// SPDX-License-Identifier: MIT
#include <massspring/massspring.h>
#include <stdio.h>

static int failed(const char *what, const char *why) {
    fprintf(stderr, "%s: %s\n", what, why);
    return 1;
}

int main(void) {
    mspring_builder *builder;
    mspring_network *network;
    mspring_particle_def particles[2] = {mspring_particle_def_default(), mspring_particle_def_default()};
    mspring_spring_def spring = mspring_spring_def_default();
    mspring_network_info info = mspring_network_info_default();
    double y[2], x[2];

    if (mspring_builder_create(NULL, &builder) != MSPRING_OK) {
        return failed("builder", "out of memory");
    }
    particles[0].flags = MSPRING_PARTICLE_PINNED;
    particles[1].x = 1;
    mspring_builder_add_particles(builder, particles, 2, NULL);
    spring.a = 0;
    spring.b = 1;
    spring.stiffness = 1000;
    mspring_builder_add_springs(builder, &spring, 1, NULL);
    if (mspring_network_create(builder, NULL, &network) != MSPRING_OK) {
        return failed("network", mspring_builder_error(builder));
    }
    mspring_builder_destroy(builder);

    for (int step = 0; step < 64; step++) {
        if (mspring_network_step(network, 1.0 / 64) != MSPRING_OK) {
            return failed("step", mspring_network_error(network));
        }
    }
    if (mspring_network_get_positions(network, NULL, 0, 2, x, y, 1) != MSPRING_OK ||
        mspring_network_get_info(network, &info) != MSPRING_OK) {
        return failed("positions", mspring_network_error(network));
    }
    printf("massspring %s at %s: the weight hangs at (%g, %g)\n", mspring_version_string(),
           mspring_simd_name(info.simd_level), x[1], y[1]);
    mspring_network_destroy(network);
#if defined(EXPECT_SHARED) // the library knows which one it is
    if (!!(mspring_features() & MSPRING_FEATURE_SHARED) != EXPECT_SHARED) {
        return failed("features", "this is the other library");
    }
#endif
    // A pendulum of 1 m: after 1 s, half of its period, it has swung to the other side and is below its pin.
    return mspring_version() == MSPRING_VERSION && x[0] == 0 && y[0] == 0 && x[1] < 0 && y[1] < 0 ? 0 : 1;
}

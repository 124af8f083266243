/// @file refused.c
/// A library of base, floor and contact with the explicit solver: it has no more features than these, and refuses
/// fields of other parts by the name of the part.
///
/// SPDX-License-Identifier: MIT
#include <massspring/massspring.h>
#include <stdio.h>
#include <string.h>

static int failures;

static void check(int is_so, const char *what, const char *message) {
    if (is_so)
        return;
    printf("%s: \"%s\"\n", what, message);
    ++failures;
}

static void check_refused(mspring_result result, const char *what, const char *message) {
    check(result == MSPRING_ERROR_ARGUMENT && strstr(message, "the part laws (MASSSPRING_PARTS)"), what, message);
}

// Two particles and a spring.
static mspring_result create(uint32_t flags, float yield_strain, float hardening, mspring_builder **builder,
                             mspring_network **network) {
    mspring_particle_def particles[2] = {mspring_particle_def_default(), mspring_particle_def_default()};
    mspring_spring_def spring = mspring_spring_def_default();
    mspring_network_def def = mspring_network_def_default();
    particles[1].x = 1;
    spring.a = 0;
    spring.b = 1;
    spring.stiffness = 1000.0f;
    spring.flags = flags;
    spring.yield_strain = yield_strain;
    spring.hardening = hardening;
    def.spare_springs = 1;
    const mspring_result result = mspring_builder_create(NULL, builder);
    if (result != MSPRING_OK)
        return result;
    mspring_builder_add_particles(*builder, particles, 2, NULL);
    mspring_builder_add_springs(*builder, &spring, 1, NULL);
    return mspring_network_create(*builder, &def, network);
}

static void check_spring(uint32_t flags, float yield_strain, float hardening, const char *what) {
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    const mspring_result result = create(flags, yield_strain, hardening, &builder, &network);
    check_refused(result, what, mspring_builder_error(builder));
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
}

int main(void) {
    const unsigned left_out = MSPRING_FEATURE_LAWS | MSPRING_FEATURE_BATCH | MSPRING_FEATURE_LAB |
                              MSPRING_FEATURE_IMPLICIT | MSPRING_FEATURE_DIRECT;
    const unsigned is_there = MSPRING_FEATURE_FLOOR | MSPRING_FEATURE_CONTACT;
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_id added = 0;
    mspring_spring_def spring = mspring_spring_def_default();
    float value = 0.1f;
    check((mspring_features() & (left_out | is_there)) == is_there, "features", "");

    check_spring(MSPRING_SPRING_PULL_ONLY, MSPRING_NEVER, MSPRING_HARDENING_DEFAULT, "pulls");
    check_spring(MSPRING_SPRING_PUSH_ONLY, MSPRING_NEVER, MSPRING_HARDENING_DEFAULT, "pushes");
    check_spring(0, 0.1f, MSPRING_HARDENING_DEFAULT, "yields");
    check_spring(0, MSPRING_NEVER, 0.5f, "hardens");

    check(create(0, MSPRING_NEVER, MSPRING_HARDENING_DEFAULT, &builder, &network) == MSPRING_OK, "create",
          builder ? mspring_builder_error(builder) : "");
    if (!network)
        return 1;
    check_refused(mspring_network_set(network, MSPRING_YIELD_STRAIN, NULL, 0, 1, &value, 1), "property",
                  mspring_network_error(network));
    check(mspring_network_remove_springs(network, NULL, 0, 1) == MSPRING_OK, "remove",
          mspring_network_error(network));
    spring.a = 0;
    spring.b = 1;
    spring.yield_strain = 0.1f;
    check_refused(mspring_network_add_springs(network, &spring, 1, &added), "added",
                  mspring_network_error(network));
    check(mspring_network_step(network, 1.0 / 64) == MSPRING_OK, "step", mspring_network_error(network));
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
    return failures > 0;
}

/// @file solvers.c
/// What a build of the library with some of the solvers does: it prints the hash of what its explicit solver
/// stepped, which is that of every build, and has what is not there refused by name.
///
/// SPDX-License-Identifier: MIT
#include <inttypes.h>
#define MSPRING_EXPERIMENTAL
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

// A bar of 40 x 5 particles, held at its left end.
static mspring_builder *make_bar(void) {
    mspring_builder *builder = NULL;
    mspring_material materials[2] = {mspring_material_default(), mspring_material_default()};
    mspring_lattice_def lattice = mspring_lattice_def_default();
    uint16_t cells[5][40] = {{1}, {1}, {1}, {1}, {1}};
    materials[0].stiffness = materials[1].stiffness = 5000.0f;
    materials[1].particle_flags = MSPRING_PARTICLE_PINNED;
    lattice.width = 40;
    lattice.height = 5;
    lattice.cells = cells[0];
    lattice.materials = materials;
    lattice.material_count = 2;
    if (mspring_builder_create(NULL, &builder) || mspring_builder_add_lattice(builder, &lattice, NULL))
        return NULL;
    return builder;
}

static void choose(mspring_network *network, mspring_solver solver, int is_there, const char *name) {
    mspring_settings settings = mspring_settings_default();
    settings.solver = solver;
    settings.substeps = 10;
    const mspring_result result = mspring_network_set_settings(network, &settings);
    const char *message = mspring_network_error(network);
    if (is_there)
        check(result == MSPRING_OK && mspring_network_step(network, 1.0 / 64) == MSPRING_OK, name, message);
    else
        check(result == MSPRING_ERROR_ARGUMENT && strstr(message, name) && strstr(message, "MASSSPRING_SOLVERS"),
              name, message);
}

int main(void) {
    const int has_implicit = !!(mspring_features() & MSPRING_FEATURE_IMPLICIT);
    const int has_direct = !!(mspring_features() & MSPRING_FEATURE_DIRECT);
    mspring_builder *builder = make_bar();
    mspring_network *network = NULL;
    mspring_network_def def = mspring_network_def_default();
    uint64_t hash = 0;
    uint32_t count = 0;
    def.settings.substeps = 10;
    check(builder && mspring_network_create(builder, &def, &network) == MSPRING_OK, "network", "not created");
    if (failures)
        return 1;
    for (int step = 0; step < 64; ++step)
        check(mspring_network_step(network, 1.0 / 64) == MSPRING_OK, "step", mspring_network_error(network));
    check(mspring_network_get_state_hash(network, &hash) == MSPRING_OK, "hash", mspring_network_error(network));
    printf("%016" PRIx64 "\n", hash);

    // The settings that are tried are those of solvers that there are: 4 explicit, 12 implicit and 4 direct ones.
    check(mspring_tune_settings(network, 1.0 / 64, NULL, 0, &count) == MSPRING_OK &&
              count == 4u + 12u * has_implicit + 4u * has_direct,
          "settings", mspring_network_error(network));
    choose(network, MSPRING_SOLVER_IMPLICIT, has_implicit, "implicit");
    choose(network, MSPRING_SOLVER_DIRECT, has_direct, "direct");
    choose(network, MSPRING_SOLVER_EXPLICIT, 1, "explicit");

    // So is the guard whose steps the implicit solver takes.
    const mspring_result expected = has_implicit ? MSPRING_OK : MSPRING_ERROR_ARGUMENT;
    mspring_settings settings = mspring_settings_default();
    check(mspring_network_get_settings(network, &settings) == MSPRING_OK, "settings",
          mspring_network_error(network));
    settings.guard = MSPRING_GUARD_IMPLICIT;
    check(mspring_network_set_settings(network, &settings) == expected, "guard", mspring_network_error(network));
    mspring_network_destroy(network);
    network = NULL;
    def.settings.guard = MSPRING_GUARD_IMPLICIT;
    check(mspring_network_create(builder, &def, &network) == expected &&
              (has_implicit || strstr(mspring_builder_error(builder), "no implicit solver")),
          "guard at creation", mspring_builder_error(builder));
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
    return failures > 0;
}

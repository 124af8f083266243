/// @file main.c
/// A program of a user: two bodies on a device, with the bits of the processor. Status 77 if there is no device.
///
/// SPDX-License-Identifier: MIT
#include <massspring/massspring_gpu.h>
#include <stdio.h>

static mspring_network *two_bodies(void) {
    static const mspring_id firsts[3] = {0, 4, 8};
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_material material = mspring_material_default();
    mspring_lattice_def lattice = mspring_lattice_def_default();
    mspring_network_def def = mspring_network_def_default();
    material.mass = 1;
    material.stiffness = 500;
    lattice.width = lattice.height = 2;
    lattice.materials = &material;
    def.settings.substeps = 8;
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    if (!mspring_builder_create(NULL, &builder) && !mspring_builder_add_lattice(builder, &lattice, NULL) &&
        !mspring_builder_add_lattice(builder, &lattice, NULL) && !mspring_network_create(builder, &def, &network) &&
        mspring_network_set_groups(network, firsts, 2))
        printf("%s\n", mspring_network_error(network));
    mspring_builder_destroy(builder);
    return network;
}

int main(void) {
    char why[512] = "";
    uint64_t expected = 0, hash = 1;
    mspring_gpu *batch = NULL;
    mspring_network *network = two_bodies();
    mspring_gpu_def def = mspring_gpu_def_default();
    def.message = why;
    def.message_size = sizeof why;
    mspring_result result = mspring_gpu_create(network, &def, &batch);
    for (int step = 0; step < 10 && !result; ++step) {
        result = mspring_gpu_step(batch, 1.0 / 64);
        if (!result)
            result = mspring_network_step(network, 1.0 / 64);
    }
    if (!result)
        result = mspring_gpu_get_state_hash(batch, &hash);
    if (!result)
        result = mspring_network_get_state_hash(network, &expected);
    printf("massspring_gpu: %s%s%s\n", why, mspring_gpu_error(batch), hash == expected ? "the same bits" : "");
    mspring_gpu_destroy(batch);
    mspring_network_destroy(network);
    return result == MSPRING_ERROR_DEVICE ? 77 : hash != expected;
}

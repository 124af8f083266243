/// @file main.c
/// A host that gives the library nothing but memory, out of one array, and prints the hash of what it stepped and
/// what it is told of its mistakes.
///
/// SPDX-License-Identifier: MIT
#include <inttypes.h>
#include <massspring/massspring.h>
#include <stdio.h>

static _Alignas(64) unsigned char memory[1 << 20];
static size_t used;

static void *take(size_t size, size_t alignment, void *user) {
    (void)user;
    const size_t start = (used + alignment - 1) / alignment * alignment;
    if (size > sizeof memory - start)
        return NULL;
    used = start + size;
    return memory + start;
}

static void leave(void *block, size_t size, void *user) {
    (void)block;
    (void)size;
    (void)user;
}

int main(void) {
    const mspring_allocator allocator = {.struct_size = sizeof allocator, .alloc = take, .free = leave};
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
#if defined(FREESTANDING) // there is nothing to fall back on
    if (mspring_builder_create(NULL, &builder) != MSPRING_ERROR_ARGUMENT)
        return 1;
#endif
    mspring_material materials[2] = {mspring_material_default(), mspring_material_default()};
    materials[0].stiffness = materials[1].stiffness = 5000.0f;
    materials[1].particle_flags = MSPRING_PARTICLE_PINNED;
    const uint16_t cells[3][10] = {{1}, {1}, {1}};
    mspring_lattice_def lattice = mspring_lattice_def_default();
    lattice.width = 10;
    lattice.height = 3;
    lattice.cells = cells[0];
    lattice.materials = materials;
    lattice.material_count = 2;
    mspring_network_def def = mspring_network_def_default();
    def.allocator = &allocator;
    def.settings.substeps = 10;
    if (mspring_builder_create(&allocator, &builder) || mspring_builder_add_lattice(builder, &lattice, NULL) ||
        mspring_network_create(builder, &def, &network))
        return 2;
    for (int step = 0; step < 64; ++step)
        if (mspring_network_step(network, 1.0 / 64))
            return 3;
    uint64_t hash = 0;
    if (mspring_network_get_state_hash(network, &hash))
        return 4;
    printf("%016" PRIx64 "\n", hash);
    // Messages have their numbers without stdio, too.
    if (mspring_network_step(network, -0.015625) != MSPRING_ERROR_ARGUMENT)
        return 5;
    printf("%s\n", mspring_network_error(network));
    if (mspring_network_break_springs(network, &(mspring_id){4000000000u}, 0, 1) != MSPRING_ERROR_ID)
        return 6;
    printf("%s\n", mspring_network_error(network));
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
    return 0;
}

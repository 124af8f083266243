/// @file old_program.c
/// A program of the stored ABI's time: built with the header of then (header/), it runs with the library of today
/// and says what it said then (old_program.txt).
///
/// SPDX-License-Identifier: MIT
#include <massspring/massspring_tools.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static int failures;

static void expect(const char *what, mspring_result result, mspring_result expected) {
    if (result != expected) {
        printf("%s: %s\n", what, mspring_result_string(result));
        failures++;
    }
}
#define CALL(call) expect(#call, call, MSPRING_OK)

/// Counts what it gives, in front of each block.
static void *count_alloc(size_t size, size_t alignment, void *user) {
    static char memory[1 << 20];
    static size_t used;
    size_t *calls = user;
    ++*calls;
    used += (alignment - ((size_t)(uintptr_t)memory + used) % alignment) % alignment;
    used += size;
    return used <= sizeof memory ? memory + (used - size) : NULL;
}

static void count_free(void *memory, size_t size, void *user) {
    (void)memory;
    (void)size;
    (void)user;
}

static void push(const mspring_hook_args *args, void *user) {
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        if (args->particle_of_slot[slot] != MSPRING_NONE) {
            args->force_x[slot] += 1.0f;
        }
    }
    *(int *)user = 1;
}

int main(void) {
    size_t calls = 0;
    int pushed = 0;
    mspring_allocator allocator;
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_material materials[2];
    mspring_lattice_def lattice;
    mspring_network_def def;
    mspring_hook_def hook;
    mspring_view view;
    mspring_plan plan;
    mspring_spring_info info;
    const uint16_t cells[3][10] = {{1}, {1}, {1}};
    double x[30], y[30];
    uint64_t hash = 0;

    memset(&allocator, 0, sizeof allocator);
    allocator.struct_size = sizeof allocator;
    allocator.alloc = count_alloc;
    allocator.free = count_free;
    allocator.user = &calls;
    CALL(mspring_builder_create(&allocator, &builder));
    for (int i = 0; i < 2; i++) {
        CALL(mspring_material_init(&materials[i], sizeof materials[i]));
        materials[i].stiffness = 5000.0f;
        materials[i].damping = 2.0f;
    }
    materials[1].particle_flags = MSPRING_PARTICLE_PINNED;
    CALL(mspring_lattice_def_init(&lattice, sizeof lattice));
    lattice.width = 10;
    lattice.height = 3;
    lattice.cells = cells[0];
    lattice.materials = materials;
    lattice.material_count = 2;
    CALL(mspring_builder_add_lattice(builder, &lattice, NULL));

    CALL(mspring_network_def_init(&def, sizeof def));
    def.substeps = 10;
    def.allocator = &allocator;
    CALL(mspring_network_create(builder, &def, &network));
    CALL(mspring_hook_def_init(&hook, sizeof hook));
    hook.phase = MSPRING_PHASE_BEFORE_SUBSTEP;
    hook.fn = push;
    hook.user = &pushed;
    CALL(mspring_network_add_hook(network, &hook, NULL));
    for (int step = 0; step < 64; step++) {
        CALL(mspring_network_step(network, 1.0 / 64));
    }
    CALL(mspring_network_get_positions(network, 0, 30, x, y, 1));
    CALL(mspring_network_state_hash(network, &hash));
    printf("hash %08lx%08lx\n", (unsigned long)(hash >> 32), (unsigned long)(hash & 0xffffffffu));
    printf("the free end is at %.6f %.6f\n", x[9], y[9]);

    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    CALL(mspring_network_view(network, &view));
    printf("the view agrees: %d\n", view.y[view.slot_of_particle[9]] == (float)(y[9] - view.origin_y));
    memset(&plan, 0, sizeof plan);
    plan.struct_size = sizeof plan;
    CALL(mspring_network_get_plan(network, &plan));
    printf("%u particles, %u springs, %u lattice\n", (unsigned)plan.particle_count, (unsigned)plan.spring_count,
           (unsigned)plan.lattice_count);
    memset(&info, 0, sizeof info);
    info.struct_size = sizeof info;
    CALL(mspring_network_get_spring(network, 0, &info));
    printf("spring 0 joins %u and %u at %.1f m\n", (unsigned)info.a, (unsigned)info.b, (double)info.rest_length);
    printf("hook called: %d, allocator called: %d\n", pushed, calls > 0);

    // Of a later header: its struct is larger than this library knows. (It is the header of today that has to name
    // a size that no library of its own has.)
    expect("init of a larger struct", mspring_network_def_init(&def, 4096), MSPRING_ERROR_STRUCT);
    CALL(mspring_network_def_init(&def, sizeof def));
    def.struct_size = 4096;
    expect("a larger struct", mspring_network_create(builder, &def, &network), MSPRING_ERROR_STRUCT);
    printf("a larger struct: %.32s...\n", mspring_builder_error(builder));

    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
    printf("%d failures\n", failures);
    return failures != 0;
}

/// @file old_program.c
/// A program of the stored ABI's time: built with the headers of then (header/), it runs with the library of today
/// and says what it said then (old_program.txt).
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL
#include <massspring/massspring.h>
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

/// A cantilever of 10 x 3 cells.
static mspring_network *build(mspring_builder *builder, const mspring_allocator *allocator) {
    const uint16_t cells[3][10] = {{1}, {1}, {1}};
    mspring_material materials[2] = {mspring_material_default(), mspring_material_default()};
    mspring_lattice_def lattice = mspring_lattice_def_default();
    mspring_network_def def = mspring_network_def_default();
    mspring_network *network = NULL;
    for (int i = 0; i < 2; i++) {
        materials[i].stiffness = 5000.0f;
        materials[i].damping = 2.0f;
    }
    materials[1].particle_flags = MSPRING_PARTICLE_PINNED;
    lattice.width = 10;
    lattice.height = 3;
    lattice.cells = cells[0];
    lattice.materials = materials;
    lattice.material_count = 2;
    CALL(mspring_builder_add_lattice(builder, &lattice, NULL));
    def.settings.substeps = 10; // behind the fields of the definition, which may be more by now
    def.settings.most_work = 5;
    def.allocator = allocator;
    CALL(mspring_network_create(builder, &def, &network));
    return network;
}

static void read(mspring_network *network) {
    double x[30], y[30];
    uint64_t hash = 0;
    uint32_t ends[2] = {0, 0};
    float rest = 0;
    mspring_view view = mspring_view_default();
    mspring_settings settings = mspring_settings_default();
    mspring_step_info info = mspring_step_info_default();
    mspring_body body = mspring_body_default();
    const mspring_column columns[3] = {
        {MSPRING_END_A, 1, &ends[0]}, {MSPRING_END_B, 1, &ends[1]}, {MSPRING_REST_LENGTH, 1, &rest}};

    CALL(mspring_network_get_positions(network, NULL, 0, 30, x, y, 1));
    CALL(mspring_network_get_state_hash(network, &hash));
    printf("hash %08lx%08lx\n", (unsigned long)(hash >> 32), (unsigned long)(hash & 0xffffffffu));
    printf("the free end is at %.6f %.6f\n", x[9], y[9]);
    CALL(mspring_network_get_view(network, &view));
    printf("the view agrees: %d\n", view.y[view.slot_of_particle[9]] == (float)(y[9] - view.origin_y));
    CALL(mspring_network_get_settings(network, &settings));
    CALL(mspring_network_get_step_info(network, &info));
    printf("%u substeps, work %u, step %u\n", (unsigned)settings.substeps, (unsigned)settings.most_work,
        (unsigned)info.step_count);
    CALL(mspring_network_get_body(network, NULL, 0, MSPRING_ALL, &body));
    printf("%u particles of %.0f kg, %u springs\n", (unsigned)body.particle_count, body.mass,
        (unsigned)mspring_network_count(network, MSPRING_SPRINGS));
    CALL(mspring_network_get_columns(network, NULL, 0, 1, columns, 3));
    printf("spring 0 joins %u and %u at %.1f m\n", (unsigned)ends[0], (unsigned)ends[1], (double)rest);
}

int main(void) {
    size_t calls = 0;
    int pushed = 0;
    mspring_allocator allocator = mspring_allocator_default();
    mspring_hook_def hook = mspring_hook_def_default();
    mspring_network_def def;
    mspring_settle_result settled = mspring_settle_result_default();
    mspring_builder *builder = NULL;
    mspring_network *network;

    allocator.alloc = count_alloc;
    allocator.free = count_free;
    allocator.user = &calls;
    CALL(mspring_builder_create(&allocator, &builder));
    network = build(builder, &allocator);
    hook.phase = MSPRING_PHASE_BEFORE_SUBSTEP;
    hook.fn = push;
    hook.user = &pushed;
    CALL(mspring_network_add_hook(network, &hook, NULL));
    for (int step = 0; step < 64; step++) {
        CALL(mspring_network_step(network, 1.0 / 64));
    }
    read(network);
    CALL(mspring_network_settle(network, NULL, &settled));
    printf("hook called: %d, allocator called: %d, settles: %d\n", pushed, calls > 0, (int)settled.is_stable);

    // Of a later header: its struct is larger than any that a library has. (It is the header of today that has to name
    // a size that no library of its own has.)
    expect("init of too large a struct", mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, 1 << 20), MSPRING_ERROR_STRUCT);
    def = mspring_network_def_default();
    def.struct_size = 1 << 20;
    expect("too large a struct", mspring_network_create(builder, &def, &network), MSPRING_ERROR_STRUCT);
    printf("too large a struct: %.32s...\n", mspring_builder_error(builder));

    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
    printf("%d failures\n", failures);
    return failures != 0;
}

/// @file check.c
/// Scenes whose hash is the same as natively.
///
/// Scene 0 is the golden one of the tests, bar_80x5, so that 64 steps of it have the hash written down there.
///
/// SPDX-License-Identifier: MIT
#include "page.h"

#if defined(__wasm__)
#include "environment.h"
#define ALLOCATOR &environment_allocator
#else
#define ALLOCATOR NULL
#endif

static uint64_t found;

// A lattice of which one column is pinned, with ropes from its top row to its bottom row.
typedef struct check_scene {
    uint32_t width, height, ropes, substeps;
    mspring_solver solver;
    float stiffness, damping, mass;
} check_scene;

static const check_scene scenes[] = {
    {80, 5, 0, 30, MSPRING_SOLVER_EXPLICIT, 6.7643e7f, 0, 73.3975f},
    {60, 20, 8, 40, MSPRING_SOLVER_EXPLICIT, 6.7643e7f, 500, 73.3975f},
    {60, 20, 8, 1, MSPRING_SOLVER_IMPLICIT, 6.7643e7f, 500, 73.3975f},
    {40, 10, 4, 1, MSPRING_SOLVER_DIRECT, 6.7643e7f, 500, 73.3975f},
    {80, 5, 0, 1, MSPRING_SOLVER_IMPLICIT, 6.7643e7f, 0, 73.3975f},
    {40, 10, 4, 1, MSPRING_SOLVER_DIRECT, 6.7643e7f, 0, 73.3975f},
};
enum { SCENES = sizeof scenes / sizeof *scenes, MOST_CELLS = 1200 };

static void fill(mspring_builder *builder, const check_scene *scene) {
    static uint16_t cells[MOST_CELLS];
    static mspring_id ids[MOST_CELLS];
    mspring_material materials[2], twine = mspring_material_default();
    mspring_lattice_def def = mspring_lattice_def_default();
    mspring_rope_def rope = mspring_rope_def_default();
    for (uint32_t i = 0; i < 2; i++) {
        materials[i] = mspring_material_default();
        materials[i].mass = scene->mass;
        materials[i].stiffness = scene->stiffness;
        materials[i].damping = scene->damping;
        materials[i].particle_flags = i == 1 ? MSPRING_PARTICLE_PINNED : 0;
    }
    for (uint32_t i = 0; i < scene->width * scene->height; i++)
        cells[i] = i % scene->width == 0;
    def.width = scene->width;
    def.height = scene->height;
    def.cells = cells;
    def.materials = materials;
    def.material_count = 2;
    mspring_builder_add_lattice(builder, &def, ids);
    twine.mass = 10;
    twine.stiffness = scene->stiffness / 20;
    twine.damping = 20;
    rope.material = &twine;
    rope.length_ratio = 1.1f;
    for (uint32_t i = 0; i < scene->ropes; i++) {
        rope.from = ids[3 + 4 * i];
        rope.to = ids[scene->width * (scene->height - 1) + 5 + 2 * i];
        rope.segment_count = 10 + i;
        mspring_builder_add_rope(builder, &rope, NULL, NULL);
    }
}

mspring_result page_check(uint32_t scene, uint32_t steps, uint32_t level) {
    mspring_builder *builder = NULL;
    mspring_network *network = NULL;
    mspring_network_def def = mspring_network_def_default();
    if (scene >= SCENES)
        return MSPRING_ERROR_ARGUMENT;
    def.allocator = ALLOCATOR;
    def.settings.substeps = scenes[scene].substeps;
    def.settings.solver = scenes[scene].solver;
    def.simd_level = (mspring_simd)level;
    mspring_result result = mspring_builder_create(ALLOCATOR, &builder);
    if (result == MSPRING_OK) {
        fill(builder, &scenes[scene]); // create returns its first failure
        result = mspring_network_create(builder, &def, &network);
    }
    if (result == MSPRING_OK)
        result = mspring_network_get_state_hash(network, &found);
    for (uint32_t i = 0; i < steps && result == MSPRING_OK; i++) {
        uint64_t hash = 0;
        result = mspring_network_step(network, 1.0 / 64);
        if (result == MSPRING_OK)
            result = mspring_network_get_state_hash(network, &hash);
        found = (found << 7 | found >> 57) ^ hash; // as in the golden tests: each step counts
    }
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
    return result;
}

uint32_t page_check_hash(uint32_t upper) {
    return (uint32_t)(upper ? found >> 32 : found);
}

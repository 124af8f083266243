/// @file page.c
/// Making a network of a picture's cells, stepping it, looking at it.
///
/// SPDX-License-Identifier: MIT
#include "internal.h"

#include <string.h>

#if defined(__wasm__)
#include "environment.h"
#define ALLOCATOR &environment_allocator
#else
#include <stdlib.h>
#define ALLOCATOR NULL
#endif

enum { EVENTS = 4096 };

page_state page;

static uint8_t *input;
static uint32_t input_size;
static const char *last_error = "";

/* ----------------------------------------------------------------------------------------------------- memory */

void *page_take(size_t size) {
    if (size == 0)
        size = 1;
#if defined(__wasm__)
    void *memory = environment_allocator.alloc(size, 64, NULL);
#else
    void *memory = malloc(size);
#endif
    if (memory)
        memset(memory, 0, size);
    return memory;
}

void page_leave(void *memory, size_t size) {
#if defined(__wasm__)
    environment_allocator.free(memory, size ? size : 1, NULL);
#else
    (void)size;
    free(memory);
#endif
}

uint8_t *page_prepare(uint32_t size) {
    page_leave(input, input_size);
    input_size = size;
    input = page_take(size);
    return input;
}

/* ------------------------------------------------------------------------------------------------------ errors */

static mspring_result failed(mspring_result result, const char *message) {
    last_error = message && *message ? message : mspring_result_string(result);
    return result;
}

mspring_result page_done(mspring_result result) {
    return result == MSPRING_OK ? MSPRING_OK : failed(result, mspring_network_error(page.network));
}

const char *page_error(void) {
    return last_error;
}

/* ------------------------------------------------------------------------------------------------------- making */

static void drop_page(void) {
    mspring_network_destroy(page.network);
    page_leave(page.springs, page.spring_count * sizeof *page.springs);
    page_leave(page.ends, 2 * page.spring_count * sizeof *page.ends);
    page_leave(page.values, page.spring_count * sizeof *page.values);
    page_leave(page.base_stiffness, page.spring_count * sizeof *page.base_stiffness);
    page_leave(page.break_strain, page.spring_count * sizeof *page.break_strain);
    page_leave(page.rest_length, page.spring_count * sizeof *page.rest_length);
    page_leave(page.plastic, page.spring_count * sizeof *page.plastic);
    page_leave(page.list, page.list_capacity * sizeof *page.list);
    page_leave(page.events, EVENTS * sizeof *page.events);
    page_leave(page.held, page.particle_count * sizeof *page.held);
    page_leave(page.held_mass, page.particle_count * sizeof *page.held_mass);
    page_leave(page.force_x, page.particle_count * sizeof *page.force_x);
    page_leave(page.force_y, page.particle_count * sizeof *page.force_y);
    memset(&page, 0, sizeof page);
}

static bool take_arrays(void) {
    page.particle_count = mspring_network_count(page.network, MSPRING_PARTICLES);
    page.spring_count = mspring_network_count(page.network, MSPRING_SPRINGS);
    page.list_capacity = page.particle_count > page.spring_count ? page.particle_count : page.spring_count;
    page.springs = page_take(page.spring_count * sizeof *page.springs);
    page.ends = page_take(2 * page.spring_count * sizeof *page.ends);
    page.values = page_take(page.spring_count * sizeof *page.values);
    page.base_stiffness = page_take(page.spring_count * sizeof *page.base_stiffness);
    page.break_strain = page_take(page.spring_count * sizeof *page.break_strain);
    page.rest_length = page_take(page.spring_count * sizeof *page.rest_length);
    page.plastic = page_take(page.spring_count * sizeof *page.plastic);
    page.list = page_take(page.list_capacity * sizeof *page.list);
    page.events = page_take(EVENTS * sizeof *page.events);
    page.held = page_take(page.particle_count * sizeof *page.held);
    page.held_mass = page_take(page.particle_count * sizeof *page.held_mass);
    page.force_x = page_take(page.particle_count * sizeof *page.force_x);
    page.force_y = page_take(page.particle_count * sizeof *page.force_y);
    return page.springs && page.ends && page.values && page.base_stiffness && page.break_strain &&
           page.rest_length && page.plastic && page.list && page.events && page.held && page.held_mass &&
           page.force_x && page.force_y;
}

static mspring_result describe_springs(void) {
    enum { STRIDE = sizeof *page.springs / sizeof page.springs->a };
    page_spring *drawn = page.springs;
    const mspring_column columns[] = {
        {MSPRING_END_A, 2, page.ends},
        {MSPRING_END_B, 2, page.ends + 1},
        {MSPRING_SLOT_A, STRIDE, &drawn->a},
        {MSPRING_SLOT_B, STRIDE, &drawn->b},
        {MSPRING_REST_LENGTH, STRIDE, &drawn->rest_length},
        {MSPRING_REST_LENGTH, 1, page.rest_length},
        {MSPRING_STIFFNESS, 1, page.base_stiffness},
    };
    const mspring_result result = mspring_network_get_columns(page.network, NULL, 0, page.spring_count, columns,
                                                              sizeof columns / sizeof *columns);
    for (uint32_t slot = 0; slot < page.view.slot_count; slot++)
        page.total_mass += page.view.inverse_mass[slot] > 0 ? 1 / (double)page.view.inverse_mass[slot] : 0;
    return page_done(result);
}

static float weaker(float a, float b) {
    return a == 0 ? b : b == 0 ? a : a < b ? a : b;
}

// Springs follow the particles in the order of cells, each with its right, lower left, lower, lower right
// neighbour.
static void find_break_strains(const mspring_lattice_def *def, const page_material *materials) {
    static const int steps[4][2] = {{1, 0}, {-1, 1}, {0, 1}, {1, 1}};
    uint32_t spring = 0;
    for (uint32_t row = 0; row < def->height; row++) {
        for (uint32_t column = 0; column < def->width; column++) {
            const uint16_t cell = def->cells[row * def->width + column];
            for (int i = 0; cell != MSPRING_CELL_EMPTY && i < 4; i++) {
                const int64_t x = (int64_t)column + steps[i][0], y = (int64_t)row + steps[i][1];
                if (x < 0 || x >= def->width || y >= def->height)
                    continue;
                const uint16_t other = def->cells[y * def->width + x];
                if (other != MSPRING_CELL_EMPTY && spring < page.spring_count)
                    page.break_strain[spring++] =
                        weaker(materials[cell].break_strain, materials[other].break_strain);
            }
        }
    }
}

static void find_strains(const mspring_lattice_def *def, const page_material *materials) {
    find_break_strains(def, materials);
    for (uint32_t i = 0; i < def->material_count; i++)
        page.yield_strain = weaker(page.yield_strain, materials[i].yield_strain);
}

static void add_ropes(mspring_builder *builder, const page_rope *ropes, uint32_t count, const mspring_id *ids) {
    mspring_material material = mspring_material_default();
    mspring_rope_def def = mspring_rope_def_default();
    def.material = &material;
    for (uint32_t i = 0; i < count; i++) {
        def.from = ids[ropes[i].from];
        def.to = ids[ropes[i].to];
        def.segment_count = ropes[i].segments;
        def.length_ratio = ropes[i].length_ratio;
        material.mass = ropes[i].mass;
        material.stiffness = ropes[i].stiffness;
        material.damping = ropes[i].damping;
        mspring_builder_add_rope(builder, &def, NULL, NULL);
    }
}

static void build(mspring_builder *builder, mspring_lattice_def *def, const page_material *given,
                  const page_rope *ropes, uint32_t rope_count, mspring_material *materials, mspring_id *ids) {
    for (uint32_t i = 0; i < def->material_count; i++) {
        materials[i] = mspring_material_default();
        materials[i].mass = given[i].mass;
        materials[i].stiffness = given[i].stiffness;
        materials[i].damping = given[i].damping;
        materials[i].particle_flags = given[i].pinned > 0 ? MSPRING_PARTICLE_PINNED : 0;
    }
    def->materials = materials;
    if (mspring_builder_add_lattice(builder, def, ids) == MSPRING_OK) // else ids are not set
        add_ropes(builder, ropes, rope_count, ids);
}

// The first failure in describing the network, too, comes out here.
static mspring_result make_network(mspring_builder *builder) {
    mspring_network_def def = mspring_network_def_default();
    def.settings.guard = MSPRING_GUARD_GROWTH; // the page says what is too stiff
    def.allocator = ALLOCATOR;
    def.flags = MSPRING_NETWORK_RESERVE_DAMPING;
    mspring_result result = mspring_network_create(builder, &def, &page.network);
    if (result != MSPRING_OK)
        return failed(result, mspring_builder_error(builder));
    page.view = mspring_view_default();
    result = mspring_network_get_view(page.network, &page.view);
    if (result == MSPRING_OK)
        result = mspring_network_reserve_events(page.network, EVENTS);
    if (result != MSPRING_OK)
        return page_done(result);
    return take_arrays() ? describe_springs() : failed(MSPRING_ERROR_MEMORY, NULL);
}

mspring_result page_make(uint32_t width, uint32_t height, uint32_t material_count, uint32_t rope_count) {
    const uint64_t cells = (uint64_t)width * height, at_materials = (2 * cells + 15) / 16 * 16;
    const uint64_t at_ropes = at_materials + (uint64_t)material_count * sizeof(page_material);
    if (!input || at_ropes + (uint64_t)rope_count * sizeof(page_rope) > input_size)
        return failed(MSPRING_ERROR_ARGUMENT, "less was prepared than is to be read");
    const page_material *given = (const page_material *)(const void *)(input + at_materials);
    const page_rope *ropes = (const page_rope *)(const void *)(input + at_ropes);
    for (uint32_t i = 0; i < rope_count; i++)
        if (ropes[i].from >= cells || ropes[i].to >= cells)
            return failed(MSPRING_ERROR_ID, "a rope ends in no cell");
    drop_page();
    mspring_builder *builder = NULL;
    mspring_lattice_def def = mspring_lattice_def_default();
    mspring_result result = MSPRING_OK;
    def.width = width;
    def.height = height;
    def.cells = (const uint16_t *)(const void *)input;
    def.material_count = material_count;
    mspring_material *materials = page_take(material_count * sizeof *materials);
    mspring_id *ids = page_take((size_t)cells * sizeof *ids);
    if (!materials || !ids)
        result = failed(MSPRING_ERROR_MEMORY, NULL);
    if (result == MSPRING_OK)
        result = mspring_builder_create(ALLOCATOR, &builder);
    if (result == MSPRING_OK) {
        build(builder, &def, given, ropes, rope_count, materials, ids);
        result = make_network(builder);
    }
    if (result == MSPRING_OK)
        find_strains(&def, given);
    else
        drop_page();
    mspring_builder_destroy(builder);
    page_leave(materials, material_count * sizeof *materials);
    page_leave(ids, (size_t)cells * sizeof *ids);
    return result;
}

/* ------------------------------------------------------------------------------------------------ stepping */

// Springs that broke are drawn no more.
static void follow_events(void) {
    uint32_t count = 0;
    bool yielded = false;
    do {
        if (mspring_network_read_events(page.network, page.events, EVENTS, &count, NULL) != MSPRING_OK)
            return;
        for (uint32_t i = 0; i < count; i++) {
            const mspring_event *event = &page.events[i];
            if (event->kind == MSPRING_EVENT_BROKEN)
                page.springs[event->id].rest_length = 0;
            else if (event->kind == MSPRING_EVENT_RESTORED)
                page.springs[event->id].rest_length = page_rest_length(event->id);
            else if (event->kind == MSPRING_EVENT_YIELDED)
                yielded = true;
        }
        page.changes += count > 0;
    } while (count == EVENTS);
    if (yielded)
        page_find_bent();
}

mspring_result page_step(double dt) {
    page_pull(dt);
    const mspring_result result = page_done(mspring_network_step(page.network, dt));
    if (result == MSPRING_OK)
        follow_events();
    const mspring_result seen = mspring_network_get_view(page.network, &page.view);
    return result != MSPRING_OK ? result : page_done(seen);
}

static mspring_settings settings_now(void) {
    mspring_settings settings = mspring_settings_default();
    mspring_network_get_settings(page.network, &settings);
    return settings;
}

mspring_result page_set_solver(uint32_t solver, uint32_t substeps, uint32_t iterations) {
    mspring_settings settings = settings_now();
    settings.solver = (mspring_solver)solver;
    settings.substeps = substeps ? substeps : MSPRING_SUBSTEPS_AUTO;
    settings.iterations = iterations;
    settings.residual = iterations ? 0 : mspring_settings_default().residual;
    return page_done(mspring_network_set_settings(page.network, &settings));
}

mspring_result page_set_gravity(float y) {
    mspring_settings settings = settings_now();
    settings.gravity_y = y;
    return page_done(mspring_network_set_settings(page.network, &settings));
}

mspring_result page_set_damping(float rate) {
    mspring_settings settings = settings_now();
    settings.global_damping = rate;
    return page_done(mspring_network_set_settings(page.network, &settings));
}

mspring_result page_set_stiffness(float factor) {
    for (uint32_t i = 0; i < page.spring_count; i++)
        page.values[i] = factor * page.base_stiffness[i];
    return page_done(
        mspring_network_set(page.network, MSPRING_STIFFNESS, NULL, 0, page.spring_count, page.values, 1));
}

mspring_result page_set_breaking(uint32_t on) {
    for (uint32_t i = 0; i < page.spring_count; i++)
        page.values[i] = on && page.break_strain[i] > 0 ? page.break_strain[i] : MSPRING_NEVER;
    return page_done(
        mspring_network_set(page.network, MSPRING_BREAK_STRAIN, NULL, 0, page.spring_count, page.values, 1));
}

/* -------------------------------------------------------------------------------------------------- looking */

uint32_t page_particle_count(void) {
    return page.particle_count;
}

uint32_t page_slot_count(void) {
    return page.view.slot_count;
}

const float *page_x(void) {
    return page.view.x;
}

const float *page_y(void) {
    return page.view.y;
}

const float *page_inverse_mass(void) {
    return page.view.inverse_mass;
}

double page_origin_x(void) {
    return page.view.origin_x;
}

double page_origin_y(void) {
    return page.view.origin_y;
}

uint32_t page_spring_count(void) {
    return page.spring_count;
}

const page_spring *page_springs(void) {
    return page.springs;
}

uint32_t page_changes(void) {
    return page.changes;
}

uint32_t page_substeps(void) {
    mspring_step_info info = mspring_step_info_default();
    return mspring_network_get_step_info(page.network, &info) == MSPRING_OK ? info.substeps : 0;
}

uint32_t page_needed_substeps(double dt) {
    uint32_t needed = 0;
    return mspring_network_suggest_substeps(page.network, dt, 0.7, &needed) == MSPRING_OK ? needed : 0;
}

float page_spring_force(uint32_t spring) {
    float force = 0;
    return mspring_network_get(page.network, MSPRING_TENSION, &spring, 0, 1, &force, 1) == MSPRING_OK ? force : 0;
}

uint32_t page_spring_end(uint32_t spring, uint32_t which) {
    return page.ends[2 * spring + which];
}

const char *page_level(void) {
    mspring_network_info info = mspring_network_info_default();
    mspring_network_get_info(page.network, &info);
    return mspring_simd_name(info.simd_level);
}

static mspring_energy energy_now(void) {
    mspring_energy energy = mspring_energy_default();
    mspring_network_get_energy(page.network, &energy);
    return energy;
}

double page_kinetic_energy(void) {
    return energy_now().kinetic;
}

double page_elastic_energy(void) {
    return energy_now().elastic;
}

double page_max_strain(void) {
    return __builtin_fabs(energy_now().largest_strain);
}

uint32_t page_hash(uint32_t upper) {
    uint64_t hash = 0;
    if (mspring_network_get_state_hash(page.network, &hash) != MSPRING_OK)
        return 0;
    return (uint32_t)(upper ? hash >> 32 : hash);
}

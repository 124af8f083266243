/// @file make.c
/// Networks as games have them: bars with holes, discs, meshes, ropes, herds, graphs, sand, and what several of
/// these make.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "game.h"

/// A builder at work.
typedef struct yard {
    game *it;
    memory *memory;
    mspring_builder *builder;
    draws *from;
    float stiffness, damping, mass;
    uint32_t flags;
    double x; ///< where the next piece begins
} yard;

/// Make a call of the builder, once more if it fails for want of memory: nothing may have been added then.
#define BUILD(y, call)                                                                                             \
    do {                                                                                                           \
        const uint32_t particles_ = mspring_builder_count((y)->builder, MSPRING_PARTICLES),                                  \
                       springs_ = mspring_builder_count((y)->builder, MSPRING_SPRINGS);                                      \
        mspring_result result_ = (call);                                                                           \
        if (result_ == MSPRING_ERROR_MEMORY) {                                                                     \
            const uint32_t fails_ = (y)->memory->fails;                                                            \
            JUDGE((y)->it, (y)->memory->has_failed);                                                               \
            JUDGE((y)->it, mspring_builder_count((y)->builder, MSPRING_PARTICLES) == particles_);                            \
            JUDGE((y)->it, mspring_builder_count((y)->builder, MSPRING_SPRINGS) == springs_);                                \
            (y)->it->counts.failed_allocations++;                                                                  \
            (y)->memory->fails = 0;                                                                                \
            mspring_builder_forget_error((y)->builder); /* copies of it would be refused */                        \
            result_ = (call);                                                                                      \
            (y)->memory->fails = fails_;                                                                           \
        }                                                                                                          \
        JUDGE((y)->it, result_ == MSPRING_OK);                                                                     \
    } while (0)

/* ------------------------------------------------------------------------------------------------- pieces */

static void add_lattice(yard *y, uint32_t width, uint32_t height) {
    uint16_t cells[64 * 32];
    mspring_material materials[2];
    mspring_lattice_def def;
    const uint32_t holes = draw(y->from, 3) == 0 ? 25 : 0;
    for (uint32_t i = 0; i < width * height; i++)
        cells[i] = draw_chance(y->from, holes) && i > 0 ? MSPRING_CELL_EMPTY : (uint16_t)(i % 7 == 3);
    for (int i = 0; i < 2; i++) {
        JUDGE(y->it, mspring_init(MSPRING_STRUCT_MATERIAL, &materials[i], sizeof materials[i]) == MSPRING_OK);
        materials[i].stiffness = y->stiffness * (float)(1 + i);
        materials[i].damping = y->damping;
        materials[i].mass = y->mass;
        materials[i].spring_flags = y->flags;
    }
    if (draw_chance(y->from, 20)) // relative springs, both of them
        for (int i = 0; i < 2; i++)
            JUDGE(y->it, mspring_material_preset(&materials[i], (mspring_preset)draw(y->from, 4), 1, 1.0 / 240) == MSPRING_OK);
    if (draw_chance(y->from, 20))
        materials[1].break_strain = 0.3f, materials[0].yield_strain = 0.05f;
    JUDGE(y->it, mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def) == MSPRING_OK);
    def.width = width, def.height = height, def.x = y->x, def.y = draw_between(y->from, 0, 4);
    def.cells = cells, def.materials = materials, def.material_count = 2;
    def.bend_share = draw_chance(y->from, 10) ? 0.2f : 0;
    BUILD(y, mspring_builder_add_lattice(y->builder, &def, NULL));
    y->x += width + 1;
}

static void add_disc(yard *y) {
    mspring_material def_material = mspring_material_default();
    mspring_disc_def def;
    JUDGE(y->it, mspring_init(MSPRING_STRUCT_DISC_DEF, &def, sizeof def) == MSPRING_OK);
    def.material = &def_material;
    def.area_density = 1;
    def.ring_count = 1 + draw(y->from, 4);
    def.radius = def.ring_count;
    def.x = y->x + def.radius, def.y = 6;
    def_material.stiffness = y->stiffness, def_material.damping = y->damping, def_material.spring_flags = y->flags;
    def.centre_flags = draw_chance(y->from, 10) ? MSPRING_PARTICLE_PINNED : 0;
    BUILD(y, mspring_builder_add_disc(y->builder, &def, NULL, NULL));
    y->x += 2 * def.radius + 1;
}

// A strip of triangles.
static void add_mesh(yard *y) {
    enum { MOST = 12 };
    double places[2][2 * MOST];
    uint32_t triangles[6 * MOST];
    mspring_material def_material = mspring_material_default();
    mspring_mesh_def def;
    const uint32_t length = 2 + draw(y->from, MOST - 2);
    for (uint32_t i = 0; i < 2 * length; i++) {
        places[0][i] = y->x + i / 2 + 0.5 * (i % 2);
        places[1][i] = 2 + 0.9 * (i % 2);
    }
    for (uint32_t i = 0; i + 2 < 2 * length; i++)
        for (uint32_t corner = 0; corner < 3; corner++)
            triangles[3 * i + corner] = i + corner;
    JUDGE(y->it, mspring_init(MSPRING_STRUCT_MESH_DEF, &def, sizeof def) == MSPRING_OK);
    def.material = &def_material;
    def.area_density = 1;
    def.vertex_count = 2 * length, def.triangle_count = 2 * length - 2;
    def.x = places[0], def.y = places[1], def.triangles = triangles;
    def.young_modulus = y->flags & MSPRING_SPRING_RELATIVE ? 0 : y->stiffness;
    def_material.stiffness = y->flags & MSPRING_SPRING_RELATIVE ? y->stiffness : 0;
    def_material.spring_flags = y->flags, def_material.damping = y->damping;
    BUILD(y, mspring_builder_add_mesh(y->builder, &def, NULL, NULL));
    y->x += length + 2;
}

static mspring_id add_particle(yard *y, double x, double height, uint32_t flags) {
    mspring_particle_def def;
    mspring_id id = MSPRING_NONE;
    JUDGE(y->it, mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def) == MSPRING_OK);
    def.x = x, def.y = height, def.mass = y->mass, def.flags = flags;
    BUILD(y, mspring_builder_add_particles(y->builder, &def, 1, &id));
    return id;
}

static void add_rope(yard *y) {
    mspring_material def_material = mspring_material_default();
    mspring_rope_def def;
    JUDGE(y->it, mspring_init(MSPRING_STRUCT_ROPE_DEF, &def, sizeof def) == MSPRING_OK);
    def.material = &def_material;
    def.from = add_particle(y, y->x, 8, draw_chance(y->from, 70) ? MSPRING_PARTICLE_PINNED : 0);
    def.to = add_particle(y, y->x + 12, 8, draw_chance(y->from, 30) ? MSPRING_PARTICLE_PINNED : 0);
    def.segment_count = 1 + draw(y->from, 30);
    def_material.stiffness = y->stiffness, def_material.damping = y->damping, def_material.mass = y->mass;
    def_material.spring_flags = y->flags | (draw_chance(y->from, 20) ? MSPRING_SPRING_PULL_ONLY : 0);
    BUILD(y, mspring_builder_add_rope(y->builder, &def, NULL, NULL));
    y->x += 13;
}

// Springs between any two, as a game's own loader may give them.
static void add_graph(yard *y) {
    enum { MOST = 30 };
    mspring_particle_def particles[MOST];
    mspring_spring_def spring;
    mspring_id first = 0;
    const uint32_t count = 2 + draw(y->from, MOST - 2);
    for (uint32_t i = 0; i < count; i++) {
        JUDGE(y->it, mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particles[i], sizeof particles[i]) == MSPRING_OK);
        particles[i].x = y->x + draw_between(y->from, 0, 8);
        particles[i].y = draw_between(y->from, 1, 9) + i * 1e-3;
        particles[i].mass = y->mass;
    }
    BUILD(y, mspring_builder_add_particles(y->builder, particles, count, &first));
    JUDGE(y->it, mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring) == MSPRING_OK);
    spring.stiffness = y->stiffness, spring.damping = y->damping, spring.flags = y->flags;
    for (uint32_t i = 1; i < count; i++) {
        spring.a = first + i, spring.b = first + draw(y->from, i);
        if (draw_chance(y->from, 80))
            BUILD(y, mspring_builder_add_springs(y->builder, &spring, 1, NULL));
    }
    y->x += 9;
}

static void add_sand(yard *y) {
    for (uint32_t i = 1 + draw(y->from, 40); i > 0; i--)
        add_particle(y, y->x + i % 6 * 0.7, 3 + i / 6 * 0.7, 0);
    y->x += 5;
}

// Robots: all alike, of one piece.
static void add_herd(yard *y) {
    double x[8], height[8];
    mspring_id first[2];
    const uint32_t count = 1 + draw(y->from, 8);
    yard one = *y;
    const mspring_allocator allocator = memory_interface(y->memory);
    const uint32_t fails = y->memory->fails;
    y->memory->fails = 0;
    JUDGE(y->it, mspring_builder_create(&allocator, &one.builder) == MSPRING_OK);
    y->memory->fails = fails;
    one.x = 0;
    add_lattice(&one, 2 + draw(y->from, 3), 2 + draw(y->from, 2));
    mspring_builder_forget_error(one.builder); // of what lacked memory at first: copies return it, too
    for (uint32_t i = 0; i < count; i++)
        x[i] = y->x + i * 7.0, height[i] = i % 2;
    BUILD(y, mspring_builder_add_copies(y->builder, one.builder, count, x, height, 1, &first[0], &first[1]));
    mspring_builder_destroy(one.builder);
    y->x += count * 7.0;
}

// True if no step has taken a particle beyond what a builder accepts.
static bool is_within_bounds(const mspring_network *network) {
    mspring_body body = mspring_body_default();
    return mspring_network_get_body(network, NULL, 0, MSPRING_ALL, &body) == MSPRING_OK &&
           body.min_x >= -MSPRING_MAX_COORDINATE && body.min_y >= -MSPRING_MAX_COORDINATE &&
           body.max_x <= MSPRING_MAX_COORDINATE && body.max_y <= MSPRING_MAX_COORDINATE;
}

// Add the present network of another place.
static void add_other(yard *y) {
    for (int i = 0; i < PLACES; i++) {
        const place *other = &y->it->places[i];
        // Its extent is not known: it may lie across what is there.
        if (other->network && other->plain->particles < 200 && other->plain->springs < 900 &&
            mspring_builder_count(y->builder, MSPRING_PARTICLES) == 0 && is_within_bounds(other->network)) {
            mspring_id ids[MOST_PARTICLES], *springs = NULL;
            BUILD(y, mspring_builder_add_network(y->builder, other->network, NULL, 0, MSPRING_ALL, ids, springs));
            return;
        }
    }
}

static void add_piece(yard *y) {
    y->flags = draw_chance(y->from, 15) ? MSPRING_SPRING_RELATIVE : 0;
    y->stiffness = y->flags ? (float)draw_between(y->from, 0.01, 0.3) : expf((float)draw_between(y->from, 2, 11));
    y->damping = draw_chance(y->from, 60) ? 0.1f * (y->flags ? y->stiffness : sqrtf(y->stiffness)) : 0;
    y->mass = draw_chance(y->from, 50) ? 1 : (float)draw_between(y->from, 0.1, 4);
    const uint32_t kind = draw(y->from, 16);
    if (kind < 5)
        add_lattice(y, 1 + draw(y->from, 12), 1 + draw(y->from, 8));
    else if (kind == 5 && draw(y->from, 4) == 0)
        add_lattice(y, 40, 24);
    else if (kind < 8)
        add_disc(y);
    else if (kind < 10)
        add_rope(y);
    else if (kind < 11)
        add_graph(y);
    else if (kind < 12)
        add_mesh(y);
    else if (kind < 13)
        add_sand(y);
    else if (kind < 15)
        add_herd(y);
    else
        add_other(y);
}

static void add_limits(yard *y) {
    const uint32_t springs = mspring_builder_count(y->builder, MSPRING_SPRINGS);
    const uint32_t count = springs < 40 ? springs : 40;
    const mspring_result result = mspring_builder_add_strain_limits(y->builder, NULL, 0, count, 0.1f, 4, NULL);
    if (result != MSPRING_OK) // one that breaks before, or memory: then none is added
        JUDGE(y->it, mspring_builder_count(y->builder, MSPRING_SPRINGS) == springs);
}

/* ---------------------------------------------------------------------------------------------- networks */

static void MSPRING_CALL run_tasks(uint32_t count, mspring_task_fn fn, void *argument, void *user) {
    (void)user;
    for (uint32_t i = 0; i < count; i++)
        fn(argument, count - 1 - i, i % 2);
}

static mspring_network_def draw_def(game *it, draws *from) {
    static const uint32_t substeps[] = {
        MSPRING_SUBSTEPS_AUTO, MSPRING_SUBSTEPS_AUTO, MSPRING_SUBSTEPS_EVEN, 1, 2, 4, 7};
    mspring_network_def def;
    JUDGE(it, mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def) == MSPRING_OK);
    const uint32_t solver = draw(from, 8);
    def.settings.solver = solver < 5   ? MSPRING_SOLVER_EXPLICIT
                 : solver < 7 ? MSPRING_SOLVER_IMPLICIT
                              : MSPRING_SOLVER_DIRECT;
    def.settings.substeps = substeps[draw(from, 7)];
    def.settings.max_substeps = 32;
    def.settings.guard = draw(from, 2) ? MSPRING_GUARD_CLAMP : (mspring_guard)draw(from, 6);
    def.settings.integrator = (mspring_integrator)draw(from, 3);
    def.settings.gravity_y = draw(from, 3) ? -9.8f : 0;
    def.settings.global_damping = draw(from, 4) ? 0 : 0.3f;
    def.settings.sleep_speed = draw(from, 2) ? 0.05f : 0;
    def.settings.sleep_time = 0.1f;
    def.settings.max_speed = draw(from, 4) ? 1e6f : 200;
    def.flags = draw(from, 4) ? 0 : draw(from, 8);
    def.spare_particles = draw(from, 3) ? 20 : 0;
    def.spare_springs = draw(from, 3) ? 60 : 0;
    def.simd_level = it->setup.level;
    def.worker_count = it->setup.workers;
    return def;
}

static void create(game *it, place *p, yard *y) {
    const mspring_allocator allocator = memory_interface(p->memory);
    mspring_tasks tasks;
    mspring_network_def def = draw_def(it, &it->from);
    def.allocator = &allocator;
    if (it->setup.has_tasks) {
        JUDGE(it, mspring_init(MSPRING_STRUCT_TASKS, &tasks, sizeof tasks) == MSPRING_OK);
        tasks.worker_count = 2;
        tasks.run = run_tasks;
        def.tasks = &tasks;
    }
    mspring_builder_forget_error(y->builder); // some shapes were refused, or lacked memory
    mspring_result result = mspring_network_create(y->builder, &def, &p->network);
    if (result == MSPRING_ERROR_MEMORY && p->memory->has_failed) {
        JUDGE(it, !p->network);
        it->counts.failed_allocations++;
        p->memory->fails = 0;
        result = mspring_network_create(y->builder, &def, &p->network);
        p->memory->fails = it->setup.fails;
    }
    if (it->setup.is_verbose && result)
        printf("%u %d create: %s\n", it->frame, it->last_place, mspring_builder_error(y->builder));
    JUDGE(it, (result == MSPRING_OK) == (p->network != NULL));
    JUDGE(it, result == MSPRING_OK || mspring_builder_error(y->builder)[0]);
    game_log(&it->log, &result, sizeof result);
}

void place_build(game *it, place *p) {
    plain *list = p->plain;
    *p = (place){.plain = list, .memory = memory_begin(it->log | 1, it->setup.fails)};
    const mspring_allocator allocator = memory_interface(p->memory);
    yard y = {.it = it, .memory = p->memory, .from = &it->from};
    it->last_act = "build";
    if (mspring_builder_create(&allocator, &y.builder) != MSPRING_OK) {
        p->memory->fails = 0;
        JUDGE(it, mspring_builder_create(&allocator, &y.builder) == MSPRING_OK);
        p->memory->fails = it->setup.fails;
    }
    for (uint32_t pieces = 1 + draw(&it->from, 3); pieces > 0; pieces--)
        add_piece(&y);
    if (draw_chance(&it->from, 8)) {
        const uint32_t fails = p->memory->fails;
        p->memory->fails = 0; // refused for one or the other: the same in all games
        add_limits(&y);
        p->memory->fails = fails;
    }
    create(it, p, &y);
    mspring_builder_destroy(y.builder);
    if (!p->network) {
        memory_end(it, p->memory);
        p->memory = NULL;
        return;
    }
    it->counts.networks++;
    place_learn(it, p);
    for (int i = 0; i < 4; i++) // events, contact and the like are there from the start, if luck has it
        game_act(it, p, ACT_SETUP, false);
}

void place_leave(game *it, place *p) {
    plain *list = p->plain;
    if (p->network) {
        if (p->plain->particles % 2) // either may go first
            mspring_job_destroy(p->job);
        mspring_network_destroy(p->network);
        if (p->plain->particles % 2 == 0)
            mspring_job_destroy(p->job);
        memory_end(it, p->memory);
    }
    *p = (place){.plain = list};
}

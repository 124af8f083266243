/// @file test_worst_growth.c
/// Four times as much of a hostile input doesn't cost sixteen times as much: stars, cliques, wheels, particles in
/// one place, edits one by one. SECURITY.md lists the calls that grow faster by their nature.
///
/// Costs are instructions, where the system counts them, and the memory of a counting allocator. By hand it is
/// processor time elsewhere, the least of two runs.
///
///     test_worst_growth               all cases, by instructions or by memory alone
///     test_worst_growth all           all cases, by processor time where instructions are not counted
///     test_worst_growth NAME [SIZE]   those whose name begins so, with all numbers, the smaller input of this size
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "costs.h"
#include "hostile_shapes.h"
#include "support.h"

/// Sizes of the two inputs: quadratic costs show at these, and the whole takes seconds.
static uint32_t smaller = ROUNDS(8000u);
#define GROWTH 4u

/// Largest ratio of costs: n log n makes 4.7; caches and noise of a clock make more. A quadratic call has 16.
#define MOST_INSTRUCTIONS 6.5
#define MOST_TIME 11.0
#define MOST_BYTES 6.5

/// Costs that are too small to tell anything: instructions, seconds, bytes.
#define FEW_INSTRUCTIONS 4e6
#define SHORT_TIME 12e-3
#define FEW_BYTES 1e6

/// A call or more, and the shape that it meets.
typedef struct hostile_case {
    const char *name;
    void (*run)(costs *c, uint32_t n, const struct hostile_case *of);
    shape make;
    mspring_solver solver;
} hostile_case;

/* ------------------------------------------------------------------------------------------------------ creation */

static void create(costs *c, uint32_t n, const hostile_case *of) {
    mspring_builder *builder = of->make(c, n);
    costs_begin(c);
    mspring_network *network = shapes_network_of(builder, c, 0);
    costs_end(c);
    mspring_network_destroy(network);
}

static void build_star(costs *c, uint32_t n, const hostile_case *of) {
    costs_begin(c);
    mspring_builder *builder = of->make(c, n);
    costs_end(c);
    mspring_builder_destroy(builder);
}

// A fan of triangles around one vertex.
static void build_mesh(costs *c, uint32_t n, const hostile_case *of) {
    double *places = malloc((2 * (size_t)n + 2) * sizeof *places);
    uint32_t *triangles = malloc(3 * (size_t)n * sizeof *triangles);
    assert_true(places != NULL && triangles != NULL);
    places[0] = places[n + 1] = 0;
    for (uint32_t i = 0; i < n; i++) {
        places[i + 1] = cos(6.2 * i / n);
        places[n + 2 + i] = sin(6.2 * i / n);
        triangles[3 * i] = 0;
        triangles[3 * i + 1] = i + 1;
        triangles[3 * i + 2] = (i + 1) % n + 1;
    }
    mspring_material def_material = mspring_material_default();
    mspring_mesh_def def;
    check_ok(mspring_init(MSPRING_STRUCT_MESH_DEF, &def, sizeof def));
    def.material = &def_material;
    def.area_density = 1;
    def.vertex_count = n + 1;
    def.triangle_count = n;
    def.x = places;
    def.y = places + n + 1;
    def.triangles = triangles;
    def_material.stiffness = 1;
    mspring_builder *builder = of->make(c, 0);
    costs_begin(c);
    check_ok(mspring_builder_add_mesh(builder, &def, NULL, NULL));
    costs_end(c);
    mspring_builder_destroy(builder);
    free(places);
    free(triangles);
}

// Springs between the same two, each of which is refused.
static void create_twice(costs *c, uint32_t n, const hostile_case *of) {
    mspring_builder *builder = of->make(c, n);
    for (uint32_t i = 0; i < n; i++) {
        support_join(builder, 0, 1, 1, 1, 0);
    }
    mspring_network_def def = support_def(0, 1);
    mspring_network *network;
    def.allocator = &c->allocator;
    costs_begin(c);
    check_error(mspring_network_create(builder, &def, &network), MSPRING_ERROR_DUPLICATE);
    costs_end(c);
    mspring_builder_destroy(builder);
}

/* --------------------------------------------------------------------------------------------------------- steps */

static void step(costs *c, uint32_t n, const hostile_case *of) {
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    mspring_settings solver = support_solver(network);
    solver.solver = of->solver;
    check_ok(support_set_solver(network, &solver));
    costs_begin(c);
    check_ok(mspring_network_step(network, 1e-4));
    check_ok(mspring_network_step(network, 1e-4));
    costs_end(c);
    mspring_network_destroy(network);
}

static void step_floor(costs *c, uint32_t n, const hostile_case *of) {
    float *heights = malloc(n * sizeof *heights);
    assert_non_null(heights);
    for (uint32_t i = 0; i < n; i++) {
        heights[i] = (float)(i % 2);
    }
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.heights_x = -1;
    def.heights_y = -1.5;
    def.spacing = 1;
    def.height_count = n;
    def.heights = heights;
    costs_begin(c);
    check_ok(mspring_network_set_floor(network, &def));
    for (uint32_t i = 0; i < n; i++) { // each grazes all of them
        const float vx = (float)n, vy = -1;
        check_ok(mspring_network_set_velocities(network, &i, 0, 1, &vx, &vy, 1));
    }
    check_ok(mspring_network_step(network, 1));
    costs_end(c);
    mspring_network_destroy(network);
    free(heights);
}

/* --------------------------------------------------------------------------------------------------------- edits */

// All springs of a star, one by one: broken, restored with a ramp, broken again and removed.
static void break_star(costs *c, uint32_t n, const hostile_case *of) {
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    costs_begin(c);
    check_ok(mspring_network_reserve_events(network, 4 * n));
    for (uint32_t turn = 0; turn < 2; turn++) {
        for (uint32_t i = 0; i < n; i++) {
            check_ok(mspring_network_break_springs(network, &i, 0, 1));
        }
        for (uint32_t i = 0; i < n; i++) {
            check_ok(mspring_network_restore_springs(network, &i, 0, 1, 1));
        }
        check_ok(mspring_network_step(network, 1e-3));
    }
    for (uint32_t i = 0; i < n; i++) {
        mspring_event event;
        uint32_t count;
        check_ok(mspring_network_read_events(network, &event, 1, &count, NULL));
    }
    for (uint32_t i = 0; i < n; i++) {
        check_ok(mspring_network_remove_springs(network, &i, 0, 1));
    }
    check_ok(mspring_network_compact(network));
    check_ok(mspring_network_step(network, 1e-3));
    costs_end(c);
    mspring_network_destroy(network);
}

// All springs of a star in one step.
static void tear_star(costs *c, uint32_t n, const hostile_case *of) {
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    const double x = 0.5, y = 0;
    const float limit = 0.01f;
    const mspring_id hub = 0;
    check_ok(mspring_network_set_positions(network, &hub, 0, 1, &x, &y, 1));
    costs_begin(c);
    for (uint32_t i = 0; i < n; i++) {
        check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, i, 1, &limit, 1));
    }
    check_ok(mspring_network_step(network, 1e-4));
    costs_end(c);
    mspring_network_destroy(network);
}

// Its outer particles, and then the hub.
static void remove_star(costs *c, uint32_t n, const hostile_case *of) {
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    const mspring_id hub = 0;
    costs_begin(c);
    for (uint32_t i = n / 2; i <= n; i++) {
        check_ok(mspring_network_remove_particles(network, &i, 0, 1));
    }
    check_ok(mspring_network_detach_particles(network, &hub, 0, 1));
    check_ok(mspring_network_remove_particles(network, &hub, 0, 1));
    check_ok(mspring_network_compact(network));
    check_ok(mspring_network_step(network, 1e-3));
    check_ok(support_expand(network));
    costs_end(c);
    mspring_network_destroy(network);
}

// A star that grows, spring by spring, shrinks and grows again.
static void grow_star(costs *c, uint32_t n, const hostile_case *of) {
    mspring_network *network = shapes_network_of(of->make(c, 1), c, 2 * n);
    mspring_id particle, *springs = malloc(n * sizeof *springs);
    assert_non_null(springs);
    costs_begin(c);
    for (uint32_t turn = 0; turn < 2; turn++) {
        for (uint32_t i = 0; i < n; i++) {
            mspring_particle_def def;
            mspring_spring_def spring;
            check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def));
            check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
            def.x = i;
            def.y = 1;
            def.mass = 1;
            check_ok(mspring_network_add_particles(network, &def, 1, &particle));
            spring.a = 0;
            spring.b = particle;
            spring.stiffness = 1;
            spring.rest_length = 1;
            check_ok(mspring_network_add_springs(network, &spring, 1, &springs[i]));
        }
        check_ok(mspring_network_step(network, 1e-3));
        for (uint32_t i = 0; i < n; i++) {
            check_ok(mspring_network_remove_springs(network, &springs[i], 0, 1));
        }
        check_ok(mspring_network_reuse_ids(network));
    }
    costs_end(c);
    mspring_network_destroy(network);
    free(springs);
}

// One by one: all that has a value a particle or a spring.
static mspring_builder *relative_star(costs *c, uint32_t n) {
    mspring_builder *builder = shape_circle(c, n);
    mspring_spring_def spring = mspring_spring_def_default();
    spring.a = 0, spring.stiffness = 0.1f, spring.flags = MSPRING_SPRING_RELATIVE;
    for (spring.b = 1; spring.b <= n; spring.b++)
        check_ok(mspring_builder_add_springs(builder, &spring, 1, NULL));
    return builder;
}

// A list that names the hub again and again, each time with another mass.
static void weigh_star(costs *c, uint32_t n, const hostile_case *of) {
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    const uint32_t count = n / 9; // fewer than would be given up for one pass
    mspring_id *hub = test_calloc(count, sizeof *hub);
    float *masses = test_calloc(count, sizeof *masses), mass;
    for (uint32_t i = 0; i < count; i++)
        masses[i] = 2 + (float)(i % 7);
    costs_begin(c);
    check_ok(mspring_network_set(network, MSPRING_MASS, hub, 0, count, masses, 1));
    costs_end(c);
    check_ok(mspring_network_get(network, MSPRING_MASS, NULL, 0, 1, &mass, 1));
    assert_true(mass == masses[count - 1]);
    test_free(masses);
    test_free(hub);
    mspring_network_destroy(network);
}

static void set_one_by_one(costs *c, uint32_t n, const hostile_case *of) {
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    costs_begin(c);
    for (uint32_t i = 0; i < n; i++) {
        const double x = 1 + i, y = 2;
        const float one = 1, high = 1e3f;
        support_spring_info info;
        float value;
        check_ok(mspring_network_set_positions(network, &i, 0, 1, &x, &y, 1));
        check_ok(mspring_network_set_velocities(network, &i, 0, 1, &one, &one, 1));
        check_ok(mspring_network_apply_force(network, i, 1, 1));
        check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_IMPULSE, &i, 0, 1, &one, &one, 1));
        check_ok(mspring_network_set(network, MSPRING_MASS, NULL, i, 1, &one, 1));
        check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, i, 1, &one, 1));
        check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, NULL, i, 1, &one, 1));
        check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, i, 1, &high, 1));
        check_ok(mspring_network_set(network, MSPRING_YIELD_STRAIN, NULL, i, 1, &high, 1));
        check_ok(mspring_network_get(network, MSPRING_STIFFNESS, NULL, i, 1, &value, 1));
        check_ok(support_get_spring(network, i, &info));
    }
    costs_end(c);
    mspring_network_destroy(network);
}

static void set_actuators(costs *c, uint32_t n, const hostile_case *of) {
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    mspring_id *springs = malloc(n * sizeof *springs);
    assert_non_null(springs);
    for (uint32_t i = 0; i < n; i++) {
        springs[i] = n - 1 - i;
    }
    costs_begin(c);
    check_ok(mspring_network_set_actuators(network, springs, n, 4));
    for (uint32_t i = 0; i < n; i++) {
        const float signal = 1.1f;
        check_ok(mspring_network_set(network, MSPRING_SIGNAL, NULL, i, 1, &signal, 1));
    }
    check_ok(mspring_network_step(network, 1e-3));
    costs_end(c);
    mspring_network_destroy(network);
    free(springs);
}

/* --------------------------------------------------------------------------------------------- areas and angles */

// Triangles around the hub of a wheel, one by one: added, changed, asked for and removed.
static void areas_of_wheel(costs *c, uint32_t n, const hostile_case *of) {
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    mspring_area_def def;
    mspring_id id;
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &def, sizeof def));
    def.stiffness = 1e-3f;
    costs_begin(c);
    for (uint32_t i = 1; i <= n; i++) {
        const mspring_id corners[] = {0, i, i % n + 1};
        check_ok(mspring_network_add_area(network, &def, corners, 3, &id));
    }
    check_ok(mspring_network_step(network, 1e-3));
    for (uint32_t i = 0; i < n; i++) {
        support_area_info info;
        check_ok(support_set_area(network, i, &def));
        check_ok(support_get_area_info(network, i, &info));
    }
    for (uint32_t i = n; i-- > 0;) { // the last first: SECURITY.md
        check_ok(mspring_network_remove_elements(network, NULL, i, 1));
    }
    costs_end(c);
    mspring_network_destroy(network);
}

// Areas of a wheel go with its particles.
static void areas_with_particles(costs *c, uint32_t n, const hostile_case *of) {
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    mspring_area_def def;
    mspring_id id;
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &def, sizeof def));
    for (uint32_t i = 1; i <= n; i++) {
        const mspring_id corners[] = {0, i, i % n + 1};
        check_ok(mspring_network_add_area(network, &def, corners, 3, &id));
    }
    mspring_id *particles = malloc(n * sizeof *particles);
    assert_non_null(particles);
    for (uint32_t i = 0; i < n; i++) {
        particles[i] = i + 1;
    }
    costs_begin(c);
    check_ok(mspring_network_remove_particles(network, particles, 0, n));
    costs_end(c);
    mspring_network_destroy(network);
    free(particles);
}

static void cells_of_lattice(costs *c, uint32_t n, const hostile_case *of) {
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    mspring_area_def def;
    mspring_id first;
    uint32_t count;
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &def, sizeof def));
    costs_begin(c);
    check_ok(mspring_network_add_cell_areas(network, &def, &first, &count));
    check_ok(mspring_network_step(network, 1e-4));
    costs_end(c);
    mspring_network_destroy(network);
}

// Angles at the hub.
static void angles_of_star(costs *c, uint32_t n, const hostile_case *of) {
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    mspring_angle_def def;
    mspring_id id;
    check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &def, sizeof def));
    def.stiffness = 1e-6f;
    costs_begin(c);
    for (uint32_t i = 1; i <= n; i++) {
        const mspring_id corners[] = {i, 0, (i + n / 3) % n + 1};
        check_ok(mspring_network_add_angles(network, &def, corners, 1, 3, &id));
    }
    check_ok(mspring_network_step(network, 1e-4));
    for (uint32_t i = 0; i < n; i++) {
        check_ok(support_set_angle(network, i, &def));
    }
    for (uint32_t i = 0; i < n; i++) {
        check_ok(mspring_network_remove_elements(network, NULL, n - 1 - i, 1));
    }
    costs_end(c);
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------------------- contact */

static void contact(costs *c, uint32_t n, const hostile_case *of) {
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    mspring_contact_def def;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &def, sizeof def));
    def.thickness = 0.01;
    def.flags = 0;
    costs_begin(c);
    check_ok(mspring_network_set_contact(network, &def));
    const mspring_result result = mspring_network_step(network, 1e-4);
    assert_true(result == MSPRING_OK || result == MSPRING_ERROR_LIMIT);
    costs_end(c);
    mspring_network_destroy(network);
}

/// Touching particles that may sleep, in a row, of which the last never rests: so the others do not, one because of the
/// next.
static void rest_in_row(costs *c, uint32_t n, const hostile_case *of) {
    const mspring_id last = n - 1;
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    mspring_contact_def def;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &def, sizeof def));
    def.thickness = ROW_SPACING;
    check_ok(mspring_network_set_contact(network, &def));
    mspring_settings settings = {.struct_size = sizeof settings};
    check_ok(mspring_network_get_settings(network, &settings));
    settings.gravity_x = settings.gravity_y = 0;
    settings.sleep_speed = 1e-3f;
    check_ok(mspring_network_set_settings(network, &settings));
    costs_begin(c);
    for (uint32_t i = 0; i < 8; i++) {
        const float across = i % 2 == 0 ? 2e-3f : -2e-3f, along = 0;
        check_ok(mspring_network_set_velocities(network, &last, 0, 1, &along, &across, 1));
        check_ok(mspring_network_step(network, 1.0 / 64));
    }
    costs_end(c);
    mspring_network_destroy(network);
}

static void colliders(costs *c, uint32_t n, const hostile_case *of) {
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    mspring_contact_def contact_def;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact_def, sizeof contact_def));
    contact_def.thickness = 0.01;
    check_ok(mspring_network_set_contact(network, &contact_def));
    mspring_collider_def def;
    mspring_id id;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    def.kind = MSPRING_COLLIDER_CIRCLE;
    def.radius = 0.1;
    uint32_t made = 0;
    costs_begin(c);
    for (; made < n / 100; made++) {
        def.x = 3.0 * made + 2;
        if (mspring_network_add_collider(network, &def, &id) != MSPRING_OK) {
            break;
        }
    }
    check_ok(mspring_network_step(network, 1e-4));
    for (uint32_t i = 0; i < made; i++) {
        check_ok(mspring_network_place_collider(network, i, 3.0 * i + 2, 0.1, 0));
    }
    check_ok(mspring_network_step(network, 1e-4));
    for (uint32_t i = 0; i < made; i++) {
        check_ok(mspring_network_remove_collider(network, i));
    }
    costs_end(c);
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------- questions and copies */

static void ask(costs *c, uint32_t n, const hostile_case *of) {
    mspring_network *network = shapes_network_of(of->make(c, n), c, 0);
    mspring_id *ids = malloc(n * sizeof *ids), nearest;
    double distance;
    uint32_t count;
    assert_non_null(ids);
    costs_begin(c);
    double stable, any_shape;
    check_ok(mspring_network_get_stable_dt(network, &stable, &any_shape));
    check_ok(mspring_network_update_components(network, &count, NULL));
    check_ok(mspring_network_nearest_particle(network, 0.5, 0.5, 10, &nearest, &distance));
    check_ok(mspring_network_particles_in_circle(network, 0, 0, 2, ids, n, &count));
    const uint32_t all = MSPRING_FIND_WHOLE | MSPRING_FIND_BROKEN;
    check_ok(mspring_network_springs_across(network, -2, 0.1, 2, 0.1, all, ids, NULL, n, &count));
    check_ok(mspring_network_springs_in_circle(network, 0, 0, 2, all, ids, n, &count));
    check_ok(mspring_network_nearest_spring(network, 0.5, 0.5, 10, all, &nearest, NULL, &distance));
    mspring_body body = {.struct_size = sizeof body};
    check_ok(mspring_network_get_body(network, NULL, 0, mspring_network_count(network, MSPRING_PARTICLES), &body));
    for (uint32_t i = 0; i < n / 8; i++) {
        check_ok(mspring_network_get_columns(
            network, NULL, i, 1, (const mspring_column[]){{MSPRING_END_A, 1, ids}, {MSPRING_END_B, 1, ids + 1}},
            2));
    }
    size_t size;
    check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_ALL, &size));
    void *bytes = malloc(size);
    assert_non_null(bytes);
    check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_ALL, bytes, size, &size));
    check_ok(mspring_network_load(network, bytes, size));
    mspring_network *clone;
    check_ok(mspring_network_clone(network, NULL, &clone));
    mspring_builder *again = shapes_builder_for(c);
    check_ok(mspring_builder_add_network(again, network, NULL, 0, MSPRING_ALL, NULL, NULL));
    costs_end(c);
    mspring_builder_destroy(again);
    mspring_network_destroy(clone);
    mspring_network_destroy(network);
    free(bytes);
    free(ids);
}

/* --------------------------------------------------------------------------------------------------------- cases */

static const hostile_case cases[] = {
    {"build_star", build_star, shape_star, 0}, {"build_mesh", build_mesh, shape_circle, 0},
    {"create_star", create, shape_star, 0}, {"create_wheel", create, shape_wheel, 0},
    {"create_clique", create, shape_clique, 0}, {"create_path", create, shape_path, 0},
    {"create_point", create, shape_point, 0}, {"create_loose", create, shape_loose, 0},
    {"create_lattices", create, shape_lattices, 0}, {"create_cliques", create, shape_cliques, 0},
    {"create_lattice", create, shape_lattice, 0}, {"create_twice", create_twice, shape_star, 0},
    {"step_star", step, shape_star, MSPRING_SOLVER_EXPLICIT},
    {"step_clique", step, shape_clique, MSPRING_SOLVER_EXPLICIT},
    {"step_implicit_star", step, shape_star, MSPRING_SOLVER_IMPLICIT},
    {"step_implicit_clique", step, shape_clique, MSPRING_SOLVER_IMPLICIT},
    {"step_direct_star", step, shape_star, MSPRING_SOLVER_DIRECT},
    {"step_direct_path", step, shape_path, MSPRING_SOLVER_DIRECT}, {"step_floor", step_floor, shape_loose, 0},
    {"break_star", break_star, shape_star, 0}, {"tear_star", tear_star, shape_star, 0},
    {"remove_star", remove_star, shape_star, 0}, {"grow_star", grow_star, shape_circle, 0},
    {"weigh_star", weigh_star, relative_star, 0}, {"set_one_by_one", set_one_by_one, shape_star, 0},
    {"set_actuators", set_actuators, shape_star, 0}, {"areas_of_wheel", areas_of_wheel, shape_wheel, 0},
    {"areas_with_particles", areas_with_particles, shape_wheel, 0},
    {"cells_of_lattice", cells_of_lattice, shape_lattice, 0}, {"angles_of_star", angles_of_star, shape_star, 0},
    {"contact_of_star", contact, shape_star, 0}, {"contact_of_wheel", contact, shape_wheel, 0},
    {"contact_of_lattices", contact, shape_lattices, 0}, {"contact_of_loose", contact, shape_loose, 0},
    {"rest_in_row", rest_in_row, shape_row, 0}, {"colliders", colliders, shape_lattices, 0},
    {"ask_star", ask, shape_star, 0}, {"ask_clique", ask, shape_clique, 0},
    {"ask_lattices", ask, shape_lattices, 0}, {"ask_point", ask, shape_point, 0}};

static const char *wanted = "";
static bool judges_work;

static costs cost_of(const hostile_case *hostile, uint32_t n) {
    costs least = {.work = INFINITY};
    for (int run = 0; run < (costs_are_instructions() || !judges_work ? 1 : 2); run++) {
        costs c;
        costs_open(&c);
        hostile->run(&c, n, hostile);
        assert_true(c.live == 0);
        least = c.work < least.work ? c : least;
    }
    return least;
}

static bool grows_too_fast(const costs *small, const costs *large) {
    const double most = costs_are_instructions() ? MOST_INSTRUCTIONS : MOST_TIME;
    return large->work > most * small->work &&
           large->work > (costs_are_instructions() ? FEW_INSTRUCTIONS : SHORT_TIME);
}

static bool is_slow_again(const hostile_case *hostile, const costs *large) {
    const costs largest = cost_of(hostile, GROWTH * GROWTH * smaller);
    return grows_too_fast(large, &largest);
}

static void hostile_inputs_cost_what_they_weigh(void **state) {
    (void)state;
    uint32_t failed = 0;
    print_message("%s\n", costs_are_instructions() ? "instructions"
                          : judges_work            ? "no counter of instructions here: processor time, s"
                                                   : "no counter of instructions here: memory alone");
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        if (strncmp(cases[i].name, wanted, strlen(wanted)) != 0) {
            continue;
        }
        const costs small = cost_of(&cases[i], smaller), large = cost_of(&cases[i], GROWTH * smaller);
        // Caches are finite and clocks noisy, so measure slow growth again: quadratic costs grow as fast in both.
        const bool is_slow = judges_work && grows_too_fast(&small, &large) && is_slow_again(&cases[i], &large);
        const bool is_large = large.bytes > MOST_BYTES * small.bytes && large.bytes > FEW_BYTES;
        if (is_slow || is_large || *wanted != '\0') {
            print_message("%-22s %10.3g %10.3g, times %5.2f   %10.3g %10.3g bytes%s\n", cases[i].name, small.work,
                          large.work, large.work / small.work, small.bytes, large.bytes,
                          is_slow || is_large ? "  grows too fast" : "");
        }
        failed += is_slow || is_large;
    }
    assert_int_equal(failed, 0);
}

int main(int argc, char **argv) {
    judges_work = argc > 1 || costs_are_instructions();
    wanted = argc > 1 && strcmp(argv[1], "all") != 0 ? argv[1] : "";
    smaller = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : smaller;
    const struct CMUnitTest tests[] = {cmocka_unit_test(hostile_inputs_cost_what_they_weigh)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

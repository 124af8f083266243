/// @file test_shapes.c
/// Shapes that a builder makes: the springs of cloth, meshes, discs; damping by ratio.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "support.h"

static support_spring_info spring_info(const mspring_network *network, mspring_id spring) {
    support_spring_info info;
    check_ok(support_get_spring(network, spring, &info));
    return info;
}

/* ------------------------------------------------------------------------------------------------------ cloth */

#define E MSPRING_CELL_EMPTY

static mspring_network *cloth(const uint16_t *cells, uint32_t width, uint32_t height, float shear, float bend,
                              uint32_t flags) {
    mspring_material material;
    mspring_lattice_def def;
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def));
    assert_true(def.shear_share == 1 && def.bend_share == 0);
    material.mass = 2;
    material.stiffness = 100;
    material.damping = 0.25f;
    material.spring_flags = flags;
    def.width = width, def.height = height, def.cells = cells;
    def.materials = &material, def.material_count = 1;
    def.shear_share = shear, def.bend_share = bend;
    mspring_builder *builder = support_builder();
    check_ok(mspring_builder_add_lattice(builder, &def, NULL));
    return support_network(builder, NULL);
}

static void bend_springs_reach_over_full_cells_behind_the_others(void **state) {
    (void)state;
    //   0 1 2 .
    //   3 . 4 5
    //   6 7 8 9
    static const uint16_t cells[3][4] = {{0, 0, 0, E}, {0, E, 0, 0}, {0, 0, 0, 0}};
    static const mspring_id ends[][2] = {{0, 2}, {0, 6}, {2, 8}, {6, 8}, {7, 9}};
    mspring_network *plain = cloth(cells[0], 4, 3, 0.5f, 0, 0), *bent = cloth(cells[0], 4, 3, 0.5f, 0.1f, 0);
    const uint32_t before = mspring_network_count(plain, MSPRING_SPRINGS);
    assert_int_equal(mspring_network_count(bent, MSPRING_SPRINGS), before + COUNT_OF(ends));
    for (mspring_id s = 0; s < before; s++) {
        const support_spring_info info = spring_info(bent, s), other = spring_info(plain, s);
        assert_int_equal(info.a, other.a);
        assert_int_equal(info.b, other.b);
        const bool diagonal = info.rest_length > 1.2f;
        assert_true(info.stiffness == (diagonal ? 50 : 100));
        assert_true(info.damping == (diagonal ? 0.125f : 0.25f));
    }
    for (mspring_id i = 0; i < COUNT_OF(ends); i++) {
        const support_spring_info info = spring_info(bent, before + i);
        assert_int_equal(info.a, ends[i][0]);
        assert_int_equal(info.b, ends[i][1]);
        assert_true(info.rest_length == 2 && info.stiffness == 0.1f * 100 && info.damping == 0.1f * 0.25f);
    }
    mspring_network_destroy(plain);
    mspring_network_destroy(bent);
}

static void shares_of_zero_make_no_springs(void **state) {
    (void)state;
    static const uint16_t cells[30 * 20] = {0};
    mspring_network *structural = cloth(cells, 30, 20, 0, 0, 0);
    assert_int_equal(mspring_network_count(structural, MSPRING_SPRINGS), 29 * 20 + 30 * 19);
    mspring_network *bent = cloth(cells, 30, 20, 0, 1, 0);
    assert_int_equal(mspring_network_count(bent, MSPRING_SPRINGS), 29 * 20 + 30 * 19 + 28 * 20 + 30 * 18);
    mspring_network_destroy(structural);
    mspring_network_destroy(bent);
    mspring_network *cell = cloth(cells, 1, 1, 1, 1, 0);
    assert_int_equal(mspring_network_count(cell, MSPRING_SPRINGS), 0);
    mspring_network_destroy(cell);
}

static void bad_shares_are_refused(void **state) {
    (void)state;
    static const uint16_t cells[4] = {0};
    const float bad[] = {-1, NAN, INFINITY, 1001};
    mspring_material material;
    mspring_lattice_def def;
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def));
    def.width = def.height = 2, def.cells = cells, def.materials = &material, def.material_count = 1;
    mspring_builder *builder = support_builder();
    for (size_t i = 0; i < 2 * COUNT_OF(bad); i++) {
        def.shear_share = i % 2 == 0 ? bad[i / 2] : 1;
        def.bend_share = i % 2 == 1 ? bad[i / 2] : 1;
        check_error(mspring_builder_add_lattice(builder, &def, NULL), MSPRING_ERROR_ARGUMENT);
        check_contains(support_builder_error(builder), i % 2 == 0 ? "shear_share" : "bend_share");
        assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 0);
    }
    mspring_builder_destroy(builder);
}

/* ----------------------------------------------------------------------------------------------- damping ratio */

static void ratio_is_resolved_from_masses(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    mspring_spring_def def;
    support_particle(builder, 0, 0, 3);
    support_particle(builder, 1, 0, 6);
    support_particle(builder, 2, 0, 6);
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = 0, def.b = 1, def.stiffness = 50, def.damping = 0.3f, def.flags = MSPRING_SPRING_DAMPING_RATIO;
    check_ok(mspring_builder_add_springs(builder, &def, 1, NULL));
    def.a = 2, def.stiffness = 0.25f, def.flags |= MSPRING_SPRING_RELATIVE;
    check_ok(mspring_builder_add_springs(builder, &def, 1, NULL));
    mspring_network_def settings = support_def(0, 1);
    settings.spare_springs = 1;
    mspring_network *network = support_network(builder, &settings);
    assert_int_equal(spring_info(network, 0).flags, 0);
    check_near(spring_info(network, 0).damping, 2 * 0.3 * sqrt(50 * 2.0), 1e-6);
    assert_int_equal(spring_info(network, 1).flags, MSPRING_SPRING_RELATIVE);
    check_near(spring_info(network, 1).nominal_damping, 2 * 0.3 * sqrt(0.25), 1e-7);
    mspring_id added;
    def.b = 0, def.stiffness = 50, def.flags = MSPRING_SPRING_DAMPING_RATIO;
    check_ok(mspring_network_add_springs(network, &def, 1, &added));
    check_near(spring_info(network, added).damping, 2 * 0.3 * sqrt(50 * 2.0), 1e-6);
    mspring_network_destroy(network);
}

/// Swings of two masses on a spring that is let go, relative or not.
static uint32_t count_swings(float ratio, uint32_t flags) {
    mspring_builder *builder = support_builder();
    mspring_spring_def def;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    support_particle(builder, 0, 0, 2);
    support_particle(builder, 1.1, 0, 1);
    def.a = 0, def.b = 1, def.stiffness = flags & MSPRING_SPRING_RELATIVE ? 1e-4f : 100;
    def.damping = ratio, def.rest_length = 1, def.flags = flags | MSPRING_SPRING_DAMPING_RATIO;
    check_ok(mspring_builder_add_springs(builder, &def, 1, NULL));
    mspring_network_def settings = support_def(0, 1);
    mspring_network *network = support_network(builder, &settings);
    uint32_t swings = 0;
    bool was_long = true;
    for (int i = 0; i < 3000; i++) {
        check_ok(mspring_network_step(network, 0.001));
        const support_spring_info info = spring_info(network, 0);
        if (fabsf(info.strain) > 1e-4f) { // below that rounding decides
            swings += (info.strain > 0) != was_long;
            was_long = info.strain > 0;
        }
    }
    mspring_network_destroy(network);
    return swings;
}

static void ratio_of_one_is_critical(void **state) {
    (void)state;
    assert_int_equal(count_swings(1, 0), 0);
    assert_int_equal(count_swings(1, MSPRING_SPRING_RELATIVE), 0);
    // exp(-0.2 w t) has come to a thousandth after w t = 34.5: eleven half periods of pi / (w sqrt(1 - 0.04)).
    assert_in_range(count_swings(0.2f, 0), 9, 12);
    assert_in_range(count_swings(0.2f, MSPRING_SPRING_RELATIVE), 9, 12);
}

static void cloth_and_ropes_take_ratios(void **state) {
    (void)state;
    static const uint16_t cells[9] = {0};
    mspring_network *network = cloth(cells, 3, 3, 0.5f, 0.1f, MSPRING_SPRING_DAMPING_RATIO);
    for (mspring_id s = 0; s < mspring_network_count(network, MSPRING_SPRINGS); s++) {
        const support_spring_info info = spring_info(network, s);
        check_near(info.damping, 2 * 0.25 * sqrt(info.stiffness * 1.0), 1e-5); // mu is 1
    }
    mspring_network_destroy(network);
    mspring_builder *builder = support_builder();
    mspring_material rope_material = mspring_material_default();
    mspring_rope_def rope;
    check_ok(mspring_init(MSPRING_STRUCT_ROPE_DEF, &rope, sizeof rope));
    rope.material = &rope_material;
    rope.from = support_particle(builder, 0, 0, 10);
    rope.to = support_particle(builder, 3, 0, 10);
    rope.segment_count = 3, rope_material.mass = 1, rope_material.stiffness = 100;
    rope_material.damping = 1, rope_material.spring_flags = MSPRING_SPRING_DAMPING_RATIO;
    check_ok(mspring_builder_add_rope(builder, &rope, NULL, NULL));
    network = support_network(builder, NULL);
    check_near(spring_info(network, 0).damping, 20 * sqrt(10.0 / 11), 1e-5);
    check_near(spring_info(network, 1).damping, 20 * sqrt(0.5), 1e-5);
    mspring_network_destroy(network);
}

static void bad_ratio_is_refused(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    mspring_spring_def def;
    support_particle(builder, 0, 0, 1e30f);
    support_particle(builder, 1, 0, 1e30f);
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = 0, def.b = 1, def.stiffness = 1e30f, def.flags = MSPRING_SPRING_DAMPING_RATIO;
    const float bad[] = {-1, 1001, NAN, INFINITY};
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        def.damping = bad[i];
        check_error(mspring_builder_add_springs(builder, &def, 1, NULL), MSPRING_ERROR_ARGUMENT);
        check_contains(support_builder_error(builder), "damping ratio");
    }
    def.damping = 1000;
    check_ok(mspring_builder_add_springs(builder, &def, 1, NULL));
    mspring_network *network = support_network(builder, NULL);
    assert_true(spring_info(network, 0).damping == 1e30f);
    mspring_network_destroy(network);
}

/* ------------------------------------------------------------------------------------------------------ meshes */

/// What meshes and discs are made of, unless a test says otherwise.
static mspring_material plain;

static int make_plain(void **state) {
    (void)state;
    plain = mspring_material_default();
    return 0;
}

/// Two triangles on a square, and one beside them that shares an edge with the first.
static const double mesh_x[] = {0, 1, 1, 0, 3}, mesh_y[] = {0, 0, 1, 1, 0};
static const uint32_t mesh_triangles[] = {0, 1, 2, 0, 2, 3, 4, 2, 1};

static mspring_mesh_def mesh_of_three(void) {
    mspring_mesh_def def;
    check_ok(mspring_init(MSPRING_STRUCT_MESH_DEF, &def, sizeof def));
    def.vertex_count = 5, def.triangle_count = 3;
    def.x = mesh_x, def.y = mesh_y, def.triangles = mesh_triangles;
    def.material = &plain, def.area_density = 6, def.young_modulus = 10;
    return def;
}

static void edges_become_one_spring_each(void **state) {
    (void)state;
    static const mspring_id ends[][2] = {{0, 1}, {1, 2}, {0, 2}, {2, 3}, {0, 3}, {2, 4}, {1, 4}};
    static const double areas[] = {0.5, 1.5, 1, 0.5, 0.5, 1, 1}, squares[] = {1, 1, 2, 1, 1, 5, 4};
    static const float masses[] = {2, 3, 4, 1, 2};
    const mspring_mesh_def def = mesh_of_three();
    mspring_builder *builder = support_builder();
    mspring_id particle = 9, spring = 9;
    support_particle(builder, 50, 0, 1);
    check_ok(mspring_builder_add_mesh(builder, &def, &particle, &spring));
    assert_int_equal(particle, 1);
    assert_int_equal(spring, 0);
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 6);
    assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), COUNT_OF(ends));
    mspring_network *network = support_network(builder, NULL);
    for (mspring_id i = 0; i < COUNT_OF(ends); i++) {
        const support_spring_info info = spring_info(network, i);
        assert_int_equal(info.a, 1 + ends[i][0]);
        assert_int_equal(info.b, 1 + ends[i][1]);
        check_near(info.rest_length, sqrt(squares[i]), 1e-6);
        check_near(info.stiffness, 10 * areas[i] / squares[i], 1e-5);
    }
    float mass[6];
    check_ok(mspring_network_get(network, MSPRING_MASS, NULL, 0, 6, mass, 1));
    for (int i = 0; i < 5; i++)
        check_near(mass[1 + i], masses[i], 1e-6);
    mspring_network_destroy(network);
}

/// Triangles at random, many on each edge, against a look at all sides before each.
static void shared_edges_are_found_among_many(void **state) {
    (void)state;
    enum { VERTICES = 24, TRIANGLES = 150 };
    uint64_t seed = 11;
    for (int round = 0; round < 10; round++) {
        double x[VERTICES], y[VERTICES], areas[3 * TRIANGLES] = {0};
        uint32_t corners[3 * TRIANGLES], edge[3 * TRIANGLES][2], edges = 0;
        for (int i = 0; i < VERTICES; i++) {
            x[i] = support_random_between(&seed, -5, 5);
            y[i] = support_random_between(&seed, -5, 5);
        }
        for (uint32_t t = 0; t < TRIANGLES; t++) {
            uint32_t *c = corners + 3 * (size_t)t;
            double area = 0;
            while (area < 1e-3) {
                for (int i = 0; i < 3; i++)
                    c[i] = t < VERTICES / 3 ? 3 * t + i : (uint32_t)(support_random(&seed) % VERTICES);
                area =
                    fabs((x[c[1]] - x[c[0]]) * (y[c[2]] - y[c[0]]) - (y[c[1]] - y[c[0]]) * (x[c[2]] - x[c[0]])) / 2;
                if (area < 1e-3 && t < VERTICES / 3)
                    x[c[0]] += 1;
            }
            for (int i = 0; i < 3; i++) {
                const uint32_t a = c[i], b = c[(i + 1) % 3], low = a < b ? a : b, high = a < b ? b : a;
                uint32_t e = 0;
                while (e < edges && (edge[e][0] != low || edge[e][1] != high))
                    e++;
                edges = e == edges ? edges + 1 : edges;
                edge[e][0] = low, edge[e][1] = high;
                areas[e] += area;
            }
        }
        mspring_mesh_def def;
        check_ok(mspring_init(MSPRING_STRUCT_MESH_DEF, &def, sizeof def));
        def.vertex_count = VERTICES, def.triangle_count = TRIANGLES;
        def.x = x, def.y = y, def.triangles = corners, def.material = &plain, def.young_modulus = 3;
        mspring_builder *builder = support_builder();
        check_ok(mspring_builder_add_mesh(builder, &def, NULL, NULL));
        mspring_network *network = support_network(builder, NULL);
        assert_int_equal(mspring_network_count(network, MSPRING_SPRINGS), edges);
        for (mspring_id e = 0; e < edges; e++) {
            const support_spring_info info = spring_info(network, e);
            assert_int_equal(info.a, edge[e][0]);
            assert_int_equal(info.b, edge[e][1]);
            const double stiffness = 3 * areas[e] / (pow(x[info.a] - x[info.b], 2) + pow(y[info.a] - y[info.b], 2));
            check_near(info.stiffness, stiffness, 1e-6 * stiffness);
        }
        mspring_network_destroy(network);
    }
}

static void empty_mesh_adds_nothing(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    mspring_mesh_def def;
    mspring_id particle = 9, spring = 9;
    check_ok(mspring_init(MSPRING_STRUCT_MESH_DEF, &def, sizeof def));
    def.material = &plain;
    check_ok(mspring_builder_add_mesh(builder, &def, &particle, &spring));
    assert_int_equal(particle, 0);
    assert_int_equal(spring, 0);
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 0);
    mspring_builder_destroy(builder);
}

static void bad_mesh_is_refused(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
#define REFUSED(change, code, part)                                                                                \
    do {                                                                                                           \
        mspring_mesh_def def = mesh_of_three();                                                                    \
        mspring_material material = mspring_material_default();                                                    \
        def.material = &material;                                                                                  \
        uint32_t triangles[9];                                                                                     \
        double x[5], y[5];                                                                                         \
        memcpy(triangles, mesh_triangles, sizeof triangles);                                                       \
        memcpy(x, mesh_x, sizeof x);                                                                               \
        memcpy(y, mesh_y, sizeof y);                                                                               \
        def.x = x, def.y = y, def.triangles = triangles;                                                           \
        change;                                                                                                    \
        check_error(mspring_builder_add_mesh(builder, &def, NULL, NULL), (code));                                  \
        check_contains(support_builder_error(builder), (part));                                                    \
        assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 0);                                    \
        assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), 0);                                      \
    } while (0)
    REFUSED(def.x = NULL, MSPRING_ERROR_ARGUMENT, "vertices");
    REFUSED(def.triangles = NULL, MSPRING_ERROR_ARGUMENT, "triangles");
    REFUSED(def.vertex_count = UINT32_MAX, MSPRING_ERROR_LIMIT, "4294967295");
    REFUSED(def.triangle_count = UINT32_MAX, MSPRING_ERROR_LIMIT, "4294967295");
    REFUSED(def.vertex_count = 0, MSPRING_ERROR_ARGUMENT, "triangle 0");
    REFUSED(def.triangle_count = 2, MSPRING_ERROR_ARGUMENT, "vertex 4");
    REFUSED(triangles[5] = 5, MSPRING_ERROR_ARGUMENT, "triangle 1 has vertex 5");
    REFUSED(triangles[5] = UINT32_MAX, MSPRING_ERROR_ARGUMENT, "triangle 1");
    REFUSED(triangles[5] = 2, MSPRING_ERROR_ARGUMENT, "triangle 1 has no area");
    REFUSED(x[4] = 1, MSPRING_ERROR_ARGUMENT, "triangle 2 has no area");
    REFUSED((x[4] = 1, y[4] = 1e-10), MSPRING_ERROR_ARGUMENT, "triangle 2 has no area");
    REFUSED(x[3] = NAN, MSPRING_ERROR_ARGUMENT, "vertex 3");
    REFUSED(y[3] = 1.1e12, MSPRING_ERROR_ARGUMENT, "vertex 3");
    REFUSED(def.area_density = 1e-30f, MSPRING_ERROR_ARGUMENT, "vertex 0");
    REFUSED(def.young_modulus = -1, MSPRING_ERROR_ARGUMENT, "young_modulus");
    REFUSED(def.young_modulus = NAN, MSPRING_ERROR_ARGUMENT, "young_modulus");
    REFUSED(def.young_modulus = 1e30f, MSPRING_ERROR_ARGUMENT, "edge of vertices 1 and 2");
    REFUSED(material.stiffness = 1, MSPRING_ERROR_ARGUMENT, "one of them");
    REFUSED(material.spring_flags = MSPRING_SPRING_RELATIVE, MSPRING_ERROR_ARGUMENT, "one of them");
    REFUSED(material.spring_flags = 32, MSPRING_ERROR_ARGUMENT, "flags");
    REFUSED((def.young_modulus = 0, material.stiffness = -1), MSPRING_ERROR_ARGUMENT, "stiffness");
    REFUSED(material.damping = -1, MSPRING_ERROR_ARGUMENT, "damping");
    REFUSED(def.material = NULL, MSPRING_ERROR_ARGUMENT, "material is NULL");
    REFUSED(def.struct_size = 0, MSPRING_ERROR_STRUCT, "mspring_mesh_def");
#undef REFUSED
    mspring_builder_destroy(builder);
}

/* ------------------------------------------------------------------------------------------------------- discs */

static mspring_disc_def disc_of(uint32_t rings) {
    mspring_disc_def def;
    check_ok(mspring_init(MSPRING_STRUCT_DISC_DEF, &def, sizeof def));
    def.ring_count = rings;
    def.x = 7, def.y = -2, def.radius = 3;
    def.material = &plain, def.area_density = 5, def.young_modulus = 1000;
    return def;
}

static void disc_has_rings_of_short_springs(void **state) {
    (void)state;
    for (uint32_t n = 1; n < 12; n++) {
        mspring_disc_def def = disc_of(n);
        def.centre_flags = MSPRING_PARTICLE_PINNED;
        mspring_builder *builder = support_builder();
        check_ok(mspring_builder_add_disc(builder, &def, NULL, NULL));
        mspring_network *network = support_network(builder, NULL);
        const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
        assert_int_equal(count, 1 + 3 * n * (n + 1));
        assert_int_equal(mspring_network_count(network, MSPRING_SPRINGS), n * (9 * n + 3));
        mspring_id id = 0;
        double area = 0;
        for (uint32_t ring = 0; ring <= n; ring++) {
            for (uint32_t k = 0; k < (ring == 0 ? 1 : 6 * ring); k++, id++) {
                const support_point p = support_position(network, id);
                const double angle = ring == 0 ? 0 : 6.283185307179586 * k / (6 * ring), r = 3.0 * ring / n;
                check_near(p.x, 7 + r * cos(angle), 1e-6);
                check_near(p.y, -2 + r * sin(angle), 1e-6);
                float mass;
                check_ok(mspring_network_get(network, MSPRING_MASS, NULL, id, 1, &mass, 1));
                area += mass / 5;
            }
        }
        // A polygon of 6 n corners.
        check_near(area, 0.5 * 6 * n * 9 * sin(6.283185307179586 / (6 * n)), 1e-4 * area + (n > 1 ? 0.2 : 0));
        for (mspring_id s = 0; s < mspring_network_count(network, MSPRING_SPRINGS); s++) {
            const double length = (double)spring_info(network, s).rest_length * n / 3;
            assert_true(length > 0.999 && length < 1.45);
        }
        mspring_network_destroy(network);
    }
}

/// A free disc that spins keeps its shape: the strain is that of a spinning sheet.
static void disc_spins_round(void **state) {
    (void)state;
    const mspring_disc_def def = disc_of(10);
    mspring_builder *builder = support_builder();
    check_ok(mspring_builder_add_disc(builder, &def, NULL, NULL));
    mspring_network_def settings = support_def(0, 20);
    mspring_network *network = support_network(builder, &settings);
    double kinetic, elastic, after, unused;
    for (mspring_id i = 0; i < mspring_network_count(network, MSPRING_PARTICLES); i++) {
        const support_point p = support_position(network, i);
        const float vx = (float)-(p.y + 2), vy = (float)(p.x - 7);
        check_ok(mspring_network_set_velocities(network, NULL, i, 1, &vx, &vy, 1));
    }
    check_ok(support_get_energy(network, &kinetic, &elastic, &unused));
    support_steps(network, 600, 1.0 / 60);
    check_ok(support_get_energy(network, &after, &elastic, &unused));
    check_near(after + elastic, kinetic, 0.01 * kinetic); // leapfrog's energy swings by its substep
    float strain;
    check_ok(support_get_max_strain(network, &strain, NULL));
    assert_true(strain < 0.05f); // rho w^2 r^2 / E is 5 * 9 / 1000 at the rim
    mspring_network_destroy(network);
}

static void bad_disc_is_refused(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
#define REFUSED(field, value, code, part)                                                                          \
    do {                                                                                                           \
        mspring_disc_def def = disc_of(3);                                                                         \
        mspring_material material = mspring_material_default();                                                    \
        def.material = &material;                                                                                  \
        field = (value);                                                                                           \
        check_error(mspring_builder_add_disc(builder, &def, NULL, NULL), (code));                                  \
        check_contains(support_builder_error(builder), (part));                                                    \
        assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 0);                                    \
    } while (0)
    REFUSED(def.ring_count, 0, MSPRING_ERROR_ARGUMENT, "rings");
    REFUSED(def.ring_count, 4730, MSPRING_ERROR_LIMIT, "4730");
    REFUSED(def.ring_count, UINT32_MAX, MSPRING_ERROR_LIMIT, "4294967295");
    REFUSED(def.radius, 0, MSPRING_ERROR_ARGUMENT, "radius");
    REFUSED(def.radius, NAN, MSPRING_ERROR_ARGUMENT, "radius");
    REFUSED(def.radius, INFINITY, MSPRING_ERROR_ARGUMENT, "radius");
    REFUSED(def.x, NAN, MSPRING_ERROR_ARGUMENT, "vertex 0");
    REFUSED(def.x, 1e12, MSPRING_ERROR_ARGUMENT, "disc of 3 rings: vertex");
    REFUSED(def.area_density, -1, MSPRING_ERROR_ARGUMENT, "area_density");
    REFUSED(def.centre_flags, 2, MSPRING_ERROR_ARGUMENT, "centre_flags");
    REFUSED(material.spring_flags, 32, MSPRING_ERROR_ARGUMENT, "flags");
    REFUSED(material.stiffness, 5, MSPRING_ERROR_ARGUMENT, "one of them");
    REFUSED(def.material, NULL, MSPRING_ERROR_ARGUMENT, "material is NULL");
    REFUSED(def.reserved_pointer, &def, MSPRING_ERROR_ARGUMENT, "mspring_disc_def.reserved");
    REFUSED(def.struct_size, 4, MSPRING_ERROR_STRUCT, "mspring_disc_def");
#undef REFUSED
    mspring_builder_destroy(builder);
}

/* --------------------------------------------------------------------------------------------------- presets */

static const mspring_preset presets[] = {MSPRING_PRESET_STEEL, MSPRING_PRESET_WOOD, MSPRING_PRESET_RUBBER,
                                         MSPRING_PRESET_JELLY};

/// A bar whose leftmost column is pinned.
static mspring_network *bar_of(mspring_preset preset, uint32_t columns, uint32_t rows, double spacing,
                               double substep, const mspring_network_def *settings) {
    static uint16_t cells[100 * 20];
    mspring_material materials[2] = {mspring_material_default()};
    mspring_lattice_def def;
    check_ok(mspring_material_preset(&materials[0], preset, spacing, substep));
    materials[1] = materials[0];
    materials[1].particle_flags = MSPRING_PARTICLE_PINNED;
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def));
    for (uint32_t i = 0; i < columns * rows; i++)
        cells[i] = i % columns == 0;
    def.width = columns, def.height = rows, def.spacing = spacing;
    def.cells = cells, def.materials = materials, def.material_count = 2;
    mspring_builder *builder = support_builder();
    check_ok(mspring_builder_add_lattice(builder, &def, NULL));
    return support_network(builder, settings);
}

/// The end of a bar sinks as far as its speed of sound says, be it the material's own or that of the limit.
static void presets_bend_as_beams_do(void **state) {
    (void)state;
    static const double sounds[] = {5000, 4000, 40, 4}, limits[] = {0.4, 0.2, 0.05, 0.01};
    const double spacing = 0.1, substeps[] = {1e-3, 1e-6}, n = 79, m = 4;
    double last = 0;
    for (size_t i = 0; i < 2 * COUNT_OF(presets); i++) {
        const double substep = substeps[i / COUNT_OF(presets)];
        const size_t p = i % COUNT_OF(presets);
        const double most = spacing / substep * sqrt(0.75 * limits[p]);
        const double sound = fmin(sounds[p], most);
        // As little gravity as bends it by a thousandth of its length.
        const double sag = 1e-3 * n * spacing;
        const double gravity = sag * sound * sound * m * (m + 1) / (1.5 * pow(n, 4) * spacing * spacing);
        mspring_network_def settings = support_def((float)-gravity, 1);
        mspring_network *network = bar_of(presets[p], 80, 5, spacing, substep, &settings);
        mspring_settle_def def;
        check_ok(mspring_init(MSPRING_STRUCT_SETTLE_DEF, &def, sizeof def));
        def.relative_substep = substep;
        const double before = support_position(network, 79).y;
        check_ok(mspring_network_settle(network, &def, NULL));
        // Shear adds 0.2 %; the clamp forbids the root to grow thinner.
        check_near(before - support_position(network, 79).y, sag, 0.02 * sag);
        mspring_network_destroy(network);
        assert_true(p == 0 || last > sound);
        last = sound;
    }
}

static void presets_are_stable_in_any_shape(void **state) {
    (void)state;
    uint64_t seed = 3;
    for (int round = 0; round < 20; round++) {
        const double spacing = support_random_between(&seed, 0.01, 2);
        const double substep = pow(10, support_random_between(&seed, -7, 0));
        uint16_t cells[20 * 20];
        mspring_material materials[COUNT_OF(presets)];
        mspring_lattice_def def;
        for (size_t i = 0; i < COUNT_OF(presets); i++) {
            materials[i] = mspring_material_default();
            check_ok(mspring_material_preset(&materials[i], presets[i], spacing, substep));
        }
        for (size_t i = 0; i < COUNT_OF(cells); i++)
            cells[i] = (uint16_t)(support_random(&seed) % COUNT_OF(presets));
        check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def));
        def.width = def.height = 20, def.spacing = spacing;
        def.cells = cells, def.materials = materials, def.material_count = COUNT_OF(presets);
        mspring_builder *builder = support_builder();
        check_ok(mspring_builder_add_lattice(builder, &def, NULL));
        mspring_network *network = support_network(builder, NULL);
        double any_shape = 0;
        check_ok(mspring_network_get_stable_dt(network, NULL, &any_shape));
        assert_true(isinf(any_shape));
        mspring_network_destroy(network);
    }
}

static void bad_preset_is_refused(void **state) {
    (void)state;
    mspring_material material, untouched;
    memset(&material, 0xa5, sizeof material);
    untouched = material;
    const size_t size = sizeof material;
    check_error(mspring_material_preset(NULL, MSPRING_PRESET_WOOD, 1, 0.01), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_material_preset(&material, -1, 1, 0.01), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_material_preset(&material, 4, 1, 0.01), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_material_preset(&material, 0, 0, 0.01), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_material_preset(&material, 0, NAN, 0.01), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_material_preset(&material, 0, 1, 0), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_material_preset(&material, 0, 1, INFINITY), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_material_preset(&material, 0, 1, 0.01), MSPRING_ERROR_STRUCT);
    assert_memory_equal(&material, &untouched, size);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bend_springs_reach_over_full_cells_behind_the_others),
        cmocka_unit_test(shares_of_zero_make_no_springs),
        cmocka_unit_test(bad_shares_are_refused),
        cmocka_unit_test(ratio_is_resolved_from_masses),
        cmocka_unit_test(ratio_of_one_is_critical),
        cmocka_unit_test(cloth_and_ropes_take_ratios),
        cmocka_unit_test(bad_ratio_is_refused),
        cmocka_unit_test(edges_become_one_spring_each),
        cmocka_unit_test(shared_edges_are_found_among_many),
        cmocka_unit_test(empty_mesh_adds_nothing),
        cmocka_unit_test(bad_mesh_is_refused),
        cmocka_unit_test(disc_has_rings_of_short_springs),
        cmocka_unit_test(disc_spins_round),
        cmocka_unit_test(bad_disc_is_refused),
        cmocka_unit_test(presets_bend_as_beams_do),
        cmocka_unit_test(presets_are_stable_in_any_shape),
        cmocka_unit_test(bad_preset_is_refused),
    };
    return cmocka_run_group_tests_name("shapes", tests, make_plain, NULL);
}

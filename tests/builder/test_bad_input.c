/// @file test_bad_input.c
/// What a builder refuses: with which error, naming whom, and that nothing has changed afterwards.
///
/// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

/// The builder of every test: particles 0 to 9 on a line (9 in the place of 8), a spring 0 - 1.
static int make_builder(void **state) {
    mspring_builder *builder = support_builder();
    for (int i = 0; i < 9; i++) {
        support_particle(builder, i, 0, 1);
    }
    support_particle(builder, 8, 0, 1);
    support_spring(builder, 0, 1, 1, 0);
    *state = builder;
    return 0;
}

/// Whatever was refused has left the ten particles and the spring as they were, and the builder works.
static int check_builder(void **state) {
    mspring_builder *builder = *state;
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 10);
    assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), 1);
    assert_int_equal(support_particle(builder, 20, 20, 1), 10);
    assert_int_equal(support_spring(builder, 3, 10, 1, 0), 1);
    mspring_network *network = support_network(builder, NULL);
    assert_int_equal(mspring_network_count(network, MSPRING_PARTICLES), 11);
    assert_int_equal(mspring_network_count(network, MSPRING_SPRINGS), 2);
    mspring_network_destroy(network);
    return 0;
}

/// A call is refused with this code; the message contains this text; the counts are as before.
#define check_refused(builder, call, code, part)                                                                   \
    do {                                                                                                           \
        check_error((call), (code));                                                                               \
        check_contains(support_builder_error(builder), (part));                                                    \
        assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 10);                                   \
        assert_int_equal(mspring_builder_count(builder, MSPRING_SPRINGS), 1);                                      \
    } while (0)

static const float not_finite[] = {NAN, INFINITY, -INFINITY};

static void create_needs_a_place_and_a_whole_allocator(void **state) {
    (void)state;
    mspring_builder *const untouched = (mspring_builder *)(uintptr_t)16;
    mspring_builder *builder = untouched;
    check_error(mspring_builder_create(NULL, NULL), MSPRING_ERROR_ARGUMENT);
    mspring_allocator allocator = {.struct_size = sizeof allocator};
    check_error(mspring_builder_create(&allocator, &builder), MSPRING_ERROR_ARGUMENT);
    allocator.struct_size = 0;
    check_error(mspring_builder_create(&allocator, &builder), MSPRING_ERROR_STRUCT);
    allocator.struct_size = sizeof allocator + 2;
    check_error(mspring_builder_create(&allocator, &builder), MSPRING_ERROR_STRUCT);
    assert_ptr_equal(builder, untouched);
}

/* --------------------------------------------------------------------------------------------- particles */

typedef struct particle_case {
    mspring_particle_def def;
    mspring_result code;
    const char *part; ///< of the message
} particle_case;

static particle_case *bad_particles(size_t *count) {
    static particle_case cases[64];
    size_t n = 0;
    mspring_particle_def good;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &good, sizeof good));
#define BAD(field, value, wrong, word)                                                                             \
    do {                                                                                                           \
        assert_true(n < COUNT_OF(cases));                                                                          \
        cases[n] = (particle_case){.def = good, .code = (wrong), .part = (word)};                                  \
        cases[n].def.field = (value);                                                                              \
        n++;                                                                                                       \
    } while (0)
    for (size_t i = 0; i < COUNT_OF(not_finite); i++) {
        BAD(x, (double)not_finite[i], MSPRING_ERROR_ARGUMENT, "position");
        BAD(y, (double)not_finite[i], MSPRING_ERROR_ARGUMENT, "position");
        BAD(vx, not_finite[i], MSPRING_ERROR_ARGUMENT, "velocity");
        BAD(vy, not_finite[i], MSPRING_ERROR_ARGUMENT, "velocity");
        BAD(mass, not_finite[i], MSPRING_ERROR_ARGUMENT, "mass");
    }
    BAD(x, 1.001e12, MSPRING_ERROR_ARGUMENT, "position");
    BAD(vx, 1.001e15f, MSPRING_ERROR_ARGUMENT, "velocity");
    BAD(vy, -1.001e15f, MSPRING_ERROR_ARGUMENT, "velocity");
    BAD(y, -1.001e12, MSPRING_ERROR_ARGUMENT, "position");
    BAD(mass, 0, MSPRING_ERROR_ARGUMENT, "mass");
    BAD(mass, -1, MSPRING_ERROR_ARGUMENT, "mass");
    BAD(mass, 0.9e-30f, MSPRING_ERROR_ARGUMENT, "mass");
    BAD(mass, 1.1e30f, MSPRING_ERROR_ARGUMENT, "mass");
    BAD(flags, MSPRING_PARTICLE_PINNED << 1, MSPRING_ERROR_ARGUMENT, "flags");
    BAD(flags, 0x80000001u, MSPRING_ERROR_ARGUMENT, "flags");
    BAD(struct_size, 0, MSPRING_ERROR_STRUCT, "mspring_particle_def");
    BAD(struct_size, sizeof good - 4, MSPRING_ERROR_STRUCT, "mspring_particle_def");
    BAD(struct_size, sizeof good + 2, MSPRING_ERROR_STRUCT, "mspring_particle_def");
#undef BAD
    *count = n;
    return cases;
}

static void bad_particle_is_refused(void **state) {
    mspring_builder *builder = *state;
    size_t count;
    const particle_case *cases = bad_particles(&count);
    for (size_t i = 0; i < count; i++) {
        mspring_id id = 4711;
        check_refused(builder, mspring_builder_add_particles(builder, &cases[i].def, 1, &id), cases[i].code,
                      cases[i].part);
        assert_int_equal(id, 4711);
    }
    check_refused(builder, mspring_builder_add_particles(builder, NULL, 1, NULL), MSPRING_ERROR_ARGUMENT, "NULL");
    check_error(mspring_builder_add_particles(NULL, &cases[0].def, 1, NULL), MSPRING_ERROR_ARGUMENT);
}

static void bulk_particles_are_all_or_nothing(void **state) {
    mspring_builder *builder = *state;
    size_t count;
    const particle_case *cases = bad_particles(&count);
    enum { MANY = 50, CULPRIT = 37 };
    mspring_particle_def defs[MANY];
    for (size_t i = 0; i < MANY; i++) {
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &defs[i], sizeof defs[i]));
    }
    const mspring_particle_def good = defs[CULPRIT];
    for (size_t i = 0; i < count; i++) {
        mspring_id first = 4711;
        defs[CULPRIT] = cases[i].def;
        check_refused(builder, mspring_builder_add_particles(builder, defs, MANY, &first), cases[i].code, "37");
        assert_int_equal(first, 4711);
    }
    defs[CULPRIT] = good;
    check_refused(builder, mspring_builder_add_particles(builder, NULL, MANY, NULL), MSPRING_ERROR_ARGUMENT,
                  "NULL");
    check_error(mspring_builder_add_particles(NULL, defs, MANY, NULL), MSPRING_ERROR_ARGUMENT);
    // Refused by the count alone: there is no such array.
    check_refused(builder, mspring_builder_add_particles(builder, defs, UINT32_MAX, NULL), MSPRING_ERROR_LIMIT,
                  "limit");
    check_refused(builder, mspring_builder_add_particles(builder, defs, (size_t)MSPRING_MAX_PARTICLES - 9, NULL),
                  MSPRING_ERROR_LIMIT, "limit");
}

static void particles_at_the_ends_of_the_ranges_are_accepted(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    mspring_particle_def def;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def));
    def.x = MSPRING_MAX_COORDINATE;
    def.y = -MSPRING_MAX_COORDINATE;
    def.mass = 1e-30f;
    check_ok(mspring_builder_add_particles(builder, &def, 1, NULL));
    def.mass = 1e30f;
    def.x = -MSPRING_MAX_COORDINATE;
    check_ok(mspring_builder_add_particles(builder, &def, 1, NULL));
    mspring_network *network = support_network(builder, NULL);
    mspring_network_destroy(network);
}

/* ----------------------------------------------------------------------------------------------- springs */

typedef struct spring_case {
    mspring_spring_def def;
    mspring_result code;
    const char *part;
} spring_case;

static spring_case *bad_springs(size_t *count) {
    static spring_case cases[64];
    size_t n = 0;
    mspring_spring_def good;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &good, sizeof good));
    good.a = 2;
    good.b = 3;
#define BAD(field, value, wrong, word)                                                                             \
    do {                                                                                                           \
        assert_true(n < COUNT_OF(cases));                                                                          \
        cases[n] = (spring_case){.def = good, .code = (wrong), .part = (word)};                                    \
        cases[n].def.field = (value);                                                                              \
        n++;                                                                                                       \
    } while (0)
    for (size_t i = 0; i < COUNT_OF(not_finite); i++) {
        BAD(stiffness, not_finite[i], MSPRING_ERROR_ARGUMENT, "stiffness");
        BAD(damping, not_finite[i], MSPRING_ERROR_ARGUMENT, "damping");
        BAD(rest_length, not_finite[i], MSPRING_ERROR_ARGUMENT, "rest length");
    }
    BAD(stiffness, -1, MSPRING_ERROR_ARGUMENT, "stiffness");
    BAD(stiffness, 1.1e30f, MSPRING_ERROR_ARGUMENT, "stiffness");
    BAD(damping, -FLT_MIN, MSPRING_ERROR_ARGUMENT, "damping");
    BAD(damping, FLT_MAX, MSPRING_ERROR_ARGUMENT, "damping");
    BAD(rest_length, -FLT_MIN, MSPRING_ERROR_ARGUMENT, "rest length");
    BAD(rest_length, -0.5f, MSPRING_ERROR_ARGUMENT, "rest length");
    BAD(rest_length, -2, MSPRING_ERROR_ARGUMENT, "rest length");
    BAD(rest_length, 4.1e12f, MSPRING_ERROR_ARGUMENT, "rest length");
    BAD(flags, MSPRING_SPRING_METRES << 1, MSPRING_ERROR_ARGUMENT, "flags");
    BAD(flags, MSPRING_SPRING_PULL_ONLY | MSPRING_SPRING_PUSH_ONLY, MSPRING_ERROR_ARGUMENT, "exclude");
    BAD(b, 2, MSPRING_ERROR_ARGUMENT, "particle 2");   // to itself
    BAD(b, 10, MSPRING_ERROR_ID, "10");                // to nowhere
    BAD(a, 12345, MSPRING_ERROR_ID, "12345");          // from nowhere
    BAD(a, MSPRING_NONE, MSPRING_ERROR_ID, "not set"); // the default
    BAD(struct_size, 4, MSPRING_ERROR_STRUCT, "mspring_spring_def");
    BAD(struct_size, sizeof good + 2, MSPRING_ERROR_STRUCT, "mspring_spring_def");
    BAD(a, 8, MSPRING_ERROR_ARGUMENT, "8 and 9"); // the distance of two particles in the same place
    cases[n - 1].def.b = 9;
#undef BAD
    *count = n;
    return cases;
}

static void bad_spring_is_refused(void **state) {
    mspring_builder *builder = *state;
    size_t count;
    const spring_case *cases = bad_springs(&count);
    for (size_t i = 0; i < count; i++) {
        mspring_id id = 4711;
        check_refused(builder, mspring_builder_add_springs(builder, &cases[i].def, 1, &id), cases[i].code,
                      cases[i].part);
        assert_int_equal(id, 4711);
    }
    check_refused(builder, mspring_builder_add_springs(builder, NULL, 1, NULL), MSPRING_ERROR_ARGUMENT, "NULL");
    check_error(mspring_builder_add_springs(NULL, &cases[0].def, 1, NULL), MSPRING_ERROR_ARGUMENT);
}

static void bulk_springs_are_all_or_nothing(void **state) {
    mspring_builder *builder = *state;
    size_t count;
    const spring_case *cases = bad_springs(&count);
    enum { MANY = 40, CULPRIT = 33 };
    mspring_spring_def defs[MANY];
    for (size_t i = 0; i < MANY; i++) {
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &defs[i], sizeof defs[i]));
        defs[i].a = (mspring_id)(i % 7);
        defs[i].b = (mspring_id)(i % 7 + 1);
    }
    for (size_t i = 0; i < count; i++) {
        mspring_id first = 4711;
        defs[CULPRIT] = cases[i].def;
        check_refused(builder, mspring_builder_add_springs(builder, defs, MANY, &first), cases[i].code, "33");
        assert_int_equal(first, 4711);
    }
    check_refused(builder, mspring_builder_add_springs(builder, NULL, MANY, NULL), MSPRING_ERROR_ARGUMENT, "NULL");
    check_error(mspring_builder_add_springs(NULL, defs, MANY, NULL), MSPRING_ERROR_ARGUMENT);
    check_refused(builder, mspring_builder_add_springs(builder, defs, UINT32_MAX, NULL), MSPRING_ERROR_LIMIT,
                  "limit");
    check_refused(builder, mspring_builder_add_springs(builder, defs, MSPRING_MAX_SPRINGS, NULL),
                  MSPRING_ERROR_LIMIT, "limit");
}

static void coincident_particles_may_have_a_spring_with_a_rest_length(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_particle(builder, 1, 1, 1);
    support_particle(builder, 1, 1, 1);
    mspring_spring_def def;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = 1;
    def.b = 0;
    def.rest_length = 2;
    check_ok(mspring_builder_add_springs(builder, &def, 1, NULL));
    mspring_builder_destroy(builder);
}

/* ---------------------------------------------------------------------------------------------- lattices */

static void bad_lattice_is_refused(void **state) {
    mspring_builder *builder = *state;
    uint16_t cells[12] = {0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1};
    mspring_material materials[2];
    mspring_lattice_def good;
    mspring_id ids[12];
    memset(ids, 0x33, sizeof ids);
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &materials[i], sizeof materials[i]));
    }
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &good, sizeof good));
    good.width = 4;
    good.height = 3;
    good.cells = cells;
    good.materials = materials;
    good.material_count = 2;
#define REFUSED(field, value, code, part)                                                                          \
    do {                                                                                                           \
        mspring_lattice_def def = good;                                                                            \
        def.field = (value);                                                                                       \
        check_refused(builder, mspring_builder_add_lattice(builder, &def, ids), (code), (part));                   \
    } while (0)
    for (size_t i = 0; i < COUNT_OF(not_finite); i++) {
        REFUSED(x, (double)not_finite[i], MSPRING_ERROR_ARGUMENT, "lattice");
        REFUSED(y, (double)not_finite[i], MSPRING_ERROR_ARGUMENT, "lattice");
        REFUSED(spacing, (double)not_finite[i], MSPRING_ERROR_ARGUMENT, "spacing");
    }
    REFUSED(spacing, 0, MSPRING_ERROR_ARGUMENT, "spacing");
    REFUSED(spacing, -1, MSPRING_ERROR_ARGUMENT, "spacing");
    REFUSED(spacing, 0.9e-9, MSPRING_ERROR_ARGUMENT, "spacing");
    REFUSED(spacing, 1.1e9, MSPRING_ERROR_ARGUMENT, "spacing");
    // So far out that neighbouring cells would fall together, in either direction: numbers there are 1e-4 apart.
    good.spacing = 1e-5;
    REFUSED(x, 9e11, MSPRING_ERROR_ARGUMENT, "spacing");
    REFUSED(y, 9e11, MSPRING_ERROR_ARGUMENT, "spacing");
    REFUSED(x, -9e11, MSPRING_ERROR_ARGUMENT, "spacing");
    good.spacing = 1;
    REFUSED(x, 1e12, MSPRING_ERROR_ARGUMENT, "1e12"); // its right columns would be outside
    REFUSED(y, 1e12, MSPRING_ERROR_ARGUMENT, "1e12"); // its upper rows would
    REFUSED(x, -1.001e12, MSPRING_ERROR_ARGUMENT, "1e12");
    REFUSED(width, 0, MSPRING_ERROR_ARGUMENT, "0 x 3");
    REFUSED(height, 0, MSPRING_ERROR_ARGUMENT, "4 x 0");
    REFUSED(width, UINT32_MAX, MSPRING_ERROR_LIMIT, "limit");
    REFUSED(height, UINT32_MAX, MSPRING_ERROR_LIMIT, "limit");
    REFUSED(width, MSPRING_MAX_PARTICLES / 2, MSPRING_ERROR_LIMIT, "limit"); // times 3 rows
    REFUSED(materials, NULL, MSPRING_ERROR_ARGUMENT, "materials");
    // Springs that nobody could add again.
    materials[1].stiffness = 1e29f;
    REFUSED(shear_share, 11, MSPRING_ERROR_ARGUMENT, "material 1: times 11");
    REFUSED(bend_share, 11, MSPRING_ERROR_ARGUMENT, "material 1: times 11");
    materials[1].stiffness = 0;
    materials[0].damping = 1e29f;
    REFUSED(shear_share, 11, MSPRING_ERROR_ARGUMENT, "damping of 1e+29");
    materials[0].damping = 0;
    REFUSED(material_count, 65536, MSPRING_ERROR_LIMIT, "65536");
    REFUSED(material_count, 1, MSPRING_ERROR_ARGUMENT, "column 1, row 0"); // cells of material 1
    REFUSED(struct_size, 0, MSPRING_ERROR_STRUCT, "mspring_lattice_def");
    REFUSED(struct_size, sizeof good + 2, MSPRING_ERROR_STRUCT, "mspring_lattice_def");
#undef REFUSED
    // 2^32 cells: the product does not fit 32 bits.
    mspring_lattice_def huge = good;
    huge.width = huge.height = 65536;
    check_refused(builder, mspring_builder_add_lattice(builder, &huge, ids), MSPRING_ERROR_LIMIT, "limit");

    cells[11] = 2;
    check_refused(builder, mspring_builder_add_lattice(builder, &good, ids), MSPRING_ERROR_ARGUMENT,
                  "column 3, row 2");
    cells[11] = MSPRING_CELL_EMPTY - 1;
    check_refused(builder, mspring_builder_add_lattice(builder, &good, ids), MSPRING_ERROR_ARGUMENT, "65534");
    cells[11] = 1;

    check_refused(builder, mspring_builder_add_lattice(builder, NULL, ids), MSPRING_ERROR_ARGUMENT, "NULL");
    check_error(mspring_builder_add_lattice(NULL, &good, ids), MSPRING_ERROR_ARGUMENT);
    for (size_t i = 0; i < COUNT_OF(ids); i++) {
        assert_int_equal(ids[i], 0x33333333);
    }
}

static void bad_material_is_refused_and_named(void **state) {
    mspring_builder *builder = *state;
    const uint16_t cells[2] = {0, 1};
    mspring_material materials[2];
    mspring_lattice_def def;
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def));
    def.width = 2;
    def.height = 1;
    def.cells = cells;
    def.materials = materials;
    def.material_count = 2;
#define REFUSED(field, value, code, part)                                                                          \
    do {                                                                                                           \
        check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &materials[0], sizeof materials[0]));                       \
        check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &materials[1], sizeof materials[1]));                       \
        materials[1].field = (value);                                                                              \
        check_refused(builder, mspring_builder_add_lattice(builder, &def, NULL), (code), (part));                  \
    } while (0)
    for (size_t i = 0; i < COUNT_OF(not_finite); i++) {
        REFUSED(mass, not_finite[i], MSPRING_ERROR_ARGUMENT, "material 1: mass");
        REFUSED(stiffness, not_finite[i], MSPRING_ERROR_ARGUMENT, "material 1: stiffness");
        REFUSED(damping, not_finite[i], MSPRING_ERROR_ARGUMENT, "material 1: damping");
    }
    REFUSED(mass, 0, MSPRING_ERROR_ARGUMENT, "material 1: mass");
    REFUSED(mass, -3, MSPRING_ERROR_ARGUMENT, "material 1: mass");
    REFUSED(stiffness, -3, MSPRING_ERROR_ARGUMENT, "material 1: stiffness");
    REFUSED(damping, -3, MSPRING_ERROR_ARGUMENT, "material 1: damping");
    REFUSED(particle_flags, 2, MSPRING_ERROR_ARGUMENT, "material 1");
    REFUSED(spring_flags, 32, MSPRING_ERROR_ARGUMENT, "material 1");
    REFUSED(spring_flags, MSPRING_SPRING_RELATIVE, MSPRING_ERROR_ARGUMENT, "spring_flags are 0x1");
    REFUSED(struct_size, 0, MSPRING_ERROR_STRUCT, "mspring_material");
    REFUSED(struct_size, sizeof materials[0] + 2, MSPRING_ERROR_STRUCT, "mspring_material");
#undef REFUSED
}

/* ------------------------------------------------------------------------------------------------- ropes */

static void bad_rope_is_refused(void **state) {
    mspring_builder *builder = *state;
    mspring_rope_def good;
    check_ok(mspring_init(MSPRING_STRUCT_ROPE_DEF, &good, sizeof good));
    good.from = 2;
    good.to = 6;
    good.segment_count = 3;
    const mspring_material good_material = mspring_material_default();
    good.material = &good_material;
    mspring_id ids[2] = {4711, 4711}, first_spring = 4712;
#define REFUSED(field, value, code, part)                                                                          \
    do {                                                                                                           \
        mspring_rope_def def = good;                                                                               \
        mspring_material material = good_material;                                                                 \
        def.material = &material;                                                                                  \
        field = (value);                                                                                           \
        check_refused(builder, mspring_builder_add_rope(builder, &def, ids, &first_spring), (code), (part));       \
    } while (0)
    for (size_t i = 0; i < COUNT_OF(not_finite); i++) {
        REFUSED(material.mass, not_finite[i], MSPRING_ERROR_ARGUMENT, "mass");
        REFUSED(material.stiffness, not_finite[i], MSPRING_ERROR_ARGUMENT, "stiffness");
        REFUSED(material.damping, not_finite[i], MSPRING_ERROR_ARGUMENT, "damping");
        REFUSED(def.length_ratio, not_finite[i], MSPRING_ERROR_ARGUMENT, "length_ratio");
    }
    REFUSED(material.mass, 0, MSPRING_ERROR_ARGUMENT, "material of the rope: mass");
    REFUSED(material.stiffness, -1, MSPRING_ERROR_ARGUMENT, "material of the rope: stiffness");
    REFUSED(material.damping, -1, MSPRING_ERROR_ARGUMENT, "damping");
    REFUSED(def.length_ratio, 0, MSPRING_ERROR_ARGUMENT, "length_ratio");
    REFUSED(def.length_ratio, 0.0009f, MSPRING_ERROR_ARGUMENT, "length_ratio");
    REFUSED(def.length_ratio, 1001, MSPRING_ERROR_ARGUMENT, "length_ratio");
    REFUSED(material.spring_flags, 32, MSPRING_ERROR_ARGUMENT, "flags");
    REFUSED(def.segment_count, 0, MSPRING_ERROR_ARGUMENT, "segment");
    REFUSED(def.segment_count, MSPRING_MAX_PARTICLES + 2, MSPRING_ERROR_LIMIT, "limit");
    REFUSED(def.segment_count, UINT32_MAX, MSPRING_ERROR_LIMIT, "limit");
    REFUSED(def.to, 2, MSPRING_ERROR_ARGUMENT, "particle 2");
    REFUSED(def.to, 10, MSPRING_ERROR_ID, "10");
    REFUSED(def.from, 77777, MSPRING_ERROR_ID, "77777");
    REFUSED(def.from, MSPRING_NONE, MSPRING_ERROR_ID, "not set");
    REFUSED(def.struct_size, 0, MSPRING_ERROR_STRUCT, "mspring_rope_def");
    REFUSED(def.struct_size, sizeof good + 2, MSPRING_ERROR_STRUCT, "mspring_rope_def");
#undef REFUSED
    // Between two particles in the same place: segments of no length.
    mspring_rope_def def = good;
    def.from = 8;
    def.to = 9;
    check_refused(builder, mspring_builder_add_rope(builder, &def, NULL, NULL), MSPRING_ERROR_ARGUMENT, "8 to 9");
    check_refused(builder, mspring_builder_add_rope(builder, NULL, NULL, NULL), MSPRING_ERROR_ARGUMENT, "NULL");
    check_error(mspring_builder_add_rope(NULL, &good, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    good.material = NULL;
    check_refused(builder, mspring_builder_add_rope(builder, &good, NULL, NULL), MSPRING_ERROR_ARGUMENT,
                  "material is NULL");
    assert_int_equal(ids[0], 4711);
    assert_int_equal(first_spring, 4712);
}

// A later version may give a meaning to what is reserved, so garbage in it is refused by name.
static void no_tasks(uint32_t count, mspring_task_fn fn, void *argument, void *user) {
    (void)user;
    for (uint32_t i = 0; i < count; i++)
        fn(argument, i, 0);
}

static void no_hook(const mspring_hook_args *args, void *user) {
    (void)args;
    (void)user;
}

static void reserved_fields_must_be_zero(void **state) {
    (void)state;
    mspring_builder *builder = NULL;
    mspring_network *network = NULL, *other = NULL;
    mspring_particle_def particle;
    check_ok(mspring_builder_create(NULL, &builder));
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &particle, sizeof particle));
    check_ok(mspring_builder_add_particles(builder, &particle, 1, NULL));
    mspring_network_def def;
    check_ok(mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def));
    mspring_tasks tasks = {
        .struct_size = sizeof tasks, .worker_count = 1, .concurrent_count = 1, .reserved = 7, .run = no_tasks};
    def.tasks = &tasks;
    check_error(mspring_network_create(builder, &def, &network), MSPRING_ERROR_ARGUMENT);
    check_contains(support_builder_error(builder), "mspring_tasks.reserved is 7");
    tasks.reserved = 0;
    check_ok(mspring_network_create(builder, &def, &network));

    mspring_hook_def hook;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &hook, sizeof hook));
    hook.fn = no_hook, hook.reserved = 3;
    check_error(mspring_network_add_hook(network, &hook, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "mspring_hook_def.reserved is 3");
    mspring_settle_def settle;
    check_ok(mspring_init(MSPRING_STRUCT_SETTLE_DEF, &settle, sizeof settle));
    settle.reserved = 1;
    check_error(mspring_network_settle(network, &settle, NULL), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "mspring_settle_def.reserved is 1");
    const double ground[4] = {0, 0, 0, 1};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = ground, floor.plane_count = 1, floor.reserved = UINT32_MAX;
    check_error(mspring_network_set_floor(network, &floor), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "mspring_floor_def.reserved is 4294967295");
    mspring_clone_def clone;
    check_ok(mspring_init(MSPRING_STRUCT_CLONE_DEF, &clone, sizeof clone));
    clone.reserved = 1;
    check_error(mspring_network_clone(network, &clone, &other), MSPRING_ERROR_ARGUMENT);
    assert_null(other);
    mspring_network_destroy(network);
    mspring_builder_destroy(builder);
}

int main(void) {
#define REFUSAL(test) cmocka_unit_test_setup_teardown(test, make_builder, check_builder)
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(create_needs_a_place_and_a_whole_allocator),
        REFUSAL(bad_particle_is_refused),
        REFUSAL(bulk_particles_are_all_or_nothing),
        cmocka_unit_test(particles_at_the_ends_of_the_ranges_are_accepted),
        REFUSAL(bad_spring_is_refused),
        REFUSAL(bulk_springs_are_all_or_nothing),
        cmocka_unit_test(coincident_particles_may_have_a_spring_with_a_rest_length),
        REFUSAL(bad_lattice_is_refused),
        REFUSAL(bad_material_is_refused_and_named),
        REFUSAL(bad_rope_is_refused),
        cmocka_unit_test(reserved_fields_must_be_zero),
    };
    return cmocka_run_group_tests_name("bad_input", tests, NULL, NULL);
}

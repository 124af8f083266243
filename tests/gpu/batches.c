/// Random batches.
///
/// SPDX-License-Identifier: MIT
#include "batches.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_SIDE 8
#define MOST_PLANES 3

static double between(batch *b, double low, double high) {
    return support_random_between(&b->seed, low, high);
}

static uint32_t below(batch *b, uint32_t count) {
    return (uint32_t)(support_random(&b->seed) % count);
}

static bool chance(batch *b, double share) {
    return between(b, 0, 1) < share;
}

void batch_need_device(void) {
    char text[4096];
    if (mspring_gpu_describe_devices(NULL, text, sizeof text) == MSPRING_OK) {
        for (const char *line = text; *line != '\0'; line = strchr(line, '\n') + 1) {
            const char *end = strchr(line, '\n'), *unfit = strstr(line, "does not suit");
            if (unfit == NULL || unfit > end)
                return;
        }
    }
    print_message("no device of OpenCL suits (Debian: apt-get install pocl-opencl-icd ocl-icd-libopencl1)\n%s\n", text);
    exit(77);
}

/* ------------------------------------------------------------------------------------------------------- a body */

typedef struct body_kind {
    bool is_relative, is_damped, has_welds;
    float stiffness, damping;
} body_kind;

static void join(batch *b, mspring_builder *body, const body_kind *kind, mspring_id from, mspring_id to) {
    mspring_spring_def def;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = from;
    def.b = to;
    def.stiffness = (float)between(b, 0.2, 1) * (kind->is_relative ? 0.2f : kind->stiffness);
    def.damping = kind->is_damped ? (float)between(b, 0, 1) * (kind->is_relative ? 0.1f : kind->damping) : 0;
    def.flags = kind->is_relative ? MSPRING_SPRING_RELATIVE : 0;
    if (kind->has_welds && chance(b, 0.1))
        def.rest_length = 0;
    check_ok(mspring_builder_add_springs(body, &def, 1, NULL));
}

static void place(batch *b, mspring_builder *body, double x, double y) {
    mspring_particle_def def;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def));
    def.x = x;
    def.y = y;
    def.mass = (float)between(b, 0.5, 2);
    def.flags = chance(b, 0.05) ? MSPRING_PARTICLE_PINNED : 0;
    check_ok(mspring_builder_add_particles(body, &def, 1, NULL));
}

// A lattice of width * height, in which each cell but those of two sides may be empty.
static void add_lattice(batch *b, mspring_builder *body, const body_kind *kind, bool is_plain) {
    const uint32_t width = 4 + below(b, is_plain ? 3 : 5), height = 4 + below(b, is_plain ? 3 : 5);
    const bool has_holes = chance(b, 0.4);
    mspring_id cells[MOST_SIDE + 1][MOST_SIDE + 1];
    memset(cells, 0xff, sizeof cells);
    for (uint32_t row = 0; row < height; row++)
        for (uint32_t column = 0; column < width; column++) {
            if (has_holes && row > 0 && column > 0 && chance(b, 0.1))
                continue;
            cells[row][column] = mspring_builder_count(body, MSPRING_PARTICLES);
            place(b, body, 0.5 * column, 0.5 * row + 0.2);
        }
    for (uint32_t row = 0; row < height; row++)
        for (uint32_t column = 0; column < width; column++) {
            const mspring_id to[] = {cells[row][column + 1], cells[row + 1][column], cells[row + 1][column + 1],
                                     column > 0 ? cells[row + 1][column - 1] : MSPRING_NONE};
            for (int i = 0; i < 4; i++)
                if (cells[row][column] != MSPRING_NONE && to[i] != MSPRING_NONE)
                    join(b, body, kind, cells[row][column], to[i]);
        }
}

static void add_chain(batch *b, mspring_builder *body, const body_kind *kind) {
    const uint32_t count = 3 + below(b, 20);
    for (uint32_t i = 0; i < count; i++) {
        place(b, body, 0.4 * i, 0.5 + between(b, 0, 0.2));
        if (i > 0)
            join(b, body, kind, i - 1, i);
    }
}

static void add_web(batch *b, mspring_builder *body, const body_kind *kind, bool is_plain) {
    const uint32_t first = mspring_builder_count(body, MSPRING_PARTICLES), count = 12 + below(b, is_plain ? 12 : 300);
    for (uint32_t i = 0; i < count; i++) {
        place(b, body, 0.4 * (i % 8) + between(b, 0, 0.2), 0.4 * (i / 8) + between(b, 0, 0.2));
        if (i > 0)
            join(b, body, kind, first + i - 1, first + i);
        if (i > 1)
            join(b, body, kind, first + i - 2, first + i);
        if (i > 3 && chance(b, 0.5))
            join(b, body, kind, first + below(b, i - 2), first + i);
    }
}

static mspring_builder *draw_body(batch *b, bool is_plain) {
    const body_kind kind = {.is_relative = chance(b, 0.2), .is_damped = chance(b, 0.7), .has_welds = chance(b, 0.1),
                            .stiffness = (float)between(b, 100, 1000), .damping = (float)between(b, 0.1, 4)};
    mspring_builder *body = support_builder();
    if (b->shape == BATCH_CHAIN)
        add_chain(b, body, &kind);
    else if (b->shape == BATCH_WEB)
        add_web(b, body, &kind, is_plain);
    else
        add_lattice(b, body, &kind, is_plain);
    if (b->shape == BATCH_MIXED) {
        const uint32_t first = mspring_builder_count(body, MSPRING_PARTICLES);
        add_web(b, body, &kind, true);
        join(b, body, &kind, 0, first);
    }
    return body;
}

/* ------------------------------------------------------------------------------------------------- the network */

static void set_planes(batch *b) {
    double planes[MOST_PLANES][4] = {{0, between(b, -0.2, 0.2), between(b, -0.3, 0.3), between(b, 0.5, 2)},
                                     {between(b, 2, 5), 0, -1, between(b, -0.5, 0.5)},
                                     {between(b, -1, 0), 0, 1, 0}};
    const float frictions[] = {0.2f, 0.7f, 0}, restitutions[] = {0, 0.3f, 0.9f};
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.planes = planes[0];
    def.plane_count = 1 + below(b, MOST_PLANES);
    def.friction = (float)between(b, 0, 1);
    def.restitution = (float)between(b, 0, 1);
    if (chance(b, 0.3)) {
        def.plane_frictions = frictions;
        def.plane_restitutions = restitutions;
    }
    check_ok(mspring_network_set_floor(b->network, &def));
}

// Positions and velocities that differ from body to body.
static void set_motion(batch *b) {
    const uint32_t all = b->body_count * b->particle_count;
    for (mspring_id p = 0; p < all; p++) {
        const support_point at = support_position(b->network, p);
        const double x = at.x + between(b, -0.05, 0.05), y = at.y + between(b, -0.05, 0.05);
        const float vx = (float)between(b, -2, 2), vy = (float)between(b, -2, 2);
        check_ok(mspring_network_set_positions(b->network, &p, 0, 1, &x, &y, 1));
        check_ok(mspring_network_set_velocities(b->network, &p, 0, 1, &vx, &vy, 1));
    }
}

static void set_groups(batch *b) {
    mspring_id *firsts = malloc((b->body_count + 1) * sizeof *firsts);
    assert_non_null(firsts);
    for (uint32_t i = 0; i <= b->body_count; i++)
        firsts[i] = i * b->particle_count;
    check_ok(mspring_network_set_groups(b->network, firsts, b->body_count));
    free(firsts);
}

static void draw_actuators(batch *b) {
    b->changes = chance(b, 0.3) ? 1 : 1 + below(b, 20);
    const uint32_t wanted = chance(b, 0.7) ? 1 + below(b, BATCH_ACTUATORS) : 0;
    const uint32_t all = wanted < b->spring_count / 2 ? wanted : b->spring_count / 2;
    for (uint32_t s = below(b, 2); b->actuator_count < all && s < b->spring_count; s += 2) {
        float length;
        check_ok(mspring_network_get(b->network, MSPRING_REST_LENGTH, NULL, s, 1, &length, 1));
        if (length > 0)
            b->actuators[b->actuator_count++] = s;
    }
    mspring_id *springs = malloc((size_t)b->body_count * BATCH_ACTUATORS * sizeof *springs);
    assert_non_null(springs);
    for (uint32_t i = 0; i < b->body_count * b->actuator_count; i++)
        springs[i] = b->actuators[i % b->actuator_count] + i / b->actuator_count * b->spring_count;
    check_ok(mspring_network_set_actuators(b->network, springs, b->body_count * b->actuator_count, b->changes));
    free(springs);
}

batch batch_draw(uint64_t seed, batch_shape shape, bool has_floor, bool is_plain) {
    batch b = {.seed = seed, .shape = shape};
    mspring_builder *body = draw_body(&b, is_plain), *all = support_builder();
    b.body_count = 1 + below(&b, shape == BATCH_MIXED ? 80 : 40);
    b.particle_count = mspring_builder_count(body, MSPRING_PARTICLES);
    b.spring_count = mspring_builder_count(body, MSPRING_SPRINGS);
    check_ok(mspring_builder_add_copies(all, body, b.body_count, NULL, NULL, 0, NULL, NULL));
    mspring_network_def def = support_def(chance(&b, 0.8) ? (float)between(&b, -10, 10) : 0, 1 + below(&b, 24));
    def.settings.gravity_x = chance(&b, 0.3) ? (float)between(&b, -3, 3) : 0;
    def.settings.global_damping = chance(&b, 0.3) ? (float)between(&b, 0, 3) : 0;
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    def.settings.max_speed = is_plain ? 1e6f : (float)between(&b, 4, 40);
    b.dt = 0.002 * (double)def.settings.substeps * between(&b, 0.5, 1);
    b.network = support_network(all, &def);
    mspring_builder_destroy(body);
    set_motion(&b);
    if (has_floor)
        set_planes(&b);
    set_groups(&b);
    draw_actuators(&b);
    return b;
}

batch batch_of_copies(uint64_t seed, batch_shape shape, uint32_t count) {
    batch b = {.seed = seed, .shape = shape, .body_count = count, .changes = 1, .dt = 1.0 / 64};
    mspring_builder *body = draw_body(&b, true), *all = support_builder();
    b.particle_count = mspring_builder_count(body, MSPRING_PARTICLES);
    b.spring_count = mspring_builder_count(body, MSPRING_SPRINGS);
    check_ok(mspring_builder_add_copies(all, body, count, NULL, NULL, 0, NULL, NULL));
    mspring_network_def def = support_def(-9.8f, 20);
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    b.network = support_network(all, &def);
    mspring_builder_destroy(body);
    set_planes(&b);
    set_groups(&b);
    return b;
}

void batch_destroy(batch *b) {
    mspring_network_destroy(b->network);
}

/* --------------------------------------------------------------------------------------------------- the device */

mspring_gpu *batch_on_device(const batch *b, uint32_t times) {
    char message[1024] = "";
    mspring_gpu_def def = mspring_gpu_def_default();
    mspring_gpu *gpu = NULL;
    def.body_count = times * b->body_count;
    def.actuators = b->actuators;
    def.actuator_count = b->actuator_count;
    def.changes = b->changes;
    def.message = message;
    def.message_size = sizeof message;
    const mspring_result result = mspring_gpu_create(b->network, &def, &gpu);
    if (result == MSPRING_ERROR_ARGUMENT && (strstr(message, "slots don't tell") || strstr(message, "otherwise")))
        return NULL;
    if (result != MSPRING_OK)
        print_error("%s\n", message);
    check_ok(result);
    return gpu;
}

// All columns that a device knows, and one of a particle that is not there. Rows lie 2 numbers apart.
static void check_rows(const batch *b, mspring_gpu *gpu) {
    enum { COLUMNS = 39, STRIDE = COLUMNS + 2 };
    const mspring_property of_body[] = {MSPRING_GROUP_X,     MSPRING_GROUP_Y,     MSPRING_GROUP_VX,
                                        MSPRING_GROUP_VY,    MSPRING_GROUP_MIN_X, MSPRING_GROUP_MIN_Y,
                                        MSPRING_GROUP_MAX_X, MSPRING_GROUP_MAX_Y, MSPRING_GROUP_FLAGS};
    const mspring_property of_particle[] = {MSPRING_RELATIVE_X,  MSPRING_RELATIVE_Y, MSPRING_RELATIVE_VX,
                                            MSPRING_RELATIVE_VY, MSPRING_X,          MSPRING_Y,
                                            MSPRING_VX,          MSPRING_VY,         MSPRING_MASS};
    const uint32_t chosen[] = {0, b->particle_count - 1, b->particle_count / 2};
    mspring_observation columns[COLUMNS];
    uint32_t made = 0;
    for (size_t i = 0; i < COUNT_OF(of_body); i++)
        columns[made++] = (mspring_observation){of_body[i], 0};
    for (size_t i = 0; i < 3 * COUNT_OF(of_particle); i++)
        columns[made++] = (mspring_observation){of_particle[i / 3], chosen[i % 3]};
    columns[made++] = (mspring_observation){MSPRING_X, b->particle_count};
    columns[made++] = (mspring_observation){MSPRING_RELATIVE_VY, UINT32_MAX};
    columns[made++] = (mspring_observation){MSPRING_GROUP_X, 0};
    assert_int_equal(made, COLUMNS);
    const size_t count = (size_t)b->body_count * STRIDE;
    double *expected = calloc(2 * count, sizeof *expected), *rows = expected + count;
    assert_non_null(expected);
    check_ok(mspring_network_observe_groups(b->network, NULL, 0, b->body_count, columns, COLUMNS, expected, STRIDE));
    check_ok(mspring_gpu_observe(gpu, 0, b->body_count, columns, COLUMNS, rows, STRIDE));
    assert_memory_equal(expected, rows, count * sizeof *rows);
    memset(expected, 0, 2 * count * sizeof *expected);
    check_ok(mspring_network_observe_groups(b->network, NULL, 0, b->body_count, columns, COLUMNS, expected, COLUMNS));
    check_ok(mspring_gpu_observe(gpu, 0, b->body_count, columns, COLUMNS, rows, COLUMNS));
    assert_memory_equal(expected, rows, count * sizeof *rows);
    free(expected);
}

static void check_particles(const batch *b, mspring_gpu *gpu) {
    const uint32_t all = b->body_count * b->particle_count, first = all / 3, count = all - first;
    double *places = malloc(4 * (size_t)count * sizeof *places);
    float *velocities = malloc(4 * (size_t)count * sizeof *velocities);
    assert_true(places != NULL && velocities != NULL);
    check_ok(mspring_network_get_positions(b->network, NULL, first, count, places, places + 1, 2));
    check_ok(mspring_gpu_get_positions(gpu, first, count, places + 2 * (size_t)count, places + 2 * (size_t)count + 1, 2));
    check_ok(mspring_network_get_velocities(b->network, NULL, first, count, velocities, velocities + 1, 2));
    check_ok(mspring_gpu_get_velocities(gpu, first, count, velocities + 2 * (size_t)count,
                                        velocities + 2 * (size_t)count + 1, 2));
    assert_memory_equal(places, places + 2 * (size_t)count, 2 * count * sizeof *places);
    assert_memory_equal(velocities, velocities + 2 * (size_t)count, 2 * count * sizeof *velocities);
    free(places);
    free(velocities);
}

void batch_check_equal(const batch *b, mspring_gpu *gpu) {
    uint64_t hash;
    for (uint32_t body = 0; body < b->body_count; body++) {
        uint32_t expected, flags;
        check_ok(mspring_network_get_integers(b->network, MSPRING_GROUP_FLAGS, NULL, body, 1, &expected, 1));
        check_ok(mspring_gpu_get_flags(gpu, body, 1, &flags, 1));
        assert_int_equal(expected, flags);
    }
    check_particles(b, gpu);
    check_rows(b, gpu);
    if (mspring_gpu_body_count(gpu) == b->body_count) {
        check_ok(mspring_gpu_get_state_hash(gpu, &hash));
        assert_true(hash == support_hash(b->network));
    }
}

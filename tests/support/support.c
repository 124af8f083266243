/// @file support.c
///
/// SPDX-License-Identifier: MIT
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200112L // setenv
#endif

#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#if defined(_WIN32)
#include <malloc.h>
#endif

bool support_is_quick(void) {
    return getenv("MASSSPRING_TEST_QUICK") != NULL;
}

void support_set_variable(const char *name, const char *value) {
#if defined(_WIN32)
    assert_int_equal(_putenv_s(name, value != NULL ? value : ""), 0);
#else
    assert_int_equal(value != NULL ? setenv(name, value, 1) : unsetenv(name), 0);
#endif
}

void *support_aligned_alloc(size_t size) {
#if defined(_WIN32)
    void *memory = _aligned_malloc(size, 64);
#else
    void *memory = aligned_alloc(64, (size + 63) / 64 * 64);
#endif
    assert_non_null(memory);
    return memory;
}

void support_aligned_free(void *memory) {
#if defined(_WIN32)
    _aligned_free(memory);
#else
    free(memory);
#endif
}

void support_check_result(mspring_result actual, mspring_result expected, const char *call, const char *file,
                          int line) {
    if (actual != expected) {
        print_error("%s\n  gave %d (%s), expected %d (%s)\n", call, actual, mspring_result_string(actual), expected,
                    mspring_result_string(expected));
        _fail(file, line);
    }
}

void support_check_near(double actual, double expected, double tolerance, const char *what, const char *file,
                        int line) {
    if (!(fabs(actual - expected) <= tolerance)) {
        print_error("%s\n  is %.9g, expected %.9g within %.3g (off by %.3g)\n", what, actual, expected, tolerance,
                    actual - expected);
        _fail(file, line);
    }
}

void support_check_contains(const char *text, const char *part, const char *file, int line) {
    if (text == NULL || strstr(text, part) == NULL) {
        print_error("message \"%s\"\n  does not contain \"%s\"\n", text == NULL ? "(NULL)" : text, part);
        _fail(file, line);
    }
}

uint64_t support_random(uint64_t *seed) {
    *seed += 0x9e3779b97f4a7c15u;
    uint64_t bits = *seed;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    return bits ^ (bits >> 31);
}

double support_random_between(uint64_t *seed, double low, double high) {
    return low + (high - low) * ((double)(support_random(seed) >> 11) * 0x1p-53);
}

mspring_builder *support_builder(void) {
    mspring_builder *builder = NULL;
    check_ok(mspring_builder_create(NULL, &builder));
    return builder;
}

static mspring_id add_particle(mspring_builder *builder, double x, double y, float mass, uint32_t flags) {
    mspring_particle_def def;
    mspring_id id = MSPRING_NONE;
    check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def));
    def.x = x;
    def.y = y;
    def.mass = mass;
    def.flags = flags;
    check_ok(mspring_builder_add_particles(builder, &def, 1, &id));
    return id;
}

mspring_id support_particle(mspring_builder *builder, double x, double y, float mass) {
    return add_particle(builder, x, y, mass, 0);
}

mspring_id support_pinned(mspring_builder *builder, double x, double y, float mass) {
    return add_particle(builder, x, y, mass, MSPRING_PARTICLE_PINNED);
}

mspring_id support_spring(mspring_builder *builder, mspring_id a, mspring_id b, float stiffness, float damping) {
    mspring_spring_def def;
    mspring_id id = MSPRING_NONE;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = a;
    def.b = b;
    def.stiffness = stiffness;
    def.damping = damping;
    check_ok(mspring_builder_add_springs(builder, &def, 1, &id));
    return id;
}

mspring_id support_join(mspring_builder *builder, mspring_id a, mspring_id b, float stiffness, float rest_length,
                        uint32_t flags) {
    mspring_spring_def def;
    mspring_id id = MSPRING_NONE;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = a;
    def.b = b;
    def.stiffness = stiffness;
    def.rest_length = rest_length;
    def.flags = flags;
    check_ok(mspring_builder_add_springs(builder, &def, 1, &id));
    return id;
}

mspring_network_def support_def(float gravity_y, uint32_t substeps) {
    mspring_network_def def;
    check_ok(mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def));
    def.settings.gravity_y = gravity_y;
    def.settings.substeps = substeps;
    def.settings.guard = MSPRING_GUARD_GROWTH;
    return def;
}

mspring_guard support_guard_of(mspring_solver solver) {
    return solver == MSPRING_SOLVER_EXPLICIT ? MSPRING_GUARD_GROWTH : MSPRING_GUARD_CLAMP;
}

mspring_network *support_network(mspring_builder *builder, const mspring_network_def *def) {
    mspring_network *network = NULL;
    mspring_result result = mspring_network_create(builder, def, &network);
    if (result != MSPRING_OK) {
        print_error("%s\n", support_builder_error(builder));
    }
    check_ok(result);
    mspring_builder_destroy(builder);
    return network;
}

mspring_step_info support_step_info(const mspring_network *network) {
    mspring_step_info info = {.struct_size = sizeof info};
    check_ok(mspring_network_get_step_info(network, &info));
    return info;
}

uint32_t support_substeps(const mspring_network *network) {
    return support_step_info(network).substeps;
}

uint64_t support_fallback_count(const mspring_network *network) {
    return support_step_info(network).fallback_count;
}

mspring_settings support_solver(const mspring_network *network) {
    mspring_settings def = {.struct_size = sizeof def};
    check_ok(mspring_network_get_settings(network, &def));
    return def;
}

void support_set_residual(mspring_network *network, float residual) {
    mspring_settings def = support_solver(network);
    def.residual = residual;
    check_ok(support_set_solver(network, &def));
}

mspring_settings support_settings(const mspring_network *network) {
    mspring_settings settings = {.struct_size = sizeof settings};
    check_ok(mspring_network_get_settings(network, &settings));
    return settings;
}

mspring_result support_set_gravity(mspring_network *network, float x, float y) {
    mspring_settings settings = support_settings(network);
    settings.gravity_x = x;
    settings.gravity_y = y;
    return mspring_network_set_settings(network, &settings);
}

mspring_result support_set_global_damping(mspring_network *network, float rate) {
    mspring_settings settings = support_settings(network);
    settings.global_damping = rate;
    return mspring_network_set_settings(network, &settings);
}

mspring_result support_set_guard(mspring_network *network, mspring_guard guard) {
    mspring_settings settings = support_settings(network);
    settings.guard = guard;
    return mspring_network_set_settings(network, &settings);
}

mspring_result support_set_relax_fraction(mspring_network *network, float fraction) {
    mspring_settings settings = support_settings(network);
    settings.relax_fraction = fraction;
    return mspring_network_set_settings(network, &settings);
}

void support_steps(mspring_network *network, uint32_t count, double dt) {
    for (uint32_t step = 0; step < count; step++) {
        mspring_result result = mspring_network_step(network, dt);
        if (result != MSPRING_OK) {
            print_error("step %u: %s\n", step, mspring_network_error(network));
        }
        check_ok(result);
    }
}

void support_kick(mspring_network *network, mspring_id particle, float speed) {
    const float along = 0.3f * speed;
    check_ok(mspring_network_set_velocities(network, NULL, particle, 1, &speed, &along, 1));
}

mspring_result support_add_hook(mspring_network *network, mspring_phase phase, mspring_hook_fn fn, void *user,
                                uint32_t *hook) {
    mspring_hook_def def;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def));
    def.phase = phase;
    def.fn = fn;
    def.user = user;
    return mspring_network_add_hook(network, &def, hook);
}

void support_compact(mspring_network *network, uint32_t functions, mspring_job **job) {
    uint32_t left = 1;
    if (!*job) {
        check_ok(mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, job));
    }
    check_ok(mspring_job_run(*job, functions, &left));
    if (left > 0) {
        return;
    }
    mspring_result result = mspring_job_finish(network, *job);
    mspring_job_destroy(*job);
    *job = NULL;
    if (result == MSPRING_ERROR_OUTDATED) {
        check_ok(mspring_job_begin(network, MSPRING_LAYOUT_COMPACT, job));
    } else {
        check_ok(result);
    }
}

support_point support_position(const mspring_network *network, mspring_id particle) {
    support_point point = {0, 0};
    check_ok(mspring_network_get_positions(network, NULL, particle, 1, &point.x, &point.y, 1));
    return point;
}

double support_distance(const mspring_network *a, const mspring_network *b) {
    const uint32_t count = mspring_network_count(a, MSPRING_PARTICLES);
    double sum = 0;
    for (mspring_id id = 0; id < count; id++) {
        const support_point p = support_position(a, id), q = support_position(b, id);
        sum += (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
    }
    return sqrt(sum / count);
}

support_point support_velocity(const mspring_network *network, mspring_id particle) {
    float vx = 0, vy = 0;
    check_ok(mspring_network_get_velocities(network, NULL, particle, 1, &vx, &vy, 1));
    return (support_point){vx, vy};
}

uint64_t support_hash(const mspring_network *network) {
    uint64_t hash = 0;
    check_ok(mspring_network_get_state_hash(network, &hash));
    return hash;
}

void support_bring(const mspring_network *from, mspring_network *to, mspring_snapshot_contents contents) {
    size_t size = 0;
    check_ok(mspring_network_get_snapshot_size(from, contents, &size));
    void *bytes = malloc(size);
    assert_non_null(bytes);
    check_ok(mspring_network_save(from, contents, bytes, size, NULL));
    check_ok(mspring_network_load(to, bytes, size));
    free(bytes);
}

double support_energy_of_motion(const mspring_network *network) {
    double kinetic, elastic;
    check_ok(support_get_energy(network, &kinetic, &elastic, NULL));
    return kinetic + elastic;
}

double support_energy(const mspring_network *network) {
    double kinetic, elastic, potential;
    check_ok(support_get_energy(network, &kinetic, &elastic, &potential));
    return kinetic + elastic + potential;
}

uint32_t support_levels(mspring_simd levels[MSPRING_SIMD_AVX512]) {
    uint32_t count = 0;
    for (mspring_simd level = MSPRING_SIMD_SCALAR; level <= MSPRING_SIMD_WASM; level++) {
        if (mspring_simd_available(level)) {
            levels[count++] = level;
        }
    }
    return count;
}

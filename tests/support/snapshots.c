#include "snapshots.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "store/snapshot_format.h"
#include "support.h"

enum { MOST = 400 };

mspring_network *snapshots_make(const recipe *made, mspring_simd level, uint32_t worker_count) {
    mspring_network_def def = support_def(-9.8f, 4);
    def.simd_level = level;
    def.worker_count = worker_count;
    return recipe_network(made, &def);
}

void snapshots_use_solver(mspring_network *network, mspring_solver kind, mspring_integrator integrator,
                          uint32_t coarse_period) {
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = kind;
    solver.integrator = integrator;
    solver.coarse_period = coarse_period;
    solver.substeps = 2;
    check_ok(support_set_solver(network, &solver));
}

saved snapshots_save(const mspring_network *network, mspring_snapshot_contents contents) {
    saved out;
    size_t written = 0;
    check_ok(mspring_network_get_snapshot_size(network, contents, &out.size));
    out.bytes = malloc(out.size + 1);
    assert_non_null(out.bytes);
    out.bytes[out.size] = 0xab;
    check_ok(mspring_network_save(network, contents, out.bytes, out.size, &written));
    assert_int_equal(written, out.size);
    assert_int_equal(out.bytes[out.size], 0xab);
    return out;
}

void snapshots_load(mspring_network *network, const saved *from) {
    mspring_result result = mspring_network_load(network, from->bytes, from->size);
    if (result != MSPRING_OK) {
        print_error("%s\n", mspring_network_error(network));
    }
    check_ok(result);
    // What has been loaded is saved as it was, unless the network had come by parts before that the snapshot lacks.
    mspringi_snapshot_header header, now;
    assert_true(mspringi_get_header(from->bytes, &header));
    saved again = snapshots_save(network, (mspring_snapshot_contents)header.contents);
    assert_true(mspringi_get_header(again.bytes, &now));
    if (again.size == from->size && now.section_count == header.section_count) {
        assert_memory_equal(again.bytes, from->bytes, from->size);
    }
    free(again.bytes);
}

void snapshots_set_up(mspring_network *network) {
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    float values[MOST * 2];
    assert_true(springs <= COUNT_OF(values));
    for (uint32_t i = 0; i < springs; i++) {
        values[i] = i % 7 == 0 ? INFINITY : 0.05f + 0.01f * (float)(i % 5);
    }
    check_ok(mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, springs, values, 1));
    for (uint32_t i = 0; i < springs; i++) {
        values[i] = 0.01f;
    }
    check_ok(mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, springs, values, 1));
    check_ok(support_set_relax_fraction(network, 0.7f));
    const float rest_length = 1.03f;
    const mspring_id spring = 3;
    check_ok(mspring_network_set(network, MSPRING_REST_LENGTH, &spring, 0, 1, &rest_length, 1));
}

void snapshots_run_frame(mspring_network *network, uint32_t frame) {
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    const uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES);
    const mspring_id broken[] = {frame * 7 % springs, frame * 13 % springs};
    check_ok(mspring_network_break_springs(network, broken, 0, 2));
    if (frame % 3 == 1) {
        const mspring_id whole[] = {(frame - 1) * 7 % springs};
        check_ok(mspring_network_restore_springs(network, whole, 0, 1, frame % 2 == 0 ? 0 : 0.5));
    }
    if (frame % 4 == 2) {
        const float mass = 1 + 0.1f * (float)(frame % 10);
        check_ok(mspring_network_set(network, MSPRING_MASS, NULL, frame % particles, 1, &mass, 1));
    }
    if (frame % 5 == 3) {
        const float scale = frame % 2 == 0 ? 0.5f : 1;
        check_ok(mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, frame * 3 % particles, 1, &scale, 1));
    }
    check_ok(support_set_gravity(network, 0.1f * (float)(frame % 3), -9.8f));
    check_ok(mspring_network_apply_force(network, frame * 11 % particles, 30, 5));
    check_ok(mspring_network_step(network, frame % 6 == 5 ? 0.013 : 0.01));
    // For the next step.
    check_ok(mspring_network_apply_force(network, frame * 5 % particles, -20, 3));
}

uint64_t snapshots_look_at(const mspring_network *network) {
    double energy[3];
    float strain[MOST * 2], mass[MOST], scale[MOST];
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    const uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES);
    uint64_t sum = support_hash(network);
    check_ok(support_get_energy(network, &energy[0], &energy[1], &energy[2]));
    check_ok(mspring_network_get(network, MSPRING_STRAIN, NULL, 0, springs, strain, 1));
    check_ok(mspring_network_get(network, MSPRING_MASS, NULL, 0, particles, mass, 1));
    check_ok(mspring_network_get(network, MSPRING_INVERSE_MASS_SCALE, NULL, 0, particles, scale, 1));
    const void *const parts[] = {energy, strain, mass, scale};
    const size_t sizes[] = {sizeof energy, springs * sizeof *strain, particles * sizeof *mass,
                            particles * sizeof *scale};
    for (size_t part = 0; part < COUNT_OF(parts); part++) {
        for (size_t i = 0; i < sizes[part]; i++) {
            sum = (sum ^ ((const uint8_t *)parts[part])[i]) * 0x100000001b3u;
        }
    }
    for (mspring_id s = 0; s < springs; s++) {
        if (!support_has_spring(network, s)) {
            continue;
        }
        support_spring_info info;
        check_ok(support_get_spring(network, s, &info));
        uint32_t stiffness;
        memcpy(&stiffness, &info.stiffness, sizeof stiffness);
        sum = (sum ^ info.flags ^ (uint64_t)stiffness << 32) * 0x100000001b3u;
    }
    return sum;
}

recipe snapshots_small_recipe(void) {
    uint64_t seed = 5;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {50, 90}, .damping = {0, 1}};
    const recipe_stuff relative = {
        .mass = {1, 2}, .stiffness = {0.1, 0.2}, .spring_flags = MSPRING_SPRING_RELATIVE};
    recipe made = {0};
    recipe_lattice(&made, 4, 3, 0, 0, 1, &stuff, &seed);
    const mspring_id end = recipe_particle(&made, 9, 3, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 11, end, 4, &relative, &seed);
    return made;
}

void snapshots_renew_checksum(saved *of) {
    const size_t summed = of->size - MSPRINGI_SNAPSHOT_CHECKSUM_BYTES;
    mspringi_checksum checksum = {{0}, {0}};
    mspringi_kernels_scalar.checksum(NULL, of->bytes, summed / MSPRINGI_CHECKSUM_UNIT, &checksum);
    const uint64_t value = mspringi_checksum_value(&checksum);
    mspringi_writer to = mspringi_writer_begin(of->bytes + summed, &mspringi_kernels_scalar);
    mspringi_put(&to, &value, 1, sizeof value);
}

uint8_t *snapshots_section_of(const saved *of, const char *tag, uint64_t *size) {
    uint8_t *at = of->bytes + MSPRINGI_SNAPSHOT_HEADER_BYTES;
    for (;;) {
        mspringi_get(at + 8, size, 1, sizeof *size);
        at += MSPRINGI_SECTION_HEADER_BYTES;
        if (memcmp(at - MSPRINGI_SECTION_HEADER_BYTES, tag, 4) == 0) {
            return at;
        }
        at += mspringi_round_up((size_t)*size, 8);
    }
}

mspring_network *snapshots_small_guarded(const recipe *made, mspring_guard guard) {
    mspring_network_def def = support_def(-9.8f, 4);
    def.settings.guard = guard;
    mspring_network *network = recipe_network(made, &def);
    snapshots_set_up(network);
    for (uint32_t frame = 0; frame < 6; frame++) {
        snapshots_run_frame(network, frame);
    }
    return network;
}

saved snapshots_copy(const saved *from) {
    saved out = {malloc(from->size), from->size};
    assert_non_null(out.bytes);
    memcpy(out.bytes, from->bytes, from->size);
    return out;
}

void snapshots_put_word(uint8_t *at, uint32_t word) {
    mspringi_writer to = mspringi_writer_begin(at, &mspringi_kernels_scalar);
    mspringi_put(&to, &word, 1, sizeof word);
}

void snapshots_put_float(uint8_t *at, float value) {
    mspringi_writer to = mspringi_writer_begin(at, &mspringi_kernels_scalar);
    mspringi_put(&to, &value, 1, sizeof value);
}

void snapshots_put_double(uint8_t *at, double value) {
    mspringi_writer to = mspringi_writer_begin(at, &mspringi_kernels_scalar);
    mspringi_put(&to, &value, 1, sizeof value);
}

void snapshots_check_refused(mspring_network *network, saved *forged, const char *part) {
    const uint64_t before = snapshots_look_at(network);
    snapshots_renew_checksum(forged);
    check_error(mspring_network_load(network, forged->bytes, forged->size), MSPRING_ERROR_SNAPSHOT);
    check_contains(mspring_network_error(network), part);
    assert_int_equal(snapshots_look_at(network), before);
}

mspring_network *snapshots_small_network(const recipe *made) {
    return snapshots_small_guarded(made, MSPRING_GUARD_GROWTH);
}

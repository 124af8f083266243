/// What the host holds, in a snapshot.
#include "contact/grips.h"

#include <math.h>

#include "store/sections.h"

// Number, particle, 3 floats, a reserved word, 6 doubles.
#define GRIP_BYTES ((size_t)72)

#define STRONGEST 1e30f

/// One of them, as it is read.
typedef struct grip_record {
    uint32_t number, reserved;
    mspringi_grip grip;
} grip_record;

static size_t grips_size(const mspring_network *network) {
    return network->grips.count * GRIP_BYTES;
}

static void grips_save(const mspring_network *network, mspringi_writer *to) {
    for (uint32_t i = 0; i < MSPRING_MAX_GRIPS; ++i) {
        const mspringi_grip *grip = &network->grips.list[i];
        if (grip->particle == MSPRING_NONE)
            continue;
        const uint32_t ids[] = {i, grip->particle}, reserved = 0;
        const float floats[] = {grip->stiffness, grip->damping, grip->max_force};
        const double doubles[] = {grip->x, grip->y, grip->from_x, grip->from_y, grip->impulse_x, grip->impulse_y};
        mspringi_put(to, ids, 2, sizeof ids[0]);
        mspringi_put(to, floats, 3, sizeof floats[0]);
        mspringi_put(to, &reserved, 1, sizeof reserved);
        mspringi_put(to, doubles, 6, sizeof doubles[0]);
    }
}

static const uint8_t *read_grip(const uint8_t *from, grip_record *record) {
    mspringi_grip *grip = &record->grip;
    double *const doubles[] = {&grip->x,      &grip->y,         &grip->from_x,
                               &grip->from_y, &grip->impulse_x, &grip->impulse_y};
    float *const floats[] = {&grip->stiffness, &grip->damping, &grip->max_force};
    from = mspringi_get(from, &record->number, 1, sizeof record->number);
    from = mspringi_get(from, &grip->particle, 1, sizeof grip->particle);
    for (size_t i = 0; i < 3; ++i)
        from = mspringi_get(from, floats[i], 1, sizeof *floats[i]);
    from = mspringi_get(from, &record->reserved, 1, sizeof record->reserved);
    for (size_t i = 0; i < 6; ++i)
        from = mspringi_get(from, doubles[i], 1, sizeof *doubles[i]);
    return from;
}

static bool is_strength(float value, float most) {
    return value >= 0.0f && value <= most;
}

static bool is_target(double value) {
    return fabs(value) <= MSPRING_MAX_COORDINATE;
}

static mspring_result grips_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_grips;
    const size_t count = size / GRIP_BYTES;
    mspring_result result = mspringi_section_check_size(network, section, size, count * GRIP_BYTES);
    for (size_t i = 0, least = 0; result == MSPRING_OK && i < count; ++i) {
        grip_record record = {0};
        const mspringi_grip *grip = &record.grip;
        from = read_grip(from, &record);
        if (record.number < least || record.number >= MSPRING_MAX_GRIPS || record.reserved != 0 ||
            grip->particle >= network->topology.reserve.particle_end)
            result = mspringi_section_fail(network, section, "grip %u holds particle %u", (unsigned)record.number,
                                           (unsigned)grip->particle);
        else if (!is_strength(grip->stiffness, STRONGEST) || !is_strength(grip->damping, STRONGEST) ||
                 !is_strength(grip->max_force, MSPRING_NEVER))
            result = mspringi_section_fail(network, section, "grip %u has stiffness %g, damping %g, max_force %g",
                                           (unsigned)record.number, (double)grip->stiffness, (double)grip->damping,
                                           (double)grip->max_force);
        else if (!is_target(grip->x) || !is_target(grip->y) || !is_target(grip->from_x) ||
                 !is_target(grip->from_y) || !isfinite(grip->impulse_x) || !isfinite(grip->impulse_y))
            result = mspringi_section_fail(network, section, "grip %u pulls to (%g, %g) m", (unsigned)record.number,
                                           grip->x, grip->y);
        least = (size_t)record.number + 1;
    }
    return result;
}

// After the section of growth: a grip on what is not there lets go.
static void grips_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_grips *grips = &network->grips;
    mspringi_grips_clear(grips);
    for (size_t i = 0; i < size / GRIP_BYTES; ++i) {
        grip_record record = {0};
        from = read_grip(from, &record);
        if (record.grip.particle >= network->topology.particle_count ||
            !mspringi_particle_exists(network, record.grip.particle))
            continue;
        grips->list[record.number] = record.grip;
        grips->count++;
    }
}

const mspringi_section mspringi_section_grips = {"grip",     "grips",     false,     grips_size,
                                                 grips_save, grips_check, grips_load};

/// What the host holds, in a snapshot.
#include "contact/grips.h"

#include <math.h>

#include "store/sections.h"

// The next id and a reserved word.
#define HEAD_BYTES ((size_t)8)
// Id, particle, 3 floats, a reserved word, 6 doubles.
#define GRIP_BYTES ((size_t)72)

#define STRONGEST 1e30f

/// What a section begins with.
typedef struct grips_head {
    mspring_id next_id;
    uint32_t reserved;
} grips_head;

/// One of them, as it is read.
typedef struct grip_record {
    uint32_t reserved;
    mspringi_grip grip;
} grip_record;

// Without it there has never been a grip.
static size_t grips_size(const mspring_network *network) {
    return network->grips.next_id > 0 ? HEAD_BYTES + network->grips.count * GRIP_BYTES : 0;
}

static void grips_save(const mspring_network *network, mspringi_writer *to) {
    const uint32_t head[] = {network->grips.next_id, 0};
    mspringi_put(to, head, 2, sizeof head[0]);
    for (uint32_t i = 0; i < network->grips.count; ++i) {
        const mspringi_grip *grip = &network->grips.list[i];
        const uint32_t ids[] = {grip->id, grip->particle}, reserved = 0;
        const float floats[] = {grip->stiffness, grip->damping, grip->max_force};
        const double doubles[] = {grip->x, grip->y, grip->from_x, grip->from_y, grip->impulse_x, grip->impulse_y};
        mspringi_put(to, ids, 2, sizeof ids[0]);
        mspringi_put(to, floats, 3, sizeof floats[0]);
        mspringi_put(to, &reserved, 1, sizeof reserved);
        mspringi_put(to, doubles, 6, sizeof doubles[0]);
    }
}

static const uint8_t *read_head(const uint8_t *from, grips_head *head) {
    from = mspringi_get(from, &head->next_id, 1, sizeof head->next_id);
    return mspringi_get(from, &head->reserved, 1, sizeof head->reserved);
}

static const uint8_t *read_grip(const uint8_t *from, grip_record *record) {
    mspringi_grip *grip = &record->grip;
    double *const doubles[] = {&grip->x,      &grip->y,         &grip->from_x,
                               &grip->from_y, &grip->impulse_x, &grip->impulse_y};
    float *const floats[] = {&grip->stiffness, &grip->damping, &grip->max_force};
    from = mspringi_get(from, &grip->id, 1, sizeof grip->id);
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

static mspring_result check_grip(mspring_network *network, const grip_record *record) {
    const mspringi_section *section = &mspringi_section_grips;
    const mspringi_grip *grip = &record->grip;
    if (record->reserved != 0 || grip->particle >= network->topology.reserve.particle_end)
        return mspringi_section_fail(network, section, "grip %s holds particle %s", MSPRINGI_ID(grip->id),
                                     MSPRINGI_ID(grip->particle));
    if (!is_strength(grip->stiffness, STRONGEST) || !is_strength(grip->damping, STRONGEST) ||
        !is_strength(grip->max_force, MSPRING_NEVER))
        return mspringi_section_fail(network, section, "grip %u has stiffness %g, damping %g, max_force %g",
                                     (unsigned)grip->id, (double)grip->stiffness, (double)grip->damping,
                                     (double)grip->max_force);
    if (!is_target(grip->x) || !is_target(grip->y) || !is_target(grip->from_x) || !is_target(grip->from_y) ||
        !isfinite(grip->impulse_x) || !isfinite(grip->impulse_y))
        return mspringi_section_fail(network, section, "grip %u pulls to (%g, %g) m", (unsigned)grip->id, grip->x,
                                     grip->y);
    return MSPRING_OK;
}

static mspring_result grips_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_grips;
    const size_t count = size > HEAD_BYTES ? (size - HEAD_BYTES) / GRIP_BYTES : 0;
    grips_head head;
    if (size == 0)
        return MSPRING_OK;
    mspring_result result = mspringi_section_check_size(network, section, size, HEAD_BYTES + count * GRIP_BYTES);
    if (result != MSPRING_OK)
        return result;
    from = read_head(from, &head);
    if (head.reserved != 0 || count > MSPRING_MAX_GRIPS)
        return mspringi_section_fail(network, section, "it has %zu grips", count);
    for (size_t i = 0, least = 0; result == MSPRING_OK && i < count; ++i) {
        grip_record record = {0};
        from = read_grip(from, &record);
        if (record.grip.id < least || record.grip.id >= head.next_id)
            return mspringi_section_fail(network, section, "grip %u comes in the wrong order",
                                         (unsigned)record.grip.id);
        result = check_grip(network, &record);
        least = (size_t)record.grip.id + 1;
    }
    return result == MSPRING_OK && count > 0 ? mspringi_grips_reserve(network) : result;
}

// After the section of growth: a grip on what is not there is left out.
static void grips_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_grips *grips = &network->grips;
    grips_head head;
    mspringi_grips_clear(grips);
    if (size == 0)
        return;
    from = read_head(from, &head);
    grips->next_id = head.next_id;
    for (size_t i = 0; i < (size - HEAD_BYTES) / GRIP_BYTES; ++i) {
        grip_record record = {0};
        from = read_grip(from, &record);
        if (record.grip.particle < network->topology.particle_count &&
            mspringi_particle_exists(network, record.grip.particle))
            grips->list[grips->count++] = record.grip;
    }
}

const mspringi_section mspringi_section_grips = {"grip",     "grips",     false,     grips_size,
                                                 grips_save, grips_check, grips_load};

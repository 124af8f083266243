/// Snapshot of the host's grips.
#include "features/grips/grips.h"

#include <math.h>

#include "store/sections.h"

#define STRONGEST 1e30f

/// Saved form of a grip.
typedef struct record {
    uint32_t reserved;
    mspringi_grip grip;
} record;

static void hand_head(mspringi_io *io, mspring_id *next_id, uint32_t *reserved) {
    MSPRINGI_HAND(io, *next_id);
    MSPRINGI_HAND(io, *reserved);
}

static void hand_grip(mspringi_io *io, record *r) {
    MSPRINGI_HAND(io, r->grip.id);
    MSPRINGI_HAND(io, r->grip.particle);
    MSPRINGI_HAND(io, r->grip.stiffness);
    MSPRINGI_HAND(io, r->grip.damping);
    MSPRINGI_HAND(io, r->grip.max_force);
    MSPRINGI_HAND(io, r->reserved);
    MSPRINGI_HAND(io, r->grip.x);
    MSPRINGI_HAND(io, r->grip.y);
    MSPRINGI_HAND(io, r->grip.from_x);
    MSPRINGI_HAND(io, r->grip.from_y);
    MSPRINGI_HAND(io, r->grip.impulse_x);
    MSPRINGI_HAND(io, r->grip.impulse_y);
}

// No section means that there never was a grip.
static void grips_save(const mspring_network *network, mspringi_writer *to) {
    mspringi_io io = mspringi_io_to(to);
    mspring_id next_id = network->grips ? network->grips->next_id : 0;
    if (next_id == 0)
        return;
    hand_head(&io, &next_id, &(uint32_t){0});
    for (uint32_t i = 0; i < mspringi_grip_count(network); ++i)
        hand_grip(&io, &(record){.grip = network->grips->list[i]});
}

static bool is_strength(float value, float most) {
    return value >= 0.0f && value <= most;
}

static bool is_target(double value) {
    return fabs(value) <= MSPRING_MAX_COORDINATE;
}

static mspring_result check_grip(mspring_network *network, const record *r) {
    const mspringi_section *section = &mspringi_section_grips;
    const mspringi_grip *grip = &r->grip;
    if (r->reserved != 0 || grip->particle >= network->topology.reserve.particle_end)
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
    mspringi_io io = mspringi_io_from(from, size);
    mspring_id next_id, least = 0;
    uint32_t reserved, count = 0;
    if (size == 0)
        return MSPRING_OK;
    hand_head(&io, &next_id, &reserved);
    mspring_result result = MSPRING_OK;
    for (; result == MSPRING_OK && io.left > 0 && !io.is_short; ++count) {
        record r;
        hand_grip(&io, &r);
        if (r.grip.id < least || r.grip.id >= next_id || count == MSPRING_MAX_GRIPS)
            return mspringi_section_fail(network, section, "grip %u comes in the wrong order", (unsigned)r.grip.id);
        result = check_grip(network, &r);
        least = r.grip.id + 1;
    }
    if (result == MSPRING_OK && reserved != 0)
        result = mspringi_section_fail(network, section, "it has %u grips", (unsigned)count);
    if (result == MSPRING_OK)
        result = mspringi_section_end(network, section, &io);
    return result == MSPRING_OK ? mspringi_grips_reserve(network) : result;
}

static mspring_result grips_check_against(mspring_network *network, const mspringi_saved *saved,
                                          const uint8_t *from, size_t size) {
    mspringi_io io = mspringi_io_from(from, size);
    mspring_id next_id;
    uint32_t reserved;
    if (size > 0)
        hand_head(&io, &next_id, &reserved);
    while (io.left > 0) {
        record r;
        hand_grip(&io, &r);
        if (!mspringi_saved_has_particle(saved, r.grip.particle))
            return mspringi_section_fail(network, &mspringi_section_grips,
                                         "grip %u holds particle %u, which is not there", (unsigned)r.grip.id,
                                         (unsigned)r.grip.particle);
    }
    return MSPRING_OK;
}

static void grips_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_io io = mspringi_io_from(from, size);
    mspringi_grips *grips = network->grips;
    uint32_t reserved;
    mspringi_grips_clear(network);
    if (size > 0)
        hand_head(&io, &grips->next_id, &reserved);
    while (io.left > 0) {
        record r = {0};
        hand_grip(&io, &r);
        grips->list[grips->count++] = r.grip;
    }
}

const mspringi_section mspringi_section_grips = {"grip",     "grips",     false,      NULL,
                                                 grips_save, grips_check, grips_load, grips_check_against};

/// Particles without springs: all substeps at once, or one by one.
#include "solvers/explicit/loose.h"

#include <string.h>

#include "base/assert.h"
#include "features/contact/floor.h"
#include "features/hooks/hooks.h"
#include "solvers/explicit/strip.h"

// Motion of particles without springs in substeps first to end - 1 of those that are taken now. (Substep by substep
// they took a quarter of the step of a wreck that has nine particles of ten loose.)
static mspringi_free_motion plan_free_motion(const mspring_network *network, const mspringi_sweep *sweep,
                                             uint32_t first, uint32_t end) {
    mspringi_sweep s = *sweep;
    const double h = (double)s.h, ax = (double)network->settings.gravity_x,
                 ay = (double)network->settings.gravity_y;
    double keep = 1.0, reach = 0.0, gain = 0.0, fall = 0.0; // of a velocity, and of an acceleration
    double gravity_gain = 0.0, gravity_fall = 0.0;
    for (uint32_t i = first; i < end; ++i) {
        mspringi_sweep_set_substep(network, &s, i);
        keep -= (double)s.damping_loss * keep;
        gain += (double)s.kick - (double)s.damping_loss * gain;
        reach += keep * h;
        fall += gain * h;
        gravity_gain += (double)s.gravity_kick - (double)s.damping_loss * gravity_gain;
        gravity_fall += gravity_gain * h;
    }
    return (mspringi_free_motion){.keep = (float)keep,
                                  .loss = (float)(1.0 - keep),
                                  .gain = (float)gain,
                                  .reach = (float)reach,
                                  .fall = (float)fall,
                                  .drift = (float)(h * (double)(end - first)),
                                  .gravity_x = (float)(gravity_gain * ax),
                                  .gravity_y = (float)(gravity_gain * ay),
                                  .gravity_way_x = (float)(gravity_fall * ax),
                                  .gravity_way_y = (float)(gravity_fall * ay)};
}

// True if a hook within reach would act in substeps. Always with added springs, which act on some of a block, and
// with groups, as contact that only others are near cuts a step. All substeps at once round differently, so bits
// would depend on the others.
static bool may_be_cut(const mspring_network *network) {
    if (network->groups.count > 0 || network->added_springs.count > 0)
        return true;
    for (size_t i = 0; i < mspringi_hook_count(network); ++i)
        if (network->hooks->list[i].def.phase != MSPRING_PHASE_BEFORE_STEP)
            return true;
    return false;
}

/// Blocks of loose particles that go through all substeps before the next ones do: they take 10 kB.
#define LOOSE_CHUNK (16 * MSPRINGI_WIDTH)

static void sweep_chunk_one_by_one(const mspringi_loose *l, const mspringi_span *span, bool is_floor_near) {
    const mspring_network *network = l->network;
    const mspringi_loose_fn loose = network->kernels->loose[l->sweep->force_x != NULL];
    mspringi_sweep substep = *l->sweep;
    for (uint32_t i = 0; i < l->count; ++i) {
        const mspringi_free_motion one = plan_free_motion(network, l->sweep, i, i + 1);
        mspringi_sweep_set_substep(network, &substep, i);
        if (is_floor_near)
            mspringi_floor_save_velocities(network, l->strip, span, 1);
        loose(&substep, span, &one);
        if (is_floor_near)
            mspringi_floor_apply_loose(network, l->strip, span, &substep);
    }
}

static void sweep_one_by_one(const mspringi_loose *l, const mspringi_span *span, bool is_floor_near) {
    mspringi_span chunk = *span;
    for (; chunk.first_slot < span->end_slot; chunk.first_slot = chunk.end_slot) {
        const uint32_t left = span->end_slot - chunk.first_slot;
        chunk.end_slot = chunk.first_slot + (left < LOOSE_CHUNK ? left : LOOSE_CHUNK);
        sweep_chunk_one_by_one(l, &chunk, is_floor_near);
    }
}

/// State of a block, array by array.
typedef struct loose_block {
    float values[8][MSPRINGI_WIDTH];
} loose_block;

static void copy_block(const mspring_network *network, uint32_t block, loose_block *to) {
    const mspringi_state *s = &network->state;
    const size_t slots = mspringi_slot_count(network), arrays = mspringi_state_arrays(network);
    for (size_t i = 0; i < arrays; ++i)
        memcpy(to->values[i], s->x + i * slots + (size_t)block * MSPRINGI_WIDTH, sizeof to->values[i]);
}

// Put back the lanes of a block that are set.
static void put_lanes(const mspring_network *network, uint32_t block, const loose_block *from, uint32_t lanes) {
    const mspringi_state *s = &network->state;
    const size_t slots = mspringi_slot_count(network), arrays = mspringi_state_arrays(network);
    for (size_t i = 0; i < arrays; ++i)
        for (uint32_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
            if (lanes >> lane & 1)
                s->x[i * slots + (size_t)block * MSPRINGI_WIDTH + lane] = from->values[i][lane];
}

// Take the substeps with a block of which some lanes are near a floor: these one by one, the others all at once.
static void sweep_mixed(const mspringi_loose *l, const mspringi_span *span, uint32_t lanes) {
    const mspring_network *network = l->network;
    const mspringi_loose_fn loose = network->kernels->loose[l->sweep->force_x != NULL];
    const uint32_t block = span->first_slot / MSPRINGI_WIDTH, all = (1u << MSPRINGI_WIDTH) - 1;
    loose_block before, after;
    if (lanes != all) {
        copy_block(network, block, &before);
        loose(l->sweep, span, &l->all);
        copy_block(network, block, &after);
        put_lanes(network, block, &before, all);
    }
    sweep_one_by_one(l, span, true);
    if (lanes != all)
        put_lanes(network, block, &after, ~lanes & all);
}

void mspringi_loose_sweep(const mspringi_loose *l, const mspringi_span *span) {
    const mspring_network *network = l->network;
    const mspringi_loose_fn loose = network->kernels->loose[l->sweep->force_x != NULL];
    const bool is_floor_near = mspringi_floor_is_near(network, l->strip);
    if (may_be_cut(network) || (is_floor_near && l->count == 1)) {
        sweep_one_by_one(l, span, is_floor_near);
        return;
    }
    MSPRINGI_ASSERT(span->first_slot % MSPRINGI_WIDTH == 0 && span->end_slot % MSPRINGI_WIDTH == 0);
    const uint32_t end = span->end_slot / MSPRINGI_WIDTH;
    uint32_t next = span->first_slot / MSPRINGI_WIDTH; // the first block that is not taken
    for (uint32_t block = next; block < end && is_floor_near; ++block) {
        const uint32_t lanes = mspringi_floor_near_lanes(network, l->strip, block, l->sweep);
        if (lanes == 0)
            continue;
        mspringi_span part = *span;
        part.first_slot = next * MSPRINGI_WIDTH;
        part.end_slot = block * MSPRINGI_WIDTH;
        if (next < block)
            loose(l->sweep, &part, &l->all);
        part.first_slot = block * MSPRINGI_WIDTH;
        part.end_slot = (block + 1) * MSPRINGI_WIDTH;
        sweep_mixed(l, &part, lanes);
        next = block + 1;
    }
    mspringi_span rest = *span;
    rest.first_slot = next * MSPRINGI_WIDTH;
    if (rest.first_slot < rest.end_slot)
        loose(l->sweep, &rest, &l->all);
}

mspringi_loose mspringi_loose_prepare(const mspring_network *network, const mspringi_sweep *sweep,
                                      const mspringi_strip *strip, uint32_t count) {
    return (mspringi_loose){.network = network,
                            .sweep = sweep,
                            .strip = strip,
                            .all = plan_free_motion(network, sweep, 0, count),
                            .count = count};
}

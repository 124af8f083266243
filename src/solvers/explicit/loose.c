/// Particles without springs: all substeps at once, or one by one.
#include "solvers/explicit/loose.h"

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

/// Blocks of loose particles that go through all substeps before the next ones do: they take 10 kB.
#define LOOSE_CHUNK 16

// The end of the blocks from that one on that are all near the floor, or all far. strip: NULL if no floor is near.
static uint32_t end_of_chunk(const mspring_network *network, const mspringi_strip *strip, uint32_t block,
                             uint32_t end, bool *is_near) {
    *is_near = strip && mspringi_floor_is_near_block(network, strip, block);
    const uint32_t most = end - block < LOOSE_CHUNK ? end : block + LOOSE_CHUNK;
    uint32_t next = block + 1;
    while (next < most && (strip && mspringi_floor_is_near_block(network, strip, next)) == *is_near)
        ++next;
    return next;
}

// True if a hook within reach would act in substeps; with groups always, as a floor that only others are near cuts
// a step. All substeps at once round differently, so the bits of a group would depend on the others.
static bool may_be_cut(const mspring_network *network) {
    if (network->groups.count > 0)
        return true;
    for (size_t i = 0; i < mspringi_hook_count(network); ++i)
        if (network->hooks->list[i].def.phase != MSPRING_PHASE_BEFORE_STEP)
            return true;
    return false;
}

static void sweep_one_by_one(const mspringi_loose *l, const mspringi_span *span, bool is_floor_near) {
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

void mspringi_loose_sweep(const mspringi_loose *l, const mspringi_span *span) {
    const mspring_network *network = l->network;
    const mspringi_loose_fn loose = network->kernels->loose[l->sweep->force_x != NULL];
    const bool is_floor_near = mspringi_floor_is_near(network, l->strip), glides = !may_be_cut(network);
    if (!is_floor_near && glides) {
        loose(l->sweep, span, &l->all);
        return;
    }
    const uint32_t end = span->end_slot / MSPRINGI_WIDTH;
    for (uint32_t block = span->first_slot / MSPRINGI_WIDTH, next; block < end; block = next) {
        bool is_near;
        next = end_of_chunk(network, is_floor_near ? l->strip : NULL, block, end, &is_near);
        mspringi_span chunk = *span;
        chunk.first_slot = block * MSPRINGI_WIDTH;
        chunk.end_slot = next * MSPRINGI_WIDTH;
        if (is_near || !glides)
            sweep_one_by_one(l, &chunk, is_near);
        else
            loose(l->sweep, &chunk, &l->all);
    }
}

mspringi_loose mspringi_loose_prepare(const mspring_network *network, const mspringi_sweep *sweep,
                                      const mspringi_strip *strip, uint32_t count) {
    return (mspringi_loose){.network = network,
                            .sweep = sweep,
                            .strip = strip,
                            .all = plan_free_motion(network, sweep, 0, count),
                            .count = count};
}

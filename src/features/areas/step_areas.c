/// The stage in which areas push: those that no sweep has in it, as forces from outside.
#include "features/areas/areas.h"
#include "store/sleepers.h"
#include "store/stages.h"

static bool is_used(const mspring_network *network) {
    return mspringi_area_count(network) > 0;
}

// Wake the corners of an area of which others are awake: its pressure changes. True if any slept.
static bool wake_corners(mspring_network *network, const mspringi_area *area) {
    uint32_t asleep = 0;
    for (uint32_t i = 0; i < area->count; ++i)
        asleep += mspringi_slot_is_asleep(network, mspringi_area_slot(network, area, i));
    if (asleep == 0 || asleep == area->count)
        return false;
    for (uint32_t i = 0; i < area->count; ++i)
        mspringi_sleepers->wake(network, network->sleep.island[mspringi_area_slot(network, area, i)]);
    mspringi_sleepers->finish_waking(network);
    return true;
}

// Corners of cells are always of one island.
static void before_step(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_areas *a = network->areas;
    (void)attempt;
    mspringi_areas_refresh(network);
    for (bool again = network->sleep.sleeping > 0 && a->unswept > 0; again;) {
        again = false;
        for (size_t i = 0; i < a->count; ++i)
            again |=
                a->list[i].cell == MSPRINGI_NO_CELL && !a->list[i].is_open && wake_corners(network, &a->list[i]);
    }
}

// Whether the solver's substeps have an area in them: the sweeps that of a cell, a linear system any with springs
// all around.
static bool is_held(const mspringi_attempt *attempt, const mspringi_area *area) {
    return (attempt->solver->ops->has_stability_limit && area->cell != MSPRINGI_NO_CELL) ||
           (attempt->solver->ops->has_implicit_areas && area->is_ringed);
}

static bool is_quiet(const mspring_network *network, const mspringi_attempt *attempt) {
    const mspringi_areas *a = network->areas;
    const mspringi_solver_ops *ops = attempt->solver->ops;
    const uint32_t forces = ops->has_stability_limit  ? a->unswept
                            : ops->has_implicit_areas ? a->unringed
                                                      : network->cells.swept + a->unswept;
    return forces == 0 || mspringi_sleep_is_whole(network);
}

/// Part of the square of the longest substep that softened areas leave room to.
#define CALM 0.25

// How much of their forces areas exert. Strain rates are clamped where a substep is too long for springs: then
// areas are softened until it is not too long for them, either.
static double share_of(const mspring_network *network, const mspringi_attempt *attempt) {
    const double longest = network->areas->longest_of_all, h = (double)attempt->h;
    const double share = CALM * (longest / h) * (longest / h);
    return attempt->solver == &mspringi_clamped && share < 1.0 ? share : 1.0;
}

static mspringi_field before_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                                     mspringi_field base) {
    const mspringi_areas *a = network->areas;
    const double share = share_of(network, attempt);
    (void)substep;
    if (is_quiet(network, attempt))
        return base;
    if (base.x)
        mspringi_field_copy(network, base, network->forces.inner);
    else
        mspringi_field_clear(network, network->forces.inner);
    for (size_t i = 0; i < a->count; ++i)
        if (!a->list[i].is_open && !is_held(attempt, &a->list[i]))
            mspringi_area_push(network, &a->list[i], share, network->forces.inner);
    return network->forces.inner;
}

// As long as no area pushes by force, substeps may be taken together.
static uint32_t free_substeps(const mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    return is_quiet(network, attempt) ? attempt->substeps - substep : 1;
}

const mspringi_stage mspringi_stage_areas = {.is_used = is_used,
                                             .is_inner = true,
                                             .before_step = before_step,
                                             .is_quiet = is_quiet,
                                             .free_substeps = free_substeps,
                                             .before_substep = before_substep};

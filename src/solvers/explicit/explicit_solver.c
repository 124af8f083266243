/// The explicit solver's table. It keeps nothing from step to step.
#include "solvers/explicit/explicit.h"

#include <string.h>

#include "features/contact/floor.h"
#include "solvers/explicit/flush.h"
#include "stability/guard.h"
#include "store/added_springs.h"

static void restore(mspring_network *network, void *object) {
    (void)object;
    mspringi_explicit_reset(network);
}

// A floor out of reach costs a look before the step and one after it. If the second finds that it was none, the
// step is taken again.
static bool whole(mspring_network *network, const mspringi_attempt *attempt, mspringi_field base,
                  mspringi_extrema *extrema) {
    const float h = attempt->h;
    if (network->added_springs.count > 0 ||
        (network->floor && !mspringi_floor_is_out_of_reach(network, (double)h * (double)attempt->substeps)))
        return false;
    *extrema = mspringi_explicit_run_step(network, h, base, attempt->substeps);
    if (!network->floor || mspringi_floor_was_out_of_reach(network, h, mspringi_guard_bound(network, h, *extrema)))
        return true;
    memcpy(network->state.x, network->backup.x,
           mspringi_state_arrays(network) * mspringi_slot_count(network) * sizeof *network->state.x);
    mspringi_clear_unused_slots(network); // the backup has nothing of slots that were not swept
    mspringi_clear_empty_slots(network);
    mspringi_explicit_reset(network);
    return false;
}

static void substeps(mspring_network *network, void *object, float h, mspringi_field base, uint32_t count) {
    (void)object;
    mspringi_explicit_run_substeps(network, h, base, count);
}

void mspringi_explicit_end(mspring_network *network) {
    mspringi_flush_to_zero(network, 0, mspringi_used_slots(network));
}

bool mspringi_explicit_is_isolated(const mspring_network *network, const void *object, size_t slot) {
    const uint32_t block = (uint32_t)(slot / MSPRINGI_WIDTH);
    (void)object;
    return block >= network->topology.loose_first &&
           mspringi_added_springs_find_block(&network->added_springs, block, block + 1, true) != block;
}

const mspringi_solver_ops mspringi_explicit_ops = {
    .has_stability_limit = true,
    .can_choose_substeps = true,
    .skips_sleepers = true,
    .lags = true,
    .is_staggered = true,
    .has_bundles = true,
    .can_add = true,
    .begin = mspringi_added_springs_update,
    .run_step = whole,
    .substeps = substeps,
    .end = mspringi_explicit_end,
    .restore = restore,
    .is_isolated = mspringi_explicit_is_isolated,
};

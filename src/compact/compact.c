/// Leaving out of the plan what has broken, and taking it in again.
#include "compact.h"

#include "base/cpu.h"
#include "move.h"
#include "network/springs.h"
#include "replan.h"
#include "topology/spare.h"

// Exchange the layout, and keep or free the one before.
static mspring_result exchange(mspring_network *network, mspringi_topology *topology, uint64_t new_print) {
    const bool was_compact = network->is_compact;
    const uint64_t print = network->topology_print;
    const uint32_t tile_size = mspringi_solver_get_basis(&network->solver).tile_size;
    const uint32_t fallback_size = mspringi_solver_get_basis(&network->fallback).tile_size;
    mspringi_topology before = network->topology;
    mspring_result result = mspringi_move(network, topology, 0, 0);
    if (result != MSPRING_OK)
        return result;
    network->topology_print = new_print;
    if (was_compact) {
        mspringi_topology_destroy(&before, &network->memory);
    } else {
        network->whole = before;
        network->whole_print = print;
        network->whole_tile_size = tile_size;
        network->whole_fallback_size = fallback_size;
        network->is_compact = true;
    }
    return MSPRING_OK;
}

static MSPRINGI_NOINLINE mspring_result expand(mspring_network *network) {
    mspringi_topology compact = network->topology;
    mspring_result result =
        mspringi_move(network, &network->whole, network->whole_tile_size, network->whole_fallback_size);
    if (result != MSPRING_OK)
        return result;
    mspringi_topology_destroy(&compact, &network->memory);
    network->topology_print = network->whole_print;
    network->whole = (mspringi_topology){0};
    network->is_compact = network->is_seen_compact = false;
    return MSPRING_OK;
}

static void abandon(mspring_network *network) {
    mspringi_free_all(&network->plan_memory);
    network->replan = NULL;
    network->mover = NULL;
}

// A compaction that is under way goes by the layout that was: it begins anew.
mspring_result mspringi_expand(mspring_network *network) {
    abandon(network);
    if (!network->is_compact)
        return MSPRING_OK;
    const mspringi_fp_state before = mspringi_fp_enter();
    mspring_result result = expand(network);
    mspringi_fp_leave(before);
    return result;
}

mspring_result mspring_network_expand(mspring_network *network) {
    mspring_result result = mspringi_enter(network);
    return result == MSPRING_OK ? mspringi_expand(network) : result;
}

/* -------------------------------------------------------------------------------------------------- compaction */

// The last piece: the network moves. If a spring that is not in the new plan was restored, all begins anew.
static mspring_result take_plan(mspring_network *network) {
    mspringi_replan *replan = network->replan;
    mspringi_topology topology;
    uint64_t print;
    if (!mspringi_replan_is_valid(replan, network)) {
        abandon(network);
        return mspringi_replan_begin(network, &network->replan);
    }
    network->replan = NULL;
    mspringi_replan_take(replan, network, &topology, &print);
    mspring_result result = exchange(network, &topology, print);
    if (result != MSPRING_OK)
        mspringi_topology_destroy(&topology, &network->memory);
    return result;
}

static mspring_result go_on(mspring_network *network) {
    mspring_result result = MSPRING_OK;
    if (mspringi_replan_is_outdated(network->replan, network)) {
        abandon(network);
        result = mspringi_replan_begin(network, &network->replan);
    }
    if (result == MSPRING_OK && mspringi_replan_is_done(network->replan) && network->mover)
        return take_plan(network);
    if (result == MSPRING_OK)
        result = mspringi_replan_go_on(network->replan, network);
    if (result == MSPRING_OK && mspringi_replan_is_needless(network->replan)) {
        network->is_seen_compact = mspringi_replan_is_current(network->replan, network);
        network->seen_links = network->edits.links;
        network->seen_growth = network->edits.growth;
        abandon(network);
    } else if (result != MSPRING_OK) {
        abandon(network);
    }
    return result;
}

static MSPRINGI_NOINLINE mspring_result compact(mspring_network *network, uint32_t pieces) {
    mspring_result result = MSPRING_OK;
    if (!network->replan && network->is_seen_compact && network->seen_links == network->edits.links &&
        network->seen_growth == network->edits.growth)
        return MSPRING_OK;
    if (!network->replan)
        result = mspringi_replan_begin(network, &network->replan);
    for (uint32_t done = 0; result == MSPRING_OK && network->replan && (pieces == 0 || done < pieces); ++done)
        result = go_on(network);
    return result;
}

mspring_result mspring_network_compact(mspring_network *network, uint32_t pieces, uint32_t *left) {
    mspring_result result = mspringi_enter(network);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    result = compact(network, pieces);
    mspringi_fp_leave(before);
    if (result == MSPRING_OK && left)
        *left = network->replan ? mspringi_replan_left(network->replan) + 1 : 0;
    return result;
}

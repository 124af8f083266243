/// Leaving out of the plan what has broken, and taking it in again.
#include "compact.h"

#include "base/cpu.h"
#include "implicit/implicit.h"
#include "move.h"
#include "network/springs.h"
#include "replan.h"
#include "topology/spare.h"

// Exchange the layout, and keep or free the one before.
static mspring_result exchange(mspring_network *network, mspringi_topology *topology) {
    const bool was_compact = network->is_compact;
    const uint64_t print = network->topology_print;
    const uint32_t tile_size = network->implicit ? network->implicit->tiles.cells.size : 0;
    const uint32_t fallback_size = network->fallback ? network->fallback->tiles.cells.size : 0;
    mspringi_topology before = network->topology;
    mspring_result result = mspringi_move(network, topology, 0, 0);
    if (result != MSPRING_OK)
        return result;
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
    network->is_compact = false;
    return MSPRING_OK;
}

mspring_result mspringi_expand(mspring_network *network) {
    if (!network->is_compact)
        return MSPRING_OK;
    const mspringi_fp_state before = mspringi_fp_enter();
    mspring_result result = expand(network);
    mspringi_fp_leave(before);
    return result;
}

static void abandon(mspring_network *network) {
    mspringi_free_all(&network->plan_memory);
    network->replan = NULL;
}

mspring_result mspring_network_expand(mspring_network *network) {
    mspring_result result = mspringi_enter(network);
    if (result != MSPRING_OK)
        return result;
    abandon(network);
    return mspringi_expand(network);
}

/* -------------------------------------------------------------------------------------------------- compaction */

// Whether some spring that is swept is broken, or one was added that the plan does not know.
static bool has_something_to_do(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    mspringi_place_reader reader;
    mspringi_places_begin(&reader, &t->places, 0);
    for (mspring_id s = 0; s < t->spring_count; ++s) {
        const mspringi_place place = mspringi_places_next(&reader);
        if (mspringi_place_is_live(network, place) != mspringi_place_is_woven(t, place))
            return true;
    }
    return false;
}

// The last piece: the network moves. If a spring that is not in the new plan was restored, all begins anew.
static mspring_result take_plan(mspring_network *network) {
    mspringi_replan *replan = network->replan;
    mspringi_topology topology;
    if (!mspringi_replan_is_valid(replan, network)) {
        abandon(network);
        return mspringi_replan_begin(network, &network->replan);
    }
    network->replan = NULL;
    mspringi_replan_take(replan, network, &topology);
    mspring_result result = exchange(network, &topology);
    if (result != MSPRING_OK)
        mspringi_topology_destroy(&topology, &network->memory);
    return result;
}

static mspring_result go_on(mspring_network *network) {
    if (mspringi_replan_pieces_left(network->replan) == 0)
        return take_plan(network);
    mspring_result result = mspringi_replan_go_on(network->replan, network);
    if (result != MSPRING_OK)
        abandon(network);
    return result;
}

static MSPRINGI_NOINLINE mspring_result compact(mspring_network *network, uint32_t pieces) {
    mspring_result result = MSPRING_OK;
    if (!network->replan && has_something_to_do(network))
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
        *left = network->replan ? mspringi_replan_pieces_left(network->replan) + 1 : 0;
    return result;
}

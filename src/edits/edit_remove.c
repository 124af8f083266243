/// Removal of particles and springs, and recycling of their ids.
#include "features/breaking/breaking.h"
#include "layout/emit/spare.h"
#include "store/changed.h"
#include "store/events.h"
#include "store/feature.h"
#include "store/id_pool.h"
#include "store/selection.h"
#include "store/springs.h"

static void remove_spring(mspring_network *network, mspring_id spring, mspring_id with) {
    if (!mspringi_spring_exists(network, spring))
        return;
    if (mspringi_spring_break(network, spring))
        mspringi_events_push(network, (mspring_event){.kind = MSPRING_EVENT_BROKEN, .id = spring, .other = with});
    mspringi_id_pool_unlink(network, spring);
    network->growth.springs[spring] = MSPRINGI_GONE;
    mspringi_fingerprint(network, MSPRINGI_EDIT_REMOVED_SPRING, spring);
}

static void remove_particle(mspring_network *network, mspring_id particle) {
    if (!mspringi_particle_exists(network, particle))
        return;
    mspringi_incident_springs around = mspringi_incident_springs_begin(network, particle);
    for (mspring_id s; (s = mspringi_incident_springs_next(network, &around)) != MSPRING_NONE;)
        remove_spring(network, s, particle);
    mspringi_id_pool_take_particle(network, particle);
    network->growth.particles[particle] = MSPRINGI_GONE;
    mspringi_fingerprint(network, MSPRINGI_EDIT_REMOVED_PARTICLE, particle);
}

static mspring_result reserve(mspring_network *network) {
    mspring_result result = mspringi_id_pool_reserve(network);
    return result == MSPRING_OK ? mspringi_breaking_reserve(network) : result;
}

static void finish(mspring_network *network) {
    mspringi_id_pool_count(network, network->topology.particle_count, network->topology.spring_count);
    mspringi_notify_change(network, MSPRINGI_CHANGED_GRAFTS, 0);
}

mspring_result mspring_network_remove_particles(mspring_network *network, const mspring_id *ids, mspring_id first,
                                                uint32_t count) {
    mspringi_selection at;
    mspring_result result = mspringi_select(network, MSPRING_PARTICLES, ids, first, count, &at);
    if (result == MSPRING_OK && at.count > 0)
        result = reserve(network);
    if (result != MSPRING_OK || at.count == 0)
        return result;
    for (uint32_t i = 0; i < at.count; ++i)
        remove_particle(network, mspringi_selected(&at, i));
#define FORGETS(function) function(network);
#include "store/features.def"
    mspringi_notify_change(network, MSPRINGI_CHANGED_MASSES, 0); // as after pinning
    finish(network);
    return MSPRING_OK;
}

mspring_result mspring_network_remove_springs(mspring_network *network, const mspring_id *ids, mspring_id first,
                                              uint32_t count) {
    mspringi_selection at;
    mspring_result result = mspringi_select(network, MSPRING_SPRINGS, ids, first, count, &at);
    if (result == MSPRING_OK && at.count > 0)
        result = reserve(network);
    if (result != MSPRING_OK || at.count == 0)
        return result;
    for (uint32_t i = 0; i < at.count; ++i)
        remove_spring(network, mspringi_selected(&at, i), MSPRING_NONE);
    finish(network);
    return MSPRING_OK;
}

/* --------------------------------------------------------------------------------------------------- recycling */

// Mark removed ids as spare. Returns the lowest of them.
static mspring_id recycle_ids(uint8_t *marks, mspring_id first, mspring_id end, mspring_id lowest) {
    for (mspring_id id = end; id-- > first;) {
        if (marks[id] != MSPRINGI_GONE)
            continue;
        marks[id] = MSPRINGI_SPARE;
        lowest = id < lowest ? id : lowest;
    }
    return lowest;
}

mspring_result mspring_network_reuse_ids(mspring_network *network) {
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK || !network->growth.particles)
        return result;
    mspringi_id_pool *g = &network->growth;
    const mspringi_reserve *r = &network->topology.reserve;
    g->lowest_particle = recycle_ids(g->particles, r->first_particle, r->particle_end, g->lowest_particle);
    g->lowest_spring = recycle_ids(g->springs, r->first_spring, r->spring_end, g->lowest_spring);
    mspringi_components_forget_removed(network);
    mspringi_fingerprint(network, MSPRINGI_EDIT_RECYCLED, 0);
    mspringi_notify_change(network, MSPRINGI_CHANGED_IDS, 0);
    return MSPRING_OK;
}

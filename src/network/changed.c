/// Notification of edits.
#include "store/changed.h"

#include "base/hash.h"
#include "network/job.h"
#include "store/feature.h"
#include "store/springs.h"

/// Longest log of broken and restored springs: more than break in one frame.
#define MAX_LOG_SIZE 4096

mspring_result mspringi_changed_reserve_log(mspring_network *network) {
    const uint32_t springs = network->topology.reserve.spring_end;
    uint32_t log_size = 1;
    if (network->edits.link_log)
        return MSPRING_OK;
    while (log_size < springs && log_size < MAX_LOG_SIZE)
        log_size *= 2;
    network->edits.link_log = mspringi_alloc(&network->memory, log_size, sizeof *network->edits.link_log);
    if (!network->edits.link_log)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for breaking any of %u springs",
                             (unsigned)network->topology.spring_count);
    network->edits.link_mask = log_size - 1;
    return MSPRING_OK;
}

static void log_spring(mspring_network *network, mspring_id spring) {
    mspringi_edits *edits = &network->edits;
    MSPRINGI_ASSERT(edits->link_log); // mspringi_changed_reserve_log() has been called
    edits->broke = true;
    edits->link_log[edits->links++ & edits->link_mask] = spring;
}

static void free_ends(const mspring_network *network, mspring_id spring) {
    const mspringi_topology *t = &network->topology;
    uint32_t base, tip;
    mspringi_topology_ends(t, mspringi_slot_of_spring(t, spring), &base, &tip);
    mspringi_solvers_clear_slot(network, base);
    mspringi_solvers_clear_slot(network, tip);
}

static void notify_floor(const mspring_network *network) {
    if (network->solver.ops->new_floor)
        network->solver.ops->new_floor(network->solver.object);
}

#define COUNT(counter) network->edits.counter++;
#define LOG log_spring(network, index);
#define COPY mspringi_job_track(network, index);
#define COPY_ALL mspringi_job_track_all(network);
#define FREE_SLOT mspringi_solvers_clear_slot(network, index);
#define COPY_SPRING mspringi_job_track(network, mspringi_slot_of_spring(&network->topology, index));
#define FREE_ENDS free_ends(network, index);
#define FLOOR notify_floor(network);

void mspringi_dispatch_change(mspring_network *network, mspringi_change change, uint32_t index) {
    switch (change) {
#define CHANGE(name, listeners)                                                                                    \
    case MSPRINGI_CHANGED_##name:                                                                                  \
        listeners break;
#include "store/changes.def"
#undef CHANGE
    case MSPRINGI_CHANGES:
        break;
    }
#define REACTS(function) function(network, change, index);
#include "store/features.def"
}

#undef COUNT
#undef LOG
#undef COPY
#undef COPY_ALL
#undef FREE_SLOT
#undef COPY_SPRING
#undef FREE_ENDS
#undef FLOOR

void mspringi_fingerprint(mspring_network *network, uint32_t edit, mspring_id id) {
    network->parameter_fingerprint = mspringi_hash(network->parameter_fingerprint, (uint64_t)edit << 32 | id);
}

void mspringi_fingerprint_floats(mspring_network *network, float a, float b) {
    network->parameter_fingerprint = mspringi_hash_floats(network->parameter_fingerprint, a, b);
}

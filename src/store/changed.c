/// Who is told of a change.
#include "changed.h"

#include "base/mix.h"
#include "compact/job.h"
#include "network/springs.h"
#include "sleep/sleep.h"

static void log_spring(mspring_network *network, mspring_id spring) {
    mspringi_edits *edits = &network->edits;
    MSPRINGI_ASSERT(edits->link_log); // mspringi_breaking_reserve() has been called
    edits->broke = true;
    edits->link_log[edits->links++ & edits->link_mask] = spring;
}

static void free_ends(const mspring_network *network, mspring_id spring) {
    const mspringi_topology *t = &network->topology;
    uint32_t base, tip;
    mspringi_topology_ends(t, mspringi_place_of(t, spring), &base, &tip);
    mspringi_solvers_clear_slot(network, base);
    mspringi_solvers_clear_slot(network, tip);
}

static void tell_of_floor(const mspring_network *network) {
    if (network->solver.ops->new_floor)
        network->solver.ops->new_floor(network->solver.object);
}

#define COUNT(counter) network->edits.counter++;
#define LOG log_spring(network, index);
#define COPY mspringi_job_follow(network, index);
#define COPY_SPRING mspringi_job_follow(network, mspringi_place_of(&network->topology, index));
#define WAKE mspringi_wake(network);
#define WAKE_SPRING mspringi_wake_spring(network, index);
#define FREE_ENDS free_ends(network, index);
#define FLOOR tell_of_floor(network);

void mspringi_tell(mspring_network *network, mspringi_change what, uint32_t index) {
    switch (what) {
#define CHANGE(name, listeners)                                                                                    \
    case MSPRINGI_CHANGED_##name:                                                                                  \
        listeners break;
#include "store/changes.def"
#undef CHANGE
    case MSPRINGI_CHANGES:
        break;
    }
}

#undef COUNT
#undef LOG
#undef COPY
#undef COPY_SPRING
#undef WAKE
#undef WAKE_SPRING
#undef FREE_ENDS
#undef FLOOR

void mspringi_fingerprint(mspring_network *network, uint32_t edit, mspring_id id) {
    network->parameter_print = mspringi_mix(network->parameter_print, (uint64_t)edit << 32 | id);
}

void mspringi_fingerprint_floats(mspring_network *network, float a, float b) {
    network->parameter_print = mspringi_mix_floats(network->parameter_print, a, b);
}

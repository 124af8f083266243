/// Forces of the host in the first substep of a step, and in no other.
///
/// They cut the step after that substep. An impulse at the start would not, but integrators of higher order spread
/// a force over the next substeps.
#include "store/stages.h"

static bool is_used(const mspring_network *network) {
    return network->forces.first_any;
}

static uint32_t free_substeps(const mspring_network *network, const mspringi_attempt *attempt, uint32_t substep) {
    (void)network;
    return substep == 0 ? 1 : attempt->substeps - substep;
}

static mspringi_field before_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                                     mspringi_field base) {
    const mspringi_field first = network->forces.first, begun = network->forces.begun;
    const size_t slots = mspringi_used_slots(network);
    (void)attempt;
    if (substep > 0 || !base.x)
        return substep > 0 ? base : first;
    for (size_t i = 0; i < slots; ++i)
        begun.x[i] = base.x[i] + first.x[i];
    for (size_t i = 0; i < slots; ++i)
        begun.y[i] = base.y[i] + first.y[i];
    return begun;
}

// After hooks, which begin from the same forces in each substep.
const mspringi_stage mspringi_stage_first_forces = {
    .is_used = is_used, .free_substeps = free_substeps, .before_substep = before_substep};

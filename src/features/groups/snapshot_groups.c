/// Snapshot of held groups.
#include "store/sections.h"

static void held_save(const mspring_network *network, mspringi_writer *to) {
    const mspringi_groups *g = &network->groups;
    if (g->held > 0)
        mspringi_put(to, g->flags, g->count, 1);
}

static mspring_result held_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_held;
    if (size == 0)
        return MSPRING_OK;
    const mspring_result result = mspringi_section_check_size(network, section, size, network->groups.count);
    for (size_t i = 0; result == MSPRING_OK && i < size; ++i)
        if (from[i] & ~MSPRINGI_HELD)
            return mspringi_section_fail(network, section, "group %zu has flags %#x", i, (unsigned)from[i]);
    return result;
}

// The next step reads only the flags: see begin() in mspringi_ops_of_groups.
static void held_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_groups *g = &network->groups;
    g->held = 0;
    for (uint32_t group = 0; group < g->count; ++group) {
        g->flags[group] = size > 0 ? from[group] : 0;
        g->held += g->flags[group];
    }
}

const mspringi_section mspringi_section_held = {
    "held", "groups that are held", false, NULL, held_save, held_check, held_load, NULL};

/// Groups in archives, with the states that they may be reset to.
#include <math.h>

#include "features/groups/edit_groups.h"
#include "store/archive.h"
#include "store/springs.h"

// Springs that were removed are in no group of the network that is read.
static uint32_t count_springs(const mspring_network *network) {
    const mspringi_groups *g = &network->groups;
    uint32_t count = 0;
    for (uint32_t i = 0; i < g->first_spring[g->count]; ++i)
        count += mspringi_spring_exists(network, g->springs[i]);
    return count;
}

static void put_mark(const mspring_network *network, const mspringi_mark *mark, mspringi_io *io) {
    const mspringi_groups *g = &network->groups;
    const uint32_t particles = g->first[g->count] - g->first[0];
    const size_t values = mspringi_state_arrays(network);
    mspringi_put(io->to, mark->origin, 2 * (size_t)g->count, sizeof *mark->origin);
    mspringi_put(io->to, mark->motion + values * g->first[0], values * particles, sizeof *mark->motion);
    for (uint32_t i = 0; i < g->first_spring[g->count]; ++i)
        if (mspringi_spring_exists(network, g->springs[i]))
            mspringi_put(io->to, mark->lengths + 2 * (size_t)i, 2, sizeof *mark->lengths);
    for (uint32_t i = 0; i < g->first_spring[g->count]; ++i)
        if (mspringi_spring_exists(network, g->springs[i]))
            mspringi_put(io->to, mark->live + i, 1, 1);
}

static void groups_save(const mspring_network *network, mspringi_io *io) {
    const mspringi_groups *g = &network->groups;
    if (g->count == 0)
        return;
    const uint32_t head[] = {g->count, g->mark.motion != NULL, count_springs(network)};
    mspringi_put(io->to, head, 3, sizeof head[0]);
    mspringi_put(io->to, g->first, (size_t)g->count + 1, sizeof *g->first);
    put_mark(network, &g->start, io);
    if (g->mark.motion)
        put_mark(network, &g->mark, io);
}

// True if a mark has the properties that steps and resets rely on.
static bool is_good(const mspring_network *network, const mspringi_mark *mark) {
    const mspringi_groups *g = &network->groups;
    const size_t values = mspringi_state_arrays(network);
    bool good = true;
    for (size_t i = 0; i < 2 * (size_t)g->count; ++i)
        good = good && fabs(mark->origin[i]) <= 2.0 * MSPRING_MAX_COORDINATE;
    for (size_t i = values * g->first[0]; i < values * g->first[g->count]; ++i)
        good = good && fabsf(mark->motion[i]) <=
                           (i % values < 2 ? (float)MSPRING_MAX_COORDINATE : (float)MSPRING_MAX_SPEED);
    for (size_t i = 0; i < 2 * (size_t)g->first_spring[g->count]; ++i)
        good = good && mark->lengths[i] > 0.0f && mark->lengths[i] <= 1e14f;
    for (size_t i = 0; i < g->first_spring[g->count]; ++i)
        good = good && mark->live[i] <= 1;
    return good;
}

static mspring_result load_mark(mspring_network *network, mspringi_mark *mark, mspringi_io *io) {
    const mspringi_groups *g = &network->groups;
    const uint32_t particles = g->first[g->count] - g->first[0], springs = g->first_spring[g->count];
    const size_t values = mspringi_state_arrays(network);
    mspringi_hand(io, mark->origin, 2 * (size_t)g->count, sizeof *mark->origin);
    mspringi_hand(io, mark->motion + values * g->first[0], values * particles, sizeof *mark->motion);
    mspringi_hand(io, mark->lengths, 2 * (size_t)springs, sizeof *mark->lengths);
    mspringi_hand(io, mark->live, springs, 1);
    return io->is_short || is_good(network, mark)
               ? MSPRING_OK
               : mspringi_fail(&network->message, MSPRING_ERROR_SNAPSHOT,
                               "a state that they may be reset to is not finite, or too large");
}

static mspring_result groups_load(mspring_network *network, mspringi_io *io) {
    uint32_t head[3];
    mspring_result result = MSPRING_OK;
    mspringi_hand(io, head, 3, sizeof head[0]);
    mspring_id *firsts = mspringi_chunk_array(network, io, (size_t)head[0] + 1, sizeof *firsts, &result);
    if (result == MSPRING_OK)
        result = mspring_network_set_groups(network, firsts, head[0]);
    mspringi_free(&network->memory, firsts);
    if (result == MSPRING_OK && (head[0] == 0 || head[2] != network->groups.first_spring[head[0]]))
        result = mspringi_fail(&network->message, MSPRING_ERROR_SNAPSHOT, "%u groups of %u springs",
                               (unsigned)head[0], (unsigned)head[2]);
    if (result == MSPRING_OK)
        result = load_mark(network, &network->groups.start, io);
    if (result == MSPRING_OK && head[1])
        result = mspringi_mark_allocate(network, &network->groups.mark, network->groups.count);
    return result == MSPRING_OK && head[1] ? load_mark(network, &network->groups.mark, io) : result;
}

const mspringi_chunk mspringi_chunk_groups = {"grou", "groups", groups_save, groups_load, &mspringi_section_held};

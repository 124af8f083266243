/// Groups in archives, with the states that they may be reset to.
#include <math.h>

#include "features/groups/edit_groups.h"
#include "store/archive.h"
#include "store/springs.h"

enum { HAS_MARK = 1, HAS_REMOVED = 2 };

static bool has_removed(const mspring_network *network) {
    const mspringi_groups *g = &network->groups;
    bool any = false;
    for (uint32_t i = 0; !any && i < g->first_spring[g->count]; ++i)
        any = !mspringi_spring_exists(network, g->springs[i]);
    return any;
}

// A mark's values of a spring that was removed since count no more.
static void put_mark(const mspring_network *network, const mspringi_mark *mark, mspringi_io *io) {
    static const float no_lengths[2] = {1.0f, 1.0f};
    static const uint8_t no_life = 0;
    const mspringi_groups *g = &network->groups;
    const uint32_t particles = g->first[g->count] - g->first[0], springs = g->first_spring[g->count];
    const size_t values = mspringi_state_arrays(network);
    mspringi_put(io->to, mark->origin, 2 * (size_t)g->count, sizeof *mark->origin);
    mspringi_put(io->to, mark->motion + values * g->first[0], values * particles, sizeof *mark->motion);
    for (uint32_t i = 0; i < springs; ++i) {
        const bool exists = mspringi_spring_exists(network, g->springs[i]);
        mspringi_put(io->to, exists ? mark->lengths + 2 * (size_t)i : no_lengths, 2, sizeof *mark->lengths);
    }
    for (uint32_t i = 0; i < springs; ++i)
        mspringi_put(io->to, mspringi_spring_exists(network, g->springs[i]) ? mark->live + i : &no_life, 1, 1);
}

// The network that is read cannot tell of which group a removed spring was: then the lists of springs are there.
static void groups_save(const mspring_network *network, mspringi_io *io) {
    const mspringi_groups *g = &network->groups;
    if (g->count == 0)
        return;
    const bool lists = has_removed(network);
    const uint32_t head[] = {g->count, (g->mark.motion ? HAS_MARK : 0u) | (lists ? HAS_REMOVED : 0u),
                             g->first_spring[g->count]};
    mspringi_put(io->to, head, 3, sizeof head[0]);
    mspringi_put(io->to, g->first, (size_t)g->count + 1, sizeof *g->first);
    if (lists) {
        mspringi_put(io->to, g->first_spring, (size_t)g->count + 1, sizeof *g->first_spring);
        mspringi_put(io->to, g->springs, head[2], sizeof *g->springs);
    }
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

// Lists of springs by rising id that have all that exist, and removed ones.
static bool are_lists(const mspring_network *network, const uint32_t *begin, const mspring_id *springs,
                      uint32_t count) {
    const mspringi_groups *g = &network->groups;
    uint32_t existing = 0;
    bool good = count <= network->topology.spring_count && begin[0] == 0 && begin[g->count] == count;
    for (uint32_t group = 0; good && group < g->count; ++group) {
        good = begin[group] <= begin[group + 1] && begin[group + 1] <= count;
        for (uint32_t i = begin[group]; good && i < begin[group + 1]; ++i) {
            good =
                springs[i] < network->topology.spring_count && (i == begin[group] || springs[i - 1] < springs[i]);
            if (!good || !mspringi_spring_exists(network, springs[i]))
                continue;
            const uint32_t slot = mspringi_spring_ends(network, springs[i]).a;
            good = g->of_particle[network->topology.particle_of_slot[slot]] == group;
            ++existing;
        }
    }
    return good && existing == g->first_spring[g->count];
}

static mspring_result load_lists(mspring_network *network, uint32_t count, mspringi_io *io) {
    mspringi_groups *g = &network->groups;
    mspring_result result = MSPRING_OK;
    uint32_t *begin = mspringi_chunk_array(network, io, (size_t)g->count + 1, sizeof *begin, &result);
    mspring_id *springs = mspringi_chunk_array(network, io, count, sizeof *springs, &result);
    if (result == MSPRING_OK && !are_lists(network, begin, springs, count))
        result = mspringi_fail(&network->message, MSPRING_ERROR_SNAPSHOT, "the lists of their springs cannot be");
    for (uint32_t group = 0; result == MSPRING_OK && group <= g->count; ++group)
        g->first_spring[group] = begin[group];
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i)
        g->springs[i] = springs[i];
    mspringi_free(&network->memory, springs);
    mspringi_free(&network->memory, begin);
    return result;
}

static mspring_result groups_load(mspring_network *network, mspringi_io *io) {
    uint32_t head[3];
    mspring_result result = MSPRING_OK;
    mspringi_hand(io, head, 3, sizeof head[0]);
    mspring_id *firsts = mspringi_chunk_array(network, io, (size_t)head[0] + 1, sizeof *firsts, &result);
    if (result == MSPRING_OK)
        result = mspring_network_set_groups(network, firsts, head[0]);
    mspringi_free(&network->memory, firsts);
    if (result == MSPRING_OK && head[0] > 0 && head[1] & HAS_REMOVED)
        result = load_lists(network, head[2], io);
    if (result == MSPRING_OK && (head[0] == 0 || head[2] != network->groups.first_spring[head[0]]))
        result = mspringi_fail(&network->message, MSPRING_ERROR_SNAPSHOT, "%u groups of %u springs",
                               (unsigned)head[0], (unsigned)head[2]);
    if (result == MSPRING_OK)
        result = load_mark(network, &network->groups.start, io);
    if (result == MSPRING_OK && head[1] & HAS_MARK)
        result = mspringi_mark_allocate(network, &network->groups.mark, network->groups.count);
    return result == MSPRING_OK && head[1] & HAS_MARK ? load_mark(network, &network->groups.mark, io) : result;
}

const mspringi_chunk mspringi_chunk_groups = {"grou", "groups", groups_save, groups_load, &mspringi_section_held};

/// Division of particles into groups.
#include "features/groups/edit_groups.h"

#include "store/changed.h"
#include "store/feature.h"
#include "store/group_ops.h"
#include "store/id_pool.h"
#include "store/springs.h"
#include "store/store.h"

static mspring_result check_firsts(mspring_network *network, const mspring_id *firsts, uint32_t count) {
    const uint32_t all = network->topology.particle_count;
    if (count == 0)
        return MSPRING_OK;
    if (!firsts)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "the list of first particles is NULL");
    if (count > all)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "%u groups are more than %u particles",
                             (unsigned)count, (unsigned)all);
    for (uint32_t g = 0; g < count; ++g)
        if (firsts[g] >= firsts[g + 1])
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                 "group %u is empty: it begins at particle %s, the next one at %s", (unsigned)g,
                                 MSPRINGI_ID(firsts[g]), MSPRINGI_ID(firsts[g + 1]));
    if (firsts[count] > all)
        return mspringi_fail(&network->message, MSPRING_ERROR_ID,
                             "the last group ends before particle %s, but ids are below %u",
                             MSPRINGI_ID(firsts[count]), (unsigned)all);
    return MSPRING_OK;
}

static mspring_result check_network(mspring_network *network, uint32_t count) {
    if (count == 0)
        return MSPRING_OK;
    const uint32_t had = network->groups.count;
    mspring_settings settings = {.struct_size = sizeof settings};
    mspring_result result = mspring_network_get_settings(network, &settings);
    network->groups.count = count; // the checks need it
    if (result == MSPRING_OK)
        result = mspringi_ops_of_groups.check_settings(network, &settings);
    network->groups.count = had;
    return result;
}

/* ------------------------------------------------------------------------------------------------------- memory */

static void free_mark(mspringi_memory *memory, mspringi_mark *mark) {
    mspringi_free(memory, mark->motion);
    mspringi_free(memory, mark->lengths);
    mspringi_free(memory, mark->live);
    mspringi_free(memory, mark->origin);
    *mark = (mspringi_mark){NULL, NULL, NULL, NULL};
}

mspring_result mspringi_mark_allocate(mspring_network *network, mspringi_mark *mark, uint32_t groups) {
    mspringi_memory *memory = &network->memory;
    const mspringi_topology *t = &network->topology;
    mark->motion =
        mspringi_alloc(memory, (size_t)t->particle_count * mspringi_state_arrays(network), sizeof *mark->motion);
    mark->lengths = mspringi_alloc(memory, (size_t)t->spring_count * 2, sizeof *mark->lengths);
    mark->live = mspringi_alloc(memory, t->spring_count, sizeof *mark->live);
    mark->origin = mspringi_alloc(memory, (size_t)groups * 2, sizeof *mark->origin);
    if (mark->motion && mark->lengths && mark->live && mark->origin)
        return MSPRING_OK;
    free_mark(memory, mark);
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for marks of %u groups",
                         (unsigned)groups);
}

static void free_groups(mspringi_memory *memory, mspringi_groups *g) {
    mspringi_free(memory, g->first);
    mspringi_free(memory, g->first_spring);
    mspringi_free(memory, g->springs);
    mspringi_free(memory, g->changing);
    mspringi_free(memory, g->of_particle);
    mspringi_free(memory, g->flags);
    mspringi_free(memory, g->velocity);
    mspringi_free(memory, g->active_inverse_mass);
    free_mark(memory, &g->start);
    free_mark(memory, &g->mark);
}

static mspring_result allocate(mspring_network *network, mspringi_groups *g) {
    mspringi_memory *memory = &network->memory;
    const mspringi_topology *t = &network->topology;
    g->first = mspringi_alloc(memory, (size_t)g->count + 1, sizeof *g->first);
    g->first_spring = mspringi_alloc(memory, (size_t)g->count + 2, sizeof *g->first_spring);
    g->springs = mspringi_alloc(memory, t->spring_count, sizeof *g->springs);
    g->changing = mspringi_alloc(memory, t->spring_count, sizeof *g->changing);
    g->of_particle = mspringi_alloc(memory, t->reserve.particle_end, sizeof *g->of_particle);
    g->flags = mspringi_alloc(memory, g->count, sizeof *g->flags);
    g->velocity = mspringi_alloc(memory, (size_t)t->particle_count * 4, sizeof *g->velocity);
    g->active_inverse_mass = mspringi_alloc(memory, mspringi_slot_count(network), sizeof *g->active_inverse_mass);
    if (g->first && g->first_spring && g->springs && g->changing && g->of_particle && g->flags && g->velocity &&
        g->active_inverse_mass)
        return mspringi_mark_allocate(network, &g->start, g->count);
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for %u groups", (unsigned)g->count);
}

/* ------------------------------------------------------------------------------------------------------ filling */

static void number_particles(const mspring_network *network, mspringi_groups *g, const mspring_id *firsts) {
    for (mspring_id p = 0; p < network->topology.reserve.particle_end; ++p)
        g->of_particle[p] = g->count;
    for (uint32_t group = 0; group <= g->count; ++group)
        g->first[group] = firsts[group];
    for (uint32_t group = 0; group < g->count; ++group)
        for (mspring_id p = g->first[group]; p < g->first[group + 1]; ++p)
            g->of_particle[p] = group;
}

// Group of a spring, or MSPRING_NONE if its ends are in two.
static uint32_t group_of_spring(const mspring_network *network, const mspringi_groups *g, mspring_id spring) {
    const mspringi_ends ends = mspringi_spring_ends(network, spring);
    const uint32_t a = g->of_particle[network->topology.particle_of_slot[ends.a]],
                   b = g->of_particle[network->topology.particle_of_slot[ends.b]];
    return a == b ? a : MSPRING_NONE;
}

// List the springs of each group in order of their ids. Counters are stored two entries after their group, so that
// their sums, one entry after, are the beginnings; listing moves each on to its group's end.
static mspring_result list_springs(mspring_network *network, mspringi_groups *g) {
    const uint32_t springs = network->topology.spring_count;
    for (mspring_id s = 0; s < springs; ++s) {
        const uint32_t group = mspringi_spring_exists(network, s) ? group_of_spring(network, g, s) : g->count;
        if (group == MSPRING_NONE)
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                 "spring %u leads from one group to another, or out of a group", (unsigned)s);
        if (group < g->count)
            g->first_spring[group + 2]++;
    }
    for (uint32_t group = 0; group < g->count; ++group)
        g->first_spring[group + 2] += g->first_spring[group + 1];
    for (mspring_id s = 0; s < springs; ++s) {
        const uint32_t group = mspringi_spring_exists(network, s) ? group_of_spring(network, g, s) : g->count;
        if (group < g->count)
            g->springs[g->first_spring[group + 1]++] = s;
    }
    return MSPRING_OK;
}

mspring_result mspring_network_set_groups(mspring_network *network, const mspring_id *firsts, uint32_t count) {
    mspring_result result = mspringi_check_call(network);
    mspringi_groups made = {.count = count};
    if (result == MSPRING_OK)
        result = check_firsts(network, firsts, count);
    if (result == MSPRING_OK)
        result = check_network(network, count);
    if (result == MSPRING_OK && count > 0) {
        result = allocate(network, &made);
        if (result == MSPRING_OK)
            number_particles(network, &made, firsts);
        if (result == MSPRING_OK)
            result = list_springs(network, &made);
#define GROUPED(function) result = result == MSPRING_OK ? function(network, made.of_particle) : result;
#include "store/features.def"
        if (result != MSPRING_OK)
            free_groups(&network->memory, &made);
    }
    if (result != MSPRING_OK)
        return result;
    free_groups(&network->memory, &network->groups);
    network->groups = made;
    for (uint32_t group = 0; group < count; ++group)
        mspringi_mark_take(network, &network->groups.start, group);
    mspringi_notify_change(network, MSPRINGI_CHANGED_GROUPS, 0);
    return MSPRING_OK;
}

bool mspringi_groups_act(const mspring_network *network) {
    return network->groups.count > 0;
}

/// Holding and releasing groups: those that go wrong are held where they were, and the others go on.
///
/// NaN may spread in the step in which it comes up: arithmetic with springs that are not there hands it to
/// neighbouring lanes. So a group that has such numbers is to blame only if it has them when it steps with none of
/// the others that had. Each of these is tried once. A group that is out of bounds by numbers is to blame for sure.
#include "features/groups/edit_groups.h"

#include <math.h>
#include <string.h>

#include "base/assert.h"
#include "store/id_pool.h"

/* ------------------------------------------------------------------------------------------ what they ask for */

static mspring_result refuse(mspring_network *network, const char *what) {
    return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "groups of particles need %s", what);
}

static mspring_result check_settings(mspring_network *network, const mspring_settings *settings) {
    if (settings->guard != MSPRING_GUARD_BOUNDS)
        return refuse(network, "the guard MSPRING_GUARD_BOUNDS: others judge all of the network");
    if (settings->sleep_speed > 0.0f)
        return refuse(network, "sleep_speed 0");
    if (settings->solver != MSPRING_SOLVER_EXPLICIT)
        return refuse(network, "the explicit solver: others solve for all of the network");
    return settings->substeps == MSPRING_SUBSTEPS_AUTO || settings->substeps == MSPRING_SUBSTEPS_EVEN ||
                   settings->substep_length > 0.0
               ? refuse(network, "a number of substeps: automatic ones follow the stiffest of them")
               : MSPRING_OK;
}

/* ------------------------------------------------------------------------------------------------- holding */

static void hold(mspring_network *network, uint32_t group) {
    mspringi_groups *g = &network->groups;
    const mspringi_state *s = &network->state;
    MSPRINGI_ASSERT(!(g->flags[group] & MSPRINGI_HELD) && g->held < g->count);
    if (g->held == 0)
        memcpy(g->active_inverse_mass, network->inverse_mass,
               mspringi_slot_count(network) * sizeof *g->active_inverse_mass);
    for (mspring_id p = g->first[group]; p < g->first[group + 1]; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        float *kept = g->velocity + 4 * (size_t)p;
        kept[0] = s->vx[slot];
        kept[1] = s->vy[slot];
        kept[2] = s->low_vx ? s->low_vx[slot] : 0.0f;
        kept[3] = s->low_vx ? s->low_vy[slot] : 0.0f;
        mspringi_set_velocity(s, slot, 0.0f, 0.0f);
        g->active_inverse_mass[slot] = 0.0f;
    }
    g->flags[group] |= MSPRINGI_HELD;
    g->held++;
}

static void release(mspring_network *network, uint32_t group) {
    mspringi_groups *g = &network->groups;
    const mspringi_state *s = &network->state;
    for (mspring_id p = g->first[group]; p < g->first[group + 1]; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        const float *kept = g->velocity + 4 * (size_t)p;
        mspringi_set_velocity(s, slot, kept[0], kept[1]);
        if (s->low_vx) {
            s->low_vx[slot] = kept[2];
            s->low_vy[slot] = kept[3];
        }
        g->active_inverse_mass[slot] = network->inverse_mass[slot];
    }
    MSPRINGI_ASSERT(g->flags[group] & MSPRINGI_HELD && g->held > 0);
    g->flags[group] &= (uint8_t)~MSPRINGI_HELD;
    g->held--;
}

// Somebody may have set masses and velocities since.
static void begin(mspring_network *network) {
    mspringi_groups *g = &network->groups;
    const mspringi_state *s = &network->state;
    if (g->held == 0)
        return;
    memcpy(g->active_inverse_mass, network->inverse_mass,
           mspringi_slot_count(network) * sizeof *g->active_inverse_mass);
    for (uint32_t group = 0; group < g->count; ++group)
        for (mspring_id p = g->first[group]; g->flags[group] & MSPRINGI_HELD && p < g->first[group + 1]; ++p) {
            const uint32_t slot = network->topology.slot_of_particle[p];
            mspringi_set_velocity(s, slot, 0.0f, 0.0f);
            g->active_inverse_mass[slot] = 0.0f;
        }
}

/* ----------------------------------------------------------------------------------------------------- judging */

// 0, MSPRINGI_SUSPECT or that with MSPRINGI_DOUBTFUL.
static uint8_t look_at(const mspring_network *network, uint32_t group) {
    const mspringi_groups *g = &network->groups;
    const mspringi_state *s = &network->state;
    const float largest = (float)MSPRING_MAX_COORDINATE, fastest = network->settings.max_speed;
    uint8_t found = 0;
    for (mspring_id p = g->first[group]; p < g->first[group + 1]; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        const float place = fmaxf(fabsf(s->x[slot]), fabsf(s->y[slot])),
                    speed = fmaxf(fabsf(s->vx[slot]), fabsf(s->vy[slot]));
        const float sum = s->x[slot] + s->y[slot] + s->vx[slot] + s->vy[slot];
        if (!isfinite(sum))
            return MSPRINGI_SUSPECT | MSPRINGI_DOUBTFUL;
        if (place > largest || speed > fastest)
            found = MSPRINGI_SUSPECT;
    }
    return found;
}

static void suspect(mspring_network *network) {
    mspringi_groups *g = &network->groups;
    for (uint32_t group = 0; group < g->count; ++group)
        if (!(g->flags[group] & MSPRINGI_HELD))
            g->flags[group] |= look_at(network, group);
}

static bool hold_suspects(mspring_network *network) {
    mspringi_groups *g = &network->groups;
    bool any = false;
    for (uint32_t group = 0; group < g->count; ++group) {
        if ((g->flags[group] & (MSPRINGI_SUSPECT | MSPRINGI_HELD)) != MSPRINGI_SUSPECT)
            continue;
        hold(network, group);
        g->flags[group] |= MSPRINGI_NEWLY;
        any = true;
    }
    return any;
}

// One that is alone in it has nobody to blame.
static uint32_t next_doubtful(const mspring_network *network, uint32_t from) {
    const mspringi_groups *g = &network->groups;
    uint32_t suspects = 0;
    for (uint32_t group = 0; group < g->count; ++group)
        suspects += (g->flags[group] & MSPRINGI_NEWLY) != 0;
    while (from < g->count && (suspects < 2 || (g->flags[from] & (MSPRINGI_DOUBTFUL | MSPRINGI_NEWLY)) !=
                                                   (MSPRINGI_DOUBTFUL | MSPRINGI_NEWLY)))
        ++from;
    return from;
}

static void end(mspring_network *network, bool is_taken) {
    mspringi_groups *g = &network->groups;
    for (uint32_t group = 0; group < g->count; ++group) {
        const uint8_t flags = g->flags[group];
        if (!is_taken && flags & MSPRINGI_NEWLY && flags & MSPRINGI_HELD)
            release(network, group);
        g->flags[group] &= MSPRINGI_HELD;
    }
}

const mspringi_group_ops mspringi_ops_of_groups = {.check_settings = check_settings,
                                                   .begin = begin,
                                                   .suspect = suspect,
                                                   .hold_suspects = hold_suspects,
                                                   .next_doubtful = next_doubtful,
                                                   .hold = hold,
                                                   .release = release,
                                                   .end = end,
                                                   .find_frame = mspringi_group_find_frame};

/// Marks of groups, and resets to them.
#include <string.h>

#include "base/assert.h"
#include "base/cpu.h"
#include "features/actuators/actuators.h"
#include "features/contact/contacts.h"
#include "features/groups/edit_groups.h"
#include "features/ramps/ramps.h"
#include "store/changed.h"
#include "store/group_ops.h"
#include "store/id_pool.h"
#include "store/metres.h"
#include "store/rest_lengths.h"
#include "store/selection.h"
#include "store/spring_limits.h"
#include "store/springs.h"

/* --------------------------------------------------------------------------------------------------- marking */

void mspringi_mark_take(mspring_network *network, mspringi_mark *mark, uint32_t group) {
    const mspringi_groups *g = &network->groups;
    const mspringi_topology *t = &network->topology;
    const float *arrays = network->state.x, *nominal = network->tested.nominal;
    const size_t slots = mspringi_slot_count(network), values = mspringi_state_arrays(network);
    for (mspring_id p = g->first[group]; p < g->first[group + 1]; ++p)
        for (size_t i = 0; i < values; ++i)
            mark->motion[p * values + i] = arrays[i * slots + t->slot_of_particle[p]];
    for (uint32_t i = g->first_spring[group]; i < g->first_spring[group + 1]; ++i) {
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(t, g->springs[i]);
        const float length = mspringi_spring_slot_own_length(network, spring_slot);
        mark->lengths[2 * (size_t)i] = length;
        mark->lengths[2 * (size_t)i + 1] = nominal ? nominal[spring_slot] : length;
        mark->live[i] = mspringi_spring_slot_is_live(network, spring_slot);
    }
    mark->origin[2 * (size_t)group] = network->origin_x;
    mark->origin[2 * (size_t)group + 1] = network->origin_y;
}

mspring_result mspring_network_mark_groups(mspring_network *network, const mspring_id *ids, mspring_id first,
                                           uint32_t count) {
    mspringi_selection marked;
    mspring_result result = mspringi_select(network, MSPRING_GROUPS, ids, first, count, &marked);
    if (result != MSPRING_OK)
        return result;
    mspringi_groups *g = &network->groups;
    if (!g->mark.motion && marked.count > 0) {
        result = mspringi_mark_allocate(network, &g->mark, g->count);
        if (result != MSPRING_OK)
            return result;
        const mspringi_topology *t = &network->topology;
        memcpy(g->mark.motion, g->start.motion,
               (size_t)t->particle_count * mspringi_state_arrays(network) * sizeof *g->mark.motion);
        memcpy(g->mark.lengths, g->start.lengths, (size_t)t->spring_count * 2 * sizeof *g->mark.lengths);
        memcpy(g->mark.live, g->start.live, t->spring_count * sizeof *g->mark.live);
        memcpy(g->mark.origin, g->start.origin, (size_t)g->count * 2 * sizeof *g->mark.origin);
    }
    for (uint32_t i = 0; i < marked.count; ++i)
        mspringi_mark_take(network, &g->mark, mspringi_selected(&marked, i));
    return MSPRING_OK;
}

/* ------------------------------------------------------------------------------------------------------- resets */

// List the springs with the given state, live or broken, at the mark and the other one now. A group may be listed
// twice.
static uint32_t list_changed(mspring_network *network, const mspringi_mark *mark, const mspringi_selection *of,
                             bool were_live) {
    mspringi_groups *g = &network->groups;
    uint32_t found = 0;
    for (uint32_t k = 0; k < of->count; ++k) {
        const uint32_t group = mspringi_selected(of, k);
        for (uint32_t i = g->first_spring[group]; i < g->first_spring[group + 1]; ++i)
            if (mark->live[i] == were_live && mspringi_spring_is_live(network, g->springs[i]) != were_live &&
                mspringi_spring_exists(network, g->springs[i]) && found < network->topology.spring_count)
                g->changing[found++] = g->springs[i];
    }
    return found;
}

static mspring_result restore_links(mspring_network *network, const mspringi_mark *mark,
                                    const mspringi_selection *of) {
    const mspring_id *changing = network->groups.changing;
    if (!network->edits.broke)
        return MSPRING_OK;
    const uint32_t restored = list_changed(network, mark, of, true);
    mspring_result result =
        restored > 0 ? mspring_network_restore_springs(network, changing, 0, restored, 0.0) : MSPRING_OK;
    const uint32_t broken = result == MSPRING_OK ? list_changed(network, mark, of, false) : 0;
    return broken > 0 ? mspring_network_break_springs(network, changing, 0, broken) : result;
}

static void restore_motion(mspring_network *network, const mspringi_mark *mark, uint32_t group) {
    const mspringi_groups *g = &network->groups;
    const mspringi_state *s = &network->state;
    const size_t slots = mspringi_slot_count(network), values = mspringi_state_arrays(network);
    const double dx = mark->origin[2 * (size_t)group] - network->origin_x,
                 dy = mark->origin[2 * (size_t)group + 1] - network->origin_y;
    for (mspring_id p = g->first[group]; p < g->first[group + 1]; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        if (!mspringi_particle_exists(network, p))
            continue;
        for (size_t i = 0; i < values; ++i)
            s->x[i * slots + slot] = mark->motion[p * values + i];
        if (dx != 0.0 || dy != 0.0) {
            mspringi_set_x(s, slot, mspringi_x_of(s, slot) + dx);
            mspringi_set_y(s, slot, mspringi_y_of(s, slot) + dy);
        }
        mspringi_contact_forget_impulses_of(network, p);
    }
}

static void put_length_back(mspring_network *network, mspring_id spring, const float lengths[2]) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    const uint32_t *actuator = network->actuators ? network->actuators->of_spring : NULL;
    float *nominal = network->tested.nominal;
    const bool is_plain =
        mspringi_actuators_are_plain(network) && spring_slot < network->topology.lattice_spring_slots;
    if (actuator && actuator[spring] != MSPRING_NONE)
        network->actuators->to[actuator[spring]] = lengths[1];
    if (mspringi_ramp_count(network) > 0)
        mspringi_ramp_drop(network, spring);
    if (is_plain)
        network->rest_lengths.lengths[spring_slot] = lengths[0];
    else if (mspringi_spring_slot_get(network, spring_slot).rest_length != lengths[0])
        mspringi_spring_slot_set_rest_length(network, spring_slot, lengths[0]);
    if (nominal) {
        nominal[spring_slot] = lengths[1];
        mspringi_limits_renew(network, spring_slot);
    }
    if (network->metres)
        mspringi_metres_renew(network, spring);
}

static void put_back(mspring_network *network, const mspringi_mark *mark, uint32_t group) {
    mspringi_groups *g = &network->groups;
    if (g->flags[group] & MSPRINGI_HELD)
        mspringi_ops_of_groups.release(network, group);
    MSPRINGI_ASSERT(group < g->count);
    restore_motion(network, mark, group);
    mspringi_sent_forget(&network->sent[mspringi_sent_index(MSPRING_REST_LENGTH)]);
    for (uint32_t i = g->first_spring[group]; i < g->first_spring[group + 1]; ++i)
        if (mspringi_spring_exists(network, g->springs[i]))
            put_length_back(network, g->springs[i], mark->lengths + 2 * (size_t)i);
}

mspring_result mspring_network_reset_groups(mspring_network *network, mspring_reset to, const mspring_id *ids,
                                            mspring_id first, uint32_t count) {
    mspringi_selection reset;
    mspring_result result = mspringi_select(network, MSPRING_GROUPS, ids, first, count, &reset);
    if (result == MSPRING_OK && to != MSPRING_RESET_START && to != MSPRING_RESET_MARK)
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "reset is %d, which is none", (int)to);
    if (result != MSPRING_OK)
        return result;
    const mspringi_groups *g = &network->groups;
    const mspringi_mark *mark = to == MSPRING_RESET_MARK && g->mark.motion ? &g->mark : &g->start;
    result = restore_links(network, mark, &reset);
    if (result != MSPRING_OK || reset.count == 0)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    for (uint32_t i = 0; i < reset.count; ++i)
        put_back(network, mark, mspringi_selected(&reset, i));
    mspringi_fp_leave(before);
    network->edits.flows++;
    mspringi_notify_change(network, MSPRINGI_CHANGED_STATE, 0);
    return MSPRING_OK;
}

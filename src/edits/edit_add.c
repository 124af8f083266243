/// Adding particles and springs.
#include <math.h>

#include "base/assert.h"
#include "base/bytes.h"
#include "base/cpu.h"
#include "base/hash.h"
#include "features/breaking/breaking.h"
#include "features/contact/contacts.h"
#include "features/contact/floor.h"
#include "features/poses/poses.h"
#include "features/ramps/ramps.h"
#include "layout/emit/spare.h"
#include "step/origin.h"
#include "store/changed.h"
#include "store/fractions.h"
#include "store/id_pool.h"
#include "store/metres.h"
#include "store/spring_limits.h"
#include "store/springs.h"

static mspring_result check_arrays(mspring_network *network, const void *defs, uint32_t count, const void *ids) {
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK && count > 0 && (!defs || !ids))
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "an array of %u elements is NULL",
                               (unsigned)count);
    if (result == MSPRING_OK && network->groups.count > 0)
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "nothing is added to groups of particles: set no groups before");
    return result;
}

// Lowest spare id from first on; end if there is none.
static mspring_id find_spare(const uint8_t *marks, mspring_id first, mspring_id end) {
    return marks && first < end ? mspringi_find_byte(marks, MSPRINGI_SPARE, first, end) : end;
}

// Return an error if fewer than `count` ids are spare.
static mspring_result check_room(mspring_network *network, const char *what, const uint8_t *marks,
                                 mspring_id lowest, mspring_id first, mspring_id end, uint32_t count) {
    uint32_t room = 0;
    for (mspring_id id = find_spare(marks, lowest, end); id < end && room < count;
         id = find_spare(marks, id + 1, end))
        ++room;
    return room == count
               ? MSPRING_OK
               : mspringi_fail(
                     &network->message, MSPRING_ERROR_LIMIT,
                     "no room for %u %s%s: spare_%ss (mspring_network_def) is %u, and %u of these are free. "
                     "Set more at creation; mspring_network_reuse_ids() frees what was removed",
                     (unsigned)count, what, count == 1 ? "" : "s", what, (unsigned)(end - first), (unsigned)room);
}

/* --------------------------------------------------------------------------------------------------- particles */

static mspring_result check_particle(mspring_network *network, mspring_id id, const mspring_particle_def *defs,
                                     uint32_t i) {
    mspring_particle_def taken, *def = &taken;
    mspring_result result = mspringi_take_particle(&network->message, id, defs, i, def);
    const double largest = MSPRING_MAX_COORDINATE;
    if (result == MSPRING_OK &&
        !(fabs(def->x - network->origin_x) <= largest && fabs(def->y - network->origin_y) <= largest))
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "particle %u: position (%g, %g) m is not within 1e12 of the local origin",
                               (unsigned)id, def->x, def->y);
    return result;
}

static void put_particle(mspring_network *network, mspring_id p, const mspring_particle_def *defs, uint32_t i) {
    mspring_particle_def taken, *def = &taken;
    (void)mspringi_take_particle_def_at(NULL, defs, i, def);
    const bool is_pinned = def->flags & MSPRING_PARTICLE_PINNED;
    mspringi_spare_add_particle(&network->topology, p);
    if (network->is_compact)
        mspringi_spare_add_particle(&network->whole, p);
    const uint32_t slot = network->topology.slot_of_particle[p];
    MSPRINGI_ASSERT(network->growth.particles[p] == MSPRINGI_SPARE &&
                    p >= network->topology.reserve.first_particle);
    network->growth.particles[p] = MSPRINGI_THERE;
    network->mass[p] = def->mass;
    network->inverse_mass[slot] = is_pinned ? 0.0f : 1.0f / def->mass;
    if (network->inverse_mass_scale)
        network->inverse_mass_scale[p] = is_pinned ? 0.0f : 1.0f;
    if (network->components.number)
        network->components.number[p] = MSPRING_NONE;
    network->state.vx[slot] = def->vx;
    network->state.vy[slot] = def->vy;
    mspringi_set_position(network, p, def->x, def->y);
    mspringi_pose_keep(network, p);
    mspringi_contact_take_in(network, p);
    mspringi_fingerprint(network, MSPRINGI_EDIT_ADDED_PARTICLE, p);
    network->parameter_fingerprint = mspringi_hash(network->parameter_fingerprint, def->flags);
}

static MSPRINGI_NOINLINE mspring_result add_particles(mspring_network *network, const mspring_particle_def *defs,
                                                      uint32_t count, mspring_id *ids) {
    const mspringi_reserve *reserve = &network->topology.reserve;
    mspringi_id_pool *g = &network->growth;
    mspring_result result = check_room(network, "particle", g->particles, g->lowest_particle,
                                       reserve->first_particle, reserve->particle_end, count);
    mspring_id id = g->lowest_particle;
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i, ++id) {
        id = find_spare(g->particles, id, reserve->particle_end);
        result = check_particle(network, id, defs, i);
        if (count > 1)
            result = mspringi_prefix(&network->message, result, "definition", i);
    }
    if (result != MSPRING_OK)
        return result;
    uint32_t end = network->topology.particle_count;
    id = g->lowest_particle;
    for (uint32_t i = 0; i < count; ++i) {
        id = find_spare(g->particles, id, reserve->particle_end);
        put_particle(network, id, defs, i);
        end = id >= end ? id + 1 : end;
        ids[i] = id;
    }
    g->lowest_particle = id;
    mspringi_id_pool_count(network, end, network->topology.spring_count);
    return MSPRING_OK;
}

mspring_result mspring_network_add_particles(mspring_network *network, const mspring_particle_def *defs,
                                             uint32_t count, mspring_id *ids) {
    mspring_result result = check_arrays(network, defs, count, ids);
    if (result != MSPRING_OK || count == 0)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    result = add_particles(network, defs, count, ids);
    mspringi_fp_leave(before);
    return result;
}

/* ----------------------------------------------------------------------------------------------------- springs */

static mspring_result check_ends(mspring_network *network, mspring_id id, const mspring_spring_def *def) {
    const mspring_id ends[] = {def->a, def->b};
    if (def->a == MSPRING_NONE || def->b == MSPRING_NONE)
        return mspringi_fail(&network->message, MSPRING_ERROR_ID,
                             "spring %u: its particle %s is not set (MSPRING_NONE)", (unsigned)id,
                             def->a == MSPRING_NONE ? "a" : "b");
    for (int i = 0; i < 2; ++i)
        if (ends[i] >= network->topology.particle_count || !mspringi_particle_exists(network, ends[i]))
            return mspringi_fail(&network->message, MSPRING_ERROR_ID, "spring %u: there is no particle %u",
                                 (unsigned)id, (unsigned)ends[i]);
    return MSPRING_OK;
}

static mspring_result check_unique(mspring_network *network, mspring_id id, const mspring_spring_def *def) {
    mspringi_springs_between pair = mspringi_springs_between_begin(network, def->a, def->b);
    const mspring_id s = mspringi_springs_between_next(network, &pair);
    return s == MSPRING_NONE
               ? MSPRING_OK
               : mspringi_fail(&network->message, MSPRING_ERROR_DUPLICATE,
                               "spring %u: particles %u and %u are joined by spring %u, which may be broken",
                               (unsigned)id, (unsigned)def->a, (unsigned)def->b, (unsigned)s);
}

static mspring_result check_kind(mspring_network *network, mspring_id id, const mspring_spring_def *def) {
    if (def->flags & MSPRING_SPRING_RELATIVE && !network->fractions.values)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "spring %u is relative, but the network was created without any that is "
                             "(MSPRING_NETWORK_RESERVE_RELATIVE)",
                             (unsigned)id);
    if (def->flags & (MSPRING_SPRING_PULL_ONLY | MSPRING_SPRING_PUSH_ONLY))
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "spring %u: springs that only pull or only push come from a builder", (unsigned)id);
    if (def->damping > 0.0f && network->parts <= MSPRINGI_DAMPING)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "spring %u: damping is %g, but the network was created without room for any "
                             "(MSPRING_NETWORK_RESERVE_DAMPING)",
                             (unsigned)id, (double)def->damping);
    return MSPRING_OK;
}

static mspring_result find_rest_length(mspring_network *network, mspring_id id, const mspring_spring_def *def,
                                       float *rest_length) {
    const mspringi_state *s = &network->state;
    const uint32_t a = network->topology.slot_of_particle[def->a], b = network->topology.slot_of_particle[def->b];
    return mspringi_find_rest_length(&network->message, id, def, (double)s->x[b] - (double)s->x[a],
                                     (double)s->y[b] - (double)s->y[a], rest_length);
}

// Check a spring and link its ends, so that later checks see it.
static mspring_result link_spring(mspring_network *network, mspring_id id, const mspring_spring_def *defs,
                                  uint32_t i) {
    mspring_spring_def taken, *def = &taken;
    float rest_length;
    mspring_result result = mspringi_take_spring(&network->message, id, defs, i, def);
    if (result == MSPRING_OK)
        result = check_ends(network, id, def);
    if (result == MSPRING_OK)
        result = mspringi_check_spring_values(&network->message, id, def);
    if (result == MSPRING_OK)
        result = check_kind(network, id, def);
    if (result == MSPRING_OK)
        result = find_rest_length(network, id, def, &rest_length);
    if (result == MSPRING_OK)
        result = check_unique(network, id, def);
    if (result == MSPRING_OK)
        mspringi_id_pool_link(network, id, def->a, def->b);
    return result;
}

static void put_spring(mspring_network *network, mspring_id s, const mspring_spring_def *defs, uint32_t i) {
    mspring_spring_def taken, *def = &taken;
    float rest_length = 0.0f;
    (void)mspringi_take_spring_def_at(NULL, defs, i, def);
    (void)find_rest_length(network, s, def, &rest_length);
    mspringi_solvers_clear_spring(network, mspringi_slot_of_spring(&network->topology, s));
    mspringi_spare_add_spring(&network->topology, s, def->a, def->b);
    if (network->is_compact)
        mspringi_spare_add_spring(&network->whole, s, def->a, def->b);
    MSPRINGI_ASSERT(network->growth.springs[s] == MSPRINGI_SPARE && s >= network->topology.reserve.first_spring);
    network->growth.springs[s] = MSPRINGI_THERE;
    const bool relative = def->flags & MSPRING_SPRING_RELATIVE;
    if (network->fractions.values)
        mspringi_fractions_set(&network->fractions, s,
                               (mspringi_relative){relative ? def->stiffness : -1.0f, 0.0f});
    MSPRINGI_ASSERT(!mspringi_has_ramp(network, s)); // a removed spring was broken first
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, s);
    const float damping = mspringi_find_damping(def->stiffness, def->damping, def->flags, network->mass[def->a],
                                                network->mass[def->b]);
    mspringi_spring_slot_set_rest_length(network, spring_slot, rest_length);
    mspringi_spring_come_live(network, s);
    mspringi_spring_set_nominal(network, s, spring_slot, (mspringi_relative){def->stiffness, damping});
    mspringi_limits_forget(network, s);
    mspringi_limits_put(network, s, def->flags, MSPRINGI_LIMITS_OF(def));
    mspringi_fingerprint(network, relative ? MSPRINGI_EDIT_ADDED_RELATIVE : MSPRINGI_EDIT_ADDED_SPRING, s);
    mspringi_fingerprint(network, def->a, def->b);
    mspringi_fingerprint_floats(network, def->stiffness, damping);
    mspringi_fingerprint_floats(network, rest_length, 0.0f);
}

static MSPRINGI_NOINLINE mspring_result add_springs(mspring_network *network, const mspring_spring_def *defs,
                                                    uint32_t count, mspring_id *ids) {
    const mspringi_reserve *reserve = &network->topology.reserve;
    mspringi_id_pool *g = &network->growth;
    mspring_result result = check_room(network, "spring", g->springs, g->lowest_spring, reserve->first_spring,
                                       reserve->spring_end, count);
    if (result != MSPRING_OK)
        return result;
    mspring_id id = g->lowest_spring;
    uint32_t linked = 0;
    for (; linked < count; ++linked, ++id) {
        id = find_spare(g->springs, id, reserve->spring_end);
        result = link_spring(network, id, defs, linked);
        if (result != MSPRING_OK)
            break;
    }
    if (count > 1)
        result = mspringi_prefix(&network->message, result, "definition", linked);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        mspring_spring_def def;
        (void)mspringi_take_spring_def_at(NULL, defs, i, &def);
        result = mspringi_limits_reserve(network, MSPRINGI_LIMITS_OF(&def));
        if (result == MSPRING_OK)
            result = mspringi_metres_reserve(network, def.flags);
    }
    if (result != MSPRING_OK) {
        for (id = g->lowest_spring; linked > 0; --linked, ++id) {
            id = find_spare(g->springs, id, reserve->spring_end);
            mspringi_id_pool_unlink(network, id);
        }
        return result;
    }
    uint32_t end = network->topology.spring_count;
    id = g->lowest_spring;
    for (uint32_t i = 0; i < count; ++i) {
        id = find_spare(g->springs, id, reserve->spring_end);
        put_spring(network, id, defs, i);
        end = id >= end ? id + 1 : end;
        ids[i] = id;
    }
    g->lowest_spring = id;
    mspringi_id_pool_count(network, network->topology.particle_count, end);
    mspringi_notify_change(network, MSPRINGI_CHANGED_GRAFTS, 0);
    return MSPRING_OK;
}

mspring_result mspring_network_add_springs(mspring_network *network, const mspring_spring_def *defs, uint32_t count,
                                           mspring_id *ids) {
    mspring_result result = check_arrays(network, defs, count, ids);
    if (result != MSPRING_OK || count == 0)
        return result;
    if (!network->solver.ops->can_add)
        return mspringi_fail(
            &network->message, MSPRING_ERROR_ARGUMENT,
            "the direct solver has found an order of elimination for the springs that there were when "
            "it was chosen: choose another solver before springs are added, and the direct one after "
            "it");
    const mspringi_fp_state before = mspringi_fp_enter();
    result = add_springs(network, defs, count, ids);
    mspringi_fp_leave(before);
    return result;
}

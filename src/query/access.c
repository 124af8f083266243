/// Access of the host to the state, by id; the hash.
#include <math.h>

#include "base/cpu.h"
#include "base/hash.h"
#include "step/origin.h"
#include "store/changed.h"
#include "store/network.h"
#include "store/selection.h"
#include "store/springs.h"

/* ---------------------------------------------------------------------------------------------------------- get */

// A removed particle reads as 0, whatever hooks have written to its slot.
static void get_positions(const mspring_network *network, const mspringi_selection *at, double *x, double *y,
                          size_t stride) {
    const double origin_x = network->origin_x, origin_y = network->origin_y;
    const mspringi_state state = network->state;
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id particle = mspringi_selected(at, i);
        const uint32_t slot = network->topology.slot_of_particle[particle];
        const bool is_there = mspringi_particle_exists(network, particle);
        x[i * stride] = is_there ? origin_x + mspringi_x_of(&state, slot) : 0.0;
        y[i * stride] = is_there ? origin_y + mspringi_y_of(&state, slot) : 0.0;
    }
}

static void get_velocities(const mspring_network *network, const mspringi_selection *at, float *vx, float *vy,
                           size_t stride) {
    const mspringi_state state = network->state;
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id particle = mspringi_selected(at, i);
        const uint32_t slot = network->topology.slot_of_particle[particle];
        const bool is_there = mspringi_particle_exists(network, particle);
        vx[i * stride] = is_there ? state.vx[slot] : 0.0f;
        vy[i * stride] = is_there ? state.vy[slot] : 0.0f;
    }
}

mspring_result mspring_network_get_positions(const mspring_network *network, const mspring_id *ids,
                                             mspring_id first, uint32_t count, double *x, double *y,
                                             uint32_t stride) {
    mspringi_selection at;
    const mspring_result result =
        mspringi_look_up_for(network, MSPRING_PARTICLES, ids, first, count, x, y, stride, &at);
    if (result == MSPRING_OK)
        get_positions(network, &at, x, y, stride);
    return result;
}

mspring_result mspring_network_get_velocities(const mspring_network *network, const mspring_id *ids,
                                              mspring_id first, uint32_t count, float *vx, float *vy,
                                              uint32_t stride) {
    mspringi_selection at;
    const mspring_result result =
        mspringi_look_up_for(network, MSPRING_PARTICLES, ids, first, count, vx, vy, stride, &at);
    if (result == MSPRING_OK)
        get_velocities(network, &at, vx, vy, stride);
    return result;
}

/* --------------------------------------------------------------------------------------------- set positions */

typedef struct positions {
    const double *x, *y;
    size_t stride;
} positions;

static mspring_result check_position(mspring_network *network, mspring_id id, double x, double y,
                                     bool keep_origin) {
    const double largest = MSPRING_MAX_COORDINATE;
    const double origin_x = keep_origin ? network->origin_x : 0.0, origin_y = keep_origin ? network->origin_y : 0.0;
    if (fabs(x) <= largest && fabs(y) <= largest && fabs(x - origin_x) <= largest && fabs(y - origin_y) <= largest)
        return MSPRING_OK;
    return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                         "particle %u: position (%g, %g) m is not within 1e12 of world and local origin",
                         (unsigned)id, x, y);
}

// A range of all particles moves the origin along.
static MSPRINGI_NOINLINE mspring_result set_positions(mspring_network *network, const mspringi_selection *at,
                                                      const positions *to) {
    const bool all = !at->list && at->count == network->topology.particle_count;
    mspringi_box box = mspringi_box_empty();
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id particle = mspringi_selected(at, i);
        if (!mspringi_particle_exists(network, particle))
            continue;
        mspring_result result =
            check_position(network, particle, to->x[i * to->stride], to->y[i * to->stride], !all);
        if (result != MSPRING_OK)
            return result;
        mspringi_box_include(&box, to->x[i * to->stride], to->y[i * to->stride]);
    }
    if (all && box.min_x <= box.max_x)
        mspringi_origin_choose(network, &box);
    for (uint32_t i = 0; i < at->count; ++i)
        if (mspringi_particle_exists(network, mspringi_selected(at, i)))
            mspringi_set_position(network, mspringi_selected(at, i), to->x[i * to->stride], to->y[i * to->stride]);
    mspringi_notify_change(network, MSPRINGI_CHANGED_STATE, 0);
    if (all)
        mspringi_notify_change(network, MSPRINGI_CHANGED_MOTION, 0);
    return MSPRING_OK;
}

static mspring_result set_rounding_to_nearest(mspring_network *network, const mspringi_selection *at,
                                              const positions *to) {
    const mspringi_fp_state before = mspringi_fp_enter();
    mspring_result result = set_positions(network, at, to);
    mspringi_fp_leave(before);
    return result;
}

mspring_result mspring_network_set_positions(mspring_network *network, const mspring_id *ids, mspring_id first,
                                             uint32_t count, const double *x, const double *y, uint32_t stride) {
    mspringi_selection at;
    const mspring_result result =
        mspringi_select_for(network, MSPRING_PARTICLES, ids, first, count, x, y, stride, &at);
    return result == MSPRING_OK ? set_rounding_to_nearest(network, &at, &(positions){x, y, stride}) : result;
}

/* -------------------------------------------------------------------------------------------- set velocities */

static mspring_result set_velocities(mspring_network *network, const mspringi_selection *at, const float *vx,
                                     const float *vy, uint32_t stride) {
    for (uint32_t i = 0; i < at->count; ++i) {
        const float x = vx[(size_t)i * stride], y = vy[(size_t)i * stride];
        if ((!mspringi_is_speed(x) || !mspringi_is_speed(y)) &&
            mspringi_particle_exists(network, mspringi_selected(at, i)))
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                 "particle %u: velocity (%g, %g) m/s is not within 1e15",
                                 (unsigned)mspringi_selected(at, i), (double)x, (double)y);
    }
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id particle = mspringi_selected(at, i);
        const uint32_t slot = network->topology.slot_of_particle[particle];
        if (!mspringi_particle_exists(network, particle))
            continue;
        mspringi_set_velocity(&network->state, slot, vx[(size_t)i * stride], vy[(size_t)i * stride]);
    }
    mspringi_notify_change(network, MSPRINGI_CHANGED_STATE, 0);
    return MSPRING_OK;
}

mspring_result mspring_network_set_velocities(mspring_network *network, const mspring_id *ids, mspring_id first,
                                              uint32_t count, const float *vx, const float *vy, uint32_t stride) {
    mspringi_selection at;
    const mspring_result result =
        mspringi_select_for(network, MSPRING_PARTICLES, ids, first, count, vx, vy, stride, &at);
    return result == MSPRING_OK ? set_velocities(network, &at, vx, vy, stride) : result;
}

/* -------------------------------------------------------------------------------------------------------- hash */

// Add the rest lengths of springs that have flowed.
static uint64_t hash_rest_lengths(const mspring_network *network, uint64_t sum) {
    const mspringi_topology *t = &network->topology;
    for (mspring_id s = 0; s < t->spring_count; ++s) {
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(t, s);
        const float own = mspringi_spring_slot_own_length(network, spring_slot);
        if (mspringi_spring_exists(network, s) && own != network->tested.nominal[spring_slot])
            sum = mspringi_hash_floats(mspringi_hash(sum, s), own, 0.0f);
    }
    return sum;
}

mspring_result mspring_network_get_state_hash(const mspring_network *network, uint64_t *hash) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    if (!hash)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT, "the place for the hash is NULL");
    const mspringi_topology *t = &network->topology;
    const mspringi_state *s = &network->state;
    uint64_t sum = MSPRINGI_HASH_START;
    sum = mspringi_hash_double(sum, network->origin_x);
    sum = mspringi_hash_double(sum, network->origin_y);
    sum = mspringi_hash_double(sum, (double)network->steps.lag);
    if (network->steps.pace.left != 0.0)
        sum = mspringi_hash_double(sum, network->steps.pace.left);
    for (mspring_id p = 0; p < t->particle_count; ++p) {
        const uint32_t slot = t->slot_of_particle[p];
        if (mspringi_particle_exists(network, p)) {
            sum = mspringi_hash_floats(sum, s->x[slot], s->y[slot]);
            sum = mspringi_hash_floats(sum, s->vx[slot], s->vy[slot]);
            sum = mspringi_hash_floats(sum, mspringi_low_of(s->x[slot], s->low_x[slot], s->grid),
                                       mspringi_low_of(s->y[slot], s->low_y[slot], s->grid));
            if (s->low_vx && !network->is_open)
                sum = mspringi_hash_floats(sum, s->low_vx[slot], s->low_vy[slot]);
            else if (s->low_vx)
                sum = mspringi_hash_floats(sum, mspringi_low_of(s->vx[slot], s->low_vx[slot], 0.0f),
                                           mspringi_low_of(s->vy[slot], s->low_vy[slot], 0.0f));
        } else {
            for (size_t pair = 0; pair < mspringi_state_arrays(network) / 2; ++pair)
                sum = mspringi_hash_floats(sum, 0.0f, 0.0f);
        }
    }
    *hash = network->tested.is_bent ? hash_rest_lengths(network, sum) : sum;
    return MSPRING_OK;
}

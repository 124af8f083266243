/// Reading and writing the state from outside: views, ranges in id order, forces, the hash.
#include <math.h>

#include "base/cpu.h"
#include "base/mix.h"
#include "step/origin.h"
#include "store/changed.h"
#include "store/network.h"
#include "store/selection.h"

static bool is_finite_pair(float x, float y) {
    return isfinite(x) && isfinite(y);
}

/* ------------------------------------------------------------------------------------------------------- views */

mspring_result mspring_network_view(mspring_network *network, mspring_view *view) {
    if (!network || !view)
        return MSPRING_ERROR_ARGUMENT;
    if (view->struct_size != sizeof *view)
        return MSPRING_ERROR_STRUCT;
    network->is_open = true;
    *view = (mspring_view){
        .struct_size = sizeof *view,
        .slot_count = (uint32_t)mspringi_slot_count(network),
        .particle_count = network->topology.particle_count,
        .origin_x = network->origin_x,
        .origin_y = network->origin_y,
        .x = network->state.x,
        .y = network->state.y,
        .vx = network->state.vx,
        .vy = network->state.vy,
        .inverse_mass = network->inverse_mass,
        .particle_of_slot = network->topology.particle_of_slot,
        .slot_of_particle = network->topology.slot_of_particle,
    };
    return MSPRING_OK;
}

/* --------------------------------------------------------------------------------------------------- get ranges */

// A range for a shared function: no message, as several threads may be here.
static mspring_result check_get(const mspring_network *network, mspring_id first, uint32_t count, const void *a,
                                const void *b) {
    if (!network || (count > 0 && (!a || !b)))
        return MSPRING_ERROR_ARGUMENT;
    const uint32_t total = network->topology.particle_count;
    return first <= total && count <= total - first ? MSPRING_OK : MSPRING_ERROR_ID;
}

mspring_result mspring_network_get_positions(const mspring_network *network, mspring_id first, uint32_t count,
                                             double *x, double *y) {
    mspring_result result = check_get(network, first, count, x, y);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[first + i];
        x[i] = network->origin_x + mspringi_x_of(&network->state, slot);
        y[i] = network->origin_y + mspringi_y_of(&network->state, slot);
    }
    return result;
}

mspring_result mspring_network_get_positions_float(const mspring_network *network, mspring_id first, uint32_t count,
                                                   float *x, float *y) {
    mspring_result result = check_get(network, first, count, x, y);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[first + i];
        x[i] = (float)(network->origin_x + mspringi_x_of(&network->state, slot));
        y[i] = (float)(network->origin_y + mspringi_y_of(&network->state, slot));
    }
    return result;
}

mspring_result mspring_network_get_velocities(const mspring_network *network, mspring_id first, uint32_t count,
                                              float *vx, float *vy) {
    mspring_result result = check_get(network, first, count, vx, vy);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[first + i];
        vx[i] = network->state.vx[slot];
        vy[i] = network->state.vy[slot];
    }
    return result;
}

mspring_result mspring_network_get_masses(const mspring_network *network, mspring_id first, uint32_t count,
                                          float *mass) {
    mspring_result result = check_get(network, first, count, mass, mass);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i)
        mass[i] = network->mass[first + i];
    return result;
}

/* --------------------------------------------------------------------------------------------------- set ranges */

static mspring_result check_set(mspring_network *network, mspring_id first, uint32_t count, const void *a,
                                const void *b) {
    mspring_result result = mspringi_enter(network);
    if (result != MSPRING_OK)
        return result;
    if (count > 0 && (!a || !b))
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "an array of %u values is NULL",
                             (unsigned)count);
    return mspringi_check_range(network, "particle", first, count, network->topology.particle_count);
}

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

// Positions in either precision: exactly one of the two pairs of arrays is there.
typedef struct positions {
    const double *x, *y;
    const float *x_float, *y_float;
} positions;

static double x_of(const positions *p, uint32_t i) {
    // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): x is there, or x_float
    return p->x ? p->x[i] : (double)p->x_float[i];
}

static double y_of(const positions *p, uint32_t i) {
    // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): y is there, or y_float
    return p->y ? p->y[i] : (double)p->y_float[i];
}

static MSPRINGI_NOINLINE mspring_result set_positions(mspring_network *network, mspring_id first, uint32_t count,
                                                      const positions *to) {
    const bool all = count == network->topology.particle_count;
    mspringi_box box = mspringi_box_empty();
    for (uint32_t i = 0; i < count; ++i) {
        if (!mspringi_particle_exists(network, first + i))
            continue;
        mspring_result result = check_position(network, first + i, x_of(to, i), y_of(to, i), !all);
        if (result != MSPRING_OK)
            return result;
        mspringi_box_include(&box, x_of(to, i), y_of(to, i));
    }
    if (all && box.min_x <= box.max_x)
        mspringi_origin_choose(network, &box);
    for (uint32_t i = 0; i < count; ++i)
        if (mspringi_particle_exists(network, first + i))
            mspringi_set_position(network, first + i, x_of(to, i), y_of(to, i));
    mspringi_changed(network, MSPRINGI_CHANGED_STATE, 0);
    if (all)
        mspringi_changed(network, MSPRINGI_CHANGED_MOTION, 0);
    return MSPRING_OK;
}

static mspring_result set_positions_rounding_to_nearest(mspring_network *network, mspring_id first, uint32_t count,
                                                        const positions *to) {
    const mspringi_fp_state before = mspringi_fp_enter();
    mspring_result result = set_positions(network, first, count, to);
    mspringi_fp_leave(before);
    return result;
}

mspring_result mspring_network_set_positions(mspring_network *network, mspring_id first, uint32_t count,
                                             const double *x, const double *y) {
    mspring_result result = check_set(network, first, count, x, y);
    const positions to = {.x = x, .y = y};
    return result == MSPRING_OK ? set_positions_rounding_to_nearest(network, first, count, &to) : result;
}

mspring_result mspring_network_set_positions_float(mspring_network *network, mspring_id first, uint32_t count,
                                                   const float *x, const float *y) {
    mspring_result result = check_set(network, first, count, x, y);
    const positions to = {.x_float = x, .y_float = y};
    return result == MSPRING_OK ? set_positions_rounding_to_nearest(network, first, count, &to) : result;
}

static mspring_result set_velocities(mspring_network *network, const mspringi_selection *at, const float *vx,
                                     const float *vy) {
    for (uint32_t i = 0; i < at->count; ++i)
        if (!mspringi_is_speed(vx[i]) || !mspringi_is_speed(vy[i]))
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                 "particle %u: velocity (%g, %g) m/s is not within 1e15",
                                 (unsigned)mspringi_selected(at, i), (double)vx[i], (double)vy[i]);
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id particle = mspringi_selected(at, i);
        const uint32_t slot = network->topology.slot_of_particle[particle];
        if (!mspringi_particle_exists(network, particle))
            continue;
        network->state.vx[slot] = vx[i];
        network->state.vy[slot] = vy[i];
    }
    mspringi_changed(network, MSPRINGI_CHANGED_STATE, 0);
    return MSPRING_OK;
}

mspring_result mspring_network_set_velocities(mspring_network *network, mspring_id first, uint32_t count,
                                              const float *vx, const float *vy) {
    mspringi_selection at;
    mspring_result result = mspringi_select_range(network, MSPRINGI_PARTICLES, first, count, vx, vy, &at);
    return result == MSPRING_OK ? set_velocities(network, &at, vx, vy) : result;
}

/* ------------------------------------------------------------------------------------------------- set by lists */

static MSPRINGI_NOINLINE mspring_result set_positions_at(mspring_network *network, const mspring_id *particles,
                                                         uint32_t count, const double *x, const double *y) {
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i)
        result = check_position(network, particles[i], x[i], y[i], true);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i)
        mspringi_set_position(network, particles[i], x[i], y[i]);
    return result;
}

mspring_result mspring_network_set_positions_at(mspring_network *network, const mspring_id *particles,
                                                uint32_t count, const double *x, const double *y) {
    mspringi_selection at;
    mspring_result result = mspringi_select_list(network, MSPRINGI_PARTICLES, particles, count, x, y, &at);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    result = set_positions_at(network, particles, count, x, y);
    mspringi_fp_leave(before);
    if (result == MSPRING_OK)
        mspringi_changed(network, MSPRINGI_CHANGED_STATE, 0);
    return result;
}

mspring_result mspring_network_set_velocities_at(mspring_network *network, const mspring_id *particles,
                                                 uint32_t count, const float *vx, const float *vy) {
    mspringi_selection at;
    mspring_result result = mspringi_select_list(network, MSPRINGI_PARTICLES, particles, count, vx, vy, &at);
    return result == MSPRING_OK ? set_velocities(network, &at, vx, vy) : result;
}

/* ------------------------------------------------------------------------------------------------------- forces */

static MSPRINGI_NOINLINE mspring_result add_held(mspring_network *network, mspring_id first, uint32_t count,
                                                 const float *x, const float *y) {
    const mspringi_field held = network->forces.held;
    const uint32_t *slots = network->topology.slot_of_particle + first;
    for (uint32_t i = 0; i < count; ++i)
        if (!is_finite_pair(held.x[slots[i]] + x[i], held.y[slots[i]] + y[i]))
            return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                 "particle %u: force (%g, %g) N is not finite, or not with what acts already",
                                 (unsigned)(first + i), (double)x[i], (double)y[i]);
    for (uint32_t i = 0; i < count; ++i) {
        if (!mspringi_particle_exists(network, first + i))
            continue;
        held.x[slots[i]] += x[i];
        held.y[slots[i]] += y[i];
    }
    network->forces.held_any = network->forces.held_any || count > 0;
    return MSPRING_OK;
}

mspring_result mspring_network_apply_forces(mspring_network *network, mspring_id first, uint32_t count,
                                            const float *x, const float *y) {
    mspring_result result = check_set(network, first, count, x, y);
    if (result == MSPRING_OK)
        result = mspringi_field_reserve(network, &network->forces.held);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    result = add_held(network, first, count, x, y);
    mspringi_fp_leave(before);
    return result;
}

mspring_result mspring_network_apply_force(mspring_network *network, mspring_id particle, float x, float y) {
    mspringi_selection at;
    mspring_result result = mspringi_select_list(network, MSPRINGI_PARTICLES, &particle, 1, &x, &y, &at);
    return result == MSPRING_OK ? mspring_network_apply_forces(network, particle, 1, &x, &y) : result;
}

/* -------------------------------------------------------------------------------------------------------- hash */

mspring_result mspring_network_state_hash(const mspring_network *network, uint64_t *hash) {
    if (!network || !hash)
        return MSPRING_ERROR_ARGUMENT;
    const mspringi_topology *t = &network->topology;
    const mspringi_state *s = &network->state;
    uint64_t sum = MSPRINGI_MIX_START;
    sum = mspringi_mix_double(sum, network->origin_x);
    sum = mspringi_mix_double(sum, network->origin_y);
    for (mspring_id p = 0; p < t->particle_count; ++p) {
        const uint32_t slot = t->slot_of_particle[p];
        sum = mspringi_mix_floats(sum, s->x[slot], s->y[slot]);
        sum = mspringi_mix_floats(sum, s->vx[slot], s->vy[slot]);
        sum = mspringi_mix_floats(sum, mspringi_low_of(s->x[slot], s->low_x[slot]),
                                  mspringi_low_of(s->y[slot], s->low_y[slot]));
    }
    *hash = sum;
    return MSPRING_OK;
}

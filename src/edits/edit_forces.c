/// Forces for the next step, and impulses, which change velocities immediately.
///
/// Forces add up, also if a list names a particle twice. So new sums are computed in the backup, which is free
/// between steps, and copied once all of them are valid: by slot for a list; by index for a range, which names each
/// particle once. Most forces are too small to overflow a sum: those of a range are added directly.
#include <math.h>

#include "base/cpu.h"
#include "store/changed.h"
#include "store/network.h"
#include "store/selection.h"

typedef struct pushes {
    const float *x, *y;
    uint32_t stride;
} pushes;

// Sums of a call: forces, or velocities with inverse masses as factors.
typedef struct target {
    mspringi_field sum;
    const float *inverse_mass; ///< NULL: forces
} target;

static mspring_result fail(mspring_network *network, const target *to, mspring_id particle, float x, float y) {
    return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                         to->inverse_mass
                             ? "particle %u: an impulse of (%g, %g) N s is not finite, or takes it above 1e15 m/s"
                             : "particle %u: force (%g, %g) N is not finite, or not with what acts already",
                         (unsigned)particle, (double)x, (double)y);
}

static bool is_valid(const target *to, float x, float y) {
    return to->inverse_mass ? mspringi_is_speed(x) && mspringi_is_speed(y) : isfinite(x) && isfinite(y);
}

// A product of two floats is exact in double precision, so fusing it with the sum makes no difference.
static float add_scaled(float sum, float push, double factor) {
    return (float)((double)sum + (double)push * factor);
}

// Compute the sums of a range. Returns the index of the first invalid one, or the count.
static MSPRINGI_NOINLINE uint32_t sum_range(const mspring_network *network, const mspringi_selection *at,
                                            const pushes *given, const target *to) {
    const uint32_t *const slots = network->topology.slot_of_particle + at->first;
    const mspringi_field sum = to->sum;
    float *const made_x = network->backup.vx, *const made_y = network->backup.vy;
    uint32_t invalid = at->count;
    for (uint32_t i = 0; i < at->count; ++i) {
        const uint32_t slot = slots[i];
        const bool exists = mspringi_particle_exists(network, at->first + i);
        const uint32_t ahead = mspringi_slot_ahead(network, at, i);
        MSPRINGI_PREFETCH(&sum.x[ahead]);
        MSPRINGI_PREFETCH(&sum.y[ahead]);
        const double factor = !to->inverse_mass ? 1.0 : (double)to->inverse_mass[slot];
        const float x = add_scaled(sum.x[slot], given->x[(size_t)i * given->stride], factor);
        const float y = add_scaled(sum.y[slot], given->y[(size_t)i * given->stride], factor);
        made_x[i] = exists ? x : sum.x[slot];
        made_y[i] = exists ? y : sum.y[slot];
        invalid = exists && !is_valid(to, x, y) && invalid == at->count ? i : invalid;
    }
    return invalid;
}

static mspring_result add_range(mspring_network *network, const mspringi_selection *at, const pushes *given,
                                const target *to) {
    const uint32_t *const slots = network->topology.slot_of_particle + at->first;
    const float *const made_x = network->backup.vx, *const made_y = network->backup.vy;
    const mspringi_field sum = to->sum;
    const uint32_t invalid = sum_range(network, at, given, to);
    if (invalid < at->count)
        return fail(network, to, at->first + invalid, given->x[(size_t)invalid * given->stride],
                    given->y[(size_t)invalid * given->stride]);
    for (uint32_t i = 0; i < at->count; ++i) {
        sum.x[slots[i]] = made_x[i];
        sum.y[slots[i]] = made_y[i];
    }
    return MSPRING_OK;
}

static MSPRINGI_NOINLINE mspring_result add_list(mspring_network *network, const mspringi_selection *at,
                                                 const pushes *given, const target *to) {
    const mspringi_field made = {network->backup.vx, network->backup.vy};
    const uint32_t *slots = network->topology.slot_of_particle;
    for (uint32_t i = 0; i < at->count; ++i) {
        const uint32_t slot = slots[mspringi_selected(at, i)];
        made.x[slot] = to->sum.x[slot];
        made.y[slot] = to->sum.y[slot];
    }
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id particle = mspringi_selected(at, i);
        const uint32_t slot = slots[particle];
        if (!mspringi_particle_exists(network, particle))
            continue;
        const float x = given->x[(size_t)i * given->stride], y = given->y[(size_t)i * given->stride];
        const double factor = to->inverse_mass ? (double)to->inverse_mass[slot] : 1.0;
        made.x[slot] = add_scaled(made.x[slot], x, factor);
        made.y[slot] = add_scaled(made.y[slot], y, factor);
        if (!is_valid(to, made.x[slot], made.y[slot]))
            return fail(network, to, particle, x, y);
    }
    for (uint32_t i = 0; i < at->count; ++i) {
        const uint32_t slot = slots[mspringi_selected(at, i)];
        if (!mspringi_particle_exists(network, mspringi_selected(at, i)))
            continue;
        to->sum.x[slot] = made.x[slot];
        to->sum.y[slot] = made.y[slot];
    }
    return MSPRING_OK;
}

static mspring_result add_rounding_to_nearest(mspring_network *network, const mspringi_selection *at,
                                              const pushes *given, const target *to) {
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = at->list ? add_list(network, at, given, to) : add_range(network, at, given, to);
    mspringi_fp_leave(before);
    return result;
}

/* ------------------------------------------------------------------------------------------------------- forces */

static bool are_all_small(const float *forces, size_t count) {
    uint32_t others = 0;
    for (size_t i = 0; i < count; ++i)
        others |= !(fabsf(forces[i]) <= MSPRINGI_MODEST);
    return others == 0;
}

// True if all forces are too small to overflow their sums.
static bool are_small(const pushes *given, uint32_t count) {
    const float *x = given->x, *y = given->y;
    const size_t stride = given->stride;
    if (stride == 1)
        return are_all_small(x, count) && are_all_small(y, count);
    if (stride == 2 && y == x + 1)
        return are_all_small(x, 2 * (size_t)count);
    uint32_t others = 0;
    for (size_t i = 0; i < count; ++i)
        others |= !(fabsf(x[i * stride]) <= MSPRINGI_MODEST && fabsf(y[i * stride]) <= MSPRINGI_MODEST);
    return others == 0;
}

// Add small forces to a range without removed particles.
static MSPRINGI_NOINLINE void add_small(mspring_network *network, const mspringi_selection *at,
                                        const pushes *given) {
    const uint32_t *const slots = network->topology.slot_of_particle + at->first;
    const mspringi_field sum = network->forces.held;
    const size_t stride = given->stride;
    for (uint32_t i = 0; i < at->count; ++i) {
        const uint32_t slot = slots[i], ahead = mspringi_slot_ahead(network, at, i);
        MSPRINGI_PREFETCH(&sum.x[ahead]);
        MSPRINGI_PREFETCH(&sum.y[ahead]);
        sum.x[slot] += given->x[i * stride];
        sum.y[slot] += given->y[i * stride];
    }
}

static void add_small_rounding_to_nearest(mspring_network *network, const mspringi_selection *at,
                                          const pushes *given) {
    const mspringi_fp_state before = mspringi_fp_enter();
    add_small(network, at, given);
    mspringi_fp_leave(before);
}

static mspring_result apply_first_forces(mspring_network *network, const mspringi_selection *at,
                                         const pushes *given) {
    mspringi_forces *forces = &network->forces;
    mspring_result result = mspringi_field_reserve(network, &forces->first);
    if (result == MSPRING_OK)
        result = mspringi_field_reserve(network, &forces->begun);
    if (result == MSPRING_OK)
        result = add_rounding_to_nearest(network, at, given, &(target){.sum = forces->first});
    forces->first_any = forces->first_any || (result == MSPRING_OK && at->count > 0);
    return result;
}

static mspring_result apply_forces(mspring_network *network, const mspringi_selection *at, const pushes *given) {
    mspringi_forces *forces = &network->forces;
    mspring_result result = mspringi_field_reserve(network, &forces->held);
    if (result != MSPRING_OK || at->count == 0)
        return result;
    const uint32_t calls = forces->held_any ? forces->held_calls : 0;
    const bool is_small =
        !at->list && !network->growth.particles && calls < MSPRINGI_MODEST_CALLS && are_small(given, at->count);
    if (is_small)
        add_small_rounding_to_nearest(network, at, given);
    else
        result = add_rounding_to_nearest(network, at, given, &(target){.sum = forces->held});
    if (result != MSPRING_OK)
        return result;
    forces->held_any = true;
    forces->held_calls = is_small ? calls + 1 : MSPRINGI_MODEST_CALLS;
    return MSPRING_OK;
}

/* ----------------------------------------------------------------------------------------------------- impulses */

// Drop low words that do not belong to velocities which a hook or a view wrote: an impulse could hide that they
// don't.
static void drop_stale_lows(const mspring_network *network, const mspringi_selection *at) {
    const mspringi_state *s = &network->state;
    for (uint32_t i = 0; network->is_open && s->low_vx && i < at->count; ++i) {
        const uint32_t slot = network->topology.slot_of_particle[mspringi_selected(at, i)];
        s->low_vx[slot] = mspringi_low_of(s->vx[slot], s->low_vx[slot], 0.0f);
        s->low_vy[slot] = mspringi_low_of(s->vy[slot], s->low_vy[slot], 0.0f);
    }
}

static mspring_result apply_impulses(mspring_network *network, const mspringi_selection *at, const pushes *given) {
    drop_stale_lows(network, at);
    const target velocities = {{network->state.vx, network->state.vy}, network->inverse_mass};
    const mspring_result result = add_rounding_to_nearest(network, at, given, &velocities);
    if (result == MSPRING_OK)
        mspringi_notify_change(network, MSPRINGI_CHANGED_STATE, 0);
    return result;
}

/* -------------------------------------------------------------------------------------------------------- calls */

mspring_result mspring_network_apply_force(mspring_network *network, mspring_id particle, float x, float y) {
    mspringi_selection at;
    const mspring_result result = mspringi_select_one(network, MSPRING_PARTICLES, &particle, &at);
    return result == MSPRING_OK ? apply_forces(network, &at, &(pushes){&x, &y, 1}) : result;
}

mspring_result mspring_network_apply_forces(mspring_network *network, mspring_push push, const mspring_id *ids,
                                            mspring_id first, uint32_t count, const float *x, const float *y,
                                            uint32_t stride) {
    mspringi_selection at;
    mspring_result result = mspringi_select_for(network, MSPRING_PARTICLES, ids, first, count, x, y, stride, &at);
    if (result == MSPRING_OK && push != MSPRING_PUSH_STEP && push != MSPRING_PUSH_SUBSTEP &&
        push != MSPRING_PUSH_IMPULSE)
        result =
            mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "push is %d, which is unknown", (int)push);
    if (result != MSPRING_OK)
        return result;
    const pushes given = {x, y, stride};
    return push == MSPRING_PUSH_STEP      ? apply_forces(network, &at, &given)
           : push == MSPRING_PUSH_SUBSTEP ? apply_first_forces(network, &at, &given)
                                          : apply_impulses(network, &at, &given);
}

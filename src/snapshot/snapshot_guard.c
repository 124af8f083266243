/// Snapshot of the guard's state between steps.
#include <float.h>
#include <math.h>

#include "solvers/implicit/cells.h"
#include "stability/guard.h"
#include "stability/stability_limit.h"
#include "store/sections.h"

typedef struct record {
    double dt; ///< longest substep that is stable in any shape, s; its spring is below
    float h, global_damping, peak;
    uint32_t policy, reserved, spring, state, fallback_steps;
    mspringi_solver_basis fallback; ///< MSPRING_GUARD_IMPLICIT
} record;

/// State of dt: unknown, from before the last edit of values or masses, up to date, or from before the last
/// addition.
enum { UNKNOWN, OUTDATED, KNOWN, OUTGROWN };

static void hand(mspringi_io *io, record *r) {
    MSPRINGI_HAND(io, r->dt);
    mspringi_hand(io, &r->h, 3, sizeof(float)); // and the next two
    mspringi_hand(io, &r->policy, 5, sizeof(uint32_t));
    if (r->policy != MSPRING_GUARD_IMPLICIT)
        return;
    MSPRINGI_HAND(io, r->fallback.scale);
    MSPRINGI_HAND(io, r->fallback.turn_inertia);
    MSPRINGI_HAND(io, r->fallback.tile_size);
}

static void guard_save(const mspring_network *network, mspringi_writer *to) {
    const mspringi_guard *guard = &network->guard;
    const mspringi_any_shape *known = &network->any_shape;
    const bool outdated = known->masses != network->edits.masses || known->values != network->edits.values;
    const bool is_of_now = known->is_known && !outdated && known->growth == network->edits.growth;
    mspringi_io io = mspringi_io_to(to);
    record r = {.dt = is_of_now ? known->dt : 0.0,
                .h = guard->h,
                .global_damping = guard->global_damping,
                .peak = guard->peak,
                .policy = (uint32_t)network->settings.guard,
                .spring = is_of_now ? known->spring : MSPRING_NONE,
                .state = !known->is_known ? UNKNOWN
                         : outdated       ? OUTDATED
                         : is_of_now      ? KNOWN
                                          : OUTGROWN,
                .fallback_steps = guard->fallback_steps};
    if (network->settings.guard == MSPRING_GUARD_IMPLICIT)
        r.fallback = mspringi_solver_get_basis(&network->fallback);
    hand(&io, &r);
}

// Make sure of a fallback with these tiles. One in use is not changed.
static mspring_result check_fallback(mspring_network *network, const mspringi_solver_basis *basis) {
    const uint32_t size = basis->tile_size, here = mspringi_solver_get_basis(&network->fallback).tile_size;
    if (!(basis->scale >= DBL_MIN && basis->scale <= DBL_MAX && basis->turn_inertia >= 0.0f &&
          basis->turn_inertia <= FLT_MAX) ||
        size < MSPRINGI_LEAST_TILE_SIZE || size > MSPRINGI_LARGEST_TILE_SIZE || (size & (size - 1)) != 0 ||
        (here > 0 && network->settings.guard == MSPRING_GUARD_IMPLICIT && here != size))
        return mspringi_section_fail(
            network, &mspringi_section_guard,
            "the implicit solver that takes steps has tiles of size %u, scale %g and inertia %g m^2",
            (unsigned)size, basis->scale, (double)basis->turn_inertia);
    if (here > 0 && here != size)
        mspringi_solver_destroy(&network->fallback, &network->memory);
    return mspringi_fallback_reserve(network, size);
}

static mspring_result guard_check(mspring_network *network, const uint8_t *from, size_t size) {
    const mspringi_section *section = &mspringi_section_guard;
    mspringi_io io = mspringi_io_from(from, size);
    record head;
    hand(&io, &head);
    mspring_result result = mspringi_section_end(network, section, &io);
    if (result != MSPRING_OK)
        return result;
    if (!(head.h >= 0.0f && head.h <= FLT_MAX && head.global_damping >= 0.0f && head.global_damping <= 1e6f &&
          head.peak >= 0.0f && head.peak <= FLT_MAX && head.dt >= 0.0) ||
        head.policy > MSPRING_GUARD_CLAMP_BOUNDS || head.state > OUTGROWN ||
        head.fallback_steps > MSPRINGI_FALLBACK_STEPS)
        return mspringi_section_fail(network, section, "for substeps of %g s, with a peak of %g m/s and policy %u",
                                     (double)head.h, (double)head.peak, (unsigned)head.policy);
    if (head.reserved != 0)
        return mspringi_section_fail(network, section, "bits that have no meaning are %#x",
                                     (unsigned)head.reserved);
    if (mspringi_guard_checks_limit((mspring_guard)head.policy))
        result = mspringi_stability_limit_reserve(network);
    return result == MSPRING_OK && head.policy == MSPRING_GUARD_IMPLICIT ? check_fallback(network, &head.fallback)
                                                                         : result;
}

static void guard_load(mspring_network *network, const uint8_t *from, size_t size) {
    mspringi_io io = mspringi_io_from(from, size);
    record head;
    hand(&io, &head);
    network->settings.guard = (mspring_guard)head.policy;
    network->guard = (mspringi_guard){.h = head.h,
                                      .global_damping = head.global_damping,
                                      .peak = head.peak,
                                      .speed = INFINITY, // unknown
                                      .coordinate = INFINITY,
                                      .fallback_steps = head.fallback_steps};
    if (head.policy == MSPRING_GUARD_IMPLICIT)
        network->fallback.ops->set_basis(network->fallback.object, network, &head.fallback);
    // the counters of edits differ between runs
    mspringi_any_shape *any_shape = &network->any_shape;
    *any_shape = (mspringi_any_shape){
        .masses = network->edits.masses, .values = network->edits.values - 1, .growth = network->edits.growth};
    if (head.state == UNKNOWN)
        return;
    any_shape->is_known = true;
    any_shape->dt = head.dt;
    any_shape->spring = head.spring;
    any_shape->values += head.state != OUTDATED;
    any_shape->growth -= head.state == OUTGROWN;
}

static mspring_result guard_check_against(mspring_network *network, const mspringi_saved *saved,
                                          const uint8_t *from, size_t size) {
    mspringi_io io = mspringi_io_from(from, size);
    record r;
    hand(&io, &r);
    return r.spring == MSPRING_NONE ||
                   (r.spring < network->topology.reserve.spring_end && mspringi_saved_has_spring(saved, r.spring))
               ? MSPRING_OK
               : mspringi_section_fail(network, &mspringi_section_guard,
                                       "the tightest spring is %u, which is not there", (unsigned)r.spring);
}

const mspringi_section mspringi_section_guard = {
    "guar", "guard of the stability limit", false, NULL, guard_save, guard_check, guard_load, guard_check_against};

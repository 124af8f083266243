/// What the guard of the stability border knows from step to step, in a snapshot.
#include <float.h>
#include <math.h>

#include "solvers/implicit/cells.h"
#include "stability/border.h"
#include "stability/guard.h"
#include "store/sections.h"

typedef struct guard_head {
    double dt; ///< what is stable in any shape, s, and for which spring
    float h, global_damping, peak;
    uint32_t policy, reserved, spring, state, fallback_steps;
} guard_head;
#define HEAD_BYTES ((size_t)40)

// Of a mspringi_solver_basis.
#define FALLBACK_BYTES ((size_t)16)

/// Whether dt is known, and whether that was before the last edit.
enum { UNKNOWN, OUTDATED, KNOWN };

static size_t guard_size(const mspring_network *network) {
    return HEAD_BYTES + (network->settings.guard == MSPRING_GUARD_IMPLICIT ? FALLBACK_BYTES : 0);
}

static void fallback_save(const mspringi_solver *fallback, mspringi_writer *to) {
    const mspringi_solver_basis basis = mspringi_solver_get_basis(fallback);
    mspringi_put(to, &basis.scale, 1, sizeof basis.scale);
    mspringi_put(to, &basis.turn_inertia, 1, sizeof basis.turn_inertia);
    mspringi_put(to, &basis.tile_size, 1, sizeof basis.tile_size);
}

static void guard_save(const mspring_network *network, mspringi_writer *to) {
    const mspringi_guard *guard = &network->guard;
    const mspringi_any_shape *any_shape = &network->any_shape;
    const bool outdated = any_shape->masses != network->edits.masses ||
                          any_shape->values != network->edits.values || any_shape->growth != network->edits.growth;
    const float floats[] = {guard->h, guard->global_damping, guard->peak};
    const uint32_t words[] = {(uint32_t)network->settings.guard, 0, any_shape->spring,
                              !any_shape->is_known ? UNKNOWN
                              : outdated           ? OUTDATED
                                                   : KNOWN,
                              guard->fallback_steps};
    mspringi_put(to, &any_shape->dt, 1, sizeof any_shape->dt);
    mspringi_put(to, floats, sizeof floats / sizeof floats[0], sizeof floats[0]);
    mspringi_put(to, words, sizeof words / sizeof words[0], sizeof words[0]);
    if (network->settings.guard == MSPRING_GUARD_IMPLICIT)
        fallback_save(&network->fallback, to);
}

static const uint8_t *read_head(const uint8_t *from, guard_head *head) {
    from = mspringi_get(from, &head->dt, 1, sizeof head->dt);
    from = mspringi_get(from, &head->h, 1, sizeof head->h);
    from = mspringi_get(from, &head->global_damping, 1, sizeof head->global_damping);
    from = mspringi_get(from, &head->peak, 1, sizeof head->peak);
    from = mspringi_get(from, &head->policy, 1, sizeof head->policy);
    from = mspringi_get(from, &head->reserved, 1, sizeof head->reserved);
    from = mspringi_get(from, &head->spring, 1, sizeof head->spring);
    from = mspringi_get(from, &head->state, 1, sizeof head->state);
    return mspringi_get(from, &head->fallback_steps, 1, sizeof head->fallback_steps);
}

static mspringi_solver_basis read_fallback(const uint8_t *from) {
    mspringi_solver_basis basis;
    from = mspringi_get(from, &basis.scale, 1, sizeof basis.scale);
    from = mspringi_get(from, &basis.turn_inertia, 1, sizeof basis.turn_inertia);
    (void)mspringi_get(from, &basis.tile_size, 1, sizeof basis.tile_size);
    return basis;
}

// See that there is a fallback with such tiles. One that is in use is not touched.
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
    guard_head head = {0};
    if (size < HEAD_BYTES)
        return mspringi_section_check_size(network, section, size, HEAD_BYTES);
    from = read_head(from, &head);
    const bool falls_back = head.policy == MSPRING_GUARD_IMPLICIT;
    mspring_result result =
        mspringi_section_check_size(network, section, size, HEAD_BYTES + (falls_back ? FALLBACK_BYTES : 0));
    if (result != MSPRING_OK)
        return result;
    if (!(head.h >= 0.0f && head.h <= FLT_MAX && head.global_damping >= 0.0f && head.global_damping <= 1e6f &&
          head.peak >= 0.0f && head.peak <= FLT_MAX && head.dt >= 0.0) ||
        head.policy > MSPRING_GUARD_CLAMP_BOUNDS || head.state > KNOWN)
        return mspringi_section_fail(network, section, "for substeps of %g s, with a peak of %g m/s and policy %u",
                                     (double)head.h, (double)head.peak, (unsigned)head.policy);
    if (head.reserved != 0)
        return mspringi_section_fail(network, section, "bits that have no meaning are %#x",
                                     (unsigned)head.reserved);
    mspringi_solver_basis fallback = {0};
    if (falls_back)
        fallback = read_fallback(from);
    if (mspringi_guard_looks((mspring_guard)head.policy))
        result = mspringi_border_reserve(network);
    return result == MSPRING_OK && falls_back ? check_fallback(network, &fallback) : result;
}

static void fallback_load(mspring_network *network, const uint8_t *from) {
    const mspringi_solver_basis basis = read_fallback(from);
    network->fallback.ops->set_basis(network->fallback.object, network, &basis);
}

static void guard_load(mspring_network *network, const uint8_t *from, size_t size) {
    guard_head head;
    (void)size;
    from = read_head(from, &head);
    network->settings.guard = (mspring_guard)head.policy;
    network->guard = (mspringi_guard){.h = head.h,
                                      .global_damping = head.global_damping,
                                      .peak = head.peak,
                                      .speed = INFINITY, // are not known
                                      .place = INFINITY,
                                      .fallback_steps = head.fallback_steps};
    if (head.policy == MSPRING_GUARD_IMPLICIT)
        fallback_load(network, from);
    // Edits of before and after are counted differently.
    mspringi_any_shape *any_shape = &network->any_shape;
    *any_shape = (mspringi_any_shape){
        .masses = network->edits.masses, .values = network->edits.values - 1, .growth = network->edits.growth};
    const bool has_spring = head.spring < network->topology.reserve.spring_end;
    if (head.state == UNKNOWN || (!has_spring && head.spring != MSPRING_NONE))
        return;
    any_shape->is_known = true;
    any_shape->dt = head.dt;
    any_shape->spring = head.spring;
    any_shape->values += head.state == KNOWN;
}

const mspringi_section mspringi_section_guard = {
    "guar", "guard of the stability border", false, guard_size, guard_save, guard_check, guard_load};

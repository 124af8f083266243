/// Which blocks lie below the height of a hook.
#include "features/hooks/reach.h"

#include <float.h>
#include <math.h>

#include "features/contact/floor.h"
#include "stability/guard.h"

/// What rounding may do to a local height, as a part of it and of what it is the difference of.
#define ROUNDING 0x1p-21
#define WORLD_ROUNDING 0x1p-50

// In local coordinates, with room for rounding.
static double local_height(const mspring_network *network, const mspring_hook_def *def) {
    const double local = def->below_y - network->origin_y;
    return local + ROUNDING * fabs(local) + WORLD_ROUNDING * (fabs(def->below_y) + fabs(network->origin_y));
}

bool mspringi_next_below(const mspring_network *network, const mspring_hook_def *def, uint32_t at, uint32_t end,
                         mspringi_slot_run *run) {
    const mspringi_state *s = &network->state;
    const mspringi_beyond_fn beyond = network->kernels->beyond;
    const double height = fmax(-(double)FLT_MAX, fmin(local_height(network, def), (double)FLT_MAX));
    const mspringi_bounds above = {-FLT_MAX, FLT_MAX, (float)height, FLT_MAX};
    run->first = run->end = (uint32_t)beyond(s->x, s->y, at, end, &above);
    while (run->end < end && beyond(s->x, s->y, run->end, run->end + MSPRINGI_WIDTH, &above) == run->end)
        run->end += MSPRINGI_WIDTH;
    return run->first < end;
}

bool mspringi_hook_is_away(const mspring_network *network, mspringi_hook *hook, double seconds) {
    if (!mspringi_has_reach(&hook->def))
        return false;
    if (hook->distance == MSPRINGI_UNKNOWN) {
        const mspringi_floor height = {.lines = {{.ny = 1.0, .offset = -local_height(network, &hook->def)}},
                                       .plane_count = 1};
        const bool is_away = mspringi_safe_box_suffices(network, &height, &hook->safe, seconds);
        hook->distance = is_away ? MSPRINGI_AWAY : MSPRINGI_CLOSE;
    }
    return hook->distance == MSPRINGI_AWAY;
}

bool mspringi_hook_must_repeat(const mspring_network *network, const mspringi_hook *hook,
                               const mspringi_attempt *attempt) {
    if (hook->distance != MSPRINGI_AWAY)
        return false;
    const mspringi_extrema seen = mspringi_guard_bound(network, attempt->h, network->seen);
    return !mspringi_safe_box_sufficed(network, &hook->safe, attempt->dt * (double)seen.speed, seen);
}

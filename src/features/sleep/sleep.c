/// Falling asleep and waking.
///
/// Islands are compared with a copy of their state at the time they fell asleep. Views and hooks write without
/// notice, and a game sets masses and forces in every frame, mostly to the values of the frame before. Edits of
/// springs notify.
#include "features/sleep/sleep.h"

#include <math.h>
#include <string.h>

#include "base/assert.h"
#include "features/hooks/hooks.h"
#include "features/ramps/ramps.h"
#include "store/changed.h"
#include "store/feature.h"
#include "store/id_pool.h"
#include "store/selection.h"
#include "store/stages.h"

/* ------------------------------------------------------------------------------------------------------ state */

static bool state_differs(const mspring_network *network, size_t slot) {
    const size_t slots = mspringi_slot_count(network);
    const float *now = network->state.x + slot, *kept = network->sleep.state + slot;
    for (size_t i = 0; i < mspringi_state_arrays(network); ++i)
        if (memcmp(now + i * slots, kept + i * slots, sizeof *now) != 0)
            return true;
    return false;
}

static bool mass_differs(const mspring_network *network, size_t slot) {
    return network->inverse_mass[slot] != network->sleep.inverse_mass[slot];
}

// True if the state or the masses of a block differ from the copy, asleep or not.
static bool block_differs(const mspring_network *network, size_t block, bool state, bool masses) {
    const size_t slots = mspringi_slot_count(network), first = block * MSPRINGI_WIDTH;
    const mspringi_sleep *s = &network->sleep;
    const size_t size = MSPRINGI_WIDTH * sizeof *s->state;
    bool differs = masses && memcmp(network->inverse_mass + first, s->inverse_mass + first, size) != 0;
    for (size_t i = 0; state && i < mspringi_state_arrays(network); ++i)
        differs |= memcmp(network->state.x + i * slots + first, s->state + i * slots + first, size) != 0;
    return differs;
}

// True if positions, velocities or masses may have changed since the last check.
static bool may_have_moved(const mspring_network *network) {
    return network->is_open || network->sleep.moved != network->edits.state;
}

// First disturbed sleeping slot from `slot` on; the number of slots if there is none.
static size_t next_disturbed(const mspring_network *network, size_t slot, bool state, bool masses) {
    const mspringi_sleep *s = &network->sleep;
    const size_t slots = mspringi_slot_count(network);
    while (slot < slots) {
        const size_t block = slot / MSPRINGI_WIDTH, end = (block + 1) * MSPRINGI_WIDTH;
        if (s->sleepers[block] != 0 && block_differs(network, block, state, masses))
            for (; slot < end; ++slot)
                if (s->sleepers[block] >> slot % MSPRINGI_WIDTH & 1 &&
                    ((state && state_differs(network, slot)) || (masses && mass_differs(network, slot))))
                    return slot;
        slot = end;
    }
    return slots;
}

size_t mspringi_next_disturbed_sleeper(const mspring_network *network, size_t slot) {
    const mspringi_sleep *s = &network->sleep;
    const size_t slots = mspringi_slot_count(network);
    if (s->sleeping == 0)
        return slots;
    const bool state = may_have_moved(network), masses = s->masses != network->edits.masses;
    const bool all = network->origin_x != s->origin_x || network->origin_y != s->origin_y;
    if (!all)
        return state || masses ? next_disturbed(network, slot, state, masses) : slots;
    while (slot < slots && !(s->sleepers[slot / MSPRINGI_WIDTH] >> slot % MSPRINGI_WIDTH & 1))
        ++slot;
    return slot;
}

/* -------------------------------------------------------------------------------------------------- waking */

static void save_rest_times(mspringi_sleep *s) {
    if (!s->has_kept)
        memcpy(s->kept, s->still, s->count * sizeof *s->kept);
    s->has_kept = true;
}

// The time at rest of a woken island restarts at 0.
static bool set_one_awake(mspring_network *network, uint32_t island) {
    mspringi_sleep *s = &network->sleep;
    const bool slept = s->still[island] < 0.0;
    s->still[island] = 0.0;
    MSPRINGI_ASSERT(island < s->count && (!slept || s->sleeping > 0));
    if (slept) {
        s->sleeping--;
        s->is_mapped = false;
        mspringi_notify_change(network, MSPRINGI_CHANGED_NAPS, 0);
    }
    return slept;
}

// All of its pile wakes, too. What sleeps has a past: it has been at rest.
static void set_awake(mspring_network *network, uint32_t island) {
    mspringi_sleep *s = &network->sleep;
    const uint32_t first = s->lowest[island];
    if (!set_one_awake(network, island))
        return;
    for (uint32_t slot = s->beside[first]; slot != first; slot = s->beside[slot])
        (void)set_one_awake(network, s->island[slot]);
}

static void set_all_awake(mspring_network *network) {
    for (uint32_t i = 0; i < network->sleep.count; ++i)
        set_awake(network, i);
}

static void wake_all(mspring_network *network) {
    network->sleep.has_kept = network->sleep.has_force = false;
    set_all_awake(network);
}

// Without effect in networks that never sleep.
static void wake_slot(mspring_network *network, uint32_t slot) {
    const mspringi_sleep *s = &network->sleep;
    if (s->count > 0 && s->island[slot] != MSPRING_NONE)
        set_awake(network, s->island[slot]);
}

static void wake_spring(mspring_network *network, mspring_id spring) {
    const mspringi_topology *t = &network->topology;
    uint32_t base, tip;
    if (network->sleep.count == 0)
        return;
    mspringi_topology_ends(t, mspringi_slot_of_spring(t, spring), &base, &tip);
    wake_slot(network, base);
    wake_slot(network, tip);
}

static void finish_waking(mspring_network *network) {
    mspringi_sleep *s = &network->sleep;
    if (s->sleeping > 0 && !s->is_mapped)
        mspringi_islands_map(network);
    else if (s->sleeping > 0 && s->masses != network->edits.masses)
        mspringi_islands_update_masses(network);
}

static void wake(mspring_network *network, uint32_t island) {
    save_rest_times(&network->sleep);
    set_awake(network, island);
}

static void wake_disturbed(mspring_network *network, bool state, bool masses) {
    mspringi_sleep *s = &network->sleep;
    const size_t slots = mspringi_slot_count(network);
    for (size_t slot = 0; (slot = next_disturbed(network, slot, state, masses)) < slots;) {
        const size_t block = slot / MSPRINGI_WIDTH;
        wake(network, s->island[slot]);
        slot = s->block_island[block] != MSPRING_NONE ? (block + 1) * MSPRINGI_WIDTH : slot + 1;
    }
}

static void begin(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_sleep *s = &network->sleep;
    // Relative springs change with the substep, and an automatic number of substeps may change.
    const bool same_h = !network->fractions.values || attempt->h == network->relative_h;
    if (!same_h || network->origin_x != s->origin_x || network->origin_y != s->origin_y) {
        save_rest_times(s);
        set_all_awake(network);
        return;
    }
    const bool state = may_have_moved(network), masses = s->masses != network->edits.masses;
    if (!s->is_mapped)
        mspringi_islands_map(network);
    if (state || masses)
        wake_disturbed(network, state, masses);
    if (!network->is_open && !s->has_kept)
        s->moved = network->edits.state;
    finish_waking(network);
}

// Lanes to wake: the change of force would bring a particle to the sleep speed within the sleep time.
static uint32_t find_forced_lanes(const mspring_network *network, mspringi_field force, size_t first) {
    const mspringi_sleep *s = &network->sleep;
    const float speed = network->settings.sleep_speed, time = network->settings.sleep_time;
    static const float none[MSPRINGI_WIDTH];
    const float *x = force.x ? force.x + first : none, *y = force.x ? force.y + first : none;
    uint32_t is_disturbed[MSPRINGI_WIDTH], bits = 0;
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
        const float dx = fabsf(x[lane] - s->force.x[first + lane]), dy = fabsf(y[lane] - s->force.y[first + lane]);
        const float inverse_mass = s->inverse_mass[first + lane];
        is_disturbed[lane] =
            (uint32_t) !(dx * inverse_mass * time <= speed) | (uint32_t) !(dy * inverse_mass * time <= speed);
    }
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
        bits |= is_disturbed[lane] << lane;
    return bits & s->sleepers[first / MSPRINGI_WIDTH];
}

// Wake particles if their external force has changed since they fell asleep.
static void wake_by_forces(mspring_network *network, mspringi_field force) {
    mspringi_sleep *s = &network->sleep;
    if (s->sleeping == 0 || (!force.x && !s->has_force))
        return;
    for (size_t block = 0; block < network->topology.block_count; ++block) {
        if (s->sleepers[block] == 0)
            continue;
        const size_t first = block * MSPRINGI_WIDTH;
        for (uint32_t bits = find_forced_lanes(network, force, first), lane = 0; bits >> lane != 0; ++lane) {
            if (!(bits >> lane & 1))
                continue;
            wake(network, s->island[first + lane]);
        }
    }
    finish_waking(network);
}

/* ------------------------------------------------------------------------------------------------------ step */

// True if the solver may move a sleeping block. Some solvers skip blocks that are not swept; others work on larger
// units.
static bool is_held(const mspring_network *network, size_t block) {
    const mspringi_sleep *s = &network->sleep;
    return s->sleepers[block] != 0 && (s->swept[block] || !network->running->ops->skips_sleepers);
}

static void hold(const mspring_network *network) {
    const mspringi_sleep *s = &network->sleep;
    const size_t slots = mspringi_slot_count(network), size = MSPRINGI_WIDTH * sizeof *s->held;
    for (size_t block = 0; block < network->topology.block_count; ++block) {
        const size_t first = block * MSPRINGI_WIDTH;
        if (!is_held(network, block))
            continue;
        memcpy(s->held + first, network->state.x + first, size);
        memcpy(s->held + slots + first, network->state.y + first, size);
        memcpy(s->held + 2 * slots + first, network->state.low_x + first, size);
        memcpy(s->held + 3 * slots + first, network->state.low_y + first, size);
    }
}

static void put_back(const mspring_network *network) {
    const mspringi_sleep *s = &network->sleep;
    const size_t slots = mspringi_slot_count(network);
    for (size_t block = 0; block < network->topology.block_count; ++block) {
        for (size_t lane = 0; is_held(network, block) && lane < MSPRINGI_WIDTH; ++lane) {
            const size_t slot = block * MSPRINGI_WIDTH + lane;
            if (!(s->sleepers[block] >> lane & 1))
                continue;
            network->state.x[slot] = s->held[slot];
            network->state.y[slot] = s->held[slots + slot];
            network->state.low_x[slot] = s->held[2 * slots + slot];
            network->state.low_y[slot] = s->held[3 * slots + slot];
        }
    }
}

// Wake islands that hooks have moved.
static void update_sleep(mspring_network *network, double dt) {
    (void)dt;
    if (network->sleep.sleeping == 0 || mspringi_hook_count(network) == 0)
        return;
    wake_disturbed(network, true, false);
    finish_waking(network);
}

static void restore(mspring_network *network) {
    const mspringi_sleep *s = &network->sleep;
    const size_t slots = mspringi_slot_count(network);
    for (size_t slot = 0; s->sleeping > 0 && slot < slots; ++slot)
        for (size_t i = 0; i < mspringi_state_arrays(network) && mspringi_slot_is_asleep(network, slot); ++i)
            network->state.x[i * slots + slot] = s->state[i * slots + slot];
}

static void undo(mspring_network *network) {
    mspringi_sleep *s = &network->sleep;
    memcpy(s->still, s->kept, s->count * sizeof *s->still);
    s->has_kept = false;
    s->sleeping = 0;
    for (uint32_t i = 0; i < s->count; ++i)
        s->sleeping += s->still[i] < 0.0;
    mspringi_notify_change(network, MSPRINGI_CHANGED_NAPS, 0);
    if (s->sleeping == 0)
        return;
    mspringi_islands_map(network);
    s->masses = network->edits.masses - 1; // islands woken by a changed mass still have that mass
}

/* ------------------------------------------------------------------------------------------- falling asleep */

// Slots of a block that are faster than the sleep speed, or pinned and moving.
static uint32_t find_moving_lanes(const mspring_network *network, size_t first) {
    const mspringi_state *state = &network->state;
    const float speed = network->settings.sleep_speed;
    uint32_t is_moving[MSPRINGI_WIDTH], bits = 0;
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
        const float vx = state->vx[first + lane], vy = state->vy[first + lane];
        const uint32_t is_fast = (uint32_t) !(fabsf(vx) <= speed) | (uint32_t) !(fabsf(vy) <= speed);
        const uint32_t is_driven = (uint32_t) !(network->inverse_mass[first + lane] > 0.0f) &
                                   ((uint32_t)(vx != 0.0f) | (uint32_t)(vy != 0.0f));
        is_moving[lane] = is_fast | is_driven;
    }
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
        bits |= is_moving[lane] << lane;
    return bits;
}

// Mark islands that are not at rest.
static void mark_moving(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const mspringi_sleep *s = &network->sleep;
    memset(s->mark, 0, s->count * sizeof *s->mark);
    for (uint32_t block = 0; block < t->block_count; ++block) {
        const uint32_t one = s->block_island[block], first = block * MSPRINGI_WIDTH;
        if ((s->sleeping > 0 && !s->swept[block]) || (one != MSPRING_NONE && s->mark[one]))
            continue;
        const uint32_t bits = find_moving_lanes(network, first);
        for (uint32_t lane = 0; bits >> lane != 0; ++lane)
            if (bits >> lane & 1 && s->island[first + lane] != MSPRING_NONE)
                s->mark[s->island[first + lane]] = 1;
    }
    for (size_t i = 0; i < mspringi_ramp_count(network); ++i) {
        uint32_t base, tip;
        mspringi_topology_ends(t, mspringi_slot_of_spring(t, network->ramps->list[i].spring), &base, &tip);
        s->mark[s->island[base]] = 1;
    }
}

// Advance the time at rest by dt, and mark the islands that are due to sleep. True if there are any.
static bool mark_sleepy(const mspring_network *network, double dt) {
    const mspringi_sleep *s = &network->sleep;
    bool any = false;
    for (uint32_t i = 0; i < s->count; ++i) {
        if (s->still[i] >= 0.0)
            s->still[i] = s->mark[i] ? 0.0 : s->still[i] + dt;
        s->mark[i] = s->still[i] > 0.0 && s->still[i] >= (double)network->settings.sleep_time;
        any |= s->mark[i];
    }
    return any;
}

static void put_to_sleep(mspring_network *network, size_t slot, mspringi_field force) {
    const mspringi_state *state = &network->state;
    const mspringi_sleep *s = &network->sleep;
    const size_t slots = mspringi_slot_count(network);
    // A block that is swept for its other slots adds 0 to the position and its low word, which would make -0 +0.
    state->low_x[slot] = mspringi_low_of(state->x[slot], state->low_x[slot], state->grid);
    state->low_y[slot] = mspringi_low_of(state->y[slot], state->low_y[slot], state->grid);
    mspringi_move_by(state, slot, 0.0f, 0.0f);
    mspringi_set_velocity(state, slot, 0.0f, 0.0f);
    for (size_t i = 0; i < mspringi_state_arrays(network); ++i)
        s->state[i * slots + slot] = state->x[i * slots + slot];
    s->inverse_mass[slot] = network->inverse_mass[slot];
    s->force.x[slot] = force.x && isfinite(force.x[slot]) ? force.x[slot] : 0.0f; // a hook's may be no number
    s->force.y[slot] = force.x && isfinite(force.y[slot]) ? force.y[slot] : 0.0f;
    if (network->solver.ops->rest_slot)
        network->solver.ops->rest_slot(network, network->solver.object, slot);
}

void mspringi_sleep_fall(mspring_network *network, mspringi_field force) {
    mspringi_sleep *s = &network->sleep;
    const bool is_first = s->sleeping == 0;
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot)
        if (s->island[slot] != MSPRING_NONE && s->mark[s->island[slot]])
            put_to_sleep(network, slot, force);
    for (uint32_t i = 0; i < s->count; ++i) {
        if (!s->mark[i])
            continue;
        s->still[i] = -1.0;
        s->beside[s->lowest[i]] = s->lowest[i];
        s->sleeping++;
        mspringi_notify_change(network, MSPRINGI_CHANGED_NAPS, 0);
    }
    s->has_force = (!is_first && s->has_force) || force.x;
    s->origin_x = network->origin_x;
    s->origin_y = network->origin_y;
    if (is_first)
        s->moved = network->edits.state;
    mspringi_islands_map(network);
}

// The local origin has moved, exactly. Move the copy with it.
static void follow_origin(mspring_network *network) {
    mspringi_sleep *s = &network->sleep;
    if (s->sleeping == 0 || (s->origin_x == network->origin_x && s->origin_y == network->origin_y))
        return;
    const size_t size = 2 * mspringi_slot_count(network) * sizeof *s->state;
    memcpy(s->state, network->state.x, size);
    memcpy(s->state + (size_t)(network->state.low_x - network->state.x), network->state.low_x, size);
    s->origin_x = network->origin_x;
    s->origin_y = network->origin_y;
}

static void fall_asleep(mspring_network *network, double dt) {
    if (!(network->settings.sleep_speed > 0.0f))
        return;
    follow_origin(network);
    if (mspringi_sleep_is_whole(network))
        return;
    mspringi_islands_find(network);
    mark_moving(network);
    if (!mark_sleepy(network, dt))
        return;
    mspringi_sleep_fall(network, network->forces.known);
    if (mspringi_sleep_is_whole(network))
        mspringi_notify_change(network, MSPRINGI_CHANGED_MOTION, 0);
}

static bool is_used(const mspring_network *network) {
    return network->sleep.state != NULL;
}

const mspringi_stage mspringi_stage_waking = {
    .is_used = is_used, .forces_known = wake_by_forces, .after_step = update_sleep};

// After all stages that change the state.
const mspringi_stage mspringi_stage_falling_asleep = {.is_used = is_used, .after_step = fall_asleep};

/* ---------------------------------------------------------------------------------------------------- relayout */

// The lowest slot of the island of a particle of another network.
static uint32_t lowest_of(const mspring_network *to, mspring_id particle) {
    return to->sleep.lowest[to->sleep.island[to->topology.slot_of_particle[particle]]];
}

static void move_piles(mspring_network *to, const mspring_network *from) {
    const mspringi_sleep *had = &from->sleep;
    const mspring_id *of_slot = from->topology.particle_of_slot;
    for (uint32_t i = 0; i < had->count; ++i) {
        const uint32_t slot = had->lowest[i];
        if (had->still[i] < 0.0)
            to->sleep.beside[lowest_of(to, of_slot[slot])] = lowest_of(to, of_slot[had->beside[slot]]);
    }
    to->sleep.piled = to->edits.sleep_changes - (had->piled != from->edits.sleep_changes);
}

static void move(mspring_network *to, const mspring_network *from) {
    mspringi_sleep *s = &to->sleep;
    const mspringi_sleep *had = &from->sleep;
    mspringi_islands_find(to);
    for (uint32_t i = 0; i < s->count; ++i)
        s->still[i] = INFINITY;
    const size_t slots = mspringi_slot_count(to), had_slots = mspringi_slot_count(from);
    for (mspring_id p = 0; p < to->topology.particle_count; ++p) {
        const uint32_t slot = to->topology.slot_of_particle[p], before = from->topology.slot_of_particle[p];
        if (!mspringi_particle_exists(from, p))
            continue;
        const double still = had->still[had->island[before]];
        double *now = &s->still[s->island[slot]];
        *now = still >= 0.0 && still < *now ? still : *now;
        for (size_t i = 0; i < mspringi_state_arrays(to); ++i)
            s->state[i * slots + slot] = had->state[i * had_slots + before];
        s->inverse_mass[slot] = had->inverse_mass[before];
        s->force.x[slot] = had->force.x[before];
        s->force.y[slot] = had->force.y[before];
    }
    for (uint32_t i = 0; i < s->count; ++i) {
        if (s->still[i] == INFINITY)
            s->still[i] = -1.0;
        s->sleeping += s->still[i] < 0.0;
    }
    move_piles(to, from);
    s->has_force = had->has_force;
    s->origin_x = had->origin_x;
    s->origin_y = had->origin_y;
    s->moved = had->moved;
    if (s->sleeping > 0)
        mspringi_islands_map(to);
    s->masses = had->masses;
}

static bool is_idle(const mspring_network *network) {
    return mspringi_sleep_is_whole(network) &&
           mspringi_next_disturbed_sleeper(network, 0) == mspringi_slot_count(network);
}

const mspringi_sleep_ops mspringi_ops_of_sleep = {.begin = begin,
                                                  .hold = hold,
                                                  .put_back = put_back,
                                                  .restore = restore,
                                                  .undo = undo,
                                                  .wake = wake,
                                                  .finish_waking = finish_waking,
                                                  .find_islands = mspringi_islands_find,
                                                  .move = move,
                                                  .wake_all = wake_all,
                                                  .is_idle = is_idle};

void mspringi_sleep_react(mspring_network *network, mspringi_change change, uint32_t index) {
    switch (change) {
    case MSPRINGI_CHANGED_SPRING_MASSES:
    case MSPRINGI_CHANGED_SOLVER:
    case MSPRINGI_CHANGED_GRAVITY:
    case MSPRINGI_CHANGED_RELAX:
    case MSPRINGI_CHANGED_SIGNALS:
    case MSPRINGI_CHANGED_NEW_FLOOR:
    case MSPRINGI_CHANGED_CONTACT:
    case MSPRINGI_CHANGED_AREA:
    case MSPRINGI_CHANGED_REST_ANGLES:
        wake_all(network);
        break;
    case MSPRINGI_CHANGED_SPRING:
    case MSPRINGI_CHANGED_BROKEN_SPRING:
    case MSPRINGI_CHANGED_LIVE_SPRING:
        wake_spring(network, index);
        break;
    case MSPRINGI_CHANGED_GRIP:
        wake_slot(network, index);
        break;
    case MSPRINGI_CHANGED_COUNTS:
    case MSPRINGI_CHANGED_SLEEP:
        wake_all(network);
        network->sleep.count = 0; // find the islands again
        break;
    default:
        break;
    }
}

bool mspringi_sleep_acts(const mspring_network *network) {
    return network->sleep.sleeping > 0;
}

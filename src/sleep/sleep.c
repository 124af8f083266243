/// A network that lies still is left alone until something happens to it.
///
/// What it was when it fell asleep is kept, and compared with what it is: views and hooks write to it without
/// telling, and a game sets masses and forces in every frame that are mostly those of the frame before.
#include "sleep.h"

#include <math.h>
#include <string.h>

mspring_result mspringi_sleep_reserve(mspring_network *network) {
    mspringi_sleep *sleep = &network->sleep;
    const size_t slots = mspringi_slot_count(network);
    if (!sleep->state)
        sleep->state = mspringi_alloc(&network->memory, 4 * slots, sizeof *sleep->state);
    if (!sleep->inverse_mass)
        sleep->inverse_mass = mspringi_alloc(&network->memory, slots, sizeof *sleep->inverse_mass);
    if (sleep->state && sleep->inverse_mass)
        return mspringi_field_reserve(network, &sleep->force);
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for the sleep of %zu slots", slots);
}

void mspringi_sleep_free(const mspringi_sleep *sleep, mspringi_memory *memory) {
    mspringi_free(memory, sleep->state);
    mspringi_free(memory, sleep->inverse_mass);
    mspringi_free(memory, sleep->force.x);
}

void mspringi_wake(mspring_network *network) {
    network->sleep.is_asleep = false;
    network->sleep.still = 0.0;
}

/* -------------------------------------------------------------------------------------------------- waking */

static bool has_moved(const mspring_network *network) {
    const mspringi_sleep *sleep = &network->sleep;
    const size_t slots = mspringi_slot_count(network);
    return network->origin_x != sleep->origin_x || network->origin_y != sleep->origin_y ||
           memcmp(network->state.x, sleep->state, 4 * slots * sizeof *sleep->state) != 0;
}

bool mspringi_sleep_is_disturbed(const mspring_network *network) {
    const mspringi_sleep *sleep = &network->sleep;
    const mspringi_edits *edits = &network->edits;
    if (sleep->values != edits->values || sleep->links != edits->links)
        return true;
    const size_t mass_bytes = mspringi_slot_count(network) * sizeof *sleep->inverse_mass;
    if (sleep->masses != edits->masses && memcmp(network->inverse_mass, sleep->inverse_mass, mass_bytes) != 0)
        return true;
    return (network->is_open || sleep->moved != edits->state) && has_moved(network);
}

void mspringi_sleep_begin(mspring_network *network, double dt) {
    if (!network->sleep.is_asleep)
        return;
    // A substep of another length changes relative springs, and how many there are may change by itself.
    const bool same_h = !network->relative || (float)(dt / (double)network->substeps) == network->relative_h;
    if (!same_h || network->ramps.count > 0 || mspringi_sleep_is_disturbed(network))
        mspringi_wake(network);
}

bool mspringi_sleep_is_idle(const mspring_network *network) {
    const mspringi_sleep *sleep = &network->sleep;
    return sleep->is_asleep && !sleep->has_force && network->hook_count == 0 && !network->forces.held_any;
}

// A change of force counts that would bring a particle to the speed that is no sleep any more within the time after
// which it would have been asleep again.
void mspringi_sleep_feel(mspring_network *network, mspringi_field force) {
    const mspringi_sleep *sleep = &network->sleep;
    const size_t slots = mspringi_slot_count(network);
    if (!sleep->is_asleep || (!force.x && !sleep->has_force))
        return;
    for (size_t slot = 0; slot < slots; ++slot) {
        const float x = force.x ? force.x[slot] : 0.0f, y = force.x ? force.y[slot] : 0.0f;
        const float change = fmaxf(fabsf(x - sleep->force.x[slot]), fabsf(y - sleep->force.y[slot]));
        if (!(change * network->inverse_mass[slot] * sleep->time <= sleep->speed)) {
            mspringi_wake(network);
            return;
        }
    }
}

/* ------------------------------------------------------------------------------------------- falling asleep */

// Whether something moves that the host has sent on its way.
static bool has_driven_pin(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    for (mspring_id p = 0; p < t->particle_count; ++p) {
        const uint32_t slot = t->slot_of_particle[p];
        if (!(network->inverse_mass[slot] > 0.0f) &&
            (network->state.vx[slot] != 0.0f || network->state.vy[slot] != 0.0f))
            return true;
    }
    return false;
}

void mspringi_sleep_fall(mspring_network *network, mspringi_field force) {
    mspringi_sleep *sleep = &network->sleep;
    const size_t slots = mspringi_slot_count(network);
    memset(network->state.vx, 0, 2 * slots * sizeof *network->state.vx); // vy lies behind vx
    sleep->origin_x = network->origin_x;
    sleep->origin_y = network->origin_y;
    memcpy(sleep->state, network->state.x, 4 * slots * sizeof *sleep->state);
    memcpy(sleep->inverse_mass, network->inverse_mass, slots * sizeof *sleep->inverse_mass);
    sleep->has_force = force.x != NULL;
    if (force.x)
        memcpy(sleep->force.x, force.x, 2 * slots * sizeof *force.x);
    else
        memset(sleep->force.x, 0, 2 * slots * sizeof *sleep->force.x);
    sleep->is_asleep = true;
    sleep->masses = network->edits.masses;
    sleep->values = network->edits.values;
    sleep->links = network->edits.links;
    sleep->moved = network->edits.state;
}

void mspringi_sleep_end(mspring_network *network, double dt) {
    mspringi_sleep *sleep = &network->sleep;
    const mspringi_field force = sleep->in_force;
    sleep->in_force = (mspringi_field){NULL, NULL};
    if (!(sleep->speed > 0.0f))
        return;
    if (sleep->is_asleep) {
        if (network->is_open && has_moved(network))
            mspringi_wake(network);
        return;
    }
    const size_t count = 2 * mspringi_slot_count(network);
    const bool is_still = network->ramps.count == 0 &&
                          network->kernels->largest(network->state.vx, NULL, count).value <= sleep->speed &&
                          !has_driven_pin(network);
    sleep->still = is_still ? sleep->still + dt : 0.0;
    if (!is_still || sleep->still < (double)sleep->time)
        return;
    // What an integrator remembers of the motion has come to its end.
    network->edits.motion++;
    mspringi_sleep_fall(network, force);
}

/* ---------------------------------------------------------------------------------------------------- the host */

mspring_result mspring_network_wake(mspring_network *network) {
    mspring_result result = mspringi_enter(network);
    if (result == MSPRING_OK)
        mspringi_wake(network);
    return result;
}

uint32_t mspring_network_is_asleep(const mspring_network *network) {
    return network && network->sleep.is_asleep && !mspringi_sleep_is_disturbed(network);
}

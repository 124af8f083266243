/// Definition of grips, set by the host; target and bound of the force.
#include "features/grips/grips.h"

#include <math.h>

#include "base/assert.h"
#include "base/cpu.h"
#include "store/changed.h"
#include "store/feature.h"
#include "store/sleepers.h"

#define STRONGEST 1e30f

/* -------------------------------------------------------------------------------------------- target and bound */

mspringi_grip_target mspringi_grip_target_at(const mspring_network *network, const mspringi_grip *grip,
                                             double share) {
    const double way_x = grip->x - grip->from_x, way_y = grip->y - grip->from_y;
    const double seconds = (double)network->grips->h / network->grips->share;
    return (mspringi_grip_target){(grip->from_x + share * way_x) - network->origin_x,
                                  (grip->from_y + share * way_y) - network->origin_y, way_x / seconds,
                                  way_y / seconds};
}

bool mspringi_grip_bound(const mspringi_grip *grip, double *force_x, double *force_y) {
    const double most = (double)grip->max_force, size = sqrt(*force_x * *force_x + *force_y * *force_y);
    if (size <= most)
        return false;
    *force_x *= most / size;
    *force_y *= most / size;
    return true;
}

bool mspringi_grip_is_active(const mspring_network *network, const mspringi_grip *grip, uint32_t *slot) {
    *slot = network->topology.slot_of_particle[grip->particle];
    return mspringi_active_inverse_mass(network)[*slot] > 0.0f;
}

void mspringi_grips_finish_step(mspring_network *network) {
    for (uint32_t i = 0; i < mspringi_grip_count(network); ++i) {
        mspringi_grip *grip = &network->grips->list[i];
        grip->from_x = grip->x;
        grip->from_y = grip->y;
        if (mspringi_slot_is_asleep(network, network->topology.slot_of_particle[grip->particle]))
            continue;
        grip->impulse_x = grip->sum_x;
        grip->impulse_y = grip->sum_y;
    }
}

bool mspringi_grips_are_finite(const mspring_network *network) {
    bool finite = true;
    for (uint32_t i = 0; i < mspringi_grip_count(network); ++i) {
        const mspringi_grip *grip = &network->grips->list[i];
        finite = finite && isfinite(grip->impulse_x) && isfinite(grip->impulse_y) && isfinite(grip->from_x) &&
                 isfinite(grip->from_y);
    }
    return finite;
}

const mspringi_feature_state mspringi_state_of_grips = {{NULL, 0}, NULL};

/* ------------------------------------------------------------------------------------------------- the setting */

// Find a grip by its id; NULL without one.
static mspringi_grip *find(const mspring_network *network, mspring_id id) {
    for (uint32_t i = 0; i < mspringi_grip_count(network); ++i)
        if (network->grips->list[i].id == id)
            return &network->grips->list[i];
    return NULL;
}

static void remove_from_list(mspringi_grips *grips, mspringi_grip *grip) {
    mspringi_grip *last = &grips->list[--grips->count];
    MSPRINGI_ASSERT(grip >= grips->list && grip <= last);
    for (; grip < last; ++grip)
        *grip = grip[1];
}

void mspringi_grips_clear(mspring_network *network) {
    if (network->grips)
        *network->grips = (mspringi_grips){.count = 0};
}

mspring_result mspringi_grips_reserve(mspring_network *network) {
    if (!network->grips)
        network->grips = mspringi_alloc(&network->memory, 1, sizeof *network->grips);
    return network->grips && mspringi_constraints_reserve(network, MSPRINGI_GRIP_CONSTRAINT, 2 * MSPRING_MAX_GRIPS,
                                                          2 * MSPRING_MAX_GRIPS)
               ? MSPRING_OK
               : mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for %u grips",
                               (unsigned)MSPRING_MAX_GRIPS);
}

void mspringi_grips_forget(mspring_network *network) {
    for (uint32_t i = mspringi_grip_count(network); i-- > 0;)
        if (!mspringi_particle_exists(network, network->grips->list[i].particle))
            remove_from_list(network->grips, &network->grips->list[i]);
}

#define NO_GRIP "there is no grip %s"

static mspring_result find_or_fail(mspring_network *network, mspring_id id, mspringi_grip **found) {
    const mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    *found = find(network, id);
    return *found ? MSPRING_OK : mspringi_fail(&network->message, MSPRING_ERROR_ID, NO_GRIP, MSPRINGI_ID(id));
}

static mspring_result check_target(mspring_network *network, double x, double y) {
    return fabs(x) <= MSPRING_MAX_COORDINATE && fabs(y) <= MSPRING_MAX_COORDINATE
               ? MSPRING_OK
               : mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "the target (%g, %g) m of the grip is not within 1e12", x, y);
}

static mspring_result check_grip(mspring_network *network, const mspring_grip_def **given, mspring_grip_def *def) {
    mspringi_message *message = &network->message;
    mspring_result result = mspringi_take_grip_def(message, given, def);
    if (result == MSPRING_OK)
        result = mspringi_check_reserved(message, "mspring_grip_def", def->reserved);
    if (result == MSPRING_OK)
        result = check_target(network, def->x, def->y);
    if (result != MSPRING_OK)
        return result;
    const struct {
        const char *name;
        float value, most;
    } values[] = {{"stiffness", def->stiffness, STRONGEST},
                  {"damping", def->damping, STRONGEST},
                  {"max_force", def->max_force, MSPRING_NEVER}};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i)
        if (!(values[i].value >= 0.0f && values[i].value <= values[i].most))
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the grip's %s is %g, it must be 0 to %g",
                                 values[i].name, (double)values[i].value, (double)values[i].most);
    if (def->particle == MSPRING_NONE)
        return mspringi_fail(message, MSPRING_ERROR_ID, "the grip's particle is not set (MSPRING_NONE)");
    if (def->particle >= network->topology.particle_count || !mspringi_particle_exists(network, def->particle))
        return mspringi_fail(message, MSPRING_ERROR_ID, "the grip is to hold particle %u, which does not exist",
                             (unsigned)def->particle);
    return MSPRING_OK;
}

// Notify a change of the force on a grip's particle.
static void notify_grip(mspring_network *network, const mspringi_grip *grip) {
    mspringi_notify_change(network, MSPRINGI_CHANGED_GRIP, network->topology.slot_of_particle[grip->particle]);
}

static mspringi_grip make_grip(const mspring_grip_def *def, mspring_id id) {
    return (mspringi_grip){.id = id,
                           .particle = def->particle,
                           .stiffness = def->stiffness,
                           .damping = def->damping,
                           .max_force = def->max_force,
                           .x = def->x,
                           .y = def->y,
                           .from_x = def->x,
                           .from_y = def->y};
}

mspring_result mspring_network_add_grip(mspring_network *network, const mspring_grip_def *def, mspring_id *grip) {
    mspring_grip_def taken;
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK)
        result = check_grip(network, &def, &taken);
    if (result != MSPRING_OK)
        return result;
    if (mspringi_grip_count(network) == MSPRING_MAX_GRIPS)
        return mspringi_fail(
            &network->message, MSPRING_ERROR_LIMIT,
            "the network has %u grips, as many as it may have (MSPRING_MAX_GRIPS): remove one first",
            (unsigned)MSPRING_MAX_GRIPS);
    if (network->grips && network->grips->next_id == MSPRING_NONE)
        return mspringi_fail(&network->message, MSPRING_ERROR_LIMIT, "all ids of grips have been given away");
    result = mspringi_grips_reserve(network);
    if (result != MSPRING_OK)
        return result;
    mspringi_grips *grips = network->grips;
    grips->list[grips->count] = make_grip(def, grips->next_id++);
    if (grip)
        *grip = grips->list[grips->count].id;
    notify_grip(network, &grips->list[grips->count++]);
    return MSPRING_OK;
}

mspring_result mspring_network_remove_grip(mspring_network *network, mspring_id grip) {
    mspringi_grip *found;
    const mspring_result result = find_or_fail(network, grip, &found);
    if (result != MSPRING_OK)
        return result;
    notify_grip(network, found);
    remove_from_list(network->grips, found);
    return MSPRING_OK;
}

mspring_result mspring_network_set_grip(mspring_network *network, mspring_id grip, const mspring_grip_def *def) {
    mspring_grip_def taken;
    mspringi_grip *found;
    mspring_result result = find_or_fail(network, grip, &found);
    if (result == MSPRING_OK)
        result = check_grip(network, &def, &taken);
    if (result != MSPRING_OK)
        return result;
    const mspringi_grip had = *found;
    notify_grip(network, &had);
    *found = make_grip(def, grip);
    if (had.particle == def->particle) {
        found->from_x = had.from_x;
        found->from_y = had.from_y;
        found->impulse_x = had.impulse_x;
        found->impulse_y = had.impulse_y;
    }
    notify_grip(network, found);
    return MSPRING_OK;
}

mspring_result mspring_network_move_grip(mspring_network *network, mspring_id grip, double x, double y) {
    mspringi_grip *found;
    mspring_result result = find_or_fail(network, grip, &found);
    if (result == MSPRING_OK)
        result = check_target(network, x, y);
    if (result != MSPRING_OK || (found->x == x && found->y == y))
        return result;
    found->x = x;
    found->y = y;
    notify_grip(network, found);
    return MSPRING_OK;
}

// Find a grip in a call that only reads; NULL, with a message, without one.
static const mspringi_grip *find_to_read(const mspring_network *network, mspring_id id) {
    const mspringi_grip *found = find(network, id);
    if (!found)
        (void)mspringi_shared_fail(network->shared, MSPRING_ERROR_ID, NO_GRIP, MSPRINGI_ID(id));
    return found;
}

mspring_result mspring_network_get_grip(const mspring_network *network, mspring_id grip, mspring_grip_def *def) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_grip_def, def);
    if (result != MSPRING_OK)
        return result;
    const mspringi_grip *found = find_to_read(network, grip);
    if (!found)
        return MSPRING_ERROR_ID;
    const mspring_grip_def had = {.particle = found->particle,
                                  .x = found->x,
                                  .y = found->y,
                                  .stiffness = found->stiffness,
                                  .damping = found->damping,
                                  .max_force = found->max_force};
    mspringi_put_grip_def(def, &had);
    return MSPRING_OK;
}

mspring_result mspring_network_get_grip_impulse(const mspring_network *network, mspring_id grip, double *x,
                                                double *y) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    if (!x || !y)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT, "the place for the impulse is NULL");
    const mspringi_grip *found = find_to_read(network, grip);
    if (!found)
        return MSPRING_ERROR_ID;
    *x = found->impulse_x;
    *y = found->impulse_y;
    return MSPRING_OK;
}

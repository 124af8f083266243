/// Grips as the host defines them.
#include "contact/grips.h"

#include <math.h>

#include "base/cpu.h"
#include "sleep/sleep.h"
#include "store/changed.h"

#define STRONGEST 1e30f

/* --------------------------------------------------------------------------------------------------------- law */

mspringi_aim mspringi_grip_aim(const mspring_network *network, const mspringi_grip *grip, double share) {
    const double way_x = grip->x - grip->from_x, way_y = grip->y - grip->from_y;
    const double seconds = (double)network->grips.h / network->grips.share;
    return (mspringi_aim){(grip->from_x + share * way_x) - network->origin_x,
                          (grip->from_y + share * way_y) - network->origin_y, way_x / seconds, way_y / seconds};
}

bool mspringi_grip_bound(const mspringi_grip *grip, double *force_x, double *force_y) {
    const double most = (double)grip->max_force, size = sqrt(*force_x * *force_x + *force_y * *force_y);
    if (size <= most)
        return false;
    *force_x *= most / size;
    *force_y *= most / size;
    return true;
}

bool mspringi_grip_acts(const mspring_network *network, const mspringi_grip *grip, uint32_t *slot) {
    if (grip->particle == MSPRING_NONE)
        return false;
    *slot = network->topology.slot_of_particle[grip->particle];
    return mspringi_free_mass(network)[*slot] > 0.0f;
}

void mspringi_grips_arrive(mspring_network *network) {
    for (uint32_t i = 0; i < MSPRING_MAX_GRIPS; ++i) {
        mspringi_grip *grip = &network->grips.list[i];
        if (grip->particle == MSPRING_NONE)
            continue;
        grip->from_x = grip->x;
        grip->from_y = grip->y;
        if (mspringi_slot_is_asleep(network, network->topology.slot_of_particle[grip->particle]))
            continue;
        grip->impulse_x = grip->sum_x;
        grip->impulse_y = grip->sum_y;
    }
}

/* ------------------------------------------------------------------------------------------------- the setting */

static void let_go(mspringi_grips *grips, mspringi_grip *grip) {
    grips->count -= grip->particle != MSPRING_NONE;
    *grip = (mspringi_grip){.particle = MSPRING_NONE};
}

void mspringi_grips_clear(mspringi_grips *grips) {
    *grips = (mspringi_grips){.count = 0};
    for (uint32_t i = 0; i < MSPRING_MAX_GRIPS; ++i)
        grips->list[i].particle = MSPRING_NONE;
}

void mspringi_grips_forget(mspring_network *network, mspring_id particle) {
    for (uint32_t i = 0; network->grips.count > 0 && i < MSPRING_MAX_GRIPS; ++i)
        if (network->grips.list[i].particle == particle)
            let_go(&network->grips, &network->grips.list[i]);
}

static mspring_result check_number(mspring_network *network, uint32_t number) {
    return number < MSPRING_MAX_GRIPS ? MSPRING_OK
                                      : mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                                      "the grip is number %u, it may be 0 to %u", (unsigned)number,
                                                      (unsigned)MSPRING_MAX_GRIPS - 1);
}

static mspring_result check_target(mspring_network *network, uint32_t number, double x, double y) {
    return fabs(x) <= MSPRING_MAX_COORDINATE && fabs(y) <= MSPRING_MAX_COORDINATE
               ? MSPRING_OK
               : mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "the target of grip %u is (%g, %g), which is out of bounds", (unsigned)number, x, y);
}

static mspring_result check_grip(mspring_network *network, uint32_t number, const mspring_grip_def *def) {
    mspringi_message *message = &network->message;
    mspring_result result = mspringi_check_struct(message, "mspring_grip_def", def, sizeof *def);
    if (result == MSPRING_OK)
        result = mspringi_check_reserved(message, "mspring_grip_def", def->reserved);
    if (result == MSPRING_OK)
        result = check_target(network, number, def->x, def->y);
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
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the %s of grip %u is %g, it must be 0 to %g",
                                 values[i].name, (unsigned)number, (double)values[i].value, (double)values[i].most);
    if (def->particle >= network->topology.particle_count || !mspringi_particle_exists(network, def->particle))
        return mspringi_fail(message, MSPRING_ERROR_ID, "grip %u is to hold particle %u, which does not exist",
                             (unsigned)number, (unsigned)def->particle);
    return MSPRING_OK;
}

// Tell that the force on a grip's particle is another from now on.
static void tell(mspring_network *network, const mspringi_grip *grip) {
    mspringi_changed(network, MSPRINGI_CHANGED_GRIP, network->topology.slot_of_particle[grip->particle]);
}

mspring_result mspring_network_set_grip(mspring_network *network, uint32_t number, const mspring_grip_def *def) {
    mspring_result result = mspringi_enter(network);
    if (result == MSPRING_OK)
        result = check_number(network, number);
    if (result == MSPRING_OK && def)
        result = check_grip(network, number, def);
    if (result != MSPRING_OK)
        return result;
    mspringi_grip *grip = &network->grips.list[number];
    const mspringi_grip had = *grip;
    if (had.particle != MSPRING_NONE)
        tell(network, &had);
    let_go(&network->grips, grip);
    if (!def)
        return MSPRING_OK;
    *grip = (mspringi_grip){.particle = def->particle,
                            .stiffness = def->stiffness,
                            .damping = def->damping,
                            .max_force = def->max_force,
                            .x = def->x,
                            .y = def->y,
                            .from_x = def->x,
                            .from_y = def->y};
    if (had.particle == def->particle) {
        grip->from_x = had.from_x;
        grip->from_y = had.from_y;
        grip->impulse_x = had.impulse_x;
        grip->impulse_y = had.impulse_y;
    }
    network->grips.count++;
    tell(network, grip);
    return MSPRING_OK;
}

mspring_result mspring_network_move_grip(mspring_network *network, uint32_t number, double x, double y) {
    mspring_result result = mspringi_enter(network);
    if (result == MSPRING_OK)
        result = check_number(network, number);
    if (result == MSPRING_OK)
        result = check_target(network, number, x, y);
    if (result != MSPRING_OK)
        return result;
    mspringi_grip *grip = &network->grips.list[number];
    if (grip->particle == MSPRING_NONE)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "grip %u holds nothing: set it before you move it", (unsigned)number);
    if (grip->x == x && grip->y == y)
        return MSPRING_OK;
    grip->x = x;
    grip->y = y;
    tell(network, grip);
    return MSPRING_OK;
}

mspring_result mspring_network_get_grip(const mspring_network *network, uint32_t number, mspring_grip_def *def) {
    mspring_grip_def had;
    if (!network || number >= MSPRING_MAX_GRIPS)
        return MSPRING_ERROR_ARGUMENT;
    const mspring_result result = mspringi_check_output(NULL, "mspring_grip_def", def, sizeof *def);
    if (result != MSPRING_OK)
        return result;
    const mspringi_grip *grip = &network->grips.list[number];
    (void)mspring_grip_def_init(&had, sizeof had);
    if (grip->particle != MSPRING_NONE) {
        had.particle = grip->particle;
        had.x = grip->x;
        had.y = grip->y;
        had.stiffness = grip->stiffness;
        had.damping = grip->damping;
        had.max_force = grip->max_force;
    }
    mspringi_put_struct(def, &had, sizeof had);
    return MSPRING_OK;
}

mspring_result mspring_network_get_grip_impulse(const mspring_network *network, uint32_t number, double *x,
                                                double *y) {
    if (!network || number >= MSPRING_MAX_GRIPS || !x || !y)
        return MSPRING_ERROR_ARGUMENT;
    *x = network->grips.list[number].impulse_x;
    *y = network->grips.list[number].impulse_y;
    return MSPRING_OK;
}

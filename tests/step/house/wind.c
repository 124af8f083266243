/// A stage: the same force along x on every particle that is free.
#include "wind.h"

#include "store/stages.h"

float house_wind_force;

static bool is_used(const mspring_network *network) {
    (void)network;
    return house_wind_force != 0.0f;
}

static void blow(mspring_network *network, const mspringi_attempt *attempt, mspringi_field field) {
    (void)attempt;
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot)
        if (network->inverse_mass[slot] > 0.0f)
            field.x[slot] += house_wind_force;
}

const mspringi_stage house_wind = {.is_used = is_used, .forces = blow};

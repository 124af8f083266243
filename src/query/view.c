/// View of the state's arrays for the host.
#include "store/network.h"

mspring_result mspring_network_get_view(const mspring_network *network, mspring_view *view) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_view, view);
    if (result != MSPRING_OK)
        return result;
    const mspring_view made = {.slot_count = (uint32_t)mspringi_slot_count(network),
                               .particle_count = network->topology.particle_count,
                               .layout_generation = network->edits.layouts + network->edits.growth,
                               .origin_generation = network->edits.origins,
                               .origin_x = network->origin_x,
                               .origin_y = network->origin_y,
                               .x = network->state.x,
                               .y = network->state.y,
                               .vx = network->state.vx,
                               .vy = network->state.vy,
                               .inverse_mass = network->inverse_mass,
                               .particle_of_slot = network->topology.particle_of_slot,
                               .slot_of_particle = network->topology.slot_of_particle};
    mspringi_put_view(view, &made);
    return MSPRING_OK;
}

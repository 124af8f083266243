/// Views of the state's arrays for the host: read-only, or writable until the next step.
#include "store/network.h"

// Members of both kinds of view.
#define VIEW_OF(network)                                                                                           \
    {                                                                                                              \
        .slot_count = (uint32_t)mspringi_slot_count(network),                                                      \
        .particle_count = (network)->topology.particle_count,                                                      \
        .layout_generation = (network)->edits.layouts + (network)->edits.growth,                                   \
        .origin_generation = (network)->edits.origins, .origin_x = (network)->origin_x,                            \
        .origin_y = (network)->origin_y, .x = (network)->state.x, .y = (network)->state.y,                         \
        .vx = (network)->state.vx, .vy = (network)->state.vy, .inverse_mass = (network)->inverse_mass,             \
        .particle_of_slot = (network)->topology.particle_of_slot,                                                  \
        .slot_of_particle = (network)->topology.slot_of_particle,                                                  \
    }

mspring_result mspring_network_view(const mspring_network *network, mspring_view *view) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_view, view);
    if (result == MSPRING_OK)
        mspringi_put_view(view, &(mspring_view)VIEW_OF(network));
    return result;
}

mspring_result mspring_network_view_mutable(mspring_network *network, mspring_mutable_view *view) {
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    result = mspringi_check_output(&network->message, &mspringi_struct_mutable_view, view);
    if (result != MSPRING_OK)
        return result;
    network->is_open = network->has_host_view = true;
    mspringi_put_mutable_view(view, &(mspring_mutable_view)VIEW_OF(network));
    return MSPRING_OK;
}

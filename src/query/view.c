/// The state's arrays, lent to the host: to read, or to write until the next step.
#include "store/network.h"

// What both kinds of view are filled with.
#define VIEW_OF(network)                                                                                           \
    {                                                                                                              \
        .struct_size = view->struct_size, .slot_count = (uint32_t)mspringi_slot_count(network),                    \
        .particle_count = (network)->topology.particle_count,                                                      \
        .layout_generation = (network)->edits.layouts + (network)->edits.growth,                                   \
        .origin_generation = (network)->edits.origins, .origin_x = (network)->origin_x,                            \
        .origin_y = (network)->origin_y, .x = (network)->state.x, .y = (network)->state.y,                         \
        .vx = (network)->state.vx, .vy = (network)->state.vy, .inverse_mass = (network)->inverse_mass,             \
        .particle_of_slot = (network)->topology.particle_of_slot,                                                  \
        .slot_of_particle = (network)->topology.slot_of_particle,                                                  \
    }

mspring_result mspring_network_view(const mspring_network *network, mspring_view *view) {
    if (!network || !view)
        return MSPRING_ERROR_ARGUMENT;
    if (view->struct_size != sizeof *view)
        return MSPRING_ERROR_STRUCT;
    *view = (mspring_view)VIEW_OF(network);
    return MSPRING_OK;
}

mspring_result mspring_network_view_mutable(mspring_network *network, mspring_mutable_view *view) {
    mspring_result result = mspringi_enter(network);
    if (result != MSPRING_OK)
        return result;
    if (!view)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "the view is NULL");
    result = mspringi_check_struct(&network->message, "mspring_mutable_view", view->struct_size, sizeof *view,
                                   sizeof *view);
    if (result != MSPRING_OK)
        return result;
    network->is_open = network->is_lent = true;
    *view = (mspring_mutable_view)VIEW_OF(network);
    return MSPRING_OK;
}

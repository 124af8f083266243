/// @file loose.c
/// Particles that nothing holds.
///
/// SPDX-License-Identifier: MIT
#include "bending/settle.h"

#include <stdlib.h>

static mspring_id first_without_pin(const mspring_view *view, const uint32_t *component, bool *held) {
    for (mspring_id i = 0; i < view->particle_count; i++)
        if (view->inverse_mass[view->slot_of_particle[i]] == 0)
            held[component[i]] = true;
    for (mspring_id i = 0; i < view->particle_count; i++)
        if (!held[component[i]])
            return i;
    return MSPRING_NONE;
}

mspring_result settle_find_loose(mspring_network *network, mspring_id *loose) {
    uint32_t count = 0;
    mspring_view view = mspring_view_default();
    mspring_result result = mspring_network_update_components(network, &count, NULL);
    if (result == MSPRING_OK)
        result = mspring_network_get_view(network, &view);
    if (result != MSPRING_OK)
        return result;
    uint32_t *component = malloc(view.particle_count * sizeof *component);
    bool *held = calloc(count, sizeof *held);
    result = component && held ? mspring_network_get_integers(network, MSPRING_COMPONENT, NULL, 0,
                                                              view.particle_count, component, 1)
                               : MSPRING_ERROR_MEMORY;
    if (result == MSPRING_OK)
        *loose = first_without_pin(&view, component, held);
    free(component);
    free(held);
    return result;
}

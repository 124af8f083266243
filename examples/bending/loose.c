/// @file loose.c
/// Particles that nothing holds.
///
/// SPDX-License-Identifier: MIT
#include "bending/settle.h"

#include <stdlib.h>

// Sets of particles that springs join: each points to another of its set, up to the one that stands for it.
static mspring_id find_root(mspring_id *parents, mspring_id particle) {
    while (parents[particle] != particle) {
        parents[particle] = parents[parents[particle]];
        particle = parents[particle];
    }
    return particle;
}

static bool join_sets(mspring_network *network, mspring_id *parents) {
    const uint32_t count = mspring_network_spring_count(network);
    mspring_id(*ends)[2] = malloc((count + 1) * sizeof *ends);
    const bool ok = ends && mspring_network_get_ends(network, 0, count, MSPRING_ENDS_IDS, &ends[0][0], &ends[0][1],
                                                     2) == MSPRING_OK;
    for (mspring_id i = 0; ok && i < count; i++)
        parents[find_root(parents, ends[i][0])] = find_root(parents, ends[i][1]);
    free(ends);
    return ok;
}

static mspring_id first_without_pin(const mspring_view *view, mspring_id *parents, bool *held) {
    for (mspring_id i = 0; i < view->particle_count; i++)
        if (view->inverse_mass[view->slot_of_particle[i]] == 0)
            held[find_root(parents, i)] = true;
    for (mspring_id i = 0; i < view->particle_count; i++)
        if (!held[find_root(parents, i)])
            return i;
    return MSPRING_NONE;
}

bool settle_find_loose(mspring_network *network, mspring_id *loose) {
    mspring_view view = {.struct_size = sizeof view};
    if (mspring_network_view(network, &view) != MSPRING_OK)
        return false;
    mspring_id *parents = malloc(view.particle_count * sizeof *parents);
    bool *held = calloc(view.particle_count, sizeof *held);
    bool ok = parents && held;
    if (ok) {
        for (mspring_id i = 0; i < view.particle_count; i++)
            parents[i] = i;
        ok = join_sets(network, parents);
    }
    if (ok)
        *loose = first_without_pin(&view, parents, held);
    free(parents);
    free(held);
    return ok;
}

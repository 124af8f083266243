/// The hash of a state.
#include "base/mix.h"
#include "network.h"

mspring_result mspring_network_state_hash(const mspring_network *network, uint64_t *hash) {
    if (!network || !hash)
        return MSPRING_ERROR_ARGUMENT;
    const mspringi_topology *t = &network->topology;
    const mspringi_state *s = &network->state;
    uint64_t sum = MSPRINGI_MIX_START;
    sum = mspringi_mix_double(sum, network->origin_x);
    sum = mspringi_mix_double(sum, network->origin_y);
    for (mspring_id p = 0; p < t->particle_count; ++p) {
        const uint32_t slot = t->slot_of_particle[p];
        sum = mspringi_mix_floats(sum, s->x[slot], s->y[slot]);
        sum = mspringi_mix_floats(sum, s->vx[slot], s->vy[slot]);
        sum = mspringi_mix_floats(sum, mspringi_low_of(s->x[slot], s->low_x[slot]),
                                  mspringi_low_of(s->y[slot], s->low_y[slot]));
    }
    *hash = sum;
    return MSPRING_OK;
}

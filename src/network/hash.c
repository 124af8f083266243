/// The hash of a state: FNV-1a (Fowler, Noll, Vo 1991) taken over 64-bit words instead of bytes, with the upper
/// half folded in so that every bit of a word reaches every bit of the hash.
#include <string.h>

#include "network.h"

static uint64_t add_word(uint64_t hash, uint64_t word) {
    hash = (hash ^ word) * UINT64_C(0x100000001b3);
    return hash ^ hash >> 32;
}

static uint64_t add_floats(uint64_t hash, float a, float b) {
    uint32_t low, high;
    memcpy(&low, &a, sizeof low);
    memcpy(&high, &b, sizeof high);
    return add_word(hash, (uint64_t)high << 32 | low);
}

static uint64_t add_double(uint64_t hash, double value) {
    uint64_t word;
    memcpy(&word, &value, sizeof word);
    return add_word(hash, word);
}

mspring_result mspring_network_state_hash(const mspring_network *network, uint64_t *hash) {
    if (!network || !hash)
        return MSPRING_ERROR_ARGUMENT;
    const mspringi_topology *t = &network->topology;
    const mspringi_state *s = &network->state;
    uint64_t sum = UINT64_C(0xcbf29ce484222325);
    sum = add_double(sum, network->origin_x);
    sum = add_double(sum, network->origin_y);
    for (mspring_id p = 0; p < t->particle_count; ++p) {
        const uint32_t slot = t->slot_of_particle[p];
        sum = add_floats(sum, s->x[slot], s->y[slot]);
        sum = add_floats(sum, s->vx[slot], s->vy[slot]);
    }
    *hash = sum;
    return MSPRING_OK;
}

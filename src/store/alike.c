/// Finding lattice blocks whose springs are alike.
#include "store/alike.h"

#include <string.h>

#include "base/mix.h"

/// Entries of the table that blocks are looked up in while they are gone through, and how many one may be in.
#define ENTRIES 2048u
#define PROBES 4u

void mspringi_alike_begin(mspringi_alike *alike, uint32_t blocks) {
    alike->changes = alike->compared = 0;
    for (uint32_t b = 0; b < blocks; ++b)
        alike->of_block[b] = alike->home[b] = b;
}

static size_t values_of_record(const mspring_network *network) {
    return (size_t)MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH * (network->parts - 1);
}

static const float *record(const mspring_network *network, uint32_t block) {
    return network->lattice_springs + block * values_of_record(network);
}

static bool are_alike(const mspring_network *network, uint32_t a, uint32_t b) {
    return memcmp(record(network, a), record(network, b), values_of_record(network) * sizeof(float)) == 0;
}

static uint32_t first_entry(const mspring_network *network, uint32_t block) {
    const float *values = record(network, block);
    uint64_t hash = MSPRINGI_MIX_START;
    for (size_t i = 0; i < values_of_record(network); i += 2)
        hash = mspringi_mix_floats(hash, values[i], values[i + 1]);
    return (uint32_t)(hash % ENTRIES);
}

// The block whose record is to be read for a block: itself if there is none like it in the table, where it is from
// then on, unless others that are read have taken all room. Entries are blocks, counted from 1.
static uint32_t find_like(const mspringi_alike *alike, const mspring_network *network, uint32_t *entries,
                          uint32_t block) {
    const uint32_t first = first_entry(network, block);
    for (uint32_t i = 0; i < PROBES; ++i) {
        uint32_t *entry = &entries[(first + i) % ENTRIES];
        if (*entry == 0) {
            *entry = block + 1;
            return block;
        }
        if (are_alike(network, block, *entry - 1))
            return *entry - 1;
    }
    if (alike->readers[entries[first] - 1] == 0)
        entries[first] = block + 1;
    return block;
}

static void look_at_all(mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    mspringi_alike *alike = &network->alike;
    uint32_t entries[ENTRIES] = {0};
    memset(alike->readers, 0, t->lattice_blocks * sizeof *alike->readers);
    memset(alike->is_set, 0, t->lattice_blocks * sizeof *alike->is_set);
    for (uint32_t b = 0; b < t->lattice_blocks; ++b) {
        const uint32_t like = alike->of_block[b] = alike->home[b] = find_like(alike, network, entries, b);
        alike->readers[like] += like != b;
    }
}

// Blocks that were set, and have a record of their own since, may be like the others again: a host that changes
// some springs in each step often changes others back.
static void look_at_set(const mspring_network *network) {
    const mspringi_alike *alike = &network->alike;
    for (uint32_t b = 0; b < network->topology.lattice_blocks; ++b) {
        if (!alike->is_set[b])
            continue;
        alike->is_set[b] = 0;
        const uint32_t home = alike->of_block[alike->home[b]], like = alike->of_block[alike->home[home]];
        if (alike->of_block[b] != b || alike->readers[b] > 0 || like == b || !are_alike(network, b, like))
            continue;
        alike->of_block[b] = like;
        alike->readers[like]++;
    }
}

void mspringi_alike_renew(mspring_network *network) {
    mspringi_alike *alike = &network->alike;
    if (alike->changes == alike->compared)
        return;
    const bool all = alike->changes >= network->topology.lattice_springs / 4;
    if (all)
        look_at_all(network);
    else
        look_at_set(network);
    alike->compared = alike->changes = all ? 0 : alike->changes;
}

void mspringi_alike_part_block(mspring_network *network, uint32_t block) {
    mspringi_alike *alike = &network->alike;
    if (alike->of_block[block] != block) {
        alike->readers[alike->of_block[block]]--;
        alike->of_block[block] = block;
        return;
    }
    // The last of those that read it has the record for all from now on: whoever sets one spring after the other
    // comes there late. (A scan of the 3,683 blocks of our ship takes 0.4 us.)
    uint32_t left = alike->readers[block], heir = block;
    alike->readers[block] = 0;
    for (uint32_t b = network->topology.lattice_blocks; left > 0;) {
        if (alike->of_block[--b] != block || b == block)
            continue;
        heir = heir == block ? b : heir;
        alike->of_block[b] = alike->home[b] = heir;
        alike->readers[heir] += b != heir;
        left--;
    }
    alike->home[block] = heir;
}

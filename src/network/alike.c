/// Finding lattice blocks whose springs are alike.
#include "alike.h"

#include <string.h>

/// Most records that several blocks have in common, and blocks for each of them.
#define MOST_RECORDS 16u
#define BLOCKS_PER_RECORD 8u

void mspringi_alike_begin(mspringi_alike *alike, const mspringi_topology *topology, mspringi_memory *memory) {
    const uint32_t blocks = topology->lattice_blocks, worth = blocks / BLOCKS_PER_RECORD;
    *alike = (mspringi_alike){.capacity = worth < MOST_RECORDS ? worth : MOST_RECORDS};
    alike->of_block = mspringi_alloc(memory, blocks, sizeof *alike->of_block);
    for (uint32_t b = 0; alike->of_block && b < blocks; ++b)
        alike->of_block[b] = b;
}

static size_t values_of_record(const mspring_network *network) {
    return (size_t)MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH * (network->parts - 1);
}

static float *record(const mspring_network *network, uint32_t number) {
    return network->lattice_springs + number * values_of_record(network);
}

static bool are_alike(const mspring_network *network, uint32_t a, uint32_t b) {
    return memcmp(record(network, a), record(network, b), values_of_record(network) * sizeof(float)) == 0;
}

// The common record that a block is like; the last one that fitted is tried first. The block itself if there is
// none.
static uint32_t find_common(const mspring_network *network, uint32_t block, uint32_t last) {
    const uint32_t first = network->topology.lattice_blocks, end = first + network->alike.count;
    if (last >= first && are_alike(network, block, last))
        return last;
    for (uint32_t common = first; common < end; ++common)
        if (common != last && are_alike(network, block, common))
            return common;
    return block;
}

// Whether the block before or the one above is alike: only what occurs twice side by side is made common, since
// there is room for few.
static bool has_like_neighbour(const mspring_network *network, uint32_t block) {
    const mspringi_topology *t = &network->topology;
    const uint32_t above = t->up_of_block[block] - t->lattice_first;
    return (block > 0 && are_alike(network, block, block - 1)) ||
           (above != block && are_alike(network, block, above));
}

void mspringi_alike_renew(mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    mspringi_alike *alike = &network->alike;
    if (alike->changes == 0 || alike->changes < t->lattice_springs / 4)
        return;
    alike->changes = 0;
    alike->count = 0;
    for (uint32_t b = 0, last = 0; b < t->lattice_blocks; ++b) {
        last = find_common(network, b, last);
        if (last == b && alike->count < alike->capacity && has_like_neighbour(network, b)) {
            last = t->lattice_blocks + alike->count++;
            memcpy(record(network, last), record(network, b), values_of_record(network) * sizeof(float));
        }
        alike->of_block[b] = last;
    }
}

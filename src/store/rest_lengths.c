/// Storage of rest lengths that many springs share.
#include "store/rest_lengths.h"
#include "store/changed.h"

#include <string.h>

/// Values of a block: one for each spring slot.
#define BLOCK_SPRING_SLOTS (MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH)

/// Most patterns, that is, sets of rest lengths by direction that blocks have in common.
#define MOST_PATTERNS 16

typedef mspringi_rest_pattern pattern;

void mspringi_rest_lengths_note(pattern *of_block, mspringi_spring_slot spring_slot, float rest_length) {
    pattern *block = &of_block[spring_slot / BLOCK_SPRING_SLOTS];
    float *length = &block->length[spring_slot / MSPRINGI_WIDTH % MSPRINGI_DIRECTIONS];
    if (*length == 0.0f)
        *length = rest_length;
    block->is_mixed = block->is_mixed || *length != rest_length;
}

// Find the rest length of each direction of each block, and if it is mixed.
static void find_patterns(pattern *of_block, const mspringi_topology *t, const mspring_builder *builder) {
    for (uint32_t s = 0; s < t->spring_count; ++s) {
        const mspringi_spring_slot spring_slot = t->slot_of_spring[s];
        if (spring_slot < t->lattice_spring_slots)
            mspringi_rest_lengths_note(of_block, spring_slot, builder->springs[s].rest_length);
    }
}

// Make one pattern of two; false if they differ.
static bool merge(pattern *into, const pattern *from) {
    for (int d = 0; d < MSPRINGI_DIRECTIONS; ++d)
        if (into->length[d] != from->length[d] && into->length[d] != 0.0f && from->length[d] != 0.0f)
            return false;
    for (int d = 0; d < MSPRINGI_DIRECTIONS; ++d)
        into->length[d] = from->length[d] != 0.0f ? from->length[d] : into->length[d];
    return true;
}

// Number the patterns that blocks share, and behind them the blocks that share none.
static void number_blocks(mspringi_rest_lengths *rests, const pattern *of_block, uint32_t block_count,
                          pattern *shared) {
    for (uint32_t b = 0; b < block_count; ++b) {
        uint32_t number = 0;
        while (number < rests->shared_count && !of_block[b].is_mixed && !merge(&shared[number], &of_block[b]))
            ++number;
        if (!of_block[b].is_mixed && number == rests->shared_count && number < MOST_PATTERNS)
            shared[rests->shared_count++] = of_block[b];
        rests->of_block[b] = of_block[b].is_mixed || number == rests->shared_count ? MSPRING_NONE : number;
    }
    rests->count = rests->shared_count;
    for (uint32_t b = 0; b < block_count; ++b)
        if (rests->of_block[b] == MSPRING_NONE)
            rests->of_block[b] = rests->count++;
}

static mspring_result no_memory(uint32_t blocks, mspringi_message *message) {
    return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for the rest lengths of %u blocks of lattice",
                         (unsigned)blocks);
}

mspring_result mspringi_rest_lengths_reserve(mspringi_rest_lengths *rests, const pattern *of_block, uint32_t blocks,
                                             mspringi_memory *memory, mspringi_message *message) {
    pattern shared[MOST_PATTERNS] = {{.is_mixed = false}};
    rests->of_block = mspringi_alloc(memory, blocks, sizeof *rests->of_block);
    if (!rests->of_block)
        return no_memory(blocks, message);
    number_blocks(rests, of_block, blocks, shared);
    rests->lengths = mspringi_alloc(memory, (size_t)rests->count * BLOCK_SPRING_SLOTS, sizeof *rests->lengths);
    if (!rests->lengths)
        return no_memory(blocks, message);
    for (uint32_t i = 0; i < rests->shared_count * BLOCK_SPRING_SLOTS; ++i)
        rests->lengths[i] = shared[i / BLOCK_SPRING_SLOTS].length[i / MSPRINGI_WIDTH % MSPRINGI_DIRECTIONS];
    return MSPRING_OK;
}

mspring_result mspringi_rest_lengths_create(mspringi_rest_lengths *rests, const mspringi_topology *topology,
                                            const mspring_builder *builder, mspringi_memory *memory,
                                            mspringi_message *message) {
    const uint32_t blocks = topology->lattice_blocks;
    pattern *of_block = mspringi_alloc(memory, blocks, sizeof *of_block);
    if (!of_block)
        return no_memory(blocks, message);
    find_patterns(of_block, topology, builder);
    mspring_result result = mspringi_rest_lengths_reserve(rests, of_block, blocks, memory, message);
    mspringi_free(memory, of_block);
    return result;
}

mspring_result mspringi_rest_lengths_unshare(mspring_network *network) {
    mspringi_rest_lengths *rests = &network->rest_lengths;
    const uint32_t blocks = network->topology.lattice_blocks;
    if (rests->shared_count == 0)
        return MSPRING_OK;
    float *lengths = mspringi_alloc(&network->memory, (size_t)blocks * BLOCK_SPRING_SLOTS, sizeof *lengths);
    if (!lengths)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for a rest length of its own for each of %zu lattice places",
                             (size_t)blocks * BLOCK_SPRING_SLOTS);
    for (uint32_t b = 0; b < blocks; ++b) {
        memcpy(lengths + (size_t)b * BLOCK_SPRING_SLOTS,
               rests->lengths + (size_t)rests->of_block[b] * BLOCK_SPRING_SLOTS,
               BLOCK_SPRING_SLOTS * sizeof *lengths);
        rests->of_block[b] = b;
    }
    mspringi_free(&network->memory, rests->lengths);
    rests->lengths = lengths;
    rests->count = blocks;
    rests->shared_count = 0;
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACES, 0);
    return MSPRING_OK;
}

/// Search for lattice blocks with equal records.
#include "store/record_sharing.h"

#include <string.h>

#include "base/hash.h"

/// Entries of the table that blocks are looked up in while they are gone through, and how many one may be in.
#define ENTRIES 2048u
#define PROBES 4u

void mspringi_shared_records_clear(mspringi_shared_records *shared, uint32_t blocks) {
    shared->changes = shared->compared = 0;
    for (uint32_t b = 0; b < blocks; ++b)
        shared->of_block[b] = shared->home[b] = b;
}

/// Data by which blocks are compared: `values` floats of each block, in each of these arrays.
#define MOST_ARRAYS 5
typedef struct records {
    const float *arrays[MOST_ARRAYS];
    uint32_t count;
    size_t values;
} records;

static bool are_alike(const records *of, uint32_t a, uint32_t b) {
    bool are = true;
    for (uint32_t i = 0; i < of->count && are; ++i)
        are =
            memcmp(of->arrays[i] + a * of->values, of->arrays[i] + b * of->values, of->values * sizeof(float)) == 0;
    return are;
}

static uint32_t first_entry(const records *of, uint32_t block) {
    uint64_t hash = MSPRINGI_HASH_START;
    for (uint32_t i = 0; i < of->count; ++i)
        for (size_t v = block * of->values; v < (block + 1) * of->values; v += 2)
            hash = mspringi_hash_floats(hash, of->arrays[i][v], of->arrays[i][v + 1]);
    return (uint32_t)(hash % ENTRIES);
}

// The block whose record is to be read for a block: itself if there is none like it in the table, where it is from
// then on, unless others that are read have taken all room. Entries are blocks, counted from 1.
static uint32_t find_like(const mspringi_shared_records *shared, const records *of, uint32_t *entries,
                          uint32_t block) {
    const uint32_t first = first_entry(of, block);
    for (uint32_t i = 0; i < PROBES; ++i) {
        uint32_t *entry = &entries[(first + i) % ENTRIES];
        if (*entry == 0) {
            *entry = block + 1;
            return block;
        }
        if (are_alike(of, block, *entry - 1))
            return *entry - 1;
    }
    if (shared->readers[entries[first] - 1] == 0)
        entries[first] = block + 1;
    return block;
}

static void look_at_all(const mspringi_shared_records *shared, const records *of, uint32_t blocks) {
    uint32_t entries[ENTRIES] = {0};
    memset(shared->readers, 0, blocks * sizeof *shared->readers);
    memset(shared->is_set, 0, blocks * sizeof *shared->is_set);
    for (uint32_t b = 0; b < blocks; ++b) {
        const uint32_t like = shared->of_block[b] = shared->home[b] = find_like(shared, of, entries, b);
        shared->readers[like] += like != b;
    }
}

// Blocks that were set, and have a record of their own since, may be like the others again: a host that changes
// some springs in each step often changes others back.
static void look_at_set(const mspringi_shared_records *shared, const records *of, uint32_t blocks) {
    for (uint32_t b = 0; b < blocks; ++b) {
        if (!shared->is_set[b])
            continue;
        shared->is_set[b] = 0;
        const uint32_t home = shared->of_block[shared->home[b]], like = shared->of_block[shared->home[home]];
        if (shared->of_block[b] != b || shared->readers[b] > 0 || like == b || !are_alike(of, b, like))
            continue;
        shared->of_block[b] = like;
        shared->readers[like]++;
    }
}

static void renew(mspringi_shared_records *shared, const records *of, const mspringi_topology *t) {
    if (shared->changes == shared->compared)
        return;
    const bool all = shared->changes >= t->lattice_springs / 4;
    if (all)
        look_at_all(shared, of, t->lattice_blocks);
    else
        look_at_set(shared, of, t->lattice_blocks);
    shared->compared = shared->changes = all ? 0 : shared->changes;
}

void mspringi_shared_records_find(mspring_network *network) {
    const records of = {.arrays = {network->lattice_springs},
                        .count = 1,
                        .values = (size_t)MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH * (network->parts - 1)};
    renew(&network->shared_records, &of, &network->topology);
}

void mspringi_shared_records_find_yielding(mspring_network *network) {
    const mspringi_tested *p = &network->tested;
    const records of = {.arrays = {network->rest_lengths.lengths, p->low, p->high, p->flow_low, p->flow_high},
                        .count = MOST_ARRAYS,
                        .values = (size_t)MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH};
    renew(&network->tested.shared_records, &of, &network->topology);
}

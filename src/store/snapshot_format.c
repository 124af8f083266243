#include "store/snapshot_format.h"

#include <string.h>

#include "base/hash.h"

static const char magic[8] = {'m', 's', 'p', 'r', 'i', 'n', 'g', '\n'};

/* --------------------------------------------------------------------------------------------------- checksum */

uint64_t mspringi_checksum_value(const mspringi_checksum *checksum) {
    uint64_t hash = MSPRINGI_HASH_START;
    for (int lane = 0; lane < MSPRINGI_CHECKSUM_LANES; ++lane) {
        hash = mspringi_hash(hash, checksum->sums[lane]);
        hash = mspringi_hash(hash, checksum->sums_of_sums[lane]);
    }
    return hash;
}

/* ----------------------------------------------------------------------------------------- writing and reading */

mspringi_writer mspringi_writer_begin(uint8_t *snapshot, const mspringi_kernels *kernels) {
    return (mspringi_writer){.at = snapshot, .unsummed = snapshot, .sum = kernels->checksum};
}

void mspringi_copy_reversed(uint8_t *to, const uint8_t *from, size_t size, size_t width) {
    for (size_t i = 0; i < size; i += width)
        for (size_t byte = 0; byte < width; ++byte)
            to[i + byte] = from[i + width - 1 - byte];
}

// First what fills up the unit that is begun, then whole units, then what begins the next one.
static void put_bytes(mspringi_writer *to, const uint8_t *from, size_t size) {
    const size_t begun = (size_t)(to->at - to->unsummed), room = MSPRINGI_CHECKSUM_UNIT - begun;
    if (begun > 0 && size >= room) {
        memcpy(to->at, from, room);
        to->sum(NULL, to->unsummed, 1, &to->checksum);
        to->unsummed = to->at += room;
        from += room;
        size -= room;
    }
    if (to->at == to->unsummed) {
        const size_t units = size / MSPRINGI_CHECKSUM_UNIT, whole = units * MSPRINGI_CHECKSUM_UNIT;
        to->sum(to->at, from, units, &to->checksum);
        to->unsummed = to->at += whole;
        from += whole;
        size -= whole;
    }
    memcpy(to->at, from, size);
    to->at += size;
}

void mspringi_put(mspringi_writer *to, const void *values, size_t count, size_t width) {
    const uint8_t *from = values;
    if (count == 0)
        return;
    if (!to->sum) {
        to->counted += count * width;
        return;
    }
    if (!MSPRINGI_BIG_ENDIAN_HOST) {
        put_bytes(to, from, count * width);
        return;
    }
    for (size_t left = count * width; left > 0;) {
        uint8_t reversed[256]; // whole values
        const size_t size = left < sizeof reversed ? left : sizeof reversed;
        mspringi_copy_reversed(reversed, from, size, width);
        put_bytes(to, reversed, size);
        from += size;
        left -= size;
    }
}

void mspringi_put_zeros(mspringi_writer *to, size_t count) {
    for (size_t i = 0; i < count; ++i)
        mspringi_put(to, &(uint8_t){0}, 1, 1);
}

void mspringi_hand(mspringi_io *io, void *values, size_t count, size_t width) {
    if (io->to) {
        mspringi_put(io->to, values, count, width);
        return;
    }
    io->is_short = io->is_short || io->left < count * width;
    if (io->is_short) {
        memset(values, 0, count * width);
        return;
    }
    io->from = mspringi_get(io->from, values, count, width);
    io->left -= count * width;
}

void mspringi_put_header(mspringi_writer *to, const mspringi_snapshot_header *header) {
    mspringi_put(to, magic, sizeof magic, 1);
    mspringi_put(to, &header->version, 1, 4);
    mspringi_put(to, &header->section_count, 1, 4);
    mspringi_put(to, &header->size, 1, 8);
    mspringi_put(to, &header->contents, 1, 4);
    mspringi_put(to, &header->particle_count, 1, 4);
    mspringi_put(to, &header->spring_count, 1, 4);
    mspringi_put_zeros(to, 4);
    mspringi_put(to, &header->topology_fingerprint, 1, 8);
    mspringi_put(to, &header->parameter_fingerprint, 1, 8);
}

bool mspringi_get_header(const uint8_t *from, mspringi_snapshot_header *header) {
    uint32_t reserved;
    if (memcmp(from, magic, sizeof magic) != 0)
        return false;
    from = mspringi_get(from + sizeof magic, &header->version, 1, 4);
    from = mspringi_get(from, &header->section_count, 1, 4);
    from = mspringi_get(from, &header->size, 1, 8);
    from = mspringi_get(from, &header->contents, 1, 4);
    from = mspringi_get(from, &header->particle_count, 1, 4);
    from = mspringi_get(from, &header->spring_count, 1, 4);
    from = mspringi_get(from, &reserved, 1, 4);
    from = mspringi_get(from, &header->topology_fingerprint, 1, 8);
    mspringi_get(from, &header->parameter_fingerprint, 1, 8);
    return reserved == 0;
}

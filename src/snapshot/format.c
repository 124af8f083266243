#include "format.h"

#include <string.h>

#include "base/mix.h"

static const char magic[8] = {'m', 's', 'p', 'r', 'i', 'n', 'g', '\n'};

/// Bytes that are written before the checksum is taken: half of a first-level cache.
#define CHUNK ((size_t)16 << 10)

/* --------------------------------------------------------------------------------------------------- checksum */

// Fletcher's sums (1982), of 64-bit words modulo 2^64: the first differ when a word is changed, the second when
// words have changed places. Several of them side by side, so that the compiler has vectors to make of them.
void mspringi_checksum_add(mspringi_checksum *checksum, const uint8_t *bytes, size_t units) {
    mspringi_checksum c = *checksum;
    for (size_t i = 0; i < units; ++i, bytes += MSPRINGI_CHECKSUM_UNIT) {
        uint64_t words[MSPRINGI_CHECKSUM_LANES];
        mspringi_get(bytes, words, MSPRINGI_CHECKSUM_LANES, sizeof words[0]);
        for (int lane = 0; lane < MSPRINGI_CHECKSUM_LANES; ++lane) {
            c.sums[lane] += words[lane];
            c.sums_of_sums[lane] += c.sums[lane];
        }
    }
    *checksum = c;
}

uint64_t mspringi_checksum_value(const mspringi_checksum *checksum) {
    uint64_t hash = MSPRINGI_MIX_START;
    for (int lane = 0; lane < MSPRINGI_CHECKSUM_LANES; ++lane) {
        hash = mspringi_mix(hash, checksum->sums[lane]);
        hash = mspringi_mix(hash, checksum->sums_of_sums[lane]);
    }
    return hash;
}

/* ----------------------------------------------------------------------------------------- writing and reading */

mspringi_writer mspringi_writer_begin(uint8_t *snapshot) {
    return (mspringi_writer){.at = snapshot, .unsummed = snapshot};
}

static void sum_up(mspringi_writer *to) {
    const size_t units = (size_t)(to->at - to->unsummed) / MSPRINGI_CHECKSUM_UNIT;
    mspringi_checksum_add(&to->checksum, to->unsummed, units);
    to->unsummed += units * MSPRINGI_CHECKSUM_UNIT;
}

void mspringi_copy_reversed(uint8_t *to, const uint8_t *from, size_t size, size_t width) {
    for (size_t i = 0; i < size; i += width)
        for (size_t byte = 0; byte < width; ++byte)
            to[i + byte] = from[i + width - 1 - byte];
}

void mspringi_put(mspringi_writer *to, const void *values, size_t count, size_t width) {
    const uint8_t *from = values;
    for (size_t left = count * width; left > 0;) {
        const size_t size = left < CHUNK ? left : CHUNK;
        if (MSPRINGI_BIG_ENDIAN_HOST)
            mspringi_copy_reversed(to->at, from, size, width);
        else
            memcpy(to->at, from, size);
        to->at += size;
        from += size;
        left -= size;
        if (to->at - to->unsummed >= MSPRINGI_CHECKSUM_UNIT)
            sum_up(to);
    }
}

void mspringi_put_zeros(mspringi_writer *to, size_t count) {
    for (size_t i = 0; i < count; ++i)
        mspringi_put(to, &(uint8_t){0}, 1, 1);
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
    mspringi_put(to, &header->topology_print, 1, 8);
    mspringi_put(to, &header->parameter_print, 1, 8);
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
    from = mspringi_get(from, &header->topology_print, 1, 8);
    mspringi_get(from, &header->parameter_print, 1, 8);
    return true;
}

/// @file snapshot_format.h
/// How a snapshot lies in memory: little-endian on every machine.
///
///   header    56 bytes: magic, version, number of sections, size, contents, fingerprints, counts
///   sections  each: tag (4 bytes), 0 (4), size (8), that many bytes, and 0 up to a multiple of 8
///   0 up to a multiple of MSPRINGI_CHECKSUM_UNIT
///   checksum  8 bytes, of all before
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SNAPSHOT_FORMAT_H
#define MSPRINGI_SNAPSHOT_FORMAT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "kernels/kernels.h"

/// Grows with each change of the format, so that no library misreads a snapshot of another.
#define MSPRINGI_SNAPSHOT_VERSION 12u
#define MSPRINGI_SNAPSHOT_CHECKSUM_BYTES 8

typedef struct mspringi_snapshot_header {
    uint32_t version, section_count;
    uint64_t size; ///< bytes of all, with the checksum
    uint32_t contents;
    uint32_t particle_count, spring_count;
    uint64_t topology_fingerprint, parameter_fingerprint;
} mspringi_snapshot_header;
#define MSPRINGI_SNAPSHOT_HEADER_BYTES ((size_t)56)

#define MSPRINGI_SECTION_HEADER_BYTES ((size_t)16)

static inline size_t mspringi_round_up(size_t size, size_t unit) {
    return (size + unit - 1) / unit * unit;
}

uint64_t mspringi_checksum_value(const mspringi_checksum *checksum);

/// Writer of a snapshot, with its checksum so far. One of zeros only counts bytes.
typedef struct mspringi_writer {
    size_t counted;
    uint8_t *at;
    const uint8_t *unsummed; ///< start of the unit whose bytes are not in the checksum yet
    mspringi_checksum_fn sum;
    mspringi_checksum checksum;
} mspringi_writer;

mspringi_writer mspringi_writer_begin(uint8_t *snapshot, const mspringi_kernels *kernels);

/// Write count values of width bytes (1, 2, 4 or 8).
void mspringi_put(mspringi_writer *to, const void *values, size_t count, size_t width);

/// Write zeros.
void mspringi_put_zeros(mspringi_writer *to, size_t count);

/// Copy values, and reverse the bytes of each.
void mspringi_copy_reversed(uint8_t *to, const uint8_t *from, size_t size, size_t width);

/// Read values. (Inline, as many are read one by one: called, it took half of loading a frame.)
/// @return the address behind them
static inline const uint8_t *mspringi_get(const uint8_t *from, void *values, size_t count, size_t width) {
    if (MSPRINGI_BIG_ENDIAN_HOST)
        mspringi_copy_reversed(values, from, count * width, width);
    else if (count > 0)
        memcpy(values, from, count * width);
    return from + count * width;
}

/// Values on their way into a snapshot or out of it. One function describes a record by mspringi_hand() for saving,
/// loading and counting.
typedef struct mspringi_io {
    mspringi_writer *to; ///< NULL: they are read
    const uint8_t *from;
    size_t size, left; ///< bytes in all; bytes not read yet
    bool is_short;     ///< too few bytes: the rest was read as 0
} mspringi_io;

void mspringi_hand(mspringi_io *io, void *values, size_t count, size_t width);
#define MSPRINGI_HAND(io, value) mspringi_hand(io, &(value), 1, sizeof(value))

void mspringi_put_header(mspringi_writer *to, const mspringi_snapshot_header *header);
/// @return false if this does not begin as snapshots do; at least MSPRINGI_SNAPSHOT_HEADER_BYTES must be there
bool mspringi_get_header(const uint8_t *from, mspringi_snapshot_header *header);

#endif

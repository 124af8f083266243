/// @file archives.h
/// Archives in memory.
///
/// SPDX-License-Identifier: MIT
#ifndef TEST_ARCHIVES_H
#define TEST_ARCHIVES_H

#include "support.h"

typedef struct archived {
    uint8_t *bytes; ///< to be freed
    size_t size, room;
} archived;

archived archives_write(const mspring_network *network);

/// A network that goes on, with so many workers.
mspring_network *archives_read(const archived *from, uint32_t workers);

/// Write, read, write: the same bytes.
/// @return the network that was read
mspring_network *archives_check_same(const mspring_network *network, uint32_t workers);

/// Where a chunk's bytes are; NULL if there is none.
uint8_t *archives_chunk(const archived *in, const char *tag, size_t *size);

/// Make the checksums of all chunks right again.
void archives_renew(archived *of);

/// True if reading, or making a network, fails with this in the message; then a builder that read nothing is empty.
bool archives_is_refused(const archived *from, const char *part);

#endif

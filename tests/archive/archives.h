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

/// Read an archive. Return its network, with this number of workers.
mspring_network *archives_read(const archived *from, uint32_t workers);

/// Write, read, write: the same bytes.
/// @return the network that was read
mspring_network *archives_check_same(const mspring_network *network, uint32_t workers);

/// Step both networks this many times. They have the same bits after each step, and the same snapshot at the end.
void archives_check_goes_on(mspring_network *network, mspring_network *other, uint32_t steps);

/// Networks that have a bit of everything between them.
enum { ARCHIVES_KINDS = 12 };
mspring_network *archives_make(int kind);

/// Where the bytes of a chunk are; NULL if there is none.
uint8_t *archives_chunk(const archived *in, const char *tag, size_t *size);

/// Make the checksums of all chunks right again, as far as these lie where their sizes say.
void archives_renew(archived *of);

/// Reading it, or making a network of it, fails with MSPRING_ERROR_SNAPSHOT; builder and memory are as before.
/// @return the message, valid until the next call
const char *archives_refused(const archived *from);

#endif

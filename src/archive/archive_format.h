/// @file archive_format.h
/// Bytes of an archive (store/archive.h).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ARCHIVE_FORMAT_H
#define MSPRINGI_ARCHIVE_FORMAT_H

#include "store/archive.h"

#define MSPRINGI_ARCHIVE_HEAD_BYTES ((size_t)16)
#define MSPRINGI_CHUNK_HEAD_BYTES ((size_t)24)

/// First chunk: data that a reader needs before all others.
typedef struct mspringi_archive_head {
    uint32_t first_particle, first_spring, particle_end, spring_end; ///< as in mspringi_reserve
    uint32_t may_have_bundles, is_compact, is_compact_with_bundles, has_welds;
    uint32_t next_collider;
    float shortest_set, grid;
    double shortest;
    uint64_t parameter_fingerprint;
    mspringi_solver_basis basis; ///< of the solver, without its tiles; scale 0: it has none
    mspring_network_def def;
} mspringi_archive_head;

/// Tags of the chunks that are not in features.def: the first, the plan and the last.
extern const char mspringi_head_tag[5], mspringi_plan_tag[5], mspringi_end_tag[5];

mspringi_archive_head mspringi_archive_head_of(const mspring_network *network);
void mspringi_archive_hand_head(mspringi_io *io, mspringi_archive_head *head);

/// Plan: for each first particle two words, where it lay; for each first spring its ends, and flags.
#define MSPRINGI_PLAN_PARTICLE_BYTES ((size_t)8)
#define MSPRINGI_PLAN_SPRING_BYTES ((size_t)9)

/// A chunk in memory.
typedef struct mspringi_read_chunk {
    const char *tag;
    uint32_t version, flags;
    const uint8_t *bytes; ///< NULL: there is none
    size_t size;
} mspringi_read_chunk;

uint64_t mspringi_chunk_hash(const uint8_t head[MSPRINGI_CHUNK_HEAD_BYTES], const uint8_t *bytes, size_t size);

/// Find a chunk in an archive that was checked.
mspringi_read_chunk mspringi_archive_find(const uint8_t *archive, const char *tag);
/// Read the chunk at *at, and move on. False: it leaves the archive.
bool mspringi_archive_next(const uint8_t *archive, size_t size, size_t *at, mspringi_read_chunk *chunk);

/// Archive in a builder: its head and a copy of its bytes.
typedef struct mspringi_archive {
    mspringi_archive_head head;
    size_t size;
    uint8_t bytes[];
} mspringi_archive;

/// Form of a section in archives; NULL: the same as in snapshots.
const mspringi_by_id *mspringi_by_id_of(const mspringi_section *section);

/// Return the size of a section by id (is_archived) or for this network, given its bytes in the other form.
/// SIZE_MAX if these are too few or too many.
size_t mspringi_by_id_size(const mspring_network *network, const mspringi_by_id *by, bool is_archived,
                           const uint8_t *from, size_t size);
/// Translate a section into the other form. `to` holds zeros: that size, plus the size of the network's own section
/// (mspringi_by_id.enter). False: the section names particles that do not exist.
bool mspringi_by_id_translate(const mspring_network *network, const mspringi_by_id *by, bool is_archived,
                              const uint8_t *from, size_t size, uint8_t *to);

#endif

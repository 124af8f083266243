/// @file archive.h
/// Archives: files that all later versions read.
///
///   head     16 bytes: magic, version of the format, 0
///   chunks   each: tag (4 bytes), version (2), flags (2), size (8), hash (8) of head and contents, then contents
///   the last chunk has the tag "end." and no bytes
///
/// All is little-endian. A chunk is one of these:
///
///   netw   definition, counts and bounds of the network (archive/archive_format.c)
///   plan   ends and flags of the first springs, and where the layout had the first particles
///   a row of features.def: CHUNK, or SECTION, whose bytes are those of a snapshot, but by id (BY_ID)
///
/// Rules for versions. A chunk may grow at its end: readers check that the bytes that they know are there, and
/// ignore those behind. A section has the size that its check asks for. A section that changes gets a version of
/// its own instead of MSPRINGI_CHUNK_VERSION. The reader converts the old one before mspringi_by_id.enter, as
/// settings_enter() does for settings that were added. Chunks of unknown tag or later version are skipped and
/// counted, unless MSPRINGI_CHUNK_IS_NEEDED. tests/archive/files has files of each version, which are never
/// renewed.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ARCHIVE_H
#define MSPRINGI_ARCHIVE_H

#include "builder/builder.h"
#include "store/sections.h"

/// Version of the format of files, and of the chunks that this library writes.
#define MSPRINGI_ARCHIVE_VERSION 1u
#define MSPRINGI_CHUNK_VERSION 1u

/// Flags of a chunk: without it the network would be another one.
#define MSPRINGI_CHUNK_IS_NEEDED 1u

/// A part of a network that has no section, but a chunk of archives.
typedef struct mspringi_chunk {
    char tag[5];
    const char *name; ///< of its contents, for messages
    /// Write it; nothing if the network has no such data.
    void (*save)(const mspring_network *network, mspringi_io *io);
    /// Load it into a new network, which has no such data yet. It may come from anywhere.
    mspring_result (*load)(mspring_network *network, mspringi_io *io);
    /// A section that needs it, and is loaded right after it. NULL: there is none, and it is loaded before the
    /// sections.
    const mspringi_section *section;
} mspringi_chunk;

#define CHUNK(name) extern const mspringi_chunk mspringi_chunk_##name;
#include "store/features.def"

/// All of them, and NULL.
extern const mspringi_chunk *const mspringi_chunks[];

/// Read an array of a chunk: NULL if it is too short or memory is out, and then *result says so. Free it.
void *mspringi_chunk_array(mspring_network *network, mspringi_io *io, size_t count, size_t width,
                           mspring_result *result);

/// Room for events that an archive may ask for: more than a network of its size has use for is cut.
static inline uint32_t mspringi_chunk_room(const mspring_network *network, uint32_t asked) {
    const mspringi_reserve *r = &network->topology.reserve;
    const uint32_t ids = r->particle_end + r->spring_end, most = ids > 0x10000 ? ids : 0x10000;
    return asked < most ? asked : most;
}

/// Calls of mspring_network_create() for a builder that has read an archive. They are behind pointers, so that
/// programs that read none are linked without them (41 kB).
typedef struct mspringi_archive_calls {
    /// Complete the given definition of a network from the builder's archive. NULL: take the archive's.
    mspring_result (*take_def)(mspring_builder *builder, const mspring_network_def *given,
                               mspring_network_def *def);
    /// The builder whose particles lie where the archived layout had them. Its particles are made in this memory.
    mspring_result (*lay_out)(const mspring_builder *builder, mspringi_memory *memory, mspringi_message *message,
                              mspring_builder *placed);
    /// Turn a failure into one of the archive, since the host's arguments are correct. chunk: name of its contents;
    /// NULL: the message is that of a section, and names a snapshot.
    mspring_result (*blame)(mspringi_message *message, mspring_result result, const char *chunk);
    /// True if the archived layout was one that may have bundles.
    bool (*may_have_bundles)(const mspring_builder *builder);
    /// Load the rest of the archive into a new network: all but particles and springs.
    mspring_result (*resume)(mspring_network *network, const mspring_builder *builder,
                             const mspring_network_def *given);
} mspringi_archive_calls;
extern const mspringi_archive_calls mspringi_archive_resuming; // archive/archive_resume.c

#endif

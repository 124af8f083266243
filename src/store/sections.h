/// @file sections.h
/// What snapshots hold: a section for each thing that the next step depends on.
///
/// Whoever adds something of that kind, a solver with a history for instance, adds a section for it to
/// features.def. What follows from other things (springs' values in N/m from relative ones, say) needs none.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SNAPSHOT_SECTIONS_H
#define MSPRINGI_SNAPSHOT_SECTIONS_H

#include "store/network.h"
#include "store/snapshot_format.h"

static inline mspringi_io mspringi_io_to(mspringi_writer *to) {
    return (mspringi_io){.to = to};
}
static inline mspringi_io mspringi_io_from(const uint8_t *from, size_t size) {
    return (mspringi_io){.from = from, .size = size, .left = size};
}

/// Particles and springs of a snapshot, for sections that refer to them.
typedef struct mspringi_saved {
    const mspring_network *network;
    const uint8_t *growth; ///< its section, NULL: all is there
    const uint8_t *live;   ///< section of broken springs, NULL: none is broken
    const void *in;        ///< for mspringi_saved_section()
} mspringi_saved;

typedef struct mspringi_section {
    char tag[5];      ///< 4 letters
    const char *name; ///< what is in it, for messages
    bool parameters;  ///< only edits change it: left out of MSPRING_SNAPSHOT_FRAME

    /// Writes nothing if the network has none of it: then there is no such section. size: what that comes to, for
    /// those that would take long only to be counted; NULL: they are saved to a writer that counts.
    size_t (*size)(const mspring_network *network);
    void (*save)(const mspring_network *network, mspringi_writer *to);

    /// Refuse what a network must not hold, and allocate what load() needs. A section that is not in the snapshot
    /// has size 0. Must not change what a step does.
    mspring_result (*check)(mspring_network *network, const uint8_t *from, size_t size);
    /// Put it into force; after check(). Size 0: the network is to have none of it.
    void (*load)(mspring_network *network, const uint8_t *from, size_t size);

    /// Refuse what contradicts other sections; after all checks. NULL: nothing can.
    mspring_result (*check_against)(mspring_network *network, const mspringi_saved *saved, const uint8_t *from,
                                    size_t size);
} mspringi_section;

/// True if the snapshot has a particle or a spring (snapshot_id_pool.c); true if that spring is unbroken
/// (snapshot_springs.c). Ids are below the end of the reserve.
bool mspringi_saved_has_particle(const mspringi_saved *saved, mspring_id particle);
bool mspringi_saved_has_spring(const mspringi_saved *saved, mspring_id spring);
bool mspringi_saved_is_whole(const mspringi_saved *saved, mspring_id spring);
/// Bytes of another section, whose check has passed; of size 0 if the network is to have none of it. False: it
/// stays as it is, as in a frame.
bool mspringi_saved_section(const mspringi_saved *saved, const struct mspringi_section *section,
                            const uint8_t **from, size_t *size);
/// Place of a spring in the snapshot.
mspringi_spring_slot mspringi_saved_place(const mspringi_saved *saved, mspring_id spring);

#define SECTION(name) extern const mspringi_section mspringi_section_##name;
#include "store/features.def"

/// Fail with what is wrong with a section.
mspring_result mspringi_section_fail(mspring_network *network, const mspringi_section *section, const char *format,
                                     ...) MSPRINGI_PRINTF(3, 4);

/// Refuse another size than the expected one.
mspring_result mspringi_section_check_size(mspring_network *network, const mspringi_section *section, size_t size,
                                           size_t expected);
/// Refuse a section of which too little was there, or something is left.
mspring_result mspringi_section_end(mspring_network *network, const mspringi_section *section,
                                    const mspringi_io *io);

/// Value number index of a section's array.
static inline float mspringi_float_at(const uint8_t *from, size_t index) {
    float value;
    mspringi_get(from + index * sizeof value, &value, 1, sizeof value);
    return value;
}

#endif

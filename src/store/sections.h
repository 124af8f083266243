/// @file sections.h
/// Sections of snapshots: one for each part of a network's state and parameters.
///
/// Data on which the next step depends, as the history of a solver, need a section, listed in features.def. Derived
/// data, as the stiffness of relative springs, need none.
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
    const uint8_t *growth; ///< section of added and removed ids, NULL: all exist
    const uint8_t *live;   ///< section of broken springs, NULL: none is broken
    const void *in;        ///< for mspringi_saved_section()
} mspringi_saved;

typedef struct mspringi_section {
    char tag[5];      ///< 4 letters
    const char *name; ///< name of its contents, for messages
    bool parameters;  ///< changed by edits only: MSPRING_SNAPSHOT_FRAME leaves it out

    /// save: write the section; nothing if the network has no such data: then the snapshot has no such section.
    /// size: its bytes, if saving only to count them would take long; NULL: count by a save without output.
    size_t (*size)(const mspring_network *network);
    void (*save)(const mspring_network *network, mspringi_writer *to);

    /// Refuse invalid data, and allocate what load() needs. A section that is not in the snapshot has size 0.
    /// Change nothing that a step depends on.
    mspring_result (*check)(mspring_network *network, const uint8_t *from, size_t size);
    /// Load the section after check(), without errors. Size 0: clear the network's data.
    void (*load)(mspring_network *network, const uint8_t *from, size_t size);

    /// Refuse contradictions with other sections, after all checks. NULL: there can be none.
    mspring_result (*check_against)(mspring_network *network, const mspringi_saved *saved, const uint8_t *from,
                                    size_t size);
} mspringi_section;

/// True if the snapshot has a particle or a spring (snapshot_id_pool.c); true if that spring is unbroken
/// (snapshot_springs.c). Ids are below the end of the reserve.
bool mspringi_saved_has_particle(const mspringi_saved *saved, mspring_id particle);
bool mspringi_saved_has_spring(const mspringi_saved *saved, mspring_id spring);
bool mspringi_saved_is_whole(const mspringi_saved *saved, mspring_id spring);
/// Find the bytes of another section, whose check has passed; size 0 if it clears the data. False: the snapshot, a
/// frame, leaves them as they are.
bool mspringi_saved_section(const mspringi_saved *saved, const struct mspringi_section *section,
                            const uint8_t **from, size_t *size);
/// Spring slot of a spring in the snapshot.
mspringi_spring_slot mspringi_saved_place(const mspringi_saved *saved, mspring_id spring);

#define SECTION(name) extern const mspringi_section mspringi_section_##name;
#include "store/features.def"

/// Fail with what is wrong with a section.
mspring_result mspringi_section_fail(mspring_network *network, const mspringi_section *section, const char *format,
                                     ...) MSPRINGI_PRINTF(3, 4);

/// Refuse another size than the expected one.
mspring_result mspringi_section_check_size(mspring_network *network, const mspringi_section *section, size_t size,
                                           size_t expected);
/// Refuse a section that was too short or too long.
mspring_result mspringi_section_end(mspring_network *network, const mspringi_section *section,
                                    const mspringi_io *io);

/// Element `index` of a section's array of floats.
static inline float mspringi_float_at(const uint8_t *from, size_t index) {
    float value;
    mspringi_get(from + index * sizeof value, &value, 1, sizeof value);
    return value;
}

#endif

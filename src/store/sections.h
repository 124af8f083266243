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

/// All sections, in the order of loading.
enum {
#define SECTION(name) MSPRINGI_SECTION_##name,
#include "store/features.def"
    MSPRINGI_SECTIONS
};
extern const mspringi_section *const mspringi_sections[MSPRINGI_SECTIONS];

/// Bytes of a section as the network would save it now; 0: it has none.
size_t mspringi_section_size(const mspring_network *network, const mspringi_section *section);

/// Where each section of a snapshot lies; size 0 if it has none.
typedef struct mspringi_found {
    const uint8_t *from[MSPRINGI_SECTIONS];
    size_t size[MSPRINGI_SECTIONS];
} mspringi_found;

/// Check sections one by one; then check them against each other, and load all of them or, on error, none.
mspring_result mspringi_sections_check(mspring_network *network, const mspringi_snapshot_header *header,
                                       const mspringi_found *in);
mspring_result mspringi_sections_load(mspring_network *network, const mspringi_snapshot_header *header,
                                      const mspringi_found *in);

/// A part of a section.
typedef struct mspringi_run {
    enum {
        MSPRINGI_BYTES,  ///< `count` bytes, the same in any layout
        MSPRINGI_FLOATS, ///< `count` arrays of floats by slot
        MSPRINGI_BITS,   ///< a bit for each spring, by spring slot, in whole words of 16
        MSPRINGI_SLOTS   ///< `count` slots, each with a double
    } kind;
    size_t count;
} mspringi_run;
#define MSPRINGI_MOST_RUNS 4
/// Bytes up to the end.
#define MSPRINGI_THE_REST SIZE_MAX

/// A section in an archive: what lies by slot in a snapshot lies by id, so that any layout can load it
/// (archive/by_id.c).
typedef struct mspringi_by_id {
    const mspringi_section *section;
    /// List the parts of a section, from its head. NULL: it has bytes only. Bytes that are not there read as 0.
    uint32_t (*runs)(const mspring_network *network, mspringi_io head, mspringi_run runs[MSPRINGI_MOST_RUNS]);
    /// Adapt what else depends on the layout: in a section for the archive, and in one for this network. NULL:
    /// nothing does. Return the size of the section, at most `size`.
    void (*leave)(const mspring_network *network, uint8_t *section, size_t size);
    size_t (*enter)(const mspring_network *network, uint8_t *section, size_t size);
} mspringi_by_id;
#define BY_ID(name) extern const mspringi_by_id mspringi_by_id_##name;
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

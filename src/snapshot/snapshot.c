/// Saving and loading snapshots.
#include <stdarg.h>
#include <string.h>

#include "base/assert.h"
#include "base/cpu.h"
#include "store/changed.h"
#include "store/feature.h"
#include "store/sections.h"

const mspringi_section *const mspringi_sections[MSPRINGI_SECTIONS] = {
#define SECTION(name) &mspringi_section_##name,
#include "store/features.def"
};

/* --------------------------------------------------------------------------------------------------- messages */

mspring_result mspringi_section_fail(mspring_network *network, const mspringi_section *section, const char *format,
                                     ...) {
    char what[160];
    va_list arguments;
    va_start(arguments, format);
    mspringi_format(what, sizeof what, format, arguments);
    va_end(arguments);
    return mspringi_fail(&network->message, MSPRING_ERROR_SNAPSHOT, "the snapshot's %s: %s", section->name, what);
}

mspring_result mspringi_section_check_size(mspring_network *network, const mspringi_section *section, size_t size,
                                           size_t expected) {
    return size == expected
               ? MSPRING_OK
               : mspringi_section_fail(network, section, "they take %zu bytes instead of %zu", size, expected);
}

mspring_result mspringi_section_end(mspring_network *network, const mspringi_section *section,
                                    const mspringi_io *io) {
    return !io->is_short && io->left == 0
               ? MSPRING_OK
               : mspringi_section_fail(network, section, "they take %zu bytes, which are too %s", io->size,
                                       io->is_short ? "few" : "many");
}

static mspring_result fail(mspring_network *network, const char *what) {
    return mspringi_fail(&network->message, MSPRING_ERROR_SNAPSHOT, "the snapshot %s", what);
}

/* ------------------------------------------------------------------------------------------------------ saving */

size_t mspringi_section_size(const mspring_network *network, const mspringi_section *section) {
    mspringi_writer counts = {0};
    if (section->size)
        return section->size(network);
    section->save(network, &counts);
    return counts.counted;
}

static size_t section_size(const mspring_network *network, const mspringi_section *section,
                           mspring_snapshot_contents contents) {
    return section->parameters && contents == MSPRING_SNAPSHOT_FRAME ? 0 : mspringi_section_size(network, section);
}

static size_t total_size(const mspring_network *network, mspring_snapshot_contents contents, uint32_t *count) {
    size_t size = MSPRINGI_SNAPSHOT_HEADER_BYTES;
    *count = 0;
    for (int i = 0; i < MSPRINGI_SECTIONS; ++i) {
        const size_t of_section = section_size(network, mspringi_sections[i], contents);
        if (of_section == 0)
            continue;
        size += MSPRINGI_SECTION_HEADER_BYTES + mspringi_round_up(of_section, 8);
        ++*count;
    }
    return mspringi_round_up(size, MSPRINGI_CHECKSUM_UNIT) + MSPRINGI_SNAPSHOT_CHECKSUM_BYTES;
}

static mspring_result check_save(const mspring_network *network, mspring_snapshot_contents contents,
                                 const void *out) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_shared_message *shared = network->shared;
    if (contents != MSPRING_SNAPSHOT_ALL && contents != MSPRING_SNAPSHOT_FRAME)
        return mspringi_shared_fail(shared, MSPRING_ERROR_ARGUMENT, "a snapshot has no contents %d", (int)contents);
    if (!out)
        return mspringi_shared_fail(shared, MSPRING_ERROR_ARGUMENT,
                                    "the place for the snapshot or its size is NULL");
    return network->in_hook == MSPRINGI_IN_NO_HOOK
               ? MSPRING_OK
               : mspringi_shared_fail(shared, MSPRING_ERROR_BUSY, "no snapshot is saved inside a hook");
}

mspring_result mspring_network_get_snapshot_size(const mspring_network *network, mspring_snapshot_contents contents,
                                                 size_t *size) {
    uint32_t count;
    mspring_result result = check_save(network, contents, size);
    if (result == MSPRING_OK)
        *size = total_size(network, contents, &count);
    return result;
}

// Write a section with its header and padding.
static void put_section(const mspring_network *network, const mspringi_section *section, uint64_t size,
                        mspringi_writer *to) {
    mspringi_put(to, section->tag, 4, 1);
    mspringi_put_zeros(to, 4);
    mspringi_put(to, &size, 1, sizeof size);
    const uint8_t *const begin = to->at;
    section->save(network, to);
    MSPRINGI_ASSERT((size_t)(to->at - begin) == size);
    mspringi_put_zeros(to, mspringi_round_up((size_t)size, 8) - (size_t)size);
}

mspring_result mspring_network_save(const mspring_network *network, mspring_snapshot_contents contents,
                                    void *snapshot, size_t capacity, size_t *size) {
    mspring_result result = check_save(network, contents, snapshot);
    if (result != MSPRING_OK)
        return result;
    mspringi_snapshot_header header = {
        .version = MSPRINGI_SNAPSHOT_VERSION,
        .contents = (uint32_t)contents,
        .particle_count = network->topology.reserve.particle_end,
        .spring_count = network->topology.reserve.spring_end,
        .topology_fingerprint = network->topology_fingerprint,
        .parameter_fingerprint = network->parameter_fingerprint,
    };
    const size_t total = total_size(network, contents, &header.section_count);
    if (capacity < total)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT,
                                    "the snapshot has %zu bytes, there is room for %zu", total, capacity);
    header.size = total;
    mspringi_writer to = mspringi_writer_begin(snapshot, network->kernels);
    mspringi_put_header(&to, &header);
    for (int i = 0; i < MSPRINGI_SECTIONS; ++i) {
        const size_t of_section = section_size(network, mspringi_sections[i], contents);
        if (of_section > 0)
            put_section(network, mspringi_sections[i], of_section, &to);
    }
    const size_t written = (size_t)(to.at - (uint8_t *)snapshot);
    mspringi_put_zeros(&to, total - MSPRINGI_SNAPSHOT_CHECKSUM_BYTES - written);
    const uint64_t checksum = mspringi_checksum_value(&to.checksum);
    mspringi_put(&to, &checksum, 1, sizeof checksum);
    if (size)
        *size = total;
    return MSPRING_OK;
}

/* ----------------------------------------------------------------------------------------------------- loading */

static mspring_result check_frame(mspring_network *network, const uint8_t *snapshot, size_t size,
                                  mspringi_snapshot_header *header) {
    if (size < MSPRINGI_SNAPSHOT_HEADER_BYTES)
        return fail(network, "is too short to be one");
    if (!mspringi_get_header(snapshot, header))
        return fail(network, "does not begin as one: it is something else, or damaged");
    if (header->version != MSPRINGI_SNAPSHOT_VERSION)
        return mspringi_fail(&network->message, MSPRING_ERROR_SNAPSHOT,
                             "the snapshot has version %u, this library knows version %u",
                             (unsigned)header->version, (unsigned)MSPRINGI_SNAPSHOT_VERSION);
    if (header->size != size)
        return mspringi_fail(&network->message, MSPRING_ERROR_SNAPSHOT,
                             "the snapshot has %zu bytes, but was saved with %llu: it is cut off, or damaged", size,
                             (unsigned long long)header->size);
    const size_t summed = size - MSPRINGI_SNAPSHOT_CHECKSUM_BYTES;
    if (summed % MSPRINGI_CHECKSUM_UNIT != 0)
        return fail(network, "is damaged: it has no size that snapshots have");
    uint64_t expected;
    mspringi_checksum checksum = {{0}, {0}};
    mspringi_get(snapshot + summed, &expected, 1, sizeof expected);
    network->kernels->checksum(NULL, snapshot, summed / MSPRINGI_CHECKSUM_UNIT, &checksum);
    if (mspringi_checksum_value(&checksum) != expected)
        return fail(network, "is damaged: its checksum does not fit");
    return MSPRING_OK;
}

static mspring_result check_compatible(mspring_network *network, const mspringi_snapshot_header *header) {
    const mspringi_reserve *r = &network->topology.reserve;
    if (header->particle_count != r->particle_end || header->spring_count != r->spring_end)
        return mspringi_fail(&network->message, MSPRING_ERROR_SNAPSHOT,
                             "the snapshot is of %u particles and %u springs, spare ones counted, the network has "
                             "%u and %u",
                             (unsigned)header->particle_count, (unsigned)header->spring_count,
                             (unsigned)r->particle_end, (unsigned)r->spring_end);
    if (header->topology_fingerprint != network->topology_fingerprint)
        return fail(network, "is of another network: its springs join other particles, or are laid out otherwise");
    if (header->contents == MSPRING_SNAPSHOT_FRAME &&
        header->parameter_fingerprint != network->parameter_fingerprint)
        return fail(network, "leaves out stiffness, damping, rest lengths, strains, areas and angles "
                             "(MSPRING_SNAPSHOT_FRAME), and the network's are others than when it was saved");
    return header->contents == MSPRING_SNAPSHOT_FRAME || header->contents == MSPRING_SNAPSHOT_ALL
               ? MSPRING_OK
               : fail(network, "has contents that this library does not know");
}

static int number_of(const uint8_t *tag) {
    for (int i = 0; i < MSPRINGI_SECTIONS; ++i)
        if (memcmp(tag, mspringi_sections[i]->tag, 4) == 0)
            return i;
    return -1;
}

static mspring_result find_sections(mspring_network *network, const mspringi_snapshot_header *header,
                                    const uint8_t *snapshot, mspringi_found *out) {
    const uint8_t *at = snapshot + MSPRINGI_SNAPSHOT_HEADER_BYTES;
    size_t left = (size_t)header->size - MSPRINGI_SNAPSHOT_HEADER_BYTES - MSPRINGI_SNAPSHOT_CHECKSUM_BYTES;
    *out = (mspringi_found){.size = {0}};
    for (uint32_t i = 0, next = 0; i < header->section_count; ++i) {
        uint64_t size = 0;
        const int number = left >= MSPRINGI_SECTION_HEADER_BYTES ? number_of(at) : -1;
        if (number < 0)
            return fail(network, "has a section that this library does not know");
        mspringi_get(at + 8, &size, 1, sizeof size);
        left -= MSPRINGI_SECTION_HEADER_BYTES;
        at += MSPRINGI_SECTION_HEADER_BYTES;
        if (size == 0 || size > left || left - size < mspringi_round_up((size_t)size, 8) - size ||
            (uint32_t)number < next)
            return mspringi_section_fail(network, mspringi_sections[number],
                                         "they do not fit in, or come twice or too late");
        next = (uint32_t)number + 1;
        out->from[number] = at;
        out->size[number] = (size_t)size;
        left -= mspringi_round_up((size_t)size, 8);
        at += mspringi_round_up((size_t)size, 8);
    }
    return MSPRING_OK;
}

static bool are_zeros(const uint8_t *from, size_t size) {
    uint8_t others = 0;
    for (size_t i = 0; i < size; ++i)
        others |= from[i];
    return others == 0;
}

// Check the bytes without meaning: in the headers of sections, and behind each section.
static mspring_result check_unused(mspring_network *network, const mspringi_snapshot_header *header,
                                   const uint8_t *snapshot, const mspringi_found *in) {
    const uint8_t *const end = snapshot + header->size - MSPRINGI_SNAPSHOT_CHECKSUM_BYTES;
    const uint8_t *at = snapshot + MSPRINGI_SNAPSHOT_HEADER_BYTES;
    for (int i = 0; i < MSPRINGI_SECTIONS; ++i) {
        const size_t size = in->size[i], padding = mspringi_round_up(size, 8) - size;
        if (size == 0)
            continue;
        at = in->from[i] + size + padding;
        if (!are_zeros(in->from[i] - 12, 4) || !are_zeros(at - padding, padding))
            return mspringi_section_fail(network, mspringi_sections[i], "unused bytes are not 0");
    }
    const size_t left = (size_t)(end - at);
    return left < MSPRINGI_CHECKSUM_UNIT && are_zeros(at, left)
               ? MSPRING_OK
               : fail(network, "has something behind its last section");
}

// True if a section is loaded. A frame has no parameters; they stay as they are.
static bool concerns(const mspringi_section *section, const mspringi_snapshot_header *header) {
    return !section->parameters || header->contents == MSPRING_SNAPSHOT_ALL;
}

typedef struct saved_sections {
    const mspringi_found *in;
    const mspringi_snapshot_header *header;
} saved_sections;

bool mspringi_saved_section(const mspringi_saved *saved, const mspringi_section *section, const uint8_t **from,
                            size_t *size) {
    const saved_sections *all = saved->in;
    for (int i = 0; i < MSPRINGI_SECTIONS; ++i) {
        if (mspringi_sections[i] != section || !concerns(section, all->header))
            continue;
        *from = all->in->from[i];
        *size = all->in->size[i];
        return true;
    }
    return false;
}

// Check the sections against each other.
static mspring_result check_together(mspring_network *network, const mspringi_snapshot_header *header,
                                     const mspringi_found *in) {
    mspringi_saved saved = {.network = network, .in = &(saved_sections){in, header}};
    mspring_result result = MSPRING_OK;
    for (int i = 0; i < MSPRINGI_SECTIONS; ++i) {
        if (mspringi_sections[i] == &mspringi_section_growth && in->size[i] > 0)
            saved.growth = in->from[i];
        if (mspringi_sections[i] == &mspringi_section_broken && in->size[i] > 0)
            saved.live = in->from[i];
    }
    for (int i = 0; result == MSPRING_OK && i < MSPRINGI_SECTIONS; ++i)
        if (mspringi_sections[i]->check_against && concerns(mspringi_sections[i], header))
            result = mspringi_sections[i]->check_against(network, &saved, in->from[i], in->size[i]);
    return result;
}

mspring_result mspringi_sections_check(mspring_network *network, const mspringi_snapshot_header *header,
                                       const mspringi_found *in) {
    mspring_result result = MSPRING_OK;
    for (int i = 0; result == MSPRING_OK && i < MSPRINGI_SECTIONS; ++i)
        if (concerns(mspringi_sections[i], header))
            result = mspringi_sections[i]->check(network, in->from[i], in->size[i]);
    return result;
}

mspring_result mspringi_sections_load(mspring_network *network, const mspringi_snapshot_header *header,
                                      const mspringi_found *in) {
    const mspring_result result = check_together(network, header, in);
    if (result != MSPRING_OK)
        return result;
    mspringi_notify_change(network, MSPRINGI_CHANGED_PLACES, 0);
    for (int i = 0; i < MSPRINGI_SENT_COUNT; ++i)
        mspringi_sent_forget(&network->sent[i]);
#define LOADS(function) function(network);
#include "store/features.def"
    for (int i = 0; i < MSPRINGI_SECTIONS; ++i)
        if (concerns(mspringi_sections[i], header))
            mspringi_sections[i]->load(network, in->from[i], in->size[i]);
    network->parameter_fingerprint = header->parameter_fingerprint;
#define LOADED(function) function(network);
#include "store/features.def"
    return MSPRING_OK;
}

static MSPRINGI_NOINLINE mspring_result load(mspring_network *network, const uint8_t *snapshot, size_t size) {
    mspringi_snapshot_header header = {0};
    mspringi_found in;
    mspring_result result = check_frame(network, snapshot, size, &header);
    if (result == MSPRING_OK)
        result = check_compatible(network, &header);
    if (result == MSPRING_OK)
        result = find_sections(network, &header, snapshot, &in);
    if (result == MSPRING_OK)
        result = mspringi_sections_check(network, &header, &in);
    if (result == MSPRING_OK)
        result = check_unused(network, &header, snapshot, &in);
    return result == MSPRING_OK ? mspringi_sections_load(network, &header, &in) : result;
}

mspring_result mspring_network_load(mspring_network *network, const void *snapshot, size_t size) {
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    if (!snapshot)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "the snapshot is NULL");
    const mspringi_fp_state before = mspringi_fp_enter();
    result = load(network, snapshot, size);
    mspringi_fp_leave(before);
    return result;
}

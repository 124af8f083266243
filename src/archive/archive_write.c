/// Writing of archives.
#include <string.h>

#include "archive/archive_format.h"
#include "base/cpu.h"
#include "store/springs.h"

// An archive on its way to the host.
typedef struct archiver {
    const mspring_network *network;
    mspring_write_fn write;
    void *user;
    mspringi_memory memory; ///< of the chunk that is written
} archiver;

static mspring_result no_memory(const archiver *a) {
    return mspringi_shared_fail(a->network->shared, MSPRING_ERROR_MEMORY, "no memory for a chunk of the archive");
}

static mspring_result put(const archiver *a, const void *bytes, size_t size) {
    const mspring_result result = size > 0 ? a->write(bytes, size, a->user) : MSPRING_OK;
    return result == MSPRING_OK
               ? result
               : mspringi_shared_fail(a->network->shared, result,
                                      "the host's function returned %d for %zu bytes of the archive", (int)result,
                                      size);
}

static mspring_result put_chunk(const archiver *a, const char *tag, bool is_needed, const uint8_t *bytes,
                                size_t size) {
    uint8_t head[MSPRINGI_CHUNK_HEAD_BYTES];
    const uint16_t words[] = {MSPRINGI_CHUNK_VERSION, is_needed ? MSPRINGI_CHUNK_IS_NEEDED : 0};
    const uint64_t bytes_of_chunk = size;
    mspringi_writer to = mspringi_writer_begin(head, a->network->kernels);
    mspringi_put(&to, tag, 4, 1);
    mspringi_put(&to, words, 2, sizeof words[0]);
    mspringi_put(&to, &bytes_of_chunk, 1, sizeof bytes_of_chunk);
    const uint64_t hash = mspringi_chunk_hash(head, bytes, size);
    mspringi_put(&to, &hash, 1, sizeof hash);
    const mspring_result result = put(a, head, sizeof head);
    return result == MSPRING_OK ? put(a, bytes, size) : result;
}

// Write a chunk by a function that hands its values, called twice: to count its bytes, and to write them.
static mspring_result put_handed(archiver *a, const char *tag, bool is_needed,
                                 mspring_result (*hand)(archiver *a, const void *what, mspringi_io *io),
                                 const void *what) {
    mspringi_writer counts = {0};
    mspringi_io io = mspringi_io_to(&counts);
    mspring_result result = hand(a, what, &io);
    if (result != MSPRING_OK || counts.counted == 0)
        return result;
    uint8_t *bytes = mspringi_alloc_unset(&a->memory, counts.counted, 1);
    if (!bytes)
        return no_memory(a);
    mspringi_writer to = mspringi_writer_begin(bytes, a->network->kernels);
    io = mspringi_io_to(&to);
    result = hand(a, what, &io);
    if (result == MSPRING_OK)
        result = put_chunk(a, tag, is_needed, bytes, counts.counted);
    mspringi_free(&a->memory, bytes);
    return result;
}

static mspring_result hand_chunk(archiver *a, const void *what, mspringi_io *io) {
    const mspringi_chunk *chunk = what;
    chunk->save(a->network, io);
    return MSPRING_OK;
}

static mspring_result hand_head(archiver *a, const void *what, mspringi_io *io) {
    mspringi_archive_head head = mspringi_archive_head_of(a->network);
    (void)what;
    mspringi_archive_hand_head(io, &head);
    return MSPRING_OK;
}

/* --------------------------------------------------------------------------------------------------------- plan */

// Places that give this layout again: those of grids by row and column, all others on a diagonal on the other side,
// in the order of their slots (as network/survivors.c has them).
static void find_places(const mspringi_topology *t, const mspring_id *particle_of_slot, int32_t (*places)[2]) {
    for (mspring_id p = 0; p < t->reserve.first_particle; ++p)
        places[p][0] = places[p][1] = (int32_t)(-10 - 3 * (int64_t)t->slot_of_particle[p]);
    for (uint32_t i = 0; i < t->lattice_rows; ++i)
        for (uint32_t k = t->rows[i].first_span; k < t->rows[i].first_span + t->rows[i].span_count; ++k)
            for (uint32_t slot = t->spans[k].first_slot; slot < t->spans[k].end_slot; ++slot) {
                const mspring_id p = particle_of_slot[slot];
                if (p == MSPRING_NONE)
                    continue;
                places[p][0] = (int32_t)(slot + t->spans[k].carry);
                places[p][1] = (int32_t)(i + 2 * t->grid_of_row[i]);
            }
}

// The ends in the order in which they were given.
static void hand_spring(const mspring_network *network, const mspringi_topology *whole,
                        const mspring_id *particle_of_slot, mspring_id s, mspringi_io *io) {
    uint32_t base, tip;
    mspringi_topology_ends(whole, whole->slot_of_spring[s], &base, &tip);
    const mspring_id a = particle_of_slot[base], b = particle_of_slot[tip];
    const bool is_reversed = network->is_reversed && network->is_reversed[s / 8] >> s % 8 & 1;
    mspring_id ends[2] = {a < b ? a : b, a < b ? b : a};
    if (is_reversed) {
        const mspring_id first = ends[0];
        ends[0] = ends[1];
        ends[1] = first;
    }
    uint8_t flags = (uint8_t)((mspringi_spring_is_relative(network, s) ? MSPRING_SPRING_RELATIVE : 0u) |
                              mspringi_side_flags(network, s));
    mspringi_hand(io, ends, 2, sizeof ends[0]);
    MSPRINGI_HAND(io, flags);
}

static mspring_result hand_plan(archiver *a, const void *what, mspringi_io *io) {
    const mspring_network *network = a->network;
    const mspringi_topology *whole = network->is_compact ? &network->whole : &network->topology;
    const uint32_t particles = whole->reserve.first_particle, springs = whole->reserve.first_spring;
    const size_t slots = (size_t)whole->block_count * MSPRINGI_WIDTH;
    (void)what;
    if (!io->to->sum) {
        io->to->counted = particles * MSPRINGI_PLAN_PARTICLE_BYTES + springs * MSPRINGI_PLAN_SPRING_BYTES;
        return MSPRING_OK;
    }
    mspring_id *of_slot = mspringi_alloc_unset(&a->memory, slots, sizeof *of_slot);
    int32_t(*places)[2] = mspringi_alloc_unset(&a->memory, particles, sizeof *places);
    for (size_t slot = 0; of_slot && slot < slots; ++slot)
        of_slot[slot] = MSPRING_NONE;
    for (mspring_id p = 0; of_slot && p < particles; ++p)
        of_slot[whole->slot_of_particle[p]] = p; // removed ones, too
    if (of_slot && places) {
        find_places(whole, of_slot, places);
        mspringi_hand(io, places, 2 * (size_t)particles, sizeof(int32_t));
        for (mspring_id s = 0; s < springs; ++s)
            hand_spring(network, whole, of_slot, s, io);
    }
    const bool ok = of_slot && places;
    mspringi_free(&a->memory, of_slot);
    mspringi_free(&a->memory, places);
    return ok ? MSPRING_OK : no_memory(a);
}

/* ----------------------------------------------------------------------------------------------------- sections */

static mspring_result put_by_id(archiver *a, const mspringi_by_id *by, const uint8_t *bytes, size_t size) {
    const size_t made = mspringi_by_id_size(a->network, by, false, bytes, size);
    MSPRINGI_ASSERT(made != SIZE_MAX);
    uint8_t *by_id = mspringi_alloc(&a->memory, made, 1);
    if (!by_id)
        return no_memory(a);
    (void)mspringi_by_id_translate(a->network, by, false, bytes, size, by_id);
    if (by->leave)
        by->leave(a->network, by_id, made);
    const mspring_result result = put_chunk(a, by->section->tag, true, by_id, made);
    mspringi_free(&a->memory, by_id);
    return result;
}

static mspring_result put_section(archiver *a, const mspringi_section *section) {
    const size_t size = mspringi_section_size(a->network, section);
    const mspringi_by_id *by = mspringi_by_id_of(section);
    if (size == 0)
        return MSPRING_OK;
    uint8_t *bytes = mspringi_alloc_unset(&a->memory, size, 1);
    if (!bytes)
        return no_memory(a);
    mspringi_writer to = mspringi_writer_begin(bytes, a->network->kernels);
    section->save(a->network, &to);
    const mspring_result result =
        by ? put_by_id(a, by, bytes, size) : put_chunk(a, section->tag, false, bytes, size);
    mspringi_free(&a->memory, bytes);
    return result;
}

/* ----------------------------------------------------------------------------------------------------- the call */

static mspring_result put_head_of_file(const archiver *a) {
    static const char magic[8] = {'m', 's', 'p', 'r', 'a', 'r', 'c', '\n'};
    const uint32_t words[] = {MSPRINGI_ARCHIVE_VERSION, 0};
    uint8_t head[MSPRINGI_ARCHIVE_HEAD_BYTES];
    mspringi_writer to = mspringi_writer_begin(head, a->network->kernels);
    mspringi_put(&to, magic, sizeof magic, 1);
    mspringi_put(&to, words, 2, sizeof words[0]);
    return put(a, head, sizeof head);
}

static MSPRINGI_NOINLINE mspring_result write_all(archiver *a) {
    mspring_result result = put_head_of_file(a);
    if (result == MSPRING_OK)
        result = put_handed(a, mspringi_head_tag, true, hand_head, NULL);
    if (result == MSPRING_OK)
        result = put_handed(a, mspringi_plan_tag, true, hand_plan, NULL);
    for (const mspringi_chunk *const *chunk = mspringi_chunks; result == MSPRING_OK && *chunk; ++chunk)
        result = put_handed(a, (*chunk)->tag, false, hand_chunk, *chunk);
    for (int i = 0; result == MSPRING_OK && i < MSPRINGI_SECTIONS; ++i)
        result = put_section(a, mspringi_sections[i]);
    return result == MSPRING_OK ? put_chunk(a, mspringi_end_tag, true, NULL, 0) : result;
}

mspring_result mspring_network_write(const mspring_network *network, mspring_write_fn write, void *user) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    if (!write)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT, "the function to write with is NULL");
    if (network->in_hook != MSPRINGI_IN_NO_HOOK)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_BUSY, "no archive is written inside a hook");
    archiver a = {network, write, user, {.allocator = network->memory.allocator}};
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = write_all(&a);
    mspringi_fp_leave(before);
    return result;
}

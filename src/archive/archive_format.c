/// Chunks in memory, and the head of an archive.
#include "archive/archive_format.h"

#include <string.h>

#include "base/definitions.h"
#include "base/hash.h"

const char mspringi_head_tag[5] = "netw", mspringi_plan_tag[5] = "plan", mspringi_end_tag[5] = "end.";

/* ------------------------------------------------------------------------------------------------------- chunks */

const mspringi_chunk *const mspringi_chunks[] = {
#define CHUNK(name) &mspringi_chunk_##name,
#include "store/features.def"
    NULL};

static uint64_t hash_bytes(uint64_t hash, const uint8_t *bytes, size_t size) {
    uint64_t word;
    for (; size >= sizeof word; size -= sizeof word, bytes += sizeof word) {
        mspringi_get(bytes, &word, 1, sizeof word);
        hash = mspringi_hash(hash, word);
    }
    for (word = 0; size > 0; --size)
        word = word << 8 | bytes[size - 1];
    return mspringi_hash(hash, word);
}

uint64_t mspringi_chunk_hash(const uint8_t head[MSPRINGI_CHUNK_HEAD_BYTES], const uint8_t *bytes, size_t size) {
    return hash_bytes(hash_bytes(MSPRINGI_HASH_START, head, 16), bytes, size);
}

bool mspringi_archive_next(const uint8_t *archive, size_t size, size_t *at, mspringi_read_chunk *chunk) {
    uint16_t version, flags;
    uint64_t bytes;
    if (size - *at < MSPRINGI_CHUNK_HEAD_BYTES)
        return false;
    const uint8_t *from = archive + *at;
    from = mspringi_get(mspringi_get(from + 4, &version, 1, 2), &flags, 1, 2);
    mspringi_get(from, &bytes, 1, sizeof bytes);
    const size_t left = size - *at - MSPRINGI_CHUNK_HEAD_BYTES;
    *chunk = (mspringi_read_chunk){(const char *)archive + *at, version, flags,
                                   archive + *at + MSPRINGI_CHUNK_HEAD_BYTES, (size_t)bytes};
    if (bytes > left)
        return false;
    *at += MSPRINGI_CHUNK_HEAD_BYTES + (size_t)bytes;
    return true;
}

mspringi_read_chunk mspringi_archive_find(const uint8_t *archive, const char *tag) {
    mspringi_read_chunk chunk;
    size_t at = MSPRINGI_ARCHIVE_HEAD_BYTES;
    while (mspringi_archive_next(archive, SIZE_MAX, &at, &chunk) && memcmp(chunk.tag, mspringi_end_tag, 4) != 0)
        if (memcmp(chunk.tag, tag, 4) == 0 && chunk.version == MSPRINGI_CHUNK_VERSION)
            return chunk;
    return (mspringi_read_chunk){.tag = tag};
}

/* --------------------------------------------------------------------------------------------------------- head */

static mspring_network_def def_of(const mspring_network *network) {
    mspring_network_def def;
    (void)mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def);
    def.settings = mspringi_settings_of(network);
    def.flags = (network->is_precise ? (uint32_t)MSPRING_NETWORK_PRECISE : 0) |
                (network->keeps_poses ? (uint32_t)MSPRING_NETWORK_POSES : 0) |
                (network->parts > MSPRINGI_DAMPING ? (uint32_t)MSPRING_NETWORK_RESERVE_DAMPING : 0) |
                (network->fractions.values ? (uint32_t)MSPRING_NETWORK_RESERVE_RELATIVE : 0);
    def.spare_particles = network->topology.reserve.particle_end - network->topology.reserve.first_particle;
    def.spare_springs = network->topology.reserve.spring_end - network->topology.reserve.first_spring;
    return def;
}

mspringi_archive_head mspringi_archive_head_of(const mspring_network *network) {
    const mspringi_topology *whole = network->is_compact ? &network->whole : &network->topology;
    const mspringi_reserve *r = &whole->reserve;
    return (mspringi_archive_head){
        .first_particle = r->first_particle,
        .first_spring = r->first_spring,
        .particle_end = r->particle_end,
        .spring_end = r->spring_end,
        .may_have_bundles = whole->may_have_bundles,
        .is_compact = network->is_compact,
        .is_compact_with_bundles = network->is_compact && network->topology.may_have_bundles,
        .has_welds = network->has_welds,
        .next_collider = network->next_collider,
        .shortest_set = network->shortest_set,
        .grid = network->state.grid,
        .shortest = network->shortest,
        .parameter_fingerprint = network->parameter_fingerprint,
        .basis = mspringi_solver_get_basis(&network->solver),
        .def = def_of(network),
    };
}

// Settings come last, so that there may be more.
void mspringi_archive_hand_head(mspringi_io *io, mspringi_archive_head *head) {
    mspring_network_def *def = &head->def;
    mspring_settings *of = &def->settings;
    int32_t names[] = {(int32_t)of->solver, (int32_t)of->integrator, (int32_t)of->guard};
    mspringi_hand(io, &head->first_particle, 9, sizeof(uint32_t)); // and those that follow
    MSPRINGI_HAND(io, head->shortest_set);
    MSPRINGI_HAND(io, head->grid);
    MSPRINGI_HAND(io, head->shortest);
    MSPRINGI_HAND(io, head->parameter_fingerprint);
    MSPRINGI_HAND(io, head->basis.scale);
    MSPRINGI_HAND(io, head->basis.turn_inertia);
    MSPRINGI_HAND(io, def->flags);
    mspringi_hand(io, names, 3, sizeof names[0]);
    mspringi_hand(io, &of->iterations, 3, sizeof(uint32_t)); // and the next two
    MSPRINGI_HAND(io, of->substeps);
    MSPRINGI_HAND(io, of->max_substeps);
    of->solver = (mspring_solver)names[0];
    of->integrator = (mspring_integrator)names[1];
    of->guard = (mspring_guard)names[2];
#define SETTING(name, first, range, is_good, change)                                                               \
    if (io->to || io->left > 0)                                                                                    \
        MSPRINGI_HAND(io, of->name);
#include "base/settings.def"
    if (io->to || io->left > 0) {
        MSPRINGI_HAND(io, of->most_work);
        MSPRINGI_HAND(io, of->residual);
        MSPRINGI_HAND(io, of->substep_length);
    }
    def->spare_particles = head->particle_end - head->first_particle;
    def->spare_springs = head->spring_end - head->first_spring;
}

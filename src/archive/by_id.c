/// Sections of snapshots in archives: values are ordered by id instead of by slot, so they fit any layout.
#include <string.h>

#include "archive/archive_format.h"

static const mspringi_by_id *const all[] = {
#define BY_ID(name) &mspringi_by_id_##name,
#include "store/features.def"
};

const mspringi_by_id *mspringi_by_id_of(const mspringi_section *section) {
    for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i)
        if (all[i]->section == section)
            return all[i];
    return NULL;
}

static size_t words_of(size_t bits) {
    return (bits + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * sizeof(uint16_t);
}

#define SLOT_BYTES (sizeof(uint32_t) + sizeof(double))

// Bytes of a run, by id or by slot. `left`: bytes up to the end of what is read.
static size_t run_size(const mspring_network *network, const mspringi_run *run, bool by_id, size_t left) {
    const mspringi_topology *t = &network->topology;
    const size_t elements = by_id ? t->reserve.particle_end : mspringi_slot_count(network);
    switch (run->kind) {
    case MSPRINGI_FLOATS:
        return run->count * elements * sizeof(float);
    case MSPRINGI_BITS:
        return by_id ? words_of(t->reserve.spring_end) : mspringi_spring_slot_words(t) * sizeof(uint16_t);
    case MSPRINGI_SLOTS:
        return run->count > left / SLOT_BYTES ? SIZE_MAX : run->count * SLOT_BYTES;
    default:
        return run->count == MSPRINGI_THE_REST ? left : run->count;
    }
}

static uint32_t runs_of(const mspring_network *network, const mspringi_by_id *by, const uint8_t *from, size_t size,
                        mspringi_run *runs) {
    if (by->runs)
        return by->runs(network, mspringi_io_from(from, size), runs);
    runs[0] = (mspringi_run){MSPRINGI_BYTES, MSPRINGI_THE_REST};
    return 1;
}

size_t mspringi_by_id_size(const mspring_network *network, const mspringi_by_id *by, bool is_archived,
                           const uint8_t *from, size_t size) {
    mspringi_run runs[MSPRINGI_MOST_RUNS];
    const uint32_t count = runs_of(network, by, from, size, runs);
    size_t left = size, made = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const size_t read = run_size(network, &runs[i], is_archived, left);
        if (read > left)
            return SIZE_MAX;
        made += run_size(network, &runs[i], !is_archived, left);
        left -= read;
    }
    return left == 0 ? made : SIZE_MAX;
}

static void translate_floats(const mspring_network *network, size_t arrays, bool is_archived, const uint8_t *from,
                             uint8_t *to) {
    const size_t slots = mspringi_slot_count(network), ids = network->topology.reserve.particle_end;
    for (size_t array = 0; array < arrays; ++array)
        for (mspring_id p = 0; p < ids; ++p) {
            const size_t by_slot = (array * slots + network->topology.slot_of_particle[p]) * sizeof(float);
            const size_t by_id = (array * ids + p) * sizeof(float);
            if (is_archived)
                memcpy(to + by_slot, from + by_id, sizeof(float));
            else if (mspringi_particle_exists(network, p))
                memcpy(to + by_id, from + by_slot, sizeof(float));
        }
}

static void translate_bits(const mspring_network *network, bool is_archived, const uint8_t *from, uint8_t *to) {
    for (mspring_id s = 0; s < network->topology.reserve.spring_end; ++s) {
        const size_t by_slot = network->topology.slot_of_spring[s];
        const size_t read = is_archived ? s : by_slot, written = is_archived ? by_slot : s;
        to[written / 8] |= (uint8_t)((from[read / 8] >> read % 8 & 1) << written % 8);
    }
}

static bool translate_slots(const mspring_network *network, size_t count, bool is_archived, const uint8_t *from,
                            uint8_t *to) {
    const mspringi_topology *t = &network->topology;
    const size_t end = is_archived ? t->reserve.particle_end : mspringi_slot_count(network);
    mspringi_writer writer = mspringi_writer_begin(to, network->kernels);
    for (size_t i = 0; i < count; ++i) {
        uint32_t at;
        double value;
        from = mspringi_get(mspringi_get(from, &at, 1, sizeof at), &value, 1, sizeof value);
        if (at >= end)
            return false;
        at = is_archived ? t->slot_of_particle[at] : t->particle_of_slot[at];
        mspringi_put(&writer, &at, 1, sizeof at);
        mspringi_put(&writer, &value, 1, sizeof value);
    }
    return true;
}

bool mspringi_by_id_translate(const mspring_network *network, const mspringi_by_id *by, bool is_archived,
                              const uint8_t *from, size_t size, uint8_t *to) {
    mspringi_run runs[MSPRINGI_MOST_RUNS];
    const uint32_t count = runs_of(network, by, from, size, runs);
    size_t left = size;
    bool ok = true;
    for (uint32_t i = 0; ok && i < count; ++i) {
        const size_t read = run_size(network, &runs[i], is_archived, left);
        const size_t made = run_size(network, &runs[i], !is_archived, left);
        if (runs[i].kind == MSPRINGI_FLOATS)
            translate_floats(network, runs[i].count, is_archived, from, to);
        else if (runs[i].kind == MSPRINGI_BITS)
            translate_bits(network, is_archived, from, to);
        else if (runs[i].kind == MSPRINGI_SLOTS)
            ok = translate_slots(network, runs[i].count, is_archived, from, to);
        else if (read > 0)
            memcpy(to, from, read);
        from += read;
        to += made;
        left -= read;
    }
    return ok;
}

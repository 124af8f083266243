/// Largest strain. Springs are searched in the order of their spring slots, in which lattices are contiguous. Then
/// the first id with this strain is searched among the springs of the chunk in which it was found.
#include <math.h>

#include "base/cpu.h"
#include "query/measure.h"
#include "store/rest_lengths.h"
#include "store/springs.h"

/// Spring slots of a chunk.
#define CHUNK ((mspringi_spring_slot)1024)

/// Largest strain, and the range of spring slots with it.
typedef struct peak {
    float strain;
    mspringi_spring_slot first, end;
} peak;

static inline float low_of(float coordinate, float low, bool may_be_stale, float grid) {
    return may_be_stale ? mspringi_low_of(coordinate, low, grid) : low;
}

// Raise the largest strain of each lane to those of sixteen spring slots of a lattice: as mspringi_measure(), but
// vectorisable.
MSPRINGI_ALWAYS_INLINE void raise_lanes(const mspring_network *network, mspringi_spring_slot first,
                                        bool may_be_stale, bool has_welds, float *restrict most) {
    const mspringi_state s = network->state;
    const float *rest_lengths = mspringi_rest_lengths_at(&network->rest_lengths, first);
    const uint32_t live = network->live[first / MSPRINGI_WIDTH];
    float strains[MSPRINGI_WIDTH];
    uint32_t base, tip;
    mspringi_lattice_ends(&network->topology, first, &base, &tip);
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
        const size_t a = base + lane, b = tip + lane;
        const float dx = (s.x[b] - s.x[a]) + (low_of(s.x[b], s.low_x[b], may_be_stale, s.grid) -
                                              low_of(s.x[a], s.low_x[a], may_be_stale, s.grid));
        const float dy = (s.y[b] - s.y[a]) + (low_of(s.y[b], s.low_y[b], may_be_stale, s.grid) -
                                              low_of(s.y[a], s.low_y[a], may_be_stale, s.grid));
        const float length = sqrtf(dx * dx + dy * dy), rest_length = rest_lengths[lane];
        strains[lane] =
            fabsf(has_welds ? mspringi_strain_of(length, rest_length) : (length - rest_length) / rest_length);
    }
    for (uint32_t lane = 0; live != UINT16_MAX && lane < MSPRINGI_WIDTH; ++lane)
        if (!(live >> lane & 1))
            strains[lane] = 0.0f;
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
        most[lane] = strains[lane] > most[lane] ? strains[lane] : most[lane];
}

static float largest_in(const mspring_network *network, mspringi_spring_slot first, mspringi_spring_slot end) {
    float most[MSPRINGI_WIDTH] = {0.0f}, all = 0.0f;
    for (; first < end; first += MSPRINGI_WIDTH)
        if (network->has_welds)
            raise_lanes(network, first, network->is_open, true, most);
        else if (network->is_open)
            raise_lanes(network, first, true, false, most);
        else
            raise_lanes(network, first, false, false, most);
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
        all = most[lane] > all ? most[lane] : all;
    return all;
}

static void include(peak *all, float strain, mspringi_spring_slot first, mspringi_spring_slot end) {
    if (strain > all->strain)
        *all = (peak){strain, first, end};
    else if (strain == all->strain)
        all->end = end;
}

static MSPRINGI_NOINLINE peak find_peak(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const mspringi_spring_slot spring_slots =
        (mspringi_spring_slot)(mspringi_spring_slot_words(t) * MSPRINGI_WIDTH);
    peak all = {0.0f, 0, 0};
    for (mspringi_spring_slot first = 0; first < t->lattice_spring_slots; first += CHUNK) {
        const mspringi_spring_slot left = t->lattice_spring_slots - first,
                                   end = first + (left < CHUNK ? left : CHUNK);
        include(&all, largest_in(network, first, end), first, end);
    }
    for (mspringi_spring_slot spring_slot = t->lattice_spring_slots; spring_slot < spring_slots; ++spring_slot)
        if (mspringi_spring_slot_is_live(network, spring_slot))
            include(&all, fabsf(mspringi_spring_slot_strain(network, spring_slot)), spring_slot, spring_slot + 1);
    return all;
}

static MSPRINGI_NOINLINE mspring_id find_first(const mspring_network *network, const peak *all) {
    const mspringi_topology *t = &network->topology;
    for (mspring_id s = 0; all->strain > 0.0f && s < t->spring_count; ++s) {
        float strain;
        if (t->slot_of_spring[s] < all->first || t->slot_of_spring[s] >= all->end)
            continue;
        mspringi_measure(network, MSPRING_STRAIN, &(mspringi_selection){.first = s, .count = 1}, &strain, 1);
        if (fabsf(strain) == all->strain)
            return s;
    }
    return t->spring_count > 0 ? 0 : MSPRING_NONE;
}

mspring_result mspring_network_max_strain(const mspring_network *network, float *strain, mspring_id *spring) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    const mspringi_fp_state before = mspringi_fp_enter();
    const peak all = find_peak(network);
    const mspring_id first = find_first(network, &all);
    mspringi_fp_leave(before);
    if (strain)
        *strain = all.strain;
    if (spring)
        *spring = first;
    return MSPRING_OK;
}

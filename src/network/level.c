/// Instruction set that suits a layout. Registers of 16 lanes take longer than those of 8, and gain nothing if rows
/// of eight particles fill one of either. (AVX-512 on a Zen 4 takes 5 to 13 % longer than AVX2 for a network of one
/// grid of 5 x 5 to 8 x 8. For 9 x 9 to 16 x 16 it takes a quarter less. Two of the small grids in one network
/// share registers, and take 10 to 30 % less.)
#include "network/level.h"

/// Most registers of the narrower level for each of the wider one, in eighths: a rope next to a narrow lattice
/// changes nothing.
#define MAX_EIGHTHS 9u

/// Most particles of a narrow network.
#define MAX_PARTICLES 64u

// Registers that a substep fills.
static uint64_t register_count(const mspringi_topology *t, uint32_t lanes) {
    const uint32_t lattice_end = t->chain_first * MSPRINGI_WIDTH;
    const uint64_t slice_columns =
        t->irregular.slice_count > 0 ? t->irregular.first_slice_column[t->irregular.slice_count] : 0;
    uint64_t count = (t->chain_blocks + slice_columns) * (MSPRINGI_WIDTH / lanes);
    for (const mspringi_span *span = t->spans; span < t->spans + t->span_count; ++span)
        if (span->first_slot < lattice_end)
            count +=
                (uint64_t)MSPRINGI_DIRECTIONS * ((span->end_slot + lanes - 1) / lanes - span->first_slot / lanes);
    return count;
}

mspring_simd mspringi_choose_level(const mspringi_topology *topology, mspring_simd widest) {
    const bool is_narrow =
        widest == MSPRING_SIMD_AVX512 && topology->lattice_blocks > 0 &&
        topology->particle_count <= MAX_PARTICLES &&
        8 * register_count(topology, MSPRINGI_WIDTH / 2) <= MAX_EIGHTHS * register_count(topology, MSPRINGI_WIDTH);
    return is_narrow ? MSPRING_SIMD_AVX2 : widest;
}

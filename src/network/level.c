/// The instruction set that suits a layout: registers of 16 lanes take longer than those of 8, and gain nothing
/// where rows of eight particles fill one of either. (Grids of 5 x 5 to 8 x 8, a network each, on a Zen 4 take 5 to
/// 13 % longer at AVX-512 than at AVX2; grids of 9 x 9 to 16 x 16 a quarter less. Two such grids in one network
/// share registers, and take 10 to 30 % less.)
#include "network/level.h"

/// Registers of the narrower level that a layout may fill for each of the wider one, in eighths: a rope beside a
/// narrow lattice changes nothing.
#define MOST_EIGHTHS 9u

/// Particles of the largest network that is narrow.
#define MOST_PARTICLES 64u

// How many registers a substep fills.
static uint64_t registers(const mspringi_topology *t, uint32_t lanes) {
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

mspring_simd mspringi_level_for(const mspringi_topology *topology, mspring_simd widest) {
    const bool is_narrow =
        widest == MSPRING_SIMD_AVX512 && topology->lattice_blocks > 0 &&
        topology->particle_count <= MOST_PARTICLES &&
        8 * registers(topology, MSPRINGI_WIDTH / 2) <= MOST_EIGHTHS * registers(topology, MSPRINGI_WIDTH);
    return is_narrow ? MSPRING_SIMD_AVX2 : widest;
}

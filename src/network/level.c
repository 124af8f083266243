/// Instruction set that suits a layout. A wider register gains nothing if all that fills it fits into a narrower
/// one, and takes longer.
///
/// AVX-512 over AVX2, a network of one shape: 1.05 to 1.3 for grids of 5 x 5 to 8 x 8, of 9 x 9 to 16 x 16 a
/// quarter less (Zen 4, Redwood Cove). Redwood Cove: chains of 3 to 8 particles 1.17, of 9 to 16 1.0, of 17 to
/// 24 1.13 to 1.35, of more at most 1.05; 2 x 2 and 3 x 2 1.4. AVX2 over SSE2: chains of up to 4 1.05, 2 x 2 1.0
/// to 1.1. (Two of the small grids in one network share registers, and take 10 to 30 % less.)
#include "network/level.h"

/// Most registers of the narrower level for each of the wider one, in eighths: in networks with grids, so that a
/// rope next to a narrow grid changes nothing, and in others.
#define MAX_EIGHTHS 9u
#define MAX_EIGHTHS_WITHOUT_GRID 12u

/// Most particles of a narrow network.
#define MAX_PARTICLES 64u

static uint32_t registers_for(uint32_t slots, uint32_t lanes) {
    return (slots + lanes - 1) / lanes;
}

// Registers that a substep fills.
static uint64_t register_count(const mspringi_topology *t, uint32_t lanes) {
    const uint32_t lattice_end = t->chain_first * MSPRINGI_WIDTH,
                   chain_end = lattice_end + t->chain_blocks * MSPRINGI_WIDTH;
    const uint64_t slice_columns =
        t->irregular.slice_count > 0 ? t->irregular.first_slice_column[t->irregular.slice_count] : 0;
    const uint32_t nodes = t->particle_count < MSPRINGI_WIDTH ? t->particle_count : MSPRINGI_WIDTH;
    uint64_t count = slice_columns * registers_for(nodes, lanes);
    for (const mspringi_span *span = t->spans; span < t->spans + t->span_count; ++span) {
        const uint32_t first = span->first_slot / lanes, end = registers_for(span->end_slot, lanes);
        if (span->first_slot < lattice_end)
            count += (uint64_t)MSPRINGI_DIRECTIONS * (end - first);
        else if (span->first_slot < chain_end)
            count += end - first;
    }
    return count;
}

// True if a level with half the lanes is no slower.
static bool suits_half(const mspringi_topology *t, uint32_t lanes) {
    const uint64_t count = register_count(t, lanes),
                   most = t->lattice_blocks > 0 ? MAX_EIGHTHS : MAX_EIGHTHS_WITHOUT_GRID;
    return count > 0 && 8 * register_count(t, lanes / 2) <= most * count;
}

mspring_simd mspringi_choose_level(const mspringi_topology *topology, mspring_simd widest) {
    mspring_simd level = widest;
    if (topology->particle_count > MAX_PARTICLES || topology->bundle_springs > 0)
        return widest;
    if (level == MSPRING_SIMD_AVX512 && suits_half(topology, MSPRINGI_WIDTH))
        level = MSPRING_SIMD_AVX2;
    if (level == MSPRING_SIMD_AVX2 && topology->particle_count <= MSPRINGI_WIDTH / 4 &&
        suits_half(topology, MSPRINGI_WIDTH / 2))
        level = MSPRING_SIMD_SSE2;
    return level;
}

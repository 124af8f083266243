/// @file laws_table.h
/// Kernels of the part `laws` in an instruction set's table: lattices with areas, rows of springs that yield. Empty
/// if the build omits that part.
///
/// SPDX-License-Identifier: MIT

#if defined(MSPRINGI_WITHOUT_LAWS)
#define MSPRINGI_LAWS_TABLE
#else

#include "kernels/yield_kernel.h"

#define MSPRINGI_LAWS_TABLE                                                                                        \
    .cells = {{cells_plain, cells_forced}, {cells_damped, cells_damped_forced}}, .precise.cells = cells_precise,   \
    .tested_lattice = {lattice_tested, lattice_tested_precise},                                                    \
    .tested_chain = {chain_tested, chain_tested_precise}, .lattice_yield = lattice_yield,                          \
    .chain_yield = chain_yield

#define MSPRINGI_CELLS_VARIANT(name, of)                                                                           \
    static void cells_##name(const mspringi_sweep *sweep, const mspringi_span *spans, uint32_t count) {            \
        lattice(sweep, spans, count, MSPRINGI_CELLS | (of));                                                       \
    }

MSPRINGI_CELLS_VARIANT(plain, 0)
MSPRINGI_CELLS_VARIANT(forced, MSPRINGI_FORCED)
MSPRINGI_CELLS_VARIANT(damped, MSPRINGI_DAMPED)
MSPRINGI_CELLS_VARIANT(damped_forced, MSPRINGI_DAMPED | MSPRINGI_FORCED)

static void cells_precise(const mspringi_sweep *sweep, const mspringi_span *spans, uint32_t count) {
    const mspringi_variant of = MSPRINGI_CELLS | MSPRINGI_PRECISE | (sweep->force_x ? MSPRINGI_FORCED : 0);
    if (sweep->parts > MSPRINGI_DAMPING)
        lattice(sweep, spans, count, of | MSPRINGI_DAMPED);
    else
        lattice(sweep, spans, count, of);
}

static void lattice_tested(const mspringi_sweep *sweep, const mspringi_span *spans, uint32_t count) {
    const mspringi_variant of =
        MSPRINGI_TESTED | (sweep->force_x ? MSPRINGI_FORCED : 0) | (sweep->cells ? MSPRINGI_CELLS : 0);
    if (sweep->parts > MSPRINGI_DAMPING)
        lattice(sweep, spans, count, of | MSPRINGI_DAMPED);
    else
        lattice(sweep, spans, count, of);
}

static void lattice_tested_precise(const mspringi_sweep *sweep, const mspringi_span *spans, uint32_t count) {
    const mspringi_variant of = MSPRINGI_TESTED | MSPRINGI_PRECISE | (sweep->force_x ? MSPRINGI_FORCED : 0) |
                                (sweep->cells ? MSPRINGI_CELLS : 0);
    if (sweep->parts > MSPRINGI_DAMPING)
        lattice(sweep, spans, count, of | MSPRINGI_DAMPED);
    else
        lattice(sweep, spans, count, of);
}

#define MSPRINGI_VARIANT_TESTED ((variant_found(sweep) & ~(mspringi_variant)MSPRINGI_PRECISE) | MSPRINGI_TESTED)
MSPRINGI_ROW_VARIANT(chain, tested, MSPRINGI_VARIANT_TESTED)
MSPRINGI_ROW_VARIANT(chain, tested_precise, MSPRINGI_VARIANT_FOUND | MSPRINGI_TESTED)

#endif

/// @file kernel_table.h
/// Table of an instruction set, and the variants of its kernels: lattice(), chain(), irregular(), bundle(),
/// loose(), attached(), pack(), largest(), extrema_of(), bounce(), bounce_free(), brake(), lattice_strain(),
/// chain_strain(), lattice_yield(), chain_yield(), lattice_violence(), bound_, image_ and clamp_lattice() and
/// _chain(), take_checksum(). Included at the end of each kernel file, which defines MSPRINGI_TABLE and
/// MSPRINGI_LEVEL.
///
/// SPDX-License-Identifier: MIT

#include "kernels/bounds.h"
#include "kernels/checksum.h"
#include "kernels/extrema.h"
#include "kernels/free_kernel.h"
#include "kernels/limit_kernel.h"
#include "kernels/silt_kernel.h"
#include "kernels/strain_kernel.h"
#include "kernels/system_table.h"
#include "kernels/violence_kernel.h"

static inline mspringi_variant variant_found(const mspringi_sweep *sweep) {
    const mspringi_variant damped = sweep->parts > MSPRINGI_DAMPING ? MSPRINGI_DAMPED : 0;
    return MSPRINGI_PRECISE | damped | (sweep->force_x ? MSPRINGI_FORCED : 0);
}
#define MSPRINGI_VARIANT_FOUND variant_found(sweep)

#define MSPRINGI_ROW_VARIANT(kind, name, of)                                                                       \
    static void kind##_##name(const mspringi_sweep *sweep, const mspringi_span *spans, uint32_t count) {           \
        kind(sweep, spans, count, of);                                                                             \
    }

MSPRINGI_ROW_VARIANT(lattice, plain, 0)
MSPRINGI_ROW_VARIANT(lattice, forced, MSPRINGI_FORCED)
MSPRINGI_ROW_VARIANT(lattice, damped, MSPRINGI_DAMPED)
MSPRINGI_ROW_VARIANT(lattice, damped_forced, MSPRINGI_DAMPED | MSPRINGI_FORCED)

// A test for dampers in each iteration costs AVX2 and AVX-512 8 to 13 % more instructions.
static void lattice_precise(const mspringi_sweep *sweep, const mspringi_span *spans, uint32_t count) {
    const mspringi_variant of = MSPRINGI_PRECISE | (sweep->force_x ? MSPRINGI_FORCED : 0);
    if (sweep->parts > MSPRINGI_DAMPING)
        lattice(sweep, spans, count, of | MSPRINGI_DAMPED);
    else
        lattice(sweep, spans, count, of);
}

#include "kernels/laws_table.h"

MSPRINGI_ROW_VARIANT(chain, plain, 0)
MSPRINGI_ROW_VARIANT(chain, forced, MSPRINGI_FORCED)
MSPRINGI_ROW_VARIANT(chain, damped, MSPRINGI_DAMPED)
MSPRINGI_ROW_VARIANT(chain, damped_forced, MSPRINGI_DAMPED | MSPRINGI_FORCED)
MSPRINGI_ROW_VARIANT(chain, precise, MSPRINGI_VARIANT_FOUND)
MSPRINGI_ROW_VARIANT(irregular, plain, MSPRINGI_FORCED_OR_NOT)
MSPRINGI_ROW_VARIANT(irregular, damped, MSPRINGI_DAMPED | MSPRINGI_FORCED_OR_NOT)
MSPRINGI_ROW_VARIANT(irregular, precise, MSPRINGI_VARIANT_FOUND)
MSPRINGI_ROW_VARIANT(bundle, plain, 0)
MSPRINGI_ROW_VARIANT(bundle, forced, MSPRINGI_FORCED)
MSPRINGI_ROW_VARIANT(bundle, damped, MSPRINGI_DAMPED)
MSPRINGI_ROW_VARIANT(bundle, damped_forced, MSPRINGI_DAMPED | MSPRINGI_FORCED)
MSPRINGI_ROW_VARIANT(bundle, precise, MSPRINGI_VARIANT_FOUND)

static void loose_plain(const mspringi_sweep *sweep, const mspringi_span *span, const mspringi_free_motion *glide) {
    loose(sweep, span, glide, false);
}

static void loose_forced(const mspringi_sweep *sweep, const mspringi_span *span,
                         const mspringi_free_motion *glide) {
    loose(sweep, span, glide, true);
}

#define MSPRINGI_ATTACHED_VARIANT(name, of)                                                                        \
    static void attached_##name(const mspringi_sweep *sweep, uint32_t first, uint32_t count, float *x, float *y) { \
        attached(sweep, first, count, x, y, of);                                                                   \
    }

MSPRINGI_ATTACHED_VARIANT(plain, 0)
MSPRINGI_ATTACHED_VARIANT(damped, MSPRINGI_DAMPED)
MSPRINGI_ATTACHED_VARIANT(precise, MSPRINGI_VARIANT_FOUND)

const mspringi_kernels MSPRINGI_TABLE = {
    .level = MSPRINGI_LEVEL,
    .lanes = LANES > MSPRINGI_QUARTER ? LANES : MSPRINGI_QUARTER,
    .lattice = {{lattice_plain, lattice_forced}, {lattice_damped, lattice_damped_forced}},
    .chain = {{chain_plain, chain_forced}, {chain_damped, chain_damped_forced}},
    .loose = {loose_plain, loose_forced},
    .irregular = {irregular_plain, irregular_damped},
    .bundle = {{bundle_plain, bundle_forced}, {bundle_damped, bundle_damped_forced}},
    .pack = pack,
    .attached = {attached_plain, attached_damped},
    .precise.lattice = lattice_precise,
    .precise.chain = chain_precise,
    .precise.irregular = irregular_precise,
    .precise.bundle = bundle_precise,
    .precise.attached = attached_precise,
    .largest = largest,
    .extrema_of = extrema_of,
    .beyond = beyond,
    .bounce = bounce,
    .bounce_free = bounce_free,
    .brake = brake,
    .lattice_strain = lattice_strain,
    .chain_strain = chain_strain,
    .lattice_violence = lattice_violence,
    .bound_rows = bound_rows,
    .image_rows = image_rows,
    .clamp_rows = clamp_rows,
    .checksum = take_checksum,
    .system = MSPRINGI_SYSTEM_TABLE,
    MSPRINGI_LAWS_TABLE};

/// @file table.h
/// The variants of an instruction set's lattice(), chain(), web(), herd(), loose(), attached(), pack(), largest(),
/// sight_of(), touch(), fly_past(), lattice_strain(), chain_strain(), bound_ and image_lattice() and _chain() and
/// take_checksum(), and the table of them. Included at the end of each kernel file, which defines MSPRINGI_TABLE and
/// MSPRINGI_LEVEL.
///
/// SPDX-License-Identifier: MIT

#include "border.h"
#include "bounds.h"
#include "checksum.h"
#include "flight.h"
#include "sight.h"
#include "strain.h"
#include "system_assemble.h"
#include "system_double.h"
#include "system_energy.h"
#include "system_iterate.h"
#include "system_motion.h"
#include "system_multiply.h"

#define MSPRINGI_VARIANT(kind, name, damped, forced)                                                               \
    static void kind##_##name(const mspringi_sweep *sweep, const mspringi_span *spans, uint32_t count) {           \
        kind(sweep, spans, count, damped, forced);                                                                 \
    }

MSPRINGI_VARIANT(lattice, plain, false, false)
MSPRINGI_VARIANT(lattice, forced, false, true)
MSPRINGI_VARIANT(lattice, damped, true, false)
MSPRINGI_VARIANT(lattice, damped_forced, true, true)
MSPRINGI_VARIANT(chain, plain, false, false)
MSPRINGI_VARIANT(chain, forced, false, true)
MSPRINGI_VARIANT(chain, damped, true, false)
MSPRINGI_VARIANT(chain, damped_forced, true, true)
MSPRINGI_VARIANT(web, plain, false, false)
MSPRINGI_VARIANT(web, forced, false, true)
MSPRINGI_VARIANT(web, damped, true, false)
MSPRINGI_VARIANT(web, damped_forced, true, true)

static void herd_plain(const mspringi_sweep *sweep, const mspringi_herd *which) {
    herd(sweep, which, false, false);
}

static void herd_forced(const mspringi_sweep *sweep, const mspringi_herd *which) {
    herd(sweep, which, false, true);
}

static void herd_damped(const mspringi_sweep *sweep, const mspringi_herd *which) {
    herd(sweep, which, true, false);
}

static void herd_damped_forced(const mspringi_sweep *sweep, const mspringi_herd *which) {
    herd(sweep, which, true, true);
}

static void loose_plain(const mspringi_sweep *sweep, const mspringi_span *span, const mspringi_glide *glide) {
    loose(sweep, span, glide, false);
}

static void loose_forced(const mspringi_sweep *sweep, const mspringi_span *span, const mspringi_glide *glide) {
    loose(sweep, span, glide, true);
}

static void attached_plain(const mspringi_sweep *sweep, uint32_t first, uint32_t count, float *x, float *y) {
    attached(sweep, first, count, x, y, false);
}

static void attached_damped(const mspringi_sweep *sweep, uint32_t first, uint32_t count, float *x, float *y) {
    attached(sweep, first, count, x, y, true);
}

const mspringi_kernels MSPRINGI_TABLE = {
    .level = MSPRINGI_LEVEL,
    .lanes = LANES > MSPRINGI_QUARTER ? LANES : MSPRINGI_QUARTER,
    .lattice = {{lattice_plain, lattice_forced}, {lattice_damped, lattice_damped_forced}},
    .chain = {{chain_plain, chain_forced}, {chain_damped, chain_damped_forced}},
    .loose = {loose_plain, loose_forced},
    .web = {{web_plain, web_forced}, {web_damped, web_damped_forced}},
    .herd = {{herd_plain, herd_forced}, {herd_damped, herd_damped_forced}},
    .pack = pack,
    .attached = {attached_plain, attached_damped},
    .largest = largest,
    .sight_of = sight_of,
    .leaves = leaves,
    .touch = touch,
    .fly_past = fly_past,
    .lattice_strain = lattice_strain,
    .chain_strain = chain_strain,
    .bound_lattice = bound_lattice,
    .bound_chain = bound_chain,
    .image_lattice = image_lattice,
    .image_chain = image_chain,
    .checksum = take_checksum,
    .system = {.weigh = weigh,
               .aim_tile = aim_tile,
               .fly = fly,
               .predict = predict,
               .assemble_lattice = {assemble_lattice_plain, assemble_lattice_damped},
               .assemble_chain = {assemble_chain_plain, assemble_chain_damped},
               .hand_on_forces = {hand_on_forces_plain, hand_on_forces_damped},
               .add_outside = add_outside,
               .invert = invert,
               .multiply_lattice = multiply_lattice,
               .multiply_chain = multiply_chain,
               .hand_on_product = hand_on_product,
               .advance = advance,
               .inertia_of_tile = inertia_of_tile,
               .restrict_to_tile = restrict_to_tile,
               .turn = {[MSPRINGI_TURN_BODIES] = turn_bodies,
                        [MSPRINGI_TURN_AFRESH] = turn_afresh,
                        [MSPRINGI_TURN_FURTHER] = turn_further},
               .land = {[MSPRINGI_REMEMBER_NOTHING] = land_nothing,
                        [MSPRINGI_REMEMBER_CHANGE] = land_change,
                        [MSPRINGI_REMEMBER_ACCELERATION] = land_acceleration,
                        [MSPRINGI_REMEMBER_BOTH] = land_both},
               .moments = sum_moments,
               .elastic = sum_elastic,
               .add_edges = add_edges},
};

/// @file precise.h
/// Precise networks, in which low words count in the lengths of springs: the explicit solver has other kernels for
/// them, and packs more of each node for the irregular springs to read.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PRECISE_H
#define MSPRINGI_PRECISE_H

#include "store/network.h"

/// Kernel that sweeps rows of this kind, with forces from outside if forced. tested: it also tests springs for
/// yield.
static inline mspringi_row_fn mspringi_row_kernel(const mspring_network *network, mspringi_row_kind kind,
                                                  bool forced, bool tested) {
    const mspringi_kernels *k = network->kernels;
    if (tested && kind <= MSPRINGI_ROW_CHAIN)
        return kind == MSPRINGI_ROW_CHAIN ? k->tested_chain[network->is_precise]
                                          : k->tested_lattice[network->is_precise];
    const bool damped = network->parts > MSPRINGI_DAMPING;
    switch (kind) {
    case MSPRINGI_ROW_LATTICE:
        if (network->cells.swept > 0)
            return network->is_precise ? k->precise.cells : k->cells[damped][forced];
        return network->is_precise ? k->precise.lattice : k->lattice[damped][forced];
    case MSPRINGI_ROW_CHAIN:
        return network->is_precise ? k->precise.chain : k->chain[damped][forced];
    default:
        return network->is_precise ? k->precise.irregular : k->irregular[damped];
    }
}

static inline mspringi_row_fn mspringi_bundle_kernel(const mspring_network *network, bool forced) {
    const mspringi_kernels *k = network->kernels;
    return network->is_precise ? k->precise.bundle : k->bundle[network->parts > MSPRINGI_DAMPING][forced];
}

static inline mspringi_attached_fn mspringi_attached_kernel(const mspring_network *network) {
    const mspringi_kernels *k = network->kernels;
    return network->is_precise ? k->precise.attached : k->attached[network->parts > MSPRINGI_DAMPING];
}

/// True if nodes are packed in two halves. A node has four packed values: x, y, vx and vy. In a precise network
/// these are x, y, low_x and low_y; with damping a second half has vx, vy and two unused values.
static inline bool mspringi_packs_halves(const mspring_network *network) {
    return network->is_precise && network->parts > MSPRINGI_DAMPING;
}

static inline uint32_t mspringi_gathered_values(const mspring_network *network) {
    return mspringi_packs_halves(network) ? 8 : 4;
}

/// Floats from a node's first half to its second; 0 if there is none.
static inline size_t mspringi_gathered_distance(const mspring_network *network, const mspringi_sell *irregular) {
    return mspringi_packs_halves(network) ? mspringi_gathered_half(irregular) : 0;
}

/// Pack the motion of a slot's particle.
static inline void mspringi_pack_slot(const mspring_network *network, const mspringi_sell *irregular,
                                      float *gathered, uint32_t slot) {
    const mspringi_state *s = &network->state;
    float *half = gathered + mspringi_gathered_distance(network, irregular);
    half[0] = s->vx[slot];
    half[1] = s->vy[slot];
    gathered[2] = network->is_precise ? s->low_x[slot] : s->vx[slot];
    gathered[3] = network->is_precise ? s->low_y[slot] : s->vy[slot];
    gathered[0] = s->x[slot];
    gathered[1] = s->y[slot];
}

#endif

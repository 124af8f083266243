/// @file energy.h
/// Whether an implicit substep has made energy out of nothing.
///
/// A substep linearises every spring once. What lies across its direction is stiff only as far as the spring is
/// tense, so a taut rope without tension moves sideways as if there were no springs; and one that is stiff is then
/// stretched by more than anything has done work for. On lattices, where others hold each spring's direction, that
/// does not happen: only the springs outside of them, of strands and of the web, are looked at.
///
/// What motion may gain: from d/dt (kinetic + elastic) <= sum of v . f, f being the forces from outside,
///
///     sqrt(E(t + h)) <= sqrt(E(t)) + h sqrt(sum of f^2 / 2m) + h sqrt(sum of k v^2 / 2)
///
/// the last sum being over springs that hang on pinned particles, which move with v.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ENERGY_H
#define MSPRINGI_ENERGY_H

#include "network/network.h"

/// A substep that gained too much, and the spring that has most of it.
typedef struct mspringi_gain {
    double to, most; ///< elastic energy after it, and what all energy might have been, J; to 0: there was none
    mspringi_place place;
} mspringi_gain;

/// Whether there is anything to look at.
static inline bool mspringi_energy_is_watched(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    return t->lattice_places < t->chain_places + t->leftover_count && network->guard_policy != MSPRING_GUARD_BOUNDS;
}

/// Look at the substep of h that the network's implicit solver is about to finish: predicted positions and
/// displacement, at the ends of springs outside of lattices, are there, the state is that of before. base: forces
/// from outside (x NULL: none).
void mspringi_energy_look(mspring_network *network, float h, mspringi_field base);

/// Fail if a substep of the present step gained too much.
mspring_result mspringi_energy_verdict(mspring_network *network, double dt);

#endif

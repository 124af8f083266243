/// @file explicit.h
/// The explicit solver.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EXPLICIT_H
#define MSPRINGI_EXPLICIT_H

#include "stability/guard.h"
#include "store/network.h"

/// Deepest pass over the lattice rows that is worth it for this topology.
uint32_t mspringi_explicit_depth(const mspring_network *network);

/// Workers that a step of as many substeps as the last one shares the lattice rows among.
uint32_t mspringi_explicit_workers(const mspring_network *network);

/// Carry rows for each share: enough for the substeps that are under way at a time.
uint32_t mspringi_explicit_carry_rows(const mspring_network *network);

/// After the last substep of a step: stop what creeps.
void mspringi_explicit_end(mspring_network *network);

/// Whether a particle is in the loose row, and no springs that were added pull at it or at one beside it.
bool mspringi_explicit_is_isolated(const mspring_network *network, const void *object, size_t slot);

/// Forget what a step has left that went out of bounds.
void mspringi_explicit_reset(mspring_network *network);

/// Take count substeps of length h, all with the forces from outside that are in base (x NULL: none).
void mspringi_explicit_run_substeps(mspring_network *network, float h, mspringi_field base, uint32_t count);

/// The same as a whole step that nothing interrupts: with the state of before copied into the backup, what creeps
/// stopped, and the extrema of the state that it ends in, each strip as it is swept, by the worker that has it.
/// Without a floor.
mspringi_extrema mspringi_explicit_run_step(mspring_network *network, float h, mspringi_field base, uint32_t count);

#endif

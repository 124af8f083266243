/// @file hooks.h
/// Calling the host in the course of a step.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_HOOKS_H
#define MSPRINGI_HOOKS_H

#include "network.h"
#include "solver.h"

bool mspringi_hooks_any(const mspring_network *network, mspring_phase phase);

/// Substeps, from this one on, that can be taken until a hook is due again.
uint32_t mspringi_hooks_free_substeps(const mspring_network *network, const mspringi_attempt *attempt,
                                      uint32_t substep);

/// Call the hooks before a step, which add to the field.
void mspringi_hooks_before_step(mspring_network *network, const mspringi_attempt *attempt, mspringi_field field);

/// Call the hooks that are due before this substep, and give forces.driven anew: base (x NULL: none)
/// and the forces of all hooks. If none is due, the field stays as it was.
void mspringi_hooks_before_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                                   mspringi_field base);

/// Call the hooks that are due after this substep.
void mspringi_hooks_after_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep);

#endif

/// @file hooks.h
/// Calling the host in the course of a step.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_HOOKS_H
#define MSPRINGI_HOOKS_H

#include "network.h"

/// Call the hooks of a phase with the given force field (x NULL: none).
void mspringi_hooks_call(mspring_network *network, mspring_phase phase, uint32_t substep, double dt,
                         mspringi_field field);
bool mspringi_hooks_any(const mspring_network *network, mspring_phase phase);

#endif

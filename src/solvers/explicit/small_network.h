/// @file small_network.h
/// A straight way through a step of a small network: its rows, one substep after the other.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SMALL_NETWORK_H
#define MSPRINGI_SMALL_NETWORK_H

#include "store/network.h"

/// Take all substeps, if the network is small and has nothing in them beside rows of one worker.
/// @return false: it is not so, and nothing was done
bool mspringi_small_network_step(const mspring_network *network, float h, mspringi_field base, uint32_t count,
                                 mspringi_extrema *extrema);

#endif

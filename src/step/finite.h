/// @file finite.h
/// A check of the whole state for builds with asserts.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_FINITE_H
#define MSPRINGI_FINITE_H

#include "store/network.h"

/// True if all numbers that a network keeps for its next step are finite, low words included.
bool mspringi_is_finite(const mspring_network *network);

#endif

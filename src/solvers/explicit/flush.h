/// @file flush.h
/// The end of motion that dies away.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_FLUSH_H
#define MSPRINGI_FLUSH_H

#include "store/network.h"

/// Stop the slots first to end - 1 whose speed is none any more, if there is damping.
void mspringi_flush_to_zero(const mspring_network *network, size_t first, size_t end);

#endif

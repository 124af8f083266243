/// @file areas.h
/// Cells that areas may be around.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EDITS_AREAS_H
#define MSPRINGI_EDITS_AREAS_H

#include "store/network.h"

/// The area within particles, in their order, m^2.
double mspringi_area_within(const mspring_network *network, const mspring_id *particles, uint32_t count);

/// Do something with a cell, whose corners are in the order in which its area is positive, if it has any.
typedef mspring_result (*mspringi_cell_fn)(mspring_network *network, const mspring_id corners[4], void *user);

/// Do it with each cell, in an order that follows from ids and springs alone, until it fails.
mspring_result mspringi_each_cell(mspring_network *network, mspringi_cell_fn fn, void *user);

#endif

/// @file edit_areas.h
/// Cells for areas, and functions shared by edits of areas and angles.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EDIT_AREAS_H
#define MSPRINGI_EDIT_AREAS_H

#include "store/network.h"

/// Area enclosed by particles, in their order, m^2.
double mspringi_area_within(const mspring_network *network, const mspring_id *particles, uint32_t count);

/// Callback for a cell. The order of the corners makes its area positive, or 0.
typedef mspring_result (*mspringi_cell_fn)(mspring_network *network, const mspring_id corners[4], void *user);

/// Call fn for each cell until it fails, in an order that follows from ids and springs alone.
mspring_result mspringi_each_cell(mspring_network *network, mspringi_cell_fn fn, void *user);

/// Check that particles exist, are distinct, and are in one group. what: "area" or "angle".
mspring_result mspringi_check_corners(mspring_network *network, const char *what, const mspring_id *particles,
                                      uint32_t count);

#endif

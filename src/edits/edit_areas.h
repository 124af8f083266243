/// @file edit_areas.h
/// Cells that areas may be around, and what edits of areas and angles have in common.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EDIT_AREAS_H
#define MSPRINGI_EDIT_AREAS_H

#include "store/network.h"

/// The area within particles, in their order, m^2.
double mspringi_area_within(const mspring_network *network, const mspring_id *particles, uint32_t count);

/// Do something with a cell, whose corners are in the order in which its area is positive, if it has any.
typedef mspring_result (*mspringi_cell_fn)(mspring_network *network, const mspring_id corners[4], void *user);

/// Do it with each cell, in an order that follows from ids and springs alone, until it fails.
mspring_result mspringi_each_cell(mspring_network *network, mspringi_cell_fn fn, void *user);

/// Check that particles exist, once each, in one group. what: an area or an angle.
mspring_result mspringi_check_corners(mspring_network *network, const char *what, const mspring_id *particles,
                                      uint32_t count);
mspring_result mspringi_area_remove(mspring_network *network, mspring_id id, bool is_angle);

/// Find one of a kind, or fail; the second is for calls that only read: NULL if there is none, with a message.
mspring_result mspringi_area_find(mspring_network *network, mspring_id id, bool is_angle, mspringi_area **found);
const mspringi_area *mspringi_area_look_up(const mspring_network *network, mspring_id id, bool is_angle);

/// Measure all of a kind: ids, sizes or angles, pressures or torques, each where it is not NULL.
mspring_result mspringi_areas_measure(const mspring_network *network, bool is_angle, mspring_id *ids, double *sizes,
                                      double *pressures, uint32_t capacity, uint32_t *count);

#endif

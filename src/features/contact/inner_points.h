/// @file inner_points.h
/// Inner particles against colliders.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_INNER_POINTS_H
#define MSPRINGI_INNER_POINTS_H

#include <massspring/massspring.h>

struct mspringi_contacts;

/// Inner particles that may touch colliders in this step.
typedef struct mspringi_inner_points {
    mspring_id *watched; ///< [particles]
    uint32_t watched_count;
    uint32_t pair_count;      ///< their pairs, at the end of the list
    uint32_t *visited, visit; ///< [particles] number of the last visit to each; number of this visit
    double way_x, way_y; ///< mean displacement of points since the list, and the grid of its edges, was made, m
} mspringi_inner_points;

/// Add the candidates of inner particles. If there is no room, the step is rejected.
void mspringi_inner_points_add(const mspring_network *network, struct mspringi_contacts *contacts);

#endif

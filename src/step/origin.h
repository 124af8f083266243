/// @file origin.h
/// The local origin.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ORIGIN_H
#define MSPRINGI_ORIGIN_H

#include "store/network.h"

/// Box of positions, m.
typedef struct mspringi_box {
    double min_x, min_y, max_x, max_y;
} mspringi_box;
mspringi_box mspringi_box_empty(void);
void mspringi_box_include(mspringi_box *box, double x, double y);

/// Set the origin. The caller must set all positions anew.
void mspringi_origin_set(mspring_network *network, double x, double y);
/// Set the origin to the middle of the box, world coordinates. The caller must set all positions anew.
void mspringi_origin_choose(mspring_network *network, const mspringi_box *box);
/// Set a particle's world position.
void mspringi_set_position(mspring_network *network, mspring_id particle, double x, double y);
/// Move the origin to the network if that is far from it. Exact: no world position changes.
void mspringi_origin_follow(mspring_network *network);

#endif

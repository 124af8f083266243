/// @file tile_order.h
/// The order of tiles.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_TILE_ORDER_H
#define MSPRINGI_TILE_ORDER_H

#include "tiles.h"

/// Number the tiles anew, so that those that a spring joins have near numbers (Cuthill and McKee 1969).
/// @return false: no memory
bool mspringi_tiles_order(mspringi_tiles *tiles, const mspring_network *network, mspringi_memory *memory);

#endif

/// @file roots.h
/// Finding the components.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ROOTS_H
#define MSPRINGI_ROOTS_H

#include "store/network.h"

/// Find the lowest slot of the component of each slot.
void mspringi_find_roots(const mspring_network *network, uint32_t *root);

/// True if a search near the springs that broke or were restored since edits.links was `seen` shows that all
/// components are unchanged. False proves nothing. A particle's component is number[index[particle]], or
/// number[particle] if index is NULL. Needs the network's incidence.
bool mspringi_links_change_nothing(const mspring_network *network, uint64_t seen, const uint32_t *number,
                                   const uint32_t *index);

#endif

/// @file roots.h
/// Finding the components.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ROOTS_H
#define MSPRINGI_ROOTS_H

#include "store/network.h"

/// Give every slot the lowest slot that it hangs together with by live springs.
void mspringi_find_roots(const mspring_network *network, uint32_t *root);

/// Whether all springs that were broken or restored since edits.links was seen have, for all one sees near them,
/// left the components as they were then. A particle's is number[index[particle]], or number[particle] if index is
/// NULL. The network's incidence must be there.
bool mspringi_links_change_nothing(const mspring_network *network, uint64_t seen, const uint32_t *number,
                                   const uint32_t *index);

#endif

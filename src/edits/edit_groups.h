/// @file edit_groups.h
/// What groups are put back to.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EDIT_GROUPS_H
#define MSPRINGI_EDIT_GROUPS_H

#include "store/network.h"

/// Allocate a mark of so many groups. On error there is none of it.
mspring_result mspringi_mark_allocate(mspring_network *network, mspringi_mark *mark, uint32_t groups);

/// Remember what a group is like now.
void mspringi_mark_take(mspring_network *network, mspringi_mark *mark, uint32_t group);

#endif

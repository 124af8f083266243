/// @file edit_groups.h
/// Marks: states of groups for a later reset.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EDIT_GROUPS_H
#define MSPRINGI_EDIT_GROUPS_H

#include "store/group_ops.h"

/// Allocate a mark for `groups` groups. On error nothing is allocated.
mspring_result mspringi_mark_allocate(mspring_network *network, mspringi_mark *mark, uint32_t groups);

/// Save the present state of a group.
void mspringi_mark_take(mspring_network *network, mspringi_mark *mark, uint32_t group);

/// Find the frame of the group of a particle (query_groups.c).
void mspringi_group_find_frame(const mspring_network *network, mspring_id particle, mspringi_group_frame *frame);

#endif

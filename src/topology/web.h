/// @file web.h
/// The leftover springs, by particle: for whatever is no grid and no strand.
///
/// Every slot that a leftover spring pulls at is a node. Nodes come in groups of MSPRINGI_WIDTH; a group has as
/// many rungs as its busiest node has springs, and a rung holds, for each of the group's nodes, the neighbour at
/// the other end of one of its springs (or the node itself, where it has no more: a spring of length 0 and
/// stiffness 0, which exerts nothing). So a node's force is a sum in registers, in the order of its rungs; each
/// spring is computed at both its ends, which costs less than adding to two places in memory.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_WEB_H
#define MSPRINGI_WEB_H

#include "builder/builder.h"

/// Slots in a block and nodes in a group: the lanes of the widest vector register, so that every instruction set
/// sees whole ones.
#define MSPRINGI_WIDTH 16

typedef struct mspringi_web {
    uint32_t own_count;      ///< nodes that are slots of web rows, in order
    uint32_t attached_count; ///< nodes after them, that are slots of other rows; each strip's fill whole groups
    uint32_t *attached_slot; ///< [attached_count] MSPRING_NONE for those that fill up
    uint32_t group_count;    ///< (own_count + attached_count) / MSPRINGI_WIDTH
    uint32_t *first_rung;    ///< [group_count + 1]
    uint32_t *neighbour;     ///< [rungs][MSPRINGI_WIDTH] nodes
    uint32_t *entry;         ///< [2 * springs] where in neighbour the two ends of each leftover spring are
} mspringi_web;

/// Make the web of count springs between slots a and b. The slots first_slot ... first_slot + own_count - 1 are
/// those of the web rows; in what strip another slot is, its block tells.
mspring_result mspringi_web_create(mspringi_web *web, const uint32_t *a, const uint32_t *b, uint32_t count,
                                   uint32_t first_slot, uint32_t own_count, uint32_t block_count,
                                   const uint32_t *strip_of_block, mspringi_memory *memory,
                                   mspringi_message *message);
void mspringi_web_destroy(mspringi_web *web, mspringi_memory *memory);

#endif

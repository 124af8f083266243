/// @file web.h
/// The leftover springs, by particle: for whatever is no grid and no strand.
///
/// Every slot that a leftover spring pulls at is a node. Nodes come in groups of MSPRINGI_WIDTH; a group has as
/// many rungs as its busiest node has springs, and a rung holds, for each of the group's nodes, the neighbour at
/// the other end of one of its springs (or the node itself, where it has no more: a spring of length 0 and
/// stiffness 0, which exerts nothing). So a node's force is a sum in registers, in the order of its rungs; each
/// spring is computed at both its ends, which costs less than adding to two places in memory.
///
/// Ropes stand upright, sixteen side by side: the springs of a group's nodes to those of the next one are its first
/// rung then, and are computed once, in place and without gathering. Nodes that they join have no more than two
/// springs, whose sum is the same in either order.
///
/// The last of the own nodes may stand in herds: equal components of up to MSPRINGI_LARGEST_COPY groups, sixteen at
/// a time, in which a rung leads all nodes of a group to the same other group. A herd's groups are in the order of
/// a search from the first one. So each of the others has a spring to a group above, which comes before. A herd is
/// swept by its links, which compute each spring once; its nodes sum up their rungs in the same order as all
/// others.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_WEB_H
#define MSPRINGI_WEB_H

#include "base/memory.h"
#include "builder/builder.h"

/// Slots in a block and nodes in a group: the lanes of the widest vector register, so that every instruction set
/// sees whole ones.
#define MSPRINGI_WIDTH 16

/// Particles of the largest tree, and of the largest other component, that may stand in a herd.
#define MSPRINGI_LARGEST_COPY 256
/// Ends of springs that such a component may have: a carry row holds a force for each.
#define MSPRINGI_MOST_ENDS 2048

/// Small herds are swept together, about so many groups, few enough to stay in the first-level cache while all
/// substeps are taken.
#define MSPRINGI_HERD_SPAN 16

/// Springs between two groups of a herd.
typedef struct mspringi_link {
    uint32_t below;      ///< slots from a node to its other end
    uint32_t rung, back; ///< of the group above, and of the one below
} mspringi_link;

typedef struct mspringi_web {
    uint32_t own_count;      ///< nodes that are slots of web rows, in order
    uint32_t attached_count; ///< nodes after them, that are slots of other rows; each strip's fill whole groups
    uint32_t *attached_slot; ///< [attached_count] MSPRING_NONE for those that fill up
    uint32_t group_count;    ///< (own_count + attached_count) / MSPRINGI_WIDTH
    uint32_t *first_rung;    ///< [group_count + 1]
    uint32_t *neighbour;     ///< [rungs][MSPRINGI_WIDTH] nodes
    uint32_t *entry;         ///< [2 * springs] where in neighbour the two ends of each leftover spring are
    uint8_t *is_upright;     ///< [group_count] whether the group's first rung is upright; NULL if none is
    uint8_t *is_read;        ///< [group_count] whether a rung that is not leads to one of its nodes, likewise
    uint32_t first_herd;     ///< first group that is in a herd
    uint32_t *first_link;    ///< [groups in herds + 1]
    mspringi_link *links;    ///< of those groups in order: their springs to groups below
} mspringi_web;

/// What a web is made of, and what is needed meanwhile.
typedef struct mspringi_weaving {
    mspringi_web *web;
    const uint32_t *a, *b; ///< [count] slots that the springs join
    uint32_t count;
    uint32_t first_slot, own_count;         ///< the slots of the web rows
    uint32_t block_count;                   ///< of all slots
    uint32_t herd_groups, herd_springs;     ///< the last of these, in herds, and springs of one component of each
    uint32_t *strip_of_block;               ///< [block_count] in what strip another slot is; freed with the rest
    uint32_t *degree, *node_of_slot, *used; ///< by slot, by slot and by node
    uint32_t homed_count;                   ///< the first of these, that have a home
    bool has_seconds;                       ///< some springs lie beside another: then none stands upright
    uint8_t *upright;                       ///< [own groups] springs that could stand there
    uint32_t upright_count;                 ///< that do
} mspringi_weaving;

/// Make the web, in this order: list the attached nodes, lay the rungs, fill them with the springs first ... end
/// - 1.
mspring_result mspringi_web_begin(mspringi_weaving *weaving, mspringi_memory *memory, mspringi_message *message);
mspring_result mspringi_web_lay_rungs(mspringi_weaving *weaving, mspringi_memory *memory,
                                      mspringi_message *message);
void mspringi_web_fill(const mspringi_weaving *weaving, uint32_t first, uint32_t end);
/// When all are filled: link the groups of herds.
void mspringi_web_link(const mspringi_weaving *weaving);
void mspringi_weaving_destroy(mspringi_weaving *weaving, mspringi_memory *memory);

#endif

/// @file store.h
/// The arrays that a network holds, and what is done to all of them alike. The table of them is network.def.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STORE_H
#define MSPRINGI_STORE_H

#include "store/network.h"

/// Arrays that are reserved together. Those below MSPRINGI_LAYOUT_END lie by slot or place.
typedef enum mspringi_group {
#define GROUP(name) MSPRINGI_STORE_##name,
#define END(name) MSPRINGI_##name##_END, MSPRINGI_##name##_LAST = MSPRINGI_##name##_END - 1,
#define ARRAY(member, elements)
#define VIEW(member, elements)
#define LANES(member, planes)
#define PLACES(member)
#define BITS(member)
#define STATE(member)
#include "store/network.def"
    MSPRINGI_STORE_GROUPS
} mspringi_group;
#undef GROUP
#undef END
#undef ARRAY
#undef VIEW
#undef LANES
#undef PLACES
#undef BITS
#undef STATE

/// Reserve what a group lacks, zeroed. False: no memory, and none of the group is there.
bool mspringi_store_reserve(mspring_network *network, mspringi_group group);
void mspringi_store_free(mspring_network *network, mspringi_group group);

/// Have a copied network's pointers lead into its own memory.
void mspringi_store_relocate(mspring_network *network, const mspringi_memory *from, const mspringi_memory *to);

/// Copy a group's arrays, which may not have views, into another network and its memory. False: no memory.
bool mspringi_store_duplicate(mspring_network *to, const mspring_network *from, mspringi_group group,
                              mspringi_memory *memory);
/// Forget all arrays.
void mspringi_store_forget(mspring_network *network);

/// Free what lies by slot or place from this memory, or forget it.
void mspringi_store_free_layout(mspring_network *network, mspringi_memory *memory);
void mspringi_store_forget_layout(mspring_network *network);

/// Take over the arrays that another network of the same particles and springs has by slot or place.
void mspringi_store_take_layout(mspring_network *to, const mspring_network *from);
/// Reserve the groups by slot or place that another one has and this one lacks, and free those that it has not.
bool mspringi_store_match_layout(mspring_network *to, const mspring_network *from);

/// Move what lies by slot, or what lies by place of one spring but for its record, between layouts.
void mspringi_store_move_slots(mspring_network *to, const mspring_network *from);
void mspringi_store_copy_spring(mspring_network *to, mspringi_spring_slot spring_slot, const mspring_network *from,
                                mspringi_spring_slot before);

#endif

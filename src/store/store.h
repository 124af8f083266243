/// @file store.h
/// Operations on all arrays of a network. network.def lists the arrays.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STORE_H
#define MSPRINGI_STORE_H

#include "store/network.h"

/// Arrays that are reserved together. Those below MSPRINGI_LAYOUT_END lie by slot or spring slot.
typedef enum mspringi_group {
#define GROUP(name) MSPRINGI_STORE_##name,
#define END(name) MSPRINGI_##name##_END, MSPRINGI_##name##_LAST = MSPRINGI_##name##_END - 1,
#define ARRAY(member, elements)
#define VIEW(member, elements)
#define LANES(member, planes)
#define FLOATS(member)
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
#undef FLOATS
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

/// Free the arrays by slot or spring slot from this memory, or forget them.
void mspringi_store_free_layout(mspring_network *network, mspringi_memory *memory);
void mspringi_store_forget_layout(mspring_network *network);

/// Take over the arrays by slot or spring slot of another network with the same particles and springs.
void mspringi_store_take_layout(mspring_network *to, const mspring_network *from);
/// Reserve the groups by slot or spring slot that another network has, and free those that it lacks.
bool mspringi_store_match_layout(mspring_network *to, const mspring_network *from);

/// Copy the arrays by slot to another layout, or one spring's elements of those by spring slot except its record.
void mspringi_store_move_slots(mspring_network *to, const mspring_network *from);
void mspringi_store_copy_spring(mspring_network *to, mspringi_spring_slot spring_slot, const mspring_network *from,
                                mspringi_spring_slot before);

#endif

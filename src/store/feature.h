/// @file feature.h
/// Operations on the states of all features. The table of features is features.def.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_FEATURE_H
#define MSPRINGI_FEATURE_H

#include "base/array_table.h"
#include "store/changed.h"

/// The arrays that a feature's state holds, none of them by slot or spring slot.
typedef struct mspringi_feature_state {
    mspringi_array_table arrays;
    void (*relocate)(void *state, const mspringi_memory *from,
                     const mspringi_memory *to); ///< pointers that are in no table; after the arrays. NULL: none
} mspringi_feature_state;

#define STATE(name) extern const mspringi_feature_state mspringi_state_of_##name;
#define CREATES(function) mspring_result function(mspring_network *network, const mspring_builder *builder);
#define APPENDS(reserve, append)                                                                                   \
    mspring_result reserve(const mspring_network *network, const mspring_id *ids, mspring_builder *builder);       \
    void append(const mspring_network *network, const mspring_id *ids, mspring_builder *builder);
#define GROUPED(function) mspring_result function(mspring_network *network, const uint32_t *group_of_particle);
#define REACTS(function) void function(mspring_network *network, mspringi_change change, uint32_t index);
#define LENGTHS(function) bool function(const mspring_network *network);
#define VARIES(function) bool function(const mspring_network *network);
#define LOADS(function) void function(mspring_network *network);
#define LOADED(function) void function(mspring_network *network);
#define DISCARDS(function) void function(mspring_network *network);
#define MOVES(make, drop)                                                                                          \
    mspring_result make(mspring_network *to, const mspring_network *from);                                         \
    void drop(const mspring_network *from, mspringi_memory *memory);
#define FORGETS(function) void function(mspring_network *network);
#define ACTS(function) bool function(const mspring_network *network);
#define FINITE(function) bool function(const mspring_network *network);
#define YIELDED(function) void function(const mspring_network *network, mspring_energy *energy);
#define ENDS(function) void function(mspring_network *network);
#define GROWS(function) mspring_result function(mspring_network *network);
#include "store/features.def"

/// Have a copied network's states lie in its own memory, with all that they point to.
void mspringi_features_relocate(mspring_network *network, const mspringi_memory *from, const mspringi_memory *to);
/// Forget all states: those of a copy are another network's.
void mspringi_features_forget(mspring_network *network);

/// Give a new network what its builder has of each feature.
mspring_result mspringi_features_create(mspring_network *network, const mspring_builder *builder);

/// Append to a builder the features' data of each particle whose ids[particle], its id there, is not MSPRING_NONE.
/// Make room first.
mspring_result mspringi_features_reserve_append(const mspring_network *network, const mspring_id *ids,
                                                mspring_builder *builder);
void mspringi_features_append(const mspring_network *network, const mspring_id *ids, mspring_builder *builder);

/// Forget what the end of a step gave, because the guard has clamped it.
void mspringi_features_discard_step(mspring_network *network);

/// True if rest lengths of springs follow from the time in the next step.
bool mspringi_features_change_lengths(const mspring_network *network);
/// True if stiffness or rest lengths do.
bool mspringi_features_vary(const mspring_network *network);

#endif

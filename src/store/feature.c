/// Operations on the states of all features.
#include "store/feature.h"

#include <string.h>

#include "store/group_ops.h"

static const struct {
    size_t offset; // of the pointer in the network
    const mspringi_feature_state *state;
} states[] = {
#define STATE(name) {offsetof(mspring_network, name), &mspringi_state_of_##name},
#include "store/features.def"
};

#define STATES (sizeof states / sizeof states[0])

// The address is an integer, since gcc 12 takes the network for its first member, and warns of a write behind it.
static void set_pointer(mspring_network *network, size_t offset, void *state) {
    memcpy((void *)((uintptr_t)network + offset), &state, sizeof state);
}

static void *get_pointer(const mspring_network *network, size_t offset) {
    void *state;
    memcpy(&state, (const char *)network + offset, sizeof state);
    return state;
}

void mspringi_features_relocate(mspring_network *network, const mspringi_memory *from, const mspringi_memory *to) {
    for (size_t i = 0; i < STATES; ++i) {
        void *state = mspringi_memory_relocate(from, to, get_pointer(network, states[i].offset));
        set_pointer(network, states[i].offset, state);
        if (!state)
            continue;
        mspringi_array_table_relocate(states[i].state->arrays, state, from, to);
        if (states[i].state->relocate)
            states[i].state->relocate(state, from, to);
    }
}

void mspringi_features_forget(mspring_network *network) {
    for (size_t i = 0; i < STATES; ++i)
        set_pointer(network, states[i].offset, NULL);
}

mspring_result mspringi_features_create(mspring_network *network, const mspring_builder *builder) {
    mspring_result result = MSPRING_OK;
    (void)network, (void)builder; // if no feature asks
#define CREATES(function) result = result == MSPRING_OK ? function(network, builder) : result;
#include "store/features.def"
    return result;
}

mspring_result mspringi_features_reserve_append(const mspring_network *network, const mspring_id *ids,
                                                mspring_builder *builder) {
    mspring_result result = MSPRING_OK;
    (void)network, (void)ids, (void)builder;
#define APPENDS(reserve, append) result = result == MSPRING_OK ? reserve(network, ids, builder) : result;
#include "store/features.def"
    return result;
}

void mspringi_features_append(const mspring_network *network, const mspring_id *ids, mspring_builder *builder) {
    (void)network, (void)ids, (void)builder;
#define APPENDS(reserve, append) append(network, ids, builder);
#include "store/features.def"
}

bool mspringi_features_change_lengths(const mspring_network *network) {
    bool any = false;
#define LENGTHS(function) any = any || function(network);
#include "store/features.def"
    return any;
}

bool mspringi_features_vary(const mspring_network *network) {
    bool any = mspringi_features_change_lengths(network);
#define VARIES(function) any = any || function(network);
#include "store/features.def"
    return any;
}

void mspringi_features_discard_step(mspring_network *network) {
#define DISCARDS(function) function(network);
#include "store/features.def"
}

/* ---------------------------------------------------------------------------------------------------- groups */

#define GROUPS(table) &table +
const mspringi_group_ops *const mspringi_held_groups =
#include "store/features.def"
    0;

/// @file things.h
/// Kinds of things that have ids and properties: particles and springs, and those of features (features.def).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_THINGS_H
#define MSPRINGI_THINGS_H

#include "store/selection.h"

/// Values of a property: one for each element of a selection, or with stride 0 one for all.
typedef struct mspringi_values {
    mspring_property property;
    const float *first;
    size_t stride; ///< stride in floats
} mspringi_values;

/// Functions of a kind of thing. The state of a network without such things is all zeros: totals are 0.
typedef struct mspringi_thing_ops {
    mspring_kind kind;
    const char *name;
    uint32_t (*total)(const mspring_network *network); ///< ids are below it
    bool (*exists)(const mspring_network *network, mspring_id id);
    double (*get)(const mspring_network *network, mspring_property property, mspring_id id);
    uint32_t (*get_integer)(const mspring_network *network, mspring_property property, mspring_id id);
    /// Check and set the values of a property that can be written; NULL: there is none.
    mspring_result (*set)(mspring_network *network, const mspringi_selection *at, const mspringi_values *values);
    /// First particle of a thing that exists, by which it belongs to a group; NULL: a property tells it.
    mspring_id (*first_particle)(const mspring_network *network, mspring_id id);
} mspringi_thing_ops;

#define THINGS(table) extern const mspringi_thing_ops table;
#include "store/features.def"

extern const mspringi_thing_ops mspringi_things_particles, mspringi_things_springs;

/// NULL: there is no such kind in this build.
const mspringi_thing_ops *mspringi_things_of(mspring_kind kind);

#endif

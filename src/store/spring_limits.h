/// @file spring_limits.h
/// Limits of springs, at which they break, yield and so on. Each belongs to a feature, which stores it by spring
/// slot.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SPRING_LIMITS_H
#define MSPRINGI_SPRING_LIMITS_H

#include "builder/builder.h"
#include "store/network.h"

/// The limits of one feature.
typedef struct mspringi_limit_ops {
    mspring_property first, last;                                                   ///< that the feature keeps
    mspring_result (*reserve)(mspring_network *network, mspring_property property); ///< make room for a property
    mspring_result (*match_layout)(mspring_network *to,
                                   const mspring_network *from); ///< make room for all that `from` has
    void (*store)(mspring_network *network, mspringi_spring_slot spring_slot, mspring_property property,
                  float value);
    void (*put)(mspring_network *network, mspring_id spring, mspringi_limits limits); ///< of a new spring
    void (*forget)(mspring_network *network, mspring_id spring);
    void (*renew)(mspring_network *network, mspringi_spring_slot spring_slot); ///< its rest length has changed
} mspringi_limit_ops;

#define LIMITS(table) extern const mspringi_limit_ops table;
#include "store/features.def"

/// Make room for a property, or for all that limits need. Fails if no feature has the property.
mspring_result mspringi_limit_reserve(mspring_network *network, mspring_property property);
mspring_result mspringi_limits_reserve(mspring_network *network, mspringi_limits limits);
/// Make room for what another network has by spring slot; mspringi_store_copy_spring() copies it.
mspring_result mspringi_limits_match_layout(mspring_network *to, const mspring_network *from);

/// Set a property of a spring; after mspringi_limit_reserve().
void mspringi_limit_store(mspring_network *network, mspringi_spring_slot spring_slot, mspring_property property,
                          float value);
/// Give a spring without limits those of its definition; after mspringi_limits_reserve() and
/// mspringi_metres_reserve().
void mspringi_limits_put(mspring_network *network, mspring_id spring, uint32_t flags, mspringi_limits limits);
/// Let nothing happen to a spring.
void mspringi_limits_forget(mspring_network *network, mspring_id spring);
/// Bring what follows from a spring's rest length, given or in force, up to date.
void mspringi_limits_renew(mspring_network *network, mspringi_spring_slot spring_slot);

/// Values of a property by spring slot, or NULL as long as all springs have the default.
float *mspringi_limits_of(const mspring_network *network, mspring_property property);

#endif

/// @file edit_values.h
/// Edits of properties that are one float for each particle or spring. Called by mspring_network_set().
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_EDIT_VALUES_H
#define MSPRINGI_EDIT_VALUES_H

#include "store/properties.h"

static inline float mspringi_value_of(const mspringi_values *values, uint32_t i) {
    const float value = values->first[i * values->stride];
    return values->property == MSPRING_REST_LENGTH ? mspringi_stored_length(value) : mspringi_broken_value(value);
}

/// True if these springs have the values, by what the host sent before. False proves nothing.
bool mspringi_sent_again(mspring_network *network, const mspringi_selection *at, const mspringi_values *values);

/// Values that were sent for a range of springs, from its first one on; NULL if one of them is unknown.
const float *mspringi_sent_range(mspring_network *network, const mspringi_selection *at, mspring_property property);
/// Index of the first value, from index i on, whose bits differ from those sent.
uint32_t mspringi_sent_skip(const float *sent, const mspringi_values *values, uint32_t i, uint32_t count);

/// An edit of a property, and what was known before it.
typedef struct mspringi_sent_edit {
    uint64_t fingerprint;
    mspring_id first, end;
    uint32_t equal;   ///< values at the front that equal those sent
    uint32_t changed; ///< springs that changed
} mspringi_sent_edit;

/// Surround an edit of spring values; the second call follows only if it succeeded.
mspringi_sent_edit mspringi_sent_begin(mspring_network *network, mspring_property property);
void mspringi_sent_end(mspring_network *network, const mspringi_selection *at, const mspringi_values *values,
                       mspringi_sent_edit edit);

/// True if a comparison with what was sent last shows that nothing changes.
bool mspringi_springs_have_values(mspring_network *network, const mspringi_selection *at,
                                  const mspringi_values *values);

/// Set the values of particles (edit_particles.c) or springs (edit_springs.c). Unchanged ones are skipped.
mspring_result mspringi_set_particle_values(mspring_network *network, const mspringi_selection *at,
                                            const mspringi_values *values);
mspring_result mspringi_set_spring_values(mspring_network *network, const mspringi_selection *at,
                                          const mspringi_values *values);

#endif

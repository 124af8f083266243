/// @file sent_values.h
/// Copies of spring values that the host sends again and again.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SENT_VALUES_H
#define MSPRINGI_SENT_VALUES_H

#include <massspring/massspring.h>

/// Values of a property by id, as the host gave them last. Setting the same bits again changes nothing, so
/// comparing two arrays is enough. Comparing with records costs more: they lie by spring slot, and each cache line
/// holds one value of the property among others.
typedef struct mspringi_sent {
    float *values;         ///< [springs] NULL before the second call that sets a range
    uint64_t fingerprint;  ///< parameter_fingerprint at which they hold
    mspring_id first, end; ///< ids whose values are known
    uint32_t calls;        ///< that set a range: 0 or 1, then `values` exists
    uint32_t reserved;
} mspringi_sent;

/// Properties that have such a copy: stiffness, damping, rest length, and strains to break, stress and relax.
#define MSPRINGI_SENT_COUNT (MSPRING_RELAX_STRAIN - MSPRING_STIFFNESS + 1)

/// Index of such a property.
static inline int mspringi_sent_index(mspring_property property) {
    return (int)property - (int)MSPRING_STIFFNESS;
}

/// Forget a copy, as values have changed without a call of the host that set them.
static inline void mspringi_sent_forget(mspringi_sent *sent) {
    sent->first = sent->end = 0;
}

#endif

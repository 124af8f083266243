/// @file penetration.h
/// More sweeps of constraints that would get deeper.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_PENETRATION_H
#define MSPRINGI_PENETRATION_H

#include <stdbool.h>
#include <stdint.h>

struct mspringi_contacts;

/// Overlap up to which bodies may get deeper, as a share of the thickness.
#define MSPRINGI_KEPT_DEPTH 0.05

/// Constraints that a sweep of penetrating ones has to visit (penetration.c).
typedef struct mspringi_due_constraints {
    uint8_t *is_due;        ///< [constraint_capacity + 8] a node has another velocity than at the last visit
    uint32_t *first, *next; ///< [nodes], [3 constraint_capacity] constraints at a node, numbered as 3 i + 0 to 2
    uint64_t made;          ///< due in this sweep
    bool are_all;
} mspringi_due_constraints;

/// How an interval ends: solved; with bodies too deep in each other, as sweeps did not suffice; or too long, as
/// nodes move too far, or too deep into colliders.
typedef enum mspringi_interval_end {
    MSPRINGI_INTERVAL_SOLVED,
    MSPRINGI_INTERVAL_TOO_DEEP,
    MSPRINGI_INTERVAL_TOO_LONG
} mspringi_interval_end;

/// Sweep the constraints that would penetrate in an interval of h seconds. *any becomes true if there are any.
mspringi_interval_end mspringi_contact_resolve_penetration(struct mspringi_contacts *contacts, double h, bool *any);

#endif

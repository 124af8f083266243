/// @file constraint_list.h
/// Constraints of a linear system: terms besides the springs of its pattern.
///
/// A constraint is a scalar function of a few positions with the Jacobian J, an entry for each particle. In a
/// substep with a linear system it has the force
///
///     f = effort - stiffness J u,    at its particles J' f.
///
/// u is the displacement beyond the prediction. An idle constraint has the force 0. One at its bound has the
/// bound's force at the last update. Solving again finds the active set
/// (solvers/constraints/constraint_services.h).
///
/// Each substep clears the list. Owners then list their constraints: elements first, which have no bound, then the
/// others in the order of kinds (mspringi_constraints_add_terms). Within a kind, they follow ids or slots.
///
/// Not to be confused with a contact constraint (features/contact/contacts.h). In an implicit substep each of those
/// has up to two constraints here: a push and its friction.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CONSTRAINT_LIST_H
#define MSPRINGI_CONSTRAINT_LIST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <massspring/massspring.h>

/// Owner of a constraint. The order is that of the list.
typedef enum mspringi_constraint_kind {
    MSPRINGI_ANGLE_CONSTRAINT, ///< an element
    MSPRINGI_FLOOR_CONSTRAINT,
    MSPRINGI_GRIP_CONSTRAINT,
    MSPRINGI_CONTACT_CONSTRAINT, ///< between bodies, or with a collider; last, see constraint_services.c
    MSPRINGI_CONSTRAINT_KINDS
} mspringi_constraint_kind;

/// Bound of a constraint's force.
typedef enum mspringi_constraint_bound {
    MSPRINGI_UNBOUNDED,
    MSPRINGI_BOUND_PUSH,     ///< f >= 0; an idle one becomes active where it would push by more than `bound`
    MSPRINGI_BOUND_FRICTION, ///< |f| is at most `bound` times the force of the constraint before, a push
    MSPRINGI_BOUND_OF_PAIR,  ///< together with the next constraint: a vector of length `bound` at most
    MSPRINGI_SECOND_OF_PAIR, ///< the next constraint of such a pair
} mspringi_constraint_bound;

typedef enum mspringi_activity {
    MSPRINGI_IDLE,    ///< no force
    MSPRINGI_STIFF,   ///< a spring in the matrix
    MSPRINGI_AT_BOUND ///< a constant force, nothing in the matrix
} mspringi_activity;

/// Derivative of a constraint by the position of a particle.
typedef struct mspringi_jacobian_entry {
    uint32_t slot;
    double x, y;
} mspringi_jacobian_entry;

typedef struct mspringi_constraint {
    uint32_t first;   ///< index of its first entry
    uint32_t source;  ///< index in the list of its owner; 0 for the floor
    uint8_t count;    ///< number of its entries
    uint8_t kind;     ///< mspringi_constraint_kind
    uint8_t bounded;  ///< mspringi_constraint_bound
    uint8_t activity; ///< mspringi_activity in the next solution
    bool was_active;  ///< of a push: it was stiff in the last solution
    /// Its entries add up to 0: products take differences from the first one, and momentum is exact.
    bool is_closed;
    double stiffness, effort; ///< in units of the matrix and of the right-hand side
    double bound;             ///< of the force, see `bounded`
    double bound_force;       ///< force of a constraint at its bound
    double force;             ///< of the last solution
} mspringi_constraint;

/// Constraint whose force is an unknown of the direct solver.
typedef struct mspringi_multiplier {
    uint32_t constraint;               ///< in the list
    double root;                       ///< square root of its stiffness
    double residual, search, answer;   ///< of its iteration; answer: response to the search
    double beside[2], pivot, solution; ///< factor of the preconditioner's band, and its solution for the residual
} mspringi_multiplier;

/// Stiff constraint as the matrix's product reads it. Most listed ones are idle.
typedef struct mspringi_active_constraint {
    double stiffness;
    uint32_t first; ///< index of its first entry
    uint32_t shape; ///< twice the number of its entries, plus 1 if it is closed
} mspringi_active_constraint;

typedef struct mspringi_constraints {
    mspringi_constraint *list;          ///< [count]
    mspringi_jacobian_entry *entries;   ///< [entry_count] of the first constraint, of the second, and so on
    mspringi_multiplier *multipliers;   ///< [multiplier_capacity] of the direct solver: of elements, then of others
    mspringi_active_constraint *active; ///< [active_count] in the order of the list
    size_t capacity, entry_capacity, multiplier_capacity, active_capacity;
    size_t reserved[MSPRINGI_CONSTRAINT_KINDS];         ///< most constraints of a kind
    size_t reserved_entries[MSPRINGI_CONSTRAINT_KINDS]; ///< most entries of these
    uint32_t count, entry_count, active_count;
    uint32_t element_count, element_entry_count; ///< constraints of elements, at the beginning, and their entries
    bool has_elements;                           ///< elements have listed theirs for this substep
} mspringi_constraints;

/// Reserve room for the constraints of a kind, as many as its owner may ever list: a kind has one owner, and the
/// largest of its reservations counts. Their memory is allocated at once if a solver of the network has a linear
/// system; else by mspringi_constraints_allocate(), before such a solver is made. A kind that can have more than
/// one particle counts among the unknowns there. @return false: out of memory, and nothing has changed
bool mspringi_constraints_reserve(mspring_network *network, mspringi_constraint_kind kind, size_t count,
                                  size_t entries);
bool mspringi_constraints_allocate(mspring_network *network);

/// Clear the list for a new substep.
void mspringi_constraints_begin(mspringi_constraints *all);
/// Add a stiff constraint without entries. Room is reserved for it and for `entries` of them, 255 at most.
mspringi_constraint *mspringi_constraint_add(mspringi_constraints *all, mspringi_constraint_kind kind,
                                             uint32_t source, uint32_t entries);
/// Add the next entry of the last constraint.
static inline void mspringi_constraint_add_entry(mspringi_constraints *all, uint32_t slot, double x, double y) {
    all->entries[all->entry_count++] = (mspringi_jacobian_entry){slot, x, y};
    all->list[all->count - 1].count++;
}

/// True if it has a force. Friction is idle with its push.
static inline bool mspringi_constraint_is_active(const mspringi_constraint *c) {
    return c->activity != MSPRINGI_IDLE &&
           (c->bounded != MSPRINGI_BOUND_FRICTION || c[-1].activity != MSPRINGI_IDLE);
}
/// True if it is a spring in the matrix.
static inline bool mspringi_constraint_is_stiff(const mspringi_constraint *c) {
    return c->activity == MSPRINGI_STIFF && mspringi_constraint_is_active(c);
}

/// True if a factored matrix has it, on the diagonal. Contact with a collider is an unknown instead: in a factor of
/// single precision a stack on pinned ground trembled at 0.055 m/s instead of 0.002, in double precision at 0.015.
static inline bool mspringi_constraint_is_diagonal(const mspringi_constraint *c) {
    return c->count == 1 && c->kind != MSPRINGI_CONTACT_CONSTRAINT;
}
/// True if its force is an unknown of the direct solver, because the factored matrix has no entry for it.
static inline bool mspringi_constraint_is_unknown(const mspringi_constraint *c) {
    return !mspringi_constraint_is_diagonal(c) && c->stiffness > 0.0 && mspringi_constraint_is_stiff(c);
}

/// Find the floor's next push after `after`, or its first one if that is NULL. Return NULL at the end.
const mspringi_constraint *mspringi_next_floor_push(const mspringi_constraints *all,
                                                    const mspringi_constraint *after);
/// Force of the friction that follows a push; 0 without friction.
static inline double mspringi_friction_of(const mspringi_constraints *all, const mspringi_constraint *push) {
    const mspringi_constraint *next = push + 1;
    return next < all->list + all->count && next->bounded == MSPRINGI_BOUND_FRICTION && push->was_active
               ? next->force
               : 0.0;
}

#endif

/// @file constraint_list.h
/// Constraints of a linear system: whatever pushes at particles besides the springs of its pattern.
///
/// A constraint is a scalar function of a few positions with the Jacobian J, an entry for each particle. In a
/// substep with a linear system it has the force
///
///     f = effort - stiffness J u,    at its particles J' f,
///
/// u being the displacement beyond the prediction. An idle one has the force 0, one at its bound the force of that
/// bound at the last update. Solving again finds the active set (solvers/implicit/constraint_services.h).
///
/// Each kind lists its constraints anew in each substep. The list has the order of the kinds, and within a kind of
/// ids. Elements come first: they have no bound.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_CONSTRAINT_LIST_H
#define MSPRINGI_CONSTRAINT_LIST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <massspring/massspring.h>

/// Owner of a constraint: `source` is an index into its list.
typedef enum mspringi_constraint_kind {
    MSPRINGI_ANGLE_CONSTRAINT,
    MSPRINGI_FLOOR_CONSTRAINT,
    MSPRINGI_GRIP_CONSTRAINT,
    MSPRINGI_CONTACT_CONSTRAINT, ///< between bodies, or with a collider
    MSPRINGI_CONSTRAINT_KINDS
} mspringi_constraint_kind;

/// Bound of a constraint's force.
typedef enum mspringi_constraint_bound {
    MSPRINGI_UNBOUNDED,
    MSPRINGI_BOUND_PUSH,     ///< f >= 0; an idle one becomes active where it would push by more than `bound`
    MSPRINGI_BOUND_FRICTION, ///< |f| is at most `bound` times the force of the constraint before, a push
    MSPRINGI_BOUND_OF_PAIR,  ///< together with the next constraint: a vector of length `bound` at most
    MSPRINGI_SECOND_OF_PAIR, ///< ... and this is the next one
} mspringi_constraint_bound;

typedef enum mspringi_activity { MSPRINGI_IDLE, MSPRINGI_STIFF, MSPRINGI_AT_BOUND } mspringi_activity;

typedef struct mspringi_jacobian_entry {
    uint32_t slot;
    double x, y;
} mspringi_jacobian_entry;

typedef struct mspringi_constraint {
    uint32_t first; ///< of its entries
    uint32_t source;
    uint8_t count; ///< of its entries
    uint8_t kind, bounded, activity;
    bool was_active; ///< a push: in the last solution
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
    double root;                       ///< of its stiffness
    double residual, search, answer;   ///< of its iteration
    double beside[2], pivot, solution; ///< factor of the preconditioner's band, and its solution for the residual
} mspringi_multiplier;

/// Constraint that is in the matrix, as its product needs it: most of the listed ones are idle.
typedef struct mspringi_active_constraint {
    double stiffness;
    uint32_t first; ///< of its entries
    uint32_t shape; ///< twice their number; 1 more: it is closed
} mspringi_active_constraint;

typedef struct mspringi_constraints {
    mspringi_constraint *list;          ///< [count]
    mspringi_jacobian_entry *entries;   ///< [entry_count] of the first constraint, of the second, and so on
    mspringi_multiplier *multipliers;   ///< [multiplier_capacity] of the direct solver: elements', then others'
    mspringi_active_constraint *active; ///< [active_count] in the order of the list
    size_t capacity, entry_capacity, multiplier_capacity, active_capacity;
    size_t reserved[MSPRINGI_CONSTRAINT_KINDS];         ///< most constraints of a kind
    size_t reserved_entries[MSPRINGI_CONSTRAINT_KINDS]; ///< and their entries
    uint32_t count, entry_count, active_count;
    uint32_t element_count, element_entry_count; ///< those without bounds, at the beginning
    bool has_elements;                           ///< these are listed for this substep
} mspringi_constraints;

/// Reserve for a kind. Memory is allocated once a solver of the network has a linear system, and before one is made
/// by mspringi_constraints_allocate(). @return false: out of memory, and nothing has changed
bool mspringi_constraints_reserve(mspring_network *network, mspringi_constraint_kind kind, size_t count,
                                  size_t entries);
bool mspringi_constraints_allocate(mspring_network *network);

/// Clear the list for a new substep.
void mspringi_constraints_begin(mspringi_constraints *all);
/// Add a stiff constraint that has no entries yet; there is room for it and for so many, 255 at most.
mspringi_constraint *mspringi_constraint_add(mspringi_constraints *all, mspringi_constraint_kind kind,
                                             uint32_t source, uint32_t entries);
/// Add the next entry of the last constraint.
static inline void mspringi_constraint_add_entry(mspringi_constraints *all, uint32_t slot, double x, double y) {
    all->entries[all->entry_count++] = (mspringi_jacobian_entry){slot, x, y};
    all->list[all->count - 1].count++;
}

/// True if it has a force; if it resists motion in the matrix. Friction is idle with its push.
static inline bool mspringi_constraint_is_active(const mspringi_constraint *c) {
    return c->activity != MSPRINGI_IDLE &&
           (c->bounded != MSPRINGI_BOUND_FRICTION || c[-1].activity != MSPRINGI_IDLE);
}
static inline bool mspringi_constraint_is_stiff(const mspringi_constraint *c) {
    return c->activity == MSPRINGI_STIFF && mspringi_constraint_is_active(c);
}

/// True if it is on the diagonal of the matrix. A collider's contact is not: in a factor of single precision a
/// stack on pinned ground trembled at 0.055 m/s instead of 0.002, in double precision at 0.015.
static inline bool mspringi_constraint_is_diagonal(const mspringi_constraint *c) {
    return c->count == 1 && c->kind != MSPRINGI_CONTACT_CONSTRAINT;
}
/// True if its force is an unknown beside a factored matrix, which has no entry for it.
static inline bool mspringi_constraint_is_unknown(const mspringi_constraint *c) {
    return !mspringi_constraint_is_diagonal(c) && c->stiffness > 0.0 && mspringi_constraint_is_stiff(c);
}

/// Find the next push of the floor after one, or the first after NULL; NULL at the end.
const mspringi_constraint *mspringi_next_floor_push(const mspringi_constraints *all,
                                                    const mspringi_constraint *after);
/// Force of a push's friction, which follows it; 0 without.
static inline double mspringi_friction_of(const mspringi_constraints *all, const mspringi_constraint *push) {
    const mspringi_constraint *next = push + 1;
    return next < all->list + all->count && next->bounded == MSPRINGI_BOUND_FRICTION && push->was_active
               ? next->force
               : 0.0;
}

#endif

/// @file implicit.h
/// The implicit solver: one linear system a substep, whatever the stiffness.
///
///   weigh, fly, predict    where the particles would be without forces               integrator.c
///   assemble               springs, linearised there, into A d = b                   assemble.c
///   solve                  two-level preconditioned conjugate gradients              conjugate_gradients.c,
///   tiles.c, coarse.c
///                          or, for the direct solver, a factorisation                solvers/direct/direct.c
///   land                   positions and velocities from d                           integrator.c
///   budget                 what no force has done is taken back                      energy_budget.h
///
/// Workers share all of it (team.h): slots in chunks, rows in panels (panels.h), and tiles. Whatever is summed is
/// summed in these pieces first, so that the bits do not depend on how many there are. The factorisation of the
/// direct solver is one worker's.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_IMPLICIT_H
#define MSPRINGI_IMPLICIT_H

#include "store/network.h"
#include "tasks/team.h"

#include "solvers/direct/direct.h"
#include "solvers/implicit/coarse.h"
#include "solvers/implicit/energy_budget.h"
#include "solvers/implicit/panels.h"
#include "solvers/implicit/tiles.h"

/// Slots from which more than one worker is worth it.
#define MSPRINGI_SMALLEST_SHARED_SLOTS 4096

/// Most iterations, and most substeps with one coarse matrix.
#define MSPRINGI_MOST_ITERATIONS 10000

/// What is the integrator's, apart from the state: kept from substep to substep, restored with the state.
typedef struct mspringi_history {
    mspringi_field first;  ///< acceleration, m/s^2; of BDF2: the last displacement beyond h v, m
    mspringi_field second; ///< of BDF2: the last change of velocity, m/s; else NULL
    float h;               ///< substep that it belongs to, s
    uint32_t restarts;     ///< substeps to come that are of implicit Euler, as there is none or it says nothing
} mspringi_history;

/// Iterations after which a substep is taken as it comes: no piece is taken again, and contact acts after it alone.
/// They bound the product of pieces, halvings, passes, and iterations within iterations. (Heaps and presses need
/// 8,000. A tangle of 87 springs with contact and angles took 310,000 in a substep, 1.3 s; these take 70 ms.)
/// Whoever asks for many iterations gets as many more.
#define MSPRINGI_MOST_SOLVES 16384u
#define MSPRINGI_TIMES_SOLVED 32u

/// How contact between bodies acts in a substep: with friction; without, where friction and what presses bodies
/// together would raise each other; after the substep alone, by impulses.
typedef enum mspringi_contact_mode {
    MSPRINGI_CONTACT_WITH_FRICTION,
    MSPRINGI_CONTACT_FRICTIONLESS,
    MSPRINGI_CONTACT_BY_IMPULSES
} mspringi_contact_mode;

typedef struct mspringi_implicit {
    mspring_integrator integrator;
    uint32_t iterations, coarse_period;
    uint32_t tile_size;     ///< as asked for: 0 is by plan
    uint32_t age;           ///< substeps since the coarse matrix was factored; 0: it is to be
    uint32_t kept_age;      ///< before the step; 0: there is none to go back to
    uint32_t kept_restarts; ///< those of the history before the step
    uint32_t retry_count;   ///< pieces of this substep that were undone
    uint32_t solves;        ///< iterations of this substep, each of which multiplies by the system or its inverse
    double scale;           ///< power of two that brings masses near 1

    mspringi_history history, backup; ///< backup is that of before the step once that has written one
    mspringi_history previous;        ///< what the next substep is written to; that of before the last substep
    bool is_kept;                     ///< history is that of before the step
    bool is_first;                    ///< the last substep was the first of a step, so backup is what was before it
    bool has_changed;                 ///< backup is
    size_t history_size;              ///< floats in a history

    double *x, *y;           ///< [slots] predicted positions, in one block
    mspringi_field velocity; ///< after the substep, if d were 0
    mspringi_field residual, displacement, direction, product, scaled;
    mspringi_field arm;                 ///< from the mass centre of its tile to each particle, m
    float *mass;                        ///< [slots] scaled; 0 if pinned or empty
    float *diagonal;                    ///< [slots] xx, then xy, then yy of A's blocks, then of their inverses
    float *factors;                     ///< of lattices, chains and irregular springs, one behind the other
    float *irregular_factors;           ///< where those of the irregular springs begin: [block][factor][lane]
    double *force_carry;                ///< carry rows, one for each worker: see mspringi_system
    float *carry;                       ///< likewise
    double (*unknowns)[MSPRINGI_RIGID]; ///< [workers][tiles] of the coarse matrix; each worker solves for them
    uint32_t team;                      ///< workers that there are carry rows and unknowns for
    uint32_t solo_substeps;             ///< substeps to come that one worker takes, as others had no core
    uint32_t solo_backoff;              ///< how many these were to be
    float *sums;                        ///< [chunks]
    mspringi_tile_motion *tile_motions; ///< [tiles]
    uint8_t *is_coupled;                ///< [loose and spare slots] 1 where springs were added, so that A is not
                                        ///< diagonal there; NULL: nowhere
    double irregular_product;           ///< what irregular springs and contacts add to p . A p
    bool uses_euler;                    ///< the present substep is one of implicit Euler: particles hit the floor,
                                        ///< or motion is not to be followed as the integrator would
    bool restarts_with_euler;           ///< it is to be begun again, as one of implicit Euler
    bool must_solve_again;              ///< it is to be solved again, as floor or grips hold particles otherwise
    mspringi_contact_mode contact_mode; ///< how rows between bodies hold in the present substep
    bool is_piece;                      ///< it is a half of one that got energy from nowhere, or of such a half
    mspringi_system system;
    mspringi_iterate iterate;
    mspringi_edits seen;                      ///< the edits that it has followed
    struct mspringi_implicit_builder *making; ///< NULL: it is complete
    size_t used_slot_end; ///< behind these no particle has ever been: all that is kept by slot is 0 there
    uint64_t rested;      ///< edits.naps for which what sleeps is at rest in all that is kept by slot

    mspringi_budget budget;
    mspringi_panels panels;
    bool is_direct;
    mspringi_direct direct; ///< all there is of it unless is_direct: zero
    mspringi_tiles tiles;   ///< none, nor a coarse matrix, if it is
    mspringi_coarse coarse;
} mspringi_implicit;

/// The object of the solver that takes the step that is being made.
static inline mspringi_implicit *mspringi_implicit_of(const mspring_network *network) {
    MSPRINGI_ASSERT(network->running);
    return network->running->object;
}

/// Make an implicit solver, as the operations create and build of store/solver.h.
mspring_result mspringi_implicit_begin(mspring_network *network, const mspring_solver_def *def, uint32_t tile_size,
                                       mspringi_implicit **begun);
mspring_result mspringi_implicit_make(mspringi_implicit *implicit, bool *is_done);
void mspringi_implicit_adjust(mspringi_implicit *implicit, const mspring_solver_def *def);
void mspringi_implicit_destroy(mspringi_implicit *implicit, mspringi_memory *memory);
/// Have a copied solver's pointers lead into the copy of its network.
void mspringi_implicit_relocate(mspringi_implicit *implicit, const mspring_network *network,
                                const mspringi_memory *from, const mspringi_memory *to);
/// Have carry rows for the workers that there are now.
mspring_result mspringi_implicit_reserve(mspringi_implicit *implicit, mspring_network *network);

/// Forget the history, as if a new motion began.
void mspringi_implicit_forget(mspringi_implicit *implicit);

/// Take count substeps of length h, all with the forces from outside that are in base (x NULL: none).
void mspringi_implicit_run_substeps(mspring_network *network, float h, mspringi_field base, uint32_t count);

/// Cut tiles anew where springs broke or were restored, or pins changed. Allocates nothing.
void mspringi_implicit_update(const mspring_network *network, mspringi_implicit *implicit);

/// Keep the history for a step that fails, and get it back.
void mspringi_implicit_keep(mspringi_implicit *implicit);
void mspringi_implicit_restore(const mspring_network *network, mspringi_implicit *implicit);

/* implicit_snapshot.c: a snapshot's section */

void mspringi_implicit_save(const mspring_network *network, const mspringi_implicit *implicit,
                            struct mspringi_writer *to);
mspring_result mspringi_implicit_check(mspring_network *network, const mspringi_implicit *implicit,
                                       const uint8_t *from, size_t size);
void mspringi_implicit_load(mspring_network *network, mspringi_implicit *implicit, const uint8_t *from,
                            size_t size);

/// What the workers of one substep share.
typedef struct mspringi_implicit_substep {
    mspring_network *network;
    mspringi_field base;
    float h;
    float mass_scale;
    bool watches; ///< with an energy budget
    uint32_t workers;
    mspringi_progress *progress;
    mspringi_prediction prediction;
    mspringi_outside outside[2];
    mspringi_correction correction[2];
    mspringi_history_kind history;
} mspringi_implicit_substep;

/// A range of slots: those of a team member's share of the chunks.
typedef struct mspringi_slots {
    size_t first, end;
} mspringi_slots;
static inline mspringi_slots mspringi_slots_of(const mspring_network *network, const mspringi_team_member *member) {
    const size_t slots = mspringi_implicit_of(network)->used_slot_end;
    const size_t chunks = (slots + MSPRINGI_CHUNK - 1) / MSPRINGI_CHUNK;
    const size_t end = mspringi_range_end(member, chunks) * MSPRINGI_CHUNK;
    return (mspringi_slots){mspringi_range_begin(member, chunks) * MSPRINGI_CHUNK, end < slots ? end : slots};
}

/// Whether a team member computes what a tile or cell with this slot in its middle needs: its particles are mostly
/// those that the team member moves. (With equal shares of tiles in their order, half of all particles went from
/// core to core and back in each iteration. Where cores are far apart, two workers took 1.15 times as long as one
/// then.)
static inline bool mspringi_slot_is_of(const mspring_network *network, const mspringi_team_member *member,
                                       size_t slot) {
    const mspringi_slots slots = mspringi_slots_of(network, member);
    return slot >= slots.first && (slot < slots.end || member->index + 1 == member->count);
}
static inline bool mspringi_tile_is_of(const mspring_network *network, const mspringi_team_member *member,
                                       size_t tile) {
    const mspringi_tiles *tiles = &mspringi_implicit_of(network)->tiles;
    const uint32_t middle = (tiles->first_part[tile] + tiles->first_part[tile + 1]) / 2;
    return member->count == 1 || mspringi_slot_is_of(network, member, tiles->parts[middle].first_slot);
}

/// The next of these slots that are to be gone through, in whole chunks, from *at on, which goes behind them: all,
/// but for chunks in which nothing is swept. Returns false if there are none.
bool mspringi_next_slots(const mspring_network *network, mspringi_slots slots, size_t *at, mspringi_slots *run);

/// Slots of loose particles, spare ones among them, and whether one of them is in the linear system.
static inline mspringi_slots mspringi_loose_slots(const mspringi_topology *t, const mspringi_slots *within) {
    const size_t loose = (size_t)t->loose_first * MSPRINGI_WIDTH;
    const size_t loose_end = loose + ((size_t)t->loose_blocks + t->spare_blocks) * MSPRINGI_WIDTH;
    return (mspringi_slots){within->first > loose ? within->first : loose,
                            within->end < loose_end ? within->end : loose_end};
}
static inline bool mspringi_is_coupled(const mspring_network *network, const mspringi_implicit *n, size_t slot) {
    return n->is_coupled && n->is_coupled[slot - (size_t)network->topology.loose_first * MSPRINGI_WIDTH];
}

/// True if a substep may take more iterations.
static inline bool mspringi_may_iterate(const mspringi_implicit *n) {
    return n->solves < MSPRINGI_MOST_SOLVES + MSPRINGI_TIMES_SOLVED * n->iterations;
}

/* integrator.c */

/// Where an integrator puts the forces: A = M + c K + s C, with c = force_fraction h^2 and s = c velocity_fraction
/// / h; the velocity after the substep is that of d = 0 plus velocity_fraction d / h.
typedef struct mspringi_integrator_coefficients {
    double force_fraction, velocity_fraction;
} mspringi_integrator_coefficients;
mspringi_integrator_coefficients mspringi_integrator_coefficients_of(mspring_integrator integrator);

/// Fill in all that a substep needs to know but its workers.
void mspringi_integrator_prepare(mspringi_implicit_substep *substep);
void mspringi_predict(const mspringi_implicit_substep *substep, mspringi_team_member *member);
/// d = displacement + alpha direction.
void mspringi_correct(const mspringi_implicit_substep *substep, const mspringi_team_member *member, float alpha);
/// Let the history be that of the substep that has landed.
void mspringi_integrator_accept(const mspringi_implicit_substep *substep);
/// Go back to the history of before the substep that has landed.
void mspringi_integrator_undo(mspring_network *network);

/* assemble.c */

/// Whether nothing of a panel is to be swept.
bool mspringi_panel_is_asleep(const mspring_network *network, const mspringi_panel *panel);

void mspringi_assemble(const mspringi_implicit_substep *substep, mspringi_team_member *member);
/// product = A direction. Returns their scalar product, when all have met.
double mspringi_multiply(const mspringi_implicit_substep *substep, mspringi_team_member *member);

/* conjugate_gradients.c: from residual, factors and diagonal to d */

/// Solve for d, but for the last step along the direction. Returns its length; NaN if numbers overflowed.
float mspringi_solve(const mspringi_implicit_substep *substep, mspringi_team_member *member);

#endif

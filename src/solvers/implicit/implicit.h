/// @file implicit.h
/// Implicit solver: one linear system a substep, stable at any stiffness.
///
/// In the order of a substep:
///
///   predict     positions and velocities without spring forces                    integrator.c
///   assemble    matrix A and right-hand side b of A d = b, linearised there       assemble.c
///   terms       floor, contact and areas in the system                            implicit_terms.h
///               constraints: angles, grips                                        constraints/
///   condense    ropes out of the system, and their displacements at the end       paths.h, condense.c
///   solve       conjugate gradients with a two-level preconditioner               conjugate_gradients.c
///                 its coarse space: cells, tiles, the coarse matrix               cells.h, tiles.h, coarse.h
///               or, in the direct solver, a factorisation                         solvers/direct/direct.c
///   correct     positions and velocities from the displacement d                  integrator.c
///   budget      energy, momentum and spin that no force explains are removed      energy_budget.h
///
/// implicit_substeps.c runs this, and solves again while the active set of floor, contact and grips changes.
///
/// A spring adds three *factors* to A: a vector `pull` along it, and its geometric stiffness. Its 2 x 2 block is
/// pull pull' + geometric I. So pull' pull is the remaining stiffness along the spring, with damping.
///
/// Workers share slots in chunks, rows in panels (panels.h), and tiles (team.h). Sums are over these parts first,
/// so bits do not depend on the number of workers. One worker factors the matrix of the direct solver.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_IMPLICIT_H
#define MSPRINGI_IMPLICIT_H

#include "store/network.h"
#include "tasks/team.h"

#include "solvers/constraints/constraint_services.h"
#include "solvers/direct/direct.h"
#include "solvers/implicit/coarse.h"
#include "solvers/implicit/energy_budget.h"
#include "solvers/implicit/panels.h"
#include "solvers/implicit/paths.h"
#include "solvers/implicit/tiles.h"

/// Fewest slots for more than one worker.
#define MSPRINGI_SMALLEST_SHARED_SLOTS 4096

/// Most iterations, and most substeps with one coarse matrix.
#define MSPRINGI_MOST_ITERATIONS 10000

/// State of the integrator: kept from substep to substep, restored with the state.
typedef struct mspringi_history {
    mspringi_field first;  ///< acceleration, m/s^2; of BDF2: the last displacement beyond h v, m
    mspringi_field second; ///< of BDF2: the last change of velocity, m/s; else NULL
    float h;               ///< substep that it belongs to, s
    uint32_t restarts;     ///< coming substeps of implicit Euler, because the history is missing or of no use
} mspringi_history;

/// Contact between bodies in a substep: with friction; without it, where friction and normal forces would raise
/// each other; by impulses after the substep only.
typedef enum mspringi_contact_mode {
    MSPRINGI_CONTACT_WITH_FRICTION,
    MSPRINGI_CONTACT_FRICTIONLESS,
    MSPRINGI_CONTACT_BY_IMPULSES
} mspringi_contact_mode;

/// Causes for a loose particle to be an unknown of the system. The equation of others is their mass alone.
enum { MSPRINGI_UNCOUPLED, MSPRINGI_COUPLED_BY_SPRINGS, MSPRINGI_COUPLED_BY_CONTACT };

typedef struct mspringi_implicit {
    mspring_integrator integrator;
    uint32_t iterations, coarse_period; ///< iterations: the most of a solution
    float residual_share;               ///< that ends them: mspring_settings.residual
    uint32_t tile_size;                 ///< as requested; 0: automatic
    uint32_t age;                       ///< substeps since the coarse matrix was factored; 0: factor it
    bool has_constraints_in_coarse;     ///< with bounds: they come and go, so it is not used again
    uint32_t kept_age;                  ///< before the step; 0: nothing to restore
    uint32_t kept_restarts;             ///< restarts of the history before the step
    uint32_t product_count;  ///< products with A or its inverse in this step; a direct solution is one more
    uint32_t pass_count;     ///< solutions in this step
    uint32_t intervals_left; ///< of the substep, behind the present one
    double work_rate;        ///< work that a second is allowed
    double most_work;        ///< of this step up to the present substep: beyond it nothing is repeated
    bool is_spent;           ///< something was not, for that reason
    double scale;            ///< power of two that brings masses near 1

    mspringi_history history, backup; ///< backup: before the step, once the step has changed it
    mspringi_history previous;        ///< output of the next substep; until then, before the last one
    bool is_kept;                     ///< history is still that of before the step
    bool is_first;                    ///< the last substep was the first of a step, so backup is its start
    bool has_changed;                 ///< backup is in use
    size_t history_size;              ///< floats in a history

    double *x, *y;           ///< [slots] predicted positions, in one block
    mspringi_field velocity; ///< velocity after the substep for d = 0
    /// Vectors of the iteration: residual, N s^2; displacement d and search direction, m; product: A direction, N
    /// s^2; scaled: D^-1 residual, m (conjugate_gradients.c). Forces in them have the factor `scale`.
    mspringi_field residual, displacement, direction, product, scaled;
    mspringi_field arm;                 ///< from the tile's mass centre to each particle, m
    float *mass;                        ///< [slots] scaled; 0 if pinned or empty
    float *diagonal;                    ///< [slots] xx, then xy, then yy of A's blocks, then of their inverses
    float *factors;                     ///< factors of lattice, chain and irregular springs, end to end
    float *irregular_factors;           ///< first factors of irregular springs: [block][factor][lane]
    double *force_carry;                ///< carry rows, one for each worker (mspringi_system)
    float *carry;                       ///< likewise for blocks of A, and for products
    double (*unknowns)[MSPRINGI_RIGID]; ///< [workers][tiles] of the coarse matrix; each worker solves for them
    uint32_t team;                      ///< workers with carry rows and unknowns
    uint32_t solo_substeps;             ///< coming substeps of one worker, because others had no core
    uint32_t solo_backoff;              ///< length of the present run of them
    float *sums;                        ///< [chunks]
    double *other_sums;                 ///< [chunks] p . A p of what panels do not have
    mspringi_tile_motion *tile_motions; ///< [tiles]
    uint8_t *couplings;                 ///< [loose and spare slots] what makes them unknowns, and one more
    float *forces_of_loose;             ///< [2][the same] without contact, while that couples them
    bool has_touched;                   ///< contact couples loose particles
    bool uses_euler;          ///< the present substep is of implicit Euler: an impact, or a history of no use
    bool restarts_with_euler; ///< repeat it as one of implicit Euler
    bool must_solve_again;    ///< solve again: the active set has changed
    bool is_cut_off;          ///< it has, but no work is left for that
    bool would_be_same;       ///< taken again whole, by implicit Euler, the substep would end as it did
    mspringi_contact_mode contact_mode; ///< of the present substep
    bool holds_overlaps;                ///< pushing overlaps apart gained energy: it holds them as they are
    bool is_half;                       ///< it is a half of one that gained energy, or of such a half
    mspringi_system system;
    mspringi_iterate iterate;
    mspringi_edits seen;                      ///< edits up to the last update
    struct mspringi_implicit_builder *making; ///< NULL: it is complete
    size_t used_slot_end;                     ///< no slot behind has had a particle: arrays by slot are 0 there
    uint64_t rested; ///< edits.sleep_changes up to which arrays by slot are at rest for sleeping particles

    mspringi_budget budget;
    mspringi_panels panels;
    bool may_have_overflowed; ///< the motion was forgotten: clear work vectors before the next substep
    bool is_direct;
    mspringi_direct direct; ///< zero unless is_direct
    mspringi_tiles tiles;   ///< tiles and coarse are empty if is_direct
    mspringi_coarse coarse;
    mspringi_paths paths; ///< empty if is_direct
} mspringi_implicit;

/// The running solver's implicit object.
static inline mspringi_implicit *mspringi_implicit_of(const mspring_network *network) {
    MSPRINGI_ASSERT(network->running);
    return network->running->object;
}

/// Make an implicit solver, as the operations create and build of store/solver.h.
mspring_result mspringi_implicit_begin(mspring_network *network, const mspring_settings *def, uint32_t tile_size,
                                       mspringi_implicit **begun);
mspring_result mspringi_implicit_make(mspringi_implicit *implicit, bool *is_done);
void mspringi_implicit_adjust(mspringi_implicit *implicit, const mspring_settings *def);
void mspringi_implicit_destroy(mspringi_implicit *implicit, mspringi_memory *memory);
/// Redirect a copied solver's pointers into the copy of its network.
void mspringi_implicit_relocate(mspringi_implicit *implicit, const mspring_network *network,
                                const mspringi_memory *from, const mspringi_memory *to);
/// Reserve carry rows for the present workers.
mspring_result mspringi_implicit_reserve(mspringi_implicit *implicit, mspring_network *network);

/// Forget the history, as if a new motion began.
void mspringi_implicit_forget(mspringi_implicit *implicit);

/// Take count substeps of length h with the outside forces in base (x NULL: none).
void mspringi_implicit_run_substeps(mspring_network *network, float h, mspringi_field base, uint32_t count);

/// Update tiles where springs broke or were restored, or pins changed. Allocates nothing.
void mspringi_implicit_update(const mspring_network *network, mspringi_implicit *implicit);

/// Save the history before a step, and restore it after a failed one.
void mspringi_implicit_keep(mspringi_implicit *implicit);
void mspringi_implicit_restore(const mspring_network *network, mspringi_implicit *implicit);
/// After an overflow, clear the arrays that are 0 between steps.
void mspringi_implicit_clear_overflow(const mspring_network *network, mspringi_implicit *n);

/* implicit_snapshot.c: a snapshot's section */

void mspringi_implicit_save(const mspring_network *network, const mspringi_implicit *implicit,
                            struct mspringi_writer *to);
mspring_result mspringi_implicit_check(mspring_network *network, const mspringi_implicit *implicit,
                                       const uint8_t *from, size_t size);
void mspringi_implicit_load(mspring_network *network, mspringi_implicit *implicit, const uint8_t *from,
                            size_t size);
/// In archives: see mspringi_by_id (store/sections.h).
uint32_t mspringi_implicit_runs(const mspring_network *network, const mspringi_implicit *implicit,
                                struct mspringi_io head, struct mspringi_run *runs);
void mspringi_implicit_leave(const mspring_network *network, uint8_t *section, size_t size);
size_t mspringi_implicit_enter(const mspring_network *network, const mspringi_implicit *implicit, uint8_t *section,
                               size_t size);

/// Arguments that the workers of a substep share.
typedef struct mspringi_implicit_substep {
    mspring_network *network;
    mspringi_field base;
    float h;
    float mass_scale; ///< mspringi_implicit.scale, and what global damping adds to masses
    bool watches;     ///< with an energy budget
    uint32_t workers;
    mspringi_progress *progress;
    mspringi_prediction prediction;
    mspringi_outside outside[2];
    mspringi_correction correction[2];
    mspringi_history_kind history;
} mspringi_implicit_substep;

/// A team member's share of the chunks in use.
static inline mspringi_slots mspringi_slots_of(const mspring_network *network, const mspringi_team_member *member) {
    const size_t slots = mspringi_implicit_of(network)->used_slot_end;
    const size_t chunks = (slots + MSPRINGI_CHUNK - 1) / MSPRINGI_CHUNK;
    const size_t end = mspringi_range_end(member, chunks) * MSPRINGI_CHUNK;
    return (mspringi_slots){mspringi_range_begin(member, chunks) * MSPRINGI_CHUNK, end < slots ? end : slots};
}

/// A share of all chunks: the last member has those that are not in use, too.
static inline mspringi_slots mspringi_all_slots_of(const mspring_network *network,
                                                   const mspringi_team_member *member) {
    const mspringi_slots slots = mspringi_slots_of(network, member);
    return (mspringi_slots){slots.first,
                            member->index + 1 == member->count ? mspringi_slot_count(network) : slots.end};
}

/// True if a team member owns a tile or cell whose middle slot this is: it moves most of its particles. (With equal
/// shares of tiles in their order, half of all particles went from core to core in each iteration. Where cores are
/// far apart, two workers then took 1.15 times as long as one.)
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

/// Find the next run of whole chunks with awake particles from *at on, and move *at behind it. Return false at the
/// end.
bool mspringi_next_slots(const mspring_network *network, mspringi_slots slots, size_t *at, mspringi_slots *run);

/// Slots of loose particles, spare ones included, and the coupling of one of them.
static inline mspringi_slots mspringi_loose_slots(const mspringi_topology *t, const mspringi_slots *within) {
    const size_t loose = (size_t)t->loose_first * MSPRINGI_WIDTH;
    const size_t loose_end = loose + ((size_t)t->loose_blocks + t->spare_blocks) * MSPRINGI_WIDTH;
    return (mspringi_slots){within->first > loose ? within->first : loose,
                            within->end < loose_end ? within->end : loose_end};
}
static inline uint8_t *mspringi_coupling_of(const mspring_network *network, const mspringi_implicit *n,
                                            size_t slot) {
    return &n->couplings[slot - (size_t)network->topology.loose_first * MSPRINGI_WIDTH];
}

/* work.c: in the unit of mspring_settings.most_work */

/// Most iterations of a solution for which calm ones are multiplied by `times`.
uint32_t mspringi_implicit_most_iterations(const mspringi_implicit *n, uint32_t times);
/// Work of a substep in which nothing is repeated.
double mspringi_implicit_calm_work(const mspringi_implicit *n);
/// Work of this step so far.
double mspringi_implicit_work(const mspringi_implicit *n);
/// Set the work that a second of the coming step is allowed.
void mspringi_implicit_allow_work(mspringi_implicit *n, double rate);
/// True if something may be repeated: the intervals that are still to come have work left, too.
bool mspringi_implicit_may_repeat(mspringi_implicit *n);
/// Return so many intervals of a substep, or as many as have work left.
uint32_t mspringi_implicit_limit_intervals(mspringi_implicit *n, uint32_t intervals);

/* integrator.c */

/// Coefficients of an integrator: A = M + c K + s C with c = force_fraction h^2 and s = c velocity_fraction / h.
/// The velocity after the substep grows by velocity_fraction d / h.
typedef struct mspringi_integrator_coefficients {
    double force_fraction, velocity_fraction;
} mspringi_integrator_coefficients;
mspringi_integrator_coefficients mspringi_integrator_coefficients_of(mspring_integrator integrator);

/// True if the present substep is of implicit Euler.
bool mspringi_integrator_is_euler(const mspringi_implicit *n);
/// Prepare a substep for its workers.
void mspringi_integrator_prepare(mspringi_implicit_substep *substep);
void mspringi_predict(const mspringi_implicit_substep *substep, mspringi_team_member *member);
/// d = displacement + alpha direction.
void mspringi_correct(const mspringi_implicit_substep *substep, const mspringi_team_member *member, float alpha);
/// Accept the history of the corrected substep.
void mspringi_integrator_accept(const mspringi_implicit_substep *substep);
/// Restore the history of before that substep.
void mspringi_integrator_undo(mspring_network *network);

/* assemble.c */

/// True if all of a panel sleeps.
bool mspringi_panel_is_asleep(const mspring_network *network, const mspringi_panel *panel);

void mspringi_assemble(const mspringi_implicit_substep *substep, mspringi_team_member *member);
/// product = A direction. Return direction . product, after a barrier.
double mspringi_multiply(const mspringi_implicit_substep *substep, mspringi_team_member *member);

/* conjugate_gradients.c: from residual, factors and diagonal to d */

/// A solution of a substep's system: d = displacement + alpha direction.
typedef struct mspringi_solution {
    float alpha;      ///< NaN after an overflow
    double product;   ///< largest r . z that a pass of the substep began with; 0: there is no solution
    bool has_contact; ///< constraints of contact were active in a pass
} mspringi_solution;

/// Solve for d, beginning with the solution of the pass before.
void mspringi_solve(const mspringi_implicit_substep *substep, mspringi_team_member *member,
                    mspringi_solution *solution);

#endif

/// @file solver.h
/// Interface of a solver: a table of properties and operations, and an object of its own.
///
/// A network has the solver that the host chose, and perhaps a fallback for steps which that one cannot take; a
/// step chooses between them (step/ladder.c). To add one: its table in its own folder, and a line in solvers.def.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SOLVER_H
#define MSPRINGI_SOLVER_H

#include <massspring/massspring.h>

#include "base/memory.h"
#include "kernels/kernels.h"
#include "layout/topology.h"
#include "store/plan.h"

struct mspringi_writer;
struct mspringi_io;
struct mspringi_run;
typedef struct mspringi_solver_ops mspringi_solver_ops;

/// Two floats per slot, x and then y, in one block of memory.
typedef struct mspringi_field {
    float *x, *y;
} mspringi_field;

typedef struct mspringi_solver {
    const mspringi_solver_ops *ops; ///< NULL: there is no such solver
    void *object;                   ///< NULL if it keeps nothing
} mspringi_solver;

typedef struct mspringi_attempt mspringi_attempt; ///< store/attempt.h

/// Values that a solver's object derived from masses, rest lengths and springs when it was made. Edits do not
/// change them.
typedef struct mspringi_solver_basis {
    double scale;       ///< power of two that brings masses near 1
    float turn_inertia; ///< m^2, see mspringi_tiles (solvers/implicit/tiles.h)
    uint32_t tile_size; ///< size of its cells (solvers/implicit/cells.h)
} mspringi_solver_basis;

/// Operations that a solver does not need are NULL, unless it says otherwise.
struct mspringi_solver_ops {
    bool has_stability_limit;  ///< its substeps may be too long: the guard looks
    bool can_choose_substeps;  ///< the library may choose their number (MSPRING_SUBSTEPS_AUTO)
    bool takes_one_substep;    ///< as a fallback it takes a step in one substep
    bool skips_sleepers;       ///< leaves alone blocks in which nothing is to be swept
    bool lags;                 ///< velocities lag by half a substep from step to step: see mspringi_steps.lag
    bool is_staggered;         ///< velocities are those of half a substep before the positions, as of leapfrog
    bool has_bundles;          ///< sweeps small trees in bundles
    bool can_add;              ///< springs may be added
    bool has_implicit_grips;   ///< has a linear system, with all grips in it but those of isolated particles
    bool has_implicit_areas;   ///< its substeps have areas in them that springs are all around
    bool has_implicit_contact; ///< its substeps have contact between bodies in them

    // Life. create: begin an object for a complete network, or, perhaps on another thread, for one that has its
    // layout, springs and masses only; tile_size: that of tiles if they are automatic, 0: by the layout; on failure
    // nothing is left to free. build: call the next of the short functions that make it, until it is done; on
    // failure it can only be destroyed. fits: true if adjust() to this definition is enough. relocate: redirect the
    // pointers of a copy into the copy of the network. reserve: make room for the present workers.
    mspring_result (*create)(mspring_network *network, const mspring_settings *def, uint32_t tile_size,
                             void **object);
    mspring_result (*build)(void *object, bool *is_done);
    bool (*fits)(const void *object, const mspring_settings *def);
    void (*adjust)(void *object, const mspring_settings *def);
    void (*destroy)(void *object, mspringi_memory *memory);
    void (*relocate)(void *object, const mspring_network *network, const mspringi_memory *from,
                     const mspringi_memory *to);
    mspring_result (*reserve)(void *object, mspring_network *network);

    // Another layout of the same network. get_def: the definition as given; a solver with create has it, too.
    // take_over: copy the history of the motion. get_basis, set_basis: see mspringi_solver_basis.
    void (*get_def)(const void *object, mspring_settings *def);
    void (*take_over)(const mspring_network *to, void *object, const mspring_network *from, const void *had);
    mspringi_solver_basis (*get_basis)(const void *object);
    void (*set_basis)(void *object, const mspring_network *network, const mspringi_solver_basis *basis);

    // A step. begin: before forces are known. run_step: take all substeps at once, copy the old state into the
    // backup, and find the extrema of the new one; false: it declines, and has changed nothing but what stages keep
    // of its sweeps (is_swept in stages.h). substeps (never NULL): take `count` of them with the same forces from
    // outside (x NULL: none), and with the floor. end: after the last.
    void (*begin)(mspring_network *network);
    bool (*run_step)(mspring_network *network, const mspringi_attempt *attempt, mspringi_field base,
                     mspringi_extrema *extrema);
    void (*substeps)(mspring_network *network, void *object, float h, mspringi_field base, uint32_t count);
    void (*end)(mspring_network *network);

    // Work, in explicit substeps. calm_work: of a calm substep, in which nothing is repeated; NULL: 1. allow_work:
    // limit for each second of the substeps after keep(); beyond it they repeat nothing. count_work: of the
    // substeps since keep(); *is_spent: they would have repeated more; NULL: each was calm.
    double (*calm_work)(const void *object);
    void (*allow_work)(void *object, double rate);
    double (*count_work)(const void *object, bool *is_spent);

    // Undo. keep: save the history before a step. restore: restore it. forget: drop it, as a new motion begins.
    // is_finite: true if all numbers that it keeps for the next step are finite.
    void (*keep)(void *object);
    void (*restore)(mspring_network *network, void *object);
    void (*forget)(void *object);
    bool (*is_finite)(const void *object);

    // Edits. clear_slot: the particle falls freely. rest_slot: it has come to rest. clear_spring: no spring lies in
    // the spring slot any more. new_floor: it is another one, or none. is_isolated (never NULL): true if no spring
    // acts on a particle; without has_isolated, true for loose particles only.
    void (*clear_slot)(const mspring_network *network, void *object, uint32_t slot);
    void (*rest_slot)(const mspring_network *network, void *object, size_t slot);
    void (*clear_spring)(const mspring_network *network, void *object, mspringi_spring_slot spring_slot);
    void (*new_floor)(void *object);
    bool (*is_isolated)(const mspring_network *network, const void *object, size_t slot);
    bool (*has_isolated)(const void *object);

    // describe: fill in its part of a plan. The others: its section (store/sections.h) in snapshots, and in
    // archives.
    void (*describe)(const void *object, mspringi_plan *plan);
    void (*save)(const mspring_network *network, const void *object, struct mspringi_writer *to);
    mspring_result (*check)(mspring_network *network, const void *object, const uint8_t *from, size_t size);
    void (*load)(mspring_network *network, void *object, const uint8_t *from, size_t size);
    uint32_t (*runs)(const mspring_network *network, const void *object, struct mspringi_io head,
                     struct mspringi_run *runs);
    void (*leave)(const mspring_network *network, uint8_t *section, size_t size);
    size_t (*enter)(const mspring_network *network, const void *object, uint8_t *section, size_t size);
};

/// Work of a calm substep, in explicit substeps.
static inline double mspringi_solver_calm_work(const mspringi_solver *solver) {
    return solver->ops->calm_work ? solver->ops->calm_work(solver->object) : 1.0;
}

#define SOLVER(name, table) extern const mspringi_solver_ops table;
#include "store/solvers.def"
#undef SOLVER

/// Table of the solver of this name; NULL if it is none, or this build leaves it out.
const mspringi_solver_ops *mspringi_solver_ops_of(mspring_solver name);

/// @return MSPRING_OK; MSPRING_ERROR_ARGUMENT if there is no such table
mspring_result mspringi_solver_check_name(mspring_solver name, mspringi_message *message);

/// Strain rates clamped (solvers/clamped/clamp.c). It can only be a fallback.
extern const mspringi_solver mspringi_clamped;

/// Make the fallback of the explicit solver, unless it exists, with tiles of that size (0: automatic). It keeps no
/// history.
mspring_result mspringi_fallback_reserve(mspring_network *network, uint32_t tile_size);

/// Make the object of a solver whose table is set, in one go. On failure there is none.
mspring_result mspringi_solver_make(mspringi_solver *solver, mspring_network *network, const mspring_settings *def,
                                    uint32_t tile_size);
void mspringi_solver_destroy(mspringi_solver *solver, mspringi_memory *memory);
void mspringi_solver_forget(const mspringi_solver *solver);
mspringi_solver_basis mspringi_solver_get_basis(const mspringi_solver *solver);

/// Let a solver take over the history of another one with the same settings and another layout.
void mspringi_solver_take_over(const mspring_network *to, const mspringi_solver *made, const mspring_network *from,
                               const mspringi_solver *had);

/// Call these operations of both solvers of a network, the chosen one and the fallback.
void mspringi_solvers_clear_slot(const mspring_network *network, uint32_t slot);
void mspringi_solvers_clear_spring(const mspring_network *network, mspringi_spring_slot spring_slot);
mspring_result mspringi_solvers_reserve(mspring_network *network);
void mspringi_solvers_relocate(mspring_network *network, const mspringi_memory *from, const mspringi_memory *to);

#endif

/// @file stages.h
/// Stages: everything in a step besides the solver. A stage is a table of functions, one for each place in a step
/// where it acts. A step calls the stages that its network uses; an unused one costs a check. A stage that is quiet
/// in a step lets its substeps be taken all at once.
///
///   before_step      once, before the guard: derive values for this substep
///   forces           add forces from outside, the same in all substeps; forces.base is reserved
///   forces_known     once, with the forces of the first substep
///   before_substep   before each substep, or each free group of them; returns the forces that act in them
///   max_parts        before each interval of a substep that is taken alone: the most parts it may have
///   after_substep    after each substep, or each free group of them
///   must_repeat      after the substeps: true if an assumption failed, so that they are undone and repeated
///                    without it. True at most once an attempt
///   verify           after the substeps: an error if the stage failed. Called only if some stage can be quiet or
///                    must_repeat
///   after_step       once the step is accepted, and will not be undone
///   roll_back        after the substeps were undone; the state is that before them. In reverse order
///   undo             undo before_step. In reverse order
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STAGES_H
#define MSPRINGI_STAGES_H

#include "store/attempt.h"

/// Parts of equal length in a substep. An interval is some of them.
#define MSPRINGI_SUBSTEP_PARTS 16u

/// Places where a stage does nothing are NULL.
typedef struct mspringi_stage {
    bool (*is_used)(const mspring_network *network); ///< NULL: always
    bool (*moves)(const mspring_network *network);   ///< something moves, as a collider, even if all islands sleep;
                                                     ///< NULL: nothing does
    bool is_inner;     ///< what before_substep adds are forces within bodies, which wake nothing
    bool writes_state; ///< before or between substeps: the backup is made before its forces are asked for
    bool is_swept;     ///< acts in the solver's sweeps: rolled back, too, if run_step declines after some of them

    void (*before_step)(mspring_network *network, const mspringi_attempt *attempt);
    bool (*is_quiet)(const mspring_network *network, const mspringi_attempt *attempt); ///< NULL: never
    bool (*is_needed)(const mspring_network *network); ///< it cannot be quiet in this step; NULL: it can
    void (*forces)(mspring_network *network, const mspringi_attempt *attempt, mspringi_field field);
    void (*forces_known)(mspring_network *network, mspringi_field force);
    uint32_t (*free_substeps)(const mspring_network *network, const mspringi_attempt *attempt,
                              uint32_t substep); ///< substeps that may be taken together; NULL: one
    mspringi_field (*before_substep)(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                                     mspringi_field base);
    uint32_t (*max_parts)(
        mspring_network *network, const mspringi_attempt *attempt,
        uint32_t left); ///< most parts that may be taken at once, of those left; NULL: all of them
    void (*after_substep)(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep);
    bool (*must_repeat)(mspring_network *network, const mspringi_attempt *attempt);
    mspring_result (*verify)(mspring_network *network);
    void (*after_step)(mspring_network *network, double dt);
    void (*roll_back)(mspring_network *network);
    void (*undo)(mspring_network *network, const mspringi_attempt *attempt);
} mspringi_stage;

#define STAGE(place, table) extern const mspringi_stage table;
#include "store/features.def"

enum {
#define PLACE(name) MSPRINGI_STAGE_OF_##name,
#include "store/places.def"
#undef PLACE
    MSPRINGI_STAGES
};

/// Those that a step uses.
typedef struct mspringi_stages {
    const mspringi_stage *used[MSPRINGI_STAGES];
    size_t count;
    bool give_forces;     ///< some stage gives forces in any case
    bool move;            ///< moves() of some stage is true
    bool cut_substeps;    ///< substeps are never taken all at once
    bool follow_substeps; ///< some stage acts after substeps
    bool can_be_quiet;    ///< some stage has is_quiet or must_repeat
} mspringi_stages;

/// False if the library was built without the stage of this place.
bool mspringi_stage_exists(int place);

mspringi_stages mspringi_stages_of(const mspring_network *network);

/// True if stages cut this step, so that its substeps are not taken all at once.
bool mspringi_stages_must_cut_step(const mspring_network *network, const mspringi_attempt *attempt);

/// The forces that all substeps have in common: what the host holds, with what stages add; x NULL: none.
mspringi_field mspringi_stages_forces(mspring_network *network, const mspringi_attempt *attempt);

/// Call the functions of one place, of all stages in turn.
void mspringi_stages_before_step(mspring_network *network, const mspringi_attempt *attempt);
void mspringi_stages_forces_known(mspring_network *network, const mspringi_attempt *attempt, mspringi_field force);
uint32_t mspringi_stages_free_substeps(const mspring_network *network, const mspringi_attempt *attempt,
                                       uint32_t substep);
mspringi_field mspringi_stages_before_substep(mspring_network *network, const mspringi_attempt *attempt,
                                              uint32_t substep, mspringi_field base,
                                              mspringi_field *outside); ///< outside: without those within bodies
uint32_t mspringi_stages_max_parts(mspring_network *network, const mspringi_attempt *attempt, uint32_t left);
void mspringi_stages_after_substep(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep);
bool mspringi_stages_must_repeat(mspring_network *network, const mspringi_attempt *attempt);
mspring_result mspringi_stages_verify(mspring_network *network, const mspringi_attempt *attempt);
void mspringi_stages_after_step(mspring_network *network, const mspringi_stages *stages, double dt);
void mspringi_stages_roll_back(mspring_network *network, const mspringi_attempt *attempt);
/// Roll back the stages that act in sweeps, because run_step declined or there is none. The solver may have swept
/// some substeps before it met the floor, and has undone them.
void mspringi_stages_roll_back_sweeps(mspring_network *network, const mspringi_attempt *attempt);
void mspringi_stages_undo(mspring_network *network, const mspringi_attempt *attempt);

#endif

/// @file stages.h
/// What happens in a step besides the solver: a table of functions for each stage, one for each place in a step
/// that it acts in. A step goes through the stages that its network uses; what a network does not use costs one
/// look. A stage that is quiet in a step does not keep its substeps from being taken all at once.
///
///   before_step      once, before the guard: values for this substep
///   forces           add forces from outside, the same in all substeps; forces.base has been reserved for that
///   forces_known     once, with those of the first substep
///   before_substep   each substep, or each free group of them; returns the forces that act in them
///   shares           before each piece of a substep that follows no other: how long it may be
///   after_substep    as before_substep
///   must_repeat       after the substeps: it counted on what did not hold, so they are undone and repeated. In the
///                    next run it does not count on that, so it says so once a step
///   judge            after the substeps, or what stands for them: whether it could do what it is for (only
///                    if some stage can be quiet or can miss something)
///   after_step       once the step is taken, and will not be undone
///   roll_back        the substeps were undone, and the state is that of before: in reverse order
///   undo             what before_step did is to be undone: in reverse order
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_STAGES_H
#define MSPRINGI_STAGES_H

#include "store/attempt.h"

/// Parts of equal length that a substep has. A piece of it is some of them.
#define MSPRINGI_SUBSTEP_PARTS 16u

/// Places where a stage does nothing are NULL.
typedef struct mspringi_stage {
    bool (*is_used)(const mspring_network *network); ///< NULL: always
    bool (*moves)(
        const mspring_network *network); ///< something of it moves though all may sleep; NULL: nothing does
    bool is_inner;                       ///< what before_substep adds are forces within bodies, which wake nothing
    bool writes_state; ///< before or between substeps: the backup is made before its forces are asked for

    void (*before_step)(mspring_network *network, const mspringi_attempt *attempt);
    bool (*is_quiet)(const mspring_network *network, const mspringi_attempt *attempt); ///< NULL: never
    bool (*is_needed)(const mspring_network *network); ///< it is not quiet in any step, even if all sleep; NULL: no
    void (*forces)(mspring_network *network, const mspringi_attempt *attempt, mspringi_field field);
    void (*forces_known)(mspring_network *network, mspringi_field force);
    uint32_t (*free_substeps)(const mspring_network *network, const mspringi_attempt *attempt,
                              uint32_t substep); ///< that it lets follow each other; NULL: one
    mspringi_field (*before_substep)(mspring_network *network, const mspringi_attempt *attempt, uint32_t substep,
                                     mspringi_field base);
    uint32_t (*max_parts)(
        mspring_network *network, const mspringi_attempt *attempt,
        uint32_t left); ///< of MSPRINGI_SUBSTEP_PARTS, that may be taken at once; NULL: all that are left
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
    bool give_forces;     ///< some stage does
    bool move;            ///< something of some stage does
    bool cut_substeps;    ///< substeps cannot be taken all at once, in whatever step
    bool follow_substeps; ///< some stage acts after substeps
    bool can_be_quiet;    ///< some stage is asked whether it is quiet, whether it has missed something, and how it
                          ///< went
} mspringi_stages;

mspringi_stages mspringi_stages_of(const mspring_network *network);

/// Whether the substeps of this step cannot be taken all at once.
bool mspringi_stages_split_step(const mspring_network *network, const mspringi_attempt *attempt);

/// The forces that all substeps have in common: what the host holds, with what stages add; x NULL: none.
mspringi_field mspringi_stages_forces(mspring_network *network, const mspringi_attempt *attempt);

/// Each place in turn.
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
void mspringi_stages_undo(mspring_network *network, const mspringi_attempt *attempt);

#endif

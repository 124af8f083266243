/// @file attempt.h
/// An attempt at a step. Stages read its substeps here: a fallback may take others than network->substeps.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_ATTEMPT_H
#define MSPRINGI_ATTEMPT_H

#include "store/network.h"

typedef enum mspringi_attempt_kind {
    MSPRINGI_AS_CHOSEN,          ///< with the host's solver, and the substeps set or chosen
    MSPRINGI_WITH_MORE_SUBSTEPS, ///< MSPRING_GUARD_RETRY
    MSPRINGI_BY_FALLBACK,        ///< with another solver
    MSPRINGI_WITHOUT_SUSPECTS,   ///< with groups held that went wrong
    MSPRINGI_WITH_DOUBTFUL       ///< with one of these groups released
} mspringi_attempt_kind;

struct mspringi_attempt {
    mspringi_attempt_kind kind;
    double dt; ///< s
    float h;   ///< length of a substep, s
    uint32_t substeps;
    const mspringi_solver *solver; ///< the one that runs, which may be the fallback
    const struct mspringi_stages *stages;
    float relative_h;      ///< substep that relative springs were derived for before, s
    uint32_t group;        ///< the group released, or the first that may be released next
    uint32_t missed_count; ///< runs undone so far because an assumption of a stage failed
    double most_work;      ///< beyond which its solver repeats nothing, in explicit substeps
    bool is_cut;           ///< stages act between its substeps

    // Outcome.
    mspring_result result;
    bool is_spent;        ///< its solver would have repeated more
    bool has_missed;      ///< the run was undone, and must be made without an assumption
    bool is_idle;         ///< all sleeps: there was nothing to do
    bool keeps_substeps;  ///< network->substeps stays raised for the next step, though this one failed
    mspringi_guard guard; ///< before it

    // Of all attempts at the step.
    double given_dt;        ///< as the host gave it, s
    double work, calm_work; ///< spent so far; of a calm step. In explicit substeps
    double work_before;     ///< spent before this attempt
};

#endif

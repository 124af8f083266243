/// @file attempt.h
/// An attempt at a step, which travels through the step's stages. What the network says of substeps is a setting.
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
    uint32_t group;        ///< the one released, or the first that may be next
    uint32_t missed_count; ///< runs undone so far because a stage counted on what did not hold
    double most_work;      ///< beyond which its solver repeats nothing
    bool is_cut;           ///< stages act between its substeps

    // Outcome.
    mspring_result result;
    bool is_spent;        ///< its solver would have repeated more
    bool has_missed;      ///< run undone, for one without that assumption
    bool is_idle;         ///< all sleeps: there was nothing to do
    bool keeps_substeps;  ///< the next step takes the network's substeps, though this one failed
    mspringi_guard guard; ///< before it

    // Of all attempts at the step.
    double given_dt;        ///< as the host gave it, s
    double work, calm_work; ///< spent so far; of a step with nothing repeated
    double work_before;     ///< spent before this attempt
};

#endif

/// One step: attempts, until one stands or none is left.
#include <float.h>
#include <math.h>

#include "base/cpu.h"
#include "stability/guard.h"
#include "step/finite.h"
#include "step/ladder.h"
#include "step/pace.h"
#include "store/group_ops.h"
#include "store/sleepers.h"
#include "store/springs.h"

// Accept a step, and let the stages follow it.
static void accept(mspring_network *network, const mspringi_attempt *attempt) {
    mspringi_attempt_accept(network, attempt);
    network->is_open = network->was_opened;
    if (attempt->is_idle) {
        network->outcome.flags |= MSPRING_STEP_ASLEEP;
        network->step_time = attempt->given_dt;
        return;
    }
    network->steps.pace = network->next_pace;
    mspringi_stages_after_step(network, attempt->stages, network->step_time);
    mspringi_forces_forget(network);
}

// Undo what attempts have changed besides the state.
static void give_up(mspring_network *network, const mspringi_attempt *last, uint32_t substeps,
                    const mspringi_any_shape *any_shape) {
    network->substeps = last->keeps_substeps ? network->substeps : substeps;
    network->any_shape = *any_shape;
    if (network->sleep.has_kept)
        mspringi_sleepers->undo(network);
}

static MSPRINGI_NOINLINE mspring_result step(mspring_network *network, double dt) {
    const double longest = (double)FLT_MAX * MSPRING_MAX_SUBSTEPS;
    if (!(dt > 0.0 && dt <= longest))
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "dt is %g s, it must be > 0 and at most %g s: a substep is a float, and at most %u "
                             "make a step",
                             dt, longest, (unsigned)MSPRING_MAX_SUBSTEPS);
    const uint32_t substeps = network->substeps;
    const mspringi_any_shape any_shape = network->any_shape;
    const mspringi_stages stages = mspringi_stages_of(network);
    network->sleep.has_kept = network->was_opened = false;
    mspringi_attempt attempt;
    mspringi_attempt_first(network, dt, &stages, &attempt);
    do
        mspringi_attempt_make(network, &attempt);
    while (mspringi_attempt_next(network, &attempt));
    if (network->groups.count > 0)
        mspringi_held_groups->end(network, attempt.result == MSPRING_OK);
    if (attempt.result == MSPRING_OK)
        accept(network, &attempt);
    else
        give_up(network, &attempt, substeps, &any_shape);
    network->forces.known = (mspringi_field){NULL, NULL};
    network->outcome.work = attempt.work / attempt.calm_work;
    return attempt.result;
}

// Record the outcome of a step. (Not inlined, so that it rounds as mspringi_fp_enter() sets.)
static MSPRINGI_NOINLINE void note(mspring_network *network, double dt, mspring_result result) {
    mspringi_steps *steps = &network->steps;
    const uint32_t flags = network->outcome.flags;
    steps->result = result;
    steps->outcome = network->outcome;
    if (result != MSPRING_OK) {
        steps->outcome.flags = 0;
        mspringi_shared_clear(network->shared); // a message of a hook would hide why the step failed
        return;
    }
    steps->substeps = (flags & MSPRING_STEP_FALLBACK ? 1 : network->substeps) + network->added_substeps;
    steps->substeps = steps->substeps < MSPRING_MAX_SUBSTEPS ? steps->substeps : MSPRING_MAX_SUBSTEPS;
    mspringi_pace_note(network, dt);
    steps->count++;
    steps->fallback_count += (flags & (MSPRING_STEP_FALLBACK | MSPRING_STEP_CLAMPED)) != 0;
    steps->time += network->step_time;
    mspringi_message_clear(&network->message); // of a failed attempt
}

// A call that took no substep is no step: it has succeeded, and nothing was to blame.
static void note_deferred(mspring_network *network) {
    network->steps.result = MSPRING_OK;
    network->steps.outcome = network->outcome;
}

mspring_result mspring_network_step(mspring_network *network, double dt) {
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    network->outcome = mspringi_outcome_none();
    network->added_substeps = 0;
    const size_t used = network->memory.used;
    bool is_deferred = false;
    const mspringi_fp_state before = mspringi_fp_enter();
    result = mspringi_tasks_restart_after_fork(network->tasks, &network->message);
    if (result == MSPRING_OK)
        result = mspringi_pace_defer(network, dt, &is_deferred);
    if (result == MSPRING_OK && !is_deferred)
        result = step(network, dt);
    if (is_deferred)
        note_deferred(network);
    else
        note(network, dt, result);
    mspringi_fp_leave(before);
    MSPRINGI_ASSERT(network->memory.used == used || network->outcome.flags & MSPRING_STEP_GREW);
    (void)used;
    MSPRINGI_ASSERT(result != MSPRING_OK || mspringi_is_finite(network));
    return result;
}

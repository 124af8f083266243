/// A step back.
#include "gradient/gradient.h"

#include "base/cpu.h"
#include "base/decay.h"

static mspringi_times times_of(const mspring_gradient *g, const mspringi_past *past, uint32_t substep) {
    const float rate = g->clone->settings.global_damping;
    const float kick = substep == 0 ? 0.5f * (past->lag + past->h) : past->h;
    const float gravity_kick = substep == 0 ? 0.5f * (past->full_lag + past->h) : past->h;
    const mspringi_times times = {(double)past->h, (double)mspringi_gain(rate, kick),
                                  (double)mspringi_gain(rate, gravity_kick), (double)mspringi_loss(rate, kick)};
    return times;
}

/* ------------------------------------------------------------------------------------------------------- actuators
 */

// Part of the change to their new lengths that actuators have made in a substep, as in
// features/actuators/actuators.c.
static double actuator_part(const mspring_gradient *g, const mspringi_past *past, uint32_t substep) {
    const uint32_t count = past->substeps, all = g->changes < count ? g->changes : count;
    const uint32_t by = g->changes <= 1       ? 1
                        : g->changes >= count ? substep + 1
                                              : (uint32_t)((uint64_t)substep * g->changes / count) + 1;
    return (double)by / (double)all;
}

static void set_actuators(mspring_gradient *g, uint32_t step, double part) {
    const float *from = g->lengths + (size_t)step * g->actuator_count, *to = from + g->actuator_count;
    for (uint32_t i = 0; i < g->actuator_count; ++i) {
        const uint32_t place = g->actuator_place[i];
        if (place != MSPRING_NONE)
            g->octets.length[place] = (double)from[i] + ((double)to[i] - (double)from[i]) * part;
    }
}

// Share the derivatives by the lengths in a substep out to the lengths at the start and at the end of the step.
static void take_actuators(mspring_gradient *g, uint32_t step, double part) {
    double *by_signals = g->by_signals + (size_t)step * g->actuator_count;
    for (uint32_t i = 0; i < g->actuator_count; ++i) {
        const uint32_t place = g->actuator_place[i];
        if (place == MSPRING_NONE)
            continue;
        const double by_length = g->octets.by_length[place];
        g->octets.by_length[place] = 0.0;
        by_signals[i] += part * by_length; // by the length at the end, until end_actuators()
        g->actuator_start[i] += (1.0 - part) * by_length;
    }
}

// After a step, pass the derivatives by its final lengths to its signals or, without signals, to the lengths before
// it.
static void end_actuators(mspring_gradient *g, uint32_t step) {
    double *by_signals = g->by_signals + (size_t)step * g->actuator_count;
    for (uint32_t i = 0; i < g->actuator_count; ++i) {
        const double by_end = by_signals[i] + g->by_length[i];
        const bool follows = g->past[step].has_signals;
        by_signals[i] = follows ? by_end * (double)g->nominal[i] : 0.0;
        g->by_length[i] = g->actuator_start[i] + (follows ? 0.0 : by_end);
        g->actuator_start[i] = 0.0;
    }
}

/* -------------------------------------------------------------------------------------------------------- substeps
 */

static mspring_result reverse_substep(mspring_gradient *g, uint32_t step, uint32_t substep,
                                      const mspringi_times *times) {
    const mspringi_past *past = &g->past[step];
    const mspringi_moment before = mspringi_tape_moment(g, past->first_moment + substep);
    const double part = actuator_part(g, past, substep);
    set_actuators(g, step, part);
    if (g->plane_count > 0) {
        const mspringi_moment after = mspringi_tape_moment(g, past->first_moment + substep + 1);
        const float *forces = past->has_forces ? g->forces + (size_t)step * g->forced_count * 2 : NULL;
        const uint32_t slot = mspringi_gradient_floor(g, &before, &after, times, forces);
        if (slot != MSPRING_NONE)
            return mspringi_fail(&g->message, MSPRING_ERROR_ARGUMENT,
                                 "step %u: particle %u was in a corner of the floor, which has no gradient",
                                 (unsigned)step, (unsigned)g->network->topology.particle_of_slot[slot]);
    }
    mspringi_gradient_go_back(g, &before, times);
    double *by_forces = g->by_forces + (size_t)step * g->forced_count * 2;
    for (uint32_t i = 0; i < g->forced_count; ++i) {
        by_forces[2 * i] += g->adjoint.force.x[g->forced_slot[i]];
        by_forces[2 * i + 1] += g->adjoint.force.y[g->forced_slot[i]];
    }
    take_actuators(g, step, part);
    return MSPRING_OK;
}

static bool has_finite_adjoint(const mspring_gradient *g) {
    const mspringi_adjoint *a = &g->adjoint;
    double sum = 0.0; // of zeros: NaN if any number is not finite
    for (uint32_t i = 0; i < g->slots; ++i)
        sum += 0.0 * a->position.x[i] + 0.0 * a->position.y[i] + 0.0 * a->velocity.x[i] + 0.0 * a->velocity.y[i];
    return isfinite(sum);
}

static mspring_result reverse_step(mspring_gradient *g) {
    const uint32_t step = g->left - 1;
    mspring_result result = mspringi_tape_play(g, step);
    if (result != MSPRING_OK)
        return result;
    const mspringi_past *past = &g->past[step];
    const mspringi_times first = times_of(g, past, 0), later = times_of(g, past, 1);
    for (uint32_t substep = past->substeps; substep > 0 && result == MSPRING_OK; --substep)
        result = reverse_substep(g, step, substep - 1, substep == 1 ? &first : &later);
    if (result != MSPRING_OK)
        return result;
    end_actuators(g, step);
    if (!has_finite_adjoint(g))
        return mspringi_fail(&g->message, MSPRING_ERROR_UNSTABLE,
                             "derivatives by the state before step %u overflow", (unsigned)step);
    --g->left;
    return MSPRING_OK;
}

mspring_result mspring_gradient_reverse(mspring_gradient *gradient, uint32_t step_count) {
    if (!gradient)
        return MSPRING_ERROR_ARGUMENT;
    mspring_gradient *g = gradient;
    mspringi_message_clear(&g->message);
    if (g->has_failed)
        return mspringi_fail(&g->message, MSPRING_ERROR_ARGUMENT, "the gradient has failed: destroy it");
    if (step_count > g->left)
        return mspringi_fail(&g->message, MSPRING_ERROR_ARGUMENT, "step_count is %u, but %u steps are left",
                             (unsigned)step_count, (unsigned)g->left);
    const mspringi_fp_state before = mspringi_fp_enter();
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; i < step_count && result == MSPRING_OK; ++i)
        result = reverse_step(g);
    mspringi_fp_leave(before);
    g->has_failed = result != MSPRING_OK;
    return result;
}

/// Recorded steps: frames of some, and the states of all substeps between two frames, which are computed again.
#include "base/cpu.h"
#include "gradient/gradient.h"
#include "stability/stability.h"

/* ---------------------------------------------------------------------------------------------------- forwards */

// Count of doubles in a moment.
static size_t moment_size(const mspring_gradient *g) {
    return (size_t)g->lanes * (g->needs_velocities ? 4 : 2);
}

static mspring_result save_frame(mspring_gradient *g) {
    size_t size;
    mspringi_frame frame = {0};
    mspring_result result = mspring_network_get_snapshot_size(g->network, MSPRING_SNAPSHOT_FRAME, &size);
    if (result == MSPRING_OK)
        result = mspring_network_get_state_hash(g->network, &frame.hash);
    if (result != MSPRING_OK)
        return result;
    frame.bytes = mspringi_alloc_unset(&g->memory, size, 1);
    void *list = g->frames;
    if (!frame.bytes || !mspringi_grow(&g->memory, &list, &g->frame_capacity, g->frame_count + 1, sizeof frame))
        return mspringi_fail(&g->network->message, MSPRING_ERROR_MEMORY, "no memory for a frame of %u bytes",
                             (unsigned)size);
    g->frames = list;
    result = mspring_network_save(g->network, MSPRING_SNAPSHOT_FRAME, frame.bytes, size, &frame.size);
    if (result == MSPRING_OK)
        g->frames[g->frame_count++] = frame;
    else
        mspringi_free(&g->memory, frame.bytes);
    return result;
}

// Steps between frames, p, with which frames and one segment on the tape take the least memory. With s steps, f
// bytes for a frame and t bytes for a step on the tape, they take s / p f + p t.
static uint32_t frame_period(const mspring_gradient *g, uint32_t substeps) {
    const double step = (double)substeps * (double)(moment_size(g) * sizeof *g->tape);
    const double period = sqrt((double)g->capacity * (double)g->frames[0].size / step);
    return period < 1.0 ? 1u : period > (double)g->capacity ? g->capacity : (uint32_t)period;
}

// Lag at the start of an explicit step, as in step/attempt.c.
static float lag_of(mspring_network *network, float lag, float h) {
    mspring_id spring;
    return lag > h
               ? fminf(lag, fmaxf((float)fmin(mspringi_stable_in_any_shape(network, &spring), (double)FLT_MAX), h))
               : lag;
}

static mspring_result set_inputs(mspring_gradient *g, mspring_network *network, uint32_t step) {
    const float *signals = g->signals + (size_t)step * g->actuator_count;
    const float *forces = g->forces + (size_t)step * g->forced_count * 2;
    mspring_result result = MSPRING_OK;
    if (g->past[step].has_signals)
        result = mspring_network_set(network, MSPRING_SIGNAL, NULL, 0, g->actuator_count, signals, 1);
    if (result == MSPRING_OK && g->past[step].has_forces)
        result = mspring_network_apply_forces(network, MSPRING_PUSH_STEP, g->forced, 0, g->forced_count, forces,
                                              forces + 1, 2);
    return result;
}

// Save the inputs of a step, and the rest lengths of actuators at its end.
static void record_inputs(mspring_gradient *g, const float *signals, const float *forces) {
    const uint32_t step = g->count, actuators = g->actuator_count, forced = g->forced_count * 2;
    mspringi_past *past = &g->past[step];
    past->has_signals = signals && actuators > 0;
    past->has_forces = forces && forced > 0;
    for (uint32_t i = 0; i < actuators; ++i) {
        const size_t at = (size_t)step * actuators + i;
        g->signals[at] = past->has_signals ? signals[i] : 0.0f;
        g->lengths[at + actuators] = past->has_signals ? signals[i] * g->nominal[i] : g->lengths[at];
    }
    for (uint32_t i = 0; i < forced && past->has_forces; ++i)
        g->forces[(size_t)step * forced + i] = forces[i];
}

// Step the network with a guard that neither clamps nor retries.
static mspring_result step_guarded(mspring_network *network, double dt) {
    mspring_settings settings = {.struct_size = sizeof settings};
    mspring_result result = mspring_network_get_settings(network, &settings);
    const mspring_guard guard = settings.guard;
    if (result != MSPRING_OK || guard == MSPRING_GUARD_GROWTH || guard == MSPRING_GUARD_BOUNDS)
        return result == MSPRING_OK ? mspring_network_step(network, dt) : result;
    settings.guard = MSPRING_GUARD_GROWTH;
    result = mspring_network_set_settings(network, &settings);
    if (result != MSPRING_OK)
        return result;
    const mspring_result outcome = mspring_network_step(network, dt);
    const mspringi_message message = network->message;
    settings.guard = guard;
    result = mspring_network_set_settings(network, &settings);
    network->message = message;
    return outcome == MSPRING_OK ? result : outcome;
}

// Take the forces of a step that failed off the network, which keeps its message.
static void take_back_forces(mspring_gradient *g) {
    mspring_network *network = g->network;
    const mspringi_message message = network->message;
    float *forces = g->forces + (size_t)g->count * g->forced_count * 2;
    for (uint32_t i = 0; i < 2 * g->forced_count; ++i)
        forces[i] = -forces[i];
    (void)!mspring_network_apply_forces(network, MSPRING_PUSH_STEP, g->forced, 0, g->forced_count, forces,
                                        forces + 1, 2);
    network->message = message;
}

static mspring_result take_step(mspring_gradient *g, double dt) {
    mspring_network *network = g->network;
    mspringi_past *past = &g->past[g->count];
    const float lag = network->steps.lag;
    mspring_result result = MSPRING_OK;
    if (g->period == 0 || g->count % g->period == 0)
        result = g->count / (g->period ? g->period : 1) < g->frame_count ? MSPRING_OK : save_frame(g);
    if (result == MSPRING_OK)
        result = set_inputs(g, network, g->count);
    if (result != MSPRING_OK)
        return result;
    result = step_guarded(network, dt);
    if (result != MSPRING_OK && past->has_forces)
        take_back_forces(g);
    if (result != MSPRING_OK)
        return result;
    past->dt = dt;
    past->h = network->steps.lag;
    past->full_lag = lag;
    past->lag = lag_of(network, lag, past->h);
    past->substeps = network->steps.substeps;
    if (g->period == 0)
        g->period = frame_period(g, past->substeps);
    return MSPRING_OK;
}

mspring_result mspring_gradient_step(mspring_gradient *gradient, double dt, const float *signals,
                                     const float *forces) {
    if (!gradient)
        return MSPRING_ERROR_ARGUMENT;
    mspring_gradient *g = gradient;
    mspringi_message_clear(&g->message);
    if (g->is_reversing)
        return mspringi_fail(&g->message, MSPRING_ERROR_ARGUMENT,
                             "the gradient has gone back already: make another one for more steps");
    if (g->count == g->capacity)
        return mspringi_fail(&g->message, MSPRING_ERROR_LIMIT, "the gradient has its %u steps",
                             (unsigned)g->capacity);
    if (g->network->edits.layouts + g->network->edits.growth != g->layout)
        return mspringi_fail(&g->message, MSPRING_ERROR_ARGUMENT,
                             "particles or springs were added or removed, or the layout has changed");
    record_inputs(g, signals, forces);
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = take_step(g, dt);
    mspringi_fp_leave(before);
    if (result == MSPRING_OK)
        g->left = ++g->count;
    else
        g->message = g->network->message;
    return result;
}

/* --------------------------------------------------------------------------------------------------- backwards */

mspringi_moment mspringi_tape_moment(const mspring_gradient *g, uint32_t index) {
    const double *values = g->tape + index * moment_size(g), *vx = values + 2 * (size_t)g->lanes;
    const mspringi_moment moment = {values,
                                    values + g->lanes,
                                    g->needs_velocities ? vx : NULL,
                                    g->needs_velocities ? vx + g->lanes : NULL,
                                    g->origins[2 * (size_t)index],
                                    g->origins[2 * (size_t)index + 1]};
    return moment;
}

static void write_velocity(double *to, const float *v, uint32_t slots) {
    for (uint32_t i = 0; i < slots; ++i)
        to[i] = (double)v[i];
}

static void write_position(double *to, const float *high, const float *low, uint32_t slots) {
    for (uint32_t i = 0; i < slots; ++i)
        to[i] = (double)high[i] + (double)low[i];
}

// Write the clone's state onto the tape. A state behind the end of the tape is dropped; play() then reports an
// error.
static void write_moment(mspring_gradient *g, uint32_t at) {
    const mspring_network *n = g->clone;
    const mspringi_state *state = &n->state;
    if (at >= g->moment_capacity)
        return;
    double *to = g->tape + at * moment_size(g);
    write_position(to, state->x, state->low_x, g->slots);
    write_position(to + g->lanes, state->y, state->low_y, g->slots);
    if (g->needs_velocities) {
        write_velocity(to + 2 * (size_t)g->lanes, state->vx, g->slots);
        write_velocity(to + 3 * (size_t)g->lanes, state->vy, g->slots);
    }
    g->origins[2 * (size_t)at] = n->origin_x;
    g->origins[2 * (size_t)at + 1] = n->origin_y;
}

// Hook after each substep. A repeated step overwrites its states.
static void MSPRING_CALL hear_substep(const mspring_hook_args *args, void *user) {
    mspring_gradient *g = user;
    write_moment(g, g->moments + args->substep);
}

static bool reserve_tape(mspring_gradient *g, uint32_t moments) {
    if (moments <= g->moment_capacity)
        return true;
    mspringi_free(&g->memory, g->tape);
    mspringi_free(&g->memory, g->origins);
    g->tape = mspringi_alloc(&g->memory, moments, moment_size(g) * sizeof *g->tape);
    g->origins = mspringi_alloc(&g->memory, moments, 2 * sizeof *g->origins);
    g->moment_capacity = g->tape && g->origins ? moments : 0;
    return g->moment_capacity > 0;
}

static mspring_result play_steps(mspring_gradient *g, uint32_t first, uint32_t end) {
    mspring_network *clone = g->clone;
    mspring_result result = MSPRING_OK;
    write_moment(g, 0);
    g->moments = 1;
    for (uint32_t step = first; step < end && result == MSPRING_OK; ++step) {
        mspringi_past *past = &g->past[step];
        past->first_moment = g->moments - 1;
        result = set_inputs(g, clone, step);
        if (result == MSPRING_OK)
            result = step_guarded(clone, past->dt);
        g->moments += clone->steps.substeps;
    }
    return result;
}

static mspring_result play(mspring_gradient *g, uint32_t segment) {
    const uint32_t first = segment * g->period;
    const uint32_t end = g->count - first < g->period ? g->count : first + g->period;
    const mspringi_frame *frame = &g->frames[segment];
    uint32_t moments = 1;
    uint64_t hash = 0;
    for (uint32_t step = first; step < end; ++step)
        moments += g->past[step].substeps;
    if (!reserve_tape(g, moments))
        return mspringi_fail(&g->message, MSPRING_ERROR_MEMORY, "no memory for %u substeps", (unsigned)moments);
    mspring_result result = mspring_network_load(g->clone, frame->bytes, frame->size);
    if (result == MSPRING_OK)
        result = play_steps(g, first, end);
    if (result == MSPRING_OK)
        result = mspring_network_get_state_hash(g->clone, &hash);
    if (result != MSPRING_OK)
        return mspringi_fail(&g->message, result, "steps %u to %u can't be computed again: %s", (unsigned)first,
                             (unsigned)end - 1, mspring_network_error(g->clone));
    if (g->moments != moments || hash != (end == g->count ? g->end_hash : g->frames[segment + 1].hash))
        return mspringi_fail(
            &g->message, MSPRING_ERROR_ARGUMENT,
            "steps %u to %u were not those of mspring_gradient_step() alone: the network was edited "
            "or stepped between them",
            (unsigned)first, (unsigned)end - 1);
    g->segment = segment;
    return MSPRING_OK;
}

mspring_result mspringi_tape_play(mspring_gradient *g, uint32_t step) {
    const uint32_t segment = step / g->period;
    if (!g->is_reversing) {
        mspring_hook_def hook;
        mspring_result result = mspring_init(MSPRING_STRUCT_HOOK_DEF, &hook, sizeof hook);
        hook.phase = MSPRING_PHASE_AFTER_SUBSTEP;
        hook.fn = hear_substep;
        hook.user = g;
        if (result == MSPRING_OK)
            result = mspring_network_get_state_hash(g->network, &g->end_hash);
        if (result == MSPRING_OK)
            result = mspring_network_add_hook(g->clone, &hook, NULL);
        if (result != MSPRING_OK)
            return mspringi_fail(&g->message, result, "the gradient can't go back");
        g->is_reversing = true;
    }
    if (segment == g->segment)
        return MSPRING_OK;
    g->segment = MSPRING_NONE;
    return play(g, segment);
}

/// mspring_network_tune(): what is asked for, in which order it is measured, and what comes out.
#include <math.h>

#include "base/clock.h"
#include "edits/strain.h"
#include "network/origin.h"
#include "sleep/sleep.h"
#include "tuning.h"

#define MOST_SETTINGS 1000
#define MOST_STEPS 100000

/* ------------------------------------------------------------------------------------------------------- checks */

static mspring_result check_numbers(const mspring_tune_def *def, mspringi_message *message) {
    if (!(def->dt > 0.0 && def->dt < INFINITY))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "dt is %g s, it must be finite and > 0", def->dt);
    if (!(def->duration >= 0.0 && def->duration <= def->dt * MOST_STEPS))
        return mspringi_fail(
            message, MSPRING_ERROR_ARGUMENT,
            "duration is %g s, it must be at most %d steps of %g s, or 0: as long as the motion asks",
            def->duration, MOST_STEPS, def->dt);
    if (!(def->budget > 0.0))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "budget is %g s, it must be > 0", def->budget);
    if (!(def->max_error > 0.0 && def->max_cost > 0.0))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "max_error is %g, max_cost %g s, both must be > 0",
                             def->max_error, def->max_cost);
    if (!(def->max_drift >= 0.0))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "max_drift is %g, it must be >= 0", def->max_drift);
    if (def->measure < MSPRING_TUNE_BY_TRAJECTORY || def->measure > MSPRING_TUNE_BY_BENDING)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "measure is %d, which is none", (int)def->measure);
    if (def->flags & ~(uint32_t)MSPRING_TUNE_NOTHING_ELSE)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "flags of mspring_tune_def are 0x%x",
                             (unsigned)def->flags);
    return MSPRING_OK;
}

static mspring_result check_def(const mspring_tune_def *def, mspringi_message *message) {
    mspring_result result =
        mspringi_check_struct(message, "mspring_tune_def", def->struct_size, sizeof *def, sizeof *def);
    if (result == MSPRING_OK)
        result = check_numbers(def, message);
    if (result != MSPRING_OK)
        return result;
    if (def->setting_count > MOST_SETTINGS || (def->settings && def->setting_count == 0))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "setting_count is %u, it must be 1 to %d",
                             (unsigned)def->setting_count, MOST_SETTINGS);
    if (!def->settings && def->setting_count > 0)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "settings is NULL, but setting_count %u",
                             (unsigned)def->setting_count);
    if (!def->clock && !mspringi_clock())
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "this build has no clock: give one");
    return MSPRING_OK;
}

static mspring_result check_settings(const mspring_solver_def *settings, uint32_t count,
                                     mspringi_message *message) {
    for (uint32_t i = 0; i < count; ++i) {
        mspringi_message what = {.text = ""};
        const mspring_result result = mspringi_check_solver(&settings[i], &what);
        if (result != MSPRING_OK)
            return mspringi_fail(message, result, "setting %u: %s", (unsigned)i, what.text);
    }
    return MSPRING_OK;
}

static mspring_result check_rows(const mspring_tune_row *rows, uint32_t capacity, uint32_t needed,
                                 mspringi_message *message) {
    if (capacity < needed)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "there is room for %u rows, but %u settings",
                             (unsigned)capacity, (unsigned)needed);
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; result == MSPRING_OK && i < needed; ++i)
        result =
            mspringi_check_struct(message, "mspring_tune_row", rows[i].struct_size, sizeof *rows, sizeof *rows);
    return result;
}

/* -------------------------------------------------------------------------------------------------------- time */

bool mspringi_tuning_goes_on(mspringi_tuning *tuning, double part) {
    const mspring_tune_def *def = &tuning->def;
    if (tuning->is_over)
        return false;
    const double done = fmin((tuning->done + part) / tuning->units, 1.0);
    tuning->is_over =
        def->clock(def->user) - tuning->begun > def->budget || (def->progress && !def->progress(done, def->user));
    return !tuning->is_over;
}

/* -------------------------------------------------------------------------------------------------- setting up */

// A clone that only springs, gravity and the forces given move: ramps stand still, springs do not break, and there
// is no floor.
static mspring_result make_base(mspringi_tuning *tuning) {
    mspring_result result = mspringi_tune_spawn(tuning, tuning->network, &tuning->base);
    if (result != MSPRING_OK)
        return result;
    mspring_network *base = tuning->base;
    result = mspring_network_set_floor(base, NULL);
    if (result != MSPRING_OK)
        return result;
    mspringi_wake(base);
    base->sleep.speed = 0.0f;
    // A setting is to be measured, not what would stand in for it.
    if (base->guard_policy == MSPRING_GUARD_IMPLICIT || base->guard_policy == MSPRING_GUARD_CLAMP)
        base->guard_policy = MSPRING_GUARD_GROWTH;
    else if (base->guard_policy == MSPRING_GUARD_CLAMP_BOUNDS)
        base->guard_policy = MSPRING_GUARD_BOUNDS;
    base->ramps.count = 0;
    for (mspring_id spring = 0; base->strain.break_strain && spring < base->topology.spring_count; ++spring)
        mspringi_strain_store(base, mspringi_place_of(&base->topology, spring), false, INFINITY);
    mspringi_box box = mspringi_box_empty();
    for (mspring_id p = 0; p < base->topology.particle_count; ++p) {
        const uint32_t slot = base->topology.slot_of_particle[p];
        if (!mspringi_particle_exists(base, p))
            continue;
        mspringi_box_include(&box, (double)base->state.x[slot], (double)base->state.y[slot]);
    }
    tuning->size = fmax(box.max_x - box.min_x, box.max_y - box.min_y);
    return MSPRING_OK;
}

// Steps of a trajectory; the most there can be where that is not known yet.
static uint32_t steps_of(const mspring_tune_def *def) {
    if (def->duration == 0.0)
        return MSPRINGI_TUNE_MOST_STEPS;
    const double steps = def->duration / def->dt, whole = floor(steps),
                 rounded = whole < steps ? whole + 1.0 : whole;
    return rounded > MSPRINGI_TUNE_MOMENTS ? (uint32_t)rounded : MSPRINGI_TUNE_MOMENTS;
}

static mspring_result allocate(mspringi_tuning *tuning) {
    mspringi_memory *memory = &tuning->network->memory;
    const size_t particles = tuning->network->topology.particle_count;
    tuning->time_capacity = MSPRINGI_TUNE_FIRST_STEPS + 2 * tuning->step_count;
    tuning->trials = mspringi_alloc(memory, tuning->trial_count, sizeof *tuning->trials);
    tuning->times =
        mspringi_alloc(memory, (size_t)2 * tuning->trial_count * tuning->time_capacity, sizeof *tuning->times);
    tuning->places = mspringi_alloc(memory, 2 * MSPRINGI_TUNE_MOMENTS * particles, sizeof *tuning->places);
    if (!tuning->trials || !tuning->times || !tuning->places)
        return mspringi_fail(&tuning->network->message, MSPRING_ERROR_MEMORY, "no memory to try %u settings",
                             (unsigned)tuning->trial_count);
    return MSPRING_OK;
}

static void fill_trials(mspringi_tuning *tuning, const mspring_solver_def *settings) {
    for (uint32_t i = 0; i < tuning->trial_count; ++i) {
        mspringi_trial *trial = &tuning->trials[i];
        trial->setting = settings[i];
        trial->times = tuning->times + (size_t)2 * i * tuning->time_capacity;
        trial->rest_times = trial->times + tuning->time_capacity;
        trial->row = (mspring_tune_row){
            .struct_size = sizeof trial->row,
            .setting = i,
            .solver = settings[i].solver,
            .integrator = settings[i].integrator,
            .substeps = settings[i].substeps,
            .iterations = settings[i].iterations,
            .tile_size = settings[i].tile_size,
            .coarse_period = settings[i].coarse_period,
        };
    }
}

/* --------------------------------------------------------------------------------------------------- measuring */

static mspring_result measure(mspringi_tuning *tuning) {
    const bool by_trajectory = tuning->def.measure == MSPRING_TUNE_BY_TRAJECTORY;
    const bool all = !(tuning->def.flags & MSPRING_TUNE_NOTHING_ELSE);
    mspring_result result = mspringi_tune_costs(tuning);
    if (result == MSPRING_OK && tuning->def.duration == 0.0)
        result = mspringi_tune_choose_duration(tuning);
    if (result == MSPRING_OK && !by_trajectory)
        result = mspringi_tune_rests(tuning);
    if (result == MSPRING_OK && (by_trajectory || all))
        result = mspringi_tune_trajectories(tuning);
    if (result == MSPRING_OK && by_trajectory && all)
        result = mspringi_tune_rests(tuning);
    return result == MSPRING_OK ? mspringi_tune_costs_again(tuning) : result;
}

static mspring_result tune(mspringi_tuning *tuning, const mspring_solver_def *settings) {
    mspring_result result = allocate(tuning);
    if (result == MSPRING_OK)
        result = make_base(tuning);
    if (result != MSPRING_OK)
        return result;
    fill_trials(tuning, settings);
    result = measure(tuning);
    if (result == MSPRING_OK)
        mspringi_tune_judge(tuning);
    return result;
}

static mspring_result run(mspring_network *network, const mspring_tune_def *def, const mspring_solver_def *settings,
                          uint32_t setting_count, mspring_tune_row *rows, uint32_t *count) {
    mspringi_tuning tuning = {
        .network = network,
        .def = *def,
        .trial_count = setting_count,
        .step_count = steps_of(def),
        .units = (def->flags & MSPRING_TUNE_NOTHING_ELSE ? 3.0 : 4.0) * (double)setting_count,
    };
    if (!tuning.def.clock)
        tuning.def.clock = mspringi_clock();
    tuning.begun = tuning.def.clock(def->user);
    const mspring_result result = tune(&tuning, settings);
    if (result == MSPRING_OK) {
        for (uint32_t i = 0; i < setting_count; ++i)
            rows[i] = tuning.trials[i].row;
        *count = setting_count;
    }
    mspringi_tune_dismiss(tuning.base);
    mspringi_free(&network->memory, tuning.places);
    mspringi_free(&network->memory, tuning.times);
    mspringi_free(&network->memory, tuning.trials);
    return result;
}

mspring_result mspring_network_tune(mspring_network *network, const mspring_tune_def *def, mspring_tune_row *rows,
                                    uint32_t capacity, uint32_t *count) {
    mspring_tune_def defaults;
    mspring_solver_def usual[MSPRINGI_TUNE_USUAL_SETTINGS];
    mspring_result result = mspringi_enter(network);
    if (result != MSPRING_OK)
        return result;
    if (!rows || !count)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "the place for rows, or their count, is NULL");
    if (!def) {
        (void)mspring_tune_def_init(&defaults, sizeof defaults);
        def = &defaults;
    }
    const mspring_solver_def *settings = def->settings;
    uint32_t setting_count = def->setting_count;
    result = check_def(def, &network->message);
    if (result == MSPRING_OK && !settings) {
        settings = usual;
        result = mspring_tune_settings(network, def->dt, usual, MSPRINGI_TUNE_USUAL_SETTINGS, &setting_count);
    }
    if (result == MSPRING_OK)
        result = check_rows(rows, capacity, setting_count, &network->message);
    if (result == MSPRING_OK)
        result = check_settings(settings, setting_count, &network->message);
    return result == MSPRING_OK ? run(network, def, settings, setting_count, rows, count) : result;
}

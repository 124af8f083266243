/// mspring_network_tune(): checks, order of the measurements, and results.
#include <math.h>

#include "analysis/tune/clock.h"
#include "analysis/tune/reference.h"
#include "analysis/tune/tuning.h"
#include "features/ramps/ramps.h"
#include "step/origin.h"
#include "store/changed.h"
#include "store/spring_limits.h"

#define MAX_SETTINGS 1000
#define MAX_STEPS 100000

/* ------------------------------------------------------------------------------------------------------- checks */

static mspring_result check_numbers(const mspring_tune_def *def, mspringi_message *message) {
    if (!(def->dt > 0.0 && def->dt < INFINITY))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "dt is %g s, it must be finite and > 0", def->dt);
    if (!(def->duration >= 0.0 && def->duration <= def->dt * MAX_STEPS))
        return mspringi_fail(
            message, MSPRING_ERROR_ARGUMENT,
            "duration is %g s, it must be at most %d steps of %g s, or 0: as long as the motion asks",
            def->duration, MAX_STEPS, def->dt);
    if (!(def->budget > 0.0))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "budget is %g s, it must be > 0", def->budget);
    if (!(def->max_error > 0.0 && def->max_cost > 0.0))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "max_error is %g, max_cost %g s, both must be > 0",
                             def->max_error, def->max_cost);
    if (!(def->max_drift >= 0.0))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "max_drift is %g, it must be >= 0", def->max_drift);
    if (def->measure < MSPRING_TUNE_BY_TRAJECTORY || def->measure > MSPRING_TUNE_BY_SCENE)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "measure is %d, which is none", (int)def->measure);
    if (def->measure == MSPRING_TUNE_BY_SCENE && !def->scene)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "measure is MSPRING_TUNE_BY_SCENE, but scene NULL");
    if (def->flags & ~(uint32_t)MSPRING_TUNE_NOTHING_ELSE)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "flags of mspring_tune_def are 0x%x",
                             (unsigned)def->flags);
    return MSPRING_OK;
}

static mspring_result check_scene_numbers(const mspring_tune_scene *scene, double dt, mspringi_message *message) {
    const uint32_t known = MSPRING_TUNE_SCENE_FLOOR | MSPRING_TUNE_SCENE_BREAKING | MSPRING_TUNE_SCENE_HOOKS;
    if (scene->flags & ~known)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "flags of mspring_tune_scene are 0x%x",
                             (unsigned)scene->flags);
    if (scene->start_count < MSPRINGI_TUNE_MIN_STARTS || scene->start_count > MSPRINGI_TUNE_MAX_STARTS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the scene's start_count is %u, it must be %d to %d",
                             (unsigned)scene->start_count, MSPRINGI_TUNE_MIN_STARTS, MSPRINGI_TUNE_MAX_STARTS);
    if (!(scene->duration > 0.0 && scene->duration <= dt * MAX_STEPS))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the scene's duration is %g s, it must be > 0 and at most %d steps of %g s",
                             scene->duration, MAX_STEPS, dt);
    if (!(scene->kick > 0.0 && scene->kick < INFINITY && scene->max_distance > 0.0))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the scene's kick is %g m/s, its max_distance %g, both must be > 0, kick finite",
                             scene->kick, scene->max_distance);
    if (!(scene->tolerance >= 0.0 && scene->tolerance < INFINITY))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the scene's tolerance is %g, it must be finite and >= 0", scene->tolerance);
    return MSPRING_OK;
}

static mspring_result check_scene(const mspring_tune_scene **given, mspring_tune_scene *scene, double dt,
                                  mspring_network *network) {
    mspringi_message *message = &network->message;
    mspring_result result = mspringi_take_tune_scene(message, given, scene);
    if (result == MSPRING_OK)
        result = mspringi_check_reserved(message, "mspring_tune_scene",
                                         scene->reserved | (scene->reserved_pointer != NULL));
    if (result == MSPRING_OK)
        result = check_scene_numbers(scene, dt, message);
    if (result == MSPRING_OK && network->fractions.values)
        result = mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                               "the network has relative springs, which would follow the substeps of the scene's "
                               "fine run: set stiffness in N/m, or no scene");
    return result;
}

static mspring_result check_def(const mspring_tune_def **given, mspring_tune_def *def, mspringi_message *message) {
    mspring_result result = mspringi_take_tune_def_or_defaults(message, given, def);
    if (result == MSPRING_OK)
        result = mspringi_check_reserved(message, "mspring_tune_def", def->reserved_pointer != NULL);
    if (result == MSPRING_OK)
        result = check_numbers(def, message);
    if (result != MSPRING_OK)
        return result;
    if (def->setting_count > MAX_SETTINGS || (def->settings && def->setting_count == 0))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "setting_count is %u, it must be 1 to %d",
                             (unsigned)def->setting_count, MAX_SETTINGS);
    if (!def->settings && def->setting_count > 0)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "settings is NULL, but setting_count %u",
                             (unsigned)def->setting_count);
    if (!def->clock && !mspringi_clock())
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "this build has no clock: set clock in mspring_tune_def");
    return MSPRING_OK;
}

static mspring_result check_settings(const mspring_settings *settings, uint32_t count, mspringi_message *message) {
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        mspring_settings setting;
        result = mspringi_take_settings_at(message, settings, i, &setting);
        if (result == MSPRING_OK)
            result = mspringi_check_settings(&setting, message);
        result = mspringi_prefix(message, result, "setting", i);
    }
    return result;
}

static mspring_result check_rows(const mspring_tune_row *rows, uint32_t capacity, uint32_t needed,
                                 mspringi_message *message) {
    if (capacity < needed)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "there is room for %u rows, but %u settings",
                             (unsigned)capacity, (unsigned)needed);
    return mspringi_check_output(message, &mspringi_struct_tune_row, rows);
}

/* -------------------------------------------------------------------------------------------------------- time */

bool mspringi_tuning_has_time(mspringi_tuning *tuning, double part) {
    const mspring_tune_def *def = &tuning->def;
    if (tuning->is_over)
        return false;
    const double done = fmin((tuning->done + part) / tuning->units, 1.0);
    tuning->is_over =
        def->clock(def->user) - tuning->begun > def->budget || (def->progress && !def->progress(done, def->user));
    return !tuning->is_over;
}

/* ------------------------------------------------------------------------------------------------------- setup */

// Disable sleep and fallbacks, so that the setting itself is measured.
void mspringi_tune_disable_fallbacks(mspring_network *clone) {
    clone->settings.sleep_speed = 0.0f;
    mspringi_notify_change(clone, MSPRINGI_CHANGED_SLEEP, 0);
    if (clone->settings.guard == MSPRING_GUARD_IMPLICIT || clone->settings.guard == MSPRING_GUARD_CLAMP)
        clone->settings.guard = MSPRING_GUARD_GROWTH;
    else if (clone->settings.guard == MSPRING_GUARD_CLAMP_BOUNDS)
        clone->settings.guard = MSPRING_GUARD_BOUNDS;
}

void mspringi_tune_make_unbreakable(mspring_network *clone) {
    for (mspring_id spring = 0; clone->strain.break_strain && spring < clone->topology.spring_count; ++spring)
        mspringi_limit_store(clone, mspringi_slot_of_spring(&clone->topology, spring), MSPRING_BREAK_STRAIN,
                             INFINITY);
    clone->tested.yields = false;
}

// Take velocities of half a substep ago on to now, where settings of all solvers and the fine run start.
static mspring_result end_lag(mspring_network *base) {
    const double half = 0.5 * (double)base->steps.lag;
    mspringi_reference r;
    if (!(half > 0.0) || base->groups.count > 0)
        return MSPRING_OK;
    const mspring_result result = mspringi_reference_create(&r, base);
    if (result != MSPRING_OK)
        return result;
    mspringi_reference_clear_forces(&r); // they are of the step to come
    mspringi_reference_kick(&r, half);
    for (uint32_t p = 0; p < r.particle_count; ++p) {
        const uint32_t slot = base->topology.slot_of_particle[p];
        if (r.inverse_mass[p] > 0.0) {
            base->state.vx[slot] = (float)r.vx[p];
            base->state.vy[slot] = (float)r.vy[p];
        }
    }
    mspringi_reference_destroy(&r, base);
    base->steps.lag = 0.0f;
    mspringi_notify_change(base, MSPRINGI_CHANGED_STATE, 0);
    return MSPRING_OK;
}

// Make a clone with springs, gravity and external forces only: without ramps, breaking or a floor.
static mspring_result make_base(mspringi_tuning *tuning) {
    mspring_result result = mspringi_tune_clone(tuning, tuning->network, 0, &tuning->base);
    if (result != MSPRING_OK)
        return result;
    mspring_network *base = tuning->base;
    if (base->forces.first_any) // another blow with each substep length
        mspringi_field_clear(base, base->forces.first);
    base->forces.first_any = false;
    result = mspring_network_set_floor(base, NULL);
    if (result != MSPRING_OK)
        return result;
    mspringi_tune_disable_fallbacks(base);
    mspringi_tune_make_unbreakable(base);
    if (base->ramps)
        base->ramps->count = 0;
    result = end_lag(base);
    if (result != MSPRING_OK) {
        tuning->network->message = base->message;
        return result;
    }
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

uint32_t mspringi_tune_steps_in(double duration, double dt) {
    const double steps = duration / dt, whole = floor(steps);
    return (uint32_t)(whole < steps ? whole + 1.0 : whole);
}

// Number of steps of a trajectory; the upper limit if the duration is automatic.
static uint32_t steps_of(const mspring_tune_def *def) {
    if (def->duration == 0.0)
        return MSPRINGI_TUNE_MAX_STEPS;
    const uint32_t steps = mspringi_tune_steps_in(def->duration, def->dt);
    return steps > MSPRINGI_TUNE_MOMENTS ? steps : MSPRINGI_TUNE_MOMENTS;
}

static mspring_result allocate(mspringi_tuning *tuning) {
    mspringi_memory *memory = &tuning->network->memory;
    const size_t particles = tuning->network->topology.particle_count;
    tuning->time_capacity = MSPRINGI_TUNE_FIRST_STEPS + 2 * tuning->step_count;
    tuning->trials = mspringi_alloc(memory, tuning->trial_count, sizeof *tuning->trials);
    tuning->times =
        mspringi_alloc(memory, (size_t)2 * tuning->trial_count * tuning->time_capacity, sizeof *tuning->times);
    tuning->positions = mspringi_alloc(memory, 2 * MSPRINGI_TUNE_MOMENTS * particles, sizeof *tuning->positions);
    tuning->runs =
        mspringi_alloc(memory, ((size_t)tuning->trial_count + 1) * tuning->scene.start_count, sizeof *tuning->runs);
    if (!tuning->trials || !tuning->times || !tuning->positions || !tuning->runs)
        return mspringi_fail(&tuning->network->message, MSPRING_ERROR_MEMORY, "no memory to try %u settings",
                             (unsigned)tuning->trial_count);
    return MSPRING_OK;
}

static void fill_trials(mspringi_tuning *tuning, const mspring_settings *settings) {
    const mspring_settings own = mspringi_settings_of(tuning->network);
    for (uint32_t i = 0; i < tuning->trial_count; ++i) {
        mspringi_trial *trial = &tuning->trials[i];
        (void)mspringi_take_settings_at(NULL, settings, i, &trial->setting);
        trial->times = tuning->times + (size_t)2 * i * tuning->time_capacity;
        trial->rest_times = trial->times + tuning->time_capacity;
        trial->runs = tuning->runs + (size_t)i * tuning->scene.start_count;
        trial->row = (mspring_tune_row){
            .setting = i,
            .settings = mspringi_settings_with_solver_of(&own, &trial->setting),
        };
    }
}

/* ------------------------------------------------------------------------------------------------ measurements */

static mspring_result measure_swings(mspringi_tuning *tuning) {
    const mspring_tune_measure by = tuning->def.measure;
    const bool all = !(tuning->def.flags & MSPRING_TUNE_NOTHING_ELSE);
    const bool rests_first = by == MSPRING_TUNE_BY_REST || by == MSPRING_TUNE_BY_BENDING;
    mspring_result result = MSPRING_OK;
    if (tuning->def.duration == 0.0)
        result = mspringi_tune_choose_duration(tuning);
    if (result == MSPRING_OK && rests_first)
        result = mspringi_tune_rests(tuning);
    if (result == MSPRING_OK && (!rests_first || all))
        result = mspringi_tune_trajectories(tuning);
    if (result == MSPRING_OK && !rests_first && all)
        result = mspringi_tune_rests(tuning);
    return result;
}

static mspring_result measure(mspringi_tuning *tuning) {
    const bool by_scene = tuning->def.measure == MSPRING_TUNE_BY_SCENE;
    const bool all = !(tuning->def.flags & MSPRING_TUNE_NOTHING_ELSE);
    mspring_result result = mspringi_tune_costs(tuning);
    if (result == MSPRING_OK && by_scene)
        result = mspringi_tune_scenes(tuning);
    if (by_scene && !all)
        return result;
    if (result == MSPRING_OK)
        result = measure_swings(tuning);
    if (result == MSPRING_OK && !by_scene && all && tuning->def.scene)
        result = mspringi_tune_scenes(tuning);
    return result == MSPRING_OK ? mspringi_tune_more_costs(tuning) : result;
}

static mspring_result tune(mspringi_tuning *tuning, const mspring_settings *settings) {
    mspring_result result = allocate(tuning);
    if (result == MSPRING_OK)
        result = make_base(tuning);
    if (result != MSPRING_OK)
        return result;
    fill_trials(tuning, settings);
    result = measure(tuning);
    if (result == MSPRING_OK)
        mspringi_tune_rank(tuning);
    return result;
}

static mspring_result run(mspring_network *network, const mspring_tune_def *def, const mspring_settings *settings,
                          uint32_t setting_count, mspring_tune_row *rows, uint32_t *count) {
    mspringi_tuning tuning = {
        .network = network,
        .def = *def,
        .trial_count = setting_count,
        .step_count = steps_of(def),
        .units = (def->flags & MSPRING_TUNE_NOTHING_ELSE ? 3.0 : 4.0) * (double)setting_count,
    };
    if (def->scene) {
        tuning.scene = *def->scene;
        tuning.units += (double)def->scene->start_count * ((double)setting_count + 1.0);
    }
    if (!tuning.def.clock)
        tuning.def.clock = mspringi_clock();
    tuning.begun = tuning.def.clock(def->user);
    const mspring_result result = tune(&tuning, settings);
    if (result == MSPRING_OK) {
        for (uint32_t i = 0; i < setting_count; ++i)
            mspringi_put_tune_row_at(rows, i, &tuning.trials[i].row);
        *count = setting_count;
    }
    mspringi_tune_destroy_clone(tuning.base);
    mspringi_free(&network->memory, tuning.runs);
    mspringi_free(&network->memory, tuning.positions);
    mspringi_free(&network->memory, tuning.times);
    mspringi_free(&network->memory, tuning.trials);
    return result;
}

mspring_result mspring_network_tune(mspring_network *network, const mspring_tune_def *def, mspring_tune_row *rows,
                                    uint32_t capacity, uint32_t *count) {
    mspring_tune_def taken;
    mspring_tune_scene scene;
    mspring_settings usual[MSPRINGI_TUNE_DEFAULT_SETTINGS];
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    if (!rows || !count)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "rows or count is NULL");
    result = check_def(&def, &taken, &network->message);
    if (result == MSPRING_OK && taken.scene)
        result = check_scene(&taken.scene, &scene, taken.dt, network);
    if (result != MSPRING_OK)
        return result;
    const mspring_settings *settings = def->settings;
    uint32_t setting_count = def->setting_count;
    if (!settings) {
        settings = usual;
        for (int i = 0; i < MSPRINGI_TUNE_DEFAULT_SETTINGS; ++i)
            usual[i].struct_size = sizeof usual[i];
        result = mspring_tune_settings(network, def->dt, usual, MSPRINGI_TUNE_DEFAULT_SETTINGS, &setting_count);
    }
    if (result == MSPRING_OK)
        result = check_rows(rows, capacity, setting_count, &network->message);
    if (result == MSPRING_OK)
        result = check_settings(settings, setting_count, &network->message);
    return result == MSPRING_OK ? run(network, def, settings, setting_count, rows, count) : result;
}

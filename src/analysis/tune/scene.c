/// Comparison of settings in a scene of the host, with floor, hooks and breaking, by statistics over many starts.
///
/// A breaking body is chaotic: the final place of a fragment says nothing about a setting, the mean number of
/// broken springs does. The fine run and all settings take one start before the next. So whenever the budget ends,
/// all were compared from the same starts, except for the last one.
#include <math.h>

#include "analysis/tune/tuning.h"
#include "base/hash.h"
#include "store/changed.h"
#include "store/springs.h"

/// Longest substep of the fine run, relative to the longest that is stable in any shape; and its substeps, relative
/// to the largest number of the explicit settings.
#define FINE_PART_OF_STABLE (1.0 / 3.0)
#define FINE_TIMES_SETTINGS 2.0

/// Smallest unit of a distance: for counts, and relative to the setting's own mean.
#define MIN_COUNT_UNIT 1.0
#define MIN_RELATIVE_UNIT 1e-6

/// Outcome of a run.
typedef enum run_outcome { WHOLE, REJECTED, CUT_SHORT } run_outcome;

/* ---------------------------------------------------------------------------------------------------- one start */

// Pseudo-random number from -1 to 1 for each n.
static double noise_at(size_t n) {
    return (double)(mspringi_mix((uint64_t)n + 1) >> 11) * 0x1p-52 - 1.0;
}

static void perturb(mspring_network *network, uint32_t start, double most) {
    const size_t particles = network->topology.particle_count;
    for (uint32_t p = 0; p < particles; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        if (!(network->inverse_mass[slot] > 0.0f))
            continue;
        const size_t number = 2 * (start * particles + p);
        network->state.vx[slot] += (float)(most * noise_at(number));
        network->state.vy[slot] += (float)(most * noise_at(number + 1));
    }
    mspringi_notify_change(network, MSPRINGI_CHANGED_STATE, 0);
}

// Clone the network with the features that the scene enables, and perturb it.
static mspring_result make_start(mspringi_tuning *tuning, uint32_t start, mspring_network **made) {
    const mspring_tune_scene *scene = &tuning->scene;
    *made = NULL;
    const bool kept = scene->flags & MSPRING_TUNE_SCENE_HOOKS;
    mspring_result result = mspringi_tune_clone(tuning, tuning->network, kept, made);
    if (result != MSPRING_OK)
        return result;
    mspringi_tune_disable_fallbacks(*made);
    if (!(scene->flags & MSPRING_TUNE_SCENE_FLOOR))
        result = mspring_network_set_floor(*made, NULL);
    if (!(scene->flags & MSPRING_TUNE_SCENE_BREAKING))
        mspringi_tune_make_unbreakable(*made);
    if (start > 0)
        perturb(*made, start, scene->kick);
    return result;
}

/* --------------------------------------------------------------------------------------------------------- runs */

static double count_live(const mspring_network *network) {
    double live = 0.0;
    for (mspring_id spring = 0; spring < network->topology.spring_count; ++spring)
        live +=
            mspringi_spring_slot_is_live(network, mspringi_slot_of_spring(&network->topology, spring)) ? 1.0 : 0.0;
    return live;
}

static void measure_run(const mspring_network *network, double live_before, mspringi_scene_run *run) {
    mspring_energy energy = {.struct_size = sizeof energy};
    mspring_body all = {.struct_size = sizeof all};
    if (mspring_network_get_energy(network, &energy) != MSPRING_OK ||
        mspring_network_get_body(network, NULL, 0, MSPRING_ALL, &all) != MSPRING_OK)
        return;
    run->quantities[MSPRING_TUNE_BROKEN] = live_before - count_live(network);
    run->quantities[MSPRING_TUNE_ENERGY] = energy.kinetic + energy.elastic;
    run->quantities[MSPRING_TUNE_EXTENT] = fmax(all.max_x - all.min_x, all.max_y - all.min_y);
}

static mspring_result forward_error(mspringi_tuning *tuning, const mspring_network *clone, mspring_result result) {
    tuning->network->message = clone->message;
    return result;
}

// Call the host's prepare, then set the solver. set: false if this kind of solver cannot take the network.
static mspring_result prepare(mspringi_tuning *tuning, mspring_network *clone, const mspring_settings *solver,
                              uint32_t start, bool *set) {
    const mspring_tune_scene *scene = &tuning->scene;
    mspring_result result = scene->prepare ? scene->prepare(clone, start, tuning->def.user) : MSPRING_OK;
    if (result != MSPRING_OK)
        return mspringi_fail(&tuning->network->message, result, "the scene's prepare returned %d at start %u",
                             (int)result, (unsigned)start);
    result = mspringi_tune_set_solver(clone, solver);
    *set = result == MSPRING_OK;
    return result == MSPRING_OK || result == MSPRING_ERROR_LIMIT ? MSPRING_OK
                                                                 : forward_error(tuning, clone, result);
}

static mspring_result take_steps(mspringi_tuning *tuning, mspring_network *clone, mspringi_scene_run *run,
                                 run_outcome *end) {
    const mspring_tune_def *def = &tuning->def;
    const uint32_t steps = mspringi_tune_steps_in(tuning->scene.duration, def->dt);
    const double live_before = count_live(clone);
    double seconds = 0.0;
    for (uint32_t step = 0; step < steps; ++step) {
        *end = CUT_SHORT;
        if (!mspringi_tuning_has_time(tuning, (double)step / (double)steps))
            return MSPRING_OK;
        const double before = def->clock(def->user);
        const mspring_result result = mspring_network_step(clone, def->dt);
        seconds += fmax(def->clock(def->user) - before, 0.0);
        *end = REJECTED;
        if (result != MSPRING_OK)
            return result == MSPRING_ERROR_UNSTABLE ? MSPRING_OK : forward_error(tuning, clone, result);
    }
    run->cost = seconds / (double)steps;
    measure_run(clone, live_before, run);
    *end = WHOLE;
    return MSPRING_OK;
}

static mspring_result run_solver(mspringi_tuning *tuning, mspring_network *from, uint32_t start,
                                 const mspring_settings *solver, mspringi_scene_run *run, run_outcome *end) {
    mspring_network *clone = NULL;
    bool set = false;
    *end = REJECTED;
    mspring_result result = mspringi_tune_clone(tuning, from, true, &clone);
    if (result == MSPRING_OK)
        result = prepare(tuning, clone, solver, start, &set);
    if (result == MSPRING_OK && set)
        result = take_steps(tuning, clone, run, end);
    mspringi_tune_destroy_clone(clone);
    tuning->done += 1.0;
    return result;
}

/* --------------------------------------------------------------------------------------------------- all starts */

static bool can_run(const mspringi_trial *trial) {
    return trial->row.flags & MSPRING_TUNE_HAS_COST && !(trial->row.flags & MSPRING_TUNE_REJECTED);
}

// Choose the solver of the fine run. substeps 0: no fine run is possible.
static mspring_result choose_fine(mspringi_tuning *tuning, mspring_settings *solver) {
    double any_shape = 0.0;
    (void)mspring_init(MSPRING_STRUCT_SETTINGS, solver, sizeof *solver);
    const mspring_result result = mspring_network_get_stable_dt(tuning->base, NULL, &any_shape);
    if (result != MSPRING_OK)
        return forward_error(tuning, tuning->base, result);
    double substeps = floor(tuning->def.dt / (FINE_PART_OF_STABLE * any_shape)) + 1.0;
    for (uint32_t i = 0; i < tuning->trial_count; ++i)
        if (can_run(&tuning->trials[i]) && tuning->trials[i].row.settings.solver == MSPRING_SOLVER_EXPLICIT)
            substeps = fmax(substeps, FINE_TIMES_SETTINGS * tuning->trials[i].row.settings.substeps);
    solver->substeps = substeps <= MSPRING_MAX_SUBSTEPS ? (uint32_t)substeps : 0;
    return MSPRING_OK;
}

static bool can_any_run(const mspringi_tuning *tuning) {
    bool is_any = false;
    for (uint32_t i = 0; i < tuning->trial_count; ++i)
        is_any = is_any || can_run(&tuning->trials[i]);
    return is_any;
}

// Run one start with the fine run and all settings. Unless it ends WHOLE, there is no next start.
static mspring_result run_start(mspringi_tuning *tuning, const mspring_settings *fine, uint32_t start,
                                mspringi_scene_run *fine_runs, run_outcome *end) {
    mspring_network *from = NULL;
    mspring_result result = make_start(tuning, start, &from);
    *end = CUT_SHORT;
    if (result == MSPRING_OK)
        result = run_solver(tuning, from, start, fine, &fine_runs[start], end);
    for (uint32_t i = 0; result == MSPRING_OK && *end == WHOLE && i < tuning->trial_count; ++i) {
        mspringi_trial *trial = &tuning->trials[i];
        if (!can_run(trial))
            continue;
        run_outcome outcome = CUT_SHORT;
        result = run_solver(tuning, from, start, &trial->setting, &trial->runs[start], &outcome);
        if (outcome == WHOLE)
            trial->row.scene_starts = start + 1;
        else if (outcome == REJECTED && result == MSPRING_OK)
            trial->row.flags |= MSPRING_TUNE_REJECTED;
        else
            *end = CUT_SHORT;
    }
    mspringi_tune_destroy_clone(from);
    return result;
}

/* ------------------------------------------------------------------------------------------------------ results */

static void sum_up(const mspringi_scene_run *runs, uint32_t count, size_t quantity, double *mean, double *spread) {
    double sum = 0.0, squares = 0.0;
    for (uint32_t i = 0; i < count; ++i)
        sum += runs[i].quantities[quantity];
    *mean = sum / count;
    for (uint32_t i = 0; i < count; ++i)
        squares += (runs[i].quantities[quantity] - *mean) * (runs[i].quantities[quantity] - *mean);
    *spread = sqrt(squares / (count - 1));
}

static void fill_row(mspringi_trial *trial, const mspringi_scene_run *fine_runs, uint32_t fine_substeps,
                     double tolerance) {
    mspring_tune_row *row = &trial->row;
    double costs[MSPRINGI_TUNE_MAX_STARTS];
    row->flags |= MSPRING_TUNE_HAS_SCENE;
    row->fine_substeps = fine_substeps;
    for (uint32_t i = 0; i < row->scene_starts; ++i)
        costs[i] = trial->runs[i].cost;
    row->scene_cost = mspringi_tune_median(costs, row->scene_starts);
    for (size_t q = 0; q < MSPRING_TUNE_QUANTITIES; ++q) {
        sum_up(trial->runs, row->scene_starts, q, &row->scene_mean[q], &row->scene_spread[q]);
        sum_up(fine_runs, row->scene_starts, q, &row->fine_mean[q], &row->fine_spread[q]);
        double unit = fmax(row->fine_spread[q], tolerance * fabs(row->fine_mean[q]));
        unit = fmax(unit, q == MSPRING_TUNE_BROKEN ? MIN_COUNT_UNIT : MIN_RELATIVE_UNIT * fabs(row->scene_mean[q]));
        const double difference = fabs(row->scene_mean[q] - row->fine_mean[q]);
        row->scene_distance = fmax(row->scene_distance, difference > 0.0 ? difference / unit : 0.0);
    }
}

mspring_result mspringi_tune_scenes(mspringi_tuning *tuning) {
    mspringi_scene_run *fine_runs = tuning->runs + (size_t)tuning->trial_count * tuning->scene.start_count;
    mspring_settings fine;
    run_outcome end = WHOLE;
    mspring_result result = choose_fine(tuning, &fine);
    if (result != MSPRING_OK || fine.substeps == 0)
        return result;
    const uint32_t starts = tuning->scene.start_count;
    for (uint32_t start = 0; result == MSPRING_OK && end == WHOLE && start < starts && can_any_run(tuning); ++start)
        result = run_start(tuning, &fine, start, fine_runs, &end);
    for (uint32_t i = 0; result == MSPRING_OK && i < tuning->trial_count; ++i) {
        mspringi_trial *trial = &tuning->trials[i];
        if (can_run(trial) && trial->row.scene_starts >= MSPRINGI_TUNE_MIN_STARTS)
            fill_row(trial, fine_runs, fine.substeps, tuning->scene.tolerance);
        else
            trial->row.scene_starts = 0;
    }
    return result;
}

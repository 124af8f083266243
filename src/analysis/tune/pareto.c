/// Pareto front and recommendation.
#include <math.h>

#include "analysis/tune/tuning.h"

static void sort(double *values, uint32_t count) {
    for (uint32_t gap = count / 2; gap > 0; gap /= 2)
        for (uint32_t i = gap; i < count; ++i) {
            const double value = values[i];
            uint32_t at = i;
            for (; at >= gap && values[at - gap] > value; at -= gap)
                values[at] = values[at - gap];
            values[at] = value;
        }
}

double mspringi_tune_median(double *values, uint32_t count) {
    sort(values, count);
    return count > 0 ? 0.5 * (values[(count - 1) / 2] + values[count / 2]) : 0.0;
}

static void sum_up(mspringi_trial *trial) {
    mspring_tune_row *row = &trial->row;
    row->moving_cost = mspringi_tune_median(trial->times, trial->time_count);
    row->resting_cost = mspringi_tune_median(trial->rest_times, trial->rest_count);
    for (uint32_t i = 0; i < trial->rest_count; ++i)
        trial->times[trial->time_count + i] = trial->rest_times[i];
    row->step_count = trial->time_count + trial->rest_count;
    row->median_cost = mspringi_tune_median(trial->times, row->step_count);
    row->min_cost = row->step_count > 0 ? trial->times[0] : 0.0;
}

static double error_of(const mspring_tune_row *row, mspring_tune_measure measure) {
    return measure == MSPRING_TUNE_BY_TRAJECTORY ? row->trajectory_share
           : measure == MSPRING_TUNE_BY_REST     ? row->rest_share
           : measure == MSPRING_TUNE_BY_SCENE    ? row->scene_distance
                                                 : row->bending;
}

static double cost_of(const mspring_tune_row *row, mspring_tune_measure measure) {
    return measure == MSPRING_TUNE_BY_SCENE ? row->scene_cost : row->median_cost;
}

static bool is_measured(const mspring_tune_row *row, mspring_tune_measure measure) {
    const uint32_t needed =
        MSPRING_TUNE_HAS_COST | (measure == MSPRING_TUNE_BY_TRAJECTORY ? (uint32_t)MSPRING_TUNE_HAS_TRAJECTORY
                                 : measure == MSPRING_TUNE_BY_SCENE    ? (uint32_t)MSPRING_TUNE_HAS_SCENE
                                                                       : (uint32_t)MSPRING_TUNE_HAS_REST);
    return (row->flags & needed) == needed && !(row->flags & MSPRING_TUNE_REJECTED);
}

static bool is_dominated(const mspringi_tuning *tuning, const mspring_tune_row *row) {
    const mspring_tune_measure measure = tuning->def.measure;
    for (uint32_t i = 0; i < tuning->trial_count; ++i) {
        const mspring_tune_row *other = &tuning->trials[i].row;
        if (!is_measured(other, measure))
            continue;
        const double cost = cost_of(other, measure) - cost_of(row, measure);
        const double error = error_of(other, measure) - error_of(row, measure);
        if (cost <= 0.0 && error <= 0.0 && (cost < 0.0 || error < 0.0))
            return true;
    }
    return false;
}

void mspringi_tune_rank(const mspringi_tuning *tuning) {
    const mspring_tune_def *def = &tuning->def;
    const double most = def->measure == MSPRING_TUNE_BY_SCENE ? tuning->scene.max_distance : def->max_error;
    mspring_tune_row *best = NULL;
    for (uint32_t i = 0; i < tuning->trial_count; ++i)
        sum_up(&tuning->trials[i]);
    for (uint32_t i = 0; i < tuning->trial_count; ++i) {
        mspring_tune_row *row = &tuning->trials[i].row;
        if (!is_measured(row, def->measure))
            continue;
        if (!is_dominated(tuning, row))
            row->flags |= MSPRING_TUNE_PARETO;
        const double error = error_of(row, def->measure), cost = cost_of(row, def->measure);
        const bool gains_energy = row->flags & MSPRING_TUNE_HAS_TRAJECTORY && row->energy_drift > def->max_drift;
        if (error > most || cost > def->max_cost || gains_energy)
            continue;
        if (!best || (most < INFINITY ? cost < cost_of(best, def->measure) : error < error_of(best, def->measure)))
            best = row;
    }
    if (best)
        best->flags |= MSPRING_TUNE_RECOMMENDED;
}

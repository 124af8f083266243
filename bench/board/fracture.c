/// @file fracture.c
/// A bridge that is too heavy breaks, from many starts: the distribution of what breaks, beside the right one.
///
/// SPDX-License-Identifier: MIT
#include "board/fracture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "board/measures.h"
#include "common/clock.h"
#include "common/output.h"
#include "draw/scatter.h"

/// The median of what 32 values come from lies between the 11th and the 22nd of them in 95 % of all cases.
enum { STARTS = 32, LOW = 10, MIDDLE = 16, HIGH = 21 };
/// Frames of a start; substeps of the reference, in the fewest that are stable.
enum { TIME = 2 * SECOND, REFERENCE = 8 };

/// A bridge of 80 x 5, as the bar of the board, and what it bears.
static const double break_strain = 0.02, heaviness = 8, /* g */ shake = 1e-3; /* m, of a start */
/// Methods whose frames take longer are not asked, us.
static const double dearest = 2500;

/// What came of the starts, each sorted.
typedef struct outcome {
    double broken[STARTS], pieces[STARTS];
    double us; ///< of a frame
} outcome;

static double noise(uint64_t *seed) { // -1 to 1
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 40) / 8388608.0 - 1;
}

// A model of its own, as springs lose their stiffness: the bar held at both ends, each particle a little elsewhere.
static bool begin_start(int start, model *m) {
    uint64_t seed = (uint64_t)start * 2654435769u + 1;
    if (!stage_read(&board_stages[0], m))
        return false;
    const double right = m->x[m->probe];
    m->gravity *= heaviness;
    for (uint32_t i = 0; i < m->particle_count; i++) {
        if (m->x[i] >= right)
            m->inverse_mass[i] = 0;
        if (m->inverse_mass[i] > 0) {
            m->x[i] += shake * noise(&seed);
            m->y[i] += shake * noise(&seed);
        }
    }
    return true;
}

// Those that are stretched or pressed too far; as a game does it, once a frame.
static uint32_t find_broken(model *m, const model_state *state, uint32_t *broken) {
    uint32_t count = 0;
    for (uint32_t s = 0; s < m->spring_count; s++) {
        const double dx = state->x[m->b[s]] - state->x[m->a[s]], dy = state->y[m->b[s]] - state->y[m->a[s]];
        if (m->stiffness[s] > 0 && !(fabs(sqrt(dx * dx + dy * dy) / m->rest[s] - 1) < break_strain)) {
            m->stiffness[s] = 0;
            broken[count++] = s;
        }
    }
    return count;
}

static uint32_t root_of(uint32_t *parent, uint32_t i) {
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

static uint32_t count_pieces(const model *m, uint32_t *parent) {
    uint32_t pieces = m->particle_count;
    for (uint32_t i = 0; i < m->particle_count; i++)
        parent[i] = i;
    for (uint32_t s = 0; s < m->spring_count; s++) {
        const uint32_t a = root_of(parent, m->a[s]), b = root_of(parent, m->b[s]);
        if (m->stiffness[s] > 0 && a != b) {
            parent[a] = b;
            pieces--;
        }
    }
    return pieces;
}

// One start with a method, or in double precision with many substeps if that is NULL.
static bool follow(const method *by, uint32_t effort, model *m, model_state *state, uint32_t *work, outcome *found,
                   int start) {
    motion run;
    uint32_t broken = 0;
    if (by && !motion_begin(&run, by, m, effort, 0, FRAME_TIME))
        return false;
    bool good = true;
    const double begun = clock_processor_seconds();
    for (int i = 0; good && i < TIME; i++) {
        if (by) {
            by->frame(&run, FRAME_TIME);
            motion_state(&run, by, state);
        } else
            good = model_move(m, FRAME_TIME, effort, state);
        const uint32_t count = find_broken(m, state, work);
        if (by && by->cut && count > 0)
            good = good && by->cut(&run, work, count, FRAME_TIME);
        broken += count;
    }
    found->us += (clock_processor_seconds() - begun) * 1e6 / TIME / STARTS;
    found->broken[start] = broken;
    found->pieces[start] = count_pieces(m, work);
    if (by)
        motion_end(&run, by);
    return good;
}

static int compare(const void *one, const void *other) {
    const double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

// All starts from the first on.
static bool follow_all(const method *by, uint32_t effort, int first, outcome *found) {
    bool good = true;
    found->us = 0;
    for (int start = 0; good && start < STARTS; start++) {
        model m = {0};
        model_state state = {0};
        good = begin_start(first + start, &m);
        uint32_t *work = good ? malloc((m.spring_count + m.particle_count) * sizeof *work) : NULL;
        good = good && work && model_state_begin(&m, &state) && follow(by, effort, &m, &state, work, found, start);
        free(work);
        model_state_end(&state);
        model_free(&m);
        if (found->us > dearest / STARTS * (start + 1) && by)
            break;
    }
    qsort(found->broken, STARTS, sizeof *found->broken, compare);
    qsort(found->pieces, STARTS, sizeof *found->pieces, compare);
    return good;
}

/// How far one sorted sample lies from another: the mean distance, as a share of the other's mean.
static double distance(const double *from, const double *to) {
    double sum = 0, mean = 0;
    for (int i = 0; i < STARTS; i++) {
        sum += fabs(from[i] - to[i]);
        mean += to[i];
    }
    return sum / mean;
}

static double print_outcome(const char *name, uint32_t effort, const outcome *found, const outcome *exact) {
    const double far = distance(found->broken, exact->broken);
    printf("%s,%u,%.2f,%g,%g,%g,%g,%g,%g,%.4g\n", name, (unsigned)effort, found->us, found->broken[LOW],
           found->broken[MIDDLE], found->broken[HIGH], found->pieces[LOW], found->pieces[MIDDLE],
           found->pieces[HIGH], far);
    fflush(stdout);
    return far;
}

static bool draw(const scatter_series *series, size_t count, const char *folder) {
    figure drawn;
    figure_start(&drawn, 800, 560, 0xffffff);
    scatter_draw(&drawn,
                 &(scatter){.title = "A bridge of 80 x 5 that breaks: 32 starts",
                            .x_label = "time of a frame of 1/64 s, us",
                            .y_label = "error of the distribution of broken springs",
                            .series = series,
                            .series_count = count,
                            .percent = true},
                 0, 0, 800, 560);
    const bool good = output_figure(&drawn, folder, "board_fracture");
    figure_free(&drawn);
    return good;
}

// One method at its efforts.
static bool follow_method(const method *by, uint32_t least, const outcome *exact, scatter_point *points,
                          size_t *count) {
    static outcome found;
    double us = 0;
    for (int e = 0; e < MOST_EFFORTS && by->efforts[e] > 0; e++) {
        const uint32_t effort = by->efforts[e] * (by->by_stability ? least : 1);
        if (e > 0 && us * by->efforts[e] / by->efforts[e - 1] > dearest)
            break;
        if (!follow_all(by, effort, 0, &found))
            return false;
        us = found.us;
        points[(*count)++] = (scatter_point){.x = us, .y = print_outcome(by->name, effort, &found, exact)};
    }
    return true;
}

bool fracture_board(const char *folder) {
    static scatter_point points[BOARD_MOST_METHODS][MOST_EFFORTS];
    static outcome exact, other;
    scatter_series series[BOARD_MOST_METHODS + 1];
    model m;
    size_t count = 0;
    if (!begin_start(0, &m))
        return false;
    const uint32_t least = least_substeps(&m);
    model_free(&m);
    printf("\nmethod,effort,us_per_frame,broken_low,broken_median,broken_high,pieces_low,pieces_median,pieces_high,"
           "distance\n");
    bool good =
        follow_all(NULL, REFERENCE * least, 0, &exact) && follow_all(NULL, REFERENCE * least, STARTS, &other);
    if (!good)
        return false;
    print_outcome("reference", REFERENCE * least, &exact, &exact);
    const double chance = print_outcome("reference, other starts", REFERENCE * least, &other, &exact);
    for (; good && board_methods[count]; count++) {
        series[count] = (scatter_series){.points = points[count],
                                         .mark = count < OURS ? SCATTER_DISC : SCATTER_SQUARE,
                                         .colour = board_methods[count]->colour,
                                         .name = board_methods[count]->name,
                                         .joined = true};
        good = follow_method(board_methods[count], least, &exact, points[count], &series[count].count);
    }
    const scatter_point chances[] = {{.x = 10, .y = chance}, {.x = dearest, .y = chance}};
    series[count++] = (scatter_series){.points = chances,
                                       .count = 2,
                                       .mark = SCATTER_NO_MARK,
                                       .colour = 0x999999,
                                       .name = "by chance: 32 other starts",
                                       .joined = true};
    return good && draw(series, count, folder);
}

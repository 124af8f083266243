/// @file 07_tune.c
/// The trade of speed for accuracy, measured: what a step costs with each solver, and how good it is.
///
/// For each network mspring_network_tune() measures the usual settings from the moment that it is let go of. Then
/// the setting that it recommends is run, to see whether the promise is kept. Then its springs are made stiffer,
/// again and again: what is paid for less bending? At last a lattice is thrown onto a slope, where it breaks: which
/// settings break as many springs as a fine run?
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL // for lab.h
#include "common/check.h"
#include "common/clock.h"
#include "common/output.h"
#include "common/progress.h"
#include "draw/scatter.h"
#include "scenes/scene.h"

#include <massspring/massspring.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ROWS = 32, MOST_STIFFER = 8, SOLVERS = 3, STEPS_OF_THE_PROMISE = 64 };

static const double dt = 1.0 / 64; // s

// Per network: a bar's size, or an image and its materials; and how often its springs are made four times as stiff.
// The ship's never are: its rest is not looked for, as its rigging comes down by 45 m, which takes half a minute to
// find.
typedef struct subject {
    const char *name, *title;
    uint32_t columns, rows;
    int stiffer;
    bool crashes;
} subject;

static const subject subjects[] = {
    {"bar_80x5", "Bar of 80 x 5 particles", 80, 5, 7, false},
    {"bar_544x68", "Bar of 544 x 68 particles", 544, 68, 4, false},
    {"bar_1800x5", "Bar of 1800 x 5 particles", 1800, 5, 8, false},
    {"ship", "Our ship: 157,962 springs, damped", 0, 0, 0, false},
    {"crash", "Lattice of 40 x 10 particles that breaks on a slope", 40, 10, 0, true},
};

static const char *const solver_names[SOLVERS] = {"explicit", "implicit", "direct"};
static const draw_colour solver_colours[SOLVERS] = {0x2f7fd6, 0xe07b10, 0x2b8a5b};
static const scatter_mark solver_marks[SOLVERS] = {SCATTER_DISC, SCATTER_SQUARE, SCATTER_DIAMOND};

typedef struct options {
    const char *folder, *images, *only;
    double budget;
    double (*clock)(void);
} options;

// Points of one plot, by solver, and those that no other beats.
typedef struct cloud {
    scatter_point points[SOLVERS][MOST_ROWS + MOST_STIFFER];
    size_t counts[SOLVERS];
    scatter_point front[SOLVERS * (MOST_ROWS + MOST_STIFFER)];
    size_t front_count;
} cloud;

/* ---------------------------------------------------------------------------------------------------- measuring */

// What a run is told by and tells.
typedef struct watch {
    progress line;
    double (*clock)(void);
} watch;

static double read_clock(void *user) {
    const watch *read = user;
    return read->clock();
}

static uint32_t show_progress(double done, void *user) {
    watch *shown = user;
    char text[64];
    if (progress_due(&shown->line)) {
        snprintf(text, sizeof text, "measuring: %.0f %%", 100 * done);
        progress_write(&shown->line, text);
    }
    return 1;
}

static bool tune(mspring_network *network, const options *how, mspring_tune_def *def, mspring_tune_row *rows,
                 uint32_t *count) {
    watch told = {.clock = how->clock};
    progress_start(&told.line);
    def->clock = read_clock;
    def->progress = show_progress;
    def->user = &told;
    for (int i = 0; i < MOST_ROWS; i++)
        rows[i].struct_size = sizeof rows[i];
    const mspring_result result = mspring_network_tune(network, def, rows, MOST_ROWS, count);
    progress_clear(&told.line);
    def->user = NULL;
    return check(result, "tune", mspring_network_error(network));
}

static void add_point(cloud *to, mspring_solver solver, double x, double y, const char *label, bool ringed) {
    scatter_point *point = &to->points[solver][to->counts[solver]++];
    *point = (scatter_point){.x = x, .y = y, .ringed = ringed};
    snprintf(point->label, sizeof point->label, "%s", label);
}

static int compare_cost(const void *a, const void *b) {
    const scatter_point *first = a, *second = b;
    return (first->x > second->x) - (first->x < second->x);
}

// The points that no other beats, by rising cost.
static void find_front(cloud *of) {
    scatter_point *all = of->front;
    size_t count = 0;
    for (int s = 0; s < SOLVERS; s++)
        for (size_t i = 0; i < of->counts[s]; i++)
            all[count++] = of->points[s][i];
    qsort(all, count, sizeof *all, compare_cost);
    for (size_t i = 0; i < count; i++)
        if (of->front_count == 0 || all[i].y < all[of->front_count - 1].y)
            all[of->front_count++] = all[i];
}

/* -------------------------------------------------------------------------------------------------------- error */

static void print_row(const mspring_tune_row *row) {
    char residual[16] = "";
    const bool steps_back =
        row->settings.solver != MSPRING_SOLVER_EXPLICIT && row->settings.integrator == MSPRING_INTEGRATOR_BDF2;
    if (row->settings.solver == MSPRING_SOLVER_IMPLICIT)
        snprintf(residual, sizeof residual, "%g", (double)row->settings.residual);
    printf("%-9s %-5s %8u %10s", solver_names[row->settings.solver], steps_back ? "BDF2" : "",
           row->settings.substeps, residual);
    if (row->flags & MSPRING_TUNE_REJECTED) {
        printf("   rejected as unstable\n");
        return;
    }
    printf(" %11.1f %11.1f", 1e6 * row->min_cost, 1e6 * row->moving_cost);
    if (row->resting_cost > 0)
        printf(" %11.1f", 1e6 * row->resting_cost);
    else
        printf(" %11s", "-");
    if (row->flags & MSPRING_TUNE_HAS_TRAJECTORY)
        printf(" %11.5f %9.3f %9.2f", row->trajectory_error, 100 * row->trajectory_share, 100 * row->energy_drift);
    else
        printf(" %11s %9s %9s", "-", "-", "-");
    if (row->flags & MSPRING_TUNE_HAS_REST)
        printf(" %10.4g %10.1e", row->bending, row->rest_error);
    else
        printf(" %10s %10s", "-", "-");
    printf("  %s%s\n", row->flags & MSPRING_TUNE_PARETO ? "front" : "",
           row->flags & MSPRING_TUNE_RECOMMENDED ? ", recommended" : "");
}

static void print_rows(const subject *about, const mspring_tune_row *rows, uint32_t count) {
    double duration = 0;
    for (uint32_t i = 0; i < count; i++)
        duration = fmax(duration, rows[i].duration);
    printf("\n%s, steps of 1/64 s, compared for %.3g s\n\n", about->title, duration);
    printf("%-15s %8s %10s %11s %11s %11s %11s %9s %9s %10s %10s\n", "solver", "substeps", "residual",
           "least, us", "moving, us", "resting, us", "error, m", "error, %", "energy, %", "bending, m",
           "at rest, m");
    for (uint32_t i = 0; i < count; i++)
        print_row(&rows[i]);
    for (uint32_t i = 0; i < count; i++)
        if (rows[i].flags & MSPRING_TUNE_CHAOTIC) {
            printf("\nThe motion is chaotic: fine runs that start a rounding apart differ by %.2g %% of it.\n",
                   100 * (double)rows[i].trajectory_spread);
            break;
        }
}

// How a setting is called in a plot.
static void print_label(char *label, size_t size, const mspring_tune_row *row) {
    const bool ga0 =
        row->settings.solver != MSPRING_SOLVER_EXPLICIT && row->settings.integrator == MSPRING_INTEGRATOR_ALPHA;
    if (row->settings.solver == MSPRING_SOLVER_IMPLICIT)
        snprintf(label, size, "%u, %g%s", row->settings.substeps, (double)row->settings.residual, ga0 ? " GA0" : "");
    else
        snprintf(label, size, "%u%s", row->settings.substeps, ga0 ? " GA0" : "");
}

static void collect_errors(const mspring_tune_row *rows, uint32_t count, cloud *to) {
    char label[32];
    for (uint32_t i = 0; i < count; i++) {
        const mspring_tune_row *row = &rows[i];
        if (!(row->flags & MSPRING_TUNE_HAS_TRAJECTORY))
            continue;
        print_label(label, sizeof label, row);
        add_point(to, row->settings.solver, 1e6 * row->median_cost, row->trajectory_share, label,
                  row->flags & MSPRING_TUNE_RECOMMENDED);
    }
    find_front(to);
}

static int compare_double(const void *a, const void *b) {
    const double first = *(const double *)a, second = *(const double *)b;
    return (first > second) - (first < second);
}

// Run the recommended setting on a clone, for longer than it was measured, and compare costs.
static bool check_promise(mspring_network *network, const options *how, const mspring_tune_row *row) {
    double seconds[STEPS_OF_THE_PROMISE];
    mspring_network *clone = NULL;
    mspring_result result = mspring_network_clone(network, NULL, &clone);
    if (result == MSPRING_OK)
        result = mspring_network_set_settings(clone, &row->settings);
    for (int i = 0; result == MSPRING_OK && i < STEPS_OF_THE_PROMISE; i++) {
        const double before = how->clock();
        result = mspring_network_step(clone, dt);
        seconds[i] = how->clock() - before;
    }
    const bool ok = check(result, "take the recommended setting", mspring_network_error(clone));
    if (ok) {
        qsort(seconds, STEPS_OF_THE_PROMISE, sizeof seconds[0], compare_double);
        const double median = seconds[STEPS_OF_THE_PROMISE / 2];
        printf(
            "\nThe recommended setting was to take %.1f us a step; over %d steps it takes %.1f us (%+.1f %%), at "
            "least %.1f us (%+.1f %%).\n",
            1e6 * row->median_cost, STEPS_OF_THE_PROMISE, 1e6 * median, 100 * (median / row->median_cost - 1),
            1e6 * seconds[0], 100 * (seconds[0] / row->min_cost - 1));
    }
    mspring_network_destroy(clone);
    return ok;
}

static bool measure_errors(const subject *about, const options *how, mspring_network *network, cloud *errors) {
    mspring_tune_def def = mspring_tune_def_default();
    mspring_tune_row rows[MOST_ROWS];
    uint32_t count = 0;
    def.dt = dt;
    def.budget = how->budget;
    def.flags = about->stiffer > 0 ? 0 : MSPRING_TUNE_NOTHING_ELSE;
    if (!tune(network, how, &def, rows, &count))
        return false;
    print_rows(about, rows, count);
    collect_errors(rows, count, errors);
    for (uint32_t i = 0; i < count; i++)
        if (rows[i].flags & MSPRING_TUNE_RECOMMENDED)
            return check_promise(network, how, &rows[i]);
    printf("\nNothing is recommended: no setting was measured that errs by less than %g %%.\n",
           100 * def.max_error);
    return true;
}

/* ----------------------------------------------------------------------------------------------------- bending */

// One setting of each solver: explicit with the least substeps, implicit with eight iterations, direct where it
// pays.
static uint32_t list_solvers(mspring_network *network, mspring_settings *settings) {
    uint32_t count = 0, substeps = 0;
    if (mspring_network_suggest_substeps(network, dt, 0.9, &substeps) == MSPRING_OK && substeps <= 2000) {
        settings[count] = mspring_settings_default();
        settings[count++].substeps = substeps;
    }
    settings[count] = mspring_settings_default();
    settings[count].iterations = 8;
    settings[count].residual = 0;
    settings[count++].solver = MSPRING_SOLVER_IMPLICIT;
    if (mspring_network_count(network, MSPRING_PARTICLES) <= 20000) {
        settings[count] = mspring_settings_default();
        settings[count++].solver = MSPRING_SOLVER_DIRECT;
    }
    return count;
}

static bool make_stiffer(mspring_network *network) {
    const uint32_t springs = mspring_network_count(network, MSPRING_SPRINGS);
    float *stiffness = malloc((springs + 1) * sizeof *stiffness);
    bool ok =
        stiffness && mspring_network_get(network, MSPRING_STIFFNESS, NULL, 0, springs, stiffness, 1) == MSPRING_OK;
    for (uint32_t s = 0; ok && s < springs; s++)
        stiffness[s] *= 4;
    ok = ok && mspring_network_set(network, MSPRING_STIFFNESS, NULL, 0, springs, stiffness, 1) == MSPRING_OK;
    free(stiffness);
    return ok;
}

static bool measure_bending(const subject *about, const options *how, mspring_network *network, cloud *bending) {
    mspring_settings settings[SOLVERS];
    mspring_tune_row rows[MOST_ROWS];
    mspring_tune_def def = mspring_tune_def_default();
    def.dt = dt;
    def.budget = how->budget;
    def.measure = MSPRING_TUNE_BY_BENDING;
    def.flags = MSPRING_TUNE_NOTHING_ELSE;
    def.settings = settings;
    printf("\n%12s %12s %-9s %8s %11s\n", "stiffness", "bending, m", "solver", "substeps", "a step, us");
    for (int i = 0; i <= about->stiffer; i++) {
        def.setting_count = list_solvers(network, settings);
        if (!tune(network, how, &def, rows, &def.setting_count))
            return false;
        for (uint32_t r = 0; r < def.setting_count; r++) {
            char label[32] = "";
            if (!(rows[r].flags & MSPRING_TUNE_HAS_REST))
                continue;
            printf("%12.0f %12.4g %-9s %8u %11.1f\n", pow(4, i), rows[r].bending,
                   solver_names[rows[r].settings.solver], rows[r].settings.substeps, 1e6 * rows[r].median_cost);
            if (rows[r].settings.solver == MSPRING_SOLVER_EXPLICIT)
                snprintf(label, sizeof label, "%u", rows[r].settings.substeps);
            add_point(bending, rows[r].settings.solver, 1e6 * rows[r].median_cost, rows[r].bending, label, false);
        }
        if (!make_stiffer(network))
            return false;
    }
    find_front(bending);
    return true;
}

/* ------------------------------------------------------------------------------------------------------- crash */

// Let go of the pinned column, throw it all at a slope, and let springs break at a strain of 1 %.
static bool throw_at_slope(mspring_network *network, uint32_t columns, uint32_t rows) {
    const double slope[4] = {0, -3, 0.1, 1};
    const float one = 1, still = 0, down = -10, strain = 0.01f;
    mspring_floor_def floor = mspring_floor_def_default();
    floor.planes = slope, floor.plane_count = 1, floor.friction = 0.3f, floor.restitution = 0.2f;
    const uint32_t particles = columns * rows, springs = mspring_network_count(network, MSPRING_SPRINGS);
    mspring_result result = mspring_network_set_floor(network, &floor);
    if (result == MSPRING_OK)
        result = mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, 0, particles, &one, 0);
    if (result == MSPRING_OK)
        result = mspring_network_set_velocities(network, NULL, 0, particles, &still, &down, 0);
    if (result == MSPRING_OK)
        result = mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, springs, &strain, 0);
    return check(result, "throw the lattice", mspring_network_error(network));
}

static void print_quantities(const double *mean, const double *spread) {
    printf(" %8.1f +- %4.1f %8.1f +- %4.1f %8.2f +- %4.2f", mean[MSPRING_TUNE_BROKEN], spread[MSPRING_TUNE_BROKEN],
           1e-3 * mean[MSPRING_TUNE_ENERGY], 1e-3 * spread[MSPRING_TUNE_ENERGY], mean[MSPRING_TUNE_EXTENT],
           spread[MSPRING_TUNE_EXTENT]);
}

static void print_crash(const subject *about, const mspring_tune_scene *crash, const mspring_tune_row *rows,
                        uint32_t count) {
    printf("\n%s, steps of 1/64 s, %g s\n\n%-15s %8s %10s %11s %6s %16s %16s %16s %9s\n", about->title,
           crash->duration, "solver", "substeps", "residual", "mean, us", "starts", "broken", "energy, kJ",
           "extent, m", "distance");
    bool told = false;
    for (uint32_t i = 0; i < count; i++) {
        char residual[16] = "";
        const mspring_tune_row *row = &rows[i];
        if (!(row->flags & MSPRING_TUNE_HAS_SCENE))
            continue;
        if (row->settings.solver == MSPRING_SOLVER_IMPLICIT)
            snprintf(residual, sizeof residual, "%g", (double)row->settings.residual);
        if (!told) {
            told = true;
            printf("%-15s %8u %10s %11s %6u", "the fine run", row->fine_substeps, "", "", row->scene_starts);
            print_quantities(row->fine_mean, row->fine_spread);
            printf("\n");
        }
        printf("%-9s %-5s %8u %10s %11.1f %6u", solver_names[row->settings.solver],
               row->settings.solver != MSPRING_SOLVER_EXPLICIT &&
                       row->settings.integrator == MSPRING_INTEGRATOR_BDF2
                   ? "BDF2"
                   : "",
               row->settings.substeps, residual, 1e6 * row->scene_cost, row->scene_starts);
        print_quantities(row->scene_mean, row->scene_spread);
        printf(" %9.2f  %s%s\n", row->scene_distance, row->flags & MSPRING_TUNE_PARETO ? "front" : "",
               row->flags & MSPRING_TUNE_RECOMMENDED ? ", recommended" : "");
    }
}

static bool measure_crash(const subject *about, const options *how, mspring_network *network, cloud *distances) {
    char label[32];
    mspring_tune_scene crash = mspring_tune_scene_default();
    mspring_tune_def def = mspring_tune_def_default();
    mspring_tune_row rows[MOST_ROWS];
    uint32_t count = 0;
    def.dt = dt;
    def.budget = how->budget;
    def.scene = &crash;
    def.measure = MSPRING_TUNE_BY_SCENE;
    def.flags = MSPRING_TUNE_NOTHING_ELSE;
    if (!throw_at_slope(network, about->columns, about->rows) || !tune(network, how, &def, rows, &count))
        return false;
    print_crash(about, &crash, rows, count);
    for (uint32_t i = 0; i < count; i++) {
        if (!(rows[i].flags & MSPRING_TUNE_HAS_SCENE))
            continue;
        print_label(label, sizeof label, &rows[i]);
        add_point(distances, rows[i].settings.solver, 1e6 * rows[i].scene_cost, rows[i].scene_distance, label,
                  rows[i].flags & MSPRING_TUNE_RECOMMENDED);
    }
    find_front(distances);
    return true;
}

/* ----------------------------------------------------------------------------------------------------- drawing */

static void draw_cloud(figure *target, const cloud *drawn, const char *title, const char *x_label,
                       const char *y_label, bool percent, double left) {
    scatter_series series[SOLVERS];
    size_t count = 0;
    for (int s = 0; s < SOLVERS; s++) {
        series[count] = (scatter_series){.points = drawn->points[s],
                                         .count = drawn->counts[s],
                                         .mark = solver_marks[s],
                                         .colour = solver_colours[s],
                                         .labels_below = s == MSPRING_SOLVER_EXPLICIT,
                                         .name = solver_names[s]};
        count += drawn->counts[s] > 0;
    }
    const scatter plot = {.title = title,
                          .x_label = x_label,
                          .y_label = y_label,
                          .series = series,
                          .series_count = count,
                          .front = drawn->front,
                          .front_count = drawn->front_count,
                          .percent = percent};
    scatter_draw(target, &plot, left, 0, 560, 460);
}

static bool draw(const subject *about, const options *how, const cloud *errors, const cloud *bending) {
    char name[64];
    figure picture;
    const char *cost = "a step of 1/64 s takes, microseconds";
    snprintf(name, sizeof name, "07_tune_%s", about->name);
    figure_start(&picture, about->stiffer > 0 ? 1120 : 560, 460, 0xffffff);
    if (about->crashes)
        draw_cloud(&picture, errors, about->title, cost, "distance from the fine run, in its spreads", false, 0);
    else
        draw_cloud(&picture, errors, about->title, cost, "error of positions, as a share of the largest motion",
                   true, 0);
    if (about->stiffer > 0)
        draw_cloud(&picture, bending, "The same, made stiffer and stiffer", cost, "bending at rest, m", false, 560);
    const bool ok = output_figure(&picture, how->folder, name);
    figure_free(&picture);
    return ok;
}

/* ------------------------------------------------------------------------------------------------ the subjects */

static bool make_scene(const subject *about, const options *how, scene *made, scene_error *error) {
    char image[OUTPUT_PATH_SIZE], table[OUTPUT_PATH_SIZE];
    if (about->columns > 0) {
        const scene_options as_iron = scene_options_default();
        return scene_bar(about->columns, about->rows, &as_iron, made, error);
    }
    const scene_options as_file = scene_options_from_file();
    scene_materials materials = {0};
    bool ok = output_path(image, how->images, about->name, ".png") &&
              output_path(table, how->images, about->name, "_materials.csv") &&
              scene_materials_read(table, &materials, error) &&
              scene_image(image, &materials, &as_file, made, error);
    scene_materials_free(&materials);
    return ok;
}

static bool show(const subject *about, const options *how) {
    static cloud errors, bending;
    scene made;
    scene_error error = {""};
    memset(&errors, 0, sizeof errors);
    memset(&bending, 0, sizeof bending);
    if (!make_scene(about, how, &made, &error)) {
        fprintf(stderr, "%s\n", error.text);
        return false;
    }
    mspring_network *network = NULL;
    const mspring_result result = mspring_network_create(made.builder, NULL, &network);
    const bool ok = check(result, "make the network", mspring_builder_error(made.builder)) &&
                    (about->crashes ? measure_crash(about, how, network, &errors)
                                    : measure_errors(about, how, network, &errors)) &&
                    (about->stiffer == 0 || measure_bending(about, how, network, &bending)) &&
                    draw(about, how, &errors, &bending);
    mspring_network_destroy(network);
    scene_free(&made);
    return ok;
}

static int print_help(const char *program, int exit_code) {
    printf("07_tune: what speed costs in accuracy, for three bars, a crash and, if --images is given, our ship.\n\n"
           "usage: %s [--out FOLDER] [--images FOLDER] [--only NAME] [--budget SECONDS] [--clock wall|cpu]\n\n"
           "  --out FOLDER      where pictures go (default: out)\n"
           "  --images FOLDER   where ship.png and ship_materials.csv are, such as examples/data\n"
           "  --only NAME       bar_80x5, bar_544x68, bar_1800x5, ship or crash\n"
           "  --budget SECONDS  for each table (default: 60)\n"
           "  --clock cpu       time that the processor gave, where others have it, too (default: wall)\n",
           program);
    return exit_code;
}

int main(int count, char **arguments) {
    options how = {.folder = "out", .budget = 60, .clock = clock_seconds};
    for (int i = 1; i < count; i += 2) {
        const char *value = i + 1 < count ? arguments[i + 1] : NULL;
        if (strcmp(arguments[i], "--help") == 0)
            return print_help(arguments[0], EXIT_SUCCESS);
        if (value && strcmp(arguments[i], "--out") == 0)
            how.folder = value;
        else if (value && strcmp(arguments[i], "--images") == 0)
            how.images = value;
        else if (value && strcmp(arguments[i], "--only") == 0)
            how.only = value;
        else if (value && strcmp(arguments[i], "--budget") == 0 && strtod(value, NULL) > 0)
            how.budget = strtod(value, NULL);
        else if (value && strcmp(arguments[i], "--clock") == 0 && strcmp(value, "cpu") == 0)
            how.clock = clock_processor_seconds;
        else if (value && strcmp(arguments[i], "--clock") == 0 && strcmp(value, "wall") == 0)
            how.clock = clock_seconds;
        else
            return print_help(arguments[0], 2);
    }
    setvbuf(stdout, NULL, _IONBF, 0);
    if (!output_make_folder(how.folder))
        return EXIT_FAILURE;
    for (size_t i = 0; i < sizeof subjects / sizeof subjects[0]; i++) {
        if (how.only ? strcmp(how.only, subjects[i].name) != 0 : subjects[i].columns == 0 && !how.images)
            continue;
        if (!show(&subjects[i], &how))
            return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}

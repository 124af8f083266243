/// @file plot.c
/// massspring-plot: how the time of a spring grows with the network, from the bench's CSV; see README.md.
///
/// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>

#include <massspring/massspring.h>

#include "draw/scatter.h"
#include "speeds.h"

enum { LEVELS = MSPRING_SIMD_WASM + 1, MOST_WORKER_COUNTS = 3, MOST_SERIES = 1 + LEVELS * MOST_WORKER_COUNTS };

static const draw_colour paper = 0xffffff, naive_colour = 0x8b8d98;

/// By level; neighbours differ in lightness, too.
static const draw_colour level_colours[LEVELS] = {
    [MSPRING_SIMD_AUTO] = 0x26262e, [MSPRING_SIMD_SCALAR] = 0xc0392b, [MSPRING_SIMD_SSE2] = 0xe07b10,
    [MSPRING_SIMD_AVX2] = 0x2f7fd6, [MSPRING_SIMD_AVX512] = 0x1b3a8f, [MSPRING_SIMD_NEON] = 0x2f7fd6,
    [MSPRING_SIMD_WASM] = 0x2f7fd6,
};

/// By the number of workers, in the order in which these come.
static const scatter_mark worker_marks[MOST_WORKER_COUNTS] = {SCATTER_DISC, SCATTER_SQUARE, SCATTER_DIAMOND};

/// The curves, whose points lie one after the other.
typedef struct curves {
    scatter_point points[2 * SPEEDS_MOST];
    size_t point_count;
    scatter_series series[MOST_SERIES];
    char names[MOST_SERIES][40];
    size_t series_count;
} curves;

static int compare_uint(uint32_t a, uint32_t b) {
    return (a > b) - (a < b);
}

static int compare_double(double a, double b) {
    return (a > b) - (a < b);
}

/// By level, workers, springs.
static int compare_rows(const void *a, const void *b) {
    const speed *first = a, *second = b;
    int order = compare_uint(first->level, second->level);
    order = order != 0 ? order : compare_uint(first->workers, second->workers);
    order = order != 0 ? order : compare_double(first->springs, second->springs);
    return order != 0 ? order : compare_double(first->ns, second->ns);
}

/// By springs, then the naive step's time.
static int compare_naive(const void *a, const void *b) {
    const speed *first = a, *second = b;
    int order = compare_double(first->springs, second->springs);
    return order != 0 ? order : compare_double(first->naive_ns, second->naive_ns);
}

static void add_point(curves *to, double springs, double ns) {
    to->points[to->point_count++] = (scatter_point){.x = springs, .y = ns};
    to->series[to->series_count - 1].count++;
}

/// Start a series; its name is written by the caller.
static char *add_series(curves *to, scatter_mark mark, draw_colour colour) {
    char *name = to->names[to->series_count];
    to->series[to->series_count++] = (scatter_series){
        .points = &to->points[to->point_count], .mark = mark, .colour = colour, .name = name, .joined = true};
    return name;
}

/// The naive step is measured beside each level: of networks of one size the median counts.
static void add_naive(curves *to, speeds *all) {
    qsort(all->rows, all->count, sizeof *all->rows, compare_naive);
    snprintf(add_series(to, SCATTER_NO_MARK, naive_colour), sizeof to->names[0], "naive step, 1 worker");
    for (size_t i = 0, next = 0; i < all->count; i = next) {
        while (next < all->count && all->rows[next].springs == all->rows[i].springs) {
            next++;
        }
        const double low = all->rows[(i + next - 1) / 2].naive_ns, high = all->rows[(i + next) / 2].naive_ns;
        add_point(to, all->rows[i].springs, (low + high) / 2);
    }
}

/// Which of the numbers of workers, as they come, this is; adds one that is not there. Returns
/// MOST_WORKER_COUNTS if it has no place.
static int find_workers(uint32_t *counts, int *known, uint32_t workers) {
    int place = 0;
    while (place < *known && counts[place] != workers) {
        place++;
    }
    if (place == *known && *known < MOST_WORKER_COUNTS) {
        counts[(*known)++] = workers;
    }
    return place;
}

static bool add_levels(curves *to, speeds *all, const char *path, scene_error *error) {
    uint32_t counts[MOST_WORKER_COUNTS];
    int known = 0;
    qsort(all->rows, all->count, sizeof *all->rows, compare_rows);
    for (size_t i = 0; i < all->count; i++) {
        const speed *row = &all->rows[i];
        if (i == 0 || row->level != row[-1].level || row->workers != row[-1].workers) {
            int place = find_workers(counts, &known, row->workers);
            if (place == MOST_WORKER_COUNTS) {
                snprintf(error->text, sizeof error->text,
                         "%.200s:%lu: a fourth number of workers, %u: marks tell %d apart, draw it by itself", path,
                         row->line, row->workers, MOST_WORKER_COUNTS);
                return false;
            }
            snprintf(add_series(to, worker_marks[place], level_colours[row->level]), sizeof to->names[0],
                     "%s, %u worker%s", mspring_simd_name(row->level), row->workers, row->workers == 1 ? "" : "s");
        }
        add_point(to, row->springs, row->ns);
    }
    return true;
}

static bool draw(const curves *drawn, const char *path, const char *where, scene_error *error) {
    char title[200];
    snprintf(title, sizeof title, "Explicit steps: time of a spring in a substep%s%.120s", where ? ", " : "",
             where ? where : "");
    const scatter plot = {.title = title,
                          .x_label = "springs of the network",
                          .y_label = "nanoseconds per spring and substep (median)",
                          .series = drawn->series,
                          .series_count = drawn->series_count};
    figure picture;
    figure_start(&picture, 800, 520, paper);
    scatter_draw(&picture, &plot, 0, 0, 800, 520);
    draw_error failed;
    const bool ok = figure_write_svg(&picture, path, &failed);
    if (!ok) {
        snprintf(error->text, sizeof error->text, "%s", failed.text);
    }
    figure_free(&picture);
    return ok;
}

int main(int count, char **arguments) {
    static speeds all;
    static curves drawn;
    scene_error error;
    if (count < 3 || count > 4) {
        fputs(
            "massspring-plot SPEEDS.csv PICTURE.svg [MACHINE]: draw what massspring-bench --csv has measured; the "
            "title ends in MACHINE\n",
            stderr);
        return 2;
    }
    bool ok = speeds_read(arguments[1], &all, &error);
    if (ok) {
        add_naive(&drawn, &all);
        ok = add_levels(&drawn, &all, arguments[1], &error) && draw(&drawn, arguments[2], arguments[3], &error);
    }
    if (!ok) {
        fprintf(stderr, "massspring-plot: %s\n", error.text);
    }
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}

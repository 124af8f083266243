/// @file wreck.c
/// Networks of which nine springs of ten have broken, or a quarter, in one way or another.
///
/// SPDX-License-Identifier: MIT
#include "wreck.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Pieces: cells of so many metres, of which some have a whole square of so many in their middle.
#define CELL 16.0
#define PIECE 10.0

/// Blasts: smallest radius and range of radii, m.
#define SMALLEST_BLAST 3.0
#define BLAST_RANGE 10.0

/// One number of a sequence that depends on index alone.
static uint32_t scatter(uint32_t index) {
    uint32_t bits = (index + 1u) * 2654435769u;
    bits = (bits ^ (bits >> 16)) * 2246822519u;
    bits = (bits ^ (bits >> 13)) * 3266489917u;
    return bits ^ (bits >> 16);
}

const char *bench_wreck_name(bench_wreck kind) {
    static const char *const names[] = {"a wreck in pieces", "a wreck of blasts", "a shattered wreck",
                                        "a quarter blown off"};
    return names[kind];
}

/// Whether a point is in the square in the middle of its cell, and that is one of those that are left: one more for
/// each step of share, in 4096.
static bool is_in_piece(double x, double y, uint32_t share) {
    const double column = floor(x / CELL), row = floor(y / CELL), margin = 0.5 * (CELL - PIECE);
    const double dx = x - column * CELL, dy = y - row * CELL;
    const bool inside = dx >= margin && dx < CELL - margin && dy >= margin && dy < CELL - margin;
    return inside && scatter((uint32_t)(int32_t)column * 7919u + (uint32_t)(int32_t)row) % 4096 < share;
}

/// Ends of all springs, and which have broken.
typedef struct wreckage {
    mspring_id *a, *b, *broken;
    bool *is_broken;
    uint32_t count;
} wreckage;

static void break_spring(wreckage *all, mspring_id s) {
    if (!all->is_broken[s]) {
        all->is_broken[s] = true;
        all->broken[all->count++] = s;
    }
}

static void break_all_but_pieces(const bench_network *n, wreckage *all) {
    const double *x = n->start_x, *y = n->start_y;
    uint32_t share = 0, left = 0;
    while (share < 4096 && left < n->spring_count / 10) {
        share += 16;
        left = 0;
        for (mspring_id s = 0; s < n->spring_count; s++) {
            const mspring_id a = all->a[s], b = all->b[s];
            left += is_in_piece(x[a], y[a], share) && is_in_piece(x[b], y[b], share) &&
                    floor(x[a] / CELL) == floor(x[b] / CELL);
        }
    }
    for (mspring_id s = 0; s < n->spring_count; s++) {
        const mspring_id a = all->a[s], b = all->b[s];
        if (!is_in_piece(x[a], y[a], share) || !is_in_piece(x[b], y[b], share)) {
            break_spring(all, s);
        }
    }
}

/// Until so many springs have broken.
static void blast(const bench_network *n, wreckage *all, uint32_t most) {
    const double *x = n->start_x, *y = n->start_y;
    for (uint32_t i = 0; all->count < most; i++) {
        const mspring_id centre = scatter(2 * i) % n->particle_count;
        const double radius = SMALLEST_BLAST + BLAST_RANGE * (double)scatter(2 * i + 1) / 4294967296.0;
        for (mspring_id s = 0; s < n->spring_count; s++) {
            if (hypot(x[all->a[s]] - x[centre], y[all->a[s]] - y[centre]) < radius) {
                break_spring(all, s);
            }
        }
    }
}

static bool list_ends(const bench_network *n, wreckage *all, scene_error *error) {
    all->a = bench_allocate(n->spring_count, sizeof *all->a, error);
    all->b = bench_allocate(n->spring_count, sizeof *all->b, error);
    all->broken = bench_allocate(n->spring_count, sizeof *all->broken, error);
    all->is_broken = bench_allocate(n->spring_count, sizeof *all->is_broken, error);
    if (all->a == NULL || all->b == NULL || all->broken == NULL || all->is_broken == NULL) {
        return false;
    }
    memset(all->is_broken, 0, n->spring_count * sizeof *all->is_broken);
    return mspring_network_get_columns(
               n->network, NULL, 0, n->spring_count,
               (const mspring_column[]){{MSPRING_END_A, 1, all->a}, {MSPRING_END_B, 1, all->b}}, 2) == MSPRING_OK;
}

static bool break_all(const bench_network *network, const wreckage *all, scene_error *error) {
    mspring_result result = mspring_network_break_springs(network->network, all->broken, 0, all->count);
    if (result != MSPRING_OK) {
        bench_library_error(error, "making a wreck", result, mspring_network_error(network->network));
    }
    return result == MSPRING_OK;
}

static void free_wreckage(wreckage *all) {
    free(all->a);
    free(all->b);
    free(all->broken);
    free(all->is_broken);
}

bool bench_wreck_make(const bench_network *network, bench_wreck kind, scene_error *error) {
    wreckage all = {0};
    bool ok = list_ends(network, &all, error);
    if (ok && kind == BENCH_WRECK_PIECES) {
        break_all_but_pieces(network, &all);
    } else if (ok && kind == BENCH_WRECK_BLASTS) {
        blast(network, &all, network->spring_count - network->spring_count / 10);
    } else if (ok && kind == BENCH_WRECK_QUARTER) {
        blast(network, &all, network->spring_count / 4);
    }
    for (mspring_id s = 0; ok && kind == BENCH_WRECK_SHATTERED && s < network->spring_count; s++) {
        if (scatter(s) % 10 != 0) {
            break_spring(&all, s);
        }
    }
    ok = ok && break_all(network, &all, error);
    free_wreckage(&all);
    return ok;
}

static int compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

bool bench_wreck_slice(const bench_network *network, uint32_t parts, mspring_id *first, scene_error *error) {
    wreckage all = {0};
    double *sorted = bench_allocate(network->particle_count, sizeof *sorted, error);
    bool ok = sorted != NULL && list_ends(network, &all, error);
    if (ok) {
        for (mspring_id p = 0; p < network->particle_count; p++) {
            sorted[p] = network->start_x[p];
        }
        qsort(sorted, network->particle_count, sizeof *sorted, compare_doubles);
        for (*first = 0; network->start_x[*first] > sorted[0];) {
            ++*first;
        }
    }
    for (uint32_t part = 1; ok && part < parts; part++) {
        const double cut = sorted[(uint64_t)network->particle_count * part / parts];
        for (mspring_id s = 0; s < network->spring_count; s++) {
            if ((network->start_x[all.a[s]] < cut) != (network->start_x[all.b[s]] < cut)) {
                break_spring(&all, s);
            }
        }
    }
    ok = ok && break_all(network, &all, error);
    free_wreckage(&all);
    free(sorted);
    return ok;
}

/// @file roofline.c
/// The bounds of this machine, measured, and how near to them each scene comes.
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL // for mspring_network_describe()
#include <massspring/massspring.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/described.h"
#include "machine.h"
#include "modes.h"
#include "roofline_kernels.h"

/// What one spring and one particle cost at least, in vector additions and multiplications for a vector of them.
/// Spring: d (2), |d|^2 (3), u (2), k L - k rest (2), force along u (2), sums at both ends (4). Its damper:
/// velocity difference (2), along u (3), times c (1), sum (1). Particle: velocity (4), its decay (2), position (4).
#define SPRING_OPERATIONS 15.0
#define DAMPER_OPERATIONS 7.0
#define PARTICLE_OPERATIONS 10.0

/// Bytes moved in a sweep: of a spring k, k rest and c (read), but where lattices read one record for many; of a
/// particle mass and constant force (read), position and velocity (read and written).
#define SPRING_BYTES 8.0
#define DAMPER_BYTES 4.0
#define PARTICLE_BYTES (12.0 + 16.0 + 16.0)

/// A bound is the best of so many runs of at least so long (s).
#define BOUND_RUNS 7
#define BOUND_SECONDS 0.01

enum { PLACE_COUNT = 4 };
static const char *const place_names[PLACE_COUNT] = {"L1", "L2", "L3", "DRAM"};

typedef struct bounds {
    mspring_simd level;
    double lanes;
    double operation;         ///< s for one vector addition or multiplication
    double pair;              ///< s for one vector square root and division
    double byte[PLACE_COUNT]; ///< s for one byte, read or written, in each place
} bounds;

typedef struct all_bounds {
    bounds items[4];
    int count;
} all_bounds;

static const roofline_kernels *kernels_of(mspring_simd level) {
#ifdef BENCH_X86
    switch (level) {
    case MSPRING_SIMD_SSE2:
        return &bench_roofline_sse2;
    case MSPRING_SIMD_AVX2:
        return &bench_roofline_avx2;
    case MSPRING_SIMD_AVX512:
        return &bench_roofline_avx512;
    default:
        break;
    }
#elif defined(BENCH_AARCH64)
    if (level == MSPRING_SIMD_NEON) {
        return &bench_roofline_neon;
    }
#endif
    (void)level;
    return &bench_roofline_scalar;
}

/// Seconds for one round of a loop.
static double time_rounds(void (*loop)(uint64_t rounds, float *sink)) {
    _Alignas(64) float sink[16];
    uint64_t rounds = 1000;
    double best = HUGE_VAL;
    for (int run = 0; run < BOUND_RUNS;) {
        double start = bench_seconds();
        loop(rounds, sink);
        double seconds = bench_seconds() - start;
        if (seconds < BOUND_SECONDS) {
            rounds *= 2;
            continue;
        }
        best = fmin(best, seconds / (double)rounds);
        run++;
    }
    return best;
}

/// Bytes that a sweep over so much of a place keeps within it: half of a cache, or several times the last one.
static size_t bytes_within(int place) {
    return place < PLACE_COUNT - 1 ? bench_cache_size(place + 1) / 2 : 4 * bench_cache_size(PLACE_COUNT - 1);
}

/// Seconds for a byte of a sweep within a place.
static bool time_sweep(const roofline_kernels *kernels, int place, double *out, scene_error *error) {
    const size_t particle_bytes = (ROOFLINE_PARAMETERS + ROOFLINE_STATE) * sizeof(float);
    size_t count = bytes_within(place) / particle_bytes / 16 * 16;
    float *parameters = bench_allocate(ROOFLINE_PARAMETERS * count, sizeof *parameters, error);
    float *state = bench_allocate(ROOFLINE_STATE * count, sizeof *state, error);
    bool ok = parameters != NULL && state != NULL;
    if (ok) {
        for (size_t i = 0; i < ROOFLINE_PARAMETERS * count; i++) {
            parameters[i] = 1e-6f;
        }
        for (size_t i = 0; i < ROOFLINE_STATE * count; i++) {
            state[i] = 1.0f;
        }
        uint64_t sweeps = 1;
        double best = HUGE_VAL;
        for (int run = 0; run < BOUND_RUNS;) {
            double start = bench_seconds();
            for (uint64_t i = 0; i < sweeps; i++) {
                kernels->sweep(parameters, state, count);
            }
            double seconds = bench_seconds() - start;
            if (seconds < BOUND_SECONDS) {
                sweeps *= 2;
                continue;
            }
            best = fmin(best, seconds / (double)sweeps);
            run++;
        }
        size_t moved = (particle_bytes + ROOFLINE_STATE * sizeof(float)) * count;
        *out = best / (double)moved;
    }
    free(parameters);
    free(state);
    return ok;
}

static bool measure_bounds(mspring_simd level, bounds *out, scene_error *error) {
    const roofline_kernels *kernels = kernels_of(level);
    out->level = level;
    out->lanes = kernels->lanes;
    out->operation = time_rounds(kernels->add_mul) / ROOFLINE_OPERATIONS;
    out->pair = time_rounds(kernels->sqrt_div) / ROOFLINE_PAIRS;
    for (int place = 0; place < PLACE_COUNT; place++) {
        if (!time_sweep(kernels, place, &out->byte[place], error)) {
            return false;
        }
    }
    return true;
}

static const bench_column machine_columns[] = {
    {"level", "level", -6},
    {"lanes", "lanes", 5},
    {"add_mul_ns", "add/mul ns", 10},
    {"add_mul_gflops", "Gflop/s", 8},
    {"sqrt_div_ns", "sqrt+div ns", 11},
    {"l1_gb_per_s", "L1 GB/s", 8},
    {"l2_gb_per_s", "L2 GB/s", 8},
    {"l3_gb_per_s", "L3 GB/s", 8},
    {"dram_gb_per_s", "DRAM GB/s", 9},
};

#define MACHINE_COLUMN_COUNT ((int)(sizeof machine_columns / sizeof *machine_columns))

static void print_bounds(bench_format format, const bounds *item) {
    const bench_cell cells[MACHINE_COLUMN_COUNT] = {
        bench_cell_of("%s", mspring_simd_name(item->level)),
        bench_cell_of("%.0f", item->lanes),
        bench_cell_of("%.3f", 1e9 * item->operation),
        bench_cell_of("%.1f", 1e-9 * item->lanes / item->operation),
        bench_cell_of("%.3f", 1e9 * item->pair),
        bench_cell_of("%.1f", 1e-9 / item->byte[0]),
        bench_cell_of("%.1f", 1e-9 / item->byte[1]),
        bench_cell_of("%.1f", 1e-9 / item->byte[2]),
        bench_cell_of("%.1f", 1e-9 / item->byte[3]),
    };
    bench_table_row(format, machine_columns, MACHINE_COLUMN_COUNT, cells);
}

static const bench_column scene_columns[] = {
    {"scene", "scene", -22},
    {"springs", "springs", 9},
    {"level", "level", -6},
    {"working_set_kb", "set kB", 8},
    {"place", "in", -4},
    {"arithmetic_ns", "add/mul ns", 10},
    {"sqrt_div_ns", "sqrt+div ns", 11},
    {"memory_ns", "memory ns", 9},
    {"bound", "bound", -8},
    {"ns_per_spring_substep_median", "measured ns", 11},
    {"percent_of_bound", "% of bound", 10},
};

#define SCENE_COLUMN_COUNT ((int)(sizeof scene_columns / sizeof *scene_columns))

/// What a spring and a substep take at least (ns).
typedef struct least_times {
    double arithmetic, roots, memory;
    double set; ///< bytes of the whole scene
    int place;  ///< of these
} least_times;

static least_times least_times_of(const bounds *item, const char *plan) {
    double springs = described_number(plan, "spring_count");
    double share = described_number(plan, "particle_count") / springs; /* particles for each spring */
    const bool has_damping = described_number(plan, "has_damping") > 0;
    double record = SPRING_BYTES + (has_damping ? DAMPER_BYTES : 0.0);
    double operations = SPRING_OPERATIONS + (has_damping ? DAMPER_OPERATIONS : 0.0) + PARTICLE_OPERATIONS * share;
    double bytes = record * (1 - described_number(plan, "lattice_springs") / springs) + PARTICLE_BYTES * share;
    double passes = fmax(described_number(plan, "pass_substeps"), 1); /* so many substeps share one */
    /* position and velocity are counted twice in what moves */
    least_times out = {.set = springs * (record + (PARTICLE_BYTES - 16.0) * share)};
    while (out.place < PLACE_COUNT - 1 && out.set > (double)bench_cache_size(out.place + 1)) {
        out.place++;
    }
    out.arithmetic = 1e9 * operations * item->operation / item->lanes;
    out.roots = 1e9 * item->pair / item->lanes;
    out.memory = 1e9 * bytes * fmax(item->byte[0], item->byte[out.place] / passes);
    return out;
}

static void print_scene(const bench_options *options, const bench_scene *subject, const bounds *item,
                        const bench_measurement *result, const char *plan) {
    const least_times least = least_times_of(item, plan);
    double bound = fmax(least.memory, fmax(least.arithmetic, least.roots));
    const bench_cell cells[SCENE_COLUMN_COUNT] = {
        bench_cell_of("%s", subject->label),
        bench_cell_of("%u", result->springs),
        bench_cell_of("%s", mspring_simd_name(item->level)),
        bench_cell_of("%.0f", 1e-3 * least.set),
        bench_cell_of("%s", place_names[least.place]),
        bench_cell_of("%.4f", least.arithmetic),
        bench_cell_of("%.4f", least.roots),
        bench_cell_of("%.4f", least.memory),
        bench_cell_of("%s", bound == least.memory  ? "memory"
                            : bound == least.roots ? "sqrt+div"
                                                   : "add/mul"),
        bench_cell_of("%.4f", result->ns),
        /* a bound that was measured while the machine was slower is none */
        bench_cell_of("%.1f", 100.0 * fmin(bound / result->ns, 1.0)),
    };
    bench_table_row(options->format, scene_columns, SCENE_COLUMN_COUNT, cells);
}

/// How the library lays the scene out at this level.
static bool read_plan(const bench_scene *subject, mspring_simd level, char *plan, scene_error *error) {
    bench_network network;
    if (!bench_network_create(subject->made.builder, level, 1, 1, &network, error)) {
        return false;
    }
    mspring_result result = mspring_network_describe(network.network, plan, DESCRIBED_SIZE, NULL);
    if (result != MSPRING_OK) {
        bench_library_error(error, "asking for the plan", result, "");
    }
    bench_network_free(&network);
    return result == MSPRING_OK;
}

static bool visit(const bench_scene *subject, const bench_options *options, void *user) {
    const all_bounds *all = user;
    scene_error error;
    for (int i = 0; i < all->count; i++) {
        bench_measurement result;
        char plan[DESCRIBED_SIZE];
        if (!read_plan(subject, all->items[i].level, plan, &error) ||
            !bench_measure(subject, options, all->items[i].level, &result, &error)) {
            bench_complain(subject->label, &error);
            return false;
        }
        print_scene(options, subject, &all->items[i], &result, plan);
    }
    return true;
}

static const char *const default_scenes[] = {"bar_80x5",  "grid_96x96",   "bar_544x68",     "ship", "ship_ropes_40",
                                             "rope_1000", "graph_100000", "grid_1581x1581", NULL};

bool bench_run_roofline(const bench_options *options) {
    mspring_simd levels[4];
    scene_error error;
    all_bounds all = {.count = bench_options_levels(options, levels, &error)};
    bench_table_preamble(options->format);
    bench_table_head(options->format, machine_columns, MACHINE_COLUMN_COUNT);
    for (int i = 0; i < all.count; i++) {
        if (!measure_bounds(levels[i], &all.items[i], &error)) {
            bench_complain("roofline", &error);
            return false;
        }
        print_bounds(options->format, &all.items[i]);
    }
    putchar('\n');
    bench_table_head(options->format, scene_columns, SCENE_COLUMN_COUNT);
    return bench_for_each_scene(options, default_scenes, visit, &all);
}

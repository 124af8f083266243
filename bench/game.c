/// @file game.c
/// A whole frame of a game: what it writes before a step and reads after it, timed call by call, next to steps of
/// the same network without any of that. Then frames in which things happen, next to the others.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "machine.h"
#include "modes.h"

#include <massspring/massspring.h>

/// Springs whose stiffness the host compares in each frame, and those of a blast.
#define COMPARED 11000u
#define BURST 1000u

/// Particles that are pinned and released, and in how many ranges forces are given.
enum { PINS = 64, RANGES = 8, EVENTS = 4096 };

/// Frames of a run, and of which the least time counts; what happens in some of them.
enum { FRAMES = 120, RUNS = 3, BREAK_AT = 30, RESTORE_AT = 60, BLAST_AT = 90 };

/// Break strain that none reaches, and stress strain of each 64th spring, which some do.
#define OUT_OF_REACH 1e6f
#define REACHED 2e-4f

/// m below the network, and m from one height of the floor to the next.
#define DEPTH 500.0
#define SPACING 10.0
#define HEIGHTS 128u

typedef struct game {
    bench_network network;
    float *forces, *positions, *velocities; ///< [particles][2]
    float *masses;                          ///< [particles]
    float *thresholds;                      ///< [springs]
    float *given, *stiffnesses;             ///< [compared] at first, and in a frame
    mspring_id *list;                       ///< [compared] scattered
    mspring_id *near;                       ///< [burst] from the middle id on
    mspring_event *events;                  ///< [EVENTS]
    uint32_t compared, burst, frame;
} game;

/* ------------------------------------------------------------------------------------------------ calls of a frame
 */

static mspring_result give_forces(game *g) {
    const uint32_t count = g->network.particle_count;
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; result == MSPRING_OK && i < RANGES; i++) {
        const uint32_t first = count / RANGES * i, end = i + 1 < RANGES ? count / RANGES * (i + 1) : count;
        result = mspring_network_apply_forces(g->network.network, MSPRING_PUSH_STEP, NULL, first, end - first,
                                              g->forces + 2 * (size_t)first, g->forces + 2 * (size_t)first + 1, 2);
    }
    return result;
}

static mspring_result set_masses(game *g) {
    return mspring_network_set(g->network.network, MSPRING_MASS, NULL, 0, g->network.particle_count, g->masses, 1);
}

/// Pinned in every other eight frames.
static mspring_result set_pins(game *g) {
    const float scale = g->frame / 8 % 2 == 0 ? 1.0f : 0.0f;
    return mspring_network_set(g->network.network, MSPRING_INVERSE_MASS_SCALE, NULL, g->network.particle_count / 2,
                               PINS, &scale, 0);
}

static mspring_result set_stiffnesses(game *g) {
    return mspring_network_set(g->network.network, MSPRING_STIFFNESS, g->list, 0, g->compared, g->stiffnesses, 1);
}

static mspring_result step(game *g) {
    return mspring_network_step(g->network.network, BENCH_DT);
}

static mspring_result read_events(game *g) {
    uint32_t count;
    return mspring_network_read_events(g->network.network, g->events, EVENTS, &count, NULL);
}

static mspring_result get_positions(game *g) {
    return mspring_network_get_columns(
        g->network.network, NULL, 0, g->network.particle_count,
        (const mspring_column[]){{MSPRING_X, 2, g->positions}, {MSPRING_Y, 2, g->positions + 1}}, 2);
}

static mspring_result get_velocities(game *g) {
    return mspring_network_get_velocities(g->network.network, NULL, 0, g->network.particle_count, g->velocities,
                                          g->velocities + 1, 2);
}

static const struct {
    const char *name;
    mspring_result (*call)(game *g);
} calls[] = {{"forces, in 8 ranges", give_forces},
             {"masses", set_masses},
             {"64 pins", set_pins},
             {"stiffness of 11,000, 1 % new", set_stiffnesses},
             {"step", step},
             {"events", read_events},
             {"positions, interleaved", get_positions},
             {"velocities, interleaved", get_velocities}};

enum { CALLS = sizeof calls / sizeof *calls, STEP = 4 };

/// What the host's own code makes of a frame: water enters a quarter of the particles, some springs soften.
static void prepare(game *g) {
    g->frame++;
    for (uint32_t i = 0; i < g->network.particle_count; i++) {
        g->forces[2 * i] = 0.5f;
        g->forces[2 * i + 1] = 0.25f * (float)(i % 4);
        g->masses[i] = 70.0f + (i / 4 % 4 == 0 ? 0.01f * (float)g->frame : 0.0f);
    }
    for (uint32_t i = 0; i < g->compared; i++) {
        g->stiffnesses[i] = i % 100 == g->frame % 100 ? 0.998f * g->given[i] : g->given[i];
    }
}

/// Take a frame. Adds the seconds of each call to those of its name.
static bool take_frame(game *g, double seconds[CALLS], scene_error *error) {
    prepare(g);
    for (int i = 0; i < CALLS; i++) {
        const double start = bench_thread_seconds();
        const mspring_result result = calls[i].call(g);
        seconds[i] += bench_thread_seconds() - start;
        if (result != MSPRING_OK) {
            bench_library_error(error, calls[i].name, result, mspring_network_error(g->network.network));
            return false;
        }
    }
    return true;
}

/* ---------------------------------------------------------------------------------------------------- the network
 */

/// Heights with a material of each part: some smooth, some rough.
static mspring_result set_floor(mspring_network *network) {
    static float heights[HEIGHTS], frictions[HEIGHTS - 1], restitutions[HEIGHTS - 1];
    mspring_body all = mspring_body_default();
    mspring_floor_def def = mspring_floor_def_default();
    const mspring_result result = mspring_network_get_body(network, NULL, 0, MSPRING_ALL, &all);
    if (result != MSPRING_OK) {
        return result;
    }
    for (uint32_t i = 0; i < HEIGHTS; i++) {
        heights[i] = 5.0f * (float)(i * 7u % 5u);
    }
    for (uint32_t i = 0; i + 1 < HEIGHTS; i++) {
        frictions[i] = 0.2f + 0.1f * (float)(i % 5);
        restitutions[i] = 0.1f * (float)(i % 3);
    }
    def.heights = heights;
    def.height_count = HEIGHTS;
    def.heights_x = 0.5 * (all.min_x + all.max_x) - 0.5 * SPACING * HEIGHTS;
    def.heights_y = all.min_y - DEPTH;
    def.spacing = SPACING;
    def.height_frictions = frictions;
    def.height_restitutions = restitutions;
    return mspring_network_set_floor(network, &def);
}

/// Copy the ship with the coefficients that the game gives its springs, N/m and N s/m: they do not follow the masses of
/// the water in it, as those of relative springs would.
static mspring_result copy_absolute(mspring_builder *from, uint32_t substeps, mspring_builder *to) {
    const uint32_t particles = mspring_builder_count(from, MSPRING_PARTICLES);
    const uint32_t springs = mspring_builder_count(from, MSPRING_SPRINGS);
    const double rate = substeps / BENCH_DT;
    for (mspring_id p = 0; p < particles; p++) {
        mspring_particle_def def = mspring_particle_def_default();
        (void)mspring_builder_get_particles(from, NULL, p, 1, &def);
        (void)mspring_builder_add_particles(to, &def, 1, NULL);
    }
    for (mspring_id s = 0; s < springs; s++) {
        mspring_spring_def def = mspring_spring_def_default();
        mspring_particle_def a = mspring_particle_def_default(), b = mspring_particle_def_default();
        (void)mspring_builder_get_springs(from, NULL, s, 1, &def);
        (void)mspring_builder_get_particles(from, NULL, def.a, 1, &a);
        (void)mspring_builder_get_particles(from, NULL, def.b, 1, &b);
        const double reduced_mass = 1.0 / (1.0 / (double)a.mass + 1.0 / (double)b.mass);
        if (def.flags & MSPRING_SPRING_RELATIVE) {
            def.stiffness = (float)((double)def.stiffness * reduced_mass * rate * rate);
            def.damping = (float)((double)def.damping * reduced_mass * rate);
            def.flags &= ~(uint32_t)MSPRING_SPRING_RELATIVE;
        }
        (void)mspring_builder_add_springs(to, &def, 1, NULL);
    }
    return mspring_builder_error(to)[0] != '\0' ? MSPRING_ERROR_MEMORY : MSPRING_OK;
}

static bool allocate(game *g, scene_error *error) {
    const uint32_t particles = g->network.particle_count, springs = g->network.spring_count;
    g->compared = springs < COMPARED ? springs : COMPARED;
    g->burst = springs < BURST ? springs : BURST;
    g->forces = bench_allocate(particles, 2 * sizeof *g->forces, error);
    g->positions = bench_allocate(particles, 2 * sizeof *g->positions, error);
    g->velocities = bench_allocate(particles, 2 * sizeof *g->velocities, error);
    g->masses = bench_allocate(particles, sizeof *g->masses, error);
    g->thresholds = bench_allocate(springs, sizeof *g->thresholds, error);
    g->given = bench_allocate(g->compared, sizeof *g->given, error);
    g->stiffnesses = bench_allocate(g->compared, sizeof *g->stiffnesses, error);
    g->list = bench_allocate(g->compared, sizeof *g->list, error);
    g->near = bench_allocate(g->burst, sizeof *g->near, error);
    g->events = bench_allocate(EVENTS, sizeof *g->events, error);
    return g->forces && g->positions && g->velocities && g->masses && g->thresholds && g->given && g->stiffnesses &&
           g->list && g->near && g->events;
}

static void free_game(game *g) {
    free(g->forces);
    free(g->positions);
    free(g->velocities);
    free(g->masses);
    free(g->thresholds);
    free(g->stiffnesses);
    free(g->given);
    free(g->list);
    free(g->near);
    free(g->events);
    bench_network_free(&g->network);
}

static bool fill(game *g, scene_error *error) {
    const uint32_t springs = g->network.spring_count;
    mspring_network *const network = g->network.network;
    if (!allocate(g, error)) {
        return false;
    }
    for (uint32_t i = 0; i < g->compared; i++) {
        g->list[i] = (mspring_id)((uint64_t)i * springs / g->compared);
    }
    for (uint32_t i = 0; i < g->burst; i++) {
        g->near[i] = (mspring_id)((springs - g->burst) / 2 + i);
    }
    for (uint32_t i = 0; i < springs; i++) {
        g->thresholds[i] = i % 64 == 0 ? REACHED : OUT_OF_REACH;
    }
    const float never = OUT_OF_REACH;
    mspring_result result = mspring_network_reserve_events(network, EVENTS);
    if (result == MSPRING_OK) {
        result = mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, 0, springs, &never, 0);
    }
    if (result == MSPRING_OK) {
        result = mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, 0, springs, g->thresholds, 1);
    }
    if (result == MSPRING_OK) {
        result = mspring_network_get(network, MSPRING_STIFFNESS, g->list, 0, g->compared, g->given, 1);
    }
    if (result == MSPRING_OK) {
        result = set_floor(network);
    }
    if (result != MSPRING_OK) {
        bench_library_error(error, "making a game's network", result, mspring_network_error(network));
    }
    return result == MSPRING_OK;
}

/* ----------------------------------------------------------------------------------------------------- measuring
 */

static const bench_column columns[] = {
    {"scene", "scene", -12}, {"what", "what", -30},   {"springs", "springs", 8},     {"substeps", "substeps", 8},
    {"level", "level", -6},  {"us_min", "us min", 8}, {"us_median", "us median", 9}, {"share", "% of step", 9},
};

#define COLUMN_COUNT ((int)(sizeof columns / sizeof *columns))

static void print_row(const bench_options *options, const bench_scene *subject, const game *g, const char *what,
                      double least, double median, double step_median) {
    const bench_cell cells[COLUMN_COUNT] = {
        bench_cell_of("%s", subject->label),
        bench_cell_of("%s", what),
        bench_cell_of("%u", g->network.spring_count),
        bench_cell_of("%u", g->network.substeps),
        bench_cell_of("%s", mspring_simd_name(bench_level_of(g->network.network))),
        bench_cell_of("%.1f", 1e6 * least),
        bench_cell_of("%.1f", 1e6 * median),
        bench_cell_of("%.2f", 100.0 * median / step_median),
    };
    bench_table_row(options->format, columns, COLUMN_COUNT, cells);
}

/// Calm frames in turn with steps of a plain network: a row for each call, one for what the step itself takes
/// longer, and one for all but the plain step.
static bool measure_calls(game *g, bench_network *plain, const bench_options *options, const bench_scene *subject,
                          uint32_t repeat, double *times, scene_error *error) {
    double *const steps = times, *const frames = times + repeat, *const longer = times + 2 * (size_t)repeat;
    double *const over = times + 3 * (size_t)repeat, *const of_call = times + 4 * (size_t)repeat;
    const bench_runner runner = bench_network_runner(plain);
    for (uint32_t i = 0; i < repeat + 1; i++) {
        const uint32_t at = i > 0 ? i - 1 : 0; // the first ones are not counted
        double seconds[CALLS] = {0.0};
        const double start = bench_thread_seconds();
        if (!runner.run(runner.self, 1, error)) {
            return false;
        }
        steps[at] = bench_thread_seconds() - start;
        if (!take_frame(g, seconds, error)) {
            return false;
        }
        frames[at] = 0.0;
        for (int call = 0; call < CALLS; call++) {
            of_call[(size_t)call * repeat + at] = seconds[call];
            frames[at] += seconds[call];
        }
        longer[at] = seconds[STEP] - steps[at];
        over[at] = frames[at] - steps[at];
    }
    const double step_median = bench_median(steps, repeat); // sorts
    print_row(options, subject, g, "a step alone", steps[0], step_median, step_median);
    for (int call = 0; call < CALLS; call++) {
        double *const own = call == STEP ? longer : of_call + (size_t)call * repeat;
        const double median = bench_median(own, repeat);
        print_row(options, subject, g, call == STEP ? "  forces, floor, strain in it" : calls[call].name, own[0],
                  median, step_median);
    }
    double median = bench_median(over, repeat);
    print_row(options, subject, g, "all but the step", over[0], median, step_median);
    median = bench_median(frames, repeat);
    print_row(options, subject, g, "a frame", frames[0], median, step_median);
    return true;
}

/// Push all particles near the middle one outwards, and break a burst of springs from the middle id on.
static mspring_result blast(game *g) {
    enum { RADIUS = 20 };
    mspring_network *const network = g->network.network;
    const uint32_t count = g->network.particle_count, middle = count / 2;
    const float *const at = g->positions;
    for (uint32_t i = 0; i < count; i++) {
        const float x = at[2 * i] - at[2 * middle], y = at[2 * i + 1] - at[2 * middle + 1];
        const float distance = sqrtf(x * x + y * y);
        const float push = distance > 0 && distance < RADIUS ? 100.0f / (1.0f + distance) : 0.0f;
        g->forces[2 * i] = push * x;
        g->forces[2 * i + 1] = push * y;
    }
    const mspring_result result =
        mspring_network_apply_forces(network, MSPRING_PUSH_IMPULSE, NULL, 0, count, g->forces, g->forces + 1, 2);
    return result == MSPRING_OK ? mspring_network_break_springs(network, g->near, 0, g->burst) : result;
}

static mspring_result restore(game *g) {
    const mspring_result result = mspring_network_restore_springs(g->network.network, g->list, 0, g->burst, 0.0);
    return result == MSPRING_OK ? mspring_network_restore_springs(g->network.network, g->near, 0, g->burst, 0.0)
                                : result;
}

static mspring_result happen(game *g, uint32_t frame) {
    switch (frame) {
    case BREAK_AT:
        return mspring_network_break_springs(g->network.network, g->list, 0, g->burst);
    case RESTORE_AT:
        return restore(g);
    case BLAST_AT:
        return blast(g);
    default:
        return MSPRING_OK;
    }
}

/// A run of frames: the seconds of each, or the least of this and earlier runs.
static bool take_run(game *g, uint32_t run, double least[FRAMES], scene_error *error) {
    const bench_runner runner = bench_network_runner(&g->network);
    const mspring_result whole = restore(g);
    if (whole != MSPRING_OK) {
        bench_library_error(error, "restoring springs", whole, mspring_network_error(g->network.network));
        return false;
    }
    if (!runner.reset(runner.self, error)) {
        return false;
    }
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        double seconds[CALLS] = {0.0};
        const double start = bench_thread_seconds();
        const mspring_result result = happen(g, frame);
        double all = bench_thread_seconds() - start;
        if (result != MSPRING_OK) {
            bench_library_error(error, "what happens", result, mspring_network_error(g->network.network));
            return false;
        }
        if (!take_frame(g, seconds, error)) {
            return false;
        }
        for (int call = 0; call < CALLS; call++) {
            all += seconds[call];
        }
        least[frame] = run == 0 || all < least[frame] ? all : least[frame];
    }
    return true;
}

/// Frames in which a burst of springs breaks, is restored, and is blown off: those, the worst and the median one.
static bool measure_events(game *g, const bench_options *options, const bench_scene *subject, scene_error *error) {
    double least[FRAMES], sorted[FRAMES];
    for (uint32_t run = 0; run < RUNS; run++) {
        if (!take_run(g, run, least, error)) {
            return false;
        }
    }
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        sorted[frame] = least[frame];
    }
    const double median = bench_median(sorted, FRAMES); // sorts
    static const struct {
        const char *name;
        uint32_t frame;
    } rows[] = {{"a frame that breaks 1,000", BREAK_AT},
                {"  restores 1,000", RESTORE_AT},
                {"  blasts and breaks 1,000", BLAST_AT}};
    print_row(options, subject, g, "median of 120 frames", sorted[0], median, median);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        print_row(options, subject, g, rows[i].name, least[rows[i].frame], least[rows[i].frame], median);
    }
    print_row(options, subject, g, "  the worst", sorted[FRAMES - 1], sorted[FRAMES - 1], median);
    return true;
}

static bool measure_level(const bench_scene *subject, const bench_options *options, mspring_simd level) {
    const uint32_t springs = mspring_builder_count(subject->made.builder, MSPRING_SPRINGS);
    const uint32_t substeps = options->substeps > 0 ? options->substeps : bench_default_substeps(springs);
    const uint32_t repeat = options->repeat > 0 ? options->repeat : 3 * bench_default_repeat(springs);
    game g = {0};
    bench_network plain = {0};
    scene_error error;
    mspring_builder *ship = NULL;
    double *times = bench_allocate((4 + CALLS) * (size_t)repeat, sizeof *times, &error);
    mspring_result result = mspring_builder_create(NULL, &ship);
    if (result == MSPRING_OK) {
        result = copy_absolute(subject->made.builder, substeps, ship);
    }
    if (result != MSPRING_OK) {
        bench_library_error(&error, "copying the ship", result, mspring_builder_error(ship));
    }
    const bool ok =
        times != NULL && result == MSPRING_OK &&
        bench_network_create(ship, level, options->workers, substeps, &plain, &error) &&
        bench_network_create(ship, level, options->workers, substeps, &g.network, &error) && fill(&g, &error) && measure_calls(&g, &plain, options, subject, repeat, times, &error) &&
        measure_events(&g, options, subject, &error);
    if (!ok) {
        bench_complain(subject->label, &error);
    }
    free(times);
    free_game(&g);
    bench_network_free(&plain);
    mspring_builder_destroy(ship);
    return ok;
}

bool bench_run_game(const bench_options *options) {
    static const char *const default_scenes[] = {"ship", NULL};
    bench_table_preamble(options->format);
    bench_table_note(options->format, "times are those of one thread");
    bench_table_head(options->format, columns, COLUMN_COUNT);
    return bench_for_each_level(options, default_scenes, measure_level);
}

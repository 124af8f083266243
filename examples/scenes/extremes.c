/// @file extremes.c
/// Networks at the extremes.
///
/// SPDX-License-Identifier: MIT
#include "scenes/extremes.h"
#include "scenes/internal.h"

#include <massspring/massspring.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    STEPS = 20,
    COLUMNS = 12,
    BAR_ROWS = 3,
    SHIP_ROWS = 8,
    SEGMENTS = 20,
    GRAPH_PARTICLES = 40,
    GRAPH_SPRINGS = 100,
    MOST_PARTICLES = COLUMNS * SHIP_ROWS + SEGMENTS,
    TRIED_SUBSTEPS = 3000,
    SUBSTEPS_A_LOOK = 20
};

static const double powers[EXTREME_STIFFNESSES] = {1,   1e1, 1e2,  1e3,  1e4,  1e5,  1e6, 1e7,
                                                   1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14};
static const double steps[EXTREME_STEPS] = {1e-6,     1e-5,     1e-4,   1e-3,  6.198e-3,
                                            1.0 / 64, 1.0 / 30, 0.0625, 0.125, 0.25};
static const double ratio_roots[EXTREME_RATIOS] = {1, 10, 100}; // third roots
static const double dampers[EXTREME_DAMPERS] = {0, 0.1, 10};
static const double spacings[EXTREME_SPACINGS] = {1e-6, 1, 1e6};
static const double places[EXTREME_PLACES] = {0, 1e7};

double extreme_stiffness(uint32_t index) {
    return powers[index];
}

double extreme_dt(uint32_t index) {
    return steps[index];
}

const char *extreme_shape_name(extreme_shape shape) {
    static const char *const names[EXTREME_SHAPES] = {"bar", "ship", "rope", "random graph"};
    return names[shape];
}

static uint32_t draw(uint32_t *rest, uint32_t count) {
    const uint32_t drawn = *rest % count;
    *rest /= count;
    return drawn;
}

extreme_network extreme_network_of(uint32_t number) {
    extreme_network made;
    made.shape = (extreme_shape)draw(&number, EXTREME_SHAPES);
    made.stiffness = draw(&number, EXTREME_STIFFNESSES);
    made.ratio = draw(&number, EXTREME_RATIOS);
    made.damper = draw(&number, EXTREME_DAMPERS);
    made.spacing = draw(&number, EXTREME_SPACINGS);
    made.place = draw(&number, EXTREME_PLACES);
    return made;
}

extreme_way extreme_way_of(uint32_t number) {
    static const extreme_way ways[EXTREME_WAYS] = {{"explicit", MSPRING_SOLVER_EXPLICIT, MSPRING_GUARD_GROWTH},
                                                   {"implicit", MSPRING_SOLVER_IMPLICIT, MSPRING_GUARD_GROWTH},
                                                   {"direct", MSPRING_SOLVER_DIRECT, MSPRING_GUARD_GROWTH},
                                                   {"clamped", MSPRING_SOLVER_EXPLICIT, MSPRING_GUARD_CLAMP}};
    return ways[number];
}

/* ------------------------------------------------------------------------------------------------ the networks */

/// What is drawn into a builder. Once a call has failed the others do nothing.
typedef struct maker {
    const extreme_network *what;
    mspring_builder *builder;
    mspring_result result;
    uint64_t seed;
    double masses[MOST_PARTICLES]; ///< [particles] kg
    double mass;                   ///< of all particles so far, kg
    uint32_t particles, springs;
} maker;

static double between(maker *m, double low, double high) {
    return low + (high - low) * random_unit(&m->seed);
}

// A particle somewhere on the grid of the spacing, of 1 kg to the ratio: as many of each third of its powers of
// ten.
static mspring_id add_particle(maker *m, double column, double row, uint32_t flags) {
    mspring_particle_def def = mspring_particle_def_default();
    const double spacing = spacings[m->what->spacing], root = ratio_roots[m->what->ratio];
    double mass = 1;
    for (uint32_t power = random_below(&m->seed, 4); power > 0; power--)
        mass *= root;
    def.x = places[m->what->place] + spacing * column;
    def.y = spacing * row;
    def.mass = (float)mass;
    def.flags = flags;
    mspring_id id = MSPRING_NONE;
    if (m->result == MSPRING_OK)
        m->result = mspring_builder_add_particles(m->builder, &def, 1, &id);
    m->masses[m->particles++] = mass;
    m->mass += mass;
    return id;
}

static void add_spring(maker *m, mspring_id a, mspring_id b) {
    mspring_spring_def def = mspring_spring_def_default();
    const double stiffness = powers[m->what->stiffness];
    def.a = a;
    def.b = b;
    def.stiffness = (float)stiffness;
    def.damping = (float)(dampers[m->what->damper] * 2 * sqrt(stiffness));
    if (m->result == MSPRING_OK)
        m->result = mspring_builder_add_springs(m->builder, &def, 1, NULL);
    m->springs++;
}

static void add_lattice(maker *m, int rows, double holes) {
    mspring_id ids[SHIP_ROWS][COLUMNS];
    for (int row = 0; row < rows; row++)
        for (int column = 0; column < COLUMNS; column++)
            ids[row][column] = random_unit(&m->seed) < holes ? MSPRING_NONE : add_particle(m, column, row, 0);
    static const int steps_to[4][2] = {
        {1, 0}, {-1, 1}, {0, 1}, {1, 1}}; // with those from the other side, all eight
    for (int row = 0; row < rows; row++) {
        for (int column = 0; column < COLUMNS; column++) {
            for (int i = 0; i < 4; i++) {
                const int to_column = column + steps_to[i][0], to_row = row + steps_to[i][1];
                if (to_column >= 0 && to_column < COLUMNS && to_row < rows && ids[row][column] != MSPRING_NONE &&
                    ids[to_row][to_column] != MSPRING_NONE)
                    add_spring(m, ids[row][column], ids[to_row][to_column]);
            }
        }
    }
}

// Straight, one end pinned.
static void add_rope(maker *m) {
    mspring_id last = add_particle(m, 0, 0, MSPRING_PARTICLE_PINNED);
    for (int i = 1; i <= SEGMENTS; i++) {
        const mspring_id next = add_particle(m, i, 0, 0);
        add_spring(m, last, next);
        last = next;
    }
}

static void add_graph(maker *m) {
    bool joined[GRAPH_PARTICLES][GRAPH_PARTICLES] = {{false}};
    for (int i = 0; i < GRAPH_PARTICLES; i++) {
        const double column = between(m, 0, 7), row = between(m, 0, 7);
        add_particle(m, column, row, 0);
    }
    for (int i = 0; i < GRAPH_SPRINGS;) {
        const uint32_t first = random_below(&m->seed, GRAPH_PARTICLES);
        const uint32_t second = random_below(&m->seed, GRAPH_PARTICLES);
        const uint32_t a = first < second ? first : second, b = first < second ? second : first;
        if (a != b && !joined[a][b]) {
            joined[a][b] = true;
            add_spring(m, a, b);
            i++;
        }
    }
}

static maker start(const extreme_network *what) {
    maker m = {.what = what, .seed = 12};
    m.result = mspring_builder_create(NULL, &m.builder);
    switch (what->shape) {
    case EXTREME_BAR:
        add_lattice(&m, BAR_ROWS, 0);
        break;
    case EXTREME_SHIP:
        add_lattice(&m, SHIP_ROWS, 0.2);
        break;
    case EXTREME_ROPE:
        add_rope(&m);
        break;
    default:
        add_graph(&m);
    }
    return m;
}

/// What a network is at one time.
typedef struct motion {
    uint32_t count;
    double x[MOST_PARTICLES], y[MOST_PARTICLES];
    float vx[MOST_PARTICLES], vy[MOST_PARTICLES];
} motion;

static bool read_motion(const mspring_network *network, motion *now) {
    now->count = mspring_network_count(network, MSPRING_PARTICLES);
    return mspring_network_get_positions(network, NULL, 0, now->count, now->x, now->y, 1) == MSPRING_OK &&
           mspring_network_get_velocities(network, NULL, 0, now->count, now->vx, now->vy, 1) == MSPRING_OK;
}

static bool is_finite(const motion *now) {
    bool all = true;
    for (uint32_t i = 0; i < now->count; i++)
        all = all && isfinite(now->x[i]) && isfinite(now->y[i]) && isfinite(now->vx[i]) && isfinite(now->vy[i]);
    return all;
}

static double energy_of(const mspring_network *network) {
    mspring_energy energy = mspring_energy_default();
    if (mspring_network_get_energy(network, &energy) != MSPRING_OK)
        return INFINITY;
    return energy.kinetic + energy.elastic;
}

/* ----------------------------------------------------------------------------------------------- what they do */

// Move the particles out of their places by up to a thousandth of the spacing.
static mspring_result disturb(mspring_network *network, const maker *m) {
    motion now;
    if (!read_motion(network, &now))
        return MSPRING_ERROR_ARGUMENT;
    uint64_t seed = m->seed;
    const double distance = 1e-3 * spacings[m->what->spacing];
    for (uint32_t i = 0; i < now.count; i++) {
        now.x[i] += distance * (2 * random_unit(&seed) - 1);
        now.y[i] += distance * (2 * random_unit(&seed) - 1);
    }
    return mspring_network_set_positions(network, NULL, 0, now.count, now.x, now.y, 1);
}

// Whether a refusal is what it should be.
static extreme_outcome judge_refusal(extreme_outcome refused, bool expected, mspring_result result,
                                     const char *reason, char *text, size_t size) {
    snprintf(text, size, "%s: %s", mspring_result_string(result), reason);
    return expected && strlen(reason) > 0 ? refused : EXTREME_FAILED;
}

/// How energy is counted.
typedef struct measure {
    double softened_by; ///< s: springs count with the stiffness that they have in clamped substeps of that; 0: all
    double stiffness;   ///< that none is above, N/m
} measure;

// Springs that are clamped are as stiff as their ends allow.
static measure measure_of(const maker *m, extreme_way way, double dt) {
    const double stiffness = powers[m->what->stiffness];
    double heaviest = 0;
    for (uint32_t i = 0; i < m->particles; i++)
        heaviest = fmax(heaviest, m->masses[i]);
    if (way.guard != MSPRING_GUARD_CLAMP)
        return (measure){0, stiffness};
    return (measure){dt, fmin(stiffness, heaviest / (dt * dt))};
}

static double measured_energy(const mspring_network *network, const maker *m, const measure *by) {
    double sum = 0;
    if (!(by->softened_by > 0))
        return energy_of(network);
    for (mspring_id s = 0; s < m->springs; s++) {
        mspring_id a, b;
        float length, rest, k;
        const mspring_column columns[] = {{MSPRING_END_A, 1, &a},
                                          {MSPRING_END_B, 1, &b},
                                          {MSPRING_LENGTH, 1, &length},
                                          {MSPRING_ACTIVE_REST_LENGTH, 1, &rest},
                                          {MSPRING_ACTIVE_STIFFNESS, 1, &k}};
        if (mspring_network_get_columns(network, NULL, s, 1, columns, 5) != MSPRING_OK)
            return INFINITY;
        const double extension = (double)length - (double)rest, stiffness = (double)k;
        const double inverse_mass = 1 / m->masses[a] + 1 / m->masses[b];
        sum += 0.5 * stiffness / (1 + stiffness * by->softened_by * by->softened_by * inverse_mass) * extension *
               extension;
    }
    mspring_energy energy = mspring_energy_default();
    return mspring_network_get_energy(network, &energy) == MSPRING_OK ? sum + energy.kinetic : INFINITY;
}

static extreme_outcome take_steps(mspring_network *network, const maker *m, extreme_way way, double dt, char *text,
                                  size_t size) {
    const double spacing = spacings[m->what->spacing];
    const measure by = measure_of(m, way, dt);
    // Positions are rounded to 1e-7 of the network's size in each step, which stretches springs.
    const double rounding = 20 * spacing * 2e-7, first = measured_energy(network, m, &by);
    const double noise = STEPS * m->springs * by.stiffness * rounding * (rounding + 1e-3 * spacing);
    for (int step = 1; step <= STEPS; step++) {
        const mspring_result result = mspring_network_step(network, dt);
        motion now;
        if (!read_motion(network, &now) || !is_finite(&now)) {
            snprintf(text, size, "not finite after step %d", step);
            return EXTREME_NOT_FINITE;
        }
        if (result != MSPRING_OK)
            return judge_refusal(EXTREME_GUARDED, result == MSPRING_ERROR_UNSTABLE, result,
                                 mspring_network_error(network), text, size);
        const double root = sqrt(first + noise) + 9.8 * step * dt * sqrt(m->mass / 2);
        // Near the border the energy of a mode swings by a factor of a hundred. Clamped springs are as stiff as the
        // shape allows at the time, so that their energy is not that of a function of the shape: motion has the
        // bound.
        mspring_step_info info = mspring_step_info_default();
        const bool loses =
            mspring_network_get_step_info(network, &info) == MSPRING_OK && info.fallback_count == info.step_count;
        mspring_energy all = mspring_energy_default();
        if (loses && mspring_network_get_energy(network, &all) != MSPRING_OK)
            return EXTREME_FAILED;
        const double energy = loses ? all.kinetic : measured_energy(network, m, &by);
        if (!(energy <= (loses ? 1.001 : 400) * root * root)) {
            snprintf(text, size, "%g J of at most %g J in step %d", energy, root * root, step);
            return EXTREME_DIVERGED;
        }
    }
    return EXTREME_STABLE;
}

extreme_outcome extreme_run(const extreme_network *what, extreme_way way, double dt, char *text, size_t size) {
    mspring_network_def def = mspring_network_def_default();
    def.settings.substeps = 1;
    def.settings.solver = way.solver;
    def.settings.guard = way.guard;
    mspring_network *network = NULL;
    maker m = start(what);
    extreme_outcome outcome;
    if (m.result == MSPRING_OK)
        m.result = mspring_network_create(m.builder, &def, &network);
    if (m.result != MSPRING_OK) {
        outcome = judge_refusal(EXTREME_REFUSED, true, m.result, mspring_builder_error(m.builder), text, size);
    } else {
        m.result = disturb(network, &m);
        outcome = m.result == MSPRING_OK
                      ? take_steps(network, &m, way, dt, text, size)
                      : judge_refusal(EXTREME_FAILED, false, m.result, mspring_network_error(network), text, size);
    }
    mspring_network_destroy(network);
    mspring_builder_destroy(m.builder);
    return outcome;
}

/* ------------------------------------------------------------------------------------------------- the border */

// Whether small motion grows in substeps of h. At first each particle has as much energy as a particle of 1 kg that
// goes up to a ten-thousandth of the spacing in a substep: what goes mad is the light ones.
static bool grows(maker *m, double h) {
    mspring_network_def def = mspring_network_def_default();
    def.settings.substeps = 1;
    def.settings.gravity_y = 0;
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    def.settings.max_speed = 1e15f;
    mspring_network *network = NULL;
    if (mspring_network_create(m->builder, &def, &network) != MSPRING_OK)
        return false;
    motion now;
    uint64_t seed = 5;
    const double speed = 1e-4 * spacings[m->what->spacing] / h;
    bool grew = !read_motion(network, &now);
    for (uint32_t i = 0; i < now.count; i++) {
        now.vx[i] = (float)(speed / sqrt(m->masses[i]) * (2 * random_unit(&seed) - 1));
        now.vy[i] = (float)(speed / sqrt(m->masses[i]) * (2 * random_unit(&seed) - 1));
    }
    if (m->what->shape == EXTREME_ROPE)
        now.vx[0] = now.vy[0] = 0; // pinned
    grew = grew || mspring_network_set_velocities(network, NULL, 0, now.count, now.vx, now.vy, 1) != MSPRING_OK;
    double first = 0;
    for (int i = 0; i < TRIED_SUBSTEPS && !grew; i++) {
        grew = mspring_network_step(network, h) != MSPRING_OK;
        // Near the border a mode's energy swings by a factor of a hundred; modes that are alone in a corner make
        // the whole a few thousand times what it was when they go mad.
        if (i == 0)
            first = energy_of(network);
        else if (i % SUBSTEPS_A_LOOK == 0)
            grew = grew || energy_of(network) > 1e3 * first;
    }
    mspring_network_destroy(network);
    return grew;
}

double extreme_border(const extreme_network *what) {
    mspring_network *network = NULL;
    maker m = start(what);
    double predicted = 0, low = 0.95, high = 1.05;
    bool known = m.result == MSPRING_OK && mspring_network_create(m.builder, NULL, &network) == MSPRING_OK &&
                 mspring_network_get_stable_dt(network, &predicted, NULL) == MSPRING_OK && predicted > 0 &&
                 predicted < INFINITY;
    mspring_network_destroy(network);
    // From inside outwards: most are near 1.
    for (double step = 0.004; known && low == 0.95 && 1 - step > 0.95; step *= 2)
        if (!grows(&m, predicted * (1 - step)))
            low = 1 - step;
        else
            high = 1 - step;
    for (double step = 0.004; known && high == 1.05 && 1 + step < 1.05; step *= 2)
        if (grows(&m, predicted * (1 + step)))
            high = 1 + step;
        else
            low = 1 + step;
    while (known && high - low > 1e-3) {
        const double middle = (low + high) / 2;
        *(grows(&m, predicted * middle) ? &high : &low) = middle;
    }
    mspring_builder_destroy(m.builder);
    return known ? (low + high) / 2 : 0;
}

double extreme_border_within(extreme_shape shape) {
    return shape == EXTREME_GRAPH ? 0.03 : 0.015;
}

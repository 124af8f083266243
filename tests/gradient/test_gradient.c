/// @file test_gradient.c
/// Gradients are those of the scheme in double precision.
///
/// **Tolerance.** The reference follows the network: rounding that the network added to each substep is a constant of
/// it. So both go the same way, and what differs is
///  - the difference of fourth order: 1e-16 of a loss of about 10, over a change of it of 1e-5 to 1e-3, is 1e-10 to 1e-8;
///  - single precision in the scheme itself: times of the first kick and shares of damping, 2^-24; lengths of actuators,
///    2^-24 of a length that a strain of some percent is left of, so some 1e-7.
/// Errors are of the largest derivative of a kind. Lattices without dampers and actuators have 4e-9, those with actuators
/// 4e-7.
///
/// Without following, the network's own way differs by rounding: 2^-24 of coordinates of 4 m are 2e-7 m of extensions of
/// some cm, or 1e-5.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <massspring/massspring_gradient.h>

#include "reference.h"
#include "support.h"

#define TOLERANCE 1e-6
#define MOST_SUBSTEPS 40
#define TOLERANCE_OF_ANOTHER_WAY 3e-5

/// A scene: a network and what its steps are given.
typedef struct scene {
    mspring_network *network;
    double dt;
    uint32_t steps, substeps; ///< AUTO and EVEN, too
    double uneven;            ///< steps are longer or shorter by up to this share
    mspring_id springs[64], forced[8];
    uint32_t actuators, changes, forced_count;
    double plane[4];
    bool has_plane;
    uint64_t seed;
} scene;

/* ---------------------------------------------------------------------------------------------- the reference */

static void read_floats(const mspring_network *n, mspring_property of, uint32_t count, double *to) {
    float *values = malloc((count + 1) * sizeof *values);
    assert_non_null(values);
    if (count > 0)
        check_ok(mspring_network_get(n, of, NULL, 0, count, values, 1));
    for (uint32_t i = 0; i < count; i++)
        to[i] = (double)values[i];
    free(values);
}

static void read_motion(const mspring_network *n, reference *r) {
    const uint32_t p = r->particles;
    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_get_view(n, &view));
    check_ok(mspring_network_get_positions(n, NULL, 0, p, r->values + r->first[BY_X], r->values + r->first[BY_Y], 1));
    for (uint32_t i = 0; i < p; i++) {
        const uint32_t slot = view.slot_of_particle[i];
        r->values[r->first[BY_VX] + i] = (double)view.vx[slot];
        r->values[r->first[BY_VY] + i] = (double)view.vy[slot];
        r->inverse_mass[i] = (double)view.inverse_mass[slot];
    }
}

// What the scene is, and signals, forces and weights of the loss by chance.
static reference reference_of(scene *s) {
    const mspring_settings settings = support_settings(s->network);
    reference sizes = {.particles = mspring_network_count(s->network, MSPRING_PARTICLES),
                       .springs = mspring_network_count(s->network, MSPRING_SPRINGS),
                       .steps = s->steps,
                       .most_substeps = MOST_SUBSTEPS,
                       .actuators = s->actuators,
                       .changes = s->changes,
                       .forced = s->forced_count,
                       .planes = s->has_plane,
                       .rate = (double)settings.global_damping,
                       .gravity_x = (double)settings.gravity_x,
                       .gravity_y = (double)settings.gravity_y};
    const double length = sqrt(s->plane[2] * s->plane[2] + s->plane[3] * s->plane[3]);
    sizes.planes_of[0][0] = s->plane[2] / length;
    sizes.planes_of[0][1] = s->plane[3] / length;
    sizes.planes_of[0][2] = (s->plane[0] * s->plane[2] + s->plane[1] * s->plane[3]) / length;
    reference r = reference_make(&sizes);
    check_ok(mspring_network_get_columns(s->network, NULL, 0, r.springs, (const mspring_column[]){{MSPRING_END_A, 1, r.a}, {MSPRING_END_B, 1, r.b}}, 2));
    read_floats(s->network, MSPRING_ACTIVE_STIFFNESS, r.springs, r.values + r.first[BY_STIFFNESS]);
    read_floats(s->network, MSPRING_ACTIVE_DAMPING, r.springs, r.values + r.first[BY_DAMPING]);
    read_floats(s->network, MSPRING_REST_LENGTH, r.springs, r.values + r.first[BY_LENGTH]);
    read_motion(s->network, &r);
    for (uint32_t i = 0; i < r.actuators; i++) {
        r.actuator[i] = s->springs[i];
        r.nominal[i] = r.values[r.first[BY_LENGTH] + s->springs[i]];
    }
    for (uint32_t i = 0; i < r.forced; i++)
        r.forced_of[i] = s->forced[i];
    for (uint32_t i = r.first[BY_SIGNALS]; i < r.first[BY_FORCES]; i++)
        r.values[i] = (double)(float)support_random_between(&s->seed, 0.9, 1.1);
    for (uint32_t i = r.first[BY_FORCES]; i < r.first[KINDS]; i++)
        r.values[i] = (double)(float)support_random_between(&s->seed, -2, 2);
    for (uint32_t i = 0; i < 8 * r.particles; i++)
        r.weights[i] = support_random_between(&s->seed, -1, 1);
    return r;
}

/* ----------------------------------------------------------------------------------------------- the gradient */

static void add_seeds(mspring_gradient *g, const reference *r, int at, const double *z) {
    const double *w = r->weights + 4 * (size_t)r->particles * (size_t)at;
    for (uint32_t p = 0; p < r->particles; p++) {
        double seeds[4];
        for (uint32_t i = 0; i < 4; i++)
            seeds[i] = w[4 * p + i] * (1 + z[i * r->particles + p]);
        check_ok(mspring_gradient_add_seeds(g, NULL, p, 1, seeds, seeds + 2));
    }
}

// x, y, vx and vy of all particles, one after another.
static void read_state(const mspring_network *n, double *z) {
    const uint32_t count = mspring_network_count(n, MSPRING_PARTICLES);
    check_ok(mspring_network_get_positions(n, NULL, 0, count, z, z + count, 1));
    for (uint32_t p = 0; p < count; p++) {
        float vx, vy;
        check_ok(mspring_network_get_velocities(n, NULL, p, 1, &vx, &vy, 1));
        z[2 * count + p] = (double)vx;
        z[3 * count + p] = (double)vy;
    }
}

/// States before steps and after substeps, as a hook sees them.
typedef struct states {
    double *values; ///< [steps][MOST_SUBSTEPS + 1][4][particles], and one more at the end
    uint32_t step;
} states;

static double *state_of(const states *s, uint32_t particles, uint32_t step, uint32_t substeps) {
    return s->values + 4 * (size_t)particles * (step * (MOST_SUBSTEPS + 1) + substeps);
}

static void MSPRING_CALL see(const mspring_hook_args *args, void *user) {
    const states *s = user;
    read_state(args->network,
               state_of(s, mspring_network_count(args->network, MSPRING_PARTICLES), s->step, args->substep + 1));
}

static double dt_of(const scene *s, uint32_t step) {
    return s->dt * (1 + s->uneven * sin(5.0 * step));
}

static void reverse(mspring_gradient *g, uint32_t count) {
    if (mspring_gradient_reverse(g, count) != MSPRING_OK)
        fail_msg("%s", mspring_gradient_error(g));
}

static void read_inputs(const reference *r, uint32_t step, float *signals, float *forces) {
    for (uint32_t i = 0; i < r->actuators; i++)
        signals[i] = (float)r->values[r->first[BY_SIGNALS] + step * r->actuators + i];
    for (uint32_t i = 0; i < 2 * r->forced; i++)
        forces[i] = (float)r->values[r->first[BY_FORCES] + step * r->forced * 2 + i];
}

// The states of the same steps, of a clone, and how long its substeps are.
static states play(const scene *s, reference *r) {
    mspring_network *clone = NULL;
    float signals[64], forces[64];
    states seen = {calloc((r->steps * (MOST_SUBSTEPS + 1) + 1) * 4 * (size_t)r->particles, sizeof(double)), 0};
    assert_non_null(seen.values);
    check_ok(mspring_network_clone(s->network, NULL, &clone));
    check_ok(support_add_hook(clone, MSPRING_PHASE_AFTER_SUBSTEP, see, &seen, NULL));
    for (; seen.step < r->steps; seen.step++) {
        const mspring_step_info before = support_step_info(clone);
        read_state(clone, state_of(&seen, r->particles, seen.step, 0));
        read_inputs(r, seen.step, signals, forces);
        if (r->actuators > 0)
            check_ok(mspring_network_set(clone, MSPRING_SIGNAL, NULL, 0, r->actuators, signals, 1));
        if (r->forced > 0)
            check_ok(mspring_network_apply_forces(clone, MSPRING_PUSH_STEP, s->forced, 0, r->forced, forces, forces + 1, 2));
        check_ok(mspring_network_step(clone, dt_of(s, seen.step)));
        const mspring_step_info after = support_step_info(clone);
        const double time = dt_of(s, seen.step) + before.time_left - after.time_left;
        assert_true(after.substeps <= MOST_SUBSTEPS);
        r->substeps[seen.step] = after.substeps;
        r->h[seen.step] = (double)(float)(time / after.substeps);
        r->lag[seen.step] = seen.step == 0 ? 0 : r->h[seen.step - 1];
    }
    read_state(clone, state_of(&seen, r->particles, r->steps, 0));
    mspring_network_destroy(clone);
    return seen;
}

// All derivatives, in the order of the reference's values.
static double *gradient_of(const scene *s, const reference *r, const states *seen) {
    mspring_gradient *g = NULL;
    double *all = calloc(r->first[KINDS], sizeof *all);
    float signals[64], forces[64];
    assert_non_null(all);
    check_ok(mspring_gradient_create(s->network, r->steps, s->forced, r->forced, &g));
    for (uint32_t step = 0; step < r->steps; step++) {
        read_inputs(r, step, signals, forces);
        check_ok(mspring_gradient_step(g, dt_of(s, step), signals, forces));
        assert_int_equal(support_substeps(s->network), r->substeps[step]);
    }
    add_seeds(g, r, 1, state_of(seen, r->particles, r->steps, 0));
    reverse(g, r->steps - r->steps / 2);
    add_seeds(g, r, 0, state_of(seen, r->particles, r->steps / 2, 0));
    reverse(g, r->steps / 2);
    for (int kind = BY_STIFFNESS; kind <= BY_VY; kind++)
        check_ok(mspring_gradient_get(g, (mspring_gradient_of)kind, NULL, 0, r->first[kind + 1] - r->first[kind],
                                      all + r->first[kind], 1));
    for (uint32_t step = 0; step < r->steps; step++) {
        check_ok(mspring_gradient_get_signals(g, step, all + r->first[BY_SIGNALS] + step * r->actuators));
        check_ok(mspring_gradient_get_forces(g, step, all + r->first[BY_FORCES] + step * r->forced * 2));
    }
    mspring_gradient_destroy(g);
    return all;
}

// A landing within a difference gives the loss a kink, and makes the difference wrong. So shorter ones are tried where
// there is a floor.
static double error_of_one(reference *r, uint32_t value, double step, double got, double expected) {
    double error = fabs(got - expected);
    for (int i = 0; i < 3 && r->planes > 0 && error > 1e-7 * fabs(expected); i++) {
        step /= 8;
        error = fmin(error, fabs(got - reference_difference(r, value, step)));
    }
    return error;
}

// Compare each derivative with a difference. Return the largest error, of the largest derivative of its kind.
static double worst_error(scene *s, const char *name, bool follows) {
    static const double steps[KINDS] = {1e-2, 1e-3, 1e-5, 1e-5, 1e-5, 1e-4, 1e-4, 1e-5, 1e-3};
    static const char *const names[KINDS] = {"stiffness", "damping", "length", "x",  "y",
                                             "vx",        "vy",      "signals", "forces"};
    reference r = reference_of(s);
    const states seen = play(s, &r);
    double *got = gradient_of(s, &r, &seen), worst = 0;
    if (follows)
        reference_follow(&r, seen.values);
    for (int kind = 0; kind < KINDS; kind++) {
        double largest = 0, error = 0;
        for (uint32_t i = r.first[kind]; i < r.first[kind + 1]; i++) {
            if (kind == BY_DAMPING && r.values[i] == 0)
                continue;
            const double expected = reference_difference(&r, i, steps[kind]);
            largest = fmax(largest, fabs(expected));
            error = isfinite(got[i]) ? fmax(error, error_of_one(&r, i, steps[kind], got[i], expected)) : INFINITY;
        }
        if (largest > 0) {
            if (error > 0.1 * TOLERANCE * largest)
                print_message("%-8s %-10s largest %-12g error %g\n", name, names[kind], largest, error / largest);
            worst = fmax(worst, error / largest);
        }
    }
    free(got);
    free(seen.values);
    reference_free(&r);
    mspring_network_destroy(s->network);
    return worst;
}

/* ----------------------------------------------------------------------------------------------------- scenes */

static void join(mspring_builder *b, mspring_id from, mspring_id to, double length, double damping,
                 uint64_t *seed) {
    mspring_spring_def def;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = from;
    def.b = to;
    def.stiffness = (float)support_random_between(seed, 100, 300);
    def.damping = (float)(damping * support_random_between(seed, 0.5, 1.5));
    def.rest_length = (float)(length * support_random_between(seed, 0.98, 1.02));
    check_ok(mspring_builder_add_springs(b, &def, 1, NULL));
}

// A lattice of width times height cells with springs of chance.
static mspring_builder *lattice(uint32_t width, uint32_t height, double damping, uint64_t *seed, bool is_pinned) {
    mspring_builder *b = support_builder();
    for (uint32_t i = 0; i < width * height; i++) {
        const double x = i % width + support_random_between(seed, -0.03, 0.03);
        const double y = (i / width) + support_random_between(seed, -0.03, 0.03);
        const float mass = (float)support_random_between(seed, 0.5, 1.5);
        (void)(is_pinned && i % width == 0 ? support_pinned(b, x, y, mass) : support_particle(b, x, y, mass));
    }
    for (uint32_t i = 0; i < width * height; i++) {
        const uint32_t x = i % width, y = i / width;
        const uint32_t to[4] = {i + 1, i + width, i + width + 1, i + width - 1};
        const bool has[4] = {x + 1 < width, y + 1 < height, x + 1 < width && y + 1 < height,
                             x > 0 && y + 1 < height};
        for (int k = 0; k < 4; k++)
            if (has[k])
                join(b, i, to[k], k < 2 ? 1.0 : sqrt(2), damping, seed);
    }
    return b;
}

static void push_all(mspring_network *n, uint64_t *seed, double most) {
    for (mspring_id p = 0; p < mspring_network_count(n, MSPRING_PARTICLES); p++) {
        const float vx = (float)support_random_between(seed, -most, most);
        const float vy = (float)support_random_between(seed, -most, most);
        check_ok(mspring_network_set_velocities(n, NULL, p, 1, &vx, &vy, 1));
    }
}

static void set_actuators(scene *s, uint32_t every) {
    for (uint32_t i = 0; i < mspring_network_count(s->network, MSPRING_SPRINGS) && s->actuators < 10; i += every)
        s->springs[s->actuators++] = i;
    check_ok(mspring_network_set_actuators(s->network, s->springs, s->actuators, s->changes));
}

static void set_plane(scene *s, double x, double y, double nx, double ny) {
    const double plane[4] = {x, y, nx, ny};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.plane_count = 1;
    floor.planes = plane;
    check_ok(mspring_network_set_floor(s->network, &floor));
    memcpy(s->plane, plane, sizeof plane);
    s->has_plane = true;
}

// Waves in an undamped lattice without gravity.
static void make_lattice(scene *s, uint32_t flags) {
    mspring_builder *b = lattice(6, 5, 0, &s->seed, false);
    mspring_network_def def = support_def(0, s->substeps);
    def.flags = flags;
    s->network = support_network(b, &def);
    push_all(s->network, &s->seed, 0.3);
}

// Springs of chance between points of chance: dampers, gravity, global damping, pins, one of which moves.
static void make_web(scene *s, uint32_t flags) {
    mspring_builder *b = support_builder();
    double x[24], y[24];
    for (uint32_t i = 0; i < 24; i++) {
        x[i] = support_random_between(&s->seed, 0, 4);
        y[i] = support_random_between(&s->seed, 0, 4);
        (void)(i < 3 ? support_pinned(b, x[i], y[i], 1) : support_particle(b, x[i], y[i], 1));
    }
    for (uint32_t i = 0; i < 24; i++)
        for (uint32_t k = 0; k < i; k++) {
            const double length = hypot(x[i] - x[k], y[i] - y[k]);
            if (length > 0.4 && (length < 1.3 || k + 1 == i))
                join(b, k, i, length, 2, &s->seed);
        }
    mspring_network_def def = support_def(-9.8f, s->substeps);
    def.settings.gravity_x = 1.5f;
    def.settings.global_damping = 0.7f;
    def.flags = flags;
    s->network = support_network(b, &def);
    const float vx = 0.4f, vy = -0.2f;
    check_ok(mspring_network_set_velocities(s->network, NULL, 0, 1, &vx, &vy, 1));
}

// Muscles whose lengths change four times a step.
static void make_muscles(scene *s, uint32_t flags) {
    mspring_builder *b = lattice(5, 4, 1.5, &s->seed, true);
    mspring_network_def def = support_def(-9.8f, s->substeps);
    def.flags = flags;
    s->network = support_network(b, &def);
    set_actuators(s, 6);
}

// Forces on some particles of a rope and a lattice.
static void make_pushed(scene *s, uint32_t flags) {
    mspring_builder *b = lattice(4, 4, 1, &s->seed, true);
    for (uint32_t i = 0; i < 8; i++) {
        (void)support_particle(b, 3.5 + i, 4, 0.5f);
        join(b, 15 + i, 16 + i, i == 0 ? 1.1 : 1, 1, &s->seed);
    }
    mspring_network_def def = support_def(-9.8f, s->substeps);
    def.settings.global_damping = 0.3f;
    def.flags = flags;
    s->network = support_network(b, &def);
    for (uint32_t i = 0; i < 5; i++)
        s->forced[s->forced_count++] = 2 + 5 * i;
}

// A truss falls onto the ground and slides along it. The ground is near the local origin: the floor takes distances from
// single precision, and landings divide their rounding by h.
static void make_floor(scene *s, uint32_t flags) {
    mspring_builder *b = lattice(5, 2, 2, &s->seed, false);
    mspring_network_def def = support_def(-9.8f, s->substeps);
    def.settings.gravity_x = 3;
    def.flags = flags;
    s->network = support_network(b, &def);
    set_plane(s, 0, -0.05, 0.01, 1);
}

// A truss whose lower row begins below the ground and rises: it is put onto the ground and goes on from there.
static void make_sunk(scene *s, uint32_t flags) {
    mspring_builder *b = lattice(5, 2, 2, &s->seed, false);
    mspring_network_def def = support_def(-9.8f, s->substeps);
    def.flags = flags;
    s->network = support_network(b, &def);
    push_all(s->network, &s->seed, 1);
    set_plane(s, 0, 0.05, 0.05, 1);
}

static double error_of(void (*make)(scene *, uint32_t), const char *name, uint64_t seed, bool is_precise, bool follows) {
    scene s = {.dt = 1.0 / 64, .steps = 14, .substeps = 6, .changes = 4, .seed = seed};
    make(&s, is_precise ? MSPRING_NETWORK_PRECISE : 0);
    return worst_error(&s, name, follows);
}

static const struct {
    const char *name;
    void (*make)(scene *, uint32_t);
} scenes[] = {{"lattice", make_lattice},
              {"web", make_web},
              {"muscles", make_muscles},
              {"pushed", make_pushed},
              {"floor", make_floor},
              {"sunk", make_sunk}};

static void is_right(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++)
        for (size_t i = 0; i < COUNT_OF(scenes); i++)
            for (int is_precise = 0; is_precise < 2; is_precise++) {
                const double error = error_of(scenes[i].make, scenes[i].name, seed, is_precise, true);
                if (!(error < TOLERANCE))
                    fail_msg("%s, seed %d: %g", scenes[i].name, (int)seed, error);
            }
}

// Substeps that the library chooses, and steps that are uneven: the first kick of a step has another length.
static void is_right_where_steps_are_uneven(void **state) {
    (void)state;
    static const uint32_t substeps[] = {6, MSPRING_SUBSTEPS_AUTO, MSPRING_SUBSTEPS_EVEN};
    for (size_t i = 0; i < COUNT_OF(scenes); i++)
        for (size_t k = 0; k < COUNT_OF(substeps); k++) {
            scene s = {.dt = 1.0 / 32, .steps = 10, .substeps = substeps[k], .uneven = 0.6, .changes = 3, .seed = 7};
            scenes[i].make(&s, MSPRING_NETWORK_PRECISE);
            const double error = worst_error(&s, scenes[i].name, true);
            if (!(error < TOLERANCE))
                fail_msg("%s, substeps %x: %g", scenes[i].name, (unsigned)substeps[k], error);
        }
}

static void is_that_of_the_scheme_without_rounding(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(scenes); i++)
        assert_true(error_of(scenes[i].make, scenes[i].name, 1, false, false) < TOLERANCE_OF_ANOTHER_WAY);
}

// Seeds from the command line: test_gradient FIRST COUNT.
static int try_seeds(uint64_t first, uint64_t count) {
    int wrong = 0;
    for (uint64_t seed = first; seed < first + count; seed++)
        for (size_t i = 0; i < COUNT_OF(scenes); i++) {
            uint64_t by = seed;
            scene s = {.dt = support_random_between(&by, 0.003, 0.03),
                       .steps = (uint32_t)support_random_between(&by, 1, 20),
                       .substeps = (uint32_t)support_random_between(&by, 2, 20),
                       .changes = (uint32_t)support_random_between(&by, 1, 9),
                       .uneven = support_random_between(&by, 0, 0.5),
                       .seed = by};
            scenes[i].make(&s, support_random_between(&by, 0, 1) < 0.5 ? MSPRING_NETWORK_PRECISE : 0);
            const double error = worst_error(&s, scenes[i].name, true);
            if (!(error < TOLERANCE)) {
                printf("%s, seed %d: %g\n", scenes[i].name, (int)seed, error);
                wrong++;
            }
        }
    return wrong;
}

int main(int count, char **arguments) {
    if (count == 3)
        return try_seeds(strtoull(arguments[1], NULL, 10), strtoull(arguments[2], NULL, 10)) > 0;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_right),
        cmocka_unit_test(is_right_where_steps_are_uneven),
        cmocka_unit_test(is_that_of_the_scheme_without_rounding),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

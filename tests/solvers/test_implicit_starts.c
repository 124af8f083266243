/// @file test_implicit_starts.c
/// The implicit and the direct solver from starts that no sane host makes: they have to stay finite, and never to
/// have more energy than they began with, but for rounding.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>

#include "recipe.h"
#include "support.h"

/// Which of the two.
static mspring_solver tested = MSPRING_SOLVER_IMPLICIT;

enum { COLUMNS = 80, ROWS = 5, COUNT = COLUMNS * ROWS };

typedef struct start {
    const char *name;
    double stiffness, dt, gravity;
    double tip_mass;     ///< times the others' mass
    double light_masses; ///< the smallest of random masses, as a share of the largest; 0: all equal
    enum { AS_BUILT, COLLAPSED, FLATTENED, SPINNING } shape;
    double spin; ///< rad/s
    bool damped;
} start;

static const start starts[] = {
    {.name = "collapsed", .stiffness = 1e9, .shape = COLLAPSED},
    {.name = "collapsed, stiff", .stiffness = 1e12, .shape = COLLAPSED, .damped = true},
    {.name = "flattened", .stiffness = 1e9, .shape = FLATTENED, .gravity = 9.8},
    {.name = "spinning slowly", .stiffness = 1e9, .shape = SPINNING, .spin = 1},
    {.name = "spinning", .stiffness = 1e9, .shape = SPINNING, .spin = 5},
    {.name = "spinning fast", .stiffness = 1e9, .shape = SPINNING, .spin = 20, .damped = true},
    // x + h v stretches it by half a percent, which is thousands of times its kinetic energy: of that, eight
    // iterations leave more behind than there was.
    {.name = "spinning slowly, stiff", .stiffness = 1e12, .shape = SPINNING, .spin = 1},
    {.name = "spinning, stiff", .stiffness = 1e12, .shape = SPINNING, .spin = 5},
    {.name = "spinning fast, stiff", .stiffness = 1e12, .shape = SPINNING, .spin = 20},
    {.name = "long step, spinning", .stiffness = 1e10, .dt = 1.0 / 15, .shape = SPINNING, .spin = 5},
    {.name = "long step, spinning, stiff", .stiffness = 1e12, .dt = 1.0 / 15, .shape = SPINNING, .spin = 10},
    {.name = "hanging, stiff", .stiffness = 1e12, .gravity = 9.8},
    {.name = "heavy tip", .stiffness = 1e9, .gravity = 9.8, .tip_mass = 1000},
    {.name = "heavier tip", .stiffness = 1e10, .gravity = 9.8, .tip_mass = 42000, .damped = true},
    {.name = "random masses", .stiffness = 1e9, .gravity = 9.8, .light_masses = 1e-3},
    {.name = "long step", .stiffness = 1e9, .gravity = 9.8, .dt = 1.0 / 15},
    {.name = "long step, collapsed", .stiffness = 1e10, .dt = 1.0 / 15, .shape = COLLAPSED},
};

static recipe bar(const start *s) {
    uint64_t seed = 11;
    const double damping = s->damped ? 1e-4 * s->stiffness : 0;
    const recipe_stuff iron = {
        .mass = {73.3975, 73.3975}, .stiffness = {s->stiffness, s->stiffness}, .damping = {damping, damping}};
    recipe made = {0};
    recipe_lattice(&made, COLUMNS, ROWS, 0, 0, 1, &iron, &seed);
    recipe_disturb(&made, 0, 0, &seed); // rest lengths are those of now
    for (uint32_t i = 0; i < COUNT; i++) {
        mspring_particle_def *p = &made.particles[i];
        const double x = p->x - COLUMNS / 2.0, y = p->y - ROWS / 2.0;
        if (s->light_masses > 0) {
            p->mass *= (float)support_random_between(&seed, s->light_masses, 1);
        }
        if (i == COUNT - 1 && s->tip_mass > 0) {
            p->mass *= (float)s->tip_mass;
        }
        if (s->shape == AS_BUILT && i % COLUMNS == 0) {
            p->flags = MSPRING_PARTICLE_PINNED;
        }
        if (s->shape == COLLAPSED) {
            p->x = support_random_between(&seed, 0, 1);
            p->y = support_random_between(&seed, 0, 1);
        } else if (s->shape == FLATTENED) {
            p->y = 0;
        } else if (s->shape == SPINNING) {
            p->vx = (float)(-s->spin * y);
            p->vy = (float)(s->spin * x);
        }
    }
    return made;
}

/// Energy, and what of it is rounding. Positions are known to their last place here: what that leaves open, u / 2
/// at most in each coordinate, has a standard deviation of d = u / sqrt(6) in a spring's length. So springs seem to
/// have k d^2 / 2 each, and beside that by chance d sqrt(2 k E), if they have E together. The rest is a millionth,
/// of all that there is or that falling by the bar's length would give: sums of single numbers.
typedef struct account {
    double total, rounding;
} account;

static account account_of(const mspring_network *network, const start *s, uint32_t springs) {
    double kinetic, elastic, potential, least_x, least_y, most_x, most_y;
    check_ok(support_get_energy(network, &kinetic, &elastic, &potential));
    check_ok(support_get_bounds(network, &least_x, &least_y, &most_x, &most_y));
    const float farthest = (float)fmax(fmax(fabs(least_x), fabs(least_y)), fmax(fabs(most_x), fabs(most_y)));
    const double off = (double)(nextafterf(farthest, INFINITY) - farthest) / sqrt(6);
    return (account){
        .total = kinetic + elastic + potential,
        .rounding = 1e-6 * (kinetic + elastic + COUNT * 73.4 * s->gravity * COLUMNS) +
                    springs * s->stiffness * off * off + 4 * off * sqrt(2 * s->stiffness * elastic),
    };
}

static mspring_network *begin(const start *s, const recipe *made, mspring_integrator integrator,
                              uint32_t substeps) {
    mspring_network_def def = support_def((float)-s->gravity, 1);
    def.settings.max_speed = 1e9f;
    mspring_network *network = recipe_network(made, &def);
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = tested;
    solver.integrator = integrator;
    solver.substeps = substeps;
    solver.max_substeps = 8;
    solver.most_work = 0; // else MSPRING_GUARD_RETRY may keep more substeps after a step that fails
    check_ok(support_set_solver(network, &solver));
    return network;
}

static void check_start(const start *s, mspring_integrator integrator, uint32_t substeps) {
    recipe made = bar(s);
    mspring_network *network = begin(s, &made, integrator, substeps);
    const double dt = s->dt > 0 ? s->dt : 1.0 / 64;
    const account first = account_of(network, s, made.spring_count);
    const int steps = substeps == 1 ? 128 : 32;
    for (int step = 0; step < steps; step++) {
        const mspring_result result = mspring_network_step(network, dt);
        const account now = account_of(network, s, made.spring_count);
        const bool is_safe = now.total <= first.total + first.rounding + now.rounding; // and finite
        if (result != MSPRING_OK || !is_safe) {
            print_error(
                "%s, solver %d, integrator %d, substeps %u, step %d: from %g J to %g J, rounding %g J; %s\n",
                s->name, (int)tested, (int)integrator, (unsigned)substeps, step, first.total, now.total,
                now.rounding, mspring_network_error(network));
        }
        check_ok(result);
        assert_true(is_safe);
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void every_start_is_safe(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(starts); i++) {
        for (mspring_integrator n = MSPRING_INTEGRATOR_ALPHA; n <= MSPRING_INTEGRATOR_EULER; n++) {
            for (uint32_t substeps = 1; substeps <= 4; substeps += support_is_quick() ? 3 : 1) {
                check_start(&starts[i], n, substeps);
            }
        }
    }
}

/// Gives a particle a speed that is no number, while it is to.
static void spoil(const mspring_hook_args *args, void *user) {
    const bool *is_to = user;
    if (*is_to && args->substep + 1 == args->substep_count) {
        args->vx[args->slot_of_particle[0]] = NAN;
    }
}

/// Also if its first substep got energy from nowhere and was taken again, after which the next ones begin anew.
static void a_rejected_step_leaves_no_trace(void **state) {
    (void)state;
    for (uint64_t round = 0; round < 60; round++) {
        uint64_t seed = 5 + round;
        const double stiffness = pow(10, support_random_between(&seed, 2, 6));
        const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {stiffness, stiffness}, .damping = {0, 0}};
        const start s = {.gravity = 9.8};
        recipe made = {0};
        recipe_lattice(&made, 4, 3, 0, 0, 1, &stuff, &seed);
        recipe_disturb(&made, 0.2, 5, &seed);
        mspring_network *networks[2];
        bool spoils = false;
        for (int n = 0; n < 2; n++) {
            networks[n] = begin(&s, &made, (mspring_integrator)(round % 3), 1 + round % 2);
            check_ok(support_set_guard(networks[n], round % 4 < 2 ? MSPRING_GUARD_GROWTH : MSPRING_GUARD_RETRY));
            check_ok(support_add_hook(networks[n], MSPRING_PHASE_AFTER_SUBSTEP, spoil, &spoils, NULL));
        }
        for (int step = 0; step < 30; step++) {
            uint64_t hashes[2];
            spoils = true;
            check_error(mspring_network_step(networks[1], 1.0 / 32), MSPRING_ERROR_UNSTABLE);
            spoils = false;
            for (int n = 0; n < 2; n++) {
                check_ok(mspring_network_step(networks[n], 1.0 / 32));
                check_ok(mspring_network_get_state_hash(networks[n], &hashes[n]));
            }
            assert_true(hashes[0] == hashes[1]);
        }
        mspring_network_destroy(networks[0]);
        mspring_network_destroy(networks[1]);
        recipe_free(&made);
    }
}

static void all_in_one_point(void **state) {
    (void)state;
    const start s = {.stiffness = 1e9, .shape = COLLAPSED};
    recipe made = bar(&s);
    for (uint32_t i = 0; i < COUNT; i++) {
        made.particles[i].x = made.particles[i].y = 3;
    }
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.solver = tested;
    mspring_network *network = recipe_network(&made, &def);
    // Springs of length 0 have no direction, so it falls as one.
    support_steps(network, 64, 1.0 / 64);
    check_near(support_position(network, 0).y, 3 - 4.9, 0.01);
    check_near(support_position(network, COUNT - 1).y, support_position(network, 0).y, 1e-5);
    mspring_network_destroy(network);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_start_is_safe),
        cmocka_unit_test(a_rejected_step_leaves_no_trace),
        cmocka_unit_test(all_in_one_point),
    };
    const int failed = cmocka_run_group_tests_name("implicit_starts", tests, NULL, NULL);
    tested = MSPRING_SOLVER_DIRECT;
    return failed + cmocka_run_group_tests_name("direct_starts", tests, NULL, NULL);
}

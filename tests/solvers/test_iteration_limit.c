/// @file test_iteration_limit.c
/// Tangles, heaps and cliques: intervals, halves and passes of a step have the common bound that most_work asks
/// for, and what it cuts off makes no energy and lets no body through another.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include <massspring/massspring.h>

#include "recipe.h"
#include "support.h"

#define DT (1.0 / 64)

/// Calm steps for each of most_work, as work.c has it: of the direct solver as much work, in steps of 9/8 instead of
/// 15/8.
#define TIMES 32.0
#define TIMES_DIRECT (TIMES * 15 / 9)

typedef enum scene {
    TANGLE,  ///< a thrown chain with angles that touches itself
    HEAP,    ///< beams of 12x3 dropped one by one into a box
    ACROSS,  ///< stiff ones, across each other from the start: each step spends its work
    RODS,    ///< rods that lie across each other from the start
    CLIQUE,  ///< particles that are all joined, thrown at themselves
    PRESS,   ///< two stiff beams, thrown at each other
    IN_WALL, ///< a stiff zigzag rope, half of it behind a wall
    SCENES
} scene;

static const char *const names[SCENES] = {"tangle", "heap", "across", "rods", "clique", "press", "in a wall"};

static void beam(recipe *made, double x, double y, double angle, float vx, float vy, double stiffness,
                 uint64_t *seed) {
    const recipe_stuff stuff = {
        .mass = {1, 1}, .stiffness = {stiffness, stiffness}, .damping = {1e-4 * stiffness, 1e-4 * stiffness}};
    const uint32_t first = made->particle_count;
    recipe_lattice(made, 12, 3, -5.5, -1, 1, &stuff, seed);
    for (uint32_t i = first; i < made->particle_count; i++) {
        mspring_particle_def *p = &made->particles[i];
        const double px = p->x, py = p->y;
        p->x = x + cos(angle) * px - sin(angle) * py;
        p->y = y + sin(angle) * px + cos(angle) * py;
        p->vx = vx;
        p->vy = vy;
    }
}

static void chain(recipe *made, uint32_t count, double stiffness, bool is_zigzag, uint64_t *seed) {
    for (uint32_t i = 0; i < count; i++) {
        const mspring_id p = is_zigzag ? recipe_particle(made, 0.5 * i, 10 + 0.1 * (i % 2), 1, 0)
                                       : recipe_particle(made, support_random_between(seed, 0, 3),
                                                         support_random_between(seed, 1, 4), 1, 0);
        made->particles[p].vx = is_zigzag ? 0 : (float)support_random_between(seed, -12, 12);
        made->particles[p].vy = (float)support_random_between(seed, -12, 12) / (is_zigzag ? 4 : 1);
        if (i > 0) {
            recipe_spring(made, p - 1, p, stiffness, 0, 0);
        }
    }
}

static void draw(recipe *made, scene kind, uint64_t *seed) {
    if (kind == TANGLE || kind == IN_WALL) {
        chain(made, kind == TANGLE ? 60 : 120, kind == TANGLE ? 2e6 : 1e8, kind == IN_WALL, seed);
    }
    for (int i = 0; i < (kind == HEAP ? 6 : 0); i++) {
        beam(made, support_random_between(seed, -6, 6), 8 + 13 * i, support_random_between(seed, 0, 6.28), 0,
             (float)support_random_between(seed, -20, 0), 1e6, seed);
    }
    for (int i = 0; i < (kind == ACROSS ? 6 : 0); i++) {
        beam(made, support_random_between(seed, -6, 6), support_random_between(seed, 6, 20),
             support_random_between(seed, 0, 6.28), 0, -23, 5e9, seed);
    }
    for (int i = 0; i < (kind == PRESS ? 2 : 0); i++) {
        beam(made, i, 4.0 * i, 0.2 * i, 0, i ? -100.0f : 100.0f, 1e12, seed);
    }
    for (mspring_id i = 0; i < (kind == RODS ? 30 : 0); i++) {
        const double x = support_random_between(seed, 0, 4), y = support_random_between(seed, 0.5, 6),
                     angle = support_random_between(seed, 0, 6.28);
        const mspring_id a = recipe_particle(made, x, y, 1, 0);
        recipe_spring(made, a, recipe_particle(made, x + cos(angle), y + sin(angle) / 2, 1, 0), 1e6, 1, 0);
    }
    for (mspring_id i = 0; i < (kind == CLIQUE ? 16 : 0); i++) {
        recipe_particle(made, support_random_between(seed, 0, 4), support_random_between(seed, 0, 4), 1, 0);
        made->particles[i].vx = (float)support_random_between(seed, -50, 50);
        made->particles[i].vy = (float)support_random_between(seed, -50, 50);
        for (mspring_id j = 0; j < i; j++) {
            recipe_spring(made, j, i, 1e6, 0, 0);
        }
    }
}

static mspring_network *network_of(scene kind, mspring_solver solver, uint32_t substeps, uint32_t most_work,
                                   uint32_t workers, uint64_t seed) {
    recipe made = {0};
    draw(&made, kind, &seed);
    mspring_network_def def = support_def(kind == PRESS ? 0 : -9.8f, substeps);
    def.settings.solver = solver;
    def.settings.guard = MSPRING_GUARD_CLAMP;
    def.worker_count = workers;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    mspring_settings settings = support_solver(network);
    settings.most_work = most_work;
    check_ok(support_set_solver(network, &settings));
    const double box[] = {0, 0, 0, 1, -14, 0, 1, 0, 14, 0, -1, 0};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = box;
    floor.plane_count = 3;
    floor.friction = 0.5f;
    if (kind == HEAP || kind == ACROSS || kind == RODS || kind == IN_WALL) {
        check_ok(mspring_network_set_floor(network, &floor));
    }
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.flags = kind == TANGLE || kind == CLIQUE ? MSPRING_CONTACT_SELF : 0;
    contact.thickness = contact.flags ? 0.02 : 0.3;
    contact.friction = 0.5f;
    if (kind != IN_WALL) {
        check_ok(mspring_network_set_contact(network, &contact));
    }
    for (mspring_id i = 1; kind == TANGLE && i < 58; i += 2) {
        mspring_angle_def angle;
        check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &angle, sizeof angle));
        angle.stiffness = 1e4f;
        check_ok(mspring_network_add_angles(network, &angle, (const mspring_id[]){i - 1, i, i + 1}, 1, 3, NULL));
    }
    return network;
}

typedef struct seen {
    double work, gain, had, overlap; ///< most of a step, in calm steps; J; J; m
    uint32_t spent;                  ///< steps with MSPRING_STEP_FEWER
    uint64_t hash;
} seen;

static double energy_of(const mspring_network *network) {
    double kinetic, elastic, potential;
    check_ok(support_get_energy(network, &kinetic, &elastic, &potential));
    return kinetic + elastic + potential;
}

static seen play(mspring_network *network, uint32_t steps) {
    seen s = {.had = energy_of(network)};
    for (uint32_t step = 0; step < steps; step++) {
        check_ok(mspring_network_step(network, DT));
        mspring_step_info info = {.struct_size = sizeof info};
        mspring_contact_info contact = {.struct_size = sizeof contact};
        check_ok(mspring_network_get_step_info(network, &info));
        check_ok(mspring_network_get_contact_info(network, &contact));
        s.work = fmax(s.work, info.work);
        s.gain = fmax(s.gain, energy_of(network) - s.had);
        s.overlap = fmax(s.overlap, contact.deepest);
        s.spent += (info.flags & MSPRING_STEP_FEWER) != 0;
    }
    check_ok(mspring_network_get_state_hash(network, &s.hash));
    mspring_network_destroy(network);
    return s;
}

/// Two passes, of which the first began within the bound, and the second as one of implicit Euler: 16 times the
/// iterations. Those of the direct solver end at the bound, but for up to 1,000 products for angles in the last one.
static double last_pass(scene kind, mspring_solver solver) {
    const double products = solver == MSPRING_SOLVER_IMPLICIT ? 16 * 8
                            : kind == TANGLE                  ? 1 + 1000
                                                              : 1,
                 calm = solver == MSPRING_SOLVER_IMPLICIT ? 1 + 7 / 8.0 : 1 + 1 / 8.0;
    return 2 * (1 + products / 8) / calm;
}

/// ... and an interval that is taken once more, without contact in its system.
#define LAST_INTERVAL 2.0

static void work_is_bounded(void **state) {
    (void)state;
    for (scene kind = TANGLE; kind < SCENES; kind++) {
        for (mspring_solver solver = MSPRING_SOLVER_IMPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
            for (uint32_t most = 1; most <= 4; most += 3) {
                const seen s = play(network_of(kind, solver, most == 1 ? 4 : 1, most, 1, 7), ROUNDS(60));
                print_message(
                    "%s, solver %d, most_work %u: %.1f calm steps at most, %u spent, %.3g J gained of %.3g\n",
                    names[kind], (int)solver, (unsigned)most, s.work, (unsigned)s.spent, s.gain, s.had);
                assert_true(s.work <= (solver == MSPRING_SOLVER_DIRECT ? TIMES_DIRECT : TIMES) * most +
                                          last_pass(kind, solver) + LAST_INTERVAL);
                // The budget's millionth a substep, rounding of k l^2 = 1e12 J in as many springs, and m
                // push_speed^2 of 60 kg that overlap from the start.
                const double pushed = 60 * 0.15 * 0.15, rest = kind == PRESS ? 0.1 : kind == RODS ? pushed : 0;
                assert_true(s.gain <= 1e-5 * s.had + rest);
            }
        }
    }
}

/// An interval without work left for contact in its system moves bodies as rigid ones. As long as it pushed single
/// particles, overlaps came to 0.299 m, which is the thickness, in seven of eight heaps, and in a tenth of the
/// presses.
static void no_body_passes_another(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= 2 * ROUNDS(2); seed++) {
        const mspring_solver solver = seed % 2 ? MSPRING_SOLVER_IMPLICIT : MSPRING_SOLVER_DIRECT;
        const seen heap = play(network_of(HEAP, solver, 1, 1, 1, seed), 200),
                   press = play(network_of(PRESS, solver, 1, 4, 1, seed), 20);
        print_message("overlap %.4f m in the heap, %.4f m in the press; %u and %u spent\n", heap.overlap,
                      press.overlap, (unsigned)heap.spent, (unsigned)press.spent);
        assert_true(heap.spent > 0 && heap.overlap < 0.15 && press.overlap < 0.15); // half of the thickness
    }
}

/// Beams that fall onto each other, of which forces or a grip press the last one down by what is five times its
/// weight.
static mspring_network *pressed_beams(mspring_solver solver, bool has_grip, mspring_id *first) {
    uint64_t seed = 5;
    recipe made = {0};
    for (int i = 0; i < 8; i++) {
        *first = made.particle_count;
        beam(&made, 16 * (i % 2) + support_random_between(&seed, -1, 1), 4 + 5.0 * (i / 2),
             support_random_between(&seed, -0.2, 0.2), 0, -5, 1e8, &seed);
    }
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.solver = solver;
    def.settings.guard = MSPRING_GUARD_CLAMP;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    mspring_settings settings = support_solver(network);
    settings.most_work = 1;
    check_ok(support_set_solver(network, &settings));
    const double planes[] = {0, 0, 0, 1, -14, 0, 1, 0, 30, 0, -1, 0};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = planes;
    floor.plane_count = 3;
    floor.friction = 0.5f;
    check_ok(mspring_network_set_floor(network, &floor));
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.3;
    contact.friction = 0.5f;
    check_ok(mspring_network_set_contact(network, &contact));
    mspring_grip_def grip;
    check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &grip, sizeof grip));
    grip.particle = *first + 17;
    grip.x = 16;
    grip.y = -1000;
    grip.stiffness = 1e3f;
    grip.max_force = 36 * 50;
    if (has_grip)
        check_ok(mspring_network_add_grip(network, &grip, NULL));
    return network;
}

/// Impulse of all floors in the last step, upwards.
static double lifted(const mspring_network *network) {
    float x[8 * 36], y[8 * 36];
    double sum = 0;
    check_ok(mspring_network_get_columns(network, NULL, 0, 8 * 36, (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, x}, {MSPRING_FLOOR_IMPULSE_Y, 1, y}}, 2));
    for (int i = 0; i < 8 * 36; i++)
        sum += (double)y[i];
    return sum;
}

/// Forces act on rigid bodies before the impulses between them. As long as they acted after these, a body sank by
/// h^2 F / m in each step, down to the floor through three others. Those of grips were lost.
static void forces_press_no_body_through_another(void **state) {
    (void)state;
    for (int trial = 0; trial < 4; trial++) {
        const bool has_grip = trial >= 2;
        mspring_id first;
        mspring_network *network =
            pressed_beams(trial % 2 ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT, has_grip, &first);
        float none[36] = {0}, down[36];
        for (int i = 0; i < 36; i++)
            down[i] = has_grip ? 0 : -50;
        double deepest = 0, lift = 0;
        uint32_t spent = 0;
        for (int step = 0; step < 240; step++) {
            check_ok(mspring_network_apply_forces(network, MSPRING_PUSH_STEP, NULL, first, 36, none, down, 1));
            check_ok(mspring_network_step(network, DT));
            mspring_contact_info contact = {.struct_size = sizeof contact};
            check_ok(mspring_network_get_contact_info(network, &contact));
            deepest = fmax(deepest, contact.deepest);
            spent += (support_step_flags(network) & MSPRING_STEP_FEWER) != 0;
            lift += step < 180 ? 0 : lifted(network) / (60 * DT);
        }
        const double weight = 8 * 36 * 9.8 + 36 * 50;
        print_message("trial %d: %.4f m deep, %.1f N of %.1f, %u spent\n", trial, deepest, lift, weight,
                      (unsigned)spent);
        assert_true(spent > 60 && deepest < 0.1); // a third of the thickness
        assert_true(fabs(lift - weight) < 0.05 * weight);
        mspring_network_destroy(network);
    }
}

/// Without a bound the same scenes take more, and most_work 0 is none.
static void the_bound_is_what_ends_the_work(void **state) {
    (void)state;
    const seen free = play(network_of(IN_WALL, MSPRING_SOLVER_IMPLICIT, 1, 0, 1, 7), 2);
    assert_true(free.work > TIMES * 4 * 4 && free.spent == 0);
    assert_true(play(network_of(IN_WALL, MSPRING_SOLVER_IMPLICIT, 1, 4, 1, 7), 2).spent == 2);
}

typedef struct guarded {
    uint32_t refused, spent, substeps; ///< steps; steps; of the last one
    bool is_taken;                     ///< the last step was
} guarded;

/// Steps of a scene of which each that is refused must leave all as it was but, for a retry, twice the substeps.
static guarded play_with(mspring_guard guard, scene kind, mspring_solver solver, int steps) {
    mspring_network *network = network_of(kind, solver, 1, 4, 1, 7);
    check_ok(support_set_guard(network, guard));
    guarded all = {.substeps = 1};
    for (int step = 0; step < steps; step++) {
        const uint64_t before = support_hash(network);
        const mspring_result result = mspring_network_step(network, DT);
        const mspring_step_info info = support_step_info(network);
        all.is_taken = result == MSPRING_OK;
        all.spent += (info.flags & MSPRING_STEP_FEWER) != 0;
        all.refused += !all.is_taken;
        if (!all.is_taken) {
            check_error(result, MSPRING_ERROR_UNSTABLE);
            check_contains(mspring_network_error(network), "most_work, 4");
            assert_true(support_hash(network) == before && info.flags == 0 && info.work > 4);
            all.substeps *= guard == MSPRING_GUARD_RETRY ? 2 : 1;
        }
        assert_int_equal(support_solver(network).substeps, all.substeps);
    }
    mspring_network_destroy(network);
    return all;
}

/// With MSPRING_GUARD_GROWTH and _RETRY a step that spends its work fails. The next one of a retry has twice the
/// substeps, each of which has as much work. Other guards take the step, and flag it.
static void guards_decide_on_what_is_left_undone(void **state) {
    (void)state;
    for (mspring_solver solver = MSPRING_SOLVER_IMPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        for (mspring_guard guard = MSPRING_GUARD_GROWTH; guard <= MSPRING_GUARD_CLAMP_BOUNDS; guard++) {
            const bool retries = guard == MSPRING_GUARD_RETRY, refuses = guard == MSPRING_GUARD_GROWTH || retries;
            const guarded across = play_with(guard, ACROSS, solver, 6), press = play_with(guard, PRESS, solver, 12);
            print_message("solver %d, guard %d: %u and %u refused, %u and %u spent, %u and %u substeps\n",
                          (int)solver, (int)guard, (unsigned)across.refused, (unsigned)press.refused,
                          (unsigned)across.spent, (unsigned)press.spent, (unsigned)across.substeps,
                          (unsigned)press.substeps);
            assert_true(refuses ? across.refused > 0 && across.spent + press.spent == 0
                                : across.refused + press.refused == 0 && across.spent > 0 && press.spent > 0);
            assert_int_equal(press.is_taken, !refuses || retries);
        }
    }
}

static void workers_share_the_bound(void **state) {
    (void)state;
    for (scene kind = TANGLE; kind < SCENES; kind++) {
        const seen one = play(network_of(kind, MSPRING_SOLVER_IMPLICIT, 2, 2, 1, 3), 20),
                   three = play(network_of(kind, MSPRING_SOLVER_IMPLICIT, 2, 2, 3, 3), 20);
        assert_true(one.hash == three.hash && one.work == three.work && one.spent == three.spent);
    }
}

/// Pushing an overlap apart gives bodies the push's energy. A step is not repeated for that until its work is
/// spent: two beams that overlap by a third of the thickness took 36 calm steps a step, as long as they overlapped.
static void a_push_is_no_gain(void **state) {
    (void)state;
    for (mspring_solver solver = MSPRING_SOLVER_IMPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        uint64_t seed = 1;
        recipe made = {0};
        beam(&made, 0, 0, 0, 0, 0, 1e6, &seed);
        beam(&made, 0, 2.2, 0, 0, 0, 1e6, &seed);
        mspring_network_def def = support_def(0, 1);
        def.settings.solver = solver;
        mspring_network *network = recipe_network(&made, &def);
        recipe_free(&made);
        mspring_contact_def contact;
        check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
        contact.thickness = 0.3;
        check_ok(mspring_network_set_contact(network, &contact));
        double work = 0;
        for (int i = 0; i < 40; i++) {
            check_ok(mspring_network_step(network, DT));
            work += support_step_info(network).work;
        }
        assert_true(work < 10 * 40);
        mspring_network_destroy(network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(work_is_bounded),
        cmocka_unit_test(no_body_passes_another),
        cmocka_unit_test(forces_press_no_body_through_another),
        cmocka_unit_test(the_bound_is_what_ends_the_work),
        cmocka_unit_test(guards_decide_on_what_is_left_undone),
        cmocka_unit_test(workers_share_the_bound),
        cmocka_unit_test(a_push_is_no_gain),
    };
    return cmocka_run_group_tests_name("iteration_limit", tests, NULL, NULL);
}

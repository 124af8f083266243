/// @file test_rigid_intervals.c
/// Bodies that collide when there is no work left for contact in the system, so that they move as rigid ones: momentum
/// and angular momentum are what floors make of them, and there is no more energy than before.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>

#include "recipe.h"
#include "support.h"

#define DT (1.0 / 64)

enum { MOST = 256 };

/// Beams of 12x3 around (40, -17), across each other and thrown together. The last one falls flat.
static recipe thrown_beams(uint64_t *seed, uint32_t loose, float fall) {
    recipe made = {0};
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {1e11, 1e11}, .damping = {1e7, 1e7}};
    for (int i = 0; i < 4; i++) {
        const uint32_t first = made.particle_count;
        const double angle = 0.9 * (i - 3) - 0.6435, x = 40 + 3 * i, y = -17 + 4.0 * i;
        recipe_lattice(&made, 12, 3, -5.5, -1, 1, &stuff, seed);
        for (uint32_t p = first; p < made.particle_count; p++) {
            mspring_particle_def *at = &made.particles[p];
            const double px = at->x, py = at->y;
            at->x = x + cos(angle) * px - sin(angle) * py;
            at->y = y + sin(angle) * px + cos(angle) * py;
            at->vx = 20.0f - 10.0f * (float)i;
            at->vy = 40.0f - 30.0f * (float)i - fall;
        }
    }
    for (uint32_t i = 0; i < loose; i++) {
        const mspring_id p = recipe_particle(&made, support_random_between(seed, 30, 60),
                                             support_random_between(seed, -20, 0), 3, 0);
        made.particles[p].vx = (float)support_random_between(seed, -30, 30);
        made.particles[p].vy = (float)support_random_between(seed, -30, 30);
    }
    return made;
}

static mspring_network *network_of(const recipe *made, mspring_solver solver, bool has_floor) {
    mspring_network_def def = support_def(0, 1);
    def.settings.solver = solver;
    def.settings.guard = MSPRING_GUARD_CLAMP;
    mspring_network *network = recipe_network(made, &def);
    mspring_settings settings = support_solver(network);
    settings.most_work = 1;
    check_ok(support_set_solver(network, &settings));
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = 0.3;
    contact.friction = 0.5f;
    check_ok(mspring_network_set_contact(network, &contact));
    const double slope[] = {37, -21, 0.6, 0.8};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = slope;
    floor.plane_count = 1;
    floor.friction = 0.5f;
    if (has_floor)
        check_ok(mspring_network_set_floor(network, &floor));
    return network;
}

/// Momentum, N s, and angular momentum about the origin, J s; and what they could be, with all speeds in one direction.
typedef struct motion {
    double px, py, spin, most, most_spin;
} motion;

static motion motion_of(const mspring_network *network, const recipe *made) {
    motion m = {0};
    for (uint32_t i = 0; i < made->particle_count; i++) {
        const double mass = (double)made->particles[i].mass;
        const support_point at = support_position(network, i), v = support_velocity(network, i);
        m.px += mass * v.x;
        m.py += mass * v.y;
        m.spin += mass * (at.x * v.y - at.y * v.x);
        m.most += mass * hypot(v.x, v.y);
        m.most_spin += mass * hypot(at.x, at.y) * hypot(v.x, v.y);
    }
    return m;
}

/// The slope pushes each particle, and friction takes at most its share of that.
static void check_friction(double x, double y) {
    const double across = 0.6 * x + 0.8 * y, along = 0.6 * y - 0.8 * x;
    assert_true(fabs(along) <= 0.5 * across + 1e-3);
}

/// Check it against that before a step. Returns the floor's impulse, N s.
static double check_motion(const mspring_network *network, const recipe *made, const motion *before, bool has_floor) {
    const motion now = motion_of(network, made);
    float x[MOST] = {0}, y[MOST] = {0};
    double px = before->px, py = before->py, given = 0;
    const mspring_column columns[] = {{MSPRING_FLOOR_IMPULSE_X, 1, x}, {MSPRING_FLOOR_IMPULSE_Y, 1, y}};
    if (has_floor)
        check_ok(mspring_network_get_columns(network, NULL, 0, made->particle_count, columns, 2));
    for (uint32_t i = 0; i < made->particle_count; i++) {
        px += (double)x[i];
        py += (double)y[i];
        given += hypot((double)x[i], (double)y[i]);
        check_friction((double)x[i], (double)y[i]);
    }
    check_near(now.px, px, 1e-7 * before->most);
    check_near(now.py, py, 1e-7 * before->most);
    if (!has_floor)
        check_near(now.spin, before->spin, 1e-7 * before->most_spin);
    return given;
}

static void play(mspring_solver solver, uint32_t loose, bool has_floor) {
    uint64_t seed = 3;
    recipe made = thrown_beams(&seed, loose, has_floor ? 30 : 0);
    assert_true(made.particle_count <= MOST);
    mspring_network *network = network_of(&made, solver, has_floor);
    const double had = support_energy_of_motion(network);
    double given = 0;
    uint32_t spent = 0;
    for (int step = 0; step < 20; step++) {
        const motion before = motion_of(network, &made);
        check_ok(mspring_network_step(network, DT));
        spent += (support_step_flags(network) & MSPRING_STEP_FEWER) != 0;
        given += check_motion(network, &made, &before, has_floor);
        assert_true(support_energy_of_motion(network) <= 1.001 * had);
    }
    print_message("solver %d, %u loose particles: %u steps spent\n", (int)solver, (unsigned)loose, (unsigned)spent);
    assert_true(spent > 5 && (given > 1000) == has_floor);
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void free_bodies_keep_their_momentum(void **state) {
    (void)state;
    play(MSPRING_SOLVER_IMPLICIT, 0, false);
    play(MSPRING_SOLVER_DIRECT, 0, false);
}

static void loose_particles_take_what_bodies_give(void **state) {
    (void)state;
    play(MSPRING_SOLVER_IMPLICIT, 20, false);
    play(MSPRING_SOLVER_DIRECT, 20, false);
}

static void floors_are_told_what_they_give(void **state) {
    (void)state;
    play(MSPRING_SOLVER_IMPLICIT, 0, true);
    play(MSPRING_SOLVER_DIRECT, 20, true);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_bodies_keep_their_momentum),
        cmocka_unit_test(loose_particles_take_what_bodies_give),
        cmocka_unit_test(floors_are_told_what_they_give),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

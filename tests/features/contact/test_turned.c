/// @file test_turned.c
/// Scenes of bodies, loose particles, floors and colliders go as they do when all of it is turned by a right angle, or
/// seen in a mirror, with each solver: no axis, no sign and no end of an edge is treated in another way.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include "recipe.h"
#include "support.h"

enum { STEPS = 48, MOST_PARTICLES = 128, PLANES = 2, POINTS = 3, KNOTS = 12 };
#define DT (1.0 / 64)
#define THICKNESS 0.4

/// Where a field of heights is in a mirror its knots are reckoned from its other end.
#define HEIGHTS_TOLERANCE 1e-9

/// Of steps that are not explicit: m, N s and N m s, in all but a few.
#define PLACE_TOLERANCE 2e-5
#define PUSH_TOLERANCE 2e-3
#define TURN_TOLERANCE 0.1
#define MOST_OTHERS 4

/// A map of the plane to itself that floats bear without rounding: x' = xx x + xy y and so on.
typedef struct view {
    const char *name;
    double xx, xy, yx, yy;
} view;

static const view plain = {"plain", 1, 0, 0, 1};
static const view views[] = {{"turned", 0, -1, 1, 0}, {"mirrored", -1, 0, 0, 1}, {"on its head", -1, 0, 0, -1}};

static support_point seen(const view *v, double x, double y) {
    return (support_point){v->xx * x + v->xy * y, v->yx * x + v->yy * y};
}

/* ---------------------------------------------------------------------------------------------------- the scene */

typedef struct scene {
    recipe made;
    double x, y; ///< of the lowest block on the left
    double planes[PLANES][4], points[POINTS][2], way[2], turn;
    uint32_t plane_count;
    bool has_heights;
    float heights[KNOTS], gravity[2], friction, restitution;
    mspring_solver solver;
    uint32_t substeps;
    mspring_guard guard;
} scene;

static void add_block(scene *s, double x, double y, double speed, bool is_soft, uint64_t *seed) {
    const double mass = pow(10, support_random_between(seed, -1, 1)),
                 k = mass * (is_soft ? 20 : support_random_between(seed, 2e3, 2e4));
    const recipe_stuff stuff = {.mass = {mass, 2 * mass}, .stiffness = {k, 2 * k}, .damping = {0.2 * mass, 2 * mass}};
    const uint32_t first = s->made.particle_count, width = 2 + (uint32_t)support_random_between(seed, 0, 2.99),
                   height = is_soft ? 3 : 1 + (uint32_t)support_random_between(seed, 0, 2.99);
    const double vx = support_random_between(seed, -speed, speed), vy = support_random_between(seed, -speed, speed);
    recipe_lattice(&s->made, width, height, x, y, 1, &stuff, seed);
    for (uint32_t p = first; p < s->made.particle_count; p++) {
        s->made.particles[p].vx = (float)vx;
        s->made.particles[p].vy = (float)vy;
        s->made.particles[p].x += support_random_between(seed, -0.02, 0.02);
        s->made.particles[p].y += support_random_between(seed, -0.02, 0.02);
    }
}

static void add_bodies(scene *s, bool is_soft, uint64_t *seed) {
    const double speed = is_soft ? 20 : support_random_between(seed, 1, 8);
    for (int column = 0; column < 2; column++)
        for (int row = 0; row < 3; row++)
            add_block(s, s->x + 4.3 * column + support_random_between(seed, -0.1, 0.1),
                      s->y + 2.55 * row + support_random_between(seed, -0.2, 0.2), speed, is_soft, seed);
    for (int i = 0; i < 4; i++) {
        const mspring_id p = recipe_particle(&s->made, s->x - 0.7 + 2.5 * i, s->y - 0.8 + 0.1 * i, 0.5, 0);
        s->made.particles[p].vx = (float)support_random_between(seed, -speed, speed);
        s->made.particles[p].vy = (float)support_random_between(seed, -speed, speed);
    }
}

static void place_surroundings(scene *s, uint64_t *seed) {
    for (int i = 0; i < PLANES; i++) {
        const double angle = i == 0 ? support_random_between(seed, 1.2, 1.9) : support_random_between(seed, -0.3, 0.3);
        s->planes[i][0] = s->x - (i == 0 ? -3 : 2.2);
        s->planes[i][1] = s->y - (i == 0 ? 2.2 : -3);
        s->planes[i][2] = cos(angle);
        s->planes[i][3] = sin(angle);
    }
    for (int i = 0; i < KNOTS; i++)
        s->heights[i] = (float)(s->y - 1 - support_random_between(seed, 0, 1.5));
    for (int i = 0; i < POINTS; i++) {
        s->points[i][0] = s->x + 9 - (i == 0 ? 4 : 0) + support_random_between(seed, -0.3, 0.3);
        s->points[i][1] = s->y - 1.2 + (i == 2 ? 4 : 0) + support_random_between(seed, -0.3, 0.3);
    }
    s->way[0] = support_random_between(seed, -2, 0.2) * DT;
    s->way[1] = support_random_between(seed, -0.2, 1) * DT;
    s->turn = support_random_between(seed, -0.01, 0.01) / 64;
}

/// Let all of a scene fly, with nothing that stands still.
static void let_fly(scene *s, uint64_t *seed) {
    const double vx = support_random_between(seed, -100, 100), vy = support_random_between(seed, -100, 100);
    for (uint32_t p = 0; p < s->made.particle_count; p++) {
        s->made.particles[p].vx += (float)vx;
        s->made.particles[p].vy += (float)vy;
    }
    s->way[0] += vx * DT;
    s->way[1] += vy * DT;
    s->plane_count = 0;
}

/// Two columns of blocks, some of which overlap at the start, and loose particles between two planes, with an angle
/// that moves and turns below.
static scene make_scene(uint64_t seed, bool has_heights) {
    scene s = {.solver = (mspring_solver)(seed % 3), .substeps = seed % 3 ? 4 : 24, .plane_count = PLANES};
    const bool is_soft = seed % 5 == 4, flies = !has_heights && seed % 4 == 2;
    s.guard = seed % 6 == 3 ? MSPRING_GUARD_CLAMP : support_guard_of(s.solver);
    s.friction = seed % 2 ? 0.4f : 0;
    s.restitution = seed % 4 < 2 ? 0 : (float)support_random_between(&seed, 0.3, 1);
    s.has_heights = has_heights;
    s.x = floor(support_random_between(&seed, -40, 40));
    s.y = floor(support_random_between(&seed, -40, 40));
    s.gravity[0] = (float)support_random_between(&seed, -9, 9);
    s.gravity[1] = (float)support_random_between(&seed, -20, 0);
    add_bodies(&s, is_soft, &seed);
    place_surroundings(&s, &seed);
    if (flies)
        let_fly(&s, &seed);
    return s;
}

static mspring_network *network_of(const scene *s, const view *v) {
    recipe made = {0};
    for (uint32_t p = 0; p < s->made.particle_count; p++) {
        const mspring_particle_def *from = &s->made.particles[p];
        const support_point at = seen(v, from->x, from->y), speed = seen(v, (double)from->vx, (double)from->vy);
        (void)recipe_particle(&made, at.x, at.y, (double)from->mass, from->flags);
        made.particles[p].vx = (float)speed.x;
        made.particles[p].vy = (float)speed.y;
    }
    for (uint32_t i = 0; i < s->made.spring_count; i++) {
        const mspring_spring_def *from = &s->made.springs[i];
        (void)recipe_spring(&made, from->a, from->b, (double)from->stiffness, (double)from->damping, from->flags);
    }
    const support_point down = seen(v, (double)s->gravity[0], (double)s->gravity[1]);
    mspring_network_def def = support_def((float)down.y, s->substeps);
    def.settings.gravity_x = (float)down.x;
    def.settings.solver = s->solver;
    def.settings.guard = s->guard;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

static void add_surroundings(mspring_network *network, const scene *s, const view *v) {
    double planes[PLANES][4], points[POINTS][2];
    float heights[KNOTS];
    mspring_floor_def floor;
    mspring_contact_def contact;
    mspring_collider_def collider;
    for (int i = 0; i < PLANES; i++) {
        const support_point at = seen(v, s->planes[i][0], s->planes[i][1]), up = seen(v, s->planes[i][2], s->planes[i][3]);
        const double plane[] = {at.x, at.y, up.x, up.y};
        for (int j = 0; j < 4; j++)
            planes[i][j] = plane[j];
    }
    for (int i = 0; i < POINTS; i++) {
        const support_point at = seen(v, s->points[i][0], s->points[i][1]);
        points[i][0] = at.x;
        points[i][1] = at.y;
    }
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = planes[0], floor.plane_count = s->plane_count;
    if (s->has_heights) {
        for (int i = 0; i < KNOTS; i++)
            heights[i] = s->heights[v->xx < 0 ? KNOTS - 1 - i : i];
        floor.heights = heights, floor.height_count = KNOTS, floor.spacing = 2;
        floor.heights_x = v->xx < 0 ? -(s->x - 5 + 2 * (KNOTS - 1)) : s->x - 5;
    }
    floor.friction = s->friction, floor.restitution = s->restitution;
    if (s->plane_count > 0 || s->has_heights)
        check_ok(mspring_network_set_floor(network, &floor));
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = THICKNESS;
    contact.friction = s->friction, contact.restitution = s->restitution;
    check_ok(mspring_network_set_contact(network, &contact));
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &collider, sizeof collider));
    collider.points = points[0], collider.point_count = POINTS;
    collider.friction = s->friction, collider.restitution = s->restitution;
    check_ok(mspring_network_add_collider(network, &collider, NULL));
}

/* --------------------------------------------------------------------------------------------------- comparing */

// Put everything of a network where it is in another.
static void follow(mspring_network *network, const mspring_network *other, const view *v, uint32_t count) {
    double x[MOST_PARTICLES], y[MOST_PARTICLES];
    float vx[MOST_PARTICLES], vy[MOST_PARTICLES];
    for (mspring_id p = 0; p < count; p++) {
        const support_point from = support_position(other, p), by = support_velocity(other, p);
        const support_point at = seen(v, from.x, from.y), speed = seen(v, by.x, by.y);
        x[p] = at.x, y[p] = at.y;
        vx[p] = (float)speed.x, vy[p] = (float)speed.y;
    }
    check_ok(mspring_network_set_positions(network, NULL, 0, count, x, y, 1));
    check_ok(mspring_network_set_velocities(network, NULL, 0, count, vx, vy, 1));
}

static double sense_of(const view *v) {
    return v->xx * v->yy - v->xy * v->yx;
}

static double distance(const view *v, support_point a, support_point b) {
    const support_point at = seen(v, a.x, a.y);
    return hypot(at.x - b.x, at.y - b.y);
}

/// What two networks differ by: places, m, and how much the collider was pushed and turned, N s and N m s.
typedef struct difference {
    double places, push, turn;
} difference;

static difference difference_of(const scene *s, const mspring_network *network, const mspring_network *other,
                                const view *v) {
    difference d = {0, 0, 0};
    support_point push, pushed;
    double turn, turned;
    for (mspring_id p = 0; p < s->made.particle_count; p++) {
        d.places = fmax(d.places, distance(v, support_position(network, p), support_position(other, p)));
        d.places = fmax(d.places, DT * distance(v, support_velocity(network, p), support_velocity(other, p)));
    }
    check_ok(mspring_network_get_collider_impulse(network, 0, &push.x, &push.y, &turn));
    check_ok(mspring_network_get_collider_impulse(other, 0, &pushed.x, &pushed.y, &turned));
    d.push = distance(v, push, pushed);
    d.turn = fabs(sense_of(v) * turn - turned);
    return d;
}

/// Explicit steps have the same bits, others those of another order of sums. So these begin where the first network
/// is; a few decide on the other side of a threshold.
static void compare(uint64_t seed, const view *v, bool has_heights) {
    scene s = make_scene(seed, has_heights);
    mspring_network *network = network_of(&s, &plain), *other = network_of(&s, v);
    uint32_t others = 0;
    add_surroundings(network, &s, &plain);
    add_surroundings(other, &s, v);
    for (int step = 1; step <= STEPS; step++) {
        const support_point at = seen(v, step * s.way[0], step * s.way[1]);
        check_ok(mspring_network_move_collider(network, 0, step * s.way[0], step * s.way[1], step * s.turn));
        check_ok(mspring_network_move_collider(other, 0, at.x, at.y, sense_of(v) * step * s.turn));
        check_ok(mspring_network_step(network, DT));
        check_ok(mspring_network_step(other, DT));
        const difference d = difference_of(&s, network, other, v);
        if (s.solver != MSPRING_SOLVER_EXPLICIT) {
            others += !(d.places <= PLACE_TOLERANCE && d.push <= PUSH_TOLERANCE && d.turn <= TURN_TOLERANCE);
            follow(other, network, v, s.made.particle_count);
            follow(network, network, &plain, s.made.particle_count);
        } else if (has_heights) {
            assert_true(d.places <= HEIGHTS_TOLERANCE && d.push <= HEIGHTS_TOLERANCE && d.turn <= HEIGHTS_TOLERANCE);
        } else {
            assert_true(d.places == 0 && d.push == 0 && d.turn == 0);
        }
    }
    if (others > MOST_OTHERS)
        fail_msg("seed %u, %s: %u steps differ", (unsigned)seed, v->name, others);
    mspring_network_destroy(network);
    mspring_network_destroy(other);
    recipe_free(&s.made);
}

static void all_views_are_alike(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < ROUNDS(24); seed++)
        for (size_t i = 0; i < COUNT_OF(views); i++)
            compare(seed, &views[i], false);
}

/// A field of heights can be seen in a mirror only.
static void heights_are_alike_in_a_mirror(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < ROUNDS(24); seed++)
        compare(seed, &views[1], true);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_views_are_alike),
                                       cmocka_unit_test(heights_are_alike_in_a_mirror)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/// @file test_colliders.c
/// Colliders of the host against what is known of them: bounces, friction, weight, both momenta, and that nothing
/// gets through at any speed.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bodies.h"

#define THICKNESS 0.5
#define DT (1.0 / 64)
#define PI 3.14159265358979323846

static void report(const char *format, ...) {
    va_list values;
    va_start(values, format);
    if (getenv("CONTACT_REPORT"))
        vprintf(format, values);
    va_end(values);
}

static mspring_collider_def shape(mspring_collider_kind kind, double x, double y, double angle) {
    mspring_collider_def def;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    def.kind = kind;
    def.x = x;
    def.y = y;
    def.angle = angle;
    return def;
}

static mspring_collider_def box(double width, double height, double x, double y, double angle) {
    mspring_collider_def def = shape(MSPRING_COLLIDER_BOX, x, y, angle);
    def.width = width;
    def.height = height;
    return def;
}

static mspring_collider_def circle(double radius, double x, double y) {
    mspring_collider_def def = shape(MSPRING_COLLIDER_CIRCLE, x, y, 0);
    def.radius = radius;
    return def;
}

static mspring_collider_def chain(const double *points, uint32_t count, uint32_t flags) {
    mspring_collider_def def = shape(MSPRING_COLLIDER_CHAIN, 0, 0, 0);
    def.points = points;
    def.point_count = count;
    def.flags = flags;
    return def;
}

static mspring_id add(mspring_network *network, const mspring_collider_def *def) {
    mspring_id id = MSPRING_NONE;
    check_ok(mspring_network_add_collider(network, def, &id));
    return id;
}

static double mean(const bodies *b, const double *values, uint32_t first) {
    double sum = 0;
    for (uint32_t p = first; p < b->count; p++)
        sum += values[p];
    return sum / (b->count - first);
}

/* ------------------------------------------------------------------------------------------------------ bounce */

/// A particle without springs that falls 5 m onto what is at y = -THICKNESS comes back with this part of its speed.
static void check_bounce(const mspring_collider_def *def, double x) {
    const uint32_t substeps = 120;
    bodies *b = bodies_begin(DT / substeps);
    const uint32_t ball =
        bodies_add(b, &(bodies_lattice){.width = 1, .height = 1, .x = x, .y = 5, .spacing = 1, .mass = 3});
    const mspring_network_def network_def = support_def(-9.8f, substeps);
    mspring_network *network = bodies_network(b, &network_def);
    check_ok(bodies_touch(network, THICKNESS, 0.5f, 0));
    (void)add(network, def);
    double low = 5, high = 0;
    bool is_back = false;
    for (int step = 0; step < 130; step++) {
        support_steps(network, 1, DT);
        low = fmin(low, support_position(network, ball).y);
        is_back |= support_velocity(network, ball).y > 0;
        high = is_back ? fmax(high, support_position(network, ball).y) : high;
    }
    report("kind %d, restitution %.2f: back with %.4f of its speed\n", (int)def->kind, (double)def->restitution,
           sqrt(high / 5));
    assert_true(low > -1e-3);
    check_near(sqrt(high / 5), (double)def->restitution, 0.01);
    mspring_network_destroy(network);
    bodies_free(b);
}

static void loose_particles_bounce(void **state) {
    (void)state;
    const double line[4] = {-3, -THICKNESS, 4, -THICKNESS};
    for (int i = 0; i < 3; i++) {
        mspring_collider_def defs[4] = {box(6, 2, 0, -THICKNESS - 1, 0), circle(2, 0, -THICKNESS - 2),
                                        chain(line, 2, 0), box(6, 1, 0, -THICKNESS - 1, PI)};
        defs[3].radius = 0.5;
        for (int k = 0; k < 4; k++) {
            defs[k].restitution = i == 0 ? 0.5f : i == 1 ? 0.8f : 1.0f;
            check_bounce(&defs[k], k == 1 ? 0 : 0.3);
        }
    }
}

/// A wall that comes at 10 m/s throws a ball at rest to 20 m/s, and to 10 m/s without restitution.
static void moving_walls_throw(void **state) {
    (void)state;
    for (int bounces = 0; bounces < 2; bounces++) {
        bodies *b = bodies_begin(DT / 40);
        const uint32_t ball = bodies_add(b, &(bodies_lattice){.width = 1, .height = 1, .spacing = 1, .mass = 3});
        const mspring_network_def def = support_def(0, 40);
        mspring_network *network = bodies_network(b, &def);
        check_ok(bodies_touch(network, THICKNESS, 0, 0));
        mspring_collider_def wall = box(2, 2, -5, 0.3, 0);
        wall.restitution = (float)bounces;
        const mspring_id id = add(network, &wall);
        double given = 0;
        for (int step = 1; step <= 40; step++) {
            double x, y, angular;
            check_ok(mspring_network_move_collider(network, id, -5 + 10 * DT * step, 0.3, 0));
            support_steps(network, 1, DT);
            check_ok(mspring_network_get_collider_impulse(network, id, &x, &y, &angular));
            given -= x;
        }
        check_near(support_velocity(network, ball).x, bounces ? 20 : 10, 1e-4);
        check_near(given, 3 * (bounces ? 20 : 10), 1e-3);
        mspring_network_destroy(network);
        bodies_free(b);
    }
}

/* ---------------------------------------------------------------------------------------------------- friction */

/// How far a block comes in 3 s down a slope of so many times what friction bears, and how fast it is then.
static void slide(double share, double *way, double *speed) {
    const double friction = 0.5, angle = atan(friction * share), u = cos(angle), v = -sin(angle);
    const double slope[8] = {-30 * u, -30 * v, 1, 1 * v / u, 17, 17 * v / u, 40 * u, 40 * v};
    bodies *b = bodies_begin(DT / 40);
    b->damping = 0.3;
    const double up = 1 + THICKNESS;
    const uint32_t first = bodies_add(b, &(bodies_lattice){.width = 8,
                                                           .height = 3,
                                                           .x = -15.3 * u - up * v,
                                                           .y = -15.3 * v + up * u,
                                                           .angle = -angle,
                                                           .spacing = 1,
                                                           .mass = 73.4,
                                                           .f = 0.5});
    const mspring_network_def network_def = support_def(-9.8f, 40);
    mspring_network *network = bodies_network(b, &network_def);
    check_ok(bodies_touch(network, THICKNESS, 0, 0));
    mspring_collider_def def = chain(slope, 4, 0);
    def.friction = (float)friction;
    (void)add(network, &def);
    support_steps(network, 64, DT);
    (void)bodies_measured(b, network);
    const double from = u * mean(b, b->x, first) + v * mean(b, b->y, first);
    support_steps(network, 3 * 64, DT);
    (void)bodies_measured(b, network);
    *way = u * mean(b, b->x, first) + v * mean(b, b->y, first) - from;
    *speed = 0;
    for (uint32_t p = first; p < b->count; p++)
        *speed += (u * (double)b->vx[p] + v * (double)b->vy[p]) / (b->count - first);
    mspring_network_destroy(network);
    bodies_free(b);
}

static void block_slides_at_its_friction_angle(void **state) {
    (void)state;
    double way, speed;
    slide(0.95, &way, &speed);
    report("slope 0.95: %.5f m, %.5f m/s\n", way, speed);
    assert_true(fabs(way) < 0.001);
    slide(1.03, &way, &speed);
    report("slope 1.03: %.5f m, %.5f m/s\n", way, speed);
    assert_true(way > 0.1);
    slide(1.2, &way, &speed);
    const double angle = atan(0.5 * 1.2), expected = 4 * 9.8 * (sin(angle) - 0.5 * cos(angle));
    report("slope 1.2: %.5f m, %.5f m/s of %.5f\n", way, speed, expected);
    check_near(speed, expected, 0.03 * expected);
}

/// Circles and rounded boxes that spin carry a beam along at the speed of their surface, and feel its drag.
static void spinning_rollers_carry(void **state) {
    (void)state;
    const double radius = 1.5, spin = -2;
    bodies *b = bodies_begin(DT / 40);
    b->damping = 0.3;
    const uint32_t first = bodies_add(
        b, &(bodies_lattice){
               .width = 30, .height = 3, .y = 1 + THICKNESS, .x = 0.2, .spacing = 1, .mass = 20, .f = 0.5});
    const mspring_network_def network_def = support_def(-9.8f, 40);
    mspring_network *network = bodies_network(b, &network_def);
    check_ok(bodies_touch(network, THICKNESS, 0, 0));
    mspring_id ids[4];
    for (int i = 0; i < 4; i++) {
        mspring_collider_def def = circle(radius, -9 + 6 * i, -radius);
        def.friction = 0.6f;
        ids[i] = add(network, &def);
    }
    double angular = 0, vx = 0, way = 0;
    for (int step = 1; step <= 64; step++) {
        for (int i = 0; i < 4; i++)
            check_ok(mspring_network_move_collider(network, ids[i], -9 + 6 * i, -radius, spin * DT * step));
        support_steps(network, 1, DT);
        for (int i = 0; i < 4; i++) {
            double x, y, turn;
            check_ok(mspring_network_get_collider_impulse(network, ids[i], &x, &y, &turn));
            angular += turn;
        }
    }
    const bodies_measure m = bodies_measured(b, network);
    for (uint32_t p = first; p < b->count; p++)
        vx += (double)b->vx[p] / b->count, way = mean(b, b->y, first);
    report("rollers: %.4f m/s of %.4f, angular impulse %.3f N m s, momentum %.3f, at %.4f m\n", vx, -spin * radius,
           angular, m.x, way);
    check_near(vx, -spin * radius, 0.01);
    check_near(angular, m.x * radius,
               1e-3 * fabs(angular)); // what drives the beam to the right turns them to the left
    mspring_network_destroy(network);
    bodies_free(b);
}

/* ------------------------------------------------------------------------------------------------------ impulses
 */

/// A block that lies on a box and a circle gives them its weight.
static void colliders_bear_weight(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / 40);
    b->damping = 0.3;
    (void)bodies_add(
        b, &(bodies_lattice){.width = 14, .height = 3, .y = 1 + THICKNESS, .spacing = 1, .mass = 10, .f = 0.5});
    mspring_network_def def = support_def(-9.8f, 40);
    def.settings.global_damping = 1;
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0, 0));
    const mspring_collider_def defs[2] = {box(2, 1, -4, -0.5, 0), circle(2, 4, -2)};
    const mspring_id ids[2] = {add(network, &defs[0]), add(network, &defs[1])};
    support_steps(network, 400, DT);
    double sum = 0, angular[2] = {0, 0};
    for (int step = 0; step < 32; step++) {
        support_steps(network, 1, DT);
        for (int i = 0; i < 2; i++) {
            double x, y, turn;
            check_ok(mspring_network_get_collider_impulse(network, ids[i], &x, &y, &turn));
            sum += y;
            angular[i] += turn;
        }
    }
    report("weight %.4f N of %.4f, turned by %.5f\n", -sum / (32 * DT), b->count * 10 * 9.8, angular[1]);
    check_near(-sum / (32 * DT), b->count * 10 * 9.8, 2e-3 * b->count * 10 * 9.8);
    check_near(angular[1], 0, 1e-6 * fabs(sum)); // a circle without friction is not turned
    mspring_network_destroy(network);
    bodies_free(b);
}

/// A rigid body, in twenty lines.
typedef struct rigid {
    mspring_id collider;
    double mass, inertia, x, y, angle, vx, vy, spin;
} rigid;

static void step_with(mspring_network *network, rigid *body, double dt) {
    double x, y, angular;
    body->x += dt * body->vx;
    body->y += dt * body->vy;
    body->angle += dt * body->spin;
    check_ok(mspring_network_move_collider(network, body->collider, body->x, body->y, body->angle));
    support_steps(network, 1, dt);
    check_ok(mspring_network_get_collider_impulse(network, body->collider, &x, &y, &angular));
    body->vx += x / body->mass;
    body->vy += y / body->mass;
    body->spin += angular / body->inertia;
}

/// A body hits a lattice off its middle and bounces, in steps of so many substeps. Returns the most energy of the
/// whole over that at first.
static double ram(const mspring_collider_def *def, uint32_t substeps) {
    bodies *b = bodies_begin(DT / 40);
    (void)bodies_add(b, &(bodies_lattice){.width = 16, .height = 5, .spacing = 1, .mass = 4, .f = 0.3});
    const mspring_network_def network_def = support_def(0, substeps);
    mspring_network *network = bodies_network(b, &network_def);
    check_ok(bodies_touch(network, THICKNESS, 0, 0));
    rigid body = {.collider = add(network, def), .mass = 600, .inertia = 800, .x = 5, .y = 7, .angle = 0.4};
    body.vy = -12;
    body.spin = 1.5;
    const double momentum = body.mass * body.vy, turn = body.mass * body.x * body.vy + body.inertia * body.spin;
    const double energy = 0.5 * (body.mass * body.vy * body.vy + body.inertia * body.spin * body.spin);
    double worst = 0, most = 0, now = 0;
    for (uint32_t step = 0; step < 60 * 40 / substeps; step++) {
        step_with(network, &body, DT * substeps / 40);
        const bodies_measure m = bodies_measured(b, network);
        const double x = m.x + body.mass * body.vx, y = m.y + body.mass * body.vy;
        const double all = m.turn + body.mass * (body.x * body.vy - body.y * body.vx) + body.inertia * body.spin;
        worst =
            fmax(worst, fmax(fmax(fabs(x), fabs(y - momentum)) / fabs(momentum), fabs(all - turn) / fabs(turn)));
        now = m.energy +
              0.5 * (body.mass * (body.vx * body.vx + body.vy * body.vy) + body.inertia * body.spin * body.spin);
        most = fmax(most, now);
    }
    report("rigid, %2u substeps: momenta within %.2g, energy at most %.4f, then %.4f, spin %.3f, v (%.3f, %.3f)\n",
           substeps, worst, most / energy, now / energy, body.spin, body.vx, body.vy);
    assert_true(worst < 1e-6);
    assert_true(fabs(body.vy + 12) > 1);
    mspring_network_destroy(network);
    bodies_free(b);
    return most / energy;
}

/// Both momenta of a rigid body and a lattice are kept. Impulses are exact, so what is lost is the rounding of
/// velocities to float, 6e-8 of each in each substep with contact. In a step nothing slows the body down. So it
/// gives more energy than it has, and the less of it the shorter the steps are.
static void rigid_body_keeps_both_momenta(void **state) {
    (void)state;
    for (int i = 0; i < 3; i++) {
        mspring_collider_def def = box(3, 2, 5, 7, 0.4);
        def.kind = i == 2 ? MSPRING_COLLIDER_CIRCLE : MSPRING_COLLIDER_BOX;
        def.radius = i == 0 ? 0 : i == 1 ? 0.3 : 1.5;
        def.friction = 0.4f;
        def.restitution = 0.3f;
        assert_true(ram(&def, 40) < 1.4);
        assert_true(ram(&def, 5) < 1.05);
        assert_true(ram(&def, 1) < 1.005);
    }
}

/* ------------------------------------------------------------------------------------------------ nothing passes
 */

/// A circle of 0.2 m comes at a pinned rope. The rope is carried along, so its middle is always ahead of it.
static void fast_circle_does_not_pass_a_thin_rope(void **state) {
    (void)state;
    const double speeds[] = {5, 100, 1000};
    for (int i = 0; i < 3; i++)
        for (uint32_t substeps = 10; substeps <= 40; substeps += 30) {
            const uint32_t count = 21;
            bodies *b = bodies_begin(DT / 40);
            (void)bodies_add(
                b, &(bodies_lattice){
                       .width = count, .height = 1, .angle = PI / 2, .spacing = 1, .mass = 0.1, .f = 0.05});
            mspring_network_def def = support_def(0, substeps);
            mspring_network *network = bodies_network(b, &def);
            check_ok(bodies_touch(network, 0.05, 0.2f, 0));
            const mspring_collider_def ball = circle(0.2, -3, 0.4);
            const mspring_id id = add(network, &ball);
            for (int step = 1; step == 1 || (step - 1) * DT * speeds[i] < 5; step++) {
                const double x = -3 + speeds[i] * DT * step;
                check_ok(mspring_network_move_collider(network, id, x, 0.4, 0));
                support_steps(network, 1, DT);
                (void)bodies_measured(b, network);
                // Where the rope crosses the line y = 0.4, it is ahead of the circle, or has not been reached.
                for (uint32_t p = 0; p + 1 < count; p++)
                    if ((b->y[p] < 0.4) != (b->y[p + 1] < 0.4)) {
                        const double at =
                            b->x[p] + (b->x[p + 1] - b->x[p]) * (0.4 - b->y[p]) / (b->y[p + 1] - b->y[p]);
                        assert_true(at > x + 0.2);
                    }
            }
            assert_true(b->x[10] > 1);
            mspring_network_destroy(network);
            bodies_free(b);
        }
}

/// A bar of any angle sweeps along its normal, at 1 to 3,000 m/s. Bodies of masses up to 1:1000 that come flying at
/// it stay in front of it, and it presses none through another.
static void nothing_passes_a_sweeping_bar(void **state) {
    (void)state;
    uint64_t seed = 11;
    double closest = 1;
    for (int trial = 0; trial < ROUNDS(300); trial++) {
        const double angle = support_random_between(&seed, 0, 6.28), nx = -sin(angle), ny = cos(angle);
        const double speed = pow(10, support_random_between(&seed, 0, 3.5)),
                     thickness = support_random_between(&seed, 0.05, 0.5);
        bodies *b = bodies_begin(DT / 10);
        for (uint32_t i = 0; i < 4; i++)
            (void)bodies_add(b, &(bodies_lattice){.width = 1 + 3 * (i % 3),
                                                  .height = 1 + (i == 2),
                                                  .x = 15 * nx + 8 * (i % 2),
                                                  .y = 15 * ny + 8 * (i / 2),
                                                  .angle = support_random_between(&seed, 0, 6),
                                                  .spacing = 1,
                                                  .mass = pow(10, support_random_between(&seed, -1, 2)),
                                                  .f = 0.1});
        const double towards = support_random_between(&seed, 0, 100);
        for (uint32_t p = 0; p < b->count; p++)
            b->vx[p] = (float)(-towards * nx), b->vy[p] = (float)(-towards * ny);
        const mspring_network_def network_def = support_def(0, 10 + 10 * (uint32_t)(trial % 4));
        mspring_network *network = bodies_network(b, &network_def);
        check_ok(bodies_touch(network, thickness, 0.3f, 0));
        mspring_collider_def def = box(400, 0.01, 0, 0, angle);
        const double line[4] = {-200, 0, 200, 0};
        if (trial % 2 == 0)
            def = chain(line, 2, 0);
        def.angle = angle;
        def.restitution = 0.1f * (float)(trial % 3);
        const mspring_id id = add(network, &def);
        for (int step = 1; step <= 2 || (step < 30 && speed * DT * step < 60); step++) {
            const double way = speed * DT * step;
            check_ok(mspring_network_move_collider(network, id, way * nx, way * ny, angle));
            support_steps(network, 1, DT);
            (void)bodies_measured(b, network);
            for (uint32_t p = 0; p < b->count; p++)
                closest = fmin(closest, ((b->x[p] - way * nx) * nx + (b->y[p] - way * ny) * ny) / thickness);
        }
        uint32_t crossings;
        (void)bodies_deepest(b, thickness, &crossings);
        assert_int_equal(crossings, 0);
        mspring_network_destroy(network);
        bodies_free(b);
    }
    report("bar: nothing nearer than %.3f of the thickness\n", closest);
    assert_true(closest > 0.9);
}

/// Whether a particle is inside the box.
static bool is_inside(const bodies *b, uint32_t p, double width, double height, double angle) {
    const double u = cos(angle) * b->x[p] + sin(angle) * b->y[p], v = cos(angle) * b->y[p] - sin(angle) * b->x[p];
    return fabs(u) < 0.5 * width && fabs(v) < 0.5 * height;
}

/// A box spins in a pile of fragments in a closed room, and squeezes them against its floor.
static void box_spins_in_a_pile(void **state) {
    (void)state;
    const double room[8] = {-14, 25, -14, -6, 14, -6, 14, 25};
    bodies *b = bodies_begin(DT / 40);
    uint64_t seed = 5;
    for (int i = 0; i < 24; i++)
        (void)bodies_add(b, &(bodies_lattice){.width = 2 + (uint32_t)(i % 3),
                                              .height = 2,
                                              .x = -10 + 4 * (i % 6),
                                              .y = 5 + 4 * (i / 6),
                                              .angle = support_random_between(&seed, 0, 6),
                                              .spacing = 1,
                                              .mass = 5,
                                              .f = 0.3});
    const mspring_network_def network_def = support_def(-9.8f, 40);
    mspring_network *network = bodies_network(b, &network_def);
    check_ok(bodies_touch(network, 0.4, 0.3f, 0));
    mspring_collider_def walls = chain(room, 4, MSPRING_COLLIDER_CLOSED), mill = box(9, 1.2, 0, 0, 0);
    walls.friction = mill.friction = 0.3f;
    (void)add(network, &walls);
    const mspring_id id = add(network, &mill);
    double turned = 0;
    for (int step = 1; step <= ROUNDS(600); step++) {
        const double angle = 4 * DT * step;
        double x, y, angular;
        check_ok(mspring_network_move_collider(network, id, 0, 0, angle));
        support_steps(network, 1, DT);
        check_ok(mspring_network_get_collider_impulse(network, id, &x, &y, &angular));
        turned += angular;
        (void)bodies_measured(b, network);
        for (uint32_t p = 0; p < b->count; p++) {
            assert_false(is_inside(b, p, 9, 1.2, angle));
            assert_true(fabs(b->x[p]) < 14 && b->y[p] > -6 && b->y[p] < 25);
        }
    }
    report("mill: angular impulse %.1f N m s\n", turned);
    assert_true(turned < -100); // it works against the pile
    mspring_network_destroy(network);
    bodies_free(b);
}

/// A closed chain with a corner that points inwards, which is shaken and turned. Of the bodies in it nothing
/// leaves.
static void closed_chain_is_a_container(void **state) {
    (void)state;
    enum { SIDES = 24 };
    double points[2 * SIDES];
    for (int i = 0; i < SIDES; i++) {
        const double radius = i == 6 ? 5 : 12, angle = 2 * PI * i / SIDES;
        points[2 * i] = radius * cos(angle);
        points[2 * i + 1] = radius * sin(angle);
    }
    bodies *b = bodies_begin(DT / 30);
    for (int i = 0; i < 5; i++)
        (void)bodies_add(b, &(bodies_lattice){.width = i < 3 ? 5 : 1,
                                              .height = i == 0 ? 3 : 1,
                                              .x = i < 3 ? -3 : 4,
                                              .y = -6 + 2.4 * i,
                                              .spacing = 1,
                                              .mass = 3,
                                              .f = 0.2});
    const mspring_network_def network_def = support_def(-9.8f, 30);
    mspring_network *network = bodies_network(b, &network_def);
    check_ok(bodies_touch(network, 0.4, 0.2f, 0));
    mspring_collider_def def = chain(points, SIDES, MSPRING_COLLIDER_CLOSED);
    def.friction = 0.3f;
    def.restitution = 0.5f;
    const mspring_id id = add(network, &def);
    double fastest = 0;
    for (int step = 1; step <= ROUNDS(2000); step++) {
        const double t = DT * step, x = 3 * sin(4 * t), y = 2 * sin(5.3 * t), angle = 2 * sin(t);
        check_ok(mspring_network_move_collider(network, id, x, y, angle));
        support_steps(network, 1, DT);
        const bodies_measure m = bodies_measured(b, network);
        fastest = fmax(fastest, m.fastest);
        for (uint32_t p = 0; p < b->count; p++) { // winding number of the chain around the particle
            double turns = 0, u = 0, v = 0;
            for (int i = 0; i <= SIDES; i++) {
                const double *local = points + 2 * (i % SIDES);
                const double px = x + cos(angle) * local[0] - sin(angle) * local[1] - b->x[p],
                             py = y + sin(angle) * local[0] + cos(angle) * local[1] - b->y[p];
                turns += i > 0 ? atan2(u * py - v * px, u * px + v * py) / (2 * PI) : 0;
                u = px, v = py;
            }
            check_near(turns, 1, 1e-6);
        }
    }
    report("container: up to %.1f m/s\n", fastest);
    mspring_network_destroy(network);
    bodies_free(b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loose_particles_bounce),
        cmocka_unit_test(moving_walls_throw),
        cmocka_unit_test(block_slides_at_its_friction_angle),
        cmocka_unit_test(spinning_rollers_carry),
        cmocka_unit_test(colliders_bear_weight),
        cmocka_unit_test(rigid_body_keeps_both_momenta),
        cmocka_unit_test(fast_circle_does_not_pass_a_thin_rope),
        cmocka_unit_test(nothing_passes_a_sweeping_bar),
        cmocka_unit_test(box_spins_in_a_pile),
        cmocka_unit_test(closed_chain_is_a_container),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/// @file families.c
/// How the cases of each family are drawn.
///
/// SPDX-License-Identifier: MIT
#include "map/draw.h"
#include "map/hold.h"
#include "map/meet.h"

#include <math.h>
#include <stdio.h>

#include "scenes/internal.h"

/// What tells families apart.
typedef struct family {
    const char *name;
    uint32_t size;
    void (*draw)(map_case *drawn, uint64_t *seed);
} family;

static double sign(uint64_t *seed) {
    return random_below(seed, 2) == 0 ? 1 : -1;
}

bool map_one_in(uint64_t *seed, uint32_t count) {
    return random_below(seed, count) == 0;
}

/* ------------------------------------------------------------------------------------------------------- parts */

static const double lengths[] = {1.0 / 240, 1.0 / 120, 1.0 / 64, 1.0 / 30, 0.1, 0.23, 0.25};
enum { LENGTHS = sizeof lengths / sizeof *lengths };

/// Solvers in turn, by the case's number, so that each family has as many of each.
static void draw_solver(map_case *drawn, uint64_t *seed) {
    static const double shares[] = {0.05, 0.1, 0.3, 0.5, 0.7, 0.86, 0.95};
    static const uint32_t substeps[] = {1, 1, 2, 4, 8, 16, 64, 256, 1024}, few[] = {1, 1, 1, 1, 2, 4, 16};
    mspring_settings *solver = &drawn->network.settings;
    const uint32_t turn = drawn->index % 8;
    drawn->dt = lengths[random_below(seed, LENGTHS)];
    drawn->steps = 20 + random_below(seed, 181);
    if (turn < 2) {
        drawn->share = shares[random_below(seed, sizeof shares / sizeof *shares)];
        solver->substeps = substeps[random_below(seed, sizeof substeps / sizeof *substeps)];
        return;
    }
    solver->solver = turn < 5 ? MSPRING_SOLVER_IMPLICIT : MSPRING_SOLVER_DIRECT;
    solver->integrator = (turn - 2) % 3;
    solver->substeps = few[random_below(seed, sizeof few / sizeof *few)];
    if (map_one_in(seed, 8))
        solver->iterations = 2 + random_below(seed, 20);
}

static map_stuff draw_stuff(uint64_t *seed) {
    static const double spreads[] = {1, 1, 1, 10}, dampers[] = {0, 0, 0, 0.01, 0.1, 1},
                        ratios[] = {1, 1, 1, 10, 1000}, spacings[] = {1, 1, 1, 0.1, 10};
    map_stuff stuff;
    stuff.stiffness = map_decades(seed, 1e3, 1e12);
    stuff.spread = spreads[random_below(seed, 4)];
    stuff.damping_ratio = dampers[random_below(seed, 6)];
    stuff.mass_ratio = ratios[random_below(seed, 5)];
    stuff.spacing = spacings[random_below(seed, 5)];
    return stuff;
}

map_stuff map_draw_begin(map_case *drawn, uint64_t *seed) {
    drawn->network = mspring_network_def_default();
    drawn->network.settings.gravity_y = 0;
    drawn->network.settings.guard = MSPRING_GUARD_GROWTH;
    draw_solver(drawn, seed);
    drawn->shape = (map_shape)random_below(seed, MAP_SHAPES);
    const map_stuff stuff = draw_stuff(seed);
    map_draw_body(&drawn->body, drawn->shape, &stuff, seed);
    return stuff;
}

void map_draw_velocities(map_case *drawn, double speed, uint64_t *seed) {
    for (uint32_t i = 0; i < drawn->body.particle_count; i++) {
        mspring_particle_def *def = &drawn->body.particles[i];
        def->vx = (float)map_between(seed, -speed, speed);
        def->vy = (float)map_between(seed, -speed, speed);
    }
}

/// Pin some particles. They move with the drift.
static void draw_pins(map_case *drawn, uint32_t most, uint64_t *seed) {
    for (uint32_t count = 1 + random_below(seed, most); count > 0; count--) {
        mspring_particle_def *def = &drawn->body.particles[random_below(seed, drawn->body.particle_count)];
        def->flags = MSPRING_PARTICLE_PINNED;
        def->vx = (float)drawn->drift_x;
        def->vy = (float)drawn->drift_y;
    }
}

static void draw_gravity(map_case *drawn, uint64_t *seed) {
    drawn->network.settings.gravity_y = map_one_in(seed, 8) ? -50.0f : -9.8f;
    if (map_one_in(seed, 8))
        drawn->network.settings.gravity_x = (float)map_between(seed, -5, 5);
}

static void draw_global_damping(map_case *drawn, uint64_t *seed) {
    if (map_one_in(seed, 8))
        drawn->network.settings.global_damping = (float)map_decades(seed, 0.1, 10);
}

/* ------------------------------------------------------------------------------------------------------ floors */

static void add_plane(map_case *drawn, double x, double y, double across_x, double across_y) {
    double *plane = drawn->planes[drawn->floor.plane_count++];
    plane[0] = x;
    plane[1] = y;
    plane[2] = across_x;
    plane[3] = across_y;
}

/// A plane (often a slope), a box that is open above, or heights below 0.
static void draw_floor(map_case *drawn, uint64_t *seed) {
    static const float restitutions[] = {0, 0, 0.3f, 0.6f, 0.94f, 1, 1}, frictions[] = {0, 0, 0.3f, 0.8f, 5};
    drawn->floor = mspring_floor_def_default();
    drawn->has_floor = true;
    drawn->floor.restitution = restitutions[random_below(seed, 7)];
    drawn->floor.friction = frictions[random_below(seed, 5)];
    const uint32_t kind = random_below(seed, 4);
    if (kind < 2)
        add_plane(drawn, 0, 0, kind == 0 ? 0 : map_between(seed, -1, 1), 1);
    if (kind == 2) {
        double left, bottom, right, top;
        map_body_box(&drawn->body, &left, &bottom, &right, &top);
        const double half = (right - left) / 2 + map_between(seed, 0.5, 8);
        add_plane(drawn, 0, 0, 0, 1);
        add_plane(drawn, -half, 0, 1, 0);
        add_plane(drawn, half, 0, -1, 0);
    }
    if (kind == 3) {
        const double rough = map_between(seed, 0, 4);
        for (uint32_t i = 0; i < MAP_HEIGHTS; i++)
            drawn->heights[i] = (float)(-rough * random_unit(seed));
        drawn->floor.height_count = MAP_HEIGHTS;
        drawn->floor.spacing = map_between(seed, 0.2, 2.2);
        drawn->floor.heights_x = -drawn->floor.spacing * MAP_HEIGHTS / 2;
    }
}

/// Above the floor: how far a plane rises below the body is added.
static void lift_body(map_case *drawn, double height) {
    double left, bottom, right, top, rise = 0;
    map_body_box(&drawn->body, &left, &bottom, &right, &top);
    if (drawn->floor.plane_count > 0)
        rise = fabs(drawn->planes[0][2]) * (right - left);
    map_move_body(&drawn->body, -(left + right) / 2, height + rise - bottom);
}

/* ---------------------------------------------------------------------------------------------------- families */

static void draw_blast(map_case *drawn, uint64_t *seed) {
    map_draw_begin(drawn, seed);
    if (map_one_in(seed, 4))
        draw_gravity(drawn, seed);
    map_draw_velocities(drawn, map_decades(seed, 0.01, 100), seed);
    if (map_one_in(seed, 4))
        draw_pins(drawn, 2, seed);
    draw_global_damping(drawn, seed);
}

static void draw_hit(map_case *drawn, uint64_t *seed) {
    map_draw_begin(drawn, seed);
    if (map_one_in(seed, 6))
        draw_gravity(drawn, seed);
    mspring_particle_def *def = &drawn->body.particles[random_below(seed, drawn->body.particle_count)];
    const double speed = map_decades(seed, 0.3, 300), angle = map_between(seed, 0, 6.3);
    def->vx = (float)(speed * cos(angle));
    def->vy = (float)(speed * sin(angle));
}

static void draw_spin(map_case *drawn, uint64_t *seed) {
    const map_stuff stuff = map_draw_begin(drawn, seed);
    double left, bottom, right, top;
    map_body_box(&drawn->body, &left, &bottom, &right, &top);
    const double turn = sign(seed) * map_decades(seed, 0.1, 20), x = (left + right) / 2, y = (bottom + top) / 2;
    const double speed = stuff.spacing * (map_one_in(seed, 3) ? map_between(seed, 0, 5) : 0);
    for (uint32_t i = 0; i < drawn->body.particle_count; i++) {
        mspring_particle_def *def = &drawn->body.particles[i];
        def->vx = (float)(-turn * (def->y - y) + speed);
        def->vy = (float)(turn * (def->x - x) - speed);
    }
    if (map_one_in(seed, 4))
        draw_gravity(drawn, seed);
}

static void draw_drop(map_case *drawn, uint64_t *seed) {
    map_draw_begin(drawn, seed);
    draw_gravity(drawn, seed);
    draw_floor(drawn, seed);
    lift_body(drawn, map_one_in(seed, 3) ? 0.001 : map_decades(seed, 0.01, 40));
    if (map_one_in(seed, 3))
        map_draw_velocities(drawn, map_decades(seed, 0.1, 20), seed);
    if (map_one_in(seed, 10))
        draw_pins(drawn, 1, seed);
    draw_global_damping(drawn, seed);
}

/// From here on bounces are damped.
enum { DAMPED_BOUNCES = 16000 };

static void draw_bounce(map_case *drawn, uint64_t *seed) {
    map_draw_begin(drawn, seed);
    const map_stuff stuff = {1, 1, 0, 100, 1};
    drawn->shape = MAP_LOOSE;
    drawn->share = 0;
    map_draw_body(&drawn->body, MAP_LOOSE, &stuff, seed);
    drawn->network.settings.gravity_y = -9.8f;
    draw_floor(drawn, seed);
    if (map_one_in(seed, 2))
        drawn->floor.restitution = 1;
    if (map_one_in(seed, 2))
        drawn->floor.friction = 0;
    const double height = map_decades(seed, 0.05, 20);
    lift_body(drawn, height);
    if (map_one_in(seed, 2))
        map_draw_velocities(drawn, map_between(seed, 0, 5), seed);
    if (drawn->network.settings.substeps > 16)
        drawn->network.settings.substeps = 16;
    // A hundred bounces of the lowest.
    const double period = 2 * sqrt(2 * height / 9.8);
    drawn->steps = (uint32_t)fmin(20000, fmax(100, 110 * period / drawn->dt));
    if (drawn->index >= DAMPED_BOUNCES)
        drawn->network.settings.global_damping = (float)map_decades(seed, 0.1, 10);
}

static void draw_hang(map_case *drawn, uint64_t *seed) {
    map_draw_begin(drawn, seed);
    draw_gravity(drawn, seed);
    if (map_one_in(seed, 2)) {
        drawn->drift_x = map_between(seed, -5, 5);
        drawn->drift_y = map_between(seed, -2, 2);
    } else {
        draw_global_damping(drawn, seed);
    }
    if (map_one_in(seed, 2))
        map_draw_velocities(drawn, map_decades(seed, 0.01, 20), seed);
    draw_pins(drawn, 3, seed);
    drawn->has_forces = map_one_in(seed, 2);
    drawn->by_hook = drawn->has_forces && map_one_in(seed, 2);
    for (uint32_t i = 0; drawn->has_forces && i < drawn->body.particle_count; i++) {
        const double most = map_one_in(seed, 3) ? 50 * (double)drawn->body.particles[i].mass : 0;
        drawn->force_x[i] = (float)map_between(seed, -most, most);
        drawn->force_y[i] = (float)map_between(seed, -most, most);
    }
}

static void draw_wreck(map_case *drawn, uint64_t *seed) {
    map_draw_begin(drawn, seed);
    if (map_one_in(seed, 2))
        draw_gravity(drawn, seed);
    if (map_one_in(seed, 3)) {
        draw_floor(drawn, seed);
        lift_body(drawn, map_decades(seed, 0.01, 10));
    }
    map_draw_velocities(drawn, map_decades(seed, 0.01, 50), seed);
    if (map_one_in(seed, 4))
        draw_pins(drawn, 1, seed);
    drawn->break_at = 2 + random_below(seed, 10);
    drawn->break_every = 1 + random_below(seed, 6);
    if (map_one_in(seed, 3)) {
        drawn->network.settings.sleep_speed = (float)map_decades(seed, 0.001, 1);
        drawn->network.settings.sleep_time = 0.1f;
    }
}

/// Something far away, so that the local origin is not near the body.
static void add_distant_pin(map_case *drawn, double distance) {
    mspring_particle_def *def = &drawn->body.particles[drawn->body.particle_count++];
    mspring_init(MSPRING_STRUCT_PARTICLE_DEF, def, sizeof *def);
    def->flags = MSPRING_PARTICLE_PINNED;
    def->x = drawn->body.particles[0].x + distance;
    def->y = drawn->body.particles[0].y;
}

static void draw_far(map_case *drawn, uint64_t *seed) {
    map_draw_begin(drawn, seed);
    if (map_one_in(seed, 2))
        draw_gravity(drawn, seed);
    map_draw_velocities(drawn, map_decades(seed, 0.1, 30), seed);
    if (map_one_in(seed, 3))
        draw_pins(drawn, 1, seed);
    const double x = sign(seed) * map_decades(seed, 10, 1e7);
    map_move_body(&drawn->body, x, sign(seed) * map_decades(seed, 1, 1e5));
    if (map_one_in(seed, 2))
        add_distant_pin(drawn, map_decades(seed, 20, 2e4));
}

// Little motion, so that it does not depend on its last digits.
static void draw_substeps(map_case *drawn, uint64_t *seed) {
    drawn->index *= 8; // explicit
    const map_stuff stuff = map_draw_begin(drawn, seed);
    drawn->index /= 8;
    drawn->share = 0.4;
    drawn->network.settings.substeps = 1;
    drawn->steps = MAP_STEPS;
    if (map_one_in(seed, 2))
        draw_pins(drawn, 2, seed);
    if (map_one_in(seed, 3))
        drawn->network.settings.gravity_y = -9.8f;
    double lightest = INFINITY;
    for (uint32_t i = 0; i < drawn->body.particle_count; i++)
        lightest = fmin(lightest, (double)drawn->body.particles[i].mass);
    // As fast as stretches a spring by a thousandth to a fiftieth.
    const double speed = stuff.spacing * sqrt(stuff.stiffness / lightest) * map_decades(seed, 1e-3, 0.02);
    map_draw_velocities(drawn, speed, seed);
    for (uint32_t i = 0; i < drawn->body.particle_count; i++)
        if (drawn->body.particles[i].flags != 0)
            drawn->body.particles[i].vx = drawn->body.particles[i].vy = 0;
    if (map_one_in(seed, 2))
        map_move_body(&drawn->body, map_decades(seed, 1, 1e6), 0);
    if (map_one_in(seed, 2))
        add_distant_pin(drawn, map_decades(seed, 20, 2e3));
}

/// The first flies, the second rests; half a turn of angle and some height apart, so that they graze, too. Returns
/// how far they are apart.
static double draw_second(map_case *drawn, const map_stuff *stuff, uint64_t *seed) {
    map_body second;
    const map_shape shape = (map_shape)random_below(seed, MAP_SHAPES + 1);
    map_draw_body(&second, shape, stuff, seed);
    for (uint32_t i = 0; i < second.particle_count && shape == MAP_LOOSE; i++) // none overlap at first
        second.particles[i].x = i * stuff->spacing;
    drawn->contact = mspring_contact_def_default();
    drawn->contact.thickness = 0.4 * stuff->spacing;
    drawn->contact.flags = 0;
    drawn->contact.friction = map_one_in(seed, 2) ? 0 : (float)map_decades(seed, 0.1, 3);
    drawn->contact.restitution = map_one_in(seed, 2) ? 0 : (float)random_unit(seed);
    const double gap = stuff->spacing * map_between(seed, 0.5, 1.5);
    double left, bottom, right, top;
    map_body_box(&drawn->body, &left, &bottom, &right, &top);
    map_move_body(&second, 0, map_between(seed, -0.8, 0.8) * (top - bottom + stuff->spacing));
    map_add_body(drawn, &second, gap);
    return gap;
}

static void let_first_fly(map_case *drawn, double speed, uint64_t *seed) {
    const double angle = map_between(seed, -0.3, 0.3);
    for (uint32_t i = 0; i < drawn->first_count; i++) {
        drawn->body.particles[i].vx = (float)(speed * cos(angle));
        drawn->body.particles[i].vy = (float)(speed * sin(angle));
    }
}

static void draw_meet(map_case *drawn, uint64_t *seed) {
    drawn->index *= 8; // explicit
    const map_stuff stuff = map_draw_begin(drawn, seed);
    drawn->index /= 8;
    const double gap = draw_second(drawn, &stuff, seed);
    // In substeps of a spring's own time, as far as it takes to meet and part.
    const double heaviest = stuff.mass_ratio, time = sqrt(heaviest / stuff.stiffness);
    const double speed = stuff.spacing / time * map_decades(seed, 1e-3, 0.1);
    let_first_fly(drawn, speed, seed);
    const double step = drawn->share * drawn->network.settings.substeps * 0.5 * time / sqrt(heaviest);
    drawn->steps = (uint32_t)fmin(2000, fmax(20, 4 * gap / (speed * fmin(step, 0.25))));
}

static void draw_press(map_case *drawn, uint64_t *seed) {
    const uint32_t index = drawn->index;
    drawn->index = 2 + index % 6; // implicit or direct
    const map_stuff stuff = map_draw_begin(drawn, seed);
    drawn->index = index;
    const double gap = draw_second(drawn, &stuff, seed);
    // Up to two springs' length in a substep, and not so fast that springs are crushed.
    const double heaviest = stuff.mass_ratio, time = sqrt(heaviest / stuff.stiffness);
    const double speed =
        stuff.spacing * fmin(drawn->network.settings.substeps / drawn->dt * map_decades(seed, 1e-3, 2), 0.1 / time);
    let_first_fly(drawn, speed, seed);
    drawn->steps = (uint32_t)fmin(400, fmax(20, 4 * gap / (speed * drawn->dt)));
}

static void draw_silt(map_case *drawn, uint64_t *seed) {
    map_draw_begin(drawn, seed);
    draw_gravity(drawn, seed);
    do
        draw_floor(drawn, seed);
    while (drawn->floor.height_count == 0);
    drawn->has_stretches = true;
    for (uint32_t i = 0; i < MAP_HEIGHTS; i++) {
        drawn->frictions[i] = map_one_in(seed, 4) ? 0 : (float)map_decades(seed, 0.01, 10);
        drawn->restitutions[i] = map_one_in(seed, 4) ? 1 : (float)random_unit(seed);
    }
    drawn->floor.silt_depth = (float)map_decades(seed, 0.01, 30);
    drawn->floor.silt_rate = (float)map_decades(seed, 0.01, 1e6);
    lift_body(drawn, map_decades(seed, 0.01, 40));
    if (map_one_in(seed, 3))
        map_draw_velocities(drawn, map_decades(seed, 0.1, 20), seed);
}

// Each spring with a chance of its own, so that kinds lie side by side.
static void draw_spring_laws(map_case *drawn, uint64_t *seed) {
    const double strain = map_decades(seed, 1e-4, 0.3);
    for (uint32_t i = 0; i < drawn->body.spring_count; i++) {
        mspring_spring_def *def = &drawn->body.springs[i];
        if ((drawn->laws & MAP_ONE_SIDED) != 0 && map_one_in(seed, 3))
            def->flags |= map_one_in(seed, 4) ? MSPRING_SPRING_PUSH_ONLY : MSPRING_SPRING_PULL_ONLY;
        if ((drawn->laws & MAP_YIELDS) != 0 && map_one_in(seed, 2)) {
            def->yield_strain = (float)strain;
            def->hardening = map_one_in(seed, 3) ? 0 : (float)map_decades(seed, 0.01, 2);
        }
    }
}

/// Explicit substeps no longer than this share of what is stable.
static const double longest_with_laws = 0.5, longest_at_walls = 0.5;

static void draw_bend(map_case *drawn, uint64_t *seed) {
    const map_stuff stuff = map_draw_begin(drawn, seed);
    drawn->laws = 1 + random_below(seed, MAP_ALL_LAWS);
    drawn->share = fmin(drawn->share, longest_with_laws);
    if ((drawn->laws & MAP_ONE_SIDED) != 0)
        drawn->laws &= ~(uint32_t)MAP_LIMITS; // a limit is a spring beside one that acts on both sides
    draw_spring_laws(drawn, seed);
    if ((drawn->laws & MAP_LIMITS) != 0) {
        drawn->limit_strain = map_decades(seed, 1e-3, 0.5);
        drawn->limit_stiffening = map_decades(seed, 0.1, 30);
    }
    if ((drawn->laws & MAP_AREAS) != 0)
        drawn->area_stiffness = (float)(stuff.stiffness * map_decades(seed, 0.1, 4));
    if ((drawn->laws & MAP_ANGLES) != 0)
        drawn->angle_stiffness =
            (float)(stuff.stiffness * stuff.spacing * stuff.spacing * map_decades(seed, 1e-3, 1));
    map_draw_velocities(drawn, map_decades(seed, 0.01, 100), seed);
    if (map_one_in(seed, 3))
        draw_gravity(drawn, seed);
    if (map_one_in(seed, 3))
        draw_pins(drawn, 2, seed);
    draw_global_damping(drawn, seed);
}

/// Make the first body heavy, and as stiff as makes it vibrate as before.
static void weigh_first(map_case *drawn, double ratio) {
    for (uint32_t i = 0; i < drawn->first_count; i++)
        drawn->body.particles[i].mass *= (float)ratio;
    for (uint32_t i = 0; i < drawn->body.spring_count; i++)
        if (drawn->body.springs[i].a < drawn->first_count) {
            drawn->body.springs[i].stiffness *= (float)ratio;
            drawn->body.springs[i].damping *= (float)ratio;
        }
}

static void draw_wall(map_case *drawn, uint64_t *seed) {
    const map_stuff stuff = map_draw_begin(drawn, seed);
    drawn->share = fmin(drawn->share, longest_at_walls);
    const double gap = draw_second(drawn, &stuff, seed), ratio = map_decades(seed, 1, 1000);
    weigh_first(drawn, ratio);
    drawn->has_wedge = true;
    drawn->wedge_angle = map_one_in(seed, 2) ? 0.5 * 3.14159265358979 : map_between(seed, 0.4, 1.2);
    drawn->wedge_radius = map_one_in(seed, 3) ? map_between(seed, 0, 0.4) * stuff.spacing : 0;
    map_hold_place_wedge(drawn, stuff.spacing * map_decades(seed, 0.01, 2));
    // As in press, and slow enough that the light body is not crushed.
    const double time = sqrt(stuff.mass_ratio / stuff.stiffness), light = 0.1 / (time * sqrt(ratio));
    const bool is_explicit = drawn->network.settings.solver == MSPRING_SOLVER_EXPLICIT;
    const double step = is_explicit
                            ? drawn->share * drawn->network.settings.substeps * 0.5 * time / sqrt(stuff.mass_ratio)
                            : drawn->dt;
    const double speed =
        stuff.spacing *
        (is_explicit ? light * map_decades(seed, 0.01, 1)
                     : fmin(drawn->network.settings.substeps / drawn->dt * map_decades(seed, 1e-3, 2), light));
    let_first_fly(drawn, speed, seed);
    if (map_one_in(seed, 2)) // it comes
        drawn->drift_x = -speed * map_between(seed, 0.05, 1);
    drawn->steps = (uint32_t)fmin(is_explicit ? 2000 : 400, fmax(20, 6 * gap / (speed * fmin(step, 0.25))));
}

static void draw_grip(map_case *drawn, uint64_t *seed) {
    const map_stuff stuff = map_draw_begin(drawn, seed);
    drawn->share = fmin(drawn->share, longest_with_laws);
    if (map_one_in(seed, 2)) {
        const double speed = stuff.spacing * map_decades(seed, 0.01, 10);
        drawn->drift_x = map_between(seed, -speed, speed);
        drawn->drift_y = map_between(seed, -speed, speed);
    }
    if (map_one_in(seed, 3))
        draw_gravity(drawn, seed);
    if (map_one_in(seed, 2))
        map_draw_velocities(drawn, map_decades(seed, 0.01, 20), seed);
    if (map_one_in(seed, 4))
        draw_pins(drawn, 1, seed);
    const mspring_id particle = random_below(seed, drawn->body.particle_count);
    const mspring_particle_def *at = &drawn->body.particles[particle];
    drawn->grip_count = 1 + random_below(seed, MAP_GRIPS);
    for (uint32_t i = 0; i < drawn->grip_count; i++) {
        mspring_grip_def *grip = &drawn->grips[i];
        mspring_init(MSPRING_STRUCT_GRIP_DEF, grip, sizeof *grip);
        grip->particle = particle;
        grip->x = at->x + stuff.spacing * map_between(seed, -1, 1);
        grip->y = at->y + stuff.spacing * map_between(seed, -1, 1);
        grip->stiffness = (float)map_decades(seed, 1, 1e10);
        if (map_one_in(seed, 3))
            grip->damping = (float)map_decades(seed, 1, 1e6);
        if (!map_one_in(seed, 3))
            grip->max_force = (float)(stuff.spacing * map_decades(seed, 1e-2, 1e6));
    }
}

static const family families[MAP_FAMILIES] = {
    {"blast", 60000, draw_blast},    {"hit", 45000, draw_hit},        {"spin", 20000, draw_spin},
    {"drop", 60000, draw_drop},      {"bounce", 18000, draw_bounce},  {"hang", 30000, draw_hang},
    {"wreck", 20000, draw_wreck},    {"far", 16000, draw_far},        {"substeps", 3000, draw_substeps},
    {"meet", 20000, draw_meet},      {"silt", 10000, draw_silt},      {"press", 12000, draw_press},
    {"bend", 16000, draw_bend},      {"wall", 12000, draw_wall},      {"grip", 16000, draw_grip},
    {"fall", 4000, map_draw_fall},   {"order", 3000, map_draw_order}, {"uneven", 2000, map_draw_uneven},
    {"burst", 6000, map_draw_burst}, {"rest", 1000, map_draw_rest},
};

const char *map_family_name(map_family of) {
    return families[of].name;
}

uint32_t map_family_size(map_family of) {
    return families[of].size;
}

void map_draw_case(map_case *drawn, map_family of, uint32_t index) {
    static const map_case none = {0};
    uint64_t seed = ((uint64_t)of + 1) << 32 | index;
    *drawn = none;
    drawn->family = of;
    drawn->index = index;
    for (int i = 0; i < 3; i++)
        random_next(&seed);
    families[of].draw(drawn, &seed);
}

mspring_floor_def map_case_floor(const map_case *what) {
    mspring_floor_def floor = what->floor;
    floor.planes = &what->planes[0][0];
    floor.heights = what->heights;
    if (what->has_stretches) {
        floor.height_frictions = what->frictions;
        floor.height_restitutions = what->restitutions;
    }
    return floor;
}

void map_describe_case(const map_case *what, char *text, size_t size) {
    static const char *const integrators[] = {"ga0", "bdf2", "euler"}, *const solvers[] = {"explicit", "implicit",
                                                                                           "direct"};
    const mspring_solver solver = what->network.settings.solver;
    snprintf(
        text, size,
        "%s%s%s, %u x %.4g s of %u substeps%s, %s of %u particles, %.3g N/m, gravity %g, damping %g, floor %s, "
        "restitution %g, friction %g%s%s%s%s%s",
        solvers[solver], solver == MSPRING_SOLVER_EXPLICIT ? "" : " ",
        solver == MSPRING_SOLVER_EXPLICIT ? "" : integrators[what->network.settings.integrator], what->steps,
        what->dt, what->network.settings.substeps, what->share > 0 ? " (explicit: a share of what is stable)" : "",
        map_shape_name(what->shape), what->body.particle_count,
        what->body.spring_count > 0 ? (double)what->body.springs[0].stiffness : 0,
        (double)what->network.settings.gravity_y, (double)what->network.settings.global_damping,
        !what->has_floor               ? "none"
        : what->floor.height_count > 0 ? "heights"
        : what->floor.plane_count > 1  ? "box"
        : what->planes[0][2] == 0      ? "level"
                                       : "slope",
        (double)what->floor.restitution, (double)what->floor.friction,
        (what->laws & MAP_ONE_SIDED) != 0 ? ", one-sided springs" : "",
        (what->laws & MAP_YIELDS) != 0 ? ", springs that yield" : "",
        (what->laws & MAP_LIMITS) != 0 ? ", strain limits" : "", (what->laws & MAP_AREAS) != 0 ? ", areas" : "",
        (what->laws & MAP_ANGLES) != 0 ? ", angles" : "");
}

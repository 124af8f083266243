/// @file motion.c
/// Oscillations, a wave, a hanging cable and impacts, against closed forms.
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL // for lab.h
#include <math.h>

#include <massspring/massspring.h>

#include "validation/cases.h"

static const double pi = 3.14159265358979323846;

// A spring with both ends where they belong: the first pinned at the origin.
static void add_pair(world *to, double x, double y, double stiffness, double rest_length) {
    mspring_particle_def ends[2] = {mspring_particle_def_default(), mspring_particle_def_default()};
    mspring_spring_def spring = mspring_spring_def_default();
    ends[0].flags = MSPRING_PARTICLE_PINNED;
    ends[1].x = x;
    ends[1].y = y;
    spring.a = 0;
    spring.b = 1;
    spring.stiffness = (float)stiffness;
    spring.rest_length = (float)rest_length;
    mspring_builder_add_particles(to->builder, ends, 2, NULL);
    mspring_builder_add_springs(to->builder, &spring, 1, NULL);
}

/* ------------------------------------------------------------------------------------------------- oscillations */

outcome oscillator_period(uint32_t substeps_per_period) {
    enum { PERIODS = 20 };
    const double dt = 1.0 / substeps_per_period; // s; omega = 2 pi / s
    world w = world_begin();
    add_pair(&w, 1.1, 0, 4 * pi * pi, 1);
    world_make(&w, 0, 0, 1);
    turn_counter turns = {.before = 1};
    for (uint32_t i = 1; w.result == MSPRING_OK && i <= PERIODS * substeps_per_period; i++) {
        double x = 0, y = 0;
        world_note(&w, mspring_network_step(w.network, dt));
        if (w.result == MSPRING_OK)
            world_note(&w, mspring_network_get_positions(w.network, NULL, 1, 1, &x, &y, 1));
        turn_counter_add(&turns, i * dt, dt, x - 1);
    }
    return (outcome){world_end(&w, turn_counter_period(&turns)), 1};
}

// The complete elliptic integral by the arithmetic-geometric mean (Gauss).
static double mean_of(double a, double b) {
    while (fabs(a - b) > 1e-15 * a) {
        const double mean = (a + b) / 2;
        b = sqrt(a * b);
        a = mean;
    }
    return a;
}

outcome pendulum_period(uint32_t steps_per_second) {
    const double g = (double)9.8f, dt = 1.0 / steps_per_second; // m/s^2; 1 m long; let go at 90 degrees
    world w = world_begin();
    add_pair(&w, 1, 0, 1e6, 1);
    world_make(&w, 0, -g, 1);
    turn_counter turns = {.before = 1};
    for (uint32_t i = 1; w.result == MSPRING_OK && i <= 12 * steps_per_second; i++) {
        double x = 0, y = 0;
        world_note(&w, mspring_network_step(w.network, dt));
        if (w.result == MSPRING_OK)
            world_note(&w, mspring_network_get_positions(w.network, NULL, 1, 1, &x, &y, 1));
        turn_counter_add(&turns, i * dt, dt, x);
    }
    const double exact = 2 * pi * sqrt(1 / g) / mean_of(1, cos(pi / 4));
    return (outcome){world_end(&w, turn_counter_period(&turns)), exact};
}

// A row of n springs between two pins, 1 m and 1 kg in all, with waves of 1 m/s. Its lowest mode along itself.
outcome wave_period(uint32_t springs) {
    const double dt = 0.05 / springs;
    world w = world_begin();
    for (uint32_t i = 0; i <= springs; i++) {
        const double at = (double)i / springs;
        mspring_particle_def def = mspring_particle_def_default();
        def.flags = i == 0 || i == springs ? MSPRING_PARTICLE_PINNED : 0;
        def.x = at + 0.01 * sin(pi * at);
        def.mass = (float)(1.0 / springs);
        mspring_builder_add_particles(w.builder, &def, 1, NULL);
    }
    for (uint32_t i = 0; i < springs; i++) {
        mspring_spring_def def = mspring_spring_def_default();
        def.a = i;
        def.b = i + 1;
        def.stiffness = (float)springs;
        def.rest_length = (float)(1.0 / springs);
        mspring_builder_add_springs(w.builder, &def, 1, NULL);
    }
    world_make(&w, 0, 0, 1);
    turn_counter turns = {.before = 1};
    for (uint32_t i = 1; w.result == MSPRING_OK && i * dt < 9; i++) {
        double sum = 0;
        world_note(&w, mspring_network_step(w.network, dt));
        for (uint32_t p = 1; w.result == MSPRING_OK && p < springs; p++) {
            double x = 0, y = 0;
            world_note(&w, mspring_network_get_positions(w.network, NULL, p, 1, &x, &y, 1));
            sum += (x - (double)p / springs) * sin(pi * p / springs);
        }
        turn_counter_add(&turns, i * dt, dt, sum);
    }
    return (outcome){world_end(&w, turn_counter_period(&turns)), 2};
}

/* ------------------------------------------------------------------------------------------------ hanging cable */

// Elastic catenary between two points at one height (Irvine, Cable Structures, 1981): the horizontal force H
// follows from the span, the sag from it.
static double catenary_exact(double span, double length, double weight, double modulus) {
    const double half = weight * length / 2;
    double low = 1e-3, high = 1e6;
    for (int i = 0; i < 200; i++) {
        const double h = sqrt(low * high);
        if (2 * h / weight * asinh(half / h) + h * length / modulus < span)
            low = h;
        else
            high = h;
    }
    return low / weight * (sqrt(1 + half / low * (half / low)) - 1) + weight * length * length / (8 * modulus);
}

outcome catenary_sag(uint32_t links) {
    const double span = 10, length = 12, weight = 10, modulus = 1e5, g = (double)9.8f; // m, m, N/m, N, m/s^2
    world w = world_begin();
    mspring_particle_def ends[2] = {mspring_particle_def_default(), mspring_particle_def_default()};
    for (int i = 0; i < 2; i++) {
        ends[i].flags = MSPRING_PARTICLE_PINNED;
        ends[i].x = i * span;
    }
    mspring_material link = mspring_material_default();
    link.mass = (float)(weight * length / links / g);
    link.stiffness = (float)(modulus * links / length);
    mspring_rope_def rope = mspring_rope_def_default();
    rope.from = 0;
    rope.to = 1;
    rope.segment_count = links;
    rope.material = &link;
    rope.length_ratio = (float)(length / span);
    mspring_builder_add_particles(w.builder, ends, 2, NULL);
    mspring_builder_add_rope(w.builder, &rope, NULL, NULL);
    world_make(&w, 0, -g, 1);
    double x = 0, y = 0;
    if (w.result == MSPRING_OK)
        world_note(&w, mspring_network_settle(w.network, NULL, NULL));
    if (w.result == MSPRING_OK)
        world_note(&w, mspring_network_get_positions(w.network, NULL, 1 + links / 2, 1, &x, &y, 1));
    return (outcome){world_end(&w, -y), catenary_exact(span, length, weight, modulus)};
}

/* ------------------------------------------------------------------------------------------------------ impacts */

static double mean_velocity(world *w, mspring_id first, uint32_t count) {
    double sum = 0;
    for (uint32_t i = 0; w->result == MSPRING_OK && i < count; i++) {
        float vx = 0, vy = 0;
        world_note(w, mspring_network_get_velocities(w->network, NULL, first + i, 1, &vx, &vy, 1));
        sum += (double)vx;
    }
    return sum / count;
}

// A bar three particles high hits one that is `times` as long and at rest, end to end. Bodies keep half a spacing
// apart.
static double restitution(uint32_t columns, uint32_t times) {
    enum { ROWS = 3 };
    const double spacing = 1.0 / columns, mass = spacing * spacing, speed = 1e-3; // waves run at 1 to 1.2 m/s
    world w = world_begin();
    world_add_plate(&w,
                    &(plate){.columns = columns, .rows = ROWS, .spacing = spacing, .stiffness = 1, .mass = mass});
    world_add_plate(&w, &(plate){.columns = columns * times,
                                 .rows = ROWS,
                                 .x = 1 - 0.45 * spacing,
                                 .spacing = spacing,
                                 .stiffness = 1,
                                 .mass = mass});
    world_make(&w, 0, 0, 8);
    const mspring_contact_def contact = mspring_contact_def_default();
    const float along = (float)speed, across = 0;
    if (w.result == MSPRING_OK)
        world_note(&w, mspring_network_set_contact(w.network, &contact));
    if (w.result == MSPRING_OK)
        world_note(&w, mspring_network_set_velocities(w.network, NULL, 0, columns * ROWS, &along, &across, 0));
    // The gap closes, and waves run to and fro through both.
    const double dt = spacing, end = 0.05 * spacing / speed + 6 * times;
    for (uint32_t i = 0; w.result == MSPRING_OK && i * dt < end; i++)
        world_note(&w, mspring_network_step(w.network, dt));
    const double first = mean_velocity(&w, 0, columns * ROWS);
    const double second = mean_velocity(&w, columns * ROWS, columns * ROWS * times);
    return world_end(&w, (second - first) / speed);
}

outcome impact_of_equal_bars(uint32_t columns) {
    return (outcome){restitution(columns, 1), 1};
}

// Saint-Venant: they part when the wave comes back in the long one, and the short one has stopped.
outcome impact_of_unequal_bars(uint32_t columns) {
    return (outcome){restitution(columns, 2), 0.5};
}

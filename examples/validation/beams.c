/// @file beams.c
/// Cantilevers and columns, against beam theory.
///
/// A lattice of springs of k along rows and columns and k / 2 across is, when it is fine, an isotropic plate with
/// the modulus E = 4 k / 3 (N/m), Poisson's ratio 1/3 and the shear modulus G = k / 2.
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL // for lab.h
#include <math.h>

#include <massspring/massspring.h>

#include "validation/cases.h"

enum { SLENDERNESS = 20 };

static const double pi = 3.14159265358979323846;
static const double stiffness = 1; // N/m; the height is 1 m, the mass of the whole bar 1 kg

static double length(void) {
    return SLENDERNESS;
}

// E I.
static double bending_stiffness(void) {
    return 4.0 / 3 * stiffness / 12;
}

// Springs along the edges are as stiff as those inside, though they have half as much plate beside them: pure
// bending gives this factor.
static double edge_factor(uint32_t cells) {
    const double n = cells;
    return 1 + (2.25 - 1) / (n * n) + 2.25 / n;
}

static double particle_mass(uint32_t cells) {
    return 1 / (((double)SLENDERNESS * cells) * (cells + 1));
}

static plate lying(uint32_t cells) {
    return (plate){.columns = SLENDERNESS * cells + 1,
                   .rows = cells + 1,
                   .spacing = 1.0 / cells,
                   .stiffness = stiffness,
                   .mass = particle_mass(cells),
                   .pinned_column = true};
}

// The last column or row stands for half as much of the bar as the others.
static void halve_end(world *w, const plate *bar) {
    const float half = (float)(bar->mass / 2);
    const mspring_id step = bar->pinned_column ? bar->columns : 1;
    const mspring_id first = bar->pinned_column ? bar->columns - 1 : 0;
    const uint32_t count = bar->pinned_column ? bar->rows : bar->columns;
    for (uint32_t i = 0; w->result == MSPRING_OK && i < count; i++)
        world_note(w, mspring_network_set(w->network, MSPRING_MASS, NULL, first + i * step, 1, &half, 0));
}

// Of the middle of a lying bar's end.
static double end_height(world *w, const plate *bar) {
    double x = 0, y = 0, sum = 0;
    for (uint32_t row = 0; w->result == MSPRING_OK && row < bar->rows; row++) {
        world_note(w, mspring_network_get_positions(w->network, NULL, (row + 1) * bar->columns - 1, 1, &x, &y, 1));
        sum += y;
    }
    return sum / bar->rows;
}

/* ---------------------------------------------------------------------------------------------------------- sag */

static outcome sag(uint32_t cells, double stiffer) {
    const double wanted = 1e-3 * length(), ei = bending_stiffness() * stiffer, weight = 1 / length();
    const double shear = 5.0 / 6 * stiffness / 2; // Timoshenko: kappa G A
    const double per_g = weight * pow(length(), 4) / (8 * ei) + weight * pow(length(), 2) / (2 * shear);
    const double g = (double)(float)(wanted / per_g);
    const plate bar = lying(cells);
    world w = world_begin();
    world_add_plate(&w, &bar);
    world_make(&w, 0, -g, 1);
    halve_end(&w, &bar);
    if (w.result == MSPRING_OK)
        world_note(&w, mspring_network_settle(w.network, NULL, NULL));
    return (outcome){world_end(&w, 0.5 - end_height(&w, &bar)), per_g * g};
}

outcome cantilever_sag(uint32_t cells) {
    return sag(cells, edge_factor(cells));
}

outcome cantilever_sag_of_continuum(uint32_t cells) {
    return sag(cells, 1);
}

/* -------------------------------------------------------------------------------------------------- oscillations
 */

// Mode of a cantilever at s = x / length, by its root of cos(b) cosh(b) = -1.
static double mode(double root, double s) {
    const double ratio = (cosh(root) + cos(root)) / (sinh(root) + sin(root));
    return cosh(root * s) - cos(root * s) - ratio * (sinh(root * s) - sin(root * s));
}

// Heights of the middle row, weighed by the mode: other modes drop out.
static double projection(world *w, const plate *bar, double root, const double *places) {
    double sum = 0;
    const mspring_id first = bar->rows / 2 * bar->columns;
    for (uint32_t i = 1; w->result == MSPRING_OK && i < bar->columns; i++) {
        double x = 0, y = 0;
        world_note(w, mspring_network_get_positions(w->network, NULL, first + i, 1, &x, &y, 1));
        sum += (i + 1 == bar->columns ? 0.5 : 1) * mode(root, i / (bar->columns - 1.0)) * (y - places[0]);
    }
    return sum;
}

// Frequency equation of a clamped Timoshenko beam (Huang 1961); b is omega over that of the bending alone, r and s
// are the shares of rotary inertia and of shear.
static double frequency_equation(double b, double r, double s) {
    const double across = sqrt((r - s) * (r - s) + 4 / (b * b));
    const double alpha = b * sqrt((across - (r + s)) / 2), beta = b * sqrt((across + (r + s)) / 2);
    return 2 + (b * b * (r - s) * (r - s) + 2) * cosh(alpha) * cos(beta) -
           b * (r + s) / sqrt(1 - b * b * r * s) * sinh(alpha) * sin(beta);
}

static double exact_omega(uint32_t cells, double root) {
    const double ei = bending_stiffness() * edge_factor(cells), mass_per_length = 1 / length();
    const double rotary =
        (1 + 2.0 / cells) / 12 / (length() * length()); // rows weigh the same, those at the edges, too
    const double shear = ei / (5.0 / 6 * stiffness / 2 * length() * length());
    double low = 0.8 * root * root, high = root * root;
    const bool rises = frequency_equation(high, rotary, shear) > 0;
    for (int i = 0; i < 60; i++) {
        const double middle = (low + high) / 2;
        if ((frequency_equation(middle, rotary, shear) > 0) == rises)
            high = middle;
        else
            low = middle;
    }
    return low * sqrt(ei / (mass_per_length * pow(length(), 4)));
}

static outcome period(uint32_t cells, double root) {
    enum { SAMPLES = 256 }; // a period
    const double omega = exact_omega(cells, root);
    const double exact = 2 * pi / omega, dt = exact / SAMPLES, swing = 1e-3 * length() / (root * root);
    const plate bar = lying(cells);
    const double middle = (bar.rows - 1 - bar.rows / 2) * bar.spacing;
    world w = world_begin();
    world_add_plate(&w, &bar);
    world_make(&w, 0, 0, MSPRING_SUBSTEPS_AUTO);
    halve_end(&w, &bar);
    for (uint32_t i = 0; w.result == MSPRING_OK && i < bar.columns * bar.rows; i++) {
        const float vx = 0, vy = (float)(-swing * omega * mode(root, i % bar.columns / (bar.columns - 1.0)));
        if (i % bar.columns > 0)
            world_note(&w, mspring_network_set_velocities(w.network, NULL, i, 1, &vx, &vy, 0));
    }
    turn_counter turns = {.before = 1};
    for (uint32_t i = 1; w.result == MSPRING_OK && i <= 3 * SAMPLES + SAMPLES / 4; i++) {
        world_note(&w, mspring_network_step(w.network, dt));
        turn_counter_add(&turns, i * dt, dt, projection(&w, &bar, root, &middle));
    }
    return (outcome){world_end(&w, turn_counter_period(&turns)), exact};
}

outcome cantilever_first_period(uint32_t cells) {
    return period(cells, 1.87510406871196);
}

outcome cantilever_second_period(uint32_t cells) {
    return period(cells, 4.69409113297418);
}

/* ----------------------------------------------------------------------------------------------------- buckling */

// Sideways push over sideways motion of the top of a column that stands in gravity g.
static double resistance(uint32_t cells, double g) {
    const plate column = {.columns = cells + 1,
                          .rows = SLENDERNESS * cells + 1,
                          .spacing = 1.0 / cells,
                          .stiffness = stiffness,
                          .mass = particle_mass(cells),
                          .pinned_row = true};
    const double push = 1e-5 * g;
    world w = world_begin();
    world_add_plate(&w, &column);
    world_make(&w, push, -g, 1);
    halve_end(&w, &column);
    if (w.result == MSPRING_OK)
        world_note(&w, mspring_network_settle(w.network, NULL, NULL));
    double sum = 0;
    for (uint32_t i = 0; w.result == MSPRING_OK && i < column.columns; i++) {
        double x = 0, y = 0;
        world_note(&w, mspring_network_get_positions(w.network, NULL, i, 1, &x, &y, 1));
        sum += (x - i * column.spacing) / column.columns;
    }
    return world_end(&w, push / sum);
}

// A column buckles under its own weight at weight length^2 = 7.8373 E I (Greenhill 1881). Its resistance falls to 0
// there, nearly straight (Southwell): from two loads below follows where.
outcome column_buckling_load(uint32_t cells) {
    const double exact = 7.83734744 * bending_stiffness() * edge_factor(cells) / pow(length(), 2); // m/s^2, of 1 kg
    const double low = 0.9 * exact, high = 0.95 * exact;
    const double at_low = resistance(cells, low), at_high = resistance(cells, high);
    return (outcome){low + at_low * (high - low) / (at_low - at_high), exact};
}

/// @file spec_laws.c
/// Specification of forces from outside of springs: hooks, areas and angle springs. They are computed in double
/// precision from the state before the substep, and added to those of the host as floats, in the order in which the
/// elements were added.
///
/// SPDX-License-Identifier: MIT
#include "spec.h"

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

typedef struct wide_vector {
    double x, y;
} wide_vector;

static float bounded(double value) {
    const double most = (double)FLT_MAX, above = value > -most ? value : -most;
    return (float)(above < most ? above : most);
}

static wide_vector between(const spec_network *network, uint32_t from, uint32_t to) {
    return (wide_vector){spec_x_of(network, to) - spec_x_of(network, from),
                         spec_y_of(network, to) - spec_y_of(network, from)};
}

static double square_of(wide_vector v) {
    return v.x * v.x + v.y * v.y;
}

static uint32_t corner_of(const spec_element *e, uint32_t corner) {
    return e->corners[corner % e->count];
}

// True if a spring along the outline is broken: then it does nothing.
static bool is_open(const spec_network *network, const spec_element *e) {
    bool open = false;
    for (uint32_t i = 0; i < e->count; i++) {
        open |= e->sides[i] != SPEC_NONE && network->springs[e->sides[i]].is_broken;
    }
    return open;
}

// True if an element acts, and not in the sums of rows.
static bool is_outside(const spec_network *network, const spec_element *e) {
    return !is_open(network, e) && e->cell[0] == SPEC_NONE;
}

static void add_force(const spec_network *network, uint32_t p, double x, double y) {
    network->fields[p].x += bounded(x);
    network->fields[p].y += bounded(y);
}

/* -------------------------------------------------------------------------------------------------------- areas */

// Shoelace formula, from the first corner.
static double area_of(const spec_network *network, const spec_element *e) {
    wide_vector before = {0.0, 0.0};
    double twice = 0.0;
    for (uint32_t i = 1; i < e->count; i++) {
        const wide_vector at = between(network, e->corners[0], e->corners[i]);
        twice += before.x * at.y - before.y * at.x;
        before = at;
    }
    return 0.5 * twice;
}

static double pressure_of(const spec_element *e, double area) {
    const double share = area / e->rest_area, fill = (double)e->fill, pressure = (double)e->pressure;
    return e->kind == SPEC_GAS ? pressure * fill / fmax(share, 0.05)
                               : pressure + (double)e->stiffness * (fill - share);
}

static void push_area(const spec_network *network, const spec_element *e) {
    const double half = 0.5 * pressure_of(e, area_of(network, e));
    for (uint32_t i = 0; i < e->count; i++) {
        const wide_vector along = between(network, corner_of(e, i + e->count - 1), corner_of(e, i + 1));
        add_force(network, e->corners[i], half * along.y, half * -along.x);
    }
}

/* -------------------------------------------------------------------------------------------------------- cells */

// The other end of a live spring in rows, or SPEC_NONE.
static uint32_t neighbour_of(const spec_network *network, uint32_t p, spec_side side) {
    const uint32_t spring = p == SPEC_NONE ? SPEC_NONE : network->sums[p].rows[side];
    if (spring == SPEC_NONE || network->springs[spring].is_broken) {
        return SPEC_NONE;
    }
    return network->springs[spring].a == p ? network->springs[spring].b : network->springs[spring].a;
}

// Enter an elastic area of four corners into the sums of rows, if live springs of rows lead around it from some
// corner on, in either sense.
static void find_cell(const spec_network *network, spec_element *e) {
    for (uint32_t i = 0; i < 4 && e->cell[0] == SPEC_NONE; i++) {
        const uint32_t here = e->corners[i], next = corner_of(e, i + 1), before = corner_of(e, i + 3);
        const uint32_t east = neighbour_of(network, here, SPEC_EAST), north = neighbour_of(network, here, SPEC_NORTH);
        const uint32_t opposite = neighbour_of(network, east, SPEC_NORTH);
        const bool is_along = east == next && north == before, is_against = east == before && north == next;
        if ((is_along || is_against) && opposite == corner_of(e, i + 2) &&
            opposite == neighbour_of(network, north, SPEC_EAST)) {
            const double force = (double)e->pressure + (double)e->stiffness * (double)e->fill;
            e->cell[0] = here;
            e->cell[1] = east;
            e->cell[2] = opposite;
            e->cell[3] = north;
            e->cell_force = (float)((is_along ? 0.5 : -0.5) * force);
            e->cell_decrease = (float)(0.25 * (double)e->stiffness / e->rest_area);
        }
    }
}

// Of several areas around one cell the first one with a force is in the sums of rows.
void spec_find_cells(const spec_network *network) {
    for (uint32_t k = 0; k < network->element_count; k++) {
        spec_element *e = &network->elements[k];
        e->cell[0] = SPEC_NONE;
        if (e->kind == SPEC_ELASTIC && e->count == 4 && !is_open(network, e)) {
            find_cell(network, e);
        }
        for (uint32_t i = 0; i < k; i++) {
            const spec_element *other = &network->elements[i];
            if (other->cell[0] == e->cell[0] && (other->cell_force != 0.0f || other->cell_decrease != 0.0f)) {
                e->cell[0] = SPEC_NONE;
            }
        }
    }
}

/* ------------------------------------------------------------------------------------------------------- angles */

// 2 sin(d / 2), with d the angle less its rest angle.
static double turn_of(const spec_element *e, wide_vector u, wide_vector w) {
    const double length = sqrt(square_of(u)) * sqrt(square_of(w));
    if (!(length > 0.0)) {
        return 0.0;
    }
    const double c = (u.x * w.x + u.y * w.y) / length, s = (u.x * w.y - u.y * w.x) / length;
    const double cosine = c * e->cosine + s * e->sine, sine = s * e->cosine - c * e->sine;
    const double size = cosine > 0.0 ? fabs(sine) * sqrt(2.0 / (1.0 + cosine)) : sqrt(2.0 - 2.0 * cosine);
    return sine < 0.0 ? -size : size;
}

// How fast an arm turns to the left, rad/s.
static double rate_of(const spec_network *network, wide_vector along, uint32_t from, uint32_t to) {
    const spec_vector a = network->motions[from].velocity, b = network->motions[to].velocity;
    return ((double)(b.y - a.y) * along.x - (double)(b.x - a.x) * along.y) / square_of(along);
}

static void push_angle(const spec_network *network, const spec_element *e) {
    const uint32_t a = e->corners[0], b = e->corners[1], c = e->corners[2];
    const wide_vector u = between(network, a, b), w = between(network, b, c);
    const double square_u = square_of(u), square_w = square_of(w);
    if (!(square_u > 0.0 && square_w > 0.0)) {
        return;
    }
    const double rate = rate_of(network, w, b, c) - rate_of(network, u, a, b), turn = turn_of(e, u, w);
    const double torque =
        -(double)e->stiffness * turn * sqrt(fmax(1.0 - 0.25 * turn * turn, 0.0)) - (double)e->damping * rate;
    const float ax = bounded(-torque * u.y / square_u), ay = bounded(torque * u.x / square_u);
    const float cx = bounded(-torque * w.y / square_w), cy = bounded(torque * w.x / square_w);
    add_force(network, a, (double)ax, (double)ay);
    add_force(network, c, (double)cx, (double)cy);
    add_force(network, b, -((double)ax + (double)cx), -((double)ay + (double)cy));
}

/* ---------------------------------------------------------------------------------------------------- stability */

static wide_vector gradient_of_angle(const spec_network *network, const spec_element *e, uint32_t corner) {
    wide_vector all[3] = {{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}};
    for (uint32_t i = 0; i < 2; i++) {
        const wide_vector arm = between(network, e->corners[i], e->corners[i + 1]);
        const double square = square_of(arm);
        if (square > 0.0) {
            all[2 * i] = (wide_vector){-arm.y / square, arm.x / square};
            all[1].x -= all[2 * i].x;
            all[1].y -= all[2 * i].y;
        }
    }
    return all[corner];
}

void spec_begin_element(const spec_network *network, spec_element *e) {
    for (uint32_t i = 0; i < e->count; i++) {
        const uint32_t here = e->corners[i], next = corner_of(e, i + 1);
        const wide_vector along = between(network, corner_of(e, i + e->count - 1), next);
        const wide_vector end = e->kind == SPEC_ANGLE ? gradient_of_angle(network, e, i)
                                                      : (wide_vector){0.5 * along.y, 0.5 * -along.x};
        e->reach[i] = bounded(sqrt(square_of(end)));
        e->sides[i] = SPEC_NONE;
        for (uint32_t s = 0; s < network->spring_count; s++) {
            const spec_spring *spring = &network->springs[s];
            if (((spring->a == here && spring->b == next) || (spring->a == next && spring->b == here)) &&
                !spring->is_broken && !(e->kind == SPEC_ANGLE && i == 2)) {
                e->sides[i] = s;
            }
        }
    }
}

// Stiffness (x) and damping (y) that bound an element count as those of springs between its corners, and half its
// pressure as springs along the outline: see spec_renew(). Open elements count, too.
void spec_add_strengths(const spec_network *network, spec_motion *sums) {
    for (uint32_t k = 0; k < network->element_count; k++) {
        const spec_element *e = &network->elements[k];
        const double pressure = fabs((double)e->pressure), fill = (double)e->fill, gas = pressure * fill;
        const double stiffness = (e->kind == SPEC_GAS ? gas : (double)e->stiffness) / e->rest_area;
        const double outline = e->kind == SPEC_GAS ? gas : pressure + (double)e->stiffness * fabs(fill - 1.0);
        double all = 0.0;
        for (uint32_t i = 0; i < e->count; i++) {
            all += (double)e->reach[i];
        }
        for (uint32_t i = 0; i < e->count; i++) {
            const double reach = (double)e->reach[i], others = e->count == 4 ? 0.5 * all : all - reach;
            spec_vector *sum = &sums[e->corners[i]].place;
            sum->x += bounded(stiffness * reach * others + outline);
            sum->y += bounded((double)e->damping * reach * others);
        }
    }
}

// The largest sum of two corners of an element, each by its mass.
double spec_largest_quotient(const spec_network *network, const spec_motion *sums, bool of_damping) {
    double largest = 0.0;
    for (uint32_t k = 0; k < network->element_count; k++) {
        const spec_element *e = &network->elements[k];
        double first = 0.0, second = 0.0;
        for (uint32_t i = 0; i < e->count; i++) {
            const spec_vector sum = sums[e->corners[i]].place;
            const double quotient =
                (double)(of_damping ? sum.y : sum.x) * (double)network->inverse_masses[e->corners[i]];
            second = fmax(second, fmin(first, quotient));
            first = fmax(first, quotient);
        }
        largest = fmax(largest, first + second);
    }
    return largest;
}

/* --------------------------------------------------------------------------------------------------- in a step */

// Substeps from first on that are taken together. Where anything acts between two, each is taken alone; actuators
// that change several times in a step cut it there.
uint32_t spec_free_substeps(const spec_network *network, uint32_t first, uint32_t count) {
    const uint32_t period = network->hook != NULL ? network->hook_period : count;
    bool is_cut = false;
    for (uint32_t k = 0; k < network->element_count; k++) {
        is_cut |= is_outside(network, &network->elements[k]);
    }
    for (uint32_t i = 0; i < network->grip_count; i++) {
        is_cut |= network->inverse_masses[network->grips[i].particle] > 0.0f;
    }
    for (uint32_t s = 0; s < network->spring_count; s++) {
        is_cut |= network->springs[s].side != 0;
    }
    uint32_t end = first + 1;
    const uint32_t most = first + spec_free_of_yield(network, first, count);
    while (!is_cut && end < most && end < count && end % period != 0 && spec_changes_by(network, end, count) == spec_changes_by(network, first, count)) {
        end++;
    }
    return end - first;
}

// The hook comes first, then elements.
void spec_add_fields(const spec_network *network, uint32_t first) {
    if (network->hook != NULL && first % network->hook_period == 0) {
        memset(network->held, 0, network->particle_count * sizeof *network->held);
        network->hook(network, network->held);
    }
    for (uint32_t p = 0; network->hook != NULL && p < network->particle_count; p++) {
        network->fields[p].x += network->held[p].x;
        network->fields[p].y += network->held[p].y;
    }
    for (uint32_t k = 0; k < network->element_count; k++) {
        const spec_element *e = &network->elements[k];
        if (is_outside(network, e) && e->kind == SPEC_ANGLE) {
            push_angle(network, e);
        } else if (is_outside(network, e)) {
            push_area(network, e);
        }
    }
}

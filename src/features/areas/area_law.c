/// Law of an area, by the positions of its corners (areas.h).
#include "base/shoelace.h"
#include "features/areas/areas.h"

/// Part of the rest area below which the pressure of a gas no longer rises.
#define SMALLEST 0.05

double mspringi_area_pressure(const void *of, double size) {
    const mspringi_area *area = of;
    const double share = size / area->rest_area, fill = (double)area->fill, pressure = (double)area->pressure;
    return area->kind == MSPRING_AREA_GAS ? pressure * fill / fmax(share, SMALLEST)
                                          : pressure + (double)area->stiffness * (fill - share);
}

double mspringi_area_stiffness(const void *of, double size) {
    const mspringi_area *area = of;
    const double share = size / area->rest_area;
    if (area->kind == MSPRING_AREA_ELASTIC)
        return (double)area->stiffness / area->rest_area;
    return share > SMALLEST ? mspringi_area_pressure(area, size) / size : 0.0;
}

// ln m = 2 artanh((m - 1) / (m + 1)), by that quotient, of at most 0.1716 in size. Not every host has libm's.
static double logarithm_by(double quotient) {
    double sum = 0.0;
    for (int power = 21; power > 0; power -= 2)
        sum = sum * quotient * quotient + 2.0 / (double)power;
    return sum * quotient;
}

// Of a number > 0, by that of a part of it between sqrt(1 / 2) and sqrt(2).
static double logarithm(double x) {
    const double ln2 = 0.693147180559945309417;
    double powers = 0.0;
    for (; x > 1.4142135623730951 && x < INFINITY; x *= 0.5)
        powers += 1.0;
    for (; x < 0.70710678118654752; x *= 2.0)
        powers -= 1.0;
    return powers * ln2 + logarithm_by((x - 1.0) / (x + 1.0));
}

double mspringi_area_energy(const void *of, double size) {
    const mspringi_area *area = of;
    const double share = size / area->rest_area, fill = (double)area->fill, lacks = fill - share;
    const double pressure = (double)area->pressure * area->rest_area;
    if (area->kind == MSPRING_AREA_ELASTIC)
        return lacks * (0.5 * (double)area->stiffness * area->rest_area * lacks + pressure);
    const double down_to = fmax(share, SMALLEST);
    return pressure * fill * ((down_to - share) / SMALLEST - logarithm(down_to / fill));
}

/* --------------------------------------------------------------------------------------------------- positions */

static double area_size(const mspringi_element_ref *e, const mspringi_positions *at) {
    mspringi_shoelace polygon = {0};
    for (uint32_t i = 1; i < e->count; ++i) {
        const mspringi_vector here = mspringi_way_of(at, e, 0, i);
        mspringi_shoelace_add(&polygon, here.x, here.y);
    }
    return 0.5 * polygon.twice;
}

static mspringi_vector area_gradient(const mspringi_element_ref *e, const mspringi_positions *at, uint32_t corner) {
    const mspringi_vector across =
        mspringi_way_of(at, e, corner > 0 ? corner - 1 : e->count - 1, corner + 1 < e->count ? corner + 1 : 0);
    return (mspringi_vector){0.5 * across.y, -0.5 * across.x};
}

// Growth of an area by a move. A difference of areas would be lost in rounding.
static double growth_of(const mspringi_element_ref *e, const mspringi_positions *at, const mspringi_move *move) {
    double twice = 0.0;
    mspringi_vector before = mspringi_way_of(at, e, 0, 1), before_moved = mspringi_move_of(move, e, 0, 1);
    for (uint32_t i = 2; i < e->count; ++i) {
        const mspringi_vector here = mspringi_way_of(at, e, 0, i), here_moved = mspringi_move_of(move, e, 0, i);
        twice += (before.x * here_moved.y - before.y * here_moved.x) +
                 (before_moved.x * here.y - before_moved.y * here.x) +
                 (before_moved.x * here_moved.y - before_moved.y * here_moved.x);
        before = here;
        before_moved = here_moved;
    }
    return 0.5 * twice;
}

static double change_of(const mspringi_area *area, double size, double growth) {
    const double pressure = mspringi_area_pressure(area, size), part = growth / size, after = size + growth;
    if (area->kind == MSPRING_AREA_ELASTIC)
        return growth * (0.5 * (double)area->stiffness / area->rest_area * growth - pressure);
    if (!(fabs(part) < 0.3) || !(fmin(size, after) > SMALLEST * area->rest_area))
        return mspringi_area_energy(area, after) - mspringi_area_energy(area, size);
    return -pressure * size * logarithm_by(part / (2.0 + part));
}

static double area_energy_change(const mspringi_element_ref *e, const mspringi_positions *at,
                                 const mspringi_move *move, double *sum) {
    const double change = change_of(e->of, area_size(e, at), growth_of(e, at, move));
    *sum += fabs(change);
    return change;
}

// Distance of the middle of a side from that of the corners.
static double middle_of(const mspringi_element_ref *e, const mspringi_positions *at, uint32_t side,
                        mspringi_vector middle) {
    const mspringi_vector a = mspringi_way_of(at, e, 0, side),
                          b = mspringi_way_of(at, e, 0, side + 1 < e->count ? side + 1 : 0);
    const double x = 0.5 * (a.x + b.x) - middle.x, y = 0.5 * (a.y + b.y) - middle.y;
    return sqrt(x * x + y * y);
}

// As in implicit substeps (implicit_areas.c). That is an upper bound, so Newton's step still descends.
static void area_blocks(const mspringi_element_ref *e, const mspringi_positions *at, bool clamped,
                        mspringi_side_block *blocks) {
    const double c = mspringi_area_stiffness(e->of, area_size(e, at));
    mspringi_vector middle = {0.0, 0.0};
    double all = 0.0;
    (void)clamped;
    for (uint32_t i = 1; i < e->count; ++i) {
        const mspringi_vector here = mspringi_way_of(at, e, 0, i);
        middle.x += here.x / (double)e->count;
        middle.y += here.y / (double)e->count;
    }
    for (uint32_t side = 0; side < e->count; ++side)
        all += middle_of(e, at, side, middle);
    for (uint32_t side = 0; side < e->count; ++side) {
        const mspringi_vector d = mspringi_way_of(at, e, side, side + 1 < e->count ? side + 1 : 0);
        const double square = d.x * d.x + d.y * d.y;
        const double k = c * all * middle_of(e, at, side, middle);
        blocks[side] = square > 0.0 ? (mspringi_side_block){k * d.x * d.x / square, k * d.x * d.y / square,
                                                            k * d.y * d.y / square}
                                    : (mspringi_side_block){0.0, 0.0, 0.0};
    }
}

// Springs of half the pressure along the outline.
static double area_rest(const mspringi_element_ref *e, const mspringi_positions *at, uint32_t side) {
    (void)e, (void)at, (void)side;
    return 0.5;
}

static mspringi_element_bound area_bound(const void *of) {
    const mspringi_area *area = of;
    const bool is_gas = area->kind == MSPRING_AREA_GAS;
    const double fill = (double)area->fill, pressure = fabs((double)area->pressure);
    const double stiffness = (double)area->stiffness;
    return is_gas ? (mspringi_element_bound){pressure * fill / area->rest_area, pressure * fill}
                  : (mspringi_element_bound){stiffness / area->rest_area, pressure + stiffness * fabs(fill - 1.0)};
}

const mspringi_element_law mspringi_law_of_areas = {.size = area_size,
                                                    .gradient = area_gradient,
                                                    .force = mspringi_area_pressure,
                                                    .stiffness = mspringi_area_stiffness,
                                                    .energy = mspringi_area_energy,
                                                    .energy_change = area_energy_change,
                                                    .blocks = area_blocks,
                                                    .rest = area_rest,
                                                    .bound = area_bound};

/* -------------------------------------------------------------------------------------------------------- push */

// mspringi_area_push() for the four corners of a cell, whose coordinates stay in registers.
static void push_cell(const mspringi_state *s, const mspringi_area *area, const mspringi_corner *corners,
                      double share, mspringi_field field) {
    double x[4], y[4];
    mspringi_shoelace polygon = {0};
    for (int i = 0; i < 4; ++i) {
        x[i] = mspringi_x_of(s, corners[i].slot);
        y[i] = mspringi_y_of(s, corners[i].slot);
    }
    for (int i = 1; i < 4; ++i)
        mspringi_shoelace_add(&polygon, x[i] - x[0], y[i] - y[0]);
    const double half = 0.5 * share * mspringi_area_pressure(area, 0.5 * polygon.twice);
    for (int i = 0; i < 4; ++i) {
        const int before = (i + 3) % 4, next = (i + 1) % 4;
        field.x[corners[i].slot] += mspringi_bounded(half * (y[next] - y[before]));
        field.y[corners[i].slot] += mspringi_bounded(half * (x[before] - x[next]));
    }
}

void mspringi_area_push(const mspring_network *network, const mspringi_area *area, double share,
                        mspringi_field field) {
    if (area->is_angle) {
        mspringi_angles->push(network, area, share, field);
        return;
    }
    const mspringi_state *s = &network->state;
    const mspringi_corner *corners = network->areas->corners + area->first;
    if (area->count == 4) {
        push_cell(s, area, corners, share, field);
        return;
    }
    const uint32_t first = corners[0].slot, last = corners[area->count - 1].slot;
    const double first_x = mspringi_x_of(s, first), first_y = mspringi_y_of(s, first);
    const double last_x = mspringi_x_of(s, last), last_y = mspringi_y_of(s, last);
    mspringi_shoelace polygon = {0};
    for (uint32_t i = 1; i < area->count; ++i)
        mspringi_shoelace_add(&polygon, mspringi_x_of(s, corners[i].slot) - first_x,
                              mspringi_y_of(s, corners[i].slot) - first_y);
    const double half = 0.5 * share * mspringi_area_pressure(area, 0.5 * polygon.twice);
    double x = first_x, y = first_y, before_x = last_x, before_y = last_y;
    for (uint32_t i = 0; i < area->count; ++i) {
        const bool is_last = i + 1 == area->count;
        const uint32_t slot = corners[i].slot;
        const double next_x = is_last ? first_x : mspringi_x_of(s, corners[i + 1].slot);
        const double next_y = is_last ? first_y : mspringi_y_of(s, corners[i + 1].slot);
        field.x[slot] += mspringi_bounded(half * (next_y - before_y));
        field.y[slot] += mspringi_bounded(half * (before_x - next_x));
        before_x = x;
        before_y = y;
        x = next_x;
        y = next_y;
    }
}

/// @file tools.c
/// Dragging, pinning, cutting, blasting, a floor, contact.
///
/// SPDX-License-Identifier: MIT
#include "internal.h"

#include <math.h>

// What is held is drawn to its goal as if all of the network hung on a critically damped spring of this angular
// frequency (rad/s); in one step it is never pulled or slowed by more than these parts of what would get it there.
static const double pull_frequency = 4;
static const double most_pull = 0.2;
static const double most_slowing = 0.5;
static const double most_distance = 60; // m

typedef struct point {
    double x, y;
} point;

static point place_of(mspring_id particle) {
    const uint32_t slot = page.view.slot_of_particle[particle];
    const point place = {page.view.origin_x + (double)page.view.x[slot],
                         page.view.origin_y + (double)page.view.y[slot]};
    return place;
}

static double square(double a) {
    return a * a;
}

// Particles within radius of a point, into page.list; at least the nearest. Returns how many.
static uint32_t list_near(double x, double y, double radius) {
    uint32_t count = 0;
    mspring_id nearest;
    if (mspring_network_particles_in_circle(page.network, x, y, radius, page.list, page.list_capacity, &count) ==
            MSPRING_OK &&
        count > 0)
        return count;
    if (mspring_network_nearest_particle(page.network, x, y, INFINITY, &nearest, NULL) != MSPRING_OK ||
        nearest == MSPRING_NONE)
        return 0;
    page.list[0] = nearest;
    return 1;
}

/* ----------------------------------------------------------------------------------------------------- dragging */

uint32_t page_hold(double x, double y, double radius) {
    const uint32_t count = list_near(x, y, radius);
    page_let_go();
    for (uint32_t i = 0; i < count; i++) {
        const float inverse = page.view.inverse_mass[page.view.slot_of_particle[page.list[i]]];
        if (inverse == 0)
            continue;
        page.held[page.held_count] = page.list[i];
        page.held_mass[page.held_count++] = 1 / inverse;
        page.hold_mass += 1 / (double)inverse;
    }
    page_hold_to(x, y);
    return page.held_count;
}

void page_hold_to(double x, double y) {
    page.hold_x = x;
    page.hold_y = y;
}

void page_let_go(void) {
    page.held_count = 0;
    page.hold_mass = 0;
}

static double limit(double value, double most) {
    return value > most ? most : value < -most ? -most : value;
}

void page_pull(double dt) {
    double x = 0, y = 0, vx = 0, vy = 0;
    if (page.held_count == 0)
        return;
    for (uint32_t i = 0; i < page.held_count; i++) {
        const uint32_t slot = page.view.slot_of_particle[page.held[i]];
        const double share = (double)page.held_mass[i] / page.hold_mass;
        x += share * (page.view.origin_x + (double)page.view.x[slot]);
        y += share * (page.view.origin_y + (double)page.view.y[slot]);
        vx += share * (double)page.view.vx[slot];
        vy += share * (double)page.view.vy[slot];
    }
    const double times = page.total_mass / page.hold_mass;
    const double pull = fmin(square(pull_frequency) * times, most_pull / square(dt));
    const double slowing = fmin(2 * pull_frequency * times, most_slowing / dt);
    const double ax = pull * limit(page.hold_x - x, most_distance) - slowing * vx;
    const double ay = pull * limit(page.hold_y - y, most_distance) - slowing * vy;
    for (uint32_t i = 0; i < page.held_count; i++) {
        page.force_x[i] = (float)(ax * (double)page.held_mass[i]);
        page.force_y[i] = (float)(ay * (double)page.held_mass[i]);
    }
    (void)page_done(mspring_network_apply_forces(page.network, MSPRING_PUSH_STEP, page.held, 0, page.held_count,
                                                 page.force_x, page.force_y, 1));
}

/* ------------------------------------------------------------------------------------------ pins, cuts, blasts */

mspring_result page_pin(double x, double y, double radius) {
    const uint32_t count = list_near(x, y, radius);
    double least = INFINITY;
    float scale = 0;
    for (uint32_t i = 0; i < count; i++) {
        const point at = place_of(page.list[i]);
        const double distance = square(at.x - x) + square(at.y - y);
        if (distance < least) {
            least = distance;
            scale = page.view.inverse_mass[page.view.slot_of_particle[page.list[i]]] == 0 ? 1 : 0;
        }
    }
    page.changes++;
    return page_done(mspring_network_set(page.network, MSPRING_INVERSE_MASS_SCALE, page.list, 0, count, &scale, 0));
}

// Those that are restored or broken are told as events, which are read behind the next step.
mspring_result page_cut(double x, double y, double x2, double y2) {
    uint32_t count = 0;
    const mspring_result result = mspring_network_springs_across(page.network, x, y, x2, y2, MSPRING_FIND_WHOLE,
                                                                 page.list, NULL, page.list_capacity, &count);
    if (result != MSPRING_OK)
        return page_done(result);
    return page_done(mspring_network_break_springs(page.network, page.list, 0, count));
}

mspring_result page_repair(void) {
    uint32_t count = 0;
    for (mspring_id spring = 0; spring < page.spring_count; spring++)
        if (page.springs[spring].rest_length == 0)
            page.list[count++] = spring;
    return page_done(mspring_network_restore_springs(page.network, page.list, 0, count, 1));
}

mspring_result page_blast(double x, double y, double radius, double speed) {
    const uint32_t count = list_near(x, y, radius);
    for (uint32_t i = 0; i < count; i++) {
        const float inverse = page.view.inverse_mass[page.view.slot_of_particle[page.list[i]]];
        const point at = place_of(page.list[i]);
        const double distance = sqrt(square(at.x - x) + square(at.y - y));
        const bool moves = inverse > 0 && distance > 0 && distance < radius;
        const double impulse = moves ? speed * (1 - distance / radius) / (distance * (double)inverse) : 0;
        page.force_x[i] = (float)(impulse * (at.x - x));
        page.force_y[i] = (float)(impulse * (at.y - y));
    }
    return page_done(mspring_network_apply_forces(page.network, MSPRING_PUSH_IMPULSE, page.list, 0, count,
                                                  page.force_x, page.force_y, 1));
}

/* ------------------------------------------------------------------------------------------- floor and contact */

mspring_result page_set_floor(double height) {
    if (!(height > -1e11))
        return page_done(mspring_network_set_floor(page.network, NULL));
    const double plane[4] = {0, height, 0, 1};
    mspring_floor_def def = mspring_floor_def_default();
    def.plane_count = 1;
    def.planes = plane;
    def.friction = 0.5f;
    return page_done(mspring_network_set_floor(page.network, &def));
}

mspring_result page_set_collide(uint32_t on) {
    mspring_contact_def def = mspring_contact_def_default();
    def.friction = 0.5f;
    return page_done(mspring_network_set_contact(page.network, on ? &def : NULL));
}

/// @file spec_pace.c
/// Specification of the number of substeps where it is left to the library: MSPRING_SUBSTEPS_AUTO and _EVEN.
///
/// SPDX-License-Identifier: MIT
#include "spec.h"

#include <math.h>
#include <string.h>

// The h above 0 with h^2 K + 2 h C = room.
static double limit_of(double k, double c, double room) {
    const double divisor = c + sqrt(c * c + k * room);
    return !(room > 0.0) ? 0.0 : divisor > 0.0 ? room / divisor : INFINITY;
}

// Longest substep that is stable in any shape: the smallest h over all springs with h^2 K + 2 h C = 4. K is the sum
// of S / m over both ends, with S the sum of stiffness over all springs of that end, by rising number. C is the
// same of damping. One-way springs count as four times as stiff. Relative ones take room off the 4, as they
// have the same strength in any substep. Broken springs count as whole. Areas and angles add to S after all springs, and their corners are
// a row of their own.
void spec_renew(spec_network *network) {
    double least = INFINITY;
    memset(network->before, 0, network->particle_count * sizeof *network->before); // sums: stiffness x, damping y
    for (uint32_t i = 0; i < network->spring_count; i++) {
        const spec_spring *s = &network->springs[i];
        const uint32_t ends[2] = {s->a, s->b};
        for (int end = 0; end < 2; end++) {
            spec_vector *sum = &network->before[ends[end]].place;
            if (s->is_relative) {
                const double mass = spec_reduced_mass(network, s), share = (double)s->stiffness_share * mass;
                const double strength = (s->side == 0 ? share : 4.0 * (double)s->stiffness_share * mass) +
                                        2.0 * ((double)s->damping_share * mass);
                network->before[ends[end]].velocity.x += (float)(strength * (double)network->inverse_masses[ends[end]]);
                continue;
            }
            sum->x += s->side == 0 ? s->stiffness : 4.0f * s->stiffness;
            sum->y += s->damping;
        }
    }
    spec_add_strengths(network, network->before);
    for (uint32_t i = 0; i < network->spring_count; i++) {
        const uint32_t a = network->springs[i].a, b = network->springs[i].b;
        const spec_vector at_a = network->before[a].place, at_b = network->before[b].place;
        const double per_a = (double)network->inverse_masses[a], per_b = (double)network->inverse_masses[b];
        const double k = (double)at_a.x * per_a + (double)at_b.x * per_b;
        const double c = (double)at_a.y * per_a + (double)at_b.y * per_b;
        const double relative = (double)network->before[a].velocity.x + (double)network->before[b].velocity.x;
        least = fmin(least, limit_of(k, c, 4.0 - relative * (1.0 - 1e-5)));
    }
    least = fmin(least, limit_of(spec_largest_quotient(network, network->before, false),
                                 spec_largest_quotient(network, network->before, true), 4.0));
    network->any_shape = least * (1.0 - 1e-5);
}

// Fewest substeps of dt that last at most so long.
static uint32_t substeps_within(double dt, double limit, uint32_t most) {
    const double count = dt / limit;
    if (!(count <= (double)most)) {
        return most + 1;
    }
    const uint32_t whole = (uint32_t)count;
    return (double)whole < count || whole == 0 ? whole + 1 : whole;
}

// True if dt is another one than that of the last step, but for its rounding.
bool spec_changes_dt(const spec_network *network, double dt) {
    return network->dt > 0.0 && !(fabs(dt - network->dt) <= 1e-6 * network->dt);
}

// Largest rate at which the ends of a live spring move against each other, in its rest length, 1/s.
static double violence_of(const spec_network *network) {
    float most = 0.0f; // square
    for (uint32_t i = 0; i < network->spring_count; i++) {
        const spec_spring *s = &network->springs[i];
        const spec_vector a = network->motions[s->a].velocity, b = network->motions[s->b].velocity;
        const float vx = b.x - a.x, vy = b.y - a.y, length = s->rest_length > 0.0f ? s->rest_length : SPEC_WELD;
        const float square =
            length > SPEC_WELD ? (vx * vx + vy * vy) / (length * length) : 0.0f; // welds are linear
        most = !s->is_broken && square > most ? square : most;
    }
    return sqrt((double)most);
}

// More substeps for violent motion: as many as it takes for the ends of no spring to move by more than a quarter of
// its length against each other in one, but at most most_work times as many as for calm motion.
static uint32_t raised(const spec_network *network, double dt, uint32_t calm) {
    const double work = network->most_work > 0 ? (double)network->most_work * (double)calm : INFINITY;
    const double most = fmin(work, (double)network->max_substeps);
    const double need = -floor(-dt * violence_of(network) / 0.25);
    return !((double)calm < most) || need <= (double)calm ? calm : need > most ? (uint32_t)most : (uint32_t)need;
}

// As few as are stable; if dt has changed in the last 600 steps, the number whose length is closest to the last one
// between 0.4 and 0.8 of what is stable.
static uint32_t count_auto(const spec_network *network, double dt) {
    const double limit = network->any_shape;
    const uint32_t most = network->max_substeps, least = substeps_within(dt, 0.8 * limit, most);
    if ((network->uneven == 0 && !spec_changes_dt(network, dt)) || least > most) {
        return raised(network, dt, substeps_within(dt, limit, most));
    }
    const double wanted = fmin(fmax((double)network->lag, 0.4 * limit), 0.8 * limit);
    const double more = -floor(-dt / wanted), fewer = fmax(more - 1.0, 1.0);
    const double closest = dt / fewer - wanted < wanted - dt / more ? fewer : more;
    return raised(network, dt, closest < (double)least ? least : closest < (double)most ? (uint32_t)closest : most);
}

// The length h stays while dt varies: the nearest whole number of substeps, at least one, and the rest is left to
// the next step. h is chosen anew, from dt, if it is not stable, or after 30 steps of one dt or of over twice the
// substeps that dt needs, or at once if it takes over 16 times as many.
static uint32_t count_even(const spec_network *network, double dt, spec_pace *pace, double *time) {
    const spec_pace *had = &network->pace;
    const uint32_t most = network->max_substeps, calm = substeps_within(dt, network->any_shape, most);
    const uint32_t fewest = raised(network, dt, calm);
    const double h = had->h, whole = fmax(floor((dt + had->left) / h + 0.5), 1.0), times = whole / (double)fewest;
    const double left = dt + had->left - whole * h;
    const bool is_ahead = dt < h && left < -1.5 * h;
    const bool is_settled = dt == network->dt || times > 2.0 || is_ahead;
    pace->steps = !is_settled ? 1 : had->steps < 30 ? had->steps + 1 : 30;
    if (fewest > most) {
        return fewest;
    }
    const bool keeps_dt = dt == had->dt && fabs(had->left) <= 0.5 * h;
    const bool is_too_long = !(h > 0.0 && h <= network->any_shape) || (fewest > calm && whole < (double)fewest);
    const bool is_too_short = pace->steps >= 30 || times > 16.0 || whole > (double)most ||
                              (is_ahead && (dt >= 0.5 * h || dt * 16.0 >= network->any_shape));
    if (keeps_dt || is_too_long || is_too_short) {
        pace->dt = dt;
        pace->h = (double)(float)(dt / (double)fewest);
        pace->steps = 0;
    } else if (!is_ahead) {
        pace->left = left;
        *time = whole * h;
        return (uint32_t)whole;
    }
    return fewest;
}

uint32_t spec_choose_substeps(spec_network *network, double dt, double *time) {
    spec_pace pace = network->pace;
    uint32_t count = network->substeps;
    *time = dt;
    if (network->substeps == SPEC_AUTO || network->substeps == SPEC_EVEN) {
        count = network->substeps == SPEC_AUTO ? count_auto(network, dt) : count_even(network, dt, &pace, time);
        if (count > network->max_substeps) {
            return 0;
        }
    }
    network->pace = pace;
    return count;
}

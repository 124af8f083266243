/// @file spec_springs.c
/// Specification of springs that change: relative ones before a step, then ramps and actuators; one-way springs before
/// each substep; breaks after the step.
///
/// SPDX-License-Identifier: MIT
#include "spec.h"

#include <math.h>

double spec_reduced_mass(const spec_network *network, const spec_spring *spring) {
    return 1.0 / (1.0 / (double)network->masses[spring->a] + 1.0 / (double)network->masses[spring->b]);
}

// Relative springs have the stiffness and damping that a substep of h can take.
void spec_derive_relative(const spec_network *network, float h) {
    const double rate = 1.0 / (double)h;
    for (uint32_t i = 0; i < network->spring_count; i++) {
        spec_spring *s = &network->springs[i];
        if (s->is_relative) {
            const double mass = spec_reduced_mass(network, s);
            s->stiffness = (float)((double)s->stiffness_share * mass * rate * rate);
            s->damping = (float)((double)s->damping_share * mass * rate);
        }
    }
}

// Changes of actuators that are due by a substep, that before it included.
uint32_t spec_changes_by(const spec_network *network, uint32_t substep, uint32_t count) {
    if (network->actuator_count == 0 || network->changes <= 1) {
        return 1;
    }
    return network->changes >= count ? substep + 1 : (uint32_t)((uint64_t)substep * network->changes / count) + 1;
}

// Actuators go to their new length in equal parts; the last change sets it exactly.
static void set_lengths(spec_network *network, uint32_t substep, uint32_t count) {
    const uint32_t all = network->changes < count ? network->changes : count;
    const uint32_t by = spec_changes_by(network, substep, count);
    for (uint32_t i = 0; i < network->actuator_count; i++) {
        const spec_actuator *a = &network->actuators[i];
        const float part = a->from + (a->to - a->from) * ((float)by / (float)all);
        network->springs[a->spring].rest_length = by == all ? a->to : part;
    }
}

// A spring that only pulls acts in a substep if it is longer than its rest length and the sum of its forces pulls.
static bool is_slack(const spec_network *network, const spec_spring *s) {
    const double x = spec_x_of(network, s->b) - spec_x_of(network, s->a);
    const double y = spec_y_of(network, s->b) - spec_y_of(network, s->a);
    const spec_vector a = network->motions[s->a].velocity, b = network->motions[s->b].velocity;
    const double length = sqrt(x * x + y * y), side = (double)s->side, dvx = (double)b.x - (double)a.x,
                 dvy = (double)b.y - (double)a.y;
    const double stretch = length - (double)s->rest_length;
    const double rate = length > 0.0 ? (dvx * x + dvy * y) / length : 0.0;
    const double force = (double)s->stiffness * stretch + (double)s->damping * rate;
    return !(side * stretch > 0.0 && side * force > 0.0);
}

void spec_begin_substeps(spec_network *network, uint32_t first, uint32_t count) {
    set_lengths(network, first, count);
    for (uint32_t i = 0; i < network->spring_count; i++) {
        spec_spring *s = &network->springs[i];
        s->is_slack = s->side != 0 && is_slack(network, s);
    }
}

/* ----------------------------------------------------------------------------------------------- ramps and breaks */

void spec_begin_ramp(const spec_network *network, spec_spring *s, double seconds) {
    const spec_vector a = network->motions[s->a].place, b = network->motions[s->b].place;
    const double x = (double)b.x - (double)a.x, y = (double)b.y - (double)a.y;
    if (s->rest_length > 0.0f && seconds > 0.0) {
        s->ramp = (spec_ramp){.from = fmax(sqrt(x * x + y * y), 1e-3 * (double)s->rest_length),
                              .to = s->rest_length,
                              .seconds = seconds};
        s->rest_length = (float)s->ramp.from;
    }
}

// Rest lengths on ramps are those of the end of the step.
void spec_follow_ramps(const spec_network *network, double dt) {
    for (uint32_t i = 0; i < network->spring_count; i++) {
        spec_spring *s = &network->springs[i];
        const spec_ramp *ramp = &s->ramp;
        const double passed = (ramp->passed + dt) / ramp->seconds;
        if (ramp->seconds > 0.0) {
            s->rest_length =
                passed < 1.0 ? (float)(ramp->from + ((double)ramp->to - ramp->from) * passed) : ramp->to;
        }
    }
}

static void let_pass(spec_spring *s, double dt) {
    s->ramp.passed += dt;
    if (!(s->ramp.passed < s->ramp.seconds)) {
        s->ramp = (spec_ramp){0};
    }
}

void spec_break(spec_spring *s) {
    s->is_broken = true;
    s->rest_length = s->ramp.seconds > 0.0 ? s->ramp.to : s->rest_length;
    s->ramp = (spec_ramp){0};
}

// After a step: a spring breaks whose length differs from its rest length by more than its limit, by first words. A
// one-way spring on its slack side does not; a weld has the limit of a spring of one metre; one that has flowed is
// compared with its rest length before any flow.
static bool must_break(const spec_network *network, const spec_spring *s) {
    const spec_vector a = network->motions[s->a].place, b = network->motions[s->b].place;
    const float own = s->nominal > 0.0f && !(s->ramp.seconds > 0.0) ? s->nominal : s->rest_length;
    const float x = b.x - a.x, y = b.y - a.y, rest_length = own > 0.0f ? own : SPEC_WELD;
    const float change = sqrtf(x * x + y * y) - rest_length, whole = own > 0.0f ? rest_length : 1.0f;
    return !s->is_broken && (float)s->side * change >= 0.0f && fabsf(change) > s->break_strain * whole;
}

void spec_end_step(spec_network *network, double dt) {
    for (uint32_t i = 0; i < network->grip_count; i++) {
        network->grips[i].from_x = network->grips[i].x;
        network->grips[i].from_y = network->grips[i].y;
    }
    for (uint32_t i = 0; i < network->spring_count; i++) {
        spec_spring *s = &network->springs[i];
        s->is_slack = false;
        let_pass(s, dt);
        if (must_break(network, s)) {
            spec_break(s);
        }
    }
    network->actuator_count = 0;
}

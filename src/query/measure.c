/// Measurements of the state, summed in double precision in id order.
#include <math.h>

#include "kernels/spring_law.h"
#include "query/kinetic.h"
#include "query/measure.h"
#include "store/element_laws.h"
#include "store/moments.h"
#include "store/springs.h"

static bool is_pinned(const mspring_network *network, mspring_id particle) {
    return network->inverse_mass[network->topology.slot_of_particle[particle]] == 0.0f;
}

// Length of a spring, and its rate of change.
static double spring_length(const mspring_network *network, const mspringi_spring_values *r, double *rate) {
    const mspringi_state *s = &network->state;
    const double dx = mspringi_x_of(s, r->tip) - mspringi_x_of(s, r->base);
    const double dy = mspringi_y_of(s, r->tip) - mspringi_y_of(s, r->base);
    const double dvx = (double)s->vx[r->tip] - (double)s->vx[r->base];
    const double dvy = (double)s->vy[r->tip] - (double)s->vy[r->base];
    const double length = sqrt(dx * dx + dy * dy);
    *rate = length > 0.0 ? (dvx * dx + dvy * dy) / length : 0.0;
    return length;
}

float mspringi_spring_slot_length(const mspring_network *network, mspringi_spring_slot spring_slot) {
    const mspringi_spring_values r = mspringi_spring_slot_get(network, spring_slot);
    double rate;
    return (float)spring_length(network, &r, &rate);
}

float mspringi_spring_slot_strain(const mspring_network *network, mspringi_spring_slot spring_slot) {
    if (!mspringi_spring_slot_is_live(network, spring_slot))
        return 0.0f;
    const mspringi_spring_values r = mspringi_spring_slot_get(network, spring_slot);
    const double rest_length = (double)mspringi_read_length(r.rest_length);
    double rate;
    return (float)((spring_length(network, &r, &rate) - rest_length) /
                   (double)mspringi_strain_length(r.rest_length));
}

float mspringi_spring_strain(const mspring_network *network, mspring_id spring) {
    return mspringi_spring_slot_strain(network, mspringi_slot_of_spring(&network->topology, spring));
}

float mspringi_spring_force(const mspring_network *network, mspring_id spring) {
    const mspringi_spring_values r = mspringi_spring_get(network, spring);
    const double stiffness = (double)r.stiffness, damping = (double)r.damping;
    double rate;
    const double length = spring_length(network, &r, &rate), stretch = length - (double)r.rest_length;
    const double pull = MSPRINGI_LAW_FORCE(MSPRINGI_TIMES, stiffness, stretch);
    const double force = pull + MSPRINGI_LAW_DAMPING_FORCE(MSPRINGI_TIMES, damping, rate);
    const int side = mspringi_side_of(network, spring);
    if (mspringi_is_slack(side, stretch) || mspringi_is_slack(side, force))
        return 0.0f;
    return length > 0.0 ? (float)force : 0.0f;
}

// Energy stored by the hardening of a spring that has flowed.
static double hardening_energy(const mspring_network *network, mspring_id spring, double stiffness) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    const double flow = (double)mspringi_spring_slot_own_length(network, spring_slot) -
                        (double)network->tested.nominal[spring_slot];
    return 0.5 * stiffness * (double)network->tested.hardening[spring_slot] * flow * flow;
}

mspring_result mspring_network_energy(const mspring_network *network, double *kinetic, double *elastic,
                                      double *potential) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    const mspringi_topology *t = &network->topology;
    const mspringi_state *s = &network->state;
    double potential_sum = 0.0, elastic_sum = 0.0;
    for (mspring_id p = 0; p < t->particle_count; ++p) {
        const uint32_t slot = t->slot_of_particle[p];
        if (is_pinned(network, p))
            continue;
        const double mass = (double)network->mass[p];
        const double x = network->origin_x + mspringi_x_of(s, slot), y = network->origin_y + mspringi_y_of(s, slot);
        potential_sum -= mass * ((double)network->settings.gravity_x * x + (double)network->settings.gravity_y * y);
    }
    for (mspring_id i = 0; elastic && i < t->spring_count; ++i) {
        const mspringi_spring_values r = mspringi_spring_get(network, i);
        double rate;
        const double stretch = spring_length(network, &r, &rate) - (double)r.rest_length;
        if (!mspringi_is_slack(mspringi_side_of(network, i), stretch))
            elastic_sum += 0.5 * (double)r.stiffness * stretch * stretch;
        if (network->tested.nominal)
            elastic_sum += hardening_energy(network, i, (double)r.stiffness);
    }
    mspringi_element_walk walk = mspringi_walk_elements(network);
    while (elastic && mspringi_element_next(&walk))
        elastic_sum += mspringi_element_energy(network, &walk.element);
    if (kinetic)
        *kinetic = mspringi_kinetic_energy(network);
    if (elastic)
        *elastic = elastic_sum;
    if (potential)
        *potential = potential_sum;
    return MSPRING_OK;
}

mspring_result mspring_network_momentum(const mspring_network *network, double *px, double *py, double *angular) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    const mspringi_topology *t = &network->topology;
    const mspringi_state *s = &network->state;
    double sum_x = 0.0, sum_y = 0.0, sum_angular = 0.0;
    for (mspring_id p = 0; p < t->particle_count; ++p) {
        const uint32_t slot = t->slot_of_particle[p];
        if (is_pinned(network, p))
            continue;
        const mspringi_moments moments = mspringi_moments_of(network, p);
        const double x = network->origin_x + mspringi_x_of(s, slot), y = network->origin_y + mspringi_y_of(s, slot);
        sum_x += moments.px;
        sum_y += moments.py;
        sum_angular += x * moments.py - y * moments.px;
    }
    if (px)
        *px = sum_x;
    if (py)
        *py = sum_y;
    if (angular)
        *angular = sum_angular;
    return MSPRING_OK;
}

mspring_result mspring_network_bounds(const mspring_network *network, double *min_x, double *min_y, double *max_x,
                                      double *max_y) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    if (!min_x || !min_y || !max_x || !max_y)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT, "the place for a bound is NULL");
    const mspringi_topology *t = &network->topology;
    const mspringi_state *s = &network->state;
    double low_x = INFINITY, low_y = INFINITY, high_x = -INFINITY, high_y = -INFINITY;
    bool any = false;
    for (mspring_id p = 0; p < t->particle_count; ++p) {
        const uint32_t slot = t->slot_of_particle[p];
        if (!mspringi_particle_exists(network, p))
            continue;
        any = true;
        low_x = fmin(low_x, mspringi_x_of(s, slot));
        low_y = fmin(low_y, mspringi_y_of(s, slot));
        high_x = fmax(high_x, mspringi_x_of(s, slot));
        high_y = fmax(high_y, mspringi_y_of(s, slot));
    }
    if (!any)
        low_x = low_y = high_x = high_y = 0.0;
    *min_x = network->origin_x + low_x;
    *min_y = network->origin_y + low_y;
    *max_x = network->origin_x + high_x;
    *max_y = network->origin_y + high_y;
    return MSPRING_OK;
}

mspring_result mspring_network_get_spring(const mspring_network *network, mspring_id spring,
                                          mspring_spring_info *info) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_spring_info, info);
    if (result != MSPRING_OK)
        return result;
    const mspringi_topology *t = &network->topology;
    if (spring >= t->spring_count || !mspringi_spring_exists(network, spring))
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ID, "there is no spring %s",
                                    MSPRINGI_ID(spring));
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(t, spring);
    const mspringi_spring_values r = mspringi_spring_slot_get(network, spring_slot);
    const mspringi_ends ends = mspringi_spring_ends(network, spring);
    const mspringi_relative nominal = mspringi_spring_get_nominal(network, spring, spring_slot);
    const mspring_spring_info made = {
        .flags = mspringi_spring_flags(network, spring),
        .a = t->particle_of_slot[ends.a],
        .b = t->particle_of_slot[ends.b],
        .stiffness = r.stiffness,
        .damping = r.damping,
        .rest_length = mspringi_read_length(r.rest_length),
        .length = mspringi_spring_slot_length(network, spring_slot),
        .strain = mspringi_spring_slot_strain(network, spring_slot),
        .force = mspringi_spring_force(network, spring),
        .nominal_stiffness = nominal.stiffness,
        .nominal_damping = nominal.damping,
    };
    mspringi_put_spring_info(info, &made);
    return MSPRING_OK;
}

/// Measurements of the state, summed in double precision in id order.
#include <math.h>

#include "base/assert.h"
#include "base/cpu.h"

#include "kernels/spring_law.h"
#include "query/kinetic.h"
#include "query/measure.h"
#include "store/element_laws.h"
#include "store/feature.h"
#include "store/moments.h"
#include "store/springs.h"

static bool is_pinned(const mspring_network *network, mspring_id particle) {
    return network->inverse_mass[network->topology.slot_of_particle[particle]] == 0.0f;
}

enum { BATCH = 64 }; // springs whose values are read together

// Length of a spring.
static inline double spring_length(const mspring_network *network, const mspringi_spring_values *r) {
    const mspringi_state *s = &network->state;
    const double dx = mspringi_x_of(s, r->tip) - mspringi_x_of(s, r->base);
    const double dy = mspringi_y_of(s, r->tip) - mspringi_y_of(s, r->base);
    return sqrt(dx * dx + dy * dy);
}

float mspringi_spring_strain(const mspring_network *network, mspring_id spring) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    MSPRINGI_ASSERT(mspringi_spring_slot_is_live(network, spring_slot));
    const mspringi_spring_values r = mspringi_spring_slot_get(network, spring_slot);
    const double rest_length = (double)mspringi_read_length(r.rest_length);
    return (float)((spring_length(network, &r) - rest_length) / (double)mspringi_strain_length(r.rest_length));
}

float mspringi_force_of(const mspring_network *network, mspring_id spring, const mspringi_spring_values *r,
                        double *dx, double *dy, double *length) {
    const mspringi_state *s = &network->state;
    *dx = mspringi_x_of(s, r->tip) - mspringi_x_of(s, r->base);
    *dy = mspringi_y_of(s, r->tip) - mspringi_y_of(s, r->base);
    *length = sqrt(*dx * *dx + *dy * *dy);
    if (!(*length > 0.0))
        return 0.0f;
    const double dvx = (double)s->vx[r->tip] - (double)s->vx[r->base];
    const double dvy = (double)s->vy[r->tip] - (double)s->vy[r->base];
    const double stretch = *length - (double)r->rest_length, rate = (dvx * *dx + dvy * *dy) / *length;
    const double pull = MSPRINGI_LAW_FORCE(MSPRINGI_TIMES, (double)r->stiffness, stretch);
    const double force = pull + MSPRINGI_LAW_DAMPING_FORCE(MSPRINGI_TIMES, (double)r->damping, rate);
    const int side = mspringi_side_of(network, spring);
    return mspringi_is_slack(side, stretch) || mspringi_is_slack(side, force) ? 0.0f : (float)force;
}

float mspringi_spring_force(const mspring_network *network, mspring_id spring) {
    const mspringi_spring_values r = mspringi_spring_get(network, spring);
    double dx, dy, length;
    return mspringi_force_of(network, spring, &r, &dx, &dy, &length);
}

// Energy stored by the hardening of a spring that has flowed.
static double hardening_energy(const mspring_network *network, mspring_id spring, double stiffness) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
    const double flow = (double)mspringi_spring_slot_own_length(network, spring_slot) -
                        (double)network->tested.nominal[spring_slot];
    return 0.5 * stiffness * (double)network->tested.hardening[spring_slot] * flow * flow;
}

static double potential_energy(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const mspringi_state *s = &network->state;
    double sum = 0.0;
    for (mspring_id p = 0; p < t->particle_count; ++p) {
        const uint32_t slot = t->slot_of_particle[p];
        if (is_pinned(network, p))
            continue;
        const double mass = (double)network->mass[p];
        const double x = network->origin_x + mspringi_x_of(s, slot), y = network->origin_y + mspringi_y_of(s, slot);
        sum -= mass * ((double)network->settings.gravity_x * x + (double)network->settings.gravity_y * y);
    }
    return sum;
}

static double elastic_energy(const mspring_network *network) {
    const uint32_t count = network->topology.spring_count;
    const mspringi_selection all = {.count = network->topology.spring_count};
    mspringi_spring_values read[BATCH];
    double elastic_sum = 0.0;
    for (mspring_id first = 0, end; first < count; first = end) {
        end = count - first < BATCH ? count : first + BATCH;
        mspringi_springs_get(network, &all, first, end - first, read);
        for (mspring_id i = first; i < end; ++i) {
            const mspringi_spring_values *r = &read[i - first];
            const double stretch = spring_length(network, r) - (double)r->rest_length;
            if (!mspringi_is_slack(mspringi_side_of(network, i), stretch))
                elastic_sum += 0.5 * (double)r->stiffness * stretch * stretch;
            if (network->tested.nominal)
                elastic_sum += hardening_energy(network, i, (double)r->stiffness);
        }
    }
    mspringi_element_walk walk = mspringi_walk_elements(network);
    while (mspringi_element_next(&walk))
        elastic_sum += mspringi_element_energy(network, &walk.element);
    return elastic_sum;
}

static uint32_t bent_springs(const mspring_network *network) {
    uint32_t count = 0;
    for (mspring_id s = 0; network->tested.is_bent && s < network->topology.spring_count; ++s) {
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, s);
        count += mspringi_spring_exists(network, s) &&
                 mspringi_spring_slot_own_length(network, spring_slot) != network->tested.nominal[spring_slot];
    }
    return count;
}

// The lowest of the fastest particles, and its speed.
static double largest_speed(const mspring_network *network, mspring_id *fastest) {
    const mspringi_state *s = &network->state;
    double largest = -1.0;
    *fastest = MSPRING_NONE;
    for (mspring_id p = 0; p < network->topology.particle_count; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        const double vx = (double)s->vx[slot], vy = (double)s->vy[slot], square = vx * vx + vy * vy;
        if (square > largest && mspringi_particle_exists(network, p)) {
            largest = square;
            *fastest = p;
        }
    }
    return largest > 0.0 ? sqrt(largest) : 0.0;
}

// The lowest of the springs with the strain of the largest size, and its strain, as MSPRING_STRAIN rounds it.
static double largest_strain(const mspring_network *network, mspring_id *strained) {
    const uint32_t count = network->topology.spring_count;
    float strains[BATCH], largest = 0.0f;
    *strained = MSPRING_NONE;
    for (mspring_id first = 0; first < count; first += BATCH) {
        const uint32_t number = count - first < BATCH ? count - first : BATCH;
        mspringi_measure(network, &(mspringi_selection){.first = first, .count = number},
                         &(mspringi_lengths){.strain = strains, .strain_stride = 1});
        for (uint32_t i = 0; i < number; ++i)
            if (fabsf(strains[i]) > fabsf(largest) ||
                (*strained == MSPRING_NONE && mspringi_spring_exists(network, first + i))) {
                largest = strains[i];
                *strained = first + i;
            }
    }
    return (double)largest;
}

static MSPRINGI_NOINLINE mspring_energy energy_of(const mspring_network *network) {
    mspring_energy made = {
        .bent_springs = bent_springs(network),
        .kinetic = mspringi_kinetic_energy(network),
        .elastic = elastic_energy(network),
        .potential = potential_energy(network),
    };
#define YIELDED(function) function(network, &made);
#include "store/features.def"
    made.largest_speed = largest_speed(network, &made.fastest);
    made.largest_strain = largest_strain(network, &made.strained);
    return made;
}

mspring_result mspring_network_get_energy(const mspring_network *network, mspring_energy *energy) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_energy, energy);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_energy made = energy_of(network);
    mspringi_fp_leave(before);
    mspringi_put_energy(energy, &made);
    return MSPRING_OK;
}

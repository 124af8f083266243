/// Kinetic energy: explicit velocities belong to half a substep ago, so forces take them on to now,
///     v exp(-b t) + (F / m + gravity) (1 - exp(-b t)) / b,   t = lag / 2,   b = global_damping.
/// Nothing is allocated: particles are taken in chunks, whose forces lie on the stack.
#include "query/kinetic.h"

#include <math.h>
#include <string.h>

#include "base/decay.h"
#include "query/measure.h"
#include "store/feature.h"
#include "store/springs.h"

enum { CHUNK = 1024, MOST_RUNS = 256, BATCH = 64 };

/// Runs of springs of equal number, and the lowest and highest particle that each joins: for networks whose ids
/// follow places, a chunk has to look at few of them.
typedef struct spring_runs {
    uint32_t size, count;
    mspring_id lowest[MOST_RUNS], highest[MOST_RUNS];
} spring_runs;

static mspring_id lower(mspring_id a, mspring_id b) {
    return a < b ? a : b;
}

static void find_runs(const mspring_network *network, spring_runs *runs) {
    const mspringi_topology *t = &network->topology;
    const mspringi_selection all = {.count = network->topology.spring_count};
    mspringi_spring_values read[BATCH];
    runs->size = (t->spring_count + MOST_RUNS - 1) / MOST_RUNS;
    runs->count = 0;
    for (mspring_id first = 0; first < t->spring_count; first += runs->size) {
        mspring_id lowest = MSPRING_NONE, highest = 0;
        const mspring_id last = lower(first + runs->size, t->spring_count);
        for (mspring_id s = first, end; s < last; s = end) {
            end = lower(s + BATCH, last);
            mspringi_springs_get(network, &all, s, end - s, read);
            for (uint32_t i = 0; i < end - s; ++i) {
                const mspring_id a = t->particle_of_slot[read[i].base], b = t->particle_of_slot[read[i].tip];
                lowest = lower(lowest, lower(a, b));
                highest = a > highest ? a : highest;
                highest = b > highest ? b : highest;
            }
        }
        runs->lowest[runs->count] = lowest;
        runs->highest[runs->count++] = highest;
    }
}

// Add the force of a spring, x and y, and its stiffness to those of its ends that are in the chunk from first on.
static inline void add_force(const mspring_network *network, mspring_id spring, const mspringi_spring_values *r,
                             mspring_id first, double (*forces)[CHUNK]) {
    const mspringi_topology *t = &network->topology;
    const mspring_id a = t->particle_of_slot[r->base] - first, b = t->particle_of_slot[r->tip] - first;
    if (a >= CHUNK && b >= CHUNK)
        return;
    double dx, dy, length;
    const double force = (double)mspringi_force_of(network, spring, r, &dx, &dy, &length);
    const double pull = length > 0.0 ? force / length : 0.0, stiffness = (double)r->stiffness;
    if (a < CHUNK) {
        forces[0][a] += pull * dx;
        forces[1][a] += pull * dy;
        forces[2][a] += stiffness;
    }
    if (b < CHUNK) {
        forces[0][b] -= pull * dx;
        forces[1][b] -= pull * dy;
        forces[2][b] += stiffness;
    }
}

static void add_forces(const mspring_network *network, mspring_id begin, mspring_id last, mspring_id first,
                       double (*forces)[CHUNK]) {
    const mspringi_selection all = {.count = network->topology.spring_count};
    mspringi_spring_values read[BATCH];
    for (mspring_id s = begin, end; s < last; s = end) {
        end = lower(s + BATCH, last);
        mspringi_springs_get(network, &all, s, end - s, read);
        for (uint32_t i = 0; i < end - s; ++i)
            add_force(network, s + i, &read[i], first, forces);
    }
}

// stiffness: of the particle's springs together. Where they have become too stiff for the lag, it is cut as in a
// step.
static double energy_of(const mspring_network *network, mspring_id particle, double fx, double fy,
                        double stiffness) {
    const mspringi_state *s = &network->state;
    const uint32_t slot = network->topology.slot_of_particle[particle];
    if (network->inverse_mass[slot] == 0.0f)
        return 0.0;
    const double mass = (double)network->mass[particle], per_mass = (double)network->inverse_mass[slot];
    const double vx = mspringi_vx_of(s, slot), vy = mspringi_vy_of(s, slot);
    const float half = 0.5f * network->steps.lag, rate = network->settings.global_damping;
    const float cut = half > 0.0f && stiffness * per_mass > 0.0
                          ? fminf(half, (float)fmin(1.0 / sqrt(stiffness * per_mass), (double)half))
                          : half;
    const double keep = (double)mspringi_decay(rate, half), gain = (double)mspringi_gain(rate, half),
                 force_gain = (double)mspringi_gain(rate, cut);
    const double now_x = keep * vx + force_gain * fx * per_mass + gain * (double)network->settings.gravity_x;
    const double now_y = keep * vy + force_gain * fy * per_mass + gain * (double)network->settings.gravity_y;
    return 0.5 * mass * (now_x * now_x + now_y * now_y);
}

// True if springs, gravity and global damping are all that acts.
static bool is_plain(const mspring_network *network) {
    bool acts = false;
#define ACTS(function) acts = acts || function(network);
#include "store/features.def"
    return !acts;
}

static double stored_energy(const mspring_network *network) {
    double sum = 0.0;
    for (mspring_id p = 0; p < network->topology.particle_count; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        const double vx = mspringi_vx_of(&network->state, slot), vy = mspringi_vy_of(&network->state, slot);
        if (network->inverse_mass[slot] != 0.0f)
            sum += 0.5 * (double)network->mass[p] * (vx * vx + vy * vy);
    }
    return sum;
}

double mspringi_kinetic_energy(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    if (!(network->steps.lag > 0.0f) || !is_plain(network))
        return stored_energy(network);
    spring_runs runs;
    double sum = 0.0, forces[3][CHUNK];
    find_runs(network, &runs);
    for (mspring_id first = 0; first < t->particle_count; first += CHUNK) {
        memset(forces, 0, sizeof forces);
        for (uint32_t run = 0; run < runs.count; ++run) {
            const mspring_id begin = run * runs.size, end = lower(begin + runs.size, t->spring_count);
            const bool is_near = runs.lowest[run] < first + CHUNK && runs.highest[run] >= first;
            if (is_near)
                add_forces(network, begin, end, first, forces);
        }
        for (mspring_id p = first; p < lower(first + CHUNK, t->particle_count); ++p)
            sum += energy_of(network, p, forces[0][p - first], forces[1][p - first], forces[2][p - first]);
    }
    return sum;
}

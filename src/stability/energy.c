/// Energy that comes from nowhere.
#include "energy.h"

#include <math.h>

#include "implicit/implicit.h"
#include "network/springs.h"

/// What motion may gain is allowed this many times: integrators do not conserve energy in each single substep.
#define TOLERATED 2.0

/// Rounding of displacements in single precision, as a part of them.
#define ROUNDING 2e-6

/* --------------------------------------------------------------------------------------------------- suspicion */

/// What is known of the slots outside of lattices, and of those that they hang on.
typedef struct outsiders {
    float low_x, high_x, low_y, high_y; ///< displacements, m; the turning of tiles left out, which is less
    float lightest;                     ///< in units of A's masses
} outsiders;

static void look_at_slot(const mspring_network *network, float h, uint32_t slot, outsiders *o) {
    const mspringi_implicit *n = network->implicit;
    if (network->topology.particle_of_slot[slot] == MSPRING_NONE)
        return;
    const float x = h * network->state.vx[slot] + n->displacement.x[slot];
    const float y = h * network->state.vy[slot] + n->displacement.y[slot];
    const float mass = n->mass[slot] > 0.0f ? n->mass[slot] : o->lightest;
    o->low_x = x < o->low_x ? x : o->low_x;
    o->high_x = x > o->high_x ? x : o->high_x;
    o->low_y = y < o->low_y ? y : o->low_y;
    o->high_y = y > o->high_y ? y : o->high_y;
    o->lightest = mass < o->lightest ? mass : o->lightest;
}

static void look_at_blocks(const mspring_network *network, float h, uint32_t first, uint32_t count, outsiders *o) {
    for (uint32_t slot = first * MSPRINGI_WIDTH; slot < (first + count) * MSPRINGI_WIDTH; ++slot)
        look_at_slot(network, h, slot, o);
}

// The largest stiffness of a spring outside of lattices in A.
static float largest_stiffness(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const size_t first = t->lattice_places / MSPRINGI_WIDTH;
    const size_t end = (t->chain_places + (size_t)t->leftover_count + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
    float largest = 0.0f;
    for (size_t block = first; block < end; ++block) {
        const float *pull_x = network->implicit->factors + block * MSPRINGI_FACTORS * MSPRINGI_WIDTH;
        const float *pull_y = pull_x + MSPRINGI_WIDTH, *swing = pull_y + MSPRINGI_WIDTH;
        for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
            const float stiffness = swing[i] + (pull_x[i] * pull_x[i] + pull_y[i] * pull_y[i]);
            largest = stiffness > largest ? stiffness : largest;
        }
    }
    return largest;
}

// Whether springs may have been stretched, by moving across their direction, by energies that count beside those of
// the motion: with ends that moved apart by s, k s^4 / 8 L^2 beside m s^2 / 2h^2. Returns s, or 0: none.
static double find_suspicious_way(const mspring_network *network, float h) {
    const mspringi_topology *t = &network->topology;
    outsiders o = {INFINITY, -INFINITY, INFINITY, -INFINITY, INFINITY};
    look_at_blocks(network, h, t->chain_first, t->chain_blocks, &o);
    look_at_blocks(network, h, t->web_first, t->web_blocks, &o);
    for (uint32_t i = 0; i < t->web.attached_count; ++i)
        if (t->web.attached_slot[i] != MSPRING_NONE)
            look_at_slot(network, h, t->web.attached_slot[i], &o);
    const double x = (double)o.high_x - (double)o.low_x, y = (double)o.high_y - (double)o.low_y;
    const double way = x * x + y * y;
    const double stiffness = (double)largest_stiffness(network) / (double)o.lightest;
    return 0.25 * stiffness * way > network->shortest * network->shortest ? sqrt(way) : 0.0;
}

/* ------------------------------------------------------------------------------------------------------ energies
 */

static double length_between(double ax, double ay, double bx, double by) {
    return sqrt((bx - ax) * (bx - ax) + (by - ay) * (by - ay));
}

static double elastic(const mspringi_spring_values *s, double length) {
    const double extension = length - (double)s->rest_length;
    return 0.5 * (double)s->stiffness * extension * extension;
}

static double energy_before(const mspring_network *network, const mspringi_spring_values *s) {
    const mspringi_field low = network->implicit->history.low;
    const float *x = network->state.x, *y = network->state.y;
    return elastic(
        s, length_between((double)x[s->base] + (double)low.x[s->base], (double)y[s->base] + (double)low.y[s->base],
                          (double)x[s->tip] + (double)low.x[s->tip], (double)y[s->tip] + (double)low.y[s->tip]));
}

static double energy_after(const mspring_network *network, const mspringi_spring_values *s) {
    const mspringi_implicit *n = network->implicit;
    const mspringi_field d = n->displacement;
    return elastic(s, length_between(n->x[s->base] + (double)d.x[s->base], n->y[s->base] + (double)d.y[s->base],
                                     n->x[s->tip] + (double)d.x[s->tip], n->y[s->tip] + (double)d.y[s->tip]));
}

static bool is_live(const mspring_network *network, mspringi_place place) {
    return network->live[place / MSPRINGI_WIDTH] >> place % MSPRINGI_WIDTH & 1;
}

// Elastic energy after the substep of the springs outside of lattices, J, and which of them has most.
static double strained_to(const mspring_network *network, mspringi_place *most) {
    const mspringi_topology *t = &network->topology;
    double sum = 0.0, largest = -1.0;
    for (mspringi_place place = t->lattice_places; place < t->chain_places + t->leftover_count; ++place) {
        if (!is_live(network, place))
            continue;
        const mspringi_spring_values s = mspringi_place_get(network, place);
        const double energy = energy_after(network, &s);
        sum += energy;
        *most = energy > largest ? place : *most;
        largest = energy > largest ? energy : largest;
    }
    return sum;
}

/// Sums over all springs.
typedef struct spring_sums {
    double energy; ///< before the substep, J
    double driven; ///< k v^2 of those that hang on moving pins
    double noise;  ///< what rounding may be worth, J
} spring_sums;

static double speed_squared(const mspring_network *network, uint32_t slot) {
    const double vx = (double)network->state.vx[slot], vy = (double)network->state.vy[slot];
    return vx * vx + vy * vy;
}

static spring_sums sum_springs(const mspring_network *network, double way) {
    const mspringi_topology *t = &network->topology;
    spring_sums sum = {0.0, 0.0, 0.0};
    for (mspringi_place place = 0; place < t->chain_places + t->leftover_count; ++place) {
        if (!is_live(network, place))
            continue;
        const mspringi_spring_values s = mspringi_place_get(network, place);
        const uint32_t ends[] = {s.base, s.tip};
        sum.energy += energy_before(network, &s);
        sum.noise += 0.5 * (double)s.stiffness * (ROUNDING * way) * (ROUNDING * way);
        for (int i = 0; i < 2; ++i)
            if (network->inverse_mass[ends[i]] == 0.0f)
                sum.driven += (double)s.stiffness * speed_squared(network, ends[i]);
    }
    return sum;
}

/// Sums over all particles that are not pinned.
typedef struct particle_sums {
    double energy; ///< kinetic, before, J
    double pushed; ///< f^2 / 2m
} particle_sums;

static particle_sums sum_particles(const mspring_network *network, mspringi_field base) {
    particle_sums sum = {0.0, 0.0};
    const size_t slots = mspringi_slot_count(network);
    for (uint32_t slot = 0; slot < slots; ++slot) {
        const double inverse = (double)network->inverse_mass[slot], mass = 1.0 / inverse;
        if (!(inverse > 0.0))
            continue;
        const double ax = (double)network->gravity_x + (base.x ? (double)base.x[slot] * inverse : 0.0);
        const double ay = (double)network->gravity_y + (base.x ? (double)base.y[slot] * inverse : 0.0);
        sum.energy += 0.5 * mass * speed_squared(network, slot);
        sum.pushed += 0.5 * mass * (ax * ax + ay * ay);
    }
    return sum;
}

/* --------------------------------------------------------------------------------------------------- the whole */

void mspringi_energy_look(mspring_network *network, float h, mspringi_field base) {
    const mspringi_topology *t = &network->topology;
    mspringi_gain *gain = &network->implicit->gain;
    if (!mspringi_energy_is_watched(network) || gain->to > 0.0)
        return;
    const double way = find_suspicious_way(network, h);
    if (!(way > 0.0))
        return;
    mspringi_place place = t->lattice_places;
    const double after = strained_to(network, &place);
    const particle_sums particles = sum_particles(network, base);
    if (!(after > particles.energy))
        return;
    const spring_sums springs = sum_springs(network, way);
    const double root = sqrt(particles.energy + springs.energy + springs.noise) +
                        (double)h * (sqrt(particles.pushed) + sqrt(0.5 * springs.driven));
    if (after > TOLERATED * root * root)
        *gain = (mspringi_gain){.to = after, .most = root * root, .place = place};
}

// The spring that lies at a place.
static mspring_id find_spring(const mspringi_topology *t, mspringi_place place) {
    mspringi_place_reader reader;
    mspring_id spring = 0;
    mspringi_places_begin(&reader, &t->places, 0);
    while (spring + 1 < t->spring_count && mspringi_places_next(&reader) != place)
        ++spring;
    return spring;
}

mspring_result mspringi_energy_verdict(mspring_network *network, double dt) {
    const mspringi_topology *t = &network->topology;
    if (!network->implicit || !(network->implicit->gain.to > 0.0))
        return MSPRING_OK;
    const mspringi_gain gain = network->implicit->gain;
    uint32_t base, tip;
    mspringi_topology_ends(t, gain.place, &base, &tip);
    const mspring_id spring = find_spring(t, gain.place);
    const mspring_id a = t->particle_of_slot[base], b = t->particle_of_slot[tip];
    return mspringi_fail(
        &network->message, MSPRING_ERROR_UNSTABLE,
        "a step of %g s (substeps: %u): springs would be stretched by %g J, of which only %g J were "
        "there or can have been added; they are too stiff to be followed so far in one substep, as "
        "is spring %u between particles %u and %u: take a shorter step, more substeps or less "
        "stiffness",
        dt, (unsigned)network->substeps, gain.to, gain.most, (unsigned)spring, (unsigned)(a < b ? a : b),
        (unsigned)(a < b ? b : a));
}

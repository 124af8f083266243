/// Bound on the substep for every shape of the network.
///
/// A spring's tangent stiffness in any shape is at most its stiffness in every direction, and so is its damping. A
/// + 2 D (see pencil.h) is therefore at most the Laplacian of the graph with the weights w = h^2 k + 2 h c, once
/// for x and once for y. Its largest eigenvalue is also that of the matrix over springs G^T M^-1 G w (G the
/// incidence matrix), whose row sums are at most S(a) / m_a + S(b) / m_b, with S the sum of the weights at a
/// particle. (For graphs without weights: Anderson and Morley 1985.)
#include "stability/stability.h"

#include <math.h>
#include <string.h>

#include "stability/pencil.h"
#include "stability/stability_elements.h"
#include "stability/stability_limit.h"
#include "store/springs.h"

mspringi_strength mspringi_strength_of(const mspring_network *network, mspring_id spring,
                                       mspringi_spring_slot spring_slot, uint32_t base, uint32_t tip,
                                       mspringi_last_masses *last) {
    const bool is_relative = mspringi_spring_is_relative(network, spring);
    const mspringi_relative nominal = is_relative ? mspringi_fractions_of(&network->fractions, spring)
                                                  : mspringi_spring_get_nominal(network, spring, spring_slot);
    const double share = mspringi_side_of(network, spring) == 0 ? 1.0 : MSPRINGI_ONE_WAY_SHARE;
    const double stiffness = share * (double)nominal.stiffness, damping = (double)nominal.damping;
    if (!is_relative)
        return (mspringi_strength){.stiffness = stiffness, .damping = damping};
    const uint32_t *particle_of_slot = network->topology.particle_of_slot;
    const double a = (double)network->mass[particle_of_slot[base]],
                 b = (double)network->mass[particle_of_slot[tip]];
    if (a != last->a || b != last->b)
        *last = (mspringi_last_masses){a, b, mspringi_reduced_mass(a, b)};
    return (mspringi_strength){.relative_stiffness = stiffness * last->reduced,
                               .relative_damping = damping * last->reduced};
}

// Memory for sums by slot: the guard's scratch arrays, else the backup.
static mspringi_state choose_scratch(const mspring_network *network) {
    if (!network->guard_scratch)
        return network->backup;
    return (mspringi_state){.x = mspringi_stability_limit_scratch(network, 0),
                            .y = mspringi_stability_limit_scratch(network, 1),
                            .vx = mspringi_stability_limit_scratch(network, 2),
                            .vy = mspringi_stability_limit_scratch(network, 3)};
}

// Sum over the springs at each slot: stiffness in x, damping in y, and the strength of relative springs per mass in
// vx.
static void sum_strengths(const mspring_network *network, const mspringi_state *sums) {
    mspringi_last_masses last = {0.0, 0.0, 0.0};
    memset(sums->x, 0, 4 * mspringi_slot_count(network) * sizeof *sums->x);
    for (mspring_id i = 0; i < network->topology.spring_count; ++i) {
        const mspringi_spring_slot spring_slot = network->topology.slot_of_spring[i];
        if (!mspringi_spring_exists(network, i))
            continue;
        uint32_t ends[2];
        mspringi_topology_ends(&network->topology, spring_slot, &ends[0], &ends[1]);
        const mspringi_strength strength = mspringi_strength_of(network, i, spring_slot, ends[0], ends[1], &last);
        const double relative = strength.relative_stiffness + 2.0 * strength.relative_damping;
        for (int end = 0; end < 2; ++end) {
            if (relative > 0.0) {
                sums->vx[ends[end]] += (float)(relative * (double)network->inverse_mass[ends[end]]);
                continue;
            }
            sums->x[ends[end]] += (float)strength.stiffness;
            sums->y[ends[end]] += (float)strength.damping;
        }
    }
    mspringi_stability_elements_sum(network, sums->x, sums->y);
}

// Smallest limit of all springs. Relative springs take at most `max_relative` of the bound, which is 4.
static double find_limit(mspring_network *network, double max_relative, mspring_id *spring) {
    // Margin for the rounding of the sums.
    const double tight = 1.0 - 1e-5;
    const mspringi_state room = choose_scratch(network), *sums = &room;
    double smallest = INFINITY;
    mspringi_quotient tightest = {0.0, 0.0, 0.0}; // with the smallest limit so far; without any, the most relative
    sum_strengths(network, sums);
    *spring = MSPRING_NONE;
    for (mspring_id i = 0; i < network->topology.spring_count && smallest > 0.0; ++i) {
        uint32_t a, b;
        if (!mspringi_spring_exists(network, i))
            continue;
        mspringi_topology_ends(&network->topology, network->topology.slot_of_spring[i], &a, &b);
        const double relative = ((double)sums->vx[a] + (double)sums->vx[b]) * tight;
        const double per_a = (double)network->inverse_mass[a], per_b = (double)network->inverse_mass[b];
        const mspringi_quotient quotient = {
            .stiffness = (double)sums->x[a] * per_a + (double)sums->x[b] * per_b,
            .damping = (double)sums->y[a] * per_a + (double)sums->y[b] * per_b,
            .relative = relative < max_relative ? relative : max_relative,
        };
        if (quotient.stiffness <= tightest.stiffness && quotient.damping <= tightest.damping &&
            quotient.relative <= tightest.relative)
            continue; // its limit is no smaller: most springs are alike
        const double limit = mspringi_quotient_limit(&quotient, 0.0f);
        // No limit at all: neither have those that are less relative.
        if (limit < smallest || smallest == INFINITY)
            tightest = quotient;
        if (limit < smallest)
            *spring = i;
        smallest = limit < smallest ? limit : smallest;
    }
    // Corners of an element may have no spring between them.
    const mspringi_quotient elements = {.stiffness = mspringi_stability_elements_largest(network, sums->x),
                                        .damping = mspringi_stability_elements_largest(network, sums->y)};
    smallest = fmin(smallest, mspringi_quotient_limit(&elements, 0.0f));
    return smallest * tight;
}

static bool is_current(const mspringi_any_shape *known, const mspringi_edits *edits) {
    return known->is_known && known->masses == edits->masses && known->values == edits->values &&
           known->growth == edits->growth;
}

double mspringi_stable_in_any_shape(mspring_network *network, mspring_id *spring) {
    mspringi_any_shape *known = &network->any_shape, *last = &network->last_shape;
    const mspringi_edits *edits = &network->edits;
    if (!is_current(known, edits)) {
        if (!is_current(last, edits)) {
            *last = (mspringi_any_shape){
                .masses = edits->masses, .values = edits->values, .growth = edits->growth, .is_known = true};
            last->dt = find_limit(network, INFINITY, &last->spring);
        }
        *known = *last;
    }
    *spring = known->spring;
    return known->dt;
}

double mspringi_stable_with_relative(mspring_network *network) {
    mspring_id spring;
    mspringi_any_shape *last = &network->last_shape;
    (void)mspringi_stable_in_any_shape(network, &spring);
    if (!is_current(last, &network->edits))
        *last = network->any_shape;
    if (!(last->mixed_dt > 0.0))
        last->mixed_dt = find_limit(network, 2.0, &spring);
    return last->mixed_dt;
}

mspring_id mspringi_tightest_spring(mspring_network *network, double h) {
    const mspringi_topology *t = &network->topology;
    mspring_id named;
    (void)mspringi_stable_in_any_shape(network, &named);
    if (named == MSPRING_NONE)
        return named;
    uint32_t base, tip;
    mspringi_topology_ends(t, mspringi_slot_of_spring(t, named), &base, &tip);
    double most = 0.0;
    mspringi_last_masses last = {0.0, 0.0, 0.0};
    for (mspring_id i = 0; i < t->spring_count; ++i) {
        const mspringi_spring_slot spring_slot = t->slot_of_spring[i];
        uint32_t a, b;
        mspringi_topology_ends(t, spring_slot, &a, &b);
        if (!mspringi_spring_exists(network, i) || !(a == base || a == tip || b == base || b == tip))
            continue;
        const mspringi_strength s = mspringi_strength_of(network, i, spring_slot, a, b, &last);
        const double weight =
            h * (h * s.stiffness + 2.0 * s.damping) + s.relative_stiffness + 2.0 * s.relative_damping;
        const double rate = weight * ((double)network->inverse_mass[a] + (double)network->inverse_mass[b]);
        named = rate > most ? i : named;
        most = rate > most ? rate : most;
    }
    return named;
}

uint32_t mspringi_substeps_within(double dt, double limit, uint32_t most) {
    const double count = dt / limit;
    if (!(count <= (double)most))
        return most + 1;
    const uint32_t whole = (uint32_t)count;
    return (double)whole < count || whole == 0 ? whole + 1 : whole;
}

/// Elements in the stability limit: in the guard's bound and search, in mspring_network_get_stable_dt(), and in any
/// shape.
///
/// The stiffness of an element is c g g' (element_laws.h), positive semidefinite. The rest of its tangent counts in
/// bounds only.
#include "stability/stability_elements.h"

#include <math.h>

/* ----------------------------------------------------------------------------------------------- in any shape */

void mspringi_stability_elements_sum(const mspring_network *network, float *sums, float *dampings) {
    mspringi_element_walk walk = mspringi_walk_all_elements(network);
    while (mspringi_element_next(&walk))
        mspringi_element_weigh(network, &walk.element, sums, dampings);
}

double mspringi_stability_elements_largest(const mspring_network *network, const float *sums) {
    double largest = 0.0;
    mspringi_element_walk walk = mspringi_walk_all_elements(network);
    while (mspringi_element_next(&walk))
        largest = fmax(largest, mspringi_element_largest(network, &walk.element, sums));
    return largest;
}

/* ----------------------------------------------------------------------------------------------- present shape */

// c h^2, plus damping times 2 h.
static double stiffness_of(const mspringi_element_ref *e, double size, double square) {
    return square * e->law->stiffness(e->of, size) + 2.0 * sqrt(square) * e->damping;
}

/// A corner's slot and its gradient.
typedef struct element_end {
    uint32_t slot;
    mspringi_vector g;
} element_end;

static element_end end_of(const mspring_network *network, const mspringi_element_ref *e,
                          const mspringi_positions *at, uint32_t corner) {
    return (element_end){mspringi_slot_of_corner(network, e, corner), e->law->gradient(e, at, corner)};
}

static double reach_of(element_end end) {
    return sqrt(end.g.x * end.g.x + end.g.y * end.g.y);
}

// Add springs along the sides, isotropic, that bound the rest.
static void bound_rest(const mspring_network *network, const mspringi_stability_limit *b,
                       const mspringi_element_ref *e, const mspringi_positions *at, double force) {
    for (uint32_t i = 0; i < e->count; ++i) {
        const uint32_t one = mspringi_slot_of_corner(network, e, i),
                       other = mspringi_slot_of_corner(network, e, i + 1 < e->count ? i + 1 : 0);
        const double weight = force * e->law->rest(e, at, i);
        const float both = (float)(weight * ((double)b->in[0][one] + (double)b->in[0][other]));
        b->out[0][one] += both;
        b->out[0][other] += both;
    }
}

// Bound the element by springs between all pairs of corners (see mspringi_element_weigh()).
static void bound(const mspring_network *network, const mspringi_stability_limit *b, const mspringi_element_ref *e,
                  const mspringi_positions *at, double stiffness) {
    double all = 0.0, weighted = 0.0;
    for (uint32_t i = 0; i < e->count; ++i) {
        const element_end end = end_of(network, e, at, i);
        all += reach_of(end);
        weighted += reach_of(end) * (double)b->in[0][end.slot];
    }
    for (uint32_t i = 0; i < e->count; ++i) {
        const element_end end = end_of(network, e, at, i);
        const double reach = reach_of(end), here = (double)b->in[0][end.slot];
        b->out[0][end.slot] += (float)(stiffness * reach * (all * here + weighted - 2.0 * reach * here));
    }
}

// Bound one of four corners of which opposite ones have opposite gradients.
static void bound_pairs(const mspring_network *network, const mspringi_stability_limit *b,
                        const mspringi_element_ref *e, const mspringi_positions *at, double stiffness) {
    const element_end ends[4] = {end_of(network, e, at, 0), end_of(network, e, at, 1), end_of(network, e, at, 2),
                                 end_of(network, e, at, 3)};
    const double reach[2] = {reach_of(ends[0]), reach_of(ends[1])};
    for (int i = 0; i < 2; ++i) {
        const uint32_t one = ends[i].slot, other = ends[i + 2].slot;
        const double x = ends[i].g.x, y = ends[i].g.y;
        if (!(reach[i] > 0.0))
            continue;
        const double both =
            stiffness * (reach[0] + reach[1]) / reach[i] * ((double)b->in[0][one] + (double)b->in[0][other]);
        const double sums[] = {0.5 * both * reach[i] * reach[i], 0.5 * both * (x * x - y * y), both * x * y};
        for (size_t sum = 0; sum < 3; ++sum) {
            b->out[sum][one] += (float)sums[sum];
            b->out[sum][other] += (float)sums[sum];
        }
    }
}

void mspringi_stability_elements_bound(const mspring_network *network, const mspringi_stability_limit *limit) {
    const double square = (double)limit->stiffness;
    const mspringi_positions all = {.network = network};
    mspringi_gathered room;
    mspringi_element_walk walk = mspringi_walk_elements(network);
    while (mspringi_element_next(&walk)) {
        const mspringi_element_ref *e = &walk.element;
        const mspringi_positions *at = mspringi_gather(&room, &all, e);
        const double size = e->law->size(e, at);
        (e->is_paired ? bound_pairs : bound)(network, limit, e, at, stiffness_of(e, size, square));
        bound_rest(network, limit, e, at, square * fabs(e->law->force(e->of, size)));
    }
}

// Growth of an element's size with a displacement.
static double growth(const mspring_network *network, const mspringi_element_ref *e, const mspringi_positions *at,
                     const float *x, const float *y) {
    double grows = 0.0;
    for (uint32_t i = 0; i < e->count; ++i) {
        const element_end end = end_of(network, e, at, i);
        grows += end.g.x * (double)x[end.slot] + end.g.y * (double)y[end.slot];
    }
    return grows;
}

void mspringi_stability_elements_image(const mspring_network *network, const mspringi_stability_limit *b,
                                       double square) {
    const mspringi_positions all = {.network = network};
    mspringi_gathered room;
    mspringi_element_walk walk = mspringi_walk_elements(network);
    while (mspringi_element_next(&walk)) {
        const mspringi_element_ref *e = &walk.element;
        const mspringi_positions *at = mspringi_gather(&room, &all, e);
        const double pull =
            stiffness_of(e, e->law->size(e, at), square) * growth(network, e, at, b->in[0], b->in[1]);
        for (uint32_t i = 0; i < e->count; ++i) {
            const element_end end = end_of(network, e, at, i);
            const double force = pull * (double)b->inverse_mass[end.slot];
            b->out[0][end.slot] += (float)(force * end.g.x);
            b->out[1][end.slot] += (float)(force * end.g.y);
        }
    }
}

void mspringi_stability_elements_quotient(const mspring_network *network, mspringi_displacement vector,
                                          mspringi_quotient *sum) {
    const mspringi_positions all = {.network = network};
    mspringi_gathered room;
    mspringi_element_walk walk = mspringi_walk_elements(network);
    while (mspringi_element_next(&walk)) {
        const mspringi_element_ref *e = &walk.element;
        const mspringi_positions *at = mspringi_gather(&room, &all, e);
        const double grows = growth(network, e, at, vector.x, vector.y);
        sum->stiffness += e->law->stiffness(e->of, e->law->size(e, at)) * grows * grows;
        sum->damping += e->damping * grows * grows;
    }
}

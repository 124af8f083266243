/// Areas in the stability limit: in the guard's bound and search, and in mspring_network_stable_dt().
///
/// The tangent stiffness of an area is c g g' (features/areas/areas.h), positive semidefinite. The remainder, of
/// the size of the pressure, counts in bounds only.
#include <math.h>

#include "features/areas/areas.h"
#include "stability/stability_elements.h"

// True if the area has pressure.
static bool has_pressure(const mspring_network *network, size_t i) {
    return !mspringi_area_is_open(network, &network->areas->list[i]);
}

/// An area at a substep.
typedef struct stiff_area {
    const mspringi_area *area;
    double stiffness; ///< c h^2, plus damping times 2 h
    double pressure;  ///< p h^2
} stiff_area;

static stiff_area make_stiff_area(const mspring_network *network, size_t i, double square) {
    const mspringi_area *area = &network->areas->list[i];
    const double size = mspringi_area_size(network, area);
    return (stiff_area){area,
                        square * mspringi_area_stiffness(area, size) + 2.0 * sqrt(square) * (double)area->damping,
                        square * fabs(mspringi_area_pressure(area, size))};
}

/* ------------------------------------------------------------------------------------------- bound and search */

// Add a spring between two slots, isotropic.
static void add_isotropic(const mspringi_stability_limit *b, uint32_t one, uint32_t other, double weight) {
    const float both = (float)(weight * ((double)b->in[0][one] + (double)b->in[0][other]));
    b->out[0][one] += both;
    b->out[0][other] += both;
}

// Stiffness of a spring along the side of a corner that bounds the pressure's part. reach: lengths of gradients.
static double outline_of(const stiff_area *stiff, uint32_t side, const double reach[2]) {
    if (!stiff->area->is_angle)
        return 0.5 * stiff->pressure;
    return side < 2 ? stiff->pressure * reach[side] * reach[side] : 0.0;
}

static double reach_of(const mspring_network *network, const stiff_area *stiff, uint32_t corner) {
    const mspringi_area_end end = mspringi_area_end_of(network, stiff->area, corner);
    return sqrt(end.x * end.x + end.y * end.y);
}

// Bound the area by springs between all pairs of corners (see mspringi_area_weigh()), and along the outline.
static void bound(const mspring_network *network, const mspringi_stability_limit *b, const stiff_area *stiff) {
    const uint32_t count = stiff->area->count;
    const double outer[2] = {reach_of(network, stiff, 0), reach_of(network, stiff, count - 1)};
    double all = 0.0, weighted = 0.0;
    for (uint32_t i = 0; i < count; ++i) {
        const mspringi_area_end end = mspringi_area_end_of(network, stiff->area, i);
        const double reach = sqrt(end.x * end.x + end.y * end.y);
        const uint32_t next = mspringi_area_slot(network, stiff->area, i + 1 < count ? i + 1 : 0);
        all += reach;
        weighted += reach * (double)b->in[0][end.slot];
        add_isotropic(b, end.slot, next, outline_of(stiff, i, outer));
    }
    for (uint32_t i = 0; i < count; ++i) {
        const mspringi_area_end end = mspringi_area_end_of(network, stiff->area, i);
        const double reach = sqrt(end.x * end.x + end.y * end.y), here = (double)b->in[0][end.slot];
        b->out[0][end.slot] += (float)(stiff->stiffness * reach * (all * here + weighted - 2.0 * reach * here));
    }
}

// Bound an area of four corners. Opposite corners have opposite gradients.
static void bound_cell(const mspring_network *network, const mspringi_stability_limit *b, const stiff_area *stiff) {
    const mspringi_area_end ends[4] = {
        mspringi_area_end_of(network, stiff->area, 0), mspringi_area_end_of(network, stiff->area, 1),
        mspringi_area_end_of(network, stiff->area, 2), mspringi_area_end_of(network, stiff->area, 3)};
    const double reach[2] = {sqrt(ends[0].x * ends[0].x + ends[0].y * ends[0].y),
                             sqrt(ends[1].x * ends[1].x + ends[1].y * ends[1].y)};
    for (int i = 0; i < 2; ++i) {
        const uint32_t one = ends[i].slot, other = ends[i + 2].slot;
        const double x = ends[i].x, y = ends[i].y;
        if (!(reach[i] > 0.0))
            continue;
        const double both =
            stiff->stiffness * (reach[0] + reach[1]) / reach[i] * ((double)b->in[0][one] + (double)b->in[0][other]);
        const double sums[] = {0.5 * both * reach[i] * reach[i], 0.5 * both * (x * x - y * y), both * x * y};
        for (size_t sum = 0; sum < 3; ++sum) {
            b->out[sum][one] += (float)sums[sum];
            b->out[sum][other] += (float)sums[sum];
        }
    }
    for (int i = 0; i < 4; ++i)
        add_isotropic(b, ends[i].slot, ends[(i + 1) % 4].slot, 0.5 * stiff->pressure);
}

static void add_bound(const mspring_network *network, const mspringi_stability_limit *b) {
    for (size_t i = 0; i < mspringi_area_count(network); ++i) {
        if (!has_pressure(network, i))
            continue;
        const stiff_area stiff = make_stiff_area(network, i, (double)b->stiffness);
        if (stiff.area->count == 4)
            bound_cell(network, b, &stiff);
        else
            bound(network, b, &stiff);
    }
}

// Growth of an area with a displacement.
static double growth(const mspring_network *network, const mspringi_area *area, const float *x, const float *y) {
    double grows = 0.0;
    for (uint32_t c = 0; c < area->count; ++c) {
        const mspringi_area_end end = mspringi_area_end_of(network, area, c);
        grows += end.x * (double)x[end.slot] + end.y * (double)y[end.slot];
    }
    return grows;
}

static void add_image(const mspring_network *network, const mspringi_stability_limit *b, double square) {
    for (size_t i = 0; i < mspringi_area_count(network); ++i) {
        if (!has_pressure(network, i))
            continue;
        const stiff_area stiff = make_stiff_area(network, i, square);
        const double grows = growth(network, stiff.area, b->in[0], b->in[1]);
        for (uint32_t c = 0; c < stiff.area->count; ++c) {
            const mspringi_area_end end = mspringi_area_end_of(network, stiff.area, c);
            const double force = stiff.stiffness * grows * (double)b->inverse_mass[end.slot];
            b->out[0][end.slot] += (float)(force * end.x);
            b->out[1][end.slot] += (float)(force * end.y);
        }
    }
}

static void add_quotient(const mspring_network *network, mspringi_displacement vector, mspringi_quotient *sum) {
    for (size_t i = 0; i < mspringi_area_count(network); ++i) {
        if (!has_pressure(network, i))
            continue;
        const mspringi_area *area = &network->areas->list[i];
        const double grows = growth(network, area, vector.x, vector.y), size = mspringi_area_size(network, area);
        sum->stiffness += mspringi_area_stiffness(area, size) * grows * grows;
        sum->damping += (double)area->damping * grows * grows;
    }
}

/* ------------------------------------------------------------------------------------------------ in any shape */

static void add_sum(const mspring_network *network, float *sums, float *dampings) {
    for (size_t i = 0; i < mspringi_area_count(network); ++i)
        mspringi_area_weigh(network, &network->areas->list[i], sums, dampings);
}

static double largest_quotient(const mspring_network *network, const float *sums) {
    double largest = 0.0;
    for (size_t i = 0; i < mspringi_area_count(network); ++i)
        largest = fmax(largest, mspringi_area_largest(network, &network->areas->list[i], sums));
    return largest;
}

/* ------------------------------------------------------------------------------------------------ of solvers */

static bool is_used(const mspring_network *network) {
    return mspringi_area_count(network) > 0;
}

// In linear systems, areas without springs all around have the forces of the start of a substep.
static double longest(const mspring_network *network) {
    const mspringi_areas *a = network->areas;
    return a && a->unringed > 0 ? a->longest : INFINITY;
}

const mspringi_stability_ops mspringi_stability_of_areas = {.is_used = is_used,
                                                            .sum = add_sum,
                                                            .largest = largest_quotient,
                                                            .bound = add_bound,
                                                            .image = add_image,
                                                            .quotient = add_quotient,
                                                            .longest = longest};

/// Areas in the linear system of a substep: those that springs are all around.
///
/// With g the gradient of an area, its stiffness is c g g', dense over its corners. With G_k the vector from the
/// middle of the corners to that of side k, turned, its growth by a displacement u is also the sum of G_k . (u_k+1
/// - u_k) over its sides. So c g g' is at most the sum of c G G_k (.)^2 / |G_k| over the sides, with G the sum of
/// all |G_k|; and that is it, where all of the area swells alike. Around a circle, or a rectangle, each G_k is
/// along its side. So the sum is that of springs along the sides, which the matrix has: they get stiffer in it. The
/// force is the area's own, where the particles are predicted.
#include "features/areas/areas.h"

#include <math.h>

#include "base/shoelace.h"
#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"
#include "store/elements.h"
#include "store/sleepers.h"

/// A polygon where its corners are predicted, from its first corner on.
typedef struct polygon {
    const mspringi_area *area;
    const mspringi_corner *corners;
    double x, y;               ///< of the first corner
    double middle_x, middle_y; ///< from there
    double size, all;          ///< m^2, and the sum of |G_k|, m
} polygon;

static uint32_t slot_of(const polygon *p, uint32_t corner) {
    return p->corners[corner < p->area->count ? corner : corner - p->area->count].slot;
}

// |G_k|
static double reach_of(const mspringi_implicit *n, const polygon *p, uint32_t side) {
    const uint32_t a = slot_of(p, side), b = slot_of(p, side + 1);
    const double x = 0.5 * ((n->x[a] - p->x) + (n->x[b] - p->x)) - p->middle_x;
    const double y = 0.5 * ((n->y[a] - p->y) + (n->y[b] - p->y)) - p->middle_y;
    return sqrt(x * x + y * y);
}

static polygon look(const mspring_network *network, const mspringi_implicit *n, const mspringi_area *area) {
    polygon p = {.area = area, .corners = network->areas->corners + area->first};
    mspringi_shoelace shape = {0};
    p.x = n->x[p.corners[0].slot];
    p.y = n->y[p.corners[0].slot];
    for (uint32_t i = 1; i < area->count; ++i) {
        const double x = n->x[p.corners[i].slot] - p.x, y = n->y[p.corners[i].slot] - p.y;
        mspringi_shoelace_add(&shape, x, y);
        p.middle_x += x / (double)area->count;
        p.middle_y += y / (double)area->count;
    }
    p.size = 0.5 * shape.twice;
    for (uint32_t side = 0; side < area->count; ++side)
        p.all += reach_of(n, &p, side);
    return p;
}

static void add_forces(const mspringi_implicit *n, const polygon *p) {
    const uint32_t count = p->area->count;
    const double half = 0.5 * n->system.force_scale * mspringi_area_pressure(p->area, p->size);
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t slot = slot_of(p, i), before = slot_of(p, i + count - 1), behind = slot_of(p, i + 1);
        n->residual.x[slot] += (float)(half * (n->y[behind] - n->y[before]));
        n->residual.y[slot] += (float)(half * (n->x[before] - n->x[behind]));
    }
}

// Make the spring of a side stiffer along its direction.
static void stiffen(const mspring_network *network, const mspringi_implicit *n, const polygon *p, uint32_t side) {
    const uint32_t a = slot_of(p, side), b = slot_of(p, side + 1);
    const double dx = n->x[b] - n->x[a], dy = n->y[b] - n->y[a], length = sqrt(dx * dx + dy * dy);
    if (!(length > 0.0))
        return;
    const double stiffness = mspringi_area_stiffness(p->area, p->size) * p->all * reach_of(n, p, side);
    const float more = (float)(n->system.force_scale * stiffness);
    const float nx = (float)(dx / length), ny = (float)(dy / length);
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, p->corners[side].spring);
    float *pull_x = n->factors + mspringi_factors_of_spring_slot(spring_slot) + MSPRINGI_PULL_X * MSPRINGI_WIDTH;
    float *pull_y = n->factors + mspringi_factors_of_spring_slot(spring_slot) + MSPRINGI_PULL_Y * MSPRINGI_WIDTH;
    const float root = sqrtf(*pull_x * *pull_x + *pull_y * *pull_y + more);
    *pull_x = root * nx;
    *pull_y = root * ny;
    for (int end = 0; end < 2; ++end) {
        const uint32_t slot = end ? b : a;
        n->system.xx[slot] += more * nx * nx;
        n->system.xy[slot] += more * nx * ny;
        n->system.yy[slot] += more * ny * ny;
    }
}

// All corners are of one island.
static bool acts(const mspring_network *network, const mspringi_implicit *n, const mspringi_area *area) {
    return area->is_ringed && !area->is_open &&
           (n->is_direct || !mspringi_slot_is_asleep(network, network->areas->corners[area->first].slot));
}

static void add_terms(const mspring_network *network) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    for (size_t i = 0; i < mspringi_area_count(network); ++i) {
        const mspringi_area *area = &network->areas->list[i];
        if (area->is_angle || !acts(network, n, area))
            continue;
        const polygon p = look(network, n, area);
        add_forces(n, &p);
        for (uint32_t side = 0; side < area->count; ++side)
            stiffen(network, n, &p, side);
    }
}

// Energies in which it is not below 0 unless it is blown up by thousands: the budget knows shares of energies.
static double energy_above_0(const mspring_network *network, const mspringi_area *area) {
    const double pressure = fabs((double)area->pressure), stiffness = (double)area->stiffness;
    const double lowest = stiffness > 0.0 ? 0.5 * pressure * pressure / stiffness : 8.0 * pressure;
    const double fill = area->kind == MSPRING_AREA_GAS ? (double)area->fill : 1.0;
    const mspringi_element_ref e = mspringi_area_element(network, area);
    return mspringi_element_energy(network, &e) + lowest * fill * area->rest_area;
}

static void add_energy(const mspring_network *network) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    for (size_t i = 0; i < mspringi_area_count(network); ++i) {
        const mspringi_area *area = &network->areas->list[i];
        const uint32_t number = n->budget.of_slot[network->areas->corners[area->first].slot];
        if (!acts(network, n, area) || number == MSPRINGI_NO_COMPONENT)
            continue;
        n->budget.components[number].elastic += energy_above_0(network, area);
        n->budget.components[number].length += (double)area->stiffness * area->rest_area;
    }
}

static bool is_used(const mspring_network *network) {
    return mspringi_area_count(network) > 0;
}

const mspringi_element_ops mspringi_element_areas = {
    .is_used = is_used, .add_terms = add_terms, .add_energy = add_energy};

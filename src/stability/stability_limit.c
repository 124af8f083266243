/// Passes over all springs for the stability limit: kernels visit lattices and chains, this file the rest.
#include "stability/stability_limit.h"

#include <math.h>

#include "stability/stability.h"
#include "stability/stability_elements.h"
#include "store/springs.h"

/// A spring outside the kernels. Members as in kernels/limit_kernel.h.
typedef struct single_spring {
    uint32_t base, tip;
    float nx, ny, across, along, stiffness;
} single_spring;

static single_spring linearise(const mspringi_stability_limit *b, const mspringi_spring_values *values) {
    single_spring s = {.base = values->base, .tip = values->tip};
    s.along = s.stiffness = b->stiffness * values->stiffness;
    s.along += b->damping * values->damping;
    const float dx = b->x[s.tip] - b->x[s.base], dy = b->y[s.tip] - b->y[s.base];
    const float square = dx * dx + dy * dy;
    const float inverse = square > MSPRINGI_NO_DIRECTION ? sqrtf(square) * (1.0f / square) : 0.0f;
    s.nx = dx * inverse;
    s.ny = dy * inverse;
    s.across = fmaxf(1.0f - values->rest_length * inverse, MSPRINGI_DEEPEST_SOFTENING);
    return s;
}

// Linearise the surcharge on a one-way spring: MSPRINGI_ONE_WAY_SHARE minus the spring itself.
static single_spring linearise_surcharge(const mspring_network *network, const mspringi_stability_limit *b,
                                         mspring_id spring) {
    mspringi_spring_values values = mspringi_spring_get(network, spring);
    values.stiffness *= (float)MSPRINGI_ONE_WAY_SHARE - 1.0f;
    values.damping = 0.0f;
    return linearise(b, &values);
}

mspringi_stability_limit mspringi_stability_limit_at(const mspring_network *network, double h) {
    return (mspringi_stability_limit){.topology = &network->topology,
                                      .x = network->state.x,
                                      .y = network->state.y,
                                      .lattice_springs = network->lattice_springs,
                                      .rest_lengths = network->rest_lengths.lengths,
                                      .chain_springs = network->chain_springs,
                                      .springs_of_block = network->shared_records.of_block,
                                      .rests_of_block = network->rest_lengths.of_block,
                                      .is_damped = network->parts > MSPRINGI_DAMPING,
                                      .stiffness = (float)(h * h),
                                      .damping = (float)(2.0 * h)};
}

static void add_bound(const mspringi_stability_limit *b, single_spring s) {
    if (!(s.along > 0.0f) || !(s.nx * s.nx + s.ny * s.ny > 0.0f))
        return;
    const float both = b->in[0][s.base] + b->in[0][s.tip];
    const float across = s.across > 0.0f ? s.stiffness * s.across : 0.0f, turned = both * (s.along - across);
    const float sums[] = {0.5f * (both * (s.along + across)), 0.5f * turned * (s.nx * s.nx - s.ny * s.ny),
                          turned * s.nx * s.ny};
    for (size_t sum = 0; sum < 3; ++sum) {
        b->out[sum][s.base] += sums[sum];
        b->out[sum][s.tip] += sums[sum];
    }
}

static void add_image(const mspringi_stability_limit *b, single_spring s) {
    if (!(s.along > 0.0f))
        return;
    const float dx = b->in[0][s.tip] - b->in[0][s.base], dy = b->in[1][s.tip] - b->in[1][s.base];
    const float pull = s.along * (s.nx * dx + s.ny * dy);
    const float shear = s.stiffness * s.across * (s.ny * dx - s.nx * dy);
    const float x = pull * s.nx + shear * s.ny, y = pull * s.ny - shear * s.nx;
    b->out[0][s.base] -= b->inverse_mass[s.base] * x;
    b->out[1][s.base] -= b->inverse_mass[s.base] * y;
    b->out[0][s.tip] += b->inverse_mass[s.tip] * x;
    b->out[1][s.tip] += b->inverse_mass[s.tip] * y;
}

static void visit_others(const mspring_network *network, const mspringi_stability_limit *b,
                         void (*visit)(const mspringi_stability_limit *b, single_spring s)) {
    for (uint32_t i = 0; i < network->topology.irregular_count; ++i) {
        const mspringi_spring_values values = mspringi_irregular_spring(network, i);
        visit(b, linearise(b, &values));
    }
    for (mspring_id i = 0; network->side && i < network->topology.reserve.first_spring; ++i)
        if (mspringi_side_of(network, i) != 0 && mspringi_spring_exists(network, i))
            visit(b, linearise_surcharge(network, b, i));
}

void mspringi_stability_limit_bound(const mspring_network *network, const mspringi_stability_limit *b) {
    network->kernels->bound_rows(b);
    visit_others(network, b, add_bound);
    mspringi_stability_elements_bound(network, b);
}

void mspringi_stability_limit_image(const mspring_network *network, const mspringi_stability_limit *b) {
    network->kernels->image_rows(b);
    visit_others(network, b, add_image);
    mspringi_stability_elements_image(network, b, (double)b->stiffness);
}

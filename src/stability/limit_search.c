/// The guard's search for an unstable motion: a Lanczos iteration over the passes of the guard.
///
/// The result never exceeds the largest eigenvalue, so a network below the limit is never rejected.
///
/// Vectors are displacements, so the motion of a step is a start as it is: each velocity minus its mean over the
/// substeps before. Smooth motion nearly cancels in it; motion that reverses in each substep stays. So a few
/// iterations suffice.
#include <string.h>

#include "stability/lanczos.h"
#include "stability/stability_limit.h"

/// Arguments of the passes.
typedef struct search {
    const mspring_network *network;
    mspringi_stability_limit limit;
} search;

// Velocity of a slot minus the mean of its earlier velocities in the last step, from the distance it moved.
static float reversing_velocity(uint32_t substeps, float h, float v, float v_before, float x, float x_before) {
    if (substeps == 1)
        return v - v_before;
    return v - (x - x_before - h * v) / (h * (float)(substeps - 1));
}

static void start_from_motion(const mspring_network *network, const float *inverse_mass, uint32_t substeps, float h,
                              mspringi_displacement to) {
    const mspringi_state *s = &network->state, *b = &network->backup;
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot) {
        const bool moves = inverse_mass[slot] > 0.0f;
        const float x = reversing_velocity(substeps, h, s->vx[slot], b->vx[slot], s->x[slot], b->x[slot]);
        const float y = reversing_velocity(substeps, h, s->vy[slot], b->vy[slot], s->y[slot], b->y[slot]);
        to.x[slot] = moves ? x : 0.0f;
        to.y[slot] = moves ? y : 0.0f;
    }
}

static void add_image(void *context, mspringi_displacement in, mspringi_displacement out) {
    search *f = context;
    f->limit.in[0] = in.x;
    f->limit.in[1] = in.y;
    f->limit.out[0] = out.x;
    f->limit.out[1] = out.y;
    mspringi_stability_limit_image(f->network, &f->limit);
}

double mspringi_stability_limit_search(mspring_network *network, double h, uint32_t moved, double bound,
                                       int iterations) {
    // Sleeping particles have no motion, but count in a search from noise: they may wake in any step.
    const float *inverse_mass = moved > 0 ? mspringi_active_inverse_mass(network) : network->inverse_mass;
    search f = {network, mspringi_stability_limit_at(network, h)};
    f.limit.inverse_mass = inverse_mass;
    const mspringi_lanczos lanczos = {
        .slots = mspringi_slot_count(network),
        .inverse_mass = inverse_mass,
        .add_image = add_image,
        .context = &f,
        .here = {mspringi_stability_limit_scratch(network, 0), mspringi_stability_limit_scratch(network, 1)},
        .next = {mspringi_stability_limit_scratch(network, 2), mspringi_stability_limit_scratch(network, 3)},
        .bound = bound,
        .most = iterations,
        .period = 1};
    if (moved > 0) {
        start_from_motion(network, inverse_mass, moved, (float)h, lanczos.here);
    } else {
        memset(lanczos.here.x, 0, 2 * lanczos.slots * sizeof *lanczos.here.x);
        mspringi_lanczos_add_noise(&lanczos, 1.0f);
    }
    return mspringi_lanczos_largest(&lanczos).value;
}

/// The guard's search for an unstable motion: a Lanczos iteration (see lanczos.c) in single precision, over plain
/// arrays. Two vectors suffice, since the eigenvector is not needed.
///
/// Vectors are displacements q with the inner product of the masses, q . M r, in which M^-1 S is symmetric. So the
/// motion of a step is a start as it is. The result never exceeds the largest eigenvalue, so a network below the
/// limit is never rejected.
///
/// The start from a step is each velocity minus its mean over the substeps before. Smooth motion nearly cancels in
/// it; motion that reverses in each substep stays. So a few iterations suffice.
#include <float.h>
#include <math.h>
#include <string.h>

#include "stability/stability_limit.h"
#include "stability/tridiagonal.h"

/// Residual of a converged eigenvalue, relative to the eigenvalue.
#define TOLERANCE 2e-3

/// Fewest iterations before a search may end with an eigenvalue below the bound.
#define MIN_ITERATIONS 12

/// Displacement, x and y by slot.
typedef struct displacement {
    float *x, *y;
} displacement;

/// Arguments of a search.
typedef struct search {
    const mspring_network *network;
    const float *inverse_mass;
    mspringi_stability_limit limit;
} search;

/* ------------------------------------------------------------------------------------------------------- start */

// Velocity of a slot minus the mean of its earlier velocities in the last step, from the distance it moved.
static float reversing_velocity(uint32_t substeps, float h, float v, float v_before, float x, float x_before) {
    if (substeps == 1)
        return v - v_before;
    return v - (x - x_before - h * v) / (h * (float)(substeps - 1));
}

static void start_from_motion(const search *f, uint32_t substeps, float h, displacement to) {
    const mspring_network *network = f->network;
    const mspringi_state *s = &network->state, *b = &network->backup;
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot) {
        const bool moves = f->inverse_mass[slot] > 0.0f;
        const float x = reversing_velocity(substeps, h, s->vx[slot], b->vx[slot], s->x[slot], b->x[slot]);
        const float y = reversing_velocity(substeps, h, s->vy[slot], b->vy[slot], s->y[slot], b->y[slot]);
        to.x[slot] = moves ? x : 0.0f;
        to.y[slot] = moves ? y : 0.0f;
    }
}

// Pseudo-random number from -1 to 1 for each n. Faster than mspringi_noise(), which would dominate a search of a
// few iterations (the last steps of MurmurHash3, Appleby 2011).
static inline float noise(uint32_t n) {
    n = (n + 1) * 0x9e3779b9u;
    n = (n ^ n >> 16) * 0x85ebca6bu;
    n = (n ^ n >> 13) * 0xc2b2ae35u;
    return (float)(int32_t)(n ^ n >> 16) * 0x1p-31f;
}

static void start_from_noise(const search *f, displacement to) {
    const uint32_t slots = (uint32_t)mspringi_slot_count(f->network);
    for (uint32_t slot = 0; slot < slots; ++slot) {
        const float root = sqrtf(f->inverse_mass[slot]);
        to.x[slot] = root * noise(slot);
        to.y[slot] = root * noise(slot + slots);
    }
}

/* -------------------------------------------------------------------------------------------------- iteration */

// a . M b, summed in an order that does not depend on the machine.
static double dot(const search *f, displacement a, displacement b) {
    double sums[MSPRINGI_WIDTH] = {0.0}, sum = 0.0;
    for (size_t slot = 0; slot < mspringi_slot_count(f->network); slot += MSPRINGI_WIDTH) {
        const float *restrict inverse_mass = f->inverse_mass + slot;
        const float *ax = a.x + slot, *ay = a.y + slot, *bx = b.x + slot, *by = b.y + slot;
        for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
            // Pinned slots have a displacement of 0.
            const float mass = 1.0f / (inverse_mass[i] > FLT_MIN ? inverse_mass[i] : FLT_MIN);
            sums[i] += (double)(mass * (ax[i] * bx[i] + ay[i] * by[i]));
        }
    }
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
        sum += sums[i];
    return sum;
}

// a -= factor b
static void subtract(const search *f, displacement a, float factor, displacement b) {
    float *restrict ax = a.x, *restrict ay = a.y;
    const float *restrict bx = b.x, *restrict by = b.y;
    for (size_t slot = 0; slot < mspringi_slot_count(f->network); ++slot) {
        ax[slot] -= factor * bx[slot];
        ay[slot] -= factor * by[slot];
    }
}

static void scale(const search *f, displacement a, float factor) {
    for (size_t slot = 0; slot < mspringi_slot_count(f->network); ++slot) {
        a.x[slot] *= factor;
        a.y[slot] *= factor;
    }
}

// out += M^-1 S in
static void add_image(search *f, displacement in, displacement out) {
    f->limit.in[0] = in.x;
    f->limit.in[1] = in.y;
    f->limit.out[0] = out.x;
    f->limit.out[1] = out.y;
    mspringi_stability_limit_image(f->network, &f->limit);
}

// Iterate from `here`; `next` must be 0.
static double iterate(search *f, displacement here, displacement next, double bound, int iterations) {
    mspringi_tridiagonal t = {.size = 0};
    double weights[MSPRINGI_LANCZOS_MAX], value = 0.0, off_diagonal = sqrt(dot(f, here, here));
    if (!(off_diagonal > 0.0 && off_diagonal < INFINITY))
        return 0.0;
    scale(f, here, (float)(1.0 / off_diagonal));
    for (;;) {
        const int j = t.size++;
        add_image(f, here, next);
        t.diagonal[j] = dot(f, here, next);
        subtract(f, next, (float)t.diagonal[j], here);
        off_diagonal = t.off_diagonal[j] = sqrt(dot(f, next, next));
        value = mspringi_tridiagonal_top(&t, weights);
        const double residual = off_diagonal * fabs(weights[j]);
        const bool stays_below = t.size >= MIN_ITERATIONS && value + residual < bound;
        if (value > bound || stays_below || residual <= TOLERANCE * value || t.size == iterations ||
            !(off_diagonal > 1e-6 * value))
            return value;
        // The vector before is needed only for its part in the next one.
        scale(f, next, (float)(1.0 / off_diagonal));
        scale(f, here, (float)-off_diagonal);
        const displacement swapped = here;
        here = next;
        next = swapped;
    }
}

double mspringi_stability_limit_search(mspring_network *network, double h, uint32_t moved, double bound,
                                       int iterations) {
    const displacement here = {mspringi_stability_limit_scratch(network, 0),
                               mspringi_stability_limit_scratch(network, 1)};
    const displacement next = {mspringi_stability_limit_scratch(network, 2),
                               mspringi_stability_limit_scratch(network, 3)};
    // Sleeping particles have no motion, but count in a search from noise: they may wake in any step.
    const float *inverse_mass = moved > 0 ? mspringi_active_inverse_mass(network) : network->inverse_mass;
    search f = {network, inverse_mass, mspringi_stability_limit_at(network, h)};
    f.limit.inverse_mass = f.inverse_mass;
    if (moved > 0)
        start_from_motion(&f, moved, (float)h, here);
    else
        start_from_noise(&f, here);
    memset(next.x, 0, 2 * mspringi_slot_count(network) * sizeof *next.x);
    return iterate(&f, here, next, bound, iterations);
}

/// Conjugate gradients with a two-level preconditioner:
///
///     z = D^-1 r + Z Ac^-1 Z^T r
///
/// D being the 2 x 2 blocks on A's diagonal, Ac = Z^T A Z, and the rows of Z for a particle of tile t, at (X, Y)
/// from its mass centre, [1 0 -Y; 0 1 X] in t's three columns. (Nicolaides 1987 has the additive coarse correction
/// by domains; rigid bodies as the coarse space of elasticity are Mandel's, 1993.)
///
/// The number of iterations is fixed, and every sum has a fixed order, whatever the instruction set.
#include "implicit.h"

#include <math.h>
#include <string.h>

/* ----------------------------------------------------------------------------------------------------- diagonal */

// Invert the 2 x 2 blocks on the diagonal, in place. Single precision has rounded them: a millionth of their size
// on top keeps those positive definite that are so by their mass alone, such as a taut rope's.
static void invert_diagonal(const mspringi_system *s, size_t slots) {
    float *restrict const block_xx = s->xx, *restrict const block_xy = s->xy, *restrict const block_yy = s->yy;
    for (size_t i = 0; i < slots; ++i) {
        const double mass = (double)s->mass[i], trace = (double)block_xx[i] + (double)block_yy[i];
        const double on_top = mass + 1e-6 * trace;
        const double xx = (double)block_xx[i] + on_top, yy = (double)block_yy[i] + on_top;
        const double xy = (double)block_xy[i];
        const double reciprocal = 1.0 / (xx * yy - xy * xy), factor = mass > 0.0 ? reciprocal : 0.0;
        block_xx[i] = (float)(mass > 0.0 ? yy * factor : 0.0);
        block_xy[i] = (float)(mass > 0.0 ? -xy * factor : 0.0);
        block_yy[i] = (float)(mass > 0.0 ? xx * factor : 0.0);
    }
}

/* ------------------------------------------------------------------------------------------------- coarse space */

static void prepare_coarse(mspringi_implicit *n) {
    if (n->age == 0) {
        mspringi_coarse_assemble(&n->coarse, &n->tiles, n->factors, n->mass, n->arm);
        mspringi_coarse_factor(&n->coarse);
    }
    n->age = n->age + 1 < n->coarse_period ? n->age + 1 : 0;
}

/* --------------------------------------------------------------------------------------------------- iteration */

// Apply Ac^-1 to Z^T r, into the coarse unknowns. Returns r . Z Ac^-1 Z^T r.
static double correct(const mspring_network *network) {
    mspringi_implicit *n = network->implicit;
    const mspringi_tiles *tiles = &n->tiles;
    const size_t count = (size_t)MSPRINGI_RIGID * tiles->count;
    double sum = 0.0;
    for (uint32_t t = 0; t < tiles->count; ++t)
        network->kernels->system.restrict_to_tile(&n->iterate, tiles->parts + tiles->first_part[t],
                                                  tiles->first_part[t + 1] - tiles->first_part[t],
                                                  n->restricted + (size_t)MSPRINGI_RIGID * t);
    memcpy(n->coarse.unknowns, n->restricted, count * sizeof *n->restricted);
    mspringi_coarse_solve(&n->coarse);
    for (size_t i = 0; i < count; ++i)
        sum += n->restricted[i] * n->coarse.unknowns[i];
    return sum;
}

// direction = z + beta direction.
static void turn(const mspring_network *network, float beta) {
    const mspringi_implicit *n = network->implicit;
    const mspringi_tiles *tiles = &n->tiles;
    for (uint32_t t = 0; t < tiles->count; ++t)
        network->kernels->system.turn_tile(&n->iterate, tiles->parts + tiles->first_part[t],
                                           tiles->first_part[t + 1] - tiles->first_part[t],
                                           n->coarse.unknowns + (size_t)MSPRINGI_RIGID * t, beta);
}

static double dot(const mspring_network *network, mspringi_field a, mspringi_field b) {
    return (double)network->kernels->system.dot(mspringi_slot_count(network), a.x, a.y, b.x, b.y);
}

// What is done with them leaves the iteration, whose sums go over all slots.
void mspringi_solve_loose(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const mspringi_implicit *n = network->implicit;
    const size_t first = (size_t)t->loose_first * MSPRINGI_WIDTH;
    for (size_t i = first; i < first + (size_t)t->loose_blocks * MSPRINGI_WIDTH; ++i) {
        n->displacement.x[i] = n->mass[i] > 0.0f ? n->residual.x[i] / n->mass[i] : 0.0f;
        n->displacement.y[i] = n->mass[i] > 0.0f ? n->residual.y[i] / n->mass[i] : 0.0f;
        n->residual.x[i] = n->residual.y[i] = 0.0f;
    }
}

void mspringi_spoil(mspring_network *network) {
    network->implicit->x[network->topology.slot_of_particle[0]] = NAN;
}

// The first iteration: the tiles alone, as rigid bodies. It takes the fast changes of a heavy or a spinning part
// off those that follow, which then leave less force unbalanced (80x5 with a tip of 1000 times the mass: no gain of
// energy, where without it there is one of 0.1 %).
static void solve_tiles(const mspring_network *network) {
    const mspringi_implicit *n = network->implicit;
    const size_t slots = mspringi_slot_count(network);
    memset(n->scaled.x, 0, 2 * slots * sizeof *n->scaled.x);
    const double product = correct(network);
    turn(network, 0.0f);
    mspringi_multiply(network, n->direction, n->product);
    const double curvature = dot(network, n->direction, n->product);
    const bool is_sound = curvature > 0.0 && curvature < INFINITY && product < INFINITY;
    const float alpha = is_sound ? (float)(product / curvature) : 0.0f;
    (void)network->kernels->system.advance(&n->system, &n->iterate, alpha);
}

void mspringi_solve(mspring_network *network) {
    mspringi_implicit *n = network->implicit;
    const mspringi_system_kernels *kernels = &network->kernels->system;
    const size_t slots = mspringi_slot_count(network);
    memset(n->displacement.x, 0, 2 * slots * sizeof *n->displacement.x);
    memset(n->direction.x, 0, 2 * slots * sizeof *n->direction.x);
    memset(n->product.x, 0, 2 * slots * sizeof *n->product.x);
    invert_diagonal(&n->system, slots);
    mspringi_solve_loose(network);
    prepare_coarse(n);
    uint32_t left = n->iterations;
    if (left > 1) {
        solve_tiles(network);
        --left;
    }
    double product = (double)kernels->advance(&n->system, &n->iterate, 0.0f) + correct(network);
    turn(network, 0.0f);
    while (left-- > 0) {
        mspringi_multiply(network, n->direction, n->product);
        const double curvature = dot(network, n->direction, n->product);
        if (!(curvature < INFINITY && product < INFINITY)) {
            mspringi_spoil(network);
            return;
        }
        // Nothing is left to do, or to be done in this precision.
        if (curvature <= 0.0 || product <= 0.0)
            break;
        double next = (double)kernels->advance(&n->system, &n->iterate, (float)(product / curvature));
        if (left == 0)
            break;
        next += correct(network);
        turn(network, (float)(next / product));
        product = next;
    }
}

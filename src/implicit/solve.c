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

// 1 for the lanes of a part of a tile, 0 for the others.
static const float lane_weights[16][MSPRINGI_QUARTER] = {
    {0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {1, 1, 0, 0}, {0, 0, 1, 0}, {1, 0, 1, 0}, {0, 1, 1, 0}, {1, 1, 1, 0},
    {0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}, {1, 1, 0, 1}, {0, 0, 1, 1}, {1, 0, 1, 1}, {0, 1, 1, 1}, {1, 1, 1, 1}};

static float sum_lanes(const float *lanes) {
    return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

/* ------------------------------------------------------------------------------------------------- coarse space */

// Find where each particle is from the mass centre of its tile.
static void find_arms(mspringi_implicit *n) {
    const mspringi_tiles *tiles = &n->tiles;
    for (uint32_t t = 0; t < tiles->count; ++t) {
        const mspringi_part_of_tile *const end = tiles->parts + tiles->first_part[t + 1];
        double sum = 0.0, sum_x = 0.0, sum_y = 0.0;
        for (const mspringi_part_of_tile *part = tiles->parts + tiles->first_part[t]; part < end; ++part) {
            const float *weights = lane_weights[part->lanes];
            for (uint32_t i = 0; i < MSPRINGI_QUARTER; ++i) {
                const double mass = (double)(weights[i] * n->mass[part->first_slot + i]);
                sum += mass;
                sum_x += mass * n->x[part->first_slot + i];
                sum_y += mass * n->y[part->first_slot + i];
            }
        }
        const double x = sum_x / sum, y = sum_y / sum;
        for (const mspringi_part_of_tile *part = tiles->parts + tiles->first_part[t]; part < end; ++part) {
            for (uint32_t i = 0; i < MSPRINGI_QUARTER; ++i) {
                if (!(part->lanes >> i & 1))
                    continue;
                n->arm.x[part->first_slot + i] = (float)(n->x[part->first_slot + i] - x);
                n->arm.y[part->first_slot + i] = (float)(n->y[part->first_slot + i] - y);
            }
        }
    }
}

static void prepare_coarse(mspringi_implicit *n) {
    find_arms(n);
    if (n->age == 0) {
        mspringi_coarse_assemble(&n->coarse, &n->tiles, n->factors, n->mass, n->arm);
        mspringi_coarse_factor(&n->coarse);
    }
    n->age = n->age + 1 < n->coarse_period ? n->age + 1 : 0;
}

/* --------------------------------------------------------------------------------------------------- iteration */

// Go on by alpha along the direction; put Z^T r into the coarse unknowns; return r . D^-1 r.
static double advance(mspringi_implicit *n, float alpha) {
    const mspringi_tiles *tiles = &n->tiles;
    float *restrict const rx = n->residual.x, *restrict const ry = n->residual.y;
    float *restrict const dx = n->displacement.x, *restrict const dy = n->displacement.y;
    const float *const px = n->direction.x, *const py = n->direction.y;
    const float *const qx = n->product.x, *const qy = n->product.y;
    const float *const xx = n->system.xx, *const xy = n->system.xy, *const yy = n->system.yy;
    const float *const arm_x = n->arm.x, *const arm_y = n->arm.y;
    double total = 0.0;
    for (uint32_t t = 0; t < tiles->count; ++t) {
        float sum_x[MSPRINGI_QUARTER] = {0.0f}, sum_y[MSPRINGI_QUARTER] = {0.0f};
        float sum_turn[MSPRINGI_QUARTER] = {0.0f}, sum_product[MSPRINGI_QUARTER] = {0.0f};
        for (uint32_t p = tiles->first_part[t]; p < tiles->first_part[t + 1]; ++p) {
            const size_t slot = tiles->parts[p].first_slot;
            const float *weights = lane_weights[tiles->parts[p].lanes];
            for (size_t i = 0; i < MSPRINGI_QUARTER; ++i) {
                const size_t at = slot + i;
                const float weight = weights[i], step = alpha * weight;
                dx[at] = dx[at] + step * px[at];
                dy[at] = dy[at] + step * py[at];
                rx[at] = rx[at] - step * qx[at];
                ry[at] = ry[at] - step * qy[at];
                const float x = weight * rx[at], y = weight * ry[at];
                sum_x[i] = sum_x[i] + x;
                sum_y[i] = sum_y[i] + y;
                sum_turn[i] = sum_turn[i] + (arm_x[at] * y - arm_y[at] * x);
                sum_product[i] = sum_product[i] + (x * (xx[at] * x + xy[at] * y) + y * (xy[at] * x + yy[at] * y));
            }
        }
        double *unknowns = n->coarse.unknowns + (size_t)MSPRINGI_RIGID * t;
        unknowns[0] = (double)sum_lanes(sum_x);
        unknowns[1] = (double)sum_lanes(sum_y);
        unknowns[2] = (double)sum_lanes(sum_turn);
        total += (double)sum_lanes(sum_product);
    }
    return total;
}

// direction = z + beta direction, with the coarse solution in the unknowns.
static void turn(mspringi_implicit *n, float beta) {
    const mspringi_tiles *tiles = &n->tiles;
    float *restrict const px = n->direction.x, *restrict const py = n->direction.y;
    const float *const rx = n->residual.x, *const ry = n->residual.y;
    const float *const xx = n->system.xx, *const xy = n->system.xy, *const yy = n->system.yy;
    const float *const arm_x = n->arm.x, *const arm_y = n->arm.y;
    for (uint32_t t = 0; t < tiles->count; ++t) {
        const double *unknowns = n->coarse.unknowns + (size_t)MSPRINGI_RIGID * t;
        const float shift_x = (float)unknowns[0], shift_y = (float)unknowns[1], angle = (float)unknowns[2];
        for (uint32_t p = tiles->first_part[t]; p < tiles->first_part[t + 1]; ++p) {
            const size_t slot = tiles->parts[p].first_slot;
            const uint32_t lanes = tiles->parts[p].lanes;
            float x[MSPRINGI_QUARTER], y[MSPRINGI_QUARTER];
            for (size_t i = 0; i < MSPRINGI_QUARTER; ++i) {
                const size_t at = slot + i;
                x[i] = ((xx[at] * rx[at] + xy[at] * ry[at]) + (shift_x - arm_y[at] * angle)) + beta * px[at];
                y[i] = ((xy[at] * rx[at] + yy[at] * ry[at]) + (shift_y + arm_x[at] * angle)) + beta * py[at];
            }
            if (lanes == 15) {
                memcpy(px + slot, x, sizeof x);
                memcpy(py + slot, y, sizeof y);
                continue;
            }
            for (size_t i = 0; i < MSPRINGI_QUARTER; ++i) {
                px[slot + i] = lanes >> i & 1 ? x[i] : px[slot + i];
                py[slot + i] = lanes >> i & 1 ? y[i] : py[slot + i];
            }
        }
    }
}

// Apply Ac^-1 and return r . Z Ac^-1 Z^T r.
static double correct(mspringi_implicit *n, double *restricted) {
    const size_t count = (size_t)MSPRINGI_RIGID * n->coarse.count;
    double sum = 0.0;
    memcpy(restricted, n->coarse.unknowns, count * sizeof *restricted);
    mspringi_coarse_solve(&n->coarse);
    for (size_t i = 0; i < count; ++i)
        sum += restricted[i] * n->coarse.unknowns[i];
    return sum;
}

// The product of two fields: 16 sums by lane, then those pairwise.
static double dot(mspringi_field a, mspringi_field b, size_t slots) {
    float sums[MSPRINGI_WIDTH] = {0.0f};
    for (size_t slot = 0; slot < slots; slot += MSPRINGI_WIDTH)
        for (size_t i = 0; i < MSPRINGI_WIDTH; ++i)
            sums[i] = sums[i] + (a.x[slot + i] * b.x[slot + i] + a.y[slot + i] * b.y[slot + i]);
    for (size_t half = MSPRINGI_WIDTH / 2; half > 0; half /= 2)
        for (size_t i = 0; i < half; ++i)
            sums[i] = sums[i] + sums[i + half];
    return (double)sums[0];
}

// Particles without springs are in no tile: their rows of A are diagonal.
static void solve_loose(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const mspringi_implicit *n = network->implicit;
    const size_t first = (size_t)t->loose_first * MSPRINGI_WIDTH;
    for (size_t i = first; i < first + (size_t)t->loose_blocks * MSPRINGI_WIDTH; ++i) {
        n->displacement.x[i] = n->mass[i] > 0.0f ? n->residual.x[i] / n->mass[i] : 0.0f;
        n->displacement.y[i] = n->mass[i] > 0.0f ? n->residual.y[i] / n->mass[i] : 0.0f;
    }
}

// Numbers overflowed: see to it that the step is refused.
static void spoil(mspring_network *network) {
    network->implicit->x[network->topology.slot_of_particle[0]] = NAN;
}

void mspringi_solve(mspring_network *network) {
    mspringi_implicit *n = network->implicit;
    const size_t slots = mspringi_slot_count(network);
    memset(n->displacement.x, 0, 2 * slots * sizeof *n->displacement.x);
    memset(n->direction.x, 0, 2 * slots * sizeof *n->direction.x);
    memset(n->product.x, 0, 2 * slots * sizeof *n->product.x);
    prepare_coarse(n);
    double product = advance(n, 0.0f);
    product += correct(n, n->restricted);
    turn(n, 0.0f);
    for (uint32_t i = 0; i < n->iterations; ++i) {
        mspringi_multiply(network, n->direction, n->product);
        const double curvature = dot(n->direction, n->product, slots);
        if (!(curvature < INFINITY && product < INFINITY)) {
            spoil(network);
            return;
        }
        // Nothing is left to do, or to be done in this precision.
        if (curvature <= 0.0 || product <= 0.0)
            break;
        double next = advance(n, (float)(product / curvature));
        if (i + 1 == n->iterations)
            break;
        next += correct(n, n->restricted);
        turn(n, (float)(next / product));
        product = next;
    }
    solve_loose(network);
}

/// Upper bound on the largest eigenvalue of S = A + 2 D (see pencil.h), from one sweep over the springs.
///
/// Let y be the displacement divided by p, the root of the inverse mass. A spring of direction n and tangent t
/// between the particles a and b adds
///     w (n . (p_b y_b - p_a y_a))^2 + c (t . (p_b y_b - p_a y_a))^2
/// to y . S y. With a weight z > 0 for each particle, 2 |u v| <= (z_b / z_a) u^2 + (z_a / z_b) v^2 gives
///     (p_b v - p_a u)^2 <= (p_a / z_a) (p_a z_a + p_b z_b) u^2 + (p_b / z_b) (p_a z_a + p_b z_b) v^2
/// So S is at most block diagonal. A particle's block is p / z times the sum of (p_a z_a + p_b z_b) (w n n' + c t
/// t') over its springs, and no eigenvalue of S exceeds the largest of the blocks'. The bound is sharp for a
/// lattice of equal particles and springs at rest, where both are 8 w / m. A compressed spring has c < 0, which
/// counts as 0.
///
/// The bound holds for any weights; the best ones make the eigenvalues of all blocks equal. Each evaluation
/// multiplies a particle's weight by the root of its block's eigenvalue. Weights change how sharp the bound is,
/// never its validity.
#include <math.h>
#include <string.h>

#include "stability/stability.h"
#include "stability/stability_limit.h"

/// Evaluations for a new network; each check adds one. For 200 x 200 with holes, three masses and four stiffnesses,
/// 6 prove 0.94 of the limit, 12 0.95 and 50 0.965.
#define FIRST_EVALUATIONS 12

/// Smallest weight; the largest is about 1.
#define MIN_WEIGHT 1e-3f

mspring_result mspringi_stability_limit_reserve(mspring_network *network) {
    if (network->guard_scratch)
        return MSPRING_OK;
    const size_t slots = mspringi_slot_count(network);
    network->guard_scratch = mspringi_alloc(&network->memory, (1 + MSPRINGI_STABILITY_LIMIT_SCRATCH) * slots,
                                            sizeof *network->guard_scratch);
    if (!network->guard_scratch)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory to check the stability of %zu slots", slots);
    for (size_t slot = 0; slot < slots; ++slot)
        network->guard_scratch[slot] = 1.0f;
    return MSPRING_OK;
}

/// Largest values over all slots, for each lane until the end of the sweep.
typedef struct extremes {
    float value[MSPRINGI_WIDTH], weight[MSPRINGI_WIDTH];
    float overflow[MSPRINGI_WIDTH]; ///< NaN unless all values are finite
} extremes;

static float largest_lane(const float *lanes) {
    float largest = lanes[0];
    for (size_t i = 1; i < MSPRINGI_WIDTH; ++i)
        largest = lanes[i] > largest ? lanes[i] : largest;
    return largest;
}

// Largest eigenvalue of each block: half the trace plus the eigenvalues' distance from it.
static void find_eigenvalues(const float *restrict inverse_mass, const float *restrict weights,
                             const mspringi_stability_limit *b, size_t slot, float *restrict values,
                             extremes *restrict found) {
    const float *restrict half = b->out[0] + slot, *restrict off = b->out[1] + slot;
    const float *restrict off_axis = b->out[2] + slot;
    for (size_t i = 0; i < MSPRINGI_WIDTH; ++i) {
        const float share = sqrtf(inverse_mass[i]) / weights[i], x = share * off[i], y = share * off_axis[i];
        values[i] = share * half[i] + sqrtf(x * x + y * y);
        found->value[i] = values[i] > found->value[i] ? values[i] : found->value[i];
        found->weight[i] = weights[i] > found->weight[i] ? weights[i] : found->weight[i];
        found->overflow[i] += values[i] - values[i];
    }
}

// Update the weights so that the blocks become equal. The largest stays at about 1.
static void update_weights(mspring_network *network, const float *restrict values, const extremes *found) {
    const float per_value = 1.0f / largest_lane(found->value), per_weight = 1.0f / largest_lane(found->weight);
    float *restrict weights = network->guard_scratch;
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot) {
        const float weight = weights[slot] * per_weight * sqrtf(values[slot] * per_value);
        weights[slot] = weight > MIN_WEIGHT ? weight : MIN_WEIGHT;
    }
}

// Bound the eigenvalues in one sweep, then update the weights. NaN if a value overflows.
static float evaluate_bound(mspring_network *network, const float *inverse_mass, double h) {
    const size_t slots = mspringi_slot_count(network);
    float *const weights = network->guard_scratch, *const room = mspringi_stability_limit_scratch(network, 0);
    mspringi_stability_limit b = mspringi_stability_limit_at(network, h);
    for (size_t slot = 0; slot < slots; ++slot)
        room[slot] = sqrtf(inverse_mass[slot]) * weights[slot];
    b.in[0] = room;
    for (size_t sum = 0; sum < 3; ++sum)
        b.out[sum] = mspringi_stability_limit_scratch(network, 1 + sum);
    memset(b.out[0], 0, 3 * slots * sizeof *b.out[0]);
    mspringi_stability_limit_bound(network, &b);
    extremes found = {{0.0f}, {0.0f}, {0.0f}};
    for (size_t slot = 0; slot < slots; slot += MSPRINGI_WIDTH)
        find_eigenvalues(inverse_mass + slot, weights + slot, &b, slot, room + slot, &found);
    const float largest = largest_lane(found.value);
    for (size_t i = 1; i < MSPRINGI_WIDTH; ++i)
        found.overflow[0] += found.overflow[i];
    if (largest > 0.0f && found.overflow[0] == 0.0f)
        update_weights(network, room, &found);
    return largest + found.overflow[0];
}

bool mspringi_stability_limit_is_below(mspring_network *network, double h, double bound) {
    return (double)evaluate_bound(network, network->inverse_mass, h) <= bound;
}

void mspringi_stability_limit_adapt(mspring_network *network) {
    mspring_id spring;
    const double h = mspringi_stable_in_any_shape(network, &spring);
    for (int round = 0; h > 0.0 && h < INFINITY && round < FIRST_EVALUATIONS; ++round)
        (void)evaluate_bound(network, network->inverse_mass, h);
}

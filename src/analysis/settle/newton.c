/// Search for an equilibrium.
#include <math.h>
#include <string.h>

#include "analysis/settle/equilibrium.h"

/// Fraction of the decrease predicted by the slope that a step must reach (Armijo 1966).
#define LEAST_DECREASE 1e-4
/// Halvings of a step before its direction is given up.
#define MOST_HALVINGS 40
/// Doublings of an accepted full step.
#define MOST_DOUBLINGS 20
/// Attempts at a direction with increasing shift.
#define MOST_SHIFTS 12
/// Shift that makes the stiffness of a stable equilibrium positive definite, relative to its scale. Covers rounding
/// and mechanisms without any stiffness.
#define STABLE_SHIFT 1e-9
/// Shift of a clamped stiffness; mechanisms would have none without it.
#define CLAMPED_SHIFT 1e-8
/// Perturbations of unstable equilibria, and their size relative to the mean rest length.
#define MOST_PUSHES 8
#define PUSH 1e-3
/// Step that is rounding, relative to the network's size or the largest displacement. Residuals at this step are
/// final.
#define SMALLEST_STEP 1e-14

typedef struct newton {
    mspringi_statics *statics;
    double reach; ///< longest step, m
    double push, shift;
    uint32_t pushes;
} newton;

static double largest_of(mspringi_vectors v, uint32_t count) {
    double largest = 0.0;
    for (uint32_t p = 0; p < count; ++p)
        largest = fmax(largest, fmax(fabs(v.x[p]), fabs(v.y[p])));
    return largest;
}

// Factor the full stiffness if it is positive definite, else the clamped one.
static bool factor(newton *n) {
    if (mspringi_statics_factor(n->statics, false, n->shift))
        return true;
    for (double shift = fmax(n->shift, CLAMPED_SHIFT); shift < 1e6; shift *= 100.0)
        if (mspringi_statics_factor(n->statics, true, shift))
            return true;
    return false;
}

/// Position on the path, and the change of energy there.
typedef struct reach {
    double t, change; ///< t 0: the energy does not fall
} reach;

// Double the step while the energy falls by more than rounding. A clamped stiffness is too stiff, so steps come out
// short where springs are compressed. An evaluation takes a small part of the time of a factorisation.
static reach extend(const newton *n, reach best) {
    for (int doublings = 0; doublings < MOST_DOUBLINGS; ++doublings) {
        double error;
        const double change = mspringi_statics_energy_change(n->statics, 2.0 * best.t, &error);
        if (!(change < best.change - error))
            return best;
        best = (reach){2.0 * best.t, change};
    }
    return best;
}

// Search backwards from t for a sufficient decrease of energy; if t itself suffices, forwards.
static reach search(const newton *n, double t, double slope) {
    for (int halvings = 0; halvings < MOST_HALVINGS; ++halvings, t *= 0.5) {
        double error;
        const double change = mspringi_statics_energy_change(n->statics, t, &error);
        if (change <= error - LEAST_DECREASE * t * slope)
            return halvings > 0 ? (reach){t, change} : extend(n, (reach){t, change});
    }
    return (reach){0.0, 0.0};
}

// Move along the curved path, no further than to where it turns back. If that is short, as with springs much
// shorter than the step, compare with the straight path. Return the largest coordinate of the move; < 0 if the
// energy does not fall.
static double go(newton *n) {
    mspringi_statics *statics = n->statics;
    const uint32_t count = statics->particle_count;
    const double slope = mspringi_statics_slope(statics);
    const double step = largest_of(statics->step, count), bend = largest_of(statics->bend, count);
    if (!(slope >= 0.0 && step < INFINITY && bend < INFINITY))
        return -1.0;
    const double farthest = step > n->reach ? n->reach / step : 1.0;
    reach best = search(n, farthest * bend > step ? step / bend : farthest, slope);
    if (best.t < 0.5 * farthest) {
        const size_t bytes = 2 * (size_t)count * sizeof *statics->bend.x;
        memcpy(statics->spare.x, statics->bend.x, bytes);
        memset(statics->bend.x, 0, bytes);
        const reach straight = search(n, farthest, slope);
        if (straight.t > 0.0 && (best.t == 0.0 || straight.change < best.change))
            best = straight;
        else
            memcpy(statics->bend.x, statics->spare.x, bytes);
    }
    if (best.t == 0.0)
        return -1.0;
    if (best.t >= farthest && farthest < 1.0)
        n->reach *= 4.0; // the equilibrium is further away than the network is large
    for (uint32_t p = 0; p < count; ++p) {
        statics->moved.x[p] += best.t * (statics->step.x[p] + best.t * statics->bend.x[p]);
        statics->moved.y[p] += best.t * (statics->step.y[p] + best.t * statics->bend.y[p]);
    }
    return best.t * step;
}

// Take one step. Returns the result of go().
static double iterate(newton *n) {
    for (int tries = 0; tries < MOST_SHIFTS; ++tries) {
        if (factor(n)) {
            mspringi_statics_find_way(n->statics);
            const double moved = go(n);
            if (moved >= 0.0) {
                n->shift = n->shift > 1e-12 ? 0.01 * n->shift : 0.0;
                return moved;
            }
        }
        n->shift = fmax(CLAMPED_SHIFT, 10.0 * n->shift);
    }
    return -1.0;
}

// Perturb all particles, the same way on every machine: SplitMix64 of their numbers (Steele et al. 2014).
static void push(newton *n) {
    mspringi_statics *statics = n->statics;
    for (uint32_t p = 0; p < statics->particle_count; ++p) {
        uint64_t bits = ((uint64_t)n->pushes << 32 | p) * 0x9e3779b97f4a7c15u;
        bits = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9u;
        bits = (bits ^ bits >> 27) * 0x94d049bb133111ebu;
        bits ^= bits >> 31;
        if (statics->fixed[p])
            continue;
        statics->moved.x[p] += n->push * ((double)(bits & 0xffff) / 65536.0 - 0.5);
        statics->moved.y[p] += n->push * ((double)(bits >> 16 & 0xffff) / 65536.0 - 0.5);
    }
    n->pushes++;
}

mspringi_rest mspringi_statics_rest(mspringi_statics *statics, uint32_t most_iterations, double tolerance,
                                    double size) {
    newton n = {.statics = statics, .reach = size};
    for (uint32_t i = 0; i < statics->springs.count; ++i)
        n.push += PUSH * statics->springs.rest_length[i] / (double)statics->springs.count;
    mspringi_rest rest = {.residual = mspringi_statics_forces(statics)};
    for (;;) {
        if (rest.found || rest.residual.force <= tolerance * rest.residual.scale) {
            rest.found = true;
            rest.is_stable = mspringi_statics_factor(statics, false, STABLE_SHIFT);
            if (rest.is_stable || n.pushes == MOST_PUSHES)
                return rest;
            push(&n);
            rest.found = false;
            rest.residual = mspringi_statics_forces(statics);
        }
        const mspringi_watcher *watcher = &statics->watcher;
        if (rest.iterations == most_iterations || (watcher->fn && !watcher->fn(watcher->user)))
            return rest;
        const double moved = iterate(&n);
        if (moved < 0.0)
            return rest;
        rest.iterations++;
        rest.residual = mspringi_statics_forces(statics);
        rest.found = moved <= SMALLEST_STEP * fmax(size, largest_of(statics->moved, statics->particle_count));
    }
}

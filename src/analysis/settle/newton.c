/// Search for an equilibrium.
#include <math.h>
#include <string.h>

#include "analysis/settle/equilibrium.h"
#include "base/hash.h"

/// Fraction of the decrease predicted by the slope that a step must reach (Armijo 1966).
#define MIN_DECREASE 1e-4
/// Halvings of a step before its direction is given up.
#define MAX_HALVINGS 40
/// Doublings of an accepted full step.
#define MAX_DOUBLINGS 20
/// Attempts at a direction with increasing shift.
#define MAX_SHIFTS 12
/// Shift that makes the stiffness of a stable equilibrium positive definite, relative to its scale. Covers rounding
/// and mechanisms without any stiffness.
#define STABLE_SHIFT 1e-9
/// Shift of a clamped stiffness; mechanisms would have none without it.
#define CLAMPED_SHIFT 1e-8
/// With elements, whose stiffness across their sides the matrix lacks: 102 of 382 floppy rings with areas and
/// angles took over 1000 iterations without secants. With them 31 did with the shift above, 11 with 1e-4, 9 with
/// this.
#define SHIFT_WITH_SECANTS 1e-2
/// Perturbations of unstable equilibria, and their size relative to the mean rest length.
#define MAX_PERTURBATIONS 8
#define PERTURBATION 1e-3
/// Step that is rounding, relative to the network's size or the largest displacement. Residuals at this step are
/// final.
#define SMALLEST_STEP 1e-14

typedef struct newton {
    mspringi_statics *statics;
    double max_step;            ///< longest step, m
    double perturbation, shift; ///< size of a perturbation, m; shift of the stiffness
    uint32_t perturbation_count;
} newton;

static double largest_of(mspringi_vectors v, uint32_t count) {
    double largest = 0.0;
    for (uint32_t p = 0; p < count; ++p)
        largest = fmax(largest, fmax(fabs(v.x[p]), fabs(v.y[p])));
    return largest;
}

// Factor the full stiffness if it is positive definite, else the clamped one.
static bool factor_stiffness(newton *n) {
    if (mspringi_statics_factor(n->statics, false, n->shift))
        return true;
    const double least = n->statics->secants.block ? SHIFT_WITH_SECANTS : CLAMPED_SHIFT;
    for (double shift = fmax(n->shift, least); shift < 1e6; shift *= 100.0)
        if (mspringi_statics_factor(n->statics, true, shift))
            return true;
    return false;
}

/// Position on the path, and the change of energy there.
typedef struct path_point {
    double t, change; ///< t 0: the energy does not fall
} path_point;

// Double the step while the energy falls by more than rounding. A clamped stiffness is too stiff, so steps come out
// short where springs are compressed. An evaluation takes a small part of the time of a factorisation.
static path_point extend_step(const newton *n, path_point best) {
    for (int doublings = 0; doublings < MAX_DOUBLINGS; ++doublings) {
        double error;
        const double change = mspringi_statics_energy_change(n->statics, 2.0 * best.t, &error);
        if (!(change < best.change - error))
            return best;
        best = (path_point){2.0 * best.t, change};
    }
    return best;
}

// Search backwards from t for a sufficient decrease of energy; if t itself suffices, forwards.
static path_point search_step(const newton *n, double t, double slope) {
    for (int halvings = 0; halvings < MAX_HALVINGS; ++halvings, t *= 0.5) {
        double error;
        const double change = mspringi_statics_energy_change(n->statics, t, &error);
        if (change <= error - MIN_DECREASE * t * slope)
            return halvings > 0 ? (path_point){t, change} : extend_step(n, (path_point){t, change});
    }
    return (path_point){0.0, 0.0};
}

// Move along the curved path, no further than to where it turns back. If that is short, as with springs much
// shorter than the step, compare with the straight path. Return the largest coordinate of the move; < 0 if the
// energy does not fall.
static double move_along_path(newton *n) {
    mspringi_statics *statics = n->statics;
    const uint32_t count = statics->particle_count;
    const double slope = mspringi_statics_slope(statics);
    const double step = largest_of(statics->step, count), curvature = largest_of(statics->curvature, count);
    if (!(slope >= 0.0 && step < INFINITY && curvature < INFINITY))
        return -1.0;
    const double farthest = step > n->max_step ? n->max_step / step : 1.0;
    path_point best = search_step(n, farthest * curvature > step ? step / curvature : farthest, slope);
    if (best.t < 0.5 * farthest) {
        const size_t bytes = 2 * (size_t)count * sizeof *statics->curvature.x;
        memcpy(statics->spare.x, statics->curvature.x, bytes);
        memset(statics->curvature.x, 0, bytes);
        const path_point straight = search_step(n, farthest, slope);
        if (straight.t > 0.0 && (best.t == 0.0 || straight.change < best.change))
            best = straight;
        else
            memcpy(statics->curvature.x, statics->spare.x, bytes);
    }
    if (best.t == 0.0)
        return -1.0;
    if (best.t >= farthest && farthest < 1.0)
        n->max_step *= 4.0; // the equilibrium is further away than the network is large
    for (uint32_t p = 0; p < count; ++p) {
        statics->moved.x[p] += best.t * (statics->step.x[p] + best.t * statics->curvature.x[p]);
        statics->moved.y[p] += best.t * (statics->step.y[p] + best.t * statics->curvature.y[p]);
    }
    return best.t * step;
}

// Take one step. Returns the result of move_along_path().
static double iterate(newton *n) {
    for (int tries = 0; tries < MAX_SHIFTS; ++tries) {
        if (factor_stiffness(n)) {
            mspringi_statics_find_step(n->statics);
            const double moved = move_along_path(n);
            if (moved >= 0.0) {
                n->shift = n->shift > 1e-12 ? 0.01 * n->shift : 0.0;
                return moved;
            }
        }
        n->shift = fmax(CLAMPED_SHIFT, 10.0 * n->shift);
        n->statics->secants.count = 0;
    }
    return -1.0;
}

// Perturb all particles, the same way on every machine.
static void perturb(newton *n) {
    mspringi_statics *statics = n->statics;
    for (uint32_t p = 0; p < statics->particle_count; ++p) {
        uint64_t bits = mspringi_mix((uint64_t)n->perturbation_count << 32 | p);
        bits ^= bits >> 31;
        if (statics->fixed[p])
            continue;
        statics->moved.x[p] += n->perturbation * ((double)(bits & 0xffff) / 65536.0 - 0.5);
        statics->moved.y[p] += n->perturbation * ((double)(bits >> 16 & 0xffff) / 65536.0 - 0.5);
    }
    n->perturbation_count++;
}

mspringi_equilibrium mspringi_statics_find_equilibrium(mspringi_statics *statics, uint32_t max_iterations,
                                                       double tolerance, double size) {
    newton n = {.statics = statics, .max_step = size};
    for (uint32_t i = 0; i < statics->springs.count; ++i)
        n.perturbation += PERTURBATION * statics->springs.rest_length[i] / (double)statics->springs.count;
    mspringi_equilibrium equilibrium = {.residual = mspringi_statics_forces(statics)};
    for (;;) {
        if (equilibrium.found || equilibrium.residual.force <= tolerance * equilibrium.residual.scale) {
            equilibrium.found = true;
            equilibrium.is_stable = mspringi_statics_factor(statics, false, STABLE_SHIFT);
            if (equilibrium.is_stable || n.perturbation_count == MAX_PERTURBATIONS)
                return equilibrium;
            perturb(&n);
            equilibrium.found = false;
            equilibrium.residual = mspringi_statics_forces(statics);
        }
        const mspringi_watcher *watcher = &statics->watcher;
        if (equilibrium.iterations == max_iterations || (watcher->fn && !watcher->fn(watcher->user)))
            return equilibrium;
        const double moved = iterate(&n);
        if (moved < 0.0)
            return equilibrium;
        equilibrium.iterations++;
        equilibrium.residual = mspringi_statics_forces(statics);
        equilibrium.found =
            moved <= SMALLEST_STEP * fmax(size, largest_of(statics->moved, statics->particle_count));
    }
}

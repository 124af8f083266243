/// Angle springs in the linear system of a substep: those that have springs along both arms.
///
/// With g the gradient of the angle where the particles are predicted, k its stiffness there and c its damping, one
/// adds w g g', w = force_scale (k + c damping_rate). Iterations need no more of it than its product with a field.
/// So there is no pair of particles that the springs' pattern would lack, and a body turns as freely as it does.
#include "store/angles.h"

#include <math.h>

#include "sleep/sleep.h"
#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"

// A sleeper is swept by the direct solver only, where it is as heavy as a pinned particle.
static bool sleeps(const mspring_network *network, const mspringi_hinge *hinge) {
    bool any = false;
    for (int i = 0; i < 3 && network->sleep.sleeping > 0; ++i)
        any = any || mspringi_slot_is_asleep(network, hinge->slots[i]);
    return any && !mspringi_implicit_of(network)->is_direct;
}

mspringi_hinge *mspringi_next_hinge(const mspring_network *network, size_t *at) {
    const mspringi_areas *all = &network->areas;
    while (*at < all->hinge_count && sleeps(network, &all->hinges[*at]))
        ++*at;
    return *at < all->hinge_count ? &all->hinges[(*at)++] : NULL;
}

/* ------------------------------------------------------------------------------------------------- the system */

/// An arm where it is predicted, and the gradient of its direction at its end.
typedef struct arm {
    double along[2], x, y, rate;
} arm;

static arm arm_of(const mspringi_implicit *n, uint32_t from, uint32_t to) {
    const double x = n->x[to] - n->x[from], y = n->y[to] - n->y[from], square = x * x + y * y;
    arm found = {{x, y}, 0.0, 0.0, 0.0};
    if (square > 0.0) {
        found.x = -y / square;
        found.y = x / square;
        found.rate = found.x * (double)(n->velocity.x[to] - n->velocity.x[from]) +
                     found.y * (double)(n->velocity.y[to] - n->velocity.y[from]);
    }
    return found;
}

static void add_corner(const mspringi_implicit *n, const mspringi_hinge *hinge, int i, double x, double y) {
    const uint32_t slot = hinge->slots[i];
    n->residual.x[slot] += mspringi_bounded(x);
    n->residual.y[slot] += mspringi_bounded(y);
    n->system.xx[slot] += mspringi_bounded(hinge->pull_x[i] * hinge->pull_x[i]);
    n->system.xy[slot] += mspringi_bounded(hinge->pull_x[i] * hinge->pull_y[i]);
    n->system.yy[slot] += mspringi_bounded(hinge->pull_y[i] * hinge->pull_y[i]);
}

static void add_hinge(const mspring_network *network, mspringi_hinge *hinge) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_area *angle = &network->areas.list[hinge->angle];
    const arm u = arm_of(n, hinge->slots[0], hinge->slots[1]), w = arm_of(n, hinge->slots[1], hinge->slots[2]);
    const double size = mspringi_angle_size_by(angle, u.along, w.along), damping = (double)angle->damping;
    const double torque =
        n->system.force_scale * (mspringi_angle_torque(angle, size) - damping * (w.rate - u.rate));
    const double root =
        sqrt(n->system.force_scale * (mspringi_angle_stiffness(angle, size) + damping * n->system.damping_rate));
    const double x[3] = {u.x, -(u.x + w.x), w.x}, y[3] = {u.y, -(u.y + w.y), w.y};
    for (int i = 0; i < 3; ++i) {
        hinge->pull_x[i] = root * x[i];
        hinge->pull_y[i] = root * y[i];
        add_corner(n, hinge, i, torque * x[i], torque * y[i]);
    }
}

void mspringi_angles_add_terms(const mspring_network *network) {
    mspringi_hinge *hinge;
    for (size_t at = 0; (hinge = mspringi_next_hinge(network, &at)) != NULL;)
        add_hinge(network, hinge);
}

// Of differences, so that what is moved as a whole feels nothing.
static double turn_by(const mspringi_hinge *hinge, mspringi_field field) {
    const uint32_t *slots = hinge->slots;
    const double x = (double)field.x[slots[1]], y = (double)field.y[slots[1]];
    return hinge->pull_x[0] * ((double)field.x[slots[0]] - x) + hinge->pull_y[0] * ((double)field.y[slots[0]] - y) +
           hinge->pull_x[2] * ((double)field.x[slots[2]] - x) + hinge->pull_y[2] * ((double)field.y[slots[2]] - y);
}

double mspringi_angles_multiply(const mspring_network *network, mspringi_field from, mspringi_field to) {
    const mspringi_hinge *hinge;
    double sum = 0.0;
    for (size_t at = 0; (hinge = mspringi_next_hinge(network, &at)) != NULL;) {
        const uint32_t *slots = hinge->slots;
        const double turned = turn_by(hinge, from);
        const float ax = (float)(turned * hinge->pull_x[0]), ay = (float)(turned * hinge->pull_y[0]);
        const float cx = (float)(turned * hinge->pull_x[2]), cy = (float)(turned * hinge->pull_y[2]);
        to.x[slots[0]] += ax;
        to.y[slots[0]] += ay;
        to.x[slots[2]] += cx;
        to.y[slots[2]] += cy;
        to.x[slots[1]] -= (float)((double)ax + (double)cx);
        to.y[slots[1]] -= (float)((double)ay + (double)cy);
        sum += turned * turned;
    }
    return sum;
}

/* --------------------------------------------------------------------------------------------- the coarse matrix
 */

// Have a corner pull at its tile.
static void pull_at(const mspringi_implicit *n, mspringi_coarse_rank_one *pulls, const mspringi_hinge *hinge,
                    int corner) {
    const uint32_t slot = hinge->slots[corner], tile = n->tiles.of_slot[slot];
    uint32_t i = 0;
    if (tile == MSPRING_NONE)
        return;
    while (i < pulls->count && pulls->tiles[i] != tile)
        ++i;
    if (i == pulls->count) {
        pulls->count++;
        pulls->tiles[i] = tile;
    }
    pulls->rows[i][0] += hinge->pull_x[corner];
    pulls->rows[i][1] += hinge->pull_y[corner];
    pulls->rows[i][2] +=
        (double)n->arm.x[slot] * hinge->pull_y[corner] - (double)n->arm.y[slot] * hinge->pull_x[corner];
}

void mspringi_angles_add_to_coarse(const mspring_network *network) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_hinge *hinge;
    for (size_t at = 0; (hinge = mspringi_next_hinge(network, &at)) != NULL;) {
        mspringi_coarse_rank_one pulls = {0};
        for (int corner = 0; corner < 3; ++corner)
            pull_at(n, &pulls, hinge, corner);
        mspringi_coarse_add_rank_one(&n->coarse, &pulls);
    }
}

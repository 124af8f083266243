/// Angle springs for the factored system.
///
/// An angle joins particles that no spring need join, so it has no place in the factor. Its torque is an unknown
/// instead: with the rows G of what pulls at the corners, and d without angles, the torques t are of
///
///     (G A^-1 G^T + 1) t = -G d,
///
/// solved by conjugate gradients, each of which takes one solution with the factor. In a straight beam springs do
/// not resist what angles do, and A is the masses M there. So the preconditioner is G M^-1 G^T + 1, of which each
/// angle knows those two before it: the band of a beam whose angles were added in their order.
#include <string.h>

#include "solvers/direct/direct.h"
#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"

/// Most iterations; and the product of residuals at which they end, as a part of the first one. What only masses
/// hold gives way by 10^10 times as much as it does with its angles.
#define MOST_ITERATIONS 1000u
#define LEAST_PRODUCT 1e-24

/* -------------------------------------------------------------------------------------------- the preconditioner
 */

// What the torque of one turns another by, if particles are free.
static double shared(const mspringi_implicit *n, const mspringi_hinge *one, const mspringi_hinge *other) {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (one->slots[i] == other->slots[j] && n->mass[one->slots[i]] > 0.0f)
                sum += (one->pull_x[i] * other->pull_x[j] + one->pull_y[i] * other->pull_y[j]) /
                       (double)n->mass[one->slots[i]];
    return sum;
}

// Factor it, as L D L^T. No pivot is below 1, if what the band lacks would not make it so.
static void factor(const mspring_network *network) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    mspringi_hinge *const list = network->areas.hinges;
    for (size_t i = 0; i < network->areas.hinge_count; ++i) {
        mspringi_hinge *h = &list[i];
        double pivot = 1.0 + shared(n, h, h);
        h->beside[0] = h->beside[1] = 0.0;
        if (i > 1) {
            const double product = shared(n, h, &list[i - 2]);
            h->beside[1] = product / list[i - 2].pivot;
            pivot -= product * h->beside[1];
        }
        if (i > 0) {
            const double product = shared(n, h, &list[i - 1]) -
                                   (i > 1 ? h->beside[1] * list[i - 2].pivot * list[i - 1].beside[0] : 0.0);
            h->beside[0] = product / list[i - 1].pivot;
            pivot -= product * h->beside[0];
        }
        h->pivot = pivot > 1.0 ? pivot : 1.0;
    }
}

// Apply it to what is left. Returns left . given.
static double precondition(const mspringi_areas *areas) {
    mspringi_hinge *const list = areas->hinges;
    const size_t count = areas->hinge_count;
    double sum = 0.0;
    for (size_t i = 0; i < count; ++i) {
        list[i].given = list[i].left;
        for (size_t k = 0; k < 2 && k < i; ++k)
            list[i].given -= list[i].beside[k] * list[i - 1 - k].given;
    }
    for (size_t i = count; i-- > 0;) {
        list[i].given /= list[i].pivot;
        for (size_t k = 0; k < 2 && i + 1 + k < count; ++k)
            list[i].given -= list[i + 1 + k].beside[k] * list[i + 1 + k].given;
        sum += list[i].left * list[i].given;
    }
    return sum;
}

/* ----------------------------------------------------------------------------------------------------- iteration
 */

static double turn_by(const mspringi_hinge *h, const double *x, const double *y) {
    const double middle_x = x[h->slots[1]], middle_y = y[h->slots[1]];
    return h->pull_x[0] * (x[h->slots[0]] - middle_x) + h->pull_y[0] * (y[h->slots[0]] - middle_y) +
           h->pull_x[2] * (x[h->slots[2]] - middle_x) + h->pull_y[2] * (y[h->slots[2]] - middle_y);
}

// What the torques of the search do, to the particles and to all angles. Returns search . answer.
static double answer_search(const mspring_network *network, double *x, double *y) {
    mspringi_direct *d = &mspringi_implicit_of(network)->direct;
    mspringi_hinge *h;
    double sum = 0.0;
    memset(x, 0, 2 * (mspringi_slot_count(network) + 1) * sizeof *x);
    for (size_t at = 0; (h = mspringi_next_hinge(network, &at)) != NULL;)
        for (int i = 0; i < 3; ++i) {
            x[h->slots[i]] += h->search * h->pull_x[i];
            y[h->slots[i]] += h->search * h->pull_y[i];
        }
    mspringi_cholesky_double_solve(&d->twice, x, y);
    mspringi_implicit_count_solve(network);
    for (size_t at = 0; (h = mspringi_next_hinge(network, &at)) != NULL;) {
        h->answer = turn_by(h, x, y) + h->search;
        sum += h->search * h->answer;
    }
    return sum;
}

void mspringi_direct_hold_angles(const mspring_network *network, double *x, double *y) {
    const size_t nodes = mspringi_slot_count(network) + 1;
    double *const to_x = mspringi_implicit_of(network)->direct.answer, *const to_y = to_x + nodes;
    mspringi_hinge *h;
    if (network->areas.hinge_count == 0)
        return;
    factor(network);
    for (size_t at = 0; (h = mspringi_next_hinge(network, &at)) != NULL;)
        h->left = -turn_by(h, x, y);
    double product = precondition(&network->areas);
    const double least = LEAST_PRODUCT * product;
    for (size_t at = 0; (h = mspringi_next_hinge(network, &at)) != NULL;)
        h->search = h->given;
    for (uint32_t iteration = 0; iteration < MOST_ITERATIONS && product > least; ++iteration) {
        const double alpha = product / answer_search(network, to_x, to_y);
        if (!(alpha > 0.0))
            break;
        for (size_t i = 0; i < nodes; ++i) {
            x[i] += alpha * to_x[i];
            y[i] += alpha * to_y[i];
        }
        for (size_t at = 0; (h = mspringi_next_hinge(network, &at)) != NULL;)
            h->left -= alpha * h->answer;
        const double next = precondition(&network->areas), beta = next / product;
        for (size_t at = 0; (h = mspringi_next_hinge(network, &at)) != NULL;)
            h->search = h->given + beta * h->search;
        product = next;
    }
}

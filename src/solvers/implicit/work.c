/// Work of a step, in the unit of mspring_settings.most_work: its passes, and its products with the matrix.
///
/// It is counted from what is computed, so it is the same for any number of workers. Beyond what a substep is
/// allowed nothing is repeated: intervals are accepted by the energy budget, and bodies that touch are rigid
/// (rigid_contact.c).
#include "solvers/implicit/implicit.h"

#include <math.h>

/// Products that count as one.
#define PRODUCTS_OF_ONE 8.0

/// Iterations of calm solutions that the residual ends: these, or if there may be many more a quarter of the most.
/// (Bars take 8 at a residual of 0.01, the sample ship 14.)
#define CALM_ITERATIONS 8u

/// Calm steps for each that the host allows: bodies that touch take 16 times the iterations, and some passes. (With
/// 4, a stack of five at rest was cut off in a third of its steps, with 16 in one of 200. Of 900 light bodies
/// between a heavy one and a wall 3 were pressed a third of the thickness into it with 16, none with 32. A heap of
/// eight beams of 12x3 took up to 330 without a bound, tangles of rods 3,000.) The direct solver has the same work,
/// 53 of its calm steps, as each iteration for contact is a product, too. (With 32, two heaps of 30 fragments ran
/// out of work in a quarter to half of their steps, with 53 in 0.6 %, and a step took less on average.)
#define TIMES_ALLOWED 32.0

static double work_of_pass(const mspringi_implicit *n, double products) {
    return 1.0 + (n->is_direct ? 1.0 : products) / PRODUCTS_OF_ONE;
}

static uint32_t calm_iterations(const mspringi_implicit *n) {
    const uint32_t most = n->iterations, many = most / 4 > CALM_ITERATIONS ? most / 4 : CALM_ITERATIONS;
    return n->residual_share > 0.0f && many < most ? many : most;
}

uint32_t mspringi_implicit_most_iterations(const mspringi_implicit *n, uint32_t times) {
    const uint32_t most = times * calm_iterations(n);
    return most > n->iterations ? most : n->iterations;
}

// Work of an interval that repeats nothing: one pass, with twice the iterations.
static double work_of_interval(const mspringi_implicit *n) {
    return work_of_pass(n, (double)mspringi_implicit_most_iterations(n, 2));
}

double mspringi_implicit_calm_work(const mspringi_implicit *n) {
    return work_of_pass(n, (double)calm_iterations(n) - 1.0); // the last step takes none
}

double mspringi_implicit_work(const mspringi_implicit *n) {
    const uint32_t products = n->product_count + (n->is_direct ? n->pass_count : 0); // each solution is one
    return (double)n->pass_count + (double)products / PRODUCTS_OF_ONE;
}

void mspringi_implicit_allow_work(mspringi_implicit *n, double rate) {
    // A calm step of the direct solver has one product.
    const double of_direct = (PRODUCTS_OF_ONE + CALM_ITERATIONS - 1.0) / (PRODUCTS_OF_ONE + 1.0);
    n->work_rate = TIMES_ALLOWED * (n->is_direct ? of_direct : 1.0) * rate;
    n->most_work = 0.0;
}

bool mspringi_implicit_may_repeat(mspringi_implicit *n) {
    const bool is_left = mspringi_implicit_work(n) + n->intervals_left * work_of_interval(n) < n->most_work;
    n->is_spent |= !is_left;
    return is_left;
}

uint32_t mspringi_implicit_limit_intervals(mspringi_implicit *n, uint32_t intervals) {
    const double most = fmax((n->most_work - mspringi_implicit_work(n)) / work_of_interval(n), 1.0);
    n->is_spent |= (double)intervals > most;
    return (double)intervals > most ? (uint32_t)most : intervals;
}

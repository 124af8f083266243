/// Calls of all elements in the stability limit.
#include "stability/stability_elements.h"

static const mspringi_stability_ops *const all[] = {
#define STABILITY(table) &table,
#include "store/features.def"
    NULL};

bool mspringi_stability_elements_are_used(const mspring_network *network) {
    bool any = false;
    for (const mspringi_stability_ops *const *ops = all; *ops; ++ops)
        any = any || (*ops)->is_used(network);
    return any;
}

void mspringi_stability_elements_sum(const mspring_network *network, float *sums, float *dampings) {
    for (const mspringi_stability_ops *const *ops = all; *ops; ++ops)
        (*ops)->sum(network, sums, dampings);
}

double mspringi_stability_elements_largest(const mspring_network *network, const float *sums) {
    double largest = 0.0;
    for (const mspringi_stability_ops *const *ops = all; *ops; ++ops)
        largest = fmax(largest, (*ops)->largest(network, sums));
    return largest;
}

void mspringi_stability_elements_bound(const mspring_network *network, const mspringi_stability_limit *limit) {
    for (const mspringi_stability_ops *const *ops = all; *ops; ++ops)
        (*ops)->bound(network, limit);
}

void mspringi_stability_elements_image(const mspring_network *network, const mspringi_stability_limit *limit,
                                       double square) {
    for (const mspringi_stability_ops *const *ops = all; *ops; ++ops)
        (*ops)->image(network, limit, square);
}

void mspringi_stability_elements_quotient(const mspring_network *network, mspringi_displacement vector,
                                          mspringi_quotient *sum) {
    for (const mspringi_stability_ops *const *ops = all; *ops; ++ops)
        (*ops)->quotient(network, vector, sum);
}

double mspringi_stability_elements_longest(const mspring_network *network) {
    double longest = INFINITY;
    for (const mspringi_stability_ops *const *ops = all; *ops; ++ops)
        longest = fmin(longest, (*ops)->longest(network));
    return longest;
}

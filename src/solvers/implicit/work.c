/// Work of the solver while bodies are near, in the unit of contact: a comparison of a point with an edge, 25 ns.
///
/// Active sets, halvings and intervals repeat substeps, and each repetition may factor the matrix. Contact counts
/// its comparisons and refuses the step where they are too many; here are what takes as long.
#include "features/contact/contacts.h"
#include "solvers/implicit/implicit.h"

/// Springs that an iteration takes in the time of a comparison; comparisons in that of an iteration without any,
/// and of a constraint in an iteration or solution.
#define SPRINGS_OF_WORK 5.0
#define WORK_OF_ITERATION 60.0
#define WORK_OF_CONSTRAINT 1.5

/// Numbers of the factor that a solution reads and that a factorisation writes, and products that it subtracts, in
/// that time.
#define READS_OF_WORK 40.0
#define WRITES_OF_WORK 6.0
#define PRODUCTS_OF_WORK 1600.0

/// Work that a substep is allowed: 65 ms, 75 us for a particle, and solutions with a factorisation or with so many
/// iterations each. (A substep takes 30 us a particle of a grid of 3,200 that is folded onto itself, 15 of a comb
/// of 8,000, and a millisecond a particle of a chain of 90 in a tangle.)
#define WORK_OF_SUBSTEP 0x1.4p21
#define WORK_OF_PARTICLE 3000.0
#define FREE_SOLUTIONS 16.0
#define ITERATIONS_OF_SOLUTION 64.0

static double work_of_constraints(const mspring_network *network) {
    return WORK_OF_CONSTRAINT * (double)network->contacts->constraint_count;
}

// Without constraints.
static double work_of_solve(const mspring_network *network) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    return n->is_direct ? WORK_OF_ITERATION + (double)n->direct.plan.panel_reals / READS_OF_WORK
                        : WORK_OF_ITERATION + (double)network->topology.spring_count / SPRINGS_OF_WORK;
}

static double work_of_factorisation(const mspring_network *network) {
    const mspringi_cholesky_symbolic *plan = &mspringi_implicit_of(network)->direct.plan;
    return work_of_solve(network) + (double)plan->panel_reals / WRITES_OF_WORK +
           plan->multiply_adds / PRODUCTS_OF_WORK;
}

static bool is_counted(const mspring_network *network) {
    return network->contacts && network->contacts->quiet_substeps == 0;
}

void mspringi_implicit_allow_work(const mspring_network *network) {
    const double solution = mspringi_implicit_of(network)->is_direct
                                ? work_of_factorisation(network)
                                : ITERATIONS_OF_SOLUTION * work_of_solve(network);
    if (is_counted(network) && !network->contacts->is_out_of_room)
        network->contacts->most_work +=
            (uint64_t)(WORK_OF_SUBSTEP + WORK_OF_PARTICLE * network->topology.particle_count +
                       FREE_SOLUTIONS * solution);
}

void mspringi_implicit_count_solve(const mspring_network *network) {
    mspringi_implicit_of(network)->solves++;
    if (is_counted(network))
        network->contacts->work += (uint64_t)(work_of_solve(network) + work_of_constraints(network));
}

void mspringi_implicit_count_factorisation(const mspring_network *network) {
    if (is_counted(network))
        network->contacts->work += (uint64_t)work_of_factorisation(network);
}

bool mspringi_implicit_is_too_much(const mspring_network *network) {
    return network->contacts &&
           (network->contacts->is_out_of_room || mspringi_contact_is_too_much(network->contacts));
}

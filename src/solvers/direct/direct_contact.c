/// Contact between bodies for the factored system.
///
/// A row joins two bodies, so it has no place in the factor. Its force is an unknown instead: with the rows J of
/// those that hold, their stiffness S, and d without them, the forces f that hold them are of
///
///     (J A^-1 J^T + S^-1) f = -(gap + J d),
///
/// solved by conjugate gradients, each of which takes one solution with the factor. S is about as stiff as the
/// network is, so few forces differ much: those of bodies as a whole.
#include <string.h>

#include "solvers/direct/direct.h"
#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"

/// Most iterations, and the product of residuals at which they end, as a part of the first one.
#define MOST_ITERATIONS 64
#define LEAST_PRODUCT 1e-12

typedef mspringi_implicit_constraint hold;
typedef double pair_of_shares[2];

// List the unknowns: forces across active constraints, and along those that stick. Return the first constraint.
static hold *list_active(const mspringi_contacts *contacts) {
    hold *const all = contacts->implicit_constraints;
    uint32_t first = MSPRING_NONE;
    for (uint32_t r = contacts->constraint_count; r-- > 0;) {
        if (!all[r].is_active)
            continue;
        all[r].force_count = mspringi_implicit_constraint_sticks(&all[r]) ? 2 : 1;
        all[r].next = first;
        first = r;
    }
    return first == MSPRING_NONE ? NULL : &all[first];
}

static hold *next_of(const mspringi_contacts *contacts, const hold *c) {
    return c->next == MSPRING_NONE ? NULL : &contacts->implicit_constraints[c->next];
}

static pair_of_shares *shares_of(hold *c, uint32_t i) {
    return i == 0 ? c->across : c->along;
}

static double stiffness_of(const hold *c, uint32_t i) {
    return i == 0 ? c->stiffness : c->grip;
}

// Begin where no row gives any force. Returns the product of residuals.
static double begin(const mspring_network *network, const mspringi_contacts *contacts, hold *first) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    double sum = 0.0;
    for (hold *c = first; c; c = next_of(contacts, c)) {
        for (uint32_t i = 0; i < c->force_count; ++i) {
            c->left[i] = -((i == 0 ? c->gap : c->ahead) +
                           mspringi_implicit_contact_gather(network, c, shares_of(c, i), n->displacement));
            c->search[i] = stiffness_of(c, i) * c->left[i];
            sum += c->search[i] * c->left[i];
        }
    }
    return sum;
}

// What the forces of the search do, to n->scaled.
static void spread_search(const mspring_network *network, const mspringi_contacts *contacts, hold *first) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    memset(n->scaled.x, 0, 2 * mspringi_slot_count(network) * sizeof *n->scaled.x);
    for (hold *c = first; c; c = next_of(contacts, c)) {
        for (uint32_t i = 0; i < c->force_count; ++i)
            mspringi_implicit_contact_scatter(network, c, shares_of(c, i), c->search[i], n->scaled);
    }
}

// What rows feel of that, to answer. Returns search . answer.
static double gather_answer(const mspring_network *network, const mspringi_contacts *contacts, hold *first) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    double sum = 0.0;
    for (hold *c = first; c; c = next_of(contacts, c)) {
        for (uint32_t i = 0; i < c->force_count; ++i) {
            c->answer[i] = mspringi_implicit_contact_gather(network, c, shares_of(c, i), n->scaled) +
                           c->search[i] / stiffness_of(c, i);
            sum += c->search[i] * c->answer[i];
        }
    }
    return sum;
}

// Go on by alpha. Returns the product of residuals.
static double advance(const mspring_network *network, const mspringi_contacts *contacts, hold *first,
                      double alpha) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const size_t count = 2 * mspringi_slot_count(network);
    double sum = 0.0;
    for (size_t i = 0; i < count; ++i)
        n->displacement.x[i] += (float)(alpha * (double)n->scaled.x[i]);
    for (hold *c = first; c; c = next_of(contacts, c)) {
        for (uint32_t i = 0; i < c->force_count; ++i) {
            c->left[i] -= alpha * c->answer[i];
            sum += stiffness_of(c, i) * c->left[i] * c->left[i];
        }
    }
    return sum;
}

static void turn(const mspringi_contacts *contacts, hold *first, double beta) {
    for (hold *c = first; c; c = next_of(contacts, c)) {
        for (uint32_t i = 0; i < c->force_count; ++i)
            c->search[i] = stiffness_of(c, i) * c->left[i] + beta * c->search[i];
    }
}

void mspringi_direct_hold_bodies(mspring_network *network, mspringi_solve_fn solve) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    mspringi_contacts *contacts = network->contacts;
    if (!mspringi_implicit_contact_is_active(network))
        return;
    hold *const first = list_active(contacts);
    double product = begin(network, contacts, first);
    const double least = LEAST_PRODUCT * product;
    for (uint32_t iteration = 0; iteration < MOST_ITERATIONS && product > least && mspringi_may_iterate(n) &&
                                 !mspringi_implicit_is_too_much(network);
         ++iteration) {
        spread_search(network, contacts, first);
        solve(network, n->scaled);
        mspringi_implicit_count_solve(network);
        const double curvature = gather_answer(network, contacts, first);
        if (!(curvature > 0.0))
            break;
        const double next = advance(network, contacts, first, product / curvature);
        turn(contacts, first, next / product);
        product = next;
    }
    // The direct solver has no tiles that would turn what is predicted.
    memset(n->scaled.x, 0, 2 * mspringi_slot_count(network) * sizeof *n->scaled.x);
}

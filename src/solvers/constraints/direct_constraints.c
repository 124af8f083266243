/// Constraints of the direct solver.
///
/// A constraint of one particle is on the diagonal of the factored matrix A. Others join particles that no spring
/// need join, so the factor has no entries for them, and their forces are unknowns. With G = root(stiffness) J, and
/// with the solution d without these constraints, the forces root(stiffness) t follow from
///
///     (G A^-1 G' + 1) t = effort / root(stiffness) - G d,
///
/// solved by conjugate gradients. Each iteration takes one solution with the factor.
///
/// Unknowns of elements are solved for first, and again within each iteration for the others: with one iteration
/// for all, three beams of 40 that lie on each other took three times as long.
///
/// Constraints with bounds are about as stiff as the network, so they need no preconditioner. Elements do: springs
/// of a straight beam do not resist what its angles resist, so A is the mass matrix M there. Their preconditioner
/// is the band of G M^-1 G' + 1 in which each element is coupled to the two before it: a beam whose angles were
/// added in order.
#include <math.h>
#include <string.h>

#include "solvers/direct/direct.h"
#include "solvers/implicit/implicit.h"

/// Most iterations. For constraints with bounds, most_work ends them before. (With 64 at most, heaps of 30
/// fragments were not solved: friction changed in all passes, the step ran out of work, and they trembled.)
#define MOST_ITERATIONS 1000u
/// Product of residuals at which they end, as a share of the first one. That of elements is small because masses
/// alone give way 10^10 times as much as they do with elements.
#define LEAST_PRODUCT 1e-24
#define LEAST_PRODUCT_OF_OTHERS 1e-12

/// Most entries of a constraint in the preconditioner's band, where all of one are compared with all of another.
#define MOST_BAND_ENTRIES 4u

typedef mspringi_multiplier multiplier;

/* ---------------------------------------------------------------------------------------------- preconditioner */

static const mspringi_constraint *constraint_of(const mspringi_constraints *all, const multiplier *m) {
    return &all->list[m->constraint];
}

// Entry of G M^-1 G': response of one constraint to a unit force of another, if only masses resist.
static double mass_coupling(const mspring_network *network, const multiplier *one, const multiplier *other) {
    const mspringi_constraints *all = &network->constraints;
    const float *mass = mspringi_implicit_of(network)->mass;
    const mspringi_constraint *c = constraint_of(all, one), *o = constraint_of(all, other);
    const mspringi_jacobian_entry *a = all->entries + c->first, *b = all->entries + o->first;
    double sum = 0.0;
    for (uint32_t i = 0; i < c->count; ++i)
        for (uint32_t j = 0; j < o->count; ++j)
            if (a[i].slot == b[j].slot && mass[a[i].slot] > 0.0f)
                sum += (a[i].x * b[j].x + a[i].y * b[j].y) / (double)mass[a[i].slot];
    return one->root * other->root * sum;
}

static bool is_in_band(const mspring_network *network, const multiplier *m) {
    const mspringi_constraint *c = constraint_of(&network->constraints, m);
    return c->bounded == MSPRINGI_UNBOUNDED && c->count <= MOST_BAND_ENTRIES;
}

// Factor the band as L D L'. The whole matrix has no pivot below 1; the band alone may have, so clamp it.
static void factor(const mspring_network *network, multiplier *list, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i) {
        multiplier *m = &list[i];
        m->beside[0] = m->beside[1] = 0.0;
        m->pivot = 1.0;
        if (!is_in_band(network, m))
            continue;
        double pivot = 1.0 + mass_coupling(network, m, m);
        if (i > 1 && is_in_band(network, &list[i - 2])) {
            const double product = mass_coupling(network, m, &list[i - 2]);
            m->beside[1] = product / list[i - 2].pivot;
            pivot -= product * m->beside[1];
        }
        if (i > 0 && is_in_band(network, &list[i - 1])) {
            const double product = mass_coupling(network, m, &list[i - 1]) -
                                   (i > 1 ? m->beside[1] * list[i - 2].pivot * list[i - 1].beside[0] : 0.0);
            m->beside[0] = product / list[i - 1].pivot;
            pivot -= product * m->beside[0];
        }
        m->pivot = pivot > 1.0 ? pivot : 1.0;
    }
}

// Apply the preconditioner to the residuals. Return residual . solution.
static double precondition(multiplier *list, uint32_t count) {
    double sum = 0.0;
    for (uint32_t i = 0; i < count; ++i) {
        list[i].solution = list[i].residual;
        for (uint32_t k = 0; k < 2 && k < i; ++k)
            list[i].solution -= list[i].beside[k] * list[i - 1 - k].solution;
    }
    for (uint32_t i = count; i-- > 0;) {
        list[i].solution /= list[i].pivot;
        for (uint32_t k = 0; k < 2 && i + 1 + k < count; ++k)
            list[i].solution -= list[i + 1 + k].beside[k] * list[i + 1 + k].solution;
        sum += list[i].residual * list[i].solution;
    }
    return sum;
}

/* --------------------------------------------------------------------------------------------------- iteration */

/// Unknowns of an iteration: forces of elements, or forces of the others, which solve for elements within.
typedef struct unknowns {
    const struct unknowns *elements; ///< unknowns to solve for within; NULL: these are the elements
    multiplier *list, *end;
    mspringi_solve_fn solve;
    double *answer_x, *answer_y; ///< [slots + 1] response to the forces of the search
} unknowns;

static unknowns list_unknowns(const mspring_network *network, mspringi_solve_fn solve, const unknowns *elements) {
    const mspringi_constraints *all = &network->constraints;
    const size_t nodes = mspringi_slot_count(network) + 1;
    const uint32_t first = elements ? all->element_count : 0, last = elements ? all->count : all->element_count;
    multiplier *const list = all->multipliers ? all->multipliers + first : NULL, *end = list;
    double *const answer = mspringi_implicit_of(network)->direct.answer + (elements ? 2 * nodes : 0);
    for (uint32_t i = first; i < last; ++i)
        if (mspringi_constraint_is_unknown(&all->list[i]))
            *end++ = (multiplier){.constraint = i, .root = sqrt(all->list[i].stiffness)};
    factor(network, list, (uint32_t)(end - list));
    return (unknowns){elements, list, end, solve, answer, answer + nodes};
}

// G u. A closed constraint takes differences from its first entry.
static double gather(const mspringi_constraints *all, const multiplier *m, const double *x, const double *y) {
    const mspringi_constraint *c = constraint_of(all, m);
    const mspringi_jacobian_entry *e = all->entries + c->first, *end = e + c->count;
    const double from_x = c->is_closed ? x[e->slot] : 0.0, from_y = c->is_closed ? y[e->slot] : 0.0;
    double sum = 0.0;
    for (e += c->is_closed; e < end; ++e)
        sum += e->x * (x[e->slot] - from_x) + e->y * (y[e->slot] - from_y);
    return m->root * sum;
}

static void iterate(mspring_network *network, const unknowns *u, double *x, double *y, bool is_whole);

// Loose particles that touch others are not in the factor, which leaves their right-hand side as it is. Their
// blocks have mass, and the floor that they lie on.
static void solve_touched(const mspring_network *network, double *x, double *y) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_slots all = {0, mspringi_slot_count(network)};
    const mspringi_slots loose = mspringi_loose_slots(&network->topology, &all);
    for (size_t i = loose.first; n->has_touched && i < loose.end; ++i) {
        if (*mspringi_coupling_of(network, n, i) != MSPRINGI_COUPLED_BY_CONTACT)
            continue;
        const double xx = (double)n->system.xx[i], xy = (double)n->system.xy[i], yy = (double)n->system.yy[i];
        y[i] = (y[i] - xy / xx * x[i]) / (yy - xy / xx * xy);
        x[i] = (x[i] - xy * y[i]) / xx;
    }
}

// Find the response of particles and constraints to the forces of the search. Return search . answer.
static double answer_search(mspring_network *network, const unknowns *u) {
    const mspringi_constraints *all = &network->constraints;
    double *const x = u->answer_x, *const y = u->answer_y;
    double sum = 0.0;
    memset(x, 0, 2 * (mspringi_slot_count(network) + 1) * sizeof *x);
    for (const multiplier *m = u->list; m < u->end; ++m) {
        const mspringi_jacobian_entry *e = all->entries + constraint_of(all, m)->first;
        const mspringi_jacobian_entry *end = e + constraint_of(all, m)->count;
        for (; e < end; ++e) {
            x[e->slot] += m->search * m->root * e->x;
            y[e->slot] += m->search * m->root * e->y;
        }
    }
    u->solve(network, x, y);
    solve_touched(network, x, y);
    mspringi_implicit_of(network)->product_count++;
    if (u->elements)
        iterate(network, u->elements, x, y, false);
    for (multiplier *m = u->list; m < u->end; ++m) {
        m->answer = gather(all, m, x, y) + m->search;
        sum += m->search * m->answer;
    }
    return sum;
}

// Step along the search by alpha.
static void advance(const mspring_network *network, const unknowns *u, double *x, double *y, double alpha) {
    const size_t nodes = mspringi_slot_count(network) + 1;
    for (size_t i = 0; i < nodes; ++i) {
        x[i] += alpha * u->answer_x[i];
        y[i] += alpha * u->answer_y[i];
    }
    for (multiplier *m = u->list; m < u->end; ++m)
        m->residual -= alpha * m->answer;
}

// Begin with the forces of the last solution, from which an active set that has changed a little differs little.
// Return false if there are none. (A stack of five bars at rest ran out of work in 95 % of its steps without this,
// now in 12 %.)
static bool step_to_last_forces(mspring_network *network, const unknowns *u, double *x, double *y) {
    bool any = false;
    for (multiplier *m = u->list; m < u->end; ++m) {
        m->search = constraint_of(&network->constraints, m)->force / m->root;
        any |= m->search != 0.0;
    }
    if (!any)
        return false;
    (void)answer_search(network, u);
    advance(network, u, x, y, 1.0);
    return true;
}

// Find the unknown forces by conjugate gradients, and add their response to a solution (x, y). is_whole: it solves
// the system, so efforts act, too; else it is a response to other forces.
static void iterate(mspring_network *network, const unknowns *u, double *x, double *y, bool is_whole) {
    const mspringi_constraints *all = &network->constraints;
    const uint32_t count = (uint32_t)(u->end - u->list);
    if (count == 0)
        return;
    for (multiplier *m = u->list; m < u->end; ++m)
        m->residual = (is_whole ? constraint_of(all, m)->effort / m->root : 0.0) - gather(all, m, x, y);
    double product = precondition(u->list, count);
    const double least = (u->elements ? LEAST_PRODUCT_OF_OTHERS : LEAST_PRODUCT) * product;
    if (u->elements && is_whole && step_to_last_forces(network, u, x, y))
        product = precondition(u->list, count);
    for (multiplier *m = u->list; m < u->end; ++m)
        m->search = m->solution;
    for (uint32_t iteration = 0; iteration < MOST_ITERATIONS && product > least; ++iteration) {
        if (u->elements && !mspringi_implicit_may_repeat(mspringi_implicit_of(network)))
            break;
        const double alpha = product / answer_search(network, u);
        if (!(alpha > 0.0))
            break;
        advance(network, u, x, y, alpha);
        const double next = precondition(u->list, count), beta = next / product;
        for (multiplier *m = u->list; m < u->end; ++m)
            m->search = m->solution + beta * m->search;
        product = next;
    }
}

void mspringi_direct_solve_constraints(mspring_network *network, mspringi_solve_fn solve, double *x, double *y) {
    const unknowns elements = list_unknowns(network, solve, NULL);
    solve_touched(network, x, y);
    iterate(network, &elements, x, y, true);
    const unknowns others = list_unknowns(network, solve, &elements);
    iterate(network, &others, x, y, true);
}

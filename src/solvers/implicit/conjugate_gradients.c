/// Conjugate gradients with a two-level preconditioner:
///
///     z = D^-1 r + Z Ac^-1 Z^T r
///
/// D being the 2 x 2 blocks on A's diagonal, Ac = Z^T A Z, and the rows of Z for a particle of tile t, at (X, Y)
/// from its mass centre, [1 0 -Y; 0 1 X] in t's three columns. (Nicolaides 1987 has the additive coarse correction
/// by domains; rigid bodies as the coarse space of elasticity are Mandel's, 1993.)
///
/// Every sum has a fixed order, whatever the instruction set and however many workers there are. All workers run
/// the same code, compute the same scalars from the same sums, and end after the same iteration.
#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"

#include <float.h>
#include <math.h>
#include <string.h>

typedef mspringi_implicit_substep substep_of;

/// Relative product of residuals, r . z, that ends a solution whose iterations are counted. A last place squared is
/// 1e-14. Products far below are denormal, and their quotients are noise that grows with the iterations.
#define LEAST_PRODUCT 1e-30

/// Smallest usable product of residuals or of a direction. Below it single precision loses digits, so quotients are
/// noise or infinite. Masses are scaled to be near 1, so it moves nothing by more than 1e-19 m.
#define NO_PRODUCT ((double)FLT_MIN)

/// The same with constraints between bodies, and their factor on the iterations.
#define LEAST_PRODUCT_WITH_CONTACT 1e-9
#define TIMES_WITH_CONTACT 16

/// Factor on the iterations with the floor, and in halves.
#define TIMES_OF_MORE 2

/* ------------------------------------------------------------------------------------------------- coarse space */

static mspringi_coarse_parts coarse_parts(const mspring_network *network) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    return (mspringi_coarse_parts){&network->kernels->system, &n->iterate, n->factors, n->mass};
}

// Invert the blocks of D. Those of particles without springs and contact are set to 0: they are no unknowns here.
static void invert(const mspring_network *network, mspringi_slots slots) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_topology *t = &network->topology;
    const mspringi_slots loose = mspringi_loose_slots(t, &slots);
    const bool has_coupled = n->has_touched || t->irregular_count > t->laid_out_count;
    const size_t end = slots.end < loose.first || has_coupled ? slots.end : loose.first;
    float *const blocks[] = {n->system.xx, n->system.xy, n->system.yy};
    mspringi_slots run;
    for (size_t at = slots.first; mspringi_next_slots(network, (mspringi_slots){slots.first, end}, &at, &run);)
        network->kernels->system.invert(&n->system, run.first, run.end);
    for (size_t i = 0; i < 3 && end < slots.end; ++i)
        memset(blocks[i] + end, 0, (slots.end - end) * sizeof *blocks[i]);
    for (size_t slot = loose.first; has_coupled && slot < loose.end; ++slot)
        if (*mspringi_coupling_of(network, n, slot) == MSPRINGI_UNCOUPLED)
            blocks[0][slot] = blocks[1][slot] = blocks[2][slot] = 0.0f;
}

// True if a team member owns a cell. Cells without tiles have no owner.
static bool is_of(const mspring_network *network, const mspringi_team_member *member, uint32_t cell) {
    const uint32_t *first = &mspringi_implicit_of(network)->tiles.first_of_cell[cell];
    return first[0] < first[1] && mspringi_tile_is_of(network, member, (first[0] + first[1]) / 2);
}

static void assemble_coarse(const mspring_network *network, const mspringi_team_member *member) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_coarse_parts parts = coarse_parts(network);
    const uint32_t cells = n->tiles.cells.count;
    for (uint32_t cell = 0, end; n->age == 0 && cell < cells; cell = end + (end == cell)) {
        for (end = cell; end < cells && is_of(network, member, end);)
            ++end;
        if (end > cell)
            mspringi_coarse_assemble(&n->coarse, &n->tiles, &parts, cell, end);
    }
}

static void factor_coarse(const mspring_network *network) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_coarse_parts parts = coarse_parts(network);
    if (n->age > 0)
        return;
    mspringi_coarse_complete(&n->coarse, &n->tiles, &parts);
    mspringi_constraints_stiffen(network);
    mspringi_condense_stiffen(network);
    mspringi_coarse_factor(&n->coarse);
}

/* --------------------------------------------------------------------------------------------------- iteration */

static double (*unknowns_of(const mspringi_implicit *n, const mspringi_team_member *member))[MSPRINGI_RIGID] {
    return n->unknowns + (size_t)member->index * n->tiles.capacity;
}

// Apply Ac^-1 to Z^T r. Each team member computes its own copy of the coarse unknowns, which is faster than waiting
// for another. Return r . Z Ac^-1 Z^T r.
static double correct(const substep_of *substep, mspringi_team_member *member, bool is_first) {
    const mspring_network *network = substep->network;
    mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_tiles *tiles = &n->tiles;
    if (is_first && member->index == 0)
        factor_coarse(network);
    for (size_t t = 0; t < tiles->count; ++t)
        if (mspringi_tile_is_of(network, member, t))
            network->kernels->system.restrict_to_tile(&n->iterate, tiles->parts + tiles->first_part[t],
                                                      tiles->first_part[t + 1] - tiles->first_part[t],
                                                      n->coarse.restricted[t]);
    mspringi_team_barrier(member);
    return mspringi_coarse_solve(&n->coarse, unknowns_of(n, member));
}

// Loose particles that touch others are in no tile: share z + beta direction.
static void turn_touched(const mspring_network *network, mspringi_slots slots, float share, float beta) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_slots loose = mspringi_loose_slots(&network->topology, &slots);
    for (size_t i = loose.first; i < loose.end; ++i) {
        if (*mspringi_coupling_of(network, n, i) != MSPRINGI_COUPLED_BY_CONTACT)
            continue;
        n->direction.x[i] = share * n->scaled.x[i] + (beta != 0.0f ? beta * n->direction.x[i] : 0.0f);
        n->direction.y[i] = share * n->scaled.y[i] + (beta != 0.0f ? beta * n->direction.y[i] : 0.0f);
    }
}

// Update the search direction: z + beta direction, or a part of it at the beginning.
static void turn(const substep_of *substep, mspringi_team_member *member, mspringi_search_update what, float beta) {
    const mspring_network *network = substep->network;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_slots slots = mspringi_slots_of(network, member);
    const mspringi_part_range parts = mspringi_tiles_parts(&n->tiles, slots.first, slots.end);
    network->kernels->system.update_search[what](&n->iterate, parts.parts, parts.count,
                                                 (const double(*)[MSPRINGI_RIGID])unknowns_of(n, member), beta);
    if (n->has_touched)
        turn_touched(network, slots, what == MSPRINGI_SEARCH_COARSE_ONLY ? 0.0f : 1.0f, beta);
    mspringi_team_barrier(member);
}

// Step along the direction by alpha. Return r . D^-1 r.
static double advance(const substep_of *substep, mspringi_team_member *member, float alpha, bool is_first) {
    const mspring_network *network = substep->network;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_slots slots = mspringi_slots_of(network, member);
    const size_t chunks = (n->used_slot_end + MSPRINGI_CHUNK - 1) / MSPRINGI_CHUNK;
    const size_t first_chunk = slots.first / MSPRINGI_CHUNK;
    const size_t end_chunk = (slots.end + MSPRINGI_CHUNK - 1) / MSPRINGI_CHUNK;
    if (network->sleep.sleeping > 0)
        memset(n->sums + first_chunk, 0, (end_chunk - first_chunk) * sizeof *n->sums);
    mspringi_slots run;
    for (size_t at = slots.first; mspringi_next_slots(network, slots, &at, &run);)
        network->kernels->system.advance(&n->system, &n->iterate, alpha, is_first, run.first, run.end, n->sums);
    mspringi_team_barrier(member);
    double sum = 0.0;
    for (size_t i = 0; i < chunks; ++i)
        sum += (double)n->sums[i];
    return sum;
}

// First iteration: the coarse space alone. It removes the fast changes of a heavy or a spinning part, so that later
// iterations leave less unbalanced force. (80x5 with a tip of 1000 times the mass: no gain of energy, instead of
// 0.1 %.)
static double solve_tiles(const substep_of *substep, mspringi_team_member *member) {
    const double product = correct(substep, member, true);
    turn(substep, member, MSPRINGI_SEARCH_COARSE_ONLY, 0.0f);
    const double curvature = mspringi_multiply(substep, member);
    const bool is_sound =
        product >= NO_PRODUCT && product < INFINITY && curvature >= NO_PRODUCT && curvature < INFINITY;
    return advance(substep, member, is_sound ? (float)(product / curvature) : 0.0f, true);
}

// d = 0.
static double begin_anew(const substep_of *substep, mspringi_team_member *member) {
    const mspringi_implicit *n = mspringi_implicit_of(substep->network);
    const mspringi_slots slots = mspringi_slots_of(substep->network, member);
    const mspringi_field fields[] = {n->direction, n->product};
    for (size_t i = 0; i < 2; ++i) {
        memset(fields[i].x + slots.first, 0, (slots.end - slots.first) * sizeof *fields[i].x);
        memset(fields[i].y + slots.first, 0, (slots.end - slots.first) * sizeof *fields[i].y);
    }
    return advance(substep, member, 0.0f, true);
}

// d = the last solution, which an active set that has changed a little changes little. (Heaps of 30 fragments took
// 23 calm steps a step without, then 16. Heaps of 100 ran out of work in 32 % of their steps, then in 17 %.)
static double begin_with_last(const substep_of *substep, mspringi_team_member *member, float alpha) {
    const mspring_network *network = substep->network;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_slots slots = mspringi_slots_of(network, member);
    mspringi_slots run;
    for (size_t at = slots.first; mspringi_next_slots(network, slots, &at, &run);)
        for (size_t i = run.first; i < run.end; ++i) {
            const bool is_unknown = n->mass[i] > 0.0f; // not pinned, nor condensed
            n->direction.x[i] = is_unknown ? n->displacement.x[i] + alpha * n->direction.x[i] : 0.0f;
            n->direction.y[i] = is_unknown ? n->displacement.y[i] + alpha * n->direction.y[i] : 0.0f;
        }
    mspringi_team_barrier(member);
    (void)mspringi_multiply(substep, member);
    return advance(substep, member, 1.0f, true);
}

// Share of the first r . z that ends a solution. Where more iterations are needed, it is squared: errors shrink by
// a factor in each, so that takes twice as many.
static double least_share(const mspringi_implicit *n, uint32_t times) {
    const double residual = (double)n->residual_share;
    if (times == TIMES_WITH_CONTACT)
        return LEAST_PRODUCT_WITH_CONTACT;
    if (residual == 0.0)
        return LEAST_PRODUCT;
    return fmax(times == TIMES_OF_MORE ? residual * residual : residual, LEAST_PRODUCT);
}

// True if the iteration has converged, or is at the limit of this precision. Not a NaN.
static bool is_small(double product, double least) {
    return product < NO_PRODUCT || product <= least;
}

// The same for a system without paths. It ends by a share of the r . z that it begins with, or has after an
// iteration: the loads of paths on their ends, often most of the first r . z, are balanced by then. (By the first
// alone 7 of 120 random scenes with ropes had more than twice the error that they had without condensation, now 3.
// The median fell from 0.20 to 0.064 % of the motion, for 1.14 times the products.)
static float solve_without_paths(const substep_of *substep, mspringi_team_member *member, mspringi_solution *last) {
    const mspring_network *network = substep->network;
    mspringi_implicit *n = mspringi_implicit_of(network);
    // Contacts are far stiffer than springs: with the usual iterations a bar on the floor trembles at 0.01 m/s.
    // Halves of a substep need more, too, because iterations that ended early may have caused the halving.
    const bool has_contacts = mspringi_next_floor_push(&network->constraints, NULL) != NULL;
    // The coarse matrix may lack entries for the tiles of bodies that touch. What no longer touches was pushed in
    // the last solution, which this one goes on from: its first product is large, and a share of it no bound.
    last->has_contact |= mspringi_contact_constraint_is_active(&network->constraints);
    const uint32_t times = last->has_contact ? TIMES_WITH_CONTACT : has_contacts || n->is_half ? TIMES_OF_MORE : 1;
    uint32_t left = mspringi_implicit_most_iterations(n, times);
    invert(network, mspringi_slots_of(network, member));
    assemble_coarse(network, member);
    mspringi_team_barrier(member);
    const bool goes_on = last->product > 0.0 && last->alpha - last->alpha == 0.0f;
    const bool tiles_first = left > 1 && !goes_on;
    double product = goes_on       ? begin_with_last(substep, member, last->alpha)
                     : tiles_first ? solve_tiles(substep, member)
                                   : begin_anew(substep, member);
    left -= tiles_first;
    product += correct(substep, member, !tiles_first);
    const double share = least_share(n, times);
    last->product = product > last->product ? product : last->product;
    double least = share * last->product;
    bool is_loaded = n->paths.count > 0;
    turn(substep, member, MSPRINGI_SEARCH_RESTART, 0.0f);
    for (;;) {
        const double curvature = mspringi_multiply(substep, member);
        if (member->index == 0)
            n->product_count++;
        if (!(curvature < INFINITY && product < INFINITY))
            return NAN;
        if (curvature < NO_PRODUCT || is_small(product, least))
            return 0.0f;
        const float alpha = (float)(product / curvature);
        if (--left == 0)
            return alpha;
        double next = advance(substep, member, alpha, false);
        next += correct(substep, member, false);
        if (is_loaded)
            least = fmin(least, share * next);
        is_loaded = false;
        if (is_small(next, least))
            return 0.0f;
        turn(substep, member, MSPRINGI_SEARCH_CONTINUE, (float)(next / product));
        product = next;
    }
}

void mspringi_solve(const substep_of *substep, mspringi_team_member *member, mspringi_solution *last) {
    mspringi_condense(substep->network, member);
    last->alpha = solve_without_paths(substep, member, last);
    mspringi_condense_finish(substep->network, member, last->alpha);
    if (mspringi_implicit_of(substep->network)->paths.count > 0)
        mspringi_team_barrier(member);
}

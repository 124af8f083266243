/// Assembly of the linear system, and its product with a vector: panels of rows by kernels, irregular springs one
/// by one.
#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"

#include <math.h>
#include <string.h>

#include "kernels/spring_law.h"
#include "store/elements.h"
#include "store/sleepers.h"
#include "store/springs.h"

/* ----------------------------------------------------------------------------------------------- matrix rows */

/// A worker's share of the panels, with carry rows of its own.
typedef struct panel_share {
    mspringi_system system;
    const mspringi_panel *begin, *end;
} panel_share;

static panel_share share_panels(const mspring_network *network, const mspringi_team_member *member) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const size_t carry = (size_t)network->topology.carry_blocks * MSPRINGI_WIDTH;
    panel_share share = {.system = n->system,
                         .begin = n->panels.list + mspringi_range_begin(member, n->panels.count),
                         .end = n->panels.list + mspringi_range_end(member, n->panels.count)};
    share.system.force_carry_x = n->force_carry + 2 * member->index * carry;
    share.system.force_carry_y = share.system.force_carry_x + carry;
    share.system.carry_xx = n->carry + 3 * member->index * carry;
    share.system.carry_xy = share.system.carry_xx + carry;
    share.system.carry_yy = share.system.carry_xy + carry;
    return share;
}

bool mspringi_panel_is_asleep(const mspring_network *network, const mspringi_panel *panel) {
    const mspringi_topology *t = &network->topology;
    if (network->sleep.sleeping == 0 || mspringi_implicit_of(network)->is_direct)
        return false;
    for (uint32_t i = panel->first_span; i < panel->first_span + panel->span_count; ++i)
        if (mspringi_is_any_swept(network, t->spans[i].first_slot / MSPRINGI_WIDTH,
                                  (t->spans[i].end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH))
            return false;
    return true;
}

// True if another worker's row carries into the first panel of a share.
static bool is_handed_on(const mspring_network *network, const panel_share *share) {
    return share->begin < share->end && share->begin->below_count > 0 &&
           !mspringi_panel_is_asleep(network, share->begin);
}

// Carry rows are 0 where grids end. Where a share ends inside of one, or what follows on a panel is left out, they
// are not.
static void clear_carry(const mspring_network *network, const panel_share *share, const mspringi_panel *next,
                        bool forces) {
    const size_t carry = (size_t)network->topology.carry_blocks * MSPRINGI_WIDTH;
    const mspringi_panels *panels = &mspringi_implicit_of(network)->panels;
    if (next == panels->list + panels->count || next->below_count == 0 ||
        (next < share->end && !mspringi_panel_is_asleep(network, next)))
        return;
    if (forces)
        memset(share->system.force_carry_x, 0, 2 * carry * sizeof *share->system.force_carry_x);
    memset(share->system.carry_xx, 0, (forces ? 3 : 2) * carry * sizeof *share->system.carry_xx);
}

static void assemble_panels(const mspring_network *network, const mspringi_team_member *member) {
    const mspringi_topology *t = &network->topology;
    const mspringi_system_kernels *kernels = &network->kernels->system;
    const bool damped = network->parts > MSPRINGI_DAMPING;
    const panel_share share = share_panels(network, member);
    if (is_handed_on(network, &share))
        kernels->carry_forces[damped](&share.system, t->spans + share.begin->below_first, share.begin->below_count);
    for (const mspringi_panel *panel = share.begin; panel < share.end; ++panel) {
        if (mspringi_panel_is_asleep(network, panel))
            continue;
        const mspringi_assemble_fn assemble =
            panel->is_lattice ? kernels->assemble_lattice[damped] : kernels->assemble_chain[damped];
        assemble(&share.system, t->spans + panel->first_span, panel->span_count);
        clear_carry(network, &share, panel + 1, true);
    }
}

static void multiply_panels(const mspring_network *network, const mspringi_team_member *member) {
    const mspringi_topology *t = &network->topology;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_system_kernels *kernels = &network->kernels->system;
    const mspringi_field from = n->direction, to = n->product;
    const panel_share share = share_panels(network, member);
    if (is_handed_on(network, &share))
        kernels->carry_product(&share.system, t->spans + share.begin->below_first, share.begin->below_count, from.x,
                               from.y);
    for (const mspringi_panel *panel = share.begin; panel < share.end; ++panel) {
        n->panels.sums[panel - n->panels.list] = 0.0f;
        if (mspringi_panel_is_asleep(network, panel))
            continue;
        const mspringi_multiply_fn multiply =
            panel->is_lattice ? kernels->multiply_lattice : kernels->multiply_chain;
        n->panels.sums[panel - n->panels.list] =
            multiply(&share.system, t->spans + panel->first_span, panel->span_count, from.x, from.y, to.x, to.y);
        clear_carry(network, &share, panel + 1, false);
    }
}

/* ------------------------------------------------------------------------------------------ irregular springs */

/// Force and factors of an irregular spring on its base.
typedef struct irregular_spring {
    double force_x, force_y;
    float pull_x, pull_y, geometric;
} irregular_spring;

// As in kernels/system_assemble.h, in double precision throughout.
static irregular_spring compute_irregular(const mspringi_system *s, uint32_t base, uint32_t tip,
                                          const mspringi_spring_values *values) {
    const double dx = s->x[tip] - s->x[base], dy = s->y[tip] - s->y[base];
    const double length = sqrt(dx * dx + dy * dy), inverse = length > 0.0 ? 1.0 / length : 0.0;
    const double nx = dx * inverse, ny = dy * inverse;
    const double extension = length - (double)values->rest_length;
    const double stiffness = s->force_scale * (double)values->stiffness;
    const double damping = s->force_scale * (double)values->damping;
    // A weld of no length is as stiff in all directions.
    const double relative = length > 0.0 || values->rest_length != MSPRINGI_WELD ? extension * inverse : 1.0;
    const double tensed = mspringi_geometric_fraction(relative);
    const double dvx = (double)s->vx[tip] - (double)s->vx[base], dvy = (double)s->vy[tip] - (double)s->vy[base];
    const double force = MSPRINGI_LAW_FORCE(MSPRINGI_TIMES, stiffness, extension) +
                         MSPRINGI_LAW_DAMPING_FORCE(MSPRINGI_TIMES, damping, dvx * nx + dvy * ny);
    const double own = MSPRINGI_LAW_ALONG(stiffness), geometric = own * tensed;
    const double along = (own - geometric) + MSPRINGI_LAW_DAMPING_ALONG(damping) * s->damping_rate;
    const float root = sqrtf((float)along);
    return (irregular_spring){force * nx, force * ny, root * (float)nx, root * (float)ny, (float)geometric};
}

static void add_to_diagonal(const mspringi_system *s, uint32_t slot, const irregular_spring *spring) {
    s->xx[slot] += spring->geometric + spring->pull_x * spring->pull_x;
    s->xy[slot] += spring->pull_x * spring->pull_y;
    s->yy[slot] += spring->geometric + spring->pull_y * spring->pull_y;
}

static float *irregular_factors(const mspringi_implicit *n, uint32_t i) {
    return n->irregular_factors + (size_t)(i / MSPRINGI_WIDTH) * MSPRINGI_FACTORS * MSPRINGI_WIDTH +
           i % MSPRINGI_WIDTH;
}

// True if both ends of an irregular spring sleep.
static bool sleeps(const mspring_network *network, uint32_t i) {
    const mspringi_topology *t = &network->topology;
    return mspringi_slot_is_asleep(network, t->irregular_a[i]) &&
           mspringi_slot_is_asleep(network, t->irregular_b[i]);
}

// A team member adds to its own slots. It computes springs to those of others, too.
static void assemble_irregular(const mspring_network *network, mspringi_slots own) {
    const mspringi_topology *t = &network->topology;
    const mspringi_system *s = &mspringi_implicit_of(network)->system;
    for (uint32_t i = 0; i < t->irregular_count; ++i) {
        const uint32_t base = t->irregular_a[i], tip = t->irregular_b[i];
        const bool has_base = mspringi_slots_have(own, base), has_tip = mspringi_slots_have(own, tip);
        if ((!has_base && !has_tip) || sleeps(network, i))
            continue;
        const mspringi_spring_values values = mspringi_spring_slot_get(network, t->row_spring_slots + i);
        const irregular_spring l = compute_irregular(s, base, tip, &values);
        if (has_base) {
            float *factors = irregular_factors(mspringi_implicit_of(network), i);
            factors[MSPRINGI_PULL_X * MSPRINGI_WIDTH] = l.pull_x;
            factors[MSPRINGI_PULL_Y * MSPRINGI_WIDTH] = l.pull_y;
            factors[MSPRINGI_GEOMETRIC * MSPRINGI_WIDTH] = l.geometric;
            s->force_x[base] += (float)l.force_x;
            s->force_y[base] += (float)l.force_y;
            add_to_diagonal(s, base, &l);
        }
        if (has_tip) {
            s->force_x[tip] -= (float)l.force_x;
            s->force_y[tip] -= (float)l.force_y;
            add_to_diagonal(s, tip, &l);
        }
    }
}

static void multiply_masses(const mspringi_implicit *n, const mspringi_product *p, size_t first, size_t end) {
    end = end < p->own.end ? end : p->own.end;
    for (size_t i = first > p->own.first ? first : p->own.first; i < end; ++i) {
        p->to.x[i] = n->mass[i] * p->from.x[i];
        p->to.y[i] = n->mass[i] * p->from.y[i];
        p->sums[i / MSPRINGI_CHUNK] += (double)(p->from.x[i] * p->to.x[i] + p->from.y[i] * p->to.y[i]);
    }
}

// Multiply the irregular part's own particles by their masses, and add the irregular springs.
static void multiply_irregular(const mspring_network *network, const mspringi_product *p) {
    const mspringi_topology *t = &network->topology;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const size_t irregular = (size_t)t->irregular_first * MSPRINGI_WIDTH;
    // Loose particles that no spring has been added to and that touch nothing are not in the iteration.
    const size_t added = (size_t)t->loose_first * MSPRINGI_WIDTH;
    multiply_masses(n, p, irregular, irregular + (size_t)t->irregular_blocks * MSPRINGI_WIDTH);
    if (t->irregular_count > t->laid_out_count || n->has_touched)
        multiply_masses(n, p, added, (size_t)(t->block_count - 1) * MSPRINGI_WIDTH);
    for (uint32_t i = 0; i < t->irregular_count; ++i) {
        const uint32_t a = t->irregular_a[i], b = t->irregular_b[i];
        if ((!mspringi_product_has(p, a) && !mspringi_product_has(p, b)) || sleeps(network, i))
            continue;
        const float *factors = irregular_factors(n, i);
        const float pull_x = factors[MSPRINGI_PULL_X * MSPRINGI_WIDTH];
        const float pull_y = factors[MSPRINGI_PULL_Y * MSPRINGI_WIDTH];
        const float geometric = factors[MSPRINGI_GEOMETRIC * MSPRINGI_WIDTH];
        const float dx = p->from.x[b] - p->from.x[a], dy = p->from.y[b] - p->from.y[a];
        const float along = pull_x * dx + pull_y * dy;
        const float x = geometric * dx + pull_x * along, y = geometric * dy + pull_y * along;
        mspringi_product_add(p, a, -x, -y);
        mspringi_product_add(p, b, x, y);
        mspringi_product_count(p, a, (double)(dx * x + dy * y));
    }
}

/* --------------------------------------------------------------------------------------------------- the whole */

// Clear the slots outside lattice and chain rows. Rows write their own.
static void clear_others(const mspring_network *network, mspringi_slots slots) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const size_t swept = (size_t)network->topology.irregular_first * MSPRINGI_WIDTH;
    const size_t first = slots.first > swept ? slots.first : swept;
    float *const arrays[] = {n->residual.x, n->residual.y, n->system.xx, n->system.xy, n->system.yy};
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0] && first < slots.end; ++i)
        memset(arrays[i] + first, 0, (slots.end - first) * sizeof *arrays[i]);
}

void mspringi_assemble(const mspringi_implicit_substep *substep, mspringi_team_member *member) {
    const mspring_network *network = substep->network;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_slots slots = mspringi_slots_of(network, member);
    mspringi_slots run;
    mspringi_team_barrier(member);
    assemble_panels(network, member);
    clear_others(network, slots);
    mspringi_team_barrier(member);
    if (network->topology.irregular_count > 0) {
        assemble_irregular(network, mspringi_all_slots_of(network, member));
        mspringi_team_barrier(member);
    }
    if (mspringi_elements_have_terms(network)) {
        if (member->index == 0) {
            mspringi_elements_assemble(network);
            mspringi_elements_list_and_assemble(substep->network);
        }
        mspringi_team_barrier(member);
    }
    for (size_t at = slots.first; mspringi_next_slots(network, slots, &at, &run);) {
        network->kernels->system.add_outside(&substep->outside[0], n->residual.x, run.first, run.end);
        network->kernels->system.add_outside(&substep->outside[1], n->residual.y, run.first, run.end);
    }
}

// Multiply by what the panels do not have.
static void multiply_others(const mspring_network *network, const mspringi_team_member *member) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_slots own = mspringi_all_slots_of(network, member);
    const mspringi_product product = {n->direction, n->product, own, n->other_sums};
    for (size_t slot = own.first; slot < own.end; slot += MSPRINGI_CHUNK)
        n->other_sums[slot / MSPRINGI_CHUNK] = 0.0;
    multiply_irregular(network, &product);
    mspringi_constraints_multiply(&network->constraints, &product);
    mspringi_condense_multiply(network, &product);
}

double mspringi_multiply(const mspringi_implicit_substep *substep, mspringi_team_member *member) {
    const mspring_network *network = substep->network;
    mspringi_implicit *n = mspringi_implicit_of(network);
    multiply_panels(network, member);
    mspringi_team_barrier(member);
    const bool has_others = network->topology.irregular_blocks > 0 || network->topology.irregular_count > 0 ||
                            network->constraints.active_count > 0 || n->paths.count > 0 || n->has_touched;
    double sum = 0.0;
    if (has_others) {
        multiply_others(network, member);
        mspringi_team_barrier(member);
        for (size_t chunk = 0; chunk < mspringi_slot_count(network) / MSPRINGI_CHUNK + 1; ++chunk)
            sum += n->other_sums[chunk];
    }
    for (uint32_t p = 0; p < n->panels.count; ++p)
        sum += (double)n->panels.sums[p];
    return sum;
}

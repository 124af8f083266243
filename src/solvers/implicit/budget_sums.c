/// Sums of the energy budget over components, before and after a substep: particles and springs in blocks by
/// workers; outside forces, moving pins and the floor.
#include "solvers/implicit/energy_budget.h"

#include <math.h>
#include <string.h>

#include "features/contact/floor.h"
#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"
#include "store/elements.h"
#include "store/sleepers.h"
#include "store/springs.h"

typedef mspringi_budget budget_of;
typedef mspringi_component_budget component;
typedef mspringi_budget_sums measuring;

static double x_at(const mspringi_motion *m, size_t slot) {
    return (double)m->x[slot] + (double)m->low_x[slot];
}

static double y_at(const mspringi_motion *m, size_t slot) {
    return (double)m->y[slot] + (double)m->low_y[slot];
}

static double vx_at(const mspringi_motion *m, size_t slot) {
    return (double)m->vx[slot] + (m->low_vx ? (double)m->low_vx[slot] : 0.0);
}

static double vy_at(const mspringi_motion *m, size_t slot) {
    return (double)m->vy[slot] + (m->low_vy ? (double)m->low_vy[slot] : 0.0);
}

/* ----------------------------------------------------------------------------------------------------- by block */

static void add_effect(const measuring *all, const component *a, size_t slot, double *to) {
    const mspring_network *network = all->network;
    const budget_of *budget = &mspringi_implicit_of(network)->budget;
    const mspringi_floor *floor = network->floor;
    if (!(network->inverse_mass[slot] > 0.0f))
        return;
    if (floor &&
        (floor->impulse.x[slot] != budget->impulse.x[slot] || floor->impulse.y[slot] != budget->impulse.y[slot]))
        to[MSPRINGI_EFFECT_TOUCH] += 1.0;
    if (!all->base.x)
        return;
    const double fx = (double)all->base.x[slot], fy = (double)all->base.y[slot];
    const double x = x_at(&all->motion, slot), y = y_at(&all->motion, slot);
    const double from_x = x_at(&all->before, slot), from_y = y_at(&all->before, slot);
    const double rx = 0.5 * (x + from_x) - a->origin[0], ry = 0.5 * (y + from_y) - a->origin[1];
    to[MSPRINGI_EFFECT_X] += fx;
    to[MSPRINGI_EFFECT_Y] += fy;
    to[MSPRINGI_EFFECT_TORQUE] += rx * fy - ry * fx;
    to[MSPRINGI_EFFECT_WORK] += fx * (x - from_x) + fy * (y - from_y);
}

// Blocks first to end - 1, all of one component.
static void measure_run(const measuring *all, size_t first, size_t end) {
    const mspring_network *network = all->network;
    budget_of *budget = &mspringi_implicit_of(network)->budget;
    const component *a = &budget->components[budget->of_block[first]];
    double *to = budget->runs[first];
    memset(to, 0, sizeof budget->runs[first]);
    if (a->is_asleep)
        return;
    network->kernels->system.moments(&all->motion, first * MSPRINGI_WIDTH, end * MSPRINGI_WIDTH, a->origin, to);
    for (size_t slot = first * MSPRINGI_WIDTH;
         all->is_after && (network->floor || all->base.x) && slot < end * MSPRINGI_WIDTH; ++slot)
        add_effect(all, a, slot, to);
}

// The next blocks of one component from *first on, below end. Returns false if there are none.
static bool next_run(const budget_of *budget, size_t *first, size_t end, size_t *run_end) {
    const size_t run_blocks = MSPRINGI_CHUNK / MSPRINGI_WIDTH;
    while (*first < end && budget->of_block[*first] >= MSPRINGI_SEVERAL_COMPONENTS)
        ++*first;
    const size_t most = (*first / run_blocks + 1) * run_blocks;
    size_t block = *first;
    while (block < end && block < most && budget->of_block[block] == budget->of_block[*first])
        ++block;
    *run_end = block;
    return *first < end;
}

static void keep_slots(const mspring_network *network, size_t first, size_t end) {
    const budget_of *budget = &mspringi_implicit_of(network)->budget;
    const size_t slots = mspringi_slot_count(network), size = (end - first) * sizeof *budget->state;
    for (size_t i = 0; i < mspringi_state_arrays(network); ++i) {
        const size_t at = i * slots + first;
        if (!budget->is_in_backup)
            memcpy(budget->state + at, network->state.x + at, size);
        else
            MSPRINGI_ASSERT(end > mspringi_used_slots(network) ||
                            memcmp(network->backup.x + at, network->state.x + at, size) == 0);
    }
    if (!network->floor)
        return;
    memcpy(budget->impulse.x + first, network->floor->impulse.x + first, size);
    memcpy(budget->impulse.y + first, network->floor->impulse.y + first, size);
}

// A worker's part.
static void measure_fraction(void *argument, uint32_t index, uint32_t worker) {
    const measuring *all = argument;
    mspring_network *network = all->network;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_team_member member = {.index = index, .count = all->workers};
    const mspringi_slots slots = mspringi_slots_of(network, &member);
    (void)worker;
    if (!all->is_after)
        keep_slots(network, slots.first, slots.end);
    const size_t end = slots.end / MSPRINGI_WIDTH;
    size_t run_end;
    for (size_t block = slots.first / MSPRINGI_WIDTH; next_run(&n->budget, &block, end, &run_end); block = run_end)
        measure_run(all, block, run_end);
    for (size_t i = mspringi_range_begin(&member, n->panels.count);
         !all->knows_elastic && i < mspringi_range_end(&member, n->panels.count); ++i) {
        const mspringi_panel *panel = &n->panels.list[i];
        if (!mspringi_panel_is_asleep(network, panel))
            network->kernels->system.elastic(&n->system, &all->motion, network->topology.spans + panel->first_span,
                                             panel->span_count, panel->is_lattice, n->budget.elastic);
    }
}

/* ------------------------------------------------------------------------------------------------- by component */

static void add_particles(const measuring *all) {
    mspring_network *network = all->network;
    budget_of *budget = &mspringi_implicit_of(network)->budget;
    const mspringi_motion *m = &all->motion;
    const size_t blocks = network->topology.block_count, sums = all->is_after ? MSPRINGI_EFFECTS : MSPRINGI_MOMENTS;
    size_t end;
    for (size_t block = 0; next_run(budget, &block, blocks, &end); block = end)
        for (size_t i = 0; i < sums; ++i)
            budget->components[budget->of_block[block]].sums[i] += budget->runs[block][i];
    for (size_t block = 0; block < blocks; ++block) {
        if (budget->of_block[block] != MSPRINGI_SEVERAL_COMPONENTS)
            continue;
        for (size_t slot = block * MSPRINGI_WIDTH; slot < (block + 1) * MSPRINGI_WIDTH; ++slot) {
            if (budget->of_slot[slot] == MSPRINGI_NO_COMPONENT || !(network->inverse_mass[slot] > 0.0f))
                continue;
            component *a = &budget->components[budget->of_slot[slot]];
            const double mass = (double)(1.0f / network->inverse_mass[slot]);
            const double x = x_at(m, slot) - a->origin[0], y = y_at(m, slot) - a->origin[1];
            const double vx = vx_at(m, slot) - a->origin[2], vy = vy_at(m, slot) - a->origin[3];
            const double moments[] = {mass,
                                      mass * x,
                                      mass * y,
                                      mass * vx,
                                      mass * vy,
                                      mass * (x * x + y * y),
                                      mass * (x * vy - y * vx),
                                      mass * (vx * vx + vy * vy)};
            for (size_t i = 0; i < MSPRINGI_MOMENTS; ++i)
                a->sums[i] += moments[i];
            if (all->is_after)
                add_effect(all, a, slot, a->sums);
        }
    }
}

// A spring of which it is not known in what component it is.
static void add_spring(const measuring *all, mspringi_spring_slot spring_slot) {
    const mspring_network *network = all->network;
    budget_of *budget = &mspringi_implicit_of(network)->budget;
    const mspringi_motion *m = &all->motion;
    const mspringi_spring_values s = mspringi_spring_slot_get(network, spring_slot);
    const double x = x_at(m, s.tip) - x_at(m, s.base), y = y_at(m, s.tip) - y_at(m, s.base),
                 k = (double)s.stiffness;
    const double extension = sqrt(x * x + y * y) - (double)s.rest_length;
    component *a = &budget->components[budget->of_slot[s.base]];
    a->elastic += 0.5 * k * (extension * extension);
    a->length += k * (x * x + y * y);
}

static bool is_live(const mspring_network *network, mspringi_spring_slot spring_slot) {
    return network->live[spring_slot / MSPRINGI_WIDTH] >> spring_slot % MSPRINGI_WIDTH & 1;
}

static void add_springs(const measuring *all) {
    const mspring_network *network = all->network;
    const mspringi_topology *t = &network->topology;
    budget_of *budget = &mspringi_implicit_of(network)->budget;
    size_t word, words;
    for (size_t block = 0; block < t->block_count; ++block) {
        const uint32_t number = budget->of_springs[block];
        if (number == MSPRINGI_NO_COMPONENT || !mspringi_words_of_block(t, block, &word, &words))
            continue;
        if (number != MSPRINGI_SEVERAL_COMPONENTS) {
            budget->components[number].elastic += budget->elastic[block].energy;
            budget->components[number].length += budget->elastic[block].length;
            continue;
        }
        for (size_t spring_slot = word * MSPRINGI_WIDTH; spring_slot < (word + words) * MSPRINGI_WIDTH;
             ++spring_slot)
            if (is_live(network, (mspringi_spring_slot)spring_slot))
                add_spring(all, (mspringi_spring_slot)spring_slot);
    }
    for (mspringi_spring_slot spring_slot = t->row_spring_slots; spring_slot < mspringi_swept_end(t); ++spring_slot)
        if (is_live(network, spring_slot))
            add_spring(all, spring_slot);
}

// The impulse of an active contact may be too small for single precision.
static void add_contacts(const mspring_network *network) {
    budget_of *budget = &mspringi_implicit_of(network)->budget;
    const mspringi_constraints *all = &network->constraints;
    for (const mspringi_constraint *c = NULL; (c = mspringi_next_floor_push(all, c)) != NULL;) {
        const uint32_t number = budget->of_slot[all->entries[c->first].slot];
        if (mspringi_constraint_is_active(c) && number != MSPRINGI_NO_COMPONENT)
            budget->components[number].sums[MSPRINGI_EFFECT_TOUCH] += 1.0;
    }
}

void mspringi_budget_add_forces(const measuring *all) {
    budget_of *budget = &mspringi_implicit_of(all->network)->budget;
    for (size_t slot = 0; all->base.x && slot < mspringi_used_slots(all->network); ++slot)
        if (budget->of_slot[slot] != MSPRINGI_NO_COMPONENT)
            add_effect(all, &budget->components[budget->of_slot[slot]], slot,
                       budget->components[budget->of_slot[slot]].sums);
}

void mspringi_budget_measure(measuring *all) {
    mspring_network *network = all->network;
    mspringi_implicit *n = mspringi_implicit_of(network);
    const bool shared = mspringi_slot_count(network) >= MSPRINGI_SMALLEST_SHARED_SLOTS && n->solo_substeps == 0;
    all->workers = shared ? mspringi_tasks_concurrency(network->tasks) : 1;
    mspringi_tasks_run(all->workers > 1 ? network->tasks : NULL, all->workers, measure_fraction, all);
    for (component *a = n->budget.components; a < n->budget.components + n->budget.count; ++a) {
        memset(a->sums, 0, sizeof a->sums);
        a->elastic = all->knows_elastic ? a->elastic : 0.0;
        a->length = all->knows_elastic ? a->length : 0.0;
    }
    add_particles(all);
    if (all->is_after) {
        add_contacts(network);
#define SYSTEM(name) mspringi_##name##_add_impulses(all);
#include "store/features.def"
        mspringi_implicit_contact_add_impulses(all);
    }
    if (all->knows_elastic)
        return;
    add_springs(all);
    mspringi_elements_add_energy(network);
}

/* -------------------------------------------------------------------------------------------- work of pins */

// Work of pinned ends of a spring: the larger force, before or after the substep, times their way.
static double given_by_pins(const measuring *all, const mspringi_spring_values *s) {
    const mspringi_motion *const motions[] = {&all->before, &all->motion};
    const float *inverse_mass = all->network->inverse_mass;
    const double base = inverse_mass[s->base] > 0.0f ? 0.0 : 1.0, tip = inverse_mass[s->tip] > 0.0f ? 0.0 : 1.0;
    const double way_x = tip * (x_at(&all->motion, s->tip) - x_at(&all->before, s->tip)) -
                         base * (x_at(&all->motion, s->base) - x_at(&all->before, s->base));
    const double way_y = tip * (y_at(&all->motion, s->tip) - y_at(&all->before, s->tip)) -
                         base * (y_at(&all->motion, s->base) - y_at(&all->before, s->base));
    double most = (double)-INFINITY;
    for (size_t i = 0; i < 2; ++i) {
        const mspringi_motion *m = motions[i];
        const double x = x_at(m, s->tip) - x_at(m, s->base), y = y_at(m, s->tip) - y_at(m, s->base);
        const double length = sqrt(x * x + y * y), per_length = length > 0.0 ? 1.0 / length : 0.0;
        const double nx = x * per_length, ny = y * per_length;
        const double rate = nx * ((double)m->vx[s->tip] - (double)m->vx[s->base]) +
                            ny * ((double)m->vy[s->tip] - (double)m->vy[s->base]);
        const double force = (double)s->stiffness * (length - (double)s->rest_length) + (double)s->damping * rate;
        const double work = force * (nx * way_x + ny * way_y);
        most = work > most ? work : most;
    }
    return most;
}

static void add_given(const measuring *all, mspringi_spring_slot spring_slot) {
    const mspring_network *network = all->network;
    const mspringi_spring_values s = mspringi_spring_slot_get(network, spring_slot);
    if (network->inverse_mass[s.base] > 0.0f && network->inverse_mass[s.tip] > 0.0f)
        return;
    budget_of *budget = &mspringi_implicit_of(network)->budget;
    budget->components[budget->of_slot[s.base]].given += given_by_pins(all, &s);
}

// True if one of these slots has a pinned particle.
static bool has_pin(const mspring_network *network, size_t block) {
    bool any = false;
    for (size_t slot = block * MSPRINGI_WIDTH; slot <= (block + 1) * MSPRINGI_WIDTH; ++slot)
        any |= !(network->inverse_mass[slot] > 0.0f) && network->topology.particle_of_slot[slot] != MSPRING_NONE;
    return any;
}

void mspringi_budget_add_pin_work(const measuring *all) {
    const mspring_network *network = all->network;
    const mspringi_topology *t = &network->topology;
    budget_of *budget = &mspringi_implicit_of(network)->budget;
    size_t word, words;
    for (uint32_t i = 0; i < budget->count; ++i)
        budget->components[i].given = 0.0;
    for (size_t block = 0; budget->is_driven && block < t->block_count; ++block) {
        if (!mspringi_words_of_block(t, block, &word, &words))
            continue;
        const size_t up = words > 1 ? t->up_of_block[block - t->lattice_first] : block;
        if (!has_pin(network, block) && (up == block || !has_pin(network, up)))
            continue;
        for (size_t spring_slot = word * MSPRINGI_WIDTH; spring_slot < (word + words) * MSPRINGI_WIDTH;
             ++spring_slot)
            if (is_live(network, (mspringi_spring_slot)spring_slot))
                add_given(all, (mspringi_spring_slot)spring_slot);
    }
    const float *inverse_mass = network->inverse_mass;
    for (mspringi_spring_slot spring_slot = t->row_spring_slots;
         budget->is_driven && spring_slot < mspringi_swept_end(t); ++spring_slot) {
        uint32_t base, tip;
        mspringi_topology_ends(t, spring_slot, &base, &tip);
        if (is_live(network, spring_slot) && !(inverse_mass[base] > 0.0f && inverse_mass[tip] > 0.0f))
            add_given(all, spring_slot);
    }
}

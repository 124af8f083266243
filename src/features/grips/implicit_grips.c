/// Grips in the linear system of an implicit substep.
///
/// A grip is a spring and a damper to a place, so it adds k and c to the block of its particle on the diagonal, and
/// its force where the particle is predicted to the right-hand side. Where that is more than the grip can exert, k
/// and c are smaller by as much. A force of constant size is so bounded from above by a spring, whatever the way is
/// (a majorizer, as in Weiszfeld's algorithm), and points to the target. If the particle goes away all the same,
/// the substep is solved again with the largest force in the direction that was found, and nothing in the matrix.
/// That force is a part of the one that was found, so it leads to a place between that and where no grip would.
#include "solvers/implicit/implicit_terms.h"

#include <math.h>

#include "features/grips/grips.h"

// True if a grip is in the system. Particles without springs have no equation there; see
// features/grips/grip_stage.c.
static bool is_held(const mspring_network *network, const mspringi_grip *grip, uint32_t *slot) {
    return mspringi_grip_is_active(network, grip, slot) &&
           !network->running->ops->is_isolated(network, network->running->object, *slot);
}

// Target at the end of a substep, or of an interval.
static mspringi_grip_target aim_of(const mspring_network *network, const mspringi_grip *grip, float h) {
    const mspringi_grips *grips = network->grips;
    const double passed = grips->passed + (double)h / (double)grips->h;
    return mspringi_grip_target_at(network, grip, grips->begin + passed * grips->share);
}

// The force where the particle is predicted, and how much of the grip that lets act.
static void predict_force(const mspring_network *network, mspringi_grip *grip, uint32_t slot, float h) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_grip_target to = aim_of(network, grip, h);
    const double k = (double)grip->stiffness, c = (double)grip->damping, most = (double)grip->max_force;
    const double x = k * (to.x - n->x[slot]) + c * (to.vx - (double)n->velocity.x[slot]);
    const double y = k * (to.y - n->y[slot]) + c * (to.vy - (double)n->velocity.y[slot]);
    const double size = sqrt(x * x + y * y);
    grip->share = size > most ? most / size : 1.0;
    grip->force_x = grip->share * x;
    grip->force_y = grip->share * y;
}

static void add_constraint(mspring_network *network, uint32_t number, uint32_t slot, bool is_y) {
    const mspringi_system *s = &mspringi_implicit_of(network)->system;
    const mspringi_grip *grip = &network->grips->list[number];
    mspringi_constraint *c = mspringi_constraint_add(&network->constraints, MSPRINGI_GRIP_CONSTRAINT, number, 1);
    mspringi_constraint_add_entry(&network->constraints, slot, is_y ? 0.0 : 1.0, is_y ? 1.0 : 0.0);
    c->bounded = is_y ? MSPRINGI_SECOND_OF_PAIR : MSPRINGI_BOUND_OF_PAIR;
    c->stiffness =
        s->force_scale * (grip->share * ((double)grip->stiffness + (double)grip->damping * s->damping_rate));
    c->effort = s->force_scale * (is_y ? grip->force_y : grip->force_x);
    c->bound = s->force_scale * (double)grip->max_force;
}

void mspringi_grips_list_constraints(mspring_network *network, float h) {
    uint32_t slot;
    for (uint32_t i = 0; i < mspringi_grip_count(network); ++i) {
        if (!is_held(network, &network->grips->list[i], &slot))
            continue;
        predict_force(network, &network->grips->list[i], slot, h);
        add_constraint(network, i, slot, false);
        add_constraint(network, i, slot, true);
    }
}

// Find the next pair of constraints of a grip, from *at on; NULL at the end. Grips alone have pairs.
static const mspringi_constraint *next_pair(const mspring_network *network, uint32_t *at) {
    const mspringi_constraints *all = &network->constraints;
    while (*at < all->count && all->list[*at].bounded != MSPRINGI_BOUND_OF_PAIR)
        ++*at;
    if (*at == all->count)
        return NULL;
    *at += 2;
    return &all->list[*at - 2];
}

void mspringi_grips_store_forces(mspring_network *network) {
    const double scale = mspringi_implicit_of(network)->system.force_scale;
    const mspringi_constraint *c;
    for (uint32_t at = 0; mspringi_grip_count(network) > 0 && (c = next_pair(network, &at)) != NULL;) {
        mspringi_grip *grip = &network->grips->list[c->source];
        grip->force_x = c[0].force / scale;
        grip->force_y = c[1].force / scale;
        grip->is_bounded = c->activity == MSPRINGI_AT_BOUND;
    }
}

void mspringi_grips_count_impulses(mspring_network *network, float h) {
    uint32_t slot;
    if (mspringi_grip_count(network) == 0)
        return;
    for (uint32_t i = 0; i < mspringi_grip_count(network); ++i) {
        mspringi_grip *grip = &network->grips->list[i];
        if (!is_held(network, grip, &slot))
            continue;
        grip->sum_x += (double)h * grip->force_x;
        grip->sum_y += (double)h * grip->force_y;
    }
    network->grips->passed += (double)h / (double)network->grips->h;
}

/* ----------------------------------------------------------------------------------------------------- the work */

static double place_x(const mspringi_motion *m, uint32_t slot) {
    return (double)m->x[slot] + (double)m->low_x[slot];
}

static double place_y(const mspringi_motion *m, uint32_t slot) {
    return (double)m->y[slot] + (double)m->low_y[slot];
}

// The energy of a grip's spring that is so long, with the bound of its force.
static double energy_of(const mspringi_grip *grip, double x, double y) {
    const double k = (double)grip->stiffness, most = (double)grip->max_force, length = sqrt(x * x + y * y);
    return k * length <= most ? 0.5 * k * (length * length) : most * (length - 0.5 * most / k);
}

// Energy that a grip's spring loses in a substep, at whose start and end the target is here.
static double loss_of(const mspringi_budget_sums *all, const mspringi_grip *grip, uint32_t slot,
                      const mspringi_grip_target *from, const mspringi_grip_target *to) {
    const mspringi_motion *before = &all->before, *after = &all->motion;
    return energy_of(grip, from->x - place_x(before, slot), from->y - place_y(before, slot)) -
           energy_of(grip, to->x - place_x(after, slot), to->y - place_y(after, slot));
}

// Work of a grip: what its target does on its way, and, in the frame of the target, what the spring loses and the
// damper does.
static double work_of(const mspringi_budget_sums *all, const mspringi_grip *grip, uint32_t slot, double x,
                      double y) {
    const mspringi_grip_target from = aim_of(all->network, grip, 0.0f), to = aim_of(all->network, grip, all->h);
    const double way_x = to.x - from.x, way_y = to.y - from.y, c = grip->is_bounded ? 0.0 : (double)grip->damping;
    const double of_target = grip->force_x * way_x + grip->force_y * way_y;
    const double braked = grip->share * c *
                          ((to.vx - (double)all->motion.vx[slot]) * (x - way_x) +
                           (to.vy - (double)all->motion.vy[slot]) * (y - way_y));
    return of_target + loss_of(all, grip, slot, &from, &to) + braked;
}

// True if two ways from one coordinate to another are equal, but for the last places of these.
static bool are_alike(double from, double to, double other_from, double other_to) {
    const double places = 0x1p-51 * (fabs(from) + fabs(to) + fabs(other_from) + fabs(other_to));
    return fabs((to - from) - (other_to - other_from)) <= places;
}

// True if the targets of all grips on a component move as one does. (Where several that one hand moves had to be
// equal bit for bit, 49 of 16,000 cases of the map gained energy: in the frame at rest, a component whose substeps
// all fail stays behind its targets.)
static bool do_targets_move_alike(const mspring_network *network, uint32_t component, const mspringi_grip *as) {
    const mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    uint32_t slot;
    bool alike = true;
    for (uint32_t i = 0; i < mspringi_grip_count(network); ++i) {
        const mspringi_grip *grip = &network->grips->list[i];
        if (is_held(network, grip, &slot) && budget->of_slot[slot] == component)
            alike &= are_alike(grip->from_x, grip->x, as->from_x, as->x) &&
                     are_alike(grip->from_y, grip->y, as->from_y, as->y);
    }
    return alike;
}

// Not with a floor or contact: they do work in the frame of targets that move.
void mspringi_grips_find_frames(const mspring_network *network) {
    const mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    uint32_t slot;
    for (uint32_t i = 0; i < mspringi_grip_count(network) && !network->floor && !network->contacts; ++i) {
        const mspringi_grip *grip = &network->grips->list[i];
        if (!is_held(network, grip, &slot) || budget->of_slot[slot] == MSPRINGI_NO_COMPONENT)
            continue;
        mspringi_component_budget *a = &budget->components[budget->of_slot[slot]];
        const mspringi_grip_target to = aim_of(network, grip, 0.0f);
        if (a->frame_pin == MSPRING_NONE && do_targets_move_alike(network, budget->of_slot[slot], grip)) {
            a->frame_x = to.vx;
            a->frame_y = to.vy;
        }
    }
}

void mspringi_grips_add_impulses(const mspringi_budget_sums *all) {
    const mspring_network *network = all->network;
    mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    uint32_t slot;
    for (uint32_t i = 0; i < mspringi_grip_count(network); ++i) {
        const mspringi_grip *grip = &network->grips->list[i];
        if (!is_held(network, grip, &slot) || budget->of_slot[slot] == MSPRINGI_NO_COMPONENT)
            continue;
        mspringi_component_budget *a = &budget->components[budget->of_slot[slot]];
        const double from_x = place_x(&all->before, slot), from_y = place_y(&all->before, slot);
        const double x = place_x(&all->motion, slot), y = place_y(&all->motion, slot);
        const double rx = 0.5 * (x + from_x) - a->origin[0], ry = 0.5 * (y + from_y) - a->origin[1];
        a->sums[MSPRINGI_EFFECT_X] += grip->force_x;
        a->sums[MSPRINGI_EFFECT_Y] += grip->force_y;
        a->sums[MSPRINGI_EFFECT_TORQUE] += rx * grip->force_y - ry * grip->force_x;
        a->sums[MSPRINGI_EFFECT_WORK] += work_of(all, grip, slot, x - from_x, y - from_y);
        a->is_held = true;
    }
}

/// The energy of bodies that touch, all together.
///
/// Each component keeps a budget of its own, in which the work of other bodies is a gift. What one is given another
/// has to lack, but forces of rows are only as right as the solution is: in stiff networks they show in how little
/// springs give way, which rounding may hide. (Two lattices of 4.5e11 N/m had 46 times their energy after a touch:
/// momenta followed an impulse of 464 N s where 20 were due.) So the sums of all that touch are looked at, too. A
/// substep that gains is taken again in pieces, and in the end without rows in the system.
#include "contact/pairs.h"
#include "solvers/implicit/budget.h"
#include "solvers/implicit/implicit.h"
#include "solvers/implicit/terms.h"

/// Energy that bodies that touch may have more than before, as a part of what they had, and of what they fall by in
/// the substep. (With 1e-4 such gains added up to 0.4 % in some thousand substeps.)
#define DRIVEN_SHARE 1e-5
#define DRIVEN_FALL 1.0

// Kinetic energy that a component is left with.
static double left_with(const mspringi_account *a, const mspringi_centre *c) {
    const double turns = c->inertia > 0.0 ? c->spin / c->inertia : 0.0, to = a->keep * turns + a->turn;
    const double x = a->keep * (a->origin[2] + c->vx) + a->add_x, y = a->keep * (a->origin[3] + c->vy) + a->add_y;
    return 0.5 * c->mass * (x * x + y * y) + a->keep * a->keep * (c->kinetic - 0.5 * c->spin * turns) +
           0.5 * c->inertia * to * to;
}

// Whether components that touch have more energy together than before, but for work from outside. In stiff networks
// forces of rows show in how little springs give way, which rounding may hide, and momenta would follow them.
bool mspringi_bodies_gain(const mspring_network *network, double h) {
    const mspringi_budget *budget = &mspringi_implicit_of(network)->budget;
    const double gx = (double)network->settings.gravity_x, gy = (double)network->settings.gravity_y;
    double gain = 0.0, most = 0.0;
    for (const mspringi_account *a = budget->accounts; a < budget->accounts + budget->count; ++a) {
        if (!a->is_touched)
            continue;
        if (!a->is_free || network->pairs->colliders.count > 0)
            return false;
        const mspringi_centre c = mspringi_centre_of(a);
        const double vx = a->origin[2] + a->vx, vy = a->origin[3] + a->vy, fall = h * h * (gx * gx + gy * gy);
        const double had = 0.5 * c.mass * (vx * vx + vy * vy) + a->internal;
        const double work = a->sums[MSPRINGI_EFFECT_WORK] - a->pushed +
                            c.mass * (gx * (c.x - a->x + a->shift_x) + gy * (c.y - a->y + a->shift_y));
        gain += left_with(a, &c) + a->elastic - had - work;
        most += DRIVEN_SHARE * had + DRIVEN_FALL * c.mass * fall + mspringi_account_rounding(a, a->internal);
    }
    return gain > most;
}

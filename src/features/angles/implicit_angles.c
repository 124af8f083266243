/// Angle springs in the linear system of a substep: those that have springs along both arms.
///
/// One is a constraint with the gradient of the angle where the particles are predicted, the stiffness k + c
/// damping_rate, and the torque there. So there is no pair of particles that the springs' pattern would lack, and a
/// body turns as freely as it does.
#include "features/angles/angles.h"

#include <math.h>

#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"
#include "store/elements.h"
#include "store/sleepers.h"

// A sleeper is swept by the direct solver only, where it is as heavy as a pinned particle.
static bool sleeps(const mspring_network *network, const mspringi_corner *corners) {
    bool any = false;
    for (int i = 0; i < 3 && network->sleep.sleeping > 0; ++i)
        any = any || mspringi_slot_is_asleep(network, corners[i].slot);
    return any && !mspringi_implicit_of(network)->is_direct;
}

/// An arm where it is predicted, and the gradient of its direction at its end.
typedef struct arm {
    double along[2], x, y, rate;
} arm;

static arm arm_of(const mspringi_implicit *n, uint32_t from, uint32_t to) {
    const double x = n->x[to] - n->x[from], y = n->y[to] - n->y[from], square = x * x + y * y;
    arm found = {{x, y}, 0.0, 0.0, 0.0};
    if (square > 0.0) {
        found.x = -y / square;
        found.y = x / square;
        found.rate = found.x * (double)(n->velocity.x[to] - n->velocity.x[from]) +
                     found.y * (double)(n->velocity.y[to] - n->velocity.y[from]);
    }
    return found;
}

static void list_angle(mspring_network *network, uint32_t number) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_area *angle = &network->areas->list[number];
    const mspringi_corner *corners = network->areas->corners + angle->first;
    if (sleeps(network, corners))
        return;
    const arm u = arm_of(n, corners[0].slot, corners[1].slot), w = arm_of(n, corners[1].slot, corners[2].slot);
    const double size = mspringi_angle_size_by(angle, u.along, w.along), damping = (double)angle->damping;
    mspringi_constraints *all = &network->constraints;
    mspringi_constraint *c = mspringi_constraint_add(all, MSPRINGI_ANGLE_CONSTRAINT, number, 3);
    c->is_closed = true;
    c->effort = n->system.force_scale * (mspringi_angle_torque(angle, size) - damping * (w.rate - u.rate));
    c->stiffness =
        n->system.force_scale * (mspringi_angle_stiffness(angle, size) + damping * n->system.damping_rate);
    mspringi_constraint_add_entry(all, corners[1].slot, -(u.x + w.x), -(u.y + w.y));
    mspringi_constraint_add_entry(all, corners[0].slot, u.x, u.y);
    mspringi_constraint_add_entry(all, corners[2].slot, w.x, w.y);
}

static bool is_used(const mspring_network *network) {
    return network->areas && network->areas->hinge_count > 0;
}

// Energies count with those of areas.
static void list_constraints(mspring_network *network) {
    for (size_t i = 0; i < mspringi_area_count(network); ++i) {
        const mspringi_area *area = &network->areas->list[i];
        if (area->is_angle && area->is_ringed && !area->is_open)
            list_angle(network, (uint32_t)i);
    }
}

const mspringi_element_ops mspringi_element_angles = {
    .is_used = is_used, .list_constraints = list_constraints, .forgets_energy = is_used};

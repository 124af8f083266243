/// Springs that only pull or only push, in the energy budget of a substep.
///
/// The system has those that are expected to act at its end (features/one_way/step_one_way.c). Where one is on the
/// other side than was expected, its record has another energy than it has: one that tightened unforeseen would get
/// its energy from nowhere, and one that acts ahead of time would make room for such.
#include "solvers/implicit/energy_budget.h"
#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"

#include <math.h>

#include "features/one_way/one_way.h"
#include "store/springs.h"

// How much longer than its rest length a spring is, m. What yields has another one since the stage looked.
static double stretch_of(const mspring_network *network, const mspringi_motion *m,
                         const mspringi_one_way_spring *spring) {
    const float rest =
        network->tested.nominal
            ? mspringi_read_length(mspringi_spring_slot_get(network, spring->spring_slot).rest_length)
            : spring->rest_length;
    const uint32_t a = spring->base, b = spring->tip;
    const double x = ((double)m->x[b] - (double)m->x[a]) + ((double)m->low_x[b] - (double)m->low_x[a]);
    const double y = ((double)m->y[b] - (double)m->y[a]) + ((double)m->low_y[b] - (double)m->low_y[a]);
    return sqrt(x * x + y * y) - (double)rest;
}

void mspringi_one_way_correct_energy(const mspringi_budget_sums *all) {
    const mspringi_one_way *one_way = all->network->one_way;
    const mspringi_budget *budget = &mspringi_implicit_of(all->network)->budget;
    for (uint32_t i = 0; one_way && i < one_way->listed; ++i) {
        const mspringi_one_way_spring *spring = &one_way->list[i];
        const uint32_t number = budget->of_slot[spring->base];
        const double stretch = stretch_of(all->network, &all->motion, spring);
        const bool is_taut = (double)spring->side * stretch > 0.0;
        if (is_taut == spring->acts || number == MSPRINGI_NO_COMPONENT)
            continue;
        const double energy = 0.5 * (double)spring->stiffness * stretch * stretch;
        budget->components[number].elastic += is_taut ? energy : -energy;
    }
}

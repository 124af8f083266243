/// Springs that only pull or only push, in the energy budget of a substep.
///
/// The system has those that are expected to act at its end (features/one_way/step_one_way.c). Where one is on the
/// other side than was expected, its record has another energy than it has: one that tightened unforeseen would get
/// its energy from nowhere, and one that acts ahead of time would make room for such.
#include "features/one_way/one_way.h"

#include <math.h>

#include "solvers/implicit/implicit.h"
#include "store/elements.h"
#include "store/springs.h"

// How much longer than its rest length a spring is, m. What yields has another one since the stage looked.
static double stretch_of(const mspring_network *network, const mspringi_one_way_spring *spring) {
    const mspringi_state *m = &network->state;
    const float rest =
        network->tested.nominal
            ? mspringi_read_length(mspringi_spring_slot_get(network, spring->spring_slot).rest_length)
            : spring->rest_length;
    const uint32_t a = spring->base, b = spring->tip;
    const double x = ((double)m->x[b] - (double)m->x[a]) + ((double)m->low_x[b] - (double)m->low_x[a]);
    const double y = ((double)m->y[b] - (double)m->y[a]) + ((double)m->low_y[b] - (double)m->low_y[a]);
    return sqrt(x * x + y * y) - (double)rest;
}

static void correct_energy(const mspring_network *network) {
    const mspringi_one_way *one_way = network->one_way;
    const mspringi_implicit *n = mspringi_implicit_of(network);
    for (uint32_t i = 0; i < one_way->listed; ++i) {
        const mspringi_one_way_spring *spring = &one_way->list[i];
        const uint32_t number = n->budget.of_slot[spring->base];
        const double stretch = stretch_of(network, spring);
        const bool is_taut = (double)spring->side * stretch > 0.0;
        if (is_taut == spring->acts || number == MSPRINGI_NO_COMPONENT)
            continue;
        const double energy = 0.5 * (double)spring->stiffness * stretch * stretch;
        n->budget.components[number].elastic += is_taut ? energy : -energy;
    }
}

const mspringi_element_ops mspringi_element_one_way = {.is_used = mspringi_one_way_is_used,
                                                       .add_energy = correct_energy};

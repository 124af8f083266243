/// Elements in a problem of statics: forces and energies are exact. Their stiffness is that of springs along their
/// sides (element_laws.h), so the matrix has the pattern of the springs. An element that owns its sides has edges
/// of its own there; others must have springs.
#include <math.h>

#include "analysis/settle/equilibrium.h"
#include "store/springs.h"

static mspringi_positions positions_of(const mspringi_statics *s) {
    return (mspringi_positions){.x = s->start.x, .y = s->start.y, .moved_x = s->moved.x, .moved_y = s->moved.y};
}

uint32_t mspringi_statics_count_sides(mspring_network *network) {
    uint32_t count = 0;
    mspringi_elements_refresh(network);
    mspringi_element_walk walk = mspringi_walk_elements(network);
    while (mspringi_element_next(&walk))
        count += walk.element.owns_sides ? walk.element.count : 0;
    return count;
}

// Number the springs with stiffness.
static void number_springs(const mspring_network *network, uint32_t *numbers) {
    uint32_t count = 0;
    for (mspring_id spring = 0; spring < network->topology.spring_count; ++spring)
        numbers[spring] = mspringi_spring_get(network, spring).stiffness > 0.0f ? count++ : MSPRING_NONE;
}

static uint32_t add_edge(mspringi_statics_springs *s, mspring_id a, mspring_id b) {
    s->a[s->edge_count] = a;
    s->b[s->edge_count] = b;
    return s->edge_count++;
}

static mspring_result find_sides(mspringi_statics *statics, mspring_network *network, const uint32_t *numbers) {
    mspringi_element_walk walk = mspringi_walk_elements(network);
    while (mspringi_element_next(&walk)) {
        const mspringi_element_ref *e = &walk.element;
        for (uint32_t side = 0; side < e->count; ++side) {
            const mspringi_corner *here = &e->corners[side],
                                  *next = &e->corners[side + 1 < e->count ? side + 1 : 0];
            uint32_t *edge = &statics->elements.sides[e->first + side];
            *edge = e->owns_sides                  ? add_edge(&statics->springs, here->particle, next->particle)
                    : here->spring != MSPRING_NONE ? numbers[here->spring]
                                                   : MSPRING_NONE;
            if (*edge == MSPRING_NONE)
                return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                     "area %u has no spring on its side from particle %u on: an equilibrium needs "
                                     "springs on all sides",
                                     (unsigned)e->id, (unsigned)here->particle);
        }
    }
    return MSPRING_OK;
}

mspring_result mspringi_statics_add_elements(mspringi_statics *statics, mspring_network *network) {
    mspringi_statics_elements *all = &statics->elements;
    uint32_t most = 0;
    bool is_bounded = false;
    all->of = network;
    mspringi_element_walk walk = mspringi_walk_elements(network);
    while (mspringi_element_next(&walk)) {
        most = walk.element.count > most ? walk.element.count : most;
        is_bounded = is_bounded || !walk.element.owns_sides;
    }
    if (most == 0)
        return MSPRING_OK;
    uint32_t *numbers = mspringi_alloc(&network->memory, network->topology.spring_count, sizeof *numbers);
    all->sides = mspringi_alloc(&network->memory, walk.corners, sizeof *all->sides);
    all->blocks = mspringi_alloc(&network->memory, most, sizeof *all->blocks);
    // Blocks on sides of their own are exact, so that Newton's method needs no secants: 19 iterations instead
    // of 67.
    if (is_bounded)
        statics->secants.block = mspringi_alloc(&network->memory, 2 * (size_t)statics->particle_count,
                                                (2 * MSPRINGI_SECANTS + 2) * sizeof(double));
    const bool whole = numbers && all->sides && all->blocks && (statics->secants.block || !is_bounded);
    if (whole)
        number_springs(network, numbers);
    const mspring_result result =
        whole ? find_sides(statics, network, numbers)
              : mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                              "no memory to settle areas and angles of %u corners", (unsigned)walk.corners);
    mspringi_free(&network->memory, numbers);
    return result;
}

double mspringi_statics_element_forces(mspringi_statics *statics) {
    const mspringi_positions at = positions_of(statics);
    double largest = 0.0;
    mspringi_element_walk walk = mspringi_walk_elements(statics->elements.of);
    while (mspringi_element_next(&walk)) {
        const mspringi_element_ref *e = &walk.element;
        const double force = e->law->force(e->of, e->law->size(e, &at));
        for (uint32_t i = 0; i < e->count; ++i) {
            const mspringi_vector g = e->law->gradient(e, &at, i);
            const uint32_t p = e->corners[i].particle;
            statics->force.x[p] += force * g.x;
            statics->force.y[p] += force * g.y;
            largest = fmax(largest, fmax(fabs(force * g.x), fabs(force * g.y)));
        }
    }
    return largest;
}

double mspringi_statics_element_change(const mspringi_statics *s, double t, double *size) {
    const mspringi_positions at = positions_of(s);
    const mspringi_move move = {t, s->step.x, s->step.y, s->curvature.x, s->curvature.y};
    double change = 0.0;
    mspringi_element_walk walk = mspringi_walk_elements(s->elements.of);
    while (mspringi_element_next(&walk))
        change += walk.element.law->energy_change(&walk.element, &at, &move, size);
    return change;
}

static void add_block(mspringi_statics *statics, uint32_t edge, mspringi_side_block block) {
    mspringi_statics_springs *s = &statics->springs;
    for (int end = 0; end < 2; ++end) {
        const uint32_t p = end ? s->b[edge] : s->a[edge];
        statics->xx[p] += block.xx;
        statics->xy[p] += block.xy;
        statics->yy[p] += block.yy;
        statics->scale[p] += 0.5 * (fabs(block.xx) + fabs(block.yy));
    }
    s->xx[edge] -= block.xx;
    s->xy[edge] -= block.xy;
    s->yy[edge] -= block.yy;
}

void mspringi_statics_add_element_stiffness(mspringi_statics *statics, bool clamped) {
    const mspringi_positions at = positions_of(statics);
    mspringi_element_walk walk = mspringi_walk_elements(statics->elements.of);
    while (mspringi_element_next(&walk)) {
        const mspringi_element_ref *e = &walk.element;
        e->law->blocks(e, &at, clamped, statics->elements.blocks);
        for (uint32_t side = 0; side < e->count; ++side)
            add_block(statics, statics->elements.sides[e->first + side], statics->elements.blocks[side]);
    }
}

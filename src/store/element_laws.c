#include "store/element_laws.h"

#include <math.h>

static const mspringi_element_list *const lists[] = {
#define ELEMENTS(table) &table,
#include "store/features.def"
    NULL};

mspringi_vector mspringi_way_between(const mspringi_positions *at, mspring_id from, mspring_id to) {
    if (at->network) {
        const mspringi_state *s = &at->network->state;
        const uint32_t a = at->network->topology.slot_of_particle[from],
                       b = at->network->topology.slot_of_particle[to];
        return (mspringi_vector){mspringi_x_of(s, b) - mspringi_x_of(s, a),
                                 mspringi_y_of(s, b) - mspringi_y_of(s, a)};
    }
    mspringi_vector way = {at->x[to] - at->x[from], at->y[to] - at->y[from]};
    if (at->moved_x) {
        way.x += at->moved_x[to] - at->moved_x[from];
        way.y += at->moved_y[to] - at->moved_y[from];
    }
    return way;
}

const mspringi_positions *mspringi_gather(mspringi_gathered *room, const mspringi_positions *all,
                                          const mspringi_element_ref *e) {
    if (all->moved_x || e->count > sizeof room->corners / sizeof room->corners[0])
        return all;
    for (uint32_t i = 0; all->network && i < e->count; ++i) {
        const uint32_t slot = mspringi_slot_of_corner(all->network, e, i);
        const mspringi_state *s = &all->network->state;
        room->corners[i] = (mspringi_vector){mspringi_x_of(s, slot), mspringi_y_of(s, slot)};
    }
    for (uint32_t i = 0; !all->network && i < e->count; ++i)
        room->corners[i] = (mspringi_vector){all->x[e->corners[i].particle], all->y[e->corners[i].particle]};
    room->at.corners = room->corners;
    return &room->at;
}

bool mspringi_element_next(mspringi_element_walk *walk) {
    for (; lists[walk->list]; ++walk->list, walk->next = 0) {
        if (!lists[walk->list]->next(walk))
            continue;
        walk->element.first = walk->corners;
        walk->corners += walk->element.count;
        return true;
    }
    return false;
}

bool mspringi_elements_exist(const mspring_network *network) {
    mspringi_element_walk walk = mspringi_walk_all_elements(network);
    return mspringi_element_next(&walk);
}

void mspringi_elements_refresh(mspring_network *network) {
    for (const mspringi_element_list *const *list = lists; *list; ++list)
        (*list)->refresh(network);
}

double mspringi_elements_longest(const mspring_network *network) {
    double longest = INFINITY;
    for (const mspringi_element_list *const *list = lists; *list; ++list)
        longest = fmin(longest, (*list)->longest(network));
    return longest;
}

double mspringi_element_size(const mspring_network *network, const mspringi_element_ref *e) {
    const mspringi_positions all = {.network = network};
    mspringi_gathered room;
    return e->law->size(e, mspringi_gather(&room, &all, e));
}

double mspringi_element_energy(const mspring_network *network, const mspringi_element_ref *e) {
    return e->law->energy(e->of, mspringi_element_size(network, e));
}

// In the shape that it was added in, g . u is the sum of g_i . (u_i - u'), whatever u' is, as all g add up to 0.
// With the mean of u by the sizes |g| for u', (g . u)^2 is at most the sum of |g_i| |g_j| (u_i - u_j)^2 over all
// pairs: c times that is what springs of stiffness c |g_i| |g_j| between them would have. Of four corners, those
// opposite each other may have opposite g, and two such pairs are enough.
void mspringi_element_weigh(const mspring_network *network, const mspringi_element_ref *e, float *sums,
                            float *dampings) {
    const mspringi_element_bound bound = e->law->bound(e->of);
    double all = 0.0;
    for (uint32_t i = 0; i < e->count; ++i)
        all += (double)e->corners[i].reach;
    for (uint32_t i = 0; i < e->count; ++i) {
        const double reach = (double)e->corners[i].reach, others = e->is_paired ? 0.5 * all : all - reach;
        const uint32_t slot = mspringi_slot_of_corner(network, e, i);
        sums[slot] += mspringi_bounded(bound.stiffness * reach * others + bound.rest);
        dampings[slot] += mspringi_bounded(e->damping * reach * others);
    }
}

double mspringi_element_largest(const mspring_network *network, const mspringi_element_ref *e, const float *sums) {
    double first = 0.0, second = 0.0;
    for (uint32_t i = 0; i < e->count; ++i) {
        const uint32_t slot = mspringi_slot_of_corner(network, e, i);
        const double quotient = (double)sums[slot] * (double)network->inverse_mass[slot];
        second = fmax(second, fmin(first, quotient));
        first = fmax(first, quotient);
    }
    return first + second;
}

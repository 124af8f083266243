/// Islands that lie on each other. They fall asleep together, and if one of them wakes, all do.
///
/// The host, a view or breaking springs may move an island from below another before contact looks at them again.
/// So piles are found when islands fall asleep. They follow from the positions, so a snapshot does not save them.
#include <math.h>
#include <string.h>

#include "base/union_find.h"
#include "features/contact/contacts.h"
#include "store/feature.h"
#include "store/sleepers.h"
#include "store/stages.h"

static uint32_t island_of(const mspring_network *network, mspring_id p) {
    return network->sleep.island[network->topology.slot_of_particle[p]];
}

/* -------------------------------------------------------------------------------------------------------- pairs */

typedef struct node_position {
    double x, y;
} node_position;

static node_position position_of(const mspring_network *network, const mspringi_contacts *contacts,
                                 mspring_id node) {
    const mspringi_state *s = &network->state;
    if (mspringi_is_collider_point(contacts, node)) {
        const uint32_t point = node - contacts->particles;
        return (node_position){contacts->colliders.x[point], contacts->colliders.y[point]};
    }
    const uint32_t slot = network->topology.slot_of_particle[node];
    return (node_position){mspringi_x_of(s, slot), mspringi_y_of(s, slot)};
}

bool mspringi_pair_is_resting(const mspring_network *network, const mspringi_contacts *contacts,
                              const mspringi_pair *pair, double way) {
    const mspringi_outline *o = &contacts->outline;
    const node_position p = position_of(network, contacts, pair->point),
                        a = position_of(network, contacts, o->a[pair->edge]),
                        b = position_of(network, contacts, o->b[pair->edge]);
    const mspringi_closest_point at = mspringi_closest_point_on_edge(p.x, p.y, a.x, a.y, b.x, b.y);
    const double distance = sqrt(at.x * at.x + at.y * at.y) - mspringi_radius_of(contacts, pair->point, pair->edge);
    return distance <= (1.0 + MSPRINGI_RESTING_SHARE) * contacts->thickness + way;
}

// Both sides of a pair: islands, and the time for which each was still, s; < 0: it sleeps. A moving collider has
// time 0. A resting collider is no side, so the pair has one side only.
typedef struct pair_sides {
    uint32_t island[2]; // MSPRING_NONE: a collider
    double still[2];
    bool are_two;
} pair_sides;

static pair_sides sides_of(const mspring_network *network, const mspringi_contacts *contacts,
                           const mspringi_pair *pair) {
    const mspring_id nodes[2] = {pair->point, contacts->outline.a[pair->edge]};
    pair_sides s = {.are_two = true};
    for (int i = 0; i < 2; ++i) {
        const bool is_collider = mspringi_is_collider_point(contacts, nodes[i]);
        s.island[i] = is_collider ? MSPRING_NONE : island_of(network, nodes[i]);
        s.still[i] = is_collider ? 0.0 : network->sleep.still[s.island[i]];
        s.are_two &= !is_collider || mspringi_collider_of(contacts, nodes[i])->is_moving;
    }
    return s;
}

/* --------------------------------------------------------------------------------------------- falling asleep */

// Begin sets of islands that lie on each other, each in one of its own. The colours are free outside of substeps.
static uint32_t *begin_sets(const mspring_network *network, const mspringi_contacts *contacts) {
    for (uint32_t i = 0; i < network->sleep.count; ++i)
        contacts->colours[i] = i;
    return contacts->colours;
}

static bool are_joined(uint32_t *sets, uint32_t a, uint32_t b) {
    return mspringi_union_find_root(sets, a) == mspringi_union_find_root(sets, b);
}

// True if one side of a pair may have to fall asleep later because of the other. Both are awake then.
static bool may_share(const pair_sides *s) {
    return s->are_two && s->still[0] >= 0.0 && s->still[1] >= 0.0 && (s->still[0] > 0.0 || s->still[1] > 0.0);
}

// Join the sides of a pair; a moving collider keeps its other side from resting.
static void join_sides(const mspring_network *network, uint32_t *sets, const pair_sides *s) {
    if (s->island[0] != MSPRING_NONE && s->island[1] != MSPRING_NONE)
        mspringi_union_find_join(sets, s->island[0], s->island[1]);
    else
        network->sleep.still[s->island[0] != MSPRING_NONE ? s->island[0] : s->island[1]] = 0.0;
}

// Sets rather than pair by pair, again and again: along a row of 10,000 bodies that took 1.3 s a step.
void mspringi_piles_share_stillness(mspring_network *network, const mspringi_contacts *contacts) {
    if (!(network->settings.sleep_speed > 0.0f) || mspringi_sleep_is_whole(network))
        return;
    mspringi_sleepers->find_islands(network);
    double *const still = network->sleep.still; // of the islands just found
    uint32_t *const sets = begin_sets(network, contacts);
    for (uint32_t i = 0; i < contacts->count; ++i) {
        const pair_sides s = sides_of(network, contacts, &contacts->list[i]);
        const bool are_islands = s.island[0] != MSPRING_NONE && s.island[1] != MSPRING_NONE;
        if (may_share(&s) && !(are_islands && are_joined(sets, s.island[0], s.island[1])) &&
            mspringi_pair_is_resting(network, contacts, &contacts->list[i], 0.0))
            join_sides(network, sets, &s);
    }
    for (uint32_t i = 0; i < network->sleep.count; ++i) {
        const uint32_t root = mspringi_union_find_root(sets, i);
        still[root] = still[i] < still[root] ? still[i] : still[root];
    }
    for (uint32_t i = 0; i < network->sleep.count; ++i)
        still[i] = still[mspringi_union_find_root(sets, i)];
}

// Lowest slot of a particle's island, which names the island in a ring.
static uint32_t lowest_slot(const mspring_network *network, mspring_id p) {
    const mspringi_sleep *s = &network->sleep;
    return s->lowest[s->island[network->topology.slot_of_particle[p]]];
}

static bool sleeps(const mspring_network *network, const mspringi_contacts *contacts, mspring_id node) {
    return !mspringi_is_collider_point(contacts, node) &&
           mspringi_slot_is_asleep(network, network->topology.slot_of_particle[node]);
}

// Join the rings of two sleepers' islands: two members, one of each, swap their successors.
static void join_rings(const mspring_network *network, uint32_t *sets, mspring_id p, mspring_id q) {
    const mspringi_sleep *s = &network->sleep;
    const uint32_t a = lowest_slot(network, p), b = lowest_slot(network, q), behind = s->beside[a];
    if (are_joined(sets, island_of(network, p), island_of(network, q)))
        return;
    mspringi_union_find_join(sets, island_of(network, p), island_of(network, q));
    s->beside[a] = s->beside[b];
    s->beside[b] = behind;
}

void mspringi_piles_find(mspring_network *network) {
    mspringi_sleep *s = &network->sleep;
    mspringi_contacts *contacts = network->contacts;
    if (s->sleeping == 0)
        return;
    for (uint32_t i = 0; i < s->count; ++i)
        s->beside[s->lowest[i]] = s->lowest[i];
    s->piled = network->edits.sleep_changes;
    if (!contacts)
        return;
    mspringi_near_begin(network, contacts, (1.0 + MSPRINGI_RESTING_SHARE) * contacts->thickness);
    uint32_t *const sets = begin_sets(network, contacts);
    for (uint32_t i = 0; i < contacts->outline.point_count; ++i) {
        const mspring_id p = contacts->outline.points[i];
        const uint32_t count = sleeps(network, contacts, p) ? mspringi_near_edges(network, contacts, p) : 0;
        for (uint32_t k = 0; k < count; ++k) {
            const mspring_id a = contacts->outline.a[contacts->grid.found[k]];
            if (sleeps(network, contacts, a))
                join_rings(network, sets, p, a);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------- waking */

// Largest speed at which both sides of a pair may approach before the next scan, m/s.
static double approach_speed(const mspringi_contacts *contacts, const mspringi_pair *pair) {
    return contacts->is_uniform ? 2.0 * contacts->max_speed
                                : mspringi_speeds_of(contacts, contacts->assumed_speed, pair);
}

static bool may_meet(const mspring_network *network, const mspringi_contacts *contacts, const mspringi_pair *pair) {
    return mspringi_pair_is_resting(network, contacts, pair, contacts->dt * approach_speed(contacts, pair));
}

// Wake the sleepers that an awake island, or a moving collider, may meet. Return true if there are any.
static bool wake_met(mspring_network *network, const mspringi_contacts *contacts) {
    bool any = false;
    for (uint32_t i = 0; i < contacts->count; ++i) {
        const pair_sides s = sides_of(network, contacts, &contacts->list[i]);
        if (!s.are_two || (s.still[0] < 0.0) == (s.still[1] < 0.0) ||
            !may_meet(network, contacts, &contacts->list[i]))
            continue;
        mspringi_sleepers->wake(network, s.island[s.still[0] < 0.0 ? 0 : 1]);
        any = true;
    }
    return any;
}

// Wake the sleepers that one of those just woken may meet, and so on.
static void wake_beyond(mspring_network *network, const mspringi_contacts *contacts) {
    const mspringi_sleep *sleep = &network->sleep;
    const uint32_t *const island = sleep->island;
    uint32_t *const sets = begin_sets(network, contacts);
    for (uint32_t i = 0; i < sleep->count; ++i)
        if (sleep->still[i] < 0.0) // of a pile all sleep
            mspringi_union_find_join(sets, i, island[sleep->beside[sleep->lowest[i]]]);
    for (uint32_t i = 0; i < contacts->count; ++i) {
        const pair_sides s = sides_of(network, contacts, &contacts->list[i]);
        if (s.island[0] != MSPRING_NONE && s.island[1] != MSPRING_NONE && (s.still[0] < 0.0 || s.still[1] < 0.0) &&
            !are_joined(sets, s.island[0], s.island[1]) && may_meet(network, contacts, &contacts->list[i]))
            mspringi_union_find_join(sets, s.island[0], s.island[1]);
    }
    memset(sleep->mark, 0, sleep->count);
    for (uint32_t i = 0; i < sleep->count; ++i)
        if (sleep->still[i] >= 0.0)
            sleep->mark[mspringi_union_find_root(sets, i)] = 1;
    for (uint32_t i = 0; i < sleep->count; ++i)
        if (sleep->still[i] < 0.0 && sleep->mark[mspringi_union_find_root(sets, i)])
            mspringi_sleepers->wake(network, i);
}

void mspringi_piles_wake(mspring_network *network, const mspringi_contacts *contacts) {
    if (network->sleep.sleeping == 0)
        return;
    if (wake_met(network, contacts) && network->sleep.sleeping > 0)
        wake_beyond(network, contacts);
    mspringi_sleepers->finish_waking(network);
}

/* -------------------------------------------------------------------------------------------------------- stage */

static bool is_used(const mspring_network *network) {
    return network->contacts != NULL && network->sleep.state != NULL;
}

static void after_step(mspring_network *network, double dt) {
    (void)dt;
    if (network->sleep.piled != network->edits.sleep_changes)
        mspringi_piles_find(network);
}

const mspringi_stage mspringi_stage_piles = {.is_used = is_used, .after_step = after_step};

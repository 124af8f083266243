/// Piles: islands that sleep on each other. If one of them wakes, all do.
///
/// The host, a view or breaking springs may move an island from below another before contact looks at them again.
/// So piles are found when islands fall asleep. They follow from the positions, so a snapshot does not save them.
#include "features/contact/contacts.h"
#include "store/feature.h"
#include "store/sleepers.h"
#include "store/stages.h"

// Lowest slot of a particle's island, which names the island in a ring.
static uint32_t lowest_slot(const mspring_network *network, mspring_id p) {
    const mspringi_sleep *s = &network->sleep;
    return s->lowest[s->island[network->topology.slot_of_particle[p]]];
}

static bool sleeps(const mspring_network *network, const mspringi_contacts *contacts, mspring_id node) {
    return !mspringi_is_collider_point(contacts, node) &&
           mspringi_slot_is_asleep(network, network->topology.slot_of_particle[node]);
}

// True if two slots are in the same ring.
static bool is_in_ring(const mspringi_sleep *s, uint32_t slot, uint32_t other) {
    uint32_t at = slot;
    do
        at = s->beside[at];
    while (at != slot && at != other);
    return at == other;
}

// Join two rings: two members, one of each, swap their successors.
static void join(const mspringi_sleep *s, uint32_t a, uint32_t b) {
    const uint32_t behind = s->beside[a];
    if (is_in_ring(s, a, b))
        return;
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
    mspringi_near_list(network, contacts, (1.0 + MSPRINGI_RESTING_SHARE) * contacts->thickness);
    for (uint32_t i = 0; i < contacts->count; ++i) {
        const mspring_id p = contacts->list[i].point, a = contacts->outline.a[contacts->list[i].edge];
        if (sleeps(network, contacts, p) && sleeps(network, contacts, a))
            join(s, lowest_slot(network, p), lowest_slot(network, a));
    }
}

static bool is_used(const mspring_network *network) {
    return network->contacts != NULL && network->sleep.state != NULL;
}

static void after_step(mspring_network *network, double dt) {
    (void)dt;
    if (network->sleep.piled != network->edits.sleep_changes)
        mspringi_piles_find(network);
}

const mspringi_stage mspringi_stage_piles = {.is_used = is_used, .after_step = after_step};

/// Begin and end events of contacts.
///
/// One contact joins a particle to another body or a collider, or a collider's corners to a body. A point that
/// slides from edge to edge stays in the same contact. It begins with an impulse. It ends after a step without one,
/// once the two no longer rest on each other.
///
/// In the order of a step:
///
///   mspringi_contact_events_begin         discard an earlier attempt, and follow bodies that broke
///   mspringi_contact_events_add_impulse   for each constraint of an accepted interval; all solvers call it by
///                                         mspringi_contact_count_impulses (contact_solver.c)
///   mspringi_contact_events_end_interval  after these
///   mspringi_contact_events_finish_step   queue events, end contacts
///
/// Ongoing contacts are ordered by ids. A contact that an attempt begins is new until the step is accepted, so
/// discarding an attempt removes it.
#include "features/contact/contacts.h"

#include <string.h>

#include "base/assert.h"
#include "store/changed.h"

/* -------------------------------------------------------------------------------------------------------- list */

static bool is_before(const mspringi_ongoing_contact *m, const mspringi_ongoing_contact *n) {
    return m->point != n->point         ? m->point < n->point
           : m->collider != n->collider ? m->collider < n->collider
                                        : m->other < n->other;
}

// Key of the contact of a node and an edge: point, other, collider. now.a and now.b are the edge, by rising id.
static mspringi_ongoing_contact contact_of(const mspringi_contacts *contacts, mspring_id point, mspring_id a,
                                           mspring_id b) {
    mspringi_ongoing_contact m = {.point = point,
                                  .other = MSPRING_NONE,
                                  .collider = MSPRING_NONE,
                                  .now = {a < b ? a : b, a < b ? b : a, 0, 0, 0, 0}};
    if (mspringi_is_collider_point(contacts, point)) {
        m.point = MSPRING_NONE;
        m.collider = mspringi_collider_of(contacts, point)->id;
    }
    if (mspringi_is_collider_point(contacts, a)) {
        m.collider = mspringi_collider_of(contacts, a)->id;
        m.now.a = m.now.b = MSPRING_NONE;
    } else {
        m.other = contacts->outline.body[a];
    }
    return m;
}

// Index of a contact in the list, or the index at which to insert it.
static uint32_t index_of(const mspringi_contact_events *all, const mspringi_ongoing_contact *wanted) {
    uint32_t low = 0, high = all->count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (is_before(&all->list[middle], wanted))
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

// Find a contact, or add it. NULL: no room.
static mspringi_ongoing_contact *find_or_add(mspringi_contact_events *all, const mspringi_ongoing_contact *wanted) {
    const uint32_t at = index_of(all, wanted);
    mspringi_ongoing_contact *m = &all->list[at];
    if (at < all->count && !is_before(wanted, m))
        return m;
    if (all->count == all->capacity)
        return NULL;
    memmove(m + 1, m, (all->count - at) * sizeof *m);
    *m = *wanted;
    all->count++;
    MSPRINGI_ASSERT(at == 0 || is_before(&all->list[at - 1], m));
    MSPRINGI_ASSERT(at + 1 == all->count || is_before(m, &all->list[at + 1]));
    return m;
}

/* ----------------------------------------------------------------------------------------------------- a step */

static mspringi_contact_location location_of(const mspring_network *network, const mspringi_contacts *contacts,
                                             const mspringi_ongoing_contact *m,
                                             const mspringi_contact_constraint *t) {
    const mspringi_contact_nodes *k = &contacts->nodes;
    const double radius = t->collider == MSPRING_NONE ? 0.0 : contacts->colliders.list[t->collider].radius;
    const double away = m->point == MSPRING_NONE ? radius : t->distance - radius;
    return (mspringi_contact_location){.a = m->now.a,
                                       .b = m->now.b,
                                       .x = network->origin_x + (k->x[t->p] - away * t->nx),
                                       .y = network->origin_y + (k->y[t->p] - away * t->ny),
                                       .nx = t->nx,
                                       .ny = t->ny};
}

void mspringi_contact_events_add_impulse(const mspring_network *network, mspringi_contacts *contacts,
                                         const mspringi_contact_constraint *t) {
    mspringi_contact_events *all = &contacts->events;
    const mspring_id *ids = contacts->nodes.particles;
    mspringi_ongoing_contact wanted = contact_of(contacts, ids[t->p], ids[t->a], ids[t->b]);
    wanted.is_new = true;
    mspringi_ongoing_contact *m = find_or_add(all, &wanted);
    if (!m) {
        all->dropped++;
        return;
    }
    if (t->normal_impulse > m->largest) {
        m->largest = t->normal_impulse;
        m->now = location_of(network, contacts, &wanted, t);
    }
    m->impulse += t->normal_impulse;
    m->friction += t->tangent_impulse < 0.0 ? -t->tangent_impulse : t->tangent_impulse;
}

void mspringi_contact_events_subtract(mspringi_contacts *contacts, const mspringi_contact_constraint *t,
                                      double impulse) {
    mspringi_contact_events *all = &contacts->events;
    const mspring_id *ids = contacts->nodes.particles;
    const mspringi_ongoing_contact wanted = contact_of(contacts, ids[t->p], ids[t->a], ids[t->b]);
    const uint32_t at = index_of(all, &wanted);
    if (at == all->count || is_before(&wanted, &all->list[at]))
        return;
    const double left = all->list[at].impulse - impulse;
    all->list[at].impulse = left > 0.0 ? left : 0.0;
}

void mspringi_contact_events_end_interval(mspringi_contacts *contacts) {
    mspringi_contact_events *all = &contacts->events;
    all->max_dropped = all->dropped > all->max_dropped ? all->dropped : all->max_dropped;
    all->dropped = 0;
}

static void clear_step(mspringi_ongoing_contact *m) {
    m->is_new = false;
    m->largest = m->impulse = m->friction = 0.0;
}

void mspringi_contact_events_discard_step(mspringi_contacts *contacts) {
    mspringi_contact_events *all = &contacts->events;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < all->count; ++i) {
        if (all->list[i].is_new)
            continue;
        all->list[kept] = all->list[i];
        clear_step(&all->list[kept++]);
    }
    all->count = kept;
    all->dropped = all->max_dropped = 0;
}

// Give contacts the present numbers of bodies, which change where bodies break. Contacts that become one keep the
// first.
static void renumber_bodies(mspringi_contacts *contacts) {
    mspringi_contact_events *all = &contacts->events;
    const uint32_t count = all->count;
    all->count = 0;
    for (uint32_t i = 0; i < count; ++i) {
        mspringi_ongoing_contact m = all->list[i];
        if (m.last.a != MSPRING_NONE)
            m.other = contacts->outline.body[m.last.a];
        (void)find_or_add(all, &m);
    }
}

// After a load, add a contact for each pair that rests on each other. They get no begin event.
static void add_existing(const mspring_network *network, mspringi_contacts *contacts) {
    mspringi_contact_events *all = &contacts->events;
    for (uint32_t i = 0; i < contacts->count; ++i) {
        const mspringi_pair *pair = &contacts->list[i];
        if (!mspringi_pair_is_resting(network, contacts, pair, 0.0))
            continue;
        mspringi_ongoing_contact m =
            contact_of(contacts, pair->point, contacts->outline.a[pair->edge], contacts->outline.b[pair->edge]);
        const mspring_id at = pair->point;
        m.last = m.now;
        m.last.x = network->origin_x + contacts->x[at];
        m.last.y = network->origin_y + contacts->y[at];
        (void)find_or_add(all, &m);
    }
    all->is_known = true;
}

void mspringi_contact_events_begin(const mspring_network *network, mspringi_contacts *contacts) {
    if (contacts->events.capacity == 0)
        return;
    mspringi_contact_events_discard_step(contacts);
    renumber_bodies(contacts);
    if (!contacts->events.is_known)
        add_existing(network, contacts);
}

/* ----------------------------------------------------------------------------------------------------- events */

static void queue_event(mspringi_contact_events *all, mspring_contact_event_kind kind,
                        const mspringi_ongoing_contact *m) {
    if (all->waiting == all->capacity) {
        all->lost++;
        return;
    }
    const uint32_t until_end = all->capacity - all->first;
    all->ring[all->waiting < until_end ? all->first + all->waiting : all->waiting - until_end] =
        (mspring_contact_event){.kind = kind,
                                .point = m->point,
                                .a = m->last.a,
                                .b = m->last.b,
                                .collider = m->collider,
                                .x = m->last.x,
                                .y = m->last.y,
                                .normal_x = m->last.nx,
                                .normal_y = m->last.ny,
                                .impulse = m->impulse,
                                .friction = m->friction};
    all->waiting++;
}

// Index of the first pair whose point is `node` or higher. The list is ordered by points.
static uint32_t first_pair(const mspringi_contacts *contacts, mspring_id node) {
    uint32_t low = 0, high = contacts->count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (contacts->list[middle].point < node)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

// True if a pair of the contact rests on each other, so that it has not ended.
static bool is_resting(const mspring_network *network, const mspringi_contacts *contacts,
                       const mspringi_ongoing_contact *m) {
    const bool is_of_corners = m->point == MSPRING_NONE;
    for (uint32_t i = first_pair(contacts, is_of_corners ? contacts->particles : m->point); i < contacts->count;
         ++i) {
        const mspringi_pair *pair = &contacts->list[i];
        if (!is_of_corners && pair->point != m->point)
            return false;
        const mspringi_ongoing_contact found =
            contact_of(contacts, pair->point, contacts->outline.a[pair->edge], contacts->outline.b[pair->edge]);
        if (!is_before(&found, m) && !is_before(m, &found) &&
            mspringi_pair_is_resting(network, contacts, pair, 0.0))
            return true;
    }
    return false;
}

void mspringi_contact_events_finish_step(const mspring_network *network, mspringi_contacts *contacts) {
    mspringi_contact_events *all = &contacts->events;
    if (all->capacity == 0)
        return;
    mspringi_contact_events_end_interval(contacts);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < all->count; ++i) {
        mspringi_ongoing_contact *m = &all->list[i];
        if (m->largest > 0.0)
            m->last = m->now;
        if (m->is_new)
            queue_event(all, MSPRING_CONTACT_BEGAN, m);
        if (!(m->largest > 0.0) && !is_resting(network, contacts, m)) {
            queue_event(all, MSPRING_CONTACT_ENDED, m);
            continue;
        }
        clear_step(m);
        all->list[kept++] = *m;
    }
    all->count = kept;
    all->lost += all->max_dropped;
    all->max_dropped = 0;
}

void mspringi_contact_events_reset(mspringi_contacts *contacts) {
    mspringi_contact_events *all = &contacts->events;
    all->count = all->waiting = 0;
    all->is_known = false;
}

/* -------------------------------------------------------------------------------------------------------- calls */

static mspring_result enter(mspring_network *network) {
    const mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK || network->contacts)
        return result;
    return mspringi_fail(
        &network->message, MSPRING_ERROR_ARGUMENT,
        "contact events are of contact, and there is none: call mspring_network_set_contact() first");
}

mspring_result mspringi_contact_events_make(mspring_network *network, uint32_t capacity,
                                            mspringi_contact_events *made) {
    mspringi_memory *memory = &network->memory;
    *made = (mspringi_contact_events){.capacity = capacity, .is_known = true};
    if (capacity > 0) {
        made->list = mspringi_alloc(memory, capacity, sizeof *made->list);
        made->ring = mspringi_alloc(memory, capacity, sizeof *made->ring);
    }
    if (capacity == 0 || (made->list && made->ring))
        return MSPRING_OK;
    mspringi_free(memory, made->list);
    mspringi_free(memory, made->ring);
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for %u contact events",
                         (unsigned)capacity);
}

void mspringi_contact_events_take(mspring_network *network, bool is_used, mspringi_contact_events *made) {
    mspringi_memory *memory = &network->memory;
    mspringi_contact_events *dropped = is_used ? &network->contacts->events : made;
    mspringi_free(memory, dropped->list);
    mspringi_free(memory, dropped->ring);
    if (!is_used)
        return;
    network->contacts->events = *made;
}

mspring_result mspringi_contact_events_resize(mspring_network *network, uint32_t capacity) {
    mspringi_contact_events made;
    const mspring_result result = mspringi_contact_events_make(network, capacity, &made);
    if (result == MSPRING_OK) {
        mspringi_contact_events_take(network, true, &made);
        network->contacts->def.event_capacity = capacity;
    }
    return result;
}

mspring_result mspring_network_read_contact_events(mspring_network *network, mspring_contact_event *events,
                                                   uint32_t capacity, uint32_t *count, uint64_t *lost) {
    mspring_result result = enter(network);
    if (result == MSPRING_OK && (!count || (capacity > 0 && !events)))
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "the place for contact events, or their count, is NULL");
    if (result == MSPRING_OK && capacity > 0)
        result = mspringi_check_output(&network->message, &mspringi_struct_contact_event, events);
    if (result != MSPRING_OK)
        return result;
    mspringi_contact_events *all = &network->contacts->events;
    const uint32_t read = capacity < all->waiting ? capacity : all->waiting;
    for (uint32_t i = 0; i < read; ++i) {
        mspringi_put_contact_event_at(events, i, &all->ring[all->first]);
        all->first = all->first + 1 < all->capacity ? all->first + 1 : 0;
    }
    all->waiting -= read;
    *count = read;
    if (lost)
        *lost = all->lost;
    return MSPRING_OK;
}

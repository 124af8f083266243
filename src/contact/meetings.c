/// Contacts that begin and end, for the host to read.
///
/// A meeting is what a particle has with another body or a collider, or what the corners of a collider have with a
/// body, wherever on it. So a point that slides from edge to edge goes on with the same meeting. It begins with an
/// impulse. It ends after a step without one, once they are apart by more than what counts as resting on each
/// other.
///
/// Meetings are kept in the order of their ids. What an attempt at a step has found becomes final after the step.
#include "contact/pairs.h"

#include <string.h>

#include "store/changed.h"

#define MOST_EVENTS 0x1000000u

/* -------------------------------------------------------------------------------------------------------- list */

static bool is_before(const mspringi_meeting *m, const mspringi_meeting *n) {
    return m->point != n->point         ? m->point < n->point
           : m->collider != n->collider ? m->collider < n->collider
                                        : m->other < n->other;
}

// A meeting of a node and an edge.
static mspringi_meeting meeting_of(const mspringi_pairs *pairs, mspring_id point, mspring_id a, mspring_id b) {
    mspringi_meeting m = {.point = point,
                          .other = MSPRING_NONE,
                          .collider = MSPRING_NONE,
                          .now = {a < b ? a : b, a < b ? b : a, 0, 0, 0, 0}};
    if (mspringi_is_of_collider(pairs, point)) {
        m.point = MSPRING_NONE;
        m.collider = mspringi_collider_of(pairs, point)->id;
    }
    if (mspringi_is_of_collider(pairs, a)) {
        m.collider = mspringi_collider_of(pairs, a)->id;
        m.now.a = m.now.b = MSPRING_NONE;
    } else {
        m.other = pairs->outline.body[a];
    }
    return m;
}

// The number that a meeting has, or is to have.
static uint32_t place_of(const mspringi_meetings *all, const mspringi_meeting *wanted) {
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

// Find a meeting, or add it. NULL: there is no room.
static mspringi_meeting *find_or_add(mspringi_meetings *all, const mspringi_meeting *wanted) {
    const uint32_t at = place_of(all, wanted);
    mspringi_meeting *m = &all->list[at];
    if (at < all->count && !is_before(wanted, m))
        return m;
    if (all->count == all->capacity)
        return NULL;
    memmove(m + 1, m, (all->count - at) * sizeof *m);
    *m = *wanted;
    all->count++;
    return m;
}

/* ----------------------------------------------------------------------------------------------------- a step */

static mspringi_meeting_place place_at(const mspring_network *network, const mspringi_pairs *pairs,
                                       const mspringi_meeting *m, const mspringi_touch *t) {
    const mspringi_active *k = &pairs->active;
    const double radius = t->collider == MSPRING_NONE ? 0.0 : pairs->colliders.list[t->collider].radius;
    const double away = m->point == MSPRING_NONE ? radius : t->distance - radius;
    return (mspringi_meeting_place){.a = m->now.a,
                                    .b = m->now.b,
                                    .x = network->origin_x + (k->x[t->p] - away * t->nx),
                                    .y = network->origin_y + (k->y[t->p] - away * t->ny),
                                    .nx = t->nx,
                                    .ny = t->ny};
}

void mspringi_meetings_push(const mspring_network *network, mspringi_pairs *pairs, const mspringi_touch *t) {
    mspringi_meetings *all = &pairs->meetings;
    const mspring_id *ids = pairs->active.particles;
    mspringi_meeting wanted = meeting_of(pairs, ids[t->p], ids[t->a], ids[t->b]);
    wanted.is_new = true;
    mspringi_meeting *m = find_or_add(all, &wanted);
    if (!m) {
        all->refused++;
        return;
    }
    if (t->across > m->largest) {
        m->largest = t->across;
        m->now = place_at(network, pairs, &wanted, t);
    }
    m->impulse += t->across;
    m->friction += t->along < 0.0 ? -t->along : t->along;
}

void mspringi_meetings_begin_piece(mspringi_pairs *pairs) {
    mspringi_meetings *all = &pairs->meetings;
    all->most_refused = all->refused > all->most_refused ? all->refused : all->most_refused;
    all->refused = 0;
}

static void rest(mspringi_meeting *m) {
    m->is_new = false;
    m->largest = m->impulse = m->friction = 0.0;
}

void mspringi_meetings_forget_step(mspringi_pairs *pairs) {
    mspringi_meetings *all = &pairs->meetings;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < all->count; ++i) {
        if (all->list[i].is_new)
            continue;
        all->list[kept] = all->list[i];
        rest(&all->list[kept++]);
    }
    all->count = kept;
    all->refused = all->most_refused = 0;
}

// Bodies that break get other numbers. Of meetings that become one the first is kept.
static void number_bodies(mspringi_pairs *pairs) {
    mspringi_meetings *all = &pairs->meetings;
    const uint32_t count = all->count;
    all->count = 0;
    for (uint32_t i = 0; i < count; ++i) {
        mspringi_meeting m = all->list[i];
        if (m.last.a != MSPRING_NONE)
            m.other = pairs->outline.body[m.last.a];
        (void)find_or_add(all, &m);
    }
}

// After a load all that rests on each other has begun before.
static void take_for_begun(const mspring_network *network, mspringi_pairs *pairs) {
    mspringi_meetings *all = &pairs->meetings;
    for (uint32_t i = 0; i < pairs->count; ++i) {
        const mspringi_pair *pair = &pairs->list[i];
        if (!mspringi_pairs_rest(network, pairs, pair, 0.0))
            continue;
        mspringi_meeting m =
            meeting_of(pairs, pair->point, pairs->outline.a[pair->edge], pairs->outline.b[pair->edge]);
        const mspring_id at = pair->point;
        m.last = m.now;
        m.last.x = network->origin_x + pairs->x[at];
        m.last.y = network->origin_y + pairs->y[at];
        (void)find_or_add(all, &m);
    }
    all->is_known = true;
}

void mspringi_meetings_begin(const mspring_network *network, mspringi_pairs *pairs) {
    if (pairs->meetings.capacity == 0)
        return;
    mspringi_meetings_forget_step(pairs);
    number_bodies(pairs);
    if (!pairs->meetings.is_known)
        take_for_begun(network, pairs);
}

/* ----------------------------------------------------------------------------------------------------- events */

static void tell(mspringi_meetings *all, mspring_contact_event_kind kind, const mspringi_meeting *m) {
    if (all->waiting == all->capacity) {
        all->lost++;
        return;
    }
    const uint32_t until_end = all->capacity - all->first;
    all->ring[all->waiting < until_end ? all->first + all->waiting : all->waiting - until_end] =
        (mspring_contact_event){.struct_size = sizeof(mspring_contact_event),
                                .kind = kind,
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

// The first pair of a node, or of one behind it. Pairs lie by their points.
static uint32_t first_pair(const mspringi_pairs *pairs, mspring_id node) {
    uint32_t low = 0, high = pairs->count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (pairs->list[middle].point < node)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static bool is_together(const mspring_network *network, const mspringi_pairs *pairs, const mspringi_meeting *m) {
    const bool is_of_corners = m->point == MSPRING_NONE;
    for (uint32_t i = first_pair(pairs, is_of_corners ? pairs->particles : m->point); i < pairs->count; ++i) {
        const mspringi_pair *pair = &pairs->list[i];
        if (!is_of_corners && pair->point != m->point)
            return false;
        const mspringi_meeting is =
            meeting_of(pairs, pair->point, pairs->outline.a[pair->edge], pairs->outline.b[pair->edge]);
        if (!is_before(&is, m) && !is_before(m, &is) && mspringi_pairs_rest(network, pairs, pair, 0.0))
            return true;
    }
    return false;
}

void mspringi_meetings_end(const mspring_network *network, mspringi_pairs *pairs) {
    mspringi_meetings *all = &pairs->meetings;
    if (all->capacity == 0)
        return;
    mspringi_meetings_begin_piece(pairs);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < all->count; ++i) {
        mspringi_meeting *m = &all->list[i];
        if (m->largest > 0.0)
            m->last = m->now;
        if (m->is_new)
            tell(all, MSPRING_CONTACT_BEGAN, m);
        if (!(m->largest > 0.0) && !is_together(network, pairs, m)) {
            tell(all, MSPRING_CONTACT_ENDED, m);
            continue;
        }
        rest(m);
        all->list[kept++] = *m;
    }
    all->count = kept;
    all->lost += all->most_refused;
    all->most_refused = 0;
}

void mspringi_meetings_forget(mspringi_pairs *pairs) {
    mspringi_meetings *all = &pairs->meetings;
    all->count = all->waiting = 0;
    all->is_known = false;
}

/* -------------------------------------------------------------------------------------------------------- calls */

static mspring_result enter(mspring_network *network) {
    const mspring_result result = mspringi_enter(network);
    if (result != MSPRING_OK || network->pairs)
        return result;
    return mspringi_fail(
        &network->message, MSPRING_ERROR_ARGUMENT,
        "contact events are of contact, and there is none: call mspring_network_set_contact() first");
}

mspring_result mspring_network_reserve_contact_events(mspring_network *network, uint32_t capacity) {
    const mspring_result result = enter(network);
    if (result != MSPRING_OK)
        return result;
    if (capacity > MOST_EVENTS)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                             "room for %u contact events is asked for, %u is the most", (unsigned)capacity,
                             MOST_EVENTS);
    mspringi_memory *memory = &network->memory;
    mspringi_meetings made = {.capacity = capacity, .is_known = true};
    if (capacity > 0) {
        made.list = mspringi_alloc(memory, capacity, sizeof *made.list);
        made.ring = mspringi_alloc(memory, capacity, sizeof *made.ring);
    }
    if (capacity > 0 && (!made.list || !made.ring)) {
        mspringi_free(memory, made.list);
        mspringi_free(memory, made.ring);
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for %u contact events",
                             (unsigned)capacity);
    }
    mspringi_free(memory, network->pairs->meetings.list);
    mspringi_free(memory, network->pairs->meetings.ring);
    network->pairs->meetings = made;
    network->pairs->outline.are_bodies_found = false;
    return MSPRING_OK;
}

mspring_result mspring_network_read_contact_events(mspring_network *network, mspring_contact_event *events,
                                                   uint32_t capacity, uint32_t *count, uint64_t *lost) {
    mspring_result result = enter(network);
    if (result == MSPRING_OK && (!count || (capacity > 0 && !events)))
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "the place for contact events, or their count, is NULL");
    if (result == MSPRING_OK)
        result =
            mspringi_check_outputs(events, capacity, "mspring_contact_event", sizeof *events, &network->message);
    if (result != MSPRING_OK)
        return result;
    mspringi_meetings *all = &network->pairs->meetings;
    const uint32_t read = capacity < all->waiting ? capacity : all->waiting;
    const size_t stride = capacity > 0 ? events->struct_size : 0;
    for (uint32_t i = 0; i < read; ++i) {
        mspringi_put_struct((char *)events + i * stride, &all->ring[all->first], sizeof *events);
        all->first = all->first + 1 < all->capacity ? all->first + 1 : 0;
    }
    all->waiting -= read;
    *count = read;
    if (lost)
        *lost = all->lost;
    return MSPRING_OK;
}

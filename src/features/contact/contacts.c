/// Definition of contact between bodies, set by the host, and memory for it.
#include "features/contact/contacts.h"

#include <math.h>
#include <string.h>

#include "base/array_table.h"
#include "base/cpu.h"
#include "features/contact/floor.h"
#include "store/changed.h"
#include "store/feature.h"
#include "store/id_pool.h"

/// Largest thickness, m, and that of bodies that touch themselves, in shortest springs; most sweeps.
#define THICKEST 1e6
#define THICKNESS_SHARE 0.9
#define MOST_SWEEPS 64

/// Default of push_speed: thicknesses a second, and at most, m/s.
#define PUSHED_SHARE 0.5
#define MOST_PUSH 3.0

/// Most comparisons to find the outline: a constant (50 ms), and more for each spring. Usual networks take 10 for
/// each.
#define MOST_TRIES ((uint64_t)1 << 24)
#define TRIES_OF_SPRING 32

/* ----------------------------------------------------------------------------------------------------- checking */

static mspring_result check_numbers(const mspring_contact_def *def, mspringi_message *message) {
    const struct {
        const char *name;
        double value, most;
    } values[] = {{"friction", (double)def->friction, MSPRINGI_MOST_FRICTION},
                  {"restitution", (double)def->restitution, 1.0},
                  {"push_speed", def->push_speed == -1.0f ? 0.0 : (double)def->push_speed, 1e6},
                  {"thickness", def->thickness, THICKEST}};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i)
        if (!(values[i].value >= 0.0 && values[i].value <= values[i].most))
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the contact's %s is %g, it must be 0 to %g",
                                 values[i].name, values[i].value, values[i].most);
    if (def->sweeps < 1 || def->sweeps > MOST_SWEEPS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the contact's sweeps are %u, they must be 1 to %d",
                             (unsigned)def->sweeps, MOST_SWEEPS);
    if (def->capacity > MSPRINGI_MOST_PAIRS || def->max_capacity > MSPRINGI_MOST_PAIRS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the contact's capacity is %u and its max_capacity %u, they must be at most %u",
                             (unsigned)def->capacity, (unsigned)def->max_capacity, (unsigned)MSPRINGI_MOST_PAIRS);
    if (def->max_capacity > 0 && def->capacity > def->max_capacity)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the contact's capacity is %u, it must be at most max_capacity, %u",
                             (unsigned)def->capacity, (unsigned)def->max_capacity);
    if (def->flags & ~(uint32_t)MSPRING_CONTACT_SELF)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "contact flags %#x are unknown",
                             (unsigned)def->flags);
    return MSPRING_OK;
}

// Fill in the defaults.
static mspring_result check_def(const mspring_network *network, mspring_contact_def *def,
                                mspringi_message *message) {
    const double shortest = network->shortest;
    const bool touches_itself = def->flags & MSPRING_CONTACT_SELF;
    mspring_result result = check_numbers(def, message);
    if (result != MSPRING_OK)
        return result;
    if (def->thickness == 0.0)
        def->thickness = 0.5 * shortest;
    if (!(def->thickness <= THICKEST))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the contact's thickness is 0, and the network has no spring to tell it by");
    if (def->event_capacity > MSPRINGI_MOST_CONTACT_EVENTS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "event_capacity is %u, it must be at most %u",
                             (unsigned)def->event_capacity, MSPRINGI_MOST_CONTACT_EVENTS);
    if (def->reserved != 0)
        return mspringi_check_reserved(message, "mspring_contact_def", def->reserved);
    if (touches_itself && def->thickness > THICKNESS_SHARE * shortest)
        return mspringi_fail(
            message, MSPRING_ERROR_ARGUMENT,
            "the contact's thickness is %g m, it must be at most 0.9 of the shortest spring, %g m, "
            "for bodies that touch themselves",
            def->thickness, shortest);
    if (def->push_speed == -1.0f)
        def->push_speed =
            (float)(def->thickness < MOST_PUSH / PUSHED_SHARE ? PUSHED_SHARE * def->thickness : MOST_PUSH);
    return MSPRING_OK;
}

/* ------------------------------------------------------------------------------------------------------ memory */

#define ARRAY(member) MSPRINGI_ARRAY_ENTRY(mspringi_contacts, member, MSPRINGI_ARRAY)
#define VIEW(member) MSPRINGI_ARRAY_ENTRY(mspringi_contacts, member, MSPRINGI_VIEW)
static const mspringi_array_entry members[] = {
    ARRAY(layers),
    VIEW(masks),
    ARRAY(materials),
    ARRAY(touch),
    ARRAY(outline.is_edge),
    ARRAY(outline.is_known),
    ARRAY(outline.shape_x),
    VIEW(outline.shape_y),
    ARRAY(outline.a),
    VIEW(outline.b),
    VIEW(outline.points),
    VIEW(outline.first),
    VIEW(outline.at),
    VIEW(outline.body),
    ARRAY(grid.first),
    ARRAY(grid.level_of),
    ARRAY(grid.found),
    ARRAY(grid.edges),
    ARRAY(list),
    ARRAY(seen_x),
    VIEW(seen_y),
    VIEW(x),
    VIEW(y),
    VIEW(margin),
    VIEW(speed),
    VIEW(assumed_speed),
    VIEW(square_moved),
    VIEW(extra_speed),
    ARRAY(stamp),
    VIEW(inner.visited),
    VIEW(inner.watched),
    ARRAY(excluded_edges),
    ARRAY(nodes.particles),
    VIEW(nodes.number),
    ARRAY(nodes.x),
    VIEW(nodes.y),
    VIEW(nodes.inverse_mass),
    VIEW(nodes.shift_x),
    VIEW(nodes.shift_y),
    ARRAY(nodes.is_fast),
    ARRAY(nodes.v),
    VIEW(nodes.v_start),
    VIEW(nodes.v_before),
    ARRAY(constraints),
    ARRAY(pending),
    ARRAY(of_shares),
    ARRAY(colours),
    VIEW(due.first),
    ARRAY(due.is_due),
    ARRAY(due.next),
    ARRAY(supports),
    ARRAY(implicit_constraints),
    ARRAY(candidates),
    ARRAY(is_seen),
    ARRAY(near_misses),
    ARRAY(events.list),
    ARRAY(events.ring),
    ARRAY(colliders.list),
    ARRAY(colliders.shape),
    ARRAY(colliders.x),
    VIEW(colliders.y),
    VIEW(colliders.vx),
    VIEW(colliders.vy),
    ARRAY(colliders.owner),
};
#undef ARRAY
#undef VIEW
static const mspringi_array_table columns = MSPRINGI_ARRAY_TABLE(members);

static void destroy(mspringi_contacts *contacts, mspringi_memory *memory) {
    if (!contacts)
        return;
    mspringi_array_table_free(columns, contacts, memory);
    mspringi_free(memory, contacts);
}

const mspringi_feature_state mspringi_state_of_contacts = {MSPRINGI_ARRAY_TABLE(members), NULL};

#define COUNT_OF(array) (sizeof(array) / sizeof(array)[0])

// Allocate `count` arrays of `elements` values in one block. False: no memory.
static bool reserve_doubles(mspringi_memory *memory, size_t elements, double **const arrays[], size_t count) {
    double *block = mspringi_alloc(memory, elements * count, sizeof *block);
    for (size_t i = 0; i < count && block; ++i)
        *arrays[i] = block + i * elements;
    return block != NULL;
}

// Reserve arrays of particles, and of nodes: particles and collider points.
static bool reserve_nodes(mspringi_contacts *made, mspringi_memory *memory, size_t particles, size_t nodes) {
    mspringi_outline *o = &made->outline;
    mspringi_contact_nodes *k = &made->nodes;
    double **const shape[] = {&o->shape_x, &o->shape_y};
    double **const places[] = {
        &made->seen_x,        &made->seen_y,       &made->x,          &made->y, &made->margin, &made->speed,
        &made->assumed_speed, &made->square_moved, &made->extra_speed};
    double **const motion[] = {&k->x, &k->y, &k->inverse_mass, &k->shift_x, &k->shift_y};
    made->layers = mspringi_alloc(memory, 2 * nodes, sizeof *made->layers);
    made->touch = mspringi_alloc(memory, 2 * particles, sizeof *made->touch);
    made->stamp = mspringi_alloc(memory, 3 * particles, sizeof *made->stamp);
    made->excluded_edges =
        mspringi_alloc(memory, MSPRINGI_EXCLUDED_EDGES * particles, sizeof *made->excluded_edges);
    o->is_known = mspringi_alloc(memory, particles, sizeof *o->is_known);
    k->particles = mspringi_alloc(memory, 2 * nodes, sizeof *k->particles);
    k->is_fast = mspringi_alloc(memory, nodes, sizeof *k->is_fast);
    k->v = mspringi_alloc(memory, 3 * nodes, sizeof *k->v);
    made->colours = mspringi_alloc(memory, 2 * nodes, sizeof *made->colours);
    made->supports = mspringi_alloc(memory, MSPRINGI_MAX_SUPPORTS * nodes, sizeof *made->supports);
    if (!made->layers || !made->touch || !made->stamp || !made->excluded_edges || !o->is_known || !k->particles ||
        !k->is_fast || !k->v || !made->colours || !made->supports)
        return false;
    made->due.first = made->colours + nodes;
    k->v_start = k->v + nodes;
    k->v_before = k->v_start + nodes;
    made->inner.visited = made->stamp + particles;
    made->inner.watched = made->inner.visited + particles;
    made->masks = made->layers + nodes;
    k->number = k->particles + nodes;
    return reserve_doubles(memory, particles, shape, COUNT_OF(shape)) &&
           reserve_doubles(memory, nodes, places, COUNT_OF(places)) &&
           reserve_doubles(memory, nodes, motion, COUNT_OF(motion));
}

static bool reserve_edges(mspringi_contacts *made, mspringi_memory *memory, size_t nodes, size_t springs) {
    mspringi_outline *o = &made->outline;
    mspringi_edge_grid *c = &made->grid;
    const size_t edges = nodes + springs;
    made->edge_capacity = edges;
    c->bucket_capacity = 1;
    while (c->bucket_capacity < edges && c->bucket_capacity < (uint32_t)1 << 30)
        c->bucket_capacity *= 2;
    o->is_edge = mspringi_alloc(memory, springs, sizeof *o->is_edge);
    o->a = mspringi_alloc(memory, 4 * edges + 3 * nodes + 1, sizeof *o->a);
    c->first = mspringi_alloc(memory, (size_t)c->bucket_capacity + 1, sizeof *c->first);
    c->edges = mspringi_alloc(memory, edges, sizeof *c->edges);
    c->level_of = mspringi_alloc(memory, edges, sizeof *c->level_of);
    c->found = mspringi_alloc(memory, edges + 1, sizeof *c->found);
    if (!o->is_edge || !o->a || !c->first || !c->edges || !c->level_of || !c->found)
        return false;
    o->b = o->a + edges;
    o->at = o->b + edges;
    o->points = o->at + 2 * edges;
    o->body = o->points + nodes;
    o->first = o->body + nodes;
    return true;
}

static bool reserve_points(mspringi_contacts *made, mspringi_memory *memory, uint32_t points) {
    mspringi_colliders *c = &made->colliders;
    double **const motion[] = {&c->x, &c->y, &c->vx, &c->vy};
    c->point_capacity = points;
    if (points == 0)
        return true;
    c->shape = mspringi_alloc(memory, points, 2 * sizeof *c->shape);
    c->owner = mspringi_alloc(memory, points, sizeof *c->owner);
    return c->shape && c->owner && reserve_doubles(memory, points, motion, COUNT_OF(motion));
}

static void set_def(mspringi_contacts *contacts, const mspring_contact_def *def) {
    contacts->def = *def;
    contacts->thickness = def->thickness;
    contacts->push = (double)def->push_speed;
    contacts->touches_itself = def->flags & MSPRING_CONTACT_SELF;
}

// Copy the host's settings and the outline from former contact, and share the arrays that hand_over() names.
static void take_over(mspringi_contacts *made, const mspringi_contacts *had, size_t springs) {
    const size_t particles = made->particles, points = had->colliders.point_count, nodes = particles + points;
    mspringi_outline *o = &made->outline;
    const mspringi_outline *from = &had->outline;
    mspringi_colliders *c = &made->colliders;
    const mspringi_colliders was = *c;
    memcpy(made->layers, had->layers, nodes * sizeof *made->layers);
    memcpy(made->masks, had->masks, nodes * sizeof *made->masks);
    memcpy(o->is_edge, from->is_edge, springs * sizeof *o->is_edge);
    memcpy(o->is_known, from->is_known, particles * sizeof *o->is_known);
    memcpy(o->shape_x, from->shape_x, particles * sizeof *o->shape_x);
    memcpy(o->shape_y, from->shape_y, particles * sizeof *o->shape_y);
    o->origin_x = from->origin_x;
    o->origin_y = from->origin_y;
    o->is_found = from->is_found;
    o->links = from->links;
    o->growth = from->growth;
    *c = had->colliders;
    c->point_capacity = was.point_capacity;
    c->shape = was.shape, c->owner = was.owner;
    c->x = was.x, c->y = was.y, c->vx = was.vx, c->vy = was.vy;
    if (points > 0) {
        memcpy(c->shape, had->colliders.shape, 2 * points * sizeof *c->shape);
        memcpy(c->owner, had->colliders.owner, points * sizeof *c->owner);
    }
    c->is_placed = false;
    c->are_new = true;
    made->materials = had->materials;
    memcpy(made->touch, had->touch, 2 * particles * sizeof *made->touch);
    made->touch_now = had->touch_now;
    memcpy(made->has_touch, had->has_touch, sizeof made->has_touch);
    made->events = had->events;
    made->touching = had->touching;
    made->deepest = had->deepest;
}

// Drop the arrays that do not depend on the room reserved, because other contact owns them now.
static void hand_over(mspringi_contacts *contacts) {
    contacts->materials = NULL;
    contacts->colliders.list = NULL;
    contacts->events.list = NULL;
    contacts->events.ring = NULL;
}

// The particle with most springs.
static mspring_id find_hub(const mspring_network *network) {
    const uint32_t *first = network->incidence.first;
    mspring_id hub = 0;
    for (mspring_id p = 1; p < network->topology.particle_count; ++p)
        if (first[p + 1] - first[p] > first[hub + 1] - first[hub])
            hub = p;
    return hub;
}

// Find the outline. A network that gets contact for the first time may have too many springs at too many particles.
static mspring_result find_outline(mspring_network *network, mspringi_contacts *made, bool is_anew) {
    mspringi_outline *o = &made->outline;
    const uint32_t springs = network->topology.spring_count;
    const uint64_t most = MOST_TRIES + TRIES_OF_SPRING * (uint64_t)springs;
    o->most_tries = is_anew ? most : UINT64_MAX;
    mspringi_outline_update(network, made);
    o->most_tries = UINT64_MAX;
    if (!is_anew || o->tries <= most)
        return MSPRING_OK;
    const mspring_id hub = find_hub(network);
    return mspringi_fail(&network->message, MSPRING_ERROR_LIMIT,
                         "to find the outline of %u springs takes over %.3g comparisons, as particle %u has %u "
                         "springs and others are like it: contact needs particles with fewer springs",
                         (unsigned)springs, (double)most, (unsigned)hub,
                         (unsigned)(network->incidence.first[hub + 1] - network->incidence.first[hub]));
}

// Make contact with room for `points` collider points, which continues `had` unless that is NULL. The error MEMORY
// has no message.
static mspring_result make(mspring_network *network, const mspring_contact_def *def, uint32_t points,
                           const mspringi_contacts *had, mspringi_contacts **contacts) {
    const size_t particles = network->topology.reserve.particle_end, springs = network->topology.reserve.spring_end,
                 nodes = particles + points;
    mspringi_memory *memory = &network->memory;
    mspringi_contacts *made = mspringi_alloc(memory, 1, sizeof *made);
    if (!made)
        return MSPRING_ERROR_MEMORY;
    set_def(made, def);
    made->particles = (uint32_t)particles;
    bool ok = reserve_nodes(made, memory, particles, nodes) && reserve_edges(made, memory, nodes, springs) &&
              reserve_points(made, memory, points) && mspringi_contact_reserve_ranges(network, made);
    for (size_t p = 0; ok && p < nodes; ++p) {
        made->layers[p] = 1;
        made->masks[p] = UINT32_MAX;
        made->nodes.number[p] = MSPRING_NONE;
    }
    made->outline.origin_x = network->origin_x;
    made->outline.origin_y = network->origin_y;
    if (ok && had)
        take_over(made, had, springs);
    mspring_result result = ok ? find_outline(network, made, !had) : MSPRING_ERROR_MEMORY;
    if (result == MSPRING_OK && !mspringi_contacts_reserve_room(network, made))
        result = MSPRING_ERROR_MEMORY;
    if (result == MSPRING_OK) {
        *contacts = made;
        return MSPRING_OK;
    }
    if (had)
        hand_over(made); // `had` still owns them
    destroy(made, memory);
    return result;
}

// Apply another definition, or room for more collider points, to existing contact. On error nothing has changed.
static mspring_result replace(mspring_network *network, const mspring_contact_def *def, uint32_t points) {
    mspringi_contacts *had = network->contacts;
    mspringi_contacts *made;
    const mspring_result result = make(network, def, points, had, &made);
    if (result != MSPRING_OK)
        return result;
    if (had)
        hand_over(had);
    destroy(had, &network->memory);
    network->contacts = made;
    return MSPRING_OK;
}

bool mspringi_contacts_reserve_points(mspring_network *network, uint32_t points) {
    return replace(network, &network->contacts->def, points) == MSPRING_OK;
}

/* ------------------------------------------------------------------------------------------------- the setting */

static mspring_contact_def def_of(const mspring_network *network) {
    mspring_contact_def def;
    (void)mspring_init(MSPRING_STRUCT_CONTACT_DEF, &def, sizeof def);
    return network->contacts ? network->contacts->def : def;
}

mspring_result mspring_network_get_contact(const mspring_network *network, mspring_contact_def *def) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_contact_def, def);
    if (result != MSPRING_OK)
        return result;
    mspring_contact_def had = def_of(network);
    if (network->contacts)
        had.max_capacity = mspringi_contacts_most_pairs(network->contacts);
    mspringi_put_contact_def(def, &had);
    return MSPRING_OK;
}

static mspring_result remove_contact(mspring_network *network) {
    destroy(network->contacts, &network->memory);
    network->contacts = NULL;
    mspringi_notify_change(network, MSPRINGI_CHANGED_CONTACT, 0);
    return MSPRING_OK;
}

// True if two definitions differ in their capacities at most, which move nothing.
static bool are_alike(const mspring_contact_def *a, const mspring_contact_def *b) {
    return a->flags == b->flags && a->thickness == b->thickness && a->friction == b->friction &&
           a->restitution == b->restitution && a->push_speed == b->push_speed && a->sweeps == b->sweeps;
}

static mspring_result use(mspring_network *network, const mspring_contact_def *def) {
    const bool is_new = !network->contacts || !are_alike(&network->contacts->def, def);
    const uint32_t points = network->contacts ? network->contacts->colliders.point_capacity : 0;
    const mspringi_fp_state before = mspringi_fp_enter();
    const bool resizes = !network->contacts || network->contacts->events.capacity != def->event_capacity;
    mspringi_contact_events events;
    mspring_result result = mspringi_incidence_reserve(network);
    if (result == MSPRING_OK && resizes)
        result = mspringi_contact_events_make(network, def->event_capacity, &events);
    if (result == MSPRING_OK) {
        result = replace(network, def, points);
        if (resizes)
            mspringi_contact_events_take(network, result == MSPRING_OK, &events);
    }
    if (result == MSPRING_ERROR_MEMORY)
        result = mspringi_fail(
            &network->message, MSPRING_ERROR_MEMORY, "no memory for contact of %u particles and %u springs",
            (unsigned)network->topology.particle_count, (unsigned)network->topology.spring_count);
    mspringi_fp_leave(before);
    if (result == MSPRING_OK && is_new)
        mspringi_notify_change(network, MSPRINGI_CHANGED_CONTACT, 0);
    return result;
}

mspring_result mspring_network_set_contact(mspring_network *network, const mspring_contact_def *def) {
    mspring_contact_def used;
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK || (!def && !network->contacts))
        return result;
    if (!def)
        return remove_contact(network);
    result = mspringi_take_contact_def(&network->message, &def, &used);
    if (result == MSPRING_OK)
        result = check_def(network, &used, &network->message);
    return result == MSPRING_OK ? use(network, &used) : result;
}

mspring_result mspring_network_get_contact_info(const mspring_network *network, mspring_contact_info *info) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_contact_info, info);
    if (result != MSPRING_OK)
        return result;
    mspring_contact_info found = {0};
    const mspringi_contacts *contacts = network->contacts;
    if (contacts) {
        found.edges = contacts->outline.edge_count - contacts->colliders.listed_sides;
        found.points = contacts->outline.point_count - contacts->colliders.listed_points;
        found.pairs = contacts->reported_pairs;
        found.touching = contacts->touching;
        found.deepest = contacts->deepest;
    }
    mspringi_put_contact_info(info, &found);
    return MSPRING_OK;
}

// Pairs are found anew: their particles may have moved to different groups, or to the same.
static void look_for_pairs_anew(mspring_network *network) {
    if (!network->contacts)
        return;
    network->contacts->is_listed = network->contacts->is_fresh = false;
    mspringi_notify_change(network, MSPRINGI_CHANGED_CONTACT, 0);
}

void mspringi_contact_react(mspring_network *network, mspringi_change change, uint32_t index) {
    if (change == MSPRINGI_CHANGED_GROUPS)
        look_for_pairs_anew(network);
    if (change != MSPRINGI_CHANGED_SLOT)
        return;
    if (network->floor)
        mspringi_floor_clear_slot(network->floor, index);
    if (network->contacts)
        mspringi_outline_clear_slot(network, index);
}

void mspringi_contact_forget_impulses_of(const mspring_network *network, mspring_id particle) {
    const mspringi_contacts *contacts = network->contacts;
    if (network->floor)
        mspringi_floor_clear_slot(network->floor, network->topology.slot_of_particle[particle]);
    if (contacts)
        contacts->touch[particle] = contacts->touch[contacts->particles + (size_t)particle] = 0.0f;
}

void mspringi_contact_forget_impulses(mspring_network *network) {
    mspringi_contacts *contacts = network->contacts;
    for (uint32_t slot = 0; network->floor && slot < network->floor->slot_count; ++slot)
        mspringi_floor_clear_slot(network->floor, slot);
    if (contacts) {
        memset(contacts->touch, 0, 2 * (size_t)contacts->particles * sizeof *contacts->touch);
        contacts->has_touch[0] = contacts->has_touch[1] = false;
    }
}

void mspringi_contact_discard_step(mspring_network *network) {
    mspringi_floor_roll_back(network->floor);
    if (!network->contacts)
        return;
    mspringi_colliders_discard_step(network->contacts);
    mspringi_contact_events_discard_step(network->contacts);
    network->contacts->is_listed = false; // the rejected positions may have been NaN
}

bool mspringi_contact_acts(const mspring_network *network) {
    return network->floor || network->contacts;
}

bool mspringi_contact_is_finite(const mspring_network *network) {
    bool finite = true;
    for (size_t i = 0; network->floor && network->floor->impulse.x && i < mspringi_used_slots(network); ++i)
        finite = finite && isfinite(network->floor->impulse.x[i]) && isfinite(network->floor->impulse.y[i]);
    for (uint32_t i = 0; network->contacts && i < network->contacts->colliders.count; ++i) {
        const mspringi_collider *c = &network->contacts->colliders.list[i];
        finite = finite && isfinite(c->impulse_x) && isfinite(c->impulse_y) && isfinite(c->angular) &&
                 isfinite(c->def.x) && isfinite(c->def.y) && isfinite(c->def.angle);
    }
    return finite;
}

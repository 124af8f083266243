/// The floor, and contact with surfaces, layers and colliders, in archives.
#include "features/contact/contacts.h"
#include "features/contact/floor.h"
#include "store/archive.h"
#include "store/properties.h"

/* -------------------------------------------------------------------------------------------------------- floor */

#define FIRST_VALUES 4
#define ALL_VALUES 5

typedef struct surfaces {
    mspring_floor_def def;
    uint32_t has[ALL_VALUES]; // values of single planes: friction, restitution; of heights the same, and silt. That
                              // comes last, if there is any, with its own `has`: older chunks end before it.
} surfaces;

static uint32_t count_values(const mspring_floor_def *def, int which) {
    const uint32_t heights = def->height_count;
    return which < 2 ? def->plane_count : which == FIRST_VALUES ? heights : heights > 0 ? heights - 1 : 0;
}

static void hand_floor(mspringi_io *io, surfaces *s) {
    MSPRINGI_HAND(io, s->def.plane_count);
    MSPRINGI_HAND(io, s->def.height_count);
    mspringi_hand(io, &s->def.heights_x, 3, sizeof(double)); // and the next two
    MSPRINGI_HAND(io, s->def.friction);
    MSPRINGI_HAND(io, s->def.restitution);
    MSPRINGI_HAND(io, s->def.silt_depth);
    MSPRINGI_HAND(io, s->def.silt_rate);
    mspringi_hand(io, s->has, FIRST_VALUES, sizeof s->has[0]);
}

static void put_floats(mspringi_io *io, const float *values, size_t count) {
    if (values)
        mspringi_put(io->to, values, count, sizeof *values);
}

static void floor_save(const mspring_network *network, mspringi_io *io) {
    surfaces s = {.def = {.struct_size = sizeof s.def}};
    if (!network->floor || mspring_network_get_floor(network, &s.def) != MSPRING_OK)
        return;
    const float *const values[ALL_VALUES] = {s.def.plane_frictions, s.def.plane_restitutions,
                                             s.def.height_frictions, s.def.height_restitutions, s.def.silt_depths};
    for (int i = 0; i < ALL_VALUES; ++i)
        s.has[i] = values[i] != NULL;
    hand_floor(io, &s);
    if (s.def.plane_count > 0)
        mspringi_put(io->to, s.def.planes, 4 * (size_t)s.def.plane_count, sizeof *s.def.planes);
    put_floats(io, s.def.heights, s.def.height_count);
    for (int i = 0; i < ALL_VALUES; ++i) {
        if (i == FIRST_VALUES && s.has[i])
            MSPRINGI_HAND(io, s.has[i]);
        put_floats(io, values[i], count_values(&s.def, i));
    }
}

static mspring_result floor_load(mspring_network *network, mspringi_io *io) {
    surfaces s = {.has = {0}};
    (void)mspring_init(MSPRING_STRUCT_FLOOR_DEF, &s.def, sizeof s.def);
    hand_floor(io, &s);
    const uint32_t planes = s.def.plane_count, heights = s.def.height_count;
    mspring_result result = MSPRING_OK;
    double *const borders = mspringi_chunk_array(network, io, 4 * (size_t)planes, sizeof *borders, &result);
    float *const levels = mspringi_chunk_array(network, io, heights, sizeof *levels, &result);
    float *values[ALL_VALUES] = {NULL};
    for (int i = 0; i < ALL_VALUES; ++i) {
        if (i == FIRST_VALUES && io->left > 0)
            MSPRINGI_HAND(io, s.has[i]);
        if (s.has[i])
            values[i] = mspringi_chunk_array(network, io, count_values(&s.def, i), sizeof(float), &result);
    }
    s.def.planes = planes > 0 ? borders : NULL;
    s.def.heights = heights > 0 ? levels : NULL;
    s.def.plane_frictions = values[0];
    s.def.plane_restitutions = values[1];
    s.def.height_frictions = values[2];
    s.def.height_restitutions = values[3];
    s.def.silt_depths = values[4];
    if (result == MSPRING_OK)
        result = mspring_network_set_floor(network, &s.def);
    for (int i = 0; i < ALL_VALUES; ++i)
        mspringi_free(&network->memory, values[i]);
    mspringi_free(&network->memory, levels);
    mspringi_free(&network->memory, borders);
    return result;
}

const mspringi_chunk mspringi_chunk_floor = {"floo", "floor", floor_save, floor_load, NULL};

/* ------------------------------------------------------------------------------------------------------ contact */

typedef struct contact_head {
    mspring_contact_def def;
    uint32_t has_materials, event_capacity, collider_count;
} contact_head;

static void hand_contact(mspringi_io *io, contact_head *head) {
    MSPRINGI_HAND(io, head->def.flags);
    MSPRINGI_HAND(io, head->def.thickness);
    mspringi_hand(io, &head->def.friction, 3, sizeof(float)); // and the next two
    mspringi_hand(io, &head->def.sweeps, 3, sizeof(uint32_t));
    mspringi_hand(io, &head->has_materials, 3, sizeof(uint32_t));
}

// Points follow each chain.
static void hand_collider(mspringi_io *io, mspringi_collider *c) {
    int32_t kind = (int32_t)c->def.kind;
    uint32_t is_moving = c->is_moving;
    MSPRINGI_HAND(io, c->id);
    MSPRINGI_HAND(io, kind);
    mspringi_hand(io, &c->def.x, 6, sizeof(double)); // to the radius
    MSPRINGI_HAND(io, c->def.point_count);
    MSPRINGI_HAND(io, c->def.flags);
    MSPRINGI_HAND(io, c->def.friction);
    MSPRINGI_HAND(io, c->def.restitution);
    MSPRINGI_HAND(io, c->def.layers);
    MSPRINGI_HAND(io, c->def.masks);
    mspringi_hand(io, &c->target.x, 3, sizeof(double));
    MSPRINGI_HAND(io, is_moving);
    c->def.kind = (mspring_collider_kind)kind;
    c->is_moving = is_moving != 0;
}

static void contact_save(const mspring_network *network, mspringi_io *io) {
    const mspringi_contacts *contacts = network->contacts;
    if (!contacts)
        return;
    contact_head head = {.def = contacts->def,
                         .has_materials = contacts->materials != NULL,
                         .event_capacity = contacts->events.capacity,
                         .collider_count = contacts->colliders.count};
    hand_contact(io, &head);
    mspringi_put(io->to, contacts->layers, contacts->particles, sizeof *contacts->layers);
    mspringi_put(io->to, contacts->masks, contacts->particles, sizeof *contacts->masks);
    if (head.has_materials)
        mspringi_put(io->to, contacts->materials, 2 * (size_t)contacts->particles, sizeof(float));
    for (uint32_t i = 0; i < head.collider_count; ++i) {
        mspringi_collider c = contacts->colliders.list[i];
        hand_collider(io, &c);
        if (c.def.kind == MSPRING_COLLIDER_CHAIN)
            mspringi_put(io->to, contacts->colliders.shape + 2 * (size_t)c.first, 2 * (size_t)c.count,
                         sizeof(double));
    }
}

static mspring_result load_materials(mspring_network *network, mspringi_io *io) {
    mspring_result result = MSPRING_OK;
    const uint32_t particles = network->contacts->particles;
    mspringi_contact_material *values =
        mspringi_chunk_array(network, io, 2 * (size_t)particles, sizeof(float), &result);
    for (mspring_id p = 0; result == MSPRING_OK && p < particles; ++p)
        if (!mspringi_are_allowed(MSPRING_FRICTION, &values[p].friction, 1, 1) ||
            !mspringi_are_allowed(MSPRING_RESTITUTION, &values[p].restitution, 1, 1))
            result = mspringi_fail(&network->message, MSPRING_ERROR_SNAPSHOT,
                                   "particle %u has the friction %g and the restitution %g", (unsigned)p,
                                   (double)values[p].friction, (double)values[p].restitution);
    if (result == MSPRING_OK)
        result = mspringi_contact_reserve_materials(network);
    for (mspring_id p = 0; result == MSPRING_OK && p < particles; ++p)
        network->contacts->materials[p] = values[p];
    mspringi_free(&network->memory, values);
    return result;
}

static mspring_result load_collider(mspring_network *network, mspringi_io *io) {
    mspringi_collider c = {.is_moving = false};
    mspring_result result = MSPRING_OK;
    double *points = NULL;
    (void)mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &c.def, sizeof c.def);
    hand_collider(io, &c);
    if (c.def.kind == MSPRING_COLLIDER_CHAIN)
        points = mspringi_chunk_array(network, io, 2 * (size_t)c.def.point_count, sizeof *points, &result);
    c.def.points = points;
    if (result == MSPRING_OK && (c.id < network->next_collider || c.id == MSPRING_NONE))
        result = mspringi_fail(&network->message, MSPRING_ERROR_SNAPSHOT, "collider %s comes in the wrong order",
                               MSPRINGI_ID(c.id));
    if (result == MSPRING_OK) {
        network->next_collider = c.id;
        result = mspring_network_add_collider(network, &c.def, NULL);
    }
    if (result == MSPRING_OK && c.is_moving)
        result = mspring_network_move_collider(network, c.id, c.target.x, c.target.y, c.target.angle);
    mspringi_free(&network->memory, points);
    return result;
}

// Steps make the room for pairs that is asked for beyond the default.
static mspring_result contact_load(mspring_network *network, mspringi_io *io) {
    contact_head head;
    (void)mspring_init(MSPRING_STRUCT_CONTACT_DEF, &head.def, sizeof head.def);
    hand_contact(io, &head);
    const uint32_t capacity = head.def.capacity;
    head.def.capacity = 0;
    mspring_result result = mspring_network_set_contact(network, &head.def);
    if (result == MSPRING_OK && capacity < mspringi_contacts_most_pairs(network->contacts)) {
        head.def.capacity = capacity;
        result = mspring_network_set_contact(network, &head.def);
    }
    if (result != MSPRING_OK)
        return result;
    mspringi_contacts *contacts = network->contacts;
    mspringi_hand(io, contacts->layers, contacts->particles, sizeof *contacts->layers);
    mspringi_hand(io, contacts->masks, contacts->particles, sizeof *contacts->masks);
    if (head.has_materials)
        result = load_materials(network, io);
    for (uint32_t i = 0; result == MSPRING_OK && !io->is_short && i < head.collider_count; ++i)
        result = load_collider(network, io);
    if (result == MSPRING_OK && head.event_capacity > 0)
        result = mspringi_contact_events_resize(network, mspringi_chunk_room(network, head.event_capacity));
    return result;
}

const mspringi_chunk mspringi_chunk_contact = {"cont", "contact", contact_save, contact_load, NULL};

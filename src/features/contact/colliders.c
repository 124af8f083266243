/// Shapes of the host: adding, moving and reading them.
#include "features/contact/contacts.h"

#include <math.h>
#include <string.h>

#include "base/assert.h"
#include "base/cpu.h"
#include "base/rotation.h"
#include "builder/builder.h"
#include "features/contact/floor.h"
#include "store/changed.h"

#define MOST_POINTS 0x1000000u

/* ----------------------------------------------------------------------------------------------------- checking */

static mspring_result check_pose(double x, double y, double angle, mspringi_message *message) {
    if (!mspringi_is_coordinate(x) || !mspringi_is_coordinate(y))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the collider's position is (%g, %g) m, it must be at most %g m in size", x, y,
                             MSPRING_MAX_COORDINATE);
    if (!(fabs(angle) <= MSPRINGI_MAX_ANGLE))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the collider's angle is %g rad, it must be at most %g rad in size", angle,
                             MSPRINGI_MAX_ANGLE);
    return MSPRING_OK;
}

static mspring_result check_size(const char *name, double value, bool may_be_0, mspringi_message *message) {
    if ((value > 0.0 || (may_be_0 && value == 0.0)) && mspringi_is_coordinate(value))
        return MSPRING_OK;
    return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                         "the collider's %s is %g m, it must be %s 0 and at most %g m", name, value,
                         may_be_0 ? ">=" : ">", MSPRING_MAX_COORDINATE);
}

static bool is_side(const double *a, const double *b) {
    const double x = b[0] - a[0], y = b[1] - a[1];
    return x * x + y * y > 0.0;
}

static mspring_result check_points(const mspring_collider_def *def, mspringi_message *message) {
    const bool is_closed = def->flags & MSPRING_COLLIDER_CLOSED;
    const uint32_t least = is_closed ? 3 : 2;
    if (def->point_count < least || def->point_count > MSPRING_MAX_COLLIDER_POINTS)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the collider has %u points, a%s chain must have %u to %u", (unsigned)def->point_count,
                             is_closed ? " closed" : "n open", (unsigned)least,
                             (unsigned)MSPRING_MAX_COLLIDER_POINTS);
    if (!def->points)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the collider's points are NULL");
    for (uint32_t i = 0; i < def->point_count; ++i) {
        const double *point = def->points + 2 * (size_t)i;
        if (!mspringi_is_coordinate(point[0]) || !mspringi_is_coordinate(point[1]))
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                 "the collider's point %u is (%g, %g) m, it must be at most %g m in size",
                                 (unsigned)i, point[0], point[1], MSPRING_MAX_COORDINATE);
    }
    for (uint32_t i = is_closed ? 0 : 1; i < def->point_count; ++i) {
        const uint32_t before = i > 0 ? i - 1 : def->point_count - 1;
        if (!is_side(def->points + 2 * (size_t)before, def->points + 2 * (size_t)i))
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                 "the collider's points %u and %u are the same, so the side between them has no "
                                 "length: leave one out",
                                 (unsigned)before, (unsigned)i);
    }
    return MSPRING_OK;
}

static mspring_result check_shape(const mspring_collider_def *def, mspringi_message *message) {
    mspring_result result = check_size("radius", def->radius, def->kind != MSPRING_COLLIDER_CIRCLE, message);
    if (def->kind == MSPRING_COLLIDER_CHAIN)
        return result == MSPRING_OK ? check_points(def, message) : result;
    if (def->kind == MSPRING_COLLIDER_BOX && result == MSPRING_OK)
        result = check_size("width", def->width, false, message);
    if (def->kind == MSPRING_COLLIDER_BOX && result == MSPRING_OK)
        result = check_size("height", def->height, false, message);
    if (result == MSPRING_OK && (def->point_count > 0 || def->flags != 0))
        result = mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                               "the collider is a %s with %u points and flags %#x: only chains have them",
                               def->kind == MSPRING_COLLIDER_BOX ? "box" : "circle", (unsigned)def->point_count,
                               (unsigned)def->flags);
    return result;
}

static mspring_result check_def(const mspring_collider_def *def, mspringi_message *message) {
    if (def->kind < MSPRING_COLLIDER_CHAIN || def->kind > MSPRING_COLLIDER_CIRCLE)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the collider's kind is %d, which is none",
                             (int)def->kind);
    if (def->flags & ~(uint32_t)MSPRING_COLLIDER_CLOSED)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "collider flags %#x are unknown",
                             (unsigned)def->flags);
    if (!(def->friction >= 0.0f && (double)def->friction <= MSPRINGI_MOST_FRICTION))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the collider's friction is %g, it must be 0 to %g",
                             (double)def->friction, MSPRINGI_MOST_FRICTION);
    if (!(def->restitution >= 0.0f && def->restitution <= 1.0f))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the collider's restitution is %g, it must be 0 to 1",
                             (double)def->restitution);
    const mspring_result result = check_pose(def->x, def->y, def->angle, message);
    return result == MSPRING_OK ? check_shape(def, message) : result;
}

/* ------------------------------------------------------------------------------------------------------- shapes */

static uint32_t points_of(const mspring_collider_def *def) {
    return def->kind == MSPRING_COLLIDER_CHAIN ? def->point_count : def->kind == MSPRING_COLLIDER_BOX ? 4 : 1;
}

static void write_shape(const mspring_collider_def *def, double *shape) {
    const double x = 0.5 * def->width, y = 0.5 * def->height;
    const double box[8] = {-x, -y, x, -y, x, y, -x, y};
    if (def->kind == MSPRING_COLLIDER_CHAIN)
        memcpy(shape, def->points, 2 * (size_t)def->point_count * sizeof *shape);
    else if (def->kind == MSPRING_COLLIDER_BOX)
        memcpy(shape, box, sizeof box);
    else
        shape[0] = shape[1] = 0.0;
}

// Set owner, layers and masks of all points, which lie in the order of their colliders' ids.
static void number_points(mspringi_contacts *contacts) {
    mspringi_colliders *all = &contacts->colliders;
    for (uint32_t i = 0; i < all->count; ++i) {
        const mspringi_collider *c = &all->list[i];
        for (uint32_t k = c->first; k < c->first + c->count; ++k) {
            all->owner[k] = i;
            contacts->layers[contacts->particles + k] = c->def.layers;
            contacts->masks[contacts->particles + k] = c->def.masks;
        }
    }
}

// Update everything that follows from the list of colliders, and wake all bodies.
static void update_after_change(mspring_network *network) {
    mspringi_colliders *all = &network->contacts->colliders;
    number_points(network->contacts);
    all->are_new = true;
    all->is_placed = false;
    mspringi_notify_change(network, MSPRINGI_CHANGED_CONTACT, 0);
}

/* --------------------------------------------------------------------------------------------- adding, removing */

static mspring_result make_room(mspring_network *network, uint32_t points) {
    const mspringi_colliders *all = &network->contacts->colliders;
    const uint32_t needed = all->point_count + points, twice = 2 * all->point_capacity;
    if (needed > MOST_POINTS)
        return mspringi_fail(&network->message, MSPRING_ERROR_LIMIT,
                             "the colliders would have %u points in all, they must have at most %u",
                             (unsigned)needed, (unsigned)MOST_POINTS);
    void *list = all->list;
    bool ok = mspringi_grow(&network->memory, &list, &network->contacts->colliders.capacity, (size_t)all->count + 1,
                            sizeof *all->list);
    network->contacts->colliders.list = list;
    if (ok && needed > all->point_capacity)
        ok = mspringi_contacts_reserve_points(network, needed > twice        ? needed
                                                       : twice < MOST_POINTS ? twice
                                                                             : MOST_POINTS);
    return ok ? MSPRING_OK
              : mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                              "no memory for collider %u of %u points, beside %u points of others",
                              (unsigned)network->next_collider, (unsigned)points, (unsigned)all->point_count);
}

static void append(mspring_network *network, const mspring_collider_def *def) {
    mspringi_colliders *all = &network->contacts->colliders;
    const uint32_t count = points_of(def);
    const bool is_open = def->kind == MSPRING_COLLIDER_CHAIN && !(def->flags & MSPRING_COLLIDER_CLOSED);
    MSPRINGI_ASSERT(all->count < all->capacity && all->point_count + count <= all->point_capacity);
    mspringi_collider *c = &all->list[all->count++];
    *c = (mspringi_collider){.def = *def,
                             .id = network->next_collider++,
                             .first = all->point_count,
                             .count = count,
                             .sides = is_open ? count - 1 : count,
                             .radius = def->radius,
                             .target = {def->x, def->y, def->angle}};
    write_shape(def, all->shape + 2 * (size_t)all->point_count);
    all->point_count += count;
    update_after_change(network);
}

mspring_result mspring_network_add_collider(mspring_network *network, const mspring_collider_def *def,
                                            mspring_id *collider) {
    mspring_collider_def taken;
    mspring_result result = mspringi_check_call(network);
    if (result == MSPRING_OK && !network->contacts)
        result = mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "colliders need contact: call mspring_network_set_contact() first");
    if (result == MSPRING_OK)
        result = mspringi_take_collider_def(&network->message, &def, &taken);
    if (result == MSPRING_OK)
        result = mspringi_check_reserved(&network->message, "mspring_collider_def", def->reserved_pointer != NULL);
    if (result == MSPRING_OK)
        result = check_def(def, &network->message);
    if (result == MSPRING_OK && network->next_collider == MSPRING_NONE)
        result = mspringi_fail(&network->message, MSPRING_ERROR_LIMIT, "all ids of colliders have been given away");
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    result = make_room(network, points_of(def));
    if (result == MSPRING_OK)
        append(network, def);
    mspringi_fp_leave(before);
    if (result == MSPRING_OK && collider)
        *collider = network->next_collider - 1;
    return result;
}

#define NO_COLLIDER "there is no collider %s"

// NULL if there is none.
static mspringi_collider *find(const mspringi_contacts *contacts, mspring_id id) {
    if (!contacts)
        return NULL;
    const mspringi_colliders *all = &contacts->colliders;
    uint32_t low = 0, high = all->count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (all->list[middle].id < id)
            low = middle + 1;
        else
            high = middle;
    }
    return low < all->count && all->list[low].id == id ? &all->list[low] : NULL;
}

static mspring_result find_or_fail(mspring_network *network, mspring_id id, mspringi_collider **found) {
    const mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    *found = find(network->contacts, id);
    return *found ? MSPRING_OK : mspringi_fail(&network->message, MSPRING_ERROR_ID, NO_COLLIDER, MSPRINGI_ID(id));
}

mspring_result mspring_network_remove_collider(mspring_network *network, mspring_id collider) {
    mspringi_collider *c;
    const mspring_result result = find_or_fail(network, collider, &c);
    if (result != MSPRING_OK)
        return result;
    mspringi_colliders *all = &network->contacts->colliders;
    const uint32_t count = c->count, end = c->first + count;
    memmove(all->shape + 2 * (size_t)c->first, all->shape + 2 * (size_t)end,
            2 * (size_t)(all->point_count - end) * sizeof *all->shape);
    MSPRINGI_ASSERT(end <= all->point_count);
    all->point_count -= count;
    all->count--;
    for (; c < all->list + all->count; ++c) {
        *c = c[1];
        c->first -= count;
    }
    update_after_change(network);
    return MSPRING_OK;
}

/* ------------------------------------------------------------------------------------------------------- moving */

// Find a collider and give it a target.
static mspring_result aim_at(mspring_network *network, mspring_id collider, mspringi_pose target,
                             mspringi_collider **found) {
    mspring_result result = find_or_fail(network, collider, found);
    if (result == MSPRING_OK)
        result = check_pose(target.x, target.y, target.angle, &network->message);
    if (result == MSPRING_OK)
        (*found)->target = target;
    return result;
}

mspring_result mspring_network_move_collider(mspring_network *network, mspring_id collider, double x, double y,
                                             double angle) {
    mspringi_collider *c;
    const mspring_result result = aim_at(network, collider, (mspringi_pose){x, y, angle}, &c);
    if (result == MSPRING_OK)
        c->is_moving = x != c->def.x || y != c->def.y || angle != c->def.angle;
    return result;
}

mspring_result mspring_network_place_collider(mspring_network *network, mspring_id collider, double x, double y,
                                              double angle) {
    mspringi_collider *c;
    const mspring_result result = aim_at(network, collider, (mspringi_pose){x, y, angle}, &c);
    if (result != MSPRING_OK)
        return result;
    c->is_moving = false;
    c->def.x = x;
    c->def.y = y;
    c->def.angle = angle;
    network->contacts->is_listed = network->contacts->is_fresh = false;
    network->contacts->colliders.is_placed = false;
    mspringi_notify_change(network, MSPRINGI_CHANGED_CONTACT, 0);
    return MSPRING_OK;
}

/* ------------------------------------------------------------------------------------------------------ reading */

mspring_result mspring_network_get_collider(const mspring_network *network, mspring_id collider,
                                            mspring_collider_def *def) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_collider_def, def);
    if (result != MSPRING_OK)
        return result;
    const mspringi_collider *c = find(network->contacts, collider);
    if (!c)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ID, NO_COLLIDER, MSPRINGI_ID(collider));
    mspring_collider_def had = c->def;
    had.points =
        had.kind == MSPRING_COLLIDER_CHAIN ? network->contacts->colliders.shape + 2 * (size_t)c->first : NULL;
    mspringi_put_collider_def(def, &had);
    return MSPRING_OK;
}

mspring_result mspring_network_get_collider_impulse(const mspring_network *network, mspring_id collider, double *x,
                                                    double *y, double *angular) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    if (!x || !y || !angular)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT, "the place for the impulse is NULL");
    const mspringi_collider *c = find(network->contacts, collider);
    if (!c)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ID, NO_COLLIDER, MSPRINGI_ID(collider));
    const bool is_of_last_step = network->contacts->colliders.reported == network->steps.count;
    *x = is_of_last_step ? c->impulse_x : 0.0;
    *y = is_of_last_step ? c->impulse_y : 0.0;
    *angular = is_of_last_step ? c->angular : 0.0;
    return MSPRING_OK;
}

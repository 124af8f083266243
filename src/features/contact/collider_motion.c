/// Motion of colliders in a step, and the impulses on them.
///
/// A collider moves and turns at constant speed in a step. In a substep its points move straight, as particles do,
/// so constraints treat both alike.
#include "features/contact/contacts.h"

#include "base/rotation.h"

/* ------------------------------------------------------------------------------------------------------ motion */

double mspringi_collider_spin(const mspringi_collider *collider, double dt) {
    return collider->is_moving ? (collider->target.angle - collider->def.angle) / dt : 0.0;
}

void mspringi_collider_velocity(const mspringi_collider *collider, double dt, double *vx, double *vy) {
    *vx = collider->is_moving ? (collider->target.x - collider->def.x) / dt : 0.0;
    *vy = collider->is_moving ? (collider->target.y - collider->def.y) / dt : 0.0;
}

static mspringi_pose pose_after(const mspringi_collider *c, uint32_t done, uint32_t substeps) {
    const mspringi_pose now = {c->def.x, c->def.y, c->def.angle};
    if (done == 0 || !c->is_moving)
        return now;
    if (done >= substeps)
        return c->target;
    const double part = (double)done / (double)substeps;
    return (mspringi_pose){now.x + part * (c->target.x - now.x), now.y + part * (c->target.y - now.y),
                           now.angle + part * (c->target.angle - now.angle)};
}

// Find the points of a collider in a pose, local coordinates.
static void put_points(const mspringi_colliders *all, const mspringi_collider *c, mspringi_pose pose, double *x,
                       double *y) {
    const mspringi_rotation turn = mspringi_rotation_by(pose.angle);
    const double local_x = pose.x - all->origin_x, local_y = pose.y - all->origin_y;
    for (uint32_t i = c->first; i < c->first + c->count; ++i) {
        const double u = all->shape[2 * i], v = all->shape[2 * i + 1];
        x[i] = local_x + (turn.cosine * u - turn.sine * v);
        y[i] = local_y + (turn.sine * u + turn.cosine * v);
    }
}

static void place_one(mspringi_colliders *all, const mspringi_collider *c, double h) {
    put_points(all, c, pose_after(c, all->done, all->substeps), all->x, all->y);
    if (c->is_moving)
        put_points(all, c, pose_after(c, all->done + 1, all->substeps), all->vx, all->vy);
    for (uint32_t i = c->first; i < c->first + c->count; ++i) {
        all->vx[i] = c->is_moving ? (all->vx[i] - all->x[i]) / h : 0.0;
        all->vy[i] = c->is_moving ? (all->vy[i] - all->y[i]) / h : 0.0;
    }
}

void mspringi_colliders_move_points(const mspring_network *network, mspringi_contacts *contacts, uint32_t done) {
    mspringi_colliders *all = &contacts->colliders;
    const bool is_known =
        all->is_placed && all->origin_x == network->origin_x && all->origin_y == network->origin_y;
    if (is_known && (done == all->done || !all->are_moving))
        return;
    all->origin_x = network->origin_x;
    all->origin_y = network->origin_y;
    all->done = done;
    for (uint32_t i = 0; i < all->count; ++i)
        if (!is_known || all->list[i].is_moving)
            place_one(all, &all->list[i], (double)contacts->h);
    all->is_placed = true;
}

/* ---------------------------------------------------------------------------------------------------- a step */

void mspringi_colliders_begin(const mspring_network *network, mspringi_contacts *contacts, uint32_t substeps) {
    mspringi_colliders *all = &contacts->colliders;
    all->are_moving = false;
    for (uint32_t i = 0; i < all->count; ++i)
        all->are_moving |= all->list[i].is_moving;
    all->is_placed &= !all->are_moving;
    all->substeps = substeps;
    mspringi_colliders_discard_step(contacts);
    mspringi_colliders_move_points(network, contacts, 0);
    contacts->is_fresh &= !all->are_moving;
}

void mspringi_colliders_discard_step(mspringi_contacts *contacts) {
    for (uint32_t i = 0; i < contacts->colliders.count; ++i) {
        mspringi_collider *c = &contacts->colliders.list[i];
        c->pushed_x = c->pushed_y = c->turned = 0.0;
    }
}

static bool is_point_of_collider(const mspringi_contacts *contacts, const mspringi_contact_constraint *t) {
    return mspringi_is_collider_point(contacts, contacts->nodes.particles[t->p]);
}

double mspringi_collider_friction_offset(const mspringi_contacts *contacts, const mspringi_contact_constraint *t) {
    return is_point_of_collider(contacts, t) ? contacts->colliders.list[t->collider].radius : 0.0;
}

double mspringi_collider_surface_speed(const mspringi_contacts *contacts, const mspringi_contact_constraint *t) {
    const mspringi_collider *c = &contacts->colliders.list[t->collider];
    const double arm = is_point_of_collider(contacts, t) ? c->radius : t->a == t->b ? t->distance : 0.0;
    return -mspringi_collider_spin(c, contacts->dt) * arm;
}

// The angular impulse is about the collider's place at the end of the step.
void mspringi_colliders_add_impulse(mspringi_contacts *contacts, const mspringi_contact_constraint *t,
                                    double normal_impulse, double tangent_impulse) {
    mspringi_colliders *all = &contacts->colliders;
    mspringi_collider *c = &all->list[t->collider];
    const mspringi_contact_nodes *k = &contacts->nodes;
    const mspringi_pose end = pose_after(c, all->substeps, all->substeps);
    const double sign = is_point_of_collider(contacts, t) ? 1.0 : -1.0,
                 grip = mspringi_collider_friction_offset(contacts, t);
    const double jx = sign * (normal_impulse * t->nx - tangent_impulse * t->ny),
                 jy = sign * (normal_impulse * t->ny + tangent_impulse * t->nx);
    const double arm_x = k->x[t->p] - grip * t->nx - (end.x - all->origin_x),
                 arm_y = k->y[t->p] - grip * t->ny - (end.y - all->origin_y);
    c->pushed_x += jx;
    c->pushed_y += jy;
    c->turned += arm_x * jy - arm_y * jx;
}

void mspringi_colliders_finish_step(const mspring_network *network, mspringi_contacts *contacts) {
    mspringi_colliders *all = &contacts->colliders;
    for (uint32_t i = 0; i < all->count; ++i) {
        mspringi_collider *c = &all->list[i];
        c->impulse_x = c->pushed_x;
        c->impulse_y = c->pushed_y;
        c->angular = c->turned;
        c->def.x = c->target.x;
        c->def.y = c->target.y;
        c->def.angle = c->target.angle;
        c->is_moving = false;
    }
    all->reported = network->steps.count + 1;
    all->is_placed &= !all->are_moving;
    contacts->is_fresh &= !all->are_moving;
    all->are_moving = false;
}

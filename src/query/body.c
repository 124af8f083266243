/// A set of particles as one body: position, angle, motion and box.
#include <math.h>

#include "base/cpu.h"
#include "base/rotation.h"
#include "features/poses/poses.h"
#include "step/origin.h"
#include "store/centre.h"

// Second moments about the centre of mass.
typedef struct second_moments {
    double inertia, spin;  ///< kg m^2; angular momentum, kg m^2/s
    double cosine, sine;   ///< of the best rotation, times a common factor
    double px, py, moment; ///< of free particles: momentum; angular momentum about the local origin
} second_moments;

// Compute the moments. cosine and sine are those of the rotation that takes the positions at creation nearest to
// the present ones (Kabsch 1976; in two dimensions they are sums of products). As the present ones are from their
// centre, those at creation may be from anywhere: from the first particle.
static second_moments second_moments_of(const mspring_network *network, const mspringi_selection *at,
                                        const mspringi_selection_centre *c) {
    const mspringi_state *s = &network->state;
    const mspringi_posed *first = NULL;
    second_moments m = {0};
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id p = mspringi_selected(at, i);
        const uint32_t slot = network->topology.slot_of_particle[p];
        if (!mspringi_particle_exists(network, p))
            continue;
        const double mass = (double)network->mass[p];
        const double x = mspringi_x_of(s, slot), y = mspringi_y_of(s, slot), dx = x - c->x, dy = y - c->y;
        const double vx = mspringi_vx_of(s, slot), vy = mspringi_vy_of(s, slot);
        m.inertia += mass * (dx * dx + dy * dy);
        m.spin += mass * (dx * (vy - c->vy) - dy * (vx - c->vx));
        if (mspringi_is_free(network, p)) {
            m.px += mass * vx;
            m.py += mass * vy;
            m.moment += mass * (x * vy - y * vx);
        }
        if (network->poses) {
            const mspringi_posed *pose = &network->poses->of_particle[p];
            first = first ? first : pose;
            m.cosine += mass * ((pose->x - first->x) * dx + (pose->y - first->y) * dy);
            m.sine += mass * ((pose->x - first->x) * dy - (pose->y - first->y) * dx);
        }
    }
    return m;
}

static double angle_of(const second_moments *m) {
    const double size = fmax(fabs(m->cosine), fabs(m->sine));
    if (!(size > 0.0))
        return 0.0;
    const double cosine = m->cosine / size, sine = m->sine / size, length = sqrt(cosine * cosine + sine * sine);
    return mspringi_angle_of((mspringi_rotation){cosine / length, sine / length});
}

static void add_box(const mspring_network *network, const mspringi_selection *at, mspring_body *to) {
    mspringi_box box = mspringi_box_empty();
    mspring_id head = MSPRING_NONE;
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id p = mspringi_selected(at, i);
        const uint32_t slot = network->topology.slot_of_particle[p];
        if (!mspringi_particle_exists(network, p))
            continue;
        mspringi_box_include(&box, mspringi_x_of(&network->state, slot), mspringi_y_of(&network->state, slot));
        head = p < head ? p : head;
    }
    if (head == MSPRING_NONE)
        box = (mspringi_box){0};
    to->head = head;
    to->min_x = network->origin_x + box.min_x;
    to->min_y = network->origin_y + box.min_y;
    to->max_x = network->origin_x + box.max_x;
    to->max_y = network->origin_y + box.max_y;
}

static MSPRINGI_NOINLINE mspring_body body_of(const mspring_network *network, const mspringi_selection *at) {
    const mspringi_selection_centre c = mspringi_selection_centre_of(network, at, true);
    const second_moments m = second_moments_of(network, at, &c);
    mspring_body made = {
        .particle_count = c.count,
        .mass = c.mass,
        .x = network->origin_x + c.x,
        .y = network->origin_y + c.y,
        .vx = c.vx,
        .vy = c.vy,
        .inertia = m.inertia,
        .angle = angle_of(&m),
        .spin = m.inertia > 0.0 ? m.spin / m.inertia : 0.0,
        .px = m.px,
        .py = m.py,
        .angular = m.moment + (network->origin_x * m.py - network->origin_y * m.px),
    };
    add_box(network, at, &made);
    return made;
}

mspring_result mspring_network_get_body(const mspring_network *network, const mspring_id *ids, mspring_id first,
                                        uint32_t count, mspring_body *body) {
    mspringi_selection at;
    mspring_result result = mspringi_check_report(network, &mspringi_struct_body, body);
    if (result == MSPRING_OK)
        result = mspringi_look_up(network, MSPRING_PARTICLES, ids, first, count, &at);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_body made = body_of(network, &at);
    mspringi_fp_leave(before);
    mspringi_put_body(body, &made);
    return MSPRING_OK;
}

/* -------------------------------------------------------------------------------------------------- components */

static mspring_result check_components(const mspring_network *network, uint32_t first, uint32_t count,
                                       const mspring_body *bodies, mspringi_message *message) {
    const mspringi_components *c = &network->components;
    if (!c->number)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the components are unknown: call mspring_network_update_components() first");
    if (first > c->count || count > c->count - first)
        return mspringi_fail(message, MSPRING_ERROR_ID, "%u components from number %s on: numbers are below %u",
                             (unsigned)count, MSPRINGI_ID(first), (unsigned)c->count);
    return count > 0 ? mspringi_check_output(message, &mspringi_struct_body, bodies) : MSPRING_OK;
}

mspring_result mspring_network_get_components(const mspring_network *network, uint32_t first, uint32_t count,
                                              mspring_body *bodies) {
    mspringi_message message;
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    const mspring_result result = check_components(network, first, count, bodies, &message);
    if (result != MSPRING_OK)
        return mspringi_shared_set(network->shared, result, &message);
    const mspringi_components *c = &network->components;
    const mspringi_fp_state before = mspringi_fp_enter();
    for (uint32_t i = 0; i < count; ++i) {
        const mspringi_selection at = {.list = c->particles + c->first[first + i], .count = c->size[first + i]};
        const mspring_body made = body_of(network, &at);
        mspringi_put_body_at(bodies, i, &made);
    }
    mspringi_fp_leave(before);
    return MSPRING_OK;
}

/// @file actors.c
/// Actors beside springs in the random networks of test_spec.c.
///
/// SPDX-License-Identifier: MIT
#include "actors.h"

#include "support.h"

/* ------------------------------------------------------------------------------------------------------ elements */

static bool is_twice(const spec_element *e, uint32_t particle) {
    bool is_there = false;
    for (uint32_t i = 0; i < e->count; i++) {
        is_there |= e->corners[i] == particle;
    }
    return is_there;
}

static uint32_t other_end(const spec_spring *spring, uint32_t p) {
    return spring->a == p ? spring->b : spring->b == p ? spring->a : SPEC_NONE;
}

/// Four corners that springs join in a ring. False: none were found.
static bool draw_ring(scene *s, spec_element *e) {
    for (uint32_t trial = 0, first = scene_below(s, s->spring_count); trial < s->spring_count; trial++) {
        const spec_spring *spring = &s->springs[(first + trial) % s->spring_count];
        for (uint32_t i = 0; i < s->spring_count; i++) {
            const uint32_t c = other_end(&s->springs[i], spring->b);
            for (uint32_t k = 0; c != SPEC_NONE && c != spring->a && k < s->spring_count; k++) {
                const uint32_t d = other_end(&s->springs[k], spring->a);
                for (uint32_t n = 0; d != SPEC_NONE && d != spring->b && d != c && n < s->spring_count; n++) {
                    if (other_end(&s->springs[n], c) == d) {
                        *e = (spec_element){.kind = e->kind, .count = 4, .corners = {spring->a, spring->b, c, d}};
                        return true;
                    }
                }
            }
        }
    }
    return false;
}

/// Corners of an element: the ends of a spring, and others nearby by number. False: there are too few.
static bool draw_corners(scene *s, spec_element *e, uint32_t count) {
    const spec_spring *spring = &s->springs[scene_below(s, s->spring_count)];
    e->corners[0] = spring->a;
    e->corners[1] = spring->b;
    e->count = 2;
    for (uint32_t i = 0; i < 50 && e->count < count; i++) {
        const uint32_t particle = scene_below(s, s->particle_count);
        const double dx = s->particles[particle].x - s->particles[spring->b].x,
                     dy = s->particles[particle].y - s->particles[spring->b].y;
        if (!is_twice(e, particle) && (i > 30 || dx * dx + dy * dy < 4)) {
            e->corners[e->count++] = particle;
        }
    }
    return e->count == count;
}

static bool add_area(const scene *s, mspring_network *library, spec_network *n, spec_element *e) {
    mspring_area_def def;
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &def, sizeof def));
    def.kind = e->kind == SPEC_GAS ? MSPRING_AREA_GAS : MSPRING_AREA_ELASTIC;
    def.stiffness = e->stiffness;
    def.pressure = e->pressure;
    def.fill = e->fill;
    double twice = 0;
    for (uint32_t i = 0; i < e->count; i++) {
        const scene_particle *here = &s->particles[e->corners[i]],
                             *next = &s->particles[e->corners[(i + 1) % e->count]];
        twice += (here->x - s->particles[e->corners[0]].x) * (next->y - s->particles[e->corners[0]].y) -
                 (here->y - s->particles[e->corners[0]].y) * (next->x - s->particles[e->corners[0]].x);
    }
    mspring_id id;
    if (mspring_network_add_area(library, &def, e->corners, e->count, &id) != MSPRING_OK) {
        return false; // too flat
    }
    mspring_area_def made = {.struct_size = sizeof made};
    check_ok(support_get_area(library, id, &made));
    const float rest_area = made.rest_area;
    made.rest_area *= 2;
    check_ok(support_set_area(library, id, &made));
    made.rest_area = rest_area; // a float from now on, which it need not be as it is made
    check_ok(support_set_area(library, id, &made));
    e->rest_area = made.rest_area;
    for (uint32_t i = 0; twice < 0 && i < e->count / 2; i++) {
        const uint32_t kept = e->corners[i];
        e->corners[i] = e->corners[e->count - 1 - i];
        e->corners[e->count - 1 - i] = kept;
    }
    spec_begin_element(n, e);
    return true;
}

static bool add_angle(mspring_network *library, spec_network *n, spec_element *e) {
    mspring_angle_def def;
    check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &def, sizeof def));
    def.stiffness = e->stiffness;
    def.damping = e->damping;
    def.rest_angle = 0; // straight
    e->fill = 1;
    e->rest_area = e->cosine = 1;
    e->pressure = 0;
    if (mspring_network_add_angles(library, &def, e->corners, 1, 3, NULL) != MSPRING_OK) {
        return false;
    }
    spec_begin_element(n, e);
    return true;
}

void actors_add_elements(scene *s, mspring_network *library, specification *to) {
    spec_network *n = &to->network;
    const uint32_t count = s->is_calm || s->spring_count == 0 || scene_chance(s, 0.7) ? 0 : 1 + scene_below(s, 6);
    for (uint32_t i = 0; i < count; i++) {
        spec_element e = {.kind = (spec_element_kind)scene_below(s, 3)};
        const uint32_t corners = e.kind == SPEC_ANGLE ? 3 : 3 + scene_below(s, 3);
        if (corners == 4 ? !draw_ring(s, &e) : !draw_corners(s, &e, corners)) {
            continue;
        }
        e.stiffness = e.kind == SPEC_GAS ? 0 : 0.1f * s->stiffness * (float)scene_between(s, 0, 1);
        e.damping = e.kind == SPEC_ANGLE ? s->damping * (float)scene_between(s, 0, 1) : 0;
        e.pressure = e.kind == SPEC_GAS ? 0.01f * s->stiffness : scene_chance(s, 0.5) ? 0 : (float)scene_between(s, -1, 1);
        e.fill = scene_chance(s, 0.5) ? 1 : (float)scene_between(s, 0.8, 1.2);
        if (e.kind == SPEC_ANGLE ? add_angle(library, n, &e) : add_area(s, library, n, &e)) {
            n->elements[n->element_count++] = e;
        }
    }
    spec_renew(n);
}

/* ------------------------------------------------------------------------------------- grips, actuators, hooks */

/// Force of the hook on a particle: a wind that grows with height.
static spec_vector wind_on(float y, spec_vector v) {
    return (spec_vector){0.1f * y - 0.2f * v.x, -0.2f * v.y};
}

static void MSPRING_CALL blow(const mspring_hook_args *args, void *user) {
    (void)user;
    for (size_t slot = args->first_slot; slot < (size_t)args->first_slot + args->slot_count; slot++) {
        const spec_vector force = wind_on(args->y[slot], (spec_vector){args->vx[slot], args->vy[slot]});
        args->force_x[slot] += force.x;
        args->force_y[slot] += force.y;
    }
}

static void blow_specified(const spec_network *n, spec_vector *forces) {
    for (uint32_t p = 0; p < n->particle_count; p++) {
        const spec_vector force = wind_on(n->motions[p].place.y, n->motions[p].velocity);
        forces[p] = (spec_vector){forces[p].x + force.x, forces[p].y + force.y};
    }
}

static void add_hook(scene *s, mspring_network *library, spec_network *n) {
    mspring_hook_def def;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def));
    def.phase = MSPRING_PHASE_BEFORE_SUBSTEP;
    def.fn = blow;
    def.period = n->hook_period = scene_chance(s, 0.5) ? 1 : 1 + scene_below(s, 6);
    check_ok(mspring_network_add_hook(library, &def, NULL));
    n->hook = blow_specified;
}

static void add_grips(scene *s, mspring_network *library, specification *to) {
    spec_network *n = &to->network;
    const uint32_t spread = scene_chance(s, 0.5) ? SCENE_GRIPS : 1 + scene_below(s, 2); // particles with grips
    for (uint32_t i = 0, first = scene_below(s, n->particle_count); i < SCENE_GRIPS && i < n->particle_count; i++) {
        mspring_grip_def def;
        check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &def, sizeof def));
        def.particle = (first + i % spread) % n->particle_count;
        def.stiffness = s->stiffness * (float)scene_between(s, 0, 10);
        def.damping = scene_chance(s, 0.5) ? 0 : (float)scene_between(s, 0, 100);
        def.max_force = scene_chance(s, 0.5) ? MSPRING_NEVER : s->stiffness;
        def.x = s->particles[def.particle].x + scene_between(s, -0.1, 0.1);
        def.y = s->particles[def.particle].y;
        check_ok(mspring_network_add_grip(library, &def, &to->grip_ids[i]));
        n->grips[n->grip_count++] =
            (spec_grip){def.particle, def.stiffness, def.damping, def.max_force, def.x, def.y, def.x, def.y};
    }
}

static void add_actuators(scene *s, mspring_network *library, specification *to) {
    for (uint32_t i = 0; i < s->spring_count && to->actuated_count < SCENE_ACTUATORS; i++) {
        if (s->springs[i].rest_length > 0 && scene_chance(s, 0.3)) {
            to->nominal[to->actuated_count] = s->springs[i].rest_length;
            to->actuated[to->actuated_count++] = i;
        }
    }
    to->network.changes = 1 + scene_below(s, 6);
    check_ok(mspring_network_set_actuators(library, to->actuated, to->actuated_count, to->network.changes));
}

void actors_add(scene *s, mspring_network *library, specification *to) {
    if (!s->is_calm && scene_chance(s, 0.15)) {
        add_hook(s, library, &to->network);
    }
    if (!s->is_calm && scene_chance(s, 0.3)) {
        add_grips(s, library, to);
    }
    if (!s->is_calm && s->spring_count > 0 && s->ductile == 0 && scene_chance(s, 0.2)) {
        add_actuators(s, library, to);
    }
}

void actors_act(scene *s, mspring_network *library, specification *to) {
    spec_network *n = &to->network;
    for (uint32_t i = 0; i < n->grip_count && scene_chance(s, 0.7); i++) {
        n->grips[i].x += scene_between(s, -0.1, 0.1);
        n->grips[i].y += scene_between(s, -0.1, 0.1);
        check_ok(mspring_network_move_grip(library, to->grip_ids[i], n->grips[i].x, n->grips[i].y));
    }
    const float signal = (float)scene_between(s, 0.4, 1.4);
    n->actuator_count = 0;
    for (uint32_t i = 0; i < to->actuated_count; i++) {
        check_ok(mspring_network_set(library, MSPRING_SIGNAL, NULL, i, 1, &signal, 1));
        n->actuators[n->actuator_count++] =
            (spec_actuator){to->actuated[i], s->springs[to->actuated[i]].rest_length, to->nominal[i] * signal};
    }
}

/// @file test_landings.c
/// Soft bodies that land on colliders so hard that triangles turn inside out: inner particles stay on their side, too.
/// The bits depend neither on when lists were made nor on their capacity.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "support.h"

enum { LANDINGS = 320, MOST = 14 * 10 };

#define STEPS_OF_FLIGHT 1.0 // s after the body has come down

typedef enum place { A_PLANE, A_VALLEY, A_DISC, A_BOX, PLACES } place;

typedef struct landing {
    mspring_network *network;
    place where;
    uint32_t count, width, steps;
    double thickness, radius, slope, width_of_box, height_of_box, dt;
    bool is_inside[MOST];
} landing;

static double decades(uint64_t *seed, double low, double high) {
    return low * pow(high / low, support_random_between(seed, 0, 1));
}

static mspring_network *make_body(landing *l, uint64_t *seed, double spacing) {
    static const uint16_t cells[MOST] = {0};
    mspring_builder *builder = support_builder();
    mspring_material material;
    mspring_lattice_def def;
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def));
    l->width = def.width = 3 + (uint32_t)support_random_between(seed, 0, 12);
    def.height = 3 + (uint32_t)support_random_between(seed, 0, 8);
    l->count = def.width * def.height;
    const double stiffness = decades(seed, 1e3, 1e4), rate = sqrt(12 * stiffness),
                 share = support_random_between(seed, 0.05, 0.5);
    l->dt = decades(seed, 1.0 / 240, 1.0 / 40);
    mspring_network_def network = support_def(-9.8f, (uint32_t)ceil(l->dt * rate / (2 * share)));
    material.mass = 1;
    material.stiffness = (float)stiffness;
    material.damping = (float)(decades(seed, 1e-4, 0.05) * network.settings.substeps / l->dt);
    def.cells = cells;
    def.materials = &material;
    def.material_count = 1;
    def.spacing = spacing;
    check_ok(mspring_builder_add_lattice(builder, &def, NULL));
    for (uint32_t i = 0; i < l->count; i++) {
        const uint32_t column = i % def.width, row = i / def.width;
        l->is_inside[i] = column > 0 && column + 1 < def.width && row > 0 && row + 1 < def.height;
    }
    return support_network(builder, &network);
}

static void add_collider(landing *l, uint64_t *seed) {
    mspring_collider_def def;
    mspring_id id;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    l->slope = support_random_between(seed, 0.2, 1);
    const double plane[] = {-300, -300 * l->slope, 300, 300 * l->slope},
                 valley[] = {-300, 300 * l->slope, 0, 0, 300, 300 * l->slope};
    def.points = l->where == A_PLANE ? plane : l->where == A_VALLEY ? valley : NULL;
    def.point_count = l->where == A_PLANE ? 2 : l->where == A_VALLEY ? 3 : 0;
    l->radius = support_random_between(seed, 2, 6);
    if (l->where == A_DISC) {
        def.kind = MSPRING_COLLIDER_CIRCLE;
        def.radius = l->radius;
    }
    if (l->where == A_BOX) {
        def.kind = MSPRING_COLLIDER_BOX;
        def.width = l->width_of_box = support_random_between(seed, 3, 12);
        def.height = l->height_of_box = support_random_between(seed, 3, 8);
    }
    check_ok(mspring_network_add_collider(l->network, &def, &id));
}

/// A body of any size, turned by any angle, that flies down.
static landing make_landing(uint32_t trial, uint32_t capacity) {
    uint64_t seed = 577 + 31 * (uint64_t)trial;
    landing l = {.where = (place)(trial % PLACES)};
    const double spacing = support_random_between(&seed, 0.3, 1), speed = support_random_between(&seed, 10, 40),
                 angle = support_random_between(&seed, 0, 6.28);
    l.network = make_body(&l, &seed, spacing);
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = l.thickness = spacing * support_random_between(&seed, 0.1, 0.5);
    contact.friction = trial % 3 ? 0 : 0.5f;
    contact.capacity = capacity;
    check_ok(mspring_network_set_contact(l.network, &contact));
    add_collider(&l, &seed);
    const double reach = 0.5 * spacing * hypot(l.width, (double)l.count / l.width);
    const double top = l.where == A_DISC    ? l.radius
                       : l.where == A_BOX   ? 0.5 * l.height_of_box
                                            : reach * (sqrt(1 + l.slope * l.slope) - 1);
    const float vx = 0, vy = (float)-speed;
    for (uint32_t i = 0; i < l.count; i++) {
        const double u = (i % l.width - 0.5 * (l.width - 1)) * spacing,
                     v = ((double)(i / l.width) - 0.5 * ((double)l.count / l.width - 1)) * spacing;
        const double x = cos(angle) * u - sin(angle) * v, y = sin(angle) * u + cos(angle) * v + top + reach + 0.5;
        check_ok(mspring_network_set_positions(l.network, NULL, i, 1, &x, &y, 1));
        check_ok(mspring_network_set_velocities(l.network, NULL, i, 1, &vx, &vy, 1));
    }
    l.steps = (uint32_t)((STEPS_OF_FLIGHT + (reach + 1) / speed) / l.dt);
    return l;
}

/// How far a point is beyond the surface, m.
static double beyond(const landing *l, double x, double y) {
    const double across = sqrt(1 + l->slope * l->slope);
    switch (l->where) {
    case A_PLANE: return (l->slope * x - y) / across;
    case A_VALLEY: return (l->slope * fabs(x) - y) / across;
    case A_DISC: return l->radius - hypot(x, y);
    default: return fmin(0.5 * l->width_of_box - fabs(x), 0.5 * l->height_of_box - fabs(y));
    }
}

static void step(const landing *l) {
    check_ok(mspring_network_step(l->network, l->dt));
}

static void inner_particles_stay_on_their_side(void **state) {
    (void)state;
    for (uint32_t trial = 0; trial < SAMPLE(LANDINGS); trial++) {
        const landing l = make_landing(trial, 0);
        for (uint32_t s = 0; s < l.steps; s++) {
            double x[MOST], y[MOST];
            step(&l);
            check_ok(mspring_network_get_positions(l.network, NULL, 0, l.count, x, y, 1));
            for (mspring_id p = 0; p < l.count; p++)
                if (l.is_inside[p] && !(beyond(&l, x[p], y[p]) <= l.thickness))
                    fail_msg("landing %u, step %u: particle %u is %g thicknesses beyond the surface", trial, s, p,
                             beyond(&l, x[p], y[p]) / l.thickness);
        }
        mspring_network_destroy(l.network);
    }
}

/// One body goes on; the other makes new lists in each step, begins with little room, and takes up a snapshot.
static void bits_depend_on_the_state_alone(void **state) {
    (void)state;
    for (uint32_t trial = 0; trial < SAMPLE(LANDINGS / 4); trial++) {
        const landing one = make_landing(trial, 0), other = make_landing(trial, 1);
        for (uint32_t s = 0; s < one.steps; s++) {
            step(&one);
            if (s % 16 == 15)
                support_bring(one.network, other.network, s % 32 == 15 ? MSPRING_SNAPSHOT_ALL : MSPRING_SNAPSHOT_FRAME);
            else {
                check_ok(support_set_layers(other.network, 0, one.count, 1, UINT32_MAX));
                step(&other);
            }
            if (support_hash(one.network) != support_hash(other.network))
                fail_msg("landing %u: other bits in step %u", trial, s);
        }
        mspring_network_destroy(one.network);
        mspring_network_destroy(other.network);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(inner_particles_stay_on_their_side),
                                       cmocka_unit_test(bits_depend_on_the_state_alone)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/// @file test_rain.c
/// Many particles without springs that rain on each other, on a bar and on colliders far larger than they are:
/// whoever meets is found, whenever the lists were made.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include "bodies.h"

#include "features/contact/contacts.h"

#define THICKNESS 0.5
#define DT (1.0 / 64)
#define DROPS 600u
#define BAR 36u
#define STEPS 96u

static void add_collider(mspring_network *network, mspring_collider_kind kind, double x, double y, double size) {
    mspring_collider_def def;
    mspring_id id;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    def.kind = kind;
    def.x = x;
    def.y = y;
    def.radius = kind == MSPRING_COLLIDER_CIRCLE ? size : 0;
    def.width = size;
    def.height = 1;
    check_ok(mspring_network_add_collider(network, &def, &id));
}

/// Ids say nothing of places. The bar is of another size than the drops, the circle and the box are far larger.
static mspring_network *rain(uint32_t substeps, bool has_colliders) {
    bodies *b = bodies_begin(DT / substeps);
    const bodies_lattice bar = {
        .width = BAR / 3, .height = 3, .x = 8, .y = 4, .angle = 0.3, .spacing = 1, .mass = 50, .f = 0.3};
    uint64_t seed = 11;
    (void)bodies_add(b, &bar);
    for (uint32_t i = 0; i < DROPS; i++) {
        const uint32_t place = i * 241u % DROPS; // 241 and DROPS have no divisor in common
        const bodies_lattice drop = {.width = 1,
                                     .height = 1,
                                     .x = -18 + 0.7 * (place % 50) + support_random_between(&seed, 0, 0.15),
                                     .y = 9 + 0.7 * (place / 50) + support_random_between(&seed, 0, 0.15),
                                     .spacing = 1,
                                     .mass = exp(support_random_between(&seed, 0, 3))};
        const uint32_t first = bodies_add(b, &drop);
        b->vx[first] = (float)support_random_between(&seed, -6, 6);
        b->vy[first] = (float)support_random_between(&seed, -12, 3);
    }
    const mspring_network_def def = support_def(-9.8f, substeps);
    mspring_network *network = bodies_network(b, &def);
    static const double planes[3][4] = {{0, 0, 0, 1}, {-20, 0, 1, 0}, {20, 0, -1, 0}};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = planes[0];
    floor.plane_count = 3;
    check_ok(mspring_network_set_floor(network, &floor));
    check_ok(bodies_touch(network, THICKNESS, 0.3f, 0.4f));
    if (has_colliders) {
        add_collider(network, MSPRING_COLLIDER_CIRCLE, -10, -1, 6);
        add_collider(network, MSPRING_COLLIDER_BOX, 10, 1, 14);
    }
    bodies_free(b);
    return network;
}

// True if the pair exists in the other order, too: two particles without springs, or one of them with a corner,
// which pairs by its edges.
static bool is_duplicate_pair(const mspringi_outline *o, mspring_id p, uint32_t edge) {
    const uint32_t own = o->at[o->first[p]];
    return o->a[edge] == o->b[edge] && (o->a[own] != o->b[own] || p > o->a[edge]);
}

/// The search rounds reaches up by 1e-6.
#define ROUNDED_UP (1.0 + 2e-6)

/// Whether the list lacks no pair that was near when it was made, and has no other; by brute force.
static void check_list(const mspring_network *network) {
    mspringi_contacts *contacts = network->contacts;
    const mspringi_outline *o = &contacts->outline;
    uint32_t listed = 0;
    for (uint32_t i = 0; i < o->point_count; i++)
        for (uint32_t edge = 0; edge < o->edge_count; edge++) {
            const mspring_id p = o->points[i], a = o->a[edge], b = o->b[edge];
            const bool is_collider = mspringi_is_collider_point(contacts, a),
                       is_apart = p < BAR && a < BAR &&
                                  (mspringi_outline_are_neighbours(network, contacts, p, a) ||
                                   mspringi_outline_are_neighbours(network, contacts, p, o->b[edge]));
            if (is_apart || p == a || (mspringi_is_collider_point(contacts, p) && is_collider) ||
                is_duplicate_pair(o, p, edge))
                continue;
            const mspringi_closest_point at =
                mspringi_closest_point_on_edge(contacts->seen_x[p], contacts->seen_y[p], contacts->seen_x[a],
                                               contacts->seen_y[a], contacts->seen_x[b], contacts->seen_y[b]);
            const double distance = sqrt(at.x * at.x + at.y * at.y) - mspringi_radius_of(contacts, p, edge);
            const double reach = contacts->thickness + contacts->margin[p] + mspringi_margin_of_edge(contacts, edge);
            const bool is_listed = listed < contacts->count && contacts->list[listed].point == p &&
                                   contacts->list[listed].edge == edge;
            assert_true(is_listed || !(distance < reach));
            assert_true(!is_listed || distance < ROUNDED_UP * reach);
            listed += is_listed;
        }
    assert_int_equal(listed, contacts->count);
}

/// Of two drops, m; by brute force.
static double deepest_of(const mspring_network *network) {
    double nearest = THICKNESS * THICKNESS, x[DROPS], y[DROPS];
    check_ok(mspring_network_get_positions(network, NULL, BAR, DROPS, x, y, 1));
    for (uint32_t i = 0; i < DROPS; i++)
        for (uint32_t j = 0; j < i; j++)
            nearest = fmin(nearest, (x[i] - x[j]) * (x[i] - x[j]) + (y[i] - y[j]) * (y[i] - y[j]));
    return THICKNESS - sqrt(nearest);
}

static void run(uint32_t substeps, bool has_colliders) {
    mspring_network *kept = rain(substeps, has_colliders), *anew = rain(substeps, has_colliders);
    mspring_contact_info info = {.struct_size = sizeof info};
    uint32_t touching = 0;
    for (uint32_t step = 0; step < STEPS; step++) {
        check_ok(support_set_layers(anew, 0, BAR + DROPS, 1, UINT32_MAX)); // drops the list
        support_steps(kept, 1, DT);
        support_steps(anew, 1, DT);
        assert_true(support_hash(kept) == support_hash(anew));
        assert_int_equal(kept->contacts->candidate_count, anew->contacts->candidate_count);
        assert_true(deepest_of(kept) < 0.1 * THICKNESS);
        if (step % 6 == 0)
            check_list(kept);
        check_ok(mspring_network_get_contact_info(kept, &info));
        touching = info.touching > touching ? info.touching : touching;
    }
    assert_true(touching > 300);
    mspring_network_destroy(kept);
    mspring_network_destroy(anew);
}

static void drops_meet_drops(void **state) {
    (void)state;
    run(4, false);
    run(30, false);
}

static void drops_meet_large_colliders(void **state) {
    (void)state;
    run(4, true);
    if (!ROUNDS_ARE_FEW)
        run(30, true);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drops_meet_drops),
        cmocka_unit_test(drops_meet_large_colliders),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

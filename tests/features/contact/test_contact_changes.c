/// @file test_contact_changes.c
/// Contact that is set again in the course of a game: what it keeps, and that room alone changes no bits.
///
/// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "bodies.h"

#include <massspring/massspring.h>

#define THICKNESS 0.5
#define DT (1.0 / 64)
#define SUBSTEPS 30
#define ROOM 512

/// Blocks that fall onto a rope and a paddle of the host. The last one is of a group that touches the paddle alone.
static mspring_network *heap(const mspring_allocator *allocator, uint32_t *ghost) {
    bodies *b = bodies_begin(DT / SUBSTEPS);
    *ghost = bodies_heap(b, 7, 2);
    mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    def.allocator = allocator;
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0.4f, 0.2f));
    check_ok(support_set_layers(network, *ghost, b->count - *ghost, 2, 4));
    check_ok(support_reserve_contact_events(network, 256));
    mspring_collider_def paddle;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &paddle, sizeof paddle));
    paddle.kind = MSPRING_COLLIDER_BOX;
    paddle.width = 2, paddle.x = -8.3, paddle.y = 6, paddle.layers = 5;
    check_ok(mspring_network_add_collider(network, &paddle, NULL));
    paddle.x = 400; // far from all
    check_ok(mspring_network_add_collider(network, &paddle, NULL));
    bodies_free(b);
    return network;
}

static void turn_paddle(mspring_network *network, uint32_t step) {
    check_ok(mspring_network_move_collider(network, 0, -8.3, 6, 0.05 * step));
}

static uint64_t mix(uint64_t hash, const void *bytes, size_t size) {
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ ((const uint8_t *)bytes)[i]) * 1099511628211u;
    return hash;
}

/// Of the state, the events that wait, the impulse of the paddle and the report: all that a host can see.
static uint64_t look(mspring_network *network, uint32_t *event_count) {
    static mspring_contact_event events[ROOM];
    const uint64_t state = support_hash(network);
    mspring_contact_info info = {.struct_size = sizeof info};
    double impulse[3];
    for (uint32_t i = 0; i < ROOM; i++)
        events[i].struct_size = sizeof events[i];
    check_ok(mspring_network_read_contact_events(network, events, ROOM, event_count, NULL));
    check_ok(mspring_network_get_collider_impulse(network, 0, &impulse[0], &impulse[1], &impulse[2]));
    check_ok(mspring_network_get_contact_info(network, &info));
    info.pairs = 0; // those that are looked at, of which there may be more
    uint64_t hash = mix(state, events, *event_count * sizeof *events);
    hash = mix(hash, impulse, sizeof impulse);
    return mix(hash, &info, sizeof info);
}

static mspring_contact_def contact_of(const mspring_network *network) {
    mspring_contact_def def = {.struct_size = sizeof def};
    check_ok(mspring_network_get_contact(network, &def));
    return def;
}

static void set_capacity(mspring_network *network, uint32_t capacity) {
    mspring_contact_def def = contact_of(network);
    def.capacity = capacity;
    check_ok(mspring_network_set_contact(network, &def));
}

/// No step may make more room.
static void set_fixed_capacity(mspring_network *network, uint32_t capacity) {
    mspring_contact_def def = contact_of(network);
    def.capacity = def.max_capacity = capacity;
    check_ok(mspring_network_set_contact(network, &def));
}

/// Between a move and its step, with events that wait.
static void room_alone_changes_no_bits(void **state) {
    (void)state;
    uint32_t ghost, count, other_count, events = 0;
    mspring_network *network = heap(NULL, &ghost), *other = heap(NULL, &ghost);
    for (uint32_t step = 1; step <= 200; step++) {
        turn_paddle(network, step);
        turn_paddle(other, step);
        if (step % 7 == 0)
            set_capacity(other, 6000 + 10 * step);
        support_steps(network, 1, DT);
        support_steps(other, 1, DT);
        if (step % 11 == 0)
            set_capacity(other, 0);
        if (step % 3 != 0)
            continue;
        assert_true(look(network, &count) == look(other, &other_count));
        assert_int_equal(count, other_count);
        events += count;
    }
    assert_true(events > 20);
    mspring_network_destroy(network);
    mspring_network_destroy(other);
}

/// Room alone wakes nothing, other numbers do.
static void sleepers_sleep_on_with_more_room(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    (void)bodies_add(b, &(bodies_lattice){.width = 12, .height = 1, .spacing = 1, .f = 0.1});
    (void)bodies_add(
        b, &(bodies_lattice){.width = 6, .height = 2, .y = 0.5 + THICKNESS, .spacing = 1, .mass = 5, .f = 0.3});
    mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    def.settings.global_damping = 2;
    def.settings.sleep_speed = 0.1f;
    def.settings.sleep_time = 0.5f;
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0.3f, 0));
    support_fall_asleep(network, DT);
    const uint64_t before = support_hash(network);
    set_capacity(network, 9000);
    assert_true(support_is_asleep(network));
    support_steps(network, 3, DT);
    assert_true(support_is_asleep(network) && support_hash(network) == before);
    mspring_contact_def contact = contact_of(network);
    contact.friction = 0.1f;
    check_ok(mspring_network_set_contact(network, &contact));
    assert_false(support_is_asleep(network));
    mspring_network_destroy(network);
    bodies_free(b);
}

/// A step that fails for want of room is repeated with more of it, as if there had always been enough.
static void refused_step_goes_on_with_more(void **state) {
    (void)state;
    uint32_t ghost, count, refused = 0;
    mspring_network *network = heap(NULL, &ghost), *enough = heap(NULL, &ghost);
    set_fixed_capacity(network, 4);
    for (uint32_t step = 1; step <= 100; step++) {
        turn_paddle(network, step);
        turn_paddle(enough, step);
        support_steps(enough, 1, DT);
        for (mspring_result result; (result = mspring_network_step(network, DT)) != MSPRING_OK; refused++) {
            assert_int_equal(result, MSPRING_ERROR_LIMIT);
            set_fixed_capacity(network, contact_of(network).capacity + 8);
        }
        assert_true(look(network, &count) == look(enough, &count));
    }
    assert_true(refused >= 3);
    mspring_network_destroy(network);
    mspring_network_destroy(enough);
}

static void add_block(mspring_builder *builder, uint32_t width, uint32_t height, double x, double y) {
    static const uint16_t cells[12 * 4];
    mspring_material material;
    mspring_lattice_def lattice;
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &material, sizeof material));
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &lattice, sizeof lattice));
    material.stiffness = 1e5f;
    lattice.width = width, lattice.height = height, lattice.x = x, lattice.y = y;
    lattice.cells = cells, lattice.materials = &material, lattice.material_count = 1;
    check_ok(mspring_builder_add_lattice(builder, &lattice, NULL));
}

/// A fast block comes to two that touch: the room that was there when a step began ends in the course of it. Pairs
/// that substeps keep from the list of before would be read in one that is not whole.
static void room_ends_within_a_step(void **state) {
    (void)state;
    uint32_t refused = 0;
    for (uint32_t capacity = 60; capacity <= 120; capacity += ROUNDS_ARE_FEW ? 12 : 3)
        for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
            mspring_builder *builder = support_builder();
            const float still = 0, fast = -60, slow = -3;
            add_block(builder, 12, 4, 0, 15);
            add_block(builder, 9, 3, 0.3, 3);
            add_block(builder, 12, 3, 0, -0.1);
            mspring_network_def def = support_def(0, solver == MSPRING_SOLVER_EXPLICIT ? SUBSTEPS : 8);
            def.settings.solver = solver;
            mspring_network *network = support_network(builder, &def);
            check_ok(mspring_network_set_velocities(network, NULL, 0, 12 * 4, &still, &fast, 0));
            check_ok(mspring_network_set_velocities(network, NULL, 12 * 4, 9 * 3, &still, &slow, 0));
            mspring_contact_def contact = bodies_contact(THICKNESS, 0, 0);
            contact.capacity = contact.max_capacity = capacity;
            check_ok(mspring_network_set_contact(network, &contact));
            for (uint32_t step = 0; step < 60; step++) {
                const uint64_t before = support_hash(network);
                const mspring_result result = mspring_network_step(network, DT);
                assert_true(result == MSPRING_OK || result == MSPRING_ERROR_LIMIT);
                assert_true(result == MSPRING_OK || support_hash(network) == before);
                refused += result == MSPRING_ERROR_LIMIT;
            }
            mspring_network_destroy(network);
        }
    assert_true(refused > 0);
}

/// Other numbers: groups, colliders with their ids and moves, and events stay.
static void other_numbers_keep_the_rest(void **state) {
    (void)state;
    uint32_t ghost, count = 0;
    mspring_network *network = heap(NULL, &ghost);
    for (uint32_t step = 1; step <= 60; step++) {
        turn_paddle(network, step);
        support_steps(network, 1, DT);
    }
    turn_paddle(network, 61);
    mspring_contact_def def = contact_of(network);
    def.friction = 0;
    def.restitution = 0.5f;
    def.thickness = 0.3;
    def.sweeps = 6;
    def.flags = 0;
    check_ok(mspring_network_set_contact(network, &def));
    const mspring_contact_def is = contact_of(network);
    assert_true(is.thickness == 0.3 && is.friction == 0 && is.sweeps == 6 && is.flags == 0);
    mspring_contact_event event = {.struct_size = sizeof event};
    check_ok(mspring_network_read_contact_events(network, &event, 1, &count, NULL));
    assert_int_equal(count, 1);
    mspring_collider_def collider = {.struct_size = sizeof collider};
    check_ok(mspring_network_get_collider(network, 1, &collider));
    assert_true(collider.width == 2 && collider.x == 400);
    support_steps(network, 1, DT);
    check_ok(mspring_network_get_collider(network, 0, &collider));
    assert_true(collider.angle == 0.05 * 61);
    mspring_id added = 0;
    check_ok(mspring_network_add_collider(network, &collider, &added));
    assert_int_equal(added, 2);
    support_steps(network, 300, DT); // what touches nothing but the paddle has fallen through the rope
    assert_true(support_position(network, ghost).y < -5);
    check_ok(mspring_network_set_contact(network, NULL));
    check_ok(mspring_network_set_contact(network, &def));
    check_error(mspring_network_get_collider(network, 0, &collider), MSPRING_ERROR_ID);
    mspring_network_destroy(network);
}

/// Snapshots of two networks have the same bytes.
static void check_contact_alike(const mspring_network *a, const mspring_network *b) {
    const mspring_network *const both[] = {a, b};
    static uint8_t bytes[2][1 << 16];
    size_t size[2];
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_network_get_snapshot_size(both[i], MSPRING_SNAPSHOT_ALL, &size[i]));
        assert_true(size[i] <= sizeof bytes[i]);
        check_ok(mspring_network_save(both[i], MSPRING_SNAPSHOT_ALL, bytes[i], size[i], NULL));
    }
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(bytes[0], bytes[1], size[0]);
}

/// The outline keeps the shape that it was found by, however the body lies now; contact that is new does not.
static void outline_keeps_its_shape(void **state) {
    (void)state;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    (void)bodies_add(b, &(bodies_lattice){.width = 5, .height = 4, .spacing = 1, .mass = 1, .f = 0.1});
    const mspring_network_def def = support_def(0, SUBSTEPS);
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, 0.3, 0, 0));
    support_steps(network, 1, DT);
    mspring_contact_info info = {.struct_size = sizeof info}, now = info;
    check_ok(mspring_network_get_contact_info(network, &info));
    for (uint32_t p = 0; p < b->count; p++) // folded in the middle
        b->x[p] = b->column[p] > 2 ? 4 - b->x[p] : b->x[p];
    check_ok(mspring_network_set_positions(network, NULL, 0, b->count, b->x, b->y, 1));
    mspring_network *before;
    check_ok(mspring_network_clone(network, NULL, &before));
    mspring_contact_def contact = contact_of(network);
    contact.thickness = 0.2;
    check_ok(mspring_network_set_contact(network, &contact));
    check_ok(mspring_network_get_contact_info(network, &now));
    assert_int_equal(now.edges, info.edges);
    contact.thickness = 0.3; // as it was, and all else with it
    check_ok(mspring_network_set_contact(network, &contact));
    check_contact_alike(before, network);
    mspring_network_destroy(before);
    check_ok(mspring_network_set_contact(network, NULL));
    check_ok(mspring_network_set_contact(network, &contact));
    check_ok(mspring_network_get_contact_info(network, &now));
    assert_int_not_equal(now.edges, info.edges);
    mspring_network_destroy(network);
    bodies_free(b);
}

/// Where memory fails, the network goes on as if nothing had been asked.
static void change_without_memory_changes_nothing(void **state) {
    (void)state;
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    uint32_t ghost, count, failures = 0;
    mspring_network *network = heap(&allocator, &ghost), *same = heap(NULL, &ghost);
    const size_t used = support_memory_used(network);
    mspring_contact_def def = contact_of(network);
    def.capacity += 1000;
    for (mspring_result result = MSPRING_ERROR_MEMORY; result != MSPRING_OK; failures++) {
        turn_paddle(network, failures);
        turn_paddle(same, failures);
        watched.fail_at = watched.calls + 1 + failures;
        result = mspring_network_set_contact(network, &def);
        watched.fail_at = 0;
        assert_true(result == MSPRING_OK || result == MSPRING_ERROR_MEMORY);
        assert_true(result == MSPRING_OK || support_memory_used(network) == used);
        support_steps(network, 3, DT);
        support_steps(same, 3, DT);
        assert_true(look(network, &count) == look(same, &count));
    }
    assert_true(failures > 10);
    assert_true(support_memory_used(network) > used);
    mspring_network_destroy(network);
    mspring_network_destroy(same);
    check_watched_clean(&watched);
}

/// A spring inside a body becomes its surface where one of the two triangles beside it breaks, though contact has
/// looked at that triangle from the broken spring's end last.
static void a_break_lays_an_edge_bare(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    const mspring_id left = support_pinned(builder, 0, 0, 1), top = support_pinned(builder, 3.3, 0.8, 1),
                     bottom = support_pinned(builder, 2, -4, 1), right = support_pinned(builder, 4, 0, 1),
                     ball = support_particle(builder, 2, 3, 1);
    (void)support_spring(builder, left, right, 100, 0);
    (void)support_spring(builder, left, top, 100, 0);
    const mspring_id breaks = support_spring(builder, right, top, 100, 0);
    (void)support_spring(builder, left, bottom, 100, 0);
    (void)support_spring(builder, right, bottom, 100, 0);
    const mspring_network_def def = support_def(-9.8f, 8);
    mspring_network *network = support_network(builder, &def);
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    contact.thickness = THICKNESS;
    check_ok(mspring_network_set_contact(network, &contact));
    support_steps(network, 32, DT); // the ball is fast enough by then for contact to look at far edges
    const double x = 0, y = 4;
    check_ok(mspring_network_break_springs(network, &breaks, 0, 1));
    check_ok(mspring_network_set_positions(network, &top, 0, 1, &x, &y, 1)); // out of the ball's way
    support_steps(network, 200, DT);
    // Contact leaves some thousandths of its thickness.
    check_near(support_position(network, ball).y, THICKNESS, 0.01);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(room_alone_changes_no_bits),     cmocka_unit_test(sleepers_sleep_on_with_more_room),
        cmocka_unit_test(refused_step_goes_on_with_more), cmocka_unit_test(room_ends_within_a_step),
        cmocka_unit_test(other_numbers_keep_the_rest),    cmocka_unit_test(outline_keeps_its_shape),
        cmocka_unit_test(a_break_lays_an_edge_bare),      cmocka_unit_test(change_without_memory_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/// @file test_contact_surfaces.c
/// Friction and restitution of particles of their own, and how they act on each other.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#include "allocator.h"
#include "bodies.h"

#include <massspring/massspring.h>

#define THICKNESS 0.5
#define DT (1.0 / 64)
#define SUBSTEPS 40

/// A block on level ground, and gravity that is tilted. The ground is a rope or a collider.
typedef struct slope {
    mspring_solver solver;
    float contact, collider; ///< friction, of colliders; < 0: the ground is a rope
    float block, ground;     ///< of its own
    double expected;         ///< friction of the two
} slope;

static void add_ground(mspring_network *network, float friction) {
    mspring_collider_def def;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    def.kind = MSPRING_COLLIDER_BOX;
    def.width = 60;
    def.y = -THICKNESS - 0.5;
    def.friction = friction;
    check_ok(mspring_network_add_collider(network, &def, NULL));
}

/// The block slides as Coulomb's law has it: two seconds at an angle at which it does.
static void check_slide(const slope *s) {
    const double angle = 0.5;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    b->damping = 0.3;
    uint32_t first = 0;
    if (s->collider < 0)
        first = bodies_add(b, &(bodies_lattice){.width = 60, .height = 1, .y = -THICKNESS, .spacing = 1, .f = 0.1});
    first = bodies_add(
        b, &(bodies_lattice){.width = 8, .height = 3, .x = -15.3, .y = 1, .spacing = 1, .mass = 73.4, .f = 0.5});
    mspring_network_def def = support_def(0, s->solver == MSPRING_SOLVER_EXPLICIT ? SUBSTEPS : 4);
    def.settings.solver = s->solver;
    mspring_network *network = bodies_network(b, &def);
    check_ok(support_set_gravity(network, (float)(9.8 * sin(angle)), (float)(-9.8 * cos(angle))));
    check_ok(bodies_touch(network, THICKNESS, s->contact, 0));
    if (s->collider >= 0)
        add_ground(network, s->collider);
    check_ok(support_set_surface(network, 0, first, s->ground, -1));
    check_ok(support_set_surface(network, first, b->count - first, s->block, -1));
    support_steps(network, 128, DT);
    (void)bodies_measured(b, network);
    double v = 0;
    for (uint32_t p = first; p < b->count; p++)
        v += (double)b->vx[p] / (b->count - first);
    const double expected = 2 * 9.8 * (sin(angle) - s->expected * cos(angle));
    check_near(v, expected, 0.05 * 2 * 9.8 * sin(angle)); // as of test_resting.c, of what pulls
    mspring_network_destroy(network);
    bodies_free(b);
}

static void friction_is_the_root_of_the_product(void **state) {
    (void)state;
    static const slope slopes[] = {
        {MSPRING_SOLVER_EXPLICIT, 0.1f, -1, 0.04f, 0.36f, 0.12},
        {MSPRING_SOLVER_IMPLICIT, 0.1f, -1, 0.04f, 0.36f, 0.12},
        {MSPRING_SOLVER_DIRECT, 0.1f, -1, 0.04f, 0.36f, 0.12},
        {MSPRING_SOLVER_EXPLICIT, 0.4f, -1, 0.1f, -1, 0.2},
        {MSPRING_SOLVER_EXPLICIT, 0, -1, 0.25f, 0.25f, 0.25},
        {MSPRING_SOLVER_EXPLICIT, 0.4f, -1, 0, -1, 0},
        {MSPRING_SOLVER_EXPLICIT, 0.1f, 0.4f, 0.1f, -1, 0.2},
        {MSPRING_SOLVER_EXPLICIT, 0.1f, 0.3f, -1, -1, 0.3},
    };
    for (size_t i = 0; i < COUNT_OF(slopes); i++)
        check_slide(&slopes[i]);
}

/// A loose particle that falls 5 m comes back with the larger restitution of the two.
static void check_bounce(float contact, float ball_has, float ground_has, double expected) {
    const uint32_t substeps = 120;
    bodies *b = bodies_begin(DT / substeps);
    (void)bodies_add(b, &(bodies_lattice){.width = 5, .height = 1, .y = -THICKNESS, .spacing = 1, .f = 0.1});
    const uint32_t ball =
        bodies_add(b, &(bodies_lattice){.width = 1, .height = 1, .x = 0.2, .y = 5, .spacing = 1, .mass = 3});
    const mspring_network_def def = support_def(-9.8f, substeps);
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0, contact));
    check_ok(support_set_surface(network, 0, ball, -1, ground_has));
    check_ok(support_set_surface(network, ball, 1, -1, ball_has));
    float back = 0;
    for (int step = 0; step < 80 && back <= 0; step++) {
        support_steps(network, 1, DT);
        back = (float)support_velocity(network, ball).y;
    }
    const double risen = support_position(network, ball).y + (double)back * (double)back / (2 * 9.8);
    check_near(sqrt(risen / 5), expected, 0.01); // as of test_resting.c
    mspring_network_destroy(network);
    bodies_free(b);
}

static void restitution_is_the_larger_one(void **state) {
    (void)state;
    check_bounce(0, 0.8f, 0.3f, 0.8);
    check_bounce(0, 0.3f, 0.8f, 0.8);
    check_bounce(0.5f, 0.2f, -1, 0.5);
    check_bounce(0.9f, 0.2f, 0.4f, 0.4);
}

static uint64_t run(mspring_network *network, uint32_t steps) {
    uint64_t hash = 0;
    for (uint32_t step = 0; step < steps; step++) {
        support_steps(network, 1, DT);
        hash = (hash << 7 | hash >> 57) ^ support_hash(network);
    }
    return hash;
}

/* -------------------------------------------------------------------------------------------------- on the floor
 */

/// A floor that is a plane or has heights, with these values.
static void lay_floor(mspring_network *network, bool has_heights, float friction, float restitution) {
    static const double plane[4] = {0, 0, 0, 1};
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.planes = plane;
    def.plane_count = has_heights ? 0 : 1;
    def.height_count = has_heights ? 1 : 0;
    def.friction = friction;
    def.restitution = restitution;
    check_ok(mspring_network_set_floor(network, &def));
}

/// What slides down a tilted floor as Coulomb's law has it: a block with another on top, and a loose particle.
static void check_floor_slide(mspring_solver solver, bool has_heights, float floor, float own, double expected) {
    const double angle = 0.5;
    bodies *b = bodies_begin(DT / SUBSTEPS);
    b->damping = 0.3;
    (void)bodies_add(b, &(bodies_lattice){.width = 8, .height = 3, .y = 1, .spacing = 1, .mass = 73.4, .f = 0.5});
    const uint32_t upper = bodies_add(
        b, &(bodies_lattice){.width = 3, .height = 2, .y = 2.5 + THICKNESS, .spacing = 1, .mass = 20, .f = 0.5});
    const uint32_t loose = bodies_add(b, &(bodies_lattice){.width = 1, .height = 1, .x = 90, .spacing = 1, .mass = 3});
    mspring_network_def def = support_def(0, solver == MSPRING_SOLVER_EXPLICIT ? SUBSTEPS : 4);
    def.settings.solver = solver;
    mspring_network *network = bodies_network(b, &def);
    check_ok(support_set_gravity(network, (float)(9.8 * sin(angle)), (float)(-9.8 * cos(angle))));
    check_ok(bodies_touch(network, THICKNESS, 0.5f, 0));
    lay_floor(network, has_heights, floor, 0);
    check_ok(support_set_surface(network, 0, upper, own, -1));
    check_ok(support_set_surface(network, loose, 1, own, -1));
    support_steps(network, 128, DT);
    (void)bodies_measured(b, network);
    double v = 0;
    for (uint32_t p = 0; p < loose; p++)
        v += (double)b->vx[p] / loose;
    const double without = 2 * 9.8 * sin(angle), left = without - 2 * 9.8 * expected * cos(angle);
    check_near(v, left, 0.005 * without);
    check_near((double)support_velocity(network, loose).x, left, 0.005 * without);
    mspring_network_destroy(network);
    bodies_free(b);
}

static void on_the_floor_friction_is_the_root_of_the_product(void **state) {
    (void)state;
    static const struct {
        float floor, own;
        double expected;
    } ways[] = {{0.3f, -1, 0.3}, {0.04f, 0.36f, 0.12}, {0.3f, 0, 0}, {0, 2, 0}};
    for (size_t i = 0; i < COUNT_OF(ways); i++)
        for (int has_heights = 0; has_heights < 2; has_heights++)
            for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++)
                check_floor_slide(solver, has_heights, ways[i].floor, ways[i].own, ways[i].expected);
}

/// A loose particle that falls 5 m, with every solver; a pair with a soft spring, with the explicit one.
static void check_floor_bounce(mspring_solver solver, bool has_heights, float floor, float own, double expected) {
    mspring_builder *builder = support_builder();
    const mspring_id a = support_particle(builder, 0, 5, 1), b = support_particle(builder, 3, 5, 1);
    support_spring(builder, a, b, 1, 0);
    const mspring_id ball = support_particle(builder, 20, 5, 3);
    mspring_network_def def = support_def(-9.8f, 120);
    def.settings.solver = solver;
    mspring_network *network = support_network(builder, &def);
    check_ok(bodies_touch(network, THICKNESS, 0, 0.1f));
    lay_floor(network, has_heights, 0.2f, floor);
    check_ok(support_set_surface(network, 0, 3, -1, own));
    float back = 0;
    for (int step = 0; step < 80 && back <= 0; step++) {
        support_steps(network, 1, DT);
        back = (float)support_velocity(network, ball).y;
    }
    for (mspring_id p = solver == MSPRING_SOLVER_EXPLICIT ? a : ball; p <= ball; p++) {
        const double v = (double)support_velocity(network, p).y;
        check_near(sqrt((support_position(network, p).y + v * v / (2 * 9.8)) / 5), expected, 0.01);
    }
    mspring_network_destroy(network);
}

static void on_the_floor_restitution_is_the_larger_one(void **state) {
    (void)state;
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++)
        for (int has_heights = 0; has_heights < 2; has_heights++) {
            check_floor_bounce(solver, has_heights, 0, 0.8f, 0.8);
            check_floor_bounce(solver, has_heights, 0.8f, 0.3f, 0.8);
            check_floor_bounce(solver, has_heights, 0.5f, -1, 0.5);
        }
}

/// A block and loose particles that fall into a valley between walls.
static uint64_t fall(mspring_solver solver, mspring_simd level, uint32_t workers, float friction, float restitution,
                     bool is_mixed) {
    static const float heights[] = {4, 1, 0.5f, -1, 0.25f, 2, 5}, frictions[] = {0.4f, 0.4f, 0.4f, 0.4f, 0.4f, 0.4f};
    static const double walls[2][4] = {{-4, 0, 1, 0.3}, {30, 0, -1, 0.2}};
    bodies *b = bodies_begin(DT / SUBSTEPS);
    (void)bodies_add(b, &(bodies_lattice){.width = 20, .height = 5, .y = 3, .spacing = 1, .f = 0.3});
    for (int i = 0; i < 24; i++)
        (void)bodies_add(
            b, &(bodies_lattice){.width = 1, .height = 1, .x = i, .y = 10 + 0.5 * i, .spacing = 1, .mass = 2});
    mspring_network_def def = support_def(-9.8f, solver == MSPRING_SOLVER_EXPLICIT ? SUBSTEPS : 3);
    def.settings.solver = solver;
    def.simd_level = level;
    def.worker_count = workers;
    mspring_network *network = bodies_network(b, &def);
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = walls[0], floor.plane_count = 2;
    floor.heights = heights, floor.height_count = COUNT_OF(heights), floor.spacing = 5, floor.heights_x = -5;
    floor.height_frictions = frictions, floor.friction = 0.4f, floor.restitution = 0.3f;
    check_ok(mspring_network_set_floor(network, &floor));
    check_ok(bodies_touch(network, THICKNESS, 0.4f, 0.3f));
    if (friction != -2)
        for (mspring_id p = 0; p < b->count; p += is_mixed ? 3 : 1)
            check_ok(support_set_surface(network, p, 1, p % 2 || !is_mixed ? friction : -1,
                                         p % 5 || !is_mixed ? restitution : -1));
    const uint64_t hash = run(network, 90);
    mspring_network_destroy(network);
    bodies_free(b);
    return hash;
}

/// The floor's own values, given or not, change no bits. Others do, alike at every level and with any workers.
static void bits_on_the_floor_are_of_the_values_alone(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    for (mspring_solver solver = MSPRING_SOLVER_EXPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        const uint64_t plain = fall(solver, MSPRING_SIMD_AUTO, 1, -2, 0, false);
        assert_true(fall(solver, MSPRING_SIMD_AUTO, 1, -1, -1, false) == plain);
        assert_true(fall(solver, MSPRING_SIMD_AUTO, 1, 0.4f, 0.3f, false) == plain);
        const uint64_t own = fall(solver, MSPRING_SIMD_AUTO, 1, 1.5f, 0.7f, true);
        assert_true(own != plain);
        for (uint32_t i = 0; i < count; i++)
            assert_true(fall(solver, levels[i], i % 3 + 1, 1.5f, 0.7f, true) == own);
    }
}

/* -------------------------------------------------------------------------------------------------------- bits */

/// Blocks that fall onto each other and onto a collider.
static mspring_network *heap(const mspring_allocator *allocator, mspring_simd level, uint32_t workers) {
    bodies *b = bodies_begin(DT / SUBSTEPS);
    (void)bodies_heap(b, 6, 3);
    mspring_network_def def = support_def(-9.8f, SUBSTEPS);
    def.allocator = allocator;
    def.simd_level = level;
    def.worker_count = workers;
    mspring_network *network = bodies_network(b, &def);
    check_ok(bodies_touch(network, THICKNESS, 0.4f, 0.3f));
    add_ground(network, 0.2f);
    bodies_free(b);
    return network;
}

static void set_own(mspring_network *network) {
    check_ok(support_set_surface(network, 0, 24, 0.05f, 0.7f));
    check_ok(support_set_surface(network, 30, 20, 2, 0));
}

/// The contact's own values, given or not, change no bits. Others do, alike at every level and with any workers.
static void bits_are_of_the_values_alone(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    mspring_network *plain = heap(NULL, MSPRING_SIMD_AUTO, 1), *same = heap(NULL, MSPRING_SIMD_AUTO, 1);
    check_ok(support_set_surface(same, 0, mspring_network_count(same, MSPRING_PARTICLES), -1, -1));
    check_ok(mspring_network_remove_collider(same, 0));
    check_ok(mspring_network_remove_collider(plain, 0));
    check_ok(support_set_surface(same, 9, 30, 0.4f, 0.3f));
    const uint64_t without = run(plain, 120);
    assert_true(run(same, 120) == without);
    uint64_t first = 0;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t workers = 1; workers <= 3; workers += 2) {
            mspring_network *network = heap(NULL, levels[i], workers);
            set_own(network);
            const uint64_t hash = run(network, 120);
            first = i == 0 && workers == 1 ? hash : first;
            assert_true(hash == first);
            mspring_network_destroy(network);
        }
    assert_true(first != without);
    mspring_network_destroy(plain);
    mspring_network_destroy(same);
}

/// Clones have them, contact that is set again keeps them, and contact that is new has none.
static void they_stay_with_contact(void **state) {
    (void)state;
    mspring_network *network = heap(NULL, MSPRING_SIMD_AUTO, 1), *clone, *plain = heap(NULL, MSPRING_SIMD_AUTO, 1);
    mspring_contact_def def = {.struct_size = sizeof def};
    set_own(network);
    check_ok(mspring_network_clone(network, NULL, &clone));
    check_ok(mspring_network_get_contact(clone, &def));
    def.capacity += 100;
    check_ok(mspring_network_set_contact(clone, &def));
    add_ground(clone, 0.2f);
    add_ground(network, 0.2f);
    const uint64_t hash = run(network, 100);
    assert_true(run(clone, 100) == hash);
    mspring_network_destroy(clone);
    check_ok(mspring_network_clone(plain, NULL, &clone));
    set_own(clone);
    for (int i = 0; i < 2; i++) {
        mspring_network *both[] = {clone, plain};
        check_ok(mspring_network_set_contact(both[i], NULL));
        check_ok(mspring_network_set_contact(both[i], &def));
    }
    const uint64_t of_new = run(plain, 100);
    assert_true(run(clone, 100) == of_new);
    mspring_network_destroy(network);
    mspring_network_destroy(clone);
    mspring_network_destroy(plain);
}

/* -------------------------------------------------------------------------------------------------------- errors
 */

static void bad_calls_are_rejected(void **state) {
    (void)state;
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    mspring_network *network = heap(&allocator, MSPRING_SIMD_AUTO, 1);
    const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
    const float wrong[] = {NAN, INFINITY, -INFINITY, -0.5f, -2, 1.1e6f}, zero = 0, more = 1.01f;
    for (size_t i = 0; i < COUNT_OF(wrong); i++) {
        check_error(support_set_surface(network, 0, 1, wrong[i], 0), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "friction");
        check_error(mspring_network_set(network, MSPRING_RESTITUTION, NULL, 0, 1, &wrong[i], 1), MSPRING_ERROR_ARGUMENT);
        check_contains(mspring_network_error(network), "restitution");
    }
    check_error(mspring_network_set(network, MSPRING_RESTITUTION, NULL, 3, 1, &more, 1), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "particle 3");
    check_error(support_set_surface(network, 1, count, 0, 0), MSPRING_ERROR_ID);
    check_error(support_set_surface(network, UINT32_MAX, 2, 0, 0), MSPRING_ERROR_ID);
    const size_t used = support_memory_used(network);
    watched.fail_at = watched.calls + 1;
    check_error(mspring_network_set(network, MSPRING_FRICTION, NULL, 0, 1, &zero, 1), MSPRING_ERROR_MEMORY);
    watched.fail_at = 0;
    assert_int_equal(support_memory_used(network), used);
    check_ok(support_set_surface(network, 0, 1, 0, 0));
    const size_t calls = watched.calls;
    check_ok(support_set_surface(network, 1, count - 1, 1, 1));
    support_steps(network, 10, DT);
    assert_int_equal(watched.calls, calls);
    check_ok(mspring_network_set_contact(network, NULL));
    check_error(support_set_surface(network, 0, 1, 0, 0), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "mspring_network_set_contact");
    mspring_network_destroy(network);
    check_watched_clean(&watched);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(friction_is_the_root_of_the_product),
        cmocka_unit_test(restitution_is_the_larger_one),
        cmocka_unit_test(bits_are_of_the_values_alone),
        cmocka_unit_test(on_the_floor_friction_is_the_root_of_the_product),
        cmocka_unit_test(on_the_floor_restitution_is_the_larger_one),
        cmocka_unit_test(bits_on_the_floor_are_of_the_values_alone),
        cmocka_unit_test(they_stay_with_contact),
        cmocka_unit_test(bad_calls_are_rejected),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

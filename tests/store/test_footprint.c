/// @file test_footprint.c
/// How much memory networks, spare room and snapshots take. examples/guides/edits.md has the numbers that it
/// prints.
///
/// SPDX-License-Identifier: MIT
#include "recipe.h"
#include "support.h"

/// What a particle of a full lattice may take all told: state and its backup (24 bytes each), four springs and
/// their places, maps.
#define MOST 142.0

static const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {100, 200}, .damping = {1, 2}};
static const recipe_stuff relative = {
    .mass = {1, 2}, .stiffness = {0.2, 0.2}, .damping = {0.05, 0.05}, .spring_flags = MSPRING_SPRING_RELATIVE};

static double bytes_per_particle(const recipe *made) {
    mspring_network *network = recipe_network(made, NULL);
    const double bytes = (double)support_memory_used(network) / made->particle_count;
    mspring_network_destroy(network);
    return bytes;
}

static void check_full_lattices(const recipe_stuff *of, const char *what) {
    const uint32_t sizes[][2] = {{128, 128}, {544, 68}, {68, 544}, {1000, 100}};
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        uint64_t seed = 5;
        recipe made = {0};
        recipe_lattice(&made, sizes[i][0], sizes[i][1], 0, 0, 1, of, &seed);
        const double bytes = bytes_per_particle(&made);
        print_message("%u x %u, %s springs: %.1f bytes per particle\n", (unsigned)sizes[i][0],
                      (unsigned)sizes[i][1], what, bytes);
        assert_true(bytes <= MOST);
        recipe_free(&made);
    }
}

static void full_lattices_are_small(void **state) {
    (void)state;
    check_full_lattices(&stuff, "absolute");
}

/// The struct itself takes 3.8 kB, and each of some 30 arrays 64 bytes or more.
static void small_networks_are_small(void **state) {
    (void)state;
    const struct {
        uint32_t width, height;
        double most;
    } cases[] = {{2, 1, 10700}, {4, 4, 15600}, {7, 5, 19300}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        uint64_t seed = 5;
        recipe made = {0};
        recipe_lattice(&made, cases[i].width, cases[i].height, 0, 0, 1, &stuff, &seed);
        const double bytes = bytes_per_particle(&made) * made.particle_count;
        print_message("%u x %u: %.0f bytes\n", (unsigned)cases[i].width, (unsigned)cases[i].height, bytes);
        assert_true(bytes <= cases[i].most);
        recipe_free(&made);
    }
}

static void relative_springs_take_little_more(void **state) {
    (void)state;
    check_full_lattices(&relative, "relative");
}

/// Ids in any order take no more.
static void order_is_not_needed(void **state) {
    (void)state;
    uint64_t seed = 5;
    recipe made = {0};
    recipe_lattice(&made, 128, 128, 0, 0, 1, &stuff, &seed);
    recipe_shuffle(&made, &seed, NULL);
    const double bytes = bytes_per_particle(&made);
    print_message("shuffled: %.1f bytes per particle\n", bytes);
    assert_true(bytes <= MOST);
    recipe_free(&made);
}

static double bytes_with(const recipe *made, uint32_t spare_particles, uint32_t spare_springs) {
    mspring_network_def def = support_def(0, 1);
    def.spare_particles = spare_particles;
    def.spare_springs = spare_springs;
    mspring_network *network = recipe_network(made, &def);
    const double bytes = (double)support_memory_used(network);
    mspring_network_destroy(network);
    return bytes;
}

/// What the first spare one takes for each spring of the builder, and each of many.
static void check_spare_room(const recipe_stuff *of, const char *what, double most_for_all) {
    enum { SIDE = 128, MANY = 10000 };
    uint64_t seed = 5;
    recipe made = {0};
    recipe_lattice(&made, SIDE, SIDE, 0, 0, 1, of, &seed);
    const double none = bytes_with(&made, 0, 0), first = bytes_with(&made, 0, 1);
    const double particle = (bytes_with(&made, MANY, 1) - first) / MANY;
    const double spring = (bytes_with(&made, 0, MANY) - first) / MANY, all = (first - none) / made.spring_count;
    print_message(
        "spare room, %s springs: %.0f bytes for each particle, %.0f for each spring, %.1f for each spring "
        "of the builder\n",
        what, particle, spring, all);
    assert_true(particle <= 150 && spring <= 210 && all <= most_for_all);
    recipe_free(&made);
}

static void spare_room_is_small(void **state) {
    (void)state;
    check_spare_room(&stuff, "absolute", 13);
    check_spare_room(&relative, "relative", 21);
}

static void frames_are_smaller(void **state) {
    (void)state;
    const recipe_stuff *const kinds[] = {&stuff, &relative};
    for (size_t i = 0; i < COUNT_OF(kinds); i++) {
        uint64_t seed = 5;
        recipe made = {0};
        size_t frame = 0, all = 0;
        recipe_lattice(&made, 128, 128, 0, 0, 1, kinds[i], &seed);
        mspring_network *network = recipe_network(&made, NULL);
        check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_FRAME, &frame));
        check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_ALL, &all));
        print_message("snapshots, %s springs: a frame %.1f bytes per particle, all %.2f times that\n",
                      i == 0 ? "absolute" : "relative", (double)frame / made.particle_count,
                      (double)all / (double)frame);
        assert_true(frame < all);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

// Bytes of a network with a floor: planes 0 for none.
static double bytes_with_floor(const recipe *made, mspring_solver solver, uint32_t planes, float friction) {
    static const double sides[][4] = {{0, -9, 0, 1}, {-9, 0, 1, 0}, {9, 0, -1, 0}};
    mspring_network_def def = support_def(0, 1);
    def.settings.solver = solver;
    mspring_network *network = recipe_network(made, &def);
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.planes = sides[0], floor.plane_count = planes, floor.friction = friction;
    if (planes > 0)
        check_ok(mspring_network_set_floor(network, &floor));
    const double bytes = (double)support_memory_used(network);
    mspring_network_destroy(network);
    return bytes;
}

/// A constraint, its entry and what its product reads: 56, 24 and 16 bytes. Each particle may push and rub; a
/// quarter of them may do so at two planes.
static void floors_take_little_of_a_linear_system(void **state) {
    (void)state;
    const struct {
        uint32_t planes;
        float friction;
        double most;
    } cases[] = {{1, 0, 97}, {1, 0.5f, 193}, {3, 0, 122}, {3, 0.5f, 242}};
    uint64_t seed = 5;
    recipe made = {0};
    recipe_lattice(&made, 128, 128, 0, 0, 1, &stuff, &seed);
    const double none = bytes_with_floor(&made, MSPRING_SOLVER_EXPLICIT, 0, 0);
    const double none_of_system = bytes_with_floor(&made, MSPRING_SOLVER_IMPLICIT, 0, 0);
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        const uint32_t planes = cases[i].planes;
        const double floor = bytes_with_floor(&made, MSPRING_SOLVER_EXPLICIT, planes, cases[i].friction) - none;
        const double of_system =
            bytes_with_floor(&made, MSPRING_SOLVER_IMPLICIT, planes, cases[i].friction) - none_of_system;
        const double bytes = (of_system - floor) / made.particle_count;
        print_message("%u planes, friction %g: %.1f bytes per particle of a linear system\n", (unsigned)planes,
                      (double)cases[i].friction, bytes);
        assert_true(bytes <= cases[i].most);
    }
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(full_lattices_are_small),
        cmocka_unit_test(small_networks_are_small),
        cmocka_unit_test(relative_springs_take_little_more),
        cmocka_unit_test(order_is_not_needed),
        cmocka_unit_test(spare_room_is_small),
        cmocka_unit_test(frames_are_smaller),
        cmocka_unit_test(floors_take_little_of_a_linear_system),
    };
    return cmocka_run_group_tests_name("footprint", tests, NULL, NULL);
}

/// @file test_topology.c
/// What a network recognises in what it is given: lattices and strands, whatever the order they were added in.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>

#include "recipe.h"
#include "support.h"

static const recipe_stuff solid = {.mass = {1, 1}, .stiffness = {100, 100}};
static const recipe_stuff holed = {.mass = {1, 1}, .stiffness = {100, 100}, .holes = 0.3};

/// The plan of a recipe, whose parts add up.
static support_plan plan_of(const recipe *made) {
    mspring_network *network = recipe_network(made, NULL);
    support_plan plan;
    check_ok(support_get_plan(network, &plan));
    assert_int_equal(plan.particle_count, made->particle_count);
    assert_int_equal(plan.spring_count, made->spring_count);
    assert_int_equal(plan.lattice_particles + plan.chain_particles + plan.irregular_particles + plan.loose_particles,
                     made->particle_count);
    assert_int_equal(plan.lattice_springs + plan.chain_springs + plan.irregular_springs, made->spring_count);
    assert_int_equal(plan.slot_count % plan.block_width, 0);
    assert_true(plan.slot_count >= made->particle_count);
    mspring_network_destroy(network);
    return plan;
}

static support_plan shuffled_plan_of(recipe *made) {
    uint64_t seed = 99;
    recipe_shuffle(made, &seed, NULL);
    return plan_of(made);
}

static void a_lattice_is_found_in_any_order(void **state) {
    (void)state;
    // Much smaller ones are cheaper spring by spring.
    const uint32_t sizes[][2] = {{8, 4}, {80, 5}, {5, 80}, {33, 31}, {128, 16}};
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        uint64_t seed = i;
        recipe made = {0};
        recipe_lattice(&made, sizes[i][0], sizes[i][1], 100, -50, 0.5, &solid, &seed);
        for (int shuffled = 0; shuffled < 2; shuffled++) {
            support_plan plan = shuffled ? shuffled_plan_of(&made) : plan_of(&made);
            assert_int_equal(plan.lattice_count, 1);
            assert_int_equal(plan.lattice_particles, made.particle_count);
            assert_int_equal(plan.lattice_springs, made.spring_count);
            assert_int_equal(plan.irregular_springs, 0);
        }
        recipe_free(&made);
    }
}

static void holes_do_not_break_a_lattice_up(void **state) {
    (void)state;
    uint64_t seed = 12;
    recipe made = {0};
    recipe_lattice(&made, 70, 40, -20, 3, 1, &holed, &seed);
    support_plan plan = shuffled_plan_of(&made);
    // Particles that holes cut off are strands or loose, but hardly any spring is.
    assert_true(plan.lattice_springs >= 0.99 * made.spring_count);
    assert_true(plan.lattice_particles >= 0.99 * made.particle_count);
    assert_true(plan.irregular_springs <= 0.01 * made.spring_count);
    recipe_free(&made);
}

static void a_lattice_need_not_lie_on_whole_numbers(void **state) {
    (void)state;
    const double spacings[] = {0.1, 1.0 / 3, 7.3, 1e-4, 12345.678};
    for (size_t i = 0; i < COUNT_OF(spacings); i++) {
        uint64_t seed = i;
        recipe made = {0};
        recipe_lattice(&made, 30, 20, 0.123 + 1000 * spacings[i], -0.7, spacings[i], &holed, &seed);
        support_plan plan = shuffled_plan_of(&made);
        assert_true(plan.lattice_springs >= 0.99 * made.spring_count);
        recipe_free(&made);
    }
}

static void several_lattices_are_found_side_by_side(void **state) {
    (void)state;
    uint64_t seed = 2;
    recipe made = {0};
    recipe_lattice(&made, 20, 10, 0, 0, 1, &solid, &seed);
    recipe_lattice(&made, 20, 10, 0.4, 20.3, 1, &solid, &seed); // between the first one's grid points
    recipe_lattice(&made, 15, 30, 50, 0, 0.25, &solid, &seed);  // of another spacing
    recipe_lattice(&made, 10, 10, 5.3, 5.1, 1, &solid, &seed);  // on top of the first
    support_plan plan = shuffled_plan_of(&made);
    assert_int_equal(plan.lattice_count, 4);
    assert_int_equal(plan.lattice_springs, made.spring_count);
    recipe_free(&made);
}

/// A lattice of the cells of a box that lie in its lowest rows, or in its leftmost or rightmost columns.
static void add_trough(recipe *made, uint32_t width, uint32_t height, uint32_t bottom, uint32_t wall, double x) {
    mspring_id ids[16][64];
    for (uint32_t row = 0; row < height; row++) {
        for (uint32_t column = 0; column < width; column++) {
            ids[row][column] = MSPRING_NONE;
            if (row >= bottom && column >= wall && column + wall < width) {
                continue;
            }
            ids[row][column] = recipe_particle(made, x + column, row, 1, 0);
            const mspring_id before[4] = {
                column > 0 ? ids[row][column - 1] : MSPRING_NONE,
                row > 0 ? ids[row - 1][column] : MSPRING_NONE,
                row > 0 && column > 0 ? ids[row - 1][column - 1] : MSPRING_NONE,
                row > 0 && column + 1 < width ? ids[row - 1][column + 1] : MSPRING_NONE,
            };
            for (uint32_t i = 0; i < 4; i++) {
                if (before[i] != MSPRING_NONE) {
                    recipe_spring(made, before[i], ids[row][column], 100, 0, 0);
                }
            }
        }
    }
}

/// Within a trough of 48 columns there is room for boxes of twelve in the blocks of its left and of its right wall,
/// and between them where they would take blocks of their own.
static void small_lattices_share_blocks(void **state) {
    (void)state;
    recipe made = {0};
    add_trough(&made, 48, 10, 2, 4, 0);
    const support_plan trough = plan_of(&made);
    assert_int_equal(trough.lattice_blocks, 2 * 3 + 8 * 2);
    add_trough(&made, 12, 7, 7, 0, 100);
    add_trough(&made, 12, 7, 7, 0, 200);
    const support_plan plan = plan_of(&made);
    assert_int_equal(plan.lattice_count, 3);
    assert_int_equal(plan.lattice_springs, made.spring_count);
    assert_int_equal(plan.lattice_blocks, trough.lattice_blocks);
    recipe_free(&made);
}

/// Ten columns fill ten lanes of sixteen: twelve such lattices of ten rows would take 120 blocks one above the
/// other. Put side by side they move as each would by itself: all are alike.
static void small_lattices_share_rows(void **state) {
    (void)state;
    enum { LATTICES = 12, EACH = 100 };
    recipe made = {0};
    for (uint32_t i = 0; i < LATTICES; i++) {
        uint64_t seed = 5;
        recipe one = {0};
        recipe_lattice(&one, 10, 10, 0, 0, 1, &solid, &seed);
        recipe_disturb(&one, 0.1, 2, &seed);
        for (uint32_t p = 0; p < EACH; p++) {
            const mspring_particle_def *from = &one.particles[p];
            const mspring_id made_p = recipe_particle(&made, from->x + 64.0 * i, from->y, (double)from->mass, 0);
            made.particles[made_p].vx = from->vx;
            made.particles[made_p].vy = from->vy;
        }
        for (uint32_t s = 0; s < one.spring_count; s++) {
            const mspring_spring_def *from = &one.springs[s];
            recipe_spring(&made, from->a + EACH * i, from->b + EACH * i, 100, 0, 0);
            made.springs[made.spring_count - 1].rest_length = from->rest_length;
        }
        recipe_free(&one);
    }
    const support_plan plan = plan_of(&made);
    assert_int_equal(plan.lattice_count, LATTICES);
    assert_int_equal(plan.lattice_particles, LATTICES * EACH);
    assert_int_equal(plan.lattice_springs, made.spring_count);
    assert_int_equal(plan.lattice_rows, 10);
    assert_true(plan.lattice_blocks <= 80);
    mspring_network_def def = support_def(0, 8);
    mspring_network *network = recipe_network(&made, &def);
    support_steps(network, 30, 1.0 / 64);
    for (uint32_t p = 0; p < EACH; p++) {
        const support_point first = support_position(network, p);
        for (uint32_t i = 1; i < LATTICES; i++) {
            // Single precision at some hundred metres, 240 substeps.
            const support_point other = support_position(network, EACH * i + p);
            check_near(other.x - 64.0 * i, first.x, 2e-3);
            check_near(other.y, first.y, 2e-3);
        }
    }
    mspring_network_destroy(network);
    recipe_free(&made);
}

static void ropes_on_a_lattice_are_swept_with_it(void **state) {
    (void)state;
    uint64_t seed = 7;
    recipe made = {0};
    recipe_lattice(&made, 60, 20, 0, 0, 1, &solid, &seed);
    const uint32_t lattice_springs = made.spring_count;
    const mspring_id weight = recipe_particle(&made, 10.3, -45.7, 5, 0);
    recipe_rope(&made, 10, weight, 50, &solid, &seed);
    for (int i = 0; i < 10; i++) {
        mspring_id a = (mspring_id)(support_random(&seed) % 1200), b = (mspring_id)(support_random(&seed) % 1200);
        if (a != b) {
            recipe_rope(&made, a, b, 10 + (uint32_t)i, &solid, &seed);
        }
    }
    support_plan plan = shuffled_plan_of(&made);
    assert_int_equal(plan.lattice_springs, lattice_springs);
    assert_int_equal(plan.chain_count, 0);
    assert_int_equal(plan.irregular_springs, made.spring_count - lattice_springs);
    assert_int_equal(plan.irregular_particles, made.particle_count - 1200);
    assert_int_equal(plan.pass_rows, plan.lattice_rows);
    recipe_free(&made);
}

static void more_rope_than_lattice_is_chains(void **state) {
    (void)state;
    uint64_t seed = 6;
    recipe made = {0};
    mspring_id first = recipe_lattice(&made, 20, 10, 0, 0, 1, &solid, &seed);
    mspring_id weight = recipe_particle(&made, 10.3, -45.7, 5, 0);
    recipe_rope(&made, first + 10, weight, 500, &solid, &seed);
    support_plan plan = shuffled_plan_of(&made);
    assert_int_equal(plan.lattice_springs, made.spring_count - 500);
    assert_int_equal(plan.chain_count, 1);
    assert_int_equal(plan.chain_springs, 499);
    assert_int_equal(plan.irregular_springs, 1);
    assert_int_equal(plan.chain_particles, 500);
    assert_int_equal(plan.pass_rows, 0);
    recipe_free(&made);
}

static void a_strand_of_its_own_is_a_chain(void **state) {
    (void)state;
    uint64_t seed = 7;
    recipe made = {0};
    mspring_id a = recipe_particle(&made, 0, 0, 1, MSPRING_PARTICLE_PINNED);
    mspring_id b = recipe_particle(&made, 70, 71, 1, 0);
    recipe_rope(&made, a, b, 100, &solid, &seed);
    support_plan plan = shuffled_plan_of(&made);
    assert_int_equal(plan.chain_springs, 100);
    assert_int_equal(plan.chain_particles, 101);
    assert_int_equal(plan.irregular_springs, 0);
    assert_int_equal(plan.lattice_particles, 0);
    recipe_free(&made);
}

static void a_ring_is_a_chain_but_for_one_spring(void **state) {
    (void)state;
    recipe made = {0};
    for (uint32_t i = 0; i < 50; i++) {
        recipe_particle(&made, 10 * cos(0.1256637 * i), 10 * sin(0.1256637 * i), 1, 0);
    }
    for (uint32_t i = 0; i < 50; i++) {
        recipe_spring(&made, i, (i + 1) % 50, 100, 0, 0);
    }
    support_plan plan = shuffled_plan_of(&made);
    assert_int_equal(plan.chain_springs + plan.irregular_springs, 50);
    assert_true(plan.irregular_springs <= 1);
    recipe_free(&made);
}

static void a_standing_bar_is_as_cheap_as_a_lying_one(void **state) {
    (void)state;
    uint64_t seed = 4;
    recipe lying = {0}, standing = {0};
    recipe_lattice(&lying, 1800, 5, 0, 0, 1, &solid, &seed);
    recipe_lattice(&standing, 5, 1800, 0, 0, 1, &solid, &seed);
    support_plan a = plan_of(&lying), b = shuffled_plan_of(&standing);
    assert_int_equal(a.lattice_springs, lying.spring_count);
    assert_int_equal(b.lattice_springs, standing.spring_count);
    assert_int_equal(a.lattice_blocks, b.lattice_blocks);
    assert_int_equal(a.lattice_blocks, 5 * ((1800 + a.block_width - 1) / a.block_width));
    recipe_free(&lying);
    recipe_free(&standing);
}

static void a_random_graph_is_no_lattice(void **state) {
    (void)state;
    uint64_t seed = 9;
    recipe made = {0};
    for (int i = 0; i < 400; i++) {
        recipe_particle(&made, support_random_between(&seed, 0, 20), support_random_between(&seed, 0, 20), 1, 0);
    }
    recipe_random_springs(&made, 1500, &solid, &seed);
    support_plan plan = plan_of(&made);
    assert_int_equal(plan.lattice_springs, 0);
    // 7.5 springs to a particle: strands of them are short and few.
    assert_true(plan.irregular_springs > 1000);
    recipe_free(&made);
}

/// A mesh of triangles whose particles lie about the nodes of a grid, by so much off in x and y.
static void add_sheet(recipe *made, uint32_t side, double off) {
    uint64_t seed = 3;
    const mspring_id first = made->particle_count;
    for (uint32_t i = 0; i < side * side; i++) {
        const double x = i % side + support_random_between(&seed, -off, off);
        const double y = i / side + support_random_between(&seed, -off, off);
        recipe_particle(made, x, y, 1, 0);
    }
    for (uint32_t i = first; i < first + side * side; i++) {
        const bool has_right = (i - first) % side + 1 < side, has_above = (i - first) / side + 1 < side;
        if (has_right) {
            recipe_spring(made, i, i + 1, 100, 0, 0);
        }
        if (has_above) {
            recipe_spring(made, i, i + side, 100, 0, 0);
        }
        if (has_right && has_above) {
            recipe_spring(made, i, i + side + 1, 100, 0, 0);
        }
    }
}

/// Of one that is far off so much is left over that all of it is a web. Lattices elsewhere are what they were, and
/// so is one with much rope.
static void sheets_far_off_a_grid_are_webs(void **state) {
    (void)state;
    uint64_t seed = 4;
    recipe made = {0};
    add_sheet(&made, 45, 0.2);
    support_plan plan = plan_of(&made);
    assert_int_equal(plan.lattice_count, 1);
    assert_true(plan.lattice_springs > plan.irregular_springs * 4);
    recipe_free(&made);
    add_sheet(&made, 45, 0.4);
    plan = shuffled_plan_of(&made);
    assert_int_equal(plan.lattice_count, 0);
    assert_int_equal(plan.irregular_particles, 45 * 45);
    recipe_lattice(&made, 70, 30, 100, 3, 1, &solid, &seed);
    const mspring_id roped = recipe_lattice(&made, 70, 30, 100, 90, 1, &solid, &seed);
    for (uint32_t i = 0; i < 60; i++) {
        recipe_rope(&made, roped + i, roped + 70 * 29 + i, 30, &solid, &seed);
    }
    plan = shuffled_plan_of(&made);
    assert_int_equal(plan.lattice_count, 2);
    assert_int_equal(plan.lattice_particles, 2 * 70 * 30);
    recipe_free(&made);
}

static void what_a_network_has_not_it_does_not_hold(void **state) {
    (void)state;
    const recipe_stuff damped = {.mass = {1, 1}, .stiffness = {100, 100}, .damping = {1, 1}};
    const recipe_stuff relative = {
        .mass = {1, 1}, .stiffness = {0.1, 0.1}, .spring_flags = MSPRING_SPRING_RELATIVE};
    const struct {
        const recipe_stuff *stuff;
        uint32_t has_damping, has_relative;
    } cases[] = {{&solid, 0, 0}, {&damped, 1, 0}, {&relative, 0, 1}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        uint64_t seed = 1;
        recipe made = {0};
        recipe_lattice(&made, 10, 10, 0, 0, 1, cases[i].stuff, &seed);
        support_plan plan = plan_of(&made);
        assert_int_equal(plan.has_damping, cases[i].has_damping);
        assert_int_equal(plan.has_relative, cases[i].has_relative);
        recipe_free(&made);
    }
}

static void order_does_not_change_the_motion(void **state) {
    (void)state;
    uint64_t seed = 41;
    const recipe_stuff stuff = {
        .mass = {1, 2}, .stiffness = {500, 1000}, .damping = {0, 2}, .pinned = 0.03, .holes = 0.2};
    recipe made = {0};
    mspring_id new_ids[1000];
    recipe_lattice(&made, 30, 20, 0, 0, 1, &stuff, &seed);
    mspring_id end = recipe_particle(&made, 50, 30, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 11, end, 30, &stuff, &seed);
    recipe_random_springs(&made, 20, &stuff, &seed);
    recipe_disturb(&made, 0.05, 1, &seed);
    assert_true(made.particle_count <= COUNT_OF(new_ids));
    mspring_network_def def = support_def(-9.8f, 2);
    mspring_network *first = recipe_network(&made, &def);
    recipe_shuffle(&made, &seed, new_ids);
    mspring_network *second = recipe_network(&made, &def);
    support_steps(first, 50, 1.0 / 64);
    support_steps(second, 50, 1.0 / 64);
    for (mspring_id id = 0; id < made.particle_count; id++) {
        support_point a = support_position(first, id), b = support_position(second, new_ids[id]);
        // Sums of forces may be taken in another order: some ulp of 32 m (2e-6 m) after 100 substeps.
        check_near(a.x, b.x, 2e-4);
        check_near(a.y, b.y, 2e-4);
    }
    mspring_network_destroy(first);
    mspring_network_destroy(second);
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lattice_is_found_in_any_order),
        cmocka_unit_test(holes_do_not_break_a_lattice_up),
        cmocka_unit_test(a_lattice_need_not_lie_on_whole_numbers),
        cmocka_unit_test(several_lattices_are_found_side_by_side),
        cmocka_unit_test(small_lattices_share_rows),
        cmocka_unit_test(small_lattices_share_blocks),
        cmocka_unit_test(ropes_on_a_lattice_are_swept_with_it),
        cmocka_unit_test(more_rope_than_lattice_is_chains),
        cmocka_unit_test(a_strand_of_its_own_is_a_chain),
        cmocka_unit_test(a_ring_is_a_chain_but_for_one_spring),
        cmocka_unit_test(a_standing_bar_is_as_cheap_as_a_lying_one),
        cmocka_unit_test(a_random_graph_is_no_lattice),
        cmocka_unit_test(sheets_far_off_a_grid_are_webs),
        cmocka_unit_test(what_a_network_has_not_it_does_not_hold),
        cmocka_unit_test(order_does_not_change_the_motion),
    };
    return cmocka_run_group_tests_name("topology", tests, NULL, NULL);
}

/// @file test_measure.c
/// Measurements against sums of the test's own, taken from positions, velocities, masses and springs.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "recipe.h"
#include "support.h"

/// A network in motion, far from the world's origin, and what it was made of.
typedef struct moving {
    recipe made;
    mspring_network *network;
} moving;

static const double gravity_x = 0.5, gravity_y = -9;

static int make(void **state, uint32_t width, uint32_t height, bool shuffled) {
    static moving m;
    uint64_t seed = 91;
    const recipe_stuff stuff = {
        .mass = {1, 3}, .stiffness = {100, 500}, .damping = {0, 5}, .pinned = 0.1, .holes = 0.2};
    m.made = (recipe){0};
    recipe_lattice(&m.made, width, height, 1000, -500, 1, &stuff, &seed);
    mspring_id end = recipe_particle(&m.made, 1030, -480, 2, MSPRING_PARTICLE_PINNED);
    recipe_rope(&m.made, 0, end, 10, &stuff, &seed);
    recipe_random_springs(&m.made, 10, &stuff, &seed);
    recipe_disturb(&m.made, 0.1, 2, &seed);
    if (shuffled) {
        recipe_shuffle(&m.made, &seed, NULL);
    }
    for (mspring_id s = 0; !shuffled && s < m.made.spring_count; s += 2) { // every other one the other way round
        const mspring_id a = m.made.springs[s].a;
        m.made.springs[s].a = m.made.springs[s].b;
        m.made.springs[s].b = a;
    }
    if (!shuffled) // the first one from the last particles to the first ones
        m.made.springs[0].a = m.made.particle_count - 2, m.made.springs[0].b = 1;
    mspring_network_def def = support_def((float)gravity_y, 2);
    def.settings.gravity_x = (float)gravity_x;
    m.network = recipe_network(&m.made, &def);
    support_steps(m.network, 10, 0.01);
    // Pinned particles that move: they count in no sum.
    for (mspring_id id = 0; id < m.made.particle_count; id++) {
        const float v = 1.5f;
        if (m.made.particles[id].flags != 0) {
            check_ok(mspring_network_set_velocities(m.network, NULL, id, 1, &v, &v, 1));
        }
    }
    *state = &m;
    return 0;
}

static int make_moving(void **state) {
    return make(state, 20, 9, true);
}

/// Particles in chunks, whose springs have ids near each other.
static int make_large(void **state) {
    return make(state, 70, 45, false);
}

static int free_moving(void **state) {
    moving *m = *state;
    mspring_network_destroy(m->network);
    recipe_free(&m->made);
    return 0;
}

/// Velocities of now, by id: those that are read belong to half a substep ago, from which forces take them on.
static void find_velocities_of_now(const moving *m, double half, support_point *v) {
    for (mspring_id id = 0; id < m->made.particle_count; id++) {
        v[id] = support_velocity(m->network, id);
        v[id].x += half * gravity_x;
        v[id].y += half * gravity_y;
    }
    for (mspring_id id = 0; id < m->made.spring_count; id++) {
        const mspring_spring_def *def = &m->made.springs[id];
        const support_point a = support_position(m->network, def->a), b = support_position(m->network, def->b);
        const support_point va = support_velocity(m->network, def->a), vb = support_velocity(m->network, def->b);
        const double dx = b.x - a.x, dy = b.y - a.y, length = hypot(dx, dy);
        const double rate = ((vb.x - va.x) * dx + (vb.y - va.y) * dy) / length;
        const double force =
            (double)def->stiffness * (length - (double)def->rest_length) + (double)def->damping * rate;
        const double mass_a = (double)m->made.particles[def->a].mass;
        const double mass_b = (double)m->made.particles[def->b].mass;
        v[def->a].x += half * force * dx / length / mass_a;
        v[def->a].y += half * force * dy / length / mass_a;
        v[def->b].x -= half * force * dx / length / mass_b;
        v[def->b].y -= half * force * dy / length / mass_b;
    }
}

static void energies_and_momenta(void **state) {
    moving *m = *state;
    double kinetic = 0, elastic = 0, potential = 0, px = 0, py = 0, angular = 0;
    support_point *now = malloc(m->made.particle_count * sizeof *now);
    assert_non_null(now);
    find_velocities_of_now(m, 0.01 / 2 / 2, now); // steps of 0.01 s in 2 substeps
    for (mspring_id id = 0; id < m->made.particle_count; id++) {
        const mspring_particle_def *def = &m->made.particles[id];
        if (def->flags != 0) {
            continue;
        }
        support_point p = support_position(m->network, id), v = support_velocity(m->network, id);
        double mass = (double)def->mass;
        kinetic += mass * (now[id].x * now[id].x + now[id].y * now[id].y) / 2;
        potential -= mass * (gravity_x * p.x + gravity_y * p.y);
        px += mass * v.x;
        py += mass * v.y;
        angular += mass * (p.x * v.y - p.y * v.x);
    }
    for (mspring_id id = 0; id < m->made.spring_count; id++) {
        const mspring_spring_def *def = &m->made.springs[id];
        support_point a = support_position(m->network, def->a), b = support_position(m->network, def->b);
        double stretch = hypot(b.x - a.x, b.y - a.y) - (double)def->rest_length;
        elastic += (double)def->stiffness * stretch * stretch / 2;
    }
    free(now);
    double got[6];
    check_ok(support_get_energy(m->network, &got[0], &got[1], &got[2]));
    check_ok(support_get_momentum(m->network, &got[3], &got[4], &got[5]));
    // The library rounds the forces of springs, which add a tenth of the velocities, to floats. The rest: sums of
    // some hundred doubles, 2^-53 each; angular momentum is a difference of two a hundred times larger.
    check_near(got[0], kinetic, 1e-8 * kinetic);
    check_near(got[1], elastic, 1e-9 * elastic); // lengths from world coordinates of 1000 m here
    check_near(got[2], potential, 1e-12 * fabs(potential));
    check_near(got[3], px, 1e-10);
    check_near(got[4], py, 1e-10);
    check_near(got[5], angular, 1e-7);
    assert_true(kinetic > 1 && elastic > 1 && fabs(px) > 0.1);

    // Each alone.
    double alone = 0;
    check_ok(support_get_energy(m->network, &alone, NULL, NULL));
    assert_true(alone == got[0]);
    check_ok(support_get_energy(m->network, NULL, &alone, NULL));
    assert_true(alone == got[1]);
    check_ok(support_get_energy(m->network, NULL, NULL, &alone));
    assert_true(alone == got[2]);
    check_ok(support_get_momentum(m->network, NULL, NULL, &alone));
    assert_true(alone == got[5]);
    check_ok(support_get_energy(m->network, NULL, NULL, NULL));
    check_ok(support_get_momentum(m->network, NULL, NULL, NULL));
    check_error(support_get_energy(NULL, &alone, NULL, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(support_get_momentum(NULL, &alone, NULL, NULL), MSPRING_ERROR_ARGUMENT);
}

/// Both words of positions and velocities count, in whole networks and in components.
static void moments_have_low_words(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_particle(builder, 1000.123456789, -3000.987654321, 3);
    support_particle(builder, 1001.123456789, -3000.987654321, 3);
    support_spring(builder, 0, 1, 100, 0);
    mspring_network_def def = support_def(-9.8f, 1);
    def.flags |= MSPRING_NETWORK_PRECISE;
    mspring_network *network = support_network(builder, &def);
    mspring_body component = {.struct_size = sizeof component};
    double py = 0;
    check_ok(mspring_network_update_components(network, NULL, NULL));
    check_ok(mspring_network_get_components(network, 0, 1, &component));
    // A float has steps of 6e-5 m and 2e-4 m there; two words have 2e-11 m, a position of the host twice that.
    check_near(component.x, 1000.623456789, 1e-9);
    check_near(component.y, -3000.987654321, 1e-9);
    support_steps(network, 1001, 1.0 / 1024);
    const double fallen = 6.0 * (double)-9.8f * 1000.5 / 1024; // velocities are of half a substep ago
    check_ok(support_get_momentum(network, NULL, &py, NULL));
    check_ok(mspring_network_get_components(network, 0, 1, &component));
    // A thousand sums of two words, of 2^-48 each; in one word the sum alone would be off by 2^-24.
    check_near(py, fallen, 1e-10 * fabs(fallen));
    assert_true(component.py == py);
    mspring_network_destroy(network);
}

static void springs_tell_what_they_are_and_do(void **state) {
    moving *m = *state;
    float strains[1000], worst = 0;
    mspring_id worst_id = MSPRING_NONE;
    const uint32_t count = m->made.spring_count;
    assert_true(count <= COUNT_OF(strains));
    check_ok(mspring_network_get(m->network, MSPRING_STRAIN, NULL, 0, count, strains, 1));
    for (mspring_id id = 0; id < count; id++) {
        const mspring_spring_def *def = &m->made.springs[id];
        support_spring_info info;
        check_ok(support_get_spring(m->network, id, &info));
        assert_int_equal(info.flags, 0);
        assert_int_equal(info.a, def->a);
        assert_int_equal(info.b, def->b);
        assert_true(info.stiffness == def->stiffness && info.damping == def->damping);
        assert_true(info.rest_length == def->rest_length);

        support_point a = support_position(m->network, def->a), b = support_position(m->network, def->b);
        support_point va = support_velocity(m->network, def->a), vb = support_velocity(m->network, def->b);
        double length = hypot(b.x - a.x, b.y - a.y), rest = (double)def->rest_length;
        double rate = ((vb.x - va.x) * (b.x - a.x) + (vb.y - va.y) * (b.y - a.y)) / length;
        double force = (length - rest) * (double)def->stiffness + rate * (double)def->damping;
        // A few roundings to float, at 2^-24 of the value.
        check_near((double)info.length, length, 2e-7 * length);
        check_near((double)info.strain, (length - rest) / rest, 3e-7 * length / rest);
        check_near((double)info.force, force, 1e-6 * (1 + fabs(force)));
        check_near((double)strains[id], (double)info.strain, 4e-7); // of lengths in single precision
        if (worst_id == MSPRING_NONE || fabsf(strains[id]) > worst) {
            worst = fabsf(strains[id]);
            worst_id = id;
        }
    }
    float strain;
    mspring_id spring;
    check_ok(support_get_max_strain(m->network, &strain, &spring));
    assert_true(strain == worst && strain > 0);
    assert_int_equal(spring, worst_id);
    check_ok(support_get_max_strain(m->network, NULL, NULL));

    // A part of them, in place.
    float part[3] = {7, 7, 7};
    check_ok(mspring_network_get(m->network, MSPRING_STRAIN, NULL, 5, 2, part, 1));
    assert_true(part[0] == strains[5] && part[1] == strains[6] && part[2] == 7);
    check_ok(mspring_network_get(m->network, MSPRING_STRAIN, NULL, count, 0, part, 1));
}

static void bounds_hold_all_particles(void **state) {
    moving *m = *state;
    double box[4] = {INFINITY, INFINITY, -INFINITY, -INFINITY}, got[4];
    for (mspring_id id = 0; id < m->made.particle_count; id++) {
        support_point p = support_position(m->network, id);
        box[0] = fmin(box[0], p.x);
        box[1] = fmin(box[1], p.y);
        box[2] = fmax(box[2], p.x);
        box[3] = fmax(box[3], p.y);
    }
    check_ok(support_get_bounds(m->network, &got[0], &got[1], &got[2], &got[3]));
    assert_memory_equal(got, box, sizeof got);
    check_error(support_get_bounds(NULL, &got[0], &got[1], &got[2], &got[3]), MSPRING_ERROR_ARGUMENT);
}

static void bad_calls_are_refused(void **state) {
    moving *m = *state;
    const uint32_t count = m->made.spring_count;
    support_spring_info info, before;
    memset(&info, 0x5a, sizeof info);
    before = info;
    float strain[2] = {7, 7};
    uint64_t hash;
    check_error(support_get_spring(m->network, count, &info), MSPRING_ERROR_ID);
    check_error(support_get_spring(m->network, MSPRING_NONE, &info), MSPRING_ERROR_ID);
    check_error(support_get_spring(NULL, 0, &info), MSPRING_ERROR_ARGUMENT);
    assert_memory_equal(&info, &before, sizeof info);
    check_error(mspring_network_get(m->network, MSPRING_STRAIN, NULL, count, 1, strain, 1), MSPRING_ERROR_ID);
    check_error(mspring_network_get(m->network, MSPRING_STRAIN, NULL, 1, UINT32_MAX - 1, strain, 1),
                MSPRING_ERROR_ID);
    check_error(mspring_network_get(m->network, MSPRING_STRAIN, NULL, 1, MSPRING_ALL, strain, 1),
                MSPRING_ERROR_ARGUMENT);
    check_ok(mspring_network_wake(m->network)); // forgets the first message
    check_error(mspring_network_get(m->network, MSPRING_STRAIN, NULL, 1, MSPRING_ALL, strain, 1),
                MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(m->network), "MSPRING_ALL");
    check_error(mspring_network_get(m->network, MSPRING_STRAIN, NULL, 0, 1, NULL, 1), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get(NULL, MSPRING_STRAIN, NULL, 0, 1, strain, 1), MSPRING_ERROR_ARGUMENT);
    check_error(support_get_max_strain(NULL, strain, NULL), MSPRING_ERROR_ARGUMENT);
    assert_true(strain[0] == 7 && strain[1] == 7);
    check_error(mspring_network_get_state_hash(m->network, NULL), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_state_hash(NULL, &hash), MSPRING_ERROR_ARGUMENT);
}

static void no_spring_no_strain(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_particle(builder, 3, 4, 5);
    mspring_network *network = support_network(builder, NULL);
    float strain = 7;
    mspring_id spring = 7;
    double kinetic = 7, elastic = 7, potential = 7;
    check_ok(support_get_max_strain(network, &strain, &spring));
    assert_true(strain == 0);
    assert_int_equal(spring, MSPRING_NONE);
    check_ok(support_get_energy(network, &kinetic, &elastic, &potential));
    assert_true(kinetic == 0 && elastic == 0);
    check_near(potential, 5 * 9.8 * 4, 1e-5); // 9.8 as a float
    mspring_network_destroy(network);
}

static void the_lowest_of_equal_strains_is_named(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    for (int i = 0; i < 5; i++) {
        support_particle(builder, i, 0, 1);
    }
    for (mspring_id i = 0; i < 4; i++) {
        mspring_spring_def spring;
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
        spring.a = i;
        spring.b = i + 1;
        spring.rest_length = i == 0 ? 1 : i % 2 == 1 ? 0.5f : 2; // strains 0, 1, -0.5, 1
        check_ok(mspring_builder_add_springs(builder, &spring, 1, NULL));
    }
    mspring_network *network = support_network(builder, NULL);
    float strain, first, third;
    mspring_id spring;
    check_ok(mspring_network_get(network, MSPRING_STRAIN, NULL, 1, 1, &first, 1));
    check_ok(mspring_network_get(network, MSPRING_STRAIN, NULL, 3, 1, &third, 1));
    assert_true(first == third);
    check_ok(support_get_max_strain(network, &strain, &spring));
    assert_true(strain == 1);
    assert_int_equal(spring, 1);
    mspring_network_destroy(network);
}

/// What is asked for by a list is what all have; the largest is the first of those.
static void check_strains(const mspring_network *network, uint32_t count) {
    float *all = malloc(count * sizeof *all), *listed = malloc(count * sizeof *listed), most = 0, got;
    mspring_id *ids = malloc(count * sizeof *ids), first = 0, named;
    assert_true(all && listed && ids);
    check_ok(mspring_network_get(network, MSPRING_STRAIN, NULL, 0, count, all, 1));
    for (mspring_id s = 0; s < count; s++) {
        ids[s] = count - 1 - s;
        if (fabsf(all[s]) > most) {
            most = fabsf(all[s]);
            first = s;
        }
    }
    check_ok(mspring_network_get(network, MSPRING_STRAIN, ids, 0, count, listed, 1));
    for (mspring_id s = 0; s < count; s++) {
        assert_true(listed[s] == all[ids[s]]);
    }
    check_ok(support_get_max_strain(network, &got, &named));
    assert_true(got == most);
    assert_int_equal(named, first);
    free(all);
    free(listed);
    free(ids);
}

/// Some thousand springs in random order, of which many are strained alike.
static void strains_do_not_depend_on_how_they_are_asked_for(void **state) {
    (void)state;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {100, 100}, .holes = 0.1};
    for (uint64_t seed = 1; seed <= 4; seed++) {
        uint64_t draws = seed;
        recipe made = {0};
        recipe_lattice(&made, 50, 30, 0, 0, 1, &stuff, &draws);
        const mspring_id end = recipe_particle(&made, 70, 5, 2, MSPRING_PARTICLE_PINNED);
        recipe_rope(&made, 0, end, 20, &stuff, &draws);
        recipe_random_springs(&made, 20, &stuff, &draws);
        recipe_shuffle(&made, &draws, NULL);
        const mspring_network_def def = support_def(-9.8f, 4);
        mspring_network *network = recipe_network(&made, &def);
        check_strains(network, made.spring_count);
        for (mspring_id p = 0; seed % 2 == 0 && p < made.particle_count; p++) { // exactly twice as wide
            const support_point at = support_position(network, p);
            const double x = 2 * at.x;
            check_ok(mspring_network_set_positions(network, NULL, p, 1, &x, &at.y, 1));
        }
        check_strains(network, made.spring_count);
        for (mspring_id s = 0; s < made.spring_count; s += 7) {
            check_ok(mspring_network_break_springs(network, &s, 0, 1));
        }
        check_strains(network, made.spring_count);
        support_steps(network, 3, 1.0 / 64);
        check_strains(network, made.spring_count);
        support_shift(network, made.particle_count / 2, 3, 0);
        check_strains(network, made.spring_count);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

static void the_hash_sees_every_bit_that_matters(void **state) {
    moving *m = *state;
    mspring_network *network = m->network;
    const uint64_t hash = support_hash(network);
    assert_int_equal(support_hash(network), hash);
    for (mspring_id id = 0; id < m->made.particle_count; id += 13) {
        const support_point at = support_position(network, id), v = support_velocity(network, id);
        support_set_velocity(network, id, nextafterf((float)v.x, INFINITY), (float)v.y);
        assert_int_not_equal(support_hash(network), hash);
        support_set_velocity(network, id, (float)v.x, nextafterf((float)v.y, INFINITY));
        assert_int_not_equal(support_hash(network), hash);
        support_set_velocity(network, id, (float)v.x, (float)v.y);
        assert_int_equal(support_hash(network), hash);
        support_shift(network, id, 1e-9, 0);
        assert_int_not_equal(support_hash(network), hash);
        check_ok(mspring_network_set_positions(network, NULL, id, 1, &at.x, &at.y, 1));
        assert_int_equal(support_hash(network), hash);
    }
    // Two particles that swap places are another state.
    const support_point a = support_position(network, 3), b = support_position(network, 4);
    check_ok(mspring_network_set_positions(network, NULL, 3, 1, &b.x, &b.y, 1));
    check_ok(mspring_network_set_positions(network, NULL, 4, 1, &a.x, &a.y, 1));
    assert_int_not_equal(support_hash(network), hash);
}

/* ------------------------------------------------------------------------------------------ all springs at once */

static void extents_are_those_of_each_spring(void **state) {
    (void)state;
    for (uint64_t variant = 1; variant <= 10; variant++) {
        uint64_t seed = variant;
        const recipe_stuff stuff = {.mass = {1, 2},
                                    .stiffness = {50, 100},
                                    .damping = {0, variant % 2 ? 1 : 0},
                                    .holes = variant > 6 ? 0.2 : 0.02};
        recipe made = {0};
        const uint32_t longer = 5 + 7 * (uint32_t)variant;
        recipe_lattice(&made, variant % 2 ? longer : 6, variant % 2 ? 6 : longer, 0, 0, 1, &stuff, &seed);
        recipe_rope(&made, 0, made.particle_count - 1, 40, &stuff, &seed);
        recipe_random_springs(&made, 23, &stuff, &seed);
        recipe_disturb(&made, 0.2, 3, &seed);
        if (variant % 3 == 0) { // else most ids lie in patterns
            recipe_shuffle(&made, &seed, NULL);
        }
        mspring_network *network = recipe_network(&made, NULL);
        const mspring_id broken = 3;
        check_ok(mspring_network_break_springs(network, &broken, 0, 1));
        support_steps(network, 5, 0.001);
        float *arrays[4];
        for (int i = 0; i < 4; i++) {
            arrays[i] = malloc(made.spring_count * sizeof(float));
            assert_non_null(arrays[i]);
        }
        check_ok(support_get_extents(network, arrays[0], arrays[1], arrays[2], arrays[3]));
        for (mspring_id s = 0; s < made.spring_count; s++) {
            support_spring_info info;
            check_ok(support_get_spring(network, s, &info));
            const support_point a = support_position(network, info.a), b = support_position(network, info.b);
            const double length = hypot(b.x - a.x, b.y - a.y);
            // Some roundings to single precision, of coordinates of up to 100 m for lengths of about 1 m.
            check_near((double)arrays[0][s], length, 1e-4);
            check_near((double)arrays[1][s], (b.x - a.x) / length, 1e-4);
            check_near((double)arrays[2][s], (b.y - a.y) / length, 1e-4);
            check_near((double)arrays[3][s], (double)info.strain, 1e-5);
            assert_true(s != broken || arrays[3][s] == 0);
        }
        // What is not wanted is left out.
        float *only = malloc(made.spring_count * sizeof *only);
        assert_non_null(only);
        check_ok(support_get_extents(network, NULL, NULL, NULL, only));
        assert_memory_equal(only, arrays[3], made.spring_count * sizeof *only);
        check_ok(support_get_extents(network, NULL, only, NULL, NULL));
        assert_memory_equal(only, arrays[1], made.spring_count * sizeof *only);
        check_error(support_get_extents(NULL, NULL, NULL, NULL, only), MSPRING_ERROR_ARGUMENT);
        free(only);
        for (int i = 0; i < 4; i++) {
            free(arrays[i]);
        }
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/* --------------------------------------------------------------------------------------------- ends and flags */

/// Check ends as ids, as pairs, and as slots, against those that were given.
static void check_ends(const mspring_network *network, const recipe *made) {
    const uint32_t count = made->spring_count;
    mspring_view view = {.struct_size = sizeof view};
    check_ok(mspring_network_get_view(network, &view));
    uint32_t *a = malloc(count * sizeof *a), *b = malloc(count * sizeof *b), *pairs = malloc(2 * count * sizeof *a);
    assert_true(a && b && pairs);
    check_ok(mspring_network_get_columns(
        network, NULL, 0, count, (const mspring_column[]){{MSPRING_END_A, 1, a}, {MSPRING_END_B, 1, b}}, 2));
    check_ok(mspring_network_get_columns(
        network, NULL, 0, count,
        (const mspring_column[]){{MSPRING_SLOT_A, 2, pairs}, {MSPRING_SLOT_B, 2, pairs + 1}}, 2));
    for (mspring_id s = 0; s < count; s++) {
        assert_int_equal(a[s], made->springs[s].a);
        assert_int_equal(b[s], made->springs[s].b);
        assert_int_equal(pairs[2 * s], view.slot_of_particle[a[s]]);
        assert_int_equal(pairs[2 * s + 1], view.slot_of_particle[b[s]]);
    }
    // A part of them, and nothing around it.
    b[0] = b[4] = 77;
    check_ok(mspring_network_get_columns(
        network, NULL, 5, 3, (const mspring_column[]){{MSPRING_END_A, 1, a}, {MSPRING_END_B, 1, b + 1}}, 2));
    assert_true(b[0] == 77 && b[4] == 77 && b[1] == made->springs[5].b && b[3] == made->springs[7].b);
    free(a);
    free(b);
    free(pairs);
}

static void ends_come_as_they_were_given(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        uint64_t random = seed;
        recipe made = recipe_mixed(seed);
        if (seed % 2 == 0) {
            recipe_shuffle(&made, &random, NULL);
        }
        for (mspring_id s = (mspring_id)seed % 3; s < made.spring_count; s += 1 + (mspring_id)seed) {
            const mspring_id a = made.springs[s].a;
            made.springs[s].a = made.springs[s].b;
            made.springs[s].b = a;
        }
        mspring_network *network = recipe_network(&made, NULL), *copy = NULL;
        check_ends(network, &made);
        for (mspring_id s = 0; s < made.spring_count; s += 2) {
            check_ok(mspring_network_break_springs(network, &s, 0, 1));
        }
        mspring_view before = {.struct_size = sizeof before}, after = before;
        check_ok(mspring_network_get_view(network, &before));
        check_ok(mspring_network_compact(network));
        check_ok(mspring_network_get_view(network, &after));
        assert_int_not_equal(before.layout_generation, after.layout_generation);
        check_ends(network, &made);
        check_ok(mspring_network_clone(network, NULL, &copy));
        check_ends(copy, &made);
        check_ok(support_expand(network));
        check_ends(network, &made);
        mspring_network_destroy(network);
        mspring_network_destroy(copy);
        recipe_free(&made);
    }
}

static void flags_are_those_of_each_spring(void **state) {
    moving *m = *state;
    const mspring_id broken = 3, removed = 4, stressed = 5;
    const float tiny = 1e-6f;
    uint32_t flags[2][6] = {{0}};
    check_ok(mspring_network_set(m->network, MSPRING_WARN_STRAIN, NULL, stressed, 1, &tiny, 1));
    check_ok(mspring_network_break_springs(m->network, &broken, 0, 1));
    check_ok(mspring_network_remove_springs(m->network, &removed, 0, 1));
    check_ok(mspring_network_step(m->network, 1e-3));
    check_ok(mspring_network_get_integers(m->network, MSPRING_SPRING_FLAGS, NULL, 2, 6, flags[0], 1));
    const uint32_t expected[] = {
        0, MSPRING_SPRING_BROKEN, MSPRING_SPRING_BROKEN | MSPRING_SPRING_REMOVED, MSPRING_SPRING_STRESSED, 0, 0};
    assert_memory_equal(flags[0], expected, sizeof expected);
    check_ok(mspring_network_get_integers(m->network, MSPRING_SPRING_FLAGS, NULL, 2, 6, flags[0], 2));
    assert_int_equal(flags[0][4], expected[2]);
    assert_int_equal(flags[1][0], expected[3]);
    uint32_t a = 0, b = 0;
    check_ok(mspring_network_get_columns(m->network, NULL, removed, 1,
                                         (const mspring_column[]){{MSPRING_SLOT_A, 1, &a}, {MSPRING_SLOT_B, 1, &b}},
                                         2));
    assert_true(a == MSPRING_NONE && b == MSPRING_NONE);

    mspring_network *network = m->network;
    const uint32_t count = m->made.spring_count;
    check_error(mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, 0, 1, &a, 0),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, 0, 1, NULL, 1),
                MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, count, 1, &a, 1),
                MSPRING_ERROR_ID);
    check_ok(mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, count, 0, NULL, 1));
    const mspring_column both[] = {{MSPRING_END_A, 1, &a}, {MSPRING_END_B, 1, &b}};
    const mspring_column mixed[] = {{MSPRING_END_A, 1, &a}, {MSPRING_MASS, 1, &b}};
    const mspring_column unknown[] = {{MSPRING_END_A, 1, &a}, {(mspring_property)(MSPRING_END_A + 70), 1, &b}};
    a = b = 77;
    check_ok(mspring_network_wake(network)); // which forgets the message
    check_error(mspring_network_get_columns(network, NULL, 0, 1, mixed, 2), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "column 1");
    check_ok(mspring_network_wake(network));
    check_error(mspring_network_get_columns(network, NULL, 0, 1, unknown, 2), MSPRING_ERROR_ARGUMENT);
    check_contains(mspring_network_error(network), "column 1");
    check_error(mspring_network_get_columns(network, NULL, 0, 1, NULL, 2), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_columns(network, &removed, 0, 1, both, 2), MSPRING_ERROR_ID);
    check_error(mspring_network_get_columns(network, NULL, 0, MSPRING_ALL, both, 2), MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_columns(NULL, NULL, 0, 1, both, 2), MSPRING_ERROR_ARGUMENT);
    check_error(
        mspring_network_get_columns(network, NULL, 0, 1,
                                    (const mspring_column[]){{MSPRING_END_A, 1, &a}, {MSPRING_END_B, 1, NULL}}, 2),
        MSPRING_ERROR_ARGUMENT);
    check_error(
        mspring_network_get_columns(network, NULL, 0, 1,
                                    (const mspring_column[]){{MSPRING_END_A, 0, &a}, {MSPRING_END_B, 0, &b}}, 2),
        MSPRING_ERROR_ARGUMENT);
    check_error(mspring_network_get_columns(network, NULL, 1, UINT32_MAX - 1, both, 2), MSPRING_ERROR_ID);
    assert_true(a == 77 && b == 77);
}

int main(void) {
#define MEASURE_TEST(test) cmocka_unit_test_setup_teardown(test, make_moving, free_moving)
    const struct CMUnitTest tests[] = {
        MEASURE_TEST(energies_and_momenta),
        cmocka_unit_test_setup_teardown(energies_and_momenta, make_large, free_moving),
        MEASURE_TEST(springs_tell_what_they_are_and_do),
        MEASURE_TEST(bounds_hold_all_particles),
        MEASURE_TEST(bad_calls_are_refused),
        cmocka_unit_test(moments_have_low_words),
        cmocka_unit_test(no_spring_no_strain),
        cmocka_unit_test(the_lowest_of_equal_strains_is_named),
        cmocka_unit_test(strains_do_not_depend_on_how_they_are_asked_for),
        MEASURE_TEST(the_hash_sees_every_bit_that_matters),
        cmocka_unit_test(extents_are_those_of_each_spring),
        cmocka_unit_test(ends_come_as_they_were_given),
        MEASURE_TEST(flags_are_those_of_each_spring),
    };
    return cmocka_run_group_tests_name("measure", tests, NULL, NULL);
}

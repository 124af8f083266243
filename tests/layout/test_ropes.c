/// @file test_ropes.c
/// Ropes that hang on lattices stand upright, side by side, and move bit by bit as those do of which there are too
/// few for that, whatever breaks or sleeps.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>
#include <stdlib.h>

#include "recipe.h"
#include "store/network.h"
#include "support.h"

#define DT (1.0 / 64)
#define ROPES 90

/// Particles between a rope's ends.
#define INNER 23

/// Ropes of which no strip has enough particles to stand.
#define FEW 2

typedef struct rigging {
    recipe made;
    mspring_id lattice_particles, lattice_springs;     ///< which come first
    mspring_id particle[ROPES + 1], spring[ROPES + 1]; ///< first ones of each rope, and behind the last
} rigging;

/// Two lattices that share rows, each with every other rope, of which the last few hang down. The lattices are
/// pinned, so that ropes know nothing of each other.
static rigging rig(double pinned, uint64_t seed) {
    const recipe_stuff stuff = {.mass = {1, 3}, .stiffness = {500, 1500}, .damping = {1, 4}};
    recipe_stuff hull = stuff;
    hull.pinned = pinned;
    hull.holes = 0.1;
    rigging r = {0};
    recipe_lattice(&r.made, 50, 60, 0, 0, 1, &hull, &seed);
    const uint32_t half = r.made.particle_count;
    recipe_lattice(&r.made, 60, 60, 90, 0, 1, &hull, &seed);
    // All ropes, or few, have their local origin in the middle of these.
    recipe_particle(&r.made, -30, -30, 1, MSPRING_PARTICLE_PINNED);
    recipe_particle(&r.made, 170, 90, 1, MSPRING_PARTICLE_PINNED);
    const uint32_t end = r.made.particle_count;
    r.lattice_particles = end;
    r.lattice_springs = r.made.spring_count;
    for (uint32_t i = 0; i < ROPES; i++) {
        r.particle[i] = r.made.particle_count;
        r.spring[i] = r.made.spring_count;
        const uint32_t low = i % 2 ? half : 0, count = (i % 2 ? end - 2 - half : half) - 1;
        const mspring_id a = low + 1 + (mspring_id)(support_random(&seed) % count);
        mspring_id b = low + 1 + (mspring_id)(support_random(&seed) % count);
        if (i + 6 >= ROPES) {
            b = recipe_particle(&r.made, r.made.particles[a].x + 9, -20, 1, 0);
        }
        recipe_rope(&r.made, a, a == b ? low : b, INNER + 1, &stuff, &seed);
    }
    r.particle[ROPES] = r.made.particle_count;
    r.spring[ROPES] = r.made.spring_count;
    recipe_disturb(&r.made, 0.05, 1, &seed);
    return r;
}

/// The lattices with few ropes, from first on.
static recipe few_of(const rigging *r, uint32_t first) {
    recipe made = {0};
    const uint32_t particles = r->particle[first + FEW] - r->particle[first];
    const uint32_t springs = r->spring[first + FEW] - r->spring[first];
    made.particle_count = made.particle_room = r->lattice_particles + particles;
    made.spring_count = made.spring_room = r->lattice_springs + springs;
    made.particles = malloc(made.particle_count * sizeof *made.particles);
    made.springs = malloc(made.spring_count * sizeof *made.springs);
    assert_non_null(made.particles);
    assert_non_null(made.springs);
    for (uint32_t i = 0; i < made.particle_count; i++) {
        const bool is_lattice = i < r->lattice_particles;
        made.particles[i] = r->made.particles[is_lattice ? i : i - r->lattice_particles + r->particle[first]];
    }
    for (uint32_t i = 0; i < made.spring_count; i++) {
        made.springs[i] = r->made.springs[i < r->lattice_springs ? i : i - r->lattice_springs + r->spring[first]];
        mspring_id *ends[] = {&made.springs[i].a, &made.springs[i].b};
        for (int end = 0; end < 2; end++) {
            if (*ends[end] >= r->lattice_particles) {
                *ends[end] -= r->particle[first] - r->lattice_particles;
            }
        }
    }
    return made;
}

/// What happens to them: of the ropes' springs some break and, if anything may sleep, ropes are kicked over and
/// over again, those of the first lattice.
typedef struct fate {
    float sleep_speed;
    mspring_simd level;
    uint32_t workers;
    int steps;
} fate;

static mspring_network *make(const recipe *made, const fate *f) {
    mspring_network_def def = support_def(0, 20);
    def.simd_level = f->level;
    def.worker_count = f->workers;
    def.settings.global_damping = f->sleep_speed > 0 ? 6 : 0;
    def.settings.sleep_speed = f->sleep_speed;
    def.settings.sleep_time = 0.25f;
    return recipe_network(made, &def);
}

static void live(mspring_network *network, const rigging *r, uint32_t first, uint32_t count, const fate *f) {
    const uint32_t particles_before = r->particle[first] - r->lattice_particles;
    const uint32_t springs_before = r->spring[first] - r->lattice_springs;
    for (int step = 0; step < f->steps; step++) {
        for (uint32_t i = first; i < first + count; i++) {
            if (step == 2 && i % 4 == 0) {
                const mspring_id spring = r->spring[i] + i % INNER - springs_before;
                check_ok(mspring_network_break_springs(network, &spring, 0, 1));
            }
            if (f->sleep_speed > 0 && step % 4 == 0 && i % 2 == 0) {
                support_kick(network, r->particle[i] + 9 - particles_before, 5);
            }
        }
        support_steps(network, 1, DT);
    }
}

static uint32_t upright_groups(const mspring_network *network) {
    const mspringi_sell *web = &network->topology.irregular;
    uint32_t count = 0;
    for (uint32_t group = 0; web->is_interleaved && group < web->slice_count; group++) {
        count += web->is_interleaved[group];
    }
    return count;
}

// Look at some of them. Of those that sleep the time depends on what else there is on their lattice.
static void check_as_few(const mspring_network *all, const rigging *r, const fate *f) {
    for (uint32_t first = 0; first < ROPES; first += 5 * FEW) {
        recipe made = few_of(r, first);
        mspring_network *few = make(&made, f);
        assert_int_equal(upright_groups(few), 0);
        live(few, r, first, FEW, f);
        for (mspring_id p = r->particle[first]; p < r->particle[first + (f->sleep_speed > 0 ? 1 : FEW)]; p++) {
            const mspring_id there = p - r->particle[first] + r->lattice_particles;
            const support_point at = support_position(all, p), also = support_position(few, there);
            const support_point v = support_velocity(all, p), w = support_velocity(few, there);
            assert_true(at.x == also.x && at.y == also.y);
            assert_true(v.x == w.x && v.y == w.y);
        }
        mspring_network_destroy(few);
        recipe_free(&made);
    }
}

/// The strip that a slot is swept with.
static uint32_t strip_of(const mspringi_topology *t, uint32_t slot) {
    for (uint32_t s = 0; s < t->strip_count; s++) {
        const mspringi_row *first = &t->rows[t->strips[s].first_row], *last = first + t->strips[s].row_count - 1;
        const mspringi_span *begin = &t->spans[first->first_span];
        const mspringi_span *end = &t->spans[last->first_span + last->span_count - 1];
        const uint32_t home = t->strips[s].assigned_span;
        if ((slot >= begin->first_slot && slot < end->end_slot) ||
            (home != MSPRING_NONE && slot >= t->spans[home].first_slot && slot < t->spans[home].end_slot)) {
            return s;
        }
    }
    return MSPRING_NONE;
}

static void ropes_stand_within_the_skew(void **state) {
    (void)state;
    rigging r = rig(0, 5);
    const fate f = {.workers = 1};
    mspring_network *network = make(&r.made, &f);
    const mspringi_topology *t = &network->topology;
    uint32_t upright = 0;
    for (uint32_t i = 0; i < t->laid_out_count; i++) {
        const uint32_t a = strip_of(t, t->irregular_a[i]), b = strip_of(t, t->irregular_b[i]);
        assert_true(a < t->wavefront_strips && b < t->wavefront_strips);
        assert_true((a > b ? a - b : b - a) <= t->skew);
        if (t->irregular.entry[2 * i] == t->irregular.entry[2 * i + 1]) {
            assert_int_equal(a, b);
            upright++;
        }
    }
    // In pieces of four, three springs of four could; the others climb from strip to strip, or there are too few.
    assert_true(upright > t->laid_out_count / 3);
    assert_int_equal(upright, 16 * upright_groups(network));
    mspring_network_destroy(network);
    recipe_free(&r.made);
}

static void standing_ropes_move_as_few_do(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    rigging r = rig(1, 6);
    for (uint32_t i = 0; i < count; i++) {
        const fate f = {.level = levels[i], .workers = 1 + i % 2, .steps = 6};
        mspring_network *all = make(&r.made, &f);
        assert_true(upright_groups(all) > 0);
        live(all, &r, 0, ROPES, &f);
        check_as_few(all, &r, &f);
        mspring_network_destroy(all);
    }
    recipe_free(&r.made);
}

/// Ropes sleep that stand in registers with others, and wake.
static void standing_ropes_sleep_as_few_do(void **state) {
    (void)state;
    rigging r = rig(1, 7);
    const fate f = {.sleep_speed = 0.5f, .workers = 1, .steps = 120};
    mspring_network *all = make(&r.made, &f);
    assert_true(upright_groups(all) > 0);
    live(all, &r, 0, ROPES, &f);
    assert_true(support_sleeps(all, r.particle[3] + 9));
    assert_false(support_sleeps(all, r.particle[6] + 9));
    check_as_few(all, &r, &f);
    mspring_network_destroy(all);
    recipe_free(&r.made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ropes_stand_within_the_skew),
        cmocka_unit_test(standing_ropes_move_as_few_do),
        cmocka_unit_test(standing_ropes_sleep_as_few_do),
    };
    return cmocka_run_group_tests_name("ropes", tests, NULL, NULL);
}

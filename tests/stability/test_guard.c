/// @file test_guard.c
/// The guard: what explodes is refused as soon as it is more than motion, the state is that of before, and nothing
/// that does not explode is ever refused.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "recipe.h"
#include "support.h"

static const recipe_shape shapes[] = {
    {"bar", .width = 60, .height = 5, .hangs = true},
    {"damped bar", .width = 60, .height = 5, .damping = 30, .hangs = true},
    {"ship", .width = 30, .height = 20, .rope = 20},
    {"rope", .rope = 200, .hangs = true},
    {"graph", .particles = 200, .springs = 600},
    {"pair", .rope = 2},
};

/// Energy that the network can have come by: what it had, and all that gravity may have given it so far.
static double energy_allowed(double first, double mass, double seconds) {
    const double root = sqrt(first) + 9.8 * seconds * sqrt(mass / 2);
    return root * root;
}

static void what_explodes_is_refused_in_time(void **state) {
    (void)state;
    const double beyond[] = {1.02, 1.1, 1.5, 3, 30, 1e3}, ratios[] = {1, 1e3};
    const uint32_t substeps[] = {1, 2, 3, 8, 31};
    uint32_t cases = 0;
    double worst = 0;
    for (size_t i = 0; i < COUNT_OF(shapes) * COUNT_OF(beyond) * COUNT_OF(substeps) * COUNT_OF(ratios); i++) {
        const recipe_shape *s = &shapes[i % COUNT_OF(shapes)];
        size_t rest = i / COUNT_OF(shapes);
        const double over = beyond[rest % COUNT_OF(beyond)];
        rest /= COUNT_OF(beyond);
        const uint32_t count = substeps[rest % COUNT_OF(substeps)];
        recipe made = recipe_of_shape(s, 1e4, ratios[rest / COUNT_OF(substeps)]);
        mspring_network_def def = support_def(-9.8f, count);
        mspring_network *network = recipe_network(&made, &def);
        double now = 0, mass = 0;
        check_ok(mspring_network_get_stable_dt(network, &now, NULL));
        for (uint32_t p = 0; p < made.particle_count; p++) {
            mass += (double)made.particles[p].mass;
        }
        const double dt = over * now * count, first = support_energy_of_motion(network);
        mspring_result result = MSPRING_OK;
        uint32_t step = 0;
        uint64_t before = 0;
        for (; step < 3000 && result == MSPRING_OK; step++) {
            before = support_hash(network);
            result = mspring_network_step(network, dt);
        }
        check_error(result, MSPRING_ERROR_UNSTABLE);
        check_contains(mspring_network_error(network), "spring");
        assert_int_equal(support_hash(network), before);
        worst = fmax(worst, support_energy_of_motion(network) / energy_allowed(first, mass, step * dt));
        mspring_network_destroy(network);
        recipe_free(&made);
        cases++;
    }
    print_message("%u cases, energy at the refusal at most %.3f of what is allowed\n", cases, worst);
    assert_true(worst < 1);
}

/// Of all springs one is too stiff, whichever it is: it is named, with the end that is more easily moved.
static void the_refusal_names_the_spring(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(shapes); i++) {
        recipe made = recipe_of_shape(&shapes[i], 1e4, 10);
        mspring_network_def def = support_def(-9.8f, 1);
        const uint32_t stride = made.spring_count / 40 + 1;
        for (mspring_id s = 0; s < made.spring_count; s += stride) {
            const mspring_spring_def *spring = &made.springs[s];
            const mspring_particle_def *a = &made.particles[spring->a], *b = &made.particles[spring->b];
            const bool a_is_pinned = a->flags & MSPRING_PARTICLE_PINNED,
                       b_is_pinned = b->flags & MSPRING_PARTICLE_PINNED;
            if (a_is_pinned && b_is_pinned) {
                continue; // moves nothing
            }
            mspring_network *network = recipe_network(&made, &def);
            double now = 0;
            const float stiff = 1e7f;
            check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, s, 1, &stiff, 1));
            check_ok(mspring_network_get_stable_dt(network, &now, NULL));
            const uint64_t before = support_hash(network);
            check_error(mspring_network_step(network, 1.1 * now), MSPRING_ERROR_UNSTABLE);
            const bool b_moves =
                a_is_pinned ||
                (!b_is_pinned && (b->mass < a->mass || (b->mass == a->mass && spring->b < spring->a)));
            char expected[64];
            snprintf(expected, sizeof expected, "(spring %u, particle %u). Use", (unsigned)s,
                     (unsigned)(b_moves ? spring->b : spring->a));
            check_contains(mspring_network_error(network), expected);
            assert_int_equal(support_hash(network), before);
            mspring_network_destroy(network);
        }
        recipe_free(&made);
    }
}

/// A spring that had no stiffness when the border was looked at first, so that nothing set it then.
static void a_spring_that_was_none_is_named(void **state) {
    (void)state;
    recipe made = {0};
    recipe_particle(&made, 0, 0, 1, 0);
    recipe_particle(&made, 1, 0, 2, 0);
    recipe_spring(&made, 0, 1, 0, 0, 0);
    mspring_network_def def = support_def(0, 1);
    mspring_network *network = recipe_network(&made, &def);
    support_steps(network, 1, 0.01);
    const float stiff = 1e5f, vx = 0.01f, vy = 0;
    check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, 0, 1, &stiff, 1));
    check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &vx, &vy, 1));
    mspring_result result = MSPRING_OK;
    for (int step = 0; step < 100 && result == MSPRING_OK; step++) {
        result = mspring_network_step(network, 0.01);
    }
    check_error(result, MSPRING_ERROR_UNSTABLE);
    check_contains(mspring_network_error(network), "(spring 0, particle 0). Use");
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// One particle is thrown out of the bounds, whichever it is: it is named, where it would have come to.
static void the_refusal_names_the_particle(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(shapes); i++) {
        recipe made = recipe_of_shape(&shapes[i], 10, 10);
        mspring_network_def def = support_def(-9.8f, 3);
        def.settings.max_speed = 100;
        mspring_network *network = recipe_network(&made, &def);
        for (mspring_id p = 0; p < made.particle_count; p += made.particle_count / 40 + 1) {
            if (made.particles[p].flags & MSPRING_PARTICLE_PINNED) {
                continue;
            }
            // Of 3 substeps, the first of a network counts half: its velocities are then those of its beginning.
            const double dt = 0.001, push = 1.2 * 100 / (dt * 5 / 6) * (double)made.particles[p].mass;
            check_ok(mspring_network_apply_force(network, p, 0, (float)push));
            const uint64_t before = support_hash(network);
            check_error(mspring_network_step(network, dt), MSPRING_ERROR_UNSTABLE);
            char expected[64];
            snprintf(expected, sizeof expected, "throw particle %u ", (unsigned)p);
            check_contains(mspring_network_error(network), expected);
            assert_int_equal(support_hash(network), before);
            check_ok(mspring_network_apply_force(network, p, 0, -(float)push)); // it was still there
        }
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/// It is told in world coordinates, far from where the local origin is 0.
static void the_refusal_tells_where_to(void **state) {
    (void)state;
    mspring_builder *builder = support_builder();
    support_particle(builder, 1000, 500, 1);
    mspring_network_def def = support_def(0, 1);
    def.settings.max_speed = 100;
    mspring_network *network = support_network(builder, &def);
    const float vx = 120, vy = -20;
    check_ok(mspring_network_set_velocities(network, NULL, 0, 1, &vx, &vy, 1));
    check_error(mspring_network_step(network, 0.5), MSPRING_ERROR_UNSTABLE);
    check_contains(mspring_network_error(network), "to (1060, 490) m at (120, -20) m/s");
    mspring_network_destroy(network);
}

/// What gets faster little by little is refused where it is too fast, also in steps whose changes of velocity are
/// watched: too long for some shape, not for the present one.
static void slow_growth_of_speed_is_refused_in_time(void **state) {
    (void)state;
    const double most = 2, g = 9.8;
    uint64_t seed = 8;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1000, 1000}};
    recipe made = {0};
    recipe_lattice(&made, 14, 8, 0, 0, 1, &stuff, &seed);
    mspring_network_def def = support_def((float)-g, 1);
    def.settings.max_speed = (float)most;
    mspring_network *network = recipe_network(&made, &def);
    double now, any_shape, time = 0;
    check_ok(mspring_network_get_stable_dt(network, &now, &any_shape));
    const double dt = 0.5 * (now + any_shape);
    assert_true(any_shape < 0.999 * now);
    for (; mspring_network_step(network, dt) == MSPRING_OK; time += dt)
        assert_true(g * time <= most + 2 * g * dt);
    assert_true(g * time >= most - 2 * g * dt);
    check_contains(mspring_network_error(network), "throw particle");
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// A lattice turned and stretched, more along than across, so that springs hold across themselves, too, and in
/// every direction: the border is that of mspring_network_get_stable_dt(), which is found in another way.
static void a_stretched_shape_has_its_own_border(void **state) {
    (void)state;
    uint64_t seed = 8;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {1000, 2000}, .damping = {0, 5}};
    for (int way = 0; way < 2; way++) {
        recipe made = {0};
        recipe_lattice(&made, 14, 8, 0, 0, 1, &stuff, &seed);
        for (mspring_id s = 0; s < made.spring_count; s++) { // what it has before it is stretched
            const mspring_particle_def *a = &made.particles[made.springs[s].a],
                                       *b = &made.particles[made.springs[s].b];
            made.springs[s].rest_length = (float)hypot(b->x - a->x, b->y - a->y);
        }
        for (mspring_id p = 0; p < made.particle_count; p++) {
            const double x = 1.5 * made.particles[p].x, y = 1.1 * made.particles[p].y;
            made.particles[p].x = 0.8 * x - 0.6 * y;
            made.particles[p].y = 0.6 * x + 0.8 * y;
        }
        const mspring_network_def def = support_def(0, 1);
        mspring_network *network = recipe_network(&made, &def);
        double now, any_shape;
        check_ok(mspring_network_get_stable_dt(network, &now, &any_shape));
        assert_true(any_shape < 0.9 * now);
        // That is told to 0.3 %, and a hundred iterations find the eigenvalue to 0.2 %.
        check_error(mspring_network_step(network, (way == 0 ? 1.02 : 0.98) * now),
                    way == 0 ? MSPRING_ERROR_UNSTABLE : MSPRING_OK);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/// Whatever the step: relative springs follow it.
static void relative_lattices_bear_what_they_are_said_to(void **state) {
    (void)state;
    const double fractions[] = {0.97, 1.05}, steps[] = {1e-3, 1.0 / 64, 10};
    for (size_t i = 0; i < COUNT_OF(fractions) * COUNT_OF(steps); i++) {
        const double fraction = fractions[i / COUNT_OF(steps)], dt = steps[i % COUNT_OF(steps)];
        uint64_t seed = 8;
        const recipe_stuff stuff = {
            .mass = {2, 2}, .stiffness = {fraction, fraction}, .spring_flags = MSPRING_SPRING_RELATIVE};
        recipe made = {0};
        recipe_lattice(&made, 20, 20, 0, 0, 1, &stuff, &seed); // so large that its sides matter by less than 2 %
        const mspring_network_def def = support_def(0, 2);
        mspring_network *network = recipe_network(&made, &def);
        check_error(mspring_network_step(network, dt), fraction < 1 ? MSPRING_OK : MSPRING_ERROR_UNSTABLE);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

static void look_on(const mspring_hook_args *args, void *user) {
    (void)args;
    (void)user;
}

/// Where a step is one substep it is reckoned how far particles can have come, and looked at only when that is too
/// far: what leaves the bounds is refused in the same step as where all is looked at in each, as with a hook.
static void reckoning_lets_nothing_out(void **state) {
    (void)state;
    const double far = MSPRING_MAX_COORDINATE;
    const mspring_guard guards[] = {MSPRING_GUARD_GROWTH, MSPRING_GUARD_BOUNDS};
    uint64_t seed = 9;
    uint32_t refused = 0, taken = 0;
    for (size_t i = 0; i < 200; i++) {
        // Two corners are pinned, so that the origin stays where it is.
        const double stiffness = i % 3 == 0 ? 0.4 : 1e-6;
        const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {stiffness, stiffness}};
        recipe made = {0};
        recipe_lattice(&made, 5, 5, -0.4 * far, -0.4 * far, 0.2 * far, &stuff, &seed);
        made.particles[0].flags = made.particles[24].flags = MSPRING_PARTICLE_PINNED;
        mspring_network_def def = support_def(0, i % 4 < 3 ? 1 : 2);
        def.settings.guard = guards[i % 2];
        def.settings.max_speed = i % 5 == 0 ? 2e10f : (float)MSPRING_MAX_SPEED;
        mspring_network *const both[] = {recipe_network(&made, &def), recipe_network(&made, &def)};
        check_ok(support_add_hook(both[1], MSPRING_PHASE_BEFORE_STEP, look_on, NULL, NULL));
        recipe_free(&made);
        for (uint32_t step = 0; step < 60; step++) {
            if (step % 20 == 0 || support_random(&seed) % 8 == 0) {
                const mspring_id p = (mspring_id)(1 + support_random(&seed) % 23);
                const double x = support_random_between(&seed, -0.95 * far, 0.95 * far),
                             y = support_random_between(&seed, -0.95 * far, 0.95 * far);
                const float vx = (float)support_random_between(&seed, -2e10, 2e10);
                const float vy = (float)support_random_between(&seed, -2e10, 2e10);
                for (size_t one = 0; one < 2; one++) {
                    if (step % 2 == 0) {
                        check_ok(mspring_network_set_positions(both[one], NULL, p, 1, &x, &y, 1));
                    }
                    check_ok(mspring_network_set_velocities(both[one], NULL, p, 1, &vx, &vy, 1));
                }
            }
            const mspring_result expected = mspring_network_step(both[1], 1);
            assert_int_equal(mspring_network_step(both[0], 1), expected);
            assert_int_equal(support_hash(both[0]), support_hash(both[1]));
            refused += expected == MSPRING_ERROR_UNSTABLE;
            taken += expected == MSPRING_OK;
            if (expected != MSPRING_OK) {
                assert_string_equal(mspring_network_error(both[0]), mspring_network_error(both[1]));
            }
        }
        mspring_network_destroy(both[0]);
        mspring_network_destroy(both[1]);
    }
    print_message("%u steps refused, %u not\n", refused, taken);
    assert_true(refused > 1000 && taken > 1000);
}

/// What sleeps far out is not seen while others move, and is again in the step in which it wakes.
static void what_wakes_far_out_is_seen(void **state) {
    (void)state;
    const double far = MSPRING_MAX_COORDINATE;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {1e-6, 1e-6}};
    uint64_t seed = 3;
    recipe made = {0};
    recipe_lattice(&made, 5, 5, -2, -2, 1, &stuff, &seed);
    recipe_lattice(&made, 40, 6, 0.9 * far, 0, 0.001 * far, &stuff, &seed);
    recipe_lattice(&made, 40, 6, -0.9 * far, 0, 0.001 * far, &stuff, &seed); // so that the origin stays
    mspring_network_def def = support_def(0, 1);
    def.settings.max_speed = (float)MSPRING_MAX_SPEED;
    def.settings.sleep_speed = 1e3f;
    def.settings.sleep_time = 2;
    mspring_network *network = recipe_network(&made, &def);
    for (int step = 0; step < 10 && !support_is_asleep(network); step++) {
        support_steps(network, 1, 1);
    }
    assert_int_equal(support_is_asleep(network), 1);
    const float fast = 2e3f;
    check_ok(mspring_network_set_velocities(network, NULL, 7, 1, &fast, &fast, 1));
    support_steps(network, 3, 1);
    const mspring_id end = 25 + 39;
    const uint64_t before = support_hash(network);
    check_ok(mspring_network_apply_force(network, end, 0.1f * (float)far, 0));
    check_error(mspring_network_step(network, 1), MSPRING_ERROR_UNSTABLE);
    check_contains(mspring_network_error(network), "throw particle 64");
    assert_int_equal(support_hash(network), before);
    check_ok(mspring_network_apply_force(network, end, -0.05f * (float)far, 0));
    check_ok(mspring_network_step(network, 1));
    check_near(support_position(network, end).x, 0.989 * far, 1e-6 * far);
    mspring_network_destroy(network);
    recipe_free(&made);
}

/// The article's bar: stable at rest, it explodes as it falls and stretches.
static mspring_network *falling_bar(double stiffness, mspring_guard guard, double *mass) {
    uint64_t seed = 8;
    const recipe_stuff stuff = {
        .mass = {73.3975, 73.3975}, .stiffness = {stiffness, stiffness}, .damping = {55.05, 55.05}};
    recipe made = {0};
    recipe_lattice(&made, 80, 5, 0, 0, 1, &stuff, &seed);
    for (uint32_t row = 0; row < 5; row++) {
        made.particles[row * 80].flags = MSPRING_PARTICLE_PINNED;
    }
    *mass = 73.3975 * 395;
    mspring_network_def def = support_def(-9.8f, 1);
    def.settings.guard = guard;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

static void a_shape_that_crosses_its_border_is_refused(void **state) {
    (void)state;
    const double dt = 1.0 / 64;
    double mass = 0;
    mspring_network *network = falling_bar(139000, MSPRING_GUARD_GROWTH, &mass);
    mspring_result result = MSPRING_OK;
    uint32_t step = 0;
    uint64_t before = 0;
    for (; step < 3840 && result == MSPRING_OK; step++) {
        before = support_hash(network);
        result = mspring_network_step(network, dt);
    }
    check_error(result, MSPRING_ERROR_UNSTABLE);
    assert_int_equal(support_hash(network), before);
    const double energy = support_energy_of_motion(network), allowed = energy_allowed(0, mass, step * dt);
    double now = 0;
    check_ok(mspring_network_get_stable_dt(network, &now, NULL));
    print_message("refused after %.3f s: energy %.3g J of at most %.3g, border %.4f of the step\n", step * dt,
                  energy, allowed, now / dt);
    assert_true(energy < allowed);
    assert_true(now < dt);
    // It stays refused, but for shorter steps.
    check_error(mspring_network_step(network, dt), MSPRING_ERROR_UNSTABLE);
    check_ok(mspring_network_step(network, dt / 2));
    mspring_network_destroy(network);
    // Without the guard it really explodes.
    network = falling_bar(139000, MSPRING_GUARD_BOUNDS, &mass);
    result = MSPRING_OK;
    double most = 0;
    for (step = 0; step < 3840 && result == MSPRING_OK; step++) {
        result = mspring_network_step(network, dt);
        most = fmax(most, support_energy_of_motion(network));
    }
    check_error(result, MSPRING_ERROR_UNSTABLE);
    check_contains(mspring_network_error(network), "throw particle");
    assert_true(most > 1e3 * energy_allowed(0, mass, step * dt));
    mspring_network_destroy(network);
}

/// What the guard has seen so far goes with a snapshot: the step that is refused is refused in a network that has
/// never moved before, too, and so are the ones before it taken.
static void what_was_seen_is_saved(void **state) {
    (void)state;
    const double dt = 1.0 / 64;
    enum { KEPT = 4 };
    double mass = 0;
    mspring_network *network = falling_bar(139000, MSPRING_GUARD_GROWTH, &mass);
    void *kept[KEPT] = {NULL};
    size_t size = 0;
    check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_FRAME, &size));
    for (size_t i = 0; i < KEPT; i++) {
        kept[i] = test_malloc(size);
    }
    uint32_t step = 0;
    for (mspring_result result = MSPRING_OK; step < 3840 && result == MSPRING_OK; step++) {
        check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, kept[step % KEPT], size, NULL));
        result = mspring_network_step(network, dt);
    }
    assert_true(step > KEPT && step < 3840);
    for (uint32_t back = 1; back <= KEPT; back++) {
        mspring_network *other = falling_bar(139000, MSPRING_GUARD_GROWTH, &mass);
        check_ok(mspring_network_load(other, kept[(step - back) % KEPT], size));
        for (uint32_t left = back; left > 1; left--) {
            check_ok(mspring_network_step(other, dt));
        }
        check_error(mspring_network_step(other, dt), MSPRING_ERROR_UNSTABLE);
        assert_string_equal(mspring_network_error(other), mspring_network_error(network));
        assert_int_equal(support_hash(other), support_hash(network));
        mspring_network_destroy(other);
    }
    for (size_t i = 0; i < KEPT; i++) {
        test_free(kept[i]);
    }
    mspring_network_destroy(network);
}

enum { STIFFER, LIGHTER, ADDED, EDITS };

/// A pair of which nothing need be watched, until that edit, and a particle beside.
static mspring_network *calm_pair(void) {
    recipe made = {0};
    recipe_particle(&made, 0, 0, 1, 0);
    recipe_particle(&made, 1, 0, 2, 0);
    recipe_particle(&made, 2, 0, 1, 0);
    recipe_spring(&made, 0, 1, 100, 0, 0);
    mspring_network_def def = support_def(0, 1);
    def.spare_springs = 1;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    return network;
}

static void edit_pair(mspring_network *network, int edit) {
    const float stiffness = 1e5f, mass = 1e-3f;
    mspring_spring_def spring;
    mspring_id id;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &spring, sizeof spring));
    spring.a = 1, spring.b = 2, spring.stiffness = stiffness, spring.rest_length = 1;
    if (edit == STIFFER) {
        check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, 0, 1, &stiffness, 1));
    } else if (edit == LIGHTER) {
        check_ok(mspring_network_set(network, MSPRING_MASS, NULL, 0, 1, &mass, 1));
    } else {
        check_ok(mspring_network_add_springs(network, &spring, 1, &id));
    }
}

/// That an edit has outdated what the guard knew of any shape goes with a snapshot: what is beyond the border since
/// is refused in the same step.
static void what_edits_outdate_is_saved(void **state) {
    (void)state;
    for (int edit = 0; edit < EDITS; edit++) {
        mspring_network *network = calm_pair(), *other = calm_pair();
        mspring_network *const both[] = {network, other};
        support_steps(network, 2, 0.01);
        edit_pair(network, edit);
        support_bring(network, other, MSPRING_SNAPSHOT_ALL);
        mspring_result results[2] = {MSPRING_OK, MSPRING_OK};
        support_kick(network, 0, 0.01f);
        support_kick(other, 0, 0.01f);
        uint32_t step = 0;
        for (; step < 100 && results[0] == MSPRING_OK; step++) {
            for (size_t i = 0; i < 2; i++) {
                results[i] = mspring_network_step(both[i], 0.01);
            }
            assert_int_equal(results[1], results[0]);
            assert_int_equal(support_hash(other), support_hash(network));
        }
        check_error(results[0], MSPRING_ERROR_UNSTABLE);
        check_contains(mspring_network_error(other), "exceeds the stability limit");
        mspring_network_destroy(network);
        mspring_network_destroy(other);
    }
}

static void more_substeps_are_tried_where_that_is_wanted(void **state) {
    (void)state;
    const double dt = 1.0 / 64;
    double mass = 0, now = 0;
    mspring_network *network = falling_bar(139000, MSPRING_GUARD_RETRY, &mass);
    for (uint32_t step = 1; step <= 3840; step++) {
        check_ok(mspring_network_step(network, dt));
        // Near the border the energy of a mode swings.
        assert_true(support_energy_of_motion(network) < 2 * energy_allowed(0, mass, step * dt));
    }
    assert_int_equal(support_substeps(network), 2);
    mspring_network_destroy(network);

    // 17 times the border: 32 substeps, if they are allowed.
    network = falling_bar(290 * 150e3, MSPRING_GUARD_RETRY, &mass);
    check_ok(mspring_network_get_stable_dt(network, &now, NULL));
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.substeps = 1;
    solver.max_substeps = 15;
    check_ok(support_set_solver(network, &solver));
    const uint64_t before = support_hash(network);
    check_error(mspring_network_step(network, dt), MSPRING_ERROR_UNSTABLE);
    assert_int_equal(support_solver(network).substeps, 1);
    assert_int_equal(support_hash(network), before);
    solver.max_substeps = 100;
    check_ok(support_set_solver(network, &solver));
    check_ok(mspring_network_step(network, dt));
    assert_int_equal(support_substeps(network), 32);
    support_steps(network, 10, dt);
    assert_int_equal(support_substeps(network), 32);
    mspring_network_destroy(network);
}

static void the_implicit_solver_steps_in_where_that_is_wanted(void **state) {
    (void)state;
    const double dt = 1.0 / 64, beyond[] = {139000, 290 * 150e3};
    double mass = 0;
    for (size_t i = 0; i < COUNT_OF(beyond); i++) {
        mspring_network *network = falling_bar(beyond[i], MSPRING_GUARD_IMPLICIT, &mass);
        void *snapshot = NULL;
        size_t size = 0;
        for (uint32_t step = 1; step <= 1000; step++) {
            check_ok(mspring_network_step(network, dt));
            // Near the border the energy of a mode swings.
            assert_true(support_energy_of_motion(network) < 2 * energy_allowed(0, mass, step * dt));
            assert_int_equal(support_substeps(network), 1);
            if (step == 700) { // among steps of either kind
                check_ok(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_FRAME, &size));
                snapshot = test_malloc(size);
                check_ok(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, snapshot, size, NULL));
            }
        }
        assert_true(support_fallback_count(network) > 10);
        const uint64_t expected = support_hash(network);
        mspring_network *clone = NULL;
        check_ok(mspring_network_load(network, snapshot, size));
        check_ok(mspring_network_clone(network, NULL, &clone));
        support_steps(network, 300, dt);
        support_steps(clone, 300, dt);
        assert_int_equal(support_hash(network), expected);
        assert_int_equal(support_hash(clone), expected);
        test_free(snapshot);
        mspring_network_destroy(clone);
        mspring_network_destroy(network);
    }
    // Where nothing has to be refused it is never asked.
    mspring_network *network = falling_bar(36700, MSPRING_GUARD_IMPLICIT, &mass);
    mspring_network *twin = falling_bar(36700, MSPRING_GUARD_GROWTH, &mass);
    support_steps(network, 1000, dt);
    support_steps(twin, 1000, dt);
    assert_int_equal(support_hash(network), support_hash(twin));
    assert_int_equal(support_fallback_count(network), 0);
    mspring_network_destroy(network);
    mspring_network_destroy(twin);
}

static void what_is_stable_is_never_refused(void **state) {
    (void)state;
    // A tenth below the border, half a metre out of shape where springs are a metre long, and kicked again and
    // again: not one refusal. The energy tells that nothing exploded.
    uint32_t steps = 0;
    for (size_t i = 0; i < 2 * COUNT_OF(shapes); i++) {
        const recipe_shape *s = &shapes[i % COUNT_OF(shapes)];
        recipe made = recipe_of_shape(s, 1e4, i < COUNT_OF(shapes) ? 1 : 100);
        mspring_network_def def = support_def(0, 1 + (uint32_t)i % 3);
        def.settings.global_damping = 0.5f;
        mspring_network *network = recipe_network(&made, &def);
        double now = 0, mass = 0;
        check_ok(mspring_network_get_stable_dt(network, &now, NULL));
        for (uint32_t p = 0; p < made.particle_count; p++) {
            mass += (double)made.particles[p].mass;
        }
        const double speed = 0.02 / now; // to stretch a spring by percents
        uint64_t seed = 5;
        for (uint32_t step = 0; step < 2000; step++, steps++) {
            if (step % 100 == 0) {
                const uint32_t one = (uint32_t)(support_random(&seed) % made.particle_count);
                const float v = (float)support_random_between(&seed, -speed, speed);
                check_ok(mspring_network_set_velocities(network, NULL, one, 1, &v, &v, 1));
            }
            mspring_result result = mspring_network_step(network, 0.9 * now * def.settings.substeps);
            if (result != MSPRING_OK) {
                print_error("%s, step %u: %s\n", s->name, step, mspring_network_error(network));
            }
            check_ok(result);
        }
        assert_true(support_energy_of_motion(network) < mass * speed * speed);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
    print_message("%u steps, none refused\n", steps);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_explodes_is_refused_in_time),
        cmocka_unit_test(the_refusal_names_the_spring),
        cmocka_unit_test(a_spring_that_was_none_is_named),
        cmocka_unit_test(the_refusal_names_the_particle),
        cmocka_unit_test(the_refusal_tells_where_to),
        cmocka_unit_test(slow_growth_of_speed_is_refused_in_time),
        cmocka_unit_test(a_stretched_shape_has_its_own_border),
        cmocka_unit_test(relative_lattices_bear_what_they_are_said_to),
        cmocka_unit_test(reckoning_lets_nothing_out),
        cmocka_unit_test(what_wakes_far_out_is_seen),
        cmocka_unit_test(a_shape_that_crosses_its_border_is_refused),
        cmocka_unit_test(what_was_seen_is_saved),
        cmocka_unit_test(what_edits_outdate_is_saved),
        cmocka_unit_test(more_substeps_are_tried_where_that_is_wanted),
        cmocka_unit_test(the_implicit_solver_steps_in_where_that_is_wanted),
        cmocka_unit_test(what_is_stable_is_never_refused),
    };
    return cmocka_run_group_tests_name("guard", tests, NULL, NULL);
}

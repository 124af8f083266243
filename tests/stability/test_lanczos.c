/// @file test_lanczos.c
/// Largest eigenvalues of networks, against those of dense matrices: of the pencil, of the guard's search, and the
/// substep that mspring_network_get_stable_dt() makes of them.
///
/// SPDX-License-Identifier: MIT
#include "stability/lanczos.h"

#include <math.h>
#include <string.h>

#include "recipe.h"
#include "stability/pencil.h"
#include "stability/stability_limit.h"
#include "stability/tridiagonal.h"
#include "support.h"

/* ------------------------------------------------------------------------------------------------------- dense */

/// Largest eigenvalue of a symmetric matrix by Jacobi's rotations, which it is overwritten by.
static double dense_largest(double *a, size_t n) {
    double off = 1, all = 0, largest = 0;
    for (size_t i = 0; i < n * n; i++) {
        all += a[i] * a[i];
    }
    for (int sweep = 0; sweep < 30 && off > 1e-20 * all; sweep++) {
        off = 0;
        for (size_t p = 0; p < n; p++) {
            for (size_t q = p + 1; q < n; q++) {
                const double beside = a[p * n + q], half = 0.5 * (a[q * n + q] - a[p * n + p]);
                const double t = beside / (half + copysign(sqrt(half * half + beside * beside), half));
                const double c = 1 / sqrt(1 + t * t), s = t * c;
                off += beside * beside;
                for (size_t i = 0; i < n && beside != 0; i++) {
                    const double x = a[i * n + p], y = a[i * n + q];
                    a[i * n + p] = c * x - s * y;
                    a[i * n + q] = s * x + c * y;
                }
                for (size_t i = 0; i < n && beside != 0; i++) {
                    const double x = a[p * n + i], y = a[q * n + i];
                    a[p * n + i] = c * x - s * y;
                    a[q * n + i] = s * x + c * y;
                }
            }
        }
    }
    for (size_t i = 0; i < n; i++) {
        largest = fmax(largest, a[i * n + i]);
    }
    return largest;
}

/// h^2 M^-1/2 K M^-1/2 + 2 h M^-1/2 C M^-1/2 of stretched springs, by their textbook formulas.
static double dense_border(const recipe *made, double h) {
    const size_t n = 2 * (size_t)made->particle_count;
    double *a = test_calloc(n * n, sizeof *a);
    for (uint32_t i = 0; i < made->spring_count; i++) {
        const mspring_spring_def *s = &made->springs[i];
        const mspring_particle_def *ends[] = {&made->particles[s->a], &made->particles[s->b]};
        const double x = (double)(float)ends[1]->x - (double)(float)ends[0]->x;
        const double y = (double)(float)ends[1]->y - (double)(float)ends[0]->y, length = sqrt(x * x + y * y);
        const double direction[] = {x / length, y / length};
        const double across = h * h * (double)s->stiffness * (1 - (double)s->rest_length / length);
        const double along = h * h * (double)s->stiffness + 2 * h * (double)s->damping - across;
        for (int end = 0; end < 4; end++) {
            const uint32_t row = end / 2 == 0 ? s->a : s->b, column = end % 2 == 0 ? s->a : s->b;
            if ((ends[end / 2]->flags | ends[end % 2]->flags) & MSPRING_PARTICLE_PINNED) {
                continue;
            }
            const double root =
                sqrt((double)ends[end / 2]->mass * (double)ends[end % 2]->mass) * (row == column ? 1 : -1);
            for (size_t k = 0; k < 4; k++) {
                const double part = along * direction[k / 2] * direction[k % 2] + (k / 2 == k % 2 ? across : 0);
                a[(2 * row + k / 2) * n + 2 * column + k % 2] += part / root;
            }
        }
    }
    const double largest = dense_largest(a, n);
    test_free(a);
    return largest;
}

/* ---------------------------------------------------------------------------------------------------- networks */

enum { CASES = 12 };

/// Lattices with holes, ropes and springs at random, of masses 1 to 1e4, all springs longer than at rest: there the
/// guard's matrix and that of mspring_network_get_stable_dt() are one.
static recipe stretched(uint64_t which) {
    uint64_t seed = which + 1;
    const recipe_stuff stuff = {.mass = {1, which % 3 == 0   ? 1
                                            : which % 3 == 1 ? 10
                                                             : 1e4},
                                .stiffness = {100, which % 2 == 0 ? 100 : 4000},
                                .damping = {0, which < CASES / 2 ? 0 : 3},
                                .pinned = which % 4 == 3 ? 0.1 : 0,
                                .holes = which % 4 == 2 ? 0.2 : 0};
    const uint32_t sizes[][2] = {{2, 2}, {12, 2}, {7, 5}, {6, 6}};
    recipe made = {0};
    recipe_lattice(&made, sizes[which % 4][0], sizes[which % 4][1], 0, 0, 1, &stuff, &seed);
    recipe_rope(&made, 0, made.particle_count - 1, 5, &stuff, &seed);
    recipe_random_springs(&made, 5, &stuff, &seed);
    recipe_disturb(&made, 0.1, 0, &seed);
    for (uint32_t i = 0; i < made.spring_count; i++) {
        made.springs[i].rest_length *= 0.5f;
    }
    return made;
}

/// The pencil's, and the length of the eigenvector that it gives.
static mspringi_ritz find(mspring_network *network, double h, double *length) {
    const size_t slots = mspringi_slot_count(network);
    mspringi_pencil pencil = {.network = network};
    pencil.terms = test_calloc(network->topology.spring_count, sizeof *pencil.terms);
    float *arrays = test_calloc(6 * slots, sizeof *arrays);
    const mspringi_lanczos lanczos = {.slots = slots,
                                      .inverse_mass = network->inverse_mass,
                                      .add_image = mspringi_pencil_add_image,
                                      .context = &pencil,
                                      .here = {arrays, arrays + slots},
                                      .next = {arrays + 2 * slots, arrays + 3 * slots},
                                      .vector = {arrays + 4 * slots, arrays + 5 * slots},
                                      .bound = INFINITY,
                                      .least = 16,
                                      .most = MSPRINGI_LANCZOS_MAX,
                                      .period = 1};
    mspringi_lanczos_add_noise(&lanczos, 1.0f);
    mspringi_pencil_set(&pencil, h);
    const mspringi_ritz ritz = mspringi_lanczos_largest(&lanczos);
    const mspringi_quotient quotient = mspringi_pencil_quotient(&pencil, lanczos.vector);
    // Of a vector of length 1 it is the eigenvalue, but for the square of the vector's error: twice the residual.
    check_near(h * h * quotient.stiffness + 2 * h * quotient.damping, ritz.value, 4e-3 * ritz.value);
    *length = 0;
    for (size_t i = 0; i < slots; i++) {
        const double x = (double)lanczos.vector.x[i], y = (double)lanczos.vector.y[i];
        *length += network->inverse_mass[i] > 0 ? (x * x + y * y) / (double)network->inverse_mass[i] : 0;
    }
    test_free(arrays);
    test_free(pencil.terms);
    return ritz;
}

static void iterations_find_the_largest_eigenvalue(void **state) {
    (void)state;
    for (uint64_t which = 0; which < CASES; which++) {
        recipe made = stretched(which);
        mspring_network_def def = support_def(0, 1);
        mspring_network *network = recipe_network(&made, &def);
        double now = 0, length = 0;
        check_ok(mspring_network_get_stable_dt(network, &now, NULL));
        const double exact = dense_border(&made, now);
        const mspringi_ritz ritz = find(network, now, &length);
        const double searched = mspringi_stability_limit_search(network, now, 0, 2 * exact, 100);
        print_message("%2d: dense %.6f, pencil %.6f, guard %.6f\n", (int)which, exact, ritz.value, searched);
        // Both are bounds from below up to single precision in some ten operations, with a residual of 2e-3.
        assert_true(ritz.value < exact * (1 + 1e-5) && ritz.value > exact * (1 - 3e-3));
        assert_true(searched < exact * (1 + 1e-5) && searched > exact * (1 - 3e-3));
        check_near(length, 1, 1e-4); // 2 slots numbers in single precision
        // The substep is as long as the eigenvalue may be 4: rather too short by the residual and the last turn of
        // the iteration, 5e-4 of the substep each.
        assert_true(exact < 4 * (1 + 1e-4) && exact > 4 * (1 - 6e-3));
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/// A bound that is far away decides early, on the right side.
static void bounds_decide(void **state) {
    (void)state;
    for (uint64_t which = 0; which < CASES; which++) {
        recipe made = stretched(which);
        mspring_network_def def = support_def(0, 1);
        mspring_network *network = recipe_network(&made, &def);
        const double exact = dense_border(&made, 1e-3);
        assert_true(mspringi_stability_limit_search(network, 1e-3, 0, 0.9 * exact, 100) > 0.9 * exact);
        assert_true(mspringi_stability_limit_search(network, 1e-3, 0, 1.01 * exact, 100) < 1.01 * exact);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(iterations_find_the_largest_eigenvalue),
        cmocka_unit_test(bounds_decide),
    };
    return cmocka_run_group_tests_name("lanczos", tests, NULL, NULL);
}

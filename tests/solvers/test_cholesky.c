/// @file test_cholesky.c
/// The sparse direct solver against dense elimination in double precision, on graphs of every kind; its levels
/// against the scalar one, bit for bit; its errors.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "level.h"
#include "solvers/sparse/symbolic.h"
#include "support.h"

static mspring_simd tested_level;

/* ------------------------------------------------------------------------------------------------- problems */

enum { MOST_NODES = 700, MOST_EDGES = 6000 };

/// A graph and a matrix: springs along its edges, masses on its nodes.
typedef struct problem {
    uint32_t nodes, edges;
    uint32_t a[MOST_EDGES], b[MOST_EDGES];
    double x[MOST_NODES], y[MOST_NODES];
    bool absent[MOST_NODES];
    double node[3][MOST_NODES], edge[3][MOST_EDGES]; ///< xx, xy, yy
    float node_float[3][MOST_NODES], edge_float[3][MOST_EDGES];
} problem;

static uint32_t add_node(problem *p, double x, double y) {
    assert_true(p->nodes < MOST_NODES);
    p->x[p->nodes] = x;
    p->y[p->nodes] = y;
    return p->nodes++;
}

static void add_edge(problem *p, uint32_t a, uint32_t b) {
    assert_true(p->edges < MOST_EDGES);
    p->a[p->edges] = a;
    p->b[p->edges++] = b;
}

static void add_grid(problem *p, uint32_t width, uint32_t height, double left) {
    const uint32_t first = p->nodes;
    for (uint32_t i = 0; i < width * height; i++) {
        add_node(p, left + i % width, i / width);
    }
    for (uint32_t i = 0; i < width * height; i++) {
        const uint32_t column = i % width, row = i / width, at = first + i;
        const bool right = column + 1 < width, up = row + 1 < height;
        if (right) {
            add_edge(p, at, at + 1);
        }
        if (up) {
            add_edge(p, at + width, at);
        }
        if (right && up) {
            add_edge(p, at, at + width + 1);
            add_edge(p, at + 1, at + width);
        }
    }
}

static void add_random_graph(problem *p, uint32_t nodes, uint32_t edges, uint64_t *seed) {
    const uint32_t first = p->nodes;
    for (uint32_t i = 0; i < nodes; i++) {
        add_node(p, support_random_between(seed, 0, 100), support_random_between(seed, 0, 100));
    }
    for (uint32_t i = 0; i < edges; i++) {
        const uint32_t a = (uint32_t)(support_random(seed) % nodes);
        const uint32_t b = (a + 1 + (uint32_t)(support_random(seed) % (nodes - 1))) % nodes;
        add_edge(p, first + a, first + b);
    }
}

/// Blocks of springs of any direction with tension (t > 0) or none, and masses: positive definite. In float the
/// sums are rounded, which the masses outweigh.
static void fill_matrix(problem *p, double mass, uint64_t *seed) {
    memset(p->node, 0, sizeof p->node);
    for (uint32_t i = 0; i < p->nodes; i++) {
        p->node[0][i] = p->node[2][i] = mass * support_random_between(seed, 0.5, 2);
    }
    for (uint32_t e = 0; e < p->edges; e++) {
        const double angle = support_random_between(seed, 0, 6.3), k = support_random_between(seed, 0.1, 1);
        const double t = fmax(0, support_random_between(seed, -0.2, 0.2));
        const double nx = cos(angle), ny = sin(angle);
        const double block[3] = {k * (t + (1 - t) * nx * nx), k * (1 - t) * nx * ny, k * (t + (1 - t) * ny * ny)};
        for (int j = 0; j < 3; j++) {
            p->edge[j][e] = -block[j];
            p->node[j][p->a[e]] += block[j];
            p->node[j][p->b[e]] += block[j];
        }
    }
    for (int j = 0; j < 3; j++) {
        for (uint32_t i = 0; i < p->nodes; i++) {
            p->node_float[j][i] = (float)p->node[j][i];
        }
        for (uint32_t e = 0; e < p->edges; e++) {
            p->edge_float[j][e] = (float)p->edge[j][e];
        }
    }
}

static mspringi_cholesky_graph graph_of(const problem *p) {
    return (mspringi_cholesky_graph){p->nodes, p->edges, p->a, p->b, p->absent, p->x, p->y, 0};
}

static mspringi_cholesky_matrix_double double_matrix(const problem *p) {
    return (mspringi_cholesky_matrix_double){p->node[0], p->node[1], p->node[2],
                                             p->edge[0], p->edge[1], p->edge[2]};
}

static mspringi_cholesky_matrix_float float_matrix(const problem *p) {
    return (mspringi_cholesky_matrix_float){p->node_float[0], p->node_float[1], p->node_float[2],
                                            p->edge_float[0], p->edge_float[1], p->edge_float[2]};
}

/* ------------------------------------------------------------------------------------------- dense elimination */

static void put_block(double *matrix, size_t size, uint32_t row, uint32_t column, const double block[3]) {
    double *at = matrix + 2 * (row * size + column);
    at[0] += block[0];
    at[1] += block[1];
    at[size] += block[1];
    at[size + 1] += block[2];
}

/// Solve in place; absent nodes have 1 on the diagonal.
static void solve_dense(const problem *p, double *solution) {
    const size_t size = 2 * (size_t)p->nodes;
    double *matrix = calloc(size * size, sizeof *matrix);
    assert_non_null(matrix);
    for (uint32_t i = 0; i < p->nodes; i++) {
        const double one[3] = {1, 0, 1}, block[3] = {p->node[0][i], p->node[1][i], p->node[2][i]};
        put_block(matrix, size, i, i, p->absent[i] ? one : block);
    }
    for (uint32_t e = 0; e < p->edges; e++) {
        const double block[3] = {p->edge[0][e], p->edge[1][e], p->edge[2][e]};
        if (!p->absent[p->a[e]] && !p->absent[p->b[e]]) {
            put_block(matrix, size, p->a[e], p->b[e], block);
            put_block(matrix, size, p->b[e], p->a[e], block);
        }
    }
    for (size_t i = 0; i < size; i++) {
        for (size_t row = i + 1; row < size; row++) {
            const double factor = matrix[row * size + i] / matrix[i * size + i];
            for (size_t column = i; factor != 0 && column < size; column++) {
                matrix[row * size + column] -= factor * matrix[i * size + column];
            }
            solution[row] -= factor * solution[i];
        }
    }
    for (size_t i = size; i-- > 0;) {
        for (size_t column = i + 1; column < size; column++) {
            solution[i] -= matrix[i * size + column] * solution[column];
        }
        solution[i] /= matrix[i * size + i];
    }
    free(matrix);
}

/* ---------------------------------------------------------------------------------------------------- solving */

typedef struct solution {
    double x[MOST_NODES], y[MOST_NODES];
    float x_float[MOST_NODES], y_float[MOST_NODES];
} solution;

/// A right-hand side; the same in both precisions.
static void fill_right_side(const problem *p, solution *s) {
    uint64_t seed = 77;
    memset(s, 0, sizeof *s);
    for (uint32_t i = 0; i < p->nodes; i++) {
        s->x[i] = s->x_float[i] = (float)support_random_between(&seed, -1, 1);
        s->y[i] = s->y_float[i] = (float)support_random_between(&seed, -1, 1);
    }
}

/// Factor and solve at once, which is the same but for rounding.
static void solve_at_once(const problem *p, mspringi_cholesky_float *single, mspringi_cholesky_double *twice,
                          solution *s) {
    const mspringi_cholesky_matrix_float matrix_float = float_matrix(p);
    const mspringi_cholesky_matrix_double matrix_double = double_matrix(p);
    assert_int_equal(mspringi_cholesky_float_factor_solve(single, &matrix_float, s->x_float, s->y_float),
                     MSPRING_NONE);
    assert_int_equal(mspringi_cholesky_double_factor_solve(twice, &matrix_double, s->x, s->y), MSPRING_NONE);
}

/// Solve in both precisions: factor and solve one after the other and, into at_once unless that is NULL, at once.
/// Returns the products that a factorisation takes.
static double solve_sparse(const problem *p, mspring_simd level, solution *s, solution *at_once) {
    mspringi_memory memory;
    mspringi_message message;
    mspringi_cholesky_symbolic plan = {0};
    mspringi_cholesky_float single = {0};
    mspringi_cholesky_double twice = {0};
    const mspringi_cholesky_graph graph = graph_of(p);
    const mspringi_cholesky_matrix_float matrix_float = float_matrix(p);
    const mspringi_cholesky_matrix_double matrix_double = double_matrix(p);
    check_ok(mspringi_memory_init(&memory, NULL, &message));
    check_ok(mspringi_cholesky_symbolic_create(&plan, &graph, &memory, &message));
    check_ok(mspringi_cholesky_float_create(&single, &plan, level, &memory, &message));
    check_ok(mspringi_cholesky_double_create(&twice, &plan, level, &memory, &message));
    assert_int_equal(mspringi_cholesky_float_factor(&single, &matrix_float), MSPRING_NONE);
    assert_int_equal(mspringi_cholesky_double_factor(&twice, &matrix_double), MSPRING_NONE);
    mspringi_cholesky_float_solve(&single, s->x_float, s->y_float);
    mspringi_cholesky_double_solve(&twice, s->x, s->y);
    if (at_once) {
        solve_at_once(p, &single, &twice, at_once);
    }
    const double products = plan.multiply_adds;
    mspringi_cholesky_float_destroy(&single, &memory);
    mspringi_cholesky_double_destroy(&twice, &memory);
    mspringi_cholesky_symbolic_destroy(&plan, &memory);
    assert_int_equal(memory.used, 0);
    return products;
}

static double largest_error(const problem *p, const solution *s, const double *dense, bool in_float) {
    double largest = 0, scale = 0;
    for (uint32_t i = 0; i < p->nodes; i++) {
        const double x = in_float ? (double)s->x_float[i] : s->x[i];
        const double y = in_float ? (double)s->y_float[i] : s->y[i];
        assert_true(isfinite(x) && isfinite(y));
        largest = fmax(largest, fmax(fabs(x - dense[2 * i]), fabs(y - dense[2 * i + 1])));
        scale = fmax(scale, fmax(fabs(dense[2 * i]), fabs(dense[2 * i + 1])));
    }
    return scale > 0 ? largest / scale : largest;
}

/// Solve a problem sparse and dense and at both levels.
static void check_problem(const problem *p) {
    enum { LEVEL, LEVEL_AT_ONCE, SCALAR, SCALAR_AT_ONCE, WAYS };
    solution *s = malloc(WAYS * sizeof *s);
    double *dense = malloc(2 * (size_t)p->nodes * sizeof *dense + 1);
    assert_true(s && dense);
    for (int way = 0; way < WAYS; way++) {
        fill_right_side(p, &s[way]);
    }
    for (uint32_t i = 0; i < p->nodes; i++) {
        dense[2 * i] = s->x[i];
        dense[2 * i + 1] = s->y[i];
    }
    solve_dense(p, dense);
    solve_sparse(p, tested_level, &s[LEVEL], &s[LEVEL_AT_ONCE]);
    solve_sparse(p, MSPRING_SIMD_SCALAR, &s[SCALAR], &s[SCALAR_AT_ONCE]);
    assert_memory_equal(&s[LEVEL], &s[SCALAR], 2 * sizeof *s);
    // Conditions of these matrices are below 1,000; rounding is 1.1e-16 and 6e-8, and adds up over some products.
    for (int way = LEVEL; way <= LEVEL_AT_ONCE; way++) {
        check_near(largest_error(p, &s[way], dense, false), 0, 1e-12);
        check_near(largest_error(p, &s[way], dense, true), 0, 5e-4);
    }
    free(s);
    free(dense);
}

static problem *new_problem(void) {
    problem *p = calloc(1, sizeof *p);
    assert_non_null(p);
    return p;
}

/// Fill in the matrix, check, and check again with absurd positions, with equal ones, and with absent nodes.
static void check_and_free(problem *p, uint64_t *seed) {
    fill_matrix(p, 0.05, seed);
    check_problem(p);
    for (uint32_t i = 0; i < p->nodes; i++) {
        p->x[i] = p->y[i] = i % 7 == 3 ? 1e300 : -1e300;
    }
    check_problem(p);
    for (uint32_t i = 0; i < p->nodes; i++) {
        p->x[i] = p->y[i] = 3;
        p->absent[i] = support_random(seed) % 5 == 0;
    }
    check_problem(p);
    free(p);
}

/* ------------------------------------------------------------------------------------------------------- tests */

static void grids(void **state) {
    (void)state;
    const uint32_t sides[][2] = {{1, 1}, {2, 1}, {2, 2}, {3, 3}, {40, 3}, {5, 60}, {24, 25}, {1, 300}};
    uint64_t seed = 1;
    for (size_t i = 0; i < COUNT_OF(sides); i++) {
        problem *p = new_problem();
        add_grid(p, sides[i][0], sides[i][1], 0);
        check_and_free(p, &seed);
    }
}

// Every number of pivots and of border rows up to what tiles of four 16-wide vectors make of them: complete graphs
// have one front, and two that share nodes have two with a border.
static void fronts_of_every_size(void **state) {
    (void)state;
    uint64_t seed = 2;
    for (uint32_t size = 1; size <= 72; size += 5 / ROUNDS(5)) {
        problem *p = new_problem();
        for (uint32_t i = 0; i < size; i++) {
            add_node(p, i, 0);
            for (uint32_t j = 0; j < i; j++) {
                add_edge(p, i, j);
            }
        }
        fill_matrix(p, 0.05, &seed);
        check_problem(p);
        free(p);
    }
    for (uint32_t shared = 1; shared <= 40; shared += 3) {
        problem *p = new_problem();
        for (uint32_t i = 0; i < 2 * shared + 24; i++) {
            add_node(p, i, 0);
            for (uint32_t j = i > shared + 12 ? i - shared - 12 : 0; j < i; j++) {
                add_edge(p, i, j);
            }
        }
        fill_matrix(p, 0.05, &seed);
        check_problem(p);
        free(p);
    }
}

// Bands of every width that there is a banded factor for and one more, of even and odd length, with random edges
// within them, some doubled, from none at all on; numbered at random, so that the order is not the given one.
static void bands(void **state) {
    (void)state;
    uint64_t seed = 8;
    for (uint32_t width = 0; width <= 8; width++) {
        for (uint32_t count = 1; count < 60; count += count < 10 ? 1 : 23) {
            problem *p = new_problem();
            uint32_t number[64];
            for (uint32_t i = 0; i < count; i++) {
                const uint32_t swapped = (uint32_t)(support_random(&seed) % (i + 1));
                number[i] = number[swapped];
                number[swapped] = i;
            }
            for (uint32_t i = 0; i < count; i++) {
                add_node(p, 0, 0);
            }
            for (uint32_t i = 0; i < count; i++) {
                p->x[number[i]] = i;
                for (uint32_t other = i + 1; other <= i + width && other < count; other++) {
                    for (uint32_t copies = (uint32_t)(support_random(&seed) % 4); copies > 1; copies--) {
                        add_edge(p, number[i], number[other]);
                    }
                }
            }
            check_and_free(p, &seed);
        }
    }
}

static void check_groups(const problem *p, uint32_t groups) {
    mspringi_memory memory;
    mspringi_message message;
    mspringi_cholesky_symbolic plan = {0};
    const mspringi_cholesky_graph graph = graph_of(p);
    check_ok(mspringi_memory_init(&memory, NULL, &message));
    check_ok(mspringi_cholesky_symbolic_create(&plan, &graph, &memory, &message));
    assert_int_equal(plan.band_groups, groups);
    mspringi_cholesky_symbolic_destroy(&plan, &memory);
}

// What is thin takes a band, whichever way it lies and however it is bent, and what is not takes none.
static void thin_is_banded(void **state) {
    (void)state;
    static const struct {
        uint32_t width, height, groups;
    } sizes[] = {{90, 5, 225}, {5, 90, 225}, {1, 77, 39}, {60, 6, 0}, {20, 20, 0}};
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        problem *p = new_problem();
        add_grid(p, sizes[i].width, sizes[i].height, 0);
        check_groups(p, sizes[i].groups);
        // Most of a circle, so that no line has an order along it.
        for (uint32_t node = 0; node < sizes[i].width * sizes[i].height; node++) {
            const bool lies = sizes[i].width > sizes[i].height;
            const double along = lies ? p->x[node] : p->y[node], radius = 20.0 + (lies ? p->y[node] : p->x[node]);
            p->x[node] = radius * cos(along / 16.0);
            p->y[node] = radius * sin(along / 16.0);
        }
        check_groups(p, sizes[i].groups);
        free(p);
    }
}

static void trees_stars_and_rings(void **state) {
    (void)state;
    uint64_t seed = 3;
    problem *tree = new_problem();
    add_node(tree, 0, 0);
    for (uint32_t i = 1; i < 500; i++) {
        add_node(tree, support_random_between(&seed, 0, 9), support_random_between(&seed, 0, 9));
        add_edge(tree, i, (uint32_t)(support_random(&seed) % i));
    }
    check_and_free(tree, &seed);
    problem *star = new_problem();
    add_node(star, 0, 0);
    for (uint32_t i = 1; i < 300; i++) {
        add_edge(star, 0, add_node(star, cos(i), sin(i)));
    }
    check_and_free(star, &seed);
    problem *ring = new_problem();
    for (uint32_t i = 0; i < 200; i++) {
        add_edge(ring, add_node(ring, cos(i * 0.0314), sin(i * 0.0314)), (i + 1) % 200);
    }
    check_and_free(ring, &seed);
}

static void random_graphs(void **state) {
    (void)state;
    const uint32_t sizes[][2] = {{10, 20}, {100, 120}, {200, 800}, {400, 600}};
    uint64_t seed = 4;
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        problem *p = new_problem();
        add_random_graph(p, sizes[i][0], sizes[i][1], &seed); // with edges that join the same nodes
        check_and_free(p, &seed);
    }
}

static void many_parts(void **state) {
    (void)state;
    uint64_t seed = 5;
    problem *p = new_problem();
    add_grid(p, 20, 10, 0);
    add_grid(p, 50, 2, 5);
    add_node(p, 3, 3); // without an edge
    add_random_graph(p, 60, 90, &seed);
    for (uint32_t i = 0; i < 20; i++) {
        add_node(p, -1, i);
    }
    check_and_free(p, &seed);
}

static void nothing_there(void **state) {
    (void)state;
    uint64_t seed = 6;
    problem *p = new_problem();
    check_problem(p); // no node at all
    add_grid(p, 4, 4, 0);
    fill_matrix(p, 1, &seed);
    for (uint32_t i = 0; i < p->nodes; i++) {
        p->absent[i] = true;
    }
    solution *s = malloc(sizeof *s), *before = malloc(sizeof *before);
    assert_true(s && before);
    fill_right_side(p, s);
    *before = *s;
    solve_sparse(p, tested_level, s, NULL);
    assert_memory_equal(s, before, sizeof *s);
    free(s);
    free(before);
    free(p);
}

static void order_is_good(void **state) {
    (void)state;
    uint64_t seed = 7;
    solution *s = malloc(sizeof *s);
    assert_non_null(s);
    // A bar 5 wide: a band of 13 numbers has 13^2 / 2 products for each column; merged fronts up to twice as many.
    problem *bar = new_problem();
    add_grid(bar, 120, 5, 0);
    fill_matrix(bar, 1, &seed);
    assert_true(solve_sparse(bar, tested_level, s, NULL) < 3 * 1200 * 13 * 13 / 2.0);
    free(bar);
    // A square of n x n: nested dissection has 829 / 84 n^3 products (George 1973), for blocks 8 times that.
    problem *square = new_problem();
    add_grid(square, 26, 26, 0);
    fill_matrix(square, 1, &seed);
    assert_true(solve_sparse(square, tested_level, s, NULL) < 8 * 829 / 84.0 * 26 * 26 * 26);
    free(square);
    // A rope, whatever the numbers of its nodes: no fill but what merging adds.
    problem *rope = new_problem();
    for (uint32_t i = 0; i < 700; i++) {
        add_node(rope, i * 37 % 700, 0);
    }
    for (uint32_t i = 0; i + 1 < 700; i++) {
        add_edge(rope, i * 19 % 700, (i + 1) * 19 % 700);
    }
    fill_matrix(rope, 1, &seed);
    assert_true(solve_sparse(rope, tested_level, s, NULL) < 700 * 2 * 20 * 20);
    free(rope);
    free(s);
}

/* ------------------------------------------------------------------------------------------------------ errors */

typedef struct solver {
    mspringi_memory memory;
    mspringi_message message;
    mspringi_cholesky_symbolic plan;
    mspringi_cholesky_float single;
    mspringi_cholesky_double twice;
} solver;

static mspring_result try_solver(solver *made, const problem *p, const mspring_allocator *allocator) {
    const mspringi_cholesky_graph graph = graph_of(p);
    memset(made, 0, sizeof *made);
    check_ok(mspringi_memory_init(&made->memory, allocator, &made->message));
    mspring_result result = mspringi_cholesky_symbolic_create(&made->plan, &graph, &made->memory, &made->message);
    if (result == MSPRING_OK) {
        result =
            mspringi_cholesky_float_create(&made->single, &made->plan, tested_level, &made->memory, &made->message);
    }
    if (result == MSPRING_OK) {
        result =
            mspringi_cholesky_double_create(&made->twice, &made->plan, tested_level, &made->memory, &made->message);
    }
    return result;
}

static void free_solver(solver *made) {
    mspringi_cholesky_float_destroy(&made->single, &made->memory);
    mspringi_cholesky_double_destroy(&made->twice, &made->memory);
    mspringi_cholesky_symbolic_destroy(&made->plan, &made->memory);
    assert_int_equal(made->memory.used, 0);
}

static void bad_pivots_are_named(void **state) {
    (void)state;
    uint64_t seed = 8;
    problem *p = new_problem();
    solver made;
    add_grid(p, 20, 9, 0);
    fill_matrix(p, 1, &seed);
    check_ok(try_solver(&made, p, NULL));
    const mspringi_cholesky_matrix_float matrix = float_matrix(p);
    const mspringi_cholesky_matrix_double matrix_double = double_matrix(p);
    const double bad[] = {-50, 0, -0.0, NAN, INFINITY, -INFINITY, 1e-310};
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        for (uint32_t node = 0; node < p->nodes; node += 7) {
            const double xx = p->node[0][node], yy = p->node[2][node];
            // Without the springs' part it is this node or, if the pivot is left positive by chance, one after it.
            p->node[0][node] = bad[i];
            p->node_float[0][node] = (float)bad[i];
            const uint32_t named = mspringi_cholesky_double_factor(&made.twice, &matrix_double);
            const uint32_t named_float = mspringi_cholesky_float_factor(&made.single, &matrix);
            assert_true(named < p->nodes);
            assert_true(named_float < p->nodes);
            if (bad[i] == -50 || bad[i] == 0 || !isfinite(bad[i])) {
                assert_int_equal(named, node);
                assert_int_equal(named_float, node);
            }
            p->node[0][node] = xx;
            p->node_float[0][node] = (float)xx;
            p->node[2][node] = -yy;
            assert_int_equal(mspringi_cholesky_double_factor(&made.twice, &matrix_double), node);
            double x[MOST_NODES] = {7}, y[MOST_NODES] = {0, 8};
            assert_int_equal(mspringi_cholesky_double_factor_solve(&made.twice, &matrix_double, x, y), node);
            assert_true(x[0] == 7 && x[1] == 0 && y[0] == 0 && y[1] == 8); // b is still there
            p->node[2][node] = yy;
        }
    }
    // After that they work as ever.
    assert_int_equal(mspringi_cholesky_double_factor(&made.twice, &matrix_double), MSPRING_NONE);
    assert_int_equal(mspringi_cholesky_float_factor(&made.single, &matrix), MSPRING_NONE);
    free_solver(&made);
    check_problem(p);
    free(p);
}

/// What is counted is what there is, in any order: here of numbers, from the first on and from the last.
static void check_count(const problem *p) {
    mspringi_memory memory;
    mspringi_message message;
    mspringi_adjacency adjacency;
    mspringi_tree tree = {0};
    double most = 1e9;
    const mspringi_cholesky_graph graph = graph_of(p);
    check_ok(mspringi_memory_init(&memory, NULL, &message));
    check_ok(mspringi_adjacency_begin(&adjacency, &graph, &memory, &message));
    mspringi_adjacency_count(&adjacency, &graph, 0, graph.edge_count);
    mspringi_adjacency_add_up(&adjacency);
    mspringi_adjacency_list(&adjacency, &graph, 0, graph.edge_count);
    check_ok(mspringi_tree_create(&tree, adjacency.size, &memory, &message));
    uint32_t *order = mspringi_alloc(&memory, 2 * (size_t)adjacency.size, sizeof *order);
    assert_non_null(order);
    for (int way = 0; way < 2; way++) {
        for (uint32_t i = 0; i < adjacency.size; i++) {
            order[i] = way == 0 ? i : adjacency.size - 1 - i;
        }
        mspringi_tree_begin(&tree, order, 0, adjacency.size, 1e9);
        while (!mspringi_tree_run(&tree, &adjacency, &most)) {
            assert_true(most > 0);
        }
        assert_true(tree.fits && tree.cost.blocks == mspringi_tree_count(&tree, &adjacency, order, 0,
                                                                         adjacency.size, order + adjacency.size));
    }
    mspringi_free_all(&memory);
}

static void too_large_is_predicted(void **state) {
    (void)state;
    uint64_t seed = 17;
    for (uint32_t n = 0; n < 60; n++) {
        problem *p = calloc(1, sizeof *p);
        assert_non_null(p);
        if (n % 3 == 0) {
            add_grid(p, 1 + n / 2, 1 + n % 7, 0);
        }
        add_random_graph(p, 2 + n, n % 3 == 1 ? n / 2 : 2 * n, &seed);
        check_count(p);
        mspringi_memory memory;
        mspringi_message message;
        mspringi_cholesky_symbolic plan;
        mspringi_cholesky_graph graph = graph_of(p);
        graph.most_numbers = 4;
        check_ok(mspringi_memory_init(&memory, NULL, &message));
        const mspring_result result = mspringi_cholesky_symbolic_create(&plan, &graph, &memory, &message);
        // Bands are as small as can be.
        if (result != MSPRING_OK) {
            assert_int_equal(result, MSPRING_ERROR_LIMIT);
            assert_true(plan.predicted_numbers >= 4.0 * (p->nodes - 1));
            assert_null(plan.order);
        } else {
            assert_true(plan.band_groups > 0);
        }
        mspringi_free_all(&memory);
        free(p);
    }
}

static void factors_again_with_the_same_bits_and_no_memory(void **state) {
    (void)state;
    uint64_t seed = 9;
    problem *p = new_problem();
    solution *first = malloc(sizeof *first), *again = malloc(sizeof *again);
    watched_allocator watched = {0};
    const mspring_allocator allocator = watched_interface(&watched);
    solver made;
    assert_true(first && again);
    add_grid(p, 17, 13, 0);
    add_random_graph(p, 100, 150, &seed);
    check_ok(try_solver(&made, p, &allocator));
    const size_t calls = watched.calls;
    for (int round = 0; round < 3; round++) {
        uint64_t other = 10 + (uint64_t)(round % 2);
        fill_matrix(p, 0.1, &other);
        const mspringi_cholesky_matrix_float matrix = float_matrix(p);
        const mspringi_cholesky_matrix_double matrix_double = double_matrix(p);
        fill_right_side(p, again);
        assert_int_equal(mspringi_cholesky_float_factor(&made.single, &matrix), MSPRING_NONE);
        assert_int_equal(mspringi_cholesky_double_factor(&made.twice, &matrix_double), MSPRING_NONE);
        mspringi_cholesky_float_solve(&made.single, again->x_float, again->y_float);
        mspringi_cholesky_double_solve(&made.twice, again->x, again->y);
        if (round == 0) {
            *first = *again;
        }
    }
    assert_memory_equal(first, again, sizeof *first);
    assert_int_equal(watched.calls, calls);
    free_solver(&made);
    check_watched_clean(&watched);
    free(first);
    free(again);
    free(p);
}

static void every_allocation_may_fail(void **state) {
    (void)state;
    uint64_t seed = 11;
    problem *p = new_problem();
    solver made;
    add_grid(p, 9, 7, 0);
    add_random_graph(p, 40, 60, &seed);
    fill_matrix(p, 1, &seed);
    for (size_t fail_at = 1;; fail_at++) {
        watched_allocator watched = {.fail_at = fail_at};
        const mspring_allocator allocator = watched_interface(&watched);
        const mspring_result result = try_solver(&made, p, &allocator);
        if (result != MSPRING_OK) {
            check_error(result, MSPRING_ERROR_MEMORY);
            check_contains(made.message.text, "memory");
        }
        free_solver(&made);
        check_watched_clean(&watched);
        if (result == MSPRING_OK) {
            assert_true(fail_at > 20);
            break;
        }
    }
    free(p);
}

int main(int argc, char **argv) {
    tested_level = level_from_arguments(argc, argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(grids),
        cmocka_unit_test(fronts_of_every_size),
        cmocka_unit_test(bands),
        cmocka_unit_test(thin_is_banded),
        cmocka_unit_test(trees_stars_and_rings),
        cmocka_unit_test(random_graphs),
        cmocka_unit_test(many_parts),
        cmocka_unit_test(nothing_there),
        cmocka_unit_test(order_is_good),
        cmocka_unit_test(bad_pivots_are_named),
        cmocka_unit_test(too_large_is_predicted),
        cmocka_unit_test(factors_again_with_the_same_bits_and_no_memory),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("cholesky", tests, NULL, NULL);
}

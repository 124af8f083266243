/// @file test_constraints.c
/// Constraints of a linear system: each service against a dense matrix in double precision, for random lists of all
/// bounds, open and closed, with shared particles.
///
/// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solvers/constraints/constraint_services.h"
#include "solvers/implicit/implicit.h"
#include "support.h"

enum { SLOTS = 2 * MSPRINGI_WIDTH, SIZE = 2 * SLOTS, MOST = 48, MOST_ENTRIES = 8 };

/// Rounding to single precision, relative.
#define ROUNDED 0x1p-24

typedef double matrix[SIZE][SIZE];

static struct {
    mspringi_constraint list[MOST];
    mspringi_jacobian_entry entries[MOST * MOST_ENTRIES];
    mspringi_multiplier multipliers[2 * MOST];
    mspringi_active_constraint active[MOST];
} room;
static mspringi_constraints all;
static float from[SIZE], to[SIZE], blocks[3 * SLOTS];
static matrix dense, sizes; ///< J' stiffness J of what the matrix has, and the same of absolute values

static double between(uint64_t *seed, double low, double high) {
    return support_random_between(seed, low, high);
}

static uint32_t below(uint64_t *seed, uint32_t count) {
    return (uint32_t)(support_random(seed) % count);
}

static mspringi_field field_of(float *values) {
    return (mspringi_field){values, values + SLOTS};
}

/* ------------------------------------------------------------------------------------------------ random lists */

// Entries at different slots; with is_closed they add up to 0.
static void add_entries(uint64_t *seed, mspringi_constraint *c, uint32_t count, bool is_closed) {
    uint32_t slots[SLOTS];
    double x = 0.0, y = 0.0;
    for (uint32_t i = 0; i < SLOTS; i++) {
        slots[i] = i;
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t other = i + below(seed, SLOTS - i), slot = slots[other];
        slots[other] = slots[i];
        mspringi_constraint_add_entry(&all, slot, between(seed, -1, 1), between(seed, -1, 1));
        x += i > 0 ? all.entries[c->first + i].x : 0.0;
        y += i > 0 ? all.entries[c->first + i].y : 0.0;
    }
    c->is_closed = is_closed;
    if (is_closed) {
        all.entries[c->first].x = -x;
        all.entries[c->first].y = -y;
    }
}

static mspringi_constraint *add(uint64_t *seed, mspringi_constraint_kind kind, mspringi_constraint_bound bounded) {
    const uint32_t count =
        kind == MSPRINGI_FLOOR_CONSTRAINT || kind == MSPRINGI_GRIP_CONSTRAINT ? 1 : 1 + below(seed, MOST_ENTRIES);
    mspringi_constraint *c = mspringi_constraint_add(&all, kind, 7, count);
    add_entries(seed, c, count, count > 1 && below(seed, 2));
    c->bounded = (uint8_t)bounded;
    c->stiffness = between(seed, 0.1, 10);
    c->effort = between(seed, -3, 3);
    c->bound = between(seed, 0, 2);
    c->bound_force = between(seed, -1, 1);
    return c;
}

// A push that is idle at times, and its friction in each of its states.
static void add_push(uint64_t *seed, mspringi_constraint_kind kind) {
    add(seed, kind, MSPRINGI_BOUND_PUSH)->activity = below(seed, 3) ? MSPRINGI_STIFF : MSPRINGI_IDLE;
    if (below(seed, 4)) {
        add(seed, kind, MSPRINGI_BOUND_FRICTION)->activity = below(seed, 2) ? MSPRINGI_STIFF : MSPRINGI_AT_BOUND;
    }
}

static void add_pair(uint64_t *seed) {
    const uint8_t activity = below(seed, 3) ? MSPRINGI_STIFF : MSPRINGI_AT_BOUND;
    add(seed, MSPRINGI_GRIP_CONSTRAINT, MSPRINGI_BOUND_OF_PAIR)->activity = activity;
    add(seed, MSPRINGI_GRIP_CONSTRAINT, MSPRINGI_SECOND_OF_PAIR)->activity = activity;
}

// In the order of the kinds.
static void make_list(uint64_t *seed) {
    memset(&room, 0, sizeof room);
    all = (mspringi_constraints){.list = room.list,
                                 .entries = room.entries,
                                 .multipliers = room.multipliers,
                                 .active = room.active,
                                 .capacity = MOST,
                                 .entry_capacity = MOST * MOST_ENTRIES,
                                 .multiplier_capacity = 2 * MOST,
                                 .active_capacity = MOST};
    mspringi_constraints_begin(&all);
    for (uint32_t i = below(seed, 8); i > 0; i--) {
        add(seed, MSPRINGI_ANGLE_CONSTRAINT, MSPRINGI_UNBOUNDED);
    }
    all.element_count = all.count;
    all.element_entry_count = all.entry_count;
    for (uint32_t i = below(seed, 6); i > 0; i--) {
        add_push(seed, MSPRINGI_FLOOR_CONSTRAINT);
    }
    for (uint32_t i = below(seed, 4); i > 0; i--) {
        add_pair(seed);
    }
    for (uint32_t i = below(seed, 9); i > 0; i--) {
        add_push(seed, MSPRINGI_CONTACT_CONSTRAINT);
    }
    mspringi_constraints_activate(&all);
}

/* ------------------------------------------------------------------------------------- the same, as definitions */

static bool acts(const mspringi_constraint *c) {
    return c->activity != MSPRINGI_IDLE &&
           !(c->bounded == MSPRINGI_BOUND_FRICTION && c[-1].activity == MSPRINGI_IDLE);
}

static void row_of(const mspringi_constraint *c, double row[SIZE]) {
    memset(row, 0, SIZE * sizeof *row);
    for (uint32_t i = 0; i < c->count; i++) {
        const mspringi_jacobian_entry *e = &all.entries[c->first + i];
        row[e->slot] = e->x;
        row[SLOTS + e->slot] = e->y;
    }
}

// Sizes of its parts. The first one of a closed constraint is a sum.
static void sizes_of(const mspringi_constraint *c, double row[SIZE]) {
    const mspringi_jacobian_entry *e = &all.entries[c->first];
    row_of(c, row);
    for (int k = 0; k < SIZE; k++) {
        row[k] = fabs(row[k]);
    }
    for (uint32_t i = 1; i < c->count && c->is_closed; i++) {
        row[e->slot] = (i > 1 ? row[e->slot] : 0.0) + fabs(e[i].x);
        row[SLOTS + e->slot] = (i > 1 ? row[SLOTS + e->slot] : 0.0) + fabs(e[i].y);
    }
}

static void add_outer(matrix sum, const double row[SIZE], double stiffness) {
    for (int i = 0; i < SIZE; i++) {
        for (int j = 0; j < SIZE; j++) {
            sum[i][j] += stiffness * row[i] * row[j];
        }
    }
}

static double dot(const double row[SIZE], const float values[SIZE]) {
    double sum = 0.0;
    for (int i = 0; i < SIZE; i++) {
        sum += row[i] * (double)values[i];
    }
    return sum;
}

static void make_dense(void) {
    double row[SIZE];
    memset(dense, 0, sizeof dense);
    memset(sizes, 0, sizeof sizes);
    for (uint32_t i = 0; i < all.count; i++) {
        const mspringi_constraint *c = &all.list[i];
        if (!acts(c) || c->activity != MSPRINGI_STIFF) {
            continue;
        }
        row_of(c, row);
        add_outer(dense, row, c->stiffness);
        sizes_of(c, row);
        add_outer(sizes, row, c->stiffness);
    }
}

static void fill(uint64_t *seed, float values[SIZE]) {
    for (int i = 0; i < SIZE; i++) {
        values[i] = (float)between(seed, -1, 1);
    }
}

/* ----------------------------------------------------------------------------------------------------- services */

static void check_active(void) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < all.count; i++) {
        const mspringi_constraint *c = &all.list[i];
        if (acts(c) && c->activity == MSPRINGI_STIFF) {
            assert_int_equal(all.active[count++].first, c->first);
        }
    }
    assert_int_equal(count, all.active_count);
}

/// Each of at most MOST constraints rounds its force at a particle, and the sum there, once. Forces of closed ones
/// are sums of up to MOST_ENTRIES.
#define MOST_ROUNDINGS (2.0 * MOST + MOST_ENTRIES)

// Multiply as one worker, and as two that divide the slots: the bits are the same.
static double multiply(void) {
    float shared[SIZE];
    double whole = 0.0, sums[2] = {0.0, 0.0};
    memcpy(shared, to, sizeof to);
    mspringi_constraints_multiply(&all, &(mspringi_product){field_of(from), field_of(to), {0, SLOTS}, &whole});
    const size_t border = all.entry_count % SLOTS;
    mspringi_constraints_multiply(
        &all, &(mspringi_product){field_of(from), field_of(shared), {0, border}, &sums[0]});
    mspringi_constraints_multiply(
        &all, &(mspringi_product){field_of(from), field_of(shared), {border, SLOTS}, &sums[1]});
    assert_memory_equal(shared, to, sizeof to);
    check_near(sums[0] + sums[1], whole, 1e-13 * (fabs(sums[0]) + fabs(sums[1])));
    return whole;
}

static void products_are_those_of_the_matrix(void **state) {
    (void)state;
    for (uint64_t round = 0; round < ROUNDS(500); round++) {
        uint64_t seed = round;
        double sum = 0.0, whole = 0.0;
        make_list(&seed);
        make_dense();
        check_active();
        fill(&seed, from);
        fill(&seed, to);
        float before[SIZE];
        memcpy(before, to, sizeof to);
        const double found = multiply();
        for (int i = 0; i < SIZE; i++) {
            double product = 0.0, size = fabs((double)before[i]);
            for (int j = 0; j < SIZE; j++) {
                product += dense[i][j] * (double)from[j];
                size += sizes[i][j] * fabs((double)from[j]);
            }
            check_near(to[i], (double)before[i] + product, MOST_ROUNDINGS * ROUNDED * size);
            sum += (double)from[i] * product;
            whole += fabs((double)from[i]) * size;
        }
        check_near(found, sum, 1e-13 * whole); // all of it is in double precision
    }
}

// Reference of assembly: the right-hand side and its size, and the diagonal blocks.
static void assemble_dense(bool is_factored, double forces[SIZE], double size[SIZE]) {
    double row[SIZE], all_sizes[SIZE];
    memset(forces, 0, SIZE * sizeof *forces);
    memset(size, 0, SIZE * sizeof *size);
    for (uint32_t i = 0; i < all.count; i++) {
        const mspringi_constraint *c = &all.list[i];
        const bool is_stiff = c->activity == MSPRINGI_STIFF;
        const bool is_beside = (c->count > 1 || c->kind == MSPRINGI_CONTACT_CONSTRAINT) && is_stiff;
        if (!acts(c) || (is_factored && is_beside)) {
            continue;
        }
        const double force = is_stiff ? c->effort : c->bound_force;
        sizes_of(c, all_sizes);
        row_of(c, row);
        for (int k = 0; k < SIZE; k++) {
            forces[k] += force * row[k];
            size[k] += fabs(force) * all_sizes[k];
        }
        if (is_stiff) {
            add_outer(dense, row, c->stiffness);
        }
    }
}

static void check_assembly(bool is_factored) {
    const mspringi_system system = {
        .force_x = to, .force_y = to + SLOTS, .xx = blocks, .xy = blocks + SLOTS, .yy = blocks + 2 * (size_t)SLOTS};
    double forces[SIZE], size[SIZE];
    memset(to, 0, sizeof to);
    memset(blocks, 0, sizeof blocks);
    memset(dense, 0, sizeof dense);
    mspringi_constraints_assemble(&all, 0, all.element_count, &system, is_factored);
    mspringi_constraints_assemble(&all, all.element_count, all.count, &system, is_factored);
    assemble_dense(is_factored, forces, size);
    for (int i = 0; i < SLOTS; i++) {
        const double most = MOST_ROUNDINGS * ROUNDED * (dense[i][i] + dense[SLOTS + i][SLOTS + i]);
        check_near(to[i], forces[i], MOST_ROUNDINGS * ROUNDED * size[i] + DBL_MIN);
        check_near(to[SLOTS + i], forces[SLOTS + i], MOST_ROUNDINGS * ROUNDED * size[SLOTS + i] + DBL_MIN);
        check_near(blocks[i], dense[i][i], most);
        check_near(blocks[SLOTS + i], dense[i][SLOTS + i], most);
        check_near(blocks[2 * SLOTS + i], dense[SLOTS + i][SLOTS + i], most);
    }
}

static void assembly_is_that_of_the_matrix(void **state) {
    (void)state;
    for (uint64_t round = 0; round < ROUNDS(500); round++) {
        uint64_t seed = round;
        make_list(&seed);
        check_assembly(false);
        check_assembly(true);
    }
}

static void particles_get_the_blocks_of_their_own(void **state) {
    (void)state;
    for (uint64_t round = 0; round < ROUNDS(500); round++) {
        uint64_t seed = round;
        double node[3][SLOTS] = {{0}}, row[SIZE];
        make_list(&seed);
        memset(dense, 0, sizeof dense);
        for (uint32_t i = all.element_count; i < all.count; i++) {
            const mspringi_constraint *c = &all.list[i];
            if (c->count == 1 && c->kind != MSPRINGI_CONTACT_CONSTRAINT && acts(c) &&
                c->activity == MSPRINGI_STIFF) {
                row_of(c, row);
                add_outer(dense, row, c->stiffness);
            }
        }
        mspringi_constraints_add_nodes(&all, node[0], node[1], node[2]);
        for (int i = 0; i < SLOTS; i++) { // sums of at most MOST products in double precision
            const double most = MOST * DBL_EPSILON * (dense[i][i] + dense[SLOTS + i][SLOTS + i]);
            check_near(node[0][i], dense[i][i], most);
            check_near(node[1][i], dense[i][SLOTS + i], most);
            check_near(node[2][i], dense[SLOTS + i][SLOTS + i], most);
        }
    }
}

/* --------------------------------------------------------------------------------------------------- active set */

/// Passes in which constraints may be released or begin to slide, and in which all contacts count; the share of the
/// largest push of a contact, and the change of a bound, that count.
enum { FREE_PASSES = 12, PASSES_OF_ALL = 4 };
static const double small_share = 1e-3;
static const double same_force[MSPRINGI_CONSTRAINT_KINDS] = {
    [MSPRINGI_FLOOR_CONSTRAINT] = 0.02, [MSPRINGI_CONTACT_CONSTRAINT] = 0.1};

static bool expect_push(mspringi_constraint *c, double force, double small, bool is_free) {
    const mspringi_constraint old = *c;
    if (old.activity == MSPRINGI_STIFF) {
        c->activity = force < 0.0 && is_free ? MSPRINGI_IDLE : MSPRINGI_STIFF;
    } else {
        c->activity = force > c->bound ? MSPRINGI_STIFF : MSPRINGI_IDLE;
    }
    c->force = old.activity == MSPRINGI_STIFF ? force : 0.0;
    return c->activity != old.activity && fabs(force) > small;
}

// was: the list before. Sliding ends where friction would drive.
static bool expect_friction(const mspringi_constraint *was, mspringi_constraint *c, double force, double small,
                            bool is_free) {
    const double most = c->bound * fmax(c[-1].force, 0.0);
    if (was[-1].activity == MSPRINGI_IDLE) {
        return false;
    }
    const bool slid = was->activity == MSPRINGI_AT_BOUND;
    const bool is_forwards = slid ? !signbit(was->bound_force) : force >= 0.0;
    c->force = slid ? was->bound_force : force;
    c->bound_force = is_forwards ? most : -most;
    if (slid) {
        c->activity = is_forwards == (force >= 0.0) || force == 0.0 ? MSPRINGI_AT_BOUND : MSPRINGI_STIFF;
    } else {
        c->activity = is_free && fabs(force) > most ? MSPRINGI_AT_BOUND : MSPRINGI_STIFF;
    }
    const bool slides = c->activity == MSPRINGI_AT_BOUND;
    const bool is_other = fabs(c->bound_force - was->bound_force) > fmax(same_force[c->kind] * most, small);
    const bool is_large = fabs((slides ? c->bound_force : force) - c->force) > small;
    return c[-1].activity != MSPRINGI_IDLE && (slides != slid ? is_large : slides && is_free && is_other);
}

static bool expect_pair(const mspringi_constraint *was, mspringi_constraint *c, double x, double y) {
    const double size = hypot(x, y), share = size > c->bound ? c->bound / size : 1.0;
    if (was->activity == MSPRINGI_AT_BOUND) {
        return false;
    }
    c[0].force = c[0].bound_force = share * x;
    c[1].force = c[1].bound_force = share * y;
    c[0].activity = c[1].activity = size > c->bound ? MSPRINGI_AT_BOUND : MSPRINGI_STIFF;
    return size > c->bound;
}

static double force_of(const mspringi_constraint *c, const float direction[SIZE], double alpha) {
    double row[SIZE];
    row_of(c, row);
    return c->effort - c->stiffness * (dot(row, from) + alpha * dot(row, direction));
}

static uint32_t expect_update(const mspringi_constraint *was, mspringi_constraint *list,
                              const float direction[SIZE], double alpha, uint32_t pass) {
    uint32_t changed = 0;
    double largest = 0;
    for (uint32_t i = all.element_count; i < all.count; i++) {
        const bool pushes = list[i].bounded == MSPRINGI_BOUND_PUSH && list[i].activity == MSPRINGI_STIFF;
        if (pushes && list[i].kind == MSPRINGI_CONTACT_CONSTRAINT) {
            largest = fmax(largest, force_of(&list[i], direction, alpha));
        }
    }
    for (uint32_t i = all.element_count; i < all.count; i++) {
        mspringi_constraint *c = &list[i];
        const double small = c->kind == MSPRINGI_CONTACT_CONSTRAINT && pass >= PASSES_OF_ALL ? small_share * largest : 0;
        const bool is_free = pass < FREE_PASSES;
        const double force = force_of(c, direction, alpha);
        bool has_changed = false;
        if (c->bounded == MSPRINGI_BOUND_PUSH) {
            has_changed = expect_push(c, force, small, is_free);
        } else if (c->bounded == MSPRINGI_BOUND_FRICTION) {
            has_changed = expect_friction(&was[i], c, force, small, is_free);
        } else if (c->bounded == MSPRINGI_BOUND_OF_PAIR) {
            has_changed = expect_pair(&was[i], c, force, force_of(c + 1, direction, alpha));
        }
        changed |= (uint32_t)has_changed << c->kind;
    }
    return changed;
}

static void active_sets_follow_from_forces(void **state) {
    (void)state;
    float direction[SIZE];
    for (uint64_t round = 0; round < ROUNDS(500); round++) {
        uint64_t seed = round;
        mspringi_constraint was[MOST], expected[MOST];
        make_list(&seed);
        fill(&seed, direction);
        const float alpha = round % 2 ? (float)between(&seed, -1, 1) : 0.0f;
        for (uint32_t pass = 0; pass < 14; pass++) {
            fill(&seed, from);
            memcpy(was, all.list, sizeof was);
            memcpy(expected, all.list, sizeof expected);
            const uint32_t changed = expect_update(was, expected, direction, (double)alpha, pass);
            assert_int_equal(
                mspringi_constraints_update_active_set(&all, field_of(from), field_of(direction), alpha, pass),
                changed);
            for (uint32_t i = 0; i < all.count; i++) {
                assert_int_equal(all.list[i].activity, expected[i].activity);
                assert_true(all.list[i].bounded != MSPRINGI_BOUND_PUSH || all.list[i].was_active == acts(&was[i]));
                // Forces are sums of 32 products below 10, in double precision.
                check_near(all.list[i].force, expected[i].force, 1e-12);
                check_near(all.list[i].bound_force, expected[i].bound_force, 1e-12);
            }
        }
    }
}

/* ---------------------------------------------------------------------------------------------- forces unknown */

static matrix factored; ///< system of the direct solver, without constraints whose forces are unknowns

// Solve system x = b in place, by elimination.
static void eliminate(matrix system, double x[SIZE]) {
    static matrix rest;
    memcpy(rest, system, sizeof rest);
    for (int i = 0; i < SIZE; i++) { // positive definite: no pivoting
        for (int j = i + 1; j < SIZE; j++) {
            const double part = rest[j][i] / rest[i][i];
            for (int k = i; k < SIZE; k++) {
                rest[j][k] -= part * rest[i][k];
            }
            x[j] -= part * x[i];
        }
    }
    for (int i = SIZE; i-- > 0;) {
        for (int k = i + 1; k < SIZE; k++) {
            x[i] -= rest[i][k] * x[k];
        }
        x[i] /= rest[i][i];
    }
}

static void solve_factored(const mspring_network *network, double *x, double *y) {
    double values[SIZE];
    (void)network;
    memcpy(values, x, SLOTS * sizeof *x);
    memcpy(values + SLOTS, y, SLOTS * sizeof *y);
    eliminate(factored, values);
    memcpy(x, values, SLOTS * sizeof *x);
    memcpy(y, values + SLOTS, SLOTS * sizeof *y);
}

// Masses, springs between neighbours, and constraints that the factor has.
static void make_factored(uint64_t *seed, float mass[SLOTS]) {
    double row[SIZE];
    memset(factored, 0, sizeof factored);
    for (int i = 0; i < SLOTS; i++) {
        mass[i] = (float)between(seed, 0.5, 2);
        factored[i][i] = factored[SLOTS + i][SLOTS + i] = (double)mass[i];
    }
    for (int i = 0; i + 1 < SLOTS; i++) {
        memset(row, 0, sizeof row);
        row[i] = between(seed, -1, 1);
        row[SLOTS + i] = between(seed, -1, 1);
        row[i + 1] = -row[i];
        row[SLOTS + i + 1] = -row[SLOTS + i];
        add_outer(factored, row, 5.0);
    }
}

static void unknown_forces_solve_the_whole_system(void **state) {
    (void)state;
    static double answer[4 * (SLOTS + 1)];
    float mass[SLOTS];
    for (uint64_t round = 0; round < ROUNDS(60); round++) {
        uint64_t seed = round;
        double x[2 * (SLOTS + 1)] = {0}, expected[SIZE], row[SIZE];
        mspringi_implicit implicit = {
            .mass = mass, .direct = {.answer = answer}, .iterations = 8, .most_work = INFINITY};
        mspringi_solver running = {.object = &implicit};
        static mspring_network network;
        make_list(&seed);
        make_factored(&seed, mass);
        memcpy(dense, factored, sizeof dense);
        for (int i = 0; i < SIZE; i++) {
            x[i < SLOTS ? i : i + 1] = expected[i] = between(&seed, -1, 1);
        }
        for (uint32_t i = 0; i < all.count; i++) {
            const mspringi_constraint *c = &all.list[i];
            row_of(c, row);
            for (int k = 0; k < SIZE && mspringi_constraint_is_unknown(c); k++) {
                expected[k] += c->effort * row[k];
            }
            if (mspringi_constraint_is_unknown(c)) {
                add_outer(dense, row, c->stiffness);
            }
        }
        eliminate(dense, expected);
        network = (mspring_network){.running = &running, .constraints = all};
        network.topology.block_count = SLOTS / MSPRINGI_WIDTH;
        solve_factored(&network, x, x + SLOTS + 1);
        mspringi_direct_solve_constraints(&network, solve_factored, x, x + SLOTS + 1);
        for (int i = 0; i < SIZE; i++) { // iterations end at 1e-6 of the residual, which is about 10
            check_near(x[i < SLOTS ? i : i + 1], expected[i], 1e-5);
        }
    }
}

/* --------------------------------------------------------------------------------------------------- conservation
 */

static double sum_of(const float values[SLOTS]) {
    double sum = 0.0;
    for (int i = 0; i < SLOTS; i++) {
        sum += (double)values[i];
    }
    return sum;
}

static void closed_constraints_conserve(void **state) {
    (void)state;
    for (uint64_t round = 0; round < ROUNDS(500); round++) {
        uint64_t seed = round;
        make_list(&seed);
        all.count = all.entry_count = 0;
        const uint32_t count = 2 + below(&seed, MOST_ENTRIES - 1);
        mspringi_constraint *c = mspringi_constraint_add(&all, MSPRINGI_ANGLE_CONSTRAINT, 0, count);
        add_entries(&seed, c, count, true);
        c->stiffness = between(&seed, 0.1, 1e6);
        mspringi_constraints_activate(&all);
        const float x = (float)between(&seed, -1e3, 1e3), y = (float)between(&seed, -1e3, 1e3);
        for (int i = 0; i < SIZE; i++) {
            from[i] = i < SLOTS ? x : y;
        }
        memset(to, 0, sizeof to);
        assert_true(multiply() == 0.0);
        for (int i = 0; i < SIZE; i++) { // all move alike: no force at all
            assert_true(to[i] == 0.0f);
        }
        fill(&seed, from);
        multiply();
        // The first entry gets minus the sum of the others, rounded once; that of one other is exact.
        const uint32_t slot = all.entries[0].slot;
        const double most = count == 2 ? 0.0 : ROUNDED;
        check_near(sum_of(to), 0.0, most * fabs((double)to[slot]));
        check_near(sum_of(to + SLOTS), 0.0, most * fabs((double)to[SLOTS + slot]));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(products_are_those_of_the_matrix),      cmocka_unit_test(assembly_is_that_of_the_matrix),
        cmocka_unit_test(particles_get_the_blocks_of_their_own), cmocka_unit_test(active_sets_follow_from_forces),
        cmocka_unit_test(unknown_forces_solve_the_whole_system), cmocka_unit_test(closed_constraints_conserve),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

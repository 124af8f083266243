/// @file test_yielding.c
/// Springs that yield: a bent bar is that of a static oracle, a blow leaves the same dent at any number of
/// substeps, the books close, and clones, snapshots, rollbacks, layouts and levels give the same bits.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

/// Spring stiffness, N/m, and particle mass, kg: steel, 1 m a cell.
#define STIFFNESS 6.7643e7f
#define MASS 73.3975f

typedef struct bar {
    uint32_t width, height;
    float yield_strain, hardening;
    double angle;
    bool is_clamped;
    mspring_simd level;
    mspring_solver solver;
    uint32_t substeps;
    float damping, global_damping, sleep_speed;
    uint32_t workers; ///< 0: one
    uint32_t tail;    ///< particles of a rope that hangs on no lattice, and of a ring of irregular springs
    bool has_hook;    ///< one that does nothing between substeps
} bar;

static mspring_id at(const bar *b, uint32_t column, uint32_t row) {
    return column * b->height + row;
}

static void do_nothing(const mspring_hook_args *args, void *user) {
    (void)args;
    (void)user;
}

static void add_empty_hook(mspring_network *network) {
    mspring_hook_def def;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &def, sizeof def));
    def.phase = MSPRING_PHASE_AFTER_SUBSTEP;
    def.fn = do_nothing;
    check_ok(mspring_network_add_hook(network, &def, NULL));
}

static void add_ductile(mspring_builder *builder, const bar *b, mspring_id from, mspring_id to) {
    mspring_spring_def def;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
    def.a = from;
    def.b = to;
    def.stiffness = STIFFNESS;
    def.yield_strain = b->yield_strain;
    check_ok(mspring_builder_add_springs(builder, &def, 1, NULL));
}

// A rope, and a ring with spokes: every other particle of both flies off at 30 m/s.
static void add_tail(mspring_builder *builder, const bar *b) {
    for (int part = 0; part < 2 && b->tail > 0; part++) {
        mspring_id ids[256] = {0};
        for (uint32_t i = 0; i < b->tail; i++) {
            mspring_particle_def def;
            const double angle = part ? 6.2832 * i / b->tail : 0;
            check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &def, sizeof def));
            def.x = part ? -50 + 0.16 * b->tail * cos(angle) : (double)i;
            def.y = part ? 0.16 * b->tail * sin(angle) : 100;
            def.vx = i % 2 ? 30 : 0;
            def.mass = MASS;
            check_ok(mspring_builder_add_particles(builder, &def, 1, &ids[i]));
            if (i > 0)
                add_ductile(builder, b, ids[i - 1], ids[i]);
            if (i > 2 && part)
                add_ductile(builder, b, ids[i / 2], ids[i]);
        }
    }
}

// Springs by hand, so that the bar may be turned: a lattice for the layout all the same.
static mspring_network *bar_network(const bar *b) {
    static const int directions[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < b->width; i++)
        for (uint32_t j = 0; j < b->height; j++) {
            const double x = i * cos(b->angle) - j * sin(b->angle), y = i * sin(b->angle) + j * cos(b->angle);
            (void)(b->is_clamped && i == 0 ? support_pinned(builder, x, y, MASS)
                                           : support_particle(builder, x, y, MASS));
        }
    for (uint32_t i = 0; i < b->width; i++)
        for (uint32_t j = 0; j < b->height; j++)
            for (int d = 0; d < 4; d++) {
                const uint32_t u = i + (uint32_t)directions[d][0], v = j + (uint32_t)directions[d][1];
                if (u >= b->width || v >= b->height)
                    continue;
                mspring_spring_def def;
                check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
                def.a = at(b, i, j);
                def.b = at(b, u, v);
                def.stiffness = STIFFNESS;
                def.damping = b->damping;
                if (b->yield_strain > 0) {
                    def.yield_strain = b->yield_strain;
                    def.hardening = b->hardening;
                }
                check_ok(mspring_builder_add_springs(builder, &def, 1, NULL));
            }
    add_tail(builder, b);
    mspring_network_def def = support_def(0, b->substeps);
    def.simd_level = b->level;
    def.worker_count = b->workers > 0 ? b->workers : 1;
    def.settings.solver = b->solver;
    def.settings.guard = MSPRING_GUARD_BOUNDS;
    def.flags = MSPRING_NETWORK_PRECISE; // strains of 0.0005 are some units in the last place of 20 m
    def.settings.global_damping = b->global_damping;
    def.settings.sleep_speed = b->sleep_speed;
    mspring_network *network = support_network(builder, &def);
    if (b->has_hook)
        add_empty_hook(network);
    return network;
}

static mspring_energy report_of(const mspring_network *network) {
    mspring_energy report = {.struct_size = sizeof report};
    check_ok(mspring_network_get_energy(network, &report));
    return report;
}

static double sum_of_strains(const mspring_network *network) {
    const uint32_t count = mspring_network_count(network, MSPRING_SPRINGS);
    float *strains = malloc(count * sizeof *strains);
    double sum = 0;
    assert_non_null(strains);
    check_ok(mspring_network_get(network, MSPRING_PLASTIC_STRAIN, NULL, 0, count, strains, 1));
    for (uint32_t s = 0; s < count; s++)
        sum += fabs((double)strains[s]);
    free(strains);
    return sum;
}

/* --------------------------------------------------------------------------------------------------- oracle */

/// Of an incremental Newton with return mapping on the potential k (e^2 / 2 + H p^2 / 2 + y |dp|), 10 increments up
/// to g = 9.8 m/s^2 and 10 down: what the lower corner of the tip goes down, and stays.
#define ORACLE_LOADED 0.24132
#define ORACLE_LEFT 0.15263

static double tip_of(const mspring_network *network, const bar *b) {
    return support_position(network, at(b, b->width - 1, b->height - 1)).y - (b->height - 1);
}

// Gravity comes and goes over 20 s each, as a cosine, and stays for 4 s: past yield nothing must swing over, and
// flow of a long substep at a time takes some of them to come to its end.
static void bends_as_the_oracle(mspring_solver solver, uint32_t substeps, double tolerance) {
    const bar b = {.width = 20,
                   .height = 5,
                   .yield_strain = 0.0005f,
                   .hardening = 0.1f,
                   .is_clamped = true,
                   .solver = solver,
                   .substeps = substeps,
                   .damping = 1400,
                   .global_damping = 6};
    mspring_network *network = bar_network(&b);
    const int steps = 20 * 64;
    double loaded = 0;
    for (int way = 1; way <= 2; way++) {
        for (int i = 1; i <= steps; i++) {
            const double share = 0.5 - 0.5 * cos(3.14159265358979 * i / steps);
            check_ok(support_set_gravity(network, 0, (float)(-9.8 * (way == 1 ? share : 1 - share))));
            check_ok(mspring_network_step(network, 1.0 / 64));
        }
        support_steps(network, 256, 1.0 / 64);
        loaded = way == 1 ? -tip_of(network, &b) : loaded;
    }
    check_near(loaded, ORACLE_LOADED, tolerance * ORACLE_LOADED);
    check_near(-tip_of(network, &b), ORACLE_LEFT, tolerance * ORACLE_LEFT);
    mspring_network_destroy(network);
}

// Found, loaded and left: 0.10 and 0.13 % too much with 24 substeps, 0.06 and 0.08 % with 40, 0.05 and 0.06 % with
// 160. Three times as long a ramp gives the same. Motion in single precision trembles, the more the longer a
// substep is, and past yield each overshoot stays.
static void explicit_bends_as_the_oracle(void **state) {
    (void)state;
    bends_as_the_oracle(MSPRING_SOLVER_EXPLICIT, 24, 0.0015);
    bends_as_the_oracle(MSPRING_SOLVER_EXPLICIT, 40, 0.001);
}

// Found: -0.02 to 0.03 % with 1 to 16 substeps, alike with both solvers.
static void implicit_bends_as_the_oracle(void **state) {
    (void)state;
    bends_as_the_oracle(MSPRING_SOLVER_DIRECT, 1, 0.001);
    bends_as_the_oracle(MSPRING_SOLVER_DIRECT, 4, 0.001);
    bends_as_the_oracle(MSPRING_SOLVER_IMPLICIT, 4, 0.001);
}

/* --------------------------------------------------------------------------------------------------- a blow */

// A free bar is struck in its middle, at 30 m/s over 10 m: a blow of 8 ms.
static mspring_network *struck(const bar *b) {
    mspring_network *network = bar_network(b);
    for (uint32_t i = 0; i < b->width; i++) {
        const double z = (i - 0.5 * (b->width - 1)) / (0.125 * b->width);
        const float vx = 0, vy = (float)(30 * exp(-z * z));
        check_ok(mspring_network_set_velocities(network, NULL, at(b, i, 0), b->height, &vx, &vy, 0));
    }
    return network;
}

static bar free_bar(uint32_t substeps) {
    return (bar){.width = 80,
                 .height = 20,
                 .yield_strain = 0.006f,
                 .hardening = 0.05f,
                 .angle = 0.15,
                 .substeps = substeps,
                 .damping = 1400};
}

static void a_blow_does_not_depend_on_substeps(void **state) {
    (void)state;
    double first = 0;
    for (uint32_t substeps = 24; substeps <= 160; substeps = substeps == 24 ? 40 : 2 * substeps) {
        const bar b = free_bar(substeps);
        mspring_network *network = struck(&b);
        support_steps(network, 64, 1.0 / 64);
        const double sum = sum_of_strains(network);
        first = first > 0 ? first : sum;
        check_near(sum, first, 0.01 * first);
        mspring_network_destroy(network);
    }
    assert_true(first > 1);
}

// Take a step, and return the substeps that it was made of.
static uint32_t substeps_of_step(mspring_network *network) {
    mspring_step_info info = {.struct_size = sizeof info};
    support_steps(network, 1, 1.0 / 64);
    check_ok(mspring_network_get_step_info(network, &info));
    return info.substeps;
}

// Long implicit substeps would damp the wave before it can yield, so they are cut while springs are near yield.
// Uncut the shares would be 0.12, 0.58, 0.85 and 0.91.
static void implicit_substeps_are_cut_for_a_blow(void **state) {
    (void)state;
    static const struct {
        mspring_solver solver;
        uint32_t substeps;
        double share;   // of the explicit dent
        uint32_t taken; // most substeps of a step, on average
    } cases[] = {{MSPRING_SOLVER_DIRECT, 1, 0.85, 12},
                 {MSPRING_SOLVER_DIRECT, 4, 0.94, 16},
                 {MSPRING_SOLVER_DIRECT, 16, 0.91, 22},
                 {MSPRING_SOLVER_DIRECT, 32, 0.92, 34},
                 {MSPRING_SOLVER_IMPLICIT, 4, 0.94, 16}};
    const bar fine = free_bar(40);
    mspring_network *network = struck(&fine);
    support_steps(network, 51, 1.0 / 64);
    const double whole = sum_of_strains(network);
    mspring_network_destroy(network);
    for (size_t i = 0; i < COUNT_OF(cases); i += ROUNDS_ARE_FEW ? 4 : 1) {
        bar b = free_bar(cases[i].substeps);
        uint32_t taken = 0;
        b.solver = cases[i].solver;
        network = struck(&b);
        for (int step = 0; step < 51; step++)
            taken += substeps_of_step(network);
        check_near(sum_of_strains(network) / whole, cases[i].share, 0.02); // these are the figures of the guide
        assert_true(taken > 51 * cases[i].substeps && taken < 51 * cases[i].taken);
        mspring_network_destroy(network);
    }
}

// The same blow, far below yield; and a network that yields all the time, slowly.
static void others_are_not_cut(void **state) {
    (void)state;
    for (int solver = MSPRING_SOLVER_IMPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        bar b = free_bar(4);
        b.solver = (mspring_solver)solver;
        b.yield_strain = 0.8f;
        mspring_network *network = struck(&b);
        for (int step = 0; step < 8; step++)
            assert_int_equal(substeps_of_step(network), 4);
        mspring_network_destroy(network);
        mspring_spring_def def;
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def));
        def.stiffness = 100;
        def.a = 0;
        def.b = 1;
        def.rest_length = 1;
        def.yield_strain = 0.1f;
        mspring_builder *builder = support_builder();
        (void)support_pinned(builder, 0, 0, 1);
        (void)support_particle(builder, 1.2, 0, 1);
        const float slow = 0.1f, none = 0; // 0.0016 m in a step, of 0.1 m until it yields
        check_ok(mspring_builder_add_springs(builder, &def, 1, NULL));
        mspring_network_def network_def = support_def(0, 4);
        network_def.settings.solver = (mspring_solver)solver;
        network = support_network(builder, &network_def);
        check_ok(mspring_network_set_velocities(network, NULL, 1, 1, &slow, &none, 1));
        assert_int_equal(substeps_of_step(network), 4);
        assert_int_equal(report_of(network).bent_springs, 1);
        mspring_network_destroy(network);
    }
}

static void cut_substeps_have_the_same_bits(void **state) {
    (void)state;
    for (int solver = MSPRING_SOLVER_IMPLICIT; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        uint64_t first = 0;
        for (uint32_t i = 0; i < 6; i += ROUNDS_ARE_FEW ? 5 : 1) {
            bar b = free_bar(4);
            b.width = 64;
            b.solver = (mspring_solver)solver;
            b.workers = 1 + i % 3;
            b.tail = 64;
            b.level = i < 3 ? MSPRING_SIMD_AUTO : MSPRING_SIMD_SCALAR;
            mspring_network *network = struck(&b);
            assert_true(substeps_of_step(network) > 4);
            support_steps(network, 3, 1.0 / 64);
            first = i == 0 ? support_hash(network) : first;
            assert_int_equal(support_hash(network), first);
            mspring_network_destroy(network);
        }
    }
}

static void energy_is_booked(void **state) {
    (void)state;
    bar b = free_bar(640);
    b.damping = 0;
    mspring_network *network = struck(&b);
    const double before = support_energy_of_motion(network);
    double dissipated = 0;
    for (int i = 0; i < 32; i++) {
        check_ok(mspring_network_step(network, 1.0 / 64));
        const mspring_energy report = report_of(network);
        assert_true(report.dissipated >= dissipated);
        dissipated = report.dissipated;
    }
    // Symplectic Euler shows 0.75, 0.37 and 0.09 % too much with 80, 160 and 640 substeps: an error of first order.
    check_near(support_energy_of_motion(network) + dissipated, before, 0.0015 * before);
    assert_true(dissipated > 0.05 * before);
    assert_true(report_of(network).bent_springs > 500);
    mspring_network_destroy(network);
}

/* --------------------------------------------------------------------------------------------------- same bits */

static uint64_t hash_after(mspring_network *network, uint32_t steps) {
    support_steps(network, steps, 1.0 / 64);
    return support_hash(network);
}

static void all_levels_have_the_same_bits(void **state) {
    (void)state;
    mspring_simd levels[MSPRING_SIMD_AVX512];
    const uint32_t count = support_levels(levels);
    uint64_t first = 0;
    mspring_energy reports[2];
    for (uint32_t i = 0; i < count; i++) {
        bar b = free_bar(40);
        b.level = levels[i];
        mspring_network *network = struck(&b);
        const uint64_t hash = hash_after(network, 8);
        first = i == 0 ? hash : first;
        assert_int_equal(hash, first);
        reports[i > 0] = report_of(network);
        assert_memory_equal(&reports[i > 0], &reports[0], sizeof reports[0]);
        mspring_network_destroy(network);
    }
}

/// In a lattice the springs of one direction alone may yield, when all are stretched or pressed. Its cells are low.
static void each_direction_has_its_own_limit(void **state) {
    (void)state;
    enum { SIDE = 6 };
    const double height = 0.75;
    static const int directions[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    for (int trial = 0; trial < 16; trial++) {
        const int soft = trial % 8;
        const double stretch = soft < 4 ? 1.05 : 0.95;
        bool is_soft[4 * SIDE * SIDE];
        mspring_builder *builder = support_builder();
        uint32_t count = 0;
        for (int i = 0; i < SIDE * SIDE; i++)
            (void)support_particle(builder, stretch * (i % SIDE), stretch * height * (i / SIDE), MASS);
        for (int i = 0; i < SIDE * SIDE; i++)
            for (int d = 0; d < 4; d++) {
                const int u = i % SIDE + directions[d][0], v = i / SIDE + directions[d][1];
                if (u >= SIDE || v < 0 || v >= SIDE)
                    continue;
                mspring_spring_def def = mspring_spring_def_default();
                def.a = (mspring_id)i;
                def.b = (mspring_id)(u + v * SIDE);
                def.stiffness = STIFFNESS;
                def.rest_length = (float)hypot(directions[d][0], height * directions[d][1]);
                is_soft[count++] = d == soft % 4;
                def.yield_strain = d == soft % 4 ? 0.01f : 0.5f;
                check_ok(mspring_builder_add_springs(builder, &def, 1, NULL));
            }
        mspring_network_def def = support_def(0, trial < 8 ? 100 : 1);
        def.settings.solver = trial < 8 ? MSPRING_SOLVER_EXPLICIT : MSPRING_SOLVER_IMPLICIT;
        mspring_network *network = support_network(builder, &def);
        float strains[4 * SIDE * SIDE];
        support_steps(network, 1, 1e-6);
        check_ok(mspring_network_get(network, MSPRING_PLASTIC_STRAIN, NULL, 0, count, strains, 1));
        for (uint32_t i = 0; i < count; i++)
            assert_true(is_soft[i] ? strains[i] * (soft < 4 ? 1 : -1) > 0.01f : strains[i] == 0);
        mspring_network_destroy(network);
    }
}

static void add_areas(mspring_network *network) {
    mspring_area_def def;
    uint32_t count;
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &def, sizeof def));
    def.stiffness = 0.5f * STIFFNESS;
    check_ok(mspring_network_add_cell_areas(network, &def, NULL, &count));
    assert_true(count > 0);
}

// Nor do they depend on how a step is divided: among workers, or in pieces between which a hook is called.
static void no_division_changes_bits(void **state) {
    (void)state;
    uint64_t hash = 0;
    mspring_energy first = {.struct_size = sizeof first};
    for (uint32_t i = 0; i < 18; i++) {
        bar b = free_bar(40);
        b.width = ROUNDS_ARE_FEW ? 80 : 160;
        b.height = ROUNDS_ARE_FEW ? 20 : 40;
        b.tail =
            i < 6 || i >= 12 ? 0 : 64; // irregular springs are mapped between substeps, so these divide a step, too
        b.yield_strain = 0.004f;
        b.workers = 1 + i % 3;
        b.has_hook = i % 6 >= 3;
        b.level = i % 2 ? MSPRING_SIMD_AUTO : MSPRING_SIMD_SCALAR;
        mspring_network *network = struck(&b);
        if (i >= 12)
            add_areas(network);
        support_steps(network, 4, 1.0 / 64);
        mspring_energy report = report_of(network);
        if (b.has_hook) // kinetic energy is of velocities of now, but with hooks of those that are read
            report.kinetic = first.kinetic;
        if (i % 6 == 0) {
            hash = support_hash(network);
            first = report;
        }
        assert_int_equal(support_hash(network), hash);
        assert_memory_equal(&report, &first, sizeof report);
        mspring_network_destroy(network);
    }
    assert_true(first.bent_springs > ROUNDS(1000));
}

// A small bar's substeps are few calls, unless one tests. With a hook each of them is a piece of its own.
static void nor_do_pieces_of_a_small_bar(void **state) {
    (void)state;
    uint64_t hashes[4];
    for (uint32_t i = 0; i < 4; i++) {
        bar b = free_bar(40);
        b.width = 40;
        b.height = 8;
        b.yield_strain = 0.0005f;
        b.has_hook = i % 2;
        b.level = i < 2 ? MSPRING_SIMD_AUTO : MSPRING_SIMD_SCALAR;
        mspring_network *network = struck(&b);
        hashes[i] = hash_after(network, 8);
        assert_true(report_of(network).bent_springs > 100);
        assert_true(hashes[i] == hashes[0]);
        mspring_network_destroy(network);
    }
}

static void what_never_yields_has_the_bits_of_before(void **state) {
    (void)state;
    uint64_t hashes[2];
    for (int i = 0; i < 2; i++) {
        bar b = free_bar(40);
        b.yield_strain = i ? 0.8f : 0;
        mspring_network *network = struck(&b);
        hashes[i] = hash_after(network, 8);
        mspring_network_destroy(network);
    }
    assert_int_equal(hashes[0], hashes[1]);
}

static void clones_and_snapshots_go_on(void **state) {
    (void)state;
    for (int solver = 0; solver <= MSPRING_SOLVER_DIRECT; solver++) {
        bar b = free_bar(solver ? 4 : 40);
        b.solver = (mspring_solver)solver;
        b.width = 24;
        b.height = 6;
        mspring_network *network = struck(&b), *clone = NULL;
        support_steps(network, 3, 1.0 / 64);
        assert_true(report_of(network).bent_springs > 0);
        check_ok(mspring_network_clone(network, NULL, &clone));
        mspring_network *fresh = bar_network(&b), *framed = bar_network(&b);
        support_bring(network, fresh, MSPRING_SNAPSHOT_ALL);
        support_bring(network, framed, MSPRING_SNAPSHOT_FRAME);
        assert_int_equal(support_hash(framed), support_hash(network));
        const uint64_t hash = hash_after(network, 5);
        const mspring_energy report = report_of(network);
        mspring_network *others[] = {clone, fresh, framed};
        for (int i = 0; i < 3; i++) {
            assert_int_equal(hash_after(others[i], 5), hash);
            const mspring_energy other = report_of(others[i]);
            assert_memory_equal(&other, &report, sizeof report);
        }
        // And back, to where nothing is bent.
        mspring_network *straight = bar_network(&b);
        support_bring(straight, network, MSPRING_SNAPSHOT_FRAME);
        assert_int_equal(support_hash(network), support_hash(straight));
        assert_int_equal(report_of(network).bent_springs, 0);
        for (int i = 0; i < 3; i++)
            mspring_network_destroy(others[i]);
        mspring_network_destroy(straight);
        mspring_network_destroy(network);
    }
}

// A step that is refused leaves nothing bent.
static void a_refused_step_takes_flow_back(void **state) {
    (void)state;
    bar b = free_bar(40);
    b.width = 24;
    b.height = 6;
    mspring_network *network = struck(&b);
    support_steps(network, 2, 1.0 / 64);
    const uint64_t hash = support_hash(network);
    const mspring_energy report = report_of(network);
    mspring_settings settings = support_settings(network);
    settings.max_speed = 0.5f;
    check_ok(mspring_network_set_settings(network, &settings));
    check_error(mspring_network_step(network, 1.0 / 64), MSPRING_ERROR_UNSTABLE);
    const mspring_energy after = report_of(network);
    assert_int_equal(support_hash(network), hash);
    assert_memory_equal(&after, &report, sizeof report);
    mspring_network_destroy(network);
}

// Another layout, by broken springs that are left out, and ids that are added.
static void another_layout_goes_on(void **state) {
    (void)state;
    bar b = free_bar(40);
    b.width = 24;
    b.height = 6;
    mspring_network *network = struck(&b);
    support_steps(network, 3, 1.0 / 64);
    mspring_id *broken = malloc(60 * sizeof *broken);
    assert_non_null(broken);
    for (mspring_id s = 0; s < 60; s++)
        broken[s] = 100 + s;
    check_ok(mspring_network_break_springs(network, broken, 0, 60));
    const double sum = sum_of_strains(network);
    check_ok(mspring_network_compact(network));
    check_near(sum_of_strains(network), sum, 0);
    support_steps(network, 3, 1.0 / 64);
    check_ok(support_expand(network));
    check_ok(mspring_network_restore_springs(network, broken, 0, 60, 0.1));
    support_steps(network, 3, 1.0 / 64);
    assert_true(report_of(network).bent_springs > 0);
    free(broken);
    mspring_network_destroy(network);
}

/* --------------------------------------------------------------------------------------------- settling and sleep
 */

// Where springs would yield on the way, the elastic equilibrium is none; where none does, it is.
static void settle_does_not_pass_over_yields(void **state) {
    (void)state;
    bar b = {
        .width = 20, .height = 5, .yield_strain = 0.0005f, .hardening = 0.1f, .is_clamped = true, .substeps = 24};
    for (int i = 0; i < 2; i++) {
        b.yield_strain = i ? 0.1f : 0.0005f;
        mspring_network *network = bar_network(&b);
        check_ok(support_set_gravity(network, 0, -9.8f));
        check_error(mspring_network_settle(network, NULL, NULL), i ? MSPRING_OK : MSPRING_ERROR_EQUILIBRIUM);
        if (!i)
            check_contains(mspring_network_error(network), "yield");
        mspring_network_destroy(network);
    }
}

static void what_has_bent_falls_asleep(void **state) {
    (void)state;
    bar b = free_bar(40);
    b.width = 24;
    b.height = 6;
    b.sleep_speed = 0.05f;
    b.global_damping = 20;
    mspring_network *network = struck(&b);
    support_steps(network, 300, 1.0 / 64);
    assert_true(support_is_asleep(network));
    const mspring_energy report = report_of(network);
    assert_true(report.bent_springs > 0);
    const float none = 0;
    check_ok(mspring_network_set(network, MSPRING_PLASTIC_STRAIN, NULL, 0,
                                 mspring_network_count(network, MSPRING_SPRINGS), &none, 0));
    assert_false(support_is_asleep(network));
    support_steps(network, 10, 1.0 / 64);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(explicit_bends_as_the_oracle),
        cmocka_unit_test(implicit_bends_as_the_oracle),
        cmocka_unit_test(a_blow_does_not_depend_on_substeps),
        cmocka_unit_test(implicit_substeps_are_cut_for_a_blow),
        cmocka_unit_test(others_are_not_cut),
        cmocka_unit_test(cut_substeps_have_the_same_bits),
        cmocka_unit_test(energy_is_booked),
        cmocka_unit_test(all_levels_have_the_same_bits),
        cmocka_unit_test(each_direction_has_its_own_limit),
        cmocka_unit_test(no_division_changes_bits),
        cmocka_unit_test(nor_do_pieces_of_a_small_bar),
        cmocka_unit_test(what_never_yields_has_the_bits_of_before),
        cmocka_unit_test(clones_and_snapshots_go_on),
        cmocka_unit_test(a_refused_step_takes_flow_back),
        cmocka_unit_test(another_layout_goes_on),
        cmocka_unit_test(settle_does_not_pass_over_yields),
        cmocka_unit_test(what_has_bent_falls_asleep),
    };
    return cmocka_run_group_tests_name("yielding", tests, NULL, NULL);
}

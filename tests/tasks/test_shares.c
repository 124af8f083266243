/// @file test_shares.c
/// Lattices that workers divide among each other: what lies at the borders has the same bits as anywhere.
///
/// SPDX-License-Identifier: MIT
#include <stdbool.h>
#include <string.h>

#include "hosts.h"
#include "recipe.h"
#include "store/network.h"
#include "support.h"

/// Workers: the library's own, which may wait for each other, or independent bodies of a host.
typedef struct team {
    uint32_t count;
    int host; ///< of hosts_fill(), or OWN
} team;

enum { OWN = -1, IN_ORDER, IN_REVERSE, FROM_BOTH_ENDS, IN_CHUNKS, ON_THREADS };

static const team alone = {1, OWN};
static const team teams[] = {{2, OWN},        {3, OWN},        {5, OWN},      {8, OWN},
                             {3, ON_THREADS}, {2, IN_REVERSE}, {3, IN_ORDER}, {7, FROM_BOTH_ENDS},
                             {7, IN_CHUNKS}};

/// Those on one thread have no races.
#ifdef __SANITIZE_THREAD__
enum { TEAM_COUNT = 5 };
#else
enum { TEAM_COUNT = COUNT_OF(teams) };
#endif

static host hosts[HOST_COUNT];

static void enlist(mspring_network_def *def, const team *who) {
    if (who->host == OWN) {
        def->worker_count = who->count;
        return;
    }
    hosts_fill(hosts, who->count);
    hosts[who->host].tasks.concurrent_count = 1;
    def->tasks = &hosts[who->host].tasks;
}

/// How a lattice is stepped.
typedef struct way {
    const char *name;
    uint32_t substeps, period; ///< of a hook after substeps; 0: none
    bool undamped, held, ropes, wide, whole, high, floor, yields;
} way;

static const way ways[] = {
    {.name = "plain", .substeps = 40},
    {.name = "without dampers", .substeps = 23, .undamped = true},
    {.name = "under a force", .substeps = 17, .held = true},
    {.name = "with ropes", .substeps = 20, .ropes = true},
    {.name = "hook after every substep", .substeps = 10, .period = 1},
    {.name = "hook after every third", .substeps = 11, .period = 3, .ropes = true, .held = true},
    {.name = "with ropes, no holes", .substeps = 20, .ropes = true, .whole = true},
    {.name = "few long rows", .substeps = 12, .wide = true},
    {.name = "with ropes, on a floor", .substeps = 20, .ropes = true, .high = true, .floor = true},
    {.name = "springs that yield", .substeps = 20, .yields = true},
};

static recipe lattice(const way *w) {
    uint64_t seed = 5;
    const recipe_stuff stuff = {.mass = {1, 2},
                                .stiffness = {200, 400},
                                .damping = {0, w->undamped ? 0 : 1},
                                .pinned = 0.01,
                                .holes = w->whole ? 0 : 0.15};
    recipe made = {0};
    const uint32_t width = w->wide ? 1500 : 90;
    recipe_lattice(&made, width, w->wide ? 16 : w->high ? 400 : 200, 0, 0, 1, &stuff, &seed);
    // Ropes between neighbouring rows: some strips away, so that passes stay deep.
    for (mspring_id p = 40; w->ropes && p < 15000; p += 1111)
        recipe_rope(&made, p, p + 3 * width, 9, &stuff, &seed);
    recipe_disturb(&made, 0.05, 0.5, &seed);
    return made;
}

static void hook(const mspring_hook_args *args, void *user) {
    (void)args, (void)user;
}

/// Where the lowest rows come to it.
static void lay_floor(mspring_network *network) {
    const double plane[4] = {0, 0.5, 0.1, 1};
    mspring_floor_def floor;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &floor, sizeof floor));
    floor.plane_count = 1;
    floor.planes = plane;
    floor.friction = 0.3f;
    check_ok(mspring_network_set_floor(network, &floor));
}

/// In the first step springs are not warm yet, so workers share it; later ones yield.
static void make_soft(mspring_network *network) {
    const float strain = 0.3f;
    for (mspring_id s = 0; s < mspring_network_count(network, MSPRING_SPRINGS); s++)
        check_ok(mspring_network_set(network, MSPRING_YIELD_STRAIN, NULL, s, 1, &strain, 1));
}

static uint64_t run(const recipe *made, const way *w, const team *who) {
    mspring_network_def def = support_def(-9.8f, ROUNDS(w->substeps));
    enlist(&def, who);
    mspring_network *network = recipe_network(made, &def);
    assert_int_equal(network->halos.count > 0, who->count > 1);
    if (w->floor)
        lay_floor(network);
    if (w->yields)
        make_soft(network);
    if (w->period > 0) {
        mspring_hook_def hooked;
        check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &hooked, sizeof hooked));
        hooked.phase = MSPRING_PHASE_AFTER_SUBSTEP;
        hooked.fn = hook;
        hooked.period = w->period;
        check_ok(mspring_network_add_hook(network, &hooked, NULL));
    }
    uint64_t hash = 0;
    for (int step = 0; step < 3; step++) {
        for (mspring_id p = 0; w->held && p < 6000; p += 7)
            check_ok(mspring_network_apply_force(network, p, 5, 10));
        support_steps(network, 1, 0.01);
        hash = hash * 31 + support_hash(network);
    }
    mspring_network_destroy(network);
    return hash;
}

static void any_division_gives_the_same_bits(void **state) {
    (void)state;
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        recipe made = lattice(&ways[i]);
        const uint64_t expected = run(&made, &ways[i], &alone);
        for (size_t t = 0; t < TEAM_COUNT; t += ROUNDS_ARE_FEW || support_is_quick() ? 2 : 1)
            if (run(&made, &ways[i], &teams[t]) != expected)
                fail_msg("%s: other bits with %u workers of host %d", ways[i].name, (unsigned)teams[t].count,
                         teams[t].host);
        recipe_free(&made);
    }
}

/// Strips of a lattice with ropes have 2,048 particles each. Few of them are a share, down to the three that
/// workers need at a border.
static void heavy_strips_are_shared_by_weight(void **state) {
    (void)state;
    static const struct {
        uint32_t way;
        team team;
        uint32_t used;
    } cases[] = {{0, {1, OWN}, 1},      {0, {2, OWN}, 2},      {0, {8, OWN}, 8},      {3, {8, OWN}, 2},
                 {6, {1, OWN}, 1},      {6, {2, OWN}, 2},      {6, {8, OWN}, 3},      {0, {2, IN_ORDER}, 2},
                 {0, {7, IN_ORDER}, 7}, {6, {2, IN_ORDER}, 2}, {6, {8, IN_ORDER}, 2}, {8, {8, IN_ORDER}, 2}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        recipe made = lattice(&ways[cases[i].way]);
        mspring_network_def def = support_def(-9.8f, 40);
        support_plan plan;
        enlist(&def, &cases[i].team);
        mspring_network *network = recipe_network(&made, &def);
        check_ok(support_get_plan(network, &plan));
        assert_int_equal(plan.pass_workers, cases[i].used);
        mspring_network_destroy(network);
        recipe_free(&made);
    }
}

/// A host of several workers, of which one takes all bodies until `others` join.
typedef struct lonely {
    uint32_t runs;
    bool others;
} lonely;

static void run_by_one(uint32_t count, mspring_task_fn fn, void *argument, void *user) {
    lonely *self = user;
    self->runs++;
    for (uint32_t i = 0; i < count; i++)
        fn(argument, i, self->others ? i % 3 : 0);
}

/// Where one worker takes all bodies, steps are divided now and then: first each fifth, then each ninth, and so on.
/// Once others take some, all are. The bits are those of one worker.
static void one_worker_of_a_host_gets_whole_steps(void **state) {
    (void)state;
    recipe made = lattice(&ways[0]);
    lonely self = {0};
    mspring_tasks tasks;
    mspring_network_def def = support_def(-9.8f, 40);
    mspring_network *one = recipe_network(&made, &def);
    check_ok(mspring_init(MSPRING_STRUCT_TASKS, &tasks, sizeof tasks));
    tasks.worker_count = 3, tasks.run = run_by_one, tasks.user = &self;
    def.tasks = &tasks;
    mspring_network *network = recipe_network(&made, &def);
    for (int step = 0; step < 20; step++) {
        self.runs = 0;
        self.others = step >= 14;
        support_steps(network, 1, 0.01);
        support_steps(one, 1, 0.01);
        assert_int_equal(self.runs > 0, step == 0 || step == 5 || step >= 14);
    }
    assert_int_equal(support_hash(network), support_hash(one));
    mspring_network_destroy(network);
    mspring_network_destroy(one);
    recipe_free(&made);
}

/// Have steps refused in which a particle is torn away, one in each fourth row, and go on. Returns what was said,
/// and the state, in one number.
static uint64_t run_refused(const recipe *made, const team *who) {
    mspring_network_def def = support_def(-9.8f, 40);
    enlist(&def, who);
    mspring_network *network = recipe_network(made, &def);
    support_steps(network, 1, 0.01);
    const uint64_t before = support_hash(network);
    uint64_t hash = before;
    for (mspring_id p = 45; p < ROUNDS(15000); p += 313) {
        if (made->particles[p].flags & MSPRING_PARTICLE_PINNED)
            continue;
        check_ok(mspring_network_apply_force(network, p, 3e9f, 1e9f));
        check_error(mspring_network_step(network, 0.01), MSPRING_ERROR_UNSTABLE);
        for (const char *said = mspring_network_error(network); *said; said++)
            hash = hash * 31 + (uint8_t)*said;
        check_ok(mspring_network_apply_force(network, p, -3e9f, -1e9f));
        assert_int_equal(support_hash(network), before);
    }
    support_steps(network, 1, 0.01);
    hash = hash * 31 + support_hash(network);
    mspring_network_destroy(network);
    return hash;
}

/// Wherever it happens, in rows that two workers share, too.
static void what_is_refused_is_taken_back(void **state) {
    (void)state;
    recipe made = lattice(&ways[0]);
    const uint64_t expected = run_refused(&made, &alone);
    for (size_t t = 0; t < TEAM_COUNT; t += support_is_quick() ? 4 : 1)
        assert_int_equal(run_refused(&made, &teams[t]), expected);
    recipe_free(&made);
}

/// Four squares in the same rows, of which two fall asleep.
static uint64_t run_sleepers(const team *who) {
    uint64_t seed = 6, hash = 0;
    const recipe_stuff stuff = {.mass = {1, 1}, .stiffness = {200, 200}, .damping = {1, 1}};
    recipe made = {0};
    for (int i = 0; i < 4; i++)
        recipe_lattice(&made, 60, 60, 100 * i, 0, 1, &stuff, &seed);
    mspring_network_def def = support_def(0, 10);
    enlist(&def, who);
    def.settings.sleep_speed = 1e-3f;
    def.settings.sleep_time = 0.02f;
    mspring_network *network = recipe_network(&made, &def);
    recipe_free(&made);
    assert_int_equal(network->halos.count > 0, who->count > 1);
    support_kick(network, 30 * 60 + 30, 3);
    support_kick(network, 2 * 3600 + 59 * 60 + 7, 3);
    for (int step = 0; step < 8; step++) {
        support_steps(network, 1, 0.01);
        hash = hash * 31 + support_hash(network);
    }
    assert_true(support_sleeps(network, 3600) && !support_sleeps(network, 0));
    mspring_network_destroy(network);
    return hash;
}

static void what_sleeps_beside_gives_the_same_bits(void **state) {
    (void)state;
    const uint64_t expected = run_sleepers(&alone);
    for (size_t t = 0; t < TEAM_COUNT; t++)
        assert_int_equal(run_sleepers(&teams[t]), expected);
}

enum { WIDE = 96, STILL = 60, ROWS = 60, NOTCH = 32, COUNT = WIDE * ROWS };

/// Enough for networks of that size to be worth more than one worker.
enum { SUBSTEPS_BESIDE_NOTCH = 14, SUBSTEPS_OF_QUILT = 40 };

/// Whether workers have met: what they hand on has been in the halos.
static bool has_used_halos(const mspring_network *network) {
    const mspringi_halos *halos = &network->halos;
    const size_t count = (size_t)halos->count * 4 * (3 + halos->substeps) * halos->segment;
    for (size_t i = 0; i < count; i++)
        if (halos->values[i] != 0)
            return true;
    return false;
}

static void add_cells(mspring_builder *builder, const uint16_t *cells, uint32_t width, double x) {
    mspring_material stuff;
    check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, &stuff, sizeof stuff));
    stuff.mass = 1, stuff.stiffness = 200, stuff.damping = 0.5f;
    mspring_lattice_def def;
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &def, sizeof def));
    def.width = width, def.height = ROWS, def.cells = cells, def.materials = &stuff, def.material_count = 1;
    def.x = x;
    check_ok(mspring_builder_add_lattice(builder, &def, NULL));
}

static mspring_network *make_sleepy(mspring_builder *builder, uint32_t substeps, float sleep_speed,
                                    const team *who) {
    mspring_network_def settings = support_def(0, substeps);
    enlist(&settings, who);
    settings.settings.sleep_speed = sleep_speed;
    settings.settings.sleep_time = 0.02f;
    mspring_network *network;
    check_ok(mspring_network_create(builder, &settings, &network));
    mspring_builder_destroy(builder);
    return network;
}

/// A lattice with a wide notch, as far from the left as it is deep, so that runs of the row below or of the column
/// at its left end and begin side by side where the notch does; and one at its right in the same rows. The
/// positions of the first, which moves, after some steps. Returns whether workers have shared it.
static bool run_beside_sleeper(int depth, float sleep_speed, const team *who, double *x, double *y) {
    static uint16_t cells[ROWS][WIDE];
    static const uint16_t full[ROWS][STILL];
    const uint32_t count = COUNT - NOTCH * (uint32_t)depth;
    memset(cells, 0, sizeof cells);
    for (int row = 0; row < depth; row++)
        for (int column = depth; column < depth + NOTCH; column++)
            cells[row][column] = MSPRING_CELL_EMPTY;
    mspring_builder *builder;
    check_ok(mspring_builder_create(NULL, &builder));
    add_cells(builder, cells[0], WIDE, 0);
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), count);
    add_cells(builder, full[0], STILL, 200);
    mspring_network *network = make_sleepy(builder, SUBSTEPS_BESIDE_NOTCH, sleep_speed, who);
    for (mspring_id p = 0; p < count; p += 3)
        support_kick(network, p, 1 + (float)(p % 7));
    support_steps(network, 8, 0.01);
    assert_true(support_sleeps(network, count) == (sleep_speed > 0) && !support_sleeps(network, 0));
    check_ok(mspring_network_get_positions(network, NULL, 0, count, x, y, 1));
    const bool shared = has_used_halos(network);
    mspring_network_destroy(network);
    return shared;
}

static void what_sleeps_beside_a_notch_changes_nothing(void **state) {
    (void)state;
    static double x[COUNT], y[COUNT], expected_x[COUNT], expected_y[COUNT];
    static const team few[] = {{1, OWN}, {2, OWN}, {3, OWN}, {2, IN_REVERSE}};
    uint32_t shared = 0;
    for (int depth = 12; depth < 50;
         depth += ROUNDS_ARE_FEW ? 16 : 4) { // at 12, 28 and 44 a block beside the notch is empty
        run_beside_sleeper(depth, 0, &alone, expected_x, expected_y);
        for (size_t i = 0; i < COUNT_OF(few); i++) {
            shared += run_beside_sleeper(depth, 1e-3f, &few[i], x, y);
            assert_memory_equal(x, expected_x, sizeof x);
            assert_memory_equal(y, expected_y, sizeof y);
        }
    }
    assert_true(shared > (ROUNDS_ARE_FEW ? 4 : 15));
}

enum { WHITE, BLACK, NEITHER };
enum { PATCH_WIDTH = 6, PATCH_HEIGHT = 4 };

static uint8_t patch_at(uint8_t patches[ROWS / PATCH_HEIGHT][WIDE / PATCH_WIDTH], int row, int column) {
    return patches[row / PATCH_HEIGHT][column / PATCH_WIDTH];
}

/// Make a lattice a quilt of white patches and black ones that lie loose in between, so that in each row runs end
/// and begin elsewhere, and most blocks have particles of both. Returns how many there are.
static uint32_t quilt(uint64_t seed, uint8_t sides[ROWS][WIDE]) {
    uint8_t patches[ROWS / PATCH_HEIGHT][WIDE / PATCH_WIDTH];
    uint32_t count = 0;
    for (int row = 0; row < ROWS / PATCH_HEIGHT; row++)
        for (int column = 0; column < WIDE / PATCH_WIDTH; column++)
            patches[row][column] = column > 0 && support_random(&seed) % 3 ? patches[row][column - 1]
                                                                           : (uint8_t)(support_random(&seed) % 2);
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < WIDE; column++) {
            uint8_t side = patch_at(patches, row, column);
            for (int i = 0; i < 9 && side == BLACK; i++) {
                const int y = row + i / 3 - 1, x = column + i % 3 - 1;
                const bool is_inside = y >= 0 && y < ROWS && x >= 0 && x < WIDE;
                if (is_inside && patch_at(patches, y, x) == WHITE)
                    side = NEITHER;
            }
            sides[row][column] = side;
            count += side != NEITHER;
        }
    return count;
}

/// A hash of the positions of the colour that moves, while the other one, which lies still but not unstrained, is
/// asleep or not. Counts in shared whether workers have shared it.
static uint64_t run_quilt(uint64_t seed, int mover, float sleep_speed, const team *who, uint32_t *shared) {
    static uint8_t sides[ROWS][WIDE];
    static uint16_t cells[ROWS][WIDE];
    static uint8_t side_of[COUNT];
    const uint32_t count = quilt(seed, sides);
    uint32_t p = 0;
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < WIDE; column++) {
            const uint8_t side = sides[row][column];
            cells[row][column] = side == NEITHER ? MSPRING_CELL_EMPTY : 0;
            if (side != NEITHER)
                side_of[p++] = side;
        }
    mspring_builder *builder;
    check_ok(mspring_builder_create(NULL, &builder));
    add_cells(builder, cells[0], WIDE, 0);
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), count);
    mspring_network *network = make_sleepy(builder, SUBSTEPS_OF_QUILT, sleep_speed, who);
    for (p = 0; p < count; p++)
        support_kick(network, p, side_of[p] == mover ? 1 + (float)(p % 7) : 2e-3f * (float)(p % 3));
    support_steps(network, 5, 0.01);
    *shared += has_used_halos(network);
    uint64_t hash = 0;
    for (p = 0; p < count; p++) {
        assert_int_equal(support_sleeps(network, p), sleep_speed > 0 && side_of[p] != mover);
        if (side_of[p] != mover)
            continue;
        const support_point at = support_position(network, p);
        uint64_t bits[2];
        memcpy(bits, &at, sizeof bits);
        hash = (hash * 31 + bits[0]) * 31 + bits[1];
    }
    mspring_network_destroy(network);
    return hash;
}

/// What sleeps in a block that is swept pulls as ever at what is not there to take it: to the right, above, and in
/// the rows that two workers share. With so much asleep borders move far from pass to pass, so that workers come to
/// strips which one that is no neighbour had in the pass before.
static void what_sleeps_in_between_changes_nothing(void **state) {
    (void)state;
    uint32_t shared = 0;
    const uint32_t quilts = ROUNDS(4);
    for (uint64_t seed = 1; seed <= quilts; seed++)
        for (int mover = WHITE; mover <= BLACK; mover++) {
            const uint64_t expected = run_quilt(seed, mover, 0, &alone, &shared);
            assert_true(run_quilt(seed, mover, 1e-2f, &alone, &shared) == expected);
            for (size_t t = 0; t < TEAM_COUNT; t++)
                assert_true(run_quilt(seed, mover, 1e-2f, &teams[t], &shared) == expected);
        }
    assert_true(shared > TEAM_COUNT * quilts); // of twice as many
}

/// A clone may share what its network does by other tasks.
static void clones_are_shared_in_their_own_way(void **state) {
    (void)state;
    static const team pairs[][2] = {
        {{3, OWN}, {3, IN_REVERSE}}, {{3, IN_ORDER}, {3, OWN}}, {{2, OWN}, {7, IN_ORDER}}};
    recipe made = lattice(&ways[0]);
    for (size_t i = 0; i < COUNT_OF(pairs); i++) {
        mspring_network_def def = support_def(-9.8f, 40), other = def;
        mspring_clone_def into;
        mspring_network *clone = NULL;
        check_ok(mspring_init(MSPRING_STRUCT_CLONE_DEF, &into, sizeof into));
        enlist(&def, &pairs[i][0]);
        mspring_network *network = recipe_network(&made, &def);
        support_steps(network, 1, 0.01);
        enlist(&other, &pairs[i][1]);
        into.worker_count = other.worker_count;
        into.tasks = other.tasks;
        check_ok(mspring_network_clone(network, &into, &clone));
        support_steps(network, 2, 0.01);
        support_steps(clone, 2, 0.01);
        assert_true(has_used_halos(clone));
        assert_int_equal(support_hash(clone), support_hash(network));
        mspring_network_destroy(clone);
        mspring_network_destroy(network);
    }
    recipe_free(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_division_gives_the_same_bits),
        cmocka_unit_test(heavy_strips_are_shared_by_weight),
        cmocka_unit_test(one_worker_of_a_host_gets_whole_steps),
        cmocka_unit_test(what_is_refused_is_taken_back),
        cmocka_unit_test(what_sleeps_beside_gives_the_same_bits),
        cmocka_unit_test(what_sleeps_beside_a_notch_changes_nothing),
        cmocka_unit_test(what_sleeps_in_between_changes_nothing),
        cmocka_unit_test(clones_are_shared_in_their_own_way),
    };
    return cmocka_run_group_tests_name("shares", tests, NULL, NULL);
}

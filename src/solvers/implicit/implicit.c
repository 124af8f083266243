/// Creation of an implicit solver, its memory, its edits and its history.
#include "solvers/implicit/implicit.h"

#include <math.h>
#include <string.h>

#include "base/definitions.h"
#include "store/sleepers.h"

/// Default of the most iterations if the residual ends them, and of their number if it does not.
#define MOST_ITERATIONS_BY_DEFAULT 30
#define ITERATIONS_BY_DEFAULT 8

/// Multiply-adds that take about as long as a product with A, for each slot but spare ones.
#define PRODUCT_COST_PER_SLOT 10.0

/* ----------------------------------------------------------------------------------------------------- creation */

/// An implicit solver that is being made.
typedef struct mspringi_implicit_builder {
    mspring_network *network;
    mspringi_implicit *made;
    mspringi_cursor cursor;
    uint32_t tile_size; ///< asked for; 0: by plan
    mspringi_tile_builder tiling;
    mspringi_tiles best; ///< of the sizes tried so far
    double product_cost; ///< multiply-adds that take as long as a product with A
    double best_score;
    mspringi_direct_builder direct;
    mspringi_path_builder finding;
} making;

static bool reserve_field(mspringi_memory *memory, mspringi_field *field, size_t slots) {
    field->x = mspringi_alloc(memory, 2 * slots, sizeof *field->x);
    if (field->x)
        field->y = field->x + slots;
    return field->x != NULL;
}

// A history is one block of memory: first and, with BDF2, second.
static bool reserve_history(mspringi_memory *memory, mspringi_history *history, size_t slots, bool two) {
    float *values = mspringi_alloc(memory, (two ? 4 : 2) * slots, sizeof *values);
    if (!values)
        return false;
    history->restarts = 1;
    history->first = (mspringi_field){values, values + slots};
    if (two)
        history->second = (mspringi_field){values + 2 * slots, values + 3 * slots};
    return true;
}

// Brings the mean of the masses near 1, without rounding any.
static double choose_scale(const mspring_network *network) {
    double sum = 0.0;
    int exponent;
    for (uint32_t p = 0; p < network->topology.particle_count; ++p)
        sum += (double)network->mass[p];
    (void)frexp(sum / (double)network->topology.particle_count, &exponent);
    return ldexp(1.0, -exponent);
}

static mspring_result no_memory(mspring_network *network) {
    return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                         "no memory for an implicit solver of %u particles",
                         (unsigned)network->topology.particle_count);
}

static mspring_result begin(making *m) {
    m->made->scale = choose_scale(m->network);
    m->made->seen = m->network->edits;
    m->made->seen.sleep_changes = ~m->network->edits.sleep_changes; // it is made as if nothing slept
    return mspringi_panels_create(&m->made->panels, &m->network->topology, &m->network->memory,
                                  &m->network->message);
}

static mspring_result allocate(making *m) {
    mspringi_implicit *n = m->made;
    mspring_network *network = m->network;
    mspringi_memory *memory = &network->memory;
    const mspringi_topology *t = &network->topology;
    const size_t slots = mspringi_slot_count(network);
    const bool two = n->integrator == MSPRING_INTEGRATOR_BDF2;
    const size_t loose = ((size_t)t->loose_blocks + t->spare_blocks) * MSPRINGI_WIDTH;
    n->couplings = mspringi_alloc(memory, loose + 1, sizeof *n->couplings);
    n->forces_of_loose = mspringi_alloc(memory, 2 * loose + 1, sizeof *n->forces_of_loose);
    n->history_size = (two ? 4 : 2) * slots;
    n->x = mspringi_alloc(memory, 2 * slots, sizeof *n->x);
    n->mass = mspringi_alloc(memory, slots, sizeof *n->mass);
    n->diagonal = mspringi_alloc(memory, 3 * slots, sizeof *n->diagonal);
    n->sums = mspringi_alloc(memory, slots / MSPRINGI_CHUNK + 1, sizeof *n->sums);
    n->other_sums = mspringi_alloc(memory, slots / MSPRINGI_CHUNK + 1, sizeof *n->other_sums);
    const bool has_all = n->couplings && n->forces_of_loose && n->x && n->mass && n->diagonal && n->sums;
    return has_all && n->other_sums ? MSPRING_OK : no_memory(network);
}

static mspring_result allocate_history(making *m) {
    mspringi_implicit *n = m->made;
    mspringi_memory *memory = &m->network->memory;
    const size_t slots = mspringi_slot_count(m->network);
    const bool two = n->integrator == MSPRING_INTEGRATOR_BDF2;
    return reserve_history(memory, &n->history, slots, two) && reserve_history(memory, &n->backup, slots, two) &&
                   reserve_history(memory, &n->previous, slots, two)
               ? MSPRING_OK
               : no_memory(m->network);
}

static mspring_result allocate_fields(making *m) {
    mspringi_implicit *n = m->made;
    mspringi_memory *memory = &m->network->memory;
    const size_t slots = mspringi_slot_count(m->network);
    return reserve_field(memory, &n->velocity, slots) && reserve_field(memory, &n->residual, slots) &&
                   reserve_field(memory, &n->displacement, slots) && reserve_field(memory, &n->product, slots) &&
                   reserve_field(memory, &n->scaled, slots)
               ? MSPRING_OK
               : no_memory(m->network);
}

static mspring_result make_budget(making *m) {
    return mspringi_budget_create(&m->made->budget, m->network);
}

static mspring_result clear_budget(making *m, uint32_t first, uint32_t end) {
    mspringi_budget_clear(&m->made->budget, first, end);
    return MSPRING_OK;
}

static uint32_t components_of(const making *m) {
    return (uint32_t)(mspringi_slot_count(m->network) / 2 + 1);
}

static mspring_result allocate_factors(making *m) {
    const mspringi_topology *t = &m->network->topology;
    const size_t irregular = ((size_t)t->irregular_capacity + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
    m->made->factors = mspringi_alloc(&m->network->memory, (t->row_spring_slots + irregular) * MSPRINGI_FACTORS,
                                      sizeof *m->made->factors);
    return m->made->factors ? MSPRING_OK : no_memory(m->network);
}

// Further arrays of conjugate gradients.
static mspring_result allocate_iterate(making *m) {
    mspringi_implicit *n = m->made;
    mspring_network *network = m->network;
    mspringi_memory *memory = &network->memory;
    const size_t slots = mspringi_slot_count(network);
    n->tile_motions = mspringi_alloc(memory, n->tiles.capacity, sizeof *n->tile_motions);
    if (!reserve_field(memory, &n->direction, slots) || !reserve_field(memory, &n->arm, slots) || !n->tile_motions)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for the iterations of %u particles",
                             (unsigned)network->topology.particle_count);
    return MSPRING_OK;
}

// Pointers into arrays of its own, and into those of the network that do not change from substep to substep.
static void wire(mspringi_implicit *n, const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const size_t slots = mspringi_slot_count(network);
    mspringi_system *s = &n->system;
    n->y = n->x + slots;
    n->tiles.paths = &n->paths;
    n->irregular_factors = n->factors + (size_t)t->row_spring_slots * MSPRINGI_FACTORS;
    n->seen.link_log = network->edits.link_log;
    s->x = n->x;
    s->y = n->y;
    s->vx = n->velocity.x;
    s->vy = n->velocity.y;
    s->mass = n->mass;
    s->lattice_springs = network->lattice_springs;
    s->chain_springs = network->chain_springs;
    s->rest_lengths = network->rest_lengths.lengths;
    s->rests_of_block = network->rest_lengths.of_block;
    s->lattice_factors = n->factors;
    s->chain_factors = n->factors + (size_t)t->lattice_spring_slots * MSPRINGI_FACTORS;
    s->force_x = n->residual.x;
    s->force_y = n->residual.y;
    s->xx = n->diagonal;
    s->xy = n->diagonal + slots;
    s->yy = n->diagonal + 2 * slots;
    n->iterate = (mspringi_iterate){
        .solution_x = n->displacement.x,
        .solution_y = n->displacement.y,
        .residual_x = n->residual.x,
        .residual_y = n->residual.y,
        .scaled_x = n->scaled.x,
        .scaled_y = n->scaled.y,
        .direction_x = n->direction.x,
        .direction_y = n->direction.y,
        .product_x = n->product.x,
        .product_y = n->product.y,
        .arm_x = n->arm.x,
        .arm_y = n->arm.y,
    };
}

// Reserve the arrays of each worker.
mspring_result mspringi_implicit_reserve(mspringi_implicit *n, mspring_network *network) {
    mspringi_memory *memory = &network->memory;
    const uint32_t team = mspringi_tasks_concurrency(network->tasks);
    const size_t carry = (size_t)network->topology.carry_blocks * MSPRINGI_WIDTH;
    if (n->team >= team)
        return MSPRING_OK;
    double *forces = mspringi_alloc(memory, 2 * carry * team, sizeof *forces);
    float *others = mspringi_alloc(memory, 3 * carry * team, sizeof *others);
    double(*unknowns)[MSPRINGI_RIGID] = mspringi_alloc(memory, (size_t)n->tiles.capacity * team, sizeof *unknowns);
    if (!forces || !others || !unknowns) {
        mspringi_free(memory, forces);
        mspringi_free(memory, others);
        mspringi_free(memory, unknowns);
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for what %u workers compute",
                             (unsigned)team);
    }
    mspringi_free(memory, n->force_carry);
    mspringi_free(memory, n->carry);
    mspringi_free(memory, n->unknowns);
    n->force_carry = forces;
    n->carry = others;
    n->unknowns = unknowns;
    n->team = team;
    return MSPRING_OK;
}

// True if the coarse matrix of these tiles is cheap enough to be factored in each substep.
static mspring_result check_coarse(const mspringi_implicit *n, mspring_network *network) {
    const double cost = mspringi_coarse_cost(&n->tiles);
    if (cost <= MSPRINGI_MOST_COARSE_COST)
        return MSPRING_OK;
    return mspringi_fail(&network->message, MSPRING_ERROR_LIMIT,
                         "with tiles of size %u there are %u of them, so tied to each other that factoring their "
                         "coarse matrix would take %.2g multiply-adds, more than %.2g: leave tile_size at 0, take "
                         "larger tiles or the explicit solver",
                         (unsigned)n->tiles.cells.size, (unsigned)n->tiles.count, cost, MSPRINGI_MOST_COARSE_COST);
}

// Of any but the largest tiles, a matrix that costs more than those could be better by is not needed.
static void begin_tiles(making *m, uint32_t size) {
    const bool is_last = m->tile_size > 0 || size == MSPRINGI_LARGEST_TILE_SIZE;
    const double most_products = is_last ? INFINITY : MSPRINGI_LARGEST_TILE_SIZE / MSPRINGI_LEAST_TILE_SIZE;
    mspringi_tiles_begin(&m->tiling, &m->made->tiles, m->network, &m->made->paths, size,
                         fmin(most_products * m->product_cost, MSPRINGI_MOST_COARSE_COST), &m->network->memory,
                         &m->network->message);
}

static mspring_result choose_tiles(making *m) {
    const mspringi_topology *t = &m->network->topology;
    m->product_cost = PRODUCT_COST_PER_SLOT * MSPRINGI_WIDTH * (double)(t->block_count - t->spare_blocks);
    begin_tiles(m, m->tile_size > 0 ? m->tile_size : MSPRINGI_LEAST_TILE_SIZE);
    return MSPRING_OK;
}

// Products that a substep takes with these tiles, less a constant. Factoring costs as much as some. Larger tiles
// take more iterations: one more for each 8 rows on lattices, twice as many where ropes hang on thin structures.
static double score_of(const making *m) {
    const mspringi_cells *cells = &m->made->tiles.cells;
    const double cost = mspringi_coarse_cost(&m->made->tiles);
    const bool is_affordable = cells->has_rows && cost <= MSPRINGI_MOST_COARSE_COST;
    return is_affordable ? cost / m->product_cost + (double)cells->size / MSPRINGI_LEAST_TILE_SIZE : INFINITY;
}

// Cut into tiles of the size asked for or else of each size, until larger ones cannot be better. Keep the best.
static mspring_result cut_tiles(making *m) {
    mspringi_tiles *tiles = &m->made->tiles;
    const uint32_t size = tiles->cells.size;
    bool is_done;
    mspring_result result = mspringi_tiles_run(&m->tiling, &is_done);
    m->cursor.again = true;
    if (result != MSPRING_OK || !is_done)
        return result;
    mspringi_tiles_end(&m->tiling);
    const double score = score_of(m);
    const bool is_better = score <= m->best_score;
    mspringi_tiles_destroy(is_better ? &m->best : tiles, &m->network->memory);
    if (is_better) {
        m->best = *tiles;
        m->best_score = score;
    }
    m->cursor.again = m->tile_size == 0 && size < MSPRINGI_LARGEST_TILE_SIZE &&
                      2.0 * size / MSPRINGI_LEAST_TILE_SIZE < m->best_score;
    if (m->cursor.again) {
        begin_tiles(m, 2 * size);
    } else {
        *tiles = m->best;
        m->best = (mspringi_tiles){0};
    }
    return MSPRING_OK;
}

static mspring_result begin_paths(making *m) {
    m->finding.paths = &m->made->paths;
    return mspringi_paths_begin(&m->finding);
}

static mspring_result count_path_springs(making *m, uint32_t first, uint32_t end) {
    mspringi_paths_count_springs(&m->finding, first, end);
    return MSPRING_OK;
}

static uint32_t springs_in(const making *m) {
    return m->network->topology.spring_count;
}

static mspring_result list_paths(making *m) {
    const mspring_result result = mspringi_paths_list(&m->finding);
    mspringi_paths_end(&m->finding);
    return result;
}

static mspring_result make_coarse(making *m) {
    mspringi_implicit *n = m->made;
    mspring_network *network = m->network;
    const mspring_result result = check_coarse(n, network);
    return result == MSPRING_OK ? mspringi_coarse_create(&n->coarse, &n->tiles, &network->memory, &network->message)
                                : result;
}

static mspring_result begin_direct(making *m) {
    mspringi_direct_begin(&m->direct, &m->made->direct, m->network);
    return MSPRING_OK;
}

static mspring_result make_direct(making *m) {
    bool is_done;
    const mspring_result result = mspringi_direct_make(&m->direct, &is_done);
    m->cursor.again = !is_done;
    return result;
}

// Mark the loose slots that are in tiles or, with the direct solver, that springs had been added to when it was
// made.
static void find_solved(mspringi_implicit *n, const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    const size_t loose = (size_t)t->loose_first * MSPRINGI_WIDTH;
    const size_t count = ((size_t)t->loose_blocks + t->spare_blocks) * MSPRINGI_WIDTH;
    for (size_t i = 0; !n->is_direct && i < count; ++i)
        n->couplings[i] = n->tiles.of_slot[loose + i] != MSPRING_NONE ? MSPRINGI_COUPLED_BY_SPRINGS : 0;
    for (uint32_t i = t->laid_out_count; n->is_direct && i < t->irregular_count; ++i) {
        if (t->irregular_a[i] >= loose)
            n->couplings[t->irregular_a[i] - loose] = MSPRINGI_COUPLED_BY_SPRINGS;
        if (t->irregular_b[i] >= loose)
            n->couplings[t->irregular_b[i] - loose] = MSPRINGI_COUPLED_BY_SPRINGS;
    }
}

static mspring_result finish(making *m) {
    const mspring_result result = mspringi_implicit_reserve(m->made, m->network);
    if (result == MSPRING_OK) {
        wire(m->made, m->network);
        find_solved(m->made, m->network);
    }
    return result;
}

static void end_making(mspringi_implicit *n, mspringi_memory *memory) {
    if (!n->making)
        return;
    mspringi_tiles_end(&n->making->tiling);
    mspringi_tiles_destroy(&n->making->best, memory);
    mspringi_direct_end(&n->making->direct);
    mspringi_paths_end(&n->making->finding);
    mspringi_free(memory, n->making);
    n->making = NULL;
}

MSPRINGI_PASSES(implicit, making)
#define COMMON                                                                                                     \
    MSPRINGI_ONCE(begin), MSPRINGI_ONCE(allocate), MSPRINGI_ONCE(allocate_factors),                                \
        MSPRINGI_ONCE(allocate_history), MSPRINGI_ONCE(allocate_fields), MSPRINGI_ONCE(make_budget),               \
        MSPRINGI_EACH(clear_budget, components_of, 2000)
static const implicit_pass two_level_passes[] = {
    COMMON,
    MSPRINGI_ONCE(begin_paths),
    MSPRINGI_EACH(count_path_springs, springs_in, 32000),
    MSPRINGI_ONCE(list_paths),
    MSPRINGI_ONCE(choose_tiles),
    MSPRINGI_ONCE(cut_tiles),
    MSPRINGI_ONCE(make_coarse),
    MSPRINGI_ONCE(allocate_iterate),
    MSPRINGI_ONCE(finish),
};
static const implicit_pass direct_passes[] = {
    COMMON,
    MSPRINGI_ONCE(begin_direct),
    MSPRINGI_ONCE(make_direct),
    MSPRINGI_ONCE(finish),
};

mspring_result mspringi_implicit_begin(mspring_network *network, const mspring_settings *def, uint32_t tile_size,
                                       mspringi_implicit **begun) {
    mspringi_implicit *n = mspringi_alloc(&network->memory, 1, sizeof *n);
    making *m = mspringi_alloc(&network->memory, 1, sizeof *m);
    if (!n || !m) {
        mspringi_free(&network->memory, n);
        mspringi_free(&network->memory, m);
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for an implicit solver");
    }
    *m = (making){.network = network,
                  .made = n,
                  .tile_size = def->tile_size > 0 ? def->tile_size : tile_size,
                  .best_score = INFINITY};
    m->tiling.memory = m->tiling.cutting.memory = &network->memory;
    m->finding =
        (mspringi_path_builder){.network = network, .memory = &network->memory, .message = &network->message};
    n->making = m;
    n->tile_size = def->tile_size;
    n->integrator = def->integrator;
    n->is_direct = def->solver == MSPRING_SOLVER_DIRECT;
    mspringi_implicit_adjust(n, def);
    *begun = n;
    return MSPRING_OK;
}

mspring_result mspringi_implicit_make(mspringi_implicit *n, bool *is_done) {
    making *m = n->making;
    mspring_network *network = m->network;
    const uint32_t count =
        n->is_direct ? MSPRINGI_PASS_COUNT(direct_passes) : MSPRINGI_PASS_COUNT(two_level_passes);
    const mspring_result result = implicit_run(m, n->is_direct ? direct_passes : two_level_passes, &m->cursor);
    *is_done = m->cursor.pass == count;
    if (result == MSPRING_OK && *is_done)
        end_making(n, &network->memory);
    return result;
}

void mspringi_implicit_adjust(mspringi_implicit *n, const mspring_settings *def) {
    const float residual = n->is_direct ? MSPRINGI_RESIDUAL : def->residual;
    const uint32_t usual = residual > 0.0f ? MOST_ITERATIONS_BY_DEFAULT : ITERATIONS_BY_DEFAULT;
    const uint32_t iterations = !n->is_direct && def->iterations > 0 ? def->iterations : usual;
    const uint32_t coarse_period = !n->is_direct && def->coarse_period > 0 ? def->coarse_period : 1;
    if (iterations != n->iterations || residual != n->residual_share || coarse_period != n->coarse_period)
        n->age = 0;
    n->iterations = iterations;
    n->residual_share = residual;
    n->coarse_period = coarse_period;
}

#define ARRAY(member) MSPRINGI_ARRAY_ENTRY(mspringi_implicit, member, MSPRINGI_ARRAY)
#define VIEW(member) MSPRINGI_ARRAY_ENTRY(mspringi_implicit, member, MSPRINGI_VIEW)
#define FIELD(member) ARRAY(member.x), VIEW(member.y)
#define HISTORY(member) FIELD(member.first), VIEW(member.second.x), VIEW(member.second.y)
static const mspringi_array_entry list[] = {
    HISTORY(history), HISTORY(backup),        HISTORY(previous),   ARRAY(x),
    FIELD(velocity),  FIELD(residual),        FIELD(displacement), FIELD(direction),
    FIELD(product),   FIELD(scaled),          FIELD(arm),          ARRAY(mass),
    ARRAY(diagonal),  ARRAY(factors),         ARRAY(force_carry),  ARRAY(carry),
    ARRAY(sums),      ARRAY(other_sums),      ARRAY(tile_motions), ARRAY(unknowns),
    ARRAY(couplings), ARRAY(forces_of_loose),
};
static const mspringi_array_table columns = MSPRINGI_ARRAY_TABLE(list);

void mspringi_implicit_destroy(mspringi_implicit *n, mspringi_memory *memory) {
    if (!n)
        return;
    end_making(n, memory);
    mspringi_direct_destroy(&n->direct, memory);
    mspringi_panels_destroy(&n->panels, memory);
    mspringi_budget_destroy(&n->budget, memory);
    mspringi_tiles_destroy(&n->tiles, memory);
    mspringi_coarse_destroy(&n->coarse, memory);
    mspringi_array_table_free(mspringi_paths_columns, &n->paths, memory);
    mspringi_array_table_free(columns, n, memory);
    mspringi_free(memory, n);
}

void mspringi_implicit_relocate(mspringi_implicit *n, const mspring_network *network, const mspringi_memory *from,
                                const mspringi_memory *to) {
    mspringi_array_table_relocate(columns, n, from, to);
    mspringi_array_table_relocate(mspringi_panels_columns, &n->panels, from, to);
    mspringi_array_table_relocate(mspringi_budget_columns, &n->budget, from, to);
    mspringi_array_table_relocate(mspringi_cells_columns, &n->tiles.cells, from, to);
    mspringi_array_table_relocate(mspringi_tiles_columns, &n->tiles, from, to);
    mspringi_array_table_relocate(mspringi_coarse_columns, &n->coarse, from, to);
    mspringi_array_table_relocate(mspringi_paths_columns, &n->paths, from, to);
    mspringi_direct_relocate(&n->direct, from, to);
    wire(n, network);
}

/* ------------------------------------------------------------------------------------------------------ history */

// Clear what is 0 where there is no tile or, with the direct solver, everywhere, unless numbers overflowed.
static void clear_outside_of_tiles(const mspring_network *network, const mspringi_implicit *n) {
    const mspringi_field fields[] = {n->scaled, n->direction, n->product};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i)
        if (fields[i].x)
            memset(fields[i].x, 0, 2 * mspringi_slot_count(network) * sizeof *fields[i].x);
}

// Clear all vectors at slots without a particle. Kernels read them with mass 0, which does not end a NaN.
static void clear_empty_slots(const mspring_network *network, const mspringi_implicit *n) {
    const mspringi_field fields[] = {n->velocity, n->residual, n->displacement, n->arm};
    const size_t slots = mspringi_slot_count(network);
    for (size_t slot = 0; slot < slots; ++slot) {
        if (network->topology.particle_of_slot[slot] != MSPRING_NONE)
            continue;
        n->x[slot] = n->y[slot] = 0.0;
        n->diagonal[slot] = n->diagonal[slot + slots] = n->diagonal[slot + 2 * slots] = 0.0f;
        for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i)
            if (fields[i].x)
                fields[i].x[slot] = fields[i].y[slot] = 0.0f;
    }
}

void mspringi_implicit_clear_overflow(const mspring_network *network, mspringi_implicit *n) {
    const size_t carry = (size_t)network->topology.carry_blocks * MSPRINGI_WIDTH * n->team;
    memset(n->force_carry, 0, 2 * carry * sizeof *n->force_carry);
    memset(n->carry, 0, 3 * carry * sizeof *n->carry);
    clear_outside_of_tiles(network, n);
    clear_empty_slots(network, n);
    n->may_have_overflowed = false;
}

void mspringi_implicit_keep(mspringi_implicit *n) {
    n->is_kept = true;
    n->has_changed = false;
    n->kept_age = n->has_constraints_in_coarse ? 0 : n->age;
    n->kept_restarts = n->history.restarts;
    n->product_count = n->pass_count = n->intervals_left = 0;
    n->is_spent = false;
    if (n->kept_age > 0)
        mspringi_coarse_keep(&n->coarse);
}

void mspringi_implicit_restore(const mspring_network *network, mspringi_implicit *n) {
    if (n->has_changed) {
        const mspringi_history failed = n->history;
        n->history = n->backup;
        n->backup = failed;
    }
    n->history.restarts = n->kept_restarts; // a first substep that is taken again begins anew: that changes them
    n->has_changed = n->is_kept = false;
    n->budget.knows_elastic = false;
    n->age = n->kept_age;
    n->has_constraints_in_coarse = false;
    if (n->age > 0)
        mspringi_coarse_restore(&n->coarse);
    mspringi_implicit_clear_overflow(network, n);
}

// Sleeping particles are left out of substeps: their prediction is their position.
static void rest_sleepers(const mspring_network *network, mspringi_implicit *n) {
    for (size_t slot = 0; slot < mspringi_slot_count(network); ++slot) {
        if (!mspringi_slot_is_asleep(network, slot))
            continue;
        n->x[slot] = mspringi_x_of(&network->state, slot);
        n->y[slot] = mspringi_y_of(&network->state, slot);
        n->mass[slot] = 0.0f;
        n->velocity.x[slot] = n->velocity.y[slot] = 0.0f;
        n->displacement.x[slot] = n->displacement.y[slot] = 0.0f;
    }
    n->rested = network->edits.sleep_changes;
}

// The factorisation of the direct solver has places for all.
static void follow_slots(const mspring_network *network, mspringi_implicit *n) {
    const size_t slots = n->is_direct ? mspringi_slot_count(network) : mspringi_used_slots(network);
    n->used_slot_end = slots > n->used_slot_end ? slots : n->used_slot_end;
}

void mspringi_implicit_update(const mspring_network *network, mspringi_implicit *n) {
    follow_slots(network, n);
    if (n->rested != network->edits.sleep_changes && network->sleep.sleeping > 0)
        rest_sleepers(network, n);
    if (!n->is_direct && mspringi_tiles_are_outdated(&n->tiles, network, &n->seen)) {
        mspringi_tiles_update(&n->tiles, network, &n->seen);
        mspringi_coarse_shape(&n->coarse, &n->tiles);
        find_solved(n, network);
        clear_outside_of_tiles(network, n);
        n->age = n->kept_age = 0;
    }
    n->seen = network->edits;
}

void mspringi_implicit_forget(mspringi_implicit *n) {
    memset(n->history.first.x, 0, n->history_size * sizeof *n->history.first.x);
    n->history.restarts = n->kept_restarts = 1; // also after a step that is refused: that history is gone
    n->budget.knows_elastic = false;
    n->may_have_overflowed = true;
}

/* ----------------------------------------------------------------------------------------------------- ranges */

// The factorisation of the direct solver has places for all.
bool mspringi_next_slots(const mspring_network *network, mspringi_slots slots, size_t *at, mspringi_slots *run) {
    const size_t first = *at > slots.first ? *at : slots.first;
    *run = (mspringi_slots){first, first};
    *at = slots.end;
    if (network->sleep.sleeping == 0 || mspringi_implicit_of(network)->is_direct) {
        run->end = slots.end;
        return run->first < run->end;
    }
    for (size_t chunk = first; chunk < slots.end; chunk += MSPRINGI_CHUNK) {
        const size_t end = chunk + MSPRINGI_CHUNK < slots.end ? chunk + MSPRINGI_CHUNK : slots.end;
        if (mspringi_is_any_swept(network, chunk / MSPRINGI_WIDTH, end / MSPRINGI_WIDTH)) {
            run->end = end;
        } else if (run->end > run->first) {
            *at = chunk;
            return true;
        } else {
            run->first = run->end = end;
        }
    }
    return run->end > run->first;
}

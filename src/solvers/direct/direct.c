/// The system of an implicit substep as a matrix of 2 x 2 blocks, factored and solved.
#include "solvers/direct/direct.h"

#include <math.h>
#include <string.h>

#include "base/hash.h"
#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"

/// The largest stiffness at a particle, in the units of its mass in A, that goes with single precision. Rounding is
/// 6e-8 of the stiffness: 0.1 % of the mass there, at random, so far less in any motion of many particles.
#define SINGLE_STIFFNESS 16384.0f

/// Most numbers that a factor may take, 1.6 GB in both precisions: a square of some 600 x 600 particles, or a
/// random graph of some 5,000, of which a substep takes seconds.
#define MOST_NUMBERS 0x1p27

/// What a pinned particle's mass is in A: what springs can take from it is lost in rounding.
#define PINNED_MASS 0x1p100

/// What is added to the mass where double precision fails, as a part of the stiffness: at first, and at most.
#define LEAST_ADDED 0x1p-46
#define MOST_ADDED 0x1p-10

/* ------------------------------------------------------------------------------------------------------- graph */

/// Times that positions are handed on to neighbours, in one direction of the places and then in the other.
#define PLACING_PASSES 4

typedef mspringi_direct_builder making;

static size_t block_count(const mspringi_direct *direct) {
    return ((size_t)direct->place_count + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH;
}

// The springs of a block's places, if their ends follow on each other as the places do; else there is no tip.
static mspringi_edge_block find_edge_block(const mspringi_direct *direct, size_t block, uint32_t slots) {
    const uint32_t first = (uint32_t)(block * MSPRINGI_WIDTH);
    const uint32_t rest = direct->place_count - first, count = rest < MSPRINGI_WIDTH ? rest : MSPRINGI_WIDTH;
    const mspringi_edge_block others = {.lanes = UINT32_MAX};
    mspringi_edge_block found = {0};
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t a = direct->end_a[first + i], b = direct->end_b[first + i];
        if (a == slots)
            continue;
        if (found.lanes == 0 && (a < i || b < i))
            return others;
        if (found.lanes == 0)
            found = (mspringi_edge_block){.base = a - i, .tip = b - i};
        if (a != found.base + i || b != found.tip + i)
            return others;
        found.lanes |= (uint32_t)1 << i;
    }
    return found;
}

// Slots without springs are absent, and so is the one behind the last, the end of places without spring.
static void list_absent(const mspring_network *network, const mspringi_direct *direct, bool *absent) {
    const size_t slots = mspringi_slot_count(network);
    for (size_t slot = 0; slot <= slots; ++slot)
        absent[slot] = true;
    for (uint32_t spring_slot = 0; spring_slot < direct->place_count; ++spring_slot)
        absent[direct->end_a[spring_slot]] = absent[direct->end_b[spring_slot]] = false;
    absent[slots] = true;
}

/* ------------------------------------------------------------------------------------------------------ memory */

/* ---------------------------------------------------------------------------------------------------- the list */

static mspring_result no_memory(const making *m) {
    return mspringi_fail(&m->network->message, MSPRING_ERROR_MEMORY,
                         "no memory for a direct solver of %u particles",
                         (unsigned)m->network->topology.particle_count);
}

static mspring_result begin_places(making *m) {
    const mspringi_topology *t = &m->network->topology;
    mspringi_memory *memory = &m->network->memory;
    mspringi_direct *d = m->direct;
    const size_t nodes = mspringi_slot_count(m->network) + 1;
    *d = (mspringi_direct){.place_count = t->row_spring_slots + t->irregular_count,
                           .fingerprint = MSPRINGI_HASH_START};
    d->end_a = mspringi_alloc(memory, d->place_count, sizeof *d->end_a);
    d->end_b = mspringi_alloc(memory, d->place_count, sizeof *d->end_b);
    d->edge_blocks = mspringi_alloc(memory, block_count(d), sizeof *d->edge_blocks);
    m->x = mspringi_alloc(memory, 2 * nodes, sizeof *m->x);
    m->absent = mspringi_alloc(memory, nodes, sizeof *m->absent);
    m->is_placed = mspringi_alloc(memory, nodes, sizeof *m->is_placed);
    if (!d->end_a || !d->end_b || !d->edge_blocks || !m->x || !m->absent || !m->is_placed)
        return no_memory(m);
    for (uint32_t spring_slot = 0; spring_slot < d->place_count; ++spring_slot)
        d->end_a[spring_slot] = d->end_b[spring_slot] = (uint32_t)nodes - 1;
    return MSPRING_OK;
}

static mspring_result list_ends(making *m, uint32_t first, uint32_t end) {
    const mspringi_topology *t = &m->network->topology;
    for (mspring_id spring = first; spring < end; ++spring) {
        const mspringi_spring_slot spring_slot = t->slot_of_spring[spring];
        if (mspringi_spring_slot_is_inactive(t, spring_slot) || !mspringi_spring_exists(m->network, spring))
            continue;
        uint32_t *a = &m->direct->end_a[spring_slot], *b = &m->direct->end_b[spring_slot];
        mspringi_topology_ends(t, spring_slot, a, b);
        m->direct->fingerprint = mspringi_hash(m->direct->fingerprint, (uint64_t)*a << 32 | *b);
    }
    return MSPRING_OK;
}

static mspring_result find_edge_blocks(making *m, uint32_t first, uint32_t end) {
    const uint32_t slots = (uint32_t)mspringi_slot_count(m->network);
    for (size_t block = first; block < end; ++block)
        m->direct->edge_blocks[block] = find_edge_block(m->direct, block, slots);
    return MSPRING_OK;
}

// Positions as a hint for the order: by layout alone, as the order has to be the same for all networks that are
// made alike, wherever their particles are by now. What is in no grid is where a neighbour is.
static mspring_result place_rows(making *m) {
    const mspringi_topology *t = &m->network->topology;
    double *const x = m->x, *const y = m->x + mspringi_slot_count(m->network) + 1;
    list_absent(m->network, m->direct, m->absent);
    for (uint32_t r = 0; r < t->lattice_rows; ++r) {
        const mspringi_row *row = &t->rows[r];
        for (uint32_t s = row->first_span; s < row->first_span + row->span_count; ++s) {
            const mspringi_span *span = &t->spans[s];
            for (uint32_t slot = span->first_slot; slot < span->end_slot; ++slot) {
                x[slot] = (double)((int64_t)slot + span->carry);
                y[slot] = (double)r;
                m->is_placed[slot] = true;
            }
        }
    }
    return MSPRING_OK;
}

static mspring_result place_others(making *m, uint32_t first, uint32_t end) {
    const mspringi_direct *d = m->direct;
    double *const x = m->x, *const y = m->x + mspringi_slot_count(m->network) + 1;
    for (uint32_t i = first; i < end; ++i) {
        const uint32_t pass = i / d->place_count, at = i % d->place_count;
        const uint32_t spring_slot = pass % 2 == 0 ? at : d->place_count - 1 - at;
        const uint32_t a = d->end_a[spring_slot], b = d->end_b[spring_slot];
        const uint32_t from = m->is_placed[a] ? a : b, to = m->is_placed[a] ? b : a;
        if (m->is_placed[from] && !m->is_placed[to]) {
            x[to] = x[from];
            y[to] = y[from];
            m->is_placed[to] = true;
        }
    }
    return MSPRING_OK;
}

static mspring_result begin_plan(making *m) {
    const size_t nodes = mspringi_slot_count(m->network) + 1;
    m->graph = (mspringi_cholesky_graph){.node_count = (uint32_t)nodes,
                                         .edge_count = m->direct->place_count,
                                         .edge_a = m->direct->end_a,
                                         .edge_b = m->direct->end_b,
                                         .absent = m->absent,
                                         .x = m->x,
                                         .y = m->x + nodes,
                                         .most_numbers = MOST_NUMBERS};
    return mspringi_cholesky_symbolic_begin(&m->direct->plan, &m->graph, &m->network->memory, &m->network->message,
                                            &m->planning);
}

static mspring_result refuse(const making *m) {
    const mspringi_topology *t = &m->network->topology;
    const double numbers = m->direct->plan.predicted_numbers, bytes = sizeof(float) + sizeof(double);
    return mspringi_fail(
        &m->network->message, MSPRING_ERROR_LIMIT,
        "the direct solver's factor for %u particles and %u springs would take at least %.3g numbers "
        "(%.3g GB), more than %.3g (%.3g GB): take the implicit solver",
        (unsigned)t->particle_count, (unsigned)t->spring_count, numbers, 1e-9 * bytes * numbers, MOST_NUMBERS,
        1e-9 * bytes * MOST_NUMBERS);
}

static mspring_result run_plan(making *m) {
    bool is_done;
    const mspring_result result = mspringi_cholesky_symbolic_run(m->planning, &is_done);
    m->cursor.again = !is_done;
    return result == MSPRING_ERROR_LIMIT ? refuse(m) : result == MSPRING_ERROR_MEMORY ? no_memory(m) : result;
}

static mspring_result reserve_system(making *m) {
    mspringi_direct *d = m->direct;
    mspringi_memory *memory = &m->network->memory;
    const size_t spring_slots = d->place_count, nodes = mspringi_slot_count(m->network) + 1;
    const size_t whole = block_count(d) * MSPRINGI_WIDTH, all_nodes = nodes + MSPRINGI_WIDTH;
    // Where no spring is, nothing of these is read; all else is set in each substep.
    d->edges.xx = mspringi_alloc_unset(memory, 3 * spring_slots, sizeof *d->edges.xx);
    d->edges_twice.xx = mspringi_alloc_unset(memory, 3 * whole, sizeof *d->edges_twice.xx);
    d->nodes_twice.xx = mspringi_alloc_unset(memory, 3 * all_nodes, sizeof *d->nodes_twice.xx);
    d->solution = mspringi_alloc(memory, 2 * nodes, sizeof *d->solution);
    d->answer = mspringi_alloc_unset(memory, 4 * nodes, sizeof *d->answer);
    if (!d->edges.xx || !d->edges_twice.xx || !d->nodes_twice.xx || !d->solution || !d->answer)
        return no_memory(m);
    d->edges.xy = d->edges.xx + spring_slots;
    d->edges.yy = d->edges.xy + spring_slots;
    d->edges_twice.xy = d->edges_twice.xx + whole;
    d->edges_twice.yy = d->edges_twice.xy + whole;
    d->nodes_twice.xy = d->nodes_twice.xx + all_nodes;
    d->nodes_twice.yy = d->nodes_twice.xy + all_nodes;
    return MSPRING_OK;
}

static mspring_result reserve_single(making *m) {
    mspring_network *n = m->network;
    const mspring_result result = mspringi_cholesky_float_reserve(&m->direct->single, &m->direct->plan,
                                                                  n->kernels->level, &n->memory, &n->message);
    return result == MSPRING_OK ? MSPRING_OK : no_memory(m);
}

static mspring_result reserve_double(making *m) {
    mspring_network *n = m->network;
    const mspring_result result = mspringi_cholesky_double_reserve(&m->direct->twice, &m->direct->plan,
                                                                   n->kernels->level, &n->memory, &n->message);
    return result == MSPRING_OK ? MSPRING_OK : no_memory(m);
}

// Have the system give the memory of the factor that is used first, in pieces: the first substep would take longer.
// Few networks ever use the other.
#define PIECE 1024

static mspring_result clear_single(making *m, uint32_t first, uint32_t end) {
    const size_t values = m->direct->plan.panel_reals, begin = (size_t)first * PIECE;
    const size_t count = (size_t)(end - first) * PIECE;
    if (begin < values)
        memset(m->direct->single.panels + begin, 0,
               (count < values - begin ? count : values - begin) * sizeof(float));
    return MSPRING_OK;
}

// What has to be 0 takes milliseconds for 150,000 springs, as the system gives its memory then.
static mspring_result clear_rest_of_single(making *m, uint32_t first, uint32_t end) {
    mspringi_cholesky_float_clear(&m->direct->single, (size_t)first * PIECE, (size_t)(end - first) * PIECE);
    return MSPRING_OK;
}

static mspring_result clear_rest_of_double(making *m, uint32_t first, uint32_t end) {
    mspringi_cholesky_double_clear(&m->direct->twice, (size_t)first * PIECE, (size_t)(end - first) * PIECE);
    return MSPRING_OK;
}

static uint32_t rest_of_single(const making *m) {
    return (uint32_t)(m->direct->single.rest / PIECE + 1);
}

static uint32_t rest_of_double(const making *m) {
    return (uint32_t)(m->direct->twice.rest / PIECE + 1);
}

static uint32_t pieces_of(const making *m) {
    return (uint32_t)(m->direct->plan.panel_reals / PIECE + 1);
}

static uint32_t springs_of(const making *m) {
    return m->network->topology.spring_count;
}

static uint32_t placings_of(const making *m) {
    return PLACING_PASSES * m->direct->place_count;
}

static uint32_t blocks_of(const making *m) {
    return (uint32_t)block_count(m->direct);
}

MSPRINGI_PASSES(direct, making)
static const direct_pass direct_passes[] = {
    MSPRINGI_ONCE(begin_places),
    MSPRINGI_EACH(list_ends, springs_of, 32000),
    MSPRINGI_EACH(find_edge_blocks, blocks_of, 4000),
    MSPRINGI_ONCE(place_rows),
    MSPRINGI_EACH(place_others, placings_of, 128000),
    MSPRINGI_ONCE(begin_plan),
    MSPRINGI_ONCE(run_plan),
    MSPRINGI_ONCE(reserve_system),
    MSPRINGI_ONCE(reserve_single),
    MSPRINGI_ONCE(reserve_double),
    MSPRINGI_EACH(clear_rest_of_single, rest_of_single, 256),
    MSPRINGI_EACH(clear_rest_of_double, rest_of_double, 128),
    MSPRINGI_EACH(clear_single, pieces_of, 256),
};

void mspringi_direct_begin(making *m, mspringi_direct *direct, mspring_network *network) {
    *m = (making){.network = network, .direct = direct};
}

mspring_result mspringi_direct_make(making *m, bool *is_done) {
    const mspring_result result = direct_run(m, direct_passes, &m->cursor);
    *is_done = m->cursor.pass == MSPRINGI_PASS_COUNT(direct_passes);
    if (*is_done)
        mspringi_direct_end(m);
    return result;
}

void mspringi_direct_end(making *m) {
    if (!m->network)
        return;
    mspringi_memory *memory = &m->network->memory;
    mspringi_cholesky_symbolic_end(m->planning, memory);
    mspringi_free(memory, m->x);
    mspringi_free(memory, m->absent);
    mspringi_free(memory, m->is_placed);
    *m = (making){0};
}

#define ARRAY(member) MSPRINGI_ARRAY_ENTRY(mspringi_direct, member, MSPRINGI_ARRAY)
#define VIEW(member) MSPRINGI_ARRAY_ENTRY(mspringi_direct, member, MSPRINGI_VIEW)
static const mspringi_array_entry list[] = {
    ARRAY(end_a),         ARRAY(end_b),          ARRAY(edge_blocks),   ARRAY(edges.xx),      VIEW(edges.xy),
    VIEW(edges.yy),       ARRAY(edges_twice.xx), VIEW(edges_twice.xy), VIEW(edges_twice.yy), ARRAY(nodes_twice.xx),
    VIEW(nodes_twice.xy), VIEW(nodes_twice.yy),  ARRAY(solution),      ARRAY(answer),
};
static const mspringi_array_table columns = MSPRINGI_ARRAY_TABLE(list);

void mspringi_direct_destroy(mspringi_direct *direct, mspringi_memory *memory) {
    mspringi_cholesky_float_destroy(&direct->single, memory);
    mspringi_cholesky_double_destroy(&direct->twice, memory);
    mspringi_cholesky_symbolic_destroy(&direct->plan, memory);
    mspringi_array_table_free(columns, direct, memory);
    *direct = (mspringi_direct){0};
}

void mspringi_direct_relocate(mspringi_direct *direct, const mspringi_memory *from, const mspringi_memory *to) {
    mspringi_array_table_relocate(columns, direct, from, to);
    mspringi_array_table_relocate(mspringi_cholesky_symbolic_columns, &direct->plan, from, to);
    mspringi_array_table_relocate(mspringi_cholesky_float_columns, &direct->single, from, to);
    mspringi_array_table_relocate(mspringi_cholesky_double_columns, &direct->twice, from, to);
}

/* ------------------------------------------------------------------------------------------- single precision */

// Add the masses to the blocks on the diagonal. Returns whether single precision will do.
static bool finish_diagonal(const mspringi_system *s, size_t slots) {
    const float pinned = (float)PINNED_MASS;
    uint32_t too_stiff = 0;
    for (size_t i = 0; i < slots; ++i) {
        const float mass = s->mass[i], xx = s->xx[i] + mass, yy = s->yy[i] + mass;
        too_stiff |= (uint32_t)(mass > 0.0f) & (uint32_t) !(xx + yy <= mass * SINGLE_STIFFNESS);
        s->xx[i] = mass > 0.0f ? xx : pinned; // also where no row writes to, and nothing must add up
        s->yy[i] = mass > 0.0f ? yy : pinned;
    }
    return !too_stiff;
}

static const float *factors_of_block(const mspringi_implicit *n, size_t block) {
    return n->factors + block * MSPRINGI_FACTORS * MSPRINGI_WIDTH;
}

// The blocks beside the diagonal, MSPRINGI_WIDTH places at a time.
static void fill_edges(const mspringi_implicit *n) {
    const mspringi_direct *d = &n->direct;
    const size_t whole = d->place_count / MSPRINGI_WIDTH, rest = d->place_count % MSPRINGI_WIDTH;
    for (size_t block = 0; block < whole + (rest > 0); ++block) {
        const float *pull_x = factors_of_block(n, block), *pull_y = pull_x + MSPRINGI_WIDTH;
        const float *geometric = pull_y + MSPRINGI_WIDTH;
        float *restrict xx = d->edges.xx + block * MSPRINGI_WIDTH;
        float *restrict xy = d->edges.xy + block * MSPRINGI_WIDTH;
        float *restrict yy = d->edges.yy + block * MSPRINGI_WIDTH;
        const size_t count = block < whole ? MSPRINGI_WIDTH : rest;
        for (size_t i = 0; i < count; ++i) {
            xx[i] = -(geometric[i] + pull_x[i] * pull_x[i]);
            xy[i] = -(pull_x[i] * pull_y[i]);
            yy[i] = -(geometric[i] + pull_y[i] * pull_y[i]);
        }
    }
}

static bool solve_in_single(mspring_network *network) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_system *s = &n->system;
    fill_edges(n);
    const mspringi_blocks_float e = n->direct.edges;
    const mspringi_cholesky_matrix_float matrix = {s->xx, s->xy, s->yy, e.xx, e.xy, e.yy};
    memcpy(n->displacement.x, n->residual.x, 2 * mspringi_slot_count(network) * sizeof *n->displacement.x);
    return mspringi_cholesky_float_factor_solve(&n->direct.single, &matrix, n->displacement.x, n->displacement.y) ==
           MSPRING_NONE;
}

static void solve_more_in_single(const mspring_network *network, double *x, double *y) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    const size_t slots = mspringi_slot_count(network);
    for (size_t i = 0; i < slots; ++i) {
        n->scaled.x[i] = (float)x[i];
        n->scaled.y[i] = (float)y[i];
    }
    mspringi_cholesky_float_solve(&n->direct.single, n->scaled.x, n->scaled.y);
    for (size_t i = 0; i < slots; ++i) {
        x[i] = (double)n->scaled.x[i];
        y[i] = (double)n->scaled.y[i];
    }
}

static void add_constraints_in_single(mspring_network *network) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const size_t slots = mspringi_slot_count(network);
    double *const x = n->direct.solution, *const y = x + slots + 1;
    for (size_t i = 0; i < slots; ++i) {
        x[i] = (double)n->displacement.x[i];
        y[i] = (double)n->displacement.y[i];
    }
    mspringi_direct_solve_constraints(network, solve_more_in_single, x, y);
    for (size_t i = 0; i < slots; ++i) {
        n->displacement.x[i] = (float)x[i];
        n->displacement.y[i] = (float)y[i];
    }
    // The direct solver has no tiles that would turn what is predicted.
    memset(n->scaled.x, 0, 2 * slots * sizeof *n->scaled.x);
}

/* ------------------------------------------------------------------------------------------- double precision */

// As mspringi_edges_fn, whatever the springs of a block join.
static void add_any_edges(const mspringi_implicit *n, uint32_t first) {
    const mspringi_direct *d = &n->direct;
    const mspringi_blocks_double node = d->nodes_twice, edge = d->edges_twice;
    const uint32_t rest = d->place_count - first, count = rest < MSPRINGI_WIDTH ? rest : MSPRINGI_WIDTH;
    for (uint32_t spring_slot = first; spring_slot < first + count; ++spring_slot) {
        const uint32_t a = d->end_a[spring_slot], b = d->end_b[spring_slot];
        const float *f = factors_of_block(n, spring_slot / MSPRINGI_WIDTH) + spring_slot % MSPRINGI_WIDTH;
        const double pull_x = (double)f[MSPRINGI_PULL_X * MSPRINGI_WIDTH];
        const double pull_y = (double)f[MSPRINGI_PULL_Y * MSPRINGI_WIDTH];
        const double geometric = (double)f[MSPRINGI_GEOMETRIC * MSPRINGI_WIDTH];
        const double xx = geometric + pull_x * pull_x, xy = pull_x * pull_y, yy = geometric + pull_y * pull_y;
        edge.xx[spring_slot] = -xx;
        edge.xy[spring_slot] = -xy;
        edge.yy[spring_slot] = -yy;
        node.xx[a] += xx;
        node.xy[a] += xy;
        node.yy[a] += yy;
        node.xx[b] += xx;
        node.xy[b] += xy;
        node.yy[b] += yy;
    }
}

// All blocks, from the springs' factors: sums in single precision would not be positive definite.
static void fill_twice(const mspring_network *network, double added) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_direct *d = &n->direct;
    const size_t slots = mspringi_slot_count(network);
    const mspringi_blocks_double node = d->nodes_twice;
    memset(node.xx, 0, 3 * (slots + 1 + MSPRINGI_WIDTH) * sizeof *node.xx);
    for (size_t block = 0; block < block_count(d); ++block) {
        const size_t first = block * MSPRINGI_WIDTH;
        const mspringi_edge_block *edges = &d->edge_blocks[block];
        const mspringi_blocks_double to = {d->edges_twice.xx + first, d->edges_twice.xy + first,
                                           d->edges_twice.yy + first};
        if (edges->lanes == 0)
            continue;
        if (edges->base != edges->tip)
            network->kernels->system.add_edges(edges, factors_of_block(n, block), &to, &node);
        else
            add_any_edges(n, (uint32_t)first);
    }
    mspringi_constraints_add_nodes(&network->constraints, node.xx, node.xy, node.yy);
    for (size_t i = 0; i < slots; ++i) {
        const double mass = n->mass[i] > 0.0f ? (double)n->mass[i] : PINNED_MASS;
        const double on_top = mass + added * (node.xx[i] + node.yy[i]);
        node.xx[i] += on_top;
        node.yy[i] += on_top;
    }
}

static void solve_more_in_double(const mspring_network *network, double *x, double *y) {
    mspringi_cholesky_double_solve(&mspringi_implicit_of(network)->direct.twice, x, y);
}

static bool solve_in_double(mspring_network *network) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    mspringi_direct *d = &n->direct;
    const size_t slots = mspringi_slot_count(network);
    const mspringi_cholesky_matrix_double matrix = {d->nodes_twice.xx, d->nodes_twice.xy, d->nodes_twice.yy,
                                                    d->edges_twice.xx, d->edges_twice.xy, d->edges_twice.yy};
    double *const x = d->solution, *const y = x + slots + 1;
    for (size_t i = 0; i < slots; ++i) {
        x[i] = (double)n->residual.x[i];
        y[i] = (double)n->residual.y[i];
    }
    for (double added = 0.0; added <= MOST_ADDED; added = added > 0.0 ? 64.0 * added : LEAST_ADDED) {
        fill_twice(network, added);
        if (mspringi_cholesky_double_factor_solve(&d->twice, &matrix, x, y) != MSPRING_NONE)
            continue;
        mspringi_direct_solve_constraints(network, solve_more_in_double, x, y);
        for (size_t i = 0; i < slots; ++i) {
            n->displacement.x[i] = (float)x[i];
            n->displacement.y[i] = (float)y[i];
        }
        return true;
    }
    return false;
}

/* --------------------------------------------------------------------------------------------------- the whole */

static void hold_pinned(const mspringi_implicit *n, size_t slots) {
    for (size_t i = 0; i < slots; ++i) {
        n->displacement.x[i] = n->mass[i] > 0.0f ? n->displacement.x[i] : 0.0f;
        n->displacement.y[i] = n->mass[i] > 0.0f ? n->displacement.y[i] : 0.0f;
    }
}

void mspringi_direct_solve(mspring_network *network) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const size_t slots = mspringi_slot_count(network);
    const bool is_soft = finish_diagonal(&n->system, slots);
    // Without elements particles go far, and nearly all of that is taken back.
    const bool in_single = is_soft && network->constraints.element_count == 0 && solve_in_single(network);
    if (!in_single && !solve_in_double(network)) {
        // Numbers overflowed: see to it that the step is refused.
        mspring_id named = 0;
        while (!mspringi_particle_exists(network, named))
            ++named;
        n->x[network->topology.slot_of_particle[named]] = NAN;
        return;
    }
    hold_pinned(n, slots);
    if (in_single && (n->has_touched || mspringi_contact_constraint_is_active(&network->constraints)))
        add_constraints_in_single(network);
}

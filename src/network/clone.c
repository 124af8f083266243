/// A copy of a network: all its blocks of memory, and then every pointer from one block into another.
///
/// Those of the network itself are in store/network.def, those of its topologies, floor and solvers here. One that
/// is forgotten leads back into the original, which test_clone finds by looking at every word of a clone.
#include "contact/floor.h"
#include "implicit/implicit.h"
#include "network.h"
#include "store/store.h"

/// The original's memory and the copy's.
typedef struct moving {
    const mspringi_memory *from, *to;
} moving;

/// Have a pointer that was copied lead to where what it points to was copied to.
#define MOVE(pointer) ((pointer) = mspringi_memory_moved(m->from, m->to, (pointer)))

static void move_field(const moving *m, mspringi_field *field) {
    MOVE(field->x);
    MOVE(field->y);
}

static void move_state(const moving *m, mspringi_state *state) {
    MOVE(state->x);
    MOVE(state->y);
    MOVE(state->vx);
    MOVE(state->vy);
    MOVE(state->low_x);
    MOVE(state->low_y);
}

static void move_topology(const moving *m, mspringi_topology *t) {
    MOVE(t->slot_of_particle);
    MOVE(t->particle_of_slot);
    MOVE(t->places.runs);
    MOVE(t->places.run_of_page);
    MOVE(t->places.listed);
    MOVE(t->up_of_block);
    MOVE(t->grid_of_row);
    MOVE(t->empty_runs);
    MOVE(t->leftover_a);
    MOVE(t->leftover_b);
    MOVE(t->laid_slots);
    MOVE(t->laid_places);
    MOVE(t->web.attached_slot);
    MOVE(t->web.first_rung);
    MOVE(t->web.neighbour);
    MOVE(t->web.entry);
    MOVE(t->web.is_upright);
    MOVE(t->web.is_read);
    MOVE(t->spans);
    MOVE(t->tight_spans);
    MOVE(t->first_tight);
    MOVE(t->rows);
    MOVE(t->strips);
    MOVE(t->layer_blocks);
}

/* --------------------------------------------------------------------------------------------- implicit solver */

static void move_history(const moving *m, mspringi_history *history) {
    move_field(m, &history->first);
    move_field(m, &history->second);
}

static void move_tiles(const moving *m, mspringi_tiles *tiles) {
    mspringi_cells *cells = &tiles->cells;
    MOVE(cells->of_slot);
    MOVE(cells->first_slot);
    MOVE(cells->slots);
    MOVE(cells->first_inner);
    MOVE(cells->inner);
    MOVE(cells->joints);
    MOVE(cells->first_joint);
    MOVE(cells->lowest);
    MOVE(tiles->first_part);
    MOVE(tiles->parts);
    MOVE(tiles->parts_by_slot);
    MOVE(tiles->first_by_slot);
    MOVE(tiles->of_slot);
    MOVE(tiles->first_of_cell);
    MOVE(tiles->parent);
    MOVE(tiles->anchors);
    MOVE(tiles->dirty);
    MOVE(tiles->is_dirty);
}

static void move_system(const moving *m, mspringi_system *system) {
    MOVE(system->x);
    MOVE(system->y);
    MOVE(system->vx);
    MOVE(system->vy);
    MOVE(system->lattice_springs);
    MOVE(system->rest_lengths);
    MOVE(system->chain_springs);
    MOVE(system->rests_of_block);
    MOVE(system->mass);
    MOVE(system->lattice_factors);
    MOVE(system->chain_factors);
    MOVE(system->force_x);
    MOVE(system->force_y);
    MOVE(system->xx);
    MOVE(system->xy);
    MOVE(system->yy);
    MOVE(system->force_carry_x);
    MOVE(system->force_carry_y);
    MOVE(system->carry_xx);
    MOVE(system->carry_xy);
    MOVE(system->carry_yy);
}

static void move_iterate(const moving *m, mspringi_iterate *iterate) {
    MOVE(iterate->solution_x);
    MOVE(iterate->solution_y);
    MOVE(iterate->residual_x);
    MOVE(iterate->residual_y);
    MOVE(iterate->scaled_x);
    MOVE(iterate->scaled_y);
    MOVE(iterate->direction_x);
    MOVE(iterate->direction_y);
    MOVE(iterate->product_x);
    MOVE(iterate->product_y);
    MOVE(iterate->arm_x);
    MOVE(iterate->arm_y);
}

#define DEFINE_MOVE_FACTOR(real)                                                                                   \
    static void move_factor_##real(const moving *m, mspringi_cholesky_##real *factor) {                            \
        MOVE(factor->plan);                                                                                        \
        MOVE(factor->panels);                                                                                      \
        MOVE(factor->reciprocal);                                                                                  \
        MOVE(factor->updates[0]);                                                                                  \
        MOVE(factor->updates[1]);                                                                                  \
        MOVE(factor->scaled);                                                                                      \
        MOVE(factor->vector);                                                                                      \
        MOVE(factor->part);                                                                                        \
    }
DEFINE_MOVE_FACTOR(float)
DEFINE_MOVE_FACTOR(double)

static void move_direct(const moving *m, mspringi_direct *direct) {
    MOVE(direct->end_a);
    MOVE(direct->end_b);
    MOVE(direct->edge_blocks);
    MOVE(direct->plan.order);
    MOVE(direct->plan.band_entries);
    MOVE(direct->plan.fronts);
    MOVE(direct->plan.children);
    MOVE(direct->plan.border);
    MOVE(direct->plan.runs);
    MOVE(direct->plan.entries);
    move_factor_float(m, &direct->single);
    move_factor_double(m, &direct->twice);
    MOVE(direct->edges.xx);
    MOVE(direct->edges.xy);
    MOVE(direct->edges.yy);
    MOVE(direct->edges_twice.xx);
    MOVE(direct->edges_twice.xy);
    MOVE(direct->edges_twice.yy);
    MOVE(direct->nodes_twice.xx);
    MOVE(direct->nodes_twice.xy);
    MOVE(direct->nodes_twice.yy);
    MOVE(direct->solution);
}

static void move_implicit(const moving *m, mspringi_implicit *n) {
    mspringi_field *const fields[] = {&n->velocity, &n->residual, &n->displacement, &n->direction,
                                      &n->product,  &n->scaled,   &n->arm};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i)
        move_field(m, fields[i]);
    move_history(m, &n->history);
    move_history(m, &n->backup);
    move_history(m, &n->previous);
    MOVE(n->x);
    MOVE(n->y);
    MOVE(n->mass);
    MOVE(n->diagonal);
    MOVE(n->factors);
    MOVE(n->leftover_factors);
    MOVE(n->force_carry);
    MOVE(n->carry);
    MOVE(n->sums);
    MOVE(n->flights);
    MOVE(n->is_solved);
    MOVE(n->panels.list);
    MOVE(n->panels.sums);
    MOVE(n->budget.accounts);
    MOVE(n->budget.of_slot);
    MOVE(n->budget.of_block);
    MOVE(n->budget.of_springs);
    MOVE(n->budget.pins);
    MOVE(n->budget.state);
    move_field(m, &n->budget.impulse);
    MOVE(n->budget.runs);
    MOVE(n->budget.elastic);
    move_system(m, &n->system);
    move_iterate(m, &n->iterate);
    MOVE(n->seen.link_log);
    move_direct(m, &n->direct);
    move_tiles(m, &n->tiles);
    MOVE(n->coarse.first);
    MOVE(n->coarse.row);
    MOVE(n->coarse.values);
    MOVE(n->coarse.kept);
    MOVE(n->unknowns);
    MOVE(n->coarse.restricted);
    MOVE(n->coarse.far_turns);
}

/* ------------------------------------------------------------------------------------------------- the network */

static void move_floor(const moving *m, mspringi_floor *floor) {
    MOVE(floor->heights.heights);
    MOVE(floor->heights.normals);
    for (uint32_t i = 0; i < MSPRINGI_HEIGHT_LEVELS; ++i)
        MOVE(floor->heights.highest[i]);
    MOVE(floor->clearances);
    MOVE(floor->contacts);
    move_field(m, &floor->start);
    move_state(m, &floor->before);
    move_field(m, &floor->impulse);
    move_field(m, &floor->former);
}

static void move_network(const moving *m, mspring_network *n) {
    move_topology(m, &n->topology);
    move_topology(m, &n->whole);
    mspringi_store_relocate(n, m->from, m->to);
    for (size_t i = 0; i < n->hook_count; ++i)
        move_field(m, &n->hooks[i].held);
    MOVE(n->floor);
    if (n->floor)
        move_floor(m, n->floor);
    MOVE(n->implicit);
    if (n->implicit)
        move_implicit(m, n->implicit);
    MOVE(n->fallback);
    if (n->fallback)
        move_implicit(m, n->fallback);
}

/* ---------------------------------------------------------------------------------------------------- the clone */

static void drop_hooks(mspring_network *network) {
    for (size_t i = 0; i < network->hook_count; ++i)
        mspringi_free(&network->memory, network->hooks[i].held.x);
    network->hook_count = 0;
}

static bool has_hook_with_storage(const mspring_network *network) {
    for (size_t i = 0; i < network->hook_count; ++i)
        if (network->hooks[i].def.storage)
            return true;
    return false;
}

// Give a copy threads of its own, and what they work in.
static mspring_result employ(mspring_network *network, const mspring_clone_def *def) {
    mspring_result result = mspringi_tasks_create(def->worker_count, def->tasks, &network->tasks_memory,
                                                  &network->message, &network->tasks);
    if (result == MSPRING_OK)
        result = mspringi_carry_reserve(network);
    return result == MSPRING_OK ? mspringi_implicit_reserve(network) : result;
}

static mspring_result copy(const mspring_network *network, const mspring_clone_def *def,
                           const mspring_allocator *allocator, mspring_network **clone) {
    mspringi_memory memory = {.allocator = *allocator};
    mspring_network *made = NULL;
    if (mspringi_memory_copy(&network->memory, &memory))
        made = mspringi_memory_moved(&network->memory, &memory, network);
    if (!made) {
        mspringi_free_all(&memory);
        return MSPRING_ERROR_MEMORY;
    }
    made->memory = memory;
    made->tasks_memory = made->plan_memory = (mspringi_memory){.allocator = *allocator};
    made->tasks = NULL;
    made->replan = NULL;
    made->mover = NULL;
    made->message = (mspringi_message){0};
    move_network(&(moving){&network->memory, &made->memory}, made);
    if (!(def->flags & MSPRING_CLONE_HOOKS))
        drop_hooks(made);
    mspring_result result = employ(made, def);
    if (result == MSPRING_OK)
        *clone = made;
    else
        mspring_network_destroy(made);
    return result;
}

mspring_result mspring_network_clone(const mspring_network *network, const mspring_clone_def *def,
                                     mspring_network **clone) {
    mspring_clone_def defaults;
    if (!network || !clone)
        return MSPRING_ERROR_ARGUMENT;
    if (network->in_hook != MSPRINGI_IN_NO_HOOK)
        return MSPRING_ERROR_BUSY;
    if (!def) {
        (void)mspring_clone_def_init(&defaults, sizeof defaults);
        def = &defaults;
    }
    if (def->struct_size != sizeof *def)
        return MSPRING_ERROR_STRUCT;
    if (def->flags & ~(uint32_t)MSPRING_CLONE_HOOKS || def->reserved != 0)
        return MSPRING_ERROR_ARGUMENT;
    const uint32_t workers = def->tasks ? def->tasks->worker_count : def->worker_count;
    if (def->flags & MSPRING_CLONE_HOOKS && workers > mspringi_tasks_workers(network->tasks) &&
        has_hook_with_storage(network))
        return MSPRING_ERROR_ARGUMENT;
    mspringi_memory memory = network->memory;
    mspringi_message message;
    if (def->allocator) {
        mspring_result result = mspringi_memory_init(&memory, def->allocator, &message);
        if (result != MSPRING_OK)
            return result;
    }
    return copy(network, def, &memory.allocator, clone);
}

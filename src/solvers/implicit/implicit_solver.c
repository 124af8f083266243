/// Solver tables: implicit and direct. They differ in the solution of the linear system.
#include <math.h>

#include "features/contact/floor.h"
#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"
#include "store/sections.h"

static mspring_result create(mspring_network *network, const mspring_settings *def, uint32_t tile_size,
                             void **object) {
    mspringi_implicit *made = NULL;
    mspring_result result = mspringi_implicit_begin(network, def, tile_size, &made);
    *object = made;
    return result;
}

static mspring_result build(void *object, bool *is_done) {
    return mspringi_implicit_make(object, is_done);
}

static bool fits(const void *object, const mspring_settings *def) {
    const mspringi_implicit *n = object;
    return n->integrator == def->integrator && (n->is_direct || n->tile_size == def->tile_size);
}

static void adjust(void *object, const mspring_settings *def) {
    mspringi_implicit_adjust(object, def);
}

static void destroy(void *object, mspringi_memory *memory) {
    mspringi_implicit_destroy(object, memory);
}

static void relocate(void *object, const mspring_network *network, const mspringi_memory *from,
                     const mspringi_memory *to) {
    mspringi_implicit_relocate(object, network, from, to);
}

static mspring_result reserve(void *object, mspring_network *network) {
    return mspringi_implicit_reserve(object, network);
}

/* ----------------------------------------------------------------------------------------------- another layout */

static void get_def(const void *object, mspring_settings *def) {
    const mspringi_implicit *n = object;
    (void)mspring_init(MSPRING_STRUCT_SETTINGS, def, sizeof *def);
    def->solver = n->is_direct ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT;
    def->integrator = n->integrator;
    def->iterations = n->iterations;
    def->residual = n->residual_share;
    def->tile_size = n->tile_size;
    def->coarse_period = n->coarse_period;
}

static mspringi_solver_basis get_basis(const void *object) {
    const mspringi_implicit *n = object;
    return (mspringi_solver_basis){n->scale, n->tiles.turn_inertia, n->tiles.cells.size};
}

static void set_basis(void *object, const mspring_network *network, const mspringi_solver_basis *basis) {
    mspringi_implicit *n = object;
    n->scale = basis->scale;
    if (!n->is_direct)
        mspringi_tiles_set_inertia(&n->tiles, basis->turn_inertia, mspringi_slot_count(network));
}

// A motion goes on: what the integrator remembers of it goes with the particles.
static void take_over(const mspring_network *to, void *object, const mspring_network *from, const void *before) {
    const uint32_t *here = from->topology.slot_of_particle, *there = to->topology.slot_of_particle;
    const size_t slots = mspringi_slot_count(from), made_slots = mspringi_slot_count(to);
    const mspringi_solver_basis basis = get_basis(before);
    const mspringi_implicit *had = before;
    mspringi_implicit *n = object;
    MSPRINGI_ASSERT(to->topology.particle_count == from->topology.particle_count);
    set_basis(n, to, &basis);
    n->history.h = had->history.h;
    n->history.restarts = had->history.restarts;
    n->seen.motion = had->seen.motion;
    for (size_t i = 0; i < had->history_size / slots; ++i)
        for (mspring_id p = 0; p < from->topology.particle_count; ++p)
            n->history.first.x[i * made_slots + there[p]] = had->history.first.x[i * slots + here[p]];
}

/* ------------------------------------------------------------------------------------------------------ a step */

static void substeps(mspring_network *network, void *object, float h, mspringi_field base, uint32_t count) {
    (void)object;
    mspringi_implicit_run_substeps(network, h, base, count);
}

static double calm_work(const void *object) {
    return mspringi_implicit_calm_work(object);
}

static void allow_work(void *object, double rate) {
    mspringi_implicit_allow_work(object, rate);
}

static double count_work(const void *object, bool *is_spent) {
    const mspringi_implicit *n = object;
    *is_spent = n->is_spent;
    return mspringi_implicit_work(n);
}

static void keep(void *object) {
    mspringi_implicit_keep(object);
}

static void restore(mspring_network *network, void *object) {
    mspringi_implicit_restore(network, object);
}

static void forget(void *object) {
    mspringi_implicit_forget(object);
}

static bool is_finite(const void *object) {
    const mspringi_implicit *n = object;
    bool finite = isfinite(n->scale) && isfinite(n->history.h);
    for (size_t i = 0; finite && i < n->history_size; ++i)
        finite = isfinite(n->history.first.x[i]);
    for (size_t i = 0; finite && n->age > 0 && i < n->coarse.value_count; ++i)
        finite = isfinite(n->coarse.values[i]);
    return finite;
}

/* ------------------------------------------------------------------------------------------------------- edits */

// As if it had fallen freely: forces that it holds act no more. With BDF2 a parabola is
// x - x(t-h) = h v - h^2 g / 2. Implicit Euler writes no history, so a value would stay in one of three buffers.
static void clear_slot(const mspring_network *network, void *object, uint32_t slot) {
    mspringi_implicit *n = object;
    const bool two = n->integrator == MSPRING_INTEGRATOR_BDF2, falls = network->inverse_mass[slot] > 0.0f;
    if (n->integrator == MSPRING_INTEGRATOR_EULER)
        return;
    const float h = n->history.h, share = two ? -0.5f * h * h : 1.0f;
    n->history.first.x[slot] = falls ? share * network->settings.gravity_x : 0.0f;
    n->history.first.y[slot] = falls ? share * network->settings.gravity_y : 0.0f;
    if (!n->history.second.x)
        return;
    n->history.second.x[slot] = falls ? h * network->settings.gravity_x : 0.0f;
    n->history.second.y[slot] = falls ? h * network->settings.gravity_y : 0.0f;
}

static void rest_slot(const mspring_network *network, void *object, size_t slot) {
    const mspringi_implicit *n = object;
    const size_t slots = mspringi_slot_count(network);
    for (size_t i = 0; i < n->history_size; i += slots)
        n->history.first.x[i + slot] = n->backup.first.x[i + slot] = n->previous.first.x[i + slot] = 0.0f;
}

// Clear the factors of an irregular spring slot that no spring uses any more.
static void clear_spring(const mspring_network *network, void *object, mspringi_spring_slot spring_slot) {
    const mspringi_implicit *n = object;
    for (uint32_t factor = 0; spring_slot >= network->topology.row_spring_slots && factor < MSPRINGI_FACTORS;
         ++factor)
        n->factors[mspringi_factors_of_spring_slot(spring_slot) + factor * MSPRINGI_WIDTH] = 0.0f;
}

// The coarse matrix may have contacts with the floor that was.
static void new_floor(void *object) {
    mspringi_implicit *n = object;
    n->age = 0;
}

static bool is_isolated(const mspring_network *network, const void *object, size_t slot) {
    const mspringi_implicit *n = object;
    if (mspringi_implicit_contact_has(network, slot))
        return false;
    if (slot < (size_t)network->topology.loose_first * MSPRINGI_WIDTH)
        return mspringi_budget_is_isolated(&n->budget, slot);
    return *mspringi_coupling_of(network, n, slot) != MSPRINGI_COUPLED_BY_SPRINGS;
}

static bool has_isolated(const void *object) {
    const mspringi_implicit *n = object;
    return n->budget.has_isolated;
}

/* ------------------------------------------------------------------------------------------------------- others */

static void describe(const void *object, mspringi_plan *plan) {
    const mspringi_implicit *n = object;
    plan->solver = n->is_direct ? MSPRING_SOLVER_DIRECT : MSPRING_SOLVER_IMPLICIT;
    plan->integrator = n->integrator;
    plan->factor_values = n->direct.plan.panel_reals;
    plan->factor_products = n->direct.plan.multiply_adds;
    if (n->is_direct)
        return;
    plan->iterations = n->iterations;
    plan->residual = n->residual_share;
    plan->tile_size = n->tiles.cells.size;
    plan->tile_count = n->tiles.count;
    plan->coarse_values = (uint32_t)(n->coarse.value_count < UINT32_MAX ? n->coarse.value_count : UINT32_MAX);
    plan->coarse_period = n->coarse_period;
}

static void save(const mspring_network *network, const void *object, struct mspringi_writer *to) {
    mspringi_implicit_save(network, object, to);
}

static mspring_result check(mspring_network *network, const void *object, const uint8_t *from, size_t bytes) {
    return mspringi_implicit_check(network, object, from, bytes);
}

static void load(mspring_network *network, void *object, const uint8_t *from, size_t bytes) {
    mspringi_implicit_load(network, object, from, bytes);
}

static uint32_t runs(const mspring_network *network, const void *object, struct mspringi_io head,
                     struct mspringi_run *list) {
    return mspringi_implicit_runs(network, object, head, list);
}

static size_t enter(const mspring_network *network, const void *object, uint8_t *section, size_t size) {
    return mspringi_implicit_enter(network, object, section, size);
}

#define BOTH                                                                                                       \
    .takes_one_substep = true, .has_implicit_grips = true, .has_implicit_contact = true,                           \
    .has_implicit_areas = true, .create = create, .build = build, .fits = fits, .adjust = adjust,                  \
    .destroy = destroy, .relocate = relocate, .reserve = reserve, .get_def = get_def, .take_over = take_over,      \
    .get_basis = get_basis, .set_basis = set_basis, .substeps = substeps, .calm_work = calm_work,                  \
    .allow_work = allow_work, .count_work = count_work, .keep = keep, .restore = restore, .forget = forget,        \
    .is_finite = is_finite, .clear_slot = clear_slot, .rest_slot = rest_slot, .clear_spring = clear_spring,        \
    .new_floor = new_floor, .is_isolated = is_isolated, .has_isolated = has_isolated, .describe = describe,        \
    .save = save, .check = check, .load = load, .runs = runs, .leave = mspringi_implicit_leave, .enter = enter

const mspringi_solver_ops mspringi_implicit_ops = {.can_add = true, BOTH};

// It has found an order of elimination for the springs that there were.
const mspringi_solver_ops mspringi_direct_ops = {.can_add = false, BOTH};

/// mspring_network_settle(): converts a network to a problem of statics and back.
#include <float.h>
#include <math.h>

#include "analysis/settle/equilibrium.h"
#include "base/cpu.h"
#include "base/union_find.h"
#include "step/origin.h"
#include "store/changed.h"
#include "store/network.h"
#include "store/springs.h"

/* ----------------------------------------------------------------------------------------------------- filling */

static uint32_t count_springs(const mspring_network *network) {
    uint32_t count = 0;
    for (mspring_id spring = 0; spring < network->topology.spring_count; ++spring)
        count += mspringi_spring_get(network, spring).stiffness > 0.0f;
    return count;
}

static void fill_particles(mspringi_statics *statics, const mspring_network *network) {
    const mspringi_forces *forces = &network->forces;
    for (mspring_id p = 0; p < statics->particle_count; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        const double inverse_mass = (double)network->inverse_mass[slot];
        statics->fixed[p] = !(inverse_mass > 0.0);
        statics->start.x[p] = mspringi_x_of(&network->state, slot);
        statics->start.y[p] = mspringi_y_of(&network->state, slot);
        if (statics->fixed[p])
            continue;
        // In equilibrium a step leaves the velocity unchanged: force * inverse_mass + gravity = 0.
        statics->outside.x[p] = (double)network->settings.gravity_x / inverse_mass;
        statics->outside.y[p] = (double)network->settings.gravity_y / inverse_mass;
        if (forces->held_any) {
            statics->outside.x[p] += (double)forces->held.x[slot];
            statics->outside.y[p] += (double)forces->held.y[slot];
        }
    }
}

static void fill_springs(mspringi_statics *statics, const mspring_network *network) {
    mspringi_statics_springs *s = &statics->springs;
    for (mspring_id spring = 0; spring < network->topology.spring_count; ++spring) {
        const mspringi_spring_values values = mspringi_spring_get(network, spring);
        if (!(values.stiffness > 0.0f))
            continue;
        const uint32_t i = s->count++;
        s->edge_count = s->count;
        const uint32_t a = s->a[i] = network->topology.particle_of_slot[values.base];
        const uint32_t b = s->b[i] = network->topology.particle_of_slot[values.tip];
        s->stiffness[i] = (double)values.stiffness;
        s->rest_length[i] = (double)mspringi_read_length(values.rest_length);
        s->side[i] = (double)mspringi_side_of(network, spring);
        s->x[i] = statics->start.x[b] - statics->start.x[a];
        s->y[i] = statics->start.y[b] - statics->start.y[a];
    }
}

/* -------------------------------------------------------------------------------------------- floating parts */

/// Component of the springs, identified by its root.
typedef struct component {
    double x, y, size; ///< sum of the external forces, and of their absolute values
    uint32_t lowest;   ///< lowest particle
    bool is_held;      ///< has a pinned particle
} component;

static void join_components(const mspringi_statics *statics, uint32_t *up) {
    for (uint32_t p = 0; p < statics->particle_count; ++p)
        up[p] = p;
    for (uint32_t i = 0; i < statics->springs.edge_count; ++i)
        mspringi_union_find_join(up, statics->springs.a[i], statics->springs.b[i]);
}

static void sum_components(const mspringi_statics *statics, uint32_t *up, component *components) {
    for (uint32_t p = 0; p < statics->particle_count; ++p) {
        component *of = &components[mspringi_union_find_root(up, p)];
        of->x += statics->outside.x[p];
        of->y += statics->outside.y[p];
        of->size += fabs(statics->outside.x[p]) + fabs(statics->outside.y[p]);
        of->is_held = of->is_held || statics->fixed[p];
    }
}

// True if the forces on a component without pinned particles do not cancel to a millionth. Rounding of many floats
// stays below that.
static bool is_unbalanced(const component *of) {
    return !of->is_held && fabs(of->x) + fabs(of->y) > 1e-6 * of->size;
}

// Fix floating components, or return an error.
static mspring_result check_floating(mspringi_statics *statics, const mspring_settle_def *def, uint32_t *left_alone,
                                     mspring_network *network) {
    uint32_t *up = mspringi_alloc(&network->memory, statics->particle_count, sizeof *up);
    component *components = mspringi_alloc(&network->memory, statics->particle_count, sizeof *components);
    mspring_result result = MSPRING_OK;
    if (!up || !components) {
        result = mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                               "no memory for the components of %u particles", (unsigned)statics->particle_count);
    } else {
        join_components(statics, up);
        sum_components(statics, up, components);
        *left_alone = 0;
        for (uint32_t p = 0; p < statics->particle_count && result == MSPRING_OK; ++p) {
            const uint32_t lowest = mspringi_union_find_root(up, p);
            if (!is_unbalanced(&components[lowest]))
                continue;
            if (def->flags & MSPRING_SETTLE_LEAVE_FLOATING) {
                statics->fixed[p] = true;
                ++*left_alone;
            } else {
                result = mspringi_fail(&network->message, MSPRING_ERROR_EQUILIBRIUM,
                                       "no equilibrium: particle %u is connected to no pinned particle, and "
                                       "(%g, %g) N act on its component. Pin one, or set "
                                       "MSPRING_SETTLE_LEAVE_FLOATING",
                                       (unsigned)p, components[lowest].x, components[lowest].y);
            }
        }
    }
    mspringi_free(&network->memory, up);
    mspringi_free(&network->memory, components);
    return result;
}

/* ----------------------------------------------------------------------------------------------------- settling */

// Extent of the network, m: the larger side of its box, or its longest spring.
static double extent_of(const mspringi_statics *statics, const mspring_network *network) {
    double extent = 0.0;
    mspringi_box box = mspringi_box_empty();
    for (uint32_t p = 0; p < statics->particle_count; ++p)
        if (mspringi_particle_exists(network, p))
            mspringi_box_include(&box, statics->start.x[p], statics->start.y[p]);
    for (uint32_t i = 0; i < statics->springs.count; ++i)
        extent = fmax(extent, statics->springs.rest_length[i]);
    return fmax(extent, fmax(box.max_x - box.min_x, box.max_y - box.min_y));
}

/// Largest strain that counts as elastic, relative to the yield strain: springs at the limit may round above it.
#define TOLERATED_YIELD (1.0 + 1e-5)

static mspring_result check_equilibrium(const mspringi_statics *statics, const mspringi_equilibrium *equilibrium,
                                        mspring_network *network) {
    if (!equilibrium->found)
        return mspringi_fail(
            &network->message, MSPRING_ERROR_EQUILIBRIUM,
            "no equilibrium after %u iterations: particle %u is still pulled by %g N (largest force: "
            "%g N). Step with global_damping first",
            (unsigned)equilibrium->iterations, (unsigned)equilibrium->residual.where, equilibrium->residual.force,
            equilibrium->residual.scale);
    for (uint32_t p = 0; p < statics->particle_count; ++p) {
        const double x = statics->start.x[p] + statics->moved.x[p], y = statics->start.y[p] + statics->moved.y[p];
        if (!(fabs(x) <= MSPRING_MAX_COORDINATE && fabs(y) <= MSPRING_MAX_COORDINATE))
            return mspringi_fail(&network->message, MSPRING_ERROR_EQUILIBRIUM,
                                 "no equilibrium within 1e12 m: particle %u would rest at (%g, %g) m", (unsigned)p,
                                 network->origin_x + x, network->origin_y + y);
    }
    return MSPRING_OK;
}

// Check that no spring would yield: the search treats all as elastic, and plastic flow leads to another
// equilibrium.
static mspring_result check_yields(const mspringi_statics *statics, mspring_network *network) {
    const mspringi_tested *p = &network->tested;
    for (mspring_id spring = 0; p->yields && spring < network->topology.spring_count; ++spring) {
        const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, spring);
        const mspringi_spring_values values = mspringi_spring_slot_get(network, spring_slot);
        if (!(values.stiffness > 0.0f))
            continue;
        const uint32_t a = network->topology.particle_of_slot[values.base],
                       b = network->topology.particle_of_slot[values.tip];
        const double x = (statics->start.x[b] + statics->moved.x[b]) - (statics->start.x[a] + statics->moved.x[a]);
        const double y = (statics->start.y[b] + statics->moved.y[b]) - (statics->start.y[a] + statics->moved.y[a]);
        const double rest = (double)values.rest_length, nominal = (double)p->nominal[spring_slot];
        const double strain = (sqrt(x * x + y * y) - rest) / nominal,
                     hardened = (double)p->hardening[spring_slot] * (rest - nominal) / nominal;
        if (fabs(strain - hardened) > TOLERATED_YIELD * (double)p->yield_strain[spring_slot])
            return mspringi_fail(&network->message, MSPRING_ERROR_EQUILIBRIUM,
                                 "no elastic equilibrium: spring %u would have strain %g, but yields at %g. Step "
                                 "with global_damping instead",
                                 (unsigned)spring, strain, (double)p->yield_strain[spring_slot]);
    }
    return MSPRING_OK;
}

static double store_positions(const mspringi_statics *statics, mspring_network *network) {
    double farthest = 0.0;
    for (mspring_id p = 0; p < statics->particle_count; ++p) {
        if (statics->fixed[p])
            continue;
        const uint32_t slot = network->topology.slot_of_particle[p];
        const double dx = statics->moved.x[p], dy = statics->moved.y[p];
        mspringi_set_x(&network->state, slot, statics->start.x[p] + dx);
        mspringi_set_y(&network->state, slot, statics->start.y[p] + dy);
        network->state.vx[slot] = network->state.vy[slot] = 0.0f;
        farthest = fmax(farthest, sqrt(dx * dx + dy * dy));
    }
    mspringi_notify_change(network, MSPRINGI_CHANGED_STATE, 0);
    mspringi_origin_follow(network);
    return farthest;
}

static mspring_result solve(mspringi_statics *statics, mspring_network *network, const mspring_settle_def *def,
                            mspring_settle_result *out, mspringi_watcher watcher) {
    uint32_t left_alone = 0;
    const uint32_t edges = count_springs(network) + mspringi_statics_count_sides(network);
    if (!mspringi_statics_create(statics, network->topology.particle_count, edges, &network->memory))
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to settle %u particles",
                             (unsigned)network->topology.particle_count);
    statics->watcher = watcher;
    fill_particles(statics, network);
    fill_springs(statics, network);
    mspring_result result = mspringi_statics_add_elements(statics, network);
    if (result == MSPRING_OK)
        result = check_floating(statics, def, &left_alone, network);
    if (result == MSPRING_OK)
        result = mspringi_statics_prepare(statics, network->kernels->level, &network->memory, &network->message);
    if (result != MSPRING_OK)
        return result;
    const mspringi_equilibrium rest = mspringi_statics_find_equilibrium(
        statics, def->max_iterations, def->tolerance, extent_of(statics, network));
    result = check_equilibrium(statics, &rest, network);
    if (result == MSPRING_OK)
        result = check_yields(statics, network);
    if (result == MSPRING_OK)
        *out = (mspring_settle_result){
            .iterations = rest.iterations,
            .residual = rest.residual.force,
            .largest_force = rest.residual.scale,
            .displacement = store_positions(statics, network),
            .is_stable = rest.is_stable,
            .left_alone = left_alone,
        };
    return result;
}

static MSPRINGI_NOINLINE mspring_result settle(mspring_network *network, const mspring_settle_def *def,
                                               mspring_settle_result *out, mspringi_watcher watcher) {
    mspringi_statics statics = {0};
    const float relative_h = network->relative_h;
    if (def->relative_substep > 0.0)
        mspringi_derive_relative(network, (float)def->relative_substep);
    const mspring_result result = solve(&statics, network, def, out, watcher);
    if (result != MSPRING_OK)
        mspringi_derive_relative(network, relative_h);
    mspringi_statics_destroy(&statics, &network->memory);
    return result;
}

static mspring_result check_def(const mspring_settle_def **given, mspring_settle_def *def,
                                mspringi_message *message) {
    mspring_result result = mspringi_take_settle_def_or_defaults(message, given, def);
    if (result == MSPRING_OK)
        result = mspringi_check_reserved(message, "mspring_settle_def", def->reserved);
    if (result != MSPRING_OK)
        return result;
    if (def->flags & ~(uint32_t)MSPRING_SETTLE_LEAVE_FLOATING)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "flags of mspring_settle_def are 0x%x",
                             (unsigned)def->flags);
    if (def->max_iterations < 1 || def->max_iterations > 1000000)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "max_iterations is %u, it must be 1 to 1000000",
                             (unsigned)def->max_iterations);
    if (!(def->tolerance >= 1e-15 && def->tolerance <= 1.0))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "tolerance is %g, it must be 1e-15 to 1",
                             def->tolerance);
    if (def->relative_substep != 0.0 &&
        !(def->relative_substep >= (double)FLT_MIN && def->relative_substep <= (double)FLT_MAX))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "relative_substep is %g s, it must be 0 or a normal float > 0", def->relative_substep);
    return MSPRING_OK;
}

mspring_result mspring_network_settle(mspring_network *network, const mspring_settle_def *def,
                                      mspring_settle_result *result) {
    const mspringi_watcher nobody = {NULL, NULL};
    return mspringi_settle_watched(network, def, result, nobody);
}

mspring_result mspringi_settle_watched(mspring_network *network, const mspring_settle_def *def,
                                       mspring_settle_result *result, mspringi_watcher watcher) {
    mspring_settle_def taken;
    mspring_settle_result out;
    mspring_result outcome = mspringi_check_call(network);
    if (outcome == MSPRING_OK)
        outcome = check_def(&def, &taken, &network->message);
    if (outcome == MSPRING_OK && result)
        outcome = mspringi_check_output(&network->message, &mspringi_struct_settle_result, result);
    if (outcome != MSPRING_OK)
        return outcome;
    const mspringi_fp_state before = mspringi_fp_enter();
    outcome = settle(network, def, &out, watcher);
    mspringi_fp_leave(before);
    if (outcome == MSPRING_OK && result)
        mspringi_put_settle_result(result, &out);
    return outcome;
}

bool mspringi_can_settle(const mspring_network *network) {
    bool can = true;
    mspringi_element_walk walk = mspringi_walk_elements(network);
    while (can && mspringi_element_next(&walk))
        can = walk.element.is_ringed;
    return can;
}

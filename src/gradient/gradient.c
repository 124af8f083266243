/// Gradients: creation and reading.
#include "gradient/gradient.h"

#include "base/cpu.h"
#include "features/actuators/actuators.h"

/* ---------------------------------------------------------------------------------------------------------
 * creation */

static double *gradient_doubles(mspring_gradient *g, bool *is_made) {
    double *made = mspringi_alloc(&g->memory, g->lanes, sizeof *made);
    *is_made = *is_made && made;
    return made;
}

static mspringi_doubles gradient_vectors(mspring_gradient *g, bool *is_made) {
    const mspringi_doubles made = {gradient_doubles(g, is_made), gradient_doubles(g, is_made)};
    return made;
}

static bool make_adjoint(mspring_gradient *g, const mspring_view *view) {
    mspringi_adjoint *adjoint = &g->adjoint;
    bool is_made = true;
    adjoint->position = gradient_vectors(g, &is_made);
    adjoint->velocity = gradient_vectors(g, &is_made);
    adjoint->force = gradient_vectors(g, &is_made);
    adjoint->by_position = gradient_vectors(g, &is_made);
    if (g->octets.damping)
        adjoint->by_velocity = gradient_vectors(g, &is_made);
    for (int end = 0; end < 2 && g->plane_count > 0; ++end)
        g->spring_force[end] = gradient_vectors(g, &is_made);
    adjoint->inverse_mass = gradient_doubles(g, &is_made);
    adjoint->is_free = gradient_doubles(g, &is_made);
    for (uint32_t slot = 0; is_made && slot < g->slots; ++slot) {
        adjoint->inverse_mass[slot] = (double)view->inverse_mass[slot];
        adjoint->is_free[slot] = view->inverse_mass[slot] > 0.0f ? 1.0 : 0.0;
    }
    return is_made;
}

static bool make_records(mspring_gradient *g) {
    mspringi_memory *m = &g->memory;
    const size_t signals = (size_t)g->actuator_count * g->capacity, forces = (size_t)g->forced_count * 2;
    g->past = mspringi_alloc(m, g->capacity, sizeof *g->past);
    g->signals = mspringi_alloc(m, signals, sizeof *g->signals);
    g->lengths = mspringi_alloc(m, signals + g->actuator_count, sizeof *g->lengths);
    g->by_signals = mspringi_alloc(m, signals, sizeof *g->by_signals);
    g->by_length = mspringi_alloc(m, g->actuator_count, sizeof *g->by_length);
    g->actuator_start = mspringi_alloc(m, g->actuator_count, sizeof *g->actuator_start);
    g->forces = mspringi_alloc(m, g->capacity, forces * sizeof *g->forces);
    g->by_forces = mspringi_alloc(m, g->capacity, forces * sizeof *g->by_forces);
    return g->past && g->signals && g->lengths && g->by_signals && g->by_length && g->actuator_start && g->forces &&
           g->by_forces;
}

static bool read_actuators(mspring_gradient *g) {
    const mspringi_actuators *from = g->network->actuators;
    g->actuator_count = mspringi_actuator_count(g->network);
    g->actuator_place = mspringi_alloc(&g->memory, g->actuator_count, sizeof *g->actuator_place);
    g->nominal = mspringi_alloc(&g->memory, g->actuator_count, sizeof *g->nominal);
    if (!g->actuator_place || !g->nominal)
        return false;
    g->changes = from ? from->changes : 1;
    for (uint32_t i = 0; i < g->actuator_count; ++i) {
        g->actuator_place[i] = g->octets.place[from->spring[i]];
        g->nominal[i] = from->nominal[i];
    }
    return true;
}

static void read_actuator_lengths(mspring_gradient *g) {
    for (uint32_t i = 0; i < g->actuator_count; ++i)
        g->lengths[i] = mspringi_actuator_length(g->network, i);
}

// Read the half-planes as features/contact/floor.c does: unit normal, and its product with a point on the border.
static void read_planes(mspring_gradient *g) {
    mspring_floor_def floor = {.struct_size = sizeof floor};
    if (mspring_network_get_floor(g->network, &floor) != MSPRING_OK)
        return;
    g->plane_count = floor.plane_count;
    for (uint32_t i = 0; i < floor.plane_count; ++i) {
        const double *given = floor.planes + 4 * (size_t)i,
                     length = sqrt(given[2] * given[2] + given[3] * given[3]);
        double *plane = g->planes[i];
        plane[0] = given[2] / length;
        plane[1] = given[3] / length;
        plane[2] = plane[0] * given[0] + plane[1] * given[1];
    }
}

static mspring_result read_forced(mspring_gradient *g, const mspring_view *view, const mspring_id *forced) {
    mspringi_message *message = &g->network->message;
    uint8_t *seen = mspringi_alloc(&g->memory, view->slot_count, 1);
    g->forced = mspringi_alloc(&g->memory, g->forced_count, sizeof *g->forced);
    g->forced_slot = mspringi_alloc(&g->memory, g->forced_count, sizeof *g->forced_slot);
    mspring_result result = MSPRING_OK;
    if (!seen || !g->forced || !g->forced_slot)
        result = mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for a gradient");
    for (uint32_t i = 0; i < g->forced_count && result == MSPRING_OK; ++i) {
        if (forced[i] >= g->particle_count || !mspringi_particle_exists(g->network, forced[i])) {
            result = mspringi_fail(message, MSPRING_ERROR_ID, "forced[%u] is %s, which is no particle", (unsigned)i,
                                   MSPRINGI_ID(forced[i]));
            break;
        }
        const uint32_t slot = view->slot_of_particle[forced[i]];
        if (seen[slot])
            result = mspringi_fail(message, MSPRING_ERROR_DUPLICATE, "forced[%u]: particle %u is there twice",
                                   (unsigned)i, (unsigned)forced[i]);
        seen[slot] = 1;
        g->forced[i] = forced[i];
        g->forced_slot[i] = slot;
    }
    mspringi_free(&g->memory, seen);
    return result;
}

// Reject moving particles without springs. The network takes all their substeps together, the clone with its hook
// takes them one by one, so the bits differ.
static mspring_result refuse_loose(const mspring_gradient *g, const mspring_view *view) {
    mspringi_message *message = &g->network->message;
    double *degree = g->adjoint.force.x; // not used yet
    const mspringi_octets *o = &g->octets;
    for (uint32_t spring = 0; spring < g->spring_count; ++spring) {
        const uint32_t place = o->place[spring];
        if (place != MSPRING_NONE) {
            degree[o->a[place / MSPRINGI_OCTET] + place % MSPRINGI_OCTET] = 1.0;
            degree[o->b[place / MSPRINGI_OCTET] + place % MSPRINGI_OCTET] = 1.0;
        }
    }
    mspring_result result = MSPRING_OK;
    for (uint32_t p = 0; p < g->particle_count && result == MSPRING_OK; ++p) {
        const uint32_t slot = view->slot_of_particle[p];
        if (mspringi_particle_exists(g->network, p) && !(degree[slot] > 0.0) &&
            (view->inverse_mass[slot] > 0.0f || view->vx[slot] != 0.0f || view->vy[slot] != 0.0f))
            result = mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                   "particle %u has no spring: such particles have no gradient yet", (unsigned)p);
    }
    memset(degree, 0, g->lanes * sizeof *degree);
    return result;
}

static mspring_result fill_gradient(mspring_gradient *g, const mspring_id *forced) {
    mspring_view view = {.struct_size = sizeof view};
    mspring_result result = mspring_network_get_view(g->network, &view);
    if (result != MSPRING_OK)
        return result;
    g->particle_count = view.particle_count;
    g->spring_count = mspring_network_count(g->network, MSPRING_SPRINGS);
    g->slots = view.slot_count;
    g->lanes = (view.slot_count + 3 * MSPRINGI_OCTET) / MSPRINGI_OCTET * MSPRINGI_OCTET;
    g->layout = view.layout_generation;
    g->segment = MSPRING_NONE;
    read_planes(g);
    if (!mspringi_octets_make(g) || !make_adjoint(g, &view) || !read_actuators(g) || !make_records(g))
        return mspringi_fail(&g->network->message, MSPRING_ERROR_MEMORY, "no memory for a gradient");
    g->needs_velocities = g->octets.damping || g->plane_count > 0;
    read_actuator_lengths(g);
    result = read_forced(g, &view, forced);
    if (result == MSPRING_OK)
        result = refuse_loose(g, &view);
    if (result == MSPRING_OK)
        result = mspring_network_clone(g->network, NULL, &g->clone);
    return result;
}

mspring_result mspring_gradient_create(mspring_network *network, uint32_t step_count, const mspring_id *forced,
                                       uint32_t forced_count, mspring_gradient **gradient) {
    mspring_result result = mspringi_check_call(network);
    if (result != MSPRING_OK)
        return result;
    if (!gradient || (!forced && forced_count > 0))
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "gradient or forced is NULL");
    if (step_count < 1 || step_count > MSPRING_MAX_GRADIENT_STEPS)
        return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT, "step_count is %u, it must be 1 to %u",
                             (unsigned)step_count, (unsigned)MSPRING_MAX_GRADIENT_STEPS);
    result = mspringi_gradient_check(network);
    if (result != MSPRING_OK)
        return result;
    mspringi_memory memory = {.allocator = network->memory.allocator};
    mspring_gradient *g = mspringi_alloc(&memory, 1, sizeof *g);
    if (!g)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for a gradient");
    g->memory = memory;
    g->network = network;
    g->capacity = step_count;
    g->level = mspringi_cpu_choose(MSPRING_SIMD_AUTO);
    g->forced_count = forced_count;
    const mspringi_fp_state before = mspringi_fp_enter();
    result = fill_gradient(g, forced);
    mspringi_fp_leave(before);
    if (result != MSPRING_OK)
        mspring_gradient_destroy(g);
    else
        *gradient = g;
    return result;
}

void mspring_gradient_destroy(mspring_gradient *gradient) {
    if (!gradient)
        return;
    mspring_network_destroy(gradient->clone);
    mspringi_memory memory = gradient->memory;
    mspringi_free_all(&memory);
}

const char *mspring_gradient_error(const mspring_gradient *gradient) {
    return gradient ? gradient->message.text : "";
}

/* ---------------------------------------------------------------------------------------------------------- seeds
 */

mspring_result mspring_gradient_add_seeds(mspring_gradient *gradient, const mspring_id *ids, mspring_id first,
                                          uint32_t count, const double *positions, const double *velocities) {
    if (!gradient)
        return MSPRING_ERROR_ARGUMENT;
    mspring_gradient *g = gradient;
    mspringi_message_clear(&g->message);
    for (int adds = 0; adds < 2; ++adds)
        for (uint32_t i = 0; i < count; ++i) {
            const uint64_t id = ids ? ids[first + i] : (uint64_t)first + i;
            if (id >= g->particle_count || !mspringi_particle_exists(g->network, (mspring_id)id))
                return mspringi_fail(&g->message, MSPRING_ERROR_ID, "seed %u: no particle %s", (unsigned)i,
                                     MSPRINGI_ID((mspring_id)id));
            const uint32_t slot = g->network->topology.slot_of_particle[id];
            const double zeros[2] = {0.0, 0.0}, *p = positions ? positions + 2 * (size_t)i : zeros,
                         *v = velocities ? velocities + 2 * (size_t)i : zeros;
            if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(v[0]) || !isfinite(v[1]))
                return mspringi_fail(&g->message, MSPRING_ERROR_ARGUMENT, "seed %u is not finite", (unsigned)i);
            if (adds) {
                g->adjoint.position.x[slot] += p[0];
                g->adjoint.position.y[slot] += p[1];
                g->adjoint.velocity.x[slot] += v[0];
                g->adjoint.velocity.y[slot] += v[1];
            }
        }
    return MSPRING_OK;
}

/* -------------------------------------------------------------------------------------------------------- reading
 */

// Derivative by a parameter of a spring. For an actuator, by its length before the steps reversed so far.
static double spring_gradient(const mspring_gradient *g, mspring_gradient_of of, uint32_t spring) {
    const uint32_t place = g->octets.place[spring];
    if (of == MSPRING_GRADIENT_REST_LENGTH && g->actuator_count > 0) {
        const uint32_t actuator = g->network->actuators->of_spring[spring];
        if (actuator != MSPRING_NONE)
            return g->by_length[actuator];
    }
    if (place == MSPRING_NONE)
        return 0.0;
    return of == MSPRING_GRADIENT_STIFFNESS     ? g->octets.by_stiffness[place]
           : of == MSPRING_GRADIENT_REST_LENGTH ? g->octets.by_length[place]
           : g->octets.by_damping               ? g->octets.by_damping[place]
                                                : 0.0;
}

static double particle_gradient(const mspring_gradient *g, mspring_gradient_of of, uint32_t particle) {
    const uint32_t slot = g->network->topology.slot_of_particle[particle];
    if (!mspringi_particle_exists(g->network, particle))
        return 0.0;
    return of == MSPRING_GRADIENT_X    ? g->adjoint.position.x[slot]
           : of == MSPRING_GRADIENT_Y  ? g->adjoint.position.y[slot]
           : of == MSPRING_GRADIENT_VX ? g->adjoint.velocity.x[slot]
                                       : g->adjoint.velocity.y[slot];
}

mspring_result mspring_gradient_get(const mspring_gradient *gradient, mspring_gradient_of of, const mspring_id *ids,
                                    mspring_id first, uint32_t count, double *values, uint32_t stride) {
    if (!gradient || (!values && count > 0) || stride == 0 || of < 0 || of > MSPRING_GRADIENT_VY)
        return MSPRING_ERROR_ARGUMENT;
    const bool is_of_spring = of <= MSPRING_GRADIENT_REST_LENGTH;
    const uint32_t total = is_of_spring ? gradient->spring_count : gradient->particle_count;
    for (uint32_t i = 0; i < count; ++i)
        if ((ids ? ids[first + i] : (uint64_t)first + i) >= total)
            return MSPRING_ERROR_ID;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t id = ids ? ids[first + i] : first + i;
        values[(size_t)i * stride] =
            is_of_spring ? spring_gradient(gradient, of, id) : particle_gradient(gradient, of, id);
    }
    return MSPRING_OK;
}

mspring_result mspring_gradient_get_signals(const mspring_gradient *gradient, uint32_t step, double *values) {
    if (!gradient || (!values && gradient->actuator_count > 0))
        return MSPRING_ERROR_ARGUMENT;
    if (step >= gradient->count)
        return MSPRING_ERROR_ID;
    for (uint32_t i = 0; i < gradient->actuator_count; ++i)
        values[i] = gradient->by_signals[(size_t)step * gradient->actuator_count + i];
    return MSPRING_OK;
}

mspring_result mspring_gradient_get_forces(const mspring_gradient *gradient, uint32_t step, double *values) {
    if (!gradient || (!values && gradient->forced_count > 0))
        return MSPRING_ERROR_ARGUMENT;
    if (step >= gradient->count)
        return MSPRING_ERROR_ID;
    for (size_t i = 0; i < (size_t)gradient->forced_count * 2; ++i)
        values[i] = gradient->by_forces[(size_t)step * gradient->forced_count * 2 + i];
    return MSPRING_OK;
}

#include "analysis/tune/reference.h"

#include <math.h>
#include <string.h>

#include "base/cpu.h"
#include "kernels/spring_law.h"
#include "store/springs.h"

/// Substep, relative to the longest one that is stable in any shape.
#define PART_OF_STABLE (1.0 / 3.0)

/* ---------------------------------------------------------------------------------------------------- creation */

static mspring_result allocate(mspringi_reference *r, mspring_network *network, uint32_t springs) {
    const size_t particles = network->topology.particle_count;
    double **const arrays[] = {&r->x,
                               &r->y,
                               &r->vx,
                               &r->vy,
                               &r->ax,
                               &r->ay,
                               &r->held_x,
                               &r->held_y,
                               &r->extrapolated_x,
                               &r->extrapolated_y,
                               &r->inverse_mass};
    const size_t count = sizeof arrays / sizeof arrays[0];
    double *block = mspringi_alloc(&network->memory, count * particles, sizeof *block);
    r->springs = mspringi_alloc(&network->memory, springs, sizeof *r->springs);
    if (!block || !r->springs) {
        mspringi_free(&network->memory, block);
        mspringi_free(&network->memory, r->springs);
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for a reference run of %zu particles", particles);
    }
    for (size_t i = 0; i < count; ++i)
        *arrays[i] = block + i * particles;
    return MSPRING_OK;
}

void mspringi_reference_set_motion(mspringi_reference *r, const mspring_network *network, double shift_x,
                                   double shift_y) {
    const mspringi_state *s = &network->state;
    for (mspring_id p = 0; p < r->particle_count; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): allocate has set it
        r->x[p] = shift_x + mspringi_x_of(s, slot);
        r->y[p] = shift_y + mspringi_y_of(s, slot);
        r->vx[p] = (double)s->vx[slot];
        r->vy[p] = (double)s->vy[slot];
    }
    r->has_accelerations = false;
}

static void fill_particles(mspringi_reference *r, const mspring_network *network) {
    const mspringi_forces *forces = &network->forces;
    mspringi_reference_set_motion(r, network, 0.0, 0.0);
    for (mspring_id p = 0; p < r->particle_count; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        r->inverse_mass[p] = (double)network->inverse_mass[slot];
        if (forces->held_any) {
            r->held_x[p] = r->inverse_mass[p] * (double)forces->held.x[slot];
            r->held_y[p] = r->inverse_mass[p] * (double)forces->held.y[slot];
        }
    }
}

static bool has_force(const mspringi_spring_values *values) {
    return values->stiffness > 0.0f || values->damping > 0.0f;
}

static uint32_t count_springs(const mspring_network *network) {
    uint32_t count = 0;
    for (mspring_id spring = 0; spring < network->topology.spring_count; ++spring) {
        const mspringi_spring_values values = mspringi_spring_get(network, spring);
        count += has_force(&values);
    }
    return count;
}

static void fill_springs(mspringi_reference *r, const mspring_network *network) {
    const uint32_t *particle = network->topology.particle_of_slot;
    for (mspring_id spring = 0; spring < network->topology.spring_count; ++spring) {
        const mspringi_spring_values values = mspringi_spring_get(network, spring);
        if (!has_force(&values))
            continue;
        r->springs[r->spring_count++] = (mspringi_reference_spring){
            .a = particle[values.base],
            .b = particle[values.tip],
            .stiffness = values.stiffness,
            .damping = values.damping,
            .rest_length = mspringi_read_length(values.rest_length),
        };
    }
}

mspring_result mspringi_reference_create(mspringi_reference *reference, mspring_network *network) {
    mspringi_reference made = {
        .network = network,
        .particle_count = network->topology.particle_count,
        .gravity_x = (double)network->settings.gravity_x,
        .gravity_y = (double)network->settings.gravity_y,
        .global_damping = (double)network->settings.global_damping,
    };
    mspring_result result = allocate(&made, network, count_springs(network));
    if (result != MSPRING_OK)
        return result;
    fill_particles(&made, network);
    fill_springs(&made, network);
    mspringi_elements_refresh(network);
    *reference = made;
    return MSPRING_OK;
}

void mspringi_reference_destroy(mspringi_reference *reference, mspring_network *network) {
    mspringi_free(&network->memory, reference->x);
    mspringi_free(&network->memory, reference->springs);
    *reference = (mspringi_reference){0};
}

void mspringi_reference_clear_forces(mspringi_reference *r) {
    memset(r->held_x, 0, 2 * (size_t)r->particle_count * sizeof *r->held_x); // held_y follows it in memory
    r->has_accelerations = false;
}

/* ----------------------------------------------------------------------------------------------------- elements */

static void push_elements(const mspringi_reference *r, const double *vx, const double *vy) {
    const mspringi_positions all = {.x = r->x, .y = r->y};
    mspringi_gathered room;
    mspringi_element_walk walk = mspringi_walk_elements(r->network);
    while (mspringi_element_next(&walk)) {
        const mspringi_element_ref *e = &walk.element;
        const mspringi_positions *now = mspringi_gather(&room, &all, e);
        double rate = 0.0;
        for (uint32_t i = 0; e->damping > 0.0 && i < e->count; ++i) {
            const mspringi_vector g = e->law->gradient(e, now, i);
            rate += g.x * vx[e->corners[i].particle] + g.y * vy[e->corners[i].particle];
        }
        const double force = e->law->force(e->of, e->law->size(e, now)) - e->damping * rate;
        for (uint32_t i = 0; i < e->count; ++i) {
            const mspringi_vector g = e->law->gradient(e, now, i);
            const uint32_t p = e->corners[i].particle;
            r->ax[p] += r->inverse_mass[p] * force * g.x;
            r->ay[p] += r->inverse_mass[p] * force * g.y;
        }
    }
}

// In c g g', the row of a corner has blocks of size c |g| |g'|, times the roots of both inverse masses.
static void add_element_sums(const mspringi_reference *r, double *stiffness, double *damping) {
    mspringi_element_walk walk = mspringi_walk_elements(r->network);
    while (mspringi_element_next(&walk)) {
        const mspringi_element_ref *e = &walk.element;
        const mspringi_element_bound bound = e->law->bound(e->of);
        double all = 0.0;
        for (uint32_t i = 0; i < e->count; ++i)
            all += (double)e->corners[i].reach * sqrt(r->inverse_mass[e->corners[i].particle]);
        for (uint32_t i = 0; i < e->count; ++i) {
            const uint32_t p = e->corners[i].particle;
            const double weight = (double)e->corners[i].reach * sqrt(r->inverse_mass[p]) * all;
            stiffness[p] += bound.stiffness * weight + 2.0 * bound.rest * r->inverse_mass[p];
            damping[p] += e->damping * weight;
        }
    }
}

// No eigenvalue of M^-1 K exceeds the largest row sum of its symmetric form (Gershgorin), in any shape. The same
// holds for the dampers. The limit is h^2 K + 2 h C = 4.
double mspringi_reference_substep(const mspringi_reference *r) {
    double *stiffness = r->ax, *damping = r->ay, longest = INFINITY;
    memset(stiffness, 0, 2 * (size_t)r->particle_count * sizeof *stiffness); // ay follows ax in memory
    for (uint32_t i = 0; i < r->spring_count; ++i) {
        const mspringi_reference_spring *spring = &r->springs[i];
        const double wa = r->inverse_mass[spring->a], wb = r->inverse_mass[spring->b], both = sqrt(wa * wb);
        stiffness[spring->a] += (double)spring->stiffness * (wa + both);
        stiffness[spring->b] += (double)spring->stiffness * (wb + both);
        damping[spring->a] += (double)spring->damping * (wa + both);
        damping[spring->b] += (double)spring->damping * (wb + both);
    }
    add_element_sums(r, stiffness, damping);
    for (uint32_t p = 0; p < r->particle_count; ++p) {
        const double k = stiffness[p], c = damping[p] + r->global_damping, rate = c + sqrt(c * c + 4.0 * k);
        if (rate > 0.0)
            longest = fmin(longest, 4.0 / rate);
    }
    return PART_OF_STABLE * longest;
}

/* ----------------------------------------------------------------------------------------------------- stepping */

// Accelerations at the present positions and these velocities.
static void find_accelerations(const mspringi_reference *r, const double *vx, const double *vy) {
    for (uint32_t p = 0; p < r->particle_count; ++p) {
        const bool moves = r->inverse_mass[p] > 0.0;
        r->ax[p] = moves ? r->gravity_x + r->held_x[p] - r->global_damping * vx[p] : 0.0;
        r->ay[p] = moves ? r->gravity_y + r->held_y[p] - r->global_damping * vy[p] : 0.0;
    }
    for (uint32_t i = 0; i < r->spring_count; ++i) {
        const mspringi_reference_spring *spring = &r->springs[i];
        const uint32_t a = spring->a, b = spring->b;
        const double dx = r->x[b] - r->x[a], dy = r->y[b] - r->y[a], length = sqrt(dx * dx + dy * dy);
        if (!(length > 0.0))
            continue;
        const double inverse = 1.0 / length, growth = ((vx[b] - vx[a]) * dx + (vy[b] - vy[a]) * dy) * inverse;
        const double force =
            MSPRINGI_LAW_FORCE(MSPRINGI_TIMES, (double)spring->stiffness, length - (double)spring->rest_length) +
            MSPRINGI_LAW_DAMPING_FORCE(MSPRINGI_TIMES, (double)spring->damping, growth);
        const double fx = force * inverse * dx, fy = force * inverse * dy;
        r->ax[a] += r->inverse_mass[a] * fx;
        r->ay[a] += r->inverse_mass[a] * fy;
        r->ax[b] -= r->inverse_mass[b] * fx;
        r->ay[b] -= r->inverse_mass[b] * fy;
    }
    push_elements(r, vx, vy);
}

// to = from + factor * change. count includes both coordinates, which follow each other in memory.
static void add(double *to, const double *from, double factor, const double *change, size_t count) {
    for (size_t i = 0; i < count; ++i)
        to[i] = from[i] + factor * change[i];
}

// Take a substep. Damping uses velocities extrapolated to its end.
static void take_substep(mspringi_reference *r, double h) {
    const size_t count = 2 * (size_t)r->particle_count;
    add(r->vx, r->vx, 0.5 * h, r->ax, count);
    add(r->x, r->x, h, r->vx, count);
    add(r->extrapolated_x, r->vx, 0.5 * h, r->ax, count);
    find_accelerations(r, r->extrapolated_x, r->extrapolated_y);
    add(r->vx, r->vx, 0.5 * h, r->ax, count);
}

static MSPRINGI_NOINLINE void run(mspringi_reference *r, double h, uint32_t count) {
    if (!r->has_accelerations)
        find_accelerations(r, r->vx, r->vy);
    r->has_accelerations = true;
    for (; count > 0; --count)
        take_substep(r, h);
}

void mspringi_reference_run(mspringi_reference *reference, double h, uint32_t count) {
    const mspringi_fp_state before = mspringi_fp_enter();
    run(reference, h, count);
    mspringi_fp_leave(before);
}

void mspringi_reference_kick(mspringi_reference *r, double time) {
    const mspringi_fp_state before = mspringi_fp_enter();
    find_accelerations(r, r->vx, r->vy);
    add(r->vx, r->vx, time, r->ax, 2 * (size_t)r->particle_count);
    mspringi_fp_leave(before);
    r->has_accelerations = false;
}

mspringi_reference_energy mspringi_reference_measure(const mspringi_reference *r) {
    mspringi_reference_energy energy = {0.0, 0.0};
    for (uint32_t p = 0; p < r->particle_count; ++p) {
        if (!(r->inverse_mass[p] > 0.0))
            continue;
        const double mass = 1.0 / r->inverse_mass[p];
        energy.internal += 0.5 * mass * (r->vx[p] * r->vx[p] + r->vy[p] * r->vy[p]);
        energy.potential -= mass * (r->gravity_x * r->x[p] + r->gravity_y * r->y[p]);
    }
    for (uint32_t i = 0; i < r->spring_count; ++i) {
        const mspringi_reference_spring *spring = &r->springs[i];
        const double dx = r->x[spring->b] - r->x[spring->a], dy = r->y[spring->b] - r->y[spring->a];
        const double stretch = sqrt(dx * dx + dy * dy) - (double)spring->rest_length;
        energy.internal += 0.5 * (double)spring->stiffness * stretch * stretch;
    }
    const mspringi_positions all = {.x = r->x, .y = r->y};
    mspringi_gathered room;
    mspringi_element_walk walk = mspringi_walk_elements(r->network);
    while (mspringi_element_next(&walk))
        energy.internal += walk.element.law->energy(
            walk.element.of, walk.element.law->size(&walk.element, mspringi_gather(&room, &all, &walk.element)));
    return energy;
}

/// Queries about groups.
#include "base/cpu.h"
#include "store/id_pool.h"
#include "store/moments.h"

uint32_t mspring_network_group_count(const mspring_network *network) {
    return network ? network->groups.count : 0;
}

static mspring_result check_range(const mspring_network *network, uint32_t first, uint32_t count, const void *out) {
    const uint32_t all = network->groups.count;
    if (!(first <= all && count <= all - first))
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ID,
                                    "%u groups from number %s on: numbers are below %u", (unsigned)count,
                                    MSPRINGI_ID(first), (unsigned)all);
    if (!out && count > 0)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT, "the place for what is read is NULL");
    return MSPRING_OK;
}

mspring_result mspring_network_get_group_flags(const mspring_network *network, uint32_t first, uint32_t count,
                                               uint32_t *flags, uint32_t stride) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    const mspring_result result = check_range(network, first, count, flags);
    if (result != MSPRING_OK)
        return result;
    if (stride < 1)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT, "the stride is 0");
    for (size_t i = 0; i < count; ++i)
        flags[i * stride] = network->groups.flags[first + i] & MSPRINGI_HELD ? MSPRING_GROUP_HELD : 0u;
    return MSPRING_OK;
}

/* ---------------------------------------------------------------------------------------------- observations */

static mspring_result check_observation(const mspring_network *network, uint32_t first, uint32_t count,
                                        const uint32_t *particles, uint32_t particle_count, const double *rows,
                                        uint32_t stride) {
    const mspringi_groups *g = &network->groups;
    mspring_result result = check_range(network, first, count, rows);
    if (result != MSPRING_OK)
        return result;
    if (!particles && particle_count > 0)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT, "the list of particles is NULL");
    const uint64_t columns = MSPRING_OBSERVE_PARTICLES + 4 * (uint64_t)particle_count;
    if (stride < columns)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT,
                                    "the stride is %u, but a row has %llu columns", (unsigned)stride,
                                    (unsigned long long)columns);
    for (uint32_t group = first; group < first + count; ++group)
        for (uint32_t i = 0; i < particle_count; ++i)
            if (particles[i] >= g->first[group + 1] - g->first[group])
                return mspringi_shared_fail(
                    network->shared, MSPRING_ERROR_ID,
                    "index %u: group %u has %u particles, and none with number %s", (unsigned)i, (unsigned)group,
                    (unsigned)(g->first[group + 1] - g->first[group]), MSPRINGI_ID(particles[i]));
    return MSPRING_OK;
}

// Centre, its velocity and the box, in local coordinates.
static void observe_body(const mspring_network *network, uint32_t group, double *row) {
    const mspringi_groups *g = &network->groups;
    const mspringi_state *s = &network->state;
    mspringi_moments sum = {0};
    double low_x = 1e300, low_y = 1e300, high_x = -1e300, high_y = -1e300;
    for (mspring_id p = g->first[group]; p < g->first[group + 1]; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        if (!mspringi_particle_exists(network, p))
            continue;
        const double x = mspringi_x_of(s, slot), y = mspringi_y_of(s, slot);
        mspringi_moments_add(&sum, mspringi_moments_of(network, p));
        low_x = x < low_x ? x : low_x;
        low_y = y < low_y ? y : low_y;
        high_x = x > high_x ? x : high_x;
        high_y = y > high_y ? y : high_y;
    }
    const double part = sum.mass > 0.0 ? 1.0 / sum.mass : 0.0;
    const double values[MSPRING_OBSERVE_PARTICLES] = {
        sum.x * part,  sum.y * part, sum.px * part,
        sum.py * part, low_x,        low_y,
        high_x,        high_y,       network->groups.flags[group] & MSPRINGI_HELD ? 1.0 : 0.0};
    for (int i = 0; i < MSPRING_OBSERVE_PARTICLES; ++i)
        row[i] = sum.mass > 0.0 || i == MSPRING_OBSERVE_HELD ? values[i] : 0.0;
}

static void observe_particles(const mspring_network *network, uint32_t group, const uint32_t *particles,
                              uint32_t count, double *row) {
    const mspringi_state *s = &network->state;
    double *to = row + MSPRING_OBSERVE_PARTICLES;
    for (uint32_t i = 0; i < count; ++i, to += 4) {
        const mspring_id p = network->groups.first[group] + particles[i];
        const uint32_t slot = network->topology.slot_of_particle[p];
        const bool exists = mspringi_particle_exists(network, p);
        to[0] = exists ? mspringi_x_of(s, slot) - row[MSPRING_OBSERVE_X] : 0.0;
        to[1] = exists ? mspringi_y_of(s, slot) - row[MSPRING_OBSERVE_Y] : 0.0;
        to[2] = exists ? mspringi_vx_of(s, slot) : 0.0;
        to[3] = exists ? mspringi_vy_of(s, slot) : 0.0;
    }
}

mspring_result mspring_network_observe_groups(const mspring_network *network, uint32_t first, uint32_t count,
                                              const uint32_t *particles, uint32_t particle_count, double *rows,
                                              uint32_t stride) {
    static const int of_x[] = {MSPRING_OBSERVE_X, MSPRING_OBSERVE_MIN_X, MSPRING_OBSERVE_MAX_X};
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    const mspring_result result = check_observation(network, first, count, particles, particle_count, rows, stride);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    for (uint32_t i = 0; i < count; ++i) {
        double *row = rows + (size_t)i * stride;
        observe_body(network, first + i, row);
        observe_particles(network, first + i, particles, particle_count, row);
        for (int k = 0; k < 3; ++k) {
            row[of_x[k]] += network->origin_x;
            row[of_x[k] + 1] += network->origin_y;
        }
    }
    mspringi_fp_leave(before);
    return MSPRING_OK;
}

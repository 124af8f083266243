/// Conversion of a network into a builder: to store it, join it to others, or split it.
#include "base/cpu.h"
#include "builder/builder.h"
#include "store/feature.h"
#include "store/properties.h"
#include "store/springs.h"

// Ids in the builder by id in the network; MSPRING_NONE for particles and springs left out.
typedef struct id_maps {
    mspring_id *particles, *springs;
} id_maps;

static mspring_result allocate(mspring_builder *builder, const mspring_network *network, id_maps *maps) {
    maps->particles = mspringi_alloc(&builder->memory, network->topology.particle_count, sizeof *maps->particles);
    maps->springs = mspringi_alloc(&builder->memory, network->topology.spring_count, sizeof *maps->springs);
    if (maps->particles && maps->springs)
        return MSPRING_OK;
    return mspringi_fail(&builder->message, MSPRING_ERROR_MEMORY, "no memory for a network of %u particles",
                         (unsigned)network->topology.particle_count);
}

// Number the particles, then the springs, that are added, and count them.

static void number_particles(const mspring_builder *builder, const mspring_network *network,
                             const mspringi_selection *at, mspring_id *map, uint32_t *added) {
    const uint32_t total = network->topology.particle_count;
    for (mspring_id p = 0; p < total; ++p)
        map[p] = MSPRING_NONE;
    for (uint32_t i = 0; i < at->count; ++i)
        if (mspringi_particle_exists(network, mspringi_selected(at, i)))
            map[mspringi_selected(at, i)] = 0;
    *added = 0;
    for (mspring_id p = 0; p < total; ++p)
        if (map[p] != MSPRING_NONE)
            map[p] = (mspring_id)builder->particle_count + (*added)++;
}

static void find_ends(const mspring_network *network, mspring_id spring, mspring_id *a, mspring_id *b) {
    const mspringi_ends ends = mspringi_spring_ends(network, spring);
    *a = network->topology.particle_of_slot[ends.a];
    *b = network->topology.particle_of_slot[ends.b];
}

static uint32_t number_springs(const mspring_builder *builder, const mspring_network *network,
                               const id_maps *maps) {
    uint32_t added = 0;
    for (mspring_id s = 0; s < network->topology.spring_count; ++s) {
        maps->springs[s] = MSPRING_NONE;
        if (!mspringi_spring_exists(network, s) || !mspringi_spring_is_live(network, s))
            continue;
        mspring_id a, b;
        find_ends(network, s, &a, &b);
        if (maps->particles[a] != MSPRING_NONE && maps->particles[b] != MSPRING_NONE)
            maps->springs[s] = (mspring_id)builder->spring_count + added++;
    }
    return added;
}

/* ---------------------------------------------------------------------------------------------------- appending */

static mspring_result append_particle(mspring_builder *builder, const mspring_network *network, mspring_id p) {
    const mspringi_state *s = &network->state;
    const uint32_t slot = network->topology.slot_of_particle[p];
    const mspringi_particle particle = {
        .x = network->origin_x + mspringi_x_of(s, slot),
        .y = network->origin_y + mspringi_y_of(s, slot),
        .vx = s->vx[slot],
        .vy = s->vy[slot],
        .mass = network->mass[p],
        .flags = network->inverse_mass[slot] == 0.0f ? MSPRING_PARTICLE_PINNED : 0,
    };
    if (!mspringi_is_coordinate(particle.x) || !mspringi_is_coordinate(particle.y))
        return mspringi_fail(&builder->message, MSPRING_ERROR_ARGUMENT,
                             "particle %u of the network: position (%g, %g) m is not within 1e12", (unsigned)p,
                             particle.x, particle.y);
    if (!mspringi_is_speed(particle.vx) || !mspringi_is_speed(particle.vy))
        return mspringi_fail(&builder->message, MSPRING_ERROR_ARGUMENT,
                             "particle %u of the network: velocity (%g, %g) m/s is not within 1e15", (unsigned)p,
                             (double)particle.vx, (double)particle.vy);
    builder->particles[builder->particle_count++] = particle;
    return MSPRING_OK;
}

static mspringi_limits limits_of(const mspring_network *network, mspring_id s) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, s);
    const float *nominal = network->tested.nominal;
    const bool has_flowed =
        nominal && nominal[spring_slot] != mspringi_spring_slot_own_length(network, spring_slot);
    return (mspringi_limits){.break_strain = mspringi_spring_property(network, MSPRING_BREAK_STRAIN, s),
                             .warn_strain = mspringi_spring_property(network, MSPRING_WARN_STRAIN, s),
                             .relax_strain = mspringi_spring_property(network, MSPRING_RELAX_STRAIN, s),
                             .yield_strain = mspringi_spring_property(network, MSPRING_YIELD_STRAIN, s),
                             .hardening = mspringi_spring_property(network, MSPRING_HARDENING, s),
                             .plastic_limit = mspringi_spring_property(network, MSPRING_PLASTIC_LIMIT, s),
                             .nominal_length = has_flowed ? nominal[spring_slot] : 0.0f};
}

static void append_spring(mspring_builder *builder, const mspring_network *network, const id_maps *maps,
                          mspring_id s) {
    const mspringi_spring_slot spring_slot = mspringi_slot_of_spring(&network->topology, s);
    const mspringi_relative nominal = mspringi_spring_get_nominal(network, s, spring_slot);
    const mspringi_limits limits = limits_of(network, s);
    mspring_id a, b;
    find_ends(network, s, &a, &b);
    builder->springs[builder->spring_count++] = (mspringi_spring){
        .a = maps->particles[a],
        .b = maps->particles[b],
        .stiffness = nominal.stiffness,
        .damping = nominal.damping,
        .rest_length = mspringi_spring_slot_get(network, spring_slot).rest_length,
        .flags = mspringi_spring_flags(network, s) & MSPRINGI_KEPT_SPRING_FLAGS,
    };
    mspringi_builder_put_limits(builder, builder->spring_count - 1, limits);
}

// Make room for the limits of the added springs, if any has limits.
static mspring_result reserve_limits(mspring_builder *builder, const mspring_network *network, const id_maps *maps,
                                     uint32_t added) {
    mspring_result result = MSPRING_OK;
    for (mspring_id s = 0; result == MSPRING_OK && s < network->topology.spring_count; ++s)
        if (maps->springs[s] != MSPRING_NONE)
            result = mspringi_builder_reserve_limits(builder, added, limits_of(network, s));
    return result;
}

static mspring_result append(mspring_builder *builder, const mspring_network *network, const id_maps *maps) {
    const size_t before = builder->particle_count;
    const float lag = mspringi_joint_lag(builder, network->steps.lag);
    for (mspring_id p = 0; p < network->topology.particle_count; ++p) {
        if (maps->particles[p] == MSPRING_NONE)
            continue;
        mspring_result result = append_particle(builder, network, p);
        if (result != MSPRING_OK) {
            builder->particle_count = before;
            return result;
        }
    }
    for (mspring_id s = 0; s < network->topology.spring_count; ++s)
        if (maps->springs[s] != MSPRING_NONE)
            append_spring(builder, network, maps, s);
    mspringi_features_append(network, maps->particles, builder);
    if (builder->particle_count > before)
        builder->lag = lag;
    return MSPRING_OK;
}

/* ----------------------------------------------------------------------------------------------------- the call */

static MSPRINGI_NOINLINE mspring_result add_network(mspring_builder *builder, const mspring_network *network,
                                                    const mspringi_selection *at, id_maps *maps) {
    uint32_t added = 0;
    mspring_result result = allocate(builder, network, maps);
    if (result == MSPRING_OK)
        number_particles(builder, network, at, maps->particles, &added);
    if (result == MSPRING_OK)
        result = mspringi_builder_reserve_particles(builder, added);
    const uint32_t springs = result == MSPRING_OK ? number_springs(builder, network, maps) : 0;
    if (result == MSPRING_OK)
        result = mspringi_builder_reserve_springs(builder, springs);
    if (result == MSPRING_OK)
        result = reserve_limits(builder, network, maps, springs);
    if (result == MSPRING_OK)
        result = mspringi_features_reserve_append(network, maps->particles, builder);
    return result == MSPRING_OK ? append(builder, network, maps) : result;
}

static void copy_ids(mspring_id *to, const mspring_id *from, uint32_t count) {
    for (uint32_t i = 0; to && i < count; ++i)
        to[i] = from[i];
}

mspring_result mspring_builder_add_network(mspring_builder *builder, const mspring_network *network,
                                           const mspring_id *ids, mspring_id first, uint32_t count,
                                           mspring_id *particle_ids, mspring_id *spring_ids) {
    mspringi_selection at;
    id_maps maps = {0};
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_message_clear(&builder->message);
    mspring_result result =
        network ? mspringi_look_up_with(&builder->message, network, MSPRING_PARTICLES, ids, first, count, &at)
                : mspringi_fail(&builder->message, MSPRING_ERROR_ARGUMENT, "the network is NULL");
    const mspringi_fp_state before = mspringi_fp_enter();
    if (result == MSPRING_OK)
        result = add_network(builder, network, &at, &maps);
    mspringi_fp_leave(before);
    if (result == MSPRING_OK) {
        copy_ids(particle_ids, maps.particles, network->topology.particle_count);
        copy_ids(spring_ids, maps.springs, network->topology.spring_count);
    }
    mspringi_free(&builder->memory, maps.particles);
    mspringi_free(&builder->memory, maps.springs);
    return mspringi_builder_end(builder, result);
}

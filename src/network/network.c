/// Creation and destruction of a network.
#include "store/network.h"

#include <math.h>

#include "base/cpu.h"
#include "base/definitions.h"
#include "base/hash.h"
#include "base/unit.h"
#include "network/job.h"
#include "network/level.h"
#include "solvers/explicit/explicit.h"
#include "solvers/explicit/halo.h"
#include "stability/guard.h"
#include "stability/stability_limit.h"
#include "step/origin.h"
#include "store/archive.h"
#include "store/feature.h"
#include "store/fractions.h"
#include "store/id_pool.h"
#include "store/metres.h"
#include "store/record_sharing.h"
#include "store/rest_lengths.h"
#include "store/sleepers.h"
#include "store/spring_limits.h"
#include "store/springs.h"
#include "store/stages.h"
#include "store/store.h"

/* --------------------------------------------------------------------------------------------------- checks */

#define IN_HOOK "called from inside a hook, where only functions marked as shared are allowed"

mspring_result mspringi_check_call(mspring_network *network) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    if (network->in_hook == MSPRINGI_IN_HOOKS)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_BUSY, IN_HOOK);
    if (network->in_hook == MSPRINGI_IN_HOOK)
        return mspringi_fail(&network->message, MSPRING_ERROR_BUSY, IN_HOOK);
    mspringi_message_clear(&network->message);
    mspringi_shared_clear(network->shared);
    return MSPRING_OK;
}

mspring_result mspringi_shared_reserve(mspring_network *network) {
    network->shared = mspringi_alloc(&network->tasks_memory, 1, sizeof *network->shared);
    if (!network->shared)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for a message");
    mspringi_shared_clear(network->shared);
    return MSPRING_OK;
}

mspring_result mspringi_check_report(const mspring_network *network, const mspringi_struct *of, const void *out) {
    mspringi_message message;
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    const mspring_result result = mspringi_check_output(&message, of, out);
    return result == MSPRING_OK ? MSPRING_OK : mspringi_shared_set(network->shared, result, &message);
}

static mspring_result check_def(const mspring_network_def **given, mspring_network_def *def,
                                mspringi_message *message) {
    mspring_result result = mspringi_take_network_def_or_defaults(message, given, def);
    if (result != MSPRING_OK)
        return result;
    if (def->simd_level < MSPRING_SIMD_AUTO || def->simd_level > MSPRING_SIMD_WASM)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "simd_level is %d, which is unknown",
                             (int)def->simd_level);
    if (def->flags & ~(uint32_t)(MSPRING_NETWORK_RESERVE_DAMPING | MSPRING_NETWORK_RESERVE_RELATIVE |
                                 MSPRING_NETWORK_PRECISE | MSPRING_NETWORK_POSES))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "network flags %#x are unknown",
                             (unsigned)def->flags);
    uint32_t reserved = def->reserved_pointers[0] || def->reserved_pointers[1];
    for (size_t i = 0; i < sizeof def->reserved / sizeof def->reserved[0]; ++i)
        reserved |= def->reserved[i];
    result = mspringi_check_reserved(message, "mspring_network_def", reserved);
    return result == MSPRING_OK ? mspringi_check_settings(&def->settings, message) : result;
}

/* ---------------------------------------------------------------------------------------------------- filling */

mspring_result mspringi_field_reserve(mspring_network *network, mspringi_field *field) {
    if (field->x)
        return MSPRING_OK;
    const size_t slots = mspringi_slot_count(network);
    float *values = mspringi_alloc(&network->memory, 2 * slots, sizeof *values);
    if (!values)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for the forces on %zu slots",
                             slots);
    *field = (mspringi_field){values, values + slots};
    return MSPRING_OK;
}

void mspringi_field_copy(const mspring_network *network, mspringi_field from, mspringi_field to) {
    const size_t size = mspringi_used_slots(network) * sizeof *to.x;
    memcpy(to.x, from.x, size);
    memcpy(to.y, from.y, size);
}

void mspringi_field_clear(const mspring_network *network, mspringi_field field) {
    const size_t size = mspringi_used_slots(network) * sizeof *field.x;
    memset(field.x, 0, size);
    memset(field.y, 0, size);
}

void mspringi_forces_forget(mspring_network *network) {
    mspringi_forces *forces = &network->forces;
    if (forces->held_any)
        mspringi_field_clear(network, forces->held);
    if (forces->first_any)
        mspringi_field_clear(network, forces->first);
    forces->held_any = forces->first_any = false;
}

mspring_result mspringi_carry_reserve(mspring_network *network) {
    const uint32_t rows = mspringi_explicit_carry_rows(network) * mspringi_tasks_partition_size(network->tasks);
    if (network->carry && network->carry_rows >= rows)
        return mspringi_halos_reserve(network);
    const size_t values = (size_t)2 * rows * network->topology.carry_blocks * MSPRINGI_WIDTH;
    float *carry = mspringi_alloc(&network->memory, values, sizeof *carry);
    if (!carry)
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for forces between rows");
    mspringi_free(&network->memory, network->carry);
    network->carry = carry;
    network->carry_rows = rows;
    return mspringi_halos_reserve(network);
}

/// Needs of a network: properties that some of the builder's springs have.
typedef struct spring_needs {
    uint32_t flags;
    bool damping, reversed; ///< some first end has the higher id
} spring_needs;

static spring_needs check_springs(const mspring_builder *builder) {
    spring_needs needs = {0};
    for (size_t s = 0; s < builder->spring_count; ++s) {
        needs.flags |= builder->springs[s].flags;
        needs.damping |= builder->springs[s].damping > 0.0f;
        needs.reversed |= builder->springs[s].a > builder->springs[s].b;
    }
    return needs;
}

mspring_result mspringi_layout_reserve(mspring_network *network) {
    static const mspringi_group groups[] = {MSPRINGI_STORE_PARTICLES, MSPRINGI_STORE_BACKUP, MSPRINGI_STORE_ROWS,
                                            MSPRINGI_STORE_IRREGULAR};
    const mspringi_topology *t = &network->topology;
    for (size_t i = 0; i < sizeof groups / sizeof groups[0]; ++i)
        if (!mspringi_store_reserve(network, groups[i]))
            return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                                 "no memory for a network of %u particles and %u springs",
                                 (unsigned)t->particle_count, (unsigned)t->spring_count);
    mspringi_shared_records_clear(&network->shared_records, t->lattice_blocks);
    network->depth = mspringi_explicit_depth(network);
    return mspringi_carry_reserve(network);
}

static mspring_result make_reserve(mspringi_reserve *reserve, const mspring_builder *builder,
                                   const mspring_network_def *def, mspringi_message *message) {
    const uint64_t particles = (uint64_t)builder->particle_count + def->spare_particles;
    const uint64_t springs = (uint64_t)builder->spring_count + def->spare_springs;
    if (particles > MSPRING_MAX_PARTICLES || springs > MSPRING_MAX_SPRINGS)
        return mspringi_fail(
            message, MSPRING_ERROR_LIMIT,
            "spare_particles is %u and spare_springs is %u, with the builder's %zu and %zu there may "
            "be %u and %u",
            (unsigned)def->spare_particles, (unsigned)def->spare_springs, builder->particle_count,
            builder->spring_count, (unsigned)MSPRING_MAX_PARTICLES, (unsigned)MSPRING_MAX_SPRINGS);
    *reserve = (mspringi_reserve){.first_particle = (uint32_t)builder->particle_count,
                                  .first_spring = (uint32_t)builder->spring_count,
                                  .particle_end = (uint32_t)particles,
                                  .spring_end = (uint32_t)springs};
    return MSPRING_OK;
}

static mspring_result allocate(mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    if (!mspringi_store_reserve(network, MSPRINGI_STORE_MASS))
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for %u particles and %u springs",
                             (unsigned)t->particle_count, (unsigned)t->spring_count);
    return mspringi_layout_reserve(network);
}

static void fill_particles(mspring_network *network, const mspring_builder *builder) {
    const mspringi_topology *t = &network->topology;
    mspringi_box box = mspringi_box_empty();
    for (uint32_t p = 0; p < t->particle_count; ++p)
        mspringi_box_include(&box, builder->particles[p].x, builder->particles[p].y);
    mspringi_origin_choose(network, &box);
    for (uint32_t p = 0; p < t->particle_count; ++p) {
        const mspringi_particle *particle = &builder->particles[p];
        const uint32_t slot = t->slot_of_particle[p];
        network->mass[p] = particle->mass;
        network->inverse_mass[slot] = particle->flags & MSPRING_PARTICLE_PINNED ? 0.0f : 1.0f / particle->mass;
        network->state.vx[slot] = particle->vx;
        network->state.vy[slot] = particle->vy;
        mspringi_set_position(network, p, particle->x, particle->y);
    }
}

// Fill the records. Fingerprints tell this network's snapshots from those of others.
static void fill_springs(mspring_network *network, const mspring_builder *builder) {
    const mspringi_topology *t = &network->topology;
    float shortest = INFINITY, longest = 0.0f;
    uint64_t topology = MSPRINGI_HASH_START, parameters = MSPRINGI_HASH_START;
    network->shortest_set = INFINITY;
    network->shared_records.changes = t->lattice_springs;
    if (t->reserve.particle_end > t->particle_count || t->reserve.spring_end > t->spring_count)
        topology = mspringi_hash(topology, (uint64_t)t->reserve.particle_end << 32 | t->reserve.spring_end);
    for (mspring_id p = 0; p < t->particle_count; ++p)
        topology = mspringi_hash(topology, t->slot_of_particle[p]);
    for (mspring_id s = 0; s < t->spring_count; ++s) {
        const mspringi_spring *spring = &builder->springs[s];
        const float length = spring->rest_length;
        if (length != MSPRINGI_WELD) {
            shortest = length < shortest ? length : shortest;
            longest = length > longest ? length : longest;
        }
        const mspringi_spring_slot spring_slot = t->slot_of_spring[s];
        mspringi_spring_slot_fill(network, spring_slot, length,
                                  spring->flags & MSPRING_SPRING_RELATIVE
                                      ? (mspringi_relative){0.0f, 0.0f}
                                      : (mspringi_relative){spring->stiffness, spring->damping});
        topology = mspringi_hash(topology, (uint64_t)spring->a << 32 | spring->b);
        topology = mspringi_hash(topology, (uint64_t)spring_slot << 32 | spring->flags);
        parameters = mspringi_hash_floats(parameters, spring->stiffness, spring->damping);
        parameters = mspringi_hash_floats(parameters, length, 0.0f);
        network->live[spring_slot / MSPRINGI_WIDTH] |= (uint16_t)(1u << spring_slot % MSPRINGI_WIDTH);
    }
    network->shortest = (double)shortest;
    network->topology_fingerprint = topology;
    network->parameter_fingerprint = parameters;
    network->state.grid = network->is_precise ? (float)mspringi_unit_of(2.0f * longest) : 0.0f;
}

// Mark springs whose first end has the higher id, which are few.
static mspring_result mark_reversed(mspring_network *network, const mspring_builder *builder) {
    if (!mspringi_store_reserve(network, MSPRINGI_STORE_TURNED))
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory for the ends of %u springs",
                             (unsigned)network->topology.spring_count);
    for (size_t s = 0; s < builder->spring_count; ++s)
        network->is_reversed[s / 8] |= (uint8_t)((builder->springs[s].a > builder->springs[s].b) << s % 8);
    return MSPRING_OK;
}

static mspring_result check_features(mspring_network *network, const mspring_builder *builder) {
    return builder->area_count == 0 || mspringi_stage_exists(MSPRINGI_STAGE_OF_AREAS)
               ? MSPRING_OK
               : mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                               "the builder has %zu areas or angles: this build of the library lacks the part laws "
                               "(MASSSPRING_PARTS)",
                               builder->area_count);
}

// Note springs that only pull or only push. Those that are added later are none.
static mspring_result set_sides(mspring_network *network, const mspring_builder *builder) {
    uint32_t count = 0;
    for (size_t s = 0; s < builder->spring_count; ++s)
        count += (builder->springs[s].flags & MSPRINGI_ONE_WAY_FLAGS) != 0;
    if (!mspringi_stage_exists(MSPRINGI_STAGE_OF_ONE_WAY))
        return mspringi_fail(
            &network->message, MSPRING_ERROR_ARGUMENT,
            "%u springs only pull or only push: this build of the library lacks the part laws (MASSSPRING_PARTS)",
            (unsigned)count);
    if (!mspringi_store_reserve(network, MSPRINGI_STORE_SIDE))
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY,
                             "no memory for %u springs that only pull or only push", (unsigned)count);
    for (size_t s = 0; s < builder->spring_count; ++s) {
        const uint32_t flags = builder->springs[s].flags;
        network->side[s] = (int8_t)(flags & MSPRING_SPRING_PULL_ONLY   ? 1
                                    : flags & MSPRING_SPRING_PUSH_ONLY ? -1
                                                                       : 0);
        mspringi_fingerprint_floats(network, (float)network->side[s], 0.0f);
    }
    return MSPRING_OK;
}

// Set the strain limits of springs.
static mspring_result set_limits(mspring_network *network, const mspring_builder *builder, uint32_t flags) {
    mspring_result result = MSPRING_OK;
    for (size_t s = 0; result == MSPRING_OK && s < builder->limit_count; ++s)
        result = mspringi_limits_reserve(network, builder->limits[s]);
    if (result == MSPRING_OK)
        result = mspringi_metres_reserve(network, flags);
    const size_t count = network->metres ? builder->spring_count : builder->limit_count;
    for (size_t s = 0; result == MSPRING_OK && s < count; ++s)
        mspringi_limits_put(network, (mspring_id)s, builder->springs[s].flags,
                            mspringi_builder_limits_of(builder, s));
    return result;
}

/* -------------------------------------------------------------------------------------------------- lifecycle */

// Lay out the builder's particles, which in an archive's network lie where the archived layout had them.
static mspring_result lay_out(mspring_network *network, const mspring_builder *builder,
                              const mspringi_reserve *reserve, const mspringi_solver_ops *solver) {
    mspring_builder placed = *builder;
    mspring_result result = MSPRING_OK;
    if (builder->archive)
        result = builder->archive_calls->lay_out(builder, &network->memory, &network->message, &placed);
    if (result == MSPRING_OK)
        result = mspringi_topology_create(&network->topology, &placed, reserve,
                                          builder->archive ? builder->archive_calls->may_have_bundles(builder)
                                                           : solver && solver->has_bundles,
                                          mspringi_tasks_partition_size(network->tasks), network->kernels->lanes,
                                          &network->memory, &network->message);
    if (builder->archive)
        mspringi_free(&network->memory, placed.particles);
    return builder->archive ? builder->archive_calls->blame(&network->message, result, "plan") : result;
}

// Fill a network whose memory is initialised. Its message describes a failure.
static MSPRINGI_NOINLINE mspring_result fill(mspring_network *network, const mspring_builder *builder,
                                             const mspring_network_def *def) {
    mspringi_reserve reserve = {0};
    network->solver.ops = mspringi_solver_ops_of(MSPRING_SOLVER_EXPLICIT);
    network->kernels = mspringi_kernels_of(mspringi_cpu_choose(def->simd_level));
    mspring_result result = mspringi_shared_reserve(network);
    if (result != MSPRING_OK)
        return result;
    result = mspringi_tasks_create(def->worker_count, def->tasks, &network->tasks_memory, &network->message,
                                   &network->tasks);
    if (result == MSPRING_OK)
        result = make_reserve(&reserve, builder, def, &network->message);
    if (result == MSPRING_OK)
        // An unknown solver has no operations: rejected below.
        result = lay_out(network, builder, &reserve, mspringi_solver_ops_of(def->settings.solver));
    if (result != MSPRING_OK)
        return result;
    if (def->simd_level == MSPRING_SIMD_AUTO)
        network->kernels = mspringi_kernels_of(mspringi_choose_level(&network->topology, network->kernels->level));
    const spring_needs needs = check_springs(builder);
    const bool damped = needs.damping || (def->flags & MSPRING_NETWORK_RESERVE_DAMPING),
               relative =
                   (needs.flags & MSPRING_SPRING_RELATIVE) || (def->flags & MSPRING_NETWORK_RESERVE_RELATIVE);
    network->parts = damped ? MSPRINGI_DAMPING + 1 : MSPRINGI_STIFFNESS + 1;
    network->is_precise = def->flags & MSPRING_NETWORK_PRECISE;
    network->keeps_poses = def->flags & MSPRING_NETWORK_POSES;
    result = allocate(network);
    if (result == MSPRING_OK && relative)
        result = mspringi_fractions_create(&network->fractions, builder, reserve.spring_end, &network->memory,
                                           &network->message);
    if (result == MSPRING_OK)
        result = mspringi_rest_lengths_create(&network->rest_lengths, &network->topology, builder, &network->memory,
                                              &network->message);
    if (result != MSPRING_OK)
        return result;
    network->settings = def->settings;
    if (def->settings.sleep_speed > 0.0f)
        result = mspringi_sleep_reserve(network);
    if (result == MSPRING_OK && needs.reversed)
        result = mark_reversed(network, builder);
    if (result != MSPRING_OK)
        return result;
    network->guard.speed = network->guard.coordinate = INFINITY; // unknown
    network->steps.outcome = mspringi_outcome_none();
    network->steps.lag = builder->lag;
    fill_springs(network, builder); // before places, which are rounded to the grid that rest lengths give
    fill_particles(network, builder);
    for (mspring_id p = network->topology.particle_count; p < network->topology.reserve.particle_end; ++p)
        network->mass[p] = 1.0f;
    if (def->spare_particles > 0 || def->spare_springs > 0)
        result = mspringi_id_pool_reserve(network);
    if (result != MSPRING_OK)
        return result;
    result = check_features(network, builder);
    if (result == MSPRING_OK && (needs.flags & MSPRINGI_ONE_WAY_FLAGS)) // before the implicit solver's tiles
        result = set_sides(network, builder);
    if (result == MSPRING_OK)
        result = mspring_network_set_settings(network, &def->settings);
    if (result == MSPRING_OK)
        result = mspringi_guard_reserve(network, def->settings.guard);
    if (result == MSPRING_OK)
        result = set_limits(network, builder, needs.flags);
    if (result == MSPRING_OK && !relative) // else the first step derives all records
        mspringi_shared_records_find(network);
    if (result == MSPRING_OK)
        result = mspringi_features_create(network, builder);
    if (result == MSPRING_OK && network->guard_scratch && network->solver.ops->has_stability_limit)
        mspringi_stability_limit_adapt(network);
    return result;
}

mspring_result mspring_network_create(mspring_builder *builder, const mspring_network_def *def,
                                      mspring_network **network) {
    mspring_network_def taken, archived;
    mspringi_memory memory;
    const mspring_network_def *wanted = NULL;
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_message *message = &builder->message;
    if (builder->failed != MSPRING_OK)
        return builder->failed;
    mspringi_message_clear(message);
    if (!network)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "network is NULL");
    const bool is_given = def != NULL;
    mspring_result result = check_def(&def, &taken, message);
    if (result == MSPRING_OK && builder->archive) {
        wanted = is_given ? def : NULL;
        def = &archived;
        result = builder->archive_calls->take_def(builder, wanted, &archived);
    }
    if (result != MSPRING_OK)
        return result;
    if (builder->particle_count == 0)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the builder has no particle");
    result = mspringi_memory_init(&memory, def->allocator, message);
    if (result != MSPRING_OK)
        return result;
    mspring_network *created = mspringi_alloc(&memory, 1, sizeof *created);
    if (!created)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for a network");
    created->memory = memory;
    created->tasks_memory = (mspringi_memory){.allocator = memory.allocator};
    const mspringi_fp_state before = mspringi_fp_enter();
    result = fill(created, builder, def);
    if (result == MSPRING_OK && builder->archive)
        result = builder->archive_calls->resume(created, builder, wanted);
    mspringi_fp_leave(before);
    if (result != MSPRING_OK) {
        *message = created->message;
        mspring_network_destroy(created);
        return result;
    }
    mspringi_network_own_tasks(created, def->tasks);
    *network = created;
    return MSPRING_OK;
}

void mspringi_network_own_tasks(mspring_network *network, const mspring_tasks *tasks) {
    mspring_tasks taken;
    network->release_tasks = NULL;
    if (tasks && mspringi_take_tasks(NULL, &tasks, &taken) == MSPRING_OK) {
        network->release_tasks = taken.release;
        network->tasks_user = taken.user;
    }
}

void mspring_network_destroy(mspring_network *network) {
    if (!network)
        return;
#define ENDS(function) function(network);
#include "store/features.def"
    mspringi_memory memory = network->memory, tasks_memory = network->tasks_memory;
    void(MSPRING_CALL * release)(void *user) = network->release_tasks;
    void *user = network->tasks_user;
    mspringi_tasks_destroy(network->tasks, &tasks_memory);
    mspringi_free_all(&tasks_memory);
    mspringi_job_invalidate(network);
    mspringi_free_all(&memory);
    if (release)
        release(user);
}

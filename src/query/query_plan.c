/// Queries about a network: its sizes, its error, its last step, and its layout.
#include <math.h>

#include "solvers/explicit/explicit.h"
#include "store/id_pool.h"
#include "store/network.h"

const char *mspring_network_error(const mspring_network *network) {
    const char *shared = network ? mspringi_shared_text(network->shared) : "";
    return shared[0] || !network ? shared : network->message.text;
}

uint32_t mspring_network_particle_count(const mspring_network *network) {
    return network ? network->topology.particle_count : 0;
}

uint32_t mspring_network_spring_count(const mspring_network *network) {
    return network ? network->topology.spring_count : 0;
}

mspring_simd mspring_network_simd_level(const mspring_network *network) {
    return network ? network->kernels->level : MSPRING_SIMD_AUTO;
}

uint32_t mspring_network_worker_count(const mspring_network *network) {
    return network ? mspringi_tasks_workers(network->tasks) : 0;
}

size_t mspring_network_memory_used(const mspring_network *network) {
    return network ? network->memory.used + network->tasks_memory.used : 0;
}

static double largest_speed(const mspring_network *network) {
    const mspringi_state *s = &network->state;
    double largest = 0.0;
    for (mspring_id p = 0; p < network->topology.particle_count; ++p) {
        const uint32_t slot = network->topology.slot_of_particle[p];
        const double vx = (double)s->vx[slot], vy = (double)s->vy[slot], square = vx * vx + vy * vy;
        if (square > largest && mspringi_particle_exists(network, p))
            largest = square;
    }
    return sqrt(largest);
}

mspring_result mspring_network_get_step_info(const mspring_network *network, mspring_step_info *info) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_step_info, info);
    if (result != MSPRING_OK)
        return result;
    const mspringi_steps *steps = &network->steps;
    const mspring_step_info made = {
        .result = steps->result,
        .particle = steps->outcome.particle,
        .spring = steps->outcome.spring,
        .flags = steps->outcome.flags,
        .substeps = steps->substeps,
        .step_count = steps->count,
        .fallback_count = steps->fallback_count,
        .time = steps->time,
        .time_left = steps->pace.left,
        .work = steps->outcome.work,
        .largest_speed = largest_speed(network),
    };
    mspringi_put_step_info(info, &made);
    return MSPRING_OK;
}

mspring_result mspring_network_get_plan(const mspring_network *network, mspring_plan *plan) {
    const mspring_result result = mspringi_check_report(network, &mspringi_struct_plan, plan);
    if (result != MSPRING_OK)
        return result;
    const mspringi_topology *t = &network->topology;
    mspring_plan made = {
        .particle_count = t->particle_count,
        .spring_count = t->spring_count,
        .lattice_count = t->lattice_count,
        .lattice_particles = t->lattice_particles,
        .lattice_springs = t->lattice_springs,
        .lattice_rows = t->lattice_rows,
        .lattice_blocks = t->lattice_blocks,
        .chain_count = t->chain_count,
        .chain_particles = t->chain_particles,
        .chain_springs = t->chain_springs,
        .irregular_particles = t->irregular_particles,
        .loose_particles = t->loose_particles + mspringi_id_pool_added_particles(network),
        .irregular_springs = t->laid_out_count + mspringi_id_pool_added_springs(network),
        .pass_rows = t->wavefront_rows,
        .pass_lag = t->skew,
        .pass_substeps = network->depth,
        .slot_count = (uint32_t)mspringi_slot_count(network),
        .block_width = MSPRINGI_WIDTH,
        .has_damping = network->parts > MSPRINGI_DAMPING,
        .has_relative = network->fractions.values != NULL,
        .simd_level = network->kernels->level,
        .irregular_layers = t->tier_count,
        .pass_workers = mspringi_explicit_workers(network),
    };
    if (network->solver.ops->describe)
        network->solver.ops->describe(network->solver.object, &made);
    mspringi_put_plan(plan, &made);
    return MSPRING_OK;
}

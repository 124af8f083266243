/// How a network is laid out and solved.
#include "solvers/explicit/explicit.h"
#include "store/id_pool.h"
#include "store/network.h"

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

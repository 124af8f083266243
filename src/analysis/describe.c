/// How a network is laid out and solved.
#include <math.h>

#include "solvers/explicit/explicit.h"
#include "store/id_pool.h"
#include "store/network.h"
#include "store/plan.h"

static mspringi_plan plan_of(const mspring_network *network) {
    const mspringi_topology *t = &network->topology;
    mspringi_plan made = {
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
    return made;
}

// A text of which as much is written as fits.
typedef struct sheet {
    char *text;
    size_t capacity, size;
} sheet;

static void add_line(sheet *to, const char *name, double value) {
    mspringi_message line; // long enough: names are short
    if (value >= 0.0 && value <= UINT32_MAX && value == floor(value))
        (void)mspringi_fail(&line, MSPRING_OK, "%s %u\n", name, (unsigned)value);
    else
        (void)mspringi_fail(&line, MSPRING_OK, "%s %g\n", name, value);
    for (const char *c = line.text; *c; ++c, ++to->size)
        if (to->size + 1 < to->capacity)
            to->text[to->size] = *c;
}

mspring_result mspring_network_describe(const mspring_network *network, char *text, size_t capacity, size_t *size) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    if (!text && capacity > 0)
        return mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT, "the place for the text is NULL");
    const mspringi_plan plan = plan_of(network);
    sheet to = {text, capacity, 0};
#define LINE(name) add_line(&to, #name, (double)plan.name);
    LINE(particle_count)
    LINE(spring_count)
    LINE(lattice_count)
    LINE(lattice_particles)
    LINE(lattice_springs)
    LINE(lattice_rows)
    LINE(lattice_blocks)
    LINE(chain_count)
    LINE(chain_particles)
    LINE(chain_springs)
    LINE(irregular_particles)
    LINE(loose_particles)
    LINE(irregular_springs)
    LINE(pass_rows)
    LINE(pass_lag)
    LINE(pass_substeps)
    LINE(slot_count)
    LINE(block_width)
    LINE(has_damping)
    LINE(has_relative)
    LINE(simd_level)
    LINE(solver)
    LINE(integrator)
    LINE(iterations)
    LINE(tile_size)
    LINE(tile_count)
    LINE(coarse_values)
    LINE(coarse_period)
    LINE(irregular_layers)
    LINE(factor_values)
    LINE(factor_products)
    LINE(pass_workers)
    LINE(residual)
    if (capacity > 0)
        text[to.size < capacity ? to.size : capacity - 1] = 0;
    if (size)
        *size = to.size + 1;
    return MSPRING_OK;
}

/// Making networks that are added to.
#include "growth.h"

#include <stdlib.h>

#include "support.h"

recipe growth_recipe(void) {
    uint64_t seed = 5;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {20, 60}, .damping = {0, 0.1}, .holes = 0.1};
    recipe made = {0};
    recipe_lattice(&made, 19, 7, 0, 0, 1, &stuff, &seed);
    const mspring_id end = recipe_particle(&made, 30, 12, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 2, end, 15, &stuff, &seed);
    const mspring_id from = recipe_particle(&made, -10, 3, 1, 0), to = recipe_particle(&made, -10, 12, 1, 0);
    recipe_rope(&made, from, to, 9, &stuff, &seed);
    const mspring_id first = made.particle_count;
    for (int i = 0; i < 20; i++) {
        const double x = support_random_between(&seed, -9, -3), y = support_random_between(&seed, -9, -3);
        recipe_particle(&made, x, y, 1, 0);
    }
    for (uint32_t i = 0; i < 20; i++) {
        recipe_spring(&made, first + i, first + (i + 1) % 20, 30, 0.1, 0);
        recipe_spring(&made, first + i, first + (i + 3) % 20, 30, 0.1, 0);
    }
    for (int i = 0; i < 21; i++) {
        recipe_particle(&made, i, 20, 1, 0);
    }
    recipe_disturb(&made, 0.05, 0.5, &seed);
    return made;
}

mspring_network *growth_network(const recipe *made, mspring_simd level, uint32_t workers) {
    mspring_network_def def = support_def(-9.8f, 4);
    def.simd_level = level;
    def.worker_count = workers;
    def.spare_particles = SPARE_PARTICLES;
    def.spare_springs = SPARE_SPRINGS;
    return recipe_network(made, &def);
}

life *growth_begin(const recipe *made, mspring_simd level, uint32_t workers, uint64_t seed) {
    life *it = malloc(sizeof *it);
    assert_non_null(it);
    life_begin(it, made, growth_network(made, level, workers), SPARE_PARTICLES, SPARE_SPRINGS, seed);
    return it;
}

void growth_end(life *it) {
    mspring_network_destroy(it->network);
    free(it);
}

void growth_use(mspring_network *network, mspring_solver solver, mspring_integrator integrator,
                uint32_t iterations) {
    mspring_settings def;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def));
    def.solver = solver;
    def.integrator = integrator;
    def.iterations = iterations;
    def.substeps = 2;
    check_ok(support_set_solver(network, &def));
}

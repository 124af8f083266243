#include "wrecks.h"

#include <math.h>

#include "support.h"

recipe wrecks_recipe(void) {
    uint64_t seed = 5;
    const recipe_stuff relative = {.mass = {1, 2},
                                   .stiffness = {0.1, 0.2},
                                   .damping = {0, 0.05},
                                   .spring_flags = MSPRING_SPRING_RELATIVE,
                                   .pinned = 0.02,
                                   .holes = 0.1};
    const recipe_stuff absolute = {.mass = {1, 2}, .stiffness = {50, 100}, .damping = {0, 1}};
    recipe made = {0};
    recipe_lattice(&made, 45, 14, 0, 0, 1, &relative, &seed);
    const mspring_id other = recipe_lattice(&made, 9, 30, 60, 0.5, 1, &absolute, &seed);
    recipe_rope(&made, 2, other, 20, &absolute, &seed);
    recipe_random_springs(&made, 25, &absolute, &seed);
    recipe_particle(&made, 5, 40, 1, 0);
    recipe_disturb(&made, 0.05, 0.5, &seed);
    return made;
}

mspring_network *wrecks_network(const recipe *made, mspring_simd level, uint32_t worker_count) {
    mspring_network_def def = support_def(-9.8f, 4);
    def.simd_level = level;
    def.worker_count = worker_count;
    def.settings.global_damping = 0.1f;
    return recipe_network(made, &def);
}

bool wrecks_breaks(const recipe *made, wreck kind, mspring_id s) {
    const mspring_particle_def *a = &made->particles[made->springs[s].a], *b = &made->particles[made->springs[s].b];
    uint64_t seed = s;
    if (kind == SHATTERED) {
        return support_random(&seed) % 10 != 0;
    }
    return kind == DISSOLVED || floor(a->x / 11) != floor(b->x / 11) || fmod(a->y, 16) > 12;
}

void wrecks_make(mspring_network *network, const recipe *made, wreck kind) {
    for (mspring_id s = 0; s < made->spring_count; s++) {
        if (wrecks_breaks(made, kind, s)) {
            check_ok(mspring_network_break_springs(network, &s, 0, 1));
        }
    }
}

support_plan wrecks_plan(const mspring_network *network) {
    support_plan plan;
    check_ok(support_get_plan(network, &plan));
    return plan;
}

uint32_t wrecks_swept(const mspring_network *network) {
    const support_plan plan = wrecks_plan(network);
    return plan.lattice_springs + plan.chain_springs + plan.irregular_springs;
}

void wrecks_set_solver(mspring_network *network, mspring_solver which, mspring_integrator integrator) {
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = which;
    solver.integrator = integrator;
    solver.substeps = 2;
    solver.iterations = 60;
    check_ok(support_set_solver(network, &solver));
}

static void push(const mspring_hook_args *args, void *user) {
    (void)user;
    for (uint32_t slot = args->first_slot; slot < args->first_slot + args->slot_count; slot++) {
        args->force_x[slot] += 2 + args->y[slot] * 0.01f;
    }
}

static void add_pushing_hook(mspring_network *network) {
    mspring_hook_def hook;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &hook, sizeof hook));
    hook.phase = MSPRING_PHASE_BEFORE_SUBSTEP;
    hook.fn = push;
    hook.period = 2;
    hook.flags = MSPRING_HOOK_CONCURRENT;
    check_ok(mspring_network_add_hook(network, &hook, NULL));
}

void wrecks_set_up(mspring_network *network, int run) {
    const double plane[4] = {0, -2, 0, 1};
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    def.planes = plane;
    def.plane_count = 1;
    def.friction = 0.3f;
    check_ok(mspring_network_set_floor(network, &def));
    if (run % 2 == 1) {
        add_pushing_hook(network);
    }
    if (run >= 2) {
        wrecks_set_solver(network, run < 5 ? MSPRING_SOLVER_IMPLICIT : MSPRING_SOLVER_DIRECT,
                          run % 3 == 0   ? MSPRING_INTEGRATOR_BDF2
                          : run % 3 == 1 ? MSPRING_INTEGRATOR_EULER
                                         : MSPRING_INTEGRATOR_ALPHA);
    }
}

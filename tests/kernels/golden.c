/// @file golden.c
///
/// SPDX-License-Identifier: MIT
#include "golden.h"

#include "level.h"
#include "recipe.h"
#include "scenes/scene.h"
#include "support.h"

/// Take over a scene that its maker has filled.
static mspring_network *network_of(bool made, scene *made_scene, const scene_error *error,
                                   const mspring_network_def *def) {
    if (!made) {
        print_error("%s\n", error->text);
    }
    assert_true(made);
    mspring_network *network = NULL;
    check_ok(mspring_network_create(made_scene->builder, def, &network));
    scene_free(made_scene);
    return network;
}

static mspring_network *bar_80x5(mspring_network_def *def) {
    scene made;
    scene_error error;
    scene_options options = scene_options_default();
    return network_of(scene_bar(80, 5, &options, &made, &error), &made, &error, def);
}

static mspring_network *bar_544x68(mspring_network_def *def) {
    scene made;
    scene_error error;
    scene_options options = scene_options_default();
    return network_of(scene_bar(544, 68, &options, &made, &error), &made, &error, def);
}

static mspring_network *bar_standing_damped(mspring_network_def *def) {
    scene made;
    scene_error error;
    scene_options options = scene_options_default();
    options.damping = 5000;
    options.spacing = 0.7;
    def->settings.gravity_x = 3;
    return network_of(scene_bar(6, 90, &options, &made, &error), &made, &error, def);
}

static mspring_network *bar_relative(mspring_network_def *def) {
    scene made;
    scene_error error;
    scene_options options = scene_options_default();
    options.relative = true;
    options.stiffness = 0.5f;
    options.damping = 0.03f;
    return network_of(scene_bar(50, 9, &options, &made, &error), &made, &error, def);
}

static mspring_network *bar_with_ropes(mspring_network_def *def) {
    scene made;
    scene_error error;
    scene_options options = scene_options_default();
    options.damping = 100;
    bool ok = scene_bar(100, 20, &options, &made, &error) && scene_add_ropes(&made, 12, 15, 5, &options, &error);
    return network_of(ok, &made, &error, def);
}

static mspring_network *rope(mspring_network_def *def) {
    scene made;
    scene_error error;
    scene_options options = scene_options_default();
    def->settings.global_damping = 0.3f;
    return network_of(scene_rope(201, &options, &made, &error), &made, &error, def);
}

static mspring_network *graph(mspring_network_def *def) {
    scene made;
    scene_error error;
    scene_options options = scene_options_default();
    options.damping = 50;
    return network_of(scene_random_graph(1000, 8, 3, &options, &made, &error), &made, &error, def);
}

#if defined(GOLDEN_IMAGES)
static mspring_network *ship(mspring_network_def *def) {
    scene made;
    scene_error error;
    scene_materials materials = {0};
    scene_options options = scene_options_from_file(), of_ropes = scene_options_default();
    of_ropes.damping = 200;
    bool ok = scene_materials_read(GOLDEN_IMAGES "/ship_materials.csv", &materials, &error) &&
              scene_image(GOLDEN_IMAGES "/ship.png", &materials, &options, &made, &error) &&
              scene_add_ropes(&made, 40, 30, 9, &of_ropes, &error);
    scene_materials_free(&materials);
    return network_of(ok, &made, &error, def);
}
#else
#define ship NULL // no PNG in this build
#endif

/// Two lattices with holes and pins, ropes between them, springs across, loose particles; all of it shuffled.
static recipe everything(void) {
    uint64_t seed = 2026;
    const recipe_stuff stuff = {
        .mass = {0.5, 2}, .stiffness = {2000, 8000}, .damping = {0, 20}, .pinned = 0.02, .holes = 0.25};
    recipe made = {0};
    mspring_id a = recipe_lattice(&made, 45, 21, 0, 0, 1, &stuff, &seed);
    mspring_id b = recipe_lattice(&made, 13, 33, 60, -5, 0.625, &stuff, &seed);
    recipe_rope(&made, a + 3, b + 7, 64, &stuff, &seed);
    recipe_rope(&made, a + 100, b + 20, 31, &stuff, &seed);
    recipe_random_springs(&made, 40, &stuff, &seed);
    for (int i = 0; i < 21; i++) {
        recipe_particle(&made, i, -10, 1 + i, i == 3 ? MSPRING_PARTICLE_PINNED : 0);
    }
    recipe_disturb(&made, 0.05, 2, &seed);
    recipe_shuffle(&made, &seed, NULL);
    return made;
}

static mspring_network *everything_damped(mspring_network_def *def) {
    recipe made = everything();
    def->settings.gravity_x = -1.5f;
    def->settings.global_damping = 0.1f;
    mspring_network *network = recipe_network(&made, def);
    recipe_free(&made);
    return network;
}

static mspring_network *precise_bar(mspring_network_def *def) {
    def->flags = MSPRING_NETWORK_PRECISE;
    return bar_544x68(def);
}

static mspring_network *precise_graph(mspring_network_def *def) {
    scene made;
    scene_error error;
    scene_options options = scene_options_default();
    def->flags = MSPRING_NETWORK_PRECISE;
    return network_of(scene_random_graph(1000, 8, 3, &options, &made, &error), &made, &error, def);
}

static mspring_network *precise_everything(mspring_network_def *def) {
    def->flags = MSPRING_NETWORK_PRECISE;
    return everything_damped(def);
}

static void push_some(mspring_network *network, uint32_t step) {
    for (mspring_id id = step % 7; id < mspring_network_count(network, MSPRING_PARTICLES); id += 50) {
        check_ok(mspring_network_apply_force(network, id, 25, 300));
    }
}

/// Flies at several hundred m/s, so that the origin comes along.
static mspring_network *everything_flying(mspring_network_def *def) {
    recipe made = everything();
    for (uint32_t i = 0; i < made.particle_count; i++) {
        made.particles[i].flags = 0;
        made.particles[i].vx += 500;
        made.particles[i].vy -= 321;
    }
    def->settings.gravity_y = 0;
    mspring_network *network = recipe_network(&made, def);
    recipe_free(&made);
    return network;
}

static mspring_network *implicit_bar(mspring_network_def *def) {
    def->settings.solver = MSPRING_SOLVER_IMPLICIT;
    return bar_80x5(def);
}

static mspring_network *implicit_ropes(mspring_network_def *def) {
    def->settings.solver = MSPRING_SOLVER_IMPLICIT;
    return bar_with_ropes(def);
}

static mspring_network *implicit_graph(mspring_network_def *def) {
    def->settings.solver = MSPRING_SOLVER_IMPLICIT;
    return graph(def);
}

static mspring_network *direct_bar(mspring_network_def *def) {
    def->settings.solver = MSPRING_SOLVER_DIRECT;
    return bar_80x5(def);
}

static mspring_network *direct_ropes(mspring_network_def *def) {
    def->settings.solver = MSPRING_SOLVER_DIRECT;
    return bar_with_ropes(def);
}

/// Everything, with all integrators in turn.
static void push_and_use(mspring_network *network, uint32_t step, mspring_solver kind) {
    push_some(network, step);
    if (step % 10 != 0) {
        return;
    }
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    solver.solver = step / 10 % 4 == 3 ? MSPRING_SOLVER_EXPLICIT : kind;
    solver.substeps = step / 10 % 4 == 3 ? 4 : 1;
    solver.integrator = (mspring_integrator)(step / 10 % 4 % 3);
    check_ok(support_set_solver(network, &solver));
}

static void push_and_change_solver(mspring_network *network, uint32_t step) {
    push_and_use(network, step, MSPRING_SOLVER_IMPLICIT);
}

/// The same with the direct solver, with and without a spring that is too stiff for single precision.
static void push_and_solve_directly(mspring_network *network, uint32_t step) {
    push_and_use(network, step, MSPRING_SOLVER_DIRECT);
    const float stiffness = step / 10 % 4 != 3 && step % 2 == 1 ? 1e9f : 1e3f;
    check_ok(mspring_network_set(network, MSPRING_STIFFNESS, NULL, 7, 1, &stiffness, 1));
}

/// Blocks, a rope and a loose particle that fall onto pinned ground, and onto each other.
static mspring_network *contact(mspring_network_def *def) {
    const recipe_stuff stuff = {.mass = {3, 5}, .stiffness = {20000, 30000}, .damping = {5, 20}};
    const recipe_stuff pinned = {.mass = {1, 1}, .stiffness = {1000, 1000}, .pinned = 1};
    uint64_t seed = 12;
    recipe made = {0};
    recipe_lattice(&made, 40, 1, -10, -1, 1, &pinned, &seed);
    recipe_lattice(&made, 12, 5, 0, 0.25, 1, &stuff, &seed);
    recipe_lattice(&made, 7, 4, 4.3, 6.5, 1, &stuff, &seed);
    const mspring_id from = recipe_particle(&made, -6, 7, 2, 0), to = recipe_particle(&made, 8.5, 12, 2, 0);
    recipe_rope(&made, from, to, 15, &stuff, &seed);
    recipe_particle(&made, 2.5, 9, 6, 0);
    mspring_network *network = recipe_network(&made, def);
    recipe_free(&made);
    mspring_contact_def touching;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &touching, sizeof touching));
    touching.thickness = 0.4;
    touching.friction = 0.5f;
    touching.restitution = 0.3f;
    check_ok(mspring_network_set_contact(network, &touching));
    return network;
}

/// The same with a basin, a paddle that turns and a circle that swings to and fro.
static mspring_network *colliders(mspring_network_def *def) {
    static const double basin[8] = {-12, 9, -9, 1, 10, 1.5, 13, 9};
    mspring_network *network = contact(def);
    mspring_collider_def def_of[3];
    for (int i = 0; i < 3; i++) {
        check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def_of[i], sizeof def_of[i]));
        def_of[i].kind = (mspring_collider_kind)i;
        def_of[i].friction = 0.4f;
        def_of[i].restitution = 0.25f;
    }
    def_of[0].points = basin, def_of[0].point_count = 4, def_of[0].radius = 0.1;
    def_of[1].width = 5, def_of[1].height = 0.5, def_of[1].x = -3, def_of[1].y = 5;
    def_of[2].radius = 0.75, def_of[2].x = 7, def_of[2].y = 3;
    for (mspring_id i = 0; i < 3; i++)
        check_ok(mspring_network_add_collider(network, &def_of[i], NULL));
    return network;
}

static mspring_network *implicit_contact(mspring_network_def *def) {
    def->settings.solver = MSPRING_SOLVER_IMPLICIT;
    return colliders(def);
}

static mspring_network *direct_contact(mspring_network_def *def) {
    def->settings.solver = MSPRING_SOLVER_DIRECT;
    return colliders(def);
}

static void move_colliders(mspring_network *network, uint32_t step) {
    const double swing = step % 64 < 32 ? step % 32 / 8.0 : 4 - step % 32 / 8.0;
    check_ok(mspring_network_move_collider(network, 1, -3, 5, (step + 1) / 16.0));
    check_ok(mspring_network_move_collider(network, 2, 7 - swing, 3, -(double)step / 8));
}

/// Lattice, ropes and irregular springs that yield; some harden, and some come to their limit.
static mspring_network *yielding(mspring_network_def *def) {
    static const float yield_strains[2] = {0.01f, 0.04f}, hardenings[3] = {0, 0.1f, 1}, limit = 0.1f;
    mspring_network *network = everything_damped(def);
    const uint32_t count = mspring_network_count(network, MSPRING_SPRINGS);
    for (mspring_id s = 0; s < count; s++) {
        check_ok(mspring_network_set(network, MSPRING_YIELD_STRAIN, NULL, s, 1, &yield_strains[s % 2], 1));
        check_ok(mspring_network_set(network, MSPRING_HARDENING, NULL, s, 1, &hardenings[s % 3], 1));
    }
    check_ok(mspring_network_set(network, MSPRING_PLASTIC_LIMIT, NULL, 0, count, &limit, 0));
    return network;
}

/// A lattice alone, whose springs yield within the sweeps.
static mspring_network *yielding_rows(mspring_network_def *def) {
    const recipe_stuff stuff = {
        .mass = {1, 2}, .stiffness = {2000, 3000}, .damping = {1, 3}, .pinned = 0.02, .holes = 0.1};
    const float yield_strain = 0.03f;
    uint64_t seed = 2027;
    recipe made = {0};
    recipe_lattice(&made, 70, 40, 0, 0, 1, &stuff, &seed);
    recipe_disturb(&made, 0.02, 3, &seed);
    mspring_network *network = recipe_network(&made, def);
    recipe_free(&made);
    check_ok(mspring_network_set(network, MSPRING_YIELD_STRAIN, NULL, 0, mspring_network_count(network, MSPRING_SPRINGS), &yield_strain, 0));
    return network;
}

/// Cloth, rope and irregular springs that only pull.
static mspring_network *one_way(mspring_network_def *def) {
    const recipe_stuff stuff = {.mass = {1, 2},
                                .stiffness = {2000, 3000},
                                .damping = {1, 3},
                                .spring_flags = MSPRING_SPRING_PULL_ONLY,
                                .pinned = 0.05};
    uint64_t seed = 2028;
    recipe made = {0};
    const mspring_id first = recipe_lattice(&made, 30, 20, 0, 0, 1, &stuff, &seed);
    const mspring_id other = recipe_lattice(&made, 10, 10, 40, 0, 1, &stuff, &seed);
    recipe_rope(&made, first + 5, other + 9, 40, &stuff, &seed);
    recipe_random_springs(&made, 20, &stuff, &seed);
    recipe_disturb(&made, 0.02, 1, &seed);
    mspring_network *network = recipe_network(&made, def);
    recipe_free(&made);
    return network;
}

/// The same springs with areas: cells in the sweeps.
static mspring_network *areas(mspring_network_def *def) {
    mspring_network *network = everything_damped(def);
    mspring_area_def area;
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area));
    area.stiffness = 20;
    check_ok(mspring_network_add_cell_areas(network, &area, NULL, NULL));
    return network;
}

static mspring_network *precise_areas(mspring_network_def *def) {
    def->flags = MSPRING_NETWORK_PRECISE;
    return areas(def);
}

/// And a gas, which no sweep has in it.
static mspring_network *all_areas(mspring_network_def *def) {
    static const mspring_id corners[5] = {0, 3, 40, 41, 90};
    mspring_network *network = areas(def);
    mspring_area_def area;
    check_ok(mspring_init(MSPRING_STRUCT_AREA_DEF, &area, sizeof area));
    area.kind = MSPRING_AREA_GAS;
    area.pressure = 3;
    check_ok(mspring_network_add_area(network, &area, corners, 5, NULL));
    return network;
}

/// And angles along the rope, which bend in steps.
static mspring_network *angles(mspring_network_def *def) {
    mspring_network *network = areas(def);
    mspring_angle_def hinge;
    check_ok(mspring_init(MSPRING_STRUCT_ANGLE_DEF, &hinge, sizeof hinge));
    hinge.stiffness = 3;
    hinge.damping = 0.01f;
    for (mspring_id p = 702; p < 730; p++) {
        const mspring_id three[3] = {p, p + 1, p + 2};
        check_ok(mspring_network_add_angles(network, &hinge, three, 1, 3, NULL));
    }
    return network;
}

static void push_and_bend(mspring_network *network, uint32_t step) {
    static const double bends[] = {0.3, -0.2, 1.7};
    push_some(network, step);
    support_angle_info info;
    mspring_id first = 0;
    while (support_get_angle_info(network, first, &info) != MSPRING_OK)
        first++;
    check_ok(support_set_rest_angles(network, first, 28, &bends[step % 3], 0));
}

/// Blocks, a rope and a loose particle that fall into a valley of heights with a wall, silt above one part of it.
static mspring_network *on_floor(mspring_network_def *def) {
    static const float heights[] = {4, 0.5f, -1, -0.5f, -1.5f, 0, 1, 5};
    static const float frictions[] = {0.9f, 0.2f, 0, 0.5f, 1, 0.4f, 0.1f};
    static const double wall[] = {-9, 0, 1, 0.2};
    mspring_network *network = contact(def);
    mspring_floor_def ground;
    check_ok(mspring_network_set_contact(network, NULL));
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &ground, sizeof ground));
    ground.heights_x = -12;
    ground.heights_y = -1.5;
    ground.spacing = 4;
    ground.heights = heights;
    ground.height_count = COUNT_OF(heights);
    ground.height_frictions = frictions;
    ground.planes = wall;
    ground.plane_count = 1;
    ground.friction = 0.3f;
    ground.restitution = 0.4f;
    ground.silt_depth = 0.5f;
    ground.silt_rate = 3;
    check_ok(mspring_network_set_floor(network, &ground));
    return network;
}

static mspring_network *implicit_floor(mspring_network_def *def) {
    def->settings.solver = MSPRING_SOLVER_IMPLICIT;
    return on_floor(def);
}

static mspring_network *direct_floor(mspring_network_def *def) {
    def->settings.solver = MSPRING_SOLVER_DIRECT;
    return on_floor(def);
}

/// Everything, held by grips: two on one particle, one of them bounded, one on a rope.
static mspring_network *grips(mspring_network_def *def) {
    static const float stiffnesses[] = {3000, 2e4f, 500, 1e6f}, bounds[] = {800, MSPRING_NEVER, 50, 4000};
    static const mspring_id particles[] = {40, 40, 715, 300};
    mspring_network *network = everything_damped(def);
    for (int i = 0; i < 4; i++) {
        mspring_grip_def grip;
        double x, y;
        check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &grip, sizeof grip));
        check_ok(mspring_network_get_positions(network, NULL, particles[i], 1, &x, &y, 1));
        grip.particle = particles[i];
        grip.x = x + 0.5;
        grip.y = y + 2.0 - i;
        grip.stiffness = stiffnesses[i];
        grip.damping = 0.02f * stiffnesses[i];
        grip.max_force = bounds[i];
        check_ok(mspring_network_add_grip(network, &grip, NULL));
    }
    return network;
}

static void push_and_drag(mspring_network *network, uint32_t step) {
    push_some(network, step);
    check_ok(mspring_network_move_grip(network, step % 4, 0.1 * step, 5 - 0.2 * (step % 11)));
}

static mspring_network *implicit_grips(mspring_network_def *def) {
    def->settings.solver = MSPRING_SOLVER_IMPLICIT;
    return grips(def);
}

static mspring_network *direct_grips(mspring_network_def *def) {
    def->settings.solver = MSPRING_SOLVER_DIRECT;
    return grips(def);
}

static mspring_network *implicit_angles(mspring_network_def *def) {
    def->settings.solver = MSPRING_SOLVER_IMPLICIT;
    return angles(def);
}

static mspring_network *direct_angles(mspring_network_def *def) {
    def->settings.solver = MSPRING_SOLVER_DIRECT;
    return angles(def);
}

const golden_scene golden_scenes[] = {
    {"bar_80x5", bar_80x5, NULL, 30, 64, 1.0 / 64, false},
    {"bar_544x68", bar_544x68, NULL, 30, 3, 1.0 / 64, true},
    {"bar_standing_damped", bar_standing_damped, NULL, 31, 50, 1.0 / 60, false},
    {"bar_relative", bar_relative, NULL, 7, 100, 0.017, false},
    {"bar_with_ropes", bar_with_ropes, NULL, 40, 20, 1.0 / 64, false},
    {"ship", ship, NULL, 40, 5, 1.0 / 64, true},
    {"rope", rope, NULL, 50, 64, 1.0 / 64, false},
    {"graph", graph, NULL, 40, 40, 1.0 / 64, true},
    {"everything_damped", everything_damped, push_some, 4, 100, 1.0 / 64, false},
    {"everything_flying", everything_flying, NULL, 5, 100, 1.0 / 50, false},
    {"implicit_bar", implicit_bar, NULL, 1, 64, 1.0 / 64, false},
    {"implicit_ropes", implicit_ropes, NULL, 2, 20, 1.0 / 64, false},
    {"implicit_graph", implicit_graph, NULL, 1, 20, 1.0 / 64, false},
    {"implicit_everything", everything_damped, push_and_change_solver, 1, 80, 1.0 / 64, false},
    {"direct_bar", direct_bar, NULL, 1, 64, 1.0 / 64, false},
    {"direct_ropes", direct_ropes, NULL, 2, 20, 1.0 / 64, true},
    {"direct_everything", everything_damped, push_and_solve_directly, 1, 80, 1.0 / 64, true},
    {"precise_bar", precise_bar, NULL, 30, 3, 1.0 / 64, true},
    {"precise_graph", precise_graph, NULL, 40, 20, 1.0 / 64, true},
    {"precise_everything", precise_everything, push_some, 4, 100, 1.0 / 64, false},
    {"contact", contact, NULL, 20, 160, 1.0 / 64, false},
    {"colliders", colliders, move_colliders, 20, 160, 1.0 / 64, true},
    {"implicit_contact", implicit_contact, move_colliders, 2, 80, 1.0 / 64, false},
    {"direct_contact", direct_contact, move_colliders, 2, 80, 1.0 / 64, false},
    {"yielding", yielding, push_some, 10, 100, 1.0 / 64, false},
    {"implicit_yielding", yielding, push_and_change_solver, 2, 80, 1.0 / 64, true},
    {"yielding_rows", yielding_rows, NULL, 10, 60, 1.0 / 64, false},
    {"one_way", one_way, NULL, 10, 60, 1.0 / 64, false},
    {"implicit_one_way", one_way, push_and_change_solver, 2, 60, 1.0 / 64, false},
    {"areas", areas, push_some, 10, 100, 1.0 / 64, false},
    {"precise_areas", precise_areas, push_some, 10, 100, 1.0 / 64, true},
    {"all_areas", all_areas, push_some, 10, 100, 1.0 / 64, false},
    {"implicit_areas", all_areas, push_and_change_solver, 10, 80, 1.0 / 64, false},
    {"angles", angles, push_and_bend, 10, 60, 1.0 / 64, false},
    {"implicit_angles", implicit_angles, push_and_bend, 2, 60, 1.0 / 64, false},
    {"direct_angles", direct_angles, push_and_bend, 2, 60, 1.0 / 64, true},
    {"floor", on_floor, NULL, 20, 160, 1.0 / 64, false},
    {"implicit_floor", implicit_floor, NULL, 2, 80, 1.0 / 64, false},
    {"direct_floor", direct_floor, NULL, 2, 80, 1.0 / 64, false},
    {"grips", grips, push_and_drag, 10, 80, 1.0 / 64, false},
    {"implicit_grips", implicit_grips, push_and_drag, 2, 80, 1.0 / 64, true},
    {"direct_grips", direct_grips, push_and_drag, 2, 80, 1.0 / 64, true},
};
const uint32_t golden_scene_count = COUNT_OF(golden_scenes);

uint64_t golden_run(const golden_scene *golden, mspring_simd level, uint32_t workers) {
    mspring_network_def def = support_def(-9.8f, golden->substeps);
    def.simd_level = level;
    def.worker_count = workers;
    mspring_network *network = golden->make(&def);
    level_check(network, level);
    uint64_t hash = support_hash(network);
    for (uint32_t step = 0; step < golden->steps; step++) {
        if (golden->before_step != NULL) {
            golden->before_step(network, step);
        }
        support_steps(network, 1, golden->dt);
        // Rotated and mixed, so that every step's state counts and not only the last one's.
        hash = (hash << 7 | hash >> 57) ^ support_hash(network);
    }
    mspring_network_destroy(network);
    return hash;
}

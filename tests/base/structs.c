/// Each public function that takes or fills a struct.
#include "structs.h"

#include <string.h>

static void *no_alloc(size_t size, size_t alignment, void *user) {
    (void)size, (void)alignment, (void)user;
    return NULL;
}

static void no_free(void *memory, size_t size, void *user) {
    (void)memory, (void)size, (void)user;
}

static void no_run(uint32_t count, mspring_task_fn fn, void *argument, void *user) {
    (void)count, (void)fn, (void)argument, (void)user;
}

static void no_hook(const mspring_hook_args *args, void *user) {
    (void)args, (void)user;
}

/// Result of two calls for one struct, which must agree.
static mspring_result both(mspring_result one, mspring_result other) {
    assert_int_equal(one, other);
    return one;
}

static mspring_result create(subject *s, const mspring_network_def *def) {
    mspring_network *made = NULL;
    const mspring_result result = mspring_network_create(s->builder, def, &made);
    mspring_network_destroy(made);
    return result;
}

static mspring_result clone(subject *s, const mspring_clone_def *def) {
    mspring_network *made = NULL;
    const mspring_result result = mspring_network_clone(s->network, def, &made);
    mspring_network_destroy(made);
    return result;
}

static mspring_result give_allocator(subject *s, void *given) {
    mspring_builder *made = NULL;
    mspring_allocator *allocator = given;
    mspring_network_def def = support_def(0, 1);
    mspring_clone_def clone_def;
    check_ok(mspring_clone_def_init(&clone_def, sizeof clone_def));
    allocator->alloc = no_alloc;
    allocator->free = no_free;
    def.allocator = clone_def.allocator = allocator;
    const mspring_result result =
        both(both(mspring_builder_create(given, &made), create(s, &def)), clone(s, &clone_def));
    return result == MSPRING_ERROR_MEMORY ? MSPRING_OK : result;
}

static mspring_result give_tasks(subject *s, void *given) {
    mspring_tasks *tasks = given;
    mspring_network_def def = support_def(0, 1);
    mspring_clone_def clone_def;
    check_ok(mspring_clone_def_init(&clone_def, sizeof clone_def));
    tasks->run = no_run;
    def.tasks = clone_def.tasks = tasks;
    return both(create(s, &def), clone(s, &clone_def));
}

static mspring_result give_particle(subject *s, void *given) {
    mspring_id id;
    const mspring_result result = mspring_network_add_particles(s->network, given, 1, &id);
    if (result == MSPRING_OK) {
        check_ok(mspring_network_remove_particles(s->network, &id, 1));
        check_ok(mspring_network_recycle(s->network));
    }
    return both(result, mspring_builder_add_particle(s->builder, given, NULL));
}

static mspring_result give_spring(subject *s, void *given) {
    mspring_spring_def *spring = given;
    mspring_id id;
    spring->a = 1;
    spring->b = 2;
    const mspring_result result = mspring_network_add_springs(s->network, given, 1, &id);
    if (result == MSPRING_OK) {
        check_ok(mspring_network_remove_springs(s->network, &id, 1));
        check_ok(mspring_network_recycle(s->network));
    }
    spring->a = mspring_builder_particle_count(s->builder);
    spring->b = 0;
    support_particle(s->builder, 3, 4, 1);
    return both(result, mspring_builder_add_spring(s->builder, given, NULL));
}

static mspring_result give_lattice(subject *s, void *given) {
    static const uint16_t cell = MSPRING_CELL_EMPTY;
    mspring_lattice_def *lattice = given;
    lattice->width = lattice->height = 1;
    lattice->cells = &cell;
    return mspring_builder_add_lattice(s->builder, given, NULL);
}

static mspring_result give_material(subject *s, void *given) {
    mspring_lattice_def lattice;
    check_ok(mspring_lattice_def_init(&lattice, sizeof lattice));
    lattice.materials = given;
    lattice.material_count = 1;
    return give_lattice(s, &lattice);
}

static mspring_result give_rope(subject *s, void *given) {
    mspring_rope_def *rope = given;
    rope->from = 0;
    rope->to = support_particle(s->builder, 5, 6, 1);
    return mspring_builder_add_rope(s->builder, given, NULL, 0, NULL);
}

static mspring_result give_mesh(subject *s, void *given) {
    return mspring_builder_add_mesh(s->builder, given, NULL, NULL);
}

static mspring_result give_disc(subject *s, void *given) {
    return mspring_builder_add_disc(s->builder, given, NULL, NULL);
}

static mspring_result give_network_def(subject *s, void *given) {
    return create(s, given);
}

static mspring_result give_clone_def(subject *s, void *given) {
    return clone(s, given);
}

static mspring_result try_setting(subject *s, mspring_tune_def *tune, const mspring_solver_def *setting) {
    mspring_tune_row row = {.struct_size = sizeof row};
    uint32_t count;
    tune->settings = setting;
    tune->setting_count = 1;
    tune->duration = tune->dt * 4;
    return mspring_network_tune(s->network, tune, &row, 1, &count);
}

static mspring_result give_solver(subject *s, void *given) {
    mspring_tune_def tune;
    check_ok(mspring_tune_def_init(&tune, sizeof tune));
    return both(mspring_network_set_solver(s->network, given), try_setting(s, &tune, given));
}

static mspring_result give_settings(subject *s, void *given) {
    return mspring_network_set_settings(s->network, given);
}

static mspring_result give_hook(subject *s, void *given) {
    mspring_hook_def *hook = given;
    hook->fn = no_hook;
    return mspring_network_add_hook(s->network, given, NULL);
}

static mspring_result give_floor(subject *s, void *given) {
    static const double plane[] = {0, -5, 0, 1};
    mspring_floor_def *floor = given;
    floor->planes = plane;
    floor->plane_count = 1;
    return mspring_network_set_floor(s->network, given);
}

static mspring_result give_contact(subject *s, void *given) {
    return mspring_network_set_contact(s->network, given);
}

static mspring_result give_grip(subject *s, void *given) {
    mspring_grip_def *grip = given;
    mspring_grip_def good;
    mspring_id id;
    grip->particle = 1;
    check_ok(mspring_grip_def_init(&good, sizeof good));
    good.particle = 1;
    check_ok(mspring_network_add_grip(s->network, &good, &id));
    const mspring_result result = mspring_network_set_grip(s->network, id, given);
    check_ok(mspring_network_remove_grip(s->network, id));
    id = MSPRING_NONE;
    both(result, mspring_network_add_grip(s->network, given, &id));
    if (id != MSPRING_NONE) {
        check_ok(mspring_network_remove_grip(s->network, id));
    }
    return result;
}

static mspring_result give_area(subject *s, void *given) {
    static const mspring_id corners[3] = {0, 1, 2};
    mspring_area_def good;
    mspring_id id;
    check_ok(mspring_area_def_init(&good, sizeof good));
    check_ok(mspring_network_add_area(s->network, &good, corners, 3, &id));
    const mspring_result result = both(mspring_network_add_cell_areas(s->network, given, NULL, NULL),
                                       mspring_network_add_area(s->network, given, corners, 3, NULL));
    return both(result, mspring_network_set_area(s->network, id, given));
}

static mspring_result give_angle(subject *s, void *given) {
    static const mspring_id three[3] = {0, 1, 2};
    mspring_angle_def good;
    mspring_id id;
    check_ok(mspring_angle_def_init(&good, sizeof good));
    check_ok(mspring_network_add_angles(s->network, &good, three, 1, &id));
    return both(mspring_network_add_angles(s->network, given, three, 1, NULL),
                mspring_network_set_angle(s->network, id, given));
}

static mspring_result give_collider(subject *s, void *given) {
    mspring_collider_def *collider = given;
    mspring_contact_def contact;
    check_ok(mspring_contact_def_init(&contact, sizeof contact));
    check_ok(mspring_network_set_contact(s->network, &contact));
    collider->kind = MSPRING_COLLIDER_BOX;
    return mspring_network_add_collider(s->network, given, NULL);
}

static mspring_result give_settle(subject *s, void *given) {
    const mspring_result result = mspring_network_settle(s->network, given, NULL);
    return result == MSPRING_ERROR_EQUILIBRIUM ? MSPRING_OK : result;
}

static mspring_result give_tune(subject *s, void *given) {
    mspring_solver_def solver;
    check_ok(mspring_solver_def_init(&solver, sizeof solver));
    return try_setting(s, given, &solver);
}

static mspring_result give_scene(subject *s, void *given) {
    mspring_tune_def tune;
    mspring_tune_scene *scene = given;
    check_ok(mspring_tune_def_init(&tune, sizeof tune));
    scene->duration = tune.dt;
    scene->start_count = 4;
    tune.scene = scene;
    return give_tune(s, &tune);
}

#define INIT(name)                                                                                                 \
    static mspring_result init_##name(void *out, size_t size) {                                                    \
        return mspring_##name##_init(out, size);                                                                   \
    }
INIT(allocator)
INIT(tasks)
INIT(particle_def)
INIT(spring_def)
INIT(lattice_def)
INIT(material)
INIT(rope_def)
INIT(mesh_def)
INIT(disc_def)
INIT(network_def)
INIT(clone_def)
INIT(solver_def)
INIT(settings)
INIT(hook_def)
INIT(floor_def)
INIT(contact_def)
INIT(grip_def)
INIT(area_def)
INIT(angle_def)
INIT(collider_def)
INIT(settle_def)
INIT(tune_def)
INIT(tune_scene)

#define NO_FIELD 0
#define INPUT(type, name, give)                                                                                    \
    { #type, sizeof(mspring_##type), 0, init_##type, give, name }
const struct input inputs[] = {
    INPUT(allocator, offsetof(mspring_allocator, reserved), give_allocator),
    INPUT(tasks, offsetof(mspring_tasks, reserved), give_tasks),
    INPUT(particle_def, offsetof(mspring_particle_def, reserved), give_particle),
    INPUT(spring_def, NO_FIELD, give_spring),
    INPUT(lattice_def, NO_FIELD, give_lattice),
    INPUT(material, NO_FIELD, give_material),
    INPUT(rope_def, NO_FIELD, give_rope),
    INPUT(mesh_def, NO_FIELD, give_mesh),
    INPUT(disc_def, NO_FIELD, give_disc),
    INPUT(network_def, NO_FIELD, give_network_def),
    INPUT(clone_def, offsetof(mspring_clone_def, reserved), give_clone_def),
    {"solver_def", sizeof(mspring_solver_def), 16, init_solver_def, give_solver,
     NO_FIELD}, // most_work, residual, substep_length
    INPUT(settings, NO_FIELD, give_settings),
    INPUT(hook_def, offsetof(mspring_hook_def, reserved), give_hook),
    INPUT(floor_def, offsetof(mspring_floor_def, reserved), give_floor),
    INPUT(contact_def, NO_FIELD, give_contact),
    INPUT(grip_def, offsetof(mspring_grip_def, reserved), give_grip),
    INPUT(area_def, offsetof(mspring_area_def, reserved), give_area),
    INPUT(angle_def, NO_FIELD, give_angle),
    INPUT(collider_def, offsetof(mspring_collider_def, reserved_pointer), give_collider),
    INPUT(settle_def, offsetof(mspring_settle_def, reserved), give_settle),
    INPUT(tune_def, offsetof(mspring_tune_def, reserved_pointer), give_tune),
    INPUT(tune_scene, offsetof(mspring_tune_scene, reserved), give_scene),
    INPUT(tune_scene, offsetof(mspring_tune_scene, reserved_pointer), give_scene),
};
const size_t input_count = COUNT_OF(inputs);

subject make_subject(void) {
    subject made = {.builder = support_builder()};
    support_spring(made.builder, support_pinned(made.builder, 0, 0, 1), support_particle(made.builder, 1, 0, 1), 10,
                   0);
    (void)support_pinned(made.builder, 0, 1, 1);
    mspring_network_def def = support_def(-9.8f, MSPRING_SUBSTEPS_AUTO);
    def.guard = MSPRING_GUARD_CLAMP;
    def.spare_particles = def.spare_springs = 8;
    check_ok(mspring_network_create(made.builder, &def, &made.network));
    return made;
}

void free_subject(subject *s) {
    mspring_builder_destroy(s->builder);
    mspring_network_destroy(s->network);
}

/* ------------------------------------------------------------------------------------------------------- outputs
 */

static mspring_result fill_view(subject *s, void *out) {
    return mspring_network_view(s->network, out);
}
static mspring_result fill_mutable_view(subject *s, void *out) {
    return mspring_network_view_mutable(s->network, out);
}
static mspring_result fill_solver(subject *s, void *out) {
    return mspring_network_get_solver(s->network, out);
}
static mspring_result fill_settings(subject *s, void *out) {
    return mspring_network_get_settings(s->network, out);
}
static mspring_result fill_floor(subject *s, void *out) {
    return mspring_network_get_floor(s->network, out);
}
static mspring_result fill_contact(subject *s, void *out) {
    return mspring_network_get_contact(s->network, out);
}
static mspring_result fill_contact_info(subject *s, void *out) {
    return mspring_network_get_contact_info(s->network, out);
}
static mspring_result fill_grip(subject *s, void *out) {
    mspring_grip_def def;
    mspring_id id;
    check_ok(mspring_grip_def_init(&def, sizeof def));
    def.particle = 1;
    check_ok(mspring_network_add_grip(s->network, &def, &id));
    const mspring_result result = mspring_network_get_grip(s->network, id, out);
    check_ok(mspring_network_remove_grip(s->network, id));
    return result;
}
static mspring_result fill_area(subject *s, void *out, bool is_info) {
    static const mspring_id corners[3] = {0, 1, 2};
    mspring_area_def def;
    mspring_id id;
    check_ok(mspring_area_def_init(&def, sizeof def));
    check_ok(mspring_network_add_area(s->network, &def, corners, 3, &id));
    const mspring_result result = is_info ? mspring_network_get_area_info(s->network, id, out)
                                          : mspring_network_get_area(s->network, id, out);
    check_ok(mspring_network_remove_area(s->network, id));
    return result;
}
static mspring_result fill_angle(subject *s, void *out, bool is_info) {
    static const mspring_id three[3] = {0, 1, 2};
    mspring_angle_def def;
    mspring_id id;
    check_ok(mspring_angle_def_init(&def, sizeof def));
    check_ok(mspring_network_add_angles(s->network, &def, three, 1, &id));
    const mspring_result result = is_info ? mspring_network_get_angle_info(s->network, id, out)
                                          : mspring_network_get_angle(s->network, id, out);
    check_ok(mspring_network_remove_angle(s->network, id));
    return result;
}
static mspring_result fill_angle_def(subject *s, void *out) {
    return fill_angle(s, out, false);
}
static mspring_result fill_angle_info(subject *s, void *out) {
    return fill_angle(s, out, true);
}
static mspring_result fill_area_def(subject *s, void *out) {
    return fill_area(s, out, false);
}
static mspring_result fill_area_info(subject *s, void *out) {
    return fill_area(s, out, true);
}
static mspring_result fill_collider(subject *s, void *out) {
    mspring_collider_def def;
    mspring_id id;
    check_ok(mspring_collider_def_init(&def, sizeof def));
    check_ok(give_collider(s, &def));
    check_ok(mspring_network_add_collider(s->network, &def, &id));
    return mspring_network_get_collider(s->network, id, out);
}
static mspring_result fill_contact_event(subject *s, void *out) {
    mspring_contact_def contact;
    mspring_collider_def def;
    uint32_t count = 0;
    check_ok(mspring_network_set_contact(s->network, NULL));
    check_ok(mspring_contact_def_init(&contact, sizeof contact));
    check_ok(mspring_network_set_contact(s->network, &contact));
    check_ok(mspring_network_reserve_contact_events(s->network, 8));
    check_ok(mspring_collider_def_init(&def, sizeof def));
    def.kind = MSPRING_COLLIDER_CIRCLE;
    def.x = 1; // into particle 1
    def.y = -0.25;
    def.radius = 0.5;
    check_ok(mspring_network_add_collider(s->network, &def, NULL));
    check_ok(mspring_network_step(s->network, 0.01));
    const mspring_result result = mspring_network_read_contact_events(s->network, out, 1, &count, NULL);
    assert_int_equal(count, result == MSPRING_OK);
    return result;
}
static mspring_result fill_plasticity(subject *s, void *out) {
    return mspring_network_get_plasticity(s->network, out);
}

static mspring_result fill_step_info(subject *s, void *out) {
    return mspring_network_get_step_info(s->network, out);
}
static mspring_result fill_spring_info(subject *s, void *out) {
    return mspring_network_get_spring(s->network, 0, out);
}
static mspring_result fill_body(subject *s, void *out) {
    return mspring_network_get_body(s->network, NULL, 0, 2, out);
}
static mspring_result fill_plan(subject *s, void *out) {
    return mspring_network_get_plan(s->network, out);
}
static mspring_result fill_settled(subject *s, void *out) {
    return mspring_network_settle(s->network, NULL, out);
}
static mspring_result fill_component(subject *s, void *out) {
    check_ok(mspring_network_update_components(s->network, NULL, NULL));
    return mspring_network_get_components(s->network, 0, 1, out);
}
static mspring_result fill_row(subject *s, void *out) {
    mspring_tune_def tune;
    mspring_solver_def solver;
    uint32_t count;
    check_ok(mspring_tune_def_init(&tune, sizeof tune));
    check_ok(mspring_solver_def_init(&solver, sizeof solver));
    tune.settings = &solver;
    tune.setting_count = 1;
    tune.duration = tune.dt * 4;
    return mspring_network_tune(s->network, &tune, out, 1, &count);
}
static mspring_result fill_row_solver(subject *s, void *out) {
    mspring_tune_row row = {.struct_size = sizeof row, .substeps = 1};
    (void)s;
    return mspring_tune_row_solver(&row, out);
}

#define OUTPUT(type, fill)                                                                                         \
    { #type, sizeof(mspring_##type), 0, fill, true }
#define OUTPUT_ONCE(type, fill)                                                                                    \
    { #type, sizeof(mspring_##type), 0, fill, false }
const struct output outputs[] = {
    OUTPUT(view, fill_view),
    OUTPUT(mutable_view, fill_mutable_view),
    {"solver_def", sizeof(mspring_solver_def), 16, fill_solver, true}, // most_work, residual, substep_length
    OUTPUT(settings, fill_settings),
    OUTPUT(floor_def, fill_floor),
    OUTPUT(contact_def, fill_contact),
    OUTPUT(contact_info, fill_contact_info),
    OUTPUT(grip_def, fill_grip),
    OUTPUT(angle_def, fill_angle_def),
    OUTPUT(angle_info, fill_angle_info),
    OUTPUT(area_def, fill_area_def),
    OUTPUT(area_info, fill_area_info),
    OUTPUT(collider_def, fill_collider),
    OUTPUT_ONCE(contact_event, fill_contact_event),
    {"step_info", sizeof(mspring_step_info), 16, fill_step_info, true}, // time_left, work
    OUTPUT(plasticity, fill_plasticity),
    OUTPUT(spring_info, fill_spring_info),
    OUTPUT(body, fill_body),
    OUTPUT(plan, fill_plan),
    OUTPUT_ONCE(settle_result, fill_settled),
    OUTPUT(component, fill_component),
    {"tune_row", sizeof(mspring_tune_row), 8, fill_row, false}, // residual
    {"solver_def", sizeof(mspring_solver_def), 16, fill_row_solver, true},
};
const size_t output_count = COUNT_OF(outputs);

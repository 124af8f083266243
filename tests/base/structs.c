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

/// Material of ropes, meshes and discs.
static const mspring_material *plain(void) {
    static mspring_material material;
    material = mspring_material_default();
    return &material;
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
    check_ok(mspring_init(MSPRING_STRUCT_CLONE_DEF, &clone_def, sizeof clone_def));
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
    check_ok(mspring_init(MSPRING_STRUCT_CLONE_DEF, &clone_def, sizeof clone_def));
    tasks->run = no_run;
    def.tasks = clone_def.tasks = tasks;
    return both(create(s, &def), clone(s, &clone_def));
}

static mspring_result give_particle(subject *s, void *given) {
    mspring_id id;
    const mspring_result result = mspring_network_add_particles(s->network, given, 1, &id);
    if (result == MSPRING_OK) {
        check_ok(mspring_network_remove_particles(s->network, &id, 0, 1));
        check_ok(mspring_network_reuse_ids(s->network));
    }
    return both(result, mspring_builder_add_particles(s->builder, given, 1, NULL));
}

static mspring_result give_spring(subject *s, void *given) {
    mspring_spring_def *spring = given;
    mspring_id id;
    spring->a = 1;
    spring->b = 2;
    const mspring_result result = mspring_network_add_springs(s->network, given, 1, &id);
    if (result == MSPRING_OK) {
        check_ok(mspring_network_remove_springs(s->network, &id, 0, 1));
        check_ok(mspring_network_reuse_ids(s->network));
    }
    spring->a = mspring_builder_count(s->builder, MSPRING_PARTICLES);
    spring->b = 0;
    support_particle(s->builder, 3, 4, 1);
    return both(result, mspring_builder_add_springs(s->builder, given, 1, NULL));
}

static mspring_result give_lattice(subject *s, void *given) {
    static const uint16_t cell = MSPRING_CELL_EMPTY;
    mspring_lattice_def *lattice = given;
    lattice->width = lattice->height = 1;
    lattice->cells = &cell;
    lattice->materials = plain();
    return mspring_builder_add_lattice(s->builder, given, NULL);
}

static mspring_result give_material(subject *s, void *given) {
    mspring_lattice_def lattice;
    mspring_rope_def rope;
    mspring_disc_def disc;
    check_ok(mspring_init(MSPRING_STRUCT_ROPE_DEF, &rope, sizeof rope));
    check_ok(mspring_init(MSPRING_STRUCT_DISC_DEF, &disc, sizeof disc));
    rope.from = 0;
    rope.to = support_particle(s->builder, 7, 8, 1);
    rope.material = disc.material = given;
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &lattice, sizeof lattice));
    lattice.materials = given;
    lattice.material_count = 1;
    lattice.width = lattice.height = 1;
    return both(both(mspring_builder_add_lattice(s->builder, &lattice, NULL),
                     mspring_builder_add_rope(s->builder, &rope, NULL, NULL)),
                mspring_builder_add_disc(s->builder, &disc, NULL, NULL));
}

static mspring_result give_rope(subject *s, void *given) {
    mspring_rope_def *rope = given;
    rope->from = 0;
    rope->to = support_particle(s->builder, 5, 6, 1);
    rope->material = plain();
    return mspring_builder_add_rope(s->builder, given, NULL, NULL);
}

static mspring_result give_mesh(subject *s, void *given) {
    mspring_mesh_def *mesh = given;
    mesh->material = plain();
    return mspring_builder_add_mesh(s->builder, given, NULL, NULL);
}

static mspring_result give_disc(subject *s, void *given) {
    mspring_disc_def *disc = given;
    disc->material = plain();
    return mspring_builder_add_disc(s->builder, given, NULL, NULL);
}

static mspring_result give_network_def(subject *s, void *given) {
    return create(s, given);
}

static mspring_result give_clone_def(subject *s, void *given) {
    return clone(s, given);
}

static mspring_result try_setting(subject *s, mspring_tune_def *tune, const mspring_settings *setting) {
    mspring_tune_row row = {.struct_size = sizeof row};
    uint32_t count;
    tune->settings = setting;
    tune->setting_count = 1;
    tune->duration = tune->dt * 4;
    return mspring_network_tune(s->network, tune, &row, 1, &count);
}

static mspring_result give_settings(subject *s, void *given) {
    mspring_tune_def tune;
    check_ok(mspring_init(MSPRING_STRUCT_TUNE_DEF, &tune, sizeof tune));
    return both(mspring_network_set_settings(s->network, given), try_setting(s, &tune, given));
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
    check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &good, sizeof good));
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
    return both(mspring_network_add_cell_areas(s->network, given, NULL, NULL),
                mspring_network_add_area(s->network, given, corners, 3, NULL));
}

static mspring_result give_angle(subject *s, void *given) {
    static const mspring_id three[3] = {0, 1, 2};
    return mspring_network_add_angles(s->network, given, three, 1, 3, NULL);
}

static mspring_result give_collider(subject *s, void *given) {
    mspring_collider_def *collider = given;
    mspring_contact_def contact;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    check_ok(mspring_network_set_contact(s->network, &contact));
    collider->kind = MSPRING_COLLIDER_BOX;
    return mspring_network_add_collider(s->network, given, NULL);
}

static mspring_result give_settle(subject *s, void *given) {
    const mspring_result result = mspring_network_settle(s->network, given, NULL);
    return result == MSPRING_ERROR_EQUILIBRIUM ? MSPRING_OK : result;
}

static mspring_result give_tune(subject *s, void *given) {
    mspring_settings solver;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    return try_setting(s, given, &solver);
}

static mspring_result give_scene(subject *s, void *given) {
    mspring_tune_def tune;
    mspring_tune_scene *scene = given;
    check_ok(mspring_init(MSPRING_STRUCT_TUNE_DEF, &tune, sizeof tune));
    scene->duration = tune.dt;
    scene->start_count = 4;
    tune.scene = scene;
    return give_tune(s, &tune);
}

#define NO_FIELD 0
#define INPUT(type, TYPE, name, give)                                                                              \
    { #type, sizeof(mspring_##type), 0, 0, MSPRING_STRUCT_##TYPE, give, name }
const struct input inputs[] = {
    INPUT(allocator, ALLOCATOR, offsetof(mspring_allocator, reserved), give_allocator),
    INPUT(tasks, TASKS, offsetof(mspring_tasks, reserved), give_tasks),
    INPUT(particle_def, PARTICLE_DEF, offsetof(mspring_particle_def, reserved), give_particle),
    INPUT(spring_def, SPRING_DEF, NO_FIELD, give_spring),
    INPUT(lattice_def, LATTICE_DEF, NO_FIELD, give_lattice),
    INPUT(material, MATERIAL, NO_FIELD, give_material),
    INPUT(rope_def, ROPE_DEF, offsetof(mspring_rope_def, reserved), give_rope),
    INPUT(mesh_def, MESH_DEF, offsetof(mspring_mesh_def, reserved), give_mesh),
    INPUT(disc_def, DISC_DEF, offsetof(mspring_disc_def, reserved), give_disc),
    {"network_def", sizeof(mspring_network_def), 0, offsetof(mspring_network_def, settings),
     MSPRING_STRUCT_NETWORK_DEF, give_network_def, offsetof(mspring_network_def, reserved)},
    INPUT(clone_def, CLONE_DEF, offsetof(mspring_clone_def, reserved), give_clone_def),
    INPUT(settings, SETTINGS, NO_FIELD, give_settings),
    INPUT(hook_def, HOOK_DEF, offsetof(mspring_hook_def, reserved), give_hook),
    INPUT(floor_def, FLOOR_DEF, offsetof(mspring_floor_def, reserved), give_floor),
    INPUT(floor_def, FLOOR_DEF, offsetof(mspring_floor_def, reserved_pointer), give_floor),
    INPUT(contact_def, CONTACT_DEF, offsetof(mspring_contact_def, reserved), give_contact),
    INPUT(grip_def, GRIP_DEF, offsetof(mspring_grip_def, reserved), give_grip),
    INPUT(area_def, AREA_DEF, NO_FIELD, give_area),
    INPUT(angle_def, ANGLE_DEF, NO_FIELD, give_angle),
    INPUT(collider_def, COLLIDER_DEF, offsetof(mspring_collider_def, reserved_pointer), give_collider),
    INPUT(settle_def, SETTLE_DEF, offsetof(mspring_settle_def, reserved), give_settle),
    INPUT(tune_def, TUNE_DEF, offsetof(mspring_tune_def, reserved_pointer), give_tune),
    INPUT(tune_scene, TUNE_SCENE, offsetof(mspring_tune_scene, reserved), give_scene),
    INPUT(tune_scene, TUNE_SCENE, offsetof(mspring_tune_scene, reserved_pointer), give_scene),
};
const size_t input_count = COUNT_OF(inputs);

subject make_subject(void) {
    subject made = {.builder = support_builder()};
    support_spring(made.builder, support_pinned(made.builder, 0, 0, 1), support_particle(made.builder, 1, 0, 1), 10,
                   0);
    (void)support_pinned(made.builder, 0, 1, 1);
    mspring_network_def def = support_def(-9.8f, MSPRING_SUBSTEPS_AUTO);
    def.settings.guard = MSPRING_GUARD_CLAMP;
    def.spare_particles = def.spare_springs = 8;
    check_ok(mspring_network_create(made.builder, &def, &made.network));
    return made;
}

void free_subject(subject *s) {
    mspring_builder_destroy(s->builder);
    mspring_network_destroy(s->network);
}

/* ----------------------------------------------------------------------------------------------------- outputs */

static mspring_result fill_view(subject *s, void *out) {
    return mspring_network_get_view(s->network, out);
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
    check_ok(mspring_init(MSPRING_STRUCT_GRIP_DEF, &def, sizeof def));
    def.particle = 1;
    check_ok(mspring_network_add_grip(s->network, &def, &id));
    const mspring_result result = mspring_network_get_grip(s->network, id, out);
    check_ok(mspring_network_remove_grip(s->network, id));
    return result;
}
static mspring_result fill_collider(subject *s, void *out) {
    mspring_collider_def def;
    mspring_id id;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    check_ok(give_collider(s, &def));
    check_ok(mspring_network_add_collider(s->network, &def, &id));
    return mspring_network_get_collider(s->network, id, out);
}
static mspring_result fill_contact_event(subject *s, void *out) {
    mspring_contact_def contact;
    mspring_collider_def def;
    uint32_t count = 0;
    check_ok(mspring_network_set_contact(s->network, NULL));
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    check_ok(mspring_network_set_contact(s->network, &contact));
    check_ok(support_reserve_contact_events(s->network, 8));
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
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

static mspring_result fill_step_info(subject *s, void *out) {
    return mspring_network_get_step_info(s->network, out);
}
static mspring_result fill_energy(subject *s, void *out) {
    return mspring_network_get_energy(s->network, out);
}
static mspring_result fill_info(subject *s, void *out) {
    return mspring_network_get_info(s->network, out);
}
static mspring_result fill_component(subject *s, void *out) {
    check_ok(mspring_network_update_components(s->network, NULL, NULL));
    return mspring_network_get_components(s->network, 0, 1, out);
}
static mspring_result fill_network_def(subject *s, void *out) {
    return mspring_builder_get_network_def(s->builder, out);
}
static mspring_result fill_body(subject *s, void *out) {
    return mspring_network_get_body(s->network, NULL, 0, 2, out);
}
static mspring_result fill_settled(subject *s, void *out) {
    return mspring_network_settle(s->network, NULL, out);
}
static mspring_result fill_row(subject *s, void *out) {
    mspring_tune_def tune;
    mspring_settings solver;
    uint32_t count;
    check_ok(mspring_init(MSPRING_STRUCT_TUNE_DEF, &tune, sizeof tune));
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver));
    tune.settings = &solver;
    tune.setting_count = 1;
    tune.duration = tune.dt * 4;
    return mspring_network_tune(s->network, &tune, out, 1, &count);
}

static mspring_result fill_particle(subject *s, void *out) {
    return mspring_builder_get_particles(s->builder, NULL, 1, 1, out);
}
static mspring_result fill_spring(subject *s, void *out) {
    return mspring_builder_get_springs(s->builder, NULL, 0, 1, out);
}
static mspring_result fill_material(subject *s, void *out) {
    (void)s;
    return mspring_material_preset(out, MSPRING_PRESET_RUBBER, 0.5, 0.01);
}

#define OUTPUT(type, fill)                                                                                         \
    { #type, sizeof(mspring_##type), 0, 0, fill, true }
#define OUTPUT_ONCE(type, fill)                                                                                    \
    { #type, sizeof(mspring_##type), 0, 0, fill, false }
/// One that ends with settings.
#define OUTPUT_WITH(type, fill, repeats)                                                                           \
    { #type, sizeof(mspring_##type), 0, offsetof(mspring_##type, settings), fill, repeats }
const struct output outputs[] = {
    OUTPUT(view, fill_view),
    OUTPUT(settings, fill_settings),
    OUTPUT_WITH(network_def, fill_network_def, true),
    OUTPUT(particle_def, fill_particle),
    OUTPUT(spring_def, fill_spring),
    OUTPUT(material, fill_material),
    OUTPUT(floor_def, fill_floor),
    OUTPUT(contact_def, fill_contact),
    OUTPUT(contact_info, fill_contact_info),
    OUTPUT(grip_def, fill_grip),
    OUTPUT(collider_def, fill_collider),
    OUTPUT_ONCE(contact_event, fill_contact_event),
    OUTPUT(step_info, fill_step_info),
    OUTPUT(energy, fill_energy),
    OUTPUT(network_info, fill_info),
    OUTPUT(body, fill_body),
    OUTPUT(body, fill_component),
    OUTPUT_ONCE(settle_result, fill_settled),
    OUTPUT_WITH(tune_row, fill_row, false),
};
const size_t output_count = COUNT_OF(outputs);

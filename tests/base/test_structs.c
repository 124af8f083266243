/// @file test_structs.c
/// Structs of a later header, which are larger than this library knows; reserved fields; elements of arrays.
///
/// SPDX-License-Identifier: MIT
#include <stdint.h>
#include <string.h>

#include "support.h"

#define MORE 24

/// A struct with room behind it, and its size as a later header would give it.
#define LARGER(type)                                                                                               \
    union {                                                                                                        \
        type is;                                                                                                   \
        unsigned char bytes[sizeof(type) + MORE];                                                                  \
    }

/// All functions that take or fill one struct, with the network and builder of a test.
typedef struct subject {
    mspring_builder *builder;
    mspring_network *network;
} subject;

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

static mspring_result give_allocator(subject *s, void *given) {
    mspring_builder *made = NULL;
    mspring_allocator *allocator = given;
    (void)s;
    allocator->alloc = no_alloc;
    allocator->free = no_free;
    const mspring_result result = mspring_builder_create(given, &made);
    return result == MSPRING_ERROR_MEMORY ? MSPRING_OK : result;
}

static mspring_result give_tasks(subject *s, void *given) {
    mspring_tasks *tasks = given;
    mspring_network_def def = support_def(0, 1);
    mspring_network *made = NULL;
    tasks->run = no_run;
    def.tasks = tasks;
    const mspring_result result = mspring_network_create(s->builder, &def, &made);
    mspring_network_destroy(made);
    return result;
}

static mspring_result give_particle(subject *s, void *given) {
    return mspring_builder_add_particle(s->builder, given, NULL);
}

static mspring_result give_spring(subject *s, void *given) {
    mspring_spring_def *spring = given;
    spring->a = mspring_builder_particle_count(s->builder);
    spring->b = 0;
    support_particle(s->builder, 3, 4, 1);
    return mspring_builder_add_spring(s->builder, given, NULL);
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
    mspring_network *made = NULL;
    const mspring_result result = mspring_network_create(s->builder, given, &made);
    mspring_network_destroy(made);
    return result;
}

static mspring_result give_clone_def(subject *s, void *given) {
    mspring_network *made = NULL;
    const mspring_result result = mspring_network_clone(s->network, given, &made);
    mspring_network_destroy(made);
    return result;
}

static mspring_result give_solver(subject *s, void *given) {
    return mspring_network_set_solver(s->network, given);
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
    grip->particle = 1;
    return mspring_network_add_grip(s->network, given, NULL);
}

static mspring_result give_area(subject *s, void *given) {
    return mspring_network_add_cell_areas(s->network, given, NULL, NULL);
}

static mspring_result give_angle(subject *s, void *given) {
    static const mspring_id three[3] = {0, 1, 2};
    return mspring_network_add_angles(s->network, given, three, 1, NULL);
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
    mspring_tune_row row = {.struct_size = sizeof row};
    mspring_tune_def *tune = given;
    mspring_solver_def solver;
    uint32_t count;
    check_ok(mspring_solver_def_init(&solver, sizeof solver));
    tune->settings = &solver;
    tune->setting_count = 1;
    tune->duration = tune->dt * 4;
    return mspring_network_tune(s->network, given, &row, 1, &count);
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
    { #type, sizeof(mspring_##type), init_##type, give, name }
static const struct input {
    const char *name;
    size_t size;
    mspring_result (*init)(void *out, size_t size);
    mspring_result (*give)(subject *s, void *given);
    size_t reserved; ///< where a reserved field is; 0: there is none
} inputs[] = {
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
    INPUT(solver_def, NO_FIELD, give_solver),
    INPUT(settings, NO_FIELD, give_settings),
    INPUT(hook_def, offsetof(mspring_hook_def, reserved), give_hook),
    INPUT(floor_def, offsetof(mspring_floor_def, reserved), give_floor),
    INPUT(contact_def, offsetof(mspring_contact_def, reserved), give_contact),
    INPUT(grip_def, offsetof(mspring_grip_def, reserved), give_grip),
    INPUT(area_def, offsetof(mspring_area_def, reserved), give_area),
    INPUT(angle_def, NO_FIELD, give_angle),
    INPUT(collider_def, offsetof(mspring_collider_def, reserved_pointer), give_collider),
    INPUT(settle_def, offsetof(mspring_settle_def, reserved), give_settle),
    INPUT(tune_def, offsetof(mspring_tune_def, reserved_pointer), give_tune),
    INPUT(tune_scene, offsetof(mspring_tune_scene, reserved), give_scene),
    INPUT(tune_scene, offsetof(mspring_tune_scene, reserved_pointer), give_scene),
};

static subject make_subject(void) {
    subject made = {.builder = support_builder()};
    support_spring(made.builder, support_pinned(made.builder, 0, 0, 1), support_particle(made.builder, 1, 0, 1), 10,
                   0);
    (void)support_pinned(made.builder, 0, 1, 1);
    check_ok(mspring_network_create(made.builder, NULL, &made.network));
    return made;
}

static void free_subject(subject *s) {
    mspring_builder_destroy(s->builder);
    mspring_network_destroy(s->network);
}

static void later_structs_are_taken_if_what_is_new_is_0(void **state) {
    (void)state;
    for (const struct input *input = inputs; input < inputs + COUNT_OF(inputs); input++) {
        subject s = make_subject();
        _Alignas(16) unsigned char bytes[512];
        uint32_t size = (uint32_t)input->size + MORE;
        memset(bytes, 0xaa, sizeof bytes);
        check_ok(input->init(bytes, size));
        assert_memory_equal(bytes, &size, sizeof size);
        for (size_t i = input->size; i < size; i++) {
            assert_int_equal(bytes[i], 0);
        }
        assert_int_equal(bytes[size], 0xaa);
        if (input->give(&s, bytes) != MSPRING_OK) {
            print_error("%s: %s%s\n", input->name, mspring_builder_error(s.builder),
                        mspring_network_error(s.network));
            fail();
        }
        check_ok(input->init(bytes, size));
        for (size_t at = input->size; at < size; at += MORE - 1) {
            bytes[at] = 1;
            check_error(input->give(&s, bytes), MSPRING_ERROR_STRUCT);
            bytes[at] = 0;
        }
        size = (uint32_t)input->size - 4;
        memcpy(bytes, &size, sizeof size);
        check_error(input->give(&s, bytes), MSPRING_ERROR_STRUCT);
        free_subject(&s);
    }
}

static void reserved_fields_must_be_0(void **state) {
    (void)state;
    for (const struct input *input = inputs; input < inputs + COUNT_OF(inputs); input++) {
        subject s = make_subject();
        _Alignas(16) unsigned char bytes[512];
        check_ok(input->init(bytes, input->size));
        if (input->reserved != NO_FIELD) {
            bytes[input->reserved] = 1;
            check_error(input->give(&s, bytes), MSPRING_ERROR_ARGUMENT);
        }
        free_subject(&s);
    }
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
static mspring_result fill_plasticity(subject *s, void *out) {
    return mspring_network_get_plasticity(s->network, out);
}

static mspring_result fill_step_info(subject *s, void *out) {
    return mspring_network_get_step_info(s->network, out);
}
static mspring_result fill_spring_info(subject *s, void *out) {
    return mspring_network_get_spring(s->network, 0, out);
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
    { #type, sizeof(type), fill }
static const struct output {
    const char *name;
    size_t size;
    mspring_result (*fill)(subject *s, void *out);
} outputs[] = {
    OUTPUT(mspring_view, fill_view),
    OUTPUT(mspring_mutable_view, fill_mutable_view),
    OUTPUT(mspring_solver_def, fill_solver),
    OUTPUT(mspring_settings, fill_settings),
    OUTPUT(mspring_floor_def, fill_floor),
    OUTPUT(mspring_contact_def, fill_contact),
    OUTPUT(mspring_contact_info, fill_contact_info),
    OUTPUT(mspring_grip_def, fill_grip),
    OUTPUT(mspring_angle_def, fill_angle_def),
    OUTPUT(mspring_angle_info, fill_angle_info),
    OUTPUT(mspring_area_def, fill_area_def),
    OUTPUT(mspring_area_info, fill_area_info),
    OUTPUT(mspring_collider_def, fill_collider),
    OUTPUT(mspring_step_info, fill_step_info),
    OUTPUT(mspring_plasticity, fill_plasticity),
    OUTPUT(mspring_spring_info, fill_spring_info),
    OUTPUT(mspring_plan, fill_plan),
    OUTPUT(mspring_settle_result, fill_settled),
    OUTPUT(mspring_component, fill_component),
    OUTPUT(mspring_tune_row, fill_row),
    OUTPUT(mspring_solver_def, fill_row_solver),
};

static void later_structs_are_filled_with_0_behind_what_is_known(void **state) {
    (void)state;
    for (const struct output *output = outputs; output < outputs + COUNT_OF(outputs); output++) {
        subject s = make_subject();
        _Alignas(16) unsigned char bytes[768];
        uint32_t size = (uint32_t)output->size + MORE;
        memset(bytes, 0xaa, sizeof bytes);
        memcpy(bytes, &size, sizeof size);
        check_ok(output->fill(&s, bytes));
        assert_memory_equal(bytes, &size, sizeof size);
        for (size_t i = output->size; i < size; i++) {
            assert_int_equal(bytes[i], 0);
        }
        assert_int_equal(bytes[size], 0xaa);
        const uint32_t bad[] = {0, 4, (uint32_t)output->size - 4, (uint32_t)output->size + 2, 1u << 20};
        for (size_t i = 0; i < COUNT_OF(bad); i++) {
            memcpy(bytes, &bad[i], sizeof bad[i]);
            check_error(output->fill(&s, bytes), MSPRING_ERROR_STRUCT);
        }
        free_subject(&s);
    }
}

/* -------------------------------------------------------------------------------------------------------- arrays
 */

static void arrays_go_by_the_size_of_their_structs(void **state) {
    (void)state;
    LARGER(mspring_particle_def) particles[4];
    LARGER(mspring_spring_def) springs[3];
    mspring_builder *builder = support_builder();
    for (uint32_t i = 0; i < 4; i++) {
        check_ok(mspring_particle_def_init(&particles[i].is, sizeof particles[i]));
        particles[i].is.x = i * i;
        particles[i].is.mass = 1 + (float)i;
    }
    for (uint32_t i = 0; i < 3; i++) {
        check_ok(mspring_spring_def_init(&springs[i].is, sizeof springs[i]));
        springs[i].is.a = i;
        springs[i].is.b = i + 1;
    }
    check_ok(mspring_builder_add_particles(builder, &particles[0].is, 4, NULL));
    check_ok(mspring_builder_add_springs(builder, &springs[0].is, 3, NULL));
    // One that is not as large as the first.
    springs[1].is.struct_size = sizeof springs[1].is;
    particles[2].is.struct_size = sizeof particles[2].is;
    check_error(mspring_builder_add_particles(builder, &particles[0].is, 4, NULL), MSPRING_ERROR_STRUCT);
    check_contains(mspring_builder_error(builder), "definition 2");
    check_error(mspring_builder_add_springs(builder, &springs[0].is, 3, NULL), MSPRING_ERROR_STRUCT);
    check_contains(mspring_builder_error(builder), "definition 1");
    assert_int_equal(mspring_builder_particle_count(builder), 4);
    mspring_network_def def = support_def(0, 1);
    def.spare_particles = def.spare_springs = 8;
    mspring_network *network = support_network(builder, &def);
    float read[4];
    check_ok(mspring_network_get(network, MSPRING_REST_LENGTH, 0, 3, read, 1));
    assert_true(read[0] == 1 && read[1] == 3 && read[2] == 5);
    // Added to a network, and read from it.
    mspring_id ids[4];
    LARGER(mspring_component) parts[2];
    particles[2].is.struct_size = sizeof particles[2];
    check_ok(mspring_network_add_particles(network, &particles[0].is, 4, ids));
    check_ok(mspring_network_get(network, MSPRING_MASS, ids[0], 4, read, 1));
    assert_true(read[0] == 1 && read[1] == 2 && read[2] == 3 && read[3] == 4);
    check_ok(mspring_network_update_components(network, NULL, NULL));
    for (int i = 0; i < 2; i++) {
        memset(&parts[i], 0xaa, sizeof parts[i]);
        parts[i].is.struct_size = sizeof parts[i];
    }
    check_ok(mspring_network_get_components(network, 0, 2, &parts[0].is));
    assert_int_equal(parts[0].is.particle_count, 4);
    assert_int_equal(parts[1].is.head, ids[0]);
    assert_int_equal(parts[1].bytes[sizeof parts[1] - 1], 0);
    parts[1].is.struct_size = sizeof parts[1].is;
    check_error(mspring_network_get_components(network, 0, 2, &parts[0].is), MSPRING_ERROR_STRUCT);
    mspring_network_destroy(network);
}

static void lattices_go_by_the_size_of_their_materials(void **state) {
    (void)state;
    LARGER(mspring_material) materials[2];
    const uint16_t cells[] = {0, 1};
    mspring_lattice_def lattice;
    check_ok(mspring_lattice_def_init(&lattice, sizeof lattice));
    for (int i = 0; i < 2; i++) {
        check_ok(mspring_material_init(&materials[i].is, sizeof materials[i]));
        materials[i].is.mass = 2 + (float)i;
    }
    lattice.width = 2;
    lattice.height = 1;
    lattice.cells = cells;
    lattice.materials = &materials[0].is;
    lattice.material_count = 2;
    mspring_builder *builder = support_builder();
    check_ok(mspring_builder_add_lattice(builder, &lattice, NULL));
    mspring_network *network = support_network(builder, NULL);
    float mass[2];
    check_ok(mspring_network_get(network, MSPRING_MASS, 0, 2, mass, 1));
    assert_true(mass[0] == 2 && mass[1] == 3);
    mspring_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(later_structs_are_taken_if_what_is_new_is_0),
        cmocka_unit_test(reserved_fields_must_be_0),
        cmocka_unit_test(later_structs_are_filled_with_0_behind_what_is_known),
        cmocka_unit_test(arrays_go_by_the_size_of_their_structs),
        cmocka_unit_test(lattices_go_by_the_size_of_their_materials),
    };
    return cmocka_run_group_tests_name("structs", tests, NULL, NULL);
}

/// @file test_structs.c
/// Structs of another version's header, which are longer or shorter than this library's.
///
/// tests/abi/other_structs compiles this program once more, with a header whose structs are longer, and against a
/// library whose structs are. LIBRARY_GROWTH is by how many bytes the structs of the library are longer than those
/// of this program's header.
///
/// SPDX-License-Identifier: MIT
#if !defined(_WIN32)
#define _DEFAULT_SOURCE // memory without access
#define _DARWIN_C_SOURCE
#endif

#include "structs.h"

#include <stdio.h>
#include <string.h>
#if defined(__unix__) && !defined(__EMSCRIPTEN__)
#include <sys/mman.h>
#include <unistd.h>
#endif

#if !defined(LIBRARY_GROWTH)
#define LIBRARY_GROWTH 0
#endif

/// A struct's size in the library, and in the version that introduced it, by its size here.
#define KNOWN(size) ((size) + LIBRARY_GROWTH)
#define FIRST(size) (LIBRARY_GROWTH < 0 ? KNOWN(size) : (size))

/// Bytes that the struct of a program may be longer than this header says. The last: longer than any library.
static const uint32_t longer[] = {0, 8, 24};
#define LONGEST 24

/// Bytes in front of a struct that nobody may write. Behind it nobody may even read.
#define FENCE 64

/// Memory of this size that ends where the readable memory does, so that one byte too many ends the program.
static unsigned char *fenced(size_t size) {
    static unsigned char *end;
#if defined(__unix__) && !defined(__EMSCRIPTEN__)
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    if (!end) {
        void *pages = mmap(NULL, 2 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        assert_true(pages != MAP_FAILED);
        assert_int_equal(mprotect((char *)pages + page, page, PROT_NONE), 0);
        end = (unsigned char *)pages + page;
    }
#else
    static _Alignas(16) unsigned char bytes[4096];
    end = bytes + sizeof bytes;
#endif
    assert_true(size <= 4096 - FENCE);
    memset(end - size - FENCE, 0xaa, size + FENCE);
    return end - size;
}

static void check_untouched(const unsigned char *bytes, size_t size) {
    for (size_t i = 0; i < size; i++) {
        assert_int_equal(bytes[i], 0xaa);
    }
}

static void check_fence(const unsigned char *bytes) {
    check_untouched(bytes - FENCE, FENCE);
}

static void set_size(unsigned char *bytes, uint32_t size) {
    memcpy(bytes, &size, sizeof size);
}

/// Sizes that no version of a struct has.
#define IMPOSSIBLE_COUNT 8
static void list_impossible(uint32_t sizes[IMPOSSIBLE_COUNT], size_t size, size_t grown) {
    const uint32_t first = (uint32_t)(FIRST(size) - grown);
    const uint32_t all[IMPOSSIBLE_COUNT] = {0, 4, first - 4, first + 2, first + 1, 4004, 1u << 20, UINT32_MAX - 3};
    memcpy(sizes, all, sizeof all);
}

/// The message of a refusal names the struct and both sizes.
static void check_message(const subject *s, const char *name, uint32_t size) {
    char expected[80];
    snprintf(expected, sizeof expected, "mspring_%s.struct_size is %u, it must be", name, (unsigned)size);
    if (!strstr(support_builder_error(s->builder), expected)) {
        check_contains(mspring_network_error(s->network), expected);
    }
}

/// Settings at the end of a struct have its other bytes, and say so.
static void check_nested(const unsigned char *bytes, size_t settings, uint32_t size) {
    const uint32_t nested = size - (uint32_t)settings;
    if (settings > 0)
        assert_memory_equal(bytes + settings, &nested, sizeof nested);
}

/* ------------------------------------------------------------------------------------------------------ inputs */

static void check_given(const struct input *input, uint32_t more) {
    subject s = make_subject();
    const uint32_t size = (uint32_t)input->size + more, known = (uint32_t)KNOWN(input->size);
    unsigned char *bytes = fenced(size);
    check_ok(mspring_init(input->kind, bytes, size));
    assert_memory_equal(bytes, &size, sizeof size);
    check_nested(bytes, input->settings, size);
    for (uint32_t i = known; i < size; i++) {
        assert_int_equal(bytes[i], 0);
    }
    if (input->give(&s, bytes) != MSPRING_OK) {
        print_error("%s: %s%s\n", input->name, support_builder_error(s.builder), mspring_network_error(s.network));
        fail();
    }
    assert_memory_equal(bytes, &size, sizeof size);
    check_ok(mspring_init(input->kind, bytes, size));
    const uint32_t later[] = {known, size - 1};
    for (size_t i = 0; i < COUNT_OF(later) && size > known; i++) {
        bytes[later[i]] = 1;
        check_error(input->give(&s, bytes), MSPRING_ERROR_STRUCT);
        bytes[later[i]] = 0;
    }
    check_fence(bytes);
    free_subject(&s);
}

static void structs_are_taken_as_far_as_they_go(void **state) {
    (void)state;
    for (const struct input *input = inputs; input < inputs + input_count; input++) {
        for (size_t k = 0; k < COUNT_OF(longer); k++) {
            check_given(input, longer[k]);
        }
    }
}

static void impossible_sizes_are_refused(void **state) {
    (void)state;
    for (const struct input *input = inputs; input < inputs + input_count; input++) {
        uint32_t sizes[IMPOSSIBLE_COUNT];
        list_impossible(sizes, input->size, input->grown);
        for (size_t i = 0; i < IMPOSSIBLE_COUNT; i++) {
            subject s = make_subject();
            unsigned char *bytes = fenced(input->size);
            check_error(mspring_init(input->kind, bytes, sizes[i]), MSPRING_ERROR_STRUCT);
            check_untouched(bytes, input->size);
            check_ok(mspring_init(input->kind, bytes, input->size));
            set_size(bytes, sizes[i]);
            check_error(input->give(&s, bytes), MSPRING_ERROR_STRUCT);
            check_message(&s, input->name, sizes[i]);
            check_fence(bytes);
            free_subject(&s);
        }
    }
}

static void check_wrong_nested(const struct input *input, uint32_t more) {
    const uint32_t size = (uint32_t)input->size + more, left = size - (uint32_t)input->settings;
    const uint32_t wrong[] = {0, 4, left - 4, left + 4, left + 8, size, UINT32_MAX - 3};
    subject s = make_subject();
    unsigned char *bytes = fenced(size);
    check_ok(mspring_init(input->kind, bytes, size));
    for (size_t i = 0; i < COUNT_OF(wrong); i++) {
        set_size(bytes + input->settings, wrong[i]);
        check_error(input->give(&s, bytes), MSPRING_ERROR_STRUCT);
        check_contains(support_builder_error(s.builder), ".settings.struct_size is ");
    }
    free_subject(&s);
}

/// Settings in a struct are as long as it says, neither shorter nor longer.
static void nested_settings_have_the_size_that_is_left(void **state) {
    (void)state;
    for (const struct input *input = inputs; input < inputs + input_count; input++)
        for (size_t k = 0; input->settings > 0 && k < COUNT_OF(longer); k++)
            check_wrong_nested(input, longer[k]);
}

/// Structs that a host gets, changes and gives: settings of a network or of a row are those of another's
/// definition.
static void settings_move_between_structs(void **state) {
    (void)state;
    subject s = make_subject();
    mspring_network_def def = mspring_network_def_default();
    mspring_network *made = NULL;
    check_ok(mspring_network_get_settings(s.network, &def.settings));
    assert_int_equal(def.settings.struct_size, sizeof def.settings);
    def.settings.gravity_y = -3;
    check_ok(mspring_network_create(s.builder, &def, &made));
    check_ok(mspring_network_set_settings(s.network, &def.settings));
    assert_true(support_settings(made).gravity_y == -3);
    assert_true(support_settings(s.network).gravity_y == -3);
    mspring_network_destroy(made);
    free_subject(&s);
}

static void reserved_fields_must_be_0(void **state) {
    (void)state;
    for (const struct input *input = inputs; input < inputs + input_count; input++) {
        subject s = make_subject();
        unsigned char *bytes = fenced(input->size);
        check_ok(mspring_init(input->kind, bytes, input->size));
        if (input->reserved != 0) {
            bytes[input->reserved] = 1;
            check_error(input->give(&s, bytes), MSPRING_ERROR_ARGUMENT);
        }
        free_subject(&s);
    }
}

/* ----------------------------------------------------------------------------------------------------- outputs */

static void check_filled(const struct output *output, uint32_t more) {
    subject s = make_subject();
    const uint32_t size = (uint32_t)output->size + more, known = (uint32_t)KNOWN(output->size);
    unsigned char *bytes = fenced(size);
    _Alignas(16) unsigned char whole[768];
    set_size(bytes, size);
    check_ok(output->fill(&s, bytes));
    assert_memory_equal(bytes, &size, sizeof size);
    check_nested(bytes, output->settings, size);
    for (uint32_t i = known; i < size; i++) {
        assert_int_equal(bytes[i], 0);
    }
    check_fence(bytes);
    // A shorter struct gets the first bytes of the whole one.
    if (output->repeats) {
        set_size(whole, (uint32_t)output->size + LONGEST);
        check_ok(output->fill(&s, whole));
        if (output->settings > 0)
            memcpy(whole + output->settings, bytes + output->settings, sizeof size);
        assert_memory_equal(bytes + sizeof size, whole + sizeof size, (size < known ? size : known) - sizeof size);
    }
    free_subject(&s);
}

static void structs_are_filled_as_far_as_they_go(void **state) {
    (void)state;
    for (const struct output *output = outputs; output < outputs + output_count; output++) {
        for (size_t k = 0; k < COUNT_OF(longer); k++) {
            check_filled(output, longer[k]);
        }
        subject s = make_subject();
        uint32_t sizes[IMPOSSIBLE_COUNT];
        unsigned char *bytes = fenced(output->size);
        list_impossible(sizes, output->size, output->grown);
        for (size_t i = 0; i < IMPOSSIBLE_COUNT; i++) {
            set_size(bytes, sizes[i]);
            check_error(output->fill(&s, bytes), MSPRING_ERROR_STRUCT);
            check_untouched(bytes + sizeof sizes[i], output->size - sizeof sizes[i]);
        }
        free_subject(&s);
    }
}

static void look_at_arguments(const mspring_hook_args *args, void *user) {
    assert_int_equal(args->struct_size, KNOWN(sizeof *args));
    *(int *)user += 1;
}

static void hooks_see_how_long_their_arguments_are(void **state) {
    (void)state;
    subject s = make_subject();
    int calls = 0;
    check_ok(support_add_hook(s.network, MSPRING_PHASE_BEFORE_STEP, look_at_arguments, &calls, NULL));
    support_steps(s.network, 3, 0.01);
    assert_int_equal(calls, 3);
    free_subject(&s);
}

/* ------------------------------------------------------------------------------------------------------ arrays */

#define AT(type, array, size, i) ((type *)(void *)((array) + (size_t)(size) * (i)))

static unsigned char *make_particles(uint32_t size, uint32_t count) {
    unsigned char *array = fenced((size_t)size * count);
    for (uint32_t i = 0; i < count; i++) {
        mspring_particle_def *particle = AT(mspring_particle_def, array, size, i);
        check_ok(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, particle, size));
        particle->x = i * i;
        particle->mass = 1 + (float)i;
    }
    return array;
}

static unsigned char *make_springs(uint32_t size, uint32_t count) {
    unsigned char *array = fenced((size_t)size * count);
    for (uint32_t i = 0; i < count; i++) {
        mspring_spring_def *spring = AT(mspring_spring_def, array, size, i);
        check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, spring, size));
        spring->a = i;
        spring->b = i + 1;
        spring->stiffness = 1 + (float)i;
        spring->break_strain = 2 + (float)i;
    }
    return array;
}

/// Another element than the first says of itself that it is longer, or shorter.
static void spoil(unsigned char *array, uint32_t size, uint32_t i) {
    set_size(array + (size_t)size * i, i % 2 ? size + 8 : (uint32_t)FIRST(size) - 4);
}

static mspring_network *build(uint32_t more) {
    const uint32_t particle = sizeof(mspring_particle_def) + more, spring = sizeof(mspring_spring_def) + more;
    mspring_builder *builder = support_builder();
    unsigned char *array = make_particles(particle, 4);
    check_ok(mspring_builder_add_particles(builder, AT(mspring_particle_def, array, 0, 0), 4, NULL));
    spoil(array, particle, 2);
    check_error(mspring_builder_add_particles(builder, AT(mspring_particle_def, array, 0, 0), 4, NULL),
                MSPRING_ERROR_STRUCT);
    check_contains(support_builder_error(builder), "definition 2");
    assert_int_equal(mspring_builder_count(builder, MSPRING_PARTICLES), 4);
    array = make_springs(spring, 3);
    check_ok(mspring_builder_add_springs(builder, AT(mspring_spring_def, array, 0, 0), 3, NULL));
    spoil(array, spring, 1);
    check_error(mspring_builder_add_springs(builder, AT(mspring_spring_def, array, 0, 0), 3, NULL),
                MSPRING_ERROR_STRUCT);
    check_contains(support_builder_error(builder), "definition 1");
    mspring_network_def def = support_def(0, 1);
    def.spare_particles = def.spare_springs = 8;
    return support_network(builder, &def);
}

static void check_components(mspring_network *network, uint32_t more, mspring_id head) {
    const uint32_t size = sizeof(mspring_body) + more;
    unsigned char *array = fenced((size_t)size * 2);
    check_ok(mspring_network_update_components(network, NULL, NULL));
    set_size(array, size); // the others get it
    spoil(array, size, 1);
    check_ok(mspring_network_get_components(network, 0, 2, AT(mspring_body, array, 0, 0)));
    assert_int_equal(AT(mspring_body, array, size, 0)->particle_count, 4);
    assert_int_equal(AT(mspring_body, array, size, 1)->head, head);
    assert_int_equal(AT(mspring_body, array, size, 1)->struct_size, size);
    check_near(AT(mspring_body, array, size, 0)->mass, 10, 0); // small whole numbers
    check_near(AT(mspring_body, array, size, 1)->mass, 3, 0);
    check_fence(array);
}

static void arrays_go_by_the_size_of_their_structs(void **state) {
    (void)state;
    for (size_t k = 0; k < COUNT_OF(longer); k++) {
        mspring_network *network = build(longer[k]);
        const uint32_t size = sizeof(mspring_particle_def) + longer[k];
        mspring_id ids[4], spring_id[2];
        float read[4];
        check_ok(mspring_network_get(network, MSPRING_REST_LENGTH, NULL, 0, 3, read, 1));
        assert_true(read[0] == 1 && read[1] == 3 && read[2] == 5);
        check_ok(mspring_network_get(network, MSPRING_BREAK_STRAIN, NULL, 0, 3, read, 1));
        assert_true(read[0] == 2 && read[1] == 3 && read[2] == 4);
        // Added to a network, and read from it.
        unsigned char *array = make_particles(size, 4);
        check_ok(mspring_network_add_particles(network, AT(mspring_particle_def, array, 0, 0), 4, ids));
        spoil(array, size, 2);
        check_error(mspring_network_add_particles(network, AT(mspring_particle_def, array, 0, 0), 4, ids),
                    MSPRING_ERROR_STRUCT);
        check_contains(mspring_network_error(network), "definition 2");
        check_ok(mspring_network_get(network, MSPRING_MASS, NULL, ids[0], 4, read, 1));
        assert_true(read[0] == 1 && read[1] == 2 && read[2] == 3 && read[3] == 4);
        const uint32_t spring = sizeof(mspring_spring_def) + longer[k];
        array = make_springs(spring, 2);
        for (uint32_t i = 0; i < 2; i++) {
            AT(mspring_spring_def, array, spring, i)->a = ids[0];
            AT(mspring_spring_def, array, spring, i)->b = ids[1 + i];
        }
        check_ok(mspring_network_add_springs(network, AT(mspring_spring_def, array, 0, 0), 2, spring_id));
        check_ok(mspring_network_get(network, MSPRING_BREAK_STRAIN, NULL, spring_id[0], 2, read, 1));
        assert_true(read[0] == 2 && read[1] == 3);
        check_ok(mspring_network_remove_particles(network, ids + 3, 0, 1));
        check_ok(mspring_network_remove_particles(network, ids + 2, 0, 1));
        check_components(network, longer[k], ids[0]);
        mspring_network_destroy(network);
    }
}

static void lattices_go_by_the_size_of_their_materials(void **state) {
    (void)state;
    for (size_t k = 0; k < COUNT_OF(longer); k++) {
        const uint32_t size = sizeof(mspring_material) + longer[k];
        const uint16_t cells[] = {0, 1};
        unsigned char *array = fenced((size_t)size * 2);
        mspring_lattice_def lattice;
        check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &lattice, sizeof lattice));
        for (uint32_t i = 0; i < 2; i++) {
            mspring_material *material = AT(mspring_material, array, size, i);
            check_ok(mspring_init(MSPRING_STRUCT_MATERIAL, material, size));
            check_ok(mspring_material_preset(material, MSPRING_PRESET_WOOD, 1, 0.01));
            material->mass = 2 + (float)i;
            material->break_strain = 3 - (float)i;
        }
        check_fence(array);
        lattice.width = 2;
        lattice.height = 1;
        lattice.cells = cells;
        lattice.materials = AT(mspring_material, array, 0, 0);
        lattice.material_count = 2;
        mspring_builder *builder = support_builder();
        check_ok(mspring_builder_add_lattice(builder, &lattice, NULL));
        spoil(array, size, 1);
        check_error(mspring_builder_add_lattice(builder, &lattice, NULL), MSPRING_ERROR_STRUCT);
        check_contains(support_builder_error(builder), "material 1");
        mspring_network *network = support_network(builder, NULL);
        float mass[2], strain;
        check_ok(mspring_network_get(network, MSPRING_MASS, NULL, 0, 2, mass, 1));
        check_ok(mspring_network_get(network, MSPRING_BREAK_STRAIN, NULL, 0, 1, &strain, 1));
        assert_true(mass[0] == 2 && mass[1] == 3 && strain == 2);
        mspring_network_destroy(network);
    }
}

static void tuning_goes_by_the_size_of_its_structs(void **state) {
    (void)state;
    for (size_t k = 0; k < COUNT_OF(longer); k++) {
        enum { MOST = 24 };
        subject s = make_subject();
        const uint32_t size = sizeof(mspring_settings) + longer[k], row = sizeof(mspring_tune_row) + longer[k];
        mspring_tune_def tune;
        uint32_t count = 0, all;
        check_ok(mspring_tune_settings(s.network, 0.01, NULL, 0, &count));
        unsigned char *array = fenced((size_t)size * count);
        set_size(array, size);
        assert_true(count > 2 && count <= MOST);
        check_ok(mspring_tune_settings(s.network, 0.01, AT(mspring_settings, array, 0, 0), count, &all));
        assert_int_equal(AT(mspring_settings, array, size, 1)->struct_size, size);
        assert_int_equal(AT(mspring_settings, array, size, 0)->solver, MSPRING_SOLVER_EXPLICIT);
        assert_int_equal(AT(mspring_settings, array, size, count - 1)->solver, MSPRING_SOLVER_DIRECT);
        check_fence(array);
        // Two of them are tried.
        _Alignas(8) unsigned char tried[2 * (sizeof(mspring_settings) + LONGEST)];
        memcpy(tried, array + (size_t)size * (count - 2), 2 * (size_t)size);
        check_ok(mspring_init(MSPRING_STRUCT_TUNE_DEF, &tune, sizeof tune));
        tune.settings = AT(mspring_settings, tried, 0, 0);
        tune.setting_count = 2;
        tune.duration = tune.dt * 4;
        array = fenced((size_t)row * 2);
        set_size(array, row);
        check_ok(mspring_network_tune(s.network, &tune, AT(mspring_tune_row, array, 0, 0), 2, &all));
        check_fence(array);
        assert_int_equal(AT(mspring_tune_row, array, row, 1)->setting, 1);
        assert_int_equal(AT(mspring_tune_row, array, row, 1)->settings.integrator,
                         AT(mspring_settings, tried, size, 1)->integrator);
        assert_int_equal(AT(mspring_tune_row, array, row, 1)->settings.solver, MSPRING_SOLVER_DIRECT);
        check_nested(array + row, offsetof(mspring_tune_row, settings), row);
        spoil(tried, size, 1);
        check_error(mspring_network_tune(s.network, &tune, AT(mspring_tune_row, array, 0, 0), 2, &all),
                    MSPRING_ERROR_STRUCT);
        check_contains(mspring_network_error(s.network), "setting 1");
        free_subject(&s);
    }
}

/* --------------------------------------------------------------------------------------------------- the table */

static bool is_tried(const char *name) {
    for (size_t i = 0; i < input_count; i++) {
        if (strcmp(inputs[i].name, name) == 0) {
            return true;
        }
    }
    for (size_t i = 0; i < output_count; i++) {
        if (strcmp(outputs[i].name, name) == 0) {
            return true;
        }
    }
    return strcmp(name, "hook_args") == 0; // above
}

// headers.sh checks that the table has each struct of the headers.
static void every_struct_of_the_table_is_tried(void **state) {
    (void)state;
#define INPUT_STRUCT(name, KIND, on_64_bits, on_32_bits, settings)                                                 \
    if (!is_tried(#name)) {                                                                                        \
        fail_msg("mspring_%s is not tried", #name);                                                                \
    }
#define OUTPUT_STRUCT INPUT_STRUCT
#define MSPRINGI_LAWS(...) __VA_ARGS__
#define MSPRINGI_LAB(...) __VA_ARGS__
#include "../../src/base/structs.def"
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(structs_are_taken_as_far_as_they_go),
        cmocka_unit_test(impossible_sizes_are_refused),
        cmocka_unit_test(nested_settings_have_the_size_that_is_left),
        cmocka_unit_test(settings_move_between_structs),
        cmocka_unit_test(reserved_fields_must_be_0),
        cmocka_unit_test(structs_are_filled_as_far_as_they_go),
        cmocka_unit_test(hooks_see_how_long_their_arguments_are),
        cmocka_unit_test(arrays_go_by_the_size_of_their_structs),
        cmocka_unit_test(lattices_go_by_the_size_of_their_materials),
        cmocka_unit_test(tuning_goes_by_the_size_of_its_structs),
        cmocka_unit_test(every_struct_of_the_table_is_tried),
    };
    return cmocka_run_group_tests_name("structs", tests, NULL, NULL);
}

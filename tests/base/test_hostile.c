/// @file test_hostile.c
/// Every public function with everything that is wrong: NULL, numbers that are none or out of range, particles and
/// springs that do not exist, absurd counts, structs of impossible sizes, calls from inside a hook. Each is refused
/// or, where that is documented, accepted; a refusal says why, changes nothing and touches no out-parameter. So
/// does a call that gets no memory, whichever of its allocations it is. Nothing means: no byte of the snapshot.
///
/// The functions are those of the header: one that is missing in the table (hostile.c) fails the test.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "allocator.h"
#include "hostile.h"
#include "recipe.h"
#include "support.h"

/* --------------------------------------------------------------------------------------------------- spoiling */

#define SPOILT_WORDS 4
static const uint32_t spoilt_words[SPOILT_WORDS] = {0x7fc00000u, 0x7f800000u, 0x80000000u, UINT32_MAX};

static void spoil_float(float *value, int n) {
    const float numbers[] = {NAN, INFINITY, -INFINITY};
    *value = numbers[n];
}

static void spoil_double(double *value, int n) {
    const double numbers[] = {NAN, INFINITY, -INFINITY, 0, -1};
    *value = numbers[n];
}

static void set_word(unsigned char *bytes, size_t word, uint32_t value) {
    memcpy(bytes + 4 * word, &value, sizeof value);
}

static uint32_t struct_size_of(const unsigned char *bytes) {
    uint32_t size;
    memcpy(&size, bytes, sizeof size);
    return size;
}

static bool spoil_struct(void **place, unsigned char *bytes, int n) {
    const uint32_t sizes[] = {0, 1, 3, 1u << 20, UINT32_MAX};
    if (n == 0)
        *place = NULL;
    else if (n <= (int)COUNT_OF(sizes))
        set_word(bytes, 0, sizes[n - 1]);
    return n <= (int)COUNT_OF(sizes);
}

static bool spoil_words(arguments *a, int n) {
    const size_t word = 1 + (size_t)n / SPOILT_WORDS;
    if (4 * word >= struct_size_of(a->given_bytes))
        return false;
    set_word(a->given_bytes, word, spoilt_words[n % SPOILT_WORDS]);
    return true;
}

// NULL, or the last of the two values; -1 as well where that is refused like the others.
static bool spoil_floats(const float **array, float *values, int n) {
    if (n == 0)
        *array = NULL;
    else if (n <= 3)
        spoil_float(&values[1], n - 1);
    return n <= 3;
}

static bool spoil_doubles(const double **array, double *values, int n) {
    if (n == 0)
        *array = NULL;
    else if (n <= 3)
        spoil_double(&values[1], n - 1);
    return n <= 3;
}

static bool spoil_range(arguments *a, int n) {
    const uint32_t ranges[][2] = {{UINT32_MAX, 1}, {1000, 1},       {0, UINT32_MAX},
                                  {0, 1000},       {1, UINT32_MAX}, {2, UINT32_MAX - 1}};
    if (n >= (int)COUNT_OF(ranges))
        return false;
    a->first = ranges[n][0];
    a->count = ranges[n][1];
    return true;
}

static bool spoil_ids(arguments *a, int n) {
    if (n == 0)
        a->ids = NULL;
    else if (n <= 2)
        a->id_values[n - 1] = n == 1 ? 1000 : UINT32_MAX;
    return n <= 2;
}

static bool spoil_size(size_t *size, int n, bool large) {
    const size_t sizes[2][3] = {{0, 1, 3}, {SIZE_MAX, SIZE_MAX / 64, (size_t)MSPRING_MAX_SPRINGS + 1}};
    if (n < 3)
        *size = sizes[large][n];
    return n < 3;
}

/// Spoil an argument in its n-th way. Returns false if there are not so many.
static bool spoil(arguments *a, char kind, int n) {
    const uint32_t ids[] = {1000, 1u << 31, UINT32_MAX};
    const int32_t kinds[] = {-1, 99, INT32_MIN, INT32_MAX};
    switch (kind) {
    case 'N':
    case 'n':
        a->network = NULL;
        return n < 1;
    case 'v':
        a->network = NULL;
        a->builder = NULL;
        return n < 1;
    case 'B':
        a->builder = NULL;
        return n < 1;
    case 'I':
        a->id = ids[n < 3 ? n : 0];
        return n < 3;
    case 'R':
    case 'r':
        return spoil_range(a, n);
    case 'A':
    case 'a':
        return spoil_ids(a, n);
    case 'C':
        return spoil_size(&a->size, n, true);
    case 'Z':
        return spoil_size(&a->size, n, false);
    case 'V':
        if (n == 0)
            a->snapshot = NULL;
        else if (n <= 200) // every byte counts, or is zero and not looked at
            a->snapshot_bytes[n * 7 % a->snapshot_size] ^= 1;
        return n <= 200;
    case 'X':
    case 'Y':
        spoil_float(kind == 'X' ? &a->x : &a->y, n < 3 ? n : 0);
        return n < 3;
    case 'T':
    case 'L':
        spoil_double(kind == 'T' ? &a->dt : &a->safety, n < 5 ? n : 0);
        return n < 5;
    case 'J':
        spoil_double(&a->ramp, n < 3 ? n : 4); // 0 is none
        return n < 4;
    case 'K':
    case 'k':
        a->kind = kinds[n < 4 ? n : 0];
        return n < 4;
    case 'F':
    case 'f':
        return spoil_floats(&a->f, a->f_values, n);
    case 'G':
        return spoil_floats(&a->g, a->g_values, n);
    case 'D':
        return spoil_doubles(&a->d, a->d_values, n);
    case 'E':
        return spoil_doubles(&a->e, a->e_values, n);
    case 'S':
    case 's':
        return spoil_struct(&a->given, a->given_bytes, n);
    case 'W':
        return spoil_words(a, n);
    case 'P':
        return spoil_struct(&a->out[0], a->out_bytes[0], n);
    case 'o':
        memset(a->out, 0, sizeof a->out);
        return n < 1;
    default:
        assert_true(kind >= '0' && kind < '0' + OUTS);
        a->out[kind - '0'] = NULL;
        return n < 1;
    }
}

/// True if the call must reject an argument spoilt in this way.
static bool has_to_be_refused(char kind, int n) {
    switch (kind) {
    case 'v':
    case 'k':
    case 'W':
    case 'o':
        return false;
    case 's':
    case 'a':
        return n > 0;
    case 'r':
        return n != 2 && n != 4; // MSPRING_ALL
    case 'f':
        return n != 2; // infinite: never
    default:
        return true;
    }
}

/* ------------------------------------------------------------------------------------------------- the matrix */

static recipe small_recipe(void) {
    uint64_t seed = 6;
    const recipe_stuff stuff = {.mass = {1, 2}, .stiffness = {100, 200}, .damping = {0, 1}};
    recipe made = {0};
    recipe_lattice(&made, 4, 3, 0, 0, 1, &stuff, &seed);
    recipe_particle(&made, 9, 2, 1, MSPRING_PARTICLE_PINNED);
    recipe_rope(&made, 0, made.particle_count - 1, 4, &stuff, &seed);
    recipe_disturb(&made, 0.01, 0.1, &seed);
    return made;
}

static watched_allocator watched; // of all networks here

static void begin(arguments *a) {
    static mspring_allocator allocator;
    recipe made = small_recipe();
    watched = (watched_allocator){0};
    allocator = watched_interface(&watched);
    mspring_network_def def = support_def(-9.8f, 2);
    def.spare_particles = def.spare_springs = 2;
    def.allocator = &allocator;
    memset(a, 0, sizeof *a);
    a->builder = recipe_builder(&made, NULL);
    a->network = recipe_network(&made, &def);
    recipe_free(&made);
    support_steps(a->network, 1, 0.001);
    check_ok(mspring_network_update_components(a->network, NULL, NULL));
    check_ok(mspring_network_reserve_events(a->network, 10));
    check_ok(mspring_network_save(a->network, MSPRING_SNAPSHOT_ALL, a->snapshot_bytes, SNAPSHOT_BYTES,
                                  &a->snapshot_size));
    a->id = 3, a->first = 1, a->count = 2, a->size = 1;
    a->x = 0.5f, a->y = 0.75f, a->dt = 0.001, a->safety = 0.9, a->ramp = 0.5;
    a->f = a->f_values, a->g = a->g_values, a->d = a->d_values, a->e = a->e_values, a->ids = a->id_values;
    for (int i = 0; i < 2; i++) {
        a->f_values[i] = a->g_values[i] = 0.5f + 0.25f * (float)i;
        a->d_values[i] = a->e_values[i] = 0.5 + 0.25 * i;
        a->id_values[i] = 2 + (mspring_id)i;
    }
    a->snapshot = a->snapshot_bytes;
    a->given = a->given_bytes;
    memset(a->out_bytes, 0xa5, sizeof a->out_bytes);
    for (int i = 0; i < OUTS; i++)
        a->out[i] = a->out_bytes[i];
}

/// State that a rejected call must not change.
typedef struct before {
    mspring_network *network;
    mspring_builder *builder;
    uint64_t hash;
    uint32_t particles, springs;
    size_t snapshot_size; ///< 0: cannot be saved here
    unsigned char snapshot[SNAPSHOT_BYTES];
    unsigned char out_bytes[OUTS][OUT_BYTES];
} before;

static before look(const arguments *a) {
    static before b;
    b = (before){.network = a->network,
                 .builder = a->builder,
                 .hash = support_hash(a->network),
                 .particles = mspring_builder_count(a->builder, MSPRING_PARTICLES),
                 .springs = mspring_builder_count(a->builder, MSPRING_SPRINGS)};
    const mspring_result result =
        mspring_network_save(a->network, MSPRING_SNAPSHOT_ALL, b.snapshot, SNAPSHOT_BYTES, &b.snapshot_size);
    assert_true(result == MSPRING_OK || result == MSPRING_ERROR_BUSY);
    return b;
}

static void check_unchanged(const before *b, const arguments *a) {
    static unsigned char snapshot[SNAPSHOT_BYTES];
    size_t size = 0;
    check_ok(mspring_network_save(b->network, MSPRING_SNAPSHOT_ALL, snapshot, SNAPSHOT_BYTES, &size));
    assert_int_equal(size, b->snapshot_size);
    assert_memory_equal(snapshot, b->snapshot, size);
    assert_int_equal(support_hash(b->network), b->hash);
    assert_int_equal(mspring_builder_count(b->builder, MSPRING_PARTICLES), b->particles);
    assert_int_equal(mspring_builder_count(b->builder, MSPRING_SPRINGS), b->springs);
    assert_memory_equal(a->out_bytes, b->out_bytes, sizeof b->out_bytes);
}

static void check_finite(const mspring_network *network) {
    for (mspring_id id = 0; id < mspring_network_count(network, MSPRING_PARTICLES); id++) {
        const support_point p = support_position(network, id), v = support_velocity(network, id);
        assert_true(isfinite(p.x) && isfinite(p.y) && isfinite(v.x) && isfinite(v.y));
    }
}

static void end(const before *b) {
    check_finite(b->network);
    // Whatever happened, it goes on.
    const mspring_result result = mspring_network_step(b->network, 0.001);
    assert_true(result == MSPRING_OK || result == MSPRING_ERROR_UNSTABLE);
    check_finite(b->network);
    mspring_network_destroy(b->network);
    mspring_builder_destroy(b->builder);
}

/// Message in the object that the call is made on; "no place for one" if there is none.
static const char *message_of(const arguments *a, const char *kinds) {
    if (strchr(kinds, 'B'))
        return a->builder ? support_builder_error(a->builder) : "no place for one";
    return strpbrk(kinds, "Nn") && a->network ? mspring_network_error(a->network) : "no place for one";
}

/// True if the message prints an unset id as a number.
static bool tells_unset_id(const char *message) {
    static const char *const words[] = {"particle ", "spring ", "grip ", "hook ", "collider ",
                                        "element ",  "group ",  "from ", "id ",   "number "};
    for (const char *at = message; (at = strstr(at, "4294967295")); at++)
        for (size_t i = 0; i < COUNT_OF(words); i++)
            if ((size_t)(at - message) >= strlen(words[i]) &&
                memcmp(at - strlen(words[i]), words[i], strlen(words[i])) == 0)
                return true;
    return false;
}

static uint32_t spoilt_calls, refused_calls;

/// Call with one argument spoilt. Returns false if there are not so many ways.
static bool try_spoilt(const function *f, char kind, int n) {
    static arguments a;
    begin(&a);
    f->prepare(&a);
    before b = look(&a);
    const bool there = spoil(&a, kind, n);
    memcpy(b.out_bytes, a.out_bytes, sizeof b.out_bytes);
    if (there) {
        const mspring_result result = f->call(&a);
        spoilt_calls++;
        refused_calls += result != MSPRING_OK;
        if (result == MSPRING_OK && has_to_be_refused(kind, n)) {
            print_error("%s, %c spoilt in way %d: accepted\n", f->name, kind, n);
            fail();
        }
        if (result != MSPRING_OK) {
            const char *message = message_of(&a, f->kinds); // a builder forgets it then
            if (strlen(message) == 0)
                print_error("%s, %c spoilt in way %d: refused without a message\n", f->name, kind, n);
            assert_true(strlen(message) > 0);
            assert_true(strlen(message) < 512);
            if (tells_unset_id(message))
                print_error("%s: %s\n", f->name, message);
            assert_false(tells_unset_id(message));
            check_unchanged(&b, &a);
        }
    }
    end(&b);
    return there;
}

static void good_calls_succeed(void **state) {
    (void)state;
    static arguments a;
    for (size_t i = 0; i < hostile_function_count; i++) {
        begin(&a);
        hostile_functions[i].prepare(&a);
        const before b = look(&a);
        const mspring_result result = hostile_functions[i].call(&a);
        if (result != MSPRING_OK)
            print_error("%s: %s%s\n", hostile_functions[i].name, mspring_network_error(a.network),
                        support_builder_error(a.builder));
        check_ok(result);
        end(&b);
    }
}

static void spoilt_calls_are_refused(void **state) {
    (void)state;
    for (size_t i = 0; i < hostile_function_count; i++)
        for (const char *kind = hostile_functions[i].kinds; *kind; kind++)
            for (int n = 0; try_spoilt(&hostile_functions[i], *kind, n); n++) {
            }
    print_message("%u calls of %u functions, %u of them refused\n", spoilt_calls, (unsigned)hostile_function_count,
                  refused_calls);
    assert_true(refused_calls > 800);
}

/* ---------------------------------------------------------------------------------------------- without memory */

/// Call with the n-th of the call's allocations failing. Returns false if there are not so many.
static bool try_without_memory(const function *f, size_t n) {
    static arguments a;
    begin(&a);
    f->prepare(&a);
    before b = look(&a);
    memcpy(b.out_bytes, a.out_bytes, sizeof b.out_bytes);
    watched.fail_at = watched.calls + n;
    const mspring_result result = f->call(&a);
    const bool there = watched.calls >= watched.fail_at;
    watched.fail_at = 0;
    if (there && result == MSPRING_OK)
        print_error("%s, allocation %zu failed: no error\n", f->name, n);
    assert_int_equal(result, there ? MSPRING_ERROR_MEMORY : MSPRING_OK);
    if (there) {
        assert_true(strlen(message_of(&a, f->kinds)) > 0);
        check_unchanged(&b, &a);
        // And it succeeds when there is memory again.
        check_ok(f->call(&a));
    }
    end(&b);
    check_watched_clean(&watched);
    return there;
}

static void calls_without_memory_change_nothing(void **state) {
    (void)state;
    size_t failed = 0;
    for (size_t i = 0; i < hostile_function_count; i++)
        for (size_t n = 1; try_without_memory(&hostile_functions[i], n); n++)
            failed++;
    print_message("%zu allocations, each failed once\n", failed);
    assert_true(failed > 100);
}

/* ---------------------------------------------------------------------------------------------- inside a hook */

typedef struct inside {
    const function *f;
    arguments *a;
    mspring_result result;
} inside;

static void call_inside(const mspring_hook_args *args, void *user) {
    (void)args;
    inside *in = user;
    const before b = look(in->a);
    in->result = in->f->call(in->a);
    assert_int_equal(support_hash(b.network), b.hash);
}

static void hooks_cannot_change_the_network(void **state) {
    (void)state;
    static arguments a;
    for (size_t i = 0; i < hostile_function_count; i++) {
        const function *f = &hostile_functions[i];
        if (!strchr(f->kinds, 'N') && !strchr(f->kinds, 'n'))
            continue;
        begin(&a);
        f->prepare(&a);
        const before b = look(&a);
        inside in = {f, &a, MSPRING_OK};
        check_ok(support_add_hook(a.network, MSPRING_PHASE_AFTER_SUBSTEP, call_inside, &in, NULL));
        check_ok(mspring_network_step(a.network, 0.001));
        if (strchr(f->kinds, 'N') && in.result != MSPRING_ERROR_BUSY)
            print_error("%s: %s\n", f->name, mspring_result_string(in.result));
        assert_true(in.result == MSPRING_ERROR_BUSY || (!strchr(f->kinds, 'N') && in.result == MSPRING_OK));
        in.f = &hostile_functions[0];
        end(&b);
    }
}

/* ------------------------------------------------------------------------------------------------ completeness */

// Of the name of a function; entries of one function more than one have "__" and a word behind it.
static bool is_end(const char *text) {
    return *text == 0 || strncmp(text, "__", 2) == 0;
}

static bool is_in_table(const char *name, size_t length) {
    for (size_t i = 0; i < hostile_function_count; i++)
        if (strncmp(hostile_functions[i].name, name, length) == 0 && is_end(hostile_functions[i].name + length))
            return true;
    return false;
}

static char *read_headers(void) {
    enum { MOST = 1 << 20 };
    static const char *const paths[] = {HOSTILE_HEADERS "core.h", HOSTILE_HEADERS "contact.h",
                                        HOSTILE_HEADERS "laws.h", HOSTILE_HEADERS "batch.h",
                                        HOSTILE_HEADERS "lab.h",  HOSTILE_HEADERS "massspring_gradient.h"};
    char *text = test_malloc(MOST);
    size_t size = 0;
    for (size_t i = 0; i < sizeof paths / sizeof paths[0]; i++) {
        FILE *stream = fopen(paths[i], "rb");
        if (!stream) {
            test_free(text);
            return NULL;
        }
        size += fread(text + size, 1, MOST - 1 - size, stream);
        fclose(stream);
    }
    text[size] = 0;
    return text;
}

static void every_function_is_in_the_table(void **state) {
    (void)state;
    static const char mark[] = "MSPRING_API ", prefix[] = "mspring_";
    char *text = read_headers();
    if (!text) { // built on another machine
        print_message("no headers at %s\n", HOSTILE_HEADERS);
        skip();
    }
    for (char *at = text; (at = strstr(at, mark)) != NULL; at += sizeof mark - 1) {
        const char *end_of_it = strchr(at, ';'), *open = strchr(at, '(');
        const char *line = at;
        while (line > text && line[-1] != '\n')
            line--;
        if (*line == '#' || *line == '/')
            continue;
        assert_true(open && end_of_it && open < end_of_it);
        const char *name = open;
        while (name[-1] == '_' || (name[-1] >= 'a' && name[-1] <= 'z') || (name[-1] >= '0' && name[-1] <= '9'))
            name--;
        assert_memory_equal(name, prefix, sizeof prefix - 1);
        if (!is_in_table(name, (size_t)(open - name))) {
            print_error("%.*s is not in the table\n", (int)(open - name), name);
            fail();
        }
    }
    for (size_t i = 0; i < hostile_function_count; i++) {
        char call[80];
        const char *name = hostile_functions[i].name, *word = strstr(name, "__");
        const int length = (int)(word ? word - name : (ptrdiff_t)strlen(name));
        snprintf(call, sizeof call, " %.*s(", length, name);
        if (!strstr(text, call)) {
            print_error("%s is no function\n", name);
            fail();
        }
    }
    test_free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_function_is_in_the_table),  cmocka_unit_test(good_calls_succeed),
        cmocka_unit_test(spoilt_calls_are_refused),        cmocka_unit_test(calls_without_memory_change_nothing),
        cmocka_unit_test(hooks_cannot_change_the_network),
    };
    return cmocka_run_group_tests_name("hostile", tests, NULL, NULL);
}

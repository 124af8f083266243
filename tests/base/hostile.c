/// How each public function is called.
#include "hostile.h"

#include <stdlib.h>
#include <string.h>

#include "hostile_table.h"
#include "support.h"

static size_t sink; // what functions without a result return

static mspring_result note_size(size_t value) {
    sink += value;
    return MSPRING_OK;
}

static mspring_result note_text(const char *text) {
    assert_non_null(text);
    return note_size(strlen(text));
}

static mspring_result MSPRING_CALL count_bytes(const void *bytes, size_t size, void *user) {
    (void)bytes;
    *(size_t *)user += size;
    return MSPRING_OK;
}

typedef struct archive_bytes {
    unsigned char bytes[1 << 16];
    size_t size;
} archive_bytes;

static mspring_result MSPRING_CALL keep_bytes(const void *bytes, size_t size, void *user) {
    archive_bytes *all = user;
    assert_true(size <= sizeof all->bytes - all->size);
    memcpy(all->bytes + all->size, bytes, size);
    all->size += size;
    return MSPRING_OK;
}

// Into an empty builder, with memory of its own; failing memory and bytes that are spoilt are tested in
// tests/archive.
static mspring_result read_archive(arguments *a) {
    static archive_bytes all;
    mspring_builder *builder = support_builder();
    support_particle(builder, 0, 0, 1);
    mspring_network *network = support_network(builder, NULL);
    all.size = 0;
    check_ok(mspring_network_write(network, keep_bytes, &all));
    mspring_network_destroy(network);
    builder = support_builder();
    const mspring_result result = mspring_builder_read(a->builder ? builder : NULL, all.bytes, all.size, NULL);
    mspring_builder_destroy(builder);
    return result;
}

static mspring_result create_builder(arguments *a) {
    const mspring_result result = mspring_builder_create(a->given, a->out[0]);
    if (result == MSPRING_OK) {
        mspring_builder_destroy(*(mspring_builder **)a->out[0]);
    }
    return result;
}

static mspring_result create_network(arguments *a) {
    const mspring_result result = mspring_network_create(a->builder, a->given, a->out[0]);
    if (result == MSPRING_OK) {
        mspring_network_destroy(*(mspring_network **)a->out[0]);
    }
    return result;
}

static mspring_result clone_network(arguments *a) {
    const mspring_result result = mspring_network_clone(a->network, a->given, a->out[0]);
    if (result == MSPRING_OK) {
        mspring_network_destroy(*(mspring_network **)a->out[0]);
    }
    return result;
}

// Other calls are those of a network without contact.
static mspring_result set_contact(arguments *a) {
    const mspring_result result = mspring_network_set_contact(a->network, a->given);
    if (result == MSPRING_OK) {
        check_ok(mspring_network_set_contact(a->network, NULL));
    }
    return result;
}

static void make_contact(arguments *a) {
    mspring_contact_def def;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &def, sizeof def));
    check_ok(mspring_network_set_contact(a->network, &def));
}

static void make_grip(arguments *a) {
    mspring_grip_def *def = (mspring_grip_def *)(void *)a->given_bytes;
    (void)mspring_init(MSPRING_STRUCT_GRIP_DEF, def, sizeof *def);
    def->particle = 2;
    def->stiffness = 100;
    check_ok(mspring_network_add_grip(a->network, def, &a->id));
}

static void fill_area(arguments *a) {
    mspring_area_def *def = (mspring_area_def *)(void *)a->given_bytes;
    (void)mspring_init(MSPRING_STRUCT_AREA_DEF, def, sizeof *def);
    def->stiffness = 100;
    a->id = 4;
}

static mspring_result add_area(arguments *a) {
    const mspring_id particles[3] = {0, 1, a->id};
    return mspring_network_add_area(a->network, a->given, particles, 3, a->out[0]);
}

// Two, for values of both.
static void make_area(arguments *a) {
    const mspring_id particles[2][3] = {{0, 1, 4}, {1, 2, 5}};
    const void *given = a->given_bytes;
    fill_area(a);
    check_ok(mspring_network_add_area(a->network, given, particles[0], 3, &a->first));
    check_ok(mspring_network_add_area(a->network, given, particles[1], 3, NULL));
    a->id = a->first;
    a->count = 2;
}

static void fill_angle(arguments *a) {
    mspring_angle_def *def = (mspring_angle_def *)(void *)a->given_bytes;
    (void)mspring_init(MSPRING_STRUCT_ANGLE_DEF, def, sizeof *def);
    def->stiffness = 100;
    a->id = 4;
}

static mspring_result add_angle(arguments *a) {
    const mspring_id particles[3] = {0, 1, a->id};
    return mspring_network_add_angles(a->network, a->given, particles, 1, 3, a->out[0]);
}

static void make_angle(arguments *a) {
    const mspring_id particles[6] = {0, 1, 4, 4, 1, 0};
    const void *given = a->given_bytes;
    fill_angle(a);
    check_ok(mspring_network_add_angles(a->network, given, particles, 2, 3, &a->first));
    a->id = a->first;
    a->count = 2;
}

// Colliders go with their contact.
static mspring_result with_collider(arguments *a, mspring_result (*call)(arguments *a, mspring_id id)) {
    mspring_contact_def contact;
    mspring_collider_def def;
    mspring_id id = 0;
    check_ok(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &contact, sizeof contact));
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    def.kind = MSPRING_COLLIDER_CIRCLE;
    def.radius = 1;
    if (!a->network) {
        return call(a, id);
    }
    mspring_result result = mspring_network_set_contact(a->network, &contact);
    if (result != MSPRING_OK) {
        return result;
    }
    result = mspring_network_add_collider(a->network, &def, &id);
    if (result == MSPRING_OK) {
        result = call(a, id);
    }
    check_ok(mspring_network_set_contact(a->network, NULL));
    if (result != MSPRING_OK) {
        assert_true(call(a, id) != MSPRING_OK); // messages go with the contact: test_collider_calls.c
    }
    return result;
}

static mspring_result add_collider(arguments *a, mspring_id id) {
    mspring_collider_def def;
    (void)id;
    check_ok(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def));
    def.kind = MSPRING_COLLIDER_BOX;
    return mspring_network_add_collider(a->network, &def, NULL);
}

static mspring_result remove_collider(arguments *a, mspring_id id) {
    return mspring_network_remove_collider(a->network, id);
}

static mspring_result move_collider(arguments *a, mspring_id id) {
    return mspring_network_move_collider(a->network, id, 1, 2, 3);
}

static mspring_result place_collider(arguments *a, mspring_id id) {
    return mspring_network_place_collider(a->network, id, 1, 2, 3);
}

static mspring_result get_collider(arguments *a, mspring_id id) {
    mspring_collider_def def = {.struct_size = sizeof def};
    return mspring_network_get_collider(a->network, id, &def);
}

static mspring_result read_contact_events(arguments *a, mspring_id id) {
    mspring_contact_event event = {.struct_size = sizeof event};
    uint32_t count;
    (void)id;
    return mspring_network_read_contact_events(a->network, &event, 1, &count, NULL);
}

static mspring_result get_collider_impulse(arguments *a, mspring_id id) {
    double x, y, angular;
    return mspring_network_get_collider_impulse(a->network, id, &x, &y, &angular);
}

static void make_components(arguments *a) {
    mspring_body *bodies = (mspring_body *)(void *)a->out_bytes[0];
    bodies->struct_size = sizeof *bodies;
    check_ok(mspring_network_update_components(a->network, NULL, NULL));
    a->first = 0, a->count = 1;
}

static void make_groups(arguments *a) {
    const uint32_t firsts[] = {0, mspring_network_count(a->network, MSPRING_PARTICLES)};
    check_ok(support_set_guard(a->network, MSPRING_GUARD_BOUNDS));
    check_ok(mspring_network_set_groups(a->network, firsts, 1));
    a->id_values[0] = a->id = a->first = 0;
    a->id_values[1] = firsts[1];
    a->count = 1;
}

static void make_actuators(arguments *a) {
    const mspring_id springs[] = {1, 3};
    check_ok(mspring_network_set_actuators(a->network, springs, 2, 1));
}

static mspring_result add_copies(arguments *a) {
    mspring_builder *one = support_builder();
    (void)support_particle(one, 1, 2, 3);
    const mspring_result result =
        mspring_builder_add_copies(a->builder, one, 2, a->d, a->e, 1, a->out[0], a->out[1]);
    mspring_builder_destroy(one);
    return result;
}

static mspring_result destroy_nothing(void) {
    mspring_builder_destroy(NULL);
    mspring_network_destroy(NULL);
    return MSPRING_OK;
}

static void *host_alloc(size_t size, size_t alignment, void *user) {
    (void)alignment, (void)user;
    return malloc(size);
}

static void host_free(void *memory, size_t size, void *user) {
    (void)size, (void)user;
    free(memory);
}

static void no_hook(const mspring_hook_args *args, void *user) {
    (void)args, (void)user;
}

/// Ways to make what is given.
#define NOTHING ((void)0)
#define FILL(KIND, type) ((void)mspring_init(MSPRING_STRUCT_##KIND, a->given_bytes, sizeof(mspring_##type)))
/// Out-parameter i is a struct.
#define OUT_STRUCT(i, type) (*(uint32_t *)(void *)a->out_bytes[i] = (uint32_t)sizeof(mspring_##type))

static void make_allocator(arguments *a) {
    const mspring_allocator made = {.struct_size = sizeof made, .alloc = host_alloc, .free = host_free};
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_spring(arguments *a) {
    mspring_spring_def made;
    check_ok(mspring_init(MSPRING_STRUCT_SPRING_DEF, &made, sizeof made));
    made.a = 0, made.b = 7;
    memcpy(a->given_bytes, &made, sizeof made);
}

/// Material of ropes, meshes, discs and lattices.
static const mspring_material *plain(void) {
    static mspring_material material;
    material = mspring_material_default();
    return &material;
}

static void make_rope(arguments *a) {
    mspring_rope_def made;
    check_ok(mspring_init(MSPRING_STRUCT_ROPE_DEF, &made, sizeof made));
    made.from = 0, made.to = 7, made.segment_count = 2, made.material = plain();
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_lattice(arguments *a) {
    static const uint16_t cells[4] = {0, 0, 0, 0};
    mspring_lattice_def made;
    check_ok(mspring_init(MSPRING_STRUCT_LATTICE_DEF, &made, sizeof made));
    made.width = made.height = 2, made.cells = cells, made.materials = plain(), made.material_count = 1;
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_mesh(arguments *a) {
    static const double x[3] = {0, 1, 0}, y[3] = {0, 0, 1};
    static const uint32_t triangle[3] = {0, 1, 2};
    mspring_mesh_def made;
    check_ok(mspring_init(MSPRING_STRUCT_MESH_DEF, &made, sizeof made));
    made.vertex_count = 3, made.triangle_count = 1, made.x = x, made.y = y, made.triangles = triangle;
    made.material = plain();
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_disc(arguments *a) {
    mspring_disc_def made;
    check_ok(mspring_init(MSPRING_STRUCT_DISC_DEF, &made, sizeof made));
    made.material = plain();
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_hook(arguments *a) {
    mspring_hook_def made;
    check_ok(mspring_init(MSPRING_STRUCT_HOOK_DEF, &made, sizeof made));
    made.fn = no_hook;
    memcpy(a->given_bytes, &made, sizeof made);
}

/// One setting to be tried in a few short steps.
static void make_tune(arguments *a) {
    static mspring_settings setting;
    mspring_tune_def made;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &setting, sizeof setting));
    check_ok(mspring_init(MSPRING_STRUCT_TUNE_DEF, &made, sizeof made));
    made.settings = &setting, made.setting_count = 1, made.dt = 0.001, made.duration = 0.004;
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_settings(arguments *a) {
    const mspring_settings made = support_settings(a->network);
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_floor(arguments *a) {
    static const double plane[4] = {0, -1, 0, 1};
    mspring_floor_def made;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &made, sizeof made));
    made.planes = plane, made.plane_count = 1;
    memcpy(a->given_bytes, &made, sizeof made);
}

// Networks of most kinds have no gradient; tests/gradient has those that do.
static mspring_result no_gradient(mspring_result result) {
    return result == MSPRING_ERROR_ARGUMENT ? MSPRING_OK : MSPRING_ERROR_ARGUMENT;
}

static mspring_result begin_job(arguments *a) {
    mspring_job *job = NULL;
    mspring_result result = mspring_job_begin(a->network, (mspring_layout)a->kind, a->out[0] ? &job : NULL);
    mspring_job_destroy(job);
    return result;
}

static mspring_result run_job(const arguments *a) {
    mspring_job *job = NULL;
    if (!a->network) {
        check_error(mspring_job_run(NULL, 0, NULL), MSPRING_ERROR_ARGUMENT);
        return MSPRING_OK;
    }
    mspring_result result = mspring_job_begin(a->network, MSPRING_LAYOUT_COMPACT, &job);
    if (result == MSPRING_OK) {
        result = mspring_job_run(job, 0, NULL);
    }
    assert_non_null(mspring_job_error(job));
    mspring_job_destroy(job);
    return result;
}

static mspring_result finish_job(const arguments *a) {
    mspring_job *job = NULL;
    mspring_result result = a->network ? mspring_job_begin(a->network, MSPRING_LAYOUT_COMPACT, &job) : MSPRING_OK;
    if (result == MSPRING_ERROR_MEMORY) {
        return result;
    }
    if (job && mspring_job_run(job, 0, NULL) != MSPRING_OK) {
        assert_true(strlen(mspring_job_error(job)) > 0);
    }
    result = mspring_job_finish(a->network, job);
    mspring_job_destroy(job);
    return result;
}

static void add_hook(arguments *a) {
    check_ok(support_add_hook(a->network, MSPRING_PHASE_BEFORE_STEP, no_hook, NULL, &a->id));
}

#define DEFINE(name, kinds, prepare, call)                                                                         \
    static void prepare_##name(arguments *a) {                                                                     \
        (void)a;                                                                                                   \
        prepare;                                                                                                   \
    }                                                                                                              \
    static mspring_result call_##name(arguments *a) {                                                              \
        (void)a;                                                                                                   \
        return call;                                                                                               \
    }
FUNCTIONS(DEFINE)

#define ENTRY(name, kinds, prepare, call) {#name, kinds, prepare_##name, call_##name},
const function hostile_functions[] = {FUNCTIONS(ENTRY)};
const size_t hostile_function_count = COUNT_OF(hostile_functions);

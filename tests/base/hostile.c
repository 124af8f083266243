/// How each public function is called.
#include "hostile.h"

#include <stdlib.h>
#include <string.h>

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

// Into an empty builder, with memory of its own; failing memory and bytes that are spoilt are tested in tests/archive.
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

// Contact goes again, and its messages with it: ranges are tested in test_touching.c.
static mspring_result set_contact_groups(arguments *a) {
    mspring_contact_def def;
    check_ok(mspring_contact_def_init(&def, sizeof def));
    mspring_result result = mspring_network_set_contact(a->network, &def);
    if (result == MSPRING_OK) {
        result = mspring_network_set_contact_groups(a->network, a->first, a->count, 1, 2);
        check_ok(mspring_network_set_contact(a->network, NULL));
    }
    return result;
}

static mspring_result set_contact_surface(arguments *a) {
    mspring_contact_def def;
    check_ok(mspring_contact_def_init(&def, sizeof def));
    mspring_result result = mspring_network_set_contact(a->network, &def);
    if (result == MSPRING_OK) {
        result = mspring_network_set_contact_surface(a->network, a->first, a->count, 0.5f, -1);
        check_ok(mspring_network_set_contact(a->network, NULL));
    }
    if (result != MSPRING_OK) { // messages go with the contact
        assert_true(mspring_network_set_contact_surface(a->network, 0, 1, 0, 0) != MSPRING_OK);
    }
    return result;
}

static void make_grip(arguments *a) {
    mspring_grip_def *def = (mspring_grip_def *)(void *)a->given_bytes;
    (void)mspring_grip_def_init(def, sizeof *def);
    def->particle = 2;
    def->stiffness = 100;
    check_ok(mspring_network_add_grip(a->network, def, &a->id));
}

static void fill_area(arguments *a) {
    mspring_area_def *def = (mspring_area_def *)(void *)a->given_bytes;
    (void)mspring_area_def_init(def, sizeof *def);
    def->stiffness = 100;
    a->id = 4;
}

static mspring_result add_area(arguments *a) {
    const mspring_id particles[3] = {0, 1, a->id};
    return mspring_network_add_area(a->network, a->given, particles, 3, a->out[0]);
}

static void make_area(arguments *a) {
    const mspring_id particles[3] = {0, 1, 4};
    fill_area(a);
    check_ok(mspring_network_add_area(a->network, (const mspring_area_def *)(const void *)a->given_bytes, particles,
                                      3, &a->id));
}

static void fill_angle(arguments *a) {
    mspring_angle_def *def = (mspring_angle_def *)(void *)a->given_bytes;
    (void)mspring_angle_def_init(def, sizeof *def);
    def->stiffness = 100;
    a->id = 4;
}

static mspring_result add_angle(arguments *a) {
    const mspring_id particles[3] = {0, 1, a->id};
    return mspring_network_add_angles(a->network, a->given, particles, 1, a->out[0]);
}

static void make_angle(arguments *a) {
    const mspring_id particles[6] = {0, 1, 4, 4, 1, 0};
    const void *given = a->given_bytes;
    fill_angle(a);
    check_ok(mspring_network_add_angles(a->network, given, particles, 2, &a->first));
    a->id = a->first;
    a->count = 2;
}

// Colliders go with their contact.
static mspring_result with_collider(arguments *a, mspring_result (*call)(arguments *a, mspring_id id)) {
    mspring_contact_def contact;
    mspring_collider_def def;
    mspring_id id = 0;
    check_ok(mspring_contact_def_init(&contact, sizeof contact));
    check_ok(mspring_collider_def_init(&def, sizeof def));
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
    check_ok(mspring_collider_def_init(&def, sizeof def));
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

static mspring_result reserve_contact_events(arguments *a, mspring_id id) {
    (void)id;
    return mspring_network_reserve_contact_events(a->network, 100);
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

static void make_groups(arguments *a) {
    const uint32_t firsts[] = {0, mspring_network_particle_count(a->network)};
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
#define FILL(type) ((void)mspring_##type##_init((mspring_##type *)(void *)a->given_bytes, sizeof(mspring_##type)))
/// Out-parameter i is a struct.
#define OUT_STRUCT(i, type) (*(uint32_t *)(void *)a->out_bytes[i] = (uint32_t)sizeof(mspring_##type))

static void make_allocator(arguments *a) {
    const mspring_allocator made = {.struct_size = sizeof made, .alloc = host_alloc, .free = host_free};
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_spring(arguments *a) {
    mspring_spring_def made;
    check_ok(mspring_spring_def_init(&made, sizeof made));
    made.a = 0, made.b = 7;
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_rope(arguments *a) {
    mspring_rope_def made;
    check_ok(mspring_rope_def_init(&made, sizeof made));
    made.from = 0, made.to = 7, made.segment_count = 2;
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_lattice(arguments *a) {
    static const uint16_t cells[4] = {0, 0, 0, 0};
    static mspring_material material;
    mspring_lattice_def made;
    check_ok(mspring_material_init(&material, sizeof material));
    check_ok(mspring_lattice_def_init(&made, sizeof made));
    made.width = made.height = 2, made.cells = cells, made.materials = &material, made.material_count = 1;
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_mesh(arguments *a) {
    static const double x[3] = {0, 1, 0}, y[3] = {0, 0, 1};
    static const uint32_t triangle[3] = {0, 1, 2};
    mspring_mesh_def made;
    check_ok(mspring_mesh_def_init(&made, sizeof made));
    made.vertex_count = 3, made.triangle_count = 1, made.x = x, made.y = y, made.triangles = triangle;
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_hook(arguments *a) {
    mspring_hook_def made;
    check_ok(mspring_hook_def_init(&made, sizeof made));
    made.fn = no_hook;
    memcpy(a->given_bytes, &made, sizeof made);
}

/// One setting to be tried in a few short steps.
static void make_tune(arguments *a) {
    static mspring_solver_def setting;
    mspring_tune_def made;
    check_ok(mspring_solver_def_init(&setting, sizeof setting));
    check_ok(mspring_tune_def_init(&made, sizeof made));
    made.settings = &setting, made.setting_count = 1, made.dt = 0.001, made.duration = 0.004;
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_tune_row(arguments *a) {
    const mspring_tune_row made = {.struct_size = sizeof made, .substeps = 1};
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_settings(arguments *a) {
    const mspring_settings made = support_settings(a->network);
    memcpy(a->given_bytes, &made, sizeof made);
}

static void make_floor(arguments *a) {
    static const double plane[4] = {0, -1, 0, 1};
    mspring_floor_def made;
    check_ok(mspring_floor_def_init(&made, sizeof made));
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

/// Setting and reading a property, whose values are refused where floats is F: name is what follows in the table's.
#define PROPERTY(X, name, property, floats)                                                                        \
    X(mspring_network_set##name, "NKR" floats, a->kind = property,                                                 \
      mspring_network_set(a->network, a->kind, a->first, a->count, a->f, 1))                                       \
    X(mspring_network_set_at##name, "NKA" floats, a->kind = property,                                              \
      mspring_network_set_at(a->network, a->kind, a->ids, a->count, a->f, 1))                                      \
    MEASURED(X, name, property)
#define MEASURED(X, name, property)                                                                                \
    X(mspring_network_get##name, "nKR0", a->kind = property,                                                       \
      mspring_network_get(a->network, a->kind, a->first, a->count, a->out[0], 1))                                  \
    X(mspring_network_get_at##name, "nKA0", a->kind = property,                                                    \
      mspring_network_get_at(a->network, a->kind, a->ids, a->count, a->out[0], 1))

/// Name, kinds of arguments, what makes the struct given, the call.
#define FUNCTIONS(X)                                                                                               \
    X(mspring_version, "", NOTHING, note_size(mspring_version()))                                                  \
    X(mspring_version_string, "", NOTHING, note_text(mspring_version_string()))                                    \
    X(mspring_features, "", NOTHING, note_size(mspring_features()))                                                \
    X(mspring_result_string, "k", NOTHING, note_text(mspring_result_string(a->kind)))                              \
    X(mspring_particle_def_init, "Z0", a->size = sizeof(mspring_particle_def),                                     \
      mspring_particle_def_init(a->out[0], a->size))                                                               \
    X(mspring_spring_def_init, "Z0", a->size = sizeof(mspring_spring_def),                                         \
      mspring_spring_def_init(a->out[0], a->size))                                                                 \
    X(mspring_material_init, "Z0", a->size = sizeof(mspring_material), mspring_material_init(a->out[0], a->size))  \
    X(mspring_lattice_def_init, "Z0", a->size = sizeof(mspring_lattice_def),                                       \
      mspring_lattice_def_init(a->out[0], a->size))                                                                \
    X(mspring_rope_def_init, "Z0", a->size = sizeof(mspring_rope_def), mspring_rope_def_init(a->out[0], a->size))  \
    X(mspring_mesh_def_init, "Z0", a->size = sizeof(mspring_mesh_def), mspring_mesh_def_init(a->out[0], a->size))  \
    X(mspring_disc_def_init, "Z0", a->size = sizeof(mspring_disc_def), mspring_disc_def_init(a->out[0], a->size))  \
    X(mspring_solver_def_init, "Z0", a->size = sizeof(mspring_solver_def),                                         \
      mspring_solver_def_init(a->out[0], a->size))                                                                 \
    X(mspring_network_def_init, "Z0", a->size = sizeof(mspring_network_def),                                       \
      mspring_network_def_init(a->out[0], a->size))                                                                \
    X(mspring_settings_init, "Z0", a->size = sizeof(mspring_settings), mspring_settings_init(a->out[0], a->size))  \
    X(mspring_allocator_init, "Z0", a->size = sizeof(mspring_allocator),                                           \
      mspring_allocator_init(a->out[0], a->size))                                                                  \
    X(mspring_tasks_init, "Z0", a->size = sizeof(mspring_tasks), mspring_tasks_init(a->out[0], a->size))           \
    X(mspring_settle_def_init, "Z0", a->size = sizeof(mspring_settle_def),                                         \
      mspring_settle_def_init(a->out[0], a->size))                                                                 \
    X(mspring_hook_def_init, "Z0", a->size = sizeof(mspring_hook_def), mspring_hook_def_init(a->out[0], a->size))  \
    X(mspring_clone_def_init, "Z0", a->size = sizeof(mspring_clone_def),                                           \
      mspring_clone_def_init(a->out[0], a->size))                                                                  \
    X(mspring_builder_create, "s0", make_allocator(a), create_builder(a))                                          \
    X(mspring_builder_destroy, "", NOTHING, destroy_nothing())                                                     \
    X(mspring_builder_error, "v", NOTHING, note_text(mspring_builder_error(a->builder)))                           \
    X(mspring_builder_particle_count, "v", NOTHING, note_size(mspring_builder_particle_count(a->builder)))         \
    X(mspring_builder_spring_count, "v", NOTHING, note_size(mspring_builder_spring_count(a->builder)))             \
    X(mspring_builder_add_particle, "BSWo", FILL(particle_def),                                                    \
      mspring_builder_add_particle(a->builder, a->given, a->out[0]))                                               \
    X(mspring_builder_add_particles, "BSWCo", FILL(particle_def),                                                  \
      mspring_builder_add_particles(a->builder, a->given, (uint32_t)a->size, a->out[0]))                           \
    X(mspring_builder_add_spring, "BSWo", make_spring(a),                                                          \
      mspring_builder_add_spring(a->builder, a->given, a->out[0]))                                                 \
    X(mspring_builder_add_springs, "BSWCo", make_spring(a),                                                        \
      mspring_builder_add_springs(a->builder, a->given, (uint32_t)a->size, a->out[0]))                             \
    X(mspring_builder_add_lattice, "BSo", make_lattice(a),                                                         \
      mspring_builder_add_lattice(a->builder, a->given, a->out[0]))                                                \
    X(mspring_builder_add_rope, "BSo", make_rope(a),                                                               \
      mspring_builder_add_rope(a->builder, a->given, a->out[0], a->out[0] ? 3 : 0, a->out[1]))                     \
    X(mspring_builder_add_mesh, "BSo", make_mesh(a),                                                               \
      mspring_builder_add_mesh(a->builder, a->given, a->out[0], a->out[1]))                                        \
    X(mspring_builder_add_disc, "BSWo", FILL(disc_def),                                                            \
      mspring_builder_add_disc(a->builder, a->given, a->out[0], a->out[1]))                                        \
    X(mspring_material_preset, "Z0KT", (a->size = sizeof(mspring_material), a->kind = MSPRING_PRESET_WOOD),        \
      mspring_material_preset(a->out[0], a->size, a->kind, 1, a->dt))                                              \
    X(mspring_builder_get_particles, "BIP", OUT_STRUCT(0, particle_def),                                            \
      mspring_builder_get_particles(a->builder, NULL, a->id, 1, a->out[0]))                                        \
    X(mspring_builder_get_springs, "BIP", OUT_STRUCT(0, spring_def),                                                \
      mspring_builder_get_springs(a->builder, NULL, a->id, 1, a->out[0]))                                          \
    X(mspring_builder_read, "B", NOTHING, read_archive(a))                                                          \
    X(mspring_builder_get_network_def, "BP", OUT_STRUCT(0, network_def),                                            \
      mspring_builder_get_network_def(a->builder, a->out[0]))                                                      \
    X(mspring_network_write, "n", NOTHING, mspring_network_write(a->network, count_bytes, &sink))                   \
    X(mspring_builder_add_network, "Bno", NOTHING,                                                                 \
      mspring_builder_add_network(a->builder, a->network, NULL, 0, a->out[0], a->out[1]))                          \
    X(mspring_network_create, "Bs0", FILL(network_def), create_network(a))                                         \
    X(mspring_network_destroy, "", NOTHING, destroy_nothing())                                                     \
    X(mspring_network_clone, "ns0", FILL(clone_def), clone_network(a))                                             \
    X(mspring_network_error, "v", NOTHING, note_text(mspring_network_error(a->network)))                           \
    X(mspring_network_particle_count, "v", NOTHING, note_size(mspring_network_particle_count(a->network)))         \
    X(mspring_network_spring_count, "v", NOTHING, note_size(mspring_network_spring_count(a->network)))             \
    X(mspring_network_get_step_info, "nP", OUT_STRUCT(0, step_info),                                               \
      mspring_network_get_step_info(a->network, a->out[0]))                                                        \
    X(mspring_network_get_solver, "nP", OUT_STRUCT(0, solver_def),                                                 \
      mspring_network_get_solver(a->network, a->out[0]))                                                           \
    X(mspring_network_get_floor, "nP", OUT_STRUCT(0, floor_def), mspring_network_get_floor(a->network, a->out[0])) \
    X(mspring_network_simd_level, "v", NOTHING, note_size((size_t)mspring_network_simd_level(a->network)))         \
    X(mspring_network_worker_count, "v", NOTHING, note_size(mspring_network_worker_count(a->network)))             \
    X(mspring_network_memory_used, "v", NOTHING, note_size(mspring_network_memory_used(a->network)))               \
    X(mspring_simd_supported, "", NOTHING, note_size((size_t)mspring_simd_supported()))                            \
    X(mspring_simd_available, "k", NOTHING, note_size(mspring_simd_available(a->kind)))                            \
    X(mspring_simd_name, "k", NOTHING, note_text(mspring_simd_name(a->kind)))                                      \
    X(mspring_network_set_solver, "NSW", FILL(solver_def), mspring_network_set_solver(a->network, a->given))       \
    X(mspring_network_get_settings, "nP", OUT_STRUCT(0, settings),                                                 \
      mspring_network_get_settings(a->network, a->out[0]))                                                         \
    X(mspring_network_set_settings, "NSW", make_settings(a), mspring_network_set_settings(a->network, a->given))   \
    X(mspring_network_step, "NT", NOTHING, mspring_network_step(a->network, a->dt))                                \
    X(mspring_network_stable_dt, "No", NOTHING, mspring_network_stable_dt(a->network, a->out[0], a->out[1]))       \
    X(mspring_network_suggest_substeps, "NTL0", NOTHING,                                                           \
      mspring_network_suggest_substeps(a->network, a->dt, a->safety, a->out[0]))                                   \
    X(mspring_network_settle, "NsWo", (FILL(settle_def), OUT_STRUCT(0, settle_result)),                            \
      mspring_network_settle(a->network, a->given, a->out[0]))                                                     \
    X(mspring_tune_def_init, "Z0", a->size = sizeof(mspring_tune_def), mspring_tune_def_init(a->out[0], a->size))  \
    X(mspring_tune_scene_init, "Z0", a->size = sizeof(mspring_tune_scene),                                         \
      mspring_tune_scene_init(a->out[0], a->size))                                                                 \
    X(mspring_tune_settings, "NT0", NOTHING, mspring_tune_settings(a->network, a->dt, NULL, 0, a->out[0]))         \
    X(mspring_network_tune, "NsP1", (make_tune(a), OUT_STRUCT(0, tune_row)),                                       \
      mspring_network_tune(a->network, a->given, a->out[0], 1, a->out[1]))                                         \
    X(mspring_tune_row_solver, "SP", (make_tune_row(a), OUT_STRUCT(0, solver_def)),                                \
      mspring_tune_row_solver(a->given, a->out[0]))                                                                \
    X(mspring_network_apply_force, "NIXY", NOTHING, mspring_network_apply_force(a->network, a->id, a->x, a->y))    \
    X(mspring_network_apply_forces, "NRFG", NOTHING,                                                               \
      mspring_network_apply_forces(a->network, a->first, a->count, a->f, a->g, 1))                                 \
    X(mspring_network_apply_forces_at, "NAFG", NOTHING,                                                            \
      mspring_network_apply_forces_at(a->network, a->ids, a->count, a->f, a->g, 1))                                \
    X(mspring_network_apply_impulses, "NRFG", NOTHING,                                                             \
      mspring_network_apply_impulses(a->network, a->first, a->count, a->f, a->g, 1))                               \
    X(mspring_network_apply_impulses_at, "NAFG", NOTHING,                                                          \
      mspring_network_apply_impulses_at(a->network, a->ids, a->count, a->f, a->g, 1))                              \
    X(mspring_network_apply_torque, "NRX", NOTHING,                                                                \
      mspring_network_apply_torque(a->network, NULL, a->first, a->count, a->x))                                    \
    X(mspring_network_set_positions_float_at, "NAFG", NOTHING,                                                     \
      mspring_network_set_positions_float_at(a->network, a->ids, a->count, a->f, a->g, 1))                         \
    X(mspring_network_add_hook, "NSo", make_hook(a), mspring_network_add_hook(a->network, a->given, a->out[0]))    \
    X(mspring_network_remove_hook, "NI", add_hook(a), mspring_network_remove_hook(a->network, a->id))              \
    X(mspring_network_view, "nP", OUT_STRUCT(0, view), mspring_network_view(a->network, a->out[0]))                \
    X(mspring_network_view_mutable, "NP", OUT_STRUCT(0, mutable_view),                                             \
      mspring_network_view_mutable(a->network, a->out[0]))                                                         \
    X(mspring_network_get_positions, "nR01", NOTHING,                                                              \
      mspring_network_get_positions(a->network, a->first, a->count, a->out[0], a->out[1], 1))                      \
    X(mspring_network_get_positions_float, "nR01", NOTHING,                                                        \
      mspring_network_get_positions_float(a->network, a->first, a->count, a->out[0], a->out[1], 1))                \
    X(mspring_network_get_velocities, "nR01", NOTHING,                                                             \
      mspring_network_get_velocities(a->network, a->first, a->count, a->out[0], a->out[1], 1))                     \
    X(mspring_network_get_positions_at, "nA01", NOTHING,                                                           \
      mspring_network_get_positions_at(a->network, a->ids, a->count, a->out[0], a->out[1], 1))                     \
    X(mspring_network_get_positions_float_at, "nA01", NOTHING,                                                     \
      mspring_network_get_positions_float_at(a->network, a->ids, a->count, a->out[0], a->out[1], 1))               \
    X(mspring_network_get_velocities_at, "nA01", NOTHING,                                                          \
      mspring_network_get_velocities_at(a->network, a->ids, a->count, a->out[0], a->out[1], 1))                    \
    X(mspring_network_set_positions, "NRDE", NOTHING,                                                              \
      mspring_network_set_positions(a->network, a->first, a->count, a->d, a->e, 1))                                \
    X(mspring_network_set_positions_float, "NRFG", NOTHING,                                                        \
      mspring_network_set_positions_float(a->network, a->first, a->count, a->f, a->g, 1))                          \
    X(mspring_network_set_velocities, "NRFG", NOTHING,                                                             \
      mspring_network_set_velocities(a->network, a->first, a->count, a->f, a->g, 1))                               \
    X(mspring_network_set_positions_at, "NADE", NOTHING,                                                           \
      mspring_network_set_positions_at(a->network, a->ids, a->count, a->d, a->e, 1))                               \
    X(mspring_network_set_velocities_at, "NAFG", NOTHING,                                                          \
      mspring_network_set_velocities_at(a->network, a->ids, a->count, a->f, a->g, 1))                              \
    PROPERTY(X, , MSPRING_MASS, "F")                                                                               \
    PROPERTY(X, _inverse_mass_scale, MSPRING_INVERSE_MASS_SCALE, "F")                                              \
    PROPERTY(X, _stiffness, MSPRING_STIFFNESS, "F")                                                                \
    PROPERTY(X, _damping, MSPRING_DAMPING, "F")                                                                    \
    PROPERTY(X, _rest_length, MSPRING_REST_LENGTH, "F")                                                            \
    PROPERTY(X, _break_strain, MSPRING_BREAK_STRAIN, "f")                                                          \
    PROPERTY(X, _stress_strain, MSPRING_STRESS_STRAIN, "f")                                                        \
    PROPERTY(X, _relax_strain, MSPRING_RELAX_STRAIN, "f")                                                          \
    MEASURED(X, _strain, MSPRING_STRAIN)                                                                           \
    MEASURED(X, _length, MSPRING_LENGTH)                                                                           \
    MEASURED(X, _force, MSPRING_FORCE)                                                                             \
    MEASURED(X, _active_stiffness, MSPRING_ACTIVE_STIFFNESS)                                                       \
    MEASURED(X, _active_damping, MSPRING_ACTIVE_DAMPING)                                                           \
    MEASURED(X, _active_rest_length, MSPRING_ACTIVE_REST_LENGTH)                                                   \
    X(mspring_network_renew_relative_springs, "N", NOTHING, mspring_network_renew_relative_springs(a->network))    \
    X(mspring_network_break_springs, "NA", NOTHING, mspring_network_break_springs(a->network, a->ids, a->count))   \
    X(mspring_network_restore_springs, "NAJ", NOTHING,                                                             \
      mspring_network_restore_springs(a->network, a->ids, a->count, a->ramp))                                      \
    X(mspring_network_detach_particles, "NA", NOTHING,                                                             \
      mspring_network_detach_particles(a->network, a->ids, a->count))                                              \
    X(mspring_network_has_particle, "v", NOTHING, note_size(mspring_network_has_particle(a->network, a->id)))      \
    X(mspring_network_has_spring, "v", NOTHING, note_size(mspring_network_has_spring(a->network, a->id)))          \
    X(mspring_network_add_particles, "NSW0", FILL(particle_def),                                                   \
      mspring_network_add_particles(a->network, a->given, 1, a->out[0]))                                           \
    X(mspring_network_add_springs, "NSW0", make_spring(a),                                                         \
      mspring_network_add_springs(a->network, a->given, 1, a->out[0]))                                             \
    X(mspring_network_remove_particles, "NA", NOTHING,                                                             \
      mspring_network_remove_particles(a->network, a->ids, a->count))                                              \
    X(mspring_network_remove_springs, "NA", NOTHING, mspring_network_remove_springs(a->network, a->ids, a->count)) \
    X(mspring_network_recycle, "N", NOTHING, mspring_network_recycle(a->network))                                  \
    X(mspring_network_reserve_events, "N", NOTHING, mspring_network_reserve_events(a->network, 100))               \
    X(mspring_network_read_events, "N01", NOTHING,                                                                 \
      mspring_network_read_events(a->network, a->out[0], 8, a->out[1], a->out[2]))                                 \
    X(mspring_network_update_components, "No", NOTHING,                                                            \
      mspring_network_update_components(a->network, a->out[0], a->out[1]))                                         \
    X(mspring_network_get_component_numbers, "nR0", NOTHING,                                                       \
      mspring_network_get_component_numbers(a->network, a->first, a->count, a->out[0], 1))                         \
    X(mspring_network_get_components, "nRP", (a->count = 1, a->first = 0, OUT_STRUCT(0, component)),               \
      mspring_network_get_components(a->network, a->first, a->count, a->out[0]))                                   \
    X(mspring_network_energy, "no", NOTHING, mspring_network_energy(a->network, a->out[0], a->out[1], a->out[2]))  \
    X(mspring_area_def_init, "Z0", a->size = sizeof(mspring_area_def), mspring_area_def_init(a->out[0], a->size))  \
    X(mspring_network_add_area, "NSWIo", fill_area(a), add_area(a))                                                \
    X(mspring_network_add_cell_areas, "NSWo", fill_area(a),                                                        \
      mspring_network_add_cell_areas(a->network, a->given, a->out[0], a->out[1]))                                  \
    X(mspring_network_remove_area, "NI", make_area(a), mspring_network_remove_area(a->network, a->id))             \
    X(mspring_network_set_area, "NISW", make_area(a), mspring_network_set_area(a->network, a->id, a->given))       \
    X(mspring_network_get_area, "nIP", (make_area(a), OUT_STRUCT(0, area_def)),                                    \
      mspring_network_get_area(a->network, a->id, a->out[0]))                                                      \
    X(mspring_network_get_area_info, "nIP", (make_area(a), OUT_STRUCT(0, area_info)),                              \
      mspring_network_get_area_info(a->network, a->id, a->out[0]))                                                 \
    X(mspring_network_get_area_particles, "nI01", make_area(a),                                                    \
      mspring_network_get_area_particles(a->network, a->id, a->out[0], 8, a->out[1]))                              \
    X(mspring_network_get_areas, "no3", NOTHING,                                                                   \
      mspring_network_get_areas(a->network, a->out[0], a->out[1], a->out[2], 8, a->out[3]))                        \
    X(mspring_network_get_angles, "no3", NOTHING,                                                                  \
      mspring_network_get_angles(a->network, a->out[0], a->out[1], a->out[2], 8, a->out[3]))                       \
    X(mspring_angle_def_init, "Z0", a->size = sizeof(mspring_angle_def),                                           \
      mspring_angle_def_init(a->out[0], a->size))                                                                  \
    X(mspring_network_add_angles, "NSWIo", fill_angle(a), add_angle(a))                                            \
    X(mspring_network_remove_angle, "NI", make_angle(a), mspring_network_remove_angle(a->network, a->id))          \
    X(mspring_network_set_angle, "NISW", make_angle(a), mspring_network_set_angle(a->network, a->id, a->given))    \
    X(mspring_network_set_rest_angles, "NRD", make_angle(a),                                                       \
      mspring_network_set_rest_angles(a->network, a->first, a->count, a->d, 1))                                    \
    X(mspring_network_get_angle, "nIP", (make_angle(a), OUT_STRUCT(0, angle_def)),                                 \
      mspring_network_get_angle(a->network, a->id, a->out[0]))                                                     \
    X(mspring_network_get_angle_info, "nIP", (make_angle(a), OUT_STRUCT(0, angle_info)),                           \
      mspring_network_get_angle_info(a->network, a->id, a->out[0]))                                                \
    X(mspring_network_get_plasticity, "nP", OUT_STRUCT(0, plasticity),                                             \
      mspring_network_get_plasticity(a->network, a->out[0]))                                                       \
    X(mspring_network_momentum, "no", NOTHING,                                                                     \
      mspring_network_momentum(a->network, a->out[0], a->out[1], a->out[2]))                                       \
    X(mspring_network_bounds, "n0123", NOTHING,                                                                    \
      mspring_network_bounds(a->network, a->out[0], a->out[1], a->out[2], a->out[3]))                              \
    X(mspring_network_get_body, "nRP", OUT_STRUCT(0, body),                                                        \
      mspring_network_get_body(a->network, NULL, a->first, a->count, a->out[0]))                                   \
    X(mspring_network_nearest_particle, "nXY0", NOTHING,                                                           \
      mspring_network_nearest_particle(a->network, a->x, a->y, 10, a->out[0], a->out[1]))                          \
    X(mspring_network_particles_in_circle, "nXY01", NOTHING,                                                       \
      mspring_network_particles_in_circle(a->network, a->x, a->y, 10, a->out[0], 8, a->out[1]))                    \
    X(mspring_network_particles_in_box, "n01", NOTHING,                                                            \
      mspring_network_particles_in_box(a->network, -1, -1, 1, 1, a->out[0], 8, a->out[1]))                         \
    X(mspring_network_nearest_spring, "nXY0", NOTHING,                                                             \
      mspring_network_nearest_spring(a->network, a->x, a->y, 10, 3, a->out[0], a->out[1], a->out[2]))              \
    X(mspring_network_springs_in_circle, "nXY01", NOTHING,                                                         \
      mspring_network_springs_in_circle(a->network, a->x, a->y, 10, 3, a->out[0], 8, a->out[1]))                   \
    X(mspring_network_springs_across, "nXY01", NOTHING,                                                            \
      mspring_network_springs_across(a->network, -1, -1, a->x, a->y, 1, a->out[0], NULL, 8, a->out[1]))            \
    X(mspring_network_get_ends, "nRK01", a->kind = MSPRING_ENDS_SLOTS,                                             \
      mspring_network_get_ends(a->network, a->first, a->count, a->kind, a->out[0], a->out[1], sizeof(uint32_t)))   \
    X(mspring_network_get_spring_flags, "nR0", NOTHING,                                                            \
      mspring_network_get_spring_flags(a->network, a->first, a->count, a->out[0], sizeof(uint32_t)))               \
    X(mspring_network_get_spring, "nIP", OUT_STRUCT(0, spring_info),                                               \
      mspring_network_get_spring(a->network, a->id, a->out[0]))                                                    \
    X(mspring_network_get_extents, "No", NOTHING,                                                                  \
      mspring_network_get_extents(a->network, a->out[0], NULL, NULL, a->out[1]))                                   \
    X(mspring_network_max_strain, "no", NOTHING, mspring_network_max_strain(a->network, a->out[0], a->out[1]))     \
    X(mspring_network_state_hash, "n0", NOTHING, mspring_network_state_hash(a->network, a->out[0]))                \
    X(mspring_network_snapshot_size, "nK0", a->kind = MSPRING_SNAPSHOT_ALL,                                        \
      mspring_network_snapshot_size(a->network, a->kind, a->out[0]))                                               \
    X(mspring_network_save, "nKZ0",                                                                                \
      (a->kind = MSPRING_SNAPSHOT_FRAME, a->size = SNAPSHOT_BYTES, a->out[0] = a->snapshot_bytes),                 \
      mspring_network_save(a->network, a->kind, a->out[0], a->size, a->out[1]))                                    \
    X(mspring_network_load, "NZV", a->size = a->snapshot_size,                                                     \
      mspring_network_load(a->network, a->snapshot, a->size))                                                      \
    X(mspring_floor_def_init, "Z0", a->size = sizeof(mspring_floor_def),                                           \
      mspring_floor_def_init(a->out[0], a->size))                                                                  \
    X(mspring_network_set_floor, "Ns", make_floor(a), mspring_network_set_floor(a->network, a->given))             \
    X(mspring_network_get_floor_impulses, "nR01", NOTHING,                                                         \
      mspring_network_get_floor_impulses(a->network, a->first, a->count, a->out[0], a->out[1], 1))                 \
    X(mspring_contact_def_init, "Z0", a->size = sizeof(mspring_contact_def),                                       \
      mspring_contact_def_init(a->out[0], a->size))                                                                \
    X(mspring_network_set_contact, "Ns", FILL(contact_def), set_contact(a))                                        \
    X(mspring_network_set_contact_groups, "N", NOTHING, set_contact_groups(a))                                     \
    X(mspring_network_set_contact_surface, "N", NOTHING, set_contact_surface(a))                                   \
    X(mspring_network_get_contact, "nP", OUT_STRUCT(0, contact_def),                                               \
      mspring_network_get_contact(a->network, a->out[0]))                                                          \
    X(mspring_network_get_contact_info, "nP", OUT_STRUCT(0, contact_info),                                         \
      mspring_network_get_contact_info(a->network, a->out[0]))                                                     \
    X(mspring_builder_add_strain_limits, "BRXYo", NOTHING,                                                         \
      mspring_builder_add_strain_limits(a->builder, a->first, a->count, a->x, a->y, a->out[0]))                    \
    X(mspring_builder_add_copies, "BDE", NOTHING, add_copies(a))                                                   \
    X(mspring_network_set_groups, "NA", make_groups(a), mspring_network_set_groups(a->network, a->ids, 1))         \
    X(mspring_network_group_count, "v", NOTHING, note_size(mspring_network_group_count(a->network)))               \
    X(mspring_network_get_group_flags, "nR0", make_groups(a),                                                      \
      mspring_network_get_group_flags(a->network, a->first, a->count, a->out[0], 1))                               \
    X(mspring_network_mark_groups, "NI", make_groups(a), mspring_network_mark_groups(a->network, &a->id, 1))       \
    X(mspring_network_reset_groups, "NIK", (make_groups(a), a->kind = MSPRING_RESET_MARK),                         \
      mspring_network_reset_groups(a->network, &a->id, 1, (mspring_reset)a->kind))                                 \
    X(mspring_network_observe_groups, "nRI0", make_groups(a),                                                      \
      mspring_network_observe_groups(a->network, a->first, a->count, &a->id, 1, a->out[0], 13))                    \
    X(mspring_network_set_actuators, "NA", NOTHING, mspring_network_set_actuators(a->network, a->ids, 2, 1))       \
    X(mspring_network_actuator_count, "v", NOTHING, note_size(mspring_network_actuator_count(a->network)))         \
    X(mspring_network_set_signals, "NRF", (make_actuators(a), a->first = 0),                                       \
      mspring_network_set_signals(a->network, a->first, a->count, a->f, 1))                                        \
    X(mspring_grip_def_init, "Z0", a->size = sizeof(mspring_grip_def), mspring_grip_def_init(a->out[0], a->size))  \
    X(mspring_network_add_grip, "NSWo", make_grip(a), mspring_network_add_grip(a->network, a->given, a->out[0]))   \
    X(mspring_network_remove_grip, "NI", make_grip(a), mspring_network_remove_grip(a->network, a->id))             \
    X(mspring_network_set_grip, "NISW", make_grip(a), mspring_network_set_grip(a->network, a->id, a->given))       \
    X(mspring_network_move_grip, "NIXY", make_grip(a), mspring_network_move_grip(a->network, a->id, a->x, a->y))   \
    X(mspring_network_get_grip, "nIP", (make_grip(a), OUT_STRUCT(0, grip_def)),                                    \
      mspring_network_get_grip(a->network, a->id, a->out[0]))                                                      \
    X(mspring_network_get_grip_impulse, "nI01", make_grip(a),                                                      \
      mspring_network_get_grip_impulse(a->network, a->id, a->out[0], a->out[1]))                                   \
    X(mspring_network_reserve_contact_events, "N", NOTHING, with_collider(a, reserve_contact_events))              \
    X(mspring_network_read_contact_events, "N", NOTHING, with_collider(a, read_contact_events))                    \
    X(mspring_collider_def_init, "Z0", a->size = sizeof(mspring_collider_def),                                     \
      mspring_collider_def_init(a->out[0], a->size))                                                               \
    X(mspring_network_add_collider, "N", NOTHING, with_collider(a, add_collider))                                  \
    X(mspring_network_remove_collider, "N", NOTHING, with_collider(a, remove_collider))                            \
    X(mspring_network_move_collider, "N", NOTHING, with_collider(a, move_collider))                                \
    X(mspring_network_place_collider, "N", NOTHING, with_collider(a, place_collider))                              \
    X(mspring_network_get_collider, "n", NOTHING, with_collider(a, get_collider))                                  \
    X(mspring_network_get_collider_impulse, "n", NOTHING, with_collider(a, get_collider_impulse))                  \
    X(mspring_network_get_sleepers, "nR0", NOTHING,                                                                \
      mspring_network_get_sleepers(a->network, a->first, a->count, a->out[0], 1))                                  \
    X(mspring_network_step_flags, "v", NOTHING, note_size(mspring_network_step_flags(a->network)))                 \
    X(mspring_network_is_asleep, "v", NOTHING, note_size(mspring_network_is_asleep(a->network)))                   \
    X(mspring_network_wake, "N", NOTHING, mspring_network_wake(a->network))                                        \
    X(mspring_network_compact, "N", NOTHING, mspring_network_compact(a->network))                                  \
    X(mspring_network_expand, "N", NOTHING, mspring_network_expand(a->network))                                    \
    X(mspring_job_begin, "NK0", a->kind = MSPRING_LAYOUT_WHOLE, begin_job(a))                                      \
    X(mspring_job_run, "v", NOTHING, run_job(a))                                                                   \
    X(mspring_job_finish, "N", NOTHING, finish_job(a))                                                             \
    X(mspring_job_error, "", NOTHING, note_text(mspring_job_error(NULL)))                                          \
    X(mspring_job_destroy, "", NOTHING, (mspring_job_destroy(NULL), MSPRING_OK))                                   \
    X(mspring_gradient_create, "", NOTHING, no_gradient(mspring_gradient_create(NULL, 1, NULL, 0, NULL)))          \
    X(mspring_gradient_step, "", NOTHING, no_gradient(mspring_gradient_step(NULL, 1, NULL, NULL)))                 \
    X(mspring_gradient_add_seeds, "", NOTHING,                                                                     \
      no_gradient(mspring_gradient_add_seeds(NULL, NULL, 0, 0, NULL, NULL)))                                       \
    X(mspring_gradient_reverse, "", NOTHING, no_gradient(mspring_gradient_reverse(NULL, 0)))                       \
    X(mspring_gradient_get, "", NOTHING,                                                                           \
      no_gradient(mspring_gradient_get(NULL, MSPRING_GRADIENT_X, NULL, 0, 0, NULL, 1)))                            \
    X(mspring_gradient_get_signals, "", NOTHING, no_gradient(mspring_gradient_get_signals(NULL, 0, NULL)))         \
    X(mspring_gradient_get_forces, "", NOTHING, no_gradient(mspring_gradient_get_forces(NULL, 0, NULL)))           \
    X(mspring_gradient_error, "", NOTHING, note_text(mspring_gradient_error(NULL)))                                \
    X(mspring_gradient_destroy, "", NOTHING, (mspring_gradient_destroy(NULL), MSPRING_OK))                         \
    X(mspring_network_get_plan, "nP", OUT_STRUCT(0, plan), mspring_network_get_plan(a->network, a->out[0]))

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

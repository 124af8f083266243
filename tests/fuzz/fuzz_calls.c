/// @file fuzz_calls.c
/// A network of any kind, and any calls on it: at two instruction sets and two numbers of workers at once, which
/// all have to answer the same and to hold the same bits, whatever they are asked. Nothing that is not finite may
/// come out, and a refused call may change nothing: neither the snapshot nor what follows, as one of them never
/// makes the calls that the first was refused. That one also has a caller who rounds upwards. Another one loads the
/// first one's snapshot after each call, and saves the same bytes. Networks whose numbers are mild are compared
/// with the plain reference in double precision as well.
///
/// SPDX-License-Identifier: MIT
#include <fenv.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include <massspring/massspring_gradient.h>

#include "calls.h"
#include "check.h"
#include "recipe.h"
#include "reference.h"
#include "step/finite.h"
#include "support.h"

/// The first is scalar; the second may have workers; the third is spared what the first is refused; the last loads.
enum { SCALAR, WORKERS, SPARED, LOADED, TWINS, MOST_CALLS = 48, MOST_PARTICLES = 600 };

/// The same network several times.
typedef struct twins {
    mspring_network *of[TWINS];
    uint32_t particles, springs;
    uint64_t look;
    fuzz_saved saved; ///< of the first
} twins;

/* ---------------------------------------------------------------------------------------------------- numbers */

static float any_number(fuzz_bytes *bytes) {
    static const float extremes[] = {0,     -0.0f, 1e-45f, 1e-38f, 1e-30f, 1e-9f,  1e-6f,    1e6f,      1e9f,
                                     1e12f, 1e15f, 1e30f,  3e38f,  -1,     -1e30f, INFINITY, -INFINITY, NAN};
    const uint8_t kind = fuzz_byte(bytes);
    if (kind < 40)
        return extremes[kind % COUNT_OF(extremes)];
    const float mild = (float)(fuzz_byte(bytes) + 1) / 16.0f;
    return kind < 100 ? mild : kind < 150 ? mild * 100.0f : kind < 200 ? mild * 1e5f : mild - 8.0f;
}

static double step_length(fuzz_bytes *bytes) {
    static const double lengths[] = {1.0 / 64, 1.0 / 64, 1e-3, 1e-3, 1e-6, 0.25,    1.0,
                                     1e-40,    1e30,     0,    -1,   NAN,  INFINITY};
    return lengths[fuzz_byte(bytes) % COUNT_OF(lengths)];
}

static uint32_t below(fuzz_bytes *bytes, uint32_t bound) {
    const uint32_t drawn = fuzz_byte(bytes) * 256u + fuzz_byte(bytes);
    return bound > 0 ? drawn % bound : 0;
}

/* ---------------------------------------------------------------------------------------------------- networks */

static recipe make_recipe(fuzz_bytes *bytes, bool mild) {
    recipe made = {0};
    uint64_t seed = 1 + fuzz_byte(bytes) * 256u + fuzz_byte(bytes);
    const uint8_t kinds = fuzz_byte(bytes);
    const double stiffness = exp(fuzz_byte(bytes) / 20.0);
    const uint32_t side = (kinds >> 2 & 3) < 3 ? 0u
                          : kinds & 1          ? MSPRING_SPRING_PULL_ONLY
                                               : MSPRING_SPRING_PUSH_ONLY;
    const recipe_stuff stuff = {.mass = {1, 1 + (kinds & 3)},
                                .stiffness = {stiffness, stiffness * (1 + (kinds >> 2 & 3))},
                                .damping = {0, kinds & 16 ? sqrt(stiffness) : 0},
                                .spring_flags = mild ? 0
                                                     : (kinds & 32 ? MSPRING_SPRING_RELATIVE : 0u) |
                                                           (kinds & 2 ? MSPRING_SPRING_METRES : 0u) | side,
                                .pinned = kinds & 64 ? 0.05 : 0,
                                .holes = kinds & 128 ? 0.3 : 0};
    for (int piece = 1 + fuzz_byte(bytes) % 3; piece > 0; piece--) {
        const uint32_t before = made.particle_count;
        switch (fuzz_byte(bytes) % 3) {
        case 0:
            recipe_lattice(&made, 1 + below(bytes, 20), 1 + below(bytes, 8), 30.0 * piece, 0, 1, &stuff, &seed);
            break;
        case 1:
            for (uint32_t i = 2 + below(bytes, 40); i > 0; i--)
                recipe_particle(&made, support_random_between(&seed, -20, -1),
                                support_random_between(&seed, -20, 20), 1 + (double)(i % 3), 0);
            if (made.particle_count - before > 12)
                recipe_random_springs(&made, 3 + below(bytes, 60), &stuff, &seed);
            break;
        default:
            recipe_particle(&made, -3 * piece, -30, 1, MSPRING_PARTICLE_PINNED);
            recipe_particle(&made, 20 + piece, -33, 1, 0);
            recipe_rope(&made, before, before + 1, 1 + below(bytes, 40), &stuff, &seed);
        }
    }
    if (made.particle_count == 0)
        recipe_particle(&made, 0, 0, 1, 0);
    recipe_disturb(&made, mild ? 0.01 : 0.1, 0.1, &seed);
    if (fuzz_byte(bytes) & 1)
        recipe_shuffle(&made, &seed, NULL);
    for (int changes = mild ? 0 : fuzz_byte(bytes) % 8; changes > 0; changes--) {
        mspring_particle_def *particle = &made.particles[below(bytes, made.particle_count)];
        float *const fields[] = {&particle->mass, &particle->vx, &particle->vy};
        const uint8_t which = fuzz_byte(bytes);
        if (which % 8 < 3)
            *fields[which % 8] = any_number(bytes);
        else if (which % 8 == 3)
            particle->x = (double)any_number(bytes);
        else if (made.spring_count > 0) {
            mspring_spring_def *spring = &made.springs[below(bytes, made.spring_count)];
            float *const values[] = {&spring->stiffness, &spring->damping, &spring->rest_length,
                                     &spring->stiffness};
            *values[which % 8 - 4] = any_number(bytes);
        }
    }
    return made;
}

static bool make_twins(twins *made, const recipe *from, bool mild, fuzz_bytes *bytes) {
    mspring_builder *builder = NULL;
    FUZZ_CHECK(mspring_builder_create(NULL, &builder) == MSPRING_OK);
    mspring_network_def def;
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_NETWORK_DEF, &def, sizeof def) == MSPRING_OK);
    const uint8_t settings = fuzz_byte(bytes);
    def.settings.substeps = settings % 8 == 7 ? MSPRING_SUBSTEPS_AUTO : 1 + settings % 8 * 3u;
    def.settings.max_substeps = 64;
    def.settings.global_damping = settings & 32 ? 0.5f : 0;
    def.settings.gravity_y = settings & 64 ? any_number(bytes) : -9.8f;
    const bool workers = settings & 128;
    const uint8_t more = fuzz_byte(bytes);
    def.settings.guard = more % 32 < 8    ? MSPRING_GUARD_CLAMP
                : more % 32 < 14 ? MSPRING_GUARD_CLAMP_BOUNDS
                                 : settings / 8 % 4;
    def.settings.sleep_speed = more % 4 == 0 && !mild ? 0.1f : 0; // the reference never sleeps
    def.settings.sleep_time = 0.01f;
    def.spare_particles = def.spare_springs = settings & 16 ? 24 : 0;
    bool whole =
        mspring_builder_add_particles(builder, from->particles, from->particle_count, NULL) == MSPRING_OK &&
        mspring_builder_add_springs(builder, from->springs, from->spring_count, NULL) == MSPRING_OK;
    const uint32_t limited = more % 8 == 1 && !mild ? from->spring_count / 2 : 0; // the reference knows none
    const bool has_limits = whole && limited > 0 &&
                            mspring_builder_add_strain_limits(builder, NULL, 0, limited, more & 16 ? -0.05f : 0.05f, more & 32 ? 9 : 0.5f, NULL) == MSPRING_OK;
    *made = (twins){.particles = from->particle_count + def.spare_particles,
                    .springs = from->spring_count + (has_limits ? limited : 0) + def.spare_springs};
    for (int i = 0; i < TWINS && whole; i++) {
        def.simd_level = i == SCALAR ? MSPRING_SIMD_SCALAR : MSPRING_SIMD_AUTO;
        def.worker_count = i == WORKERS && workers ? 2 : 1;
        whole = mspring_network_create(builder, &def, &made->of[i]) == MSPRING_OK;
        FUZZ_CHECK(whole || i == 0); // one as the other
    }
    if (!whole)
        FUZZ_CHECK(strlen(support_builder_error(builder)) > 0);
    mspring_builder_destroy(builder);
    return whole;
}

/* ---------------------------------------------------------------------------------------------------- checks */

static uint64_t hash_of(const mspring_network *network) {
    uint64_t hash = 0;
    FUZZ_CHECK(mspring_network_get_state_hash(network, &hash) == MSPRING_OK);
    return hash;
}

static void mix(uint64_t *hash, const void *bytes, size_t size) {
    for (size_t i = 0; i < size; i++)
        *hash = (*hash ^ ((const uint8_t *)bytes)[i]) * UINT64_C(0x100000001b3); // FNV-1a
}

// Mix the impulses on colliders into a hash.
static void mix_colliders(const mspring_network *network, uint64_t *look) {
    for (mspring_id id = 0; id < 8; id++) {
        double impulse[3];
        if (mspring_network_get_collider_impulse(network, id, &impulse[0], &impulse[1], &impulse[2]) == MSPRING_OK)
            mix(look, impulse, sizeof impulse);
    }
}

// All that there is to see of a network, but for its error message.
static uint64_t look_of(const mspring_network *network) {
    uint64_t look = hash_of(network);
    const uint32_t particles = mspring_network_count(network, MSPRING_PARTICLES),
                   springs = mspring_network_count(network, MSPRING_SPRINGS);
    const uint64_t numbers[] = {particles, springs, support_substeps(network), support_is_asleep(network),
                                support_fallback_count(network)};
    mix(&look, numbers, sizeof numbers);
    for (mspring_id p = 0; p < particles; p++) {
        uint8_t asleep;
        float mass[2], impulse[2];
        FUZZ_CHECK(support_get_sleepers(network, p, 1, &asleep, 1) == MSPRING_OK);
        FUZZ_CHECK(mspring_network_get(network, MSPRING_MASS, NULL, p, 1, &mass[0], 1) == MSPRING_OK);
        FUZZ_CHECK(mspring_network_get(network, MSPRING_INVERSE_MASS_SCALE, NULL, p, 1, &mass[1], 1) == MSPRING_OK);
        FUZZ_CHECK(mspring_network_get_columns(network, NULL, p, 1, (const mspring_column[]){{MSPRING_FLOOR_IMPULSE_X, 1, &impulse[0]}, {MSPRING_FLOOR_IMPULSE_Y, 1, &impulse[1]}}, 2) == MSPRING_OK);
        mix(&look, &asleep, sizeof asleep);
        mix(&look, mass, sizeof mass);
        mix(&look, impulse, sizeof impulse);
    }
    for (mspring_id s = 0; s < springs; s++) {
        support_spring_info info;
        if (support_get_spring(network, s, &info) != MSPRING_OK) // it was removed
            continue;
        mspring_id ends[2] = {0};
        uint32_t flags = 0;
        FUZZ_CHECK(mspring_network_get_columns(network, NULL, s, 1, (const mspring_column[]){{MSPRING_END_A, 1, &ends[0]}, {MSPRING_END_B, 1, &ends[1]}}, 2) == MSPRING_OK);
        FUZZ_CHECK(mspring_network_get_integers(network, MSPRING_SPRING_FLAGS, NULL, s, 1, &flags, 1) == MSPRING_OK);
        FUZZ_CHECK(ends[0] == info.a && ends[1] == info.b && flags == info.flags);
        info.stiffness += 0.0f, info.damping += 0.0f, info.force += 0.0f; // -0 is as good as 0
        mix(&look, &info, sizeof info);
    }
    mix_colliders(network, &look);
    call_look(network, &look, mix);
    return look;
}

static void check_finite(const mspring_network *network, uint32_t count) {
    double x[MOST_PARTICLES], y[MOST_PARTICLES];
    float vx[MOST_PARTICLES], vy[MOST_PARTICLES];
    count = count < MOST_PARTICLES ? count : MOST_PARTICLES;
    FUZZ_CHECK(mspring_network_get_positions(network, NULL, 0, count, x, y, 1) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_get_velocities(network, NULL, 0, count, vx, vy, 1) == MSPRING_OK);
    for (uint32_t i = 0; i < count; i++)
        FUZZ_CHECK(isfinite(x[i]) && isfinite(y[i]) && isfinite(vx[i]) && isfinite(vy[i]));
}

// All save the same, the last one once it has loaded that.
static void check_snapshots(twins *all, const call *c, bool is_refused) {
    static const char *const names[TWINS] = {"", "with workers", "without refused calls", "that was loaded"};
    char after[80];
    const fuzz_saved before = all->saved;
    all->saved = fuzz_save(all->of[SCALAR]);
    snprintf(after, sizeof after, "call %u (%u), refused", (unsigned)c->kind, (unsigned)c->kind % 52);
    if (is_refused)
        fuzz_check_saves(all->of[SCALAR], &before, after);
    free(before.bytes);
    for (int i = 0; i < TWINS; i++) {
        if (i == LOADED) {
            const mspring_result result = mspring_network_load(all->of[i], all->saved.bytes, all->saved.size);
            if (result != MSPRING_OK)
                fprintf(stderr, "%s\n", mspring_network_error(all->of[i]));
            FUZZ_CHECK(result == MSPRING_OK);
        }
        snprintf(after, sizeof after, "call %u (%u), in the one %s", (unsigned)c->kind, (unsigned)c->kind % 52,
                 names[i]);
        fuzz_check_saves(all->of[i], &all->saved, after);
    }
}

// A step that MSPRING_GUARD_RETRY gives up for its work raises the substeps of the next one.
static bool has_raised_substeps(const mspring_network *network, mspring_result result) {
    return result == MSPRING_ERROR_UNSTABLE && strstr(mspring_network_error(network), "most_work") != NULL;
}

// The same answer from all, and the same bits; from a refusal nothing but a message.
static void check_answers(twins *all, const call *c, const mspring_result results[TWINS], bool is_refused) {
    for (int i = 0; i < TWINS; i++) {
        FUZZ_CHECK(results[i] == results[SCALAR]);
        FUZZ_CHECK(hash_of(all->of[i]) == hash_of(all->of[SCALAR]));
        FUZZ_CHECK(support_substeps(all->of[i]) == support_substeps(all->of[SCALAR]));
    }
    const uint64_t look = look_of(all->of[SCALAR]);
    FUZZ_CHECK(look_of(all->of[look % 2 ? WORKERS : SPARED]) == look); // now this one, now that
    FUZZ_CHECK(!is_refused || look == all->look);
    FUZZ_CHECK(results[SCALAR] == MSPRING_OK || strlen(mspring_network_error(all->of[SCALAR])) > 0);
    all->look = look;
    check_finite(all->of[SCALAR], mspring_network_count(all->of[SCALAR], MSPRING_PARTICLES));
    FUZZ_CHECK(mspringi_is_finite(all->of[SCALAR]));
    check_snapshots(all, c, is_refused);
}

/* ---------------------------------------------------------------------------------------------------- calls */

static mspring_result set_floor(mspring_network *network, const call *c) {
    const double plane[4] = {(double)c->a, (double)c->b, c->particle % 3 - 1.0, 1};
    const float heights[3] = {c->a, c->b, c->a};
    mspring_floor_def def;
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def) == MSPRING_OK);
    def.planes = plane;
    def.plane_count = c->count % 2;
    def.heights = heights;
    def.height_count = c->spring % 2 ? 3 : 0;
    def.heights_y = -30;
    def.friction = c->b;
    def.plane_frictions = def.height_frictions = c->particle % 5 == 1 ? heights : NULL;
    def.plane_restitutions = def.height_restitutions = c->particle % 5 == 2 ? heights : NULL;
    def.silt_depth = c->particle % 5 == 3 ? 20.0f : 0.0f;
    def.silt_rate = c->a;
    def.silt_depths = c->particle % 10 == 4 ? heights : NULL;
    return mspring_network_set_floor(network, c->count == 2 ? NULL : &def);
}

static mspring_result set_contact(mspring_network *network, const call *c) {
    mspring_contact_def def;
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_CONTACT_DEF, &def, sizeof def) == MSPRING_OK);
    def.flags = c->spring % 2 ? MSPRING_CONTACT_SELF : 0;
    def.thickness = c->particle % 2 ? (double)c->a : 0.0;
    def.friction = c->b;
    def.restitution = c->particle % 3 == 0 ? 0.5f : 0.0f;
    return mspring_network_set_contact(network, c->count == 2 ? NULL : &def);
}

static mspring_result set_who_touches(mspring_network *network, const call *c) {
    const mspring_property surface = c->spring % 2 ? MSPRING_FRICTION : MSPRING_RESTITUTION;
    if (c->spring % 3 == 1)
        return mspring_network_set(network, surface, NULL, c->particle, c->count, &c->a, 0);
    return support_set_layers(network, c->particle, c->count, c->spring, c->spring | 1);
}

static mspring_result change_grip(mspring_network *network, const call *c) {
    mspring_grip_def def;
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_GRIP_DEF, &def, sizeof def) == MSPRING_OK);
    def.particle = c->particle;
    def.x = (double)c->a;
    def.y = (double)c->b;
    def.stiffness = c->b;
    def.damping = c->spring % 2 ? c->a : 0.0f;
    def.max_force = c->spring % 3 ? 1000.0f : MSPRING_NEVER;
    const mspring_id grip = c->spring % 20;
    if (c->count == 2)
        return mspring_network_remove_grip(network, grip);
    return c->count == 1 ? mspring_network_set_grip(network, grip, &def)
                         : mspring_network_add_grip(network, &def, NULL);
}

// One of a few: added, moved, put somewhere or removed.
static mspring_result change_collider(mspring_network *network, const call *c) {
    const mspring_id id = c->particle % 4;
    const double points[6] = {(double)c->a, -2, 0, (double)c->b, 20, -2};
    mspring_collider_def def;
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_COLLIDER_DEF, &def, sizeof def) == MSPRING_OK);
    switch (c->spring % 6) {
    case 0:
        return mspring_network_remove_collider(network, id);
    case 1:
        return mspring_network_place_collider(network, id, (double)c->a, (double)c->b, (double)c->b);
    case 2:
    case 3:
        return mspring_network_move_collider(network, id, (double)c->a, (double)c->b, (double)c->a);
    default:
        def.kind = (mspring_collider_kind)(c->particle % 3);
        def.points = points;
        def.point_count = def.kind == MSPRING_COLLIDER_CHAIN ? 3 : 0;
        def.flags = c->count == 1 && def.kind == MSPRING_COLLIDER_CHAIN ? MSPRING_COLLIDER_CLOSED : 0;
        def.radius = def.kind == MSPRING_COLLIDER_CHAIN ? 0 : (double)c->b;
        def.width = (double)c->a;
        def.friction = c->b;
        return mspring_network_add_collider(network, &def, NULL);
    }
}

// A job, of which some functions are run, and with luck all. One that is not run to its end changes nothing, just
// as one that finds nothing to do; a network that remembers this needs no function for it, one that was loaded
// some.
static mspring_result change_layout(mspring_network *network, const call *c) {
    mspring_job *job = NULL;
    const mspring_layout layout = c->spring % 4 == 0 ? MSPRING_LAYOUT_WHOLE : MSPRING_LAYOUT_COMPACT;
    mspring_result result = mspring_job_begin(network, layout, &job);
    uint32_t left = 1;
    if (result == MSPRING_OK)
        result = mspring_job_run(job, c->particle, &left);
    if (result == MSPRING_OK)
        result = mspring_job_finish(network, job);
    FUZZ_CHECK(left == 0 || result != MSPRING_OK);
    mspring_job_destroy(job);
    return left > 0 && result == MSPRING_ERROR_BUSY ? MSPRING_OK : result;
}

// Some steps of a clone and back, if it has a gradient. What was recorded is computed again with the same bits.
static void go_back(const mspring_network *network) {
    mspring_network *clone = NULL;
    mspring_gradient *gradient = NULL;
    const double seed[2] = {1, -1};
    double values[2];
    uint32_t steps = 0;
    if (mspring_network_clone(network, NULL, &clone) != MSPRING_OK)
        return;
    if (mspring_gradient_create(clone, 3, NULL, 0, &gradient) != MSPRING_OK)
        FUZZ_CHECK(mspring_network_error(clone)[0] != 0);
    while (gradient && steps < 3 && mspring_gradient_step(gradient, 0.01, NULL, NULL) == MSPRING_OK)
        steps++;
    if (gradient) {
        mspring_result result = mspring_gradient_add_seeds(gradient, NULL, 0, 1, seed, seed);
        if (result == MSPRING_OK)
            result = mspring_gradient_reverse(gradient, steps);
        FUZZ_CHECK(result != MSPRING_ERROR_ARGUMENT || strstr(mspring_gradient_error(gradient), "corner"));
        FUZZ_CHECK(mspring_gradient_get(gradient, MSPRING_GRADIENT_VY, NULL, 0, 1, values, 1) == MSPRING_OK);
        FUZZ_CHECK(mspring_gradient_get_signals(gradient, steps, values) == MSPRING_ERROR_ID);
        FUZZ_CHECK(mspring_gradient_get_forces(gradient, steps, values) == MSPRING_ERROR_ID);
        (void)mspring_gradient_error(gradient);
    }
    mspring_gradient_destroy(gradient);
    mspring_network_destroy(clone);
}

static mspring_result settle(mspring_network *network) {
    mspring_settle_def def;
    go_back(network);
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_SETTLE_DEF, &def, sizeof def) == MSPRING_OK);
    def.flags = MSPRING_SETTLE_LEAVE_FLOATING;
    def.max_iterations = 20;
    return mspring_network_settle(network, &def, NULL);
}

// There and back: nothing may have changed.
static mspring_result save_and_load(mspring_network *network) {
    size_t size = 0;
    const uint64_t before = hash_of(network);
    FUZZ_CHECK(mspring_network_get_snapshot_size(network, MSPRING_SNAPSHOT_FRAME, &size) == MSPRING_OK);
    void *snapshot = malloc(size);
    FUZZ_CHECK(snapshot != NULL);
    FUZZ_CHECK(mspring_network_save(network, MSPRING_SNAPSHOT_FRAME, snapshot, size, NULL) == MSPRING_OK);
    const mspring_result result = mspring_network_load(network, snapshot, size);
    FUZZ_CHECK(result == MSPRING_OK && hash_of(network) == before);
    free(snapshot);
    return result;
}

// Measurements are numbers after any calls. (Energies and momenta may overflow.)
static mspring_result measure(mspring_network *network) {
    double box[4];
    float strain = 0;
    mspring_id spring = 0;
    FUZZ_CHECK(support_get_bounds(network, &box[0], &box[1], &box[2], &box[3]) == MSPRING_OK);
    FUZZ_CHECK(isfinite(box[0]) && isfinite(box[1]) && box[0] <= box[2] && box[1] <= box[3]);
    FUZZ_CHECK(support_get_max_strain(network, &strain, &spring) == MSPRING_OK);
    FUZZ_CHECK(!isnan(strain));
    mspring_body body = {.struct_size = sizeof body};
    const uint32_t count = mspring_network_count(network, MSPRING_PARTICLES);
    FUZZ_CHECK(mspring_network_get_body(network, NULL, 0, count, &body) == MSPRING_OK);
    FUZZ_CHECK(body.particle_count <= count && body.angle >= -4 && body.angle <= 4);
    // support_get_bounds() rounds as the host does, who may round another way.
    FUZZ_CHECK(body.particle_count == 0 || (fabs(body.min_x - box[0]) <= 1e-12 * fabs(box[0]) &&
                                            fabs(body.max_y - box[3]) <= 1e-12 * fabs(box[3])));
    return support_get_extents(network, NULL, NULL, NULL, NULL);
}

// Go on with a copy.
static mspring_result clone(const mspring_network *network) {
    mspring_network *copy = NULL;
    const mspring_result result = mspring_network_clone(network, NULL, &copy);
    FUZZ_CHECK(result == MSPRING_OK && look_of(copy) == look_of(network));
    const mspring_result stepped = mspring_network_step(copy, 1e-3);
    FUZZ_CHECK(stepped == MSPRING_OK || stepped == MSPRING_ERROR_UNSTABLE || stepped == MSPRING_ERROR_LIMIT);
    mspring_network_destroy(copy);
    return result;
}

static mspring_result add_particles(mspring_network *network, const call *c) {
    mspring_particle_def defs[2];
    mspring_id ids[2];
    for (int i = 0; i < 2; i++) {
        FUZZ_CHECK(mspring_init(MSPRING_STRUCT_PARTICLE_DEF, &defs[i], sizeof defs[i]) == MSPRING_OK);
        defs[i].x = (double)(i == 0 ? c->a : c->b); // no sum, which would depend on how the caller rounds
        defs[i].y = (double)c->b;
        defs[i].vx = c->b;
    }
    return mspring_network_add_particles(network, defs, c->count, ids);
}

static mspring_result add_spring(mspring_network *network, const call *c) {
    mspring_spring_def def;
    mspring_id id;
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_SPRING_DEF, &def, sizeof def) == MSPRING_OK);
    def.a = c->particle;
    def.b = (mspring_id)(c->particle * 7u + c->spring) % (mspring_network_count(network, MSPRING_PARTICLES) + 1);
    def.stiffness = c->a;
    return mspring_network_add_springs(network, &def, 1, &id);
}

// Where the particle is, and where perhaps none is.
static mspring_result write_view(mspring_network *network, const call *c) {
    if (!support_has_particle(network, c->particle))
        return MSPRING_OK;
    const float vx = fabsf(c->b) < 1e9f ? c->b : 0, vy = fabsf(c->a) < 1e9f ? c->a : 0;
    return mspring_network_set_velocities(network, &c->particle, 0, 1, &vx, &vy, 1);
}

static mspring_result make_call(mspring_network *network, const call *c) {
    const float pair[2] = {c->a, c->b}, other[2] = {c->b, c->a};
    const double place[2] = {(double)c->a, (double)c->b}, turned[2] = {(double)c->b, (double)c->a};
    const mspring_id twice[2] = {c->particle, c->particle};
    double now = 0, any_shape = 0;
    mspring_settings solver;
    uint32_t number = 0;
    if (c->kind >= 224)
        return c->kind % 4 == 3 ? call_batch(network, c) : call_laws(network, c);
    switch (c->kind % 52) {
    case 0:
        return mspring_network_apply_force(network, c->particle, c->a, c->b);
    case 1:
        return mspring_network_apply_forces(network, c->spring % 2 ? MSPRING_PUSH_SUBSTEP : MSPRING_PUSH_STEP, NULL,
                                            c->particle, c->count, pair, other, 1);
    case 2:
        return mspring_network_set_velocities(network, NULL, c->particle, c->count, pair, other, 1);
    case 3:
        return mspring_network_set_positions(network, NULL, c->particle, c->count, place, turned, 1);
    case 4:
        return mspring_network_break_springs(network, &c->spring, 0, 1);
    case 5:
        return mspring_network_restore_springs(network, &c->spring, 0, 1, c->a > 0 ? 0.01 : 0.0);
    case 6:
        return mspring_network_set(network, MSPRING_MASS, NULL, c->particle, c->count, pair, 1);
    case 7:
        return mspring_network_set(network, MSPRING_INVERSE_MASS_SCALE, NULL, c->particle, c->count, pair, 1);
    case 8:
        return mspring_network_set(network, MSPRING_STIFFNESS, NULL, c->spring, c->count, pair, 1);
    case 9:
        return mspring_network_set(network, MSPRING_DAMPING, NULL, c->spring, c->count, pair, 1);
    case 10:
        return mspring_network_set(network, MSPRING_REST_LENGTH, NULL, c->spring, c->count, pair, 1);
    case 11:
        return support_set_gravity(network, c->a, c->b);
    case 12:
        return support_set_global_damping(network, c->a);
    case 13: {
        mspring_result result = mspring_network_get_stable_dt(network, &now, &any_shape);
        // Areas and angle springs count in the bound as they are in the present shape.
        FUZZ_CHECK(result != MSPRING_OK || call_has_laws(network) || now >= any_shape);
        FUZZ_CHECK(result != MSPRING_OK || (now >= 0 && any_shape >= 0));
        return result;
    }
    case 14:
        FUZZ_CHECK(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver) == MSPRING_OK);
        solver.substeps = c->count == 0 ? MSPRING_SUBSTEPS_AUTO : 1 + c->particle % 33;
        solver.max_substeps = 64;
        solver.solver = c->solver;
        solver.substep_length = c->spring % 4 == 3 ? fabs((double)c->a) : 0.0;
        return support_set_solver(network, &solver);
    case 44: // one value for all, or what is no stride of the array's
        return mspring_network_set(network, (int32_t)(c->particle % 12), NULL, c->spring, c->count, pair, 0);
    case 45: {
        const mspring_id list[2] = {c->spring, c->particle};
        return mspring_network_set(network, (int32_t)(c->particle % 12), list, 0, 2, pair, 1);
    }
    case 15:
        return mspring_network_set(network, MSPRING_BREAK_STRAIN, NULL, c->spring, c->count, pair, 1);
    case 16:
        return mspring_network_update_components(network, &number, NULL);
    case 17:
        return mspring_network_wake(network);
    case 18:
        return set_floor(network, c);
    case 19:
        return c->count == 0 ? mspring_network_compact(network) : change_layout(network, c);
    case 20:
        return support_expand(network);
    case 21:
        return mspring_network_detach_particles(network, &c->particle, 0, 1);
    case 22:
        return mspring_network_set(network, MSPRING_WARN_STRAIN, NULL, c->spring, c->count, pair, 1);
    case 23:
        return settle(network);
    case 24:
        return save_and_load(network);
    case 25:
        return measure(network);
    case 26:
        return clone(network);
    case 27:
        return mspring_network_wake(network);
    case 28:
        return add_particles(network, c);
    case 29:
    case 30:
        return add_spring(network, c);
    case 31:
        return mspring_network_remove_particles(network, &c->particle, 0, 1);
    case 32:
        return mspring_network_remove_springs(network, &c->spring, 0, 1);
    case 33:
        return mspring_network_reuse_ids(network);
    case 34:
        return mspring_network_apply_forces(network, MSPRING_PUSH_IMPULSE, NULL, c->particle, c->count, pair, other, c->spring % 2);
    case 35:
        return mspring_network_apply_forces(network, MSPRING_PUSH_IMPULSE, twice, 0, c->count, pair, other, 1);
    case 36:
        return c->spring % 2 ? mspring_network_apply_forces(network, MSPRING_PUSH_STEP, twice, 0, c->count, pair, other, 0)
                             : mspring_network_apply_torque(network, NULL, c->particle, c->count, *pair);
    case 37:
        return write_view(network, c);
    case 38:
        return set_contact(network, c);
    case 39:
        return set_who_touches(network, c);
    case 40:
    case 41:
        return change_grip(network, c);
    case 42:
        return mspring_network_move_grip(network, c->spring % 20, (double)c->a, (double)c->b);
    case 43:
    case 46:
        return change_collider(network, c);
    case 47:
        return mspring_network_set(network, (int32_t)(MSPRING_YIELD_STRAIN + c->particle % 4), NULL, c->spring, c->count, pair, 1);
    default:
        return mspring_network_step(network, c->dt);
    }
}

static void make_calls(twins *all, fuzz_bytes *bytes) {
    static const mspring_solver solvers[] = {MSPRING_SOLVER_IMPLICIT, MSPRING_SOLVER_DIRECT,
                                             MSPRING_SOLVER_EXPLICIT, MSPRING_SOLVER_EXPLICIT};
    for (int i = 0; i < MOST_CALLS && bytes->at < bytes->size; i++) {
        // Now and then one that is not there.
        const call c = {.kind = fuzz_byte(bytes),
                        .particle = below(bytes, all->particles + 1),
                        .spring = below(bytes, all->springs + 1),
                        .count = fuzz_byte(bytes) % 3,
                        .a = any_number(bytes),
                        .b = any_number(bytes),
                        .dt = step_length(bytes),
                        .solver = solvers[fuzz_byte(bytes) % 4]};
        mspring_result results[TWINS] = {MSPRING_OK};
        bool is_refused = false;
        for (int twin = 0; twin < TWINS; twin++) {
            results[twin] = results[SCALAR];
            if (twin > WORKERS && is_refused)
                continue;
#if defined(FE_UPWARD)
            fesetround(twin == SPARED ? FE_UPWARD : FE_TONEAREST);
#endif
            results[twin] = make_call(all->of[twin], &c);
            fesetround(FE_TONEAREST);
            if (twin == SCALAR)
                is_refused =
                    results[SCALAR] != MSPRING_OK && !has_raised_substeps(all->of[SCALAR], results[SCALAR]);
        }
        check_answers(all, &c, results, is_refused);
    }
}

// Some steps well below the border, by the reference as well.
static void compare_with_reference(twins *all, const recipe *made) {
    mspring_settings solver;
    double now = 0;
    FUZZ_CHECK(mspring_init(MSPRING_STRUCT_SETTINGS, &solver, sizeof solver) == MSPRING_OK);
    solver.substeps = 3;
    FUZZ_CHECK(mspring_network_set_contact(all->of[0], NULL) == MSPRING_OK);
    for (mspring_id grip = 0; grip < MOST_CALLS; grip++)
        (void)!mspring_network_remove_grip(all->of[0], grip); // those that there are
    FUZZ_CHECK(support_set_solver(all->of[0], &solver) == MSPRING_OK);
    FUZZ_CHECK(support_set_gravity(all->of[0], 1, -9.8f) == MSPRING_OK);
    FUZZ_CHECK(support_set_global_damping(all->of[0], 0.25f) == MSPRING_OK);
    FUZZ_CHECK(mspring_network_get_stable_dt(all->of[0], &now, NULL) == MSPRING_OK);
    const float h = (float)fmin(0.3 * now, 0.01);
    reference net = reference_of(made, 1, (double)-9.8f, 0.25);
    for (int step = 0; step < 5; step++) {
        FUZZ_CHECK(mspring_network_step(all->of[0], 3 * (double)h) == MSPRING_OK);
        for (int substep = 0; substep < 3; substep++)
            reference_substep(&net, (double)h);
    }
    for (mspring_id id = 0; id < made->particle_count; id++) {
        double x, y;
        FUZZ_CHECK(mspring_network_get_positions(all->of[0], NULL, id, 1, &x, &y, 1) == MSPRING_OK);
        // 15 substeps below a third of the border, springs out of shape by a percent: rounding of a coordinate
        // below 128 m, 4e-6 m, grows a hundredfold at most.
        FUZZ_CHECK(fabs(x - net.particles[id].x) < 1e-3 && fabs(y - net.particles[id].y) < 1e-3);
    }
    reference_free(&net);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    fuzz_bytes bytes = {data, size, 0};
    const bool mild = fuzz_byte(&bytes) % 4 == 0;
    recipe made = make_recipe(&bytes, mild);
    twins all;
    if (make_twins(&all, &made, mild, &bytes)) {
        all.look = look_of(all.of[0]);
        all.saved = fuzz_save(all.of[0]);
        check_finite(all.of[0], made.particle_count);
        if (mild)
            compare_with_reference(&all, &made);
        else
            make_calls(&all, &bytes);
        free(all.saved.bytes);
    }
    for (int i = 0; i < TWINS; i++)
        mspring_network_destroy(all.of[i]);
    recipe_free(&made);
    return 0;
}

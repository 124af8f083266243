/// Builder of particles and springs. All values are checked here, so later code can rely on them.
#include "builder/builder.h"

#include <math.h>

#include "base/assert.h"
#include "base/cpu.h"

#define MAX_VALUE 1e30f
#define MAX_RATIO 1e3f
#define MIN_MASS 1e-30f

mspring_result mspring_builder_create(const mspring_allocator *allocator, mspring_builder **builder) {
    mspringi_memory memory;
    mspringi_message message;
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    mspring_result result = mspringi_memory_init(&memory, allocator, &message);
    if (result != MSPRING_OK)
        return result;
    mspring_builder *created = mspringi_alloc(&memory, 1, sizeof *created);
    if (!created)
        return MSPRING_ERROR_MEMORY;
    created->memory = memory;
    *builder = created;
    return MSPRING_OK;
}

void mspring_builder_destroy(mspring_builder *builder) {
    if (!builder)
        return;
    mspringi_memory memory = builder->memory;
    mspringi_free(&memory, builder->particles);
    mspringi_free(&memory, builder->springs);
    mspringi_free(&memory, builder->limits);
    mspringi_free(&memory, builder->areas);
    mspringi_free(&memory, builder->corners);
    mspringi_free(&memory, builder->archive);
    mspringi_free(&memory, builder);
}

const char *mspring_builder_error(const mspring_builder *builder) {
    return !builder ? "" : builder->failed == MSPRING_OK ? builder->message.text : builder->failed_message.text;
}

void mspring_builder_forget_error(mspring_builder *builder) {
    if (!builder)
        return;
    builder->failed = MSPRING_OK;
    mspringi_message_clear(&builder->message);
}

mspring_result mspringi_builder_end(mspring_builder *builder, mspring_result result) {
    if (result != MSPRING_OK && builder->failed == MSPRING_OK) {
        builder->failed = result;
        builder->failed_message = builder->message;
    }
    return result;
}

uint32_t mspring_builder_count(const mspring_builder *builder, mspring_kind kind) {
    const size_t count = !builder                    ? 0
                         : kind == MSPRING_PARTICLES ? builder->particle_count
                         : kind == MSPRING_SPRINGS   ? builder->spring_count
                         : kind == MSPRING_ELEMENTS  ? builder->area_count
                                                     : 0;
    return (uint32_t)count;
}

/* ---------------------------------------------------------------------------------------------- reserving */

mspring_result mspringi_builder_reserve_particles(mspring_builder *builder, size_t count) {
    if (count > MSPRING_MAX_PARTICLES - builder->particle_count)
        return mspringi_fail(&builder->message, MSPRING_ERROR_LIMIT,
                             "%zu particles in addition to %zu exceed the limit of %u (MSPRING_MAX_PARTICLES)",
                             count, builder->particle_count, (unsigned)MSPRING_MAX_PARTICLES);
    void *particles = builder->particles;
    bool is_grown = mspringi_grow(&builder->memory, &particles, &builder->particle_capacity,
                                  builder->particle_count + count, sizeof *builder->particles);
    builder->particles = particles;
    return is_grown
               ? MSPRING_OK
               : mspringi_fail(&builder->message, MSPRING_ERROR_MEMORY, "no memory for %zu more particles", count);
}

mspring_result mspringi_builder_reserve_springs(mspring_builder *builder, size_t count) {
    if (count > MSPRING_MAX_SPRINGS - builder->spring_count)
        return mspringi_fail(&builder->message, MSPRING_ERROR_LIMIT,
                             "%zu springs in addition to %zu exceed the limit of %u (MSPRING_MAX_SPRINGS)", count,
                             builder->spring_count, (unsigned)MSPRING_MAX_SPRINGS);
    void *springs = builder->springs;
    bool is_grown = mspringi_grow(&builder->memory, &springs, &builder->spring_capacity,
                                  builder->spring_count + count, sizeof *builder->springs);
    builder->springs = springs;
    return is_grown
               ? MSPRING_OK
               : mspringi_fail(&builder->message, MSPRING_ERROR_MEMORY, "no memory for %zu more springs", count);
}

mspring_result mspringi_builder_reserve_areas(mspring_builder *builder, size_t areas, size_t corners) {
    void *list = builder->areas, *all = builder->corners;
    if (areas >= MSPRING_NONE - builder->area_count || corners >= MSPRING_NONE - builder->corner_count)
        return mspringi_fail(&builder->message, MSPRING_ERROR_LIMIT, "%zu areas in addition to %zu are too many",
                             areas, builder->area_count);
    bool is_grown = areas == 0 || mspringi_grow(&builder->memory, &list, &builder->area_capacity,
                                                builder->area_count + areas, sizeof *builder->areas);
    builder->areas = list;
    is_grown = is_grown && (areas == 0 || mspringi_grow(&builder->memory, &all, &builder->corner_capacity,
                                                        builder->corner_count + corners, sizeof *builder->corners));
    builder->corners = all;
    return is_grown ? MSPRING_OK
                    : mspringi_fail(&builder->message, MSPRING_ERROR_MEMORY, "no memory for %zu more areas", areas);
}

void mspringi_builder_append_area(mspring_builder *builder, mspringi_area area, const mspring_id *corners,
                                  mspring_id more) {
    area.first = (uint32_t)builder->corner_count;
    MSPRINGI_ASSERT(builder->area_count < builder->area_capacity);
    MSPRINGI_ASSERT(builder->corner_count + area.count <= builder->corner_capacity);
    builder->areas[builder->area_count++] = area;
    for (uint32_t i = 0; i < area.count; ++i)
        builder->corners[builder->corner_count++] = corners[i] + more;
}

/* ----------------------------------------------------------------------------------------------- checking */

// Comparisons are written to reject NaN. Values for the network are computed in the floating-point environment of a
// step.

mspring_result mspringi_check_mass(mspringi_message *message, const char *what, size_t index, float mass) {
    if (mspringi_in_range(mass, MIN_MASS, MAX_VALUE))
        return MSPRING_OK;
    return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s %zu: mass is %g kg, it must be 1e-30 to 1e30", what,
                         index, (double)mass);
}

mspring_result mspringi_check_coefficients(mspringi_message *message, const char *what, size_t index,
                                           float stiffness, float damping, uint32_t flags) {
    if (!mspringi_in_range(stiffness, 0.0f, MAX_VALUE))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s %zu: stiffness is %g, it must be 0 to 1e30", what,
                             index, (double)stiffness);
    if (flags & ~(uint32_t)(MSPRINGI_KEPT_SPRING_FLAGS | MSPRING_SPRING_DAMPING_RATIO))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s %zu: unknown spring flags 0x%x", what, index,
                             (unsigned)flags);
    if (flags & MSPRING_SPRING_PULL_ONLY && flags & MSPRING_SPRING_PUSH_ONLY)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "%s %zu: MSPRING_SPRING_PULL_ONLY and MSPRING_SPRING_PUSH_ONLY exclude each other",
                             what, index);
    const bool is_ratio = flags & MSPRING_SPRING_DAMPING_RATIO;
    if (!mspringi_in_range(damping, 0.0f, is_ratio ? MAX_RATIO : MAX_VALUE))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s %zu: damping%s is %g, it must be 0 to %s", what,
                             index, is_ratio ? " ratio" : "", (double)damping, is_ratio ? "1000" : "1e30");
    return MSPRING_OK;
}

float mspringi_find_damping(float stiffness, float damping, uint32_t flags, float mass_a, float mass_b) {
    if (!(flags & MSPRING_SPRING_DAMPING_RATIO))
        return damping;
    const double reduced_mass = 1.0 / (1.0 / (double)mass_a + 1.0 / (double)mass_b);
    const double unit = flags & MSPRING_SPRING_RELATIVE ? 1.0 : reduced_mass;
    const double found = 2.0 * (double)damping * sqrt((double)stiffness * unit);
    return found < (double)MAX_VALUE ? (float)found : MAX_VALUE;
}

mspring_result mspringi_take_particle(mspringi_message *message, size_t index, const mspring_particle_def *defs,
                                      size_t i, mspring_particle_def *def) {
    mspring_result result = mspringi_take_particle_def_at(message, defs, i, def);
    if (result != MSPRING_OK)
        return mspringi_prefix(message, result, "particle", index);
    if (def->reserved != 0)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "particle %zu: mspring_particle_def.reserved is %u, it must be 0", index,
                             (unsigned)def->reserved);
    if (!mspringi_is_coordinate(def->x) || !mspringi_is_coordinate(def->y))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "particle %zu: position (%g, %g) m is not within 1e12", index, def->x, def->y);
    if (!mspringi_is_speed(def->vx) || !mspringi_is_speed(def->vy))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "particle %zu: velocity (%g, %g) m/s is not within 1e15", index, (double)def->vx,
                             (double)def->vy);
    if (def->flags & ~(uint32_t)MSPRING_PARTICLE_PINNED)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "particle %zu: unknown particle flags 0x%x", index,
                             (unsigned)def->flags);
    return mspringi_check_mass(message, "particle", index, def->mass);
}

mspring_result mspringi_take_spring(mspringi_message *message, size_t index, const mspring_spring_def *defs,
                                    size_t i, mspring_spring_def *def) {
    return mspringi_prefix(message, mspringi_take_spring_def_at(message, defs, i, def), "spring", index);
}

mspring_result mspringi_check_spring_values(mspringi_message *message, size_t index,
                                            const mspring_spring_def *def) {
    if (def->a == def->b)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "spring %zu joins particle %u to itself", index,
                             (unsigned)def->a);
    mspring_result result =
        mspringi_check_coefficients(message, "spring", index, def->stiffness, def->damping, def->flags);
    return result == MSPRING_OK ? mspringi_check_limits(message, "spring", index, MSPRINGI_LIMITS_OF(def)) : result;
}

mspring_result mspringi_find_rest_length(mspringi_message *message, size_t index, const mspring_spring_def *def,
                                         double dx, double dy, float *rest_length) {
    float length = def->rest_length;
    if (length == MSPRING_REST_LENGTH_DISTANCE) {
        length = (float)sqrt(dx * dx + dy * dy);
        if (!(length > 0.0f))
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                 "spring %zu: particles %u and %u lie in the same place, so their distance is no "
                                 "rest length: give one, or 0 to weld them",
                                 index, (unsigned)def->a, (unsigned)def->b);
    }
    if (!(length >= 0.0f && length <= MSPRINGI_MAX_LENGTH))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "spring %zu: rest length is %g m, it must be 0 to 4e12", index, (double)length);
    *rest_length = mspringi_stored_length(length);
    return MSPRING_OK;
}

// Check a spring and find its rest length.
static mspring_result check_spring(mspring_builder *builder, size_t index, const mspring_spring_def *def,
                                   float *rest_length) {
    mspringi_message *message = &builder->message;
    if (def->a == MSPRING_NONE || def->b == MSPRING_NONE)
        return mspringi_fail(message, MSPRING_ERROR_ID, "spring %zu: its particle %s is not set (MSPRING_NONE)",
                             index, def->a == MSPRING_NONE ? "a" : "b");
    if (def->a >= builder->particle_count || def->b >= builder->particle_count)
        return mspringi_fail(message, MSPRING_ERROR_ID,
                             "spring %zu joins particles %u and %u, but there are only %zu particles", index,
                             (unsigned)def->a, (unsigned)def->b, builder->particle_count);
    const mspring_result result = mspringi_check_spring_values(message, index, def);
    if (result != MSPRING_OK)
        return result;
    const mspringi_particle *a = &builder->particles[def->a], *b = &builder->particles[def->b];
    return mspringi_find_rest_length(message, index, def, b->x - a->x, b->y - a->y, rest_length);
}

/* ------------------------------------------------------------------------------------ particles and springs */

static void append_particle(mspring_builder *builder, const mspring_particle_def *def) {
    builder->particles[builder->particle_count++] = (mspringi_particle){
        .x = def->x, .y = def->y, .vx = def->vx, .vy = def->vy, .mass = def->mass, .flags = def->flags};
}

static void append_spring(mspring_builder *builder, const mspring_spring_def *def, float rest_length) {
    const float mass_a = builder->particles[def->a].mass, mass_b = builder->particles[def->b].mass;
    builder->springs[builder->spring_count++] = (mspringi_spring){
        .a = def->a,
        .b = def->b,
        .stiffness = def->stiffness,
        .damping = mspringi_find_damping(def->stiffness, def->damping, def->flags, mass_a, mass_b),
        .rest_length = rest_length,
        .flags = def->flags & MSPRINGI_KEPT_SPRING_FLAGS};
    mspringi_builder_put_limits(builder, builder->spring_count - 1, MSPRINGI_LIMITS_OF(def));
}

static mspring_result add_particles(mspring_builder *builder, const mspring_particle_def *defs, uint32_t count,
                                    mspring_id *first_id) {
    if (!defs && count > 0)
        return mspringi_fail(&builder->message, MSPRING_ERROR_ARGUMENT, "particle definitions are NULL");
    const size_t before = builder->particle_count;
    mspring_result result = mspringi_builder_reserve_particles(builder, count);
    for (size_t i = 0; result == MSPRING_OK && i < count; ++i) {
        mspring_particle_def def;
        result = mspringi_take_particle(&builder->message, before + i, defs, i, &def);
        if (result == MSPRING_OK)
            append_particle(builder, &def);
        else if (count > 1)
            result = mspringi_prefix(&builder->message, result, "definition", i);
    }
    if (result != MSPRING_OK)
        builder->particle_count = before;
    else if (first_id)
        *first_id = (mspring_id)before;
    return result;
}

mspring_result mspring_builder_add_particles(mspring_builder *builder, const mspring_particle_def *defs,
                                             uint32_t count, mspring_id *first_id) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_message_clear(&builder->message);
    return mspringi_builder_end(builder, add_particles(builder, defs, count, first_id));
}

static MSPRINGI_NOINLINE mspring_result add_springs(mspring_builder *builder, const mspring_spring_def *defs,
                                                    uint32_t count, mspring_id *first_id) {
    if (!defs && count > 0)
        return mspringi_fail(&builder->message, MSPRING_ERROR_ARGUMENT, "spring definitions are NULL");
    const size_t before = builder->spring_count;
    mspring_result result = mspringi_builder_reserve_springs(builder, count);
    for (size_t i = 0; result == MSPRING_OK && i < count; ++i) {
        float rest_length = 0.0f;
        mspring_spring_def def;
        result = mspringi_take_spring(&builder->message, before + i, defs, i, &def);
        if (result == MSPRING_OK)
            result = check_spring(builder, before + i, &def, &rest_length);
        if (result == MSPRING_OK)
            result = mspringi_builder_reserve_limits(builder, count - i, MSPRINGI_LIMITS_OF(&def));
        if (result == MSPRING_OK)
            append_spring(builder, &def, rest_length);
        else if (count > 1)
            result = mspringi_prefix(&builder->message, result, "definition", i);
    }
    if (result != MSPRING_OK)
        mspringi_builder_cut_springs(builder, before);
    else if (first_id)
        *first_id = (mspring_id)before;
    return result;
}

mspring_result mspring_builder_add_springs(mspring_builder *builder, const mspring_spring_def *defs, uint32_t count,
                                           mspring_id *first_id) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_message_clear(&builder->message);
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = add_springs(builder, defs, count, first_id);
    mspringi_fp_leave(before);
    return mspringi_builder_end(builder, result);
}

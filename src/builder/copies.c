/// Copies of a whole builder within another one.
#include "base/cpu.h"
#include "builder/builder.h"

typedef struct offsets {
    const double *x, *y;
    size_t stride;
} offsets;

static double x_of(const offsets *by, uint32_t i) {
    return by->x ? by->x[i * by->stride] : 0.0;
}

static double y_of(const offsets *by, uint32_t i) {
    return by->y ? by->y[i * by->stride] : 0.0;
}

// Bounding box of at least one particle.
static void find_bounds(const mspring_builder *from, double low[2], double high[2]) {
    const mspringi_particle *p = from->particles;
    low[0] = high[0] = p->x;
    low[1] = high[1] = p->y;
    for (size_t i = 1; i < from->particle_count; ++i) {
        low[0] = p[i].x < low[0] ? p[i].x : low[0];
        low[1] = p[i].y < low[1] ? p[i].y : low[1];
        high[0] = p[i].x > high[0] ? p[i].x : high[0];
        high[1] = p[i].y > high[1] ? p[i].y : high[1];
    }
}

static mspring_result check(mspring_builder *builder, const mspring_builder *from, uint32_t count,
                            const offsets *by) {
    mspringi_message *message = &builder->message;
    double low[2], high[2];
    if (!from || from == builder)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the builder to copy is %s",
                             from ? "the one that gets the copies" : "NULL");
    if (from->failed != MSPRING_OK)
        return mspringi_fail(message, from->failed, "the builder to copy: %s", from->failed_message.text);
    if (count == 0 || !by->x != !by->y)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s",
                             count == 0 ? "there are 0 copies, at least 1 is needed"
                                        : "one of the arrays of offsets is NULL");
    if (from->particle_count == 0)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the builder to copy has no particle");
    const uint64_t particles = (uint64_t)from->particle_count * count,
                   springs = (uint64_t)from->spring_count * count;
    if (particles > MSPRING_MAX_PARTICLES || springs > MSPRING_MAX_SPRINGS) // before a loop over copies
        return mspringi_fail(message, MSPRING_ERROR_LIMIT,
                             "%u copies of %zu particles and %zu springs are over the limits", (unsigned)count,
                             from->particle_count, from->spring_count);
    find_bounds(from, low, high);
    for (uint32_t i = 0; i < count; ++i)
        if (!mspringi_is_coordinate(low[0] + x_of(by, i)) || !mspringi_is_coordinate(low[1] + y_of(by, i)) ||
            !mspringi_is_coordinate(high[0] + x_of(by, i)) || !mspringi_is_coordinate(high[1] + y_of(by, i)))
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                 "copy %u: with an offset of (%g, %g) m it is not within 1e12", (unsigned)i,
                                 x_of(by, i), y_of(by, i));
    return MSPRING_OK;
}

static mspring_result reserve(mspring_builder *builder, const mspring_builder *from, uint32_t count) {
    const size_t particles = from->particle_count * count, springs = from->spring_count * count;
    mspring_result result = mspringi_builder_reserve_particles(builder, particles);
    if (result == MSPRING_OK)
        result = mspringi_builder_reserve_springs(builder, springs);
    for (size_t i = 0; result == MSPRING_OK && i < from->limit_count; ++i)
        result = mspringi_builder_reserve_limits(builder, springs, from->limits[i]);
    if (result == MSPRING_OK && from->corner_count > MSPRING_NONE / count)
        result = mspringi_fail(&builder->message, MSPRING_ERROR_LIMIT, "%u copies of %zu areas are too many",
                               (unsigned)count, from->area_count);
    if (result == MSPRING_OK)
        result = mspringi_builder_reserve_areas(builder, from->area_count * count, from->corner_count * count);
    return result;
}

static void append(mspring_builder *builder, const mspring_builder *from, double x, double y) {
    const mspring_id first = (mspring_id)builder->particle_count;
    for (size_t i = 0; i < from->particle_count; ++i) {
        mspringi_particle *made = &builder->particles[builder->particle_count++];
        *made = from->particles[i];
        made->x += x;
        made->y += y;
    }
    for (size_t i = 0; i < from->spring_count; ++i) {
        mspringi_spring *made = &builder->springs[builder->spring_count++];
        *made = from->springs[i];
        made->a += first;
        made->b += first;
        if (i < from->limit_count)
            mspringi_builder_put_limits(builder, builder->spring_count - 1, from->limits[i]);
    }
    for (size_t i = 0; i < from->area_count; ++i)
        mspringi_builder_append_area(builder, from->areas[i], from->corners + from->areas[i].first, first);
}

static MSPRINGI_NOINLINE mspring_result add_copies(mspring_builder *builder, const mspring_builder *from,
                                                   uint32_t count, const offsets *by) {
    mspring_result result = check(builder, from, count, by);
    if (result == MSPRING_OK)
        result = reserve(builder, from, count);
    if (result != MSPRING_OK)
        return result;
    const float lag = mspringi_joint_lag(builder, from->lag);
    for (uint32_t i = 0; i < count; ++i)
        append(builder, from, x_of(by, i), y_of(by, i));
    builder->lag = lag;
    return MSPRING_OK;
}

mspring_result mspring_builder_add_copies(mspring_builder *builder, const mspring_builder *from, uint32_t count,
                                          const double *x, const double *y, uint32_t stride,
                                          mspring_id *first_particle, mspring_id *first_spring) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_message_clear(&builder->message);
    const mspring_id particle = (mspring_id)builder->particle_count, spring = (mspring_id)builder->spring_count;
    const offsets by = {x, y, stride};
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = mspringi_builder_end(builder, add_copies(builder, from, count, &by));
    mspringi_fp_leave(before);
    if (result == MSPRING_OK && first_particle)
        *first_particle = particle;
    if (result == MSPRING_OK && first_spring)
        *first_spring = spring;
    return result;
}

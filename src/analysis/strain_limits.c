/// Strain limits: parallel springs that act only beyond a strain of the original spring.
#include "base/cpu.h"
#include "builder/builder.h"

/// Largest stiffening. Beyond it, even a stable substep gains energy when a spring meets its limit.
#define MAX_STIFFENING 30.0f

static mspring_result check_range(mspring_builder *builder, mspring_id first, uint32_t count, float strain,
                                  float stiffening) {
    mspringi_message *message = &builder->message;
    if (first > builder->spring_count || count > builder->spring_count - first)
        return mspringi_fail(message, MSPRING_ERROR_ID, "springs %u ... %llu get a limit, but there are only %zu",
                             (unsigned)first, (unsigned long long)first + count - 1, builder->spring_count);
    if (!(strain > -1.0f && strain < MSPRING_NEVER && strain != 0.0f))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "strain limit is %g, it must be above 0 for pull, or -1 to 0 for push, both excluded",
                             (double)strain);
    if (!(stiffening > 0.0f && stiffening <= MAX_STIFFENING))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "stiffening is %g, it must be above 0 and at most %g",
                             (double)stiffening, (double)MAX_STIFFENING);
    return MSPRING_OK;
}

// Break strain of the limit, so that it breaks at the same length as the original spring.
static float break_strain_of(float break_strain, float strain) {
    const double length = 1.0 + (strain > 0.0f ? (double)break_strain : -(double)break_strain);
    const double limit_strain = length / (1.0 + (double)strain) - 1.0;
    return break_strain == MSPRING_NEVER ? MSPRING_NEVER : (float)(strain > 0.0f ? limit_strain : -limit_strain);
}

static mspring_result add_limit(mspring_builder *builder, size_t spring, float strain, float stiffening) {
    mspringi_message *message = &builder->message;
    const mspringi_spring original = builder->springs[spring];
    const float rest_length = mspringi_read_length(original.rest_length);
    const float break_strain = mspringi_builder_limits_of(builder, spring).break_strain;
    const mspringi_spring limit = {.a = original.a,
                                   .b = original.b,
                                   .stiffness = original.stiffness * stiffening,
                                   .rest_length = (1.0f + strain) * rest_length,
                                   .flags = (original.flags & MSPRING_SPRING_RELATIVE) |
                                            (strain > 0.0f ? MSPRING_SPRING_PULL_ONLY : MSPRING_SPRING_PUSH_ONLY)};
    mspringi_limits limits = mspringi_builder_limits_of(builder, SIZE_MAX);
    limits.break_strain = break_strain_of(break_strain, strain);
    if (!(limit.rest_length > 0.0f && limit.rest_length <= MSPRINGI_MAX_LENGTH))
        return mspringi_fail(
            message, MSPRING_ERROR_ARGUMENT,
            "spring %zu has the rest length %g m, so its limit is at %g m, which must be > 0 and at "
            "most 4e12",
            spring, (double)rest_length, (double)limit.rest_length);
    if (!(limits.break_strain > 0.0f))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "spring %zu breaks at a strain of %g, which is not beyond its limit of %g", spring,
                             (double)break_strain, (double)strain);
    mspring_result result =
        mspringi_check_coefficients(message, "limit of spring", spring, limit.stiffness, 0.0f, limit.flags);
    if (result == MSPRING_OK)
        result = mspringi_builder_reserve_limits(builder, 1, limits);
    if (result != MSPRING_OK)
        return result;
    builder->springs[builder->spring_count++] = limit;
    mspringi_builder_put_limits(builder, builder->spring_count - 1, limits);
    return MSPRING_OK;
}

static MSPRINGI_NOINLINE mspring_result add_limits(mspring_builder *builder, mspring_id first, uint32_t count,
                                                   float strain, float stiffening, mspring_id *first_limit) {
    const size_t before = builder->spring_count;
    mspring_result result = check_range(builder, first, count, strain, stiffening);
    if (result == MSPRING_OK)
        result = mspringi_builder_reserve_springs(builder, count);
    for (size_t spring = first; result == MSPRING_OK && spring < (size_t)first + count; ++spring)
        result = add_limit(builder, spring, strain, stiffening);
    if (result != MSPRING_OK)
        mspringi_builder_cut_springs(builder, before);
    else if (first_limit)
        *first_limit = (mspring_id)before;
    return result;
}

mspring_result mspring_builder_add_strain_limits(mspring_builder *builder, mspring_id first, uint32_t count,
                                                 float strain, float stiffening, mspring_id *first_limit) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_message_clear(&builder->message);
    const mspringi_fp_state before = mspringi_fp_enter();
    mspring_result result = add_limits(builder, first, count, strain, stiffening, first_limit);
    mspringi_fp_leave(before);
    return result;
}

/// Strain limits: parallel springs that act only beyond a strain of the original spring.
#include "base/cpu.h"
#include "builder/builder.h"

/// Largest stiffening. Beyond it, even a stable substep gains energy when a spring meets its limit.
#define MAX_STIFFENING 30.0f

// Springs that get a limit: a list, or a range.
typedef struct springs {
    const mspring_id *ids;
    mspring_id first;
    uint32_t count;
} springs;

static mspring_result check(mspring_builder *builder, const springs *of, float strain, float stiffening) {
    mspringi_message *message = &builder->message;
    const size_t there = builder->spring_count;
    if (!of->ids && (of->first > there || of->count > there - of->first))
        return mspringi_fail(message, MSPRING_ERROR_ID, "%u springs from id %s on get a limit: ids are below %zu",
                             (unsigned)of->count, MSPRINGI_ID(of->first), there);
    if (of->ids && of->count == MSPRING_ALL)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "the count is MSPRING_ALL, but there is a list of ids: give its length");
    for (uint32_t i = 0; of->ids && i < of->count; ++i)
        if (of->ids[of->first + i] >= there)
            return mspringi_fail(message, MSPRING_ERROR_ID, "index %u of the list: there is no spring %s",
                                 (unsigned)(of->first + i), MSPRINGI_ID(of->ids[of->first + i]));
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
    const float given = mspringi_builder_limits_of(builder, spring).break_strain;
    const float break_strain =
        original.flags & MSPRING_SPRING_METRES ? mspringi_strain_of_metres(given, original.rest_length) : given;
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

static MSPRINGI_NOINLINE mspring_result add_limits(mspring_builder *builder, const springs *of, float strain,
                                                   float stiffening, mspring_id *first_limit) {
    const size_t before = builder->spring_count;
    mspring_result result = check(builder, of, strain, stiffening);
    if (result == MSPRING_OK)
        result = mspringi_builder_reserve_springs(builder, of->count);
    for (uint32_t i = 0; result == MSPRING_OK && i < of->count; ++i)
        result = add_limit(builder, of->ids ? of->ids[of->first + i] : of->first + i, strain, stiffening);
    if (result != MSPRING_OK)
        mspringi_builder_cut_springs(builder, before);
    else if (first_limit)
        *first_limit = (mspring_id)before;
    return result;
}

mspring_result mspring_builder_add_strain_limits(mspring_builder *builder, const mspring_id *ids, mspring_id first,
                                                 uint32_t count, float strain, float stiffening,
                                                 mspring_id *first_limit) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_message_clear(&builder->message);
    const bool is_open = !ids && count == MSPRING_ALL && first <= builder->spring_count;
    const springs of = {ids, first, is_open ? (uint32_t)builder->spring_count - first : count};
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = add_limits(builder, &of, strain, stiffening, first_limit);
    mspringi_fp_leave(before);
    return mspringi_builder_end(builder, result);
}

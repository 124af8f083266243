/// Strain limits of springs: break, stress, relax and yield. A builder without any stores none.
#include "builder/builder.h"

static const mspringi_limits none = {MSPRING_NEVER,
                                     MSPRING_NEVER,
                                     MSPRING_RELAX_STRAIN_DEFAULT,
                                     MSPRING_NEVER,
                                     MSPRING_HARDENING_DEFAULT,
                                     MSPRING_PLASTIC_LIMIT_DEFAULT,
                                     0.0f};

mspring_result mspringi_check_limits(mspringi_message *message, const char *what, size_t index,
                                     mspringi_limits limits) {
    const struct {
        const char *name, *range;
        float value;
        bool is_good;
    } all[] = {
        {"break strain", "> 0", limits.break_strain, mspringi_is_threshold(limits.break_strain)},
        {"warn strain", "> 0", limits.warn_strain, mspringi_is_threshold(limits.warn_strain)},
        {"relax strain", ">= 0 or MSPRING_RELAX_STRAIN_DEFAULT", limits.relax_strain,
         mspringi_is_relax_strain(limits.relax_strain)},
        {"yield strain", "> 0", limits.yield_strain, mspringi_is_threshold(limits.yield_strain)},
        {"hardening", "0 to 10", limits.hardening,
         mspringi_in_range(limits.hardening, 0.0f, MSPRINGI_MAX_HARDENING)},
        {"plastic limit", "0 to 0.9", limits.plastic_limit,
         mspringi_in_range(limits.plastic_limit, 0.0f, MSPRINGI_MAX_PLASTIC_STRAIN)},
    };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i)
        if (!all[i].is_good)
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s %zu: %s is %g, it must be %s", what, index,
                                 all[i].name, (double)all[i].value, all[i].range);
    return MSPRING_OK;
}

bool mspringi_has_plasticity(mspringi_limits limits) {
    return limits.yield_strain < MSPRING_NEVER || limits.hardening != MSPRING_HARDENING_DEFAULT ||
           limits.plastic_limit != MSPRING_PLASTIC_LIMIT_DEFAULT || limits.nominal_length > 0.0f;
}

bool mspringi_has_limits(mspringi_limits limits) {
    return mspringi_has_plasticity(limits) || limits.break_strain < MSPRING_NEVER ||
           limits.warn_strain < MSPRING_NEVER || limits.relax_strain != MSPRING_RELAX_STRAIN_DEFAULT;
}

mspring_result mspringi_builder_reserve_limits(mspring_builder *builder, size_t count, mspringi_limits limits) {
    if (!mspringi_has_limits(limits))
        return MSPRING_OK;
    void *grown = builder->limits;
    const bool is_grown = mspringi_grow(&builder->memory, &grown, &builder->limit_capacity,
                                        builder->spring_count + count, sizeof *builder->limits);
    builder->limits = grown;
    return is_grown ? MSPRING_OK
                    : mspringi_fail(&builder->message, MSPRING_ERROR_MEMORY,
                                    "no memory for the limits of %zu more springs", count);
}

void mspringi_builder_put_limits(mspring_builder *builder, size_t first, mspringi_limits limits) {
    if (!mspringi_has_limits(limits))
        return;
    while (builder->limit_count < first)
        builder->limits[builder->limit_count++] = none;
    while (builder->limit_count < builder->spring_count)
        builder->limits[builder->limit_count++] = limits;
}

mspringi_limits mspringi_builder_limits_of(const mspring_builder *builder, size_t spring) {
    return spring < builder->limit_count ? builder->limits[spring] : none;
}

void mspringi_builder_cut_springs(mspring_builder *builder, size_t count) {
    builder->spring_count = count;
    builder->limit_count = builder->limit_count < count ? builder->limit_count : count;
}

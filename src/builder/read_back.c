/// Particles and springs of a builder as definitions that would add them again.
#include "builder/builder.h"

static mspring_result check(mspring_builder *builder, const mspringi_struct *of, size_t there,
                            const mspring_id *ids, mspring_id first, uint32_t count, const void *defs) {
    mspringi_message_clear(&builder->message);
    if (count == MSPRING_ALL)
        return mspringi_fail(&builder->message, MSPRING_ERROR_ARGUMENT,
                             "the count is MSPRING_ALL, but arrays depend on it: give their length");
    if (!ids && (first > there || count > there - first))
        return mspringi_fail(&builder->message, MSPRING_ERROR_ID, "%u from id %s on: ids are below %zu",
                             (unsigned)count, MSPRINGI_ID(first), there);
    for (uint32_t i = 0; ids && i < count; ++i)
        if (ids[first + i] >= there)
            return mspringi_fail(&builder->message, MSPRING_ERROR_ID,
                                 "index %u of the list: ids are below %zu, not %s", (unsigned)(first + i), there,
                                 MSPRINGI_ID(ids[first + i]));
    if (count == 0)
        return MSPRING_OK;
    return mspringi_check_output(&builder->message, of, defs);
}

mspring_result mspring_builder_get_particles(mspring_builder *builder, const mspring_id *ids, mspring_id first,
                                             uint32_t count, mspring_particle_def *defs) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    const mspring_result result =
        check(builder, &mspringi_struct_particle_def, builder->particle_count, ids, first, count, defs);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        const mspringi_particle *particle = &builder->particles[ids ? ids[first + i] : first + i];
        const mspring_particle_def def = {.flags = particle->flags & MSPRING_PARTICLE_PINNED,
                                          .x = particle->x,
                                          .y = particle->y,
                                          .vx = particle->vx,
                                          .vy = particle->vy,
                                          .mass = particle->mass};
        mspringi_put_particle_def_at(defs, i, &def);
    }
    return result;
}

mspring_result mspring_builder_get_springs(mspring_builder *builder, const mspring_id *ids, mspring_id first,
                                           uint32_t count, mspring_spring_def *defs) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    const mspring_result result =
        check(builder, &mspringi_struct_spring_def, builder->spring_count, ids, first, count, defs);
    for (uint32_t i = 0; result == MSPRING_OK && i < count; ++i) {
        const mspring_id id = ids ? ids[first + i] : first + i;
        const mspringi_spring *spring = &builder->springs[id];
        const mspringi_limits limits = mspringi_builder_limits_of(builder, id);
        const mspring_spring_def def = {.flags = spring->flags & MSPRINGI_KEPT_SPRING_FLAGS,
                                        .a = spring->a,
                                        .b = spring->b,
                                        .stiffness = spring->stiffness,
                                        .damping = spring->damping,
                                        .rest_length = mspringi_read_length(spring->rest_length),
                                        .break_strain = limits.break_strain,
                                        .warn_strain = limits.warn_strain,
                                        .relax_strain = limits.relax_strain,
                                        .yield_strain = limits.yield_strain,
                                        .hardening = limits.hardening,
                                        .plastic_limit = limits.plastic_limit};
        mspringi_put_spring_def_at(defs, i, &def);
    }
    return result;
}

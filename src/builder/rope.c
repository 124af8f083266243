/// Rope: a chain of equal springs.
#include "builder/builder.h"

#include <math.h>

#include "base/cpu.h"

static mspring_result check_rope(mspring_builder *builder, const mspring_rope_def **given, mspring_rope_def *def,
                                 mspring_material *material, float *segment_length) {
    mspringi_message *message = &builder->message;
    mspring_result result = mspringi_take_rope_def(message, given, def);
    if (result != MSPRING_OK)
        return result;
    if (def->from == MSPRING_NONE || def->to == MSPRING_NONE)
        return mspringi_fail(message, MSPRING_ERROR_ID, "rope: its end %s is not set (MSPRING_NONE)",
                             def->from == MSPRING_NONE ? "from" : "to");
    if (def->from >= builder->particle_count || def->to >= builder->particle_count)
        return mspringi_fail(message, MSPRING_ERROR_ID,
                             "rope from particle %u to %u, but there are only %zu particles", (unsigned)def->from,
                             (unsigned)def->to, builder->particle_count);
    if (def->from == def->to)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "rope from particle %u to itself",
                             (unsigned)def->from);
    if (def->segment_count == 0)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "rope has no segment, it needs at least one");
    result = mspringi_check_reserved(message, "mspring_rope_def", def->reserved);
    if (result == MSPRING_OK)
        result = mspringi_take_own_material(message, "rope", def->material, material);
    if (result != MSPRING_OK)
        return result;
    if (!mspringi_in_range(def->length_ratio, 0.001f, 1000.0f))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "rope length_ratio is %g, it must be 0.001 to 1000",
                             (double)def->length_ratio);
    const mspringi_particle *from = &builder->particles[def->from], *to = &builder->particles[def->to];
    const double dx = to->x - from->x, dy = to->y - from->y;
    const float segment = (float)(sqrt(dx * dx + dy * dy) * (double)def->length_ratio / (double)def->segment_count);
    if (!(segment > 0.0f && segment <= MSPRINGI_MAX_LENGTH))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "rope from particle %u to %u: a segment would be %g m long, it must be > 0 and at "
                             "most 4e12",
                             (unsigned)def->from, (unsigned)def->to, (double)segment);
    *segment_length = segment;
    return MSPRING_OK;
}

static MSPRINGI_NOINLINE mspring_result add_rope(mspring_builder *builder, const mspring_rope_def *def,
                                                 mspring_id *particles, mspring_id *first_spring) {
    mspring_rope_def taken;
    mspring_material material;
    float segment_length = 0.0f;
    mspring_result result = check_rope(builder, &def, &taken, &material, &segment_length);
    if (result == MSPRING_OK)
        result = mspringi_builder_reserve_particles(builder, def->segment_count - 1);
    if (result == MSPRING_OK)
        result = mspringi_builder_reserve_springs(builder, def->segment_count);
    if (result == MSPRING_OK)
        result = mspringi_builder_reserve_limits(builder, def->segment_count, MSPRINGI_LIMITS_OF(&material));
    if (result != MSPRING_OK)
        return result;

    const mspring_id inner = (mspring_id)builder->particle_count;
    const mspring_id spring = (mspring_id)builder->spring_count;
    const uint32_t segments = def->segment_count;
    const mspringi_particle from = builder->particles[def->from], to = builder->particles[def->to];
    for (uint32_t i = 1; i < segments; ++i) {
        const double t = (double)i / (double)segments;
        builder->particles[builder->particle_count++] = (mspringi_particle){.x = from.x + (to.x - from.x) * t,
                                                                            .y = from.y + (to.y - from.y) * t,
                                                                            .mass = material.mass,
                                                                            .flags = material.particle_flags};
    }
    for (uint32_t i = 0; i < segments; ++i) {
        const mspring_id a = i == 0 ? def->from : inner + i - 1, b = i + 1 == segments ? def->to : inner + i;
        const float mass_a = builder->particles[a].mass, mass_b = builder->particles[b].mass;
        builder->springs[builder->spring_count++] =
            (mspringi_spring){.a = a,
                              .b = b,
                              .stiffness = material.stiffness,
                              .damping = mspringi_find_damping(material.stiffness, material.damping,
                                                               material.spring_flags, mass_a, mass_b),
                              .rest_length = segment_length,
                              .flags = material.spring_flags & MSPRINGI_KEPT_SPRING_FLAGS};
    }
    mspringi_builder_put_limits(builder, spring, MSPRINGI_LIMITS_OF(&material));
    for (uint32_t i = 0; particles && i <= segments; ++i)
        particles[i] = i == 0 ? def->from : i == segments ? def->to : inner + i - 1;
    if (first_spring)
        *first_spring = spring;
    return MSPRING_OK;
}

mspring_result mspring_builder_add_rope(mspring_builder *builder, const mspring_rope_def *def,
                                        mspring_id *particles, mspring_id *first_spring) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_message_clear(&builder->message);
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = add_rope(builder, def, particles, first_spring);
    mspringi_fp_leave(before);
    return mspringi_builder_end(builder, result);
}

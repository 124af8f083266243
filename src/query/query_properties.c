/// Reading of properties.
#include "base/cpu.h"
#include "query/measure.h"
#include "store/group_ops.h"
#include "store/properties.h"
#include "store/rest_lengths.h"
#include "store/sleepers.h"
#include "store/springs.h"

#include "features/contact/contacts.h"
#include "features/contact/floor.h"

/* --------------------------------------------------------------------------------------------------- particles */

static uint32_t particle_total(const mspring_network *network) {
    return network->topology.particle_count;
}

MSPRINGI_ALWAYS_INLINE double value_of_particle(const mspring_network *network, mspring_property property,
                                                mspring_id p) {
    const mspringi_state *s = &network->state;
    const uint32_t slot = network->topology.slot_of_particle[p];
    switch (property) {
    case MSPRING_X:
        return network->origin_x + mspringi_x_of(s, slot);
    case MSPRING_Y:
        return network->origin_y + mspringi_y_of(s, slot);
    case MSPRING_VX:
        return (double)s->vx[slot];
    case MSPRING_VY:
        return (double)s->vy[slot];
    case MSPRING_FRICTION:
        return (double)mspringi_contact_material_of(network, p).friction;
    case MSPRING_RESTITUTION:
        return (double)mspringi_contact_material_of(network, p).restitution;
    case MSPRING_FLOOR_IMPULSE_X:
        return (double)mspringi_floor_impulse_of(network, slot, 0);
    case MSPRING_FLOOR_IMPULSE_Y:
        return (double)mspringi_floor_impulse_of(network, slot, 1);
    case MSPRING_TOUCH:
        return (double)mspringi_contact_touch_of(network, p);
    default:
        return (double)mspringi_particle_property(network, property, p);
    }
}

static double particle_value(const mspring_network *network, mspring_property property, mspring_id p) {
    return value_of_particle(network, property, p);
}

static uint32_t particle_integer(const mspring_network *network, mspring_property property, mspring_id p) {
    const uint32_t slot = network->topology.slot_of_particle[p];
    switch (property) {
    case MSPRING_PARTICLE_FLAGS:
        return (network->inverse_mass[slot] == 0.0f ? (uint32_t)MSPRING_PARTICLE_PINNED : 0u) |
               (mspringi_slot_fell_asleep(network, slot) ? (uint32_t)MSPRING_PARTICLE_ASLEEP : 0u);
    case MSPRING_LAYERS:
        return mspringi_contact_layers_of(network, p);
    case MSPRING_MASKS:
        return mspringi_contact_masks_of(network, p);
    case MSPRING_COMPONENT:
        return network->components.number ? network->components.number[p] : MSPRING_NONE;
    default:
        return slot;
    }
}

const mspringi_thing_ops mspringi_things_particles = {.kind = MSPRING_PARTICLES,
                                                      .name = "particle",
                                                      .total = particle_total,
                                                      .exists = mspringi_particle_exists,
                                                      .get = particle_value,
                                                      .get_integer = particle_integer};

/* ----------------------------------------------------------------------------------------------------- springs */

static uint32_t spring_total(const mspring_network *network) {
    return network->topology.spring_count;
}

static bool is_in_force(mspring_property property) {
    return property >= MSPRING_TENSION && property <= MSPRING_ACTIVE_REST_LENGTH;
}

// r: what was read of the spring.
static float value_in_force(const mspring_network *network, mspring_property property, mspring_id id,
                            const mspringi_spring_values *r) {
    double dx, dy, length;
    switch (property) {
    case MSPRING_TENSION:
        return mspringi_force_of(network, id, r, &dx, &dy, &length);
    case MSPRING_ACTIVE_STIFFNESS:
        return r->stiffness;
    case MSPRING_ACTIVE_DAMPING:
        return r->damping;
    default:
        return mspringi_read_length(r->rest_length);
    }
}

static inline float given_value(const mspring_network *network, mspring_property property, mspring_id id) {
    const float value = mspringi_spring_property(network, property, id);
    return property == MSPRING_REST_LENGTH ? mspringi_read_length(value) : mspringi_read_value(value);
}

static double spring_value(const mspring_network *network, mspring_property property, mspring_id id) {
    if (is_in_force(property)) {
        const mspringi_spring_values r = mspringi_spring_get(network, id);
        return (double)value_in_force(network, property, id, &r);
    }
    return (double)given_value(network, property, id);
}

static uint32_t spring_integer(const mspring_network *network, mspring_property property, mspring_id id) {
    if (property == MSPRING_SPRING_FLAGS)
        return mspringi_spring_flags(network, id);
    const mspringi_ends ends = mspringi_spring_ends(network, id);
    const bool is_first = property == MSPRING_END_A || property == MSPRING_SLOT_A;
    const uint32_t slot = is_first ? ends.a : ends.b;
    return property == MSPRING_SLOT_A || property == MSPRING_SLOT_B ? slot
                                                                    : network->topology.particle_of_slot[slot];
}

const mspringi_thing_ops mspringi_things_springs = {.kind = MSPRING_SPRINGS,
                                                    .name = "spring",
                                                    .total = spring_total,
                                                    .exists = mspringi_spring_exists,
                                                    .get = spring_value,
                                                    .get_integer = spring_integer};

/* ----------------------------------------------------------------------------------------------------- reading */

// Value that a property of integers reads for a removed thing.
static uint32_t removed_integer(mspring_property property) {
    switch (property) {
    case MSPRING_PARTICLE_FLAGS:
        return MSPRING_PARTICLE_REMOVED;
    case MSPRING_SPRING_FLAGS:
        return MSPRING_SPRING_BROKEN | MSPRING_SPRING_REMOVED;
    case MSPRING_ELEMENT_FLAGS:
        return MSPRING_ELEMENT_REMOVED;
    case MSPRING_COMPONENT:
    case MSPRING_SLOT:
    case MSPRING_END_A:
    case MSPRING_END_B:
    case MSPRING_SLOT_A:
    case MSPRING_SLOT_B:
    case MSPRING_ACTUATOR_SPRING:
        return MSPRING_NONE;
    default:
        return 0;
    }
}

static bool is_measured(mspring_property property) {
    return property >= MSPRING_LENGTH && property <= MSPRING_STRAIN;
}

static void get_relative(const mspring_network *network, mspring_property property, const mspringi_selection *at,
                         float *values, size_t stride) {
    mspringi_group_frame frame = {.end = 0};
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id p = mspringi_selected(at, i);
        mspringi_group_frame_of(network, p, &frame);
        values[i * stride] = mspringi_particle_exists(network, p)
                                 ? (float)mspringi_relative_value(network, property, p, &frame)
                                 : 0.0f;
    }
}

static void get_in_force(const mspring_network *network, mspring_property property, const mspringi_selection *at,
                         float *values, size_t stride) {
    enum { BATCH = 64 };
    mspringi_spring_values read[BATCH];
    for (uint32_t i = 0, end; i < at->count; i = end) {
        end = at->count - i < BATCH ? at->count : i + BATCH;
        mspringi_springs_get(network, at, i, end - i, read);
        for (uint32_t of = i; of < end; ++of) {
            const mspring_id id = mspringi_selected(at, of);
            values[of * stride] =
                mspringi_spring_exists(network, id) ? value_in_force(network, property, id, &read[of - i]) : 0.0f;
        }
    }
}

// A loop for each property that games read in every frame takes a fourth of the time of one for all.
MSPRINGI_ALWAYS_INLINE bool get_of_particles(const mspring_network *network, mspring_property property,
                                             const mspringi_selection *at, float *values, size_t stride) {
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id p = mspringi_selected(at, i);
        values[i * stride] =
            mspringi_particle_exists(network, p) ? (float)value_of_particle(network, property, p) : 0.0f;
    }
    return true;
}

static void get_of_springs(const mspring_network *network, mspring_property property, const mspringi_selection *at,
                           float *values, size_t stride) {
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id id = mspringi_selected(at, i);
        values[i * stride] = mspringi_spring_exists(network, id) ? given_value(network, property, id) : 0.0f;
    }
}

static bool get_state(const mspring_network *network, mspring_property property, const mspringi_selection *at,
                      float *values, size_t stride) {
    switch (property) {
    case MSPRING_X:
        return get_of_particles(network, MSPRING_X, at, values, stride);
    case MSPRING_Y:
        return get_of_particles(network, MSPRING_Y, at, values, stride);
    case MSPRING_VX:
        return get_of_particles(network, MSPRING_VX, at, values, stride);
    case MSPRING_VY:
        return get_of_particles(network, MSPRING_VY, at, values, stride);
    default:
        return false;
    }
}

static void get_each(const mspring_network *network, const mspringi_thing_ops *of, mspring_property property,
                     const mspringi_selection *at, float *values, size_t stride) {
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id id = mspringi_selected(at, i);
        values[i * stride] = of->exists(network, id) ? (float)of->get(network, property, id) : 0.0f;
    }
}

static MSPRINGI_NOINLINE void get_values(const mspring_network *network, mspring_property property,
                                         const mspringi_selection *at, float *values, size_t stride) {
    const mspringi_thing_ops *of = mspringi_things_of(mspringi_kind_of(property));
    if (get_state(network, property, at, values, stride))
        return;
    if (property >= MSPRING_RELATIVE_X && property <= MSPRING_RELATIVE_VY)
        get_relative(network, property, at, values, stride);
    else if (is_in_force(property))
        get_in_force(network, property, at, values, stride);
    else if (of == &mspringi_things_springs)
        get_of_springs(network, property, at, values, stride);
    else
        get_each(network, of, property, at, values, stride);
}

static MSPRINGI_NOINLINE void get_integers(const mspring_network *network, mspring_property property,
                                           const mspringi_selection *at, uint32_t *values, size_t stride) {
    const mspringi_thing_ops *of = mspringi_things_of(mspringi_kind_of(property));
    for (uint32_t i = 0; i < at->count; ++i) {
        const mspring_id id = mspringi_selected(at, i);
        values[i * stride] =
            of->exists(network, id) ? of->get_integer(network, property, id) : removed_integer(property);
    }
}

// Take a column to those that are measured together. False if it is none of them, or there is one already.
static bool join_measured(mspringi_lengths *to, mspring_property property, float *values, uint32_t stride) {
    float **const places[] = {&to->length, &to->direction_x, &to->direction_y, &to->strain};
    uint32_t *const strides[] = {&to->length_stride, &to->direction_x_stride, &to->direction_y_stride,
                                 &to->strain_stride};
    const int which = property - MSPRING_LENGTH;
    if (!is_measured(property) || *places[which])
        return false;
    *places[which] = values;
    *strides[which] = stride;
    return true;
}

static mspring_result check(const mspring_network *network, mspring_property property, bool is_of_integers,
                            mspringi_message *message) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    const mspringi_property *known = mspringi_property_of(property);
    if (!known)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "there is no property 0x%x", (unsigned)property);
    if (mspringi_is_of_integers(property) == is_of_integers)
        return MSPRING_OK;
    return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "property 0x%x, %s, has %s values: call %s",
                         (unsigned)property, known->name, is_of_integers ? "float" : "integer",
                         is_of_integers ? "mspring_network_get()" : "mspring_network_get_integers()");
}

static mspring_result enter(const mspring_network *network, mspring_property property, bool is_of_integers) {
    mspringi_message message;
    const mspring_result result = check(network, property, is_of_integers, &message);
    return result == MSPRING_OK || !network ? result : mspringi_shared_set(network->shared, result, &message);
}

mspring_result mspring_network_get(const mspring_network *network, mspring_property property, const mspring_id *ids,
                                   mspring_id first, uint32_t count, float *values, uint32_t stride) {
    mspringi_selection at;
    mspringi_lengths lengths = {.length = NULL};
    mspring_result result = enter(network, property, false);
    if (result == MSPRING_OK)
        result = mspringi_look_up_for(network, mspringi_kind_of(property), ids, first, count, values, values,
                                      stride, &at);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    if (join_measured(&lengths, property, values, stride))
        mspringi_measure(network, &at, &lengths);
    else
        get_values(network, property, &at, values, stride);
    mspringi_fp_leave(before);
    return MSPRING_OK;
}

mspring_result mspring_network_get_integers(const mspring_network *network, mspring_property property,
                                            const mspring_id *ids, mspring_id first, uint32_t count,
                                            uint32_t *values, uint32_t stride) {
    mspringi_selection at;
    mspring_result result = enter(network, property, true);
    if (result == MSPRING_OK)
        result = mspringi_look_up_for(network, mspringi_kind_of(property), ids, first, count, values, values,
                                      stride, &at);
    if (result == MSPRING_OK)
        get_integers(network, property, &at, values, stride);
    return result;
}

/* ----------------------------------------------------------------------------------------------------- columns */

static mspring_result check_columns(const mspring_network *network, uint32_t count, const mspring_column *columns,
                                    uint32_t column_count, mspringi_message *message) {
    if (!columns && column_count > 0)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "the list of columns is NULL");
    for (uint32_t i = 0; i < column_count; ++i) {
        const mspring_column *c = &columns[i];
        mspring_result result = check(network, c->property, mspringi_is_of_integers(c->property), message);
        if (result == MSPRING_OK && mspringi_kind_of(c->property) != mspringi_kind_of(columns[0].property))
            result =
                mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "its property is of other things than the first's");
        if (result == MSPRING_OK && count > 0 && (!c->values || c->stride < 1))
            result = mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s",
                                   c->values ? "its stride is 0, it must be at least 1" : "its values are NULL");
        if (result != MSPRING_OK)
            return mspringi_prefix(message, result, "column", i);
    }
    return MSPRING_OK;
}

mspring_result mspring_network_get_columns(const mspring_network *network, const mspring_id *ids, mspring_id first,
                                           uint32_t count, const mspring_column *columns, uint32_t column_count) {
    mspringi_selection at;
    mspringi_message message;
    mspringi_lengths lengths = {.length = NULL};
    bool has_lengths = false;
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    mspring_result result = check_columns(network, count, columns, column_count, &message);
    if (result != MSPRING_OK)
        return mspringi_shared_set(network->shared, result, &message);
    if (column_count == 0)
        return MSPRING_OK;
    result = mspringi_look_up_for(network, mspringi_kind_of(columns[0].property), ids, first, count, columns,
                                  columns, 1, &at);
    if (result != MSPRING_OK)
        return result;
    const mspringi_fp_state before = mspringi_fp_enter();
    for (uint32_t i = 0; i < column_count; ++i) {
        const mspring_column *c = &columns[i];
        if (mspringi_is_of_integers(c->property))
            get_integers(network, c->property, &at, c->values, c->stride);
        else if (join_measured(&lengths, c->property, c->values, c->stride))
            has_lengths = true;
        else if (is_measured(c->property)) {
            mspringi_lengths again = {.length = NULL};
            (void)join_measured(&again, c->property, c->values, c->stride);
            mspringi_measure(network, &at, &again);
        } else
            get_values(network, c->property, &at, c->values, c->stride);
    }
    if (has_lengths)
        mspringi_measure(network, &at, &lengths);
    mspringi_fp_leave(before);
    return MSPRING_OK;
}

/// Collecting particles and springs: every value is checked here, so that nothing behind it has to.
#include "builder/builder.h"

#include <math.h>

#include "base/cpu.h"

#define LARGEST_VALUE 1e30f
#define SMALLEST_MASS 1e-30f
#define LARGEST_LENGTH 4e12f // over any distance between two places within MSPRING_MAX_COORDINATE

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
    mspringi_free(&memory, builder);
}

const char *mspring_builder_error(const mspring_builder *builder) {
    return builder ? builder->message.text : "";
}

uint32_t mspring_builder_particle_count(const mspring_builder *builder) {
    return builder ? (uint32_t)builder->particle_count : 0;
}

uint32_t mspring_builder_spring_count(const mspring_builder *builder) {
    return builder ? (uint32_t)builder->spring_count : 0;
}

/* ---------------------------------------------------------------------------------------------- reserving */

static mspring_result reserve_particles(mspring_builder *builder, size_t count) {
    if (count > MSPRING_MAX_PARTICLES - builder->particle_count)
        return mspringi_fail(&builder->message, MSPRING_ERROR_LIMIT,
                             "%zu particles more on top of %zu are over the limit of %u", count,
                             builder->particle_count, (unsigned)MSPRING_MAX_PARTICLES);
    void *particles = builder->particles;
    bool grown = mspringi_grow(&builder->memory, &particles, &builder->particle_capacity,
                               builder->particle_count + count, sizeof *builder->particles);
    builder->particles = particles;
    return grown
               ? MSPRING_OK
               : mspringi_fail(&builder->message, MSPRING_ERROR_MEMORY, "no memory for %zu particles more", count);
}

static mspring_result reserve_springs(mspring_builder *builder, size_t count) {
    if (count > MSPRING_MAX_SPRINGS - builder->spring_count)
        return mspringi_fail(&builder->message, MSPRING_ERROR_LIMIT,
                             "%zu springs more on top of %zu are over the limit of %u", count,
                             builder->spring_count, (unsigned)MSPRING_MAX_SPRINGS);
    void *springs = builder->springs;
    bool grown = mspringi_grow(&builder->memory, &springs, &builder->spring_capacity, builder->spring_count + count,
                               sizeof *builder->springs);
    builder->springs = springs;
    return grown ? MSPRING_OK
                 : mspringi_fail(&builder->message, MSPRING_ERROR_MEMORY, "no memory for %zu springs more", count);
}

/* ----------------------------------------------------------------------------------------------- checking */

// Comparisons are written so that NaN fails them. What computes values for the network runs in the floating-point
// environment of a step.

static bool in_range(float value, float low, float high) {
    return value >= low && value <= high;
}

static bool is_coordinate(double value) {
    return value >= -MSPRING_MAX_COORDINATE && value <= MSPRING_MAX_COORDINATE;
}

// A definition's struct_size, where it is one of several.
static mspring_result check_struct_of(mspringi_message *message, const char *what, size_t index, const char *name,
                                      size_t given, size_t known) {
    if (given == known)
        return MSPRING_OK;
    return mspringi_fail(message, MSPRING_ERROR_STRUCT,
                         "%s %zu: %s.struct_size is %zu, this library knows %zu: fill the struct with its init "
                         "function",
                         what, index, name, given, known);
}

// Put the place in the caller's array in front of what was wrong with it.
static mspring_result name_definition(mspring_builder *builder, mspring_result result, size_t index) {
    const mspringi_message reason = builder->message;
    return mspringi_fail(&builder->message, result, "definition %zu: %s", index, reason.text);
}

static mspring_result check_mass(mspringi_message *message, const char *what, size_t index, float mass) {
    if (in_range(mass, SMALLEST_MASS, LARGEST_VALUE))
        return MSPRING_OK;
    return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s %zu: mass is %g kg, it must be 1e-30 to 1e30", what,
                         index, (double)mass);
}

static mspring_result check_coefficients(mspringi_message *message, const char *what, size_t index, float stiffness,
                                         float damping, uint32_t flags) {
    if (!in_range(stiffness, 0.0f, LARGEST_VALUE))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s %zu: stiffness is %g, it must be 0 to 1e30", what,
                             index, (double)stiffness);
    if (!in_range(damping, 0.0f, LARGEST_VALUE))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s %zu: damping is %g, it must be 0 to 1e30", what,
                             index, (double)damping);
    if (flags & ~(uint32_t)MSPRING_SPRING_RELATIVE)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "%s %zu: unknown spring flags 0x%x", what, index,
                             (unsigned)flags);
    return MSPRING_OK;
}

mspring_result mspringi_check_particle_def(mspringi_message *message, size_t index,
                                           const mspring_particle_def *def) {
    mspring_result result =
        check_struct_of(message, "particle", index, "mspring_particle_def", def->struct_size, sizeof *def);
    if (result != MSPRING_OK)
        return result;
    if (!is_coordinate(def->x) || !is_coordinate(def->y))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "particle %zu: position (%g, %g) m is not within 1e12", index, def->x, def->y);
    if (!mspringi_is_speed(def->vx) || !mspringi_is_speed(def->vy))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "particle %zu: velocity (%g, %g) m/s is not within 1e15", index, (double)def->vx,
                             (double)def->vy);
    if (def->flags & ~(uint32_t)MSPRING_PARTICLE_PINNED)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "particle %zu: unknown particle flags 0x%x", index,
                             (unsigned)def->flags);
    return check_mass(message, "particle", index, def->mass);
}

mspring_result mspringi_check_spring_def(mspringi_message *message, size_t index, const mspring_spring_def *def) {
    return check_struct_of(message, "spring", index, "mspring_spring_def", def->struct_size, sizeof *def);
}

mspring_result mspringi_check_spring_values(mspringi_message *message, size_t index,
                                            const mspring_spring_def *def) {
    if (def->a == def->b)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "spring %zu joins particle %u to itself", index,
                             (unsigned)def->a);
    return check_coefficients(message, "spring", index, def->stiffness, def->damping, def->flags);
}

mspring_result mspringi_find_rest_length(mspringi_message *message, size_t index, const mspring_spring_def *def,
                                         double dx, double dy, float *rest_length) {
    float length = def->rest_length;
    if (length == MSPRING_REST_LENGTH_DISTANCE) {
        length = (float)sqrt(dx * dx + dy * dy);
        if (!(length > 0.0f))
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                 "spring %zu: particles %u and %u lie in the same place, so their distance is no "
                                 "rest length: give one",
                                 index, (unsigned)def->a, (unsigned)def->b);
    }
    if (!(length > 0.0f && length <= LARGEST_LENGTH))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "spring %zu: rest length is %g m, it must be > 0 and at most 4e12", index,
                             (double)length);
    *rest_length = length;
    return MSPRING_OK;
}

// Check a spring and find its rest length.
static mspring_result check_spring(mspring_builder *builder, size_t index, const mspring_spring_def *def,
                                   float *rest_length) {
    mspringi_message *message = &builder->message;
    mspring_result result = mspringi_check_spring_def(message, index, def);
    if (result != MSPRING_OK)
        return result;
    if (def->a >= builder->particle_count || def->b >= builder->particle_count)
        return mspringi_fail(message, MSPRING_ERROR_ID,
                             "spring %zu joins particles %u and %u, but there are only %zu particles", index,
                             (unsigned)def->a, (unsigned)def->b, builder->particle_count);
    result = mspringi_check_spring_values(message, index, def);
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
    builder->springs[builder->spring_count++] = (mspringi_spring){.a = def->a,
                                                                  .b = def->b,
                                                                  .stiffness = def->stiffness,
                                                                  .damping = def->damping,
                                                                  .rest_length = rest_length,
                                                                  .flags = def->flags};
}

mspring_result mspring_builder_add_particles(mspring_builder *builder, const mspring_particle_def *defs,
                                             size_t count, mspring_id *first_id) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    if (!defs && count > 0)
        return mspringi_fail(&builder->message, MSPRING_ERROR_ARGUMENT, "particle definitions are NULL");
    const size_t before = builder->particle_count;
    mspring_result result = reserve_particles(builder, count);
    for (size_t i = 0; result == MSPRING_OK && i < count; ++i) {
        result = mspringi_check_particle_def(&builder->message, before + i, &defs[i]);
        if (result == MSPRING_OK)
            append_particle(builder, &defs[i]);
        else if (count > 1)
            result = name_definition(builder, result, i);
    }
    if (result != MSPRING_OK)
        builder->particle_count = before;
    else if (first_id)
        *first_id = (mspring_id)before;
    return result;
}

mspring_result mspring_builder_add_particle(mspring_builder *builder, const mspring_particle_def *def,
                                            mspring_id *id) {
    return mspring_builder_add_particles(builder, def, 1, id);
}

static MSPRINGI_NOINLINE mspring_result add_springs(mspring_builder *builder, const mspring_spring_def *defs,
                                                    size_t count, mspring_id *first_id) {
    if (!defs && count > 0)
        return mspringi_fail(&builder->message, MSPRING_ERROR_ARGUMENT, "spring definitions are NULL");
    const size_t before = builder->spring_count;
    mspring_result result = reserve_springs(builder, count);
    for (size_t i = 0; result == MSPRING_OK && i < count; ++i) {
        float rest_length = 0.0f;
        result = check_spring(builder, before + i, &defs[i], &rest_length);
        if (result == MSPRING_OK)
            append_spring(builder, &defs[i], rest_length);
        else if (count > 1)
            result = name_definition(builder, result, i);
    }
    if (result != MSPRING_OK)
        builder->spring_count = before;
    else if (first_id)
        *first_id = (mspring_id)before;
    return result;
}

mspring_result mspring_builder_add_springs(mspring_builder *builder, const mspring_spring_def *defs, size_t count,
                                           mspring_id *first_id) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    const mspringi_fp_state before = mspringi_fp_enter();
    mspring_result result = add_springs(builder, defs, count, first_id);
    mspringi_fp_leave(before);
    return result;
}

mspring_result mspring_builder_add_spring(mspring_builder *builder, const mspring_spring_def *def, mspring_id *id) {
    return mspring_builder_add_springs(builder, def, 1, id);
}

/* ------------------------------------------------------------------------------------------------- lattice */

static mspring_result check_materials(mspring_builder *builder, const mspring_lattice_def *def) {
    mspringi_message *message = &builder->message;
    if (!def->materials && def->material_count > 0)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "lattice materials are NULL");
    if (def->material_count > MSPRING_CELL_EMPTY)
        return mspringi_fail(message, MSPRING_ERROR_LIMIT, "%u materials are over the limit of %u",
                             (unsigned)def->material_count, (unsigned)MSPRING_CELL_EMPTY);
    for (uint32_t i = 0; i < def->material_count; ++i) {
        const mspring_material *material = &def->materials[i];
        mspring_result result = check_struct_of(&builder->message, "material", i, "mspring_material",
                                                material->struct_size, sizeof *material);
        if (result == MSPRING_OK)
            result = check_mass(&builder->message, "material", i, material->mass);
        if (result == MSPRING_OK)
            result = check_coefficients(&builder->message, "material", i, material->stiffness, material->damping,
                                        material->spring_flags);
        if (result != MSPRING_OK)
            return result;
        if (material->particle_flags & ~(uint32_t)MSPRING_PARTICLE_PINNED)
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "material %u: unknown particle flags 0x%x",
                                 (unsigned)i, (unsigned)material->particle_flags);
        if (material->spring_flags != def->materials[0].spring_flags)
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                 "material %u: some materials are relative and some are not", (unsigned)i);
    }
    return MSPRING_OK;
}

// Whether neighbouring cells between two coordinates would round to the same place.
static bool is_lost(double spacing, size_t cells, double low, double high) {
    return cells > 1 && (low + spacing == low || high - spacing == high);
}

// Check a lattice's cells and count what it will add.
static mspring_result check_lattice(mspring_builder *builder, const mspring_lattice_def *def, size_t *particles,
                                    size_t *springs) {
    mspringi_message *message = &builder->message;
    mspring_result result =
        mspringi_check_struct(message, "mspring_lattice_def", def->struct_size, sizeof *def, sizeof *def);
    if (result != MSPRING_OK)
        return result;
    const size_t width = def->width, height = def->height;
    if (width == 0 || height == 0)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "lattice has %u x %u cells, it needs at least one",
                             (unsigned)def->width, (unsigned)def->height);
    if (width > MSPRING_MAX_PARTICLES / height)
        return mspringi_fail(message, MSPRING_ERROR_LIMIT, "lattice of %u x %u cells is over the limit of %u",
                             (unsigned)def->width, (unsigned)def->height, (unsigned)MSPRING_MAX_PARTICLES);
    if (!def->cells)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "lattice cells are NULL");
    if (!(def->spacing >= 1e-9 && def->spacing <= 1e9))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "lattice spacing is %g m, it must be 1e-9 to 1e9",
                             def->spacing);
    const double right = def->x + (double)(width - 1) * def->spacing;
    const double top = def->y + (double)(height - 1) * def->spacing;
    if (!is_coordinate(def->x) || !is_coordinate(def->y) || !is_coordinate(right) || !is_coordinate(top))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "lattice from (%g, %g) to (%g, %g) m is not within 1e12", def->x, def->y, right, top);
    if (is_lost(def->spacing, width, def->x, right) || is_lost(def->spacing, height, def->y, top))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "lattice spacing %g m is lost in coordinates from (%g, %g) to (%g, %g) m",
                             def->spacing, def->x, def->y, right, top);
    result = check_materials(builder, def);
    if (result != MSPRING_OK)
        return result;

    *particles = *springs = 0;
    for (size_t row = 0; row < height; ++row) {
        const uint16_t *cells = def->cells + row * width;
        const uint16_t *below = row + 1 < height ? cells + width : NULL;
        for (size_t column = 0; column < width; ++column) {
            if (cells[column] == MSPRING_CELL_EMPTY)
                continue;
            if (cells[column] >= def->material_count)
                return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                     "lattice cell in column %zu, row %zu has material %u, but there are only %u",
                                     column, row, (unsigned)cells[column], (unsigned)def->material_count);
            *particles += 1;
            *springs += column + 1 < width && cells[column + 1] != MSPRING_CELL_EMPTY;
            *springs += below && column > 0 && below[column - 1] != MSPRING_CELL_EMPTY;
            *springs += below && below[column] != MSPRING_CELL_EMPTY;
            *springs += below && column + 1 < width && below[column + 1] != MSPRING_CELL_EMPTY;
        }
    }
    return MSPRING_OK;
}

// The ids of a lattice's particles are dense in cell order, so those of two rows are enough to join them.
static void join_cells(mspring_builder *builder, const mspring_lattice_def *def, mspring_id a, uint16_t material_a,
                       mspring_id b, uint16_t material_b, bool diagonal) {
    const mspring_material *ma = &def->materials[material_a], *mb = &def->materials[material_b];
    const double length = diagonal ? def->spacing * 1.4142135623730951 : def->spacing;
    builder->springs[builder->spring_count++] =
        (mspringi_spring){.a = a,
                          .b = b,
                          .stiffness = 0.5f * ma->stiffness + 0.5f * mb->stiffness,
                          .damping = 0.5f * ma->damping + 0.5f * mb->damping,
                          .rest_length = (float)length,
                          .flags = ma->spring_flags};
}

static void append_lattice(mspring_builder *builder, const mspring_lattice_def *def, mspring_id *cell_ids) {
    const size_t width = def->width, height = def->height;
    mspring_id id = (mspring_id)builder->particle_count;
    mspring_id next_below = id; // id of the first particle of the row below
    for (size_t column = 0; column < width; ++column)
        next_below += def->cells[column] != MSPRING_CELL_EMPTY;

    for (size_t row = 0; row < height; ++row) {
        const uint16_t *cells = def->cells + row * width;
        const uint16_t *below = row + 1 < height ? cells + width : NULL;
        // The id that the cell below this one has, if it is not empty.
        mspring_id below_id = next_below;
        for (size_t column = 0; column < width; ++column) {
            const bool has_below = below && below[column] != MSPRING_CELL_EMPTY;
            if (cell_ids)
                cell_ids[row * width + column] = MSPRING_NONE;
            if (cells[column] != MSPRING_CELL_EMPTY) {
                const mspring_material *material = &def->materials[cells[column]];
                builder->particles[builder->particle_count++] =
                    (mspringi_particle){.x = def->x + (double)column * def->spacing,
                                        .y = def->y + (double)(height - 1 - row) * def->spacing,
                                        .mass = material->mass,
                                        .flags = material->particle_flags};
                if (column + 1 < width && cells[column + 1] != MSPRING_CELL_EMPTY)
                    join_cells(builder, def, id, cells[column], id + 1, cells[column + 1], false);
                if (below && column > 0 && below[column - 1] != MSPRING_CELL_EMPTY)
                    join_cells(builder, def, id, cells[column], below_id - 1, below[column - 1], true);
                if (has_below)
                    join_cells(builder, def, id, cells[column], below_id, below[column], false);
                if (below && column + 1 < width && below[column + 1] != MSPRING_CELL_EMPTY)
                    join_cells(builder, def, id, cells[column], below_id + has_below, below[column + 1], true);
                if (cell_ids)
                    cell_ids[row * width + column] = id;
                ++id;
            }
            below_id += has_below;
        }
        next_below = below_id;
    }
}

static MSPRINGI_NOINLINE mspring_result add_lattice(mspring_builder *builder, const mspring_lattice_def *def,
                                                    mspring_id *cell_ids) {
    size_t particles = 0, springs = 0;
    if (!def)
        return mspringi_fail(&builder->message, MSPRING_ERROR_ARGUMENT, "lattice definition is NULL");
    mspring_result result = check_lattice(builder, def, &particles, &springs);
    if (result == MSPRING_OK)
        result = reserve_particles(builder, particles);
    if (result == MSPRING_OK)
        result = reserve_springs(builder, springs);
    if (result == MSPRING_OK)
        append_lattice(builder, def, cell_ids);
    return result;
}

mspring_result mspring_builder_add_lattice(mspring_builder *builder, const mspring_lattice_def *def,
                                           mspring_id *cell_ids) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    const mspringi_fp_state before = mspringi_fp_enter();
    mspring_result result = add_lattice(builder, def, cell_ids);
    mspringi_fp_leave(before);
    return result;
}

/* ---------------------------------------------------------------------------------------------------- rope */

static mspring_result check_rope(mspring_builder *builder, const mspring_rope_def *def, float *segment_length) {
    mspringi_message *message = &builder->message;
    mspring_result result =
        mspringi_check_struct(message, "mspring_rope_def", def->struct_size, sizeof *def, sizeof *def);
    if (result != MSPRING_OK)
        return result;
    if (def->from >= builder->particle_count || def->to >= builder->particle_count)
        return mspringi_fail(message, MSPRING_ERROR_ID,
                             "rope from particle %u to %u, but there are only %zu particles", (unsigned)def->from,
                             (unsigned)def->to, builder->particle_count);
    if (def->from == def->to)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "rope from particle %u to itself",
                             (unsigned)def->from);
    if (def->segment_count == 0)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "rope has no segment, it needs at least one");
    result = check_mass(&builder->message, "rope from particle", def->from, def->mass);
    if (result == MSPRING_OK)
        result = check_coefficients(&builder->message, "rope from particle", def->from, def->stiffness,
                                    def->damping, def->spring_flags);
    if (result != MSPRING_OK)
        return result;
    if (!in_range(def->slack, 0.001f, 1000.0f))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "rope slack is %g, it must be 0.001 to 1000",
                             (double)def->slack);
    const mspringi_particle *from = &builder->particles[def->from], *to = &builder->particles[def->to];
    const double dx = to->x - from->x, dy = to->y - from->y;
    const float segment = (float)(sqrt(dx * dx + dy * dy) * (double)def->slack / (double)def->segment_count);
    if (!(segment > 0.0f && segment <= LARGEST_LENGTH))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "rope from particle %u to %u: a segment would be %g m long, it must be > 0 and at "
                             "most 4e12",
                             (unsigned)def->from, (unsigned)def->to, (double)segment);
    *segment_length = segment;
    return MSPRING_OK;
}

static MSPRINGI_NOINLINE mspring_result add_rope(mspring_builder *builder, const mspring_rope_def *def,
                                                 mspring_id *first_particle, mspring_id *first_spring) {
    float segment_length = 0.0f;
    if (!def)
        return mspringi_fail(&builder->message, MSPRING_ERROR_ARGUMENT, "rope definition is NULL");
    mspring_result result = check_rope(builder, def, &segment_length);
    if (result == MSPRING_OK)
        result = reserve_particles(builder, def->segment_count - 1);
    if (result == MSPRING_OK)
        result = reserve_springs(builder, def->segment_count);
    if (result != MSPRING_OK)
        return result;

    const mspring_id inner = (mspring_id)builder->particle_count;
    const mspring_id spring = (mspring_id)builder->spring_count;
    const uint32_t segments = def->segment_count;
    const mspringi_particle from = builder->particles[def->from], to = builder->particles[def->to];
    for (uint32_t i = 1; i < segments; ++i) {
        const double t = (double)i / (double)segments;
        builder->particles[builder->particle_count++] = (mspringi_particle){
            .x = from.x + (to.x - from.x) * t, .y = from.y + (to.y - from.y) * t, .mass = def->mass};
    }
    for (uint32_t i = 0; i < segments; ++i)
        builder->springs[builder->spring_count++] = (mspringi_spring){.a = i == 0 ? def->from : inner + i - 1,
                                                                      .b = i + 1 == segments ? def->to : inner + i,
                                                                      .stiffness = def->stiffness,
                                                                      .damping = def->damping,
                                                                      .rest_length = segment_length,
                                                                      .flags = def->spring_flags};
    if (first_particle)
        *first_particle = segments > 1 ? inner : MSPRING_NONE;
    if (first_spring)
        *first_spring = spring;
    return MSPRING_OK;
}

mspring_result mspring_builder_add_rope(mspring_builder *builder, const mspring_rope_def *def,
                                        mspring_id *first_particle, mspring_id *first_spring) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    const mspringi_fp_state before = mspringi_fp_enter();
    mspring_result result = add_rope(builder, def, first_particle, first_spring);
    mspringi_fp_leave(before);
    return result;
}

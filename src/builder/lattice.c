/// Lattice: cells become particles, neighbours get springs.
#include "builder/builder.h"

#include "base/cpu.h"

// Copy the materials at this library's size, and check them. The definition then points to the copies.
static mspring_result take_materials(mspring_builder *builder, mspring_lattice_def *def,
                                     mspring_material **materials) {
    mspringi_message *message = &builder->message;
    if (!def->materials && def->material_count > 0)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "lattice materials are NULL");
    if (def->material_count > MSPRING_CELL_EMPTY)
        return mspringi_fail(message, MSPRING_ERROR_LIMIT, "%u materials are over the limit of %u",
                             (unsigned)def->material_count, (unsigned)MSPRING_CELL_EMPTY);
    *materials = mspringi_alloc(&builder->memory, def->material_count, sizeof **materials);
    if (!*materials)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for %u materials",
                             (unsigned)def->material_count);
    for (uint32_t i = 0; i < def->material_count; ++i) {
        mspring_material *material = &(*materials)[i];
        const mspring_result result = mspringi_take_good_material(message, "material", i, def->materials, material);
        if (result != MSPRING_OK)
            return result;
        if (material->spring_flags != (*materials)->spring_flags)
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                 "material %u: its spring_flags are 0x%x, they must be 0x%x as those of material 0",
                                 (unsigned)i, (unsigned)material->spring_flags,
                                 (unsigned)(*materials)->spring_flags);
    }
    def->materials = *materials;
    return MSPRING_OK;
}

// Refuse shares that make springs stiffer than one may be.
static mspring_result check_shares(mspringi_message *message, const mspring_lattice_def *def) {
    const float share = def->shear_share > def->bend_share ? def->shear_share : def->bend_share;
    for (uint32_t i = 0; i < def->material_count; ++i) {
        const mspring_material *of = &def->materials[i];
        const bool is_ratio = of->spring_flags & MSPRING_SPRING_DAMPING_RATIO;
        const mspring_result result = mspringi_check_coefficients(
            message, "material", i, share > 1.0f ? share * of->stiffness : of->stiffness,
            share > 1.0f && !is_ratio ? share * of->damping : of->damping, of->spring_flags);
        if (result != MSPRING_OK)
            return mspringi_fail(message, result,
                                 "material %u: times %g, the larger share, its stiffness of %g or "
                                 "damping of %g is above 1e30",
                                 (unsigned)i, (double)share, (double)of->stiffness, (double)of->damping);
    }
    return MSPRING_OK;
}

// True if neighbouring cells would have equal coordinates after rounding.
static bool is_spacing_lost(double spacing, size_t cells, double low, double high) {
    return cells > 1 && (low + spacing == low || high - spacing == high);
}

// True if a full cell has a bend spring to the second cell to its right, or below it.

static bool has_bend_right(const mspring_lattice_def *def, size_t row, size_t column) {
    const uint16_t *cell = def->cells + row * def->width + column;
    return column + 2 < def->width && cell[1] != MSPRING_CELL_EMPTY && cell[2] != MSPRING_CELL_EMPTY;
}

static bool has_bend_below(const mspring_lattice_def *def, size_t row, size_t column) {
    const size_t width = def->width;
    const uint16_t *cell = def->cells + row * width + column;
    return row + 2 < def->height && cell[width] != MSPRING_CELL_EMPTY && cell[2 * width] != MSPRING_CELL_EMPTY;
}

// Check a lattice's cells and count its particles and springs.
static mspring_result check_lattice(mspring_builder *builder, mspring_lattice_def *def,
                                    mspring_material **materials, size_t *particles, size_t *springs) {
    mspringi_message *message = &builder->message;
    const size_t width = def->width, height = def->height;
    if (width == 0 || height == 0)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "lattice has %u x %u cells, it needs at least one",
                             (unsigned)def->width, (unsigned)def->height);
    if (width > MSPRING_MAX_PARTICLES / height)
        return mspringi_fail(message, MSPRING_ERROR_LIMIT, "lattice of %u x %u cells is over the limit of %u",
                             (unsigned)def->width, (unsigned)def->height, (unsigned)MSPRING_MAX_PARTICLES);
    if (!(def->spacing >= 1e-9 && def->spacing <= 1e9))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "lattice spacing is %g m, it must be 1e-9 to 1e9",
                             def->spacing);
    const double right = def->x + (double)(width - 1) * def->spacing;
    const double top = def->y + (double)(height - 1) * def->spacing;
    if (!mspringi_is_coordinate(def->x) || !mspringi_is_coordinate(def->y) || !mspringi_is_coordinate(right) ||
        !mspringi_is_coordinate(top))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "lattice from (%g, %g) to (%g, %g) m is not within 1e12", def->x, def->y, right, top);
    if (is_spacing_lost(def->spacing, width, def->x, right) || is_spacing_lost(def->spacing, height, def->y, top))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "lattice spacing %g m is lost in coordinates from (%g, %g) to (%g, %g) m",
                             def->spacing, def->x, def->y, right, top);
    const mspring_result result = take_materials(builder, def, materials);
    if (result != MSPRING_OK)
        return result;

    if (!(def->shear_share >= 0.0f && def->shear_share <= 1e3f) ||
        !(def->bend_share >= 0.0f && def->bend_share <= 1e3f))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "lattice has shear_share %g and bend_share %g, they must be 0 to 1000",
                             (double)def->shear_share, (double)def->bend_share);
    const mspring_result scaled = check_shares(message, def);
    if (scaled != MSPRING_OK)
        return scaled;
    const bool has_shear = def->shear_share > 0.0f, has_bend = def->bend_share > 0.0f;

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
            *springs += has_shear && below && column + 1 < width && below[column + 1] != MSPRING_CELL_EMPTY;
            *springs += has_bend && has_bend_right(def, row, column);
            *springs += has_bend && has_bend_below(def, row, column);
        }
    }
    return MSPRING_OK;
}

// Limits of springs between two materials: those of the weaker one.
static mspringi_limits join_limits(const mspring_material *a, const mspring_material *b) {
    const mspring_material *stressed = b->warn_strain < a->warn_strain ? b : a;
    const mspring_material *yields = b->yield_strain < a->yield_strain ? b : a;
    return (mspringi_limits){.break_strain = b->break_strain < a->break_strain ? b->break_strain : a->break_strain,
                             .warn_strain = stressed->warn_strain,
                             .relax_strain = stressed->relax_strain,
                             .yield_strain = yields->yield_strain,
                             .hardening = yields->hardening,
                             .plastic_limit = yields->plastic_limit};
}

// Make room for the springs' limits, if a material has any.
static mspring_result reserve_limits(mspring_builder *builder, const mspring_lattice_def *def, size_t springs) {
    mspring_result result = MSPRING_OK;
    for (uint32_t i = 0; result == MSPRING_OK && i < def->material_count; ++i)
        result = mspringi_builder_reserve_limits(builder, springs, MSPRINGI_LIMITS_OF(&def->materials[i]));
    return result;
}

typedef enum join { STRUCTURAL, SHEAR, BEND } join;

// Add the spring between two cells. Ids are dense in cell order, so two rows of ids suffice to find neighbours.
static void join_cells(mspring_builder *builder, const mspring_lattice_def *def, mspring_id a, uint16_t material_a,
                       mspring_id b, uint16_t material_b, join kind) {
    static const double cells[] = {[STRUCTURAL] = 1.0, [SHEAR] = 1.4142135623730951, [BEND] = 2.0};
    const float shares[] = {[STRUCTURAL] = 1.0f, [SHEAR] = def->shear_share, [BEND] = def->bend_share};
    const mspring_material *ma = &def->materials[material_a], *mb = &def->materials[material_b];
    const uint32_t flags = ma->spring_flags;
    const float stiffness = shares[kind] * (0.5f * ma->stiffness + 0.5f * mb->stiffness);
    const float given = 0.5f * ma->damping + 0.5f * mb->damping;
    const float damping = flags & MSPRING_SPRING_DAMPING_RATIO ? given : shares[kind] * given;
    builder->springs[builder->spring_count++] =
        (mspringi_spring){.a = a,
                          .b = b,
                          .stiffness = stiffness,
                          .damping = mspringi_find_damping(stiffness, damping, flags, ma->mass, mb->mass),
                          .rest_length = (float)(def->spacing * cells[kind]),
                          .flags = flags & MSPRINGI_KEPT_SPRING_FLAGS};
    mspringi_builder_put_limits(builder, builder->spring_count - 1, join_limits(ma, mb));
}

static void append_lattice(mspring_builder *builder, const mspring_lattice_def *def, mspring_id *cell_ids) {
    const size_t width = def->width, height = def->height;
    const bool has_shear = def->shear_share > 0.0f;
    mspring_id id = (mspring_id)builder->particle_count;
    mspring_id next_below = id; // id of the first particle of the row below
    for (size_t column = 0; column < width; ++column)
        next_below += def->cells[column] != MSPRING_CELL_EMPTY;

    for (size_t row = 0; row < height; ++row) {
        const uint16_t *cells = def->cells + row * width;
        const uint16_t *below = row + 1 < height ? cells + width : NULL;
        // Id of the cell below this one, if that is not empty.
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
                    join_cells(builder, def, id, cells[column], id + 1, cells[column + 1], STRUCTURAL);
                if (has_shear && below && column > 0 && below[column - 1] != MSPRING_CELL_EMPTY)
                    join_cells(builder, def, id, cells[column], below_id - 1, below[column - 1], SHEAR);
                if (has_below)
                    join_cells(builder, def, id, cells[column], below_id, below[column], STRUCTURAL);
                if (has_shear && below && column + 1 < width && below[column + 1] != MSPRING_CELL_EMPTY)
                    join_cells(builder, def, id, cells[column], below_id + has_below, below[column + 1], SHEAR);
                if (cell_ids)
                    cell_ids[row * width + column] = id;
                ++id;
            }
            below_id += has_below;
        }
        next_below = below_id;
    }
}

static uint32_t particles_in_row(const mspring_lattice_def *def, size_t row) {
    uint32_t count = 0;
    for (size_t column = 0; row < def->height && column < def->width; ++column)
        count += def->cells[row * def->width + column] != MSPRING_CELL_EMPTY;
    return count;
}

static void append_bend_springs(mspring_builder *builder, const mspring_lattice_def *def, mspring_id first_id) {
    const size_t width = def->width;
    mspring_id id = first_id;
    mspring_id second_below = first_id + particles_in_row(def, 0) + particles_in_row(def, 1);
    for (size_t row = 0; row < def->height; ++row) {
        for (size_t column = 0; column < width; ++column) {
            const uint16_t *cell = def->cells + row * width + column;
            if (cell[0] != MSPRING_CELL_EMPTY) {
                if (has_bend_right(def, row, column))
                    join_cells(builder, def, id, cell[0], id + 2, cell[2], BEND);
                if (has_bend_below(def, row, column))
                    join_cells(builder, def, id, cell[0], second_below, cell[2 * width], BEND);
                ++id;
            }
            second_below += row + 2 < def->height && cell[2 * width] != MSPRING_CELL_EMPTY;
        }
    }
}

// A definition without cells has the first material in all of them.
static mspring_result fill_cells(mspring_builder *builder, mspring_lattice_def *def, uint16_t **cells) {
    const size_t count = (size_t)def->width * def->height;
    if (def->cells || count == 0 || count > MSPRING_MAX_PARTICLES) // too many are refused below
        return MSPRING_OK;
    def->cells = *cells = mspringi_alloc(&builder->memory, count, sizeof **cells);
    return def->cells ? MSPRING_OK
                      : mspringi_fail(&builder->message, MSPRING_ERROR_MEMORY, "no memory for %zu cells", count);
}

static MSPRINGI_NOINLINE mspring_result add_lattice(mspring_builder *builder, const mspring_lattice_def *def,
                                                    mspring_id *cell_ids) {
    mspring_lattice_def taken;
    mspring_material *materials = NULL;
    uint16_t *cells = NULL;
    size_t particles = 0, springs = 0;
    mspring_result result = mspringi_take_lattice_def(&builder->message, &def, &taken);
    if (result == MSPRING_OK)
        result = fill_cells(builder, &taken, &cells);
    if (result == MSPRING_OK)
        result = check_lattice(builder, &taken, &materials, &particles, &springs);
    if (result == MSPRING_OK)
        result = mspringi_builder_reserve_particles(builder, particles);
    if (result == MSPRING_OK)
        result = mspringi_builder_reserve_springs(builder, springs);
    if (result == MSPRING_OK)
        result = reserve_limits(builder, def, springs);
    if (result == MSPRING_OK) {
        const mspring_id first_id = (mspring_id)builder->particle_count;
        append_lattice(builder, def, cell_ids);
        if (def->bend_share > 0.0f)
            append_bend_springs(builder, def, first_id);
    }
    mspringi_free(&builder->memory, materials);
    mspringi_free(&builder->memory, cells);
    return result;
}

mspring_result mspring_builder_add_lattice(mspring_builder *builder, const mspring_lattice_def *def,
                                           mspring_id *cell_ids) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_message_clear(&builder->message);
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = add_lattice(builder, def, cell_ids);
    mspringi_fp_leave(before);
    return mspringi_builder_end(builder, result);
}

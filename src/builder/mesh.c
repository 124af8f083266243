/// Mesh of triangles: vertices become particles, edges become springs.
///
/// Stiffness from Young's modulus: k = E h (sum of the areas of the edge's triangles) / length^2. (Van Gelder,
/// "Approximate simulation of elastic membranes by triangulated spring meshes", Journal of Graphics Tools 3(2),
/// 1998.)
#include "builder/builder.h"

#include <math.h>

#include "base/cpu.h"

// Smallest ratio of a triangle's height over its longest side to that side. Thinner ones have no area.
#define MIN_ASPECT_RATIO 1e-9

// Sides of triangles. Side 3 t + i of triangle t joins its corner i to the next one.
typedef struct mesh_work {
    uint32_t *first_of_vertex; // [vertices + 1] first side with this lower vertex
    uint32_t *sides;           // [sides] by lower vertex, in order
    uint32_t *same;            // [sides] first side between the same vertices
    uint32_t *seen_from;       // [vertices] 1 + lower vertex of the last side to this vertex
    uint32_t *seen_by;         // [vertices] that side
    double *area;              // [sides] area of the triangles at an edge, m^2, for its first side
    double *mass;              // [vertices] kg
} mesh_work;

static mspring_result allocate(mspring_builder *builder, size_t vertices, size_t sides, mesh_work *work) {
    mspringi_memory *memory = &builder->memory;
    work->first_of_vertex = mspringi_alloc(memory, vertices + 1, sizeof *work->first_of_vertex);
    work->sides = mspringi_alloc(memory, sides, sizeof *work->sides);
    work->same = mspringi_alloc(memory, sides, sizeof *work->same);
    work->seen_from = mspringi_alloc(memory, vertices, sizeof *work->seen_from);
    work->seen_by = mspringi_alloc(memory, vertices, sizeof *work->seen_by);
    work->area = mspringi_alloc(memory, sides, sizeof *work->area);
    work->mass = mspringi_alloc(memory, vertices, sizeof *work->mass);
    if (work->first_of_vertex && work->sides && work->same && work->seen_from && work->seen_by && work->area &&
        work->mass)
        return MSPRING_OK;
    return mspringi_fail(&builder->message, MSPRING_ERROR_MEMORY, "no memory for a mesh of %zu triangles",
                         sides / 3);
}

static void release(mspring_builder *builder, mesh_work *work) {
    mspringi_memory *memory = &builder->memory;
    mspringi_free(memory, work->first_of_vertex);
    mspringi_free(memory, work->sides);
    mspringi_free(memory, work->same);
    mspringi_free(memory, work->seen_from);
    mspringi_free(memory, work->seen_by);
    mspringi_free(memory, work->area);
    mspringi_free(memory, work->mass);
}

/* ----------------------------------------------------------------------------------------------------- checks */

static mspring_result check_values(mspringi_message *message, const mspring_mesh_def *def,
                                   const mspring_material *material) {
    if (def->vertex_count > 0 && (!def->x || !def->y))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "mesh vertices are NULL");
    if (def->triangle_count > 0 && !def->triangles)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "mesh triangles are NULL");
    if (def->vertex_count > MSPRING_MAX_PARTICLES || def->triangle_count > MSPRING_MAX_SPRINGS)
        return mspringi_fail(message, MSPRING_ERROR_LIMIT,
                             "mesh of %u vertices and %u triangles is over the limit of %u and %u",
                             (unsigned)def->vertex_count, (unsigned)def->triangle_count,
                             (unsigned)MSPRING_MAX_PARTICLES, (unsigned)MSPRING_MAX_SPRINGS);
    if (def->area_density != 0.0f && !mspringi_in_range(def->area_density, 1e-30f, 1e30f))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "mesh has an area_density of %g kg/m^2, it must be 0 or 1e-30 to 1e30",
                             (double)def->area_density);
    if (!mspringi_in_range(def->young_modulus, 0.0f, 1e30f))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                             "mesh has a young_modulus of %g N/m, it must be 0 to 1e30",
                             (double)def->young_modulus);
    if (def->young_modulus > 0.0f &&
        (material->stiffness != 0.0f || material->spring_flags & MSPRING_SPRING_RELATIVE))
        return mspringi_fail(
            message, MSPRING_ERROR_ARGUMENT, "mesh has a young_modulus of %g N/m and %s: give one of them",
            (double)def->young_modulus, material->stiffness != 0.0f ? "a stiffness, too" : "relative springs");
    return mspringi_check_reserved(message, "mspring_mesh_def", def->reserved);
}

static mspring_result check_triangle(mspringi_message *message, const mspring_mesh_def *def, uint32_t triangle,
                                     double *area) {
    const uint32_t *corners = def->triangles + 3 * (size_t)triangle;
    for (int i = 0; i < 3; ++i)
        if (corners[i] >= def->vertex_count)
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                 "triangle %u has vertex %u, but there are only %u", (unsigned)triangle,
                                 (unsigned)corners[i], (unsigned)def->vertex_count);
    double dx[3], dy[3], longest = 0.0;
    for (int i = 0; i < 3; ++i) {
        const uint32_t from = corners[i], to = corners[(i + 1) % 3];
        dx[i] = def->x[to] - def->x[from];
        dy[i] = def->y[to] - def->y[from];
        longest = fmax(longest, dx[i] * dx[i] + dy[i] * dy[i]);
    }
    const double twice = fabs(dx[0] * dy[1] - dy[0] * dx[1]);
    *area = 0.5 * twice;
    if (twice > MIN_ASPECT_RATIO * longest)
        return MSPRING_OK;
    return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "triangle %u has no area: vertices %u, %u and %u lie %s",
                         (unsigned)triangle, (unsigned)corners[0], (unsigned)corners[1], (unsigned)corners[2],
                         longest > 0.0 ? "on a line" : "in one place");
}

static mspring_result check_vertices(mspringi_message *message, const mspring_mesh_def *def) {
    for (uint32_t v = 0; v < def->vertex_count; ++v)
        if (!mspringi_is_coordinate(def->x[v]) || !mspringi_is_coordinate(def->y[v]))
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                 "vertex %u: position (%g, %g) m is not within 1e12", (unsigned)v, def->x[v],
                                 def->y[v]);
    return MSPRING_OK;
}

// Distribute the triangles' masses to their corners, a third each. Without a density all weigh as the material
// says.
static mspring_result distribute_mass(mspringi_message *message, const mspring_mesh_def *def, float mass,
                                      const mesh_work *work) {
    const double density = def->area_density > 0.0f ? (double)def->area_density : 1.0;
    for (uint32_t t = 0; t < def->triangle_count; ++t) {
        double area;
        mspring_result result = check_triangle(message, def, t, &area);
        if (result != MSPRING_OK)
            return result;
        for (int i = 0; i < 3; ++i)
            work->mass[def->triangles[3 * (size_t)t + i]] += area * density / 3.0;
    }
    for (uint32_t v = 0; v < def->vertex_count; ++v) {
        if (!(work->mass[v] > 0.0))
            return mspringi_fail(message, MSPRING_ERROR_ARGUMENT,
                                 "vertex %u belongs to no triangle, so it has no mass", (unsigned)v);
        if (def->area_density == 0.0f)
            work->mass[v] = (double)mass;
        mspring_result result = mspringi_check_mass(message, "vertex", v, (float)work->mass[v]);
        if (result != MSPRING_OK)
            return result;
    }
    return MSPRING_OK;
}

/* ------------------------------------------------------------------------------------------------------ edges */

static void side_ends(const mspring_mesh_def *def, uint32_t side, uint32_t *low, uint32_t *high) {
    const uint32_t a = def->triangles[side], b = def->triangles[side % 3 == 2 ? side - 2 : side + 1];
    *low = a < b ? a : b;
    *high = a < b ? b : a;
}

// Find the first side of each edge. Return the number of edges.
static uint32_t find_edges(const mspring_mesh_def *def, const mesh_work *work) {
    const uint32_t sides = 3 * def->triangle_count;
    uint32_t low, high, edges = 0, *const first = work->first_of_vertex;
    for (uint32_t s = 0; s < sides; ++s) {
        side_ends(def, s, &low, &high);
        ++first[low];
    }
    for (uint32_t v = 0, sum = 0; v <= def->vertex_count; ++v) {
        sum += first[v];
        first[v] = sum; // end of its group
    }
    for (uint32_t s = sides; s-- > 0;) {
        side_ends(def, s, &low, &high);
        work->sides[--first[low]] = s;
    }
    for (uint32_t v = 0; v < def->vertex_count; ++v) {
        for (uint32_t i = first[v]; i < first[v + 1]; ++i) {
            const uint32_t s = work->sides[i];
            side_ends(def, s, &low, &high);
            const bool is_new = work->seen_from[high] != v + 1;
            if (is_new)
                work->seen_by[high] = s;
            work->seen_from[high] = v + 1;
            work->same[s] = work->seen_by[high];
            edges += is_new;
        }
    }
    return edges;
}

static void measure_areas(const mspring_mesh_def *def, const mesh_work *work) {
    mspringi_message unused;
    for (uint32_t t = 0; t < def->triangle_count; ++t) {
        double area = 0.0;
        (void)check_triangle(&unused, def, t, &area);
        for (uint32_t i = 0; i < 3; ++i)
            work->area[work->same[3 * t + i]] += area;
    }
}

static mspring_result append_edge(mspring_builder *builder, const mspring_mesh_def *def,
                                  const mspring_material *material, const mesh_work *work,
                                  mspring_id first_particle, uint32_t side) {
    uint32_t low, high;
    side_ends(def, side, &low, &high);
    const double dx = def->x[high] - def->x[low], dy = def->y[high] - def->y[low];
    const double square = dx * dx + dy * dy;
    const float rest_length = (float)sqrt(square);
    const float stiffness = def->young_modulus > 0.0f
                                ? (float)((double)def->young_modulus * work->area[side] / square)
                                : material->stiffness;
    if (!(rest_length > 0.0f && rest_length <= MSPRINGI_MAX_LENGTH) || !mspringi_in_range(stiffness, 0.0f, 1e30f))
        return mspringi_fail(
            &builder->message, MSPRING_ERROR_ARGUMENT,
            "edge of vertices %u and %u: length %g m must be > 0 and at most 4e12, stiffness %g N/m "
            "at most 1e30",
            (unsigned)low, (unsigned)high, (double)rest_length, (double)stiffness);
    const float mass_low = (float)work->mass[low], mass_high = (float)work->mass[high];
    builder->springs[builder->spring_count++] = (mspringi_spring){
        .a = first_particle + low,
        .b = first_particle + high,
        .stiffness = stiffness,
        .damping = mspringi_find_damping(stiffness, material->damping, material->spring_flags, mass_low, mass_high),
        .rest_length = rest_length,
        .flags = material->spring_flags & MSPRINGI_KEPT_SPRING_FLAGS};
    return MSPRING_OK;
}

static mspring_result append_mesh(mspring_builder *builder, const mspring_mesh_def *def,
                                  const mspring_material *material, const mesh_work *work) {
    const size_t particles = builder->particle_count, springs = builder->spring_count;
    const size_t edges = find_edges(def, work);
    mspring_result result = mspringi_builder_reserve_particles(builder, def->vertex_count);
    if (result == MSPRING_OK)
        result = mspringi_builder_reserve_springs(builder, edges);
    if (result == MSPRING_OK)
        result = mspringi_builder_reserve_limits(builder, edges, MSPRINGI_LIMITS_OF(material));
    if (result != MSPRING_OK)
        return result;
    measure_areas(def, work);
    for (uint32_t v = 0; v < def->vertex_count; ++v)
        builder->particles[builder->particle_count++] = (mspringi_particle){
            .x = def->x[v], .y = def->y[v], .mass = (float)work->mass[v], .flags = material->particle_flags};
    for (uint32_t side = 0; result == MSPRING_OK && side < 3 * def->triangle_count; ++side)
        if (work->same[side] == side)
            result = append_edge(builder, def, material, work, (mspring_id)particles, side);
    if (result != MSPRING_OK) {
        builder->particle_count = particles;
        mspringi_builder_cut_springs(builder, springs);
    } else {
        mspringi_builder_put_limits(builder, springs, MSPRINGI_LIMITS_OF(material));
    }
    return result;
}

mspring_result mspringi_builder_add_mesh(mspring_builder *builder, const mspring_mesh_def *def,
                                         const mspring_material *material) {
    mspringi_message *message = &builder->message;
    mesh_work work = {0};
    mspring_result result = check_values(message, def, material);
    if (result == MSPRING_OK)
        result = check_vertices(message, def);
    if (result == MSPRING_OK)
        result = allocate(builder, def->vertex_count, 3 * (size_t)def->triangle_count, &work);
    if (result == MSPRING_OK)
        result = distribute_mass(message, def, material->mass, &work);
    if (result == MSPRING_OK)
        result = append_mesh(builder, def, material, &work);
    release(builder, &work);
    return result;
}

static MSPRINGI_NOINLINE mspring_result add_mesh(mspring_builder *builder, const mspring_mesh_def *def) {
    mspring_mesh_def taken;
    mspring_material material;
    mspring_result result = mspringi_take_mesh_def(&builder->message, &def, &taken);
    if (result == MSPRING_OK)
        result = mspringi_take_own_material(&builder->message, "mesh", def->material, &material);
    return result == MSPRING_OK ? mspringi_builder_add_mesh(builder, def, &material) : result;
}

mspring_result mspring_builder_add_mesh(mspring_builder *builder, const mspring_mesh_def *def,
                                        mspring_id *first_particle, mspring_id *first_spring) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_message_clear(&builder->message);
    const mspring_id particle = (mspring_id)builder->particle_count, spring = (mspring_id)builder->spring_count;
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = mspringi_builder_end(builder, add_mesh(builder, def));
    mspringi_fp_leave(before);
    if (result == MSPRING_OK && first_particle)
        *first_particle = particle;
    if (result == MSPRING_OK && first_spring)
        *first_spring = spring;
    return result;
}

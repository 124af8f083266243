/// Disc: rings around a centre, in a mesh of triangles.
///
/// Ring i has 6 i particles. The disc is a hexagon of equilateral triangles, deformed so that its rings become
/// circles.
#include "builder/builder.h"

#include <math.h>

#include "base/cpu.h"

// Most rings: 1 + 3 n (n + 1) particles do not exceed MSPRING_MAX_PARTICLES.
#define MAX_RINGS 4729u

#define SECTORS 6u

static mspring_result check_disc(mspringi_message *message, const mspring_disc_def *def) {
    if (def->ring_count < 1 || def->ring_count > MAX_RINGS)
        return mspringi_fail(message, def->ring_count < 1 ? MSPRING_ERROR_ARGUMENT : MSPRING_ERROR_LIMIT,
                             "disc has %u rings, it must have 1 to %u", (unsigned)def->ring_count, MAX_RINGS);
    if (!(def->radius >= 1e-9 && def->radius <= 1e12))
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "disc has a radius of %g m, it must be 1e-9 to 1e12",
                             def->radius);
    if (def->centre_flags & ~(uint32_t)MSPRING_PARTICLE_PINNED)
        return mspringi_fail(message, MSPRING_ERROR_ARGUMENT, "disc has unknown centre_flags 0x%x",
                             (unsigned)def->centre_flags);
    return mspringi_check_reserved(message, "mspring_disc_def", def->reserved | (def->reserved_pointer != NULL));
}

// Vertex k of a ring, modulo the ring's size.
static uint32_t vertex_at(uint32_t ring, uint32_t k) {
    return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + k % (SECTORS * ring);
}

// Direction at a fraction of a sector (60 degrees), by Taylor series: equal bits on every machine.
static void direction_in_sector(double part, double *x, double *y) {
    const double angle = part * 1.0471975511965977, square = angle * angle;
    double cosine = 1.0, sine = 1.0;
    for (int n = 20; n > 0; n -= 2) {
        cosine = 1.0 - square / (double)(n * (n - 1)) * cosine;
        sine = 1.0 - square / (double)(n * (n + 1)) * sine;
    }
    *x = cosine;
    *y = angle * sine;
}

static void place_vertices(const mspring_disc_def *def, double *x, double *y) {
    static const double root = 0.8660254037844386; // sqrt(3/4)
    static const double turns[SECTORS][2] = {{1, 0},  {0.5, root},   {-0.5, root},
                                             {-1, 0}, {-0.5, -root}, {0.5, -root}};
    x[0] = def->x;
    y[0] = def->y;
    for (uint32_t ring = 1; ring <= def->ring_count; ++ring) {
        const double radius = def->radius * (double)ring / (double)def->ring_count;
        for (uint32_t k = 0; k < ring; ++k) {
            double dx, dy;
            direction_in_sector((double)k / (double)ring, &dx, &dy);
            for (uint32_t sector = 0; sector < SECTORS; ++sector) {
                const double *turn = turns[sector];
                const uint32_t vertex = vertex_at(ring, sector * ring + k);
                x[vertex] = def->x + radius * (turn[0] * dx - turn[1] * dy);
                y[vertex] = def->y + radius * (turn[1] * dx + turn[0] * dy);
            }
        }
    }
}

static void join_vertices(uint32_t rings, uint32_t *corner) {
    for (uint32_t ring = 1; ring <= rings; ++ring) {
        const uint32_t inner = ring - 1;
        for (uint32_t sector = 0; sector < SECTORS; ++sector) {
            for (uint32_t k = 0; k < ring; ++k) {
                *corner++ = vertex_at(ring, sector * ring + k);
                *corner++ = vertex_at(ring, sector * ring + k + 1);
                *corner++ = vertex_at(inner, sector * inner + k);
                if (k == inner)
                    continue;
                *corner++ = vertex_at(inner, sector * inner + k);
                *corner++ = vertex_at(ring, sector * ring + k + 1);
                *corner++ = vertex_at(inner, sector * inner + k + 1);
            }
        }
    }
}

static mspring_result fill_disc(mspring_builder *builder, const mspring_disc_def *def,
                                const mspring_material *material, double *places, uint32_t *corners) {
    const size_t centre = builder->particle_count;
    const uint32_t vertices = 1 + 3 * def->ring_count * (def->ring_count + 1);
    if (!places || !corners)
        return mspringi_fail(&builder->message, MSPRING_ERROR_MEMORY, "no memory for a disc of %u rings",
                             (unsigned)def->ring_count);
    place_vertices(def, places, places + vertices);
    join_vertices(def->ring_count, corners);
    const mspring_mesh_def mesh = {.vertex_count = vertices,
                                   .triangle_count = SECTORS * def->ring_count * def->ring_count,
                                   .x = places,
                                   .y = places + vertices,
                                   .triangles = corners,
                                   .area_density = def->area_density,
                                   .young_modulus = def->young_modulus};
    mspring_result result = mspringi_builder_add_mesh(builder, &mesh, material);
    if (result == MSPRING_OK)
        builder->particles[centre].flags |= def->centre_flags;
    if (result == MSPRING_OK || result == MSPRING_ERROR_MEMORY)
        return result;
    const mspringi_message reason = builder->message;
    return mspringi_fail(&builder->message, result, "disc of %u rings: %s", (unsigned)def->ring_count, reason.text);
}

static MSPRINGI_NOINLINE mspring_result add_disc(mspring_builder *builder, const mspring_disc_def *def) {
    mspring_disc_def taken;
    mspring_material material;
    mspring_result result = mspringi_take_disc_def(&builder->message, &def, &taken);
    if (result == MSPRING_OK)
        result = check_disc(&builder->message, def);
    if (result == MSPRING_OK)
        result = mspringi_take_own_material(&builder->message, "disc", def->material, &material);
    if (result != MSPRING_OK)
        return result;
    const size_t rings = def->ring_count;
    double *places = mspringi_alloc(&builder->memory, 2 * (1 + 3 * rings * (rings + 1)), sizeof *places);
    uint32_t *corners = mspringi_alloc(&builder->memory, 3 * SECTORS * rings * rings, sizeof *corners);
    result = fill_disc(builder, def, &material, places, corners);
    mspringi_free(&builder->memory, places);
    mspringi_free(&builder->memory, corners);
    return result;
}

mspring_result mspring_builder_add_disc(mspring_builder *builder, const mspring_disc_def *def,
                                        mspring_id *first_particle, mspring_id *first_spring) {
    if (!builder)
        return MSPRING_ERROR_ARGUMENT;
    mspringi_message_clear(&builder->message);
    const mspring_id particle = (mspring_id)builder->particle_count, spring = (mspring_id)builder->spring_count;
    const mspringi_fp_state before = mspringi_fp_enter();
    const mspring_result result = mspringi_builder_end(builder, add_disc(builder, def));
    mspringi_fp_leave(before);
    if (result == MSPRING_OK && first_particle)
        *first_particle = particle;
    if (result == MSPRING_OK && first_spring)
        *first_spring = spring;
    return result;
}

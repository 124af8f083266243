/// Areas and angle springs of the reference: the law of features/areas/areas.h and angles.h in double precision.
#include <math.h>

#include "analysis/tune/reference.h"
#include "base/shoelace.h"
#include "features/areas/areas.h"

typedef struct point {
    double x, y;
} point;

static uint32_t particle_of(const mspringi_reference *r, const mspringi_area *area, uint32_t corner) {
    return r->areas->corners[area->first + corner % area->count].particle;
}

// Vector from one corner to another.
static point vector_between(const mspringi_reference *r, const mspringi_area *area, uint32_t from, uint32_t to) {
    const uint32_t a = particle_of(r, area, from), b = particle_of(r, area, to);
    return (point){r->x[b] - r->x[a], r->y[b] - r->y[a]};
}

static double square_of(point p) {
    return p.x * p.x + p.y * p.y;
}

static double size_of(const mspringi_reference *r, const mspringi_area *area) {
    mspringi_shoelace polygon = {0};
    if (area->is_angle) {
        const point before = vector_between(r, area, 0, 1), next = vector_between(r, area, 1, 2);
        const double u[2] = {before.x, before.y}, w[2] = {next.x, next.y};
        return mspringi_angles->size_by(area, u, w);
    }
    for (uint32_t i = 1; i < area->count; ++i) {
        const point here = vector_between(r, area, 0, i);
        mspringi_shoelace_add(&polygon, here.x, here.y);
    }
    return 0.5 * polygon.twice;
}

// An arm rotated left by 90 degrees, divided by its squared length.
static point perpendicular(point arm) {
    const double square = square_of(arm);
    return square > 0.0 ? (point){-arm.y / square, arm.x / square} : (point){0.0, 0.0};
}

static point gradient_of(const mspringi_reference *r, const mspringi_area *area, uint32_t corner) {
    if (!area->is_angle) {
        const point across = vector_between(r, area, corner + area->count - 1, corner + 1);
        return (point){0.5 * across.y, -0.5 * across.x};
    }
    const point u = perpendicular(vector_between(r, area, 0, 1)), w = perpendicular(vector_between(r, area, 1, 2));
    return corner == 0 ? u : corner == 2 ? w : (point){-u.x - w.x, -u.y - w.y};
}

// Next closed area from *i on; NULL if there is none.
static const mspringi_area *next_area(const mspringi_reference *r, size_t *i) {
    const mspringi_areas *all = r->areas;
    while (all && *i < all->count && all->list[*i].is_open)
        ++*i;
    return all && *i < all->count ? &all->list[(*i)++] : NULL;
}

static void begin(mspringi_reference *r, mspring_network *network) {
    if (mspringi_area_count(network) == 0)
        return;
    mspringi_areas_refresh(network);
    r->areas = network->areas;
}

static void push(const mspringi_reference *r, const double *vx, const double *vy) {
    const mspringi_area *area;
    for (size_t at = 0; (area = next_area(r, &at)) != NULL;) {
        double rate = 0.0;
        for (uint32_t i = 0; area->damping > 0.0f && i < area->count; ++i) {
            const uint32_t p = particle_of(r, area, i);
            const point g = gradient_of(r, area, i);
            rate += g.x * vx[p] + g.y * vy[p];
        }
        const double pressure = mspringi_area_pressure(area, size_of(r, area)) - (double)area->damping * rate;
        for (uint32_t i = 0; i < area->count; ++i) {
            const uint32_t p = particle_of(r, area, i);
            const point g = gradient_of(r, area, i);
            r->ax[p] += r->inverse_mass[p] * pressure * g.x;
            r->ay[p] += r->inverse_mass[p] * pressure * g.y;
        }
    }
}

// In c g g', the row of a corner has blocks of size c |g| |g'|, times the roots of both inverse masses.
static void bound_sums(const mspringi_reference *r, double *stiffness, double *damping) {
    const mspringi_area *area;
    for (size_t at = 0; (area = next_area(r, &at)) != NULL;) {
        const mspringi_corner *corners = r->areas->corners + area->first;
        const double c = mspringi_area_stiffness(area, area->rest_area * (double)area->fill),
                     pressure = fabs(mspringi_area_pressure(area, area->rest_area));
        double all = 0.0;
        for (uint32_t i = 0; i < area->count; ++i)
            all += (double)corners[i].reach * sqrt(r->inverse_mass[corners[i].particle]);
        for (uint32_t i = 0; i < area->count; ++i) {
            const uint32_t p = corners[i].particle;
            const double weight = (double)corners[i].reach * sqrt(r->inverse_mass[p]) * all;
            stiffness[p] += (area->is_angle ? (double)area->stiffness : c) * weight +
                            (area->is_angle ? 0.0 : 2.0 * pressure * r->inverse_mass[p]);
            damping[p] += (double)area->damping * weight;
        }
    }
}

static double elastic_energy(const mspringi_reference *r) {
    const mspringi_area *area;
    double sum = 0.0;
    for (size_t at = 0; (area = next_area(r, &at)) != NULL;)
        sum += mspringi_area_energy(area, size_of(r, area));
    return sum;
}

const mspringi_reference_ops mspringi_reference_of_areas = {
    .begin = begin, .push = push, .bound = bound_sums, .energy = elastic_energy};

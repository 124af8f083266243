/// Areas in a problem of statics. Each side must be a spring.
///
/// An area adds stiffness along the springs of its outline, as in implicit substeps
/// (implicit_areas.c). That is an upper bound, so Newton's step still descends, and the matrix
/// keeps the pattern of the springs. Forces and energies are exact.
#include "features/areas/areas.h"

#include <math.h>

#include "analysis/settle/equilibrium.h"
#include "base/shoelace.h"
#include "store/springs.h"

// Settling of angles; NULL in a build without them.
#define ANGLE_STATICS(table) &table +
static const mspringi_angle_statics *const angles =
#include "store/features.def"
    0;

// Number the springs with stiffness.
static void number_springs(const mspring_network *network, uint32_t *numbers) {
    uint32_t count = 0;
    for (mspring_id spring = 0; spring < network->topology.spring_count; ++spring)
        numbers[spring] = mspringi_spring_get(network, spring).stiffness > 0.0f ? count++ : MSPRING_NONE;
}

static mspring_result find_sides(mspringi_statics *statics, mspring_network *network, const uint32_t *numbers) {
    const mspringi_areas *a = network->areas;
    for (size_t i = 0; i < a->count; ++i)
        if (a->list[i].is_angle && !a->list[i].is_open)
            angles->add(statics, a, &a->list[i]);
    for (size_t i = 0; i < a->count; ++i)
        for (size_t c = a->list[i].first;
             !a->list[i].is_open && !a->list[i].is_angle && c < a->list[i].first + a->list[i].count; ++c) {
            const mspring_id spring = a->corners[c].spring;
            statics->areas.sides[c] = spring == MSPRING_NONE ? MSPRING_NONE : numbers[spring];
            if (statics->areas.sides[c] == MSPRING_NONE)
                return mspringi_fail(&network->message, MSPRING_ERROR_ARGUMENT,
                                     "area %u has no spring on its side from particle %u on: an equilibrium needs "
                                     "springs on all sides",
                                     (unsigned)a->list[i].id, (unsigned)a->corners[c].particle);
        }
    return MSPRING_OK;
}

static uint32_t count_edges(const mspring_network *network) {
    return network->areas ? 3 * (uint32_t)network->areas->angle_count : 0;
}

static bool is_possible(const mspring_network *network) {
    return !network->areas || network->areas->unringed == 0;
}

static mspring_result add_areas(mspringi_statics *statics, mspring_network *network) {
    if (mspringi_area_count(network) == 0)
        return MSPRING_OK;
    mspringi_areas_refresh(network);
    uint32_t *numbers = mspringi_alloc(&network->memory, network->topology.spring_count, sizeof *numbers);
    statics->areas.sides =
        mspringi_alloc(&network->memory, network->areas->corner_count, sizeof *statics->areas.sides);
    mspring_result result = MSPRING_OK;
    if (!numbers || !statics->areas.sides) {
        result = mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to settle %zu areas",
                               network->areas->count);
    } else {
        number_springs(network, numbers);
        result = find_sides(statics, network, numbers);
    }
    mspringi_free(&network->memory, numbers);
    statics->areas.of = result == MSPRING_OK ? network->areas : NULL;
    return result;
}

/* ---------------------------------------------------------------------------------------------------- one area */

typedef struct point {
    double x, y;
} point;

static uint32_t particle_of(const mspringi_statics *statics, const mspringi_area *area, uint32_t corner) {
    return statics->areas.of->corners[area->first + corner % area->count].particle;
}

// Position relative to the first corner.
static point position_of(const mspringi_statics *s, const mspringi_area *area, uint32_t corner) {
    const uint32_t p = particle_of(s, area, corner), first = particle_of(s, area, 0);
    return (point){(s->start.x[p] - s->start.x[first]) + (s->moved.x[p] - s->moved.x[first]),
                   (s->start.y[p] - s->start.y[first]) + (s->moved.y[p] - s->moved.y[first])};
}

static double size_of(const mspringi_statics *s, const mspringi_area *area) {
    mspringi_shoelace polygon = {0};
    for (uint32_t i = 1; i < area->count; ++i) {
        const point here = position_of(s, area, i);
        mspringi_shoelace_add(&polygon, here.x, here.y);
    }
    return 0.5 * polygon.twice;
}

// Displacement on the path, relative to the first corner.
static point displacement_of(const mspringi_statics *s, const mspringi_area *area, uint32_t corner, double t) {
    const uint32_t p = particle_of(s, area, corner), first = particle_of(s, area, 0);
    return (point){t * ((s->step.x[p] - s->step.x[first]) + t * (s->curvature.x[p] - s->curvature.x[first])),
                   t * ((s->step.y[p] - s->step.y[first]) + t * (s->curvature.y[p] - s->curvature.y[first]))};
}

// Growth of an area on the path. A difference of areas would be lost in rounding.
static double growth_of(const mspringi_statics *s, const mspringi_area *area, double t) {
    double twice = 0.0;
    point before = position_of(s, area, 1), before_moved = displacement_of(s, area, 1, t);
    for (uint32_t i = 2; i < area->count; ++i) {
        const point here = position_of(s, area, i), here_moved = displacement_of(s, area, i, t);
        twice += (before.x * here_moved.y - before.y * here_moved.x) +
                 (before_moved.x * here.y - before_moved.y * here.x) +
                 (before_moved.x * here_moved.y - before_moved.y * here_moved.x);
        before = here;
        before_moved = here_moved;
    }
    return 0.5 * twice;
}

/* --------------------------------------------------------------------------------------------------- all areas */

// Next closed area from *i on; NULL if there is none.
static const mspringi_area *next_area(const mspringi_statics *statics, size_t *i) {
    const mspringi_areas *all = statics->areas.of;
    while (all && *i < all->count && all->list[*i].is_open)
        ++*i;
    return all && *i < all->count ? &all->list[(*i)++] : NULL;
}

static double add_forces(mspringi_statics *statics) {
    double largest = 0.0;
    const mspringi_area *area;
    for (size_t at = 0; (area = next_area(statics, &at)) != NULL;) {
        if (area->is_angle) {
            largest = fmax(largest, angles->forces(statics, area));
            continue;
        }
        const double half = 0.5 * mspringi_area_pressure(area, size_of(statics, area));
        for (uint32_t i = 0; i < area->count; ++i) {
            const point before = position_of(statics, area, i + area->count - 1),
                        after = position_of(statics, area, i + 1);
            const double x = half * (after.y - before.y), y = half * (before.x - after.x);
            const uint32_t p = particle_of(statics, area, i);
            statics->force.x[p] += x;
            statics->force.y[p] += y;
            largest = fmax(largest, fmax(fabs(x), fabs(y)));
        }
    }
    return largest;
}

static double energy_change(const mspringi_statics *statics, double t, double *size) {
    double change = 0.0;
    const mspringi_area *area;
    for (size_t at = 0; (area = next_area(statics, &at)) != NULL;) {
        if (area->is_angle) {
            change += angles->change(statics, area, t, size);
            continue;
        }
        const double energy =
            mspringi_area_energy_change(area, size_of(statics, area), growth_of(statics, area, t));
        change += energy;
        *size += fabs(energy);
    }
    return change;
}

// Vector from the centre of the corners to the midpoint of a side.
static point arm_of(const mspringi_statics *s, const mspringi_area *area, uint32_t side, point middle) {
    const point a = position_of(s, area, side), b = position_of(s, area, side + 1);
    return (point){0.5 * (a.x + b.x) - middle.x, 0.5 * (a.y + b.y) - middle.y};
}

static void stiffen(mspringi_statics *statics, const mspringi_area *area, uint32_t side, double stiffness) {
    const point from = position_of(statics, area, side), to = position_of(statics, area, side + 1);
    const double x = to.x - from.x, y = to.y - from.y, square = x * x + y * y;
    const uint32_t a = particle_of(statics, area, side), b = particle_of(statics, area, side + 1);
    const uint32_t spring = statics->areas.sides[area->first + side];
    if (!(square > 0.0))
        return;
    const double xx = stiffness * x * x / square, xy = stiffness * x * y / square, yy = stiffness * y * y / square;
    for (int end = 0; end < 2; ++end) {
        statics->xx[end ? b : a] += xx;
        statics->xy[end ? b : a] += xy;
        statics->yy[end ? b : a] += yy;
        statics->scale[end ? b : a] += 0.5 * stiffness;
    }
    statics->springs.xx[spring] -= xx;
    statics->springs.xy[spring] -= xy;
    statics->springs.yy[spring] -= yy;
}

static void add_stiffness(mspringi_statics *statics, bool clamped) {
    const mspringi_area *area;
    for (size_t at = 0; (area = next_area(statics, &at)) != NULL;) {
        if (area->is_angle) {
            angles->stiffness(statics, area, clamped);
            continue;
        }
        const double c = mspringi_area_stiffness(area, size_of(statics, area));
        point middle = {0.0, 0.0};
        double all = 0.0;
        for (uint32_t i = 1; i < area->count; ++i) {
            middle.x += position_of(statics, area, i).x / (double)area->count;
            middle.y += position_of(statics, area, i).y / (double)area->count;
        }
        for (uint32_t side = 0; side < area->count; ++side) {
            const point arm = arm_of(statics, area, side, middle);
            all += sqrt(arm.x * arm.x + arm.y * arm.y);
        }
        for (uint32_t side = 0; side < area->count; ++side) {
            const point arm = arm_of(statics, area, side, middle);
            stiffen(statics, area, side, c * all * sqrt(arm.x * arm.x + arm.y * arm.y));
        }
    }
}

const mspringi_statics_ops mspringi_statics_of_areas = {.count_edges = count_edges,
                                                        .is_possible = is_possible,
                                                        .add = add_areas,
                                                        .forces = add_forces,
                                                        .change = energy_change,
                                                        .stiffness = add_stiffness};

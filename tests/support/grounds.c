#include "grounds.h"

#include <math.h>
#include <string.h>

void grounds_step_by(mspring_network *network, const grounds_way *way) {
    mspring_settings def;
    check_ok(mspring_init(MSPRING_STRUCT_SETTINGS, &def, sizeof def));
    def.solver = way->solver;
    def.integrator = way->integrator;
    def.substeps = way->substeps;
    check_ok(support_set_solver(network, &def));
    check_ok(support_set_guard(network, support_guard_of(way->solver)));
}

mspring_floor_def grounds_def(void) {
    mspring_floor_def def;
    check_ok(mspring_init(MSPRING_STRUCT_FLOOR_DEF, &def, sizeof def));
    return def;
}

static const double level[4] = {0, 0, 0, 1};

mspring_floor_def grounds_level(float friction, float restitution) {
    mspring_floor_def def = grounds_def();
    def.planes = level;
    def.plane_count = 1;
    def.friction = friction;
    def.restitution = restitution;
    return def;
}

static double height_of(const mspring_floor_def *def, double x) {
    const double place = (x - def->heights_x) / def->spacing;
    if (place <= 0)
        return def->heights_y + (double)def->heights[0];
    if (place >= def->height_count - 1)
        return def->heights_y + (double)def->heights[def->height_count - 1];
    const uint32_t i = (uint32_t)place;
    const double share = place - i;
    return def->heights_y + (1 - share) * (double)def->heights[i] + share * (double)def->heights[i + 1];
}

/// How much a field rises in a metre at x.
static double slope_of(const mspring_floor_def *def, double x) {
    const double place = (x - def->heights_x) / def->spacing;
    if (!(place > 0 && place < def->height_count - 1))
        return 0;
    const uint32_t i = (uint32_t)place;
    return ((double)def->heights[i + 1] - (double)def->heights[i]) / def->spacing;
}

double grounds_above(const mspring_floor_def *def, double x, double y) {
    double least = INFINITY;
    for (uint32_t i = 0; i < def->plane_count; i++) {
        const double *plane = def->planes + 4 * i;
        const double length = sqrt(plane[2] * plane[2] + plane[3] * plane[3]);
        least = fmin(least, ((x - plane[0]) * plane[2] + (y - plane[1]) * plane[3]) / length);
    }
    if (def->height_count > 0)
        least = fmin(least, (y - height_of(def, x)) / hypot(1, slope_of(def, x)));
    return least;
}

uint32_t grounds_make(ground *to, double x, double y) {
    uint64_t seed = 5;
    memset(to, 0, 6 * sizeof *to);
    const char *names[] = {"level", "tilted", "box", "wedge", "hills", "cliffs"};
    for (uint32_t i = 0; i < 6; i++) {
        to[i].name = names[i];
        to[i].def = grounds_def();
        to[i].def.friction = 0.3f;
        to[i].def.restitution = 0.4f;
    }
    memcpy(to[0].planes, (double[]){x, y, 0, 1}, sizeof level);
    to[0].def.plane_count = 1;
    memcpy(to[1].planes, (double[]){x, y, -3, 4}, sizeof level);
    to[1].def.plane_count = 1;
    memcpy(to[2].planes, (double[]){x, y, 0, 2, x - 30, y, 5, 0, x + 30, y, -1, 0, x, y + 60, 0, -1},
           4 * sizeof level);
    to[2].def.plane_count = 4;
    memcpy(to[3].planes, (double[]){x, y, 9, 1, x, y, -9, 1}, 2 * sizeof level);
    to[3].def.plane_count = 2;
    for (uint32_t i = 0; i < GROUNDS_HEIGHTS; i++) {
        to[4].heights[i] = (float)support_random_between(&seed, -3, 0);
        to[5].heights[i] = i / 8 % 2 ? -20.0f : 0.0f;
    }
    for (uint32_t i = 4; i < 6; i++) {
        to[i].def.height_count = GROUNDS_HEIGHTS;
        to[i].def.heights_x = x - 40;
        to[i].def.heights_y = y;
        to[i].def.spacing = 1.25;
    }
    return 6;
}

/// Searches by position: the nearest particle or spring, those in a circle, particles in a box, springs across a
/// line. All visit ids in order and compare in double precision, with the low words of positions. A pass over all
/// is the bound of their time, however springs are joined.
#include <math.h>

#include "store/springs.h"

typedef struct point {
    double x, y;
} point;

/// List of found ids: it counts all, and stores up to its capacity.
typedef struct found {
    mspring_id *ids;
    double *fractions; ///< may be NULL
    uint32_t capacity, count;
} found;

static void add_found(found *to, mspring_id id, double fraction) {
    if (to->count < to->capacity) {
        to->ids[to->count] = id;
        if (to->fractions)
            to->fractions[to->count] = fraction;
    }
    ++to->count;
}

// Convert a world position to local coordinates, in which sums are as exact as positions.
static point local_point(const mspring_network *network, double x, double y) {
    return (point){x - network->origin_x, y - network->origin_y};
}

static point point_of(const mspring_network *network, uint32_t slot) {
    return (point){mspringi_x_of(&network->state, slot), mspringi_y_of(&network->state, slot)};
}

static bool is_coordinate(double x) {
    return fabs(x) <= MSPRING_MAX_COORDINATE; // false for NaN
}

static mspring_result check_point(const mspring_network *network, double x, double y) {
    return is_coordinate(x) && is_coordinate(y)
               ? MSPRING_OK
               : mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT,
                                      "the point (%g, %g) m is not within 1e12", x, y);
}

static mspring_result check_room(const mspring_network *network, const mspring_id *ids, uint32_t capacity,
                                 const uint32_t *count) {
    if (!network)
        return MSPRING_ERROR_ARGUMENT;
    return count && (ids || capacity == 0)
               ? MSPRING_OK
               : mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT, "the place for %s is NULL",
                                      count ? "the ids" : "their count");
}

static mspring_result check_within(const mspring_network *network, double within) {
    return within >= 0.0 ? MSPRING_OK
                         : mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT,
                                                "within is %g m, it must be at least 0", within);
}

static mspring_result check_radius(const mspring_network *network, double radius) {
    return radius >= 0.0 ? MSPRING_OK
                         : mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT,
                                                "the radius is %g m, it must be at least 0", radius);
}

mspring_result mspring_network_nearest_particle(const mspring_network *network, double x, double y, double within,
                                                mspring_id *particle, double *distance) {
    mspring_result result = check_room(network, particle, 1, &(uint32_t){0});
    if (result == MSPRING_OK)
        result = check_point(network, x, y);
    if (result == MSPRING_OK)
        result = check_within(network, within);
    if (result != MSPRING_OK)
        return result;
    const point centre = local_point(network, x, y);
    mspring_id nearest = MSPRING_NONE;
    double least = within * within;
    for (mspring_id p = 0; p < network->topology.particle_count; ++p) {
        const point at = point_of(network, network->topology.slot_of_particle[p]);
        const double dx = at.x - centre.x, dy = at.y - centre.y, square = dx * dx + dy * dy;
        if ((nearest == MSPRING_NONE ? square <= least : square < least) && mspringi_particle_exists(network, p)) {
            nearest = p;
            least = square;
        }
    }
    *particle = nearest;
    if (distance)
        *distance = nearest == MSPRING_NONE ? INFINITY : sqrt(least);
    return MSPRING_OK;
}

mspring_result mspring_network_particles_in_circle(const mspring_network *network, double x, double y,
                                                   double radius, mspring_id *particles, uint32_t capacity,
                                                   uint32_t *count) {
    mspring_result result = check_room(network, particles, capacity, count);
    if (result == MSPRING_OK)
        result = check_point(network, x, y);
    if (result == MSPRING_OK)
        result = check_radius(network, radius);
    if (result != MSPRING_OK)
        return result;
    const point centre = local_point(network, x, y);
    found to = {particles, NULL, capacity, 0};
    for (mspring_id p = 0; p < network->topology.particle_count; ++p) {
        const point at = point_of(network, network->topology.slot_of_particle[p]);
        const double dx = at.x - centre.x, dy = at.y - centre.y;
        if (dx * dx + dy * dy <= radius * radius && mspringi_particle_exists(network, p))
            add_found(&to, p, 0.0);
    }
    *count = to.count;
    return MSPRING_OK;
}

mspring_result mspring_network_particles_in_box(const mspring_network *network, double min_x, double min_y,
                                                double max_x, double max_y, mspring_id *particles,
                                                uint32_t capacity, uint32_t *count) {
    mspring_result result = check_room(network, particles, capacity, count);
    if (result == MSPRING_OK && !(min_x <= max_x && min_y <= max_y))
        result = mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT,
                                      "the box from (%g, %g) to (%g, %g) has a min above its max", min_x, min_y,
                                      max_x, max_y);
    if (result != MSPRING_OK)
        return result;
    const point low = local_point(network, min_x, min_y), high = local_point(network, max_x, max_y);
    found to = {particles, NULL, capacity, 0};
    for (mspring_id p = 0; p < network->topology.particle_count; ++p) {
        const point at = point_of(network, network->topology.slot_of_particle[p]);
        if (at.x >= low.x && at.x <= high.x && at.y >= low.y && at.y <= high.y &&
            mspringi_particle_exists(network, p))
            add_found(&to, p, 0.0);
    }
    *count = to.count;
    return MSPRING_OK;
}

// Twice the signed area of a triangle: positive if c is on the left of the line from a to b.
static double signed_area(point a, point b, point c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static bool overlap(double a, double b, double c, double d) {
    return fmax(fmin(a, b), fmin(c, d)) <= fmin(fmax(a, b), fmax(c, d));
}

// Fraction of the line from a to b at which c lies.
static double fraction_of(point a, point b, point c) {
    const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    return square > 0.0 ? fmin(fmax(((c.x - a.x) * dx + (c.y - a.y) * dy) / square, 0.0), 1.0) : 0.0;
}

// True if the line from a to b crosses the spring from c to d. fraction: position of the crossing on the line.
static bool is_across(point a, point b, point c, point d, double *fraction) {
    if (!overlap(a.x, b.x, c.x, d.x) || !overlap(a.y, b.y, c.y, d.y))
        return false;
    const double of_a = signed_area(c, d, a), of_b = signed_area(c, d, b), of_c = signed_area(a, b, c),
                 of_d = signed_area(a, b, d);
    if ((of_a > 0.0 && of_b > 0.0) || (of_a < 0.0 && of_b < 0.0) || (of_c > 0.0 && of_d > 0.0) ||
        (of_c < 0.0 && of_d < 0.0))
        return false;
    // Collinear: they meet at the nearer end, or at 0 if that is behind a.
    *fraction = of_a != of_b ? of_a / (of_a - of_b) : fmin(fraction_of(a, b, c), fraction_of(a, b, d));
    return true;
}

static mspring_result check_flags(const mspring_network *network, uint32_t flags) {
    return flags != 0 && !(flags & ~(uint32_t)(MSPRING_FIND_WHOLE | MSPRING_FIND_BROKEN))
               ? MSPRING_OK
               : mspringi_shared_fail(network->shared, MSPRING_ERROR_ARGUMENT,
                                      "flags are %#x, they must be MSPRING_FIND_WHOLE, _BROKEN or both",
                                      (unsigned)flags);
}

static bool is_wanted(const mspring_network *network, mspring_id spring, uint32_t flags) {
    return mspringi_spring_exists(network, spring) &&
           (flags & (mspringi_spring_is_live(network, spring) ? MSPRING_FIND_WHOLE : MSPRING_FIND_BROKEN));
}

mspring_result mspring_network_springs_across(const mspring_network *network, double from_x, double from_y,
                                              double to_x, double to_y, uint32_t flags, mspring_id *springs,
                                              double *fractions, uint32_t capacity, uint32_t *count) {
    mspring_result result = check_room(network, springs, capacity, count);
    if (result == MSPRING_OK)
        result = check_point(network, from_x, from_y);
    if (result == MSPRING_OK)
        result = check_point(network, to_x, to_y);
    if (result == MSPRING_OK)
        result = check_flags(network, flags);
    if (result != MSPRING_OK)
        return result;
    const point from = local_point(network, from_x, from_y), end = local_point(network, to_x, to_y);
    found to = {springs, fractions, capacity, 0};
    for (mspring_id i = 0; i < network->topology.spring_count; ++i) {
        if (!is_wanted(network, i, flags))
            continue;
        const mspringi_ends ends = mspringi_spring_ends(network, i);
        double fraction;
        if (is_across(from, end, point_of(network, ends.a), point_of(network, ends.b), &fraction))
            add_found(&to, i, fraction);
    }
    *count = to.count;
    return MSPRING_OK;
}

// Square of the distance from a point to a spring. fraction: position of the nearest place on it. Where that is an
// end, all springs at it have the same distance.
static double square_to_spring(const mspring_network *network, mspring_id spring, point at, double *fraction) {
    const mspringi_ends ends = mspringi_spring_ends(network, spring);
    const point a = point_of(network, ends.a), b = point_of(network, ends.b);
    const double t = *fraction = fraction_of(a, b, at);
    const double dx = t == 1.0 ? b.x - at.x : a.x - at.x + t * (b.x - a.x);
    const double dy = t == 1.0 ? b.y - at.y : a.y - at.y + t * (b.y - a.y);
    return dx * dx + dy * dy;
}

mspring_result mspring_network_nearest_spring(const mspring_network *network, double x, double y, double within,
                                              uint32_t flags, mspring_id *spring, double *fraction,
                                              double *distance) {
    mspring_result result = check_room(network, spring, 1, &(uint32_t){0});
    if (result == MSPRING_OK)
        result = check_point(network, x, y);
    if (result == MSPRING_OK)
        result = check_within(network, within);
    if (result == MSPRING_OK)
        result = check_flags(network, flags);
    if (result != MSPRING_OK)
        return result;
    const point centre = local_point(network, x, y);
    mspring_id nearest = MSPRING_NONE;
    double least = within * within, on_nearest = 0.0;
    for (mspring_id i = 0; i < network->topology.spring_count; ++i) {
        if (!is_wanted(network, i, flags))
            continue;
        double on;
        const double square = square_to_spring(network, i, centre, &on);
        if (nearest == MSPRING_NONE ? square <= least : square < least) {
            nearest = i;
            least = square;
            on_nearest = on;
        }
    }
    *spring = nearest;
    if (fraction)
        *fraction = on_nearest;
    if (distance)
        *distance = nearest == MSPRING_NONE ? INFINITY : sqrt(least);
    return MSPRING_OK;
}

mspring_result mspring_network_springs_in_circle(const mspring_network *network, double x, double y, double radius,
                                                 uint32_t flags, mspring_id *springs, uint32_t capacity,
                                                 uint32_t *count) {
    mspring_result result = check_room(network, springs, capacity, count);
    if (result == MSPRING_OK)
        result = check_point(network, x, y);
    if (result == MSPRING_OK)
        result = check_radius(network, radius);
    if (result == MSPRING_OK)
        result = check_flags(network, flags);
    if (result != MSPRING_OK)
        return result;
    const point centre = local_point(network, x, y);
    found to = {springs, NULL, capacity, 0};
    for (mspring_id i = 0; i < network->topology.spring_count; ++i) {
        double on;
        if (is_wanted(network, i, flags) && square_to_spring(network, i, centre, &on) <= radius * radius)
            add_found(&to, i, 0.0);
    }
    *count = to.count;
    return MSPRING_OK;
}

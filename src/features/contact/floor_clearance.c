/// Distance of the floor from each strip, for single substeps, or from the whole network, for a step in passes.
#include "features/contact/floor.h"

#include <math.h>

#include "store/sleepers.h"

/// A box in double precision.
typedef struct box {
    double min_x, max_x, min_y, max_y;
} box;

/// Bounding box and largest velocity of slots, by lane.
typedef struct extent {
    float min_x[MSPRINGI_WIDTH], max_x[MSPRINGI_WIDTH], min_y[MSPRINGI_WIDTH], max_y[MSPRINGI_WIDTH];
    float fast[MSPRINGI_WIDTH];
} extent;

static void begin_extent(extent *e) {
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
        e->min_x[lane] = e->min_y[lane] = INFINITY;
        e->max_x[lane] = e->max_y[lane] = -INFINITY;
        e->fast[lane] = 0.0f;
    }
}

// Widen it by slots; a pass over memory, so written for vectors.
static void extend(const mspring_network *network, size_t first, size_t end, extent *e) {
    const mspringi_state *s = &network->state;
    for (size_t slot = first; slot < end; slot += MSPRINGI_WIDTH)
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
            const float x = s->x[slot + lane], y = s->y[slot + lane];
            const float vx = fabsf(s->vx[slot + lane]), vy = fabsf(s->vy[slot + lane]);
            e->min_x[lane] = x < e->min_x[lane] ? x : e->min_x[lane];
            e->max_x[lane] = x > e->max_x[lane] ? x : e->max_x[lane];
            e->min_y[lane] = y < e->min_y[lane] ? y : e->min_y[lane];
            e->max_y[lane] = y > e->max_y[lane] ? y : e->max_y[lane];
            e->fast[lane] = vx > e->fast[lane] ? vx : e->fast[lane];
            e->fast[lane] = vy > e->fast[lane] ? vy : e->fast[lane];
        }
}

static box end_extent(const extent *e, float *fastest) {
    float min_x = INFINITY, max_x = -INFINITY, min_y = INFINITY, max_y = -INFINITY;
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
        min_x = e->min_x[lane] < min_x ? e->min_x[lane] : min_x;
        max_x = e->max_x[lane] > max_x ? e->max_x[lane] : max_x;
        min_y = e->min_y[lane] < min_y ? e->min_y[lane] : min_y;
        max_y = e->max_y[lane] > max_y ? e->max_y[lane] : max_y;
        *fastest = e->fast[lane] > *fastest ? e->fast[lane] : *fastest;
    }
    return (box){(double)min_x, (double)max_x, (double)min_y, (double)max_y};
}

static box cover(const mspring_network *network, size_t first, size_t end, float *fastest) {
    extent e;
    begin_extent(&e);
    extend(network, first, end, &e);
    return end_extent(&e, fastest);
}

static void extend_span(const mspring_network *network, const mspringi_span *span, extent *e) {
    const size_t first = span->first_slot / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
    const size_t end = (span->end_slot + MSPRINGI_WIDTH - 1) / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
    if (first < end)
        extend(network, first, end, e);
}

static box cover_strip(const mspring_network *network, const mspringi_strip *strip, float *fastest) {
    const mspringi_topology *t = &network->topology;
    const mspringi_row *first = &t->rows[strip->first_row], *last = first + strip->row_count - 1;
    extent e;
    begin_extent(&e);
    for (uint32_t i = first->first_span; i < last->first_span + last->span_count; ++i)
        extend_span(network, &t->spans[i], &e);
    if (strip->assigned_span != MSPRING_NONE)
        extend_span(network, &t->spans[strip->assigned_span], &e);
    return end_extent(&e, fastest);
}

// Cut a box down to a part that is clear of a line.
static void keep_clear_of(const mspringi_line *line, box *clear) {
    if (line->ny == 0.0) {
        const double x = -line->offset / line->nx;
        if (line->nx > 0.0)
            clear->min_x = fmax(clear->min_x, x);
        else
            clear->max_x = fmin(clear->max_x, x);
        return;
    }
    const double left = -(line->nx * clear->min_x + line->offset) / line->ny;
    const double right = -(line->nx * clear->max_x + line->offset) / line->ny;
    if (line->ny > 0.0)
        clear->min_y = fmax(clear->min_y, fmax(left, right));
    else
        clear->max_y = fmin(clear->max_y, fmin(left, right));
}

// Round a bound to single precision. Bounds far beyond all coordinates are clamped.
static float bound(double value) {
    return (float)fmax(-1e30, fmin(value, 1e30));
}

// Find the clear box around a strip: its bounding box widened by `reach`, m, cut down to be clear of the surface,
// less a margin for rounding.
static mspringi_clearance find_clearance(const mspringi_floor *floor, const box *strip, double reach) {
    box clear = {strip->min_x - reach, strip->max_x + reach, -INFINITY, INFINITY};
    for (uint32_t i = 0; i < floor->plane_count; ++i)
        keep_clear_of(&floor->lines[i], &clear);
    double bare = clear.min_y;
    if (floor->heights.count > 0) {
        const double highest = mspringi_heights_highest(&floor->heights, clear.min_x, clear.max_x);
        const double silt = mspringi_has_silt(&floor->heights) ? floor->heights.silt_depth : 0.0;
        bare = fmax(bare, highest);
        clear.min_y = fmax(clear.min_y, highest + silt);
    }
    const double size = fabs(clear.min_x) + fabs(clear.max_x) + fmax(fabs(strip->min_y), fabs(strip->max_y));
    const double margin = 4.0 * mspringi_floor_slop(size, reach);
    clear = (box){clear.min_x + margin, clear.max_x - margin, clear.min_y + margin, clear.max_y - margin};
    const bool is_empty = strip->min_x > strip->max_x; // spare slots alone
    const bool is_far =
        is_empty || (!floor->is_second_try && clear.min_x < strip->min_x - 0.5 * reach &&
                     clear.max_x > strip->max_x + 0.5 * reach && clear.min_y < strip->min_y - 0.5 * reach &&
                     clear.max_y > strip->max_y + 0.5 * reach);
    return (mspringi_clearance){{bound(clear.min_x), bound(clear.max_x), bound(clear.min_y), bound(clear.max_y)},
                                bound(bare + margin),
                                is_far};
}

// Largest acceleration by forces from outside, along x or y, m/s^2.
static double hardest_push(const mspring_network *network) {
    const mspringi_field *force = &network->forces.known;
    const float *inverse_mass = mspringi_active_inverse_mass(network);
    const size_t slots = (size_t)network->topology.block_count * MSPRINGI_WIDTH;
    float hardest[MSPRINGI_WIDTH] = {0.0f}, all = 0.0f;
    for (size_t slot = 0; force->x && slot < slots; slot += MSPRINGI_WIDTH)
        for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane) {
            const float x = fabsf(force->x[slot + lane]), y = fabsf(force->y[slot + lane]);
            const float push = (x > y ? x : y) * inverse_mass[slot + lane];
            hardest[lane] = push > hardest[lane] ? push : hardest[lane];
        }
    for (size_t lane = 0; lane < MSPRINGI_WIDTH; ++lane)
        all = hardest[lane] > all ? hardest[lane] : all;
    return (double)all;
}

// Twice the way of a particle by its speed, gravity and a push from outside, and what rounds first words, m. The
// first kick lasts half the lag, too.
static double reach_by(const mspring_network *network, float fastest, double outside, double seconds) {
    const double push =
        fabs((double)network->settings.gravity_x) + fabs((double)network->settings.gravity_y) + outside;
    return 2.0 * seconds * ((double)fastest + push * (seconds + (double)network->steps.lag)) +
           (double)network->state.grid;
}

// Reach of a survey, m: twice that of any particle. A strip is far if half of it is clear, so that particles may be
// twice as fast as assumed.
static double reach_of(const mspring_network *network, float fastest, double seconds) {
    return 2.0 * reach_by(network, fastest, hardest_push(network), seconds) + 1e-6;
}

/* ------------------------------------------------------------------------------------------------------ strips */

void mspringi_floor_update_clearances(mspring_network *network, double seconds) {
    const mspringi_topology *t = &network->topology;
    mspringi_floor *floor = network->floor;
    float fastest = 0.0f;
    mspringi_floor_set_origin(floor, network->origin_x, network->origin_y);
    for (uint32_t i = 0; i < t->strip_count; ++i) {
        if (mspringi_sleep_state_of_strip(network, &t->strips[i]) == MSPRINGI_ASLEEP)
            continue;
        const box all = cover_strip(network, &t->strips[i], &fastest);
        floor->clearances[i].clear =
            (mspringi_bounds){(float)all.min_x, (float)all.max_x, (float)all.min_y, (float)all.max_y};
    }
    const double reach = reach_of(network, fastest, seconds);
    floor->reach = reach;
    floor->seconds = seconds;
    floor->is_near = network->sleep.sleeping > 0; // these strips are left out
    for (uint32_t i = 0; i < t->strip_count; ++i) {
        if (mspringi_sleep_state_of_strip(network, &t->strips[i]) == MSPRINGI_ASLEEP)
            continue;
        const mspringi_bounds *b = &floor->clearances[i].clear;
        const box strip = {(double)b->min_x, (double)b->max_x, (double)b->min_y, (double)b->max_y};
        floor->clearances[i] = find_clearance(floor, &strip, reach);
        floor->is_near |= !floor->clearances[i].is_far;
        if (floor->heights.count > 0 && !floor->clearances[i].is_far)
            mspringi_floor_mark_blocks(network, &t->strips[i]);
    }
    floor->has_impulse |= floor->is_near;
}

// True if a particle within reach of its place may meet a surface.
static bool is_within_reach(const mspringi_floor *floor, double x, double y, double reach) {
    const mspringi_heights *h = &floor->heights;
    const double silt = mspringi_has_silt(h) ? h->silt_depth : 0.0;
    for (uint32_t i = 0; i < floor->plane_count; ++i)
        if (!(mspringi_distance_from_line(&floor->lines[i], x, y) >= reach))
            return true;
    return h->count > 0 && !(y - mspringi_heights_highest(h, x - reach, x + reach) >= reach + silt);
}

uint32_t mspringi_floor_near_lanes(const mspring_network *network, const mspringi_strip *strip, uint32_t block,
                                   const mspringi_sweep *sweep) {
    const mspringi_floor *floor = network->floor;
    const mspringi_state *s = &network->state;
    const size_t first = (size_t)block * MSPRINGI_WIDTH;
    const mspringi_bounds *all = &floor->clearances[strip - network->topology.strips].clear;
    const double way = 0.5 * floor->reach;
    const float *inverse_mass = mspringi_active_inverse_mass(network);
    // Usually the clear box of the whole strip is enough.
    const mspringi_bounds within = {bound((double)all->min_x + way), bound((double)all->max_x - way),
                                    bound((double)all->min_y + way), bound((double)all->max_y - way)};
    if (network->kernels->beyond(s->x, s->y, first, first + MSPRINGI_WIDTH, &within) != first)
        return 0;
    uint32_t lanes = 0;
    for (size_t slot = first; slot < first + MSPRINGI_WIDTH; ++slot) {
        const float fast = fmaxf(fabsf(s->vx[slot]), fabsf(s->vy[slot]));
        const float force = sweep->force_x ? fmaxf(fabsf(sweep->force_x[slot]), fabsf(sweep->force_y[slot])) : 0.0f;
        const double x = (double)s->x[slot], y = (double)s->y[slot];
        const double reach = reach_by(network, fast, (double)(force * inverse_mass[slot]), floor->seconds);
        if (inverse_mass[slot] > 0.0f && is_within_reach(floor, x, y, reach + mspringi_floor_slop(x, y)))
            lanes |= 1u << (slot - first);
    }
    return lanes;
}

/* ------------------------------------------------------------------------------------------- the whole network */

/// Largest reach of a search for the surface, m.
#define FARTHEST 1e9

// Find a safe box around the network: a quarter of the free distance on all sides. Its reach is 0 if the surface is
// nearer than twice `reach`.
static mspringi_safe_box find_box(const mspring_network *network, const mspringi_floor *floor, double reach) {
    float fastest = 0.0f;
    double free = 0.0;
    const box all = cover(network, 0, mspringi_used_slots(network), &fastest);
    for (double way = 2.0 * reach; way < FARTHEST && find_clearance(floor, &all, way).is_far; way *= 2.0)
        free = way;
    for (double more = 0.5 * free, least = 0.1 * free; more > least; more *= 0.5)
        free += find_clearance(floor, &all, free + more).is_far ? more : 0.0;
    const double quarter = 0.25 * free;
    const box around = {all.min_x - quarter, all.max_x + quarter, all.min_y - quarter, all.max_y + quarter};
    const double coordinate = fmin(fmin(-around.min_x, around.max_x), fmin(-around.min_y, around.max_y));
    return (mspringi_safe_box){
        .box = {bound(around.min_x), bound(around.max_x), bound(around.min_y), bound(around.max_y)},
        .coordinate = (float)coordinate,
        .reach = 0.5 * free,
        .origin_x = network->origin_x,
        .origin_y = network->origin_y};
}

// True if all particles are in the box. coordinate: bound on theirs.
static bool is_in_box(const mspring_network *network, const mspringi_safe_box *safe, float coordinate) {
    const mspringi_state *s = &network->state;
    const size_t slots = mspringi_used_slots(network);
    return coordinate < safe->coordinate || network->kernels->beyond(s->x, s->y, 0, slots, &safe->box) == slots;
}

// Upper bound of all velocity components, m/s; NaN if one is NaN.
static float fastest_of(const mspring_network *network) {
    const mspringi_guard *guard = &network->guard;
    const mspringi_largest_fn largest = network->kernels->largest;
    const size_t slots = mspringi_used_slots(network);
    if (guard->knows_speed)
        return guard->speed;
    const float vx = largest(network->state.vx, NULL, slots).value,
                vy = largest(network->state.vy, NULL, slots).value;
    return vx > vy || vx != vx ? vx : vy;
}

bool mspringi_safe_box_suffices(const mspring_network *network, const mspringi_floor *surfaces,
                                mspringi_safe_box *safe, double seconds) {
    const double reach = reach_of(network, fastest_of(network), seconds);
    const bool is_known =
        safe->reach >= reach && safe->origin_x == network->origin_x && safe->origin_y == network->origin_y;
    if (!is_known || !is_in_box(network, safe, network->guard.knows_speed ? network->guard.coordinate : INFINITY))
        *safe = find_box(network, surfaces, reach);
    return safe->reach >= reach;
}

bool mspringi_safe_box_sufficed(const mspring_network *network, const mspringi_safe_box *safe, double way,
                                mspringi_extrema seen) {
    return way <= 0.5 * safe->reach && is_in_box(network, safe, seen.coordinate);
}

bool mspringi_floor_is_out_of_reach(mspring_network *network, double seconds) {
    mspringi_floor *floor = network->floor;
    if (floor->is_near || network->sleep.sleeping > 0)
        return false;
    floor->seconds = seconds;
    mspringi_floor_set_origin(floor, network->origin_x, network->origin_y);
    return mspringi_safe_box_suffices(network, floor, &floor->safe, seconds);
}

bool mspringi_floor_was_out_of_reach(const mspring_network *network, float h, mspringi_extrema seen) {
    const mspringi_floor *floor = network->floor;
    const double way = fmax((double)h, floor->seconds) * (double)seen.speed;
    return mspringi_safe_box_sufficed(network, &floor->safe, way, seen);
}

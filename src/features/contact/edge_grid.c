/// Broad phase: outline edges in a hashed grid, and search around a point.
///
/// An edge lies in the cell of its midpoint. The cells of a grid row take consecutive buckets, from one that a hash
/// of the row gives. So distances between bodies do not matter, and a search reads a few runs of memory. Edges with
/// a larger reach, long or fast ones, lie in coarser levels of the grid. A search visits all levels near its point.
#include <math.h>
#include <string.h>

#include "base/assert.h"
#include "features/contact/contacts.h"

/// Largest reach in the finest level, in units of the harmonic mean of all reaches, which few large ones do not
/// raise; and that of a level in units of the next finer one's.
#define FINEST_REACH 2.0
#define LEVEL_RATIO 4.0

/// Cells in the reach of a search. More of them cover its circle better, and need more runs.
#define CELLS_IN_REACH 2.0

/// Rounding of the reach, as a share of it, and of a distance from an edge, as a share of the edge.
#define ROUNDING 1e-6
#define ROUNDING_ALONG 1e-12

/// Edges that a search skips in the time of a comparison.
#define PASSED_OF_WORK 4

/// Cells in each direction from the origin; the last one has everything beyond.
#define MOST_CELLS 1e8

/// Number that a search gives to a point whose own edges have a length: below the `below` of all edges with a
/// length (MSPRING_NONE), and of no edge of length 0.
#define ANY_POINT (MSPRING_NONE - 1)

static int32_t cell_of(double coordinate, double size) {
    const double cell = floor(coordinate / size);
    return cell > -MOST_CELLS && cell < MOST_CELLS ? (int32_t)cell
           : cell > 0.0                            ? (int32_t)MOST_CELLS
                                                   : -(int32_t)MOST_CELLS;
}

// Row of a level's cells, unlike those of all other levels.
static int32_t row_of(const mspringi_grid_level *level, uint32_t number, double y) {
    return cell_of(y, level->size) * MSPRINGI_GRID_LEVELS + (int32_t)number;
}

// Bucket of a cell.
static uint32_t bucket_of(const mspringi_edge_grid *grid, int32_t row, uint32_t column) {
    uint32_t hash = (uint32_t)row * 0x9E3779B1u;
    hash ^= hash >> 15;
    return (hash + column) & (grid->bucket_count - 1);
}

// Column of a node. Groups in the same place get different columns, unless there are colliders, which they share.
static uint32_t column_of(const mspring_network *network, const mspringi_contacts *contacts, mspring_id node,
                          double x, double size) {
    const uint32_t *group = network->groups.of_particle, column = (uint32_t)cell_of(x, size);
    const bool is_apart = group && contacts->colliders.count == 0;
    return is_apart ? column + group[node] * 0x9E3779B1u : column;
}

/* ----------------------------------------------------------------------------------------------------- filling */

// Length of an edge, m; of a collider's with its radius at both ends.
static double length_of(const mspringi_contacts *contacts, uint32_t edge) {
    const mspring_id a = contacts->outline.a[edge], b = contacts->outline.b[edge];
    const double ex = contacts->x[b] - contacts->x[a], ey = contacts->y[b] - contacts->y[a],
                 length = sqrt(ex * ex + ey * ey);
    return mspringi_is_collider_point(contacts, a) ? length + 2.0 * mspringi_collider_of(contacts, a)->radius
                                                   : length;
}

static double middle_of(const double *at, const mspringi_outline *o, uint32_t edge) {
    return 0.5 * (at[o->a[edge]] + at[o->b[edge]]);
}

static void add_to_level(mspringi_grid_level *level, double reach, double x, double y) {
    level->reach = reach > level->reach ? reach : level->reach;
    level->min_x = x < level->min_x ? x : level->min_x;
    level->max_x = x > level->max_x ? x : level->max_x;
    level->min_y = y < level->min_y ? y : level->min_y;
    level->max_y = y > level->max_y ? y : level->max_y;
    ++level->count;
}

// Choose the level of each edge by its reach, and the sizes of cells.
static void make_levels(mspringi_contacts *contacts) {
    mspringi_edge_grid *grid = &contacts->grid;
    const mspringi_outline *o = &contacts->outline;
    double inverse_sum = 0.0, margin_sum = 0.0;
    for (uint32_t e = 0; e < o->edge_count; ++e) {
        const double margin = mspringi_margin_of_edge(contacts, e);
        grid->edges[e].length = 0.5 * length_of(contacts, e) + margin; // its reach, until the edge gets its place
        inverse_sum += 1.0 / grid->edges[e].length;
        margin_sum += margin;
    }
    const double finest = FINEST_REACH * (double)o->edge_count / inverse_sum,
                 margin = margin_sum / (double)o->edge_count;
    for (uint32_t l = 0; l < MSPRINGI_GRID_LEVELS; ++l)
        grid->levels[l] =
            (mspringi_grid_level){.min_x = INFINITY, .max_x = -INFINITY, .min_y = INFINITY, .max_y = -INFINITY};
    for (uint32_t e = 0; e < o->edge_count; ++e) {
        const double reach = grid->edges[e].length;
        uint32_t l = 0;
        for (double most = finest; l + 1 < MSPRINGI_GRID_LEVELS && reach > most; most *= LEVEL_RATIO)
            ++l;
        grid->level_of[e] = (uint8_t)l;
        add_to_level(&grid->levels[l], reach, middle_of(contacts->x, o, e), middle_of(contacts->y, o, e));
    }
    for (uint32_t l = 0; l < MSPRINGI_GRID_LEVELS; ++l) {
        mspringi_grid_level *level = &grid->levels[l];
        const double of_point = margin < level->reach ? margin : level->reach;
        level->size = (level->reach + contacts->thickness + of_point) / CELLS_IN_REACH;
    }
}

// Write what a search reads of an edge.
static void place(mspringi_contacts *contacts, uint32_t edge, uint32_t at) {
    mspringi_edge_grid *grid = &contacts->grid;
    const mspringi_outline *o = &contacts->outline;
    const mspring_id a = o->a[edge], b = o->b[edge];
    const uint32_t level = grid->level_of[edge];
    const double ex = contacts->x[b] - contacts->x[a], ey = contacts->y[b] - contacts->y[a],
                 length = sqrt(ex * ex + ey * ey), part = length > 0.0 ? 1.0 / length : 0.0;
    const double margin = mspringi_margin_of_edge(contacts, edge),
                 radius = mspringi_is_collider_point(contacts, a) ? mspringi_collider_of(contacts, a)->radius : 0.0;
    grid->edges[at] =
        (mspringi_sought_edge){.x = contacts->x[a],
                               .y = contacts->y[a],
                               .along_x = part * ex,
                               .along_y = part * ey,
                               .length = length,
                               .slack = (margin + radius) * (1.0 + ROUNDING) + ROUNDING_ALONG * length,
                               .edge = edge,
                               .below = a == b ? a : MSPRING_NONE,
                               .row = row_of(&grid->levels[level], level, middle_of(contacts->y, o, edge))};
}

void mspringi_edge_grid_fill(const mspring_network *network, mspringi_contacts *contacts) {
    mspringi_edge_grid *grid = &contacts->grid;
    const mspringi_outline *o = &contacts->outline;
    make_levels(contacts);
    grid->bucket_count = 1;
    while (grid->bucket_count < 2 * o->edge_count && grid->bucket_count < grid->bucket_capacity)
        grid->bucket_count *= 2;
    memset(grid->first, 0, ((size_t)grid->bucket_count + 1) * sizeof *grid->first);
    for (uint32_t e = 0; e < o->edge_count; ++e) {
        const mspringi_grid_level *level = &grid->levels[grid->level_of[e]];
        const uint32_t column = column_of(network, contacts, o->a[e], middle_of(contacts->x, o, e), level->size);
        const int32_t row = row_of(level, grid->level_of[e], middle_of(contacts->y, o, e));
        grid->found[e] = bucket_of(grid, row, column);
        grid->first[grid->found[e]]++;
    }
    for (uint32_t i = 0; i < grid->bucket_count; ++i)
        grid->first[i + 1] += grid->first[i];
    MSPRINGI_ASSERT(grid->first[grid->bucket_count - 1] == o->edge_count);
    for (uint32_t e = o->edge_count; e-- > 0;)
        place(contacts, e, --grid->first[grid->found[e]]);
}

/* --------------------------------------------------------------------------------------------------- searching */

/// Arguments of a search.
typedef struct search {
    double x, y, reach;
    uint32_t point;
    bool is_wide;     ///< all rows count
    uint64_t *passed; ///< edges visited
} search;

// Collect the near edges of a run. Most are farther than their length, which takes the fewest operations to see.
static uint32_t sieve(const mspringi_edge_grid *grid, const search *s, int32_t row, uint32_t from, uint32_t to,
                      uint32_t count) {
    *s->passed += to - from;
    for (uint32_t k = from; k < to; ++k) {
        const mspringi_sought_edge *e = &grid->edges[k];
        const double dx = s->x - e->x, dy = s->y - e->y, reach = s->reach + e->slack, most = reach + e->length;
        if (dx * dx + dy * dy > most * most)
            continue;
        const double along = dx * e->along_x + dy * e->along_y, ahead = 0.5 * (along + fabs(along)),
                     nearest = ahead < e->length ? ahead : e->length;
        const double rx = dx - nearest * e->along_x, ry = dy - nearest * e->along_y;
        grid->found[count] = e->edge;
        count += (rx * rx + ry * ry <= reach * reach) & (s->point < e->below) & ((e->row == row) | s->is_wide);
    }
    return count;
}

static uint32_t sieve_row(const mspringi_edge_grid *grid, const search *s, int32_t row, uint32_t column,
                          uint32_t columns, uint32_t count) {
    for (uint32_t done = 0, part; done < columns; done += part) {
        const uint32_t bucket = bucket_of(grid, row, column + done), until_end = grid->bucket_count - bucket;
        part = columns - done < until_end ? columns - done : until_end;
        count = sieve(grid, s, row, grid->first[bucket], grid->first[bucket + part], count);
    }
    return count;
}

// Grid rows and columns of a level within reach of a point.
typedef struct grid_range {
    int32_t row, last_row;
    uint32_t columns;
    bool is_empty; ///< no edge of the level is near
} grid_range;

static grid_range range_of(const mspringi_grid_level *level, const search *s, double reach) {
    return (grid_range){
        .row = cell_of(s->y - reach, level->size),
        .last_row = cell_of(s->y + reach, level->size),
        .columns = (uint32_t)cell_of(s->x + reach, level->size) - (uint32_t)cell_of(s->x - reach, level->size) + 1,
        .is_empty = level->count == 0 || s->x + reach < level->min_x || s->x - reach > level->max_x ||
                    s->y + reach < level->min_y || s->y - reach > level->max_y};
}

uint32_t mspringi_edge_grid_search(const mspring_network *network, mspringi_contacts *contacts, mspring_id p) {
    const mspringi_edge_grid *grid = &contacts->grid;
    const mspringi_outline *o = &contacts->outline;
    const uint32_t own = o->first[p];
    const double radius = mspringi_is_collider_point(contacts, p) ? mspringi_collider_of(contacts, p)->radius : 0.0;
    uint64_t passed = 0;
    // Two particles without springs are one pair, and such a particle pairs with a corner by the corner's edges.
    // Inner particles have no edge.
    const bool has_point_edge = own == o->first[p + 1] || o->a[o->at[own]] == o->b[o->at[own]];
    search s = {.x = contacts->x[p] - contacts->inner.way_x,
                .y = contacts->y[p] - contacts->inner.way_y,
                .reach = (contacts->thickness + contacts->margin[p] + radius) * (1.0 + ROUNDING),
                .point = has_point_edge ? p : ANY_POINT,
                .passed = &passed};
    uint32_t count = 0;
    for (uint32_t l = 0; l < MSPRINGI_GRID_LEVELS && !s.is_wide; ++l) {
        const mspringi_grid_level *level = &grid->levels[l];
        const double reach = s.reach + level->reach * (1.0 + ROUNDING);
        const grid_range range = range_of(level, &s, reach);
        if (range.is_empty)
            continue;
        s.is_wide = !(((double)range.last_row - range.row + 1.0) * range.columns < (double)o->edge_count);
        const uint32_t column = column_of(network, contacts, p, s.x - reach, level->size);
        for (int32_t j = range.row; j <= range.last_row && !s.is_wide; ++j)
            count = sieve_row(grid, &s, j * MSPRINGI_GRID_LEVELS + (int32_t)l, column, range.columns, count);
    }
    if (s.is_wide) // more cells than edges: look at all edges instead
        count = sieve(grid, &s, 0, 0, o->edge_count, 0);
    contacts->work += passed / PASSED_OF_WORK;
    return count;
}

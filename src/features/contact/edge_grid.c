/// Broad phase: outline edges in a hashed grid, and search around a point.
///
/// An edge lies in the cell of its midpoint. The cells of a grid row take consecutive buckets, from one that a hash
/// of the row gives. So distances between bodies do not matter, and a search reads a few runs of memory. Much
/// longer edges than the mean lie in no cell.
#include <math.h>
#include <string.h>

#include "features/contact/contacts.h"

/// An edge this many times as long as the mean is a long one.
#define LONG_EDGE 4.0

/// Cells in the reach of a search. More of them cover its circle better, and need more runs.
#define CELLS_IN_REACH 2.0

/// Rounding of the reach, as a share of it, and of a distance from an edge, as a share of the edge.
#define ROUNDING 1e-6
#define ROUNDING_ALONG 1e-12

/// Edges that a search skips in the time of a comparison.
#define PASSED_OF_WORK 4

/// Cells in each direction from the origin; the last one has everything beyond.
#define MOST_CELLS 1e9

/// A point that has springs, or is a corner of a collider, is below all limits but that of edges with a length.
#define ANY_POINT (MSPRING_NONE - 1)

static int32_t cell_of(double coordinate, double size) {
    const double cell = floor(coordinate / size);
    return cell > -MOST_CELLS && cell < MOST_CELLS ? (int32_t)cell
           : cell > 0.0                            ? (int32_t)MOST_CELLS
                                                   : -(int32_t)MOST_CELLS;
}

// Bucket of a cell.
static uint32_t bucket_of(const mspringi_edge_grid *cells, int32_t row, uint32_t column) {
    uint32_t hash = (uint32_t)row * 0x9E3779B1u;
    hash ^= hash >> 15;
    return (hash + column) & (cells->bucket_count - 1);
}

// Column of a node. Groups in the same place get different columns, unless there are colliders, which they share.
static uint32_t column_of(const mspring_network *network, const mspringi_contacts *contacts, mspring_id node,
                          double x) {
    const uint32_t *group = network->groups.of_particle, column = (uint32_t)cell_of(x, contacts->cells.size);
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

// List the long edges, and choose the size of cells for the others.
static void size_cells(mspringi_contacts *contacts, double reach) {
    mspringi_edge_grid *cells = &contacts->cells;
    double sum = 0.0, longest = 0.0;
    for (uint32_t e = 0; e < contacts->outline.edge_count; ++e)
        sum += cells->edges[e].length = length_of(contacts, e); // until the edge gets its place
    const double most = LONG_EDGE * (sum / (double)contacts->outline.edge_count + reach);
    cells->long_count = 0;
    for (uint32_t e = 0; e < contacts->outline.edge_count; ++e) {
        const double length = cells->edges[e].length;
        if (!(length <= most))
            cells->long_edges[cells->long_count++] = e;
        else
            longest = length > longest ? length : longest;
    }
    cells->reach = (0.5 * longest + reach) * (1.0 + ROUNDING);
    cells->size = cells->reach / CELLS_IN_REACH;
}

static double middle_of(const double *at, const mspringi_outline *o, uint32_t edge) {
    return 0.5 * (at[o->a[edge]] + at[o->b[edge]]);
}

// Write what a search reads of an edge.
static void place(mspringi_contacts *contacts, uint32_t edge, uint32_t at) {
    mspringi_edge_grid *cells = &contacts->cells;
    const mspringi_outline *o = &contacts->outline;
    const mspring_id a = o->a[edge], b = o->b[edge];
    const double ex = contacts->x[b] - contacts->x[a], ey = contacts->y[b] - contacts->y[a],
                 length = sqrt(ex * ex + ey * ey), part = length > 0.0 ? 1.0 / length : 0.0;
    cells->edges[at] = (mspringi_sought_edge){.x = contacts->x[a],
                                              .y = contacts->y[a],
                                              .along_x = part * ex,
                                              .along_y = part * ey,
                                              .length = length,
                                              .slack = ROUNDING_ALONG * length,
                                              .edge = edge,
                                              .below = a == b ? a : MSPRING_NONE,
                                              .row = cell_of(middle_of(contacts->y, o, edge), cells->size)};
    if (mspringi_is_collider_point(contacts, a))
        cells->edges[at].slack += mspringi_collider_of(contacts, a)->radius;
}

void mspringi_edge_grid_fill(const mspring_network *network, mspringi_contacts *contacts, double reach) {
    mspringi_edge_grid *cells = &contacts->cells;
    const mspringi_outline *o = &contacts->outline;
    size_cells(contacts, reach);
    cells->bucket_count = 1;
    while (cells->bucket_count < 2 * o->edge_count && cells->bucket_count < cells->bucket_capacity)
        cells->bucket_count *= 2;
    memset(cells->first, 0, ((size_t)cells->bucket_count + 1) * sizeof *cells->first);
    for (uint32_t e = 0, l = 0; e < o->edge_count; ++e) {
        if (l < cells->long_count && cells->long_edges[l] == e) {
            ++l;
            continue;
        }
        const uint32_t column = column_of(network, contacts, o->a[e], middle_of(contacts->x, o, e));
        cells->found[e] = bucket_of(cells, cell_of(middle_of(contacts->y, o, e), cells->size), column);
        cells->first[cells->found[e]]++;
    }
    for (uint32_t i = 0; i < cells->bucket_count; ++i)
        cells->first[i + 1] += cells->first[i];
    for (uint32_t e = o->edge_count, l = cells->long_count; e-- > 0;) {
        if (l > 0 && cells->long_edges[l - 1] == e)
            place(contacts, e, cells->first[cells->bucket_count] + --l);
        else
            place(contacts, e, --cells->first[cells->found[e]]);
    }
}

/* --------------------------------------------------------------------------------------------------- searching */

/// Arguments of a search.
typedef struct search {
    double x, y, reach;
    uint32_t point;
    bool is_wide;     ///< all rows count
    uint64_t *passed; ///< edges visited
} search;

// Collect the near edges of a run. Branch-free, in a few nanoseconds each, since many are not near.
static uint32_t sieve(const mspringi_edge_grid *cells, const search *s, int32_t row, uint32_t from, uint32_t to,
                      uint32_t count) {
    *s->passed += to - from;
    for (uint32_t k = from; k < to; ++k) {
        const mspringi_sought_edge *e = &cells->edges[k];
        const double dx = s->x - e->x, dy = s->y - e->y, along = dx * e->along_x + dy * e->along_y;
        const double ahead = 0.5 * (along + fabs(along)), nearest = ahead < e->length ? ahead : e->length;
        const double rx = dx - nearest * e->along_x, ry = dy - nearest * e->along_y, reach = s->reach + e->slack;
        cells->found[count] = e->edge;
        count += (rx * rx + ry * ry <= reach * reach) & (s->point < e->below) & ((e->row == row) | s->is_wide);
    }
    return count;
}

static uint32_t sieve_row(const mspringi_edge_grid *cells, const search *s, int32_t row, uint32_t column,
                          uint32_t columns, uint32_t count) {
    for (uint32_t done = 0, part; done < columns; done += part) {
        const uint32_t bucket = bucket_of(cells, row, column + done), until_end = cells->bucket_count - bucket;
        part = columns - done < until_end ? columns - done : until_end;
        count = sieve(cells, s, row, cells->first[bucket], cells->first[bucket + part], count);
    }
    return count;
}

uint32_t mspringi_edge_grid_search(const mspring_network *network, mspringi_contacts *contacts, mspring_id p) {
    const mspringi_edge_grid *cells = &contacts->cells;
    const mspringi_outline *o = &contacts->outline;
    const uint32_t own = o->at[o->first[p]];
    const double radius = mspringi_is_collider_point(contacts, p) ? mspringi_collider_of(contacts, p)->radius : 0.0;
    const double x = contacts->x[p], y = contacts->y[p], reach = cells->reach + radius, size = cells->size;
    const int32_t row = cell_of(y - reach, size), last_row = cell_of(y + reach, size);
    const uint32_t columns = (uint32_t)cell_of(x + reach, size) - (uint32_t)cell_of(x - reach, size) + 1;
    uint64_t passed = 0;
    const bool is_wide = !(((double)last_row - row + 1.0) * columns < (double)o->edge_count);
    // Two particles without springs are one pair, and such a particle pairs with a corner by the corner's edges.
    search s = {.x = x,
                .y = y,
                .reach = (contacts->reach + radius) * (1.0 + ROUNDING),
                .point = o->a[own] == o->b[own] ? p : ANY_POINT,
                .passed = &passed};
    const uint32_t column = column_of(network, contacts, p, x - reach);
    uint32_t count = 0;
    for (int32_t j = row; j <= last_row && !is_wide; ++j)
        count = sieve_row(cells, &s, j, column, columns, count);
    s.is_wide = true;
    count = sieve(cells, &s, row, is_wide ? 0 : cells->first[cells->bucket_count], o->edge_count, count);
    contacts->work += passed / PASSED_OF_WORK;
    return count;
}

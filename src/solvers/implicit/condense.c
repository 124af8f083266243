/// Paths out of the linear system of a solution, and their displacements back.
///
/// A particle of a segment has no mass, no factors and no residual while the system is iterated. So its row of A is
/// empty, and its tile has none of it. Constraints that hold it alone, as the floor or a grip, are in its pivot.
#include "solvers/implicit/paths.h"

#include <math.h>
#include <string.h>

#include "solvers/implicit/implicit.h"
#include "solvers/implicit/implicit_terms.h"
#include "store/springs.h"

/// Bits of a node's marks: something joins it to other particles; it is in a segment.
#define JOINED 1u
#define CONDENSED 2u

static mspringi_path_segment *segments_of(const mspringi_paths *p, const mspringi_path *path) {
    return p->segments + path->first / MSPRINGI_LEAST_PATH;
}

/* ---------------------------------------------------------------------------------------------------- dividing */

static void mark_joined(const mspringi_paths *p, uint32_t slot) {
    if (p->node_of_slot[slot] != MSPRING_NONE)
        p->marks[p->node_of_slot[slot]] |= JOINED;
}

// Mark what added springs and constraints of several particles join to others; add up constraints of one.
static void mark_nodes(const mspring_network *network, mspringi_paths *p) {
    const mspringi_topology *t = &network->topology;
    const mspringi_constraints *all = &network->constraints;
    if (p->has_marks) {
        memset(p->marks, 0, p->node_count * sizeof *p->marks);
        memset(p->held, 0, p->node_count * sizeof *p->held);
    }
    p->has_marks = t->irregular_count > t->laid_out_count || all->active_count > 0;
    for (uint32_t i = t->laid_out_count; i < t->irregular_count; ++i) {
        if (!mspringi_spring_slot_is_live(network, t->row_spring_slots + i))
            continue;
        mark_joined(p, t->irregular_a[i]);
        mark_joined(p, t->irregular_b[i]);
    }
    for (uint32_t i = 0; i < all->active_count; ++i) {
        const mspringi_active_constraint *a = &all->active[i];
        const mspringi_jacobian_entry *e = all->entries + a->first;
        const uint32_t count = a->shape >> 1, node = p->node_of_slot[e->slot];
        for (uint32_t k = 0; k < count && count > 1; ++k)
            mark_joined(p, e[k].slot);
        if (count > 1 || node == MSPRING_NONE)
            continue;
        p->held[node][0] += a->stiffness * e->x * e->x;
        p->held[node][1] += a->stiffness * e->x * e->y;
        p->held[node][2] += a->stiffness * e->y * e->y;
    }
}

// Displacement of a path's end by the rotation of its tile.
static void turned_end(const mspringi_prediction *prediction, uint32_t slot, double turned[2]) {
    turned[0] = slot != MSPRING_NONE ? (double)prediction->turned_x[slot] : 0.0;
    turned[1] = slot != MSPRING_NONE ? (double)prediction->turned_y[slot] : 0.0;
}

static void turn_node(const mspringi_prediction *prediction, uint32_t slot, float x, float y) {
    prediction->arm_x[slot] += x - prediction->turned_x[slot];
    prediction->arm_y[slot] += y - prediction->turned_y[slot];
    prediction->turned_x[slot] = x;
    prediction->turned_y[slot] = y;
}

// Between the ends' turns, in equal steps. A loose end goes along with the other one. Particles that do not move
// are ends, too.
static void turn_path(const mspringi_paths *p, const mspringi_prediction *prediction, const mspringi_path *path) {
    const float *weight = prediction->inverse_mass;
    for (uint32_t first = path->first, end; first < path->end; first = end + 1) {
        for (end = first; end < path->end && weight[p->slots[end]] > 0.0f;)
            ++end;
        const uint32_t before = first == path->first ? path->ends[0] : p->slots[first - 1];
        const uint32_t behind = end == path->end ? path->ends[1] : p->slots[end];
        double from[2], to[2];
        if (end < path->end)
            turn_node(prediction, p->slots[end], 0.0f, 0.0f);
        turned_end(prediction, before != MSPRING_NONE ? before : behind, from);
        turned_end(prediction, behind != MSPRING_NONE ? behind : before, to);
        for (uint32_t i = first; i < end; ++i) {
            const double share = (double)(i - first + 1) / (double)(end - first + 1);
            turn_node(prediction, p->slots[i], (float)(from[0] + share * (to[0] - from[0])),
                      (float)(from[1] + share * (to[1] - from[1])));
        }
    }
}

void mspringi_condense_turn(const mspring_network *network, const mspringi_prediction *prediction,
                            mspringi_team_member *member) {
    const mspringi_paths *p = &mspringi_implicit_of(network)->paths;
    if (p->count == 0)
        return;
    mspringi_team_barrier(member);
    const size_t end = mspringi_range_end(member, p->count);
    for (size_t i = mspringi_range_begin(member, p->count); i < end; ++i)
        turn_path(p, prediction, &p->list[i]);
    mspringi_team_barrier(member);
}

static uint32_t moving_end(const mspringi_implicit *n, uint32_t slot) {
    return slot != MSPRING_NONE && n->mass[slot] > 0.0f ? slot : MSPRING_NONE;
}

// Divide a path into segments.
static void divide_path(const mspringi_implicit *n, const mspringi_paths *p, mspringi_path *path) {
    path->segment_count = 0;
    for (uint32_t i = path->first, end; i < path->end; i = end + (end == i)) {
        for (end = i; end < path->end && n->mass[p->slots[end]] > 0.0f && !(p->marks[end] & JOINED);)
            ++end;
        if (end - i < MSPRINGI_LEAST_PATH)
            continue;
        segments_of(p, path)[path->segment_count++] = (mspringi_path_segment){
            .first = i,
            .end = end,
            .ends = {moving_end(n, i == path->first ? path->ends[0] : p->slots[i - 1]),
                     moving_end(n, end == path->end ? path->ends[1] : p->slots[end])},
        };
    }
}

/* ------------------------------------------------------------------------------------------------- eliminating */

/// A symmetric block.
typedef struct path_block {
    double xx, xy, yy;
} path_block;

static path_block block_of_spring(const mspringi_implicit *n, uint32_t factors) {
    if (factors == MSPRING_NONE)
        return (path_block){0.0, 0.0, 0.0};
    const float *f = n->factors + factors;
    const double x = (double)f[MSPRINGI_PULL_X * MSPRINGI_WIDTH], y = (double)f[MSPRINGI_PULL_Y * MSPRINGI_WIDTH];
    const double geometric = (double)f[MSPRINGI_GEOMETRIC * MSPRINGI_WIDTH];
    return (path_block){geometric + x * x, x * y, geometric + y * y};
}

static void clear_factors(const mspringi_implicit *n, uint32_t factors) {
    for (uint32_t i = 0; i < MSPRINGI_FACTORS && factors != MSPRING_NONE; ++i)
        n->factors[factors + i * MSPRINGI_WIDTH] = 0.0f;
}

// Add block times a column of from to one of to.
static void add_columns(path_block block, const mspringi_path_response *from, mspringi_path_response *to) {
    for (int i = 0; i < 5; ++i) {
        to->x[i] += block.xx * from->x[i] + block.xy * from->y[i];
        to->y[i] += block.xy * from->x[i] + block.yy * from->y[i];
    }
}

// Pivot of a node between the springs before and behind it: P_j = D_j - K_j P_(j-1)^-1 K_j, K_j being the block of
// the spring before. D_j is summed in double precision from mass and factors, since the diagonal in single
// precision has lost the mass of a stiff one.
static path_block pivot_of(const mspringi_paths *p, uint32_t node, double mass, path_block before,
                           path_block behind, const double *up) {
    const double *held = p->held[node];
    path_block pivot = {mass + before.xx + behind.xx + held[0], before.xy + behind.xy + held[1],
                        mass + before.yy + behind.yy + held[2]};
    if (!up)
        return pivot;
    pivot.xx -= before.xx * up[0] + before.xy * up[2];
    pivot.xy -= before.xx * up[1] + before.xy * up[3];
    pivot.yy -= before.xy * up[1] + before.yy * up[3];
    return pivot;
}

/// Factor L D L^T of a pivot, which begins with its larger diagonal entry: of y if it is turned.
typedef struct path_factor {
    double ratio, first, second; ///< L, and the reciprocals of D
    bool is_turned;
} path_factor;

// The rest of the second diagonal entry is at least the mass, whatever rounding says.
static path_factor factor_of(path_block pivot, double mass) {
    const bool is_turned = pivot.yy > pivot.xx;
    const double larger = is_turned ? pivot.yy : pivot.xx, smaller = is_turned ? pivot.xx : pivot.yy;
    const double ratio = pivot.xy / larger, left = smaller - ratio * pivot.xy;
    return (path_factor){ratio, 1.0 / larger, 1.0 / (left > mass ? left : mass), is_turned};
}

// Divide a vector by a pivot. Its inverse would be as wrong across a spring as along it, where an error counts
// k / m times as much: at 1e12 N/m a rope with masses of 1 g to 1 t was 1.2 mm off after 4 steps, now less than 1
// um.
static void divide(const path_factor *f, double *x, double *y) {
    double *const first = f->is_turned ? y : x, *const second = f->is_turned ? x : y;
    *second = (*second - f->ratio * *first) * f->second;
    *first = *first * f->first - f->ratio * *second;
}

// P^-1 times the block of the spring behind.
static void find_up(const path_factor *pivot, path_block behind, double *up) {
    double columns[2][2] = {{behind.xx, behind.xy}, {behind.xy, behind.yy}};
    for (int i = 0; i < 2; ++i) {
        divide(pivot, &columns[i][0], &columns[i][1]);
        up[i] = columns[i][0];
        up[2 + i] = columns[i][1];
    }
}

// Forward: pivots, and the responses but for what comes back. The system loses the segment.
static void eliminate_segment(const mspringi_implicit *n, const mspringi_paths *p,
                              const mspringi_path_segment *segment, const uint32_t *factors) {
    path_block before = block_of_spring(n, factors[segment->first]);
    const path_block first = before, last = block_of_spring(n, factors[segment->end]);
    for (uint32_t i = segment->first; i < segment->end; ++i) {
        const bool is_first = i == segment->first, is_last = i + 1 == segment->end;
        const uint32_t slot = p->slots[i];
        const path_block behind = block_of_spring(n, factors[i + 1]);
        const double mass = (double)n->mass[slot];
        const path_factor pivot =
            factor_of(pivot_of(p, i, mass, before, behind, is_first ? NULL : p->ups[i - 1]), mass);
        mspringi_path_response sum = {{0.0}, {0.0}};
        sum.x[4] = (double)n->residual.x[slot];
        sum.y[4] = (double)n->residual.y[slot];
        if (is_first) {
            sum.x[0] = first.xx, sum.x[1] = sum.y[0] = first.xy, sum.y[1] = first.yy;
        } else {
            add_columns(before, &p->responses[i - 1], &sum);
        }
        if (is_last) {
            sum.x[2] = last.xx, sum.x[3] = sum.y[2] = last.xy, sum.y[3] = last.yy;
        }
        for (int k = 0; k < 5; ++k)
            divide(&pivot, &sum.x[k], &sum.y[k]);
        p->responses[i] = sum;
        find_up(&pivot, behind, p->ups[i]);
        p->mass[i] = n->mass[slot];
        p->marks[i] |= CONDENSED;
        n->mass[slot] = n->residual.x[slot] = n->residual.y[slot] = 0.0f;
        clear_factors(n, factors[i]);
        before = behind;
    }
    clear_factors(n, factors[segment->end]);
}

static void substitute_back(const mspringi_paths *p, const mspringi_path_segment *segment) {
    for (uint32_t i = segment->end - 1; i-- > segment->first;) {
        const mspringi_path_response *next = &p->responses[i + 1];
        mspringi_path_response *own = &p->responses[i];
        const double *up = p->ups[i];
        for (int k = 0; k < 5; ++k) {
            own->x[k] += up[0] * next->x[k] + up[1] * next->y[k];
            own->y[k] += up[2] * next->x[k] + up[3] * next->y[k];
        }
    }
}

// Rows of S and of the load at an end whose spring is `outer`, beside a node with this response.
static void leave_at_end(mspringi_path_segment *segment, int end, path_block outer,
                         const mspringi_path_response *response) {
    const double rows[2][2] = {{outer.xx, outer.xy}, {outer.xy, outer.yy}};
    segment->lost[end][0] = outer.xx;
    segment->lost[end][1] = outer.xy;
    segment->lost[end][2] = outer.yy;
    for (int i = 0; i < 2; ++i) {
        for (int k = 0; k < 4; ++k) {
            const bool moves = segment->ends[end] != MSPRING_NONE && segment->ends[k / 2] != MSPRING_NONE;
            const double own = k / 2 == end ? rows[i][k % 2] : 0.0;
            segment->block[2 * end + i][k] =
                moves ? own - (rows[i][0] * response->x[k] + rows[i][1] * response->y[k]) : 0.0;
        }
        segment->load[2 * end + i] = rows[i][0] * response->x[4] + rows[i][1] * response->y[4];
    }
}

static void condense_path(const mspringi_implicit *n, const mspringi_paths *p, mspringi_path *path) {
    const uint32_t *factors = p->factors + (path - p->list);
    divide_path(n, p, path);
    mspringi_path_segment *const segments = segments_of(p, path);
    for (mspringi_path_segment *s = segments; s < segments + path->segment_count; ++s) {
        const path_block first = block_of_spring(n, factors[s->first]), last = block_of_spring(n, factors[s->end]);
        eliminate_segment(n, p, s, factors);
        substitute_back(p, s);
        leave_at_end(s, 0, first, &p->responses[s->first]);
        leave_at_end(s, 1, last, &p->responses[s->end - 1]);
    }
}

/* ------------------------------------------------------------------------------------------------ what is left */

#define EACH_SEGMENT(p, s)                                                                                         \
    for (const mspringi_path *path = (p)->list, *path_end = path ? path + (p)->count : path; path < path_end;      \
         ++path)                                                                                                   \
        for (const mspringi_path_segment *s = segments_of(p, path);                                                \
             s < segments_of(p, path) + path->segment_count; ++s)

// Subtract a spring from a diagonal block. Rounding must not leave less than nothing.
static void subtract_spring(const mspringi_system *s, uint32_t slot, const double *spring) {
    const float xx = s->xx[slot] - (float)spring[0], yy = s->yy[slot] - (float)spring[2];
    const float xy = s->xy[slot] - (float)spring[1];
    s->xx[slot] = xx > 0.0f ? xx : 0.0f;
    s->yy[slot] = yy > 0.0f ? yy : 0.0f;
    s->xy[slot] = xx > 0.0f && yy > 0.0f && xy * xy <= xx * yy ? xy : 0.0f;
}

static void add_segment(const mspringi_implicit *n, const mspringi_path_segment *s, int end) {
    const uint32_t slot = s->ends[end];
    n->system.xx[slot] += (float)s->block[2 * end][2 * end];
    n->system.xy[slot] += (float)s->block[2 * end][2 * end + 1];
    n->system.yy[slot] += (float)s->block[2 * end + 1][2 * end + 1];
    n->residual.x[slot] += (float)s->load[2 * end];
    n->residual.y[slot] += (float)s->load[2 * end + 1];
}

// Change the rows of the ends. Constraints of condensed particles, whose pivots have them, lose their stiffness
// until the next mspringi_constraints_activate().
static void change_ends(const mspring_network *network, const mspringi_paths *p) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_system *system = &n->system;
    const mspringi_constraints *all = &network->constraints;
    EACH_SEGMENT(p, s) {
        for (int end = 0; end < 2; ++end)
            if (s->ends[end] != MSPRING_NONE)
                subtract_spring(system, s->ends[end], s->lost[end]);
    }
    EACH_SEGMENT(p, s) {
        for (int end = 0; end < 2; ++end)
            if (s->ends[end] != MSPRING_NONE)
                add_segment(n, s, end);
    }
    for (uint32_t i = 0; i < all->active_count; ++i) {
        const uint32_t node = p->node_of_slot[all->entries[all->active[i].first].slot];
        if (all->active[i].shape >> 1 == 1 && node != MSPRING_NONE && p->marks[node] & CONDENSED)
            all->active[i].stiffness = 0.0;
    }
}

void mspringi_condense(const mspring_network *network, mspringi_team_member *member) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    mspringi_paths *p = &n->paths;
    if (p->count == 0)
        return;
    mspringi_team_barrier(member);
    if (member->index == 0)
        mark_nodes(network, p);
    mspringi_team_barrier(member);
    const size_t end = mspringi_range_end(member, p->count);
    for (size_t i = mspringi_range_begin(member, p->count); i < end; ++i) {
        mspringi_path *path = &p->list[i];
        for (uint32_t node = path->first; node < path->end; ++node)
            p->marks[node] &= JOINED;
        condense_path(n, p, path);
    }
    mspringi_team_barrier(member);
    if (member->index == 0)
        change_ends(network, p);
    mspringi_team_barrier(member);
}

static void gather_ends(const mspringi_path_segment *s, mspringi_field from, double *to) {
    for (int end = 0; end < 2; ++end) {
        const uint32_t slot = s->ends[end];
        to[2 * end] = slot != MSPRING_NONE ? (double)from.x[slot] : 0.0;
        to[2 * end + 1] = slot != MSPRING_NONE ? (double)from.y[slot] : 0.0;
    }
}

void mspringi_condense_multiply(const mspring_network *network, const mspringi_product *product) {
    const mspringi_paths *p = &mspringi_implicit_of(network)->paths;
    EACH_SEGMENT(p, s) {
        const uint32_t first = s->ends[s->ends[0] == MSPRING_NONE];
        double d[4], q[4], sum = 0.0;
        if (!mspringi_product_has(product, s->ends[0]) && !mspringi_product_has(product, s->ends[1]))
            continue;
        gather_ends(s, product->from, d);
        for (int i = 0; i < 4; ++i) {
            const double *row = s->block[i];
            q[i] = (row[0] * d[0] + row[1] * d[1]) + (row[2] * d[2] + row[3] * d[3]);
            sum += d[i] * q[i];
        }
        for (int end = 0; end < 2; ++end)
            mspringi_product_add(product, s->ends[end], (float)q[2 * end], (float)q[2 * end + 1]);
        mspringi_product_count(product, first, sum);
    }
}

static void finish_segment(const mspringi_implicit *n, const mspringi_paths *p, const mspringi_path_segment *s,
                           double alpha) {
    double d[4], along[4];
    gather_ends(s, n->displacement, d);
    gather_ends(s, n->direction, along);
    for (int i = 0; i < 4; ++i)
        d[i] += alpha * along[i];
    for (uint32_t i = s->first; i < s->end; ++i) {
        const double *x = p->responses[i].x, *y = p->responses[i].y;
        const uint32_t slot = p->slots[i];
        n->displacement.x[slot] = (float)(x[4] + ((x[0] * d[0] + x[1] * d[1]) + (x[2] * d[2] + x[3] * d[3])));
        n->displacement.y[slot] = (float)(y[4] + ((y[0] * d[0] + y[1] * d[1]) + (y[2] * d[2] + y[3] * d[3])));
        n->direction.x[slot] = n->direction.y[slot] = 0.0f;
        n->mass[slot] = p->mass[i];
    }
}

void mspringi_condense_finish(const mspring_network *network, mspringi_team_member *member, float alpha) {
    const mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_paths *p = &n->paths;
    const size_t end = mspringi_range_end(member, p->count);
    for (size_t i = mspringi_range_begin(member, p->count); i < end; ++i) {
        const mspringi_path_segment *segments = segments_of(p, &p->list[i]);
        for (uint32_t k = 0; k < p->list[i].segment_count; ++k)
            finish_segment(n, p, &segments[k], (double)alpha);
    }
}

/* ----------------------------------------------------------------------------------------------- coarse matrix */

// Add a column of S's root, as a constraint's, to the tiles of the ends.
static void add_column(mspringi_implicit *n, const mspringi_path_segment *s, const double *column) {
    mspringi_coarse_rank_one pulls;
    pulls.count = 0;
    for (int end = 0; end < 2; ++end) {
        const uint32_t slot = s->ends[end], tile = slot == MSPRING_NONE ? MSPRING_NONE : n->tiles.of_slot[slot];
        const double x = column[2 * end], y = column[2 * end + 1];
        if (tile == MSPRING_NONE)
            continue;
        uint32_t i = 0;
        if (pulls.count == 0 || pulls.tiles[0] != tile) {
            i = pulls.count++;
            pulls.tiles[i] = tile;
            pulls.rows[i][0] = pulls.rows[i][1] = pulls.rows[i][2] = 0.0;
        }
        pulls.rows[i][0] += x;
        pulls.rows[i][1] += y;
        pulls.rows[i][2] += (double)n->arm.x[slot] * y - (double)n->arm.y[slot] * x;
    }
    mspringi_coarse_add_rank_one(&n->coarse, &pulls);
}

// S = L L^T, by columns. A pivot that rounding has left is none.
static void stiffen_segment(mspringi_implicit *n, const mspringi_path_segment *s) {
    double block[4][4];
    memcpy(block, s->block, sizeof block);
    for (int j = 0; j < 4; ++j) {
        const double pivot = block[j][j], root = sqrt(fmax(pivot, 0.0));
        double column[4] = {0.0};
        if (!(pivot > 1e-12 * s->block[j][j]))
            continue;
        for (int i = j; i < 4; ++i)
            column[i] = block[i][j] / root;
        for (int i = j + 1; i < 4; ++i)
            for (int k = j + 1; k < 4; ++k)
                block[i][k] -= column[i] * column[k];
        add_column(n, s, column);
    }
}

void mspringi_condense_stiffen(const mspring_network *network) {
    mspringi_implicit *n = mspringi_implicit_of(network);
    const mspringi_paths *p = &n->paths;
    EACH_SEGMENT(p, s) {
        stiffen_segment(n, s);
    }
}

/// Ropes on lattices: strips of their particles, and positions in these strips.
///
/// Springs between consecutive slices, with sixteen ropes side by side, are computed once and gather nothing
/// (layout/emit/sell.h). So a rope crosses to a strip near its other end in as few particles as the skew allows,
/// and stays there. The part that stays is cut into pieces of two lengths. Sixteen pieces of equal length begin and
/// end together, so only springs between pieces are computed at both ends.
#include "layout/arrange/ropes.h"

/// Particles in a piece.
#define LONG_PIECE 8
#define SHORT_PIECE 4

static uint32_t strip_of(const mspringi_strip_assignment *assignment, const mspringi_grids *grids,
                         uint32_t particle) {
    const uint32_t grid = grids->grid_of[particle];
    return grid == MSPRING_NONE ? assignment->assigned_strip[particle]
                                : (assignment->first_row[grid] + grids->row[particle]) / assignment->strip_rows;
}

// Strip of the particle to which a spring outside the chain connects its first or last one; MSPRING_NONE if there
// is no such spring.
static uint32_t strip_at_end(const mspringi_ropes *ropes, uint32_t particle, uint32_t own_spring) {
    const mspringi_graph *graph = ropes->graph;
    for (uint32_t i = graph->first[particle]; i < graph->first[particle + 1]; ++i)
        if (graph->springs[i] != own_spring)
            return strip_of(ropes->assignment, ropes->grids, graph->others[i]);
    return MSPRING_NONE;
}

static int64_t clamp(int64_t value, int64_t low, int64_t high) {
    return value < low ? low : value > high ? high : value;
}

// Assign strips to a chain's particles, at most the skew apart from each other and from the strips at its ends.
static void assign_strips(const mspringi_ropes *ropes, uint32_t begin, uint32_t end) {
    const uint32_t *particles = ropes->chains->particles, *springs = ropes->chains->springs;
    const int64_t skew = ropes->assignment->skew;
    uint32_t from = strip_at_end(ropes, particles[begin], springs[begin]);
    uint32_t to = strip_at_end(ropes, particles[end - 1], end - begin > 1 ? springs[end - 2] : MSPRING_NONE);
    from = from == MSPRING_NONE ? to : from;
    to = to == MSPRING_NONE ? from : to;
    // One strip in 2 * skew is in reach of all others, so that more ropes meet there.
    const int64_t target = clamp((int64_t)to / (2 * skew) * (2 * skew) + skew, 0, (int64_t)ropes->strip_count - 1);
    for (uint32_t i = begin; i < end; ++i) {
        const int64_t from_reach = skew * (i + 1 - begin), to_reach = skew * (end - i);
        const int64_t low = from - from_reach > to - to_reach ? from - from_reach : to - to_reach;
        const int64_t high = from + from_reach < to + to_reach ? from + from_reach : to + to_reach;
        ropes->assignment->assigned_strip[particles[i]] = (uint32_t)clamp(target, low, high);
    }
}

static uint32_t add_piece(mspringi_ropes *ropes, uint32_t *counts, uint32_t begin, uint32_t length) {
    const uint32_t assigned_strip = ropes->assignment->assigned_strip[ropes->chains->particles[begin]];
    for (uint32_t row = 0; row < length; ++row)
        ropes->piece[ropes->chains->particles[begin + row]] =
            1 + counts[assigned_strip] * 2 * LONG_PIECE + (length == LONG_PIECE) * LONG_PIECE + row;
    counts[assigned_strip]++;
    return length;
}

// Cut particles with the same assigned strip into pieces.
static void cut_run(mspringi_ropes *ropes, uint32_t begin, uint32_t end) {
    while (end - begin >= LONG_PIECE)
        begin += add_piece(ropes, ropes->long_count, begin, LONG_PIECE);
    while (end - begin >= SHORT_PIECE)
        begin += add_piece(ropes, ropes->short_count, begin, SHORT_PIECE);
}

static void cut_chain(mspringi_ropes *ropes, uint32_t begin, uint32_t end) {
    const uint32_t *particles = ropes->chains->particles, *assigned_strip = ropes->assignment->assigned_strip;
    for (uint32_t last; begin < end; begin = last) {
        for (last = begin + 1; last < end && assigned_strip[particles[last]] == assigned_strip[particles[begin]];)
            ++last;
        cut_run(ropes, begin, last);
    }
}

mspring_result mspringi_ropes_assign_strips(mspringi_ropes *ropes, const mspringi_graph *graph,
                                            const mspringi_grids *grids, const mspringi_chains *chains,
                                            mspringi_strip_assignment *assignment, mspringi_memory *memory,
                                            mspringi_message *message) {
    *ropes = (mspringi_ropes){.graph = graph, .grids = grids, .chains = chains, .assignment = assignment};
    if (chains->count == 0 || assignment->row_count == 0)
        return MSPRING_OK;
    const size_t strips = ((size_t)assignment->row_count + assignment->strip_rows - 1) / assignment->strip_rows;
    ropes->strip_count = (uint32_t)strips;
    ropes->piece = mspringi_alloc(memory, graph->builder->particle_count, sizeof *ropes->piece);
    ropes->long_count = mspringi_alloc(memory, strips, sizeof *ropes->long_count);
    ropes->short_count = mspringi_alloc(memory, strips, sizeof *ropes->short_count);
    if (!ropes->piece || !ropes->long_count || !ropes->short_count)
        return mspringi_fail(message, MSPRING_ERROR_MEMORY, "no memory for ropes of %u particles",
                             (unsigned)chains->count);
    for (uint32_t begin = 0, end; begin < chains->count; begin = end) {
        for (end = begin + 1; chains->springs[end - 1] != MSPRING_NONE;)
            ++end;
        if (assignment->assigned_strip[chains->particles[begin]] == MSPRING_NONE)
            continue;
        assign_strips(ropes, begin, end);
        cut_chain(ropes, begin, end);
    }
    return MSPRING_OK;
}

// Position of a piece's particle among those of its strip, or MSPRING_NONE if it is not interleaved. Long pieces
// that cannot fill all lanes count as two short ones each.
static uint32_t interleaved_position(const mspringi_ropes *ropes, uint32_t assigned_strip, uint32_t particle) {
    if (ropes->piece[particle] == 0)
        return MSPRING_NONE;
    const uint32_t piece = ropes->piece[particle] - 1;
    const uint32_t full = ropes->long_count[assigned_strip] / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
    const uint32_t left_over = ropes->long_count[assigned_strip] - full;
    uint32_t number = piece / (2 * LONG_PIECE), row = piece % LONG_PIECE;
    if (piece / LONG_PIECE % 2 == 1) {
        if (number < full)
            return (number / MSPRINGI_WIDTH * LONG_PIECE + row) * MSPRINGI_WIDTH + number % MSPRINGI_WIDTH;
        number = LONG_PIECE / SHORT_PIECE * (number - full) + row / SHORT_PIECE;
        row %= SHORT_PIECE;
    } else {
        number += LONG_PIECE / SHORT_PIECE * left_over;
    }
    const uint32_t shorts = ropes->short_count[assigned_strip] + LONG_PIECE / SHORT_PIECE * left_over;
    if (number >= shorts / MSPRINGI_WIDTH * MSPRINGI_WIDTH)
        return MSPRING_NONE;
    return full * LONG_PIECE + (number / MSPRINGI_WIDTH * SHORT_PIECE + row) * MSPRINGI_WIDTH +
           number % MSPRINGI_WIDTH;
}

static uint32_t interleaved_count(const mspringi_ropes *ropes, uint32_t assigned_strip) {
    const uint32_t full = ropes->long_count[assigned_strip] / MSPRINGI_WIDTH * MSPRINGI_WIDTH;
    const uint32_t shorts =
        ropes->short_count[assigned_strip] + LONG_PIECE / SHORT_PIECE * (ropes->long_count[assigned_strip] - full);
    return full * LONG_PIECE + shorts / MSPRINGI_WIDTH * MSPRINGI_WIDTH * SHORT_PIECE;
}

// Interleave strip by strip.
void mspringi_ropes_interleave(const mspringi_ropes *ropes, mspringi_irregular_list *list) {
    if (!ropes->piece)
        return;
    for (uint32_t begin = 0, end; begin < list->assigned_count; begin = end) {
        const uint32_t assigned_strip = ropes->assignment->assigned_strip[list->particles[begin]];
        uint32_t next = begin + interleaved_count(ropes, assigned_strip);
        for (end = begin; end < list->assigned_count &&
                          ropes->assignment->assigned_strip[list->particles[end]] == assigned_strip;
             ++end) {
            const uint32_t position = interleaved_position(ropes, assigned_strip, list->particles[end]);
            list->scratch[position == MSPRING_NONE ? next++ : begin + position] = list->particles[end];
        }
        for (uint32_t i = begin; i < end; ++i)
            list->particles[i] = (uint32_t)list->scratch[i];
    }
}

void mspringi_ropes_destroy(mspringi_ropes *ropes, mspringi_memory *memory) {
    mspringi_free(memory, ropes->piece);
    mspringi_free(memory, ropes->long_count);
    mspringi_free(memory, ropes->short_count);
}

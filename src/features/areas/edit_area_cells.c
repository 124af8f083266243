/// Search for cells.
///
/// In a lattice's rows a cell is four particles with live springs around them; sweeps can compute its area.
/// Elsewhere, also in lattices too small for rows, it is four particles that are all connected by live springs, two
/// of which cross.
#include "features/areas/edit_areas.h"

#include "features/areas/areas.h"
#include "store/id_pool.h"
#include "store/springs.h"

static uint32_t slot_of(const mspring_network *network, mspring_id particle) {
    return network->topology.slot_of_particle[particle];
}

static void make_positive(const mspring_network *network, mspring_id corners[4]) {
    if (mspringi_area_within(network, corners, 4) < 0.0) {
        const mspring_id second = corners[1];
        corners[1] = corners[3];
        corners[3] = second;
    }
}

// Find the cell of rows above and on the right of a particle.
static bool find_in_rows(const mspring_network *network, mspring_id particle, mspring_id corners[4]) {
    uint32_t slots[4];
    if (!mspringi_cell_at(network, slot_of(network, particle), slots))
        return false;
    for (int i = 0; i < 4; ++i)
        corners[i] = network->topology.particle_of_slot[slots[i]];
    make_positive(network, corners);
    return true;
}

// True if a cell of rows has the same four corners.
static bool is_in_rows(const mspring_network *network, const mspring_id corners[4]) {
    for (int i = 0; i < 4; ++i) {
        mspring_id cell[4];
        int shared = 0;
        if (!find_in_rows(network, corners[i], cell))
            continue;
        for (int j = 0; j < 16; ++j)
            shared += cell[j / 4] == corners[j % 4];
        if (shared == 4)
            return true;
    }
    return false;
}

// True if the particle is on the left of the line between two others.
static bool is_left(const mspring_network *network, mspring_id from, mspring_id to, mspring_id particle) {
    const mspring_id three[3] = {from, to, particle};
    return mspringi_area_within(network, three, 3) > 0.0;
}

static bool are_crossed(const mspring_network *network, mspring_id a, mspring_id b, mspring_id c, mspring_id d) {
    return is_left(network, a, b, c) != is_left(network, a, b, d) &&
           is_left(network, c, d, a) != is_left(network, c, d, b);
}

// Order four connected particles around their cell. False if none of their springs cross.
static bool order_corners(const mspring_network *network, mspring_id corners[4]) {
    for (int other = 1; other < 4; ++other) {
        const mspring_id a = corners[0], b = corners[other], c = corners[other == 1 ? 2 : 1],
                         d = corners[other == 3 ? 2 : 3];
        if (!are_crossed(network, a, b, c, d))
            continue;
        corners[0] = a;
        corners[1] = c;
        corners[2] = b;
        corners[3] = d;
        make_positive(network, corners);
        return true;
    }
    return false;
}

/// Neighbours of a higher id that whole springs join a particle to: those of p from first[p] to first[p + 1].
typedef struct cell_search {
    mspring_network *network;
    uint32_t *first;
    mspring_id *neighbours;
    uint8_t *marks; ///< of the neighbours of the lowest corner, and of those of the second
    uint64_t work, most_work;
    uint64_t cells_left;
    mspringi_cell_fn fn;
    void *user;
} cell_search;

enum { OF_LOWEST = 1, OF_SECOND = 2 };

/// Particles that may be tried for a corner (50 ms), and for each spring besides: a lattice takes 20. To look at
/// four that are joined takes as long as so many tries.
#define MOST_WORK ((uint64_t)1 << 24)
#define WORK_OF_SPRING 64
#define WORK_OF_FOUR 32

/// Cells that there may be, or as many as springs. Those of a lattice share springs with four others each; where
/// more are than springs, they lie above each other, as in a clique.
#define MOST_CELLS 16384

static void end_search(cell_search *s) {
    mspringi_memory *memory = &s->network->memory;
    mspringi_free(memory, s->first);
    mspringi_free(memory, s->neighbours);
    mspringi_free(memory, s->marks);
}

static mspring_result begin_search(cell_search *s) {
    mspring_network *network = s->network;
    const uint32_t particles = network->topology.particle_count, springs = network->topology.spring_count;
    s->first = mspringi_alloc_unset(&network->memory, (size_t)particles + 1, sizeof *s->first);
    s->neighbours = mspringi_alloc_unset(&network->memory, springs, sizeof *s->neighbours);
    s->marks = mspringi_alloc(&network->memory, particles, sizeof *s->marks);
    if (!s->first || !s->neighbours || !s->marks) {
        end_search(s);
        return mspringi_fail(&network->message, MSPRING_ERROR_MEMORY, "no memory to search %u springs for cells",
                             (unsigned)springs);
    }
    uint32_t end = 0;
    for (mspring_id p = 0; p < particles; ++p) {
        s->first[p] = end;
        if (!mspringi_particle_exists(network, p))
            continue;
        mspringi_incident_springs around = mspringi_incident_springs_begin(network, p);
        for (mspring_id spring; (spring = mspringi_incident_springs_next(network, &around)) != MSPRING_NONE;) {
            const mspring_id other = mspringi_end_beyond(network, spring, p);
            if (mspringi_spring_is_live(network, spring) && other > p)
                s->neighbours[end++] = other;
        }
    }
    s->first[particles] = end;
    s->most_work = MOST_WORK + WORK_OF_SPRING * (uint64_t)springs;
    s->cells_left = springs > MOST_CELLS ? springs : MOST_CELLS;
    return MSPRING_OK;
}

static void mark(const cell_search *s, mspring_id of, uint8_t bit) {
    for (uint32_t i = s->first[of]; i < s->first[of + 1]; ++i)
        s->marks[s->neighbours[i]] |= bit;
}

static void unmark(const cell_search *s, mspring_id of, uint8_t bit) {
    for (uint32_t i = s->first[of]; i < s->first[of + 1]; ++i)
        s->marks[s->neighbours[i]] &= (uint8_t)~bit;
}

static mspring_result too_many(const cell_search *s, mspring_id at) {
    return mspringi_fail(
        &s->network->message, MSPRING_ERROR_LIMIT,
        "springs join so many particles each to each, as around particle %u, that %s: add areas one "
        "by one with mspring_network_add_area()",
        (unsigned)at,
        s->cells_left == 0 ? "over 16384 cells, and more than there are springs, lie above each other"
                           : "to search them for cells takes too long");
}

static mspring_result found_cell(cell_search *s, const mspring_id corners[4]) {
    if (s->cells_left == 0)
        return too_many(s, corners[0]);
    s->cells_left--;
    return s->fn(s->network, corners, s->user);
}

// Those elsewhere whose lowest corners are three that springs join: the fourth is joined to all.
static mspring_result each_of_three(cell_search *s, const mspring_id three[3]) {
    mspring_result result = MSPRING_OK;
    for (uint32_t i = s->first[three[2]]; result == MSPRING_OK && i < s->first[three[2] + 1]; ++i) {
        mspring_id corners[4] = {three[0], three[1], three[2], s->neighbours[i]};
        if (s->marks[corners[3]] != (OF_LOWEST | OF_SECOND))
            continue;
        s->work += WORK_OF_FOUR;
        if (!is_in_rows(s->network, corners) && order_corners(s->network, corners))
            result = found_cell(s, corners);
    }
    return result;
}

// Those whose lowest corners are a pair that a spring joins: the third is joined to both. The neighbours of the
// lowest are marked.
static mspring_result each_of_pair(cell_search *s, mspring_id lowest, mspring_id second) {
    mspring_result result = MSPRING_OK;
    mark(s, second, OF_SECOND);
    for (uint32_t i = s->first[second]; result == MSPRING_OK && i < s->first[second + 1]; ++i) {
        const mspring_id third = s->neighbours[i];
        const bool is_joined = s->marks[third] & OF_LOWEST;
        s->work += 1 + (is_joined ? s->first[third + 1] - s->first[third] : 0);
        if (s->work > s->most_work)
            result = too_many(s, lowest);
        else if (is_joined)
            result = each_of_three(s, (const mspring_id[]){lowest, second, third});
    }
    unmark(s, second, OF_SECOND);
    return result;
}

static mspring_result each_of_lowest(cell_search *s, mspring_id lowest) {
    mspring_result result = MSPRING_OK;
    mspring_id corners[4];
    if (find_in_rows(s->network, lowest, corners))
        result = found_cell(s, corners);
    mark(s, lowest, OF_LOWEST);
    for (uint32_t i = s->first[lowest]; result == MSPRING_OK && i < s->first[lowest + 1]; ++i)
        result = each_of_pair(s, lowest, s->neighbours[i]);
    unmark(s, lowest, OF_LOWEST);
    return result;
}

mspring_result mspringi_each_cell(mspring_network *network, mspringi_cell_fn fn, void *user) {
    cell_search s = {.network = network, .fn = fn, .user = user};
    mspring_result result = mspringi_incidence_reserve(network);
    if (result == MSPRING_OK)
        result = begin_search(&s);
    if (result != MSPRING_OK)
        return result;
    for (mspring_id p = 0; result == MSPRING_OK && p < network->topology.particle_count; ++p)
        if (mspringi_particle_exists(network, p))
            result = each_of_lowest(&s, p);
    end_search(&s);
    return result;
}
